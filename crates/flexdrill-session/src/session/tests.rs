use std::collections::BTreeMap;

use super::*;
use crate::ensemble::{Ensemble, Pace};
use crate::rig_inputs::Measured;
use flexdrill_core::inputs::{InputState, MeasuredKind};
use flexdrill_core::twin::{Run, Simulation};
use flexdrill_messages::topics::Cadence;
use flexdrill_messages::{HoleAhead, HoleDrilled, RigMeasured, SafeWindow as SafeWindowMessage, from_cdr};
use flexdrill_outputs::{MeasuredValues as _, schedule};

const SECOND: i64 = 1_000_000_000;
const START: i64 = 1_700_000_000 * SECOND;

/// A host that keeps what it gets, with a rig that measures.
#[derive(Default)]
struct Kept {
    sent: Vec<(&'static str, i64, Vec<u8>)>,
    measured: Measured,
    compared: usize,
    judged: usize,
}

impl Host for Kept {
    type Error = CdrError;

    fn send(&mut self, encoded: Encoded<'_>) -> Result<(), CdrError> {
        self.sent
            .push((encoded.topic.name, encoded.stamp, encoded.cdr.to_vec()));
        Ok(())
    }

    fn measured(&mut self, rig: &mut RigComparison, ticks: u64, stamp: i64) -> Option<Samples> {
        rig.is_due(ticks).then(|| rig.samples(&self.measured, stamp))
    }

    fn judged(&mut self, _: &mut AlarmBook, _: &Snapshot) {
        self.judged += 1;
    }

    fn compared(&mut self, _: &Comparison) {
        self.compared += 1;
    }
}

impl Kept {
    /// How often each topic came.
    fn counts(&self) -> BTreeMap<&'static str, usize> {
        let mut counts = BTreeMap::new();
        for (topic, ..) in &self.sent {
            *counts.entry(*topic).or_default() += 1;
        }
        counts
    }
}

/// With as few plausible tools as have bands.
fn config() -> Arc<Config> {
    let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/default.yaml")).unwrap();
    let text = format!("{}ensemble: {{members: 8}}\n", config.to_yaml().unwrap());
    Arc::new(Config::from_text("default.yaml with an ensemble", &text).unwrap())
}

fn session(config: &Arc<Config>) -> Session {
    let book = AlarmBook::fresh(Arc::clone(config), START);
    Session::new(Arc::clone(config), book)
}

/// Two seconds of a run, hosted as a replay hosts it, with a rig that has measured its torque once.
fn hosted(config: &Arc<Config>) -> (Session, Kept) {
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(config, &config.outputs.rates));
    let mut frame = run.new_frame();
    let (mut session, mut host) = (session(config), Kept::default());
    let mut message = RigMeasured::not_given(session.header(START), RigMeasured::GOOD, "test".into());
    message.set(MeasuredKind::SurfaceTorque, 300.0);
    host.measured.accept(&message, START, 0.0, 1.0).unwrap();
    let ensemble = Ensemble::of(config, None).unwrap().unwrap();
    session.run_with(Running::start(ensemble, Pace::Waits(Vec::new())).unwrap());
    session.begin(START, &mut host).unwrap();
    session.applied(&run.applied(), &[], 0, &mut host).unwrap();
    for _ in 0..(2.0 / config.solver.time_step) as usize {
        assert!(!matches!(
            run.advance(),
            flexdrill_core::dynamics::StepOutcome::Failed(_)
        ));
        if run.due().is_empty() {
            continue;
        }
        run.capture(&mut frame);
        session.frame(&frame, &mut host).unwrap();
        session.repeat_applied(&frame, &mut host).unwrap();
        let stamp = session.instant(frame.ticks).unwrap();
        let header = session.header(stamp);
        session.publish_alarms(header, stamp, &mut host).unwrap();
        session.publish_bands(false, &mut host).unwrap();
        session.publish_hole(true, &mut host).unwrap();
    }
    session.publish_bands(true, &mut host).unwrap();
    (session, host)
}

/// What a host has to do with wall-clock time or with other threads; all other topics that the twin publishes come from
/// the session alone.
const OF_THE_NODE: [&str; 3] = [
    topics::STATUS.name,
    topics::DIAGNOSTICS.name,
    // Look-aheads end when the machine has time for them.
    topics::FORECAST.name,
];

