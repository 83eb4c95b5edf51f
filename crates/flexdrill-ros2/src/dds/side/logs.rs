//! Log lines of the DDS library. Errors are forwarded to the node's log, a few per second. One kind of debug line names a
//! reader that does not acknowledge samples, and one kind of error shows that discovery is jammed.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use log::{Level, LevelFilter, Log, Metadata, Record};

use super::outlet::Outlet;
use crate::dds::frames::LogLevel;

/// Target of the lines in which RustDDS names the readers to which it sends samples again.
const REPAIR_TARGET: &str = "rustdds::rtps::writer";
/// Text before and after the reader's id in such a line.
const REPAIR_LINE: (&str, &str) = ("Repair data send to ", ". ReaderProxy");
/// Text of discovery about an announcement that it cannot decode. Discovery then postpones the announcements behind it.
const BROKEN_ANNOUNCEMENT: &str = "spdp_receive:";
/// Broken announcements within this time were in the queue together.
const TOGETHER: Duration = Duration::from_millis(2);
/// Most lines per second in the log: the library writes one for every broken packet.
const MOST_LINES: u32 = 5;
/// Most readers remembered.
const MOST_REPAIRED: usize = 256;

static LOG: OnceLock<SideLog> = OnceLock::new();

struct SideLog {
    outlet: Outlet,
    level: LevelFilter,
    watchers: AtomicU32,
    repaired: Mutex<Vec<String>>,
    throttle: Mutex<Throttle>,
    jam: Mutex<Jam>,
}

/// Lines of the present second.
#[derive(Default)]
struct Throttle {
    began: Option<Instant>,
    passed: u32,
    held_back: u64,
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
        throttle: Mutex::default(),
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

impl Throttle {
    /// How many lines were held back since the last one, if a line may be logged at `now`.
    fn pass(&mut self, now: Instant) -> Option<u64> {
        if self
            .began
            .is_none_or(|began| now.saturating_duration_since(began) >= Duration::from_secs(1))
        {
            (self.began, self.passed) = (Some(now), 0);
        }
        if self.passed < MOST_LINES {
            self.passed += 1;
            return Some(std::mem::take(&mut self.held_back));
        }
        self.held_back += 1;
        None
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
                self.throttle.lock().unwrap_or_else(PoisonError::into_inner).pass(now)
            } else {
                // RUST_LOG requests all lines.
                Some(0)
            };
            if let Some(held_back) = passed {
                let more = if held_back > 0 {
                    format!(" ({held_back} more lines of the DDS library since the last one)")
                } else {
                    String::new()
                };
                self.outlet.log(level, format!("{}: {line}{more}", record.target()));
            }
        }
    }

    fn flush(&self) {}
}

fn repaired_reader(line: &str) -> Option<&str> {
    let (start, end) = REPAIR_LINE;
    line.strip_prefix(start)?.split_once(end).map(|(reader, _)| reader)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_of_lines_is_counted_not_written() {
        let mut throttle = Throttle::default();
        let start = Instant::now();
        let passed = (0..1000).filter(|_| throttle.pass(start).is_some()).count();
        assert_eq!(passed, 5);
        assert_eq!(throttle.pass(start + Duration::from_secs(1)), Some(995));
        assert_eq!(throttle.pass(start + Duration::from_secs(1)), Some(0));
    }

    #[test]
    fn the_line_that_names_a_reader_is_read() {
        let line = "Repair data send to GUID {x}. ReaderProxy Unsent changes: []";
        assert_eq!(repaired_reader(line), Some("GUID {x}"));
        assert_eq!(repaired_reader("Writer x HEARTBEAT"), None);
    }
}
