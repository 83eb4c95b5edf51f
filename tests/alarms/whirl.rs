//! The analysis on the real mechanics: a rotor that rolls in its clearance by physics, one that slides, and what
//! doubtful inputs do to what is said of them.

use flexdrill::messages::WhirlWarning;
use flexdrill::messages::std_msgs::Header;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::InputState;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{Frame, Run, Simulation};
use flexdrill_motion::{DriveState, HazardKind, Severity, WhirlKind};
use flexdrill_outputs::fill;
use flexdrill_outputs::schedule;

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
        let run = Run::new(simulation, schedule(config, &config.outputs.rates));
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
    // With 20 N of contact force: what it does is to bend the pipe four times per turn.
    assert_eq!(
        (warning.severity, warning.kind),
        (WhirlWarning::CRITICAL, WhirlWarning::BACKWARD)
    );
    let hazard = *bench.frame.snapshot.hazards.of(HazardKind::BackwardWhirl);
    assert_eq!((hazard.severity, hazard.threshold), (Severity::Critical, 3.0));
    assert!((whirl.bending_cycles[0] - 4.0).abs() < 0.05, "{whirl:?}");
    // The hazard keeps its worst moment; the estimated rate of a whirl that begins is off by up to a tenth of its 3 turns.
    assert!((3.95..4.3).contains(&hazard.value), "{hazard:?}");
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
    // Half of -3: two and a half bending cycles per turn.
    assert_eq!(bench.frame.snapshot.warning.severity, Severity::Warning);
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
    assert_eq!(level.severity, Severity::Critical);
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
    chaotic: f64,
    /// Mean whirl ratio where one is reported.
    ratio: f64,
    /// Turns about the gap's centre per turn of the tool, counted from the positions alone.
    counted: f64,
    /// Mean part of the time in contact.
    duty: f64,
}

/// A run of the tool.
struct ToolRun {
    places: Vec<Watched>,
    /// Highest level of each hazard in the whole run.
    worst: [Severity; HazardKind::ALL.len()],
    /// Turns of the tool from the moment at which a third of the places have gone round twice against the last turn of
    /// the tool, and the drive turns steadily, to backward whirl that is critical.
    delay: Option<f64>,
}

/// Samples of the positions per second.
const RATE: f64 = 200.0;

