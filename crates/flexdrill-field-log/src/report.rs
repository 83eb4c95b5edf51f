//! The report of a log.

use std::fmt;

use crate::InputSequence;
use crate::table::Numbering;
use flexdrill_core::inputs::InputKind;

flexdrill_base::listed! {
    /// Kinds of problems in a log, in the order of the table.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum IssueKind: 1 {
        /// Not a number, not text, or the wrong number of fields.
        Unreadable: "unreadable";
        /// Empty or a missing code.
        Missing: "missing value";
        /// A number that recorders write for no value and the mapping does not list.
        MissingCode: "missing code";
        /// The same time as the row before.
        TimeRepeats: "time repeats";
        /// Before the time of the row before, in a few rows.
        TimeBackwards: "time steps backwards";
        /// Far after the times of both the row before and the row after, in one row.
        TimeJumps: "time jumps";
        /// The time steps back and continues from there.
        TimeRestarts: "time restarts";
        /// A long time since the row before.
        Gap: "gap";
        /// A single sample far from both its neighbours.
        Spike: "spike";
        /// A value that does not change for long.
        Frozen: "frozen value";
        /// Drilling, but no tare to compare the hookload with.
        NoTare: "no tare yet";
        /// The hookload exceeds the tare by so much that the tare must be wrong.
        NegativeWeight: "negative weight";
        /// The hookload exceeds the tare by measurement noise.
        TareNoise: "weight just below 0";
    }
}

impl IssueKind {
    /// For people.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }

    /// How the reader treats the problem.
    pub const fn treatment(self) -> &'static str {
        match self {
            Self::Unreadable => "value left out, or the row where time or fields are wrong",
            Self::Missing | Self::MissingCode | Self::Spike | Self::NoTare | Self::NegativeWeight => "value left out",
            Self::TimeRepeats | Self::TimeBackwards | Self::TimeJumps => "row left out",
            Self::TimeRestarts => "a new part begins",
            Self::Gap => "left as a gap",
            Self::Frozen => "kept",
            Self::TareNoise => "set to 0",
        }
    }
}

/// A problem in one row or in successive rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Issue {
    /// Kind of problem.
    pub kind: IssueKind,
    /// The column; empty for the whole row.
    pub column: String,
    /// First row, as an editor numbers it.
    pub first_row: u64,
    /// Last row.
    pub last_row: u64,
    /// How many rows.
    pub rows: u64,
    /// Detail of the first row.
    pub detail: String,
}

impl Issue {
    fn swap(&mut self, numbering: Numbering) {
        if numbering.is_mirrored() {
            let [first, last] = [self.last_row, self.first_row].map(|row| numbering.swap(row));
            (self.first_row, self.last_row) = (first, last);
        }
    }
}

/// The hookload off bottom, from which the weight on bit is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tare {
    /// First row of the window.
    pub first_row: u64,
    /// Last row; the tare applies to the rows after it.
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

