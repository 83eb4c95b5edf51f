//! `flexdrill bridge`: joins the twin's topics to a rig's own protocol, or to a broker.

mod keys;
mod look;
mod mqtt;
mod opcua;
mod ros_side;

use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Duration;

use anyhow::Context as _;
use clap::{Args, Subcommand};

use self::ros_side::RosSideArgs;
use super::{WrongUse, signals};
use crate::bridge::Outgoing;
use crate::bridge::confirmations::Confirmations;
use crate::bridge::first_frames::FirstFrames;
use crate::bridge::wits::WitsBridge;
use crate::cli::output::{say, say_text};
use crate::state_file;
use flexdrill_bridge::TwinFigures;
use flexdrill_bridge::lines::{Place, Times};
use flexdrill_bridge::wits::Mapping;
use flexdrill_messages::topics::{CONFIRM_MAPPING, WITS_BRIDGE};
use flexdrill_text::printable;

/// Join the twin's topics to a rig's own protocol, or to a broker.
#[derive(Debug, Args)]
pub(super) struct BridgeArgs {
    #[command(subcommand)]
    protocol: Protocol,
}

#[derive(Debug, Subcommand)]
enum Protocol {
    Wits(Box<WitsArgs>),
    Mqtt(Box<mqtt::MqttArgs>),
    Opcua(Box<opcua::OpcuaArgs>),
}

/// Read WITS level 0 from a line, and send the twin's figures back.
#[derive(Debug, Args)]
struct WitsArgs {
    #[command(flatten)]
    line: LineArgs,
    /// Bits per second of a serial line; 8 data bits, no parity, one stop bit.
    #[arg(long, value_name = "RATE", default_value_t = 9600, requires = "serial")]
    baud: u32,
    /// Mapping of items to quantities and units (YAML). Default: the usual items in metric units.
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Keep the bytes of the line with their times in a new file.
    #[arg(long, value_name = "FILE")]
    capture: Option<PathBuf>,
    /// Listen for so long (s), print what arrives and what the mapping makes of it, and end. Nothing is published.
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..=86_400), conflicts_with = "capture")]
    look: Option<u32>,
    /// With --look: the mapping to write, with the items that arrived. A file that exists is left as it is.
    #[arg(long, value_name = "FILE", default_value = "site.yaml", requires = "look")]
    site: PathBuf,
    /// Confirm what the mapping makes of each source when its first frame is shown. Without it the values are marked SUSPECT
    /// until a person presses c and Enter, or confirms them on the page. A confirmation is kept for this mapping and this
    /// source.
    #[arg(long, conflicts_with = "look")]
    confirm: bool,
    /// Folder for the confirmations; default $XDG_STATE_HOME/flexdrill or ~/.local/state/flexdrill.
    #[arg(long, value_name = "DIR", conflicts_with = "look")]
    state_dir: Option<PathBuf>,
    #[command(flatten)]
    ros: RosSideArgs,
}

/// The line; exactly one.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct LineArgs {
    /// Connect to the rig's server.
    #[arg(long, value_name = "HOST:PORT", value_parser = host_and_port)]
    connect: Option<String>,
    /// Let the rig connect to this address. Whoever reaches it can drive the twin.
    #[arg(long, value_name = "ADDRESS:PORT")]
    listen: Option<SocketAddr>,
    /// Read a serial line.
    #[arg(long, value_name = "DEVICE")]
    serial: Option<PathBuf>,
}

/// A host and a port. Whether the host is known shows later, and again with every attempt: a rig's network may come after
/// the bridge.
///
/// # Errors
/// When one of the two is missing, which no waiting cures.
fn host_and_port(text: &str) -> Result<String, String> {
    let (host, port) = text
        .rsplit_once(':')
        .ok_or("it has no port; write HOST:PORT, such as 192.168.1.20:5555")?;
    let is_host = !host.is_empty() && !host.chars().any(|letter| letter.is_whitespace() || letter == '/');
    if !is_host {
        return Err("it has no host; write HOST:PORT alone, such as 192.168.1.20:5555".to_owned());
    }
    let is_in_brackets = host.starts_with('[') && host.ends_with(']');
    if host.contains(':') && !is_in_brackets {
        return Err(format!("an IPv6 address stands in brackets: [{host}]:{port}"));
    }
    match port.parse::<u16>() {
        Ok(1..) => Ok(text.to_owned()),
        _ => Err(format!("{port:?} is no port: a port is 1 to 65535")),
    }
}

