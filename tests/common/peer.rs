//! A DDS program of another vendor.

use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::program::{forward, signal};

/// `tests/python/peer.py`, driven by JSON lines.
pub struct Peer {
    child: Child,
    answers: Receiver<String>,
}

impl Peer {
    pub(super) fn start(mut command: Command) -> Self {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let stdout = child.stdout.take().unwrap();
        let (sender, answers) = channel();
        forward(stdout, sender);
        let peer = Self { child, answers };
        assert_eq!(peer.answer(), json!({"ready": true}));
        peer
    }

    /// Gives a command whose answer is taken later, by [`Self::answer`].
    pub fn ask(&mut self, command: &Value) {
        writeln!(self.child.stdin.as_mut().unwrap(), "{command}").unwrap();
    }

    /// The answer to what was asked.
    pub fn answer(&self) -> Value {
        let line = self
            .answers
            .recv_timeout(Duration::from_secs(60))
            .expect("the peer answers");
        serde_json::from_str(&line).unwrap()
    }

    /// Has a command carried out; its answer.
    pub fn command(&mut self, command: Value) -> Value {
        self.ask(&command);
        let answer = self.answer();
        assert!(answer.get("error").is_none(), "{command}: {answer}");
        answer
    }

    /// Subscribes to a topic as `reliable`, `best_effort`, `latched` or `hoarding`; the id of the reader.
    pub fn subscribe(&mut self, topic: &str, ros_type: &str, kind: &str) -> String {
        let answer = self.command(json!({"do": "subscribe", "topic": topic, "type": ros_type, "kind": kind}));
        answer["id"].as_str().unwrap().to_owned()
    }

    /// Takes messages until there are `count` or `seconds` have passed.
    pub fn take(&mut self, topic: &str, count: usize, seconds: f64) -> Vec<Value> {
        let answer = self.command(json!({"do": "take", "topic": topic, "count": count, "seconds": seconds}));
        answer["messages"].as_array().unwrap().clone()
    }

    /// Receives on these topics for some seconds; per topic `[stamp, written, received]` of each message (ns since
    /// 1970).
    pub fn listen(&mut self, topics: &[&str], seconds: f64) -> Vec<Vec<[i64; 3]>> {
        let answer = self.command(json!({"do": "listen", "topics": topics, "seconds": seconds}));
        topics
            .iter()
            .map(|topic| serde_json::from_value(answer["received"][topic].clone()).unwrap())
            .collect()
    }

    /// Publishes a Float64; a value that is not finite is written as text.
    pub fn send(&mut self, topic: &str, value: Value) {
        let value = json!({"data": value});
        let answer =
            self.command(json!({"do": "publish", "topic": topic, "type": "std_msgs/msg/Float64", "value": value}));
        assert!(answer["matched"].as_u64().unwrap() > 0, "nobody listens to {topic}");
    }

    /// Calls a service of a plain DDS client.
    pub fn call(&mut self, service: &str, ros_type: &str, request: Value) -> Value {
        self.command(json!({"do": "call", "service": service, "type": ros_type, "request": request}))["reply"].clone()
    }

    /// Calls a service as rmw_cyclonedds does.
    pub fn call_as_rmw_cyclone(&mut self, service: &str, ros_type: &str, request: Value) -> Value {
        self.command(json!({"do": "call", "service": service, "type": ros_type, "request": request, "header": true}))["reply"].clone()
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

    /// Sends a signal by its name, to stop it and let it go on.
    pub fn signal(&self, name: &str) {
        signal(&self.child, name);
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
