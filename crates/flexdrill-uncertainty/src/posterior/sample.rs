//! Draws from a sample, as the scores that [`crate::Member`] has.
//!
//! A value of the sample has the score z = Phi^-1(F(value)), with the distribution function F of its key's prior. In these
//! scores the prior is standard normal, and a member of the sample is a point. A draw is near such a point,
//!
//! ```text
//! z' = a z + (1 - a) mean + h R xi,   R R' = V,   a = sqrt(1 - h^2),
//! ```
//!
//! which keeps mean and covariance V of the weighted sample (Liu and West 2001), so that no two draws are equal. Keys that the
//! sample leaves out have their prior's draws, given those in it: with the scores z of a draw from the prior and the
//! correlations C, z + C_.S C_SS^-1 (z'_S - z_S) is a draw from that conditional distribution (Matheron's rule).

use nalgebra::{DMatrix, DVector};

use super::error::PosteriorError;
use super::{Posterior, Weighted};
use crate::law::{Law, standard_normal, standard_quantile};
use crate::priors::Priors;
use crate::random::Random;
use crate::sensors::Channel;
use flexdrill_config::Form;
use flexdrill_config::checker::number;
use flexdrill_core::units::kn_to_n;

/// Scatter of a draw about a member of the sample, the `h` of Liu and West: draws differ, and what the sample has of shape
/// beyond its covariance remains.
const SCATTER: f64 = 0.1;
/// Largest score, beyond which a share of 1 has no digits left: 1e-12 of a distribution lie beyond it.
const FARTHEST: f64 = 7.0;
/// Keys with one draw have one draw in the sample, to its nine digits.
const SAME: f64 = 1e-6;

/// What a column decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    /// The score of an entry.
    Entry(usize),
    /// The score of the factor (0) or of the tare (1) of a sensor.
    Sensor(usize, usize),
}

/// A sample in scores.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    /// By column.
    places: Vec<Place>,
    members: Vec<DVector<f64>>,
    /// Sums of the weights up to each member, over the sum of all.
    cumulated: Vec<f64>,
    mean: DVector<f64>,
    /// A root of the covariance.
    root: DMatrix<f64>,
    /// What a change of the sample's scores changes of all entries: a row per entry, a column per column of an entry.
    gain: DMatrix<f64>,
}

/// A column with what its values are drawn by.
struct Column<'a> {
    place: Place,
    law: Law,
    form: Form,
    configured: f64,
    /// SI units per unit of the key.
    factor: f64,
    key: &'a str,
    unit: &'static str,
    index: usize,
}

impl Column<'_> {
    /// The score of a value, beyond [`FARTHEST`] where the distribution has no such value; not a number for a factor on 0.
    fn score(&self, value: f64) -> f64 {
        let draw = self.factor * self.form.draw(value, self.configured);
        if !draw.is_finite() {
            return f64::NAN;
        }
        standard_quantile(self.law.share(draw).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON))
    }

    /// The smallest and the largest value with a score.
    fn ends(&self) -> [f64; 2] {
        let mut ends = [-FARTHEST, FARTHEST].map(|score| {
            let draw = self.law.quantile(standard_normal(score)) / self.factor;
            self.form.value(draw, self.configured)
        });
        // A factor on a negative value turns them round.
        ends.sort_by(f64::total_cmp);
        ends
    }
}

impl Sample {
    /// The sample in the scores of these priors. With `whole` each column must have a distribution that has its values;
    /// otherwise columns without one are left out, and values are held at its ends.
    pub(crate) fn of(priors: &Priors, posterior: &Posterior, whole: bool) -> Result<Self, PosteriorError> {
        // Keys of one entry have one draw, so that the sample must have the same for all of them.
        let mut columns: Vec<Column> = Vec::new();
        for (index, key) in posterior.keys().iter().enumerate() {
            let Some(column) = column(priors, key, index) else {
                if whole {
                    return Err(no_prior(posterior, key, index));
                }
                continue;
            };
            match columns.iter().find(|known| known.place == column.place) {
                None => columns.push(column),
                Some(first) if whole => same_draws(posterior, first, &column)?,
                Some(_) => {}
            }
        }
        let mut members = Vec::with_capacity(posterior.members().len());
        for member in posterior.members() {
            let mut scores = DVector::zeros(columns.len());
            for (score, column) in scores.iter_mut().zip(&columns) {
                let found = column.score(member.values[column.index]);
                let has_it = found.abs() <= FARTHEST;
                if whole && !has_it {
                    return Err(beyond(posterior, member, column));
                }
                *score = if found.is_nan() {
                    0.0
                } else {
                    found.clamp(-FARTHEST, FARTHEST)
                };
            }
            members.push(scores);
        }
        // The scatter about a member needs the spread of all, by their weights.
        let shares = shares(posterior.members());
        let (mean, root) = spread(&members, &shares);
        let cumulated = shares.iter().scan(0.0, |sum, share| {
            *sum += share;
            Some(*sum)
        });
        let places: Vec<Place> = columns.iter().map(|column| column.place).collect();
        Ok(Self {
            cumulated: cumulated.collect(),
            gain: gain(priors.correlation_factor(), &entries(&places)),
            places,
            members,
            mean,
            root,
        })
    }

