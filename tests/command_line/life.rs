//! `flexdrill life`: from recordings to a table, and from the table to words and to a report.

use std::path::{Path, PathBuf};
use std::process::Command;

use flexdrill::bag::{Recorder, Topic};
use flexdrill_config::Config;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::{Ageing, SessionInfo, to_cdr, topics};

const SECOND: i64 = 1_000_000_000;
/// 2026-08-01 00:00:00 UTC.
const BEGIN: i64 = 1_785_542_400 * SECOND;

/// A tool of three joints with these serial numbers from the bit up.
fn tool(serials: &str, life: &str) -> Config {
    let text = format!(
        "well:\n  sections:\n    - arc: {{radius: 3.2, build_angle_deg: 11}}\n  hole_diameter: 0.118\ntool:\n  links: 4\n  \
         pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}\n  guide: {{outer_diameter: 0.102, inner_diameter: \
         0.080}}\n  joint: {{limit_deg: 6.0, serial_numbers: [{serials}], life: {{{life}}}}}\n  bit: {{diameter: \
         0.118}}\n"
    );
    Config::from_text("tool.yaml", &text).unwrap()
}

/// A recording of `hours` whose links have these sums of counted cycles per hour, from the top down.
fn recorded(folder: &Path, name: &str, config: &Config, start: i64, hours: i64, per_hour: [f64; 3]) -> PathBuf {
    let path = folder.join(name);
    let topic = |known: &topics::TopicInfo| Topic::new(format!("/rig_7/{}", known.name), &known.kind, known.qos);
    let mut recorder = Recorder::create(&path, &[topic(&topics::SESSION), topic(&topics::AGEING)]).unwrap();
    let session = SessionInfo {
        config_hash: config.hash(),
        start: Time::from_nanoseconds(start),
        configuration: config.to_yaml().unwrap(),
        ..SessionInfo::default()
    };
    recorder.record(0, start, &to_cdr(&session).unwrap()).unwrap();
    for hour in 0..=hours {
        let settings = config.simulation().ageing;
        let mut message = Ageing {
            duration: 3600.0 * hour as f64,
            woehler_slope: settings.slope,
            rated_moment: settings.rated_moment,
            stop_damage_rate: vec![0.0; 3],
            bending_damage_rate: if hour > 0 { per_hour.to_vec() } else { vec![0.0; 3] },
            ..Ageing::default()
        };
        let stamp = start + hour * 3600 * SECOND;
        message.header.stamp = Time::from_nanoseconds(stamp);
        recorder.record(1, stamp, &to_cdr(&message).unwrap()).unwrap();
    }
    recorder.finish().unwrap();
    path
}

/// Exit code, standard output and standard error of `flexdrill life`.
fn life(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .args(arguments)
        .output()
        .unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (output.status.code(), out, err)
}

/// Median damage of a unit of the count: F1 in free corrosion, log10 N = 11.222 + 2 x 0.2 - 3 log10 S.
fn unit() -> f64 {
    let modulus = std::f64::consts::PI * (0.063f64.powi(4) - 0.032f64.powi(4)) / (32.0 * 0.063);
    (100.0 / modulus / 1e6).powi(3) / 10f64.powf(11.622)
}

