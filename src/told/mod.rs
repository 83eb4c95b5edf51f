//! What people are told: text of others that cannot act on a terminal, and not the same line again and again.

mod printable;
mod throttle;

pub use printable::{printable, printable_lines};
pub use throttle::{Throttle, Throttles};
