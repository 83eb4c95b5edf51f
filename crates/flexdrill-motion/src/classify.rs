//! Classification of the motion at a station from its orbit and its spectrum.

use std::f64::consts::TAU;

use super::WhirlKind;
use super::full_spectrum::Lines;
use super::orbit::Orbit;
use super::orbit_window::Round;
use super::settings::WhirlSettings;

/// Turns that an orbit must make in the long window. Half an arc about its own centre appears as up to 0.7 turns, so
/// that fewer turns may be a drift.
const MIN_TURNS: f64 = 0.8;

/// Direction and concentration from which the short window overrules the long one. Over a few turns broad-band motion
/// can appear directed, but not both pure and concentrated on one line.
const CLEAN_DIRECTION: f64 = 0.9;
const CLEAN_CONCENTRATION: f64 = 0.9;

/// Agreement of the two rates from which the orbit counts as one line; the spectrum is accurate to a few percent.
const SINGLE_LINE: f64 = 0.9;

/// Agreement of turns and strongest line from which the line, which is more accurate, determines the rate. The turns of
/// a window of two turns are accurate to a quarter of a turn.
const SAME_RATE: f64 = 0.8;

/// Net share of the turns about the gap's centre from which a motion whose lines have no direction counts as whirl: a
/// pipe thrown from wall to wall moves along chords, whose lines have both directions although every flight runs
/// backward. For broad-band motion over ten swings the share scatters by 0.15 around 0.
const DIRECT: f64 = 0.5;

/// Relative difference to twice the rotary speed within which the joint's cross drives a small orbit.
const TWICE: f64 = 0.1;

/// Both estimators' results for one window.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct View {
    pub(super) orbit: Orbit,
    pub(super) lines: Lines,
    pub(super) round: Round,
    /// Phase rate (rad/s) from the turns about the centre, where the swept area and the strongest line disagree.
    pub(super) turning: Option<f64>,
    /// Correlation of the motion with itself after one, one and a half or two turns of the tool; 0 if not evaluated.
    pub(super) repetition: f64,
    /// Length of the window (s).
    pub(super) duration: f64,
}

impl View {
    fn is_clean(&self, min_axis_ratio: f64) -> bool {
        self.orbit.axis_ratio >= min_axis_ratio
            && self.lines.direction.abs() >= CLEAN_DIRECTION
            && self.lines.concentration >= CLEAN_CONCENTRATION
    }

    /// 1 where the estimators in time and in frequency yield the same rate, 0 where they differ by their own size. In
    /// time the swept area or the turns may agree: for one line both do, for several the turns follow the larger one.
    fn agreement(&self) -> f64 {
        let agree = |time: f64| agreement(time, self.lines.rate);
        agree(self.orbit.rate).max(self.turning.map_or(0.0, agree))
    }

    /// Whether the swept area and the strongest line yield the same rate.
    pub(super) fn is_single_line(&self) -> bool {
        agreement(self.orbit.rate, self.lines.rate) >= SINGLE_LINE
    }

    /// The whirl rate (rad/s). The swept area is exact for a single line. For several lines it is the mean; then the
    /// strongest line is better, unless the counted turns contradict it: the strongest line of chords is not the rate
    /// of their revolution. Turns about the gap's centre count where the motion encloses it.
    fn rate(&self) -> f64 {
        let Some(turning) = self.turning else {
            return self.orbit.rate;
        };
        let turns = if self.round.net.abs() >= MIN_TURNS && self.round.net * self.lines.rate > 0.0 {
            self.round_rate()
        } else {
            turning
        };
        if agreement(turns, self.lines.rate) < SAME_RATE {
            turns
        } else {
            self.lines.rate
        }
    }

    /// Rate (rad/s) of the turns about the gap's centre.
    fn round_rate(&self) -> f64 {
        TAU * self.round.net / self.duration
    }
}

/// Rotation of the tool at the time of the judgement.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rotation {
    /// +1 or -1, the sign of the rotation.
    pub(super) sense: f64,
    /// Magnitude of the mean rotary speed (rad/s); none while the tool stands.
    pub(super) speed: Option<f64>,
}

/// 1 for equal rates, 0 for rates that differ by their own size.
fn agreement(one: f64, other: f64) -> f64 {
    let scale = one.abs().max(other.abs());
    if scale > 0.0 {
        (1.0 - (one - other).abs() / scale).max(0.0)
    } else {
        0.0
    }
}

/// Kind of motion at one station; the sense is that of the station frame (y towards z), not yet that of the rotation.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Verdict {
    pub(super) kind: WhirlKind,
    /// rad/s, positive from y towards z.
    pub(super) rate: f64,
    pub(super) radius: f64,
    pub(super) confidence: f64,
    /// Length of the window behind it (s).
    pub(super) window: f64,
}

/// Thresholds for a station, with hysteresis: staying in a kind requires less than entering it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gates {
    /// RMS radius (m) below which there is no orbit.
    pub(super) radius: f64,
    /// Minor over major axis below which the motion is a line.
    pub(super) axis_ratio: f64,
    direction: f64,
    turns: f64,
    /// RMS radius (m) from which a motion counts as whirl although it does not go round the gap's centre.
    large: f64,
    direct: f64,
    twice: f64,
    repetition: f64,
    out_of_chaos: bool,
}

