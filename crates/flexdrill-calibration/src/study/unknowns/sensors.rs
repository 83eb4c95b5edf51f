//! Factors and tares of the rig's sensors. They act on what is measured, or on the weight that acts, and need no runs of the
//! twin of their own.

use crate::CalibrationError;
use crate::sensor::Sensor;
use crate::unknown::{Shape, Unknown};
use crate::windows::Channel;
use flexdrill_config::{Config, Law};
use flexdrill_core::units::n_to_kn;

/// Distance from 1 within which 90 % of the factors of weight indicators lie, and that of their tares from 0 (kN), where the
/// configuration states neither: assumptions, those of `config/rig.yaml`. The weight is derived from the tension of the
/// deadline, which the sheaves' friction changes by some per cent.
const INDICATOR: [f64; 2] = [0.05, 5.0];

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// The weight indicator, whose weight drives the twin.
    Indicator,
    /// A channel that is compared.
    Channel(Channel),
}

/// Part of a sensor's error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Reading over truth.
    Factor,
    /// Reading at a truth of 0.
    Tare,
}

/// An unknown of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct OfSensor {
    /// Name and prior (SI).
    pub unknown: Unknown,
    /// Whose it is.
    pub of: Of,
    /// What it is.
    pub part: Part,
    /// Key of the configuration that gets its value; none where the configuration does not state the sensor.
    pub key: Option<&'static str>,
    /// What the key gets per SI unit.
    pub per_value: f64,
}

/// An unknown as the configuration states it.
struct Stated {
    of: Of,
    part: Part,
    /// Middle and half width of the 90 % of its prior, in the unit of the key.
    prior: [f64; 2],
    key: Option<&'static str>,
}

/// Rows of what is measured, the part of its error, and the path of both numbers, of which the first is the key.
macro_rules! stated {
    ($($of:expr, $part:ident: $($section:ident).+ [$middle:ident, $half:ident];)+) => {
        vec![$(Stated {
            of: $of,
            part: Part::$part,
            prior: [$($section).+.$middle, $($section).+.$half],
            key: Some(concat!($(stringify!($section), ".",)+ stringify!($middle))),
        }),+]
    };
}

/// The unknowns of all sensors: the tares of surface torque and hook load, then what is stated of factors and further tares.
pub(super) fn of(config: &Config) -> Result<Vec<OfSensor>, CalibrationError> {
    let calibration = &config.calibration;
    let uncertainty = config.uncertainty.clone().unwrap_or_default();
    let [torque, load, bit_torque, bit_weight] = [
        Channel::SurfaceTorque,
        Channel::HookLoad,
        Channel::BitTorque,
        Channel::BitWeight,
    ]
    .map(Of::Channel);
    let mut rows = stated! {
        torque, Tare: calibration[torque_tare_nm, torque_tare_range_nm];
        load, Tare: calibration[hook_load_tare_kn, hook_load_tare_range_kn];
        Of::Indicator, Factor: uncertainty.sensors.weight_indicator[factor, factor_error];
        Of::Indicator, Tare: uncertainty.sensors.weight_indicator[tare_kn, tare_range_kn];
        torque, Factor: uncertainty.sensors.surface_torque[factor, factor_error];
        load, Factor: uncertainty.sensors.hook_load[factor, factor_error];
        bit_torque, Factor: uncertainty.sensors.downhole_torque[factor, factor_error];
        bit_torque, Tare: uncertainty.sensors.downhole_torque[tare_nm, tare_range_nm];
        bit_weight, Factor: uncertainty.sensors.downhole_weight[factor, factor_error];
        bit_weight, Tare: uncertainty.sensors.downhole_weight[tare_kn, tare_range_kn];
    };
    // An indicator of which nothing is stated is not exact: none is. Its values have no key then.
    let indicator = uncertainty.sensors.weight_indicator;
    if indicator.factor_error == 0.0 && indicator.tare_range_kn == 0.0 {
        let [error, tare] = INDICATOR;
        for row in rows.iter_mut().filter(|row| row.of == Of::Indicator) {
            row.prior[1] = if row.part == Part::Factor { error } else { tare };
            row.key = None;
        }
    }
    // Of the error of the rate of penetration, a half of the variance is that of all windows: a factor that no length of the log
    // averages away. As a covariance it would pull the rates down, since low ones would have small errors.
    if config.rock.law == Law::DepthOfCut {
        let half = crate::BAND * calibration.rate_of_penetration_error / 2.0_f64.sqrt();
        rows.push(Stated {
            of: Of::Channel(Channel::RateOfPenetration),
            part: Part::Factor,
            prior: [1.0, half],
            key: None,
        });
    }
    // What has no range is exact.
    rows.retain(|row| row.prior[1] != 0.0);
    rows.into_iter().map(OfSensor::of).collect()
}

