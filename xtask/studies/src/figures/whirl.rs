//! Draws the figure of `docs/whirl.md`: three orbits of the mechanics, each called by the analysis, and their full
//! spectra.
//!
//!     cargo xtask figure whirl docs/images/whirl.svg

use std::f64::consts::TAU;
use std::path::Path;

use anyhow::{Context as _, bail, ensure};
use flexdrill_config::{Config, ConfigError};
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{Simulation, Snapshot};
use flexdrill_core::units::{kn_to_n, rad_to_deg, rpm_to_rad_per_s};
use flexdrill_motion::WhirlKind;
use flexdrill_plot::{Figure, Line, Panel, svg};

/// Time between two samples (s), as the analysis has by default.
const SPACING: f64 = 0.004;
/// Turns of the tool that are drawn and transformed.
const TURNS: f64 = 4.0;
/// Lines of the spectrum are shown up to this multiple of the rotary speed.
const ORDERS: f64 = 6.0;

/// A run, and the kind that is looked for in it.
struct Case {
    title: &'static str,
    config: &'static str,
    changes: fn(&Config) -> Result<Config, ConfigError>,
    /// r/min.
    rpm: f64,
    /// kN.
    wob: f64,
    /// s.
    duration: f64,
    kind: WhirlKind,
}

const CASES: [Case; 3] = [
    Case {
        title: "Forward",
        config: "config/default.yaml",
        changes: |config| Ok(config.clone()),
        rpm: 40.0,
        wob: 10.0,
        duration: 16.0,
        kind: WhirlKind::Forward,
    },
    Case {
        title: "Backward, rolling",
        config: "config/verify/rolling_rotor.yaml",
        // It has no joints, which are watched otherwise.
        changes: |config| config.with_value("whirl.watched", serde_json::json!({"stations": [0, 1]})),
        rpm: 60.0,
        wob: 0.0,
        duration: 8.0,
        kind: WhirlKind::Backward,
    },
    Case {
        title: "Chaotic",
        config: "config/coarse.yaml",
        changes: |config| config.with_value("contact.inner.friction_tangential", 0.5),
        rpm: 120.0,
        wob: 10.0,
        duration: 10.0,
        kind: WhirlKind::Chaotic,
    },
];

/// What the analysis says of a place, and the motion it was said of.
struct Orbit {
    /// Degrees.
    inclination: f64,
    ratio: f64,
    confidence: f64,
    /// m.
    clearance: f64,
    /// Pipe in the guide: horizontal, towards the low side (m).
    position: Vec<[f64; 2]>,
}

/// # Errors
/// When a run fails or the file cannot be written.
pub(crate) fn draw(to: &Path) -> anyhow::Result<()> {
    let mut panels = Vec::new();
    let mut spectra = Vec::new();
    for case in &CASES {
        let orbit = run(case).with_context(|| format!("{}: {}", case.title, case.config))?;
        println!(
            "{}: {}, {} r/min, at {:.1} deg, ratio {:.2}, confidence {:.2}",
            case.title, case.config, case.rpm, orbit.inclination, orbit.ratio, orbit.confidence
        );
        panels.push(orbit_panel(case, &orbit));
        spectra.push(spectrum_panel(case, &orbit));
    }
    panels.append(&mut spectra);
    let figure = Figure {
        name: "whirl",
        title: String::new(),
        caption: String::new(),
        columns: CASES.len(),
        height: 340,
        panels,
    };
    std::fs::write(to, svg(&figure)?).with_context(|| format!("{} cannot be written", to.display()))
}

