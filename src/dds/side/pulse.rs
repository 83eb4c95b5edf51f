//! Whether DDS is alive: a sample goes out and comes back through the whole of it, and its threads are counted.

use std::time::{Duration, Instant};

use rustdds::policy::{History, Reliability};
use rustdds::{CDRDeserializerAdapter, CDRSerializerAdapter, DomainParticipant, QosPolicyBuilder, TopicKind, no_key};

/// Longest time without a sample that came back.
const SILENCE: Duration = Duration::from_millis(1200);
/// Longest time to the first one: discovery comes first.
const FIRST: Duration = Duration::from_secs(4);
/// A look that comes later than this after the one before was held up, and what it sees says nothing of DDS.
const HELD_UP: Duration = Duration::from_millis(600);
/// How the library's threads are named in the process table.
const THREADS: &str = "RustDDS";

type Writer = no_key::DataWriter<u64, CDRSerializerAdapter<u64, byteorder::LittleEndian>>;
type Reader = no_key::SimpleDataReader<u64, CDRDeserializerAdapter<u64>>;

/// A topic that nobody else reads, and what is heard on it.
pub(super) struct Pulse {
    writer: Writer,
    reader: Reader,
    count: u64,
    /// When a sample came back last, or when there was reason to begin to wait.
    heard: Instant,
    has_heard: bool,
    looked: Instant,
    threads: usize,
}

impl Pulse {
    pub(super) fn new(participant: &DomainParticipant) -> Result<Self, String> {
        let show = |error: rustdds::dds::CreateError| error.to_string();
        let policies = QosPolicyBuilder::new()
            .reliability(Reliability::BestEffort)
            .history(History::KeepLast { depth: 1 })
            .build();
        // No name of a ROS topic, so that ROS 2's tools do not list it.
        let name = format!("flexdrill_pulse_{}_{}", std::process::id(), nonce());
        let topic = participant
            .create_topic(name, "flexdrill::Pulse".to_owned(), &policies, TopicKind::NoKey)
            .map_err(show)?;
        let writer = participant
            .create_publisher(&policies)
            .map_err(show)?
            .create_datawriter_no_key(&topic, None)
            .map_err(show)?;
        let reader = participant
            .create_subscriber(&policies)
            .map_err(show)?
            .create_simple_datareader_no_key(&topic, None)
            .map_err(show)?;
        let now = Instant::now();
        Ok(Self {
            writer,
            reader,
            count: 0,
            heard: now,
            has_heard: false,
            looked: now,
            threads: threads(),
        })
    }

    /// Sends the next sample and looks for what came back.
    ///
    /// # Errors
    /// When DDS is dead, and how that shows.
    pub(super) fn check(&mut self, now: Instant) -> Result<(), String> {
        let alive = threads();
        if alive < self.threads {
            return Err(format!(
                "{} of the DDS library's {} threads have ended, as they do when a signal or a debugger interrupts them",
                self.threads - alive,
                self.threads
            ));
        }
        let _ = self.writer.write(self.count, None);
        self.count += 1;
        let mut came = false;
        self.reader.drain_read_notifications();
        while let Ok(Some(_)) = self.reader.try_take_one() {
            came = true;
        }
        let held_up = now.duration_since(self.looked) > HELD_UP;
        self.looked = now;
        if came || held_up {
            self.heard = now;
            self.has_heard |= came;
        }
        let silent = now.duration_since(self.heard);
        if silent > if self.has_heard { SILENCE } else { FIRST } {
            return Err(format!(
                "nothing has come back through DDS for {:.1} s: it is busy with what the network sends, or dead",
                silent.as_secs_f64()
            ));
        }
        Ok(())
    }
}

fn nonce() -> u64 {
    flexdrill_realtime::monotonic::now()
}

/// Threads of the DDS library in this process.
fn threads() -> usize {
    let Ok(tasks) = std::fs::read_dir("/proc/self/task") else {
        return 0;
    };
    tasks
        .filter_map(|task| std::fs::read_to_string(task.ok()?.path().join("comm")).ok())
        .filter(|name| name.starts_with(THREADS))
        .count()
}
