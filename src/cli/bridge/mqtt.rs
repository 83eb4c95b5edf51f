//! `flexdrill bridge mqtt`: the twin's outputs on a broker.

use std::path::PathBuf;

use clap::Args;

use super::super::numbers;
use super::ros_side::RosSideArgs;

/// Publish the twin's outputs on an MQTT broker: JSON documents with units and, if asked for, Sparkplug B.
///
/// Nothing that the broker sends reaches the twin.
#[derive(Debug, Args)]
#[cfg_attr(
    not(feature = "mqtt"),
    allow(dead_code, reason = "a program without MQTT only says so")
)]
pub(super) struct MqttArgs {
    /// The broker. The port is 1883 unless given, and 8883 with TLS.
    #[arg(long, value_name = "HOST[:PORT]")]
    broker: String,
    /// Beginning of the topics. Default: flexdrill, followed by the namespace.
    #[arg(long, value_name = "PREFIX")]
    topic: Option<String>,
    /// User at the broker.
    #[arg(long, value_name = "NAME")]
    user: Option<String>,
    /// File with the password of the user, in its first line.
    #[arg(long, value_name = "FILE", requires = "user")]
    password_file: Option<PathBuf>,
    /// Encrypt; trust the certificates that this system trusts.
    #[arg(long, conflicts_with = "tls_ca")]
    tls: bool,
    /// Encrypt; trust the authorities in this file (PEM).
    #[arg(long, value_name = "FILE")]
    tls_ca: Option<PathBuf>,
    /// Publish as a Sparkplug B node too.
    #[arg(long, value_name = "GROUP/NODE")]
    sparkplug: Option<String>,
    /// Time between two documents with status and figures (s). Alarms are sent when they change.
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = numbers::seconds)]
    every: f64,
    /// Name of the client at the broker. Default: made from the topics.
    #[arg(long, value_name = "NAME")]
    client_id: Option<String>,
    /// Folder for the number of the last Sparkplug session, which the next one continues; default
    /// $XDG_STATE_HOME/flexdrill or ~/.local/state/flexdrill.
    #[arg(long, value_name = "DIR", requires = "sparkplug")]
    state_dir: Option<PathBuf>,
    #[command(flatten)]
    ros: RosSideArgs,
}

/// # Errors
/// Always: this program has no MQTT.
#[cfg(not(feature = "mqtt"))]
pub(super) fn run(_args: &MqttArgs, _ros_args: &[String]) -> anyhow::Result<()> {
    Err(super::super::absent::refusal("MQTT", "mqtt"))
}

#[cfg(feature = "mqtt")]
pub(super) use with_mqtt::run;

#[cfg(feature = "mqtt")]
mod with_mqtt {
    use std::io::Read as _;
    use std::path::Path;
    use std::time::Duration;

    use anyhow::Context as _;
    use flexdrill_bridge::mqtt::{Broker, Documents, LinkTimes, SparkplugNode, Tls};
    use flexdrill_text::{log_ending, printable};
    use tokio::sync::watch;

    use super::super::super::{WrongUse, signals};
    use super::MqttArgs;
    use crate::bridge::mqtt::MqttBridge;
    use crate::bridge::{Outgoing, birth_number};
    use crate::cli::output::say;
    use crate::state_file;

    /// Name of the node unless it is remapped.
    const NODE_NAME: &str = "flexdrill_bridge_mqtt";
    /// Largest file with a password or certificates (bytes).
    const LARGEST_FILE: u64 = 1 << 20;

