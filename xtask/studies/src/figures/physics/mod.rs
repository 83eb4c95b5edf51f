//! Draws the figures of `docs/physics.md`: what each piece of the rig's physics does to the paper's tool. It prints the
//! table of the same page.
//!
//!     cargo xtask figure physics docs/images
//!
//! Each run is 20 s of `config/default.yaml` at 40 r/min and 10 kN in whole steps with the changes of its line. Figures
//! are means over the last three quarters, as in `flexdrill bench`. The runs share the processor's cores; their results
//! do not depend on it.

mod cases;

use std::path::Path;

use anyhow::{Context as _, bail, ensure};
use flexdrill_bench::changed;
use flexdrill_bench::parallel::in_order;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, Direction};
use flexdrill_core::twin::Simulation;
use flexdrill_core::units::{kn_to_n, rad_to_deg, rpm_to_rad_per_s};
use flexdrill_plot::{Figure, Legend, Line, Panel, svg_of_width};

use self::cases::{CASES, Case, number};

/// Length of a run (s).
const DURATION: f64 = 20.0;
/// The first quarter is not judged (s).
const JUDGED_FROM: f64 = DURATION / 4.0;
/// Time between two samples (s).
const SPACING: f64 = 0.01;
/// Width of a drawing, whose texts are then read on a telephone.
const WIDTH: u32 = 480;

/// What a run showed.
#[derive(Default)]
struct Found {
    /// Instants of the samples (s).
    time: Vec<f64>,
    /// Speed of the bit (r/min).
    speed: Vec<f64>,
    /// Torque of the rock (N m).
    torque: Vec<f64>,
    /// The bit's angle less that of the tool's top (deg).
    wind_up: Vec<f64>,
    /// Displacement of the pipe's lower end (mm), up the hole.
    lift: Vec<f64>,
    /// Pipe in the guide at the joint in the middle (mm): horizontal, towards the low side.
    orbit: Vec<(f64, f64)>,
    /// Its clearance (mm).
    clearance: f64,
    /// Means of the judged part by station: inclination (deg), guide-wall force (N).
    wall: Vec<(f64, f64)>,
    /// The same of the wall's friction on the guide (N), up the hole.
    drag: Vec<(f64, f64)>,
    /// By joint: inclination (deg), axial force (kN).
    axial: Vec<(f64, f64)>,
    /// By joint: inclination (deg), bend (deg).
    bend: Vec<(f64, f64)>,
    /// By joint: inclination (deg), torque (N m).
    joint_torque: Vec<(f64, f64)>,
    /// Of the judged part: torque at the tool's top (N m), weight at the kick-off (kN), joints at their stop, largest
    /// pipe-guide force (N), error of the energy over the work of drive and advance.
    top_torque: f64,
    kick_off: f64,
    stops: f64,
    peak: f64,
    energy_error: f64,
}

impl Found {
    fn judged<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = f64> + Clone + 'a {
        let pairs = self.time.iter().zip(values);
        pairs.filter(|(time, _)| **time >= JUDGED_FROM).map(|(_, value)| *value)
    }

    /// Mean and standard deviation of the judged part.
    fn mean(&self, values: &[f64]) -> [f64; 2] {
        let judged = self.judged(values);
        let count = judged.clone().count() as f64;
        let mean = judged.clone().sum::<f64>() / count;
        let variance = judged.map(|value| (value - mean) * (value - mean)).sum::<f64>() / count;
        [mean, variance.sqrt()]
    }

    /// A history for a drawing.
    fn history(&self, values: &[f64], from: f64, to: f64) -> Vec<(f64, f64)> {
        let pairs = self.time.iter().copied().zip(values.iter().copied());
        pairs.filter(|(time, _)| (from..=to).contains(time)).collect()
    }
}

/// # Errors
/// When a run fails or a file cannot be written.
pub(crate) fn draw(folder: &Path) -> anyhow::Result<()> {
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let found = in_order(&CASES, jobs, |case| run(case).with_context(|| case.name.to_owned()))?;
    print!("{}", table(&found));
    for figure in figures(&found) {
        let path = folder.join(format!("{}.svg", figure.name));
        std::fs::write(&path, svg_of_width(&figure, WIDTH)?)
            .with_context(|| format!("{} cannot be written", path.display()))?;
    }
    Ok(())
}

