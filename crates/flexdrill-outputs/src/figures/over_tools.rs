//! The scalars that are compared over plausible tools, each over one second.

use super::row::{Figure, Group, Window};
use super::tables::{
    BIT_STATE, CONTACT_FORCES, JOINT_DEFLECTIONS, TRANSFER, fill_bit_state, fill_contact_forces,
    fill_joint_deflections, fill_transfer,
};
use flexdrill_core::inputs::Dimension;
use flexdrill_core::twin::Snapshot;
use flexdrill_messages::{BitState, ContactForces, JointDeflections, Message, Transfer, topics};

/// What a value over several snapshots is formed from, by the time that a figure covers.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Sum {
    /// The newest value, of a figure that covers an instant or more than the time.
    Newest(f64),
    /// Sum and count.
    Mean(f64, u32),
    /// Sum of squares and count.
    Squares(f64, u32),
    /// The largest.
    Largest(f64),
    /// The sum.
    Integral(f64),
}

impl Sum {
    fn new(window: Window) -> Self {
        match window {
            Window::Instant | Window::LongMean | Window::LongRms => Self::Newest(f64::NAN),
            Window::Mean => Self::Mean(0.0, 0),
            Window::Rms => Self::Squares(0.0, 0),
            Window::Largest => Self::Largest(f64::NAN),
            Window::Integral => Self::Integral(0.0),
        }
    }

    fn add(&mut self, value: f64) {
        match self {
            Self::Newest(newest) => *newest = value,
            Self::Mean(sum, count) => (*sum, *count) = (*sum + value, *count + 1),
            Self::Squares(sum, count) => (*sum, *count) = (*sum + value * value, *count + 1),
            Self::Largest(largest) => *largest = largest.max(value),
            Self::Integral(sum) => *sum += value,
        }
    }

    fn value(&self) -> f64 {
        match *self {
            Self::Newest(value) | Self::Largest(value) | Self::Integral(value) => value,
            Self::Mean(sum, count) => sum / f64::from(count),
            Self::Squares(sum, count) => (sum / f64::from(count)).sqrt(),
        }
    }
}

/// Name and unit of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Known {
    /// Topic below `twin` and field, such as `transfer/bit_torque`.
    pub name: String,
    /// What it is, from the definition of its message.
    pub text: String,
    /// What it measures; `None` for a power.
    pub dimension: Option<Dimension>,
    /// SI unit as in messages; empty for a ratio.
    pub unit: &'static str,
    /// Smallest and largest value that it can have (SI).
    pub range: [f64; 2],
}

/// Figures over the snapshots of a time. Each snapshot ends an interval of the statistics.
#[derive(Debug, Clone)]
pub struct OverTools {
    bit: BitState,
    joints: JointDeflections,
    contacts: ContactForces,
    transfer: Transfer,
    sums: Vec<Sum>,
}

/// Whether a figure is compared: what a bridge sends or a table of torque, weight and the whole tool shows. Powers follow
/// from those; of the bit only what a bridge sends is compared.
fn is_compared<M>(figure: &Figure<M>) -> bool {
    let left_out = |group| matches!(group, Group::Bit | Group::PutIn | Group::Taken);
    figure.bridge.is_some() || figure.shown.is_some_and(|shown| !left_out(shown.group))
}

