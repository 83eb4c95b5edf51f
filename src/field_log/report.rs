//! What was found in a log.

use std::fmt;

use super::InputSequence;
use flexdrill_core::inputs::InputKind;

/// Kinds of things in a log that are not as they should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IssueKind {
    /// Not a number, not text, or the wrong number of fields.
    Unreadable,
    /// Empty or a missing code.
    Missing,
    /// The same time as the row before.
    TimeStandsStill,
    /// Before the time of the row before, in a few rows.
    TimeBackwards,
    /// Far after the time of the row before and of the row behind, in one row.
    TimeJumps,
    /// The time goes back and runs on from there.
    TimeStartsAnew,
    /// A long time since the row before.
    Gap,
    /// A single sample far from both its neighbours.
    Spike,
    /// A value that does not change for long.
    Frozen,
    /// Drilling, but nothing to hold the hookload against.
    NoTare,
    /// The hookload is so far above the tare that the tare must be wrong.
    NegativeWeight,
    /// The hookload is a little above the tare.
    TareNoise,
}

impl IssueKind {
    /// All, in the order of the table.
    pub const ALL: [Self; 12] = [
        Self::Unreadable,
        Self::Missing,
        Self::TimeStandsStill,
        Self::TimeBackwards,
        Self::TimeJumps,
        Self::TimeStartsAnew,
        Self::Gap,
        Self::Spike,
        Self::Frozen,
        Self::NoTare,
        Self::NegativeWeight,
        Self::TareNoise,
    ];

    /// For people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unreadable => "unreadable",
            Self::Missing => "missing value",
            Self::TimeStandsStill => "time stands still",
            Self::TimeBackwards => "time goes backwards",
            Self::TimeJumps => "time jumps",
            Self::TimeStartsAnew => "time starts anew",
            Self::Gap => "gap",
            Self::Spike => "spike",
            Self::Frozen => "frozen value",
            Self::NoTare => "no tare yet",
            Self::NegativeWeight => "negative weight",
            Self::TareNoise => "weight just below 0",
        }
    }

    /// What was done about it.
    pub const fn treatment(self) -> &'static str {
        match self {
            Self::Unreadable => "value left out, or the row where time or fields are wrong",
            Self::Missing | Self::Spike | Self::NoTare | Self::NegativeWeight => "value left out",
            Self::TimeStandsStill | Self::TimeBackwards | Self::TimeJumps => "row left out",
            Self::TimeStartsAnew => "a new part begins",
            Self::Gap => "left as a gap",
            Self::Frozen => "kept",
            Self::TareNoise => "set to 0",
        }
    }
}

/// Something found in one row or in successive rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Issue {
    /// What is wrong with it.
    pub kind: IssueKind,
    /// In which column; empty if the whole row.
    pub column: String,
    /// First row, as an editor numbers it.
    pub first_row: u64,
    /// Last row.
    pub last_row: u64,
    /// How many rows.
    pub rows: u64,
    /// Of the first row.
    pub detail: String,
}

/// What a hookload is held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tare {
    /// First row of the window.
    pub first_row: u64,
    /// Last row; it acts on the rows after it.
    pub last_row: u64,
    /// Median hookload in the window (kN).
    pub hookload_kn: f64,
    /// Largest minus smallest hookload in the window (kN).
    pub spread_kn: f64,
}

/// The samples of one input, in the unit of its topic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// The input that it belongs to.
    pub kind: InputKind,
    /// How many samples.
    pub samples: u64,
    /// Smallest; 0 without samples.
    pub smallest: f64,
    /// Median.
    pub median: f64,
    /// Largest.
    pub largest: f64,
}

/// The drive's torque in a log. The model has its own; this is what it can be held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueSummary {
    /// How many rows have it.
    pub samples: u64,
    /// Smallest (kN m).
    pub smallest_kn_m: f64,
    /// Median (kN m).
    pub median_kn_m: f64,
    /// Largest (kN m).
    pub largest_kn_m: f64,
}

