//! The publisher's thread: frames and events of the solver become messages, for DDS and the recording alike; status and
//! diagnostics follow the wall clock, so that they go on when the model does not.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::alarms::{self, AlarmDesk};
use super::control::Change;
use super::publishers::Publishers;
use super::rig::{Now, Received, RigTime, ToRecord};
use super::thinned::{Share, Thinned};
use crate::alarms::{another_of_this_name, not_in_real_time};
use crate::bag::RecordingThread;
use crate::dds::port::Monitor;
use crate::health::diagnostics;
use crate::health::motion::MotionEvidence;
use crate::health::status::{OutputCount, Sources, StatusKeeper};
use crate::live::LiveServer;
use crate::messages::diagnostic_msgs::DiagnosticArray;
use crate::messages::outputs::{Encoded, Outputs, ParameterChange};
use crate::messages::std_msgs::Float64;
use crate::messages::topics::{self, TopicInfo};
use crate::messages::{CdrError, Message, TwinStatus, to_cdr};
use crate::rig_inputs::Intake;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::inputs::Conditioner;
use flexdrill_core::twin::{Output, RunInputs};
use flexdrill_realtime::link::{Gauges, LoopEvent, PublisherEnd};
use flexdrill_realtime::monotonic;
use flexdrill_text::{Throttle, Throttles};

/// How often the rings are polled: the delay that publishing adds.
const POLL: Duration = Duration::from_millis(1);
/// How often the node's own alarms are judged (Hz): ten times within their shortest default delay.
const NODE_ALARM_RATE: f64 = 5.0;

/// Least time between two lines about failed steps of one cause (s).
const FAILURE_INTERVAL: f64 = 1.0;

/// Least time between two lines about other nodes of this one's name (s).
const NAMESAKE_INTERVAL: f64 = 60.0;

/// What the publisher's thread is made of.
pub struct PublisherParts {
    /// From the solver.
    pub end: PublisherEnd,
    /// Output topics.
    pub publishers: Publishers,
    /// Recording, if any.
    pub recording: Option<RecordingThread>,
    /// Live over WebSocket, if asked for.
    pub live: Option<LiveServer>,
    /// Samples as received.
    pub received: ToRecord,
    /// Parameters that changed.
    pub changes: Receiver<Change>,
    /// The configuration at the start.
    pub config: Arc<Config>,
    /// Of the solver.
    pub gauges: Arc<Gauges>,
    /// Alarms.
    pub alarms: AlarmDesk,
    /// Inputs.
    pub conditioner: Arc<Mutex<Conditioner>>,
    /// Who sends them. Where both are locked, this comes first.
    pub intake: Arc<Mutex<Intake>>,
    /// Time as the conditioner counts it.
    pub now: Now,
    /// `/clock` paces the model.
    pub use_sim_time: bool,
    /// Present instant on the rig's clock (ns since 1970).
    pub rig_time: RigTime,
    /// DDS.
    pub dds: Monitor,
    /// Name of the node, for the diagnostics.
    pub node_name: String,
    /// Set when the thread is to write what is left and end.
    pub finish: Arc<AtomicBool>,
}

/// Turns what happens in the run into messages.
pub struct Publisher {
    parts: PublisherParts,
    outputs: Option<Outputs>,
    thinned: Thinned,
    status: StatusKeeper,
    motion: MotionEvidence,
    /// The failed step, while the model is stopped by it.
    failure: Option<StepFailure>,
    pending: Vec<Change>,
    next_status: u64,
    next_diagnostics: u64,
    next_alarms: u64,
    namesake_lines: Throttle,
    namesake: bool,
    newest_status: TwinStatus,
    late: bool,
    failure_lines: Throttles<&'static str>,
    /// The last failure was logged.
    failure_told: bool,
}

impl Publisher {
    /// A publisher of a run with this configuration.
    ///
    /// # Errors
    /// When the meters cannot be made.
    pub fn new(parts: PublisherParts) -> Result<Self, hdrhistogram::CreationError> {
        let status = StatusKeeper::new(parts.config.solver.time_step, parts.config.hash())?;
        let now = monotonic::now();
        Ok(Self {
            thinned: Thinned::new(&parts.config),
            parts,
            outputs: None,
            status,
            motion: MotionEvidence::default(),
            failure: None,
            pending: Vec::new(),
            next_status: now,
            next_diagnostics: now,
            next_alarms: now,
            namesake_lines: Throttle::new(NAMESAKE_INTERVAL),
            namesake: false,
            newest_status: TwinStatus::default(),
            late: false,
            failure_lines: Throttles::new(FAILURE_INTERVAL),
            failure_told: false,
        })
    }

