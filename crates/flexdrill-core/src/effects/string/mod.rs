//! The drill string above the tool, up to the top drive and the hoist.
//!
//! A uniform piece of length L carries torsional and axial waves without dispersion (d'Alembert): with f going down and g
//! coming up, the speed is f + g and the torque or force that is passed down z (f - g). A wave that enters a piece leaves
//! it tau = L / c later; lumps between pieces attenuate it. Every end reads waves from the past only, so that the string adds to the
//! tool's equations nothing but a dashpot z and a known force at the first node:
//!
//! ```text
//! T = z_t (2 f - w)        N = z_a (2 f_a - u')
//! ```
//!
//! Pieces meet where the section changes and where friction on the wall is lumped ([`WallFriction`](crate::tool::description::WallFriction)).
//!
//! T (N m) turns the pipe's first node, N (N) pushes the guide's first node down the hole. The string takes each part of a step
//! before the tool does ([`Effect::lead`]). While the tool comes to rest, the string's end is a spring.

mod friction;
mod history;
mod hoist;
mod line;
mod modes;
mod top_drive;
mod torsion;

use flexdrill_base::energies::Energies;

use super::places;
use crate::chain::{Asked, Carrier, Chain, Effect, FromAbove, Under};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::{LedgerPoint, StepWork};
use crate::dynamics::state::State;
use crate::elements::factors::TangentFactors;
use crate::model::Model;
use crate::tool::description::{Feed, Hoist, StringDescription};

#[cfg(feature = "checkpoints")]
pub(crate) use line::StringState;
use line::{StringLine, StringStep};

/// Places in [`Sums::of_effects`](crate::dynamics::energy::Sums::of_effects): energy that the string has lost so far (J), to
/// friction on the wall and inside; work of the hoist so far (J); and power of the frame's advance in the weight on bit less that
/// in the string's force (W). The string and the rock move in the frame of the hole, the tool in a frame that advances with it.
const LOST: usize = places::STRING;
const HOIST_WORK: usize = places::STRING + 1;
const ADVANCE_POWER: usize = places::STRING + 2;

/// Stiffness that holds the string's end while the tool comes to rest, in torsion (N m/rad) and along the hole (N/m): that
/// of some metres of pipe, so that the end moves by micrometres.
const HELD: [f64; 2] = [1e5, 1e8];

/// The string's lower end at the tool: the force z (2 f - v) - k q on an unknown q of the first node, with its speed v.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TopEnd {
    /// Impedance z (N m s or N s/m).
    impedance: f64,
    /// Wave f that arrives from above (rad/s or m/s).
    arriving: f64,
    /// Stiffness k (N m/rad or N/m) that holds the end while the tool comes to rest; 0 in motion.
    stiffness: f64,
}

impl TopEnd {
    /// The end of a line of this impedance, at which the wave arrives.
    fn of([impedance, arriving]: [f64; 2]) -> Self {
        Self {
            impedance,
            arriving,
            stiffness: 0.0,
        }
    }

    /// An end that is held.
    fn held(stiffness: f64) -> Self {
        Self {
            impedance: 0.0,
            arriving: 0.0,
            stiffness,
        }
    }
}

/// The string above a tool.
#[derive(Debug, Clone)]
pub(crate) struct DrillString {
    description: StringDescription,
    /// `None` until steps are prepared: a tool that only comes to rest needs none.
    line: Option<StringLine>,
    /// Its lower end, in torsion and along the hole; no other without a hoist.
    ends: [Option<TopEnd>; 2],
    /// The unknowns at its end: spin of the pipe's first node, and u of the guide's.
    at: [usize; 2],
    /// Time that a torsional wave needs from the drive to the tool (s).
    delay: f64,
}

impl DrillString {
    /// That above the tool of `model`; `None` without one.
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        let description = model.description.string.clone()?;
        let places = &chain.model.places;
        Some(Self {
            line: None,
            ends: [None; 2],
            at: [places.top_spin, places.guide_top],
            delay: description.pieces.iter().map(|piece| piece.torsion.delay).sum(),
            description,
        })
    }

    /// What it does, as ends of it and as conditions of the tool, whose drive was at `drive_angle` (rad) before.
    fn apply(&mut self, conditions: &mut Conditions, step: &StringStep, drive_angle: f64) {
        self.ends = [Some(TopEnd::of(step.torsion)), step.axial.map(TopEnd::of)];
        conditions.drive_torque = Some(step.drive_torque);
        conditions.drive_angle = drive_angle + step.drive_turns;
        if step.axial.is_some() {
            (conditions.depth, conditions.rate_of_penetration) = (step.depth, step.advance);
        }
    }

    /// What it does, to be saved.
    #[cfg(feature = "checkpoints")]
    pub(super) fn history(&self) -> Option<&StringState> {
        self.line.as_ref().map(StringLine::state)
    }

    /// Whether a saved state is one of this string.
    #[cfg(feature = "checkpoints")]
    pub(super) fn fits(&self, saved: &StringState) -> bool {
        self.line.as_ref().is_some_and(|line| line.fits(saved))
    }

    /// Continues with a saved state that fits.
    #[cfg(feature = "checkpoints")]
    pub(super) fn restore(&mut self, saved: &StringState) {
        if let Some(line) = &mut self.line {
            line.restore(saved);
        }
    }
}