fn compared<M>(table: &'static [Figure<M>]) -> impl Iterator<Item = &'static Figure<M>> {
    table.iter().filter(|figure| is_compared(figure))
}

impl Default for OverTools {
    fn default() -> Self {
        let mut windows: Vec<Window> = compared(BIT_STATE).map(|figure| figure.window).collect();
        windows.extend(compared(JOINT_DEFLECTIONS).map(|figure| figure.window));
        windows.extend(compared(CONTACT_FORCES).map(|figure| figure.window));
        windows.extend(compared(TRANSFER).map(|figure| figure.window));
        Self {
            bit: BitState::default(),
            joints: JointDeflections::default(),
            contacts: ContactForces::default(),
            transfer: Transfer::default(),
            sums: windows.into_iter().map(Sum::new).collect(),
        }
    }
}

impl OverTools {
    /// Names and units, in the order of the values.
    pub fn known() -> Vec<Known> {
        fn of<M: Message>(topic: &str, table: &'static [Figure<M>]) -> impl Iterator<Item = Known> {
            let topic = topic.trim_start_matches("twin/").to_owned();
            compared(table).map(move |figure| Known {
                name: format!("{topic}/{}", figure.field),
                text: figure.text(),
                dimension: figure.kind.dimension(),
                unit: figure.kind.si(),
                range: figure.range(),
            })
        }
        of(topics::BIT_STATE.name, BIT_STATE)
            .chain(of(topics::JOINT_DEFLECTIONS.name, JOINT_DEFLECTIONS))
            .chain(of(topics::CONTACT_FORCES.name, CONTACT_FORCES))
            .chain(of(topics::TRANSFER.name, TRANSFER))
            .collect()
    }

    /// Takes a snapshot.
    pub fn add(&mut self, snapshot: &Snapshot) {
        fill_bit_state(snapshot, &mut self.bit);
        fill_joint_deflections(snapshot, &mut self.joints);
        fill_contact_forces(snapshot, &mut self.contacts);
        fill_transfer(snapshot, &mut self.transfer);
        let values = (compared(BIT_STATE).map(|figure| (figure.read)(&self.bit)))
            .chain(compared(JOINT_DEFLECTIONS).map(|figure| (figure.read)(&self.joints)))
            .chain(compared(CONTACT_FORCES).map(|figure| (figure.read)(&self.contacts)))
            .chain(compared(TRANSFER).map(|figure| (figure.read)(&self.transfer)));
        for (sum, value) in self.sums.iter_mut().zip(values) {
            sum.add(value);
        }
    }

    /// The values over the snapshots since the last call; NaN where a tool has no such figure.
    pub fn take(&mut self) -> Vec<f64> {
        let values = self.sums.iter().map(Sum::value).collect();
        self.sums = Self::default().sums;
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_cover_what_their_figures_cover() {
        let known = OverTools::known();
        assert!((20..40).contains(&known.len()), "{}", known.len());
        let mut over = OverTools::default();
        let mut snapshot = Snapshot::default();
        let mut take = |looks: [[f64; 4]; 2]| {
            for [torque, shock, axial, hook_load] in looks {
                snapshot.bit.mean_torque = torque;
                snapshot.bit.lateral_acceleration_peak = shock;
                snapshot.bit.axial_acceleration = axial;
                snapshot.transfer.mean.hook_load = hook_load;
                over.add(&snapshot);
            }
            let values = over.take();
            let fields =
                ["torque", "lateral_acceleration_peak", "axial_acceleration"].map(|field| format!("bit_state/{field}"));
            let names = fields.into_iter().chain(["transfer/hook_load".to_owned()]);
            names
                .map(|name| values[known.iter().position(|known| known.name == name).unwrap()])
                .collect::<Vec<f64>>()
        };
        // Mean, largest, root of the mean square, and the newest of what covers more.
        assert_eq!(
            take([[2.0, 9.0, 3.0, 5.0], [4.0, 7.0, 4.0, 6.0]]),
            [3.0, 9.0, 12.5_f64.sqrt(), 6.0]
        );
        assert_eq!(
            take([[1.0, 1.0, 1.0, 1.0]; 2]),
            [1.0; 4],
            "nothing is left of the second before"
        );
        let of = |name: &str| known.iter().find(|known| known.name == name).unwrap();
        assert_eq!(of("transfer/bit_torque").unit, "N m");
        // A torque has a sign; a largest force, an index, a bend and a root of a mean square are sizes.
        assert_eq!(of("transfer/bit_torque").range, [f64::NEG_INFINITY, f64::INFINITY]);
        for size in [
            "contact_forces/max_guide_wall_force",
            "bit_state/stick_slip_index",
            "bit_state/axial_acceleration",
            "joint_deflections/max_bend_angle",
            "transfer/depth_of_cut",
        ] {
            assert_eq!(of(size).range, [0.0, f64::INFINITY], "{size}");
        }
        assert_eq!(of("transfer/drive_at_limit").range, [0.0, 1.0]);
    }
}
