//! The guide as a beam in the hole: elements with cubic shapes, one per chord.
//!
//! Unknowns of a node are (v, v', w, w'): its offset from the hole's axis to the right and to the low side, and their slopes
//! against the hole's tangent. Within an element the hole is the cubic through both points with both tangents, so that
//! whatever tangents the points have, beam and hole together have the geometry of the points. With y'' = (ky, -kb) of the
//! hole and C the thrust, the potential of an element is
//!
//! ```text
//! integral of  EI/2 |(v'', w'') + y'' + ring - shape|2  +  C y'' . (v, w) - C/2 (v'2 + w'2) - q . (v, w)
//! ring = -y'' (kb w - ky v): curvature changes across the hole;    shape = kf (sin roll, -cos roll)
//! ```
//!
//! Where the spine of the guide is e off its axis, against the direction m, the thrust bends the guide into m. The spine keeps
//! its length, so that the axis becomes shorter by e m . K per length, where K is the guide's change of curvature per length of
//! the axis that is there without a bend. K in the place of k = (v'', w'') + ring, and a load per thrust, have that:
//!
//! ```text
//! K = k - y'' e (m . k) / (1 + e m . y''),      - min(C, C_shut) e m . K
//! ```
//!
//! C_shut is the thrust that shuts the slots. Shut slots limit what the thrust bends; against what else bends the guide it is
//! as soft as with open ones.

use nalgebra::{Matrix4, SMatrix, SVector, Vector2, Vector4};

use crate::blocks::Blocks;
use crate::guide::{Gravity, Guide};
use crate::hole::Hole;

type Row = SVector<f64, 8>;

/// What an element needs of its piece of hole.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    /// Length of the chord (m).
    pub length: f64,
    /// Angles (right, low) of the hole's tangents at both ends against the chord (rad).
    slopes: [Vector2<f64>; 2],
    /// Mean y'' = (ky, -kb) of the hole (1/m).
    pub turn: Vector2<f64>,
    /// Mean curvature of the guide as made in it (1/m).
    made: f64,
    /// Weight across the hole (right, low) and along it, down (N/m).
    pub weight: Vector2<f64>,
    pub weight_along: f64,
}

impl Piece {
    /// Bending moment about the guide's axis (right, low) in the middle of the piece (N m), from the states of its ends and the
    /// thrust C (N): EI times the change of curvature, less that of the thrust on the spine.
    pub(crate) fn moment(&self, guide: &Guide, start: &Vector4<f64>, end: &Vector4<f64>, thrust: f64) -> Vector2<f64> {
        let bend = Vector2::new(end.y - start.y, end.w - start.w) / self.length;
        let offset = Vector2::new(start.x + end.x, start.z + end.z) * 0.5;
        // The middle of the cubic is off the mean of its ends by the slopes' difference.
        let offset = offset - bend * (self.length * self.length / 8.0);
        let Some((toward, e)) = guide.thrust_bends() else {
            return (bend + self.turn + self.turn * self.turn.dot(&offset) - shape(guide, self.made))
                * guide.bending_stiffness;
        };
        let bend = bend + self.turn * self.turn.dot(&offset);
        let bend = bend - self.turn * (self.shorter(toward, e) * toward.dot(&bend));
        (bend + self.turn - shape(guide, self.made)) * guide.bending_stiffness
            - toward * (e * thrust.min(guide.shutting_thrust()))
    }

    /// By how much the axis of a guide becomes shorter as its curvature changes (m), with its spine `e` (m) off the axis.
    fn shorter(&self, toward: Vector2<f64>, e: f64) -> f64 {
        e / (1.0 + e * toward.dot(&self.turn))
    }
}

/// y'' of the guide (right, low) where it was made with a curvature (1/m).
fn shape(guide: &Guide, made: f64) -> Vector2<f64> {
    let (sine, cosine) = guide.roll.sin_cos();
    Vector2::new(sine, -cosine) * made
}

