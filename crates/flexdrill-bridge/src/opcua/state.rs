//! The newest messages of the twin, and what their age and the twin's health say about their values.

use std::collections::BTreeMap;

use ::opcua::types::StatusCode;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{AlarmList, Bands, Residuals, SafeWindow, TwinStatus};

use crate::TwinFigures;
use crate::figures::{FiguresError, read};

/// Without a new message for so long (ns) a value is the last usable one: three messages of the slowest topic.
const LATE: i64 = 3_000_000_000;
/// After this time (ns) the twin counts as lost.
const LOST: i64 = 15_000_000_000;

/// The newest messages of the twin.
#[derive(Debug, Default)]
pub struct TwinState {
    figures: TwinFigures,
    residuals: Option<Residuals>,
    window: Option<SafeWindow>,
    bands: Option<Bands>,
    /// When the newest message of each topic came (ns since 1970).
    arrived: BTreeMap<&'static str, i64>,
}

/// What a value stands for, which decides what makes it doubtful.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// Computed from the inputs: as good as these, and as the model.
    Computed,
    /// The same, from a topic that is sent on change only: its age is that of the twin's heartbeat.
    ComputedOnChange,
    /// The health of the twin itself, and what it states about its alarms.
    Stated,
    /// The same on change only.
    StatedOnChange,
}

impl TwinState {
    /// The topics that it is made from.
    pub fn topics() -> impl Iterator<Item = &'static TopicInfo> {
        TwinFigures::TOPICS
            .into_iter()
            .chain([&topics::RESIDUALS, &topics::SAFE_WINDOW, &topics::BANDS])
    }

    /// Takes the body (CDR without its header) of a message on one of [`Self::topics`] that came at `now` (ns since 1970).
    ///
    /// # Errors
    /// When the topic is another one or the bytes are no message of its type.
    pub fn take(&mut self, topic: &'static TopicInfo, body: &[u8], now: i64) -> Result<(), FiguresError> {
        if topic.name == topics::RESIDUALS.name {
            self.residuals = Some(read(topic, body)?);
        } else if topic.name == topics::SAFE_WINDOW.name {
            self.window = Some(read(topic, body)?);
        } else if topic.name == topics::BANDS.name {
            self.bands = Some(read(topic, body)?);
        } else {
            self.figures.take(topic.name, body)?;
        }
        self.arrived.insert(topic.name, now);
        Ok(())
    }

    /// The figures.
    pub fn figures(&self) -> &TwinFigures {
        &self.figures
    }

    /// The newest status.
    pub fn status(&self) -> Option<&TwinStatus> {
        self.figures.status()
    }

    /// The newest list of alarms.
    pub fn alarms(&self) -> Option<&AlarmList> {
        self.figures.alarms()
    }

    /// The newest residuals.
    pub fn residuals(&self) -> Option<&Residuals> {
        self.residuals.as_ref()
    }

    /// The map of speed and weight.
    pub fn window(&self) -> Option<&SafeWindow> {
        self.window.as_ref()
    }

    /// What plausible tools did in the newest second that is known of them.
    pub fn bands(&self) -> Option<&Bands> {
        self.bands.as_ref()
    }

    /// How far a value of a topic can be used at `now` (ns since 1970).
    pub fn quality(&self, topic: &'static TopicInfo, meaning: Meaning, now: i64) -> StatusCode {
        let Some(&arrived) = self.arrived.get(topic.name) else {
            return StatusCode::BadWaitingForInitialData;
        };
        let heartbeat = self.arrived.get(topics::STATUS.name).copied();
        let on_change = matches!(meaning, Meaning::ComputedOnChange | Meaning::StatedOnChange);
        let newest = if on_change {
            heartbeat.unwrap_or(arrived).max(arrived)
        } else {
            arrived
        };
        let stated = matches!(meaning, Meaning::Stated | Meaning::StatedOnChange);
        let alive = heartbeat.is_some_and(|at| now.saturating_sub(at) <= LATE);
        if let Some(status) = self.status().filter(|_| alive && !stated) {
            match status.state {
                TwinStatus::FAILED => return StatusCode::BadOutOfService,
                // Its topics are silent for this reason.
                TwinStatus::PAUSED => return StatusCode::UncertainLastUsableValue,
                TwinStatus::STARTING => return StatusCode::UncertainInitialValue,
                _ => {}
            }
        }
        match now.saturating_sub(newest) {
            LOST.. => return StatusCode::BadNoCommunication,
            LATE.. => return StatusCode::UncertainLastUsableValue,
            _ => {}
        }
        let Some(status) = self.status().filter(|_| !stated) else {
            return StatusCode::Good;
        };
        if inputs_are_doubtful(status) {
            StatusCode::UncertainSubNormal
        } else if status.model_quality == TwinStatus::QUALITY_POOR {
            StatusCode::UncertainSensorNotAccurate
        } else {
            StatusCode::Good
        }
    }
}

