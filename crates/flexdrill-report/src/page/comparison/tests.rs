use super::*;
use crate::compare::{Pair, quantity::Unit};

/// A drag that differs by half matters less than an alarm, and less than a tenth of the weight at the bit.
#[test]
fn cards_begin_with_what_matters_most() {
    let quantity = |name: &str, a: f64, b: f64| {
        let figures = |mean| {
            Some(Figures {
                min: mean,
                mean,
                max: mean,
            })
        };
        ComparedQuantity {
            name: name.to_owned(),
            unit: Unit {
                shown: "kN",
                factor: 1.0,
                small: 1e-6,
            },
            runs: Pair {
                a: figures(a),
                b: figures(b),
            },
        }
    };
    let all = [
        quantity("drag of the wall on the guide", 1.0, 2.0),
        quantity("rate of penetration of the bit", 3.0, 3.3),
        quantity("torque of the rock on the bit", 100.0, 100.1),
        quantity("weight on bit, at the bit", 9.0, 10.0),
        quantity("power taken: rock", 2.0, 2.0),
    ];
    let names: Vec<&str> = largest(&all).iter().map(|quantity| quantity.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "weight on bit, at the bit",
            "rate of penetration of the bit",
            "drag of the wall on the guide",
            "torque of the rock on the bit"
        ]
    );
    let alarm = |name: &str, a: u8, b: u8| {
        let stood = |priority| Stood {
            times: u64::from(priority > 0),
            duration: 1.0,
            priority,
        };
        AlarmPair {
            id: name.to_owned(),
            name: name.to_owned(),
            runs: Pair {
                a: stood(a),
                b: stood(b),
            },
        }
    };
    let alarms = [
        alarm("same", 3, 3),
        alarm("low", 0, 1),
        alarm("raised", 2, 3),
        alarm("new", 0, 3),
    ];
    let names: Vec<&str> = raised_otherwise(&alarms)
        .iter()
        .map(|alarm| alarm.name.as_str())
        .collect();
    assert_eq!(names, ["new", "raised", "low"]);
}

#[test]
fn differing_keys_have_their_path() {
    let a = "run:\n  title: x\nwell:\n  depth: 3\n  sections:\n  - arc: 1\n";
    let b = "run:\n  title: x\nwell:\n  depth: 4 # m\n  sections:\n  - arc: 1\ntool:\n  links: 3\n";
    let found = differing(a, b);
    assert_eq!(
        found,
        [
            ["well.depth: 3".to_owned(), "well.depth: 4".to_owned()],
            [String::new(), "tool.links: 3".to_owned()]
        ]
    );
}
