//! The table. A row is
//!
//! ```text
//! field: Kind, Window = source [, in Group "label" [as "short label"]] [, bridge "name"];
//! ```
//!
//! where the source reads a part `s` of the snapshot. Rows of a group stand in the order in which tables show them, from
//! the surface to the bit; bridges send theirs in the order of the rows. NaN is a figure that the tool does not have.
//! A message that is made from more than a snapshot has rows without a source, for the bridges alone:
//!
//! ```text
//! field: Kind, Window, bridge "name";
//! ```
//!
//! Friction and drag are arrays: between pipe and guide, between guide and wall, in the joints, and last along the string.

use super::row::{Figure, Group, Kind, Shown, Window};
use crate::fill::largest;
use flexdrill_core::twin::{Joints, Snapshot};
use flexdrill_messages::{BitState, ContactForces, HoleAhead, JointDeflections, Transfer};
use flexdrill_motion::{BIT, KICK_OFF, SURFACE};

macro_rules! figures {
    (
        $(#[$doc:meta])*
        $table:ident of $message:ident, filled by $fill:ident from $s:ident = $part:ident;
        $(
            $field:ident: $kind:ident, $window:ident = $source:expr
            $(, in $group:ident $label:literal $(as $short:literal)?)?
            $(, bridge $bridge:literal)?;
        )*
    ) => {
        $(#[$doc])*
        pub const $table: &[Figure<$message>] = &[$(Figure {
            shown: first(&[$(Shown { group: Group::$group, label: $label, short: last([$label $(, $short)?]) })?]),
            bridge: first(&[$($bridge)?]),
            source: Some(|snapshot| {
                let $s = &snapshot.$part;
                f64::from($source)
            }),
            ..figures!(@row $message $field $kind $window)
        }),*];

        /// Fills the figures of a message.
        pub(crate) fn $fill(snapshot: &Snapshot, out: &mut $message) {
            let $s = &snapshot.$part;
            $(out.$field = $source;)*
        }
    };
    (
        $(#[$doc:meta])*
        $table:ident of $message:ident, made elsewhere;
        $($field:ident: $kind:ident, $window:ident, bridge $bridge:literal;)*
    ) => {
        $(#[$doc])*
        pub const $table: &[Figure<$message>] = &[$(Figure {
            bridge: Some($bridge),
            ..figures!(@row $message $field $kind $window)
        }),*];
    };
    (@row $message:ident $field:ident $kind:ident $window:ident) => {
        Figure {
            field: stringify!($field),
            kind: Kind::$kind,
            window: Window::$window,
            shown: None,
            bridge: None,
            source: None,
            read: |message: &$message| f64::from(message.$field),
            write: |message: &mut $message, value| message.$field.set(value),
        }
    };
}

/// A number in a message.
trait Number {
    fn set(&mut self, value: f64);
}

impl Number for f64 {
    fn set(&mut self, value: f64) {
        *self = value;
    }
}

/// A count: a value beyond its range becomes the nearest one within.
impl Number for u32 {
    fn set(&mut self, value: f64) {
        *self = value as u32;
    }
}

/// 0 and 1.
impl Number for bool {
    fn set(&mut self, value: f64) {
        *self = value != 0.0;
    }
}

/// The short label of a row, or its label where it has no other.
const fn last<const N: usize>(labels: [&'static str; N]) -> &'static str {
    labels[N - 1]
}

/// What a row may have.
const fn first<T: Copy>(given: &[T]) -> Option<T> {
    match given {
        [value, ..] => Some(*value),
        [] => None,
    }
}

figures! {
    /// The figures of `twin/bit_state`.
    BIT_STATE of BitState, filled by fill_bit_state from s = bit;
    torque: Torque, Mean = s.mean_torque,
        in Bit "torque of the rock on the bit" as "torque", bridge "bit_torque";
    rotary_speed: RotarySpeed, Mean = s.mean_rotary_speed,
        in Bit "rotary speed of the bit" as "rotary speed", bridge "bit_rotary_speed";
    weight_on_bit: Weight, Mean = s.mean_weight_on_bit,
        in Bit "weight on bit, at the bit" as "weight", bridge "bit_weight";
    stick_slip_index: Number, Instant = s.stick_slip_index,
        in Bit "stick-slip index", bridge "stick_slip_index";
    tangential_acceleration: Acceleration, Rms = s.tangential_acceleration,
        in Bit "tangential acceleration of the bit" as "tangential acceleration";
    axial_acceleration: Acceleration, Rms = s.axial_acceleration,
        in Bit "axial acceleration of the bit" as "axial acceleration", bridge "bit_axial_vibration";
    lateral_acceleration: Acceleration, Rms = s.lateral_acceleration,
        in Bit "lateral acceleration above the bit" as "lateral acceleration", bridge "bit_lateral_vibration";
    lateral_acceleration_peak: Acceleration, Largest = s.lateral_acceleration_peak,
        in Bit "lateral acceleration above the bit, largest" as "lateral acceleration, largest", bridge "bit_lateral_shock";
    lateral_impulse: Speed, Integral = s.lateral_impulse,
        in Bit "impulse of the lateral acceleration above the bit" as "lateral impulse";
}

figures! {
    /// The totals of `twin/joint_deflections`.
    JOINT_DEFLECTIONS of JointDeflections, filled by fill_joint_deflections from s = joints;
    max_bend_angle: Bend, Instant = largest(&s.bend_angle).0, bridge "max_bend_angle";
    joints_at_limit: Number, Instant = at_limit(s), bridge "joints_at_limit";
}

figures! {
    /// The totals of `twin/contact_forces`.
    CONTACT_FORCES of ContactForces, filled by fill_contact_forces from s = contacts;
    max_pipe_guide_force: Force, Largest = largest(&s.pipe_guide.normal_peak).0, bridge "max_pipe_guide_force";
    max_guide_wall_force: Force, Largest = largest(&s.guide_wall.normal_peak).0, bridge "max_guide_wall_force";
}

figures! {
    /// The figures of `twin/transfer`.
    TRANSFER of Transfer, filled by fill_transfer from s = transfer;
    duration: Time, Instant = s.duration;

    surface_torque: Torque, LongMean = s.torque.mean[SURFACE],
        in Torque "torque at the surface" as "surface", bridge "surface_torque";
    kickoff_torque: Torque, LongMean = s.torque.mean[KICK_OFF],
        in Torque "torque at the kick-off" as "kick-off", bridge "kickoff_torque";
    bit_torque: Torque, LongMean = s.torque.mean[BIT], in Torque "torque at the bit" as "bit";
    surface_torque_rms: Torque, LongRms = s.torque.rms[SURFACE];
    kickoff_torque_rms: Torque, LongRms = s.torque.rms[KICK_OFF];
    bit_torque_rms: Torque, LongRms = s.torque.rms[BIT];
    torque_efficiency: Share, LongMean = s.torque_efficiency, bridge "torque_efficiency";

    string_friction_torque: Torque, LongMean = s.friction_torque[3], in Friction "friction of the string" as "string";
    pipe_guide_friction_torque: Torque, LongMean = s.friction_torque[0],
        in Friction "friction of pipe in guide" as "pipe in guide";
    joint_friction_torque: Torque, LongMean = s.friction_torque[2], in Friction "friction in the joints" as "joints";
    guide_wall_friction_torque: Torque, LongMean = s.friction_torque[1],
        in Friction "friction of the wall on the guide" as "guide on wall";

    surface_weight: Weight, LongMean = s.weight.mean[SURFACE], in Weight "weight at the surface" as "surface";
    kickoff_weight: Weight, LongMean = s.weight.mean[KICK_OFF],
        in Weight "weight at the kick-off, on the guide" as "kick-off";
    bit_weight: Weight, LongMean = s.weight.mean[BIT], in Weight "weight at the bit" as "bit";
    surface_weight_rms: Weight, LongRms = s.weight.rms[SURFACE];
    kickoff_weight_rms: Weight, LongRms = s.weight.rms[KICK_OFF];
    bit_weight_rms: Weight, LongRms = s.weight.rms[BIT];

    string_axial_drag: Weight, LongMean = s.mean.axial_drag[2], in Drag "drag of the string" as "string";
    pipe_guide_axial_drag: Weight, LongMean = s.mean.axial_drag[0],
        in Drag "drag of the guide on the pipe" as "pipe in guide";
    guide_wall_axial_drag: Weight, LongMean = s.mean.axial_drag[1],
        in Drag "drag of the wall on the guide" as "guide on wall";

    drive_at_limit: TimeShare, LongMean = s.mean.drive_at_limit,
        in Whole "top drive at its torque limit" as "top drive at its limit", bridge "drive_at_limit";
    hook_load: Weight, LongMean = s.mean.hook_load, in Whole "hook load", bridge "hook_load";
    rate_of_penetration: Advance, LongMean = s.mean.rate_of_penetration,
        in Whole "rate of penetration of the bit" as "rate of penetration", bridge "rate_of_penetration";
    depth_of_cut: Cut, LongMean = s.mean.depth_of_cut, in Whole "depth of cut";
    weight_arrives: Share, LongMean = s.mean.arrives,
        in Whole "weight that reaches the bit in a clean hole", bridge "weight_arrives";

    drive_power: Power, LongMean = s.power.drive, in PutIn "top drive";
    hoist_power: Power, LongMean = s.power.hoist, in PutIn "hoist";
    weight_on_bit_power: Power, LongMean = s.power.weight_on_bit, in PutIn "weight on bit";
    gravity_power: Power, LongMean = s.power.gravity, in PutIn "gravity";
    feed_power: Power, LongMean = s.power.feed, in PutIn "advance against the wall";
    pressure_power: Power, LongMean = s.power.pressure, in PutIn "pressure";
    load_power: Power, LongMean = s.power.loads, in PutIn "loads";

    bit_power: Power, LongMean = s.power.bit, in Taken "rock";
    pipe_guide_friction_power: Power, LongMean = s.mean.friction_power[0],
        in Taken "friction of pipe in guide" as "pipe in guide";
    guide_wall_friction_power: Power, LongMean = s.mean.friction_power[1],
        in Taken "friction of guide on wall" as "guide on wall";
    joint_friction_power: Power, LongMean = s.mean.friction_power[2], in Taken "friction in the joints" as "joints";
    string_power: Power, LongMean = s.power.string, in Taken "friction and mud along the string" as "string";
    contact_damping_power: Power, LongMean = s.power.contact_damping, in Taken "collisions";
    rayleigh_damping_power: Power, LongMean = s.power.rayleigh_damping, in Taken "damping of the steel";
    mud_power: Power, LongMean = s.power.mud, in Taken "mud around the pipes";
    numerical_damping_power: Power, LongMean = s.power.numerical_damping, in Taken "time integration";

    friction_power: Power, LongMean = s.power.friction;
    axial_update_power: Power, LongMean = s.power.axial_update;
    stored_power: Power, LongMean = s.power.stored;
    error_power: Power, LongMean = s.power.error;
}

figures! {
    /// The figures of `twin/hole_ahead` that bridges send. NaN where the hole ahead is not known.
    HOLE_AHEAD of HoleAhead, made elsewhere;
    known: Number, Instant, bridge "hole_known";
    radius: Length, Instant, bridge "hole_radius";
    build_rate: TurnRate, Instant, bridge "hole_build_rate";
    walk_rate: TurnRate, Instant, bridge "hole_walk_rate";
    plan_off: Number, Instant, bridge "hole_plan_off";
    plan_weight: Weight, Instant, bridge "hole_plan_weight";
}

/// Number of joints at the limit of their angle.
fn at_limit(joints: &Joints) -> u32 {
    let angles = joints.bend_angle.iter().zip(&joints.limit_angle);
    angles.filter(|(angle, limit)| angle >= limit).count() as u32
}
