//! Rotations that are no unknowns of their own: those below a node that follow from the others of the node.
//!
//! Where the pipe passes a node in one piece, the rotations below are those above. Through a joint the constraint rows of
//! Eq. 13 say how they follow: linearised, Phi + G_s x_s + G_f x_f = 0 gives x_s = -G_s^-1 (Phi + G_f x_f). The spin below
//! is always one of them; a revolute joint, which has two rows, makes one tilt below another. The multipliers of the rows
//! follow from the balance of the moments on the dependent rotations, R_s + G_s^T lambda = 0, so that they are no unknowns
//! either: their moments on the other rotations are the same coefficients times R_s. A joint with play has no constraint
//! row: no rotation of its node follows from others.

use super::nodes::Node;
use super::precision::{Lanes, Precision};
use super::{Chain, GUIDE, NODE, U};
use crate::dynamics::carried::JointForces;
use crate::dynamics::joints::{Joints, pin_lanes, rotations};
use crate::dynamics::state::State;
use crate::elements::joint::group::JointGroup;
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::number::{Eight, Lane, Number};
use crate::simd::vector::Vector;
use crate::tool::PinFriction;

/// Place in a node of the residual of a joint's first row: the place of the spin below, whose moment is always in balance.
pub(super) const FIRST_ROW: usize = 6;
/// Place in a node of the residual of its second row.
pub(super) const SECOND_ROW: usize = 15;
/// Places in a node of the rotations of a joint's rows: of the end above, of the start below.
pub(super) const ROTATIONS: [usize; 6] = [0, 1, 2, 6, 7, 8];

/// The same without the spin below.
const OTHERS: [usize; 5] = [0, 1, 2, 7, 8];

/// One in the places of a joint's node whose residual is a force or moment, zero in those of the rows.
pub(super) static MOMENTS: [f64; NODE] = {
    let mut places = [1.0; NODE];
    (places[FIRST_ROW], places[SECOND_ROW]) = (0.0, 0.0);
    places
};

/// A rotation that follows from the others of its node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dependent {
    /// Its place in the node.
    pub slot: usize,
    /// How it changes with each of the others; -1 at its own place, 0 at those of other dependent ones.
    pub by: [f64; NODE],
    /// How it changes with what stands on the right of the joint's rows.
    pub by_rows: [f64; 2],
}

/// The dependent rotations of a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dependents {
    list: [Dependent; 3],
    count: usize,
}

impl Dependents {
    /// Those of a node that the pipe passes in one piece.
    fn welded() -> Self {
        let list = std::array::from_fn(|k| {
            let mut by = [0.0; NODE];
            (by[k], by[6 + k]) = (1.0, -1.0);
            Dependent {
                slot: 6 + k,
                by,
                by_rows: [0.0; 2],
            }
        });
        Self { list, count: 3 }
    }

