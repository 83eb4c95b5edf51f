//! `offered_qos_profiles` as rosbag2 writes them: policies as words since version 9, as numbers before.

use std::fmt::Write as _;

use serde::Deserialize;

use flexdrill_messages::topics::Qos;

/// rosbag2 writes an infinite duration as the largest that fits.
const INFINITE: &str = "sec: 9223372036\n    nsec: 854775807";

/// The YAML list, in block style, ending in a newline.
pub(crate) fn to_yaml(profiles: &[Qos]) -> String {
    if profiles.is_empty() {
        return "[]\n".to_owned();
    }
    let mut text = String::new();
    for qos in profiles {
        let _ = write!(
            text,
            concat!(
                "- history: keep_last\n  depth: {}\n  reliability: {}\n  durability: {}\n",
                "  deadline:\n    {}\n  lifespan:\n    {}\n",
                "  liveliness: automatic\n  liveliness_lease_duration:\n    {}\n",
                "  avoid_ros_namespace_conventions: false\n",
            ),
            qos.depth,
            if qos.reliable { "reliable" } else { "best_effort" },
            if qos.transient_local {
                "transient_local"
            } else {
                "volatile"
            },
            INFINITE,
            INFINITE,
            INFINITE,
        );
    }
    text
}

/// A policy, as a word or as rmw's number.
#[derive(Deserialize)]
#[serde(untagged)]
enum Policy {
    Number(i64),
    Word(String),
}

impl Policy {
    /// In rmw's enumerations, `reliable` and `transient_local` are both 1.
    fn is(&self, word: &str) -> bool {
        match self {
            Self::Number(number) => *number == 1,
            Self::Word(text) => text == word,
        }
    }
}

#[derive(Deserialize)]
struct Profile {
    #[serde(default)]
    depth: u32,
    reliability: Policy,
    durability: Policy,
}

/// The profiles in a YAML list. Text that cannot be parsed gives none, so that it never prevents reading the bag.
pub fn from_yaml(text: &str) -> Vec<Qos> {
    let profiles: Vec<Profile> = serde_saphyr::from_str(text).unwrap_or_default();
    profiles
        .iter()
        .map(|profile| Qos {
            reliable: profile.reliability.is("reliable"),
            transient_local: profile.durability.is("transient_local"),
            depth: profile.depth,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_profiles_are_read() {
        let profiles = [
            Qos {
                reliable: true,
                transient_local: true,
                depth: 1,
            },
            Qos {
                reliable: false,
                transient_local: false,
                depth: 10,
            },
        ];
        assert_eq!(from_yaml(&to_yaml(&profiles)), profiles);
        assert!(from_yaml(&to_yaml(&[])).is_empty());
    }

    #[test]
    fn older_numbers_are_read_and_nonsense_is_none() {
        let old = "- history: 1\n  depth: 7\n  reliability: 2\n  durability: 1\n  deadline:\n    sec: 0\n    nsec: 0\n";
        assert_eq!(
            from_yaml(old),
            [Qos {
                reliable: false,
                transient_local: true,
                depth: 7
            }]
        );
        assert!(from_yaml("").is_empty());
        assert!(from_yaml("{[").is_empty());
    }
}
