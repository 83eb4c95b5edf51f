//! The dashboard's server, as a browser and a foreign viewer see it: page, session, history, steering, a recording.

use std::io::Write as _;
use std::os::unix::fs::PermissionsExt as _;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::common::{Network, Program};
use serde_json::{Value, json};

const TOKEN: &str = "0123456789abcdef";
const ROOT: &str = "http://127.0.0.1:8080";
const STATUS: (&str, &str) = ("/rig_7/twin/status", "flexdrill/msg/TwinStatus");

/// A dashboard in the network, and the file with its token.
struct Server<'a> {
    network: &'a Network,
    program: Program,
    _token: tempfile::NamedTempFile,
}

impl<'a> Server<'a> {
    fn start(network: &'a Network, arguments: &[&str]) -> Self {
        let mut token = tempfile::NamedTempFile::new().unwrap();
        writeln!(token, "{TOKEN}").unwrap();
        let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.arg("dashboard").args(arguments);
        if arguments.contains(&"--allow-control") {
            command.arg("--token-file").arg(token.path());
        }
        let mut program = Program::start(command);
        program.wait_for("dashboard at");
        Self {
            network,
            program,
            _token: token,
        }
    }

    fn get(&self, path: &str) -> Option<Value> {
        self.network.http("GET", &format!("{ROOT}{path}"), &[], "")
    }

    fn body(&self, path: &str) -> Value {
        self.get(path).unwrap()["body"].clone()
    }

    /// Waits until what a path says fulfils a condition.
    fn body_with(&self, path: &str, condition: impl Fn(&Value) -> bool) -> Value {
        self.body_within(30, path, condition)
    }

    /// The same within some seconds.
    fn body_within(&self, seconds: u64, path: &str, condition: impl Fn(&Value) -> bool) -> Value {
        let deadline = Instant::now() + Duration::from_secs(seconds);
        loop {
            let body = self.body(path);
            if condition(&body) {
                return body;
            }
            assert!(Instant::now() < deadline, "{path} is not as it should be: {body}");
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Asks with a token; code and body.
    fn post(&self, what: &str, token: &str, body: Value) -> (u64, Value) {
        let bearer = format!("Authorization=Bearer {token}");
        let url = format!("{ROOT}/api/control/{what}");
        let answer = self.network.http("POST", &url, &[&bearer], &body.to_string()).unwrap();
        (answer["code"].as_u64().unwrap(), answer["body"].clone())
    }

    fn steer(&self, rpm: f64) -> (u64, Value) {
        let wanted = json!({"operator": "Kim", "rotary_speed_rpm": rpm, "weight_on_bit_kn": 10.0});
        self.post("steer", TOKEN, wanted)
    }

    /// Steers until the twin turns as fast.
    fn steer_to(&self, rpm: f64) {
        let deadline = Instant::now() + Duration::from_secs(20);
        loop {
            let (code, said) = self.steer(rpm);
            assert_eq!(code, 200, "{said}");
            let control = self.body("/api/control");
            assert_eq!(
                (&control["driving"], &control["by"]),
                (&json!(true), &json!("Kim")),
                "{control}"
            );
            if near(&control["applied_rpm"], rpm) && near(&control["applied_wob_kn"], 10.0) {
                return;
            }
            assert!(Instant::now() < deadline, "{control}");
            std::thread::sleep(Duration::from_millis(200));
        }
    }

    fn end(mut self) {
        self.program.signal("INT");
        assert_eq!(self.program.end(), Some(0), "{}", self.program.said());
    }
}

/// The conversion from rad/s and back rounds.
fn near(value: &Value, wanted: f64) -> bool {
    value.as_f64().is_some_and(|value| (value - wanted).abs() < 1e-6)
}

fn text(value: &Value) -> &str {
    value["message"].as_str().unwrap()
}

#[test]
fn steering_needs_the_token_and_that_nobody_else_drives() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&["--namespace", "/rig_7"]);
    twin.wait_for("model time runs");
    peer.subscribe(STATUS.0, STATUS.1, "reliable");
    let mut server = Server::start(&network, &["--namespace", "/rig_7", "--allow-control"]);
    let session = server.body_with("/api/session", |session| !session["limits"].is_null());
    assert_eq!((&session["control"], &session["mode"]), (&json!(true), &json!("live")));
    assert_eq!(
        session["limits"]["rotary_speed_rpm"],
        json!({"min": 0.0, "max": 120.0, "slew_per_s": 20.0})
    );
    assert_eq!(session["tool"]["stations"].as_array().unwrap().len(), 15);
    server.body_with("/api/control", |control| control["applied_rpm"] == 0.0);

