//! Plays a recording to Foxglove and Lichtblick in its own time; they play, pause and seek.

use std::net::SocketAddr;
use std::path::Path;
use std::sync::Arc;

use crate::bag;
use crate::cli::output::say;
use crate::cli::signals;
use crate::live::{self, Gateway, Hub, LatchedStates, Player};
use crate::ros::args::RosArgs;
use crate::ros::logging;
use flexdrill_text::printable;

/// Plays a bag at `address` until a signal requests the end.
pub(super) fn show(path: &Path, address: SocketAddr, origins: &[String]) -> anyhow::Result<()> {
    logging::start(&RosArgs::default());
    let listener = live::listen("--foxglove", address)?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let shutdown = signals::shutdown(false)?;
        let bag = bag::open(path)?;
        for fault in bag.faults() {
            tracing::warn!("{}", printable(&fault.to_string()));
        }
        let (start, end) = live::range(&bag, path)?;
        let hub = Hub::new(bag.topics().iter().map(AsRef::as_ref));
        let states = Arc::new(LatchedStates::default());
        read_states(path, Arc::clone(&states))?;
        let playing = Player::start(bag, (start, end), &hub, &states)?;
        say!(
            "playing {} ({:.1} s) at ws://{} for Foxglove and Lichtblick; Ctrl-C ends it",
            printable(&path.display().to_string()),
            (end - start) as f64 * 1e-9,
            listener.local_addr()?
        );
        let gateway = Gateway::new(&hub, None, origins);
        live::serve(listener, live::only_gateway(gateway), shutdown).await?;
        drop(playing);
        anyhow::Ok(())
    })
}

/// Reads the latched topics on a separate thread. The thread only reads, so nothing waits for its end.
fn read_states(path: &Path, states: Arc<LatchedStates>) -> anyhow::Result<()> {
    let mut bag = bag::open(path)?;
    bag.select(|topic| topic.qos.iter().any(|qos| qos.transient_local));
    std::thread::Builder::new().name("reader".into()).spawn(move || {
        // The player reports unreadable parts when it reaches them.
        for message in bag.flatten() {
            states.observe(&message);
        }
    })?;
    Ok(())
}
