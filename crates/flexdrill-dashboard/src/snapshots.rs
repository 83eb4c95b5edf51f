//! Large answers that all readers share: only a few copies exist, for any number and speed of readers.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes};

/// Largest number of copies at a time. The history of the default tool has 23 MB.
const MOST: usize = 4;
/// A reader has at least this time before a newer copy replaces its copy.
const GRACE: Duration = Duration::from_secs(20);
/// Bytes passed to a connection at a time.
const CHUNK: usize = 64 << 10;

struct Snapshot {
    version: u64,
    made: Instant,
    bytes: Arc<Vec<u8>>,
    /// Each reader holds a clone, so that the count shows the number of readers.
    readers: Arc<()>,
}

/// The newest copies of an answer.
#[derive(Default)]
pub(crate) struct Snapshots(Mutex<Vec<Snapshot>>);

impl Snapshots {
    /// The answer of a version, which `make` produces if necessary. While slow readers hold all copies, the answer is
    /// the newest of these.
    pub fn body(&self, version: u64, make: impl FnOnce() -> Option<Vec<u8>>) -> Option<Body> {
        self.bytes(version, Instant::now(), make).map(Reader::body)
    }

    fn bytes(&self, version: u64, now: Instant, make: impl FnOnce() -> Option<Vec<u8>>) -> Option<Reader> {
        let mut kept = self.lock();
        if kept.last().is_none_or(|newest| newest.version != version) {
            kept.retain(|snapshot| Arc::strong_count(&snapshot.readers) > 1);
            if kept.len() >= MOST && now.saturating_duration_since(kept[0].made) >= GRACE {
                kept.remove(0);
            }
            if kept.len() < MOST {
                let bytes = Arc::new(make()?);
                let readers = Arc::default();
                kept.push(Snapshot {
                    version,
                    made: now,
                    bytes,
                    readers,
                });
            }
        }
        let newest = kept.last()?;
        Some(Reader {
            bytes: Arc::downgrade(&newest.bytes),
            at: 0,
            _reading: Arc::clone(&newest.readers),
        })
    }

    fn lock(&self) -> MutexGuard<'_, Vec<Snapshot>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Reads a snapshot as long as it exists.
struct Reader {
    bytes: Weak<Vec<u8>>,
    at: usize,
    _reading: Arc<()>,
}

impl Reader {
    /// The next part; `None` at the end.
    ///
    /// # Errors
    /// When a newer copy has replaced this one.
    fn next(&mut self) -> Option<std::io::Result<Bytes>> {
        let Some(bytes) = self.bytes.upgrade() else {
            return Some(Err(std::io::ErrorKind::TimedOut.into()));
        };
        let rest = bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let chunk = Bytes::copy_from_slice(&rest[..rest.len().min(CHUNK)]);
        self.at += chunk.len();
        Some(Ok(chunk))
    }

    fn body(self) -> Body {
        Body::from_stream(futures::stream::unfold(self, |mut reader| async move {
            let next = reader.next()?;
            Some((next, reader))
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(mut reader: Reader) -> Vec<u8> {
        let mut all = Vec::new();
        while let Some(chunk) = reader.next() {
            all.extend(chunk.unwrap());
        }
        all
    }

    #[test]
    fn readers_share_a_copy_and_few_copies_exist() {
        let snapshots = Snapshots::default();
        let start = Instant::now();
        let made = std::cell::Cell::new(0);
        let ask = |version: u64, second: u64| {
            let make = || {
                made.set(made.get() + 1);
                Some(vec![version as u8; 3 * CHUNK + 1])
            };
            snapshots
                .bytes(version, start + Duration::from_secs(second), make)
                .unwrap()
        };
        // A hundred readers of one version do not read.
        let readers: Vec<Reader> = (0..100).map(|_| ask(1, 0)).collect();
        assert_eq!(made.get(), 1);
        assert_eq!(read(ask(1, 0)), vec![1; 3 * CHUNK + 1]);
        // One more reader of each version does not read either.
        let mut slow: Vec<Reader> = (2..50).map(|version| ask(version, 1)).collect();
        assert_eq!((made.get(), snapshots.lock().len()), (MOST, MOST));
        assert_eq!(read(ask(50, 2))[0], MOST as u8, "the newest there is");
        // After their time, the oldest copy is dropped, and its readers end with an error instead of a part.
        assert_eq!(read(ask(51, 20))[0], 51);
        let mut late = readers.into_iter().next().unwrap();
        assert!(late.next().unwrap().is_err());
        assert!(slow.remove(0).next().unwrap().is_ok());
        // Without the slow readers, one copy remains.
        drop(slow);
        ask(52, 21);
        assert_eq!(snapshots.lock().len(), 1);
    }

    #[test]
    fn without_data_there_is_no_answer() {
        assert!(Snapshots::default().body(1, || None).is_none());
    }
}