    // Who has no token moves nothing.
    let wanted = json!({"operator": "Kim", "rotary_speed_rpm": 30.0, "weight_on_bit_kn": 10.0});
    for token in ["", "0123456789abcdeF", "0123456789abcdef0"] {
        assert_eq!(server.post("steer", token, wanted.clone()).0, 401, "{token}");
    }
    let naked = network
        .http("POST", &format!("{ROOT}/api/control/steer"), &[], &wanted.to_string())
        .unwrap();
    assert_eq!(naked["code"], 401);
    server
        .program
        .wait_for("sent a wrong token and was refused; 1 from this address so far");
    assert_eq!(server.body("/api/control")["driving"], false);
    // A page of a server that has ended moves nothing either; its own page does.
    let instance = server.body("/api/pulse")["instance"].as_str().unwrap().to_owned();
    for (bound, code) in [("0000000000000000", 409), (instance.as_str(), 200)] {
        let headers = [
            format!("Authorization=Bearer {TOKEN}"),
            format!("X-Flexdrill-Instance={bound}"),
        ];
        let headers: Vec<&str> = headers.iter().map(String::as_str).collect();
        let url = format!("{ROOT}/api/control/release");
        let answer = network.http("POST", &url, &headers, &json!({"operator": "Kim"}).to_string());
        assert_eq!(answer.unwrap()["code"], code, "{bound}");
    }
    let (code, said) = server.steer(121.0);
    assert!(code == 400 && text(&said).contains("between 0 and 120 r/min"), "{said}");
    for wrong in [
        json!({}),
        json!({"operator": "", "rotary_speed_rpm": 1.0, "weight_on_bit_kn": 1.0}),
        json!([1]),
    ] {
        assert_eq!(server.post("steer", TOKEN, wrong).0, 400);
    }

    // With it, the twin follows, and all clients see who drives.
    server.steer_to(30.0);
    let status = peer.status_with(STATUS.0, |status| status["input_source"][0] == "dashboard: Kim");
    assert!(
        status["input_driver"][0]
            .as_str()
            .unwrap()
            .contains("/rig_7/flexdrill_dashboard_"),
        "{status}"
    );
    assert_eq!(status["input_several_drivers"], json!([false, false]));

    // The page has gone: after 3 s nothing is sent any more, and the node's own rules hold.
    std::thread::sleep(Duration::from_millis(3500));
    let control = server.body("/api/control");
    assert_eq!(
        (&control["driving"], &control["ended"]),
        (&json!(false), &json!("the page of Kim has not responded for 3 s"))
    );
    peer.status_with(STATUS.0, |status| {
        status["input_state"] == json!([3, 3]) && status["input_safe"] == json!([true, true])
    });

    // A rig that sends ends it, and keeps it from beginning.
    server.steer_to(20.0);
    peer.send("/rig_7/rig/rotary_speed_rpm", json!(25.0));
    let ended = server.body_with("/api/control", |control| control["driving"] == false);
    assert!(ended["ended"].as_str().unwrap().ends_with("began to drive"), "{ended}");
    let (code, said) = server.steer(20.0);
    assert!(code == 409 && text(&said).contains("drives; stop it"), "{code} {said}");
    assert!(server.body("/api/control")["other_driver"].is_string());

