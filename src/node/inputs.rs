//! The rig's inputs in the node: one owner of their state, which the receiving tasks and the publisher share.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::clocks::Clocks;
use crate::rig_inputs::{
    Carried, Driver, DriverId, Intake, KeptSurveys, Measured, Restored, RigSample, SafeValueEvent, SampleRefused,
    SampleSource, Taken, stamped,
};
use flexdrill_config::{Config, InputsConfig};
use flexdrill_core::inputs::{InputKind, Stamp};
use flexdrill_hole::Survey;
use flexdrill_messages::{RigInputs as RigInputsMessage, RigMeasured, RigSurvey};
use flexdrill_realtime::link::Targets;
use flexdrill_text::log_ending;

/// Characters of a message's source that are kept, since every status carries them.
const LONGEST_SOURCE: usize = 64;

/// Conditions the samples of the rig into the targets of the solver. Its lock is held for moments only, and the solver
/// never takes it.
#[derive(Clone)]
pub struct RigInputs {
    intake: Arc<Mutex<Intake>>,
    targets: Arc<Targets>,
    clocks: Clocks,
    max_skew: f64,
}

impl RigInputs {
    /// Inputs that follow the rules of a configuration.
    pub fn new(config: &Config, targets: Arc<Targets>, clocks: Clocks) -> Self {
        Self {
            intake: Arc::new(Mutex::new(Intake::of(config))),
            targets,
            clocks,
            max_skew: config.inputs.stamp.max_skew,
        }
    }

    /// Logs what the model assumes of the optional inputs that concern the run.
    pub fn log_assumed(&self) {
        let intake = self.locked();
        let conditioner = intake.conditioner();
        let optional = InputKind::ALL.into_iter().filter(|kind| kind.is_optional());
        for kind in optional.filter(|kind| conditioner.is_of_interest(*kind)) {
            tracing::info!(
                "{kind}: the model assumes {} {} until a sample arrives on {}",
                conditioner.rule(kind).initial,
                kind.unit(),
                kind.topic()
            );
        }
    }

    /// A copy of the state of the inputs.
    pub fn snapshot(&self) -> Intake {
        self.locked().clone()
    }

    /// What a look at the measured values gives. The lock is held meanwhile.
    pub fn with_measured<T>(&self, look: impl FnOnce(&Measured) -> T) -> T {
        look(self.locked().measured())
    }

    /// Adopts changed limits, ages and safe values.
    pub fn set_rules(&self, inputs: &InputsConfig) {
        self.locked().set_rules(inputs, self.clocks.age_time());
    }

    /// Adds what is known of a publisher.
    pub fn describe(&self, driver: Driver) {
        self.locked().describe(driver);
    }

    /// Whether node and host of a publisher are known.
    pub fn is_described(&self, id: DriverId) -> bool {
        self.locked().is_described(id)
    }

    /// Counts samples whose bytes are no message of their type.
    pub fn count_unreadable(&self, carried: Carried) {
        self.locked().count_unreadable(carried);
    }

    /// Counts samples that were dropped unread.
    pub fn count_overrun(&self, carried: Carried, samples: u64) {
        self.locked().count_overrun(carried, samples);
    }

    /// Sets the solver's targets to the inputs of the present time.
    pub fn update_targets(&self) {
        let now = self.clocks.age_time();
        let (inputs, quality) = {
            let intake = self.locked();
            (intake.conditioner().targets(now), intake.conditioner().quality(now))
        };
        self.targets.set(inputs, quality as u8);
    }

    /// Restarts the ages of the inputs, after the clock was set.
    pub fn clock_set(&self) {
        self.locked().clock_set(self.clocks.age_time());
    }

    /// Accepts a plain number of a publisher, or returns the refusal.
    pub fn accept_plain(&self, kind: InputKind, value: f64, id: DriverId) -> Vec<SampleRefused> {
        self.accept([(kind, value, None)], id)
    }

    /// Accepts a message with a stamp, and returns the refusals of its values.
    pub fn accept_stamped(&self, message: &RigInputsMessage, id: DriverId) -> Vec<SampleRefused> {
        let source = SampleSource {
            name: message.source.chars().take(LONGEST_SOURCE).collect(),
            suspect: stamped::is_suspect(message),
        };
        let values = stamped::values(message, self.clocks.stamp_time(), self.max_skew);
        let samples = InputKind::ALL.into_iter().zip(values);
        self.accept(
            samples
                .filter_map(|(kind, value)| value.map(|(value, stamp)| (kind, value, Some((stamp, source.clone()))))),
            id,
        )
    }

    /// Accepts a message of `rig/measured`, or returns the refusal.
    pub fn accept_measured(&self, message: &RigMeasured) -> Option<SampleRefused> {
        let time = self.clocks.age_time();
        let stamp = self.clocks.stamp_time();
        let accepted = self.locked().accept_measured(message, stamp, time, self.max_skew);
        accepted.err()
    }

    /// Accepts a survey.
    ///
    /// # Errors
    /// Why it is refused.
    pub fn accept_survey(&self, message: &RigSurvey) -> Result<Taken, SampleRefused> {
        let stamp = self.clocks.stamp_time();
        self.locked().accept_survey(message, stamp, self.max_skew)
    }

    /// Takes the surveys of an earlier run; none where they are of another hole.
    pub fn restore_surveys(&self, kept: &KeptSurveys) -> Option<Restored> {
        self.locked().restore_surveys(kept)
    }

    /// The surveys for the next run.
    pub fn kept_surveys(&self) -> KeptSurveys {
        self.locked().surveys().kept()
    }

    /// The surveys that are known, in the order of arrival.
    pub fn surveys(&self) -> Arc<[Survey]> {
        self.locked().surveys().known()
    }

    fn accept(
        &self,
        samples: impl IntoIterator<Item = (InputKind, f64, Option<(Stamp, SampleSource)>)>,
        id: DriverId,
    ) -> Vec<SampleRefused> {
        let time = self.clocks.age_time();
        let refused = {
            let mut intake = self.locked();
            let samples = samples.into_iter().map(|(kind, value, stamp)| RigSample {
                kind,
                value,
                id,
                time,
                stamp,
            });
            samples.filter_map(|sample| intake.accept(&sample).err()).collect()
        };
        self.update_targets();
        refused
    }

    /// Logs the begin and the end of each input's ramp to its safe value.
    pub fn log_safe_values(&self) {
        let now = self.clocks.age_time();
        for kind in InputKind::ALL {
            let event = self.locked().safe_value_event(kind, now);
            match event {
                Some(SafeValueEvent::RampBegan(text)) => {
                    if let Some(more) = log_ending(format!("{kind} ramps")) {
                        tracing::warn!("{text}{more}");
                    }
                }
                Some(SafeValueEvent::Recovered(text)) => {
                    if let Some(more) = log_ending(format!("{kind} is back")) {
                        tracing::info!("{text}{more}");
                    }
                }
                None => {}
            }
        }
    }

    fn locked(&self) -> MutexGuard<'_, Intake> {
        self.intake.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
