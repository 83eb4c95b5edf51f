//! The law of mud near a wall: what an eccentric body carries and squeezes out beyond what it does about the centre.
//!
//! A body at the distance d from the centre of an annulus of width w, eps = |d| / w, moves against the outer wall with
//! the velocity v. Of what is beyond small motion about the centre ([`crate::effects::mud`]) this file has two parts, both of the
//! narrow annulus:
//!
//! **Added mass.** The kinetic energy m phi |v|^2 / 2 grows with phi(eps) = 2 (1 - sqrt(1 - eps^2)) / eps^2 = 2 / (1 +
//! s), s = sqrt(1 - eps^2), from 1 at the centre to 2 at the wall, alike across and along d. By Lagrange's equations the
//! mud takes
//!
//! ```text
//! m [ (phi - 1) a + phi' v - grad(phi) |v|^2 / 2 ],      grad(phi) = g d,   phi' = g (d.v),   g = 2 / (s (1 + s)^2 w^2)
//! ```
//!
//! from the body and gives it to the outer one: its work is the gain of kinetic energy.
//!
//! **Squeeze film.** The full film of lubrication (Pinkus and Sternlicht, Theory of Hydrodynamic Lubrication, 1961), which
//! the pressure of a deep hole keeps from cavitating, takes with c = 12 pi mu (r / w)^3 per length, n = d / |d|,
//!
//! ```text
//! c [ k_r n (n.v) + k_t (v - n (n.v)) ],      k_r = s^-3 - 1,      k_t = 2 / ((2 + eps^2) s) - 1
//! ```
//!
//! towards and around. The ones are what it has about the centre, in whose place [`crate::effects::mud`] has the damping at its
//! frequency. The load that a rotating pipe makes in its film is left out.
//!
//! eps counts up to 0.99: closer, rough surfaces touch. From there phi grows on to 2 as a parabola in eps^2, whose slope
//! falls from that at 0.99 to none: a slope that ended at once would leave a body that whirls along the wall between a force
//! towards the wall and none, where no step has a solution. Forces are those that the body loses (N), in the frame of the
//! station, y and z. SI.

use crate::elements::factors::TangentFactors;
use crate::simd::number::{Lane, Number};

/// Largest square of eps.
const MOST: f64 = 0.99 * 0.99;
/// s there.
const LEAST_ROOT: f64 = 0.141_067_359_796_658_84;
/// How far the parabola goes on from there in eps^2: with half of its first slope, 1 / (s (1 + s)^2), it gains the 2 - phi that
/// are left, 2 s / (1 + s).
const BEYOND: f64 = 4.0 * LEAST_ROOT * LEAST_ROOT * (1.0 + LEAST_ROOT);
/// Square of the distance (m2) below which its direction does not count.
const LEAST: f64 = 1e-16;
/// Square of eps below which the tangent leaves this out: phi - 1 is below 6 %, so that a correction leaves as much of
/// this small part.
const NEAR: f64 = 1e-6;

/// The mud of an annulus at a station, or of one in each of eight lanes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NearWall<N = f64> {
    /// m (kg); 0 leaves the added mass out.
    pub mass: N,
    /// c (N s/m); 0 leaves the film out.
    pub film: N,
    /// One over the square of the annulus's width (1/m2).
    pub per_square: N,
}

/// How a body moves in an annulus: y and z of its position, velocity and acceleration against the outer wall.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Motion<N = f64> {
    /// Position (m).
    pub d: [N; 2],
    /// Velocity (m/s).
    pub v: [N; 2],
    /// Acceleration (m/s2).
    pub a: [N; 2],
}

/// What the mud takes from the body beyond what it takes about the centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taken<N = f64> {
    /// Force of the film (N).
    pub film: [N; 2],
    /// Force of the added mass (N).
    pub inertia: [N; 2],
    /// Kinetic energy of the added mass (J).
    pub energy: N,
}

impl NearWall<Lane> {
    /// Sets the annulus in lane `k`.
    pub fn set_lane(&mut self, k: usize, from: &NearWall) {
        (self.mass[k], self.film[k], self.per_square[k]) = (from.mass, from.film, from.per_square);
    }

