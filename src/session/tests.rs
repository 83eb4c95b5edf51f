use std::collections::BTreeMap;

use super::*;
use crate::ensemble::{Ensemble, Pace};
use crate::rig_inputs::Measured;
use flexdrill_core::inputs::MeasuredKind;
use flexdrill_core::twin::{Run, Simulation};
use flexdrill_messages::RigMeasured;
use flexdrill_messages::topics::Cadence;
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
    let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/config/default.yaml")).unwrap();
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

/// A topic that the session does not send would be missing in every host, and none of them could add it: nothing else in
/// them sends messages of a run (`hosts_publish_nothing_of_their_own`, in `xtask/tests/arrows.rs`).
#[test]
fn all_topics_of_a_run_come_from_the_session() {
    let (session, host) = hosted(&config());
    let counts = host.counts();
    // A map is sent by sessions that have one, and nothing happens in two seconds that an alarm's event is of.
    let at_times = [topics::SAFE_WINDOW.name, topics::ALARM_EVENTS.name];
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

/// A member of a look-ahead has a session that was never begun: it judges as the others do, and sends nothing.
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
    let before = host.sent.len();
    for tenth in 0..100 {
        let stamp = START + tenth * SECOND / 10;
        silent.observe(&frame.snapshot, stamp);
        begun.observe(&frame.snapshot, stamp);
    }
    assert!(silent.alarms().active(id).is_some());
    assert_eq!(silent.alarms().active(id), begun.alarms().active(id));
    silent.frame(&frame, &mut host).unwrap();
    silent.applied(&run.applied(), &[], 0, &mut host).unwrap();
    silent.repeat_applied(&frame, &mut host).unwrap();
    assert_eq!((host.sent.len(), silent.instant(0)), (before, None));
}
