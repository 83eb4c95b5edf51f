//! The state of an OPC UA bridge in `/diagnostics`.

use flexdrill_bridge::opcua::values::ValueCounts;
use flexdrill_messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};

use crate::bridge::diagnostics::{array, counts, item};

/// A rig without a value or a sign of life for so long is not OK (s).
const QUIET: f64 = 10.0;
/// A twin without a message for so long is not OK (s).
const SILENT: f64 = 3.0;

/// Seconds since an instant (ns).
fn age(since: Option<i64>, now: i64) -> Option<f64> {
    since.map(|at| now.saturating_sub(at) as f64 * 1e-9)
}

/// What is known of a rig's server.
#[derive(Debug, Clone, Default)]
pub(super) struct RigHealth {
    pub(super) connected: bool,
    pub(super) connections_made: u64,
    pub(super) attempts_failed: u64,
    pub(super) nodes: [u64; 2],
    pub(super) last_loss: String,
    pub(super) heard_at: Option<i64>,
    pub(super) lost: u64,
    pub(super) published: [u64; 2],
    pub(super) counts: ValueCounts,
}

impl RigHealth {
    pub(super) fn diagnostics(&self, node: &str, place: &str, now: i64) -> DiagnosticArray {
        let [followed, refused] = self.nodes;
        let (level, text) = match (self.connected, age(self.heard_at, now)) {
            (false, _) if self.last_loss.is_empty() => (DiagnosticStatus::WARN, "not yet connected".to_owned()),
            (false, _) => (DiagnosticStatus::ERROR, format!("not connected: {}", self.last_loss)),
            (true, Some(age)) if age > QUIET => (
                DiagnosticStatus::WARN,
                format!("connected, no sign of life for {age:.0} s"),
            ),
            (true, _) if refused > 0 => (
                DiagnosticStatus::WARN,
                format!("connected; the server refuses {refused} nodes of the mapping"),
            ),
            (true, _) => (DiagnosticStatus::OK, "values arrive".to_owned()),
        };
        let of_values = &self.counts;
        let values = [
            ("connections_open", u64::from(self.connected)),
            ("connections_made", self.connections_made),
            ("attempts_failed", self.attempts_failed),
            ("nodes_followed", followed),
            ("nodes_refused", refused),
            ("values", of_values.received),
            ("values_bad", of_values.bad),
            ("values_uncertain", of_values.uncertain),
            ("values_no_number", of_values.no_number),
            ("values_out_of_range", of_values.out_of_range),
            ("values_lost", self.lost),
            ("stamps_replaced", of_values.stamps_replaced),
            ("inputs_published", self.published[0]),
            ("measured_published", self.published[1]),
        ];
        array(now, vec![item(node, "opcua", (level, text), place, counts(values))])
    }
}

/// What is known of our server.
#[derive(Debug, Clone, Default)]
pub(super) struct ServerHealth {
    pub(super) open: u64,
    pub(super) opened: u64,
    pub(super) refused: u64,
    pub(super) not_opcua: u64,
    pub(super) logins_refused: u64,
    pub(super) targets_written: u64,
    pub(super) restarts: u64,
    pub(super) certificates_rejected: u64,
    pub(super) unreadable: u64,
    pub(super) twin_at: Option<i64>,
    pub(super) last_fault: String,
}

impl ServerHealth {
    pub(super) fn diagnostics(&self, node: &str, place: &str, now: i64) -> DiagnosticArray {
        let (level, text) = match age(self.twin_at, now) {
            _ if !self.last_fault.is_empty() => (
                DiagnosticStatus::ERROR,
                format!("the server does not run: {}", self.last_fault),
            ),
            None => (DiagnosticStatus::WARN, "no message of the twin yet".to_owned()),
            Some(age) if age > SILENT => (
                DiagnosticStatus::WARN,
                format!("no message of the twin for {age:.0} s; clients see this in the status of the values"),
            ),
            Some(_) => (DiagnosticStatus::OK, "clients are served".to_owned()),
        };
        let values = [
            ("connections_open", self.open),
            ("connections_made", self.opened),
            ("connections_refused", self.refused),
            ("connections_not_opcua", self.not_opcua),
            ("logins_refused", self.logins_refused),
            ("targets_written", self.targets_written),
            ("certificates_rejected", self.certificates_rejected),
            ("server_restarts", self.restarts),
            ("messages_unreadable", self.unreadable),
        ];
        array(now, vec![item(node, "opcua", (level, text), place, counts(values))])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_level_follows_the_connection_and_the_twin() {
        let now = 1_700_000_000_000_000_000;
        let of_rig = |health: &RigHealth| health.diagnostics("/rig_7/bridge", "opc.tcp://rig", now).status[0].level;
        let mut rig = RigHealth::default();
        assert_eq!(of_rig(&rig), DiagnosticStatus::WARN);
        (rig.connected, rig.heard_at) = (true, Some(now - 1_000_000_000));
        assert_eq!(of_rig(&rig), DiagnosticStatus::OK);
        rig.nodes = [1, 1];
        assert_eq!(of_rig(&rig), DiagnosticStatus::WARN);
        (rig.connected, rig.last_loss) = (false, "BadConnectionClosed".into());
        assert_eq!(of_rig(&rig), DiagnosticStatus::ERROR);
        let of_server = |health: &ServerHealth| health.diagnostics("/a", "b", now).status[0].level;
        let mut server = ServerHealth::default();
        assert_eq!(of_server(&server), DiagnosticStatus::WARN);
        server.twin_at = Some(now);
        assert_eq!(of_server(&server), DiagnosticStatus::OK);
        server.last_fault = "its port is closed".into();
        assert_eq!(of_server(&server), DiagnosticStatus::ERROR);
    }
}
