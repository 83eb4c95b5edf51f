//! Whether several plausible tools should share the vectors of one elimination:
//! `cargo bench --package flexdrill-benches --bench lanes`.
//!
//! A tool has the columns of a block in the lanes of a vector. The other layout has one entry of the blocks of eight or
//! sixteen tools in the lanes. It needs no work that nothing reads: later rows are reduced only (LU), where a vector over
//! the rows reduces all others (Gauss-Jordan). This program times that layout on chains of the default tool's size, and
//! the corrections of the default tool itself, which know its zeros. A layout that is not much faster here is not worth a
//! step that is written for all tools at once: contacts open and steps are halved in one tool and not in another.

#![expect(
    unsafe_code,
    reason = "code compiled for vector instructions, behind a check that the processor has them"
)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    reason = "a program of measurements fails by panicking"
)]
#![allow(
    clippy::needless_range_loop,
    reason = "rows, columns and lanes are indices of the algebra"
)]

use std::hint::black_box;
use std::time::Instant;

use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::dynamics::phases::Phase;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use flexdrill_realtime::monotonic;

/// Nodes of the default tool.
const NODES: usize = 34;
/// Unknowns of a node without those that follow from others, and the size of a column in the lanes.
const UNKNOWNS: usize = 14;
const ROWS: usize = 16;
/// Unknowns that couple neighbours; with the right-hand side these are the columns that a block is solved for.
const COUPLED: usize = 12;
const COLUMNS: usize = COUPLED + 1;
/// Best of so many trials: neighbours and frequency changes only take away.
const TRIALS: usize = 200;

/// A block with its coupling and right-hand side, by columns: those of the block, of the coupling, of the right-hand side.
type Turn = [[f32; ROWS]; UNKNOWNS + COLUMNS];
/// The same of `L` tools, by rows.
type Lanes<const L: usize> = [[[f32; L]; UNKNOWNS + COLUMNS]; UNKNOWNS];

/// Numbers between -1 and 1 that are the same in every run (a linear congruence, Knuth's constants).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1_u64 << 23) as f32 - 1.0
    }
}

/// Chains of blocks with a dominant diagonal, in both layouts; the same numbers in both.
fn systems<const L: usize>() -> (Vec<Vec<Turn>>, Vec<Lanes<L>>) {
    let mut numbers = Numbers(1);
    let turn: Vec<Vec<Turn>> = (0..L)
        .map(|_| {
            let block = |_| {
                let mut block = [[0.0; ROWS]; UNKNOWNS + COLUMNS];
                for (j, column) in block.iter_mut().enumerate() {
                    for (i, entry) in column[..UNKNOWNS].iter_mut().enumerate() {
                        *entry = 0.1 * numbers.next() + if i == j { 4.0 } else { 0.0 };
                    }
                }
                block
            };
            (0..NODES).map(block).collect()
        })
        .collect();
    let lanes = (0..NODES)
        .map(|node| {
            let mut out = [[[0.0; L]; UNKNOWNS + COLUMNS]; UNKNOWNS];
            for (i, row) in out.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    for (lane, value) in entry.iter_mut().enumerate() {
                        *value = turn[lane][node][j][i];
                    }
                }
            }
            out
        })
        .collect();
    (turn, lanes)
}

/// `to - a b`, rounded once.
#[inline(always)]
fn minus_product<const L: usize>(to: [f32; L], a: [f32; L], b: [f32; L]) -> [f32; L] {
    std::array::from_fn(|k| (-a[k]).mul_add(b[k], to[k]))
}

/// Eliminates one chain: D^-1 (U, r) of each node, the next block less U^T D^-1 (U, r).
#[inline(always)]
fn in_turn(chain: &[Turn], sum: &mut f32) {
    let mut carry = [[0.0; ROWS]; COLUMNS];
    for block in chain {
        let mut a = *block;
        // What the node above leaves.
        for j in 0..COUPLED {
            a[j] = std::array::from_fn(|i| a[j][i] - carry[j][i]);
        }
        a[UNKNOWNS + COUPLED] = std::array::from_fn(|i| a[UNKNOWNS + COUPLED][i] - carry[COUPLED][i]);
        let mut inverse = [0.0; ROWS];
        for pivot in 0..UNKNOWNS {
            let reciprocal = 1.0 / a[pivot][pivot];
            inverse[pivot] = reciprocal;
            let mut by: [f32; ROWS] = std::array::from_fn(|i| a[pivot][i] * reciprocal);
            by[pivot] = 0.0;
            for column in &mut a[pivot + 1..] {
                *column = minus_product(*column, by, [column[pivot]; ROWS]);
            }
        }
        for (to, column) in carry.iter_mut().zip(&a[UNKNOWNS..]) {
            let solved: [f32; ROWS] = std::array::from_fn(|i| column[i] * inverse[i]);
            *to = [0.0; ROWS];
            // The coupling below is the transpose of that above.
            for (j, coupling) in block[UNKNOWNS..UNKNOWNS + COUPLED].iter().enumerate() {
                *to = minus_product(*to, *coupling, [-solved[j]; ROWS]);
            }
        }
    }
    *sum += carry[COUPLED][0];
}

