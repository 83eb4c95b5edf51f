//! A posterior's sample: what is read and what is refused, and plausible tools drawn from it.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::path::Path;

use flexdrill_config::Config;
use flexdrill_uncertainty::posterior::{Provenance, to_csv};
use flexdrill_uncertainty::{Channel, Posterior, PosteriorError, Priors};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;

const TOOL: &str = "\
well:
  sections: [{arc: {radius: 3.2, build_angle_deg: 90}}]
  hole_diameter: 0.118
tool:
  links: 33
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6}
  bit: {diameter: 0.118, inertia: 0.01}
calibration: {torque_tare_range_nm: 50}
uncertainty:
  keys:
    - key: contact.inner.friction_tangential
      also: [contact.inner.friction_axial]
      distribution: {log_normal: {low: 0.25, high: 0.40}}
      source: a test
    - {key: tool.bit.friction_factor, form: factor, distribution: {log_normal: {low: 0.8, high: 1.25}}, source: a test}
    - key: contact.outer.friction_tangential
      distribution: {log_normal: {low: 0.25, high: 0.40}}
      source: a test
    - {key: tool.joint.play_deg, distribution: {uniform: {low: 0, high: 1}}, source: a test}
  correlated:
    - {keys: [contact.inner.friction_tangential, contact.outer.friction_tangential], correlation: 0.6}
ensemble: {members: 8, from: {posterior: posterior.csv}}
";
const INNER: [&str; 2] = ["contact.inner.friction_tangential", "contact.inner.friction_axial"];
const BIT: &str = "tool.bit.friction_factor";
const TARE: &str = "calibration.torque_tare_nm";
/// Half of the range of 90 %, in standard deviations.
const BAND: f64 = 1.644_853_626_951_472_2;

fn config() -> Config {
    Config::from_text("test.yaml", TOOL).unwrap()
}

fn provenance(config: &Config, keys: &[&str]) -> Provenance {
    Provenance {
        version: "0.2.0".to_owned(),
        tool: config.tool_hash(keys.iter().copied()),
        configuration: config.hash(),
        log: "rig, of May.csv".to_owned(),
        sha256: "ab".repeat(32),
        rows: [3, 3600],
        seed: 4,
        objections: Vec::new(),
    }
}

fn text(config: &Config, keys: &[&str], rows: &[(f64, Vec<f64>)]) -> String {
    let rows = rows.iter().map(|(weight, values)| (*weight, values.as_slice()));
    to_csv(&provenance(config, keys), keys, rows)
}

fn read(text: &str, config: &Config) -> Result<Posterior, PosteriorError> {
    let read = Posterior::from_csv("posterior.csv", text.as_bytes())?;
    read.belongs_to(config)?;
    Ok(read)
}

/// Ten members of the bit's friction, which the drafts of these tests change.
fn ten() -> String {
    let rows: Vec<(f64, Vec<f64>)> = (0..10).map(|k| (1.0, vec![0.2 + 0.005 * f64::from(k)])).collect();
    text(&config(), &[BIT], &rows)
}

/// A value at a standard normal score of a log-normal prior with 90 % between two ends.
fn log_normal([low, high]: [f64; 2], z: f64) -> f64 {
    (0.5 * (low * high).ln() + 0.5 * (high / low).ln() / BAND * z).exp()
}

/// Standard normal numbers (Box and Muller).
fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}

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

#[test]
fn what_was_written_is_read() {
    let config = config();
    let rows: Vec<(f64, Vec<f64>)> = (0..10)
        .map(|k| {
            (
                0.5 + 0.1 * f64::from(k),
                vec![1.0 / f64::from(k + 3), -12.345_678_9 * f64::from(k)],
            )
        })
        .collect();
    let keys = [INNER[0], TARE];
    let posterior = read(&text(&config, &keys, &rows), &config).unwrap();
    assert_eq!(posterior.keys(), keys);
    assert_eq!(posterior.provenance, provenance(&config, &keys));
    for (member, (weight, values)) in posterior.members().iter().zip(&rows) {
        assert_eq!(member.weight, *weight);
        for (found, written) in member.values.iter().zip(values) {
            assert!((found - written).abs() <= 5e-9 * written.abs());
        }
    }
    // As a spreadsheet writes it again: marks, quotes, ends of lines, lines filled with commas.
    let filled = ten().replace("# seed: 4", "\"# seed: 4\",").replace('\n', "\r\n") + ",\r\n\r\n";
    let again = Posterior::from_csv("a", ("\u{feff}".to_owned() + &filled).as_bytes()).unwrap();
    let first = Posterior::from_csv("a", ten().as_bytes()).unwrap();
    assert_eq!((again.members().len(), again.keys()), (10, first.keys()));
    assert_eq!(again.provenance, first.provenance);
    assert_ne!(again.sha256(), first.sha256());
}

