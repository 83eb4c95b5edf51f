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
    assert_eq!(surveys.counts(), [5, 1, 0, 0]);
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
                measured_depth: 2005.1,
                ..good()
            },
            "must be 2000.00 m, the kick-off (well.kick_off_depth), to 2005.03 m",
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
    assert_eq!(surveys.counts(), [count + 3, count + 2, 0, 0]);
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
