//! `flexdrill bridge opcua`: the twin as a server of OPC UA, or a rig's server as a source.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use super::ros_side::RosSideArgs;

/// Serve the twin over OPC UA, or follow a rig's server.
///
/// Clients read without a password. With --users and --allow-write a user may write targets, which drive the twin like
/// any other input.
#[derive(Debug, Args)]
#[cfg_attr(
    not(feature = "opcua"),
    allow(dead_code, reason = "a program without OPC UA only says so")
)]
pub(super) struct OpcuaArgs {
    #[command(flatten)]
    side: SideArgs,
    /// Host name or address in the URLs that clients receive; default that of --listen.
    #[arg(long, value_name = "HOST", requires = "listen")]
    host: Option<String>,
    /// Users with their passwords: one NAME:PASSWORD per line, readable by this user alone.
    #[arg(long, value_name = "FILE", requires = "listen")]
    users: Option<PathBuf>,
    /// Let these users write targets.
    #[arg(long, requires = "users")]
    allow_write: bool,
    /// Let clients connect without encryption; on loopback they always may.
    #[arg(long, requires = "listen")]
    unencrypted: bool,
    /// Mapping of the rig's nodes to quantities and units (YAML).
    #[arg(long, value_name = "FILE", requires = "connect")]
    map: Option<PathBuf>,
    /// Encrypt the connection to the rig's server.
    #[arg(long, requires = "connect")]
    encrypt: bool,
    /// User at the rig's server; anonymous without.
    #[arg(long, value_name = "NAME", requires_all = ["connect", "password_file"])]
    user: Option<String>,
    /// File with the password of the user, in its first line.
    #[arg(long, value_name = "FILE", requires = "user")]
    password_file: Option<PathBuf>,
    /// Folder for certificates; default $XDG_STATE_HOME/flexdrill/opcua or ~/.local/state/flexdrill/opcua.
    #[arg(long, value_name = "DIR")]
    state: Option<PathBuf>,
    #[command(flatten)]
    ros: RosSideArgs,
}

/// The side that the bridge takes; exactly one.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct SideArgs {
    /// Serve the twin at this address.
    #[arg(long, value_name = "ADDRESS:PORT")]
    listen: Option<SocketAddr>,
    /// Follow the rig's server.
    #[arg(long, value_name = "opc.tcp://HOST:PORT", requires = "map")]
    connect: Option<String>,
}

/// # Errors
/// Always: this program has no OPC UA.
#[cfg(not(feature = "opcua"))]
pub(super) fn run(_args: &OpcuaArgs, _ros_args: &[String]) -> anyhow::Result<()> {
    Err(super::super::absent::refusal("OPC UA", "opcua"))
}

#[cfg(feature = "opcua")]
pub(super) use with_opcua::run;

#[cfg(feature = "opcua")]
mod with_opcua {
    use std::io::Read as _;
    use std::net::SocketAddr;
    use std::os::unix::fs::PermissionsExt as _;
    use std::path::{Path, PathBuf};

    use anyhow::Context as _;
    use flexdrill_bridge::opcua::client::Place;
    use flexdrill_bridge::opcua::keys::{Application, Keys, own_name};
    use flexdrill_bridge::opcua::mapping::NodeMapping;
    use flexdrill_bridge::opcua::server::Setup;
    use flexdrill_bridge::opcua::state::TwinState;
    use flexdrill_bridge::opcua::users::Users;
    use flexdrill_text::printable;

    use super::super::super::{WrongUse, signals};
    use super::super::ros_side::RosSide;
    use super::OpcuaArgs;
    use crate::bridge::Outgoing;
    use crate::bridge::opcua::{RigBridge, ServerBridge};
    use crate::cli::output::say;
    use crate::state_file;

    /// Name of the node unless it is remapped.
    const NODE_NAME: &str = "flexdrill_bridge_opcua";
    /// Largest file with a password (bytes).
    const LARGEST_FILE: u64 = 4096;

    /// # Errors
    /// When the options are wrong, or a file, a port or the network cannot be used. A rig's server that is not there is
    /// waited for.
    pub fn run(args: &OpcuaArgs, ros_args: &[String]) -> anyhow::Result<()> {
        let ros = args.ros.start(ros_args, NODE_NAME)?;
        // Signing and encrypting take milliseconds, in which the other clients are served.
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()?;
        runtime.block_on(async {
            match (args.side.listen, &args.side.connect) {
                (Some(address), _) => serve(args, address, &ros).await,
                (None, Some(url)) => follow(args, url, &ros).await,
                (None, None) => Err(WrongUse::new("one of --listen and --connect is needed").into()),
            }
        })?;
        say!("stopped");
        Ok(())
    }

