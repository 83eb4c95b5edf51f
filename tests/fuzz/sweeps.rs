//! Files of sweeps: specification, plan, a point's result, a map; the table of a sensitivity.

use std::path::Path;

use flexdrill::map::program;
use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_sweep::directory::plan_from_bytes;
use flexdrill_sweep::map::{AlarmCount, Axis, Cell, FORMAT, Figure, Map, OfStart, Origin, Start, Verdict};
use flexdrill_sweep::outcome::{self, Begun};
use flexdrill_sweep::{Outcome, Plan, Spec};
use flexdrill_uncertainty::Effects;

use crate::engine::Target;
use crate::{file, says_why};

const JSON: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "null",
    "true",
    "false",
    "1e308",
    "1e999",
    "-0.0",
    "-1",
    "0.5",
    "1e-320",
    "18446744073709551616",
    "\\u0000",
    "\\ud800",
    "\n",
    "[[[[[[[[",
    "{\"a\":{\"a\":{\"a\":",
];

const SPEC: &str = "configuration: coarse.yaml\nhorizon: 20\nseeds: [7, 3]\nrunning: {rpm: 100, time: 3}\n";
const GRID: &str = "grid:\n  inputs.rotary_speed.initial_rpm: {from: 20, to: 120, count: 5}\n  tool.links: [20, 30]\n";
const LIST: &str = "starts: [rest]\nlist:\n- {tool.links: 20, rock.law: paper}\n- {tool.links: 30, rock.law: paper}\n";
const CUBE: &str = "members: 5\nlatin_hypercube: {points: 9, seed: 2, ranges: {contact.slip_speed: [0.01, 0.02]}}\n";

fn config() -> Config {
    Config::from_text("coarse.yaml", &String::from_utf8(file("config/coarse.yaml")).unwrap()).unwrap()
}

fn plan() -> Plan {
    let spec = Spec::from_text("spec.yaml", &format!("{SPEC}{GRID}")).unwrap();
    spec.plan_for("spec.yaml", &config(), &program()).unwrap()
}

fn result(plan: &Plan) -> Outcome {
    let figure = |(name, unit): &(String, String)| Figure {
        name: name.clone(),
        unit: unit.clone(),
        quantiles: Some([0.1, 0.2, 1e5]),
    };
    Outcome {
        members: 3,
        failed: 1,
        failure: "a step failed".to_owned(),
        run_up: Some(2.5),
        model_time: 31.5,
        begun: vec![Begun {
            tool: Some(2),
            time: 13.5,
        }],
        any_alarm: [1, 1, 0],
        alarms: vec![AlarmCount {
            alarm: "shock".to_owned(),
            priority: Priority::Medium,
            seen: 1,
            of: 2,
            interval: [0.1, 0.9],
            first: Some(6.5),
        }],
        figures: plan.runs.figures.iter().map(figure).collect(),
        quality: [1, 1, 0],
    }
}

#[test]
fn sweep_specification() {
    let config = config();
    let program = program();
    Target {
        name: "sweep_specification",
        seeds: [GRID, LIST, CUBE]
            .map(|values| format!("{SPEC}{values}").into_bytes())
            .to_vec(),
        words: &[
            "from: ",
            "to: ",
            "count: ",
            "- ",
            "{",
            "}",
            "[",
            "]",
            ": ",
            "1e308",
            ".nan",
            "*a",
            "&a ",
            "grid:\n",
            "tool.links",
            "200000",
            "-1",
        ],
        run: &mut |bytes| {
            let spec = match Spec::from_text("fuzz.yaml", &String::from_utf8_lossy(bytes)) {
                Ok(spec) => spec,
                Err(error) => return says_why(&error),
            };
            // Every row is held against the schema, which takes a while: thousands of them are a plan's work.
            let rows = spec.latin_hypercube.as_ref().map_or(0, |cube| cube.points) + spec.list.len();
            let text = String::from_utf8_lossy(bytes);
            if rows > 50 || (text.contains("count") && text.bytes().filter(u8::is_ascii_digit).count() > 60) {
                return true;
            }
            match spec.plan_for("fuzz.yaml", &config, &program) {
                Ok(plan) => {
                    assert!(plan.problem().is_none());
                    assert_eq!(plan.points().len(), plan.len());
                    true
                }
                Err(error) => says_why(&error),
            }
        },
    }
    .fuzz();
}

