//! Detection of the processor's vector instructions. An [`Instructions`] value proves that they are present.

use std::fmt;

use super::vector::{Portable, Vector};
#[cfg(target_arch = "x86_64")]
use super::x86::{Avx2, Avx512};

/// Vector instructions that this processor has. Its values come from [`Instructions::best`] and
/// [`Instructions::available`] only, so that holding one proves that the instructions may be used.
///
/// With AVX2 and with AVX-512 every number is the same to the bit, since both round a product and a sum once and in the
/// same order (`tests/mechanics_machines.rs`); without either, products are rounded by themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Instructions(Level);

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Level {
    const ALL: &[Self] = &[
        Self::Portable,
        #[cfg(target_arch = "x86_64")]
        Self::Avx2,
        #[cfg(target_arch = "x86_64")]
        Self::Avx512,
    ];

    fn is_here(self) -> bool {
        match self {
            Self::Portable => true,
            // Miri runs the portable path: it knows neither the instructions nor which of them there are.
            #[cfg(target_arch = "x86_64")]
            _ if cfg!(miri) => false,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("fma") && is_x86_feature_detected!("avx2"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                Self::Avx2.is_here() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")
            }
        }
    }
}

impl Instructions {
    /// No vector instructions; runs on every processor.
    pub const PORTABLE: Self = Self(Level::Portable);

    /// All that this processor has, from the narrowest to the widest.
    pub fn available() -> impl Iterator<Item = Self> {
        Level::ALL.iter().copied().filter(|level| level.is_here()).map(Self)
    }

    /// The widest that this processor has.
    pub fn best() -> Self {
        Self::available().last().unwrap_or(Self::PORTABLE)
    }

    /// `portable`, `avx2` or `avx512`.
    pub const fn name(self) -> &'static str {
        match self.0 {
            Level::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => "avx512",
        }
    }

    /// Runs `kernel` with the vectors of these instructions.
    #[inline]
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            Level::Portable => with_portable(kernel),
            #[cfg(target_arch = "x86_64")]
            #[expect(unsafe_code, reason = "the one place where vector instructions are entered")]
            // SAFETY: `self` was made by `available`, which found the processor to have AVX2 and FMA.
            Level::Avx2 => unsafe { with_avx2(kernel) },
            #[cfg(target_arch = "x86_64")]
            #[expect(unsafe_code, reason = "the one place where vector instructions are entered")]
            // SAFETY: `self` was made by `available`, which found the processor to have AVX-512 F and VL, AVX2
            // and FMA.
            Level::Avx512 => unsafe { with_avx512(kernel) },
        }
    }
}

impl Default for Instructions {
    fn default() -> Self {
        Self::best()
    }
}

impl fmt::Display for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A computation written once for every width of vectors; its fields are its arguments.
pub(crate) trait Kernel {
    /// Result of the computation.
    type Output;

    /// Computes the result. Implementations and everything that they call with `V` are `#[inline(always)]`: the code
    /// must end up inside the function that carries the target feature. A closure cannot be marked so, and a large one
    /// becomes a function that calls another one for each product; `mechanics_machines` finds those.
    fn run<V: Vector>(self) -> Self::Output;
}

/// Not inlined, so that a kernel that is called from several others is compiled once.
#[inline(never)]
pub(super) fn with_portable<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Portable>()
}

/// As [`with_portable`].
#[cfg(target_arch = "x86_64")]
#[inline(never)]
#[target_feature(enable = "avx2,fma")]
pub(super) fn with_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

/// As [`with_portable`].
#[cfg(target_arch = "x86_64")]
#[inline(never)]
#[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
pub(super) fn with_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx512>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_is_portable_and_the_best_is_available() {
        let all: Vec<_> = Instructions::available().collect();
        assert_eq!(all.first(), Some(&Instructions::PORTABLE));
        assert_eq!(all.last(), Some(&Instructions::best()));
        assert!(all.is_sorted());
    }
}
