//! The time that each phase of a step takes.
//!
//! The mechanics has no clock: a caller that wants times hands one in, as a plain function. Without it nothing is measured.
//! Times are no part of the state: no checkpoint, snapshot or output that a replay compares holds them.

/// Nanoseconds of a monotonic clock. It is called some ten times per Newton iteration and must neither lock nor
/// allocate.
pub type Clock = fn() -> u64;

/// A part of the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Residual and tangent of beams, joints and loads, the base tangent included; judging convergence.
    Assembly,
    /// Gaps of both layers: search, force, tangent.
    Contact,
    /// Factorisation and solution of the linear system.
    Solve,
    /// The energy audit.
    Energy,
    /// What is read off each step: statistics, stick-slip, whirl.
    Analysis,
    /// Filling the snapshots that are published.
    Snapshot,
    /// The rest: predictor, corrections of the state, copies for the retreat.
    Other,
}

impl Phase {
    /// All, in the order in which they are published.
    pub const ALL: [Self; 7] = [
        Self::Assembly,
        Self::Contact,
        Self::Solve,
        Self::Energy,
        Self::Analysis,
        Self::Snapshot,
        Self::Other,
    ];

    /// Its word in status, summaries and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Assembly => "assembly",
            Self::Contact => "contact",
            Self::Solve => "solve",
            Self::Energy => "energy",
            Self::Analysis => "analysis",
            Self::Snapshot => "snapshot",
            Self::Other => "other",
        }
    }
}

/// Time per phase since the start (ns).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PhaseTimes([u64; Phase::ALL.len()]);

impl PhaseTimes {
    /// From a time per phase (ns).
    pub fn from_nanoseconds(time: impl Fn(Phase) -> u64) -> Self {
        Self(Phase::ALL.map(time))
    }

    /// Of one phase (ns).
    pub fn of(&self, phase: Phase) -> u64 {
        self.0[phase as usize]
    }

    /// Of all phases (ns).
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }

    /// What was added since `before` (ns).
    pub fn since(&self, before: &Self) -> Self {
        let mut out = *self;
        for (time, before) in out.0.iter_mut().zip(&before.0) {
            *time = time.saturating_sub(*before);
        }
        out
    }
}

/// A running clock whose laps are added to phases, so that one reading ends a phase and begins the next.
#[derive(Debug, Clone, Default)]
pub struct Stopwatch {
    clock: Option<Clock>,
    /// When the present lap began (ns); `None` while stopped.
    mark: Option<u64>,
    times: PhaseTimes,
}

impl Stopwatch {
    /// Measures with `clock` from now on; with `None` not at all.
    pub fn set_clock(&mut self, clock: Option<Clock>) {
        self.clock = clock;
        self.mark = None;
    }

    /// Begins the first lap.
    pub fn start(&mut self) {
        self.mark = self.clock.map(|clock| clock());
    }

    /// Ends a lap that went into `phase`. Nothing while stopped, as during a static start.
    #[inline]
    pub fn lap(&mut self, phase: Phase) {
        if let (Some(clock), Some(mark)) = (self.clock, self.mark) {
            let now = clock();
            self.times.0[phase as usize] += now.saturating_sub(mark);
            self.mark = Some(now);
        }
    }

    /// Ends the last lap.
    pub fn stop(&mut self, phase: Phase) {
        self.lap(phase);
        self.mark = None;
    }

    /// What was measured so far.
    pub fn times(&self) -> PhaseTimes {
        self.times
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;

    #[test]
    fn laps_add_up_to_the_time_between_start_and_stop() {
        // Read once per call: 10, 20, 30, ...
        static TIME: AtomicU64 = AtomicU64::new(0);
        let mut watch = Stopwatch::default();
        watch.lap(Phase::Solve);
        assert_eq!(watch.times(), PhaseTimes::default());
        watch.set_clock(Some(|| TIME.fetch_add(10, Ordering::Relaxed)));
        watch.lap(Phase::Solve);
        assert_eq!(watch.times().total(), 0);
        watch.start();
        watch.lap(Phase::Assembly);
        watch.lap(Phase::Solve);
        let before = watch.times();
        watch.stop(Phase::Assembly);
        watch.lap(Phase::Energy);
        assert_eq!(watch.times().of(Phase::Assembly), 20);
        assert_eq!(watch.times().of(Phase::Solve), 10);
        assert_eq!(watch.times().total(), 30);
        assert_eq!(watch.times().since(&before).total(), 10);
    }

    #[test]
    fn every_phase_has_its_place_and_name() {
        for (index, phase) in Phase::ALL.into_iter().enumerate() {
            assert_eq!(phase as usize, index);
            assert_eq!(Phase::ALL.iter().filter(|p| p.name() == phase.name()).count(), 1);
        }
    }
}
