//! Whole steps of the chain with a node at every station against those of the witness, from the same states.

use super::equations::{StationEquations, StationRoom};
use super::interactions::Interactions;
use super::joint_violation;
use super::linear::{BlockLu, LinearSolver, SparseReference};
use crate::Instructions;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::newton::{self, Stride};
use crate::dynamics::phases::Stopwatch;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::{Accuracy, Tolerances};
use crate::effects::bit::BitMark;
use crate::inputs::Inputs;
use crate::model::Model;
use crate::step::{Forcing, SolverKind, Stepper, StepperSettings};
use crate::support::small;
use crate::tool::{
    AddedMass, FreeCurvature, FrictionLaw, JointKind, MudDamping, MudDescription, MudFilm, PressureDescription,
    PressureEnd, PressureSource, Shortening, Spine, ToolDescription, WobPath,
};

/// Step size (s).
const STEP: f64 = 2.5e-4;

/// A hundredth of the usual tolerances, an order above rounding: what is compared is the solution, not where the
/// iterations stop.
fn tolerances() -> Tolerances {
    Tolerances {
        force: 1e-5,
        moment: 1e-6,
        moving_force: (0.0, 1e-5),
        ..Tolerances::default()
    }
}

fn scheme() -> Scheme {
    Scheme::newmark(0.6)
}

fn over_stations(tool: &ToolDescription) -> Stepper {
    let settings = StepperSettings {
        time_step: STEP,
        scheme: scheme(),
        tolerances: tolerances(),
        max_halvings: 6,
        solver: SolverKind::Stations,
        instructions: Instructions::best(),
    };
    Stepper::new(tool, &settings).unwrap()
}

/// The step from `from` by the witness with this `solver`.
fn witnessed(
    model: &Model,
    solver: Box<dyn LinearSolver>,
    (from, bit): (&State, &BitMark),
    conditions: &Conditions,
) -> State {
    let instructions = Instructions::best();
    let mut room = StationRoom::new(model, solver, tolerances(), instructions);
    let mut to = from.clone();
    room.set_pin_moments(model, from, &mut to.pin_moments);
    let mut interactions = Interactions::new(model, instructions);
    room.assembler.bit.rewind(bit);
    let stride = Stride {
        scheme: scheme(),
        h: STEP,
        foresight: STEP,
        foreseen_part: scheme().foreseen_part(),
        accuracy: Accuracy::Motion,
        most_iterations: tolerances().max_iterations,
    };
    let mut equations = StationEquations {
        model,
        room: &mut room,
        interactions: &mut interactions,
        stopwatch: &mut Stopwatch::default(),
    };
    newton::step(&mut equations, &stride, conditions, from, &mut to).unwrap();
    to
}

/// Displacements of all nodes.
fn displacements(model: &Model, state: &State) -> Vec<f64> {
    let nodes = model
        .stations
        .iter()
        .flat_map(|s| [s.pipe_above, s.pipe_below, s.guide]);
    nodes.flat_map(|n| state.q[n..n + 6].to_vec()).collect()
}

/// Runs `tool` up and compares the steps that are `asked` for with those of both solvers of the witness. Gives the contacts
/// between the joints, of both layers, in the steps that were compared.
fn check(tool: &ToolDescription, steps: usize, asked: impl Fn(usize) -> bool) -> [usize; 2] {
    let mut stepper = over_stations(tool);
    let loaded = Inputs {
        weight_on_bit: 10e3,
        standpipe_pressure: 5e6,
        ..Inputs::ZERO
    };
    stepper.settle(&loaded).unwrap();
    let mut speed = 0.0;
    let mut contacts = [0; 2];
    for step in 0..steps {
        let next = f64::min(speed + 0.01, 4.0);
        let turning = |rotary_speed| Inputs { rotary_speed, ..loaded };
        let forcing = Forcing::between(&turning(speed), &turning(next));
        let mut before = stepper.state();
        // Newmark's scheme lags nothing; a state that is looked at does not show it.
        before.lagged.copy_from_slice(&before.a);
        let bit = stepper.effects().bit.as_ref().unwrap().mark();
        let mut conditions = stepper.conditions(before.time + STEP, &forcing.end());
        conditions.drive_angle = before.drive_angle + 0.5 * STEP * (speed + next);
        speed = next;
        stepper.advance(STEP, &forcing).ok().unwrap();
        let (model, after) = (stepper.model(), stepper.state());
        let (open, turned) = joint_violation(model, &after);
        assert!(
            open < 1e-9 && (turned < 1e-9 || tool.joint.play.half_angle > 0.0),
            "joint rows {open} m, {turned}"
        );
        if !asked(step) {
            continue;
        }
        let block_lu = Box::new(BlockLu::new(&model.layout));
        let solvers: [Box<dyn LinearSolver>; 2] = [block_lu, Box::new(SparseReference::default())];
        let by_chain = displacements(model, &after);
        let largest = by_chain.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for solver in solvers {
            let by_witness = displacements(model, &witnessed(model, solver, (&before, &bit), &conditions));
            let apart = by_chain.iter().zip(&by_witness);
            let apart = apart.fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
            // Relative 1e-9, the promise for a step.
            assert!(apart < 1e-9 * largest, "step {step}: {apart} of {largest}");
        }
        let inside = |station: &usize| model.stations[*station].joint.is_none();
        let layers = stepper.effects().contact.as_ref().unwrap().layers();
        let inner = layers.inner.iter().map(|(station, _)| station);
        contacts[0] += inner.filter(inside).count();
        contacts[1] += layers.outer.count();
    }
    contacts
}

