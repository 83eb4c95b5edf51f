//! Standard output and standard error. Either may be full or closed without ending a run.
//!
//! After the first error of standard output nothing more is printed, and [`end`] returns that error, so that a command
//! whose result was not printed fails. A reader that has closed the pipe (`| head`) is not an error.

use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write as _};
use std::sync::{Mutex, PoisonError};

/// The first error of standard output.
static FAILED: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints a line on standard output.
macro_rules! say {
    () => { $crate::cli::output::print(format_args!("\n")) };
    ($($text:tt)*) => { $crate::cli::output::print(format_args!("{}\n", format_args!($($text)*))) };
}

/// Prints text on standard output.
macro_rules! say_text {
    ($($text:tt)*) => { $crate::cli::output::print(format_args!($($text)*)) };
}

/// Prints a line on standard error.
macro_rules! tell {
    ($($text:tt)*) => { $crate::cli::output::print_error(format_args!("{}\n", format_args!($($text)*))) };
}

/// Prints text on standard error.
macro_rules! tell_text {
    ($($text:tt)*) => { $crate::cli::output::print_error(format_args!($($text)*)) };
}

pub(super) use {say, say_text, tell, tell_text};

/// Writes to standard output, unless that has failed before.
pub(super) fn print(text: Arguments<'_>) {
    let mut failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner);
    if failed.is_none() {
        // `write_fmt` also reports errors of formatting, which does not occur here.
        *failed = io::stdout().lock().write_fmt(text).err();
    }
}

/// Writes to standard error. A failure is ignored, as there is no other place to report it.
pub(super) fn print_error(text: Arguments<'_>) {
    let _ = io::stderr().lock().write_fmt(text);
}

/// An error of standard output.
#[derive(Debug, thiserror::Error)]
#[error("cannot write to standard output: {0}; the rest of the output is lost")]
pub(super) struct NotPrinted(#[source] pub(super) io::Error);

/// Error number of a file descriptor that is not open (EBADF).
const NOT_OPEN: i32 = 9;

/// The error of a standard output that was not open at the start.
static CLOSED: std::sync::atomic::AtomicBool = std::sync::atomic::AtomicBool::new(false);

/// Marks standard output as closed. Rust's runtime has opened /dev/null in its place, which accepts everything.
pub(super) fn close() {
    CLOSED.store(true, std::sync::atomic::Ordering::Relaxed);
    *FAILED.lock().unwrap_or_else(PoisonError::into_inner) = closed();
}

/// The error of a standard output that was closed at the start.
pub(super) fn closed() -> Option<io::Error> {
    let closed = CLOSED.load(std::sync::atomic::Ordering::Relaxed);
    closed.then(|| io::Error::from_raw_os_error(NOT_OPEN))
}

/// Flushes standard output.
///
/// # Errors
/// When some output could not be written, unless its reader has closed the pipe.
pub(super) fn end() -> Result<(), NotPrinted> {
    let mut failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner);
    judge(failed.take().or_else(|| io::stdout().lock().flush().err()))
}

/// Ignores the error of a reader that has closed the pipe.
///
/// # Errors
/// Every other error.
pub(super) fn judge(error: Option<io::Error>) -> Result<(), NotPrinted> {
    match error {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => Err(NotPrinted(error)),
        _ => Ok(()),
    }
}

/// Whether standard output has failed.
pub(super) fn has_failed() -> bool {
    FAILED.lock().unwrap_or_else(PoisonError::into_inner).is_some()
}
