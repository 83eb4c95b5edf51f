//! The paper's case: a run recorded at every station, the paper's findings as numbers of that record, its figures and a
//! report.
//!
//! Source: Lin, Luo, Wang, Xiu, Li, Scientific Reports 2024, figures 9 to 17.
//!
//! # Layout
//! - [`Setup`] says what is run; [`record`] runs it and keeps a [`Record`]. A record whose energy audit fails is an
//!   error.
//! - [`findings()`] turns a record into [`Finding`]s, each with its definition, the paper's number and a [`Verdict`].
//!   `series` and `motion` hold what it measures with.
//! - [`hinge`]: the case of Fig. 9. [`figures`]: the drawings, as SVG, and their data.
//! - [`Report`]: the table of findings with what makes them trustworthy, as Markdown and HTML.

mod error;
pub mod figures;
mod files;
mod findings;
pub mod hinge;
mod motion;
mod record;
mod report;
mod series;
mod setup;

pub use error::PaperError;
pub use files::{findings_csv, write_figures, write_text};
pub use findings::{Finding, Verdict, findings, score};
pub use motion::{Motion, Whirl};
pub use record::{Axis, Layer, Record, Recorder, Series, Stations};
pub use report::Report;
pub use series::{Period, contact_episodes, dominant_period, rms};
pub use setup::{Setup, record};