fn run(case: &Case) -> anyhow::Result<Found> {
    // All runs begin from one file and one load, so that a difference is that of the changed keys.
    let changes: Vec<String> = case.changes.iter().map(|change| (*change).to_owned()).collect();
    let config = changed(Config::load("config/default.yaml")?, None, &changes)?
        .with_value("inputs.rotary_speed.initial_rpm", case.rpm)?
        .with_value("inputs.weight_on_bit.initial_kn", 10)?;
    let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(case.rpm),
        weight_on_bit: kn_to_n(10.0),
        rate_of_penetration: case.rate_of_penetration / 3600.0,
        ..Inputs::default()
    };
    let step = config.solver.time_step;
    let every = (SPACING / step).round() as usize;
    ensure!(every > 0, "the step is longer than {SPACING} s");
    let joints = simulation.joint_stations().to_vec();
    // The joint in the middle stands for the orbit: it is far from the supports at both ends.
    let middle = joints[joints.len() / 2];
    let (last, stations) = (simulation.last_station(), simulation.last_station() + 1);
    let mut snapshot = simulation.new_snapshot();
    // Sums first, over the time that is judged; they become means below.
    let mut found = Found {
        clearance: 1e3 * simulation.clearance(middle, Body::Pipe).unwrap_or(f64::NAN),
        wall: vec![(0.0, 0.0); stations],
        drag: vec![(0.0, 0.0); stations],
        axial: vec![(0.0, 0.0); joints.len()],
        bend: vec![(0.0, 0.0); joints.len()],
        joint_torque: vec![(0.0, 0.0); joints.len()],
        ..Found::default()
    };
    let mut judged = 0.0;
    for number in 1..=(DURATION / step).round() as usize {
        if let StepOutcome::Failed(failure) = simulation.advance(&inputs) {
            bail!("a step failed: {failure}");
        }
        if number % every != 0 {
            continue;
        }
        // Each snapshot ends its interval, so that peaks between two samples are not lost.
        simulation.snapshot(&mut snapshot, true);
        let spin = |station| {
            simulation
                .displacement(station, Body::Pipe, Direction::Psi)
                .unwrap_or(f64::NAN)
        };
        found.time.push(snapshot.time);
        found.speed.push(snapshot.bit.rotary_speed / rpm_to_rad_per_s(1.0));
        found.torque.push(snapshot.bit.torque);
        found.wind_up.push(rad_to_deg(spin(last) - spin(0)));
        let down = simulation
            .displacement(last, Body::Pipe, Direction::U)
            .unwrap_or(f64::NAN);
        found.lift.push(-1e3 * down);
        let (pipe, guide) = (snapshot.shape.pipe[middle], snapshot.shape.guide[middle]);
        found
            .orbit
            .push((1e3 * (pipe[0] - guide[0]), 1e3 * (pipe[1] - guide[1])));
        // The histories begin with the start; means leave its transient out.
        if snapshot.time < JUDGED_FROM {
            continue;
        }
        judged += 1.0;
        let contacts = &snapshot.contacts;
        for (station, (inclination, force)) in found.wall.iter_mut().enumerate() {
            *inclination = rad_to_deg(contacts.inclination[station]);
            *force += contacts.guide_wall.normal[station];
            found.drag[station].0 = *inclination;
            found.drag[station].1 -= contacts.guide_wall.axial[station];
        }
        for joint in 0..joints.len() {
            let inclination = rad_to_deg(snapshot.joints.inclination[joint]);
            found.axial[joint].0 = inclination;
            found.axial[joint].1 += 1e-3 * snapshot.joints.axial_force[joint];
            found.bend[joint].0 = inclination;
            found.bend[joint].1 += rad_to_deg(snapshot.joints.bend_angle[joint]);
            found.joint_torque[joint].0 = inclination;
            found.joint_torque[joint].1 += snapshot.joints.torque[joint];
        }
        let at_stop = snapshot.joints.stop_moment.iter().filter(|moment| **moment > 0.0);
        found.stops += at_stop.count() as f64;
        found.peak = contacts
            .pipe_guide
            .normal_peak
            .iter()
            .copied()
            .fold(found.peak, f64::max);
    }
    // All lists hold pairs of inclination and sum, and are divided alike.
    let lists = [
        &mut found.wall,
        &mut found.drag,
        &mut found.axial,
        &mut found.bend,
        &mut found.joint_torque,
    ];
    for (_, sum) in lists.into_iter().flatten() {
        *sum /= judged;
    }
    found.stops /= judged;
    // The transfer has its own window, of which the last one is taken.
    found.top_torque = snapshot.transfer.torque.mean[1];
    found.kick_off = 1e-3 * snapshot.transfer.weight.mean[1];
    let energy = &snapshot.energy;
    found.energy_error = energy.error.abs() / (energy.drive.abs() + energy.feed.abs());
    Ok(found)
}

