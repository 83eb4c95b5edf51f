//! Lives from run to run: sums, joints that change places, runs that are added twice, and what is refused.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::Config;
use flexdrill_life::{Added, Counted, LifeError, Lives, LivingJoints, Part, RunLife, Verdict, ranked};
use flexdrill_messages::Ageing;
use flexdrill_messages::builtin_interfaces::Time;

const SECOND: i64 = 1_000_000_000;
/// Begin of the first run: 2026-08-01.
const BEGIN: i64 = 1_785_542_400 * SECOND;
const JOINTS: usize = 4;

/// A tool of five links with these serial numbers from the bit up.
fn tool(serials: [&str; JOINTS], life: &str) -> Config {
    let text = format!(
        "well:\n  sections:\n    - arc: {{radius: 3.2, build_angle_deg: 14}}\n  hole_diameter: 0.118\ntool:\n  links: 5\n  \
         pipe: {{outer_diameter: 0.063, inner_diameter: 0.032}}\n  guide: {{outer_diameter: 0.102, inner_diameter: \
         0.080}}\n  joint: {{limit_deg: 6.0, serial_numbers: [{}], life: {{{life}}}}}\n  bit: {{diameter: 0.118}}\n",
        serials.join(", ")
    );
    Config::from_text("tool.yaml", &text).unwrap()
}

/// A run of `seconds` with these sums of counted cycles of the stops and links, from the top down.
fn run(config: &Config, begin: i64, seconds: f64, stop: [f64; JOINTS], link: [f64; JOINTS]) -> RunLife {
    RunLife::of(config, &counted(config, begin, seconds, stop, link), begin).unwrap()
}

fn counted(config: &Config, begin: i64, seconds: f64, stop: [f64; JOINTS], link: [f64; JOINTS]) -> Counted {
    let mut counted = Counted::default();
    assert!(counted.push(&message(config, begin, seconds, stop, link), begin));
    counted
}

fn message(config: &Config, begin: i64, seconds: f64, stop: [f64; JOINTS], link: [f64; JOINTS]) -> Ageing {
    let per_hour = if seconds > 0.0 { 3600.0 / seconds } else { 0.0 };
    let settings = config.simulation().ageing;
    let mut message = Ageing {
        duration: seconds,
        woehler_slope: settings.slope,
        rated_moment: settings.rated_moment,
        stop_damage_rate: stop.map(|sum| sum * per_hour).to_vec(),
        bending_damage_rate: link.map(|sum| sum * per_hour).to_vec(),
        ..Ageing::default()
    };
    message.header.stamp = Time::from_nanoseconds(begin).plus_seconds(seconds);
    message
}

const F1: &str = "class: F1, stress_concentration: 1.5";
const NAMES: [&str; JOINTS] = ["J-1", "J-2", "J-3", "J-4"];

/// Median damage of a unit of the count, 100 N m on a tube of 63 and 32 mm: F1 has 11.222 + 2 * 0.2 and a slope of 3.
fn unit() -> f64 {
    let modulus = std::f64::consts::PI * (0.063f64.powi(4) - 0.032f64.powi(4)) / (32.0 * 0.063);
    (1.5 * 100.0 / modulus / 1e6).powi(3) / 10f64.powf(11.622)
}

fn close(a: f64, b: f64) -> bool {
    // The table has nine digits.
    (a - b).abs() <= 1e-8 * b.abs()
}

