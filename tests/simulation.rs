//! The node's world, simulated: one seed decides clock, rig, operator, machine and network, on one thread and far faster
//! than time. The solver's loop, the inputs' judgement, messages, status and alarms are the real ones; the tool is small.
//! Every fiftieth seed records with the real recorder, on a disk that is full from time to time.
//!
//! `FLEXDRILL_SEEDS=10000 cargo test --release --test simulation` runs so many; `FLEXDRILL_SEED=17` one, and tells of it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod bag_support;
#[path = "../crates/flexdrill-core/tests/support/random.rs"]
#[allow(dead_code, reason = "each test uses some of it")]
mod random;

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex};

use bag_support::witness::Witness;
use flexdrill::alarms::AlarmBook;
use flexdrill::dds::port::{Health, Restart};
use flexdrill::health::conditions::{NodeConditions, NodeState};
use flexdrill::health::status::{OutputCount, Sources, StatusKeeper};
use flexdrill::messages::builtin_interfaces::Time as Stamp;
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{Alarm, AlarmList, CdrError, TwinStatus, from_cdr, topics};
use flexdrill::residuals::{Comparison, RigComparison, Samples};
use flexdrill::rig_inputs::{DriverId, Intake, RigSample};
use flexdrill::session::{Host, Session};
use flexdrill_config::Config;
use flexdrill_core::inputs::{InputKind, InputState};
use flexdrill_core::twin::{Run, Simulation};
use flexdrill_outputs::Encoded;
use flexdrill_realtime::clock::Clock;
use flexdrill_realtime::link::{Command, Gauges, LoopEvent, PublisherEnd, RunState, Settings, Targets, link};
use flexdrill_realtime::{PaceReading, RealTimeLoop};
use random::Random;

const MS: u64 = 1_000_000;
const SECOND: u64 = 1000 * MS;
/// When the world begins, monotonic and on the rig's clock (ns).
const BEGIN: u64 = 1000 * SECOND;
const RIG_BEGIN: u64 = 1_700_000_000 * SECOND;
/// Length of a run.
const LENGTH: u64 = 20 * SECOND;

/// Two links of one element in 10 ms steps: the loop is what is tested, not the mechanics.
const CONFIG: &str = r#"
well:
  sections: [{arc: {radius: 3.2, build_angle_deg: 5.7}}]
  hole_diameter: 0.118
tool:
  links: 2
  elements_per_link: 1
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6.0}
  bit: {diameter: 0.118}
solver: {time_step: 0.005}
inputs:
  rotary_speed: {slow_age: 1.0, max_age: 2.0, hold_before_safe: 0.5, safe_ramp_rpm_per_s: 50}
  weight_on_bit: {slow_age: 1.0, max_age: 2.0, hold_before_safe: 0.5, safe_ramp_kn_per_s: 20}
outputs:
  rates: {joint_deflections: 10, contact_forces: 10, whirl: 5, bit_state: 10, tool_shape: 0, ageing: 1, reactions: 5,
          joint_states: 0}
"#;

/// Chances of a world.
trait Chance {
    fn one_in(&mut self, many: u64) -> bool;
}

impl Chance for Random {
    fn one_in(&mut self, many: u64) -> bool {
        self.below(many) == 0
    }
}

/// What happens in the world, each again and again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Happening {
    Publisher,
    Speed,
    Weight,
    Operator,
    Network,
    Disk,
}

/// Everything but the solver's loop.
struct World {
    chance: Random,
    now: u64,
    next: BTreeMap<Happening, u64>,
    config: Arc<Config>,
    intake: Intake,
    targets: Arc<Targets>,
    gauges: Arc<Gauges>,
    publisher: PublisherEnd,
    commands: rtrb::Producer<Command>,
    status: StatusKeeper,
    session: Session,
    conditions: NodeConditions,
    dds: Health,
    stamps: BTreeMap<&'static str, i64>,
    counts: BTreeMap<&'static str, u64>,
    stale_since: [Option<u64>; InputKind::COUNT],
    paused: bool,
    sequence: u64,
    next_status: u64,
    /// In some worlds, a recording of all that is published.
    witness: Option<Witness>,
    /// Of all that was published but the status, which tells of this machine's speed.
    digest: DefaultHasher,
}

