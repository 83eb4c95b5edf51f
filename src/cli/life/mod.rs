//! `flexdrill life`: the life of each joint by its serial number, carried from run to run in a table.

mod recorded;
mod words;

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::{Args, Subcommand};

use super::WrongUse;
use super::progress::Progress;
use crate::cli::output::{say, tell};
use crate::life_table::{locked, read, write};
use flexdrill_life::{Added, Lives, RunLife};
use flexdrill_text::{counted, date_time, printable};

/// Keep the life of each joint by its serial number: add the damages of recorded runs, list the joints to inspect.
///
/// The configuration of a run states the class of the joints (tool.joint.life) and their serial numbers
/// (tool.joint.serial_numbers).
#[derive(Debug, Args)]
pub(super) struct LifeArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    Add(AddArgs),
    Show(ShowArgs),
}

/// Add recorded runs to a table of lives. A run that the table has is not added again; a longer recording of it replaces
/// the shorter one.
#[derive(Debug, Args)]
struct AddArgs {
    /// The table (CSV), created if necessary.
    file: PathBuf,
    /// Bags: .mcap or .db3 files, or folders with such files. All are added, or none.
    #[arg(required = true)]
    bags: Vec<PathBuf>,
    /// Namespace of the twin, such as /rig_7, if a bag has several.
    #[arg(long, value_name = "NS")]
    namespace: Option<String>,
    /// Serial number of a joint whose life begins with one of these runs. A new table needs none.
    #[arg(long, value_name = "SERIAL")]
    new: Vec<String>,
    /// Take runs out of the table that had a joint of these runs at the same time.
    #[arg(long)]
    replace: bool,
}

/// List the joints of a table, the most damaged first, with what to do.
#[derive(Debug, Args)]
struct ShowArgs {
    /// The table (CSV).
    file: PathBuf,
    /// List all joints, also those that need no inspection.
    #[arg(long)]
    all: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When a table or a bag cannot be read, a run is refused, or the table cannot be written.
pub(super) fn run(args: &LifeArgs) -> anyhow::Result<()> {
    match &args.action {
        Action::Add(args) => add(args),
        Action::Show(args) => show(args),
    }
}

/// Adds a recording that this program has just written.
///
/// # Errors
/// As the subcommand.
pub(super) fn add_recording(file: &Path, bag: &Path) -> anyhow::Result<()> {
    add(&AddArgs {
        file: file.to_owned(),
        bags: vec![bag.to_owned()],
        namespace: None,
        new: Vec::new(),
        replace: false,
    })
}

/// Whether a table can be read, or is to be made.
///
/// # Errors
/// When there is a file that cannot be read.
pub(super) fn is_readable(file: &Path) -> anyhow::Result<()> {
    read(file)?;
    Ok(())
}

fn add(args: &AddArgs) -> anyhow::Result<()> {
    // Another command that adds to a table of this folder waits until this one has written.
    let _locked = locked(&args.file)?;
    let mut lives = read(&args.file)?;
    let mut lines = Vec::new();
    // A joint may be new in the first of several runs, and is known in the others.
    for bag in &args.bags {
        let mut progress = Progress::share();
        let recorded = recorded::runs(bag, args.namespace.as_deref(), |share| progress.at(share))?;
        progress.done();
        for what in &recorded.missing {
            tell!("{}: {}", bag.display(), printable(what));
        }
        for recorded in recorded.runs {
            let added = recorded
                .life()
                .and_then(|run| Ok((add_run(&mut lives, &args.file, &run, args)?, run)))
                .with_context(|| bag.display().to_string())?;
            lines.push(line(&added.1, added.0));
        }
    }
    // The table is written once, after every run has been accepted.
    if let Some(lives) = &lives {
        let known = lives.serials();
        if let Some(serial) = args.new.iter().find(|serial| !known.contains(serial.as_str())) {
            let why = format!("--new {serial}: none of these runs has a joint of this serial number");
            return Err(WrongUse::new(why).into());
        }
        write(&args.file, lives)?;
    }
    for line in lines {
        say!("{line}");
    }
    if let Some(lives) = &lives {
        say!(
            "{} has {} in {}; `flexdrill life show` lists them",
            args.file.display(),
            counted(lives.serials().len() as u64, "joint"),
            counted(lives.runs() as u64, "run")
        );
    }
    Ok(())
}

/// Adds a run to the table, which the first run makes.
fn add_run(lives: &mut Option<Lives>, file: &Path, run: &RunLife, args: &AddArgs) -> anyhow::Result<Added> {
    let lives = lives.get_or_insert_with(|| Lives::new(&file.display().to_string(), run.kind.clone()));
    Ok(lives.add(run, &args.new, args.replace)?)
}

fn line(run: &RunLife, added: Added) -> String {
    let what = match added {
        Added::New => "added",
        Added::Grown => "replaced a shorter recording of",
        Added::Known => "the table has",
    };
    format!(
        "{what} the run that began at {}: {:.2} h, {}",
        date_time(run.start),
        run.hours,
        counted(run.joints.len() as u64, "joint")
    )
}

/// Reads a table that there must be.
///
/// # Errors
/// When it cannot be read.
pub(super) fn existing(file: &Path) -> anyhow::Result<Lives> {
    let lives = read(file)?;
    lives.with_context(|| format!("{}: no such file; `flexdrill life add` makes it", file.display()))
}

fn show(args: &ShowArgs) -> anyhow::Result<()> {
    let lives = existing(&args.file)?;
    for line in words::lines(&lives, args.all) {
        say!("{}", printable(&line));
    }
    Ok(())
}
