//! Shortening of a straight, tilted span of the pipe to second order.
//!
//! A span whose points move by v and w across it is shorter along it by the integral of (v'^2 + w'^2) / 2. With q the
//! unknowns of its ends, a the row that gives the elongation of the ends, D u = a . q, and G the beam's geometric
//! matrix for unit tension,
//!
//! ```text
//! e = a . q + s,      s = q . G q / 2,      N = (E A / L) e + N_p,      U = (E A / L) e^2 / 2,
//! forces on the ends: (N + beta N')(a + G q),      N' = (E A / L)(a . v + v . G q)
//! ```
//!
//! (von Karman's strain, averaged over the span). beta is Rayleigh's: it damps the rate of the strain itself, so that a
//! link that turns as a rigid body is not damped. The linear element has (E A / L)(a . q + beta a . v) a of it; this
//! file has the rest. Lengths in m, forces in N, tension positive.
//!
//! Under [pressure](super::pressure) N is the effective tension, N_p = - (1 - 2 nu) p A_i. A span that becomes longer by
//! de has de more wall and A_i de more bore: the wall takes N_wall de = (E A e / L + 2 nu p A_i) de, the pressure gives
//! p A_i de, so that pipe and mud resist by N_eff de = N_eff (a + G q) . dq, along and across. U is the strain's part;
//! the pressure's work on a span is - N_p (d(a . q) + d s), of which - N_p d(a . q) is that of a force on its ends.
//!
//! The inner stations of a span of several elements move along it such that its axial force is the same everywhere, so that
//! the law holds with the condensed geometric matrix.

use crate::chain::columns::{EndColumn, TENSION, at_ends, product, store};
use crate::chain::{Additions, BOTTOM, Chain, Effect, Precision, TOP, Touching, Under, row};
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::simd::Kernel;
use crate::simd::vector::Vector;
use crate::tool::Shortening;

/// The law of a span at one state.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stretch {
    /// Axial force N without damping, under pressure the effective tension (N).
    pub tension: f64,
    /// Axial force of the damping, beta N' (N).
    pub damped: f64,
    /// Elongation (m) whose elastic force the linear element lacks: s.
    pub shortening: f64,
    /// The same of the damping: beta v . G q (m).
    pub damped_shortening: f64,
    /// Elastic energy beyond that of the linear element (J).
    pub energy: f64,
}

impl Stretch {
    /// Of a span with the axial stiffness `axial` = E A / L (N/m) and damping `beta` (s), from the axial force of the linear
    /// element and its rate, t . q and t . v with t = (E A / L) a (N, N/s), and from q . G q (m) and v . G q (m/s).
    /// `unstrained` is its tension without strain (N).
    #[inline(always)]
    pub fn of(
        axial: f64,
        beta: f64,
        unstrained: f64,
        [linear, linear_rate]: [f64; 2],
        [square, square_rate]: [f64; 2],
    ) -> Self {
        let shortening = 0.5 * square;
        Self {
            tension: linear + axial * shortening + unstrained,
            damped: beta * (linear_rate + axial * square_rate),
            shortening,
            damped_shortening: beta * square_rate,
            energy: (linear + 0.5 * axial * shortening) * shortening,
        }
    }

    /// Factor of G q in the forces on the ends (N).
    #[inline(always)]
    pub fn across(&self) -> f64 {
        self.tension + self.damped
    }

    /// Factor of t in the forces on the ends beyond those of the linear element (m).
    #[inline(always)]
    pub fn along(&self) -> f64 {
        self.shortening + self.damped_shortening
    }
}

/// What a span adds to the tangent of the linear element: d forces / d q times `stiffness` and d forces / d v times
/// `damping`.
#[derive(Debug, Clone, Copy)]
pub struct StretchTangent {
    /// E A / L (N/m).
    pub axial: f64,
    /// Rayleigh's beta (s).
    pub beta: f64,
    /// Weights of the derivatives in displacements and velocities.
    pub factors: [f64; 2],
}

