//! Bit and rock: the torque against the rotation and, where the rock holds the bit, the weight.
//!
//! Three laws:
//!
//! - [`RockLaw::Paper`], Eq. 1: T = eta D W / 3, with the weight W given.
//! - [`RockLaw::Weakening`]: the same times P(omega) = 1 + (mu_s / mu_k - 1) exp(-|omega| / omega_c), which falls as the bit
//!   turns faster and so excites torsional vibration.
//! - [`RockLaw::DepthOfCut`]: cutting and wear flats (Detournay and Defourny, Int. J. Rock Mech. 29, 1992), with the depth of
//!   cut from the paths of the blades before (Richard, Germay and Detournay, J. Sound Vib. 305, 2007). The weight is then a
//!   result:
//!
//! ```text
//! d = n [U - max path]+        W = zeta e a d + W_f        T = e a^2 d / 2 P_c(omega) + mu_g a W_f / 2 P(omega)
//! ```
//!
//! U is the depth of the bit (m, down), n the number of blades, a the radius, and P_c = 1 + c (P - 1) with the part c of the
//! torque of cutting that falls with the speed. That is while the bit turns ahead. Turning back,
//! its cutters leave the rock: only the wear flats act, they carry all the weight, and nothing is removed.
//!
//! The torque of the paper's law has a smooth sign of the speed, by which a bit that is held creeps. With the other laws
//! the bit sticks on an elastic twist ([`Bristle`]).
//!
//! Torque (N m) and weight (N) act on the tool's last node: against the spin of the pipe, and up the hole on the guide.

mod bristle;
mod groove;
mod law;
mod load;
#[cfg(test)]
mod tests;

use flexdrill_base::energies::Energies;

use super::places;
use crate::chain::{Chain, Effect, EndLoad, Under};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::{LedgerPoint, StepWork};
use crate::dynamics::state::State;
use crate::elements::factors::TangentFactors;
use crate::model::{Model, Places};
use crate::tool::description::{BitDescription, RockLaw};

pub(crate) use bristle::Bristle;
pub(crate) use groove::Groove;
pub(crate) use load::BitMark;
#[cfg(feature = "checkpoints")]
pub(crate) use load::BitState;
use load::{BitAt, BitLoad};

/// Places in [`Sums::of_effects`](crate::dynamics::energy::Sums::of_effects): the torque (N m), and the energy in the twist of a
/// bit that sticks (J), which the rock has not taken yet.
const TORQUE: usize = places::BIT;
const ELASTIC: usize = places::BIT + 1;

/// Depth of the hole's bottom (m) while the tool comes to rest: far below the bit, which then carries no weight.
const OFF_BOTTOM: f64 = 10.0;

/// The bit on its rock, in a numbering of the unknowns.
#[derive(Debug, Clone)]
pub(crate) struct Bit {
    described: BitDescription,
    rock: RockLaw,
    load: BitLoad,
    /// What a retreat from the present step needs.
    mark: Option<BitMark>,
    /// Spin of the pipe's last node.
    spin: usize,
    /// u of the guide's last node, which carries the weight.
    down: usize,
}

impl Bit {
    /// That of `model`. Every tool has one.
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        Some(Self::at(model, &chain.model.places))
    }

    /// The same in the numbering of `places`.
    pub(crate) fn at(model: &Model, places: &Places) -> Self {
        let description = &model.description;
        Self {
            described: description.bit,
            rock: description.rock,
            load: BitLoad::new(&description.rock),
            mark: None,
            spin: places.end_spin,
            down: places.guide_end,
        }
    }

    /// Torque of Eq. 1 (N m, >= 0). It vanishes at rest, and is left out on the way there.
    fn of_given_weight(&self, conditions: &Conditions) -> f64 {
        if conditions.comes_to_rest {
            return 0.0;
        }
        conditions.live.bit_friction_factor * self.described.diameter * conditions.weight_on_bit.max(0.0) / 3.0
    }

    /// Evaluates torque and weight at `state`.
    pub(crate) fn evaluate(&mut self, state: &State, conditions: &Conditions) {
        let at = BitAt {
            radius: 0.5 * self.described.diameter,
            slip_rate: self.described.slip_rate,
            given: [self.of_given_weight(conditions), conditions.weight_on_bit],
            angle: state.q[self.spin],
            speed: state.v[self.spin],
            depth: conditions.depth + state.q[self.down],
        };
        self.load.evaluate(&self.rock, &at);
    }

    /// Lets the bit begin the step at `angle` (rad) without torque, over a flat bottom at `depth` (m).
    pub(crate) fn start(&mut self, [angle, depth]: [f64; 2]) {
        self.load.start(angle, depth);
    }

    /// What the rock holds of it at the end of the last step.
    #[cfg(test)]
    pub(crate) fn mark(&self) -> BitMark {
        self.load.mark()
    }

    /// Goes back to a mark.
    #[cfg(test)]
    pub(crate) fn rewind(&mut self, mark: &BitMark) {
        self.load.rewind(mark);
    }

    /// How it holds the rock, to be saved.
    #[cfg(feature = "checkpoints")]
    pub(super) fn history(&self) -> Option<&BitState> {
        Some(self.load.state())
    }

    /// Whether a saved state is one of this bit.
    #[cfg(feature = "checkpoints")]
    pub(super) fn fits(&self, saved: &BitState) -> bool {
        self.load.fits(saved)
    }

    /// Continues with a saved state that fits.
    #[cfg(feature = "checkpoints")]
    pub(super) fn restore(&mut self, saved: &BitState) {
        self.load.restore(saved);
    }
}