    /// Whether nothing is drawn from it.
    pub(crate) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The score below which a share of the sample lies, for an entry that the sample decides; none for another.
    pub(crate) fn score(&self, entry: usize, share: f64) -> Option<f64> {
        let column = self.places.iter().position(|place| *place == Place::Entry(entry))?;
        let before = self
            .cumulated
            .iter()
            .scan(0.0, |before, sum| Some(sum - std::mem::replace(before, *sum)));
        let scores = self.members.iter().map(|member| member[column]);
        let mut weighted: Vec<(f64, f64)> = scores.zip(before).collect();
        weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut sum = 0.0;
        let found = weighted.iter().find(|(_, weight)| {
            sum += weight;
            sum >= share
        });
        found.or(weighted.last()).map(|(score, _)| *score)
    }

    /// Makes `scores`, a draw from the prior, one from the sample: of the member below which a share of the weights lies.
    pub(crate) fn draw(&self, factor: &DMatrix<f64>, scores: &mut [f64], share: f64, random: &mut Random) {
        let at = self.cumulated.partition_point(|sum| *sum <= share);
        let Some(member) = self.members.get(at).or(self.members.last()) else {
            return;
        };
        let shrink = (1.0 - SCATTER * SCATTER).sqrt();
        let normal = DVector::from_fn(self.places.len(), |_, _| standard_quantile(random.uniform()));
        let wanted = member * shrink + &self.mean * (1.0 - shrink) + &self.root * normal * SCATTER;
        let count = factor.nrows();
        let mut correlated = factor * DVector::from_column_slice(&scores[..count]);
        let known = entries(&self.places);
        let change = DVector::from_iterator(
            known.len(),
            known.iter().map(|(column, entry)| wanted[*column] - correlated[*entry]),
        );
        correlated += &self.gain * change;
        // The factor of a positive definite matrix has no zero on its diagonal.
        if let Some(independent) = factor.solve_lower_triangular(&correlated) {
            scores[..count].copy_from_slice(independent.as_slice());
        }
        for (column, place) in self.places.iter().enumerate() {
            if let Place::Sensor(sensor, part) = place {
                scores[count + 2 * sensor + part] = wanted[column];
            }
        }
    }
}

/// The columns that are entries: column and entry.
fn entries(places: &[Place]) -> Vec<(usize, usize)> {
    let of = |(column, place): (usize, &Place)| match place {
        Place::Entry(entry) => Some((column, *entry)),
        Place::Sensor(..) => None,
    };
    places.iter().enumerate().filter_map(of).collect()
}

/// What the values of a key are drawn by; `None` where they have no distribution.
fn column<'a>(priors: &Priors, key: &'a str, index: usize) -> Option<Column<'a>> {
    let of_entry = priors.entries().iter().enumerate().find_map(|(at, entry)| {
        let known = entry.keys().iter().find(|known| known.name == key)?;
        Some(Column {
            place: Place::Entry(at),
            law: entry.law().clone(),
            form: entry.form,
            configured: known.configured,
            factor: 1.0,
            key,
            unit: known.unit,
            index,
        })
    });
    of_entry.or_else(|| {
        let (channel, part, factor, unit) = of_a_sensor(key)?;
        let at = priors.sensors().iter().position(|sensor| sensor.channel == channel)?;
        let sensor = &priors.sensors()[at];
        Some(Column {
            place: Place::Sensor(at, part),
            law: if part == 0 { sensor.factor() } else { sensor.tare() }?,
            form: Form::Value,
            configured: 0.0,
            factor,
            key,
            unit,
            index,
        })
    })
}

