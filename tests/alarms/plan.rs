//! The alarm `hole_leaves_plan` in the book: when it comes and ends, and what it says.

use flexdrill::alarms::{AlarmBook, AlarmId};
use flexdrill::messages::{Alarm, HoleAhead};
use flexdrill_alarms::Priority;
use flexdrill_motion::{HazardKind, Severity};

use crate::words::{SECOND, config, find, hazard, list, snapshot};

/// The worn bit of the design at 10 kN: 3.57 m where the plan needs 3.20 m, 6 deg behind after 3 m, and 3.33 m at 15 kN.
fn behind() -> HoleAhead {
    let numbers = |of: fn(f64) -> f64| (0..21).map(|index| of(0.25 * f64::from(index))).collect();
    HoleAhead {
        known: true,
        weight_on_bit: 10e3,
        build_rate: 1.0 / 3.57,
        plan_build_rate: 1.0 / 3.2,
        plan_target: 0.5,
        plan_off: 1.2,
        measured_depths: numbers(|ahead| 5.0 + ahead),
        plan_inclination: numbers(|ahead| -ahead * 2_f64.to_radians()),
        plan_high: numbers(|ahead| -0.016 * ahead * ahead),
        plan_right: numbers(|_| 0.0),
        plan_within: numbers(|_| 0.75),
        plan_weight_low: 9.5e3,
        plan_weight_high: 15e3,
        plan_nearest_weight: 15e3,
        plan_nearest_off: 0.5,
        plan_nearest_radius: 3.33,
        plan_weight: 15e3,
        ..HoleAhead::default()
    }
}

/// The same with another distance from the plan.
pub fn off(plan_off: f64) -> HoleAhead {
    HoleAhead { plan_off, ..behind() }
}

fn unknown() -> HoleAhead {
    HoleAhead {
        known: false,
        because: "the bit is off bottom".to_owned(),
        plan_off: f64::NAN,
        ..HoleAhead::default()
    }
}

struct Bench {
    book: AlarmBook,
    now: i64,
}

impl Bench {
    fn new() -> Self {
        Self {
            book: AlarmBook::fresh(config(), 0),
            now: 0,
        }
    }

    /// Observes the same for some seconds; the priority with which the alarm stands then.
    fn observe(&mut self, hole: &HoleAhead, seconds: i64) -> Option<Priority> {
        for _ in 0..seconds {
            self.now += SECOND;
            self.book.advance(self.now);
            self.book.observe_hole(hole, self.now);
        }
        self.book.active(AlarmId::HoleLeavesPlan)
    }

    fn alarm(&self) -> Alarm {
        find(&list(&self.book), "hole_leaves_plan").clone()
    }
}

#[test]
fn the_alarm_needs_a_plan_outside_the_range_for_five_seconds() {
    let mut bench = Bench::new();
    // A well that follows its plan within the range is quiet.
    assert_eq!(bench.observe(&off(0.99), 600), None);
    assert_eq!(bench.observe(&off(1.2), 5), None);
    assert_eq!(bench.observe(&off(0.99), 1), None);
    assert_eq!(bench.observe(&off(1.2), 5), None);
    assert_eq!(bench.observe(&off(1.2), 1), Some(Priority::Low));
    // Hysteresis: it remains until the plan is within the range by a tenth, and ten seconds longer.
    assert_eq!(bench.observe(&off(0.95), 60), Some(Priority::Low));
    assert_eq!(bench.observe(&off(0.89), 10), Some(Priority::Low));
    assert_eq!(bench.observe(&off(0.89), 1), None);
    assert_eq!(bench.observe(&off(0.95), 60), None);
}

#[test]
fn off_bottom_and_where_the_hole_is_not_known_it_is_quiet() {
    let mut bench = Bench::new();
    assert_eq!(bench.observe(&unknown(), 60), None);
    // Without a plan nothing is compared.
    let no_plan = HoleAhead {
        known: true,
        ..unknown()
    };
    assert_eq!(bench.observe(&no_plan, 60), None);
    // What was not known does not count as time of the condition.
    bench.observe(&behind(), 4);
    bench.observe(&unknown(), 20);
    assert_eq!(bench.observe(&behind(), 5), None);
    assert_eq!(bench.observe(&behind(), 1), Some(Priority::Low));
    // The ten seconds after a change of the weight do not end it; a connection does.
    assert_eq!(bench.observe(&unknown(), 15), Some(Priority::Low));
    assert_eq!(bench.observe(&behind(), 5), Some(Priority::Low));
    assert_eq!(bench.alarm().episodes, 1);
    assert_eq!(bench.observe(&unknown(), 60), None);
}

