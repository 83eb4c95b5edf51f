//! Draws: their distributions, their correlation, their limits, and what they depend on.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::f64::consts::PI;
use std::sync::LazyLock;

use flexdrill_config::{Config, NumberKey};
use flexdrill_uncertainty::{Channel, Priors, UncertaintyError};
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
uncertainty:
  keys:
    - {key: tool.joint.friction, distribution: {normal: {low: 0.0, high: 0.4}}, source: a test}
    - {key: contact.inner.stiffness, form: factor, distribution: {log_normal: {low: 0.3333, high: 3}}, source: a test}
    - {key: tool.joint.play_deg, distribution: {uniform: {low: 0, high: 1}}, source: a test}
    - {key: well.hole_diameter, form: offset, distribution: {triangular: {low: 0, mode: 0.001, high: 0.004}}, source: a test}
    - {key: contact.inner.friction_axial, distribution: {log_normal: {low: 0.2, high: 0.4}}, source: a test}
    - {key: contact.outer.friction_axial, distribution: {log_normal: {low: 0.2, high: 0.4}}, source: a test}
  correlated:
    - {keys: [contact.inner.friction_axial, contact.outer.friction_axial], correlation: 0.5}
    - {keys: [tool.joint.play_deg, well.hole_diameter], correlation: -0.8}
";
/// Draws of a test of distributions.
const COUNT: usize = 10_000;

static PRIORS: LazyLock<Priors> = LazyLock::new(|| priors(TOOL));
/// By entry, the draws of [`COUNT`] members.
static DRAWS: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
    let members: Vec<Vec<f64>> = (0..COUNT as u64).map(|member| PRIORS.draws(7, member)).collect();
    let entries = PRIORS.entries().len();
    (0..entries)
        .map(|entry| members.iter().map(|draws| draws[entry]).collect())
        .collect()
});

fn priors(text: &str) -> Priors {
    Priors::of(&Config::from_text("test.yaml", text).unwrap()).unwrap()
}