    /// The annulus in lane `k`.
    #[inline(always)]
    pub fn lane(&self, k: usize) -> NearWall {
        NearWall {
            mass: self.mass[k],
            film: self.film[k],
            per_square: self.per_square[k],
        }
    }
}

impl Motion<Lane> {
    /// The motion in lane `k`.
    #[inline(always)]
    pub fn lane(&self, k: usize) -> Motion {
        let two = |x: &[Lane; 2]| [x[0][k], x[1][k]];
        Motion {
            d: two(&self.d),
            v: two(&self.v),
            a: two(&self.a),
        }
    }
}

/// Sum of the products of two pairs. Functions and not closures, which the compiler may leave out of a vector kernel.
#[inline(always)]
fn dot<N: Number>(x: [N; 2], y: [N; 2]) -> N {
    (x[0] * y[0]).plus_product(x[1], y[1])
}

/// The smaller of two numbers.
#[inline(always)]
fn smaller<N: Number>(x: N, y: N) -> N {
    let zero = N::of(0.0);
    -(zero - x).largest(zero - y)
}

impl<N: Number> NearWall<N> {
    /// What the mud takes.
    #[inline(always)]
    pub fn take(&self, at: &Motion<N>) -> Taken<N> {
        let (zero, one, two) = (N::of(0.0), N::of(1.0), N::of(2.0));
        let Motion { d, v, a } = *at;
        let (away, closing, speed) = (dot(d, d), dot(d, v), dot(v, v));
        let eccentricity = away * self.per_square;
        let most = N::of(MOST);
        let u = smaller(eccentricity, most);
        let beyond = smaller((eccentricity - most).largest(zero), N::of(BEYOND));
        let s = (one - u).root();
        let sum = one + s;
        // phi by eps^2, and phi - 1.
        let growth = one.over(s * sum * sum);
        let slope = two * self.per_square * growth * (one - beyond * N::of(1.0 / BEYOND));
        let on = growth * beyond * (one - beyond * N::of(0.5 / BEYOND));
        let excess = (one - s).over(sum) + on;
        let around = two.over((two + u) * s) - one;
        let towards = one.over(s * s * s) - one;
        let along = (towards - around).over(away.largest(N::of(LEAST))) * closing;
        let (gained, turned) = (slope * closing, slope * N::of(0.5) * speed);
        let mut taken = Taken {
            film: [zero; 2],
            inertia: [zero; 2],
            energy: N::of(0.5) * self.mass * excess * speed,
        };
        for k in 0..2 {
            taken.film[k] = self.film * (around * v[k]).plus_product(along, d[k]);
            taken.inertia[k] = self.mass * ((excess * a[k]).plus_product(gained, v[k]) - turned * d[k]);
        }
        taken
    }
}

