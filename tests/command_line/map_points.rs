//! Points and cells of maps, computed in this process with the short tool of the tests.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use flexdrill::ahead::keep_priority;
use flexdrill::map::point;
use flexdrill::map::shared::Shared;
use flexdrill::map::study::{self, Question, Study};
use flexdrill_alarms::Priority;
use flexdrill_config::Config;
use flexdrill_sweep::Outcome;
use flexdrill_sweep::choice::Class;
use flexdrill_sweep::map::{ROTARY_SPEED, WEIGHT_ON_BIT};
use flexdrill_uncertainty::posterior::{Provenance, to_csv};
use flexdrill_uncertainty::{Channel, Posterior, Priors};

/// A question over speeds (r/min) and weights (kN), of a member that runs for 10 s whatever its alarms.
fn asked(speeds: Vec<f64>, weights: Vec<f64>) -> Question {
    Question {
        axes: [(ROTARY_SPEED.to_owned(), speeds), (WEIGHT_ON_BIT.to_owned(), weights)],
        horizon: 10.0,
        members: 1,
        run_all: true,
        fast: false,
        plausible: false,
        seed: 5,
        running_rpm: None,
        running_time: 1.0,
        priority: Priority::Low,
        limit: 0.1,
        share: 1.0,
    }
}

/// The members of one run of the short tool in calm drilling, of at most seven, and what the map says of them.
fn members(run_all: bool) -> (u32, u32) {
    keep_priority();
    let config = Config::load("tests/data/small.yaml").unwrap();
    let question = Question {
        members: 7,
        run_all,
        seed: 1,
        ..asked(vec![40.0, 60.0], vec![2.0, 4.0])
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
fn one_point(config: &Config, members: u32, plausible: bool, fast: bool) -> Outcome {
    point_of(config, members, plausible, fast, &Arc::default())
}

/// The same with what its members are drawn from.
fn point_of(config: &Config, members: u32, plausible: bool, fast: bool, shared: &Arc<Shared>) -> Outcome {
    // As `flexdrill map` does: idle work would not come to an end on a busy machine.
    keep_priority();
    let question = Question {
        members,
        fast,
        plausible,
        ..asked(vec![40.0, 60.0], vec![6.0, 8.0])
    };
    let plan = study::plan("small.yaml", config, &question).unwrap();
    point::run(&plan, config, &plan.points()[0], shared, &AtomicBool::new(false)).unwrap()
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
                ..asked(vec![40.0, 60.0], vec![acts, 9.0])
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
        members: 3,
        run_all: !fast,
        fast,
        running_rpm: Some(50.0),
        limit: 0.4,
        ..asked(vec![20.0, 40.0, 50.0], vec![2.0, 8.0])
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
    // The map, which looks first, has the same classes from fewer members.
    let folder = tempfile::tempdir().unwrap();
    let (outcomes_of_fast, fast) = (fast, question(true));
    let plan = study::plan("small.yaml", &config, &fast).unwrap();
    let stop = AtomicBool::new(false);
    let study = Study {
        config: &config,
        question: &fast,
        shared: &Arc::default(),
    };
    let map = study::make(folder.path(), &plan, study, 2, &stop, |_| ());
    let map = map.unwrap().unwrap();
    let starts = map.cells.iter().flat_map(|cell| &cell.starts);
    let found: Vec<bool> = starts.clone().map(|start| start.expected).collect();
    let wanted: Vec<bool> = classes.iter().map(|class| *class == Class::Expected).collect();
    assert_eq!(found, wanted, "{map:?}");
    // A run that begins with its look is the run of all members at once.
    for (of, point) in starts.clone().zip(&outcomes_of_fast) {
        assert!(of.members == 1 || of.alarms == point.alarms, "{of:?} {point:?}");
        // A figure that was read from its file may be off by a rounding.
        let pairs = of.figures.iter().zip(&point.figures);
        let mut values =
            pairs.flat_map(|(a, b)| a.quantiles.into_iter().flatten().zip(b.quantiles.into_iter().flatten()));
        assert!(
            of.members == 1 || values.all(|(a, b)| (a - b).abs() <= 1e-14 * a.abs()),
            "{of:?} {point:?}"
        );
    }
    let members: u32 = starts.map(|start| start.members).sum();
    assert!(members < full.iter().map(|outcome| outcome.members).sum());
    let spent: f64 = full.iter().map(|outcome| outcome.model_time).sum();
    assert!(
        map.model_time > 0.0 && map.model_time < spent,
        "{} {spent}",
        map.model_time
    );
}

/// A fast member ends after 30 s of a calm motion, and its alarms are those of the whole horizon.
#[test]
fn a_calm_member_ends_early() {
    keep_priority();
    let config = Config::load("tests/data/small.yaml").unwrap();
    let outcome = |fast: bool| {
        let question = Question {
            horizon: 45.0,
            run_all: false,
            fast,
            seed: 1,
            ..asked(vec![40.0, 60.0], vec![2.0, 4.0])
        };
        let plan = study::plan("small.yaml", &config, &question).unwrap();
        let stop = AtomicBool::new(false);
        point::run(&plan, &config, &plan.points()[0], &Arc::default(), &stop).unwrap()
    };
    let (whole, fast) = (outcome(false), outcome(true));
    assert_eq!((whole.any_alarm, fast.any_alarm), ([0; 3], [0; 3]));
    // To a tenth of a second, as a member is looked at.
    let saved = whole.model_time - fast.model_time;
    assert!((saved - 15.0).abs() < 0.2, "{whole:?} {fast:?}");
}

/// The friction of a map's tools is that of the calibration's sample, not that of the prior.
#[test]
fn a_map_draws_from_the_sample_that_the_configuration_names() {
    keep_priority();
    const KEYS: [&str; 2] = ["contact.outer.friction_tangential", "contact.outer.friction_axial"];
    let text = std::fs::read_to_string("tests/data/small.yaml").unwrap();
    let (drawn, _) = NOT_KNOWN.split_once("  sensors").unwrap();
    let config = Config::from_text("small.yaml", &(text + drawn)).unwrap();
    let provenance = Provenance {
        tool: config.tool_hash(KEYS),
        ..Provenance::default()
    };
    let forces = [0.1, 0.55].map(|friction| {
        let rows: Vec<[f64; 2]> = (0..20).map(|row| [friction + 1e-4 * f64::from(row); 2]).collect();
        let csv = to_csv(&provenance, &KEYS, rows.iter().map(|row| (1.0, row.as_slice())));
        let sample = Posterior::from_csv("sample.csv", csv.as_bytes()).unwrap();
        sample.belongs_to(&config).unwrap();
        let of_sample = point_of(&config, 3, true, false, &Arc::new(Shared::with(Some(sample))));
        let plain = config
            .with_values("test", KEYS.map(|key| (key, friction + 1e-3)))
            .unwrap();
        let [found, own] = [of_sample, one_point(&plain, 3, false, false)].map(|of| median(&of, "guide_wall_force"));
        // As in the test above: disturbances move the largest value of ten seconds by less than a twentieth.
        assert!((found / own - 1.0).abs() < 0.05, "{friction}: {found} {own}");
        found
    });
    assert!((forces[0] / forces[1] - 1.0).abs() > 0.1, "{forces:?}");
}

/// States that are made once for all cells of a weight change no digit of an outcome, also where members are plausible tools.
#[test]
fn shared_states_change_no_digit_of_a_point() {
    keep_priority();
    let text = std::fs::read_to_string("tests/data/small.yaml").unwrap();
    let config = Config::from_text("small.yaml", &(text + NOT_KNOWN)).unwrap();
    for plausible in [false, true] {
        let question = Question {
            members: 2,
            plausible,
            running_rpm: Some(50.0),
            ..asked(vec![40.0, 50.0], vec![4.0, 6.0])
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