impl OfSensor {
    fn of(stated: Stated) -> Result<Self, CalibrationError> {
        let Stated { of, part, prior, key } = stated;
        let (sensor, unit) = match of {
            Of::Indicator => ("weight indicator", "N"),
            Of::Channel(channel) => channel.name_and_unit(),
        };
        let (name, unit) = match part {
            // It is no sensor's.
            _ if of == Of::Channel(Channel::RateOfPenetration) => (format!("error of the twin's {sensor}"), ""),
            Part::Factor => (format!("factor of the {sensor}"), ""),
            Part::Tare => (format!("tare of the {sensor}"), unit),
        };
        // Keys have forces in kN.
        let per_value = if unit == "N" { n_to_kn(1.0) } else { 1.0 };
        let [middle, half] = prior;
        let ends = [middle - half, middle + half].map(|end| end / per_value);
        Ok(Self {
            unknown: Unknown::new(&name, unit, Shape::Normal, ends)?,
            of,
            part,
            key,
            per_value,
        })
    }
}

/// The sensor of what is measured, by the numbers of its unknowns, which begin at `first`. Without an own factor the hook load
/// has that of the weight indicator, which is derived from it: such a hook load does not say whether the indicator is right.
/// That factor acts about `hanging`, the hook load (N) of a tool that hangs, which the tare belongs to.
pub(super) fn sensor(all: &[OfSensor], first: usize, of: Of, hanging: f64) -> Sensor {
    let find = |of: Of, part: Part| all.iter().position(|known| known.of == of && known.part == part);
    let place = |at: Option<usize>| at.map(|at| first + at);
    let own = find(of, Part::Factor);
    let tare = place(find(of, Part::Tare));
    match own {
        None if of == Of::Channel(Channel::HookLoad) => Sensor {
            factor: place(find(Of::Indicator, Part::Factor)),
            tare,
            about: hanging,
        },
        own => Sensor {
            factor: place(own),
            tare,
            about: 0.0,
        },
    }
}

/// Range of the weights (N) that may act where the indicator shows these, for standardised errors up to `most`. Both errors
/// are rarely large together: their squares add up.
pub(super) fn acting_range(all: &[OfSensor], shown: [f64; 2], most: f64) -> [f64; 2] {
    let spread = |part: Part| {
        let of = all.iter().find(|known| known.of == Of::Indicator && known.part == part);
        of.map_or(0.0, |known| {
            let [low, high] = known.unknown.prior();
            0.5 * (high - low) / crate::BAND * most
        })
    };
    let middle = |part: Part, without: f64| {
        let of = all.iter().find(|known| known.of == Of::Indicator && known.part == part);
        of.map_or(without, |known| known.unknown.value(0.0))
    };
    let (factor, tare) = (middle(Part::Factor, 1.0), middle(Part::Tare, 0.0));
    let [low, high] = shown.map(|shown| (shown - tare) / factor);
    let half = |weight: f64| (weight * spread(Part::Factor)).hypot(spread(Part::Tare)) / factor;
    [low - half(low), high + half(high)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::unknowns::Unknowns;

    fn rig() -> Config {
        Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap()
    }

    #[test]
    fn what_is_stated_of_the_sensors_is_the_prior() {
        let unknowns = Unknowns::of(&rig()).unwrap();
        let known = |of, part| {
            let mut all = unknowns.sensors.iter();
            all.find(|known| known.of == of && known.part == part)
        };
        let factor = known(Of::Indicator, Part::Factor).unwrap();
        assert_eq!(factor.unknown.prior(), [0.95, 1.05]);
        assert_eq!(factor.key, Some("uncertainty.sensors.weight_indicator.factor"));
        let tare = known(Of::Indicator, Part::Tare).unwrap();
        assert_eq!(tare.unknown.prior(), [-5000.0, 5000.0]);
        assert_eq!(tare.per_value, 1e-3);
        assert!(known(Of::Channel(Channel::SurfaceTorque), Part::Factor).is_some());
        assert!(known(Of::Channel(Channel::HookLoad), Part::Factor).is_none());
        // A hook load whose error is not stated has the indicator's factor, about the load of hanging.
        let first = unknowns.modelled.len();
        let hook = unknowns.sensor(Of::Channel(Channel::HookLoad), 61e3);
        assert_eq!(hook.factor, unknowns.sensor(Of::Indicator, 0.0).factor);
        assert_eq!((hook.tare, hook.about), (Some(first + 1), 61e3));
        let own = rig()
            .with_value("uncertainty.sensors.hook_load.factor_error", 0.01)
            .unwrap();
        let hook = Unknowns::of(&own).unwrap().sensor(Of::Channel(Channel::HookLoad), 61e3);
        assert!(hook.factor.is_some() && hook.about == 0.0);
        assert_ne!(hook.factor, unknowns.sensor(Of::Indicator, 0.0).factor);
    }

    #[test]
    fn an_indicator_of_which_nothing_is_stated_is_not_exact() {
        let unknowns = Unknowns::of(&rig().without_uncertainty()).unwrap();
        let of = unknowns.sensors.iter().filter(|known| known.of == Of::Indicator);
        let found: Vec<_> = of.map(|known| (known.unknown.prior(), known.key)).collect();
        assert_eq!(found, [([0.95, 1.05], None), ([-5000.0, 5000.0], None)]);
        // 2.5 standard deviations of 5 % and of 5 kN at 10 kN, in squares: 760 N and 7.6 kN.
        let [low, high] = acting_range(&unknowns.sensors, [10e3, 10e3], 2.5);
        let half = 2.5 / crate::BAND * 500.0_f64.hypot(5000.0);
        assert!((high - 10e3 - half).abs() < 1e-6 && (10e3 - low - half).abs() < 1e-6);
    }
}
