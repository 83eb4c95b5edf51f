//! A browser's requests and a foreign viewer's, from within a network.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;

use super::{Network, python, root};

impl Network {
    /// Runs a script of `tests/python/` within the network; the JSON object that it answers. `None`, with a line that says
    /// so, where Python lacks `package`.
    ///
    /// # Panics
    /// When the script fails.
    pub fn python(&self, package: &str, script: &str, arguments: &[&str], input: &str) -> Option<Value> {
        let mut command = self.command(python::with(package)?);
        let mut child = command
            .arg(root().join("tests/python").join(script))
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
        let output = child.wait_with_output().unwrap();
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            output.status.success(),
            "{script} {arguments:?}:\n{printed}{}",
            String::from_utf8_lossy(&output.stderr)
        );
        Some(serde_json::from_str(&printed).unwrap())
    }

    /// One HTTP request.
    pub fn http(&self, method: &str, url: &str, headers: &[&str], body: &str) -> Option<Value> {
        let arguments: Vec<&str> = [method, url].into_iter().chain(headers.iter().copied()).collect();
        self.python("json", "http_client.py", &arguments, body)
    }

    /// A foreign viewer of the Foxglove protocol.
    pub fn viewer(&self, arguments: &[&str]) -> Option<Value> {
        self.python("websockets", "viewer.py", arguments, "")
    }
}
