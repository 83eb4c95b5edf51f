//! The step_constant part of the tangent with its spans condensed: made once per step size.

use nalgebra::{Matrix6, SMatrix};

use super::guide_contact::{GuideChain, InterfaceMatrices, six};
use super::joint_reduction::Reduction;
use super::substructure::{Chain, Substructure, close};
use super::{Block, GUIDE, MULTIPLIER, PIPE_PLACES, PaddedColumns, SIZE};
use crate::linear::system::{BlockSystem, Layout};

type Block24 = [[f64; 24]; 24];

/// Between two stations of the sweep: the pipe's coupling, in the order of the blocks.
#[derive(Debug, Clone)]
pub struct InterfaceCoupling {
    /// Rows of the station above (its outgoing six), columns of the one below (rotations, displacement).
    pub upper: PaddedColumns,
    /// Rows of the station below, columns of the one above.
    pub lower: PaddedColumns,
    /// Columns of the start below's own displacement in `lower`.
    pub lower_offset: [[f64; 8]; 3],
    /// Rows of the start below's displacement in `upper`, by columns.
    pub multiplier_rows: [[f64; 3]; 6],
}

/// What a joint's start below adds that the reduction has taken out.
#[derive(Debug, Clone, Copy, Default)]
pub struct StartBelow {
    /// Columns of its displacement, reduced.
    pub columns: [[f64; SIZE]; 3],
    /// Rows of its displacement over its own six unknowns, by columns.
    pub rows: [[f64; 3]; 6],
}

/// Matrices of a station of the sweep.
#[derive(Debug, Clone)]
pub struct Matrices {
    /// Its own block and what the pipe's spans above and below put on it.
    pub condensed: Block,
    /// Its own block.
    pub own: Block,
    /// What the pipe's span above puts on it.
    pub above: Block,
    /// What the pipe's span below puts on it.
    pub below: Block,
    /// How the start below was taken out, at a joint.
    pub reduction: Option<Reduction>,
    /// With the span below condensed.
    pub start: StartBelow,
    /// With the span below not condensed, because the pipe touches the guide there.
    pub own_start: StartBelow,
}

/// A guide between two stations of the sweep.
#[derive(Debug, Clone)]
pub struct Guide {
    /// Its matrices.
    pub substructure: Substructure,
    /// The same, for an elimination with contacts.
    pub chain: GuideChain,
    /// What it puts on its ends without contact.
    pub clamped: InterfaceMatrices,
}

/// A station of the sweep.
#[derive(Debug, Clone, Copy)]
pub struct Node {
    /// Station.
    pub station: usize,
    /// Its matrices among [`CondensedSystem::matrices`].
    pub matrices: usize,
    /// Its joint.
    pub joint: Option<usize>,
}

/// Stations between two nodes.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// First inner station.
    pub first: usize,
    /// Number of inner stations.
    pub inner: usize,
    /// Its pipe among [`CondensedSystem::pipes`].
    pub pipe: usize,
    /// Its guide among [`CondensedSystem::guides`].
    pub guide: usize,
    /// Its coupling among [`CondensedSystem::couplings`].
    pub coupling_of_pipe: usize,
}

/// The step_constant tangent of one step size, condensed to the joints.
#[derive(Debug, Clone)]
pub struct CondensedSystem {
    /// The step_constant tangent itself.
    pub step_constant: BlockSystem,
    /// Top, joints, bottom.
    pub nodes: Vec<Node>,
    /// Span k is between nodes k and k + 1.
    pub spans: Vec<Span>,
    /// Pipes that differ; like links share one.
    pub pipes: Vec<Substructure>,
    /// Guides that differ between joints; like ones share one.
    pub guides: Vec<Guide>,
    /// Couplings that differ between stations of the sweep.
    pub couplings: Vec<InterfaceCoupling>,
    /// Matrices that differ between stations of the sweep.
    pub matrices: Vec<Matrices>,
}

