//! The chain of nodes that every step is taken over: pipe and guide between two nodes move as their ends do.
//!
//! A span is the part of pipe and guide between two nodes. Its inner stations are slaved statically,
//! x_i = -K_ii^-1 K_ie x_e (Guyan), so that stiffness, mass and geometric stiffness of a span are matrices over its two
//! ends. The displacement of a
//! joint's start below follows from that of the end above, u_b = E_b^T E_a u_a, so that the translational rows are kept
//! exactly and have no multipliers. A node has 16 places:
//!
//! | place | unknown |
//! |---|---|
//! | 0..3 | rotations above |
//! | 3..6 | displacement of the pipe |
//! | 6..9 | rotations below, of which some or all follow from the others ([`dependents`]) |
//! | 9..15 | guide |
//! | 15 | multiplier of the axial tie, in the last node |
//!
//! Effects act at all stations: one inside a span moves with both ends, and what pushes it acts on both, through the slaving.
//! Slaving holds where inner stations vibrate faster than a step can follow; [`nodes`] places the nodes so that it does.

mod active;
pub(crate) mod columns;
mod deflection;
mod dependents;
pub(crate) mod double;
mod effect;
mod energy;
mod equations;
mod geometric;
mod linear;
mod links;
mod motion;
mod nodes;
mod numbering;
mod operator;
mod precision;
mod residual;
mod single;
mod slaving;
mod solve;
mod start;
mod tangent;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::dynamics::conditions::Conditions;
use crate::dynamics::numbered::Numbered;
use crate::dynamics::tolerances::{Accuracy, Limits, Tolerances};
use crate::elements::factors::TangentFactors;
use crate::elements::joint::Joint;
use crate::model::{Model, Places};
use crate::simd::Instructions;
use crate::simd::aligned::Aligned;

use active::Active;
use columns::EndForces;
use dependents::{Dependents, FIRST_ROW, SECOND_ROW, Spins};
use links::{ConstantForces, Link};
use nodes::Nodes;
use operator::Operator;
use single::SingleSweep;
use slaving::LinkMatrices;
use solve::Sweep;

pub(crate) use effect::{Along, Asked, Carrier, Effect, EndLoad, FromAbove, Inside, Touched, Under};
pub(crate) use energy::add_to_ends;
pub(crate) use equations::ChainEquations;
pub(crate) use linear::{Acting, CoupledParts, Parts, Segment};
pub(crate) use motion::SpanMotion;
use numbering::Numbering;
pub(crate) use precision::{Lanes, Precision};
pub(crate) use slaving::row;
pub(crate) use tangent::{Additions, Touching};

/// Unknowns per node.
pub(crate) const NODE: usize = 16;
/// First of the displacement.
const U: usize = 3;
/// First of the guide.
pub(crate) const GUIDE: usize = 9;
/// Place of the tie's multiplier, and after the last of the guide.
const TIE: usize = 15;
/// Stations per span, its lower end included, that one vector of eight holds.
const MOST_STATIONS: usize = 8;

/// Least product of a span's slowest inner frequency, its ends clamped (rad/s), and the step (s). What a step resolves
/// is slower than 1 / h; inner stations answer it quasi-statically to 1 / 3^2.
const LEAST_FREQUENCY: f64 = 3.0;
/// The same for parts of a step, which keep the spans of the whole. A finer step is taken for faster motions, which inner
/// stations must then answer to 1 / 8^2.
const LEAST_REFINED: f64 = 8.0;
/// Largest deflection of a span between its ends under what effects push back with when all its inner stations are
/// displaced by 1: the largest row sum of K_ii^-1 times their stiffness. As spans are deflected by the forces of
/// the step before, an error of the deflection shrinks by this from step to step, and would grow above 1.
const MOST_COMPLIANCE: f64 = 0.5;

/// Corrections of a step that are solved in single precision; a step that needs more is solved in double from there on.
const SINGLE_CORRECTIONS: u32 = 6;

/// Places in a node of the twelve unknowns of a span's top end, pipe then guide: one after the other.
pub(crate) const TOP: [usize; 12] = [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14];
/// Of its bottom end.
pub(crate) const BOTTOM: [usize; 12] = [0, 1, 2, 3, 4, 5, 9, 10, 11, 12, 13, 14];