#[test]
fn joints_that_change_places_keep_their_lives() {
    let first = tool(NAMES, F1);
    let mut lives = Lives::new("lives.csv", run(&first, BEGIN, 3600.0, [0.0; 4], [0.0; 4]).kind);
    // From the top down: J-4, J-3, J-2, J-1.
    let one = run(&first, BEGIN, 3600.0, [4e6, 3e6, 2e6, 1e6], [0.0, 0.0, 0.0, 9e6]);
    assert_eq!(lives.add(&one, &[], false).unwrap(), Added::New);
    // J-1 and J-4 change places, and J-3 is replaced.
    let second = tool(["J-4", "J-2", "J-5", "J-1"], F1);
    let two = run(&second, BEGIN + 7200 * SECOND, 1800.0, [1e7, 0.0, 0.0, 0.0], [0.0; 4]);
    assert_eq!(lives.add(&two, &["J-5".to_owned()], false).unwrap(), Added::New);
    let joints = lives.ranked();
    let of = |serial: &str| joints.iter().find(|joint| joint.serial == serial).unwrap();
    for (serial, stop, link, places, hours) in [
        ("J-1", 1.1e7, 9e6, &[1, 4][..], 1.5),
        ("J-2", 2e6, 0.0, &[2, 2][..], 1.5),
        ("J-3", 3e6, 0.0, &[3][..], 1.0),
        ("J-4", 4e6, 0.0, &[4, 1][..], 1.5),
        ("J-5", 0.0, 0.0, &[3][..], 0.5),
    ] {
        let joint = of(serial);
        assert!(
            close(joint.stop.median, stop * unit()) && close(joint.link.median, link * unit()),
            "{joint:?}"
        );
        assert_eq!((joint.places.as_slice(), joint.hours), (places, hours), "{serial}");
    }
    let order: Vec<&str> = joints.iter().map(|joint| joint.serial.as_str()).collect();
    assert_eq!(order, ["J-1", "J-4", "J-3", "J-2", "J-5"]);
    // Bands are those of the class: a factor of 10^(1.645 * 0.2) and the cube of the stress concentration's.
    let factor = (1.644_853_627 * (0.2 * 10f64.ln()).hypot(3.0 * 1.04f64.ln().sqrt())).exp();
    assert!((of("J-1").stop.high / of("J-1").stop.median / factor - 1.0).abs() < 1e-8);
    assert_eq!(of("J-1").part, Part::Stop);
    // The text reads back to the same table.
    let text = lives.to_csv();
    let read = Lives::from_csv("lives.csv", text.as_bytes()).unwrap();
    assert_eq!((&read, read.to_csv()), (&lives, text));
}

#[test]
fn a_run_counts_once_however_often_it_is_added() {
    let config = tool(NAMES, F1);
    let part = run(&config, BEGIN, 600.0, [1e5; 4], [2e5; 4]);
    let whole = run(&config, BEGIN, 1800.0, [3e5; 4], [6e5; 4]);
    let mut lives = Lives::new("lives.csv", part.kind.clone());
    assert_eq!(lives.add(&part, &[], false).unwrap(), Added::New);
    assert_eq!(lives.add(&whole, &[], false).unwrap(), Added::Grown);
    let text = lives.to_csv();
    for again in [&whole, &part] {
        assert_eq!(lives.add(again, &[], false).unwrap(), Added::Known);
        assert_eq!(lives.to_csv(), text);
    }
    assert_eq!((lives.runs(), lives.rows.len()), (1, JOINTS));
    assert!(close(lives.ranked()[0].link.median, 6e5 * unit()));
    // Runs that begin with the model's own clock are only known where they are equal.
    let mut own = Lives::new("lives.csv", part.kind.clone());
    let undated = |seconds, sum| run(&config, 0, seconds, [sum; 4], [sum; 4]);
    assert_eq!(own.add(&undated(600.0, 1e5), &[], false).unwrap(), Added::New);
    assert_eq!(own.add(&undated(600.0, 1e5), &[], false).unwrap(), Added::Known);
    let said = own.add(&undated(900.0, 2e5), &[], false).unwrap_err();
    assert!(matches!(said, LifeError::SameBegin { .. }), "{said}");
    assert!(said.to_string().contains("Give each run its own run.title"), "{said}");
}

