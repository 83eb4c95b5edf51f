//! What one item of `/diagnostics` says.

/// Level, sentence and evidence of an item.
pub(super) struct Judgement {
    /// Which item, such as `pacing`.
    pub(super) name: &'static str,
    /// One of the constants of `DiagnosticStatus`.
    pub(super) level: u8,
    /// For a person.
    pub(super) message: String,
    /// Keys, with their unit unless the value says it, and values.
    pub(super) values: Vec<(&'static str, String)>,
}
