//! Bands and chances of a second, as a message.

use super::engine::{Counts, Ensemble};
use super::evidence::channel;
use super::member::Second;
use super::place::{Place, State};
use crate::alarms::AlarmId;
use flexdrill_alarms::Priority;
use flexdrill_calibration::residual::RigQuantity;
use flexdrill_config::Config;
use flexdrill_ensemble::{Band, Chance, LEAST_MEMBERS, effective_number};
use flexdrill_messages::{AlarmChance, Bands, FigureBand};
use flexdrill_motion::HazardKind;
use flexdrill_outputs::figures::OverTools;
use flexdrill_outputs::words::priority_code;
use flexdrill_uncertainty::UncertaintyError;

/// Why there are no bands while members run that were chosen by what is withdrawn.
const MISLED: &str = "the plausible tools were chosen by a sensor that is not believed any more; those of the beginning are \
                      prepared, which takes up to two minutes";

impl Ensemble {
    /// What the members do in the second that ends.
    pub(super) fn message(&mut self) -> Bands {
        let shares = self.weights();
        let counts = Counts {
            members: self.generation.members,
            failed: self.places.iter().filter(|place| place.has_failed()).count() as u32,
            prepared: self.choice.as_ref().map_or(0, |choice| choice.prepared.len() as u32),
            effective: effective_number(&shares),
            renewals: self.renewals,
            why: match self.misled {
                true => MISLED.to_owned(),
                false => self.generation.why.clone(),
            },
        };
        let second = |place: &mut Place| match &mut place.state {
            State::Runs(member) => Some(member.second()),
            _ => None,
        };
        // Those that are prepared begin each second, too: their first one that counts must not have the minute before.
        for prepared in self.choice.iter_mut().flat_map(|choice| &mut choice.prepared) {
            second(&mut prepared.place);
        }
        let seconds: Vec<(f64, Option<Second>)> = shares.into_iter().zip(self.places.iter_mut().map(second)).collect();
        let doubts = RigQuantity::ALL.into_iter();
        let doubts =
            doubts.filter_map(|quantity| Some((channel(quantity).name(), self.trust.doubt(quantity)?.words())));
        let (distrusted, distrusted_why) = doubts.map(|(name, why)| (name.to_owned(), why.to_owned())).unzip();
        Bands {
            distrusted,
            distrusted_why,
            ..message(&counts, &seconds, &self.factors)
        }
    }
}

/// Figures whose factors the profiles of both layers have: the largest force of all stations is the same quantity.
const OF_PROFILES: [&str; 2] = [
    "contact_forces/max_pipe_guide_force",
    "contact_forces/max_guide_wall_force",
];

/// What a normal force can be (N).
const FORCES: [f64; 2] = [0.0, f64::INFINITY];

/// The factors on the bands of a configuration, by [`OverTools::known`]: 1 where it states none.
///
/// # Errors
/// When a factor is given for a figure that has no band.
pub fn band_factors(config: &Config) -> Result<Vec<f64>, UncertaintyError> {
    let known = OverTools::known();
    let mut factors = vec![1.0; known.len()];
    for of in config.ensemble.iter().flat_map(|stated| &stated.band_factors) {
        let Some(index) = known.iter().position(|known| known.name == of.figure) else {
            let nearest = known
                .iter()
                .min_by_key(|known| strsim::levenshtein(&known.name, &of.figure));
            return Err(UncertaintyError::Figure {
                figure: of.figure.clone(),
                nearest: nearest.map_or_else(String::new, |known| known.name.clone()),
            });
        };
        factors[index] = of.factor;
    }
    Ok(factors)
}

