use super::*;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header;

const NOW: i64 = 1_700_000_000_000_000_000;
const SECOND: i64 = 1_000_000_000;

/// A hole of 5.026548 m below a kick-off at 2000 m.
fn surveys() -> Surveys {
    let text = include_str!("../../../../../config/default.yaml");
    assert!(text.contains("\nwell:\n"));
    let text = text.replace("\nwell:\n", "\nwell:\n  kick_off_depth: 2000\n");
    Surveys::new(&Config::from_text("a deep kick-off", &text).unwrap())
}

/// Messages received, and refused.
fn counted(surveys: &Surveys) -> [u64; 2] {
    let SurveyCounts { received, refused, .. } = surveys.counts();
    [received, refused]
}

fn message(depth: f64, inclination: f64, azimuth: f64) -> RigSurvey {
    RigSurvey {
        header: Header {
            stamp: Time::from_nanoseconds(NOW),
            ..Header::default()
        },
        measured_depth: depth,
        inclination,
        azimuth,
        source: "mwd".to_owned(),
        ..RigSurvey::default()
    }
}

#[test]
fn a_survey_counts_from_the_kick_off_with_the_usual_deviations() {
    let mut surveys = surveys();
    surveys.accept(&message(2004.0, 1.2, f64::NAN), NOW, 0.5).unwrap();
    let gyro = RigSurvey {
        azimuth_deviation: 0.5_f64.to_radians(),
        inclination_deviation: f64::NAN,
        ..message(2002.0, 0.6, 0.3)
    };
    // A late one, after an hour: the hole does not age.
    surveys.accept(&gyro, NOW + 3600 * SECOND, 0.5).unwrap();
    let known = surveys.known();
    assert_eq!(known.iter().map(|survey| survey.depth).collect::<Vec<_>>(), [4.0, 2.0]);
    assert_eq!(known[0].azimuth, None);
    let deviations = known.iter().map(|survey| survey.inclination_deviation);
    assert!(
        deviations
            .into_iter()
            .all(|deviation| deviation == 0.2_f64.to_radians())
    );
    assert_eq!(known[1].azimuth, Some([0.3, 0.5_f64.to_radians()]));
}

#[test]
fn a_repeated_survey_changes_nothing_and_a_corrected_one_replaces_it() {
    let mut surveys = surveys();
    surveys.accept(&message(2004.0, 1.2, 0.3), NOW, 0.5).unwrap();
    let before = surveys.known();
    let mut again = message(2004.0, 1.2, 0.3);
    again.header.stamp = Time::from_nanoseconds(NOW + SECOND);
    surveys.accept(&again, NOW + SECOND, 0.5).unwrap();
    assert!(Arc::ptr_eq(&before, &surveys.known()), "another list");
    again.inclination = 1.25;
    surveys.accept(&again, NOW + SECOND, 0.5).unwrap();
    assert_eq!(
        surveys
            .known()
            .iter()
            .map(|survey| survey.inclination)
            .collect::<Vec<_>>(),
        [1.25]
    );
    let refused = surveys
        .accept(&message(2004.0, 1.1, 0.3), NOW + SECOND, 0.5)
        .unwrap_err();
    assert!(
        refused.to_string().contains("2004.00 m whose stamp is 1.000 s newer"),
        "{refused}"
    );
    // Another tool measures the same depth too.
    let other = RigSurvey {
        source: "gyro".to_owned(),
        ..message(2004.0, 1.21, 0.3)
    };
    surveys.accept(&other, NOW, 0.5).unwrap();
    assert_eq!(surveys.known().len(), 2);
    assert_eq!(counted(&surveys), [5, 1]);
}

