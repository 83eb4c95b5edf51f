//! Spans with their inner stations slaved to their ends: made once per tool.

use nalgebra::{DMatrix, DVector, Matrix3};

use super::nodes::Nodes;
use super::precision::OnNodes;
use super::{EndColumn, ends};
use crate::dynamics::state::Deflection;
use crate::model::Model;
use crate::simd::aligned::Aligned;

/// Relative difference below which the matrices of two spans count as one: links of a regular tool differ by the rounding
/// of their geometry only. Sharing keeps them in the first-level cache.
const SAME: f64 = 1e-11;

/// Matrices of a span over its ends, by columns: six of the top end, six of the bottom end.
#[derive(Debug, Clone)]
pub(super) struct LinkMatrices {
    /// Stiffness, mass and geometric stiffness per tension, of pipe and guide.
    pub stiffness: Aligned<[[EndColumn; 12]; 2]>,
    pub mass: Aligned<[[EndColumn; 12]; 2]>,
    pub geometric: Aligned<[[EndColumn; 12]; 2]>,
    /// Mean axial force (N) by the ends' displacements; also in lane [`TENSION`] of the geometric stiffness.
    pub tension: Aligned<[EndColumn; 2]>,
    /// Lateral position of each station but the first in its station's frame: y in 0..8, z in 8..16.
    pub lateral: Aligned<[[EndColumn; 12]; 2]>,
    /// Local motion of each station, the top included: the pipe's in the station's frame, rotations times its radius; the
    /// guide's.
    pub motion: Vec<Aligned<[[[f64; 8]; 12]; 2]>>,
    /// The same by rows: what a local force puts on the ends.
    pub force: Vec<Aligned<[[EndColumn; 6]; 2]>>,
    /// What a force of a gap puts on the unknowns of both nodes, in both precisions.
    pub on_nodes: Vec<OnNodes<f64>>,
    pub on_nodes_single: Vec<OnNodes<f32>>,
    /// Displacements of the inner nodes in their own frames, columns of a node one after the other.
    pub inner: Vec<Aligned<[[[f64; 8]; 12]; 2]>>,
    /// Lateral deflection of the inner stations, as `lateral`, by a local force at each of them while the ends stand
    /// still.
    pub deflection: Vec<Aligned<[[EndColumn; 6]; 2]>>,
    /// Slowest frequency of pipe or guide while the ends stand still (rad/s).
    pub slowest: f64,
    slaved: [DMatrix<f64>; 2],
    /// K_ii^-1 of pipe and guide.
    compliance: [DMatrix<f64>; 2],
}

/// A span.
#[derive(Debug, Clone)]
pub(super) struct Link {
    /// Its matrices.
    pub kind: usize,
    /// Where the undeflected pipe lies at each station but the first: y, z (m).
    pub offset: Aligned<[[f64; 8]; 2]>,
    /// Squares of the inner clearance at those stations; beyond them what is never reached.
    pub clearance_squared: Aligned<[f64; 8]>,
    /// What the pipe's weight puts on its top end (N), along the axes of the link above.
    pub weight_on_top: [f64; 3],
    /// Lateral deflection of the inner stations under the weight of pipe and guide (m), as [`LinkMatrices::lateral`].
    pub by_weight: Aligned<Deflection>,
}

/// The spans between `nodes`, whose matrices were `made` with them: like ones share theirs.
pub(super) fn links(model: &Model, nodes: &Nodes, made: Vec<LinkMatrices>) -> (Vec<LinkMatrices>, Vec<Link>) {
    let (mut kinds, mut links) = (Vec::<LinkMatrices>::new(), Vec::new());
    for (l, made) in made.into_iter().enumerate() {
        let (first, per) = (nodes.first(l), nodes.elements(l));
        let kind = match kinds.iter().position(|kind| kind.is_close(&made)) {
            Some(kind) => kind,
            None => {
                kinds.push(made);
                kinds.len() - 1
            }
        };
        let mut link = Link {
            kind,
            offset: Aligned([[0.0; 8]; 2]),
            clearance_squared: Aligned([f64::MAX; 8]),
            weight_on_top: [0.0; 3],
            by_weight: Aligned([[0.0; 16]; 2]),
        };
        for i in 0..per {
            let station = &model.stations[first + i + 1];
            (link.offset[0][i], link.offset[1][i]) = (station.offset.x, station.offset.y);
            link.clearance_squared[i] = station.inner_clearance * station.inner_clearance;
        }
        links.push(link);
    }
    (kinds, links)
}

