//! The alarm "outside the known window": where the present speed and weight are on the map that the node has loaded.

use super::catalogue::AlarmId;
use super::finding::Finding;
use super::sentence::{capitalized, number};
use crate::safe_window::{Location, SafeWindow};
use flexdrill_alarms::Priority;
use flexdrill_core::twin::Snapshot;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_motion::DriveState;

/// The finding on a snapshot. A tool at standstill, that runs up, or that is off bottom is not judged, nor are a speed
/// and weight that are the twin's own: `inputs_known` says that those of the run are the rig's.
pub(super) fn finding(window: &SafeWindow, snapshot: &Snapshot, inputs_known: bool) -> Finding {
    // The axis of the map is the magnitude of the speed.
    let rpm = rad_per_s_to_rpm(snapshot.applied.rotary_speed).abs();
    let kn = n_to_kn(snapshot.applied.weight_on_bit);
    // A speed that is assumed or held is no point of the rig, and a
    // judgement on it would accuse the driller of the twin's values.
    let suppressed = snapshot.hazards.drive != DriveState::Turning || !inputs_known;
    let location = window.locate(rpm, kn);
    if suppressed || matches!(location, Location::Inside | Location::OffBottom) {
        return Finding {
            suppressed,
            ..Finding::default()
        };
    }
    let at = format!(
        "{} r/min and {} kN",
        number(rpm, 0).unwrap_or_default(),
        number(kn, 1).unwrap_or_default()
    );
    // Priorities follow what is known: an alarm that the map expects is medium, all uncertainty is low.
    let (priority, evidence, consequence) = match &location {
        Location::Expected(expected) => {
            let known = AlarmId::ALL.into_iter().find(|id| id.id() == expected.alarm);
            let name = known.map_or("an alarm", AlarmId::name);
            let share = expected.chance.and_then(|chance| number(100.0 * chance, 0));
            // The share is that of any alarm; the name is that of the likeliest.
            let found = share.map_or_else(
                || name.to_owned(),
                |share| format!("alarms in {share} % of the runs, most often {name},"),
            );
            if expected.depends {
                let evidence = format!("At {at} the map has {found} from one start, and none from another.");
                (
                    Priority::Low,
                    evidence,
                    format!("{} may come and stay.", capitalized(name)),
                )
            } else {
                let evidence = format!("At {at} the map has {}.", found.trim_end_matches(','));
                (Priority::Medium, evidence, format!("{} is likely.", capitalized(name)))
            }
        }
        Location::Beyond { axis, end, unit } => {
            let evidence = format!(
                "{} beyond the map: it ends at {end} {unit}, the present point is {at}.",
                capitalized(axis)
            );
            let consequence = "What the tool does here has not been computed.";
            (Priority::Low, evidence, consequence.to_owned())
        }
        // The two last returned above; they complete the match.
        Location::NotKnown | Location::Unknown | Location::Inside | Location::OffBottom => {
            let evidence = if location == Location::NotKnown {
                format!("The map has no run at {at}, and the runs around it do not say what happens there.")
            } else {
                format!("Runs of the map failed at {at}.")
            };
            let consequence = "What the tool does here is not known.";
            (Priority::Low, evidence, consequence.to_owned())
        }
    };
    Finding {
        priority: Some(priority),
        evidence,
        cause: "Speed and weight are outside the part of the map in which no alarm must be expected.".to_owned(),
        consequence,
        // A cell of the map, never a point between cells: a boundary may lie between them.
        what_to_do: match window.nearest_inside(rpm, kn) {
            Some([rpm, kn]) => {
                format!("Set {rpm} r/min and {kn} kN: the nearest point that is known to be free of alarms.")
            }
            None => "Call the engineer: the map has no point that is known to be free of alarms.".to_owned(),
        },
        what_the_engineer_can_do:
            "Extend the map to this speed and weight, or refine it there, with flexdrill map. Compare the \
                                   alarms of the run with those that the map expects."
                .to_owned(),
        ..Finding::default()
    }
}