/// # Errors
/// When the line, a file or the network cannot be used.
pub(super) fn run(args: &BridgeArgs, ros_args: &[String]) -> anyhow::Result<()> {
    match &args.protocol {
        Protocol::Wits(args) => run_wits(args, ros_args),
        Protocol::Mqtt(args) => mqtt::run(args, ros_args),
        Protocol::Opcua(args) => opcua::run(args, ros_args),
    }
}

fn run_wits(args: &WitsArgs, ros_args: &[String]) -> anyhow::Result<()> {
    let ros = args.ros.start(ros_args, WITS_BRIDGE)?;
    let mapping = match &args.map {
        Some(file) => Mapping::load(file)?,
        None => Mapping::default(),
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    if let Some(seconds) = args.look {
        return runtime.block_on(look::run(args, &mapping, Duration::from_secs(seconds.into())));
    }
    runtime.block_on(async {
        let (place, name) = args.line.place(args.baud).await?;
        let receives: &[_] = if mapping.write.is_some() {
            &TwinFigures::TOPICS
        } else {
            &[]
        };
        let sends = &Outgoing::OF_A_RIG;
        let service = (CONFIRM_MAPPING, "flexdrill/srv/ConfirmMapping");
        let node = ros.node(sends, receives, Some(service))?;
        say!(
            "wits {name} to {}, domain {}; Ctrl-C ends it",
            node.topics()[..3].join(", "),
            ros.network.domain_id
        );
        let node_name = ros.identity.full_name();
        let capture = args.capture.as_deref();
        let first = FirstFrames::new(args.confirmations(&mapping)?, args.confirm);
        let mut bridge = WitsBridge::new(node, node_name, name, mapping, capture, first, |text| {
            say_text!("{text}")
        })?;
        let shutdown = signals::shutdown(false)?;
        tokio::select! {
            () = shutdown => {}
            () = bridge.run(place, Times::default(), keys::confirmations()) => {}
        }
        anyhow::Ok(())
    })?;
    say!("stopped");
    Ok(())
}

impl WitsArgs {
    /// The confirmations of the mapping: of the file's bytes and of all that is read with it, because the items that a file
    /// does not name are those of this version of the program.
    fn confirmations(&self, mapping: &Mapping) -> anyhow::Result<Confirmations> {
        let (mut content, name) = match &self.map {
            Some(file) => {
                let content = std::fs::read(file).with_context(|| format!("--map {}", file.display()))?;
                (content, printable(&file.display().to_string()).into_owned())
            }
            None => (Vec::new(), "default".to_owned()),
        };
        content.extend(format!("\n{:?}\n{mapping:?}", mapping.table()).into_bytes());
        let folder = self.state_dir.clone();
        let folder = folder.or_else(|| state_file::default_folder(|name| std::env::var(name).ok()));
        Ok(Confirmations::new(folder, &content, name))
    }
}

impl LineArgs {
    /// The line, and its name for people. A port to listen on is opened at once, so that a wrong one ends the program.
    async fn place(&self, baud: u32) -> anyhow::Result<(Place, String)> {
        if let Some(address) = &self.connect {
            return Ok((Place::Connect(address.clone()), format!("from {address}")));
        }
        if let Some(device) = &self.serial {
            let place = Place::Serial {
                device: device.clone(),
                baud,
            };
            return Ok((place, format!("from {} at {baud} bit/s", device.display())));
        }
        let Some(address) = self.listen else {
            return Err(WrongUse::new("one of --connect, --listen and --serial is needed").into());
        };
        let listening = tokio::net::TcpListener::bind(address).await;
        let listener = listening.with_context(|| format!("--listen {address}"))?;
        let name = format!("at {}", listener.local_addr()?);
        Ok((Place::Listen(listener), name))
    }
}

#[cfg(test)]
mod tests {
    use super::host_and_port;

    #[test]
    fn what_no_waiting_cures_is_refused_at_once() {
        for good in ["192.168.1.20:5555", "rig.local:1", "[::1]:65535"] {
            assert_eq!(host_and_port(good).as_deref(), Ok(good));
        }
        for (wrong, words) in [
            ("nohost", "no port"),
            (":5555", "no host"),
            ("rig:", "1 to 65535"),
            ("rig:0", "1 to 65535"),
            ("rig:70000", "1 to 65535"),
            ("::1:5555", "[::1]:5555"),
            ("tcp://rig:5555", "HOST:PORT alone"),
            ("a rig:5555", "no host"),
        ] {
            let error = host_and_port(wrong).unwrap_err();
            assert!(error.contains(words), "{wrong}: {error}");
        }
    }
}
