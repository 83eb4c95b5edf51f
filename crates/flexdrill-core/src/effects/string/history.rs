//! Waves that have entered the pieces of a string, kept as long as they travel.
//!
//! A row holds every wave at one instant. Steps have different sizes, so a wave between two rows is interpolated by the
//! cubic through the four nearest rows. A straight line would damp a wave of angular frequency w in rows h apart by
//! (w h)^2 / 8 per reading.

use serde::{Deserialize, Serialize};

/// Rows that may be taken back: those of one step, in parts of at least an eighth.
const MARGIN: usize = 16;

/// Rows of the constant waves before the start.
const BEGINNING: usize = 5;
/// Shortest interval next to the one that is interpolated, relative to it: beyond a shorter one a cubic magnifies rounding,
/// and a straight line is read.
const LEAST_RATIO: f64 = 0.2;

/// A ring of rows, newest last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Waves per row.
    channels: usize,
    /// Least time between rows (s). A row that follows closer replaces the one before.
    spacing: f64,
    /// Rows written since the start, of which the ring holds the last.
    count: usize,
    /// Instant of each row (s).
    times: Vec<f64>,
    /// Waves (m/s, rad/s), row by row.
    values: Vec<f64>,
    /// Integral of each wave's square from the start to the row, by the trapezoid rule.
    squares: Vec<f64>,
}

/// A row and how far it was written, to go back to.
#[derive(Debug, Clone)]
pub struct Mark {
    count: usize,
    time: f64,
    values: Vec<f64>,
    squares: Vec<f64>,
}

/// Where an instant lies between the rows: the first of four, and their weights.
#[derive(Debug, Clone, Copy)]
pub struct Reading {
    first: usize,
    weights: [f64; 4],
    /// The row before the instant, and how far the instant is on the way to the next row (0 to 1).
    before: usize,
    part: f64,
}

impl History {
    /// Room for `channels` waves over `delay` (s), in rows at least `spacing` (s) apart.
    pub fn new(channels: usize, delay: f64, spacing: f64) -> Self {
        let rows = (delay / spacing).ceil() as usize + 2 * MARGIN;
        let mut history = Self {
            channels,
            spacing,
            count: 0,
            times: vec![0.0; rows],
            values: vec![0.0; rows * channels],
            squares: vec![0.0; rows * channels],
        };
        history.begin(0.0, delay, &vec![0.0; channels]);
        history
    }

    /// Begins at `time` (s) with waves that have been constant for longer than `delay` (s).
    pub fn begin(&mut self, time: f64, delay: f64, waves: &[f64]) {
        self.count = BEGINNING;
        for row in 0..BEGINNING {
            // The last rows are near each other, so that no cubic reaches from long ago into the motion.
            let steps = (BEGINNING - 1 - row) as f64;
            let long_ago = if row == 0 { 2.0 * delay } else { 0.0 };
            let before = steps * self.spacing + long_ago;
            self.times[row] = time - before;
            for (channel, &wave) in waves.iter().enumerate() {
                self.values[row * self.channels + channel] = wave;
                self.squares[row * self.channels + channel] = -before * wave * wave;
            }
        }
    }

    fn rows(&self) -> usize {
        self.times.len()
    }

    /// Instant of the newest row (s).
    pub fn newest(&self) -> f64 {
        self.times[(self.count - 1) % self.rows()]
    }

    /// The waves of the newest row.
    pub fn last(&self) -> &[f64] {
        let at = (self.count - 1) % self.rows() * self.channels;
        &self.values[at..at + self.channels]
    }

    /// Adds the waves at `time` (s), after the newest row.
    pub fn record(&mut self, time: f64, waves: &[f64]) {
        let rows = self.rows();
        let [before, last] = [self.count - 2, self.count - 1];
        // A row nearer than the spacing to the one before is replaced, so that the newest row is always the present.
        let close = self.times[last % rows] - self.times[before % rows] < 0.99 * self.spacing;
        let (from, to) = if close { (before, last) } else { (last, self.count) };
        let (from, at) = (from % rows, to % rows);
        let interval = time - self.times[from];
        self.times[at] = time;
        for (channel, &wave) in waves.iter().enumerate() {
            let (old, new) = (from * self.channels + channel, at * self.channels + channel);
            let mean = 0.5 * (self.values[old] * self.values[old] + wave * wave);
            self.squares[new] = self.squares[old] + interval * mean;
            self.values[new] = wave;
        }
        self.count = to + 1;
    }

