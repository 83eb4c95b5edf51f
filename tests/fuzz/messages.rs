//! CDR: every message type in both byte orders, and requests in both forms in which they travel.

use std::sync::LazyLock;

use flexdrill::ahead::{Candidate, Ends, Goal};
use flexdrill::messages::generated::{
    TYPES, action_msgs, builtin_interfaces, diagnostic_msgs, flexdrill as ours, geometry_msgs, lifecycle_msgs,
    rcl_interfaces, rosgraph_msgs, sensor_msgs, service_msgs, simulation_interfaces, std_msgs, std_srvs, tf2_msgs,
    type_description_interfaces, unique_identifier_msgs, visualization_msgs,
};
use flexdrill::messages::{Message, find_type, from_cdr, from_cdr_body, to_cdr, to_cdr_body};
use flexdrill_config::Config;
use flexdrill_core::inputs::InputKind;

use crate::engine::Target;
use crate::says_why;

/// Whether the bytes are a message; one that is has bytes that read as the same.
fn read<M: Message>(bytes: &[u8]) -> bool {
    let message = match from_cdr::<M>(bytes) {
        Ok(message) => message,
        Err(error) => {
            assert!(error.to_string().contains(M::ROS_TYPE), "{error}");
            return says_why(&error);
        }
    };
    let written = to_cdr(&message).unwrap();
    let again = to_cdr(&from_cdr::<M>(&written).unwrap()).unwrap();
    assert!(again == written, "{}: other bytes", M::ROS_TYPE);
    true
}

type Read = fn(&[u8]) -> bool;

/// Every type with its reader and a default message.
macro_rules! types {
    ($($package:ident::$name:ident,)*) => {
        const READERS: &[(&str, Read)] = &[$((<$package::$name as Message>::ROS_TYPE, read::<$package::$name>)),*];

        fn defaults() -> Vec<Vec<u8>> {
            vec![$(to_cdr(&$package::$name::default()).unwrap()),*]
        }
    };
}

