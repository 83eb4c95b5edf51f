//! The step-constant part of the chain's tangent: elastic, damping and inertia terms, made once per step size.
//!
//! A node's block, by what has entries where. `S` is in the step-constant part (the spans above and below), the rest comes
//! with each iteration: `J` is the joint, `C` a contact between pipe and guide, `W` one between guide and wall, `t` the tie
//! in the last node. The rows of rotations below that follow from others are replaced ([`dependents`]).
//!
//! ```text
//!                     above   u     below   guide        tie
//!                     0 1 2 | 3 4 5 | 6 7 8 | 9 . . . . 14 | 15
//!  rotations above    S+J     S       J       C              .
//!  displacement       S       S       S       C              t
//!  rotations below    J       S       S+J     C              .
//!  guide              C       C       C       S+W            t
//!  tie                .       t       .       t              .
//! ```
//!
//! A span couples rows and columns 3..9 of the node above (its top end) with 0..6 of the node below (its bottom end) for the
//! pipe, 9..15 with 9..15 for the guide. Contacts inside it couple pipe and guide too. Mud between them couples them everywhere:
//! then `S` is also where `C` is ([`Operator::crossed`]).
//!
//! [`dependents`]: super::dependents

use super::columns::EndColumn;
use super::slaving::row;
use super::{BOTTOM, Chain, NODE, TIE, TOP, U};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::numbered::along_the_hole;
use crate::elements::factors::TangentFactors;
use crate::model::Model;
use crate::simd::aligned::Aligned;

/// A node's block by columns.
pub(super) type Block = [[f64; NODE]; NODE];

/// Forces on the ends of pipe and guide by the motion of the other's, of a kind of span; none where they are not
/// coupled.
type Across = Option<Box<Aligned<[[EndColumn; 12]; 2]>>>;

/// Coupling of a span's two ends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Coupling {
    /// Rows of the node above, columns of the span's bottom end.
    pub upper: [[f64; NODE]; 12],
    /// Rows of the node below, columns of the span's top end.
    pub lower: [[f64; NODE]; 12],
}

/// For one step size and damping.
pub(crate) struct Operator {
    factors: TangentFactors,
    damping: [f64; 2],
    /// k K + d C + m M of each kind of span, pipe and guide, by columns over its ends.
    pub spans: Vec<Aligned<[[EndColumn; 12]; 2]>>,
    /// Blocks that differ, and which each node has.
    pub blocks: Vec<Block>,
    pub block_of: Vec<usize>,
    /// Couplings, by kind of span.
    pub couplings: Vec<Coupling>,
    /// What the motion of one pipe does to the other, in place of `spans`; none where they are not coupled.
    pub across: Vec<Across>,
    /// Whether some are coupled: all rows of pipe and guide are then taken to depend on each other, as at a contact between them.
    pub crossed: bool,
    /// The same rounded.
    pub single: SingleOperator,
}

