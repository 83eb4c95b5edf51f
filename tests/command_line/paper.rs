//! `flexdrill paper` on a small tool: every file is there and reads back, the same inputs give the same bytes, and what
//! a short tool cannot agree with is said.

use std::path::Path;
use std::process::Command;

const FIGURES: [&str; 9] = [
    "fig09_hinge_displacement",
    "fig10_pipe_displacement",
    "fig11_guide_displacement",
    "fig12_pipe_speed",
    "fig13_guide_speed",
    "fig14_pipe_guide_force",
    "fig15_guide_wall_force",
    "fig16_pipe_acceleration",
    "fig17_guide_acceleration",
];

fn paper(out: &Path, more: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["paper", "--config", "tests/data/small.yaml", "--turns", "3", "--out"])
        .arg(out)
        .args(more)
        .output()
        .unwrap()
}

/// Tags of an SVG in order, checked to be closed.
fn check_xml(text: &str) {
    let mut open: Vec<&str> = vec![];
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        let end = start + rest[start..].find('>').unwrap();
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') && !tag.starts_with(['?', '!']) {
            open.push(tag.split_whitespace().next().unwrap());
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn a_run_writes_all_figures_twice_alike() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("a"), folder.path().join("b"));
    let output = paper(&first, &[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(paper(&second, &["--no-step-check"]).status.success());
    for name in FIGURES {
        let read = |folder: &Path, extension: &str| std::fs::read(folder.join(format!("{name}.{extension}"))).unwrap();
        for extension in ["svg", "csv"] {
            assert_eq!(read(&first, extension), read(&second, extension), "{name}.{extension}");
        }
        let svg = String::from_utf8(read(&first, "svg")).unwrap();
        assert!(
            svg.starts_with("<svg width=\"1080\"") && svg.contains("viewBox"),
            "{name}: {:.80}",
            svg
        );
        check_xml(&svg);
        let mut points = 0;
        let mut table = csv::Reader::from_path(first.join(format!("{name}.csv"))).unwrap();
        for row in table.records() {
            let row = row.unwrap();
            assert_eq!(row.len(), 6);
            for column in [3, 5] {
                assert!(row[column].parse::<f64>().unwrap().is_finite());
            }
            points += 1;
        }
        assert!(points > 20, "{name} has {points} points");
    }
    let report = std::fs::read_to_string(first.join("report.md")).unwrap();
    // Seven links at the top of the well cannot reach the paper's place at 88 degrees, and the report says so.
    let line = report.lines().find(|line| line.contains("at 88 degrees")).unwrap();
    assert!(line.contains("| no |"), "{line}");
    for needed in [
        "configuration hash",
        "energy error",
        "half the step",
        env!("CARGO_PKG_VERSION"),
    ] {
        assert!(report.contains(needed), "{needed}");
    }
    let page = std::fs::read_to_string(first.join("report.html")).unwrap();
    assert_eq!(page.matches("<svg").count(), FIGURES.len());
    assert!(
        !page.contains("src=") && !page.contains("href="),
        "the page is not self-contained"
    );
    let findings = std::fs::read_to_string(first.join("findings.csv")).unwrap();
    assert_eq!(findings.lines().count(), 21);
    assert_eq!(findings, std::fs::read_to_string(second.join("findings.csv")).unwrap());
}

#[test]
fn a_run_that_feeds_itself_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    // A bit without torque takes nothing, so the drive's work is small, and a coarse step on stiff contacts is wrong by
    // more than that.
    let output = paper(
        &out,
        &[
            "--no-step-check",
            "--time-step",
            "0.004",
            "--set",
            "contact.inner.stiffness=1e9",
            "--set",
            "contact.outer.stiffness=1e9",
            "--set",
            "contact.inner.damping=0",
            "--set",
            "contact.outer.damping=0",
            "--set",
            "solver.scheme=newmark",
            "--set",
            "solver.gamma=0.5",
            "--set",
            "tool.bit.friction_factor=0.001",
            "--set",
            "contact.inner.friction_tangential=0.01",
        ],
    );
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "{message}");
    assert!(
        message.contains("energy audit failed") || message.contains("step failed"),
        "{message}"
    );
    assert!(!out.join("report.md").exists() && !out.join("fig14_pipe_guide_force.svg").exists());
}
