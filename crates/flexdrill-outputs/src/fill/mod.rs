//! Messages made from a [`Snapshot`](flexdrill_core::twin::Snapshot): one function per type, each filling a message
//! that keeps its memory from one time to the next.

mod ageing;
mod arrows;
mod bit;
mod contacts;
mod joints;
mod reactions;
mod shape;
mod transfer;
mod whirl;

pub use ageing::ageing;
pub use bit::bit_state;
pub use contacts::contact_forces;
pub use joints::{joint_deflections, joint_state};
pub use reactions::reactions;
pub use shape::{ShapeStyle, tool_shape};
pub use transfer::transfer;
pub use whirl::{whirl_state, whirl_warning, whirl_warning_is_suppressed};

use flexdrill_messages::std_msgs::Header;

/// Copies a header, keeping the target's memory.
fn stamp(target: &mut Header, header: &Header) {
    target.clone_from(header);
}

/// Copies an array, keeping the target's memory.
fn copy<T: Clone>(target: &mut Vec<T>, values: &[T]) {
    target.clear();
    target.extend_from_slice(values);
}

/// The largest of the values and its place; (0, 0) where there is none.
pub(crate) fn largest(values: &[f64]) -> (f64, u32) {
    let mut best = (0.0, 0);
    for (index, &value) in values.iter().enumerate() {
        if value > best.0 {
            best = (value, index as u32);
        }
    }
    best
}