/// What does not change while the tool moves.
pub(crate) struct ChainModel {
    /// Vector instructions.
    pub(crate) instructions: Instructions,
    /// Inner frequency of the slowest span (rad/s).
    slowest: f64,
    nodes: Nodes,
    /// Matrices of the spans that differ.
    kinds: Vec<LinkMatrices>,
    /// The spans, top to bottom.
    pub(crate) links: Vec<Link>,
    /// Rotational rows per joint that are constraints; with play none.
    joint_rows: usize,
    numbering: Numbering,
    pub(crate) places: Places,
    /// What the drive prescribes: the spin of the first node, above and below.
    driven: Vec<usize>,
    /// Consistent forces of gravity (N, N m).
    weight: Vec<f64>,
    /// Masses of effects at nodes: the unknown, and the mass (kg) or inertia (kg m2) of its direction.
    node_masses: Vec<(usize, f64)>,
    /// Constant forces of effects, which have a potential (N, N m); empty without any.
    potential: Vec<f64>,
    /// Sum of both.
    constant: Vec<f64>,
    /// Rows of each node whose unknowns are free, 1, or held, 0; `None` where all are free.
    rows: Vec<Option<[f64; NODE]>>,
    /// Per unknown 1, or 0 for the tie's multiplier, which has no velocity.
    moving: Vec<f64>,
}

impl ChainModel {
    /// Matrices of span `l`.
    #[inline(always)]
    pub(crate) fn kind(&self, l: usize) -> &LinkMatrices {
        &self.kinds[self.links[l].kind]
    }

    /// The span that a station is in, and which of its stations it is; that of its top end is 0.
    #[inline(always)]
    pub(crate) fn span_of(&self, station: usize) -> (usize, usize) {
        self.nodes.stations[station]
    }

    /// The tool in the chain's numbering.
    pub(crate) fn numbered<'a>(&'a self, model: &'a Model) -> Numbered<'a> {
        Numbered {
            model,
            places: &self.places,
            weight: &self.weight,
        }
    }
}

/// The chain of nodes: its model, what a residual evaluates, and the room that a step needs.
#[derive(Clone)]
pub(crate) struct Chain {
    pub(crate) model: Arc<ChainModel>,
    /// Step-constant tangents, one per step size.
    operators: Vec<Arc<Operator>>,
    limits: Limits,
    /// Corrections of a step that are solved in single precision; with none the tangent has the geometric stiffness.
    single_corrections: u32,
    /// How closely the step is solved.
    accuracy: Accuracy,
    /// The nodes and spans that the present correction changes.
    active: Active,
    foreseen: Vec<[f64; 2]>,
    foreseen_part: f64,
    /// Forces of the spans on their ends: elastic, damping and inertia forces.
    linear: Vec<Aligned<EndForces>>,
    /// Those of geometric stiffness per axial force; one lane holds the axial force of the displacements.
    pub(crate) geometric_forces: Vec<Aligned<EndForces>>,
    /// Those of effects inside the spans, and whether there are any.
    inside: Vec<Aligned<EndForces>>,
    has_inside: Vec<bool>,
    /// What effects do to the pipe of each span along its axis.
    pub(crate) along: Vec<Along>,
    /// The rotations of each node that follow from its others.
    dependents: Vec<Dependents>,
    /// The same of joints with one row, eight at a time.
    spins: Vec<Spins>,
    /// Multipliers of the rotational rows of each joint (N m).
    multipliers: Vec<[f64; 2]>,
    /// Residual with its reactions.
    residual: Vec<f64>,
    /// What effects add to the tangent, in both precisions.
    additions: Additions<f64>,
    single_additions: Additions<f32>,
    sweep: Sweep,
    single_sweep: SingleSweep,
    /// The last correction.
    correction: Vec<f64>,
}

impl Chain {
    /// The chain of a tool for steps of size `h` (s), with what effects add to it.
    pub(crate) fn of(
        model: &Model,
        tolerances: &Tolerances,
        h: f64,
        acting: &Acting,
        instructions: Instructions,
    ) -> Self {
        let nodes = Nodes::of(model, acting, h);
        Self::over(model, tolerances, acting, nodes, SINGLE_CORRECTIONS, instructions)
    }

    /// The chain with a node at every station, for steps of any size, solved in double precision. Nothing is slaved, so that
    /// it finds a tool at rest under what acts at all stations.
    pub(crate) fn over_stations(
        model: &Model,
        tolerances: &Tolerances,
        acting: &Acting,
        instructions: Instructions,
    ) -> Self {
        let nodes = Nodes::at_every_station(model, acting);
        Self::over(model, tolerances, acting, nodes, 0, instructions)
    }

