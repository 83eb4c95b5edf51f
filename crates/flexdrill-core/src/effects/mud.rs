//! Mud between pipe and guide and between guide and wall: what moves with the bodies, and what its viscosity takes.
//!
//! An annulus of inner radius a, bore b and width w = b - a is filled with fluid of density rho and kinematic viscosity
//! nu. Its walls move across with the velocities V_i and V_o. Ideal fluid has the kinetic energy per length (Fritz, J.
//! Eng. Ind. 94, 1972; Chen, Wambsganss and Jendrzejczyk, J. Appl. Mech. 43, 1976)
//!
//! ```text
//! T = [ m |V_i - V_o|^2 - rho pi a^2 |V_i|^2 + rho pi b^2 |V_o|^2 ] / 2,      m = 2 rho pi a^2 b^2 / (b^2 - a^2)
//! ```
//!
//! for small motion about the centre. Fluid that moves with both walls takes part as a rigid body: rho pi (b^2 - a^2).
//! The fluid in the pipe's bore moves with the pipe. Motion along the axis and rotation move no ideal fluid.
//!
//! Viscosity acts on the relative velocity. In an oscillation of angular frequency omega the flow between the walls is
//! that of a slot, and m becomes complex:
//!
//! ```text
//! force per length = - (m k' a_r + omega m k'' v_r),      k' - i k'' = 1 + q (1 / (1 - tanh(s) / s) - 1)
//! s = (1 + i) w / (2 delta),     delta = sqrt(2 nu / omega),     q = (a^2 - a b + b^2) / (a b)
//! ```
//!
//! with the relative acceleration a_r and velocity v_r. The slot is exact for narrow annuli; the factor q makes its
//! limit of thin boundary layers that of any annulus, 4 pi rho a b (a^3 + b^3) / (b^2 - a^2)^2 sqrt(nu omega / 2),
//! from which Pettigrew, Taylor and Kim (1986) have their damping ratio. Its limit of slow motion is the film of
//! lubrication, 12 pi mu (a / w)^3 times q. Mass and damping are constant: those of the stated frequency.
//!
//! What is per length is lumped at the stations, half of each element's at either end. It acts across the hole, along y
//! and z of the station's frame. Mud has weight only by the buoyancy in the gravity. SI.

use std::f64::consts::PI;

use flexdrill_base::energies::Energies;
use nalgebra::{DMatrix, Vector3};

use crate::chain::{Chain, CoupledParts, Effect, Parts, Segment, Under};
use crate::dynamics::energy::StepWork;
use crate::dynamics::state::State;
use crate::model::Model;
use crate::tool::{AddedMass, MudDamping, MudDescription, ToolDescription, Tube};

/// A symmetric matrix over the lateral motion of pipe and guide, alike along y and z.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lateral {
    /// Force on the pipe by the pipe's motion.
    pub pipe: f64,
    /// On either by the other's.
    pub coupling: f64,
    /// On the guide by the guide's.
    pub guide: f64,
}

impl Lateral {
    /// This times `x`.
    #[must_use]
    pub fn times(self, x: f64) -> Self {
        Self {
            pipe: self.pipe * x,
            coupling: self.coupling * x,
            guide: self.guide * x,
        }
    }

    /// The sum with another.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            pipe: self.pipe + other.pipe,
            coupling: self.coupling + other.coupling,
            guide: self.guide + other.guide,
        }
    }
}

/// Mass and damping by the mud; per length, or lumped at a station.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MudLump {
    /// Added mass (kg, or kg/m).
    pub mass: Lateral,
    /// Damping (N s/m, or N s/m2).
    pub drag: Lateral,
}

/// A fluid-filled annulus whose walls move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Annulus {
    /// m k' (kg/m).
    pub(crate) mass: f64,
    /// omega m k'' (N s/m2).
    drag: f64,
    /// rho pi a^2 and rho pi b^2 (kg/m).
    displaced: [f64; 2],
}

impl Annulus {
    /// Of inner radius `a` and bore `b` (m).
    pub(crate) fn of(mud: &MudDescription, a: f64, b: f64) -> Self {
        let squares = [a * a, b * b];
        let displaced = squares.map(|square| mud.density * PI * square);
        let ideal = 2.0 * displaced[0] * squares[1] / (squares[1] - squares[0]);
        let kinematic = mud.viscosity / mud.density;
        let omega = 2.0 * PI * mud.frequency;
        if mud.damping == MudDamping::None || kinematic == 0.0 {
            return Self {
                mass: ideal,
                drag: 0.0,
                displaced,
            };
        }
        let q = (squares[0] - a * b + squares[1]) / (a * b);
        let [real, imaginary] = slot(0.5 * (b - a) * (0.5 * omega / kinematic).sqrt());
        Self {
            mass: ideal * (1.0 + q * real),
            drag: ideal * omega * q * imaginary,
            displaced,
        }
    }
}