/// A topic that the session does not send would be missing in every host, and none of them could add it: nothing else
/// in them sends messages of a run (`hosts_publish_nothing_of_their_own`, in `xtask/tests/arrows.rs`).
#[test]
fn all_topics_of_a_run_come_from_the_session() {
    let (session, host) = hosted(&config());
    let counts = host.counts();
    // A map is sent by sessions that have one, and nothing happens in two seconds that an alarm's event is of, or that
    // a point of the hole is complete with.
    let at_times = [
        topics::SAFE_WINDOW.name,
        topics::ALARM_EVENTS.name,
        topics::HOLE_DRILLED.name,
    ];
    let published = topics::ALL.iter().filter(|topic| topic.cadence != Cadence::Received);
    for topic in published.filter(|topic| !OF_THE_NODE.contains(&topic.name)) {
        assert!(
            counts.contains_key(topic.name) || at_times.contains(&topic.name),
            "{} is not sent: {counts:?}",
            topic.name
        );
    }
    assert_eq!(counts.get(OF_THE_NODE[0]), None);
    // Twenty looks at the alarms, two comparisons, and their residuals as the newest.
    assert_eq!((host.judged, host.compared), (20, 2));
    assert_eq!(counts[topics::RESIDUALS.name], host.compared);
    assert_eq!(counts[topics::BANDS.name], 2);
    assert_eq!(counts[topics::HOLE_AHEAD.name], 2);
    let (_, _, newest) = host
        .sent
        .iter()
        .rfind(|(topic, ..)| *topic == topics::RESIDUALS.name)
        .unwrap();
    // By bytes: values that are not known are not equal to themselves.
    assert_eq!(*newest, to_cdr(session.residuals().unwrap()).unwrap());
    // One message of applied inputs at the start and one repetition a second later; the second one is due at 2 s.
    assert_eq!(counts[topics::APPLIED_INPUTS.name], 3);
    assert_eq!(host.sent[0].0, topics::SESSION.name);
}

/// A recording of a run that continues from a checkpoint has all of the hole.
#[test]
fn a_hole_that_an_earlier_run_has_drilled_is_published_at_the_start() {
    let config = config();
    let (mut session, mut host) = (session(&config), Kept::default());
    let point = |build| Point {
        curvatures: [build, 0.0],
        known: true,
    };
    let points = [point(0.3), point(0.31), point(0.29)];
    session.continue_hole(&points);
    session.begin(START, &mut host).unwrap();
    let drilled = host
        .sent
        .iter()
        .filter(|(topic, ..)| *topic == topics::HOLE_DRILLED.name);
    let sent: Vec<HoleDrilled> = drilled.map(|(_, _, cdr)| from_cdr(cdr).unwrap()).collect();
    assert_eq!(
        sent.iter().map(|sent| sent.build).collect::<Vec<_>>(),
        [0.3, 0.31, 0.29]
    );
    assert!((sent[2].measured_depth - config.well.length() - 0.06).abs() < 1e-12);
    assert_eq!(session.drilled().points(), points);
    // What was published is not published again.
    let before = host.sent.len();
    session.publish_hole(true, &mut host).unwrap();
    assert_eq!(host.sent.len(), before);
}

/// A session that is judged by the map of a recording has the alarms of the recorded one: at the same inputs it stands
/// off the map, and is suppressed while an input is stale.
#[test]
fn a_session_with_a_recorded_map_judges_as_the_recorded_one() {
    let config = config();
    let map = SafeWindowMessage {
        rotary_speed_rpm: vec![40.0, 80.0],
        weight_on_bit_kn: vec![2.0, 6.0],
        verdict: vec![SafeWindowMessage::CLEAR; 4],
        chance: vec![0.0; 4],
        alarm: vec![String::new(); 4],
        was_run: vec![true; 4],
        ..SafeWindowMessage::default()
    };
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let due = schedule(&config, &config.outputs.rates);
    let mut run = Run::new(simulation, due);
    let mut frame = run.new_frame();
    run.capture(&mut frame);
    frame.snapshot.hazards.drive = flexdrill_motion::DriveState::Turning;
    frame.snapshot.applied.rotary_speed = 60.0 * std::f64::consts::TAU / 60.0;
    frame.snapshot.applied.weight_on_bit = 14e3;
    let mut judge = |map: SafeWindowMessage, quality: InputState| {
        let (mut session, mut host) = (session(&config), Kept::default());
        session.judge_by(Arc::new(SafeWindow::of_recording(map).unwrap()));
        session.begin(START, &mut host).unwrap();
        frame.input_quality = quality as u8;
        // Ten seconds, twice the delay of the alarm, at the ticks at which alarms are due.
        for ticks in (1..=20_000).filter(|ticks| due.due(*ticks).has(Output::Alarms)) {
            (frame.ticks, frame.due) = (ticks, due.due(ticks));
            session.frame(&frame, &mut host).unwrap();
        }
        let sent = host.sent.iter().find(|(topic, ..)| *topic == topics::SAFE_WINDOW.name);
        let sent: SafeWindowMessage = from_cdr(&sent.unwrap().2).unwrap();
        (session.alarms().active(crate::alarms::AlarmId::KnownWindow), sent)
    };
    let (stands, recorded) = judge(map, InputState::Ok);
    assert_eq!(stands, Some(flexdrill_alarms::Priority::Low));
    let (again, twice) = judge(recorded.clone(), InputState::Slow);
    assert_eq!((again, &twice), (stands, &recorded));
    for unknown in [InputState::Stale, InputState::NotReceived] {
        assert_eq!(judge(recorded.clone(), unknown).0, None, "{unknown}");
    }
}

