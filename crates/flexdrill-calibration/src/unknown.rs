//! What is fitted, with its prior.

use crate::{BAND, CalibrationError};

/// Shape of a prior.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Normal: an offset, which may have either sign.
    Normal,
    /// Its logarithm is normal: a coefficient, which is positive.
    LogNormal,
}

/// An unknown with its prior. The standardised value z of the unknown has the prior N(0, 1).
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Name in words.
    pub name: String,
    /// Unit of its value; empty for a coefficient.
    pub unit: &'static str,
    shape: Shape,
    low: f64,
    high: f64,
}

impl Unknown {
    /// An unknown of which the prior gives 90 % to the range from `low` to `high`.
    ///
    /// # Errors
    /// When the range is empty or not finite, or a coefficient's is not positive.
    pub fn new(name: &str, unit: &'static str, shape: Shape, [low, high]: [f64; 2]) -> Result<Self, CalibrationError> {
        let wrong = |what, value, bound| Err(CalibrationError::Number { what, value, bound });
        if !(low.is_finite() && high.is_finite() && high > low) {
            return wrong("the upper end of a prior", high, "finite and above the lower end");
        }
        if shape == Shape::LogNormal && low <= 0.0 {
            return wrong("the lower end of a coefficient's prior", low, "above 0");
        }
        Ok(Self {
            name: name.to_owned(),
            unit,
            shape,
            low,
            high,
        })
    }

    /// Ends of the prior's 90 %.
    pub fn prior(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Shape of the prior.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The value at a standardised value: 0 is the prior's median.
    pub fn value(&self, z: f64) -> f64 {
        let [low, high] = self.scaled();
        let middle = 0.5 * (low + high);
        let deviation = 0.5 * (high - low) / BAND;
        match self.shape {
            Shape::Normal => middle + deviation * z,
            Shape::LogNormal => libm::exp(middle + deviation * z),
        }
    }

    /// The standardised value of a value; of a coefficient that is not positive it is not a number.
    pub fn standard(&self, value: f64) -> f64 {
        let [low, high] = self.scaled();
        let scaled = match self.shape {
            Shape::Normal => value,
            Shape::LogNormal => libm::log(value),
        };
        BAND * (2.0 * scaled - low - high) / (high - low)
    }

    fn scaled(&self) -> [f64; 2] {
        match self.shape {
            Shape::Normal => [self.low, self.high],
            Shape::LogNormal => [libm::log(self.low), libm::log(self.high)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_prior_has_its_quantiles_and_the_way_back_is_exact() {
        let friction = Unknown::new("friction", "", Shape::LogNormal, [0.25, 0.40]).unwrap();
        for (z, value) in [(-BAND, 0.25), (BAND, 0.40), (0.0, (0.25_f64 * 0.40).sqrt())] {
            // Rounding of a logarithm and an exponential.
            assert!((friction.value(z) - value).abs() < 1e-15 * 10.0);
            assert!((friction.standard(value) - z).abs() < 1e-13);
        }
        let tare = Unknown::new("tare", "N m", Shape::Normal, [-50.0, 50.0]).unwrap();
        assert_eq!(tare.value(0.0), 0.0);
        assert!((tare.standard(tare.value(-1.7)) + 1.7).abs() < 1e-14);
        assert!(Unknown::new("x", "", Shape::LogNormal, [0.0, 1.0]).is_err());
        assert!(Unknown::new("x", "", Shape::Normal, [1.0, 1.0]).is_err());
        assert!(Unknown::new("x", "", Shape::Normal, [f64::NAN, 1.0]).is_err());
    }
}
