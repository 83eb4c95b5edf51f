//! The matrices of a span whose inner stations are slaved to its ends (Guyan): made once per tool.

mod columns_of;
mod guyan;

use columns_of::{columns, end_column, force_rows, lateral_columns, motion_columns, with_tension};
use guyan::{Guyan, slowest};
use nalgebra::{DMatrix, DVector, Matrix3};

use super::columns::EndColumn;
use super::linear::{Acting, CoupledParts, Parts, Segment};
use super::precision::OnNodesInBoth;
use crate::model::Model;
use crate::simd::aligned::Aligned;

/// Relative difference below which the matrices of two spans count as one: links of a regular tool differ by the rounding
/// of their geometry only. Sharing keeps them in the first-level cache.
const SAME: f64 = 1e-11;

/// A matrix of a span over both its ends, by columns.
type SpanMatrix = [EndColumn; 12];
/// Motions at a station of pipe and guide by the twelve unknowns of the ends: six lanes, and two that do not count.
type MotionColumns = [[[f64; 8]; 12]; 2];
/// What the six components of a local force at a station do, to the ends or to the inner stations: on pipe and guide.
type ForceRows = [[EndColumn; 6]; 2];

/// Matrices of a span over its ends, by columns: six of the top end, six of the bottom end.
#[derive(Debug, Clone)]
pub(crate) struct LinkMatrices {
    /// Stiffness, mass and geometric stiffness per tension, of pipe and guide.
    pub stiffness: Aligned<[SpanMatrix; 2]>,
    pub mass: Aligned<[SpanMatrix; 2]>,
    pub geometric: Aligned<[SpanMatrix; 2]>,
    /// Stiffness of the guide that stores but does not damp; none where it has none.
    pub undamped: Option<Box<Aligned<SpanMatrix>>>,
    /// What pipe and guide have of each other, and viscous damping; none where they have none.
    pub coupled: Option<Box<Coupled>>,
    /// Mean axial force (N) by the ends' displacements; also in lane [`TENSION`] of the geometric stiffness.
    pub tension: Aligned<[EndColumn; 2]>,
    /// E A / L of the pipe (N/m).
    pub axial: f64,
    /// Lateral position of each station but the first in its station's frame: y in 0..8, z in 8..16.
    pub lateral: Aligned<[SpanMatrix; 2]>,
    /// Local motion of each station, the top included: the pipe's in the station's frame, rotations times its radius; the
    /// guide's.
    pub motion: Vec<Aligned<MotionColumns>>,
    /// The same by rows: forces on the ends by the components of a local force.
    pub force: Vec<Aligned<ForceRows>>,
    /// Forces on the unknowns of both nodes by local ones at each station, in both precisions.
    pub on_nodes: OnNodesInBoth,
    /// Displacements of the inner nodes in their own frames, columns of a node one after the other.
    pub inner: Vec<Aligned<MotionColumns>>,
    /// Lateral deflection of the inner stations, as `lateral`, by a local force at each of them, the ends held.
    pub deflection: Vec<Aligned<ForceRows>>,
    /// Slowest frequency of pipe or guide, the ends held (rad/s).
    pub slowest: f64,
    /// Displacements of all nodes by the unknowns of the ends.
    pub slaved: [DMatrix<f64>; 2],
    /// K_ii^-1 of pipe and guide.
    pub compliance: [DMatrix<f64>; 2],
}

/// What couples pipe and guide of a span all along, and its viscous damping. The mass of either by its own motion is in its mass.
#[derive(Debug, Clone)]
pub(crate) struct Coupled {
    /// Mass on the ends of pipe and guide by the motion of the other's.
    pub mass_across: Aligned<[SpanMatrix; 2]>,
    /// Damping by the own motion, and by that of the other's ends.
    pub damping: Aligned<[SpanMatrix; 2]>,
    pub damping_across: Aligned<[SpanMatrix; 2]>,
}

impl Coupled {
    /// What `parts` over all nodes come to at the ends.
    fn of(parts: &CoupledParts, slaved: &[DMatrix<f64>; 2]) -> Self {
        let on_ends =
            |body: usize, matrix: &DMatrix<f64>, by: usize| columns(&(slaved[body].transpose() * matrix * &slaved[by]));
        let across = |matrix: &DMatrix<f64>| Aligned([on_ends(0, matrix, 1), on_ends(1, &matrix.transpose(), 0)]);
        let [pipe, damping, guide] = &parts.damping;
        Self {
            mass_across: across(&parts.mass[1]),
            damping: Aligned([on_ends(0, pipe, 0), on_ends(1, guide, 1)]),
            damping_across: across(damping),
        }
    }

