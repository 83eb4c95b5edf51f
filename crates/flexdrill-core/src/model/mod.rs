//! The tool after the build: geometry, elements, joints and numbering. Constant while it runs.
//!
//! Numbering: each [`Station`] carries a pipe node and a guide node; at a joint station the pipe has two nodes, the end of the
//! link above and the start of the link below. Pipe nodes are in their link's frame, guide nodes in the station's frame.

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::elements::beam::{Beam, ElementMatrix, ElementVector};
use crate::elements::element_form::{ElementForms, Elements};
use crate::elements::joint::Joint;
use crate::linear::Layout;
use crate::tool::description::{Body, Direction, Location, PointLoad, ToolDescription, WobPath};
use crate::tool::section::SectionProperties;
use crate::tool::well::{WellPath, frame_along, tangent};
use crate::validation::ValidationError;

/// An arc-length position that carries a pipe node and a guide node.
#[derive(Debug, Clone)]
pub struct Station {
    /// Measured depth (m).
    pub depth: f64,
    /// Inclination (rad).
    pub inclination: f64,
    /// Point on the bore's axis (m, world).
    pub position: Vector3<f64>,
    /// Station frame, columns x (down the hole), y, z (low side) in the world.
    pub frame: Matrix3<f64>,
    /// Pipe displacement in its (upper) link's frame to the station's frame.
    pub pipe_to_station: Matrix3<f64>,
    /// Where the undeflected pipe lies in the station's frame (y, z), m: the link's chord against the arc.
    pub offset: Vector2<f64>,
    /// Clearance of the inner layer, Eq. 27 (m).
    pub inner_clearance: f64,
    /// Radius of the pipe's outer surface (m).
    pub pipe_radius: f64,
    /// Number of the joint here, if any.
    pub joint: Option<usize>,
    /// First unknown of the pipe node at the end of the element above (at the top, of the only node).
    pub pipe_above: usize,
    /// First unknown of the pipe node at the start of the element below.
    pub pipe_below: usize,
    /// First unknown of the guide node.
    pub guide: usize,
}

/// A pipe element, in its link's frame.
#[derive(Debug, Clone)]
pub struct PipeElement {
    /// Beam.
    pub beam: Beam,
    /// G.
    pub geometric: ElementMatrix,
    /// Consistent forces of gravity (N).
    pub weight: ElementVector,
}

/// A guide element, between station frames.
#[derive(Debug, Clone)]
pub struct GuideElement {
    /// Beam in its chord's frame.
    pub beam: Beam,
    /// Node frames to the chord frame, Eq. 8.
    pub rotation: [Matrix3<f64>; 2],
    /// Consistent forces of gravity on the nodes, in their frames (N).
    pub weight: ElementVector,
    /// Gamma^T K Gamma, Eq. 9.
    pub stiffness: ElementMatrix,
    /// Gamma^T M Gamma.
    pub mass: ElementMatrix,
    /// Gamma^T G Gamma.
    pub geometric: ElementMatrix,
}

/// A load with its unknown resolved.
#[derive(Debug, Clone)]
pub struct ResolvedLoad {
    /// Unknown it acts on.
    pub unknown: usize,
    /// As described.
    pub load: PointLoad,
}

/// A point mass with its unknown resolved; it acts on the three translations.
#[derive(Debug, Clone)]
pub struct ResolvedMass {
    /// Unknown of the node's u.
    pub unknown: usize,
    /// kg.
    pub mass: f64,
    /// Gravity in the node's frame (m/s2).
    pub gravity: Vector3<f64>,
}

/// Everything that does not change.
#[derive(Debug, Clone)]
pub struct Model {
    /// Stations, top to bottom.
    pub stations: Vec<Station>,
    /// Joints, top to bottom; joint h is at station (h + 1) elements_per_link.
    pub joints: Vec<Joint>,
    /// Station of each joint.
    pub joint_stations: Vec<usize>,
    /// Element e between stations e and e + 1.
    pub pipe: Vec<PipeElement>,
    /// Element e between stations e and e + 1.
    pub guide: Vec<GuideElement>,
    /// The same elements, pipe then guide, as the residual needs them.
    pub elements: Elements,
    /// Consistent forces of gravity on both pipes, per unknown (N, N m).
    pub weight: Vec<f64>,
    /// Unknowns held at zero.
    pub held: Vec<usize>,
    /// Spin of the top pipe node, if driven.
    pub driven: Option<usize>,
    /// Padding unknowns without an equation of their own.
    pub padding: Vec<usize>,
    /// Point loads.
    pub loads: Vec<ResolvedLoad>,
    /// Point masses.
    pub masses: Vec<ResolvedMass>,
    /// Clearance of the outer layer, Eq. 31 (m).
    pub outer_clearance: f64,
    /// Inner and outer radius of the guide (m).
    pub guide_radii: [f64; 2],
    /// Whether the two pipes' ends are tied axially.
    pub tied: bool,
    /// Multiplier of the tie, in the last station's block.
    pub tie: Option<usize>,
    /// Numbering of the linear system.
    pub layout: Layout,
    /// Force per unit of a scaled multiplier (lambda of Eq. 18): translational rows (N).
    pub force_scale: f64,
    /// The same for rotational rows (N m).
    pub moment_scale: f64,
    /// As described.
    pub description: ToolDescription,
}

