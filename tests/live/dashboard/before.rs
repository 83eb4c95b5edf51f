//! What the page knows of before: an hour, the motion of a joint, a recording.

use super::*;

#[test]
fn a_twin_that_went_comes_back_by_itself_and_the_hour_has_a_gap() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let server = Server::start(&network, &[]);
    let history = || server.get("/api/history").unwrap()["history"].clone();
    if server.get("/api/session").is_none() {
        return;
    }
    server.body_with("/api/session", |session| !session["tool"].is_null());
    std::thread::sleep(Duration::from_secs(3));
    let before = history();
    let frames = before["head"]["count"].as_u64().unwrap();
    assert!(frames >= 3, "{}", before["head"]);
    // Joints, stations, watched places of the small tool.
    let column = |name: &str| {
        let columns = before["head"]["columns"].as_array().unwrap();
        let found = columns
            .iter()
            .find(|column| column["name"] == name)
            .unwrap_or_else(|| panic!("{name}"));
        (
            found["offset"].as_u64().unwrap() as usize,
            found["length"].as_u64().unwrap(),
        )
    };
    assert_eq!(
        [column("joint_bend_angle").1, column("pipe_y").1, column("whirl_kind").1],
        [6, 15, 12]
    );
    let last = &before["frames"][before["frames"].as_array().unwrap().len() - 2];
    assert_eq!(last[column("state").0], 1.0);
    // The pipe leans off the bore's axis, by no more than both clearances: 8.5 mm in the guide, 8 mm of the guide.
    let away = last[column("pipe_z").0 + 7].as_f64().unwrap().abs();
    assert!((1e-4..0.0165).contains(&away), "{away} m");

    let Some(seen) = network.viewer(&["decode", "ws://127.0.0.1:8080/live", "2"]) else {
        return;
    };
    let status = seen["found"]["/twin/status"]["count"].as_u64().unwrap();
    assert!((7..=11).contains(&status), "5 Hz for 2 s: {status}");
    let pulse = || server.body("/api/pulse");
    let age = |pulse: &Value| pulse["newest"]["twin/status"]["age_s"].as_f64().unwrap();
    let instance = pulse()["instance"].clone();
    assert_eq!(server.body("/api/session")["instance"], instance);
    assert_eq!(instance.as_str().map(str::len), Some(16));
    // At 5 Hz a status is older than a second only where the machine stands still.
    server.body_with("/api/pulse", |pulse| age(pulse) < 1.0);
    twin.signal("KILL");
    twin.end();
    let gone = pulse();
    let silent = network.viewer(&["decode", "ws://127.0.0.1:8080/live", "2"]).unwrap();
    assert!(silent["found"].get("/twin/status").is_none(), "{}", silent["found"]);
    let later = pulse();
    assert_eq!(
        gone["newest"]["twin/status"]["time_ns"],
        later["newest"]["twin/status"]["time_ns"]
    );
    // The viewer listened for two seconds.
    assert!(age(&later) >= age(&gone) + 2.0, "{gone} {later}");
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let back = Instant::now();
    loop {
        let seen = network.viewer(&["decode", "ws://127.0.0.1:8080/live", "1"]).unwrap();
        if seen["found"].get("/twin/status").is_some() {
            break;
        }
        assert!(back.elapsed() < Duration::from_secs(10), "it has not come back");
    }
    std::thread::sleep(Duration::from_secs(2));
    let after = history();
    let times: Vec<f64> = after["frames"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| frame[0].as_f64().unwrap())
        .collect();
    let gaps = times.windows(2).filter(|pair| pair[1] - pair[0] > 1.5).count();
    assert_eq!(gaps, 1, "{times:?}");
    assert!(times.len() as u64 > frames);
    server.end();
}

