//! `flexdrill sweep` and `flexdrill map` on the short tool of the tests: the same bytes with any number of threads, killed
//! workers and interruptions, and refusals in words.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use flexdrill::ahead::keep_priority;
use flexdrill::map::point;
use flexdrill::map::study::{self, Question};
use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_sweep::map::{Map, Origin, ROTARY_SPEED, Verdict, WEIGHT_ON_BIT};
use flexdrill_sweep::{Directory, Outcome};
use flexdrill_uncertainty::{Channel, Priors};

fn flexdrill(arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
    command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .arg(folder);
    command
}

fn text(output: &Output) -> String {
    [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes))
        .concat()
}

fn run(arguments: &[&str], folder: &Path, more: &[&str]) -> String {
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
    let map = flexdrill(&MAP, &path).args(SMALL).output().unwrap();
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

const MAP: [&str; 5] = ["map", "tests/data/small.yaml", "--rpm", "30:110", "--out"];
const SMALL: [&str; 8] = ["--wob", "1:9", "--grid", "3x3", "--horizon", "10", "--members", "2"];

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
    // The picture has both classes in words, and no clear cell.
    let picture = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    let has = |words: &str| picture.contains(&format!(">{words}<")) || picture.contains(words);
    assert!(has("not known") && has("a run failed") && !has("clear"), "the legend");
    let page = std::fs::read_to_string(folder.path().join("map.html")).unwrap();
    assert!(page.contains("cells are not known") && page.contains("No member of any run ended."));
}

/// The members of one run of the short tool in calm drilling, of at most seven, and what the map says of them.
fn members(run_all: bool) -> (u32, u32) {
    keep_priority();
    let config = Config::load("tests/data/small.yaml").unwrap();
    let question = Question {
        axes: [
            (ROTARY_SPEED.to_owned(), vec![40.0, 60.0]),
            (WEIGHT_ON_BIT.to_owned(), vec![2.0, 4.0]),
        ],
        horizon: 10.0,
        members: 7,
        run_all,
        first_alarm: false,
        plausible: false,
        seed: 1,
        running_rpm: None,
        running_time: 1.0,
        priority: Priority::Low,
        limit: 0.1,
        share: 1.0,
    };
    let plan = study::plan("small.yaml", &config, &question).unwrap();
    let point = &plan.points()[0];
    let outcome = point::run(&plan, &config, point, &Arc::default(), &AtomicBool::new(false)).unwrap();
    assert_eq!((outcome.any_alarm, outcome.failed), ([0; 3], 0), "{outcome:?}");
    (outcome.members, outcome.ended())
}

