use std::f64::consts::TAU;

use super::*;
use flexdrill_hole::{Bounds, bounds, steady};
use flexdrill_messages::to_cdr;

/// The paper's tool with a guide of 0.05 of a tube's stiffness, made with a radius of 3.2 m, after 70 degrees of its arc.
pub(super) const TOOL: &str = include_str!("../../../../../tests/data/hole_ahead.yaml");

/// Side force of that guide at rest at 10 kN (N) by a program of finite differences that was written apart from this one.
const SIDE_FORCE: f64 = 1913.0;

pub(super) fn config(text: &str) -> Arc<Config> {
    Arc::new(Config::from_text("a test's tool", text).unwrap())
}

/// A tenth of a second: one turn per second at this weight (N) and side force (N).
#[derive(Debug, Clone, Copy)]
pub(super) struct Tenth {
    pub(super) turns: f64,
    pub(super) weight: f64,
    pub(super) side_force: f64,
}

pub(super) const STEADY: Tenth = Tenth {
    turns: 1.0,
    weight: 10e3,
    side_force: SIDE_FORCE,
};

/// A twin whose bit does what a test says.
pub(super) struct Twin {
    pub(super) hole: LiveHole,
    frame: Frame,
    tenth: u64,
    pub(super) surveys: Arc<[Survey]>,
    pub(super) found: Vec<Ready>,
}

impl Twin {
    pub(super) fn new(config: &Arc<Config>) -> Self {
        let mut frame = Frame::default();
        frame.snapshot.contacts.measured_depth = vec![0.0, config.well.length()];
        frame.snapshot.contacts.inclination = vec![0.0, config.well.end_inclination_deg().to_radians()];
        Self {
            hole: LiveHole::new(config),
            frame,
            tenth: (0.1 / config.solver.time_step).round() as u64,
            surveys: Arc::default(),
            found: Vec::new(),
        }
    }

    /// Adds tenths of a second, and waits for answers or not.
    pub(super) fn run(&mut self, tenths: usize, tenth: Tenth, wait: bool) {
        for _ in 0..tenths {
            self.frame.ticks += self.tenth;
            let steering = &mut self.frame.snapshot.steering;
            steering.duration = 0.1;
            // A rounding above one turn, so that five are whole.
            steering.rotary_speed = tenth.turns * (1.0 + 1e-9) * TAU;
            (steering.weight_on_bit, steering.torque) = (tenth.weight, 92.4);
            (steering.side_force, steering.tilt) = ([28.9, tenth.side_force], [0.0, -13.9e-3]);
            self.hole.observe(&self.frame, || Arc::clone(&self.surveys));
            self.found.extend(std::iter::from_fn(|| self.hole.take(wait)));
        }
    }

    pub(super) fn last(&self) -> &HoleAhead {
        &self.found.last().unwrap().message
    }
}

/// That nothing is said of where the tool drills, and why.
pub(super) fn assert_unknown(message: &HoleAhead, words: &str) {
    assert!(!message.known && message.because.contains(words), "{}", message.because);
    let numbers = [
        message.build_rate,
        message.build_rate_low,
        message.build_rate_high,
        message.walk_rate,
        message.walk_rate_low,
        message.walk_rate_high,
        message.radius,
        message.radius_low,
        message.radius_high,
        message.steering_number,
        message.free_length,
        message.radius_any_bit_low,
        message.radius_any_bit_high,
        message.plan_target,
        message.plan_build_rate,
        message.plan_off,
        message.plan_weight_low,
        message.plan_weight_high,
        message.plan_nearest_weight,
        message.plan_nearest_off,
        message.plan_nearest_radius,
        message.plan_weight,
    ];
    assert!(numbers.iter().all(|number| number.is_nan()), "{message:?}");
    let arrays = [
        &message.measured_depths,
        &message.inclinations,
        &message.azimuths,
        &message.position_x,
        &message.half_width_high,
        &message.half_width_right,
        &message.inclinations_low,
        &message.plan_high,
        &message.plan_right,
        &message.plan_inclination,
        &message.plan_azimuth,
        &message.plan_within,
    ];
    assert!(arrays.iter().all(|array| array.is_empty()), "{message:?}");
    assert!(!message.ripples && !message.plan_no_weight && !message.plan_no_guide);
    assert_eq!(message.plan_because, "");
}

