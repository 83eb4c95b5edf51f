//! What must not change anything, over the rows of the covering array: a frictionless wall passes weight by gravity
//! alone, a pump changes no wall force, a longer string no steady figure, and twice every mass, force and stiffness no
//! motion. No key turns the plane of the hole about the vertical, so that there is nothing to hold for it.
//!
//! All runs stand without friction, so that their equilibrium does not depend on how they came to it.

use std::sync::Mutex;

use flexdrill::bag;
use flexdrill::messages::{BitState, JointDeflections, Reactions};

use super::covering::{self, GUIDE, PRESSURE, ROCK, Row, SPINE, STRING};
use super::tool::{Variant, WEIGHT, yaml};
use super::{Phase, check, judge, record, spread};
use crate::common::python;

/// Standing without friction of any kind.
const SMOOTH: Variant = Variant {
    rubs: false,
    pressure: None,
    string: 600.0,
    scale: 1.0,
};

/// A hoist needs eight of its response times of 1 s, and the window of the means 6 s; all others begin at rest, and move for a
/// second at most: a weight at the kick-off settles by e in 0.13 s, and an equilibrium in the plane of the hole may be
/// unstable.
fn standing(row: &Row) -> Vec<Phase> {
    let seconds = if row[ROCK] == 2 { 20 } else { 4 };
    vec![(seconds, 0.0, WEIGHT / 1e3, 0.0)]
}

/// Forces from outside at the end of a run, mean over the last half second (N).
#[derive(Debug, Default, Clone, Copy)]
struct Outside {
    wall: [f64; 3],
    /// On both pipes together, the string's pull included.
    supports: [f64; 3],
    bit: f64,
}

impl Outside {
    fn of(path: &std::path::Path) -> Self {
        let (mut reactions, mut bits) = (Vec::<Reactions>::new(), Vec::<BitState>::new());
        for message in bag::open(path).unwrap() {
            let message = message.unwrap();
            if message.topic.is("twin/reactions") {
                reactions.push(message.decode().unwrap());
            } else if message.topic.is("twin/bit_state") {
                bits.push(message.decode().unwrap());
            }
        }
        // 10 samples at 20 Hz.
        let last = &reactions[reactions.len() - 10..];
        let mean = |of: fn(&Reactions) -> [f64; 3]| {
            std::array::from_fn(|k| last.iter().map(|sample| of(sample)[k]).sum::<f64>() / last.len() as f64)
        };
        let bits = &bits[bits.len() - 10..];
        Self {
            wall: mean(|sample| sample.wall_force),
            supports: mean(|sample| sample.support_force),
            bit: bits.iter().map(|sample| sample.weight_on_bit).sum::<f64>() / bits.len() as f64,
        }
    }

    /// Largest difference of any force (N), after `factor` on the other.
    fn distance(&self, other: &Self, factor: f64) -> f64 {
        let forces = |of: &Self| {
            [
                of.wall[0],
                of.wall[1],
                of.wall[2],
                of.supports[0],
                of.supports[2],
                of.bit,
            ]
        };
        let pairs = forces(self).into_iter().zip(forces(other));
        pairs
            .map(|(one, other)| (one - factor * other).abs())
            .fold(0.0, f64::max)
    }
}

/// Pressure of the pump (Pa).
const PUMP: f64 = 2e6;
/// Clearance between pipe and guide, length of a link and of its three elements, and distance of a spine from the axis (m), of
/// `tool.rs`.
const INNER_CLEARANCE: f64 = 8.5e-3;
const LINK: f64 = 1.2566 / 8.0;
const ELEMENT: f64 = LINK / 3.0;
const OFFSET: f64 = 0.04;

/// Force (N) by which the pump compresses the pipe against the guide: p A_s in a seal, (1 - 2 nu) p A_i where both ends are
/// tied.
fn compression(row: &Row) -> f64 {
    let disc = |diameter: f64| 0.25 * std::f64::consts::PI * diameter * diameter;
    match row[PRESSURE] {
        2 => PUMP * disc(0.063),
        3 if row[GUIDE] > 0 => PUMP * 0.4 * disc(0.032),
        _ => 0.0,
    }
}

fn run(row: &Row, name: &str, variant: &Variant, folder: &std::path::Path, phases: &[Phase]) -> std::path::PathBuf {
    record(folder, name, &yaml(row, variant), phases).unwrap_or_else(|said| panic!("{}: {said}", covering::name(row)))
}

/// The in-plane moment about the arc's centre without friction: kick-off less bit is what gravity asks for.
#[test]
fn a_frictionless_wall_passes_weight_by_gravity_alone() {
    if python::with("rosbags").is_none() {
        return;
    }
    let rows = covering::rows();
    let violations = Mutex::new(Vec::new());
    spread(rows.len(), |index| {
        let row = &rows[index];
        let of = format!("row {index} ({}), without friction", covering::name(row));
        let folder = tempfile::tempdir().unwrap();
        let bag = run(row, "run", &SMOOTH, folder.path(), &standing(row));
        judge(&bag, &of, 1, &violations);
    });
    check(violations);
}

