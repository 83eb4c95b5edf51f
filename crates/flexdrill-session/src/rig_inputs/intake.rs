//! Input validation: every sample of the rig is judged by its publisher, then by its value.

use std::fmt;

use super::driver::{Driver, DriverId};
use super::drivers::{DriverSummary, Drivers, NotDriving, Rule};
use super::measured::{Measured, MeasuredRefused};
use super::safe_value_watch::{SafeValueEvent, SafeValueWatch};
use super::surveys::{KeptSurveys, Restored, SurveyRefused, Surveys, Taken};
use super::time_zone::TimeZone;
use flexdrill_config::{Config, InputsConfig};
use flexdrill_core::inputs::{Conditioner, InputKind, InputRoute, Rejection, RejectionReason, Stamp};
use flexdrill_messages::{RigMeasured, RigSurvey};

/// What a message on `rig/inputs` states about its source.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SampleSource {
    /// Sensor or program; empty where the message names none.
    pub name: String,
    /// The source doubts the values.
    pub suspect: bool,
}

/// A sample as it arrives.
#[derive(Debug, Clone, PartialEq)]
pub struct RigSample {
    /// Of which input.
    pub kind: InputKind,
    /// In the unit of the input's topic.
    pub value: f64,
    /// Its publisher.
    pub id: DriverId,
    /// When it arrived (s, the conditioner's clock).
    pub time: f64,
    /// Stamp and source; none for a plain number.
    pub stamp: Option<(Stamp, SampleSource)>,
}

/// Why a sample was refused.
#[derive(Debug, Clone, PartialEq)]
pub enum SampleRefused {
    /// Its publisher does not drive the input.
    Driver(Box<NotDriving>),
    /// Its value or its stamp is refused.
    Value(Rejection),
    /// A message of `rig/measured` is refused.
    Measured(MeasuredRefused),
    /// A survey is refused.
    Survey(SurveyRefused),
}

/// What a topic carries.
#[derive(Debug, Clone, Copy)]
pub enum Carried {
    /// These inputs.
    Inputs(&'static [InputKind]),
    /// What the rig measures besides.
    Measured,
    /// Surveys.
    Surveys,
}

impl fmt::Display for SampleRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Driver(refused) => refused.fmt(f),
            Self::Value(rejection) => {
                rejection.fmt(f)?;
                match rejection.reason {
                    RejectionReason::FromFuture { by, .. } => match TimeZone::ahead(by) {
                        Some(zone) => write!(f, "; {zone}"),
                        None => Ok(()),
                    },
                    _ => Ok(()),
                }
            }
            Self::Measured(refused) => refused.fmt(f),
            Self::Survey(refused) => refused.fmt(f),
        }
    }
}

/// The state of the inputs: their publishers, their conditioned values, and the counts of samples that were lost.
#[derive(Debug, Clone)]
pub struct Intake {
    drivers: Drivers,
    conditioner: Conditioner,
    /// The inputs that the tool's mechanics depend on.
    used: [bool; InputKind::COUNT],
    safe_values: SafeValueWatch,
    unreadable: [u64; InputKind::COUNT],
    overrun: [u64; InputKind::COUNT],
    /// Of the newest good sample.
    sources: [SampleSource; InputKind::COUNT],
    measured: Measured,
    surveys: Surveys,
}

/// The largest weight that the configuration can allow (N): its hard limit, or the configured maximum beyond it.
fn heaviest(inputs: &InputsConfig) -> f64 {
    InputKind::WeightOnBit.to_si(inputs.hard_limits.max_kn.max(inputs.weight_on_bit.max_kn))
}

impl Intake {
    /// An intake of a run that has received nothing.
    pub fn of(config: &Config) -> Self {
        Self {
            surveys: Surveys::new(config),
            ..Self::new(&config.inputs, config.used_inputs())
        }
    }

    /// One without a hole to survey; `used` as in [`InputsConfig::rules_of`].
    pub fn new(inputs: &InputsConfig, used: [bool; InputKind::COUNT]) -> Self {
        Self {
            drivers: Drivers::new(Rule::of(inputs)),
            conditioner: Conditioner::new(inputs.rules_of(used)),
            used,
            safe_values: SafeValueWatch::default(),
            unreadable: [0; InputKind::COUNT],
            overrun: [0; InputKind::COUNT],
            sources: Default::default(),
            measured: Measured::new(heaviest(inputs)),
            surveys: Surveys::default(),
        }
    }

