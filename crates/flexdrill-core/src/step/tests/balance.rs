//! Balances that any mechanics must keep: reactions carry the loads, masses add up, the static start is at rest.

use crate::Instructions;
use crate::chain::Effect;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::tolerances::Tolerances;
use crate::inputs::Inputs;
use crate::stations::{Assembler, Interactions};
use crate::step::{SolverKind, Stepper, StepperSettings};
use crate::tool::{Body, Direction, JointKind, LoadHistory, Location, PointLoad, ToolDescription};
use nalgebra::Vector3;

fn stepper(tolerances: Tolerances, solver: SolverKind) -> Stepper {
    stepper_of(&ToolDescription::paper(), tolerances, solver)
}

fn stepper_of(tool: &ToolDescription, tolerances: Tolerances, solver: SolverKind) -> Stepper {
    let settings = StepperSettings {
        time_step: 2.5e-4,
        scheme: Scheme::newmark(0.6),
        tolerances,
        max_halvings: 6,
        solver,
        instructions: Instructions::best(),
    };
    Stepper::new(tool, &settings).unwrap()
}

#[test]
fn reactions_at_rest_carry_weight_and_weight_on_bit() {
    let mut stepper = stepper(Tolerances::default(), SolverKind::Stations);
    let weight_on_bit = 10e3;
    stepper
        .settle(&Inputs {
            weight_on_bit,
            ..Inputs::ZERO
        })
        .unwrap();
    let (model, state) = (stepper.model(), stepper.state());
    // The reactions as another assembly finds them.
    let mut witness = Assembler::new(model, Instructions::best());
    let mut interactions = Interactions::new(model, Instructions::best());
    interactions.begin(&state, 0.0);
    witness.bit.start([0.0, 0.0]);
    let loaded = Inputs {
        weight_on_bit,
        ..Inputs::ZERO
    };
    witness.residual(&mut interactions, model, &state, &stepper.conditions(0.0, &loaded));
    let residual = &witness.residual;
    // All forces from outside on both pipes in the world: gravity, weight on bit, wall, supports.
    let mut total = Vector3::z() * (model.mass() * model.description.gravity);
    let bottom = &model.stations[model.last()];
    total -= bottom.frame.column(0) * weight_on_bit;
    let mut wall = Vector3::zeros();
    stepper.effects().each_touched(Body::Guide, &mut |station, touched| {
        let [x, y, z, ..] = touched.force;
        wall += model.stations[station].frame * Vector3::new(x, y, z);
    });
    total += wall;
    for &unknown in &model.held {
        let station = &model.stations[model.layout.station_of(unknown)];
        let local = unknown - model.layout.offset(model.layout.station_of(unknown));
        let frame = if local < 6 {
            station.frame * station.pipe_to_station
        } else {
            station.frame
        };
        if local % 6 < 3 {
            total += frame.column(local % 6) * residual[unknown];
        }
    }
    // What pushes across the hole turns as the tool moves along it: 2 mrad at most, of 10 kN.
    let turned = stepper.outside_forces().wall - wall;
    assert!(turned.norm() < 30.0, "{turned}");
    total += turned;
    // Newton leaves up to 10 mN per node; 166 stations, two pipes. Of 10 kN.
    assert!(total.norm() < 0.35, "{total}");
    assert!(state.v.iter().all(|&v| v == 0.0));
}

#[test]
fn nothing_moves_after_the_static_start() {
    let mut simulation = crate::support::simulation(&ToolDescription::paper());
    let inputs = simulation.settings().initial_inputs;
    let start = simulation.stepper().state();
    for _ in 0..400 {
        simulation.advance(&inputs).ok().unwrap();
    }
    let state = simulation.stepper().state();
    let moved = state
        .q
        .iter()
        .zip(&start.q)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    // 0.1 s with the accelerations that Newton's tolerance of 1 mN on 0.5 kg allows: 1e-5 m.
    assert!(moved < 1e-5, "moved by {moved} m");
}

/// Without friction all joints of a bent chain at rest pass on the bit's torque: a ball cage as it is, whichever way it
/// bends.
#[test]
fn ball_cages_pass_the_torque_on() {
    let mut tool = crate::support::small();
    tool.joint.kind = JointKind::BallCage;
    tool.loads = vec![PointLoad {
        location: Location::Bottom,
        body: Body::Pipe,
        direction: Direction::Psi,
        history: LoadHistory::Constant(-50.0),
    }];
    let simulation = crate::support::simulation(&tool);
    let joints = simulation.new_snapshot().joints;
    assert!(
        joints.bend_angle.iter().all(|&bend| bend > 0.05),
        "{:?}",
        joints.bend_angle
    );
    for torque in joints.torque {
        // The static start leaves some 1 mN m per node; ten nodes.
        assert!((torque - 50.0).abs() < 1e-2, "{torque} N m");
    }
}

#[test]
fn the_mass_is_that_of_steel_tubes() {
    let stepper = stepper(Tolerances::default(), SolverKind::Stations);
    let area = |outer: f64, inner: f64| std::f64::consts::PI / 4.0 * (outer * outer - inner * inner);
    let length = 3.2 * std::f64::consts::FRAC_PI_2;
    let expected = 7850.0 * length * (area(0.063, 0.032) + area(0.102, 0.080));
    // Chords are shorter than arcs by (2.7 degrees)^2 / 24 = 1e-4.
    assert!((stepper.model().mass() / expected - 1.0).abs() < 1e-4);
}
