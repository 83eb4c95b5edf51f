//! `outputs`: what is published how often.

use super::checker::Checker;
use super::section::section;

section! {
    /// Frames and rates of the outputs.
    pub struct Outputs(this) {
        /// `frame_id` of every header. Default `flexible_tool`.
        frame_id: String = "flexible_tool".to_string();
        /// Parent of `frame_id` on `/tf_static`: Z up, X in the build's direction, origin at the kick-off. Default
        /// `map`; with an empty text the transform is not published.
        parent_frame: String = "map".to_string();
        /// Factor by which `twin/tool_shape` enlarges displacements.
        exaggeration: f64 = 10.0, within(0.0, 1000.0), "", "1 is true to scale";
        /// Messages per second, by topic.
        rates: Rates = Rates::default(), below;
    }
}

section! {
    /// Messages per second of model time (Hz). Each key is the last part of a topic's name. 0 switches a topic off,
    /// except status and diagnostics, which show the operator that the twin works. A recording keeps at least the rates
    /// at which the run began: lower rates that are set while the twin runs act on DDS only.
    #[derive(Copy)]
    pub struct Rates(this) {
        /// Rate of `twin/joint_deflections`.
        joint_deflections: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `twin/contact_forces`.
        contact_forces: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `twin/whirl`.
        whirl: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `twin/bit_state`.
        bit_state: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `twin/status`.
        status: f64 = 5.0, within(1.0, 1000.0), "Hz",
            "it shows that the twin works; more would flood the network";
        /// Rate of `twin/tool_shape`.
        tool_shape: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `twin/ageing`.
        ageing: f64 = 1.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `twin/reactions`.
        reactions: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `twin/transfer`.
        transfer: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `joint_states`.
        joint_states: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// Rate of `/diagnostics`.
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
            transfer: self.transfer.max(other.transfer),
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