/// The message of a second, but for its times. Members are given with their weight; `None` failed. `factors` are those of
/// [`band_factors`].
pub(super) fn message(counts: &Counts, members: &[(f64, Option<Second>)], factors: &[f64]) -> Bands {
    let known = || {
        members
            .iter()
            .filter_map(|(weight, second)| Some((*weight, second.as_ref()?)))
    };
    let band = |factor: f64, range: [f64; 2], value: &dyn Fn(&Second) -> f64| {
        let band = Band::of(known().map(|(weight, second)| (weight, value(second))), factor);
        band.map_or([f64::NAN; 3], |band| band.within(range).quantiles)
    };
    let mut out = Bands {
        members: counts.members,
        failed: counts.failed,
        prepared: counts.prepared,
        effective: counts.effective,
        renewals: counts.renewals,
        no_bands: no_bands(counts),
        any_alarm: f64::NAN,
        any_alarm_upper: 1.0,
        ..Bands::default()
    };
    chances(members, &mut out);
    let Some((_, first)) = known().next().filter(|_| out.no_bands.is_empty()) else {
        return out;
    };
    let figures = OverTools::known().into_iter().enumerate();
    let factor = |index: usize| factors.get(index).copied().unwrap_or(1.0);
    let mut of_profiles = [1.0; 2];
    out.bands = figures
        .map(|(index, figure)| {
            if let Some(layer) = OF_PROFILES.iter().position(|name| *name == figure.name) {
                of_profiles[layer] = factor(index);
            }
            let value = |second: &Second| second.figures.get(index).copied().unwrap_or(f64::NAN);
            let [p5, p50, p95] = band(factor(index), figure.range, &value);
            out.band_factors.push(factor(index));
            FigureBand {
                name: figure.name,
                unit: figure.unit.to_owned(),
                p5,
                p50,
                p95,
            }
        })
        .collect();
    // All members have the stations of the same links.
    out.measured_depth.clone_from(&first.measured_depth);
    for station in 0..first.measured_depth.len() {
        let of = |layer: usize| {
            band(of_profiles[layer], FORCES, &|second| {
                second.peaks[layer].get(station).copied().unwrap_or(f64::NAN)
            })
        };
        let [p5, p50, p95] = of(0);
        out.pipe_guide_force_p5.push(p5);
        out.pipe_guide_force_p50.push(p50);
        out.pipe_guide_force_p95.push(p95);
        let [p5, p50, p95] = of(1);
        out.guide_wall_force_p5.push(p5);
        out.guide_wall_force_p50.push(p50);
        out.guide_wall_force_p95.push(p95);
    }
    out
}

/// Why there are no bands; empty where there are.
fn no_bands(counts: &Counts) -> String {
    if !counts.why.is_empty() {
        return counts.why.clone();
    }
    // Rounding must not cost a member that is there.
    if counts.effective >= LEAST_MEMBERS - 1e-9 {
        return String::new();
    }
    format!(
        "{} plausible tools amount to {:.1} alike, and bands need {LEAST_MEMBERS:.0}: some could not be computed, and are \
         replaced",
        counts.members, counts.effective,
    )
}

/// The chances of all alarms that stand in a member.
fn chances(members: &[(f64, Option<Second>)], out: &mut Bands) {
    let of = |stands: &dyn Fn(&Second) -> bool| {
        let outcomes = members
            .iter()
            .map(|(weight, second)| (*weight, second.as_ref().map(stands)));
        let seen = members
            .iter()
            .filter(|(_, second)| second.as_ref().is_some_and(stands))
            .count() as u32;
        (Chance::of(outcomes), seen)
    };
    let ended = members.iter().filter(|(_, second)| second.is_some()).count() as u32;
    // Those of the motion: poor model quality is of the computation, not of a tool.
    let of_motion = HazardKind::ALL.map(|kind| AlarmId::of_hazard(kind) as usize);
    let (any, _) = of(&|second| {
        of_motion
            .iter()
            .any(|id| second.alarms.get(*id).copied().flatten().is_some())
    });
    out.any_alarm = any.probability;
    [out.any_alarm_lower, out.any_alarm_upper] = any.interval;
    for (index, id) in AlarmId::ALL.into_iter().enumerate() {
        for priority in Priority::ALL {
            let (chance, seen) = of(&|second| second.alarms.get(index).copied().flatten() >= Some(priority));
            if seen == 0 {
                continue;
            }
            out.alarms.push(AlarmChance {
                id: id.id().to_owned(),
                name: id.name().to_owned(),
                priority: priority_code(Some(priority)),
                seen,
                members: ended,
                probability: chance.probability,
                lower: chance.interval[0],
                upper: chance.interval[1],
                time_to_first: f64::NAN,
            });
        }
    }
}