    /// Runs until `finish` is set; gives back the recording and the last status.
    pub fn run(mut self) -> (Option<RecordingThread>, TwinStatus) {
        loop {
            let finish = self.parts.finish.load(Ordering::Acquire);
            let worked = self.poll();
            if finish {
                break;
            }
            if !worked {
                std::thread::sleep(POLL);
            }
        }
        self.send_status();
        let header = self.header();
        alarms::publish(&mut self.parts, header, monotonic::now());
        if let Some(dropped) = self
            .parts
            .live
            .map(|live| live.dropped())
            .filter(|dropped| *dropped > 0)
        {
            tracing::warn!("{dropped} messages were not shown live: the live thread got no processor");
        }
        (self.parts.recording, self.newest_status)
    }

    /// Publishes what is there; whether there was something of the solver.
    fn poll(&mut self) -> bool {
        match (self.parts.gauges.start(), &mut self.outputs) {
            (Some(start), None) => self.begin(start),
            (Some(start), Some(outputs)) => outputs.set_start(start),
            (None, _) => {}
        }
        let mut worked = false;
        while let Ok(event) = self.parts.end.events.pop() {
            worked = true;
            if let Err(error) = self.publish_event(event) {
                tracing::error!("a message could not be encoded: {error}");
            }
        }
        while let Ok(time) = self.parts.end.step_times.pop() {
            self.status.step_times.add(time);
        }
        while let Some(received) = self.parts.received.take() {
            self.record_received(received);
        }
        if let Some(recording) = &self.parts.recording {
            for (topic, samples) in self.parts.received.missed() {
                recording.lose(topic, samples);
            }
        }
        let now = monotonic::now();
        self.status.note(self.pace_time(), &self.parts.gauges);
        let rates = self.parts.config.outputs.rates;
        if due(&mut self.next_status, now, rates.status) {
            self.send_status();
        }
        if due(&mut self.next_diagnostics, now, rates.diagnostics) {
            self.send_diagnostics();
        }
        if due(&mut self.next_alarms, now, NODE_ALARM_RATE) {
            let pace = self.status.pace();
            alarms::judge_node(&mut self.parts, self.failure, pace);
        }
        let parts = &mut self.parts;
        parts.alarms.answer(|| (parts.rig_time)());
        if self.parts.alarms.is_due(now) {
            let header = self.header();
            alarms::publish(&mut self.parts, header, now);
        }
        worked
    }

    /// The model has started: the clock of the run is known.
    fn begin(&mut self, start: i64) {
        let config = Arc::clone(&self.parts.config);
        let mut outputs = Outputs::new(&config, start);
        let configuration = config.to_yaml().unwrap_or_default();
        let parts = &self.parts;
        let sent = outputs.session(&config.hash(), &configuration, |encoded| parts.send(encoded));
        if let Err(error) = sent {
            tracing::error!("{error}");
        }
        self.outputs = Some(outputs);
    }

