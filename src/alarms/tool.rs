//! Alarms of the tool's motion, from the hazards that the analysis sees, and of how far it can be trusted.

use super::advice::{self, Operating};
use super::catalogue::AlarmId;
use super::finding::Finding;
use super::sentence::number;
use flexdrill_alarms::{Priority, Time, span};
use flexdrill_config::{Advice, AdviceTable, Config};
use flexdrill_core::motion::{DriveState, Hazard, HazardKind, IncidentLocation, Severity};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{ModelQuality, QualityCause, QualityLevel, Snapshot};
use flexdrill_core::units::rad_to_deg;

/// Difference to the rate of rolling without slip up to which whirl is said to roll, as by default in the analysis.
const ROLLS: f64 = 0.15;

/// What a snapshot at the instant `stamp` says of every alarm of the tool. `stands` is whether an alarm stands already.
pub(super) fn findings(
    snapshot: &Snapshot,
    stamp: Time,
    config: &Config,
    stands: impl Fn(AlarmId) -> bool,
) -> Vec<(AlarmId, Finding)> {
    let hazards = &snapshot.hazards;
    let suppressed = hazards.drive != DriveState::Turning;
    let now = Operating::of(&snapshot.applied);
    let instant = |time: f64| stamp.saturating_sub(span(snapshot.time - time));
    let mut findings: Vec<_> = hazards
        .list
        .iter()
        .map(|hazard| {
            let id = AlarmId::of_hazard(hazard.kind);
            let calls = |priority: &Priority| {
                *priority >= id.lowest()
                    && (*priority > Priority::Low
                        || advice::applies(
                            &rule(hazard.kind, &config.alarms.advice),
                            &now,
                            &config.inputs,
                            stands(id),
                        ))
            };
            let finding = match priority(hazard.severity).filter(calls) {
                Some(priority) if !suppressed => Finding {
                    seen: Some(instant(hazard.seen)),
                    ended: hazard.ended.map(instant),
                    ..describe(hazard, priority)
                },
                _ => Finding::default(),
            };
            (id, Finding { suppressed, ..finding })
        })
        .collect();
    findings.push((AlarmId::ModelQuality, quality(&snapshot.quality)));
    findings
}

/// Whether the motion can be trusted: the same standing and turning.
fn quality(quality: &ModelQuality) -> Finding {
    // The status reports what is degraded: no action of an operator would change it now.
    if quality.level < QualityLevel::Poor {
        return Finding::default();
    }
    let share = number(100.0 * quality.value, 0).map_or(String::new(), |share| match quality.cause {
        Some(QualityCause::NumericalDamping) => {
            format!(": numerical damping takes {share} % of the energy that contacts and damping take")
        }
        _ => format!(": energy errors come to {share} % of what contacts and damping take"),
    });
    Finding {
        priority: Some(Priority::Medium),
        value: quality.value,
        threshold: quality.bound,
        unit: "of what damping takes",
        evidence: format!("The computed motion is not reliable{share}."),
        cause: match quality.cause {
            Some(QualityCause::NumericalDamping) => "The time integration damps the motion.",
            Some(QualityCause::EnergyError) | None => {
                "Collisions are too short for the time step, or axial forces change too much within it."
            }
        }
        .to_owned(),
        consequence: "Vibration and forces may be off by a third and more: whirl and shock may be missed or false."
            .to_owned(),
        what_to_do: "Go by the rig's own instruments until this clears, and call the engineer.".to_owned(),
        what_the_engineer_can_do:
            "Take a smaller solver.time_step for the next run, or solver.step: auto; compare with \
                                   the measured torque."
                .to_owned(),
        ..Finding::default()
    }
}

/// The priority that a level of the analysis has: what to watch is low, what warns medium, what is critical high.
pub(super) fn priority(severity: Severity) -> Option<Priority> {
    match severity {
        Severity::Ok => None,
        Severity::Watch => Some(Priority::Low),
        Severity::Warning => Some(Priority::Medium),
        Severity::Critical => Some(Priority::High),
    }
}

fn describe(hazard: &Hazard, priority: Priority) -> Finding {
    let words = words(hazard);
    Finding {
        priority: Some(priority),
        place: hazard.place,
        value: hazard.value,
        threshold: hazard.threshold,
        unit: words.unit,
        confidence: hazard.confidence,
        evidence: format!("{}.", words.evidence),
        cause: words.cause.to_owned(),
        consequence: format!("{}.", words.consequence),
        what_the_engineer_can_do: words.engineer.to_owned(),
        ..Finding::default()
    }
}

/// The rule for a hazard.
pub(super) fn rule(kind: HazardKind, table: &AdviceTable) -> Advice {
    match kind {
        HazardKind::BackwardWhirl => table.backward_whirl,
        HazardKind::ForwardWhirl => table.forward_whirl,
        HazardKind::Shock => table.shock,
        HazardKind::StickSlip => table.stick_slip,
        HazardKind::JointLoad => table.joint_load,
        HazardKind::ChaoticWhirl => table.chaotic_whirl,
    }
}