#[test]
fn sweep_plan() {
    let plan = plan();
    Target {
        name: "sweep_plan",
        seeds: vec![serde_json::to_vec(&plan).unwrap()],
        words: JSON,
        run: &mut |bytes| match plan_from_bytes(Path::new("sweep.json"), bytes) {
            Ok(plan) => {
                let points = plan.points();
                assert_eq!(points.len(), plan.len());
                let written = serde_json::to_vec(&plan).unwrap();
                // A number may be rounded to its last bit when it is read; the plan that is read again is its own copy.
                let again = plan_from_bytes(Path::new("again.json"), &written).unwrap();
                assert_eq!(again.len(), plan.len());
                true
            }
            Err(error) => says_why(&error),
        },
    }
    .fuzz();
}

#[test]
fn sweep_point() {
    let plan = plan();
    let point = &plan.points()[3];
    let result = result(&plan);
    Target {
        name: "sweep_point",
        seeds: vec![outcome::to_bytes(&plan, point, &result).unwrap()],
        words: JSON,
        run: &mut |bytes| match outcome::from_bytes(&plan, point, bytes) {
            // The checksum leaves only what was written.
            Ok(found) => {
                assert_eq!(found, result);
                true
            }
            Err(damage) => says_why(&damage),
        },
    }
    .fuzz();
}

#[test]
fn map_file() {
    let plan = plan();
    let outcome = result(&plan);
    let known = OfStart {
        state: Origin::Known,
        expected: true,
        confidence: 1.0,
        chance: Some(0.5),
        interval: [0.1, 0.9],
        alarm: "shock".to_owned(),
        members: 3,
        failed: 1,
        failure: outcome.failure.clone(),
        alarms: outcome.alarms.clone(),
        figures: outcome.figures.clone(),
    };
    let axis = |key: &str| Axis {
        key: key.to_owned(),
        name: key.to_owned(),
        unit: "kN".to_owned(),
        values: vec![1.0, 2.0],
    };
    let at = [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0), (2.0, 2.0)];
    let cell = |(x, y): (f64, f64)| {
        let other = if x > 1.5 {
            OfStart::inferred(true, 0.96)
        } else {
            OfStart::not_known(0.75)
        };
        let starts = vec![known.clone(), other];
        Cell {
            x,
            y,
            verdict: Verdict::of(&starts),
            starts,
        }
    };
    let map = Map {
        format: FORMAT,
        program: "flexdrill".to_owned(),
        title: "a tool".to_owned(),
        configuration: "0".repeat(64),
        motion: "1".repeat(64),
        x: axis("a"),
        y: axis("b"),
        horizon: 30.0,
        members: 3,
        run_all: false,
        first_alarm: false,
        plausible: false,
        posterior: None,
        seed: 1,
        priority: Priority::Low,
        limit: 0.1,
        starts: Start::ALL.to_vec(),
        runs: 4,
        first_looks: 0,
        model_time: 0.0,
        cells: at.map(cell).to_vec(),
    };
    Target {
        name: "map_file",
        seeds: vec![map.to_json().unwrap().into_bytes()],
        words: JSON,
        run: &mut |bytes| match Map::from_bytes("fuzz.json", bytes) {
            Ok(map) => {
                // What is read is drawn and written, whatever it says.
                let again = Map::from_bytes("again.json", map.to_json().unwrap().as_bytes()).unwrap();
                assert_eq!((again.cells.len(), again.runs), (map.cells.len(), map.runs));
                assert!(flexdrill::map::table::words(&map).len() > 2);
                flexdrill::map::table::csv(&map).unwrap();
                true
            }
            Err(error) => says_why(&error),
        },
    }
    .fuzz();
}

const EFFECTS: &str = r#"{"format": 1, "program": "flexdrill 0.2.0", "configuration": "00ff", "rotary_speed_rpm": 40.0,
"weight_on_bit_kn": 10.0, "seconds": 40.0, "outputs": [{"name": "bit_torque", "unit": "N m", "nominal": 92.5, "scatter": 0.5},
{"name": "whirl_ratio", "unit": "", "nominal": null, "scatter": null}], "rows": [
{"key": "a.b", "quantile": 0.05, "value": 0.2, "unit": "", "results": [90.0, null], "cause": ""},
{"key": "a.b", "quantile": 0.95, "value": 0.4, "unit": "", "results": [null, null], "cause": "a step failed"}]}"#;

#[test]
fn effects() {
    Target {
        name: "effects",
        seeds: vec![EFFECTS.into()],
        words: JSON,
        run: &mut |bytes| match Effects::from_json(bytes) {
            Ok(effects) => {
                for key in effects.keys() {
                    assert!(!effects.largest_in_words(key).is_empty());
                }
                for output in 0..effects.outputs.len() {
                    effects.ranked(output);
                }
                let again = Effects::from_json(effects.to_json().unwrap().as_bytes()).unwrap();
                assert_eq!(again.rows.len(), effects.rows.len());
                true
            }
            Err(error) => says_why(&error),
        },
    }
    .fuzz();
}
