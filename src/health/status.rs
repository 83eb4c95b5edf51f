//! `twin/status`: collected from the solver's gauges, the snapshots, the inputs, the outputs and the recorder.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::step_times::StepTimes;
use crate::bag::RecordingThread;
use crate::dds::frames::Peer;
use crate::dds::port::Health;
use crate::messages::TwinStatus;
use crate::messages::std_msgs::Header;
use crate::rig_inputs::Intake;
use flexdrill_config::Config;
use flexdrill_core::dynamics::phases::{Phase as StepPhase, PhaseTimes};
use flexdrill_core::dynamics::{Energies, StepFailure};
use flexdrill_core::inputs::InputKind;
use flexdrill_core::twin::{ModelQuality, Snapshot, SolverCounters};
use flexdrill_realtime::link::{Gauges, RunState};
use flexdrill_realtime::{PaceReading, PaceWatch, RealTimeFactor};

/// Span of the real-time factor (s).
const FACTOR_SPAN: f64 = 1.0;

/// Keeps what the status needs between two messages.
pub struct StatusKeeper {
    /// Computing times of steps.
    pub step_times: StepTimes,
    factor: RealTimeFactor,
    pace: PaceWatch,
    sequence: u64,
    time_step: f64,
    begun: Arc<Config>,
    config_hash: String,
    /// What differs from it, in words.
    changed: Vec<String>,
    /// What makes the motion doubtful and no quality of the steps sees, in words.
    unseen: Option<String>,
    counters: SolverCounters,
    /// At the message before.
    counters_before: (SolverCounters, u64),
    /// Time per phase and steps taken at the message before.
    phases_before: (PhaseTimes, u64),
    /// Encoding and sending frames since the message before (ns).
    publishing: u64,
    energy: Energies,
    quality: ModelQuality,
    depths: Vec<f64>,
    counters_step: u64,
    applied: [f64; InputKind::COUNT],
    failures: u64,
    last_failure: Option<StepFailure>,
}

/// Messages of one output topic so far.
#[derive(Debug, Clone, Copy)]
pub struct OutputCount<'a> {
    /// Absolute name.
    pub topic: &'a str,
    /// Handed to the middleware.
    pub sent: u64,
    /// Refused because a reader stalls and the history is full.
    pub dropped: u64,
}

/// Where the status is collected from.
pub struct Sources<'a> {
    /// Of the solver's thread.
    pub gauges: &'a Gauges,
    /// The inputs: their publishers, their conditioned values, and lost samples.
    pub intake: &'a Intake,
    /// Present time as the conditioner counts it (s).
    pub now: f64,
    /// Time that the model is to keep up with (ns).
    pub pace_time: u64,
    /// Every output topic.
    pub outputs: &'a [OutputCount<'a>],
    /// The recording, if there is one.
    pub recording: Option<&'a RecordingThread>,
    /// DDS.
    pub dds: &'a Health,
    /// Other nodes with the name of this one.
    pub namesakes: &'a [Peer],
}

impl StatusKeeper {
    /// An empty status of a run that begins with a configuration.
    ///
    /// # Errors
    /// As [`StepTimes::new`].
    pub fn new(begun: Arc<Config>) -> Result<Self, hdrhistogram::CreationError> {
        Ok(Self {
            step_times: StepTimes::new()?,
            factor: RealTimeFactor::new(FACTOR_SPAN),
            pace: PaceWatch::default(),
            sequence: 0,
            time_step: begun.solver.time_step,
            config_hash: begun.hash(),
            changed: Vec::new(),
            unseen: begun.guide_that_rings(),
            begun,
            counters: SolverCounters::default(),
            counters_before: Default::default(),
            phases_before: Default::default(),
            publishing: 0,
            energy: Energies::default(),
            quality: ModelQuality::default(),
            depths: Vec::new(),
            counters_step: 0,
            applied: [f64::NAN; InputKind::COUNT],
            failures: 0,
            last_failure: None,
        })
    }

    /// Keeps what the configuration in force differs in from that of the start.
    pub fn reconfigure(&mut self, config: &Config) {
        let changed = config.changed_since(&self.begun);
        self.changed = changed.iter().map(ToString::to_string).collect();
        self.unseen = config.guide_that_rings();
    }

    /// Keeps what a snapshot says of the solver.
    pub fn observe(&mut self, snapshot: &Snapshot) {
        if snapshot.step < self.counters_step {
            // After a reset all counts start again.
            self.counters_before = Default::default();
            self.failures = 0;
        }
        self.counters = snapshot.solver;
        self.counters_step = snapshot.step;
        self.energy = snapshot.energy;
        self.quality = snapshot.quality;
        let applied = snapshot.applied.inputs();
        self.applied = InputKind::ALL.map(|kind| applied.get(kind));
        if self.depths.len() != snapshot.contacts.measured_depth.len() {
            self.depths.clone_from(&snapshot.contacts.measured_depth);
        }
    }

    /// Adds time that went into encoding and sending a frame (ns), on the publisher's thread.
    pub fn add_publishing(&mut self, time: u64) {
        self.publishing += time;
    }