/// The same of all chains at once.
#[inline(always)]
fn in_lanes<const L: usize>(chain: &[Lanes<L>], sum: &mut f32) {
    let mut carry = [[[0.0; L]; COLUMNS]; UNKNOWNS];
    for block in chain {
        let mut a = *block;
        for i in 0..UNKNOWNS {
            for j in 0..COUPLED {
                a[i][j] = std::array::from_fn(|k| a[i][j][k] - carry[i][j][k]);
            }
            let right = UNKNOWNS + COUPLED;
            a[i][right] = std::array::from_fn(|k| a[i][right][k] - carry[i][COUPLED][k]);
        }
        // Down: later rows only.
        for pivot in 0..UNKNOWNS {
            let reciprocal: [f32; L] = a[pivot][pivot].map(|x| 1.0 / x);
            a[pivot][pivot] = reciprocal;
            let (above, below) = a.split_at_mut(pivot + 1);
            let row = &above[pivot];
            for later in below {
                let by = std::array::from_fn(|k| later[pivot][k] * reciprocal[k]);
                for j in pivot + 1..UNKNOWNS + COLUMNS {
                    later[j] = minus_product(later[j], by, row[j]);
                }
            }
        }
        // Up: the columns that are solved for.
        for pivot in (0..UNKNOWNS).rev() {
            for j in UNKNOWNS..UNKNOWNS + COLUMNS {
                let mut x = a[pivot][j];
                for c in pivot + 1..UNKNOWNS {
                    x = minus_product(x, a[pivot][c], a[c][j]);
                }
                a[pivot][j] = std::array::from_fn(|k| x[k] * a[pivot][pivot][k]);
            }
        }
        for i in 0..UNKNOWNS {
            for j in 0..COLUMNS {
                let mut x = [0.0; L];
                for c in 0..COUPLED {
                    x = minus_product(x, block[i][UNKNOWNS + c], a[c][UNKNOWNS + j].map(|y| -y));
                }
                carry[i][j] = x;
            }
        }
    }
    *sum += carry[0][COUPLED].iter().sum::<f32>();
}

/// Best time of `work` in microseconds per tool, and what it gave.
fn best(tools: usize, work: impl Fn(&mut f32)) -> (f64, f32) {
    let (mut best, mut value) = (f64::INFINITY, 0.0);
    for _ in 0..TRIALS {
        let began = Instant::now();
        value = 0.0;
        work(&mut value);
        best = best.min(began.elapsed().as_secs_f64());
        black_box(value);
    }
    (best * 1e6 / tools as f64, value)
}

/// Solves the systems of `L` tools together; checks one against the elimination in turn.
fn report<const L: usize>(name: &str, together: impl Fn(&[Lanes<L>], &mut f32)) {
    let (turn, lanes) = systems::<L>();
    let (took, value) = best(L, |sum| together(black_box(&lanes), sum));
    let mut expected = 0.0;
    for chain in &turn {
        in_turn(chain, &mut expected);
    }
    // Sums of `L` numbers in single precision, of systems with a condition near one.
    assert!(
        (value - expected).abs() < 1e-4 * (1.0 + expected.abs()),
        "{value} is not {expected}"
    );
    println!("{L:>2} tools in the lanes of {name:<8} {took:>6.2} us per tool and correction");
}

/// What a correction of the default tool takes in its phase `solve`, with the widest vectors that the processor has.
fn of_the_product() {
    let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../config/default.yaml"))
        .and_then(|config| config.with_value("inputs.weight_on_bit.initial_kn", 10.0))
        .expect("the shipped configuration");
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).expect("a tool that can be built");
    simulation.set_clock(monotonic::processor_time);
    let inputs = Inputs {
        rotary_speed: 4.19,
        weight_on_bit: 10e3,
        ..Inputs::ZERO
    };
    let mut corrections = 0;
    let mut run = |steps: u32| {
        for _ in 0..steps {
            match simulation.advance(&inputs) {
                StepOutcome::Advanced { iterations, .. } => corrections += iterations,
                other => panic!("{other:?}"),
            }
        }
        (simulation.phase_times(), corrections)
    };
    let (before, first) = run(4000);
    let (after, last) = run(4000);
    let took = after.since(&before).of(Phase::Solve) as f64 * 1e-3 / f64::from(last - first);
    println!("the default tool, one by one        {took:>6.2} us per correction; the third and later ones are partial");
}

/// The layout compiled for one set of instructions.
macro_rules! compiled_for {
    ($name:ident, $features:literal) => {
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = $features)]
        fn $name<const L: usize>(chain: &[Lanes<L>], sum: &mut f32) {
            in_lanes(chain, sum);
        }
    };
}
compiled_for!(avx2, "avx2,fma");
compiled_for!(avx512, "avx512f,avx2,fma");

fn main() {
    of_the_product();
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor has what the function needs.
            report::<8>("AVX2", |chain, sum| unsafe { avx2(chain, sum) });
        }
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: as above.
            report::<16>("AVX-512", |chain, sum| unsafe { avx512(chain, sum) });
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    println!("the other layout is compiled for AVX2 and AVX-512 only");
}
