//! Large answers, shared by all who read them: however many readers there are and however slowly they read, only a few
//! copies exist.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use axum::body::{Body, Bytes};

/// Copies that may exist at once. The history of the default tool has 23 MB.
const MOST: usize = 4;
/// A reader has at least this time before a newer copy takes the place of its own.
const GRACE: Duration = Duration::from_secs(20);
/// Bytes that are handed to a connection at once.
const CHUNK: usize = 64 << 10;

struct Snapshot {
    version: u64,
    made: Instant,
    bytes: Arc<Vec<u8>>,
    /// Each reader holds a copy of this.
    readers: Arc<()>,
}

/// The newest copies of an answer.
#[derive(Default)]
pub(super) struct Snapshots(Mutex<Vec<Snapshot>>);

impl Snapshots {
    /// The answer of a version, which `make` makes where it is not there yet. Where slow readers hold all copies, it is
    /// the newest of those, [`GRACE`] / [`MOST`] old at most while they come and go.
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

/// Reads a snapshot for as long as it is kept.
struct Reader {
    bytes: Weak<Vec<u8>>,
    at: usize,
    _reading: Arc<()>,
}

impl Reader {
    /// The next part; none at the end.
    ///
    /// # Errors
    /// When newer copies have taken the place of this one.
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
        // A hundred readers of one version that read nothing.
        let readers: Vec<Reader> = (0..100).map(|_| ask(1, 0)).collect();
        assert_eq!(made.get(), 1);
        assert_eq!(read(ask(1, 0)), vec![1; 3 * CHUNK + 1]);
        // And one of each version.
        let mut slow: Vec<Reader> = (2..50).map(|version| ask(version, 1)).collect();
        assert_eq!((made.get(), snapshots.lock().len()), (MOST, MOST));
        assert_eq!(read(ask(50, 2))[0], MOST as u8, "the newest there is");
        // After their time, the oldest copy makes room, and its readers end with an error, not with a part.
        assert_eq!(read(ask(51, 20))[0], 51);
        let mut late = readers.into_iter().next().unwrap();
        assert!(late.next().unwrap().is_err());
        assert!(slow.remove(0).next().unwrap().is_ok());
        // Once they have gone, there is one.
        drop(slow);
        ask(52, 21);
        assert_eq!(snapshots.lock().len(), 1);
    }

    #[test]
    fn nothing_known_is_no_answer() {
        assert!(Snapshots::default().body(1, || None).is_none());
    }
}