#[test]
fn what_does_not_belong_is_refused_in_words_and_changes_nothing() {
    let config = tool(NAMES, F1);
    let first = run(&config, BEGIN, 3600.0, [1e5; 4], [1e5; 4]);
    let mut lives = Lives::new("lives.csv", first.kind.clone());
    lives.add(&first, &[], false).unwrap();
    let later = BEGIN + 86_400 * SECOND;
    let known = lives.clone();
    let mut refused = |config: &Config, begin: i64, words: &[&str]| {
        let said = lives.add(&run(config, begin, 3600.0, [1e5; 4], [1e5; 4]), &[], false);
        let said = said.unwrap_err().to_string();
        for words in words {
            assert!(said.contains(words), "{words}: {said}");
        }
        assert_eq!(lives, known);
    };
    let unknown = tool(["J-1", "J-22", "J-3", "K-9"], F1);
    let words = [
        "J-22 (place 2 from the bit), K-9 (place 4 from the bit)",
        "is it J-2?",
        "--new J-22",
    ];
    refused(&unknown, later, &words);
    refused(
        &tool(NAMES, "class: D"),
        later,
        &["class is DNVGL-RP-C203 F1 there, and DNVGL-RP-C203 D in the run"],
    );
    refused(
        &tool(NAMES, "class: F1, environment: air"),
        later,
        &["environment is free_corrosion there"],
    );
    refused(&tool(NAMES, "class: F1"), later, &["other joints: stop is"]);
    // The same hour with another configuration: a joint drills once at a time.
    let other = config.with_value("run.title", "again").unwrap();
    refused(
        &other,
        BEGIN + 1800 * SECOND,
        &["has J-1 in another run at that time", "2026-08-01", "--replace"],
    );
    // The design factor says when to inspect, and nothing of the damages.
    let mut same = lives.clone();
    let careful = tool(NAMES, &format!("{F1}, design_factor: 10"));
    assert_eq!(
        same.add(&run(&careful, later, 60.0, [0.0; 4], [0.0; 4]), &[], false)
            .unwrap(),
        Added::New
    );
    let replaced = lives.add(&run(&other, BEGIN + 1800 * SECOND, 60.0, [0.0; 4], [0.0; 4]), &[], true);
    assert_eq!((replaced.unwrap(), lives.runs()), (Added::New, 1));
}

#[test]
fn a_run_without_a_class_or_names_is_refused_in_words() {
    let config = tool(NAMES, F1);
    let good = counted(&config, BEGIN, 60.0, [0.0; 4], [0.0; 4]);
    let without = |key: &str| {
        let mut schema = (*config).clone();
        match key {
            "life" => schema.tool.joint.life = None,
            _ => schema.tool.joint.serial_numbers.clear(),
        }
        Config::from_schema("tool.yaml", schema).unwrap()
    };
    let said = |config: &Config, counted: &Counted| RunLife::of(config, counted, BEGIN).unwrap_err().to_string();
    assert!(said(&without("life"), &good).contains("no tool.joint.life"));
    assert!(said(&without("serials"), &good).contains("no tool.joint.serial_numbers"));
    assert!(said(&config, &Counted::default()).contains("no twin/ageing with time in it"));
    // A recording that counted with the default slope of 5.
    let old = counted(&without("life"), BEGIN, 60.0, [1.0; 4], [0.0; 4]);
    assert!(said(&config, &old).contains("a slope of 5, and the class in tool.joint.life has 3"));
}

#[test]
fn a_verdict_follows_from_the_band() {
    let config = tool(NAMES, F1);
    let factor = (1.644_853_627 * (0.2 * 10f64.ln()).hypot(3.0 * 1.04f64.ln().sqrt())).exp();
    // Medians on either side of each bound: a life, a life at 95 %, a third of one at 95 %. From the top down.
    let sums = [1.01, 0.99, 1.01 / factor, 0.99 / (3.0 * factor)].map(|damage| damage / unit());
    let counted = counted(&config, BEGIN, 3600.0, [0.0; 4], sums);
    let kind = flexdrill_life::Kind::of(&config).unwrap();
    let joints = ranked(&kind, &counted, &config.tool.joint.serial_numbers).unwrap();
    let found: Vec<_> = joints
        .iter()
        .map(|joint| (joint.serial.as_str(), joint.verdict))
        .collect();
    let expected = [
        ("J-4", Verdict::Expected),
        ("J-3", Verdict::Possible),
        ("J-2", Verdict::Possible),
        ("J-1", Verdict::Sound),
    ];
    assert_eq!(found, expected);
    // An hour made 0.99 / 3 of a life at 95 %: there is room for 2.03 more.
    assert!((joints[3].hours_left.unwrap() - (3.0 / 0.99 - 1.0)).abs() < 1e-6);
    let listed = flexdrill_life::verdict(joints[3].damage, 3.1);
    assert_eq!(listed, Verdict::Listed);
    let unnamed = ranked(&kind, &counted, &[]).unwrap();
    assert_eq!(unnamed[0].serial, "place 4");
}

