//! What a source sends and what the mapping makes of it: a table for people, who know whether both agree.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use flexdrill_text::{Course, counted, six_digits};

use super::frame::RawFrame;
use super::header::LAST_HEADER_ITEM;
use super::item::{ItemCode, is_null, number};
use super::mapping::{ItemMapping, Mapping};
use super::may_be::{self, Numbers};
use super::shown;

/// Most items that are kept: a source that sends more is no rig, and must not fill the memory.
const MOST_ITEMS: usize = 1000;
/// Most items whose numbers are kept and compared with each other: rigs send ten to fifty.
const MOST_COMPARED: usize = 100;
/// Bytes of a value that are shown.
const SHOWN: usize = 20;

/// An item of a source, for people.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LookRow {
    /// Record and item, such as `0116`.
    pub code: ItemCode,
    /// Its first value as sent, escaped and cut, with the unit of the mapping; without a unit where the item is not read.
    pub sent: String,
    /// Name of the quantity, and the first value in the unit in which people know it, or `no value`; none where the mapping
    /// does not name the item.
    pub used: Option<(&'static str, String)>,
}

/// The items of a source.
#[derive(Debug, Clone)]
pub struct Look {
    table: BTreeMap<ItemCode, ItemMapping>,
    mapping: Mapping,
    items: BTreeMap<ItemCode, Seen>,
    /// The numbers of the items that came first.
    compared: BTreeMap<ItemCode, Numbers>,
    frames: u64,
}

/// What an item held.
#[derive(Debug, Clone)]
struct Seen {
    /// Its first value, as sent, escaped and cut.
    first_text: String,
    /// Its numbers, nulls left out.
    numbers: Option<Course>,
}

impl Look {
    /// Before the first frame.
    pub fn new(mapping: &Mapping) -> Self {
        Self {
            table: mapping.table(),
            mapping: mapping.clone(),
            items: BTreeMap::new(),
            compared: BTreeMap::new(),
            frames: 0,
        }
    }

    /// Adds a frame.
    pub fn frame(&mut self, frame: &RawFrame) {
        self.frames += 1;
        for (code, text) in frame.lines.iter().filter_map(|line| ItemCode::of_line(line)) {
            if code.item <= LAST_HEADER_ITEM || self.items.len() >= MOST_ITEMS && !self.items.contains_key(&code) {
                continue;
            }
            let seen = self.items.entry(code).or_insert_with(|| Seen {
                first_text: shown(&text[..text.len().min(SHOWN)]),
                numbers: None,
            });
            let Some(value) = number(text).filter(|_| !is_null(text, &self.mapping.nulls)) else {
                continue;
            };
            match &mut seen.numbers {
                Some(numbers) => numbers.add(value),
                None => seen.numbers = Some(Course::new(value)),
            }
            if self.compared.len() < MOST_COMPARED || self.compared.contains_key(&code) {
                self.compared.entry(code).or_default().add(self.frames, value);
            }
        }
    }

    /// Frames so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The items in the order of their numbers, each with its first value.
    pub fn rows(&self) -> impl Iterator<Item = LookRow> {
        self.items.iter().map(|(code, seen)| self.row(*code, seen))
    }

    fn row(&self, code: ItemCode, seen: &Seen) -> LookRow {
        let Some(mapping) = self.table.get(&code) else {
            return LookRow {
                code,
                sent: seen.first_text.clone(),
                used: None,
            };
        };
        let used = match seen.numbers {
            Some(numbers) => as_used(mapping, numbers.first),
            None => "no value".to_owned(),
        };
        LookRow {
            code,
            sent: format!("{} {}", seen.first_text, mapping.unit),
            used: Some((mapping.quantity.name(), used)),
        }
    }

    /// What an item may be by its numbers, where there are enough of them.
    fn may_be(&self, code: ItemCode) -> Option<String> {
        let mapped = self.table.get(&code).map(|item| item.quantity);
        may_be::in_words(code, mapped, &self.compared)
    }

    /// The table: a line per item with its quantity, its first value as sent and as used, and, if there were several frames,
    /// how it changed and what it may be; then the items that the mapping does not name.
    pub fn table(&self) -> String {
        let mut text = String::new();
        let mut unread = Vec::new();
        for (code, seen) in &self.items {
            let LookRow { sent, used, .. } = self.row(*code, seen);
            let Some((quantity, used)) = used else {
                let may_be = self
                    .may_be(*code)
                    .map_or_else(String::new, |words| format!("; {words}"));
                unread.push(format!("{code} ({sent}{may_be})"));
                continue;
            };
            let change = seen.numbers.filter(|_| self.frames > 1).map(Course::words);
            let may_be = self.may_be(*code);
            let change = [change, may_be].into_iter().flatten().collect::<Vec<_>>().join("; ");
            // Writing to a string does not fail.
            let _ = writeln!(text, "  {code}  {quantity:<26} {sent:>18} = {used:<18} {change}");
        }
        let mut text: String = text.lines().flat_map(|line| [line.trim_end(), "\n"]).collect();
        if text.is_empty() {
            text.push_str("  no item that the mapping names\n");
        }
        if !unread.is_empty() {
            let _ = writeln!(text, "  not read: {}", unread.join(", "));
        }
        text
    }

