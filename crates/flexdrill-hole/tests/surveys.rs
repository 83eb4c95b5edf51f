//! The filter of surveys: what it must give in closed form, late surveys, and what it refuses.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_hole::{KEPT, PlaneModel, Planes, RunStart, Survey, SurveyFilter, usual_azimuth_deviation};

const MODELS: Planes<PlaneModel> = Planes {
    build: PlaneModel::BUILD,
    right: PlaneModel::RIGHT,
};
const MODEL: Planes<f64> = Planes { build: 0.3, right: 0.0 };
/// A long hole with the curvature of an arc has an inclination that no survey has.
const STRAIGHT: Planes<f64> = Planes { build: 0.0, right: 0.0 };

fn begin(models: Planes<PlaneModel>, deviation: f64) -> SurveyFilter {
    let start = RunStart {
        depth: 3.0,
        inclination: 0.2,
        azimuth: 0.5,
        deviation,
    };
    SurveyFilter::begin(models, start).unwrap()
}

fn drilled(filter: SurveyFilter, to: f64) -> SurveyFilter {
    along(MODEL, filter, to)
}

/// With another curvature of the model.
fn along(model: Planes<f64>, mut filter: SurveyFilter, to: f64) -> SurveyFilter {
    let mut depth = filter.depth();
    while depth < to {
        depth += 0.25;
        filter.drilled_to(depth, model).unwrap();
    }
    filter
}

fn survey(depth: f64, inclination: f64, deviation: f64) -> Survey {
    Survey {
        depth,
        inclination,
        inclination_deviation: deviation,
        azimuth: None,
    }
}

#[test]
fn two_surveys_without_noise_give_the_curvature() {
    let quiet = PlaneModel {
        correction_walk: 0.0,
        angle_walk: 0.0,
        ..PlaneModel::BUILD
    };
    let mut filter = drilled(
        begin(
            Planes {
                build: quiet,
                right: quiet,
            },
            0.1,
        ),
        7.0,
    );
    // An arc of 0.34 1/m between them, which turns to the right by 0.02 1/m.
    for (depth, inclination, right) in [(4.75, 0.7, 0.01), (6.75, 0.7 + 2.0 * 0.34, 0.05)] {
        let azimuth: f64 = 0.5 + (f64::sin(right) / f64::sin(inclination)).asin();
        filter
            .survey(Survey {
                azimuth: Some([azimuth, 1e-9]),
                ..survey(depth, inclination, 1e-9)
            })
            .unwrap();
    }
    let at = filter.at_bit();
    // Deviations of 1e-9 rad, 2 m apart, are 1e-9 1/m.
    assert!((at.build.correction - 0.04).abs() < 1e-8, "{at:?}");
    assert!((at.right.correction - 0.02).abs() < 1e-8, "{at:?}");
    assert!(at.build.correction_deviation() < 1e-8);
    let ahead = filter.forecast(0.25, &[MODEL; 20]).unwrap();
    let end = ahead[19];
    assert!((end.build.angle - (1.38 + 5.25 * 0.34)).abs() < 1e-7, "{end:?}");
    assert!((end.right.angle - (0.05 + 5.25 * 0.02)).abs() < 1e-7, "{end:?}");
}

#[test]
fn late_surveys_give_the_bits_of_early_ones() {
    let surveys = [
        survey(4.0, 0.52, 3e-3),
        survey(5.1, 0.85, 3e-3),
        survey(6.5, 1.30, 3e-3),
    ];
    let mut early = begin(MODELS, 0.02);
    for one in surveys {
        early = drilled(early, one.depth);
        early.survey(one).unwrap();
    }
    let early = drilled(early, 9.0).at_bit();
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let mut late = drilled(begin(MODELS, 0.02), 9.0);
        for index in order {
            late.survey(surveys[index]).unwrap();
        }
        assert_eq!(late.at_bit(), early);
        assert_eq!((late.used(), late.learnt()), (3, 2));
    }
}

#[test]
fn surveys_of_the_first_metre_and_a_half_correct_the_angle_alone() {
    let mut filter = drilled(begin(MODELS, 0.1), 4.25);
    let before = filter.at_bit().build;
    filter.survey(survey(4.25, 0.9, 1e-6)).unwrap();
    let after = filter.at_bit().build;
    assert_eq!(after.correction, before.correction);
    assert!((after.angle - 0.9).abs() < 1e-6 && after.angle_deviation() < 1e-5);
    assert_eq!((filter.used(), filter.learnt()), (1, 0));
}