/// 1 / (1 - tanh(s) / s) - 1 at s = (1 + i) `x`: its real part and minus its imaginary part.
fn slot(x: f64) -> [f64; 2] {
    // tanh of a complex number, without overflow: e = exp(-2 x), sinh(2x) and cosh(2x) over exp(2x) / 2.
    let e = libm::exp(-2.0 * x);
    let (sinh, cosh) = (1.0 - e * e, 1.0 + e * e);
    let below = cosh + 2.0 * e * libm::cos(2.0 * x);
    let (re, im) = (sinh / below, 2.0 * e * libm::sin(2.0 * x) / below);
    // tanh(s) / s = (re + i im) (1 - i) / (2 x).
    let (re, im) = ((re + im) / (2.0 * x), (im - re) / (2.0 * x));
    // t / (1 - t) for t = re + i im.
    let square = (1.0 - re) * (1.0 - re) + im * im;
    [(re * (1.0 - re) - im * im) / square, -im / square]
}

/// Adds mass and damping of the mud along a part of the tool.
pub(crate) fn linear(at: &Segment<'_>, parts: &mut Parts) {
    let Some(mud) = &at.model.description.mud else {
        return;
    };
    let size = 6 * (at.elements + 1);
    let assembled = |matrix: fn(&MudLump) -> Lateral| {
        let mut out: [DMatrix<f64>; 3] = std::array::from_fn(|_| DMatrix::zeros(size, size));
        for e in 0..at.elements {
            let matrix = matrix(&half_of_element(mud, at.model, at.first + e));
            for i in [e, e + 1] {
                // Across the hole are y and z of the station, in which the guide's numbers are.
                let turn = at.pipe_to_station(i);
                for k in 1..3 {
                    let (node, guide) = (6 * i, 6 * i + k);
                    for row in 0..3 {
                        for column in 0..3 {
                            out[0][(node + row, node + column)] += turn[(k, row)] * turn[(k, column)] * matrix.pipe;
                        }
                        out[1][(node + row, guide)] += turn[(k, row)] * matrix.coupling;
                    }
                    out[2][(guide, guide)] += matrix.guide;
                }
            }
        }
        out
    };
    parts.coupled = Some(CoupledParts {
        mass: assembled(|mud| mud.mass),
        damping: assembled(|mud| mud.drag),
    });
}

/// The mud's part in the motion of the tool.
#[derive(Debug, Clone)]
pub(crate) struct Mud {
    /// Of each station.
    pub stations: Vec<MudLump>,
}

impl Mud {
    /// Of a tool with mud, on any chain.
    pub(crate) fn of(model: &Model, _chain: &Chain) -> Option<Self> {
        Self::around(model)
    }

    /// Of a tool with mud.
    pub(crate) fn around(model: &Model) -> Option<Self> {
        let mud = model.description.mud.as_ref()?;
        let mut stations = vec![MudLump::default(); model.guide.len() + 1];
        for e in 0..model.guide.len() {
            let half = half_of_element(mud, model, e);
            for station in &mut stations[e..e + 2] {
                station.mass = station.mass.plus(half.mass);
                station.drag = station.drag.plus(half.drag);
            }
        }
        Some(Self { stations })
    }
}

impl MudLump {
    /// This times `x`.
    fn times(self, x: f64) -> Self {
        Self {
            mass: self.mass.times(x),
            drag: self.drag.times(x),
        }
    }
}

impl Effect for Mud {
    fn drags(&self) -> bool {
        true
    }

    fn work(&self, chain: &Chain, step: &StepWork<'_>, ledger: &mut Energies) {
        ledger.mud += step.of_drag(chain.model.instructions);
    }

    fn on_guide(&self, chain: &Chain, station: usize, state: &State, under: &Under<'_>) -> [f64; 2] {
        let at = &under.model.stations[station];
        let moving = |values: &[f64]| -> Vector3<f64> { at.pipe_to_station * chain.pipe_translation(values, station) };
        let (v, a) = (moving(&state.v), moving(&state.a));
        let MudLump { mass, drag } = self.stations[station];
        let alpha = under.conditions.rayleigh.alpha;
        [1, 2].map(|k| -(mass.coupling * (a[k] + alpha * v[k]) + drag.coupling * v[k]))
    }
}

