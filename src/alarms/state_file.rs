//! Acknowledgements and shelvings kept over a restart: a small file, written whole by a thread of its own, so that a slow
//! disk holds nobody up. One node at a time writes it: the writer holds a lock beside it.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use flexdrill_alarms::Saved;

/// Longest wait for the last state at the end.
const LAST_STATE: Duration = Duration::from_secs(2);

/// Why a kept state cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The file is there and cannot be read.
    #[error("{}: the alarms' state cannot be read: {source}; all alarms begin as normal", path.display())]
    Read {
        /// File.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// It holds something else, or only a part.
    #[error("{}: the alarms' state is damaged: {source}; all alarms begin as normal", path.display())]
    Damaged {
        /// File.
        path: PathBuf,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// It cannot be written.
    #[error(
        "{}: the alarms' state cannot be written: {source}; acknowledgements and shelvings will not outlast this run, \
         --state-dir takes another folder", path.display()
    )]
    Write {
        /// File or folder.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// Another node of the same name and domain has it.
    #[error(
        "{}: process {owner} keeps the alarms of a node with this name and domain in it; acknowledgements and shelvings of \
         this node will not outlast its run; start it with another --namespace or --state-dir", path.display()
    )]
    Owned {
        /// File.
        path: PathBuf,
        /// Number of the process, as it says itself.
        owner: String,
    },
}

/// The folder that states are kept in, from the environment as the XDG Base Directory Specification has it; none where
/// that names no home.
pub fn default_folder(variable: impl Fn(&str) -> Option<String>) -> Option<PathBuf> {
    let given = |name: &str| variable(name).filter(|value| Path::new(value).is_absolute());
    let base = given("XDG_STATE_HOME")
        .map(PathBuf::from)
        .or_else(|| given("HOME").map(|home| Path::new(&home).join(".local/state")))?;
    Some(base.join("flexdrill"))
}

/// The name of a node's file: two nodes on one machine differ in domain or full name (`/rig_7/flexdrill`).
pub fn file_name(domain: u16, node: &str) -> String {
    format!("alarms_domain_{domain}{}.json", node.replace('/', "."))
}

/// Reads a state; none where there is no file.
///
/// # Errors
/// When the file cannot be read or holds something else.
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

/// Writes a state next to the old one and puts it in its place: at any time one of the two is there, whole. On the disk
/// when this returns.
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
    // Numbers, words and lists: this does not fail but for want of memory.
    let text = serde_json::to_vec(saved).map_err(|error| failed(error.into()))?;
    file.write_all(&text)
        .and_then(|()| file.sync_all())
        .and_then(|()| std::fs::rename(&fresh, path))
        .and_then(|()| sync_folder(path))
        .map_err(failed)
}

/// Brings the new name of a file to the disk.
fn sync_folder(path: &Path) -> std::io::Result<()> {
    match path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        Some(folder) => File::open(folder)?.sync_all(),
        None => File::open(".")?.sync_all(),
    }
}

/// Takes the file for this process alone, for as long as the returned handle lives. A process that was killed has let go.
///
/// # Errors
/// [`StateError::Owned`] where another process has it; [`StateError::Write`] where the folder cannot be written to.
fn own(path: &Path) -> Result<File, StateError> {
    let failed = |source| StateError::Write {
        path: path.to_owned(),
        source,
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    let beside = path.with_extension("json.lock");
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false);
    let mut lock = options.open(&beside).map_err(failed)?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            let owner = std::fs::read_to_string(&beside).unwrap_or_default();
            return Err(StateError::Owned {
                path: path.to_owned(),
                owner: owner.chars().filter(char::is_ascii_digit).take(10).collect(),
            });
        }
        Err(TryLockError::Error(source)) => return Err(failed(source)),
    }
    // Only for the words of another node's error: the lock is the file's, not its content's.
    let _ = lock.set_len(0).and_then(|()| writeln!(lock, "{}", std::process::id()));
    Ok(lock)
}

/// Called when a state is on the disk, or with the reason why it is not.
type Written = Box<dyn FnOnce(Result<(), String>) + Send>;

/// A state on its way to the disk.
struct Order {
    state: Saved,
    written: Option<Written>,
}

/// Writes states as they come; of several that wait, the newest, which holds what the others say.
pub struct StateWriter {
    sender: Option<Sender<Order>>,
    thread: Option<JoinHandle<()>>,
}

impl StateWriter {
    /// A thread that writes to a file, which no other process writes meanwhile.
    ///
    /// # Errors
    /// [`StateError::Owned`] where another process writes it; [`StateError::Write`] where the thread cannot be started. A
    /// folder that cannot be written to is logged, and tried again with every state.
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

    /// Hands a state over.
    pub fn save(&self, state: Saved) {
        self.send(Order { state, written: None });
    }

    /// Hands a state over; `written` is called from the writer's thread when it is on the disk, or cannot be.
    pub fn save_then(&self, state: Saved, written: Written) {
        self.send(Order {
            state,
            written: Some(written),
        });
    }

    fn send(&self, order: Order) {
        if let Some(sender) = &self.sender {
            // The thread ends with this value only.
            let _ = sender.send(order);
        }
    }
}

impl Drop for StateWriter {
    /// Waits until the last state is on the disk, for a moment.
    fn drop(&mut self) {
        drop(self.sender.take());
        let Some(thread) = self.thread.take() else { return };
        let deadline = Instant::now() + LAST_STATE;
        while !thread.is_finished() {
            if Instant::now() >= deadline {
                // The thread is left behind: a disk that does not answer must not hold the end of the node.
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
            // Once, until it works again.
            Err(error) if works => {
                tracing::warn!("{error}");
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
    fn what_was_written_is_read_and_a_damaged_file_is_told() {
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
    fn who_asks_is_told_when_the_state_is_on_the_disk_and_when_it_cannot_be() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/alarms.json");
        let writer = StateWriter::start(path.clone()).unwrap();
        let ask = || {
            let (sender, answer) = channel();
            let file = path.clone();
            // What is told is true when it is told: the file is read within the call.
            let told = move |result: Result<(), String>| sender.send((result, read(&file))).unwrap();
            writer.save_then(saved(), Box::new(told));
            answer.recv_timeout(Duration::from_secs(30)).unwrap()
        };
        let (result, there) = ask();
        assert_eq!((result, there.unwrap()), (Ok(()), Some(saved())));
        // A folder where the file is to be: no disk takes that, not even for root.
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
