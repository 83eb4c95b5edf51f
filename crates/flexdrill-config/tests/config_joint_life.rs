//! The class of the joints' details and their serial numbers: printed tables, slopes of the count, and what is refused.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use flexdrill_config::{Config, DetailClass, Schema};

fn with(life: &str) -> Result<Config, String> {
    let text = include_str!("../../../config/coarse.yaml");
    let joint = format!("joint: {{limit_deg: 6.0, {life}}}");
    assert!(text.contains("joint: {limit_deg: 6.0}"));
    Config::from_text("life.yaml", &text.replace("joint: {limit_deg: 6.0}", &joint)).map_err(|e| e.to_string())
}

/// At 2e6 cycles DNV-RP-C203 lists the stress range of each category in air: 160 for B1 to 36 for W3 (MPa), as IIW and
/// Eurocode 3 name the same details.
#[test]
fn categories_have_the_ranges_that_iiw_names() {
    let names = [
        ("B1", 160.0),
        ("B2", 140.0),
        ("C", 125.0),
        ("C1", 112.0),
        ("C2", 100.0),
        ("D", 90.0),
        ("E", 80.0),
        ("F", 71.0),
        ("F1", 63.0),
        ("F3", 56.0),
        ("G", 50.0),
        ("W1", 45.0),
        ("W2", 40.0),
        ("W3", 36.0),
    ];
    assert_eq!(names.len(), DetailClass::ALL.len());
    for ((name, fat), class) in names.into_iter().zip(DetailClass::ALL) {
        assert_eq!(class.name(), name);
        let config = with(&format!("life: {{class: {name}, environment: air}}")).unwrap();
        let line = config.tool.joint.life.unwrap().line();
        // The design line lies two standard deviations of 0.2 below the mean.
        let design = line.cycles(fat * 1e6) / 10f64.powf(0.4);
        // Names are rounded to a whole MPa: by 1.4 % at W3, to the power of the slope.
        assert!((design / 2e6 - 1.0).abs() < 0.03, "{name}: {design}");
        let other = with(&format!(
            "life: {{fat: {fat}, fat_slope: {}, environment: air}}",
            line.slope
        ));
        let other = other.unwrap().tool.joint.life.unwrap().line();
        assert!((other.cycles(30e6) / line.cycles(30e6) - 1.0).abs() < 0.03, "{name}");
    }
}

#[test]
fn mud_takes_the_knee_and_shortens_the_life() {
    let line = |life: &str| with(life).unwrap().tool.joint.life.unwrap().line();
    let (air, mud) = (line("life: {class: F, environment: air}"), line("life: {class: F}"));
    assert_eq!((mud.knee, mud.slopes()), (0.0, [3.0, 3.0]));
    // Above the knee free corrosion has a third of the cycles in air: log10 3 = 0.477.
    assert!((air.cycles(100e6) / mud.cycles(100e6) / 3.0 - 1.0).abs() < 2e-3);
    // IIW: 70 % of the range, whose cube is 0.343.
    let iiw = line("life: {fat: 71}").cycles(50e6) / line("life: {fat: 71, environment: air}").cycles(50e6);
    assert!((iiw / 0.343 - 1.0).abs() < 1e-9, "{iiw}");
}

#[test]
fn cycles_are_counted_with_the_slopes_of_the_class() {
    let config = with("life: {class: B1, environment: air, stress_concentration: 2, stop_section_modulus: 1.0e-5}");
    let config = config.unwrap();
    let settings = config.simulation().ageing;
    assert_eq!((settings.slope, settings.slope_below_knee), (4.0, 5.0));
    // The knee of B1 is at 106.97 MPa, half of which is nominal; a tube of 63 and 32 mm has 2.291e-5 m3.
    let modulus = std::f64::consts::PI * (0.063f64.powi(4) - 0.032f64.powi(4)) / (32.0 * 0.063);
    for (knee, modulus) in settings.knees.into_iter().zip([1e-5, modulus]) {
        let expected = 0.5 * 106.97e6 * modulus / settings.rated_moment;
        assert!((knee / expected - 1.0).abs() < 1e-4, "{settings:?}");
    }
    let plain = Config::from_text("a.yaml", include_str!("../../../config/coarse.yaml")).unwrap();
    assert_eq!(plain.simulation().ageing, flexdrill_motion::AgeingSettings::default());
    // It is no part of the motion, and a file without it has the hash that it had.
    assert_eq!(config.motion_hash(), plain.motion_hash());
    assert_eq!(config.tool_hash([]), plain.tool_hash([]));
    assert!(
        !serde_json::to_string::<Schema>(&plain)
            .unwrap()
            .contains("serial_numbers")
    );
}

#[test]
fn a_wrong_class_and_wrong_serial_numbers_are_named() {
    for (life, words) in [
        ("life: {scatter: 0.2}", "tool.joint.life.class = left out"),
        ("life: {class: F2}", "F2"),
        ("life: {class: F, fat: 71}", "left out with tool.joint.life.class"),
        ("life: {class: F, fat_slope: 5}", "left out without tool.joint.life.fat"),
        ("life: {fat: 7}", "must be 15 to 320 MPa"),
        ("serial_numbers: [J-1, J-2]", "32 serial numbers, one per joint"),
        ("serial_numbers: ['J,1']", "letters A to Z"),
        ("serial_numbers: [J-1, J-1]", "another serial number"),
    ] {
        let said = with(life).unwrap_err();
        assert!(said.contains(words), "{life}: {said}");
    }
    let serials: Vec<String> = (1..=32).map(|place| format!("J-{place:03}")).collect();
    let config = with(&format!("serial_numbers: [{}]", serials.join(", "))).unwrap();
    assert_eq!(config.tool.joint.serial_numbers, serials);
}
