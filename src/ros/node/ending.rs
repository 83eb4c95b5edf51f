//! When a run with a duration is over.

/// Why it is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ended {
    /// So much model time has passed.
    ModelTime,
    /// Model time has stood still for so long: whoever gives a duration does not wait for ever.
    StandsStill,
}

/// Watches model time against the wall clock.
#[derive(Debug, Clone)]
pub(super) struct Ending {
    duration: f64,
    model_time: f64,
    /// When model time moved last (s, wall).
    moved: f64,
}

impl Ending {
    /// Over after `duration` (s) of model time, or when model time stands still for as long from `wall` (s) on.
    pub(super) fn new(duration: f64, wall: f64) -> Self {
        Self {
            duration,
            model_time: 0.0,
            moved: wall,
        }
    }

    /// Whether it is over at a model time and a wall time (s).
    pub(super) fn look(&mut self, model_time: f64, wall: f64) -> Option<Ended> {
        if model_time != self.model_time {
            (self.model_time, self.moved) = (model_time, wall);
        }
        if model_time >= self.duration {
            Some(Ended::ModelTime)
        } else if wall - self.moved >= self.duration {
            Some(Ended::StandsStill)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn model_time_ends_it_also_where_it_is_slow() {
        let mut ending = Ending::new(10.0, 100.0);
        for second in 0..40 {
            let model_time = 0.25 * f64::from(second);
            assert_eq!(ending.look(model_time, 100.0 + f64::from(second)), None, "{model_time}");
        }
        assert_eq!(ending.look(10.0, 140.0), Some(Ended::ModelTime));
    }

    #[test]
    fn a_clock_that_stands_still_ends_it_by_wall_time() {
        let mut ending = Ending::new(10.0, 100.0);
        assert_eq!(ending.look(0.0, 109.9), None);
        assert_eq!(ending.look(0.0, 110.0), Some(Ended::StandsStill));
        let mut ending = Ending::new(10.0, 100.0);
        assert_eq!(ending.look(4.0, 104.0), None);
        assert_eq!(ending.look(4.0, 113.9), None);
        // A reset is a movement too.
        assert_eq!(ending.look(0.0, 113.95), None);
        assert_eq!(ending.look(0.0, 123.9), None);
        assert_eq!(ending.look(0.0, 123.95), Some(Ended::StandsStill));
    }
}
