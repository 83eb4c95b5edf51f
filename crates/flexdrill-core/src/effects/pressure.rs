//! Pump pressure in the pipe: the effective tension, and what an end and a joint carry of it.
//!
//! Inside the pipe the pressure is higher than outside by p, which falls along the tool by friction of the mud. The mud is
//! counted with the pipe: what bends a pipe is the tension in its wall less pressure times bore, the effective tension
//!
//! ```text
//! N_eff = N_wall - p A_i
//! ```
//!
//! (Lubinski, Althouse and Logan, JPT 14, 1962). It takes the place of N in the geometric stiffness, and forces on pipe
//! and mud together are in balance with it. The friction that lowers p pulls the wall by as much per length as p A_i falls,
//! so that N_eff does not change by it; nor does it where the bore changes. A wall under internal pressure shortens
//! (Poisson's ratio nu), N_wall = EA e + 2 nu p A_i, so that an element has
//!
//! ```text
//! N_eff = EA e - (1 - 2 nu) p A_i.
//! ```
//!
//! The lower end decides: where it is closed and free, N_eff = 0 there; where it slides in a seal of area A_s, the pressure
//! pushes it up, N_eff = - p A_s, and the guide, whose connector holds the seal, is pulled down by the same force: a cut
//! through both pipes does not know the pump. Where it is held, the strain decides. The pins of a joint that is sealed at a diameter of
//! area A_j carry N_eff + p A_j. The momentum of the flow, rho A U^2, is left out (88 N at 8 l/s).
//!
//! Constant factors per pressure at the top are data of the spans and nodes; the conditions of a residual scale them. Work over
//! a step: the force of the pressure acts along the whole strain of a span, its second-order shortening included.
//!
//! Tension is positive; p in Pa. Hydrostatic pressure, the same inside and outside, is in the buoyancy.

use std::f64::consts::PI;
use std::sync::Arc;

use flexdrill_base::energies::Energies;
use nalgebra::DVector;

use crate::chain::columns::ends;
use crate::chain::{Along, Chain, Effect, Under};
use crate::dynamics::carried::Carried;
use crate::dynamics::energy::{LedgerPoint, StepWork};
use crate::dynamics::state::State;
use crate::model::Model;
use crate::tool::{PressureDescription, PressureEnd, PressureSource, ToolDescription};

/// Its place in [`Carried::of_effects`], the pressure at the top (Pa), and in
/// [`Sums::of_effects`](crate::dynamics::energy::Sums::of_effects), what shortening lifts of the forces per pressure (N m/Pa).
pub(crate) const PLACE: usize = super::places::PRESSURE;

/// Constant factors of the pressure at the tool's top.
#[derive(Debug, Clone)]
pub(crate) struct PipePressure {
    described: PressureDescription,
    /// Effective tension of each pipe element that is not strained, per pressure at the top (N/Pa).
    pub(crate) unstrained: Vec<f64>,
    /// Force on the pipe's lower end along its axis, per pressure at the top (N/Pa); its reaction is on the guide's.
    pub(crate) on_end: f64,
    /// Its reaction on the guide's lower end, along the guide's own axes (N/Pa).
    pub(crate) on_guide: [f64; 3],
    /// What the pins of each joint carry beyond the effective tension, per pressure at the top (N/Pa).
    on_pins: Vec<f64>,
}

impl PipePressure {
    /// That of `model`; `None` without pressure.
    pub(crate) fn around(model: &Model) -> Option<Self> {
        let d = &model.description;
        // The first station below the top is as deep as stations are apart.
        let law = Self::of(d.pressure?, d, model.stations[1].depth);
        let axis = model.stations[model.last()].pipe_to_station.column(0) * -law.on_end;
        Some(Self {
            on_guide: axis.into(),
            ..law
        })
    }

    /// Of a tool whose stations are `spacing` (m) apart.
    fn of(described: PressureDescription, d: &ToolDescription, spacing: f64) -> Self {
        let per_link = d.elements_per_link;
        let elements = d.links * per_link;
        let share = |stations: f64| 1.0 - described.drop_per_metre * spacing * stations;
        let free = 1.0 - 2.0 * d.material.poisson_ratio;
        let unstrained = |e: usize| {
            let bore = disc(d.pipe_sections[e % per_link].inner_diameter);
            -free * bore * share(e as f64 + 0.5)
        };
        let at_joint = |j: usize| disc(described.joint_seal_diameter) * share(((j + 1) * per_link) as f64);
        Self {
            unstrained: (0..elements).map(unstrained).collect(),
            on_end: match described.end {
                PressureEnd::Sealed { diameter } => -disc(diameter) * share(elements as f64),
                PressureEnd::Closed | PressureEnd::Held => 0.0,
            },
            on_guide: [0.0; 3],
            on_pins: (0..d.links - 1).map(at_joint).collect(),
            described,
        }
    }

