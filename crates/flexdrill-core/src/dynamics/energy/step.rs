//! A step's entry in the ledger: the works of all forces over it.

use flexdrill_base::energies::Energies;

use super::LedgerPoint;
use crate::dynamics::carried::Carried;
use crate::dynamics::numbered::Numbered;
use crate::dynamics::state::State;
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

/// One end of a step, with what was evaluated there.
#[derive(Clone, Copy)]
pub(crate) struct StepEnd<'a> {
    pub state: &'a State,
    pub carried: &'a Carried,
    pub point: &'a LedgerPoint,
}

/// A step, from end to end.
pub(crate) struct StepWork<'a> {
    /// Step size (s).
    pub h: f64,
    /// Displacements of the step, by unknown.
    pub moved: &'a [f64],
    /// Work of the spans; over all stations there are none.
    pub spans: SpanWorks,
    pub before: StepEnd<'a>,
    pub after: StepEnd<'a>,
}

impl StepWork<'_> {
    /// Work of the effects' viscous damping (J).
    pub(crate) fn of_drag(&self, instructions: Instructions) -> f64 {
        let [work] = instructions.run(MeanWorks {
            moved: self.moved,
            forces: [[&self.before.point.drag, &self.after.point.drag]],
        });
        work
    }

    /// Enters the step into the ledger, to which effects have added their rows, and balances it.
    pub(crate) fn enter(&self, ledger: &mut Energies, numbered: &Numbered<'_>, instructions: Instructions) {
        let Numbered { places, weight, .. } = *numbered;
        let Self {
            h,
            moved,
            spans,
            before,
            after,
        } = *self;
        let (e0, e1) = (before.point, after.point);
        // Energies and powers of the whole tool at both ends.
        let (at0, at1) = (&e0.sums, &e1.sums);
        // Works by the trapezoid rule over the displacement: exact for forces that are linear in the step.
        let [friction, gravity] = instructions.run(MeanWorks {
            moved,
            forces: [[&e0.friction, &e1.friction], [weight, weight]],
        });
        let SpanWorks {
            mut damping,
            mut inertia,
            geometric: mut geometric_work,
        } = spans;
        // Elements by stations, or what acts at nodes.
        if e1.has_nodes {
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
        let (error_before, foresight_before) = (ledger.error, ledger.axial_foresight);
        // All works of scalars use the same mean, so that the balance is one rule.
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        // A drive that prescribes the spin of the first node works there.
        if let Some(driven) = places.driven {
            ledger.drive += mean(before.carried.drive_torque, after.carried.drive_torque) * moved[driven];
        }
        for (k, &load) in places.loads.iter().enumerate() {
            ledger.loads += mean(e0.loads[k], e1.loads[k]) * moved[load];
        }
        // The wall that moves past a guide at rest does work by its friction; what it holds it gives back.
        let feed = h * mean(at0.feed, at1.feed);
        ledger.feed += feed;
        ledger.friction += (feed - (at1.held - at0.held)) - friction;
        // By the same rule as `friction`, of which it is a part: the mean of the pins' power differs by what the joint's
        // swing turns within the step.
        for ((m0, m1), joint) in e0.pin_moments.iter().zip(&e1.pin_moments).zip(&places.joints) {
            let rotations = (joint.above..joint.above + 3).chain(joint.below..joint.below + 3);
            let work = rotations
                .zip(m0.iter().zip(m1))
                .map(|(at, (m0, m1))| moved[at] * (m0 + m1));
            ledger.joint_friction -= 0.5 * work.sum::<f64>();
        }
        // Powers are integrated over time, forces over displacement: the damping of what touches is known as a power.
        ledger.contact_damping += h * mean(at0.touch_dissipation, at1.touch_dissipation);
        ledger.gravity += gravity;
        ledger.gravity += at1.fallen - at0.fallen;
        ledger.rayleigh_damping += damping;
        // The scheme's own loss: what inertia took less what became kinetic energy.
        ledger.numerical_damping += inertia - (at1.kinetic - at0.kinetic);
        ledger.axial_update += (at1.geometric_energy - at0.geometric_energy) - geometric_work;
        ledger.axial_foresight += h * mean(at0.foresight, at1.foresight);
        ledger.stored += at1.stored - at0.stored;
        // All terms are sums since the start, and so is the error.
        ledger.error = ledger.unbalanced();
        // The axial force that is foreseen works by intention and is no error of the laws.
        let foresight = ledger.axial_foresight - foresight_before;
        ledger.against_laws += (ledger.error - error_before - foresight).abs();
    }
}
