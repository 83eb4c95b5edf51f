//! Generated from `msg/` and `crates/flexdrill-messages/external/` by `cargo xtask messages`. Do not edit.

use super::{ActionInfo, ServiceInfo, TypeInfo};

/// Messages of the ROS package `action_msgs`.
pub mod action_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// A goal: its identifier and when it was accepted.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GoalInfo {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub stamp: super::builtin_interfaces::Time,
    }

    impl Message for GoalInfo {
        const PACKAGE: &'static str = "action_msgs";
        const NAME: &'static str = "GoalInfo";
        const ROS_TYPE: &'static str = "action_msgs/msg/GoalInfo";
        const DDS_TYPE: &'static str = "action_msgs::msg::dds_::GoalInfo_";
        const RIHS01: &'static str = "RIHS01_6398fe763154554353930716b225947f93b672f0fb2e49fdd01bb7a7e37933e9";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalInfo.msg"),
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "action_msgs/msg/GoalInfo", "fields": [{"name": "goal_id", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "unique_identifier_msgs/msg/UUID"}}, {"name": "stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}]}"#;
    }

    /// The state of a goal.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GoalStatus {
        pub goal_info: GoalInfo,
        /// One of the above.
        pub status: i8,
    }

    impl GoalStatus {
        pub const STATUS_UNKNOWN: i8 = 0;
        pub const STATUS_ACCEPTED: i8 = 1;
        pub const STATUS_EXECUTING: i8 = 2;
        pub const STATUS_CANCELING: i8 = 3;
        pub const STATUS_SUCCEEDED: i8 = 4;
        pub const STATUS_CANCELED: i8 = 5;
        pub const STATUS_ABORTED: i8 = 6;
    }

    impl Message for GoalStatus {
        const PACKAGE: &'static str = "action_msgs";
        const NAME: &'static str = "GoalStatus";
        const ROS_TYPE: &'static str = "action_msgs/msg/GoalStatus";
        const DDS_TYPE: &'static str = "action_msgs::msg::dds_::GoalStatus_";
        const RIHS01: &'static str = "RIHS01_32f4cfd717735d17657e1178f24431c1ce996c878c515230f6c5b3476819dbb9";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalStatus.msg"),
            "================================================================================\nMSG: action_msgs/GoalInfo\n",
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalInfo.msg"),
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "action_msgs/msg/GoalStatus", "fields": [{"name": "goal_info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "action_msgs/msg/GoalInfo"}}, {"name": "status", "type": {"type_id": 2, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The states of all goals that an action server knows.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GoalStatusArray {
        pub status_list: Vec<GoalStatus>,
    }

    impl Message for GoalStatusArray {
        const PACKAGE: &'static str = "action_msgs";
        const NAME: &'static str = "GoalStatusArray";
        const ROS_TYPE: &'static str = "action_msgs/msg/GoalStatusArray";
        const DDS_TYPE: &'static str = "action_msgs::msg::dds_::GoalStatusArray_";
        const RIHS01: &'static str = "RIHS01_6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalStatusArray.msg"),
            "================================================================================\nMSG: action_msgs/GoalStatus\n",
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalStatus.msg"),
            "================================================================================\nMSG: action_msgs/GoalInfo\n",
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalInfo.msg"),
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "action_msgs/msg/GoalStatusArray", "fields": [{"name": "status_list", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "action_msgs/msg/GoalStatus"}}]}"#;
    }

    /// `action_msgs/srv/CancelGoal_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct CancelGoalRequest {
        /// Which goals: all where both are zero, one where the identifier is given, those accepted before an instant otherwise.
        pub goal_info: GoalInfo,
    }

    impl Message for CancelGoalRequest {
        const PACKAGE: &'static str = "action_msgs";
        const NAME: &'static str = "CancelGoal_Request";
        const ROS_TYPE: &'static str = "action_msgs/srv/CancelGoal_Request";
        const DDS_TYPE: &'static str = "action_msgs::srv::dds_::CancelGoal_Request_";
        const RIHS01: &'static str = "RIHS01_3d3c84653c1f96918086887e1dcb236faec88b81a5b14fd4cf4840065bcdf8af";
        const SCHEMA: &'static str = concat!(
            "# Which goals: all where both are zero, one where the identifier is given, those accepted before an instant otherwise.\nGoalInfo goal_info\n",
            "================================================================================\nMSG: action_msgs/GoalInfo\n",
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalInfo.msg"),
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "action_msgs/srv/CancelGoal_Request", "fields": [{"name": "goal_info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "action_msgs/msg/GoalInfo"}}]}"#;
    }

    /// `action_msgs/srv/CancelGoal_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct CancelGoalResponse {
        pub return_code: i8,
        /// The goals that will be cancelled.
        pub goals_canceling: Vec<GoalInfo>,
    }

    impl CancelGoalResponse {
        pub const ERROR_NONE: i8 = 0;
        pub const ERROR_REJECTED: i8 = 1;
        pub const ERROR_UNKNOWN_GOAL_ID: i8 = 2;
        pub const ERROR_GOAL_TERMINATED: i8 = 3;
    }

    impl Message for CancelGoalResponse {
        const PACKAGE: &'static str = "action_msgs";
        const NAME: &'static str = "CancelGoal_Response";
        const ROS_TYPE: &'static str = "action_msgs/srv/CancelGoal_Response";
        const DDS_TYPE: &'static str = "action_msgs::srv::dds_::CancelGoal_Response_";
        const RIHS01: &'static str = "RIHS01_35e682cf3f510e83c70a82a4aac888496dedee56773bf9d8e5e0aa81f9e1c960";
        const SCHEMA: &'static str = concat!(
            "int8 ERROR_NONE=0\nint8 ERROR_REJECTED=1\nint8 ERROR_UNKNOWN_GOAL_ID=2\nint8 ERROR_GOAL_TERMINATED=3\n\nint8 return_code\n# The goals that will be cancelled.\nGoalInfo[] goals_canceling\n",
            "================================================================================\nMSG: action_msgs/GoalInfo\n",
            include_str!("../../../crates/flexdrill-messages/external/action_msgs/msg/GoalInfo.msg"),
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "action_msgs/srv/CancelGoal_Response", "fields": [{"name": "return_code", "type": {"type_id": 2, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "goals_canceling", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "action_msgs/msg/GoalInfo"}}]}"#;
    }
}

/// Messages of the ROS package `builtin_interfaces`.
pub mod builtin_interfaces {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `builtin_interfaces/msg/Duration`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Duration {
        pub sec: i32,
        pub nanosec: u32,
    }

    impl Message for Duration {
        const PACKAGE: &'static str = "builtin_interfaces";
        const NAME: &'static str = "Duration";
        const ROS_TYPE: &'static str = "builtin_interfaces/msg/Duration";
        const DDS_TYPE: &'static str = "builtin_interfaces::msg::dds_::Duration_";
        const RIHS01: &'static str = "RIHS01_e8d009f659816f758b75334ee1a9ca5b5c0b859843261f14c7f937349599d93b";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Duration.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "builtin_interfaces/msg/Duration", "fields": [{"name": "sec", "type": {"type_id": 6, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "nanosec", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `builtin_interfaces/msg/Time`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Time {
        pub sec: i32,
        pub nanosec: u32,
    }

    impl Message for Time {
        const PACKAGE: &'static str = "builtin_interfaces";
        const NAME: &'static str = "Time";
        const ROS_TYPE: &'static str = "builtin_interfaces/msg/Time";
        const DDS_TYPE: &'static str = "builtin_interfaces::msg::dds_::Time_";
        const RIHS01: &'static str = "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "builtin_interfaces/msg/Time", "fields": [{"name": "sec", "type": {"type_id": 6, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "nanosec", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `diagnostic_msgs`.
pub mod diagnostic_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `diagnostic_msgs/msg/DiagnosticArray`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct DiagnosticArray {
        pub header: super::std_msgs::Header,
        pub status: Vec<DiagnosticStatus>,
    }

    impl Message for DiagnosticArray {
        const PACKAGE: &'static str = "diagnostic_msgs";
        const NAME: &'static str = "DiagnosticArray";
        const ROS_TYPE: &'static str = "diagnostic_msgs/msg/DiagnosticArray";
        const DDS_TYPE: &'static str = "diagnostic_msgs::msg::dds_::DiagnosticArray_";
        const RIHS01: &'static str = "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/diagnostic_msgs/msg/DiagnosticArray.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: diagnostic_msgs/DiagnosticStatus\n",
            include_str!("../../../crates/flexdrill-messages/external/diagnostic_msgs/msg/DiagnosticStatus.msg"),
            "================================================================================\nMSG: diagnostic_msgs/KeyValue\n",
            include_str!("../../../crates/flexdrill-messages/external/diagnostic_msgs/msg/KeyValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "diagnostic_msgs/msg/DiagnosticArray", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "status", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "diagnostic_msgs/msg/DiagnosticStatus"}}]}"#;
    }

    /// `diagnostic_msgs/msg/DiagnosticStatus`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct DiagnosticStatus {
        pub level: u8,
        pub name: std::string::String,
        pub message: std::string::String,
        pub hardware_id: std::string::String,
        pub values: Vec<KeyValue>,
    }

    impl DiagnosticStatus {
        pub const OK: u8 = 0;
        pub const WARN: u8 = 1;
        pub const ERROR: u8 = 2;
        pub const STALE: u8 = 3;
    }

    impl Message for DiagnosticStatus {
        const PACKAGE: &'static str = "diagnostic_msgs";
        const NAME: &'static str = "DiagnosticStatus";
        const ROS_TYPE: &'static str = "diagnostic_msgs/msg/DiagnosticStatus";
        const DDS_TYPE: &'static str = "diagnostic_msgs::msg::dds_::DiagnosticStatus_";
        const RIHS01: &'static str = "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/diagnostic_msgs/msg/DiagnosticStatus.msg"),
            "================================================================================\nMSG: diagnostic_msgs/KeyValue\n",
            include_str!("../../../crates/flexdrill-messages/external/diagnostic_msgs/msg/KeyValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "diagnostic_msgs/msg/DiagnosticStatus", "fields": [{"name": "level", "type": {"type_id": 16, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hardware_id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "values", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "diagnostic_msgs/msg/KeyValue"}}]}"#;
    }

    /// `diagnostic_msgs/msg/KeyValue`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct KeyValue {
        pub key: std::string::String,
        pub value: std::string::String,
    }

    impl Message for KeyValue {
        const PACKAGE: &'static str = "diagnostic_msgs";
        const NAME: &'static str = "KeyValue";
        const ROS_TYPE: &'static str = "diagnostic_msgs/msg/KeyValue";
        const DDS_TYPE: &'static str = "diagnostic_msgs::msg::dds_::KeyValue_";
        const RIHS01: &'static str = "RIHS01_d68081eaa540288c5440753baecef0c4e16e81a5f78ad68902ded5100413bb42";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/diagnostic_msgs/msg/KeyValue.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "diagnostic_msgs/msg/KeyValue", "fields": [{"name": "key", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "value", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `flexdrill`.
pub mod flexdrill {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `flexdrill/action/WhatIf_Feedback`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfFeedback {
        /// Members that have ended.
        pub done: u32,
        /// Members that may have to run yet.
        pub remaining: u32,
        /// What they say so far, one per candidate.
        pub answers: Vec<WhatIfAnswer>,
    }

