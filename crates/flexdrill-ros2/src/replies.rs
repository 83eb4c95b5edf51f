//! Short forms of replies that are too long to send, so that every client gets an answer.

use ros2_client::parameters::raw;
use ros2_client::rcl_interfaces::{
    DescribeParametersResponse, GetParameterTypesResponse, GetParametersResponse, ListParametersResponse,
    ListParametersResult, SetParametersAtomicallyResponse, SetParametersResponse,
};
use serde::Serialize;

use flexdrill_messages::action_msgs::CancelGoalResponse;
use flexdrill_messages::lifecycle_msgs::{
    ChangeStateResponse, GetAvailableStatesResponse, GetAvailableTransitionsResponse, GetStateResponse,
};
use flexdrill_messages::rcl_interfaces::{GetLoggerLevelsResponse, SetLoggerLevelsResponse, SetLoggerLevelsResult};
use flexdrill_messages::simulation_interfaces::{
    GetSimulationStateResponse, GetSimulatorFeaturesResponse, ResetSimulationResponse, Result as SimulationResult,
    SetSimulationStateResponse, SimulateStepsGetResultResponse, SimulateStepsSendGoalResponse, StepSimulationResponse,
};
use flexdrill_messages::std_srvs::{SetBoolResponse, TriggerResponse};
use flexdrill_messages::type_description_interfaces::GetTypeDescriptionResponse;
use flexdrill_messages::{
    AcknowledgeAlarmResponse, ConfirmMappingResponse, ShelveAlarmResponse, UnshelveAlarmResponse,
    WhatIfGetResultResponse, WhatIfSendGoalResponse,
};

/// Bytes for the reasons of a list of results together, when they must be cut.
const REASONS: usize = 30_000;
/// Most results whose flags fit next to those reasons, at 12 bytes each.
const MOST_RESULTS: usize = 2_000;

/// A reply that has a short form.
pub trait Reply: Serialize {
    /// The short form of a reply that is too long. The outcome of the request remains; `why` replaces the text where the reply
    /// has one, and lists without a text become empty.
    #[must_use]
    fn shortened(self, why: &str) -> Self;

    /// The reply to a request that must not be carried out, for this reason; `None` where the service only reads, and may be
    /// asked twice.
    fn refused(_why: &str) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }
}

/// Replies with a flag for the outcome, and a text.
macro_rules! flag_and_text {
    ($($reply:ty),*) => {$(
        impl Reply for $reply {
            fn shortened(self, why: &str) -> Self {
                Self { message: why.to_owned(), ..self }
            }

            fn refused(why: &str) -> Option<Self> {
                Some(Self { success: false, message: not_carried_out(why) })
            }
        }
    )*};
}

fn not_carried_out(why: &str) -> String {
    format!("the request was not carried out: {why}")
}

flag_and_text!(
    TriggerResponse,
    SetBoolResponse,
    AcknowledgeAlarmResponse,
    ConfirmMappingResponse,
    ShelveAlarmResponse,
    UnshelveAlarmResponse
);

/// Replies that are lists without a text.
macro_rules! list {
    ($($reply:ty { $field:ident }),*) => {$(
        impl Reply for $reply {
            fn shortened(self, _why: &str) -> Self {
                Self { $field: Vec::new() }
            }
        }
    )*};
}
list!(
    GetParametersResponse { values },
    GetParameterTypesResponse { values },
    GetLoggerLevelsResponse { levels },
    GetAvailableStatesResponse { available_states },
    GetAvailableTransitionsResponse { available_transitions }
);

/// Most descriptions of parameters that fit without their texts: a name, two flags and a range each.
const MOST_DESCRIBED: usize = 800;

impl Reply for DescribeParametersResponse {
    /// Names, types and ranges remain where they fit: a tool that asks for all parameters at once needs them, and can ask
    /// for the texts of one.
    fn shortened(mut self, _why: &str) -> Self {
        if self.values.len() > MOST_DESCRIBED {
            self.values = Vec::new();
        }
        for value in &mut self.values {
            (value.description, value.additional_constraints) = (String::new(), String::new());
        }
        self
    }
}

/// Replies that are never long.
macro_rules! short {
    ($($reply:ty),*) => {$(
        impl Reply for $reply {
            fn shortened(self, _why: &str) -> Self {
                self
            }
        }
    )*};
}
short!(
    GetStateResponse,
    GetSimulatorFeaturesResponse,
    GetSimulationStateResponse,
    SimulateStepsGetResultResponse
);

/// Replies with a result code and a text.
macro_rules! code_and_text {
    ($($reply:ty),*) => {$(
        impl Reply for $reply {
            fn shortened(mut self, why: &str) -> Self {
                why.clone_into(&mut self.result.error_message);
                self
            }

            fn refused(why: &str) -> Option<Self> {
                Some(Self {
                    result: SimulationResult {
                        result: SimulationResult::RESULT_OPERATION_FAILED,
                        error_message: not_carried_out(why),
                    },
                })
            }
        }
    )*};
}

