//! The alarm "changed parameters": a client has changed values that alarms depend on, and the journal says who.

use std::sync::Arc;

use flexdrill_alarms::{Priority, Time};
use flexdrill_config::{ChangedNumber, Config};
use flexdrill_text::six_digits;

use super::finding::Finding;
use flexdrill_outputs::ParameterChange;

/// Who asks for a change by following the rig, for the log, the journal and the recording.
pub const FOLLOW: &str = "calibration.follow";

/// Entries within [`SPAN`] (ns) after which changes wait for its end and share one, so that a client that changes a value
/// without end does not fill the journal.
const AT_ONCE: usize = 10;
const SPAN: Time = 10_000_000_000;
/// Changes that a text names.
const NAMED: usize = 6;

/// A change that the journal does not yet have.
#[derive(Debug, Clone, PartialEq)]
struct Pending {
    change: ChangedNumber,
    by: String,
}

/// An entry of the journal: who changed what.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    /// Service and client; empty where they are not known.
    pub(super) by: String,
    /// The values before and after, as a text.
    pub(super) reason: String,
}

/// What differs from the configuration that the run began with, and what of it the journal does not yet have.
#[derive(Debug, Clone)]
pub(super) struct Changed {
    begun: Arc<Config>,
    differs: Vec<ChangedNumber>,
    pending: Vec<Pending>,
    /// The present span: its beginning, and the times at which it had entries.
    span: Option<(Time, usize)>,
}

impl Changed {
    /// Nothing differs from the configuration of the start.
    pub(super) fn new(begun: Arc<Config>) -> Self {
        Self {
            begun,
            differs: Vec::new(),
            pending: Vec::new(),
            span: None,
        }
    }

    /// Takes a change of the configuration in force, with the requests behind it.
    pub(super) fn reconfigure(&mut self, before: &Config, now: &Config, changes: &[ParameterChange]) {
        for change in now.changed_since(before) {
            let request = changes.iter().rev().find(|request| request.name == change.key);
            let by = request.map_or("", |request| request.asked_by.as_str());
            // The journal has these moves under `rig_disagrees`.
            if by == FOLLOW {
                continue;
            }
            let same = |pending: &&mut Pending| pending.by == by && pending.change.key == change.key;
            match self.pending.iter_mut().find(same) {
                Some(pending) => pending.change.to = change.to,
                None => self.pending.push(Pending {
                    change,
                    by: by.to_owned(),
                }),
            }
        }
        self.differs = now.changed_since(&self.begun);
    }

    /// The entries that are due at a time, one per client.
    pub(super) fn due(&mut self, time: Time) -> Vec<Entry> {
        // A clock that was set back begins a new span.
        let (began, used) = self
            .span
            .filter(|(began, _)| (0..SPAN).contains(&(time - began)))
            .unwrap_or((time, 0));
        if self.pending.is_empty() || used >= AT_ONCE {
            return Vec::new();
        }
        self.span = Some((began, used + 1));
        let mut entries: Vec<(String, Vec<String>)> = Vec::new();
        for Pending { change, by } in std::mem::take(&mut self.pending) {
            let text = format!(
                "{} from {} to {}",
                change.key,
                six_digits(change.from),
                with_unit(change.to, change.unit)
            );
            match entries.iter_mut().find(|(who, _)| *who == by) {
                Some((_, texts)) => texts.push(text),
                None => entries.push((by, vec![text])),
            }
        }
        entries
            .into_iter()
            .map(|(by, texts)| Entry {
                by,
                reason: listed(&texts),
            })
            .collect()
    }

    /// The condition, with its texts.
    pub(super) fn finding(&self) -> Finding {
        if self.differs.is_empty() {
            return Finding::default();
        }
        let texts: Vec<String> = self.differs.iter().map(ToString::to_string).collect();
        Finding {
            priority: Some(Priority::Low),
            value: self.differs.len() as f64,
            threshold: 0.0,
            unit: "values",
            evidence: format!("The twin differs from its configuration: {}.", listed(&texts)),
            cause: "A client has changed these values while the twin runs; the journal says who.".to_owned(),
            consequence:
                "Alarms are judged with other limits or another friction than was checked: some may be missing, \
                          early or false."
                    .to_owned(),
            what_to_do: "Ask the engineer whether this change is meant.".to_owned(),
            what_the_engineer_can_do:
                "Set the values back with ros2 param set, or write them into the configuration and \
                                       start the node again."
                    .to_owned(),
            ..Finding::default()
        }
    }
}

fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "" => six_digits(value),
        unit => format!("{} {unit}", six_digits(value)),
    }
}

fn listed(texts: &[String]) -> String {
    let named = texts.iter().take(NAMED).cloned().collect::<Vec<_>>().join("; ");
    match texts.len().saturating_sub(NAMED) {
        0 => named,
        more => format!("{named}; and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CYCLES: &str = "whirl.backward_cycles.critical";
    const FRICTION: &str = "contact.inner.friction_tangential";

    fn config() -> Arc<Config> {
        Arc::new(Config::from_text("default.yaml", include_str!("../../../../config/default.yaml")).unwrap())
    }

    fn request(name: &str, value: f64, asked_by: &str) -> ParameterChange {
        ParameterChange {
            name: name.to_owned(),
            value,
            asked_by: asked_by.to_owned(),
        }
    }

    #[test]
    fn each_client_has_an_entry_and_the_condition_stands_until_nothing_differs() {
        let begun = config();
        let [cycles, friction] = [
            begun.whirl.backward_cycles.critical,
            begun.contact.inner.friction_tangential,
        ];
        let mut changed = Changed::new(Arc::clone(&begun));
        let mut now = Arc::clone(&begun);
        let mut set = |changed: &mut Changed, values: &[(&str, f64)], by: &str| {
            let requests: Vec<_> = values.iter().map(|(name, value)| request(name, *value, by)).collect();
            let after = Arc::new(now.with_live_values("a test", values.iter().copied()).unwrap());
            changed.reconfigure(&now, &after, &requests);
            now = after;
        };
        assert_eq!(changed.finding().priority, None);
        set(
            &mut changed,
            &[(CYCLES, 1.1 * cycles), ("outputs.rates.whirl", 5.0)],
            "ann",
        );
        let [entry] = &changed.due(0)[..] else { panic!() };
        assert_eq!(entry.by, "ann");
        assert!(
            entry
                .reason
                .starts_with(&format!("{CYCLES} from {} to", six_digits(cycles)))
                && !entry.reason.contains("outputs"),
            "{}",
            entry.reason
        );
        let finding = changed.finding();
        assert_eq!((finding.priority, finding.value), (Some(Priority::Low), 1.0));
        assert!(finding.evidence.contains("configured"), "{}", finding.evidence);
        // A client that changes a value without end has ten entries within ten seconds, and nothing is lost.
        let mut entered = 1;
        for step in 1..100 {
            set(
                &mut changed,
                &[(FRICTION, friction * (1.0 + 0.001 * f64::from(step)))],
                "bob",
            );
            entered += changed.due(SPAN / 2).len();
        }
        assert_eq!(entered, AT_ONCE);
        set(&mut changed, &[(CYCLES, cycles)], "ann");
        let entries = changed.due(SPAN);
        assert_eq!(
            entries.iter().map(|entry| entry.by.as_str()).collect::<Vec<_>>(),
            ["bob", "ann"]
        );
        assert!(
            entries[0]
                .reason
                .ends_with(&format!(" to {}", six_digits(1.099 * friction))),
            "{entries:?}"
        );
        assert_eq!(changed.finding().value, 1.0);
        set(&mut changed, &[(FRICTION, friction)], "bob");
        assert_eq!(changed.finding().priority, None);
        assert_eq!(changed.due(SPAN).len(), 1);
    }

    /// The journal has the moves of `calibration.follow` under `rig_disagrees`.
    #[test]
    fn what_follows_the_rig_is_no_change_of_a_client() {
        let begun = Arc::new(config().with_value("calibration.follow", true).unwrap());
        let mut changed = Changed::new(Arc::clone(&begun));
        let key = "calibration.friction_factor";
        let now = begun.with_live_values("a test", [(key, 1.01)]).unwrap();
        changed.reconfigure(&begun, &now, &[request(key, 1.01, FOLLOW)]);
        assert_eq!(changed.finding().priority, None);
        assert_eq!(changed.due(0), []);
    }
}
