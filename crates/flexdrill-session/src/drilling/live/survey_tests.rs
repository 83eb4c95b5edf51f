//! Surveys of a hole that the twin's law does not drill.

use std::sync::Arc;

use flexdrill_hole::Survey;

use super::tests::{STEADY, TOOL, Twin, config};
use super::*;

/// Measured depth of the bit, and from which on this tool has drilled (m).
const BIT: f64 = 5.026547;
const SINCE: f64 = 3.026547;
/// Curvature of the configured hole (1/m).
const ARC: f64 = 0.3125;
/// Inclination of the configured hole where this tool began (rad).
const BEGAN: f64 = 70.0 * std::f64::consts::PI / 180.0 - ARC * (BIT - SINCE);

/// The curvature that the hole comes to (1/m): a blunt bit's. The closed form has 0.318 for the bit as configured.
const BLUNT: f64 = 0.275;
/// The length in which it does (m).
const LAG: f64 = 0.5;

/// Inclination of the hole at a depth below [`SINCE`] (rad): its curvature turns from the arc's to that of a blunt bit, as a lag
/// of first order.
fn truth(depth: f64) -> f64 {
    let drilled = depth - SINCE;
    BEGAN + BLUNT * drilled + (ARC - BLUNT) * LAG * (1.0 - (-drilled / LAG).exp())
}

/// A survey that is exact, of a usual tool.
fn survey(depth: f64, azimuth: Option<[f64; 2]>) -> Survey {
    Survey {
        depth,
        inclination: truth(depth),
        inclination_deviation: 0.2_f64.to_radians(),
        azimuth,
    }
}

fn tool() -> Arc<Config> {
    let since = format!("  drilled_from: {SINCE}\n  hole_diameter");
    assert!(TOOL.contains("  hole_diameter"));
    config(&TOOL.replace("  hole_diameter", &since))
}

/// Error of the inclination 3 m ahead, and the range there (rad).
fn ahead(message: &HoleAhead) -> (f64, [f64; 2]) {
    let expected = truth(BIT + 3.0);
    let range = [message.inclinations_low[12], message.inclinations_high[12]];
    (message.inclinations[12] - expected, range)
}

/// The error without surveys is 3 (0.318 - 0.275) rad of curvature and 2 deg of direction, 0.16 rad. Two surveys 1.75 m apart
/// leave the filter's prior of 0.035 1/m against what they measure to 0.003 1/m: a hundredth of 0.04 1/m, and the lag, of which
/// they see 0.004 1/m as curvature: together 0.015 rad after 3 m. Three times that is allowed for what the prior of the drift
/// adds.
#[test]
fn surveys_of_another_hole_turn_the_answer_toward_it() {
    let mut twin = Twin::new(&tool());
    twin.run(70, STEADY, true);
    let (before, _) = ahead(twin.last());
    assert!(before > 0.12, "{before}");
    assert_eq!(
        (twin.last().surveys_used, twin.last().surveys_because.as_str()),
        (0, "")
    );
    assert!(twin.last().since_survey.is_nan() && twin.last().surveyed_build.is_nan());

    twin.surveys = [survey(SINCE + 0.25, None), survey(BIT, None)].into();
    twin.run(20, STEADY, true);
    // The old answer is shown until the new one is used, 5 s later.
    assert_eq!(twin.last().surveys_used, 0);
    assert_eq!(twin.last().survey_depths, [SINCE + 0.25, BIT]);
    twin.run(50, STEADY, true);
    let message = twin.last();
    assert!(message.known, "{}", message.because);
    let (after, [low, high]) = ahead(message);
    assert!(after.abs() < 0.045, "{after}");
    assert!((low..high).contains(&truth(BIT + 3.0)), "{low} {high}");
    // The second alone is 1.5 m or more below the beginning.
    assert_eq!((message.surveys_used, message.surveys_learnt), (2, 1));
    // The hole ends at a rounded depth.
    assert!(message.since_survey.abs() < 1e-6, "{}", message.since_survey);
    // 0.2 deg of the survey at the bit.
    assert!((message.surveyed_inclination - truth(BIT)).abs() < 0.2_f64.to_radians());
    assert!(
        message.surveyed_build < 0.0 && message.surveyed_build_deviation < 0.035,
        "{} {}",
        message.surveyed_build,
        message.surveyed_build_deviation
    );
    assert!((message.build_rate_low..message.build_rate_high).contains(&message.build_rate));
    assert_eq!((message.drilled_from, message.members, message.failed), (SINCE, 300, 0));
    assert!(message.plane_azimuth.is_nan());
    // The hole of the configuration is 3.2 deg more inclined at the bit.
    assert!(
        message.surveys_because.contains("correct well.sections"),
        "{}",
        message.surveys_because
    );
}

