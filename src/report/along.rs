//! Quantities along the tool: what they came to at each place over the whole recording.

use super::history::HELD;
use super::is_quantity;

/// One quantity at each place.
#[derive(Debug, Clone, Default)]
pub(super) struct Envelope {
    places: Vec<Statistics>,
    last: Option<f64>,
}

/// One quantity at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Statistics {
    pub min: f64,
    pub max: f64,
    /// When it was largest in size (s from the beginning).
    pub when: f64,
    /// Of values times the time since the message before (s).
    area: f64,
    squares: f64,
    weight: f64,
    /// Of the first value, which has no time.
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

    /// Largest size.
    pub(super) fn size(&self) -> f64 {
        self.max.abs().max(self.min.abs())
    }

    /// Over time.
    pub(super) fn mean(&self) -> f64 {
        if self.weight > 0.0 {
            self.area / self.weight
        } else {
            self.first
        }
    }

    /// Root mean square over time.
    pub(super) fn rms(&self) -> f64 {
        if self.weight > 0.0 {
            (self.squares / self.weight).sqrt()
        } else {
            self.first.abs()
        }
    }
}

impl Envelope {
    /// Takes the values of an instant, one per place; they count for the time since the message before, which is what a
    /// root mean square of a message covers. Its caller has seen to it that the places are the same each time.
    pub(super) fn push(&mut self, time: f64, values: impl IntoIterator<Item = f64>) {
        let weight = self.last.map_or(0.0, |last| (time - last).clamp(0.0, HELD));
        self.last = Some(time);
        for (index, value) in values.into_iter().enumerate() {
            if index == self.places.len() {
                self.places.push(NOTHING);
            }
            self.places[index].push(time, weight, value);
        }
    }

    /// Place by place; `None` where nothing finite was said.
    pub(super) fn at(&self, place: usize) -> Option<&Statistics> {
        self.places.get(place).filter(|statistics| statistics.count > 0)
    }

    /// Points over `x`, one per place: `of` the statistics times `factor`.
    pub(super) fn curve(&self, x: &[f64], factor: f64, of: impl Fn(&Statistics) -> f64) -> Vec<(f64, f64)> {
        x.iter()
            .enumerate()
            .filter_map(|(place, x)| Some((*x, factor * of(self.at(place)?))))
            .filter(|(x, y)| is_quantity(*x) && is_quantity(*y))
            .collect()
    }

    /// What lies between least and largest, as an outline.
    pub(super) fn outline(&self, x: &[f64], factor: f64) -> Vec<(f64, f64)> {
        let mut outline = self.curve(x, factor, |s| s.max);
        outline.extend(self.curve(x, factor, |s| s.min).into_iter().rev());
        outline
    }

    /// The places with the largest size, at least `apart` from each other along `x`, the largest first.
    pub(super) fn largest(&self, x: &[f64], apart: f64, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.places.len().min(x.len()))
            .filter(|place| self.at(*place).is_some_and(|s| s.size() > 0.0))
            .collect();
        order.sort_by(|a, b| self.places[*b].size().total_cmp(&self.places[*a].size()));
        let mut found: Vec<usize> = Vec::new();
        for place in order {
            if found.len() < count && found.iter().all(|other| (x[*other] - x[place]).abs() >= apart) {
                found.push(place);
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_keeps_its_extremes_and_when() {
        let mut envelope = Envelope::default();
        envelope.push(0.0, [1.0, -2.0, f64::NAN]);
        envelope.push(1.0, [3.0, -6.0, f64::NAN]);
        envelope.push(2.0, [2.0, 1.0, f64::NAN]);
        let second = envelope.at(1).unwrap();
        assert_eq!((second.min, second.max, second.when), (-6.0, 1.0, 1.0));
        // Each value counts for the second before it; the first has none.
        assert!((envelope.at(0).unwrap().mean() - 2.5).abs() < 1e-15);
        assert!((envelope.at(0).unwrap().rms() - (13.0_f64 / 2.0).sqrt()).abs() < 1e-15);
        assert!(envelope.at(2).is_none());
        assert_eq!(envelope.largest(&[0.0, 0.1, 0.2], 0.0, 3), [1, 0]);
        assert_eq!(envelope.largest(&[0.0, 0.1, 0.2], 0.15, 3), [1]);
    }
}