impl Operator {
    pub(super) fn of(chain: &Chain, model: &Model, factors: TangentFactors, conditions: &Conditions) -> Self {
        // The step turns the linear system into one matrix: stiffness, damping and mass by the factors of the scheme.
        let (alpha, beta) = (conditions.rayleigh.alpha, conditions.rayleigh.beta);
        let elastic = factors.stiffness + factors.damping * beta;
        let inertial = factors.mass + factors.damping * alpha;
        let spans: Vec<Aligned<[[EndColumn; 12]; 2]>> = chain
            .model
            .kinds
            .iter()
            .map(|kind| {
                // Once per kind of span and not per span: a regular tool has few kinds.
                Aligned(std::array::from_fn(|body| {
                    std::array::from_fn(|j| {
                        let (k, m) = (&kind.stiffness[body][j], &kind.mass[body][j]);
                        let mut column: EndColumn = std::array::from_fn(|i| elastic * k[i] + inertial * m[i]);
                        if let Some(coupled) = &kind.coupled {
                            let damping = column.iter_mut().zip(&coupled.damping[body][j]);
                            damping.for_each(|(x, damping)| *x += factors.damping * damping);
                        }
                        // This stiffness has no damping: it turns with the guide.
                        match kind.undamped.as_ref().filter(|_| body == 1) {
                            Some(undamped) => std::array::from_fn(|i| column[i] + factors.stiffness * undamped[j][i]),
                            None => column,
                        }
                    })
                }))
            })
            .collect();
        // Mud across the gap is kept apart in the residual: the motion of the other pipe is read for it.
        let across: Vec<Across> = (chain.model.kinds.iter())
            .map(|kind| {
                let coupled = kind.coupled.as_ref()?;
                Some(Box::new(Aligned(std::array::from_fn(|body| {
                    std::array::from_fn(|j| {
                        let (m, c) = (&coupled.mass_across[body][j], &coupled.damping_across[body][j]);
                        std::array::from_fn(|i| inertial * m[i] + factors.damping * c[i])
                    })
                }))))
            })
            .collect();
        // Blocks: each span adds to those of both its ends.
        let mut nodes: Vec<Block> = vec![[[0.0; NODE]; NODE]; chain.model.nodes.list.len()];
        for (l, link) in chain.model.links.iter().enumerate() {
            for (body, columns) in spans[link.kind].iter().enumerate() {
                let (top, bottom) = (&TOP[6 * body..], &BOTTOM[6 * body..]);
                for j in 0..6 {
                    for i in 0..6 {
                        nodes[l][top[j]][top[i]] += columns[j][row(i)];
                        nodes[l + 1][bottom[j]][bottom[i]] += columns[6 + j][row(6 + i)];
                    }
                }
            }
            // Mud between them: forces on this body by the motion of the other.
            for (body, columns) in across[link.kind].iter().flat_map(|across| across.iter()).enumerate() {
                let (on, by) = (6 * body, 6 * (1 - body));
                for j in 0..6 {
                    for i in 0..6 {
                        nodes[l][TOP[by + j]][TOP[on + i]] += columns[j][row(i)];
                        nodes[l + 1][BOTTOM[by + j]][BOTTOM[on + i]] += columns[6 + j][row(6 + i)];
                    }
                }
            }
        }
        // Masses at nodes, and the tie, which holds both ends together along the hole, with its multiplier. A node without a tie
        // has a one for it.
        for &(place, mass) in &chain.model.node_masses {
            let (node, at) = (place / NODE, place % NODE);
            nodes[node][at][at] += inertial * mass;
        }
        nodes.iter_mut().for_each(|node| node[TIE][TIE] = 1.0);
        if chain.model.places.tie.is_some() {
            nodes[chain.spans()][TIE][TIE] = 0.0;
            let (last, scale) = (chain.spans(), model.force_scale);
            for (place, share) in along_the_hole(model.ends_along[1], U, super::GUIDE) {
                nodes[last][TIE][place] += scale * share;
                nodes[last][place][TIE] += scale * share;
            }
        }
        // The coupling of two neighbours, per kind: above by the bottom's motion, below by the top's.
        let couplings = spans
            .iter()
            .zip(&across)
            .map(|(bodies, across)| {
                let mut coupling = Coupling {
                    upper: [[0.0; NODE]; 12],
                    lower: [[0.0; NODE]; 12],
                };
                for (body, columns) in bodies.iter().enumerate() {
                    for j in 0..6 {
                        for i in 0..6 {
                            coupling.upper[6 * body + j][TOP[6 * body + i]] = columns[6 + j][row(i)];
                            coupling.lower[6 * body + j][BOTTOM[6 * body + i]] = columns[j][row(6 + i)];
                        }
                    }
                }
                // Mud fills the places that no span has: rows of this body by columns of the other.
                for (body, columns) in across.iter().flat_map(|across| across.iter()).enumerate() {
                    let (on, by) = (6 * body, 6 * (1 - body));
                    for j in 0..6 {
                        for i in 0..6 {
                            coupling.upper[by + j][TOP[on + i]] = columns[6 + j][row(i)];
                            coupling.lower[by + j][BOTTOM[on + i]] = columns[j][row(6 + i)];
                        }
                    }
                }
                coupling
            })
            .collect();
        // A regular tool has few blocks that differ: sharing keeps them in the first-level cache.
        let mut blocks = Vec::<Block>::new();
        let block_of = nodes
            .iter()
            .map(|block| {
                let known = blocks.iter().position(|known| known == block);
                known.unwrap_or_else(|| {
                    blocks.push(*block);
                    blocks.len() - 1
                })
            })
            .collect();
        let mut operator = Self {
            crossed: across.iter().any(Option::is_some),
            across,
            factors,
            damping: [alpha, beta],
            spans,
            blocks,
            block_of,
            couplings,
            single: SingleOperator::default(),
        };
        operator.single = SingleOperator::of(&operator);
        operator
    }

    pub(super) fn is_for(&self, factors: TangentFactors, conditions: &Conditions) -> bool {
        self.factors == factors && self.damping == [conditions.rayleigh.alpha, conditions.rayleigh.beta]
    }
}

/// The step-constant part in single precision.
#[derive(Default)]
pub(crate) struct SingleOperator {
    pub blocks: Vec<Aligned<[[f32; NODE]; NODE]>>,
    /// Per kind of span: rows of the node above by columns of the bottom end; rows of the node below by columns of the
    /// top end, apart and, where nothing crosses, pipe and guide in one column, as they do not share rows.
    pub upper: Vec<Aligned<[[f32; NODE]; 12]>>,
    pub lower: Vec<Aligned<[[f32; NODE]; 12]>>,
    pub lower_joined: Vec<Aligned<[[f32; NODE]; 6]>>,
}

fn rounded<const N: usize>(columns: &[[f64; NODE]; N]) -> Aligned<[[f32; NODE]; N]> {
    Aligned(columns.map(|column| column.map(|x| x as f32)))
}

impl SingleOperator {
    fn of(operator: &Operator) -> Self {
        let lower: Vec<Aligned<[[f32; NODE]; 12]>> = operator.couplings.iter().map(|c| rounded(&c.lower)).collect();
        Self {
            blocks: operator.blocks.iter().map(rounded).collect(),
            upper: operator.couplings.iter().map(|c| rounded(&c.upper)).collect(),
            lower_joined: lower
                .iter()
                .map(|lower| {
                    Aligned(std::array::from_fn(|c| {
                        std::array::from_fn(|i| lower[c][i] + lower[6 + c][i])
                    }))
                })
                .collect(),
            lower,
        }
    }
}
