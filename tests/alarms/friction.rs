//! The alarm `friction_near_stuck` in the book: quiet without limits, its levels with hysteresis, and what it says.

use std::sync::Arc;

use flexdrill::alarms::{AlarmBook, AlarmId};
use flexdrill::messages::{Alarm, Residuals};
use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_trip::soft_string::Motion;
use flexdrill_trip::{Assembly, Sense};

use crate::words::{SECOND, find, list};

/// A straight tool in an inclined hole without a string, so that the friction that takes a pull has a closed form.
fn config(limits: &str) -> Config {
    let text = format!(
        "well: {{start_inclination_deg: 60, sections: [{{straight: {{length: 6}}}}], hole_diameter: 0.118}}
tool:
  links: 40
  pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}
  guide: {{outer_diameter: 0.102, inner_diameter: 0.080, bending_factor: 0.05, free_curvature: 0}}
  joint: {{limit_deg: 6}}
  bit: {{diameter: 0.118}}
contact: {{outer: {{friction_tangential: 0.3, friction_axial: 0.3}}}}
boundary: {{supports: [{{at: top, body: guide, fix: [psi]}}]}}
string: {{{limits}}}
"
    );
    Config::from_text("test.yaml", &text).unwrap()
}

/// Hook load (kN) of pulling out with all friction times a factor.
fn pulling_out(factor: f64) -> f64 {
    let assembly = Assembly::of(&config("")).unwrap().with_friction(factor);
    assembly
        .loads(6.0, 0.0, &Motion::sliding(Sense::Out))
        .unwrap()
        .hook_load()
        / 1e3
}

/// A friction factor with half the width of its band.
fn friction(factor: f64, half: f64) -> Residuals {
    Residuals {
        friction_factor: factor,
        friction_factor_low: factor - half,
        friction_factor_high: factor + half,
        ..Residuals::default()
    }
}

struct Bench {
    book: AlarmBook,
    now: i64,
}

impl Bench {
    fn new(limits: &str) -> Self {
        Self {
            book: AlarmBook::fresh(Arc::new(config(limits)), 0),
            now: 0,
        }
    }

    /// Observes the same for some seconds; the priority with which the alarm stands then.
    fn observe(&mut self, residuals: &Residuals, seconds: i64) -> Option<Priority> {
        for _ in 0..seconds {
            self.now += SECOND;
            self.book.advance(self.now);
            self.book.observe_friction(residuals, self.now);
        }
        self.book.active(AlarmId::FrictionNearStuck)
    }

    fn alarm(&self) -> Alarm {
        find(&list(&self.book), "friction_near_stuck").clone()
    }
}

#[test]
fn without_limits_and_without_a_known_friction_it_is_quiet() {
    let mut bench = Bench::new("");
    assert_eq!(bench.observe(&friction(5.0, 0.1), 120), None);
    let mut bench = Bench::new(&format!("largest_pull_kn: {}", pulling_out(2.0)));
    // The estimate begins with a third, and where nothing is measured it has no value.
    assert_eq!(bench.observe(&friction(2.0, 0.66), 120), None);
    assert_eq!(bench.observe(&friction(f64::NAN, f64::NAN), 120), None);
    assert_eq!(bench.observe(&friction(1.0, 0.1), 120), None);
}

/// A pull that pulls out twice the friction is taken by twice the friction: 0.7, 0.85 and 0.95 of it are the levels.
#[test]
fn levels_are_shares_of_the_friction_that_takes_all_of_the_pull() {
    let mut bench = Bench::new(&format!("largest_pull_kn: {}", pulling_out(2.0)));
    let mut at = |share: f64, seconds: i64| bench.observe(&friction(2.0 * share, 0.1), seconds);
    assert_eq!(at(0.69, 120), None);
    assert_eq!(at(0.71, 30), None);
    assert_eq!(at(0.71, 1), Some(Priority::Low));
    assert_eq!(at(0.84, 60), Some(Priority::Low));
    assert_eq!(at(0.86, 60), Some(Priority::Medium));
    assert_eq!(at(0.96, 60), Some(Priority::High));
    // Hysteresis of 0.05 of the critical friction at each level.
    assert_eq!(at(0.91, 120), Some(Priority::High));
    assert_eq!(at(0.89, 120), Some(Priority::Medium));
    assert_eq!(at(0.66, 120), Some(Priority::Low));
    assert_eq!(at(0.64, 120), None);
    assert_eq!(at(0.69, 120), None);
}

#[test]
fn a_connection_does_not_end_it_and_it_says_what_to_do() {
    let mut bench = Bench::new(&format!("largest_pull_kn: {}", pulling_out(2.0)));
    assert_eq!(bench.observe(&friction(1.8, 0.1), 40), Some(Priority::Medium));
    assert_eq!(
        bench.observe(&friction(f64::NAN, f64::NAN), 500),
        Some(Priority::Medium)
    );
    let alarm = bench.alarm();
    assert!(
        alarm
            .evidence
            .starts_with("Friction is 1.80 times that of the configuration (1.70 to 1.90). At 2.00 times,"),
        "{}",
        alarm.evidence
    );
    assert!(
        alarm.what_to_do.starts_with("Pick up off bottom, rotate and circulate"),
        "{}",
        alarm.what_to_do
    );
    assert_eq!(bench.observe(&friction(f64::NAN, f64::NAN), 200), None);
}
