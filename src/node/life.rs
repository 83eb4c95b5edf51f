//! Joint life of a running node: what its joints have lived in this run, by serial number, added to a table while it runs. A
//! separate thread counts and writes, so that neither disk nor another program with the table delays anything.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use flexdrill_config::{Config, ConfigError};
use flexdrill_life::{Counted, LifeError, LivingJoints, RunLife};
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{Ageing, CdrError, SessionInfo, from_cdr};
use flexdrill_text::log_ending;

use crate::life_table::{self, TableError};

/// Time until the first write: early enough that who starts a node sees that it works.
const FIRST: Duration = Duration::from_secs(10);
/// Time between two writes. A node that is killed loses as much of its joints' life; its recording has it.
const INTERVAL: Duration = Duration::from_secs(60);
/// Messages that wait for the thread. A count that finds no room is in the next one, which has the sums since the start.
const CAPACITY: usize = 64;
/// Longest wait for the last write when the node ends.
const LAST: Duration = Duration::from_secs(5);

/// The table that a node adds its run to.
#[derive(Debug, Clone)]
pub struct LifeSetup {
    /// The table (CSV).
    pub table: PathBuf,
    /// Serial numbers of joints whose life begins with this run.
    pub new: Vec<String>,
}

impl LifeSetup {
    /// The joints of a configuration with what the table has of them now. What other programs add to it later is of the next run.
    ///
    /// # Errors
    /// When the table cannot be read or has other joints, or the configuration has no class or no serial numbers.
    pub fn living(&self, config: &Config) -> Result<LivingJoints, TableError> {
        Ok(LivingJoints::of_table(config, life_table::read(&self.table)?)?)
    }
}

/// A message that the life of joints is made of.
enum Said {
    Session(Vec<u8>),
    Count(Vec<u8>),
}

/// Counts and writes.
pub struct JointLife {
    sender: Option<SyncSender<Said>>,
    thread: Option<JoinHandle<()>>,
}

impl JointLife {
    /// Starts the thread.
    ///
    /// # Errors
    /// When there is no thread.
    pub fn start(setup: LifeSetup) -> std::io::Result<Self> {
        let (sender, said) = sync_channel(CAPACITY);
        let thread = std::thread::Builder::new().name("joint life".into());
        let thread = thread.spawn(move || keep(&setup, &said))?;
        Ok(Self {
            sender: Some(sender),
            thread: Some(thread),
        })
    }

    /// Takes a message of the session, if the life of joints is made of it. Never waits.
    pub fn take(&self, topic: &TopicInfo, cdr: &[u8]) {
        let said = if topic.name == topics::AGEING.name {
            Said::Count(cdr.to_vec())
        } else if topic.name == topics::SESSION.name {
            Said::Session(cdr.to_vec())
        } else {
            return;
        };
        if let Some(sender) = &self.sender {
            // Without room, or without the thread, the next count has the sums.
            let _ = sender.try_send(said);
        }
    }
}

impl Drop for JointLife {
    /// Waits a limited time until the whole run is in the table.
    fn drop(&mut self) {
        drop(self.sender.take());
        let Some(thread) = self.thread.take() else { return };
        let deadline = Instant::now() + LAST;
        while !thread.is_finished() {
            if Instant::now() >= deadline {
                tracing::warn!(
                    "the joints' life was not written within {} s: the disk, or another program with the table, does not answer; \
                     add the recording (flexdrill life add)",
                    LAST.as_secs()
                );
                return;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        let _ = thread.join();
    }
}

/// Why the life of this run is not known, or not in its table.
#[derive(Debug, thiserror::Error)]
enum LifeFault {
    #[error("a message of this run cannot be read: {0}")]
    Message(#[from] CdrError),
    #[error("the configuration of this run cannot be read: {0}")]
    Config(#[from] ConfigError),
    #[error("the joints' life is not in its table: {0}")]
    Table(#[from] TableError),
    #[error("the joints' life is not in its table: {0}")]
    Life(#[from] LifeError),
}

/// What the run has counted.
#[derive(Default)]
struct Run {
    config: Option<Config>,
    /// Instant of its first step (ns since 1970).
    start: i64,
    counted: Counted,
    /// End of what is in the table (ns since 1970).
    written: i64,
}

impl Run {
    /// # Errors
    /// When a message of this program cannot be read: the run is then not known.
    fn take(&mut self, said: &Said) -> Result<(), LifeFault> {
        match said {
            Said::Session(cdr) => {
                let session: SessionInfo = from_cdr(cdr)?;
                self.start = session.start.to_nanoseconds();
                self.config = Some(Config::from_text(
                    "the configuration of the run",
                    &session.configuration,
                )?);
            }
            Said::Count(cdr) => {
                let ageing: Ageing = from_cdr(cdr)?;
                // A count without time in it, as at the first step, says nothing.
                self.counted.push(&ageing, self.start);
            }
        }
        Ok(())
    }

    /// Writes what is not in the table yet.
    ///
    /// # Errors
    /// When the table refuses the run, or cannot be read or written.
    fn write(&mut self, setup: &LifeSetup) -> Result<(), LifeFault> {
        let Some(config) = &self.config else { return Ok(()) };
        if self.counted.duration() <= 0.0 || self.counted.end() == self.written {
            return Ok(());
        }
        let run = RunLife::of(config, &self.counted, self.start)?;
        // Read again each time: another run, or a person, may have added to the table.
        let _locked = life_table::locked(&setup.table)?;
        let lives = life_table::with_run(&setup.table, &run, &setup.new)?;
        life_table::write(&setup.table, &lives)?;
        self.written = self.counted.end();
        Ok(())
    }
}

fn keep(setup: &LifeSetup, said: &Receiver<Said>) {
    let mut run = Run::default();
    let mut next = Instant::now() + FIRST;
    loop {
        let ended = match said.recv_timeout(next.saturating_duration_since(Instant::now())) {
            Ok(said) => {
                log(run.take(&said));
                false
            }
            Err(RecvTimeoutError::Timeout) => false,
            Err(RecvTimeoutError::Disconnected) => true,
        };
        if ended || Instant::now() >= next {
            log(run.write(setup));
            next = Instant::now() + INTERVAL;
        }
        if ended {
            return;
        }
    }
}

fn log(result: Result<(), LifeFault>) {
    if let Err(error) = result
        && let Some(more) = log_ending("joint life")
    {
        tracing::warn!("{error}{more}");
    }
}
