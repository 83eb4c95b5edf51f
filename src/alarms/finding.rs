//! What is known of an alarm's condition, with its words.

use flexdrill_alarms::{Priority, Time};
use flexdrill_core::motion::IncidentLocation;

/// A condition as it is now. Sentences begin with a capital and end with a full stop.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Its priority; none while it is not there.
    pub priority: Option<Priority>,
    /// The tool is in a state in which it means nothing.
    pub suppressed: bool,
    /// Where it was worst when it was seen.
    pub place: Option<IncidentLocation>,
    /// What it is judged by, in `unit`; NaN where there is no such number.
    pub value: f64,
    /// What `value` is held against.
    pub threshold: f64,
    /// Of both.
    pub unit: &'static str,
    /// How far it can be trusted, 0 to 1.
    pub confidence: f64,
    /// What is seen.
    pub evidence: String,
    /// Why it comes.
    pub cause: String,
    /// What it leads to.
    pub consequence: String,
    /// What the driller can do: weight, speed, pick up, call the engineer. It names no file, no parameter and no mesh.
    /// The book writes it for the alarms of the tool's motion, which are advised together.
    pub what_to_do: String,
    /// What the engineer can do.
    pub what_the_engineer_can_do: String,
    /// When place, value and evidence were seen (ns); none where that is now.
    pub seen: Option<Time>,
    /// When the condition ended, where the priority is only held (ns).
    pub ended: Option<Time>,
}

impl Default for Finding {
    /// Nothing there.
    fn default() -> Self {
        Self {
            priority: None,
            suppressed: false,
            place: None,
            value: f64::NAN,
            threshold: f64::NAN,
            unit: "",
            confidence: 1.0,
            evidence: String::new(),
            cause: String::new(),
            consequence: String::new(),
            what_to_do: String::new(),
            what_the_engineer_can_do: String::new(),
            seen: None,
            ended: None,
        }
    }
}
