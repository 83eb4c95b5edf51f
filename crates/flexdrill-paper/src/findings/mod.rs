//! The paper's findings as numbers of a record, and whether they agree.
//!
//! "Effective value" is the root mean square over the record. All definitions stand with their findings and in the
//! report.

mod accelerations;
mod finding;
mod forces;
mod shapes;
mod speeds;

use super::motion::motion;
use super::record::Record;
use flexdrill_core::tool::Body;

pub use finding::{Finding, Verdict};
pub(super) use forces::worst_place;
pub(super) use speeds::FIVE_PLACES;

/// Shortest period looked for, in turns: twenty times the turning rate is noise of single impacts.
const SHORTEST: f64 = 0.05;

/// All findings of a record, in the order of the figures.
pub fn findings(record: &Record) -> Vec<Finding> {
    let pipe = motion(record, Body::Pipe);
    let guide = motion(record, Body::Guide);
    let mut all = shapes::findings(record, &pipe, &guide);
    all.extend(speeds::findings(record, &guide));
    all.extend(forces::findings(record));
    all.extend(accelerations::findings(record));
    all
}

/// Mean closeness, 0 to 1, and the number of findings that agree.
pub fn score(findings: &[Finding]) -> (f64, usize) {
    let sum: f64 = findings.iter().map(|finding| finding.closeness).sum();
    let agree = findings.iter().filter(|f| f.verdict == Verdict::Agrees).count();
    (sum / findings.len().max(1) as f64, agree)
}
