//! Helpers of the tests that run the binary: a network of their own, programs in it that end with the test, and a DDS
//! program of another vendor that does what it is told.

#![allow(dead_code)] // Each test file uses some of it.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// A network namespace with nothing but the loopback interface, so that tests do not see each other.
pub struct Network {
    holder: Child,
    root: bool,
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
        Some(Self { holder, root })
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
            "CYCLONEDDS_URI",
        ] {
            command.env_remove(variable);
        }
        command
    }

    /// The twin, with a configuration that a busy machine can hold, and these arguments.
    pub fn twin(&self, arguments: &[&str]) -> Program {
        let mut command = self.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.args(["run", "--config"]).arg(small_config()).args(arguments);
        Program::start(command)
    }

    /// The DDS program of another vendor; `None` where Python has no cyclonedds.
    pub fn peer(&self) -> Option<Peer> {
        let python = python()?;
        let mut command = self.command(python);
        command.arg(root().join("tests/python/peer.py"));
        Some(Peer::start(command))
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        let _ = self.holder.kill();
        let _ = self.holder.wait();
    }
}

fn skipped<T>(why: &str) -> Option<T> {
    eprintln!("SKIPPED: {why}");
    None
}

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A small tool in the same well: what is tested here is the node, not the mechanics.
pub fn small_config() -> PathBuf {
    root().join("tests/data/small.yaml")
}

/// The Python with cyclonedds: FLEXDRILL_PYTHON, or the one that test.sh makes.
pub fn python() -> Option<PathBuf> {
    let candidates = [
        std::env::var_os("FLEXDRILL_PYTHON").map(PathBuf::from),
        Some(root().join(".venv/bin/python")),
    ];
    for python in candidates.into_iter().flatten() {
        let has = Command::new(&python)
            .args(["-c", "import cyclonedds"])
            .stderr(Stdio::null())
            .status();
        if has.is_ok_and(|status| status.success()) {
            return Some(python);
        }
    }
    skipped("no Python with cyclonedds; run launch_scripts/test.sh or set FLEXDRILL_PYTHON")
}

/// A program that ends with the test, and what it says.
pub struct Program {
    child: Child,
    lines: Receiver<String>,
    said: Vec<String>,
}

