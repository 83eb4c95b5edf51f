//! Whether DDS is alive: a sample goes out and comes back through the whole of it, and its threads are counted.
//!
//! Without multicast, as on a loopback interface by default, a participant does not hear itself. Then the threads tell
//! alone: one that does nothing but compute, for seconds, is caught in what the network sent.

use std::time::{Duration, Instant};

use rustdds::policy::{History, Reliability};
use rustdds::{CDRDeserializerAdapter, CDRSerializerAdapter, DomainParticipant, QosPolicyBuilder, TopicKind, no_key};

/// Longest time without a sample that came back.
const SILENCE: Duration = Duration::from_millis(1200);
/// Longest time in which a thread may compute without a pause, where nothing comes back in any case.
const CAUGHT: Duration = Duration::from_secs(3);
/// Share of the time between two looks that is no pause.
const NO_PAUSE: f64 = 0.95;
/// Ticks of the process table per second, on every Linux that there is.
const TICKS: f64 = 100.0;
/// A look that comes later than this after the one before was held up, and what it sees says nothing of DDS.
const HELD_UP: Duration = Duration::from_millis(600);
/// What the names of DDS's own topics begin with. rmw_cyclonedds passes over endpoints of such topics, and so does not
/// complain that these give no hash of a ROS type.
const HIDDEN: &str = "DCPS";
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
    /// Processor time (ticks) of the library's threads at the last look, and since when one makes no pause.
    spent: Vec<(String, u64)>,
    caught: Option<Instant>,
}

impl Pulse {
    pub(super) fn new(participant: &DomainParticipant) -> Result<Self, String> {
        let show = |error: rustdds::dds::CreateError| error.to_string();
        let policies = QosPolicyBuilder::new()
            .reliability(Reliability::BestEffort)
            .history(History::KeepLast { depth: 1 })
            .build();
        // The layers of ROS 2 leave topics whose names begin like those of DDS's own discovery out of the graph.
        let name = format!("{HIDDEN}flexdrill_pulse_{}_{}", std::process::id(), nonce());
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
            threads: threads().len(),
            spent: threads(),
            caught: None,
        })
    }

    /// Sends the next sample and looks for what came back.
    ///
    /// # Errors
    /// When DDS is dead, and how that shows.
    pub(super) fn check(&mut self, now: Instant) -> Result<(), String> {
        let threads = threads();
        if threads.len() < self.threads {
            return Err(format!(
                "{} of the DDS library's {} threads have ended, as they do when a signal or a debugger interrupts them",
                self.threads - threads.len(),
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
        let passed = now.duration_since(self.looked);
        let held_up = passed > HELD_UP;
        self.looked = now;
        if came || held_up {
            self.heard = now;
            self.has_heard |= came;
        }
        let silent = now.duration_since(self.heard);
        if self.has_heard && silent > SILENCE {
            return Err(format!(
                "nothing has come back through DDS for {:.1} s: it is busy with what the network sends, or dead",
                silent.as_secs_f64()
            ));
        }
        self.look_for_a_caught_one(now, passed, threads)
    }

    fn look_for_a_caught_one(
        &mut self,
        now: Instant,
        passed: Duration,
        threads: Vec<(String, u64)>,
    ) -> Result<(), String> {
        let no_pause = threads.iter().any(|(id, ticks)| {
            let before = self.spent.iter().find(|(known, _)| known == id);
            before.is_some_and(|(_, before)| {
                // A tick more than the table can tell.
                let spent = (ticks.saturating_sub(*before) + 1) as f64 / TICKS;
                spent >= NO_PAUSE * passed.as_secs_f64()
            })
        });
        self.spent = threads;
        if !no_pause {
            self.caught = None;
            return Ok(());
        }
        let since = *self.caught.get_or_insert(now);
        if !self.has_heard && now.duration_since(since) > CAUGHT {
            return Err(format!(
                "a thread of the DDS library has computed for {:.1} s without a pause: it is caught in what the network sent",
                now.duration_since(since).as_secs_f64()
            ));
        }
        Ok(())
    }
}

fn nonce() -> u64 {
    flexdrill_realtime::monotonic::now()
}

/// Threads of the DDS library in this process: id and processor time so far (ticks).
fn threads() -> Vec<(String, u64)> {
    let Ok(tasks) = std::fs::read_dir("/proc/self/task") else {
        return Vec::new();
    };
    tasks
        .filter_map(|task| {
            let path = task.ok()?.path();
            let name = std::fs::read_to_string(path.join("comm")).ok()?;
            let stat = std::fs::read_to_string(path.join("stat")).ok()?;
            let id = path.file_name()?.to_string_lossy().into_owned();
            name.starts_with(THREADS)
                .then(|| (id, processor_ticks(&stat).unwrap_or(0)))
        })
        .collect()
}

/// Ticks in user and system mode of a line of `/proc/self/task/*/stat`; the name in it may have blanks.
fn processor_ticks(stat: &str) -> Option<u64> {
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace();
    let user: u64 = fields.nth(11)?.parse().ok()?;
    let system: u64 = fields.next()?.parse().ok()?;
    Some(user + system)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processor_time_is_read_behind_a_name_with_blanks() {
        let stat = "17 (RustDDS Partici) S 1 17 17 0 -1 4194368 5 0 0 0 250 31 0 0 20 0 4 0 1000 0 0";
        assert_eq!(processor_ticks(stat), Some(281));
        assert_eq!(processor_ticks("nothing"), None);
    }
}