#[test]
fn what_is_no_longer_kept_remains_in_the_state() {
    let surveyed = |to: f64| {
        let mut filter = along(STRAIGHT, begin(MODELS, 0.1), 6.0);
        filter.survey(survey(5.5, 0.21, 1e-3)).unwrap();
        along(STRAIGHT, filter, to)
    };
    let mut far = surveyed(5.5 + KEPT + 3.0);
    // Without surveys the correction stays as it was.
    let near = surveyed(6.25).at_bit().build.correction;
    assert!((far.at_bit().build.correction - near).abs() < 1e-15);
    let refused = far.survey(survey(5.5, 0.21, 1e-3)).unwrap_err().to_string();
    assert!(
        refused.contains("survey.depth = 5.5 m: must be 8.5 to 28.5"),
        "{refused}"
    );
    // Another survey is filtered from the base, which has the first one.
    far.survey(survey(28.5, 1.5 + far.at_bit().build.angle - 1.5, 1e-3))
        .unwrap();
    assert!((far.at_bit().build.correction - near).abs() < 1e-12);
}

#[test]
fn surveys_that_cannot_be_are_refused_and_change_nothing() {
    let mut filter = drilled(begin(MODELS, 0.1), 6.0);
    let before = filter.at_bit();
    let good = survey(5.0, 0.8, 3e-3);
    for (bad, said) in [
        (survey(2.9, 0.8, 3e-3), "survey.depth = 2.9 m: must be 3 to 6"),
        (survey(6.1, 0.8, 3e-3), "survey.depth = 6.1 m"),
        (survey(f64::NAN, 0.8, 3e-3), "survey.depth = NaN m"),
        (survey(5.0, -0.1, 3e-3), "survey.inclination = -0.1 rad"),
        (survey(5.0, 3.2, 3e-3), "survey.inclination = 3.2 rad"),
        (survey(5.0, f64::NAN, 3e-3), "survey.inclination = NaN rad"),
        (survey(5.0, 0.8, 0.0), "survey.inclination_deviation = 0 rad"),
        (
            Survey {
                azimuth: Some([f64::INFINITY, 0.1]),
                ..good
            },
            "survey.azimuth = inf rad",
        ),
        (
            Survey {
                azimuth: Some([0.5, -0.1]),
                ..good
            },
            "survey.azimuth_deviation = -0.1 rad",
        ),
    ] {
        let refused = filter.survey(bad).unwrap_err().to_string();
        assert!(refused.contains(said), "{said}: {refused}");
        assert_eq!(filter.at_bit(), before);
    }
    assert!(filter.drilled_to(6.0, MODEL).is_err());
    assert!(filter.forecast(0.0, &[MODEL]).is_err());
}

#[test]
fn magnetic_azimuths_near_the_casing_are_hardly_used() {
    assert_eq!(usual_azimuth_deviation(9.9).to_degrees().round(), 5.0);
    assert_eq!(usual_azimuth_deviation(10.0).to_degrees().round(), 1.0);
}

#[test]
fn plausible_holes_scatter_as_the_forecast_says() {
    let mut filter = drilled(begin(MODELS, 0.02), 7.0);
    filter.survey(survey(6.5, 1.3, 3e-3)).unwrap();
    let straight = [STRAIGHT; 20];
    let forecast = filter.forecast(0.25, &straight).unwrap()[19].build;
    let mut rng = fastrand::Rng::with_seed(3);
    let mut normal = || (-2.0 * (1.0 - rng.f64()).ln()).sqrt() * (std::f64::consts::TAU * rng.f64()).cos();
    let count = 4000;
    let ends: Vec<f64> = (0..count)
        .map(|_| filter.plausible(0.25, 20, &mut normal).unwrap()[20].build)
        .collect();
    let mean = ends.iter().sum::<f64>() / f64::from(count);
    let deviation = (ends.iter().map(|end| (end - mean).powi(2)).sum::<f64>() / f64::from(count)).sqrt();
    // Four standard errors: of a mean 1/sqrt(n), of a deviation 1/sqrt(2 n).
    let expected = forecast.angle_deviation();
    assert!(
        (mean - forecast.angle).abs() < 4.0 * expected / 63.0,
        "{mean} {forecast:?}"
    );
    assert!(
        (deviation / expected - 1.0).abs() < 4.0 / 89.0,
        "{deviation} {expected}"
    );
}
