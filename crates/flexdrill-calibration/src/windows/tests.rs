//! What is a window, and what is left out.

use super::*;

fn sample(second: u64, rpm: f64, weight: f64, torque: f64) -> Sample {
    Sample {
        time: second as f64,
        row: second + 2,
        rotary_speed: rpm * std::f64::consts::TAU / 60.0,
        weight,
        // Ripple, so that no sensor counts as frozen.
        measured: [
            torque + (second as f64 * 2.4).sin(),
            f64::NAN,
            f64::NAN,
            f64::NAN,
            f64::NAN,
        ],
    }
}

fn accounted(samples: &[Sample], found: &Windows) {
    let used: usize = found.steady.iter().map(|window| window.samples).sum();
    let parts = found
        .left_out
        .iter()
        .filter(|part| !matches!(part.reason, Reason::Frozen(_) | Reason::Trend(_)));
    let left: usize = parts.map(|part| part.samples).sum();
    assert_eq!(used + left, samples.len(), "{found:?}");
}

#[test]
fn steady_parts_are_windows_and_everything_else_has_its_reason() {
    let mut log = Vec::new();
    for second in 0..400 {
        log.push(match second {
            0..60 => sample(second, 40.0, 0.0, 60.0),
            60..90 => sample(second, 40.0, 500.0 * (second - 60) as f64, 90.0),
            90..200 => sample(second, 40.0, 15e3, 300.0),
            200..220 => sample(second, 0.0, 15e3, 0.0),
            220..230 => sample(second, f64::NAN, 15e3, 0.0),
            // The torque rises by a half.
            230..300 => sample(second, 40.0, 10e3, 200.0 + second as f64),
            _ => sample(second, 60.0, 10e3, 250.0),
        });
    }
    // The sensor stops moving.
    log.iter_mut().skip(320).for_each(|sample| sample.measured[0] = 250.0);
    let found = find(&log, &WindowSettings::default());
    accounted(&log, &found);
    let windows: Vec<_> = found
        .steady
        .iter()
        .map(|w| (w.motion, w.rows, w.measured[0].is_some()))
        .collect();
    assert_eq!(
        windows,
        [
            (Activity::OffBottom, [17, 63], true),
            // The end of the ramp lies within the band of the weight, so the settling begins on it.
            (Activity::Drilling, [101, 201], true),
            (Activity::Drilling, [247, 301], false),
            (Activity::Drilling, [317, 401], false),
        ],
        "{found:?}"
    );
    let mean = found.steady[0].measured[0].unwrap();
    assert!((mean.value - 60.0).abs() < 2.0 && mean.scatter < 2.0, "{mean:?}");
    for reason in [
        Reason::Settling,
        Reason::Standing,
        Reason::Missing,
        Reason::Frozen(Channel::SurfaceTorque),
        Reason::Trend(Channel::SurfaceTorque),
    ] {
        assert!(found.left_out.iter().any(|part| part.reason == reason), "{reason}");
    }
}

/// A weight from a hook load scatters by a third; its mean does not change.
#[test]
fn a_noisy_weight_is_steady_and_a_step_of_it_is_not() {
    let mut random = crate::random::Random::new(9);
    let log: Vec<Sample> = (0..400)
        .map(|second| {
            let weight = if second < 200 { 15e3 } else { 25e3 };
            sample(second, 60.0, (weight + 4e3 * random.normal()).max(0.0), 300.0)
        })
        .collect();
    let found = find(&log, &WindowSettings::default());
    accounted(&log, &found);
    let used: usize = found.steady.iter().map(|window| window.samples).sum();
    assert!(used > 300, "{found:?}");
    for window in &found.steady {
        let near = [15e3, 25e3].iter().any(|weight| (window.weight - weight).abs() < 2e3);
        assert!(near && window.motion == Activity::Drilling, "{window:?}");
    }
}

#[test]
fn a_frozen_sensor_and_one_that_jumps_are_no_measurement() {
    let settings = WindowSettings::default();
    let channel = Channel::SurfaceTorque;
    assert_eq!(judge(&[5.0; 40], channel, &settings), Err(Reason::Frozen(channel)));
    let ripple = |k: i32| (f64::from(k) * 2.4).sin();
    for moves in [
        (0..40)
            .map(|k| if k < 20 { 100.0 } else { 110.0 } + ripple(k))
            .collect::<Vec<f64>>(),
        (0..40).map(|k| 100.0 + f64::from(k) + ripple(k)).collect(),
    ] {
        assert_eq!(judge(&moves, channel, &settings), Err(Reason::Trend(channel)));
    }
    let still: Vec<f64> = (0..40).map(|k| 100.0 + ripple(k)).collect();
    assert!(judge(&still, channel, &settings).is_ok());
}

#[test]
fn correlated_samples_count_less() {
    let mut random = crate::random::Random::new(3);
    let (mut walk, mut means) = (0.0, Vec::new());
    let mut stated = 0.0;
    for _ in 0..500 {
        let values: Vec<f64> = (0..60)
            .map(|_| {
                walk = 0.7 * walk + random.normal();
                walk
            })
            .collect();
        if let Ok(mean) = judge(
            &values,
            Channel::HookLoad,
            &WindowSettings {
                trend: 1e9,
                ..WindowSettings::default()
            },
        ) {
            means.push(mean.value);
            stated += mean.scatter / 500.0;
        }
    }
    let seen = (means.iter().map(|m| m * m).sum::<f64>() / means.len() as f64).sqrt();
    // The correlation is estimated from 60 samples; a figure that ignored it would be 2.4 times too small.
    assert!((0.7..1.3).contains(&(stated / seen)), "{stated} {seen}");
}

#[test]
fn a_rate_of_penetration_counts_while_the_bit_drills() {
    let log: Vec<Sample> = (0..200)
        .map(|second| {
            let mut sample = sample(second, 40.0, if second < 100 { 0.0 } else { 15e3 }, 300.0);
            sample.measured[Channel::RateOfPenetration as usize] = 1e-3 * (1.0 + 0.1 * (second as f64 * 1.7).sin());
            sample
        })
        .collect();
    let found = find(&log, &WindowSettings::default());
    let has = found.steady.iter().map(|window| {
        let rate = window.measured[Channel::RateOfPenetration as usize];
        (window.motion, rate.is_some())
    });
    let has: Vec<_> = has.collect();
    assert_eq!(has, [(Activity::OffBottom, false), (Activity::Drilling, true)]);
}
