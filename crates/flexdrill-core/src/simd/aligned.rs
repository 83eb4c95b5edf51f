//! Values at the beginning of a cache line.

use std::ops::{Deref, DerefMut};

/// A value at an address that is a multiple of 64: sixteen lanes of single or eight of double precision are then read
/// from one cache line instead of two.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(C, align(64))]
pub struct Aligned<T>(pub T);

impl<T> Deref for Aligned<T> {
    type Target = T;

    #[inline(always)]
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> DerefMut for Aligned<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}
