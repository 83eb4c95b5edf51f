//! Joint stations with one rotational row (universal, ball cage): 24 unknowns reduced to 16 before they are eliminated.
//!
//! Rows 18 to 20 of the block say s E_a du_a - s E_b du_b = r, so du_b = P du_a + c with P = E_b^T E_a. Adding P^T
//! times the rows of u_b to those of u_a cancels the three translational multipliers. Order of the 16: rotations of a,
//! u_a, rotations of b, guide, rotational multiplier; what couples to the next station comes late, so that its columns
//! enter the elimination late.

/// Unknowns of a joint station after the reduction, 16 of 24.
pub const REDUCED: usize = 16;
/// Columns of the coupling to the next station with entries in rows 0 to k of the reduced block: the pipe's begin at
/// u_a, the guide's at the guide.
#[inline(always)]
pub fn active(k: usize) -> usize {
    6 * (usize::from(k >= 3) + usize::from(k >= 9))
}
/// Place in the block of 24 of each reduced unknown.
pub const PLACES: [usize; REDUCED] = [3, 4, 5, 0, 1, 2, 15, 16, 17, 6, 7, 8, 9, 10, 11, 21];
/// First of u_a among the reduced unknowns.
const U: usize = 3;
/// First of the rotations of b.
const ROTATIONS: usize = 6;
/// First of the guide.
const GUIDE: usize = 9;
/// Relative tolerance on the orthogonality of the frames; a held translation fails by 1.
const ORTHOGONAL: f64 = 1e-9;

type Block = [[f64; 24]; 24];

/// What it takes to reduce a station and to recover what was taken out.
#[derive(Debug, Clone, Copy)]
pub struct Reduction {
    /// P by columns.
    pub turn: [[f64; 3]; 3],
    /// E_b / s, by columns, with the sign of its entries: gives the multipliers from the rows of u_b.
    pub recover: [[f64; 3]; 3],
}

impl Reduction {
    /// The reduction of a joint station, or `None` if the block does not have the form.
    pub fn of(block: &Block) -> Option<Self> {
        if block[22][22] != 1.0 || block[23][23] != 1.0 {
            return None;
        }
        let (mut above, mut below) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for j in 0..3 {
            above[j].copy_from_slice(&block[j][18..21]);
            below[j].copy_from_slice(&block[12 + j][18..21]);
        }
        let square = dot(&below[0], &below[0]);
        let small = ORTHOGONAL * square;
        let mut right = square > 0.0;
        for j in 0..3 {
            right &= (dot(&below[j], &below[j]) - square).abs() <= small;
            right &= dot(&below[j], &below[(j + 1) % 3]).abs() <= small;
            for i in 0..3 {
                right &= block[18 + i][j] == above[j][i] && block[18 + i][12 + j] == below[j][i];
            }
        }
        if !right {
            return None;
        }
        let scale = 1.0 / square;
        let mut reduction = Self {
            turn: [[0.0; 3]; 3],
            recover: below,
        };
        for (i, below) in below.iter().enumerate() {
            for (turn, above) in reduction.turn.iter_mut().zip(&above) {
                turn[i] = -scale * dot(below, above);
            }
        }
        reduction.recover.iter_mut().flatten().for_each(|x| *x *= scale);
        Some(reduction)
    }

    /// P^T x: a displacement of the start below seen from the end above.
    #[inline(always)]
    pub fn turned_back(&self, x: [f64; 3]) -> [f64; 3] {
        [dot(&self.turn[0], &x), dot(&self.turn[1], &x), dot(&self.turn[2], &x)]
    }

    /// P x: a displacement of the end above seen from the start below.
    #[inline(always)]
    pub fn turned(&self, x: [f64; 3]) -> [f64; 3] {
        let mut out = [0.0; 3];
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.turn[0][i] * x[0] + self.turn[1][i] * x[1] + self.turn[2][i] * x[2];
        }
        out
    }

    /// The 16 rows of a column of 24.
    #[inline(always)]
    pub fn rows(&self, column: &[f64; 24]) -> [f64; REDUCED] {
        let mut out = [0.0; REDUCED];
        out[..U].copy_from_slice(&column[3..6]);
        out[ROTATIONS..GUIDE].copy_from_slice(&column[15..18]);
        out[GUIDE..GUIDE + 6].copy_from_slice(&column[6..12]);
        out[REDUCED - 1] = column[21];
        let added = self.turned_back([column[12], column[13], column[14]]);
        for i in 0..3 {
            out[U + i] = column[i] + added[i];
        }
        out
    }

    /// The reduced block.
    pub fn reduce(&self, block: &Block) -> [[f64; REDUCED]; REDUCED] {
        let mut reduced = PLACES.map(|place| self.rows(&block[place]));
        for k in 0..3 {
            let column = self.rows(&block[12 + k]);
            for j in 0..3 {
                for (x, y) in reduced[U + j].iter_mut().zip(&column) {
                    *x += y * self.turn[j][k];
                }
            }
        }
        reduced
    }
}

#[inline(always)]
fn dot(x: &[f64; 3], y: &[f64; 3]) -> f64 {
    x[0] * y[0] + x[1] * y[1] + x[2] * y[2]
}
