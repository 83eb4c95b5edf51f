//! The tool: inputs, joints, contacts, bit, reactions, shape.

use super::Read::{Code, Codes, Few, List, Number, Pairs, Triples};
use super::{Column, Group, holder_code};

pub(super) const APPLIED: Group = Group::new(
    "applied",
    &[
        Column::new("rotary_speed_rad_per_s", Number(|s| s.applied.rotary_speed)),
        Column::new("drive_angle_rad", Number(|s| s.applied.drive_angle)),
        Column::new("drive_torque_nm", Number(|s| s.applied.drive_torque)),
        Column::new("weight_on_bit_n", Number(|s| s.applied.weight_on_bit)),
        Column::new("weight_set_n", Number(|s| s.applied.weight_set)),
        Column::new(
            "weight_at_kickoff_n",
            Number(|s| s.applied.weight_at_kickoff.unwrap_or(f64::NAN)),
        ),
        Column::new("rate_of_penetration_m_per_s", Number(|s| s.applied.rate_of_penetration)),
        Column::new("standpipe_pressure_pa", Number(|s| s.applied.standpipe_pressure)),
    ],
);

pub(super) const JOINTS: Group = Group::new(
    "joints",
    &[
        Column::fixed("measured_depth_m", List(|s| &s.joints.measured_depth)),
        Column::fixed("inclination_rad", List(|s| &s.joints.inclination)),
        Column::new("bend_angle_rad", List(|s| &s.joints.bend_angle)),
        Column::new("bend_direction_rad", List(|s| &s.joints.bend_direction)),
        Column::new("limit_angle_rad", List(|s| &s.joints.limit_angle)),
        Column::new("stop_moment_nm", List(|s| &s.joints.stop_moment)),
        Column::new("lateral_y_m", List(|s| &s.joints.lateral_y)),
        Column::new("lateral_z_m", List(|s| &s.joints.lateral_z)),
        Column::new("spin_rate_rad_per_s", List(|s| &s.joints.spin_rate)),
        Column::new("axial_force_n", List(|s| &s.joints.axial_force)),
        Column::new("shear_force_n", List(|s| &s.joints.shear_force)),
        Column::new("torque_nm", List(|s| &s.joints.torque)),
    ],
);

pub(super) const CONTACTS: Group = Group::new(
    "contacts",
    &[
        Column::fixed("measured_depth_m", List(|s| &s.contacts.measured_depth)),
        Column::fixed("inclination_rad", List(|s| &s.contacts.inclination)),
        Column::new("state", Codes(|s, out| out.extend(&s.contacts.state))),
        Column::new("pipe_guide_gap_m", List(|s| &s.contacts.pipe_guide.gap)),
        Column::new("pipe_guide_normal_n", List(|s| &s.contacts.pipe_guide.normal)),
        Column::new("pipe_guide_tangential_n", List(|s| &s.contacts.pipe_guide.tangential)),
        Column::new("pipe_guide_axial_n", List(|s| &s.contacts.pipe_guide.axial)),
        Column::new("pipe_guide_normal_peak_n", List(|s| &s.contacts.pipe_guide.normal_peak)),
        Column::new("pipe_guide_normal_rms_n", List(|s| &s.contacts.pipe_guide.normal_rms)),
        Column::new("pipe_guide_shock_ns", List(|s| &s.contacts.pipe_guide.shock)),
        Column::new("guide_wall_gap_m", List(|s| &s.contacts.guide_wall.gap)),
        Column::new("guide_wall_normal_n", List(|s| &s.contacts.guide_wall.normal)),
        Column::new("guide_wall_tangential_n", List(|s| &s.contacts.guide_wall.tangential)),
        Column::new("guide_wall_axial_n", List(|s| &s.contacts.guide_wall.axial)),
        Column::new("guide_wall_normal_peak_n", List(|s| &s.contacts.guide_wall.normal_peak)),
        Column::new("guide_wall_normal_rms_n", List(|s| &s.contacts.guide_wall.normal_rms)),
        Column::new("guide_wall_shock_ns", List(|s| &s.contacts.guide_wall.shock)),
    ],
);

/// The bit at the instant of the sample; its published figures follow from their table.
pub(super) const BIT: Group = Group::new(
    "bit",
    &[
        Column::new("torque_nm", Number(|s| s.bit.torque)),
        Column::new("rotary_speed_rad_per_s", Number(|s| s.bit.rotary_speed)),
        Column::new("weight_on_bit_n", Number(|s| s.bit.weight_on_bit)),
        Column::new("stick_slip_severity", Code(|s| s.bit.stick_slip as u8)),
    ],
);

pub(super) const REACTIONS: Group = Group::new(
    "reactions",
    &[
        Column::fixed("measured_depth_m", List(|s| &s.reactions.measured_depth)),
        Column::fixed("inclination_rad", List(|s| &s.reactions.inclination)),
        Column::fixed(
            "body",
            Codes(|s, out| out.extend(s.reactions.holder.iter().map(|holder| holder_code(*holder)))),
        ),
        Column::new("force_n", Triples(|s| &s.reactions.force)),
        Column::new("moment_nm", Triples(|s| &s.reactions.moment)),
        Column::new("supports_n", Few(|s, out| out.extend(s.reactions.supports))),
        Column::new("weight_n", Few(|s, out| out.extend(s.reactions.weight))),
        Column::new("wall_n", Few(|s, out| out.extend(s.reactions.wall))),
        Column::new("bit_n", Few(|s, out| out.extend(s.reactions.bit))),
        Column::new("loads_n", Few(|s, out| out.extend(s.reactions.loads))),
        Column::new("inertia_n", Few(|s, out| out.extend(s.reactions.inertia))),
        Column::new("damping_n", Few(|s, out| out.extend(s.reactions.damping))),
        Column::new("unbalance_n", Few(|s, out| out.extend(s.reactions.unbalance))),
    ],
);

pub(super) const SHAPE: Group = Group::new(
    "shape",
    &[
        Column::fixed("bore_m", Triples(|s| &s.shape.bore)),
        Column::fixed("low_side", Triples(|s| &s.shape.low_side)),
        Column::new("pipe_m", Pairs(|s| &s.shape.pipe)),
        Column::new("guide_m", Pairs(|s| &s.shape.guide)),
    ],
);