    fn publish_event(&mut self, event: LoopEvent) -> Result<(), CdrError> {
        match event {
            LoopEvent::Frame(frame) => {
                self.status.observe(&frame.snapshot);
                self.motion = MotionEvidence::of(&frame.snapshot);
                let (parts, thinned) = (&self.parts, &mut self.thinned);
                let began = monotonic::now();
                let sent = self.outputs.as_mut().map_or(Ok(()), |outputs| {
                    outputs.frame(&frame, |encoded| {
                        match thinned.share(&frame, encoded.topic, encoded.cdr)? {
                            Share::Same => parts.publishers.publish(encoded.topic, encoded.cdr),
                            Share::Instead(cdr) => parts.publishers.publish(encoded.topic, &cdr),
                            Share::Nothing => {}
                        }
                        keep(&parts.beside(), encoded.topic, encoded.stamp, encoded.cdr);
                        Ok::<(), CdrError>(())
                    })?;
                    thinned.end_frame(&frame);
                    outputs.repeat_applied(&frame, |encoded| parts.send(encoded))
                });
                self.status.add_publishing(monotonic::now().saturating_sub(began));
                if let Some(outputs) = self.outputs.as_ref().filter(|_| frame.due.has(Output::Alarms)) {
                    let stamp = outputs.instant(frame.ticks);
                    self.parts.alarms.observe_tool(&frame.snapshot, stamp);
                }
                // There is room: no more frames are in circulation than the ring holds.
                let _ = self.parts.end.empty.push(frame);
                sent
            }
            LoopEvent::Applied {
                inputs,
                ticks,
                commands,
            } => self.applied(&inputs, ticks, commands),
            LoopEvent::Failed(failure, _) => {
                self.status.fail(failure);
                self.failure = Some(failure);
                // Inputs that change all the time try the step again all the time.
                let clock = monotonic::now() as f64 * 1e-9;
                let more = self.failure_lines.ending(failure.cause.name(), clock);
                self.failure_told |= more.is_some();
                if let Some(more) = more {
                    tracing::error!(
                        "a step failed at model time {:.4} s: {failure}; the outputs are frozen until the inputs change or \
                         ~/reset is called{more}",
                        failure.time
                    );
                    self.send_status();
                    self.send_diagnostics();
                }
                Ok(())
            }
            LoopEvent::Recovered => {
                if std::mem::take(&mut self.failure_told) {
                    tracing::info!("the model runs again");
                }
                self.failure = None;
                Ok(())
            }
        }
    }

    fn applied(&mut self, inputs: &RunInputs, ticks: u64, commands: u64) -> Result<(), CdrError> {
        if inputs.reset {
            self.failure = None;
        }
        self.pending.extend(self.parts.changes.try_iter());
        let (acting, waiting): (Vec<Change>, Vec<Change>) = std::mem::take(&mut self.pending)
            .into_iter()
            .partition(|change| change.command <= commands);
        self.pending = waiting;
        let mut values: Vec<ParameterChange> = Vec::new();
        for change in acting {
            values.extend(change.values);
            self.parts.config = change.config;
        }
        self.parts.alarms.reconfigure(&self.parts.config);
        self.thinned.reconfigure(inputs.schedule, &self.parts.config);
        let parts = &self.parts;
        let Some(outputs) = self.outputs.as_mut() else {
            return Ok(());
        };
        outputs.reconfigure(&parts.config);
        outputs.applied(inputs, &values, ticks, |encoded| parts.send(encoded))
    }

    fn record_received(&self, received: Received) {
        if self.parts.recording.is_none() && self.parts.live.is_none() {
            return;
        }
        let topic = received.topic();
        let cdr = match received {
            Received::Plain { value, .. } => to_cdr(&Float64 { data: value }),
            Received::Stamped(message) => to_cdr(&message),
        };
        if let Ok(cdr) = cdr {
            keep(&self.parts.beside(), topic, (self.parts.rig_time)(), &cdr);
        }
    }

    fn send_status(&mut self) {
        let header = self.header();
        let parts = &self.parts;
        let intake = parts.intake.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let conditioner = parts.conditioner.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let outputs: Vec<OutputCount<'_>> = parts.publishers.counts().collect();
        let sources = Sources {
            gauges: &parts.gauges,
            conditioner: &conditioner,
            intake: &intake,
            now: (parts.now)(),
            pace_time: self.pace_time(),
            outputs: &outputs,
            recording: parts.recording.as_ref(),
            dds: &parts.dds.health(),
            namesakes: &parts.dds.namesakes(),
        };
        let status = self.status.status(header, &sources);
        self.parts.send_message(&topics::STATUS, &status, self.instant());
        self.log_lateness(&status);
        self.log_namesakes(&status);
        self.newest_status = status;
    }

    /// One line when the model falls out of real time, one when it is back.
    fn log_lateness(&mut self, status: &TwinStatus) {
        match status.pace {
            TwinStatus::PACE_FAR_BEHIND if !self.late => {
                tracing::warn!(
                    "not in real time: {}; close other programs and viewers, set solver.step: fixed for the next run, or \
                     use a computer with faster cores",
                    not_in_real_time(status.pace_factor)
                );
                self.late = true;
            }
            TwinStatus::PACE_KEPT if self.late => {
                tracing::info!("in real time again");
                self.late = false;
            }
            _ => {}
        }
    }

