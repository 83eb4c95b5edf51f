//! `outputs`: what is published how often.

use super::checker::Checker;
use super::section::section;

section! {
    /// Publishing.
    pub struct Outputs(this) {
        /// `frame_id` of every header. Default `flexible_tool`.
        frame_id: String = "flexible_tool".to_string();
        /// Factor on displacements in `twin/tool_shape`.
        exaggeration: f64 = 10.0, within(0.0, 1000.0), "", "1 is true to scale";
        /// Per topic.
        rates: Rates = Rates::default(), below;
    }
}

section! {
    /// Messages per second of model time (Hz); 0 switches a topic off. Keys are the topics' last names.
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
        status: f64 = 5.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/tool_shape`.
        tool_shape: f64 = 10.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `twin/ageing`.
        ageing: f64 = 1.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `joint_states`.
        joint_states: f64 = 50.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
        /// `/diagnostics`.
        diagnostics: f64 = 1.0, within(0.0, 1000.0), "Hz", "0 is off; more would flood the network";
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
        self.check_numbers(c);
    }
}
