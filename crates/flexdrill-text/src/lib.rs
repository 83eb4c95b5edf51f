//! Text for terminals and logs: escapes for text that others wrote, bytes in hex, a rate limit for log lines, dates, counts,
//! numbers, how they change, and names of machines.
//!
//! The crate knows nothing of the twin; every other crate that prints may use it.

mod course;
mod date;
mod host;
mod number;
mod printable;
mod throttle;

pub use course::Course;
pub use date::{compact_date_time, date_time, time_of_day};
pub use host::is_host;
pub use number::{beyond, counted, fixed, percent, six_digits};
pub use printable::{hex, printable, printable_lines, table_cell};
pub use throttle::{LOG_INTERVAL, Throttle, Throttles, log_ending};