    /// Over these nodes, with the matrices of the spans between them.
    fn over(
        model: &Model,
        tolerances: &Tolerances,
        acting: &Acting,
        (points, spans): (Nodes, Vec<LinkMatrices>),
        single_corrections: u32,
        instructions: Instructions,
    ) -> Self {
        // Numbering and places first: everything below is given by places in the chain.
        let numbering = Numbering::of(model, &points);
        let place = |unknown: usize| numbering::place(model, &points, unknown);
        let places = model.places.renumbered(place, |unknown| numbering.place(unknown));
        let nodes = points.list.len();
        let node_masses = (acting.at_nodes)(model).into_iter();
        let node_masses = node_masses.flat_map(|(first, masses)| (0..6).map(move |k| (place(first + k), masses[k])));
        let node_masses: Vec<(usize, f64)> = node_masses.collect();
        let (kinds, mut links) = links::links(model, &points, spans);
        // The slowest span bounds the step from below, for all spans alike.
        let slowest = kinds.iter().fold(f64::INFINITY, |least, kind| least.min(kind.slowest));
        let spans = links.len();
        // The drive holds the spin above and below, so that its joint's row cannot turn the node.
        let mut driven: Vec<usize> = places.driven.into_iter().collect();
        driven.extend(places.driven.map(|spin| spin + FIRST_ROW));
        let held = numbering.held(model, places.driven);
        // A factor per row, so that held rows are zeroed by a product and not by a branch.
        let mut rows = vec![None; nodes];
        for &unknown in &held {
            rows[unknown / NODE].get_or_insert([1.0; NODE])[unknown % NODE] = 0.0;
        }
        let unknowns = NODE * nodes;
        let (force, moment) = (tolerances.force, tolerances.moment);
        let moving_force = tolerances.moving_force(model);
        let moving_moment = moving_force * tolerances.moving_moment;
        let joint_rows = Joint::constraints(&model.description.joint);
        // A tool in motion is judged by larger limits than one at rest; rows of constraints have their own in both.
        let limits = |force: f64, moment: f64| {
            let mut limits = vec![moment; unknowns];
            for (node, at) in limits.chunks_exact_mut(NODE).zip(&points.list) {
                node[U..U + 3].fill(force);
                node[GUIDE..GUIDE + 3].fill(force);
                let rows = tolerances.constraint * model.moment_scale;
                match at.joint {
                    Some(_) if joint_rows > 0 => node[FIRST_ROW] = rows,
                    // With play the spin below has an equation of its own.
                    Some(_) => {}
                    // No joint: the three rotations below follow by definition and have no equation to violate.
                    None => node[6..9].fill(f64::INFINITY),
                }
                node[SECOND_ROW] = if at.joint.is_some() && joint_rows > 1 {
                    rows
                } else {
                    f64::INFINITY
                };
            }
            if let Some(tie) = places.tie {
                limits[tie] = tolerances.constraint * model.force_scale;
            }
            // Reactions of supports are not out of balance, whatever their size.
            held.iter().for_each(|&unknown| limits[unknown] = f64::INFINITY);
            limits.iter().map(|limit| 1.0 / limit).collect::<Vec<f64>>()
        };
        // Weight is a constant force per span. It is condensed once, with the spans' own matrices.
        let ConstantForces { weight, potential } =
            links::constant_forces(model, acting, &points, &kinds, &mut links, unknowns);
        // The residual subtracts one vector; the audit needs both apart.
        let mut constant = weight.clone();
        constant
            .iter_mut()
            .zip(&potential)
            .for_each(|(sum, force)| *sum += force);
        Self {
            operators: Vec::new(),
            limits: Limits::new(limits(force, moment), limits(moving_force, moving_moment)),
            single_corrections,
            accuracy: Accuracy::Rest,
            active: Active::new(nodes),
            foreseen: vec![[0.0; 2]; spans],
            foreseen_part: 0.0,
            linear: vec![Aligned([[0.0; 16]; 2]); spans],
            geometric_forces: vec![Aligned([[0.0; 16]; 2]); spans],
            inside: vec![Aligned([[0.0; 16]; 2]); spans],
            has_inside: vec![false; spans],
            along: vec![Along::default(); spans],
            dependents: points
                .list
                .iter()
                .map(|node| Dependents::of(node, joint_rows))
                .collect(),
            spins: vec![Spins::default(); model.joints.len().div_ceil(8)],
            multipliers: vec![[0.0; 2]; model.joints.len()],
            residual: vec![0.0; unknowns],
            additions: Additions::new(nodes),
            single_additions: Additions::new(nodes),
            sweep: Sweep::new(nodes),
            single_sweep: SingleSweep::new(nodes),
            correction: vec![0.0; unknowns],
            model: Arc::new(ChainModel {
                instructions,
                slowest,
                nodes: points,
                kinds,
                links,
                joint_rows,
                numbering,
                places,
                driven,
                weight,
                node_masses,
                potential,
                constant,
                rows,
                // The tie's multiplier is a force: it has no velocity to predict.
                moving: (0..unknowns)
                    .map(|unknown| if unknown % NODE == TIE { 0.0 } else { 1.0 })
                    .collect(),
            }),
        }
    }