    /// Those of a node whose joint has so many `rows`; of a joint they are linearised with each residual.
    pub(super) fn of(node: &Node, rows: usize) -> Self {
        if node.joint.is_none() {
            return Self::welded();
        }
        let mut dependents = Self::welded();
        if rows == 0 {
            dependents.count = 0;
            return dependents;
        }
        dependents.list[0].by = [0.0; NODE];
        dependents.list[0].by[FIRST_ROW] = -1.0;
        dependents.count = 1;
        dependents
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Dependent> {
        self.list[..self.count].iter()
    }

    /// Of a joint with one row: the spin below follows the other five rotations by these coefficients, and what stands on
    /// the right of the row by `by_row`.
    #[inline(always)]
    fn set_spin(&mut self, by: [f64; 5], by_row: f64) {
        let spin = &mut self.list[0];
        for (place, by) in OTHERS.into_iter().zip(by) {
            spin.by[place] = by;
        }
        spin.by_rows[0] = by_row;
    }

    /// By the gradients of a joint's two rows: the spin below follows, and the tilt below that the rows give most surely;
    /// `held` says which places of the node are held.
    fn linearise_two(&mut self, [first, second]: [[f64; 6]; 2], scale: f64, held: Option<&[f64; NODE]>) {
        let minor = |k: usize| first[3] * second[k] - first[k] * second[3];
        let is_free = |slot: usize| held.is_none_or(|rows| rows[slot] != 0.0);
        let tilts = [4, 5].into_iter().filter(|&k| is_free(ROTATIONS[k]));
        let Some(tilt) = tilts.max_by(|&i, &j| minor(i).abs().total_cmp(&minor(j).abs())) else {
            // Both are held: the second row can only be watched.
            let inverse = 1.0 / first[3];
            self.set_spin([0, 1, 2, 4, 5].map(|k| -first[k] * inverse), inverse / scale);
            self.count = 1;
            return;
        };
        let inverse = 1.0 / minor(tilt);
        // [first[3], first[tilt]; second[3], second[tilt]]^-1.
        let solved = [
            [second[tilt] * inverse, -first[tilt] * inverse],
            [-second[3] * inverse, first[3] * inverse],
        ];
        let slots = [ROTATIONS[3], ROTATIONS[tilt]];
        for (r, of_rows) in solved.into_iter().enumerate() {
            let mut by = [0.0; NODE];
            for (k, &place) in ROTATIONS.iter().enumerate() {
                by[place] = -(of_rows[0] * first[k] + of_rows[1] * second[k]);
            }
            (by[slots[r]], by[slots[1 - r]]) = (-1.0, 0.0);
            self.list[r] = Dependent {
                slot: slots[r],
                by,
                by_rows: of_rows.map(|x| x / scale),
            };
        }
        self.count = 2;
    }

    /// Multipliers of the joint's rows, which stand in the equations times `scale`, that balance the moments on the
    /// dependent rotations (N m).
    fn multipliers(&self, residual: &[f64; NODE], scale: f64) -> [f64; 2] {
        let mut lambda = [0.0; 2];
        for dependent in self.iter() {
            for (lambda, by) in lambda.iter_mut().zip(dependent.by_rows) {
                *lambda -= scale * by * residual[dependent.slot];
            }
        }
        lambda
    }

    /// Moves the moments on the dependent rotations to the rotations that these follow from.
    #[inline(always)]
    fn project(&self, residual: &mut [f64; NODE]) {
        for dependent in self.iter() {
            let moment = residual[dependent.slot];
            // -1 at its own place leaves nothing there.
            for place in ROTATIONS {
                residual[place] += dependent.by[place] * moment;
            }
        }
    }

    /// Writes the dependent rotations by the others in a node's block `a`, in the columns that couple it to the node below
    /// and in the right-hand side, which it gives back. Their own rows then say how they follow, so that the solution
    /// holds them. `rows` is what stands on the right of the joint's rows; `crossed` whether the guide's columns have
    /// entries in the pipe's rows.
    #[inline(always)]
    pub(super) fn eliminate<S: Precision, L: Lanes<S>>(
        &self,
        a: &mut [[S; NODE]; NODE],
        coupling: &mut [[S; NODE]],
        mut right: L,
        rows: [f64; 2],
        crossed: bool,
    ) -> L {
        for dependent in self.iter() {
            right = match dependent.slot {
                6 => dependent.eliminate::<S, L, 6>(a, coupling, right, rows, crossed),
                7 => dependent.eliminate::<S, L, 7>(a, coupling, right, rows, crossed),
                _ => dependent.eliminate::<S, L, 8>(a, coupling, right, rows, crossed),
            };
        }
        right
    }
}

impl Dependent {
    #[inline(always)]
    fn eliminate<S: Precision, L: Lanes<S>, const SLOT: usize>(
        &self,
        a: &mut [[S; NODE]; NODE],
        coupling: &mut [[S; NODE]],
        right: L,
        rows: [f64; 2],
        crossed: bool,
    ) -> L {
        let offset = self.by_rows[0] * rows[0] + self.by_rows[1] * rows[1];
        let (by, only) = (L::round(&self.by), L::load(S::only(SLOT)));
        let column = L::load(&a[SLOT]);
        // x_slot changes by the offset whatever the others do: its column times the offset goes to the right-hand side.
        let mut lanes = Aligned([S::ZERO; NODE]);
        right.plus_product(column, L::splat(S::of(-offset))).store(&mut lanes);
        let right = L::load(&lanes)
            .plus_product(by, L::splat(lanes[SLOT]))
            .plus_product(only, L::splat(S::of(offset)));
        // Its row is added to the rows of the rotations that it follows; -1 at its own place leaves zero there.
        let without_row = |column: L, moment: S| column.plus_product(by, L::splat(moment));
        for k in ROTATIONS {
            if k != SLOT {
                // Its column is added to their columns, and its row becomes x_slot - by x = offset.
                let of_it = self.by[k];
                L::load(&a[k])
                    .plus_product(column, L::splat(S::of(of_it)))
                    .store(&mut a[k]);
                without_row(L::load(&a[k]), a[k][SLOT])
                    .plus_product(only, L::splat(S::of(-of_it)))
                    .store(&mut a[k]);
            }
        }
        for k in (U..FIRST_ROW).chain(GUIDE..if crossed { NODE } else { GUIDE }) {
            without_row(L::load(&a[k]), a[k][SLOT]).store(&mut a[k]);
        }
        for column in coupling {
            without_row(L::load(column), column[SLOT]).store(column);
        }
        only.store(&mut a[SLOT]);
        right
    }
}

/// How the spins below eight joints with one row follow from their other rotations, a joint per lane.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Spins {
    /// By the other five rotations.
    by: [Lane; 5],
    /// By the value of the row.
    by_row: Lane,
}

