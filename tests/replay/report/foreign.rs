//! Recordings that other programs have written, and programs that read ours.

use super::*;

/// Sections, figures and tiles of a page, in their order.
fn contents(page: &str) -> Vec<String> {
    let all = |before: &str, after: &str| -> Vec<String> {
        let pieces = page.split(before).skip(1);
        pieces
            .filter_map(|piece| piece.split(after).next().map(str::to_owned))
            .collect()
    };
    [all("<h2>", "</h2>"), all("<figure id=\"", "\"")].concat()
}

/// Bags of the twin's topics that a recorder from other hands made, MCAP and SQLite, give the page that ours gives.
#[test]
fn interop_a_foreign_recording_of_a_run_has_the_same_sections() {
    let Some(network) = crate::common::Network::new() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("run");
    let mut twin = network.twin(&["--record", text(&own), "--duration", "16"]);
    assert_eq!(twin.end(), Some(0));
    let Some(said) = crate::common::python::run("bags.py", &["record", text(&own)], "") else {
        return;
    };
    assert!(said.contains("/twin/session"), "{said}");
    let (page, _) = report(&own, &[]);
    let sections = contents(&page);
    assert!(sections.len() > 10, "{sections:?}");
    let mut tiles = Vec::new();
    // Folders, and their files alone; of ROS 2 Humble a file without definitions.
    for name in [
        "run_mcap",
        "run_mcap/run_mcap.mcap",
        "run_sqlite",
        "run_sqlite/run_sqlite.db3",
        "run_humble.db3",
    ] {
        let (foreign, said) = report(&folder.path().join(name), &[]);
        let has = contents(&foreign);
        for section in &sections {
            assert!(has.contains(section), "{name}: {section} is not in {has:?}: {said}");
        }
        assert!(foreign.contains("tool:\n"), "the configuration, from the latched topic");
        assert!(!said.contains("cannot be read"), "{said}");
        let tile = foreign.split("largest force, pipe on guide").next().unwrap();
        tiles.push(tile.rsplit("<b>").next().unwrap().to_owned());
    }
    assert!(
        tiles.iter().all(|tile| *tile == tiles[0]),
        "both hold the same: {tiles:?}"
    );
}

/// The example of the manual, on a bag of ours, with the packages that it names.
#[test]
fn interop_the_python_example_reads_and_draws_a_recording() {
    let Some(python) = crate::common::python::with("rosbags, matplotlib") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let picture = folder.path().join("run.png");
    let output = Command::new(python)
        .arg(crate::common::root().join("docs/examples/plot_recording.py"))
        .args([text(&run), "--out", text(&picture)])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(std::fs::read(&picture).unwrap().starts_with(b"\x89PNG"));
    // Both found the same largest force.
    let (page, _) = report(&run, &[]);
    let force = said
        .lines()
        .find_map(|line| line.strip_prefix("largest force, pipe on guide: "))
        .unwrap();
    let newtons: f64 = force.split(' ').next().unwrap().parse().unwrap();
    assert!(newtons > 10.0, "{said}");
    let tile = format!("<b>{:.3} kN</b>largest force, pipe on guide", newtons / 1e3);
    assert!(newtons >= 1000.0 || page.contains(&tile), "{tile}");
}

/// A recording with the default's rates has too few positions to count turns in: the example says so and prints the rest.
#[test]
fn interop_the_example_that_counts_turns_reads_a_recording_of_any_rate() {
    let Some(python) = crate::common::python::with("mcap_ros2, numpy, ruamel.yaml") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let run = replayed(folder.path());
    let file = std::fs::read_dir(&run)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .find(|path| path.extension().is_some_and(|extension| extension == "mcap"))
        .unwrap();
    let read = |path: &Path| {
        let mut command = Command::new(&python);
        let script = crate::common::root().join("docs/examples/count_turns.py");
        let output = command.arg(script).args(["read", text(path)]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(!said.contains("Traceback"), "{said}");
        (output.status.success(), said)
    };
    let (done, said) = read(&file);
    assert!(done, "{said}");
    assert!(
        said.contains("bit speed ripple") && said.contains("largest pipe-guide force"),
        "{said}"
    );
    assert!(
        said.contains("turns are not counted: twin/tool_shape comes every 0.10 s"),
        "{said}"
    );
    assert!(said.contains("record with outputs.rates.tool_shape: 50"), "{said}");
    // Of a bag without the twin, what is missing is named.
    let path = folder.path().join("rig.mcap");
    let mut bag = Bag::new(&path, &[("/", &topics::ROTARY_SPEED_RPM)]);
    bag.put("/rig/rotary_speed_rpm", 0.0, &to_cdr(&Float64 { data: 40.0 }).unwrap());
    bag.recorder.finish().unwrap();
    let (done, said) = read(&path);
    assert!(!done && said.contains("0 messages of twin/tool_shape"), "{said}");
}
