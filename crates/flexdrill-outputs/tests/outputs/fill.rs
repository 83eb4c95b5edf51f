//! Messages made from a snapshot say what the snapshot says.

use flexdrill_core::tool::Body;
use flexdrill_core::twin::{ContactLayer, Holder, Snapshot};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::visualization_msgs::{Marker, MarkerArray};
use flexdrill_messages::{
    Ageing, BitState, ContactForces, JointDeflections, Reactions, Transfer, WhirlWarning, sensor_msgs,
};
use flexdrill_motion::{DriveState, Hold, Severity, ShockLevel, WhirlKind};
use flexdrill_outputs::fill::{self, ShapeStyle};

fn header() -> Header {
    Header {
        stamp: Time {
            sec: 100,
            nanosec: 500_000_000,
        },
        frame_id: "tool".to_owned(),
    }
}

fn layer(normal: [f64; 2]) -> ContactLayer {
    let mut layer = ContactLayer::default();
    layer.gap = vec![0.0; 2];
    layer.normal = normal.to_vec();
    layer.tangential = vec![0.0; 2];
    layer.axial = vec![0.0; 2];
    layer.normal_peak = normal.iter().map(|force| force * 2.0).collect();
    layer.normal_rms = normal.to_vec();
    layer.shock = normal.iter().map(|force| force * 1e-3).collect();
    layer
}

fn snapshot() -> Snapshot {
    let mut snapshot = Snapshot::default();
    snapshot.time = 3.0;
    snapshot.hazards.drive = DriveState::Turning;
    snapshot.joints.bend_angle = vec![0.01, 0.06, 0.05];
    snapshot.joints.limit_angle = vec![0.05; 3];
    snapshot.contacts.state = vec![ContactForces::INNER, ContactForces::FREE];
    snapshot.contacts.pipe_guide = layer([1000.0, 0.0]);
    snapshot.contacts.guide_wall = layer([0.0, 0.0]);
    snapshot.shape.bore = vec![[0.0; 3], [0.0, 0.0, 1.0]];
    snapshot.shape.low_side = vec![[-1.0, 0.0, 0.0]; 2];
    snapshot.shape.pipe = vec![[0.0, 0.002], [0.0, 0.0]];
    snapshot.shape.guide = vec![[0.0, 0.0]; 2];
    snapshot
}

#[test]
fn joints_name_the_largest_bend_and_count_those_at_the_limit() {
    let mut message = JointDeflections::default();
    fill::joint_deflections(&snapshot(), &header(), &mut message);
    assert_eq!(message.header, header());
    assert_eq!((message.max_bend_angle, message.max_bend_joint), (0.06, 1));
    assert_eq!(message.joints_at_limit, 2);

    let mut stock = sensor_msgs::JointState::default();
    fill::joint_state(&snapshot(), &header(), &mut stock);
    assert_eq!(stock.name, ["joint_01", "joint_02", "joint_03"]);
    assert_eq!(stock.position, [0.01, 0.06, 0.05]);
}

#[test]
fn the_largest_contact_force_is_the_interval_s_peak() {
    let mut message = ContactForces::default();
    fill::contact_forces(&snapshot(), &header(), &mut message);
    assert_eq!(
        (message.max_pipe_guide_force, message.max_pipe_guide_station),
        (2000.0, 0)
    );
    assert_eq!((message.max_guide_wall_force, message.max_guide_wall_station), (0.0, 0));
    assert_eq!(message.state, [1, 0]);
    assert_eq!(message.pipe_guide_shock, [1.0, 0.0]);
}

#[test]
fn ageing_is_told_per_hour_and_relative_to_the_worst() {
    let mut snapshot = snapshot();
    snapshot.joints.measured_depth = vec![0.15, 0.3, 0.45];
    snapshot.ageing.duration = 1800.0;
    snapshot.ageing.stop_damage = vec![1.0, 0.0, 3.0];
    snapshot.ageing.bending_damage = vec![2.0, 4.0, 0.0];
    snapshot.ageing.friction_work = [vec![5.0, 6.0], vec![7.0, 8.0]];
    let mut message = Ageing::default();
    fill::ageing(&snapshot, &header(), &mut message);
    assert_eq!(message.stop_damage_rate, [2.0, 0.0, 6.0]);
    assert_eq!(message.bending_damage_rate, [4.0, 8.0, 0.0]);
    assert_eq!(message.relative_damage, [0.5, 1.0, 0.75]);
    assert_eq!(message.guide_wall_friction_work, [7.0, 8.0]);
    assert_eq!(message.joint_measured_depth.len(), 3);
    assert_eq!(message.woehler_slope, 5.0);
}

