//! The alarm "twin and rig disagree": what the rig measures is beyond the band that the twin expects.

use super::finding::Finding;
use super::sentence::number;
use flexdrill_alarms::{Priority, Time};
use flexdrill_calibration::monitor::{Compared, LEVELS};
use flexdrill_calibration::plausible::{self, Tools};
use flexdrill_calibration::residual::{Cause, RigQuantity};
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// Time without steady motion for which a standing alarm remains (ns): a connection lasts some minutes.
pub(super) const OUTLASTS: Time = 600_000_000_000;
/// Causes in a sentence.
const NAMED: usize = 4;

/// A quantity as the driller reads it: name, unit, factor from SI, digits.
fn display(quantity: RigQuantity) -> (&'static str, &'static str, f64, usize) {
    match quantity {
        RigQuantity::SurfaceTorque => ("Surface torque", "N m", 1.0, 0),
        RigQuantity::HookLoad => ("Hook load", "kN", n_to_kn(1.0), 1),
        RigQuantity::DownholeSpeed => ("Rotary speed in the hole", "r/min", rad_per_s_to_rpm(1.0), 1),
        RigQuantity::DownholeTorque => ("Torque in the hole", "N m", 1.0, 0),
        RigQuantity::DownholeWeight => ("Weight on bit in the hole", "kN", n_to_kn(1.0), 1),
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
        Cause::TorqueSensor => "the torque is measured wrongly",
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

/// Factor of the friction, either way, beyond which a twin that follows the rig no longer is the tool of its configuration:
/// the range in which friction wanders in an hour of drilling lies within it.
const FAR: f64 = 1.25;

/// The friction that the twin has followed the rig to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Followed {
    /// Factor in force and configured factor.
    pub factors: [f64; 2],
    /// Whether a limit stops the following.
    pub at_limit: bool,
    /// Whether it follows plausible tools, which know how far friction can be.
    pub by_tools: bool,
}

impl Default for Followed {
    /// A twin that follows nothing.
    fn default() -> Self {
        Self {
            factors: [1.0; 2],
            at_limit: false,
            by_tools: false,
        }
    }
}

impl Followed {
    fn ratio(&self) -> f64 {
        self.factors[0] / self.factors[1]
    }

    /// Whether the comparison with the rig says little, because the twin was moved far to agree with it.
    pub(super) fn is_far(&self) -> bool {
        self.at_limit || !self.by_tools && !(1.0 / FAR..=FAR).contains(&self.ratio())
    }

    /// The finding on it, where it is far.
    pub(super) fn finding(&self) -> Option<Finding> {
        if !self.is_far() {
            return None;
        }
        let [applied, configured] = self.factors.map(|factor| number(factor, 2).unwrap_or_default());
        let limit = if self.at_limit { ", where a limit stops it" } else { "" };
        Some(Finding {
            priority: Some(Priority::Low),
            value: self.ratio(),
            threshold: if self.ratio() < 1.0 { 1.0 / FAR } else { FAR },
            unit: "",
            evidence: format!(
                "The twin agrees with the rig only with a friction factor of {applied}{limit}; {configured} is configured."
            ),
            cause: "Likely friction has changed, the torque sensor drifts, or the bit takes another torque.".to_owned(),
            consequence:
                "The weight at the bit is computed with that factor. Whirl and stick-slip are judged with the larger of \
                          both, so that none that goes on loses its alarm."
                    .to_owned(),
            what_to_do: what_to_do(Some(Cause::FrictionHigher)).to_owned(),
            what_the_engineer_can_do:
                "Compare the torque off bottom with that of the last connections. If the sensor is \
                                       right, fit the friction to a log of today with flexdrill calibrate; if not, set \
                                       calibration.follow to false and the factor back."
                    .to_owned(),
            ..Finding::default()
        })
    }
}

/// What the rig is compared with.
#[derive(Debug, Clone, Copy)]
pub enum Judged<'a> {
    /// The twin alone.
    Twin(&'a Compared),
    /// Plausible tools; `None` where they have not come to an instant that can be judged.
    Tools(Option<&'a plausible::Compared>),
}

impl Judged<'_> {
    /// The finding; `None` while nothing can be judged. `bit_depth` (m) is NaN where the rig does not give it.
    pub(super) fn finding(&self, bit_depth: f64) -> Option<Finding> {
        match self {
            Self::Twin(compared) => finding(compared, bit_depth),
            Self::Tools(compared) => by_tools((*compared)?, bit_depth),
        }
    }
}

/// The finding on a comparison with plausible tools.
fn by_tools(compared: &plausible::Compared, bit_depth: f64) -> Option<Finding> {
    // Nothing comparable is not the same as agreement: `None` leaves the alarm as it stands.
    if !compared.is_judged() {
        return None;
    }
    let Some(found) = compared.disagreement() else {
        return Some(Finding::default());
    };
    let (name, unit, factor, digits) = display(found.quantity);
    let write = |value: f64| number(factor * value, digits).unwrap_or_else(|| "a value out of range".to_owned());
    let range = |[low, high]: [f64; 2]| format!("{} to {} {unit}", write(low), write(high));
    let all = found.readings.all.map(range);
    // The range that does not hold the value comes first. A reader must see whether any plausible tool explains it.
    let ranges = match (found.tools, all) {
        (Tools::Fitting, Some(all)) => format!(
            "the plausible tools that fit what was measured before show {}, all {} of them {all}",
            range(found.range),
            compared.tools,
        ),
        (Tools::Fitting, None) => format!(
            "the plausible tools that fit what was measured before show {}",
            range(found.range)
        ),
        (Tools::All, _) => format!("all {} plausible tools show {}", compared.tools, range(found.range)),
    };
    let consequence = match found.tools {
        Tools::All => {
            "No plausible tool describes the rig at present; the twin's other alarms may be wrong or missing."
        }
        Tools::Fitting => {
            "Something has changed since, which the twin does not know yet; its other alarms may be wrong."
        }
    };
    let (causes, distance) = (compared.causes(), found.readings.distance(found.range));
    Some(Finding {
        priority: Some(if found.much { Priority::Medium } else { Priority::Low }),
        value: factor * distance,
        threshold: factor * found.readings.limit(LEVELS[0]).copysign(distance),
        unit,
        evidence: format!(
            "{name} {}: {} {unit} measured; {ranges}.",
            state(compared.drilling, bit_depth),
            write(found.readings.measured)
        ),
        cause: in_one(&causes),
        consequence: consequence.to_owned(),
        what_to_do: what_to_do(causes.first().copied()).to_owned(),
        what_the_engineer_can_do: ENGINEER.to_owned(),
        ..Finding::default()
    })
}

/// What an engineer can do about a disagreement.
const ENGINEER: &str = "Compare the residuals of all quantities on and off bottom. Check the sensors of torque, hook load \
                        and weight. If they are right, fit friction and bit to a log of today with flexdrill calibrate.";

/// What the rig does, and where.
fn state(drilling: bool, bit_depth: f64) -> String {
    let state = if drilling {
        "while drilling"
    } else {
        "while rotating off bottom"
    };
    let depth = number(bit_depth, 0).map_or(String::new(), |depth| format!(" at a bit depth of {depth} m"));
    format!("{state}{depth}")
}

/// The likely causes in a sentence. What is measured has separated those that it can: several are named as one.
fn in_one(causes: &[Cause]) -> String {
    // The causes come in the order of likelihood, and the driller acts on the first.
    let causes: Vec<&str> = causes.iter().take(NAMED).map(|cause| in_words(*cause)).collect();
    let apart = match causes.len() {
        0 | 1 => "",
        _ => "; what is measured cannot separate these",
    };
    format!("Likely {}{apart}.", causes.join(", or "))
}

/// The finding on a comparison; `None` while nothing can be judged. `bit_depth` (m) is NaN where the rig does not give it.
pub(super) fn finding(compared: &Compared, bit_depth: f64) -> Option<Finding> {
    // Nothing comparable is not the same as agreement: `None` leaves the alarm as it stands.
    let (quantity, worst) = compared.worst()?;
    let beyond = |level: f64| worst.difference().abs() >= worst.limit(level);
    // The two levels are of the same residual, so the second implies the first.
    let priority = match LEVELS.map(beyond) {
        [_, true] => Priority::Medium,
        [true, false] => Priority::Low,
        [false, false] => return Some(Finding::default()),
    };
    let (name, unit, factor, digits) = display(quantity);
    // Both texts and figures leave in the display's unit, so that the alarm shows what the trend shows.
    let write = |value: f64| number(factor * value, digits).unwrap_or_else(|| "a value out of range".to_owned());
    Some(Finding {
        priority: Some(priority),
        value: factor * worst.difference(),
        // A negative difference is shown against a negative threshold.
        threshold: factor * worst.limit(LEVELS[0]).copysign(worst.difference()),
        unit,
        evidence: format!(
            "{name} {}: {} {unit} measured, {} to {} {unit} expected.",
            state(compared.drilling, bit_depth),
            write(worst.measured),
            write(worst.predicted - worst.band()),
            write(worst.predicted + worst.band()),
        ),
        cause: in_one(&compared.causes),
        consequence: "The model does not describe the tool at present; its other alarms may be wrong or missing."
            .to_owned(),
        what_to_do: what_to_do(compared.causes.first().copied()).to_owned(),
        what_the_engineer_can_do: ENGINEER.to_owned(),
        ..Finding::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_calibration::residual::{Residual, causes};

    fn compared(quantity: RigQuantity, measured: f64, drilling: bool) -> Compared {
        let mut residuals = [None; RigQuantity::COUNT];
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
            |measured, drilling| finding(&compared(RigQuantity::SurfaceTorque, measured, drilling), 1234.4).unwrap();
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
        let weight = compared(RigQuantity::DownholeWeight, 100.0, true);
        let lost = finding(&weight, f64::NAN).unwrap();
        assert!(
            lost.evidence
                .starts_with("Weight on bit in the hole while drilling: 0.1 kN"),
            "{}",
            lost.evidence
        );
        assert!(lost.what_to_do.starts_with("Do not add weight"), "{}", lost.what_to_do);
    }

    /// A torque that drifts by a quarter moves the friction of a twin that follows, after which the two agree.
    #[test]
    fn a_twin_that_agrees_because_it_was_moved_far_says_so() {
        let at = |factor: f64, at_limit: bool| Followed {
            factors: [factor, 1.0],
            at_limit,
            by_tools: false,
        };
        for near in [0.8, 1.0, 1.25] {
            assert_eq!(at(near, false).finding(), None, "{near}");
        }
        for far in [0.5, 0.79, 1.26, 2.0] {
            let finding = at(far, false).finding().unwrap();
            assert_eq!(finding.priority, Some(Priority::Low));
            assert!(finding.evidence.contains("1.00 is configured"), "{}", finding.evidence);
        }
        let stopped = at(1.1, true).finding().unwrap();
        assert!(
            stopped.evidence.contains("where a limit stops it"),
            "{}",
            stopped.evidence
        );
    }

    #[test]
    fn what_cannot_be_judged_is_no_finding() {
        let mut none = compared(RigQuantity::HookLoad, 900.0, true);
        assert!(finding(&none, f64::NAN).unwrap().priority.is_some());
        none.residuals = [None; RigQuantity::COUNT];
        assert_eq!(finding(&none, f64::NAN), None);
    }
}