/// Consistent forces of gravity in the chain's numbering.
pub(super) fn weights(
    model: &Model,
    nodes: &Nodes,
    kinds: &[LinkMatrices],
    links: &mut [Link],
    unknowns: usize,
) -> Vec<f64> {
    let mut out = vec![0.0; unknowns];
    for (l, link) in links.iter_mut().enumerate() {
        let (first, per) = (nodes.first(l), nodes.elements(l));
        for body in 0..2 {
            let mut weight = DVector::<f64>::zeros(6 * (per + 1));
            for e in 0..per {
                let element = if body == 0 {
                    &model.pipe[first + e].weight
                } else {
                    &model.guide[first + e].weight
                };
                let mut part = weight.rows_mut(6 * e, 12);
                part += element;
            }
            let kind = &kinds[link.kind];
            let on_ends = kind.slaved[body].tr_mul(&weight);
            let by_weight = &kind.compliance[body] * weight.rows(6, 6 * (per - 1));
            for i in 1..per {
                let at = local_lateral(model, first + i, body) * by_weight.rows(6 * (i - 1), 6);
                (link.by_weight[body][i - 1], link.by_weight[body][8 + i - 1]) = (at[0], at[1]);
            }
            if body == 0 {
                link.weight_on_top = [on_ends[0], on_ends[1], on_ends[2]];
            }
            let [top, bottom] = ends(l, body);
            for i in 0..6 {
                out[top + i] += on_ends[i];
                out[bottom + i] += on_ends[6 + i];
            }
        }
    }
    out
}