/// A survey that comes after deeper ones is filtered in its place: the answer has the bits of surveys in the order of depth.
#[test]
fn late_surveys_are_filtered_again() {
    let config = tool();
    let north = Some([0.4, 1.0_f64.to_radians()]);
    let [first, middle, last] = [0.25, 1.0, 1.9].map(|drilled| survey(SINCE + drilled, north));
    let (mut late, mut ordered) = (Twin::new(&config), Twin::new(&config));
    late.surveys = [first, last].into();
    ordered.surveys = Arc::clone(&late.surveys);
    late.run(70, STEADY, true);
    ordered.run(70, STEADY, true);
    let without = late.last().clone();
    late.surveys = [first, last, middle].into();
    ordered.surveys = [first, middle, last].into();
    late.run(70, STEADY, true);
    ordered.run(70, STEADY, true);
    let (late, ordered) = (late.last(), ordered.last());
    assert_eq!(
        (without.surveys_used, late.surveys_used, ordered.surveys_used),
        (2, 3, 3)
    );
    assert_eq!(late.inclinations, ordered.inclinations);
    assert_eq!(late.half_width_high, ordered.half_width_high);
    assert_ne!(late.inclinations, without.inclinations);
    assert!((late.since_survey - 0.1).abs() < 1e-6, "{}", late.since_survey);
    // The hole lies in the plane of the surveys, and its azimuth is counted from there.
    assert!(
        (late.plane_azimuth - 0.4).abs() < 1e-9 && late.surveyed_azimuth.abs() < 1e-3,
        "{late:?}"
    );
    assert_eq!(surveys_of(late), [first, last, middle]);
}

/// Another tool drilled the hole above: the answer has the bits of one without surveys.
#[test]
fn surveys_above_this_tool_correct_nothing() {
    let mut twin = Twin::new(&tool());
    twin.run(70, STEADY, true);
    let before = twin.last().inclinations.clone();
    twin.surveys = [survey(SINCE - 0.01, None)].into();
    twin.run(70, STEADY, true);
    let message = twin.last();
    assert!(message.known && message.surveys_used == 0, "{}", message.because);
    assert!(
        message.surveys_because.contains("no survey lies below 3.03 m"),
        "{}",
        message.surveys_because
    );
    assert_eq!(message.inclinations, before);
}

/// Three degrees off, the guide is taken to lie in another hole than the one that was measured.
#[test]
fn a_configuration_with_another_hole_is_said() {
    let mut twin = Twin::new(&tool());
    let mut off = survey(BIT, None);
    off.inclination = truth(BIT) - 6.0_f64.to_radians();
    off.inclination_deviation = 0.02_f64.to_radians();
    twin.surveys = [off].into();
    twin.run(70, STEADY, true);
    assert!(
        twin.last()
            .surveys_because
            .contains("and the configuration 70.0 deg: correct well.sections"),
        "{}",
        twin.last().surveys_because
    );
}

/// A node that never waits has the messages of a replay that does; a reset of the motion leaves the surveys of the hole.
#[test]
fn messages_follow_from_frames_and_surveys_alone() {
    let config = tool();
    let (mut waits, mut polls) = (Twin::new(&config), Twin::new(&config));
    for (twin, wait) in [(&mut waits, true), (&mut polls, false)] {
        twin.run(75, STEADY, wait);
        twin.surveys = [survey(BIT, None)].into();
        twin.run(30, STEADY, wait);
        twin.hole.reset();
        twin.surveys = [survey(BIT, None), survey(SINCE + 0.5, None)].into();
        twin.run(95, STEADY, wait);
    }
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(120);
    while polls.found.len() < waits.found.len() {
        assert!(std::time::Instant::now() < deadline, "{} messages", polls.found.len());
        std::thread::sleep(std::time::Duration::from_millis(5));
        polls.found.extend(std::iter::from_fn(|| polls.hole.take(false)));
    }
    let bytes = |twin: &Twin| -> Vec<Vec<u8>> {
        let messages = twin.found.iter().map(|ready| &ready.message);
        messages
            .map(|message| flexdrill_messages::to_cdr(message).unwrap())
            .collect()
    };
    assert!(bytes(&waits) == bytes(&polls));
    let used: Vec<u32> = waits.found.iter().map(|ready| ready.message.surveys_used).collect();
    assert!(used.contains(&1) && used.last() == Some(&2), "{used:?}");
}
