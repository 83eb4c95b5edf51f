//! Bags: recording to MCAP, reading MCAP and rosbag2's SQLite, recovering what a killed recording left.
//!
//! The only module that knows these formats.
//!
//! ```no_run
//! # fn main() -> Result<(), flexdrill::bag::BagError> {
//! use flexdrill::bag::{self, Recorder, Topic};
//! use flexdrill::messages::{BitState, to_cdr, topics};
//!
//! let topic = Topic::new("/rig_7/twin/bit_state", &topics::BIT_STATE.kind, topics::BIT_STATE.qos);
//! let mut recorder = Recorder::create("run.mcap".as_ref(), &[topic])?;
//! # let bytes = to_cdr(&BitState::default()).unwrap_or_default();
//! recorder.record(0, 1_700_000_000_000_000_000, &bytes)?;
//! recorder.finish()?;
//!
//! for message in bag::open("run.mcap".as_ref())? {
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
//! - `storage`: what is asked of the file system. `part`: one MCAP file that is written, by `sink`, with its
//!   `tally`. `recorder`: a recording that the
//!   first error ends; `live`: one that goes on in another file; `recording_thread`: the same behind a queue, with its
//!   `recording_health`. `location`: where the files go. `metadata`: rosbag2's `metadata.yaml`.
//! - `reader`: [`open`], all sources merged in time order. `mcap_file`, `sqlite`: one source each.
//! - `recover`: reading and writing again. `gaps`: what a recording lost.

mod error;
mod gaps;
mod live;
mod location;
mod losses;
mod mcap_file;
mod metadata;
mod part;
mod qos;
mod raw;
mod reader;
mod recorder;
mod recording_health;
mod recording_thread;
mod recover;
mod sink;
mod sqlite;
mod storage;
mod tally;
mod topic;

pub use error::BagError;
pub use gaps::{Gap, Gaps};
pub use losses::Losses;
pub use reader::{Bag, BagMessage, Cut, open};
pub use recorder::{Recorder, Recording};
pub use recording_health::{Problem, RecordingHealth};
pub use recording_thread::RecordingThread;
pub use recover::{Recovered, recover, recover_with};
pub use storage::{Disk, FileId, Storage, StorageFile};
pub use topic::Topic;
