//! The twin's alarms as conditions after Part 9: events of `AlarmConditionType` that a client filters and selects from.

use ::opcua::nodes::Event;
use ::opcua::types::{
    AttributeId, ByteString, DateTime, LocalizedText, NodeId, NumericRange, ObjectTypeId, QualifiedName, StatusCode,
    Variant, event_field::EventField,
};
use flexdrill_messages::Alarm;

/// The severity of Part 9 (1 to 1000) of a priority: the middles of its ranges low, medium and high.
pub const fn severity(priority: u8) -> u16 {
    match priority {
        Alarm::LOW => 200,
        Alarm::MEDIUM => 500,
        Alarm::HIGH => 800,
        _ => 1,
    }
}

/// What of an alarm makes a new event when it changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Standing {
    state: u8,
    priority: u8,
    active: bool,
    acknowledged: bool,
}

impl Standing {
    /// That of an alarm.
    pub const fn of(alarm: &Alarm) -> Self {
        Self {
            state: alarm.state,
            priority: alarm.priority,
            active: alarm.active,
            acknowledged: alarm.acknowledged,
        }
    }

    /// Whether a client should show the condition.
    pub const fn retain(self) -> bool {
        self.active || !self.acknowledged || self.state == Alarm::SHELVED
    }
}

/// A condition of the twin at one instant.
#[derive(Debug, Clone)]
pub struct Condition {
    event_type: NodeId,
    event_id: ByteString,
    node: NodeId,
    name: String,
    message: String,
    category: u8,
    shelved: bool,
    suppressed: bool,
    out_of_service: bool,
    standing: Standing,
    last_severity: u16,
    time: DateTime,
    quality: StatusCode,
}

impl Condition {
    /// The condition of an alarm whose node is `node`. `number` counts the events.
    pub fn new(
        alarm: &Alarm,
        node: NodeId,
        number: u64,
        last_severity: u16,
        time: DateTime,
        quality: StatusCode,
    ) -> Self {
        let mut event_id = time.ticks().to_be_bytes().to_vec();
        event_id.extend(number.to_be_bytes());
        let texts = [&alarm.evidence, &alarm.consequence, &alarm.what_to_do];
        let texts: Vec<&str> = texts
            .into_iter()
            .map(String::as_str)
            .filter(|text| !text.is_empty())
            .collect();
        Self {
            event_type: ObjectTypeId::AlarmConditionType.into(),
            event_id: ByteString::from(event_id),
            node,
            name: alarm.name.clone(),
            message: if texts.is_empty() {
                format!("{}: {}", alarm.name, super::alarms::state(alarm))
            } else {
                texts.join(" ")
            },
            category: alarm.category,
            shelved: alarm.state == Alarm::SHELVED,
            suppressed: alarm.state == Alarm::SUPPRESSED_BY_DESIGN,
            out_of_service: alarm.state == Alarm::OUT_OF_SERVICE,
            standing: Standing::of(alarm),
            last_severity,
            time,
            quality,
        }
    }

    /// Whether a client should show it.
    pub const fn retain(&self) -> bool {
        self.standing.retain()
    }

