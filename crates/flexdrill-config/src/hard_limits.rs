//! `inputs.hard_limits`: what no parameter goes beyond while the twin runs, whoever asks.
//!
//! A parameter that is set while the twin runs comes over the network. The configuration is what the operator of the
//! machine has allowed; its hard limits hold for everything that may be set live and loosens how the inputs are
//! watched.

use super::Config;
use super::error::{ConfigError, Problem};
use super::section::section;

section! {
    /// Limits of the parameters that may change while the twin runs. Where a value of the configuration is beyond its
    /// hard limit, that value is the limit.
    #[derive(Copy)]
    pub struct HardLimits(this) {
        /// Lowest value of `inputs.rotary_speed.min_rpm` (r/min).
        min_rpm: f64 = 0.0, within(-5000.0, this.max_rpm), "r/min", "not above max_rpm";
        /// Highest value of `inputs.rotary_speed.max_rpm` (r/min).
        max_rpm: f64 = 300.0, within(-5000.0, 5000.0), "r/min", "far above any top drive";
        /// Highest value of `inputs.rotary_speed.safe_rpm` (r/min), or the configured value where that is higher.
        safe_rpm: f64 = 0.0, within(-5000.0, 5000.0), "r/min", "far above any top drive";
        /// Highest value of `inputs.rotary_speed.slew_rpm_per_s`, `downhole_slew_rpm_per_s` and `safe_ramp_rpm_per_s`
        /// (r/min per s).
        slew_rpm_per_s: f64 = 200.0, above(0.0, 1e6), "r/min per s", "a jump in speed is an infinite torque";
        /// Lowest value of `inputs.rotary_speed.safe_ramp_rpm_per_s` (r/min per s).
        slowest_ramp_rpm_per_s: f64 = 0.5, within(0.0, 1e6), "r/min per s", "too slow a ramp never gets there";
        /// Highest value of `inputs.weight_on_bit.max_kn` (kN).
        max_kn: f64 = 200.0, within(0.0, 2000.0), "kN", "far above any drilling tool";
        /// Highest value of `inputs.weight_on_bit.safe_kn` (kN), or the configured value where that is higher.
        safe_kn: f64 = 0.0, within(0.0, 2000.0), "kN", "far above any drilling tool";
        /// Highest value of `inputs.weight_on_bit.tare_error_kn` (kN).
        tare_error_kn: f64 = 5.0, within(0.0, 100.0), "kN", "a reading further below zero is wrong, not untared";
        /// Highest value of `inputs.weight_on_bit.slew_kn_per_s` and `safe_ramp_kn_per_s` (kN/s).
        slew_kn_per_s: f64 = 100.0, above(0.0, 1e6), "kN/s", "a jump in load is a blow on the tool";
        /// Lowest value of `inputs.weight_on_bit.safe_ramp_kn_per_s` (kN/s).
        slowest_ramp_kn_per_s: f64 = 0.1, within(0.0, 1e6), "kN/s", "too slow a ramp never gets there";
        /// Lowest value of `inputs.rate_of_penetration.min_m_per_h` (m/h).
        min_m_per_h: f64 = -500.0, within(-3000.0, this.max_m_per_h), "m/h", "not above max_m_per_h";
        /// Highest value of `inputs.rate_of_penetration.max_m_per_h` (m/h).
        max_m_per_h: f64 = 500.0, within(-3000.0, 3000.0), "m/h", "pipe is not tripped faster";
        /// Highest value of `inputs.rate_of_penetration.slew_m_per_h_per_s` (m/h per s).
        slew_m_per_h_per_s: f64 = 100.0, above(0.0, 1e6), "m/h per s", "a jump in advance is a blow on the tool";
        /// Lowest value of `inputs.standpipe_pressure.min_mpa` (MPa).
        min_mpa: f64 = 0.0, within(-150.0, this.max_mpa), "MPa", "not above max_mpa";
        /// Highest value of `inputs.standpipe_pressure.max_mpa` (MPa).
        max_mpa: f64 = 105.0, within(-150.0, 150.0), "MPa", "beyond any pump";
        /// Highest value of `inputs.standpipe_pressure.tare_error_mpa` (MPa).
        tare_error_mpa: f64 = 1.0, within(0.0, 5.0), "MPa", "a reading further below zero is wrong, not untared";
        /// Highest value of `inputs.standpipe_pressure.slew_mpa_per_s` (MPa/s).
        slew_mpa_per_s: f64 = 10.0, above(0.0, 1e6), "MPa/s", "a jump in pressure is a blow on the tool";
        /// Highest value of `slow_age` and `max_age` of all inputs (s).
        max_age: f64 = 60.0, above(0.0, 3600.0), "s", "an hour is not live any more";
        /// Highest value of `hold_before_safe` of all inputs (s).
        hold_before_safe: f64 = 600.0, within(0.0, 86_400.0), "s", "a day is not live any more";
        /// Highest value of all keys of `outputs.rates` (Hz).
        rate: f64 = 200.0, within(0.0, 1000.0), "Hz", "more would flood the network";
    }
}

