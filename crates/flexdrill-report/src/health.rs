//! Health of the twin: pace, model and recording.

use std::collections::{BTreeMap, BTreeSet};

use crate::history::History;
use crate::shares::Shares;
use flexdrill_messages::TwinStatus;

/// Largest number of publishers of an input that are named.
const DRIVERS: usize = 8;

/// Summary of the status messages.
#[derive(Debug, Default)]
pub(crate) struct Health {
    pub messages: u64,
    pub real_time_factor: History,
    pub lateness: History,
    pub step_time_p99: History,
    pub step_time_max: f64,
    /// Shares of the model's quality.
    pub quality: Shares,
    /// The newest cause of a quality that is not good.
    pub quality_cause: String,
    /// Shares of each input's states.
    pub inputs: BTreeMap<String, Shares>,
    /// Publishers that drove each input.
    pub drivers: BTreeMap<String, BTreeSet<String>>,
    /// Shares of the twin's states.
    pub states: Shares,
    /// Longest time between two heartbeats (s), and its begin (s from the beginning).
    pub longest_silence: (f64, f64),
    pub newest: Option<TwinStatus>,
    last_time: Option<f64>,
}

impl Health {
    pub(crate) fn status(&mut self, time: f64, status: TwinStatus) {
        self.messages += 1;
        self.real_time_factor.push(time, status.real_time_factor);
        self.lateness.push(time, status.lateness);
        self.step_time_p99.push(time, status.step_time_p99);
        self.step_time_max = self.step_time_max.max(status.step_time_max);
        self.quality.push(time, status.model_quality);
        if status.model_quality != TwinStatus::QUALITY_GOOD {
            self.quality_cause.clone_from(&status.model_quality_cause);
        }
        for (name, state) in status.input_name.iter().zip(&status.input_state) {
            self.inputs.entry(name.clone()).or_default().push(time, *state);
        }
        for (name, driver) in status.input_name.iter().zip(&status.input_driver) {
            let drivers = self.drivers.entry(name.clone()).or_default();
            if !driver.is_empty() && drivers.len() < DRIVERS {
                drivers.insert(driver.clone());
            }
        }
        self.states.push(time, status.state);
        if let Some(last) = self.last_time.filter(|last| time - last > self.longest_silence.0) {
            self.longest_silence = (time - last, last);
        }
        self.last_time = Some(time);
        self.newest = Some(status);
    }
}