#[test]
fn what_is_wrong_is_refused_with_its_place() {
    let config = config();
    let ten = ten();
    let (head, rows) = ten.split_at(ten.find("weight").unwrap());
    let heavy = format!("{head}weight,{BIT}\n1e3,1\n") + &"1,0.2\n".repeat(20);
    for (changed, why) in [
        (
            ten.replacen("\n1,0.2\n", "\n-1,0.2\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: weight: -1: must be at least 0",
        ),
        (
            ten.replacen("\n1,0.2\n", "\nNaN,0.9\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: weight: NaN: must be a finite number",
        ),
        (
            ten.replacen("\n1,0.2\n", "\n1,inf\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: tool.bit.friction_factor: inf: must be a finite number",
        ),
        (
            ten.replacen("\n1,0.2\n", "\n1,0.2,2\n", 1),
            "posterior.csv:11: no posterior of `flexdrill calibrate`: 3 values: must be 2, a weight and one per key",
        ),
        (
            ten.replace("\n1,", "\n0,"),
            "all weights are 0: at least one must be above 0",
        ),
        (heavy, "its weights amount to 1 members alike: must be at least 8"),
        (
            ten.replacen("\n1,0.2\n", "\n1,-0.2\n", 1),
            "posterior.csv:11: tool.bit.friction_factor: -0.2: must be 0 to",
        ),
        (
            ten.replace(BIT, "tool.bit.friction_facto"),
            "tool.bit.friction_facto: must be the name of a number of this configuration; did you mean tool.bit.friction_factor?",
        ),
        (
            ten.replace(BIT, "tool.links"),
            "tool.links: must be the name of a number of this configuration",
        ),
        (
            ten.replace(BIT, ""),
            "no posterior of `flexdrill calibrate`: column 2 has no name",
        ),
        (ten.replace(",tool", ",a,a,tool"), "a has two columns: must have one"),
        (
            ten.replace("weight,", "w,"),
            "the first column is `w`: must be `weight`",
        ),
        (head.to_owned(), "it has no line of names"),
        (format!("{head}weight,{BIT}\n"), "it has no members"),
        (format!("{head}weight\n1\n"), "it has no keys: the log determined none"),
        (
            format!(
                "{head}weight,{}\n",
                (0..65).map(|k| format!("k{k}")).collect::<Vec<_>>().join(",")
            ),
            "must have at most 64 keys",
        ),
        (
            format!("{head}weight,{BIT}\n") + &"1,1\n".repeat(100_001),
            "posterior.csv:100011: no posterior of `flexdrill calibrate`: must have at most 100000 members",
        ),
        (
            rows.to_owned(),
            "the comment line `# flexdrill posterior: ...` is missing",
        ),
        (ten.replace("posterior: 1", "posterior: 2"), "format 2: must be 1"),
        (
            ten.replace("usable: yes", "usable: no: another rock"),
            "posterior.csv: this calibration is not to be used: another rock",
        ),
        (
            ten.replace("log rows: 3 to", "log rows: 3 -"),
            "must be two numbers with `to`",
        ),
    ] {
        let error = read(&changed, &config).unwrap_err().to_string();
        assert!(error.contains(why), "{error}\n{why}");
    }
}

#[test]
fn a_posterior_of_another_tool_or_file_is_refused() {
    let ten = ten();
    let other = config().with_value("well.hole_diameter", 0.1185).unwrap();
    let error = read(&ten, &other).unwrap_err().to_string();
    assert!(
        error.contains("a posterior of another tool or hole (log \"rig, of May.csv\""),
        "{error}"
    );
    // What was fitted, how it is solved and what is called an alarm make no other tool.
    for (key, value) in [(BIT, 0.83), ("solver.time_step", 1e-4), ("whirl.hysteresis", 0.3)] {
        read(&ten, &config().with_value(key, value).unwrap()).unwrap();
    }
    let digest = read(&ten, &config()).unwrap().sha256().to_owned();
    let named = config().with_value("ensemble.posterior_sha256", digest).unwrap();
    read(&ten, &named).unwrap();
    let error = read(&(ten + "1,1\n"), &named).unwrap_err().to_string();
    assert!(
        error.contains("ensemble.posterior_sha256, for the same plausible tools"),
        "{error}"
    );
    let error = Posterior::named_by(&config(), Path::new("nowhere"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("posterior.csv: the posterior named by ensemble.from cannot be read"),
        "{error}"
    );
}

#[test]
fn a_key_needs_a_prior_that_has_its_values() {
    let config = config();
    let refused = |keys: &[&str], values: &[f64], odd: &[f64]| {
        let mut rows = vec![(1.0, values.to_vec()); 20];
        rows[4].1 = odd.to_vec();
        let posterior = read(&text(&config, keys, &rows), &config).unwrap();
        let priors = Priors::of(&config).unwrap();
        // A run that goes on takes what holds.
        let kept = priors.clone().drawn_from_what_holds(&posterior);
        kept.member(1, 2).unwrap();
        priors.drawn_from(&posterior).unwrap_err().to_string()
    };
    let error = refused(&["tool.joint.friction"], &[0.1], &[0.3]);
    assert!(
        error.contains("tool.joint.friction: must be in uncertainty.keys") && error.contains("are 0.1 to 0.1"),
        "{error}"
    );
    let error = refused(&["tool.joint.play_deg"], &[0.5], &[1.5]);
    assert!(
        error.contains("posterior.csv:15: tool.joint.play_deg: 1.5 deg: must be from "),
        "{error}"
    );
    assert!(
        error.ends_with("(its prior has no values beyond; state a wider one)"),
        "{error}"
    );
    let error = refused(&INNER, &[0.3, 0.3], &[0.3, 0.31]);
    assert!(
        error.contains("posterior.csv:15: contact.inner.friction_axial: 0.31: must be 0.3 (it has one draw with"),
        "{error}"
    );
}

/// A file with damaged bytes, lines that were cut, doubled or exchanged: it is read or refused in words.
fn damaged() -> impl Strategy<Value = Vec<u8>> {
    let edits = prop::collection::vec((any::<prop::sample::Index>(), 0..6_u8, any::<u8>()), 1..12);
    edits.prop_map(|edits| {
        const WORDS: [&[u8]; 8] = [
            b"1e308",
            b"-1",
            b",",
            b"\n",
            b"NaN",
            b"weight",
            b"# usable: no",
            b"\xff",
        ];
        let mut bytes = ten().into_bytes();
        for (place, what, byte) in edits {
            if bytes.is_empty() {
                break;
            }
            let at = place.index(bytes.len());
            match what {
                0 => bytes[at] = byte,
                1 => bytes.truncate(at),
                2 => drop(bytes.remove(at)),
                3 => bytes.insert(at, byte),
                4 => drop(bytes.splice(at..at, WORDS[usize::from(byte) % WORDS.len()].iter().copied())),
                _ => {
                    let tail = bytes[at..].to_vec();
                    bytes.extend(tail);
                }
            }
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_damaged_file_is_read_or_refused_in_words(bytes in damaged()) {
        let config = config();
        match Posterior::from_csv("damaged.csv", &bytes) {
            Err(error) => {
                let error = error.to_string();
                prop_assert!(error.starts_with("damaged.csv") && error.len() < 1000, "{}", error);
            }
            Ok(posterior) => {
                let held = posterior.belongs_to(&config);
                let priors = Priors::of(&config).unwrap();
                match priors.clone().drawn_from(&posterior) {
                    Ok(after) if held.is_ok() => {
                        let draws = after.member(1, 3).unwrap().draws;
                        prop_assert!(draws.iter().all(|draw| draw.is_finite()));
                    }
                    Ok(_) => {}
                    Err(error) => prop_assert!(error.to_string().starts_with("damaged.csv")),
                }
                let _ = priors.drawn_from_what_holds(&posterior).member(1, 3);
            }
        }
    }
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