    async fn serve(args: &OpcuaArgs, address: SocketAddr, ros: &RosSide) -> anyhow::Result<()> {
        let users = match &args.users {
            Some(file) => Users::load(file)?,
            None => Users::default(),
        };
        // Clients compare the certificate with the host that they were given. An
        // unspecified address is no name, so the machine's stands for it.
        let host = args.host.clone().unwrap_or_else(|| match address.ip() {
            ip if ip.is_unspecified() => own_name(),
            ip => ip.to_string(),
        });
        let (keys, application_uri) = args.keys(Some(&host))?;
        // The port is bound before the configuration of the server: port 0 is only known afterwards, and an occupied
        // one must end the program.
        let listening = tokio::net::TcpListener::bind(address).await;
        let listener = listening.with_context(|| format!("--listen {address}"))?;
        let address = listener.local_addr()?;
        let loopback = address.ip().is_loopback();
        let setup = Setup {
            host: match &host {
                // An address of IPv6 stands in brackets in a URL.
                host if host.contains(':') => format!("[{host}]"),
                host => host.clone(),
            },
            application_uri,
            keys,
            users,
            allow_write: args.allow_write,
            // On the loopback nothing can be overheard, so clients without certificates may come.
            unencrypted: args.unencrypted || loopback,
            plain_passwords: loopback,
        };
        let topics: Vec<_> = TwinState::topics().collect();
        // Without writing the node has no publisher of inputs at all: then a fault in the server cannot send any.
        let sends: &[Outgoing] = if args.allow_write {
            &[Outgoing::Diagnostics, Outgoing::Inputs]
        } else {
            &[Outgoing::Diagnostics]
        };
        let node = ros.node(sends, &topics, None)?;
        let place = format!("opc.tcp://{}:{}/", setup.host, address.port());
        say!(
            "opcua at {place}, {}, {}, certificates in {}, domain {}; Ctrl-C ends it",
            if setup.unencrypted {
                "with and without encryption"
            } else {
                "encrypted"
            },
            if setup.allow_write {
                "targets can be written by users"
            } else {
                "read only"
            },
            setup.keys.folder().display(),
            ros.network.domain_id
        );
        let mut bridge = ServerBridge::new(node, ros.identity.full_name(), place, setup);
        let shutdown = signals::shutdown(false)?;
        tokio::select! {
            () = shutdown => {}
            () = bridge.run(&listener) => {}
        }
        Ok(())
    }

    async fn follow(args: &OpcuaArgs, url: &str, ros: &RosSide) -> anyhow::Result<()> {
        let file = args
            .map
            .as_ref()
            .ok_or_else(|| WrongUse::new("--connect needs --map"))?;
        let mapping = NodeMapping::load(file)?;
        if !url.starts_with("opc.tcp://") {
            let text = format!("--connect {}: it must begin with opc.tcp://", printable(url));
            return Err(WrongUse::new(text).into());
        }
        let user = match (&args.user, &args.password_file) {
            (Some(user), Some(file)) => Some((user.clone(), password(file)?)),
            _ => None,
        };
        if user.is_some() && !args.encrypt {
            tracing::warn!("opcua: the password may cross the network unencrypted; give --encrypt");
        }
        let (keys, application_uri) = args.keys(None)?;
        let place = Place {
            url: url.to_owned(),
            encrypt: args.encrypt,
            user,
            keys: keys.folder().to_owned(),
            application_uri,
        };
        let node = ros.node(&Outgoing::OF_A_RIG, &[], None)?;
        say!(
            "opcua from {} to {}, {} nodes, domain {}; Ctrl-C ends it",
            printable(url),
            node.topics()[..3].join(", "),
            mapping.nodes.len(),
            ros.network.domain_id
        );
        let mut bridge = RigBridge::new(node, ros.identity.full_name(), url, &mapping);
        let shutdown = signals::shutdown(false)?;
        tokio::select! {
            () = shutdown => {}
            () = bridge.run(place, &mapping) => {}
        }
        Ok(())
    }

    impl OpcuaArgs {
        /// The folder of certificates and the URI that ours names.
        fn keys(&self, host: Option<&str>) -> anyhow::Result<(Keys, String)> {
            let folder: PathBuf = match &self.state {
                Some(folder) => folder.clone(),
                None => state_file::default_folder(|name| std::env::var(name).ok())
                    .context("there is no home folder for certificates; name one with --state DIR")?
                    .join("opcua"),
            };
            let uri = format!("urn:{}:flexdrill", own_name());
            let application = Application {
                name: "flexdrill",
                uri: &uri,
                host,
            };
            Ok((Keys::open(&folder, application)?, uri))
        }
    }

    /// The first line of a file that only its user can read.
    fn password(path: &Path) -> anyhow::Result<String> {
        let name = path.display();
        let file = std::fs::File::open(path).with_context(|| format!("{name}"))?;
        let mode = file.metadata()?.permissions().mode() & 0o777;
        if mode & 0o077 != 0 {
            anyhow::bail!("{name}: others on this machine may read it (mode {mode:03o}); chmod 600 {name}");
        }
        let mut text = String::new();
        file.take(LARGEST_FILE)
            .read_to_string(&mut text)
            .with_context(|| format!("{name}"))?;
        let line = text.lines().next().unwrap_or_default();
        if line.is_empty() {
            anyhow::bail!("{name}: the first line is empty; it must hold the password");
        }
        Ok(line.to_owned())
    }
}
