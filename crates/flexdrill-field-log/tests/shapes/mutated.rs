//! Logs with damaged bytes.

use super::*;

/// Numbers of a generator by Knuth (MMIX), so that a failure can be repeated.
struct Seeded(u64);

impl Seeded {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound
    }
}

const PIECES: [&str; 22] = [
    ",",
    ";",
    "\"",
    "\n",
    "\r\n",
    " ",
    "\t",
    "-",
    ".",
    "1,234.5",
    "-999.25",
    "NaN",
    "1e308",
    "sep=;\n",
    "\u{a0}",
    "\0",
    "~V\n",
    "#",
    "0",
    "999999999999",
    "t,rpm,wob\n",
    "29/01/2026",
];

fn mutated(log: &str, seed: u64) -> Vec<u8> {
    let mut random = Seeded(seed);
    let mut bytes = log.as_bytes().to_vec();
    for _ in 0..=random.below(4) {
        let (at, length) = (random.below(bytes.len() + 1), random.below(12));
        let end = (at + length).min(bytes.len());
        match random.below(6) {
            0 => drop(bytes.drain(at..end)),
            1 => bytes[at..end].reverse(),
            2 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            3 if at < bytes.len() => bytes[at] = random.below(256) as u8,
            4 => bytes.truncate(at),
            _ => {
                let piece = PIECES[random.below(PIECES.len())];
                bytes.splice(at..at, piece.bytes());
            }
        }
    }
    bytes
}

/// What a mutated log may not do: panic, lose a row without a word, or give a value that the field of its row does not
/// have.
#[test]
fn ten_thousand_mutated_logs_lose_no_row_and_invent_no_value() {
    let plain: String = (0..30)
        .map(|row| format!("{}.5,{},{}.25\n", row, 40 + row % 3, row % 7))
        .collect();
    let newest_first: String = (0..30)
        .rev()
        .map(|row| format!("{row},{},{row}\n", 40 + row % 5))
        .collect();
    let logs = [
        format!("t,rpm,wob\n{plain}"),
        format!("t,rpm,wob\n{newest_first}"),
        LAS.to_owned(),
    ];
    let mapping = mapping_of("column: t", "");
    let mut read_logs = 0;
    for seed in 0..10_000_u64 {
        let bytes = mutated(&logs[seed as usize % logs.len()], seed);
        let (sequence, report) = match read(&bytes, &mapping) {
            Ok(read) => read,
            Err(error) => {
                assert!(error.to_string().len() > 20, "{seed}: {error}");
                continue;
            }
        };
        read_logs += 1;
        // Every row of the file is used, or an issue has it.
        let rows_of = |issue: &flexdrill_field_log::Issue| issue.first_row..=issue.last_row;
        let lost: u64 = (report.issues.iter())
            .filter(|issue| match issue.kind {
                IssueKind::Unreadable => issue.column.is_empty() || issue.column == "t",
                IssueKind::TimeRepeats | IssueKind::TimeBackwards | IssueKind::TimeJumps => true,
                _ => false,
            })
            .map(|issue| issue.rows)
            .sum();
        assert_eq!(lost, report.left_out, "{seed}: {report}");
        assert_eq!(sequence.rows.len() as u64, report.rows, "{seed}: {report}");
        for row in &sequence.rows {
            for kind in [InputKind::RotarySpeed, InputKind::WeightOnBit] {
                let has = sequence
                    .inputs
                    .iter()
                    .any(|input| input.row == row.row && input.kind == kind);
                let said = report
                    .issues
                    .iter()
                    .any(|issue| rows_of(issue).contains(&row.row) && !issue.column.is_empty());
                assert!(
                    has || said,
                    "{seed}: row {} has no {} and no word: {report}",
                    row.row,
                    kind.name()
                );
            }
        }
        // A value is what one field of its row says.
        let lines = lines_of(&bytes);
        for input in &sequence.inputs {
            assert!(
                input.value.is_finite() && input.value.abs() <= 1e15,
                "{seed}: {input:?}"
            );
            let line = &lines[input.row as usize - 1];
            let fields = line
                .split([',', ';', ' ', '\t', '"'])
                .map(|field| field.replace('\u{a0}', " ").trim().to_owned());
            let said = fields
                .filter_map(|field| field.parse::<f64>().ok())
                .any(|value| value == input.value);
            // A number with thousands has several fields here.
            assert!(said || line.contains("1,234"), "{seed}: {input:?} is not in {line:?}");
        }
        assert!(sequence.inputs.is_sorted_by_key(|input| input.time), "{seed}");
    }
    assert!(read_logs > 3000, "{read_logs} of 10,000 were read");
}

/// The lines as an editor shows them.
fn lines_of(bytes: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(bytes).replace("\r\n", "\n").replace('\r', "\n");
    text.split('\n').map(str::to_owned).collect()
}
