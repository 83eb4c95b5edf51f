//! The chain's equations are those of the whole tool seen through the slaving: residual, tangent and solution.

mod against_stations;
mod derivative;
mod spans;
mod windows;

use nalgebra::{DMatrix, DVector, Matrix3};

use crate::Instructions;
use crate::chain::dependents::{FIRST_ROW, SECOND_ROW};
use crate::chain::{Chain, ChainEquations, Effect, NODE, TIE};
use crate::dynamics::carried::{Carried, JointForces};
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::joints::Joints;
use crate::dynamics::newton::{Equations, Iteration, correct};
use crate::dynamics::phases::Stopwatch;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::{Accuracy, Tolerances};
use crate::effects::contact::Layers;
use crate::effects::contact::law::LayerContacts;
use crate::effects::{Effects, acting};
use crate::elements::factors::TangentFactors;
use crate::elements::joint::Joint;
use crate::model::Model;
use crate::stations::{Assembler, Interactions};
use crate::tool::description::LiveParameters;
use crate::tool::{
    AddedMass, Body, Direction, FreeCurvature, FrictionLaw, JointKind, LoadHistory, Location, MudDamping,
    MudDescription, MudFilm, PointLoad, PointMass, PressureDescription, PressureEnd, PressureSource, RockLaw,
    Shortening, Spine, Support, ToolDescription, WallFrictionFactors, Weakening, WellSection, WobPath,
};

fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 33) as f64 / f64::from(1_u32 << 31) * 2.0 - 1.0
}

fn small(links: usize, elements: usize) -> ToolDescription {
    let mut tool = ToolDescription::paper().with_mesh(links, elements);
    // A wide limit leaves some of the stops shut and some open.
    tool.joint.limit = 0.26;
    tool
}

/// Friction in the pins, with a rate of swing that is not far above the width in which it turns.
fn with_pin_friction(mut tool: ToolDescription) -> ToolDescription {
    tool.joint.friction.coefficient = 0.2;
    tool.joint.friction.slip_rate = 0.5;
    tool
}

fn with_shortening(mut tool: ToolDescription) -> ToolDescription {
    tool.shortening = Shortening::SecondOrder;
    tool
}

/// Soft guides of three shapes as made, whose slots are closed in part of a lively state.
fn with_slots(tool: &ToolDescription) -> [ToolDescription; 3] {
    let free = |curvature: f64, phase: f64| Some(FreeCurvature { curvature, phase });
    [None, free(0.0, 0.0), free(0.2, 0.7)].map(|free| {
        let mut tool = tool.clone();
        (tool.guide_bending_factor, tool.guide_free_curvature) = (0.05, free);
        tool.guide_slots_close_at = Some(0.3);
        if free.is_some() {
            tool.supports.push(Support {
                location: Location::Top,
                body: Body::Guide,
                directions: vec![Direction::Psi],
            });
        }
        tool
    })
}

/// Soft guides whose spine lies on the low side, on the high side, and aside of a guide that is bent as made.
fn with_spine(tool: &ToolDescription) -> [ToolDescription; 3] {
    [0.0, std::f64::consts::PI, 0.7].map(|phase| {
        let mut tool = tool.clone();
        (tool.guide_bending_factor, tool.guide_spine) = (0.05, Some(Spine { offset: 0.04, phase }));
        if phase == 0.7 {
            tool.guide_free_curvature = Some(FreeCurvature { curvature: 0.2, phase });
            tool.supports.push(Support {
                location: Location::Top,
                body: Body::Guide,
                directions: vec![Direction::Psi],
            });
        }
        tool
    })
}

/// Play; the contact is soft, as the spins of a lively state are far apart.
fn with_play(mut tool: ToolDescription) -> ToolDescription {
    tool.joint.play.half_angle = 0.05;
    tool.joint.play.stiffness = 1e4;
    tool.joint.play.damping = 0.1;
    tool
}

/// Mud of 1100 kg/m3 whose viscosity is large enough to be told from rounding.
fn with_mud(mut tool: ToolDescription) -> ToolDescription {
    tool.mud = Some(MudDescription {
        density: 1100.0,
        viscosity: 2.0,
        frequency: 4.0,
        added_mass: AddedMass::Concentric,
        damping: MudDamping::Viscous,
        film: MudFilm::None,
    });
    tool
}