/// The load of the table in docs/hole_ahead.md: nothing moves for 12 s.
#[test]
fn a_steady_load_has_the_answer_of_the_closed_form() {
    let config = config(TOOL);
    let mut twin = Twin::new(&config);
    twin.run(120, STEADY, true);
    assert_eq!(twin.found.len(), 12);
    // Asked for with the first means, at 1 s, and used from 6 s on.
    let second = twin.tenth * 10;
    for (index, ready) in twin.found.iter().enumerate() {
        assert_eq!(ready.ticks, second * (index as u64 + 1));
        if index < 5 {
            assert_unknown(&ready.message, "being computed");
            assert_eq!(ready.answered, None);
        } else {
            assert!(ready.message.known, "{}", ready.message.because);
            assert_eq!(ready.answered, Some(second), "one answer for all");
        }
    }
    let message = twin.last();
    assert_eq!((message.turns, message.members + message.failed), (5, 24));
    assert!(message.members >= 19, "{}", message.members);
    // The law of the bit by hand: -13.9 mrad + (1913 N + 139 N)/(20 10 kN) = -3.64 mrad, and to the right 28.9/2e5.
    assert!((message.turn_low + 3.64e-3).abs() < 1e-6, "{}", message.turn_low);
    assert!((message.turn_right - 28.9 / 2e5).abs() < 1e-9, "{}", message.turn_right);

    // From 2 to 4 m the hole has the curvature of the closed form at its inclination. The closed form is up to 1.3 % low;
    // within 1.5 free lengths, 1.8 m, the hole has all but a hundredth of its change from the arc as found, 2 %.
    let guide = tool::guide(&config, 10e3);
    let law = tool::bit(&config, 10e3).unwrap();
    let inclinations = &message.inclinations;
    let drilled = (inclinations[16] - inclinations[8]) / 2.0;
    let sine = inclinations[12].sin();
    let closed = steady(&guide, &law, sine).unwrap();
    assert!(
        (drilled / closed.curvature - 1.0).abs() < 0.015,
        "{drilled} {}",
        closed.curvature
    );
    let Bounds { low, high } = bounds(&guide, 10e3, sine).unwrap();
    assert!((low..high).contains(&drilled), "{low} {drilled} {high}");
    // In the message the bounds are those at the bit, 70 deg.
    let Bounds { low, high } = bounds(&guide, 10e3, 70_f64.to_radians().sin()).unwrap();
    assert!((message.radius_any_bit_low * high - 1.0).abs() < 1e-9);
    assert!((message.radius_any_bit_high * low - 1.0).abs() < 1e-9);

    // Ranges hold the tool as configured; a radius is one over a rate.
    assert!((message.build_rate_low..message.build_rate_high).contains(&message.build_rate));
    assert!((message.radius_low..message.radius_high).contains(&message.radius));
    assert!((message.walk_rate_low..message.walk_rate_high).contains(&message.walk_rate));
    // The azimuth turns by the torque, 0.013 deg/m in a level hole: nothing of the build.
    assert!((message.radius * message.build_rate - 1.0).abs() < 1e-3);
    assert_eq!(message.measured_depths.len(), 21);
    let [from, to] = [message.measured_depths[0], message.measured_depths[20]];
    assert!((from - message.measured_depth).abs() < 1e-12 && (to - from - METRES_AHEAD).abs() < 1e-9);
    for array in [
        &message.inclinations_low,
        &message.azimuths_high,
        &message.position_z,
        &message.half_width_high,
    ] {
        assert_eq!(array.len(), 21);
    }
    assert!(message.half_width_high[20] > message.half_width_high[4]);
}