#[test]
fn a_damaged_table_is_named_with_its_line() {
    let config = tool(NAMES, F1);
    let first = run(&config, BEGIN, 3600.0, [1e5; 4], [1e5; 4]);
    let mut lives = Lives::new("lives.csv", first.kind.clone());
    lives.add(&first, &[], false).unwrap();
    let text = lives.to_csv();
    let said = |text: &str| Lives::from_csv("lives.csv", text.as_bytes()).unwrap_err().to_string();
    for (from, to, words) in [
        ("# flexdrill life: 1\n", "", "`# flexdrill life: ...` is missing"),
        ("flexdrill life: 1", "flexdrill life: 2", "line 1: format 2: must be 1"),
        ("J-2,", "J-1,", "J-1 stands twice"),
        (",1,1,", ",0,1,", "line 10: place_from_bit = 0"),
        (",1,1,", ",1,-1,", "line 10: hours = -1: must be a number of at least 0"),
        ("\"slope\":3.0", "\"slope\":0.0", "# stop: must have numbers above 0"),
        ("serial_number,", "serial,", "must be the names serial_number,"),
    ] {
        assert!(text.contains(from), "{from}: {text}");
        let said = said(&text.replacen(from, to, 1));
        assert!(
            said.starts_with("lives.csv, line ") && said.contains(words),
            "{words}: {said}"
        );
    }
    let half = &text[..text.len() - 30];
    assert!(said(half).contains("fields: must have 8"), "{half}");
    // A spreadsheet quotes the lines of the heading and fills them with commas.
    let mut sheet = String::new();
    for line in text.lines() {
        if line.contains('"') {
            sheet += &format!("\"{}\",,,\r\n", line.replace('"', "\"\""));
        } else {
            sheet += &format!("{line}\r\n");
        }
    }
    assert_eq!(Lives::from_csv("lives.csv", sheet.as_bytes()).unwrap(), lives);
}

/// Damages by the count (`unit`) of each joint from the top.
#[track_caller]
fn are(found: &[f64], counts: [f64; JOINTS]) {
    assert_eq!(found.len(), JOINTS);
    for (found, count) in found.iter().zip(counts) {
        assert!(close(*found, count * unit()), "{found}, not {count} counts");
    }
}

