//! `flexdrill map` on the short tool of the tests: the same bytes with any number of threads and interruptions, what its files
//! say, and refusals in words.

use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use flexdrill_config::Config;
use flexdrill_sweep::Directory;
use flexdrill_sweep::map::{Map, Origin, Verdict};
use flexdrill_uncertainty::posterior::{Provenance, to_csv};

use crate::sweep::{flexdrill, run, text};

pub(crate) const MAP: [&str; 5] = ["map", "tests/data/small.yaml", "--rpm", "30:110", "--out"];
pub(crate) const SMALL: [&str; 8] = ["--wob", "1:9", "--grid", "3x3", "--horizon", "10", "--members", "2"];

#[test]
fn a_map_has_the_same_bytes_with_any_threads_and_interruptions() {
    let folder = tempfile::tempdir().unwrap();
    let (one, two) = (folder.path().join("one"), folder.path().join("two"));
    let words = run(&MAP, &one, &[&SMALL[..], &["--share", "80"]].concat());
    assert!(
        words.contains("9 cells from 2 starts") && words.contains("map.json"),
        "{words}"
    );
    // Interrupted in the middle, then continued with two threads.
    let share = [&SMALL[..], &["--share", "80", "--jobs", "2"]].concat();
    let mut worker = flexdrill(&MAP, &two)
        .args(&share)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let limit = Instant::now() + Duration::from_secs(120);
    while !Directory::open(&two).is_ok_and(|there| there.status().is_ok_and(|status| status.done > 1)) {
        assert!(Instant::now() < limit, "no point was computed");
        std::thread::sleep(Duration::from_millis(5));
    }
    worker.kill().unwrap();
    worker.wait().unwrap();
    run(&MAP, &two, &share);
    for name in [
        "map.json",
        "map.csv",
        "map.svg",
        "map.html",
        "envelope_x.csv",
        "envelope_y.csv",
    ] {
        let [a, b] = [&one, &two].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(!a.is_empty() && a == b, "{name}");
    }
    let map = Map::load(&one.join("map.json")).unwrap();
    let config = Config::load("tests/data/small.yaml").unwrap();
    assert_eq!((map.configuration, map.motion), (config.hash(), config.motion_hash()));
    assert_eq!((map.x.unit.as_str(), map.y.unit.as_str()), ("r/min", "kN"));
    assert_eq!(map.x.values, [30.0, 70.0, 110.0]);
    let known = map
        .cells
        .iter()
        .flat_map(|cell| &cell.starts)
        .filter(|start| start.state == Origin::Known)
        .count();
    assert_eq!(known, map.runs as usize);
    assert!(map.runs <= 14, "{}", map.runs);
}

/// Two Newton iterations and no smaller step: no run can be computed.
const FAILING: [&str; 4] = ["--set", "solver.max_iterations=2", "--set", "solver.max_halvings=0"];

#[test]
fn settings_under_which_every_run_fails_leave_nothing_clear() {
    let folder = tempfile::tempdir().unwrap();
    let grid = [
        &["--wob", "1:9", "--grid", "7x5", "--horizon", "10", "--jobs", "2"],
        &FAILING[..],
    ]
    .concat();
    let command = || flexdrill(&MAP, folder.path()).args(&grid).output().unwrap();
    let first = command();
    assert_eq!(first.status.code(), Some(1), "{}", text(&first));
    let said = text(&first);
    let map = Map::load(&folder.path().join("map.json")).unwrap();
    assert!(said.contains(&format!("all {} runs failed", map.runs)), "{said}");
    assert!(said.contains("no envelope") && said.contains("a step failed"), "{said}");
    let verdicts: Vec<Verdict> = map.cells.iter().map(|cell| cell.verdict).collect();
    assert_eq!(verdicts.len(), 35);
    let nothing = [Verdict::Unknown, Verdict::NotKnown];
    assert!(verdicts.iter().all(|verdict| nothing.contains(verdict)), "{verdicts:?}");
    assert!(nothing.iter().all(|verdict| verdicts.contains(verdict)), "{verdicts:?}");
    // What an earlier map of the folder has left is not taken for this one's.
    let envelope = folder.path().join("envelope_x.csv");
    assert!(!envelope.exists());
    std::fs::write(&envelope, "a").unwrap();
    assert_eq!(command().status.code(), Some(1));
    assert!(!envelope.exists());
    // The picture has both classes in its legend, no clear one, and says of itself what it is a map of.
    let picture = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    let texts: Vec<&str> = picture.lines().filter(|line| !line.starts_with('<')).collect();
    let has = |words: &str| texts.contains(&words);
    assert!(has("not known") && has("a run failed") && !has("clear"), "the legend");
    let words = texts.join(" ");
    assert!(
        has("Safe window") && words.contains("clear for its friction"),
        "{words}"
    );
    let page = std::fs::read_to_string(folder.path().join("map.html")).unwrap();
    assert!(page.contains("cells are not known") && page.contains("No member of any run ended."));
}