/// A reader that a new twin finds at once, and that finds the twin some seconds later, is not one that does not take.
#[test]
fn a_twin_that_starts_again_has_no_word_against_the_dashboard() {
    let Some(network) = Network::new() else { return };
    let server = Server::start(&network, &[]);
    for _ in 0..3 {
        let mut twin = network.twin(&["--duration", "7"]);
        assert_eq!(twin.end(), Some(0));
        let said = twin.said();
        assert!(!said.contains("does not take them"), "{said}");
    }
    // All of them were heard to the end: the last one's alarms are those of a run.
    if let Some(journal) = server.get("/api/journal") {
        assert!(!journal["body"]["events"].as_array().unwrap().is_empty(), "{journal}");
    }
    server.end();
}

/// Longer ago than the page keeps motion, the server has three seconds of every ten.
#[test]
fn a_joints_motion_of_before_is_there_and_where_it_is_not_is_said() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let server = Server::start(&network, &[]);
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos();
    let path = |joint: usize, time: u128| format!("/api/orbit/{joint}/{time}");
    let Some(before) = server.get(&path(2, now() - 3_600_000_000_000)) else {
        return;
    };
    assert_eq!(before["code"], 404);
    assert!(
        text(&before["body"]).contains("no motion of that joint is kept"),
        "{before}"
    );
    let deadline = Instant::now() + Duration::from_secs(40);
    let motion = loop {
        let answer = server.get(&path(2, now())).unwrap();
        // The first windows may be parts of one.
        let enough = |times: &Value| times.as_array().is_some_and(|times| times.len() >= 10);
        if answer["code"] == 200 && enough(&answer["body"]["times_s"]) {
            break answer["body"].clone();
        }
        assert!(Instant::now() < deadline, "{answer}");
        std::thread::sleep(Duration::from_millis(300));
    };
    let numbers = |name: &str| -> Vec<f64> { serde_json::from_value(motion[name].clone()).unwrap() };
    let (times, y, z) = (numbers("times_s"), numbers("y_m"), numbers("z_m"));
    // 25 a second of model time; a busy machine skips some.
    assert!(
        (10..=76).contains(&times.len()) && *times.last().unwrap() < 3.0,
        "{times:?}"
    );
    // The pipe leans off the bore's axis, by no more than both clearances.
    let away = y.iter().zip(&z).map(|(y, z)| y.hypot(*z)).fold(0.0, f64::max);
    assert!(y.len() == times.len() && (1e-5..0.0165).contains(&away), "{away} m");
    assert_eq!(server.get(&path(6, now())).unwrap()["code"], 404, "six joints");
    assert_eq!(server.get("/api/orbit/2/yesterday").unwrap()["code"], 400);
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
    server.end();
}

#[test]
fn a_recording_has_its_hour_its_incidents_and_no_steering() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("run.mcap");
    // Without a rig both inputs call after their 2 s.
    let mut twin = network.twin(&[
        "--record",
        bag.to_str().unwrap(),
        "--duration",
        "6",
        "--namespace",
        "/rig_7",
        "--ros-args",
        "-p",
        "alarms.first_sample_within:=0.0",
    ]);
    assert_eq!(twin.end(), Some(0));
    let server = Server::start(&network, &["--bag", bag.to_str().unwrap()]);
    if server.get("/api/session").is_none() {
        return;
    }
    let session = server.body_with("/api/session", |session| session["bag"]["ready"] == true);
    assert_eq!(
        (&session["mode"], &session["namespace"]),
        (&json!("bag"), &json!("/rig_7"))
    );
    let incidents = session["bag"]["incidents"].as_array().unwrap();
    assert!(
        incidents
            .iter()
            .any(|incident| incident["alarm"] == "rotary_speed_input"),
        "{incidents:?}"
    );
    let history = server.get("/api/history").unwrap()["history"]["head"].clone();
    assert_eq!(history["complete"], true);
    assert!((6..=8).contains(&history["count"].as_u64().unwrap()), "{history}");
    assert!(!server.body("/api/journal")["events"].as_array().unwrap().is_empty());
    assert_eq!(server.steer(20.0).0, 403);
    let Some(seen) = network.viewer(&["play", "ws://127.0.0.1:8080/live"]) else {
        return;
    };
    assert_eq!(seen["ended"]["status"], 3);
    server.end();
}