    impl Message for WhatIfFeedback {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_Feedback";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_Feedback";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_Feedback_";
        const RIHS01: &'static str = "RIHS01_68509d5b8c1893bce7007419b20cc93deab87667b5f3172bde6251cd78382d0f";
        const SCHEMA: &'static str = concat!(
            "# Members that have ended.\nuint32 done\n# Members that may have to run yet.\nuint32 remaining\n# What they say so far, one per candidate.\nWhatIfAnswer[] answers\n",
            "================================================================================\nMSG: flexdrill/WhatIfAnswer\n",
            include_str!("../../../msg/WhatIfAnswer.msg"),
            "================================================================================\nMSG: flexdrill/WhatIfCandidate\n",
            include_str!("../../../msg/WhatIfCandidate.msg"),
            "================================================================================\nMSG: flexdrill/AlarmChance\n",
            include_str!("../../../msg/AlarmChance.msg"),
            "================================================================================\nMSG: flexdrill/FigureBand\n",
            include_str!("../../../msg/FigureBand.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_Feedback", "fields": [{"name": "done", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "remaining", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "answers", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/WhatIfAnswer"}}]}"#;
    }

    /// `flexdrill/action/WhatIf_FeedbackMessage`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfFeedbackMessage {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub feedback: WhatIfFeedback,
    }

    impl Message for WhatIfFeedbackMessage {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_FeedbackMessage";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_FeedbackMessage";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_FeedbackMessage_";
        const RIHS01: &'static str = "RIHS01_1cc4fac0fc86f6342ce1a209e4d4cdc3ceafa722682ff4a0873d8fcdeb6c266e";
        const SCHEMA: &'static str = concat!(
            "unique_identifier_msgs/UUID goal_id\nflexdrill/WhatIf_Feedback feedback\n",
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: flexdrill/WhatIf_Feedback\n",
            "# Members that have ended.\nuint32 done\n# Members that may have to run yet.\nuint32 remaining\n# What they say so far, one per candidate.\nWhatIfAnswer[] answers\n",
            "================================================================================\nMSG: flexdrill/WhatIfAnswer\n",
            include_str!("../../../msg/WhatIfAnswer.msg"),
            "================================================================================\nMSG: flexdrill/WhatIfCandidate\n",
            include_str!("../../../msg/WhatIfCandidate.msg"),
            "================================================================================\nMSG: flexdrill/AlarmChance\n",
            include_str!("../../../msg/AlarmChance.msg"),
            "================================================================================\nMSG: flexdrill/FigureBand\n",
            include_str!("../../../msg/FigureBand.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_FeedbackMessage", "fields": [{"name": "goal_id", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "unique_identifier_msgs/msg/UUID"}}, {"name": "feedback", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_Feedback"}}]}"#;
    }

    /// `flexdrill/action/WhatIf_GetResult_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfGetResultRequest {
        pub goal_id: super::unique_identifier_msgs::UUID,
    }

    impl Message for WhatIfGetResultRequest {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_GetResult_Request";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_GetResult_Request";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_GetResult_Request_";
        const RIHS01: &'static str = "RIHS01_2c598a3606b99d25b6df56466b130ce5b081881b2737472c462dfc4746c64146";
        const SCHEMA: &'static str = concat!(
            "unique_identifier_msgs/UUID goal_id\n",
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_GetResult_Request", "fields": [{"name": "goal_id", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "unique_identifier_msgs/msg/UUID"}}]}"#;
    }

    /// `flexdrill/action/WhatIf_GetResult_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfGetResultResponse {
        pub status: i8,
        pub result: WhatIfResult,
    }

    impl Message for WhatIfGetResultResponse {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_GetResult_Response";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_GetResult_Response";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_GetResult_Response_";
        const RIHS01: &'static str = "RIHS01_db83f948412a7aae974cfad9de28a13d16b0307a43305411d1995bb4d03d1e53";
        const SCHEMA: &'static str = concat!(
            "int8 status\nflexdrill/WhatIf_Result result\n",
            "================================================================================\nMSG: flexdrill/WhatIf_Result\n",
            "# The instant of the state that was looked ahead from, on the rig's clock.\nbuiltin_interfaces/Time from_stamp\n# Model step of that state.\nuint64 from_step\n# Whether all members ran that were needed; false after a cancellation.\nbool complete\n# In a sentence: what was found, or why nothing was.\nstring message\n# One per candidate, in the order of the goal.\nWhatIfAnswer[] answers\n",
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: flexdrill/WhatIfAnswer\n",
            include_str!("../../../msg/WhatIfAnswer.msg"),
            "================================================================================\nMSG: flexdrill/WhatIfCandidate\n",
            include_str!("../../../msg/WhatIfCandidate.msg"),
            "================================================================================\nMSG: flexdrill/AlarmChance\n",
            include_str!("../../../msg/AlarmChance.msg"),
            "================================================================================\nMSG: flexdrill/FigureBand\n",
            include_str!("../../../msg/FigureBand.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_GetResult_Response", "fields": [{"name": "status", "type": {"type_id": 2, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_Result"}}]}"#;
    }

    /// Looks ahead from the present state of the twin: many short runs of each candidate, which differ by disturbances too small
    /// to measure. The live run goes on meanwhile.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfGoal {
        /// Speeds and weights to be tried, 1 to 16.
        pub candidates: Vec<WhatIfCandidate>,
        /// Model time that each member is judged over, after the way to the candidate (s), 10 to 600.
        pub horizon: f64,
        /// Members per candidate at most, 1 to 200.
        pub members: u32,
        /// Whether all members run, also where the first ones decide every alarm.
        pub run_all: bool,
        /// Seed of the disturbances. The same goal from the same state gives the same result.
        pub seed: u64,
    }

    impl Message for WhatIfGoal {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_Goal";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_Goal";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_Goal_";
        const RIHS01: &'static str = "RIHS01_d0072da13cbfe2407b455fc60e344d21d09ff1624c40484d996c2d465d5cc1e8";
        const SCHEMA: &'static str = concat!(
            "# Looks ahead from the present state of the twin: many short runs of each candidate, which differ by disturbances too small\n# to measure. The live run goes on meanwhile.\n\n# Speeds and weights to be tried, 1 to 16.\nWhatIfCandidate[] candidates\n# Model time that each member is judged over, after the way to the candidate (s), 10 to 600.\nfloat64 horizon\n# Members per candidate at most, 1 to 200.\nuint32 members\n# Whether all members run, also where the first ones decide every alarm.\nbool run_all\n# Seed of the disturbances. The same goal from the same state gives the same result.\nuint64 seed\n",
            "================================================================================\nMSG: flexdrill/WhatIfCandidate\n",
            include_str!("../../../msg/WhatIfCandidate.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_Goal", "fields": [{"name": "candidates", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/WhatIfCandidate"}}, {"name": "horizon", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "run_all", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "seed", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `flexdrill/action/WhatIf_Result`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfResult {
        /// The instant of the state that was looked ahead from, on the rig's clock.
        pub from_stamp: super::builtin_interfaces::Time,
        /// Model step of that state.
        pub from_step: u64,
        /// Whether all members ran that were needed; false after a cancellation.
        pub complete: bool,
        /// In a sentence: what was found, or why nothing was.
        pub message: std::string::String,
        /// One per candidate, in the order of the goal.
        pub answers: Vec<WhatIfAnswer>,
    }

    impl Message for WhatIfResult {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_Result";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_Result";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_Result_";
        const RIHS01: &'static str = "RIHS01_0e32a9e2bf8b670d697c0b680947fbdd430189ccd560ad2389ea171fe2a850f5";
        const SCHEMA: &'static str = concat!(
            "# The instant of the state that was looked ahead from, on the rig's clock.\nbuiltin_interfaces/Time from_stamp\n# Model step of that state.\nuint64 from_step\n# Whether all members ran that were needed; false after a cancellation.\nbool complete\n# In a sentence: what was found, or why nothing was.\nstring message\n# One per candidate, in the order of the goal.\nWhatIfAnswer[] answers\n",
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: flexdrill/WhatIfAnswer\n",
            include_str!("../../../msg/WhatIfAnswer.msg"),
            "================================================================================\nMSG: flexdrill/WhatIfCandidate\n",
            include_str!("../../../msg/WhatIfCandidate.msg"),
            "================================================================================\nMSG: flexdrill/AlarmChance\n",
            include_str!("../../../msg/AlarmChance.msg"),
            "================================================================================\nMSG: flexdrill/FigureBand\n",
            include_str!("../../../msg/FigureBand.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_Result", "fields": [{"name": "from_stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "from_step", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "complete", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "answers", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/WhatIfAnswer"}}]}"#;
    }

    /// `flexdrill/action/WhatIf_SendGoal_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfSendGoalRequest {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub goal: WhatIfGoal,
    }

    impl Message for WhatIfSendGoalRequest {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_SendGoal_Request";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_SendGoal_Request";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_SendGoal_Request_";
        const RIHS01: &'static str = "RIHS01_0d87129d2d12939bb7ffd275e2e5173d3551698a1e25deffd66b62873d9b7196";
        const SCHEMA: &'static str = concat!(
            "unique_identifier_msgs/UUID goal_id\nflexdrill/WhatIf_Goal goal\n",
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: flexdrill/WhatIf_Goal\n",
            "# Looks ahead from the present state of the twin: many short runs of each candidate, which differ by disturbances too small\n# to measure. The live run goes on meanwhile.\n\n# Speeds and weights to be tried, 1 to 16.\nWhatIfCandidate[] candidates\n# Model time that each member is judged over, after the way to the candidate (s), 10 to 600.\nfloat64 horizon\n# Members per candidate at most, 1 to 200.\nuint32 members\n# Whether all members run, also where the first ones decide every alarm.\nbool run_all\n# Seed of the disturbances. The same goal from the same state gives the same result.\nuint64 seed\n",
            "================================================================================\nMSG: flexdrill/WhatIfCandidate\n",
            include_str!("../../../msg/WhatIfCandidate.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_SendGoal_Request", "fields": [{"name": "goal_id", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "unique_identifier_msgs/msg/UUID"}}, {"name": "goal", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_Goal"}}]}"#;
    }

    /// `flexdrill/action/WhatIf_SendGoal_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfSendGoalResponse {
        pub accepted: bool,
        pub stamp: super::builtin_interfaces::Time,
    }

    impl Message for WhatIfSendGoalResponse {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIf_SendGoal_Response";
        const ROS_TYPE: &'static str = "flexdrill/action/WhatIf_SendGoal_Response";
        const DDS_TYPE: &'static str = "flexdrill::action::dds_::WhatIf_SendGoal_Response_";
        const RIHS01: &'static str = "RIHS01_b37fe453111616af53872e38ffee0abe18f90427da0deb94b9d0eace2fa0b9d9";
        const SCHEMA: &'static str = concat!(
            "bool accepted\nbuiltin_interfaces/Time stamp\n",
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/action/WhatIf_SendGoal_Response", "fields": [{"name": "accepted", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}]}"#;
    }

    /// Fatigue damage and friction work since the start or the last reset, to compare joints, stations and drilling
    /// parameters with each other. No absolute life follows from them. The damages by serial number at the end are parts of a
    /// life.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Ageing {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Model time over which the sums were taken (s).
        pub duration: f64,
        /// Slope m of the Woehler line: a load cycle of range r counts (r / rated_moment)^m.
        pub woehler_slope: f64,
        /// Rated moment of a joint's stop (N m).
        pub rated_moment: f64,
        /// Per joint: measured depth from the kick-off (m).
        pub joint_measured_depth: Vec<f64>,
        /// Inclination of the bore there, 0 is straight down (rad).
        pub joint_inclination: Vec<f64>,
        /// Damage of the joint's stop per hour (1/h).
        pub stop_damage_rate: Vec<f64>,
        /// Damage per hour of the link below the joint by bending at its middle, on its worse side (1/h).
        pub bending_damage_rate: Vec<f64>,
        /// The larger of the two damage rates, divided by that of the joint that ages fastest (0 to 1).
        pub relative_damage: Vec<f64>,
        /// Per station: measured depth from the kick-off (m).
        pub station_measured_depth: Vec<f64>,
        /// Inclination of the bore there (rad).
        pub station_inclination: Vec<f64>,
        /// Work of the friction between pipe and guide pipe (J).
        pub pipe_guide_friction_work: Vec<f64>,
        /// Work of the friction between guide pipe and wall (J).
        pub guide_wall_friction_work: Vec<f64>,
        /// Per joint: serial number. This list and those below are empty unless the run began with a table of lives.
        pub joint_serial_number: Vec<std::string::String>,
        /// Damage of the joint's stop in all its runs: the median. 1 is a life, by which half of such details have a crack.
        pub stop_life_damage: Vec<f64>,
        /// End of its band: 5 % of the scatter of class and stress concentration are below.
        pub stop_life_damage_low: Vec<f64>,
        /// End of its band: 5 % are above.
        pub stop_life_damage_high: Vec<f64>,
        /// Its part from the runs before this one, by the table as it was when this run began: the median.
        pub stop_life_damage_before: Vec<f64>,
        /// The same of the link below the joint, by bending at its middle: the median.
        pub link_life_damage: Vec<f64>,
        /// End of its band: 5 % of the scatter of class and stress concentration are below.
        pub link_life_damage_low: Vec<f64>,
        /// End of its band: 5 % are above.
        pub link_life_damage_high: Vec<f64>,
        /// Its part from the runs before this one, by the table as it was when this run began: the median.
        pub link_life_damage_before: Vec<f64>,
    }

    impl Message for Ageing {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Ageing";
        const ROS_TYPE: &'static str = "flexdrill/msg/Ageing";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Ageing_";
        const RIHS01: &'static str = "RIHS01_ec0bd0abdd01e7f7682b6b9bb109220a4c3fad6025d2d0dedd8f9d74d237ae83";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/Ageing.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Ageing", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "duration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "woehler_slope", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rated_moment", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "joint_measured_depth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "joint_inclination", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stop_damage_rate", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bending_damage_rate", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "relative_damage", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "station_measured_depth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "station_inclination", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_friction_work", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_friction_work", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "joint_serial_number", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stop_life_damage", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stop_life_damage_low", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stop_life_damage_high", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stop_life_damage_before", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "link_life_damage", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "link_life_damage_low", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "link_life_damage_high", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "link_life_damage_before", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The state of one alarm: one condition that an operator can act on. docs/alarms.md explains each alarm.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Alarm {
        /// Identifier for programs and requests, such as backward_whirl.
        pub id: std::string::String,
        /// Name for displays.
        pub name: std::string::String,
        /// NORMAL, ACTIVE_UNACKNOWLEDGED, ACTIVE_ACKNOWLEDGED, RETURNED_UNACKNOWLEDGED, SHELVED, SUPPRESSED_BY_DESIGN or
        /// OUT_OF_SERVICE.
        pub state: u8,
        /// Priority of the condition, or of the alarm to be acknowledged, whichever is higher: NO_PRIORITY, LOW, MEDIUM or HIGH.
        pub priority: u8,
        /// The condition stands, also while the alarm is shelved.
        pub active: bool,
        /// No acknowledgement is needed.
        pub acknowledged: bool,
        /// When this state began, on the rig's clock; zero before the first change.
        pub since: super::builtin_interfaces::Time,
        /// When shelving ends at the latest, on the rig's clock; zero while not shelved.
        pub shelved_until: super::builtin_interfaces::Time,
        /// Shelving ends when the condition ends.
        pub shelved_one_shot: bool,
        /// Body with the worst value, see worst_at: NOWHERE, PIPE or GUIDE.
        pub body: u8,
        /// Measured depth from the kick-off (m), NaN where there is none.
        pub measured_depth: f64,
        /// Inclination of the bore there, 0 is straight down (rad), NaN where there is none.
        pub inclination: f64,
        /// The value that is judged, in unit; NaN where there is no such number.
        pub value: f64,
        /// The threshold that value is compared with, in unit; NaN where there is no such number.
        pub threshold: f64,
        /// Unit of value and threshold; empty where they have none.
        pub unit: std::string::String,
        /// How far the evidence can be trusted (0 to 1).
        pub confidence: f64,
        /// What happened at worst_at, in a sentence; it says when the condition has ended. This text and the next three are empty
        /// while the alarm is normal.
        pub evidence: std::string::String,
        /// Why it happens.
        pub cause: std::string::String,
        /// Why it matters: the consequence without action.
        pub consequence: std::string::String,
        /// What the driller can do: weight on bit, rotary speed, pick up, call the engineer. It never contradicts the other
        /// alarms in the list.
        pub what_to_do: std::string::String,
        /// Number of annunciations since the count began; a restart continues the count.
        pub annunciations: u64,
        /// Number of annunciations in the last minute; from three on the alarm chatters.
        pub annunciations_last_minute: u32,
        /// Addressee of the alarm: DRILLING or SYSTEM. Show SYSTEM alarms separately from the driller's.
        pub category: u8,
        /// The present state began in an earlier run of the node; since is a time of that run.
        pub from_earlier_run: bool,
        /// What the engineer can do: settings of the model and the machine, measurements, inspection.
        pub what_the_engineer_can_do: std::string::String,
        /// Time of location, value, confidence and evidence, on the rig's clock: the worst moment since the priority was reached.
        /// Zero while the alarm is normal.
        pub worst_at: super::builtin_interfaces::Time,
        /// The condition has ended: the alarm is held in case it returns, or waits to be acknowledged.
        pub ended: bool,
        /// When the condition was last met, on the rig's clock; zero unless ended.
        pub ended_at: super::builtin_interfaces::Time,
        /// When the condition last reached the priority of the alarm, on the rig's clock: it stands since then at a lower one.
        /// Zero while it stands at the alarm's priority, and once it has ended.
        pub less_severe_since: super::builtin_interfaces::Time,
        /// Number of times that the condition has come since the alarm was normal or the node began: 1 for a condition that stands
        /// without a pause, more for an intermittent one. Zero while the alarm is normal.
        pub episodes: u32,
        /// Id of the alarm whose action comes first: what_to_do refers to it. Empty for an alarm with an action of its own.
        pub follows: std::string::String,
    }

    impl Alarm {
        /// No action is needed.
        pub const NORMAL: u8 = 0;
        /// The condition stands and is not yet acknowledged.
        pub const ACTIVE_UNACKNOWLEDGED: u8 = 1;
        /// The condition stands and is acknowledged.
        pub const ACTIVE_ACKNOWLEDGED: u8 = 2;
        /// The condition has ended and is not yet acknowledged.
        pub const RETURNED_UNACKNOWLEDGED: u8 = 3;
        /// An operator has put it aside for a time.
        pub const SHELVED: u8 = 4;
        /// The condition has no meaning at present: the drive stands or runs up, the model is paused, or the first sample of an
        /// input is awaited.
        pub const SUPPRESSED_BY_DESIGN: u8 = 5;
        /// Switched off by the configuration.
        pub const OUT_OF_SERVICE: u8 = 6;
        /// No priority: no action is needed.
        pub const NO_PRIORITY: u8 = 0;
        /// Act when there is time.
        pub const LOW: u8 = 1;
        /// Act soon.
        pub const MEDIUM: u8 = 2;
        /// Act at once.
        pub const HIGH: u8 = 3;
        /// The alarm concerns drilling and is for the driller.
        pub const DRILLING: u8 = 0;
        /// The alarm concerns the twin's computer, disk or network and is for its administrator.
        pub const SYSTEM: u8 = 1;
        /// The alarm has no location along the tool, or none at present.
        pub const NOWHERE: u8 = 0;
        /// The flexible pipe.
        pub const PIPE: u8 = 1;
        /// The guide pipe.
        pub const GUIDE: u8 = 2;
    }

    impl Message for Alarm {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Alarm";
        const ROS_TYPE: &'static str = "flexdrill/msg/Alarm";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Alarm_";
        const RIHS01: &'static str = "RIHS01_7df940a0b40e8c3b66b7409ee691c3ab26ce023a74fca0f5c4b1c2e637338db0";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/Alarm.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Alarm", "fields": [{"name": "id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "state", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "priority", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "active", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "acknowledged", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "since", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "shelved_until", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "shelved_one_shot", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "body", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "value", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "threshold", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "unit", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "confidence", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "evidence", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "cause", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "consequence", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "what_to_do", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "annunciations", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "annunciations_last_minute", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "category", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "from_earlier_run", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "what_the_engineer_can_do", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "worst_at", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "ended", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "ended_at", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "less_severe_since", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "episodes", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "follows", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// How many members of a look-ahead saw an alarm: raised after the first 5 s of the horizon, or standing in its second half.
    /// On twin/bands: in how many plausible tools it stands.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct AlarmChance {
        /// Id of the alarm, such as backward_whirl.
        pub id: std::string::String,
        /// Its name for people.
        pub name: std::string::String,
        /// Of this priority or a higher one: Alarm.LOW, MEDIUM or HIGH.
        pub priority: u8,
        /// Members that saw it.
        pub seen: u32,
        /// Members that ended.
        pub members: u32,
        /// Share of the members, on twin/bands by their weights; NaN where none ended.
        pub probability: f64,
        /// The 95 % interval of the probability (Wilson).
        pub lower: f64,
        pub upper: f64,
        /// Median of the time from the beginning of the horizon until the alarm counts (s), over the members that saw it. On
        /// twin/bands: since it stands.
        pub time_to_first: f64,
    }

    impl Message for AlarmChance {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "AlarmChance";
        const ROS_TYPE: &'static str = "flexdrill/msg/AlarmChance";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::AlarmChance_";
        const RIHS01: &'static str = "RIHS01_b09881a359085a3ee2125e592e203f926e9891e2cb86e051c7a67408e9bf44fd";
        const SCHEMA: &'static str = include_str!("../../../msg/AlarmChance.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/AlarmChance", "fields": [{"name": "id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "priority", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "seen", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "probability", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lower", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "upper", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "time_to_first", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// One change of one alarm: an entry of the journal. Alarm defines the states and priorities.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct AlarmEvent {
        /// Stamp: time of the change, on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Number of the event, one more in every event, also across restarts.
        pub sequence: u64,
        /// Id of the alarm, as in Alarm.
        pub id: std::string::String,
        /// Name for displays.
        pub name: std::string::String,
        /// ACTIVATED, RAISED, LOWERED, RETURNED, ACKNOWLEDGED, SHELVED, UNSHELVED, SUPPRESSED, RELEASED, TAKEN_OUT, PUT_BACK or
        /// ADJUSTED.
        pub change: u8,
        /// State before the change, as in Alarm.
        pub from_state: u8,
        /// State after the change.
        pub to_state: u8,
        /// The present priority of the condition; when it has ended, its last priority or the one to be acknowledged. As in
        /// Alarm.
        pub priority: u8,
        /// The event is an annunciation. A rise of an alarm that is not yet acknowledged is none.
        pub annunciates: bool,
        /// Operator or client who requested it; empty if it was not requested.
        pub operator_name: std::string::String,
        /// Reason; for UNSHELVED without a request, why the shelving ended.
        pub reason: std::string::String,
        /// When shelving ends at the latest, for SHELVED.
        pub shelved_until: super::builtin_interfaces::Time,
        /// What happens, in a sentence; empty where the condition is absent.
        pub evidence: std::string::String,
        /// What the driller can do, as in Alarm; empty where no action is needed.
        pub what_to_do: std::string::String,
        /// Body with the worst value, as in Alarm: NOWHERE, PIPE or GUIDE.
        pub body: u8,
        /// Measured depth from the kick-off (m), NaN where there is none.
        pub measured_depth: f64,
        /// Inclination of the bore there (rad), NaN where there is none.
        pub inclination: f64,
        /// The value that was judged, NaN where there is no such number.
        pub value: f64,
        /// Addressee of the alarm, as in Alarm: DRILLING or SYSTEM.
        pub category: u8,
        /// What the engineer can do, as in Alarm.
        pub what_the_engineer_can_do: std::string::String,
        /// Time of location, value and evidence, as in Alarm.
        pub worst_at: super::builtin_interfaces::Time,
        /// When the condition ended, as in Alarm: earlier than the stamp of RETURNED by the time for which the alarm was held.
        /// Zero while the condition is met.
        pub ended_at: super::builtin_interfaces::Time,
        /// When the condition last reached the priority of the alarm, as in Alarm: earlier than the stamp of LOWERED by the time
        /// for which the priority was held.
        pub less_severe_since: super::builtin_interfaces::Time,
        /// Number of times that the condition has come, as in Alarm.
        pub episodes: u32,
        /// Id of the alarm whose action comes first, as in Alarm.
        pub follows: std::string::String,
    }

    impl AlarmEvent {
        /// The condition has stood for its on-delay.
        pub const ACTIVATED: u8 = 0;
        /// Its priority has risen.
        pub const RAISED: u8 = 1;
        /// Its priority has fallen, but it stands.
        pub const LOWERED: u8 = 2;
        /// The condition has been absent for its off-delay.
        pub const RETURNED: u8 = 3;
        /// An operator has acknowledged it.
        pub const ACKNOWLEDGED: u8 = 4;
        /// An operator has shelved it.
        pub const SHELVED: u8 = 5;
        /// Its shelving has ended: by a request, after its time, with its condition, or by a rise to HIGH.
        pub const UNSHELVED: u8 = 6;
        /// The condition has no meaning from now on; SUPPRESSED_BY_DESIGN in Alarm gives the cases.
        pub const SUPPRESSED: u8 = 7;
        /// The condition has a meaning again.
        pub const RELEASED: u8 = 8;
        /// The configuration takes it out of service.
        pub const TAKEN_OUT: u8 = 9;
        /// The configuration returns it to service.
        pub const PUT_BACK: u8 = 10;
        /// What the alarm is judged against was adjusted, by calibration.follow or by a client, which operator_name names; the
        /// reason says how. The state stays.
        pub const ADJUSTED: u8 = 11;
    }

    impl Message for AlarmEvent {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "AlarmEvent";
        const ROS_TYPE: &'static str = "flexdrill/msg/AlarmEvent";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::AlarmEvent_";
        const RIHS01: &'static str = "RIHS01_7cf9b88fdab8c3d3c51b3cc468fcd668c48577e11ebf4282aab0d1ec99196035";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/AlarmEvent.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/AlarmEvent", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "sequence", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "change", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "from_state", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "to_state", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "priority", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "annunciates", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "operator_name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "reason", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "shelved_until", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "evidence", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "what_to_do", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "body", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "value", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "category", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "what_the_engineer_can_do", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "worst_at", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "ended_at", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "less_severe_since", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "episodes", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "follows", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// All alarms, the worst first, sent when one of them changes and every second. Latched: of several received messages,
    /// the one with the highest sequence is valid, and of those with the same sequence the newest.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct AlarmList {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Number of events so far, across restarts: the sequence of the newest AlarmEvent.
        pub sequence: u64,
        /// All alarms, including normal ones, in this order: active ones whose condition stands, active ones whose condition has
        /// ended, returned, shelved, suppressed, normal, out of service. Within each group the driller's before those of the
        /// computer, those with an action of their own before those that follow another alarm's, then by priority, and the
        /// unacknowledged before the acknowledged. So the first one stands if any stands, and its what_to_do is an action.
        pub alarms: Vec<Alarm>,
        /// Number of alarms to be acknowledged.
        pub unacknowledged: u32,
        /// Number of annunciations in the last ten minutes.
        pub annunciations_last_ten_minutes: u32,
        /// There were more than ten annunciations in the last ten minutes.
        pub flood: bool,
        /// Mean number of annunciations per hour since the count began; a restart continues the count. NaN before one full hour.
        pub annunciations_per_hour: f64,
        /// Share of the time in flood (0 to 1); NaN before ten full minutes.
        pub flood_share: f64,
    }

    impl Message for AlarmList {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "AlarmList";
        const ROS_TYPE: &'static str = "flexdrill/msg/AlarmList";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::AlarmList_";
        const RIHS01: &'static str = "RIHS01_7d5d373a7cdc7100369b8160b6a9fc58ca7423f860d4a5c53a4c9a2c4580265a";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/AlarmList.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: flexdrill/Alarm\n",
            include_str!("../../../msg/Alarm.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/AlarmList", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "sequence", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "alarms", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/Alarm"}}, {"name": "unacknowledged", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "annunciations_last_ten_minutes", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "flood", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "annunciations_per_hour", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "flood_share", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The values that drive the model from a step on, sent when one of them changes. The sequence of these messages and the
    /// configuration determine a run bit for bit. Without a change the message is repeated every second of model time, with
    /// reset false and with all parameters changed since the start, for clients that join or record later.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct AppliedInputs {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Number of model steps before these values act: they act on the next step.
        pub step: u64,
        /// Steps skipped so far because the model was late.
        pub skipped_steps: u64,
        /// The model was reset to its state after the start before this step; step counts from 0 again.
        pub reset: bool,
        /// Target speed of the drive, before the slew limit (rad/s).
        pub rotary_speed: f64,
        /// Target weight on bit, before the slew limit (N).
        pub weight_on_bit: f64,
        /// The worst state of the inputs that the tool uses: INPUT_NOT_RECEIVED, INPUT_OK, INPUT_SLOW, INPUT_STALE or
        /// INPUT_REJECTED. An optional input of which no sample has arrived does not count.
        pub input_quality: u8,
        /// Slew limit of the rotary speed (rad/s2).
        pub rotary_speed_slew: f64,
        /// Slew limit of the weight on bit (N/s).
        pub weight_on_bit_slew: f64,
        /// Coulomb coefficients between pipe and guide pipe: around the circumference, along the axis.
        pub inner_friction: [f64; 2],
        /// Coulomb coefficients between guide pipe and wall: around the circumference, along the axis.
        pub outer_friction: [f64; 2],
        /// Friction factor between bit and rock.
        pub bit_friction_factor: f64,
        /// Other numeric parameters that were changed at this step, by their ROS name.
        pub parameter_name: Vec<std::string::String>,
        /// Their new values, in the parameter's unit.
        pub parameter_value: Vec<f64>,
        /// Client that requested them: the service and its client, as node @ host (id of its DDS writer).
        pub parameter_asked_by: Vec<std::string::String>,
        /// Every model step is solved in 2^refinement equal parts: as many as the motion requires and the pace allows.
        pub refinement: u8,
        /// Target rate of penetration, before the slew limit (m/s); negative while the tool is pulled back.
        pub rate_of_penetration: f64,
        /// Target standpipe pressure, inside minus outside, before the slew limit (Pa).
        pub standpipe_pressure: f64,
        /// Slew limit of the rate of penetration (m/s2).
        pub rate_of_penetration_slew: f64,
        /// Slew limit of the standpipe pressure (Pa/s).
        pub standpipe_pressure_slew: f64,
    }

    impl AppliedInputs {
        /// No sample has arrived yet: the twin runs on its configured start values.
        pub const INPUT_NOT_RECEIVED: u8 = 0;
        /// The newest sample is fresh.
        pub const INPUT_OK: u8 = 1;
        /// The newest sample is later than expected, but not yet stale.
        pub const INPUT_SLOW: u8 = 2;
        /// The newest sample is too old: the value is held, then brought to the safe value.
        pub const INPUT_STALE: u8 = 3;
        /// The newest sample was refused; the last good value is held.
        pub const INPUT_REJECTED: u8 = 4;
        /// An optional input of which no sample has arrived: the twin runs on its configured constant.
        pub const INPUT_ASSUMED: u8 = 5;
    }

    impl Message for AppliedInputs {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "AppliedInputs";
        const ROS_TYPE: &'static str = "flexdrill/msg/AppliedInputs";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::AppliedInputs_";
        const RIHS01: &'static str = "RIHS01_34b14ec2983cc54e4f27e00fa9e2b35e00a1b7ebe8aae8126996f58894e5fd76";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/AppliedInputs.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/AppliedInputs", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "step", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "skipped_steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "reset", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rotary_speed", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_quality", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rotary_speed_slew", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit_slew", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inner_friction", "type": {"type_id": 59, "capacity": 2, "string_capacity": 0, "nested_type_name": ""}}, {"name": "outer_friction", "type": {"type_id": 59, "capacity": 2, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_friction_factor", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "parameter_name", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "parameter_value", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "parameter_asked_by", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "refinement", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rate_of_penetration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "standpipe_pressure", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rate_of_penetration_slew", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "standpipe_pressure_slew", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// What plausible tools do under the inputs of the twin, once per second of model time: bands of its figures, and the share of
    /// the tools in which each alarm stands.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Bands {
        /// Stamp: the instant of the figures, on the rig's clock. The message comes once every member has been computed up to it, a
        /// second or more later. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Instant at which these members began.
        pub begun: super::builtin_interfaces::Time,
        /// Members: tools that were drawn from what is known of the tool and its rig.
        pub members: u32,
        /// Members that could not be computed. What they do is unknown, not safe: they are in no band and no chance, and are replaced
        /// within two minutes.
        pub failed: u32,
        /// Members that are prepared to replace others, and count for nothing yet.
        pub prepared: u32,
        /// Number of members alike that those amount to by their weights, which what the rig measures gives them; without
        /// measurements all that were computed. Bands need 8.
        pub effective: f64,
        /// How often members of little weight gave way to others near those of much weight.
        pub renewals: u32,
        /// Why there are no bands; empty where there are.
        pub no_bands: std::string::String,
        /// The figures: those of twin/bit_state, twin/joint_deflections, twin/contact_forces and twin/transfer that a table or a
        /// bridge shows, over the last second. With fewer than 19 members the ends lie beyond the outermost, as of a normal distribution.
        pub bands: Vec<FigureBand>,
        /// Measured depth of the stations of the two profiles below (m).
        pub measured_depth: Vec<f64>,
        /// Largest normal force of pipe and guide within the last second at each station (N): quantiles over plausible tools at 5, 50
        /// and 95 %. Empty without bands.
        pub pipe_guide_force_p5: Vec<f64>,
        pub pipe_guide_force_p50: Vec<f64>,
        pub pipe_guide_force_p95: Vec<f64>,
        /// The same of guide and wall (N).
        pub guide_wall_force_p5: Vec<f64>,
        pub guide_wall_force_p50: Vec<f64>,
        pub guide_wall_force_p95: Vec<f64>,
        /// Alarms that stand in a plausible tool, with each priority: the share of the tools by their weights.
        pub alarms: Vec<AlarmChance>,
        /// Share of the plausible tools in which any alarm of the tool stands, with its 95 % interval (Wilson); NaN where no member
        /// was computed.
        pub any_alarm: f64,
        pub any_alarm_lower: f64,
        pub any_alarm_upper: f64,
        /// Sensors of the rig that the plausible tools are not weighed by, as in `uncertainty.sensors` (surface_torque, hook_load); empty
        /// where all are believed. The alarms of the twin do not depend on it.
        pub distrusted: Vec<std::string::String>,
        /// Why, in words, for each of them.
        pub distrusted_why: Vec<std::string::String>,
        /// Factors by which the bands of `bands` are wider than those of the members (ensemble.band_factors), in their order: 1 where none
        /// is stated; empty without bands. The profiles have those of the largest force of their layer.
        pub band_factors: Vec<f64>,
    }

    impl Message for Bands {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Bands";
        const ROS_TYPE: &'static str = "flexdrill/msg/Bands";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Bands_";
        const RIHS01: &'static str = "RIHS01_31701ffa948dc14f36781abb6b11c054b59b15980753bdb041e40ae92f31bd8d";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/Bands.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: flexdrill/FigureBand\n",
            include_str!("../../../msg/FigureBand.msg"),
            "================================================================================\nMSG: flexdrill/AlarmChance\n",
            include_str!("../../../msg/AlarmChance.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Bands", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "begun", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failed", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "prepared", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "effective", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "renewals", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "no_bands", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bands", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/FigureBand"}}, {"name": "measured_depth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_force_p5", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_force_p50", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_force_p95", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_force_p5", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_force_p50", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_force_p95", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "alarms", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/AlarmChance"}}, {"name": "any_alarm", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "any_alarm_lower", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "any_alarm_upper", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "distrusted", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "distrusted_why", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "band_factors", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The bit. Torque, speed, weight and accelerations cover the time since the previous message, in which every step counts:
    /// an instant would alias with the rotation. Only the first message of a run has torque, speed and weight of its instant.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct BitState {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Torque of the rock against the bit, mean (N m): positive where it opposes forward rotation, negative in
        /// reverse, 0 off bottom.
        pub torque: f64,
        /// Rotary speed of the bit, mean (rad/s, negative in reverse).
        pub rotary_speed: f64,
        /// Weight on the bit, mean (N): given, or what the rock carries; 0 off bottom.
        pub weight_on_bit: f64,
        /// (max - min) / (2 mean) of the rotary speed over its window; 0 while the drive is near standstill, at least 1 while the
        /// bit stands and the drive turns.
        pub stick_slip_index: f64,
        /// Root mean square over the publishing interval of spin acceleration times bit radius (m/s2).
        pub tangential_acceleration: f64,
        /// Root mean square over the publishing interval of the axial acceleration (m/s2).
        pub axial_acceleration: f64,
        /// Root mean square over the publishing interval of the lateral acceleration one station above the bit (m/s2).
        pub lateral_acceleration: f64,
        /// Largest lateral acceleration one station above the bit in the publishing interval (m/s2).
        pub lateral_acceleration_peak: f64,
        /// Integral of the size of the lateral acceleration one station above the bit over the publishing interval (m/s).
        pub lateral_impulse: f64,
        /// Level that the stick-slip index has reached: OK, WATCH, WARNING or CRITICAL.
        pub stick_slip_severity: u8,
    }

    impl BitState {
        /// No action is needed.
        pub const OK: u8 = 0;
        /// The driller should watch it.
        pub const WATCH: u8 = 1;
        /// Action is needed soon.
        pub const WARNING: u8 = 2;
        /// Action is needed now.
        pub const CRITICAL: u8 = 3;
    }

    impl Message for BitState {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "BitState";
        const ROS_TYPE: &'static str = "flexdrill/msg/BitState";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::BitState_";
        const RIHS01: &'static str = "RIHS01_689e5e56898732a1224f82b9c4b2e861660c3263671dbebf76d104ecca570b25";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/BitState.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/BitState", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rotary_speed", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stick_slip_index", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "tangential_acceleration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "axial_acceleration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateral_acceleration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateral_acceleration_peak", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateral_impulse", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stick_slip_severity", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Contact between pipe and guide pipe and between guide pipe and bore wall. All arrays have one entry per station, top
    /// to bottom. Collisions are shorter than the publishing interval: see the peak and rms arrays.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ContactForces {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Largest normal force between pipe and guide pipe in the publishing interval (N).
        pub max_pipe_guide_force: f64,
        /// Entry of its station in the arrays below.
        pub max_pipe_guide_station: u32,
        /// Largest normal force between guide pipe and wall in the publishing interval (N).
        pub max_guide_wall_force: f64,
        /// Entry of its station in the arrays below.
        pub max_guide_wall_station: u32,
        /// Measured depth from the kick-off (m).
        pub measured_depth: Vec<f64>,
        /// Inclination of the bore there, 0 is straight down (rad).
        pub inclination: Vec<f64>,
        /// FREE, INNER, OUTER or BOTH at the stamp.
        pub state: Vec<u8>,
        /// Gap between pipe and guide pipe (m, negative is penetration).
        pub pipe_guide_gap: Vec<f64>,
        /// Normal force at the stamp (N, \>= 0).
        pub pipe_guide_normal: Vec<f64>,
        /// Friction around the circumference on the pipe (N, positive in the drive's sense).
        pub pipe_guide_tangential: Vec<f64>,
        /// Friction along the axis on the pipe (N, positive downhole).
        pub pipe_guide_axial: Vec<f64>,
        /// Largest normal force in the publishing interval (N).
        pub pipe_guide_normal_peak: Vec<f64>,
        /// Root mean square of the normal force over the publishing interval (N).
        pub pipe_guide_normal_rms: Vec<f64>,
        /// Gap between guide pipe and wall (m, negative is penetration).
        pub guide_wall_gap: Vec<f64>,
        /// Normal force at the stamp (N, \>= 0).
        pub guide_wall_normal: Vec<f64>,
        /// Friction around the circumference on the guide pipe (N, positive in the drive's sense).
        pub guide_wall_tangential: Vec<f64>,
        /// Friction along the axis on the guide pipe (N, positive downhole).
        pub guide_wall_axial: Vec<f64>,
        /// Largest normal force in the publishing interval (N).
        pub guide_wall_normal_peak: Vec<f64>,
        /// Root mean square of the normal force over the publishing interval (N).
        pub guide_wall_normal_rms: Vec<f64>,
        /// Shock: largest impulse of the normal force in a short interval (20 ms by default) in the publishing interval, minus
        /// that of the resting force (N s).
        pub pipe_guide_shock: Vec<f64>,
        /// The same between guide pipe and wall (N s).
        pub guide_wall_shock: Vec<f64>,
        /// Level of shock of the tool: SHOCK_OK, SHOCK_WATCH, SHOCK_WARNING or SHOCK_CRITICAL.
        pub shock_severity: u8,
        /// Largest shock since that level was reached (N s).
        pub shock_impulse: f64,
        /// Entry of its station in the arrays.
        pub shock_station: u32,
        /// Its layer: INNER or OUTER.
        pub shock_layer: u8,
    }

    impl ContactForces {
        /// No contact at this station.
        pub const FREE: u8 = 0;
        /// Pipe and guide pipe are in contact.
        pub const INNER: u8 = 1;
        /// Guide pipe and wall are in contact.
        pub const OUTER: u8 = 2;
        /// Both layers are in contact.
        pub const BOTH: u8 = 3;
        /// No action is needed.
        pub const SHOCK_OK: u8 = 0;
        /// The driller should watch it.
        pub const SHOCK_WATCH: u8 = 1;
        /// Action is needed soon.
        pub const SHOCK_WARNING: u8 = 2;
        /// Action is needed now.
        pub const SHOCK_CRITICAL: u8 = 3;
    }

    impl Message for ContactForces {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "ContactForces";
        const ROS_TYPE: &'static str = "flexdrill/msg/ContactForces";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::ContactForces_";
        const RIHS01: &'static str = "RIHS01_e57eb3ac0cfce2e19834ef628c2c524459b4322030fac85664ff561df40ee3bc";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/ContactForces.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/ContactForces", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "max_pipe_guide_force", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "max_pipe_guide_station", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "max_guide_wall_force", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "max_guide_wall_station", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "state", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_gap", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_normal", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_tangential", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_axial", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_normal_peak", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_normal_rms", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_gap", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_normal", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_tangential", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_axial", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_normal_peak", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_normal_rms", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_shock", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_shock", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "shock_severity", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "shock_impulse", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "shock_station", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "shock_layer", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// A figure over the members of a look-ahead, or over plausible tools.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct FigureBand {
        /// Of a look-ahead: bit_speed_ripple, pipe_guide_force, guide_wall_force, stop_moment, bending_cycles, damage,
        /// torque_transfer or weight_transfer. Of twin/bands: topic and field, such as transfer/bit_torque.
        pub name: std::string::String,
        /// Unit; empty for a ratio.
        pub unit: std::string::String,
        /// Quantiles over the members at 5, 50 and 95 %; NaN where no member has the figure.
        pub p5: f64,
        pub p50: f64,
        pub p95: f64,
    }

    impl Message for FigureBand {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "FigureBand";
        const ROS_TYPE: &'static str = "flexdrill/msg/FigureBand";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::FigureBand_";
        const RIHS01: &'static str = "RIHS01_232c55beb50dfd1e690034962b6e3d73f6ddc61f6279b58c7e40069dc1c747dd";
        const SCHEMA: &'static str = include_str!("../../../msg/FigureBand.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/FigureBand", "fields": [{"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "unit", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "p5", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "p50", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "p95", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The next minute at the present speed and weight, from runs that begin at the present state.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Forecast {
        /// Stamp: the instant of the state that the runs begin from, on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Model step of that state.
        pub from_step: u64,
        /// Rotary speed that is asked for during the forecast (rad/s).
        pub rotary_speed: f64,
        /// Weight on bit that is asked for during the forecast (N).
        pub weight_on_bit: f64,
        /// Start of the first second of the bands: the first whole second of model time after the state, on the rig's clock.
        pub bands_from: super::builtin_interfaces::Time,
        /// Time between two values of the bands (s).
        pub interval: f64,
        /// Members whose motion could be computed to the end.
        pub members: u32,
        /// Members that failed. They are in no band and no probability: what would have come is unknown, not safe.
        pub failed: u32,
        /// Why the first of these failed, or why there is no forecast; empty where none failed.
        pub failure: std::string::String,
        /// One per figure.
        pub bands: Vec<ForecastBand>,
        /// The alarms that a member saw, with each priority.
        pub alarms: Vec<AlarmChance>,
        /// Chance that a member saw any alarm, with its 95 % interval (Wilson); NaN where no member ended.
        pub any_alarm: f64,
        pub any_alarm_lower: f64,
        pub any_alarm_upper: f64,
        /// Plausible tools that the members, those that failed included, are runs of, each from its own state; 0 where they are runs of
        /// the twin.
        pub tools: u32,
    }

    impl Message for Forecast {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Forecast";
        const ROS_TYPE: &'static str = "flexdrill/msg/Forecast";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Forecast_";
        const RIHS01: &'static str = "RIHS01_83b6cf767febf9da436c3d22188ec703ed632391f72a544715a0dc6a00bc124a";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/Forecast.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: flexdrill/ForecastBand\n",
            include_str!("../../../msg/ForecastBand.msg"),
            "================================================================================\nMSG: flexdrill/AlarmChance\n",
            include_str!("../../../msg/AlarmChance.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Forecast", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "from_step", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rotary_speed", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bands_from", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "interval", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failed", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failure", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bands", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/ForecastBand"}}, {"name": "alarms", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/AlarmChance"}}, {"name": "any_alarm", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "any_alarm_lower", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "any_alarm_upper", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "tools", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// One figure of a forecast, second by second.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ForecastBand {
        /// bit_speed, bit_torque, weight_on_bit, pipe_guide_force or guide_wall_force. Speed, torque and weight are means over
        /// each second, forces the largest of each second at any station.
        pub name: std::string::String,
        /// Unit: rad/s, N m or N.
        pub unit: std::string::String,
        /// The 90 % band and the median, one value per second of the horizon; NaN where no member ended. The band has been widened
        /// or narrowed to the share of earlier seconds that it is to hold (see width), and is never narrower than the band of
        /// plausible tools at present (twin/bands).
        pub p5: Vec<f64>,
        pub p50: Vec<f64>,
        pub p95: Vec<f64>,
        /// Factor on the band of the members over the first seconds, lead_width\[0\].
        pub width: f64,
        /// Seconds of earlier forecasts of this run that were compared with what came, while speed and weight stayed.
        pub compared: u32,
        /// Seconds among them in which the figure was in the published band.
        pub inside: u32,
        /// Seconds among them in which it was in the band of the members as they were.
        pub inside_members: u32,
        /// How far ahead seconds are that are calibrated together, counted from the beginning of the bands: the i-th of the lists below
        /// holds for seconds before lead_until\[i\] (s), and from lead_until\[i - 1\] on.
        pub lead_until: Vec<f64>,
        /// Factor on the band of the members. It is the one with which nine of ten of the last seconds that were compared at this
        /// lead would have been in their band; 1 before that is known.
        pub lead_width: Vec<f64>,
        /// Whether it is known: nine forecasts at least were compared with what came at this lead. Where it is false, the band is
        /// that of the members, and not calibrated yet.
        pub lead_calibrated: Vec<bool>,
        /// Seconds that were compared at this lead, and those among them in which the figure was in the published band.
        pub lead_compared: Vec<u32>,
        pub lead_inside: Vec<u32>,
    }

    impl Message for ForecastBand {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "ForecastBand";
        const ROS_TYPE: &'static str = "flexdrill/msg/ForecastBand";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::ForecastBand_";
        const RIHS01: &'static str = "RIHS01_0d68d4f104a7f3e111c012bdfa712bc39cb7fb1084d1ac6df3074563a7b21984";
        const SCHEMA: &'static str = include_str!("../../../msg/ForecastBand.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/ForecastBand", "fields": [{"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "unit", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "p5", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "p50", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "p95", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "width", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "compared", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inside", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inside_members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lead_until", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lead_width", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lead_calibrated", "type": {"type_id": 159, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lead_compared", "type": {"type_id": 151, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lead_inside", "type": {"type_id": 151, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Where this tool drills next: what the bit does now, and the next metres with the range of plausible tools, once per second
    /// of model time. It reads the twin and acts on nothing.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct HoleAhead {
        /// Stamp: the instant at which the means end, on the rig's clock. Where an answer is to come the message follows once it is
        /// there, some seconds later. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Whether the hole ahead is known. Where it is false, all from build_rate on that says where the tool drills is NaN, and the
        /// arrays are empty.
        pub known: bool,
        /// Why it is not known, in one sentence; empty where it is.
        pub because: std::string::String,
        /// Time that the means cover (s): whole turns, or all that is there where it is less than one turn.
        pub window: f64,
        /// Whole turns of the bit in that time; 0 where the bit stands or turns more slowly.
        pub turns: u32,
        /// Measured depth of the bit, from the kick-off (m).
        pub measured_depth: f64,
        /// Inclination of the hole at the bit (rad): 0 is straight down.
        pub inclination: f64,
        /// Azimuth of the hole at the bit (rad), clockwise seen from above: 0 is the plane of the configured hole.
        pub azimuth: f64,
        /// Force of the bit on the rock across the hole (N), to the low side: above 0 it drops.
        pub side_force_low: f64,
        /// The same to the right, seen down the hole (N): above 0 it walks to the right.
        pub side_force_right: f64,
        /// Standard errors of these means (N); NaN with fewer than 3 whole turns.
        pub side_force_low_error: f64,
        pub side_force_right_error: f64,
        /// Tilt of the guide's last node against the hole (rad), to the low side: below 0 the bit points up and builds.
        pub tilt_low: f64,
        /// The same to the right (rad).
        pub tilt_right: f64,
        /// Direction in which the bit drills against the hole's (rad), to the low side: tilt and side force together by the law of the
        /// bit. Below 0 it builds more than the hole at the bit does. NaN where the bit cuts nothing.
        pub turn_low: f64,
        /// The same to the right (rad).
        pub turn_right: f64,
        /// Weight on the bit (N); 0 off bottom.
        pub weight_on_bit: f64,
        /// The part of it that cuts (N): without the wear flats. 0 where the bit cuts nothing.
        pub weight_that_cuts: f64,
        /// Torque of the rock against the bit (N m).
        pub torque: f64,
        /// The instant of the means that the answer is for, on the rig's clock; 0 without an answer.
        pub answered: super::builtin_interfaces::Time,
        /// Side force to the low side of the guide at rest in this hole, by the statics that the hole is grown with (N). The hole ahead
        /// is not known where that of the twin differs by more than 3 standard errors and 5 %, or 0.5 % of the weight where that is
        /// more. NaN without an answer.
        pub side_force_low_at_rest: f64,
        /// Build rate over the next metre (rad/m): above 0 the inclination rises. Low and high: 5 and 95 % of the plausible tools. NaN
        /// where it is not known.
        pub build_rate: f64,
        pub build_rate_low: f64,
        pub build_rate_high: f64,
        /// Walk rate over the next metre (rad/m): above 0 the azimuth turns to the right. NaN where it is not known, or the hole is
        /// within 3 deg of the vertical.
        pub walk_rate: f64,
        pub walk_rate_low: f64,
        pub walk_rate_high: f64,
        /// Radius of the hole over the next metre (m), whatever its direction; infinite where it is straight. NaN where it is not known.
        pub radius: f64,
        pub radius_low: f64,
        pub radius_high: f64,
        /// Steering number P: lateral resistance of the bit against the bending of the guide, in a long arc. NaN where it is not known.
        pub steering_number: f64,
        /// Length between the bit and where the guide lies on the wall, in a long arc (m). NaN where it is not known.
        pub free_length: f64,
        /// Whether the hole ripples: P is below 2.2; false where it is not known.
        pub ripples: bool,
        /// Smallest and largest radius in a long arc that this guide drills at the present weight, with any bit and any rock (m). NaN
        /// where it is not known.
        pub radius_any_bit_low: f64,
        pub radius_any_bit_high: f64,
        /// Measured depth from the kick-off (m); the first is that of the bit when the answer was computed.
        pub measured_depths: Vec<f64>,
        /// Inclination (rad), and 5 and 95 % of the plausible tools.
        pub inclinations: Vec<f64>,
        pub inclinations_low: Vec<f64>,
        pub inclinations_high: Vec<f64>,
        /// Azimuth (rad), and 5 and 95 % of the plausible tools.
        pub azimuths: Vec<f64>,
        pub azimuths_low: Vec<f64>,
        pub azimuths_high: Vec<f64>,
        /// Position from the kick-off, X horizontal in the plane of the configured hole (m).
        pub position_x: Vec<f64>,
        /// Position, Y horizontal, to the right (m).
        pub position_y: Vec<f64>,
        /// Position, Z down (m).
        pub position_z: Vec<f64>,
        /// Half of the width that 90 % of the plausible tools have across the hole, towards its high side (m).
        pub half_width_high: Vec<f64>,
        /// The same to the right (m).
        pub half_width_right: Vec<f64>,
        /// Plausible tools that were computed, and those without a result. What the latter drill is unknown.
        pub members: u32,
        pub failed: u32,
        /// Surveys (rig/survey) that the answer rests on: those of the hole that this tool has drilled.
        pub surveys_used: u32,
        /// How far the bit is beyond the last of them (m); NaN without any.
        pub since_survey: f64,
        /// Why there is no comparison where the configuration has a plan; empty otherwise.
        pub plan_because: std::string::String,
        /// Radius around the plan within which the bit is on plan (m).
        pub plan_target: f64,
        /// Build rate of the plan over the next metre (rad/m).
        pub plan_build_rate: f64,
        /// By measured_depths, NaN beyond the end of the plan. Distance of the bit from the nearest point of the plan, to the high
        /// side (m): above 0 the bit is above the plan.
        pub plan_high: Vec<f64>,
        /// The same to the right (m).
        pub plan_right: Vec<f64>,
        /// Inclination less that of the plan at the same measured depth (rad): below 0 the hole builds less than planned.
        pub plan_inclination: Vec<f64>,
        /// Azimuth less that of the plan (rad): above 0 the hole is to the right of it. NaN within 3 deg of the vertical.
        pub plan_azimuth: Vec<f64>,
        /// Share of the plausible tools that stay within plan_target from the bit up to there, 0 to 1.
        pub plan_within: Vec<f64>,
        /// How far the plan is from the middle of the range of the plausible tools, in half widths of that range: the largest of the
        /// inclination and, outside plan_target, of the position, from 1 m ahead on. Above 1 the hole leaves its plan.
        pub plan_off: f64,
        /// Where plan_off is above 0.9, the weights from plan_weight_low to plan_weight_high are searched: within a half of the present
        /// one and inputs.weight_on_bit.
        pub plan_weight_low: f64,
        pub plan_weight_high: f64,
        /// The weight of these with the smallest plan_off (N), with that and the radius of the next metre (m). NaN where none is known.
        pub plan_nearest_weight: f64,
        pub plan_nearest_off: f64,
        pub plan_nearest_radius: f64,
        /// The same weight where it brings the hole back to its plan, with a plan_off of at most 0.9 (N); NaN otherwise.
        pub plan_weight: f64,
        /// Whether plan_off is above 0.9 and no weight brings the hole back.
        pub plan_no_weight: bool,
        /// Whether this guide drills no such hole with any bit, in any rock, at any weight that the inputs allow: the mean build rate of
        /// the plan over 5 m is outside kf -+ sqrt(2 p c/EI).
        pub plan_no_guide: bool,
        /// Surveys of those used that correct the curvature too, not the direction alone.
        pub surveys_learnt: u32,
        /// Direction of the hole at the bit by the surveys, with standard deviations (rad): inclination, and azimuth as azimuth is
        /// counted. NaN without a survey that is used.
        pub surveyed_inclination: f64,
        pub surveyed_inclination_deviation: f64,
        pub surveyed_azimuth: f64,
        pub surveyed_azimuth_deviation: f64,
        /// How much more the tool builds than as configured, by the surveys, with its standard deviation (rad/m). NaN where none
        /// corrects the curvature.
        pub surveyed_build: f64,
        pub surveyed_build_deviation: f64,
        /// Azimuth of the plane of the configured hole (rad), clockwise from the north of plan and surveys: that of the plan at the bit,
        /// or else of the surveys; NaN where neither has one.
        pub plane_azimuth: f64,
        /// Measured depth from which on this tool has drilled (m); NaN without surveys.
        pub drilled_from: f64,
        /// Why surveys are not used, where that is so; empty otherwise.
        pub surveys_because: std::string::String,
        /// Every survey that is known when the means end, in the order of arrival; a new answer rests on them some seconds later.
        /// Measured depth from the kick-off (m).
        pub survey_depths: Vec<f64>,
        /// Inclination (rad).
        pub survey_inclinations: Vec<f64>,
        /// Its standard deviation (rad).
        pub survey_inclination_deviations: Vec<f64>,
        /// Azimuth (rad), clockwise from north; NaN of a tool that measures inclinations alone.
        pub survey_azimuths: Vec<f64>,
        /// Its standard deviation (rad); NaN without an azimuth.
        pub survey_azimuth_deviations: Vec<f64>,
    }

    impl Message for HoleAhead {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "HoleAhead";
        const ROS_TYPE: &'static str = "flexdrill/msg/HoleAhead";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::HoleAhead_";
        const RIHS01: &'static str = "RIHS01_750c03783111854cdb30d02e4d24cc05f067d3e2aa5c031eb7c485852fae2caa";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/HoleAhead.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/HoleAhead", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "known", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "because", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "window", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "turns", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "azimuth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "side_force_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "side_force_right", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "side_force_low_error", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "side_force_right_error", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "tilt_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "tilt_right", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "turn_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "turn_right", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_that_cuts", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "answered", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "side_force_low_at_rest", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "build_rate", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "build_rate_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "build_rate_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "walk_rate", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "walk_rate_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "walk_rate_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "radius", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "radius_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "radius_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "steering_number", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "free_length", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "ripples", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "radius_any_bit_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "radius_any_bit_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depths", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclinations", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclinations_low", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclinations_high", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "azimuths", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "azimuths_low", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "azimuths_high", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "position_x", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "position_y", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "position_z", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "half_width_high", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "half_width_right", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failed", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveys_used", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "since_survey", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_because", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_target", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_build_rate", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_high", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_right", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_inclination", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_azimuth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_within", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_off", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_weight_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_weight_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_nearest_weight", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_nearest_off", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_nearest_radius", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_weight", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_no_weight", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plan_no_guide", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveys_learnt", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveyed_inclination", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveyed_inclination_deviation", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveyed_azimuth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveyed_azimuth_deviation", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveyed_build", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveyed_build_deviation", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "plane_azimuth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "drilled_from", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveys_because", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "survey_depths", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "survey_inclinations", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "survey_inclination_deviations", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "survey_azimuths", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "survey_azimuth_deviations", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// A point of the hole as this tool drills it, from the end of the configured hole on: one message per 20 mm of advance. A
    /// point is final. The model stays in its configured hole until the next run; `flexdrill rebase` makes its configuration.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct HoleDrilled {
        /// Stamp: the instant of the means of `twin/hole_ahead` at which the point was complete, on the rig's clock; of points that a
        /// checkpoint has brought, the start of the run. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Number of the point, from 0 on. Where it is 0 again the motion has begun again, and the hole with it.
        pub point: u32,
        /// Length of hole of this point (m).
        pub length: f64,
        /// Length of hole from the end of the configured one to the lower end of this point (m).
        pub drilled: f64,
        /// Measured depth of the lower end, from the kick-off (m).
        pub measured_depth: f64,
        /// Inclination there (rad): 0 is straight down.
        pub inclination: f64,
        /// Azimuth there (rad), clockwise seen from above: 0 is the plane of the configured hole.
        pub azimuth: f64,
        /// Position there, from the kick-off (m): X horizontal in the plane of the configured hole, Y to its right, Z down.
        pub position: [f64; 3],
        /// Curvature of the hole over this point (1/m): above 0 the inclination rises. Axes are carried along the hole without twist.
        pub build: f64,
        /// The same to the right, seen down the hole (1/m).
        pub right: f64,
        /// Whether the hole ahead was known there. Where it is false the curvatures are those of the newest answer, or of the point
        /// above, or of the configured hole.
        pub known: bool,
        /// Why it is not known, in one sentence; empty where it is.
        pub because: std::string::String,
        /// The instant of the means whose answer has these curvatures, on the rig's clock; 0 without one.
        pub answered: super::builtin_interfaces::Time,
    }

    impl Message for HoleDrilled {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "HoleDrilled";
        const ROS_TYPE: &'static str = "flexdrill/msg/HoleDrilled";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::HoleDrilled_";
        const RIHS01: &'static str = "RIHS01_0608fbf6efdbcccba5c24b55bcf0f5880a76dc68690d82ffbff9035d6057e296";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/HoleDrilled.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/HoleDrilled", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "point", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "length", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "drilled", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "azimuth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "position", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "build", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "right", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "known", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "because", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "answered", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}]}"#;
    }

    /// Deflection of and load on every joint of the flexible pipe. All arrays have one entry per joint, top to bottom:
    /// entry 0 is joint_01 of joint_states.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct JointDeflections {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Largest bend angle of all joints (rad, \>= 0).
        pub max_bend_angle: f64,
        /// Entry of that joint in the arrays below.
        pub max_bend_joint: u32,
        /// Number of joints whose bend angle has reached the limit.
        pub joints_at_limit: u32,
        /// Measured depth from the kick-off (m).
        pub measured_depth: Vec<f64>,
        /// Inclination of the bore there, 0 is straight down (rad).
        pub inclination: Vec<f64>,
        /// Angle between the axes of the two links (rad, \>= 0).
        pub bend_angle: Vec<f64>,
        /// Toolface of the bend: the direction in which the lower link turns away, from the high side, clockwise looking down
        /// the hole (rad, -pi to pi).
        pub bend_direction: Vec<f64>,
        /// Bend angle at which the joint's stop begins (rad).
        pub limit_angle: Vec<f64>,
        /// Moment of the stop (N m, \>= 0, zero below the limit).
        pub stop_moment: Vec<f64>,
        /// Horizontal transverse displacement from the bore axis (m).
        pub lateral_y: Vec<f64>,
        /// Displacement from the bore axis towards the low side (m).
        pub lateral_z: Vec<f64>,
        /// Spin rate of the link below the joint (rad/s, positive in the drive's sense).
        pub spin_rate: Vec<f64>,
        /// Axial force through the joint (N, tension positive).
        pub axial_force: Vec<f64>,
        /// Magnitude of the shear force through the joint (N, \>= 0).
        pub shear_force: Vec<f64>,
        /// Torque through the joint (N m, positive in the drive's sense).
        pub torque: Vec<f64>,
    }

    impl Message for JointDeflections {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "JointDeflections";
        const ROS_TYPE: &'static str = "flexdrill/msg/JointDeflections";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::JointDeflections_";
        const RIHS01: &'static str = "RIHS01_0cbbe142f2c40f82a157ed05b518531c55256d8c6b5212d55b61a70e92292388";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/JointDeflections.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/JointDeflections", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "max_bend_angle", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "max_bend_joint", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "joints_at_limit", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bend_angle", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bend_direction", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "limit_angle", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stop_moment", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateral_y", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateral_z", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "spin_rate", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "axial_force", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "shear_force", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "torque", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The external forces on the tool, so that a reader can check the balance: supports, weight, wall, bit and loads. At
    /// rest they sum to zero; in motion they do so together with inertia and damping. All vectors are along the axes of the
    /// frame: X horizontal in the build's direction, Y horizontal, Z down. All figures are of the instant of the stamp.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Reactions {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Torque on the top of the pipe (N m), negative in reverse: the drive's, or below a string the string's.
        pub drive_torque: f64,
        /// Torque of the rock against the bit (N m), negative in reverse, 0 off bottom.
        pub bit_torque: f64,
        /// Sum of the forces in the list below (N).
        pub support_force: [f64; 3],
        /// Weight of both pipes and of the bodies on them, minus buoyancy (N).
        pub weight: [f64; 3],
        /// Sum of the forces of the wall on the guide pipe, friction included (N).
        pub wall_force: [f64; 3],
        /// Force of the rock on the tool: the weight on bit, along the axis at the bit (N).
        pub bit_force: [f64; 3],
        /// Sum of the configured point loads (N).
        pub load_force: [f64; 3],
        /// Minus mass times acceleration of the whole tool (N).
        pub inertia_force: [f64; 3],
        /// Damping of the motion of the tool as a whole (N).
        pub damping_force: [f64; 3],
        /// Sum of the seven forces: the residual of the solver (N).
        pub unbalanced_force: [f64; 3],
        /// Per support, which holds a pipe in some directions, and last the string above where a hoist carries it: measured depth
        /// from the kick-off (m).
        pub measured_depth: Vec<f64>,
        /// Inclination of the bore there, 0 is straight down (rad).
        pub inclination: Vec<f64>,
        /// PIPE, GUIDE or STRING.
        pub body: Vec<u8>,
        /// Force on the pipe, X (N); that of STRING on the guide.
        pub force_x: Vec<f64>,
        /// Force, Y (N).
        pub force_y: Vec<f64>,
        /// Force, Z (N).
        pub force_z: Vec<f64>,
        /// Moment on the pipe about the location, X (N m), without drive_torque; 0 for STRING.
        pub moment_x: Vec<f64>,
        /// Moment, Y (N m).
        pub moment_y: Vec<f64>,
        /// Moment, Z (N m).
        pub moment_z: Vec<f64>,
    }

    impl Reactions {
        /// A support of the flexible pipe.
        pub const PIPE: u8 = 0;
        /// A support of the guide pipe.
        pub const GUIDE: u8 = 1;
        /// The string above, which pulls at the top of the guide pipe along the hole.
        pub const STRING: u8 = 2;
    }

    impl Message for Reactions {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Reactions";
        const ROS_TYPE: &'static str = "flexdrill/msg/Reactions";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Reactions_";
        const RIHS01: &'static str = "RIHS01_4ccf4ad06f5c354eb83a5ec31e99219185cbced1737213ed22a25db08357f9cd";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/Reactions.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Reactions", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "drive_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "support_force", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "wall_force", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_force", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "load_force", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inertia_force", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "damping_force", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "unbalanced_force", "type": {"type_id": 59, "capacity": 3, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "body", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "force_x", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "force_y", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "force_z", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "moment_x", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "moment_y", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "moment_z", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// One quantity of the comparison of rig and twin.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Residual {
        /// surface_torque, hook_load, downhole_rotary_speed, downhole_torque or downhole_weight_on_bit.
        pub name: std::string::String,
        /// Unit: N m, N or rad/s.
        pub unit: std::string::String,
        /// What was measured since the message before, as received; NaN where nothing new came. Of several values the newest.
        pub sample: f64,
        /// Sliding mean of what was measured; NaN, as all below, while the quantity cannot be judged.
        pub measured: f64,
        /// The same of what the twin computes, with the tare of the sensor.
        pub predicted: f64,
        /// The band in which nine of ten means are expected.
        pub low: f64,
        pub high: f64,
        /// Measured less predicted over half of the band: one of ten lies beyond -1 to 1.
        pub ratio: f64,
    }

    impl Message for Residual {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Residual";
        const ROS_TYPE: &'static str = "flexdrill/msg/Residual";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Residual_";
        const RIHS01: &'static str = "RIHS01_b345834b965b1369a908947b52a9d65ba419ee84bcb858d6aa320f830b194348";
        const SCHEMA: &'static str = include_str!("../../../msg/Residual.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Residual", "fields": [{"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "unit", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "sample", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "predicted", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "ratio", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// What the rig measures less what the twin computes, with the band that is expected. Published every second of model time
    /// once rig/measured has brought one of the quantities. Judged in steady motion only: after a change of speed or weight all
    /// means are NaN until the string and the auto-driller have settled.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Residuals {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// One per quantity, always in the same order.
        pub residuals: Vec<Residual>,
        /// Speed and weight are steady, and all inputs are good.
        pub steady: bool,
        /// The bit drills; otherwise it is off bottom.
        pub drilling: bool,
        /// Measured depth of the bit, from the rig's own zero (m); NaN where the rig does not give it.
        pub bit_depth: f64,
        /// Running estimate, from the surface torque in steady motion, of calibration.friction_factor: the friction in both layers
        /// over that of contact.inner and contact.outer, with its 90 % band. Where plausible tools run
        /// with the twin, it is theirs by their weights; NaN where they say nothing.
        pub friction_factor: f64,
        pub friction_factor_low: f64,
        pub friction_factor_high: f64,
        /// The same of the offset of the torque's sensor (N m).
        pub torque_tare: f64,
        pub torque_tare_low: f64,
        pub torque_tare_high: f64,
        /// Why the newest sample changed neither: an input is not good, the motion is not steady, a value is missing, the sample is
        /// far from what is expected, or plausible tools have not come to it. Empty where it changed them.
        pub estimate_frozen: std::string::String,
        /// What the residuals that are surely beyond their bands may mean, the likeliest first.
        pub likely_causes: Vec<std::string::String>,
        /// Whether the twin's friction and the tare follow the running estimate (calibration.follow).
        pub following: bool,
        /// Factor on the friction of both layers that acts in the model: calibration.friction_factor in force and as configured.
        pub applied_friction_factor: f64,
        pub configured_friction_factor: f64,
        /// The same of calibration.torque_tare_nm (N m).
        pub applied_torque_tare: f64,
        pub configured_torque_tare: f64,
        /// Why both did not move at this comparison, or move no further. Empty where they follow.
        pub following_held: std::string::String,
    }

    impl Message for Residuals {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Residuals";
        const ROS_TYPE: &'static str = "flexdrill/msg/Residuals";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Residuals_";
        const RIHS01: &'static str = "RIHS01_a8aeafd2f76f3982f0310949b863830f17cb520c060d3a898efed1160dc4d6e2";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/Residuals.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: flexdrill/Residual\n",
            include_str!("../../../msg/Residual.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Residuals", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "residuals", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/Residual"}}, {"name": "steady", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "drilling", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_factor", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_factor_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_factor_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "torque_tare", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "torque_tare_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "torque_tare_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "estimate_frozen", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "likely_causes", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "following", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "applied_friction_factor", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "configured_friction_factor", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "applied_torque_tare", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "configured_torque_tare", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "following_held", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The inputs of the rig with the time of their measurement, for rigs that provide it; the topics rig/rotary_speed_rpm,
    /// rig/weight_on_bit_kn, rig/rate_of_penetration and rig/standpipe_pressure carry the numbers alone. Topic rig/inputs.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct RigInputs {
        /// Stamp: time of the measurement, on the rig's clock. The age of the input counts from it. Frame: not used.
        pub header: super::std_msgs::Header,
        /// Speed of the top drive (r/min), NaN if not given.
        pub rotary_speed_rpm: f64,
        /// Weight on bit (kN), NaN if not given.
        pub weight_on_bit_kn: f64,
        /// Quality of all values: GOOD, SUSPECT or BAD.
        pub quality: u8,
        /// Sensor or program of origin, for displays; may be empty.
        pub source: std::string::String,
        /// Rate of penetration (m/h), negative while the tool is pulled back; NaN if not given.
        pub rate_of_penetration_m_per_h: f64,
        /// Standpipe pressure, inside minus outside at the tool's top (MPa), NaN if not given.
        pub standpipe_pressure_mpa: f64,
        /// Which of the values are given: a sum of the GIVEN_ constants. With 0 the message does not say so, and a rate or pressure
        /// of exactly 0 counts as not given: a program that does not know the field leaves it at 0.
        pub given: u32,
    }

    impl RigInputs {
        /// The source considers the values correct.
        pub const GOOD: u8 = 0;
        /// The source has doubts; the twin accepts the values, and the status says so.
        pub const SUSPECT: u8 = 1;
        /// The values are wrong or not measured; the twin refuses them.
        pub const BAD: u8 = 2;
        /// Bits of `given`.
        pub const GIVEN_ROTARY_SPEED: u32 = 1;
        pub const GIVEN_WEIGHT_ON_BIT: u32 = 2;
        pub const GIVEN_RATE_OF_PENETRATION: u32 = 4;
        pub const GIVEN_STANDPIPE_PRESSURE: u32 = 8;
    }

    impl Message for RigInputs {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "RigInputs";
        const ROS_TYPE: &'static str = "flexdrill/msg/RigInputs";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::RigInputs_";
        const RIHS01: &'static str = "RIHS01_9efac5ffbffc4da5926c39013faf84522a543c2d5ddc444ff330d2ae09e0b63e";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/RigInputs.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/RigInputs", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "rotary_speed_rpm", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit_kn", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "quality", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "source", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rate_of_penetration_m_per_h", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "standpipe_pressure_mpa", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "given", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// What the rig and the tool's own sensors measure besides the inputs that drive the twin. The twin compares these values
    /// with its own and never drives the model by them. Every value is optional: NaN where it is not given; see also `given`.
    /// Topic rig/measured.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct RigMeasured {
        /// Stamp: time of the measurement, on the rig's clock. Frame: not used.
        pub header: super::std_msgs::Header,
        /// Torque of the drive at the surface (N m).
        pub surface_torque: f64,
        /// Standpipe pressure, inside minus outside at the tool's top (Pa).
        pub standpipe_pressure: f64,
        /// Load on the hook (N), the weight of the string in the mud minus the weight on bit and the friction along the hole.
        pub hook_load: f64,
        /// Rate of penetration (m/s), negative while the tool is pulled back.
        pub rate_of_penetration: f64,
        /// Measured depth of the bit, from the rig's own zero (m).
        pub bit_depth: f64,
        /// Measured depth of the hole, from the rig's own zero (m).
        pub hole_depth: f64,
        /// Rotary speed above the bit, measured in the hole (rad/s).
        pub downhole_rotary_speed: f64,
        /// Torque above the bit, measured in the hole (N m).
        pub downhole_torque: f64,
        /// Weight on bit, measured in the hole (N).
        pub downhole_weight_on_bit: f64,
        /// Axial acceleration in the hole, root mean square of the sensor's window (m/s2).
        pub axial_vibration: f64,
        /// Lateral acceleration in the hole, root mean square of the sensor's window (m/s2).
        pub lateral_vibration: f64,
        /// Largest axial acceleration in the sensor's window (m/s2).
        pub axial_shock: f64,
        /// Largest lateral acceleration in the sensor's window (m/s2).
        pub lateral_shock: f64,
        /// Quality of all values: GOOD, SUSPECT or BAD.
        pub quality: u8,
        /// Sensor or program of origin, for displays; may be empty.
        pub source: std::string::String,
        /// Which of the values are given: bit k for value k of the above, the surface torque being value 0. With 0 the message does
        /// not say so, and a value of exactly 0 counts as not given: a program that does not know a field leaves it at 0.
        pub given: u32,
    }

    impl RigMeasured {
        /// The source considers the values correct.
        pub const GOOD: u8 = 0;
        /// The source has doubts; comparisons leave the values out, and the recording keeps them.
        pub const SUSPECT: u8 = 1;
        /// The values are wrong or not measured.
        pub const BAD: u8 = 2;
    }

    impl Message for RigMeasured {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "RigMeasured";
        const ROS_TYPE: &'static str = "flexdrill/msg/RigMeasured";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::RigMeasured_";
        const RIHS01: &'static str = "RIHS01_44f88d41aa2249f5e6e694cfdd99a933a4da86b78538496eddb6fa1802ca5748";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/RigMeasured.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/RigMeasured", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "surface_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "standpipe_pressure", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hook_load", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rate_of_penetration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "downhole_rotary_speed", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "downhole_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "downhole_weight_on_bit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "axial_vibration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateral_vibration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "axial_shock", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateral_shock", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "quality", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "source", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "given", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// A survey: the direction of the hole at a measured depth. Late by metres is normal: the tool that measures sits above the
    /// bit. The twin corrects by surveys where the tool drills next (twin/hole_ahead), and never drives the model by them. Topic
    /// rig/survey.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct RigSurvey {
        /// Stamp: time of the measurement, on the rig's clock; of two surveys of one source at the same depth the newer one counts.
        /// Frame: not used.
        pub header: super::std_msgs::Header,
        /// Measured depth of the survey, from the rig's own zero (m); well.kick_off_depth is that of the kick-off.
        pub measured_depth: f64,
        /// Inclination of the hole (rad): 0 is straight down.
        pub inclination: f64,
        /// Azimuth of the hole (rad), clockwise seen from above, from the same north as the plan; NaN of a tool that measures
        /// inclinations alone.
        pub azimuth: f64,
        /// Standard deviation of the inclination (rad). NaN or 0 is the usual one, 0.2 deg.
        pub inclination_deviation: f64,
        /// Standard deviation of the azimuth (rad). NaN or 0 is the usual one of a magnetic tool: 5 deg down to 10 m below the
        /// kick-off, 1 deg below. A gyro has 0.5 deg.
        pub azimuth_deviation: f64,
        /// Quality of all values: GOOD, SUSPECT or BAD.
        pub quality: u8,
        /// Sensor or program of origin, for displays; may be empty.
        pub source: std::string::String,
    }

    impl RigSurvey {
        /// The source considers the values correct.
        pub const GOOD: u8 = 0;
        /// The source has doubts; the twin does not use the survey, and the recording keeps it.
        pub const SUSPECT: u8 = 1;
        /// The values are wrong or not measured.
        pub const BAD: u8 = 2;
    }

    impl Message for RigSurvey {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "RigSurvey";
        const ROS_TYPE: &'static str = "flexdrill/msg/RigSurvey";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::RigSurvey_";
        const RIHS01: &'static str = "RIHS01_7992b3e583a842dcce5e6e2b0faac44211b94b49d3da361f3f42ba4d49ff3ddc";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/RigSurvey.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/RigSurvey", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "measured_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "azimuth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination_deviation", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "azimuth_deviation", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "quality", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "source", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The map of rotary speed and weight on bit that the node has loaded (map.file): where alarms must be expected, and where
    /// not. It belongs to the tool of this run.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SafeWindow {
        /// Stamp: when the run began. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Title of the configuration that the map was made for.
        pub title: std::string::String,
        /// The program that made it.
        pub program: std::string::String,
        /// Hash of what determines the motion of the tool and its alarms.
        pub motion: std::string::String,
        /// Model time that each run of the map was judged over (s).
        pub horizon: f64,
        /// Runs per cell and start, at most.
        pub members: u32,
        /// Chance above which an alarm must be expected.
        pub limit: f64,
        /// Priority from which on an alarm counts: Alarm.LOW, MEDIUM or HIGH.
        pub priority: u8,
        /// Rotary speeds of the cells (r/min), rising.
        pub rotary_speed_rpm: Vec<f64>,
        /// Weights on bit of the cells (kN), rising.
        pub weight_on_bit_kn: Vec<f64>,
        /// What each cell is: row by row of the weight, the speed within a row.
        pub verdict: Vec<u8>,
        /// Largest chance of any alarm over the starts; NaN where the cell was not run or is unknown.
        pub chance: Vec<f64>,
        /// The id of the likeliest alarm of that start; empty where none was seen.
        pub alarm: Vec<std::string::String>,
        /// Whether the cell was run; otherwise its verdict is inferred from those that were.
        pub was_run: Vec<bool>,
        /// Fewest and most members that ended at a start that was run; 0 where none ended. A chance is known as well as these say.
        pub least_members: u32,
        pub most_members: u32,
    }

    impl SafeWindow {
        /// From no start must an alarm be expected.
        pub const CLEAR: u8 = 0;
        /// From every start an alarm must be expected.
        pub const ALARM: u8 = 1;
        /// From one start an alarm must be expected, from another not.
        pub const DEPENDS_ON_START: u8 = 2;
        /// A run of it failed: it is not safe.
        pub const UNKNOWN: u8 = 3;
        /// It was not run from some start, and the runs around it do not say with 95 % what it is: it is not safe.
        pub const NOT_KNOWN: u8 = 4;
    }

    impl Message for SafeWindow {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "SafeWindow";
        const ROS_TYPE: &'static str = "flexdrill/msg/SafeWindow";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::SafeWindow_";
        const RIHS01: &'static str = "RIHS01_5d079f88b6544dca13eb5c57c994f12e5da241726d2c98773c0837ee6633252c";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/SafeWindow.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/SafeWindow", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "title", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "program", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "motion", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "horizon", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "limit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "priority", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rotary_speed_rpm", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit_kn", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "verdict", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "chance", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "alarm", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "was_run", "type": {"type_id": 159, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "least_members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "most_members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Configuration and version of a run, so that a recording is self-contained.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SessionInfo {
        /// Stamp: start of the run on the rig's clock. Frame: the tool, as in all messages of this run.
        pub header: super::std_msgs::Header,
        /// Version of flexdrill.
        pub version: std::string::String,
        /// SHA-256 of the configuration.
        pub config_hash: std::string::String,
        /// Model step (s).
        pub time_step: f64,
        /// Time of model step 0 on the rig's clock.
        pub start: super::builtin_interfaces::Time,
        /// The whole configuration, YAML.
        pub configuration: std::string::String,
    }

    impl Message for SessionInfo {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "SessionInfo";
        const ROS_TYPE: &'static str = "flexdrill/msg/SessionInfo";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::SessionInfo_";
        const RIHS01: &'static str = "RIHS01_0a3eff65416a497c5640cf09c4b8823cc1454df0723a6441ab160a5110ef22b9";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/SessionInfo.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/SessionInfo", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "version", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "config_hash", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "time_step", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "start", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "configuration", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Torque, weight and power from the surface to the bit, and where they are lost. All figures are means over the last
    /// `duration` seconds, in which every step counts; those ending in `_rms` are root mean squares over the same time.
    /// A figure that the tool does not have is NaN: surface torque, hook load and the drive's limit need the string above,
    /// surface weight and drag of the string its hoist, the depth of cut a rock that holds the bit.
    /// 
    /// Signs: a torque is positive where it belongs to forward rotation, and negative in reverse: the drive's, the bit's and
    /// every loss, since a loss opposes the rotation. In both senses a torque less the losses below it is the torque below.
    /// Powers are positive in both senses, as their names say: put in, or taken.
    /// 
    /// The tool turns where the mean speed of its top is above a tenth of the speed asked for, of the root mean square of its
    /// own speed, and of a turn per minute. Standing, at a stall or swinging to and fro it does not turn, and what is a power
    /// over a speed does not exist: it is NaN.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Transfer {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Time that the means cover (s): transfer.window, less at the beginning; 0 before the first tenth of a second.
        pub duration: f64,
        /// Torque of the top drive (N m).
        pub surface_torque: f64,
        /// Root mean square of it (N m).
        pub surface_torque_rms: f64,
        /// Torque on the top of the tool (N m).
        pub kickoff_torque: f64,
        /// Root mean square of it (N m).
        pub kickoff_torque_rms: f64,
        /// Torque of the rock against the bit (N m), 0 off bottom.
        pub bit_torque: f64,
        /// Root mean square of it (N m).
        pub bit_torque_rms: f64,
        /// Torque at the bit over that at the surface, without a string over that at the kick-off; 0 off bottom. NaN below 1 N m
        /// there and while the tool does not turn.
        pub torque_efficiency: f64,
        /// Torque of the rotation that friction between pipe and guide takes (N m): its power over the speed of the tool's top.
        /// NaN while the tool does not turn, as for the next two.
        pub pipe_guide_friction_torque: f64,
        /// Torque of the rotation that friction between guide and wall takes (N m), without what the advance takes.
        pub guide_wall_friction_torque: f64,
        /// Torque of the rotation that the pins of the joints take (N m).
        pub joint_friction_torque: f64,
        /// Torque that the friction of the wall takes from the string above (N m); it also holds a string that stands.
        pub string_friction_torque: f64,
        /// Weight that is slacked off at the surface (N): what the hook carries less than off bottom.
        pub surface_weight: f64,
        /// Root mean square of it (N).
        pub surface_weight_rms: f64,
        /// Axial force on the guide at the kick-off (N), positive where it pushes down the hole.
        pub kickoff_weight: f64,
        /// Root mean square of it (N).
        pub kickoff_weight_rms: f64,
        /// Weight on the bit (N), 0 off bottom.
        pub bit_weight: f64,
        /// Root mean square of it (N).
        pub bit_weight_rms: f64,
        /// Load on the hook (N): the weight in mud of the string and of all that hangs on its end, guide and pipe, less what stands
        /// on the bottom and on the wall.
        pub hook_load: f64,
        /// Axial friction of the guide on the pipe (N), positive where it pushes up the hole.
        pub pipe_guide_axial_drag: f64,
        /// Axial friction of the wall on the guide (N), positive where it pushes up the hole.
        pub guide_wall_axial_drag: f64,
        /// Axial friction of the wall on the string above (N), positive where it pushes up the hole.
        pub string_axial_drag: f64,
        /// Depth of cut (m per turn), 0 off bottom.
        pub depth_of_cut: f64,
        /// Rate at which the hole deepens (m/s), never negative: how much deeper than before the bit has come. 0 off bottom, whatever
        /// the block does, and while a bit that was lifted is lowered to the bottom again.
        pub rate_of_penetration: f64,
        /// Power put in: of the top drive (W).
        pub drive_power: f64,
        /// Of the hoist (W).
        pub hoist_power: f64,
        /// Of the weight on bit (W); below a hoist minus the power that the rock takes along the hole.
        pub weight_on_bit_power: f64,
        /// Of gravity (W).
        pub gravity_power: f64,
        /// Of the point loads (W).
        pub load_power: f64,
        /// Of the advance (W): the friction of the wall times the advance; below a hoist with the weight on bit and less the string's
        /// force times the advance, which the displacements of the tool in its frame do not contain.
        pub feed_power: f64,
        /// Of the pressure in the pipe (W).
        pub pressure_power: f64,
        /// Power taken: by the rock (W).
        pub bit_power: f64,
        /// By friction in both layers and in the joints (W): the sum of the next three, to the accuracy of a step.
        pub friction_power: f64,
        /// By friction between pipe and guide (W).
        pub pipe_guide_friction_power: f64,
        /// By friction between guide and wall (W).
        pub guide_wall_friction_power: f64,
        /// By friction in the joints (W).
        pub joint_friction_power: f64,
        /// By the damping of contacts, stops and joints with play (W).
        pub contact_damping_power: f64,
        /// By Rayleigh damping (W).
        pub rayleigh_damping_power: f64,
        /// By the time integration (W).
        pub numerical_damping_power: f64,
        /// By the string above, to friction on the wall and to the mud (W).
        pub string_power: f64,
        /// Of updating the axial force in the geometric stiffness (W), positive when put in.
        pub axial_update_power: f64,
        /// Stored as motion and deformation (W), negative when it is released.
        pub stored_power: f64,
        /// Put in, less taken, less stored (W): the error of the energy audit.
        pub error_power: f64,
        /// By the mud that moves with pipe and guide (W): power taken, part of the same balance.
        pub mud_power: f64,
        /// Share of the time (0 to 1) in which the torque of the top drive was at its limit: the speed asked for is then not kept.
        pub drive_at_limit: f64,
        /// Share of a weight at the kick-off (0 to 1) that reaches the bit when only the sliding friction of a clean hole in the arc
        /// takes from it.
        pub weight_arrives: f64,
    }

    impl Message for Transfer {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "Transfer";
        const ROS_TYPE: &'static str = "flexdrill/msg/Transfer";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::Transfer_";
        const RIHS01: &'static str = "RIHS01_f5d8d9395b18ded8f1c0ed0e30350697b789e704550a4f766009f91450f8577f";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/Transfer.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/Transfer", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "duration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surface_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surface_torque_rms", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "kickoff_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "kickoff_torque_rms", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_torque_rms", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "torque_efficiency", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_friction_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_friction_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "joint_friction_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "string_friction_torque", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surface_weight", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surface_weight_rms", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "kickoff_weight", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "kickoff_weight_rms", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_weight", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_weight_rms", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hook_load", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_axial_drag", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_axial_drag", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "string_axial_drag", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "depth_of_cut", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rate_of_penetration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "drive_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hoist_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "gravity_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "load_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "feed_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pressure_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bit_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pipe_guide_friction_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "guide_wall_friction_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "joint_friction_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "contact_damping_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rayleigh_damping_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "numerical_damping_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "string_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "axial_update_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stored_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "error_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "mud_power", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "drive_at_limit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_arrives", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Health of the twin. The sequence is its heartbeat: when it stops, the twin has stopped.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TwinStatus {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Heartbeat: one more in every message.
        pub sequence: u64,
        /// STARTING, RUNNING, PAUSED or FAILED.
        pub state: u8,
        /// Model time since the start or the last reset (s).
        pub model_time: f64,
        /// Model steps since the start or the last reset.
        pub step_count: u64,
        /// Model step (s).
        pub time_step: f64,
        /// Model time gained per second of wall time, over the last second; 1 keeps up. NaN until the model has run for a second
        /// since the start, a pause or a failed step.
        pub real_time_factor: f64,
        /// How far the model is behind its deadlines now (s, \>= 0).
        pub lateness: f64,
        /// Steps that ended after their deadline.
        pub deadline_misses: u64,
        /// Steps skipped because the model was late; those of a pause or after a failed step are in steps_stood_still.
        pub steps_skipped: u64,
        /// Median computing time of a step in the last interval (s).
        pub step_time_p50: f64,
        /// 99th percentile of the computing time of a step in the last interval (s).
        pub step_time_p99: f64,
        /// Longest computing time of a step in the last interval (s).
        pub step_time_max: f64,
        /// Mean Newton iterations per step in the last interval.
        pub newton_iterations_mean: f64,
        /// Sub-steps rejected since the start.
        pub rejected_steps: u64,
        /// Steps that were halved since the start.
        pub halved_steps: u64,
        /// Steps that failed at the smallest sub-step since the start.
        pub failed_steps: u64,
        /// Cause of the last rejection, empty if there was none.
        pub last_rejection_cause: std::string::String,
        /// Station of the last rejection, 0 is the uppermost.
        pub last_rejection_station: u32,
        /// Measured depth of that station from the kick-off (m).
        pub last_rejection_measured_depth: f64,
        /// Work put in, minus energy taken out, minus energy stored since the start (J); zero is exact.
        pub energy_error: f64,
        /// Magnitude of energy_error divided by the drive's work.
        pub energy_error_ratio: f64,
        /// RECORDING_OFF, RECORDING_ON or RECORDING_FAILED.
        pub recording_state: u8,
        /// File of the recording, empty if none.
        pub recording_path: std::string::String,
        /// Messages in the recording's files, without the newest ones that are not written yet.
        pub recording_messages: u64,
        /// Messages that the recording lost, including those in a file whose sync the disk refused.
        pub recording_drops: u64,
        /// SHA-256 of the configuration that the run began with; changed_parameter has what differs from it.
        pub config_hash: std::string::String,
        /// Version of flexdrill.
        pub version: std::string::String,
        /// Per input: rotary_speed, weight_on_bit; then rate_of_penetration and standpipe_pressure where the tool uses them, a
        /// value other than zero is assumed, or a sample arrived.
        pub input_name: Vec<std::string::String>,
        /// INPUT_NOT_RECEIVED, INPUT_OK, INPUT_SLOW, INPUT_STALE, INPUT_REJECTED or INPUT_ASSUMED.
        pub input_state: Vec<u8>,
        /// Time since the newest good sample (s), NaN if there was none.
        pub input_age: Vec<f64>,
        /// Newest sample as received, in SI (rad/s, N), NaN if there was none.
        pub input_received: Vec<f64>,
        /// Value that acts on the model, in SI (rad/s, N).
        pub input_applied: Vec<f64>,
        /// Samples refused since the start.
        pub input_rejected: Vec<u64>,
        /// Per output: topic with namespace.
        pub output_topic: Vec<std::string::String>,
        /// Messages sent since the start.
        pub output_sent: Vec<u64>,
        /// Messages lost since the start.
        pub output_dropped: Vec<u64>,
        /// Per phase of a step: its name. assembly, contact, solve, energy, analysis, snapshot and other make up the solver's
        /// time; publish is the time of encoding and sending, on another thread.
        pub phase_name: Vec<std::string::String>,
        /// Mean time per step in the last interval (s).
        pub phase_time: Vec<f64>,
        /// How far the motion can be trusted: QUALITY_GOOD, QUALITY_DEGRADED or QUALITY_POOR.
        pub model_quality: u8,
        /// Why it is not GOOD, with value and bound, or that it is not judged yet; and what it does not see: a soft guide that rings
        /// on the wall. Empty if there is nothing to say.
        pub model_quality_cause: std::string::String,
        /// Energy error of the steps over the last 10 s, magnitudes added, divided by the energy that contact, Rayleigh and
        /// numerical damping dissipated in that time; zero is exact.
        pub energy_error_share: f64,
        /// DDS: whether it is up, and how often it was restarted since the start.
        pub dds_up: bool,
        pub dds_restarts: u64,
        /// Cause of the last restart; empty if there was none.
        pub dds_restart_cause: std::string::String,
        /// Topic, node, address and id of reliable readers that did not read their samples within the last minute; empty if there
        /// are none.
        pub dds_stalled_reader: std::string::String,
        /// Other nodes on the network with the name of this one, with address and id.
        pub namesake: Vec<std::string::String>,
        /// Time by which the system clock was set since the start (s). Stamps follow the clock as it was at the start.
        pub clock_set_by: f64,
        /// Per input: the publisher that drives it, as node @ host (id of its DDS writer); empty while there is none.
        pub input_driver: Vec<std::string::String>,
        /// Per input: all publishers with a sample within its max_age, the one that drives first, separated by commas.
        pub input_publishers: Vec<std::string::String>,
        /// Per input: two or more publishers send it at once.
        pub input_several_drivers: Vec<bool>,
        /// Per input: samples refused because their publisher does not drive.
        pub input_not_driving: Vec<u64>,
        /// Per input: samples whose bytes do not match the topic's type.
        pub input_unreadable: Vec<u64>,
        /// Per input: without a good sample for so long that the model is on the ramp to the safe value, or has reached it.
        pub input_safe: Vec<bool>,
        /// Per input: source that the newest good sample names, empty if it names none.
        pub input_source: Vec<std::string::String>,
        /// Per input: the source has doubts about the newest good sample.
        pub input_suspect: Vec<bool>,
        /// Snapshots that were dropped since the start because the publisher's thread was too late: their outputs were neither
        /// sent nor recorded.
        pub frames_dropped: u64,
        /// Changes of the inputs that were lost for the same reason: a recording of this run cannot be replayed exactly.
        pub events_lost: u64,
        /// Per input: samples that arrived faster than the node read them since the start: the oldest of 256 waiting samples were
        /// dropped.
        pub input_overrun: Vec<u64>,
        /// Step in which the motion is computed: the model step, or a half or a quarter of it (s).
        pub step_in_force: f64,
        /// Step that the motion requires (s); shorter than the one in force where the machine is too slow for it.
        pub step_wanted: f64,
        /// Pace of the model relative to the clock, judged over ten seconds and with hysteresis: PACE_NOT_JUDGED, PACE_KEPT,
        /// PACE_LATE or PACE_FAR_BEHIND. Lateness concerns the computer, not drilling.
        pub pace: u8,
        /// Model time gained per second of wall time over the last ten seconds, from which pace is judged. NaN until the model
        /// has run for ten seconds.
        pub pace_factor: f64,
        /// Why messages are missing in the recording, with the count of each cause; empty if none is missing.
        pub recording_drops_cause: std::string::String,
        /// Steps during which the model stood still: paused, or after a failed step.
        pub steps_stood_still: u64,
        /// Values on which motion or alarms depend and that a client has changed since the start, each with the configured value.
        pub changed_parameter: Vec<std::string::String>,
        /// Surveys of the hole (rig/survey) that are taken into account, also those of an earlier run.
        pub surveys_known: u64,
        /// Surveys below the bit of the configuration: they wait for a run with that hole as drilled.
        pub surveys_waiting: u64,
        /// Surveys refused since the start.
        pub surveys_refused: u64,
    }

    impl TwinStatus {
        /// The tool is being brought to rest under gravity and weight on bit.
        pub const STARTING: u8 = 0;
        /// Model time advances.
        pub const RUNNING: u8 = 1;
        /// Paused by service.
        pub const PAUSED: u8 = 2;
        /// The model stands still because a step failed; reset it.
        pub const FAILED: u8 = 3;
        /// No sample has arrived yet: the twin runs on its configured start values.
        pub const INPUT_NOT_RECEIVED: u8 = 0;
        /// The newest sample is fresh.
        pub const INPUT_OK: u8 = 1;
        /// The newest sample is later than expected, but not yet stale.
        pub const INPUT_SLOW: u8 = 2;
        /// The newest sample is too old: the value is held, then brought to the safe value.
        pub const INPUT_STALE: u8 = 3;
        /// The newest sample was refused; the last good value is held.
        pub const INPUT_REJECTED: u8 = 4;
        /// An optional input of which no sample has arrived: the twin runs on its configured constant.
        pub const INPUT_ASSUMED: u8 = 5;
        /// Not recording.
        pub const RECORDING_OFF: u8 = 0;
        /// Recording to recording_path.
        pub const RECORDING_ON: u8 = 1;
        /// The recording stopped on an error; earlier messages are kept. It continues in another file as soon as the disk allows
        /// it, and is then RECORDING_ON again.
        pub const RECORDING_FAILED: u8 = 2;
        /// With such errors of the steps, runs agree with a finer step within about a tenth in ripple and forces.
        pub const QUALITY_GOOD: u8 = 0;
        /// With such errors, runs differ by more; model_quality_cause gives the reason.
        pub const QUALITY_DEGRADED: u8 = 1;
        /// With such errors, runs differ by a sixth up to several times: an alarm. The whirl analysis lowers its confidences.
        pub const QUALITY_POOR: u8 = 2;
        /// Not judged: the model has run for less than ten seconds since the start, a pause or a failed step.
        pub const PACE_NOT_JUDGED: u8 = 0;
        /// The model keeps up with the clock.
        pub const PACE_KEPT: u8 = 1;
        /// The model gains less than 0.98 s per second and skips the rest.
        pub const PACE_LATE: u8 = 2;
        /// It gains less than 0.9 s per second.
        pub const PACE_FAR_BEHIND: u8 = 3;
    }

    impl Message for TwinStatus {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "TwinStatus";
        const ROS_TYPE: &'static str = "flexdrill/msg/TwinStatus";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::TwinStatus_";
        const RIHS01: &'static str = "RIHS01_4e40095eb2946060db5c6611166b5a8f0e54eacd1aafae10f3f11ec6b8e7af39";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/TwinStatus.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/TwinStatus", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "sequence", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "state", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "model_time", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step_count", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "time_step", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "real_time_factor", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "lateness", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "deadline_misses", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "steps_skipped", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step_time_p50", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step_time_p99", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step_time_max", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "newton_iterations_mean", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rejected_steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "halved_steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failed_steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "last_rejection_cause", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "last_rejection_station", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "last_rejection_measured_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "energy_error", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "energy_error_ratio", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "recording_state", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "recording_path", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "recording_messages", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "recording_drops", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "config_hash", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "version", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_name", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_state", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_age", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_received", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_applied", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_rejected", "type": {"type_id": 153, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "output_topic", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "output_sent", "type": {"type_id": 153, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "output_dropped", "type": {"type_id": 153, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "phase_name", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "phase_time", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "model_quality", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "model_quality_cause", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "energy_error_share", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "dds_up", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "dds_restarts", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "dds_restart_cause", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "dds_stalled_reader", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "namesake", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "clock_set_by", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_driver", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_publishers", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_several_drivers", "type": {"type_id": 159, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_not_driving", "type": {"type_id": 153, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_unreadable", "type": {"type_id": 153, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_safe", "type": {"type_id": 159, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_source", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_suspect", "type": {"type_id": 159, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "frames_dropped", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "events_lost", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "input_overrun", "type": {"type_id": 153, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step_in_force", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step_wanted", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pace", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pace_factor", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "recording_drops_cause", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "steps_stood_still", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "changed_parameter", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveys_known", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveys_waiting", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "surveys_refused", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// What a look-ahead says of one candidate.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfAnswer {
        /// Which.
        pub candidate: WhatIfCandidate,
        /// Time of the way to the candidate's speed and weight, before the horizon (s); NaN where they were not reached.
        pub run_up: f64,
        /// Members that count: those up to the first number at which every alarm is decided.
        pub members: u32,
        /// Members among them whose motion could not be computed to the end. They are in no probability: what would have come is
        /// unknown, not safe.
        pub failed: u32,
        /// Why the first of these failed, or why there is no member at all; empty where none did.
        pub failure: std::string::String,
        /// Whether the members decide every alarm: a sequential test between a chance of a tenth or less and one of a half or more,
        /// with a risk of 5 % for either error.
        pub decided: bool,
        /// Chance that a member saw any alarm, with its 95 % interval (Wilson); NaN where no member ended.
        pub any_alarm: f64,
        pub any_alarm_lower: f64,
        pub any_alarm_upper: f64,
        /// The alarms that a member saw, with each priority.
        pub alarms: Vec<AlarmChance>,
        /// The continuous figures.
        pub figures: Vec<FigureBand>,
        /// Members by the worst quality of their computed motion.
        pub quality_good: u32,
        pub quality_degraded: u32,
        pub quality_poor: u32,
        /// Whether it is known. Where it is false, all below is NaN.
        pub hole_known: bool,
        /// Why it is not known, in one sentence; empty where it is.
        pub hole_because: std::string::String,
        /// Radius of the hole over the next metre, with 5 and 95 % of the plausible tools (m); infinite where it is straight.
        pub hole_radius: f64,
        pub hole_radius_low: f64,
        pub hole_radius_high: f64,
        /// Distance of the bit from the plan (well.plan.stations) at hole_plan_ahead (m); NaN without a plan that is compared.
        pub hole_plan_distance: f64,
        /// How far ahead of the bit that is: 5 m, or less where the plan ends before (m).
        pub hole_plan_ahead: f64,
        /// Plausible tools that the members are runs of, each from its own state, drawn by their weights; 0 where they are runs of
        /// the twin. A tool that is drawn again has another disturbance.
        pub tools: u32,
        /// Factors on the friction: a fifth lower and higher.
        pub friction_factors: Vec<f64>,
        /// Members with that friction, those among them that failed, and those that saw any alarm.
        pub friction_members: Vec<u32>,
        pub friction_failed: Vec<u32>,
        pub friction_any_alarm: Vec<u32>,
    }

    impl Message for WhatIfAnswer {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIfAnswer";
        const ROS_TYPE: &'static str = "flexdrill/msg/WhatIfAnswer";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::WhatIfAnswer_";
        const RIHS01: &'static str = "RIHS01_7633ba0f5873b924f2d458828a71cdba4628059df8e78088607e1b4bd17603e7";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/WhatIfAnswer.msg"),
            "================================================================================\nMSG: flexdrill/WhatIfCandidate\n",
            include_str!("../../../msg/WhatIfCandidate.msg"),
            "================================================================================\nMSG: flexdrill/AlarmChance\n",
            include_str!("../../../msg/AlarmChance.msg"),
            "================================================================================\nMSG: flexdrill/FigureBand\n",
            include_str!("../../../msg/FigureBand.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/WhatIfAnswer", "fields": [{"name": "candidate", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/WhatIfCandidate"}}, {"name": "run_up", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "members", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failed", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failure", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "decided", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "any_alarm", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "any_alarm_lower", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "any_alarm_upper", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "alarms", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/AlarmChance"}}, {"name": "figures", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/msg/FigureBand"}}, {"name": "quality_good", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "quality_degraded", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "quality_poor", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_known", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_because", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_radius", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_radius_low", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_radius_high", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_plan_distance", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "hole_plan_ahead", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "tools", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_factors", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_members", "type": {"type_id": 151, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_failed", "type": {"type_id": 151, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_any_alarm", "type": {"type_id": 151, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// A rotary speed and a weight on bit to be tried in a look-ahead.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhatIfCandidate {
        /// Rotary speed (r/min), within inputs.rotary_speed of the configuration.
        pub rotary_speed: f64,
        /// Weight on bit (kN), within inputs.weight_on_bit of the configuration.
        pub weight_on_bit: f64,
        /// How fast the speed changes on the way there (r/min per s); 0: as fast as the configuration's slew limit.
        pub speed_ramp: f64,
        /// How fast the weight changes on the way there (kN/s); 0: as fast as the configuration's slew limit.
        pub weight_ramp: f64,
    }

    impl Message for WhatIfCandidate {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhatIfCandidate";
        const ROS_TYPE: &'static str = "flexdrill/msg/WhatIfCandidate";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::WhatIfCandidate_";
        const RIHS01: &'static str = "RIHS01_b392e04faf28921ab0c566de14e41ba9c8b3166bff07086a1746ac7d13848921";
        const SCHEMA: &'static str = include_str!("../../../msg/WhatIfCandidate.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/WhatIfCandidate", "fields": [{"name": "rotary_speed", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_on_bit", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "speed_ramp", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "weight_ramp", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Whirl at every watched station. All arrays have one entry per watched station and pipe.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhirlState {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// Measured depth from the kick-off (m).
        pub measured_depth: Vec<f64>,
        /// Inclination of the bore there, 0 is straight down (rad).
        pub inclination: Vec<f64>,
        /// PIPE or GUIDE.
        pub body: Vec<u8>,
        /// NONE, FORWARD, BACKWARD, CHAOTIC or JOINT_VIBRATION.
        pub kind: Vec<u8>,
        /// Rate of the orbit (rad/s, positive in the sense of the rotation).
        pub whirl_rate: Vec<f64>,
        /// Rate of the orbit divided by the rotary speed; NaN where the motion has no single whirl rate and while the tool does
        /// not turn.
        pub whirl_ratio: Vec<f64>,
        /// Root mean square radius about the running mean (m).
        pub orbit_radius: Vec<f64>,
        /// Largest distance from the centre of the gap in the window, divided by the clearance.
        pub clearance_ratio: Vec<f64>,
        /// Share of the window in contact (0 to 1).
        pub contact_duty: Vec<f64>,
        /// Confidence in the kind (0 to 1); it is lower while an input is not OK.
        pub confidence: Vec<f64>,
        /// Level at this station: OK, WATCH, WARNING or CRITICAL of WhirlWarning.
        pub severity: Vec<u8>,
        /// Backward whirl of the driven pipe: rate divided by that of rolling without slip, - spin d / (D - d). 1 rolls, a
        /// smaller value slides, 0 is no such whirl.
        pub rolling_share: Vec<f64>,
        /// Counted turns about the centre of the gap per turn of the tool, positive in the sense of the rotation; NaN while the
        /// tool stands.
        pub gap_turns: Vec<f64>,
        /// Bending cycles per turn of the tool due to whirl of one rate; 0 elsewhere.
        pub bending_cycles: Vec<f64>,
        /// Largest impulse above the resting one in the window (N s).
        pub impulse: Vec<f64>,
        /// Impacts of at least 1 N s per second (1/s).
        pub impact_rate: Vec<f64>,
        /// Work of the friction per second and metre of the tool (W/m).
        pub friction_power: Vec<f64>,
    }

    impl WhirlState {
        /// No whirl: at rest, along a line, a small orbit off the centre of the gap, or a motion that repeats itself turn by turn
        /// without circling the centre.
        pub const NONE: u8 = 0;
        /// The orbit turns in the sense of the rotation.
        pub const FORWARD: u8 = 1;
        /// The orbit turns against the rotation.
        pub const BACKWARD: u8 = 2;
        /// Large motion without a steady direction that does not repeat itself.
        pub const CHAOTIC: u8 = 3;
        /// A small orbit at twice the tool's speed that does not circle the centre of the gap: the cross of the joint drives it.
        /// D-WIS defines the other kinds and has no term for this one.
        pub const JOINT_VIBRATION: u8 = 4;
        /// The flexible pipe.
        pub const PIPE: u8 = 0;
        /// The guide pipe.
        pub const GUIDE: u8 = 1;
    }

    impl Message for WhirlState {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhirlState";
        const ROS_TYPE: &'static str = "flexdrill/msg/WhirlState";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::WhirlState_";
        const RIHS01: &'static str = "RIHS01_ea41454404d7eff1b674ed7b75695a83fd62ec22970962b84c28b38ade72a441";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/WhirlState.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/WhirlState", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "measured_depth", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "body", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "kind", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "whirl_rate", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "whirl_ratio", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "orbit_radius", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "clearance_ratio", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "contact_duty", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "confidence", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "severity", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rolling_share", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "gap_turns", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bending_cycles", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "impulse", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "impact_rate", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "friction_power", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// The level of the whirl warning, sent when it changes. Latched: of several received messages, the one with the highest
    /// sequence is valid.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct WhirlWarning {
        /// Stamp: model time on the rig's clock. Frame: the tool.
        pub header: super::std_msgs::Header,
        /// OK, WATCH, WARNING or CRITICAL.
        pub severity: u8,
        /// NONE, FORWARD, BACKWARD, CHAOTIC or JOINT_VIBRATION.
        pub kind: u8,
        /// PIPE or GUIDE.
        pub body: u8,
        /// Measured depth from the kick-off (m).
        pub measured_depth: f64,
        /// Inclination of the bore there, 0 is straight down (rad).
        pub inclination: f64,
        /// Evidence: rate of the orbit divided by the rotary speed; NaN where there is none.
        pub whirl_ratio: f64,
        /// Evidence: largest distance from the centre of the gap, divided by the clearance.
        pub clearance_ratio: f64,
        /// Evidence: share of the window in contact (0 to 1).
        pub contact_duty: f64,
        /// Length of the window of the evidence (s).
        pub window: f64,
        /// When this level was reached, on the rig's clock.
        pub since: super::builtin_interfaces::Time,
        /// The worst state of the inputs that the tool uses: INPUT_NOT_RECEIVED, INPUT_OK, INPUT_SLOW, INPUT_STALE or
        /// INPUT_REJECTED.
        pub input_quality: u8,
        /// Number of changes so far, of the level, its station and kind, or of the trust in the inputs.
        pub sequence: u64,
        /// The warning as one sentence for an operator.
        pub message: std::string::String,
        /// Evidence: largest normal force in the window (N).
        pub peak_force: f64,
        /// Evidence: backward whirl of the driven pipe, rate divided by that of rolling without slip, - spin d / (D - d). 1
        /// rolls, a smaller value slides, 0 is no such whirl.
        pub rolling_share: f64,
        /// Confidence in the kind (0 to 1); it is lower while an input is not OK.
        pub confidence: f64,
    }

    impl WhirlWarning {
        /// No action is needed.
        pub const OK: u8 = 0;
        /// The driller should watch it.
        pub const WATCH: u8 = 1;
        /// Action is needed soon.
        pub const WARNING: u8 = 2;
        /// Action is needed now.
        pub const CRITICAL: u8 = 3;
        /// No whirl: at rest, along a line, a small orbit off the centre of the gap, or a motion that repeats itself turn by turn
        /// without circling the centre.
        pub const NONE: u8 = 0;
        /// The orbit turns in the sense of the rotation.
        pub const FORWARD: u8 = 1;
        /// The orbit turns against the rotation.
        pub const BACKWARD: u8 = 2;
        /// Large motion without a steady direction that does not repeat itself.
        pub const CHAOTIC: u8 = 3;
        /// A small orbit at twice the tool's speed that does not circle the centre of the gap: the cross of the joint drives it.
        /// D-WIS defines the other kinds and has no term for this one.
        pub const JOINT_VIBRATION: u8 = 4;
        /// The flexible pipe.
        pub const PIPE: u8 = 0;
        /// The guide pipe.
        pub const GUIDE: u8 = 1;
        /// No sample has arrived yet: the twin runs on its configured start values.
        pub const INPUT_NOT_RECEIVED: u8 = 0;
        /// The newest sample is fresh.
        pub const INPUT_OK: u8 = 1;
        /// The newest sample is later than expected, but not yet stale.
        pub const INPUT_SLOW: u8 = 2;
        /// The newest sample is too old: the value is held, then brought to the safe value.
        pub const INPUT_STALE: u8 = 3;
        /// The newest sample was refused; the last good value is held.
        pub const INPUT_REJECTED: u8 = 4;
        /// An optional input of which no sample has arrived: the twin runs on its configured constant.
        pub const INPUT_ASSUMED: u8 = 5;
    }

    impl Message for WhirlWarning {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "WhirlWarning";
        const ROS_TYPE: &'static str = "flexdrill/msg/WhirlWarning";
        const DDS_TYPE: &'static str = "flexdrill::msg::dds_::WhirlWarning_";
        const RIHS01: &'static str = "RIHS01_e126acd535b1644030bb7451f1304582f3337b6805bc5350c2870b8d9639324a";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../msg/WhirlWarning.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/msg/WhirlWarning", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "severity", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "kind", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "body", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "measured_depth", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "inclination", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "whirl_ratio", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "clearance_ratio", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "contact_duty", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "window", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "since", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "input_quality", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "sequence", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "peak_force", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "rolling_share", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "confidence", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Acknowledges an alarm on behalf of an operator.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct AcknowledgeAlarmRequest {
        /// Id of the alarm, such as backward_whirl; empty or all: every alarm that needs an acknowledgement.
        pub id: std::string::String,
        /// Name of the operator. It must not be empty.
        pub operator_name: std::string::String,
        /// Reason for the journal; it may be empty.
        pub reason: std::string::String,
    }

    impl Message for AcknowledgeAlarmRequest {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "AcknowledgeAlarm_Request";
        const ROS_TYPE: &'static str = "flexdrill/srv/AcknowledgeAlarm_Request";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::AcknowledgeAlarm_Request_";
        const RIHS01: &'static str = "RIHS01_f79a38c9120398574da69bcb97cbfea7b2a75af0eff1ed18a6f487237848290a";
        const SCHEMA: &'static str = "# Acknowledges an alarm on behalf of an operator.\n\n# Id of the alarm, such as backward_whirl; empty or all: every alarm that needs an acknowledgement.\nstring id\n# Name of the operator. It must not be empty.\nstring operator_name\n# Reason for the journal; it may be empty.\nstring reason\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/AcknowledgeAlarm_Request", "fields": [{"name": "id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "operator_name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "reason", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `flexdrill/srv/AcknowledgeAlarm_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct AcknowledgeAlarmResponse {
        /// Whether the journal has the acknowledgement.
        pub success: bool,
        /// The result, or the reason of a refusal.
        pub message: std::string::String,
    }

    impl Message for AcknowledgeAlarmResponse {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "AcknowledgeAlarm_Response";
        const ROS_TYPE: &'static str = "flexdrill/srv/AcknowledgeAlarm_Response";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::AcknowledgeAlarm_Response_";
        const RIHS01: &'static str = "RIHS01_982e6903d0b88cc10f418258bf38db0249f8a0c1b33ea6c1986541d3e1868730";
        const SCHEMA: &'static str = "# Whether the journal has the acknowledgement.\nbool success\n# The result, or the reason of a refusal.\nstring message\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/AcknowledgeAlarm_Response", "fields": [{"name": "success", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Confirms what a bridge makes of the items of a source: a person has compared its table with the rig's display.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ConfirmMappingRequest {
        /// The source as the bridge shows it: an address without its port, or a device.
        pub source: std::string::String,
        /// The mapping as the bridge shows it, the first 16 digits of a SHA-256. Another one is refused: it was not seen.
        pub mapping: std::string::String,
        /// Name of the operator. It must not be empty.
        pub operator_name: std::string::String,
    }

    impl Message for ConfirmMappingRequest {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "ConfirmMapping_Request";
        const ROS_TYPE: &'static str = "flexdrill/srv/ConfirmMapping_Request";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::ConfirmMapping_Request_";
        const RIHS01: &'static str = "RIHS01_a36c3a1723e0f0625edbceb10cdac296fe71f89e261879ec66f9d67511d705da";
        const SCHEMA: &'static str = "# Confirms what a bridge makes of the items of a source: a person has compared its table with the rig's display.\n\n# The source as the bridge shows it: an address without its port, or a device.\nstring source\n# The mapping as the bridge shows it, the first 16 digits of a SHA-256. Another one is refused: it was not seen.\nstring mapping\n# Name of the operator. It must not be empty.\nstring operator_name\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/ConfirmMapping_Request", "fields": [{"name": "source", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "mapping", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "operator_name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `flexdrill/srv/ConfirmMapping_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ConfirmMappingResponse {
        /// Whether the mapping is confirmed for this source.
        pub success: bool,
        /// The result, or the reason of a refusal.
        pub message: std::string::String,
    }

    impl Message for ConfirmMappingResponse {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "ConfirmMapping_Response";
        const ROS_TYPE: &'static str = "flexdrill/srv/ConfirmMapping_Response";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::ConfirmMapping_Response_";
        const RIHS01: &'static str = "RIHS01_2e9f1bb6d2340239168962b9639032faf18f79c3b7c43a9f38f2b70c9d01150e";
        const SCHEMA: &'static str = "# Whether the mapping is confirmed for this source.\nbool success\n# The result, or the reason of a refusal.\nstring message\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/ConfirmMapping_Response", "fields": [{"name": "success", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Shelves an alarm for a time.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ShelveAlarmRequest {
        /// Id of the alarm, such as backward_whirl.
        pub id: std::string::String,
        /// Shelves until the condition has ended, at most for the longest time of the configuration; duration is then ignored.
        pub one_shot: bool,
        /// Duration (s), at most the longest time of the configuration.
        pub duration: f64,
        /// Name of the operator. It must not be empty.
        pub operator_name: std::string::String,
        /// Reason for the journal. It must not be empty.
        pub reason: std::string::String,
    }

    impl Message for ShelveAlarmRequest {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "ShelveAlarm_Request";
        const ROS_TYPE: &'static str = "flexdrill/srv/ShelveAlarm_Request";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::ShelveAlarm_Request_";
        const RIHS01: &'static str = "RIHS01_3866739753c91bc6e370b97f9df74188b76166a9447cafc3d397eb710bf730ef";
        const SCHEMA: &'static str = "# Shelves an alarm for a time.\n\n# Id of the alarm, such as backward_whirl.\nstring id\n# Shelves until the condition has ended, at most for the longest time of the configuration; duration is then ignored.\nbool one_shot\n# Duration (s), at most the longest time of the configuration.\nfloat64 duration\n# Name of the operator. It must not be empty.\nstring operator_name\n# Reason for the journal. It must not be empty.\nstring reason\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/ShelveAlarm_Request", "fields": [{"name": "id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "one_shot", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "duration", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "operator_name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "reason", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `flexdrill/srv/ShelveAlarm_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ShelveAlarmResponse {
        /// Whether the alarm is shelved.
        pub success: bool,
        /// The end of the shelving, or the reason of a refusal.
        pub message: std::string::String,
    }

    impl Message for ShelveAlarmResponse {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "ShelveAlarm_Response";
        const ROS_TYPE: &'static str = "flexdrill/srv/ShelveAlarm_Response";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::ShelveAlarm_Response_";
        const RIHS01: &'static str = "RIHS01_08f2120785f28bfdee73a05f02403c5148f0c329cc732190381602da11261d7e";
        const SCHEMA: &'static str = "# Whether the alarm is shelved.\nbool success\n# The end of the shelving, or the reason of a refusal.\nstring message\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/ShelveAlarm_Response", "fields": [{"name": "success", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// Ends the shelving of an alarm.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct UnshelveAlarmRequest {
        /// Id of the alarm, such as backward_whirl.
        pub id: std::string::String,
        /// Name of the operator. It must not be empty.
        pub operator_name: std::string::String,
        /// Reason for the journal; it may be empty.
        pub reason: std::string::String,
    }

    impl Message for UnshelveAlarmRequest {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "UnshelveAlarm_Request";
        const ROS_TYPE: &'static str = "flexdrill/srv/UnshelveAlarm_Request";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::UnshelveAlarm_Request_";
        const RIHS01: &'static str = "RIHS01_b7d3b33cc977e3739b3e05be7729d5b4218c4542821b13bae8075ce872ff253c";
        const SCHEMA: &'static str = "# Ends the shelving of an alarm.\n\n# Id of the alarm, such as backward_whirl.\nstring id\n# Name of the operator. It must not be empty.\nstring operator_name\n# Reason for the journal; it may be empty.\nstring reason\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/UnshelveAlarm_Request", "fields": [{"name": "id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "operator_name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "reason", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `flexdrill/srv/UnshelveAlarm_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct UnshelveAlarmResponse {
        /// Whether the shelving has ended.
        pub success: bool,
        /// The result, or the reason of a refusal.
        pub message: std::string::String,
    }

    impl Message for UnshelveAlarmResponse {
        const PACKAGE: &'static str = "flexdrill";
        const NAME: &'static str = "UnshelveAlarm_Response";
        const ROS_TYPE: &'static str = "flexdrill/srv/UnshelveAlarm_Response";
        const DDS_TYPE: &'static str = "flexdrill::srv::dds_::UnshelveAlarm_Response_";
        const RIHS01: &'static str = "RIHS01_a2c420ea33db6edd380a9599a50564c47cabf1e7d292c4a15efd0ad61032f37a";
        const SCHEMA: &'static str = "# Whether the shelving has ended.\nbool success\n# The result, or the reason of a refusal.\nstring message\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "flexdrill/srv/UnshelveAlarm_Response", "fields": [{"name": "success", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `geometry_msgs`.
pub mod geometry_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `geometry_msgs/msg/Point`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Point {
        pub x: f64,
        pub y: f64,
        pub z: f64,
    }

    impl Message for Point {
        const PACKAGE: &'static str = "geometry_msgs";
        const NAME: &'static str = "Point";
        const ROS_TYPE: &'static str = "geometry_msgs/msg/Point";
        const DDS_TYPE: &'static str = "geometry_msgs::msg::dds_::Point_";
        const RIHS01: &'static str = "RIHS01_6963084842a9b04494d6b2941d11444708d892da2f4b09843b9c43f42a7f6881";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Point.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "geometry_msgs/msg/Point", "fields": [{"name": "x", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "y", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "z", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `geometry_msgs/msg/Pose`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Pose {
        pub position: Point,
        pub orientation: Quaternion,
    }

    impl Message for Pose {
        const PACKAGE: &'static str = "geometry_msgs";
        const NAME: &'static str = "Pose";
        const ROS_TYPE: &'static str = "geometry_msgs/msg/Pose";
        const DDS_TYPE: &'static str = "geometry_msgs::msg::dds_::Pose_";
        const RIHS01: &'static str = "RIHS01_d501954e9476cea2996984e812054b68026ae0bfae789d9a10b23daf35cc90fa";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Pose.msg"),
            "================================================================================\nMSG: geometry_msgs/Point\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Point.msg"),
            "================================================================================\nMSG: geometry_msgs/Quaternion\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Quaternion.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "geometry_msgs/msg/Pose", "fields": [{"name": "position", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Point"}}, {"name": "orientation", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Quaternion"}}]}"#;
    }

    /// `geometry_msgs/msg/Quaternion`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Quaternion {
        pub x: f64,
        pub y: f64,
        pub z: f64,
        pub w: f64,
    }

    impl Message for Quaternion {
        const PACKAGE: &'static str = "geometry_msgs";
        const NAME: &'static str = "Quaternion";
        const ROS_TYPE: &'static str = "geometry_msgs/msg/Quaternion";
        const DDS_TYPE: &'static str = "geometry_msgs::msg::dds_::Quaternion_";
        const RIHS01: &'static str = "RIHS01_8a765f66778c8ff7c8ab94afcc590a2ed5325a1d9a076ffff38fbce36f458684";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Quaternion.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "geometry_msgs/msg/Quaternion", "fields": [{"name": "x", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "y", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "z", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "w", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `geometry_msgs/msg/Transform`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Transform {
        pub translation: Vector3,
        pub rotation: Quaternion,
    }

    impl Message for Transform {
        const PACKAGE: &'static str = "geometry_msgs";
        const NAME: &'static str = "Transform";
        const ROS_TYPE: &'static str = "geometry_msgs/msg/Transform";
        const DDS_TYPE: &'static str = "geometry_msgs::msg::dds_::Transform_";
        const RIHS01: &'static str = "RIHS01_beb83fbe698636351461f6f35d1abb20010c43d55374d81bd041f1ba2581fddc";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Transform.msg"),
            "================================================================================\nMSG: geometry_msgs/Vector3\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Vector3.msg"),
            "================================================================================\nMSG: geometry_msgs/Quaternion\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Quaternion.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "geometry_msgs/msg/Transform", "fields": [{"name": "translation", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Vector3"}}, {"name": "rotation", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Quaternion"}}]}"#;
    }

    /// `geometry_msgs/msg/TransformStamped`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TransformStamped {
        pub header: super::std_msgs::Header,
        pub child_frame_id: std::string::String,
        pub transform: Transform,
    }

    impl Message for TransformStamped {
        const PACKAGE: &'static str = "geometry_msgs";
        const NAME: &'static str = "TransformStamped";
        const ROS_TYPE: &'static str = "geometry_msgs/msg/TransformStamped";
        const DDS_TYPE: &'static str = "geometry_msgs::msg::dds_::TransformStamped_";
        const RIHS01: &'static str = "RIHS01_0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/TransformStamped.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: geometry_msgs/Transform\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Transform.msg"),
            "================================================================================\nMSG: geometry_msgs/Vector3\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Vector3.msg"),
            "================================================================================\nMSG: geometry_msgs/Quaternion\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Quaternion.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "geometry_msgs/msg/TransformStamped", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "child_frame_id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "transform", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Transform"}}]}"#;
    }

    /// `geometry_msgs/msg/Vector3`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Vector3 {
        pub x: f64,
        pub y: f64,
        pub z: f64,
    }

    impl Message for Vector3 {
        const PACKAGE: &'static str = "geometry_msgs";
        const NAME: &'static str = "Vector3";
        const ROS_TYPE: &'static str = "geometry_msgs/msg/Vector3";
        const DDS_TYPE: &'static str = "geometry_msgs::msg::dds_::Vector3_";
        const RIHS01: &'static str = "RIHS01_cc12fe83e4c02719f1ce8070bfd14aecd40f75a96696a67a2a1f37f7dbb0765d";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Vector3.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "geometry_msgs/msg/Vector3", "fields": [{"name": "x", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "y", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "z", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `lifecycle_msgs`.
pub mod lifecycle_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `lifecycle_msgs/msg/State`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct State {
        pub id: u8,
        pub label: std::string::String,
    }

    impl State {
        pub const PRIMARY_STATE_UNKNOWN: u8 = 0;
        pub const PRIMARY_STATE_UNCONFIGURED: u8 = 1;
        pub const PRIMARY_STATE_INACTIVE: u8 = 2;
        pub const PRIMARY_STATE_ACTIVE: u8 = 3;
        pub const PRIMARY_STATE_FINALIZED: u8 = 4;
        pub const TRANSITION_STATE_CONFIGURING: u8 = 10;
        pub const TRANSITION_STATE_CLEANINGUP: u8 = 11;
        pub const TRANSITION_STATE_SHUTTINGDOWN: u8 = 12;
        pub const TRANSITION_STATE_ACTIVATING: u8 = 13;
        pub const TRANSITION_STATE_DEACTIVATING: u8 = 14;
        pub const TRANSITION_STATE_ERRORPROCESSING: u8 = 15;
    }

    impl Message for State {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "State";
        const ROS_TYPE: &'static str = "lifecycle_msgs/msg/State";
        const DDS_TYPE: &'static str = "lifecycle_msgs::msg::dds_::State_";
        const RIHS01: &'static str = "RIHS01_dd2d02b82f3ebc858e53c431b1e6e91f3ffc71436fc81d0715214ac6ee2107a0";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/State.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/msg/State", "fields": [{"name": "id", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "label", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `lifecycle_msgs/msg/Transition`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Transition {
        pub id: u8,
        pub label: std::string::String,
    }

    impl Transition {
        pub const TRANSITION_CREATE: u8 = 0;
        pub const TRANSITION_CONFIGURE: u8 = 1;
        pub const TRANSITION_CLEANUP: u8 = 2;
        pub const TRANSITION_ACTIVATE: u8 = 3;
        pub const TRANSITION_DEACTIVATE: u8 = 4;
        pub const TRANSITION_UNCONFIGURED_SHUTDOWN: u8 = 5;
        pub const TRANSITION_INACTIVE_SHUTDOWN: u8 = 6;
        pub const TRANSITION_ACTIVE_SHUTDOWN: u8 = 7;
        pub const TRANSITION_DESTROY: u8 = 8;
        pub const TRANSITION_ON_CONFIGURE_SUCCESS: u8 = 10;
        pub const TRANSITION_ON_CONFIGURE_FAILURE: u8 = 11;
        pub const TRANSITION_ON_CONFIGURE_ERROR: u8 = 12;
        pub const TRANSITION_ON_CLEANUP_SUCCESS: u8 = 20;
        pub const TRANSITION_ON_CLEANUP_FAILURE: u8 = 21;
        pub const TRANSITION_ON_CLEANUP_ERROR: u8 = 22;
        pub const TRANSITION_ON_ACTIVATE_SUCCESS: u8 = 30;
        pub const TRANSITION_ON_ACTIVATE_FAILURE: u8 = 31;
        pub const TRANSITION_ON_ACTIVATE_ERROR: u8 = 32;
        pub const TRANSITION_ON_DEACTIVATE_SUCCESS: u8 = 40;
        pub const TRANSITION_ON_DEACTIVATE_FAILURE: u8 = 41;
        pub const TRANSITION_ON_DEACTIVATE_ERROR: u8 = 42;
        pub const TRANSITION_ON_SHUTDOWN_SUCCESS: u8 = 50;
        pub const TRANSITION_ON_SHUTDOWN_FAILURE: u8 = 51;
        pub const TRANSITION_ON_SHUTDOWN_ERROR: u8 = 52;
        pub const TRANSITION_ON_ERROR_SUCCESS: u8 = 60;
        pub const TRANSITION_ON_ERROR_FAILURE: u8 = 61;
        pub const TRANSITION_ON_ERROR_ERROR: u8 = 62;
        pub const TRANSITION_CALLBACK_SUCCESS: u8 = 97;
        pub const TRANSITION_CALLBACK_FAILURE: u8 = 98;
        pub const TRANSITION_CALLBACK_ERROR: u8 = 99;
    }

    impl Message for Transition {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "Transition";
        const ROS_TYPE: &'static str = "lifecycle_msgs/msg/Transition";
        const DDS_TYPE: &'static str = "lifecycle_msgs::msg::dds_::Transition_";
        const RIHS01: &'static str = "RIHS01_c65d7b31ea134cba4f54fc867b817979be799f7452035cd35fac9b7421fb3424";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/Transition.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/msg/Transition", "fields": [{"name": "id", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "label", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `lifecycle_msgs/msg/TransitionDescription`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TransitionDescription {
        pub transition: Transition,
        pub start_state: State,
        pub goal_state: State,
    }

    impl Message for TransitionDescription {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "TransitionDescription";
        const ROS_TYPE: &'static str = "lifecycle_msgs/msg/TransitionDescription";
        const DDS_TYPE: &'static str = "lifecycle_msgs::msg::dds_::TransitionDescription_";
        const RIHS01: &'static str = "RIHS01_c5f1cd4bb1ad2ba0e3329d4ac7015c52a674a72c1faf7974c37a33f4f6048b28";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/TransitionDescription.msg"),
            "================================================================================\nMSG: lifecycle_msgs/Transition\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/Transition.msg"),
            "================================================================================\nMSG: lifecycle_msgs/State\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/State.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/msg/TransitionDescription", "fields": [{"name": "transition", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/Transition"}}, {"name": "start_state", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/State"}}, {"name": "goal_state", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/State"}}]}"#;
    }

    /// `lifecycle_msgs/msg/TransitionEvent`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TransitionEvent {
        pub timestamp: u64,
        pub transition: Transition,
        pub start_state: State,
        pub goal_state: State,
    }

    impl Message for TransitionEvent {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "TransitionEvent";
        const ROS_TYPE: &'static str = "lifecycle_msgs/msg/TransitionEvent";
        const DDS_TYPE: &'static str = "lifecycle_msgs::msg::dds_::TransitionEvent_";
        const RIHS01: &'static str = "RIHS01_d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/TransitionEvent.msg"),
            "================================================================================\nMSG: lifecycle_msgs/Transition\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/Transition.msg"),
            "================================================================================\nMSG: lifecycle_msgs/State\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/State.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/msg/TransitionEvent", "fields": [{"name": "timestamp", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "transition", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/Transition"}}, {"name": "start_state", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/State"}}, {"name": "goal_state", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/State"}}]}"#;
    }

    /// `lifecycle_msgs/srv/ChangeState_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ChangeStateRequest {
        pub transition: Transition,
    }

    impl Message for ChangeStateRequest {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "ChangeState_Request";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/ChangeState_Request";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::ChangeState_Request_";
        const RIHS01: &'static str = "RIHS01_d74c6f524e14cade7b67e7297190360ed749264af300524fc1456f27cc2a553a";
        const SCHEMA: &'static str = concat!(
            "Transition transition\n",
            "================================================================================\nMSG: lifecycle_msgs/Transition\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/Transition.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/ChangeState_Request", "fields": [{"name": "transition", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/Transition"}}]}"#;
    }

    /// `lifecycle_msgs/srv/ChangeState_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ChangeStateResponse {
        pub success: bool,
    }

    impl Message for ChangeStateResponse {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "ChangeState_Response";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/ChangeState_Response";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::ChangeState_Response_";
        const RIHS01: &'static str = "RIHS01_e1ddfed0271fefe63767aa71561926e4d9eac0f1ddf9e71a8873eb46b36deac2";
        const SCHEMA: &'static str = "bool success\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/ChangeState_Response", "fields": [{"name": "success", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `lifecycle_msgs/srv/GetAvailableStates_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetAvailableStatesRequest {
        /// Carries nothing; DDS has no empty struct.
        pub structure_needs_at_least_one_member: u8,
    }

    impl Message for GetAvailableStatesRequest {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "GetAvailableStates_Request";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/GetAvailableStates_Request";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::GetAvailableStates_Request_";
        const RIHS01: &'static str = "RIHS01_c2c0c12de6023822f284929577d4ca2862e0501150010966e8a90b632e4424de";
        const SCHEMA: &'static str = "";
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/GetAvailableStates_Request", "fields": [{"name": "structure_needs_at_least_one_member", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `lifecycle_msgs/srv/GetAvailableStates_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetAvailableStatesResponse {
        pub available_states: Vec<State>,
    }

    impl Message for GetAvailableStatesResponse {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "GetAvailableStates_Response";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/GetAvailableStates_Response";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::GetAvailableStates_Response_";
        const RIHS01: &'static str = "RIHS01_223e0dd5bb8a847ebb9532adaf8b5e2a97e6e68e79faeaabd81a45fb32925bd1";
        const SCHEMA: &'static str = concat!(
            "State[] available_states\n",
            "================================================================================\nMSG: lifecycle_msgs/State\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/State.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/GetAvailableStates_Response", "fields": [{"name": "available_states", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/State"}}]}"#;
    }

    /// `lifecycle_msgs/srv/GetAvailableTransitions_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetAvailableTransitionsRequest {
        /// Carries nothing; DDS has no empty struct.
        pub structure_needs_at_least_one_member: u8,
    }

    impl Message for GetAvailableTransitionsRequest {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "GetAvailableTransitions_Request";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/GetAvailableTransitions_Request";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::GetAvailableTransitions_Request_";
        const RIHS01: &'static str = "RIHS01_52a73c0b5d7489bee0df6ddb0aec45c41289d223ff225b58fe11d859ac8109a6";
        const SCHEMA: &'static str = "";
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Request", "fields": [{"name": "structure_needs_at_least_one_member", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `lifecycle_msgs/srv/GetAvailableTransitions_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetAvailableTransitionsResponse {
        pub available_transitions: Vec<TransitionDescription>,
    }

    impl Message for GetAvailableTransitionsResponse {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "GetAvailableTransitions_Response";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/GetAvailableTransitions_Response";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::GetAvailableTransitions_Response_";
        const RIHS01: &'static str = "RIHS01_4711339461aadf02bcfff797a198de911f885074bd3f2fe9f7b677ef87f0741c";
        const SCHEMA: &'static str = concat!(
            "TransitionDescription[] available_transitions\n",
            "================================================================================\nMSG: lifecycle_msgs/TransitionDescription\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/TransitionDescription.msg"),
            "================================================================================\nMSG: lifecycle_msgs/Transition\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/Transition.msg"),
            "================================================================================\nMSG: lifecycle_msgs/State\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/State.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Response", "fields": [{"name": "available_transitions", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/TransitionDescription"}}]}"#;
    }

    /// `lifecycle_msgs/srv/GetState_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetStateRequest {
        /// Carries nothing; DDS has no empty struct.
        pub structure_needs_at_least_one_member: u8,
    }

    impl Message for GetStateRequest {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "GetState_Request";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/GetState_Request";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::GetState_Request_";
        const RIHS01: &'static str = "RIHS01_77a9c844e7975f15bc2221e8bbebafc4d118afb78c7f7071eef91f83f940f2f6";
        const SCHEMA: &'static str = "";
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/GetState_Request", "fields": [{"name": "structure_needs_at_least_one_member", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `lifecycle_msgs/srv/GetState_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetStateResponse {
        pub current_state: State,
    }

    impl Message for GetStateResponse {
        const PACKAGE: &'static str = "lifecycle_msgs";
        const NAME: &'static str = "GetState_Response";
        const ROS_TYPE: &'static str = "lifecycle_msgs/srv/GetState_Response";
        const DDS_TYPE: &'static str = "lifecycle_msgs::srv::dds_::GetState_Response_";
        const RIHS01: &'static str = "RIHS01_fe249babab472e42cb5653b5d6a6b0c42a003b0fdfb84851aea3fde08760b4f5";
        const SCHEMA: &'static str = concat!(
            "State current_state\n",
            "================================================================================\nMSG: lifecycle_msgs/State\n",
            include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/msg/State.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "lifecycle_msgs/srv/GetState_Response", "fields": [{"name": "current_state", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/msg/State"}}]}"#;
    }
}

/// Messages of the ROS package `rcl_interfaces`.
pub mod rcl_interfaces {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `rcl_interfaces/msg/FloatingPointRange`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct FloatingPointRange {
        pub from_value: f64,
        pub to_value: f64,
        pub step: f64,
    }

    impl Message for FloatingPointRange {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "FloatingPointRange";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/FloatingPointRange";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::FloatingPointRange_";
        const RIHS01: &'static str = "RIHS01_e6af23a23c177fee5f3075c8b1e435162a9b63c863d78c06017460b49684262d";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/FloatingPointRange.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/FloatingPointRange", "fields": [{"name": "from_value", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "to_value", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/IntegerRange`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct IntegerRange {
        pub from_value: i64,
        pub to_value: i64,
        pub step: u64,
    }

    impl Message for IntegerRange {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "IntegerRange";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/IntegerRange";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::IntegerRange_";
        const RIHS01: &'static str = "RIHS01_f7b7fdc0f65f07702e099218e13288c3963bcb9345bde78b560e6cd19800fc5a";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/IntegerRange.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/IntegerRange", "fields": [{"name": "from_value", "type": {"type_id": 8, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "to_value", "type": {"type_id": 8, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "step", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/ListParametersResult`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ListParametersResult {
        pub names: Vec<std::string::String>,
        pub prefixes: Vec<std::string::String>,
    }

    impl Message for ListParametersResult {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "ListParametersResult";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/ListParametersResult";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::ListParametersResult_";
        const RIHS01: &'static str = "RIHS01_237ae3428413dcbcfb452b510c42355f3a2b021dc091afa3e18526d57022f1cd";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ListParametersResult.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/ListParametersResult", "fields": [{"name": "names", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "prefixes", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/Log`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Log {
        pub stamp: super::builtin_interfaces::Time,
        pub level: u8,
        pub name: std::string::String,
        pub msg: std::string::String,
        pub file: std::string::String,
        pub function: std::string::String,
        pub line: u32,
    }

    impl Log {
        pub const DEBUG: u8 = 10;
        pub const INFO: u8 = 20;
        pub const WARN: u8 = 30;
        pub const ERROR: u8 = 40;
        pub const FATAL: u8 = 50;
    }

    impl Message for Log {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "Log";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/Log";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::Log_";
        const RIHS01: &'static str = "RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/Log.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/Log", "fields": [{"name": "stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "level", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "msg", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "file", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "function", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "line", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/LoggerLevel`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct LoggerLevel {
        pub name: std::string::String,
        pub level: u32,
    }

    impl LoggerLevel {
        /// No logger level has been set; the parent logger decides.
        pub const LOG_LEVEL_UNKNOWN: u8 = 0;
        pub const LOG_LEVEL_DEBUG: u8 = 10;
        pub const LOG_LEVEL_INFO: u8 = 20;
        pub const LOG_LEVEL_WARN: u8 = 30;
        pub const LOG_LEVEL_ERROR: u8 = 40;
        pub const LOG_LEVEL_FATAL: u8 = 50;
    }

    impl Message for LoggerLevel {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "LoggerLevel";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/LoggerLevel";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::LoggerLevel_";
        const RIHS01: &'static str = "RIHS01_95785cc42f048ab4f395af65035aeaf2181d8e1c7a44edb8ad4558445fdb43c0";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/LoggerLevel.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/LoggerLevel", "fields": [{"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "level", "type": {"type_id": 7, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/Parameter`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Parameter {
        pub name: std::string::String,
        pub value: ParameterValue,
    }

    impl Message for Parameter {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "Parameter";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/Parameter";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::Parameter_";
        const RIHS01: &'static str = "RIHS01_ddfe6442cffc462317adb5c92536a7b6dd55858c5c3e1e328165a6b73c2831af";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/Parameter.msg"),
            "================================================================================\nMSG: rcl_interfaces/ParameterValue\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/Parameter", "fields": [{"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "value", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/ParameterValue"}}]}"#;
    }

    /// `rcl_interfaces/msg/ParameterDescriptor`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ParameterDescriptor {
        pub name: std::string::String,
        pub type_: u8,
        pub description: std::string::String,
        pub additional_constraints: std::string::String,
        pub read_only: bool,
        pub dynamic_typing: bool,
        pub floating_point_range: Vec<FloatingPointRange>,
        pub integer_range: Vec<IntegerRange>,
    }

    impl Message for ParameterDescriptor {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "ParameterDescriptor";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/ParameterDescriptor";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::ParameterDescriptor_";
        const RIHS01: &'static str = "RIHS01_52175dbfda6c51153101d33d2a9da05743f66f02d5ab2ca9ec4709b46b73d704";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterDescriptor.msg"),
            "================================================================================\nMSG: rcl_interfaces/FloatingPointRange\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/FloatingPointRange.msg"),
            "================================================================================\nMSG: rcl_interfaces/IntegerRange\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/IntegerRange.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/ParameterDescriptor", "fields": [{"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "type", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "description", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "additional_constraints", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "read_only", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "dynamic_typing", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "floating_point_range", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/FloatingPointRange"}}, {"name": "integer_range", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/IntegerRange"}}]}"#;
    }

    /// `rcl_interfaces/msg/ParameterEvent`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ParameterEvent {
        pub stamp: super::builtin_interfaces::Time,
        pub node: std::string::String,
        pub new_parameters: Vec<Parameter>,
        pub changed_parameters: Vec<Parameter>,
        pub deleted_parameters: Vec<Parameter>,
    }

    impl Message for ParameterEvent {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "ParameterEvent";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/ParameterEvent";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::ParameterEvent_";
        const RIHS01: &'static str = "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterEvent.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: rcl_interfaces/Parameter\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/Parameter.msg"),
            "================================================================================\nMSG: rcl_interfaces/ParameterValue\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/ParameterEvent", "fields": [{"name": "stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "node", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "new_parameters", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/Parameter"}}, {"name": "changed_parameters", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/Parameter"}}, {"name": "deleted_parameters", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/Parameter"}}]}"#;
    }

