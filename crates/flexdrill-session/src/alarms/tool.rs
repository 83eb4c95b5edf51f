//! Alarms of the tool's motion: conditions from the hazards of the analysis and from the quality of the model.

use super::advice::{self, Operating, Unknown};
use super::catalogue::AlarmId;
use super::finding::Finding;
use super::sentence::number;
use flexdrill_alarms::{Priority, Time, span};
use flexdrill_config::{Advice, AdviceTable, Config, Law};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{ModelQuality, QualityCause, QualityLevel, Snapshot};
use flexdrill_core::units::rad_to_deg;
use flexdrill_motion::{DriveState, Hazard, HazardKind, Hold, Severity, ToolLocation};
use flexdrill_text::percent;

/// Largest difference of the whirl rate from that of rolling without slip, over the latter, for whirl that is called
/// rolling: the default of the analysis.
const ROLLING_TOLERANCE: f64 = 0.15;

/// Speed of the bit against the drive, over the drive's speed, from which it spins back. A bit that sticks rocks by a few
/// percent about zero: the ripple of the joints. Assumption.
const SPINS_BACK: f64 = 0.1;

/// The findings of a snapshot at the instant `stamp`, one per alarm of the tool. `stands` says whether an alarm stands
/// already.
pub(super) fn findings(
    snapshot: &Snapshot,
    stamp: Time,
    config: &Config,
    stands: impl Fn(AlarmId) -> bool,
) -> Vec<(AlarmId, Finding)> {
    let hazards = &snapshot.hazards;
    let suppressed = hazards.drive != DriveState::Turning;
    let now = Operating::of(&snapshot.applied, Unknown::default());
    let instant = |time: f64| stamp.saturating_sub(span(snapshot.time - time));
    let mut findings: Vec<_> = hazards
        .list
        .iter()
        .map(|hazard| {
            let id = AlarmId::of_hazard(hazard.kind);
            let finding = match called(hazard.kind, hazard.severity, &now, config, stands(id)) {
                Some(priority) if !suppressed => {
                    // A lower level that is a displayed state here is the end of the condition.
                    let (ended, less) = match hazard.hold {
                        Hold::Met => (None, None),
                        Hold::Less { severity, since } => {
                            let less = called(hazard.kind, severity, &now, config, stands(id));
                            (Some(since), less)
                        }
                        Hold::Ended { at } => (Some(at), None),
                    };
                    Finding {
                        seen: Some(instant(hazard.seen)),
                        ended: ended.map(instant),
                        less,
                        ..describe(hazard, priority, config.rock.law)
                    }
                }
                _ => Finding::default(),
            };
            (id, Finding { suppressed, ..finding })
        })
        .collect();
    findings.push((AlarmId::ModelQuality, quality(&snapshot.quality)));
    findings
}

/// The finding on the quality of the model. It does not depend on the drive: the errors are the same at standstill.
fn quality(quality: &ModelQuality) -> Finding {
    // A degraded model is a displayed state of the status: no action of an operator would change it now.
    if quality.level < QualityLevel::Poor {
        return Finding::default();
    }
    let share = percent(quality.value);
    let share = match quality.cause {
        _ if !quality.value.is_finite() => String::new(),
        Some(QualityCause::NumericalDamping) => {
            format!(": numerical damping takes {share} of the energy that contacts and damping dissipate")
        }
        _ => format!(": numerical energy errors reach {share} of the energy that contacts and damping dissipate"),
    };
    Finding {
        priority: Some(Priority::Medium),
        value: quality.value,
        threshold: quality.bound,
        unit: "of the dissipated energy",
        evidence: format!("The computed motion is unreliable{share}."),
        cause: match quality.cause {
            Some(QualityCause::NumericalDamping) => "The time integration damps the motion.",
            Some(QualityCause::EnergyError) | None => {
                "Collisions are too short for the time step, or axial forces change too much within one step."
            }
        }
        .to_owned(),
        consequence: "Vibration levels and forces may be wrong by a third or more; alarms of whirl and shock may be missing or false."
            .to_owned(),
        what_to_do: "Rely on the rig's own instruments until this alarm clears, and call the engineer.".to_owned(),
        what_the_engineer_can_do:
            "Set solver.step: auto or a smaller solver.time_step for the next run. Compare the computed torque with the \
             measured torque."
                .to_owned(),
        ..Finding::default()
    }
}

