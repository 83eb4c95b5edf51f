//! What to do, from the rules of the configuration: limits that the inputs are to be brought to.

use flexdrill_alarms::Priority;
use flexdrill_config::{Advice, InputsConfig};
use flexdrill_core::twin::Applied;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// The last resort of a driller, for what is high.
const STOP: &str = "pick up off bottom and stop the drive.";
/// What is said of the rest where no rule would change anything.
const WATCH: &str = "Watch it: no rule (alarms.advice) would change anything at these inputs.";
/// An input is told to be raised to this many times its present value at most: more is another way of drilling, and no
/// answer to an alarm. Assumption.
const MOST_RAISE: f64 = 3.0;

/// The sentences for inputs as they act now. Only what changes them in the right direction, within the limits that the
/// inputs have anyway, is said.
pub(super) fn what_to_do(advice: &Advice, applied: &Applied, inputs: &InputsConfig, priority: Priority) -> String {
    let (speed, weight) = (rad_per_s_to_rpm(applied.rotary_speed), n_to_kn(applied.weight_on_bit));
    let mut ways = Vec::new();
    if let Some(limit) = advice.lower_weight_on_bit_kn.filter(|limit| weight > *limit) {
        ways.push(format!("lower the weight on bit below {limit} kN ({weight:.1} kN now)"));
    }
    let reachable = |now: f64, limit: f64, most: f64| now < limit && limit < most && limit <= MOST_RAISE * now;
    let in_reach = |limit: &f64| reachable(weight, *limit, inputs.weight_on_bit.max_kn);
    if let Some(limit) = advice.raise_weight_on_bit_kn.filter(in_reach) {
        ways.push(format!("raise the weight on bit above {limit} kN ({weight:.1} kN now)"));
    }
    if let Some(limit) = advice.lower_rotary_speed_rpm.filter(|limit| speed > *limit) {
        ways.push(format!("lower the speed below {limit} r/min ({speed:.0} r/min now)"));
    }
    let in_reach = |limit: &f64| reachable(speed, *limit, inputs.rotary_speed.max_rpm);
    if let Some(limit) = advice.raise_rotary_speed_rpm.filter(in_reach) {
        ways.push(format!("raise the speed above {limit} r/min ({speed:.0} r/min now)"));
    }
    let last = match (ways.is_empty(), priority) {
        (true, Priority::High) => return capitalized(STOP),
        (true, _) => return WATCH.to_owned(),
        (false, Priority::High) => format!(" If it does not end, {STOP}"),
        (false, _) => String::new(),
    };
    capitalized(&ways.join(" or ")) + "." + &last
}

fn capitalized(text: &str) -> String {
    let (first, rest) = text.split_at(text.len().min(1));
    first.to_uppercase() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

    fn told(advice: &Advice, rpm: f64, kn: f64, priority: Priority) -> String {
        let applied = Applied {
            rotary_speed: rpm_to_rad_per_s(rpm),
            weight_on_bit: kn_to_n(kn),
            ..Applied::default()
        };
        what_to_do(advice, &applied, &InputsConfig::default(), priority)
    }

    #[test]
    fn only_what_moves_in_the_right_direction_is_said() {
        let advice = Advice {
            lower_weight_on_bit_kn: Some(8.0),
            raise_rotary_speed_rpm: Some(55.0),
            ..Advice::default()
        };
        let (medium, high) = (Priority::Medium, Priority::High);
        assert_eq!(
            told(&advice, 40.0, 10.0, medium),
            "Lower the weight on bit below 8 kN (10.0 kN now) or raise the speed above 55 r/min (40 r/min now)."
        );
        assert_eq!(
            told(&advice, 40.0, 5.0, medium),
            "Raise the speed above 55 r/min (40 r/min now)."
        );
        assert_eq!(told(&advice, 60.0, 5.0, medium), WATCH);
        assert_eq!(told(&advice, 60.0, 5.0, high), "Pick up off bottom and stop the drive.");
        // The drive does not go there.
        let fast = Advice {
            raise_rotary_speed_rpm: Some(500.0),
            ..Advice::default()
        };
        assert_eq!(told(&fast, 40.0, 10.0, medium), WATCH);
        // Nobody sets down twenty times the load because of an alarm.
        let heavy = Advice {
            raise_weight_on_bit_kn: Some(25.0),
            ..Advice::default()
        };
        assert_eq!(told(&heavy, 40.0, 1.3, medium), WATCH);
        assert!(told(&heavy, 40.0, 10.0, medium).starts_with("Raise the weight on bit above 25 kN"));
    }
}
