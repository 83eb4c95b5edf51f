//! The checks of a whole configuration: every section, and the keys that exclude each other.

use super::Schema;
use super::boundary::{BottomAxial, Drive, Preset};
use super::checker::{Checker, NumberKey};
use super::inputs::Measured;
use super::lines::Lines;
use super::place::Mesh;
use super::rock::Law;
use super::start::Start;
use super::string::Model;
use flexdrill_core::tool::{FrictionLaw, WeightPlace};

impl Schema {
    /// Whether the hoist lowers the tool: the rock then holds the bit.
    pub(crate) fn has_hoist(&self) -> bool {
        self.rock.law == Law::DepthOfCut
    }

    pub(crate) fn mesh(&self) -> Mesh {
        Mesh {
            links: self.tool.links,
            elements_per_link: self.tool.elements_per_link,
            length: self.well.length(),
        }
    }

    /// What a guide that has been slid in needs to keep its friction.
    fn check_slid_in(&self, c: &mut Checker) {
        let slid_in = self.start == Start::SlidIn;
        c.require(
            !slid_in || self.contact.outer.friction == FrictionLaw::Bristle,
            "start",
            "slid_in",
            "",
            "static, or contact.outer.friction: bristle",
            "only bristles hold friction at rest",
        );
        c.require(
            !slid_in || !self.tool.guide.fixed,
            "start",
            "slid_in",
            "",
            "static while tool.guide.fixed is true",
            "a guide that is held at every node has not slid",
        );
    }

    /// String, rock and the keys that exclude each other.
    fn check_string(&self, c: &mut Checker) {
        let has_line = self.string.model == Model::Line;
        // Each section is checked by itself first; what follows are pairs of keys that are valid one by one.
        c.below("rock", |c| self.rock.check(c, has_line));
        c.below("string", |c| self.string.check(c, self.solver.time_step));
        // The string drives the tool, so nothing else may.
        c.require(
            !has_line || self.boundary.drive == Drive::Top,
            "boundary.drive",
            "none",
            "",
            "top with string.model: line",
            "the string turns the first link",
        );
        // The same speed cannot be the input at both ends of the string.
        let downhole = self.inputs.rotary_speed.measured == Measured::Downhole;
        c.require(
            !has_line || !downhole,
            "string.model",
            "line",
            "",
            "measured, or inputs.rotary_speed.measured: surface",
            "a speed that is measured downhole has the swing of the string already",
        );
        c.require(
            self.string.model != Model::Measured || downhole,
            "string.model",
            "measured",
            "",
            "none or line, or inputs.rotary_speed.measured: downhole",
            "a speed at the surface is not that of the first link",
        );
        // With a hoist the rock carries the bit along the hole. Any other support in that direction would take an
        // unknown part of the weight.
        c.require(
            !self.has_hoist() || self.boundary.bottom_axial == BottomAxial::Free,
            "boundary.bottom_axial",
            "fixed",
            "",
            "free with rock.law: depth_of_cut",
            "the rock holds the bit along the hole",
        );
        c.require(
            !self.has_hoist() || self.boundary.weight_on_bit_at == WeightPlace::Bit,
            "boundary.weight_on_bit_at",
            "kickoff",
            "",
            "bit with rock.law: depth_of_cut",
            "the hoist holds the weight at the surface, and the rock gives that at the bit",
        );
        c.require(
            !self.has_hoist() || self.boundary.preset == Preset::Paper,
            "boundary.preset",
            "none",
            "",
            "paper with rock.law: depth_of_cut",
            "the hoist carries the tops of both pipes, which no support may hold",
        );
        c.require(
            !self.has_hoist() || !self.boundary.holds_a_top(&self.mesh()),
            "boundary.supports",
            "u of a pipe at the top",
            "",
            "without it with rock.law: depth_of_cut",
            "the hoist carries both pipes along the hole",
        );
        c.require(
            !self.has_hoist() || !self.tool.guide.fixed,
            "tool.guide.fixed",
            "true",
            "",
            "false with rock.law: depth_of_cut",
            "the hoist lowers the guide onto the rock",
        );
    }

    /// Every numeric key.
    pub(crate) fn numbers(&self) -> Vec<NumberKey> {
        let lines = Lines::default();
        let mut checker = Checker::new("", &lines);
        self.check(&mut checker);
        checker.numbers
    }