/// The last turns of the watched pipe place that is of the case's kind with the greatest confidence.
fn run(case: &Case) -> anyhow::Result<Orbit> {
    let config =
        (case.changes)(&Config::load(case.config)?)?.with_value("inputs.weight_on_bit.initial_kn", case.wob)?;
    let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
    let step = config.solver.time_step;
    let every = (SPACING / step).round() as usize;
    let inputs = Inputs {
        rotary_speed: rpm_to_rad_per_s(case.rpm),
        weight_on_bit: kn_to_n(case.wob),
        ..Inputs::default()
    };
    let mut snapshot = simulation.new_snapshot();
    let mut history: Vec<Vec<[f64; 2]>> = Vec::new();
    let steps = (case.duration / step).round() as usize;
    // The orbit is drawn over whole turns of the tool at its speed.
    let window = (TURNS * 60.0 / case.rpm / SPACING).round() as usize;
    ensure!(steps / every > window, "the run is shorter than the window");
    for number in 1..=steps {
        if let StepOutcome::Failed(failure) = simulation.advance(&inputs) {
            bail!("a step failed: {failure}");
        }
        // Only the last turns are kept, for all stations: which of them is shown is known at the end.
        if number % every == 0 && (steps - number) / every < window {
            simulation.snapshot(&mut snapshot, false);
            history.push(
                (0..snapshot.shape.pipe.len())
                    .map(|at| in_guide(&snapshot, at))
                    .collect(),
            );
        }
    }
    let whirl = &snapshot.whirl;
    // The clearest example of the kind, and not the largest: the figure explains what the kind looks like.
    let entry = (0..whirl.kind.len())
        .filter(|&entry| whirl.kind[entry] == case.kind && whirl.body[entry] == Body::Pipe)
        .max_by(|&a, &b| whirl.confidence[a].total_cmp(&whirl.confidence[b]))
        .with_context(|| format!("no place is {:?} at the end of the run", case.kind))?;
    let station = whirl.station[entry];
    Ok(Orbit {
        inclination: rad_to_deg(whirl.inclination[entry]),
        ratio: whirl.whirl_ratio[entry],
        confidence: whirl.confidence[entry],
        clearance: simulation.clearance(station, Body::Pipe).unwrap_or(f64::NAN),
        position: history.iter().map(|at| at[station]).collect(),
    })
}

fn in_guide(snapshot: &Snapshot, station: usize) -> [f64; 2] {
    let (pipe, guide) = (snapshot.shape.pipe[station], snapshot.shape.guide[station]);
    [pipe[0] - guide[0], pipe[1] - guide[1]]
}

fn orbit_panel(case: &Case, orbit: &Orbit) -> Panel {
    let circle = (0..=120).map(|k| {
        let angle = TAU * f64::from(k) / 120.0;
        (1e3 * orbit.clearance * angle.cos(), 1e3 * orbit.clearance * angle.sin())
    });
    let motion: Vec<(f64, f64)> = orbit.position.iter().map(|p| (1e3 * p[0], 1e3 * p[1])).collect();
    let last = motion.last().copied().into_iter().collect();
    let place = if case.config.contains("verify") {
        "rotor".to_owned()
    } else {
        format!("{:.0} deg", orbit.inclination)
    };
    let title = match case.kind {
        WhirlKind::Chaotic => format!("{}: {place}", case.title),
        _ => format!("{}: {place}, {:.2} x speed", case.title, orbit.ratio),
    };
    Panel::new(title, "y (mm), horizontal", "z (mm), low side down")
        .line(Line::new("clearance", circle.collect()).dashed().color(6))
        .line(Line::new("pipe's centre", motion).thin().color(0))
        .line(Line::new("last", last).dots().color(1))
        .equal()
        .down()
}

/// Amplitude of the complex signal y + i z at forward (positive) and backward (negative) multiples of the rotary speed,
/// with a Hann window.
fn spectrum_panel(case: &Case, orbit: &Orbit) -> Panel {
    let count = orbit.position.len();
    let mean = |axis: usize| orbit.position.iter().map(|p| p[axis]).sum::<f64>() / count as f64;
    let centre = [mean(0), mean(1)];
    let speed = rpm_to_rad_per_s(case.rpm);
    let amplitude = |order: f64| {
        let (mut real, mut imaginary, mut weights) = (0.0, 0.0, 0.0);
        for (k, p) in orbit.position.iter().enumerate() {
            let weight = 0.5 - 0.5 * (TAU * (k as f64 + 0.5) / count as f64).cos();
            let (sin, cos) = (order * speed * SPACING * k as f64).sin_cos();
            let (y, z) = (p[0] - centre[0], p[1] - centre[1]);
            real += weight * (y * cos + z * sin);
            imaginary += weight * (z * cos - y * sin);
            weights += weight;
        }
        1e3 * real.hypot(imaginary) / weights
    };
    let steps = (ORDERS * 20.0) as i32;
    let side = |from: i32, to: i32| {
        (from..=to)
            .map(|k| (f64::from(k) / 20.0, amplitude(f64::from(k) / 20.0)))
            .collect::<Vec<_>>()
    };
    Panel::new("Full spectrum", "frequency over rotary speed", "amplitude (mm)")
        .line(Line::new("backward", side(-steps, 0)).color(1))
        .line(Line::new("forward", side(0, steps)).color(2))
        .over(-ORDERS, ORDERS)
        .from_zero()
}
