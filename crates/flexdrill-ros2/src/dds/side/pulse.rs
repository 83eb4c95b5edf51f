//! The self-test of DDS: a sample is sent and received through the whole library, and the library's threads are counted.
//!
//! Without multicast, as on a loopback interface by default, a participant does not receive its own samples. Then the
//! threads are the only sign: one that computes for seconds without a pause is caught in a loop over received packets.

use std::time::{Duration, Instant};

use rustdds::policy::{History, Reliability};
use rustdds::{CDRDeserializerAdapter, CDRSerializerAdapter, DomainParticipant, QosPolicyBuilder, TopicKind, no_key};

/// Longest time without a received sample.
const SILENCE: Duration = Duration::from_millis(1200);
/// Longest time in which a thread may compute without a pause, where no sample can be received.
const CAUGHT: Duration = Duration::from_secs(3);
/// Share of the time between two checks from which on a thread makes no pause.
const NO_PAUSE: f64 = 0.95;
/// Ticks of the process table per second, on all Linux systems.
const TICKS: f64 = 100.0;
/// A longer time between two checks means that this process stood still, and says nothing about DDS.
const OWN_DELAY: Duration = Duration::from_millis(600);
/// Prefix of DDS's own topics. rmw_cyclonedds ignores endpoints of such topics, so that it does not warn of a missing hash
/// of a ROS type.
const HIDDEN: &str = "DCPS";
/// Prefix of the library's threads in the process table.
const THREADS: &str = "RustDDS";

type Writer = no_key::DataWriter<u64, CDRSerializerAdapter<u64, byteorder::LittleEndian>>;
type Reader = no_key::SimpleDataReader<u64, CDRDeserializerAdapter<u64>>;

/// A topic for this process alone, and the samples received on it.
pub(super) struct Pulse {
    writer: Writer,
    reader: Reader,
    count: u64,
    /// When the last sample was received, or when waiting for one began.
    received: Instant,
    has_received: bool,
    checked: Instant,
    threads: usize,
    /// Processor time (ticks) of the library's threads at the last check.
    spent: Vec<(String, u64)>,
    /// Since when a thread makes no pause.
    busy_since: Option<Instant>,
}

impl Pulse {
    pub(super) fn new(participant: &DomainParticipant) -> Result<Self, String> {
        let text = |error: rustdds::dds::CreateError| error.to_string();
        let policies = QosPolicyBuilder::new()
            .reliability(Reliability::BestEffort)
            .history(History::KeepLast { depth: 1 })
            .build();
        // The layers of ROS 2 leave topics whose names begin like those of DDS's own discovery out of the graph.
        let name = format!("{HIDDEN}flexdrill_pulse_{}_{}", std::process::id(), nonce());
        let topic = participant
            .create_topic(name, "flexdrill::Pulse".to_owned(), &policies, TopicKind::NoKey)
            .map_err(text)?;
        let writer = participant
            .create_publisher(&policies)
            .map_err(text)?
            .create_datawriter_no_key(&topic, None)
            .map_err(text)?;
        let reader = participant
            .create_subscriber(&policies)
            .map_err(text)?
            .create_simple_datareader_no_key(&topic, None)
            .map_err(text)?;
        let now = Instant::now();
        Ok(Self {
            writer,
            reader,
            count: 0,
            received: now,
            has_received: false,
            checked: now,
            threads: threads().len(),
            spent: threads(),
            busy_since: None,
        })
    }

    /// Sends the next sample and reads received ones.
    ///
    /// # Errors
    /// When DDS has failed, with the evidence.
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
        let mut is_received = false;
        self.reader.drain_read_notifications();
        while let Ok(Some(_)) = self.reader.try_take_one() {
            is_received = true;
        }
        let passed = now.duration_since(self.checked);
        let held_up = passed > OWN_DELAY;
        self.checked = now;
        if is_received || held_up {
            self.received = now;
            self.has_received |= is_received;
        }
        let silent = now.duration_since(self.received);
        if self.has_received && silent > SILENCE {
            return Err(format!(
                "no sample has passed through DDS for {:.1} s: it is overloaded by received packets, or has stopped",
                silent.as_secs_f64()
            ));
        }
        self.check_threads(now, passed, threads)
    }

    fn check_threads(&mut self, now: Instant, passed: Duration, threads: Vec<(String, u64)>) -> Result<(), String> {
        let no_pause = threads.iter().any(|(id, ticks)| {
            let before = self.spent.iter().find(|(known, _)| known == id);
            before.is_some_and(|(_, before)| {
                // One tick is the resolution of the table.
                let spent = (ticks.saturating_sub(*before) + 1) as f64 / TICKS;
                spent >= NO_PAUSE * passed.as_secs_f64()
            })
        });
        self.spent = threads;
        if !no_pause {
            self.busy_since = None;
            return Ok(());
        }
        let since = *self.busy_since.get_or_insert(now);
        if !self.has_received && now.duration_since(since) > CAUGHT {
            return Err(format!(
                "a thread of the DDS library has computed for {:.1} s without a pause: it is caught in a loop over received packets",
                now.duration_since(since).as_secs_f64()
            ));
        }
        Ok(())
    }
}

fn nonce() -> u64 {
    flexdrill_clock::monotonic::now()
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
