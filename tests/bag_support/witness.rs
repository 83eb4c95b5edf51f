//! A recording on a disk that may fail, and a list of what it was given, to hold them against each other at the end.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::sync::Arc;

use flexdrill::bag::{self, BagError, RecordingThread};
use flexdrill::messages::topics::{self, TopicInfo};

use super::faulty::{Counted, ENOSPC, Fault, Faulty};

/// The recording and the list.
pub struct Witness {
    recording: RecordingThread,
    disk: Faulty,
    fails: bool,
    folder: tempfile::TempDir,
    /// Per topic, in order: stamp and digest of each message.
    given: BTreeMap<&'static str, Vec<(i64, u64)>>,
}

impl Witness {
    /// Begins a recording on a disk that is full from time to time.
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let disk = Faulty::new(Counted::Writes, Fault::Refuse(ENOSPC));
        let path = folder.path().join("run");
        let name = |topic: &TopicInfo| format!("/{}", topic.name.trim_start_matches('/'));
        Self {
            recording: RecordingThread::start_on(Arc::new(disk.clone()), &path, name).unwrap(),
            disk,
            fails: false,
            folder,
            given: BTreeMap::new(),
        }
    }

    /// The recording.
    pub fn recording(&self) -> &RecordingThread {
        &self.recording
    }

    /// Hands a message over.
    pub fn record(&mut self, topic: &str, stamp: i64, bytes: &[u8]) {
        let topic = topics::ALL.iter().find(|known| known.name == topic).unwrap();
        self.recording.record(topic, stamp, bytes);
        self.given.entry(topic.name).or_default().push((stamp, digest(bytes)));
    }

    /// The disk takes nothing any more, or takes everything again.
    pub fn turn(&mut self) {
        self.fails = !self.fails;
        if self.fails {
            self.disk.fail();
        } else {
            self.disk.heal();
        }
    }

    /// Ends it. Everything that was handed over is in the bag, as it was and in its place, or counted as lost.
    pub fn check(self) {
        let given: usize = self.given.values().map(Vec::len).sum();
        let (messages, lost) = match self.recording.finish() {
            Ok(recording) => (recording.messages, recording.lost),
            Err(BagError::Incomplete { messages, lost, .. }) => (messages, lost),
            Err(error) => panic!("{error}"),
        };
        assert_eq!(messages + lost, given as u64, "{messages} in it, {lost} lost");
        assert!(
            self.fails || self.disk.fired() || lost == 0,
            "{lost} lost without a fault"
        );
        if messages == 0 {
            return;
        }
        let mut found = 0;
        for read in bag::open(&self.folder.path().join("run")).unwrap() {
            let read = read.unwrap();
            let (_, list) = self.given.iter().find(|(name, _)| read.topic.is(name)).unwrap();
            let number = read.sequence.unwrap() as usize;
            assert_eq!(
                list[number],
                (read.log_time, digest(&read.data)),
                "{} {number}",
                read.topic.name
            );
            found += 1;
        }
        assert_eq!(found, messages);
    }
}

fn digest(bytes: &[u8]) -> u64 {
    let mut digest = DefaultHasher::new();
    bytes.hash(&mut digest);
    digest.finish()
}