impl TorqueSummary {
    /// None without samples.
    pub(super) fn of(torques: impl Iterator<Item = f64>) -> Option<Self> {
        let mut torques: Vec<f64> = torques.collect();
        torques.sort_by(f64::total_cmp);
        Some(Self {
            samples: torques.len() as u64,
            smallest_kn_m: *torques.first()?,
            median_kn_m: *torques.get(torques.len() / 2)?,
            largest_kn_m: *torques.last()?,
        })
    }
}

impl Summary {
    pub(super) fn of(sequence: &InputSequence, kind: InputKind) -> Self {
        let of_kind = sequence.inputs.iter().filter(|input| input.kind == kind);
        let mut values: Vec<f64> = of_kind.map(|input| input.value).collect();
        values.sort_by(f64::total_cmp);
        let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
        Self {
            kind,
            samples: values.len() as u64,
            smallest: at(0),
            median: at(values.len() / 2),
            largest: at(values.len().saturating_sub(1)),
        }
    }
}

/// What was found in a log. `Display` prints it as a table. Every row is either used or left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// Name of the log.
    pub file: String,
    /// First row that was used, as an editor numbers it.
    pub first_row: u64,
    /// Last row that was used.
    pub last_row: u64,
    /// Rows with a usable time.
    pub rows: u64,
    /// Rows without a usable time; each is in an issue.
    pub left_out: u64,
    /// Duration (s).
    pub duration: f64,
    /// Per input, in the order of [`InputKind::ALL`].
    pub inputs: [Summary; 2],
    /// Torque of the drive, where the mapping names its column.
    pub torque: Option<TorqueSummary>,
    /// A longer time between two rows is a gap (s).
    pub max_gap: f64,
    /// Whether weight on bit was formed from the hookload.
    pub weight_from_hookload: bool,
    /// Factor on the log's speed.
    pub speed_scale: f64,
    /// Factor on the log's weight.
    pub weight_scale: f64,
    /// Tares used, in order of rows; empty with a column of weight on bit.
    pub tares: Vec<Tare>,
    /// Everything found, in order of rows.
    pub issues: Vec<Issue>,
    /// Where the time of the log starts anew, a report of each part; else empty.
    pub parts: Vec<Report>,
}

impl Report {
    /// Rows with an issue of a kind.
    pub fn rows_with(&self, kind: IssueKind) -> u64 {
        self.issues
            .iter()
            .filter(|issue| issue.kind == kind)
            .map(|issue| issue.rows)
            .sum()
    }
}

/// Ranges of rows printed per kind; the rest is counted.
const PRINTED: usize = 8;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: rows {} to {} as an editor numbers them (the header is row 1), {} used",
            self.file, self.first_row, self.last_row, self.rows
        )?;
        if self.left_out > 0 {
            write!(f, ", {} LEFT OUT", self.left_out)?;
        }
        writeln!(f, ", {:.1} s", self.duration)?;
        if !self.parts.is_empty() {
            writeln!(
                f,
                "  NOTE: ITS TIME STARTS ANEW, {} parts; how long it was between them is not in the log. Each begins \
                 {:.1} s after the last row of the one before; --from row:N --to row:M takes one alone",
                self.parts.len(),
                super::parts::SEAM_IN_GAPS * self.max_gap
            )?;
            return self
                .parts
                .iter()
                .enumerate()
                .try_for_each(|(index, part)| write!(f, "part {}\n{part}", index + 1));
        }
        for input in &self.inputs {
            writeln!(
                f,
                "  {:<14} {:>6} samples, {:.1} to {:.1} {}, median {:.1}",
                input.kind.name(),
                input.samples,
                input.smallest,
                input.largest,
                input.kind.unit(),
                input.median
            )?;
        }
        if let Some(torque) = &self.torque {
            writeln!(
                f,
                "  {:<14} {:>6} samples, {:.2} to {:.2} kN m, median {:.2}; not used, the model has its own",
                "torque", torque.samples, torque.smallest_kn_m, torque.largest_kn_m, torque.median_kn_m
            )?;
        }
        for (kind, scale) in InputKind::ALL.into_iter().zip([self.speed_scale, self.weight_scale]) {
            if scale == 1.0 {
                writeln!(f, "  {} is taken as it is in the log (scale 1)", kind.name())?;
            } else {
                writeln!(
                    f,
                    "  NOTE: {} IS SCALED, log x {scale}, to the tool's range",
                    kind.name()
                )?;
            }
        }
        self.print_tares(f)?;
        self.print_issues(f)
    }
}

