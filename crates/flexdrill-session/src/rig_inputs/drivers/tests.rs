//! Which publisher drives, by policy, over time.

use super::*;
use InputKind::{RotarySpeed, WeightOnBit};
use InputRoute::{Plain, Stamped};

fn id(process: u8, writer: u8) -> DriverId {
    let mut bytes = [0; 16];
    (bytes[0], bytes[15]) = (process, writer);
    DriverId(bytes)
}

fn drivers(policy: DriverPolicy, named: &[&str]) -> Drivers {
    Drivers::new(Rule {
        policy,
        named: named.iter().map(ToString::to_string).collect(),
        silent_after: [5.0; InputKind::COUNT],
    })
}

const A: u8 = 0xa;
const B: u8 = 0xb;

#[test]
fn the_newest_drives_and_two_at_once_are_reported() {
    let mut drivers = drivers(DriverPolicy::Newest, &[]);
    drivers.describe(Driver {
        id: id(A, 1),
        node: Some("/rig_pc".into()),
        host: Some("10.0.0.7".into()),
        source: String::new(),
    });
    for second in 0..3 {
        let now = f64::from(second);
        drivers.offer(RotarySpeed, Plain, id(A, 1), "", now, 40.0).unwrap();
        assert_eq!(drivers.summary(RotarySpeed, now).several, second > 0);
        drivers
            .offer(RotarySpeed, Plain, id(B, 1), "", now + 0.5, 60.0)
            .unwrap();
    }
    let summary = drivers.summary(RotarySpeed, 3.0);
    assert!(summary.several);
    assert_eq!(
        summary.driving,
        "unnamed node @ unknown host (0b0000000000000000000000.00000001)"
    );
    assert_eq!(
        summary.heard[1],
        "/rig_pc @ 10.0.0.7 (0a0000000000000000000000.00000001)"
    );
    assert_eq!(drivers.summary(WeightOnBit, 3.0), DriverSummary::default());
    // The first of them goes; the other is alone when it has been silent for long enough.
    for second in 3..9 {
        drivers
            .offer(RotarySpeed, Plain, id(B, 1), "", f64::from(second), 60.0)
            .unwrap();
    }
    assert!(!drivers.summary(RotarySpeed, 8.0).several);
}

/// A rig whose program starts again has another id: that is one after the other, not two at once.
#[test]
fn a_restart_is_no_second_driver() {
    let mut drivers = drivers(DriverPolicy::Newest, &[]);
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 1.0, 40.0).unwrap();
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 2.0, 40.0).unwrap();
    drivers.offer(RotarySpeed, Plain, id(B, 1), "", 2.5, 40.0).unwrap();
    drivers.offer(RotarySpeed, Plain, id(B, 1), "", 3.5, 40.0).unwrap();
    let summary = drivers.summary(RotarySpeed, 3.6);
    assert!(!summary.several);
    assert_eq!(summary.heard.len(), 2);
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 4.0, 40.0).unwrap();
    assert!(drivers.summary(RotarySpeed, 4.0).several);
}

#[test]
fn the_first_drives_until_it_falls_silent() {
    let mut drivers = drivers(DriverPolicy::First, &[]);
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 0.0, 40.0).unwrap();
    let refused = drivers.offer(RotarySpeed, Plain, id(B, 2), "", 1.0, 60.0).unwrap_err();
    let said = refused.to_string();
    assert!(
        said.starts_with("rig/rotary_speed_rpm: 60 r/min of unnamed node @ unknown host (0b"),
        "{said}"
    );
    assert!(
        said.contains("(0a0000000000000000000000.00000001) drives until it has been silent for 5 s"),
        "{said}"
    );
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 2.0, 41.0).unwrap();
    // NaN does not keep a publisher in charge.
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 6.0, f64::NAN).unwrap();
    assert!(drivers.offer(RotarySpeed, Plain, id(B, 2), "", 6.9, 60.0).is_err());
    drivers.offer(RotarySpeed, Plain, id(B, 2), "", 7.0, 60.0).unwrap();
    assert!(drivers.offer(RotarySpeed, Plain, id(A, 1), "", 7.1, 40.0).is_err());
    let summary = drivers.summary(RotarySpeed, 7.1);
    assert_eq!((summary.refused, summary.several), (3, true));
    assert!(summary.driving.contains("(0b"), "{summary:?}");
    // The other input has drivers of its own.
    drivers.offer(WeightOnBit, Plain, id(A, 3), "", 7.1, 10.0).unwrap();
}