/// Bounds of one live parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct HardBound {
    /// Dotted path of the parameter.
    pub key: String,
    /// Least value; none where no hard limit is.
    pub low: Option<f64>,
    /// Greatest value; none where no hard limit is.
    pub high: Option<f64>,
    /// Where the limit comes from.
    pub limit: String,
    unit: &'static str,
}

/// Groups of thresholds of alarms, and the factor by which a client may raise one above its configured value. Beyond it,
/// one call would end an alarm whose motion continues. Thresholds may be lowered: that calls earlier.
const THRESHOLDS: ([&str; 3], f64) = (
    ["whirl.backward_cycles.", "whirl.forward_power.", "whirl.lasting_turns."],
    1.25,
);
/// Coefficients of friction, and the factor by which a client may move one from its configured value either way: the range
/// in which a calibration looks for it. Without friction nothing whirls backward, and a twin without it is silent.
const FRICTION: ([&str; 5], f64) = (
    [
        "contact.inner.friction_tangential",
        "contact.inner.friction_axial",
        "contact.outer.friction_tangential",
        "contact.outer.friction_axial",
        "tool.bit.friction_factor",
    ],
    2.0,
);

/// The bounds near the configured values of what decides whether an alarm is raised.
fn near_the_configuration(numbers: &[super::NumberKey]) -> Vec<HardBound> {
    let bound = |number: &super::NumberKey, low: Option<f64>, high: Option<f64>, words: String| HardBound {
        key: number.key.clone(),
        low,
        high,
        limit: words,
        unit: number.unit,
    };
    let (groups, most) = THRESHOLDS;
    let thresholds = numbers
        .iter()
        .filter(|number| groups.iter().any(|group| number.key.starts_with(group)));
    let thresholds = thresholds.map(|number| {
        let words = format!("alarms depend on it: at most {most} times its configured value");
        bound(number, None, Some(most * number.value), words)
    });
    let (keys, factor) = FRICTION;
    let friction = numbers
        .iter()
        .filter(|number| keys.contains(&number.key.as_str()) && number.value > 0.0);
    let friction = friction.flat_map(|number| {
        let words = |side: &str| format!("alarms depend on it: {side} its configured value");
        [
            bound(number, Some(number.value / factor), None, words("at least half")),
            bound(number, None, Some(factor * number.value), words("at most twice")),
        ]
    });
    thresholds.chain(friction).collect()
}

/// Where the hard limits of a configuration lie for each live parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct HardBounds(Vec<HardBound>);

#[derive(Clone, Copy)]
enum Side {
    Low,
    High,
}
use Side::{High, Low};

/// A key of an input, the side on which it is bounded, and the hard limit with its value.
type Row = (&'static str, Side, &'static str, f64);

/// A watch that is looser than this would not notice a silent input in time, whichever input it is.
fn of_every_input(limits: &HardLimits) -> [Row; 3] {
    [
        ("slow_age", High, "max_age", limits.max_age),
        ("max_age", High, "max_age", limits.max_age),
        ("hold_before_safe", High, "hold_before_safe", limits.hold_before_safe),
    ]
}

/// The ramp to the safe value has both sides: too fast it is a blow on the tool, too slow it never arrives.
fn of_rotary_speed(limits: &HardLimits) -> Vec<Row> {
    let fastest = |key| (key, High, "slew_rpm_per_s", limits.slew_rpm_per_s);
    let slowest = limits.slowest_ramp_rpm_per_s;
    vec![
        ("min_rpm", Low, "min_rpm", limits.min_rpm),
        ("max_rpm", High, "max_rpm", limits.max_rpm),
        ("safe_rpm", High, "safe_rpm", limits.safe_rpm),
        fastest("slew_rpm_per_s"),
        fastest("downhole_slew_rpm_per_s"),
        fastest("safe_ramp_rpm_per_s"),
        ("safe_ramp_rpm_per_s", Low, "slowest_ramp_rpm_per_s", slowest),
    ]
}

/// As of the speed, but without a limit from below.
fn of_weight_on_bit(limits: &HardLimits) -> Vec<Row> {
    let fastest = |key| (key, High, "slew_kn_per_s", limits.slew_kn_per_s);
    let slowest = limits.slowest_ramp_kn_per_s;
    vec![
        ("max_kn", High, "max_kn", limits.max_kn),
        ("safe_kn", High, "safe_kn", limits.safe_kn),
        ("tare_error_kn", High, "tare_error_kn", limits.tare_error_kn),
        fastest("slew_kn_per_s"),
        fastest("safe_ramp_kn_per_s"),
        ("safe_ramp_kn_per_s", Low, "slowest_ramp_kn_per_s", slowest),
    ]
}

fn of_rate_of_penetration(limits: &HardLimits) -> Vec<Row> {
    vec![
        ("min_m_per_h", Low, "min_m_per_h", limits.min_m_per_h),
        ("max_m_per_h", High, "max_m_per_h", limits.max_m_per_h),
        (
            "slew_m_per_h_per_s",
            High,
            "slew_m_per_h_per_s",
            limits.slew_m_per_h_per_s,
        ),
    ]
}