    pub(crate) fn check(&self, c: &mut Checker) {
        // The mesh is needed by checks of places; it is formed from numbers that may be wrong, and must only not fail.
        let mesh = self.mesh();
        c.below("run", |c| self.run.check(c));
        c.below("well", |c| self.well.check(c));
        c.below("tool", |c| self.tool.check(c));
        // The diameters belong to two sections, neither of which can check the clearance alone.
        let guide = self.tool.guide.outer_diameter;
        c.require(
            guide < self.well.hole_diameter,
            "well.hole_diameter",
            self.well.hole_diameter,
            "m",
            format!("above the guide's outer diameter, {guide} m"),
            "the guide lies in the hole",
        );
        c.below("contact", |c| self.contact.check(c));
        c.below("environment", |c| {
            // Numbers before pressure and mud, whose checks use them.
            self.environment.check_numbers(c);
            if let Some(pressure) = &self.environment.pressure {
                c.below("pressure", |c| pressure.check(c, self));
            }
            if let Some(mud) = &self.environment.mud {
                c.below("mud", |c| mud.check(c, self));
            }
        });
        c.below("boundary", |c| self.boundary.check(c, &mesh));
        // String, rock and boundary exclude each other in pairs, so they follow the sections.
        self.check_string(c);
        // In a straight hole no bending moment depends on the guide's spin: the tangent would be singular.
        let guide_may_spin = self.well.is_straight() && !self.tool.guide.fixed && !self.boundary.holds_guide_spin();
        c.require(
            !guide_may_spin,
            "boundary.supports",
            "nothing that holds the guide's psi",
            "",
            "given psi of the guide in a straight well",
            "only curvature keeps the guide from turning",
        );
        // The guide is modelled with small turns about its axis, which this bend would exceed by itself.
        let phase = self.tool.guide.free_curvature_phase_deg;
        c.require(
            phase == 0.0 || self.boundary.holds_guide_spin(),
            "tool.guide.free_curvature_phase_deg",
            phase,
            "deg",
            "0, or boundary.supports given psi of the guide",
            "a bend off the high side turns the guide until it lies along the build; the model has small turns only",
        );
        let toolface = self.tool.guide.spine_toolface_deg;
        c.require(
            self.tool.guide.thrust_bend_toolface_deg() == 0.0 || self.boundary.holds_guide_spin(),
            "tool.guide.spine_toolface_deg",
            toolface,
            "deg",
            "180, or boundary.supports given psi of the guide",
            "under thrust a spine off the low side turns the guide until it lies there; the model has small turns only",
        );
        c.below("loads", |c| {
            for (index, load) in self.loads.iter().enumerate() {
                c.below(index, |c| load.check(c, &mesh));
            }
        });
        c.below("masses", |c| {
            for (index, mass) in self.masses.iter().enumerate() {
                c.below(index, |c| mass.check(c, &mesh));
            }
        });
        c.below("initial", |c| self.initial.check(c, self.start));
        // The start that slides the tool in depends on tool, well and contact, so it is checked after them.
        self.check_slid_in(c);
        c.below("solver", |c| self.solver.check(c));
        c.below("inputs", |c| self.inputs.check(c));
        c.below("network", |c| self.network.check(c));
        c.below("whirl", |c| self.whirl.check(c, &mesh));
        c.below("stick_slip", |c| self.stick_slip.check(c));
        c.below("shock", |c| self.shock.check(c));
        c.below("joint_load", |c| self.joint_load.check(c));
        c.below("chaotic_whirl", |c| self.chaotic_whirl.check(c));
        c.below("transfer", |c| self.transfer.check(c));
        c.below("look_ahead", |c| self.look_ahead.check(c));
        c.below("calibration", |c| self.calibration.check(c));
        c.below("map", |c| self.map.check(c));
        c.below("guide_preload", |c| self.guide_preload.check(c));
        c.below("pressure_folding", |c| self.pressure_folding.check(c));
        // A rating without the quantity that it rates would be an alarm that can never stand, and be trusted.
        c.require(
            self.guide_preload.rated_moment_nm == 0.0 || self.tool.guide.free_curvature().is_some(),
            "guide_preload.rated_moment_nm",
            self.guide_preload.rated_moment_nm,
            "N m",
            "0, or tool.guide.free_curvature given",
            "a guide that was made with the curvature of the hole has no preload",
        );
        c.require(
            self.pressure_folding.rated_compression_kn == 0.0 || self.environment.pressure.is_some(),
            "pressure_folding.rated_compression_kn",
            self.pressure_folding.rated_compression_kn,
            "kN",
            "0, or environment.pressure given",
            "without pressure in the pipe none of its compression comes from it",
        );
        // Alarms and outputs come last: they refer to places and quantities of everything before.
        c.below("alarms", |c| self.alarms.check(c));
        c.below("outputs", |c| self.outputs.check(c));
        // Distributions are held against the limits of their keys, which are known once all other sections were read.
        if let Some(uncertainty) = &self.uncertainty {
            let known = c.numbers.clone();
            c.below("uncertainty", |c| uncertainty.check(c, &known));
        }
        if let Some(ensemble) = &self.ensemble {
            c.below("ensemble", |c| ensemble.check(c, self.uncertainty.is_some()));
        }
    }
}
