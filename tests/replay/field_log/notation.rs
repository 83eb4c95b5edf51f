//! How a log is written: columns, lines, encodings, decimal commas, units.

use super::*;

fn error_of(text: &[u8], mapping: &Mapping) -> String {
    match read_text(text, mapping) {
        Ok((_, report)) => panic!("it was read:\n{report}"),
        Err(error) => error.to_string(),
    }
}

/// Which of two columns of one name is meant, only the log's author knows.
#[test]
fn a_column_name_that_stands_twice_is_refused_with_both_places() {
    let error = error_of(b"t,rpm,wob,rpm\n0,2300,1,40\n1,2300,1,40\n", &direct_mapping());
    assert!(
        error.contains(
            "column `rpm`, which columns.rotary_speed.column of the mapping names, is in the header twice, as field 2 and \
             field 4"
        ),
        "{error}"
    );
    // A name that the mapping does not use, such as an empty one, may stand twice.
    let (sequence, _) = read_text(b"t,rpm,wob,,\n0,40,1,x,y\n1,40,1,x,y\n", &direct_mapping()).unwrap();
    assert_eq!(values(&sequence, InputKind::RotarySpeed), [(2, 40.0), (3, 40.0)]);
}

/// What reads a line needs a multiple of its length: a long line is left out before that.
#[test]
fn long_lines_are_left_out_and_a_long_header_is_refused() {
    let long = "9".repeat((1 << 20) + 1);
    let text = format!("t,rpm,wob\n0,40,1\n1,40,{long}\n2,41,1\n");
    let (sequence, report) = read_text(text.as_bytes(), &direct_mapping()).unwrap();
    assert_eq!(values(&sequence, InputKind::RotarySpeed), [(2, 40.0), (4, 41.0)]);
    assert_eq!(places(&report, IssueKind::Unreadable), [(3, 3, 1)]);
    assert!(
        report.issues[0].detail.contains("at most 1048576 are read"),
        "{}",
        report.issues[0].detail
    );
    let error = error_of(long.as_bytes(), &direct_mapping());
    assert!(
        error.contains("the first line has 1048577 bytes, at most 1048576 are read"),
        "{error}"
    );
    // A field is quoted in part.
    let text = format!("t,rpm,wob\n0,40,1\n1,{},1\n", "x".repeat(1000));
    let (_, report) = read_text(text.as_bytes(), &direct_mapping()).unwrap();
    assert!(report.issues[0].detail.len() < 100, "{}", report.issues[0].detail);
}

#[test]
fn a_log_in_utf_16_is_named_as_such() {
    let text = "t,rpm,wob\n0,40,1\n";
    let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    for (mark, bytes, name) in [
        (&b"\xff\xfe"[..], &little, "UTF-16"),
        (b"\xfe\xff", &big, "UTF-16"),
        (b"", &little, "UTF-16LE"),
        (b"", &big, "UTF-16BE"),
    ] {
        let error = error_of(&[mark, bytes].concat(), &direct_mapping());
        assert!(
            error.contains(&format!(
                "the encoding is {name}, not UTF-8; save the log as \"CSV UTF-8\""
            )),
            "{error}"
        );
        assert!(error.contains(&format!("iconv -f {name} -t UTF-8")), "{error}");
    }
}

