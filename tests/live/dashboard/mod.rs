//! The dashboard's server, as a browser and a foreign viewer see it: page, session, history, steering, a recording.

mod access;
mod before;

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
