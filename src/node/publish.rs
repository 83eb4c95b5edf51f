//! The publisher's thread. It turns frames and events of the solver into messages, the same bytes for DDS, the recording
//! and the viewers. Status and diagnostics follow the wall clock, so that they continue when the model stands still.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::time::Duration;

use super::alarms::{self, AlarmDesk};
use super::clocks::{Clocks, steady};
use super::confirmed::Confirmed;
use super::control::ParameterUpdate;
use super::following::Moves;
use super::host::NodeHost;
use super::inputs::RigInputs;
use super::life::JointLife;
use super::publishers::Publishers;
use super::received::{Received, ReceivedQueue};
use super::set_point::SharedSetPoint;
use super::thinned::Thinned;
use crate::ahead::ForecastDesk;
use crate::bag::RecordingThread;
use crate::drilling::live::SharedPoints;
use crate::health::conditions::{another_of_this_name, not_in_real_time};
use crate::health::diagnostics::{self, RigEvidence};
use crate::health::motion::MotionEvidence;
use crate::health::status::{OutputCount, Sources, StatusKeeper};
use crate::live::LiveServer;
use crate::session::Session;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::twin::RunInputs;
use flexdrill_messages::diagnostic_msgs::DiagnosticArray;
use flexdrill_messages::std_msgs::{Float64, Header};
use flexdrill_messages::topics;
use flexdrill_messages::{CdrError, TwinStatus, to_cdr};
use flexdrill_outputs::{Encoded, ParameterChange};
use flexdrill_realtime::link::{Gauges, LoopEvent, PublisherEnd};
use flexdrill_realtime::monotonic;
use flexdrill_ros2::dds::port::Monitor;
use flexdrill_text::{Throttle, Throttles, counted, log_ending};

/// How often the rings are polled: the delay that publishing adds.
const POLL: Duration = Duration::from_millis(1);
/// How often the node's own alarms are judged (Hz): ten times within their shortest default delay.
const NODE_ALARM_RATE: f64 = 5.0;

/// Least time between two lines about failed steps of one cause (s).
const FAILURE_INTERVAL: f64 = 1.0;

/// Least time between two lines about other nodes of this one's name (s).
const NAMESAKE_INTERVAL: f64 = 60.0;

/// The parts of the publisher's thread.
pub struct PublisherParts {
    /// Frames and events of the solver.
    pub end: PublisherEnd,
    /// Output topics.
    pub publishers: Publishers,
    /// Recording, if any.
    pub recording: Option<RecordingThread>,
    /// The server for viewers, if any.
    pub live: Option<LiveServer>,
    /// Samples as received.
    pub received: ReceivedQueue,
    /// Parameters that changed.
    pub parameter_updates: Receiver<ParameterUpdate>,
    /// Gauges of the solver.
    pub gauges: Arc<Gauges>,
    /// Requests, advice and memory of the alarms.
    pub alarms: AlarmDesk,
    /// The rig's inputs.
    pub inputs: RigInputs,
    /// Which mappings of bridges persons have confirmed.
    pub confirmed: Confirmed,
    /// The clocks of the node.
    pub clocks: Clocks,
    /// The state of DDS.
    pub dds: Monitor,
    /// Absolute name of the node, for the diagnostics.
    pub node_name: String,
    /// Set when the thread is to publish what is queued, and end.
    pub finish: Arc<AtomicBool>,
    /// Forecasts and what came; none where they are off.
    pub forecasts: Option<ForecastDesk>,
    /// What the driller has set.
    pub set_point: Arc<SharedSetPoint>,
    /// Takes the moves of what follows the rig.
    pub moves: Moves,
    /// Takes the hole as drilled, for checkpoints.
    pub drilled: Arc<SharedPoints>,
    /// Adds the run to the joints' lives; none without a table.
    pub life: Option<JointLife>,
}

/// Publishes the run.
pub struct Publisher {
    parts: PublisherParts,
    session: Session,
    thinned: Thinned,
    status: StatusKeeper,
    motion: MotionEvidence,
    /// The failed step, while the model is stopped by it.
    failure: Option<StepFailure>,
    /// Parameters whose command the solver has not carried out yet.
    pending: Vec<ParameterUpdate>,
    next_status: u64,
    next_diagnostics: u64,
    next_alarms: u64,
    namesake_lines: Throttle,
    namesake: bool,
    newest_status: TwinStatus,
    late: bool,
    failure_lines: Throttles<&'static str>,
    /// The last failure was logged.
    failure_logged: bool,
}

