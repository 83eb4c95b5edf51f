//! Field logs: reads a log (CSV, or LAS by time) and its mapping file into the timed inputs that the topics would carry, and reports
//! everything in the log that is wrong.
//!
//! The crate never fills in a value: it leaves out what is missing, so that the conditioner sees the input age as it
//! would on the rig, and the report names the rows. Rows are numbered as an editor shows them: the header is row 1.
//!
//! ```no_run
//! # fn main() -> Result<(), flexdrill_field_log::FieldLogError> {
//! use flexdrill_field_log::{Mapping, read};
//!
//! let mapping = Mapping::load("config/field_logs/rig_1hz.yaml")?;
//! let (sequence, report) = read("config/field_logs/demo.csv", &mapping)?;
//! print!("{report}");
//! for input in &sequence.inputs {
//!     println!("{:8.1} s {} = {} {}", input.time, input.kind.name(), input.value, input.kind.unit());
//! }
//! # Ok(())
//! # }
//! ```

mod compressed;
mod condition;
mod error;
mod guess;
mod hookload;
mod judge;
mod las;
mod layout;
mod lines;
mod log_rows;
mod mapping;
mod measured;
mod parts;
mod range;
mod read;
mod report;
mod sequence;
mod spikes;
mod surveys;
mod table;
mod time_format;
mod time_suggestion;

pub use condition::Condition;
pub use error::FieldLogError;
pub use guess::{Guess, LeftOut, Proposal, Quantity, Sure, guess, guess_bytes, is_proposed};
pub use log_rows::{LogRows, row_source};
pub use mapping::{Column, Columns, Decimal, Hookload, Mapping, Quality, ScaledColumn, TimeColumn, WeightOnBitColumn};
pub use measured::{MeasuredRow, MeasuredSequence};
pub use range::{Position, Range};
pub use read::{read, read_bytes, read_range};
pub use report::{Issue, IssueKind, Report, Summary, Tare, TorqueSummary};
pub use sequence::{InputSequence, RowTime, TimedInput};
pub use surveys::SurveyRow;
pub use time_format::TimeFormat;
