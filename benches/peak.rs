//! The most floating-point operations that one core does per second, to hold the solver's figures against:
//! `cargo bench --package flexdrill-benches --bench peak`.
//!
//! A loop of independent fused multiply-adds in registers, for every vector width that the processor has. Two
//! operations each.

#![expect(
    unsafe_code,
    reason = "vector instructions, behind a check that the processor has them"
)]

use std::time::{Duration, Instant};

/// Rounds of a loop between two looks at the clock.
const ROUNDS: u64 = 1 << 20;
/// Best of so many trials: neighbours and frequency changes only take away.
const TRIALS: u32 = 10;

fn main() {
    println!("width     GFLOP/s");
    report("scalar", scalar);
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor has what the function needs.
            report("AVX2", || unsafe { x86::avx2() });
        }
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: as above.
            report("AVX-512", || unsafe { x86::avx512() });
        }
    }
}

/// `work` does a number of operations and gives it, with a value that depends on all of them.
fn report(name: &str, work: impl Fn() -> (u64, f64)) {
    let mut best = f64::INFINITY;
    let mut operations = 0;
    for _ in 0..TRIALS {
        let began = Instant::now();
        let (done, value) = work();
        let took: Duration = began.elapsed();
        std::hint::black_box(value);
        operations = done;
        best = best.min(took.as_secs_f64());
    }
    println!("{name:<9} {:.1}", operations as f64 / best * 1e-9);
}

/// Sums kept at once: enough to hide the latency of the multiply-add (4 cycles, 2 units) with room.
const CHAINS: usize = 16;

/// What the compiler makes of plain code for the oldest processor it builds for: a multiplication and an addition.
fn scalar() -> (u64, f64) {
    let mut sums = [1.0_f64; CHAINS];
    let (a, b) = (std::hint::black_box(0.999_999), std::hint::black_box(1e-6));
    for _ in 0..ROUNDS {
        for sum in &mut sums {
            *sum = *sum * a + b;
        }
    }
    (2 * ROUNDS * CHAINS as u64, sums.iter().sum())
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::{
        _mm256_fmadd_pd, _mm256_set1_pd, _mm256_storeu_pd, _mm512_fmadd_pd, _mm512_reduce_add_pd, _mm512_set1_pd,
    };

    use super::{CHAINS, ROUNDS};

    #[target_feature(enable = "avx2,fma")]
    pub fn avx2() -> (u64, f64) {
        // Twelve of the sixteen registers hold sums.
        const SUMS: usize = 12;
        let mut sums = [_mm256_set1_pd(1.0); SUMS];
        let (a, b) = (
            _mm256_set1_pd(std::hint::black_box(0.999_999)),
            _mm256_set1_pd(std::hint::black_box(1e-6)),
        );
        for _ in 0..ROUNDS {
            for sum in &mut sums {
                *sum = _mm256_fmadd_pd(*sum, a, b);
            }
        }
        let mut total = 0.0;
        for sum in sums {
            let mut lanes = [0.0; 4];
            // SAFETY: `lanes` has room for the four values.
            unsafe { _mm256_storeu_pd(lanes.as_mut_ptr(), sum) };
            total += lanes.iter().sum::<f64>();
        }
        (2 * 4 * ROUNDS * SUMS as u64, total)
    }

    #[target_feature(enable = "avx512f")]
    pub fn avx512() -> (u64, f64) {
        let mut sums = [_mm512_set1_pd(1.0); CHAINS];
        let (a, b) = (
            _mm512_set1_pd(std::hint::black_box(0.999_999)),
            _mm512_set1_pd(std::hint::black_box(1e-6)),
        );
        for _ in 0..ROUNDS {
            for sum in &mut sums {
                *sum = _mm512_fmadd_pd(*sum, a, b);
            }
        }
        let total = sums.iter().map(|&sum| _mm512_reduce_add_pd(sum)).sum();
        (2 * 8 * ROUNDS * CHAINS as u64, total)
    }
}
