//! The alarm `rig_disagrees` in the book: its delays, and what a connection does to it.

use std::path::PathBuf;
use std::sync::Arc;

use flexdrill::alarms::{AlarmBook, AlarmId, Followed, Judged};
use flexdrill::messages::std_msgs::Header;
use flexdrill_alarms::Priority;
use flexdrill_calibration::monitor::Compared;
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
