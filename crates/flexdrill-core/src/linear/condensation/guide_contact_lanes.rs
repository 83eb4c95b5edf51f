//! The guides of up to eight like spans eliminated at once, a span per lane: the method of [`super::guide_contact`],
//! whose spans one by one leave a processor waiting for each pivot. Eight lanes have no row to fill up and no chain to
//! wait for.

use super::PaddedColumns;
use super::guide_contact::{COLUMNS, GuideChain, InterfaceMatrices, RIGHT, TOP};
use super::system::Span;
use crate::linear::block::PIVOT_RATIO;
use crate::linear::increment::{TangentIncrement, Touching};
use crate::simd::vector::Vector;

/// Spans per group.
pub const LANES: usize = 8;

/// A value per span.
type Lane = [f64; LANES];
/// A column of six.
type Column = [Lane; 6];

/// The solved columns of one inner node.
pub type SolvedLanes = [Column; COLUMNS];

/// Columns of a node that has not been eliminated: all zero.
pub const NOTHING: SolvedLanes = [[[0.0; LANES]; 6]; COLUMNS];

/// Spans with the same guide that are eliminated together; lanes without a span repeat the last one.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    /// Index of the guide in the system.
    pub guide: usize,
    /// Which spans, one per lane.
    pub spans: [usize; LANES],
    /// Lanes in use.
    pub count: usize,
}

/// What the spans of a group put on their ends: see [`InterfaceMatrices`].
struct Ends {
    top: [Column; 6],
    bottom: [Column; 6],
    upper: [Column; 6],
    lower: [Column; 6],
    right: [Column; 2],
}

impl GuideChain {
    /// Eliminates the inner nodes of all spans in `group` from the top down; `spans` are the system's, `forces` the
    /// right-hand sides by node, unknown and lane. Results per lane go to `out`.
    ///
    /// Returns whether the diagonal did as pivots everywhere; where not, nothing may be used and the spans have to be
    /// taken one by one.
    #[inline(always)]
    pub fn condense_lanes<V: Vector>(
        &self,
        group: &Group,
        spans: &[Span],
        increment: &TangentIncrement,
        forces: &[Column],
        solved: &mut [SolvedLanes],
        out: &mut [InterfaceMatrices],
    ) -> bool {
        let zero = [[0.0; LANES]; 6];
        let mut ends = Ends {
            top: [zero; 6],
            bottom: [zero; 6],
            upper: splat(&self.upper[0]),
            lower: [zero; 6],
            right: [zero; 2],
        };
        let mut carry = NOTHING;
        for (k, solved) in solved.iter_mut().enumerate() {
            let mut block = [zero; 6];
            contacts(group, spans, increment, k, &mut block);
            for j in 0..6 {
                for i in 0..6 {
                    let own = V::splat(self.diagonal[k][j][i]).plus(V::load(&block[j][i]));
                    own.minus(V::load(&carry[j][i])).store(&mut block[j][i]);
                    V::splat(self.upper[k + 1][j][i]).store(&mut solved[j][i]);
                    let top = if k == 0 {
                        V::splat(self.lower[0][j][i])
                    } else {
                        V::splat(0.0).minus(V::load(&carry[TOP + j][i]))
                    };
                    top.store(&mut solved[TOP + j][i]);
                }
                V::load(&forces[k][j])
                    .minus(V::load(&carry[RIGHT][j]))
                    .store(&mut solved[RIGHT][j]);
            }
            if !eliminate::<V>(&mut block, solved) {
                return false;
            }
            // The top end's coupling to this node is what `upper` holds now; it moves on to the next node.
            let upper = load_matrix::<V>(&ends.upper);
            for j in 0..6 {
                subtract_product(&upper, &solved[TOP + j], &mut ends.top[j]);
                ends.upper[j] = zero;
                subtract_product(&upper, &solved[j], &mut ends.upper[j]);
            }
            subtract_product(&upper, &solved[RIGHT], &mut ends.right[0]);
            for (carry, solved) in carry.iter_mut().zip(solved.iter()) {
                let mut x = [V::splat(0.0); 6];
                for (x, solved) in x.iter_mut().zip(solved) {
                    *x = V::load(solved);
                }
                for (i, carry) in carry.iter_mut().enumerate() {
                    let mut sum = V::splat(0.0);
                    for (lower, &x) in self.lower[k + 1].iter().zip(&x) {
                        sum = sum.plus_product(V::splat(lower[i]), x);
                    }
                    sum.store(carry);
                }
            }
        }
        for (j, carry) in carry.iter().enumerate() {
            let end = match j {
                RIGHT => &mut ends.right[1],
                TOP..RIGHT => &mut ends.lower[j - TOP],
                _ => &mut ends.bottom[j],
            };
            for (end, carry) in end.iter_mut().zip(carry) {
                V::splat(0.0).minus(V::load(carry)).store(end);
            }
        }
        for (lane, &span) in group.spans.iter().enumerate().take(group.count) {
            let out = &mut out[span];
            let parts = [
                (&mut out.top, &ends.top),
                (&mut out.bottom, &ends.bottom),
                (&mut out.upper, &ends.upper),
                (&mut out.lower, &ends.lower),
            ];
            for (to, from) in parts {
                for (to, from) in to.iter_mut().zip(from) {
                    for (to, from) in to.iter_mut().zip(from) {
                        *to = from[lane];
                    }
                }
            }
            for (to, from) in out.right.iter_mut().zip(&ends.right) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to = from[lane];
                }
            }
        }
        true
    }
}

