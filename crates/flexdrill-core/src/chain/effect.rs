//! What acts inside the spans of a chain and at its nodes, as the chain sees it. The chain has no word of physics for it: it hands an effect its
//! motion, and gathers forces on the ends of spans, their derivative, and energies.

use flexdrill_base::energies::Energies;
use nalgebra::Vector3;

use super::columns::EndForces;
use super::precision::Precision;
use super::tangent::Additions;
use super::{Chain, ChainModel};
use crate::dynamics::carried::Carried;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::{LedgerPoint, StepWork};
use crate::dynamics::newton::Iteration;
use crate::dynamics::state::{Deflection, State};
use crate::elements::factors::TangentFactors;
use crate::model::Model;
use crate::simd::aligned::Aligned;
use crate::tool::description::Body;

/// What a residual is evaluated under.
pub(crate) struct Under<'a> {
    pub model: &'a Model,
    pub conditions: &'a Conditions,
    /// Whether the axial forces of the state count as they are.
    pub keeps_axial: bool,
}

/// What effects do to the pipe of a span along its axis, as the last residual found it. One effect may read what an earlier one
/// has written.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Along {
    /// Axial force of a pipe without strain (N, tension positive): the mean over the span.
    pub unstrained: f64,
    /// The same as the span's ends have it.
    pub on_strain: f64,
    /// Force on the span's top end, whatever the motion (N), along the axes of the link above.
    pub on_top: [f64; 3],
    /// Elongation of the pipe beyond that by the motion of its ends along it (m).
    pub beyond_ends: f64,
}

/// Forces of what acts inside all spans on their ends.
pub(crate) struct Inside<'a> {
    pub model: &'a ChainModel,
    /// Of each span: pipe and guide.
    pub forces: &'a mut [Aligned<EndForces>],
    /// Whether it is part of the present correction.
    pub moved: &'a [bool],
}

/// What touches a body at a station from outside, as the last residual found it: the guide the pipe, the wall the guide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Touched {
    /// Normal force (N, >= 0).
    pub normal: f64,
    /// Friction on the body around it, positive in the sense of positive spin (N).
    pub tangential: f64,
    /// Friction on the body along the hole, downhole positive (N).
    pub axial: f64,
    /// Power taken by damping (W).
    pub dissipation: f64,
    /// Power taken by friction (W, >= 0).
    pub friction_power: f64,
    /// Local force on the body at its surface: along x, y, z of the station (N), and torque and couples per radius (N).
    pub force: [f64; 6],
}

/// What acts on the tool's lower end, as the last residual found it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct EndLoad {
    /// Radius at which it acts (m).
    pub radius: f64,
    /// Torque against the rotation (N m).
    pub torque: f64,
    /// Force up the hole (N).
    pub weight: f64,
    /// Depth that the end cuts (m per turn); `None` where nothing there holds it.
    pub depth_of_cut: Option<f64>,
}

/// What is asked for at the end of a part of a step, beyond the [`Conditions`] there.
pub(crate) struct Asked {
    /// Size of the part (s).
    pub h: f64,
    /// Rotary speed (rad/s).
    pub rotary_speed: f64,
    /// Angle of the drive at the start of the part (rad).
    pub drive_angle: f64,
}

/// What turns the tool's top, and may carry it, at the end of the last step, where it is not held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FromAbove {
    /// Torque on the pipe's top (N m), positive where it drives.
    pub torque: f64,
    /// Speed of the drive (rad/s).
    pub drive_speed: f64,
    /// Whether the drive's torque is at its limit.
    pub drive_at_limit: bool,
    /// Torque (N m) and axial force (N, against advance) of friction above the tool.
    pub drag: [f64; 2],
    /// Load on the hook (N), without what supports at the tool's top hold.
    pub hook_load: f64,
    /// Time that a torsional wave needs from the drive to the tool (s).
    pub delay: f64,
    /// What carries the tool along the hole; `None` where a support does.
    pub carrier: Option<Carrier>,
}