    /// The conditioned values.
    pub fn conditioner(&self) -> &Conditioner {
        &self.conditioner
    }

    /// The publishers of an input at `now` (s, the conditioner's clock).
    pub fn drivers(&self, kind: InputKind, now: f64) -> DriverSummary {
        self.drivers.summary(kind, now)
    }

    /// Adopts the rules of a changed configuration from `now` on (s, the conditioner's clock).
    pub fn set_rules(&mut self, inputs: &InputsConfig, now: f64) {
        self.drivers.set_rule(Rule::of(inputs));
        self.conditioner.set_rules(inputs.rules_of(self.used), now);
    }

    /// Adds what discovery knows of a publisher.
    pub fn describe(&mut self, driver: Driver) {
        self.drivers.describe(driver);
    }

    /// Whether node and host of a publisher are known.
    pub fn is_described(&self, id: DriverId) -> bool {
        self.drivers.is_described(id)
    }

    /// Accepts a sample: it becomes the input's newest value.
    ///
    /// # Errors
    /// When its publisher or its value is refused.
    pub fn accept(&mut self, sample: &RigSample) -> Result<(), SampleRefused> {
        let RigSample {
            kind,
            value,
            id,
            time,
            ref stamp,
        } = *sample;
        let route = if stamp.is_some() {
            InputRoute::Stamped
        } else {
            InputRoute::Plain
        };
        let source = stamp.as_ref().map_or("", |(_, source)| source.name.as_str());
        self.drivers
            .offer(kind, route, id, source, time, value)
            .map_err(SampleRefused::Driver)?;
        let judged = match stamp {
            None => self.conditioner.offer(kind, value, time),
            Some((stamp, _)) => self.conditioner.offer_stamped(kind, value, time, stamp),
        };
        judged.map_err(SampleRefused::Value)?;
        self.sources[kind.index()] = stamp.as_ref().map(|(_, source)| source.clone()).unwrap_or_default();
        Ok(())
    }

    /// Accepts a message of `rig/measured` that arrived at `time` (s, the conditioner's clock). `now` is the present
    /// instant of the stamps (ns), `max_skew` how far ahead of it a stamp may be (s).
    ///
    /// # Errors
    /// When its stamp or one of its values is refused.
    pub fn accept_measured(
        &mut self,
        message: &RigMeasured,
        now: i64,
        time: f64,
        max_skew: f64,
    ) -> Result<(), SampleRefused> {
        let accepted = self.measured.accept(message, now, time, max_skew);
        accepted.map_err(SampleRefused::Measured)
    }

    /// What the rig measures besides the inputs.
    pub fn measured(&self) -> &Measured {
        &self.measured
    }

    /// Accepts a survey. `now` is the present instant of the stamps (ns), `max_skew` how far ahead of it a stamp may be (s).
    ///
    /// # Errors
    /// When it is refused.
    pub fn accept_survey(&mut self, message: &RigSurvey, now: i64, max_skew: f64) -> Result<Taken, SampleRefused> {
        let accepted = self.surveys.accept(message, now, max_skew);
        accepted.map_err(SampleRefused::Survey)
    }

    /// Takes the surveys of an earlier run; none where they are of another hole.
    pub fn restore_surveys(&mut self, kept: &KeptSurveys) -> Option<Restored> {
        self.surveys.restore(kept)
    }

    /// The surveys of the hole.
    pub fn surveys(&self) -> &Surveys {
        &self.surveys
    }

    /// Counts a sample whose bytes are no message of its type.
    pub fn count_unreadable(&mut self, carried: Carried) {
        match carried {
            Carried::Inputs(kinds) => {
                for kind in kinds {
                    self.unreadable[kind.index()] += 1;
                }
            }
            Carried::Measured => self.measured.count_unreadable(),
            Carried::Surveys => self.surveys.count_unreadable(),
        }
    }

    /// Samples that could not be read so far.
    pub fn unreadable(&self, kind: InputKind) -> u64 {
        self.unreadable[kind.index()]
    }