/// Every figure of the message is another one of the snapshot: none is left out, and none stands twice.
#[test]
fn transfer_fills_every_field_with_its_own_figure() {
    let mut snapshot = snapshot();
    let mut next = 0.0;
    let mut number = || {
        next += 1.0;
        next
    };
    let from = &mut snapshot.transfer;
    from.duration = number();
    for along in [&mut from.torque, &mut from.weight] {
        (along.mean, along.rms) = ([0; 3].map(|_| number()), [0; 3].map(|_| number()));
    }
    from.mean.axial_drag = [0; 3].map(|_| number());
    from.mean.friction_power = [0; 3].map(|_| number());
    from.friction_torque = [0; 4].map(|_| number());
    from.mean.hook_load = number();
    from.mean.depth_of_cut = number();
    from.mean.rate_of_penetration = number();
    from.mean.drive_at_limit = number();
    from.torque_efficiency = number();
    let power = &mut from.power;
    for power in [
        &mut power.drive,
        &mut power.hoist,
        &mut power.weight_on_bit,
        &mut power.gravity,
        &mut power.loads,
        &mut power.feed,
        &mut power.pressure,
        &mut power.bit,
        &mut power.friction,
        &mut power.contact_damping,
        &mut power.rayleigh_damping,
        &mut power.numerical_damping,
        &mut power.string,
        &mut power.axial_update,
        &mut power.stored,
        &mut power.error,
        &mut power.mud,
    ] {
        *power = number();
    }
    let mut message = Transfer::default();
    fill::transfer(&snapshot, &header(), &mut message);
    let json = serde_json::to_value(&message).unwrap();
    let mut values: Vec<f64> = json
        .as_object()
        .unwrap()
        .values()
        .filter_map(serde_json::Value::as_f64)
        .collect();
    values.sort_by(f64::total_cmp);
    assert_eq!(values, (1..=next as u32).map(f64::from).collect::<Vec<_>>());
    assert_eq!((message.surface_torque, message.bit_torque_rms), (2.0, 7.0));
    assert_eq!((message.duration, message.mud_power), (1.0, next));
}

#[test]
fn reactions_are_vectors_by_axis_and_support() {
    let mut snapshot = snapshot();
    let reactions = &mut snapshot.reactions;
    reactions.measured_depth = vec![0.0, 5.0];
    reactions.inclination = vec![0.0, 1.5];
    reactions.holder = vec![Holder::Support(Body::Pipe), Holder::String];
    reactions.force = vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    reactions.moment = vec![[0.0; 3], [7.0, 8.0, 9.0]];
    reactions.supports = [5.0, 7.0, 9.0];
    reactions.top_torque = 300.0;
    reactions.unbalance = [0.0, 0.0, 0.1];
    let mut message = Reactions::default();
    fill::reactions(&snapshot, &header(), &mut message);
    // A second time: what was there is gone.
    fill::reactions(&snapshot, &header(), &mut message);
    assert_eq!(message.body, [Reactions::PIPE, Reactions::STRING]);
    assert_eq!(
        (message.force_x.as_slice(), message.force_z.as_slice()),
        ([1.0, 4.0].as_slice(), [3.0, 6.0].as_slice())
    );
    assert_eq!(message.moment_y, [0.0, 8.0]);
    assert_eq!(message.support_force, [5.0, 7.0, 9.0]);
    assert_eq!((message.unbalanced_force[2], message.drive_torque), (0.1, 300.0));
}

#[test]
fn shock_and_stick_slip_carry_their_levels() {
    let mut snapshot = snapshot();
    snapshot.shock = ShockLevel {
        severity: Severity::Warning,
        layer: 1,
        station: 1,
        impulse: 17.0,
        since: 1.0,
        seen: 1.0,
        hold: Hold::Met,
    };
    snapshot.bit.stick_slip = Severity::Critical;
    snapshot.bit.lateral_impulse = 0.4;
    let mut contacts = ContactForces::default();
    fill::contact_forces(&snapshot, &header(), &mut contacts);
    assert_eq!(contacts.shock_severity, ContactForces::SHOCK_WARNING);
    assert_eq!(
        (contacts.shock_layer, contacts.shock_station, contacts.shock_impulse),
        (ContactForces::OUTER, 1, 17.0)
    );
    let mut bit = BitState::default();
    fill::bit_state(&snapshot, &header(), &mut bit);
    assert_eq!(
        (bit.stick_slip_severity, bit.lateral_impulse),
        (BitState::CRITICAL, 0.4)
    );
}

