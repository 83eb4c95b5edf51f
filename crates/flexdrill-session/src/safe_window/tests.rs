use super::*;
use flexdrill_alarms::Priority;
use flexdrill_map::{Axis, Cell, FORMAT, OfStart, Origin, Start};

fn config() -> Config {
    Config::from_text("coarse.yaml", include_str!("../../../../config/coarse.yaml")).unwrap()
}

fn axis(key: &str, values: &[f64]) -> Axis {
    Axis {
        key: key.to_owned(),
        name: key.to_owned(),
        unit: String::new(),
        values: values.to_vec(),
    }
}

fn known(chance: f64, alarm: &str) -> OfStart {
    OfStart {
        state: Origin::Known,
        expected: chance > 0.1,
        confidence: 1.0,
        chance: Some(chance),
        interval: [0.0, 1.0],
        alarm: alarm.to_owned(),
        members: 10,
        ..OfStart::inferred(false, 1.0)
    }
}

/// Speeds of 40, 60 and 80 r/min, weights of 5 and 10 kN: whirl at 80 r/min, from one start at 60 r/min and 10 kN, and a
/// failed run at 40 r/min and 10 kN; at 40 r/min and 5 kN a start is inferred. `turned` has the weight as the first axis.
fn map(config: &Config, turned: bool) -> Map {
    let (speeds, weights) = (
        axis(ROTARY_SPEED, &[40.0, 60.0, 80.0]),
        axis(WEIGHT_ON_BIT, &[5.0, 10.0]),
    );
    let of = |rpm: f64, kn: f64| match (rpm, kn) {
        (80.0, _) => [
            known(0.8, "backward_whirl"),
            OfStart {
                members: 6,
                ..known(0.5, "backward_whirl")
            },
        ],
        (60.0, 10.0) => [known(0.0, ""), known(0.6, "chaotic_whirl")],
        (40.0, 10.0) => [
            known(0.0, ""),
            OfStart {
                state: Origin::Unknown,
                members: 1,
                failed: 1,
                ..OfStart::inferred(false, 0.5)
            },
        ],
        (40.0, _) => [known(0.0, ""), OfStart::inferred(false, 0.96)],
        _ => [known(0.0, ""), known(0.0, "")],
    };
    let (x, y) = if turned { (weights, speeds) } else { (speeds, weights) };
    let mut cells = Vec::new();
    for on_y in &y.values {
        for on_x in &x.values {
            let (rpm, kn) = if turned { (*on_y, *on_x) } else { (*on_x, *on_y) };
            let starts = of(rpm, kn).to_vec();
            cells.push(Cell {
                x: *on_x,
                y: *on_y,
                verdict: Verdict::of(&starts),
                starts,
            });
        }
    }
    Map {
        format: FORMAT,
        program: "flexdrill 0.2.0".to_owned(),
        title: "a test".to_owned(),
        configuration: config.hash(),
        motion: config.motion_hash(),
        x,
        y,
        horizon: 30.0,
        members: 20,
        run_all: false,
        first_alarm: false,
        plausible: false,
        posterior: None,
        seed: 1,
        priority: Priority::Medium,
        limit: 0.1,
        starts: Start::ALL.to_vec(),
        runs: 0,
        first_looks: 0,
        model_time: 0.0,
        cells,
    }
}

