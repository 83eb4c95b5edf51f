//! Every way in which a step or a start can fail, provoked from outside, is reported with its cause and changes
//! nothing.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::dynamics::{FailureCause, StepFailure, StepOutcome};
use flexdrill_core::inputs::{InputKind, Inputs};
use flexdrill_core::step::StartError;
use flexdrill_core::tool::{
    Body, Direction, LoadHistory, Location, PointLoad, Support, ToolDescription, WellDescription, WellSection,
};
use flexdrill_core::twin::{BuildError, Simulation, SimulationSettings};
use support::{coarse, hard_settings, tiny};

const INPUTS: Inputs = Inputs {
    rotary_speed: 4.0,
    weight_on_bit: 10e3,
    ..Inputs::ZERO
};

/// The first failure within `steps` steps; afterwards everything is as before that step.
fn failure(mut simulation: Simulation, inputs: &Inputs, steps: u32) -> StepFailure {
    for _ in 0..steps {
        let before = simulation.new_snapshot();
        if let StepOutcome::Failed(failure) = simulation.advance(inputs) {
            let after = simulation.new_snapshot();
            assert_eq!(after.solver.failed_steps, 1);
            assert_eq!(after.solver.last_rejection.map(|last| last.cause), Some(failure.cause));
            assert_eq!((after.time, after.applied), (before.time, before.applied));
            assert_eq!((after.shape, after.energy), (before.shape, before.energy));
            return failure;
        }
    }
    panic!("no step failed");
}

fn start_error(tool: &ToolDescription) -> StartError {
    match Simulation::new(tool, &SimulationSettings::default()) {
        Err(BuildError::Start(error)) => error,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("it started"),
    }
}

fn load(location: Location, body: Body, direction: Direction, value: f64) -> PointLoad {
    PointLoad {
        location,
        body,
        direction,
        history: LoadHistory::Constant(value),
    }
}

#[test]
fn not_converged() {
    // Two iterations and no halving: the first collision cannot be solved.
    let simulation = Simulation::new(&coarse(), &hard_settings(2, 0)).unwrap();
    let failure = failure(simulation, &INPUTS, 4000);
    assert_eq!(failure.cause, FailureCause::NotConverged);
    let words = failure.to_string();
    assert!(
        words.starts_with("Newton's iterations did not converge (station "),
        "{words}"
    );
    assert!(words.ends_with("sub-step 2.000e-3 s)"), "{words}");
}

/// An input that is not finite, or far beyond any rig, is named with its value, bound and unit, and nothing is computed
/// from it.
#[test]
fn inputs_out_of_bounds() {
    use InputKind::{RateOfPenetration, RotarySpeed, StandpipePressure, WeightOnBit};
    for (kind, value) in [
        (RotarySpeed, f64::NAN),
        (RotarySpeed, f64::INFINITY),
        (RotarySpeed, 1e6),
        (RotarySpeed, -1001.0),
        (WeightOnBit, f64::NAN),
        (WeightOnBit, f64::NEG_INFINITY),
        (WeightOnBit, 1e12),
        (WeightOnBit, -1.0),
        (RateOfPenetration, f64::NAN),
        (RateOfPenetration, -1.1),
        (StandpipePressure, f64::INFINITY),
        (StandpipePressure, 1.1e9),
    ] {
        let simulation = Simulation::new(&tiny(), &SimulationSettings::default()).unwrap();
        let mut inputs = INPUTS;
        match kind {
            RotarySpeed => inputs.rotary_speed = value,
            WeightOnBit => inputs.weight_on_bit = value,
            RateOfPenetration => inputs.rate_of_penetration = value,
            StandpipePressure => inputs.standpipe_pressure = value,
        }
        let failure = failure(simulation, &inputs, 1);
        assert_eq!(failure.cause, FailureCause::InputOutOfBounds(kind), "{failure}");
        let [low, high] = Inputs::bounds(kind);
        let (name, unit) = (kind.name(), kind.si_unit());
        let words = failure.to_string();
        assert!(
            words.ends_with(&format!(
                "inputs.{name} = {value} {unit}: must be {low} to {high} {unit}"
            )),
            "{words}"
        );
    }
    // The bounds themselves are taken, and settings are held to the same ones.
    let bound = Inputs {
        rotary_speed: -1000.0,
        weight_on_bit: 1e7,
        rate_of_penetration: -1.0,
        standpipe_pressure: 1e9,
    };
    assert_eq!(bound.out_of_bounds(), None);
    let settings = SimulationSettings::default().with(|settings| {
        settings.initial_inputs = Inputs {
            rotary_speed: 1e6,
            ..INPUTS
        }
    });
    let refused = Simulation::new(&tiny(), &settings).err().map(|error| error.to_string());
    assert_eq!(
        refused.as_deref(),
        Some("settings: initial_inputs.rotary_speed = 1000000 rad/s: must be -1000 to 1000")
    );
}

