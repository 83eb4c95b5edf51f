//! Confirmations of persons that a bridge reads the rig's line rightly: those of bridges whose samples this node receives,
//! for the journal of the alarms, which every recording has.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::receive::decode;
use crate::rig_inputs::DriverId;
use flexdrill_messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use flexdrill_ros2::dds::port::{Inbox, Sample};
use flexdrill_ros2::service::Task;
use flexdrill_text::printable;

/// Most bridges that are known: a process that comes back has another id, and the oldest leaves.
const MOST_BRIDGES: usize = 16;
/// Most confirmations of a run: a program that invents them must not fill the journal.
const MOST: usize = 64;
/// Longest text of a confirmation (bytes); a longer one is none of a bridge of ours.
const LONGEST: usize = 400;

/// A confirmation as the journal has it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Confirmation {
    /// Who compared the values with the rig's display.
    pub by: String,
    /// Mapping, source and date, in words.
    pub reason: String,
}

/// The confirmations that bridges report on `/diagnostics`, once per second each.
#[derive(Debug, Clone, Default)]
pub struct Confirmed(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    /// A writer of each process that has sent messages of a rig.
    bridges: Vec<DriverId>,
    /// Those that were taken, and behind them those that were not.
    known: Vec<Confirmation>,
    taken: usize,
}

impl Confirmed {
    /// Notes who sends messages of a rig: only bridges that this node reads belong into its journal, as `/diagnostics` is
    /// one topic for all rigs.
    pub fn rig_message(&self, id: DriverId) {
        let bridges = &mut self.locked().bridges;
        if bridges.iter().any(|known| known.same_process(&id)) {
            return;
        }
        if bridges.len() == MOST_BRIDGES {
            bridges.remove(0);
        }
        bridges.push(id);
    }

    /// Takes diagnostics that `id` has sent.
    pub fn observe(&self, array: &DiagnosticArray, id: DriverId) {
        let mut state = self.locked();
        if !state.bridges.iter().any(|known| known.same_process(&id)) {
            return;
        }
        for confirmation in array.status.iter().filter_map(confirmation) {
            if state.known.len() < MOST && !state.known.contains(&confirmation) {
                state.known.push(confirmation);
            }
        }
    }

    /// The confirmations since the last call, oldest first.
    pub fn take(&self) -> Vec<Confirmation> {
        let mut state = self.locked();
        let fresh = state.known.iter().skip(state.taken).cloned().collect();
        state.taken = state.known.len();
        fresh
    }