    /// One line when another node of this name appears, one a minute while it stays, one when it has gone: both take the
    /// rig's inputs and publish to the same topics.
    fn log_namesakes(&mut self, status: &TwinStatus) {
        if status.namesake.is_empty() {
            if std::mem::take(&mut self.namesake) {
                tracing::info!("no other node has the name of this one any more");
            }
            return;
        }
        self.namesake = true;
        if let Some(more) = self.namesake_lines.ending(monotonic::now() as f64 * 1e-9) {
            tracing::warn!(
                "{}; start one of them with another --namespace{more}",
                another_of_this_name(&status.namesake)
            );
        }
    }

    fn send_diagnostics(&mut self) {
        let alarms = self.parts.alarms.list(self.header());
        let message = DiagnosticArray {
            header: self.header(),
            status: diagnostics::items(&self.parts.node_name, &self.newest_status, &self.motion, &alarms),
        };
        self.parts.send_message(&topics::DIAGNOSTICS, &message, self.instant());
    }

    /// Time that the model is to keep up with (ns). Under `/clock`, which jumps and may stand still, it is what the model
    /// has gone through or given up.
    fn pace_time(&self) -> u64 {
        if self.parts.use_sim_time {
            let ticks = self.parts.gauges.ticks.load(Ordering::Relaxed);
            (ticks as f64 * self.parts.config.solver.time_step * 1e9) as u64
        } else {
            monotonic::now()
        }
    }

    /// The present instant of the run (ns since 1970).
    fn instant(&self) -> i64 {
        match &self.outputs {
            Some(outputs) => outputs.instant(self.parts.gauges.ticks.load(Ordering::Relaxed)),
            None => (self.parts.rig_time)(),
        }
    }

    fn header(&self) -> crate::messages::std_msgs::Header {
        crate::messages::std_msgs::Header {
            stamp: crate::messages::builtin_interfaces::Time::from_nanoseconds(self.instant()),
            frame_id: self.parts.config.outputs.frame_id.clone(),
        }
    }
}

impl PublisherParts {
    fn send(&self, encoded: Encoded<'_>) -> Result<(), CdrError> {
        send(&self.publishers, &self.beside(), encoded);
        Ok(())
    }

    fn beside(&self) -> Beside<'_> {
        Beside::new(self.recording.as_ref(), self.live.as_ref())
    }

    fn send_message<M: Message>(&self, topic: &'static TopicInfo, message: &M, stamp: i64) {
        match to_cdr(message) {
            // Counted when there is no room.
            Ok(cdr) => drop(self.send(Encoded {
                topic,
                stamp,
                cdr: &cdr,
            })),
            Err(error) => tracing::error!("{error}"),
        }
    }
}

/// Who gets the bytes beside DDS; neither is waited for.
#[derive(Clone, Copy)]
pub(super) struct Beside<'a> {
    recording: Option<&'a RecordingThread>,
    live: Option<&'a LiveServer>,
}

impl<'a> Beside<'a> {
    /// A recording and a live server, where there are such.
    pub(super) fn new(recording: Option<&'a RecordingThread>, live: Option<&'a LiveServer>) -> Self {
        Self { recording, live }
    }
}

/// The same bytes to DDS, to the recording and to who looks live.
pub(super) fn send(publishers: &Publishers, beside: &Beside<'_>, encoded: Encoded<'_>) {
    publishers.publish(encoded.topic, encoded.cdr);
    keep(beside, encoded.topic, encoded.stamp, encoded.cdr);
}

fn keep(beside: &Beside<'_>, topic: &TopicInfo, stamp: i64, cdr: &[u8]) {
    if let Some(recording) = beside.recording {
        recording.record(topic, stamp, cdr);
    }
    if let Some(live) = beside.live
        && let Some(number) = topics::ALL.iter().position(|known| known.name == topic.name)
    {
        live.publish(number, stamp, cdr);
    }
}

/// Whether something at `rate` (Hz) is due; moves the deadline on its grid.
fn due(next: &mut u64, now: u64, rate: f64) -> bool {
    if rate <= 0.0 || now < *next {
        return false;
    }
    let interval = (1e9 / rate) as u64;
    *next += interval.max(1);
    if *next <= now {
        *next = now + interval;
    }
    true
}