#[test]
fn the_map_states_the_members_that_ran() {
    let folder = tempfile::tempdir().unwrap();
    let small = [
        "--wob",
        "2:4",
        "--grid",
        "2x2",
        "--horizon",
        "10",
        "--members",
        "2",
        "--run-all",
        "--jobs",
        "2",
    ];
    let words = run(
        &["map", "tests/data/small.yaml", "--rpm", "40:60", "--out"],
        folder.path(),
        &small,
    );
    let said = "In each run 2 of at most 2 members ended. No alarm in 2 excludes chances above 66 %";
    assert!(words.contains(said), "{words}");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(read("map.html").contains(said) && read("map.json").contains("\"run_all\":true"));
    let table = read("map.csv");
    assert!(
        table.lines().next().is_some_and(|names| names.contains("members")),
        "{table}"
    );
}

#[test]
fn maps_of_other_keys_are_made_and_wrong_axes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let keys = [
        "map",
        "tests/data/small.yaml",
        "--x",
        "contact.inner.friction_tangential=0.1:0.7",
        "--y",
        "contact.outer.friction_tangential=0.1:0.5",
        "--grid",
        "2x2",
        "--horizon",
        "10",
        "--members",
        "1",
        "--share",
        "100",
        "--set",
        "inputs.rotary_speed.initial_rpm=40",
        "--running-rpm",
        "80",
        "--set",
        "inputs.weight_on_bit.initial_kn=5",
        "--out",
    ];
    run(&keys, folder.path(), &["--jobs", "2"]);
    let map = Map::load(&folder.path().join("map.json")).unwrap();
    assert_eq!(
        (map.runs, map.x.name.as_str()),
        (8, "contact.inner.friction_tangential")
    );
    let other = folder.path().join("other");
    for (arguments, code, part) in [
        (
            &[
                "map",
                "tests/data/small.yaml",
                "--rpm",
                "30:130",
                "--wob",
                "1:9",
                "--out",
            ][..],
            1,
            "inputs.rotary_speed.initial_rpm = 120.9",
        ),
        (
            &[
                "map",
                "tests/data/small.yaml",
                "--rpm",
                "30:110",
                "--wob",
                "1:90",
                "--out",
            ],
            1,
            "inputs.weight_on_bit.initial_kn = 60.3",
        ),
        (
            &[
                "map",
                "tests/data/small.yaml",
                "--rpm",
                "30:110",
                "--y",
                "no.such=1:9",
                "--out",
            ],
            1,
            "no.such: no such key",
        ),
        (
            &["map", "tests/data/small.yaml", "--rpm", "30:110", "--out"],
            2,
            "--wob",
        ),
        (
            &[
                "map",
                "tests/data/small.yaml",
                "--rpm",
                "110:30",
                "--wob",
                "1:9",
                "--out",
            ],
            2,
            "use LOW:HIGH",
        ),
        (
            &[
                "map",
                "tests/data/small.yaml",
                "--rpm",
                "30:110",
                "--wob",
                "1:9",
                "--horizon",
                "5",
                "--out",
            ],
            2,
            "use 10 to 600 s",
        ),
        (
            &[
                "map",
                "tests/data/small.yaml",
                "--rpm",
                "30:110",
                "--wob",
                "1:9",
                "--grid",
                "1x3",
                "--out",
            ],
            2,
            "use NxM",
        ),
    ] {
        let output = flexdrill(arguments, &other).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{}", text(&output));
        assert!(text(&output).contains(part), "{part}: {}", text(&output));
        assert!(!other.exists(), "{part}");
    }
}

const DRAWN: &str = "contact.outer.friction_tangential";

