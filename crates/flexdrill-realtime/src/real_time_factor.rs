//! Real-time factor: model time gained per wall time.

/// Marks kept. Two more than a window has, so that the oldest of a full ring is always at least a window old; the
/// factor then spans window x (1 + 1/MARKS) at most.
const MARKS: usize = 64;

/// Model time gained per wall time over a sliding window.
#[derive(Debug, Clone)]
pub struct RealTimeFactor {
    /// Window (ns).
    window: u64,
    /// (wall ns, model s), a ring.
    marks: [(u64, f64); MARKS],
    /// Number of valid marks.
    filled: usize,
    /// Index of the next mark.
    next: usize,
}

impl RealTimeFactor {
    /// Over a window of `window_s` (s).
    pub fn new(window_s: f64) -> Self {
        Self {
            window: (window_s * 1e9) as u64,
            marks: [(0, 0.0); MARKS],
            filled: 0,
            next: 0,
        }
    }

    /// Notes that at `now` (wall, ns) the model is at `model_time` (s). The call is cheap and may be frequent.
    pub fn note(&mut self, now: u64, model_time: f64) {
        let spacing = self.window / (MARKS as u64 - 2);
        if self.filled > 0 {
            let newest = self.marks[(self.next + MARKS - 1) % MARKS].0;
            if now < newest.saturating_add(spacing) {
                return;
            }
        }
        self.marks[self.next] = (now, model_time);
        self.next = (self.next + 1) % MARKS;
        self.filled = (self.filled + 1).min(MARKS);
    }

    /// Factor at `now` (wall, ns) with the model at `model_time` (s): 1 keeps up, 0.5 is half as fast. `None` until a
    /// whole window has passed since the first mark: a factor of less time would show the jitter of single periods.
    pub fn factor(&self, now: u64, model_time: f64) -> Option<f64> {
        let youngest_allowed = now.checked_sub(self.window)?;
        let marks = (0..self.filled).map(|index| self.marks[(self.next + MARKS - self.filled + index) % MARKS]);
        let (wall, model) = marks.take_while(|mark| mark.0 <= youngest_allowed).last()?;
        let passed = Some(now - wall).filter(|passed| *passed > 0)?;
        Some((model_time - model) / (passed as f64 * 1e-9))
    }

    /// Forgets everything: the time of a pause or of a failed step is none that the model should have kept up with.
    pub fn restart(&mut self) {
        self.filled = 0;
        self.next = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(factor: &mut RealTimeFactor, from_ms: u64, to_ms: u64, model_from: f64, speed: f64) -> f64 {
        let mut model = model_from;
        for ms in from_ms..to_ms {
            model = model_from + (ms - from_ms) as f64 * 1e-3 * speed;
            factor.note(ms * 1_000_000, model);
        }
        model
    }

    #[test]
    fn tells_the_speed_and_forgets_the_past() {
        let mut factor = RealTimeFactor::new(1.0);
        assert_eq!(factor.factor(0, 0.0), None);
        let model = run(&mut factor, 0, 3000, 0.0, 1.0);
        let measured = factor.factor(2_999_000_000, model).unwrap();
        assert!((measured - 1.0).abs() < 1e-9, "{measured}");
        let model = run(&mut factor, 3000, 5000, model, 0.5);
        let measured = factor.factor(4_999_000_000, model).unwrap();
        assert!((measured - 0.5).abs() < 1e-9, "{measured}");
    }

    /// The model may hang in one step: the factor sinks although nothing is noted.
    #[test]
    fn sinks_while_nothing_is_noted() {
        let mut factor = RealTimeFactor::new(1.0);
        let model = run(&mut factor, 0, 1000, 0.0, 1.0);
        let measured = factor.factor(10_000_000_000, model).unwrap();
        assert!(measured < 0.01, "{measured}");
    }

    #[test]
    fn a_restart_forgets() {
        let mut factor = RealTimeFactor::new(1.0);
        run(&mut factor, 0, 1000, 0.0, 1.0);
        factor.restart();
        assert_eq!(factor.factor(2_000_000_000, 1.0), None);
    }

    #[test]
    fn less_than_a_window_gives_no_factor_and_a_full_one_always_does() {
        let mut factor = RealTimeFactor::new(1.0);
        for ms in 0..5000_u64 {
            let (now, model) = (ms * 1_000_000, ms as f64 * 1e-3);
            factor.note(now, model);
            assert_eq!(factor.factor(now, model).is_some(), ms >= 1000, "at {ms} ms");
        }
    }
}
