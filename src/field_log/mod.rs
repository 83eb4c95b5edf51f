//! Field logs: a CSV file with a mapping file gives the same timed inputs as the topics do, and a report of everything
//! in the log that is not as it should be.
//!
//! Nothing is guessed silently: what is missing is not filled in but left out, so that the conditioner sees the input
//! age as it would on the rig, and the report names the rows. Rows are numbered as an editor shows them: the header is
//! row 1.

mod condition;
mod error;
mod hookload;
mod mapping;
mod parts;
mod range;
mod read;
mod report;
mod sequence;
mod spikes;
mod table;
mod time_format;

pub use condition::Condition;
pub use error::FieldLogError;
pub use mapping::{
    Columns, Decimal, Direct, Hookload, Mapping, Quality, RotarySpeedColumn, TimeColumn, WeightOnBitColumn,
};
pub use mapping::{SpeedUnit, TorqueColumn, TorqueUnit, WeightUnit};
pub use range::{Position, Range};
pub use read::{read, read_range};
pub use report::{Issue, IssueKind, Report, Summary, Tare, TorqueSummary};
pub use sequence::{InputSequence, TimedInput};
pub use time_format::TimeFormat;
