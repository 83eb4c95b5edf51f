//! `rig/survey` in the node: the surveys of the hole that are known, and the counts of what was refused. The tool that measures
//! sits above the bit, and its surveys come when a pump stops: they are late, come in any order, and are repeated.

#[cfg(test)]
mod tests;

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::sync::Arc;

use super::measured::NO_STAMP;
use super::time_zone::TimeZone;
use flexdrill_config::Config;
use flexdrill_core::units::rad_to_deg;
use flexdrill_hole::{Survey, USUAL_INCLINATION_DEVIATION, usual_azimuth_deviation};
use flexdrill_messages::RigSurvey;
use flexdrill_text::six_digits;

/// Surveys that are kept, those deepest in the hole: a message has all of them, and more than 20 m above the bit they say
/// nothing of the tool any more.
const MOST: usize = 200;
/// Depths nearer than this (m) are the same survey: rigs round to a centimetre.
const SAME_DEPTH: f64 = 0.01;

/// Why a survey was refused.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurveyRefused {
    /// The source does not consider the values correct.
    Quality {
        /// The code.
        quality: u8,
    },
    /// It does not state when it was measured: its stamp is 0.
    NoStamp,
    /// Its stamp is ahead of the clock.
    Ahead {
        /// By how much (s).
        ahead: f64,
        /// The most that is accepted (s).
        most: f64,
    },
    /// An angle is out of its bounds.
    Angle {
        /// Field of the message.
        field: &'static str,
        /// The value (rad).
        value: f64,
        /// What is allowed.
        bound: &'static str,
    },
    /// It lies outside the hole of the configuration.
    Depth {
        /// Measured depth as the rig counts it (m).
        depth: f64,
        /// Measured depth of the kick-off and of the bit, as the rig counts them (m).
        hole: [f64; 2],
    },
    /// A newer survey of its source at this depth came before.
    Older {
        /// Measured depth as the rig counts it (m).
        depth: f64,
        /// By how much its stamp is older (s).
        by: f64,
    },
}

impl SurveyRefused {
    /// A number per reason, for the limits of log lines.
    pub const fn index(&self) -> usize {
        match self {
            Self::Quality { .. } => 0,
            Self::NoStamp => 1,
            Self::Ahead { .. } => 2,
            Self::Angle { .. } => 3,
            Self::Depth { .. } => 4,
            Self::Older { .. } => 5,
        }
    }
}

impl fmt::Display for SurveyRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("rig/survey: a survey was refused: ")?;
        match *self {
            Self::Quality { quality } => write!(
                f,
                "its source does not consider it correct (quality {quality}, must be {}): send it again once it is checked",
                RigSurvey::GOOD
            ),
            Self::NoStamp => f.write_str(
                "its stamp is 0, so that its age is not known; set header.stamp to the time of the measurement",
            ),
            Self::Ahead { ahead, most } => {
                write!(
                    f,
                    "its stamp is {ahead:.3} s ahead of the clock, at most {most} s are accepted; "
                )?;
                match TimeZone::ahead(ahead) {
                    Some(zone) => write!(f, "{zone}"),
                    None => f.write_str("synchronise the clocks"),
                }
            }
            Self::Angle { field, value, bound } => write!(
                f,
                "{field} = {} rad ({} deg): must be {bound}; check the unit, which is rad",
                six_digits(value),
                six_digits(rad_to_deg(value))
            ),
            Self::Depth {
                depth,
                hole: [kick_off, bit],
            } => write!(
                f,
                "measured_depth = {depth:.2} m: must be {kick_off:.2} m, the kick-off (well.kick_off_depth), to {bit:.2} m, the \
                 bit, where well.sections ends; correct the depth, or well.sections to the hole as drilled"
            ),
            Self::Older { depth, by } => write!(
                f,
                "its source has sent one for {depth:.2} m whose stamp is {by:.3} s newer"
            ),
        }
    }
}

/// A survey with what its message says of it.
#[derive(Debug, Clone, PartialEq)]
struct Held {
    survey: Survey,
    /// ns since 1970, on the clock of the stamps.
    stamp: i64,
    source: String,
}

/// The surveys that are known.
#[derive(Debug, Clone, Default)]
pub struct Surveys {
    /// Measured depths of kick-off and bit, as the rig counts them (m).
    hole: [f64; 2],
    held: Vec<Held>,
    known: Arc<[Survey]>,
    received: u64,
    refused: u64,
    unreadable: u64,
    overrun: u64,
    newest_refusal: Option<SurveyRefused>,
}

impl Surveys {
    /// None yet, for the hole of a configuration.
    pub fn new(config: &Config) -> Self {
        let kick_off = config.well.kick_off_depth;
        Self {
            hole: [kick_off, kick_off + config.well.length()],
            ..Self::default()
        }
    }