/// Half of that of element `e`, which is lumped at either of its stations.
fn half_of_element(mud: &MudDescription, model: &Model, e: usize) -> MudLump {
    let d = &model.description;
    let pipe = &d.pipe_sections[e % d.elements_per_link];
    per_length(mud, d, pipe).times(0.5 * model.guide[e].beam.length)
}

/// Of an element with this `pipe`, per length.
fn per_length(mud: &MudDescription, d: &ToolDescription, pipe: &Tube) -> MudLump {
    let radius = |diameter: f64| 0.5 * diameter;
    let inner = Annulus::of(mud, radius(pipe.outer_diameter), radius(d.guide_section.inner_diameter));
    let outer = Annulus::of(mud, radius(d.guide_section.outer_diameter), radius(d.hole_diameter));
    let bore = mud.density * PI * radius(pipe.inner_diameter).powi(2);
    MudLump {
        mass: match mud.added_mass {
            AddedMass::None => Lateral::default(),
            AddedMass::Concentric | AddedMass::Eccentric => Lateral {
                pipe: bore + inner.mass - inner.displaced[0],
                coupling: -inner.mass,
                guide: inner.mass + inner.displaced[1] + outer.mass - outer.displaced[0],
            },
        },
        drag: Lateral {
            pipe: inner.drag,
            coupling: -inner.drag,
            guide: inner.drag + outer.drag,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::MudFilm;

    /// The paper's annuli: pipe of 63 mm in 80 mm, guide of 102 mm in 118 mm; radii (m).
    const ANNULI: [[f64; 2]; 2] = [[0.0315, 0.040], [0.051, 0.059]];

    fn mud(damping: MudDamping, viscosity: f64, frequency: f64) -> MudDescription {
        MudDescription {
            density: 1100.0,
            viscosity,
            frequency,
            added_mass: AddedMass::Concentric,
            damping,
            film: MudFilm::None,
        }
    }

    /// Twice the kinetic energy per length of ideal fluid between walls that move at V_i and V_o, by the potential phi =
    /// (A r + B / r) cos(theta): the surface integral of phi times its normal derivative.
    fn kinetic_energy([a, b]: [f64; 2], density: f64, [inner, outer]: [f64; 2]) -> f64 {
        // A - B / r^2 is the speed of the wall at r = a and r = b.
        let slope = (inner - outer) / (1.0 / (b * b) - 1.0 / (a * a));
        let (along, pole) = (inner + slope / (a * a), slope);
        let surface = |r: f64, speed: f64| PI * r * (along * r + pole / r) * speed;
        density * (surface(b, outer) - surface(a, inner))
    }

    /// Added mass of pipe and guide in mud of 1100 kg/m3, concentric: Fritz, J. Eng. Ind. 94, 1972, with the mud in the bore;
    /// less the steel. Also every combination of speeds against twice the kinetic energy of the potential flow. Tolerance:
    /// half of the last digit of the three figures.
    #[test]
    fn analytic_confined_added_mass() {
        let mut tool = ToolDescription::paper();
        tool.pipe_sections
            .iter_mut()
            .for_each(|pipe| pipe.inner_diameter = 0.032);
        let described = mud(MudDamping::None, 0.02, 1.0);
        let at = per_length(&described, &tool, &tool.pipe_sections[0]).mass;
        for [pipe, guide] in [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.7, -0.4]] {
            let bore = 1100.0 * PI * 0.016 * 0.016 * pipe * pipe;
            let expected = bore
                + kinetic_energy(ANNULI[0], 1100.0, [pipe, guide])
                + kinetic_energy(ANNULI[1], 1100.0, [guide, 0.0]);
            let got = at.pipe * pipe * pipe + 2.0 * at.coupling * pipe * guide + at.guide * guide * guide;
            // Rounding.
            assert!(
                (got / expected - 1.0).abs() < 1e-12,
                "{pipe}, {guide}: {got} {expected}"
            );
        }
        // The numbers of docs/effects/mud.md, printed to a hundredth.
        for (of, got, printed) in [
            ("pipe", at.pipe, 33.67 - 18.16),
            ("pipe with guide", at.coupling, -18.06),
            ("guide", at.guide, 110.39 - 24.69),
        ] {
            crate::support::scaled_figure(&format!("{of} (kg/m)"), printed, got, 1.0, 0.011);
        }
    }

    /// Pipe and guide that move as one carry the mud between them, rho pi (b^2 - a^2) = 2.100 kg/m. Tolerance: half of
    /// the last of four digits.
    #[test]
    fn analytic_mud_between_bodies_that_move_as_one() {
        let inner = Annulus::of(&mud(MudDamping::None, 0.02, 1.0), 0.0315, 0.040);
        let together = inner.displaced[1] - inner.displaced[0];
        crate::support::figure("mass (kg/m)", 2.100, together, 2.4e-4);
    }

    /// Added mass over displaced mass, and damping per length, in viscous fluid: Chen, Wambsganss and Jendrzejczyk, J.
    /// Appl. Mech. 43, 1976, and ANL-CT-75-08, 1975, whose function H(alpha, beta) they hold against experiments.
    /// Published law: the solution in Bessel functions, evaluated for both annuli in water (1e-6 m2/s, 1000 kg/m3) and
    /// mud (1.8e-5 m2/s, 1100 kg/m3) at 1, 10 and 100 Hz, coefficients to three digits, damping to two or three. Ours:
    /// the slot with the factor q. Tolerance: 0.5 % on the mass, whose values are printed to half a hundredth, and 2.5 % on
    /// the damping, which the slot has 2 % too high where the boundary layers fill the pipe's annulus (1 Hz).
    #[test]
    fn val_confined_oscillation_in_viscous_fluid() {
        use crate::support::figure;
        let cases = [
            (ANNULI[0], 1000.0, 1e-6, [(4.63, None), (4.38, None), (4.30, None)]),
            (ANNULI[1], 1000.0, 1e-6, [(7.47, None), (7.09, None), (6.97, None)]),
            (
                ANNULI[0],
                1100.0,
                1.8e-5,
                [(5.34, Some(60.0)), (4.75, Some(127.0)), (4.42, Some(357.0))],
            ),
            (
                ANNULI[1],
                1100.0,
                1.8e-5,
                [(8.48, Some(257.0)), (7.66, Some(520.0)), (7.15, Some(1449.0))],
            ),
        ];
        for ([a, b], density, kinematic, published) in cases {
            for (frequency, (coefficient, drag)) in [1.0, 10.0, 100.0].into_iter().zip(published) {
                let described = MudDescription {
                    density,
                    ..mud(MudDamping::Viscous, kinematic * density, frequency)
                };
                let got = Annulus::of(&described, a, b);
                let added = (got.mass - got.displaced[0]) / got.displaced[0];
                let at = format!("{} mm in {} mm, {kinematic:e} m2/s, {frequency} Hz", 2e3 * a, 2e3 * b);
                figure(
                    &format!("{at}: added over displaced mass (-)"),
                    coefficient,
                    added,
                    5e-3,
                );
                if let Some(drag) = drag {
                    figure(&format!("{at}: damping (N s/m2)"), drag, got.drag, 0.025);
                }
            }
        }
    }

    /// The limits of the damping per length in viscous mud, for both annuli: thin boundary layers by Pettigrew, Taylor and
    /// Kim, 1986, for a body of diameter D in D_e; and the film of lubrication. Tolerance: layers of 0.2 um in 8 mm leave out
    /// twice their part, 1e-4; the film at 1e-6 Hz has no inertia, 1e-6.
    #[test]
    fn analytic_damping_of_thin_layers_and_of_a_film() {
        use crate::support::figure;
        for [a, b] in ANNULI {
            let (frequency, kinematic) = (10.0, 1e-12);
            let got = Annulus::of(&mud(MudDamping::Viscous, 1100.0 * kinematic, frequency), a, b);
            let omega = 2.0 * PI * frequency;
            // Pettigrew, Taylor and Kim: c / (2 m omega) of a body of diameter D in D_e, g = D / D_e.
            let (d, g) = (2.0 * a, a / b);
            let ratio = PI / 8.0_f64.sqrt()
                * 1100.0
                * d
                * d
                * (2.0 * kinematic / (PI * frequency * d * d)).sqrt()
                * (1.0 + g.powi(3))
                / (1.0 - g * g).powi(2);
            let of = format!("{} mm in {} mm", 2e3 * a, 2e3 * b);
            figure(
                &format!("{of}: thin layers (N s/m2)"),
                2.0 * omega * ratio,
                got.drag,
                1e-4,
            );
            let slow = Annulus::of(&mud(MudDamping::Viscous, 0.02, 1e-6), a, b);
            let q = (a * a - a * b + b * b) / (a * b);
            let film = 24.0 * PI * 0.02 * q * (a * b / (b - a)).powi(2) / (b * b - a * a);
            figure(&format!("{of}: film (N s/m2)"), film, slow.drag, 1e-6);
        }
    }
}