#[test]
fn a_doubtful_input_is_said_and_rolling_is_told_from_sliding() {
    let mut snapshot = snapshot();
    snapshot.whirl.measured_depth = vec![2.5];
    snapshot.whirl.inclination = vec![0.5];
    snapshot.whirl.body = vec![Body::Pipe];
    snapshot.warning.severity = Severity::Warning;
    snapshot.warning.kind = WhirlKind::Backward;
    snapshot.warning.rolling_share = 0.97;
    snapshot.warning.rolling = true;
    snapshot.warning.confidence = 0.54;
    snapshot.warning.peak_force = 7300.0;
    let mut message = WhirlWarning::default();
    let mut said = |snapshot: &Snapshot, quality| {
        fill::whirl_warning(snapshot, &header(), quality, &mut message);
        assert_eq!(
            (message.input_quality, message.confidence, message.peak_force),
            (quality, 0.54, 7300.0)
        );
        message.message.clone()
    };
    let fresh = said(&snapshot, WhirlWarning::INPUT_OK);
    assert!(fresh.contains("rolling (97 % of the rate without slip)"), "{fresh}");
    assert!(fresh.contains("up to 7.30 kN, confidence 54 %"), "{fresh}");
    assert!(!fresh.contains("input"), "{fresh}");
    let stale = said(&snapshot, WhirlWarning::INPUT_STALE);
    assert!(
        stale.ends_with("at held or safe values, and the confidence is lower."),
        "{stale}"
    );
    let rejected = said(&snapshot, WhirlWarning::INPUT_REJECTED);
    assert!(rejected.contains("was rejected"), "{rejected}");
    (snapshot.warning.rolling_share, snapshot.warning.rolling) = (0.6, false);
    let sliding = said(&snapshot, WhirlWarning::INPUT_OK);
    assert!(sliding.contains("sliding (60 % of the rate without slip)"), "{sliding}");
    // That all is well is doubtful too when nobody knows what the tool is doing.
    snapshot.warning.severity = Severity::Ok;
    let calm = said(&snapshot, WhirlWarning::INPUT_NOT_RECEIVED);
    assert!(
        calm.starts_with("No whirl") && calm.contains("No input has been received"),
        "{calm}"
    );
}

#[test]
fn a_warning_names_its_place_and_when_it_began() {
    let mut snapshot = snapshot();
    snapshot.whirl.measured_depth = vec![1.0, 2.5];
    snapshot.whirl.inclination = vec![0.0, 0.5];
    snapshot.whirl.body = vec![Body::Pipe, Body::Guide];
    snapshot.warning.entry = 1;
    snapshot.warning.severity = Severity::Warning;
    snapshot.warning.kind = WhirlKind::Backward;
    snapshot.warning.since = 2.0;
    let mut message = WhirlWarning::default();
    fill::whirl_warning(&snapshot, &header(), WhirlWarning::INPUT_SLOW, &mut message);
    assert_eq!(message.body, WhirlWarning::GUIDE);
    assert_eq!(message.measured_depth, 2.5);
    assert_eq!(
        message.since,
        Time {
            sec: 99,
            nanosec: 500_000_000
        }
    );
    assert_eq!(message.input_quality, WhirlWarning::INPUT_SLOW);
    assert!(
        message
            .message
            .starts_with("Warning: backward whirl of the guide pipe at 2.50 m"),
        "{}",
        message.message
    );

    // While the drive is run up the alarms of whirl are suppressed, and so is the warning.
    snapshot.hazards.drive = DriveState::RunningUp;
    fill::whirl_warning(&snapshot, &header(), WhirlWarning::INPUT_OK, &mut message);
    assert_eq!(message.severity, WhirlWarning::OK);
    assert!(
        message.message.contains("standstill or starting"),
        "{}",
        message.message
    );

    snapshot.warning.entry = 9;
    fill::whirl_warning(&snapshot, &header(), 0, &mut message);
    assert_eq!(message.measured_depth, 0.0);
}

#[test]
fn the_shape_is_exaggerated_and_contacts_push_towards_the_axis() {
    let mut message = MarkerArray::default();
    fill::tool_shape(&snapshot(), &header(), &ShapeStyle::new(10.0), &mut message);
    let marker = |name: &str| message.markers.iter().find(|marker| marker.ns == name).unwrap();
    // 2 mm towards the low side, which is -X here, ten times enlarged.
    assert!((marker("flexible_pipe").points[0].x + 0.02).abs() < 1e-12);
    let contact = marker("pipe_guide_contact");
    assert_eq!(contact.type_, Marker::LINE_LIST);
    assert_eq!((contact.points.len(), contact.colors.len()), (6, 6));
    assert!(
        contact.points[1].x > contact.points[0].x,
        "the force on the pipe points away from the low side"
    );
    assert_eq!(marker("guide_wall_contact").action, Marker::DELETE);
}

#[test]
fn an_empty_snapshot_fills_everything() {
    let (empty, header) = (Snapshot::default(), Header::default());
    let mut shape = MarkerArray::default();
    fill::tool_shape(&empty, &header, &ShapeStyle::new(1.0), &mut shape);
    assert!(shape.markers.iter().all(|marker| marker.action == Marker::DELETE));
    let mut joints = JointDeflections::default();
    fill::joint_deflections(&empty, &header, &mut joints);
    assert_eq!(joints.max_bend_joint, 0);
}