impl StretchTangent {
    /// Column `j` of the tangent, into `out`: with p = G q, r = G v, t and the geometric matrix' column, over as many rows.
    #[inline(always)]
    pub fn column(
        &self,
        stretch: &Stretch,
        [t, p]: [&[f64; 12]; 2],
        [t_j, p_j, r_j]: [f64; 3],
        geometric: &[f64; 12],
        out: &mut [f64; 12],
    ) {
        let [stiffness, damping] = self.factors;
        // (E A / L) ((a + p)(a + p)' - a a') with the damping's share, the turn of a + p under the damping, and N G.
        let elastic = stiffness + self.beta * damping;
        let by_slope = elastic * p_j + stiffness * self.beta * r_j;
        let by_stretch = elastic * t_j;
        let turned = stiffness * stretch.across();
        for i in 0..12 {
            out[i] = (t[i] + self.axial * p[i]) * by_slope + p[i] * by_stretch + turned * geometric[i];
        }
    }
}

/// The twelve numbers of a column over both ends.
#[inline(always)]
fn twelve(column: &EndColumn) -> [f64; 12] {
    std::array::from_fn(|k| column[row(k)])
}

#[inline(always)]
fn dot(a: &[f64; 12], b: &[f64; 12]) -> f64 {
    let mut sum = [0.0; 4];
    for k in 0..12 {
        sum[k % 4] += a[k] * b[k];
    }
    (sum[0] + sum[1]) + (sum[2] + sum[3])
}

/// The unknowns of a span's pipe at both ends.
#[inline(always)]
fn ends_of(values: &[f64], l: usize) -> [f64; 12] {
    let (nodes, _) = values.as_chunks();
    let [top, bottom] = at_ends(nodes, l, 0);
    std::array::from_fn(|k| if k < 6 { top[k] } else { bottom[k - 6] })
}

/// The pipe whose spans shorten.
#[derive(Clone)]
pub(crate) struct Shortened {
    /// Per span.
    stretches: Vec<Stretch>,
    /// Axial force across each span beyond that of the state (N).
    beyond: Vec<f64>,
}

impl Shortened {
    /// Of a pipe whose spans shorten to second order.
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        is_on(model).then(|| Self {
            stretches: vec![Stretch::default(); chain.spans()],
            beyond: vec![0.0; chain.spans()],
        })
    }
}

/// Whether the pipe's spans shorten to second order.
pub(crate) fn is_on(model: &Model) -> bool {
    model.description.shortening == Shortening::SecondOrder
}

/// `to` += factor column, over both ends.
#[inline(always)]
fn add_times(to: &mut EndColumn, column: &EndColumn, factor: f64) {
    for k in (0..6).chain(8..14) {
        to[k] += factor * column[k];
    }
}

impl Effect for Shortened {
    fn force(&mut self, chain: &mut Chain, state: &mut State, under: &Under<'_>) {
        for (l, (stretch, beyond)) in self.stretches.iter_mut().zip(&mut self.beyond).enumerate() {
            if chain.is_active(l) {
                let slopes = chain.geometric_forces[l][0];
                let kind = chain.model.kind(l);
                let tension = kind.tension[0];
                let (p, t) = (twelve(&slopes), twelve(&tension));
                let (q, v) = (ends_of(&state.q, l), ends_of(&state.v, l));
                let linear = [slopes[TENSION], dot(&t, &v)];
                let unstrained = chain.along[l].on_strain;
                let beta = under.conditions.rayleigh.beta;
                *stretch = Stretch::of(kind.axial, beta, unstrained, linear, [dot(&q, &p), dot(&v, &p)]);
                // The chain has the axial force of the state across the span; the rest and what is along it are left.
                *beyond = if under.keeps_axial {
                    stretch.across() - state.pipe_axial[l]
                } else {
                    stretch.damped
                };
                let [pipe, _] = chain.inside(l);
                add_times(pipe, &slopes, *beyond);
                add_times(pipe, &tension, stretch.along());
            }
            chain.along[l].beyond_ends = stretch.shortening;
            if !under.keeps_axial {
                state.pipe_axial[l] = stretch.tension;
            }
        }
    }

    fn tangent<S: Precision>(&self, to: &mut Additions<S>, chain: &Chain, state: &State, at: &Iteration<'_>) {
        chain.model.instructions.run(Tangents {
            to,
            chain,
            stretches: &self.stretches,
            state,
            at,
        });
    }

