//! The tool as built: geometry, elements, joints and numbering. The model stays constant while the tool runs.
//!
//! Numbering: each [`Station`] carries a pipe node and a guide node; at a joint station the pipe has two nodes, the end
//! of the link above and the start of the link below. Pipe nodes are in their link's frame, guide nodes in the
//! station's frame.

mod attached;
mod element;
pub(crate) mod layout;
mod places;
mod station;

use nalgebra::Vector3;

use crate::elements::beam::{Beam, ElementVector};
use crate::elements::joint::Joint;
use crate::tool::{Direction, ToolDescription, WobPath};
use crate::validation::ValidationError;

pub use attached::{HeldNode, ResolvedLoad};
pub use element::{GuideElement, PipeElement};
use layout::Layout;
pub use places::{JointPlaces, Places};
pub use station::Station;

use station::Bore;

/// The constant part of a simulation: everything that follows from the description alone.
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
    /// Consistent forces of gravity on both pipes, per unknown (N, N m).
    pub weight: Vec<f64>,
    /// Unknowns held at zero, in rising order.
    pub held: Vec<usize>,
    /// The nodes of the held unknowns, in the same order.
    pub held_nodes: Vec<HeldNode>,
    /// Weight of both pipes, along the world axes (N).
    pub total_weight: Vector3<f64>,
    /// Spin of the top pipe node, if driven.
    pub driven: Option<usize>,
    /// Padding unknowns, which fill joint blocks up to their fixed size and have the equation x = 0.
    pub padding: Vec<usize>,
    /// Point loads, resolved to unknowns.
    pub loads: Vec<ResolvedLoad>,
    /// Clearance of the outer layer, Eq. 31 (m).
    pub outer_clearance: f64,
    /// Inner and outer radius of the guide (m).
    pub guide_radii: [f64; 2],
    /// Multiplier of the tie, in the last station's block.
    pub tie: Option<usize>,
    /// Stiffness of the connector by which the pipe's top hangs on the guide's, where that moves along the hole (N/m): that of one element of
    /// the pipe, which adds micrometres to what the tool itself yields.
    pub hanger: Option<f64>,
    /// The hole's axis in the pipe's frame at the first and at the last station, (u, v, w). Hanger and tie act along it: along
    /// the chord of the pipe's link, half a link's bend away, pipe and guide would not pull each other in opposite
    /// directions.
    pub ends_along: [[f64; 3]; 2],
    /// The unknowns that loads, joints, drive and bit act on.
    pub places: Places,
    /// Numbering of the linear system.
    pub layout: Layout,
    /// Force per unit of a scaled multiplier (lambda of Eq. 18): translational rows (N).
    pub force_scale: f64,
    /// The same for rotational rows (N m).
    pub moment_scale: f64,
    /// The description of the tool.
    pub description: ToolDescription,
}

impl Model {
    /// Distances of the lower and the upper end of element `e` above the bit (m).
    pub(crate) fn above_bit(&self, e: usize) -> [f64; 2] {
        let bit = self.stations.last().map_or(0.0, |station| station.depth);
        [e + 1, e].map(|station| bit - self.stations[station].depth)
    }