    /// Halvings of a step of size `h` (s) down to the smallest that the slaving of inner stations holds for.
    pub(crate) fn finest_refinement(&self, h: f64) -> u32 {
        let mut halvings = 0;
        while halvings < 31 && self.model.slowest * h / f64::from(2_u32 << halvings) >= LEAST_REFINED {
            halvings += 1;
        }
        halvings
    }

    /// Number of unknowns.
    pub(crate) fn unknowns(&self) -> usize {
        NODE * self.model.nodes.list.len()
    }

    /// Number of nodes.
    pub(crate) fn nodes(&self) -> usize {
        self.model.nodes.list.len()
    }

    /// Number of spans.
    pub(crate) fn spans(&self) -> usize {
        self.model.links.len()
    }

    /// Whether the whole tool is part of the present correction.
    #[inline(always)]
    pub(crate) fn is_whole(&self) -> bool {
        self.active.whole
    }

    /// Whether span `l` is part of the present correction.
    #[inline(always)]
    pub(crate) fn is_active(&self, l: usize) -> bool {
        self.active.spans[l]
    }

    /// Whether the residual of `unknown` is evaluated after the present correction.
    pub(crate) fn is_affected(&self, unknown: usize) -> bool {
        self.active.affected[unknown / NODE]
    }

    /// The span that a station is in, and which of its stations it is; that of its top end is 0.
    #[inline(always)]
    pub(crate) fn span_of(&self, station: usize) -> (usize, usize) {
        self.model.span_of(station)
    }

    /// Station `i` of span `l`.
    #[inline(always)]
    pub(crate) fn station(&self, l: usize, i: usize) -> usize {
        self.model.nodes.first(l) + i
    }

    /// The stations of span `l`, that of its top end left out.
    #[inline(always)]
    pub(crate) fn stations_below(&self, l: usize) -> std::ops::Range<usize> {
        self.model.nodes.first(l) + 1..self.model.nodes.first(l + 1) + 1
    }

    /// The elements of span `l`.
    #[inline(always)]
    pub(crate) fn elements_of(&self, l: usize) -> std::ops::Range<usize> {
        self.model.nodes.first(l)..self.model.nodes.first(l + 1)
    }

    /// Forces of what acts inside span `l` on its ends, pipe and guide: zero before the first is added in a residual.
    #[inline(always)]
    pub(crate) fn inside(&mut self, l: usize) -> &mut EndForces {
        if !self.has_inside[l] {
            self.has_inside[l] = true;
            *self.inside[l] = [[0.0; 16]; 2];
        }
        &mut self.inside[l].0
    }

    /// Takes what acts inside the spans that are part of the present correction out, as they are evaluated again.
    fn clear_inside(&mut self) {
        for (any, moved) in self.has_inside.iter_mut().zip(&self.active.spans) {
            *any &= !moved;
        }
    }

    /// Forces of what acts inside all spans, to be added to where [`Chain::inside`] has been asked for.
    #[inline(always)]
    pub(crate) fn forces_inside(&mut self) -> Inside<'_> {
        Inside {
            model: &self.model,
            forces: &mut self.inside,
            moved: &self.active.spans,
        }
    }

    /// Whether the tangent has the geometric stiffness.
    fn has_geometric_stiffness(&self) -> bool {
        self.single_corrections == 0
    }

    /// Makes what steps with these factors need, and forgets what others did.
    pub(crate) fn prepare_only(&mut self, model: &Model, conditions: &Conditions, factors: TangentFactors) {
        self.operators.clear();
        self.prepare(model, conditions, factors);
    }

    /// Makes what steps with these factors need.
    pub(crate) fn prepare(&mut self, model: &Model, conditions: &Conditions, factors: TangentFactors) {
        if self.operator(factors, conditions).is_none() {
            let operator = Operator::of(self, model, factors, conditions);
            self.operators.push(Arc::new(operator));
        }
    }

    fn operator(&self, factors: TangentFactors, conditions: &Conditions) -> Option<usize> {
        self.operators
            .iter()
            .position(|operator| operator.is_for(factors, conditions))
    }
}