/// From rest, and in every hundredth of the steps under way, when there is contact in both layers between the joints too.
#[test]
fn steps_of_the_papers_tool() {
    let contacts = check(&ToolDescription::paper(), 1200, |step| step < 10 || step % 100 == 99);
    assert!(
        contacts[0] > 0 && contacts[1] > 0,
        "no contact between joints: {contacts:?}"
    );
}

fn check_small(tool: &ToolDescription) {
    check(tool, 400, |step| step < 3 || step % 40 == 39);
}

#[test]
fn steps_with_each_kind_of_joint_and_path_of_the_weight() {
    for kind in [JointKind::Universal, JointKind::Revolute, JointKind::BallCage] {
        let mut tool = small();
        tool.joint.kind = kind;
        check_small(&tool);
        tool.wob_path = WobPath::Shared;
        check_small(&tool);
    }
    let mut tool = small();
    tool.joint.friction.coefficient = 0.2;
    check_small(&tool);
    tool.joint.play.half_angle = 0.01;
    tool.joint.play.stiffness = 1e4;
    check_small(&tool);
}

#[test]
fn steps_with_each_friction_law() {
    for [inner, outer] in [
        [FrictionLaw::Vector, FrictionLaw::Vector],
        [FrictionLaw::Bristle, FrictionLaw::Bristle],
        [FrictionLaw::Vector, FrictionLaw::Bristle],
    ] {
        let mut tool = small();
        (tool.inner.friction_law, tool.outer.friction_law) = (inner, outer);
        check_small(&tool);
    }
}

/// One after another, and all together.
#[test]
fn steps_with_what_acts_inside_spans() {
    let mud = MudDescription {
        density: 1100.0,
        viscosity: 0.02,
        frequency: 4.0,
        added_mass: AddedMass::Eccentric,
        damping: MudDamping::Viscous,
        film: MudFilm::Squeeze,
    };
    let pressure = PressureDescription {
        at_top: PressureSource::Standpipe,
        drop_per_metre: 0.05,
        end: PressureEnd::Sealed { diameter: 0.063 },
        joint_seal_diameter: 0.062,
    };
    let soft = |tool: &mut ToolDescription| {
        tool.guide_bending_factor = 0.05;
        tool.guide_free_curvature = Some(FreeCurvature {
            curvature: 0.2,
            phase: 0.7,
        });
        tool.guide_slots_close_at = Some(0.15);
    };
    let off_axis = Some(Spine {
        offset: 0.03,
        phase: 0.7,
    });
    let mut tools = [0; 6].map(|_| small());
    tools[0].mud = Some(mud);
    tools[1].pressure = Some(pressure);
    tools[2].shortening = Shortening::SecondOrder;
    soft(&mut tools[3]);
    let all = &mut tools[4];
    (all.mud, all.pressure, all.shortening) = (Some(mud), Some(pressure), Shortening::SecondOrder);
    soft(all);
    all.guide_spine = off_axis;
    (tools[5].guide_bending_factor, tools[5].guide_spine) = (0.05, off_axis);
    for tool in &tools {
        check_small(tool);
    }
}