impl World {
    fn rig_time(&self) -> i64 {
        (RIG_BEGIN + (self.now - BEGIN)) as i64
    }

    fn seconds(&self) -> f64 {
        self.now as f64 * 1e-9
    }

    /// Lets time go on to `until`, with all that happens before.
    fn live(&mut self, until: u64) {
        loop {
            let (&what, &at) = self.next.iter().min_by_key(|(what, at)| (**at, **what)).unwrap();
            if at > until {
                break;
            }
            self.now = self.now.max(at);
            let pause = self.happen(what);
            self.next.insert(what, self.now + pause);
        }
        self.now = self.now.max(until);
        self.gauges.stop.store(self.now >= BEGIN + LENGTH, Ordering::Relaxed);
    }

    /// One happening; how long until the next of its kind (ns).
    fn happen(&mut self, what: Happening) -> u64 {
        match what {
            Happening::Publisher => {
                self.publish();
                if self.now >= self.next_status {
                    self.next_status = self.now + SECOND / 5;
                    self.tell_status();
                    self.judge();
                }
                // Now and then its thread gets no processor for long.
                if self.chance.one_in(300) {
                    self.chance.below(3 * SECOND)
                } else {
                    5 * MS
                }
            }
            Happening::Speed => self.sample(InputKind::RotarySpeed),
            Happening::Weight => self.sample(InputKind::WeightOnBit),
            Happening::Operator => {
                self.operate();
                SECOND / 2 + self.chance.below(6 * SECOND)
            }
            Happening::Network => {
                self.dds.is_up = !self.dds.is_up;
                if self.dds.is_up {
                    self.dds.restarts += 1;
                    self.dds.newest = vec![Restart {
                        at: self.now,
                        cause: "it was killed".into(),
                    }];
                    SECOND + self.chance.below(20 * SECOND)
                } else {
                    self.chance.below(3 * SECOND)
                }
            }
            Happening::Disk => {
                if let Some(witness) = &mut self.witness {
                    witness.turn();
                }
                // The recorder lives in real time, a thousand times slower than this world: most worlds see one fault.
                10 * SECOND + self.chance.below(20 * SECOND)
            }
        }
    }