#[test]
fn all_members_run_where_that_is_asked_for() {
    // Six without any alarm decide: a chance of a tenth or less, against one of a half or more.
    assert_eq!(members(false), (6, 6));
    assert_eq!(members(true), (7, 7));
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

/// What is not known of the short tool in the test below.
const NOT_KNOWN: &str = "
uncertainty:
  keys:
    - key: contact.outer.friction_tangential
      also: [contact.outer.friction_axial]
      distribution: {uniform: {low: 0.05, high: 0.6}}
      source: test
  sensors: {weight_indicator: {factor_error: 0.2, tare_range_kn: 1.0}}
";

/// A question for one point of a tool: 40 r/min, 6 kN from rest.
fn one_point(config: &Config, members: u32, plausible: bool, first_alarm: bool) -> Outcome {
    // As `flexdrill map` does: idle work would not come to an end on a busy machine.
    keep_priority();
    let question = Question {
        axes: [
            (ROTARY_SPEED.to_owned(), vec![40.0, 60.0]),
            (WEIGHT_ON_BIT.to_owned(), vec![6.0, 8.0]),
        ],
        horizon: 10.0,
        members,
        run_all: true,
        first_alarm,
        plausible,
        seed: 5,
        running_rpm: None,
        running_time: 1.0,
        priority: Priority::Low,
        limit: 0.1,
        share: 1.0,
    };
    let plan = study::plan("small.yaml", config, &question).unwrap();
    point::run(
        &plan,
        config,
        &plan.points()[0],
        &Arc::default(),
        &AtomicBool::new(false),
    )
    .unwrap()
}

fn median(outcome: &Outcome, figure: &str) -> f64 {
    let figure = outcome.figures.iter().find(|of| of.name == figure).unwrap();
    figure.quantiles.unwrap()[1]
}

/// The members of a map over plausible tools are the draws of the priors: the median of three is the middle one of three
/// runs whose configurations have the drawn friction, under the weight that the drawn indicator shows as 6 kN.
#[test]
fn a_map_over_plausible_tools_runs_the_draws() {
    let text = std::fs::read_to_string("tests/data/small.yaml").unwrap();
    let config = Config::from_text("small.yaml", &(text + NOT_KNOWN)).unwrap();
    let together = one_point(&config, 3, true, false);
    assert_eq!((together.members, together.failed), (3, 0), "{}", together.failure);
    let priors = Priors::of(&config).unwrap();
    let mut single: Vec<f64> = (0..3)
        .map(|number| {
            let drawn = priors.member(5, number).unwrap();
            let error = drawn
                .sensors
                .iter()
                .find(|of| of.channel == Channel::WeightIndicator)
                .unwrap();
            let acts = (6.0 - error.tare / 1e3) / error.factor;
            let plain = &drawn.config;
            let question = Question {
                axes: [
                    (ROTARY_SPEED.to_owned(), vec![40.0, 60.0]),
                    (WEIGHT_ON_BIT.to_owned(), vec![acts, 9.0]),
                ],
                horizon: 10.0,
                members: 1,
                run_all: true,
                first_alarm: false,
                plausible: false,
                seed: 5,
                running_rpm: None,
                running_time: 1.0,
                priority: Priority::Low,
                limit: 0.1,
                share: 1.0,
            };
            let plan = study::plan("drawn.yaml", plain, &question).unwrap();
            let outcome = point::run(
                &plan,
                plain,
                &plan.points()[0],
                &Arc::default(),
                &AtomicBool::new(false),
            )
            .unwrap();
            median(&outcome, "guide_wall_force")
        })
        .collect();
    single.sort_by(f64::total_cmp);
    let [least, middle, most] = single[..] else { panic!() };
    // The draws part the force by tens of percent. The disturbances of members, other ones here, and slew limits that the
    // indicator scales move its largest value of ten seconds by less than a twentieth.
    assert!(most > 1.1 * least, "{single:?}");
    let found = median(&together, "guide_wall_force");
    assert!((found / middle - 1.0).abs() < 0.05, "{found} against {single:?}");
}

/// Where an alarm is sure to come a member ends with it, and has no figures of the time behind.
#[test]
fn a_member_may_end_with_its_first_alarm() {
    let text = std::fs::read_to_string("tests/data/small.yaml").unwrap();
    // Any swing of the bit's speed is stick-slip.
    let sure = "\nstick_slip: {levels: {watch: 1.0e-6, warning: 0.9, critical: 1.0}}\n";
    let config = Config::from_text("small.yaml", &(text + sure)).unwrap();
    let alarming = |first_alarm| one_point(&config, 4, false, first_alarm);
    let (whole, short) = (alarming(false), alarming(true));
    assert_eq!((whole.any_alarm[0], short.any_alarm[0]), (4, 4), "{whole:?}");
    assert!(whole.figures.iter().any(|figure| figure.quantiles.is_some()));
    assert!(short.figures.iter().all(|figure| figure.quantiles.is_none()));
    let first = |outcome: &Outcome| {
        outcome
            .alarms
            .iter()
            .filter_map(|count| count.first)
            .fold(f64::INFINITY, f64::min)
    };
    assert_eq!(first(&whole), first(&short));
}

/// The map that is fast: states made once per weight, members that end with their first alarm, cells that a part of their members
/// decide. Its cells are those of a full grid of fresh runs, in which every member of every cell makes its own way from
/// rest and runs over the whole horizon.
#[test]
fn the_cells_of_a_fast_map_are_those_of_fresh_full_runs() {
    keep_priority();
    let text = std::fs::read_to_string("tests/data/small.yaml").unwrap();
    // A level amid the swings of the bit's speed over the grid, so that some cells have alarms and some have none.
    let level = |watch: f64| {
        let levels = format!("levels: {{watch: {watch}, warning: 8.0, critical: 9.0}}");
        let levels = format!("\nstick_slip: {{window: 2.0, hysteresis: 1.0e-9, hold_off: 0.0, {levels}}}\n");
        Config::from_text("small.yaml", &(text.clone() + &levels)).unwrap()
    };
    let question = |fast: bool| Question {
        axes: [
            (ROTARY_SPEED.to_owned(), vec![20.0, 40.0, 50.0]),
            (WEIGHT_ON_BIT.to_owned(), vec![2.0, 8.0]),
        ],
        horizon: 10.0,
        members: 3,
        run_all: !fast,
        first_alarm: fast,
        plausible: false,
        seed: 5,
        running_rpm: Some(50.0),
        running_time: 1.0,
        priority: Priority::Low,
        limit: 0.4,
        share: 1.0,
    };
    let outcomes = |config: &Config, fast: bool| -> Vec<Outcome> {
        let plan = study::plan("small.yaml", config, &question(fast)).unwrap();
        let shared = Arc::default();
        let run = |point: &_| {
            let fresh = Arc::default();
            let states = if fast { &shared } else { &fresh };
            point::run(&plan, config, point, states, &AtomicBool::new(false)).unwrap()
        };
        plan.points().iter().map(run).collect()
    };
    // The swing of a cell is the median of its members' means over the horizon, by runs without any alarm.
    let calm = outcomes(&level(7.0), false);
    let mut swings: Vec<f64> = calm.iter().map(|outcome| median(outcome, "bit_speed_ripple")).collect();
    swings.sort_by(f64::total_cmp);
    let config = level(swings[swings.len() / 2]);
    let (full, fast) = (outcomes(&config, false), outcomes(&config, true));
    let class = |outcome: &Outcome, fast| study::class(outcome, &question(fast));
    let classes: Vec<_> = full.iter().map(|outcome| class(outcome, false)).collect();
    assert!(
        classes.iter().any(|class| *class != classes[0]),
        "{swings:?} {classes:?}"
    );
    for (point, ((full, fast), expected)) in full.iter().zip(&fast).zip(&classes).enumerate() {
        assert_eq!(class(fast, true), *expected, "point {point}: {full:?} {fast:?}");
        // A cell with alarms ends with two members that saw one, which fresh runs of all three saw too.
        assert!(fast.members <= full.members);
        assert_eq!((full.members, full.failed, fast.failed), (3, 0, 0));
    }
    assert!(
        fast.iter().any(|outcome| outcome.members == 2),
        "no cell was decided early"
    );
}

/// States that are made once for all cells of a weight change no digit of an outcome, also where members are plausible tools.
#[test]
fn shared_states_change_no_digit_of_a_point() {
    keep_priority();
    let text = std::fs::read_to_string("tests/data/small.yaml").unwrap();
    let config = Config::from_text("small.yaml", &(text + NOT_KNOWN)).unwrap();
    for plausible in [false, true] {
        let question = Question {
            axes: [
                (ROTARY_SPEED.to_owned(), vec![40.0, 50.0]),
                (WEIGHT_ON_BIT.to_owned(), vec![4.0, 6.0]),
            ],
            horizon: 10.0,
            members: 2,
            run_all: true,
            first_alarm: false,
            plausible,
            seed: 5,
            running_rpm: Some(50.0),
            running_time: 1.0,
            priority: Priority::Low,
            limit: 0.1,
            share: 1.0,
        };
        let plan = study::plan("small.yaml", &config, &question).unwrap();
        let shared = Arc::default();
        for point in plan.points() {
            let [with, fresh] = [&shared, &Arc::default()]
                .map(|states| point::run(&plan, &config, &point, states, &AtomicBool::new(false)).unwrap());
            assert_eq!(with, fresh, "{plausible} {point:?}");
        }
    }
}
