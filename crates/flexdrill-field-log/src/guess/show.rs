//! A guess as a table for people and as a mapping file.

use std::fmt::Write as _;

use super::{Guess, Proposal, Quantity};
use crate::{Decimal, FieldLogError, Mapping};
use flexdrill_text::{counted, printable, six_digits};

/// How the first line of a mapping begins that no person has compared with the log.
const MARK: &str = "# Proposed by flexdrill, not yet compared:";
/// Characters of a text that are shown.
const SHOWN: usize = 24;

/// Whether a mapping file is a proposal whose first line is as it was written: such a file is used by its name alone.
pub fn is_proposed(text: &str) -> bool {
    text.starts_with(MARK)
}

impl Guess {
    /// A line per column: quantity, unit, the first value as read and as used, how sure, and the evidence; then the columns
    /// that are left out, each with the reason.
    pub fn table(&self) -> String {
        let mut lines = vec![
            [
                "column",
                "quantity",
                "first value, as read and as used",
                "how sure",
                "evidence",
            ]
            .map(str::to_owned),
        ];
        if let Some(time) = &self.time {
            lines.push([
                cut(&time.column.name()),
                "time".to_owned(),
                format!("{} ({})", cut(&time.first), time.column.format().name()),
                time.sure.words().to_owned(),
                time.evidence.join("; "),
            ]);
        }
        for proposal in &self.proposals {
            lines.push([
                cut(&proposal.column),
                proposal.quantity.name().to_owned(),
                proposal.as_read_and_used(),
                proposal.sure.words().to_owned(),
                proposal.evidence.join("; "),
            ]);
        }
        // The width of each column of the table is that of its longest text; the last one needs none.
        let width = |index: usize| lines.iter().map(|line| line[index].chars().count()).max().unwrap_or(0);
        let widths = [0, 1, 2, 3].map(width);
        let mut text = String::new();
        for [column, quantity, first, sure, evidence] in &lines {
            let [a, b, c, d] = widths;
            // Writing to a string does not fail.
            let _ = writeln!(text, "  {column:a$}  {quantity:b$}  {first:c$}  {sure:d$}  {evidence}");
        }
        if !self.left_out.is_empty() {
            text.push_str("left out:\n");
        }
        for left in &self.left_out {
            let _ = writeln!(
                text,
                "  {} ({}): {}{}",
                cut(&left.column),
                cut(&left.first_text),
                printable(&left.why),
                may_be(&left.may_be)
            );
        }
        for note in &self.notes {
            let _ = writeln!(text, "note: {}", printable(note));
        }
        text
    }

    /// The mapping that the guess proposes.
    ///
    /// # Errors
    /// When the guess lacks what a mapping needs: see [`Guess::lacks`].
    pub fn mapping(&self) -> Result<Mapping, FieldLogError> {
        Ok(Mapping::from_text(
            &format!("the mapping that is proposed for {}", self.file),
            &self.mapping_file(),
        )?)
    }

    /// The mapping as a file (YAML): the columns with their evidence as comments, and what is left out as comments too. A
    /// guess that lacks a required column is a file that a person completes.
    pub fn mapping_file(&self) -> String {
        let mut text = format!(
            "{MARK} remove this line when each column is compared.\n# {} of {}. Compare quantity, unit and first value of each \
             column with the rig's display.\n",
            counted(self.rows as u64, "row"),
            printable(&self.file)
        );
        // Writing to a string does not fail.
        let _ = writeln!(text, "separator: {}", quoted(&self.separator.to_string()));
        if self.decimal == Decimal::Comma {
            text.push_str("decimal: comma\n");
        }
        if let Some(row) = self.header_row {
            let _ = writeln!(text, "header_row: {row}");
        }
        if !self.missing.is_empty() {
            let codes: Vec<String> = self.missing.iter().map(f64::to_string).collect();
            let _ = writeln!(text, "missing: [{}]", codes.join(", "));
        }
        text.push_str("columns:\n");
        self.write_time(&mut text);
        self.write_inputs(&mut text);
        let measured =
            [Quantity::HookLoad, Quantity::BitDepth, Quantity::HoleDepth].map(|quantity| self.proposal(quantity));
        if measured.iter().any(Option::is_some) {
            text.push_str("  measured:\n");
        }
        for proposal in measured.into_iter().flatten() {
            let _ = writeln!(text, "    {}: {}", proposal.quantity.name(), proposal.in_yaml());
        }
        if !self.left_out.is_empty() {
            text.push_str("# Left out:\n");
        }
        for left in &self.left_out {
            let _ = writeln!(
                text,
                "#   {} ({}): {}{}",
                quoted(&left.column),
                cut(&left.first_text),
                printable(&left.why),
                may_be(&left.may_be)
            );
        }
        text
    }

