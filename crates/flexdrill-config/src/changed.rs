//! What a running configuration differs in from the one that its run began with.

use std::collections::BTreeMap;
use std::fmt;

use flexdrill_text::six_digits;

use super::Config;

/// Publishing rates and drawing: they change what is shown of a motion and how often, and no alarm depends on them.
const SHOWN: &str = "outputs.";
/// Keys that `calibration.follow` moves, friction factor and torque tare.
pub const FOLLOWED: [&str; 2] = ["calibration.friction_factor", "calibration.torque_tare_nm"];

/// A numeric key whose value has changed.
#[derive(Debug, Clone, PartialEq)]
pub struct ChangedNumber {
    /// Dotted path.
    pub key: String,
    /// Value before the change.
    pub from: f64,
    /// Value after it.
    pub to: f64,
    /// Empty if dimensionless.
    pub unit: &'static str,
}

impl fmt::Display for ChangedNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, from, to, unit } = self;
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" {unit}")
        };
        let [from, to] = [from, to].map(|value| six_digits(*value));
        write!(f, "{key} is {to}{unit}, configured {from}{unit}")
    }
}

impl Config {
    /// The numeric keys on which motion or alarms depend and whose values differ from `earlier`, by their names. Those
    /// that `calibration.follow` moves are left out: the alarm on rig and twin covers them.
    pub fn changed_since(&self, earlier: &Self) -> Vec<ChangedNumber> {
        let before: BTreeMap<String, f64> = earlier.numbers().into_iter().map(|of| (of.key, of.value)).collect();
        let follows = |key: &str| self.calibration.follow && FOLLOWED.contains(&key);
        let mut changed: Vec<ChangedNumber> = self
            .numbers()
            .into_iter()
            .filter(|now| !now.key.starts_with(SHOWN) && !follows(&now.key))
            .filter_map(|now| {
                let from = *before.get(&now.key)?;
                (from != now.value).then_some(ChangedNumber {
                    key: now.key,
                    from,
                    to: now.value,
                    unit: now.unit,
                })
            })
            .collect();
        changed.sort_by(|a, b| a.key.cmp(&b.key));
        changed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_that_decide_on_alarms_are_named_and_what_is_shown_is_not() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml");
        let begun = Config::load(path).unwrap();
        assert_eq!(begun.changed_since(&begun), []);
        let names = |follow: bool| {
            let begun = begun.with_value("calibration.follow", follow).unwrap();
            let values = [
                (
                    "whirl.backward_cycles.warning",
                    1.01 * begun.whirl.backward_cycles.warning,
                ),
                ("inputs.rotary_speed.max_age", 7.5),
                (FOLLOWED[0], 0.9),
                ("outputs.rates.whirl", 5.0),
                ("outputs.exaggeration", 3.0),
            ];
            let now = begun.with_live_values("a client", values).unwrap();
            let changed = now.changed_since(&begun);
            changed.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        let texts = names(false);
        assert_eq!(texts.len(), 3, "{texts:?}");
        assert_eq!(texts[0], "calibration.friction_factor is 0.9, configured 1");
        assert_eq!(texts[1], "inputs.rotary_speed.max_age is 7.5 s, configured 5 s");
        assert!(texts[2].starts_with("whirl.backward_cycles.warning is "), "{texts:?}");
        assert_eq!(names(true), texts[1..]);
    }
}
