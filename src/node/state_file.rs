//! Acknowledgements and shelvings that outlast a restart: a small file, written as a whole by a separate thread, so that a
//! slow disk delays nothing else. One node at a time writes it: the writer holds a lock next to it.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use flexdrill_alarms::Saved;
use flexdrill_text::log_ending;

/// Longest wait for the last state when the node ends.
const LAST_STATE: Duration = Duration::from_secs(2);

/// Why a saved state cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The file exists and cannot be read.
    #[error("{}: the alarms' state cannot be read: {source}; all alarms begin as normal", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// The file has another content, or only a part of it.
    #[error("{}: the alarms' state is damaged: {source}; all alarms begin as normal", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: serde_json::Error,
    },
    /// The file cannot be written.
    #[error(
        "{}: the alarms' state cannot be written: {source}; acknowledgements and shelvings will not outlast this run; \
         --state-dir selects another folder", path.display()
    )]
    Write {
        /// The file or its folder.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// Another node of the same name and domain writes the file.
    #[error(
        "{}: process {owner} keeps the alarms of a node with this name and domain in it; acknowledgements and shelvings of \
         this node will not outlast its run; start it with another --namespace or --state-dir", path.display()
    )]
    Owned {
        /// The file.
        path: PathBuf,
        /// The number of the process, as the lock file has it.
        owner: String,
    },
}

/// The folder of the states, from the environment after the XDG Base Directory Specification; none without a home
/// folder.
pub fn default_folder(variable: impl Fn(&str) -> Option<String>) -> Option<PathBuf> {
    let given = |name: &str| variable(name).filter(|value| Path::new(value).is_absolute());
    let base = given("XDG_STATE_HOME")
        .map(PathBuf::from)
        .or_else(|| given("HOME").map(|home| Path::new(&home).join(".local/state")))?;
    Some(base.join("flexdrill"))
}

/// The name of a node's file. Two nodes on one machine differ in domain or full name (`/rig_7/flexdrill`).
pub fn file_name(domain: u16, node: &str) -> String {
    format!("alarms_domain_{domain}{}.json", node.replace('/', "."))
}

/// Reads a state; none without a file.
///
/// # Errors
/// When the file cannot be read or has another content.
pub fn read(path: &Path) -> Result<Option<Saved>, StateError> {
    let text = match std::fs::read(path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => {
            return Err(StateError::Read {
                path: path.to_owned(),
                source,
            });
        }
    };
    serde_json::from_slice(&text)
        .map(Some)
        .map_err(|source| StateError::Damaged {
            path: path.to_owned(),
            source,
        })
}

/// Writes a state next to the old one and replaces the old one with it, so that one of the two is complete at any time.
/// The state is on the disk when this returns.
///
/// # Errors
/// When the disk refuses the write.
pub fn write(path: &Path, saved: &Saved) -> Result<(), StateError> {
    let failed = |source| StateError::Write {
        path: path.to_owned(),
        source,
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    let fresh = path.with_extension("json.new");
    let mut file = std::fs::File::create(&fresh).map_err(failed)?;
    // A state of numbers, words and lists fails to encode only without memory.
    let text = serde_json::to_vec(saved).map_err(|error| failed(error.into()))?;
    file.write_all(&text)
        .and_then(|()| file.sync_all())
        .and_then(|()| std::fs::rename(&fresh, path))
        .and_then(|()| sync_folder(path))
        .map_err(failed)
}

/// Syncs the folder of a file, so that its new name is on the disk.
fn sync_folder(path: &Path) -> std::io::Result<()> {
    match path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => File::open(folder)?.sync_all(),
        None => File::open(".")?.sync_all(),
    }
}

/// Locks the file for this process until the returned handle is dropped. A killed process holds no lock.
///
/// # Errors
/// [`StateError::Owned`] if another process holds the lock; [`StateError::Write`] if the folder cannot be written.
fn own(path: &Path) -> Result<File, StateError> {
    let failed = |source| StateError::Write {
        path: path.to_owned(),
        source,
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    let lock_path = path.with_extension("json.lock");
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false);
    let mut lock = options.open(&lock_path).map_err(failed)?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            let owner = std::fs::read_to_string(&lock_path).unwrap_or_default();
            return Err(StateError::Owned {
                path: path.to_owned(),
                owner: owner.chars().filter(char::is_ascii_digit).take(10).collect(),
            });
        }
        Err(TryLockError::Error(source)) => return Err(failed(source)),
    }
    // The content serves only the error text of another node; the lock itself does not depend on it.
    let _ = lock.set_len(0).and_then(|()| writeln!(lock, "{}", std::process::id()));
    Ok(lock)
}

/// Called when a state is on the disk, or with the reason of the failure.
type Written = Box<dyn FnOnce(Result<(), String>) + Send>;

/// A state to write.
struct Order {
    state: Saved,
    written: Option<Written>,
}

/// Writes states in order. Of several waiting states it writes the newest, which includes the others.
pub struct StateWriter {
    sender: Option<Sender<Order>>,
    thread: Option<JoinHandle<()>>,
}

impl StateWriter {
    /// Starts the thread that writes to a file, and locks the file for this process.
    ///
    /// # Errors
    /// [`StateError::Owned`] if another process writes the file; [`StateError::Write`] if the thread cannot be started. A
    /// folder that cannot be written is logged, and tried again with every state.
    pub fn start(path: PathBuf) -> Result<Self, StateError> {
        let lock = match own(&path) {
            Err(error @ StateError::Write { .. }) => {
                tracing::warn!("{error}");
                None
            }
            owned => Some(owned?),
        };
        let (sender, orders) = channel();
        let started = std::thread::Builder::new().name("alarm state".into());
        let file = path.clone();
        match started.spawn(move || keep(&path, lock, &orders)) {
            Ok(thread) => Ok(Self {
                sender: Some(sender),
                thread: Some(thread),
            }),
            Err(source) => Err(StateError::Write { path: file, source }),
        }
    }

