//! Quantities derived from a configuration.

use super::guide::MadePiece;
use super::{Config, Section};
use std::f64::consts::PI;

use flexdrill_core::tool::{JointKind, SectionProperties};
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

/// A piece of the guide that reaches into a section of the well by less (m) does not lie in it: lengths in files are rounded.
const TOUCHES: f64 = 1e-3;

/// Size of the system, held directions included.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unknowns {
    /// Nodes of the flexible pipe: two at a joint.
    pub pipe_nodes: usize,
    /// Nodes of the guide pipe: one per station.
    pub guide_nodes: usize,
    /// Multipliers of the joints.
    pub joint_rows: usize,
}

impl Unknowns {
    /// Six per node and one per joint row.
    pub fn total(&self) -> usize {
        6 * (self.pipe_nodes + self.guide_nodes) + self.joint_rows
    }
}

impl Config {
    /// Size of the system.
    pub fn unknowns(&self) -> Unknowns {
        let (links, elements) = (self.tool.links, self.tool.elements_per_link);
        let rows_per_joint = match self.tool.joint.kind {
            JointKind::Universal | JointKind::BallCage => 4,
            JointKind::Revolute => 5,
        };
        Unknowns {
            pipe_nodes: links * (elements + 1),
            guide_nodes: links * elements + 1,
            joint_rows: rows_per_joint * (links - 1),
        }
    }

    /// Length of a link along the path (m).
    pub fn link_length(&self) -> f64 {
        self.well.length() / self.tool.links as f64
    }

    /// Largest build angle that one joint must take (deg); 0 in a straight well.
    pub fn build_angle_per_link_deg(&self) -> f64 {
        rad_to_deg(self.link_length() / self.well.smallest_radius())
    }

    /// Largest sagitta of a link's chord (m): L^2 / 8R.
    pub fn chord_sagitta(&self) -> f64 {
        self.link_length().powi(2) / (8.0 * self.well.smallest_radius())
    }

    /// Smallest clearance between pipe and guide (m), without the chord's sagitta.
    pub fn inner_clearance(&self) -> f64 {
        let contact = self.tool.pipe.contact_diameters(self.tool.elements_per_link);
        (self.tool.guide.inner_diameter - contact.into_iter().fold(0.0, f64::max)) / 2.0
    }

    /// Duration of the contact (s) when the lightest single node of the pipe strikes the guide: half a period of its
    /// mass on the contact's spring.
    pub fn contact_duration(&self) -> f64 {
        let elements = self.tool.elements_per_link;
        let length = self.link_length() / elements as f64;
        let material = self.tool.material.describe();
        let sections = self.tool.pipe.element_sections(elements);
        let masses = sections
            .into_iter()
            .map(|tube| SectionProperties::of(tube, material, 1.0).mass * length);
        let lightest = masses.fold(f64::INFINITY, f64::min);
        PI * (lightest / self.contact.inner.stiffness).sqrt()
    }

    /// Changes of curvature (1/m) by which sections of the well bend the guide as made: each piece in the sections that it
    /// lies in, or, with `has_passed`, in those that it has been in on its way from the kick-off, and in the straight hole
    /// above that.
    fn guide_bends(&self, has_passed: bool) -> Vec<f64> {
        let guide = &self.tool.guide;
        let phase = deg_to_rad(guide.free_curvature_phase_deg);
        let (sin, cos) = (phase.sin(), phase.cos());
        let bit = self.well.length();
        let mut bends = Vec::new();
        for MadePiece { above_bit, curvature } in guide.made() {
            let mut bent = |path: f64| bends.push((path - curvature * cos).hypot(curvature * sin));
            if has_passed {
                bent(0.0);
            }
            let [lower, upper] = above_bit.map(|distance| bit - distance);
            let mut begin = 0.0;
            for section in &self.well.sections {
                let end = begin + section.length();
                if begin + TOUCHES < lower && (has_passed || end - TOUCHES > upper) {
                    section.curvature_range().into_iter().for_each(&mut bent);
                }
                begin = end;
            }
        }
        bends
    }

    /// Strain of the guide's outermost bent fibre where it is bent most on its way through the hole, which is straight above
    /// the tool: each piece of the guide as made against the sections that it has been in and against a straight hole. A guide
    /// without stress in the path was made with the curvature of its tightest section. What slots take until they close
    /// strains nothing.
    pub fn guide_bending_strain(&self) -> f64 {
        let guide = &self.tool.guide;
        let mut bends = self.guide_bends(true);
        if bends.is_empty() {
            let sections = self.well.sections.iter().flat_map(Section::curvature_range);
            let tightest = sections.clone().fold(0.0, f64::max);
            bends.extend(sections.chain([0.0]).map(|path| (path - tightest).abs()));
        }
        let most = bends.into_iter().fold(0.0, f64::max);
        let taken_by_slots = guide.slots_close_at().unwrap_or(0.0);
        guide.outer_fibre() * (most - taken_by_slots).max(0.0)
    }

    /// Bending moment of the guide that lies in the path (N m), where it is bent most; 0 where it is without stress.
    pub fn guide_preload_moment(&self) -> f64 {
        let (guide, material) = (&self.tool.guide, self.tool.material.describe());
        let bending = |factor: f64| SectionProperties::of(guide.section(), material, factor).bending;
        let bend = self.guide_bends(false).into_iter().fold(0.0, f64::max);
        let open = bending(guide.bending_factor);
        let beyond = guide
            .slots_close_at()
            .map_or(0.0, |close_at| (bend - close_at).max(0.0));
        open * bend + (bending(1.0) - open) * beyond
    }

    /// Clearance between guide and wall (m).
    pub fn outer_clearance(&self) -> f64 {
        (self.well.hole_diameter - self.tool.guide.outer_diameter) / 2.0
    }
}