    /// Where `time` (s) lies, which is between the oldest row and the newest.
    pub fn at(&self, time: f64) -> Reading {
        let rows = self.rows();
        let oldest = self.count.saturating_sub(rows - MARGIN);
        let time_of = |row: usize| self.times[row % rows];
        // The first row after the instant.
        let (mut low, mut high) = (oldest + 1, self.count - 1);
        while low < high {
            let middle = usize::midpoint(low, high);
            if time_of(middle) > time {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        let before = low - 1;
        let first = before.saturating_sub(1).clamp(oldest, self.count - 4);
        let nodes: [f64; 4] = std::array::from_fn(|k| time_of(first + k));
        let [t0, t1] = [time_of(before), time_of(before + 1)];
        let part = (time - t0) / (t1 - t0);
        let shortest = (nodes[1] - nodes[0]).min(nodes[3] - nodes[2]).min(nodes[2] - nodes[1]);
        let weights = if shortest >= LEAST_RATIO * (t1 - t0) {
            std::array::from_fn(|k| {
                let others = (0..4).filter(|&l| l != k);
                others.fold(1.0, |product, l| product * ((time - nodes[l]) / (nodes[k] - nodes[l])))
            })
        } else {
            let mut weights = [0.0; 4];
            (weights[before - first], weights[before - first + 1]) = (1.0 - part, part);
            weights
        };
        Reading {
            first,
            weights,
            before,
            part,
        }
    }

    /// Wave of `channel` at a reading.
    pub fn wave(&self, reading: &Reading, channel: usize) -> f64 {
        let rows = self.rows();
        (0..4)
            .map(|k| reading.weights[k] * self.values[(reading.first + k) % rows * self.channels + channel])
            .sum()
    }

    /// Integral of the wave's square from a reading to the newest row (m2/s, rad2/s): its square is linear between rows.
    pub fn square_since(&self, reading: &Reading, channel: usize) -> f64 {
        let rows = self.rows();
        let of = |row: usize| row % rows * self.channels + channel;
        let (old, new) = (of(reading.before), of(reading.before + 1));
        let interval = self.times[(reading.before + 1) % rows] - self.times[reading.before % rows];
        let (a, b) = (self.values[old] * self.values[old], self.values[new] * self.values[new]);
        let part = reading.part;
        let integral = self.squares[old] + interval * part * (a + 0.5 * part * (b - a));
        self.squares[of(self.count - 1)] - integral
    }

    /// Room for a mark.
    pub fn new_mark(&self) -> Mark {
        Mark {
            count: 0,
            time: 0.0,
            values: vec![0.0; self.channels],
            squares: vec![0.0; self.channels],
        }
    }

    /// Marks the newest row.
    pub fn mark(&self, mark: &mut Mark) {
        let row = (self.count - 1) % self.rows();
        (mark.count, mark.time) = (self.count, self.times[row]);
        let channels = row * self.channels..(row + 1) * self.channels;
        mark.values.copy_from_slice(&self.values[channels.clone()]);
        mark.squares.copy_from_slice(&self.squares[channels]);
    }

    /// Goes back to a mark of the present step.
    pub fn rewind(&mut self, mark: &Mark) {
        let row = (mark.count - 1) % self.rows();
        (self.count, self.times[row]) = (mark.count, mark.time);
        let channels = row * self.channels..(row + 1) * self.channels;
        self.values[channels.clone()].copy_from_slice(&mark.values);
        self.squares[channels].copy_from_slice(&mark.squares);
    }

    /// Whether it has the same sizes as `other`.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, other: &Self) -> bool {
        self.channels == other.channels
            && self.times.len() == other.times.len()
            && self.values.len() == other.values.len()
            && self.squares.len() == other.squares.len()
            && self.count >= BEGINNING
    }

    /// Takes another history's rows without allocating.
    #[cfg(feature = "checkpoints")]
    pub fn copy_from(&mut self, other: &Self) {
        self.count = other.count;
        self.times.copy_from_slice(&other.times);
        self.values.copy_from_slice(&other.values);
        self.squares.copy_from_slice(&other.squares);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_read_exactly_between_uneven_rows() {
        let mut history = History::new(1, 0.02, 1e-3);
        let cubic = |t: f64| 1.0 + t * (2.0 + t * (-3.0 + 40.0 * t));
        let mut t = 0.0;
        for k in 0..400 {
            t += if k % 3 == 0 { 2e-3 } else { 1e-3 };
            history.record(t, &[cubic(t)]);
        }
        for k in 1..100 {
            let at = t - 0.02 * f64::from(k) / 100.0;
            let got = history.wave(&history.at(at), 0);
            // Rounding of four products of numbers up to the cubic's value.
            assert!((got - cubic(at)).abs() < 1e-12 * cubic(at).abs(), "{at}: {got}");
        }
    }

    #[test]
    fn rows_that_follow_closely_are_replaced_and_the_newest_is_the_present() {
        let mut history = History::new(1, 0.01, 1e-3);
        for k in 1..=1000_u32 {
            let t = f64::from(k) * 1e-4;
            history.record(t, &[t]);
            assert_eq!(history.newest(), t);
            assert_eq!(history.last(), [t]);
        }
        assert!(history.count < 110, "{} rows for 100 spacings", history.count);
        assert!((history.wave(&history.at(0.0951), 0) - 0.0951).abs() < 1e-15);
    }

    #[test]
    fn a_rewound_history_goes_on_as_if_nothing_had_been_written() {
        let write = |history: &mut History, from: u32, to: u32, scale: f64| {
            (from..to).for_each(|k| history.record(f64::from(k) * 5e-4, &[scale * f64::from(k * k % 7)]));
        };
        let mut plain = History::new(1, 0.05, 1e-3);
        write(&mut plain, 1, 333, 1.0);
        let mut rewound = plain.clone();
        let mut mark = rewound.new_mark();
        rewound.mark(&mut mark);
        write(&mut rewound, 333, 341, 9.0);
        rewound.rewind(&mark);
        write(&mut plain, 333, 400, 1.0);
        write(&mut rewound, 333, 400, 1.0);
        for k in 0..50 {
            let at = plain.newest() - 1e-3 * f64::from(k);
            assert_eq!(plain.wave(&plain.at(at), 0), rewound.wave(&rewound.at(at), 0));
            let squares = |history: &History| history.square_since(&history.at(at), 0);
            assert_eq!(squares(&plain), squares(&rewound));
        }
    }
}