    /// # Errors
    /// When the options are wrong, or a file or the network cannot be used. A broker that is not there is waited for.
    pub fn run(args: &MqttArgs, ros_args: &[String]) -> anyhow::Result<()> {
        let ros = args.ros.start(ros_args, NODE_NAME)?;
        let broker = args.broker()?;
        // The namespace in the topic keeps two rigs on one broker apart.
        let prefix = match &args.topic {
            Some(prefix) => prefix.clone(),
            None => format!("flexdrill{}", ros.identity.namespace.trim_end_matches('/')),
        };
        let documents = Documents::new(&prefix, args.client_id.as_deref()).map_err(WrongUse::new)?;
        // The name is checked before the network is touched: a wrong one is an
        // error of use, and would never come right by waiting.
        let sparkplug = match &args.sparkplug {
            Some(name) => {
                let parsed = name.parse().map_err(WrongUse::new)?;
                let node = SparkplugNode::new(parsed, args.client_id.as_deref());
                Some(args.continuing(node, name))
            }
            None => None,
        };
        // A warning and not an error: a broker on the same machine is a common case.
        if broker.exposes_password() {
            tracing::warn!("the password crosses the network unencrypted; give --tls-ca or --tls");
        }
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        runtime.block_on(async {
            let topics = MqttBridge::topics();
            let sends = &[Outgoing::Diagnostics];
            let node = ros.node(sends, &topics, None)?;
            let also = args.sparkplug.as_ref();
            say!(
                "mqtt to {broker}{}, topics {prefix}/...{}, domain {}; Ctrl-C ends it",
                if broker.is_encrypted() { " with TLS" } else { "" },
                also.map_or_else(String::new, |name| format!(" and Sparkplug {}", printable(name))),
                ros.network.domain_id
            );
            let every = Duration::from_secs_f64(args.every);
            let mut bridge = MqttBridge::new(node, ros.identity.full_name(), broker, documents, sparkplug, every);
            // Signals are caught before the first connection, so that its end is announced in any case.
            let shutdown = signals::shutdown(false)?;
            // The bridge ends by a channel, because dropping its future
            // would leave the broker to find out by a timeout.
            let (stop, stopping) = watch::channel(false);
            let mut running = std::pin::pin!(bridge.run(LinkTimes::default(), stopping));
            tokio::select! {
                () = shutdown => {
                    // The bridge announces its end, so that the broker need not find out by a timeout.
                    stop.send_replace(true);
                    running.await;
                }
                () = &mut running => {}
            }
            anyhow::Ok(())
        })?;
        say!("stopped");
        Ok(())
    }

    impl MqttArgs {
        /// The node with the numbers of births after those of its last session. Without them it works too: only a death
        /// that arrives late may then end the new session.
        fn continuing(&self, node: SparkplugNode, name: &str) -> SparkplugNode {
            let folder = self.state_dir.clone();
            let Some(folder) = folder.or_else(|| state_file::default_folder(|name| std::env::var(name).ok())) else {
                tracing::warn!(
                    "the number of this Sparkplug session is not kept, because there is no home folder; use --state-dir"
                );
                return node;
            };
            let file = folder.join(birth_number::file_name(name));
            let last = birth_number::read(&file).unwrap_or_else(|error| {
                tracing::warn!("{error}");
                None
            });
            node.continuing(last, move |number| {
                if let Err(error) = birth_number::write(&file, number)
                    && let Some(more) = log_ending("number of a Sparkplug session not written")
                {
                    tracing::warn!(
                        "{}: the number of this Sparkplug session cannot be written: {error}; after a restart the numbers \
                         begin again; --state-dir selects another folder{more}",
                        file.display()
                    );
                }
            })
        }

        fn broker(&self) -> anyhow::Result<Broker> {
            let tls = match &self.tls_ca {
                Some(file) => Tls::Authority(read("--tls-ca", file)?),
                None if self.tls => Tls::System,
                None => Tls::None,
            };
            let password = match &self.password_file {
                Some(file) => {
                    let bytes = read("--password-file", file)?;
                    let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
                    let password = line.strip_suffix(b"\r").unwrap_or(line).to_vec();
                    anyhow::ensure!(
                        !password.is_empty(),
                        "--password-file {}: the first line is empty; the password belongs there",
                        file.display()
                    );
                    warn_of_readers(file);
                    password
                }
                None => Vec::new(),
            };
            let user = self.user.clone().map(|user| (user, password));
            let broker = Broker::new(&self.broker, tls, user);
            broker.map_err(|error| match &self.tls_ca {
                Some(file) => anyhow::anyhow!(
                    "--broker {}, --tls-ca {}: {error}",
                    printable(&self.broker),
                    file.display()
                ),
                None => WrongUse::new(format!("--broker: {error}")).into(),
            })
        }
    }

    fn read(option: &str, file: &Path) -> anyhow::Result<Vec<u8>> {
        let place = || format!("{option} {}", file.display());
        let mut bytes = Vec::new();
        let opened = std::fs::File::open(file).with_context(place)?;
        opened
            .take(LARGEST_FILE + 1)
            .read_to_end(&mut bytes)
            .with_context(place)?;
        anyhow::ensure!(
            bytes.len() as u64 <= LARGEST_FILE,
            "{}: the file has more than {LARGEST_FILE} bytes; is it the right one?",
            place()
        );
        Ok(bytes)
    }

    /// Warns when other users can read the password.
    fn warn_of_readers(file: &Path) {
        use std::os::unix::fs::PermissionsExt as _;
        let mode = std::fs::metadata(file).map_or(0, |data| data.permissions().mode());
        if mode & 0o077 != 0 {
            tracing::warn!(
                "--password-file {}: other users can read it; chmod 600 protects it",
                file.display()
            );
        }
    }
}