impl CondensedSystem {
    /// Condenses `step_constant`, whose joints are at the stations `joints`. `None` where the joints do not have the
    /// form that the reduction needs (two rotational rows, held translations), where something that lasts couples pipe
    /// and guide, or where an inner matrix is singular.
    pub fn of(step_constant: BlockSystem, joints: &[usize]) -> Option<Self> {
        if !bodies_are_apart(&step_constant, joints) {
            return None;
        }
        let layout = step_constant.layout().clone();
        let last = layout.stations() - 1;
        let mut stations = vec![0];
        stations.extend_from_slice(joints);
        if last > 0 {
            stations.push(last);
        }
        let (mut pipes, mut guides, mut spans) = (Vec::<Substructure>::new(), Vec::<Guide>::new(), Vec::new());
        for ends in stations.windows(2) {
            let (pipe, guide) = chains(&step_constant, ends[0], ends[1]);
            let pipe = index_of(
                &mut pipes,
                |substructure| substructure.chain.is_close(&pipe),
                || Substructure::of(pipe.clone()),
            )?;
            let guide = index_of(
                &mut guides,
                |known| known.substructure.chain.is_close(&guide),
                || Substructure::of(guide.clone()).map(Guide::of),
            )?;
            spans.push(Span {
                first: ends[0] + 1,
                inner: ends[1] - ends[0] - 1,
                pipe,
                guide,
                coupling_of_pipe: 0,
            });
        }
        let mut matrices = Vec::<Matrices>::new();
        let mut nodes = Vec::with_capacity(stations.len());
        for (k, &station) in stations.iter().enumerate() {
            let above = k.checked_sub(1).map(|above| &pipes[spans[above].pipe].bottom);
            let below = spans.get(k).map(|span| &pipes[span.pipe].top);
            let joint = joints.binary_search(&station).ok();
            let made = if joint.is_some() {
                Matrices::of_joint(&step_constant, station, above, below)?
            } else {
                Matrices::of_end(&step_constant, station, above, below)
            };
            let matrices = index_of(&mut matrices, |known| known.is_close(&made), || Some(made.clone()))?;
            nodes.push(Node {
                station,
                matrices,
                joint,
            });
        }
        let mut couplings = Vec::<InterfaceCoupling>::new();
        for (k, span) in spans.iter_mut().enumerate() {
            let pipe = &pipes[span.pipe];
            let coupling_of_pipe =
                InterfaceCoupling::of(&pipe.upper, &pipe.lower, matrices[nodes[k].matrices].reduction.as_ref());
            span.coupling_of_pipe = index_of(
                &mut couplings,
                |known| known.is_close(&coupling_of_pipe),
                || Some(coupling_of_pipe.clone()),
            )?;
        }
        Some(Self {
            step_constant,
            nodes,
            spans,
            pipes,
            guides,
            couplings,
            matrices,
        })
    }

    /// Numbering of the full system, whose right-hand sides it takes.
    pub fn layout(&self) -> &Layout {
        self.step_constant.layout()
    }
}

/// Whether pipe and guide are coupled neither inside spans nor with a joint's start below.
fn bodies_are_apart(system: &BlockSystem, joints: &[usize]) -> bool {
    let last = system.layout().stations() - 1;
    (0..=last).all(|station| {
        let slot = system.layout().slot(station);
        if joints.binary_search(&station).is_ok() {
            let block = &system.diagonal.joint[slot];
            (0..12).all(|i| (12..18).all(|j| block[(i, j)] == 0.0 && block[(j, i)] == 0.0))
        } else if station > 0 && station < last {
            let Some(block) = system
                .diagonal
                .plain
                .get(slot)
                .filter(|_| !system.layout().is_large(station))
            else {
                return false;
            };
            (0..6).all(|i| (6..12).all(|j| block[(i, j)] == 0.0 && block[(j, i)] == 0.0))
        } else {
            true
        }
    })
}

/// Index of the first known item that is the same, or of a new one.
fn index_of<T>(known: &mut Vec<T>, same: impl Fn(&T) -> bool, make: impl FnOnce() -> Option<T>) -> Option<usize> {
    if let Some(index) = known.iter().position(same) {
        return Some(index);
    }
    known.push(make()?);
    Some(known.len() - 1)
}

