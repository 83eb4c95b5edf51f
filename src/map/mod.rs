//! Maps and sweeps: points of `flexdrill_sweep` computed with the twin, and the safe window made from them.
//!
//! # Layout
//! - [`point`]: one point: the way to its values, then members judged by the node's alarms ([`crate::ahead`]).
//! - [`shared`]: what all points share: the [`states`] that they start from, made once, and the sample of a calibration.
//! - [`rounds`]: which points of a map to run, and with how many members. [`study`]: the map from what they say.
//! - [`picture`], [`table`]: the map drawn and as tables.

pub mod picture;
pub mod point;
pub mod rounds;
pub mod shared;
pub mod states;
pub mod study;
pub mod table;

use crate::ahead::Figure;
use crate::alarms::AlarmId;
use flexdrill_core::Instructions;
use flexdrill_motion::HazardKind;
use flexdrill_sweep::spec::Program;

/// What this program says of itself in a plan.
pub fn program() -> Program {
    let portable = Instructions::best() == Instructions::PORTABLE;
    let hazards = HazardKind::ALL.map(AlarmId::of_hazard).into_iter();
    Program {
        name: concat!("flexdrill ", env!("CARGO_PKG_VERSION")).to_owned(),
        arithmetic: if portable { "portable" } else { "fused" }.to_owned(),
        alarms: hazards
            .chain([AlarmId::ModelQuality])
            .map(|id| id.id().to_owned())
            .collect(),
        figures: Figure::ALL
            .map(Figure::name_and_unit)
            .map(|(name, unit)| (name.to_owned(), unit.to_owned()))
            .to_vec(),
    }
}