#[test]
fn lives_are_carried_from_run_to_run_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("joints.csv");
    let table = table.to_str().unwrap();
    let first = tool("J-1, J-2, J-3", "class: F1");
    // An hour makes 0.1 of a life of the uppermost joint, J-3, and 0.01 of J-1.
    let per_hour = [0.1, 0.0, 0.01].map(|damage| damage / unit());
    let one = recorded(folder.path(), "one", &first, BEGIN, 4, per_hour);
    // The next day J-1 and J-3 have changed places.
    let second = tool("J-3, J-2, J-1", "class: F1");
    let two = recorded(folder.path(), "two", &second, BEGIN + 86_400 * SECOND, 3, per_hour);
    let [one, two] = [&one, &two].map(|path| path.to_str().unwrap());
    let (code, out, err) = life(&["life", "add", table, one]);
    assert_eq!(code, Some(0), "{err}");
    assert!(
        out.contains("added the run that began at 2026-08-01 00:00:00 UTC: 4.00 h, 3 joints"),
        "{out}"
    );
    let before = std::fs::read_to_string(table).unwrap();
    let (code, out, _) = life(&["life", "add", table, one]);
    assert!(code == Some(0) && out.contains("the table has the run"), "{out}");
    assert_eq!(std::fs::read_to_string(table).unwrap(), before);
    let (code, out, err) = life(&["life", "add", table, two]);
    assert!(code == Some(0) && out.contains("3 joints in 2 runs"), "{out}{err}");
    // J-3 has 4 x 0.1 + 3 x 0.01 = 0.43, J-1 4 x 0.01 + 3 x 0.1 = 0.34. The band is a factor of 3.44.
    let (code, out, err) = life(&["life", "show", table]);
    assert_eq!(code, Some(0), "{err}");
    for words in [
        "class DNVGL-RP-C203 F1 in free corrosion",
        "1. J-3: link below 0.43 (0.12 to 1.5); stop 0 (0 to 0); 7.0 h in 2 runs, last at place 1 from the bit. A crack is \
         possible",
        "2. J-1: link below 0.34 (0.099 to 1.2)",
        "1 joint more below a damage of 0.33 at 95 %",
        "It has neither the choice of the class, nor corrosion pits",
    ] {
        assert!(out.contains(words), "{words}: {out}");
    }
    assert!(
        life(&["life", "show", table, "--all"])
            .1
            .contains("3. J-2: link below 0 (0 to 0)")
    );
    // The report has the same ranking.
    let report = folder.path().join("report");
    let (code, _, err) = life(&["report", two, "--life", table, "--out", report.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{err}");
    let page = std::fs::read_to_string(report.join("report.html")).unwrap();
    for words in [
        "Joints to inspect",
        "0.43 (0.12 to 1.5)",
        "This recording alone",
        "0.30 (0.087 to 1.0)",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn what_does_not_belong_leaves_the_table_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("joints.csv");
    let table = table.to_str().unwrap();
    let bag = |name: &str, config: &Config, start: i64| {
        let path = recorded(folder.path(), name, config, start, 1, [1.0; 3]);
        path.to_str().unwrap().to_owned()
    };
    let first = bag("first", &tool("J-1, J-2, J-3", "class: F1"), BEGIN);
    assert_eq!(life(&["life", "add", table, &first]).0, Some(0));
    let before = std::fs::read_to_string(table).unwrap();
    let later = BEGIN + 86_400 * SECOND;
    let unknown = bag("unknown", &tool("J-1, J-22, J-3", "class: F1"), later);
    let class = bag("class", &tool("J-1, J-2, J-3", "class: W3"), later);
    for (arguments, words) in [
        (vec![&*unknown], "does not have J-22 (place 2 from the bit)"),
        (
            vec![&*class],
            "class is DNVGL-RP-C203 F1 there, and DNVGL-RP-C203 W3 in the run",
        ),
        (
            vec![&*unknown, "--new", "J-22", "--new", "J-23"],
            "--new J-23: none of these runs has a joint",
        ),
        // The first is good, and is not added either.
        (
            vec![&*unknown, "--new", "J-22", &*class],
            "class is DNVGL-RP-C203 F1 there",
        ),
        (vec![&*first, "--namespace", "/rig_8"], "/rig_8/twin/session"),
    ] {
        let (code, _, err) = life(&[&["life", "add", table][..], &arguments[..]].concat());
        assert!(matches!(code, Some(1 | 2)) && err.contains(words), "{words}: {err}");
        assert_eq!(std::fs::read_to_string(table).unwrap(), before, "{words}");
    }
    let (code, out, err) = life(&["life", "add", table, &unknown, "--new", "J-22"]);
    assert!(code == Some(0) && out.contains("4 joints in 2 runs"), "{out}{err}");
    let missing = folder.path().join("missing.csv");
    let (code, _, err) = life(&["life", "show", missing.to_str().unwrap()]);
    assert!(
        code == Some(1) && err.contains("`flexdrill life add` makes it"),
        "{err}"
    );
}