types! {
    action_msgs::GoalInfo,
    action_msgs::GoalStatus,
    action_msgs::GoalStatusArray,
    action_msgs::CancelGoalRequest,
    action_msgs::CancelGoalResponse,
    builtin_interfaces::Duration,
    builtin_interfaces::Time,
    diagnostic_msgs::DiagnosticArray,
    diagnostic_msgs::DiagnosticStatus,
    diagnostic_msgs::KeyValue,
    ours::WhatIfFeedback,
    ours::WhatIfFeedbackMessage,
    ours::WhatIfGetResultRequest,
    ours::WhatIfGetResultResponse,
    ours::WhatIfGoal,
    ours::WhatIfResult,
    ours::WhatIfSendGoalRequest,
    ours::WhatIfSendGoalResponse,
    ours::Ageing,
    ours::Alarm,
    ours::AlarmChance,
    ours::AlarmEvent,
    ours::AlarmList,
    ours::AppliedInputs,
    ours::Bands,
    ours::BitState,
    ours::ContactForces,
    ours::FigureBand,
    ours::Forecast,
    ours::ForecastBand,
    ours::HoleAhead,
    ours::HoleDrilled,
    ours::JointDeflections,
    ours::Reactions,
    ours::Residual,
    ours::Residuals,
    ours::RigInputs,
    ours::RigMeasured,
    ours::RigSurvey,
    ours::SafeWindow,
    ours::SessionInfo,
    ours::Transfer,
    ours::TwinStatus,
    ours::WhatIfAnswer,
    ours::WhatIfCandidate,
    ours::WhirlState,
    ours::WhirlWarning,
    ours::AcknowledgeAlarmRequest,
    ours::AcknowledgeAlarmResponse,
    ours::ConfirmMappingRequest,
    ours::ConfirmMappingResponse,
    ours::ShelveAlarmRequest,
    ours::ShelveAlarmResponse,
    ours::UnshelveAlarmRequest,
    ours::UnshelveAlarmResponse,
    geometry_msgs::Point,
    geometry_msgs::Pose,
    geometry_msgs::Quaternion,
    geometry_msgs::Transform,
    geometry_msgs::TransformStamped,
    geometry_msgs::Vector3,
    lifecycle_msgs::State,
    lifecycle_msgs::Transition,
    lifecycle_msgs::TransitionDescription,
    lifecycle_msgs::TransitionEvent,
    lifecycle_msgs::ChangeStateRequest,
    lifecycle_msgs::ChangeStateResponse,
    lifecycle_msgs::GetAvailableStatesRequest,
    lifecycle_msgs::GetAvailableStatesResponse,
    lifecycle_msgs::GetAvailableTransitionsRequest,
    lifecycle_msgs::GetAvailableTransitionsResponse,
    lifecycle_msgs::GetStateRequest,
    lifecycle_msgs::GetStateResponse,
    rcl_interfaces::FloatingPointRange,
    rcl_interfaces::IntegerRange,
    rcl_interfaces::ListParametersResult,
    rcl_interfaces::Log,
    rcl_interfaces::LoggerLevel,
    rcl_interfaces::Parameter,
    rcl_interfaces::ParameterDescriptor,
    rcl_interfaces::ParameterEvent,
    rcl_interfaces::ParameterType,
    rcl_interfaces::ParameterValue,
    rcl_interfaces::SetLoggerLevelsResult,
    rcl_interfaces::SetParametersResult,
    rcl_interfaces::DescribeParametersRequest,
    rcl_interfaces::DescribeParametersResponse,
    rcl_interfaces::GetLoggerLevelsRequest,
    rcl_interfaces::GetLoggerLevelsResponse,
    rcl_interfaces::GetParameterTypesRequest,
    rcl_interfaces::GetParameterTypesResponse,
    rcl_interfaces::GetParametersRequest,
    rcl_interfaces::GetParametersResponse,
    rcl_interfaces::ListParametersRequest,
    rcl_interfaces::ListParametersResponse,
    rcl_interfaces::SetLoggerLevelsRequest,
    rcl_interfaces::SetLoggerLevelsResponse,
    rcl_interfaces::SetParametersAtomicallyRequest,
    rcl_interfaces::SetParametersAtomicallyResponse,
    rcl_interfaces::SetParametersRequest,
    rcl_interfaces::SetParametersResponse,
    rosgraph_msgs::Clock,
    sensor_msgs::CompressedImage,
    sensor_msgs::JointState,
    service_msgs::ServiceEventInfo,
    simulation_interfaces::SimulateStepsFeedback,
    simulation_interfaces::SimulateStepsFeedbackMessage,
    simulation_interfaces::SimulateStepsGetResultRequest,
    simulation_interfaces::SimulateStepsGetResultResponse,
    simulation_interfaces::SimulateStepsGoal,
    simulation_interfaces::SimulateStepsResult,
    simulation_interfaces::SimulateStepsSendGoalRequest,
    simulation_interfaces::SimulateStepsSendGoalResponse,
    simulation_interfaces::Result,
    simulation_interfaces::SimulationState,
    simulation_interfaces::SimulatorFeatures,
    simulation_interfaces::GetSimulationStateRequest,
    simulation_interfaces::GetSimulationStateResponse,
    simulation_interfaces::GetSimulatorFeaturesRequest,
    simulation_interfaces::GetSimulatorFeaturesResponse,
    simulation_interfaces::ResetSimulationRequest,
    simulation_interfaces::ResetSimulationResponse,
    simulation_interfaces::SetSimulationStateRequest,
    simulation_interfaces::SetSimulationStateResponse,
    simulation_interfaces::StepSimulationRequest,
    simulation_interfaces::StepSimulationResponse,
    std_msgs::ColorRGBA,
    std_msgs::Float64,
    std_msgs::Header,
    std_msgs::String,
    std_srvs::SetBoolRequest,
    std_srvs::SetBoolResponse,
    std_srvs::TriggerRequest,
    std_srvs::TriggerResponse,
    tf2_msgs::TFMessage,
    type_description_interfaces::Field,
    type_description_interfaces::FieldType,
    type_description_interfaces::IndividualTypeDescription,
    type_description_interfaces::KeyValue,
    type_description_interfaces::TypeDescription,
    type_description_interfaces::TypeSource,
    type_description_interfaces::GetTypeDescriptionRequest,
    type_description_interfaces::GetTypeDescriptionResponse,
    unique_identifier_msgs::UUID,
    visualization_msgs::Marker,
    visualization_msgs::MarkerArray,
    visualization_msgs::MeshFile,
    visualization_msgs::UVCoordinate,
}

/// The number of a type in [`READERS`].
fn number<M: Message>() -> u8 {
    READERS.iter().position(|(name, _)| *name == M::ROS_TYPE).unwrap() as u8
}

/// The number of a type, before bytes of it.
fn input<M: Message>(message: &M) -> Vec<u8> {
    [vec![number::<M>()], to_cdr(message).unwrap()].concat()
}