    /// `rcl_interfaces/msg/ParameterType`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ParameterType {
        /// Carries nothing; DDS has no empty struct.
        pub structure_needs_at_least_one_member: u8,
    }

    impl ParameterType {
        pub const PARAMETER_NOT_SET: u8 = 0;
        pub const PARAMETER_BOOL: u8 = 1;
        pub const PARAMETER_INTEGER: u8 = 2;
        pub const PARAMETER_DOUBLE: u8 = 3;
        pub const PARAMETER_STRING: u8 = 4;
        pub const PARAMETER_BYTE_ARRAY: u8 = 5;
        pub const PARAMETER_BOOL_ARRAY: u8 = 6;
        pub const PARAMETER_INTEGER_ARRAY: u8 = 7;
        pub const PARAMETER_DOUBLE_ARRAY: u8 = 8;
        pub const PARAMETER_STRING_ARRAY: u8 = 9;
    }

    impl Message for ParameterType {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "ParameterType";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/ParameterType";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::ParameterType_";
        const RIHS01: &'static str = "RIHS01_df29ed057a834862187be24dd187d981790ff3ea6502f4cd27b432cbc42c6d46";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterType.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/ParameterType", "fields": [{"name": "structure_needs_at_least_one_member", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/ParameterValue`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ParameterValue {
        pub type_: u8,
        pub bool_value: bool,
        pub integer_value: i64,
        pub double_value: f64,
        pub string_value: std::string::String,
        pub byte_array_value: Vec<u8>,
        pub bool_array_value: Vec<bool>,
        pub integer_array_value: Vec<i64>,
        pub double_array_value: Vec<f64>,
        pub string_array_value: Vec<std::string::String>,
    }

