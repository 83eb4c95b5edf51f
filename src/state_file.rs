//! States that outlast a restart of the node: small files, each written as a whole by a separate thread, so that a slow disk
//! delays nothing else. One node at a time writes a file: the writer holds a lock next to it.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use flexdrill_text::log_ending;

/// Longest wait for the last state when the node ends.
const LAST_STATE: Duration = Duration::from_secs(2);

/// How errors name a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Words {
    /// The state, such as "the alarms' state".
    pub state: &'static str,
    /// What a node keeps in the file, such as "the alarms".
    pub of_node: &'static str,
    /// What a run begins with without it.
    pub without: &'static str,
    /// What does not outlast a run that cannot write it.
    pub lost: &'static str,
}

/// A state that outlasts a restart.
pub trait Kept: Sized + Send + 'static {
    /// How errors name it.
    const WORDS: Words;

    /// The bytes of its file.
    ///
    /// # Errors
    /// When there is no memory.
    fn encode(&self) -> std::io::Result<Vec<u8>>;

    /// The state in the bytes of a file.
    ///
    /// # Errors
    /// Why the bytes are none.
    fn decode(bytes: &[u8]) -> Result<Self, String>;
}

/// Why a saved state cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// The file exists and cannot be read.
    #[error("{}: {} cannot be read: {source}; {}", path.display(), words.state, words.without)]
    Read {
        /// How the state is named.
        words: Words,
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// The file has another content, or only a part of it.
    #[error("{}: {} is damaged: {why}; {}", path.display(), words.state, words.without)]
    Damaged {
        /// How the state is named.
        words: Words,
        /// The file.
        path: PathBuf,
        /// The cause.
        why: String,
    },
    /// The file cannot be written.
    #[error(
        "{}: {} cannot be written: {source}; {} will not outlast this run; --state-dir selects another folder",
        path.display(), words.state, words.lost
    )]
    Write {
        /// How the state is named.
        words: Words,
        /// The file or its folder.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// Another node of the same name and domain writes the file.
    #[error(
        "{}: process {owner} keeps {} of a node with this name and domain in it; {} of this node will not outlast its run; \
         start it with another --namespace or --state-dir", path.display(), words.of_node, words.lost
    )]
    Owned {
        /// How the state is named.
        words: Words,
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
pub fn file_name(of: &str, domain: u16, node: &str, extension: &str) -> String {
    format!("{of}_domain_{domain}{}.{extension}", node.replace('/', "."))
}

/// The file with something behind its name.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// Reads a state; none without a file.
///
/// # Errors
/// When the file cannot be read or has another content.
pub fn read<T: Kept>(path: &Path) -> Result<Option<T>, StateError> {
    let words = T::WORDS;
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => {
            return Err(StateError::Read {
                words,
                path: path.to_owned(),
                source,
            });
        }
    };
    T::decode(&bytes).map(Some).map_err(|why| StateError::Damaged {
        words,
        path: path.to_owned(),
        why,
    })
}

/// Writes a state next to the old one and replaces the old one with it, so that one of the two is complete at any time.
/// The state is on the disk when this returns.
///
/// # Errors
/// When the disk refuses the write.
pub fn write<T: Kept>(path: &Path, state: &T) -> Result<(), StateError> {
    let failed = |source| StateError::Write {
        words: T::WORDS,
        path: path.to_owned(),
        source,
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    let bytes = state.encode().map_err(failed)?;
    replace(path, &bytes).map_err(failed)
}

/// Writes bytes next to a file and replaces the file with them. They are on the disk when this returns.
///
/// # Errors
/// When the disk refuses the write; the file is then as it was.
pub fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    replace_by(&with_ending(path, ".new"), path, bytes)
}

/// As [`replace`], for a file that several processes may write: they write under different names first.
///
/// # Errors
/// When the disk refuses the write; the file is then as it was.
pub fn replace_shared(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    replace_by(&with_ending(path, &format!(".{}", std::process::id())), path, bytes)
}

fn replace_by(fresh: &Path, path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let replaced = File::create(fresh)
        .and_then(|mut file| {
            file.write_all(bytes)?;
            file.sync_all()
        })
        .and_then(|()| std::fs::rename(fresh, path));
    if replaced.is_err() {
        // The first error is the one to report.
        let _ = std::fs::remove_file(fresh);
    }
    replaced.and_then(|()| sync_folder(path))
}

