//! Field logs: what is read, what is reported with which row, and that nothing makes the reader panic.

mod notation;
mod times;

use std::io::Write;
use std::path::{Path, PathBuf};

use flexdrill::field_log::{
    FieldLogError, InputSequence, IssueKind, Mapping, Position, Range, Report, read, read_range,
};
use flexdrill_config::Config;
use flexdrill_core::inputs::{Conditioner, InputKind};
use proptest::prelude::*;

fn config_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("config").join(name)
}

fn rig_mapping() -> Mapping {
    Mapping::load(config_file("field_logs/rig_1hz.yaml")).unwrap_or_else(|error| panic!("{error}"))
}

fn direct_mapping() -> Mapping {
    Mapping::from_text(
        "direct.yaml",
        "columns:
  time: {column: t}
  rotary_speed: {column: rpm, unit: r/min}
  weight_on_bit: {direct: {column: wob, unit: kN, scale: 0.5}}
missing: [-999.25]
",
    )
    .unwrap_or_else(|error| panic!("{error}"))
}

fn read_text(text: &[u8], mapping: &Mapping) -> Result<(InputSequence, Report), FieldLogError> {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(text).unwrap();
    read(file.path(), mapping)
}

fn values(sequence: &InputSequence, kind: InputKind) -> Vec<(u64, f64)> {
    let of_kind = sequence.inputs.iter().filter(|input| input.kind == kind);
    of_kind.map(|input| (input.row, input.value)).collect()
}

/// The log of the demonstration.
fn demo_log() -> String {
    std::fs::read_to_string(config_file("field_logs/demo.csv")).unwrap()
}

/// (first row, last row, rows) of every issue of a kind.
fn places(report: &Report, kind: IssueKind) -> Vec<(u64, u64, u64)> {
    let of_kind = report.issues.iter().filter(|issue| issue.kind == kind);
    of_kind
        .map(|issue| (issue.first_row, issue.last_row, issue.rows))
        .collect()
}

#[test]
fn the_demo_log_shows_everything() {
    let (sequence, report) = read(config_file("field_logs/demo.csv"), &rig_mapping()).unwrap();
    // Row of second s: s + 2 up to the gap of six rows after second 137, s - 4 after it.
    assert_eq!(places(&report, IssueKind::Gap), [(140, 140, 1)]);
    assert_eq!(places(&report, IssueKind::Missing), [(146, 148, 3), (146, 148, 3)]);
    assert_eq!(places(&report, IssueKind::Spike), [(154, 154, 1)]);
    assert_eq!(places(&report, IssueKind::TimeRepeats), [(159, 159, 1)]);
    assert!(places(&report, IssueKind::NoTare).is_empty());
    assert_eq!(report.rows, 173);
    assert!(
        (report.tares[0].hookload_kn - 48.0 * 4.448_221_615).abs() < 0.5,
        "{:?}",
        report.tares
    );
    // The step to 10 kN: the hookload's noise is 0.15 klbf, so 0.7 kN, and the tare has its part.
    for (row, weight) in values(&sequence, InputKind::WeightOnBit) {
        if (90..110).contains(&row) {
            assert!((weight - 10.0).abs() < 1.2, "row {row}: {weight} kN");
        }
        if row < 52 {
            assert_eq!(weight, 0.0, "row {row}, off bottom");
        }
    }
    let stalled = values(&sequence, InputKind::RotarySpeed)
        .into_iter()
        .filter(|(row, rpm)| *row > 60 && *rpm == 0.0);
    assert!(stalled.count() >= 4);
    let table = report.to_string();
    for words in [
        "rows 2 to 175",
        "tare - hookload",
        "row 140: 6.8 s since",
        "412.0 r/min between 40.2 and 39.6",
    ] {
        assert!(table.contains(words), "{words} is not in\n{table}");
    }
}

/// The whole way that a topic's sample takes: nothing of the demo log is refused by the default limits.
#[test]
fn the_demo_log_passes_the_door() {
    let config = Config::load(config_file("default.yaml")).unwrap();
    let mut conditioner = Conditioner::new(config.inputs.rules());
    let (sequence, _) = read(config_file("field_logs/demo.csv"), &rig_mapping()).unwrap();
    for input in &sequence.inputs {
        conditioner.offer(input.kind, input.value, input.time).unwrap();
    }
    assert!(sequence.duration > 175.0);
}