#[test]
fn a_bad_survey_is_refused_with_words_and_harms_nothing() {
    let mut surveys = surveys();
    surveys.accept(&message(2004.0, 1.2, 0.3), NOW, 0.5).unwrap();
    let before = surveys.known();
    let good = || message(2003.0, 1.0, 0.3);
    let cases = [
        (
            RigSurvey {
                measured_depth: 2055.1,
                ..good()
            },
            "must be 2000.00 m, the kick-off (well.kick_off_depth), to 2055.03 m, 50 m below the bit",
        ),
        (
            RigSurvey {
                measured_depth: 4.0,
                ..good()
            },
            "measured_depth = 4.00 m",
        ),
        (
            RigSurvey {
                measured_depth: f64::NAN,
                ..good()
            },
            "measured_depth = NaN m",
        ),
        (
            RigSurvey {
                inclination: 57.0,
                ..good()
            },
            "inclination = 57 rad (3265.86 deg): must be 0 to pi",
        ),
        (
            RigSurvey {
                inclination: f64::NAN,
                ..good()
            },
            "inclination = NaN",
        ),
        (
            RigSurvey {
                azimuth: f64::INFINITY,
                ..good()
            },
            "azimuth = ",
        ),
        (
            RigSurvey {
                inclination_deviation: -0.1,
                ..good()
            },
            "inclination_deviation = -0.1 rad",
        ),
        (
            RigSurvey {
                azimuth_deviation: 4.0,
                ..good()
            },
            "azimuth_deviation = 4 rad",
        ),
        (
            RigSurvey {
                quality: RigSurvey::SUSPECT,
                ..good()
            },
            "(quality 1, must be 0)",
        ),
        (RigSurvey { quality: 9, ..good() }, "(quality 9, must be 0)"),
    ];
    let count = cases.len() as u64;
    for (message, words) in cases {
        let refused = surveys.accept(&message, NOW, 0.5).unwrap_err();
        assert!(refused.to_string().contains(words), "{words}: {refused}");
        let newest = surveys.newest_refusal().map(|newest| newest.to_string());
        assert_eq!(newest, Some(refused.to_string()));
    }
    let mut unset = good();
    unset.header.stamp = Time::default();
    assert_eq!(surveys.accept(&unset, NOW, 0.5), Err(SurveyRefused::NoStamp));
    let mut ahead = good();
    ahead.header.stamp = Time::from_nanoseconds(NOW + 7200 * SECOND);
    let refused = surveys.accept(&ahead, NOW, 0.5).unwrap_err().to_string();
    assert!(refused.contains("2 h is a time zone"), "{refused}");
    assert!(Arc::ptr_eq(&before, &surveys.known()), "another list");
    assert_eq!(counted(&surveys), [count + 3, count + 2]);
}

/// 300 surveys between kick-off and bit, from above: the 200 deepest remain.
#[test]
fn the_deepest_are_kept() {
    let mut surveys = surveys();
    for index in 0..300 {
        let depth = 2000.0 + 0.0165 * f64::from(index);
        surveys.accept(&message(depth, 0.3, f64::NAN), NOW, 0.5).unwrap();
    }
    let known = surveys.known();
    assert_eq!(known.len(), MOST);
    assert!((known[0].depth - 1.65).abs() < 1e-9, "{}", known[0].depth);
}

/// A rig that drills on sends surveys of hole that the configuration does not have yet.
#[test]
fn a_survey_below_the_bit_waits_for_a_run_with_that_hole() {
    let mut surveys = surveys();
    surveys.accept(&message(2004.0, 1.2, 0.3), NOW, 0.5).unwrap();
    let before = surveys.known();
    let taken = surveys.accept(&message(2006.0, 1.7, f64::NAN), NOW, 0.5).unwrap();
    assert_eq!(
        taken,
        Taken::Waits {
            depth: 2006.0,
            bit: surveys.hole[1]
        }
    );
    let words = taken.advice().unwrap();
    assert!(
        words.contains("2006.00 m waits") && words.contains("2005.03 m"),
        "{words}"
    );
    assert!(Arc::ptr_eq(&before, &surveys.known()), "another list");
    surveys.accept(&message(2003.0, 0.9, f64::NAN), NOW, 0.5).unwrap();
    let counts = surveys.counts();
    assert_eq!(
        (counts.known, counts.waiting, counts.late, counts.deepest),
        (2, 1, 1, Some(2004.0))
    );

    // The next run has the hole down to 2007.03 m, below a kick-off that is 2 m deeper.
    let mut kept = surveys.kept();
    let text = include_str!("../../../../../config/default.yaml");
    let named = |well: &str| {
        let text = text.replace("\nwell:\n", "\nwell:\n  kick_off_depth: 2002\n");
        let config = Config::from_text("rebased", &text).unwrap();
        config.with_value("run.well", well).unwrap()
    };
    let mut rebased = Surveys::new(&named("B-7"));
    assert_eq!(
        rebased.restore(&kept),
        None,
        "a well without a name is known by its hole alone"
    );
    kept.of.well = "B-7".to_owned();
    let restored = rebased.restore(&kept).unwrap();
    assert_eq!(
        restored,
        Restored {
            known: 3,
            waiting: 0,
            left_out: 0
        }
    );
    let depths: Vec<f64> = rebased.known().iter().map(|survey| survey.depth).collect();
    assert_eq!(depths, [2.0, 1.0, 4.0]);
    assert_eq!(rebased.counts().earlier, 3);
    // Nothing of them came in this run.
    assert_eq!(counted(&rebased), [0, 0]);
    kept.of.well = "B-8".to_owned();
    assert_eq!(Surveys::new(&named("B-7")).restore(&kept), None, "of another well");
}

