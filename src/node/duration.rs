//! The end of a run that has a duration.

/// Why a run is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ended {
    /// Model time has reached the duration.
    ModelTime,
    /// Model time has stood still for as long as the duration, so that a run with a duration always ends.
    StandsStill,
}

/// Compares model time with the duration, and with the wall clock where it stands still.
#[derive(Debug, Clone)]
pub(super) struct DurationWatch {
    duration: f64,
    model_time: f64,
    /// Wall time of the last change of model time (s).
    moved: f64,
}

impl DurationWatch {
    /// A watch from the wall time `wall` (s) on, with a duration in s.
    pub(super) fn new(duration: f64, wall: f64) -> Self {
        Self {
            duration,
            model_time: 0.0,
            moved: wall,
        }
    }

    /// Whether and why the run is over at a model time and a wall time (s).
    pub(super) fn update(&mut self, model_time: f64, wall: f64) -> Option<Ended> {
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
        let mut watch = DurationWatch::new(10.0, 100.0);
        for second in 0..40 {
            let model_time = 0.25 * f64::from(second);
            assert_eq!(
                watch.update(model_time, 100.0 + f64::from(second)),
                None,
                "{model_time}"
            );
        }
        assert_eq!(watch.update(10.0, 140.0), Some(Ended::ModelTime));
    }

    #[test]
    fn a_clock_that_stands_still_ends_it_by_wall_time() {
        let mut watch = DurationWatch::new(10.0, 100.0);
        assert_eq!(watch.update(0.0, 109.9), None);
        assert_eq!(watch.update(0.0, 110.0), Some(Ended::StandsStill));
        let mut watch = DurationWatch::new(10.0, 100.0);
        assert_eq!(watch.update(4.0, 104.0), None);
        assert_eq!(watch.update(4.0, 113.9), None);
        // A reset is a movement too.
        assert_eq!(watch.update(0.0, 113.95), None);
        assert_eq!(watch.update(0.0, 123.9), None);
        assert_eq!(watch.update(0.0, 123.95), Some(Ended::StandsStill));
    }
}
