//! A step's share of the audit: the works of all forces over it.

use super::EnergyPoint;
use crate::dynamics::numbered::Numbered;
use crate::dynamics::outcome::EnergyAudit;
use crate::dynamics::state::{State, motion};
use crate::simd::vector::Vector;
use crate::simd::{Instructions, Kernel};

/// dq . (f0 + f1) / 2 for the forces of both ends of a step.
#[inline(always)]
fn mean_work(moved: &[f64], before: &[f64], after: &[f64]) -> f64 {
    // Eight sums, so that the compiler can use vectors.
    let mut sums = [0.0; 8];
    let (moved, before, after) = (moved.as_chunks::<8>(), before.as_chunks::<8>(), after.as_chunks::<8>());
    for ((dq, f0), f1) in moved.0.iter().zip(before.0).zip(after.0) {
        for k in 0..8 {
            sums[k] += dq[k] * (f0[k] + f1[k]);
        }
    }
    for ((dq, f0), f1) in moved.1.iter().zip(before.1).zip(after.1) {
        sums[0] += dq * (f0 + f1);
    }
    0.5 * sums.iter().sum::<f64>()
}

/// Work of some kinds of forces by the trapezoid rule (J).
struct MeanWorks<'a, const N: usize> {
    /// Displacements of the step.
    moved: &'a [f64],
    forces: [[&'a [f64]; 2]; N],
}

impl<const N: usize> Kernel for MeanWorks<'_, N> {
    type Output = [f64; N];

    #[inline(always)]
    fn run<V: Vector>(self) -> [f64; N] {
        let mut out = [0.0; N];
        for (work, [f0, f1]) in out.iter_mut().zip(self.forces) {
            *work = mean_work(self.moved, f0, f1);
        }
        out
    }
}

/// Work of a chain's spans by the trapezoid rule over a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SpanWorks {
    /// Of the damping (J).
    pub damping: f64,
    /// Of the inertia (J).
    pub inertia: f64,
    /// Of the geometric stiffness (J).
    pub geometric: f64,
}

/// Both ends of a step: its states with what was evaluated there.
pub(crate) struct StepEnds<'a> {
    /// Step size (s).
    pub h: f64,
    /// Displacements of the step, by unknown.
    pub moved: &'a [f64],
    /// Work of the spans; over all stations there are none.
    pub spans: SpanWorks,
    pub before: (&'a State, &'a EnergyPoint),
    pub after: (&'a State, &'a EnergyPoint),
}

