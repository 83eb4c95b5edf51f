//! The alarm "twin and rig disagree": what the rig measures is beyond the band that the twin expects.

use super::finding::Finding;
use super::sentence::number;
use flexdrill_alarms::{Priority, Time};
use flexdrill_calibration::monitor::{Compared, LEVELS};
use flexdrill_calibration::residual::{Cause, Quantity};
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// Time without steady motion for which a standing alarm remains (ns): a connection lasts some minutes.
pub(super) const OUTLASTS: Time = 600_000_000_000;
/// Causes in a sentence.
const NAMED: usize = 3;

/// A quantity as the driller reads it: name, unit, factor from SI, digits.
fn display(quantity: Quantity) -> (&'static str, &'static str, f64, usize) {
    match quantity {
        Quantity::SurfaceTorque => ("Surface torque", "N m", 1.0, 0),
        Quantity::HookLoad => ("Hook load", "kN", n_to_kn(1.0), 1),
        Quantity::DownholeSpeed => ("Rotary speed in the hole", "r/min", rad_per_s_to_rpm(1.0), 1),
        Quantity::DownholeTorque => ("Torque in the hole", "N m", 1.0, 0),
        Quantity::DownholeWeight => ("Weight on bit in the hole", "kN", n_to_kn(1.0), 1),
    }
}

/// A cause in the words of alarm and message.
pub const fn in_words(cause: Cause) -> &'static str {
    match cause {
        Cause::FrictionHigher => "friction has risen, such as by cuttings or a tight hole",
        Cause::FrictionLower => "friction is lower than the twin assumes",
        Cause::BitTakesLess => "the bit is dull or balled",
        Cause::BitTakesMore => "the rock takes more torque than the twin assumes",
        Cause::WeightLost => "part of the weight does not arrive at the bit",
        Cause::WeightSensor => "the weight or the hook load is measured wrongly",
        Cause::TorqueSensor => "the offset of the torque sensor has changed",
        Cause::SpeedSensor => "a rotary speed is measured wrongly",
        Cause::DownholeSensor => "a sensor in the hole has an offset",
    }
}

const fn what_to_do(cause: Option<Cause>) -> &'static str {
    match cause {
        Some(Cause::FrictionHigher | Cause::FrictionLower) => {
            "Pick up off bottom, rotate and circulate, and compare the torque with that of the last connection. If it \
             differs, call the engineer."
        }
        Some(Cause::WeightLost) => {
            "Do not add weight. Pick up off bottom, rotate and circulate, and set down slowly. If the difference returns, \
             call the engineer."
        }
        Some(Cause::BitTakesLess | Cause::BitTakesMore) => {
            "Pick up off bottom, rotate, and set down again with the same weight. If torque and rate of penetration stay as \
             they are now, call the engineer."
        }
        _ => {
            "Rely on the rig's own instruments. Pick up off bottom, rotate, and compare torque and hook load with those of \
             the last connection. Call the engineer."
        }
    }
}

/// The finding on a comparison; `None` while nothing can be judged. `bit_depth` (m) is NaN where the rig does not give it.
pub(super) fn finding(compared: &Compared, bit_depth: f64) -> Option<Finding> {
    let (quantity, worst) = compared.worst()?;
    let beyond = |level: f64| worst.difference().abs() >= worst.limit(level);
    let priority = match LEVELS.map(beyond) {
        [_, true] => Priority::Medium,
        [true, false] => Priority::Low,
        [false, false] => return Some(Finding::default()),
    };
    let (name, unit, factor, digits) = display(quantity);
    let write = |value: f64| number(factor * value, digits).unwrap_or_else(|| "a value out of range".to_owned());
    let state = if compared.drilling {
        "drilling"
    } else {
        "rotating off bottom"
    };
    let depth = number(bit_depth, 0).map_or(String::new(), |depth| format!(" at a bit depth of {depth} m"));
    let causes: Vec<&str> = compared
        .causes
        .iter()
        .take(NAMED)
        .map(|cause| in_words(*cause))
        .collect();
    Some(Finding {
        priority: Some(priority),
        value: factor * worst.difference(),
        threshold: factor * worst.limit(LEVELS[0]).copysign(worst.difference()),
        unit,
        evidence: format!(
            "{name} while {state}{depth}: {} {unit} measured, {} to {} {unit} expected.",
            write(worst.measured),
            write(worst.predicted - worst.band()),
            write(worst.predicted + worst.band()),
        ),
        cause: format!("Likely {}.", causes.join(", or ")),
        consequence: "The model does not describe the tool at present; its other alarms may be wrong or missing.".to_owned(),
        what_to_do: what_to_do(compared.causes.first().copied()).to_owned(),
        what_the_engineer_can_do: "Compare the residuals of all quantities on and off bottom. Check the sensors of torque, \
                                   hook load and weight. If they are right, fit friction and bit to a log of today with \
                                   flexdrill calibrate."
            .to_owned(),
        ..Finding::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_calibration::residual::{Residual, causes};

    fn compared(quantity: Quantity, measured: f64, drilling: bool) -> Compared {
        let mut residuals = [None; Quantity::COUNT];
        residuals[quantity as usize] = Some(Residual {
            measured,
            predicted: 300.0,
            error: 20.0 / flexdrill_calibration::BAND,
            scatter: 0.0,
        });
        Compared {
            causes: causes(
                &residuals.map(|residual| residual.map(|of: Residual| of.ratio())),
                drilling,
            ),
            residuals,
            steady: true,
            drilling,
        }
    }

    #[test]
    fn a_disagreement_has_evidence_cause_and_action() {
        let torque =
            |measured, drilling| finding(&compared(Quantity::SurfaceTorque, measured, drilling), 1234.4).unwrap();
        assert_eq!(torque(329.0, true).priority, None);
        let low = torque(331.0, true);
        assert_eq!(low.priority, Some(Priority::Low));
        assert_eq!(
            low.evidence,
            "Surface torque while drilling at a bit depth of 1234 m: 331 N m measured, 280 to 320 N m expected."
        );
        assert_eq!(low.value, 31.0);
        assert!((low.threshold - 30.0).abs() < 1e-9, "{}", low.threshold);
        assert!(low.cause.starts_with("Likely friction has risen"), "{}", low.cause);
        assert!(low.what_to_do.contains("circulate"), "{}", low.what_to_do);
        let medium = torque(239.0, true);
        assert_eq!(medium.priority, Some(Priority::Medium));
        assert!((medium.threshold + 30.0).abs() < 1e-9, "{}", medium.threshold);
        assert!(medium.cause.contains("the bit is dull or balled"), "{}", medium.cause);
        let weight = compared(Quantity::DownholeWeight, 100.0, true);
        let lost = finding(&weight, f64::NAN).unwrap();
        assert!(
            lost.evidence
                .starts_with("Weight on bit in the hole while drilling: 0.1 kN"),
            "{}",
            lost.evidence
        );
        assert!(lost.what_to_do.starts_with("Do not add weight"), "{}", lost.what_to_do);
    }

    #[test]
    fn what_cannot_be_judged_is_no_finding() {
        let mut none = compared(Quantity::HookLoad, 900.0, true);
        assert!(finding(&none, f64::NAN).unwrap().priority.is_some());
        none.residuals = [None; Quantity::COUNT];
        assert_eq!(finding(&none, f64::NAN), None);
    }
}