impl LinkMatrices {
    /// Of the span of `per` elements below station `first`.
    pub fn of(model: &Model, first: usize, per: usize) -> Self {
        let size = 6 * (per + 1);
        let mut matrices: [[DMatrix<f64>; 3]; 2] =
            std::array::from_fn(|_| std::array::from_fn(|_| DMatrix::zeros(size, size)));
        for e in 0..per {
            let (pipe, guide) = (&model.pipe[first + e], &model.guide[first + e]);
            let parts = [
                [pipe.beam.stiffness(), pipe.beam.mass(), pipe.geometric],
                [guide.stiffness, guide.mass, guide.geometric],
            ];
            for (to, from) in matrices.iter_mut().flatten().zip(parts.iter().flatten()) {
                let mut part = to.view_mut((6 * e, 6 * e), (12, 12));
                part += from;
            }
        }
        let mut slowest = f64::INFINITY;
        let empty = || [DMatrix::zeros(0, 0), DMatrix::zeros(0, 0)];
        let (mut slaved, mut compliance): ([DMatrix<f64>; 2], [DMatrix<f64>; 2]) = (empty(), empty());
        for (body, [stiffness, mass, _]) in matrices.iter().enumerate() {
            let held = Guyan::held(per);
            let made = if body == 1 && model.description.guide_fixed {
                held
            } else {
                // What cannot be slaved is as slow as can be, so that the span is split.
                Guyan::of(stiffness, mass).unwrap_or(Guyan { slowest: 0.0, ..held })
            };
            (slaved[body], compliance[body]) = (made.slaved, made.compliance);
            slowest = slowest.min(made.slowest);
        }
        // The pipe's top end: the displacement is that of the end above the joint, in its frame. Its bottom end: rotations
        // before displacements.
        let mut turned = DMatrix::<f64>::identity(12, 12);
        if let Some(joint) = model.stations[first].joint {
            let joint = &model.joints[joint];
            let turn: Matrix3<f64> = joint.lower.transpose() * joint.upper;
            turned.view_mut((0, 0), (3, 3)).copy_from(&turn);
        }
        let mut places = DMatrix::<f64>::zeros(12, 12);
        for i in 0..6 {
            places[(i, i)] = 1.0;
            places[(6 + i, 6 + (i + 3) % 6)] = 1.0;
        }
        slaved[0] = &slaved[0] * turned * places;
        let condensed =
            |body: usize, which: usize| columns(&(slaved[body].transpose() * &matrices[body][which] * &slaved[body]));
        let both = |which: usize| Aligned([condensed(0, which), condensed(1, which)]);
        let tension: [[f64; 12]; 2] = std::array::from_fn(|body| {
            std::array::from_fn(|j| {
                let along = |e: usize| {
                    let column = slaved[body].column(j);
                    if body == 0 {
                        let stretch = column[6 * e + 6] - column[6 * e];
                        return model.pipe[first + e].beam.tension(stretch);
                    }
                    let guide = &model.guide[first + e];
                    let end = |n: usize| {
                        let node = 6 * (e + n);
                        guide.rotation[n][(0, 0)] * column[node] + guide.rotation[n][(0, 2)] * column[node + 2]
                    };
                    guide.beam.tension(end(1) - end(0))
                };
                (0..per).map(along).sum::<f64>() / per as f64
            })
        });
        let mut lateral = [[[0.0; 16]; 12]; 2];
        let (mut motion, mut force) = (Vec::new(), Vec::new());
        for i in 0..=per {
            // At the span's top it is the span above that meets the gap, but for the first station.
            let maps: [_; 2] = std::array::from_fn(|body| local(model, first + i, body) * slaved[body].rows(6 * i, 6));
            let mut by_columns = [[[0.0; 8]; 12]; 2];
            let mut by_rows = [[[0.0; 16]; 6]; 2];
            for (body, map) in maps.iter().enumerate() {
                for j in 0..12 {
                    for k in 0..6 {
                        by_columns[body][j][k] = map[(k, j)];
                        by_rows[body][k][row(j)] = map[(k, j)];
                    }
                    if i > 0 {
                        lateral[body][j][i - 1] = map[(1, j)];
                        lateral[body][j][8 + i - 1] = map[(2, j)];
                    }
                }
            }
            motion.push(Aligned(by_columns));
            force.push(Aligned(by_rows));
        }
        let inner = (1..per)
            .map(|i| {
                Aligned(std::array::from_fn(|body| {
                    std::array::from_fn(|j| {
                        let mut column = [0.0; 8];
                        (0..6).for_each(|k| column[k] = slaved[body][(6 * i + k, j)]);
                        column
                    })
                }))
            })
            .collect();
        let deflection = (1..per).map(|i| {
            Aligned(std::array::from_fn(|body| {
                let bent = compliance[body].columns(6 * (i - 1), 6) * local(model, first + i, body).transpose();
                let mut columns = [[0.0; 16]; 6];
                for at in 1..per {
                    let lateral = local_lateral(model, first + at, body) * bent.rows(6 * (at - 1), 6);
                    for (k, column) in columns.iter_mut().enumerate() {
                        (column[at - 1], column[8 + at - 1]) = (lateral[(0, k)], lateral[(1, k)]);
                    }
                }
                columns
            }))
        });
        Self {
            stiffness: both(0),
            mass: both(1),
            geometric: geometric(&both(2), &tension),
            tension: Aligned(tension.map(|tension| end_column(|j| tension[j]))),
            lateral: Aligned(lateral),
            motion,
            on_nodes: force.iter().map(|rows| OnNodes::of(rows, model.guide_radii)).collect(),
            on_nodes_single: force.iter().map(|rows| OnNodes::of(rows, model.guide_radii)).collect(),
            force,
            inner,
            deflection: deflection.collect(),
            slowest,
            slaved,
            compliance,
        }
    }