    fn is_close(&self, other: &Self) -> bool {
        [
            (&self.mass_across, &other.mass_across),
            (&self.damping, &other.damping),
            (&self.damping_across, &other.damping_across),
        ]
        .into_iter()
        .all(|(a, b)| (0..2).all(|body| near(a[body].as_flattened(), b[body].as_flattened())))
    }
}

/// Whether two lists of numbers are the same but for rounding.
fn near(a: &[f64], b: &[f64]) -> bool {
    let scale = a.iter().chain(b).fold(0.0_f64, |m, x| m.max(x.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * scale)
}

impl LinkMatrices {
    /// Of the span of `per` elements below station `first`.
    pub fn of(model: &Model, acting: &Acting, first: usize, per: usize) -> Self {
        let span = Span {
            at: Segment {
                model,
                first,
                elements: per,
            },
            model,
            first,
            per,
        };
        let parts = acting.parts(&span.at);
        let matrices = span.assembled(&parts);
        let [pipe, guide] = span.slaving(&matrices, &parts);
        let slowest = span.slowest(&matrices, &parts, [&pipe, &guide]);
        let slaved = [pipe.slaved * span.to_node_unknowns(), guide.slaved];
        let compliance = [pipe.compliance, guide.compliance];
        // Guyan: what the inner nodes' matrices come to at the ends, S^T A S.
        let condensed = |which: usize| {
            let of_body = |body: usize| columns(&(slaved[body].transpose() * &matrices[body][which] * &slaved[body]));
            Aligned([of_body(0), of_body(1)])
        };
        let tension = span.mean_tension(&slaved);
        let maps = span.station_maps(&slaved);
        let force: Vec<_> = maps.iter().map(force_rows).collect();
        Self {
            stiffness: condensed(STIFFNESS),
            mass: condensed(MASS),
            geometric: with_tension(condensed(GEOMETRIC), &tension),
            coupled: parts
                .coupled
                .as_ref()
                .map(|parts| Box::new(Coupled::of(parts, &slaved))),
            undamped: (parts.undamped.as_ref())
                .map(|undamped| Box::new(Aligned(columns(&(slaved[1].transpose() * undamped * &slaved[1]))))),
            tension: Aligned(tension.map(|tension| end_column(|j| tension[j]))),
            axial: span.axial(),
            lateral: lateral_columns(&maps),
            motion: maps.iter().map(motion_columns).collect(),
            on_nodes: OnNodesInBoth::of(force.iter().map(|rows| &**rows), model.guide_radii),
            force,
            inner: span.inner_displacements(&slaved),
            deflection: span.deflections(&compliance),
            slowest,
            slaved,
            compliance,
        }
    }

    /// What `forces` on all nodes of pipe (0) or guide (1) come to at both ends: the slaving condenses forces as it does
    /// displacements.
    pub fn on_ends(&self, body: usize, forces: &DVector<f64>) -> DVector<f64> {
        self.slaved[body].tr_mul(forces)
    }

    /// Largest deflection that springs of these stiffnesses (N/m; of pipe and guide, of guide and wall) make between the ends for a
    /// deflection of 1 in either direction at all inner stations: a bound on what is left of it from step to step.
    pub fn compliance(&self, [inner, outer]: [f64; 2]) -> f64 {
        let mut largest = 0.0_f64;
        for lane in 0..16 {
            let sum = |body: usize| {
                self.deflection
                    .iter()
                    .map(|at| at[body][1][lane].abs() + at[body][2][lane].abs())
                    .sum::<f64>()
            };
            largest = largest.max(inner * (sum(0) + sum(1)) + outer * sum(1));
        }
        largest
    }

    /// Whether `other` is the same but for rounding.
    pub fn is_close(&self, other: &Self) -> bool {
        (0..2).all(|body| {
            near(
                self.stiffness[body].as_flattened(),
                other.stiffness[body].as_flattened(),
            ) && near(self.mass[body].as_flattened(), other.mass[body].as_flattened())
                && near(
                    self.geometric[body].as_flattened(),
                    other.geometric[body].as_flattened(),
                )
                && near(&self.tension[body], &other.tension[body])
                && near(self.slaved[body].as_slice(), other.slaved[body].as_slice())
        }) && match (&self.undamped, &other.undamped) {
            (Some(a), Some(b)) => near(a.as_flattened(), b.as_flattened()),
            (None, None) => true,
            _ => false,
        } && match (&self.coupled, &other.coupled) {
            (Some(a), Some(b)) => a.is_close(b),
            (None, None) => true,
            _ => false,
        } && self
            .motion
            .iter()
            .zip(&other.motion)
            .all(|(a, b)| near(a.as_flattened().as_flattened(), b.as_flattened().as_flattened()))
    }
}

/// Which of the assembled matrices.
const STIFFNESS: usize = 0;
const MASS: usize = 1;
const GEOMETRIC: usize = 2;

/// A span whose matrices are made: `per` elements below station `first`.
struct Span<'a> {
    at: Segment<'a>,
    model: &'a Model,
    first: usize,
    per: usize,
}