/// The drive's torque in a log. The model computes its own torque; this one is for comparison.
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
    pub(crate) fn of(torques: impl Iterator<Item = f64>) -> Option<Self> {
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
    pub(crate) fn of(sequence: &InputSequence, kind: InputKind) -> Self {
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

/// The report of a log. `Display` prints a table. Every row is either used or left out.
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
    /// Rows without a usable time; an issue names each.
    pub left_out: u64,
    /// Duration (s).
    pub duration: f64,
    /// Per input, in the order of [`InputKind::ALL`].
    pub inputs: [Summary; InputKind::COUNT],
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
    /// Whether the newest row is the first of the file; first and last rows are by their numbers.
    pub newest_first: bool,
    /// What was found in the log and not in the mapping, in words.
    pub notes: Vec<String>,
    /// Where the log's clock restarts, a report of each part; otherwise empty.
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
        // Rows as an editor numbers them: the reader opens the log to look.
        write!(
            f,
            "{}: rows {} to {} as an editor numbers them (the header is row 1), {} used",
            self.file, self.first_row, self.last_row, self.rows
        )?;
        if self.left_out > 0 {
            write!(f, ", {} LEFT OUT", self.left_out)?;
        }
        writeln!(f, ", {:.1} s", self.duration)?;
        for note in &self.notes {
            writeln!(f, "  NOTE: {note}")?;
        }
        // With several parts only these are printed, because sums across a seam would mislead.
        if !self.parts.is_empty() {
            writeln!(
                f,
                "  NOTE: THE CLOCK RESTARTS, {} parts; the log does not give the time between them. Each part begins \
                 {:.1} s after the last row of the part before; --from row:N --to row:M selects one part",
                self.parts.len(),
                crate::parts::SEAM_IN_GAPS * self.max_gap
            )?;
            return self
                .parts
                .iter()
                .enumerate()
                .try_for_each(|(index, part)| write!(f, "part {}\n{part}", index + 1));
        }
        for input in &self.inputs {
            // A missing optional input is a note, a required one would have been an error.
            if input.kind.is_optional() && input.samples == 0 {
                writeln!(
                    f,
                    "  NOTE: {} is not in the log; the model assumes the value of the configuration",
                    input.kind.name()
                )?;
                continue;
            }
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
        // Torque is an output of the model, so the log's is for comparison only.
        if let Some(torque) = &self.torque {
            writeln!(
                f,
                "  {:<14} {:>6} samples, {:.2} to {:.2} kN m, median {:.2}; for comparison, the model computes its own",
                "torque", torque.samples, torque.smallest_kn_m, torque.largest_kn_m, torque.median_kn_m
            )?;
        }
        // The scale is always said, also when it is 1: a scaled log that
        // is taken for a measured one is a costly mistake.
        for (kind, scale) in InputKind::ALL.into_iter().zip([self.speed_scale, self.weight_scale]) {
            if scale == 1.0 {
                writeln!(f, "  {} is used unchanged (scale 1)", kind.name())?;
            } else {
                writeln!(
                    f,
                    "  NOTE: {} IS SCALED, log x {scale}, to the tool's range",
                    kind.name()
                )?;
            }
        }
        // Tares and issues come last, since they may be long.
        self.print_tares(f)?;
        self.print_issues(f)
    }
}

impl Report {
    /// Numbers the rows as an editor does.
    pub(crate) fn numbered(mut self, numbering: Numbering) -> Self {
        if !numbering.is_mirrored() {
            return self;
        }
        (self.first_row, self.last_row) = (numbering.swap(self.last_row), numbering.swap(self.first_row));
        for tare in &mut self.tares {
            (tare.first_row, tare.last_row) = (numbering.swap(tare.first_row), numbering.swap(tare.last_row));
        }
        for issue in &mut self.issues {
            issue.swap(numbering);
        }
        self.issues.sort_by_key(|issue| (issue.first_row, issue.last_row));
        self.newest_first = true;
        self.parts = self.parts.into_iter().map(|part| part.numbered(numbering)).collect();
        self
    }

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
                // The rows after a tare have lower numbers where the newest row is first.
                if self.newest_first {
                    tare.last_row.saturating_sub(1)
                } else {
                    tare.last_row + 1
                },
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
                writeln!(f, "    and {} more", of_kind.len() - PRINTED)?;
            }
        }
        Ok(())
    }
}

/// Collects issues, and joins successive rows of one kind and column.
#[derive(Debug, Default)]
pub(crate) struct Issues {
    list: Vec<Issue>,
}

impl Issues {
    pub(crate) fn add(&mut self, kind: IssueKind, column: &str, row: u64, detail: impl FnOnce() -> String) {
        // A row may have issues of several kinds and columns, so the one to extend is not always the last.
        let before = self.list.iter_mut().rev().take(16).find(|issue| {
            let alone = matches!(kind, IssueKind::Gap | IssueKind::TimeRestarts);
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

    pub(crate) fn add_span(
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

    /// The first problem of a column that was found.
    pub(crate) fn first_of(&self, column: &str) -> Option<&Issue> {
        self.list.iter().find(|issue| issue.column == column)
    }

    /// Numbers the rows in the other way of [`Numbering`].
    pub(crate) fn swap(&mut self, numbering: Numbering) {
        for issue in &mut self.list {
            issue.swap(numbering);
        }
        self.list.reverse();
    }

    /// The issues that overlap a range of rows, clipped to the range, in order of rows.
    pub(crate) fn between(&self, first: u64, last: u64) -> Vec<Issue> {
        let overlapping = |issue: &&Issue| issue.last_row >= first && issue.first_row <= last;
        let mut list: Vec<Issue> = self.list.iter().filter(overlapping).cloned().collect();
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
