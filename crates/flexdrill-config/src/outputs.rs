//! `outputs`: what is published how often.

use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};

/// Publishing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Outputs {
    /// `frame_id` of every header. Default `flexible_tool`.
    pub frame_id: String,
    /// Factor on displacements in `twin/tool_shape`. Default 10.
    pub exaggeration: f64,
    /// Per topic.
    pub rates: Rates,
}

impl Default for Outputs {
    fn default() -> Self {
        Self {
            frame_id: "flexible_tool".to_string(),
            exaggeration: 10.0,
            rates: Rates::default(),
        }
    }
}

/// Messages per second of model time (Hz); 0 switches a topic off. Keys are the topics' last names.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rates {
    /// Default 50.
    pub joint_deflections: f64,
    /// Default 50.
    pub contact_forces: f64,
    /// Default 10.
    pub whirl: f64,
    /// Default 50.
    pub bit_state: f64,
    /// Default 5.
    pub status: f64,
    /// Default 10.
    pub tool_shape: f64,
    /// Default 50.
    pub joint_states: f64,
    /// Default 1.
    pub diagnostics: f64,
}

impl Default for Rates {
    fn default() -> Self {
        Self {
            joint_deflections: 50.0,
            contact_forces: 50.0,
            whirl: 10.0,
            bit_state: 50.0,
            status: 5.0,
            tool_shape: 10.0,
            joint_states: 50.0,
            diagnostics: 1.0,
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
        let reason = "1 is true to scale";
        c.number(
            "exaggeration",
            self.exaggeration,
            Bound::within(0.0, 1000.0),
            "",
            reason,
        );
        c.below("rates", |c| {
            let rates = [
                ("joint_deflections", self.rates.joint_deflections),
                ("contact_forces", self.rates.contact_forces),
                ("whirl", self.rates.whirl),
                ("bit_state", self.rates.bit_state),
                ("status", self.rates.status),
                ("tool_shape", self.rates.tool_shape),
                ("joint_states", self.rates.joint_states),
                ("diagnostics", self.rates.diagnostics),
            ];
            for (key, rate) in rates {
                let reason = "0 is off; more would flood the network";
                c.number(key, rate, Bound::within(0.0, 1000.0), "Hz", reason);
            }
        });
    }
}