impl Program {
    /// Starts it; both its outputs are read.
    pub fn start(mut command: Command) -> Self {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, lines) = channel();
        let errors = sender.clone();
        let stdout = child.stdout.take().unwrap();
        let stderr = child.stderr.take().unwrap();
        std::thread::spawn(move || {
            BufReader::new(stdout)
                .lines()
                .map_while(Result::ok)
                .for_each(|line| drop(sender.send(line)))
        });
        std::thread::spawn(move || {
            BufReader::new(stderr)
                .lines()
                .map_while(Result::ok)
                .for_each(|line| drop(errors.send(line)))
        });
        Self {
            child,
            lines,
            said: Vec::new(),
        }
    }

    /// Waits until it says something with this in it.
    pub fn wait_for(&mut self, text: &str) -> String {
        let deadline = Instant::now() + Duration::from_secs(60);
        while let Ok(line) = self
            .lines
            .recv_timeout(deadline.saturating_duration_since(Instant::now()))
        {
            self.said.push(line.clone());
            if line.contains(text) {
                return line;
            }
        }
        panic!("never said '{text}', but:\n{}", self.said.join("\n"));
    }

    /// All it has said.
    pub fn said(&mut self) -> String {
        self.said.extend(self.lines.try_iter());
        self.said.join("\n")
    }

    /// Sends a signal by its name: INT, TERM, KILL, STOP, CONT.
    pub fn signal(&self, name: &str) {
        let status = Command::new("kill")
            .args(["-s", name, &self.child.id().to_string()])
            .status()
            .unwrap();
        assert!(status.success());
    }

    /// Waits for its end; the exit code.
    pub fn end(&mut self) -> Option<i32> {
        let deadline = Instant::now() + Duration::from_secs(30);
        while Instant::now() < deadline {
            if let Some(status) = self.child.try_wait().unwrap() {
                // What it said last is still on its way.
                std::thread::sleep(Duration::from_millis(50));
                return status.code();
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        panic!("it did not end:\n{}", self.said());
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// `tests/python/peer.py`, told by JSON lines.
pub struct Peer {
    child: Child,
    answers: Receiver<String>,
}

impl Peer {
    fn start(mut command: Command) -> Self {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let stdout = child.stdout.take().unwrap();
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            BufReader::new(stdout)
                .lines()
                .map_while(Result::ok)
                .for_each(|line| drop(sender.send(line)))
        });
        let peer = Self { child, answers };
        assert_eq!(peer.answer(), json!({"ready": true}));
        peer
    }

    fn answer(&self) -> Value {
        let line = self
            .answers
            .recv_timeout(Duration::from_secs(60))
            .expect("the peer answers");
        serde_json::from_str(&line).unwrap()
    }

    /// Has a command carried out.
    pub fn tell(&mut self, command: Value) -> Value {
        writeln!(self.child.stdin.as_mut().unwrap(), "{command}").unwrap();
        let answer = self.answer();
        assert!(answer.get("error").is_none(), "{command}: {answer}");
        answer
    }

    /// Subscribes to a topic as `reliable`, `best_effort` or `latched`.
    pub fn subscribe(&mut self, topic: &str, ros_type: &str, kind: &str) {
        self.tell(json!({"do": "subscribe", "topic": topic, "type": ros_type, "kind": kind}));
    }

    /// Takes messages until there are `count` or `seconds` have passed.
    pub fn take(&mut self, topic: &str, count: usize, seconds: f64) -> Vec<Value> {
        let answer = self.tell(json!({"do": "take", "topic": topic, "count": count, "seconds": seconds}));
        answer["messages"].as_array().unwrap().clone()
    }

    /// Receives on these topics for some seconds; per topic `[stamp, written, received]` of each message (ns since 1970).
    pub fn listen(&mut self, topics: &[&str], seconds: f64) -> Vec<Vec<[i64; 3]>> {
        let answer = self.tell(json!({"do": "listen", "topics": topics, "seconds": seconds}));
        topics
            .iter()
            .map(|topic| serde_json::from_value(answer["received"][topic].clone()).unwrap())
            .collect()
    }

    /// Publishes a Float64; a value that is not finite is written as text.
    pub fn send(&mut self, topic: &str, value: Value) {
        let value = json!({"data": value});
        let answer =
            self.tell(json!({"do": "publish", "topic": topic, "type": "std_msgs/msg/Float64", "value": value}));
        assert!(answer["matched"].as_u64().unwrap() > 0, "nobody listens to {topic}");
    }

    /// Calls a service of a plain DDS client.
    pub fn call(&mut self, service: &str, ros_type: &str, request: Value) -> Value {
        self.tell(json!({"do": "call", "service": service, "type": ros_type, "request": request}))["reply"].clone()
    }

    /// Calls a service as rmw_cyclonedds does.
    pub fn call_as_rmw_cyclone(&mut self, service: &str, ros_type: &str, request: Value) -> Value {
        self.tell(json!({"do": "call", "service": service, "type": ros_type, "request": request, "header": true}))["reply"].clone()
    }

    /// Waits until a status fulfils a condition.
    pub fn status_with(&mut self, topic: &str, condition: impl Fn(&Value) -> bool) -> Value {
        let deadline = Instant::now() + Duration::from_secs(30);
        let mut last = Value::Null;
        while Instant::now() < deadline {
            for status in self.take(topic, 1, 1.0) {
                if condition(&status) {
                    return status;
                }
                last = status;
            }
        }
        panic!("no status is as it should be; the last: {last}");
    }

    /// Process id, to stop and go on.
    pub fn signal(&self, name: &str) {
        let status = Command::new("kill")
            .args(["-s", name, &self.child.id().to_string()])
            .status()
            .unwrap();
        assert!(status.success());
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