/// What carries the tool along the hole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Carrier {
    /// Axial force on the guide's top (N), positive where it pushes down the hole.
    pub force: f64,
    /// Weight that is slacked off at the surface (N).
    pub weight: f64,
    /// Rate at which the frame of the tool's displacements advances (m/s).
    pub advance: f64,
    /// Distance by which it has advanced (m).
    pub depth: f64,
    /// Response time of its feed (s).
    pub response_time: f64,
    /// Whether it is fed by the weight that is asked for.
    pub by_weight: bool,
}

/// Something that acts inside spans or at nodes, beyond beams and joints. It keeps what it found at the last residual: its tangent
/// and its energy read that. It evaluates the spans that a correction has moved ([`Chain::is_active`]); the others keep their
/// forces. An effect that is linear along spans is data of theirs ([`Acting`](super::Acting)) and needs no force here.
///
/// An effect with a history keeps it from step to step: it [begins](Effect::release) it with the motion, takes on what a step
/// [accepted](Effect::accept), and [retreats](Effect::retreat) with the motion from a step that failed.
pub(crate) trait Effect {
    /// Makes what steps of size `h` (s) and their parts need, so that they do not allocate.
    fn prepare(&mut self, _h: f64) {}

    /// Forgets its history, before the tool comes to rest: until [`Effect::release`] it acts as at rest.
    fn hold(&mut self) {}

    /// Begins its history with the motion, from `state`, and sets in `conditions` what follows from it.
    fn release(&mut self, _state: &State, _conditions: &mut Conditions) {}

    /// Sets in `conditions` what follows from its history at `state`.
    fn resume(&mut self, _state: &State, _conditions: &mut Conditions) {}

    /// Takes a part of a step that the tool takes next, and sets in the `conditions` at its end, which are those asked for, what
    /// it makes of them. Nothing of it counts before [`Effect::accept`].
    fn lead(&mut self, _asked: &Asked, _conditions: &mut Conditions) {}

    /// Sets in `state`, from which the tool comes to rest, what it keeps there meanwhile.
    fn settle(&self, _state: &mut State) {}

    /// Begins the corrections of a step of size `step` (s) from the state `from`, or with 0 of a state at rest.
    fn begin(&mut self, _from: &State, _step: f64) {}