    impl Message for ParameterValue {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "ParameterValue";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/ParameterValue";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::ParameterValue_";
        const RIHS01: &'static str = "RIHS01_115fc089a387e23c7ecd3525c9189c379109119d6ab82e8dfbde0fdf6a7f9b68";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterValue.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/ParameterValue", "fields": [{"name": "type", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bool_value", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "integer_value", "type": {"type_id": 8, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "double_value", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "string_value", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "byte_array_value", "type": {"type_id": 160, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "bool_array_value", "type": {"type_id": 159, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "integer_array_value", "type": {"type_id": 152, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "double_array_value", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "string_array_value", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/SetLoggerLevelsResult`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetLoggerLevelsResult {
        pub successful: bool,
        pub reason: std::string::String,
    }

    impl Message for SetLoggerLevelsResult {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetLoggerLevelsResult";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/SetLoggerLevelsResult";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::SetLoggerLevelsResult_";
        const RIHS01: &'static str = "RIHS01_9316e5e679a5b72d2dd7fd80c539bae9e106fa0890a06dc5da3a8177a3ff6909";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/SetLoggerLevelsResult.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/SetLoggerLevelsResult", "fields": [{"name": "successful", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "reason", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/msg/SetParametersResult`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetParametersResult {
        pub successful: bool,
        pub reason: std::string::String,
    }

