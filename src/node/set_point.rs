//! What the driller has set, between the publisher's thread, which sees every frame, and the threads that look ahead.

use std::sync::{Mutex, PoisonError};

use crate::ahead::SetPoint;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{Frame, Output};

/// The set point of the run, for every thread.
#[derive(Debug)]
pub struct SharedSetPoint {
    time_step: f64,
    set_point: Mutex<SetPoint>,
}

impl SharedSetPoint {
    /// Before the first frame of a run of this configuration.
    pub fn new(config: &Config) -> Self {
        Self {
            time_step: config.solver.time_step,
            set_point: Mutex::new(SetPoint::new(&config.inputs)),
        }
    }

    /// Takes what acts in a frame, as often as alarms are observed.
    pub fn observe(&self, frame: &Frame) {
        if frame.due.has(Output::Alarms) {
            let mut set_point = self.set_point.lock().unwrap_or_else(PoisonError::into_inner);
            set_point.take(frame.ticks as f64 * self.time_step, &frame.snapshot.applied);
        }
    }

    /// What is set now; `None` before the first frame.
    pub fn inputs(&self) -> Option<Inputs> {
        self.set_point.lock().unwrap_or_else(PoisonError::into_inner).inputs()
    }

    /// Whether what acts now counts as what is set.
    pub fn is_settled(&self) -> bool {
        let set_point = self.set_point.lock().unwrap_or_else(PoisonError::into_inner);
        set_point.is_settled()
    }

    /// The last minute of it.
    pub fn now(&self) -> SetPoint {
        self.set_point.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
