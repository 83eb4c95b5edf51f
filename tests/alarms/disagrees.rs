//! The alarm `rig_disagrees` in the book: its delays, and what a connection does to it.

use std::path::PathBuf;
use std::sync::Arc;

use flexdrill::alarms::{AlarmBook, AlarmId, Followed, Judged};
use flexdrill::messages::std_msgs::Header;
use flexdrill_alarms::Priority;
use flexdrill_calibration::monitor::Compared;
use flexdrill_calibration::plausible::{self, Readings};
use flexdrill_calibration::residual::{Residual, RigQuantity, causes};
use flexdrill_config::Config;

const SECOND: i64 = 1_000_000_000;

/// A comparison of the surface torque with 300 N m, of which 20 N m is one standard deviation; `None` while nothing can be
/// judged.
fn compared(measured: Option<f64>) -> Compared {
    let mut residuals = [None; RigQuantity::COUNT];
    residuals[RigQuantity::SurfaceTorque as usize] = measured.map(|measured| Residual {
        measured,
        predicted: 300.0,
        error: 20.0,
        scatter: 0.0,
    });
    Compared {
        causes: causes(
            &residuals.map(|of| of.map(|of: Residual| of.difference() / of.limit(1.0))),
            true,
        ),
        residuals,
        steady: measured.is_some(),
        drilling: true,
    }
}

struct Bench {
    book: AlarmBook,
    now: i64,
}

impl Bench {
    /// Observes the same for some seconds; whether the alarm stands then.
    fn observe(&mut self, measured: Option<f64>, seconds: i64) -> Option<Priority> {
        for _ in 0..seconds {
            self.now += SECOND;
            self.book.advance(self.now);
            let compared = compared(measured);
            self.book
                .observe_rig(Judged::Twin(&compared), &Followed::default(), 1234.0, self.now);
        }
        self.book.active(AlarmId::RigDisagrees)
    }
}

#[test]
fn a_disagreement_must_last_and_outlasts_a_connection_but_not_a_trip() {
    let config = Config::load(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("config/rig.yaml")).unwrap();
    let mut bench = Bench {
        book: AlarmBook::fresh(Arc::new(config), 0),
        now: 0,
    };
    // Half of the band is 33 N m: low from 49 N m on, medium from 99 N m on.
    assert_eq!(bench.observe(Some(340.0), 60), None);
    assert_eq!(bench.observe(Some(360.0), 9), None);
    // What was not judged does not count as time of the condition.
    assert_eq!(bench.observe(None, 20), None);
    assert_eq!(bench.observe(Some(360.0), 9), None);
    assert_eq!(bench.observe(Some(360.0), 3), Some(Priority::Low));
    let list = bench.book.list(Header::default());
    let alarm = list.alarms.iter().find(|alarm| alarm.id == "rig_disagrees").unwrap();
    assert!(
        alarm.evidence.contains("360 N m measured, 267 to 333 N m expected"),
        "{alarm:?}"
    );
    assert!(
        alarm.cause.contains("friction") && alarm.what_to_do.contains("circulate"),
        "{alarm:?}"
    );
    // A connection, then the same again, then worse.
    assert_eq!(bench.observe(None, 300), Some(Priority::Low));
    assert_eq!(bench.observe(Some(360.0), 60), Some(Priority::Low));
    assert_eq!(bench.observe(Some(420.0), 12), Some(Priority::Medium));
    // Within the band for less than the off-delay, then for longer.
    assert_eq!(bench.observe(Some(300.0), 25), Some(Priority::Medium));
    assert_eq!(bench.observe(Some(420.0), 15), Some(Priority::Medium));
    assert_eq!(bench.observe(Some(300.0), 35), None);
    // A trip ends it.
    assert!(bench.observe(Some(200.0), 15).is_some());
    assert!(bench.observe(None, 590).is_some());
    assert_eq!(bench.observe(None, 60), None);
}

/// Plausible tools that show 280 to 350 N m, those that fit 300 to 320 N m.
fn by_tools(measured: f64) -> plausible::Compared {
    let mut readings = [None; RigQuantity::COUNT];
    readings[RigQuantity::SurfaceTorque as usize] = Some(Readings {
        measured,
        all: Some([280.0, 350.0]),
        fitting: Some([300.0, 320.0]),
        error: 10.0,
        scatter: 0.0,
    });
    plausible::Compared {
        readings,
        drilling: true,
        tools: 14,
    }
}

/// The alarm names the value, the range that does not hold it, whether any plausible tool explains it, and causes as one.
#[test]
fn what_plausible_tools_do_not_explain_is_an_alarm_that_says_which() {
    let config = Config::load(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("config/rig.yaml")).unwrap();
    let mut book = AlarmBook::fresh(Arc::new(config), 0);
    let mut now = 0;
    let mut observe = |judged: Judged<'_>, followed: &Followed, seconds: i64| {
        for _ in 0..seconds {
            now += SECOND;
            book.advance(now);
            book.observe_rig(judged, followed, 1234.0, now);
        }
        let list = book.list(Header::default());
        let alarm = list.alarms.into_iter().find(|alarm| alarm.id == "rig_disagrees");
        (book.active(AlarmId::RigDisagrees), alarm)
    };
    // Friction that followed the tools within what they hold for possible is no alarm, however far.
    let followed = Followed {
        factors: [1.4, 1.0],
        at_limit: false,
        by_tools: true,
    };
    // The limit is 1.5 times 1.645 x 10 N m beyond a range.
    assert_eq!(observe(Judged::Tools(Some(&by_tools(344.0))), &followed, 60).0, None);
    let (priority, alarm) = observe(Judged::Tools(Some(&by_tools(346.0))), &followed, 15);
    assert_eq!(priority, Some(Priority::Low));
    let alarm = alarm.unwrap();
    assert!(
        alarm.evidence.contains(
            "Surface torque while drilling at a bit depth of 1234 m: 346 N m measured; the plausible tools that fit what was \
             measured before show 300 to 320 N m, all 14 of them 280 to 350 N m."
        ),
        "{alarm:?}"
    );
    // Outside of all: by 52 N m, of which 49 is much.
    let outside = by_tools(402.0);
    let (priority, alarm) = observe(Judged::Tools(Some(&outside)), &followed, 15);
    assert_eq!(priority, Some(Priority::Medium));
    let alarm = alarm.unwrap();
    assert!(
        alarm
            .evidence
            .contains("402 N m measured; all 14 plausible tools show 280 to 350 N m."),
        "{alarm:?}"
    );
    for words in [
        "friction has risen",
        "torque is measured wrongly",
        "cannot separate these",
    ] {
        assert!(alarm.cause.contains(words), "{words}: {}", alarm.cause);
    }
    // While they have not come to an instant that can be judged, what stands remains.
    assert_eq!(observe(Judged::Tools(None), &followed, 300).0, Some(Priority::Medium));
    assert_eq!(observe(Judged::Tools(Some(&by_tools(310.0))), &followed, 35).0, None);
    // Friction at the end of what was possible is one.
    let stopped = Followed {
        at_limit: true,
        ..followed
    };
    assert_eq!(
        observe(Judged::Tools(Some(&by_tools(310.0))), &stopped, 15).0,
        Some(Priority::Low)
    );
}