/// Inner displacements by node and unknown from those of the ends, from the bottom up.
#[inline(always)]
pub fn expand_lanes<V: Vector>(solved: &[SolvedLanes], top: &Column, bottom: &Column, inner: &mut [Column]) {
    let mut below = [V::splat(0.0); 6];
    let mut above = [V::splat(0.0); 6];
    for j in 0..6 {
        below[j] = V::load(&bottom[j]);
        above[j] = V::load(&top[j]);
    }
    for (solved, inner) in solved.iter().zip(inner).rev() {
        let mut x = [V::splat(0.0); 6];
        for i in 0..6 {
            let mut sum = V::load(&solved[RIGHT][i]);
            for j in 0..6 {
                sum = sum
                    .minus_product(V::load(&solved[j][i]), below[j])
                    .minus_product(V::load(&solved[TOP + j][i]), above[j]);
            }
            sum.store(&mut inner[i]);
            x[i] = sum;
        }
        below = x;
    }
}

/// What the wall adds at inner node `k` of every span.
#[inline(always)]
fn contacts(group: &Group, spans: &[Span], increment: &TangentIncrement, k: usize, block: &mut [Column; 6]) {
    for (lane, &span) in group.spans.iter().enumerate() {
        let station = spans[span].first + k;
        if increment.touching[station] == Touching::Guide {
            for (to, from) in block.iter_mut().zip(&increment.contact[station][6..]) {
                for (to, from) in to.iter_mut().zip(&from[6..]) {
                    to[lane] = *from;
                }
            }
        }
    }
}

/// Gauss-Jordan with the diagonal as pivots; false if one would not do in some lane.
#[inline(always)]
fn eliminate<V: Vector>(a: &mut [Column; 6], b: &mut SolvedLanes) -> bool {
    let mut fails = false;
    for k in 0..6 {
        let pivot = V::load(&a[k][k]);
        let mut reciprocal = [0.0; LANES];
        for (reciprocal, pivot) in reciprocal.iter_mut().zip(&a[k][k]) {
            *reciprocal = 1.0 / pivot;
        }
        let reciprocal = V::load(&reciprocal);
        // A pivot of zero has no reciprocal: infinite, which any bound finds.
        fails |= reciprocal.any_beyond(V::splat(f64::MAX));
        let mut multipliers = [V::splat(0.0); 6];
        for i in 0..6 {
            multipliers[i] = V::load(&a[k][i]);
            if i > k {
                fails |= multipliers[i].times(reciprocal).any_beyond(V::splat(1.0 / PIVOT_RATIO));
            }
        }
        // The pivot's own row takes x = b_k / pivot, the others b_i - a_ik x.
        multipliers[k] = pivot;
        for column in a[k + 1..].iter_mut().chain(b.iter_mut()) {
            let x = V::load(&column[k]).times(reciprocal);
            for i in 0..6 {
                if i != k {
                    V::load(&column[i])
                        .minus_product(multipliers[i], x)
                        .store(&mut column[i]);
                }
            }
            x.store(&mut column[k]);
        }
    }
    !fails
}

#[inline(always)]
fn splat(m: &PaddedColumns) -> [Column; 6] {
    let mut out = [[[0.0; LANES]; 6]; 6];
    for (to, from) in out.iter_mut().zip(m) {
        for (to, from) in to.iter_mut().zip(from) {
            *to = [*from; LANES];
        }
    }
    out
}

#[inline(always)]
fn load_matrix<V: Vector>(m: &[Column; 6]) -> [[V; 6]; 6] {
    let mut out = [[V::splat(0.0); 6]; 6];
    for (to, from) in out.iter_mut().zip(m) {
        for (to, from) in to.iter_mut().zip(from) {
            *to = V::load(from);
        }
    }
    out
}

