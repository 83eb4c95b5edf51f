//! `flexdrill sweep` on the short tool of the tests: the same bytes with any number of threads and killed workers, and refusals
//! in words.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use flexdrill_sweep::Directory;

use crate::map;

pub(crate) fn flexdrill(arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
    command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .arg(folder);
    command
}

pub(crate) fn text(output: &Output) -> String {
    [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes))
        .concat()
}

pub(crate) fn run(arguments: &[&str], folder: &Path, more: &[&str]) -> String {
    let output = flexdrill(arguments, folder).args(more).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", text(&output));
    text(&output)
}

const PLAN: [&str; 3] = ["sweep", "plan", "tests/data/sweep.yaml"];

fn planned(folder: &Path) -> PathBuf {
    run(&PLAN, folder, &[]);
    folder.to_owned()
}

#[test]
fn killed_workers_and_threads_change_no_byte_of_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let alone = planned(&folder.path().join("alone"));
    run(&["sweep", "work"], &alone, &["--jobs", "1"]);
    run(&["sweep", "collect"], &alone, &[]);
    let killed = planned(&folder.path().join("killed"));
    let done = || Directory::open(&killed).unwrap().status().unwrap().done;
    // Two workers on the same points; one is killed once a point is there, while it works on another one.
    let mut workers = [0, 1].map(|_| {
        flexdrill(&["sweep", "work"], &killed)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    });
    let limit = Instant::now() + Duration::from_secs(120);
    while done() == 0 {
        assert!(Instant::now() < limit, "no point was computed");
        std::thread::sleep(Duration::from_millis(5));
    }
    workers[0].kill().unwrap();
    assert!(!workers[0].wait().unwrap().success());
    assert!(done() < 8, "the worker had ended before it was killed");
    assert!(workers[1].wait().unwrap().success());
    let again = run(&["sweep", "work"], &killed, &["--jobs", "2"]);
    assert!(again.contains("8 points: 0 computed"), "{again}");
    run(&["sweep", "collect"], &killed, &[]);
    let tables = [&alone, &killed].map(|folder| std::fs::read(folder.join("points.csv")).unwrap());
    assert_eq!(tables[0], tables[1]);
    let table = String::from_utf8(tables[0].clone()).unwrap();
    assert_eq!(table.lines().count(), 9, "{table}");
    assert!(table.lines().skip(1).all(|row| row.contains(",known,2,0,")), "{table}");
}

#[test]
fn parts_are_parts_and_what_is_refused_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let path = planned(&folder.path().join("sweep"));
    let said = run(&["sweep", "work"], &path, &["--chunk", "1/8"]);
    assert!(said.contains("1 point: 1 computed"), "{said}");
    // A scheduler's array may have more tasks than there are points.
    let said = run(&["sweep", "work"], &path, &["--chunk", "9/20"]);
    assert!(said.contains("0 points: 0 computed"), "{said}");
    let said = run(&["sweep", "status"], &path, &[]);
    assert!(
        said.contains("missing     7") && said.contains("done        1 (0 with"),
        "{said}"
    );
    for (arguments, more, code, part) in [
        (&["sweep", "work"][..], &["--chunk", "8/8"][..], 2, "use I/N"),
        (
            &["sweep", "collect"],
            &[],
            1,
            "7 of 8 points have no result; run flexdrill sweep work",
        ),
        (
            &["sweep", "plan", "tests/data/small.yaml"],
            &[],
            1,
            "tests/data/small.yaml",
        ),
    ] {
        let output = flexdrill(arguments, &path).args(more).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{}", text(&output));
        assert!(text(&output).contains(part), "{}", text(&output));
    }
    // A map is another plan.
    let map = flexdrill(&map::MAP, &path).args(map::SMALL).output().unwrap();
    assert_eq!(map.status.code(), Some(1));
    assert!(text(&map).contains("the directory has another plan"), "{}", text(&map));
    // Another version's plan.
    let plan = path.join("sweep.json");
    let other =
        std::fs::read_to_string(&plan)
            .unwrap()
            .replacen("\"program\":\"flexdrill ", "\"program\":\"flexdrill 9", 1);
    std::fs::write(&plan, other).unwrap();
    let work = flexdrill(&["sweep", "work"], &path).output().unwrap();
    assert!(
        text(&work).contains("results of two programs are not mixed"),
        "{}",
        text(&work)
    );
}
