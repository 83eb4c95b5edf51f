//! Two recordings side by side.

use super::*;

/// A bag with a bit torque (N m) at 10 Hz over 20 s, forces along the tool, and a shock from 2 to 9 s if asked for.
fn steady(path: &Path, torque: f64, shock: bool) {
    let known = [&topics::BIT_STATE, &topics::CONTACT_FORCES, &topics::ALARM_EVENTS];
    let mut bag = Bag::new(path, &known.map(|topic| ("/", topic)));
    for index in 0..=200_u32 {
        let time = 0.1 * f64::from(index);
        let bit = BitState {
            header: header(time),
            torque,
            ..BitState::default()
        };
        bag.put("/twin/bit_state", time, &to_cdr(&bit).unwrap());
        let row = |value: f64| vec![0.0, value, 0.0];
        let contacts = ContactForces {
            header: header(time),
            measured_depth: vec![0.0, 1.5, 3.0],
            inclination: vec![0.0; 3],
            state: vec![ContactForces::FREE; 3],
            pipe_guide_normal_peak: row(10.0 * torque),
            pipe_guide_normal_rms: row(5.0 * torque),
            guide_wall_normal_peak: row(0.0),
            guide_wall_normal_rms: row(0.0),
            ..ContactForces::default()
        };
        bag.put("/twin/contact_forces", time, &to_cdr(&contacts).unwrap());
        for (at, change) in [(20, AlarmEvent::ACTIVATED), (90, AlarmEvent::RETURNED)] {
            if shock && index == at {
                bag.put("/twin/alarm_events", time, &event(time, change, "strong"));
            }
        }
    }
    bag.recorder.finish().unwrap();
}

/// Two bags next to each other: exit code, what is said, JSON and page.
fn against(a: &Path, b: &Path, tolerance: Option<&str>) -> (Option<i32>, String, serde_json::Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let mut arguments = vec![
        "report",
        text(a),
        "--against",
        text(b),
        "--json",
        "--out",
        text(folder.path()),
    ];
    arguments.extend(tolerance.iter().flat_map(|percent| ["--tolerance", *percent]));
    let output = flexdrill(&arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    check_page(&page);
    let json = serde_json::from_slice(&output.stdout).unwrap();
    (output.status.code(), said, json, page)
}

#[test]
fn two_bags_side_by_side_differ_by_what_was_put_into_them() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b, c] = ["a", "b", "c"].map(|name| folder.path().join(name).join("run.mcap"));
    steady(&a, 100.0, true);
    steady(&b, 103.0, false);
    // 3 of 103 are 2.913 %; the forces follow the torque; the shock is in A only.
    let (code, said, json, page) = against(&a, &b, Some("2"));
    assert_eq!(code, Some(1), "{said}");
    for difference in [
        "the alarm \"shock\"",
        "torque of the rock on the bit (2.913 %)",
        "pipe on guide, RMS (2.913 %)",
    ] {
        assert!(said.contains(difference), "{said}");
    }
    assert_eq!(json["same"], false);
    assert_eq!(json["beyond_tolerance"].as_array().unwrap().len(), 3, "{json}");
    let torque = json["quantities"]
        .as_array()
        .unwrap()
        .iter()
        .find(|quantity| quantity["unit"] == "N m");
    // Rounding of a sum of 200 products.
    assert!((torque.unwrap()["a"]["mean"].as_f64().unwrap() - 100.0).abs() < 1e-9);
    assert!((torque.unwrap()["relative_difference"].as_f64().unwrap() - 3.0 / 103.0).abs() < 1e-9);
    let force = &json["along_the_tool"][0];
    assert_eq!(force["largest_difference"]["measured_depth"], 1.5);
    assert_eq!(force["largest_difference"]["b"], 1030.0, "in newtons");
    assert_eq!(json["alarms"][0]["a"]["times"], 1);
    assert!((json["alarms"][0]["a"]["duration_s"].as_f64().unwrap() - 7.0).abs() < 1e-9);
    assert_eq!(json["alarms"][0]["b"]["times"], 0);
    for shown in [
        "<figure id=\"torque\">",
        "<figure id=\"envelopes\">",
        "Alarms on one time line",
        "<b>3</b>beyond the tolerance of 2 %",
    ] {
        assert!(page.contains(shown), "{shown}");
    }
    // A wider tolerance leaves the alarm, and none asks for nothing.
    let (code, said, json, _) = against(&a, &b, Some("3"));
    assert_eq!(
        (code, json["beyond_tolerance"].as_array().unwrap().len()),
        (Some(1), 1),
        "{said}"
    );
    let (code, said, json, _) = against(&a, &b, None);
    assert_eq!((code, json["tolerance"].is_null()), (Some(0), true), "{said}");
    // Of the same bag nothing differs, and of one without the shock only the torque.
    let (code, said, json, page) = against(&b, &b, Some("0"));
    assert_eq!((code, json["same"].as_bool()), (Some(0), Some(true)), "{said}");
    assert!(page.contains("<b>the same</b>"));
    steady(&c, 103.0 * (1.0 + 1e-9), false);
    let (code, said, _, _) = against(&b, &c, Some("0"));
    assert_eq!(code, Some(1), "{said}");
    let (code, said, _, _) = against(&b, &c, Some("0.001"));
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn a_replay_agrees_with_itself_and_a_wrong_tolerance_is_wrong_use() {
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let (code, said, json, page) = against(&run, &run, Some("0"));
    assert_eq!(code, Some(0), "{said}");
    assert!(json["quantities"].as_array().unwrap().len() > 8, "{json}");
    assert!(page.contains("Both runs have the same configuration."));
    for arguments in [
        vec![
            "report",
            text(&run),
            "--against",
            text(&run),
            "--json",
            "--tolerance",
            "-1",
        ],
        vec!["report", text(&run), "--json"],
        vec!["report", text(&run), "--out", "x", "--tolerance", "1"],
    ] {
        assert_eq!(flexdrill(&arguments).status.code(), Some(2), "{arguments:?}");
    }
}