    /// Counts samples that were dropped unread because they came faster than the node reads them.
    pub fn count_overrun(&mut self, carried: Carried, samples: u64) {
        match carried {
            Carried::Inputs(kinds) => {
                for kind in kinds {
                    self.overrun[kind.index()] += samples;
                }
            }
            Carried::Measured => self.measured.count_overrun(samples),
            Carried::Surveys => self.surveys.count_overrun(samples),
        }
    }

    /// Samples dropped unread so far.
    pub fn overrun(&self, kind: InputKind) -> u64 {
        self.overrun[kind.index()]
    }

    /// The source of the newest good sample.
    pub fn source(&self, kind: InputKind) -> &SampleSource {
        &self.sources[kind.index()]
    }

    /// The begin or end of an input's ramp to its safe value since the last call, at `now` (s, the conditioner's clock).
    pub fn safe_value_event(&mut self, kind: InputKind, now: f64) -> Option<SafeValueEvent> {
        self.safe_values.update(kind, &self.conditioner, now)
    }

    /// Restarts all ages and silences at `now` (s), after the conditioner's clock was set.
    pub fn clock_set(&mut self, now: f64) {
        self.drivers.clock_set(now);
        self.conditioner.clock_set(now);
        self.measured.clock_set();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use InputKind::RotarySpeed;

    fn sample(id: u8, value: f64, time: f64) -> RigSample {
        RigSample {
            kind: RotarySpeed,
            value,
            id: DriverId([id; 16]),
            time,
            stamp: None,
        }
    }

    #[test]
    fn a_sample_of_another_than_the_driver_does_not_reach_the_conditioner() {
        let mut inputs = InputsConfig::default();
        inputs.driver.policy = flexdrill_config::DriverPolicy::First;
        let mut intake = Intake::new(&inputs, [true; InputKind::COUNT]);
        intake.accept(&sample(1, 40.0, 1.0)).unwrap();
        let refused = intake.accept(&sample(2, 90.0, 1.5)).unwrap_err();
        assert!(matches!(refused, SampleRefused::Driver(_)));
        assert_eq!(intake.conditioner().target(RotarySpeed, 1.5), 40.0);
        assert_eq!(intake.conditioner().counts(RotarySpeed).accepted, 1);
        assert_eq!(intake.drivers(RotarySpeed, 1.5).refused, 1);
        let refused = intake.accept(&sample(1, 500.0, 2.0)).unwrap_err();
        assert!(refused.to_string().contains("above the maximum of 120 r/min"));
    }

    #[test]
    fn a_rig_clock_of_another_time_zone_is_named() {
        let mut intake = Intake::new(&InputsConfig::default(), [true; InputKind::COUNT]);
        let mut words = |age| {
            let mut stamped = sample(1, 40.0, 1.0);
            let stamp = Stamp {
                age,
                bad: false,
                max_skew: 0.5,
            };
            stamped.stamp = Some((stamp, SampleSource::default()));
            intake.accept(&stamped).unwrap_err().to_string()
        };
        let zone = words(-19_799.0);
        assert!(
            zone.contains("19799.000 s ahead") && zone.contains("; 5.5 h is a time zone: add it to `utc_offset_h`"),
            "{zone}"
        );
        assert!(!words(-30.0).contains("time zone"));
    }

    #[test]
    fn source_and_doubt_are_those_of_the_newest_good_sample() {
        let inputs = InputsConfig::default();
        let mut intake = Intake::new(&inputs, [true; InputKind::COUNT]);
        let stamp = Stamp {
            age: 0.1,
            bad: false,
            max_skew: 0.5,
        };
        let source = SampleSource {
            name: "encoder".into(),
            suspect: true,
        };
        let mut stamped = sample(1, 40.0, 1.0);
        stamped.stamp = Some((stamp, source.clone()));
        intake.accept(&stamped).unwrap();
        assert_eq!(intake.source(RotarySpeed), &source);
        stamped.stamp = Some((Stamp { bad: true, ..stamp }, SampleSource::default()));
        stamped.time = 1.1;
        assert!(intake.accept(&stamped).is_err());
        assert_eq!(intake.source(RotarySpeed), &source);
        intake.accept(&sample(1, 41.0, 1.2)).unwrap();
        assert_eq!(intake.source(RotarySpeed), &SampleSource::default());
    }
}
