//! Which instant the next step is due at, and what is given up when it is late.

/// Absolute deadlines of a fixed period. Being late is caught up while it stays within a tolerance; beyond that, whole
/// periods are given up and counted, so that the deadlines keep their phase.
#[derive(Debug, Clone)]
pub struct Pacer {
    /// Origin (ns).
    origin: u64,
    /// ns; deadlines are computed from the origin each time, so that no rounding adds up.
    period: f64,
    /// Periods since the origin that are done or given up.
    ticks: u64,
    tolerance: u64,
    skipped: u64,
    misses: u64,
}

/// What a step's end came to.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Paced {
    /// The step ended after its period.
    pub missed: bool,
    /// How long after (ns), before periods were given up; 0 when in time.
    pub lateness: u64,
    /// Whole periods given up now.
    pub skipped: u64,
}

/// Whole periods between `deadline` and `now` (ns); 0 when `now` is not after it or the period is not positive.
pub fn whole_periods(now: u64, deadline: u64, period: f64) -> u64 {
    if period > 0.0 && now > deadline {
        // Truncation is meant: whole periods only.
        ((now - deadline) as f64 / period) as u64
    } else {
        0
    }
}

impl Pacer {
    /// The first step is due at `now` (ns), the next ones every `period_s` (s; divide by a rate to go faster). Up to
    /// `tolerance` periods of lateness are caught up.
    pub fn new(now: u64, period_s: f64, tolerance: u64) -> Self {
        Self {
            origin: now,
            period: period_s * 1e9,
            ticks: 0,
            tolerance,
            skipped: 0,
            misses: 0,
        }
    }

    /// When the next step is due to begin (ns).
    pub fn deadline(&self) -> u64 {
        self.deadline_of(self.ticks)
    }

    fn deadline_of(&self, tick: u64) -> u64 {
        // A float to integer conversion saturates: absurd periods give a far deadline, not a panic.
        self.origin.saturating_add((tick as f64 * self.period).round() as u64)
    }

    /// To be called at the end of each step. A step is in time when it ends before the next one is due.
    pub fn step_done(&mut self, now: u64) -> Paced {
        self.ticks += 1;
        let due = self.deadline();
        let lateness = now.saturating_sub(due);
        let late_periods = whole_periods(now, due, self.period);
        let skipped = if late_periods > self.tolerance { late_periods } else { 0 };
        self.ticks += skipped;
        self.skipped += skipped;
        let missed = lateness > 0;
        self.misses += u64::from(missed);
        Paced {
            missed,
            lateness,
            skipped,
        }
    }

    /// The next step is due at `now` (ns), as after a pause; nothing counts as skipped.
    pub fn restart(&mut self, now: u64) {
        self.origin = now;
        self.ticks = 0;
    }

    /// How far behind the next deadline `now` is (s), 0 when ahead of it.
    pub fn lateness(&self, now: u64) -> f64 {
        now.saturating_sub(self.deadline()) as f64 * 1e-9
    }

    /// Periods given up since the start.
    pub fn skipped(&self) -> u64 {
        self.skipped
    }

    /// Steps that ended late since the start.
    pub fn misses(&self) -> u64 {
        self.misses
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn deadlines_do_not_drift() {
        // A third of a millisecond is not a whole number of ns.
        let mut pacer = Pacer::new(7, 1e-3 / 3.0, 0);
        for _ in 0..3_000_000_u64 {
            let due = pacer.deadline();
            assert_eq!(pacer.step_done(due).skipped, 0);
        }
        assert_eq!(pacer.deadline(), 7 + 1_000_000 * MS);
        assert_eq!(pacer.misses(), 0);
    }

    #[test]
    fn lateness_within_the_tolerance_is_caught_up() {
        let mut pacer = Pacer::new(0, 1e-3, 5);
        let paced = pacer.step_done(4 * MS);
        assert_eq!(
            paced,
            Paced {
                missed: true,
                lateness: 3 * MS,
                skipped: 0
            }
        );
        assert_eq!(pacer.deadline(), MS);
        for _ in 0..3 {
            pacer.step_done(4 * MS);
        }
        assert_eq!(pacer.lateness(4 * MS), 0.0);
        assert_eq!(pacer.misses(), 3);
    }

    #[test]
    fn beyond_it_whole_periods_are_given_up_and_the_phase_is_kept() {
        let mut pacer = Pacer::new(0, 1e-3, 5);
        let paced = pacer.step_done(10 * MS + MS / 2);
        assert_eq!(paced.skipped, 9);
        assert_eq!(pacer.deadline(), 10 * MS);
        assert_eq!(pacer.skipped(), 9);
        assert_eq!(pacer.lateness(10 * MS + MS / 2), 0.0005);
    }

    #[test]
    fn steps_and_skips_account_for_all_time() {
        let mut pacer = Pacer::new(0, 1e-3, 3);
        let (mut now, mut steps) = (0, 0);
        // Steps of 1.7 periods: the machine is too slow.
        for _ in 0..1000 {
            now = now.max(pacer.deadline()) + MS * 17 / 10;
            pacer.step_done(now);
            steps += 1;
        }
        assert_eq!(pacer.deadline() / MS, steps + pacer.skipped());
        assert!(pacer.lateness(now) < 0.005);
    }

    #[test]
    fn a_restart_forgets_the_pause() {
        let mut pacer = Pacer::new(0, 1e-3, 0);
        pacer.restart(500 * MS);
        assert_eq!(pacer.deadline(), 500 * MS);
        assert_eq!(pacer.step_done(500 * MS + 1).skipped, 0);
    }

    #[test]
    fn absurd_values_do_not_panic() {
        for period in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
            let mut pacer = Pacer::new(u64::MAX, period, 0);
            pacer.step_done(u64::MAX);
            let _ = pacer.deadline();
        }
        assert_eq!(whole_periods(5, 10, 1.0), 0);
        assert_eq!(whole_periods(10, 5, 2.0), 2);
    }
}