/// out -= m x.
#[inline(always)]
fn subtract_product<V: Vector>(m: &[[V; 6]; 6], x: &Column, out: &mut Column) {
    let mut factors = [V::splat(0.0); 6];
    for (to, from) in factors.iter_mut().zip(x) {
        *to = V::load(from);
    }
    for i in 0..6 {
        let mut sum = V::load(&out[i]);
        for j in 0..6 {
            sum = sum.minus_product(m[j][i], factors[j]);
        }
        sum.store(&mut out[i]);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix6;

    use super::super::guide_contact::expand;
    use super::super::substructure::{Chain, Substructure};
    use super::*;
    use crate::linear::Layout;
    use crate::simd::vector::Portable;

    const NODES: usize = 3;

    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (*seed >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
    }

    fn matrix(seed: &mut u64, diagonal: f64) -> Matrix6<f64> {
        Matrix6::from_fn(|_, _| random(seed)) + Matrix6::identity() * diagonal
    }

    /// Five spans of three inner nodes, one after the other, with a wall that touches here and there.
    fn case(diagonal: f64) -> (GuideChain, Vec<Span>, TangentIncrement, Group) {
        let mut seed = 5;
        let substructure = Substructure::of(Chain {
            diagonal: (0..NODES).map(|_| matrix(&mut seed, diagonal)).collect(),
            upper: (0..=NODES).map(|_| matrix(&mut seed, 0.0)).collect(),
            lower: (0..=NODES).map(|_| matrix(&mut seed, 0.0)).collect(),
        });
        let spans: Vec<Span> = (0..5)
            .map(|k| Span {
                first: 1 + k * (NODES + 1),
                inner: NODES,
                pipe: 0,
                guide: 0,
                coupling_of_pipe: 0,
            })
            .collect();
        let layout = Layout::new(vec![false; 5 * (NODES + 1) + 1]);
        let mut increment = TangentIncrement::new(&layout, 0, 1, std::iter::empty());
        for station in 0..layout.stations() {
            if station % 3 != 0 {
                increment.touching[station] = Touching::Guide;
            }
            for column in &mut increment.contact[station][6..] {
                column[6..].iter_mut().for_each(|x| *x = random(&mut seed));
            }
        }
        let group = Group {
            guide: 0,
            spans: [0, 1, 2, 3, 4, 4, 4, 4],
            count: 5,
        };
        (GuideChain::of(&substructure.unwrap()), spans, increment, group)
    }

    #[test]
    fn spans_together_are_spans_alone() {
        let (chain, spans, increment, group) = case(20.0);
        let mut seed = 11;
        let values: Vec<[[f64; LANES]; 6]> = (0..NODES + 2)
            .map(|_| std::array::from_fn(|_| std::array::from_fn(|_| random(&mut seed))))
            .collect();
        let (forces, ends) = values.split_at(NODES);
        let mut together = vec![InterfaceMatrices::NOTHING; 5];
        let mut solved = [NOTHING; NODES];
        assert!(chain.condense_lanes::<Portable>(&group, &spans, &increment, forces, &mut solved, &mut together));
        let mut inner = [[[0.0; LANES]; 6]; NODES];
        expand_lanes::<Portable>(&solved, &ends[0], &ends[1], &mut inner);
        // Rounding of some hundred operations on numbers of the order of one.
        let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-13, "{x} {y}");
        for (lane, span) in spans.iter().enumerate() {
            let stations = span.first..span.first + NODES;
            let mine: Vec<f64> = forces.iter().flatten().map(|x| x[lane]).collect();
            let mut solved = vec![[[0.0; 8]; COLUMNS]; NODES];
            let (touching, contact) = (&increment.touching[stations.clone()], &increment.contact[stations]);
            let alone = chain
                .condense::<Portable>(touching, contact, &mine, &mut solved)
                .unwrap();
            let parts = |c: &InterfaceMatrices| [c.top, c.bottom, c.upper, c.lower].concat().concat();
            let (x, y) = (parts(&together[lane]), parts(&alone));
            x.iter().zip(&y).for_each(|(x, y)| near(*x, *y));
            for end in 0..2 {
                (0..6).for_each(|i| near(together[lane].right[end][i], alone.right[end][i]));
            }
            let of = |column: &Column| std::array::from_fn(|i| column[i][lane]);
            expand::<Portable>(&solved, &of(&ends[0]), &of(&ends[1]), |node, x| {
                (0..6).for_each(|i| near(inner[node][i][lane], x[i]));
            });
        }
    }

    #[test]
    fn a_pivot_that_will_not_do_is_told() {
        let (mut chain, spans, mut increment, group) = case(20.0);
        let mut out = vec![InterfaceMatrices::NOTHING; 5];
        let mut run = |chain: &GuideChain, increment: &TangentIncrement| {
            let mut solved = [NOTHING; NODES];
            chain.condense_lanes::<Portable>(
                &group,
                &spans,
                increment,
                &[[[1.0; LANES]; 6]; NODES],
                &mut solved,
                &mut out,
            )
        };
        assert!(run(&chain, &increment));
        // One lane that is not a number, then a first pivot of zero in all of them.
        let kept = increment.contact[1][6][6];
        increment.contact[1][6][6] = f64::NAN;
        assert!(!run(&chain, &increment));
        increment.contact[1][6][6] = kept;
        increment.touching[1] = Touching::Nothing;
        chain.diagonal[0][0][0] = 0.0;
        assert!(!run(&chain, &increment));
    }
}
