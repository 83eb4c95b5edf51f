//! What the motion means: transfer, whirl, hazards, ageing; and the quality of the computation.

use super::Read::{Code, Codes, Count, Energy, Few, Indices, List, Number};
use super::{Column, Group, body_code};
use flexdrill_core::dynamics::Energies;
use flexdrill_core::twin::Snapshot;

pub(super) const TRANSFER: Group = Group {
    name: "transfer",
    columns: &[
        Column::new("window_s", Number(|s| s.transfer.duration)),
        Column::new("torque_nm", Few(|s, out| out.extend(s.transfer.torque.mean))),
        Column::new("torque_rms_nm", Few(|s, out| out.extend(s.transfer.torque.rms))),
        Column::new("weight_n", Few(|s, out| out.extend(s.transfer.weight.mean))),
        Column::new("weight_rms_n", Few(|s, out| out.extend(s.transfer.weight.rms))),
        Column::new(
            "friction_torque_nm",
            Few(|s, out| out.extend(s.transfer.friction_torque)),
        ),
        Column::new("axial_drag_n", Few(|s, out| out.extend(s.transfer.mean.axial_drag))),
        Column::new("torque_efficiency", Number(|s| s.transfer.torque_efficiency)),
        Column::new("hook_load_n", Number(|s| s.transfer.mean.hook_load)),
        Column::new("depth_of_cut_m", Number(|s| s.transfer.mean.depth_of_cut)),
        Column::new(
            "rate_of_penetration_m_per_s",
            Number(|s| s.transfer.mean.rate_of_penetration),
        ),
        Column::new("drive_at_limit", Number(|s| s.transfer.mean.drive_at_limit)),
    ],
};

pub(super) const WHIRL: Group = Group {
    name: "whirl",
    columns: &[
        Column::fixed(
            "station",
            Indices(|s, out| out.extend(s.whirl.station.iter().map(|station| *station as u64))),
        ),
        Column::fixed("measured_depth_m", List(|s| &s.whirl.measured_depth)),
        Column::fixed("inclination_rad", List(|s| &s.whirl.inclination)),
        Column::fixed(
            "body",
            Codes(|s, out| out.extend(s.whirl.body.iter().map(|body| body_code(*body)))),
        ),
        Column::new(
            "kind",
            Codes(|s, out| out.extend(s.whirl.kind.iter().map(|kind| *kind as u8))),
        ),
        Column::new("whirl_rate_rad_per_s", List(|s| &s.whirl.whirl_rate)),
        Column::new("whirl_ratio", List(|s| &s.whirl.whirl_ratio)),
        Column::new("orbit_radius_m", List(|s| &s.whirl.orbit_radius)),
        Column::new("clearance_ratio", List(|s| &s.whirl.clearance_ratio)),
        Column::new("contact_duty", List(|s| &s.whirl.contact_duty)),
        Column::new("confidence", List(|s| &s.whirl.confidence)),
        Column::new(
            "severity",
            Codes(|s, out| out.extend(s.whirl.severity.iter().map(|severity| *severity as u8))),
        ),
        Column::new(
            "level_kind",
            Codes(|s, out| out.extend(s.whirl.level_kind.iter().map(|kind| *kind as u8))),
        ),
        Column::new(
            "rolling",
            Codes(|s, out| out.extend(s.whirl.rolling.iter().map(|rolling| u8::from(*rolling)))),
        ),
        Column::new("rolling_share", List(|s| &s.whirl.rolling_share)),
        Column::new("peak_force_n", List(|s| &s.whirl.peak_force)),
        Column::new("gap_turns", List(|s| &s.whirl.gap_turns)),
        Column::new("bending_cycles", List(|s| &s.whirl.bending_cycles)),
        Column::new("impulse_ns", List(|s| &s.whirl.impulse)),
        Column::new("impact_rate_per_s", List(|s| &s.whirl.impact_rate)),
        Column::new("friction_power_w_per_m", List(|s| &s.whirl.friction_power)),
    ],
};

pub(super) const HAZARDS: Group = Group {
    name: "hazards",
    columns: &[
        Column::new(
            "severity",
            Codes(|s, out| out.extend(s.hazards.list.iter().map(|hazard| hazard.severity as u8))),
        ),
        Column::new(
            "value",
            Few(|s, out| out.extend(s.hazards.list.iter().map(|hazard| hazard.value))),
        ),
        Column::new(
            "threshold",
            Few(|s, out| out.extend(s.hazards.list.iter().map(|hazard| hazard.threshold))),
        ),
        Column::new(
            "measured_depth_m",
            Few(|s, out| {
                let depth = |place: Option<flexdrill_motion::ToolLocation>| {
                    place.map_or(f64::NAN, |place| place.measured_depth)
                };
                out.extend(s.hazards.list.iter().map(|hazard| depth(hazard.place)));
            }),
        ),
        Column::new(
            "confidence",
            Few(|s, out| out.extend(s.hazards.list.iter().map(|hazard| hazard.confidence))),
        ),
        Column::new(
            "since_s",
            Few(|s, out| out.extend(s.hazards.list.iter().map(|hazard| hazard.since))),
        ),
    ],
};

pub(super) const AGEING: Group = Group {
    name: "ageing",
    columns: &[
        Column::new("duration_s", Number(|s| s.ageing.duration)),
        Column::new("stop_damage", List(|s| &s.ageing.stop_damage)),
        Column::new("bending_damage", List(|s| &s.ageing.bending_damage)),
        Column::new("pipe_guide_friction_work_j", List(|s| &s.ageing.friction_work[0])),
        Column::new("guide_wall_friction_work_j", List(|s| &s.ageing.friction_work[1])),
    ],
};

pub(super) const SOLVER: Group = Group {
    name: "solver",
    columns: &[
        Column::new("newton_iterations", Count(|s| s.solver.newton_iterations)),
        Column::new("last_iterations", Count(|s| s.solver.last_iterations.into())),
        Column::new("rejected", Count(|s| s.solver.rejected)),
        Column::new("halved_steps", Count(|s| s.solver.halved_steps)),
        Column::new("deepest_halving", Count(|s| s.solver.deepest_halving.into())),
        Column::new("failed_steps", Count(|s| s.solver.failed_steps)),
    ],
};

/// One column for each row of the ledger.
const LEDGER: [Column; Energies::COUNT] = {
    let first = Energies::TERMS[0];
    let mut columns = [Column::new(first.joules, Energy(first.of)); Energies::COUNT];
    let mut row = 1;
    while row < Energies::COUNT {
        let term = Energies::TERMS[row];
        columns[row] = Column::new(term.joules, Energy(term.of));
        row += 1;
    }
    columns
};

pub(super) const ENERGY: Group = Group {
    name: "energy",
    columns: &LEDGER,
};

pub(super) const QUALITY: Group = Group {
    name: "quality",
    columns: &[
        Column::new("level", Code(|s| s.quality.level as u8)),
        Column::new("judged", Code(judged)),
        Column::new("energy_error_share", Number(|s| s.quality.energy_error_share)),
        Column::new("numerical_share", Number(|s| s.quality.numerical_share)),
        Column::new("refinement", Count(|s| s.quality.choice.in_force.into())),
    ],
};

fn judged(snapshot: &Snapshot) -> u8 {
    snapshot.quality.judged.into()
}
