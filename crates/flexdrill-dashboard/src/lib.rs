//! The rig page and its server: a separate program that receives the topics as any DDS client does, or plays a bag.
//!
//! One address serves everything. `/` is the page (`web/`); `/live` is the live data, in the protocol of Foxglove and
//! Lichtblick, which may use it too; `/api/...` has the other data for the page, and the requests to the twin:
//! - `GET /api/session`: mode, limits, the tool's stations, a bag's incidents;
//! - `GET /api/pulse`: the server's clock, its instance, the age of its newest data;
//! - `GET /api/history`: the last hour, one frame per second; `GET /api/journal`: the alarms' events;
//! - `GET /api/what_if`: the newest question to the look-ahead with its answers so far;
//! - `GET /api/mappings`: what bridges make of the items of a rig's line;
//! - `GET /api/life`: the joints to inspect, where a table of lives is named;
//! - `GET /api/control`: who steers; `POST /api/control/{steer, release, acknowledge, shelve, unshelve, reset, pause,
//!   confirm_mapping, what_if, cancel_what_if}`, with the token.
//!
//! # Layout
//! - `listen`: from DDS to page and board. `recorded`: from a bag to page and board.
//! - `board`: the server's own knowledge of the twin, with `session`, `history`, `orbits` and `mappings`. `life`: the table of joints' lives. `control`: steering.
//!   `what_if`: questions to the look-ahead.
//! - `api`, `assets`, `snapshots`: HTTP.

mod api;
mod assets;
mod board;
mod control;
mod error;
mod history;
mod life;
mod listen;
mod mappings;
mod orbits;
mod recorded;
mod session;
mod snapshots;
mod what_if;

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::api::{PlayedBag, Shared, SharedAnswers};
use crate::board::Board;
use crate::control::{Control, ControlParts};
pub use crate::error::DashboardError;
use crate::life::LifeTable;
use crate::listen::Listener;
use crate::recorded::Recorded;
use crate::what_if::{WhatIf, WhatIfParts};
use flexdrill_live::{self as live, Gateway, Hub};
use flexdrill_ros2::args::NodeIdentity;
use flexdrill_ros2::dds::network::Network;
use flexdrill_ros2::dds::port::{Port, PortBuilder};

pub use flexdrill_live::Token;

/// The source of the data.
pub enum Source {
    /// A twin over DDS.
    Twin {
        /// Domain and reach.
        network: Network,
        /// The twin's namespace and name.
        twin: NodeIdentity,
        /// The token for steering; without one, no client may steer.
        token: Option<Token>,
    },
    /// A recording.
    Bag(PathBuf),
}

/// The settings of a dashboard.
pub struct Dashboard {
    /// Address to listen at.
    pub address: SocketAddr,
    /// Origins of further pages to admit, such as `https://viewer.example`.
    pub origins: Vec<String>,
    /// The source of the data.
    pub source: Source,
    /// The table of joints' lives (`flexdrill life`) that the page shows.
    pub life: Option<PathBuf>,
}

impl Dashboard {
    /// Serves until `end` completes. `ready` receives the page's URL, with the token if there is one.
    ///
    /// # Errors
    /// When the address, DDS or the bag cannot be used.
    pub async fn run(self, ready: impl FnOnce(&str), end: impl Future<Output = ()>) -> Result<(), DashboardError> {
        // The port is bound before the twin is searched: an occupied port must fail at once.
        let listener = live::listen("--listen", self.address)?;
        let mut url = format!("http://{}/", listener.local_addr()?);
        let life = self.life.map(LifeTable::new).map(Arc::new);
        match self.source {
            Source::Twin { network, twin, token } => {
                // The token is in the fragment of the URL, which browsers do not send and servers do not log.
                if let Some(token) = &token {
                    url = format!("{url}#token={}", token.text());
                }
                // The network starts first; the page would otherwise load and show nothing.
                let live = Live::start(&network, &twin, token).await?;
                let router = api::router(Shared {
                    board: Arc::clone(&live.board),
                    control: live.control.clone(),
                    what_if: live.what_if.clone(),
                    no_control: "steering is off: start the dashboard with --allow-control",
                    gateway: Gateway::new(&live.hub, None, &self.origins),
                    namespace: twin.namespace.clone(),
                    node: twin.full_name(),
                    bag: None,
                    // The instance distinguishes this run from an earlier one, whose open pages must not act on it.
                    instance: api::new_instance()?,
                    answers: SharedAnswers::default(),
                    life,
                });
                ready(&url);
                live::serve(listener, router, end).await?;
                // Leaving the network blocks for a moment.
                tokio::task::spawn_blocking(move || drop(live.port)).await?;
            }
            Source::Bag(path) => {
                // A bag has the same page without control: the same router with nothing to steer.
                let recorded = Recorded::start(&path)?;
                let router = api::router(Shared {
                    board: Arc::clone(&recorded.board),
                    control: None,
                    what_if: None,
                    no_control: "a recording cannot be steered",
                    gateway: Gateway::new(&recorded.hub, None, &self.origins),
                    namespace: recorded.namespace.clone(),
                    node: String::new(),
                    bag: Some(Arc::clone(&recorded.played)),
                    instance: api::new_instance()?,
                    answers: SharedAnswers::default(),
                    life,
                });
                ready(&url);
                live::serve(listener, router, end).await?;
            }
        }
        Ok(())
    }
}

/// A twin over DDS.
struct Live {
    hub: Arc<Hub>,
    board: Arc<Board>,
    control: Option<Arc<Control>>,
    what_if: Option<Arc<WhatIf>>,
    port: Port,
}

impl Live {
    async fn start(network: &Network, twin: &NodeIdentity, token: Option<Token>) -> Result<Self, DashboardError> {
        let mut random = [0; 8];
        live::fill_random(&mut random)?;
        // The process id makes the node's name unique, so that the twin can distinguish several dashboards.
        let own = NodeIdentity::new(&twin.namespace, &format!("flexdrill_dashboard_{}", std::process::id()))?;
        let mut port = PortBuilder::new(network, &own.namespace, &own.name);
        let listener = Listener::new(&mut port, twin)?;
        let identity = u64::from_le_bytes(random);
        let control = match token {
            Some(token) => Some((
                token,
                ControlParts::new(&mut port, &own, twin, identity)?,
                WhatIfParts::new(&mut port, twin, identity)?,
            )),
            None => None,
        };
        let hub = Hub::new(listener.topics());
        let board = Arc::new(Board::live());
        let port = tokio::task::spawn_blocking(move || port.start()).await??;
        listener.listen(&hub, &board);
        let (control, what_if) = control
            .map(|(token, parts, what_if)| {
                let control = Control::new(token, port.monitor(), parts);
                (Arc::new(control), WhatIf::new(port.monitor(), what_if, identity))
            })
            .unzip();
        if let Some(control) = &control {
            tokio::spawn(steer(Arc::clone(control), Arc::clone(&board)));
        }
        Ok(Self {
            hub,
            board,
            control,
            what_if,
            port,
        })
    }
}

async fn steer(control: Arc<Control>, board: Arc<Board>) {
    let mut tick = tokio::time::interval(control::PERIOD);
    tick.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    loop {
        tick.tick().await;
        if control.is_steering() {
            let status = board.status();
            control.tick(status.as_ref().map(|(status, arrived)| (status, *arrived)));
        }
    }
}

/// The system's clock (ns since 1970).
fn now() -> i64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_nanos() as i64)
}
