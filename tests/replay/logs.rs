//! Two minutes of a drilling log through the model: the generated log always, the real one where it is there.

use std::path::{Path, PathBuf};
use std::process::Command;

use flexdrill::messages::{BitState, ContactForces, JointDeflections};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// What the program says when it succeeds.
fn run(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let said = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(output.status.success(), "{said}");
    said
}

/// Replays 120 s of steady drilling and checks what came out against what must hold on any log.
fn replay(log: &Path, from: &str) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.mcap");
    let incidents = folder.path().join("incidents.json");
    let mapping = root().join("config/field_logs/rig_1hz.yaml");
    let said = run(Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(log)
        .arg("--mapping")
        .arg(mapping)
        .arg("--config")
        .arg(root().join("config/coarse.yaml"))
        .args(["--from", from, "--duration", "120", "--out"])
        .arg(&out)
        .arg("--incidents")
        .arg(&incidents));
    println!("{said}");
    let found = check_incidents(&said, &incidents);
    // Levels that stand in normal drilling are worse than none.
    assert!(found.len() <= 2, "{said}");
    assert!(found.iter().all(|row| row["severity"] != "critical"), "{said}");

    let (mut joints, mut contacts, mut bits) = (0_u32, 0_u32, Vec::new());
    for message in flexdrill::bag::open(&out).unwrap() {
        let message = message.unwrap();
        if message.topic.is("twin/joint_deflections") {
            let m: JointDeflections = message.decode().unwrap();
            assert_eq!(m.bend_angle.len(), 32);
            // The stop gives way by its stiffness only: 1 kN m, far above what any pipe here carries, is 0.3 degrees.
            assert!(m.max_bend_angle < 6.3_f64.to_radians(), "bend {}", m.max_bend_angle);
            joints += 1;
        } else if message.topic.is("twin/contact_forces") {
            let m: ContactForces = message.decode().unwrap();
            assert!(
                m.pipe_guide_normal
                    .iter()
                    .chain(&m.guide_wall_normal)
                    .all(|n| n.is_finite() && *n >= 0.0)
            );
            contacts += 1;
        } else if message.topic.is("twin/bit_state") {
            bits.push(message.decode::<BitState>().unwrap());
        }
    }
    // 50 Hz of 120 s and the start.
    assert_eq!((joints, contacts, bits.len()), (6001, 6001, 6001));
    // The bit turns as the log's top drive does, on average over the second half, within the ripple.
    let half = &bits[3000..];
    let mean = half.iter().map(|bit| bit.rotary_speed).sum::<f64>() / half.len() as f64;
    assert!(
        mean > 10.0 * std::f64::consts::TAU / 60.0,
        "the bit hardly turns: {mean} rad/s"
    );
    assert!(
        bits.iter()
            .all(|bit| bit.weight_on_bit >= 0.0 && bit.weight_on_bit <= 60e3)
    );
    assert!(
        bits.iter().any(|bit| bit.weight_on_bit > 1e3),
        "no weight on bit in the log"
    );
}

/// Every incident has its time, place, kind, severity and duration, on the screen and in the file. All of them.
fn check_incidents(said: &str, path: &Path) -> Vec<serde_json::Value> {
    let text = std::fs::read_to_string(path).unwrap();
    let rows: Vec<serde_json::Value> = serde_json::from_str(&text).unwrap();
    assert!(
        rows.is_empty() || said.contains(&format!("incidents: {}", rows.len())),
        "{said}"
    );
    for row in &rows {
        let number = |key: &str| row.pointer(key).and_then(serde_json::Value::as_f64).unwrap();
        assert!((0.0..=120.0).contains(&number("/start")), "{row}");
        assert!(
            number("/duration") >= 0.0 && number("/start") + number("/duration") <= 120.0 + 1e-6,
            "{row}"
        );
        assert!((0.0..=5.1).contains(&number("/place/measured_depth")), "{row}");
        assert!((0.0..=90.1).contains(&number("/inclination_deg")), "{row}");
        assert!(
            ["watch", "warning", "critical"].contains(&row["severity"].as_str().unwrap()),
            "{row}"
        );
        assert!(row["kind"].is_string() && row["place"]["station"].is_u64(), "{row}");
    }
    rows
}

/// A pipe that rubs hard in its guide at 120 r/min: the table tells of backward whirl, and the alarm calls.
#[test]
fn a_tool_that_is_being_destroyed() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let rows: String = (0..30).map(|second| format!("{second},120,10\n")).collect();
    let log = file("log.csv", &format!("time_s,rpm,wob_kn\n{rows}"));
    let mapping = file(
        "mapping.yaml",
        "title: constant\ncolumns:\n  time: {column: time_s, format: seconds}\n  rotary_speed: {column: rpm, unit: r/min}\n  \
         weight_on_bit: {direct: {column: wob_kn, unit: kN}}\n",
    );
    let coarse = std::fs::read_to_string(root().join("config/coarse.yaml")).unwrap();
    let config = file(
        "config.yaml",
        &format!("{coarse}\ncontact: {{inner: {{friction_tangential: 0.7}}}}\n"),
    );
    let incidents = folder.path().join("incidents.json");
    let said = run(Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("replay")
        .arg(&log)
        .arg("--mapping")
        .arg(&mapping)
        .arg("--config")
        .arg(&config)
        .args(["--duration", "15", "--out"])
        .arg(folder.path().join("out.mcap"))
        .arg("--incidents")
        .arg(&incidents));
    let found = check_incidents(&said, &incidents);
    assert!(
        found.iter().any(|row| row["severity"] == "critical"
            && ["backward_whirl", "rolling_whirl"].contains(&row["kind"].as_str().unwrap())),
        "{said}"
    );
    assert!(said.contains("HIGH     backward whirl"), "{said}");
    assert!(said.contains("Lower the speed below 80 r/min"), "{said}");
}

#[test]
fn the_generated_log() {
    replay(&root().join("config/field_logs/demo.csv"), "45");
}

#[test]
fn the_real_log() {
    let Some(log) = crate::common::real_log() else { return };
    // The steady stretch at 49 r/min: data rows 6343 on, which an editor shows two lines further down.
    replay(&log, "row:6345");
}
