//! The publisher's thread. It turns frames and events of the solver into messages, the same bytes for DDS, the recording
//! and the viewers. Status and diagnostics follow the wall clock, so that they continue when the model stands still.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

use super::alarms::{self, AlarmDesk};
use super::clocks::Clocks;
use super::control::ParameterUpdate;
use super::following::{self, Moves};
use super::forecast::ForecastDesk;
use super::inputs::RigInputs;
use super::publishers::Publishers;
use super::received::{Received, ReceivedQueue};
use super::thinned::{Share, Thinned};
use crate::alarms::{another_of_this_name, not_in_real_time};
use crate::bag::RecordingThread;
use crate::compare::RigComparison;
use crate::health::diagnostics::{self, RigEvidence};
use crate::health::motion::MotionEvidence;
use crate::health::status::{OutputCount, Sources, StatusKeeper};
use crate::live::LiveServer;
use crate::window::SafeWindow;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::twin::{Output, RunInputs};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::diagnostic_msgs::DiagnosticArray;
use flexdrill_messages::std_msgs::{Float64, Header};
use flexdrill_messages::topics;
use flexdrill_messages::{CdrError, Residuals, TwinStatus, to_cdr};
use flexdrill_outputs::{Encoded, Outputs, ParameterChange};
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
    /// The configuration at the start.
    pub config: Arc<Config>,
    /// Gauges of the solver.
    pub gauges: Arc<Gauges>,
    /// Alarms.
    pub alarms: AlarmDesk,
    /// The rig's inputs.
    pub inputs: RigInputs,
    /// The clocks of the node.
    pub clocks: Clocks,
    /// The state of DDS.
    pub dds: Monitor,
    /// Absolute name of the node, for the diagnostics.
    pub node_name: String,
    /// Set when the thread is to publish what is queued, and end.
    pub finish: Arc<AtomicBool>,
    /// The map of speed and weight, where one is loaded.
    pub window: Option<Arc<SafeWindow>>,
    /// Forecasts and what came; none where they are off.
    pub forecasts: Option<ForecastDesk>,
    /// Takes the moves of what follows the rig.
    pub moves: Moves,
}

/// Publishes the run.
pub struct Publisher {
    parts: PublisherParts,
    outputs: Option<Outputs>,
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
    rig: RigComparison,
    /// The newest comparison of rig and twin.
    residuals: Option<Residuals>,
}

