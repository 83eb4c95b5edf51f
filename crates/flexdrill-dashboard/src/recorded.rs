//! A bag as the source: the player plays it, and one more pass reads it for history, journal and incidents.

use crate::DashboardError;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::PlayedBag;
use crate::board::Board;
use crate::history::CAPACITY;
use crate::listen::CDR_HEADER;
use flexdrill_bag::{Bag, BagMessage};
use flexdrill_live::{Hub, LatchedStates, Player, Playing};
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_text::{log_ending, printable};

/// A bag that is played.
pub(crate) struct Recorded {
    pub hub: Arc<Hub>,
    pub board: Arc<Board>,
    pub played: Arc<PlayedBag>,
    pub namespace: String,
    /// Dropping it ends the playback.
    _playing: Playing,
}

impl Recorded {
    /// Starts to play and to read the bag.
    pub fn start(path: &Path) -> Result<Self, DashboardError> {
        let bag = flexdrill_bag::open(path)?;
        for fault in bag.faults() {
            tracing::warn!("{}", printable(&fault.to_string()));
        }
        let (start, end) = flexdrill_live::range(&bag, path)?;
        let hub = Hub::new(bag.topics().iter().map(AsRef::as_ref));
        let namespace = bag
            .topics()
            .iter()
            .find_map(|topic| topic.namespace(topics::STATUS.name).map(str::to_owned));
        let states = Arc::new(LatchedStates::default());
        let seconds = (end - start).div_ceil(CAPACITY as u64 * 1_000_000_000);
        let board = Arc::new(Board::of_bag(u32::try_from(seconds).unwrap_or(u32::MAX)));
        board.with_history(|history| history.set_complete(false));
        let played = Arc::new(PlayedBag {
            name: path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned())
                .unwrap_or_default(),
            start,
            end,
            ready: AtomicBool::new(false),
        });
        let pass = FullPass {
            bag: flexdrill_bag::open(path)?,
            board: Arc::clone(&board),
            states: Arc::clone(&states),
            played: Arc::clone(&played),
        };
        // The thread only reads, so nothing waits for its end.
        std::thread::Builder::new()
            .name("reader".into())
            .spawn(move || pass.run())?;
        let playing = Player::start(bag, (start, end), &hub, &states)?;
        Ok(Self {
            hub,
            board,
            played,
            namespace: namespace.unwrap_or_else(|| "/".to_owned()),
            _playing: playing,
        })
    }
}

/// The pass over the whole bag.
struct FullPass {
    bag: Bag,
    board: Arc<Board>,
    states: Arc<LatchedStates>,
    played: Arc<PlayedBag>,
}

impl FullPass {
    fn run(mut self) {
        let began = std::time::Instant::now();
        for message in self.bag.by_ref() {
            match message {
                Ok(message) => {
                    self.states.observe(&message);
                    if let Some((topic, body)) = known(&message) {
                        self.board.observe(topic, body, message.log_time);
                    }
                }
                Err(error) => {
                    if let Some(more) = log_ending("defect of the bag") {
                        tracing::warn!("{}{more}", printable(&error.to_string()));
                    }
                }
            }
        }
        self.board.with_history(super::history::History::finish);
        self.played.ready.store(true, Ordering::Release);
        tracing::info!("read the whole bag in {:.1} s", began.elapsed().as_secs_f64());
    }
}

/// The node's topic of a message, and the message's CDR body.
fn known(message: &BagMessage) -> Option<(&'static TopicInfo, &[u8])> {
    let is_it = |topic: &&TopicInfo| message.topic.is(topic.name) && message.topic.check(topic.kind.ros_type).is_ok();
    let topic = topics::ALL.iter().find(is_it)?;
    Some((topic, message.data.strip_prefix(&CDR_HEADER)?))
}
