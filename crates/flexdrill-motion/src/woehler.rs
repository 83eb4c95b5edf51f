//! Woehler lines (S-N curves): from counted load cycles to a damage with its band.
//!
//! Palmgren and Miner: D = sum n_i / N(S_i). A line is log10 N = a - m log10 S for the stress range S, and below its knee
//! the same with another slope, continuous there. Standards print the design line, two standard deviations of log10 N
//! below the mean; [`Woehler`] has the mean line, whose D is the median.

use serde::{Deserialize, Serialize};

/// Standard deviations from the mean line to the one that standards print.
pub const DESIGN_DEVIATIONS: f64 = 2.0;
/// Standard deviations from the median to 95 % of a normal distribution.
const TO_95_PERCENT: f64 = 1.644_853_626_951_472;
/// Stress range at which the constant of a line is printed (Pa): 1 MPa.
const MEGAPASCAL: f64 = 1e6;

/// The mean line of a class of details.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Woehler {
    /// log10 of the cycles at a stress range of 1 MPa, along the first slope.
    pub log_cycles: f64,
    /// Slope m above the knee.
    pub slope: f64,
    /// Stress range of the knee (Pa); 0 for a line without one.
    pub knee: f64,
    /// Slope below the knee.
    pub slope_below_knee: f64,
    /// Standard deviation of log10 N at a stress range.
    pub scatter: f64,
}

impl Woehler {
    /// The mean line of a printed one without a knee: log10 N = `design` - `slope` log10(S / 1 MPa), two standard deviations
    /// `scatter` below the mean.
    pub fn from_design(design: f64, slope: f64, scatter: f64) -> Self {
        Self {
            log_cycles: design + DESIGN_DEVIATIONS * scatter,
            slope,
            knee: 0.0,
            slope_below_knee: slope,
            scatter,
        }
    }

    /// The line with another slope beyond the stress range at which the printed line has `cycles`.
    #[must_use]
    pub fn with_knee(mut self, cycles: f64, slope: f64) -> Self {
        let design = self.log_cycles - DESIGN_DEVIATIONS * self.scatter;
        self.knee = MEGAPASCAL * libm::pow(10.0, (design - libm::log10(cycles)) / self.slope);
        self.slope_below_knee = slope;
        self
    }

    /// Cycles N of the mean line at a stress range (Pa); infinite at 0.
    pub fn cycles(&self, range: f64) -> f64 {
        libm::pow(10.0, self.log_cycles) / cycle_weight(range / MEGAPASCAL, self.slopes(), self.knee / MEGAPASCAL)
    }

    /// Slopes above and below the knee.
    pub fn slopes(&self) -> [f64; 2] {
        [self.slope, self.slope_below_knee]
    }
}

/// What a cycle of a range counts next to one of range 1, both in the unit of the `knee`: range^m, and below the knee
/// continued with the second slope.
pub fn cycle_weight(range: f64, [slope, below]: [f64; 2], knee: f64) -> f64 {
    if range >= knee {
        libm::pow(range, slope)
    } else {
        libm::pow(knee, slope) * libm::pow(range / knee, below)
    }
}

/// A detail of a joint: its class, and the stress at a moment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Detail {
    /// The mean line of its class.
    pub line: Woehler,
    /// Section modulus (m3) that turns a moment into a nominal stress.
    pub section_modulus: f64,
    /// Stress that the class refers to, over the nominal one.
    pub stress_concentration: f64,
    /// Standard deviation of that factor over the factor.
    pub stress_concentration_scatter: f64,
}

impl Detail {
    /// Stress range (Pa) at a range of the moment (N m).
    pub fn stress(&self, moment: f64) -> f64 {
        self.stress_concentration * moment / self.section_modulus
    }

    /// Range of the moment (N m) at the knee of the class; 0 without one.
    pub fn knee_moment(&self) -> f64 {
        self.line.knee * self.section_modulus / self.stress_concentration
    }

    /// Median damage of cycles that are `counted` as [`cycle_weight`] of their range of moment over `rated_moment` (N m).
    pub fn damage(&self, counted: f64, rated_moment: f64) -> f64 {
        let unit = self.stress(rated_moment) / MEGAPASCAL;
        counted * libm::pow(unit, self.line.slope) / libm::pow(10.0, self.line.log_cycles)
    }

    /// Factor from the median damage to its 95 %; its 5 % is the median over the factor. Endurance and stress
    /// concentration are lognormal and independent, and a factor on the stress is one of its slope's power on the damage.
    /// With a knee the steeper slope counts for all cycles, which bounds the band from outside.
    pub fn band(&self) -> f64 {
        let endurance = std::f64::consts::LN_10 * self.line.scatter;
        let spread = self.stress_concentration_scatter;
        let [slope, below] = self.line.slopes();
        let stress = slope.max(below) * libm::sqrt(libm::log1p(spread * spread));
        libm::exp(TO_95_PERCENT * libm::hypot(endurance, stress))
    }
}
