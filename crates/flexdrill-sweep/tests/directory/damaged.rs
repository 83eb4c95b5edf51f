//! What is damaged or refused is named and left alone.

use super::*;

#[test]
fn damaged_points_are_named_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &all(&directory), 1).unwrap();
    let file = |number: usize| directory.file(&directory.points()[number]);
    let good = std::fs::read(file(0)).unwrap();
    let flipped = |at: usize| {
        let mut bytes = good.clone();
        bytes[at] ^= 1;
        bytes
    };
    for bytes in [
        vec![],
        good[..good.len() - 1].to_vec(),
        flipped(10),
        flipped(good.len() - 5),
        vec![b'x'; 1 << 19],
    ] {
        std::fs::write(file(0), &bytes).unwrap();
        assert!(matches!(
            directory.find(&directory.points()[0]).unwrap(),
            Found::Damaged(_)
        ));
    }
    // The result of another point under this one's name.
    std::fs::copy(file(1), file(0)).unwrap();
    std::fs::remove_file(file(2)).unwrap();
    let error = work(&directory, &all(&directory), 2).unwrap_err().to_string();
    assert!(error.contains(&file(0).display().to_string()), "{error}");
    assert!(
        error.contains("the result of another point") && error.contains("left alone"),
        "{error}"
    );
    // The others were computed, and the file is as it was.
    assert!(directory.has_file(&directory.points()[2]));
    assert_eq!(std::fs::read(file(0)).unwrap(), std::fs::read(file(1)).unwrap());
    let status = directory.status().unwrap();
    assert_eq!((status.done, status.damaged.len(), status.missing()), (39, 1, 0));
    assert!(directory.collect(true).unwrap_err().to_string().contains("damaged"));
    std::fs::remove_file(file(0)).unwrap();
    assert_eq!(work(&directory, &all(&directory), 1).unwrap(), 1);
    assert_eq!(std::fs::read(file(0)).unwrap(), good);
    // What killed workers leave, and what is no point, is counted and not read.
    std::fs::write(file(0).parent().unwrap().join(".part-abc"), "{").unwrap();
    std::fs::write(file(0).parent().unwrap().join("else.jsonl"), "{").unwrap();
    let status = directory.status().unwrap();
    assert_eq!((status.done, status.unfinished, status.foreign), (40, 1, 1));
    directory.collect(false).unwrap();
}

/// Another user of a shared directory may have put them there.
#[test]
fn pipes_and_links_are_named_and_not_followed() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &all(&directory), 1).unwrap();
    let file = |number: usize| directory.file(&directory.points()[number]);
    std::fs::remove_file(file(0)).unwrap();
    let made = std::process::Command::new("mkfifo").arg(file(0)).status().unwrap();
    assert!(made.success());
    std::fs::rename(file(1), elsewhere.path().join("result")).unwrap();
    symlink(elsewhere.path().join("result"), file(1)).unwrap();
    let status = directory.status().unwrap();
    let damaged: Vec<String> = status.damaged.iter().map(|(_, damage)| damage.to_string()).collect();
    assert_eq!(damaged, ["it is no regular file"; 2]);
    assert!(directory.collect(true).is_err());
    assert!(work(&directory, &all(&directory), 1).is_err());
    // A plan that is a pipe does not hang either.
    let other = tempfile::tempdir().unwrap();
    let pipe = other.path().join(PLAN);
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    assert!(Directory::open(other.path()).is_err());
    // All results elsewhere.
    std::fs::rename(folder.path().join("points"), elsewhere.path().join("points")).unwrap();
    symlink(elsewhere.path().join("points"), folder.path().join("points")).unwrap();
    for refused in [
        directory.status().err(),
        directory.collect(true).err(),
        work(&directory, &all(&directory), 1).err(),
        directory
            .put(&directory.points()[0], &made_up(&directory.points()[0]))
            .err(),
    ] {
        let text = refused.unwrap().to_string();
        assert!(text.contains("points: is a link"), "{text}");
    }
}

#[test]
fn a_foreign_failure_is_text_in_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    let point = &directory.points()[0];
    let mut outcome = made_up(point);
    outcome.failure = "=HYPERLINK(\"http://x\")\x1b[2J\u{202e}".to_owned();
    directory.put(point, &outcome).unwrap();
    let table = String::from_utf8(directory.collect(true).unwrap()).unwrap();
    assert!(
        table.contains("'=HYPERLINK") && table.contains("\\u{1b}[2J\\u{202e}"),
        "{table}"
    );
    assert!(!table.contains(['\x1b', '\u{202e}']));
}

#[test]
fn a_disk_that_refuses_a_write_costs_no_result() {
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path(), &plan(GRID)).unwrap();
    work(&directory, &[0, 1, 2, 3], 1).unwrap();
    // A file where a folder of points must be.
    let blocked = directory
        .points()
        .iter()
        .find(|point| !directory.file(point).parent().unwrap().exists())
        .unwrap();
    std::fs::write(directory.file(blocked).parent().unwrap(), "").unwrap();
    let error = work(&directory, &all(&directory), 2).unwrap_err().to_string();
    assert!(error.contains("cannot be"), "{error}");
    std::fs::remove_file(directory.file(blocked).parent().unwrap()).unwrap();
    work(&directory, &all(&directory), 2).unwrap();
    assert_eq!(directory.status().unwrap().done, 40);
}

#[test]
fn damaged_plans_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = Directory::open(folder.path()).unwrap_err().to_string();
    assert!(error.contains("no sweep") && error.contains("sweep plan"), "{error}");
    let path = folder.path().join(PLAN);
    let good = serde_json::to_value(plan(GRID)).unwrap();
    for (pointer, value, said) in [
        ("/format", serde_json::json!(9), "format 9; this program reads format 3"),
        (
            "/runs/horizon",
            serde_json::json!(1e9),
            "horizon = 1000000000: must be 10 to 600 s",
        ),
        ("/runs/members", serde_json::json!(0), "members = 0: must be 1 to 200"),
        ("/rows/3", serde_json::json!([1.0]), "2 values each, one per key"),
        ("/starts", serde_json::json!(["rest", "rest"]), "starts = "),
        ("/seeds", serde_json::json!([]), "seeds = []"),
        ("/keys", serde_json::json!(["a", "a"]), "keys = a: must be given once"),
        (
            "/seeds",
            serde_json::json!((0..20_000).collect::<Vec<u64>>()),
            "points = 400000: must be 1 to 200000",
        ),
    ] {
        let mut tree = good.clone();
        *tree.pointer_mut(pointer).unwrap() = value;
        std::fs::write(&path, tree.to_string()).unwrap();
        let error = Directory::open(folder.path()).unwrap_err().to_string();
        assert!(error.contains(PLAN) && error.contains(said), "{pointer}: {error}");
    }
    for text in ["", "{", "[]", "{\"format\": 3}"] {
        std::fs::write(&path, text).unwrap();
        let error = Directory::open(folder.path()).unwrap_err().to_string();
        assert!(error.contains("not the plan of a sweep, or damaged"), "{error}");
    }
}

#[test]
fn the_python_package_reads_these_formats() {
    let reader = include_str!("../../../flexdrill-python/python/flexdrill/_results_file.py");
    for (name, format) in [
        ("SWEEP_FORMAT", flexdrill_sweep::plan::FORMAT),
        ("MAP_FORMAT", flexdrill_sweep::map::FORMAT),
    ] {
        let line = format!("\n{name} = {format}\n");
        assert!(reader.contains(&line), "{name} of _results_file.py must be {format}");
    }
}
