//! The motion reads nothing of the ledger.

use crate::Instructions;
use crate::dynamics::Energies;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::tolerances::Tolerances;
use crate::inputs::Inputs;
use crate::step::{Forcing, SolverKind, Stepper, StepperSettings};
use crate::support::small;
use crate::tool::{
    AddedMass, FrictionLaw, MudDamping, MudDescription, MudFilm, PressureDescription, PressureEnd, PressureSource,
    Shortening,
};

/// Step size (s).
const STEP: f64 = 2.5e-4;

/// Overwrites every number of the ledger by one that no tool has.
fn spoil(stepper: &mut Stepper) {
    const NONSENSE: f64 = 7e9;
    stepper.audit = Energies::of([NONSENSE; Energies::COUNT]);
    for ledger in [&mut stepper.track.ledger, &mut stepper.track.trial_ledger] {
        let vectors = [
            &mut ledger.friction,
            &mut ledger.geometric,
            &mut ledger.damping,
            &mut ledger.inertia,
            &mut ledger.drag,
            &mut ledger.loads,
        ];
        vectors.into_iter().for_each(|vector| vector.fill(NONSENSE));
        ledger.pin_moments.fill([NONSENSE; 6]);
        for span in &mut ledger.spans {
            for forces in [&mut span.geometric, &mut span.damping, &mut span.inertia] {
                *forces = [[NONSENSE; 16]; 2];
            }
        }
        let sums = &mut ledger.sums;
        (sums.stored, sums.kinetic, sums.geometric_energy) = (NONSENSE, NONSENSE, NONSENSE);
        (sums.foresight, sums.touch_dissipation) = (NONSENSE, NONSENSE);
        sums.of_effects.fill(NONSENSE);
    }
}

#[test]
fn the_motion_reads_nothing_of_the_ledger() {
    // Everything that puts rows into the ledger and acts inside spans or joints.
    let mut tool = small();
    tool.mud = Some(MudDescription {
        density: 1100.0,
        viscosity: 0.02,
        frequency: 4.0,
        added_mass: AddedMass::Eccentric,
        damping: MudDamping::Viscous,
        film: MudFilm::Squeeze,
    });
    tool.pressure = Some(PressureDescription {
        at_top: PressureSource::Standpipe,
        drop_per_metre: 0.05,
        end: PressureEnd::Sealed { diameter: 0.063 },
        joint_seal_diameter: 0.062,
    });
    tool.shortening = Shortening::SecondOrder;
    tool.joint.friction.coefficient = 0.2;
    tool.inner.friction_law = FrictionLaw::Bristle;
    let settings = StepperSettings {
        time_step: STEP,
        scheme: Scheme::newmark(0.6),
        tolerances: Tolerances::default(),
        max_halvings: 6,
        solver: SolverKind::default(),
        instructions: Instructions::best(),
    };
    let loaded = Inputs {
        weight_on_bit: 10e3,
        standpipe_pressure: 5e6,
        ..Inputs::ZERO
    };
    let mut steppers = [0; 2].map(|_| {
        let mut stepper = Stepper::new(&tool, &settings).unwrap();
        stepper.settle(&loaded).unwrap();
        stepper
    });
    let mut speed = 0.0;
    for _ in 0..400 {
        let next = f64::min(speed + 0.01, 4.0);
        let turning = |rotary_speed| Inputs { rotary_speed, ..loaded };
        let forcing = Forcing::between(&turning(speed), &turning(next));
        speed = next;
        spoil(&mut steppers[1]);
        for stepper in &mut steppers {
            stepper.advance(STEP, &forcing).ok().unwrap();
        }
    }
    assert_ne!(steppers[0].audit, steppers[1].audit);
    let [left, spoilt] = steppers.map(|stepper| stepper.track);
    // The tool turned, with contacts and pins that slip.
    assert!(left.state.drive_angle > 0.1 && left.carried.pin_power.iter().any(|power| *power > 0.0));
    assert_eq!(left.state, spoilt.state);
    assert_eq!(left.carried, spoilt.carried);
}