    // The rig has been silent for max_age (2 s): the page may drive again, until it is released.
    std::thread::sleep(Duration::from_millis(2500));
    server.steer_to(20.0);
    assert_eq!(server.post("release", TOKEN, json!({"operator": "Kim"})).0, 200);
    assert_eq!(server.body("/api/control")["ended"], "Kim released it");
    server.end();
    twin.signal("INT");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn what_an_operator_asks_reaches_the_node_and_its_words_come_back() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&["--namespace", "/rig_7"]);
    twin.wait_for("model time runs");
    let server = Server::start(&network, &["--namespace", "/rig_7", "--allow-control"]);
    let Some(_) = server.get("/api/session") else { return };
    server.body_with("/api/control", |control| !control["applied_rpm"].is_null());
    let said = |what: &str, body: Value| server.post(what, TOKEN, body);
    let shelve = json!({"operator": "Kim", "id": "shock", "reason": "a test", "duration_s": 60});
    assert_eq!(
        said("shelve", shelve),
        (200, json!({"ok": true, "message": "shock shelved for 60 s"}))
    );
    let back = json!({"operator": "Kim", "id": "shock"});
    assert_eq!(
        said("unshelve", back),
        (200, json!({"ok": true, "message": "shock is no longer shelved"}))
    );
    let (code, refused) = said(
        "shelve",
        json!({"operator": "Kim", "id": "no_such", "reason": "a test"}),
    );
    assert!(code == 409 && text(&refused).contains("no_such"), "{code} {refused}");
    assert_eq!(said("acknowledge", json!({"operator": "Kim", "id": "all"})).0, 200);
    assert_eq!(
        said("pause", json!({"operator": "Kim", "paused": true})).1["message"],
        "paused"
    );
    assert_eq!(
        said("pause", json!({"operator": "Kim", "paused": false})).1["message"],
        "running"
    );
    assert_eq!(said("reset", json!({"operator": "Kim"})).0, 200);
    assert_eq!(said("explode", json!({"operator": "Kim"})).0, 404);
    let journal = server.body_with("/api/journal", |journal| {
        journal["events"].as_array().unwrap().len() >= 2
    });
    let by_kim = |event: &&Value| event["operator_name"] == "Kim" && event["id"] == "shock";
    let events = journal["events"].as_array().unwrap();
    assert_eq!(events.iter().filter(by_kim).count(), 2, "{journal}");
    twin.signal("KILL");
    twin.end();
    // Its status is 2 s old, and its services are gone or do not answer within 3 s.
    std::thread::sleep(Duration::from_millis(2500));
    assert_eq!(server.steer(20.0).0, 503);
    assert_eq!(said("reset", json!({"operator": "Kim"})).0, 503);
    server.end();
}

/// The page shows what the bridge makes of the rig's first frame, and its click confirms it.
#[test]
fn the_page_shows_the_items_of_a_rigs_line_and_confirms_them() {
    let Some(network) = Network::new() else { return };
    let state = tempfile::tempdir().unwrap();
    let mut bridge = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    bridge
        .args([
            "bridge",
            "wits",
            "--namespace",
            "/rig_7",
            "--listen",
            "127.0.0.1:0",
            "--state-dir",
        ])
        .arg(state.path());
    let mut bridge = Program::start(bridge);
    let said = bridge.wait_for("wits at 127.0.0.1:");
    let mut words = said.split_whitespace();
    let place = words.find(|word| word.starts_with("127.0.0.1:")).unwrap();
    let port = place.rsplit(':').next().unwrap();
    let server = Server::start(&network, &["--namespace", "/rig_7", "--allow-control"]);
    let Some(_) = server.get("/api/session") else { return };
    // A rig that sends until the test ends.
    let script = "exec 3<>/dev/tcp/127.0.0.1/$0; for turn in {1..600}; do \
                  printf '&&\\r\\n0116 0.8\\r\\n0120 40\\r\\n0144 1180\\r\\n!!\\r\\n' >&3; sleep 0.1; done";
    let mut rig = network.command("bash");
    rig.args(["-c", script, port]);
    let rig = Program::start(rig);
    let shown = server.body_with("/api/mappings", |all| !all[0].is_null());
    let first = &shown[0];
    assert_eq!(
        (&first["node"], &first["source"], &first["file"]),
        (
            &json!("/rig_7/flexdrill_bridge_wits"),
            &json!("127.0.0.1"),
            &json!("default")
        )
    );
    assert_eq!((&first["confirmed"], &first["can_confirm"]), (&json!(""), &json!(true)));
    // A kdaN is 10 kN.
    assert_eq!(
        first["items"],
        json!([
            {"item": "0116", "quantity": "weight_on_bit", "sent": "0.8 kdaN", "used": "8 kN"},
            {"item": "0120", "quantity": "rotary_speed", "sent": "40 r/min", "used": "40 r/min"},
            {"item": "0144", "quantity": "", "sent": "1180", "used": ""},
        ])
    );
    let wanted = |mapping: &Value| json!({"operator": "Kim", "source": "127.0.0.1", "mapping": mapping});
    assert_eq!(server.post("confirm_mapping", "", wanted(&first["mapping"])).0, 401);
    let (code, refused) = server.post("confirm_mapping", TOKEN, wanted(&json!("0123456789abcdef")));
    assert!(
        code == 409 && text(&refused).contains("compare its table again"),
        "{code} {refused}"
    );
    let (code, done) = server.post("confirm_mapping", TOKEN, wanted(&first["mapping"]));
    assert!(
        code == 200 && text(&done).ends_with("is confirmed for 127.0.0.1 by Kim"),
        "{code} {done}"
    );
    let confirmed = server.body_with("/api/mappings", |all| all[0]["confirmed"] != "");
    assert!(
        confirmed[0]["confirmed"].as_str().unwrap().ends_with(" by Kim"),
        "{confirmed}"
    );
    // Another namespace has another rig, and a server for reading only confirms nothing.
    server.end();
    let reader = Server::start(&network, &["--namespace", "/rig_7"]);
    let shown = reader.body_with("/api/mappings", |all| !all[0].is_null());
    assert_eq!(shown[0]["can_confirm"], false);
    assert_eq!(reader.post("confirm_mapping", TOKEN, wanted(&first["mapping"])).0, 403);
    reader.end();
    drop(rig);
    bridge.signal("TERM");
    assert_eq!(bridge.end(), Some(0), "{}", bridge.said());
}