impl Publisher {
    /// A publisher of a run with this configuration.
    ///
    /// # Errors
    /// When the histogram of the step times cannot be created.
    pub fn new(parts: PublisherParts) -> Result<Self, hdrhistogram::CreationError> {
        let status = StatusKeeper::new(Arc::clone(&parts.config))?;
        let now = monotonic::now();
        Ok(Self {
            thinned: Thinned::new(&parts.config),
            rig: RigComparison::new(&parts.config),
            residuals: None,
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
        let header = self.header();
        alarms::publish(&mut self.parts, header, monotonic::now());
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
        // Stamps need the instant of the first step, so the outputs begin once the solver has fixed it.
        match (self.parts.gauges.start(), &mut self.outputs) {
            (Some(start), None) => self.begin(start),
            (Some(start), Some(outputs)) => outputs.set_start(start),
            (None, _) => {}
        }
        let mut worked = false;
        // Events before statistics: a frame changes what the status reports in this same call.
        while let Ok(event) = self.parts.end.events.pop() {
            worked = true;
            if let Err(error) = self.publish_event(event)
                && let Some(more) = log_ending("message not encoded")
            {
                tracing::error!("a message could not be encoded: {error}{more}");
            }
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
        let rates = self.parts.config.outputs.rates;
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
            alarms::judge_node(&mut self.parts, self.failure, pace);
        }
        self.send_forecast();
        let parts = &mut self.parts;
        // Requests of operators are answered before the list is published,
        // so that an acknowledgement is in the next list.
        parts.alarms.answer(|| parts.clocks.rig_time());
        if self.parts.alarms.is_due(now) {
            let header = self.header();
            alarms::publish(&mut self.parts, header, now);
        }
        worked
    }

    /// Publishes the session. It needs the start of the model on the rig's clock.
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
        if let Some(window) = &self.parts.window {
            let message = window.message(self.header());
            self.parts.send_message(&topics::SAFE_WINDOW, &message, self.instant());
        }
    }

    fn publish_event(&mut self, event: LoopEvent) -> Result<(), CdrError> {
        match event {
            LoopEvent::Frame(frame) => {
                // The status sees every frame, also those that are not due on any topic.
                self.status.observe(&frame.snapshot);
                self.motion = MotionEvidence::of(&frame.snapshot);
                let (parts, thinned) = (&self.parts, &mut self.thinned);
                let began = monotonic::now();
                let sent = self.outputs.as_mut().map_or(Ok(()), |outputs| {
                    // Each message is encoded once. DDS may get fewer of them, and
                    // combined ones; recording and viewers always get all.
                    outputs.frame(&frame, |encoded| {
                        match thinned.share(&frame, encoded.topic, encoded.cdr)? {
                            Share::Same => parts.publishers.publish(encoded.topic, encoded.cdr),
                            Share::Combined(cdr) => parts.publishers.publish(encoded.topic, &cdr),
                            Share::Nothing => {}
                        }
                        parts.sinks().write(encoded);
                        Ok::<(), CdrError>(())
                    })?;
                    thinned.end_frame(&frame);
                    // The applied inputs are repeated, so that a recording that begins later has those in force.
                    outputs.repeat_applied(&frame, |encoded| parts.send(encoded))
                });
                self.status.add_publishing(monotonic::now().saturating_sub(began));
                if let Some(desk) = &mut self.parts.forecasts {
                    desk.observe(&frame);
                }
                // Alarms are judged at their rate in model time, so that a replay judges at the same steps.
                if let Some(outputs) = self.outputs.as_ref().filter(|_| frame.due.has(Output::Alarms)) {
                    let stamp = outputs.instant(frame.ticks);
                    self.parts.alarms.observe_tool(&frame.snapshot, stamp);
                    let compared = following::compare_with_rig(&mut self.parts, &mut self.rig, &frame, stamp);
                    // Between two comparisons the last one remains what the rig's alarm is judged by.
                    self.residuals = compared.or(self.residuals.take());
                }
                // The ring has room for all frames in circulation, so that this cannot fail.
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
                // The alarm stands until the model runs again, whether or not the line below is logged.
                self.failure = Some(failure);
                // Inputs that change continuously repeat the step, and its failure, continuously.
                let clock = monotonic::now() as f64 * 1e-9;
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
        let mut values: Vec<ParameterChange> = Vec::new();
        for update in acting {
            values.extend(update.values);
            self.parts.config = update.config;
            self.status.reconfigure(&self.parts.config);
        }
        self.rig.reconfigure(&self.parts.config);
        if inputs.reset {
            self.rig.restart();
        }
        self.parts.alarms.reconfigure(&self.parts.config, &values);
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
            Received::Measured(message) => to_cdr(&message),
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
        if let Some(more) = self.namesake_lines.ending(monotonic::now() as f64 * 1e-9) {
            tracing::warn!(
                "{}; start one of them with another --namespace{more}",
                another_of_this_name(&status.namesake)
            );
        }
    }

    /// Publishes the forecast that has arrived, or gives up the one that stands.
    fn send_forecast(&mut self) {
        let (Some(desk), Some(outputs)) = (&mut self.parts.forecasts, &self.outputs) else {
            return;
        };
        let frame_id = &self.parts.config.outputs.frame_id;
        if let Some(forecast) = desk.take(frame_id, |ticks| outputs.instant(ticks)) {
            self.parts.send_message(&topics::FORECAST, &forecast, self.instant());
        }
    }

    fn send_diagnostics(&mut self) {
        let alarms = self.parts.alarms.list(self.header());
        let intake = self.parts.inputs.snapshot();
        let rig = RigEvidence {
            measured: intake.measured(),
            now: self.parts.clocks.age_time(),
            residuals: self.residuals.as_ref(),
        };
        let node = &self.parts.node_name;
        let mut status = diagnostics::items(node, &self.newest_status, &rig, &self.motion, &alarms);
        let look_ahead = self.parts.forecasts.as_ref();
        status.extend(look_ahead.map(|desk| desk.item(node, Instant::now())));
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
            (ticks as f64 * self.parts.config.solver.time_step * 1e9) as u64
        } else {
            monotonic::now()
        }
    }

    /// The present instant of the run (ns since 1970).
    fn instant(&self) -> i64 {
        match &self.outputs {
            Some(outputs) => outputs.instant(self.parts.gauges.ticks.load(Ordering::Relaxed)),
            None => self.parts.clocks.rig_time(),
        }
    }

    fn header(&self) -> Header {
        Header {
            stamp: Time::from_nanoseconds(self.instant()),
            frame_id: self.parts.config.outputs.frame_id.clone(),
        }
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