    fn energy(&self, chain: &Chain, point: &mut LedgerPoint, _state: &State, _under: &Under<'_>) -> f64 {
        let mut energy = 0.0;
        for (l, stretch) in self.stretches.iter().enumerate() {
            energy += stretch.energy;
            let damping = &mut point.spans[l].damping[0];
            add_times(damping, &chain.geometric_forces[l][0], stretch.damped);
            add_times(damping, &chain.model.kind(l).tension[0], stretch.damped_shortening);
        }
        energy
    }

    fn has_tension(&self) -> bool {
        true
    }

    fn tension_beyond(&self, l: usize) -> f64 {
        self.beyond[l]
    }
}

/// Adds the derivative of the active spans' forces beyond the linear ones.
struct Tangents<'a, S> {
    to: &'a mut Additions<S>,
    chain: &'a Chain,
    stretches: &'a [Stretch],
    state: &'a State,
    at: &'a Iteration<'a>,
}

impl<S: Precision> Kernel for Tangents<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            to,
            chain,
            stretches,
            state,
            at,
        } = self;
        let (rates, _) = state.v.as_chunks();
        for (l, stretch) in stretches.iter().enumerate() {
            if !chain.is_active(l) {
                continue;
            }
            let kind = chain.model.kind(l);
            let (p, t) = (twelve(&chain.geometric_forces[l][0]), twelve(&kind.tension[0]));
            let mut turning = [0.0; 16];
            store(product::<V>(&kind.geometric[0], &at_ends(rates, l, 0)), &mut turning);
            let r = twelve(&turning);
            let tangent = StretchTangent {
                axial: kind.axial,
                beta: at.conditions.rayleigh.beta,
                factors: [at.factors.stiffness, at.factors.damping],
            };
            // The tangent is full over the twelve unknowns of the pipe: tension couples both ends.
            let mut columns = [[0.0; 12]; 12];
            for (j, column) in columns.iter_mut().enumerate() {
                let geometric = twelve(&kind.geometric[0][j]);
                tangent.column(stretch, [&t, &p], [t[j], p[j], r[j]], &geometric, column);
            }
            let add = |to: &mut [S], from: &[f64]| {
                for (to, from) in to.iter_mut().zip(from) {
                    *to += S::of(*from);
                }
            };
            // The columns of each end are added to its node's block, the mixed ones to the coupling of both.
            let (top, bottom) = (TOP[0], BOTTOM[0]);
            let block = to.block(l, Touching::Both);
            for j in 0..6 {
                add(&mut block[TOP[j]][top..top + 6], &columns[j][..6]);
            }
            let block = to.block(l + 1, Touching::Both);
            for j in 0..6 {
                add(&mut block[BOTTOM[j]][bottom..bottom + 6], &columns[6 + j][6..]);
            }
            let coupling = to.coupling(l, Touching::Both);
            for j in 0..6 {
                add(&mut coupling.upper[j][top..top + 6], &columns[6 + j][..6]);
                add(&mut coupling.lower[j][bottom..bottom + 6], &columns[j][6..]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::beam::{Beam, ElementVector};
    use crate::tool::{Material, SectionProperties, Tube};

    fn beam() -> Beam {
        let tube = Tube {
            outer_diameter: 0.04,
            inner_diameter: 0.0,
        };
        Beam {
            section: SectionProperties::of(tube, Material::STEEL, 1.0),
            length: 0.6,
        }
    }

    struct At {
        stretch: Stretch,
        t: [f64; 12],
        p: [f64; 12],
        r: [f64; 12],
    }

    fn at(beam: &Beam, q: &[f64; 12], v: &[f64; 12], beta: f64) -> At {
        let axial = beam.section.axial / beam.length;
        let mut t = [0.0; 12];
        (t[0], t[6]) = (-axial, axial);
        let g = beam.geometric();
        let (q, v) = (ElementVector::from_row_slice(q), ElementVector::from_row_slice(v));
        let (p, r) = (g * q, g * v);
        let of = |x: &ElementVector| axial * (x[6] - x[0]);
        At {
            stretch: Stretch::of(axial, beta, 0.0, [of(&q), of(&v)], [q.dot(&p), v.dot(&p)]),
            t,
            p: p.into(),
            r: r.into(),
        }
    }

    const Q: [f64; 12] = [1e-5, 2e-3, -1e-3, 0.3, 0.01, 0.02, 3e-5, -4e-3, 6e-3, 0.2, -0.01, 0.015];
    const V: [f64; 12] = [0.1, 0.3, -0.2, 2.0, 0.5, -0.3, 0.2, 0.1, 0.4, 1.0, -0.6, 0.2];

    /// A link of 40 mm and 0.6 m that lies askew by d = 8.5 mm and whose lower end has come up by d^2 / (2 L) carries no
    /// tension, and none of its damping where it turns about its upper end at 1 rad/s. Tolerance 1e-9 N: rounding of the axial
    /// stiffness, 4e8 N/m, times 0.06 mm; differences are in N.
    #[test]
    fn analytic_shortening_of_a_link_askew() {
        use crate::support::scaled_figure;
        let beam = beam();
        // 8.5 mm over the length, both ends turned with it; the lower end up by d^2 / (2 L).
        let (d, l) = (8.5e-3, beam.length);
        let mut q = [0.0; 12];
        (q[4], q[8], q[10]) = (-d / l, d, -d / l);
        q[6] = -d * d / (2.0 * l);
        let At { stretch, .. } = at(&beam, &q, &[0.0; 12], 1e-4);
        scaled_figure("tension (N)", 0.0, stretch.tension, 1.0, 1e-9);
        let mut v = [0.0; 12];
        (v[4], v[8], v[10], v[6]) = (-1.0, l, -1.0, -d);
        let At { stretch, .. } = at(&beam, &q, &v, 1e-4);
        scaled_figure("tension of damping (N)", 0.0, stretch.damped, 1.0, 1e-9);
    }

    #[test]
    fn the_forces_are_those_of_the_energy_and_the_tangent_is_that_of_the_forces() {
        let (beam, beta) = (beam(), 1e-4);
        let axial = beam.section.axial / beam.length;
        let forces = |q: &[f64; 12], v: &[f64; 12]| -> [f64; 12] {
            let At { stretch, t, p, .. } = at(&beam, q, v, beta);
            std::array::from_fn(|i| stretch.along() * t[i] + stretch.across() * p[i])
        };
        let now = at(&beam, &Q, &V, beta);
        let moved = |x: &[f64; 12], j: usize, by: f64| {
            let mut x = *x;
            x[j] += by;
            x
        };
        let h = 1e-7;
        let still = [0.0; 12];
        let elastic = forces(&Q, &still);
        let g = beam.geometric();
        let largest = axial * 0.02;
        for (j, force) in elastic.iter().enumerate() {
            let energy = |by: f64| at(&beam, &moved(&Q, j, by), &still, beta).stretch.energy;
            let slope = (energy(h) - energy(-h)) / (2.0 * h);
            // Energies of 1 J round to 1e-16 over the step.
            assert!(
                (slope - force).abs() < 1e-6 * (1.0 + force.abs()) + 1e-3,
                "{j}: {slope}"
            );
            for (factors, quotient) in [
                (
                    [1.0, 0.0],
                    [forces(&moved(&Q, j, h), &V), forces(&moved(&Q, j, -h), &V)],
                ),
                (
                    [0.0, 1.0],
                    [forces(&Q, &moved(&V, j, h)), forces(&Q, &moved(&V, j, -h))],
                ),
            ] {
                let tangent = StretchTangent { axial, beta, factors };
                let mut column = [0.0; 12];
                let geometric: [f64; 12] = g.column(j).into_owned().into();
                let of = [now.t[j], now.p[j], now.r[j]];
                tangent.column(&now.stretch, [&now.t, &now.p], of, &geometric, &mut column);
                for i in 0..12 {
                    let difference = (quotient[0][i] - quotient[1][i]) / (2.0 * h);
                    // Forces of 1e5 N round to 1e-11 of them: 1e-4 N over the step; a second difference of the same size.
                    assert!(
                        (column[i] - difference).abs() < 1e-7 * largest + 1e-2,
                        "{factors:?} {i} {j}"
                    );
                }
            }
        }
    }
}