impl Publisher {
    /// A publisher of the session of a run that has not begun.
    ///
    /// # Errors
    /// When the histogram of the step times cannot be created.
    pub fn new(parts: PublisherParts, session: Session) -> Result<Self, hdrhistogram::CreationError> {
        let status = StatusKeeper::new(Arc::clone(session.config()))?;
        let now = monotonic::now();
        Ok(Self {
            thinned: Thinned::new(session.config()),
            parts,
            session,
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
            failure_logged: false,
        })
    }

    /// Runs until `finish` is set. Returns the recording and the last status.
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
        self.send_alarms(monotonic::now());
        if let Some(dropped) = self
            .parts
            .live
            .map(|live| live.dropped())
            .filter(|dropped| *dropped > 0)
        {
            tracing::warn!(
                "{} did not reach the viewers, because the live thread got no processor time",
                counted(dropped, "message")
            );
        }
        (self.parts.recording, self.newest_status)
    }

    /// Publishes everything that is queued or due. Returns whether the solver had sent something.
    fn poll(&mut self) -> bool {
        // Stamps need the instant of the first step, so the session begins once the solver has fixed it.
        match self.parts.gauges.start() {
            Some(start) if self.session.has_begun() => self.session.set_start(start),
            Some(start) => {
                let begun = self.session.begin(start, &mut NodeHost::all(&self.parts));
                log_unsent(begun);
            }
            None => {}
        }
        let mut worked = false;
        // Events before statistics: a frame changes what the status reports in this same call.
        while let Ok(event) = self.parts.end.events.pop() {
            worked = true;
            log_unsent(self.publish_event(event));
        }
        // Emptied at every call, as the ring has room for some time only; the percentiles need every step.
        while let Ok(time) = self.parts.end.step_times.pop() {
            self.status.step_times.add(time);
        }
        while let Some(received) = self.parts.received.pop() {
            self.record_received(received);
        }
        // Samples that the queue could not take are counted under their
        // topic, and the alarm on the recording sees them.
        if let Some(recording) = &self.parts.recording {
            for (topic, samples) in self.parts.received.missed() {
                recording.lose(topic, samples);
            }
        }
        // The rest runs by the wall clock: it must continue when the model stops or fails.
        let now = monotonic::now();
        self.status.note(self.pace_time(), &self.parts.gauges);
        let rates = self.session.config().outputs.rates;
        if due(&mut self.next_status, now, rates.status) {
            self.send_status();
        }
        if due(&mut self.next_diagnostics, now, rates.diagnostics) {
            self.send_diagnostics();
        }
        if due(&mut self.next_alarms, now, NODE_ALARM_RATE) {
            let pace = self.status.pace();
            // The node's alarms are judged at a fixed rate, not with the status:
            // a rate that a client sets must not delay an alarm.
            alarms::judge_node(&mut self.parts, self.session.alarms_mut(), self.failure, pace);
        }
        self.send_forecast();
        log_unsent(self.session.publish_bands(false, &mut NodeHost::all(&self.parts)));
        log_unsent(self.session.publish_hole(false, &mut NodeHost::all(&self.parts)));
        self.parts.drilled.update(self.session.drilled());
        // Requests of operators are answered before the list is published,
        // so that an acknowledgement is in the next list.
        let PublisherParts { alarms, clocks, .. } = &mut self.parts;
        alarms.answer(self.session.alarms_mut(), || clocks.rig_time());
        if self.session.alarms().is_due(now as i64) {
            self.send_alarms(now);
        }
        worked
    }

    /// Publishes events and list of the alarms that are due at an instant of the steady clock (ns).
    fn send_alarms(&mut self, clock: u64) {
        let header = self.header();
        let mut host = NodeHost::all(&self.parts);
        match self.session.publish_alarms(header, clock as i64, &mut host) {
            Ok(events) => self.parts.alarms.published(self.session.alarms(), &events),
            Err(error) => log_unsent(Err(error)),
        }
    }

    fn publish_event(&mut self, event: LoopEvent) -> Result<(), CdrError> {
        match event {
            LoopEvent::Frame(frame) => {
                // The status sees every frame, also those that are not due on any topic.
                self.status.observe(&frame.snapshot);
                self.motion = MotionEvidence::of(&frame.snapshot);
                self.parts.set_point.observe(&frame);
                let began = monotonic::now();
                let mut host = NodeHost::of_frame(&self.parts, &mut self.thinned, &frame);
                let sent = self.session.frame(&frame, &mut host);
                self.thinned.end_frame(&frame);
                let repeated = self.session.repeat_applied(&frame, &mut NodeHost::all(&self.parts));
                self.status.add_publishing(monotonic::now().saturating_sub(began));
                if let Some(desk) = &mut self.parts.forecasts {
                    desk.observe(&frame);
                }
                // The ring has room for all frames in circulation, so that this cannot fail.
                let _ = self.parts.end.empty.push(frame);
                sent.and(repeated)
            }
            LoopEvent::Applied {
                inputs,
                ticks,
                commands,
            } => self.applied(&inputs, ticks, commands),
            LoopEvent::Failed(failure, _) => {
                self.status.fail(failure);
                // The alarm stands until the model runs again, whether or not the line below is logged.
                self.failure = Some(failure);
                // Inputs that change continuously repeat the step, and its failure, continuously.
                let clock = steady();
                let more = self.failure_lines.ending(failure.cause.name(), clock);
                self.failure_logged |= more.is_some();
                if let Some(more) = more {
                    tracing::error!(
                        "a step failed at model time {:.4} s: {failure}; the outputs are frozen until the inputs change or \
                         ~/reset is called{more}",
                        failure.time
                    );
                    // A failure is published at once: the next status may be a second away.
                    self.send_status();
                    self.send_diagnostics();
                }
                Ok(())
            }
            LoopEvent::Recovered => {
                // A recovery is logged only if its failure was, or the log would have an end without a beginning.
                if std::mem::take(&mut self.failure_logged)
                    && let Some(more) = log_ending("the model runs again")
                {
                    tracing::info!("the model runs again{more}");
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
        if let Some(desk) = &mut self.parts.forecasts {
            desk.ask(inputs);
        }
        self.pending.extend(self.parts.parameter_updates.try_iter());
        let (acting, pending): (Vec<_>, Vec<_>) = std::mem::take(&mut self.pending)
            .into_iter()
            .partition(|update| update.command <= commands);
        self.pending = pending;
        let mut changes: Vec<ParameterChange> = Vec::new();
        let mut config = Arc::clone(self.session.config());
        for update in acting {
            changes.extend(update.values);
            config = update.config;
        }
        // Inputs that change come with the same configuration, again and again.
        if !Arc::ptr_eq(&config, self.session.config()) {
            self.session.reconfigure(&config, &changes);
            self.status.reconfigure(&config);
            self.parts.alarms.reconfigure(&config);
        }
        self.thinned.reconfigure(inputs.schedule, &config);
        let mut host = NodeHost::all(&self.parts);
        self.session.applied(inputs, &changes, ticks, &mut host)
    }

    fn record_received(&self, received: Received) {
        if self.parts.recording.is_none() && self.parts.live.is_none() {
            return;
        }
        let topic = received.topic();
        let cdr = match received {
            Received::Plain { value, .. } => to_cdr(&Float64 { data: value }),
            Received::Stamped(message) => to_cdr(&message),
            Received::Measured(message) => to_cdr(&message),
            Received::Survey(message) => to_cdr(&message),
        };
        if let Ok(cdr) = cdr {
            self.parts.sinks().write(Encoded {
                topic,
                stamp: self.parts.clocks.rig_time(),
                cdr: &cdr,
            });
        }
    }

    fn send_status(&mut self) {
        let header = self.header();
        let parts = &self.parts;
        let intake = parts.inputs.snapshot();
        let outputs: Vec<OutputCount<'_>> = parts.publishers.counts().collect();
        let sources = Sources {
            gauges: &parts.gauges,
            intake: &intake,
            now: parts.clocks.age_time(),
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

    /// Logs one line when the model falls behind real time, and one when it keeps real time again.
    fn log_lateness(&mut self, status: &TwinStatus) {
        match status.pace {
            TwinStatus::PACE_FAR_BEHIND if !self.late => {
                if let Some(more) = log_ending("not in real time") {
                    tracing::warn!(
                        "not in real time: {}; close other programs and viewers, set solver.step: fixed for the next run, \
                         or use a computer with faster cores{more}",
                        not_in_real_time(status.pace_factor)
                    );
                }
                self.late = true;
            }
            TwinStatus::PACE_KEPT if self.late => {
                if let Some(more) = log_ending("real time again") {
                    tracing::info!("the model keeps real time again{more}");
                }
                self.late = false;
            }
            _ => {}
        }
    }

    /// Logs one line when another node with this name appears, one per minute while it stays, and one when it has gone. Both
    /// nodes receive the rig's inputs and publish on the same topics.
    fn log_namesakes(&mut self, status: &TwinStatus) {
        if status.namesake.is_empty() {
            if std::mem::take(&mut self.namesake)
                && let Some(more) = log_ending("namesake gone")
            {
                tracing::info!("the other node with the name of this one has gone{more}");
            }
            return;
        }
        self.namesake = true;
        if let Some(more) = self.namesake_lines.ending(steady()) {
            tracing::warn!(
                "{}; start one of them with another --namespace{more}",
                another_of_this_name(&status.namesake)
            );
        }
    }

    /// Publishes the forecast that has arrived, or gives up the one that stands.
    fn send_forecast(&mut self) {
        let session = &self.session;
        let Some(desk) = self.parts.forecasts.as_mut().filter(|_| session.has_begun()) else {
            return;
        };
        let frame_id = &session.config().outputs.frame_id;
        if let Some(forecast) = desk.take(steady(), frame_id, session.seconds_of_tools(), |ticks| {
            session.instant(ticks).unwrap_or_default()
        }) {
            self.parts.send_message(&topics::FORECAST, &forecast, self.instant());
        }
    }

    fn send_diagnostics(&mut self) {
        let alarms = self.session.alarms().list(self.header());
        let intake = self.parts.inputs.snapshot();
        let rig = RigEvidence {
            measured: intake.measured(),
            surveys: intake.surveys(),
            stamp_time: self.parts.clocks.stamp_time(),
            now: self.parts.clocks.age_time(),
            residuals: self.session.residuals(),
        };
        let node = &self.parts.node_name;
        let mut status = diagnostics::items(node, &self.newest_status, &rig, &self.motion, &alarms);
        let look_ahead = self.parts.forecasts.as_ref();
        status.extend(look_ahead.map(|desk| desk.item(node, steady())));
        let message = DiagnosticArray {
            header: self.header(),
            status,
        };
        self.parts.send_message(&topics::DIAGNOSTICS, &message, self.instant());
    }

    /// The time with which the model must keep up (ns). Under `/clock`, which jumps and may stand still, it is the time of the
    /// steps that the model has taken or skipped.
    fn pace_time(&self) -> u64 {
        if self.parts.clocks.are_simulated() {
            let ticks = self.parts.gauges.ticks.load(Ordering::Relaxed);
            (ticks as f64 * self.session.config().solver.time_step * 1e9) as u64
        } else {
            monotonic::now()
        }
    }

    /// The present instant of the run (ns since 1970).
    fn instant(&self) -> i64 {
        let ticks = self.parts.gauges.ticks.load(Ordering::Relaxed);
        let of_run = self.session.instant(ticks);
        of_run.unwrap_or_else(|| self.parts.clocks.rig_time())
    }

    fn header(&self) -> Header {
        self.session.header(self.instant())
    }
}

/// Logs a message that could not be encoded.
fn log_unsent(sent: Result<(), CdrError>) {
    if let Err(error) = sent
        && let Some(more) = log_ending("message not encoded")
    {
        tracing::error!("a message could not be encoded: {error}{more}");
    }
}

/// Whether an output at `rate` (Hz) is due. Moves its deadline by whole intervals.
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
