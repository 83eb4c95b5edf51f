//! Plausible tools drawn from a sample.

use super::*;

/// Bayes's rule for a linear measurement with a normal error has a closed form. With standard normal scores x of two keys and
/// of a tare, y = h x + e, the posterior has the precision C^-1 + h h' / s^2. The sample is the prior of the keys that it has,
/// weighted by the likelihood; the key that it leaves out, the wall's friction, follows by its correlation with the pipe's.
#[test]
fn members_have_the_posterior_of_a_linear_measurement() {
    let config = config();
    let (correlation, h, y, noise) = (0.6, [1.0, 0.7, -0.5], 1.4, 0.6);
    let mut random = fastrand::Rng::with_seed(3);
    let rows: Vec<(f64, Vec<f64>)> = (0..20_000)
        .map(|_| {
            let x = [(); 3].map(|()| normal(&mut random));
            let residual = y - h.iter().zip(x).map(|(h, x)| h * x).sum::<f64>();
            let inner = log_normal([0.25, 0.40], x[0]);
            let bit = config.tool.bit.friction_factor * log_normal([0.8, 1.25], x[1]);
            let weight = (-0.5 * (residual / noise).powi(2)).exp();
            (weight, vec![inner, inner, bit, 50.0 / BAND * x[2]])
        })
        .collect();
    let keys = [INNER[0], INNER[1], BIT, TARE];
    let posterior = read(&text(&config, &keys, &rows), &config).unwrap();
    let priors = Priors::of(&config).unwrap().drawn_from(&posterior).unwrap();

    // Closed form for (pipe, bit, tare), whose priors are independent.
    let h = Vector3::from(h);
    let covariance = (Matrix3::identity() + h * h.transpose() / (noise * noise))
        .try_inverse()
        .unwrap();
    let mean = covariance * h * y / (noise * noise);
    // The wall's friction: x_w = r x_p + sqrt(1 - r^2) n.
    let wall_mean = correlation * mean[0];
    let wall_variance = correlation * correlation * covariance[(0, 0)] + 1.0 - correlation * correlation;

    let count = 20_000;
    let sensor = |channel| priors.sensors().iter().position(|of| of.channel == channel).unwrap();
    let torque = sensor(Channel::SurfaceTorque);
    let inverse = |[low, high]: [f64; 2], value: f64| BAND * (2.0 * value.ln() - (low * high).ln()) / (high / low).ln();
    let drawn: Vec<[f64; 5]> = (0..count)
        .map(|number| {
            let member = priors.member(1, number).unwrap();
            [
                inverse([0.25, 0.40], member.draws[0]),
                inverse([0.8, 1.25], member.draws[1]),
                member.sensors[torque].tare * BAND / 50.0,
                inverse([0.25, 0.40], member.draws[2]),
                member.draws[3],
            ]
        })
        .collect();
    let n = count as f64;
    let mean_of = |of: usize| drawn.iter().map(|x| x[of]).sum::<f64>() / n;
    let covariance_of = |a: usize, b: usize| {
        let (ma, mb) = (mean_of(a), mean_of(b));
        drawn.iter().map(|x| (x[a] - ma) * (x[b] - mb)).sum::<f64>() / n
    };
    // The weights leave about 7,000 members alike of the sample: a mean is known to 0.012 of a deviation, a variance to 1.7 %.
    // Four of these are allowed.
    for a in 0..3 {
        let deviation = covariance[(a, a)].sqrt();
        assert!(
            (mean_of(a) - mean[a]).abs() < 0.05 * deviation,
            "{a}: {} {}",
            mean_of(a),
            mean[a]
        );
        for b in 0..3 {
            let scale = (covariance[(a, a)] * covariance[(b, b)]).sqrt();
            let found = covariance_of(a, b);
            assert!(
                (found - covariance[(a, b)]).abs() < 0.07 * scale,
                "{a} {b}: {found} {}",
                covariance[(a, b)]
            );
        }
    }
    assert!((mean_of(3) - wall_mean).abs() < 0.05, "{} {wall_mean}", mean_of(3));
    assert!(
        (covariance_of(3, 3) / wall_variance - 1.0).abs() < 0.07,
        "{} {wall_variance}",
        covariance_of(3, 3)
    );
    assert!((covariance_of(0, 3) - correlation * covariance[(0, 0)]).abs() < 0.05);
    // The play is uniform from 0 to 1, as without the sample.
    assert!((mean_of(4) - 0.5).abs() < 0.01 && (covariance_of(4, 4) - 1.0 / 12.0).abs() < 0.003);
}

