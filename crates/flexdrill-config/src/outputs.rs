//! `outputs`: what is published how often.

use super::checker::Checker;
use super::section::section;

section! {
    /// Publishing.
    pub struct Outputs(this) {
        /// `frame_id` of every header. Default `flexible_tool`.
        frame_id: String = "flexible_tool".to_string();
        /// Frame in which `frame_id` is told to lie, on `/tf_static`: Z up, X in the build's direction, origin at the
        /// kick-off. Default `map`; empty tells nothing.
        parent_frame: String = "map".to_string();
        /// Factor on displacements in `twin/tool_shape`.
        exaggeration: f64 = 10.0, within(0.0, 1000.0), "", "1 is true to scale";
        /// Per topic.
        rates: Rates = Rates::default(), below;
    }
}

section! {
    /// Messages per second of model time (Hz). Keys are the topics' last names. 0 switches a topic off, except those by
    /// which an operator knows that the twin works. A recording keeps at least the rates with which the run began: rates
    /// that are set lower while the twin runs act on DDS only.
    #[derive(Copy)]
    pub struct Rates(this) {
        /// `twin/joint_deflections`.
        joint_deflections: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/contact_forces`.
        contact_forces: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/whirl`.
        whirl: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/bit_state`.
        bit_state: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/status`.
        status: f64 = 5.0, within(1.0, 1000.0), "Hz",
            "it shows that the twin works; more would flood the network";
        /// `twin/tool_shape`.
        tool_shape: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/ageing`.
        ageing: f64 = 1.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/reactions`.
        reactions: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `joint_states`.
        joint_states: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `/diagnostics`.
        diagnostics: f64 = 1.0, within(1.0, 1000.0), "Hz",
            "it shows that the twin works; more would flood the network";
    }
}

impl Rates {
    /// Of each topic the higher of two rates.
    #[must_use]
    pub fn at_least(&self, other: &Self) -> Self {
        Self {
            joint_deflections: self.joint_deflections.max(other.joint_deflections),
            contact_forces: self.contact_forces.max(other.contact_forces),
            whirl: self.whirl.max(other.whirl),
            bit_state: self.bit_state.max(other.bit_state),
            reactions: self.reactions.max(other.reactions),
            status: self.status.max(other.status),
            tool_shape: self.tool_shape.max(other.tool_shape),
            ageing: self.ageing.max(other.ageing),
            joint_states: self.joint_states.max(other.joint_states),
            diagnostics: self.diagnostics.max(other.diagnostics),
        }
    }
}

impl Outputs {
    pub(super) fn check(&self, c: &mut Checker) {
        c.require(
            !self.frame_id.is_empty() && !self.frame_id.contains(char::is_whitespace),
            "frame_id",
            format!("{:?}", self.frame_id),
            "",
            "one word",
            "tf frames have names without spaces",
        );
        c.require(
            !self.parent_frame.contains(char::is_whitespace) && self.parent_frame != self.frame_id,
            "parent_frame",
            format!("{:?}", self.parent_frame),
            "",
            "one word other than frame_id, or none",
            "tf frames have names without spaces, and none is its own parent",
        );
        self.check_numbers(c);
    }
}