#[test]
fn what_if_is_asked_with_the_token_and_its_answers_are_for_all() {
    let Some(network) = Network::new() else { return };
    let mut twin = network.twin(&["--namespace", "/rig_7"]);
    twin.wait_for("model time runs");
    let server = Server::start(&network, &["--namespace", "/rig_7", "--allow-control"]);
    let Some(_) = server.get("/api/session") else { return };
    server.body_with("/api/control", |control| !control["applied_rpm"].is_null());
    assert_eq!(server.body("/api/what_if")["number"], 0);
    let point = |rpm: f64| json!({"rotary_speed_rpm": rpm, "weight_on_bit_kn": 5.0});
    let question = |points: &[Value], horizon: f64, members: u32| json!({"operator": "Kim", "candidates": points, "horizon": horizon, "members": members});
    let short = question(&[point(30.0), point(60.0)], 10.0, 2);
    assert_eq!(
        server.post("what_if", "another token of a reader", short.clone()).0,
        401
    );
    assert_eq!(server.post("what_if", TOKEN, question(&[], 10.0, 2)).0, 400);
    let (code, said) = server.post("what_if", TOKEN, short);
    assert_eq!(code, 200, "{said}");
    // The look-ahead has the lowest priority: on a busy machine it waits for all else.
    let answered = server.body_within(240, "/api/what_if", |asked| asked["running"] == false);
    assert_eq!((&answered["failed"], &answered["by"]), (&json!(false), &json!("Kim")));
    let answers = answered["answers"].as_array().unwrap();
    assert_eq!(answers.len(), 2);
    for (answer, rpm) in answers.iter().zip([30.0, 60.0]) {
        assert_eq!(answer["candidate"]["rotary_speed"], rpm);
        assert_eq!((&answer["members"], &answer["failed"]), (&json!(2), &json!(0)));
        assert!(answer["any_alarm_upper"].as_f64().unwrap() > 0.0, "{answer}");
    }
    // The node's words on a question that is out of its bounds.
    std::thread::sleep(Duration::from_secs(1));
    let (code, said) = server.post("what_if", TOKEN, question(&[point(1e6)], 10.0, 2));
    assert!(
        code == 409 && text(&said).contains("inputs.rotary_speed"),
        "{code} {said}"
    );
    let refused = server.body_with("/api/what_if", |asked| asked["running"] == false);
    assert!(
        refused["failed"] == true && text(&refused).contains("inputs.rotary_speed"),
        "{refused}"
    );
    // One at a time; a long one is cancelled.
    std::thread::sleep(Duration::from_secs(1));
    let long = question(&[point(30.0)], 600.0, 50);
    assert_eq!(server.post("what_if", TOKEN, long.clone()).0, 200);
    let (code, said) = server.post("what_if", TOKEN, long);
    assert!(
        code == 409 && text(&said).contains("a question of Kim"),
        "{code} {said}"
    );
    assert_eq!(server.post("cancel_what_if", TOKEN, json!({"operator": "Kim"})).0, 200);
    let cancelled = server.body_with("/api/what_if", |asked| asked["running"] == false);
    assert!(text(&cancelled).starts_with("cancelled"), "{cancelled}");
    server.end();
    // A server for reading only has no questions.
    let server = Server::start(&network, &["--namespace", "/rig_7"]);
    assert_eq!(server.body("/api/what_if"), Value::Null);
    assert_eq!(server.post("what_if", TOKEN, question(&[point(30.0)], 10.0, 2)).0, 403);
    server.end();
}

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
fn the_page_is_guarded_and_without_leave_nobody_steers() {
    let Some(network) = Network::new() else { return };
    let server = Server::start(&network, &[]);
    let Some(page) = server.get("/") else { return };
    assert_eq!(
        (&page["code"], &page["headers"]["content-type"]),
        (&json!(200), &json!("text/html; charset=utf-8"))
    );
    let policy = page["headers"]["content-security-policy"].as_str().unwrap();
    assert!(
        policy.contains("default-src 'none'") && policy.contains("connect-src 'self'"),
        "{policy}"
    );
    let tag = format!("If-None-Match={}", page["headers"]["etag"].as_str().unwrap());
    let again = network.http("GET", ROOT, &[&tag], "").unwrap();
    assert_eq!(again["code"], 304);
    let foreign = network
        .http("GET", &format!("{ROOT}/api/session"), &["Host=rig.example"], "")
        .unwrap();
    assert_eq!(foreign["code"], 403, "a name that anybody may point here");
    let (code, said) = server.steer(20.0);
    assert!(code == 403 && text(&said).contains("--allow-control"), "{code} {said}");
    assert_eq!(server.body("/api/control"), json!({"allowed": false, "driving": false}));
    assert_eq!(server.get("/api/history").unwrap()["code"], 404);
    assert_eq!(server.get("/api/nothing").unwrap()["code"], 404);
    let refused = network.viewer(&[
        "refused",
        "ws://127.0.0.1:8080/live",
        "foxglove.sdk.v1",
        "https://evil.example",
    ]);
    assert_eq!(refused.unwrap()["code"], 403);
    server.end();
}