/// The tool of a configuration at 10 kN for 20 s.
fn tool_run(file: &str, rpm: f64, inner_friction: f64) -> ToolRun {
    let config = Config::load(file)
        .and_then(|config| config.with_value("contact.inner.friction_tangential", inner_friction))
        .and_then(|config| config.with_value("inputs.weight_on_bit.initial_kn", 10.0))
        .unwrap();
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let inputs = Inputs {
        rotary_speed: rpm * std::f64::consts::TAU / 60.0,
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    let every = (1.0 / (RATE * config.solver.time_step)).round() as usize;
    let (samples, turn) = (20 * RATE as usize, (60.0 / rpm * RATE) as usize);
    let mut snapshot = simulation.new_snapshot();
    let pipes: Vec<usize> = (0..snapshot.whirl.body.len())
        .filter(|&entry| snapshot.whirl.body[entry] == Body::Pipe)
        .collect();
    // Of each place: turns about the gap's centre since the start, sample by sample.
    let mut turned: Vec<Vec<f64>> = vec![vec![0.0]; pipes.len()];
    let mut before = vec![[0.0; 2]; pipes.len()];
    let mut reports = vec![];
    let mut worst = [Severity::Ok; HazardKind::ALL.len()];
    let (mut begun, mut critical) = (None, None);
    for sample in 0..samples {
        for _ in 0..every {
            assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
        }
        simulation.snapshot(&mut snapshot, false);
        for ((path, at), &entry) in turned.iter_mut().zip(&mut before).zip(&pipes) {
            let station = snapshot.whirl.station[entry];
            let shape = &snapshot.shape;
            let [y, z] = [0, 1].map(|axis| shape.pipe[station][axis] - shape.guide[station][axis]);
            let angle = (at[0] * z - at[1] * y).atan2(at[0] * y + at[1] * z);
            path.push(path.last().unwrap() + angle / std::f64::consts::TAU);
            *at = [y, z];
        }
        for (worst, hazard) in worst.iter_mut().zip(&snapshot.hazards.list) {
            *worst = hazard.severity.max(*worst);
        }
        let back = |path: &&Vec<f64>| path.len() > turn && path[path.len() - 1] - path[path.len() - 1 - turn] <= -2.0;
        let many = 3 * turned.iter().filter(back).count() >= pipes.len();
        if many && snapshot.hazards.drive == DriveState::Turning {
            begun = begun.or(Some(sample));
        }
        if snapshot.hazards.of(HazardKind::BackwardWhirl).severity == Severity::Critical {
            critical = critical.or(Some(sample));
        }
        if 2 * sample >= samples {
            reports.push(snapshot.whirl.clone());
        }
    }
    let (count, turns) = (reports.len() as f64, reports.len() as f64 / turn as f64);
    let places = pipes.iter().zip(&turned).map(|(&entry, path)| {
        let part = |kind: WhirlKind| reports.iter().filter(|r| r.kind[entry] == kind).count() as f64 / count;
        let ratios: Vec<f64> = reports
            .iter()
            .map(|r| r.whirl_ratio[entry])
            .filter(|r| r.is_finite())
            .collect();
        Watched {
            forward: part(WhirlKind::Forward),
            backward: part(WhirlKind::Backward),
            chaotic: part(WhirlKind::Chaotic),
            ratio: ratios.iter().sum::<f64>() / ratios.len() as f64,
            counted: (path[path.len() - 1] - path[path.len() - 1 - reports.len()]) / turns,
            duty: reports.iter().map(|r| r.contact_duty[entry]).sum::<f64>() / count,
        }
    });
    ToolRun {
        places: places.collect(),
        worst,
        delay: begun
            .zip(critical)
            .map(|(from, to)| (to as f64 - from as f64) / turn as f64),
    }
}

fn table(run: &ToolRun) -> String {
    let row = |(joint, place): (usize, &Watched)| {
        format!(
            "{:2}: forward {:.2} backward {:.2} chaotic {:.2}, ratio {:5.2}, counted {:5.2}, in contact {:.2}\n",
            joint + 1,
            place.forward,
            place.backward,
            place.chaotic,
            place.ratio,
            place.counted,
            place.duty
        )
    };
    let places: String = run.places.iter().enumerate().map(row).collect();
    format!("{:?}, critical after {:?} turns\n{places}", run.worst, run.delay)
}

/// Drilling quietly: the pipe goes round forward in the middle of the tool, and nothing is wrong with that.
#[test]
fn the_tool_whirls_forward_with_little_friction_and_no_level_rises() {
    let run = tool_run("config/coarse.yaml", 40.0, 0.2);
    println!("friction 0.2, 40 r/min: {}", table(&run));
    // Towards the ends the pipe swings beside the gap's centre, and turns about its mean are none about the centre.
    let third = run.places.len() / 3;
    let middle = &run.places[third..2 * third];
    let steady: Vec<&Watched> = middle.iter().filter(|place| place.forward > 0.95).collect();
    assert!(4 * steady.len() >= 3 * middle.len(), "{}", table(&run));
    // In ten seconds of a motion that bounces now and then the mean of the window's ratios is not quite its turns.
    let agree = |place: &&&Watched| (place.ratio - place.counted).abs() < 0.3;
    assert!(
        4 * steady.iter().filter(agree).count() >= 3 * steady.len(),
        "{}",
        table(&run)
    );
    assert_eq!(run.worst, [Severity::Ok; HazardKind::ALL.len()]);
}

/// Thrown from wall to wall two to three times against each turn of the tool, in contact for a few percent of the time:
/// seen as what it is, and critical within three turns.
#[test]
fn the_tool_whirls_backward_with_much_friction_and_that_is_critical() {
    let run = tool_run("config/coarse.yaml", 120.0, 0.7);
    println!("friction 0.7, 120 r/min: {}", table(&run));
    // A place that is thrown for a part of the time only is counted less.
    let thrown: Vec<&Watched> = run.places.iter().filter(|place| place.counted < -2.0).collect();
    assert!(thrown.len() >= 10, "{}", table(&run));
    assert!(thrown.iter().all(|place| place.duty < 0.15), "{}", table(&run));
    assert!(thrown.iter().all(|place| place.backward > 0.6), "{}", table(&run));
    assert!(
        thrown
            .iter()
            .all(|place| (place.ratio / place.counted - 1.0).abs() < 0.5),
        "{}",
        table(&run)
    );
    assert!(run.places.iter().all(|place| place.forward < 0.2), "{}", table(&run));
    assert!(run.delay.is_some_and(|turns| turns <= 3.0), "{}", table(&run));
}

/// The same below a string, on a rock that holds the bit. A third of the places are thrown at once, which ends by itself.
#[test]
fn the_rigs_tool_whirls_backward_with_much_friction_and_that_is_critical() {
    let run = tool_run("config/rig.yaml", 120.0, 0.7);
    println!("rig.yaml, friction 0.7, 120 r/min: {}", table(&run));
    assert!(run.delay.is_some_and(|turns| turns <= 3.0), "{}", table(&run));
}
