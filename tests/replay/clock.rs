//! A replayed field log keeps its clock, its rows and its inputs; names of rig and well head the report.

use std::path::Path;
use std::process::Command;

use flexdrill::bag;
use flexdrill::messages::{RigInputs, SessionInfo};

fn flexdrill(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Replays six rows of a log whose time column has this format, and returns what was printed and the page.
fn replayed(folder: &Path, format: &str, time: impl Fn(u32) -> String) -> (String, String) {
    let rows = (0..6).map(|row| format!("{},40,5,{}\n", time(row), 2 + row));
    let log: String = std::iter::once("when,rpm,wob,rop\n".to_owned()).chain(rows).collect();
    let [csv, mapping, config] = ["log.csv", "mapping.yaml", "tool.yml"].map(|name| folder.join(name));
    std::fs::write(&csv, log).unwrap();
    std::fs::write(
        &mapping,
        format!(
            "columns:
  time: {{column: when, format: {format}}}
  rotary_speed: {{column: rpm, unit: r/min}}
  weight_on_bit: {{direct: {{column: wob, unit: kN}}}}
  rate_of_penetration: {{column: rop, unit: m/h}}
"
        ),
    )
    .unwrap();
    let small = std::fs::read_to_string(crate::common::small_config()).unwrap();
    let named = small.replacen("run:\n", "run:\n  rig: \"Rig <7>\"\n  well: Example 3 H\n", 1);
    assert_ne!(named, small);
    std::fs::write(&config, named).unwrap();
    let (run, out) = (folder.join("run"), folder.join("page"));
    let said = flexdrill(&[
        "replay",
        text(&csv),
        "--mapping",
        text(&mapping),
        "--config",
        text(&config),
        "--out",
        text(&run),
    ]);
    flexdrill(&["report", text(&run), "--out", text(&out)]);
    (said, std::fs::read_to_string(out.join("report.html")).unwrap())
}

fn sources(run: &Path) -> Vec<(i64, RigInputs)> {
    let messages = bag::open(run).unwrap().map(Result::unwrap);
    messages
        .filter(|message| message.topic.is("rig/inputs"))
        .map(|message| (message.log_time, message.decode().unwrap()))
        .collect()
}

#[test]
fn a_log_with_dates_keeps_them_and_its_rows() {
    let folder = tempfile::tempdir().unwrap();
    let (said, page) = replayed(folder.path(), "iso8601", |row| {
        format!("2024-05-01T12:30:{:02}Z", 5 + row)
    });
    assert!(
        said.contains("row 2 to row 7 of log.csv; begin: 2024-05-01 12:30:05 UTC"),
        "{said}"
    );
    for words in [
        "<dt>From</dt><dd>2024-05-01 12:30:05 UTC</dd>",
        "<dt>Log</dt><dd>row 2 to row 7 of log.csv</dd>",
        "<dt>Rig</dt><dd>Rig &lt;7&gt;</dd><dt>Well</dt><dd>Example 3 H</dd>",
    ] {
        assert!(page.contains(words), "{words}");
    }
    // The operator is not given, and is left out.
    assert!(!page.contains("<dt>Operator</dt>"));
    // The log gave the rate, so that nothing about it is assumed.
    assert!(page.contains("rate of penetration, received") && page.contains("rate of penetration, accepted"));
    assert!(!page.contains("penetration, assumed"));
    let run = folder.path().join("run");
    let start = bag::open(&run)
        .unwrap()
        .map(Result::unwrap)
        .find(|message| message.topic.is("twin/session"))
        .map(|message| message.decode::<SessionInfo>().unwrap().start.to_nanoseconds());
    // date -u -d 2024-05-01T12:30:05 +%s
    assert_eq!(start, Some(1_714_566_605_000_000_000));
    // A replay of the replay has the same inputs with the same rows.
    let again = folder.path().join("again");
    flexdrill(&["replay", text(&run), "--out", text(&again)]);
    let found = sources(&run);
    assert_eq!(found.len(), 6);
    assert_eq!(found[3].1.source, "row 5 of log.csv");
    assert_eq!(
        (found[3].1.rotary_speed_rpm, found[3].1.rate_of_penetration_m_per_h),
        (40.0, 5.0)
    );
    // As text, because a value that is not given is NaN.
    assert_eq!(format!("{:?}", sources(&again)), format!("{found:?}"));
}

#[test]
fn a_log_without_dates_shows_its_own_time_column() {
    let folder = tempfile::tempdir().unwrap();
    let (said, page) = replayed(folder.path(), "time_of_day", |row| match row {
        0..3 => format!("23:59:{:02}.5", 57 + row),
        _ => format!("00:00:{:02}.5", row - 3),
    });
    let rows = "row 2 (when 23:59:57.5) to row 7 (when 00:00:02.5) of log.csv";
    assert!(said.contains(rows), "{said}");
    assert!(page.contains(rows));
    assert!(page.contains("model time 0 s"));
}