#[test]
fn a_weight_column_is_scaled_and_said_so() {
    let (sequence, report) = read_text(b"t,rpm,wob\n10,40,20\n11,41,22\n", &direct_mapping()).unwrap();
    assert_eq!(values(&sequence, InputKind::WeightOnBit), [(2, 10.0), (3, 11.0)]);
    assert_eq!(values(&sequence, InputKind::RotarySpeed), [(2, 40.0), (3, 41.0)]);
    assert_eq!(sequence.inputs[0].time, 0.0);
    assert_eq!(sequence.inputs[2].time, 1.0);
    let table = report.to_string();
    assert!(table.contains("weight_on_bit IS SCALED, log x 0.5"), "{table}");
    assert!(table.contains("rotary_speed is used unchanged"), "{table}");
    assert!(table.contains("nothing wrong found"), "{table}");
}

#[test]
fn wrong_rows_are_left_out_and_named() {
    let text = b"t,rpm,wob\n0,40,1\n1,x,1\n1,40,1\n0.5,40,1\n2,40\n3,,1\n4,inf,1\nlunch,40,1\n5,40,\xff\n30,40,1\n";
    let (sequence, report) = read_text(text, &direct_mapping()).unwrap();
    assert_eq!(places(&report, IssueKind::TimeRepeats), [(4, 4, 1)]);
    assert_eq!(places(&report, IssueKind::TimeBackwards), [(5, 5, 1)]);
    let detail = |kind| &report.issues.iter().find(|issue| issue.kind == kind).unwrap().detail;
    assert_eq!(detail(IssueKind::TimeRepeats), "that of the row before");
    assert_eq!(detail(IssueKind::TimeBackwards), "by 0.5 s");
    assert_eq!(places(&report, IssueKind::Missing), [(7, 7, 1)]);
    assert_eq!(places(&report, IssueKind::Gap), [(11, 11, 1)]);
    let unreadable: Vec<_> = report
        .issues
        .iter()
        .filter(|issue| issue.kind == IssueKind::Unreadable)
        .map(|issue| (issue.first_row, issue.column.as_str(), issue.detail.as_str()))
        .collect();
    assert_eq!(
        unreadable,
        [
            (3, "rpm", "\"x\" is not a number"),
            (6, "", "2 fields instead of 3"),
            (8, "rpm", "\"inf\" is not a number"),
            (9, "t", "\"lunch\" is not a time"),
            (10, "wob", "not text"),
        ]
    );
    assert_eq!(values(&sequence, InputKind::RotarySpeed).len(), 3);
}

/// However lines end, and with empty lines and line ends in quotes between.
#[test]
fn rows_are_numbered_as_an_editor_does() {
    for text in [
        "t,rpm,wob\n0,1,1\n\n1,\"x\ny\",1\n2,z,1\n",
        "t,rpm,wob\r\n0,1,1\r\n\r\n1,\"x\r\ny\",1\r\n2,z,1\r\n",
    ] {
        let (_, report) = read_text(text.as_bytes(), &direct_mapping()).unwrap();
        let rows: Vec<u64> = report.issues.iter().map(|issue| issue.first_row).collect();
        assert_eq!(rows, [4, 6], "{text:?}");
        assert_eq!((report.first_row, report.last_row), (2, 6));
    }
}

/// Rows that are left out as a whole.
fn left_out(report: &Report) -> u64 {
    report
        .issues
        .iter()
        .filter(|issue| match issue.kind {
            IssueKind::Unreadable => issue.column.is_empty() || issue.column == "t",
            IssueKind::TimeRepeats | IssueKind::TimeBackwards | IssueKind::TimeJumps => true,
            _ => false,
        })
        .map(|issue| issue.rows)
        .sum()
}

#[test]
fn unreadable_rows_at_both_ends_are_told() {
    let text = b"t,rpm,wob\nlunch,1,1\n0;1;1\n0,40,1\n1,40,1\n2,40\nend of log,,\n";
    let (_, report) = read_text(text, &direct_mapping()).unwrap();
    let unreadable: Vec<(u64, u64)> = (report.issues.iter())
        .map(|issue| (issue.first_row, issue.last_row))
        .collect();
    assert_eq!(unreadable, [(2, 2), (3, 3), (6, 6), (7, 7)]);
    assert_eq!(
        (report.first_row, report.last_row, report.rows, report.left_out),
        (4, 5, 2, 4)
    );
    let table = report.to_string();
    assert!(
        table.contains("2 used, 4 LEFT OUT") && !table.contains("nothing wrong"),
        "{table}"
    );
}