impl Report {
    fn print_tares(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.weight_from_hookload {
            return Ok(());
        }
        writeln!(
            f,
            "  NOTE: weight_on_bit = tare - hookload while drilling, 0 otherwise; tares used: {}",
            self.tares.len()
        )?;
        for tare in self.tares.iter().take(PRINTED) {
            writeln!(
                f,
                "    from row {:>6} on: {:.1} kN, median of rows {} to {}, which spread by {:.1} kN",
                tare.last_row + 1,
                tare.hookload_kn,
                tare.first_row,
                tare.last_row,
                tare.spread_kn
            )?;
        }
        if self.tares.len() > PRINTED {
            writeln!(f, "    and {} more", self.tares.len() - PRINTED)?;
        }
        Ok(())
    }

    fn print_issues(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.issues.is_empty() {
            return writeln!(f, "  nothing wrong found");
        }
        for kind in IssueKind::ALL {
            let of_kind: Vec<&Issue> = self.issues.iter().filter(|issue| issue.kind == kind).collect();
            if of_kind.is_empty() {
                continue;
            }
            writeln!(
                f,
                "  {:<20} {:>6} rows, {}",
                kind.name(),
                self.rows_with(kind),
                kind.treatment()
            )?;
            for issue in of_kind.iter().take(PRINTED) {
                write!(f, "    row {}", issue.first_row)?;
                if issue.last_row != issue.first_row {
                    write!(f, " to {}", issue.last_row)?;
                }
                if !issue.column.is_empty() {
                    write!(f, " {}", issue.column)?;
                }
                writeln!(f, ": {}", issue.detail)?;
            }
            if of_kind.len() > PRINTED {
                writeln!(f, "    and {} more places", of_kind.len() - PRINTED)?;
            }
        }
        Ok(())
    }
}

/// Collects issues, successive rows of one kind and column in one.
#[derive(Debug, Default)]
pub(super) struct Issues {
    list: Vec<Issue>,
}

impl Issues {
    pub(super) fn add(&mut self, kind: IssueKind, column: &str, row: u64, detail: impl FnOnce() -> String) {
        // Kinds and columns take turns within a row, so that the one to continue may lie a little back.
        let before = self.list.iter_mut().rev().take(16).find(|issue| {
            let alone = matches!(kind, IssueKind::Gap | IssueKind::TimeStartsAnew);
            issue.kind == kind && issue.column == column && issue.last_row + 1 == row && !alone
        });
        match before {
            Some(issue) => {
                issue.last_row = row;
                issue.rows += 1;
            }
            None => self.add_span(kind, column, row, row, 1, detail),
        }
    }

    pub(super) fn add_span(
        &mut self,
        kind: IssueKind,
        column: &str,
        first_row: u64,
        last_row: u64,
        rows: u64,
        detail: impl FnOnce() -> String,
    ) {
        self.list.push(Issue {
            kind,
            column: column.to_string(),
            first_row,
            last_row,
            rows,
            detail: detail(),
        });
    }

    /// Those that touch a range of rows, cut to it, in order of rows.
    pub(super) fn between(&self, first: u64, last: u64) -> Vec<Issue> {
        let touching = |issue: &&Issue| issue.last_row >= first && issue.first_row <= last;
        let mut list: Vec<Issue> = self.list.iter().filter(touching).cloned().collect();
        for issue in &mut list {
            let (from, to) = (issue.first_row.max(first), issue.last_row.min(last));
            if (from, to) != (issue.first_row, issue.last_row) {
                issue.rows = issue.rows.min(to - from + 1);
                (issue.first_row, issue.last_row) = (from, to);
            }
        }
        list.sort_by_key(|issue| (issue.first_row, issue.last_row));
        list
    }
}
