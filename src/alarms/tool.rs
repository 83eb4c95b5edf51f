//! Alarms of the tool's motion, from the hazards that the analysis sees, and of how far it can be trusted.

use super::advice;
use super::catalogue::AlarmId;
use super::finding::Finding;
use flexdrill_alarms::Priority;
use flexdrill_config::{Advice, AdviceTable, Config};
use flexdrill_core::motion::{DriveState, Hazard, HazardKind, IncidentLocation, Severity};
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{ModelQuality, QualityCause, QualityLevel, Snapshot};
use flexdrill_core::units::rad_to_deg;

/// Difference to the rate of rolling without slip up to which it is said to roll, as by default in the analysis.
const ROLLS: f64 = 0.15;

/// What a snapshot says of every alarm of the tool.
pub(super) fn findings(snapshot: &Snapshot, config: &Config) -> impl Iterator<Item = (AlarmId, Finding)> {
    let hazards = snapshot.hazards;
    let quality = (AlarmId::ModelQuality, quality(&snapshot.quality));
    let suppressed = hazards.drive != DriveState::Turning;
    let of_hazards = hazards.list.into_iter().map(move |hazard| {
        let finding = match priority(hazard.severity) {
            Some(priority) if !suppressed => describe(&hazard, priority, snapshot, config),
            _ => Finding::default(),
        };
        (AlarmId::of_hazard(hazard.kind), Finding { suppressed, ..finding })
    });
    of_hazards.chain([quality])
}

/// Whether the motion is the tool's: the same standing and turning.
fn quality(quality: &ModelQuality) -> Finding {
    // What is degraded is said in the status: nobody could do anything about it now.
    if quality.level < QualityLevel::Poor {
        return Finding::default();
    }
    Finding {
        priority: Some(Priority::Medium),
        value: quality.value,
        threshold: quality.bound,
        unit: "of what damping takes",
        evidence: sentence(&quality.to_string()),
        cause: match quality.cause {
            Some(QualityCause::NumericalDamping) => "The scheme itself damps the motion.",
            Some(QualityCause::EnergyError) | None => {
                "Collisions are too short for the step, or axial forces change too much within it."
            }
        }
        .to_owned(),
        consequence: "Ripple and forces may be off by a third and more: hazards may be missed or made up.".to_owned(),
        what_to_do: "Go by the rig's own instruments; take a smaller solver.time_step for the next run.".to_owned(),
        ..Finding::default()
    }
}

/// With a capital and a full stop.
fn sentence(text: &str) -> String {
    let (first, rest) = text.split_at(text.chars().next().map_or(0, char::len_utf8));
    format!("{}{rest}.", first.to_uppercase())
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

fn describe(hazard: &Hazard, priority: Priority, snapshot: &Snapshot, config: &Config) -> Finding {
    let words = words(hazard);
    let advice = advice_for(hazard.kind, &config.alarms.advice);
    Finding {
        priority: Some(priority),
        suppressed: false,
        place: hazard.place,
        value: hazard.value,
        threshold: hazard.threshold,
        unit: words.unit,
        confidence: hazard.confidence,
        evidence: words.evidence,
        cause: words.cause.to_owned(),
        consequence: words.consequence,
        what_to_do: advice::what_to_do(&advice, &snapshot.applied, &config.inputs, priority),
    }
}

fn advice_for(kind: HazardKind, table: &AdviceTable) -> Advice {
    match kind {
        HazardKind::BackwardWhirl => table.backward_whirl,
        HazardKind::ForwardWhirl => table.forward_whirl,
        HazardKind::Shock => table.shock,
        HazardKind::StickSlip => table.stick_slip,
        HazardKind::JointLoad => table.joint_load,
    }
}

struct Words {
    unit: &'static str,
    evidence: String,
    cause: &'static str,
    consequence: String,
}

fn words(hazard: &Hazard) -> Words {
    let at = hazard.place.as_ref().map(place).unwrap_or_default();
    let of_guide = hazard.place.is_some_and(|place| place.body == Body::Guide);
    let (body, housing) = if of_guide {
        ("guide pipe", "hole")
    } else {
        ("flexible pipe", "guide")
    };
    let value = hazard.value;
    match hazard.kind {
        HazardKind::BackwardWhirl => {
            let manner = match hazard.rolling_share {
                share if (share - 1.0).abs() <= ROLLS => "rolls",
                share if share > 0.0 => "slides",
                _ => "goes",
            };
            Words {
                unit: "per turn",
                evidence: format!(
                    "The {body} {manner} round the {housing} against the rotation at {:.1} times its speed{at}.",
                    hazard.whirl_ratio.abs()
                ),
                cause: if of_guide {
                    "Friction between guide and wall drives it."
                } else {
                    "Friction between pipe and guide drives it."
                },
                consequence: format!("Each link is bent {value:.1} times per turn of the tool: fatigue of the joints."),
            }
        }
        HazardKind::ForwardWhirl => Words {
            unit: "W/m",
            evidence: format!(
                "The {body} goes round the {housing} with the rotation at {:.1} times its speed{at}.",
                hazard.whirl_ratio
            ),
            cause: "Load presses the bent tool against one side, and the rotation carries it round.",
            consequence: format!("The same side rubs all the time, with {value:.0} W/m: it wears flat."),
        },
        HazardKind::Shock => Words {
            unit: "N s",
            evidence: format!("Collisions of the {body} with {value:.1} N s{at}."),
            cause: if of_guide {
                "The guide is thrown across the hole and strikes the wall."
            } else {
                "The pipe is thrown across its clearance and strikes the guide."
            },
            consequence: "Damage to joints, cutters and instruments.".to_owned(),
        },
        HazardKind::StickSlip => Words {
            unit: "of the mean",
            evidence: format!("The bit's speed swings by {value:.2} of its mean; at 1 the bit just stops."),
            cause: "The torque at the bit winds the tool up until it breaks loose.",
            consequence: "Impacts on the cutters, torque swings in every joint.".to_owned(),
        },
        HazardKind::JointLoad => Words {
            unit: "of its rating",
            evidence: format!("The stop of a joint carries {value:.2} of its rated moment{at}."),
            cause: "The tool is bent further than its joints give way, and their stops carry the rest.",
            consequence: "Overload of the joint: a crack or a broken pin.".to_owned(),
        },
    }
}

/// ` at 2.31 m (inclination 42 deg)`.
fn place(place: &IncidentLocation) -> String {
    format!(
        " at {:.2} m (inclination {:.0} deg)",
        place.measured_depth,
        rad_to_deg(place.inclination)
    )
}
