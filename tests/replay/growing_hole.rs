//! The hole as drilled: recorded, replayed with the same bytes, and the tool in it.

use std::path::Path;

use flexdrill::drilling::Drilling;
use flexdrill::messages::{HoleAhead, HoleDrilled, from_cdr};
use flexdrill_config::{Config, Section};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::Simulation;

use super::hole_ahead::{TOOL, messages, replayed, run, succeeds};

/// Under 10 kN at 60 m/h, which is reached after 6 s: 20 s make (6 / 2 + 14) 16.7 mm, some 0.28 m.
fn drilled(folder: &Path) -> (std::path::PathBuf, Vec<HoleDrilled>) {
    let bag = run(folder, TOOL, 21, 60);
    let points = messages(&bag, "twin/hole_drilled");
    let points = points.iter().map(|(_, data)| from_cdr(data).unwrap());
    let points = points.collect();
    (bag, points)
}

#[test]
fn a_hole_that_was_drilled_is_the_hole_of_the_next_run() {
    let folder = tempfile::tempdir().unwrap();
    let (first, points) = drilled(folder.path());
    println!("{} points, the last {:?}", points.len(), points.last());
    assert!((10..=15).contains(&points.len()), "{} points", points.len());
    assert!(
        points.iter().all(|point| point.known && point.because.is_empty()),
        "{points:?}"
    );
    assert!(
        points
            .iter()
            .enumerate()
            .all(|(index, point)| point.point as usize == index)
    );

    // A replay has the same points.
    let second = folder.path().join("again");
    replayed(&[&first, Path::new("--out"), &second]);
    assert!(messages(&first, "twin/hole_drilled") == messages(&second, "twin/hole_drilled"));

    // The hole is that of the answers: at the last point its inclination is theirs there, between two stations. An answer
    // for another weight is used from a difference of 3 % on, which turns 0.3 m of hole by less than 0.1 mrad.
    let before = Config::from_text("tool", TOOL).unwrap();
    let last = points.last().unwrap();
    let answers = messages(&first, "twin/hole_ahead");
    let mut answers = answers.iter().map(|(_, data)| from_cdr::<HoleAhead>(data).unwrap());
    let answer = answers.rfind(|answer| answer.known).unwrap();
    let station = (last.drilled / 0.25) as usize;
    let [from, to] = [station, station + 1].map(|station| answer.inclinations[station]);
    let expected = from + (last.drilled / 0.25 - station as f64) * (to - from);
    assert!(
        (last.inclination - expected).abs() < 1e-4,
        "{} {expected}",
        last.inclination
    );
    // The closed form has 3.145 m for this tool, and the bit points 4 mrad above a hole of 3.2 m: both build more.
    let turned: f64 = points.iter().map(|point| point.build * point.length).sum();
    assert!(
        (0.31..0.35).contains(&(turned / last.drilled)),
        "{turned} rad in {} m",
        last.drilled
    );
    // The torque of 10 kN pushes it to the right, by 0.00023 1/m in long holes and 0.14 mrad at the bit.
    assert!(points.iter().all(|point| point.right.abs() < 2e-3), "{points:?}");

    // The tool in it: as long as before, its bit where the points end.
    let file = folder.path().join("rebased.yaml");
    succeeds(&[Path::new("rebase"), &first, Path::new("--out"), &file]);
    succeeds(&[Path::new("check"), &file]);
    let rebased = Config::load(&file).unwrap();
    assert!(matches!(rebased.well.sections.last(), Some(Section::Drilled(hole)) if hole.points.len() == points.len()));
    assert!((rebased.well.length() - before.well.length()).abs() < 1e-9);
    let simulation = Simulation::new(&rebased.tool(), &rebased.simulation()).unwrap();
    let bit = simulation.stations().last().unwrap();
    // A sum apart from the program's: chords of arcs in one plane. What it walks, 0.1 mrad, is laid into the plane: the
    // square of that.
    let mut inclination = before.well.end_inclination_deg().to_radians();
    let [mut x, mut z] = [
        3.2 * (1.0 - inclination.cos()),
        1.117010 + 3.2 * inclination.sin() - last.drilled,
    ];
    for point in &points {
        let middle = inclination + 0.5 * point.build * point.length;
        x += point.length * middle.sin();
        z += point.length * middle.cos();
        inclination += point.build * point.length;
    }
    // A chord is shorter than its arc by the angle squared over 24, 2e-6 of 20 mm.
    assert!((bit.inclination - inclination).abs() < 1e-6, "{bit:?}");
    assert!((bit.measured_depth - before.well.length()).abs() < 1e-9);
    assert!(
        (bit.position[0] - x).abs() < 1e-5 && (bit.position[2] - z).abs() < 1e-5,
        "{bit:?} {x} {z}"
    );
    assert!((last.inclination - inclination).abs() < 1e-6);
    assert!(
        (last.position[0] - x).abs() < 1e-5 && (last.position[2] - last.drilled - z).abs() < 1e-5,
        "{last:?}"
    );

    // Statics: it lies on the wall in that hole, and the bit pushes as the guide alone does in another program for the same
    // hole, 2 % as in the hole of the configuration.
    assert!((0..=simulation.last_station()).any(|station| simulation.in_contact(station, Body::Guide) == Some(true)));
    let push = |config: &Config| {
        let mut settings = config.simulation();
        settings.initial_inputs.weight_on_bit = 10e3;
        let mut simulation = Simulation::new(&config.tool(), &settings).unwrap();
        let mut snapshot = simulation.new_snapshot();
        simulation.snapshot(&mut snapshot, false);
        let hole = Drilling::of(config, 10e3, 0.0).unwrap();
        let rest = flexdrill_hole::at_rest(&hole.guide, 10e3, &hole.hole).unwrap();
        (snapshot.steering.side_force[1], rest.side_force.y)
    };
    let (twin, alone) = push(&rebased);
    println!("side force {twin} N, of the guide alone {alone} N");
    assert!(
        (twin / alone - 1.0).abs() < 0.05 && alone > 1000.0,
        "{twin} N, {alone} N"
    );

    // A file that is there is not replaced.
    let again = std::process::Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args([Path::new("rebase"), &first, Path::new("--out"), &file])
        .output()
        .unwrap();
    assert!(
        String::from_utf8_lossy(&again.stderr).contains("the file exists"),
        "{again:?}"
    );
}
