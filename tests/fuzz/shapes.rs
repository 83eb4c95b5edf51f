//! Logs in the notations of others: days of a spreadsheet, patterns of date and time, date and clock in two columns,
//! columns between blanks, LAS, compressed files, and the mapping that is proposed for any of them.

use flexdrill::field_log::{self, Mapping, Range};

use crate::engine::Target;
use crate::says_why;

const WORDS: &[&str] = &[
    "sep=;\n",
    "\n",
    "\r\n",
    "\t",
    "  ",
    ";",
    ",",
    "'",
    "1,234.5",
    "1.234,5",
    "\u{a0}",
    "\u{202f}",
    "-999.25",
    "-9999",
    "29/01/2026-23:59:59",
    "29-Jan-2026",
    "11:59:20 AM",
    "12:00 PM",
    "46051.4995",
    "1e9",
    "~A\n",
    "~C\n",
    "~V\nVERS. 2.0:\n",
    "WRAP. YES:\n",
    "NULL. -999.25:\n",
    "DEPT.M :\n",
    "ft-lbf",
    "klbs",
    "RPM",
];

/// Rows with a time of the given notation, forty of them.
fn rows(header: &str, row: impl Fn(u32) -> String) -> Vec<u8> {
    let rows: String = (0..40).map(|number| row(number) + "\n").collect();
    format!("{header}\n{rows}").into_bytes()
}

/// The mappings, each with a log that it reads.
fn shapes() -> [(Mapping, Vec<u8>); 5] {
    let mapping = |time: &str, more: &str| {
        let text = format!(
            "columns:\n  time: {{{time}}}\n  rotary_speed: {{column: rpm, unit: RPM}}\n  \
             weight_on_bit: {{direct: {{column: wob, unit: klbs}}}}\n{more}"
        );
        Mapping::from_text("mapping.yaml", &text).unwrap()
    };
    let las = "~V\nVERS. 2.0:\nWRAP. NO:\n~W\nSTRT.S 0:\nSTOP.S 39:\nSTEP.S 1:\nNULL. -999.25:\n~C\nt.S : time\nrpm.RPM : \
               speed\nwob.KLB : weight\n~A";
    [
        (
            mapping("column: t, format: excel_days", "thousands: \"'\"\n"),
            rows("t,rpm,wob", |row| {
                format!("{:.8},{},1'0{row:02}.5", 46_051.5 + f64::from(row) / 86_400.0, 40 + row)
            }),
        ),
        (
            mapping(
                "column: t, format: \"%d/%m/%Y-%H:%M:%S\"",
                "separator: ;\ndecimal: comma\n",
            ),
            rows("written by a recorder\nt;rpm;wob", |row| {
                format!("29/01/2026-11:59:{row:02};{},5;{row},25", 40 + row)
            }),
        ),
        (
            mapping("date: d, clock: c", ""),
            rows("sep=,\nd,c,rpm,wob,", |row| {
                format!("2026-01-29,23:59:{row:02},{},{row},", 40 + row)
            }),
        ),
        (
            mapping("column: t", "separator: \" \"\n"),
            rows("  t   rpm  wob", |row| format!("  {row}\t {}   {row}.5 ", 40 + row)),
        ),
        (
            mapping("column: t", ""),
            rows(las, |row| format!(" {row} {} {row}.5", 40 + row)),
        ),
    ]
}

/// Each row is used or left out with a reason, each value is a number, times go forward, and a proposed mapping can be read.
#[test]
fn field_log_shapes() {
    let (mappings, logs): (Vec<Mapping>, Vec<Vec<u8>>) = shapes().into_iter().unzip();
    let mut seeds: Vec<Vec<u8>> = logs
        .iter()
        .zip(0..)
        .map(|(log, kind)| [&[kind], &log[..]].concat())
        .collect();
    seeds.push([&[3], &zstd::encode_all(&logs[3][..], 1).unwrap()[..]].concat());
    Target {
        name: "field_log_shapes",
        seeds,
        words: WORDS,
        run: &mut |bytes| {
            let (kind, content) = bytes.split_first().unwrap_or((&0, bytes));
            // A guess is for a person; what it writes must be a mapping, whatever the log is.
            if let Ok(guess) = field_log::guess_bytes("log.csv".to_owned(), content)
                && guess.lacks().is_empty()
            {
                let text = guess.mapping_file();
                Mapping::from_text("guess.yaml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            }
            let mapping = &mappings[usize::from(*kind) % mappings.len()];
            let (sequence, report) = match field_log::read_bytes("log.csv".to_owned(), content, mapping, &Range::ALL) {
                Ok(read) => read,
                Err(error) => return says_why(&error),
            };
            let inputs = &sequence.inputs;
            assert!(inputs.iter().all(|input| input.value.is_finite()));
            assert!(inputs.is_sorted_by_key(|input| input.time), "times go back");
            let is_within = |time: f64| (0.0..=sequence.duration).contains(&time);
            assert!(inputs.iter().all(|input| is_within(input.time)), "{report}");
            let mut used: Vec<u64> = inputs.iter().map(|input| input.row).collect();
            used.sort_unstable();
            used.dedup();
            assert!(used.len() as u64 <= report.rows, "{report}");
            true
        },
    }
    .fuzz();
}
