//! The door: every sample of the rig is judged by its sender, then by its value.

use std::fmt;

use super::announcer::{Announcement, Announcer};
use super::driver::DriverId;
use super::drivers::{Drivers, NotDriving, Rule};
use flexdrill_config::InputsConfig;
use flexdrill_core::inputs::{Conditioner, InputKind, InputRoute, Rejection, Stamp};

/// Where a sample of `rig/inputs` comes from, as it says itself.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Sent {
    /// Sensor or program; empty if it does not say.
    pub source: String,
    /// The source has doubts about it.
    pub suspect: bool,
}

/// A sample as it arrives.
#[derive(Debug, Clone, PartialEq)]
pub struct RigSample {
    /// Of which input.
    pub kind: InputKind,
    /// r/min or kN.
    pub value: f64,
    /// Who sent it.
    pub id: DriverId,
    /// When it arrived (s, the conditioner's clock).
    pub time: f64,
    /// What it says of itself; none of a number alone.
    pub stamp: Option<(Stamp, Sent)>,
}

/// Why a sample was refused.
#[derive(Debug, Clone, PartialEq)]
pub enum SampleRefused {
    /// Its sender does not drive.
    Driver(Box<NotDriving>),
    /// It cannot be right.
    Value(Rejection),
}

impl fmt::Display for SampleRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Driver(refused) => refused.fmt(f),
            Self::Value(rejection) => rejection.fmt(f),
        }
    }
}

/// What is kept of the samples beside their values.
#[derive(Debug, Clone)]
pub struct Intake {
    /// Who sends.
    pub drivers: Drivers,
    announcer: Announcer,
    unreadable: [u64; 2],
    overrun: [u64; 2],
    /// Of the newest good sample.
    sent: [Sent; 2],
}

impl Intake {
    /// Nothing has come yet.
    pub fn new(inputs: &InputsConfig) -> Self {
        Self {
            drivers: Drivers::new(Rule::of(inputs)),
            announcer: Announcer::default(),
            unreadable: [0; 2],
            overrun: [0; 2],
            sent: Default::default(),
        }
    }

    /// Takes over a changed configuration.
    pub fn set_rules(&mut self, inputs: &InputsConfig) {
        self.drivers.set_rule(Rule::of(inputs));
    }

    /// Hands a sample to the conditioner.
    ///
    /// # Errors
    /// When its sender or its value is refused.
    pub fn take(&mut self, conditioner: &mut Conditioner, sample: &RigSample) -> Result<(), SampleRefused> {
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
        self.drivers
            .offer(kind, route, id, time, value)
            .map_err(SampleRefused::Driver)?;
        let taken = match stamp {
            None => conditioner.offer(kind, value, time),
            Some((stamp, _)) => conditioner.offer_stamped(kind, value, time, stamp),
        };
        taken.map_err(SampleRefused::Value)?;
        self.sent[kind.index()] = stamp.as_ref().map(|(_, sent)| sent.clone()).unwrap_or_default();
        Ok(())
    }

    /// Counts a sample whose bytes are no message of its type.
    pub fn count_unreadable(&mut self, kinds: &[InputKind]) {
        for kind in kinds {
            self.unreadable[kind.index()] += 1;
        }
    }

    /// Samples that could not be read so far.
    pub fn unreadable(&self, kind: InputKind) -> u64 {
        self.unreadable[kind.index()]
    }

    /// Counts samples that came faster than they were taken, and that nobody has seen.
    pub fn count_overrun(&mut self, kinds: &[InputKind], samples: u64) {
        for kind in kinds {
            self.overrun[kind.index()] += samples;
        }
    }

    /// Samples that came faster than they were taken so far.
    pub fn overrun(&self, kind: InputKind) -> u64 {
        self.overrun[kind.index()]
    }

    /// What the newest good sample said of itself.
    pub fn sent(&self, kind: InputKind) -> &Sent {
        &self.sent[kind.index()]
    }

    /// What is to be told of an input by `now` (s, the conditioner's clock).
    pub fn announce(&mut self, kind: InputKind, conditioner: &Conditioner, now: f64) -> Option<Announcement> {
        self.announcer.look(kind, conditioner, now)
    }

    /// To be called when the clock was set anew, with the conditioner's own call.
    pub fn clock_set(&mut self, now: f64) {
        self.drivers.clock_set(now);
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
        let mut conditioner = Conditioner::new(inputs.rules());
        let mut intake = Intake::new(&inputs);
        intake.take(&mut conditioner, &sample(1, 40.0, 1.0)).unwrap();
        let refused = intake.take(&mut conditioner, &sample(2, 90.0, 1.5)).unwrap_err();
        assert!(matches!(refused, SampleRefused::Driver(_)));
        assert_eq!(conditioner.target(RotarySpeed, 1.5), 40.0);
        assert_eq!(conditioner.counts(RotarySpeed).accepted, 1);
        assert_eq!(intake.drivers.summary(RotarySpeed, 1.5).refused, 1);
        let refused = intake.take(&mut conditioner, &sample(1, 500.0, 2.0)).unwrap_err();
        assert!(refused.to_string().contains("above the maximum of 120 r/min"));
    }

    #[test]
    fn source_and_doubt_are_those_of_the_newest_good_sample() {
        let inputs = InputsConfig::default();
        let mut conditioner = Conditioner::new(inputs.rules());
        let mut intake = Intake::new(&inputs);
        let stamp = Stamp {
            age: 0.1,
            bad: false,
            max_skew: 0.5,
        };
        let sent = Sent {
            source: "encoder".into(),
            suspect: true,
        };
        let mut stamped = sample(1, 40.0, 1.0);
        stamped.stamp = Some((stamp, sent.clone()));
        intake.take(&mut conditioner, &stamped).unwrap();
        assert_eq!(intake.sent(RotarySpeed), &sent);
        stamped.stamp = Some((Stamp { bad: true, ..stamp }, Sent::default()));
        stamped.time = 1.1;
        assert!(intake.take(&mut conditioner, &stamped).is_err());
        assert_eq!(intake.sent(RotarySpeed), &sent);
        intake.take(&mut conditioner, &sample(1, 41.0, 1.2)).unwrap();
        assert_eq!(intake.sent(RotarySpeed), &Sent::default());
    }
}