/// Pieces of the last `points` points of a hole.
pub(crate) fn pieces(guide: &Guide, hole: &Hole, points: usize, out: &mut Vec<Piece>) {
    let first = hole.points().len() - points;
    let (points, frames) = (&hole.points()[first..], &hole.frames()[first..]);
    out.clear();
    out.extend((1..points.len()).map(|index| {
        let chord = points[index] - points[index - 1];
        let length = chord.norm();
        let slopes = [index - 1, index].map(|end| -frames[end].deviation(chord));
        let q = guide.weight_per_metre;
        let (weight, weight_along) = match guide.gravity {
            Gravity::LowSide => (Vector2::new(0.0, q), 0.0),
            Gravity::Down => {
                // The lateral axes of both ends, so that an element at a kink has the weight of its middle.
                let right = 0.5 * (frames[index - 1].right.z + frames[index].right.z);
                let low = 0.5 * (frames[index - 1].low.z + frames[index].low.z);
                (Vector2::new(right, low) * q, q * chord.z / length)
            }
        };
        Piece {
            length,
            slopes,
            turn: (slopes[1] - slopes[0]) / length,
            made: guide.free_curvature,
            weight,
            weight_along,
        }
    }));
    // The pieces of the guide count from the bit up.
    if !guide.bends.is_none() {
        let mut near = 0.0;
        for piece in out.iter_mut().rev() {
            let far = near + piece.length;
            piece.made = guide.bends.mean(guide.free_curvature, near, far);
            near = far;
        }
    }
}

/// The shapes N and N'' at x = xi h of the offsets and slopes at both ends.
fn shapes(xi: f64, h: f64) -> ([f64; 4], [f64; 4]) {
    let (xi2, xi3) = (xi * xi, xi * xi * xi);
    (
        [
            1.0 - 3.0 * xi2 + 2.0 * xi3,
            h * (xi - 2.0 * xi2 + xi3),
            3.0 * xi2 - 2.0 * xi3,
            h * (xi3 - xi2),
        ],
        [
            (12.0 * xi - 6.0) / (h * h),
            (6.0 * xi - 4.0) / h,
            (6.0 - 12.0 * xi) / (h * h),
            (6.0 * xi - 2.0) / h,
        ],
    )
}

/// Numbers of the unknowns of a plane, 0 right and 1 low, in an element's row.
fn unknowns(plane: usize) -> [usize; 4] {
    [0, 1, 4, 5].map(|unknown| unknown + 2 * plane)
}

/// A row with the values of a plane's shapes.
fn row(plane: usize, values: [f64; 4]) -> Row {
    let mut row = Row::zeros();
    for (at, value) in unknowns(plane).into_iter().zip(values) {
        row[at] = value;
    }
    row
}

/// Points of Gauss's quadrature in an element, each with half of its length.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// What does not depend on the thrust: stiffness and load of all elements, and each element's load per thrust.
#[derive(Debug, Clone, Default)]
pub(crate) struct Beam {
    stiffness: Blocks,
    load: Vec<Vector4<f64>>,
    per_thrust: Vec<Row>,
    /// Load per thrust on the spine up to the one that shuts the slots; empty for a guide whose spine is on its axis.
    on_spine: Vec<Row>,
    shutting_thrust: f64,
}

impl Beam {
    /// Sets the beam of a guide in pieces of hole.
    pub(crate) fn set(&mut self, guide: &Guide, pieces: &[Piece]) {
        let Self {
            stiffness,
            load,
            per_thrust,
            on_spine,
            shutting_thrust,
        } = self;
        stiffness.reset(pieces.len() + 1);
        load.clear();
        load.resize(pieces.len() + 1, Vector4::zeros());
        per_thrust.clear();
        on_spine.clear();
        *shutting_thrust = guide.shutting_thrust();
        for (index, piece) in pieces.iter().enumerate() {
            let (matrix, force, curve, spine) = element(guide, piece);
            stiffness.diagonal[index] += matrix.fixed_view::<4, 4>(0, 0);
            stiffness.diagonal[index + 1] += matrix.fixed_view::<4, 4>(4, 4);
            stiffness.upper[index] = Matrix4::from(matrix.fixed_view::<4, 4>(0, 4));
            load[index] += force.fixed_rows::<4>(0);
            load[index + 1] += force.fixed_rows::<4>(4);
            per_thrust.push(curve);
            on_spine.extend(spine);
        }
    }