    impl Message for SetParametersResult {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetParametersResult";
        const ROS_TYPE: &'static str = "rcl_interfaces/msg/SetParametersResult";
        const DDS_TYPE: &'static str = "rcl_interfaces::msg::dds_::SetParametersResult_";
        const RIHS01: &'static str = "RIHS01_cfcc0fb0371ee5159b403960ef4300f8f9d2f1fd6117c8666b7f9654d528a9b1";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/SetParametersResult.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/msg/SetParametersResult", "fields": [{"name": "successful", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "reason", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/srv/DescribeParameters_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct DescribeParametersRequest {
        pub names: Vec<std::string::String>,
    }

    impl Message for DescribeParametersRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "DescribeParameters_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/DescribeParameters_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::DescribeParameters_Request_";
        const RIHS01: &'static str = "RIHS01_05dd1c2bc87dec2627105c8070d6f9725c781a4f2ab852975bf105462b82b644";
        const SCHEMA: &'static str = "string[] names\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/DescribeParameters_Request", "fields": [{"name": "names", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/srv/DescribeParameters_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct DescribeParametersResponse {
        pub descriptors: Vec<ParameterDescriptor>,
    }

    impl Message for DescribeParametersResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "DescribeParameters_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/DescribeParameters_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::DescribeParameters_Response_";
        const RIHS01: &'static str = "RIHS01_ad6747319613c6131589e062e095b469a46cc764f7d0f12a001a49e6cd893995";
        const SCHEMA: &'static str = concat!(
            "ParameterDescriptor[] descriptors\n",
            "================================================================================\nMSG: rcl_interfaces/ParameterDescriptor\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterDescriptor.msg"),
            "================================================================================\nMSG: rcl_interfaces/FloatingPointRange\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/FloatingPointRange.msg"),
            "================================================================================\nMSG: rcl_interfaces/IntegerRange\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/IntegerRange.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/DescribeParameters_Response", "fields": [{"name": "descriptors", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/ParameterDescriptor"}}]}"#;
    }

    /// `rcl_interfaces/srv/GetLoggerLevels_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetLoggerLevelsRequest {
        pub names: Vec<std::string::String>,
    }

    impl Message for GetLoggerLevelsRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "GetLoggerLevels_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/GetLoggerLevels_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::GetLoggerLevels_Request_";
        const RIHS01: &'static str = "RIHS01_490ace424a5f5b14cb4e1e95030d7fe366d8df0fd9fe4d03b44d6009504fd2cc";
        const SCHEMA: &'static str = "string[] names\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/GetLoggerLevels_Request", "fields": [{"name": "names", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/srv/GetLoggerLevels_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetLoggerLevelsResponse {
        pub levels: Vec<LoggerLevel>,
    }

    impl Message for GetLoggerLevelsResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "GetLoggerLevels_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/GetLoggerLevels_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::GetLoggerLevels_Response_";
        const RIHS01: &'static str = "RIHS01_228685d350911d213047abe756f5bf566d2f76b359c4e9fac16e5ef652aff910";
        const SCHEMA: &'static str = concat!(
            "rcl_interfaces/LoggerLevel[] levels\n",
            "================================================================================\nMSG: rcl_interfaces/LoggerLevel\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/LoggerLevel.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/GetLoggerLevels_Response", "fields": [{"name": "levels", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/LoggerLevel"}}]}"#;
    }

    /// `rcl_interfaces/srv/GetParameterTypes_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetParameterTypesRequest {
        pub names: Vec<std::string::String>,
    }

    impl Message for GetParameterTypesRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "GetParameterTypes_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/GetParameterTypes_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::GetParameterTypes_Request_";
        const RIHS01: &'static str = "RIHS01_87d7ec5ef545d4daa289d500025d31fb2437bc8b8365ca367161c4dac4be33fd";
        const SCHEMA: &'static str = "string[] names\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/GetParameterTypes_Request", "fields": [{"name": "names", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/srv/GetParameterTypes_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetParameterTypesResponse {
        pub types: Vec<u8>,
    }

    impl Message for GetParameterTypesResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "GetParameterTypes_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/GetParameterTypes_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::GetParameterTypes_Response_";
        const RIHS01: &'static str = "RIHS01_ac1335dce67c478e669434f6ac2fbff34fcd529580f272d3006785ba8b54e47f";
        const SCHEMA: &'static str = "uint8[] types\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/GetParameterTypes_Response", "fields": [{"name": "types", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/srv/GetParameters_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetParametersRequest {
        pub names: Vec<std::string::String>,
    }

    impl Message for GetParametersRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "GetParameters_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/GetParameters_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::GetParameters_Request_";
        const RIHS01: &'static str = "RIHS01_135a9e1c3d7cebef792f6687d7ddf99949b21a0bd9a320d863a9110a3f5cf4d6";
        const SCHEMA: &'static str = "string[] names\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/GetParameters_Request", "fields": [{"name": "names", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/srv/GetParameters_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetParametersResponse {
        pub values: Vec<ParameterValue>,
    }

    impl Message for GetParametersResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "GetParameters_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/GetParameters_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::GetParameters_Response_";
        const RIHS01: &'static str = "RIHS01_9fa773b46e39cc5d02db6224d8fd520bb9caeeffc2b27c96c1e59431baba9f2a";
        const SCHEMA: &'static str = concat!(
            "ParameterValue[] values\n",
            "================================================================================\nMSG: rcl_interfaces/ParameterValue\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/GetParameters_Response", "fields": [{"name": "values", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/ParameterValue"}}]}"#;
    }

    /// `rcl_interfaces/srv/ListParameters_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ListParametersRequest {
        pub prefixes: Vec<std::string::String>,
        pub depth: u64,
    }

    impl ListParametersRequest {
        pub const DEPTH_RECURSIVE: u64 = 0;
    }

    impl Message for ListParametersRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "ListParameters_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/ListParameters_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::ListParameters_Request_";
        const RIHS01: &'static str = "RIHS01_a1b0b5d6b967a5b8ac5bc8563c3ea678f349e312a6a4967227c5a96bc5ce38df";
        const SCHEMA: &'static str = "uint64 DEPTH_RECURSIVE = 0\nstring[] prefixes\nuint64 depth\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/ListParameters_Request", "fields": [{"name": "prefixes", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "depth", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `rcl_interfaces/srv/ListParameters_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ListParametersResponse {
        pub result: ListParametersResult,
    }

    impl Message for ListParametersResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "ListParameters_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/ListParameters_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::ListParameters_Response_";
        const RIHS01: &'static str = "RIHS01_31b937b82de3612426be79f231e386259f97e8dc843e3f2845288b4bfa296bdd";
        const SCHEMA: &'static str = concat!(
            "ListParametersResult result\n",
            "================================================================================\nMSG: rcl_interfaces/ListParametersResult\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ListParametersResult.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/ListParameters_Response", "fields": [{"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/ListParametersResult"}}]}"#;
    }

    /// `rcl_interfaces/srv/SetLoggerLevels_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetLoggerLevelsRequest {
        pub levels: Vec<LoggerLevel>,
    }

    impl Message for SetLoggerLevelsRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetLoggerLevels_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/SetLoggerLevels_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::SetLoggerLevels_Request_";
        const RIHS01: &'static str = "RIHS01_4e7768e0f4c749205f35bc05449f83fad18c42de52c16b1934d66c2f68ffd862";
        const SCHEMA: &'static str = concat!(
            "rcl_interfaces/LoggerLevel[] levels\n",
            "================================================================================\nMSG: rcl_interfaces/LoggerLevel\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/LoggerLevel.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/SetLoggerLevels_Request", "fields": [{"name": "levels", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/LoggerLevel"}}]}"#;
    }

    /// `rcl_interfaces/srv/SetLoggerLevels_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetLoggerLevelsResponse {
        pub results: Vec<SetLoggerLevelsResult>,
    }

    impl Message for SetLoggerLevelsResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetLoggerLevels_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/SetLoggerLevels_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::SetLoggerLevels_Response_";
        const RIHS01: &'static str = "RIHS01_ba51739027e57cb9120015737f4618579684047d862b2b16a76bc399d987d6d3";
        const SCHEMA: &'static str = concat!(
            "rcl_interfaces/SetLoggerLevelsResult[] results\n",
            "================================================================================\nMSG: rcl_interfaces/SetLoggerLevelsResult\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/SetLoggerLevelsResult.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/SetLoggerLevels_Response", "fields": [{"name": "results", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/SetLoggerLevelsResult"}}]}"#;
    }

    /// `rcl_interfaces/srv/SetParametersAtomically_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetParametersAtomicallyRequest {
        pub parameters: Vec<Parameter>,
    }

    impl Message for SetParametersAtomicallyRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetParametersAtomically_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/SetParametersAtomically_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::SetParametersAtomically_Request_";
        const RIHS01: &'static str = "RIHS01_db0bd950ed5ed867a0e90b225e44dea382d762c0762ff3e0ee842190042a59e5";
        const SCHEMA: &'static str = concat!(
            "Parameter[] parameters\n",
            "================================================================================\nMSG: rcl_interfaces/Parameter\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/Parameter.msg"),
            "================================================================================\nMSG: rcl_interfaces/ParameterValue\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/SetParametersAtomically_Request", "fields": [{"name": "parameters", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/Parameter"}}]}"#;
    }

    /// `rcl_interfaces/srv/SetParametersAtomically_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetParametersAtomicallyResponse {
        pub result: SetParametersResult,
    }

    impl Message for SetParametersAtomicallyResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetParametersAtomically_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/SetParametersAtomically_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::SetParametersAtomically_Response_";
        const RIHS01: &'static str = "RIHS01_31b1a38c5b0b9d893ee24da45f69638f4561c78461d82d52750f429b534502b8";
        const SCHEMA: &'static str = concat!(
            "SetParametersResult result\n",
            "================================================================================\nMSG: rcl_interfaces/SetParametersResult\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/SetParametersResult.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/SetParametersAtomically_Response", "fields": [{"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/SetParametersResult"}}]}"#;
    }

    /// `rcl_interfaces/srv/SetParameters_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetParametersRequest {
        pub parameters: Vec<Parameter>,
    }

    impl Message for SetParametersRequest {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetParameters_Request";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/SetParameters_Request";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::SetParameters_Request_";
        const RIHS01: &'static str = "RIHS01_130d46386b7e84ea9ecf60608a4d83cbe5e5cb7c6cc5b712b7a4e3a6c254e932";
        const SCHEMA: &'static str = concat!(
            "Parameter[] parameters\n",
            "================================================================================\nMSG: rcl_interfaces/Parameter\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/Parameter.msg"),
            "================================================================================\nMSG: rcl_interfaces/ParameterValue\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/ParameterValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/SetParameters_Request", "fields": [{"name": "parameters", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/Parameter"}}]}"#;
    }

    /// `rcl_interfaces/srv/SetParameters_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetParametersResponse {
        pub results: Vec<SetParametersResult>,
    }

    impl Message for SetParametersResponse {
        const PACKAGE: &'static str = "rcl_interfaces";
        const NAME: &'static str = "SetParameters_Response";
        const ROS_TYPE: &'static str = "rcl_interfaces/srv/SetParameters_Response";
        const DDS_TYPE: &'static str = "rcl_interfaces::srv::dds_::SetParameters_Response_";
        const RIHS01: &'static str = "RIHS01_7a0e8140a0b8d98308fa81a5403a766e610af29a239caf54b7553227906fc266";
        const SCHEMA: &'static str = concat!(
            "SetParametersResult[] results\n",
            "================================================================================\nMSG: rcl_interfaces/SetParametersResult\n",
            include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/msg/SetParametersResult.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rcl_interfaces/srv/SetParameters_Response", "fields": [{"name": "results", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/msg/SetParametersResult"}}]}"#;
    }
}

