//! What the mapping makes of the first frame of each connection, shown to people, and whether one of them has confirmed it.
//! Public programs give some items other meanings: only a person sees that a value is another quantity's.

use std::collections::BTreeMap;
use std::time::Instant;

use flexdrill_bridge::wits::{Look, LookRow, Mapping, RawFrame};
use flexdrill_messages::diagnostic_msgs::DiagnosticStatus;
use flexdrill_messages::{ConfirmMappingRequest, ConfirmMappingResponse};
use flexdrill_text::{Throttle, counted, log_ending, printable};

use super::confirmations::Confirmations;
use super::diagnostics::item;

/// Most items of a source in the diagnostics, which come every second. Rigs send ten to fifty.
const MOST_ROWS: usize = 100;
/// Least time between two tables of one source on the terminal (s), as for lines of the log.
const TABLE_INTERVAL: f64 = 10.0;
/// Most sources that have this interval for themselves; all others share one.
const MOST_SOURCES: usize = 64;
/// Most sources whose confirmation is known to this run alone.
const MOST_UNKEPT: usize = 64;
/// Longest name of an operator (characters).
const LONGEST_NAME: usize = 100;

/// The connections and what they sent first.
pub struct FirstFrames {
    confirmations: Confirmations,
    /// Confirm each source when its first frame was shown: a person has asked for it.
    confirms: bool,
    connections: BTreeMap<u64, Connection>,
    /// When and by whom sources were confirmed whose confirmation the disk has refused.
    unkept: BTreeMap<String, String>,
    /// When the table of a source was shown; an empty name is all further sources.
    tables: BTreeMap<String, Throttle>,
    began: Instant,
}

struct Connection {
    /// Its other end as confirmations name it: without a port that changes.
    source: String,
    /// Its other end with the port.
    address: String,
    /// Its first frame with an item.
    shown: Option<Look>,
    /// When and by whom the mapping was confirmed for this source.
    confirmed: Option<String>,
}

impl FirstFrames {
    /// Before the first connection. With `confirms` a source is confirmed when its first frame was shown.
    pub fn new(confirmations: Confirmations, confirms: bool) -> Self {
        Self {
            confirmations,
            confirms,
            connections: BTreeMap::new(),
            unkept: BTreeMap::new(),
            tables: BTreeMap::new(),
            began: Instant::now(),
        }
    }

    /// Adds a connection.
    pub fn opened(&mut self, connection: u64, source: String, address: String) {
        let kept = || {
            self.confirmations.of(&source).unwrap_or_else(|error| {
                if let Some(more) = log_ending("wits confirmation") {
                    tracing::warn!("wits: {error}{more}");
                }
                None
            })
        };
        let confirmed = self.unkept.get(&source).cloned().or_else(kept);
        let opened = Connection {
            source,
            address,
            shown: None,
            confirmed,
        };
        self.connections.insert(connection, opened);
    }

    /// Removes a connection.
    pub fn closed(&mut self, connection: u64) {
        self.connections.remove(&connection);
    }

    /// Whether a person has confirmed what the mapping makes of a connection.
    pub fn is_confirmed(&self, connection: u64) -> bool {
        let found = self.connections.get(&connection);
        found.is_some_and(|found| found.confirmed.is_some())
    }

    /// Connections whose first frame was shown and that no person has confirmed.
    pub fn unconfirmed(&self) -> u64 {
        let doubtful = self.connections.values().filter(|found| found.waits());
        doubtful.count() as u64
    }

    /// Takes a frame with an item that arrived at `now` (ns since 1970). Returns the table for people, if it is the first of
    /// its connection. A source that connects again and again has one table in ten seconds.
    pub fn frame(&mut self, connection: u64, frame: &RawFrame, mapping: &Mapping, now: i64) -> Option<String> {
        let found = self.connections.get_mut(&connection);
        let found = found.filter(|found| found.shown.is_none())?;
        let is_known = self.tables.contains_key(&found.source) || self.tables.len() < MOST_SOURCES;
        let of_table = if is_known { found.source.clone() } else { String::new() };
        let throttle = self
            .tables
            .entry(of_table)
            .or_insert_with(|| Throttle::new(TABLE_INTERVAL));
        let ending = throttle.ending(self.began.elapsed().as_secs_f64());
        // One of many sources whose table was not yet shown waits for its turn, because nothing unseen is confirmed.
        if ending.is_none() && !is_known {
            return None;
        }
        let mut look = Look::new(mapping);
        look.frame(frame);
        let note = match (&found.confirmed, self.confirms) {
            (Some(when), _) => format!("a person has confirmed this mapping for this source: {when}"),
            (None, true) => "--confirm confirms it".to_owned(),
            (None, false) => {
                "its values are marked SUSPECT until a person confirms the mapping: press c and Enter here, \
                              confirm it on the page, or start with --confirm"
                    .to_owned()
            }
        };
        let text = ending.map(|more| {
            format!(
                "first frame of connection {connection} ({}); compare it with the rig's display{more}:\n{}  {note}\n",
                printable(&found.address),
                look.table()
            )
        });
        found.shown = Some(look);
        if self.confirms {
            self.confirm_shown("--confirm", now);
        }
        text
    }

