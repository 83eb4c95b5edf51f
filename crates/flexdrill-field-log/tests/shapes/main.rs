//! The shapes in which rigs, recorders and spreadsheets write logs: each is read rightly, or refused with the cause and
//! the line of the mapping that cures it. `docs/rig_inputs.md` lists them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod mutated;
mod times;

use flexdrill_core::inputs::InputKind;
use flexdrill_field_log::{FieldLogError, InputSequence, IssueKind, Mapping, Position, Range, Report, read_bytes};

/// A mapping with this time column and these further lines at its end.
fn mapping_of(time: &str, more: &str) -> Mapping {
    let text = format!(
        "columns:\n  time: {{{time}}}\n  rotary_speed: {{column: rpm, unit: r/min}}\n  \
         weight_on_bit: {{direct: {{column: wob, unit: kN}}}}\n{more}\n"
    );
    Mapping::from_text("mapping.yaml", &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn read(content: &[u8], mapping: &Mapping) -> Result<(InputSequence, Report), FieldLogError> {
    read_bytes("log.csv".to_owned(), content, mapping, &Range::ALL)
}

fn good(content: &str, mapping: &Mapping) -> (InputSequence, Report) {
    read(content.as_bytes(), mapping).unwrap_or_else(|error| panic!("{error}\n{content}"))
}

/// The error of a log that is refused, which has these words.
fn refused(content: &str, mapping: &Mapping, words: &[&str]) -> String {
    let error = match read(content.as_bytes(), mapping) {
        Ok((_, report)) => panic!("it was read:\n{report}"),
        Err(error) => error.to_string(),
    };
    for words in words {
        assert!(error.contains(words), "{words} is not in: {error}");
    }
    error
}

fn values(sequence: &InputSequence, kind: InputKind) -> Vec<(u64, f64)> {
    let of_kind = sequence.inputs.iter().filter(|input| input.kind == kind);
    of_kind.map(|input| (input.row, input.value)).collect()
}

/// Ten rows with these times.
fn log_of(header: &str, time: impl Fn(u32) -> String) -> String {
    let rows: String = (0..10).map(|row| format!("{},{},2.5\n", time(row), 40 + row)).collect();
    format!("{header},rpm,wob\n{rows}")
}

/// `29-Jan-2026 11:59:20` and later seconds, as minute and second.
fn minute_and_second(row: u32) -> (u32, u32) {
    (57 + (20 + row * 15) / 60, (20 + row * 15) % 60)
}

#[test]
fn a_log_by_depth_is_named() {
    refused(
        &log_of("Depth", |row| format!("{:.2}", 3000.0 + 0.9 * f64::from(row))),
        &mapping_of("column: Depth", ""),
        &["it seems to be a depth", "export it by time"],
    );
    refused(
        &log_of("x", |row| format!("{:.4}", 3000.0 + 0.1524 * f64::from(row))),
        &mapping_of("column: x", ""),
        &["it seems to be a depth"],
    );
    let text = "DEPT,time_s,rpm,wob\n3000,1,40,2\n3000.1,2,40,2\n3000.2,3,40,2\n3000.3,4,40,2\n";
    refused(text, &mapping_of("column: DEPT", ""), &["`time: {column: \"time_s\"}`"]);
}

#[test]
fn rows_that_are_too_rare_name_the_limit() {
    let text = log_of("t", |row| format!("2026-01-29 {row:02}:00:00"));
    let iso = mapping_of("column: t, format: iso8601", "");
    refused(&text, &iso, &["3600 s apart", "`quality: {max_gap: 7200}`"]);
    let (_, report) = good(
        &text,
        &mapping_of("column: t, format: iso8601", "quality: {max_gap: 7200}"),
    );
    assert_eq!(report.rows, 10);
}

#[test]
fn the_newest_row_first_is_turned_and_keeps_its_numbers() {
    let text = log_of("t", |row| (100 - row).to_string()) + "end of log,,\n";
    let (sequence, report) = good(&text, &mapping_of("column: t", ""));
    assert_eq!(
        (report.first_row, report.last_row, report.rows, report.left_out),
        (2, 11, 10, 1)
    );
    assert!(report.newest_first && report.parts.is_empty());
    assert!(report.to_string().contains("THE NEWEST ROW IS FIRST"), "{report}");
    // The oldest row is the last of the file.
    assert_eq!(
        (
            sequence.inputs[0].row,
            sequence.inputs[0].time,
            sequence.inputs[0].value
        ),
        (11, 0.0, 49.0)
    );
    assert_eq!(sequence.duration, 9.0);
    assert!(sequence.inputs.is_sorted_by_key(|input| input.time));
    let unreadable: Vec<u64> = report.issues.iter().map(|issue| issue.first_row).collect();
    assert_eq!(unreadable, [12]);
    // A range is of rows as an editor numbers them.
    let range = Range {
        from: Some(Position::Row(3)),
        to: Some(Position::Row(5)),
    };
    let (sequence, report) =
        read_bytes("log".to_owned(), text.as_bytes(), &mapping_of("column: t", ""), &range).unwrap();
    assert_eq!(
        (report.first_row, report.last_row, report.rows, report.left_out),
        (3, 5, 3, 0)
    );
    assert_eq!(
        values(&sequence, InputKind::RotarySpeed),
        [(5, 43.0), (4, 42.0), (3, 41.0)]
    );
    // A clock that falls over midnight.
    let clock = log_of("t", |row| {
        format!(
            "{}:{:02}",
            if row < 5 { "00:00" } else { "23:59" },
            if row < 5 { 4 - row } else { 64 - row }
        )
    });
    let (_, report) = good(&clock, &mapping_of("column: t, format: time_of_day", ""));
    assert_eq!((report.rows, report.duration, report.newest_first), (10, 9.0, true));
}

#[test]
fn rows_that_are_not_in_the_order_of_time_are_refused() {
    let text = log_of("t", |row| (row * 7 % 10).to_string());
    refused(
        &text,
        &mapping_of("column: t", ""),
        &["it falls in", "sort the rows of the log by time"],
    );
    refused(
        &log_of("t", |_| "5".to_owned()),
        &mapping_of("column: t", ""),
        &["9 of 9 rows repeat the time"],
    );
    // A time without seconds keeps one row of sixty.
    let text: String = (0..300)
        .map(|row| format!("2026-01-29 11:{:02},40,2\n", row / 60))
        .collect();
    let text = format!("date,rpm,wob\n{text}");
    refused(
        &text,
        &mapping_of("column: date, format: iso8601", ""),
        &["295 of 299 rows repeat the time", "export the log with seconds"],
    );
}

#[test]
fn an_input_without_a_usable_value_refuses_the_log() {
    let mapping = mapping_of("column: t", "");
    refused(
        "t,rpm,wob\n0,40,\n1,40,\n2,40,x\n",
        &mapping,
        &[
            "column `wob` has no usable value for weight_on_bit in 3 rows: missing value: empty",
            "weight_on_bit: {direct",
        ],
    );
    refused(
        "t,rpm,wob\n0,NaN,1\n1,n/a,1\n",
        &mapping,
        &["for rotary_speed", "\"NaN\" is not a number"],
    );
    refused(
        "t,rpm,wob\n0,40,-999.25\n1,40,-999.25\n",
        &mapping,
        &["missing code: -999.25 stands for no value in many recorders: add `missing: [-999.25]`"],
    );
    let text = "columns:\n  time: {column: t}\n  rotary_speed: {column: rpm, unit: RPM}\n  weight_on_bit: {direct: {column: \
                wob, unit: klbs}}\n  rate_of_penetration: {column: rop, unit: ft/hr}\n";
    let rate = Mapping::from_text("mapping.yaml", text).unwrap();
    refused(
        "t,rpm,wob,rop\n0,40,1,\n",
        &rate,
        &["remove `rate_of_penetration` from the mapping"],
    );
    let text = "columns:\n  time: {column: t}\n  rotary_speed: {column: rpm, unit: r/min}\n  weight_on_bit:\n    hookload: \
                {column: hl, unit: kN, drilling: {column: s, values: [2]}, off_bottom: {column: s, values: [4]}}\n";
    let hookload = Mapping::from_text("mapping.yaml", text).unwrap();
    refused("t,rpm,hl,s\n0,40,100,2\n1,40,100,2\n", &hookload, &["no tare yet"]);
}

#[test]
fn missing_codes_that_the_mapping_does_not_list_are_no_values() {
    let text = "t,rpm,wob\n0,40,1\n1,-999.25,2\n2,41,-9999\n3,42,-8888\n";
    let (sequence, report) = good(text, &mapping_of("column: t", ""));
    assert!(sequence.inputs.iter().all(|input| input.value > 0.0));
    assert_eq!(report.rows_with(IssueKind::MissingCode), 3);
    assert!(report.to_string().contains("add `missing: [-9999]`"), "{report}");
    let (_, report) = good(text, &mapping_of("column: t", "missing: [-999.25, -9999, -8888]"));
    assert_eq!(
        (
            report.rows_with(IssueKind::MissingCode),
            report.rows_with(IssueKind::Missing)
        ),
        (0, 3)
    );
}

#[test]
fn trailing_separators_are_ignored() {
    let mapping = mapping_of("column: t", "");
    let (sequence, report) = good("t,rpm,wob\n0,40,1,\n1,41,2,\n2,42,\n3,43,3,9\n", &mapping);
    assert_eq!(values(&sequence, InputKind::WeightOnBit), [(2, 1.0), (3, 2.0)]);
    assert_eq!((report.rows, report.left_out), (2, 2));
    assert!(
        report.to_string().contains("1 empty fields more than the header"),
        "{report}"
    );
    let (sequence, _) = good("t,rpm,wob,,\n0,40,1\n1,41,2\n", &mapping);
    assert_eq!(values(&sequence, InputKind::WeightOnBit).len(), 2);
    // A field more in single rows shifts their values.
    let (_, report) = good("t,rpm,wob\n0,40,1\n1,,41,2\n1,40,,\n2,40,1\n", &mapping);
    assert_eq!((report.rows, report.left_out), (2, 2));
}

#[test]
fn a_preamble_and_a_line_with_the_separator() {
    let comma = mapping_of("column: t", "");
    let text = "Well: A-1\nRig, date\n\nt,rpm,wob\ns,r/min,kN\n0,40,1\n1,41,2\n";
    let (sequence, report) = good(text, &comma);
    assert_eq!(values(&sequence, InputKind::RotarySpeed), [(6, 40.0), (7, 41.0)]);
    assert_eq!((report.rows, report.left_out), (2, 1));
    assert!(report.to_string().contains("the header is row 4"), "{report}");
    assert_eq!(good(text, &mapping_of("column: t", "header_row: 4")).0, sequence);
    refused(
        text,
        &mapping_of("column: t", "header_row: 99"),
        &["row 99, which `header_row`"],
    );
    refused(
        text,
        &mapping_of("column: t", "header_row: 3"),
        &["row 3, which `header_row`"],
    );
    let (sequence, report) = good("sep=;\nt;rpm;wob\n0;40;1\n1;41;2\n", &comma);
    assert_eq!(values(&sequence, InputKind::RotarySpeed), [(3, 40.0), (4, 41.0)]);
    assert!(report.to_string().contains("row 1 says that ';' separates"), "{report}");
}

#[test]
fn thousands_and_no_break_blanks() {
    let text = "t;rpm;wob\u{a0}\n0;\u{a0}40\u{a0};1\u{202f}234.5\n1;41;1,234.5\n2;42;1'234\n3;43;1,234\n";
    let (sequence, report) = good(text, &mapping_of("column: t", "separator: \";\""));
    assert_eq!(
        values(&sequence, InputKind::WeightOnBit),
        [(2, 1234.5), (3, 1234.5), (4, 1234.0)]
    );
    let issue = &report.issues[0];
    assert_eq!((issue.first_row, issue.kind), (5, IssueKind::Unreadable));
    assert!(issue.detail.contains("`thousands: \",\"`"), "{}", issue.detail);
    let (sequence, _) = good(text, &mapping_of("column: t", "separator: \";\"\nthousands: \",\""));
    assert_eq!(values(&sequence, InputKind::WeightOnBit)[3], (5, 1234.0));
    let comma = "t;rpm;wob\n0;40;1.234,5\n1;41;0,5\n";
    let (sequence, _) = good(comma, &mapping_of("column: t", "separator: \";\"\ndecimal: comma"));
    assert_eq!(values(&sequence, InputKind::WeightOnBit), [(2, 1234.5), (3, 0.5)]);
}

#[test]
fn columns_between_blanks() {
    let text = "  t     rpm\twob\n  0.0   40   1.5\n 10.0  41     2\n 11.0  42\n";
    let (sequence, report) = good(text, &mapping_of("column: t", "separator: \" \""));
    assert_eq!(values(&sequence, InputKind::WeightOnBit), [(2, 1.5), (3, 2.0)]);
    assert_eq!((report.rows, report.left_out), (2, 1));
}

const LAS: &str = "# by a logger\n~Version information\n VERS.   2.0 : CWLS LOG ASCII STANDARD\n WRAP.   NO  : One line per step\n\
    ~Well\n STRT.S  0 : START\n NULL.   -999.25 : NULL VALUE\n DATE.   11:59:20 29/01/2026 : LOG DATE\n~Curve\n \
    t  .S   : time\n rpm .RPM : speed\n wob .KLB 7 00 : weight\n~A  t rpm wob\n0 40 1\n1 41 -999.25\n# a remark\n2 42 3\n";

#[test]
fn las_by_time() {
    let mapping = mapping_of("column: t", "");
    let (sequence, report) = good(LAS, &mapping);
    assert_eq!(
        values(&sequence, InputKind::RotarySpeed),
        [(14, 40.0), (15, 41.0), (17, 42.0)]
    );
    assert_eq!(values(&sequence, InputKind::WeightOnBit), [(14, 1.0), (17, 3.0)]);
    assert_eq!((report.rows_with(IssueKind::Missing), report.rows), (1, 3));
    let table = report.to_string();
    assert!(table.contains("the log is LAS"), "{table}");
    assert!(
        table.contains("CHECK THE UNIT of column `wob`: the log gives it as KLB, the mapping reads it in kN"),
        "{table}"
    );
    refused(
        &LAS.replace("t  .S ", "t  .MS"),
        &mapping,
        &["its unit as \"MS\"", "`format: milliseconds`"],
    );
    let by_depth = LAS.replace(" t  .S ", " DEPT.M ");
    refused(&by_depth, &mapping_of("column: DEPT", ""), &["it seems to be a depth"]);
    refused(
        &LAS.replace("WRAP.   NO", "WRAP.   YES"),
        &mapping,
        &["export the log without wrapping"],
    );
    refused(
        &LAS.replace("VERS.   2.0", "VERS.   3.0"),
        &mapping,
        &["versions 1.2 and 2.0 are read"],
    );
    refused(&LAS[..200], &mapping, &["no section ~A"]);
    refused(
        &LAS.replace("wob .KLB", "hook.KLB"),
        &mapping,
        &["no column `wob`", "t, rpm, hook"],
    );
}

#[test]
fn compressed_logs_are_read_and_damaged_ones_refused() {
    let text = log_of("t", |row| row.to_string());
    let mapping = mapping_of("column: t", "");
    let packed = zstd::encode_all(text.as_bytes(), 3).unwrap();
    assert_eq!(read(&packed, &mapping).unwrap().0, good(&text, &mapping).0);
    for length in 4..packed.len() {
        let error = read(&packed[..length], &mapping).unwrap_err().to_string();
        assert!(error.contains("copy it again") || error.contains("header"), "{error}");
    }
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    std::io::Write::write_all(&mut gzip, text.as_bytes()).unwrap();
    assert_eq!(
        read(&gzip.finish().unwrap(), &mapping).unwrap().0,
        good(&text, &mapping).0
    );
    let error = read(b"PK\x03\x04\x14\0", &mapping).unwrap_err().to_string();
    assert!(error.contains("workbook"), "{error}");
}

#[test]
fn units_in_the_names_are_compared_with_the_mapping() {
    let text = "columns:\n  time: {column: t}\n  rotary_speed: {column: \"speed [rev/min]\", unit: rpm}\n  \
                weight_on_bit: {direct: {column: \"WOB (kip)\", unit: KDN}}\n";
    let mapping = Mapping::from_text("mapping.yaml", text).unwrap();
    let (sequence, report) = good("t,speed [rev/min],WOB (kip)\n0,40,2\n1,41,3\n", &mapping);
    assert_eq!(values(&sequence, InputKind::WeightOnBit), [(2, 20.0), (3, 30.0)]);
    assert!(
        report
            .to_string()
            .contains("the log gives it as kip, the mapping reads it in kdaN"),
        "{report}"
    );
    assert_eq!(report.notes.len(), 1, "{report}");
}
