//! Connections and options that are refused.

use super::*;

/// Certificates for `localhost`, of an authority in `ca.pem` and of another in `other.pem`.
fn certificates(folder: &Path) -> Option<()> {
    let script = "set -e
        cat >names <<'END'
[req]
distinguished_name = name
prompt = no
[name]
CN = set by -subj
[authority]
basicConstraints = critical, CA:TRUE
[broker]
subjectAltName = DNS:localhost
END
        new='-newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -config names'
        for ca in ca other; do
            openssl req -x509 $new -subj /CN=$ca -extensions authority -days 2 -keyout $ca.key -out $ca.pem
        done
        openssl req $new -subj /CN=broker -keyout broker.key -out broker.csr
        openssl x509 -req -in broker.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -extfile names \
            -extensions broker -out broker.pem";
    let made = Command::new("sh").args(["-c", script]).current_dir(folder).output();
    match made {
        Ok(output) if output.status.success() => Some(()),
        Ok(output) => skipped(&format!("openssl: {}", String::from_utf8_lossy(&output.stderr))),
        Err(error) => skipped(&format!("sh: {error}")),
    }
}

#[test]
fn a_refused_connection_says_what_to_do() {
    let Some(network) = Network::new() else { return };
    let lines = "listener 1883 127.0.0.1\nallow_anonymous false\npassword_file FOLDER/users\n\
        listener 8883 127.0.0.1\ncertfile FOLDER/broker.pem\nkeyfile FOLDER/broker.key\ncafile FOLDER/ca.pem\n";
    let folder = tempfile::tempdir().unwrap();
    let Some(()) = certificates(folder.path()) else { return };
    let in_folder = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (users, ca, other) = (in_folder("users"), in_folder("ca.pem"), in_folder("other.pem"));
    // mosquitto_passwd comes with mosquitto.
    let Some(broker) = mosquitto() else { return };
    let made = Command::new("mosquitto_passwd")
        .args(["-b", "-c", &users, "rig", "s3cret-right"])
        .status();
    if !made.is_ok_and(|status| status.success()) {
        let Some(()) = skipped("mosquitto_passwd did not make a file of users") else {
            return;
        };
    }
    drop(broker);
    let lines = lines.replace("FOLDER", folder.path().to_str().unwrap());
    let Some(_broker) = Broker::start(&network, &lines) else {
        return;
    };
    let (right, wrong) = (in_folder("right"), in_folder("wrong"));
    std::fs::write(&right, "s3cret-right\n").unwrap();
    std::fs::write(&wrong, "s3cret-wrong\n").unwrap();

    let user = ["--user", "rig", "--password-file", &right];
    let bad_user = ["--user", "rig", "--password-file", &wrong];
    let cases: [(&str, &[&str], &[&str], &str); 9] = [
        (
            "localhost",
            &[],
            &[],
            "the broker requires a user; give --user and --password-file",
        ),
        (
            "localhost",
            &bad_user,
            &[],
            "refuses the user \"rig\" or its password; check --user and --password-file",
        ),
        ("localhost", &user, &[], "connected to localhost:1883"),
        (
            "localhost:1884",
            &user,
            &[],
            "nothing listens at localhost:1884; check --broker",
        ),
        (
            "nowhere.invalid",
            &user,
            &[],
            "the host \"nowhere.invalid\" cannot be found",
        ),
        ("localhost", &user, &["--tls-ca", &ca], "connected to localhost:8883"),
        (
            "localhost",
            &user,
            &["--tls-ca", &other],
            "from none of the trusted authorities; check --tls-ca",
        ),
        (
            "127.0.0.1",
            &user,
            &["--tls-ca", &ca],
            "the broker's certificate is not for \"127.0.0.1\"",
        ),
        (
            "localhost:8883",
            &user,
            &[],
            "if this port expects TLS, give --tls-ca or --tls",
        ),
    ];
    for (host, user, tls, expected) in cases {
        let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
        command.args(["bridge", "mqtt", "--broker", host]).args(user).args(tls);
        let mut program = Program::start(command);
        program.wait_for(expected);
        assert!(!program.said().contains("s3cret"), "{}", program.said());
        program.signal("INT");
        assert_eq!(program.end(), Some(0), "{}", program.said());
    }
}

#[test]
fn wrong_options_are_refused_before_anything_starts() {
    let folder = tempfile::tempdir().unwrap();
    let empty = folder.path().join("empty");
    std::fs::write(&empty, "\n").unwrap();
    let empty = empty.to_str().unwrap();
    let cases: [(&[&str], i32, &str); 8] = [
        (&["--broker", "mqtt://a"], 2, "HOST:PORT"),
        (&["--broker", "a:0"], 2, "the port must be 1 to 65535"),
        (&["--broker", "a", "--topic", "a/#"], 2, "such as rigs/rig_7"),
        (&["--broker", "a", "--sparkplug", "rig"], 2, "such as field_a/rig_7"),
        (&["--broker", "a", "--password-file", empty], 2, "--user"),
        (
            &["--broker", "a", "--user", "u", "--password-file", empty],
            1,
            "the first line is empty",
        ),
        (
            &["--broker", "a", "--user", "u", "--password-file", "/nowhere"],
            1,
            "--password-file /nowhere",
        ),
        (&["--broker", "a", "--tls-ca", empty], 1, "-----BEGIN CERTIFICATE-----"),
    ];
    for (arguments, code, expected) in cases {
        let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
        let output = command.args(["bridge", "mqtt"]).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
}
