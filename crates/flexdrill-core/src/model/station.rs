//! Stations: their position on the bore, and the chords of the straight links in it.

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::tool::ToolDescription;
use crate::tool::{WellPath, frame_along, tangent};

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
    /// Rotation from the frame of the (upper) link, in which the pipe's displacements are, to the station's frame.
    pub pipe_to_station: Matrix3<f64>,
    /// Lateral position of the undeflected pipe in the station's frame (y, z), m: the chord's distance from the arc.
    pub offset: Vector2<f64>,
    /// Clearance of the inner layer, Eq. 27 (m).
    pub inner_clearance: f64,
    /// Radius of the pipe's outer surface (m).
    pub pipe_radius: f64,
    /// Number of the joint at this station, if any.
    pub joint: Option<usize>,
    /// First unknown of the pipe node at the end of the element above (at the top, of the only node).
    pub pipe_above: usize,
    /// First unknown of the pipe node at the start of the element below.
    pub pipe_below: usize,
    /// First unknown of the guide node.
    pub guide: usize,
}

/// The bore with the links' chords in it.
pub(super) struct Bore {
    path: WellPath,
    /// Distance between stations along the bore (m).
    pub(super) spacing: f64,
    per_link: usize,
    /// Ends of the links, on the bore's axis (m, world).
    link_ends: Vec<Vector3<f64>>,
    /// Link frames, x along the chord, columns in the world.
    pub(super) link_frames: Vec<Matrix3<f64>>,
}

impl Bore {
    pub(super) fn new(d: &ToolDescription) -> Self {
        let path = WellPath::new(&d.well);
        let per_link = d.elements_per_link;
        let spacing = path.length() / (d.links * per_link) as f64;
        let link_ends: Vec<_> = (0..=d.links)
            .map(|k| path.position(spacing * (k * per_link) as f64))
            .collect();
        let link_frames = link_ends
            .windows(2)
            .map(|ends| frame_along((ends[1] - ends[0]).normalize()))
            .collect();
        Self {
            path,
            spacing,
            per_link,
            link_ends,
            link_frames,
        }
    }

    /// Length of a link's chord (m).
    pub(super) fn chord(&self, link: usize) -> f64 {
        (self.link_ends[link + 1] - self.link_ends[link]).norm()
    }

    /// Angle by which the bore turns along a link (rad).
    pub(super) fn turn(&self, link: usize) -> f64 {
        let at = |end: usize| self.path.inclination(self.spacing * (end * self.per_link) as f64);
        at(link + 1) - at(link)
    }

    /// Station `s`, whose block of unknowns begins at `first`.
    pub(super) fn station(&self, d: &ToolDescription, s: usize, is_joint: bool, first: usize) -> Station {
        let link = if s == 0 { 0 } else { (s - 1) / self.per_link };
        let within = s - link * self.per_link;
        let fraction = within as f64 / self.per_link as f64;
        let on_chord = self.link_ends[link].lerp(&self.link_ends[link + 1], fraction);
        let depth = self.spacing * s as f64;
        let inclination = self.path.inclination(depth);
        let frame = frame_along(tangent(inclination));
        let position = self.path.position(depth);
        let away = frame.transpose() * (on_chord - position);
        let contact = d.pipe_contact_diameters[within];
        Station {
            depth,
            inclination,
            position,
            frame,
            pipe_to_station: frame.transpose() * self.link_frames[link],
            offset: Vector2::new(away.y, away.z),
            inner_clearance: 0.5 * (d.guide_section.inner_diameter - contact),
            pipe_radius: 0.5 * contact,
            joint: is_joint.then(|| s / self.per_link - 1),
            pipe_above: first,
            pipe_below: if is_joint { first + 12 } else { first },
            guide: first + 6,
        }
    }
}
