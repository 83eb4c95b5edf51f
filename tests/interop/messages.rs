//! The hashes of all messages, and the bytes of those with content, held against the Python package rosbags.

use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use flexdrill::messages::generated::TYPES;
use flexdrill::messages::sensor_msgs::JointState;
use flexdrill::messages::std_msgs::{ColorRGBA, Float64, Header};
use flexdrill::messages::visualization_msgs::{Marker, MarkerArray};
use flexdrill::messages::{
    Alarm, AlarmEvent, AlarmList, AppliedInputs, BitState, ContactForces, JointDeflections, Message, SessionInfo,
    TwinStatus, TypeInfo, WhirlState, WhirlWarning, rcl_interfaces, to_cdr,
};

/// A line for the script: type, hash, bytes.
fn line<M: Message>(message: &M) -> String {
    let bytes = to_cdr(message).unwrap();
    let text: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("{} {} {text}\n", M::ROS_TYPE, M::RIHS01)
}

fn header() -> Header {
    Header {
        stamp: Time { sec: -5, nanosec: 7 },
        // Of a length that leaves what follows unaligned.
        frame_id: "tööl".to_owned(),
    }
}

#[test]
fn interop_rosbags_agrees_on_hashes_and_bytes() {
    let marker = Marker {
        header: header(),
        type_: Marker::LINE_LIST,
        colors: vec![
            ColorRGBA {
                r: 0.5,
                g: 0.25,
                b: 1.0,
                a: 1.0
            };
            3
        ],
        mesh_use_embedded_materials: true,
        ..Marker::default()
    };
    let status = DiagnosticStatus {
        level: DiagnosticStatus::WARN,
        name: "pacing".to_owned(),
        values: vec![KeyValue {
            key: "lateness".to_owned(),
            value: String::new(),
        }],
        ..DiagnosticStatus::default()
    };
    let lines = [
        line(&Float64 { data: f64::NAN }),
        line(&header()),
        line(&BitState {
            header: header(),
            torque: -1.5,
            lateral_acceleration: 9.0,
            ..BitState::default()
        }),
        line(&JointDeflections {
            header: header(),
            max_bend_joint: 3,
            torque: vec![1.0, 2.0],
            ..JointDeflections::default()
        }),
        line(&ContactForces {
            header: header(),
            state: vec![1, 2, 3],
            pipe_guide_gap: vec![-1e-3; 3],
            guide_wall_normal_rms: vec![5.0; 3],
            ..ContactForces::default()
        }),
        line(&WhirlState {
            body: vec![1],
            kind: vec![2],
            confidence: vec![0.5],
            ..WhirlState::default()
        }),
        line(&WhirlWarning {
            header: header(),
            severity: 3,
            sequence: 9,
            message: "!".to_owned(),
            ..WhirlWarning::default()
        }),
        line(&AlarmList {
            header: header(),
            sequence: 3,
            alarms: vec![
                Alarm {
                    id: "shock".to_owned(),
                    active: true,
                    measured_depth: f64::NAN,
                    evidence: "Collisions.".to_owned(),
                    annunciations: 2,
                    ..Alarm::default()
                };
                2
            ],
            flood: true,
            flood_share: 0.25,
            ..AlarmList::default()
        }),
        line(&AlarmEvent {
            header: header(),
            change: AlarmEvent::SHELVED,
            operator_name: "ann".to_owned(),
            shelved_until: Time { sec: 9, nanosec: 1 },
            value: 4.4,
            ..AlarmEvent::default()
        }),
        line(&TwinStatus {
            header: header(),
            state: TwinStatus::RUNNING,
            last_rejection_cause: "not converged".to_owned(),
            input_name: vec!["a".to_owned(), "bc".to_owned()],
            input_state: vec![1, 2],
            phase_time: vec![1e-4],
            ..TwinStatus::default()
        }),
        line(&AppliedInputs {
            header: header(),
            step: u64::MAX,
            reset: true,
            inner_friction: [0.1, 0.2],
            parameter_name: vec!["x".to_owned()],
            parameter_value: vec![1.0],
            ..AppliedInputs::default()
        }),
        line(&SessionInfo {
            configuration: "a: 1\n".repeat(3000),
            ..SessionInfo::default()
        }),
        line(&JointState {
            name: vec!["joint_01".to_owned()],
            position: vec![0.1],
            ..JointState::default()
        }),
        line(&MarkerArray {
            markers: vec![marker.clone(), marker],
        }),
        line(&DiagnosticArray {
            header: header(),
            status: vec![status],
        }),
        line(&rcl_interfaces::Log {
            level: rcl_interfaces::Log::WARN,
            line: 7,
            ..rcl_interfaces::Log::default()
        }),
        line(&rcl_interfaces::ParameterEvent {
            new_parameters: vec![rcl_interfaces::Parameter {
                name: "p".to_owned(),
                value: rcl_interfaces::ParameterValue {
                    type_: rcl_interfaces::ParameterType::PARAMETER_DOUBLE,
                    double_value: 0.5,
                    bool_array_value: vec![true, false],
                    ..rcl_interfaces::ParameterValue::default()
                },
            }],
            ..rcl_interfaces::ParameterEvent::default()
        }),
    ];
    // The hash of every message, without bytes. rosbags takes `char` for another type than ROS 2 does.
    let has_char = |info: &TypeInfo| info.schema.lines().any(|line| line.starts_with("char"));
    let all = TYPES
        .iter()
        .filter(|info| info.ros_type.contains("/msg/") && !has_char(info));
    let hashes: Vec<String> = all.map(|info| format!("{} {}\n", info.ros_type, info.rihs01)).collect();
    let lines = [lines.as_slice(), &hashes].concat();
    let Some(printed) = crate::common::python::run("messages.py", &[], &lines.concat()) else {
        return;
    };
    let answers: Vec<&str> = printed.lines().collect();
    assert_eq!(answers, vec!["same"; lines.len()]);
}
