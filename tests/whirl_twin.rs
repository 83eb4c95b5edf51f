//! The analysis on the real mechanics: a rotor that rolls in its clearance by physics, one that slides, and what
//! doubtful inputs do to what is said of them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill::messages::WhirlWarning;
use flexdrill::messages::fill;
use flexdrill::messages::outputs::schedule;
use flexdrill::messages::std_msgs::Header;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::InputState;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::motion::{Severity, WhirlKind};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{Frame, Run, Simulation};

/// The closed-form case of a rolling rotor, d = 60 mm in D = 80 mm at 60 r/min, with both its stations watched.
fn rolling_rotor() -> Config {
    let text = std::fs::read_to_string("config/verify/rolling_rotor.yaml").unwrap();
    Config::from_text(
        "rolling_rotor",
        &format!("{text}\nwhirl: {{watched: {{stations: [0, 1]}}}}\n"),
    )
    .unwrap()
}

struct Bench {
    run: Run,
    frame: Frame,
}

impl Bench {
    fn new(config: &Config, quality: InputState) -> Self {
        let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
        let run = Run::new(simulation, schedule(config));
        let mut bench = Self {
            frame: run.new_frame(),
            run,
        };
        bench.set_quality(quality);
        bench
    }

    fn set_quality(&mut self, quality: InputState) {
        let mut inputs = self.run.applied();
        inputs.input_quality = quality as u8;
        self.run.apply(&inputs);
    }

    fn advance(&mut self, seconds: f64) {
        let steps = (seconds / self.run.simulation().settings().time_step).round() as u64;
        for _ in 0..steps {
            assert!(matches!(self.run.advance(), StepOutcome::Advanced { .. }));
        }
        self.run.capture(&mut self.frame);
    }

    /// The message that the node would send.
    fn warning(&self) -> WhirlWarning {
        let mut message = WhirlWarning::default();
        let header = Header::default();
        fill::whirl_warning(&self.frame.snapshot, &header, self.frame.input_quality, &mut message);
        message
    }
}

#[test]
fn rolling_by_physics_is_backward_and_rolling() {
    let mut bench = Bench::new(&rolling_rotor(), InputState::Ok);
    bench.advance(8.0);
    let whirl = &bench.frame.snapshot.whirl;
    assert_eq!(whirl.body, [Body::Pipe, Body::Guide, Body::Pipe, Body::Guide]);
    for entry in [0, 2] {
        assert_eq!(whirl.kind[entry], WhirlKind::Backward);
        // The verification case gives the rate within 2 %: the regularised friction creeps by 0.5 %, contact is soft.
        assert!((whirl.whirl_ratio[entry] / -3.0 - 1.0).abs() < 0.02, "{whirl:?}");
        assert!((whirl.rolling_share[entry] - 1.0).abs() < 0.02 && whirl.rolling[entry]);
        assert!(
            whirl.contact_duty[entry] > 0.99 && whirl.confidence[entry] > 0.95,
            "{whirl:?}"
        );
        // The held guide stands still.
        assert_eq!(
            (whirl.kind[entry + 1], whirl.rolling_share[entry + 1]),
            (WhirlKind::None, 0.0)
        );
    }
    let warning = bench.warning();
    // 20 N of contact force would be watched only; rolling counts one level more.
    assert_eq!(
        (warning.severity, warning.kind),
        (WhirlWarning::WARNING, WhirlWarning::BACKWARD)
    );
    assert!(warning.message.contains("rolling"), "{}", warning.message);
    assert_eq!(warning.input_quality, WhirlWarning::INPUT_OK);
}