/// The short tool with plausible tools from `sample.csv` next to it: 20 members of a friction about 0.3, fitted to `tool`, or to
/// this one.
fn calibrated(folder: &Path, tool: Option<String>) -> std::path::PathBuf {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/small.yaml")).unwrap();
    let path = folder.join("tool.yaml");
    let more = format!(
        "uncertainty:\n  keys:\n    - {{key: {DRAWN}, distribution: {{uniform: {{low: 0.05, high: 0.6}}}}, source: a \
         test}}\nensemble: {{members: 8, from: {{posterior: sample.csv}}}}\n"
    );
    std::fs::write(&path, text + &more).unwrap();
    let provenance = Provenance {
        version: "1.2.3".into(),
        tool: tool.unwrap_or_else(|| Config::load(&path).unwrap().tool_hash([DRAWN])),
        log: "rig of May.csv".into(),
        sha256: "ab".repeat(32),
        rows: [3, 900],
        ..Provenance::default()
    };
    let rows: Vec<[f64; 1]> = (0..20).map(|row| [0.29 + 1e-3 * f64::from(row)]).collect();
    let rows = rows.iter().map(|row| (1.0, row.as_slice()));
    std::fs::write(folder.join("sample.csv"), to_csv(&provenance, &[DRAWN], rows)).unwrap();
    path
}

/// A map over plausible tools of a calibration says so, keeps the sample for other machines, and refuses that of another tool.
#[test]
fn a_map_says_what_its_tools_are_drawn_from() {
    let folder = tempfile::tempdir().unwrap();
    let config = calibrated(folder.path(), None);
    let out = folder.path().join("map");
    let config = config.to_str().unwrap();
    let small = [
        "--wob",
        "2:4",
        "--grid",
        "2x2",
        "--horizon",
        "10",
        "--members",
        "1",
        "--share",
        "100",
    ];
    let small = [&small[..], &["--running-rpm", "60", "--jobs", "2", "--plausible"]].concat();
    let of = ["map", config, "--rpm", "40:60", "--out"];
    let words = run(&of, &out, &small);
    let said =
        "drawn from a calibration: 20 members, 20 alike by their weights, fitted to rows 3 to 900 of rig of May.csv";
    assert!(words.contains(said) && words.contains("s of model time"), "{words}");
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    assert!(read("map.html").contains(said));
    let map = Map::load(&out.join("map.json")).unwrap();
    let sample = map.posterior.unwrap();
    assert_eq!(
        (sample.keys, sample.log_sha256),
        (vec![DRAWN.to_owned()], "ab".repeat(32))
    );
    assert_eq!(
        flexdrill_config::sha256(read("posterior.csv").as_bytes()),
        sample.sha256
    );
    // Eight runs of 10 s with their ways, and a running tool of 13 s for each weight.
    assert!((100.0..180.0).contains(&map.model_time), "{}", map.model_time);
    // Another machine has the copy alone.
    std::fs::remove_file(folder.path().join("sample.csv")).unwrap();
    std::fs::remove_dir_all(out.join("points")).unwrap();
    let worked = run(&["sweep", "work"], &out, &["--jobs", "2", "--chunk", "0/8"]);
    assert!(worked.contains("1 computed"), "{worked}");
    std::fs::write(
        out.join("posterior.csv"),
        read("posterior.csv").replacen("0.29", "0.28", 1),
    )
    .unwrap();
    let another = flexdrill(&["sweep", "work"], &out).output().unwrap();
    assert_eq!(another.status.code(), Some(1));
    assert!(
        text(&another).contains("ensemble.posterior_sha256"),
        "{}",
        text(&another)
    );
    // A sample of another tool, and cells of other tools than that of the sample.
    let other = folder.path().join("other");
    let refused = |of: &[&str], more: &[&str]| {
        let output = flexdrill(of, &other).args(more).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", text(&output));
        assert!(
            text(&output).contains("a posterior of another tool"),
            "{}",
            text(&output)
        );
        assert!(!other.exists());
    };
    calibrated(folder.path(), None);
    let length = "tool.joint.limit_deg=5:7";
    refused(
        &[
            "map",
            config,
            "--rpm",
            "40:60",
            "--y",
            length,
            "--grid",
            "2x2",
            "--plausible",
            "--out",
        ],
        &[],
    );
    calibrated(folder.path(), Some("cd".repeat(32)));
    refused(&of, &small);
}