/// Mud whose mass and film grow near the walls. The film is soft, as a lively state moves far into it.
fn with_mud_near_walls(tool: ToolDescription) -> ToolDescription {
    let mut tool = with_mud(tool);
    if let Some(mud) = &mut tool.mud {
        (mud.added_mass, mud.film, mud.viscosity) = (AddedMass::Eccentric, MudFilm::Squeeze, 0.02);
    }
    tool
}

/// Contacts that spans of a metre do not give way to.
fn with_soft_contacts(mut tool: ToolDescription) -> ToolDescription {
    (tool.inner.stiffness, tool.outer.stiffness) = (1e5, 2e5);
    tool
}

/// Both layers with a friction law of their own, and different coefficients around and along.
fn with_friction(mut tool: ToolDescription, inner: FrictionLaw, outer: FrictionLaw) -> ToolDescription {
    (tool.inner.friction_law, tool.outer.friction_law) = (inner, outer);
    (tool.inner.friction_axial, tool.outer.friction_axial) = (0.1, 0.5);
    tool
}

/// A hole with straight parts before and after its arc, and another friction of the wall in each.
fn with_intervals(mut tool: ToolDescription) -> ToolDescription {
    tool.well.sections = vec![
        WellSection::Straight { length: 1.1 },
        WellSection::Arc {
            radius: 3.2,
            angle: 1.0,
        },
        WellSection::Straight { length: 0.8 },
    ];
    tool.wall_friction_factors = WallFrictionFactors {
        before_arc: 0.5,
        arc: 1.4,
        after_arc: 2.5,
    };
    tool
}

/// Pairs of friction laws by which each law is in each layer.
const FRICTION: [[FrictionLaw; 2]; 4] = [
    [FrictionLaw::Vector, FrictionLaw::Vector],
    [FrictionLaw::Bristle, FrictionLaw::Bristle],
    [FrictionLaw::Vector, FrictionLaw::Bristle],
    [FrictionLaw::Bristle, FrictionLaw::Separate],
];

/// Where a step that ends at `state` may have begun: up to 40 um away, so that some bristles slip and others stick, with
/// random forces in the bristles.
fn before(chain: &Chain, state: &State, seed: u64) -> State {
    let mut seed = seed;
    let mut before = state.clone();
    before
        .q
        .iter_mut()
        .for_each(|x| *x += 4e-5 * random(&mut seed) * random(&mut seed).abs());
    for (k, node) in chain.model.nodes.list.iter().enumerate() {
        if node.joint.is_none() {
            before.q.copy_within(NODE * k..NODE * k + 3, NODE * k + 6);
        }
    }
    let forces = before.held_friction.iter_mut().flatten().flatten();
    forces.for_each(|force| *force = 300.0 * random(&mut seed));
    before
}

/// A law under which a bit sticks. The law with depth of cut needs a hoist; `effects/bit/tests.rs` has its derivatives.
const ROCKS: [RockLaw; 1] = [RockLaw::Weakening(Weakening { ratio: 1.8, rate: 4.0 })];

/// Angle of the bit (rad) that a step has `turned` (rad), and a bottom 0.3 mm above the bit (m): it cuts, and its wear flats
/// bear fully.
fn bit_before(chain: &Chain, state: &State, turned: f64) -> [f64; 2] {
    let places = &chain.model.places;
    [state.q[places.end_spin] - turned, state.q[places.guide_end] - 3e-4]
}

fn mass(location: Location, body: Body) -> PointMass {
    PointMass {
        location,
        body,
        mass: 8.0,
        axial_inertia: 0.05,
        transverse_inertia: 0.03,
        eccentricity: 0.02,
        eccentricity_phase: 0.4,
    }
}

fn load(location: Location, body: Body) -> PointLoad {
    PointLoad {
        location,
        body,
        direction: Direction::V,
        history: LoadHistory::Constant(300.0),
    }
}