#[test]
fn it_says_what_happens_why_it_matters_and_which_weight_helps() {
    let mut bench = Bench::new();
    bench.observe(&behind(), 6);
    let alarm = bench.alarm();
    assert_eq!(
        alarm.evidence,
        "The hole leaves its plan: it drills a radius of 3.57 m over the next metre, the plan needs a radius of 3.20 m; \
         6.0 deg behind the plan after 3 m."
    );
    assert_eq!(
        alarm.consequence,
        "After 5.0 m the bit is 0.40 m below the plan; 75 % of the plausible tools stay within 0.50 m of it. 15.0 kN at the \
         bit would bring it back."
    );
    assert!(alarm.cause.contains("build less than the plan"), "{}", alarm.cause);
    let action = &alarm.what_to_do;
    assert!(
        action.starts_with("Raise the weight at the bit to 15.0 kN (10.0 kN now) and keep the rotary speed."),
        "{action}"
    );

    // No weight that may be set now.
    let nearest = HoleAhead {
        plan_weight: f64::NAN,
        plan_no_weight: true,
        ..behind()
    };
    assert_eq!(
        bench.observe(&nearest, 6),
        Some(Priority::Medium),
        "the tool must be changed"
    );
    let alarm = bench.alarm();
    assert!(
        alarm
            .consequence
            .ends_with("No weight that may be set now brings it back."),
        "{}",
        alarm.consequence
    );
    assert!(
        alarm.what_to_do.contains("No weight from 9.5 kN to 15.0 kN")
            && alarm.what_to_do.contains("15.0 kN at the bit comes"),
        "{}",
        alarm.what_to_do
    );

    // No weight at all.
    let none = HoleAhead {
        plan_no_guide: true,
        ..nearest
    };
    bench.observe(&none, 1);
    let alarm = bench.alarm();
    assert!(
        alarm
            .what_to_do
            .starts_with("This guide cannot drill the plan at any weight.")
            && alarm.what_to_do.ends_with("change the guide."),
        "{}",
        alarm.what_to_do
    );
    assert!(
        alarm
            .consequence
            .ends_with("No weight does: this guide cannot drill the plan."),
        "{}",
        alarm.consequence
    );
}

/// Another weight can be what raises an alarm of the motion, or what ends it.
#[test]
fn an_alarm_of_the_motion_comes_first() {
    let mut bench = Bench::new();
    bench.observe(&behind(), 6);
    let whirls = snapshot(120.0, 10.0, &[hazard(HazardKind::BackwardWhirl, Severity::Critical)]);
    bench.book.observe_tool(&whirls, bench.now);
    bench.observe(&behind(), 1);
    let alarm = bench.alarm();
    assert_eq!(alarm.follows, "backward_whirl");
    assert_eq!(alarm.what_to_do, "First do what the alarm \"backward whirl\" asks for.");
}

/// A hole that is straight, or drops where the plan builds, has no radius to name.
#[test]
fn no_text_has_a_number_that_there_is_not() {
    let drops = HoleAhead {
        build_rate: -0.02,
        plan_build_rate: 0.0,
        plan_inclination: vec![f64::NAN; 21],
        plan_weight: f64::NAN,
        plan_nearest_weight: f64::NAN,
        ..behind()
    };
    let mut bench = Bench::new();
    bench.observe(&drops, 6);
    let alarm = bench.alarm();
    assert_eq!(
        alarm.evidence,
        "The hole leaves its plan: it drills a drop with a radius of 50.00 m over the next metre, the plan needs a straight hole."
    );
    assert!(
        !alarm.consequence.contains("NaN") && !alarm.what_to_do.contains("NaN"),
        "{alarm:?}"
    );
}
