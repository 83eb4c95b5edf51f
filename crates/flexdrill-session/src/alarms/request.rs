//! Requests of an operator by service.

use crate::messages::{AcknowledgeAlarmRequest, ShelveAlarmRequest, UnshelveAlarmRequest};
use flexdrill_alarms::{AlarmSystem, Event, Operator, Refusal, Shelving, Time};
use flexdrill_text::printable;

/// Addresses every alarm in an acknowledgement.
const ALL: &str = "all";

/// A request of an operator.
#[derive(Debug, Clone, PartialEq)]
pub enum Request {
    /// Acknowledges an alarm, or all.
    Acknowledge(AcknowledgeAlarmRequest),
    /// Shelves an alarm.
    Shelve(ShelveAlarmRequest),
    /// Ends a shelving.
    Unshelve(UnshelveAlarmRequest),
}

impl Request {
    /// Carries the request out. Returns what was done.
    pub(super) fn carry_out(
        &self,
        system: &mut AlarmSystem,
        time: Time,
        events: &mut Vec<Event>,
    ) -> Result<String, Refusal> {
        // The name enters the journal, and every reader of it shows the name.
        let (name, reason) = self.operator();
        let (name, reason) = (printable(name), printable(reason));
        let by = Operator {
            name: &name,
            reason: &reason,
        };
        match self {
            Request::Acknowledge(request) if ["", ALL].contains(&request.id.as_str()) => {
                let count = system.acknowledge_all(time, &by, events)?;
                Ok(format!("alarms acknowledged: {count}"))
            }
            Request::Acknowledge(request) => {
                system.acknowledge(system.find(&request.id)?, time, &by, events)?;
                Ok(format!("{} acknowledged", request.id))
            }
            Request::Shelve(request) => {
                let how = if request.one_shot {
                    Shelving::OneShot
                } else {
                    Shelving::Timed(request.duration)
                };
                let until = system.shelve(system.find(&request.id)?, time, how, &by, events)?;
                let seconds = (until - time) as f64 * 1e-9;
                let when = if request.one_shot {
                    format!("until its condition ends, for {seconds:.0} s at most")
                } else {
                    format!("for {seconds:.0} s")
                };
                Ok(format!("{} shelved {when}", request.id))
            }
            Request::Unshelve(request) => {
                system.unshelve(system.find(&request.id)?, time, &by, events)?;
                Ok(format!("{} is no longer shelved", request.id))
            }
        }
    }

    /// The operator's name, and the reason.
    fn operator(&self) -> (&str, &str) {
        match self {
            Request::Acknowledge(request) => (&request.operator_name, &request.reason),
            Request::Shelve(request) => (&request.operator_name, &request.reason),
            Request::Unshelve(request) => (&request.operator_name, &request.reason),
        }
    }
}
