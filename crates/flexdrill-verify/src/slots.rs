//! A slotted guide whose slots close as it bends.

use super::case::CaseTwin;
use super::preload::{RADIUS, chord};
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// Couples bend all elements alike: what the iteration leaves of them.
const COUPLES: f64 = 1e-6;
/// Within an element the curvature varies as with open slots, which makes the way longer by V l^2 L (1 / EI_f - 1 / EI) /
/// 24 with the shear V, 0.2 %. The force falls by three times that, because closing the slots takes most of the way. The
/// thrust that the shear becomes takes 0.1 %.
const WALL: f64 = 1e-2;
/// Intervals of the integral over half the arc, whose integrand has a kink: 1e-7.
const INTERVALS: u32 = 2000;

/// Bending stiffness of a tube with open slots and of the whole tube (N m2), and the curvature at which the slots
/// close (1/m).
struct Slotted {
    open: f64,
    whole: f64,
    close_at: f64,
}

impl Slotted {
    fn of(case: &'static str, twin: &CaseTwin) -> Result<Self, VerifyError> {
        let tool = twin.config.tool();
        let bending = |factor: f64| SectionProperties::of(tool.guide_section, tool.material, factor).bending;
        let close_at = tool.guide_slots_close_at.ok_or(VerifyError::Missing {
            case,
            what: "slots that close",
        })?;
        Ok(Self {
            open: bending(tool.guide_bending_factor),
            whole: bending(1.0),
            close_at,
        })
    }

    /// Curvature under a moment (N m).
    fn curvature(&self, moment: f64) -> f64 {
        let closing = self.open * self.close_at;
        moment.min(closing) / self.open + (moment - closing).max(0.0) / self.whole
    }
}

pub(super) fn under_couples() -> Result<Vec<Row>, VerifyError> {
    let case = "slots_couples";
    let slotted = Slotted::of(case, &CaseTwin::new(case)?)?;
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    let mut rows = Vec::new();
    for (moment, state) in [(400.0, "open"), (5000.0, "closed")] {
        let twin = CaseTwin::within(case, 1e-3, |config| {
            let couples = [-cos, -sin, cos, sin].map(|part| part * moment);
            couples
                .into_iter()
                .enumerate()
                .try_fold(config, |config, (load, couple)| {
                    config.with_value(&format!("loads.{load}.history.constant"), couple)
                })
        })?;
        let bend = slotted.curvature(moment) * twin.config.well.length();
        for (direction, plane, part) in [
            (Direction::PhiY, "in the plane", cos),
            (Direction::PhiZ, "out of it", sin),
        ] {
            let tilt = |station| twin.displacement(station, Body::Guide, direction);
            let quantity = format!("{state}, from end to end {plane} (rad)");
            let got = tilt(twin.last()) - tilt(0);
            rows.push(Row::relative(case, quantity, part * bend, got, COUPLES));
        }
    }
    Ok(rows)
}

pub(super) fn on_the_wall() -> Result<Vec<Row>, VerifyError> {
    let case = "slots_wall";
    let twin = CaseTwin::new(case)?;
    let slotted = Slotted::of(case, &twin)?;
    let (length, last) = (twin.config.well.length(), twin.last());
    let half = 0.5 * length / RADIUS;
    let missing = chord(length) - twin.config.outer_clearance();
    let way = |force: f64| {
        // Moments by a unit force; the other half of the arc does as much.
        let step = half / f64::from(INTERVALS);
        let sum: f64 = (0..INTERVALS)
            .map(|i| {
                let arm = RADIUS * (step * (f64::from(i) + 0.5)).sin() / (2.0 * half.cos());
                slotted.curvature(force * arm) * arm
            })
            .sum();
        2.0 * sum * step * RADIUS + force / twin.config.tool().outer.stiffness
    };
    let (mut below, mut above) = (0.0, 1e7);
    for _ in 0..60 {
        let middle = 0.5 * (below + above);
        if way(middle) < missing {
            below = middle;
        } else {
            above = middle;
        }
    }
    let force: f64 = (0..=last)
        .filter_map(|station| twin.simulation.normal_force(station, Body::Guide))
        .sum();
    Ok(vec![Row::relative(
        case,
        "force on the wall in the middle (N)",
        below,
        force,
        WALL,
    )])
}