/// J-1 and J-4 change places between the run of the table and this one; a run of the table that began later is not before it.
#[test]
fn a_run_that_lasts_adds_to_what_the_table_has_of_its_joints() {
    let first = tool(NAMES, F1);
    let one = run(&first, BEGIN, 3600.0, [4e6, 3e6, 2e6, 1e6], [0.0, 0.0, 0.0, 9e6]);
    let mut table = Lives::new("lives.csv", one.kind.clone());
    table.add(&one, &[], false).unwrap();
    let mut longer = table.clone();
    let later = run(&first, BEGIN + 86_400 * SECOND, 60.0, [1e9; 4], [1e9; 4]);
    longer.add(&later, &[], false).unwrap();

    let (config, begin) = (tool(["J-4", "J-2", "J-3", "J-1"], F1), BEGIN + 7200 * SECOND);
    let mut living = LivingJoints::of_table(&config, Some(longer)).unwrap();
    living.begin(begin);
    let mut at_begin = message(&config, begin, 0.0, [0.0; 4], [0.0; 4]);
    living.complete(&mut at_begin);
    assert_eq!(at_begin.joint_serial_number, ["J-1", "J-3", "J-2", "J-4"]);
    are(&at_begin.stop_life_damage_before, [1e6, 3e6, 2e6, 4e6]);
    are(&at_begin.link_life_damage_before, [9e6, 0.0, 0.0, 0.0]);
    assert_eq!(at_begin.stop_life_damage, at_begin.stop_life_damage_before);

    // An hour of it, which the table has in the end with the same bands.
    let (stop, link) = ([1e6, 0.0, 0.0, 5e6], [1e6, 0.0, 0.0, 0.0]);
    let mut after = message(&config, begin, 3600.0, stop, link);
    living.complete(&mut after);
    are(&after.stop_life_damage, [2e6, 3e6, 2e6, 9e6]);
    are(&after.link_life_damage, [1e7, 0.0, 0.0, 0.0]);
    are(&after.stop_life_damage_before, [1e6, 3e6, 2e6, 4e6]);
    table.add(&run(&config, begin, 3600.0, stop, link), &[], false).unwrap();
    for joint in table.ranked() {
        let at = after
            .joint_serial_number
            .iter()
            .position(|serial| *serial == joint.serial);
        let at = at.unwrap();
        for (found, expected) in [
            (after.stop_life_damage_low[at], joint.stop.low),
            (after.stop_life_damage_high[at], joint.stop.high),
            (after.link_life_damage_low[at], joint.link.low),
            (after.link_life_damage_high[at], joint.link.high),
        ] {
            assert!(close(found, expected), "{}: {found}, not {expected}", joint.serial);
        }
    }

    // After a reset of the twin the count begins at zero, and the lives continue.
    let mut reset = message(&config, begin + 3600 * SECOND, 60.0, [1e6, 0.0, 0.0, 0.0], [0.0; 4]);
    living.complete(&mut reset);
    are(&reset.stop_life_damage, [3e6, 3e6, 2e6, 9e6]);

    // A replay knows what was lived before from any message of the recording.
    for known in [&at_begin, &reset] {
        let mut replayed = LivingJoints::of_recording(&config, known).unwrap();
        replayed.begin(begin);
        for message in [&at_begin, &after, &reset] {
            let mut again = message.clone();
            again.link_life_damage_low.clear();
            again.joint_serial_number.clear();
            replayed.complete(&mut again);
            assert_eq!(again, *message);
        }
    }
}

#[test]
fn lives_that_are_not_known_are_not_in_a_message() {
    let config = tool(NAMES, F1);
    let counts = message(&config, BEGIN, 3600.0, [1e6; 4], [0.0; 4]);
    assert!(LivingJoints::of_recording(&config, &counts).is_none());
    // A new table: the lives begin with this run.
    let mut living = LivingJoints::of_table(&config, None).unwrap();
    living.begin(BEGIN);
    let mut whole = counts.clone();
    living.complete(&mut whole);
    are(&whole.stop_life_damage, [1e6; 4]);
    are(&whole.stop_life_damage_before, [0.0; 4]);
    // The counts of another tool have no lives of this one.
    let mut other = whole;
    other.stop_damage_rate.pop();
    other.bending_damage_rate.pop();
    living.complete(&mut other);
    assert!(other.joint_serial_number.is_empty() && other.link_life_damage_before.is_empty());
    // Damages of another class do not add up.
    let mut table = Lives::new("lives.csv", run(&config, BEGIN, 60.0, [0.0; 4], [0.0; 4]).kind);
    table
        .add(&run(&config, BEGIN, 60.0, [1e6; 4], [0.0; 4]), &[], false)
        .unwrap();
    let refused = LivingJoints::of_table(&tool(NAMES, "class: D"), Some(table));
    assert!(matches!(refused, Err(LifeError::OtherKind { what: "class", .. })));
}
