//! Counts of steps: where a replay is in its recording, and how far it has come.

use super::player::Player;
use crate::cli::progress::Progress;
use crate::messages::{AppliedInputs, SessionInfo};

/// Origin of the replay's counts within the recording's.
pub(super) struct Base {
    /// Instant of the replay's step 0 (ns since 1970).
    pub start: i64,
    /// Steps taken before it, since the last reset.
    pub step: u64,
    /// Steps skipped before it.
    pub skipped: u64,
}

impl Base {
    /// Of the first applied inputs of a recording: a recording that began late begins with them.
    pub(super) fn of(session: &SessionInfo, first: Option<&AppliedInputs>) -> Self {
        match first {
            Some(first) if first.step > 0 || first.reset => Self {
                start: first.header.stamp.to_nanoseconds(),
                step: first.step,
                skipped: first.skipped_steps,
            },
            _ => Self {
                start: session.start.to_nanoseconds(),
                step: 0,
                skipped: 0,
            },
        }
    }

    /// The replay's number of a recorded step; `None` before its beginning.
    pub(super) fn step(&self, recorded: u64) -> Option<u64> {
        recorded.checked_sub(self.step)
    }
}

/// Progress of a replay.
pub(super) struct Pace {
    /// Steps taken, over all resets.
    pub taken: u64,
    /// Most of them.
    pub most: u64,
    /// Model time of a step (s).
    pub time_step: f64,
    /// Where it is shown.
    pub progress: Progress,
}

impl Pace {
    /// Advances a replay until it has taken so many steps since its last reset.
    ///
    /// # Errors
    /// When a step fails, or an output cannot be recorded.
    pub(super) fn advance(&mut self, player: &mut Player, until: u64) -> anyhow::Result<()> {
        while player.step() < until && self.taken < self.most && !player.is_stopped() {
            player.advance_or_fail()?;
            self.taken += 1;
            self.progress.at(self.taken as f64 * self.time_step);
        }
        Ok(())
    }
}

/// Steps since the last reset at the newest output, for recordings whose last status is older than that.
pub(super) fn step_of(newest: Option<i64>, session: &SessionInfo, applied: &[AppliedInputs]) -> u64 {
    let (Some(newest), Some(last)) = (newest, applied.last()) else {
        return 0;
    };
    let before = if last.reset { 0 } else { last.step };
    let since = (newest - last.header.stamp.to_nanoseconds()) as f64 * 1e-9 / session.time_step;
    // An output older than the last change of inputs gives no step after it.
    before + since.round().max(0.0) as u64
}
