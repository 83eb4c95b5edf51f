//! Values of a simulation by name. Single values allocate nothing; [`Simulation::joints`], [`Simulation::contacts`] and
//! [`Simulation::bit`] allocate a snapshot, so a caller in real time fills a [`Snapshot`] instead.
//!
//! Stations count from 0 at the top. The result is `None` for a station that is not on the tool.
//!
//! [`Snapshot`]: super::Snapshot

use nalgebra::Vector3;

use super::quality::ModelQuality;
use super::simulation::Simulation;
use super::snapshot::{Applied, Bit, Contacts, Joints, SolverCounters};
use crate::chain::{Effect, Touched};
use crate::dynamics::Energies;
use crate::dynamics::state::State;
use crate::model::Station;
use crate::tool::{Body, Direction};

/// Position and clearances of a station; constant while the tool moves.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StationGeometry {
    /// Along the path from the kick-off (m).
    pub measured_depth: f64,
    /// Inclination of the bore (rad), 0 is straight down.
    pub inclination: f64,
    /// Point on the bore's axis (m, world).
    pub position: [f64; 3],
    /// The station frame's z in the world, unit.
    pub low_side: [f64; 3],
    /// Lateral position of the undeflected pipe, y and z (m): the distance of the link's chord from the arc.
    pub offset: [f64; 2],
    /// Number of the joint at this station, from the top.
    pub joint: Option<usize>,
    /// Clearance of the pipe in the guide, Eq. 27, and of the guide in the hole, Eq. 31 (m).
    pub clearance: [f64; 2],
    /// Outer diameter of the pipe where it meets the guide, and of the guide (m).
    pub diameter: [f64; 2],
}

impl Simulation {
    /// Last station; the first is 0. Link `k` begins at station `k` times [`elements_per_link`].
    ///
    /// [`elements_per_link`]: crate::tool::ToolDescription::elements_per_link
    pub fn last_station(&self) -> usize {
        self.stepper().model().last()
    }

    /// Station of each joint, top to bottom.
    pub fn joint_stations(&self) -> &[usize] {
        &self.stepper().model().joint_stations
    }

    /// Number of unknowns that are neither held nor padding: directions of nodes and rows of joints.
    pub fn degrees_of_freedom(&self) -> usize {
        self.stepper().model().degrees_of_freedom()
    }

    /// Mass of both pipes (kg), without added point masses.
    pub fn mass(&self) -> f64 {
        self.stepper().model().mass()
    }

    /// Every station, top to bottom.
    pub fn stations(&self) -> impl ExactSizeIterator<Item = StationGeometry> {
        let model = self.stepper().model();
        model.stations.iter().map(|at| StationGeometry {
            measured_depth: at.depth,
            inclination: at.inclination,
            position: at.position.into(),
            low_side: at.frame.column(2).into_owned().into(),
            offset: at.offset.into(),
            joint: at.joint,
            clearance: [at.inner_clearance, model.outer_clearance],
            diameter: [2.0 * at.pipe_radius, 2.0 * model.guide_radii[1]],
        })
    }

    /// Clearance at a station (m): of the pipe in the guide, Eq. 27, or of the guide in the hole, Eq. 31.
    pub fn clearance(&self, station: usize, body: Body) -> Option<f64> {
        let model = self.stepper().model();
        let at = model.stations.get(station)?;
        Some(match body {
            Body::Pipe => at.inner_clearance,
            Body::Guide => model.outer_clearance,
        })
    }

    /// Bend angle of the undeflected tool at a joint, from the top (rad).
    pub fn bend_as_built(&self, joint: usize) -> Option<f64> {
        let joint = self.stepper().model().joints.get(joint)?;
        Some((joint.upper.column(0).dot(&joint.lower.column(0))).acos())
    }

    /// Normal force now (N): of the guide on the pipe, or of the wall on the guide; 0 without contact.
    pub fn normal_force(&self, station: usize, body: Body) -> Option<f64> {
        Some(self.touch(station, body)?.map_or(0.0, |touch| touch.normal))
    }

    /// Whether a gap is closed now: pipe on guide, or guide on wall. Its force can be 0 then, as the bodies part.
    pub fn in_contact(&self, station: usize, body: Body) -> Option<bool> {
        Some(self.touch(station, body)?.is_some())
    }

    /// Power that friction takes now (W, >= 0): of the pipe on the guide, or of the guide on the wall; 0 without
    /// contact.
    pub fn friction_power(&self, station: usize, body: Body) -> Option<f64> {
        Some(self.touch(station, body)?.map_or(0.0, |touch| touch.friction_power))
    }

    /// Axial friction now (N, down the hole): of the guide on the pipe, or of the wall on the guide; 0 without contact.
    pub fn axial_friction(&self, station: usize, body: Body) -> Option<f64> {
        Some(self.touch(station, body)?.map_or(0.0, |touch| touch.axial))
    }

    /// Load on the hook (N): the weight in mud of the string above and of all that hangs on its end, less what is slacked
    /// off; `None` without a string.
    pub fn hook_load(&self) -> Option<f64> {
        self.stepper().hook_load()
    }

    /// Rate at which the hoist lets the tool advance (m/s); `None` without a hoist.
    pub fn advance_rate(&self) -> Option<f64> {
        self.stepper().carrier().map(|carrier| carrier.advance)
    }

    /// Torque (N m) and axial force (N, against advance) of the wall's friction on the string above; `None` without a
    /// string.
    pub fn string_drag(&self) -> Option<[f64; 2]> {
        self.stepper().load_above().map(|above| above.drag)
    }

