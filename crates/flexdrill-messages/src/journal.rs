//! An event of the alarms' journal, as the incidents of an alarm read it.

use crate::{Alarm, AlarmEvent};
use flexdrill_alarms::{Course, Occurrence};

impl AlarmEvent {
    /// What the event means for the incident of its alarm.
    pub fn occurrence(&self) -> Occurrence<'_> {
        let stands = [Alarm::ACTIVE_UNACKNOWLEDGED, Alarm::ACTIVE_ACKNOWLEDGED].contains(&self.to_state);
        Occurrence {
            alarm: &self.id,
            course: match self.change {
                AlarmEvent::ACTIVATED | AlarmEvent::RAISED => Course::Stands,
                AlarmEvent::RELEASED | AlarmEvent::PUT_BACK | AlarmEvent::UNSHELVED if stands => Course::Stands,
                AlarmEvent::RETURNED | AlarmEvent::SUPPRESSED | AlarmEvent::TAKEN_OUT => Course::Ends,
                AlarmEvent::ACKNOWLEDGED => Course::Acknowledged,
                _ => Course::Unchanged,
            },
            priority: self.priority,
            operator: &self.operator_name,
            acts: self.follows.is_empty(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_begins_ends_or_acknowledges() {
        let course = |change, to_state| {
            let event = AlarmEvent {
                change,
                to_state,
                ..AlarmEvent::default()
            };
            event.occurrence().course
        };
        assert_eq!(course(AlarmEvent::RAISED, Alarm::SHELVED), Course::Stands);
        assert_eq!(
            course(AlarmEvent::UNSHELVED, Alarm::ACTIVE_UNACKNOWLEDGED),
            Course::Stands
        );
        assert_eq!(course(AlarmEvent::UNSHELVED, Alarm::NORMAL), Course::Unchanged);
        assert_eq!(
            course(AlarmEvent::SUPPRESSED, Alarm::SUPPRESSED_BY_DESIGN),
            Course::Ends
        );
        assert_eq!(
            course(AlarmEvent::LOWERED, Alarm::ACTIVE_UNACKNOWLEDGED),
            Course::Unchanged
        );
    }
}
