//! Eight lanes in the registers of AVX2 and of AVX-512.
#![expect(
    unsafe_code,
    reason = "vector instructions; these types can be named in this room only, where Instructions::run enters their target features"
)]

use std::arch::x86_64::*;

use super::vector::Vector;

/// Two registers of four.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx2(__m256d, __m256d);

/// One register of eight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx512(__m512d);

// SAFETY of all blocks in both: these types are private to this room, which hands them to kernels in functions with the
// target features `avx2,fma` and `avx512f,avx512vl` only; those are entered through `Instructions::run`, whose `self`
// proves that the processor has them. Memory is read and written through references to arrays of eight, unaligned.
impl Vector for Avx2 {
    const FUSED: bool = true;

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
    const FUSED: bool = true;

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
