//! A finding: the condition of an alarm with its texts.

use super::catalogue::AlarmId;
use flexdrill_alarms::{Priority, Time};
use flexdrill_motion::ToolLocation;

/// The present condition. Sentences begin with a capital and end with a full stop.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The priority of the condition; none while the condition is not met.
    pub priority: Option<Priority>,
    /// The state of drive or node makes the condition meaningless.
    pub suppressed: bool,
    /// The worst location.
    pub place: Option<ToolLocation>,
    /// The value that is judged, in `unit`; NaN where the condition has none.
    pub value: f64,
    /// The limit of `value`.
    pub threshold: f64,
    /// The unit of `value` and `threshold`.
    pub unit: &'static str,
    /// The confidence of the analysis, 0 to 1.
    pub confidence: f64,
    /// What was observed.
    pub evidence: String,
    /// The physical or technical cause.
    pub cause: String,
    /// Why it matters.
    pub consequence: String,
    /// What the driller can do: weight, speed, pick up, call the engineer; never a file, a parameter or a mesh. For the
    /// alarms of the tool's motion the book writes it, since they share one advice.
    pub what_to_do: String,
    /// The alarm that `what_to_do` refers to; none for an alarm with its own action.
    pub follows: Option<AlarmId>,
    /// What the engineer can do.
    pub what_the_engineer_can_do: String,
    /// When location, value and evidence were observed (ns); none for the present.
    pub seen: Option<Time>,
    /// When the condition for `priority` was last met, where the analysis only holds the level (ns).
    pub ended: Option<Time>,
    /// The lower priority that the condition has then; none where it has ended.
    pub less: Option<Priority>,
}

impl Finding {
    /// The present priority of the condition.
    pub(super) fn present(&self) -> Option<Priority> {
        if self.ended.is_some() { self.less } else { self.priority }
    }
}

impl Default for Finding {
    /// The condition is not met.
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
            follows: None,
            what_the_engineer_can_do: String::new(),
            seen: None,
            ended: None,
            less: None,
        }
    }
}