/// Contact in both layers at about a third of the stations, inside spans too, at joints and at the first station.
fn lively(chain: &Chain, model: &Model, seed: u64) -> State {
    let (mut seed, mut pins) = (seed, seed + 77);
    let mut state = chain.state(model);
    state
        .pin_moments
        .iter_mut()
        .for_each(|moment| *moment = 40.0 + 20.0 * random(&mut pins));
    for values in [&mut state.v, &mut state.a] {
        values.iter_mut().for_each(|x| *x = random(&mut seed));
    }
    for node in state.q.chunks_exact_mut(NODE) {
        let angle = 3.0 * random(&mut seed);
        let active = if random(&mut seed) > 0.0 { 0.019 } else { 1e-4 };
        (node[3], node[4], node[5]) = (1e-4 * random(&mut seed), active * angle.cos(), active * angle.sin());
        let angle = 3.0 * random(&mut seed);
        let active = if random(&mut seed) > 0.0 { 0.009 } else { 1e-4 };
        (node[9], node[10], node[11]) = (1e-4 * random(&mut seed), active * angle.cos(), active * angle.sin());
        // A twist that a joint carries: what is out of balance by more has multipliers that no motion has.
        (node[0], node[12]) = (2.0 + 1e-3 * random(&mut seed), 5.0 * random(&mut seed));
        // Near what the joint's row asks for.
        node[6] = node[0] + 0.3 * random(&mut seed);
        for k in [1, 2, 7, 8, 13, 14] {
            node[k] = 0.05 * random(&mut seed);
        }
        node[TIE] = 1e-4 * random(&mut seed);
    }
    for (k, node) in chain.model.nodes.list.iter().enumerate() {
        if node.joint.is_none() {
            for values in [&mut state.q, &mut state.v, &mut state.a] {
                values.copy_within(NODE * k..NODE * k + 3, NODE * k + 6);
            }
        }
    }
    state
}

/// The state with what is not in the equations at zero, as it is in motion.
fn clean(chain: &Chain, state: &mut State) {
    for (unknown, weight) in chain.limits.weights(Accuracy::Rest).iter().enumerate() {
        let node = unknown / NODE * NODE;
        if *weight == 0.0 && Some(unknown) != chain.model.places.driven {
            (state.q[unknown], state.v[unknown], state.a[unknown]) = (0.0, 0.0, 0.0);
        }
        if chain.model.nodes.list[unknown / NODE].joint.is_none() {
            for values in [&mut state.q, &mut state.v, &mut state.a] {
                values.copy_within(node..node + 3, node + 6);
            }
        }
    }
}

/// No force in any joint.
fn no_forces(chain: &Chain) -> JointForces {
    JointForces {
        on_top: vec![[0.0; 3]; chain.spans()],
        multipliers: vec![[0.0; 2]; chain.multipliers.len()],
    }
}

/// What the chain's equations need apart from the chain.
struct Room {
    effects: Effects,
    joints: Joints,
    stopwatch: Stopwatch,
}

impl Room {
    fn new(model: &Model, chain: &Chain, instructions: Instructions) -> Self {
        Self {
            effects: Effects::of(model, chain),
            joints: Joints::new(model, instructions),
            stopwatch: Stopwatch::default(),
        }
    }

    /// What touches.
    fn layers(&self) -> &Layers {
        self.effects.contact.as_ref().unwrap().layers()
    }

    /// Begins a step of size `h` (s) from `start`, in which the bit was at an angle (rad) over a flat bottom at a depth (m).
    fn begin(&mut self, start: &State, h: f64, bit_before: [f64; 2]) {
        self.joints.begin();
        self.effects.begin(start, h);
        self.effects.bit.as_mut().unwrap().start(bit_before);
    }
}

fn equations<'a>(model: &'a Model, chain: &'a mut Chain, room: &'a mut Room) -> ChainEquations<'a, Effects> {
    ChainEquations {
        model,
        chain,
        effects: &mut room.effects,
        joints: &mut room.joints,
        stopwatch: &mut room.stopwatch,
    }
}

/// What the whole tool's unknowns are by each of the chain's and, in further columns, by the multiplier of each rotational
/// row.
fn slaving(chain: &Chain, model: &Model) -> DMatrix<f64> {
    let n = chain.unknowns();
    let rows = Joint::constraints(&model.description.joint);
    let mut out = DMatrix::zeros(model.unknowns(), n + rows * model.joints.len());
    let (mut unit, mut full) = (chain.state(model), State::at_rest(model));
    for j in 0..n {
        // Where the pipe passes a node in one piece, the rotations below are those above.
        let one_piece = chain.model.nodes.list[j / NODE].joint.is_none();
        let (above, below) = ((0..3).contains(&(j % NODE)), (6..9).contains(&(j % NODE)));
        let with = if one_piece && above { j + 6 } else { j };
        (unit.q[j], unit.q[with]) = (1.0, 1.0);
        if !(one_piece && below) {
            chain.show(model, &unit, &no_forces(chain), &mut full);
            out.set_column(j, &DVector::from_column_slice(&full.q));
        }
        (unit.q[j], unit.q[with]) = (0.0, 0.0);
    }
    for joint in 0..model.joints.len() {
        for row in 0..rows {
            out[(model.multipliers(joint) + 3 + row, n + rows * joint + row)] = 1.0;
        }
    }
    out
}