    /// Keeps that `by` has confirmed the mapping for all sources whose first frame was shown. Returns how many they were.
    pub fn confirm_shown(&mut self, by: &str, now: i64) -> usize {
        let waiting = self.connections.values().filter(|found| found.waits());
        let mut sources: Vec<String> = waiting.map(|found| found.source.clone()).collect();
        sources.sort();
        sources.dedup();
        for source in &sources {
            // The log has the result; who pressed a key reads it there.
            let _ = self.confirm(source, by, now);
        }
        sources.len()
    }

    /// Confirms the mapping for one source, as a service's client asks for it at `now` (ns since 1970).
    pub fn answer(&mut self, request: &ConfirmMappingRequest, now: i64) -> ConfirmMappingResponse {
        let refused = |message: String| ConfirmMappingResponse {
            success: false,
            message,
        };
        // The name stands in the journal, so it must be one on a line.
        let name = request.operator_name.trim();
        let length = name.chars().count();
        if length == 0 || length > LONGEST_NAME || printable(name) != name {
            return refused(format!(
                "operator_name has {length} characters; it must have 1 to {LONGEST_NAME}, and no control characters"
            ));
        }
        // Nothing is confirmed that the person has not seen: neither another mapping nor a source without a frame.
        let own = self.confirmations.short_hash();
        if request.mapping != own {
            return refused(format!(
                "the bridge reads with mapping {own}, not {}; compare its table again",
                printable(&request.mapping)
            ));
        }
        let mut of_source = self.connections.values().filter(|found| found.source == request.source);
        if !of_source.any(|found| found.shown.is_some()) {
            return refused(format!(
                "no open connection from {} has sent a frame",
                printable(&request.source)
            ));
        }
        let (is_kept, message) = match self.confirm(&request.source, name, now) {
            Ok(message) => (true, message),
            Err(message) => (false, message),
        };
        ConfirmMappingResponse {
            success: is_kept,
            message,
        }
    }

    /// Confirms a source in this run, and keeps that. Returns the result in words, as an error where it is not kept.
    fn confirm(&mut self, source: &str, by: &str, now: i64) -> Result<String, String> {
        let when = Confirmations::words(by, now);
        for found in self.connections.values_mut().filter(|found| found.source == source) {
            found.confirmed = Some(when.clone());
        }
        let (name, hash) = (printable(self.confirmations.mapping()), self.confirmations.short_hash());
        let text = format!("mapping {hash} ({name}) is confirmed for {} by {by}", printable(source));
        match self.confirmations.add(source, by, now) {
            Ok(file) => {
                if let Some(more) = log_ending("wits confirmed") {
                    tracing::info!("wits: {text}, kept in {}{more}", file.display());
                }
                Ok(text)
            }
            Err(error) => {
                if let Some(more) = log_ending("wits confirmed, not kept") {
                    tracing::warn!("wits: {text}, and not kept: {error}{more}");
                }
                if self.unkept.len() < MOST_UNKEPT {
                    self.unkept.insert(source.to_owned(), when);
                }
                Err(format!("{text} in this run, but not kept over a restart: {error}"))
            }
        }
    }

    /// An item of `/diagnostics` per connection that has sent a frame, for displays: what the mapping makes of each item. `node`
    /// is the bridge's name; `service` is the absolute name of the one that confirms.
    pub fn diagnostics(&self, node: &str, service: &str) -> Vec<DiagnosticStatus> {
        let shown = self.connections.iter().filter_map(|(connection, found)| {
            let look = found.shown.as_ref()?;
            // A mapping that no person has confirmed is no fault, but a display must not show it as checked.
            let verdict = match &found.confirmed {
                Some(when) => (DiagnosticStatus::OK, format!("confirmed {when}")),
                None => (
                    DiagnosticStatus::WARN,
                    "no person has confirmed what the mapping makes of this source; its values are marked SUSPECT"
                        .to_owned(),
                ),
            };
            let head = [
                ("source", printable(&found.source).into_owned()),
                ("address", printable(&found.address).into_owned()),
                ("mapping", self.confirmations.short_hash().to_owned()),
                ("mapping_file", printable(self.confirmations.mapping()).into_owned()),
                ("confirmed", found.confirmed.clone().unwrap_or_default()),
                ("confirm_service", service.to_owned()),
            ];
            let head = head.into_iter().map(|(key, value)| (key.to_owned(), value));
            // A source that sends thousands of items must not fill the message.
            let rows: Vec<LookRow> = look.rows().collect();
            let items = rows.iter().take(MOST_ROWS).map(|row| {
                let words = match &row.used {
                    Some((quantity, used)) => format!("{quantity}: {} = {used}", row.sent),
                    None => format!("not read: {}", row.sent),
                };
                (format!("item_{}", row.code), words)
            });
            let further = rows.len().saturating_sub(MOST_ROWS);
            let more = (further > 0).then(|| ("items_not_shown".to_owned(), counted(further as u64, "item")));
            let part = format!("wits mapping of connection {connection}");
            let values = head.chain(items).chain(more);
            Some(item(node, &part, verdict, &printable(&found.source), values))
        });
        shown.collect()
    }
}

