//! The table of lives: a row per joint and run, so that sums, hours, runs and places follow from it, and a run that is
//! added twice is known.

use std::collections::{BTreeMap, BTreeSet};

use super::{Kind, LifeError, RunLife};

/// Begin of a clock (ns) below which a run has the model's own time: a year, as `flexdrill_text::date_time` has it.
const FIRST_DATE: i64 = 31_536_000_000_000_000;
/// Share by which a sum may differ that was counted twice: the digits of the table.
const SAME: f64 = 1e-7;

/// A joint in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Serial number.
    pub serial: String,
    /// Begin of the run on the rig's clock (ns).
    pub start: i64,
    /// Its last count (ns).
    pub end: i64,
    /// Hash of its configuration.
    pub configuration: String,
    /// Place in the tool, counted from the bit up.
    pub place: u32,
    /// Model time of the run (h).
    pub hours: f64,
    /// Median damage of the stop.
    pub stop: f64,
    /// Median damage of the link below it.
    pub link: f64,
}

impl Row {
    /// What distinguishes its run from others.
    pub(crate) fn run(&self) -> (i64, &str) {
        (self.start, &self.configuration)
    }
}

/// What came of adding a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Added {
    /// It is in the table now.
    New,
    /// The table had its beginning, which the whole replaces.
    Grown,
    /// The table has it already.
    Known,
}

/// The lives of all joints of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Lives {
    /// Name of the table, for messages.
    pub file: String,
    /// What the damages mean.
    pub kind: Kind,
    /// By serial number, then by time.
    pub rows: Vec<Row>,
}

impl Lives {
    /// An empty table for the joints of a run.
    pub fn new(file: &str, kind: Kind) -> Self {
        Self {
            file: file.to_owned(),
            kind,
            rows: Vec::new(),
        }
    }

    /// Serial numbers of the table.
    pub fn serials(&self) -> BTreeSet<&str> {
        self.rows.iter().map(|row| row.serial.as_str()).collect()
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.rows.iter().map(Row::run).collect::<BTreeSet<_>>().len()
    }

    /// Adds a run. A joint that the table does not have must be among `new`, or the table empty. With `replace` runs that
    /// had a joint of this run at the same time are taken out.
    ///
    /// # Errors
    /// When the run is of other joints or of another class, has serial numbers that the table does not have, overlaps with
    /// another run of a joint, or cannot be distinguished from another one. The table is then as it was.
    pub fn add(&mut self, run: &RunLife, new: &[String], replace: bool) -> Result<Added, LifeError> {
        self.kind.is_of(&self.file, &run.kind)?;
        // A run that the table has is compared first: its joints are known, whatever they are called now.
        let before = self.same_run(run);
        if !before.is_empty() {
            if let Some(known) = self.compared(run, &before)? {
                return Ok(known);
            }
        } else if !self.rows.is_empty() {
            self.all_known(run, new)?;
        }
        // A joint drills once at a time: the same hours of another configuration would count twice.
        let overlapping = self.overlapping(run);
        if let Some(row) = overlapping.first()
            && !replace
        {
            return Err(LifeError::Overlap {
                file: self.file.clone(),
                serial: row.serial.clone(),
                start: row.start,
                end: row.end,
            });
        }
        // Whole runs leave, so that no run has a part of its joints.
        let leave: BTreeSet<(i64, String)> = (overlapping.iter().chain(&before))
            .map(|row| (row.start, row.configuration.clone()))
            .collect();
        let grown = !before.is_empty();
        self.rows
            .retain(|row| !leave.contains(&(row.start, row.configuration.clone())));
        self.rows.extend(run.joints.iter().map(|joint| Row {
            serial: joint.serial.clone(),
            start: run.start,
            end: run.end,
            configuration: run.configuration.clone(),
            place: joint.place,
            hours: run.hours,
            stop: joint.stop,
            link: joint.link,
        }));
        self.rows
            .sort_by(|a, b| (&a.serial, a.start, &a.configuration).cmp(&(&b.serial, b.start, &b.configuration)));
        Ok(if grown { Added::Grown } else { Added::New })
    }