code_and_text!(
    SetSimulationStateResponse,
    ResetSimulationResponse,
    StepSimulationResponse
);

impl Reply for CancelGoalResponse {
    fn shortened(self, _why: &str) -> Self {
        self
    }

    fn refused(_why: &str) -> Option<Self> {
        Some(Self {
            return_code: Self::ERROR_REJECTED,
            goals_canceling: Vec::new(),
        })
    }
}

impl Reply for ChangeStateResponse {
    fn shortened(self, _why: &str) -> Self {
        self
    }

    fn refused(_why: &str) -> Option<Self> {
        Some(Self { success: false })
    }
}

/// Replies to a goal: whether it is accepted.
macro_rules! accepted {
    ($($reply:ty),*) => {$(
        impl Reply for $reply {
            fn shortened(self, _why: &str) -> Self {
                self
            }

            fn refused(_why: &str) -> Option<Self> {
                Some(Self {
                    accepted: false,
                    ..Self::default()
                })
            }
        }
    )*};
}

accepted!(WhatIfSendGoalResponse, SimulateStepsSendGoalResponse);

impl Reply for ListParametersResponse {
    fn shortened(self, _why: &str) -> Self {
        Self {
            result: ListParametersResult {
                names: Vec::new(),
                prefixes: Vec::new(),
            },
        }
    }
}

impl Reply for SetParametersAtomicallyResponse {
    fn shortened(self, why: &str) -> Self {
        Self {
            result: raw::SetParametersResult {
                reason: why.to_owned(),
                ..self.result
            },
        }
    }

    fn refused(why: &str) -> Option<Self> {
        Some(Self {
            result: Err(not_carried_out(why)).into(),
        })
    }
}

impl Reply for SetParametersResponse {
    fn shortened(mut self, why: &str) -> Self {
        if self.results.len() > MOST_RESULTS {
            let failed = Err(format!("{why}; /parameter_events has the values that were set"));
            self.results = vec![failed.into()];
        }
        let share = REASONS / self.results.len().max(1);
        for result in &mut self.results {
            cut(&mut result.reason, share);
        }
        self
    }

    fn refused(why: &str) -> Option<Self> {
        Some(Self {
            results: vec![Err(not_carried_out(why)).into()],
        })
    }
}

impl Reply for SetLoggerLevelsResponse {
    fn shortened(mut self, why: &str) -> Self {
        if self.results.len() > MOST_RESULTS {
            self.results = vec![SetLoggerLevelsResult {
                successful: false,
                reason: format!("{why}; ~/get_logger_levels has the levels that were set"),
            }];
        }
        let share = REASONS / self.results.len().max(1);
        for result in &mut self.results {
            cut(&mut result.reason, share);
        }
        self
    }

    fn refused(why: &str) -> Option<Self> {
        Some(Self {
            results: vec![SetLoggerLevelsResult {
                successful: false,
                reason: not_carried_out(why),
            }],
        })
    }
}

impl Reply for GetTypeDescriptionResponse {
    fn shortened(self, why: &str) -> Self {
        Self {
            successful: false,
            failure_reason: why.to_owned(),
            ..Self::default()
        }
    }
}

impl Reply for WhatIfGetResultResponse {
    /// The chances of any alarm remain; the lists are left out.
    fn shortened(mut self, why: &str) -> Self {
        self.result.message = format!("{why}; ask for fewer candidates");
        for answer in &mut self.result.answers {
            (answer.alarms, answer.figures) = (Vec::new(), Vec::new());
        }
        self
    }
}

/// Cuts a text to `most` bytes at most, between characters.
fn cut(text: &mut String, most: usize) {
    let mut end = most.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    text.truncate(end);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dds::plan::MOST_REPLY;
    use flexdrill_messages::to_cdr_body;

    fn set(count: usize, reason: &str) -> SetParametersResponse {
        let result = |index| match index % 2 {
            0 => Ok(()),
            _ => Err(reason.to_owned()),
        };
        SetParametersResponse {
            results: (0..count).map(|index| result(index).into()).collect(),
        }
    }

    #[test]
    fn a_short_reply_keeps_the_outcome() {
        let reason = "\u{e4}".repeat(200);
        let long = set(1500, &reason);
        assert!(to_cdr_body(&long).unwrap().len() > MOST_REPLY);
        let shortened = long.shortened("too long");
        assert!(to_cdr_body(&shortened).unwrap().len() <= MOST_REPLY);
        assert_eq!(shortened.results.len(), 1500);
        for (index, result) in shortened.results.iter().enumerate() {
            assert_eq!(result.successful, index % 2 == 0);
            assert!(reason.starts_with(&result.reason) && result.reason.is_empty() == result.successful);
        }
        let shortened = set(20_000, "").shortened("too long");
        assert_eq!(shortened.results.len(), 1);
        assert!(shortened.results[0].reason.contains("/parameter_events"));
        let done = TriggerResponse {
            success: true,
            message: "x".repeat(MOST_REPLY),
        };
        let shortened = done.shortened("too long");
        assert!(shortened.success && shortened.message == "too long");
    }
}