struct Words {
    unit: &'static str,
    evidence: String,
    cause: &'static str,
    consequence: String,
    engineer: &'static str,
}

/// Numbers that were not measured are left out.
fn words(hazard: &Hazard) -> Words {
    let at = hazard.place.as_ref().and_then(place).unwrap_or_default();
    let of_guide = hazard.place.is_some_and(|place| place.body == Body::Guide);
    let body = if of_guide { "guide" } else { "pipe" };
    let ratio =
        number(hazard.whirl_ratio.abs(), 1).map_or(String::new(), |ratio| format!(", {ratio} times the rotary speed"));
    let value = |digits| number(hazard.value, digits);
    match hazard.kind {
        HazardKind::BackwardWhirl => {
            let manner = match hazard.rolling_share {
                share if (share - 1.0).abs() <= ROLLS => ", rolling",
                share if share > 0.0 => ", sliding",
                _ => "",
            };
            Words {
                unit: "per turn",
                evidence: format!("Backward whirl of the {body}{at}{manner}{ratio}"),
                cause: if of_guide {
                    "Friction between guide and wall drives it."
                } else {
                    "Friction between pipe and guide drives it."
                },
                consequence: match value(1) {
                    Some(cycles) => format!("Each link bends {cycles} times per turn; joint fatigue"),
                    None => "Each link bends several times per turn; joint fatigue".to_owned(),
                },
                engineer: "Compare the surface torque with the model's: a lower measured torque means less friction than \
                           contact.inner.friction_tangential assumes. Add lubricant to the mud. At the next trip inspect \
                           the joints near this depth for fatigue.",
            }
        }
        HazardKind::ForwardWhirl => Words {
            unit: "W/m",
            evidence: format!("Forward whirl of the {body}{at}{ratio}"),
            cause: "Load presses the bent tool against one side, and the rotation carries it round.",
            consequence: match value(0) {
                Some(power) => format!("One side of the {body} rubs with {power} W/m; it wears flat"),
                None => format!("One side of the {body} rubs all the time; it wears flat"),
            },
            engineer: "Add lubricant to the mud. At the next trip measure the wear of the side that rubs near this depth.",
        },
        HazardKind::Shock => Words {
            unit: "N s",
            evidence: match value(1) {
                Some(impulse) => format!("Lateral shock of the {body}{at}: collisions of up to {impulse} N s"),
                None => format!("Lateral shock of the {body}{at}"),
            },
            cause: if of_guide {
                "The guide is thrown across the hole and strikes the wall."
            } else {
                "The pipe is thrown across its clearance and strikes the guide."
            },
            consequence: "Damage to joints, cutters and instruments".to_owned(),
            engineer: "Compare with a downhole vibration log. Check hole size and clearance; at the next trip inspect \
                       joints and cutters near this depth.",
        },
        HazardKind::StickSlip => Words {
            unit: "of the mean",
            evidence: match value(2) {
                Some(index) => format!("Stick-slip: the bit's speed swings by {index} of its mean; at 1 the bit stops"),
                None => "Stick-slip of the bit".to_owned(),
            },
            cause: "The torque at the bit winds the tool up until the bit breaks loose.",
            consequence: "Impacts on the cutters; torque swings in every joint".to_owned(),
            engineer: "Check tool.bit.friction_factor against the measured torque. Tune the drive's speed controller \
                       (soft torque); a less aggressive bit needs less torque.",
        },
        HazardKind::JointLoad => Words {
            unit: "of its rating",
            evidence: match value(2) {
                Some(ratio) => format!("Joint overload{at}: the stop carries {ratio} times its rated moment"),
                None => format!("Joint overload{at}"),
            },
            cause: "The tool is bent further than its joints turn, and their stops carry the rest.",
            consequence: "A cracked joint or a broken pin".to_owned(),
            engineer: "Check joint_load.rated_moment_nm against the maker's rating. At the next trip inspect the joint near \
                       this depth.",
        },
        HazardKind::ChaoticWhirl => Words {
            unit: "W/m",
            evidence: match value(1) {
                Some(power) => {
                    format!(
                        "Chaotic whirl of the pipe, hardest{at}: its collisions take {power} W per metre of the tool"
                    )
                }
                None => format!("Chaotic whirl of the pipe, hardest{at}"),
            },
            cause: "Friction between pipe and guide throws the pipe about without direction.",
            consequence: "Blows all along the tool; joint fatigue, loosened connections, damaged instruments"
                .to_owned(),
            engineer: "Add lubricant to the mud. Compare with a downhole vibration log. At the next trip inspect joints and \
                       connections along the whole tool.",
        },
    }
}

/// ` at 2.31 m (42 deg)`.
fn place(place: &IncidentLocation) -> Option<String> {
    let depth = number(place.measured_depth, 2)?;
    let inclination = number(rad_to_deg(place.inclination), 0);
    let inclination = inclination.map_or(String::new(), |degrees| format!(" ({degrees} deg)"));
    Some(format!(" at {depth} m{inclination}"))
}
