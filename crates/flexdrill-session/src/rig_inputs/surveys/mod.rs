//! `rig/survey` in the node: the surveys of the hole that are known, and the counts of what was refused. The tool that measures
//! sits above the bit, and its surveys come when a pump stops: they are late, come in any order, and are repeated. What is known
//! outlasts a restart (`kept`).

mod kept;
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

pub use kept::{KeptSurveys, OfHole};

/// Surveys that are kept, those deepest in the hole: a message has all of them, and more than 20 m above the bit they say
/// nothing of the tool any more.
const MOST: usize = 200;
/// Depths nearer than this (m) are the same survey: rigs round to a centimetre.
const SAME_DEPTH: f64 = 0.01;
/// How far below the bit of the configuration (m) a survey waits for a run with that hole: a rig drills some metres between two
/// runs. Farther down it is of another hole, or in another unit.
const AHEAD: f64 = 50.0;
/// Characters of a source that are kept.
const LONGEST_SOURCE: usize = 64;

/// What became of a survey.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Taken {
    /// It is known now.
    New,
    /// It was known, and changed nothing.
    Known,
    /// It lies below the bit of the configuration, and is kept for a run with that hole. Measured depths of the survey and of
    /// the bit, as the rig counts them (m).
    Waits {
        /// Of the survey.
        depth: f64,
        /// Of the bit.
        bit: f64,
    },
}

impl Taken {
    /// What the operator does about it; none where nothing is to be done.
    pub fn advice(self) -> Option<String> {
        match self {
            Self::New | Self::Known => None,
            Self::Waits { depth, bit } => Some(format!(
                "rig/survey: a survey at {depth:.2} m waits: the hole of the configuration ends at {bit:.2} m. A run with the hole \
                 as drilled uses it (flexdrill rebase)"
            )),
        }
    }
}

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
            // A difference of whole hours is a time zone, which has another cure than a clock that is off.
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
            // In degrees too: a value that makes sense there was sent in them.
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
                "measured_depth = {depth:.2} m: must be {kick_off:.2} m, the kick-off (well.kick_off_depth), to {:.2} m, {AHEAD} m \
                 below the bit, where well.sections ends; correct the depth or well.kick_off_depth",
                bit + AHEAD
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
    /// As the rig counts it (m).
    measured_depth: f64,
    /// ns since 1970, on the clock of the stamps.
    stamp: i64,
    source: String,
    /// It came in an earlier run of the node.
    is_earlier: bool,
}

/// Counts of surveys, for the diagnostics.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SurveyCounts {
    /// Messages received.
    pub received: u64,
    /// Messages refused.
    pub refused: u64,
    /// Messages whose bytes could not be read.
    pub unreadable: u64,
    /// Messages dropped unread, because they came faster than the node reads them.
    pub overrun: u64,
    /// Surveys that came after a deeper one.
    pub late: u64,
    /// Surveys that are known.
    pub known: u64,
    /// Those of them that came in an earlier run of the node.
    pub earlier: u64,
    /// Surveys below the bit of the configuration.
    pub waiting: u64,
    /// Measured depth of the deepest known survey, as the rig counts it (m); none without one.
    pub deepest: Option<f64>,
    /// Stamp of the newest survey that is known or waits (ns since 1970); none without one.
    pub newest: Option<i64>,
}

/// What became of the surveys of an earlier run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Restored {
    /// Surveys that are known.
    pub known: usize,
    /// Surveys below the bit of the configuration.
    pub waiting: usize,
    /// Surveys outside the hole, or with values out of bounds.
    pub left_out: usize,
}

/// The surveys that are known.
#[derive(Debug, Clone, Default)]
pub struct Surveys {
    of: Arc<OfHole>,
    /// Measured depths of kick-off and bit, as the rig counts them (m).
    hole: [f64; 2],
    held: Vec<Held>,
    /// Those below the bit.
    waiting: Vec<Held>,
    known: Arc<[Survey]>,
    received: u64,
    refused: u64,
    unreadable: u64,
    overrun: u64,
    late: u64,
    newest_refusal: Option<SurveyRefused>,
}

impl Surveys {
    /// None yet, for the hole of a configuration.
    pub fn new(config: &Config) -> Self {
        let kick_off = config.well.kick_off_depth;
        Self {
            of: Arc::new(OfHole::new(config)),
            hole: [kick_off, kick_off + config.well.length()],
            ..Self::default()
        }
    }

    /// Accepts a survey. `now` is the present instant of the stamps (ns), `max_skew` how far ahead of it a stamp may be (s). One
    /// that is known already changes nothing.
    ///
    /// # Errors
    /// Why it is refused; the surveys are then as before.
    pub fn accept(&mut self, message: &RigSurvey, now: i64, max_skew: f64) -> Result<Taken, SurveyRefused> {
        self.received += 1;
        self.judge(message, now, max_skew).inspect_err(|refused| {
            self.refused += 1;
            self.newest_refusal = Some(*refused);
        })
    }

    fn judge(&mut self, message: &RigSurvey, now: i64, max_skew: f64) -> Result<Taken, SurveyRefused> {
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
        // A sender that does not know a field leaves it at 0.
        let deviation = |value: f64, usual: f64| if value.is_nan() || value == 0.0 { usual } else { value };
        let kick_off = self.hole[0];
        let usual = usual_azimuth_deviation(message.measured_depth - kick_off);
        let given = |azimuth: f64| [azimuth, deviation(message.azimuth_deviation, usual)];
        let held = Held {
            survey: Survey {
                depth: message.measured_depth - kick_off,
                inclination: message.inclination,
                inclination_deviation: deviation(message.inclination_deviation, USUAL_INCLINATION_DEVIATION),
                azimuth: (!message.azimuth.is_nan()).then(|| given(message.azimuth)),
            },
            measured_depth: message.measured_depth,
            stamp,
            source: message.source.chars().take(LONGEST_SOURCE).collect(),
            is_earlier: false,
        };
        let latest = now.saturating_add((max_skew * 1e9) as i64);
        self.hold(held, latest)
    }

