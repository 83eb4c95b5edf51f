//! `flexdrill verify`: the closed-form cases, as a table.

mod record;

use std::io::IsTerminal;
use std::path::PathBuf;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use self::record::Record;
use crate::cli::output::say;
use flexdrill_verify::{CASES, Row, VALIDATIONS, VerifyError, title, with_runs};

/// Runs the closed-form verification cases and compares them with theory; fails when one is outside its limit.
#[derive(Debug, Args)]
pub struct VerifyArgs {
    /// Only cases whose name contains this.
    #[arg(long)]
    only: Option<String>,
    /// Also run the published figures, and record every run as a bag into this folder, with the figures (figures.csv)
    /// and the list of the runs (runs.csv), for comparison with another program. The folder is made and must be empty.
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,
}

struct Work {
    name: &'static str,
    shows: &'static str,
    run: fn() -> Result<Vec<Row>, VerifyError>,
}

/// The closed forms, and the published figures where they are asked for.
fn work(published: bool) -> impl Iterator<Item = Work> {
    let published = VALIDATIONS.iter().filter(move |_| published).map(|figure| Work {
        name: figure.name,
        shows: figure.shows,
        run: figure.run,
    });
    let closed = CASES.iter().map(|case| Work {
        name: case.name,
        shows: case.shows,
        run: case.run,
    });
    closed.chain(published)
}

/// Runs the subcommand.
///
/// # Errors
/// When a case cannot be run or is outside its limit.
pub fn run(args: &VerifyArgs) -> anyhow::Result<()> {
    let cases: Vec<_> = work(args.record.is_some())
        .filter(|case| args.only.as_deref().is_none_or(|part| case.name.contains(part)))
        .collect();
    anyhow::ensure!(
        !cases.is_empty(),
        "no verification case has a name that contains {:?}",
        args.only.as_deref().unwrap_or("")
    );
    let bar = if std::io::stderr().is_terminal() {
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} {elapsed}")?;
        ProgressBar::new(cases.len() as u64).with_style(style)
    } else {
        ProgressBar::hidden()
    };
    let mut record = args.record.as_deref().map(Record::into_folder).transpose()?;
    say!("{}", title());
    let (mut passed, mut failed) = (0, 0);
    for case in cases {
        bar.set_message(format!("{}: {}", case.name, case.shows));
        let (rows, runs) = with_runs(case.run)?;
        bar.suspend(|| rows.iter().for_each(|row| say!("{row}")));
        let good = rows.iter().filter(|row| row.passed()).count();
        passed += good;
        failed += rows.len() - good;
        if let Some(record) = &mut record {
            record.case(case.name, &rows, &runs)?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    if let Some(record) = record {
        say!("{}", record.finish()?);
    }
    say!("{passed} within their limits, {failed} outside");
    anyhow::ensure!(failed == 0, "{failed} verification values are outside their limits");
    Ok(())
}
