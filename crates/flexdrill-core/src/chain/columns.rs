//! Columns over a node or over both ends of a span, in vectors of eight.

use super::{GUIDE, NODE, U};
use crate::simd::aligned::Aligned;
use crate::simd::vector::Vector;

/// A column over both ends of a span: six of the top end, two that do not count, six of the bottom end, two more.
pub(crate) type EndColumn = [f64; 16];
/// Forces on both ends of a span, pipe and guide.
pub(crate) type EndForces = [EndColumn; 2];

/// Lane of the geometric stiffness, free of forces, that gives the axial force (N).
pub(crate) const TENSION: usize = 7;

/// Per row, one in that row only.
pub(crate) static ONLY: Aligned<[[f32; NODE]; NODE]> = {
    let mut out = [[0.0; NODE]; NODE];
    let mut k = 0;
    while k < NODE {
        out[k][k] = 1.0;
        k += 1;
    }
    Aligned(out)
};

/// Two vectors of eight: a span's top and bottom end, or a node.
#[inline(always)]
pub(crate) fn load<V: Vector>(column: &[f64; 16]) -> [V; 2] {
    let (halves, _) = column.as_chunks::<8>();
    [V::load(&halves[0]), V::load(&halves[1])]
}

#[inline(always)]
pub(crate) fn store<V: Vector>(values: [V; 2], column: &mut [f64; 16]) {
    let (halves, _) = column.as_chunks_mut::<8>();
    values[0].store(&mut halves[0]);
    values[1].store(&mut halves[1]);
}

/// sum + column x.
#[inline(always)]
pub(crate) fn plus_column<V: Vector>(sum: [V; 2], column: &[f64; 16], x: V) -> [V; 2] {
    let column = load::<V>(column);
    [sum[0].plus_product(column[0], x), sum[1].plus_product(column[1], x)]
}

/// A matrix over both ends times what the ends are.
#[inline(always)]
pub(crate) fn product<V: Vector>(columns: &[EndColumn; 12], [top, bottom]: &Ends) -> [V; 2] {
    let zero = [V::splat(0.0); 2];
    let (mut above, mut below) = (zero, zero);
    for j in 0..6 {
        above = plus_column(above, &columns[j], V::splat(top[j]));
        below = plus_column(below, &columns[6 + j], V::splat(bottom[j]));
    }
    [above[0].plus(below[0]), above[1].plus(below[1])]
}

/// A local force's lanes with those of the rotations times a radius.
#[inline(always)]
pub(crate) fn at_radius(force: &[f64; 6], radius: f64) -> [f64; 6] {
    [
        force[0],
        force[1],
        force[2],
        radius * force[3],
        radius * force[4],
        radius * force[5],
    ]
}

/// `sum` plus the forces on both ends of a span by the components `x` of a local force.
#[inline(always)]
pub(crate) fn plus_rows<V: Vector>(sum: [V; 2], rows: &[EndColumn; 6], x: &[f64; 6]) -> [V; 2] {
    let (mut even, mut odd) = (sum, [V::splat(0.0); 2]);
    for k in 0..3 {
        even = plus_column(even, &rows[2 * k], V::splat(x[2 * k]));
        odd = plus_column(odd, &rows[2 * k + 1], V::splat(x[2 * k + 1]));
    }
    [even[0].plus(odd[0]), even[1].plus(odd[1])]
}

/// Places in the nodes of a span's ends, [top, bottom], of the first unknown of the pipe (0) or the guide (1) there.
#[inline(always)]
pub(crate) fn places(body: usize) -> [usize; 2] {
    if body == 0 { [U, 0] } else { [GUIDE; 2] }
}

/// First unknowns of a span's ends, [top, bottom], of the pipe (0) or the guide (1).
#[inline(always)]
pub(crate) fn ends(span: usize, body: usize) -> [usize; 2] {
    let [top, bottom] = places(body);
    [NODE * span + top, NODE * (span + 1) + bottom]
}

/// What a span's ends are to a body: the unknowns of its top end and of its bottom end.
pub(crate) type Ends = [[f64; 6]; 2];

/// The unknowns of the ends of the span below node `l`, of the pipe (0) or the guide (1).
#[inline(always)]
pub(crate) fn at_ends(nodes: &[[f64; NODE]], l: usize, body: usize) -> Ends {
    let (above, below) = (&nodes[l], &nodes[l + 1]);
    if body == 0 {
        [
            [above[3], above[4], above[5], above[6], above[7], above[8]],
            [below[0], below[1], below[2], below[3], below[4], below[5]],
        ]
    } else {
        [
            [above[9], above[10], above[11], above[12], above[13], above[14]],
            [below[9], below[10], below[11], below[12], below[13], below[14]],
        ]
    }
}

/// Eight values from each end on. Two of each belong to other unknowns, and are to be multiplied by zero.
#[inline(always)]
pub(crate) fn around<V: Vector>(values: &[f64], ends: [usize; 2]) -> [V; 2] {
    let mut out = [V::splat(0.0); 2];
    for (out, first) in out.iter_mut().zip(ends) {
        *out = match values[first..].first_chunk() {
            Some(eight) => V::load(eight),
            None => {
                // The guide's end at the bottom is the last but one of all.
                let mut last = [0.0; 8];
                last[..6].copy_from_slice(&values[first..first + 6]);
                V::load(&last)
            }
        };
    }
    out
}
