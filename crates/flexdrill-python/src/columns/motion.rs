//! What the motion means: whirl, hazards, ageing; and the quality of the computation.

use super::Read::{Code, Codes, Count, Energy, Few, Indices, List, Number};
use super::{Column, Group, body_code};
use flexdrill_core::dynamics::Energies;
use flexdrill_core::twin::Snapshot;

pub(super) const WHIRL: Group = Group::new(
    "whirl",
    &[
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
);

pub(super) const HAZARDS: Group = Group::new(
    "hazards",
    &[
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
);

pub(super) const AGEING: Group = Group::new(
    "ageing",
    &[
        Column::new("duration_s", Number(|s| s.ageing.duration)),
        Column::new("stop_damage", List(|s| &s.ageing.stop_damage)),
        Column::new("bending_damage", List(|s| &s.ageing.bending_damage)),
        Column::new("pipe_guide_friction_work_j", List(|s| &s.ageing.friction_work[0])),
        Column::new("guide_wall_friction_work_j", List(|s| &s.ageing.friction_work[1])),
    ],
);

pub(super) const SOLVER: Group = Group::new(
    "solver",
    &[
        Column::new("newton_iterations", Count(|s| s.solver.newton_iterations)),
        Column::new("last_iterations", Count(|s| s.solver.last_iterations.into())),
        Column::new("rejected", Count(|s| s.solver.rejected)),
        Column::new("halved_steps", Count(|s| s.solver.halved_steps)),
        Column::new("deepest_halving", Count(|s| s.solver.deepest_halving.into())),
        Column::new("failed_steps", Count(|s| s.solver.failed_steps)),
    ],
);

/// One column for each row of the ledger.
pub(super) fn ledger() -> impl Iterator<Item = Column> {
    Energies::TERMS
        .iter()
        .map(|term| Column::new(term.joules, Energy(term.of)))
}

pub(super) const QUALITY: Group = Group::new(
    "quality",
    &[
        Column::new("level", Code(|s| s.quality.level as u8)),
        Column::new("judged", Code(judged)),
        Column::new("energy_error_share", Number(|s| s.quality.energy_error_share)),
        Column::new("numerical_share", Number(|s| s.quality.numerical_share)),
        Column::new("refinement", Count(|s| s.quality.choice.in_force.into())),
    ],
);

fn judged(snapshot: &Snapshot) -> u8 {
    snapshot.quality.judged.into()
}