impl EnergyAudit {
    /// Adds a step.
    pub(crate) fn add_step(&mut self, numbered: &Numbered<'_>, ends: &StepEnds<'_>, instructions: Instructions) {
        let Numbered {
            model,
            places,
            weight,
            pressure,
        } = *numbered;
        let StepEnds {
            h,
            moved,
            spans,
            before: (s0, e0),
            after: (s1, e1),
        } = *ends;
        // Works by the trapezoid rule over the displacement: exact for forces that are linear in the step.
        let [friction, gravity] = instructions.run(MeanWorks {
            moved,
            forces: [[&e0.friction, &e1.friction], [weight, weight]],
        });
        // A tool without mud has no such vector, and its audit no term for it.
        if !e0.mud.is_empty() {
            let [work] = instructions.run(MeanWorks {
                moved,
                forces: [[&e0.mud, &e1.mud]],
            });
            self.mud += work;
        }
        let SpanWorks {
            mut damping,
            mut inertia,
            geometric: mut geometric_work,
        } = spans;
        // Elements by stations, or point masses.
        if e0.spans.is_empty() || !model.masses.is_empty() {
            let nodal = instructions.run(MeanWorks {
                moved,
                forces: [
                    [&e0.damping, &e1.damping],
                    [&e0.inertia, &e1.inertia],
                    [&e0.geometric, &e1.geometric],
                ],
            });
            damping += nodal[0];
            inertia += nodal[1];
            geometric_work += nodal[2];
        }
        let (error_before, foresight_before) = (self.error, self.axial_foresight);
        // All works of scalars use the same mean, so that the balance is one rule.
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        // Below a string the drive works on the string's top, and hoist and string have their own parts.
        if let Some(driven) = places.driven {
            self.drive += mean(e0.drive_torque, e1.drive_torque) * moved[driven];
        } else if model.description.string.is_some() {
            self.drive += mean(e0.drive_torque, e1.drive_torque) * (s1.drive_angle - s0.drive_angle);
            self.hoist += e1.hoist_work - e0.hoist_work;
            self.string += e1.string_lost - e0.string_lost;
            // The bit goes down with the frame.
            let advanced = h * mean(e0.advance, e1.advance);
            self.weight_on_bit -= mean(e0.weight_on_bit, e1.weight_on_bit) * advanced;
            self.feed += h * mean(e0.advance_power, e1.advance_power);
        }
        // The weight on bit is an input at the guide's end, or the rock's answer; either works on that displacement.
        self.weight_on_bit -= mean(e0.weight_on_bit, e1.weight_on_bit) * moved[places.guide_end];
        // What the twist of a bit that sticks takes it gives back.
        let twisted = e1.bit_elastic - e0.bit_elastic;
        self.bit += mean(e0.bit_torque, e1.bit_torque) * moved[places.bit_spin] - twisted;
        for (k, &load) in places.loads.iter().enumerate() {
            self.loads += mean(e0.loads[k], e1.loads[k]) * moved[load];
        }
        if !pressure.is_empty() {
            let along: f64 = pressure.iter().zip(moved).map(|(force, moved)| force * moved).sum();
            // The force of the pressure works on the whole strain of a span, its shortening included.
            let lifted = e1.lifted_by_pressure - e0.lifted_by_pressure;
            self.pressure += mean(e0.pressure, e1.pressure) * (along - lifted);
        }
        // The wall that moves past a guide at rest does work by its friction; what bristles take they give back.
        let feed = h * mean(e0.feed, e1.feed);
        self.feed += feed;
        self.friction += (feed - (e1.bristles - e0.bristles)) - friction;
        // By the same rule as `friction`, of which it is a part: the mean of the pins' power differs by what the joint's
        // swing turns within the step.
        for ((m0, m1), joint) in e0.joint_moments.iter().zip(&e1.joint_moments).zip(&places.joints) {
            let rotations = (joint.above..joint.above + 3).chain(joint.below..joint.below + 3);
            let work = rotations
                .zip(m0.iter().zip(m1))
                .map(|(at, (m0, m1))| moved[at] * (m0 + m1));
            self.joint_friction -= 0.5 * work.sum::<f64>();
        }
        // Powers are integrated over time, forces over displacement: contact damping is known as a power.
        self.contact_damping += h * mean(e0.contact_dissipation, e1.contact_dissipation);
        self.gravity += gravity;
        // An eccentric mass falls with its node and by its turning.
        for (point, places) in model.masses.iter().zip(&places.masses) {
            let (before, after) = (motion(s0, places), motion(s1, places));
            let (r0, r1) = (
                point.body.offset(before.as_node().q),
                point.body.offset(after.as_node().q),
            );
            let down = (0..3).map(|k| point.gravity[k] * (moved[places[k]] + (r1[k] - r0[k])));
            self.gravity += point.body.mass * down.sum::<f64>();
        }
        self.rayleigh_damping += damping;
        // The scheme's own loss: what inertia took less what became kinetic energy.
        self.numerical_damping += inertia - (e1.kinetic - e0.kinetic);
        self.axial_update += (e1.geometric_energy - e0.geometric_energy) - geometric_work;
        self.axial_foresight += h * mean(e0.foresight, e1.foresight);
        self.stored += e1.stored - e0.stored;
        // All terms are sums since the start, and so is the error.
        let worked_in =
            self.drive + self.weight_on_bit + self.gravity + self.loads + self.feed + self.axial_update + self.pressure;
        let worked_in = worked_in + self.hoist;
        let taken = self.bit + self.friction + self.contact_damping + self.rayleigh_damping + self.numerical_damping;
        let taken = taken + self.string + self.mud;
        self.error = worked_in - taken - self.stored;
        // The axial force that is foreseen works by intention and is no error of the laws.
        let foresight = self.axial_foresight - foresight_before;
        self.against_laws += (self.error - error_before - foresight).abs();
    }
}