impl Effect for DrillString {
    fn prepare(&mut self, h: f64) {
        // Waves are kept in steps of the first size: other ones read between them.
        let description = &self.description;
        self.line.get_or_insert_with(|| StringLine::new(description, h));
    }

    fn hold(&mut self) {
        let along = self.description.hoist.map(|_| TopEnd::held(HELD[1]));
        self.ends = [Some(TopEnd::held(HELD[0])), along];
    }

    fn release(&mut self, state: &State, conditions: &mut Conditions) {
        let [spin, top] = self.at;
        // The tool pushes back with what the end's stiffness takes.
        let (torque, force) = (-HELD[0] * state.q[spin], -HELD[1] * state.q[top]);
        let force = if self.ends[1].is_some() { force } else { 0.0 };
        if let Some(line) = &mut self.line {
            line.begin(state.time, state.v[spin], torque, force);
        }
        // A string of which no step has been taken: its end is that of the waves it began with.
        self.resume(state, conditions);
    }

    fn resume(&mut self, state: &State, conditions: &mut Conditions) {
        let [spin, top] = self.at;
        if let Some(line) = &self.line {
            let at = line.present(state.v[spin], state.v[top]);
            self.apply(conditions, &at, state.drive_angle);
        }
    }

    fn lead(&mut self, asked: &Asked, conditions: &mut Conditions) {
        // Its waves take longer than a step, so that its answer does not depend on the tool's end of it.
        if let Some(line) = &mut self.line {
            let at = line.step(
                conditions.time,
                asked.h,
                asked.rotary_speed,
                conditions.weight_on_bit,
                conditions.rate_of_penetration,
            );
            self.apply(conditions, &at, asked.drive_angle);
        }
    }

    fn at_nodes(&self, residual: &mut [f64], state: &State, _under: &Under<'_>, wanted: &impl Fn(usize) -> bool) {
        // An impedance with an arriving wave: its force depends on the end's velocity at once.
        for (unknown, end) in self.at.into_iter().zip(self.ends) {
            if let Some(end) = end.filter(|_| wanted(unknown)) {
                let force = end.impedance * (2.0 * end.arriving - state.v[unknown]) - end.stiffness * state.q[unknown];
                residual[unknown] -= force;
            }
        }
    }

    fn at_ends(&self, factors: TangentFactors, add: &mut impl FnMut(usize, usize, f64)) {
        for (unknown, end) in self.at.into_iter().zip(self.ends) {
            if let Some(end) = end {
                let slope = factors.damping * end.impedance + factors.stiffness * end.stiffness;
                add(unknown, unknown, slope);
            }
        }
    }

    fn accept(&mut self, state: &State) {
        let [spin, top] = self.at;
        if let Some(line) = &mut self.line {
            line.accept(state.v[spin], [state.q[top], state.v[top]]);
        }
    }

    fn close(&self, point: &mut LedgerPoint) {
        let Some(line) = &self.line else { return };
        let sums = &mut point.sums;
        let [friction, attenuation] = line.lost();
        sums.stored += line.stored();
        sums.of_effects[LOST] = friction + attenuation;
        sums.of_effects[HOIST_WORK] = line.hoist_work();
        if let Some(hoist) = line.hoist() {
            sums.advance = hoist.advance;
            sums.of_effects[ADVANCE_POWER] = (sums.pushed_up - line.force_on_tool()) * hoist.advance;
        }
    }

    fn work(&self, _chain: &Chain, step: &StepWork<'_>, ledger: &mut Energies) {
        let (before, after) = (&step.before, &step.after);
        let (from, to) = (&before.point.sums.of_effects, &after.point.sums.of_effects);
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        // The drive works on the string's top; hoist and string have their own parts.
        let turned = after.state.drive_angle - before.state.drive_angle;
        ledger.drive += mean(before.carried.drive_torque, after.carried.drive_torque) * turned;
        ledger.hoist += to[HOIST_WORK] - from[HOIST_WORK];
        ledger.string += to[LOST] - from[LOST];
        ledger.feed += step.h * mean(from[ADVANCE_POWER], to[ADVANCE_POWER]);
    }

    fn keep(&mut self) {
        if let Some(line) = &mut self.line {
            line.keep();
        }
    }

    fn retreat(&mut self) {
        if let Some(line) = &mut self.line {
            line.retreat();
        }
    }

    fn load_above(&self, state: &State) -> Option<FromAbove> {
        let line = self.line.as_ref()?;
        let [spin, top] = self.at.map(|unknown| state.v[unknown]);
        let at = line.present(spin, top);
        let on = |[impedance, arriving]: [f64; 2], speed: f64| impedance * (2.0 * arriving - speed);
        let carrier = |hoist: Hoist| {
            let now = line.hoist()?;
            Some(Carrier {
                force: on(at.axial?, top),
                weight: now.weight,
                advance: now.advance,
                depth: now.depth,
                response_time: hoist.response_time,
                by_weight: hoist.feed == Feed::Weight,
            })
        };
        Some(FromAbove {
            torque: on(at.torsion, spin),
            drive_speed: line.drive().speed,
            drive_at_limit: line.is_drive_at_limit(),
            drag: line.drag(),
            hook_load: line.hook_load(),
            delay: self.delay,
            carrier: self.description.hoist.and_then(carrier),
        })
    }
}