/// Messages of the ROS package `rosgraph_msgs`.
pub mod rosgraph_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `rosgraph_msgs/msg/Clock`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Clock {
        pub clock: super::builtin_interfaces::Time,
    }

    impl Message for Clock {
        const PACKAGE: &'static str = "rosgraph_msgs";
        const NAME: &'static str = "Clock";
        const ROS_TYPE: &'static str = "rosgraph_msgs/msg/Clock";
        const DDS_TYPE: &'static str = "rosgraph_msgs::msg::dds_::Clock_";
        const RIHS01: &'static str = "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/rosgraph_msgs/msg/Clock.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "rosgraph_msgs/msg/Clock", "fields": [{"name": "clock", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}]}"#;
    }
}

/// Messages of the ROS package `sensor_msgs`.
pub mod sensor_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `sensor_msgs/msg/CompressedImage`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct CompressedImage {
        pub header: super::std_msgs::Header,
        pub format: std::string::String,
        pub data: Vec<u8>,
    }

    impl Message for CompressedImage {
        const PACKAGE: &'static str = "sensor_msgs";
        const NAME: &'static str = "CompressedImage";
        const ROS_TYPE: &'static str = "sensor_msgs/msg/CompressedImage";
        const DDS_TYPE: &'static str = "sensor_msgs::msg::dds_::CompressedImage_";
        const RIHS01: &'static str = "RIHS01_15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/sensor_msgs/msg/CompressedImage.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "sensor_msgs/msg/CompressedImage", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "format", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "data", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `sensor_msgs/msg/JointState`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct JointState {
        pub header: super::std_msgs::Header,
        pub name: Vec<std::string::String>,
        pub position: Vec<f64>,
        pub velocity: Vec<f64>,
        pub effort: Vec<f64>,
    }

    impl Message for JointState {
        const PACKAGE: &'static str = "sensor_msgs";
        const NAME: &'static str = "JointState";
        const ROS_TYPE: &'static str = "sensor_msgs/msg/JointState";
        const DDS_TYPE: &'static str = "sensor_msgs::msg::dds_::JointState_";
        const RIHS01: &'static str = "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/sensor_msgs/msg/JointState.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "sensor_msgs/msg/JointState", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "name", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "position", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "velocity", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "effort", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `service_msgs`.
pub mod service_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// What every event of a service carries.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ServiceEventInfo {
        /// One of the above.
        pub event_type: u8,
        /// When it was sent or received.
        pub stamp: super::builtin_interfaces::Time,
        /// Of the client that asked, unique within its session.
        pub client_gid: [u8; 16],
        /// Of the request, unique for the client.
        pub sequence_number: i64,
    }

    impl ServiceEventInfo {
        pub const REQUEST_SENT: u8 = 0;
        pub const REQUEST_RECEIVED: u8 = 1;
        pub const RESPONSE_SENT: u8 = 2;
        pub const RESPONSE_RECEIVED: u8 = 3;
    }

    impl Message for ServiceEventInfo {
        const PACKAGE: &'static str = "service_msgs";
        const NAME: &'static str = "ServiceEventInfo";
        const ROS_TYPE: &'static str = "service_msgs/msg/ServiceEventInfo";
        const DDS_TYPE: &'static str = "service_msgs::msg::dds_::ServiceEventInfo_";
        const RIHS01: &'static str = "RIHS01_41bcbbe07a75c9b52bc96bfd5c24d7f0fc0a08c0cb7921b3373c5732345a6f45";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/service_msgs/msg/ServiceEventInfo.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "service_msgs/msg/ServiceEventInfo", "fields": [{"name": "event_type", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "client_gid", "type": {"type_id": 51, "capacity": 16, "string_capacity": 0, "nested_type_name": ""}}, {"name": "sequence_number", "type": {"type_id": 8, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `simulation_interfaces`.
pub mod simulation_interfaces {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `simulation_interfaces/action/SimulateSteps_Feedback`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsFeedback {
        pub completed_steps: u64,
        pub remaining_steps: u64,
    }

    impl Message for SimulateStepsFeedback {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_Feedback";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_Feedback";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_Feedback_";
        const RIHS01: &'static str = "RIHS01_735661ca01115eb9bca068c3f2cb79bd790cd46962317ce7ee9081a5915c9a77";
        const SCHEMA: &'static str = "uint64 completed_steps\nuint64 remaining_steps\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_Feedback", "fields": [{"name": "completed_steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "remaining_steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/action/SimulateSteps_FeedbackMessage`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsFeedbackMessage {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub feedback: SimulateStepsFeedback,
    }

    impl Message for SimulateStepsFeedbackMessage {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_FeedbackMessage";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_FeedbackMessage";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_FeedbackMessage_";
        const RIHS01: &'static str = "RIHS01_a30dee7ee7380769e616406ec5067b238aa2b27e1dbd7a5957fba1d908d7754d";
        const SCHEMA: &'static str = concat!(
            "unique_identifier_msgs/UUID goal_id\nsimulation_interfaces/SimulateSteps_Feedback feedback\n",
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: simulation_interfaces/SimulateSteps_Feedback\n",
            "uint64 completed_steps\nuint64 remaining_steps\n",
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_FeedbackMessage", "fields": [{"name": "goal_id", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "unique_identifier_msgs/msg/UUID"}}, {"name": "feedback", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_Feedback"}}]}"#;
    }

    /// `simulation_interfaces/action/SimulateSteps_GetResult_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsGetResultRequest {
        pub goal_id: super::unique_identifier_msgs::UUID,
    }

    impl Message for SimulateStepsGetResultRequest {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_GetResult_Request";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_GetResult_Request";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_GetResult_Request_";
        const RIHS01: &'static str = "RIHS01_4591b0bfbcb881003bbd46a2acebcaddceb977e5352905218688ce5ed051fdeb";
        const SCHEMA: &'static str = concat!(
            "unique_identifier_msgs/UUID goal_id\n",
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Request", "fields": [{"name": "goal_id", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "unique_identifier_msgs/msg/UUID"}}]}"#;
    }

    /// `simulation_interfaces/action/SimulateSteps_GetResult_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsGetResultResponse {
        pub status: i8,
        pub result: SimulateStepsResult,
    }

    impl Message for SimulateStepsGetResultResponse {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_GetResult_Response";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_GetResult_Response";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_GetResult_Response_";
        const RIHS01: &'static str = "RIHS01_5658172e771cb145a986a8ef4c2b80b5407b741038453b8539e35bed5ff23207";
        const SCHEMA: &'static str = concat!(
            "int8 status\nsimulation_interfaces/SimulateSteps_Result result\n",
            "================================================================================\nMSG: simulation_interfaces/SimulateSteps_Result\n",
            "Result result\n",
            "================================================================================\nMSG: simulation_interfaces/Result\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/Result.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Response", "fields": [{"name": "status", "type": {"type_id": 2, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_Result"}}]}"#;
    }

    /// `simulation_interfaces/action/SimulateSteps_Goal`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsGoal {
        pub steps: u64,
    }

    impl Message for SimulateStepsGoal {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_Goal";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_Goal";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_Goal_";
        const RIHS01: &'static str = "RIHS01_3f02c5df1dcdc7c08efee7f47c953c42c11686e0df8f8bbfb2d7e901f0d440d2";
        const SCHEMA: &'static str = "uint64 steps\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_Goal", "fields": [{"name": "steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/action/SimulateSteps_Result`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsResult {
        pub result: Result,
    }

    impl Message for SimulateStepsResult {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_Result";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_Result";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_Result_";
        const RIHS01: &'static str = "RIHS01_a1384eaee4ca7ae9238e612dfe26939dd0922cae664be1b5886cf773718823dc";
        const SCHEMA: &'static str = concat!(
            "Result result\n",
            "================================================================================\nMSG: simulation_interfaces/Result\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/Result.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_Result", "fields": [{"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/Result"}}]}"#;
    }

    /// `simulation_interfaces/action/SimulateSteps_SendGoal_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsSendGoalRequest {
        pub goal_id: super::unique_identifier_msgs::UUID,
        pub goal: SimulateStepsGoal,
    }

    impl Message for SimulateStepsSendGoalRequest {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_SendGoal_Request";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_SendGoal_Request";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_SendGoal_Request_";
        const RIHS01: &'static str = "RIHS01_275e6fd2fafc5d33dcdc83bdea6de5cf29f30b9df74a3b9514a8c5d501fd0fe3";
        const SCHEMA: &'static str = concat!(
            "unique_identifier_msgs/UUID goal_id\nsimulation_interfaces/SimulateSteps_Goal goal\n",
            "================================================================================\nMSG: unique_identifier_msgs/UUID\n",
            include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg"),
            "================================================================================\nMSG: simulation_interfaces/SimulateSteps_Goal\n",
            "uint64 steps\n",
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Request", "fields": [{"name": "goal_id", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "unique_identifier_msgs/msg/UUID"}}, {"name": "goal", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_Goal"}}]}"#;
    }

    /// `simulation_interfaces/action/SimulateSteps_SendGoal_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulateStepsSendGoalResponse {
        pub accepted: bool,
        pub stamp: super::builtin_interfaces::Time,
    }

    impl Message for SimulateStepsSendGoalResponse {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulateSteps_SendGoal_Response";
        const ROS_TYPE: &'static str = "simulation_interfaces/action/SimulateSteps_SendGoal_Response";
        const DDS_TYPE: &'static str = "simulation_interfaces::action::dds_::SimulateSteps_SendGoal_Response_";
        const RIHS01: &'static str = "RIHS01_755f44a68d1e8d116f50dfed7ab30a140137fb71ad59eca4851d55abe2b3d4c2";
        const SCHEMA: &'static str = concat!(
            "bool accepted\nbuiltin_interfaces/Time stamp\n",
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Response", "fields": [{"name": "accepted", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}]}"#;
    }

    /// `simulation_interfaces/msg/Result`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Result {
        /// One of the codes above, or one from 101 on that the service defines.
        pub result: u8,
        pub error_message: std::string::String,
    }

    impl Result {
        /// The interface is not offered, or not with these arguments.
        pub const RESULT_FEATURE_UNSUPPORTED: u8 = 0;
        pub const RESULT_OK: u8 = 1;
        pub const RESULT_NOT_FOUND: u8 = 2;
        /// The simulator is in a state in which the request cannot be carried out.
        pub const RESULT_INCORRECT_STATE: u8 = 3;
        /// The request failed; error_message has the reason.
        pub const RESULT_OPERATION_FAILED: u8 = 4;
    }

    impl Message for Result {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "Result";
        const ROS_TYPE: &'static str = "simulation_interfaces/msg/Result";
        const DDS_TYPE: &'static str = "simulation_interfaces::msg::dds_::Result_";
        const RIHS01: &'static str = "RIHS01_cf43a306adff3337a0a47143d8f5689933bc70a30478f13b077dc1fe3bc5ad17";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/Result.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/msg/Result", "fields": [{"name": "result", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "error_message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/msg/SimulationState`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulationState {
        pub state: u8,
    }

    impl SimulationState {
        /// At its start, and paused.
        pub const STATE_STOPPED: u8 = 0;
        pub const STATE_PLAYING: u8 = 1;
        pub const STATE_PAUSED: u8 = 2;
        pub const STATE_QUITTING: u8 = 3;
        pub const STATE_NO_WORLD: u8 = 4;
        pub const STATE_LOADING_WORLD: u8 = 5;
    }

    impl Message for SimulationState {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulationState";
        const ROS_TYPE: &'static str = "simulation_interfaces/msg/SimulationState";
        const DDS_TYPE: &'static str = "simulation_interfaces::msg::dds_::SimulationState_";
        const RIHS01: &'static str = "RIHS01_bb9f87ccdd98fba113052a512d9801e84ce732d0a2b3c2b0cb281828de36e415";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/SimulationState.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/msg/SimulationState", "fields": [{"name": "state", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/msg/SimulatorFeatures`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SimulatorFeatures {
        /// Of the constants above.
        pub features: Vec<u16>,
        /// Formats of what may be spawned.
        pub spawn_formats: Vec<std::string::String>,
        pub custom_info: std::string::String,
    }

    impl SimulatorFeatures {
        pub const SPAWNING: u8 = 0;
        pub const DELETING: u8 = 1;
        pub const NAMED_POSES: u8 = 2;
        pub const POSE_BOUNDS: u8 = 3;
        pub const ENTITY_TAGS: u8 = 4;
        pub const ENTITY_BOUNDS: u8 = 5;
        pub const ENTITY_BOUNDS_BOX: u8 = 6;
        pub const ENTITY_BOUNDS_CONVEX: u8 = 7;
        pub const ENTITY_CATEGORIES: u8 = 8;
        pub const SPAWNING_RESOURCE_STRING: u8 = 9;
        pub const ENTITY_STATE_GETTING: u8 = 10;
        pub const ENTITY_STATE_SETTING: u8 = 11;
        pub const ENTITY_INFO_GETTING: u8 = 12;
        pub const ENTITY_INFO_SETTING: u8 = 13;
        pub const SPAWNABLES: u8 = 14;
        pub const SIMULATION_RESET: u8 = 20;
        pub const SIMULATION_RESET_TIME: u8 = 21;
        pub const SIMULATION_RESET_STATE: u8 = 22;
        pub const SIMULATION_RESET_SPAWNED: u8 = 23;
        pub const SIMULATION_STATE_GETTING: u8 = 24;
        pub const SIMULATION_STATE_SETTING: u8 = 25;
        pub const SIMULATION_STATE_PAUSE: u8 = 26;
        pub const STEP_SIMULATION_SINGLE: u8 = 31;
        pub const STEP_SIMULATION_MULTIPLE: u8 = 32;
        pub const STEP_SIMULATION_ACTION: u8 = 33;
        pub const WORLD_LOADING: u8 = 40;
        pub const WORLD_RESOURCE_STRING: u8 = 41;
        pub const WORLD_TAGS: u8 = 42;
        pub const WORLD_UNLOADING: u8 = 43;
        pub const WORLD_INFO_GETTING: u8 = 44;
        pub const AVAILABLE_WORLDS: u8 = 45;
        pub const SPAWNING_ENTITIES: u8 = 50;
    }

    impl Message for SimulatorFeatures {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SimulatorFeatures";
        const ROS_TYPE: &'static str = "simulation_interfaces/msg/SimulatorFeatures";
        const DDS_TYPE: &'static str = "simulation_interfaces::msg::dds_::SimulatorFeatures_";
        const RIHS01: &'static str = "RIHS01_8b101c8529bc0ea3dcf056078254768f39832b9ef0adaf93bd5cea96c0de3305";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/SimulatorFeatures.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/msg/SimulatorFeatures", "fields": [{"name": "features", "type": {"type_id": 149, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "spawn_formats", "type": {"type_id": 161, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "custom_info", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/srv/GetSimulationState_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetSimulationStateRequest {
        /// Carries nothing; DDS has no empty struct.
        pub structure_needs_at_least_one_member: u8,
    }

    impl Message for GetSimulationStateRequest {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "GetSimulationState_Request";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/GetSimulationState_Request";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::GetSimulationState_Request_";
        const RIHS01: &'static str = "RIHS01_c6d65bc5c0a95ca2886bc57f146f803e01722c84ddb5acd5f32a4417f55eecfb";
        const SCHEMA: &'static str = "";
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/GetSimulationState_Request", "fields": [{"name": "structure_needs_at_least_one_member", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/srv/GetSimulationState_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetSimulationStateResponse {
        pub state: SimulationState,
        pub result: Result,
    }

    impl Message for GetSimulationStateResponse {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "GetSimulationState_Response";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/GetSimulationState_Response";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::GetSimulationState_Response_";
        const RIHS01: &'static str = "RIHS01_dc80ce852a5ab04c2b23cdd47910cee1bcc46e0f1931cac85825e6916b15517f";
        const SCHEMA: &'static str = concat!(
            "SimulationState state\nResult result\n",
            "================================================================================\nMSG: simulation_interfaces/SimulationState\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/SimulationState.msg"),
            "================================================================================\nMSG: simulation_interfaces/Result\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/Result.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/GetSimulationState_Response", "fields": [{"name": "state", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/SimulationState"}}, {"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/Result"}}]}"#;
    }

    /// `simulation_interfaces/srv/GetSimulatorFeatures_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetSimulatorFeaturesRequest {
        /// Carries nothing; DDS has no empty struct.
        pub structure_needs_at_least_one_member: u8,
    }

    impl Message for GetSimulatorFeaturesRequest {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "GetSimulatorFeatures_Request";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/GetSimulatorFeatures_Request";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::GetSimulatorFeatures_Request_";
        const RIHS01: &'static str = "RIHS01_982b8c1adef1d556f6ecdc019d1269fc39413626a9222d73b4fc874bd798b7db";
        const SCHEMA: &'static str = "";
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Request", "fields": [{"name": "structure_needs_at_least_one_member", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/srv/GetSimulatorFeatures_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetSimulatorFeaturesResponse {
        pub features: SimulatorFeatures,
    }

    impl Message for GetSimulatorFeaturesResponse {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "GetSimulatorFeatures_Response";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/GetSimulatorFeatures_Response";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::GetSimulatorFeatures_Response_";
        const RIHS01: &'static str = "RIHS01_ede4dc8227cbb2f86a24612c999dcaa67d17dab21dab566cefdc233e7a2a65d1";
        const SCHEMA: &'static str = concat!(
            "SimulatorFeatures features\n",
            "================================================================================\nMSG: simulation_interfaces/SimulatorFeatures\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/SimulatorFeatures.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Response", "fields": [{"name": "features", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/SimulatorFeatures"}}]}"#;
    }

    /// `simulation_interfaces/srv/ResetSimulation_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ResetSimulationRequest {
        /// Bits of the constants above.
        pub scope: u8,
    }

    impl ResetSimulationRequest {
        /// All.
        pub const SCOPE_DEFAULT: u8 = 0;
        pub const SCOPE_TIME: u8 = 1;
        pub const SCOPE_STATE: u8 = 2;
        pub const SCOPE_SPAWNED: u8 = 4;
        pub const SCOPE_ALL: u8 = 255;
    }

    impl Message for ResetSimulationRequest {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "ResetSimulation_Request";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/ResetSimulation_Request";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::ResetSimulation_Request_";
        const RIHS01: &'static str = "RIHS01_2c766d09c3aa30f01fadc55a42fd760b63db358c7d1d3b6a64ea9978225ffbc7";
        const SCHEMA: &'static str = "# All.\nuint8 SCOPE_DEFAULT = 0\nuint8 SCOPE_TIME = 1\nuint8 SCOPE_STATE = 2\nuint8 SCOPE_SPAWNED = 4\nuint8 SCOPE_ALL = 255\n\n# Bits of the constants above.\nuint8 scope\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/ResetSimulation_Request", "fields": [{"name": "scope", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `simulation_interfaces/srv/ResetSimulation_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ResetSimulationResponse {
        pub result: Result,
    }

    impl Message for ResetSimulationResponse {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "ResetSimulation_Response";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/ResetSimulation_Response";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::ResetSimulation_Response_";
        const RIHS01: &'static str = "RIHS01_718428121e0f1755720878d3c28f1688da7581ee5a5d56d26d10d941a28a50a0";
        const SCHEMA: &'static str = concat!(
            "Result result\n",
            "================================================================================\nMSG: simulation_interfaces/Result\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/Result.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/ResetSimulation_Response", "fields": [{"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/Result"}}]}"#;
    }

    /// `simulation_interfaces/srv/SetSimulationState_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetSimulationStateRequest {
        pub state: SimulationState,
    }

    impl Message for SetSimulationStateRequest {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SetSimulationState_Request";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/SetSimulationState_Request";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::SetSimulationState_Request_";
        const RIHS01: &'static str = "RIHS01_73283477d36ba619db2ac37a3e599077ca244502c9d8ca2a7183afcb2224f476";
        const SCHEMA: &'static str = concat!(
            "SimulationState state\n",
            "================================================================================\nMSG: simulation_interfaces/SimulationState\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/SimulationState.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/SetSimulationState_Request", "fields": [{"name": "state", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/SimulationState"}}]}"#;
    }

    /// `simulation_interfaces/srv/SetSimulationState_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetSimulationStateResponse {
        pub result: Result,
    }

    impl SetSimulationStateResponse {
        pub const ALREADY_IN_TARGET_STATE: u8 = 101;
        pub const STATE_TRANSITION_ERROR: u8 = 102;
        pub const INCORRECT_TRANSITION: u8 = 103;
    }

    impl Message for SetSimulationStateResponse {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "SetSimulationState_Response";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/SetSimulationState_Response";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::SetSimulationState_Response_";
        const RIHS01: &'static str = "RIHS01_6351aebf2bbf06e2993977918b944240f7403b532a9e4a344c53e71a56afd174";
        const SCHEMA: &'static str = concat!(
            "uint8 ALREADY_IN_TARGET_STATE = 101\nuint8 STATE_TRANSITION_ERROR = 102\nuint8 INCORRECT_TRANSITION = 103\nResult result\n",
            "================================================================================\nMSG: simulation_interfaces/Result\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/Result.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/SetSimulationState_Response", "fields": [{"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/Result"}}]}"#;
    }

    /// `simulation_interfaces/srv/StepSimulation_Request`.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    pub struct StepSimulationRequest {
        pub steps: u64,
    }

    impl Default for StepSimulationRequest {
        fn default() -> Self {
            Self {
                steps: 1,
            }
        }
    }

    impl Message for StepSimulationRequest {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "StepSimulation_Request";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/StepSimulation_Request";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::StepSimulation_Request_";
        const RIHS01: &'static str = "RIHS01_cda33f6887815f3dce0f90e61fd8efd39bda13ae264ddede15c33fbad890630e";
        const SCHEMA: &'static str = "uint64 steps 1\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/StepSimulation_Request", "fields": [{"name": "steps", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}, "default_value": "1"}]}"#;
    }

    /// `simulation_interfaces/srv/StepSimulation_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct StepSimulationResponse {
        pub result: Result,
    }

    impl Message for StepSimulationResponse {
        const PACKAGE: &'static str = "simulation_interfaces";
        const NAME: &'static str = "StepSimulation_Response";
        const ROS_TYPE: &'static str = "simulation_interfaces/srv/StepSimulation_Response";
        const DDS_TYPE: &'static str = "simulation_interfaces::srv::dds_::StepSimulation_Response_";
        const RIHS01: &'static str = "RIHS01_5b4acf2d0ce7c3fc125d0bef2acb9b5a81377e80db6b696b81beeffb9824fb5c";
        const SCHEMA: &'static str = concat!(
            "Result result\n",
            "================================================================================\nMSG: simulation_interfaces/Result\n",
            include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/msg/Result.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "simulation_interfaces/srv/StepSimulation_Response", "fields": [{"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/msg/Result"}}]}"#;
    }
}