impl Model {
    /// Builds the tool.
    ///
    /// # Errors
    /// See [`ToolDescription::validate`].
    pub fn new(description: &ToolDescription) -> Result<Self, ValidationError> {
        description.validate()?;
        let d = description;
        let path = WellPath::new(&d.well);
        let per_link = d.elements_per_link;
        let last = d.links * per_link;
        let spacing = path.length() / last as f64;
        let depth = |station: usize| spacing * station as f64;

        let tied = d.wob_path == WobPath::Shared;
        let is_joint = |station: usize| station > 0 && station < last && station.is_multiple_of(per_link);
        let layout = Layout::new((0..=last).map(|s| is_joint(s) || (s == last && tied)).collect());

        let link_ends: Vec<_> = (0..=d.links).map(|k| path.position(depth(k * per_link))).collect();
        let link_frames: Vec<_> = link_ends
            .windows(2)
            .map(|ends| frame_along((ends[1] - ends[0]).normalize()))
            .collect();

        let mut stations = Vec::with_capacity(last + 1);
        for s in 0..=last {
            let link = if s == 0 { 0 } else { (s - 1) / per_link };
            let within = s - link * per_link;
            let fraction = within as f64 / per_link as f64;
            let on_chord = link_ends[link].lerp(&link_ends[link + 1], fraction);
            let inclination = path.inclination(depth(s));
            let frame = frame_along(tangent(inclination));
            let position = path.position(depth(s));
            let away = frame.transpose() * (on_chord - position);
            let contact = d.pipe_contact_diameters[within];
            let first = layout.offset(s);
            stations.push(Station {
                depth: depth(s),
                inclination,
                position,
                frame,
                pipe_to_station: frame.transpose() * link_frames[link],
                offset: Vector2::new(away.y, away.z),
                inner_clearance: 0.5 * (d.guide_section.inner_diameter - contact),
                pipe_radius: 0.5 * contact,
                joint: is_joint(s).then(|| s / per_link - 1),
                pipe_above: first,
                pipe_below: if is_joint(s) { first + 12 } else { first },
                guide: first + 6,
            });
        }

        let mut pipe = Vec::with_capacity(last);
        let mut guide = Vec::with_capacity(last);
        let down = Vector3::z() * d.gravity;
        let guide_properties = SectionProperties::of(d.guide_section, d.material, d.guide_bending_factor);
        for e in 0..last {
            let link = e / per_link;
            let chord = (link_ends[link + 1] - link_ends[link]).norm();
            let section = SectionProperties::of(d.pipe_sections[e % per_link], d.material, 1.0);
            let beam = Beam {
                section,
                length: chord / per_link as f64,
            };
            let weight = beam.weight((link_frames[link].transpose() * down).into());
            let geometric = beam.geometric();
            pipe.push(PipeElement {
                beam,
                geometric,
                weight,
            });

            let (above, below) = (&stations[e], &stations[e + 1]);
            let span = below.position - above.position;
            let beam = Beam {
                section: guide_properties,
                length: span.norm(),
            };
            let frame = frame_along(span.normalize());
            guide.push(GuideElement::new(beam, frame, [above.frame, below.frame], down));
        }

        let joint_stations: Vec<usize> = (1..d.links).map(|k| k * per_link).collect();
        let joints = (1..d.links)
            .map(|k| Joint::new(&d.joint, k - 1, link_frames[k - 1], link_frames[k]))
            .collect::<Vec<_>>();

        let mut padding = Vec::new();
        let rows = 3 + Joint::rotational_rows(d.joint.kind);
        for &s in &joint_stations {
            padding.extend(layout.offset(s) + 18 + rows..layout.offset(s) + 24);
        }
        let mut tie = None;
        if tied {
            let first = layout.offset(last);
            tie = Some(first + 18);
            padding.extend((first + 12..first + 24).filter(|&u| u != first + 18));
        }

        let stiffest = pipe
            .iter()
            .map(|e| e.beam.section.axial / e.beam.length)
            .fold(0.0, f64::max);
        let bending = pipe
            .iter()
            .map(|e| e.beam.section.bending / e.beam.length)
            .fold(0.0, f64::max);
        let mut model = Self {
            joints,
            joint_stations,
            elements: Elements::default(),
            weight: vec![0.0; layout.unknowns()],
            pipe,
            guide,
            held: Vec::new(),
            driven: d.drive_top.then(|| stations[0].pipe_above + Direction::Psi as usize),
            padding,
            loads: Vec::new(),
            masses: Vec::new(),
            outer_clearance: 0.5 * (d.hole_diameter - d.guide_section.outer_diameter),
            guide_radii: [
                0.5 * d.guide_section.inner_diameter,
                0.5 * d.guide_section.outer_diameter,
            ],
            tied,
            tie,
            layout,
            force_scale: stiffest,
            moment_scale: bending,
            stations,
            description: description.clone(),
        };
        model.collect_elements();
        model.attach(description)?;
        Ok(model)
    }