/// Pipe and guide from station `top` to station `bottom`.
fn chains(system: &BlockSystem, top: usize, bottom: usize) -> (Chain, Chain) {
    let inner = |first: usize| {
        (top + 1..bottom)
            .map(|station| {
                let block = &system.diagonal.plain[system.layout().slot(station)];
                Matrix6::from(block.fixed_view::<6, 6>(first, first))
            })
            .collect()
    };
    let (upper, lower) = (&system.upper[top..bottom], &system.lower[top..bottom]);
    (
        Chain {
            diagonal: inner(0),
            upper: upper.iter().map(|c| c.pipe).collect(),
            lower: lower.iter().map(|c| c.pipe).collect(),
        },
        Chain {
            diagonal: inner(6),
            upper: upper.iter().map(|c| c.guide).collect(),
            lower: lower.iter().map(|c| c.guide).collect(),
        },
    )
}

impl Guide {
    fn of(substructure: Substructure) -> Self {
        Self {
            chain: GuideChain::of(&substructure),
            clamped: InterfaceMatrices {
                top: six(&substructure.top),
                bottom: six(&substructure.bottom),
                upper: six(&substructure.upper),
                lower: six(&substructure.lower),
                right: [[0.0; 8]; 2],
            },
            substructure,
        }
    }
}

impl InterfaceCoupling {
    /// From the natural order (displacement, rotations) of both nodes; `joint` is the reduction of the station above,
    /// if it is a joint.
    pub fn of(upper: &Matrix6<f64>, lower: &Matrix6<f64>, joint: Option<&Reduction>) -> Self {
        let mut coupling_of_pipe = Self {
            upper: [[0.0; 8]; 6],
            lower: [[0.0; 8]; 6],
            lower_offset: [[0.0; 8]; 3],
            multiplier_rows: [[0.0; 3]; 6],
        };
        for (j, place) in PIPE_PLACES.into_iter().enumerate() {
            let column = upper.column(place);
            let (u, rotations) = ([column[0], column[1], column[2]], [column[3], column[4], column[5]]);
            coupling_of_pipe.multiplier_rows[j] = u;
            let (first, second) = match joint {
                Some(reduction) => (reduction.turned_back(u), rotations),
                None => (rotations, u),
            };
            coupling_of_pipe.upper[j][..3].copy_from_slice(&first);
            coupling_of_pipe.upper[j][3..6].copy_from_slice(&second);
        }
        let row_order = |column: [f64; 6]| {
            let mut out = [0.0; 8];
            for (k, place) in PIPE_PLACES.into_iter().enumerate() {
                out[place] = column[k];
            }
            out
        };
        let column = |j: usize| row_order(std::array::from_fn(|i| lower[(i, j)]));
        for j in 0..3 {
            coupling_of_pipe.lower_offset[j] = column(j);
            match joint {
                Some(reduction) => {
                    let mut turned = [0.0; 6];
                    for k in 0..3 {
                        for (i, x) in turned.iter_mut().enumerate() {
                            *x += lower[(i, k)] * reduction.turn[j][k];
                        }
                    }
                    coupling_of_pipe.lower[j] = row_order(turned);
                    coupling_of_pipe.lower[3 + j] = column(3 + j);
                }
                None => {
                    coupling_of_pipe.lower[j] = column(3 + j);
                    coupling_of_pipe.lower[3 + j] = column(j);
                }
            }
        }
        coupling_of_pipe
    }

    fn is_close(&self, other: &Self) -> bool {
        close(self.upper.as_flattened(), other.upper.as_flattened())
            && close(self.lower.as_flattened(), other.lower.as_flattened())
            && close(self.lower_offset.as_flattened(), other.lower_offset.as_flattened())
    }
}

impl StartBelow {
    fn of(reduction: &Reduction, block: &Block24) -> Self {
        Self {
            columns: std::array::from_fn(|k| reduction.rows(&block[12 + k])),
            rows: std::array::from_fn(|k| [block[12 + k][12], block[12 + k][13], block[12 + k][14]]),
        }
    }
}