/// The sensor that a key is of, whether it is the factor (0) or the tare (1), and the SI units per unit of the key with its
/// name.
fn of_a_sensor(key: &str) -> Option<(Channel, usize, f64, &'static str)> {
    // Tares of what is compared with the twin in every configuration are in `calibration`.
    match key {
        "calibration.torque_tare_nm" => return Some((Channel::SurfaceTorque, 1, 1.0, "N m")),
        "calibration.hook_load_tare_kn" => return Some((Channel::HookLoad, 1, kn_to_n(1.0), "kN")),
        _ => {}
    }
    let (name, part) = key.strip_prefix("uncertainty.sensors.")?.split_once('.')?;
    let channel = Channel::ALL.into_iter().find(|channel| channel.name() == name)?;
    match part {
        "factor" => Some((channel, 0, 1.0, "")),
        "tare_kn" => Some((channel, 1, kn_to_n(1.0), "kN")),
        "tare_nm" => Some((channel, 1, 1.0, "N m")),
        _ => None,
    }
}

/// Weights over their sum.
fn shares(members: &[Weighted]) -> Vec<f64> {
    // Of the largest one first, since a sum of weights may overflow.
    let most = members.iter().map(|member| member.weight).fold(0.0, f64::max);
    let sum: f64 = members.iter().map(|member| member.weight / most).sum();
    members.iter().map(|member| member.weight / most / sum).collect()
}

/// Mean of weighted members, and a root of their covariance.
fn spread(members: &[DVector<f64>], shares: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
    let size = members.first().map_or(0, DVector::len);
    let mut mean = DVector::zeros(size);
    for (member, share) in members.iter().zip(shares) {
        mean += member * *share;
    }
    let mut covariance = DMatrix::zeros(size, size);
    for (member, share) in members.iter().zip(shares) {
        let from = member - &mean;
        covariance += &from * from.transpose() * *share;
    }
    // A matrix without rows has no decomposition.
    if size == 0 {
        return (mean, covariance);
    }
    // A key that is the same in all members leaves a direction without variance, which Cholesky's root does not have.
    let eigen = covariance.symmetric_eigen();
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    (mean, eigen.eigenvectors * DMatrix::from_diagonal(&roots))
}

/// C_.S C_SS^-1 of the correlations C = factor factor', for the entries S of the columns.
fn gain(factor: &DMatrix<f64>, known: &[(usize, usize)]) -> DMatrix<f64> {
    let all = factor * factor.transpose();
    let of_known = DMatrix::from_fn(all.nrows(), known.len(), |row, column| all[(row, known[column].1)]);
    let between = DMatrix::from_fn(known.len(), known.len(), |row, column| {
        all[(known[row].1, known[column].1)]
    });
    // A part of a positive definite matrix is one.
    match between.cholesky() {
        Some(root) => root.solve(&of_known.transpose()).transpose(),
        None => DMatrix::zeros(all.nrows(), known.len()),
    }
}

/// Refuses members in which two keys with one draw have two.
fn same_draws(posterior: &Posterior, first: &Column, other: &Column) -> Result<(), PosteriorError> {
    for member in posterior.members() {
        let draw = |column: &Column| column.form.draw(member.values[column.index], column.configured);
        let (wanted, found) = (draw(first), draw(other));
        if (found - wanted).abs() > SAME * wanted.abs().max(found.abs()) {
            let value = other.form.value(wanted, other.configured);
            return Err(PosteriorError::Value {
                file: posterior.file().to_owned(),
                line: member.line,
                key: other.key.to_owned(),
                value: member.values[other.index],
                unit: other.unit,
                rule: format!("{} (it has one draw with {})", number(value), first.key),
            });
        }
    }
    Ok(())
}

fn no_prior(posterior: &Posterior, key: &str, index: usize) -> PosteriorError {
    let mut values: Vec<(f64, f64)> = (posterior.members().iter().zip(shares(posterior.members())))
        .map(|(member, share)| (member.values[index], share))
        .collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let quantile = |p: f64| {
        let mut sum = 0.0;
        let found = values.iter().find(|(_, share)| {
            sum += share;
            sum >= p
        });
        found.map_or_else(|| "unknown".to_owned(), |(value, _)| number(*value))
    };
    PosteriorError::NoPrior {
        file: posterior.file().to_owned(),
        key: key.to_owned(),
        low: quantile(0.05),
        high: quantile(0.95),
    }
}

fn beyond(posterior: &Posterior, member: &Weighted, column: &Column) -> PosteriorError {
    // Six digits, of a bound that is far outside.
    let [low, high] = column
        .ends()
        .map(|end| number(format!("{end:.5e}").parse().unwrap_or(end)));
    PosteriorError::Value {
        file: posterior.file().to_owned(),
        line: member.line,
        key: column.key.to_owned(),
        value: member.values[column.index],
        unit: column.unit,
        rule: format!("from {low} to {high} (its prior has no values beyond; state a wider one)"),
    }
}
