//! A progress bar on a terminal; elsewhere a line at intervals.

use crate::cli::output::tell;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Time between two lines without a terminal.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// The unit of the progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    /// Seconds of model time.
    ModelTime,
    /// A share, 0 to 1.
    Share,
}

/// Progress of a command, towards an end.
pub(super) struct Progress {
    bar: Option<ProgressBar>,
    end: f64,
    unit: Unit,
    began: Instant,
    printed: Instant,
}

impl Progress {
    /// A bar up to `end` (s of model time).
    pub(super) fn new(end: f64) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new((end * 1e3) as u64);
            // The template is a constant; if it were wrong, the default style would remain.
            if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {msg}  {eta} left") {
                bar.set_style(style);
            }
            bar
        });
        let now = Instant::now();
        Self {
            bar,
            end,
            unit: Unit::ModelTime,
            began: now,
            printed: now,
        }
    }

    /// A bar for a share (0 to 1).
    pub(super) fn share() -> Self {
        Self {
            unit: Unit::Share,
            ..Self::new(1.0)
        }
    }

    /// Sets the progress, in its unit.
    pub(super) fn at(&mut self, time: f64) {
        let wall = self.began.elapsed().as_secs_f64();
        let speed = if wall > 0.0 { time / wall } else { 0.0 };
        if self.unit == Unit::Share {
            if let Some(bar) = &self.bar {
                bar.set_position((time * 1e3) as u64);
            } else if self.printed.elapsed() >= LINE_EVERY {
                self.printed = Instant::now();
                // A rate of less than a hundredth says nothing about the rest.
                let left = if time < 0.01 {
                    String::new()
                } else {
                    format!(", about {:.0} s left", (1.0 - time) / speed)
                };
                tell!("{:.0} % after {wall:.0} s{left}", 100.0 * time);
            }
            return;
        }
        if let Some(bar) = &self.bar {
            bar.set_position((time * 1e3) as u64);
            bar.set_message(format!("{time:.1} of {:.1} s, {speed:.2} x real time", self.end));
        } else if self.printed.elapsed() >= LINE_EVERY {
            self.printed = Instant::now();
            tell!("{time:.1} of {:.1} s of model time, {speed:.2} x real time", self.end);
        }
    }

    /// Wall time since the start (s).
    pub(super) fn elapsed(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Removes the bar.
    pub(super) fn done(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