    /// A mapping file (YAML) that reads the items as the table does, with their first values as comments: the beginning of
    /// a site's mapping. Items that are not read stand in it as comments. `source` names the other end.
    pub fn site_file(&self, source: &str) -> String {
        let mut text = format!(
            "# Items of {source} in {}, as the bridge reads them. Compare each value with the rig's\n# display, and correct \
             quantity and unit. Items that are not listed are read as by default.\n",
            counted(self.frames, "frame")
        );
        text.push_str(&self.mapping.keys_in_yaml());
        text.push_str("items:\n");
        for (code, seen) in &self.items {
            let may_be = self
                .may_be(*code)
                .map_or_else(String::new, |words| format!("; {words}"));
            // Writing to a string does not fail.
            let _ = match self.table.get(code) {
                Some(item) => {
                    let used = seen
                        .numbers
                        .map_or_else(|| "no value".to_owned(), |numbers| as_used(item, numbers.first));
                    writeln!(
                        text,
                        "  \"{code}\": {}  # {} {} = {used}{may_be}",
                        item.in_yaml(),
                        seen.first_text,
                        item.unit
                    )
                }
                None => writeln!(
                    text,
                    "  # \"{code}\": {{quantity: NAME, unit: UNIT}}  # {}{may_be}",
                    seen.first_text
                ),
            };
        }
        for (code, _) in self.mapping.items.iter().filter(|(_, item)| item.is_none()) {
            let _ = writeln!(text, "  \"{code}\":  # never read");
        }
        text
    }
}

/// A value in the unit in which people know the quantity.
fn as_used(mapping: &ItemMapping, value: f64) -> String {
    let unit = mapping.quantity.dimension().known_in();
    format!("{} {unit}", six_digits(unit.from_si(mapping.unit.to_si(value))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(frames: &[&str]) -> String {
        let mut look = Look::new(&Mapping::default());
        for text in frames {
            let lines = text.lines().map(|line| line.as_bytes().to_vec()).collect();
            look.frame(&RawFrame {
                lines,
                ..RawFrame::default()
            });
        }
        look.table()
    }

    #[test]
    fn the_table_has_values_as_sent_and_as_used_and_what_is_not_read() {
        let text = table(&["01041\n01082500.5\n01160.85\n0120 40\n0121-9999\n0144 \u{1b}[2J\n01991.5"]);
        let rows: Vec<String> = text
            .lines()
            .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
            .collect();
        assert_eq!(
            rows,
            [
                "0108 bit_depth 2500.5 m = 2500.5 m",
                "0116 weight_on_bit 0.85 kdaN = 8.5 kN",
                "0120 rotary_speed 40 r/min = 40 r/min",
                "0121 standpipe_pressure -9999 kPa = no value",
                "not read: 0144 (\\x1b[2J), 0199 (1.5)",
            ]
        );
    }

    #[test]
    fn the_mapping_of_a_site_is_read_as_it_was_seen() {
        let given = "units: field\nnulls: [-1]\nstamp: header\nutc_offset_h: 5.5\nsequence: ignore\nitems:\n  \"0117\":\n  \
                     \"0116\": {quantity: weight_on_bit, unit: klbs, valid: [-1, 20.5], fallback: true}\n";
        let mapping = Mapping::from_text("given", given).unwrap();
        let mut look = Look::new(&mapping);
        let lines = ["0108 9000", "0116 2.5", "0117 3", "0199 # \u{1b}: {"].map(|line| line.as_bytes().to_vec());
        look.frame(&RawFrame {
            lines: lines.to_vec(),
            ..RawFrame::default()
        });
        let text = look.site_file("10.0.0.7:5555");
        let again = Mapping::from_text("site.yaml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(again.table(), mapping.table(), "{text}");
        let others = |mapping: &Mapping| Mapping {
            items: BTreeMap::new(),
            ..mapping.clone()
        };
        assert_eq!(others(&again), others(&mapping));
        for line in [
            "  \"0108\": {quantity: bit_depth, unit: ft}  # 9000 ft = 2743.2 m\n",
            "  # \"0199\": {quantity: NAME, unit: UNIT}  # # \\x1b: {\n",
        ] {
            assert!(text.contains(line), "{line}\n{text}");
        }
    }

    #[test]
    fn several_frames_show_how_each_item_changes() {
        let text = table(&[
            "0108 1\n0116 2\n0120 7",
            "0108 3\n0116 1\n0120 7",
            "0108 4\n0116 5\n0120 7",
        ]);
        for words in ["1 to 4, only rises", "1 to 5, varies", "constant"] {
            assert!(text.contains(words), "{words} in {text}");
        }
        assert_eq!(table(&["0104 1\n"]), "  no item that the mapping names\n");
    }

    /// Hook load and weight on bit under each other's numbers, and pump strokes that no mapping reads.
    #[test]
    fn a_line_of_thirty_seconds_shows_what_each_item_may_be() {
        let mut look = Look::new(&Mapping::default());
        for second in 0..30_u32 {
            let weight = 0.8 + 0.05 * f64::from(second * second % 11);
            let lines = [
                format!("0108 {}", 2500.0 + 0.001 * f64::from(second)),
                format!("0114 {weight:.2}"),
                format!("0116 {:.2}", 15.0 - weight),
                format!("0130 {}", 60 + second * second % 7),
            ];
            look.frame(&RawFrame {
                lines: lines.map(String::into_bytes).to_vec(),
                ..RawFrame::default()
            });
        }
        let (table, site) = (look.table(), look.site_file("rig"));
        for words in [
            "only rises; may be a depth",
            "varies; CHECK: may be a weight on bit (mirrors 0116)",
            "varies; CHECK: may be a hook load (mirrors 0114)",
            "not read: 0130 (60; may be a rotary speed, pump strokes, ",
        ] {
            assert!(table.contains(words), "{words} in {table}");
        }
        assert!(site.contains("# 60; may be a rotary speed, pump strokes, "), "{site}");
        Mapping::from_text("site.yaml", &site).unwrap_or_else(|error| panic!("{error}\n{site}"));
    }
}
