//! Surveys through a replay: of another program's bag, and of the recording made of it.

use std::path::Path;

use flexdrill::bag::{Recorder, Topic};
use flexdrill::messages::builtin_interfaces::Time;
use flexdrill::messages::std_msgs::Header;
use flexdrill::messages::{HoleAhead, Message, RigInputs, RigSurvey, to_cdr, topics};

use crate::hole_ahead::{TOOL, messages, replayed};

/// 2023-11-14 22:13:20 UTC.
const START: i64 = 1_700_000_000_000_000_000;
const SECOND: i64 = 1_000_000_000;
/// Measured depths of the kick-off and of the bit below it (m), and the hole's inclination at the bit (deg).
const KICK_OFF: f64 = 2000.0;
const BIT: f64 = 5.026548;
const INCLINATION: f64 = 70.0;

fn header(stamp: i64) -> Header {
    Header {
        stamp: Time::from_nanoseconds(stamp),
        ..Header::default()
    }
}

/// A survey of a hole that is a degree less inclined than the configured one, so far above the bit (m).
fn survey(above: f64) -> RigSurvey {
    RigSurvey {
        header: header(START),
        measured_depth: KICK_OFF + BIT - above,
        inclination: (INCLINATION - 1.0).to_radians() - above / 3.2,
        azimuth: f64::NAN,
        source: "mwd".to_owned(),
        ..RigSurvey::default()
    }
}

/// A rig's bag of 24 s at 10 kN and 60 r/min: a survey at the bit, one below it, a late one above, and the first again.
fn rig(path: &Path) {
    let of = |topic: &topics::TopicInfo| Topic::new(format!("/{}", topic.name), &topic.kind, topic.qos);
    let mut recorder = Recorder::create(path, &[of(&topics::RIG_INPUTS), of(&topics::RIG_SURVEY)]).unwrap();
    for second in 0..24 {
        let stamp = START + second * SECOND;
        let inputs = RigInputs {
            header: header(stamp),
            rotary_speed_rpm: 60.0,
            weight_on_bit_kn: 10.0,
            rate_of_penetration_m_per_h: f64::NAN,
            standpipe_pressure_mpa: f64::NAN,
            ..RigInputs::default()
        };
        recorder.record(0, stamp, &to_cdr(&inputs).unwrap()).unwrap();
        let sent = match second {
            2 => survey(0.0),
            3 => survey(-0.5),
            12 => survey(0.3),
            14 => survey(0.0),
            _ => continue,
        };
        recorder.record(1, stamp + 1, &to_cdr(&sent).unwrap()).unwrap();
    }
    recorder.finish().unwrap();
}

fn surveys(of: &Path) -> Vec<(i64, Vec<u8>)> {
    let messages = flexdrill::bag::open(of).unwrap().map(Result::unwrap);
    messages
        .filter(|message| message.topic.ros_type == RigSurvey::ROS_TYPE)
        .map(|message| (message.log_time, message.data.clone()))
        .collect()
}

#[test]
fn a_replay_repeats_when_surveys_were_used() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    rig(&at("rig"));
    let begun = format!("well:\n  kick_off_depth: {KICK_OFF}\n  drilled_from: {}\n", BIT - 2.0);
    std::fs::write(at("tool.yaml"), TOOL.replace("well:\n", &begun)).unwrap();
    let said = replayed(&[
        &at("rig"),
        Path::new("--config"),
        &at("tool.yaml"),
        Path::new("--out"),
        &at("run"),
    ]);
    assert!(
        said.contains(
            "at 3.00 s: rig/survey: a survey at 2005.53 m waits: the hole of the configuration ends at 2005.03 m"
        ),
        "{said}"
    );
    let said = replayed(&[&at("run"), Path::new("--out"), &at("again")]);
    assert!(said.contains("exact: the recording has everything"), "{said}");

    // All that came is in both recordings, the one that waits too.
    let (run, again) = (
        messages(&at("run"), "twin/hole_ahead"),
        messages(&at("again"), "twin/hole_ahead"),
    );
    assert_eq!(surveys(&at("run")).len(), 4);
    assert_eq!(surveys(&at("run")), surveys(&at("again")));
    assert!(
        run.len() >= 20 && run == again,
        "{} and {} messages",
        run.len(),
        again.len()
    );
    let all: Vec<HoleAhead> = run
        .iter()
        .map(|(_, data)| flexdrill::messages::from_cdr(data).unwrap())
        .collect();
    let known: Vec<usize> = all.iter().map(|message| message.survey_depths.len()).collect();
    assert!(known.starts_with(&[0, 0]) && known.contains(&1), "{known:?}");
    let last = all.last().unwrap();
    assert!(last.known, "{}", last.because);
    // From the kick-off; the repeated survey is one.
    let depths = [BIT, BIT - 0.3];
    assert_eq!(last.survey_depths.len(), 2);
    for (depth, expected) in last.survey_depths.iter().zip(depths) {
        // The end of the hole is rounded to a micrometre.
        assert!((depth - expected).abs() < 1e-6, "{depth}");
    }
    assert_eq!((last.surveys_used, last.surveys_learnt), (2, 2));
    // Two surveys say a degree less, each to 0.2 deg.
    assert!(
        (last.surveyed_inclination.to_degrees() - (INCLINATION - 1.0)).abs() < 0.2,
        "{}",
        last.surveyed_inclination.to_degrees()
    );
}
