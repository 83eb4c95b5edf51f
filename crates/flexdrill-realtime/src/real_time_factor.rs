//! How fast model time runs against wall time.

/// From this factor on the model keeps up with the clock: what is missing is the jitter of the measurement.
pub const KEEPS_UP: f64 = 0.98;
/// Below this factor it is far behind: every tenth second or more is skipped.
pub const FAR_BEHIND: f64 = 0.9;

/// Marks kept in a window; the factor is as old as window x (1 +- 1/MARKS).
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
    /// Where the next mark goes.
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

    /// Notes that at `now` (wall, ns) the model is at `model_time` (s). As often as one likes; cheap.
    pub fn note(&mut self, now: u64, model_time: f64) {
        let spacing = self.window / (MARKS as u64 - 1);
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

    /// Factor at `now` (wall, ns) with the model at `model_time` (s): 1 keeps up, 0.5 is half as fast. `None` before
    /// any time has passed.
    pub fn factor(&self, now: u64, model_time: f64) -> Option<f64> {
        let oldest_allowed = now.saturating_sub(self.window);
        let marks = (0..self.filled).map(|back| self.marks[(self.next + MARKS - self.filled + back) % MARKS]);
        let mut base = None;
        for mark in marks {
            // The newest mark that is at least a window old, else the oldest there is.
            if base.is_none() || mark.0 <= oldest_allowed {
                base = Some(mark);
            }
        }
        let (wall, model) = base?;
        let passed = now.checked_sub(wall).filter(|passed| *passed > 0)?;
        Some((model_time - model) / (passed as f64 * 1e-9))
    }

    /// Forgets everything, as after a pause or a reset.
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
        let told = factor.factor(2_999_000_000, model).unwrap();
        assert!((told - 1.0).abs() < 1e-9, "{told}");
        let model = run(&mut factor, 3000, 5000, model, 0.5);
        let told = factor.factor(4_999_000_000, model).unwrap();
        assert!((told - 0.5).abs() < 1e-9, "{told}");
    }

    /// The model may hang in one step: the factor sinks although nothing is noted.
    #[test]
    fn sinks_while_nothing_is_noted() {
        let mut factor = RealTimeFactor::new(1.0);
        let model = run(&mut factor, 0, 1000, 0.0, 1.0);
        let told = factor.factor(10_000_000_000, model).unwrap();
        assert!(told < 0.01, "{told}");
    }

    #[test]
    fn a_restart_forgets() {
        let mut factor = RealTimeFactor::new(1.0);
        run(&mut factor, 0, 1000, 0.0, 1.0);
        factor.restart();
        assert_eq!(factor.factor(2_000_000_000, 1.0), None);
    }
}