#[test]
fn a_stray_quote_costs_the_row_that_it_is_in() {
    let log = demo_log();
    let rows = log.lines().count() as u64 - 1;
    for row in [1, 80, rows - 1] {
        let damaged: String = log
            .lines()
            .enumerate()
            .map(|(index, line)| {
                if index as u64 == row {
                    format!("\"{line}\n")
                } else {
                    format!("{line}\n")
                }
            })
            .collect();
        let (_, report) = read_text(damaged.as_bytes(), &rig_mapping()).unwrap();
        assert_eq!(report.rows + report.left_out, rows, "quote in row {}", row + 1);
        assert!(
            places(&report, IssueKind::Unreadable).contains(&(row + 1, row + 1, 1)),
            "quote in row {}: {report}",
            row + 1
        );
        // One more than without it: the demo log has a time that stands still.
        assert_eq!(report.left_out, 2, "quote in row {}", row + 1);
    }
}

#[test]
fn a_frozen_value_is_reported_and_kept() {
    let mut text = String::from("t,rpm,wob\n");
    for second in 0..300 {
        text += &format!("{second},{},7.5\n", second % 3);
    }
    let (sequence, report) = read_text(text.as_bytes(), &direct_mapping()).unwrap();
    assert_eq!(places(&report, IssueKind::Frozen), [(2, 301, 300)]);
    assert_eq!(values(&sequence, InputKind::WeightOnBit).len(), 300);
}

#[test]
fn hookload_without_a_tare_gives_no_weight() {
    let mapping = rig_mapping();
    let mut text = String::from("time_s,hookload_klbf,top_drive_rpm,rig_state\n");
    for second in 0..10 {
        text += &format!("{second},45,60,2\n");
    }
    // Off bottom and rotating, then drilling, then a hookload far above the tare.
    for second in 10..40 {
        text += &format!("{second},50,60,4\n");
    }
    text += "40,48,60,2\n41,50.5,60,2\n42,55,60,2\n";
    let (sequence, report) = read_text(text.as_bytes(), &mapping).unwrap();
    assert_eq!(places(&report, IssueKind::NoTare), [(2, 11, 10)]);
    assert_eq!(places(&report, IssueKind::TareNoise), [(43, 43, 1)]);
    assert_eq!(places(&report, IssueKind::NegativeWeight), [(44, 44, 1)]);
    assert_eq!((report.tares[0].first_row, report.tares[0].last_row), (12, 41));
    let weights = values(&sequence, InputKind::WeightOnBit);
    assert_eq!(weights.len(), 32);
    let (row, weight) = weights[30];
    assert_eq!(row, 42);
    assert!((weight - 2.0 * 4.448_221_615_260_5).abs() < 1e-9);
    assert_eq!(weights[31], (43, 0.0));
}

#[test]
fn a_range_keeps_the_tare_from_before_it() {
    let range = Range {
        from: Some("row:92".parse().unwrap()),
        to: Some("100s".parse().unwrap()),
    };
    let (sequence, report) = read_range(config_file("field_logs/demo.csv"), &rig_mapping(), &range).unwrap();
    assert_eq!((report.first_row, report.last_row), (92, 101));
    assert_eq!(sequence.inputs[0].time, 0.0);
    assert_eq!(report.tares.len(), 1);
    assert!(report.inputs[1].median > 8.0);
    assert!(
        report
            .issues
            .iter()
            .all(|issue| issue.first_row >= 92 && issue.last_row <= 102)
    );
}

#[test]
fn places_are_rows_or_seconds() {
    assert_eq!("row:6345".parse::<Position>().unwrap(), Position::Row(6345));
    assert_eq!("90".parse::<Position>().unwrap(), Position::Time(90.0));
    assert_eq!("90s".parse::<Position>().unwrap(), Position::Time(90.0));
    for text in [
        "", "s", "-5", "-5s", "nans", "1e999s", "1e-308", "inf", "1e11", "row 5", "row:-5",
    ] {
        assert!(text.parse::<Position>().is_err(), "{text}");
    }
}