impl Effect for Bit {
    fn hold(&mut self) {
        self.start([0.0, OFF_BOTTOM]);
    }

    fn release(&mut self, state: &State, _conditions: &mut Conditions) {
        self.start([state.q[self.spin], state.q[self.down]]);
    }

    fn begin(&mut self, _from: &State, step: f64) {
        self.load.begin(step);
    }

    fn force(&mut self, chain: &mut Chain, state: &mut State, under: &Under<'_>) {
        // A window may leave the last node out, whose residual then keeps what the bit has there.
        if chain.is_affected(self.spin) {
            self.evaluate(state, under.conditions);
        }
    }

    fn applied(&self, residual: &mut [f64], wanted: &impl Fn(usize) -> bool) {
        // Both are in the last node.
        if wanted(self.spin) {
            residual[self.down] += self.load.weight;
            residual[self.spin] += self.load.torque;
        }
    }

    fn at_ends(&self, factors: TangentFactors, add: &mut impl FnMut(usize, usize, f64)) {
        let (spin, down, load) = (self.spin, self.down, &self.load);
        add(spin, spin, factors.damping * load.slope);
        if load.holds() {
            let stiffness = factors.stiffness;
            add(spin, spin, stiffness * load.torque_by[1]);
            add(spin, down, stiffness * load.torque_by[0]);
            add(down, down, stiffness * load.weight_by[0]);
            add(down, spin, stiffness * load.weight_by[1]);
        }
    }

    fn close(&self, point: &mut LedgerPoint) {
        let sums = &mut point.sums;
        sums.stored += self.load.elastic;
        sums.pushed_up = self.load.weight;
        (sums.of_effects[TORQUE], sums.of_effects[ELASTIC]) = (self.load.torque, self.load.elastic);
    }

    fn work(&self, _chain: &Chain, step: &StepWork<'_>, ledger: &mut Energies) {
        let (at0, at1) = (&step.before.point.sums, &step.after.point.sums);
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        // The weight on bit is an input at the guide's end, or the rock's answer; either works on that displacement, and on that
        // of the frame which goes down with the bit.
        let weight = mean(at0.pushed_up, at1.pushed_up);
        ledger.weight_on_bit -= weight * (step.h * mean(at0.advance, at1.advance));
        ledger.weight_on_bit -= weight * step.moved[self.down];
        // What the twist of a bit that sticks takes it gives back.
        let (from, to) = (&at0.of_effects, &at1.of_effects);
        let twisted = to[ELASTIC] - from[ELASTIC];
        ledger.bit += mean(from[TORQUE], to[TORQUE]) * step.moved[self.spin] - twisted;
    }

    fn accept(&mut self, _state: &State) {
        self.load.accept();
    }

    fn keep(&mut self) {
        self.mark = Some(self.load.mark());
    }

    fn retreat(&mut self) {
        if let Some(mark) = &self.mark {
            self.load.rewind(mark);
        }
    }

    fn unwind(&mut self, turns: f64) {
        self.load.unwind(turns);
    }

    fn end_load(&self) -> Option<EndLoad> {
        let load = &self.load;
        Some(EndLoad {
            radius: 0.5 * self.described.diameter,
            torque: load.torque,
            weight: load.weight,
            depth_of_cut: load.holds().then_some(load.depth_of_cut),
        })
    }
}