    /// Accepts a survey. `now` is the present instant of the stamps (ns), `max_skew` how far ahead of it a stamp may be (s). One
    /// that is known already changes nothing.
    ///
    /// # Errors
    /// Why it is refused; the surveys are then as before.
    pub fn accept(&mut self, message: &RigSurvey, now: i64, max_skew: f64) -> Result<(), SurveyRefused> {
        self.received += 1;
        self.judge(message, now, max_skew).inspect_err(|refused| {
            self.refused += 1;
            self.newest_refusal = Some(*refused);
        })
    }

    fn judge(&mut self, message: &RigSurvey, now: i64, max_skew: f64) -> Result<(), SurveyRefused> {
        if message.quality != RigSurvey::GOOD {
            return Err(SurveyRefused::Quality {
                quality: message.quality,
            });
        }
        let stamp = message.header.stamp.to_nanoseconds();
        if stamp == 0 && now > NO_STAMP {
            return Err(SurveyRefused::NoStamp);
        }
        let ahead = stamp.saturating_sub(now) as f64 * 1e-9;
        if ahead > max_skew {
            return Err(SurveyRefused::Ahead { ahead, most: max_skew });
        }
        let held = Held {
            survey: self.survey(message)?,
            stamp,
            source: message.source.clone(),
        };
        self.keep(held, message.measured_depth)
    }

    /// The survey of a message, from the kick-off.
    fn survey(&self, message: &RigSurvey) -> Result<Survey, SurveyRefused> {
        let angle = |field, value: f64, range: std::ops::RangeInclusive<f64>, bound| {
            // No range contains NaN.
            if range.contains(&value) {
                Ok(value)
            } else {
                Err(SurveyRefused::Angle { field, value, bound })
            }
        };
        // A sender that does not know a field leaves it at 0.
        let deviation = |field, value: f64, usual: f64| {
            if value.is_nan() || value == 0.0 {
                return Ok(usual);
            }
            angle(
                field,
                value,
                f64::MIN_POSITIVE..=PI,
                "above 0 and at most pi, or NaN for the usual one",
            )
        };
        let [kick_off, bit] = self.hole;
        let depth = message.measured_depth;
        // Within rounding the bit itself has a survey.
        if !(kick_off - SAME_DEPTH..=bit + SAME_DEPTH).contains(&depth) {
            return Err(SurveyRefused::Depth { depth, hole: self.hole });
        }
        let depth = depth.clamp(kick_off, bit) - kick_off;
        let inclination = angle("inclination", message.inclination, 0.0..=PI, "0 to pi")?;
        let usual = USUAL_INCLINATION_DEVIATION;
        let inclination_deviation = deviation("inclination_deviation", message.inclination_deviation, usual)?;
        let azimuth = if message.azimuth.is_nan() {
            None
        } else {
            let azimuth = angle("azimuth", message.azimuth, -TAU..=TAU, "-2 pi to 2 pi, or NaN for none")?;
            let usual = usual_azimuth_deviation(depth);
            Some([
                azimuth,
                deviation("azimuth_deviation", message.azimuth_deviation, usual)?,
            ])
        };
        Ok(Survey {
            depth,
            inclination,
            inclination_deviation,
            azimuth,
        })
    }

    /// Keeps a survey, in place of an older one of its source at this depth.
    fn keep(&mut self, new: Held, depth: f64) -> Result<(), SurveyRefused> {
        let same = |held: &Held| held.source == new.source && (held.survey.depth - new.survey.depth).abs() < SAME_DEPTH;
        match self.held.iter().position(same) {
            Some(index) if self.held[index].survey == new.survey => return Ok(()),
            Some(index) if self.held[index].stamp > new.stamp => {
                return Err(SurveyRefused::Older {
                    depth,
                    by: (self.held[index].stamp - new.stamp) as f64 * 1e-9,
                });
            }
            Some(index) => self.held[index] = new,
            None => self.held.push(new),
        }
        if self.held.len() > MOST {
            let depths = self.held.iter().map(|held| held.survey.depth).enumerate();
            if let Some((highest, _)) = depths.min_by(|(_, a), (_, b)| a.total_cmp(b)) {
                self.held.remove(highest);
            }
        }
        self.known = self.held.iter().map(|held| held.survey).collect();
        Ok(())
    }

    /// The surveys that are known, in the order of arrival.
    pub fn known(&self) -> Arc<[Survey]> {
        Arc::clone(&self.known)
    }

    /// Messages received, messages refused, messages whose bytes could not be read, and messages dropped unread.
    pub const fn counts(&self) -> [u64; 4] {
        [self.received, self.refused, self.unreadable, self.overrun]
    }

    /// Why the newest refused survey was refused, since the start.
    pub const fn newest_refusal(&self) -> Option<SurveyRefused> {
        self.newest_refusal
    }

    /// Counts a message whose bytes could not be read.
    pub const fn count_unreadable(&mut self) {
        self.unreadable += 1;
    }

    /// Counts messages that were dropped unread because they came faster than the node reads them.
    pub const fn count_overrun(&mut self, messages: u64) {
        self.overrun += messages;
    }
}