    /// Keeps a survey within the bounds, of stamps up to an instant (ns).
    fn hold(&mut self, mut new: Held, latest: i64) -> Result<Taken, SurveyRefused> {
        let (depth, [kick_off, bit]) = (new.measured_depth, self.hole);
        // No range contains NaN. Within rounding the ends of the hole have a survey.
        if !(kick_off - SAME_DEPTH..=bit + AHEAD).contains(&depth) {
            return Err(SurveyRefused::Depth { depth, hole: self.hole });
        }
        check_angles(&new.survey)?;
        if depth > bit + SAME_DEPTH {
            keep(&mut self.waiting, new, latest)?;
            return Ok(Taken::Waits { depth, bit });
        }
        new.survey.depth = depth.clamp(kick_off, bit) - kick_off;
        let at = new.survey.depth;
        let is_late = self.held.iter().any(|held| held.survey.depth > at + SAME_DEPTH);
        if !keep(&mut self.held, new, latest)? {
            return Ok(Taken::Known);
        }
        self.late += u64::from(is_late);
        self.known = self.held.iter().map(|held| held.survey).collect();
        Ok(Taken::New)
    }

    /// Takes the surveys of an earlier run; none where they are of another hole.
    pub fn restore(&mut self, kept: &KeptSurveys) -> Option<Restored> {
        if !self.of.holds(&kept.of) {
            return None;
        }
        let mut restored = Restored::default();
        let late = self.late;
        for held in kept.held(self.hole[0]) {
            match self.hold(held, i64::MAX) {
                Ok(Taken::New | Taken::Known) => restored.known += 1,
                Ok(Taken::Waits { .. }) => restored.waiting += 1,
                Err(_) => restored.left_out += 1,
            }
        }
        self.late = late;
        Some(restored)
    }

    /// What outlasts a restart.
    pub fn kept(&self) -> KeptSurveys {
        KeptSurveys::new(self.of.as_ref().clone(), self.held.iter().chain(&self.waiting))
    }

    /// The surveys that are known, in the order of arrival.
    pub fn known(&self) -> Arc<[Survey]> {
        Arc::clone(&self.known)
    }

    /// Counts of what came, and what is known.
    pub fn counts(&self) -> SurveyCounts {
        let count = |count: usize| count as u64;
        let all = || self.held.iter().chain(&self.waiting);
        let depths = self.held.iter().map(|held| held.measured_depth);
        SurveyCounts {
            received: self.received,
            refused: self.refused,
            unreadable: self.unreadable,
            overrun: self.overrun,
            late: self.late,
            known: count(self.held.len()),
            earlier: count(self.held.iter().filter(|held| held.is_earlier).count()),
            waiting: count(self.waiting.len()),
            deepest: depths.reduce(f64::max),
            newest: all().map(|held| held.stamp).max(),
        }
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

/// # Errors
/// When an angle of a survey is out of its bounds.
fn check_angles(survey: &Survey) -> Result<(), SurveyRefused> {
    let within = |field, value: f64, range: std::ops::RangeInclusive<f64>, bound| {
        // No range contains NaN.
        if range.contains(&value) {
            Ok(())
        } else {
            Err(SurveyRefused::Angle { field, value, bound })
        }
    };
    let deviation = |field, value| {
        let bound = "above 0 and at most pi, or NaN for the usual one";
        within(field, value, f64::MIN_POSITIVE..=PI, bound)
    };
    within("inclination", survey.inclination, 0.0..=PI, "0 to pi")?;
    deviation("inclination_deviation", survey.inclination_deviation)?;
    if let Some([azimuth, azimuth_deviation]) = survey.azimuth {
        within("azimuth", azimuth, -TAU..=TAU, "-2 pi to 2 pi, or NaN for none")?;
        deviation("azimuth_deviation", azimuth_deviation)?;
    }
    Ok(())
}

/// Keeps a survey, in place of an older one of its source at this depth. False where it was there. No stamp is after `latest`
/// (ns since 1970).
///
/// # Errors
/// When a newer one of its source at this depth is there.
fn keep(list: &mut Vec<Held>, new: Held, latest: i64) -> Result<bool, SurveyRefused> {
    let same = |held: &Held| held.source == new.source && (held.measured_depth - new.measured_depth).abs() < SAME_DEPTH;
    match list.iter().position(same) {
        Some(index) if list[index].survey == new.survey => return Ok(false),
        // A stamp after the latest is of a clock that has begun again since, as a simulated one does.
        Some(index) if list[index].stamp > new.stamp && list[index].stamp <= latest => {
            return Err(SurveyRefused::Older {
                depth: new.measured_depth,
                by: (list[index].stamp - new.stamp) as f64 * 1e-9,
            });
        }
        Some(index) => list[index] = new,
        None => list.push(new),
    }
    if list.len() > MOST {
        let depths = list.iter().map(|held| held.survey.depth).enumerate();
        if let Some((highest, _)) = depths.min_by(|(_, a), (_, b)| a.total_cmp(b)) {
            list.remove(highest);
        }
    }
    Ok(true)
}