/// A host that has a table of lives gives them to the session; the joints count from the top in messages, from the bit
/// up in a configuration.
#[test]
fn ageing_has_the_lives_of_the_joints_where_the_host_has_a_table() {
    let text = include_str!("../../../../config/default.yaml");
    let joints = Config::from_text("default.yaml", text).unwrap().tool.links - 1;
    let serials: Vec<String> = (1..=joints).map(|place| format!("J-{place}")).collect();
    let lives = format!(
        "  joint:\n    life: {{class: F1}}\n    serial_numbers: [{}]\n",
        serials.join(", ")
    );
    let config = Arc::new(Config::from_text("default.yaml", &text.replace("  joint:\n", &lives)).unwrap());
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(&config, &config.outputs.rates));
    let mut frame = run.new_frame();
    run.capture(&mut frame);
    let ageing = |lives: Option<LivingJoints>| -> Ageing {
        let (mut session, mut host) = (session(&config), Kept::default());
        session.begin(START, &mut host).unwrap();
        lives.into_iter().for_each(|lives| session.continue_lives(lives));
        session.frame(&frame, &mut host).unwrap();
        let mut sent = host.sent.iter().filter(|(topic, ..)| *topic == topics::AGEING.name);
        from_cdr(&sent.next().unwrap().2).unwrap()
    };
    let without = ageing(None);
    assert!(without.joint_serial_number.is_empty() && without.stop_life_damage.is_empty());
    let with = ageing(Some(LivingJoints::of_table(&config, None).unwrap()));
    assert_eq!(with.joint_serial_number.first().unwrap(), &format!("J-{joints}"));
    assert_eq!(with.joint_serial_number.last().unwrap(), "J-1");
    assert_eq!(with.link_life_damage_high, vec![0.0; joints]);
    assert_eq!(with.stop_damage_rate, without.stop_damage_rate);
}

/// A member of a look-ahead and the twin of the package for Python have a session that was never begun: it judges as
/// the others do, and sends nothing.
#[test]
fn a_session_that_was_not_begun_judges_and_sends_nothing() {
    let config = config();
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(&config, &config.outputs.rates));
    let mut frame = run.new_frame();
    run.capture(&mut frame);
    let hazard = flexdrill_motion::HazardKind::BackwardWhirl;
    frame.snapshot.hazards.drive = flexdrill_motion::DriveState::Turning;
    frame.snapshot.hazards.list[hazard as usize].severity = flexdrill_motion::Severity::Critical;
    let id = crate::alarms::AlarmId::of_hazard(hazard);
    let (mut silent, mut begun, mut host) = (session(&config), session(&config), Kept::default());
    begun.begin(START, &mut host).unwrap();
    let mut events = silent.alarms_mut().take_events();
    for tenth in 0..100 {
        let stamp = START + tenth * SECOND / 10;
        events.extend(silent.judge(&frame.snapshot, stamp));
        begun.observe(&frame.snapshot, stamp);
    }
    assert!(silent.alarms().active(id).is_some());
    assert_eq!(silent.alarms().active(id), begun.alarms().active(id));
    let published = begun.publish_alarms(Header::default(), 0, &mut host).unwrap();
    // As texts: what is not known of a place is NaN, which is not equal to itself.
    assert_eq!(format!("{events:?}"), format!("{published:?}"));
    assert!(events.iter().any(|event| event.id == id.id()));
    let before = host.sent.len();
    silent.frame(&frame, &mut host).unwrap();
    silent.applied(&run.applied(), &[], 0, &mut host).unwrap();
    silent.repeat_applied(&frame, &mut host).unwrap();
    assert_eq!((host.sent.len(), silent.instant(0)), (before, None));
}