/// A name from outside as part of a file's name: letters, digits and the bytes `kept` are as they are, others are `%` and two
/// hexadecimal digits.
pub fn plain(name: &str, kept: &[u8]) -> String {
    let plain = |byte: u8| match byte {
        byte if byte.is_ascii_alphanumeric() || kept.contains(&byte) => char::from(byte).to_string(),
        byte => format!("%{byte:02x}"),
    };
    name.bytes().map(plain).collect()
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
fn own(path: &Path, words: Words) -> Result<File, StateError> {
    let failed = |source| StateError::Write {
        words,
        path: path.to_owned(),
        source,
    };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    let lock_path = with_ending(path, ".lock");
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false);
    let mut lock = options.open(&lock_path).map_err(failed)?;
    match lock.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => {
            let owner = std::fs::read_to_string(&lock_path).unwrap_or_default();
            return Err(StateError::Owned {
                words,
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
struct Order<T> {
    state: T,
    written: Option<Written>,
}

/// Writes states in order. Of several waiting states it writes the newest, which includes the others.
pub struct StateWriter<T: Kept> {
    sender: Option<Sender<Order<T>>>,
    thread: Option<JoinHandle<()>>,
}

impl<T: Kept> StateWriter<T> {
    /// Starts the thread that writes to a file, and locks the file for this process.
    ///
    /// # Errors
    /// [`StateError::Owned`] if another process writes the file; [`StateError::Write`] if the thread cannot be started. A
    /// folder that cannot be written is logged, and tried again with every state.
    pub fn start(path: PathBuf) -> Result<Self, StateError> {
        let lock = match own(&path, T::WORDS) {
            Err(error @ StateError::Write { .. }) => {
                tracing::warn!("{error}");
                None
            }
            owned => Some(owned?),
        };
        let (sender, orders) = channel();
        let started = std::thread::Builder::new().name("state file".into());
        let file = path.clone();
        match started.spawn(move || keep(&path, lock, &orders)) {
            Ok(thread) => Ok(Self {
                sender: Some(sender),
                thread: Some(thread),
            }),
            Err(source) => Err(StateError::Write {
                words: T::WORDS,
                path: file,
                source,
            }),
        }
    }

    /// Queues a state.
    pub fn save(&self, state: T) {
        self.send(Order { state, written: None });
    }

    /// Queues a state. The writer's thread calls `written` when the state is on the disk or has failed.
    pub fn save_then(&self, state: T, written: Written) {
        self.send(Order {
            state,
            written: Some(written),
        });
    }

    fn send(&self, order: Order<T>) {
        if let Some(sender) = &self.sender {
            // The thread lives as long as this value.
            let _ = sender.send(order);
        }
    }
}

impl<T: Kept> Drop for StateWriter<T> {
    /// Waits a limited time until the last state is on the disk.
    fn drop(&mut self) {
        drop(self.sender.take());
        let Some(thread) = self.thread.take() else { return };
        let deadline = Instant::now() + LAST_STATE;
        while !thread.is_finished() {
            if Instant::now() >= deadline {
                // The thread is abandoned: a disk that does not answer must not delay the end of the node.
                tracing::warn!(
                    "{} was not written within {} s: the disk does not answer",
                    T::WORDS.state,
                    LAST_STATE.as_secs()
                );
                return;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        let _ = thread.join();
    }
}

fn keep<T: Kept>(path: &Path, mut lock: Option<File>, orders: &Receiver<Order<T>>) {
    let mut works = lock.is_some();
    while let Ok(first) = orders.recv() {
        let mut waiting = vec![first];
        waiting.extend(orders.try_iter());
        let Some(newest) = waiting.last() else { continue };
        let owned = match lock {
            Some(_) => Ok(()),
            None => own(path, T::WORDS).map(|owned| lock = Some(owned)),
        };
        let result = owned
            .and_then(|()| write(path, &newest.state))
            .map_err(|error| error.to_string());
        match &result {
            Ok(()) => works = true,
            // One warning until a write succeeds again.
            Err(error) if works => {
                if let Some(more) = log_ending(format!("{} not written", T::WORDS.state)) {
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
    use flexdrill_alarms::{AlarmSystem, Definition, Delays, Saved};

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
        assert_eq!(read::<Saved>(&path).unwrap(), None);
        let writer = StateWriter::start(path.clone()).unwrap();
        writer.save(saved());
        drop(writer);
        assert_eq!(read(&path).unwrap(), Some(saved()));
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &text[..text.len() / 2]).unwrap();
        let error = read::<Saved>(&path).unwrap_err().to_string();
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
        let first = StateWriter::<Saved>::start(path.clone()).unwrap();
        let Err(error) = StateWriter::<Saved>::start(path.clone()) else {
            panic!("two writers of one file");
        };
        let error = error.to_string();
        let owner = format!("process {}", std::process::id());
        for part in [owner.as_str(), "alarms.json", "--namespace", "--state-dir"] {
            assert!(error.contains(part), "'{part}' is not in: {error}");
        }
        drop(first);
        StateWriter::<Saved>::start(path).unwrap();
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
        assert_eq!(
            file_name("alarms", 3, "/rig_7/flexdrill", "json"),
            "alarms_domain_3.rig_7.flexdrill.json"
        );
    }
}