    /// Evaluates the effect at `state`, and adds its forces to [`Chain::inside`]. An effect with a
    /// [tension](Effect::has_tension) sets the axial forces of the state, unless they count as they are.
    fn force(&mut self, _chain: &mut Chain, _state: &mut State, _under: &Under<'_>) {}

    /// Adds the derivative of those of these forces that begin and end from station to station, with the factors of the iteration
    /// `at`, before all others.
    fn at_stations<S: Precision>(&self, _to: &mut Additions<S>, _chain: &Chain, _at: &Iteration<'_>) {}

    /// Adds the derivative of the other ones by the motion at `state`.
    fn tangent<S: Precision>(&self, _to: &mut Additions<S>, _chain: &Chain, _state: &State, _at: &Iteration<'_>) {}

    /// Adds its forces at nodes to the `residual`, on nodes whose first unknown is `wanted`.
    fn at_nodes(&self, _residual: &mut [f64], _state: &State, _under: &Under<'_>, _wanted: &impl Fn(usize) -> bool) {}

    /// Adds what it does to nodes as the last [`Effect::force`] found it to the `residual`, on unknowns that are `wanted`.
    fn applied(&self, _residual: &mut [f64], _wanted: &impl Fn(usize) -> bool) {}

    /// Hands the derivative of its forces at the ends of the tool to `add`: unknown of the force, unknown of the motion, value. Each
    /// acts within a node. The tangents inside spans are added to these.
    fn at_ends(&self, _factors: TangentFactors, _add: &mut impl FnMut(usize, usize, f64)) {}

    /// Adds to `point` what it stores, takes and moves in the whole tool. Gives the energy that it stores (J), the kinetic one
    /// left out, which it adds to `point`.
    fn energy(&self, _chain: &Chain, _point: &mut LedgerPoint, _state: &State, _under: &Under<'_>) -> f64 {
        0.0
    }

    /// Adds to `point` its dry friction, and what else of it begins and ends from station to station: the power of its damping,
    /// what friction holds, and the power of the advance against it. Gives the energy that its springs store there (J).
    fn friction(&self, _chain: &Chain, _point: &mut LedgerPoint, _under: &Under<'_>) -> f64 {
        0.0
    }

    /// Adds how the spans deflect between their ends by its forces inside them.
    fn deflect(&self, _chain: &Chain, _to: &mut [Deflection]) {}

    /// Leaves in `to` what it keeps in the state at the end of a step, where the last residual was evaluated.
    fn leave(&self, _to: &mut State) {}

    /// Takes the step that ends at `state`, where the last residual was evaluated.
    fn accept(&mut self, _state: &State) {}

    /// Adds to `point`, which has all else, what it stores and moves at an end of the tool, of a step once it is
    /// [accepted](Effect::accept).
    fn close(&self, _point: &mut LedgerPoint) {}

    /// Keeps its history for [`Effect::retreat`].
    fn keep(&mut self) {}

    /// Goes back to the history kept last.
    fn retreat(&mut self) {}

    /// Takes so many whole `turns` off the angles that it keeps of the pipe.
    fn unwind(&mut self, _turns: f64) {}

    /// Writes what its figures and its works read of it at the end of a step to `carried`.
    fn carry(&self, _carried: &mut Carried) {}

    /// Enters its works over a step into its rows of the `ledger`, beyond those of its forces in damping and inertia.
    fn work(&self, _chain: &Chain, _step: &StepWork<'_>, _ledger: &mut Energies) {}

    /// Whether it has forces in [`LedgerPoint::drag`].
    fn drags(&self) -> bool {
        false
    }

    /// Whether the axial forces of the pipe's spans come from the energy of this effect. Its tangent then has their geometric
    /// stiffness, and the energy of the spans has none.
    fn has_tension(&self) -> bool {
        false
    }

    /// Factor of the geometric forces of the pipe in span `l` beyond the axial force of the state (N).
    fn tension_beyond(&self, _l: usize) -> f64 {
        0.0
    }

    /// Force on the guide by the motion of the pipe at a station inside a span of a guide that is held, along y and z there (N).
    fn on_guide(&self, _chain: &Chain, _station: usize, _state: &State, _under: &Under<'_>) -> [f64; 2] {
        [0.0; 2]
    }

    /// What it adds to the bending moment of the guide's element `e` (N m), with the mean `spin` of its nodes (rad) and the
    /// differences of their tilts `bent` (rad).
    fn guide_moment(&self, _e: usize, _spin: f64, _bent: [f64; 2]) -> f64 {
        0.0
    }

    /// Whether it bends the guide at rest, without a load: what is rated for a guide so bent then counts.
    fn bends_guide(&self) -> bool {
        false
    }

    /// Its weight, along the world axes (N).
    fn weight(&self) -> Vector3<f64> {
        Vector3::zeros()
    }

    /// What touches `body` at a station; `None` where nothing does.
    fn touched(&self, _body: Body, _station: usize) -> Option<Touched> {
        None
    }

    /// Hands all that touches `body`, with its station, to `visit`: from the top down where the whole tool was evaluated.
    fn each_touched(&self, _body: Body, _visit: &mut impl FnMut(usize, &Touched)) {}

    /// What it does to the tool's lower end; `None` where it acts elsewhere.
    fn end_load(&self) -> Option<EndLoad> {
        None
    }

    /// What it does to the tool's top at `state`; `None` where it acts elsewhere.
    fn load_above(&self, _state: &State) -> Option<FromAbove> {
        None
    }

    /// What the pins of a joint carry of it beyond the force between both links' ends (N, tension positive).
    fn on_pins(&self, _joint: usize, _carried: &Carried) -> f64 {
        0.0
    }

    /// Force by which it pulls the guide down the hole and pushes the pipe up (N): the supports of both give it back at the top.
    fn pulls_guide(&self, _carried: &Carried) -> f64 {
        0.0
    }

    /// Whether it pushes the pipe together at the end of the last step; `None` where it never does.
    fn pushes_pipe(&self, _carried: &Carried) -> Option<bool> {
        None
    }
}