    /// Pressure inside less outside at the tool's top (Pa), under that of the standpipe (Pa).
    #[inline]
    pub(crate) fn at_top(&self, standpipe: f64) -> f64 {
        match self.described.at_top {
            PressureSource::Constant(pressure) => pressure,
            PressureSource::Standpipe => standpipe,
        }
    }
}

/// Constant factors of a span.
#[derive(Clone, Copy)]
struct OnSpan {
    /// Effective tension without strain (N/Pa): the mean of its elements.
    mean: f64,
    /// The same as the span's ends have it: the mean by the elements' compliance.
    on_strain: f64,
    /// Force on its top end (N/Pa), along the axes of the link above.
    on_top: [f64; 3],
}

/// The pressure in the pipe of a chain.
#[derive(Clone)]
pub(crate) struct Pressurised {
    law: Arc<PipePressure>,
    spans: Arc<[OnSpan]>,
    /// Forces on pipe and mud, and on the guide's end, per pressure at the top (N/Pa), in the chain's numbering.
    forces: Arc<[f64]>,
    /// Pressure at the top in the last residual (Pa).
    at_top: f64,
}

impl Pressurised {
    /// Of a tool with pressure in the pipe.
    pub(crate) fn of(model: &Model, chain: &Chain) -> Option<Self> {
        let law = PipePressure::around(model)?;
        let (mut forces, mut spans) = (vec![0.0; chain.unknowns()], Vec::new());
        for l in 0..chain.spans() {
            let elements = chain.elements_of(l);
            let of_elements = &law.unstrained[elements];
            // An element that is pushed apart pushes both its nodes; the slaving brings that to the span's ends.
            let mut along = DVector::<f64>::zeros(6 * (of_elements.len() + 1));
            for (e, tension) in of_elements.iter().enumerate() {
                along[6 * e] += tension;
                along[6 * (e + 1)] -= tension;
            }
            let on_ends = chain.model.kind(l).on_ends(0, &along);
            spans.push(OnSpan {
                mean: of_elements.iter().sum::<f64>() / of_elements.len() as f64,
                // The lower end has its rotations first, and its axes are the span's own.
                on_strain: -on_ends[9],
                on_top: [on_ends[0], on_ends[1], on_ends[2]],
            });
            let [top, bottom] = ends(l, 0);
            for i in 0..6 {
                forces[top + i] += on_ends[i];
                forces[bottom + i] += on_ends[6 + i];
            }
        }
        // The seal is in the guide's connector: what pushes the pipe's end pulls the guide's.
        let places = &chain.model.places;
        forces[places.pipe_end] += law.on_end;
        for (k, force) in law.on_guide.into_iter().enumerate() {
            forces[places.guide_end + k] += force;
        }
        Some(Self {
            law: Arc::new(law),
            spans: spans.into(),
            forces: forces.into(),
            at_top: 0.0,
        })
    }
}

impl Effect for Pressurised {
    fn force(&mut self, chain: &mut Chain, state: &mut State, under: &Under<'_>) {
        self.at_top = self.law.at_top(under.conditions.standpipe_pressure);
        for (l, span) in self.spans.iter().enumerate() {
            let along = &mut chain.along[l];
            *along = Along {
                unstrained: self.at_top * span.mean,
                on_strain: self.at_top * span.on_strain,
                on_top: span.on_top.map(|force| self.at_top * force),
                ..*along
            };
            // The chain has set the axial force of the strain; the effective tension is that with the pressure's part.
            if !under.keeps_axial && self.at_top != 0.0 {
                state.pipe_axial[l] += along.unstrained;
            }
        }
    }

    fn applied(&self, residual: &mut [f64], wanted: &impl Fn(usize) -> bool) {
        // Pressure scales one vector of forces, because its distribution along the tool is fixed.
        for (unknown, force) in self.forces.iter().enumerate() {
            if wanted(unknown) {
                residual[unknown] -= self.at_top * force;
            }
        }
    }