    fn collect_elements(&mut self) {
        let mut add = |beam: &Beam, turn: Option<&[Matrix3<f64>; 2]>, weight: &ElementVector, nodes: [usize; 2]| {
            self.elements.push(ElementForms::of(beam, turn), nodes);
            for (k, w) in weight.iter().enumerate() {
                self.weight[nodes[k / 6] + k % 6] += w;
            }
        };
        for (ends, element) in self.stations.windows(2).zip(&self.pipe) {
            let nodes = [ends[0].pipe_below, ends[1].pipe_above];
            add(&element.beam, None, &element.weight, nodes);
        }
        for (ends, element) in self.stations.windows(2).zip(&self.guide) {
            let nodes = [ends[0].guide, ends[1].guide];
            add(&element.beam, Some(&element.rotation), &element.weight, nodes);
        }
    }

    fn attach(&mut self, d: &ToolDescription) -> Result<(), ValidationError> {
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
                    mass: mass.mass,
                    gravity,
                });
            }
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

    /// Number of unknowns, padding included.
    pub fn unknowns(&self) -> usize {
        self.layout.unknowns()
    }

    /// Number of equations that mean something: nodes' directions and constraint rows.
    pub fn degrees_of_freedom(&self) -> usize {
        self.unknowns() - self.padding.len()
    }

    /// First multiplier (Eq. 18) of joint `joint`, and first of its rows among those of all joints, Eq. 14: three
    /// translational ones (world axes), then the rotational ones.
    pub fn multipliers(&self, joint: usize) -> usize {
        self.layout.offset(self.joint_stations[joint]) + 18
    }

    /// Last station.
    pub fn last(&self) -> usize {
        self.stations.len() - 1
    }

    /// Total mass of both pipes without point masses (kg).
    pub fn mass(&self) -> f64 {
        let of = |beam: &Beam| beam.section.mass * beam.length;
        self.pipe.iter().map(|e| of(&e.beam)).sum::<f64>() + self.guide.iter().map(|e| of(&e.beam)).sum::<f64>()
    }
}

impl GuideElement {
    /// Turns the beam's matrices into its nodes' frames, Eq. 9.
    fn new(beam: Beam, frame: Matrix3<f64>, nodes: [Matrix3<f64>; 2], down: Vector3<f64>) -> Self {
        let rotation = nodes.map(|node| frame.transpose() * node);
        let mut gamma = ElementMatrix::zeros();
        for (n, r) in rotation.iter().enumerate() {
            gamma.fixed_view_mut::<3, 3>(6 * n, 6 * n).copy_from(r);
            gamma.fixed_view_mut::<3, 3>(6 * n + 3, 6 * n + 3).copy_from(r);
        }
        let turned = |m: ElementMatrix| gamma.transpose() * m * gamma;
        Self {
            rotation,
            weight: gamma.transpose() * beam.weight((frame.transpose() * down).into()),
            stiffness: turned(beam.stiffness()),
            mass: turned(beam.mass()),
            geometric: turned(beam.geometric()),
            beam,
        }
    }
}
