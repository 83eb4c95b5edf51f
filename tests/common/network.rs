//! A network that nobody else is in.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use super::peer::Peer;
use super::program::Program;
use super::skip::skipped;
use super::{fast, python, root, small_config};

/// A network namespace with nothing but the loopback interface, so that tests do not see each other.
pub struct Network {
    holder: Child,
    root: bool,
    /// What a node keeps over a restart, it keeps here.
    state: tempfile::TempDir,
}

impl Network {
    /// A new one; `None`, with a line that says so, where the system does not allow it.
    pub fn new() -> Option<Self> {
        let root = Command::new("id")
            .arg("-u")
            .output()
            .is_ok_and(|out| out.stdout.trim_ascii() == b"0");
        let script = "ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo && echo ready && exec sleep 900";
        let flags = if root { "-n" } else { "-rn" };
        let holder = Command::new("unshare")
            .args([flags, "sh", "-c", script])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut holder = match holder {
            Ok(holder) => holder,
            Err(error) => return skipped(&format!("unshare: {error}")),
        };
        let mut line = String::new();
        let _ = BufReader::new(holder.stdout.take().unwrap()).read_line(&mut line);
        if line.trim() != "ready" {
            let _ = holder.kill();
            let _ = holder.wait();
            return skipped("no private network namespace can be made (needs root or user namespaces, and iproute2)");
        }
        let state = tempfile::tempdir().unwrap();
        Some(Self { holder, root, state })
    }

    /// A process that lives in it.
    pub fn id(&self) -> u32 {
        self.holder.id()
    }

    /// A command within it.
    pub fn command(&self, program: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new("nsenter");
        command.args(["-t", &self.holder.id().to_string(), "-n"]);
        if !self.root {
            command.args(["-U", "--preserve-credentials"]);
        }
        command.arg("--").arg(program);
        for variable in [
            "ROS_DOMAIN_ID",
            "ROS_LOCALHOST_ONLY",
            "ROS_AUTOMATIC_DISCOVERY_RANGE",
            "RUST_LOG",
            "ROS_STATIC_PEERS",
            "CYCLONEDDS_URI",
        ] {
            command.env_remove(variable);
        }
        command.env("XDG_STATE_HOME", self.state.path());
        command
    }

    /// Runs a command within it; whether it succeeded.
    pub fn done(&self, command: &[&str]) -> bool {
        let out = self.command(command[0]).args(&command[1..]).output();
        out.is_ok_and(|out| out.status.success())
    }

    /// The folder that states are kept in.
    pub fn state(&self) -> &Path {
        self.state.path()
    }

    /// The twin, with a configuration that a busy machine can hold, and these arguments.
    pub fn twin(&self, arguments: &[&str]) -> Program {
        let mut command = self.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.args(["run", "--config"]).arg(small_config()).args(arguments);
        Program::start(command)
    }

    /// The DDS program of another vendor; `None` where Python has no cyclonedds.
    pub fn peer(&self) -> Option<Peer> {
        self.peer_with(&[])
    }

    /// The same with variables of its environment.
    pub fn peer_with(&self, variables: &[(&str, &str)]) -> Option<Peer> {
        let mut command = self.command(python::with("cyclonedds")?);
        command.arg(root().join("tests/python/peer.py"));
        command.envs(variables.iter().copied());
        Some(Peer::start(command))
    }

    /// The DDS program on Fast DDS; `None` where that is not.
    pub fn fast_peer(&self) -> Option<Peer> {
        self.fast_peer_with(&[])
    }

    /// The same with variables of its environment.
    pub fn fast_peer_with(&self, variables: &[(&str, &str)]) -> Option<Peer> {
        let mut command = self.command(fast::program()?);
        command.envs(variables.iter().copied());
        Some(Peer::start(command))
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        let _ = self.holder.kill();
        let _ = self.holder.wait();
    }
}