fn decimal_mapping(separator: char, decimal: &str) -> Mapping {
    let text = format!(
        "separator: \"{separator}\"
decimal: {decimal}
missing: [-999.25]
columns:
  time: {{column: t}}
  rotary_speed: {{column: rpm, unit: rpm}}
  weight_on_bit: {{direct: {{column: wob, unit: t}}}}
"
    );
    Mapping::from_text("decimal.yaml", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// `rpm` and `t` are units too: turns per minute and tonne-force.
#[test]
fn decimal_commas_are_read_where_the_mapping_says_so() {
    let mapping = decimal_mapping(';', "comma");
    let text = b"t;rpm;wob\n0,5;40,25;2,0\n1,5;-999,25;2\n2,5;1.234;2\n";
    let (sequence, report) = read_text(text, &mapping).unwrap();
    assert_eq!(values(&sequence, InputKind::RotarySpeed), [(2, 40.25)]);
    assert_eq!(values(&sequence, InputKind::WeightOnBit)[0], (2, 2.0 * 9.806_65));
    assert_eq!(places(&report, IssueKind::Missing), [(3, 3, 1)]);
    // A point may stand between thousands.
    assert_eq!(places(&report, IssueKind::Unreadable), [(4, 4, 1)]);
    // Quoted fields may have the separator in them.
    let quoted = b"t,rpm,wob\n0,\"40,25\",2\n1,\"40,5\",2\n";
    let (sequence, _) = read_text(quoted, &decimal_mapping(',', "comma")).unwrap();
    assert_eq!(values(&sequence, InputKind::RotarySpeed), [(2, 40.25), (3, 40.5)]);
}

#[test]
fn decimal_commas_that_the_mapping_does_not_name_are_recognised() {
    let point = decimal_mapping(';', "point");
    let (_, report) = read_text(b"t;rpm;wob\n0;40,25;2\n1;40;2\n", &point).unwrap();
    let said = &report.issues[0].detail;
    assert!(
        said.contains("\"40,25\" is not a number") && said.contains("set `decimal: comma`"),
        "{said}"
    );
    // Without a readable time nothing can be read: the error says what to change.
    let error = error_of(b"t;rpm;wob\n0,5;40;2\n1,5;40;2\n", &point);
    assert!(
        error.contains("row 2: \"0,5\" is not a time") && error.contains("set `decimal: comma`"),
        "{error}"
    );
    let commas = decimal_mapping(',', "point");
    let (_, report) = read_text(b"t,rpm,wob\n0,40,2\n1,5,40,2,2,5\n2,40,2\n", &commas).unwrap();
    let said = &report.issues[0].detail;
    assert!(
        said.contains("6 fields instead of 3; decimal commas cannot be distinguished from separators"),
        "{said}"
    );
    let error = error_of(b"t;rpm;wob\n0;40;2\n", &commas);
    assert!(error.contains("set `separator: \";\"` in the mapping"), "{error}");
}

#[test]
fn weights_of_other_units_are_kilonewton() {
    for (unit, kilonewton) in [
        ("tf", 9.806_65),
        ("kgf", 9.806_65e-3),
        ("lbf", 4.448_221_615_260_5e-3),
        ("klbf", 4.448_221_615_260_5),
    ] {
        let mapping = format!(
            "columns:\n  time: {{column: t}}\n  rotary_speed: {{column: rpm, unit: r/min}}\n  \
             weight_on_bit: {{direct: {{column: wob, unit: {unit}}}}}\n"
        );
        let mapping = Mapping::from_text("units.yaml", &mapping).unwrap();
        let (sequence, _) = read_text(b"t,rpm,wob\n0,40,3\n", &mapping).unwrap();
        let [(_, weight)] = values(&sequence, InputKind::WeightOnBit)[..] else {
            panic!("{unit}");
        };
        // Both are the exact definitions, rounded once or twice.
        assert!((weight / (3.0 * kilonewton) - 1.0).abs() < 1e-15, "{unit}: {weight}");
    }
}

#[test]
fn a_torque_is_reported_in_one_unit() {
    for (unit, factor) in [
        ("N.m", 1e-3),
        ("kN.m", 1.0),
        ("kft.lbf", 4.448_221_615_260_5 * 0.3048),
        ("ft.lbf", 4.448_221_615_260_5e-3 * 0.3048),
    ] {
        let mapping = format!(
            "columns:\n  time: {{column: t}}\n  rotary_speed: {{column: rpm, unit: r/min}}\n  \
             weight_on_bit: {{direct: {{column: wob, unit: kN}}}}\n  torque: {{column: trq, unit: {unit}}}\n"
        );
        let mapping = Mapping::from_text("torque.yaml", &mapping).unwrap();
        let (_, report) = read_text(b"t,rpm,wob,trq\n0,40,3,2\n1,40,3,x\n2,40,3,4\n3,40,3,3\n", &mapping).unwrap();
        let torque = report.torque.unwrap();
        let (smallest, median, largest) = (torque.smallest_kn_m, torque.median_kn_m, torque.largest_kn_m);
        for (found, given) in [(smallest, 2.0), (median, 3.0), (largest, 4.0)] {
            // The exact definitions, rounded once or twice.
            assert!((found / (given * factor) - 1.0).abs() < 1e-15, "{unit}: {found}");
        }
        assert_eq!((torque.samples, report.rows), (3, 4));
        assert_eq!(places(&report, IssueKind::Unreadable), [(3, 3, 1)]);
    }
}
