//! `flexdrill dashboard`: the rig page.

mod browser;

use std::cell::OnceCell;
use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use super::{WrongUse, signals};
use crate::cli::output::say;
use crate::dashboard::{Dashboard, Source, Token};
use crate::dds::network::Network;
use crate::node::DEFAULT_NODE_NAME;
use crate::ros::args::{NodeIdentity, RosArgs};
use flexdrill_ros2::logging;

/// Serve a page that shows a running twin or a recording in a browser; with --allow-control it also steers.
#[derive(Debug, Args)]
pub(super) struct DashboardArgs {
    /// Address to listen at. At an address beyond this machine, any client can look, and the token is sent unencrypted.
    #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Show this recording instead of a running twin: MCAP, SQLite or their folder.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["namespace", "node", "domain", "allow_control"])]
    bag: Option<PathBuf>,
    /// DDS domain, 0 to 232; default ROS_DOMAIN_ID or 0.
    #[arg(long, value_name = "ID")]
    domain: Option<u16>,
    /// Namespace of the twin.
    #[arg(long, value_name = "NS", default_value = "/")]
    namespace: String,
    /// Name of the twin's node.
    #[arg(long, value_name = "NAME", default_value = DEFAULT_NODE_NAME)]
    node: String,
    /// Let clients with the token steer, acknowledge and shelve alarms, pause and reset.
    #[arg(long)]
    allow_control: bool,
    /// File with the token; without it the program prints a new one.
    #[arg(long, value_name = "FILE", requires = "allow_control")]
    token_file: Option<PathBuf>,
    /// Admit a viewer from this page too, such as https://viewer.example, or file:// for viewers opened from a file;
    /// pages of this machine and of Foxglove are always admitted.
    #[arg(long, value_name = "ORIGIN")]
    allow_origin: Vec<String>,
    /// Show the joints of this table of `flexdrill life` in the panel Life; a node with --life adds to it while it runs.
    #[arg(long, value_name = "FILE.csv")]
    life: Option<PathBuf>,
    /// Open the page in this machine's browser.
    #[arg(long)]
    open: bool,
}

/// # Errors
/// When the address, DDS, the token or the bag cannot be used.
pub(super) fn run(args: &DashboardArgs) -> anyhow::Result<()> {
    logging::start(&RosArgs::default());
    let source = match &args.bag {
        Some(path) => Source::Bag(path.clone()),
        None => {
            let (network, notes) =
                Network::read(args.domain, |name| std::env::var(name).ok()).map_err(WrongUse::new)?;
            for note in notes {
                tracing::warn!("{note}");
            }
            let token = Token::where_allowed(args.allow_control, args.token_file.as_deref())?;
            Source::Twin {
                network,
                twin: NodeIdentity::new(&args.namespace, &args.node).map_err(WrongUse::new)?,
                token,
            }
        }
    };
    let dashboard = Dashboard {
        address: args.listen,
        origins: args.allow_origin.clone(),
        source,
        life: args.life.clone(),
    };
    // The file that redirects the browser exists as long as the server runs.
    let redirect = OnceCell::new();
    let ready = |url: &str| {
        say!("dashboard at {url}");
        say!("live data for Foxglove at ws://{}/live; Ctrl-C ends it", host_of(url));
        if args.open {
            // `ready` is called once.
            let _ = redirect.set(browser::open(url));
        }
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let shutdown = signals::shutdown(false)?;
        Ok(dashboard.run(ready, shutdown).await?)
    })
}

fn host_of(url: &str) -> &str {
    let rest = url.strip_prefix("http://").unwrap_or(url);
    rest.split('/').next().unwrap_or_default()
}
