//! What the joints have lived: the damage that the recording counted, and that of a table of all runs.

use flexdrill_config::Config;
use flexdrill_life::{Counted, JointOfFile, Kind, LifeError, Lives, ranked};
use flexdrill_messages::Ageing;

/// Everything that the report says of the joints' lives.
#[derive(Debug, Default)]
pub(crate) struct JointLives {
    counted: Counted,
    /// The table of all runs, if one was given.
    pub lives: Option<Lives>,
}

impl JointLives {
    /// Takes a count of a run that began at `start` (ns), if that is known.
    pub(crate) fn push(&mut self, message: &Ageing, start: Option<i64>) {
        // A message whose numbers are none is left out: the next one has the whole sum again.
        let _ = self.counted.push(message, start.unwrap_or(i64::MIN));
    }

    /// The kind of the joints of a configuration that states a class, and the joints of the recording, the most damaged
    /// first.
    pub(crate) fn of_recording(&self, config: &Config) -> Option<(Kind, Result<Vec<JointOfFile>, LifeError>)> {
        let kind = Kind::of(config).ok()?;
        let joints = ranked(&kind, &self.counted, &config.tool.joint.serial_numbers);
        Some((kind, joints))
    }
}