impl Gates {
    /// Thresholds for a gap of `clearance` (m); `previous` is the present kind.
    pub(super) fn new(clearance: f64, previous: WhirlKind, settings: &WhirlSettings) -> Self {
        let leaving = 1.0 - settings.hysteresis;
        let when = |stands: bool| if stands { leaving } else { 1.0 };
        let orbits = when(previous != WhirlKind::None);
        let whirls = when(matches!(previous, WhirlKind::Forward | WhirlKind::Backward));
        let vibrates = previous == WhirlKind::JointVibration;
        let is_large = when(!matches!(previous, WhirlKind::None | WhirlKind::JointVibration));
        Self {
            radius: settings.min_orbit_ratio * clearance * orbits,
            axis_ratio: settings.min_axis_ratio * orbits,
            direction: settings.steady_direction * whirls,
            turns: MIN_TURNS * whirls,
            large: settings.large_orbit_ratio * clearance * is_large,
            direct: DIRECT * whirls,
            twice: TWICE * if vibrates { 1.0 + settings.hysteresis } else { 1.0 },
            repetition: settings.min_repetition * when(previous == WhirlKind::None),
            out_of_chaos: previous == WhirlKind::Chaotic,
        }
    }

    /// Whether the direction is steady enough for a whirl.
    pub(super) fn is_directed(&self, lines: &Lines) -> bool {
        lines.direction.abs() >= self.direction
    }

    /// Whether the motion encloses the gap's centre, or is so large that the position of its centre is irrelevant.
    fn goes_round(&self, view: &View) -> bool {
        view.round.net.abs() >= self.turns || view.orbit.radius >= self.large
    }

    /// Whether the flights from wall to wall revolve in one direction, whatever the lines of their chords.
    fn is_thrown_round(&self, round: &Round) -> bool {
        round.net.abs() >= self.turns && round.directness() >= self.direct
    }

    /// Whether a rate (rad/s) is twice that of the tool.
    fn is_twice(&self, rate: f64, speed: f64) -> bool {
        (rate.abs() - 2.0 * speed).abs() <= self.twice * 2.0 * speed
    }
}

/// Names the motion of a station.
pub(super) fn judge(long: &View, short: Option<&View>, gates: &Gates, rotation: &Rotation) -> Verdict {
    // Three cases in which the long window decides: after chaos, a few turns of which resemble one whirl by chance; for
    // a motion that repeats itself without revolving, whose parts do so too; and where the short window would take a
    // large slow line for the drift of a small fast one.
    let is_part = |short: &View| gates.goes_round(long) && !gates.goes_round(short);
    let long_leads = gates.out_of_chaos || long.repetition >= gates.repetition || short.is_some_and(is_part);
    let view = match short {
        Some(view) if view.is_clean(gates.axis_ratio) && !long_leads => view,
        _ => long,
    };
    let verdict = |kind, rate, confidence: f64| Verdict {
        kind,
        rate,
        radius: view.orbit.radius,
        confidence: confidence.clamp(0.0, 1.0),
        window: view.duration,
    };
    // The short window is the first to show that an orbit has decayed.
    let radius = short
        .map_or(f64::MAX, |short| short.orbit.radius)
        .min(long.orbit.radius);
    if radius < gates.radius {
        return Verdict {
            radius,
            ..verdict(WhirlKind::None, 0.0, 1.0 - 0.5 * radius / gates.radius)
        };
    }
    // A flat orbit is a vibration along a line: it has no direction of
    // rotation, and the sign of its rate would be noise.
    if view.orbit.axis_ratio < gates.axis_ratio {
        let confidence = 1.0 - 0.5 * view.orbit.axis_ratio / gates.axis_ratio;
        return verdict(WhirlKind::None, 0.0, confidence);
    }
    // Forward is the direction of the drive, whichever way that turns.
    let direction = view.lines.direction;
    let whirl = |rate: f64, confidence: f64| {
        let kind = if rate * rotation.sense > 0.0 {
            WhirlKind::Forward
        } else {
            WhirlKind::Backward
        };
        verdict(kind, rate, confidence)
    };
    // An orbit that does not go around the axis is no whirl. At twice the
    // speed and with a direction it is the joints' own ripple.
    if !gates.goes_round(view) {
        let directed = gates.is_directed(&view.lines);
        return match rotation.speed {
            Some(speed) if directed && gates.is_twice(view.rate(), speed) => {
                verdict(WhirlKind::JointVibration, view.rate(), view.agreement())
            }
            _ => verdict(WhirlKind::None, 0.0, 1.0 - 0.5 * view.orbit.radius / gates.large),
        };
    }
    // Energy in both directions alike: either chaos, or a pipe that is
    // carried round by its impacts and is whirl only over the long window.
    if !gates.is_directed(&view.lines) {
        if gates.is_thrown_round(&long.round) {
            return Verdict {
                window: long.duration,
                ..whirl(long.round_rate(), long.round.directness())
            };
        }
        // A pipe that rocks up both sides of the hole, or repeats the same throw at every turn, has no direction
        // either, but its motion is not chaotic.
        return if view.repetition >= gates.repetition {
            verdict(WhirlKind::None, 0.0, view.repetition)
        } else {
            let confidence = 1.0 - 0.5 * direction.abs() / gates.direction;
            verdict(WhirlKind::Chaotic, 0.0, confidence)
        };
    }
    // With too few turns in the window the direction is not reliable, and half the confidence says that.
    if view.orbit.rate.abs().max(view.lines.rate.abs()) * view.duration < gates.turns * TAU {
        return verdict(WhirlKind::None, 0.0, 0.5);
    }
    // The sign is that of the lines: noise can hide the sign of the turns.
    let rate = view.rate().copysign(direction);
    whirl(rate, direction.abs() * view.agreement())
}