const METRES_AHEAD: f64 = 5.0;

/// Bytes of messages with the ticks of their answers, as the session sends them.
fn bytes(found: &[Ready]) -> Vec<(u64, Option<u64>, Vec<u8>)> {
    let of = |ready: &Ready| (ready.ticks, ready.answered, to_cdr(&ready.message).unwrap());
    found.iter().map(of).collect()
}

/// A node that never waits has the messages of a replay that does, late ones too.
#[test]
fn messages_follow_from_the_frames_alone() {
    let config = config(TOOL);
    // At 12 kN the guide at rest pushes by 2160 N, between the 1913 N at 10 kN and 3060 N at 20 kN of the same program.
    let heavier = Tenth {
        weight: 12e3,
        side_force: 2160.0,
        ..STEADY
    };
    let (mut waits, mut polls) = (Twin::new(&config), Twin::new(&config));
    for (twin, wait) in [(&mut waits, true), (&mut polls, false)] {
        twin.run(75, STEADY, wait);
        twin.run(125, heavier, wait);
    }
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(120);
    while polls.found.len() < waits.found.len() {
        assert!(std::time::Instant::now() < deadline, "{} messages", polls.found.len());
        std::thread::sleep(std::time::Duration::from_millis(5));
        polls.found.extend(std::iter::from_fn(|| polls.hole.take(false)));
    }
    assert!(bytes(&waits.found) == bytes(&polls.found));
    // An answer is not shown for another weight: from 10 to 12 kN it is another one once the mean has moved by 6 %.
    let seconds: Vec<bool> = waits.found.iter().map(|ready| ready.message.known).collect();
    let changed = |ready: &&Ready| ready.message.because.contains("weight has changed");
    let changing: Vec<&Ready> = waits.found.iter().filter(changed).collect();
    assert!(seconds[6] && seconds[19] && !changing.is_empty(), "{seconds:?}");
    changing
        .iter()
        .for_each(|ready| assert_unknown(&ready.message, "follow within 10 s"));
    let answers: Vec<u64> = waits.found.iter().filter_map(|ready| ready.answered).collect();
    assert!(answers.last() > answers.first(), "{answers:?}");
}

/// A driller's weight wavers for as long as the tool drills: what was computed for each of its values holds the next time.
#[test]
fn a_weight_that_comes_back_has_its_answer_already() {
    let config = config(TOOL);
    let mut twin = Twin::new(&config);
    let wavers = |twin: &mut Twin| {
        for weight in [9e3, 10e3, 11e3, 12e3, 13e3, 14e3] {
            // The mean is that of this weight alone after 5 s; its answer is asked for then and used 5 s later.
            twin.run(120, Tenth { weight, ..STEADY }, true);
        }
        let answers = twin.found.drain(..).filter_map(|ready| ready.answered);
        answers.collect::<std::collections::BTreeSet<u64>>()
    };
    let first = wavers(&mut twin);
    assert!(first.len() >= 6, "an answer for each weight: {first:?}");
    // Weights between these, on the way from one to the next and back to the first, have an answer within 3 % too.
    let once = twin.frame.ticks;
    let second = wavers(&mut twin);
    assert!(
        second.len() >= 6 && second.last() < Some(&once),
        "asked for after {once}: {second:?}"
    );
}

#[test]
fn a_computer_that_does_not_keep_up_says_so() {
    let config = config(TOOL);
    let mut twin = Twin::new(&config);
    twin.run(60, STEADY, false);
    // The thread has no time for its answer: it is never heard.
    twin.hole.worker = None;
    twin.hole.found.clear();
    twin.found.clear();
    twin.run(WAITING * 10 + 10, STEADY, false);
    assert!(twin.found.len() < WAITING, "others wait");
    assert_unknown(&twin.found[0].message, "does not keep up");
}

