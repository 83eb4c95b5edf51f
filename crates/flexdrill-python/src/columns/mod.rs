//! The figures of a snapshot, as columns of a recording.
//!
//! A name carries the unit where there is one: `torque_nm`, `rotary_speed_rad_per_s`. Angles are in rad. The columns of
//! the published figures of bit and transfer come from the table of figures.

mod figures;
mod motion;
mod tool;

use std::borrow::Cow;
use std::sync::LazyLock;

use flexdrill_core::dynamics::Energies;
use flexdrill_core::tool::Body;
use flexdrill_core::twin::{Holder, Snapshot};
use flexdrill_outputs::figures::{BIT_STATE, TRANSFER};

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
#[derive(Clone)]
pub struct Group {
    /// Name of the group.
    pub name: &'static str,
    /// Its columns.
    pub columns: Cow<'static, [Column]>,
}

impl Group {
    const fn new(name: &'static str, columns: &'static [Column]) -> Self {
        Self {
            name,
            columns: Cow::Borrowed(columns),
        }
    }

    /// The group with further columns at its end.
    fn with(mut self, columns: impl Iterator<Item = Column>) -> Self {
        self.columns.to_mut().extend(columns);
        self
    }
}

/// Every recording has these.
pub static INSTANT: Group = Group::new(
    "instant",
    &[
        Column::new("time_s", Read::Number(|s| s.time)),
        Column::new("step", Read::Count(|s| s.step)),
    ],
);

/// What may be recorded in addition.
pub static GROUPS: LazyLock<Vec<Group>> = LazyLock::new(|| {
    vec![
        tool::APPLIED,
        tool::JOINTS,
        tool::CONTACTS,
        tool::BIT.with(figures::of(BIT_STATE)),
        tool::REACTIONS,
        Group::new("transfer", &[]).with(figures::of(TRANSFER)),
        tool::SHAPE,
        motion::WHIRL,
        motion::HAZARDS,
        motion::AGEING,
        motion::SOLVER,
        Group::new("energy", &[]).with(motion::ledger()),
        motion::QUALITY,
    ]
});

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

    /// Names of a group's columns.
    fn names(name: &str) -> Vec<&'static str> {
        let columns = group(name).unwrap().columns.iter();
        columns.map(|column| column.name).collect()
    }

    #[test]
    fn names_are_unique() {
        let mut all: Vec<String> = Vec::new();
        for group in GROUPS.iter() {
            all.extend(names(group.name).iter().map(|name| format!("{}.{name}", group.name)));
        }
        let count = all.len();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), count);
        assert!(count > 150, "{count} columns");
    }

    /// Names that scripts use; the rest of bit and transfer follows from the table by the same rule.
    #[test]
    fn figures_have_names_with_their_units() {
        let expected = [
            (
                "bit",
                "torque_nm mean_torque_nm mean_rotary_speed_rad_per_s mean_weight_on_bit_n stick_slip_index",
            ),
            ("bit", "lateral_acceleration_m_per_s2 lateral_impulse_m_per_s"),
            (
                "transfer",
                "duration_s surface_torque_nm bit_torque_rms_nm kickoff_weight_n torque_efficiency",
            ),
            (
                "transfer",
                "hook_load_n rate_of_penetration_m_per_s depth_of_cut_m drive_power_w drive_at_limit",
            ),
        ];
        for (group, expected) in expected {
            let names = names(group);
            for name in expected.split(' ') {
                assert!(names.contains(&name), "{group}.{name}: {names:?}");
            }
        }
    }

    /// A figure reads the snapshot as the message of the same instant does.
    #[test]
    fn figures_have_the_values_of_the_messages() {
        let mut snapshot = Snapshot::default();
        snapshot.bit.mean_torque = 2.0;
        snapshot.bit.torque = 3.0;
        snapshot.transfer.torque.rms = [4.0, 5.0, 6.0];
        snapshot.transfer.mean.hook_load = 7.0;
        let value = |group_name: &str, name: &str| {
            let columns = &group(group_name).unwrap().columns;
            match columns
                .iter()
                .find(|column| column.name == name)
                .map(|column| column.read)
            {
                Some(Read::Number(read)) => read(&snapshot),
                _ => panic!("{group_name}.{name} is no number"),
            }
        };
        assert_eq!(value("bit", "mean_torque_nm"), 2.0);
        assert_eq!(value("bit", "torque_nm"), 3.0);
        assert_eq!(value("transfer", "bit_torque_rms_nm"), 6.0);
        assert_eq!(value("transfer", "hook_load_n"), 7.0);
    }
}
