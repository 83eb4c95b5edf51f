//! Who may see the page and steer.

use super::*;

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
