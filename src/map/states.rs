//! States that points start from, made once for all points that share them: the cells of a map at one weight start from the
//! same running tool, whatever their speed.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::ahead::NoTool;
use flexdrill_config::Config;
use flexdrill_core::twin::{Run, RunInputs};
use flexdrill_sweep::map::{ROTARY_SPEED, WEIGHT_ON_BIT};
use flexdrill_sweep::plan::Running;

/// Most states that are kept: ten weights of ten tools have 110. The run of a tool takes some megabytes.
const MOST_KEPT: usize = 128;

/// What a state follows from.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Key {
    /// Hash of the configuration, but for what acts from the start on alone.
    configuration: String,
    /// Speed (r/min) and time (s) of the start, to the bit; none at rest.
    running: Option<[u64; 2]>,
    /// Seed and number of a plausible tool.
    tool: Option<(u64, u32)>,
}

impl Key {
    /// Of a point's configuration, in a sweep of `base`. The speed of the point acts after its start alone; the weight too, where
    /// the start is at rest.
    pub fn of(config: &Config, base: &Config, running: Option<&Running>, tool: Option<(u64, u32)>) -> Self {
        let shared =
            |key: &str, value: f64, of: Result<Config, ()>| of.and_then(|of| of.with_value(key, value).map_err(|_| ()));
        let speed = base.inputs.rotary_speed.initial_rpm;
        let mut of = shared(ROTARY_SPEED, speed, Ok(config.clone()));
        if running.is_none() {
            of = shared(WEIGHT_ON_BIT, base.inputs.weight_on_bit.initial_kn, of);
        }
        Self {
            // Where the values exclude each other, the point has a state that no other shares.
            configuration: of.map_or_else(|()| config.hash(), |of| of.hash()),
            running: running.map(|running| [running.rpm.to_bits(), running.time.to_bits()]),
            tool,
        }
    }
}

/// A run with what acts on it.
pub type State = (Run, RunInputs);
/// A state that one thread makes while others wait for it, or why there is none.
type Slot = Arc<Mutex<Option<Result<State, String>>>>;

/// The states that were made, the oldest first.
#[derive(Default)]
pub struct States(Mutex<(HashMap<Key, Slot>, Vec<Key>)>);

impl States {
    /// A fork of the state of a key, made by `make` where it is not there.
    ///
    /// # Errors
    /// What `make` says, once for all who ask; a stop is not kept.
    pub fn fork(&self, key: Key, make: impl FnOnce() -> Result<State, NoTool>) -> Result<State, NoTool> {
        let slot = self.slot(key);
        let mut state = slot.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = match &mut *state {
            Some(kept) => kept,
            empty => match make() {
                Ok(made) => empty.insert(Ok(made)),
                Err(NoTool::Unknown(why)) => empty.insert(Err(why)),
                Err(NoTool::Stopped) => return Err(NoTool::Stopped),
            },
        };
        match kept {
            Ok((run, applied)) => Ok((run.fork(), *applied)),
            Err(why) => Err(NoTool::Unknown(why.clone())),
        }
    }

    fn slot(&self, key: Key) -> Slot {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (slots, order) = &mut *all;
        if let Some(slot) = slots.get(&key) {
            return Arc::clone(slot);
        }
        if order.len() >= MOST_KEPT {
            slots.remove(&order.remove(0));
        }
        order.push(key.clone());
        Arc::clone(slots.entry(key).or_default())
    }
}
