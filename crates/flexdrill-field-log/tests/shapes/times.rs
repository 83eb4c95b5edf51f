//! Notations of date and time.

use super::*;

#[test]
fn serial_days_of_a_spreadsheet_are_named() {
    let text = log_of("t", |row| format!("{:.10}", 46_051.5 + f64::from(row) / 86_400.0));
    let error = refused(
        &text,
        &mapping_of("column: t", ""),
        &["read as seconds", "set `format: excel_days` (1 s between rows)"],
    );
    assert!(!error.contains("hours"), "{error}");
    let (sequence, report) = good(&text, &mapping_of("column: t, format: excel_days", ""));
    assert!((report.duration - 9.0).abs() < 1e-3, "{report}");
    assert_eq!(report.rows, 10);
    // date -u -d 2026-01-29T12:00:00 +%s
    assert!((sequence.start.unwrap() - 1_769_688_000.0).abs() < 1e-3);
}

#[test]
fn milliseconds_and_hours_as_seconds_are_named() {
    let seconds = mapping_of("column: t", "");
    let milliseconds = log_of("t", |row| (1_769_688_000_000_u64 + u64::from(row) * 1000).to_string());
    refused(
        &milliseconds,
        &seconds,
        &["the rows are 1000 s apart", "`format: milliseconds` (1 s between rows)"],
    );
    assert_eq!(
        good(&milliseconds, &mapping_of("column: t, format: milliseconds", ""))
            .1
            .duration,
        9.0
    );
    refused(
        &log_of("t", |row| format!("{:.7}", f64::from(row) / 3600.0)),
        &seconds,
        &["`format: hours` (1 s between rows)"],
    );
    refused(
        &log_of("t", |row| row.to_string()),
        &mapping_of("column: t, format: milliseconds", ""),
        &["`format: seconds` (1 s between rows)"],
    );
    refused(
        &log_of("Time (ms)", |row| (row * 1000).to_string()),
        &mapping_of("column: Time (ms)", ""),
        &["its unit as \"ms\"", "set `format: milliseconds`"],
    );
}

#[test]
fn date_and_clock_in_two_columns() {
    let text = |date: &str, clock: &str| {
        let rows = [
            (29, "23:59:58"),
            (29, "23:59:59"),
            (31, "06:00:00"),
            (31, "06:00:01"),
            (31, "06:00:02"),
        ];
        let rows: String = rows
            .iter()
            .map(|(day, clock)| format!("{},{clock},40,2\n", date.replace("DD", &day.to_string())))
            .collect();
        format!("DATE,{clock},rpm,wob\n{rows}")
    };
    // The pause of 30 h and 1 s would be one of 6 h.
    refused(
        &text("2026-01-DD", "CLOCK"),
        &mapping_of("column: CLOCK, format: time_of_day", ""),
        &[
            "column `DATE` has several",
            "set `time: {date: \"DATE\", clock: \"CLOCK\"}`",
        ],
    );
    let both = mapping_of("date: DATE, clock: CLOCK", "");
    let (sequence, report) = good(&text("2026-01-DD", "CLOCK"), &both);
    assert_eq!((report.rows, report.duration), (5, 108_004.0));
    assert_eq!(sequence.start, Some(1_769_731_198.0)); // date -u -d 2026-01-29T23:59:58 +%s
    // A date of another notation is named with its format.
    let european = text("DD/01/2026", "CLOCK");
    refused(
        &european,
        &both,
        &["set `format: \"%d/%m/%Y %H:%M:%S\"` in `columns.time`"],
    );
    let (_, report) = good(
        &european,
        &mapping_of("date: DATE, clock: CLOCK, format: \"%d/%m/%Y %H:%M:%S\"", ""),
    );
    assert_eq!(report.duration, 108_004.0);
    // The column of the date alone.
    refused(
        &text("2026-01-DD", "CLOCK"),
        &mapping_of("column: DATE, format: iso8601", ""),
        &["it is a date alone: set `time: {date: \"DATE\", clock: \"CLOCK\"}`"],
    );
    // One date does no harm.
    let one = log_of("DATE,CLOCK", |row| format!("2026-01-29,11:59:{row:02}"));
    assert_eq!(
        good(&one, &mapping_of("column: CLOCK, format: time_of_day", "")).1.rows,
        10
    );
}