    /// A sample of the rig, good or not; how long until the next one.
    fn sample(&mut self, kind: InputKind) -> u64 {
        let rule = *self.intake.conditioner().rule(kind);
        let good = self.chance.within(rule.min, rule.max);
        let value = match self.chance.below(12) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            2 => rule.max * 10.0 + 1.0,
            3 => rule.min - 1.0,
            4 => 5e-324,
            _ => good,
        };
        let other = self.chance.one_in(20);
        let sample = RigSample {
            kind,
            value,
            id: DriverId([u8::from(other); 16]),
            time: self.seconds(),
            stamp: None,
        };
        let taken = self.intake.accept(&sample).is_ok();
        assert!(!taken || (rule.min..=rule.max).contains(&value), "{value} was taken");
        self.update_targets();
        match self.chance.below(30) {
            0 => SECOND + self.chance.below(8 * SECOND),
            1 => self.chance.below(2 * MS),
            _ => SECOND / 5 + self.chance.below(SECOND / 2),
        }
    }

    fn update_targets(&mut self) {
        let now = self.seconds();
        let targets = self.intake.conditioner().targets(now);
        let quality = self.intake.conditioner().quality(now);
        for kind in InputKind::ALL {
            let rule = self.intake.conditioner().rule(kind);
            let target = self.intake.conditioner().target(kind, now);
            let allowed = rule.min.min(rule.safe)..=rule.max.max(rule.safe);
            assert!(allowed.contains(&target), "{kind:?}: a target of {target}");
        }
        self.targets.set(targets, quality as u8);
    }

    fn operate(&mut self) {
        let command = match self.chance.below(4) {
            0 => {
                self.paused = !self.paused;
                Command::Pause(self.paused)
            }
            1 => Command::Reset,
            _ => {
                let factor = self.chance.within(0.05, 0.4);
                let changed = self.config.with_value("contact.inner.friction_tangential", factor);
                self.config = Arc::new(changed.unwrap());
                let simulation = self.config.simulation();
                Command::Settings(Settings {
                    live: self.config.live(),
                    slew: simulation.slew(),
                    whirl: self.config.whirl_settings(),
                    schedule: flexdrill_outputs::schedule(&self.config, &self.config.outputs.rates),
                })
            }
        };
        // The solver may be far behind; who asked is told then.
        let _ = self.commands.push(command);
    }

    /// What the publisher's thread does when it gets to it.
    fn publish(&mut self) {
        self.update_targets();
        let mut sent = Sent::default();
        if let Some(start) = self.gauges.start().filter(|_| !self.session.has_begun()) {
            self.session.begin(start, &mut sent).unwrap();
        }
        while let Ok(event) = self.publisher.events.pop() {
            match event {
                LoopEvent::Frame(frame) => {
                    self.status.observe(&frame.snapshot);
                    self.session.frame(&frame, &mut sent).unwrap();
                    self.publisher.empty.push(frame).unwrap();
                }
                LoopEvent::Applied { inputs, ticks, .. } => {
                    for (kind, value) in InputKind::ALL
                        .iter()
                        .zip(InputKind::ALL.map(|kind| inputs.inputs.get(kind)))
                    {
                        assert!(value.is_finite(), "{kind:?}: {value} was applied");
                    }
                    self.session.applied(&inputs, &[], ticks, &mut sent).unwrap();
                }
                LoopEvent::Failed(failure, _) => self.status.fail(failure),
                LoopEvent::Recovered => {}
            }
        }
        while self.publisher.step_times.pop().is_ok() {}
        self.status.note(self.now, &self.gauges);
        self.check_all(&sent.0);
    }

    /// What is published is on time, in order and a message.
    fn check_all(&mut self, sent: &[(&'static str, i64, Vec<u8>)]) {
        for (topic, stamp, bytes) in sent {
            assert!(*stamp <= self.rig_time(), "{topic}: a stamp of the future");
            let before = self.stamps.insert(topic, *stamp);
            assert!(
                before.is_none_or(|before| before <= *stamp),
                "{topic}: a stamp went back"
            );
            *self.counts.entry(topic).or_default() += 1;
            if let Some(witness) = &mut self.witness {
                witness.record(topic, *stamp, bytes);
            }
            (topic, stamp, bytes).hash(&mut self.digest);
        }
    }

    fn header(&self) -> Header {
        Header {
            stamp: Stamp::from_nanoseconds(self.rig_time()),
            frame_id: "flexible_tool".into(),
        }
    }

    fn tell_status(&mut self) {
        let counts: Vec<OutputCount<'_>> = self
            .counts
            .iter()
            .map(|(topic, sent)| OutputCount {
                topic,
                sent: *sent,
                dropped: 0,
            })
            .collect();
        let sources = Sources {
            gauges: &self.gauges,
            intake: &self.intake,
            now: self.seconds(),
            pace_time: self.now,
            outputs: &counts,
            recording: self.witness.as_ref().map(Witness::recording),
            dds: &self.dds,
            namesakes: &[],
        };
        let header = self.header();
        let status: TwinStatus = self.status.status(header, &sources);
        assert!(status.sequence > self.sequence);
        self.sequence = status.sequence;
        assert!(status.state <= TwinStatus::FAILED, "{}", status.state);
        for (index, state) in status.input_state.iter().enumerate() {
            assert!(*state <= TwinStatus::INPUT_ASSUMED, "{state}");
            let received = self.intake.conditioner().counts(InputKind::ALL[index]);
            assert_eq!(status.input_rejected[index], received.rejected.iter().sum::<u64>());
        }
        let numbers = [
            status.model_time,
            status.lateness,
            status.newton_iterations_mean,
            status.energy_error,
            status.energy_error_share,
        ];
        assert!(numbers.iter().all(|number| number.is_finite()), "{numbers:?}");
        let factors = [status.real_time_factor, status.pace_factor];
        assert!(factors.iter().all(|factor| !factor.is_infinite()), "{factors:?}");
        let judged = status.pace != TwinStatus::PACE_NOT_JUDGED;
        assert!(!judged || status.pace_factor.is_finite());
        if status.state != TwinStatus::RUNNING {
            assert!(
                !judged && status.real_time_factor.is_nan(),
                "a standing model has no pace"
            );
        }
        assert_eq!(status.dds_restarts, self.dds.restarts);
        assert_eq!(status.dds_up, self.dds.is_up);
        let off = status.recording_state == TwinStatus::RECORDING_OFF;
        assert_eq!(off, self.witness.is_none());
        // What was due is taken, given up or still to come; the loop says which.
        let gauges = &self.gauges;
        let [ticks, taken, skipped] =
            [&gauges.ticks, &gauges.steps_taken, &gauges.steps_skipped].map(|gauge| gauge.load(Ordering::Relaxed));
        assert_eq!(ticks, taken + skipped, "ticks");
    }

    fn judge(&mut self) {
        let now = self.seconds();
        let state = NodeState {
            conditioner: self.intake.conditioner(),
            dds: self.dds.clone(),
            now,
            namesakes: Vec::new(),
            drivers: InputKind::ALL.map(|kind| self.intake.drivers(kind, now)),
            run_state: self.gauges.run_state(),
            failure: None,
            pace: PaceReading::default(),
            recording: None,
        };
        let time = self.rig_time();
        let book = self.session.alarms_mut();
        book.advance(time);
        self.conditions.observe(book, &state, time);
        let header = self.header();
        let mut sent = Sent::default();
        self.session.publish_alarms(header, self.now as i64, &mut sent).unwrap();
        self.check_alarms(&sent.0);
        self.check_all(&sent.0);
    }

    /// An input that has been stale for longer than its alarm's delays calls, one that never was does not call high.
    fn check_alarms(&mut self, sent: &[(&'static str, i64, Vec<u8>)]) {
        for kind in InputKind::ALL {
            let is_stale = self.intake.conditioner().state(kind, self.seconds()) == InputState::Stale;
            let since = &mut self.stale_since[kind.index()];
            *since = if is_stale { since.or(Some(self.now)) } else { None };
        }
        for (_, _, bytes) in sent.iter().filter(|(topic, _, _)| *topic == topics::ALARMS.name) {
            let list: AlarmList = from_cdr(bytes).unwrap();
            for (kind, id) in InputKind::ALL.iter().zip(["rotary_speed_input", "weight_on_bit_input"]) {
                let alarm = list.alarms.iter().find(|alarm| alarm.id == id).unwrap();
                assert!(alarm.state <= Alarm::OUT_OF_SERVICE);
                let stale = self.stale_since[kind.index()];
                if stale.is_some_and(|since| self.now - since > 3 * SECOND) {
                    assert!(alarm.state != Alarm::NORMAL, "{id}: stale and silent");
                    assert!(
                        alarm.priority >= Alarm::MEDIUM,
                        "{id}: stale at priority {}",
                        alarm.priority
                    );
                }
            }
        }
    }
}

/// What a session has sent: topic, stamp (ns) and bytes. This rig measures nothing.
#[derive(Default)]
struct Sent(Vec<(&'static str, i64, Vec<u8>)>);

impl Host for Sent {
    type Error = CdrError;

    fn send(&mut self, encoded: Encoded<'_>) -> Result<(), CdrError> {
        self.0.push((encoded.topic.name, encoded.stamp, encoded.cdr.to_vec()));
        Ok(())
    }

    fn measured(&mut self, _: &mut RigComparison, _: u64, _: i64) -> Option<Samples> {
        None
    }

    fn compared(&mut self, _: &Comparison) {}
}

/// The world's clock: when the solver waits, the world lives.
struct WorldClock(Arc<Mutex<World>>);

impl Clock for WorldClock {
    fn now(&self) -> u64 {
        let mut world = self.0.lock().unwrap();
        // A step takes time; now and then the machine does something else.
        let hiccup = if world.chance.one_in(5000) {
            world.chance.below(SECOND)
        } else {
            20_000
        };
        world.now += hiccup;
        world.now
    }

    fn machine_time(&self) -> u64 {
        self.0.lock().unwrap().now
    }

    fn wait_until(&self, deadline: u64) {
        self.0.lock().unwrap().live(deadline);
    }

    fn rig_time(&self) -> u64 {
        self.0.lock().unwrap().rig_time() as u64
    }

    fn tolerance(&self) -> f64 {
        0.1
    }
}

/// Runs the world of a seed to its end; a digest of all that was published.
fn run(seed: u64, config: &Arc<Config>, fresh: &[u8]) -> u64 {
    let mut simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    simulation.restore(fresh).unwrap();
    let run = Run::new(simulation, flexdrill_outputs::schedule(config, &config.outputs.rates));
    let targets = Targets::new(config.simulation().initial_inputs);
    let gauges = Arc::new(Gauges::default());
    let (end, publisher, requests) = link(Arc::clone(&targets), Arc::clone(&gauges));
    let happenings = [
        Happening::Publisher,
        Happening::Speed,
        Happening::Weight,
        Happening::Operator,
        Happening::Network,
        Happening::Disk,
    ];
    let mut chance = Random(seed);
    let next = happenings
        .into_iter()
        .map(|what| {
            let first = if what == Happening::Disk { LENGTH } else { SECOND / 2 };
            (what, BEGIN + chance.below(first))
        })
        .collect();
    let world = World {
        chance,
        now: BEGIN,
        next,
        config: Arc::clone(config),
        intake: Intake::new(&config.inputs, config.used_inputs()),
        targets,
        gauges: Arc::clone(&gauges),
        publisher,
        commands: requests.commands,
        status: StatusKeeper::new(Arc::clone(config)).unwrap(),
        conditions: NodeConditions::default(),
        session: Session::new(
            Arc::clone(config),
            AlarmBook::fresh(Arc::clone(config), RIG_BEGIN as i64),
        ),
        dds: Health {
            is_up: true,
            ..Health::default()
        },
        stamps: BTreeMap::new(),
        counts: BTreeMap::new(),
        stale_since: [None; InputKind::COUNT],
        paused: false,
        sequence: 0,
        next_status: BEGIN,
        witness: seed.is_multiple_of(50).then(Witness::new),
        digest: DefaultHasher::new(),
    };
    let world = Arc::new(Mutex::new(world));
    RealTimeLoop::new(run, WorldClock(Arc::clone(&world)), end, 1).run();
    let mut world = world.lock().unwrap();
    world.publish();
    world.tell_status();
    assert_ne!(gauges.run_state(), RunState::Starting);
    assert_eq!(
        gauges.events_lost.load(Ordering::Relaxed),
        0,
        "no event found the ring full"
    );
    if let Some(witness) = world.witness.take() {
        witness.check();
    }
    world.digest.finish()
}

fn asked(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

#[test]
fn whatever_happens_the_promises_hold() {
    let config = Arc::new(Config::from_text("simulation.yaml", CONFIG).unwrap());
    let fresh = Simulation::new(&config.tool(), &config.simulation())
        .unwrap()
        .checkpoint()
        .unwrap();
    let seeds: Vec<u64> = match (asked("FLEXDRILL_SEED"), asked("FLEXDRILL_SEEDS")) {
        (Some(seed), _) => vec![seed],
        (None, Some(count)) => (0..count).collect(),
        // Ten thousand in CI; a developer's are quick.
        (None, None) => (0..if std::env::var_os("CI").is_some() { 10_000 } else { 300 }).collect(),
    };
    let began = std::time::Instant::now();
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for worker in 0..workers {
            let (seeds, config, fresh) = (&seeds, &config, &fresh);
            scope.spawn(move || {
                for seed in seeds.iter().skip(worker).step_by(workers) {
                    let told = std::panic::catch_unwind(|| run(*seed, config, fresh));
                    let Ok(digest) = told else {
                        panic!("seed {seed} fails; FLEXDRILL_SEED={seed} runs it alone");
                    };
                    // A seed is one world.
                    if seed.is_multiple_of(100) {
                        assert_eq!(run(*seed, config, fresh), digest, "seed {seed} twice");
                    }
                }
            });
        }
    });
    let simulated = seeds.len() as f64 * LENGTH as f64 * 1e-9;
    let seconds = began.elapsed().as_secs_f64();
    println!(
        "{} seeds, {simulated:.0} s of the world in {seconds:.1} s: {:.0} times real time",
        seeds.len(),
        simulated / seconds
    );
}