    fn energy(&self, chain: &Chain, point: &mut LedgerPoint, _state: &State, _under: &Under<'_>) -> f64 {
        let spans = chain.along.iter().zip(self.spans.iter());
        point.sums.of_effects[PLACE] = spans.fold(0.0, |sum, (along, span)| sum + along.beyond_ends * span.on_strain);
        0.0
    }

    fn carry(&self, carried: &mut Carried) {
        carried.of_effects[PLACE] = self.at_top;
    }

    fn work(&self, _chain: &Chain, step: &StepWork<'_>, ledger: &mut Energies) {
        let along: f64 = self
            .forces
            .iter()
            .zip(step.moved)
            .map(|(force, moved)| force * moved)
            .sum();
        let (before, after) = (step.before, step.after);
        // The force of the pressure works on the whole strain of a span, its shortening included.
        let lifted = after.point.sums.of_effects[PLACE] - before.point.sums.of_effects[PLACE];
        let at_top = 0.5 * (before.carried.of_effects[PLACE] + after.carried.of_effects[PLACE]);
        ledger.pressure += at_top * (along - lifted);
    }

    fn on_pins(&self, joint: usize, carried: &Carried) -> f64 {
        carried.of_effects[PLACE] * self.law.on_pins[joint]
    }

    fn pulls_guide(&self, carried: &Carried) -> f64 {
        self.law.on_guide[0] * carried.of_effects[PLACE]
    }

    fn pushes_pipe(&self, carried: &Carried) -> Option<bool> {
        Some(carried.of_effects[PLACE] > 0.0)
    }
}

/// Area of a disc (m2).
fn disc(diameter: f64) -> f64 {
    PI / 4.0 * diameter * diameter
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::figure;

    /// Pressure at the top (Pa).
    const AT_TOP: f64 = 5e6;

    /// The figures that docs/effects/pressure.md prints for 5 MPa: -1.6 kN in a pipe that is held, 15.6 kN in a seal of 63 mm,
    /// up on the pipe and down on the guide, and 15.1 kN on a joint that is sealed at 62 mm; where friction takes nothing.
    /// Friction of 2 % per metre leaves 1 - 0.02 s at the depth s (m). Tolerances: half of the last printed digit; rounding.
    #[test]
    fn analytic_forces_of_the_pressure() {
        let law = |drop_per_metre: f64| {
            let tool = ToolDescription::paper().with(|tool| {
                tool.pressure = Some(PressureDescription {
                    at_top: PressureSource::Constant(AT_TOP),
                    drop_per_metre,
                    end: PressureEnd::Sealed { diameter: 0.063 },
                    joint_seal_diameter: 0.062,
                });
            });
            let model = Model::new(&tool).unwrap();
            (PipePressure::around(&model).unwrap(), model)
        };
        let (even, model) = law(0.0);
        figure("without strain (N)", -1.6e3, AT_TOP * even.unstrained[7], 0.032);
        figure("on the pipe's end (N)", -15.6e3, AT_TOP * even.on_end, 0.0033);
        let on_guide = even.on_guide.iter().map(|force| force * force).sum::<f64>().sqrt();
        figure("on the guide's end (N)", -even.on_end, on_guide, 1e-12);
        // The frames of both ends differ by half a link's turn.
        assert!(even.on_guide[0] > 0.99 * on_guide, "{:?}", even.on_guide);
        figure("on a joint's pins (N)", 15.1e3, AT_TOP * even.on_pins[3], 0.0034);

        let (falling, _) = law(0.02);
        let share = |depth: f64| 1.0 - 0.02 * depth;
        let e = 40;
        let middle = 0.5 * (model.stations[e].depth + model.stations[e + 1].depth);
        let quantity = "without strain, below friction (N)";
        figure(
            quantity,
            share(middle) * even.unstrained[e],
            falling.unstrained[e],
            1e-12,
        );
        let joint = model.stations[model.joint_stations[9]].depth;
        let quantity = "on a joint's pins, below friction (N)";
        figure(quantity, share(joint) * even.on_pins[9], falling.on_pins[9], 1e-12);
        let end = model.stations[model.last()].depth;
        figure(
            "on the end, below friction (N)",
            share(end) * even.on_end,
            falling.on_end,
            1e-12,
        );
        assert!(PipePressure::around(&Model::new(&ToolDescription::paper()).unwrap()).is_none());
    }
}
