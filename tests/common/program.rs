//! Programs that end with the test.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Sends a signal by its name (INT, TERM, KILL, STOP, CONT) to a process.
pub fn signal(child: &Child, name: &str) {
    signal_id(child.id(), name);
}

/// As [`signal`], by the process's id.
pub fn signal_id(id: u32, name: &str) {
    let status = Command::new("kill")
        .args(["-s", name, &id.to_string()])
        .status()
        .unwrap();
    assert!(status.success());
}

/// Hands on what a program says, line by line.
pub fn forward(output: impl std::io::Read + Send + 'static, to: std::sync::mpsc::Sender<String>) {
    std::thread::spawn(move || {
        BufReader::new(output)
            .lines()
            .map_while(Result::ok)
            .for_each(|line| drop(to.send(line)))
    });
}

/// A program that ends with the test, and what it says.
pub struct Program {
    child: Child,
    lines: Receiver<String>,
    said: Vec<String>,
}

impl Program {
    /// Starts it; both its outputs are read.
    pub fn start(command: Command) -> Self {
        Self::start_at(command, Stdio::null())
    }

    /// As [`Program::start`], with an input.
    pub fn start_at(mut command: Command, input: Stdio) -> Self {
        let mut child = command
            .stdin(input)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (sender, lines) = channel();
        forward(child.stdout.take().unwrap(), sender.clone());
        forward(child.stderr.take().unwrap(), sender);
        Self {
            child,
            lines,
            said: Vec::new(),
        }
    }

    /// Number of the process.
    pub fn id(&self) -> u32 {
        self.child.id()
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

    /// The process that keeps DDS for it, once there is one.
    pub fn dds_process(&self) -> u32 {
        let deadline = Instant::now() + Duration::from_secs(10);
        while Instant::now() < deadline {
            let found = Command::new("pgrep")
                .args(["-P", &self.child.id().to_string()])
                .output()
                .unwrap();
            if let Ok(id) = String::from_utf8_lossy(&found.stdout).trim().parse() {
                return id;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        panic!("it has no process for DDS");
    }

    /// Sends a signal by its name: INT, TERM, KILL, STOP, CONT.
    pub fn signal(&self, name: &str) {
        signal(&self.child, name);
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