    /// A step failed, after which there are no snapshots.
    pub fn fail(&mut self, failure: StepFailure) {
        self.failures += 1;
        self.last_failure = Some(failure);
    }

    /// Notes the progress of the model, for the real-time factor and the pace. While the model is stopped there is no
    /// pace to judge, and the time of the pause is forgotten.
    pub fn note(&mut self, pace_time: u64, gauges: &Gauges) {
        if gauges.run_state() == RunState::Running {
            let gained = self.model_time_gained(gauges);
            self.factor.note(pace_time, gained);
            self.pace.note(pace_time, gained);
        } else {
            self.factor.restart();
            self.pace.restart();
        }
    }

    /// How the model keeps up with the clock, judged over ten seconds.
    pub fn pace(&self) -> PaceReading {
        self.pace.reading()
    }

    fn model_time_gained(&self, gauges: &Gauges) -> f64 {
        gauges.steps_taken.load(Ordering::Relaxed) as f64 * self.time_step
    }

    /// The status now. Ends the interval of its statistics.
    pub fn status(&mut self, header: Header, sources: &Sources<'_>) -> TwinStatus {
        // Gauges of the solver are relaxed atomics: each is exact, but two of them may be of neighbouring steps.
        let gauges = sources.gauges;
        let step_count = gauges.step.load(Ordering::Relaxed);
        let times = self.step_times.take();
        let gained = self.model_time_gained(gauges);
        // Counters are sums since the start. The mean of this interval needs their values at its beginning.
        let (before, step_before) = std::mem::replace(&mut self.counters_before, (self.counters, self.counters_step));
        let steps = self.counters_step.saturating_sub(step_before);
        let iterations = self.counters.newton_iterations.saturating_sub(before.newton_iterations);
        let rejection = self.last_failure.or(self.counters.last_rejection);
        let station = rejection.map_or(0, |rejection| rejection.station);
        // Skipped steps are two things: late ones, the machine's fault, and those in which the twin stood still.
        let (pace, late) = (self.pace.reading(), gauges.steps_late.load(Ordering::Relaxed));
        self.sequence += 1;
        let mut status = TwinStatus {
            header,
            sequence: self.sequence,
            state: match gauges.run_state() {
                RunState::Starting => TwinStatus::STARTING,
                RunState::Running => TwinStatus::RUNNING,
                RunState::Paused => TwinStatus::PAUSED,
                RunState::Failed => TwinStatus::FAILED,
            },
            model_time: step_count as f64 * self.time_step,
            step_count,
            time_step: self.time_step,
            // NaN until two readings exist.
            real_time_factor: self.factor.factor(sources.pace_time, gained).unwrap_or(f64::NAN),
            lateness: gauges.lateness.load(Ordering::Relaxed) as f64 * 1e-9,
            deadline_misses: gauges.deadline_misses.load(Ordering::Relaxed),
            steps_skipped: late,
            steps_stood_still: gauges.steps_skipped.load(Ordering::Relaxed).saturating_sub(late),
            pace: pace.level as u8,
            pace_factor: pace.factor.unwrap_or(f64::NAN),
            step_time_p50: times.p50,
            step_time_p99: times.p99,
            step_time_max: times.max,
            newton_iterations_mean: if steps > 0 {
                iterations as f64 / steps as f64
            } else {
                0.0
            },
            rejected_steps: self.counters.rejected,
            halved_steps: self.counters.halved_steps,
            // Failures are also counted from the events, because a failed run has no newer snapshot with its counters.
            failed_steps: self.counters.failed_steps.max(self.failures),
            last_rejection_cause: rejection
                .map(|rejection| rejection.cause.name().to_owned())
                .unwrap_or_default(),
            last_rejection_station: u32::try_from(station).unwrap_or(u32::MAX),
            last_rejection_measured_depth: self.depths.get(station).copied().unwrap_or_default(),
            energy_error: self.energy.error,
            energy_error_ratio: ratio(self.energy.error, self.energy.drive),
            model_quality: self.quality.level as u8,
            model_quality_cause: quality_cause(&self.quality, self.unseen.as_deref()),
            energy_error_share: self.quality.energy_error_share,
            frames_dropped: gauges.frames_dropped.load(Ordering::Relaxed),
            events_lost: gauges.events_lost.load(Ordering::Relaxed),
            step_in_force: self.part_of_step(self.quality.choice.in_force),
            step_wanted: self.part_of_step(self.quality.choice.wanted),
            config_hash: self.config_hash.clone(),
            changed_parameter: self.changed.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            ..TwinStatus::default()
        };
        // Parts with arrays are filled in place, since they resize to what the twin has.
        self.fill_phases(&mut status, gauges);
        self.fill_inputs(&mut status, sources);
        fill_outputs(&mut status, sources);
        fill_surveys(&mut status, sources);
        fill_network(&mut status, sources);
        status
    }

    /// Length of the parts in which a refined step is taken (s).
    fn part_of_step(&self, refinement: u32) -> f64 {
        self.time_step / f64::from(1_u32 << refinement)
    }