#[test]
fn not_finite() {
    // A torque that comes within the first step, and overflows.
    let mut tool = tiny();
    tool.static_start = false;
    tool.loads = vec![PointLoad {
        history: LoadHistory::Table(vec![(0.0, 0.0), (1e-9, 1e308)]),
        ..load(Location::Bottom, Body::Pipe, Direction::Psi, 0.0)
    }];
    let simulation = Simulation::new(&tool, &SimulationSettings::default()).unwrap();
    let failure = failure(simulation, &INPUTS, 1);
    assert_eq!(failure.cause, FailureCause::NotFinite, "{failure}");
}

#[test]
fn singular() {
    // Damping so large that the tangent overflows; the start, which sees the mass only, does not.
    let mut tool = tiny();
    tool.static_start = false;
    tool.rayleigh.beta = 1e300;
    let simulation = Simulation::new(&tool, &SimulationSettings::default()).unwrap();
    assert_eq!(failure(simulation, &INPUTS, 10).cause, FailureCause::Singular);
}

#[test]
fn out_of_range() {
    // A single link without stiff neighbours is pulled out of a straight well, where nothing bends it: the geometric
    // stiffness of such a tension would keep the step from converging.
    let mut tool = tiny().with_mesh(1, 2);
    tool.static_start = false;
    tool.well = WellDescription {
        start_inclination: 0.0,
        sections: vec![WellSection::Straight { length: 0.32 }],
    };
    tool.loads = vec![load(Location::Bottom, Body::Pipe, Direction::U, 1e12)];
    let simulation = Simulation::new(&tool, &SimulationSettings::default()).unwrap();
    let failure = failure(simulation, &INPUTS, 1000);
    assert_eq!(failure.cause, FailureCause::OutOfRange);
    assert!(failure.value.abs() > 1.0, "{failure}");
}

#[test]
fn a_start_that_overflows() {
    let mut tool = tiny();
    tool.loads = vec![load(Location::Bottom, Body::Pipe, Direction::U, 1e300)];
    let error = start_error(&tool);
    assert!(matches!(error, StartError::Step(_)), "{error}");
    assert!(
        error.to_string().starts_with("the tool did not come to rest: "),
        "{error}"
    );
}

/// A support at a joint holds the end above it; the start below follows through the joint, so that nothing is held
/// twice.
#[test]
fn a_joint_held_in_place_starts_and_stays() {
    let mut tool = tiny();
    tool.supports.push(Support {
        location: Location::Joint(0),
        body: Body::Pipe,
        directions: vec![Direction::U, Direction::V, Direction::W],
    });
    let mut simulation = Simulation::new(&tool, &SimulationSettings::default()).unwrap();
    let inputs = Inputs {
        rotary_speed: 4.0,
        weight_on_bit: 1e3,
        ..Inputs::default()
    };
    for _ in 0..100 {
        assert!(matches!(simulation.advance(&inputs), StepOutcome::Advanced { .. }));
    }
    let station = simulation.joint_stations()[0];
    assert_eq!(simulation.lateral(station, Body::Pipe), Some([0.0; 2]));
}

#[test]
fn a_start_that_keeps_moving() {
    // Nothing keeps the guide from turning in a straight well.
    let mut tool = tiny();
    tool.well = WellDescription {
        start_inclination: 0.0,
        sections: vec![WellSection::Straight { length: 0.32 }],
    };
    tool.loads = vec![load(Location::Bottom, Body::Guide, Direction::Psi, 1e-3)];
    let error = start_error(&tool);
    assert!(
        matches!(error, StartError::Moving { speed, .. } if speed > 1e-6),
        "{error}"
    );
}
