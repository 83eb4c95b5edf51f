//! `flexdrill verify --record`: a bag of every run, the figures, and the list of the runs.

use std::path::{Path, PathBuf};

use anyhow::Context as _;

use crate::cli::replay::record_case;
use flexdrill_text::counted;
use flexdrill_verify::{CaseRun, Row};

/// A folder that is being filled.
pub(super) struct Record {
    folder: PathBuf,
    figures: csv::Writer<std::fs::File>,
    runs: csv::Writer<std::fs::File>,
    bags: usize,
    messages: u64,
}

impl Record {
    /// Makes the folder.
    ///
    /// # Errors
    /// When it has files already, or cannot be written.
    pub(super) fn into_folder(folder: &Path) -> anyhow::Result<Self> {
        std::fs::create_dir_all(folder).with_context(|| format!("{}: cannot be made", folder.display()))?;
        let mut entries = std::fs::read_dir(folder).with_context(|| format!("{}", folder.display()))?;
        anyhow::ensure!(
            entries.next().is_none(),
            "{}: it has files already; name a new folder with --record",
            folder.display()
        );
        let table = |name: &str, header: &[&str]| {
            let path = folder.join(name);
            let mut table = csv::Writer::from_path(&path).with_context(|| format!("{}", path.display()))?;
            table.write_record(header)?;
            anyhow::Ok(table)
        };
        Ok(Self {
            folder: folder.to_owned(),
            figures: table(
                "figures.csv",
                &["case", "quantity", "expected", "ours", "difference", "tolerance"],
            )?,
            runs: table(
                "runs.csv",
                &["bag", "case", "steps", "time_step_s", "duration_s", "residual_factor"],
            )?,
            bags: 0,
            messages: 0,
        })
    }

    /// Adds a case: its figures, and a bag of each of its runs.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub(super) fn case(&mut self, name: &str, rows: &[Row], runs: &[CaseRun]) -> anyhow::Result<()> {
        for row in rows {
            let [expected, ours, difference, tolerance] =
                [row.expected, row.got, row.error(), row.limit].map(|number| number.to_string());
            self.figures
                .write_record([name, &row.quantity, &expected, &ours, &difference, &tolerance])?;
        }
        for (index, run) in runs.iter().enumerate() {
            let bag = if runs.len() == 1 {
                name.to_owned()
            } else {
                format!("{name}_{:02}", index + 1)
            };
            let path = self.folder.join(&bag);
            let recording = record_case(run, &path).with_context(|| format!("{}", path.display()))?;
            let step = run.settings.time_step;
            self.runs.write_record([
                &bag,
                name,
                &run.steps.to_string(),
                &step.to_string(),
                &(run.steps as f64 * step).to_string(),
                &run.settings.residual_factor.to_string(),
            ])?;
            self.bags += 1;
            self.messages += recording.messages;
        }
        Ok(())
    }

    /// Ends the tables, and says what the folder holds.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub(super) fn finish(mut self) -> anyhow::Result<String> {
        self.figures.flush()?;
        self.runs.flush()?;
        Ok(format!(
            "{} with {}, figures.csv and runs.csv in {}",
            counted(self.bags as u64, "bag"),
            counted(self.messages, "message"),
            self.folder.display()
        ))
    }
}
