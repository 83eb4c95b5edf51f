//! The key of the bridge's terminal: `c` and Enter confirm what the mapping makes of the sources that were shown.

use std::fs::File;
use std::io::{ErrorKind, IsTerminal as _, Read as _};
use std::time::Duration;

use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use tokio::sync::mpsc;

/// Time between two looks at the terminal: a person does not notice it.
const INTERVAL: Duration = Duration::from_millis(200);
/// Longest line that is kept; a longer one is no key.
const LONGEST_LINE: usize = 16;

/// A message for each line `c` that a person writes on the terminal; none where the input is no terminal.
pub(super) fn confirmations() -> mpsc::Receiver<()> {
    let (sender, keys) = mpsc::channel(1);
    if std::io::stdin().is_terminal() {
        match open() {
            // A thread, because terminals are read at intervals; it ends with the program.
            Ok(terminal) => drop(std::thread::spawn(move || watch(terminal, &sender))),
            Err(error) => tracing::warn!("the terminal cannot be read: {error}; --confirm confirms a mapping"),
        }
    }
    keys
}

/// The terminal of the input, opened for itself, so that reading without waiting does not change it for the shell.
fn open() -> Result<File, Errno> {
    let flags = OFlags::RDONLY | OFlags::NONBLOCK | OFlags::NOCTTY | OFlags::CLOEXEC;
    let open = |path: &str| rustix::fs::open(path, flags, Mode::empty()).map(File::from);
    // After a change of the user the first belongs to another one.
    open("/proc/self/fd/0").or_else(|_| open("/dev/tty"))
}

/// Reads the terminal until it is gone or `sender` has no receiver.
fn watch(mut terminal: File, sender: &mpsc::Sender<()>) {
    let (mut line, mut bytes) = (Vec::new(), [0; 256]);
    while !sender.is_closed() {
        std::thread::sleep(INTERVAL);
        // A program in the background that reads its terminal is stopped by the system.
        match rustix::termios::tcgetpgrp(&terminal) {
            Ok(group) if group != rustix::process::getpgrp() => continue,
            // It is no terminal of job control, so that whoever has it may read it.
            Ok(_) | Err(Errno::NOTTY) => {}
            Err(_) => return,
        }
        let read = match terminal.read(&mut bytes) {
            // The end of the input: a person has pressed Ctrl-D, or the terminal is gone.
            Ok(0) => return,
            Ok(read) => read,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => continue,
            Err(_) => return,
        };
        for byte in bytes.iter().take(read) {
            match byte {
                b'\n' | b'\r' => {
                    if line.trim_ascii().eq_ignore_ascii_case(b"c") && sender.blocking_send(()).is_err() {
                        return;
                    }
                    line.clear();
                }
                byte if line.len() < LONGEST_LINE => line.push(*byte),
                _ => {}
            }
        }
    }
}