    fn fill_phases(&mut self, status: &mut TwinStatus, gauges: &Gauges) {
        let now = (gauges.phase_times(), gauges.steps_taken.load(Ordering::Relaxed));
        let (before, steps_before) = std::mem::replace(&mut self.phases_before, now);
        let times = now.0.since(&before);
        let steps = now.1.saturating_sub(steps_before).max(1) as f64;
        let published = ("publish", std::mem::take(&mut self.publishing));
        let phases = StepPhase::ALL.map(|phase| (phase.name(), times.of(phase)));
        for (name, time) in phases.into_iter().chain([published]) {
            status.phase_name.push(name.to_owned());
            status.phase_time.push(time as f64 * 1e-9 / steps);
        }
    }

    fn fill_inputs(&self, status: &mut TwinStatus, sources: &Sources<'_>) {
        let intake = sources.intake;
        let conditioner = intake.conditioner();
        for kind in InputKind::ALL {
            if !conditioner.is_of_interest(kind) {
                continue;
            }
            status.input_name.push(kind.name().to_owned());
            status.input_state.push(conditioner.state(kind, sources.now) as u8);
            status
                .input_age
                .push(conditioner.age(kind, sources.now).unwrap_or(f64::NAN));
            status
                .input_received
                .push(conditioner.last_good(kind).map_or(f64::NAN, |value| kind.to_si(value)));
            status.input_applied.push(self.applied[kind.index()]);
            status.input_rejected.push(conditioner.counts(kind).rejected_total());
            let drivers = intake.drivers(kind, sources.now);
            status.input_driver.push(drivers.driving);
            status.input_publishers.push(drivers.heard.join(", "));
            status.input_several_drivers.push(drivers.several);
            status.input_not_driving.push(drivers.refused);
            status.input_unreadable.push(intake.unreadable(kind));
            status.input_overrun.push(intake.overrun(kind));
            status
                .input_safe
                .push(conditioner.is_brought_to_safe(kind, sources.now));
            let source = intake.source(kind);
            status.input_source.push(source.name.clone());
            status.input_suspect.push(source.suspect);
        }
    }
}

/// Why the motion cannot be trusted: what the quality has measured, and what it does not see.
fn quality_cause(measured: &ModelQuality, unseen: Option<&str>) -> String {
    let measured = measured.to_string();
    match unseen {
        None => measured,
        Some(unseen) if measured.is_empty() => unseen.to_owned(),
        Some(unseen) => format!("{measured}; {unseen}"),
    }
}

/// The same counts as those of the item `surveys` of the diagnostics.
fn fill_surveys(status: &mut TwinStatus, sources: &Sources<'_>) {
    let counts = sources.intake.surveys().counts();
    status.surveys_known = counts.known;
    status.surveys_waiting = counts.waiting;
    status.surveys_refused = counts.refused;
}

fn fill_network(status: &mut TwinStatus, sources: &Sources<'_>) {
    let dds = sources.dds;
    status.dds_up = dds.is_up;
    status.dds_restarts = dds.restarts;
    status.dds_restart_cause = dds.cause().unwrap_or_default().to_owned();
    status.dds_stalled_reader = dds.stalled_reader().unwrap_or_default().to_owned();
    status.namesake = sources.namesakes.iter().map(ToString::to_string).collect();
    status.clock_set_by = dds.clock_set_by;
}

fn fill_outputs(status: &mut TwinStatus, sources: &Sources<'_>) {
    for output in sources.outputs {
        status.output_topic.push(output.topic.to_owned());
        status.output_sent.push(output.sent);
        status.output_dropped.push(output.dropped);
    }
    if let Some(recording) = sources.recording {
        let health = recording.health();
        status.recording_state = if health.failed() {
            TwinStatus::RECORDING_FAILED
        } else {
            TwinStatus::RECORDING_ON
        };
        status.recording_path = health.path().display().to_string();
        status.recording_messages = health.messages();
        status.recording_drops = health.drops();
        status.recording_drops_cause = health.losses().to_string();
    }
}

fn ratio(error: f64, drive: f64) -> f64 {
    if drive == 0.0 { 0.0 } else { (error / drive).abs() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_core::twin::QualityCause;

    /// `check` warns of the guide of the rig's tool without damping at the wall; a run with it has a good quality.
    #[test]
    fn a_guide_that_rings_is_a_cause_of_doubt_that_a_good_quality_has() {
        let rig = include_str!("../../config/rig.yaml");
        let rig = Config::from_text("rig.yaml", rig).unwrap();
        let dry = rig.with_value("contact.outer.damping", 0.5).unwrap();
        let (calm, rings) = (rig.guide_that_rings(), dry.guide_that_rings());
        let good = ModelQuality {
            judged: true,
            ..ModelQuality::default()
        };
        assert_eq!(quality_cause(&good, calm.as_deref()), "");
        let said = quality_cause(&good, rings.as_deref());
        assert!(said.starts_with("contact.outer.damping 0.5 s/m"), "{said}");
        let poor = ModelQuality {
            cause: Some(QualityCause::EnergyError),
            ..good
        };
        let both = quality_cause(&poor, rings.as_deref());
        assert!(both.starts_with("energy errors") && both.ends_with(&said), "{both}");
    }
}