#[test]
fn errors_name_file_and_column() {
    let error = read_text(b"t,rpm,weight\n0,1,2\n", &direct_mapping())
        .unwrap_err()
        .to_string();
    assert!(
        error.ends_with("no column `wob`, which columns.weight_on_bit.direct.column of the mapping names; the header has: t, rpm, weight"),
        "{error}"
    );
    let error = read_text(b"t,rpm,wob\nmonday,1,2\n", &direct_mapping())
        .unwrap_err()
        .to_string();
    assert!(error.contains("no row with a readable time in column `t`"), "{error}");
    let error = read("no/such.csv", &direct_mapping()).unwrap_err().to_string();
    assert!(error.starts_with("no/such.csv: cannot be read"), "{error}");
    let range = Range {
        from: Some(Position::Row(5000)),
        to: None,
    };
    let error = read_range(config_file("field_logs/demo.csv"), &rig_mapping(), &range)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("no row lies between row 5000 and the log's end; the log has rows 2 to 175"),
        "{error}"
    );
    let error = Mapping::from_text("m.yaml", "columns:\n  time: {column: t}\n")
        .unwrap_err()
        .to_string();
    assert_eq!(
        error,
        "m.yaml:1:1: columns.rotary_speed: must be given, it has no default"
    );
}

/// The real log, where it is: its README counts data rows from 0, an editor counts 2 more.
#[test]
fn the_real_rig_log_reads_as_its_description_says() {
    let Some(path) = crate::common::real_log() else { return };
    let (sequence, report) = read(&path, &rig_mapping()).unwrap();
    println!("{report}");
    assert_eq!((report.first_row, report.last_row), (2, 50_001));
    assert_eq!(places(&report, IssueKind::TimeRepeats).len(), 2);
    let missing = places(&report, IssueKind::Missing);
    assert!(missing.contains(&(38_001, 38_129, 129)), "{missing:?}");
    assert!(missing.contains(&(40_001, 41_329, 1329)), "{missing:?}");
    let mut conditioner = Conditioner::new(Config::load(config_file("default.yaml")).unwrap().inputs.rules());
    let refused = sequence
        .inputs
        .iter()
        .filter(|input| conditioner.offer(input.kind, input.value, input.time).is_err());
    assert_eq!(refused.count(), 0);
    // The steady stretch that the description gives: rows 6343 to 7899 at 49.1 r/min.
    let range = Range {
        from: Some(Position::Row(6345)),
        to: Some(Position::Row(7901)),
    };
    let (_, report) = read_range(&path, &rig_mapping(), &range).unwrap();
    assert!((report.inputs[0].median - 49.1).abs() < 0.05, "{report}");
    assert_eq!(report.tares.len(), 1, "{report}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn garbage_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = read_text(&bytes, &direct_mapping());
    }

    #[test]
    fn garbage_under_a_good_header_never_panics(body in "[0-9eE+.,\"\n -]{0,300}") {
        let text = format!("t,rpm,wob\n{body}");
        if let Ok((sequence, report)) = read_text(text.as_bytes(), &direct_mapping()) {
            prop_assert!(sequence.inputs.iter().all(|input| input.value.is_finite() && input.time >= 0.0));
            prop_assert!(sequence.inputs.windows(2).all(|pair| pair[0].time <= pair[1].time));
            let _ = report.to_string();
        }
    }

    /// Every row is used, or left out and told; the parts' reports tell of all of them too.
    #[test]
    fn every_row_is_accounted_for(rows in prop::collection::vec("([0-9]{1,3}|[0-9]{1,3}|x)(,[0-9\"]{1,2}){1,3}", 1..60)) {
        let text = format!("t,rpm,wob\n{}\n", rows.join("\n"));
        if let Ok((_, report)) = read_text(text.as_bytes(), &direct_mapping()) {
            prop_assert_eq!(report.rows + report.left_out, rows.len() as u64);
            prop_assert_eq!(left_out(&report), report.left_out);
            if !report.parts.is_empty() {
                let of_parts = |count: fn(&Report) -> u64| report.parts.iter().map(count).sum::<u64>();
                prop_assert_eq!(of_parts(|part| part.rows), report.rows);
                prop_assert_eq!(of_parts(|part| part.left_out), report.left_out);
            }
        }
    }

    #[test]
    fn damaged_demo_logs_never_panic(cut in 0usize..5000, insert in prop::collection::vec(any::<u8>(), 0..20)) {
        let mut bytes = demo_log().into_bytes();
        let cut = cut.min(bytes.len());
        bytes.splice(cut..cut, insert);
        if let Ok((_, report)) = read_text(&bytes, &rig_mapping()) {
            let _ = report.to_string();
        }
    }

    #[test]
    fn garbage_mappings_never_panic(text in "\\PC{0,200}") {
        let _ = Mapping::from_text("garbage", &text);
    }
}
