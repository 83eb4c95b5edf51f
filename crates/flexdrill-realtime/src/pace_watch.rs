//! Judgement, over seconds, of whether the model keeps up with the clock. Status, diagnostics, alarm and log share it.

use crate::RealTimeFactor;

/// Real-time factor from which the model keeps up with the clock; the difference to 1 is jitter of the measurement.
pub const KEEPS_UP: f64 = 0.98;
/// Factor below which the model is far behind: it skips a tenth of the time or more.
pub const FAR_BEHIND: f64 = 0.9;

/// Window of the judged factor (s): a machine that is late for single steps is not too slow.
const WINDOW: f64 = 10.0;
/// Time that the factor must stay below a limit before the level rises (ns). Longer than the window, in which
/// a stall appears for its own duration plus the window: a stall of up to two seconds has no effect.
const RISE: u64 = 12_000_000_000;
/// Time that the factor must stay above a limit and its deadband before the level falls (ns): load on a
/// computer varies within half a minute.
const FALL: u64 = 30_000_000_000;
/// Part of the factor between the limit that raises a level and the one that lets it fall.
const DEADBAND: f64 = 0.01;

/// How the model keeps up with the clock. The discriminants are those of the messages' PACE_ constants.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Pace {
    /// The model has not run for long enough.
    #[default]
    NotJudged = 0,
    /// The model keeps up.
    Kept = 1,
    /// The factor is below [`KEEPS_UP`].
    Late = 2,
    /// The factor is below [`FAR_BEHIND`].
    FarBehind = 3,
}

/// A judgement with its factor.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PaceReading {
    /// The level.
    pub level: Pace,
    /// Model time gained per second over the last ten seconds; `None` until the model has run for so long.
    pub factor: Option<f64>,
}

/// Times since when the factor has been on either side of a limit.
#[derive(Debug, Clone, Copy, Default)]
struct Limit {
    below_since: Option<u64>,
    above_since: Option<u64>,
}

impl Limit {
    fn note(&mut self, now: u64, limit: f64, factor: f64) {
        let keep = |since: &mut Option<u64>, holds: bool| *since = holds.then(|| since.unwrap_or(now));
        keep(&mut self.below_since, factor < limit);
        keep(&mut self.above_since, factor >= limit + DEADBAND);
    }

    /// Whether a level stands, given whether it stood before.
    fn stands(&self, now: u64, stood: bool) -> bool {
        let lasted = |since: Option<u64>, time: u64| since.is_some_and(|since| now.saturating_sub(since) >= time);
        lasted(self.below_since, RISE) || stood && !lasted(self.above_since, FALL)
    }
}

/// Judges the pace, with delays and hysteresis.
#[derive(Debug, Clone)]
pub struct PaceWatch {
    factor: RealTimeFactor,
    reading: PaceReading,
    /// Limits of [`Pace::Late`] and [`Pace::FarBehind`].
    limits: [Limit; 2],
}

impl Default for PaceWatch {
    fn default() -> Self {
        Self {
            factor: RealTimeFactor::new(WINDOW),
            reading: PaceReading::default(),
            limits: Default::default(),
        }
    }
}

impl PaceWatch {
    /// Notes that at `now` (ns, on the clock to keep up with) the model is at `model_time` (s). The caller notes
    /// several times per second while the model runs.
    pub fn note(&mut self, now: u64, model_time: f64) {
        self.factor.note(now, model_time);
        let Some(factor) = self.factor.factor(now, model_time) else {
            return;
        };
        let before = self.reading.level;
        let mut level = if before == Pace::NotJudged && factor < KEEPS_UP {
            Pace::NotJudged
        } else {
            Pace::Kept
        };
        let levels = [(Pace::Late, KEEPS_UP), (Pace::FarBehind, FAR_BEHIND)];
        for (limit, (name, at)) in self.limits.iter_mut().zip(levels) {
            limit.note(now, at, factor);
            if limit.stands(now, before >= name) {
                level = name;
            }
        }
        self.reading = PaceReading {
            level,
            factor: Some(factor),
        };
    }

    /// The present judgement.
    pub fn reading(&self) -> PaceReading {
        self.reading
    }

    /// Resets the judgement. The caller does so while the model stands still.
    pub fn restart(&mut self) {
        self.factor.restart();
        self.reading = PaceReading::default();
        self.limits = Default::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TENTH: u64 = 100_000_000;

    /// A model whose speed the test chooses, looked at ten times per second.
    #[derive(Default)]
    struct Model {
        watch: PaceWatch,
        now: u64,
        time: f64,
    }

    impl Model {
        /// Runs so long at these speeds in turn, a tenth of a second each; the levels that were shown, without repeats.
        fn run(&mut self, seconds: u64, speeds: &[f64]) -> Vec<Pace> {
            let mut levels = vec![self.watch.reading().level];
            for tenth in 0..seconds * 10 {
                self.now += TENTH;
                self.time += 0.1 * speeds[tenth as usize % speeds.len()];
                self.watch.note(self.now, self.time);
                levels.push(self.watch.reading().level);
            }
            levels.dedup();
            levels
        }
    }

    #[test]
    fn nothing_is_judged_in_the_first_ten_seconds_nor_after_a_restart() {
        let mut model = Model::default();
        assert_eq!(model.run(9, &[0.1]), [Pace::NotJudged]);
        assert_eq!(model.watch.reading().factor, None);
        model.watch.restart();
        assert_eq!(model.run(11, &[1.0]), [Pace::NotJudged, Pace::Kept]);
        assert_eq!(model.run(60, &[0.5]).last(), Some(&Pace::FarBehind));
        model.watch.restart();
        assert_eq!(model.watch.reading(), PaceReading::default());
        assert_eq!(model.run(11, &[1.0]), [Pace::NotJudged, Pace::Kept]);
    }

    #[test]
    fn a_computer_that_is_too_slow_is_named_once_and_until_it_has_kept_up_for_long() {
        let mut model = Model::default();
        model.run(30, &[1.0]);
        assert_eq!(model.run(40, &[0.95]), [Pace::Kept, Pace::Late]);
        assert_eq!(model.run(40, &[0.8]), [Pace::Late, Pace::FarBehind]);
        // The window takes 5.5 s to rise above the lower limit with its deadband and 9.5 s above the upper one.
        assert_eq!(model.run(35, &[1.0]), [Pace::FarBehind]);
        assert_eq!(model.run(6, &[1.0]), [Pace::FarBehind, Pace::Late, Pace::Kept]);
    }

    /// One stall of a second, as of a machine that writes its memory out.
    #[test]
    fn a_single_stall_changes_nothing() {
        let mut model = Model::default();
        model.run(30, &[1.0]);
        assert_eq!(model.run(1, &[0.0]), [Pace::Kept]);
        assert_eq!(model.run(60, &[1.0]), [Pace::Kept]);
    }

    /// Three minutes about the limit: before, the judgement of one second changed every few seconds.
    #[test]
    fn a_pace_about_the_limit_does_not_flicker() {
        let mut model = Model::default();
        model.run(30, &[1.0]);
        // Each second another speed, 0.98 in the mean.
        let speeds: Vec<f64> = [0.8, 1.1, 0.9, 1.05, 1.05]
            .iter()
            .flat_map(|speed| [*speed; 10])
            .collect();
        let levels = model.run(180, &speeds);
        assert!(levels.len() <= 2, "{levels:?}");
    }
}