impl Connection {
    /// Its first frame was shown, and no person has confirmed what the mapping makes of it.
    fn waits(&self) -> bool {
        self.shown.is_some() && self.confirmed.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn frames(folder: &Path, confirms: bool) -> FirstFrames {
        let confirmations = Confirmations::new(Some(folder.to_owned()), b"items", "site.yaml".to_owned());
        FirstFrames::new(confirmations, confirms)
    }

    fn frame(lines: &[&str]) -> RawFrame {
        RawFrame {
            lines: lines.iter().map(|line| line.as_bytes().to_vec()).collect(),
            ..RawFrame::default()
        }
    }

    /// A connection with its first frame; the table that is shown.
    fn open(first: &mut FirstFrames, connection: u64, source: &str) -> Option<String> {
        first.opened(connection, source.to_owned(), format!("{source}:4000"));
        first.frame(
            connection,
            &frame(&["01160.81", "012041", "01441180"]),
            &Mapping::default(),
            0,
        )
    }

    fn request(source: &str, mapping: &str, operator_name: &str) -> ConfirmMappingRequest {
        ConfirmMappingRequest {
            source: source.to_owned(),
            mapping: mapping.to_owned(),
            operator_name: operator_name.to_owned(),
        }
    }

    #[test]
    fn the_first_frame_is_shown_once_and_confirmed_by_a_key_for_its_source() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = frames(folder.path(), false);
        assert_eq!(first.confirm_shown("a key", 0), 0);
        first.opened(9, "silent".to_owned(), "silent:1".to_owned());
        let table = open(&mut first, 1, "key-a").unwrap();
        for words in ["0116  weight_on_bit", "not read: 0144 (1180)", "marked SUSPECT until"] {
            assert!(table.contains(words), "{words} in {table}");
        }
        let again = first.frame(1, &frame(&["01160.9"]), &Mapping::default(), 0);
        assert_eq!(again, None);
        assert!(!first.is_confirmed(1));
        assert_eq!(first.unconfirmed(), 1);
        assert_eq!(first.confirm_shown("a key", 0), 1);
        assert!(first.is_confirmed(1) && !first.is_confirmed(9));
        assert_eq!(first.unconfirmed(), 0);
        // Another source asks, the same one does not, also after a restart.
        open(&mut first, 2, "key-b");
        assert!(!first.is_confirmed(2));
        let mut later = frames(folder.path(), false);
        open(&mut later, 1, "key-a");
        open(&mut later, 2, "key-b");
        assert!(later.is_confirmed(1) && !later.is_confirmed(2));
        later.closed(2);
        assert_eq!(later.unconfirmed(), 0);
    }