/// Messages with something in their lists.
fn filled() -> Vec<Vec<u8>> {
    let text = |text: &str| text.to_owned();
    let value = diagnostic_msgs::KeyValue {
        key: text("pace"),
        value: text("1.0"),
    };
    let status = diagnostic_msgs::DiagnosticStatus {
        name: text("flexdrill: solver"),
        message: text("fine"),
        values: vec![value; 3],
        ..Default::default()
    };
    let parameter = rcl_interfaces::Parameter {
        name: text("rates.bit_state"),
        value: rcl_interfaces::ParameterValue {
            type_: 3,
            double_array_value: vec![1.0, f64::NAN],
            string_array_value: vec![text("a"), text("")],
            ..Default::default()
        },
    };
    let marker = visualization_msgs::Marker {
        ns: text("tool"),
        points: vec![geometry_msgs::Point::default(); 4],
        colors: vec![std_msgs::ColorRGBA::default(); 2],
        uv_coordinates: vec![visualization_msgs::UVCoordinate::default(); 2],
        ..Default::default()
    };
    vec![
        input(&ours::TwinStatus {
            version: text("0.1.0"),
            input_name: InputKind::ALL.map(|kind| kind.name().to_owned()).to_vec(),
            input_age: vec![0.1, f64::INFINITY],
            ..Default::default()
        }),
        input(&ours::ContactForces {
            state: vec![ours::ContactForces::BOTH; 9],
            pipe_guide_normal: vec![3.5; 9],
            ..Default::default()
        }),
        input(&ours::AlarmList {
            alarms: vec![ours::Alarm::default(); 3],
            ..Default::default()
        }),
        input(&diagnostic_msgs::DiagnosticArray {
            status: vec![status; 2],
            ..Default::default()
        }),
        input(&rcl_interfaces::SetParametersRequest {
            parameters: vec![parameter; 2],
        }),
        input(&visualization_msgs::MarkerArray {
            markers: vec![marker; 2],
        }),
        input(&tf2_msgs::TFMessage {
            transforms: vec![geometry_msgs::TransformStamped::default(); 2],
        }),
        // A time in the other byte order: 7 s and 9 ns.
        [
            &[number::<builtin_interfaces::Time>(), 0, 0, 0, 0][..],
            &[0, 0, 0, 7, 0, 0, 0, 9],
        ]
        .concat(),
    ]
}

/// The first byte is the type.
#[test]
fn cdr() {
    assert!(READERS.len() == TYPES.len() && READERS.iter().all(|(name, _)| find_type(name).is_some()));
    let defaults = defaults().into_iter().enumerate();
    let seeds = defaults.map(|(index, bytes)| [vec![index as u8], bytes].concat());
    Target {
        name: "cdr",
        seeds: seeds.chain(filled()).collect(),
        words: &["\0\0\0\0", "\u{1}\0\0\0", "\0\u{1}\0\0", "twin"],
        run: &mut |bytes| {
            let Some((kind, bytes)) = bytes.split_first() else {
                return false;
            };
            let (_, read) = READERS[usize::from(*kind) % READERS.len()];
            read(bytes)
        },
    }
    .fuzz();
}

/// Whether the bytes begin as a request; one that does has bytes that read as the same.
fn request<M: Message>(body: &[u8]) -> bool {
    match from_cdr_body::<M>(body) {
        Ok((request, used)) => {
            assert!(used <= body.len(), "{}: {used} of {} bytes", M::ROS_TYPE, body.len());
            let written = to_cdr_body(&request).unwrap();
            let (again, _) = from_cdr_body::<M>(&written).unwrap();
            assert!(to_cdr_body(&again).unwrap() == written, "{}: other bytes", M::ROS_TYPE);
            true
        }
        Err(error) => says_why(&error),
    }
}

