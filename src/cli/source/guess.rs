//! `--guess`: proposes the mapping of a field log, shows it and writes it. Nothing runs on it without `--yes`.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use clap::Args;

use crate::cli::built_in::DemoLog;
use crate::cli::output::{say, say_text};
use crate::cli::{WrongUse, new_file};
use crate::field_log::{self, Guess, Mapping};
use flexdrill_text::printable;

/// The options of a guess.
#[derive(Debug, Args)]
pub(super) struct GuessArgs {
    /// Propose the mapping of a field log: show each column with the evidence, and write the mapping to a file. Nothing runs
    /// on it without --yes.
    #[arg(long, conflicts_with = "mapping")]
    guess: bool,
    /// Run on the mapping that --guess proposes, without a person's comparison.
    #[arg(long, requires = "guess")]
    yes: bool,
    /// File for the mapping that --guess proposes. Default: the log's name with .yaml.
    #[arg(long, value_name = "FILE", requires = "guess")]
    guess_file: Option<PathBuf>,
}

impl GuessArgs {
    /// Whether a guess is asked for.
    pub(super) const fn is_given(&self) -> bool {
        self.guess
    }

    /// Proposes the mapping of a log where --guess asks for it. True where the command ends with that: without --yes.
    ///
    /// # Errors
    /// When the log cannot be read, or the mapping cannot be written.
    pub(super) fn ends_the_command(&self, log: &Path) -> anyhow::Result<bool> {
        if !self.guess || self.yes {
            return Ok(false);
        }
        let guess = self.propose(log)?;
        let file = self.file(log);
        if guess.lacks().is_empty() {
            say!(
                "nothing was run; compare each line with the rig's display, correct the file, and run it with --mapping {}",
                printable(&file.display().to_string())
            );
        } else {
            say!(
                "nothing was run; the log does not show {}: complete the file",
                guess.lacks().join(", ")
            );
        }
        Ok(true)
    }

    /// The mapping that is proposed, for a run with --yes; `None` without --guess.
    ///
    /// # Errors
    /// As [`GuessArgs::ends_the_command`], and when the guess lacks what a mapping needs.
    pub(super) fn mapping(&self, log: &Path) -> anyhow::Result<Option<Mapping>> {
        if !self.guess {
            return Ok(None);
        }
        // The commands end before this without --yes; a command that does not must not run on a guess either.
        if !self.yes {
            bail!(WrongUse::new("--guess runs nothing without --yes"));
        }
        let guess = self.propose(log)?;
        let lacks = guess.lacks();
        if !lacks.is_empty() {
            bail!(
                "{}: the log does not show {}; complete {} and name it with --mapping",
                log.display(),
                lacks.join(", "),
                self.file(log).display()
            );
        }
        Ok(Some(guess.mapping()?))
    }

    /// Shows the guess and writes it.
    fn propose(&self, log: &Path) -> anyhow::Result<Guess> {
        let guess = match DemoLog::at(log) {
            Some(demo) => field_log::guess_bytes(demo.name(), demo.content())?,
            None => field_log::guess(log)?,
        };
        say_text!("{}", guess.table());
        let file = self.file(log);
        let name = printable(&file.display().to_string()).into_owned();
        let text = guess.mapping_file();
        if new_file::write(&file, &text, "--guess-file")? {
            say!("{name} has this mapping");
        } else {
            let there = std::fs::read_to_string(&file).with_context(|| name.clone())?;
            // A file with other contents may have a person's corrections, and running on the guess would pass them over.
            if there != text && self.yes {
                return Err(WrongUse::new(format!(
                    "{name} exists and is another mapping: run with --mapping {name}, or name another file with --guess-file"
                ))
                .into());
            }
            say!("{name} exists and is left as it is");
        }
        Ok(guess)
    }

    /// Where the mapping is written.
    fn file(&self, log: &Path) -> PathBuf {
        let next_to_log = || {
            // The built-in log has no folder here.
            let log = match DemoLog::at(log) {
                Some(_) => Path::new(log.file_name().unwrap_or(log.as_os_str())),
                None => log,
            };
            let packed = log
                .extension()
                .is_some_and(|extension| extension == "gz" || extension == "zst");
            let log = if packed {
                log.with_extension("")
            } else {
                log.to_path_buf()
            };
            log.with_extension("yaml")
        };
        self.guess_file.clone().unwrap_or_else(next_to_log)
    }
}