/// Whether an input that drives the model is not a fresh, good sample.
fn inputs_are_doubtful(status: &TwinStatus) -> bool {
    let by_state = status.input_state.iter().any(|&state| {
        matches!(
            state,
            TwinStatus::INPUT_NOT_RECEIVED | TwinStatus::INPUT_STALE | TwinStatus::INPUT_REJECTED
        )
    });
    by_state || status.input_suspect.contains(&true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::{BitState, to_cdr_body};

    const SECOND: i64 = 1_000_000_000;

    type Change = fn(&mut TwinStatus);

    fn status(change: impl FnOnce(&mut TwinStatus)) -> Vec<u8> {
        let mut status = TwinStatus {
            state: TwinStatus::RUNNING,
            input_state: vec![TwinStatus::INPUT_OK; 2],
            ..TwinStatus::default()
        };
        change(&mut status);
        to_cdr_body(&status).unwrap()
    }

    #[test]
    fn age_and_health_of_the_twin_decide_the_status() {
        let mut twin = TwinState::default();
        let bit = |twin: &TwinState, now| twin.quality(&topics::BIT_STATE, Meaning::Computed, now);
        assert_eq!(bit(&twin, 0), StatusCode::BadWaitingForInitialData);
        let body = to_cdr_body(&BitState::default()).unwrap();
        let at = |twin: &mut TwinState, now, change: fn(&mut TwinStatus)| {
            twin.take(&topics::BIT_STATE, &body, now).unwrap();
            twin.take(&topics::STATUS, &status(change), now).unwrap();
            bit(twin, now)
        };
        assert_eq!(at(&mut twin, 0, |_| {}), StatusCode::Good);
        let cases: [(Change, StatusCode); 6] = [
            (
                |status| status.input_state[1] = TwinStatus::INPUT_STALE,
                StatusCode::UncertainSubNormal,
            ),
            (
                |status| status.input_suspect = vec![true],
                StatusCode::UncertainSubNormal,
            ),
            (
                |status| status.model_quality = TwinStatus::QUALITY_POOR,
                StatusCode::UncertainSensorNotAccurate,
            ),
            (
                |status| status.state = TwinStatus::PAUSED,
                StatusCode::UncertainLastUsableValue,
            ),
            (|status| status.state = TwinStatus::FAILED, StatusCode::BadOutOfService),
            (
                |status| status.state = TwinStatus::STARTING,
                StatusCode::UncertainInitialValue,
            ),
        ];
        for (change, expected) in cases {
            assert_eq!(at(&mut twin, 0, change), expected);
            // The twin states its own health whatever that is.
            assert_eq!(twin.quality(&topics::STATUS, Meaning::Stated, 0), StatusCode::Good);
        }
        assert_eq!(at(&mut twin, 0, |_| {}), StatusCode::Good);
        assert_eq!(bit(&twin, 4 * SECOND), StatusCode::UncertainLastUsableValue);
        assert_eq!(bit(&twin, 15 * SECOND), StatusCode::BadNoCommunication);
        // What is sent on change only is as old as the heartbeat.
        twin.take(&topics::SAFE_WINDOW, &to_cdr_body(&SafeWindow::default()).unwrap(), 0)
            .unwrap();
        twin.take(&topics::STATUS, &status(|_| {}), 60 * SECOND).unwrap();
        let window = |now| twin.quality(&topics::SAFE_WINDOW, Meaning::StatedOnChange, now);
        assert_eq!(window(61 * SECOND), StatusCode::Good);
        assert_eq!(window(64 * SECOND), StatusCode::UncertainLastUsableValue);
        assert!(twin.take(&topics::STATUS, b"\0", 0).is_err());
    }
}