#[test]
fn notations_of_date_and_time_are_read_by_pattern_and_suggested() {
    type Write = dyn Fn(u32, u32) -> String;
    let patterns: [(&Write, &str); 4] = [
        (&|m, s| format!("29/01/2026-11:{m}:{s:02}"), "%d/%m/%Y-%H:%M:%S"),
        (&|m, s| format!("29-Jan-2026 11:{m}:{s:02}"), "%d-%b-%Y %H:%M:%S"),
        (&|m, s| format!("01/29/2026 11:{m}:{s:02} AM"), "%m/%d/%Y %I:%M:%S %p"),
        (
            &|m, s| format!("29.01.2026 11:{m}:{s:02} +02:00"),
            "%d.%m.%Y %H:%M:%S %:z",
        ),
    ];
    for (write, pattern) in patterns {
        let text = log_of("t", |row| {
            let (minute, second) = minute_and_second(row);
            write(minute, second)
        });
        refused(
            &text,
            &mapping_of("column: t", ""),
            &[&format!("set `format: \"{pattern}\"` in `columns.time`")],
        );
        let (sequence, report) = good(&text, &mapping_of(&format!("column: t, format: \"{pattern}\""), ""));
        assert_eq!((report.rows, report.duration), (10, 135.0), "{pattern}");
        assert!(sequence.start.is_some());
    }
    let iso = mapping_of("column: t, format: iso8601", "");
    let compact = log_of("t", |row| format!("20260129T1159{row:02}Z"));
    assert_eq!(good(&compact, &iso).1.duration, 9.0);
    let offset = log_of("t", |row| format!("2026-01-29 11:59:{row:02}.5 +02:00"));
    assert_eq!(good(&offset, &iso).1.duration, 9.0);
    let comma = log_of("t", |row| format!("\"2026-01-29 11:59:{row:02},250\""));
    assert_eq!(good(&comma, &iso).1.duration, 9.0);
    let clock = log_of("t", |row| format!("11:59:{row:02} AM"));
    refused(&clock, &mapping_of("column: t", ""), &["set `format: time_of_day`"]);
    assert_eq!(
        good(&clock, &mapping_of("column: t, format: time_of_day", ""))
            .1
            .duration,
        9.0
    );
    // Day and month cannot be distinguished here.
    let both = log_of("t", |row| format!("01/02/2026 11:59:{row:02}"));
    refused(
        &both,
        &mapping_of("column: t", ""),
        &["several formats fit", "%d/%m/%Y", "%m/%d/%Y"],
    );
}

#[test]
fn a_pattern_that_cannot_be_used_is_refused_in_the_mapping() {
    for (time, words) in [
        ("column: t, format: \"%d/%m/%Y\"", "columns.time.format"),
        ("column: t, format: \"%I:%M:%S\"", "columns.time.format"),
        ("column: t, format: second", "second"),
        ("date: d", "either column, or date and clock"),
        ("column: t, date: d, clock: c", "either column, or date and clock"),
        ("date: d, clock: c, format: seconds", "columns.time.format"),
        ("format: seconds", "columns.time.column"),
    ] {
        let text = format!(
            "columns:\n  time: {{{time}}}\n  rotary_speed: {{column: rpm, unit: r/min}}\n  \
             weight_on_bit: {{direct: {{column: wob, unit: kN}}}}\n"
        );
        let error = Mapping::from_text("mapping.yaml", &text).unwrap_err().to_string();
        assert!(
            error.contains(words) && error.contains("mapping.yaml:"),
            "{time}: {error}"
        );
    }
}
