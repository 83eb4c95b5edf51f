//! Acknowledgements and shelvings kept over a restart: a small file, written whole by a thread of its own, so that a slow
//! disk holds up nobody.

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

/// Writes a state beside the old one and puts it in its place: at any time one of the two is there, whole.
///
/// # Errors
/// When the disk does not take it.
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
        .map_err(failed)
}

/// Writes states as they come; of several that wait, the newest.
pub struct StateWriter {
    sender: Option<Sender<Saved>>,
    thread: Option<JoinHandle<()>>,
}

impl StateWriter {
    /// A thread that writes to a file.
    ///
    /// # Errors
    /// When the thread cannot be started.
    pub fn start(path: PathBuf) -> Result<Self, StateError> {
        let (sender, states) = channel();
        let started = std::thread::Builder::new().name("alarm state".into());
        let folder = path.clone();
        match started.spawn(move || keep(&path, &states)) {
            Ok(thread) => Ok(Self {
                sender: Some(sender),
                thread: Some(thread),
            }),
            Err(source) => Err(StateError::Write { path: folder, source }),
        }
    }

    /// Hands a state over.
    pub fn save(&self, saved: Saved) {
        if let Some(sender) = &self.sender {
            // The thread ends with this value only.
            let _ = sender.send(saved);
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

fn keep(path: &Path, states: &Receiver<Saved>) {
    let mut works = true;
    while let Ok(state) = states.recv() {
        let newest = states.try_iter().last().unwrap_or(state);
        match write(path, &newest) {
            Ok(()) => works = true,
            // Once, until it works again.
            Err(error) if works => {
                tracing::warn!("{error}");
                works = false;
            }
            Err(_) => {}
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
