//! Times of a log: over midnight, from a new beginning, far ahead.

use super::*;

/// An hour of 1 Hz over midnight.
fn over_midnight(write: impl Fn(u32) -> String) -> String {
    let rows = (84_600..88_200).map(|second| format!("{},40,1\n", write(second % 86_400)));
    std::iter::once("t,rpm,wob\n".to_owned()).chain(rows).collect()
}

#[test]
fn a_time_of_day_goes_on_over_midnight() {
    let mapping = Mapping::from_text(
        "clock.yaml",
        "columns:
  time: {column: t, format: time_of_day}
  rotary_speed: {column: rpm, unit: r/min}
  weight_on_bit: {direct: {column: wob, unit: kN}}
",
    )
    .unwrap();
    let clock = |second: u32| format!("{:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60);
    for text in [over_midnight(clock), over_midnight(|second| second.to_string())] {
        let (sequence, report) = read_text(text.as_bytes(), &mapping).unwrap();
        assert_eq!((report.rows, report.left_out, report.duration), (3600, 0, 3599.0));
        assert!(report.parts.is_empty());
        assert!(places(&report, IssueKind::Gap).is_empty());
        assert_eq!(sequence.inputs[2 * 1800].time, 1800.0);
    }
}

#[test]
fn a_time_that_starts_anew_begins_a_part_with_its_own_report() {
    let text = over_midnight(|second| second.to_string()) + "soup\n";
    let (sequence, report) = read_text(text.as_bytes(), &direct_mapping()).unwrap();
    assert_eq!((report.rows, report.left_out), (3600, 1));
    assert_eq!(places(&report, IssueKind::TimeRestarts), [(1802, 1802, 1)]);
    let parts: Vec<_> = (report.parts.iter())
        .map(|part| (part.first_row, part.last_row, part.rows, part.left_out, part.duration))
        .collect();
    assert_eq!(parts, [(2, 1801, 1800, 0, 1799.0), (1802, 3601, 1800, 1, 1799.0)]);
    assert_eq!(places(&report.parts[1], IssueKind::Unreadable), [(3602, 3602, 1)]);
    // Twice the longest time between rows: the inputs become stale, nothing is joined.
    assert_eq!(sequence.duration, 1799.0 + 10.0 + 1799.0);
    assert_eq!(sequence.inputs.len(), 7200);
    let table = report.to_string();
    assert!(
        table.contains("THE CLOCK RESTARTS, 2 parts") && table.contains("part 2"),
        "{table}"
    );
    // One part alone.
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(text.as_bytes()).unwrap();
    let range = Range {
        from: Some(Position::Row(1802)),
        to: None,
    };
    let (sequence, report) = read_range(file.path(), &direct_mapping(), &range).unwrap();
    assert_eq!((report.rows, report.left_out, report.parts.len()), (1800, 1, 0));
    assert_eq!((sequence.inputs[0].time, sequence.duration), (0.0, 1799.0));
}

#[test]
fn a_single_time_far_ahead_does_not_cost_the_rows_behind_it() {
    let mut text = String::from("t,rpm,wob\n");
    for second in 0..100 {
        text += &format!("{},40,1\n", if second == 50 { 999_999 } else { second });
    }
    let (sequence, report) = read_text(text.as_bytes(), &direct_mapping()).unwrap();
    assert_eq!(places(&report, IssueKind::TimeJumps), [(52, 52, 1)]);
    assert_eq!((report.rows, report.left_out, sequence.duration), (99, 1, 99.0));
}