impl Chain {
    /// Hands the spins of the joints that are solved for from the lanes to their nodes. A residual is evaluated more often
    /// than a tangent, so that it leaves them in the lanes. The rows stand in the equations times `scale`.
    pub(super) fn set_spins(&mut self, scale: f64) {
        if self.model.joint_rows != 1 {
            return;
        }
        for (joint, &k) in self.model.nodes.of_joints.iter().enumerate() {
            if self.active.nodes[k] {
                let (spins, lane) = (&self.spins[joint / 8], joint % 8);
                self.dependents[k].set_spin(spins.by.map(|by| by[lane]), spins.by_row[lane] / scale);
            }
        }
    }

    /// Sets the moments with which slipping pins of the joints resist (N m) to those under the `forces` in them.
    pub(crate) fn set_pin_moments(&self, pins: &PinFriction, forces: &JointForces, moments: &mut [f64]) {
        if pins.coefficient == 0.0 {
            return;
        }
        let joints = self.model.nodes.of_joints.iter().zip(&forces.multipliers);
        for (moment, (&k, [torque, _])) in moments.iter_mut().zip(joints) {
            let [x, y, z] = forces.on_top[k];
            *moment = pins.moment(*torque, (x * x + y * y + z * z).sqrt());
        }
    }

    /// Adds the moments of the joints' stops, linearises the dependent rotations, and moves the moments on them to the
    /// rotations that they follow from: with the multipliers of the joints' rows the dependent ones are in balance. Their
    /// places in the residual hold the rows themselves, times `scale`.
    pub(super) fn joint_forces(&mut self, joints: &mut Joints, state: &State, scale: f64) {
        let (residual, _) = self.residual.as_chunks_mut::<NODE>();
        for (k, (node, residual)) in self.model.nodes.list.iter().zip(residual).enumerate() {
            if node.joint.is_none() && self.active.affected[k] {
                self.dependents[k].project(residual);
            }
        }
        let instructions = self.model.instructions;
        instructions.run(BalanceJoints {
            chain: self,
            groups: joints.groups_mut(),
            state,
            scale,
        });
    }
}

/// The joints' part of [`Chain::joint_forces`], eight at a time.
struct BalanceJoints<'a> {
    chain: &'a mut Chain,
    groups: &'a mut [JointGroup],
    state: &'a State,
    scale: f64,
}