/// Renewals work with scores: those of a member drawn from a sample give that member, as those of any other.
#[test]
fn a_member_has_scores_that_give_it_again() {
    let config = config();
    let bit = config.tool.bit.friction_factor;
    let rows: Vec<(f64, Vec<f64>)> = (0..100)
        .map(|k| {
            let inner = 0.28 + 0.001 * f64::from(k % 17);
            (1.0, vec![inner, inner, bit * (0.9 + 0.003 * f64::from(k))])
        })
        .collect();
    let keys = [INNER[0], INNER[1], BIT];
    let posterior = read(&text(&config, &keys, &rows), &config).unwrap();
    let priors = Priors::of(&config).unwrap();
    let after = priors.clone().drawn_from(&posterior).unwrap();
    let mut bits = Vec::new();
    for number in 0..64 {
        let member = after.member(5, number).unwrap();
        let again = priors.at(member.scores.clone()).unwrap();
        assert_eq!((&again.draws, &again.sensors), (&member.draws, &member.sensors));
        assert_eq!(again.config, member.config);
        assert_eq!(
            member.config.contact.inner.friction_axial,
            member.config.contact.inner.friction_tangential
        );
        // Seed and number decide, and not what was drawn before.
        assert_eq!(after.member(5, number).unwrap().draws, member.draws);
        assert_ne!(after.member(6, number).unwrap().draws, member.draws);
        bits.push(member.draws[1].to_bits());
    }
    bits.sort_unstable();
    bits.dedup();
    assert_eq!(bits.len(), 64, "members are equal");
    // Without a sample members are what they were.
    assert_eq!(
        priors.member(5, 3).unwrap().draws,
        Priors::of(&config).unwrap().member(5, 3).unwrap().draws
    );
}

/// Any number of members takes each part of a sample as often as its weights ask for: of two clouds with one and three
/// quarters of the weight, the rarer one has a quarter of the members, to within two.
#[test]
fn few_members_are_spread_over_the_sample() {
    let config = config();
    let bit = config.tool.bit.friction_factor;
    let rows: Vec<(f64, Vec<f64>)> = (0..200)
        .map(|k| {
            if k < 100 {
                (1.0, vec![0.8 * bit])
            } else {
                (3.0, vec![1.2 * bit])
            }
        })
        .collect();
    let posterior = read(&text(&config, &[BIT], &rows), &config).unwrap();
    let priors = Priors::of(&config).unwrap().drawn_from(&posterior).unwrap();
    for seed in 1..20 {
        let low = |count: u64| {
            let members = (0..count).map(|number| priors.member(seed, number).unwrap());
            members
                .filter(|member| member.config.tool.bit.friction_factor < bit)
                .count() as f64
        };
        for count in [8, 12, 24, 48] {
            assert!(
                (low(count) - 0.25 * count as f64).abs() <= 2.0,
                "seed {seed}, {count} members: {}",
                low(count)
            );
        }
    }
}

