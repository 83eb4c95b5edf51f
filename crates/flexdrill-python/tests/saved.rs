//! Saved twins go on to the same bits, and other bytes are refused.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::sync::{Arc, LazyLock};

use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_python::recorder::Finished;
use flexdrill_python::rollout::{Member, rollout};
use flexdrill_python::{Plan, Recorder, Twin, saved};
use proptest::prelude::*;

/// Four links of the paper's tool.
const SMALL: &str = "
well: {sections: [{arc: {radius: 3.2, build_angle_deg: 11}}], hole_diameter: 0.118}
tool:
  links: 4
  elements_per_link: 2
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118}
";

const INPUTS: Inputs = Inputs {
    rotary_speed: 6.0,
    weight_on_bit: 5e3,
    ..Inputs::ZERO
};

/// In motion, at no border of a period.
static TURNING: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let config = Config::from_text("small", SMALL).unwrap();
    let mut twin = Twin::new(Arc::new(config)).unwrap();
    twin.advance(&INPUTS, 123, None).unwrap();
    saved::to_bytes(&twin).unwrap()
});

fn recorded(twin: &mut Twin, steps: u64) -> Vec<Finished> {
    let mut recorder = Recorder::new(["joints", "bit", "energy", "whirl"], 10).unwrap();
    twin.advance(&INPUTS, steps, Some(&mut recorder)).unwrap();
    recorder.finish()
}

/// All digits of all values, in which NaN equals NaN.
fn exact(columns: &[Finished]) -> String {
    format!("{columns:?}")
}

#[test]
fn a_saved_twin_goes_on_to_the_same_bits() {
    let mut first = saved::from_bytes(&TURNING).unwrap();
    let mut second = saved::from_bytes(&saved::to_bytes(&first).unwrap()).unwrap();
    let mut fork = first.fork();
    let expected = recorded(&mut first, 200);
    assert!(
        expected
            .iter()
            .any(|column| column.name == "bit.torque_nm" && column.shape == [20])
    );
    assert_eq!(exact(&recorded(&mut second, 200)), exact(&expected));
    assert_eq!(exact(&recorded(&mut fork, 200)), exact(&expected));
}

#[test]
fn threads_change_no_bit() {
    let batch = |threads: usize| {
        let mut twins: Vec<Twin> = (0..4).map(|_| saved::from_bytes(&TURNING).unwrap()).collect();
        for (seed, twin) in twins.iter_mut().enumerate() {
            twin.disturb(seed as u64);
        }
        let members = twins
            .iter_mut()
            .map(|twin| Member {
                twin,
                plan: Plan {
                    steps: 150,
                    changes: vec![(0, INPUTS), (70, Inputs::ZERO)],
                },
                recorder: Recorder::new(["joints", "bit"], 10).unwrap(),
            })
            .collect();
        let outcomes = rollout(members, threads, |_| true);
        assert!(
            outcomes
                .iter()
                .all(|outcome| outcome.ended && outcome.failure.is_none())
        );
        let columns = outcomes.into_iter().map(|outcome| outcome.recorder.finish());
        columns.collect::<Vec<_>>()
    };
    let alone = batch(1);
    assert_ne!(alone[0], alone[1], "the disturbance changes the motion");
    assert_eq!(batch(3), alone);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn damage_anywhere_is_found(at: prop::sample::Index, bit in 0_u8..8, cut: prop::sample::Index) {
        let mut bytes = TURNING.clone();
        let at = at.index(bytes.len());
        bytes[at] ^= 1 << bit;
        prop_assert!(saved::from_bytes(&bytes).is_err());
        prop_assert!(saved::from_bytes(&TURNING[..cut.index(TURNING.len())]).is_err());
    }

    #[test]
    fn any_bytes_are_refused(bytes: Vec<u8>) {
        prop_assert!(saved::from_bytes(&bytes).is_err());
        prop_assert!(saved::from_bytes(&[b"flexdrPY\x01\0\0\0".as_slice(), &bytes].concat()).is_err());
    }
}