/// Rows with pressure. The pump acts between pipe, string and the guide's connector. A pipe that it compresses is centred at
/// both ends and lies at the edge of the inner clearance c from the first joint on: links of length L turn the force F by c / L
/// there, and the guide takes 2 F c / L across the hole. The guide is pulled by as much; where its spine lies e off its axis,
/// this bends it by the couple e F, which its top and the wall take as two forces, an element apart or more.
#[test]
fn a_pump_changes_no_wall_force() {
    let rows: Vec<Row> = covering::rows().into_iter().filter(|row| row[PRESSURE] > 0).collect();
    let across = |row: &Row| {
        let spine = if row[SPINE] > 0 { OFFSET / ELEMENT } else { 0.0 };
        compression(row) * (2.0 * INNER_CLEARANCE / LINK + spine)
    };
    compare(&rows, "pump", 1e-3, across, 1.0, |row, name, folder| {
        let pressure = Some(if name == "one" { 0.0 } else { PUMP });
        run(row, name, &Variant { pressure, ..SMOOTH }, folder, &standing(row))
    });
}

/// Rows with a string: three times the length gives the same figures.
#[test]
fn a_longer_string_changes_no_steady_figure() {
    let rows: Vec<Row> = covering::rows().into_iter().filter(|row| row[STRING] > 0).collect();
    compare(
        &rows,
        "string",
        1e-3,
        |_| 0.0,
        1.0,
        |row, name, folder| {
            let string = if name == "one" { 300.0 } else { 900.0 };
            run(row, name, &Variant { string, ..SMOOTH }, folder, &standing(row))
        },
    );
}

/// Twice every mass, force and stiffness: twice the forces. Without the laws of rock, whose bit holds by a stiffness that no key
/// gives.
#[test]
fn twice_every_mass_force_and_stiffness_changes_no_equilibrium() {
    let rows: Vec<Row> = covering::rows().into_iter().filter(|row| row[ROCK] == 0).collect();
    compare(
        &rows,
        "scale",
        1e-4,
        |_| 0.0,
        0.5,
        |row, name, folder| {
            let scale = if name == "one" { 1.0 } else { 2.0 };
            let phases: Vec<_> = standing(row)
                .into_iter()
                .map(|(s, rpm, kn, mpa)| (s, rpm, kn * scale, mpa))
                .collect();
            run(row, name, &Variant { scale, ..SMOOTH }, folder, &phases)
        },
    );
}

/// Both runs of every row: forces from outside equal to `share` of the weight on bit and a row's `more` (N), after `factor` on
/// those of the second.
fn compare(
    rows: &[Row],
    what: &str,
    share: f64,
    more: impl Fn(&Row) -> f64 + Sync,
    factor: f64,
    runs: impl Fn(&Row, &str, &std::path::Path) -> std::path::PathBuf + Sync,
) {
    let violations = Mutex::new(Vec::new());
    spread(rows.len(), |index| {
        let row = &rows[index];
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = ["one", "other"].map(|name| Outside::of(&runs(row, name, folder.path())));
        let distance = one.distance(&other, factor);
        println!(
            "{what} | {} | {distance:.3} N | {one:?} | {other:?}",
            covering::name(row)
        );
        // A node at rest may be left with 10 mN, and 38 nodes of either run in one sense with 0.8 N.
        if distance > share * WEIGHT + 0.8 + more(row) {
            let line = format!("{distance:.2} N: {one:?} against {other:?}");
            violations
                .lock()
                .unwrap()
                .push((covering::name(row), what.to_owned(), line));
        }
    });
    check(violations);
}

/// The first tenth of a second of a start, before collisions part any two runs: positions are equal.
#[test]
fn twice_every_mass_force_and_stiffness_changes_no_motion() {
    // As above, without the laws of rock.
    let rows: Vec<Row> = covering::rows().into_iter().filter(|row| row[ROCK] == 0).collect();
    let violations = Mutex::new(Vec::new());
    spread(rows.len(), |index| {
        let row = &rows[index];
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = [("one", 1.0), ("other", 2.0)].map(|(name, scale)| {
            let variant = Variant {
                scale,
                ..Variant::default()
            };
            let phases = [(1, 40.0, scale * WEIGHT / 1e3, 0.0)];
            early(&run(row, name, &variant, folder.path(), &phases))
        });
        let (mut moved, mut apart) = (0.0_f64, 0.0_f64);
        for (a, b) in one.iter().zip(&other) {
            for ((x, y), rest) in a.iter().zip(b).zip(&one[0]) {
                moved = moved.max((x - rest).abs());
                apart = apart.max((x - y).abs());
            }
        }
        println!("motion | {} | {apart:.3e} of {moved:.3e}", covering::name(row));
        // Newton stops at forces of 1 N, which are half as much of the doubled tool: a ten-thousandth of the weight on bit,
        // and as much of the motion.
        if apart > 1e-3 * moved.max(1e-4) {
            let line = format!("{apart:.3e} apart of a motion of {moved:.3e} (rad, m)");
            violations
                .lock()
                .unwrap()
                .push((covering::name(row), "motion".to_owned(), line));
        }
    });
    check(violations);
}

/// Bends (rad), positions (m) and spins of the joints in the first tenth of a second.
fn early(path: &std::path::Path) -> Vec<Vec<f64>> {
    let messages = bag::open(path).unwrap().map(|message| message.unwrap());
    let joints = messages.filter(|message| message.topic.is("twin/joint_deflections"));
    joints
        .take(3)
        .map(|message| {
            let m: JointDeflections = message.decode().unwrap();
            [m.bend_angle, m.lateral_y, m.lateral_z].concat()
        })
        .collect()
}
