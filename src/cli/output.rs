//! What is printed. Standard output may be full or closed, and so may standard error: that ends no run.
//!
//! The first error of standard output is kept, and what comes after it is left out. [`end`] returns it, so that a command
//! does not succeed whose result was not printed. Where the reader has gone (`| head`), it wanted no more.

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
        // A line that fails to be formatted is an error of the formatter too; there is none such here.
        *failed = io::stdout().lock().write_fmt(text).err();
    }
}

/// Writes to standard error. Where that fails there is nobody left to tell.
pub(super) fn print_error(text: Arguments<'_>) {
    let _ = io::stderr().lock().write_fmt(text);
}

/// Why standard output does not have all that was printed.
#[derive(Debug, thiserror::Error)]
#[error("standard output does not take what is printed: {0}; what is missing there was not written")]
pub(super) struct NotPrinted(#[source] pub(super) io::Error);

/// Error number of a file descriptor that is not open (EBADF).
const NOT_OPEN: i32 = 9;

/// The error of a standard output that was not open at the start.
static CLOSED: std::sync::atomic::AtomicBool = std::sync::atomic::AtomicBool::new(false);

/// To be called where standard output was not open when the program started. Rust's runtime opens /dev/null in its place,
/// which takes everything.
pub(super) fn close() {
    CLOSED.store(true, std::sync::atomic::Ordering::Relaxed);
    *FAILED.lock().unwrap_or_else(PoisonError::into_inner) = closed();
}

/// Why standard output takes nothing, where it was not open at the start.
pub(super) fn closed() -> Option<io::Error> {
    let closed = CLOSED.load(std::sync::atomic::Ordering::Relaxed);
    closed.then(|| io::Error::from_raw_os_error(NOT_OPEN))
}

/// Whether all was printed.
///
/// # Errors
/// When standard output did not take it and its reader was still there.
pub(super) fn end() -> Result<(), NotPrinted> {
    let mut failed = FAILED.lock().unwrap_or_else(PoisonError::into_inner);
    judge(failed.take().or_else(|| io::stdout().lock().flush().err()))
}

/// Whether an error of standard output is a failure.
///
/// # Errors
/// When it is one, and not that of a reader that has gone.
pub(super) fn judge(error: Option<io::Error>) -> Result<(), NotPrinted> {
    match error {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => Err(NotPrinted(error)),
        _ => Ok(()),
    }
}

/// Whether standard output takes nothing more.
pub(super) fn has_failed() -> bool {
    FAILED.lock().unwrap_or_else(PoisonError::into_inner).is_some()
}