impl Kernel for BalanceJoints<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            chain,
            groups,
            state,
            scale,
        } = self;
        let (residual, _) = chain.residual.as_chunks_mut::<NODE>();
        let places = chain
            .model
            .places
            .joints
            .chunks(8)
            .zip(chain.model.nodes.of_joints.chunks(8));
        let of_groups = chain.spins.iter_mut().zip(chain.multipliers.chunks_mut(8));
        for (g, ((group, (places, nodes)), (spins, multipliers))) in
            groups.iter_mut().zip(places).zip(of_groups).enumerate()
        {
            // A group of eight joints is linearised if any of its nodes is affected; the other lanes cost nothing.
            if !nodes.iter().any(|&k| chain.active.affected[k]) {
                continue;
            }
            // Rotations and rates are gathered to one lane per joint, so that the law runs over eight joints at once.
            let (q, rate) = rotations(places, state);
            group.linearise::<V>(&q, &rate, &pin_lanes(&state.pin_moments, 8 * g));
            // Moments without a multiplier act directly on the rotations, on the spin below too.
            for (lane, &k) in nodes.iter().enumerate() {
                if let Some(moments) = group.further_moments(lane).filter(|_| chain.active.affected[k]) {
                    for (place, moment) in ROTATIONS.into_iter().zip(moments) {
                        residual[k][place] += moment;
                    }
                }
            }
            let stop = group.shut_stop();
            // With play the row is a contact and no constraint: its moment is in
            // the residual, and its torque stands for the multiplier.
            if group.has_play() {
                for (lane, (&k, multipliers)) in nodes.iter().zip(multipliers).enumerate() {
                    if !chain.active.affected[k] {
                        continue;
                    }
                    if let Some(stop) = stop {
                        for (place, gradient) in ROTATIONS.into_iter().zip(&stop.gradient) {
                            residual[k][place] += gradient[lane] * stop.moment[lane];
                        }
                    }
                    *multipliers = [group.play().multiplier[lane], 0.0];
                }
                continue;
            }
            // Two rows, of a revolute joint: each joint chooses the tilt
            // that depends best, so these are done one by one.
            let [row] = group.rows() else {
                for (lane, (&k, lambda)) in nodes.iter().zip(multipliers).enumerate() {
                    if chain.active.affected[k] {
                        let (residual, dependents) = (&mut residual[k], &mut chain.dependents[k]);
                        let gradients = [0, 1].map(|r| group.rows()[r].gradient.map(|lanes| lanes[lane]));
                        dependents.linearise_two(gradients, scale, chain.model.rows[k].as_ref());
                        *lambda = dependents.multipliers(residual, scale);
                        dependents.project(residual);
                        // The values of the rows take the places of the dependent
                        // moments, which are in balance by construction.
                        residual[FIRST_ROW] = scale * group.rows()[0].value[lane];
                        residual[SECOND_ROW] = scale * group.rows()[1].value[lane];
                    }
                }
                continue;
            };
            // R_s + G_s lambda = 0 for the spin below, the stop's moment in R_s.
            let zero = Eight::<V>::of(0.0);
            let mut stops = [zero; 6];
            if let Some(stop) = stop {
                let moment = Eight::load(&stop.moment);
                for (out, gradient) in stops.iter_mut().zip(&stop.gradient) {
                    *out = Eight::load(gradient) * moment;
                }
            }
            // The moment on the spin below is read before the loop that replaces it by the row's value.
            let mut on_spin = Lane::default();
            for (on_spin, &k) in on_spin.iter_mut().zip(nodes) {
                *on_spin = residual[k][FIRST_ROW];
            }
            let inverse = Eight::of(1.0).over(Eight::load(&row.gradient[3]));
            let lambda = zero - (Eight::load(&on_spin) + stops[3]) * inverse;
            // The spin below is left out: its moment has become the multiplier, and its place holds the row.
            let (mut moments, mut of_rows) = ([Lane::default(); 5], Lane::default());
            for (out, (by, k)) in moments.iter_mut().zip(spins.by.iter_mut().zip([0, 1, 2, 4, 5])) {
                let gradient = Eight::load(&row.gradient[k]);
                stops[k].plus_product(gradient, lambda).store(out);
                (zero - gradient * inverse).store(by);
            }
            inverse.store(&mut spins.by_row);
            (Eight::<V>::load(&row.value) * Eight::of(scale)).store(&mut of_rows);
            // Scattered back to the nodes only here; everything before stayed in registers.
            let mut lambdas = Lane::default();
            lambda.store(&mut lambdas);
            for (lane, (&k, lambda)) in nodes.iter().zip(multipliers).enumerate() {
                if chain.active.affected[k] {
                    let residual = &mut residual[k];
                    for (place, moment) in OTHERS.into_iter().zip(&moments) {
                        residual[place] += moment[lane];
                    }
                    residual[FIRST_ROW] = of_rows[lane];
                    *lambda = [lambdas[lane], 0.0];
                }
            }
        }
    }
}