#[test]
fn a_point_has_the_verdict_of_its_cell_whichever_axis_is_first() {
    let config = config();
    for turned in [false, true] {
        let window = SafeWindow::new(map(&config, turned), &config, "map.json").unwrap();
        assert_eq!(window.locate(45.0, 6.0), Location::Inside);
        assert_eq!(window.locate(45.0, 9.0), Location::Unknown);
        let Location::Expected(whirl) = window.locate(85.0, 4.0) else {
            panic!("whirl at 80 r/min")
        };
        assert_eq!(
            (whirl.alarm, whirl.chance, whirl.depends),
            ("backward_whirl", Some(0.8), false)
        );
        let Location::Expected(chaotic) = window.locate(60.0, 10.0) else {
            panic!("from one start")
        };
        assert_eq!((chaotic.alarm, chaotic.depends), ("chaotic_whirl", true));
        assert_eq!(window.locate(60.0, 2.0), Location::OffBottom);
        let beyond = |axis, end, unit| Location::Beyond { axis, end, unit };
        assert_eq!(window.locate(91.0, 5.0), beyond("rotary speed", 80.0, "r/min"));
        assert_eq!(window.locate(29.0, 5.0), beyond("rotary speed", 40.0, "r/min"));
        assert_eq!(window.locate(60.0, 13.0), beyond("weight on bit", 10.0, "kN"));
        assert_eq!(window.nearest_inside(85.0, 10.0), Some([60.0, 5.0]));
        let message = window.message(Header::default());
        let [clear, alarm] = [Message::CLEAR, Message::ALARM];
        let second = [Message::UNKNOWN, Message::DEPENDS_ON_START, alarm];
        assert_eq!(message.verdict, [[clear, clear, alarm], second].concat());
        assert_eq!(message.chance[2], 0.8);
        assert_eq!(message.alarm[4], "chaotic_whirl");
        assert_eq!(message.was_run, [true; 6]);
        let ended = [message.members, message.least_members, message.most_members];
        assert_eq!(ended, [20, 6, 10]);
        // A recording of the run has the same map.
        let recorded = SafeWindow::of_recording(message.clone()).unwrap();
        assert_eq!(recorded.message(Header::default()), message);
        for [rpm, kn] in [
            [45.0, 6.0],
            [45.0, 9.0],
            [85.0, 4.0],
            [60.0, 10.0],
            [60.0, 2.0],
            [60.0, 13.0],
        ] {
            assert_eq!(recorded.locate(rpm, kn), window.locate(rpm, kn));
        }
        assert_eq!(recorded.nearest_inside(85.0, 10.0), Some([60.0, 5.0]));
    }
}

#[test]
fn what_is_not_known_is_outside_and_is_never_advised() {
    let config = config();
    let mut map = map(&config, false);
    // At 60 r/min and 5 kN, the nearest clear point, nothing was run and nothing is known.
    let cell = &mut map.cells[1];
    cell.starts[1] = OfStart::not_known(0.9);
    cell.verdict = Verdict::of(&cell.starts);
    let window = SafeWindow::new(map, &config, "map.json").unwrap();
    assert_eq!(window.locate(60.0, 5.0), Location::NotKnown);
    assert_eq!(window.nearest_inside(85.0, 10.0), Some([40.0, 5.0]));
    let message = window.message(Header::default());
    assert_eq!(
        message.verdict[..3],
        [Message::CLEAR, Message::NOT_KNOWN, Message::ALARM]
    );
}

#[test]
fn a_map_of_another_tool_or_over_other_keys_is_refused_in_words() {
    let config = config();
    let other = config.with_value("well.hole_diameter", 0.12).unwrap();
    let refused = |map: Map, config: &Config| SafeWindow::new(map, config, "map.json").unwrap_err().to_string();
    let words = refused(map(&config, false), &other);
    assert!(
        words.contains("map.json: a map of another tool") && words.contains("make the map again"),
        "{words}"
    );
    let renamed = config.with_value("run.title", "the same tool").unwrap();
    assert!(SafeWindow::new(map(&config, false), &renamed, "map.json").is_ok());
    let mut friction = map(&config, false);
    friction.x.key = "contact.inner.friction_tangential".to_owned();
    assert!(refused(friction, &config).contains("over contact.inner.friction_tangential and"));
}

#[test]
fn a_damaged_map_of_a_recording_is_refused_in_words() {
    let config = config();
    let window = SafeWindow::new(map(&config, false), &config, "map.json").unwrap();
    let mut cut = window.message(Header::default());
    cut.alarm.pop();
    let error = SafeWindow::of_recording(cut).unwrap_err().to_string();
    assert!(error.contains("5 values of alarm for 6 cells"), "{error}");
    assert!(SafeWindow::of_recording(Message::default()).is_err());
}

#[test]
fn a_map_that_is_missing_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let named = config().with_value("map.file", "no_such.json").unwrap();
    let error = SafeWindow::of(&named, &folder.path().join("tool.yaml"))
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("map.file: ") && error.contains("no_such.json"),
        "{error}"
    );
    assert_eq!(SafeWindow::of(&config(), Path::new("tool.yaml")).unwrap(), None);
}
