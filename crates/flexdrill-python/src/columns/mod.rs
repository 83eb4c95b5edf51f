//! The figures of a snapshot, as columns of a recording.
//!
//! A name carries the unit where there is one: `torque_nm`, `rotary_speed_rad_per_s`. Angles are in rad.

mod motion;
mod tool;

use flexdrill_core::dynamics::Energies;
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{Holder, Snapshot};

/// How the values of one sample are read.
#[derive(Clone, Copy)]
pub enum Read {
    /// One number.
    Number(fn(&Snapshot) -> f64),
    /// A row of the energy ledger.
    Energy(fn(&Energies) -> f64),
    /// Numbers along the tool.
    List(fn(&Snapshot) -> &[f64]),
    /// Vectors (y, z) along the tool.
    Pairs(fn(&Snapshot) -> &[[f64; 2]]),
    /// Vectors (x, y, z) along the tool.
    Triples(fn(&Snapshot) -> &[[f64; 3]]),
    /// A few numbers in a fixed order.
    Few(fn(&Snapshot, &mut Vec<f64>)),
    /// A code, as in the messages.
    Code(fn(&Snapshot) -> u8),
    /// Codes along the tool.
    Codes(fn(&Snapshot, &mut Vec<u8>)),
    /// A count.
    Count(fn(&Snapshot) -> u64),
    /// Indices along the tool.
    Indices(fn(&Snapshot, &mut Vec<u64>)),
}

/// One column.
#[derive(Clone, Copy)]
pub struct Column {
    /// Name within its group.
    pub name: &'static str,
    /// Whether it is constant during a run: it then has no axis of time.
    pub fixed: bool,
    /// How a sample is read.
    pub read: Read,
}

impl Column {
    const fn new(name: &'static str, read: Read) -> Self {
        Self {
            name,
            fixed: false,
            read,
        }
    }

    const fn fixed(name: &'static str, read: Read) -> Self {
        Self {
            name,
            fixed: true,
            read,
        }
    }
}

/// Columns that are recorded together.
#[derive(Clone, Copy)]
pub struct Group {
    /// Name of the group.
    pub name: &'static str,
    /// Its columns.
    pub columns: &'static [Column],
}

/// Every recording has these.
pub const INSTANT: Group = Group {
    name: "instant",
    columns: &[
        Column::new("time_s", Read::Number(|s| s.time)),
        Column::new("step", Read::Count(|s| s.step)),
    ],
};

/// What may be recorded in addition.
pub const GROUPS: &[Group] = &[
    tool::APPLIED,
    tool::JOINTS,
    tool::CONTACTS,
    tool::BIT,
    tool::REACTIONS,
    motion::TRANSFER,
    tool::SHAPE,
    motion::WHIRL,
    motion::HAZARDS,
    motion::AGEING,
    motion::SOLVER,
    motion::ENERGY,
    motion::QUALITY,
];

/// The group of that name.
pub fn group(name: &str) -> Option<&'static Group> {
    GROUPS.iter().find(|group| group.name == name)
}

const fn body_code(body: Body) -> u8 {
    match body {
        Body::Pipe => 0,
        Body::Guide => 1,
    }
}

/// A support by its pipe, and the string.
const fn holder_code(holder: Holder) -> u8 {
    match holder {
        Holder::Support(body) => body_code(body),
        Holder::String => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        let mut names: Vec<String> = GROUPS
            .iter()
            .flat_map(|group| {
                group
                    .columns
                    .iter()
                    .map(|column| format!("{}.{}", group.name, column.name))
            })
            .collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(count > 100, "{count} columns");
    }
}
