//! What people are told: text of others that cannot act on a terminal, not the same line again and
//! again, and dates.

mod instant;
mod printable;
mod throttle;

pub use instant::{instant, instant_in_a_name, time_of_day};
pub use printable::{printable, printable_lines};
pub use throttle::{Throttle, Throttles};