impl Span<'_> {
    /// Stiffness, mass and geometric stiffness over all nodes of the span, of pipe and guide.
    fn assembled(&self, parts: &Parts) -> [[DMatrix<f64>; 3]; 2] {
        let size = 6 * (self.per + 1);
        let mut matrices: [[DMatrix<f64>; 3]; 2] =
            std::array::from_fn(|_| std::array::from_fn(|_| DMatrix::zeros(size, size)));
        for e in 0..self.per {
            let (pipe, guide) = (&self.model.pipe[self.first + e], &self.model.guide[self.first + e]);
            let parts = [
                [pipe.beam.stiffness(), pipe.beam.mass(), pipe.geometric],
                [guide.stiffness, guide.mass, guide.geometric],
            ];
            for (to, from) in matrices.iter_mut().flatten().zip(parts.iter().flatten()) {
                let mut part = to.view_mut((6 * e, 6 * e), (12, 12));
                part += from;
            }
        }
        if let Some(coupled) = &parts.coupled {
            let [pipe, _, guide] = &coupled.mass;
            matrices[0][MASS] += pipe;
            matrices[1][MASS] += guide;
        }
        matrices
    }

    /// Slowest frequency of the inner nodes, the ends held (rad/s). What couples pipe and guide lowers it.
    fn slowest(&self, [pipe, guide]: &[[DMatrix<f64>; 3]; 2], parts: &Parts, [of_pipe, of_guide]: [&Guyan; 2]) -> f64 {
        let alone = of_pipe.slowest.min(of_guide.slowest);
        let inner = 6 * (self.per - 1);
        let coupling = match parts.coupled.as_ref().map(|coupled| &coupled.mass) {
            Some([_, coupling, _]) if inner > 0 && alone > 0.0 && of_guide.slowest.is_finite() => coupling,
            _ => return alone,
        };
        let both = |pipe: &DMatrix<f64>, guide: &DMatrix<f64>, coupling: Option<&DMatrix<f64>>| {
            let part = |matrix: &DMatrix<f64>| matrix.view((6, 6), (inner, inner)).clone_owned();
            let mut out = DMatrix::zeros(2 * inner, 2 * inner);
            out.view_mut((0, 0), (inner, inner)).copy_from(&part(pipe));
            out.view_mut((inner, inner), (inner, inner)).copy_from(&part(guide));
            if let Some(coupling) = coupling.map(part) {
                out.view_mut((0, inner), (inner, inner)).copy_from(&coupling);
                out.view_mut((inner, 0), (inner, inner))
                    .copy_from(&coupling.transpose());
            }
            out
        };
        let undamped = parts.undamped.as_ref();
        let of_guide = undamped.map_or_else(|| guide[STIFFNESS].clone(), |undamped| &guide[STIFFNESS] + undamped);
        let stiffness = both(&pipe[STIFFNESS], &of_guide, None);
        let mass = both(&pipe[MASS], &guide[MASS], Some(coupling));
        // Without a frequency the span is split.
        slowest(&stiffness, &mass).unwrap_or(0.0).min(alone)
    }

    /// How the inner nodes of pipe and guide follow the ends.
    fn slaving(&self, [pipe, guide]: &[[DMatrix<f64>; 3]; 2], parts: &Parts) -> [Guyan; 2] {
        let of = |stiffness: &DMatrix<f64>, mass: &DMatrix<f64>| {
            // Inner nodes without a static solution count as infinitely slow, so that the span is split.
            Guyan::of(stiffness, mass).unwrap_or_else(|| Guyan {
                slowest: 0.0,
                ..Guyan::held(self.per)
            })
        };
        let guide = if self.model.description.guide_fixed {
            Guyan::held(self.per)
        } else {
            match &parts.undamped {
                Some(undamped) => of(&(&guide[STIFFNESS] + undamped), &guide[MASS]),
                None => of(&guide[STIFFNESS], &guide[MASS]),
            }
        };
        [of(&pipe[STIFFNESS], &pipe[MASS]), guide]
    }

    /// From the unknowns of the nodes at both ends to the displacements of the pipe's ends. A node has the displacement of
    /// the end above its joint, in the frame there, u_b = E_b^T E_a u_a; and at the span's bottom end a node lists the
    /// rotations before the displacements.
    fn to_node_unknowns(&self) -> DMatrix<f64> {
        let mut turned = DMatrix::<f64>::identity(12, 12);
        if let Some(joint) = self.model.stations[self.first].joint {
            let joint = &self.model.joints[joint];
            let turn: Matrix3<f64> = joint.lower.transpose() * joint.upper;
            turned.view_mut((0, 0), (3, 3)).copy_from(&turn);
        }
        let mut order = DMatrix::<f64>::zeros(12, 12);
        for i in 0..6 {
            order[(i, i)] = 1.0;
            order[(6 + i, 6 + (i + 3) % 6)] = 1.0;
        }
        turned * order
    }

    /// Mean axial force (N) of the elements by the unknowns of the ends.
    fn mean_tension(&self, slaved: &[DMatrix<f64>; 2]) -> [[f64; 12]; 2] {
        let Self { model, first, per, .. } = *self;
        let of_pipe = |e: usize, j: usize| {
            let column = slaved[0].column(j);
            let stretch = column[6 * e + 6] - column[6 * e];
            model.pipe[first + e].beam.tension(stretch)
        };
        let of_guide = |e: usize, j: usize| {
            let column = slaved[1].column(j);
            model.guide[first + e].tension(|k| column[6 * e + k])
        };
        let mean = |sum: f64| sum / per as f64;
        [
            std::array::from_fn(|j| mean((0..per).map(|e| of_pipe(e, j)).sum())),
            std::array::from_fn(|j| mean((0..per).map(|e| of_guide(e, j)).sum())),
        ]
    }

    /// Axial stiffness of the pipe's elements one after the other (N/m).
    fn axial(&self) -> f64 {
        let elements = &self.model.pipe[self.first..self.first + self.per];
        1.0 / elements.iter().map(|e| 1.0 / e.beam.tension(1.0)).sum::<f64>()
    }

    /// The local motion of pipe and guide at each station, the top included, by the unknowns of the ends: six rows, twelve
    /// columns. At the span's top it is the span above that has the station, but for the tool's first station.
    fn station_maps(&self, slaved: &[DMatrix<f64>; 2]) -> Vec<[DMatrix<f64>; 2]> {
        let at = |i: usize, body: usize| local(self.model, self.first + i, body) * slaved[body].rows(6 * i, 6);
        (0..=self.per).map(|i| [at(i, 0), at(i, 1)]).collect()
    }

    /// Displacements of the inner nodes in their own frames by the unknowns of the ends.
    fn inner_displacements(&self, slaved: &[DMatrix<f64>; 2]) -> Vec<Aligned<MotionColumns>> {
        let columns = |i: usize, body: usize| {
            std::array::from_fn(|j| {
                let mut column = [0.0; 8];
                (0..6).for_each(|k| column[k] = slaved[body][(6 * i + k, j)]);
                column
            })
        };
        (1..self.per).map(|i| Aligned([columns(i, 0), columns(i, 1)])).collect()
    }

    /// Lateral deflection of all inner stations by a local force at each of them, the ends held: w = K_ii^-1 f_i.
    fn deflections(&self, compliance: &[DMatrix<f64>; 2]) -> Vec<Aligned<ForceRows>> {
        let Self { model, first, per, .. } = *self;
        let by_force_at = |i: usize, body: usize| {
            let bent = compliance[body].columns(6 * (i - 1), 6) * local(model, first + i, body).transpose();
            let mut columns = [[0.0; 16]; 6];
            for at in 1..per {
                let lateral = local_lateral(model, first + at, body) * bent.rows(6 * (at - 1), 6);
                for (k, column) in columns.iter_mut().enumerate() {
                    (column[at - 1], column[8 + at - 1]) = (lateral[(0, k)], lateral[(1, k)]);
                }
            }
            columns
        };
        (1..per)
            .map(|i| Aligned([by_force_at(i, 0), by_force_at(i, 1)]))
            .collect()
    }
}

/// From a node's displacements to the local motion at a station: the pipe's in the station's frame, rotations times its
/// radius; the guide's.
fn local(model: &Model, station: usize, body: usize) -> DMatrix<f64> {
    let mut local = DMatrix::identity(6, 6);
    if body == 0 {
        let station = &model.stations[station];
        local.view_mut((0, 0), (3, 3)).copy_from(&station.pipe_to_station);
        (3..6).for_each(|k| local[(k, k)] = station.pipe_radius);
    }
    local
}

/// Its lateral rows.
pub(super) fn local_lateral(model: &Model, station: usize, body: usize) -> DMatrix<f64> {
    local(model, station, body).rows(1, 2).clone_owned()
}

/// Row of an [`EndColumn`] of end unknown `k` of twelve.
#[inline(always)]
pub(crate) const fn row(k: usize) -> usize {
    if k < 6 { k } else { k + 2 }
}
