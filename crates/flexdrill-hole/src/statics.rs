//! Equilibrium of the guide in the hole as it is: Newton's method on offsets and slopes, with the thrust set between.

use flexdrill_base::validation::require;
use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};

use crate::beam::{Beam, Piece, pieces};
use crate::blocks::Blocks;
use crate::guide::Guide;
use crate::hole::Hole;
use crate::{BitLaw, HoleError};

/// A guide at rest in a hole.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// F: force of the bit on the rock across the hole (right, low) (N).
    pub side_force: Vector2<f64>,
    /// t: tilt of the bit's axis against the hole's tangent (right, low) (rad).
    pub tilt: Vector2<f64>,
    /// Offsets of the guide from the hole's axis (right, low) (m), from its upper end to the bit.
    pub offsets: Vec<Vector2<f64>>,
    /// Forces of the guide on the wall (right, low) at the same points (N).
    pub wall_forces: Vec<Vector2<f64>>,
    /// Force of the guide's upper end on its centraliser (right, low) (N).
    pub top_force: Vector2<f64>,
    /// Thrust of each piece between two points (N), from the top; kb M more where the guide's moment bends it.
    pub thrust: Vec<f64>,
    /// Length between the bit and the first contact (m); that of the guide without contact. A wall of a stiffness k carries
    /// the guide some (4 EI/k)^(1/4) nearer to the bit than a rigid one.
    pub free_length: f64,
}

/// What holds the bit.
#[derive(Debug, Clone, Copy)]
pub(crate) enum AtBit {
    /// The bit is on the hole's axis, and turns freely.
    Held,
    /// F = offset u + slope phi + constant, with the bit's offset u (m) and slope phi (rad), all (right, low).
    Cutting {
        offset: Matrix2<f64>,
        slope: Matrix2<f64>,
        constant: Vector2<f64>,
    },
}

/// Shares of the thrust with which a solution without a state to start from is found: the guide without contacts is near
/// its buckling load.
const SHARES: [f64; 4] = [0.02, 0.3, 0.65, 1.0];
/// Iterations of Newton's method for one thrust.
const ITERATIONS: usize = 80;
/// Updates of the thrust along the guide, and the share of the loads by which the last one may change it.
const UPDATES: usize = 40;
const THRUST_TOLERANCE: f64 = 1e-5;
/// Share of the loads (as N and as N m) that may lack balance.
const BALANCE: f64 = 1e-7;
/// Shortest share of a correction that the line search takes.
const SHORTEST: f64 = 1e-4;

/// The solver with its state, which is the start of the next solution.
#[derive(Debug, Clone, Default)]
pub(crate) struct Statics {
    /// (v, v', w, w') of each point.
    pub state: Vec<Vector4<f64>>,
    /// What stands for C in the potential of each piece, without the weight at the bit (N).
    excess: Vec<f64>,
    /// Its change in the last update and in the one before.
    change: Vec<f64>,
    last_change: Vec<f64>,
    pieces: Vec<Piece>,
    beam: Beam,
    thrust: Vec<f64>,
    /// Thrust just above each point, whatever bends there (N).
    pub axial: Vec<f64>,
    stiffness: Blocks,
    tangent: Blocks,
    load: Vec<Vector4<f64>>,
    residual: Vec<Vector4<f64>>,
    step: Vec<Vector4<f64>>,
    from: Vec<Vector4<f64>>,
    /// Linear systems solved since the beginning.
    pub solves: usize,
}

impl Statics {
    /// Points of the hole over which the guide lies.
    ///
    /// # Errors
    /// [`HoleError::HoleTooShort`].
    fn points(guide: &Guide, hole: &Hole) -> Result<usize, HoleError> {
        let points = hole.points();
        let mut covered = 0.0;
        for index in (1..points.len()).rev() {
            let chord = (points[index] - points[index - 1]).norm();
            covered += chord;
            if covered > guide.length - 0.5 * chord {
                return Ok(points.len() - index + 1);
            }
        }
        Err(HoleError::HoleTooShort {
            hole_length: covered,
            guide_length: guide.length,
        })
    }