    fn proposal(&self, quantity: Quantity) -> Option<&Proposal> {
        self.proposals.iter().find(|proposal| proposal.quantity == quantity)
    }

    fn write_time(&self, text: &mut String) {
        // Writing to a string does not fail.
        let _ = match &self.time {
            Some(time) => {
                let column = &time.column;
                let columns = match (&column.date, &column.clock) {
                    (Some(date), Some(clock)) => format!("date: {}, clock: {}", quoted(date), quoted(clock)),
                    _ => format!("column: {}", quoted(&column.column)),
                };
                let format = quoted(column.format().name());
                writeln!(
                    text,
                    "  time: {{{columns}, format: {format}}}  # {}: {}",
                    time.sure.words(),
                    printable(&time.evidence.join("; "))
                )
            }
            None => writeln!(
                text,
                "  # time: {{column: NAME, format: FORMAT}}  # not found: complete this line"
            ),
        };
    }

    fn write_inputs(&self, text: &mut String) {
        // Writing to a string does not fail.
        let _ = match self.proposal(Quantity::RotarySpeed) {
            Some(speed) => writeln!(text, "  rotary_speed: {}", speed.in_yaml()),
            None => writeln!(
                text,
                "  # rotary_speed: {{column: NAME, unit: UNIT}}  # not found: complete this line"
            ),
        };
        match (self.proposal(Quantity::WeightOnBit), self.proposal(Quantity::HookLoad)) {
            (Some(weight), _) => {
                let _ = writeln!(text, "  weight_on_bit:\n    direct: {}", weight.in_yaml());
            }
            (None, Some(hook)) => self.write_hook_load(text, hook),
            (None, None) => {
                text.push_str(
                    "  # weight_on_bit: {direct: {column: NAME, unit: UNIT}}  # not found: complete this line\n",
                );
            }
        }
        for quantity in [
            Quantity::Torque,
            Quantity::RateOfPenetration,
            Quantity::StandpipePressure,
        ] {
            if let Some(proposal) = self.proposal(quantity) {
                let _ = writeln!(text, "  {}: {}", quantity.name(), proposal.in_yaml());
            }
        }
    }

    /// The weight on bit from the hook load, as comments: what the codes of an activity mean is in no log.
    fn write_hook_load(&self, text: &mut String, hook: &Proposal) {
        let column = self
            .codes
            .as_ref()
            .map_or("NAME".to_owned(), |codes| quoted(&codes.column));
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "  # The log has no weight on bit; it is the tare minus the hook load. When the bit drills, and when it is off\n  \
             # bottom, is not in the log: complete the lists of codes, and remove the # of these lines.\n  \
             # weight_on_bit:\n  #   hookload:\n  #     column: {}\n  #     unit: {}\n  \
             #     drilling: {{column: {column}, values: [CODES]}}\n  #     off_bottom: {{column: {column}, values: [CODES]}}",
            quoted(&hook.column),
            hook.unit
        );
        for line in self.codes.iter().flat_map(|codes| &codes.lines) {
            let _ = writeln!(text, "  # code {line}");
        }
    }
}

impl Proposal {
    /// The first number in the unit of the log and in the unit in which people know the quantity.
    pub fn as_read_and_used(&self) -> String {
        let used = self.quantity.dimension().known_in();
        let value = used.from_si(self.unit.to_si(self.first));
        let read = format!("{} {}", six_digits(self.first), self.unit);
        if used == self.unit {
            return read;
        }
        format!("{read} = {} {used}", six_digits(value))
    }

    fn in_yaml(&self) -> String {
        format!(
            "{{column: {}, unit: {}}}  # {}: {}; first {}",
            quoted(&self.column),
            self.unit,
            self.sure.words(),
            printable(&self.evidence.join("; ")),
            self.as_read_and_used()
        )
    }
}

/// What a column may be, behind the reason.
fn may_be(quantities: &[Quantity]) -> String {
    let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
    if names.is_empty() {
        String::new()
    } else {
        format!(" (may be {})", names.join(", "))
    }
}

/// A text that a terminal can show, cut.
fn cut(text: &str) -> String {
    let text = printable(text);
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.into_owned(),
    }
}

/// A text between quotes of YAML.
fn quoted(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            character if character.is_control() || matches!(character, '\u{2028}' | '\u{2029}' | '\u{feff}') => {
                quoted.push_str(&format!("\\u{:04x}", u32::from(character)));
            }
            character => quoted.push(character),
        }
    }
    quoted.push('"');
    quoted
}
