//! Supports and loads, resolved to unknowns of the model.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use super::Model;
use crate::tool::{Body, Direction, Location, PointLoad, ToolDescription};
use crate::validation::ValidationError;

/// A load with its unknown resolved.
#[derive(Debug, Clone)]
pub struct ResolvedLoad {
    /// The unknown that it acts on.
    pub unknown: usize,
    /// The described load with its history.
    pub load: PointLoad,
}

/// A node with at least one held direction.
#[derive(Debug, Clone)]
pub struct HeldNode {
    /// Station of the node.
    pub station: usize,
    /// The pipe that the node belongs to.
    pub body: Body,
    /// First unknown of the node.
    pub node: usize,
    /// The node's axes, columns in the world.
    pub frame: Matrix3<f64>,
    /// Its held unknowns, as a range of [`Model::held`].
    pub held: Range<usize>,
}

impl Model {
    /// Resolves supports (Table 1) and loads.
    pub(super) fn attach(&mut self, d: &ToolDescription) -> Result<(), ValidationError> {
        for support in &d.supports {
            for node in self.nodes("supports", support.location, support.body, true)? {
                // A joint transmits displacements and spin: holding them above the joint holds them below. The tilts
                // below are free, and are held on their own.
                let station = &self.stations[self.layout.station_of(node)];
                let below_joint = station.joint.is_some() && node == station.pipe_below;
                let directions = support
                    .directions
                    .iter()
                    .filter(|direction| !below_joint || matches!(direction, Direction::PhiY | Direction::PhiZ));
                self.held.extend(directions.map(|&direction| node + direction as usize));
            }
        }
        // A fixed guide holds all its unknowns at every station.
        if d.guide_fixed {
            for s in 0..self.stations.len() {
                let node = self.stations[s].guide;
                self.held.extend(node..node + 6);
            }
        }
        // Supports may overlap; each unknown is held once.
        self.held.sort_unstable();
        self.held.dedup();
        // The drive prescribes its spin: as a support it would be held at zero.
        if let Some(driven) = self.driven {
            self.held.retain(|&unknown| unknown != driven);
        }
        self.collect_held_nodes();
        for load in &d.loads {
            for node in self.nodes("loads", load.location, load.body, false)? {
                self.loads.push(ResolvedLoad {
                    unknown: node + load.direction as usize,
                    load: load.clone(),
                });
            }
        }
        Ok(())
    }

    /// Groups the held unknowns, which are sorted, by their nodes.
    fn collect_held_nodes(&mut self) {
        let mut nodes: Vec<HeldNode> = Vec::new();
        for (index, &unknown) in self.held.iter().enumerate() {
            match nodes.last_mut() {
                Some(last) if unknown < last.node + 6 => last.held.end = index + 1,
                _ => {
                    let (node, body, frame) = self.node_of(unknown);
                    nodes.push(HeldNode {
                        station: self.layout.station_of(unknown),
                        body,
                        node,
                        frame,
                        held: index..index + 1,
                    });
                }
            }
        }
        self.held_nodes = nodes;
    }

    /// First unknown, pipe and axes (columns in the world) of the node that an unknown belongs to.
    pub fn node_of(&self, unknown: usize) -> (usize, Body, Matrix3<f64>) {
        let station = &self.stations[self.layout.station_of(unknown)];
        let of = |node: usize| (node..node + 6).contains(&unknown);
        if of(station.guide) {
            return (station.guide, Body::Guide, station.frame);
        }
        match station.joint {
            Some(joint) if of(station.pipe_below) => (station.pipe_below, Body::Pipe, self.joints[joint].lower),
            _ => (station.pipe_above, Body::Pipe, station.frame * station.pipe_to_station),
        }
    }

    /// Sum over all nodes, in the world frame, of the translational entries of `values` (one entry per unknown).
    pub fn sum_in_world(&self, values: &[f64]) -> Vector3<f64> {
        let at = |node: usize| Vector3::new(values[node], values[node + 1], values[node + 2]);
        let mut sum = Vector3::zeros();
        for station in &self.stations {
            sum += station.frame * (at(station.guide) + station.pipe_to_station * at(station.pipe_above));
            if let Some(joint) = station.joint {
                sum += self.joints[joint].lower * at(station.pipe_below);
            }
        }
        sum
    }

    /// First unknowns of the nodes at a location; with `both`, both pipe nodes of a joint station.
    ///
    /// # Errors
    /// Where the location is not on the tool, which the checks of a description find too.
    pub(crate) fn nodes(
        &self,
        what: &'static str,
        location: Location,
        body: Body,
        both: bool,
    ) -> Result<Vec<usize>, ValidationError> {
        let last = self.stations.len() - 1;
        let range = match location {
            Location::Top => 0..1,
            Location::Bottom => last..last + 1,
            Location::Station(s) if s <= last => s..s + 1,
            Location::Joint(j) if j < self.joints.len() => self.joint_stations[j]..self.joint_stations[j] + 1,
            Location::All => 0..last + 1,
            _ => {
                return Err(ValidationError::Location {
                    field: what.to_owned(),
                    location,
                    last_station: last,
                    joints: self.joints.len(),
                });
            }
        };
        let mut nodes = Vec::new();
        for station in &self.stations[range] {
            match body {
                Body::Guide => nodes.push(station.guide),
                Body::Pipe => {
                    nodes.push(station.pipe_above);
                    if both && station.pipe_below != station.pipe_above {
                        nodes.push(station.pipe_below);
                    }
                }
            }
        }
        Ok(nodes)
    }
}