fn of_standpipe_pressure(limits: &HardLimits) -> Vec<Row> {
    vec![
        ("min_mpa", Low, "min_mpa", limits.min_mpa),
        ("max_mpa", High, "max_mpa", limits.max_mpa),
        ("tare_error_mpa", High, "tare_error_mpa", limits.tare_error_mpa),
        ("slew_mpa_per_s", High, "slew_mpa_per_s", limits.slew_mpa_per_s),
    ]
}

impl HardBounds {
    /// Those of the configuration that a run begins with.
    pub fn of(config: &Config) -> Self {
        let limits = &config.inputs.hard_limits;
        let groups = [
            ("inputs.rotary_speed", of_rotary_speed(limits)),
            ("inputs.weight_on_bit", of_weight_on_bit(limits)),
            ("inputs.rate_of_penetration", of_rate_of_penetration(limits)),
            ("inputs.standpipe_pressure", of_standpipe_pressure(limits)),
        ];
        let rows = groups.into_iter().flat_map(|(group, own)| {
            let keys = own.into_iter().chain(of_every_input(limits));
            keys.map(move |(key, side, limit, value)| (format!("{group}.{key}"), side, limit, value))
        });
        // Numbers that the configuration does not have are left out: a limit needs the value that it bounds.
        let numbers = config.numbers();
        let rates = numbers.iter().filter(|number| number.key.starts_with("outputs.rates."));
        let rates = rates.map(|number| (number.key.clone(), High, "rate", limits.rate));
        // A value of the configuration beyond its hard limit is the limit itself: the file is the operator's decision, and
        // a parameter may come from any client.
        let bound = |(key, side, limit, value): (String, Side, &str, f64)| {
            let own = numbers.iter().find(|number| number.key == key)?;
            let (low, high) = match side {
                Low => (Some(value.min(own.value)), None),
                High => (None, Some(value.max(own.value))),
            };
            Some(HardBound {
                key,
                low,
                high,
                limit: format!("the hard limit inputs.hard_limits.{limit}"),
                unit: own.unit,
            })
        };
        let near = near_the_configuration(&numbers);
        Self(rows.chain(rates).filter_map(bound).chain(near).collect())
    }

    /// Whether a configuration that parameters have changed keeps them.
    ///
    /// # Errors
    /// With every value that goes beyond its hard limit.
    pub fn check(&self, changed: &Config) -> Result<(), ConfigError> {
        let numbers = changed.numbers();
        let mut problems = Vec::new();
        for bound in &self.0 {
            let Some(number) = numbers.iter().find(|number| number.key == bound.key) else {
                continue;
            };
            let words = match (bound.low, bound.high) {
                (Some(low), _) if number.value < low => format!("at least {low} {}", bound.unit),
                (_, Some(high)) if number.value > high => format!("at most {high} {}", bound.unit),
                _ => continue,
            };
            problems.push(Problem {
                file: "parameter".to_owned(),
                line: None,
                is_default: false,
                key: bound.key.clone(),
                value: super::checker::number(number.value),
                unit: bound.unit,
                bound: words,
                reason: format!(
                    "{}, which holds while the twin runs; start it again with another configuration",
                    bound.limit
                ),
            });
        }
        if problems.is_empty() {
            Ok(())
        } else {
            Err(ConfigError::Invalid { problems })
        }
    }

    /// A range of a parameter, cut to its hard limits.
    pub fn cut(&self, key: &str, range: [f64; 2]) -> [f64; 2] {
        let mine = self.0.iter().filter(|bound| bound.key == key);
        mine.fold(range, |[low, high], bound| {
            [
                bound.low.map_or(low, |hard| low.max(hard)),
                bound.high.map_or(high, |hard| high.min(hard)),
            ]
        })
    }

    /// Hard limits that the configuration itself goes beyond, in sentences.
    pub(super) fn overridden(config: &Config) -> Vec<String> {
        let limits = &config.inputs.hard_limits;
        let (speed, weight) = (&config.inputs.rotary_speed, &config.inputs.weight_on_bit);
        let (advance, pressure) = (&config.inputs.rate_of_penetration, &config.inputs.standpipe_pressure);
        let pairs = [
            (
                "rotary_speed.max_rpm",
                speed.max_rpm,
                "max_rpm",
                limits.max_rpm,
                "r/min",
            ),
            ("weight_on_bit.max_kn", weight.max_kn, "max_kn", limits.max_kn, "kN"),
            (
                "rate_of_penetration.max_m_per_h",
                advance.max_m_per_h,
                "max_m_per_h",
                limits.max_m_per_h,
                "m/h",
            ),
            (
                "standpipe_pressure.max_mpa",
                pressure.max_mpa,
                "max_mpa",
                limits.max_mpa,
                "MPa",
            ),
        ];
        let beyond = pairs.into_iter().filter(|(_, own, _, hard, _)| own > hard);
        beyond
            .map(|(key, own, limit, hard, unit)| {
                format!(
                    "inputs.{key} {own} {unit} is beyond inputs.hard_limits.{limit} {hard} {unit}; what the configuration asks for is \
                     the hard limit"
                )
            })
            .collect()
    }
}
