//! The topic on which a sample arrived.

use super::InputKind;

/// The topics that carry inputs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum InputRoute {
    /// A number alone, on the input's own topic.
    #[default]
    Plain,
    /// All inputs with stamp, quality and source.
    Stamped,
}

impl InputRoute {
    /// Topic of [`InputRoute::Stamped`], relative to the node's namespace.
    pub const STAMPED_TOPIC: &'static str = "rig/inputs";

    /// Topic of an input on this route, relative to the node's namespace.
    pub const fn topic(self, kind: InputKind) -> &'static str {
        match self {
            Self::Plain => kind.topic(),
            Self::Stamped => Self::STAMPED_TOPIC,
        }
    }
}

/// Age and quality of a stamped sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stamp {
    /// Age on arrival (s), by the stamp; negative where the stamp is ahead of the clock.
    pub age: f64,
    /// Its source marks it as bad.
    pub bad: bool,
    /// How far ahead of the clock a stamp may be (s).
    pub max_skew: f64,
}
