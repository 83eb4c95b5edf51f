//! From orbit and spectrum to a kind of whirl.

use std::f64::consts::TAU;

use super::WhirlKind;
use super::full_spectrum::Lines;
use super::orbit::Orbit;
use super::settings::WhirlSettings;

/// Turns that an orbit must make in the long window; half an arc about its own centre looks like up to 0.7 turns, so
/// anything less may be a drift.
const MIN_TURNS: f64 = 0.8;

/// What the short window must reach in direction and concentration to overrule the long one. Broad-band motion looks
/// directed over a few turns, but not both pure and on one line.
const CLEAN_DIRECTION: f64 = 0.9;
const CLEAN_CONCENTRATION: f64 = 0.9;

/// Agreement of the two rates from which the orbit counts as one line; the spectrum alone is good for a few percent.
const SINGLE_LINE: f64 = 0.9;

/// Both estimators' results for one window.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct View {
    pub(super) orbit: Orbit,
    pub(super) lines: Lines,
    /// s.
    pub(super) duration: f64,
}

impl View {
    fn is_clean(&self, settings: &WhirlSettings) -> bool {
        self.orbit.axis_ratio >= settings.min_axis_ratio
            && self.lines.direction.abs() >= CLEAN_DIRECTION
            && self.lines.concentration >= CLEAN_CONCENTRATION
    }

    /// 1 when the rates of both estimators are equal, 0 when they differ by their own size.
    fn agreement(&self) -> f64 {
        let (time, spectrum) = (self.orbit.rate, self.lines.rate);
        let scale = time.abs().max(spectrum.abs());
        if scale > 0.0 {
            (1.0 - (time - spectrum).abs() / scale).max(0.0)
        } else {
            0.0
        }
    }
}

/// Kind of motion at one place; the sense is that of the station frame (y towards z), not yet that of the rotation.
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

/// `sense` is +1 or -1, the sign of the rotation; `previous` is the kind that stands, for the hysteresis.
pub(super) fn judge(
    long: &View,
    short: Option<&View>,
    clearance: f64,
    sense: f64,
    previous: WhirlKind,
    settings: &WhirlSettings,
) -> Verdict {
    let leaving = 1.0 - settings.hysteresis;
    let view = match short {
        // Out of chaos only the long window leads: by chance a few turns of it look like one whirl.
        Some(view) if view.is_clean(settings) && previous != WhirlKind::Chaotic => view,
        _ => long,
    };
    let verdict = |kind, rate, confidence: f64| Verdict {
        kind,
        rate,
        radius: view.orbit.radius,
        confidence: confidence.clamp(0.0, 1.0),
        window: view.duration,
    };
    let factor = if previous == WhirlKind::None { 1.0 } else { leaving };
    let smallest = settings.min_orbit_ratio * clearance * factor;
    // The short window knows first that an orbit has died down.
    let radius = short
        .map_or(f64::MAX, |short| short.orbit.radius)
        .min(long.orbit.radius);
    if radius < smallest {
        return Verdict {
            radius,
            ..verdict(WhirlKind::None, 0.0, 1.0 - 0.5 * radius / smallest)
        };
    }
    if view.orbit.axis_ratio < settings.min_axis_ratio {
        return verdict(
            WhirlKind::None,
            0.0,
            1.0 - 0.5 * view.orbit.axis_ratio / settings.min_axis_ratio,
        );
    }
    let direction = view.lines.direction;
    let stands = matches!(previous, WhirlKind::Forward | WhirlKind::Backward);
    let steady = settings.steady_direction * if stands { leaving } else { 1.0 };
    if direction.abs() < steady {
        return verdict(WhirlKind::Chaotic, 0.0, 1.0 - 0.5 * direction.abs() / steady);
    }
    if view.orbit.rate.abs().max(view.lines.rate.abs()) * view.duration < MIN_TURNS * TAU {
        return verdict(WhirlKind::None, 0.0, 0.5);
    }
    let kind = if direction * sense > 0.0 {
        WhirlKind::Forward
    } else {
        WhirlKind::Backward
    };
    let agreement = view.agreement();
    // The time estimate is the exacter one for a single line; of several lines it is the mean, and then the strongest
    // line says more.
    let rate = if agreement >= SINGLE_LINE {
        view.orbit.rate
    } else {
        view.lines.rate
    };
    verdict(kind, rate, direction.abs() * agreement)
}