    /// Solves in a hole from the state of the last solution. A guide that drills has almost the same offsets at the same
    /// distances from the bit, so that points are matched from the bit up.
    pub(crate) fn solve(&mut self, guide: &Guide, law: &BitLaw, hole: &Hole, at_bit: &AtBit) -> Result<(), HoleError> {
        let points = Self::points(guide, hole)?;
        pieces(guide, hole, points, &mut self.pieces);
        self.beam.set(guide, &self.pieces);
        let before = self.solves;
        if !self.state.is_empty() {
            self.state.reverse();
            self.state.resize(points, Vector4::zeros());
            self.state.reverse();
            self.excess.reverse();
            self.excess.resize(points - 1, 0.0);
            self.excess.reverse();
            // The upper end is on the axis.
            self.state[0].x = 0.0;
            self.state[0].z = 0.0;
            if self.settle(guide, law.weight, at_bit) {
                return Ok(());
            }
        }
        self.state.clear();
        self.state.resize(points, Vector4::zeros());
        self.excess.clear();
        self.excess.resize(points - 1, 0.0);
        if SHARES
            .iter()
            .all(|share| self.settle(guide, share * law.weight, at_bit))
        {
            return Ok(());
        }
        self.state.clear();
        Err(HoleError::NoEquilibrium {
            depth: hole.length(),
            weight: law.weight,
            iterations: self.solves - before,
        })
    }

    /// Equilibrium with a weight at the bit: the thrust along the guide follows from the forces, and these from it.
    ///
    /// Repeated substitution halves the error of a stiff guide per update. Aitken's factor, which measures that ratio from
    /// two changes, takes it out.
    fn settle(&mut self, guide: &Guide, weight: f64, at_bit: &AtBit) -> bool {
        // The last is the force that straightens the guide: without weight and thrust it is all that acts.
        let loads = weight.abs()
            + guide.weight_per_metre * guide.length
            + guide.bending_stiffness * guide.bends.most(guide.free_curvature) / guide.length;
        let mut factor = 1.0;
        for update in 0..UPDATES {
            self.thrust.clear();
            self.thrust.extend(self.excess.iter().map(|excess| weight + excess));
            self.beam
                .under(&self.pieces, &self.thrust, &mut self.stiffness, &mut self.load);
            if !self.newton(guide, at_bit, BALANCE * loads) {
                return false;
            }
            std::mem::swap(&mut self.change, &mut self.last_change);
            self.thrust_change(guide, weight);
            let largest = self.change.iter().fold(0.0, |most: f64, change| most.max(change.abs()));
            if largest <= THRUST_TOLERANCE * loads {
                return true;
            }
            if update > 0 {
                let (mut along, mut square) = (0.0, 0.0);
                for (now, before) in self.change.iter().zip(&self.last_change) {
                    along += before * (now - before);
                    square += (now - before) * (now - before);
                }
                factor = (-factor * along / square).clamp(0.1, 3.0);
            }
            for (excess, change) in self.excess.iter_mut().zip(&self.change) {
                *excess += factor * change;
            }
        }
        false
    }

    /// Newton's method with a line search, for a given thrust, until no more than `balance` (N, N m) lacks balance.
    fn newton(&mut self, guide: &Guide, at_bit: &AtBit, balance: f64) -> bool {
        let mut from = std::mem::take(&mut self.from);
        self.residual(guide, at_bit);
        let mut found = false;
        for _ in 0..ITERATIONS {
            self.step.clone_from(&self.residual);
            self.tangent(guide, at_bit);
            self.solves += 1;
            if self.tangent.solve(&mut self.step).is_none() {
                break;
            }
            from.clone_from(&self.state);
            let whole = self.search(guide, at_bit, &from);
            let most = self.residual.iter().fold(0.0, |most: f64, row| most.max(row.amax()));
            if whole && most <= balance {
                found = true;
                break;
            }
            if !most.is_finite() {
                break;
            }
        }
        self.from = from;
        found
    }

    /// Takes the share of the step at which the residual no longer points along it: for conservative forces the lowest
    /// potential. Returns whether that is the whole step.
    fn search(&mut self, guide: &Guide, at_bit: &AtBit, from: &[Vector4<f64>]) -> bool {
        let along = |residual: &[Vector4<f64>], step: &[Vector4<f64>]| -> f64 {
            residual
                .iter()
                .zip(step)
                .map(|(residual, step)| residual.dot(step))
                .sum()
        };
        let start = along(&self.residual, &self.step);
        let (mut low, mut at_low, mut high) = (0.0, start, 1.0);
        let mut share = 1.0;
        loop {
            for (state, (from, step)) in self.state.iter_mut().zip(from.iter().zip(&self.step)) {
                *state = from + step * share;
            }
            self.residual(guide, at_bit);
            let now = along(&self.residual, &self.step);
            // Beyond the root the sign changes. At the end of the iteration both are roundings.
            if now.abs() <= 0.8 * start.abs() || share < SHORTEST || high - low < SHORTEST {
                return share >= 1.0;
            }
            if start <= 0.0 || now * start > 0.0 && share >= 1.0 {
                // Uphill, or steeper behind the whole step: no root to be found between.
                return share >= 1.0;
            }
            if now * start > 0.0 {
                (low, at_low) = (share, now);
            } else {
                high = share;
            }
            // The secant, kept away from both ends.
            let secant = low + (high - low) * at_low.abs() / (at_low.abs() + now.abs());
            share = if now * start > 0.0 {
                f64::midpoint(low, high)
            } else {
                secant
            }
            .clamp(low + 0.1 * (high - low), high - 0.1 * (high - low));
        }
    }