const REQUESTS: &[Read] = &[
    request::<std_srvs::TriggerRequest>,
    request::<std_srvs::SetBoolRequest>,
    request::<ours::AcknowledgeAlarmRequest>,
    request::<ours::ShelveAlarmRequest>,
    request::<ours::UnshelveAlarmRequest>,
    request::<rcl_interfaces::DescribeParametersRequest>,
    request::<rcl_interfaces::GetParametersRequest>,
    request::<rcl_interfaces::GetParameterTypesRequest>,
    request::<rcl_interfaces::ListParametersRequest>,
    request::<rcl_interfaces::SetParametersRequest>,
    request::<rcl_interfaces::SetParametersAtomicallyRequest>,
    request::<rcl_interfaces::GetLoggerLevelsRequest>,
    request::<rcl_interfaces::SetLoggerLevelsRequest>,
    request::<type_description_interfaces::GetTypeDescriptionRequest>,
    request::<lifecycle_msgs::ChangeStateRequest>,
    request::<lifecycle_msgs::GetStateRequest>,
    request::<lifecycle_msgs::GetAvailableStatesRequest>,
    request::<lifecycle_msgs::GetAvailableTransitionsRequest>,
    goal,
    request::<ours::WhatIfGetResultRequest>,
    request::<action_msgs::CancelGoalRequest>,
    request::<simulation_interfaces::GetSimulatorFeaturesRequest>,
    request::<simulation_interfaces::GetSimulationStateRequest>,
    request::<simulation_interfaces::SetSimulationStateRequest>,
    request::<simulation_interfaces::ResetSimulationRequest>,
    request::<simulation_interfaces::StepSimulationRequest>,
    request::<simulation_interfaces::SimulateStepsSendGoalRequest>,
    request::<simulation_interfaces::SimulateStepsGetResultRequest>,
    request::<ours::ConfirmMappingRequest>,
];

/// A request that begins a look-ahead: what its bytes ask for is within the bounds, or is refused in words.
fn goal(body: &[u8]) -> bool {
    static CONFIG: LazyLock<Config> =
        LazyLock::new(|| Config::from_text("coarse.yaml", include_str!("../../config/coarse.yaml")).unwrap());
    if let Ok((asked, _)) = from_cdr_body::<ours::WhatIfSendGoalRequest>(body) {
        let asked = asked.goal;
        let goal = Goal {
            candidates: asked
                .candidates
                .iter()
                .map(|of| Candidate {
                    rotary_speed: of.rotary_speed,
                    weight_on_bit: of.weight_on_bit,
                    speed_ramp: of.speed_ramp,
                    weight_ramp: of.weight_ramp,
                })
                .collect(),
            horizon: asked.horizon,
            members: asked.members,
            run_all: asked.run_all,
            ends: Ends::Horizon,
            seed: asked.seed,
        };
        match goal.check(&CONFIG) {
            Ok(()) => {
                let all = goal.horizon * f64::from(goal.members) * goal.candidates.len() as f64;
                assert!(all <= 72_000.0 && goal.candidates.len() <= 16, "{goal:?}");
            }
            Err(error) => {
                says_why(&error);
            }
        }
    }
    request::<ours::WhatIfSendGoalRequest>(body)
}

/// The first byte is the service; the rest comes as rmw_fastrtps sends it, and as rmw_cyclonedds does behind 16 bytes.
#[test]
fn requests() {
    let names = vec!["use_sim_time".to_owned(), "bit.friction_factor".to_owned()];
    let list = rcl_interfaces::ListParametersRequest {
        prefixes: names.clone(),
        depth: 2,
    };
    let get = rcl_interfaces::GetParametersRequest { names };
    let set = rcl_interfaces::SetParametersRequest {
        parameters: vec![rcl_interfaces::Parameter::default(); 2],
    };
    let shelve = ours::ShelveAlarmRequest::default();
    let what_if = ours::WhatIfSendGoalRequest {
        goal: ours::WhatIfGoal {
            candidates: vec![
                ours::WhatIfCandidate {
                    rotary_speed: 60.0,
                    weight_on_bit: 12.0,
                    ..Default::default()
                };
                2
            ],
            horizon: 30.0,
            members: 20,
            ..Default::default()
        },
        ..Default::default()
    };
    let seed = |kind: u8, bytes: Vec<u8>| [vec![kind], bytes].concat();
    Target {
        name: "requests",
        seeds: vec![
            seed(0, vec![0]),
            seed(3, to_cdr_body(&shelve).unwrap()),
            seed(6, to_cdr_body(&get).unwrap()),
            seed(6, [vec![7; 16], to_cdr_body(&get).unwrap()].concat()),
            seed(8, to_cdr_body(&list).unwrap()),
            seed(9, to_cdr_body(&set).unwrap()),
            seed(18, to_cdr_body(&what_if).unwrap()),
            seed(18, [vec![7; 16], to_cdr_body(&what_if).unwrap()].concat()),
            seed(19, vec![5; 16]),
            seed(20, vec![0; 24]),
        ],
        words: &["\0\0\0\0", "\u{1}\0\0\0", "rates"],
        run: &mut |bytes| {
            let Some((kind, body)) = bytes.split_first() else {
                return false;
            };
            let request = REQUESTS[usize::from(*kind) % REQUESTS.len()];
            let cyclone = body.get(16..).is_some_and(request);
            request(body) || cyclone
        },
    }
    .fuzz();
}
