//! What can be read off a simulation at any time, by name. For the hot path fill a [`Snapshot`] instead: the functions here that give
//! lists allocate them.

use super::simulation::Simulation;
use super::snapshot::{Bit, Contacts, Joints, Snapshot, SolverCounters};
use crate::dynamics::outcome::EnergyAudit;
use crate::tool::description::{Body, Direction};

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

    /// Clearance at a station (m): of the pipe in the guide, Eq. 27, or of the guide in the hole, Eq. 31. `None` outside the tool.
    pub fn clearance(&self, station: usize, body: Body) -> Option<f64> {
        let model = self.stepper().model();
        let at = model.stations.get(station)?;
        Some(match body {
            Body::Pipe => at.inner_clearance,
            Body::Guide => model.outer_clearance,
        })
    }

    /// Displacement of a node (m or rad) in its own frame: that of its link for the pipe (at a joint: of the link above), that of the
    /// station for the guide. `None` outside the tool.
    pub fn displacement(&self, station: usize, body: Body, direction: Direction) -> Option<f64> {
        Some(self.stepper().state().q[self.unknown(station, body, direction)?])
    }

    /// Velocity of a node (m/s or rad/s), as [`Simulation::displacement`].
    pub fn velocity(&self, station: usize, body: Body, direction: Direction) -> Option<f64> {
        Some(self.stepper().state().v[self.unknown(station, body, direction)?])
    }

    /// Acceleration of a node (m/s2 or rad/s2), as [`Simulation::displacement`].
    pub fn acceleration(&self, station: usize, body: Body, direction: Direction) -> Option<f64> {
        Some(self.stepper().state().a[self.unknown(station, body, direction)?])
    }

    /// Angles, stops and forces of every joint now.
    pub fn joints(&self) -> Joints {
        self.new_snapshot().joints
    }

    /// Gaps and forces of both contact layers now, peaks and root mean squares since the last snapshot that ended an interval.
    pub fn contacts(&self) -> Contacts {
        self.new_snapshot().contacts
    }

    /// Speed, torque and accelerations of the bit now.
    pub fn bit(&self) -> Bit {
        self.new_snapshot().bit
    }

    /// Work and energy since the start.
    pub fn energy(&self) -> &EnergyAudit {
        self.stepper().audit()
    }

    /// What the solver has done since the start.
    pub fn solver_counters(&self) -> SolverCounters {
        let Snapshot { solver, .. } = self.new_snapshot();
        solver
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