    /// Speed of the top drive (rad/s), and whether its torque is at its limit; `None` without a string.
    pub fn top_drive(&self) -> Option<(f64, bool)> {
        let above = self.stepper().load_above()?;
        Some((above.drive_speed, above.drive_at_limit))
    }

    /// Axial force of the guide's support at the top (N), positive where it pushes down the hole: the weight at the
    /// kick-off. `None` where the guide is not held there.
    pub fn weight_at_kickoff(&self) -> Option<f64> {
        self.stepper().weight_at_kickoff()
    }

    fn touch(&self, station: usize, body: Body) -> Option<Option<Touched>> {
        let stepper = self.stepper();
        (station < stepper.model().stations.len()).then(|| stepper.effects().touched(body, station))
    }

    /// Distance of a pipe's axis from the bore's, horizontally and towards the low side (m).
    pub fn lateral(&self, station: usize, body: Body) -> Option<[f64; 2]> {
        let at = self.stepper().model().stations.get(station)?;
        let moved = self.in_bore(at, body, |state| &state.q);
        Some(match body {
            Body::Pipe => [moved.y + at.offset.x, moved.z + at.offset.y],
            Body::Guide => [moved.y, moved.z],
        })
    }

    /// Acceleration of a node in the station's frame: down the hole, horizontally, towards the low side (m/s2).
    pub fn acceleration_in_bore(&self, station: usize, body: Body) -> Option<[f64; 3]> {
        let at = self.stepper().model().stations.get(station)?;
        Some(self.in_bore(at, body, |state| &state.a).into())
    }

    /// Displacement of a node (m or rad) in its own frame: that of its link for the pipe (at a joint: of the link
    /// above), that of the station for the guide.
    pub fn displacement(&self, station: usize, body: Body, direction: Direction) -> Option<f64> {
        let unknown = self.unknown(station, body, direction)?;
        Some(self.stepper().value(|state| &state.q, unknown))
    }

    /// Velocity of a node (m/s or rad/s), as [`Simulation::displacement`].
    pub fn velocity(&self, station: usize, body: Body, direction: Direction) -> Option<f64> {
        let unknown = self.unknown(station, body, direction)?;
        Some(self.stepper().value(|state| &state.v, unknown))
    }

    /// Acceleration of a node (m/s2 or rad/s2), as [`Simulation::displacement`].
    pub fn acceleration(&self, station: usize, body: Body, direction: Direction) -> Option<f64> {
        let unknown = self.unknown(station, body, direction)?;
        Some(self.stepper().value(|state| &state.a, unknown))
    }

    /// Angles, stops and forces of every joint now.
    pub fn joints(&self) -> Joints {
        self.new_snapshot().joints
    }

    /// Gaps and forces of both contact layers now, peaks and root mean squares since the last snapshot that ended an
    /// interval.
    pub fn contacts(&self) -> Contacts {
        self.new_snapshot().contacts
    }

    /// Speed, torque and accelerations of the bit now.
    pub fn bit(&self) -> Bit {
        self.new_snapshot().bit
    }

    /// Work and energy since the start.
    pub fn energy(&self) -> &Energies {
        self.stepper().audit()
    }

    /// Power that the pins of each joint take now (W), top to bottom; empty without friction in the joints.
    pub fn joint_friction(&self) -> &[f64] {
        self.stepper().joint_friction()
    }

    /// Torque at the tool's top that the pins of all joints take now (N m): their power over the first link's own speed,
    /// negative in reverse; NaN where it does not turn, below a tenth of the speed asked for.
    pub fn joint_friction_torque(&self) -> f64 {
        self.stepper().joint_friction_torque()
    }

    /// Quality of the computed motion over the last seconds.
    pub fn quality(&self) -> ModelQuality {
        self.observer.quality()
    }

    /// Drive and load as they act now, after slew limits.
    pub fn applied(&self) -> &Applied {
        &self.applied
    }

    /// Displacements, multipliers, velocities and accelerations of all unknowns, in the numbering of the model, for
    /// comparisons of states.
    pub fn state(&self) -> State {
        self.stepper().state()
    }

    /// Nodes of the chain that steps are taken over.
    pub fn chain_nodes(&self) -> usize {
        self.stepper().chain_nodes()
    }

    /// Upper bound of the Newton iterations of one [`Simulation::advance`].
    pub fn most_iterations(&self) -> u64 {
        self.stepper().most_iterations()
    }

    /// Counters of the solver since the start.
    pub fn solver_counters(&self) -> SolverCounters {
        let counters = self.stepper().counters();
        SolverCounters {
            newton_iterations: counters.iterations,
            last_iterations: self.observer.last_iterations(),
            rejected: counters.rejected,
            halved_steps: counters.halved_steps,
            deepest_halving: counters.deepest_halving,
            failed_steps: counters.failed_steps,
            last_rejection: counters.last_rejection,
        }
    }

    fn unknown(&self, station: usize, body: Body, direction: Direction) -> Option<usize> {
        let at = self.stepper().model().stations.get(station)?;
        let node = match body {
            Body::Pipe => at.pipe_above,
            Body::Guide => at.guide,
        };
        Some(node + direction as usize)
    }
}

impl Simulation {
    /// Translational entries of `of` for a node, in the station's frame.
    fn in_bore(&self, at: &Station, body: Body, of: fn(&State) -> &[f64]) -> Vector3<f64> {
        let at_node = |first: usize| Vector3::from_fn(|k, _| self.stepper().value(of, first + k));
        match body {
            Body::Pipe => at.pipe_to_station * at_node(at.pipe_above),
            Body::Guide => at_node(at.guide),
        }
    }
}
