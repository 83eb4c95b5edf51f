//! What is attached to the tool: supports, loads and masses, resolved to unknowns.

use nalgebra::Vector3;

use super::Model;
use crate::elements::point_body::PointBody;
use crate::tool::description::{Body, Location, PointLoad, ToolDescription};
use crate::validation::ValidationError;

/// A load with its unknown resolved.
#[derive(Debug, Clone)]
pub struct ResolvedLoad {
    /// Unknown it acts on.
    pub unknown: usize,
    /// The load as described, with its history.
    pub load: PointLoad,
}

/// A point mass, or the bit's inertia, with its unknown resolved.
#[derive(Debug, Clone)]
pub struct ResolvedMass {
    /// Unknown of the node's u.
    pub unknown: usize,
    /// Mass, inertias and unbalance.
    pub body: PointBody,
    /// Gravity in the node's frame (m/s2).
    pub gravity: Vector3<f64>,
}

impl Model {
    /// Resolves supports (Table 1), loads and masses.
    pub(super) fn attach(&mut self, d: &ToolDescription) -> Result<(), ValidationError> {
        for support in &d.supports {
            for node in self.nodes("supports", support.location, support.body, true)? {
                self.held
                    .extend(support.directions.iter().map(|&direction| node + direction as usize));
            }
        }
        if d.guide_fixed {
            for s in 0..self.stations.len() {
                let node = self.stations[s].guide;
                self.held.extend(node..node + 6);
            }
        }
        self.held.sort_unstable();
        self.held.dedup();
        if let Some(driven) = self.driven {
            self.held.retain(|&unknown| unknown != driven);
        }
        for load in &d.loads {
            for node in self.nodes("loads", load.location, load.body, false)? {
                self.loads.push(ResolvedLoad {
                    unknown: node + load.direction as usize,
                    load: load.clone(),
                });
            }
        }
        for mass in &d.masses {
            for unknown in self.nodes("masses", mass.location, mass.body, false)? {
                let station = &self.stations[self.layout.station_of(unknown)];
                let frame = match mass.body {
                    Body::Guide => station.frame,
                    Body::Pipe => station.frame * station.pipe_to_station,
                };
                let gravity = frame.transpose() * (Vector3::z() * d.gravity);
                self.masses.push(ResolvedMass {
                    unknown,
                    body: PointBody {
                        mass: mass.mass,
                        axial_inertia: mass.axial_inertia,
                        transverse_inertia: mass.transverse_inertia,
                        eccentricity: mass.eccentricity,
                        phase: mass.eccentricity_phase,
                    },
                    gravity,
                });
            }
        }
        if d.bit.inertia > 0.0 {
            self.masses.push(ResolvedMass {
                unknown: self.stations[self.last()].pipe_above,
                body: PointBody {
                    axial_inertia: d.bit.inertia,
                    // A disc's: the least that a body can have.
                    transverse_inertia: 0.5 * d.bit.inertia,
                    ..PointBody::default()
                },
                gravity: Vector3::zeros(),
            });
        }
        Ok(())
    }

    /// First unknowns of the nodes at a location; with `both`, both pipe nodes of a joint station.
    fn nodes(
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