    #[test]
    fn the_option_confirms_each_source_when_it_is_shown() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = frames(folder.path(), true);
        first.opened(1, "option-a".to_owned(), "option-a:1".to_owned());
        assert!(!first.is_confirmed(1));
        assert!(
            open(&mut first, 1, "option-a")
                .unwrap()
                .contains("--confirm confirms it")
        );
        assert!(first.is_confirmed(1));
    }

    #[test]
    fn many_sources_do_not_fill_the_terminal_and_none_is_confirmed_unseen() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = frames(folder.path(), false);
        // The same source again: its table was just shown.
        assert!(open(&mut first, 1000, "0").is_some());
        assert!(open(&mut first, 1001, "0").is_none());
        assert_eq!(first.unconfirmed(), 2);
        let shown = (1..500).filter(|source| open(&mut first, *source, &source.to_string()).is_some());
        // The first 64 and one of all others; the test ends within ten seconds, except on a machine that pauses.
        let shown = shown.count() as u64;
        assert!((MOST_SOURCES as u64..70).contains(&shown), "{shown}");
        assert_eq!(first.unconfirmed(), shown + 2);
        assert_eq!(first.confirm_shown("a key", 0) as u64, shown + 1);
        assert!(!first.is_confirmed(499));
    }

    #[test]
    fn a_request_confirms_what_was_seen_only() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = frames(folder.path(), false);
        first.opened(1, "asked-silent".to_owned(), String::new());
        open(&mut first, 2, "asked-a");
        open(&mut first, 3, "asked-b");
        let hash = first.confirmations.short_hash().to_owned();
        for (wrong, words) in [
            (request("asked-a", &hash, " "), "operator_name has 0"),
            (request("asked-a", &hash, "a\nb"), "no control characters"),
            (request("asked-a", "0123456789abcdef", "ann"), "compare its table again"),
            (request("asked-a", "", "ann"), "compare its table again"),
            (request("asked-silent", &hash, "ann"), "has sent a frame"),
            (request("unknown", &hash, "ann"), "has sent a frame"),
        ] {
            let answer = first.answer(&wrong, 0);
            assert!(!answer.success && answer.message.contains(words), "{answer:?}");
        }
        assert_eq!(first.unconfirmed(), 2);
        let answer = first.answer(&request("asked-a", &hash, " ann "), 0);
        assert!(answer.success && answer.message.ends_with("by ann"), "{answer:?}");
        assert!(first.is_confirmed(2) && !first.is_confirmed(3));
    }

    #[test]
    fn what_the_disk_refuses_holds_in_this_run_and_the_answer_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let mut first = frames(&file, false);
        open(&mut first, 1, "disk-a");
        let hash = first.confirmations.short_hash().to_owned();
        let answer = first.answer(&request("disk-a", &hash, "ann"), 0);
        assert!(!answer.success && answer.message.contains("--state-dir"), "{answer:?}");
        assert!(first.is_confirmed(1));
        // Also after a new connection of the same source, until the bridge ends.
        first.closed(1);
        open(&mut first, 2, "disk-a");
        assert!(first.is_confirmed(2));
        let mut later = frames(&file, false);
        open(&mut later, 1, "disk-a");
        assert!(!later.is_confirmed(1));
    }

    #[test]
    fn a_damaged_state_asks_again() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = frames(folder.path(), true);
        open(&mut first, 1, "damaged-a");
        for entry in std::fs::read_dir(folder.path()).unwrap() {
            std::fs::write(entry.unwrap().path(), b"\xff").unwrap();
        }
        let mut later = frames(folder.path(), false);
        open(&mut later, 1, "damaged-a");
        assert!(!later.is_confirmed(1));
    }

    #[test]
    fn diagnostics_have_the_table_with_what_confirms_it() {
        let folder = tempfile::tempdir().unwrap();
        let mut first = frames(folder.path(), false);
        first.opened(1, "page-silent".to_owned(), String::new());
        open(&mut first, 2, "page-a");
        let many: Vec<String> = (0..200)
            .map(|item| format!("{:02}{:02}1", 30 + item / 50, 10 + item % 50))
            .collect();
        first.opened(3, "page-b".to_owned(), String::new());
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        first.frame(3, &frame(&many), &Mapping::default(), 0);
        let status = first.diagnostics("/rig_7/bridge", "/rig_7/bridge/confirm_mapping");
        assert_eq!(status.len(), 2);
        assert_eq!(status[0].name, "rig_7/bridge: wits mapping of connection 2");
        assert_eq!(status[0].level, DiagnosticStatus::WARN);
        let value = |status: &DiagnosticStatus, key: &str| {
            let found = status.values.iter().find(|pair| pair.key == key);
            found.map(|pair| pair.value.clone())
        };
        for (key, wanted) in [
            ("source", "page-a"),
            ("mapping_file", "site.yaml"),
            ("confirmed", ""),
            ("confirm_service", "/rig_7/bridge/confirm_mapping"),
            ("item_0116", "weight_on_bit: 0.81 kdaN = 8.1 kN"),
            ("item_0144", "not read: 1180"),
        ] {
            assert_eq!(value(&status[0], key).as_deref(), Some(wanted), "{key}");
        }
        assert_eq!(value(&status[1], "items_not_shown").as_deref(), Some("100 items"));
        let hash = value(&status[0], "mapping").unwrap();
        first.answer(&request("page-a", &hash, "ann"), 1_700_000_000_000_000_000);
        let status = first.diagnostics("/rig_7/bridge", "");
        assert_eq!(status[0].level, DiagnosticStatus::OK);
        assert_eq!(status[0].message, "confirmed 2023-11-14 22:13:20 UTC by ann");
    }
}
