//! The state of a line in `/diagnostics`.

use flexdrill_bridge::wits::{Counts, DiscardReason, ItemFaultKind, NotUsed};
use flexdrill_messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};

use super::diagnostics::{array, counts as counts_of, item};

/// A line without a used frame for so long is not OK (s).
const QUIET: f64 = 10.0;

/// What is known of a line.
#[derive(Debug, Clone, Default)]
pub struct LineHealth {
    /// Open connections.
    pub open: u64,
    /// Connections made so far.
    pub made: u64,
    /// The newest reason of a loss; empty before the first.
    pub last_loss: String,
    /// When the newest used frame arrived (ns since 1970).
    pub used_at: Option<i64>,
    /// What the line carried.
    pub counts: Counts,
    /// Values that were refused, because another connection serves their quantity.
    pub second_source: u64,
    /// What was refused last, in words; empty before the first.
    pub second_text: String,
    /// Whether two connections send one of the inputs now.
    pub disputed: bool,
    /// Open connections whose mapping no person has confirmed.
    pub unconfirmed: u64,
    /// Frames of the twin that were written, and those that a slow connection lost.
    pub written: [u64; 2],
    /// Why the capture ended, if it did.
    pub capture_failed: Option<String>,
}

impl LineHealth {
    /// Level and words at an instant (ns since 1970).
    fn verdict(&self, now: i64) -> (u8, String) {
        let age = self.used_at.map(|at| now.saturating_sub(at) as f64 * 1e-9);
        let (level, text) = match (self.open, age) {
            (0, _) if self.last_loss.is_empty() => (DiagnosticStatus::WARN, "not yet connected".to_owned()),
            (0, _) => (DiagnosticStatus::ERROR, format!("not connected: {}", self.last_loss)),
            (_, None) => (DiagnosticStatus::WARN, "connected, no usable frame yet".to_owned()),
            (_, Some(age)) if age > QUIET => (
                DiagnosticStatus::WARN,
                format!("connected, no usable frame for {age:.0} s"),
            ),
            _ if self.disputed => (DiagnosticStatus::WARN, format!("two sources: {}", self.second_text)),
            _ if self.unconfirmed > 0 => (
                DiagnosticStatus::WARN,
                "frames arrive, marked suspect: no person has confirmed what the mapping makes of them (key c in the \
                 bridge's terminal, the page, or --confirm)"
                    .to_owned(),
            ),
            _ => (DiagnosticStatus::OK, "frames arrive".to_owned()),
        };
        match &self.capture_failed {
            Some(why) => (
                level.max(DiagnosticStatus::WARN),
                format!("{text}; the capture ended: {why}"),
            ),
            None => (level, text),
        }
    }

    /// The message of `/diagnostics` at an instant (ns since 1970).
    pub fn diagnostics(&self, node: &str, place: &str, now: i64) -> DiagnosticArray {
        let counts = &self.counts;
        // The verdict is of the state now, the counts are since the start: an operator needs both, the level follows the first.
        // Keys are names of interfaces that monitors match on, in the order of the way through the bridge.
        let mut values = vec![
            ("connections_open", self.open),
            ("connections_made", self.made),
            ("connections_unconfirmed", self.unconfirmed),
            ("frames", counts.frames),
            ("frames_used", counts.used),
            ("values", counts.values),
            ("records_missing", counts.missing),
            ("records_repeated", counts.duplicates),
            ("records_out_of_order", counts.out_of_order),
            ("values_of_a_second_source", self.second_source),
            ("items_unmapped", counts.unmapped),
            ("items_null", counts.nulls),
            ("bytes_discarded", counts.discarded_bytes),
            ("frames_written", self.written[0]),
            ("frames_not_written", self.written[1]),
        ];
        values.extend(NotUsed::ALL.map(|reason| (reason.name(), counts.not_used[reason as usize])));
        values.extend(DiscardReason::ALL.map(|reason| (reason.name(), counts.discarded[reason as usize])));
        values.extend(ItemFaultKind::ALL.map(|kind| (kind.name(), counts.faults[kind as usize])));
        let values = values.into_iter().map(|(key, count)| (key.replace(' ', "_"), count));
        array(
            now,
            vec![item(node, "wits", self.verdict(now), place, counts_of(values))],
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_level_follows_connection_and_frames() {
        let now = 1_700_000_000_000_000_000;
        let level = |health: &LineHealth| health.diagnostics("/rig_7/bridge", "rig:5555", now).status[0].level;
        let mut health = LineHealth::default();
        assert_eq!(level(&health), DiagnosticStatus::WARN);
        health.open = 1;
        health.used_at = Some(now - 1_000_000_000);
        assert_eq!(level(&health), DiagnosticStatus::OK);
        health.disputed = true;
        health.second_text = "connection 2 also sends rotary_speed".to_owned();
        assert_eq!(level(&health), DiagnosticStatus::WARN);
        health.disputed = false;
        health.unconfirmed = 1;
        let status = &health.diagnostics("/a", "b", now).status[0];
        assert_eq!(status.level, DiagnosticStatus::WARN);
        assert!(status.message.contains("--confirm"), "{}", status.message);
        health.unconfirmed = 0;
        health.used_at = Some(now - 11_000_000_000);
        assert_eq!(level(&health), DiagnosticStatus::WARN);
        health.open = 0;
        health.last_loss = "no data for 60 s".into();
        assert_eq!(level(&health), DiagnosticStatus::ERROR);
        let keys: Vec<_> = health.diagnostics("/a", "b", now).status[0]
            .values
            .iter()
            .map(|value| value.key.clone())
            .collect();
        assert!(
            keys.contains(&"frame_cut_by_the_end_of_the_connection".to_owned()),
            "{keys:?}"
        );
    }
}