#[test]
fn nothing_is_known_of_a_tool_that_nothing_can_be_said_of() {
    let changes = [
        (
            "free_curvature: 0.3125",
            "free_curvature: as_built",
            "shape of the guide is not given",
        ),
        ("lateral_resistance: 20", "axis: link", "screwed to the last link"),
        (
            "well:\n  sections: [{straight: {length: 1.117010}}, {arc: {radius: 3.2, build_angle_deg: 70}}]",
            // Without an arc nothing but a support keeps the guide from turning.
            "boundary: {supports: [{at: top, body: guide, fix: [psi]}]}\nwell:\n  sections: [{straight: {length: 5.026548}}]",
            "hole is straight",
        ),
        (
            "free_curvature: 0.3125}",
            "free_curvature: as_built, fixed: true}",
            "held at every node",
        ),
    ];
    for (from, to, words) in changes {
        assert!(TOOL.contains(from), "{from}");
        let config = config(&TOOL.replace(from, to));
        let mut twin = Twin::new(&config);
        twin.run(70, STEADY, true);
        assert_unknown(twin.last(), words);
        assert!(twin.hole.worker.is_none(), "nothing is computed");
        assert_eq!(twin.last().side_force_low, SIDE_FORCE, "the means are there");
    }
}

/// An arc of 1.1 m above the bit: the guide needs twice its free length, 2.4 m.
#[test]
fn a_short_arc_says_nothing() {
    let text = TOOL
        .replace("1.117010", "3.909537")
        .replace("build_angle_deg: 70", "build_angle_deg: 20");
    let mut twin = Twin::new(&config(&text));
    twin.run(70, STEADY, true);
    assert_unknown(twin.last(), "arc above the bit is 1.12 m long");
    assert!(twin.last().side_force_low_at_rest.is_finite());
}

#[test]
fn a_bit_that_does_not_drill_says_nothing() {
    let config = config(TOOL);
    let cases = [
        (Tenth { weight: 0.0, ..STEADY }, "off bottom"),
        (Tenth { turns: 0.0, ..STEADY }, "the bit stands"),
        (Tenth { turns: -1.0, ..STEADY }, "reverse"),
        (Tenth { turns: 0.1, ..STEADY }, "180 deg in 5.0 s"),
    ];
    let mut twin = Twin::new(&config);
    twin.run(70, STEADY, true);
    assert!(twin.last().known, "{}", twin.last().because);
    for (tenth, words) in cases {
        twin.run(60, tenth, true);
        assert_unknown(twin.last(), words);
        // The first five seconds after it have means of both.
        twin.run(60, STEADY, true);
        assert!(twin.last().known, "{}", twin.last().because);
    }
    let means = Means {
        weight: 8e3,
        rotary_speed: TAU,
        ..twin.hole.window.means().unwrap()
    };
    let words = standing(&means, 8.67e3).unwrap();
    assert!(
        words.contains("8.00 kN, is on the wear flats") && words.contains("8.67 kN"),
        "{words}"
    );
    assert_eq!(standing(&means, 0.0), None);
}

/// At rest this guide pushes with 1913 N: 2100 N are not within 5 %, 96 N, and errors of 0 N.
#[test]
fn another_side_force_than_that_of_the_statics_is_no_forecast() {
    let config = config(TOOL);
    let mut twin = Twin::new(&config);
    let pushed = Tenth {
        side_force: 2100.0,
        ..STEADY
    };
    twin.run(70, pushed, true);
    assert_unknown(twin.last(), "the bit pushes 2100 N");
    let at_rest = twin.last().side_force_low_at_rest;
    // Both programs differ by 0.1 % in the cases of docs/hole_ahead.md; 0.5 % leaves room for their meshes.
    assert!((at_rest / SIDE_FORCE - 1.0).abs() < 0.005, "{at_rest}");
    twin.run(50, STEADY, true);
    assert!(twin.last().known, "{}", twin.last().because);
}