fn shipped(name: &str) -> Config {
    Config::load(format!("{}/../../config/{name}.yaml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

/// Share of a standard normal below z, by the error function.
fn normal(z: f64) -> f64 {
    0.5 * (1.0 + libm::erf(z / 2.0_f64.sqrt()))
}

/// Largest distance of the empirical distribution from a distribution function, times the root of the count.
fn kolmogorov(values: &[f64], below: impl Fn(f64) -> f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len() as f64;
    let distance = sorted
        .iter()
        .enumerate()
        .map(|(place, value)| {
            let f = below(*value);
            (f - place as f64 / count).max((place + 1) as f64 / count - f)
        })
        .fold(0.0, f64::max);
    distance * count.sqrt()
}

/// Kolmogorov and Smirnov: the limiting distribution has 1 % above 1.628. The distribution functions are written here
/// again, with the cut.
#[test]
fn draws_have_their_distributions() {
    const CRITICAL: f64 = 1.628;
    const Z95: f64 = 1.644_853_626_951_472_2;
    // The middle of the pins' friction is 0.2, of which 0 and 1, the key's limits, cut something off.
    let pins = |x: f64| {
        let at = |x: f64| normal((x - 0.2) / (0.2 / Z95));
        (at(x) - at(0.0)) / (at(1.0) - at(0.0))
    };
    let log_normal = |low: f64, high: f64| {
        let (middle, deviation) = (0.5 * (low * high).ln(), 0.5 * (high / low).ln() / Z95);
        move |x: f64| normal((x.ln() - middle) / deviation)
    };
    let triangle = |x: f64| {
        if x < 0.001 {
            x * x / (0.004 * 0.001)
        } else {
            1.0 - (0.004 - x).powi(2) / (0.004 * 0.003)
        }
    };
    let laws: [Box<dyn Fn(f64) -> f64>; 6] = [
        Box::new(pins),
        Box::new(log_normal(0.3333, 3.0)),
        Box::new(|x| x),
        Box::new(triangle),
        Box::new(log_normal(0.2, 0.4)),
        Box::new(log_normal(0.2, 0.4)),
    ];
    for ((draws, law), entry) in DRAWS.iter().zip(laws).zip(PRIORS.entries()) {
        let found = kolmogorov(draws, law);
        assert!(found < CRITICAL, "{}: {found}", entry.name());
    }
}

/// Ranks, 0 to 1.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    for (rank, place) in order.into_iter().enumerate() {
        ranks[place] = rank as f64 / values.len() as f64;
    }
    ranks
}

fn rank_correlation(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (ranks(a), ranks(b));
    let count = a.len() as f64;
    let products: f64 = a.iter().zip(&b).map(|(a, b)| (a - 0.5) * (b - 0.5)).sum();
    // The variance of a uniform number is 1/12.
    12.0 * products / count
}

/// The correlation of the ranks of a Gaussian copula is 6 / pi asin(r / 2) (Kruskal 1958).
#[test]
fn ranks_are_correlated_as_a_gaussian_copula_has_them() {
    // Four standard errors of a rank correlation.
    let error = 4.0 / (COUNT as f64).sqrt();
    for first in 0..DRAWS.len() {
        for second in 0..first {
            let stated = match (second, first) {
                (4, 5) => 0.5,
                (2, 3) => -0.8,
                _ => 0.0,
            };
            let expected = 6.0 / PI * libm::asin(0.5 * stated);
            let found = rank_correlation(&DRAWS[first], &DRAWS[second]);
            assert!((found - expected).abs() < error, "{first} {second}: {found} {expected}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_one_others() {
    let member = PRIORS.member(3, 5).unwrap();
    // Other members before it change nothing.
    for other in 0..4 {
        PRIORS.member(3, other).unwrap();
    }
    let again = PRIORS.member(3, 5).unwrap();
    assert_eq!(
        (&again.draws, &again.config, &again.sensors),
        (&member.draws, &member.config, &member.sensors)
    );
    assert_eq!(again.config.hash(), member.config.hash());
    for (seed, number) in [(3, 6), (4, 5), (5, 3)] {
        let other = PRIORS.member(seed, number).unwrap();
        assert!(other.draws.iter().zip(&member.draws).all(|(a, b)| a != b));
        assert!(other.sensors.iter().zip(&member.sensors).any(|(a, b)| a != b));
    }
}

/// Draws to their last bits: a member of an earlier build is the same tool. These are of this version; whoever changes the
/// draws on purpose writes the new ones.
#[test]
fn regress_draws_of_an_earlier_build() {
    let draws = PRIORS.draws(1, 0);
    let text: Vec<String> = draws.iter().map(|draw| format!("{draw:.10}")).collect();
    assert_eq!(text, EARLIER);
}
const EARLIER: [&str; 6] = [
    "0.1296385295",
    "1.5628991379",
    "0.1954020518",
    "0.0019381084",
    "0.2865591480",
    "0.2632466525",
];

#[test]
fn an_entry_acts_on_all_its_keys_in_its_form() {
    let config = shipped("rig");
    let priors = Priors::of(&config).unwrap();
    let member = priors.member(1, 2).unwrap();
    let (drawn, draw) = (&member.config, |name: &str| {
        let place = priors.entries().iter().position(|entry| entry.name() == name).unwrap();
        member.draws[place]
    });
    assert!(drawn.uncertainty.is_none());
    let inner = &drawn.contact.inner;
    assert_eq!(inner.friction_axial, inner.friction_tangential);
    assert_eq!(inner.friction_axial, draw("contact.inner.friction_tangential"));
    assert_eq!(
        inner.stiffness,
        config.contact.inner.stiffness * draw("contact.inner.stiffness")
    );
    assert_eq!(
        drawn.well.hole_diameter,
        config.well.hole_diameter + draw("well.hole_diameter")
    );
    let factor = draw("tool.damping.alpha");
    assert_eq!(drawn.tool.damping.beta, config.tool.damping.beta * factor);
    // What is not drawn is as configured.
    assert_eq!(drawn.solver, config.solver);
}

#[test]
fn without_the_section_nothing_is_drawn() {
    let config = Config::from_text("test.yaml", TOOL).unwrap().without_uncertainty();
    let priors = Priors::of(&config).unwrap();
    assert!(priors.is_empty());
    let member = priors.member(1, 1).unwrap();
    assert_eq!(
        (member.config, member.draws.len(), member.sensors.len()),
        (config, 0, 0)
    );
}

/// Each key is allowed by itself, and a guide as wide as its hole is not: such a tool is drawn again.
#[test]
fn draws_that_exclude_each_other_are_drawn_again() {
    let cut = TOOL.find("uncertainty").unwrap();
    let tool = |low: f64| {
        let entries = format!(
            "uncertainty:\n  keys:\n    - {{key: well.hole_diameter, distribution: {{uniform: {{low: {low}, high: 0.112}}}}, \
             source: a test}}\n"
        );
        TOOL[..cut].to_owned() + &entries
    };
    let priors = priors(&tool(0.092));
    let members: Vec<_> = (0..200).map(|member| priors.member(1, member).unwrap()).collect();
    assert!(members.iter().all(|member| member.config.well.hole_diameter > 0.102));
    // Half of the draws are refused: one for each member in the mean, and the root of two of scatter.
    let refused: u32 = members.iter().map(|member| member.refused).sum();
    assert!((140..260).contains(&refused), "{refused}");
    let never = "uncertainty:\n  keys:\n    - {key: well.hole_diameter, distribution: {uniform: {low: 0.09, high: 0.1}}, source: \
                 a test}\n";
    let never = Priors::of(&Config::from_text("test.yaml", &(TOOL[..cut].to_owned() + never)).unwrap()).unwrap();
    let error = never.member(1, 4).unwrap_err();
    assert!(matches!(error, UncertaintyError::Refused { member: 4, .. }));
    assert!(error.to_string().contains("well.hole_diameter"), "{error}");
}

#[test]
fn sensors_join_both_sections() {
    let priors = Priors::of(&shipped("rig")).unwrap();
    let of = |channel| {
        *priors
            .sensors()
            .iter()
            .find(|sensor| sensor.channel == channel)
            .unwrap()
    };
    let weight = of(Channel::WeightIndicator);
    assert_eq!((weight.factor_error, weight.tare_range), (0.05, 5000.0));
    // Of `calibration`, by its defaults.
    let torque = of(Channel::SurfaceTorque);
    assert_eq!(
        (torque.factor_error, torque.tare_range, torque.noise, torque.drift),
        (0.05, 50.0, 15.0, 5.0)
    );
    assert_eq!(of(Channel::HookLoad).tare_range, 20e3);
    let names: Vec<&str> = priors.sensors().iter().map(|sensor| sensor.channel.name()).collect();
    assert_eq!(names, Channel::ALL.map(Channel::name));
}

#[test]
fn errors_of_sensors_have_their_distributions() {
    const Z95: f64 = 1.644_853_626_951_472_2;
    let priors = Priors::of(&shipped("rig")).unwrap();
    let errors: Vec<_> = (0..2000).map(|member| priors.sensor_errors(2, member)).collect();
    let weight = |of: fn(&flexdrill_uncertainty::SensorError) -> f64| -> Vec<f64> {
        errors
            .iter()
            .map(|errors| of(&errors[Channel::WeightIndicator as usize]))
            .collect()
    };
    let factors = kolmogorov(&weight(|error| error.factor), |x| normal((x - 1.0) / (0.05 / Z95)));
    let tares = kolmogorov(&weight(|error| error.tare), |x| normal(x / (5000.0 / Z95)));
    assert!(factors < 1.628 && tares < 1.628, "{factors} {tares}");
    // Nothing is stated of the speed in the hole.
    let exact = &errors[0][Channel::DownholeSpeed as usize];
    assert_eq!((exact.factor, exact.tare), (1.0, 0.0));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 64, ..ProptestConfig::default() })]

    /// Whatever the seed, each key of a member is within its limits, and the member is a tool.
    #[test]
    fn limits_are_never_left(seed: u64, number: u64, rig: bool) {
        let config = shipped(if rig { "rig" } else { "default" });
        let priors = Priors::of(&config).unwrap();
        let member = priors.member(seed, number).unwrap();
        let limits: Vec<NumberKey> = member.config.numbers();
        for key in priors.entries().iter().flat_map(|entry| entry.keys()) {
            let number = limits.iter().find(|number| number.key == key.name).unwrap();
            let low = if number.low_is_in { number.value >= number.low } else { number.value > number.low };
            prop_assert!(low && number.value <= number.high, "{number:?}");
        }
        prop_assert!(member.config.tool().validate().is_ok());
        prop_assert!(member.sensors.iter().all(|error| error.factor > 0.0));
    }

    /// Also where the distribution is cut at the limits, and at its very ends.
    #[test]
    fn cut_distributions_end_at_the_limits(p in 0.0..=1.0_f64, width in 1e-3..1e3_f64) {
        let high = 0.5 * width;
        let text = format!(
            "    - {{key: tool.joint.limit_deg, form: factor, distribution: {{log_normal: {{low: {}, high: {}}}}}, source: a}}\n",
            1.0 / (1.0 + high), 1.0 + high.min(6.4)
        );
        let cut = TOOL.find("    - {key: tool.joint.friction").unwrap();
        let priors = priors(&(TOOL[..cut].to_owned() + &text));
        let entry = &priors.entries()[0];
        for p in [0.0, p, 1.0] {
            for (_, value) in entry.values(entry.draw(p)) {
                prop_assert!(value > 0.0 && value <= 45.0, "{value}");
            }
        }
    }
}