/// Quantiles of a key are those of the weighted sample where it has the key, and those of the prior elsewhere.
#[test]
fn quantiles_are_those_of_the_sample() {
    let config = config();
    // Twenty members, the last one with more weight: 19 + 19^0.5 over as many squares, 14 alike.
    let rows: Vec<(f64, Vec<f64>)> = (0..20)
        .map(|row| {
            let weight = if row == 19 { f64::sqrt(19.0) } else { 1.0 };
            (weight, vec![0.30 + 1e-3 * f64::from(row); 2])
        })
        .collect();
    let sample = read(&text(&config, &INNER, &rows), &config).unwrap();
    let priors = Priors::of(&config).unwrap();
    let drawn = priors.clone().drawn_from(&sample).unwrap();
    let whole = 19.0 + f64::sqrt(19.0);
    // Members 0 to 9 have a share of 10 / whole of all weights.
    for (p, value) in [(0.5 / whole, 0.300), (9.5 / whole, 0.309), (0.9, 0.319), (1.0, 0.319)] {
        assert!(
            (drawn.draw(0, p) - value).abs() < 1e-8,
            "{p}: {} {value}",
            drawn.draw(0, p)
        );
    }
    for entry in 1..4 {
        for p in [0.05, 0.5, 0.95] {
            assert_eq!(drawn.draw(entry, p), priors.draw(entry, p));
        }
    }
    assert_eq!(priors.draw(0, 0.05), priors.entries()[0].draw(0.05));
}

/// A calibration finds factor and tare of the weight indicator: members have them from its sample, jointly.
#[test]
fn members_have_the_weight_indicator_of_a_sample() {
    let stated = "  sensors: {weight_indicator: {factor_error: 0.05, tare_range_kn: 5.0}}\nensemble:";
    let config = Config::from_text("test.yaml", &TOOL.replace("ensemble:", stated)).unwrap();
    let keys = [
        "uncertainty.sensors.weight_indicator.factor",
        "uncertainty.sensors.weight_indicator.tare_kn",
    ];
    // An indicator that is 3 % high; the more, the less its tare.
    let rows: Vec<(f64, Vec<f64>)> = (0..200)
        .map(|k| {
            let from_middle = 1e-4 * (f64::from(k) - 99.5);
            (1.0, vec![1.03 + from_middle, 1.0 - 50.0 * from_middle])
        })
        .collect();
    let posterior = read(&text(&config, &keys, &rows), &config).unwrap();
    let priors = Priors::of(&config).unwrap().drawn_from(&posterior).unwrap();
    let mut mean = [0.0; 2];
    for number in 0..64 {
        let member = priors.member(3, number).unwrap();
        let shown = member
            .sensors
            .iter()
            .find(|of| of.channel == Channel::WeightIndicator)
            .unwrap();
        mean[0] += shown.factor / 64.0;
        mean[1] += shown.tare / 64.0;
        // The line of the sample, in SI: they scatter about it along it.
        let on_the_line = 1000.0 - 50e3 * (shown.factor - 1.03);
        assert!((shown.tare - on_the_line).abs() < 5.0, "{shown:?}");
    }
    // Members take each part of the sample alike: a deviation of 0.0058 over 64 members, less than 0.001 in their mean.
    assert!(
        (mean[0] - 1.03).abs() < 1e-3 && (mean[1] - 1000.0).abs() < 50.0,
        "{mean:?}"
    );
    // Without the errors stated, a member near the sample has no scale.
    let bare = self::config();
    let error = read(&text(&bare, &keys, &rows), &bare).unwrap();
    let error = Priors::of(&bare).unwrap().drawn_from(&error).unwrap_err();
    assert!(error.to_string().contains("uncertainty.sensors"), "{error}");
}

/// What a calibration wrote as the likeliest factor is the middle of the draws.
#[test]
fn factors_lie_about_the_stated_one() {
    let stated =
        "  sensors: {weight_indicator: {factor: 1.03, factor_error: 0.01, tare_kn: -2, tare_range_kn: 1}}\nensemble:";
    let config = Config::from_text("test.yaml", &TOOL.replace("ensemble:", stated)).unwrap();
    let priors = Priors::of(&config).unwrap();
    let found = priors.at(Vec::new()).unwrap();
    let shown = found
        .sensors
        .iter()
        .find(|of| of.channel == Channel::WeightIndicator)
        .unwrap();
    assert!(
        (shown.factor - 1.03).abs() < 1e-9 && (shown.tare + 2000.0).abs() < 1e-6,
        "{shown:?}"
    );
}
