//! Eight numbers at once: the same kernels with AVX-512, with AVX2 and without either.
//!
//! Kernels are written once over [`Vector`] and marked `#[inline(always)]`; the functions that call them for one kind of vector carry
//! the `target_feature` that it needs. The compiler's own vectors of such code were tried and are several times slower: it takes
//! the lanes apart.

/// Eight lanes.
pub trait Vector: Copy {
    /// The same in every lane.
    fn splat(x: f64) -> Self;
    /// From memory.
    fn load(from: &[f64; 8]) -> Self;
    /// To memory.
    fn store(self, to: &mut [f64; 8]);
    /// By lane.
    fn plus(self, other: Self) -> Self;
    /// By lane.
    fn minus(self, other: Self) -> Self;
    /// By lane.
    fn times(self, other: Self) -> Self;
    /// self + a b, rounded once where the machine does that.
    fn plus_product(self, a: Self, b: Self) -> Self;
    /// self - a b, likewise.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// Lanes 0, 5, 4, 3, 2, 1, 6, 7: in a node's values, the other unknown of the same bending plane.
    fn paired(self) -> Self;
    /// Lanes 2, 1, 0, 5, 4, 3, 6, 7: in a node's values, along and across exchanged.
    fn across(self) -> Self;
    /// Lanes 1, 0, 3, 2, 5, 4, 7, 6: neighbours exchanged.
    fn swapped(self) -> Self;
    /// Whether some lane of `self` is larger in size than the same lane of `bound`; lanes that are not numbers count as larger.
    fn any_beyond(self, bound: Self) -> bool;
}

/// Eight lanes at a time of a longer array.
#[inline(always)]
pub fn part(values: &[f64], first: usize) -> Option<&[f64; 8]> {
    values.get(first..first + 8)?.first_chunk()
}

/// Without vector instructions.
#[derive(Debug, Clone, Copy)]
pub struct Portable([f64; 8]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, op: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self;
        for (x, y) in out.0.iter_mut().zip(other.0) {
            *x = op(*x, y);
        }
        out
    }
}

impl Vector for Portable {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn load(from: &[f64; 8]) -> Self {
        Self(*from)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        *to = self.0;
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self.zip(other, |x, y| x + y)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self.zip(other, |x, y| x - y)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        self.zip(other, |x, y| x * y)
    }
    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        self.plus(a.times(b))
    }
    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        self.minus(a.times(b))
    }
    #[inline(always)]
    fn paired(self) -> Self {
        let x = self.0;
        Self([x[0], x[5], x[4], x[3], x[2], x[1], x[6], x[7]])
    }
    #[inline(always)]
    fn across(self) -> Self {
        let x = self.0;
        Self([x[2], x[1], x[0], x[5], x[4], x[3], x[6], x[7]])
    }
    #[inline(always)]
    fn swapped(self) -> Self {
        let x = self.0;
        Self([x[1], x[0], x[3], x[2], x[5], x[4], x[7], x[6]])
    }
    #[inline(always)]
    fn any_beyond(self, bound: Self) -> bool {
        let mut any = false;
        for (x, bound) in self.0.iter().zip(bound.0) {
            any |= x.abs() > bound || x.is_nan() || bound.is_nan();
        }
        any
    }
}

