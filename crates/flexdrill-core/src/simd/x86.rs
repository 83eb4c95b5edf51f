//! Eight lanes in the registers of AVX2 and of AVX-512.
#![expect(
    unsafe_code,
    reason = "vector instructions; these types can be named in this room only, where Instructions::run enters their target features"
)]

use std::arch::x86_64::*;

use super::instructions::{Kernel, with_avx2, with_avx512};
use super::single::Single;
use super::vector::Vector;

/// Two registers of four.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx2(__m256d, __m256d);

/// One register of eight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx512(__m512d);

/// Two registers of eight of single precision.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx2Single(__m256, __m256);

/// One register of sixteen of single precision.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx512Single(__m512);

// SAFETY of all blocks in all four: these types are private to this room, which hands them to kernels in functions with
// the target features `avx2,fma` and `avx512f,avx512vl` only; those are entered through `Instructions::run`, whose
// `self` proves that the processor has them. Memory is read and written through references to arrays of eight or
// sixteen, unaligned.
impl Vector for Avx2 {
    type Single = Avx2Single;

    #[inline(always)]
    fn call<K: Kernel>(kernel: K) -> K::Output {
        unsafe { with_avx2(kernel) }
    }
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
    fn over(self, other: Self) -> Self {
        unsafe { Self(_mm256_div_pd(self.0, other.0), _mm256_div_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn root(self) -> Self {
        unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }
    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        unsafe { Self(_mm256_max_pd(self.0, other.0), _mm256_max_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn where_above(self, x: Self, bound: Self, otherwise: Self) -> Self {
        unsafe {
            Self(
                _mm256_blendv_pd(otherwise.0, self.0, _mm256_cmp_pd::<_CMP_GT_OQ>(x.0, bound.0)),
                _mm256_blendv_pd(otherwise.1, self.1, _mm256_cmp_pd::<_CMP_GT_OQ>(x.1, bound.1)),
            )
        }
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
    #[inline(always)]
    fn above(self, bound: Self) -> u32 {
        unsafe {
            let above = |x, bound| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(x, bound)) as u32;
            above(self.0, bound.0) | above(self.1, bound.1) << 4
        }
    }
}

impl Vector for Avx512 {
    type Single = Avx512Single;

    #[inline(always)]
    fn call<K: Kernel>(kernel: K) -> K::Output {
        unsafe { with_avx512(kernel) }
    }
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
    fn over(self, other: Self) -> Self {
        unsafe { Self(_mm512_div_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn root(self) -> Self {
        unsafe { Self(_mm512_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        unsafe { Self(_mm512_max_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn where_above(self, x: Self, bound: Self, otherwise: Self) -> Self {
        unsafe {
            let above = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(x.0, bound.0);
            Self(_mm512_mask_mov_pd(otherwise.0, above, self.0))
        }
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
    fn swapped(self) -> Self {
        unsafe { Self(_mm512_permute_pd::<0b0101_0101>(self.0)) }
    }
    #[inline(always)]
    fn any_beyond(self, bound: Self) -> bool {
        unsafe { _mm512_cmp_pd_mask::<_CMP_NLE_UQ>(_mm512_abs_pd(self.0), bound.0) != 0 }
    }
    #[inline(always)]
    fn above(self, bound: Self) -> u32 {
        unsafe { u32::from(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, bound.0)) }
    }
}

impl Single for Avx2Single {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        unsafe { Self(_mm256_set1_ps(x), _mm256_set1_ps(x)) }
    }
    #[inline(always)]
    fn load(from: &[f32; 16]) -> Self {
        unsafe { Self(_mm256_loadu_ps(from.as_ptr()), _mm256_loadu_ps(from.as_ptr().add(8))) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 16]) {
        unsafe {
            _mm256_storeu_ps(to.as_mut_ptr(), self.0);
            _mm256_storeu_ps(to.as_mut_ptr().add(8), self.1);
        }
    }
    #[inline(always)]
    fn round(from: &[f64; 16]) -> Self {
        unsafe {
            let four = |first: usize| _mm256_cvtpd_ps(_mm256_loadu_pd(from.as_ptr().add(first)));
            Self(_mm256_set_m128(four(4), four(0)), _mm256_set_m128(four(12), four(8)))
        }
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        unsafe { Self(_mm256_add_ps(self.0, other.0), _mm256_add_ps(self.1, other.1)) }
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        unsafe { Self(_mm256_sub_ps(self.0, other.0), _mm256_sub_ps(self.1, other.1)) }
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        unsafe { Self(_mm256_mul_ps(self.0, other.0), _mm256_mul_ps(self.1, other.1)) }
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        unsafe { Self(_mm256_div_ps(self.0, other.0), _mm256_div_ps(self.1, other.1)) }
    }
    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        unsafe { Self(_mm256_fmadd_ps(a.0, b.0, self.0), _mm256_fmadd_ps(a.1, b.1, self.1)) }
    }
    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        unsafe { Self(_mm256_fnmadd_ps(a.0, b.0, self.0), _mm256_fnmadd_ps(a.1, b.1, self.1)) }
    }
    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        unsafe { Self(_mm256_max_ps(self.0, other.0), _mm256_max_ps(self.1, other.1)) }
    }
    #[inline(always)]
    fn taken(self, from: &[i32; 16]) -> Self {
        unsafe {
            let half = |first: usize| {
                let from = _mm256_loadu_si256(from.as_ptr().add(first).cast());
                let low = _mm256_permutevar8x32_ps(self.0, from);
                let high = _mm256_permutevar8x32_ps(self.1, from);
                // The sign bit chooses: 8 to 15 are in the upper half.
                let upper = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(from));
                _mm256_blendv_ps(low, high, upper)
            };
            Self(half(0), half(8))
        }
    }
    #[inline(always)]
    fn spread<const K: usize>(self) -> Self {
        self.spread_two::<K, K>()
    }
    #[inline(always)]
    fn spread_two<const J: usize, const K: usize>(self) -> Self {
        unsafe {
            let lane = |half: usize| if half < 8 { self.0 } else { self.1 };
            let at = |k: usize| _mm256_set1_epi32((k % 8) as i32);
            Self(
                _mm256_permutevar8x32_ps(lane(J), at(J)),
                _mm256_permutevar8x32_ps(lane(K), at(K)),
            )
        }
    }
}

impl Single for Avx512Single {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        unsafe { Self(_mm512_set1_ps(x)) }
    }
    #[inline(always)]
    fn load(from: &[f32; 16]) -> Self {
        unsafe { Self(_mm512_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 16]) {
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn round(from: &[f64; 16]) -> Self {
        unsafe {
            let eight = |first: usize| _mm512_cvtpd_ps(_mm512_loadu_pd(from.as_ptr().add(first)));
            let low = _mm512_castpd256_pd512(_mm256_castps_pd(eight(0)));
            let both = _mm512_insertf64x4::<1>(low, _mm256_castps_pd(eight(8)));
            Self(_mm512_castpd_ps(both))
        }
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        unsafe { Self(_mm512_add_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        unsafe { Self(_mm512_sub_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        unsafe { Self(_mm512_mul_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        unsafe { Self(_mm512_div_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn plus_product(self, a: Self, b: Self) -> Self {
        unsafe { Self(_mm512_fmadd_ps(a.0, b.0, self.0)) }
    }
    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        unsafe { Self(_mm512_fnmadd_ps(a.0, b.0, self.0)) }
    }
    #[inline(always)]
    fn largest(self, other: Self) -> Self {
        unsafe { Self(_mm512_max_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn taken(self, from: &[i32; 16]) -> Self {
        unsafe { Self(_mm512_permutexvar_ps(_mm512_loadu_si512(from.as_ptr().cast()), self.0)) }
    }
    #[inline(always)]
    fn spread<const K: usize>(self) -> Self {
        unsafe { Self(_mm512_permutexvar_ps(_mm512_set1_epi32(K as i32), self.0)) }
    }
    #[inline(always)]
    fn spread_two<const J: usize, const K: usize>(self) -> Self {
        unsafe {
            let (low, high) = (_mm512_set1_epi32(J as i32), _mm512_set1_epi32(K as i32));
            Self(_mm512_permutexvar_ps(
                _mm512_mask_blend_epi32(0xff00, low, high),
                self.0,
            ))
        }
    }
}