    /// Builds the tool.
    ///
    /// # Errors
    /// See [`ToolDescription::validate`].
    pub fn new(description: &ToolDescription) -> Result<Self, ValidationError> {
        // A description that is not valid would fail below, with an error that names no field.
        description.validate()?;
        let d = description;
        let per_link = d.elements_per_link;
        let last = d.links * per_link;

        // The tie is an additional multiplier in the last station, which then has the size of a joint's.
        let tied = d.wob_path == WobPath::Shared;
        let is_joint = |station: usize| station > 0 && station < last && station.is_multiple_of(per_link);
        let layout = Layout::new((0..=last).map(|s| is_joint(s) || (s == last && tied)));

        // The bore gives the frames of all stations; elements and joints are built in them.
        let bore = Bore::new(d);
        let stations: Vec<Station> = (0..=last)
            .map(|s| bore.station(d, s, is_joint(s), layout.offset(s)))
            .collect();
        let pipe: Vec<PipeElement> = (0..last).map(|e| PipeElement::new(d, &bore, e)).collect();
        let guide: Vec<GuideElement> = stations
            .windows(2)
            .map(|ends| GuideElement::new(d, &ends[0], &ends[1]))
            .collect();

        let joint_stations: Vec<usize> = (1..d.links).map(|k| k * per_link).collect();
        let joints = (1..d.links)
            .map(|k| Joint::new(&d.joint, k - 1, bore.link_frames[k - 1], bore.link_frames[k]))
            .collect::<Vec<_>>();

        // Rows that no joint uses keep the blocks of one size, and are held by a one.
        let mut padding = Vec::new();
        let rows = 3 + Joint::constraints(&d.joint);
        for &s in &joint_stations {
            padding.extend(layout.offset(s) + 18 + rows..layout.offset(s) + 24);
        }
        let mut tie = None;
        if tied {
            let first = layout.offset(last);
            tie = Some(first + 18);
            padding.extend((first + 12..first + 24).filter(|&u| u != first + 18));
        }

        // Multipliers are forces over these, so that their columns are as large as the stiffness columns.
        let stiffest = pipe
            .iter()
            .map(|e| e.beam.section.axial / e.beam.length)
            .fold(0.0, f64::max);
        let bending = pipe
            .iter()
            .map(|e| e.beam.section.bending / e.beam.length)
            .fold(0.0, f64::max);
        // Supports and loads refer to the finished numbering, so they are attached below.
        let mut model = Self {
            joints,
            joint_stations,
            weight: vec![0.0; layout.unknowns()],
            pipe,
            guide,
            held: Vec::new(),
            held_nodes: Vec::new(),
            total_weight: Vector3::zeros(),
            driven: d
                .prescribes_spin()
                .then(|| stations[0].pipe_above + Direction::Psi as usize),
            padding,
            loads: Vec::new(),
            outer_clearance: 0.5 * (d.hole_diameter - d.guide_section.outer_diameter),
            guide_radii: [
                0.5 * d.guide_section.inner_diameter,
                0.5 * d.guide_section.outer_diameter,
            ],
            tie,
            hanger: d.moves_at_top().then_some(stiffest),
            ends_along: [0, last].map(|s| stations[s].pipe_to_station.row(0).into_owned().into()),
            places: Places::default(),
            layout,
            force_scale: stiffest,
            moment_scale: bending,
            stations,
            description: description.clone(),
        };
        // In this order: places need the supports.
        model.add_weight();
        model.attach(description)?;
        model.total_weight = model.sum_in_world(&model.weight);
        model.places = Places::of(&model);
        Ok(model)
    }

    /// Sums up the forces of gravity on the nodes of all elements.
    fn add_weight(&mut self) {
        let mut add = |weight: &ElementVector, nodes: [usize; 2]| {
            for (k, w) in weight.iter().enumerate() {
                self.weight[nodes[k / 6] + k % 6] += w;
            }
        };
        for (ends, element) in self.stations.windows(2).zip(&self.pipe) {
            add(&element.weight, [ends[0].pipe_below, ends[1].pipe_above]);
        }
        for (ends, element) in self.stations.windows(2).zip(&self.guide) {
            add(&element.weight, [ends[0].guide, ends[1].guide]);
        }
    }

    /// Number of joints whose pins have friction.
    pub fn joints_with_friction(&self) -> usize {
        if self.description.joint.friction.coefficient > 0.0 {
            self.joints.len()
        } else {
            0
        }
    }

    /// Number of unknowns, padding included.
    pub fn unknowns(&self) -> usize {
        self.layout.unknowns()
    }

    /// Number of unknowns without padding: directions of nodes, and constraint rows.
    pub fn degrees_of_freedom(&self) -> usize {
        self.unknowns() - self.padding.len()
    }

    /// First multiplier (Eq. 18) of joint `joint`, and first of its rows among those of all joints, Eq. 14: three
    /// translational ones (world axes), then the rotational ones.
    pub fn multipliers(&self, joint: usize) -> usize {
        self.layout.offset(self.joint_stations[joint]) + 18
    }

    /// Number of the last station, at the bit.
    pub fn last(&self) -> usize {
        self.stations.len() - 1
    }

    /// Total mass of both pipes without point masses (kg).
    pub fn mass(&self) -> f64 {
        let of = |beam: &Beam| beam.section.mass * beam.length;
        self.pipe.iter().map(|e| of(&e.beam)).sum::<f64>() + self.guide.iter().map(|e| of(&e.beam)).sum::<f64>()
    }
}
