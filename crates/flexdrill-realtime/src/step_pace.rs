//! The refinement of the model's steps that the machine has time for.

/// Window of one judgement (ns).
const WINDOW: u64 = 1_000_000_000;
/// Share of the time for computing above which the step becomes coarser. The rest is for other work of the machine.
const MOST: f64 = 0.75;
/// Largest expected share of the next finer step. Halving the step doubles the work at most; it needs fewer iterations.
const ENOUGH: f64 = 0.6;
/// Consecutive windows with enough time before a finer step is tried.
const CALM: u32 = 3;
/// Windows after a coarser step before a finer one is tried again: a machine that was too slow once will be again.
const WARY: u32 = 60;

/// Watches the share of the time that computing takes.
#[derive(Debug, Clone)]
pub struct StepPace {
    most: u32,
    allowed: u32,
    /// Start of the window (ns).
    began: Option<u64>,
    /// Computing time in the window (ns).
    busy: u64,
    late: bool,
    /// Remaining windows before a finer step.
    wait: u32,
}

impl StepPace {
    /// A watch that allows no refinement at the start, and up to `most` later.
    pub fn new(most: u32) -> Self {
        Self {
            most,
            allowed: 0,
            began: None,
            busy: 0,
            late: false,
            wait: CALM,
        }
    }

    /// The refinement that the machine has time for.
    pub fn allowed(&self) -> u32 {
        self.allowed
    }

    /// A period was computed between two instants (ns) with a refinement `in_force`; `late` if
    /// periods were skipped.
    pub fn note(&mut self, (from, to): (u64, u64), late: bool, in_force: u32) {
        let began = *self.began.get_or_insert(from);
        self.busy += to.saturating_sub(from);
        self.late |= late;
        let passed = to.saturating_sub(began);
        if passed < WINDOW {
            return;
        }
        let load = self.busy as f64 / passed as f64;
        if self.late || load > MOST {
            self.allowed = in_force.saturating_sub(1);
            self.wait = WARY;
        } else if 2.0 * load > ENOUGH {
            self.wait = self.wait.max(CALM);
        } else if self.wait > 1 {
            self.wait -= 1;
        } else if self.allowed <= in_force {
            // One level at a time: the load of each level predicts that of the next.
            self.allowed = (in_force + 1).min(self.most);
            self.wait = CALM;
        }
        self.forget();
    }

    /// Restarts the window after the model stood still, which says nothing about the load.
    pub fn forget(&mut self) {
        self.began = None;
        self.busy = 0;
        self.late = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    /// Runs periods of 5 ms; a step costs `cost` of the time whole and twice as much with each refinement.
    struct Machine {
        pace: StepPace,
        now: u64,
        in_force: u32,
    }

    impl Machine {
        fn new() -> Self {
            Self {
                pace: StepPace::new(2),
                now: 0,
                in_force: 0,
            }
        }

        /// For so many seconds; gives the number of changes.
        fn run(&mut self, seconds: u32, cost: f64, late: bool) -> u32 {
            let period = 5 * MS;
            let mut changes = 0;
            for _ in 0..seconds * 200 {
                let busy = (period as f64 * cost * f64::from(1 << self.in_force)) as u64;
                self.pace.note((self.now, self.now + busy), late, self.in_force);
                self.now += period.max(busy);
                changes += u32::from(self.pace.allowed() != self.in_force);
                self.in_force = self.pace.allowed();
            }
            changes
        }
    }

    #[test]
    fn a_fast_machine_rises_to_the_finest_step_and_stays() {
        let mut machine = Machine::new();
        assert_eq!(machine.run(2, 0.1, false), 0);
        assert_eq!(machine.run(600, 0.1, false), 2);
        assert_eq!(machine.in_force, 2);
    }

    #[test]
    fn a_slower_one_stops_where_time_is_left() {
        let mut machine = Machine::new();
        machine.run(60, 0.25, false);
        assert_eq!(machine.in_force, 1);
        // 31 % now would be 62 %.
        let mut machine = Machine::new();
        assert_eq!(machine.run(600, 0.31, false), 0);
    }

    #[test]
    fn load_and_lateness_make_it_coarser_within_two_seconds_and_wary_for_a_minute() {
        for late in [false, true] {
            let mut machine = Machine::new();
            machine.run(20, 0.1, false);
            assert_eq!(machine.in_force, 2);
            machine.run(2, if late { 0.1 } else { 0.2 }, late);
            assert!(machine.in_force < 2, "{late}");
            let before = machine.in_force;
            assert_eq!(machine.run(55, 0.05, false), 0, "{late}");
            machine.run(20, 0.05, false);
            assert!(machine.in_force > before, "{late}");
        }
    }

    #[test]
    fn what_the_motion_does_not_ask_for_is_not_taken_for_slow() {
        let mut pace = StepPace::new(2);
        // In force stays 1 whatever is allowed.
        for n in 0..20_000 {
            let from = n * 5 * MS;
            pace.note((from, from + MS / 2), false, 1);
        }
        assert_eq!(pace.allowed(), 2);
    }

    #[test]
    fn standing_still_tells_nothing() {
        let mut pace = StepPace::new(2);
        for n in 0..1000 {
            let from = n * 900 * MS;
            pace.note((from, from + MS / 2), false, 0);
            pace.forget();
        }
        assert_eq!(pace.allowed(), 0);
    }
}