/// Messages of the ROS package `std_msgs`.
pub mod std_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `std_msgs/msg/ColorRGBA`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct ColorRGBA {
        pub r: f32,
        pub g: f32,
        pub b: f32,
        pub a: f32,
    }

    impl Message for ColorRGBA {
        const PACKAGE: &'static str = "std_msgs";
        const NAME: &'static str = "ColorRGBA";
        const ROS_TYPE: &'static str = "std_msgs/msg/ColorRGBA";
        const DDS_TYPE: &'static str = "std_msgs::msg::dds_::ColorRGBA_";
        const RIHS01: &'static str = "RIHS01_77a7a5b9ae477306097665106e0413ba74440245b1f3d0c6d6405fe5c7813fe8";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/ColorRGBA.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "std_msgs/msg/ColorRGBA", "fields": [{"name": "r", "type": {"type_id": 10, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "g", "type": {"type_id": 10, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "b", "type": {"type_id": 10, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "a", "type": {"type_id": 10, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `std_msgs/msg/Float64`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Float64 {
        pub data: f64,
    }

    impl Message for Float64 {
        const PACKAGE: &'static str = "std_msgs";
        const NAME: &'static str = "Float64";
        const ROS_TYPE: &'static str = "std_msgs/msg/Float64";
        const DDS_TYPE: &'static str = "std_msgs::msg::dds_::Float64_";
        const RIHS01: &'static str = "RIHS01_705ba9c3d1a09df43737eb67095534de36fd426c0587779bda2bc51fe790182a";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Float64.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "std_msgs/msg/Float64", "fields": [{"name": "data", "type": {"type_id": 11, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `std_msgs/msg/Header`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Header {
        pub stamp: super::builtin_interfaces::Time,
        pub frame_id: std::string::String,
    }

    impl Message for Header {
        const PACKAGE: &'static str = "std_msgs";
        const NAME: &'static str = "Header";
        const ROS_TYPE: &'static str = "std_msgs/msg/Header";
        const DDS_TYPE: &'static str = "std_msgs::msg::dds_::Header_";
        const RIHS01: &'static str = "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "std_msgs/msg/Header", "fields": [{"name": "stamp", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Time"}}, {"name": "frame_id", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `std_msgs/msg/String`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct String {
        pub data: std::string::String,
    }

    impl Message for String {
        const PACKAGE: &'static str = "std_msgs";
        const NAME: &'static str = "String";
        const ROS_TYPE: &'static str = "std_msgs/msg/String";
        const DDS_TYPE: &'static str = "std_msgs::msg::dds_::String_";
        const RIHS01: &'static str = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/String.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "std_msgs/msg/String", "fields": [{"name": "data", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `std_srvs`.
pub mod std_srvs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `std_srvs/srv/SetBool_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetBoolRequest {
        pub data: bool,
    }

    impl Message for SetBoolRequest {
        const PACKAGE: &'static str = "std_srvs";
        const NAME: &'static str = "SetBool_Request";
        const ROS_TYPE: &'static str = "std_srvs/srv/SetBool_Request";
        const DDS_TYPE: &'static str = "std_srvs::srv::dds_::SetBool_Request_";
        const RIHS01: &'static str = "RIHS01_c62fbb99d94e1b25e8ef9e109f9581956bb1b3361a45a4e5810c36a90d29932e";
        const SCHEMA: &'static str = "bool data\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "std_srvs/srv/SetBool_Request", "fields": [{"name": "data", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `std_srvs/srv/SetBool_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SetBoolResponse {
        pub success: bool,
        pub message: std::string::String,
    }

    impl Message for SetBoolResponse {
        const PACKAGE: &'static str = "std_srvs";
        const NAME: &'static str = "SetBool_Response";
        const ROS_TYPE: &'static str = "std_srvs/srv/SetBool_Response";
        const DDS_TYPE: &'static str = "std_srvs::srv::dds_::SetBool_Response_";
        const RIHS01: &'static str = "RIHS01_d0814e7f7b4880ab77e9c57426c7aa1562ab69f11eef8e2e968812f9cbd0b059";
        const SCHEMA: &'static str = "bool success\nstring message\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "std_srvs/srv/SetBool_Response", "fields": [{"name": "success", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `std_srvs/srv/Trigger_Request`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TriggerRequest {
        /// Carries nothing; DDS has no empty struct.
        pub structure_needs_at_least_one_member: u8,
    }

    impl Message for TriggerRequest {
        const PACKAGE: &'static str = "std_srvs";
        const NAME: &'static str = "Trigger_Request";
        const ROS_TYPE: &'static str = "std_srvs/srv/Trigger_Request";
        const DDS_TYPE: &'static str = "std_srvs::srv::dds_::Trigger_Request_";
        const RIHS01: &'static str = "RIHS01_d010825374ce8918e72bfd826c82603e60f45419e932ea976f807b74a863a199";
        const SCHEMA: &'static str = "";
        const DESCRIPTION: &'static str = r#"{"type_name": "std_srvs/srv/Trigger_Request", "fields": [{"name": "structure_needs_at_least_one_member", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `std_srvs/srv/Trigger_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TriggerResponse {
        pub success: bool,
        pub message: std::string::String,
    }

    impl Message for TriggerResponse {
        const PACKAGE: &'static str = "std_srvs";
        const NAME: &'static str = "Trigger_Response";
        const ROS_TYPE: &'static str = "std_srvs/srv/Trigger_Response";
        const DDS_TYPE: &'static str = "std_srvs::srv::dds_::Trigger_Response_";
        const RIHS01: &'static str = "RIHS01_2d946c21e2fc3f1e9ca6986a8191d85fcc70097a8bb7771a053564bc47009cdf";
        const SCHEMA: &'static str = "bool success\nstring message\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "std_srvs/srv/Trigger_Response", "fields": [{"name": "success", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "message", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `tf2_msgs`.
pub mod tf2_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `tf2_msgs/msg/TFMessage`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TFMessage {
        pub transforms: Vec<super::geometry_msgs::TransformStamped>,
    }

    impl Message for TFMessage {
        const PACKAGE: &'static str = "tf2_msgs";
        const NAME: &'static str = "TFMessage";
        const ROS_TYPE: &'static str = "tf2_msgs/msg/TFMessage";
        const DDS_TYPE: &'static str = "tf2_msgs::msg::dds_::TFMessage_";
        const RIHS01: &'static str = "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/tf2_msgs/msg/TFMessage.msg"),
            "================================================================================\nMSG: geometry_msgs/TransformStamped\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/TransformStamped.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: geometry_msgs/Transform\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Transform.msg"),
            "================================================================================\nMSG: geometry_msgs/Vector3\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Vector3.msg"),
            "================================================================================\nMSG: geometry_msgs/Quaternion\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Quaternion.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "tf2_msgs/msg/TFMessage", "fields": [{"name": "transforms", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/TransformStamped"}}]}"#;
    }
}

/// Messages of the ROS package `type_description_interfaces`.
pub mod type_description_interfaces {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `type_description_interfaces/msg/Field`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Field {
        /// One field of a type.
        pub name: std::string::String,
        pub type_: FieldType,
        /// As text; empty if it has none.
        pub default_value: std::string::String,
    }

    impl Message for Field {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "Field";
        const ROS_TYPE: &'static str = "type_description_interfaces/msg/Field";
        const DDS_TYPE: &'static str = "type_description_interfaces::msg::dds_::Field_";
        const RIHS01: &'static str = "RIHS01_c0b01379cd4226281285ccaf6be46653968f855f7c5e41614ff5d7a854efef7c";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/Field.msg"),
            "================================================================================\nMSG: type_description_interfaces/FieldType\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/FieldType.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/msg/Field", "fields": [{"name": "name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "type", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/msg/FieldType"}}, {"name": "default_value", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `type_description_interfaces/msg/FieldType`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct FieldType {
        /// REP-2016's number of the type: 1 is another message, 2 to 22 are built in; 48 more for an array of fixed length, 96 for
        /// one with a bound, 144 for one without.
        pub type_id: u8,
        /// Length or bound of an array, else 0.
        pub capacity: u64,
        /// Bound of a string, else 0.
        pub string_capacity: u64,
        /// The other message, as package/msg/Name; else empty.
        pub nested_type_name: std::string::String,
    }

    impl Message for FieldType {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "FieldType";
        const ROS_TYPE: &'static str = "type_description_interfaces/msg/FieldType";
        const DDS_TYPE: &'static str = "type_description_interfaces::msg::dds_::FieldType_";
        const RIHS01: &'static str = "RIHS01_a70b6dd919645a03a3586f7f821defbc886ea3e531a1d95cc0f380a3973ccaa6";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/FieldType.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/msg/FieldType", "fields": [{"name": "type_id", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "capacity", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "string_capacity", "type": {"type_id": 9, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "nested_type_name", "type": {"type_id": 21, "capacity": 0, "string_capacity": 255, "nested_type_name": ""}}]}"#;
    }

    /// A type alone.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct IndividualTypeDescription {
        /// As package/msg/Name.
        pub type_name: std::string::String,
        pub fields: Vec<Field>,
    }

    impl Message for IndividualTypeDescription {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "IndividualTypeDescription";
        const ROS_TYPE: &'static str = "type_description_interfaces/msg/IndividualTypeDescription";
        const DDS_TYPE: &'static str = "type_description_interfaces::msg::dds_::IndividualTypeDescription_";
        const RIHS01: &'static str = "RIHS01_55c827d86c3c141bdd318fe6c22e11190e4d3b37c8f4f9751a084aa05ce96560";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/IndividualTypeDescription.msg"),
            "================================================================================\nMSG: type_description_interfaces/Field\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/Field.msg"),
            "================================================================================\nMSG: type_description_interfaces/FieldType\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/FieldType.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/msg/IndividualTypeDescription", "fields": [{"name": "type_name", "type": {"type_id": 21, "capacity": 0, "string_capacity": 255, "nested_type_name": ""}}, {"name": "fields", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/msg/Field"}}]}"#;
    }

    /// `type_description_interfaces/msg/KeyValue`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct KeyValue {
        pub key: std::string::String,
        pub value: std::string::String,
    }

    impl Message for KeyValue {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "KeyValue";
        const ROS_TYPE: &'static str = "type_description_interfaces/msg/KeyValue";
        const DDS_TYPE: &'static str = "type_description_interfaces::msg::dds_::KeyValue_";
        const RIHS01: &'static str = "RIHS01_274fe56bf14f33c7512e34c646a37579ee36779f745f049a9760763e817f0c42";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/KeyValue.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/msg/KeyValue", "fields": [{"name": "key", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "value", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `type_description_interfaces/msg/TypeDescription`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TypeDescription {
        /// A type with all that it is made of.
        pub type_description: IndividualTypeDescription,
        /// Sorted by name.
        pub referenced_type_descriptions: Vec<IndividualTypeDescription>,
    }

    impl Message for TypeDescription {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "TypeDescription";
        const ROS_TYPE: &'static str = "type_description_interfaces/msg/TypeDescription";
        const DDS_TYPE: &'static str = "type_description_interfaces::msg::dds_::TypeDescription_";
        const RIHS01: &'static str = "RIHS01_739f2508c9fa3a6f330913ff5b9d25fb74159a077da71e1087f51a60c12a080b";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/TypeDescription.msg"),
            "================================================================================\nMSG: type_description_interfaces/IndividualTypeDescription\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/IndividualTypeDescription.msg"),
            "================================================================================\nMSG: type_description_interfaces/Field\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/Field.msg"),
            "================================================================================\nMSG: type_description_interfaces/FieldType\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/FieldType.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/msg/TypeDescription", "fields": [{"name": "type_description", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/msg/IndividualTypeDescription"}}, {"name": "referenced_type_descriptions", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/msg/IndividualTypeDescription"}}]}"#;
    }

    /// `type_description_interfaces/msg/TypeSource`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct TypeSource {
        /// The text that a type was defined by.
        pub type_name: std::string::String,
        /// Its language: msg, srv, idl.
        pub encoding: std::string::String,
        pub raw_file_contents: std::string::String,
    }

    impl Message for TypeSource {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "TypeSource";
        const ROS_TYPE: &'static str = "type_description_interfaces/msg/TypeSource";
        const DDS_TYPE: &'static str = "type_description_interfaces::msg::dds_::TypeSource_";
        const RIHS01: &'static str = "RIHS01_faeaec7596c04ecf5b6e99ad225e4c7cbb997ad5435f793526fb3984d011aae5";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/TypeSource.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/msg/TypeSource", "fields": [{"name": "type_name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "encoding", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "raw_file_contents", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `type_description_interfaces/srv/GetTypeDescription_Request`.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    pub struct GetTypeDescriptionRequest {
        /// As package/msg/Name.
        pub type_name: std::string::String,
        /// As RIHS01_ and 64 hexadecimal digits.
        pub type_hash: std::string::String,
        /// Whether to give the texts too.
        pub include_type_sources: bool,
    }

    impl Default for GetTypeDescriptionRequest {
        fn default() -> Self {
            Self {
                type_name: Default::default(),
                type_hash: Default::default(),
                include_type_sources: true,
            }
        }
    }

    impl Message for GetTypeDescriptionRequest {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "GetTypeDescription_Request";
        const ROS_TYPE: &'static str = "type_description_interfaces/srv/GetTypeDescription_Request";
        const DDS_TYPE: &'static str = "type_description_interfaces::srv::dds_::GetTypeDescription_Request_";
        const RIHS01: &'static str = "RIHS01_470f56ccbcf13d55c78c8b735fb12da03e639e5acded994426c89d94778d9e28";
        const SCHEMA: &'static str = "# As package/msg/Name.\nstring type_name\n# As RIHS01_ and 64 hexadecimal digits.\nstring type_hash\n# Whether to give the texts too.\nbool include_type_sources true\n";
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/srv/GetTypeDescription_Request", "fields": [{"name": "type_name", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "type_hash", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "include_type_sources", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}, "default_value": "True"}]}"#;
    }

    /// `type_description_interfaces/srv/GetTypeDescription_Response`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct GetTypeDescriptionResponse {
        /// Whether there is a description.
        pub successful: bool,
        /// Why not; else empty.
        pub failure_reason: std::string::String,
        pub type_description: TypeDescription,
        /// The texts of the type and of those it is made of.
        pub type_sources: Vec<TypeSource>,
        pub extra_information: Vec<KeyValue>,
    }

    impl Message for GetTypeDescriptionResponse {
        const PACKAGE: &'static str = "type_description_interfaces";
        const NAME: &'static str = "GetTypeDescription_Response";
        const ROS_TYPE: &'static str = "type_description_interfaces/srv/GetTypeDescription_Response";
        const DDS_TYPE: &'static str = "type_description_interfaces::srv::dds_::GetTypeDescription_Response_";
        const RIHS01: &'static str = "RIHS01_648c49d976240861a482f961c5621ddd0d2135d8cce6f297a76d4f6376d93b75";
        const SCHEMA: &'static str = concat!(
            "# Whether there is a description.\nbool successful\n# Why not; else empty.\nstring failure_reason\nTypeDescription type_description\n# The texts of the type and of those it is made of.\nTypeSource[] type_sources\nKeyValue[] extra_information\n",
            "================================================================================\nMSG: type_description_interfaces/TypeDescription\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/TypeDescription.msg"),
            "================================================================================\nMSG: type_description_interfaces/IndividualTypeDescription\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/IndividualTypeDescription.msg"),
            "================================================================================\nMSG: type_description_interfaces/Field\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/Field.msg"),
            "================================================================================\nMSG: type_description_interfaces/FieldType\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/FieldType.msg"),
            "================================================================================\nMSG: type_description_interfaces/TypeSource\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/TypeSource.msg"),
            "================================================================================\nMSG: type_description_interfaces/KeyValue\n",
            include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/msg/KeyValue.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "type_description_interfaces/srv/GetTypeDescription_Response", "fields": [{"name": "successful", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "failure_reason", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "type_description", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/msg/TypeDescription"}}, {"name": "type_sources", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/msg/TypeSource"}}, {"name": "extra_information", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/msg/KeyValue"}}]}"#;
    }
}

/// Messages of the ROS package `unique_identifier_msgs`.
pub mod unique_identifier_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// A universally unique identifier.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct UUID {
        pub uuid: [u8; 16],
    }

    impl Message for UUID {
        const PACKAGE: &'static str = "unique_identifier_msgs";
        const NAME: &'static str = "UUID";
        const ROS_TYPE: &'static str = "unique_identifier_msgs/msg/UUID";
        const DDS_TYPE: &'static str = "unique_identifier_msgs::msg::dds_::UUID_";
        const RIHS01: &'static str = "RIHS01_1b8e8aca958cbea28fe6ef60bf6c19b683c97a9ef60bb34752067d0f2f7ab437";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/unique_identifier_msgs/msg/UUID.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "unique_identifier_msgs/msg/UUID", "fields": [{"name": "uuid", "type": {"type_id": 51, "capacity": 16, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Messages of the ROS package `visualization_msgs`.
pub mod visualization_msgs {
    use serde::{Deserialize, Serialize};

    use crate::Message;

    /// `visualization_msgs/msg/Marker`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct Marker {
        pub header: super::std_msgs::Header,
        pub ns: std::string::String,
        pub id: i32,
        pub type_: i32,
        pub action: i32,
        pub pose: super::geometry_msgs::Pose,
        pub scale: super::geometry_msgs::Vector3,
        pub color: super::std_msgs::ColorRGBA,
        pub lifetime: super::builtin_interfaces::Duration,
        pub frame_locked: bool,
        pub points: Vec<super::geometry_msgs::Point>,
        pub colors: Vec<super::std_msgs::ColorRGBA>,
        pub texture_resource: std::string::String,
        pub texture: super::sensor_msgs::CompressedImage,
        pub uv_coordinates: Vec<UVCoordinate>,
        pub text: std::string::String,
        pub mesh_resource: std::string::String,
        pub mesh_file: MeshFile,
        pub mesh_use_embedded_materials: bool,
    }

    impl Marker {
        pub const ARROW: i32 = 0;
        pub const CUBE: i32 = 1;
        pub const SPHERE: i32 = 2;
        pub const CYLINDER: i32 = 3;
        pub const LINE_STRIP: i32 = 4;
        pub const LINE_LIST: i32 = 5;
        pub const CUBE_LIST: i32 = 6;
        pub const SPHERE_LIST: i32 = 7;
        pub const POINTS: i32 = 8;
        pub const TEXT_VIEW_FACING: i32 = 9;
        pub const MESH_RESOURCE: i32 = 10;
        pub const TRIANGLE_LIST: i32 = 11;
        pub const ARROW_STRIP: i32 = 12;
        pub const ADD: i32 = 0;
        pub const MODIFY: i32 = 0;
        pub const DELETE: i32 = 2;
        pub const DELETEALL: i32 = 3;
    }

    impl Message for Marker {
        const PACKAGE: &'static str = "visualization_msgs";
        const NAME: &'static str = "Marker";
        const ROS_TYPE: &'static str = "visualization_msgs/msg/Marker";
        const DDS_TYPE: &'static str = "visualization_msgs::msg::dds_::Marker_";
        const RIHS01: &'static str = "RIHS01_45b13ccf791f225962bf74e746f9644518855d783a6f42ba0cc14fde2b4f3ce0";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/Marker.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: geometry_msgs/Pose\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Pose.msg"),
            "================================================================================\nMSG: geometry_msgs/Point\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Point.msg"),
            "================================================================================\nMSG: geometry_msgs/Quaternion\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Quaternion.msg"),
            "================================================================================\nMSG: geometry_msgs/Vector3\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Vector3.msg"),
            "================================================================================\nMSG: std_msgs/ColorRGBA\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/ColorRGBA.msg"),
            "================================================================================\nMSG: builtin_interfaces/Duration\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Duration.msg"),
            "================================================================================\nMSG: sensor_msgs/CompressedImage\n",
            include_str!("../../../crates/flexdrill-messages/external/sensor_msgs/msg/CompressedImage.msg"),
            "================================================================================\nMSG: visualization_msgs/UVCoordinate\n",
            include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/UVCoordinate.msg"),
            "================================================================================\nMSG: visualization_msgs/MeshFile\n",
            include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/MeshFile.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "visualization_msgs/msg/Marker", "fields": [{"name": "header", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/Header"}}, {"name": "ns", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "id", "type": {"type_id": 6, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "type", "type": {"type_id": 6, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "action", "type": {"type_id": 6, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "pose", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Pose"}}, {"name": "scale", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Vector3"}}, {"name": "color", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/ColorRGBA"}}, {"name": "lifetime", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "builtin_interfaces/msg/Duration"}}, {"name": "frame_locked", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "points", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "geometry_msgs/msg/Point"}}, {"name": "colors", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_msgs/msg/ColorRGBA"}}, {"name": "texture_resource", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "texture", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "sensor_msgs/msg/CompressedImage"}}, {"name": "uv_coordinates", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "visualization_msgs/msg/UVCoordinate"}}, {"name": "text", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "mesh_resource", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "mesh_file", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "visualization_msgs/msg/MeshFile"}}, {"name": "mesh_use_embedded_materials", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `visualization_msgs/msg/MarkerArray`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct MarkerArray {
        pub markers: Vec<Marker>,
    }

    impl Message for MarkerArray {
        const PACKAGE: &'static str = "visualization_msgs";
        const NAME: &'static str = "MarkerArray";
        const ROS_TYPE: &'static str = "visualization_msgs/msg/MarkerArray";
        const DDS_TYPE: &'static str = "visualization_msgs::msg::dds_::MarkerArray_";
        const RIHS01: &'static str = "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf";
        const SCHEMA: &'static str = concat!(
            include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/MarkerArray.msg"),
            "================================================================================\nMSG: visualization_msgs/Marker\n",
            include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/Marker.msg"),
            "================================================================================\nMSG: std_msgs/Header\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/Header.msg"),
            "================================================================================\nMSG: builtin_interfaces/Time\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Time.msg"),
            "================================================================================\nMSG: geometry_msgs/Pose\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Pose.msg"),
            "================================================================================\nMSG: geometry_msgs/Point\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Point.msg"),
            "================================================================================\nMSG: geometry_msgs/Quaternion\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Quaternion.msg"),
            "================================================================================\nMSG: geometry_msgs/Vector3\n",
            include_str!("../../../crates/flexdrill-messages/external/geometry_msgs/msg/Vector3.msg"),
            "================================================================================\nMSG: std_msgs/ColorRGBA\n",
            include_str!("../../../crates/flexdrill-messages/external/std_msgs/msg/ColorRGBA.msg"),
            "================================================================================\nMSG: builtin_interfaces/Duration\n",
            include_str!("../../../crates/flexdrill-messages/external/builtin_interfaces/msg/Duration.msg"),
            "================================================================================\nMSG: sensor_msgs/CompressedImage\n",
            include_str!("../../../crates/flexdrill-messages/external/sensor_msgs/msg/CompressedImage.msg"),
            "================================================================================\nMSG: visualization_msgs/UVCoordinate\n",
            include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/UVCoordinate.msg"),
            "================================================================================\nMSG: visualization_msgs/MeshFile\n",
            include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/MeshFile.msg"),
        );
        const DESCRIPTION: &'static str = r#"{"type_name": "visualization_msgs/msg/MarkerArray", "fields": [{"name": "markers", "type": {"type_id": 145, "capacity": 0, "string_capacity": 0, "nested_type_name": "visualization_msgs/msg/Marker"}}]}"#;
    }

    /// `visualization_msgs/msg/MeshFile`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct MeshFile {
        pub filename: std::string::String,
        pub data: Vec<u8>,
    }

    impl Message for MeshFile {
        const PACKAGE: &'static str = "visualization_msgs";
        const NAME: &'static str = "MeshFile";
        const ROS_TYPE: &'static str = "visualization_msgs/msg/MeshFile";
        const DDS_TYPE: &'static str = "visualization_msgs::msg::dds_::MeshFile_";
        const RIHS01: &'static str = "RIHS01_7710ece15a148fb7c9b546364cfb215bb06098087bd6394fe5b73a493508f8c4";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/MeshFile.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "visualization_msgs/msg/MeshFile", "fields": [{"name": "filename", "type": {"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "data", "type": {"type_id": 147, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }

    /// `visualization_msgs/msg/UVCoordinate`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct UVCoordinate {
        pub u: f32,
        pub v: f32,
    }

    impl Message for UVCoordinate {
        const PACKAGE: &'static str = "visualization_msgs";
        const NAME: &'static str = "UVCoordinate";
        const ROS_TYPE: &'static str = "visualization_msgs/msg/UVCoordinate";
        const DDS_TYPE: &'static str = "visualization_msgs::msg::dds_::UVCoordinate_";
        const RIHS01: &'static str = "RIHS01_f27f7ed21fe360c6066944f856b801a0c0d1e94e815b6886444b42d90b196a26";
        const SCHEMA: &'static str = include_str!("../../../crates/flexdrill-messages/external/visualization_msgs/msg/UVCoordinate.msg");
        const DESCRIPTION: &'static str = r#"{"type_name": "visualization_msgs/msg/UVCoordinate", "fields": [{"name": "u", "type": {"type_id": 10, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, {"name": "v", "type": {"type_id": 10, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}"#;
    }
}

