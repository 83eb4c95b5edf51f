//! The alarms of a run. The twin is a host of a session, as node and replay are: the session judges, and the twin gives the
//! events to its caller, next to the columns.

use std::sync::{Arc, Mutex, PoisonError};

use flexdrill_config::Config;
use flexdrill_core::twin::{Frame, Output, Run, Schedule, Timeline};
use flexdrill_messages::AlarmEvent;
use flexdrill_session::Session;
use flexdrill_session::alarms::AlarmBook;

/// Judges the alarms of one run. Their clock is model time, which begins at 0 with the run.
pub(crate) struct Judge {
    /// Python shares a twin between threads, and the ends of channels in a session are for one thread at a time.
    session: Mutex<Session>,
    /// Used again by each look.
    frame: Frame,
}

impl Judge {
    /// All alarms normal at the present instant of a run.
    pub fn new(config: &Arc<Config>, run: &Run) -> Self {
        let book = AlarmBook::fresh(Arc::clone(config), stamp(config, run));
        Self {
            session: Mutex::new(Session::new(Arc::clone(config), book)),
            frame: run.new_frame(),
        }
    }

    /// Another one in the same state, for a fork of the run.
    pub fn fork(&self) -> Self {
        let session = self.session.lock().unwrap_or_else(PoisonError::into_inner);
        let config = Arc::clone(session.config());
        Self {
            session: Mutex::new(Session::new(config, session.alarms().clone())),
            frame: self.frame.clone(),
        }
    }

    /// Judges the alarms where that is due, as often as in a node, and returns their new events.
    pub fn look(&mut self, run: &mut Run) -> Vec<AlarmEvent> {
        if !run.due().has(Output::Alarms) {
            return Vec::new();
        }
        // The schedule has no other output, so that the intervals of peaks and means remain those of the columns.
        run.capture(&mut self.frame);
        let session = self.session.get_mut().unwrap_or_else(PoisonError::into_inner);
        let stamp = stamp(session.config(), run);
        session.judge(&self.frame.snapshot, stamp)
    }
}

/// The outputs of a run: the alarms, as often as a node judges them. Columns are sampled by hand.
pub(crate) fn schedule(config: &Config) -> Schedule {
    let (of_node, time_step) = (flexdrill_outputs::published(config), config.solver.time_step);
    Schedule::new(time_step, |output| match output {
        Output::Alarms => of_node.rate(output, time_step),
        _ => 0.0,
    })
}

/// The present model time of a run (ns).
fn stamp(config: &Config, run: &Run) -> i64 {
    let timeline = Timeline {
        start: 0,
        time_step: config.solver.time_step,
    };
    timeline.at(run.simulation().step())
}