/// The table of the page.
fn table(found: &[Found]) -> String {
    let mut out = String::from(
        "| run | ripple of the bit, rms (r/min) | torque at top, at bit (N m) | weight at kick-off (kN) | joints at stop | \
         largest force (kN) | energy error |\n|---|---|---|---|---|---|---|\n",
    );
    for (case, found) in CASES.iter().zip(found) {
        let [_, ripple] = found.mean(&found.speed);
        let [torque, _] = found.mean(&found.torque);
        out.push_str(&format!(
            "| {} | {ripple:.2} | {:.1}, {torque:.1} | {:.2} | {:.1} | {:.2} | {:.1e} |\n",
            case.name,
            found.top_torque,
            found.kick_off,
            found.stops,
            1e-3 * found.peak,
            found.energy_error
        ));
    }
    out
}

fn figures(found: &[Found]) -> Vec<Figure> {
    use number::{
        ADVANCE, AS_BUILT, CLOSED, DEPTH_OF_CUT, MUD, PAPER, PINS, PLAY, SEALED, SHORTENING, SLIDING, SOFT_TORQUE,
        STIFF, STRAIGHT, WEAKENING, WORN_PINS,
    };
    // Lines are named by their runs, so that a legend cannot name another one.
    let line = |at: usize, points: Vec<(f64, f64)>| Line::new(CASES[at].name, points);
    let history = |values: fn(&Found) -> &[f64], at: usize, from, to| {
        let found = &found[at];
        line(at, found.history(values(found), from, to))
    };
    let speed: fn(&Found) -> &[f64] = |found| &found.speed;
    let torque: fn(&Found) -> &[f64] = |found| &found.torque;
    let wind_up: fn(&Found) -> &[f64] = |found| &found.wind_up;
    let lift: fn(&Found) -> &[f64] = |found| &found.lift;
    let by_inclination = "inclination (deg)";
    let over_time = |title, y| Panel::new(title, "time (s)", y).legend(Legend::Stacked);
    let along = |title, y| Panel::new(title, by_inclination, y).legend(Legend::Stacked);
    // Two turns at 40 r/min, the last ones: the start would cover the orbit.
    let orbit = |at: usize, to: f64| {
        let found = &found[at];
        let shown = found.time.iter().zip(&found.orbit);
        shown
            .filter(|(time, _)| **time > to - 3.0)
            .map(|(_, at)| *at)
            .collect::<Vec<_>>()
    };
    // The clearance is drawn as an area behind the orbits, since the pipe may press a little into the guide.
    let circle = (0..=120).map(|k| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 120.0).sin_cos();
        (found[PAPER].clearance * cos, found[PAPER].clearance * sin)
    });
    let clearance = Line::new("clearance", circle.collect()).area().color(6);
    let mut mud = Panel::new(
        "Pipe in the guide, middle, 2 turns",
        "horizontal (mm)",
        "low side down (mm)",
    )
    .equal()
    .down()
    .legend(Legend::Stacked)
    .line(clearance);
    for (at, color) in [(MUD, 1), (PAPER, 0)] {
        mud = mud.line(line(at, orbit(at, DURATION)).thin().color(color));
    }
    // One panel per effect, each with the quantity that the effect changes most and with the run without it.
    vec![
        drawn(
            "physics_string",
            vec![
                over_time("Speed of the bit from the start", "r/min")
                    .line(history(speed, PAPER, 0.0, 8.0).thin())
                    .line(history(speed, SOFT_TORQUE, 0.0, 8.0))
                    .line(history(speed, STIFF, 0.0, 8.0).thin()),
            ],
        ),
        drawn(
            "physics_rock",
            vec![
                over_time("Torque on the bit from the start", "N m")
                    .line(history(torque, PAPER, 0.0, DURATION))
                    .line(history(torque, WEAKENING, 0.0, DURATION).thin())
                    .line(history(torque, DEPTH_OF_CUT, 0.0, DURATION).thin()),
            ],
        ),
        drawn(
            "physics_advance",
            vec![
                along("Drag of the wall, summed from the bit up", "kN")
                    .line(line(PAPER, summed(&found[PAPER].drag)))
                    .line(line(ADVANCE, summed(&found[ADVANCE].drag)))
                    .line(line(SLIDING, summed(&found[SLIDING].drag))),
            ],
        ),
        drawn(
            "physics_preload",
            vec![
                along("Guide on wall, mean", "kN per station")
                    .line(line(AS_BUILT, thousands(&found[AS_BUILT].wall)))
                    .line(line(STRAIGHT, thousands(&found[STRAIGHT].wall)))
                    .from_zero(),
            ],
        ),
        drawn(
            "physics_pressure",
            vec![
                along("Axial force in the joints, mean", "kN, tension positive")
                    .line(line(PAPER, found[PAPER].axial.clone()))
                    .line(line(CLOSED, found[CLOSED].axial.clone()).dashed())
                    .line(line(SEALED, found[SEALED].axial.clone())),
                along("Bend of the joints, mean", "deg")
                    .line(line(PAPER, found[PAPER].bend.clone()))
                    .line(line(CLOSED, found[CLOSED].bend.clone()).dashed())
                    .line(line(SEALED, found[SEALED].bend.clone())),
            ],
        ),
        drawn(
            "physics_joints",
            vec![
                along("Torque in the joints, mean", "N m")
                    .line(line(PAPER, found[PAPER].joint_torque.clone()))
                    .line(line(PINS, found[PINS].joint_torque.clone()))
                    .line(line(WORN_PINS, found[WORN_PINS].joint_torque.clone())),
                over_time("Bit against top from the start", "deg")
                    .line(history(wind_up, PAPER, 0.0, 4.0))
                    .line(history(wind_up, PLAY, 0.0, 4.0)),
            ],
        ),
        drawn("physics_mud", vec![mud]),
        drawn(
            "physics_shortening",
            vec![
                over_time("Pipe's lower end, up the hole", "mm")
                    .line(history(lift, PAPER, 0.0, DURATION))
                    .line(history(lift, SHORTENING, 0.0, DURATION).thin()),
            ],
        ),
    ]
}

/// Without the ends, whose forces are those of the supports.
fn inner(wall: &[(f64, f64)]) -> Vec<(f64, f64)> {
    wall[1..wall.len() - 1].to_vec()
}

/// Forces summed from the lower end up (kN).
fn summed(forces: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sum = 0.0;
    let from_below = forces.iter().rev().map(|(at, force)| {
        sum += 1e-3 * force;
        (*at, sum)
    });
    from_below.collect()
}

fn thousands(wall: &[(f64, f64)]) -> Vec<(f64, f64)> {
    inner(wall).into_iter().map(|(x, y)| (x, 1e-3 * y)).collect()
}

fn drawn(name: &'static str, panels: Vec<Panel>) -> Figure {
    Figure {
        name,
        title: String::new(),
        caption: String::new(),
        columns: 1,
        height: 330,
        panels,
    }
}
