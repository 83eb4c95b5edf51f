//! Rainflow counting of a running signal: each closed cycle of a load once, by the four-point rule. ASTM E 1049 yields
//! the same cycles for a whole record.
//!
//! A range between two larger ones is a closed hysteresis loop; it is counted and removed. The ranges of the residue
//! grow and then shrink, so that it stays short.

use serde::{Deserialize, Serialize};

/// Capacity for turning points of open cycles. When it is exhausted, the smallest range of the residue counts as
/// closed.
const WAITING: usize = 48;

/// One load channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Rainflow {
    /// Turning points of open cycles.
    waiting: Vec<f64>,
    /// The newest extreme, a turning point once the signal reverses.
    extreme: f64,
    /// Direction towards it, up (1) or down (-1); 0 before the first change.
    heading: f64,
}

impl Rainflow {
    pub(super) fn new() -> Self {
        Self {
            waiting: Vec::with_capacity(WAITING + 1),
            extreme: 0.0,
            heading: 0.0,
        }
    }

    /// Takes the next value; calls `closed` with the range of every cycle that it closes. Changes below `least` are
    /// noise.
    pub(super) fn push(&mut self, value: f64, least: f64, mut closed: impl FnMut(f64)) {
        let moved = value - self.extreme;
        if self.heading == 0.0 {
            if self.waiting.is_empty() {
                (self.extreme, self.heading) = (value, 0.0);
                self.waiting.push(value);
            } else if (value - self.waiting[0]).abs() > least {
                (self.extreme, self.heading) = (value, (value - self.waiting[0]).signum());
            }
            return;
        }
        if moved * self.heading >= 0.0 {
            self.extreme = value;
        } else if moved.abs() > least {
            self.turn(&mut closed);
            (self.extreme, self.heading) = (value, -self.heading);
        }
    }

    /// Adds the extreme as a turning point, and counts the cycles that it closes.
    fn turn(&mut self, closed: &mut impl FnMut(f64)) {
        self.waiting.push(self.extreme);
        while let [.., a, b, c, d] = self.waiting[..] {
            let (before, inner, after) = ((b - a).abs(), (c - b).abs(), (d - c).abs());
            if inner > before || inner > after {
                break;
            }
            closed(inner);
            let end = self.waiting.len();
            self.waiting.drain(end - 3..end - 1);
        }
        if self.waiting.len() > WAITING {
            let range = |index: usize| (self.waiting[index + 1] - self.waiting[index]).abs();
            let smallest = (0..self.waiting.len() - 1)
                .min_by(|&a, &b| range(a).total_cmp(&range(b)))
                .unwrap_or_default();
            closed(range(smallest));
            self.waiting.drain(smallest..smallest + 2);
        }
    }

    pub(super) fn clear(&mut self) {
        self.waiting.clear();
        (self.extreme, self.heading) = (0.0, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(values: impl IntoIterator<Item = f64>, least: f64) -> Vec<f64> {
        let mut flow = Rainflow::new();
        let mut cycles = Vec::new();
        for value in values {
            flow.push(value, least, |range| cycles.push(range));
        }
        cycles.sort_by(f64::total_cmp);
        cycles
    }

    /// The record of ASTM E 1049-85, figure 6, over and over: each repetition has one cycle of 3, 4, 7 and 9.
    #[test]
    fn the_standards_record_gives_the_standards_cycles() {
        let block = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];
        let many = counted(block.iter().cycle().take(9 * 20).copied(), 0.1);
        let count = |range: f64| many.iter().filter(|&&cycle| (cycle - range).abs() < 1e-12).count();
        // Those of the last repetitions wait for their partners.
        for (range, least) in [(9.0, 18), (4.0, 19), (7.0, 18), (3.0, 18)] {
            assert!(
                (least..=20).contains(&count(range)),
                "{range}: {} in {many:?}",
                count(range)
            );
        }
        assert_eq!(
            many.iter()
                .filter(|&&range| ![9.0, 4.0, 7.0, 3.0].contains(&range))
                .count(),
            0,
            "{many:?}"
        );
    }

    #[test]
    fn a_sine_counts_once_per_period_and_noise_not_at_all() {
        let sine = |index: u32| 2.0 * (f64::from(index) * 0.01).sin() + 0.01 * (f64::from(index) * 1.7).sin();
        let cycles = counted((0..62_832).map(sine), 0.1);
        // Some wait for a partner as large as themselves, half of the room at most.
        assert!((100 - WAITING / 2..=100).contains(&cycles.len()), "{}", cycles.len());
        assert!(cycles.iter().all(|range| (range - 4.0).abs() < 0.05));
    }

    #[test]
    fn a_load_that_only_grows_does_not_fill_the_memory() {
        let mut flow = Rainflow::new();
        let mut closed = 0;
        for index in 0..10_000u32 {
            let size = f64::from(index);
            flow.push(if index % 2 == 0 { size } else { -size }, 0.1, |_| closed += 1);
            assert!(flow.waiting.len() <= WAITING && flow.waiting.capacity() == WAITING + 1);
        }
        assert!(closed > 4_000);
    }
}
