//! Every path of the station elimination and of the condensed one gives what the reference gives, on random systems
//! with joints of every kind.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::{
    BlockLu, BlockSystem, CondensedElimination, CondensedSystem, Layout, LinearSolver, SparseReference,
    TangentIncrement, Touching,
};
use crate::simd::Instructions;

/// Deterministic values in -1..1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
    }

    fn frame(&mut self) -> Matrix3<f64> {
        *Rotation3::new(Vector3::new(self.next(), self.next(), self.next())).matrix()
    }
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
    let layout = Layout::new(joints.iter().map(Option::is_some).collect());
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
            let (a, b) = (random.frame() * 7.0, random.frame() * -7.0);
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

/// Compares the block LU, with all instructions that this machine has, with the reference.
fn compare(system: &BlockSystem, seed: u64) {
    let mut random = Random(seed);
    let rhs: Vec<f64> = (0..system.layout().unknowns()).map(|_| random.next()).collect();
    let mut expected = rhs.clone();
    SparseReference::default().solve(system, &mut expected).unwrap();
    let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for instructions in Instructions::available() {
        let mut solver = BlockLu::new(system.layout(), instructions);
        let mut x = rhs.clone();
        solver.solve(system, &mut x).unwrap();
        for (i, (x, expected)) in x.iter().zip(&expected).enumerate() {
            // 1e-9 relative is what a step is promised; condition numbers of 1e3 leave 1e-12.
            assert!(
                (x - expected).abs() < 1e-9 * scale,
                "{instructions}: x[{i}] = {x} against {expected}"
            );
        }
        // Determinism: the same bits again, with the room used before.
        let mut again = rhs.clone();
        solver.solve(system, &mut again).unwrap();
        assert!(x == again, "{instructions} gave different bits");
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

/// Makes a system of [`system`] one that lasts: no rotational rows, and each body coupled with itself only. What
/// couples bodies belongs to what an iteration adds.
fn step_constant(joints: &[Option<Joint>], places: &[usize], seed: u64) -> BlockSystem {
    let mut system = system(joints, seed);
    for station in 0..joints.len() {
        let nodes = if places.contains(&station) { 18 } else { 12 };
        for row in 0..nodes {
            for column in 0..nodes {
                if row / 6 != column / 6 {
                    *system.entry(station, row, column) = 0.0;
                }
            }
        }
    }
    for &station in places {
        for k in [3, 4, 5, 15, 16, 17] {
            *system.entry(station, 21, k) = 0.0;
            *system.entry(station, k, 21) = 0.0;
        }
    }
    system
}

/// Random contacts and joints: per station nothing, the guide or both, as `touching` says.
fn increment(layout: &Layout, joints: &[usize], touching: &[Touching], held: &[usize], seed: u64) -> TangentIncrement {
    let mut random = Random(seed);
    let mut increment = TangentIncrement::new(layout, joints.len(), 1, held.iter().copied());
    increment.touching.copy_from_slice(touching);
    for (block, touching) in increment.contact.iter_mut().zip(touching) {
        let first = match touching {
            // What a block holds where nothing touches must not matter.
            Touching::Nothing => {
                *block = [[1e9; 12]; 12];
                continue;
            }
            Touching::Guide => 6,
            Touching::Both => 0,
        };
        *block = [[0.0; 12]; 12];
        for column in &mut block[first..] {
            column[first..].iter_mut().for_each(|x| *x = random.next());
        }
    }
    for joint in &mut increment.joints {
        joint.rotations.iter_mut().flatten().for_each(|x| *x = random.next());
        for k in 0..6 {
            joint.rows[0][k] = random.next() + if k % 3 == 0 { 3.0 } else { 0.0 };
        }
    }
    increment.drop_held();
    increment
}

#[test]
fn condensed_links() {
    use Joint::{OneRow, Tie};
    use Touching::{Both, Guide, Nothing};
    let one = Some(OneRow);
    let plain: [Option<Joint>; 3] = [None; 3];
    // Top, three inner stations per link, joints; free, or tied at the bottom; two joints next to each other; no joint
    // at all.
    let link = |end| [plain.as_slice(), &[end]].concat();
    let free = [vec![None], link(one), link(one), link(one), link(None)].concat();
    let tied = [vec![None], link(one), link(one), link(one), link(Some(Tie))].concat();
    let long = [vec![None], [plain.as_slice(), &[one]].concat().repeat(20), link(None)].concat();
    let dense = vec![None, one, one, None, one, None, None, None, None, None, one, None];
    for (joints, held) in [
        (free.clone(), vec![]),
        // A support inside a link, the guide's at a joint, and at both ends.
        (free, vec![(2, 1), (4, 7), (0, 0), (0, 3), (16, 1), (16, 8)]),
        (tied, vec![(0, 0)]),
        (long, vec![(2, 1), (0, 0)]),
        (dense, vec![]),
        (vec![None; 5], vec![]),
    ] {
        let places: Vec<usize> = (0..joints.len()).filter(|&s| joints[s] == one).collect();
        let mut counted = [0; 3];
        for seed in 0..20 {
            let mut step_constant = step_constant(&joints, &places, seed);
            let unknowns: Vec<usize> = held
                .iter()
                .map(|&(s, k)| step_constant.layout().offset(s) + k)
                .collect();
            unknowns.iter().for_each(|&unknown| step_constant.hold(unknown));
            let mut random = Random(seed + 500);
            let touching: Vec<Touching> = joints
                .iter()
                .map(|_| match random.next() {
                    x if x < 0.2 => Nothing,
                    x if x < 0.85 => Guide,
                    _ => Both,
                })
                .collect();
            let increment = increment(step_constant.layout(), &places, &touching, &unknowns, seed + 600);
            let mut full = step_constant.clone();
            increment.add_to(&mut full);
            let rhs: Vec<f64> = (0..full.layout().unknowns()).map(|_| random.next()).collect();
            let mut expected = rhs.clone();
            SparseReference::default().solve(&full, &mut expected).unwrap();
            let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let condensed = CondensedSystem::of(step_constant.clone(), &places).unwrap();
            for instructions in Instructions::available() {
                let mut solver = CondensedElimination::new(step_constant.layout(), &places, instructions);
                let mut x = rhs.clone();
                solver.solve(&condensed, &increment, &mut x).unwrap();
                for (i, (x, expected)) in x.iter().zip(&expected).enumerate() {
                    // As for the other paths.
                    assert!(
                        (x - expected).abs() < 1e-9 * scale,
                        "{instructions}, seed {seed}: x[{i}] = {x} against {expected}"
                    );
                }
                let mut again = rhs.clone();
                solver.solve(&condensed, &increment, &mut again).unwrap();
                assert!(x == again, "{instructions} gave different bits");
                counted
                    .iter_mut()
                    .zip(solver.span_counts())
                    .for_each(|(sum, n)| *sum += n);
            }
        }
        assert!(counted[1] > 0 && counted[2] > 0, "spans of one kind only: {counted:?}");
    }
}

#[test]
fn what_does_not_have_the_form_is_not_condensed() {
    use Joint::{OneRow, TwoRows};
    let hinges = step_constant(&[None, None, Some(TwoRows), None, None], &[2], 1);
    assert!(CondensedSystem::of(hinges, &[2]).is_none());
    let made = || step_constant(&[None, None, Some(OneRow), None, None], &[2], 1);
    assert!(CondensedSystem::of(made(), &[2]).is_some());
    let mut held = made();
    held.hold(held.layout().offset(2) + 13);
    assert!(CondensedSystem::of(held, &[2]).is_none());
    // Pipe and guide coupled by what is said to last: inside a link, and at the start below a joint.
    for (station, row, column) in [(1, 2, 8), (1, 8, 2), (2, 13, 7), (2, 7, 16)] {
        let mut coupled = made();
        coupled.add(station, row, column, 1.0);
        assert!(
            CondensedSystem::of(coupled, &[2]).is_none(),
            "entry {row}, {column} of station {station}"
        );
    }
}
