//! Contact forces along the tool: peaks held for a few seconds, and their maxima over bins of the inclination.

/// Peaks are held at least this long and at most twice as long (s of model time): one turn at 40 r/min.
const HOLD: f64 = 1.5;

/// Largest force of every station over the last [`HOLD`] to 2 [`HOLD`] seconds.
#[derive(Debug, Clone, Default)]
pub(super) struct HeldPeaks {
    started: f64,
    current: Vec<f64>,
    previous: Vec<f64>,
}

impl HeldPeaks {
    /// Takes the peaks of one publishing interval that ends at `time` (s).
    pub(super) fn take(&mut self, time: f64, peaks: &[f64]) {
        if peaks.len() != self.current.len() || time < self.started {
            self.current = vec![0.0; peaks.len()];
            self.previous = vec![0.0; peaks.len()];
            self.started = time;
        } else if time - self.started >= HOLD {
            std::mem::swap(&mut self.current, &mut self.previous);
            self.current.fill(0.0);
            self.started = time;
        }
        for (held, peak) in self.current.iter_mut().zip(peaks) {
            *held = held.max(*peak);
        }
    }

    /// Held peaks, one per station.
    pub(super) fn forces(&self) -> impl Iterator<Item = f64> {
        self.current
            .iter()
            .zip(&self.previous)
            .map(|(now, before)| now.max(*before))
    }

    /// The largest and its station; none while nothing touches.
    pub(super) fn largest(&self) -> Option<(usize, f64)> {
        self.forces()
            .enumerate()
            .filter(|(_, force)| *force > 0.0)
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Largest force in each of `bins` equal parts of the way from the first to the last station, along `positions`
/// (increasing). A part without a station takes that of the nearest one.
pub(super) fn binned(positions: &[f64], forces: impl Iterator<Item = f64>, bins: usize) -> Vec<f64> {
    let mut out = vec![f64::NAN; bins];
    let (Some(&first), Some(&last)) = (positions.first(), positions.last()) else {
        return vec![0.0; bins];
    };
    let length = last - first;
    for (position, force) in positions.iter().zip(forces) {
        let part = if length > 0.0 { (position - first) / length } else { 0.0 };
        let bin = ((part * bins as f64) as usize).min(bins.saturating_sub(1));
        if let Some(held) = out.get_mut(bin) {
            *held = held.max(force);
        }
    }
    let filled: Vec<usize> = (0..bins).filter(|&bin| !out[bin].is_nan()).collect();
    (0..bins)
        .map(|bin| {
            let nearest = filled.iter().min_by_key(|&&other| other.abs_diff(bin));
            nearest.map_or(0.0, |&other| out[other])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_is_held_and_then_forgotten() {
        let mut held = HeldPeaks::default();
        assert_eq!(held.largest(), None);
        held.take(0.0, &[0.0, 500.0]);
        held.take(1.0, &[20.0, 0.0]);
        assert_eq!(held.largest(), Some((1, 500.0)));
        held.take(1.6, &[20.0, 0.0]);
        assert_eq!(held.largest(), Some((1, 500.0)));
        held.take(3.2, &[20.0, 0.0]);
        assert_eq!(held.largest(), Some((0, 20.0)));
        held.take(0.1, &[1.0, 0.0]);
        assert_eq!(held.largest(), Some((0, 1.0)));
    }

    #[test]
    fn bins_keep_the_largest_and_fill_gaps() {
        let positions = [0.0, 0.1, 0.5, 1.0];
        assert_eq!(binned(&positions, [1.0, 3.0, 5.0, 7.0].into_iter(), 2), [3.0, 7.0]);
        assert_eq!(
            binned(&positions, [1.0, 3.0, 5.0, 7.0].into_iter(), 5),
            [3.0, 3.0, 5.0, 5.0, 7.0]
        );
        assert_eq!(binned(&[], std::iter::empty(), 3), [0.0; 3]);
    }
}