    /// Median damages of a joint, of its stop and of the link below it, in the runs before one that begins at an instant (ns) with
    /// a configuration of a hash. Of a run on the model's own time, all others are before it.
    pub(crate) fn damages_before(&self, (start, configuration): (i64, &str), serial: &str) -> [f64; 2] {
        let before = self.rows.iter().filter(|row| {
            row.serial == serial && row.run() != (start, configuration) && (start < FIRST_DATE || row.start < start)
        });
        before.fold([0.0; 2], |[stop, link], row| [stop + row.stop, link + row.link])
    }

    /// Rows of the run, if the table has it.
    fn same_run(&self, run: &RunLife) -> Vec<Row> {
        let same = |row: &&Row| row.run() == (run.start, run.configuration.as_str());
        self.rows.iter().filter(same).cloned().collect()
    }

    /// Compares a run with the rows that the table has of it: `Known` if it adds nothing to them, none if it is longer.
    fn compared(&self, run: &RunLife, rows: &[Row]) -> Result<Option<Added>, LifeError> {
        let by_serial: BTreeMap<&str, &Row> = rows.iter().map(|row| (row.serial.as_str(), row)).collect();
        let pairs = || {
            let joints = run.joints.iter();
            joints.filter_map(|joint| Some((joint, *by_serial.get(joint.serial.as_str())?)))
        };
        let at_most = |a: f64, b: f64| a <= b * (1.0 + SAME);
        // A recording of a part of the run has no more of anything.
        let is_part = at_most(run.hours, rows[0].hours)
            && pairs().all(|(joint, row)| at_most(joint.stop, row.stop) && at_most(joint.link, row.link));
        let is_whole = at_most(rows[0].hours, run.hours)
            && pairs().all(|(joint, row)| at_most(row.stop, joint.stop) && at_most(row.link, joint.link));
        let alike = pairs().count() == run.joints.len();
        // Runs whose clock begins at zero all begin at once: only equal ones are known to be one.
        let dated = run.start >= FIRST_DATE;
        match (alike, is_part, is_whole) {
            (true, true, true) => Ok(Some(Added::Known)),
            (true, true, false) if dated => Ok(Some(Added::Known)),
            (true, false, true) if dated => Ok(None),
            _ => Err(LifeError::SameBegin {
                file: self.file.clone(),
                start: run.start,
            }),
        }
    }

    /// Rows of joints of the run in other runs at the same time. The model's own time says nothing of that.
    fn overlapping(&self, run: &RunLife) -> Vec<Row> {
        if run.start < FIRST_DATE {
            return Vec::new();
        }
        let serials: BTreeSet<&str> = run.joints.iter().map(|joint| joint.serial.as_str()).collect();
        let rows = self.rows.iter().filter(|row| {
            row.run() != (run.start, run.configuration.as_str())
                && row.start < run.end
                && run.start < row.end
                && serials.contains(row.serial.as_str())
        });
        rows.cloned().collect()
    }

    /// Whether the table or `new` has every joint of a run.
    fn all_known(&self, run: &RunLife, new: &[String]) -> Result<(), LifeError> {
        let known = self.serials();
        let unknown: Vec<_> = run
            .joints
            .iter()
            .filter(|joint| !known.contains(joint.serial.as_str()) && !new.contains(&joint.serial))
            .collect();
        let Some(first) = unknown.first() else {
            return Ok(());
        };
        let named: Vec<String> = unknown
            .iter()
            .map(|joint| format!("{} (place {} from the bit)", joint.serial, joint.place))
            .collect();
        let meant = flexdrill_config::reading::nearest(&first.serial, known.iter().copied());
        Err(LifeError::UnknownSerials {
            file: self.file.clone(),
            named: named.join(", "),
            first: first.serial.clone(),
            meant: meant.map(str::to_owned),
        })
    }
}