/// The bits of every number are those before, of any number; a survey that the rig repeats is known.
#[test]
fn what_is_kept_is_read_with_the_same_bits() {
    let mut before = surveys();
    let sent: Vec<RigSurvey> = (0..40)
        .map(|index| {
            let share = f64::from(index) / 39.0;
            RigSurvey {
                azimuth_deviation: 0.01 + share / 3.0,
                source: ["mwd", "a \"b\", c\n", ""][index as usize % 3].to_owned(),
                ..message(
                    2000.0 + 5.0 * share,
                    share.sqrt(),
                    if index % 4 == 0 { f64::NAN } else { share / 7.0 },
                )
            }
        })
        .collect();
    for survey in &sent {
        before.accept(survey, NOW, 0.5).unwrap();
    }
    let bytes = before.kept().encode().unwrap();
    let kept = KeptSurveys::decode(&bytes).unwrap();
    assert_eq!(kept, before.kept());
    assert_eq!((kept.len(), kept.newest()), (40, Some(NOW)));
    let mut after = surveys();
    assert_eq!(after.restore(&kept).map(|restored| restored.known), Some(40));
    assert_eq!(after.known(), before.known());
    for survey in &sent {
        assert_eq!(after.accept(survey, NOW, 0.5), Ok(Taken::Known));
    }
    let nothing = surveys().kept();
    assert_eq!(KeptSurveys::decode(&nothing.encode().unwrap()).unwrap(), nothing);
}

/// Every byte of a file counts: one that has changed, or a file that is cut, is no other hole.
#[test]
fn a_damaged_file_is_none() {
    let mut surveys = surveys();
    surveys.accept(&message(2004.0, 1.2, 0.3), NOW, 0.5).unwrap();
    let bytes = surveys.kept().encode().unwrap();
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 1;
        assert!(KeptSurveys::decode(&damaged).is_err(), "byte {at}");
        assert!(KeptSurveys::decode(&bytes[..at]).is_err(), "cut at {at}");
    }
    let newer = String::from_utf8(bytes)
        .unwrap()
        .replacen("surveys: 1", "surveys: 2", 1);
    let why = KeptSurveys::decode(newer.as_bytes()).unwrap_err();
    assert!(why.contains("format is 2"), "{why}");
}

/// A simulated clock begins at 0 with each run: what an earlier run has left must not look newer than all that comes.
#[test]
fn a_stamp_ahead_of_the_clock_does_not_hold_a_depth() {
    let mut before = surveys();
    before.accept(&message(2004.0, 1.2, 0.3), NOW, 0.5).unwrap();
    let mut after = surveys();
    after.restore(&before.kept()).unwrap();
    let mut corrected = message(2004.0, 1.25, 0.3);
    corrected.header.stamp = Time::from_nanoseconds(3 * SECOND);
    assert_eq!(after.accept(&corrected, 3 * SECOND, 0.5), Ok(Taken::New));
    assert_eq!(after.known()[0].inclination, 1.25);
}
