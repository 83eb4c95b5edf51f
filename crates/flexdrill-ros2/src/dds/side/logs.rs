//! Log lines of the DDS library. Errors are forwarded to the node's log, one per place in the library and ten seconds. One kind of debug line names a
//! reader that does not acknowledge samples, and one kind of error shows that discovery is jammed.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use log::{Level, LevelFilter, Log, Metadata, Record};

use super::outlet::Outlet;
use crate::dds::frames::LogLevel;
use flexdrill_text::log_ending;

/// Target of the lines in which RustDDS names the readers to which it sends samples again.
const REPAIR_TARGET: &str = "rustdds::rtps::writer";
/// Text before and after the reader's id in such a line.
const REPAIR_LINE: (&str, &str) = ("Repair data send to ", ". ReaderProxy");
/// Text of discovery about an announcement that it cannot decode. Discovery then postpones the announcements behind it.
const BROKEN_ANNOUNCEMENT: &str = "spdp_receive:";
/// Broken announcements within this time were in the queue together.
const TOGETHER: Duration = Duration::from_millis(2);
/// Most readers remembered.
const MOST_REPAIRED: usize = 256;

static LOG: OnceLock<SideLog> = OnceLock::new();

struct SideLog {
    outlet: Outlet,
    level: LevelFilter,
    watchers: AtomicU32,
    repaired: Mutex<Vec<String>>,
    jam: Mutex<Jam>,
}

/// Announcements that could not be decoded.
#[derive(Default)]
struct Jam {
    newest: Option<Instant>,
    together: u32,
}

/// Number of broken announcements that came at once, and the time since the last one; none where there was none.
pub(super) fn broken_announcements(now: Instant) -> Option<(u32, Duration)> {
    let jam = LOG.get()?.jam.lock().unwrap_or_else(PoisonError::into_inner);
    Some((jam.together, now.saturating_duration_since(jam.newest?)))
}

/// Forwards the library's errors to the node, and further levels where RUST_LOG names `rustdds`.
pub(super) fn start(outlet: &Outlet) {
    let directives = std::env::var("RUST_LOG").unwrap_or_default();
    let level = directives
        .split(',')
        .find_map(|part| part.strip_prefix("rustdds=")?.parse().ok())
        .unwrap_or(LevelFilter::Error);
    let log = LOG.get_or_init(|| SideLog {
        outlet: outlet.clone(),
        level,
        watchers: AtomicU32::new(0),
        repaired: Mutex::default(),
        jam: Mutex::default(),
    });
    if log::set_logger(log).is_ok() {
        log::set_max_level(level);
    }
}

/// Collects the readers to which samples are sent again, until it is dropped: those readers have not acknowledged all
/// samples.
pub(super) struct RepairWatch;

impl RepairWatch {
    pub(super) fn begin() -> Self {
        if let Some(log) = LOG.get()
            && log.watchers.fetch_add(1, Ordering::AcqRel) == 0
        {
            log.lock().clear();
            log::set_max_level(LevelFilter::Debug);
        }
        Self
    }

    /// Whether samples were sent again to the reader, by the text of its id.
    pub(super) fn has_seen(&self, reader: &str) -> bool {
        LOG.get()
            .is_some_and(|log| log.lock().iter().any(|seen| seen == reader))
    }
}

impl Drop for RepairWatch {
    fn drop(&mut self) {
        if let Some(log) = LOG.get()
            && log.watchers.fetch_sub(1, Ordering::AcqRel) == 1
        {
            log::set_max_level(log.level);
        }
    }
}

impl SideLog {
    fn lock(&self) -> std::sync::MutexGuard<'_, Vec<String>> {
        self.repaired.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note_broken_announcement(&self, now: Instant) {
        let mut jam = self.jam.lock().unwrap_or_else(PoisonError::into_inner);
        if jam
            .newest
            .is_some_and(|newest| now.saturating_duration_since(newest) < TOGETHER)
        {
            jam.together += 1;
        }
        jam.newest = Some(now);
    }

    fn is_watching(&self) -> bool {
        self.watchers.load(Ordering::Acquire) > 0
    }
}

impl Log for SideLog {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.level() <= self.level || (self.is_watching() && metadata.target() == REPAIR_TARGET)
    }

    fn log(&self, record: &Record<'_>) {
        if record.level() == Level::Debug && record.target() == REPAIR_TARGET && self.is_watching() {
            let line = record.args().to_string();
            if let Some(reader) = repaired_reader(&line) {
                let mut repaired = self.lock();
                if repaired.len() < MOST_REPAIRED && !repaired.iter().any(|seen| seen == reader) {
                    repaired.push(reader.to_owned());
                }
            }
        }
        if record.level() <= self.level {
            let level = match record.level() {
                Level::Error => LogLevel::Error,
                Level::Warn => LogLevel::Warning,
                Level::Info => LogLevel::Info,
                Level::Debug | Level::Trace => LogLevel::Debug,
            };
            let line = record.args().to_string();
            let now = Instant::now();
            if line.contains(BROKEN_ANNOUNCEMENT) {
                self.note_broken_announcement(now);
            }
            let passed = if self.level == LevelFilter::Error {
                // The library writes a line for every broken packet.
                log_ending(place(record))
            } else {
                // RUST_LOG requests all lines.
                Some(String::new())
            };
            if let Some(more) = passed {
                self.outlet.log(level, format!("{}: {line}{more}", record.target()));
            }
        }
    }

    fn flush(&self) {}
}

/// The place in the library that writes a line: the cause, whatever a peer has sent.
fn place(record: &Record<'_>) -> String {
    format!("{}:{}", record.target(), record.line().unwrap_or_default())
}

fn repaired_reader(line: &str) -> Option<&str> {
    let (start, end) = REPAIR_LINE;
    line.strip_prefix(start)?.split_once(end).map(|(reader, _)| reader)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The library writes a line for every broken packet; the place is the cause, whatever the packet holds.
    #[test]
    fn lines_of_one_place_are_one_cause() {
        let passed = (0..1000).filter(|number| {
            let text = format_args!("packet {number} is broken");
            let record = Record::builder()
                .target("a test's library")
                .line(Some(7))
                .args(text)
                .build();
            log_ending(place(&record)).is_some()
        });
        assert_eq!(passed.count(), 1);
    }

    #[test]
    fn the_line_that_names_a_reader_is_read() {
        let line = "Repair data send to GUID {x}. ReaderProxy Unsent changes: []";
        assert_eq!(repaired_reader(line), Some("GUID {x}"));
        assert_eq!(repaired_reader("Writer x HEARTBEAT"), None);
    }
}