/// The arguments of a program are there for all users of the machine to read.
#[test]
fn a_browser_is_opened_without_showing_the_token() {
    let Some(network) = Network::new() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (opener, seen) = (folder.path().join("xdg-open"), folder.path().join("seen"));
    let script = format!(
        "#!/bin/sh\necho \"$@\" > {0}.part\ncat \"$1\" >> {0}.part\nmv {0}.part {0}\n",
        seen.display()
    );
    std::fs::write(&opener, script).unwrap();
    std::fs::set_permissions(&opener, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut token = tempfile::NamedTempFile::new().unwrap();
    writeln!(token, "{TOKEN}").unwrap();
    let path = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap());
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command
        .args(["dashboard", "--open", "--allow-control", "--token-file"])
        .arg(token.path());
    command.env("PATH", path).env("XDG_RUNTIME_DIR", folder.path());
    let mut program = Program::start(command);
    program.wait_for("dashboard at");
    let deadline = Instant::now() + Duration::from_secs(20);
    while !seen.exists() {
        assert!(Instant::now() < deadline, "no browser was opened: {}", program.said());
        std::thread::sleep(Duration::from_millis(50));
    }
    let seen = std::fs::read_to_string(&seen).unwrap();
    let (arguments, page) = seen.split_once('\n').unwrap();
    assert!(
        !arguments.contains(TOKEN) && arguments.ends_with(".html"),
        "{arguments}"
    );
    assert!(page.contains(&format!("url={ROOT}/#token={TOKEN}")), "{page}");
    let mode = std::fs::metadata(arguments).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    program.signal("INT");
    assert_eq!(program.end(), Some(0));
    assert!(!std::path::Path::new(arguments).exists(), "it goes with the dashboard");
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