/// The priority of a level of the analysis: watch is low, warning medium, critical high.
pub(super) fn priority(severity: Severity) -> Option<Priority> {
    match severity {
        Severity::Ok => None,
        Severity::Watch => Some(Priority::Low),
        Severity::Warning => Some(Priority::Medium),
        Severity::Critical => Some(Priority::High),
    }
}

/// The priority with which a level calls at an operating point; none where it is a displayed state there. `stands` says
/// whether its alarm stands already.
fn called(kind: HazardKind, severity: Severity, now: &Operating, config: &Config, stands: bool) -> Option<Priority> {
    let of_rule = || advice::applies(&rule(kind, &config.alarms.advice), now, &config.inputs, stands);
    priority(severity)
        .filter(|priority| *priority >= AlarmId::of_hazard(kind).lowest() && (*priority > Priority::Low || of_rule()))
}

/// The priority with which a level would raise its alarm at a speed (r/min) and weight (kN); none where it is a
/// displayed state there.
pub fn called_at(kind: HazardKind, severity: Severity, [rpm, kn]: [f64; 2], config: &Config) -> Option<Priority> {
    let now = Operating {
        rpm,
        kn,
        ..Operating::default()
    };
    called(kind, severity, &now, config, false)
}

fn describe(hazard: &Hazard, priority: Priority, law: Law) -> Finding {
    let words = words(hazard, law);
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

pub(super) fn rule(kind: HazardKind, table: &AdviceTable) -> Advice {
    match kind {
        HazardKind::BackwardWhirl => table.backward_whirl,
        HazardKind::ForwardWhirl => table.forward_whirl,
        HazardKind::Shock => table.shock,
        HazardKind::StickSlip => table.stick_slip,
        HazardKind::JointLoad => table.joint_load,
        HazardKind::ChaoticWhirl => table.chaotic_whirl,
        HazardKind::WeightTransfer => table.weight_transfer,
        HazardKind::TorqueTransfer => table.torque_transfer,
        HazardKind::GuidePreload => table.guide_preload,
        HazardKind::PressureFolding => table.pressure_folding,
        HazardKind::BitStuck => table.bit_stuck,
    }
}

struct Words {
    unit: &'static str,
    evidence: String,
    cause: &'static str,
    consequence: String,
    engineer: &'static str,
}

/// The texts on a hazard of a tool whose rock has this law. Numbers that were not measured are left out.
fn words(hazard: &Hazard, law: Law) -> Words {
    // Every text is complete without its numbers, because a hazard may come without place, ratio or value (NaN), and an
    // alarm must never show one.
    let at = hazard.place.as_ref().and_then(place).unwrap_or_default();
    let of_guide = hazard.place.is_some_and(|place| place.body == Body::Guide);
    let body = if of_guide { "guide" } else { "pipe" };
    let ratio = number(hazard.whirl_ratio.abs(), 1).map_or(String::new(), |ratio| {
        format!(", whirl rate {ratio} times the rotary speed")
    });
    let value = |digits| number(hazard.value, digits);
    match hazard.kind {
        // A share near 1 is rolling without slip. NaN, where the body is
        // not the driven pipe, matches no arm but the last.
        HazardKind::BackwardWhirl => {
            let manner = match hazard.rolling_share {
                share if (share - 1.0).abs() <= ROLLING_TOLERANCE => ", rolling",
                share if share > 0.0 => ", sliding",
                _ => "",
            };
            Words {
                unit: "per turn",
                evidence: format!("Backward whirl of the {body}{at}{manner}{ratio}"),
                cause: if of_guide {
                    "Friction between guide and wall drives the whirl."
                } else {
                    "Friction between pipe and guide drives the whirl."
                },
                consequence: match value(1) {
                    Some(cycles) => format!("Each link bends {cycles} times per turn; joint fatigue"),
                    None => "Each link bends several times per turn; joint fatigue".to_owned(),
                },
                engineer: "Compare the measured surface torque with the computed one: a lower measured torque means less \
                           friction than contact.inner.friction_tangential assumes. Add lubricant to the mud. On the next \
                           trip, inspect the joints near this depth for fatigue cracks.",
            }
        }
        // Forward whirl is judged by rubbing power, because it wears one
        // side and does not bend the links against the rotation.
        HazardKind::ForwardWhirl => Words {
            unit: "W/m",
            evidence: format!("Forward whirl of the {body}{at}{ratio}"),
            cause: "The load presses the bent tool against one side of the bore, and the rotation carries it around.",
            consequence: match value(0) {
                Some(power) => format!("One side of the {body} rubs with {power} W/m and wears flat"),
                None => format!("One side of the {body} rubs continuously and wears flat"),
            },
            engineer: "Add lubricant to the mud. On the next trip, measure the one-sided wear near this depth.",
        },
        HazardKind::Shock => Words {
            unit: "N s",
            evidence: match value(1) {
                Some(impulse) => format!("Lateral shock of the {body}{at}: impacts of up to {impulse} N s"),
                None => format!("Lateral shock of the {body}{at}"),
            },
            cause: if of_guide {
                "The guide is thrown across the hole and strikes the wall."
            } else {
                "The pipe is thrown across its clearance and strikes the guide."
            },
            consequence: "Impacts damage joints, cutters and downhole instruments".to_owned(),
            engineer: "Compare with a downhole vibration log. Check the hole size and the clearance. On the next trip, \
                       inspect joints and cutters near this depth.",
        },
        HazardKind::StickSlip => Words {
            unit: "of the mean",
            evidence: match number(100.0 * hazard.value, 0) {
                // From 1 on the mean is near zero in the swing, and a share of it says nothing to a driller.
                Some(_) if hazard.value >= 1.0 && hazard.least_speed < -SPINS_BACK => {
                    "Stick-slip: the bit stops and spins back before it breaks free".to_owned()
                }
                Some(_) if hazard.value >= 1.0 => "Stick-slip: the bit stops and then breaks free".to_owned(),
                Some(swing) => format!(
                    "Stick-slip: the bit speed swings {swing} % above and below its mean; at 100 % the bit stops"
                ),
                None => "Stick-slip of the bit".to_owned(),
            },
            cause: "The bit torque winds up the tool until the bit breaks free and spins.",
            consequence: "Impacts damage the cutters, and every joint carries a cyclic torque".to_owned(),
            // The remedy names a parameter that the rock's law reads: the other law ignores it.
            engineer: match law {
                Law::Paper | Law::Weakening => {
                    "Compare the measured torque with that of tool.bit.friction_factor. Tune the soft-torque control of the \
                     top drive. A less aggressive bit needs less torque."
                }
                Law::DepthOfCut => {
                    "Compare the measured torque with that of rock.depth_of_cut.specific_energy and wear_flat_friction. Tune \
                     the soft-torque control of the top drive. A less aggressive bit needs less torque."
                }
            },
        },
        HazardKind::JointLoad => Words {
            unit: "of its rating",
            evidence: match value(2) {
                Some(ratio) => format!("Joint overload{at}: the stop carries {ratio} times its rated moment"),
                None => format!("Joint overload{at}"),
            },
            cause: "The tool bends beyond the angle limit of its joints, and their stops carry the remaining moment.",
            consequence: "The joint may crack, or its pin may break".to_owned(),
            engineer: "Check joint_load.rated_moment_nm against the manufacturer's rating. On the next trip, inspect the \
                       joint near this depth.",
        },
        // The analysis sums the impacts over the tool, so there is no ratio
        // or manner to name, only where they are strongest.
        HazardKind::ChaoticWhirl => Words {
            unit: "W/m",
            evidence: match value(1) {
                Some(power) => {
                    format!(
                        "Chaotic whirl of the pipe, strongest{at}: impacts dissipate {power} W per metre of the tool"
                    )
                }
                None => format!("Chaotic whirl of the pipe, strongest{at}"),
            },
            cause: "Friction between pipe and guide drives the pipe from impact to impact.",
            consequence: "Impacts along the whole tool fatigue the joints, loosen connections and damage instruments"
                .to_owned(),
            engineer: "Add lubricant to the mud. Compare with a downhole vibration log. On the next trip, inspect joints \
                       and connections along the whole tool.",
        },
        // Transfer hazards count what is lost as a share of what is put in
        // at the surface, so that 0 is good and 1 is all lost.
        HazardKind::WeightTransfer => Words {
            unit: "of the weight",
            evidence: match number(100.0 * hazard.value, 0) {
                Some(lost) => {
                    format!("Weight does not arrive: {lost} % of the weight at the surface is not on the bottom")
                }
                None => "Weight does not arrive: much of the weight at the surface is not on the bottom".to_owned(),
            },
            cause: "Friction on the wall holds the string or the guide back, or the bit whips on the bottom.",
            consequence:
                "The bit hardly cuts. More weight at the surface may buckle the string, or reach the bit at once \
                          when the friction gives way"
                    .to_owned(),
            engineer: "Compare the drag of string and guide with the hook load while picking up and slacking off. Clean the \
                       hole, or add lubricant to the mud. A guide that was not made with the curvature of the hole drags more.",
        },
        HazardKind::TorqueTransfer => Words {
            unit: "of the torque",
            evidence: match number(100.0 * hazard.value, 0) {
                Some(lost) => format!("Torque does not arrive: friction takes {lost} % of the torque of the top drive"),
                None => "Torque does not arrive: friction takes most of the torque of the top drive".to_owned(),
            },
            cause: "Friction on the wall, between pipe and guide or in the joints brakes the rotation.",
            consequence: "String and joints carry torque that does not cut rock; the tool may stick".to_owned(),
            engineer: "Compare the torque off bottom with that while drilling: what remains off bottom is friction. Clean the \
                       hole, or add lubricant to the mud. Check the joints for wear on the next trip.",
        },
        HazardKind::GuidePreload => Words {
            unit: "of its rating",
            evidence: match value(2) {
                Some(ratio) => format!("Guide overbent{at}: its bending moment is {ratio} times the rated moment"),
                None => format!("Guide overbent{at}"),
            },
            cause: "The hole bends the guide beyond the curvature that it was made with.",
            consequence: "The guide may take a permanent bend or crack at a slot, and presses on the wall at its ends"
                .to_owned(),
            engineer: "Check guide_preload.rated_moment_nm against the manufacturer's rating, and the radius of the hole. Use \
                       a guide with more slots, or one that was made with a bend.",
        },
        HazardKind::PressureFolding => Words {
            unit: "of its rating",
            evidence: match value(2) {
                Some(ratio) => format!(
                    "Folding under pressure, strongest{at}: the effective compression of the pipe is {ratio} times its rating"
                ),
                None => format!("Folding under pressure, strongest{at}"),
            },
            cause: "The pressure on the seal at the lower end pushes the chain of links together.",
            consequence: "The links fold against the guide: their stops carry the load, and friction takes torque"
                .to_owned(),
            engineer: "Check pressure_folding.rated_compression_kn against the manufacturer's rating. Use a larger nozzle, or \
                       a lower end that the pressure does not push up.",
        },
        // The value is a time: a stall is a stall at once, and gets worse by the wind-up that lasts.
        HazardKind::BitStuck => Words {
            unit: "s",
            evidence: match value(0) {
                Some(time) => format!(
                    "The bit is stuck and the drive stalls: for {time} s the top drive has been at its torque limit and the \
                     bit has not turned"
                ),
                None => "The bit is stuck and the drive stalls at its torque limit".to_owned(),
            },
            cause: "The bit needs more torque than the limit of the top drive: too much weight is on it, or the tool is held \
                    in the hole.",
            consequence:
                "The string is wound up. If it is released suddenly, it spins back and may unscrew; if the bit breaks \
                          free, it spins faster than the drive and damages cutters and joints"
                    .to_owned(),
            engineer: "Check string.top_drive.torque_limit against the make-up torque of the connections, and the limit that \
                       the rig has set. Compare the torque of the bit with the rock's. A less aggressive bit needs less torque.",
        },
    }
}

/// ` at 2.31 m (42 deg)`.
fn place(place: &ToolLocation) -> Option<String> {
    let depth = number(place.measured_depth, 2)?;
    let inclination = number(rad_to_deg(place.inclination), 0);
    let inclination = inclination.map_or(String::new(), |degrees| format!(" ({degrees} deg)"));
    Some(format!(" at {depth} m{inclination}"))
}
