//! Quantities along the tool: their statistics over the whole recording, by station or joint.

use crate::history::HELD;
use crate::is_quantity;

/// Statistics of one quantity, by station or joint.
#[derive(Debug, Clone, Default)]
pub(crate) struct Envelope {
    points: Vec<Statistics>,
    /// Time of the last message (s).
    last: Option<f64>,
}

/// Statistics of one quantity at one station or joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Statistics {
    pub min: f64,
    pub max: f64,
    /// Time of the largest magnitude (s from the beginning).
    pub when: f64,
    /// Sum of values times the time since the message before (value times s).
    area: f64,
    /// The same of squares.
    squares: f64,
    /// Sum of these times (s).
    weight: f64,
    /// The first value, which has no time before it.
    first: f64,
    count: u64,
}

const NOTHING: Statistics = Statistics {
    min: f64::INFINITY,
    max: f64::NEG_INFINITY,
    when: 0.0,
    area: 0.0,
    squares: 0.0,
    weight: 0.0,
    first: 0.0,
    count: 0,
};

impl Statistics {
    fn push(&mut self, time: f64, weight: f64, value: f64) {
        if !is_quantity(value) {
            return;
        }
        if self.count == 0 {
            self.first = value;
        }
        if self.count == 0 || value.abs() > self.size() {
            self.when = time;
        }
        self.min = self.min.min(value);
        self.max = self.max.max(value);
        self.area += weight * value;
        self.squares += weight * value * value;
        self.weight += weight;
        self.count += 1;
    }

    /// Largest magnitude.
    pub(crate) fn size(&self) -> f64 {
        self.max.abs().max(self.min.abs())
    }

    /// Mean over time.
    pub(crate) fn mean(&self) -> f64 {
        if self.weight > 0.0 {
            self.area / self.weight
        } else {
            self.first
        }
    }

    /// Root mean square over time.
    pub(crate) fn rms(&self) -> f64 {
        if self.weight > 0.0 {
            (self.squares / self.weight).sqrt()
        } else {
            self.first.abs()
        }
    }
}

impl Envelope {
    /// Adds the values of an instant, one per station or joint. They are weighted with the time since the message
    /// before, because the RMS values in a message cover that time. The caller ensures that the stations never change.
    pub(crate) fn push(&mut self, time: f64, values: impl IntoIterator<Item = f64>) {
        let weight = self.last.map_or(0.0, |last| (time - last).clamp(0.0, HELD));
        self.last = Some(time);
        for (index, value) in values.into_iter().enumerate() {
            if index == self.points.len() {
                self.points.push(NOTHING);
            }
            self.points[index].push(time, weight, value);
        }
    }

    /// The statistics at an index; `None` without a finite value.
    pub(crate) fn at(&self, index: usize) -> Option<&Statistics> {
        self.points.get(index).filter(|statistics| statistics.count > 0)
    }

    /// The curve of `of` times `factor` over `x`, one point per index.
    pub(crate) fn curve(&self, x: &[f64], factor: f64, of: impl Fn(&Statistics) -> f64) -> Vec<(f64, f64)> {
        x.iter()
            .enumerate()
            .filter_map(|(index, x)| Some((*x, factor * of(self.at(index)?))))
            .filter(|(x, y)| is_quantity(*x) && is_quantity(*y))
            .collect()
    }

    /// The outline of the band between least and largest value.
    pub(crate) fn outline(&self, x: &[f64], factor: f64) -> Vec<(f64, f64)> {
        let mut outline = self.curve(x, factor, |s| s.max);
        outline.extend(self.curve(x, factor, |s| s.min).into_iter().rev());
        outline
    }

    /// The indices with the largest magnitudes, at least `apart` from each other along `x`, the largest first.
    pub(crate) fn largest(&self, x: &[f64], apart: f64, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.points.len().min(x.len()))
            .filter(|index| self.at(*index).is_some_and(|s| s.size() > 0.0))
            .collect();
        order.sort_by(|a, b| self.points[*b].size().total_cmp(&self.points[*a].size()));
        let mut found: Vec<usize> = Vec::new();
        for index in order {
            if found.len() < count && found.iter().all(|other| (x[*other] - x[index]).abs() >= apart) {
                found.push(index);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_keep_their_time() {
        let mut envelope = Envelope::default();
        envelope.push(0.0, [1.0, -2.0, f64::NAN]);
        envelope.push(1.0, [3.0, -6.0, f64::NAN]);
        envelope.push(2.0, [2.0, 1.0, f64::NAN]);
        let second = envelope.at(1).unwrap();
        assert_eq!((second.min, second.max, second.when), (-6.0, 1.0, 1.0));
        // Each value has the weight of the second before it; the first has none.
        assert!((envelope.at(0).unwrap().mean() - 2.5).abs() < 1e-15);
        assert!((envelope.at(0).unwrap().rms() - (13.0_f64 / 2.0).sqrt()).abs() < 1e-15);
        assert!(envelope.at(2).is_none());
        assert_eq!(envelope.largest(&[0.0, 0.1, 0.2], 0.0, 3), [1, 0]);
        assert_eq!(envelope.largest(&[0.0, 0.1, 0.2], 0.15, 3), [1]);
    }
}