    /// Queues a state.
    pub fn save(&self, state: Saved) {
        self.send(Order { state, written: None });
    }

    /// Queues a state. The writer's thread calls `written` when the state is on the disk or has failed.
    pub fn save_then(&self, state: Saved, written: Written) {
        self.send(Order {
            state,
            written: Some(written),
        });
    }

    fn send(&self, order: Order) {
        if let Some(sender) = &self.sender {
            // The thread lives as long as this value.
            let _ = sender.send(order);
        }
    }
}

impl Drop for StateWriter {
    /// Waits a limited time until the last state is on the disk.
    fn drop(&mut self) {
        drop(self.sender.take());
        let Some(thread) = self.thread.take() else { return };
        let deadline = Instant::now() + LAST_STATE;
        while !thread.is_finished() {
            if Instant::now() >= deadline {
                // The thread is abandoned: a disk that does not answer must not delay the end of the node.
                tracing::warn!(
                    "the alarms' state was not written within {} s: the disk does not answer",
                    LAST_STATE.as_secs()
                );
                return;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        let _ = thread.join();
    }
}

fn keep(path: &Path, mut lock: Option<File>, orders: &Receiver<Order>) {
    let mut works = lock.is_some();
    while let Ok(first) = orders.recv() {
        let mut waiting = vec![first];
        waiting.extend(orders.try_iter());
        let Some(newest) = waiting.last() else { continue };
        let owned = match lock {
            Some(_) => Ok(()),
            None => own(path).map(|owned| lock = Some(owned)),
        };
        let result = owned
            .and_then(|()| write(path, &newest.state))
            .map_err(|error| error.to_string());
        match &result {
            Ok(()) => works = true,
            // One warning until a write succeeds again.
            Err(error) if works => {
                if let Some(more) = log_ending("alarm state not written") {
                    tracing::warn!("{error}{more}");
                }
                works = false;
            }
            Err(_) => {}
        }
        for written in waiting.into_iter().filter_map(|order| order.written) {
            written(result.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_alarms::{AlarmSystem, Definition, Delays};

    fn saved() -> Saved {
        let definition = Definition {
            id: "shock",
            delays: Delays::default(),
            in_service: true,
        };
        AlarmSystem::new(vec![definition], 60.0).save()
    }

    #[test]
    fn a_written_state_is_read_and_a_damaged_file_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/alarms.json");
        assert_eq!(read(&path).unwrap(), None);
        let writer = StateWriter::start(path.clone()).unwrap();
        writer.save(saved());
        drop(writer);
        assert_eq!(read(&path).unwrap(), Some(saved()));
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &text[..text.len() / 2]).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(
            error.contains("damaged") && error.contains("begin as normal"),
            "{error}"
        );
        write(&path, &saved()).unwrap();
        assert_eq!(read(&path).unwrap(), Some(saved()));
    }

    #[test]
    fn the_caller_learns_when_the_state_is_on_the_disk_and_when_it_cannot_be() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/alarms.json");
        let writer = StateWriter::start(path.clone()).unwrap();
        let ask = || {
            let (sender, answer) = channel();
            let file = path.clone();
            // The file is read within the call, so that the report is checked at the time at which it is made.
            let written = move |result: Result<(), String>| sender.send((result, read(&file))).unwrap();
            writer.save_then(saved(), Box::new(written));
            answer.recv_timeout(Duration::from_secs(30)).unwrap()
        };
        let (result, on_disk) = ask();
        assert_eq!((result, on_disk.unwrap()), (Ok(()), Some(saved())));
        // A folder at the path of the file makes the write fail, even for root.
        std::fs::remove_file(&path).unwrap();
        std::fs::create_dir_all(path.join("in the path")).unwrap();
        let (result, _) = ask();
        let why = result.unwrap_err();
        assert!(
            why.contains("cannot be written") && why.contains("alarms.json"),
            "{why}"
        );
    }

    #[test]
    fn a_second_writer_is_refused_while_the_first_lives() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("alarms.json");
        let first = StateWriter::start(path.clone()).unwrap();
        let Err(error) = StateWriter::start(path.clone()) else {
            panic!("two writers of one file");
        };
        let error = error.to_string();
        let owner = format!("process {}", std::process::id());
        for part in [owner.as_str(), "alarms.json", "--namespace", "--state-dir"] {
            assert!(error.contains(part), "'{part}' is not in: {error}");
        }
        drop(first);
        StateWriter::start(path).unwrap();
    }

    #[test]
    fn the_folder_follows_the_environment() {
        let with = |pairs: &'static [(&str, &str)]| {
            default_folder(|name| {
                pairs
                    .iter()
                    .find(|(key, _)| *key == name)
                    .map(|(_, value)| (*value).to_owned())
            })
        };
        assert_eq!(with(&[]), None);
        assert_eq!(
            with(&[("HOME", "/home/ann")]),
            Some("/home/ann/.local/state/flexdrill".into())
        );
        assert_eq!(
            with(&[("HOME", "/home/ann"), ("XDG_STATE_HOME", "/var/state")]),
            Some("/var/state/flexdrill".into())
        );
        assert_eq!(with(&[("XDG_STATE_HOME", "relative")]), None);
        assert_eq!(file_name(3, "/rig_7/flexdrill"), "alarms_domain_3.rig_7.flexdrill.json");
    }
}