    /// Largest deflection that contacts of these stiffnesses (N/m; pipe-guide, guide-wall) make between the ends for a
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
    fn is_close(&self, other: &Self) -> bool {
        let near = |a: &[f64], b: &[f64]| {
            let scale = a.iter().chain(b).fold(0.0_f64, |m, x| m.max(x.abs()));
            a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * scale)
        };
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
        }) && self
            .motion
            .iter()
            .zip(&other.motion)
            .all(|(a, b)| near(a.as_flattened().as_flattened(), b.as_flattened().as_flattened()))
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
fn local_lateral(model: &Model, station: usize, body: usize) -> DMatrix<f64> {
    local(model, station, body).rows(1, 2).clone_owned()
}

/// Lane of the geometric stiffness, free of forces, that gives the axial force (N) beside them.
pub(super) const TENSION: usize = 7;

/// Geometric stiffness with the axial force beside it.
fn geometric(stiffness: &[[EndColumn; 12]; 2], tension: &[[f64; 12]; 2]) -> Aligned<[[EndColumn; 12]; 2]> {
    let mut out = Aligned(*stiffness);
    for (columns, tension) in out.iter_mut().zip(tension) {
        for (column, tension) in columns.iter_mut().zip(tension) {
            column[TENSION] = *tension;
        }
    }
    out
}

/// Row of an [`EndColumn`] of end unknown `k` of twelve.
#[inline(always)]
pub(super) const fn row(k: usize) -> usize {
    if k < 6 { k } else { k + 2 }
}

fn columns(matrix: &DMatrix<f64>) -> [EndColumn; 12] {
    std::array::from_fn(|j| end_column(|i| matrix[(i, j)]))
}

/// A column of the twelve unknowns of both ends.
fn end_column(of: impl Fn(usize) -> f64) -> EndColumn {
    let mut column = [0.0; 16];
    (0..12).for_each(|i| column[row(i)] = of(i));
    column
}

/// A span's inner nodes, their ends held (Guyan).
struct Guyan {
    /// Displacements of all nodes by those of the two ends, twelve columns.
    slaved: DMatrix<f64>,
    /// K_ii^-1.
    compliance: DMatrix<f64>,
    /// Slowest inner frequency (rad/s).
    slowest: f64,
}

impl Guyan {
    /// Of a span all of whose inner nodes are held too.
    fn held(per: usize) -> Self {
        let n = 6 * (per + 1);
        let mut slaved = DMatrix::zeros(n, 12);
        for i in 0..6 {
            (slaved[(i, i)], slaved[(n - 6 + i, 6 + i)]) = (1.0, 1.0);
        }
        Self {
            slaved,
            compliance: DMatrix::zeros(n - 12, n - 12),
            slowest: f64::INFINITY,
        }
    }

    fn of(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>) -> Option<Self> {
        let n = stiffness.nrows();
        let held = Self::held(n / 6 - 1);
        let inner = n - 12;
        if inner == 0 {
            return Some(held);
        }
        let mut slaved = held.slaved;
        let part = |matrix: &DMatrix<f64>| matrix.view((6, 6), (inner, inner)).clone_owned();
        let factor = part(mass).cholesky()?.l();
        let mut to_ends = DMatrix::zeros(inner, 12);
        to_ends
            .view_mut((0, 0), (inner, 6))
            .copy_from(&stiffness.view((6, 0), (inner, 6)));
        to_ends
            .view_mut((0, 6), (inner, 6))
            .copy_from(&stiffness.view((6, n - 6), (inner, 6)));
        let inside = part(stiffness).cholesky()?;
        slaved.view_mut((6, 0), (inner, 12)).copy_from(&-inside.solve(&to_ends));
        // L^-1 K L^-T of K x = omega^2 L L^T x.
        let left = factor.solve_lower_triangular(&part(stiffness))?;
        let both = factor.solve_lower_triangular(&left.transpose())?;
        let symmetric = 0.5 * (&both + both.transpose());
        Some(Self {
            slaved,
            compliance: inside.inverse(),
            slowest: symmetric.symmetric_eigenvalues().min().max(0.0).sqrt(),
        })
    }
}