/// Every generated type, sorted by name.
pub const TYPES: &[TypeInfo] = &[
    <action_msgs::GoalInfo as super::Message>::INFO,
    <action_msgs::GoalStatus as super::Message>::INFO,
    <action_msgs::GoalStatusArray as super::Message>::INFO,
    <action_msgs::CancelGoalRequest as super::Message>::INFO,
    <action_msgs::CancelGoalResponse as super::Message>::INFO,
    <builtin_interfaces::Duration as super::Message>::INFO,
    <builtin_interfaces::Time as super::Message>::INFO,
    <diagnostic_msgs::DiagnosticArray as super::Message>::INFO,
    <diagnostic_msgs::DiagnosticStatus as super::Message>::INFO,
    <diagnostic_msgs::KeyValue as super::Message>::INFO,
    <flexdrill::WhatIfFeedback as super::Message>::INFO,
    <flexdrill::WhatIfFeedbackMessage as super::Message>::INFO,
    <flexdrill::WhatIfGetResultRequest as super::Message>::INFO,
    <flexdrill::WhatIfGetResultResponse as super::Message>::INFO,
    <flexdrill::WhatIfGoal as super::Message>::INFO,
    <flexdrill::WhatIfResult as super::Message>::INFO,
    <flexdrill::WhatIfSendGoalRequest as super::Message>::INFO,
    <flexdrill::WhatIfSendGoalResponse as super::Message>::INFO,
    <flexdrill::Ageing as super::Message>::INFO,
    <flexdrill::Alarm as super::Message>::INFO,
    <flexdrill::AlarmChance as super::Message>::INFO,
    <flexdrill::AlarmEvent as super::Message>::INFO,
    <flexdrill::AlarmList as super::Message>::INFO,
    <flexdrill::AppliedInputs as super::Message>::INFO,
    <flexdrill::Bands as super::Message>::INFO,
    <flexdrill::BitState as super::Message>::INFO,
    <flexdrill::ContactForces as super::Message>::INFO,
    <flexdrill::FigureBand as super::Message>::INFO,
    <flexdrill::Forecast as super::Message>::INFO,
    <flexdrill::ForecastBand as super::Message>::INFO,
    <flexdrill::HoleAhead as super::Message>::INFO,
    <flexdrill::HoleDrilled as super::Message>::INFO,
    <flexdrill::JointDeflections as super::Message>::INFO,
    <flexdrill::Reactions as super::Message>::INFO,
    <flexdrill::Residual as super::Message>::INFO,
    <flexdrill::Residuals as super::Message>::INFO,
    <flexdrill::RigInputs as super::Message>::INFO,
    <flexdrill::RigMeasured as super::Message>::INFO,
    <flexdrill::RigSurvey as super::Message>::INFO,
    <flexdrill::SafeWindow as super::Message>::INFO,
    <flexdrill::SessionInfo as super::Message>::INFO,
    <flexdrill::Transfer as super::Message>::INFO,
    <flexdrill::TwinStatus as super::Message>::INFO,
    <flexdrill::WhatIfAnswer as super::Message>::INFO,
    <flexdrill::WhatIfCandidate as super::Message>::INFO,
    <flexdrill::WhirlState as super::Message>::INFO,
    <flexdrill::WhirlWarning as super::Message>::INFO,
    <flexdrill::AcknowledgeAlarmRequest as super::Message>::INFO,
    <flexdrill::AcknowledgeAlarmResponse as super::Message>::INFO,
    <flexdrill::ConfirmMappingRequest as super::Message>::INFO,
    <flexdrill::ConfirmMappingResponse as super::Message>::INFO,
    <flexdrill::ShelveAlarmRequest as super::Message>::INFO,
    <flexdrill::ShelveAlarmResponse as super::Message>::INFO,
    <flexdrill::UnshelveAlarmRequest as super::Message>::INFO,
    <flexdrill::UnshelveAlarmResponse as super::Message>::INFO,
    <geometry_msgs::Point as super::Message>::INFO,
    <geometry_msgs::Pose as super::Message>::INFO,
    <geometry_msgs::Quaternion as super::Message>::INFO,
    <geometry_msgs::Transform as super::Message>::INFO,
    <geometry_msgs::TransformStamped as super::Message>::INFO,
    <geometry_msgs::Vector3 as super::Message>::INFO,
    <lifecycle_msgs::State as super::Message>::INFO,
    <lifecycle_msgs::Transition as super::Message>::INFO,
    <lifecycle_msgs::TransitionDescription as super::Message>::INFO,
    <lifecycle_msgs::TransitionEvent as super::Message>::INFO,
    <lifecycle_msgs::ChangeStateRequest as super::Message>::INFO,
    <lifecycle_msgs::ChangeStateResponse as super::Message>::INFO,
    <lifecycle_msgs::GetAvailableStatesRequest as super::Message>::INFO,
    <lifecycle_msgs::GetAvailableStatesResponse as super::Message>::INFO,
    <lifecycle_msgs::GetAvailableTransitionsRequest as super::Message>::INFO,
    <lifecycle_msgs::GetAvailableTransitionsResponse as super::Message>::INFO,
    <lifecycle_msgs::GetStateRequest as super::Message>::INFO,
    <lifecycle_msgs::GetStateResponse as super::Message>::INFO,
    <rcl_interfaces::FloatingPointRange as super::Message>::INFO,
    <rcl_interfaces::IntegerRange as super::Message>::INFO,
    <rcl_interfaces::ListParametersResult as super::Message>::INFO,
    <rcl_interfaces::Log as super::Message>::INFO,
    <rcl_interfaces::LoggerLevel as super::Message>::INFO,
    <rcl_interfaces::Parameter as super::Message>::INFO,
    <rcl_interfaces::ParameterDescriptor as super::Message>::INFO,
    <rcl_interfaces::ParameterEvent as super::Message>::INFO,
    <rcl_interfaces::ParameterType as super::Message>::INFO,
    <rcl_interfaces::ParameterValue as super::Message>::INFO,
    <rcl_interfaces::SetLoggerLevelsResult as super::Message>::INFO,
    <rcl_interfaces::SetParametersResult as super::Message>::INFO,
    <rcl_interfaces::DescribeParametersRequest as super::Message>::INFO,
    <rcl_interfaces::DescribeParametersResponse as super::Message>::INFO,
    <rcl_interfaces::GetLoggerLevelsRequest as super::Message>::INFO,
    <rcl_interfaces::GetLoggerLevelsResponse as super::Message>::INFO,
    <rcl_interfaces::GetParameterTypesRequest as super::Message>::INFO,
    <rcl_interfaces::GetParameterTypesResponse as super::Message>::INFO,
    <rcl_interfaces::GetParametersRequest as super::Message>::INFO,
    <rcl_interfaces::GetParametersResponse as super::Message>::INFO,
    <rcl_interfaces::ListParametersRequest as super::Message>::INFO,
    <rcl_interfaces::ListParametersResponse as super::Message>::INFO,
    <rcl_interfaces::SetLoggerLevelsRequest as super::Message>::INFO,
    <rcl_interfaces::SetLoggerLevelsResponse as super::Message>::INFO,
    <rcl_interfaces::SetParametersAtomicallyRequest as super::Message>::INFO,
    <rcl_interfaces::SetParametersAtomicallyResponse as super::Message>::INFO,
    <rcl_interfaces::SetParametersRequest as super::Message>::INFO,
    <rcl_interfaces::SetParametersResponse as super::Message>::INFO,
    <rosgraph_msgs::Clock as super::Message>::INFO,
    <sensor_msgs::CompressedImage as super::Message>::INFO,
    <sensor_msgs::JointState as super::Message>::INFO,
    <service_msgs::ServiceEventInfo as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsFeedback as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsFeedbackMessage as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsGetResultRequest as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsGetResultResponse as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsGoal as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsResult as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsSendGoalRequest as super::Message>::INFO,
    <simulation_interfaces::SimulateStepsSendGoalResponse as super::Message>::INFO,
    <simulation_interfaces::Result as super::Message>::INFO,
    <simulation_interfaces::SimulationState as super::Message>::INFO,
    <simulation_interfaces::SimulatorFeatures as super::Message>::INFO,
    <simulation_interfaces::GetSimulationStateRequest as super::Message>::INFO,
    <simulation_interfaces::GetSimulationStateResponse as super::Message>::INFO,
    <simulation_interfaces::GetSimulatorFeaturesRequest as super::Message>::INFO,
    <simulation_interfaces::GetSimulatorFeaturesResponse as super::Message>::INFO,
    <simulation_interfaces::ResetSimulationRequest as super::Message>::INFO,
    <simulation_interfaces::ResetSimulationResponse as super::Message>::INFO,
    <simulation_interfaces::SetSimulationStateRequest as super::Message>::INFO,
    <simulation_interfaces::SetSimulationStateResponse as super::Message>::INFO,
    <simulation_interfaces::StepSimulationRequest as super::Message>::INFO,
    <simulation_interfaces::StepSimulationResponse as super::Message>::INFO,
    <std_msgs::ColorRGBA as super::Message>::INFO,
    <std_msgs::Float64 as super::Message>::INFO,
    <std_msgs::Header as super::Message>::INFO,
    <std_msgs::String as super::Message>::INFO,
    <std_srvs::SetBoolRequest as super::Message>::INFO,
    <std_srvs::SetBoolResponse as super::Message>::INFO,
    <std_srvs::TriggerRequest as super::Message>::INFO,
    <std_srvs::TriggerResponse as super::Message>::INFO,
    <tf2_msgs::TFMessage as super::Message>::INFO,
    <type_description_interfaces::Field as super::Message>::INFO,
    <type_description_interfaces::FieldType as super::Message>::INFO,
    <type_description_interfaces::IndividualTypeDescription as super::Message>::INFO,
    <type_description_interfaces::KeyValue as super::Message>::INFO,
    <type_description_interfaces::TypeDescription as super::Message>::INFO,
    <type_description_interfaces::TypeSource as super::Message>::INFO,
    <type_description_interfaces::GetTypeDescriptionRequest as super::Message>::INFO,
    <type_description_interfaces::GetTypeDescriptionResponse as super::Message>::INFO,
    <unique_identifier_msgs::UUID as super::Message>::INFO,
    <visualization_msgs::Marker as super::Message>::INFO,
    <visualization_msgs::MarkerArray as super::Message>::INFO,
    <visualization_msgs::MeshFile as super::Message>::INFO,
    <visualization_msgs::UVCoordinate as super::Message>::INFO,
];

/// Every service, sorted by name.
pub const SERVICES: &[ServiceInfo] = &[
    ServiceInfo {
        ros_type: "action_msgs/srv/CancelGoal",
        rihs01: "RIHS01_573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a",
        source: include_str!("../../../crates/flexdrill-messages/external/action_msgs/srv/CancelGoal.srv"),
        description: r#"{"type_name": "action_msgs/srv/CancelGoal", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "action_msgs/srv/CancelGoal_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "action_msgs/srv/CancelGoal_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "action_msgs/srv/CancelGoal_Event"}}]}"#,
        event_type: "action_msgs/srv/CancelGoal_Event",
        event_description: r#"{"type_name": "action_msgs/srv/CancelGoal_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "action_msgs/srv/CancelGoal_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "action_msgs/srv/CancelGoal_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "flexdrill/action/WhatIf_GetResult",
        rihs01: "RIHS01_fba9a20bea4a6136650cad1ee6bc4e22a9701f13c80d4b5726d3212c2a6f77ec",
        source: "",
        description: r#"{"type_name": "flexdrill/action/WhatIf_GetResult", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_GetResult_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_GetResult_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_GetResult_Event"}}]}"#,
        event_type: "flexdrill/action/WhatIf_GetResult_Event",
        event_description: r#"{"type_name": "flexdrill/action/WhatIf_GetResult_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_GetResult_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_GetResult_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "flexdrill/action/WhatIf_SendGoal",
        rihs01: "RIHS01_411266d3df75bbbdbfd218287e270f84321195ee0090836411c7e6d7aa13cf37",
        source: "",
        description: r#"{"type_name": "flexdrill/action/WhatIf_SendGoal", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_SendGoal_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_SendGoal_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_SendGoal_Event"}}]}"#,
        event_type: "flexdrill/action/WhatIf_SendGoal_Event",
        event_description: r#"{"type_name": "flexdrill/action/WhatIf_SendGoal_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_SendGoal_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_SendGoal_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "flexdrill/srv/AcknowledgeAlarm",
        rihs01: "RIHS01_edcf727feeabd4248a12a54fe946fb8c26e4cadd2265b4e0a1baef3c9966e439",
        source: include_str!("../../../msg/AcknowledgeAlarm.srv"),
        description: r#"{"type_name": "flexdrill/srv/AcknowledgeAlarm", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/AcknowledgeAlarm_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/AcknowledgeAlarm_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/AcknowledgeAlarm_Event"}}]}"#,
        event_type: "flexdrill/srv/AcknowledgeAlarm_Event",
        event_description: r#"{"type_name": "flexdrill/srv/AcknowledgeAlarm_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/AcknowledgeAlarm_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/AcknowledgeAlarm_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "flexdrill/srv/ConfirmMapping",
        rihs01: "RIHS01_938d93c1c9465df04b3ed68a424d2aeac458b00a6ee513ad7fc4c8fd82f0fadd",
        source: include_str!("../../../msg/ConfirmMapping.srv"),
        description: r#"{"type_name": "flexdrill/srv/ConfirmMapping", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ConfirmMapping_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ConfirmMapping_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ConfirmMapping_Event"}}]}"#,
        event_type: "flexdrill/srv/ConfirmMapping_Event",
        event_description: r#"{"type_name": "flexdrill/srv/ConfirmMapping_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ConfirmMapping_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ConfirmMapping_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "flexdrill/srv/ShelveAlarm",
        rihs01: "RIHS01_29570b7a8b9ab744361c8012843cb5eee47200bfabcb280f74781652c7ffa248",
        source: include_str!("../../../msg/ShelveAlarm.srv"),
        description: r#"{"type_name": "flexdrill/srv/ShelveAlarm", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ShelveAlarm_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ShelveAlarm_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ShelveAlarm_Event"}}]}"#,
        event_type: "flexdrill/srv/ShelveAlarm_Event",
        event_description: r#"{"type_name": "flexdrill/srv/ShelveAlarm_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ShelveAlarm_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/ShelveAlarm_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "flexdrill/srv/UnshelveAlarm",
        rihs01: "RIHS01_85221884fbd006fca85b8a3fe168225a1c01dac67955f57c7be88c275e02fc3b",
        source: include_str!("../../../msg/UnshelveAlarm.srv"),
        description: r#"{"type_name": "flexdrill/srv/UnshelveAlarm", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/UnshelveAlarm_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/UnshelveAlarm_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/srv/UnshelveAlarm_Event"}}]}"#,
        event_type: "flexdrill/srv/UnshelveAlarm_Event",
        event_description: r#"{"type_name": "flexdrill/srv/UnshelveAlarm_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/UnshelveAlarm_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "flexdrill/srv/UnshelveAlarm_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "lifecycle_msgs/srv/ChangeState",
        rihs01: "RIHS01_356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5",
        source: include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/srv/ChangeState.srv"),
        description: r#"{"type_name": "lifecycle_msgs/srv/ChangeState", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/ChangeState_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/ChangeState_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/ChangeState_Event"}}]}"#,
        event_type: "lifecycle_msgs/srv/ChangeState_Event",
        event_description: r#"{"type_name": "lifecycle_msgs/srv/ChangeState_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/ChangeState_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/ChangeState_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "lifecycle_msgs/srv/GetAvailableStates",
        rihs01: "RIHS01_00a07d79d2207d71e81a8cbc1880e5d924cc16d4688ea8e8e06e443dc8f8aa1d",
        source: include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/srv/GetAvailableStates.srv"),
        description: r#"{"type_name": "lifecycle_msgs/srv/GetAvailableStates", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableStates_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableStates_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableStates_Event"}}]}"#,
        event_type: "lifecycle_msgs/srv/GetAvailableStates_Event",
        event_description: r#"{"type_name": "lifecycle_msgs/srv/GetAvailableStates_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableStates_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableStates_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "lifecycle_msgs/srv/GetAvailableTransitions",
        rihs01: "RIHS01_59b7ecefce0982a8a844b9f2c4f14764c1c4543cc55e72924e2aa4adad83e9bc",
        source: include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/srv/GetAvailableTransitions.srv"),
        description: r#"{"type_name": "lifecycle_msgs/srv/GetAvailableTransitions", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Event"}}]}"#,
        event_type: "lifecycle_msgs/srv/GetAvailableTransitions_Event",
        event_description: r#"{"type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetAvailableTransitions_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "lifecycle_msgs/srv/GetState",
        rihs01: "RIHS01_800a0a5aae599782b02932de0caf563f6dc4e7e94b794eadde075ba2cbef9795",
        source: include_str!("../../../crates/flexdrill-messages/external/lifecycle_msgs/srv/GetState.srv"),
        description: r#"{"type_name": "lifecycle_msgs/srv/GetState", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetState_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetState_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetState_Event"}}]}"#,
        event_type: "lifecycle_msgs/srv/GetState_Event",
        event_description: r#"{"type_name": "lifecycle_msgs/srv/GetState_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetState_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "lifecycle_msgs/srv/GetState_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/DescribeParameters",
        rihs01: "RIHS01_845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/DescribeParameters.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/DescribeParameters", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/DescribeParameters_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/DescribeParameters_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/DescribeParameters_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/DescribeParameters_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/DescribeParameters_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/DescribeParameters_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/DescribeParameters_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/GetLoggerLevels",
        rihs01: "RIHS01_03bf1bebd0d6514c7ed0ba7c5e08dc9f2f39c759fe99e1e30ea4157d7674f72d",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/GetLoggerLevels.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/GetLoggerLevels", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetLoggerLevels_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetLoggerLevels_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetLoggerLevels_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/GetLoggerLevels_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/GetLoggerLevels_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetLoggerLevels_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetLoggerLevels_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/GetParameterTypes",
        rihs01: "RIHS01_da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/GetParameterTypes.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/GetParameterTypes", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameterTypes_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameterTypes_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameterTypes_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/GetParameterTypes_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/GetParameterTypes_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameterTypes_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameterTypes_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/GetParameters",
        rihs01: "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/GetParameters.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/GetParameters", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameters_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameters_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameters_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/GetParameters_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/GetParameters_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameters_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/GetParameters_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/ListParameters",
        rihs01: "RIHS01_3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/ListParameters.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/ListParameters", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/ListParameters_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/ListParameters_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/ListParameters_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/ListParameters_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/ListParameters_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/ListParameters_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/ListParameters_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/SetLoggerLevels",
        rihs01: "RIHS01_3ff86cb4e91fbf9abae15c234ecc874448de6ece8e193401c077cf116e4f6d78",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/SetLoggerLevels.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/SetLoggerLevels", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetLoggerLevels_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetLoggerLevels_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetLoggerLevels_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/SetLoggerLevels_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/SetLoggerLevels_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetLoggerLevels_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetLoggerLevels_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/SetParameters",
        rihs01: "RIHS01_56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/SetParameters.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/SetParameters", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParameters_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParameters_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParameters_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/SetParameters_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/SetParameters_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParameters_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParameters_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "rcl_interfaces/srv/SetParametersAtomically",
        rihs01: "RIHS01_0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd",
        source: include_str!("../../../crates/flexdrill-messages/external/rcl_interfaces/srv/SetParametersAtomically.srv"),
        description: r#"{"type_name": "rcl_interfaces/srv/SetParametersAtomically", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParametersAtomically_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParametersAtomically_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParametersAtomically_Event"}}]}"#,
        event_type: "rcl_interfaces/srv/SetParametersAtomically_Event",
        event_description: r#"{"type_name": "rcl_interfaces/srv/SetParametersAtomically_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParametersAtomically_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "rcl_interfaces/srv/SetParametersAtomically_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "simulation_interfaces/action/SimulateSteps_GetResult",
        rihs01: "RIHS01_a1dae0516ab5c70d6d797e1bcd55c9448dfbb1966643f1ebd3e3f153d8169ae0",
        source: "",
        description: r#"{"type_name": "simulation_interfaces/action/SimulateSteps_GetResult", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Event"}}]}"#,
        event_type: "simulation_interfaces/action/SimulateSteps_GetResult_Event",
        event_description: r#"{"type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_GetResult_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "simulation_interfaces/action/SimulateSteps_SendGoal",
        rihs01: "RIHS01_504407b9ff5617a737df8222cf581452b4f2e699e11e940d8d36590c5fb07d01",
        source: "",
        description: r#"{"type_name": "simulation_interfaces/action/SimulateSteps_SendGoal", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Event"}}]}"#,
        event_type: "simulation_interfaces/action/SimulateSteps_SendGoal_Event",
        event_description: r#"{"type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_SendGoal_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "simulation_interfaces/srv/GetSimulationState",
        rihs01: "RIHS01_3362dcebee4b1afebbf9c4beee5c79c1455385aded62092a892d61fde8644f30",
        source: include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/srv/GetSimulationState.srv"),
        description: r#"{"type_name": "simulation_interfaces/srv/GetSimulationState", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulationState_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulationState_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulationState_Event"}}]}"#,
        event_type: "simulation_interfaces/srv/GetSimulationState_Event",
        event_description: r#"{"type_name": "simulation_interfaces/srv/GetSimulationState_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulationState_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulationState_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "simulation_interfaces/srv/GetSimulatorFeatures",
        rihs01: "RIHS01_abb9439c8cf196722a469fb6c68b44b484f198c2a1356ac38849a29c2a20a794",
        source: include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/srv/GetSimulatorFeatures.srv"),
        description: r#"{"type_name": "simulation_interfaces/srv/GetSimulatorFeatures", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Event"}}]}"#,
        event_type: "simulation_interfaces/srv/GetSimulatorFeatures_Event",
        event_description: r#"{"type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/GetSimulatorFeatures_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "simulation_interfaces/srv/ResetSimulation",
        rihs01: "RIHS01_4ce285d7ff9b8ac70dcc95161f32bf54c05a6f4b13427990e41ab40c36c39646",
        source: include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/srv/ResetSimulation.srv"),
        description: r#"{"type_name": "simulation_interfaces/srv/ResetSimulation", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/ResetSimulation_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/ResetSimulation_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/ResetSimulation_Event"}}]}"#,
        event_type: "simulation_interfaces/srv/ResetSimulation_Event",
        event_description: r#"{"type_name": "simulation_interfaces/srv/ResetSimulation_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/ResetSimulation_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/ResetSimulation_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "simulation_interfaces/srv/SetSimulationState",
        rihs01: "RIHS01_a868b916dce49974f637ba252141258c4b07b0c06858b88af560e3eb6bfbcb30",
        source: include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/srv/SetSimulationState.srv"),
        description: r#"{"type_name": "simulation_interfaces/srv/SetSimulationState", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/SetSimulationState_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/SetSimulationState_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/SetSimulationState_Event"}}]}"#,
        event_type: "simulation_interfaces/srv/SetSimulationState_Event",
        event_description: r#"{"type_name": "simulation_interfaces/srv/SetSimulationState_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/SetSimulationState_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/SetSimulationState_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "simulation_interfaces/srv/StepSimulation",
        rihs01: "RIHS01_913fe0653690ce6bf8f09f316e6a626747012e9fca31e26719910d417aa8565c",
        source: include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/srv/StepSimulation.srv"),
        description: r#"{"type_name": "simulation_interfaces/srv/StepSimulation", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/StepSimulation_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/StepSimulation_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/StepSimulation_Event"}}]}"#,
        event_type: "simulation_interfaces/srv/StepSimulation_Event",
        event_description: r#"{"type_name": "simulation_interfaces/srv/StepSimulation_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/StepSimulation_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "simulation_interfaces/srv/StepSimulation_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "std_srvs/srv/SetBool",
        rihs01: "RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a",
        source: include_str!("../../../crates/flexdrill-messages/external/std_srvs/srv/SetBool.srv"),
        description: r#"{"type_name": "std_srvs/srv/SetBool", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_srvs/srv/SetBool_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_srvs/srv/SetBool_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_srvs/srv/SetBool_Event"}}]}"#,
        event_type: "std_srvs/srv/SetBool_Event",
        event_description: r#"{"type_name": "std_srvs/srv/SetBool_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "std_srvs/srv/SetBool_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "std_srvs/srv/SetBool_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "std_srvs/srv/Trigger",
        rihs01: "RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f",
        source: include_str!("../../../crates/flexdrill-messages/external/std_srvs/srv/Trigger.srv"),
        description: r#"{"type_name": "std_srvs/srv/Trigger", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_srvs/srv/Trigger_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_srvs/srv/Trigger_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "std_srvs/srv/Trigger_Event"}}]}"#,
        event_type: "std_srvs/srv/Trigger_Event",
        event_description: r#"{"type_name": "std_srvs/srv/Trigger_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "std_srvs/srv/Trigger_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "std_srvs/srv/Trigger_Response"}}]}"#,
    },
    ServiceInfo {
        ros_type: "type_description_interfaces/srv/GetTypeDescription",
        rihs01: "RIHS01_69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5",
        source: include_str!("../../../crates/flexdrill-messages/external/type_description_interfaces/srv/GetTypeDescription.srv"),
        description: r#"{"type_name": "type_description_interfaces/srv/GetTypeDescription", "fields": [{"name": "request_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/srv/GetTypeDescription_Request"}}, {"name": "response_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/srv/GetTypeDescription_Response"}}, {"name": "event_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "type_description_interfaces/srv/GetTypeDescription_Event"}}]}"#,
        event_type: "type_description_interfaces/srv/GetTypeDescription_Event",
        event_description: r#"{"type_name": "type_description_interfaces/srv/GetTypeDescription_Event", "fields": [{"name": "info", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "service_msgs/msg/ServiceEventInfo"}}, {"name": "request", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "type_description_interfaces/srv/GetTypeDescription_Request"}}, {"name": "response", "type": {"type_id": 97, "capacity": 1, "string_capacity": 0, "nested_type_name": "type_description_interfaces/srv/GetTypeDescription_Response"}}]}"#,
    },
];

/// Every action, sorted by name.
pub const ACTIONS: &[ActionInfo] = &[
    ActionInfo {
        ros_type: "flexdrill/action/WhatIf",
        rihs01: "RIHS01_3b780d28a08bcc955e0ba8d773f0f5015499bd8961918487e46f04dec321d922",
        source: include_str!("../../../msg/WhatIf.action"),
        description: r#"{"type_name": "flexdrill/action/WhatIf", "fields": [{"name": "goal", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_Goal"}}, {"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_Result"}}, {"name": "feedback", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_Feedback"}}, {"name": "send_goal_service", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_SendGoal"}}, {"name": "get_result_service", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_GetResult"}}, {"name": "feedback_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "flexdrill/action/WhatIf_FeedbackMessage"}}]}"#,
    },
    ActionInfo {
        ros_type: "simulation_interfaces/action/SimulateSteps",
        rihs01: "RIHS01_f0837c898e1219cd73bf4c041feab41e8c533e8e1057e982744dba7b093467eb",
        source: include_str!("../../../crates/flexdrill-messages/external/simulation_interfaces/action/SimulateSteps.action"),
        description: r#"{"type_name": "simulation_interfaces/action/SimulateSteps", "fields": [{"name": "goal", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_Goal"}}, {"name": "result", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_Result"}}, {"name": "feedback", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_Feedback"}}, {"name": "send_goal_service", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_SendGoal"}}, {"name": "get_result_service", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_GetResult"}}, {"name": "feedback_message", "type": {"type_id": 1, "capacity": 0, "string_capacity": 0, "nested_type_name": "simulation_interfaces/action/SimulateSteps_FeedbackMessage"}}]}"#,
    },
];