    /// Sets stiffness and load under a compression C (N) of each element.
    pub(crate) fn under(&self, pieces: &[Piece], thrust: &[f64], stiffness: &mut Blocks, load: &mut Vec<Vector4<f64>>) {
        stiffness.clone_from(&self.stiffness);
        load.clone_from(&self.load);
        for (index, (piece, &thrust)) in pieces.iter().zip(thrust).enumerate() {
            let h = piece.length;
            // The integral of N' N' over the element: offsets and slopes of an end with itself, and with the other end.
            let [offset, mixed, slope, far] =
                [36.0, 3.0 * h, 4.0 * h * h, -h * h].map(|value| thrust * value / (30.0 * h));
            for v in [0, 2] {
                let s = v + 1;
                for (block, sign) in [(index, 1.0), (index + 1, -1.0)] {
                    let block = &mut stiffness.diagonal[block];
                    block[(v, v)] -= offset;
                    block[(v, s)] -= sign * mixed;
                    block[(s, v)] -= sign * mixed;
                    block[(s, s)] -= slope;
                }
                let block = &mut stiffness.upper[index];
                block[(v, v)] += offset;
                block[(v, s)] -= mixed;
                block[(s, v)] += mixed;
                block[(s, s)] -= far;
            }
            let curve = &self.per_thrust[index];
            load[index] += curve.fixed_rows::<4>(0) * thrust;
            load[index + 1] += curve.fixed_rows::<4>(4) * thrust;
            if let Some(spine) = self.on_spine.get(index) {
                let bending = thrust.min(self.shutting_thrust);
                load[index] += spine.fixed_rows::<4>(0) * bending;
                load[index + 1] += spine.fixed_rows::<4>(4) * bending;
            }
        }
    }
}

/// Stiffness and load of an element, its load per thrust, which is the thrust's on the curve of the hole, and that per thrust on
/// a spine off the axis.
fn element(guide: &Guide, piece: &Piece) -> (SMatrix<f64, 8, 8>, Row, Row, Option<Row>) {
    let h = piece.length;
    let mut matrix = SMatrix::<f64, 8, 8>::zeros();
    let (mut force, mut curve) = (Row::zeros(), Row::zeros());
    let shape = shape(guide, piece.made);
    let thrust_bends = guide.thrust_bends();
    let mut on_spine = thrust_bends.map(|_| Row::zeros());
    for xi in GAUSS {
        let (value, second) = shapes(xi, h);
        let [offset_right, offset_low] = [0, 1].map(|plane| row(plane, value));
        // kb w - ky v: by this share a fibre is longer than the axis, and its curvature smaller.
        let longer = -(offset_right * piece.turn.x + offset_low * piece.turn.y);
        let mut bends = [0, 1].map(|plane| row(plane, second) - longer * piece.turn[plane]);
        if let (Some((toward, e)), Some(on_spine)) = (thrust_bends, &mut on_spine) {
            // The spine keeps its length: a bend shortens the axis, along which the hole turns.
            let shortening = (bends[0] * toward.x + bends[1] * toward.y) * piece.shorter(toward, e);
            for (plane, bend) in bends.iter_mut().enumerate() {
                *bend -= shortening * piece.turn[plane];
            }
            *on_spine += (bends[0] * toward.x + bends[1] * toward.y) * (0.5 * h * e);
        }
        for (plane, bend) in bends.into_iter().enumerate() {
            let ends = [piece.slopes[0][plane], piece.slopes[1][plane]];
            let hole = second[1] * ends[0] + second[3] * ends[1];
            let stiff = 0.5 * h * guide.bending_stiffness;
            matrix.ger(stiff, &bend, &bend, 1.0);
            force -= bend * (stiff * (hole - shape[plane]));
            let across = [offset_right, offset_low][plane];
            force += across * (0.5 * h * piece.weight[plane]);
            curve -= across * (0.5 * h * hole);
        }
    }
    for plane in 0..2 {
        let at = unknowns(plane);
        // The pipe's torque turns with the hole. That needs a couple T k per metre, which pushes the bit along x cross y''.
        let couple = guide.torque * [-piece.turn.y, piece.turn.x][plane];
        force[at[0]] -= couple;
        force[at[2]] += couple;
    }
    (matrix, force, curve, on_spine)
}
