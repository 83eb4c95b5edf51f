//! The page beside the rig: its server, a program of its own that sees what any client of DDS sees, or plays a bag.
//!
//! All is behind one address. `/` is the page; `/live` the live data, in the protocol of Foxglove and Lichtblick, which
//! may use it too; `/api/...` what a page needs beside that, and what it may ask of the twin:
//! - `GET /api/session`: mode, limits, the tool's places, a bag's incidents;
//! - `GET /api/pulse`: the server's clock, its instance, the age of its newest data;
//! - `GET /api/history`: the last hour, a frame a second; `GET /api/journal`: the alarms' events;
//! - `GET /api/control`: who steers; `POST /api/control/{steer, release, acknowledge, shelve, unshelve, reset, pause}`, with
//!   the token.
//!
//! `listen`: DDS -> page and board. `recorded`: bag -> page and board. `board`: what the server knows itself, with
//! `session`, `history`. `control`: steering. `api`, `assets`, `token`: HTTP.

mod api;
mod board;
mod control;
mod history;
mod listen;
mod orbits;
mod recorded;
mod session;
mod snapshots;

use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use self::api::{PlayedBag, Shared, Shares};
use self::board::Board;
use self::control::{Control, ControlParts};
use self::listen::Ears;
use self::recorded::Recorded;
use crate::dds::network::Network;
use crate::dds::port::{Port, PortBuilder};
pub use crate::live::Token;
use crate::live::{self, Gateway, Hub};
use crate::ros::args::NodeIdentity;

/// What is shown.
pub enum Source {
    /// A twin over DDS.
    Twin {
        /// Domain and reach.
        network: Network,
        /// The twin's namespace and name.
        twin: NodeIdentity,
        /// Who may steer; nobody without.
        token: Option<Token>,
    },
    /// A recording.
    Bag(PathBuf),
}

/// A dashboard to be.
pub struct Dashboard {
    /// Where to listen.
    pub address: SocketAddr,
    /// Pages of viewers that may look too, as `https://viewer.example`.
    pub origins: Vec<String>,
    /// What is shown.
    pub source: Source,
}

impl Dashboard {
    /// Serves until `end` is done. `ready` is told the address, with the token where there is one.
    ///
    /// # Errors
    /// When the address, DDS or the bag cannot be used.
    pub async fn run(self, ready: impl FnOnce(&str), end: impl Future<Output = ()>) -> anyhow::Result<()> {
        let listener = live::listen("--listen", self.address)?;
        let mut url = format!("http://{}/", listener.local_addr()?);
        match self.source {
            Source::Twin { network, twin, token } => {
                if let Some(token) = &token {
                    url = format!("{url}#token={}", token.text());
                }
                let live = Live::start(&network, &twin, token).await?;
                let router = api::router(Shared {
                    board: Arc::clone(&live.board),
                    control: live.control.clone(),
                    no_control: "steering is off: start the dashboard with --allow-control",
                    gateway: Gateway::new(&live.hub, None, &self.origins),
                    namespace: twin.namespace.clone(),
                    node: twin.full_name(),
                    bag: None,
                    instance: api::new_instance()?,
                    shares: Shares::default(),
                });
                ready(&url);
                live::serve(listener, router, end).await?;
                // Leaving the network takes a moment.
                tokio::task::spawn_blocking(move || drop(live.port)).await?;
            }
            Source::Bag(path) => {
                let recorded = Recorded::start(&path)?;
                let router = api::router(Shared {
                    board: Arc::clone(&recorded.board),
                    control: None,
                    no_control: "a recording cannot be steered",
                    gateway: Gateway::new(&recorded.hub, None, &self.origins),
                    namespace: recorded.namespace.clone(),
                    node: String::new(),
                    bag: Some(Arc::clone(&recorded.played)),
                    instance: api::new_instance()?,
                    shares: Shares::default(),
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
    port: Port,
}

impl Live {
    async fn start(network: &Network, twin: &NodeIdentity, token: Option<Token>) -> anyhow::Result<Self> {
        let mut random = [0; 8];
        live::fill_random(&mut random)?;
        // Several dashboards are several nodes: the twin tells them apart by their names.
        let own = NodeIdentity::new(&twin.namespace, &format!("flexdrill_dashboard_{}", std::process::id()))?;
        let mut port = PortBuilder::new(network, &own.namespace, &own.name);
        let ears = Ears::new(&mut port, twin)?;
        let control = match token {
            Some(token) => Some((
                token,
                ControlParts::new(&mut port, &own, twin, u64::from_le_bytes(random))?,
            )),
            None => None,
        };
        let hub = Hub::new(ears.topics());
        let board = Arc::new(Board::live());
        let port = tokio::task::spawn_blocking(move || port.start()).await??;
        ears.listen(&hub, &board);
        let control = control.map(|(token, parts)| Arc::new(Control::new(token, port.monitor(), parts)));
        if let Some(control) = &control {
            tokio::spawn(steer(Arc::clone(control), Arc::clone(&board)));
        }
        Ok(Self {
            hub,
            board,
            control,
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
