//! What sensors show of a figure: reading = factor x truth + tare.

/// Least weight (N) that acts while the bit drills, whatever the indicator's errors are: below it the bit counts as off
/// bottom ([`crate::windows::WindowSettings::off_bottom`]), and a log that drills is none of that.
pub const LEAST_WEIGHT: f64 = 1e3;

/// The errors of a sensor: which unknowns they are, if any.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sensor {
    /// Unknown of the factor; 1 where there is none.
    pub factor: Option<usize>,
    /// Unknown of the tare; 0 where there is none.
    pub tare: Option<usize>,
    /// Figure (SI) at which the tare is stated, and about which the factor acts. For a hook load whose factor is that of the
    /// weight indicator it is the load while the tool hangs, which the tare belongs to.
    pub about: f64,
}

impl Sensor {
    /// What it shows of a figure, where `of` has the values of the unknowns.
    pub fn shows(&self, figure: f64, of: impl Fn(usize) -> f64) -> f64 {
        let factor = self.factor.map_or(1.0, &of);
        self.about + factor * (figure - self.about) + self.tare.map_or(0.0, &of)
    }

    /// What acts where it shows a weight (N), at least [`LEAST_WEIGHT`].
    pub fn acting(&self, shown: f64, of: impl Fn(usize) -> f64) -> f64 {
        let factor = self.factor.map_or(1.0, &of);
        let tare = self.tare.map_or(0.0, &of);
        // A factor is near 1; a member of an ensemble that is not must not turn the weight round.
        let truth = self.about + (shown - self.about - tare) / factor.max(0.1);
        truth.max(LEAST_WEIGHT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_is_what_shows_it() {
        let sensor = Sensor {
            factor: Some(0),
            tare: Some(1),
            about: 0.0,
        };
        let of = |unknown: usize| [1.03, 500.0][unknown];
        assert_eq!(sensor.shows(10e3, of), 10.8e3);
        assert!((sensor.acting(10.8e3, of) - 10e3).abs() < 1e-9);
        assert_eq!(sensor.acting(1.2e3, of), LEAST_WEIGHT);
        // About the load of hanging the factor changes nothing.
        let hook = Sensor { about: 60e3, ..sensor };
        assert_eq!(hook.shows(60e3, of), 60.5e3);
        assert!((hook.shows(50e3, of) - (60.5e3 - 10.3e3)).abs() < 1e-9);
        assert_eq!(Sensor::default().shows(7.0, of), 7.0);
    }
}