#[test]
fn sliding_by_physics_is_backward_and_sliding() {
    // Half of the rolling speed, and hardly any friction to bring it up: mu v2 / e x 8 s is 4 % of it.
    let config = rolling_rotor()
        .with_value("contact.inner.friction_tangential", 0.001)
        .unwrap()
        .with_value("initial.velocity", serde_json::json!([0.0, 0.0942, 0.0]))
        .unwrap();
    let mut bench = Bench::new(&config, InputState::Ok);
    bench.advance(8.0);
    let whirl = &bench.frame.snapshot.whirl;
    assert_eq!(whirl.kind[0], WhirlKind::Backward, "{whirl:?}");
    assert!(
        (0.45..0.65).contains(&whirl.rolling_share[0]) && !whirl.rolling[0],
        "{whirl:?}"
    );
    assert_eq!(bench.frame.snapshot.warning.severity, Severity::Watch);
    assert!(
        bench.warning().message.contains("sliding"),
        "{}",
        bench.warning().message
    );
}

#[test]
fn a_stale_input_lowers_the_confidence_and_says_so() {
    let config = rolling_rotor();
    let mut bench = Bench::new(&config, InputState::Ok);
    bench.advance(6.0);
    let fresh = bench.warning();
    assert!(fresh.confidence > 0.95, "{fresh:?}");
    for (quality, trust, word) in [
        (InputState::Stale, 0.6, "stale"),
        (InputState::Rejected, 0.8, "rejected"),
        (InputState::Slow, 0.9, "late"),
    ] {
        bench.set_quality(quality);
        bench.advance(0.1);
        let doubtful = bench.warning();
        assert_eq!(doubtful.input_quality, quality as u8);
        assert!(
            (doubtful.confidence / fresh.confidence - trust).abs() < 0.01,
            "{doubtful:?}"
        );
        assert!(doubtful.message.contains(word), "{}", doubtful.message);
        // It is sent anew, and the level stands.
        assert!(doubtful.sequence > fresh.sequence);
        assert_eq!(doubtful.severity, fresh.severity);
    }
    // The motion is the same whatever is thought of the inputs.
    let mut other = Bench::new(&config, InputState::Stale);
    other.advance(6.3);
    assert_eq!(other.frame.snapshot.joints, bench.frame.snapshot.joints);
    assert_eq!(other.frame.snapshot.shape, bench.frame.snapshot.shape);
}

#[test]
fn a_checkpoint_does_not_turn_the_warnings_back() {
    let config = rolling_rotor();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let early = simulation.checkpoint().unwrap();
    let inputs = config.simulation().initial_inputs;
    for _ in 0..60_000 {
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
    }
    let mut snapshot = simulation.new_snapshot();
    simulation.snapshot(&mut snapshot, true);
    let (level, late) = (snapshot.warning, simulation.checkpoint().unwrap());
    assert_eq!(level.severity, Severity::Warning);
    simulation.restore(&early).unwrap();
    simulation.snapshot(&mut snapshot, true);
    assert_eq!(snapshot.warning.severity, Severity::Ok);
    assert!(
        snapshot.warning.sequence > level.sequence,
        "listeners would keep the old warning"
    );
    // In a new process the counting goes on from the checkpoint's.
    let mut fresh = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    fresh.restore(&late).unwrap();
    fresh.snapshot(&mut snapshot, true);
    assert_eq!(snapshot.warning, level);
}

/// What the analysis said of the pipe at a joint, and what the motion sums up to, over the second half of a run.
struct Watched {
    /// Parts of the time.
    forward: f64,
    backward: f64,
    /// Mean whirl ratio as reported.
    ratio: f64,
    /// Turns of the orbit about its centre per turn of the tool, counted from the positions alone.
    winding: f64,
    /// Area swept per turn of the tool over that of a circle as large as the clearance, positive is forward.
    area: f64,
}