#[test]
fn named_ones_drive_by_node_or_by_id() {
    let own = id(A, 1).to_string();
    let mut drivers = drivers(DriverPolicy::Named, &["/rig_pc", &own]);
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 0.0, 40.0).unwrap();
    let said = drivers
        .offer(RotarySpeed, Plain, id(B, 1), "", 0.0, 40.0)
        .unwrap_err()
        .to_string();
    assert!(said.contains("inputs.driver.named does not list it"), "{said}");
    drivers.describe(Driver {
        id: id(B, 1),
        node: Some("/rig_pc".into()),
        host: None,
        source: String::new(),
    });
    drivers.offer(RotarySpeed, Plain, id(B, 1), "", 0.1, 40.0).unwrap();
}

#[test]
fn one_process_on_both_topics_is_one_driver() {
    let mut drivers = drivers(DriverPolicy::First, &[]);
    for second in 0..3 {
        drivers
            .offer(RotarySpeed, Plain, id(A, 1), "", f64::from(second), 40.0)
            .unwrap();
        drivers
            .offer(RotarySpeed, Stamped, id(A, 2), "", f64::from(second), 40.0)
            .unwrap();
    }
    assert!(!drivers.summary(RotarySpeed, 2.0).several);
    assert!(drivers.offer(RotarySpeed, Plain, id(A, 3), "", 2.0, 40.0).is_err());
}

#[test]
fn a_flood_of_publishers_is_bounded_and_a_name_cannot_act_on_a_terminal() {
    let mut drivers = drivers(DriverPolicy::Newest, &[]);
    for writer in 0..=255 {
        let driver = id(B, writer);
        drivers.describe(Driver {
            id: driver,
            node: Some("/\x1b[2J".into()),
            host: None,
            source: String::new(),
        });
        drivers
            .offer(RotarySpeed, Plain, driver, "", f64::from(writer) * 1e-3, 40.0)
            .unwrap();
    }
    let summary = drivers.summary(RotarySpeed, 0.3);
    assert_eq!(summary.heard.len(), MOST_NAMED + 1);
    assert!(summary.driving.starts_with("/\\u{1b}[2J @"), "{summary:?}");
    assert!(drivers.known.len() <= MOST_KNOWN && drivers.channels[0].heard.len() <= MOST_PUBLISHERS);
}

#[test]
fn a_clock_that_starts_over_keeps_who_drives() {
    let mut drivers = drivers(DriverPolicy::First, &[]);
    drivers.offer(RotarySpeed, Plain, id(A, 1), "", 1000.0, 40.0).unwrap();
    drivers.clock_set(3.0);
    assert!(drivers.offer(RotarySpeed, Plain, id(B, 1), "", 4.0, 40.0).is_err());
    drivers.offer(RotarySpeed, Plain, id(B, 1), "", 8.0, 40.0).unwrap();
}

/// A bridge is one writer, however many rigs send over it.
#[test]
fn two_sources_of_one_writer_are_two_drivers() {
    let [rig, other] = ["wits 10.0.0.7, well 3", "wits 10.0.0.8"];
    let mut first = drivers(DriverPolicy::First, &[]);
    first.offer(RotarySpeed, Stamped, id(A, 1), rig, 0.0, 40.0).unwrap();
    let refused = first.offer(RotarySpeed, Stamped, id(A, 1), other, 0.5, 100.0);
    let said = refused.unwrap_err().to_string();
    assert!(
        said.contains("of wits 10.0.0.8 refused") && said.contains("of wits 10.0.0.7; well 3 drives until"),
        "{said}"
    );
    // 40 r/min, back from rad/s.
    let refused = first.offer(RotarySpeed, Stamped, id(A, 1), other, 0.9, 39.999_999_999_999_99);
    let said = refused.unwrap_err().to_string();
    assert!(said.contains(": 40 r/min of "), "{said}");
    first.offer(RotarySpeed, Stamped, id(A, 1), rig, 1.0, 40.0).unwrap();
    let summary = first.summary(RotarySpeed, 1.0);
    assert!(
        summary.several && summary.driving.ends_with("of wits 10.0.0.7; well 3"),
        "{summary:?}"
    );
    // Invented sources do not drive out the one that drives.
    for number in 0..100 {
        let source = format!("source {number}");
        assert!(
            first
                .offer(RotarySpeed, Stamped, id(A, 1), &source, 2.0, 100.0)
                .is_err()
        );
    }
    assert!(first.channels[0].heard.len() <= MOST_PUBLISHERS);
    first.offer(RotarySpeed, Stamped, id(A, 1), rig, 3.0, 40.0).unwrap();
    // With the policy newest both drive, and the alarm for several publishers follows.
    let mut newest = drivers(DriverPolicy::Newest, &[]);
    for (time, source, rpm) in [(0.0, rig, 40.0), (0.5, other, 100.0), (1.0, rig, 40.0)] {
        newest.offer(RotarySpeed, Stamped, id(A, 1), source, time, rpm).unwrap();
    }
    assert!(newest.summary(RotarySpeed, 1.0).several);
}