impl NearWall {
    /// Derivative of the force by the motion, columns of y and z, where displacement, velocity and acceleration change in
    /// proportion to the factors; `None` near the centre.
    #[inline]
    pub fn tangent(&self, at: &Motion, factors: &TangentFactors) -> Option<[[f64; 2]; 2]> {
        let Motion { d, v, a } = *at;
        // A body in the centre has no direction away from it: the floor avoids
        // a quotient of zeros, and below NEAR nothing is added.
        let away = (d[0] * d[0] + d[1] * d[1]).max(LEAST);
        let eccentricity = away * self.per_square;
        if eccentricity < NEAR || (self.mass == 0.0 && self.film == 0.0) {
            return None;
        }
        // Closer than MOST rough surfaces touch, and the eccentricity is held.
        let (u, inside) = if eccentricity < MOST {
            (eccentricity, 1.0)
        } else {
            (MOST, 0.0)
        };
        let (closing, speed) = (d[0] * v[0] + d[1] * v[1], v[0] * v[0] + v[1] * v[1]);
        // u, s and what follows are eps^2, s, phi and the coefficients at the head of this file.
        let s = (1.0 - u).sqrt();
        let sum = 1.0 + s;
        // By u: d u / d d = 2 d / w^2.
        let by_square = 2.0 * self.per_square;
        // Where the eccentricity is held, its derivative is zero.
        let by = by_square * inside;
        let growth = 1.0 / (s * sum * sum);
        // Beyond the bound phi levels out over BEYOND: a slope that ended at
        // once would leave states for which no step has a solution.
        let beyond = (eccentricity - MOST).clamp(0.0, BEYOND);
        let slope = by_square * growth * (1.0 - beyond / BEYOND);
        let bent = if beyond == 0.0 {
            0.5 * by * by * (1.0 / (s * s * s * sum * sum) + 2.0 / (s * s * sum * sum * sum))
        } else if beyond < BEYOND {
            -by_square * by_square * growth / BEYOND
        } else {
            0.0
        };
        // The film's two coefficients, across and towards the wall, less
        // their values in the centre, which the linear mud has.
        let (around, towards) = (2.0 / ((2.0 + u) * s) - 1.0, 1.0 / (s * s * s) - 1.0);
        let around_by = 1.0 / ((2.0 + u) * s * s * s) - 2.0 / ((2.0 + u) * (2.0 + u) * s);
        let towards_by = 1.5 / (s * s * s * s * s);
        // The film's tensor is isotropic across plus an excess along the direction of the wall.
        let along = (towards - around) / away;
        let along_by = (towards_by - around_by) * by / away - 2.0 * along / away;
        let excess = (1.0 - s) / sum + growth * beyond * (1.0 - 0.5 * beyond / BEYOND);
        // Column by column of the motion, with the factors of the scheme: mass, damping and stiffness in one matrix.
        let mut out = [[0.0; 2]; 2];
        for (column, out) in out.iter_mut().enumerate() {
            let other = |k: usize| f64::from(u8::from(k == column));
            for (row, out) in out.iter_mut().enumerate() {
                let unit = other(row);
                let of_mass = factors.mass * excess * unit
                    + factors.damping * slope * (closing * unit + v[row] * d[column] - d[row] * v[column])
                    + factors.stiffness
                        * (slope * a[row] * d[column]
                            + slope * (v[row] * v[column] - 0.5 * speed * unit)
                            + bent * (closing * v[row] - 0.5 * speed * d[row]) * d[column]);
                let of_film = factors.damping * (around * unit + along * d[row] * d[column])
                    + factors.stiffness
                        * (around_by * by * v[row] * d[column]
                            + along_by * closing * d[row] * d[column]
                            + along * (d[row] * v[column] + closing * unit));
                *out = self.mass * of_mass + self.film * of_film;
            }
        }
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::Random;

    const WIDTH: f64 = 8.5e-3;

    fn near() -> NearWall {
        NearWall {
            mass: 0.5,
            film: 40.0,
            per_square: 1.0 / (WIDTH * WIDTH),
        }
    }

    fn motion(random: &mut Random, eccentricity: f64) -> Motion {
        let angle = 3.0 * random.next();
        let (sin, cos) = (angle.sin(), angle.cos());
        Motion {
            d: [eccentricity * WIDTH * cos, eccentricity * WIDTH * sin],
            v: [0.3 * random.next(), 0.3 * random.next()],
            a: [100.0 * random.next(), 100.0 * random.next()],
        }
    }

    #[test]
    fn the_tangent_is_that_of_differences() {
        let mut random = Random(9);
        for eccentricity in [0.5, 0.7, 0.9, 0.97, 0.985, 1.01, 1.3] {
            for part in [[1.0, 0.0], [0.0, 1.0]] {
                let near = NearWall {
                    mass: part[0] * near().mass,
                    film: part[1] * near().film,
                    ..near()
                };
                let at = motion(&mut random, eccentricity);
                for (factors, h) in [
                    ([1.0, 0.0, 0.0], 1e-9),
                    ([0.0, 1.0, 0.0], 1e-6),
                    ([0.0, 0.0, 1.0], 1e-3),
                ] {
                    let [stiffness, damping, mass] = factors;
                    let factors = TangentFactors {
                        stiffness,
                        damping,
                        mass,
                    };
                    let tangent = near.tangent(&at, &factors).unwrap();
                    let scale = tangent.as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                    for column in 0..2 {
                        let force = |sign: f64| {
                            let mut at = at;
                            at.d[column] += sign * h * stiffness;
                            at.v[column] += sign * h * damping;
                            at.a[column] += sign * h * mass;
                            let taken = near.take(&at);
                            [0, 1].map(|k| taken.film[k] + taken.inertia[k])
                        };
                        let (high, low) = (force(1.0), force(-1.0));
                        for row in 0..2 {
                            let difference = (high[row] - low[row]) / (2.0 * h);
                            // Differences of 1e-7 of the width, at 0.985 of it: third derivatives leave 1e-9; rounding.
                            assert!(
                                (tangent[column][row] - difference).abs() < 1e-6 * scale + 1e-7 / h * 1e-6,
                                "{eccentricity} {part:?} {factors:?}: {tangent:?} {difference}"
                            );
                        }
                    }
                }
            }
        }
    }

    /// The power of the added mass is the gain of its kinetic energy, and the film takes energy.
    #[test]
    fn power_is_gain_of_energy() {
        let mut random = Random(10);
        for k in 0..2000 {
            let at = motion(&mut random, 0.0007 * f64::from(k));
            let taken = near().take(&at);
            let power = |force: [f64; 2]| force[0] * at.v[0] + force[1] * at.v[1];
            let energy = |t: f64| {
                let at = Motion {
                    d: [0, 1].map(|k| at.d[k] + at.v[k] * t),
                    v: [0, 1].map(|k| at.v[k] + at.a[k] * t),
                    ..at
                };
                near().take(&at).energy
            };
            let h = 1e-7;
            let gain = (energy(h) - energy(-h)) / (2.0 * h);
            let scale = gain.abs().max(1.0);
            assert!(
                (power(taken.inertia) - gain).abs() < 1e-5 * scale,
                "{} {gain}",
                power(taken.inertia)
            );
            assert!(power(taken.film) >= -1e-15, "{taken:?}");
        }
    }

    /// No force has a jump where the body comes to the wall: a whirl along the wall would stay at it, and no step there would
    /// have a solution. At the wall a body carries twice what it carries in the centre.
    #[test]
    fn the_added_mass_reaches_the_wall_without_a_jump() {
        assert!((LEAST_ROOT - (1.0 - MOST).sqrt()).abs() < 1e-16);
        let force = |eccentricity: f64, v: [f64; 2], a: f64| {
            let at = Motion {
                d: [0.0, eccentricity * WIDTH],
                v,
                a: [0.0, a],
            };
            near().take(&at).inertia[1]
        };
        let mut largest = 0.0_f64;
        for k in 0..3000 {
            let eccentricity = 0.96 + 5e-5 * f64::from(k);
            for v in [[0.3, 0.0], [0.0, 0.3]] {
                let step = force(eccentricity + 5e-5, v, 0.0) - force(eccentricity, v, 0.0);
                largest = largest.max(step.abs());
            }
        }
        // 27 N at 0.99 fall to none within 0.045 of the width: 0.1 N per step where the slope is steepest.
        assert!(largest < 0.1, "{largest} N");
        assert!((force(1.1, [0.0; 2], 1.0) / near().mass - 1.0).abs() < 1e-12);
    }

    /// Added mass of a body out of the centre over that in the centre, at the eccentricity e: 2 (1 - sqrt(1 - e^2)) / e^2,
    /// the potential flow of a thin annulus. Tolerance: rounding.
    #[test]
    fn analytic_eccentric_added_mass() {
        for eccentricity in [0.1, 0.5, 0.9, 0.98_f64] {
            let at = Motion {
                d: [0.0, eccentricity * WIDTH],
                a: [1.0, 0.0],
                ..Motion::default()
            };
            let got = 1.0 + near().take(&at).inertia[0] / near().mass;
            let square = eccentricity * eccentricity;
            let expected = 2.0 * (1.0 - (1.0 - square).sqrt()) / square;
            crate::support::figure(&format!("at e = {eccentricity} (-)"), expected, got, 1e-12);
            assert!(eccentricity != 0.9 || (got - 1.39).abs() < 5e-3);
        }
    }
}