/// The tool of config/default.yaml at rest under a weight (kN), with this in place of its guide's stiffness: what the
/// newest message of the first second says.
fn at_rest(bending_factor: &str) -> HoleAhead {
    let text = include_str!("../../../../config/default.yaml");
    let text = text
        .replace("bending_factor: 1.0 ", &format!("bending_factor: {bending_factor} "))
        .replace("initial_kn: 0", "initial_kn: 10");
    let config = Arc::new(Config::from_text("a tool at rest", &text).unwrap());
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(&config, &config.outputs.rates));
    let mut frame = run.new_frame();
    let (mut session, mut host) = (session(&config), Kept::default());
    session.begin(START, &mut host).unwrap();
    session.applied(&run.applied(), &[], 0, &mut host).unwrap();
    while !host.counts().contains_key(topics::HOLE_AHEAD.name) {
        assert!(frame.snapshot.time < 1.5, "no message");
        assert!(!matches!(
            run.advance(),
            flexdrill_core::dynamics::StepOutcome::Failed(_)
        ));
        if !run.due().is_empty() {
            run.capture(&mut frame);
            session.frame(&frame, &mut host).unwrap();
            session.publish_hole(true, &mut host).unwrap();
        }
    }
    let (_, stamp, cdr) = host
        .sent
        .iter()
        .rfind(|(topic, ..)| *topic == topics::HOLE_AHEAD.name)
        .unwrap();
    let message: HoleAhead = from_cdr(cdr).unwrap();
    assert_eq!(message.header.stamp.to_nanoseconds(), *stamp);
    message
}

/// Side force and tilt at rest at 10 kN after 90 degrees of arc against a static program of finite differences that was
/// written apart from this one, for a guide as curved as the hole: 4083 N and -6.636 mrad, with a bending factor of
/// 0.05 1930 N and -13.906 mrad. The twin holds the pipe's end too (23 N) and has friction: 2 %.
#[test]
fn a_tool_at_rest_has_the_side_force_of_the_statics() {
    for (bending_factor, force, tilt) in [("1.0", 4083.0, -6.636e-3), ("0.05", 1930.0, -13.906e-3)] {
        let message = at_rest(bending_factor);
        assert!(
            (message.side_force_low / force - 1.0).abs() < 0.02,
            "{}",
            message.side_force_low
        );
        assert!((message.tilt_low / tilt - 1.0).abs() < 0.02, "{}", message.tilt_low);
        // Nothing turns, so that nothing points sideways.
        assert!(message.side_force_right.abs() < 5.0, "{}", message.side_force_right);
        assert!(
            !message.known && message.because.contains("as_built"),
            "{}",
            message.because
        );
        assert!((message.inclination - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        assert!((message.measured_depth - 3.2 * std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        assert_eq!(message.turns, 0);
    }
}

/// The torque T that turns with a hole of radius R pushes the bit to the right by T/R: 92.4 N m over 3.2 m, 28.9 N. The
/// standard error of a mean over 30 s is 7.5 N: two of them.
#[test]
fn the_torque_pushes_a_running_bit_to_the_right() {
    let text = include_str!("../../../../config/default.yaml").replace("initial_kn: 0", "initial_kn: 10");
    let config = Arc::new(Config::from_text("a tool that runs", &text).unwrap());
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(&config, &config.outputs.rates));
    let mut inputs = run.applied();
    inputs.inputs.rotary_speed = 40.0 * std::f64::consts::TAU / 60.0;
    run.apply(&inputs);
    let (mut frame, mut time, mut right, mut torque) = (run.new_frame(), 0.0, 0.0, 0.0);
    // Ten seconds for the motion to settle.
    while frame.snapshot.time < 40.0 {
        assert!(!matches!(
            run.advance(),
            flexdrill_core::dynamics::StepOutcome::Failed(_)
        ));
        if run.due().has(flexdrill_core::twin::Output::Alarms) {
            run.capture(&mut frame);
            let part = &frame.snapshot.steering;
            if frame.snapshot.time > 10.0 {
                time += part.duration;
                right += part.duration * part.side_force[0];
                torque += part.duration * part.torque;
            }
        }
    }
    assert!((time - 30.0).abs() < 0.2, "{time}");
    let (right, torque) = (right / time, torque / time);
    assert!((torque - 92.4).abs() < 1.0, "{torque}");
    assert!((right - torque / 3.2).abs() < 15.0, "{right}");
}