/// The tool of `config/coarse.yaml` at 10 kN for 20 s.
fn tool_run(rpm: f64, inner_friction: f64) -> Vec<Watched> {
    let config = Config::load("config/coarse.yaml")
        .and_then(|config| config.with_value("contact.inner.friction_tangential", inner_friction))
        .and_then(|config| config.with_value("inputs.weight_on_bit.initial_kn", 10.0))
        .unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let inputs = Inputs {
        rotary_speed: rpm * std::f64::consts::TAU / 60.0,
        weight_on_bit: 10e3,
    };
    let (steps, every) = (40_000, 10);
    let mut snapshot = simulation.new_snapshot();
    let (mut positions, mut reports) = (vec![], vec![]);
    for step in 1..=steps {
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        if step % every == 0 && 2 * step > steps {
            simulation.snapshot(&mut snapshot, false);
            let shape = &snapshot.shape;
            let in_guide = |s: usize| [0, 1].map(|axis| shape.pipe[s][axis] - shape.guide[s][axis]);
            positions.push((0..shape.pipe.len()).map(in_guide).collect::<Vec<_>>());
            reports.push(snapshot.whirl.clone());
        }
    }
    let turns = rpm / 60.0 * positions.len() as f64 * every as f64 * config.solver.time_step;
    let count = reports.len() as f64;
    let part = |entry: usize, kind: WhirlKind| reports.iter().filter(|r| r.kind[entry] == kind).count() as f64 / count;
    (0..reports[0].kind.len())
        .filter(|&entry| reports[0].body[entry] == Body::Pipe)
        .map(|entry| {
            let station = reports[0].station[entry];
            let path: Vec<[f64; 2]> = positions.iter().map(|at| at[station]).collect();
            let clearance = simulation.clearance(station, Body::Pipe).unwrap();
            let (winding, area) = wound(&path);
            Watched {
                forward: part(entry, WhirlKind::Forward),
                backward: part(entry, WhirlKind::Backward),
                ratio: reports.iter().map(|r| r.whirl_ratio[entry]).sum::<f64>() / count,
                winding: winding / turns,
                area: area / turns / (std::f64::consts::PI * clearance * clearance),
            }
        })
        .collect()
}

/// Turns about the mean point, and the swept area.
fn wound(path: &[[f64; 2]]) -> (f64, f64) {
    let mean = [0, 1].map(|axis| path.iter().map(|p| p[axis]).sum::<f64>() / path.len() as f64);
    let (mut angle, mut area) = (0.0, 0.0);
    for pair in path.windows(2) {
        let [p, q] = [pair[0], pair[1]].map(|at| [at[0] - mean[0], at[1] - mean[1]]);
        let (cross, dot) = (p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]);
        angle += cross.atan2(dot);
        area += 0.5 * cross;
    }
    (angle / std::f64::consts::TAU, area)
}

#[test]
fn the_tool_whirls_forward_with_little_friction_and_backward_with_much() {
    let ratios = |places: &[&Watched]| -> String {
        places
            .iter()
            .map(|place| {
                format!(
                    "{:.2} (winding {:.2}, area {:.2}) ",
                    place.ratio, place.winding, place.area
                )
            })
            .collect()
    };
    let places = tool_run(40.0, 0.2);
    let steady: Vec<&Watched> = places.iter().filter(|place| place.forward > 0.95).collect();
    println!(
        "friction 0.2, 40 r/min, forward at {}: {}",
        steady.len(),
        ratios(&steady)
    );
    assert!(steady.len() >= 5, "{}", steady.len());
    assert!(
        steady.iter().all(|place| place.winding > 0.0 && place.area > 0.0),
        "{}",
        ratios(&steady)
    );

    let places = tool_run(120.0, 0.7);
    let steady: Vec<&Watched> = places.iter().filter(|place| place.backward > 0.9).collect();
    println!(
        "friction 0.7, 120 r/min, backward at {}: {}",
        steady.len(),
        ratios(&steady)
    );
    assert!(steady.len() >= 3, "{}", steady.len());
    // It rolls, at -3.7 times its speed, and is thrown off the wall for parts of a turn, in which it does not go round
    // its centre.
    assert!(
        steady
            .iter()
            .all(|place| place.winding < -1.0 && place.area < -1.0 && (-4.5..-3.0).contains(&place.ratio)),
        "{}",
        ratios(&steady)
    );
    let turned: Vec<&Watched> = places.iter().filter(|place| place.forward > 0.5).collect();
    assert!(turned.is_empty(), "{}", ratios(&turned));
}
