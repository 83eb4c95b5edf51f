//! Bags: records to MCAP, reads MCAP, and recovers a recording that was interrupted. The crate
//! `flexdrill-sqlite` reads rosbag2's SQLite.
//!
//! This is the only crate that knows these formats. It has no clock, logs only what happens to a recording, and never
//! touches ROS or the network.
//!
//! ```no_run
//! # fn main() -> Result<(), flexdrill_bag::BagError> {
//! use flexdrill_bag::{Recorder, Topic};
//! use flexdrill_messages::{BitState, to_cdr, topics};
//!
//! let topic = Topic::new("/rig_7/twin/bit_state", &topics::BIT_STATE.kind, topics::BIT_STATE.qos);
//! let mut recorder = Recorder::create("run.mcap".as_ref(), &[topic])?;
//! # let bytes = to_cdr(&BitState::default()).unwrap_or_default();
//! recorder.record(0, 1_700_000_000_000_000_000, &bytes)?;
//! recorder.finish()?;
//!
//! for message in flexdrill_bag::open("run.mcap".as_ref())? {
//!     let message = message?;
//!     if message.topic.is("twin/bit_state") {
//!         println!("{} {}", message.log_time, message.decode::<BitState>()?.torque);
//!     }
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # Layout
//! - `storage`: the file system, as a trait that tests replace by one that fails.
//! - `part`: one MCAP file under way, with its `sink` and `tally`. `location`: names of the files. `metadata`:
//!   rosbag2's `metadata.yaml`.
//! - `recorder`: a recording that the first error ends. `failover`: one that continues in another file.
//!   `recording_thread`: the same behind a queue, with its `recording_health` and `losses`.
//! - `reader`: [`open`], all files of a bag merged in time order. `parts`: which files these are. `packed`: files that are
//!   compressed. `raw`: one file, of any storage. `mcap_file`: one of MCAP.
//! - `recover`: copies what can be read into a new bag. `gaps`: finds messages that a recording lost.

mod error;
mod failover;
mod gaps;
mod location;
mod losses;
mod mcap_file;
mod metadata;
mod packed;
mod part;
mod parts;
mod qos;
mod raw;
mod reader;
mod recorder;
mod recording_health;
mod recording_thread;
mod recover;
mod sink;
mod storage;
mod tally;
mod topic;

pub use error::BagError;
pub use gaps::{Gap, Gaps};
pub use losses::Losses;
pub use parts::PartFault;
pub use qos::from_yaml as qos_from_yaml;
pub use raw::{BagFile, OpenSqlite, RawMessage, read_sqlite_with};
pub use reader::{Bag, BagMessage, Cut, is_bag, open};
pub use recorder::{Recorder, Recording};
pub use recording_health::{Problem, RecordingHealth};
pub use recording_thread::RecordingThread;
pub use recover::{Recovered, recover, recover_with};
pub use storage::{Disk, FileId, Storage, StorageFile};
pub use topic::Topic;
