//! What is not known of a tool that drills, and plausible tools drawn from it.
//!
//! Keys that the configuration names in `uncertainty.keys` are drawn by its own priors. The others have the ranges of
//! [`Unknown::distribution`].

use fastrand::Rng;
use flexdrill_config::{Config, Distribution};
use flexdrill_core::units::deg_to_rad;
use flexdrill_uncertainty::{Law, Priors};

use super::tool::Drilling;

/// What is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unknown {
    /// Lateral resistance of the bit, with rock and wear.
    LateralResistance,
    /// Curvature of the guide as made: a factor.
    FreeCurvature,
    /// Bending stiffness of the guide: a factor.
    BendingStiffness,
    /// Gap between guide and wall: an offset (m).
    Gap,
    /// Weight at the bit: a factor.
    Weight,
    /// Walk angle of the bit: an offset (deg).
    WalkAngle,
    /// Roll of the guide: an offset (deg).
    Roll,
}

impl Unknown {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::LateralResistance,
        Self::FreeCurvature,
        Self::BendingStiffness,
        Self::Gap,
        Self::Weight,
        Self::WalkAngle,
        Self::Roll,
    ];

    /// The key whose distribution replaces the range here; no key has the weight that arrives at the bit.
    pub const fn key(self) -> Option<&'static str> {
        match self {
            Self::LateralResistance => Some("tool.bit.lateral_resistance"),
            Self::FreeCurvature => Some("tool.guide.free_curvature"),
            Self::BendingStiffness => Some("tool.guide.bending_factor"),
            Self::Gap => Some("well.hole_diameter"),
            Self::Weight => None,
            Self::WalkAngle => Some("tool.bit.walk_angle_deg"),
            Self::Roll => Some("tool.guide.free_curvature_phase_deg"),
        }
    }

    /// The range as a distribution.
    pub fn distribution(self, config: &Config) -> Distribution {
        match self {
            Self::LateralResistance => {
                let [low, high] = config.tool.bit.lateral_resistance_range();
                Distribution::LogNormal { low, high }
            }
            Self::FreeCurvature => Distribution::Normal { low: 0.98, high: 1.02 },
            Self::BendingStiffness => Distribution::LogNormal { low: 0.75, high: 1.33 },
            Self::Gap => Distribution::Uniform { low: 0.0, high: 2e-3 },
            Self::Weight => Distribution::Normal { low: 0.9, high: 1.1 },
            Self::WalkAngle => Distribution::Normal { low: -20.0, high: 20.0 },
            Self::Roll => Distribution::Normal { low: -2.0, high: 2.0 },
        }
    }

    /// Limits of what is drawn: beyond them it has no meaning.
    const fn limits(self) -> [f64; 2] {
        match self {
            Self::LateralResistance => [1.1, 1e4],
            Self::FreeCurvature | Self::BendingStiffness | Self::Weight => [0.1, 10.0],
            Self::Gap => [0.0, 1.0],
            Self::WalkAngle => [-60.0, 60.0],
            Self::Roll => [-90.0, 90.0],
        }
    }

    /// Whether the configuration's own priors draw it.
    pub fn is_of(self, config: &Config) -> bool {
        let stated = config.uncertainty.as_ref();
        self.key()
            .zip(stated)
            .is_some_and(|(key, stated)| stated.position(key).is_some())
    }

    /// Sets the drawn value.
    fn set(self, drilling: &mut Drilling, value: f64) {
        let Drilling { guide, law, .. } = drilling;
        match self {
            Self::LateralResistance => law.lateral_resistance = value,
            Self::FreeCurvature => {
                guide.free_curvature *= value;
                guide.bends = guide.bends.times(value);
            }
            Self::BendingStiffness => guide.bending_stiffness *= value,
            Self::Gap => guide.gap += value,
            // The tool was built under the weight that was drawn.
            Self::Weight => {}
            Self::WalkAngle => law.walk_angle += deg_to_rad(value),
            Self::Roll => guide.roll += deg_to_rad(value),
        }
    }
}

/// Shares of a number of members, one in each part of equal probability, in an order that the seed decides: the ends of a band
/// scatter less than with independent draws.
fn shares(count: usize, seed: u64, unknown: usize) -> Vec<f64> {
    // Seeds of neighbours differ in all bits.
    let mut rng = Rng::with_seed(seed ^ (unknown as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut shares: Vec<f64> = (0..count)
        .map(|part| (part as f64 + rng.f64().clamp(1e-9, 1.0 - 1e-9)) / count as f64)
        .collect();
    rng.shuffle(&mut shares);
    shares
}

/// Plausible tools, or why one cannot be.
///
/// # Errors
/// When the priors of the configuration cannot be drawn at all.
pub fn members(
    config: &Config,
    weight: f64,
    azimuth: f64,
    count: usize,
    seed: u64,
) -> Result<Vec<Result<Drilling, String>>, flexdrill_uncertainty::UncertaintyError> {
    let priors = Priors::of(config)?;
    let own: Vec<(usize, Unknown)> = Unknown::ALL
        .into_iter()
        .enumerate()
        .filter(|(_, unknown)| !unknown.is_of(config))
        .collect();
    let mut draws = vec![Vec::with_capacity(own.len()); count];
    for &(index, unknown) in &own {
        // A range that the configuration has checked is a distribution within the limits.
        let Some(law) = Law::new(&unknown.distribution(config), unknown.limits()) else {
            continue;
        };
        for (draw, share) in draws.iter_mut().zip(shares(count, seed, index)) {
            draw.push((unknown, law.quantile(share)));
        }
    }
    let tool = |(number, draws): (usize, Vec<(Unknown, f64)>)| -> Result<Drilling, String> {
        let drawn;
        let config = if priors.entries().is_empty() {
            config
        } else {
            drawn = priors.member(seed, number as u64).map_err(|error| error.to_string())?;
            &drawn.config
        };
        let factor = draws.iter().find(|(unknown, _)| *unknown == Unknown::Weight);
        let weight = weight * factor.map_or(1.0, |(_, factor)| *factor);
        let mut drilling = Drilling::of(config, weight, azimuth).map_err(|error| error.to_string())?;
        for (unknown, value) in draws {
            unknown.set(&mut drilling, value);
        }
        Ok(drilling)
    };
    Ok(draws.into_iter().enumerate().map(tool).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_fill_the_whole_range_and_depend_on_the_seed_alone() {
        let mut drawn = shares(10, 7, 0);
        assert_eq!(drawn, shares(10, 7, 0));
        assert_ne!(drawn, shares(10, 8, 0));
        assert_ne!(drawn, shares(10, 7, 1));
        drawn.sort_by(f64::total_cmp);
        for (part, share) in drawn.iter().enumerate() {
            assert!(
                (0.1 * part as f64..0.1 * (part + 1) as f64).contains(share),
                "{drawn:?}"
            );
        }
    }
}
