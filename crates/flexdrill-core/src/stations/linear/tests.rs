//! Every path of block LU gives what the reference gives, on random systems with joints of every kind.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::{BlockLu, BlockSystem, LinearSolver, SparseReference};
use crate::model::layout::Layout;
use crate::support::Random;

/// Any rotation.
fn frame(random: &mut Random) -> Matrix3<f64> {
    *Rotation3::new(Vector3::new(random.next(), random.next(), random.next())).matrix()
}

/// What stands at a large station.
#[derive(Clone, Copy, PartialEq)]
enum Joint {
    /// One rotational row: universal and ball-cage joints.
    OneRow,
    /// Two rotational rows: hinges.
    TwoRows,
    /// The axial tie of pipe and guide.
    Tie,
}

/// Rows whose diagonal outweighs the rest, so that the condition is mild; constraint rows as the assembly makes them.
fn system(joints: &[Option<Joint>], seed: u64) -> BlockSystem {
    let mut random = Random(seed);
    let layout = Layout::new(joints.iter().map(Option::is_some));
    let mut system = BlockSystem::new(layout);
    for (station, &joint) in joints.iter().enumerate() {
        let nodes = if matches!(joint, Some(Joint::OneRow | Joint::TwoRows)) {
            18
        } else {
            12
        };
        for column in 0..nodes {
            for row in 0..nodes {
                let dominant = if row == column { 20.0 } else { 0.0 };
                system.add(station, row, column, random.next() + dominant);
            }
        }
        let mut both = |row, column, value| {
            system.add(station, row, column, value);
            system.add(station, column, row, value);
        };
        if joint == Some(Joint::Tie) {
            both(18, 0, 7.0);
            both(18, 6, -7.0);
        } else if joint.is_some() {
            let (a, b) = (frame(&mut random) * 7.0, frame(&mut random) * -7.0);
            for i in 0..3 {
                for j in 0..3 {
                    both(18 + i, j, a[(i, j)]);
                    both(18 + i, 12 + j, b[(i, j)]);
                }
            }
            let rows = if joint == Some(Joint::OneRow) { 1 } else { 2 };
            for row in 0..rows {
                for k in 0..3 {
                    // The second row leans on another rotation than the first.
                    let lean = |at: usize| if at == row { 3.0 } else { 0.0 };
                    both(21 + row, 3 + k, lean(k) + random.next());
                    both(21 + row, 15 + k, random.next());
                }
            }
        }
        if let Some(joint) = joint {
            let offset = system.layout().offset(station);
            let padding = match joint {
                Joint::OneRow => vec![22, 23],
                Joint::TwoRows => vec![23],
                Joint::Tie => (12..24).filter(|&k| k != 18).collect(),
            };
            padding.into_iter().for_each(|k| system.hold(offset + k));
        }
        if station + 1 < joints.len() {
            for coupling in [&mut system.upper[station], &mut system.lower[station]] {
                for part in [&mut coupling.pipe, &mut coupling.guide] {
                    part.iter_mut().for_each(|x| *x = random.next());
                }
            }
        }
    }
    system
}

/// Compares the block LU with the reference.
fn compare(system: &BlockSystem, seed: u64) {
    let mut random = Random(seed);
    let rhs: Vec<f64> = (0..system.layout().unknowns()).map(|_| random.next()).collect();
    let mut expected = rhs.clone();
    SparseReference::default().solve(system, &mut expected).unwrap();
    let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut solver = BlockLu::new(system.layout());
    let mut x = rhs;
    solver.solve(system, &mut x).unwrap();
    for (i, (x, expected)) in x.iter().zip(&expected).enumerate() {
        // 1e-9 relative is what a step is promised; condition numbers of 1e3 leave 1e-12.
        assert!((x - expected).abs() < 1e-9 * scale, "x[{i}] = {x} against {expected}");
    }
}

#[test]
fn joints_of_every_kind() {
    use Joint::{OneRow, Tie, TwoRows};
    for joints in [
        vec![None; 6],
        vec![None, Some(OneRow), None, None, Some(OneRow), None],
        vec![None, Some(OneRow), Some(OneRow), Some(OneRow), None, Some(Tie)],
        vec![None, Some(TwoRows), None, Some(OneRow), Some(TwoRows), None, None],
        vec![Some(Tie)],
    ] {
        for seed in 0..20 {
            compare(&system(&joints, seed), seed + 100);
        }
    }
}

#[test]
fn supports_at_joints() {
    use Joint::OneRow;
    let joints = [None, Some(OneRow), None, Some(OneRow), None];
    for local in [1, 4, 7, 16, 13] {
        for seed in 0..5 {
            let mut system = system(&joints, seed);
            let unknown = system.layout().offset(1) + local;
            system.hold(unknown);
            compare(&system, seed + 200);
        }
    }
}

#[test]
fn blocks_without_a_diagonal() {
    // Stations whose diagonal blocks are cyclic: every pivot needs an exchange.
    for seed in 0..10 {
        let mut system = system(&[None; 5], seed);
        for block in &mut system.diagonal.plain {
            let turned = *block;
            for column in 0..12 {
                block.set_column((column + 5) % 12, &turned.column(column));
            }
        }
        compare(&system, seed + 300);
    }
}