    /// Length of hole whose wall acts on a point (m).
    fn tributary(&self, index: usize) -> f64 {
        let below = self.pieces.get(index).map_or(0.0, |piece| piece.length);
        let above = if index > 0 { self.pieces[index - 1].length } else { 0.0 };
        0.5 * (above + below)
    }

    /// Force of point `index` on the wall (right, low) (N) and its derivative by the offset. Both ends are not on the wall.
    fn wall(&self, guide: &Guide, index: usize) -> Option<(Vector2<f64>, Matrix2<f64>)> {
        let state = self.state[index];
        let offset = Vector2::new(state.x, state.z);
        let radius = offset.norm();
        let depth = radius - guide.gap;
        if depth <= 0.0 || index == 0 || index + 1 == self.state.len() {
            return None;
        }
        let stiffness = guide.wall_stiffness * self.tributary(index);
        let normal = offset / radius;
        let radial = normal * normal.transpose();
        let tangent = radial * stiffness + (Matrix2::identity() - radial) * (stiffness * depth / radius);
        Some((normal * (stiffness * depth), tangent))
    }

    /// Force of the bit on the rock by the law at the bit (N).
    fn bit_force(&self, at_bit: &AtBit) -> Vector2<f64> {
        match at_bit {
            AtBit::Held => self.reaction(self.state.len() - 1),
            AtBit::Cutting {
                offset,
                slope,
                constant,
            } => {
                let bit = self.state[self.state.len() - 1];
                offset * Vector2::new(bit.x, bit.z) + slope * Vector2::new(bit.y, bit.w) + constant
            }
        }
    }

    /// Force (N) with which beam and loads push on what holds the offset of a point.
    fn reaction(&self, index: usize) -> Vector2<f64> {
        let mut force = self.load[index] - self.stiffness.diagonal[index] * self.state[index];
        if index > 0 {
            force -= self.stiffness.upper[index - 1].tr_mul(&self.state[index - 1]);
        }
        if let Some(coupling) = self.stiffness.upper.get(index) {
            force -= coupling * self.state[index + 1];
        }
        Vector2::new(force.x, force.z)
    }

    /// Sets the residual (forces without balance) at the state.
    fn residual(&mut self, guide: &Guide, at_bit: &AtBit) {
        self.stiffness.times(&self.state, &mut self.residual);
        for (residual, load) in self.residual.iter_mut().zip(&self.load) {
            *residual = load - *residual;
        }
        for index in 1..self.state.len() - 1 {
            if let Some((force, _)) = self.wall(guide, index) {
                self.residual[index].x -= force.x;
                self.residual[index].z -= force.y;
            }
        }
        let last = self.state.len() - 1;
        let force = self.bit_force(at_bit);
        self.residual[last].x -= force.x;
        self.residual[last].z -= force.y;
        // The upper end is on the axis.
        self.residual[0].x = 0.0;
        self.residual[0].z = 0.0;
        if matches!(at_bit, AtBit::Held) {
            self.residual[last].x = 0.0;
            self.residual[last].z = 0.0;
        }
    }

