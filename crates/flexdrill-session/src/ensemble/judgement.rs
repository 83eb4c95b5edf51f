//! What the members say of the rig: the ranges that the alarm `rig_disagrees` is judged by, and the friction that
//! `calibration.follow` moves to.
//!
//! The range of all tools must not follow what is measured. Where members are replaced by others that fit, the outermost of
//! those that were drawn first run on: they show what all of them would do at another speed and weight, too.

use std::sync::Arc;

use super::engine::Ensemble;
use super::place::Place;
use crate::residuals::{Friction, Judgement};
use flexdrill_calibration::plausible::{Compared, Readings};
use flexdrill_calibration::residual::{Residual, RigQuantity};
use flexdrill_config::Config;
use flexdrill_ensemble::{Band, LEAST_MEMBERS};
use flexdrill_uncertainty::Priors;

/// The quantiles of 5 and 95 % of friction before anything is measured, as [`Friction::prior`]: each distribution of a friction
/// at its own quantiles, which bound what their mean can be.
pub(super) fn prior_of_friction(config: &Config, priors: &Priors) -> [f64; 2] {
    let is_friction = |name: &str| {
        let of_layer = name.starts_with("contact.") && name.contains(".friction_");
        of_layer || name == "calibration.friction_factor"
    };
    let at = |p: f64| {
        let draws: Vec<f64> = (priors.entries().iter())
            .map(|entry| {
                let has_friction = entry.keys().iter().any(|key| is_friction(&key.name));
                entry.draw(if has_friction { p } else { 0.5 })
            })
            .collect();
        // Medians that exclude each other leave the configured value, which nothing moves away from.
        let drawn = priors.config(&draws).ok();
        drawn.map_or(config.calibration.friction_factor, |drawn| factor(config, &drawn))
    };
    [0.05, 0.95].map(at)
}

/// The factor on the friction of a configuration that gives a drawn one that of its layers, as a mean.
fn factor(config: &Config, drawn: &Config) -> f64 {
    let around = |config: &Config| {
        let live = config.live();
        [live.inner_friction[0], live.outer_friction[0]]
    };
    let ratios = around(drawn).into_iter().zip(around(config));
    // A layer without friction has none by any factor.
    let ratios: Vec<f64> = ratios
        .filter(|(_, of)| *of > 0.0)
        .map(|(drawn, of)| drawn / of)
        .collect();
    match ratios.is_empty() {
        true => config.calibration.friction_factor,
        false => config.calibration.friction_factor * ratios.iter().sum::<f64>() / ratios.len() as f64,
    }
}

impl Ensemble {
    /// A configuration without the friction that follows the members: it must not move them.
    pub(super) fn unfollowed(&self, config: Arc<Config>) -> Arc<Config> {
        let begun = ("calibration.friction_factor", self.config.calibration.friction_factor);
        let held = (config.calibration.follow).then(|| config.with_live_values("the plausible tools", [begun]).ok());
        held.flatten().map_or(config, Arc::new)
    }

    /// What the members say of the rig now.
    pub(super) fn judgement(&self) -> Judgement {
        let shares = self.weights();
        let running = self.places.iter().filter(|place| place.member().is_some()).count();
        if (running as f64) < LEAST_MEMBERS {
            return Judgement::default();
        }
        let compared = Compared {
            readings: RigQuantity::ALL.map(|quantity| self.readings(quantity, &shares)),
            drilling: self.newest.is_some_and(|newest| newest.drilling),
            tools: self.generation.members,
        };
        Judgement {
            compared: Some(compared),
            friction: self.friction_by(&shares),
        }
    }

    /// A quantity as it is measured and as the members have it; `None` while no member's means are filled.
    fn readings(&self, quantity: RigQuantity, shares: &[f64]) -> Option<Readings> {
        let hours = self.at as f64 * self.config.solver.time_step / 3600.0;
        let mean = |place: &Place| place.member()?.windows.mean(&self.errors, quantity, hours);
        let known = self.places.iter().chain(&self.outermost);
        let known: Vec<(&Place, Residual)> = known.filter_map(|place| Some((place, mean(place)?))).collect();
        // Members that began later have means of fewer seconds; the first has the longest.
        let (_, first) = known.iter().max_by_key(|(place, _)| place.first)?;
        let firsts = known.iter().filter(|(place, _)| place.first);
        let all = firsts.map(|(_, of)| of.predicted).fold(None, |range, reading| {
            let [low, high] = range.unwrap_or([reading; 2]);
            Some([reading.min(low), reading.max(high)])
        });
        let weighted = self.places.iter().zip(shares);
        let weighted = weighted.filter_map(|(place, share)| Some((*share, mean(place)?.predicted)));
        Some(Readings {
            measured: first.measured,
            all,
            fitting: Band::of(weighted, 1.0).map(|band| [band.quantiles[0], band.quantiles[2]]),
            error: known.iter().map(|(_, of)| of.error).sum::<f64>() / known.len() as f64,
            scatter: first.scatter,
        })
    }

    fn friction_by(&self, shares: &[f64]) -> Option<Friction> {
        if self.misled {
            return None;
        }
        let drawn = self.places.iter().zip(shares);
        let factors: Vec<(f64, f64)> = drawn
            .filter(|(_, share)| **share > 0.0)
            .filter_map(|(place, share)| Some((*share, factor(&self.config, &place.drawn.as_ref().ok()?.config))))
            .collect();
        let band = Band::of(factors.iter().copied(), 1.0)?.quantiles;
        let sum: f64 = factors.iter().map(|(share, _)| share).sum();
        Some(Friction {
            mean: factors.iter().map(|(share, factor)| share * factor).sum::<f64>() / sum,
            band: [band[0], band[2]],
            prior: self.prior_friction,
        })
    }

    /// Keeps those of the replaced members whose readings are the outermost of all that were drawn first, per quantity and
    /// side, and lets those run on that were kept before and are outermost.
    pub(super) fn keep_outermost(&mut self, replaced: Vec<Place>) {
        let mut candidates: Vec<Place> = std::mem::take(&mut self.outermost);
        candidates.extend(replaced);
        let reading = |place: &Place, quantity: RigQuantity, side: f64| {
            let member = place.member().filter(|_| place.first)?;
            Some(side * member.windows.newest(quantity)).filter(|reading| reading.is_finite())
        };
        let mut keeps = vec![false; candidates.len()];
        for quantity in RigQuantity::ALL {
            for side in [-1.0, 1.0] {
                let staying = self.places.iter().filter_map(|place| reading(place, quantity, side));
                let staying = staying.fold(f64::NEG_INFINITY, f64::max);
                let of_candidates = candidates.iter().enumerate();
                let best = of_candidates
                    .filter_map(|(index, place)| Some((index, reading(place, quantity, side)?)))
                    .max_by(|a, b| a.1.total_cmp(&b.1));
                if let Some((index, reading)) = best
                    && reading > staying
                {
                    keeps[index] = true;
                }
            }
        }
        let kept = candidates.into_iter().zip(keeps).filter(|(_, keeps)| *keeps);
        self.outermost = kept.map(|(place, _)| place).collect();
    }
}