impl Matrices {
    fn of_joint(
        system: &BlockSystem,
        station: usize,
        above: Option<&Matrix6<f64>>,
        below: Option<&Matrix6<f64>>,
    ) -> Option<Self> {
        let own: Block24 = system.diagonal.joint[system.layout().slot(station)].data.0;
        let reduction = Reduction::of(&own)?;
        let at = |part: Option<&Matrix6<f64>>, first: usize| {
            let mut block = SMatrix::<f64, 24, 24>::zeros();
            if let Some(part) = part {
                block.fixed_view_mut::<6, 6>(first, first).copy_from(part);
            }
            block
        };
        let (above, below) = (at(above, 0), at(below, 12));
        let condensed = (SMatrix::from_array_storage(nalgebra::ArrayStorage(own)) + above + below)
            .data
            .0;
        let reduced = |block: &Block24| reduction.reduce(block);
        Some(Self {
            condensed: reduced(&condensed),
            own: reduced(&own),
            above: reduced(&above.data.0),
            below: reduced(&below.data.0),
            start: StartBelow::of(&reduction, &condensed),
            own_start: StartBelow::of(&reduction, &own),
            reduction: Some(reduction),
        })
    }

    fn of_end(
        system: &BlockSystem,
        station: usize,
        above: Option<&Matrix6<f64>>,
        below: Option<&Matrix6<f64>>,
    ) -> Self {
        let slot = system.layout().slot(station);
        let own = if system.layout().is_large(station) {
            let block = &system.diagonal.joint[slot];
            let mut own = spread(|i, j| block[(i, j)]);
            // The axial tie's multiplier is the nineteenth unknown of the block.
            own[MULTIPLIER][MULTIPLIER] = block[(18, 18)];
            for k in 0..12 {
                own[MULTIPLIER][place(k)] = block[(k, 18)];
                own[place(k)][MULTIPLIER] = block[(18, k)];
            }
            own
        } else {
            let block = &system.diagonal.plain[slot];
            spread(|i, j| block[(i, j)])
        };
        let pipe = |part: Option<&Matrix6<f64>>| {
            let mut block = [[0.0; SIZE]; SIZE];
            if let Some(part) = part {
                for j in 0..6 {
                    for i in 0..6 {
                        block[PIPE_PLACES[j]][PIPE_PLACES[i]] = part[(i, j)];
                    }
                }
            }
            block
        };
        let (above, below) = (pipe(above), pipe(below));
        Self {
            condensed: std::array::from_fn(|j| std::array::from_fn(|i| own[j][i] + above[j][i] + below[j][i])),
            own,
            above,
            below,
            reduction: None,
            start: StartBelow::default(),
            own_start: StartBelow::default(),
        }
    }

    fn is_close(&self, other: &Self) -> bool {
        let reductions = match (&self.reduction, &other.reduction) {
            (Some(a), Some(b)) => {
                close(a.turn.as_flattened(), b.turn.as_flattened())
                    && close(a.recover.as_flattened(), b.recover.as_flattened())
            }
            (None, None) => true,
            _ => false,
        };
        reductions
            && close(self.condensed.as_flattened(), other.condensed.as_flattened())
            && close(self.own.as_flattened(), other.own.as_flattened())
            && close(self.above.as_flattened(), other.above.as_flattened())
            && close(self.below.as_flattened(), other.below.as_flattened())
    }
}

/// Place in a block of 16 of unknown `k` of a station's first twelve (pipe, guide).
#[inline(always)]
pub fn place(k: usize) -> usize {
    if k < 6 { PIPE_PLACES[k] } else { GUIDE + k - 6 }
}

/// A plain station's block of 12 in the order of the blocks of 16; what is not used there stands alone.
#[inline(always)]
pub fn spread(entry: impl Fn(usize, usize) -> f64) -> Block {
    let mut block = [[0.0; SIZE]; SIZE];
    for unused in [6, 7, 8, MULTIPLIER] {
        block[unused][unused] = 1.0;
    }
    for j in 0..12 {
        for i in 0..12 {
            block[place(j)][place(i)] = entry(i, j);
        }
    }
    block
}
