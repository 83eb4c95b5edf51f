//! What a person writes, and what names a point.

use super::*;

#[test]
fn a_point_is_named_by_all_that_determines_it() {
    let base = plan(GRID);
    let ids = |plan: &Plan| plan.points().into_iter().map(|point| point.id).collect::<Vec<_>>();
    let first = ids(&base);
    let mut unique = first.clone();
    unique.sort();
    unique.dedup();
    assert_eq!(unique.len(), 40);
    let changed = |change: &dyn Fn(&mut Plan)| {
        let mut plan = base.clone();
        change(&mut plan);
        ids(&plan)
    };
    for (what, other) in [
        ("program", changed(&|plan| plan.runs.program.push('1'))),
        (
            "arithmetic",
            changed(&|plan| plan.runs.arithmetic = "portable".to_owned()),
        ),
        ("configuration", changed(&|plan| plan.runs.hash = "1".repeat(64))),
        ("horizon", changed(&|plan| plan.runs.horizon = 20.000_000_1)),
        ("members", changed(&|plan| plan.runs.members = 4)),
        ("run_all", changed(&|plan| plan.runs.run_all = true)),
        (
            "fast",
            changed(&|plan| {
                plan.runs.fast = Some(Fast {
                    first_alarm: Priority::Low,
                    calm_after: 20.0,
                    limit: 0.1,
                    turns: 3,
                });
            }),
        ),
        ("plausible", changed(&|plan| plan.runs.plausible = true)),
    ] {
        assert!(first.iter().all(|id| !other.contains(id)), "{what}");
    }
    // What a start from rest does not need does not change it.
    let other = changed(&|plan| plan.runs.running.time = 11.0);
    for ((a, b), point) in first.iter().zip(&other).zip(base.points()) {
        assert_eq!(a == b, point.start == Start::Rest);
    }
}

#[test]
fn specifications_are_refused_with_file_line_key_and_bound() {
    for (text, said) in [
        ("horizon: 20\n", "configuration"),
        (
            "configuration: a\nhorizon: 5\ngrid: {a.b: [1]}\n",
            "spec.yaml:2: horizon = 5 s: must be",
        ),
        ("configuration: a\nmembers: 500\ngrid: {a.b: [1]}\n", "members = 500"),
        ("configuration: a\n", "exactly one of them"),
        (
            "configuration: a\ngrid: {a.b: [1]}\nlist: [{a.b: 1}]\n",
            "exactly one of them",
        ),
        (
            "configuration: a\ngrid: {a.b: {from: 1, to: 0, count: 3}}\n",
            "from a smaller to a larger",
        ),
        (
            "configuration: a\ngrid: {a.b: {from: 1, to: 2, count: 3, by: 1}}\n",
            "of `from`, `to` and `count` only",
        ),
        ("configuration: a\ngrid: {a.b: [[1]]}\n", "grid.a.b"),
        (
            "configuration: a\nlist: [{a.b: 1}, {a.c: 1}]\n",
            "of the same keys as the first point",
        ),
        (
            "configuration: a\nlatin_hypercube: {points: 3, ranges: {a.b: [2, 1]}}\n",
            "two numbers, the smaller first",
        ),
        (
            "configuration: a\nlatin_hypercube: {points: 0, ranges: {a.b: [1, 2]}}\n",
            "latin_hypercube.points = 0",
        ),
        (
            "configuration: a\ngrid: {a: {from: 0, to: 1, count: 1000}, b: {from: 0, to: 1, count: 1000}}\n",
            "at most 200000",
        ),
        ("configuration: a\nspeed: 3\n", "spec.yaml:2"),
        ("configuration: a\nstarts: [sliding]\ngrid: {a.b: [1]}\n", "spec.yaml:2"),
    ] {
        let error = Spec::from_text("spec.yaml", text).unwrap_err().to_string();
        assert!(error.contains(said), "{text}{error}");
    }
    for (from, to, said) in [
        ("to: 120", "to: 130", "row 9 of the values"),
        (
            "contact.inner.friction_tangential",
            "contact.inner.friction",
            "row 1 of the values",
        ),
        ("[0.1, ", "[-0.1, ", "contact.inner.friction_tangential = -0.1"),
        (
            "horizon: 20",
            "horizon: 20\nrunning: {rpm: 200}",
            "running.rpm = 200: must be within inputs.rotary_speed",
        ),
    ] {
        let spec = Spec::from_text("spec.yaml", &GRID.replace(from, to)).unwrap();
        let error = spec
            .plan_for("spec.yaml", &config(), &program())
            .unwrap_err()
            .to_string();
        assert!(error.contains(said), "{to}: {error}");
    }
}

#[test]
fn lists_and_hypercubes_give_the_values() {
    let list =
        plan("configuration: a\nlist:\n- {tool.links: 20, rock.law: paper}\n- {rock.law: paper, tool.links: 30}\n");
    assert_eq!(
        serde_json::to_string(&list.rows).unwrap(),
        r#"[[20,"paper"],[30,"paper"]]"#
    );
    let text = "configuration: a\nlatin_hypercube:\n  points: 50\n  seed: 4\n  ranges:\n    \
                contact.inner.friction_tangential: [0.1, 0.6]\n    tool.links: [20, 40]\n";
    let cube = plan(text);
    assert_eq!(cube.rows, plan(text).rows);
    assert_ne!(cube.rows, plan(&text.replace("seed: 4", "seed: 5")).rows);
    // One value in each fiftieth of the range; links are whole.
    let mut parts: Vec<usize> = cube
        .rows
        .iter()
        .map(|row| ((row[0].as_f64().unwrap() - 0.1) / 0.01).floor() as usize)
        .collect();
    parts.sort_unstable();
    assert_eq!(parts, (0..50).collect::<Vec<_>>());
    assert!(
        cube.rows
            .iter()
            .all(|row| (20..=40).contains(&row[1].as_u64().unwrap()))
    );
}