    /// Sets the tangent matrix: stiffness, walls, the law at the bit, and held offsets as rows of the identity.
    fn tangent(&mut self, guide: &Guide, at_bit: &AtBit) {
        self.tangent.clone_from(&self.stiffness);
        for index in 1..self.state.len() - 1 {
            if let Some((_, wall)) = self.wall(guide, index) {
                let block = &mut self.tangent.diagonal[index];
                for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    block[(2 * row, 2 * column)] += wall[(row, column)];
                }
            }
        }
        let last = self.state.len() - 1;
        hold(&mut self.tangent.diagonal[0]);
        if let Some(coupling) = self.tangent.upper.first_mut() {
            coupling.row_mut(0).fill(0.0);
            coupling.row_mut(2).fill(0.0);
        }
        match at_bit {
            AtBit::Held => {
                hold(&mut self.tangent.diagonal[last]);
                let coupling = &mut self.tangent.upper[last - 1];
                coupling.column_mut(0).fill(0.0);
                coupling.column_mut(2).fill(0.0);
            }
            AtBit::Cutting { offset, slope, .. } => {
                let block = &mut self.tangent.diagonal[last];
                for row in 0..2 {
                    for column in 0..2 {
                        block[(2 * row, 2 * column)] += offset[(row, column)];
                        block[(2 * row, 2 * column + 1)] += slope[(row, column)];
                    }
                }
            }
        }
    }

    /// Sets how the thrust of the forces at the state differs from the thrust in use, from the bit up.
    ///
    /// C' = kb V_z - ky V_y + (weight along the hole) - (friction), with the shear V of the beam in the hole's frame:
    /// (V_y, V_z)' = C y'' - q + (force of the wall), V = -F at the bit. In the potential of an element, moment and change
    /// of curvature across the hole (ring) have a part M . y'' of the load that the thrust has on the curve. The potential
    /// therefore has C - M . y'' in the place of C. In an arc without axial loads that is the weight at the bit.
    fn thrust_change(&mut self, guide: &Guide, weight: f64) {
        let last = self.state.len() - 1;
        // The beam's own balance gives the force at the bit, whatever holds it.
        let mut shear = -self.reaction(last);
        let mut thrust = weight;
        self.change.clear();
        self.change.resize(last, 0.0);
        self.axial.clear();
        self.axial.resize(last + 1, weight);
        for index in (0..last).rev() {
            let piece = self.pieces[index];
            let gradient = piece.turn * thrust - piece.weight;
            let middle = shear - gradient * (0.5 * piece.length);
            let rise = -piece.turn.dot(&middle) + piece.weight_along;
            let of_piece = thrust - 0.5 * rise * piece.length;
            let multiplier = of_piece
                - piece
                    .moment(guide, &self.state[index], &self.state[index + 1], of_piece)
                    .dot(&piece.turn);
            self.change[index] = multiplier - weight - self.excess[index];
            thrust -= rise * piece.length;
            shear -= gradient * piece.length;
            if let Some((force, _)) = self.wall(guide, index) {
                shear -= force;
                thrust += guide.wall_friction * force.norm();
            }
            self.axial[index] = thrust;
        }
    }

    /// Slope of the bit against the hole's tangent (right, low) (rad).
    pub(crate) fn tilt(&self) -> Vector2<f64> {
        let bit = self.state[self.state.len() - 1];
        Vector2::new(bit.y, bit.w)
    }

    /// Offset of the bit from the hole's end (right, low) (m).
    pub(crate) fn bit_offset(&self) -> Vector2<f64> {
        let bit = self.state[self.state.len() - 1];
        Vector2::new(bit.x, bit.z)
    }

    /// Force of the bit on the rock (right, low) (N).
    pub(crate) fn side_force(&self) -> Vector2<f64> {
        self.reaction(self.state.len() - 1)
    }

    /// Length between the bit and the first contact (m); that of the guide without contact.
    pub(crate) fn free_length(&self, guide: &Guide) -> f64 {
        let mut length = 0.0;
        for index in (0..self.pieces.len()).rev() {
            length += self.pieces[index].length;
            if self.wall(guide, index).is_some() {
                break;
            }
        }
        length
    }

    pub(crate) fn equilibrium(&self, guide: &Guide) -> Equilibrium {
        let wall = |index| self.wall(guide, index).map_or_else(Vector2::zeros, |(force, _)| force);
        Equilibrium {
            side_force: self.side_force(),
            tilt: self.tilt(),
            offsets: self.state.iter().map(|state| Vector2::new(state.x, state.z)).collect(),
            wall_forces: (0..self.state.len()).map(wall).collect(),
            top_force: self.reaction(0),
            thrust: self.thrust.clone(),
            free_length: self.free_length(guide),
        }
    }
}

/// Makes the rows and columns of a block's offsets those of the identity.
fn hold(block: &mut Matrix4<f64>) {
    for offset in [0, 2] {
        block.row_mut(offset).fill(0.0);
        block.column_mut(offset).fill(0.0);
        block[(offset, offset)] = 1.0;
    }
}

/// Equilibrium of a guide whose bit is on the axis at the end of a hole and turns freely there.
///
/// A weight of 0 is allowed: of the law nothing but its weight acts.
///
/// # Errors
/// [`HoleError::Invalid`] for numbers out of bounds; [`HoleError::HoleTooShort`]; [`HoleError::NoEquilibrium`].
pub fn at_rest(guide: &Guide, weight: f64, hole: &Hole) -> Result<Equilibrium, HoleError> {
    guide.check()?;
    flexdrill_base::validation::Bound::NotNegative.check("weight", weight, "N")?;
    require(hole.points().len() > 2, "hole", "fewer than two chords: shorten them")?;
    let mut statics = Statics::default();
    let law = BitLaw::sharp(weight, 1.0);
    statics.solve(guide, &law, hole, &AtBit::Held)?;
    Ok(statics.equilibrium(guide))
}