    fn field(&self, path: &str) -> Variant {
        // Only English is served, and marked as such, so that a client with other locales knows.
        let text = |text: &str| Variant::from(LocalizedText::new("en", text));
        let either = |yes: bool, words: [&str; 2]| text(words[usize::from(!yes)]);
        // Paths are those of the standard's type. A client selects fields by
        // them, and gets an empty value for one that is unknown.
        match path {
            "EventId" => self.event_id.clone().into(),
            "EventType" => self.event_type.clone().into(),
            "SourceNode" => self.node.clone().into(),
            "SourceName" | "ConditionName" => Variant::from(self.name.as_str()),
            "Time" | "ReceiveTime" => self.time.into(),
            "Message" => text(&self.message),
            "Severity" => severity(self.standing.priority).into(),
            "LastSeverity" => self.last_severity.into(),
            "ConditionClassId" => NodeId::from(if self.category == Alarm::SYSTEM {
                ObjectTypeId::SystemConditionClassType
            } else {
                ObjectTypeId::ProcessConditionClassType
            })
            .into(),
            "ConditionClassName" => text(if self.category == Alarm::SYSTEM {
                "System"
            } else {
                "Process"
            }),
            // Earlier states of a condition are no conditions of their own here.
            "BranchId" | "InputNode" => NodeId::null().into(),
            "Retain" => self.retain().into(),
            "Quality" => self.quality.into(),
            "Comment" => text(""),
            "ClientUserId" => Variant::from(""),
            "EnabledState" => either(!self.out_of_service, ["Enabled", "Disabled"]),
            "EnabledState/Id" => (!self.out_of_service).into(),
            "ActiveState" => either(self.standing.active, ["Active", "Inactive"]),
            "ActiveState/Id" => self.standing.active.into(),
            "AckedState" => either(self.standing.acknowledged, ["Acknowledged", "Unacknowledged"]),
            "AckedState/Id" => self.standing.acknowledged.into(),
            "SuppressedState" => either(self.suppressed, ["Suppressed", "Unsuppressed"]),
            "SuppressedState/Id" => self.suppressed.into(),
            "OutOfServiceState" => either(self.out_of_service, ["Out of Service", "In Service"]),
            "OutOfServiceState/Id" => self.out_of_service.into(),
            "SuppressedOrShelved" => (self.suppressed || self.shelved || self.out_of_service).into(),
            _ => Variant::Empty,
        }
    }
}

impl EventField for Condition {
    fn get_value(&self, attribute: AttributeId, range: &NumericRange, path: &[QualifiedName]) -> Variant {
        if path.is_empty() {
            // The id of the condition itself.
            return match attribute {
                AttributeId::NodeId => self.node.clone().into(),
                _ => Variant::Empty,
            };
        }
        if attribute != AttributeId::Value || path.iter().any(|name| name.namespace_index != 0) {
            return Variant::Empty;
        }
        let names: Vec<&str> = path.iter().map(|name| name.name.as_ref()).collect();
        self.field(&names.join("/"))
            .range_of_owned(range)
            .unwrap_or(Variant::Empty)
    }
}

impl Event for Condition {
    fn get_field(&self, _of: &NodeId, attribute: AttributeId, range: &NumericRange, path: &[QualifiedName]) -> Variant {
        // The server has checked that the type has the field, and no two types of one branch share a name.
        self.get_value(attribute, range, path)
    }

    fn time(&self) -> &DateTime {
        &self.time
    }

    fn event_type_id(&self) -> &NodeId {
        &self.event_type
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_has_the_fields_of_its_type() {
        let alarm = Alarm {
            id: "backward_whirl".into(),
            name: "Backward whirl".into(),
            state: Alarm::ACTIVE_UNACKNOWLEDGED,
            priority: Alarm::HIGH,
            active: true,
            evidence: "Backward whirl of the pipe at 1.5 m.".into(),
            what_to_do: "Lower the speed below 80 r/min.".into(),
            ..Alarm::default()
        };
        let node = NodeId::new(2, "alarms/backward_whirl");
        let condition = Condition::new(&alarm, node.clone(), 7, 500, DateTime::now(), StatusCode::Good);
        let value = |path: &[&str]| {
            let path: Vec<QualifiedName> = path.iter().map(|name| QualifiedName::new(0, *name)).collect();
            condition.get_field(&NodeId::null(), AttributeId::Value, &NumericRange::None, &path)
        };
        assert_eq!(value(&["Severity"]), Variant::from(800_u16));
        assert_eq!(value(&["LastSeverity"]), Variant::from(500_u16));
        assert_eq!(value(&["ActiveState", "Id"]), Variant::from(true));
        assert_eq!(value(&["AckedState", "Id"]), Variant::from(false));
        assert_eq!(value(&["Retain"]), Variant::from(true));
        assert_eq!(value(&["EventType"]), Variant::from(NodeId::new(0, 2915_u32)));
        let message = Variant::from(LocalizedText::new(
            "en",
            "Backward whirl of the pipe at 1.5 m. Lower the speed below 80 r/min.",
        ));
        assert_eq!(value(&["Message"]), message);
        assert_eq!(value(&["NoSuchField"]), Variant::Empty);
        let id = condition.get_value(AttributeId::NodeId, &NumericRange::None, &[]);
        assert_eq!(id, Variant::from(node));
        assert!(
            !Standing::of(&Alarm {
                acknowledged: true,
                ..Alarm::default()
            })
            .retain()
        );
    }
}