    fn locked(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The confirmation in an item of a bridge: "2023-11-14 22:13:20 UTC by ann" under `confirmed`, with mapping and source.
fn confirmation(status: &DiagnosticStatus) -> Option<Confirmation> {
    let value = |key: &str| {
        let found = status.values.iter().find(|pair| pair.key == key)?;
        Some(found.value.as_str()).filter(|value| !value.is_empty())
    };
    let (mapping, source) = (value("mapping")?, value("source")?);
    let (when, by) = value("confirmed")?.split_once(" by ")?;
    if by.is_empty() {
        return None;
    }
    let file = value("mapping_file").map_or_else(String::new, |file| format!(" ({file})"));
    let reason = format!("mapping {mapping}{file} of {source} was confirmed at {when}");
    (reason.len() + by.len() <= LONGEST).then(|| Confirmation {
        by: printable(by).into_owned(),
        reason: printable(&reason).into_owned(),
    })
}

/// The confirmations, and the task that receives them from `/diagnostics`.
pub fn receive(samples: Arc<Inbox<Sample>>) -> (Confirmed, Task) {
    let confirmed = Confirmed::default();
    let receiving = confirmed.clone();
    let task = async move {
        loop {
            // What cannot be read is none of a bridge of ours.
            if let Ok((array, writer)) = decode(samples.next().await) {
                receiving.observe(&array, DriverId(writer));
            }
        }
    };
    (confirmed, Box::pin(task))
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::diagnostic_msgs::KeyValue;

    /// A writer of a process.
    fn writer(process: u8, writer: u8) -> DriverId {
        let mut id = [process; 16];
        id[15] = writer;
        DriverId(id)
    }

    fn item(source: &str, confirmed: &str) -> DiagnosticArray {
        let values = [
            ("source", source),
            ("mapping", "5f0c9a1be27d4436"),
            ("mapping_file", "site.yaml"),
            ("confirmed", confirmed),
        ];
        DiagnosticArray {
            status: vec![DiagnosticStatus {
                values: values
                    .map(|(key, value)| KeyValue {
                        key: key.to_owned(),
                        value: value.to_owned(),
                    })
                    .to_vec(),
                ..DiagnosticStatus::default()
            }],
            ..DiagnosticArray::default()
        }
    }

    #[test]
    fn a_confirmation_of_a_bridge_that_drives_the_node_is_taken_once() {
        let confirmed = Confirmed::default();
        let by_ann = item("10.0.0.7", "2023-11-14 22:13:20 UTC by ann by the rig");
        // Another rig's bridge, and one whose first sample has not come.
        confirmed.observe(&by_ann, writer(1, 3));
        confirmed.rig_message(writer(2, 1));
        confirmed.observe(&by_ann, writer(1, 3));
        assert_eq!(confirmed.take(), []);
        confirmed.rig_message(writer(1, 4));
        for _ in 0..3 {
            confirmed.observe(&by_ann, writer(1, 3));
        }
        let expected = Confirmation {
            by: "ann by the rig".to_owned(),
            reason: "mapping 5f0c9a1be27d4436 (site.yaml) of 10.0.0.7 was confirmed at 2023-11-14 22:13:20 UTC"
                .to_owned(),
        };
        assert_eq!(confirmed.take(), [expected]);
        confirmed.observe(&by_ann, writer(1, 3));
        assert_eq!(confirmed.take(), []);
        // Another source, and another date of the same.
        confirmed.observe(&item("10.0.0.8", "2023-11-14 22:13:20 UTC by ann"), writer(1, 3));
        confirmed.observe(&item("10.0.0.7", "2023-11-15 08:00:00 UTC by ann"), writer(1, 3));
        assert_eq!(confirmed.take().len(), 2);
    }

    #[test]
    fn what_is_not_confirmed_or_of_others_makes_no_entry() {
        let confirmed = Confirmed::default();
        confirmed.rig_message(writer(1, 1));
        for words in ["", "soon", "2023-11-14 22:13:20 UTC by "] {
            confirmed.observe(&item("10.0.0.7", words), writer(1, 3));
        }
        confirmed.observe(&DiagnosticArray::default(), writer(1, 3));
        confirmed.observe(&item("", "2023-11-14 22:13:20 UTC by ann"), writer(1, 3));
        confirmed.observe(
            &item(&"x".repeat(LONGEST), "2023-11-14 22:13:20 UTC by ann"),
            writer(1, 3),
        );
        assert_eq!(confirmed.take(), []);
        // Text of others is one line.
        confirmed.observe(&item("a\nb", "2023-11-14 22:13:20 UTC by \x1b[2J"), writer(1, 3));
        let found = confirmed.take();
        assert!(
            !format!("{}{}", found[0].by, found[0].reason).contains(char::is_control),
            "{found:?}"
        );
    }

    #[test]
    fn who_invents_confirmations_fills_no_memory() {
        let confirmed = Confirmed::default();
        for process in 0..100 {
            confirmed.rig_message(writer(process, 1));
        }
        assert_eq!(confirmed.locked().bridges.len(), MOST_BRIDGES);
        for number in 0..1000 {
            confirmed.observe(
                &item(&number.to_string(), "2023-11-14 22:13:20 UTC by ann"),
                writer(99, 3),
            );
        }
        assert_eq!(confirmed.take().len(), MOST);
        assert_eq!(confirmed.take(), []);
    }
}
