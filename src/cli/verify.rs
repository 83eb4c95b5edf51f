//! `flexdrill verify`: the closed-form cases, as a table.

use std::io::IsTerminal;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::output::say;
use flexdrill_verify::{CASES, title};

/// Runs the closed-form verification cases and compares them with theory; fails when one is outside its limit.
#[derive(Debug, Args)]
pub struct VerifyArgs {
    /// Only cases whose name contains this.
    #[arg(long)]
    only: Option<String>,
}

/// Runs the subcommand.
///
/// # Errors
/// When a case cannot be run or is outside its limit.
pub fn run(args: &VerifyArgs) -> anyhow::Result<()> {
    let cases: Vec<_> = CASES
        .iter()
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
    say!("{}", title());
    let (mut passed, mut failed) = (0, 0);
    for case in cases {
        bar.set_message(format!("{}: {}", case.name, case.shows));
        let rows = (case.run)()?;
        bar.suspend(|| rows.iter().for_each(|row| say!("{row}")));
        let good = rows.iter().filter(|row| row.passed()).count();
        passed += good;
        failed += rows.len() - good;
        bar.inc(1);
    }
    bar.finish_and_clear();
    say!("{passed} within their limits, {failed} outside");
    anyhow::ensure!(failed == 0, "{failed} verification values are outside their limits");
    Ok(())
}