#[cfg(target_arch = "x86_64")]
pub use x86::{Avx2, Avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    #![expect(
        unsafe_code,
        reason = "vector instructions; every caller runs under the target feature that it names"
    )]

    use std::arch::x86_64::*;

    use super::Vector;

    /// Two registers of four.
    #[derive(Debug, Clone, Copy)]
    pub struct Avx2(__m256d, __m256d);

    /// One register of eight.
    #[derive(Debug, Clone, Copy)]
    pub struct Avx512(__m512d);

    // SAFETY of all blocks in both: these types are used only in functions with the target features `avx2,fma` and `avx512f`, which are
    // called only after the processor was found to have them (see `Instructions`). Memory is read and written through references to
    // arrays of eight, unaligned.
    impl Vector for Avx2 {
        #[inline(always)]
        fn splat(x: f64) -> Self {
            unsafe { Self(_mm256_set1_pd(x), _mm256_set1_pd(x)) }
        }
        #[inline(always)]
        fn load(from: &[f64; 8]) -> Self {
            unsafe { Self(_mm256_loadu_pd(from.as_ptr()), _mm256_loadu_pd(from.as_ptr().add(4))) }
        }
        #[inline(always)]
        fn store(self, to: &mut [f64; 8]) {
            unsafe {
                _mm256_storeu_pd(to.as_mut_ptr(), self.0);
                _mm256_storeu_pd(to.as_mut_ptr().add(4), self.1);
            }
        }
        #[inline(always)]
        fn plus(self, other: Self) -> Self {
            unsafe { Self(_mm256_add_pd(self.0, other.0), _mm256_add_pd(self.1, other.1)) }
        }
        #[inline(always)]
        fn minus(self, other: Self) -> Self {
            unsafe { Self(_mm256_sub_pd(self.0, other.0), _mm256_sub_pd(self.1, other.1)) }
        }
        #[inline(always)]
        fn times(self, other: Self) -> Self {
            unsafe { Self(_mm256_mul_pd(self.0, other.0), _mm256_mul_pd(self.1, other.1)) }
        }
        #[inline(always)]
        fn plus_product(self, a: Self, b: Self) -> Self {
            unsafe { Self(_mm256_fmadd_pd(a.0, b.0, self.0), _mm256_fmadd_pd(a.1, b.1, self.1)) }
        }
        #[inline(always)]
        fn minus_product(self, a: Self, b: Self) -> Self {
            unsafe { Self(_mm256_fnmadd_pd(a.0, b.0, self.0), _mm256_fnmadd_pd(a.1, b.1, self.1)) }
        }
        #[inline(always)]
        fn paired(self) -> Self {
            let mut x = [0.0; 8];
            self.store(&mut x);
            Self::load(&[x[0], x[5], x[4], x[3], x[2], x[1], x[6], x[7]])
        }
        #[inline(always)]
        fn across(self) -> Self {
            let mut x = [0.0; 8];
            self.store(&mut x);
            Self::load(&[x[2], x[1], x[0], x[5], x[4], x[3], x[6], x[7]])
        }
        #[inline(always)]
        fn swapped(self) -> Self {
            unsafe { Self(_mm256_permute_pd::<0b0101>(self.0), _mm256_permute_pd::<0b0101>(self.1)) }
        }
        #[inline(always)]
        fn any_beyond(self, bound: Self) -> bool {
            unsafe {
                let sign = _mm256_set1_pd(-0.0);
                let beyond =
                    |x, bound| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_NLE_UQ>(_mm256_andnot_pd(sign, x), bound)) != 0;
                beyond(self.0, bound.0) | beyond(self.1, bound.1)
            }
        }
    }

    impl Vector for Avx512 {
        #[inline(always)]
        fn splat(x: f64) -> Self {
            unsafe { Self(_mm512_set1_pd(x)) }
        }
        #[inline(always)]
        fn load(from: &[f64; 8]) -> Self {
            unsafe { Self(_mm512_loadu_pd(from.as_ptr())) }
        }
        #[inline(always)]
        fn store(self, to: &mut [f64; 8]) {
            unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        fn plus(self, other: Self) -> Self {
            unsafe { Self(_mm512_add_pd(self.0, other.0)) }
        }
        #[inline(always)]
        fn minus(self, other: Self) -> Self {
            unsafe { Self(_mm512_sub_pd(self.0, other.0)) }
        }
        #[inline(always)]
        fn times(self, other: Self) -> Self {
            unsafe { Self(_mm512_mul_pd(self.0, other.0)) }
        }
        #[inline(always)]
        fn plus_product(self, a: Self, b: Self) -> Self {
            unsafe { Self(_mm512_fmadd_pd(a.0, b.0, self.0)) }
        }
        #[inline(always)]
        fn minus_product(self, a: Self, b: Self) -> Self {
            unsafe { Self(_mm512_fnmadd_pd(a.0, b.0, self.0)) }
        }
        #[inline(always)]
        fn paired(self) -> Self {
            unsafe { Self(_mm512_permutexvar_pd(_mm512_setr_epi64(0, 5, 4, 3, 2, 1, 6, 7), self.0)) }
        }
        #[inline(always)]
        fn across(self) -> Self {
            unsafe { Self(_mm512_permutexvar_pd(_mm512_setr_epi64(2, 1, 0, 5, 4, 3, 6, 7), self.0)) }
        }
        #[inline(always)]
        fn swapped(self) -> Self {
            unsafe { Self(_mm512_permute_pd::<0b0101_0101>(self.0)) }
        }
        #[inline(always)]
        fn any_beyond(self, bound: Self) -> bool {
            unsafe { _mm512_cmp_pd_mask::<_CMP_NLE_UQ>(_mm512_abs_pd(self.0), bound.0) != 0 }
        }
    }
}
