//! Frames, good and bad, and what is read from them.

use super::*;
use flexdrill_core::inputs::MeasuredKind;
use flexdrill_outputs::MeasuredValues as _;

const ARRIVED: i64 = 1_700_000_000_500_000_000;

fn frame(text: &str) -> RawFrame {
    RawFrame {
        lines: text.lines().map(|line| line.trim().as_bytes().to_vec()).collect(),
        ..RawFrame::default()
    }
}

fn decode(mapping: &str, text: &str) -> Reading {
    let mapping = Mapping::from_text("site.yaml", mapping).unwrap();
    Decoder::new(&mapping, "rig:5555").decode(&frame(text), ARRIVED)
}

const FRAME: &str = "0101 Well 7\n01031\n01041\n0105231114\n0106221320\n01071\n01082510.4\n01102512\n011318.5\n011438.2\n\
                     01162.5\n01189.75\n0120 60\n012112500\n01399999\n";

#[test]
fn a_metric_frame_becomes_inputs_and_measured_values() {
    let reading = decode("", FRAME);
    assert_eq!(reading.outcome, FrameUse::Used { values: 8 });
    let inputs = reading.inputs.unwrap();
    assert_eq!(inputs.quality, RigInputs::GOOD);
    // The conversion to rad/s and back rounds.
    assert!((inputs.rotary_speed_rpm - 60.0).abs() < 1e-12);
    // 2.5 KDN are 25 kN, and no 2.5 kN.
    assert!((inputs.weight_on_bit_kn - 25.0).abs() < 1e-12);
    assert!((inputs.rate_of_penetration_m_per_h - 18.5).abs() < 1e-12);
    assert!((inputs.standpipe_pressure_mpa - 12.5).abs() < 1e-12);
    assert_eq!(inputs.source, "wits rig:5555, well Well 7");
    assert_eq!(inputs.header.stamp.to_nanoseconds(), ARRIVED);
    let measured = reading.measured.unwrap();
    assert_eq!(measured.value(MeasuredKind::HookLoad), Some(382e3));
    assert_eq!(measured.value(MeasuredKind::SurfaceTorque), Some(9750.0));
    assert_eq!(measured.value(MeasuredKind::BitDepth), Some(2510.4));
    assert_eq!(measured.value(MeasuredKind::DownholeTorque), None);
    assert_eq!((reading.unmapped, reading.nulls, reading.faults.len()), (1, 0, 0));
    assert_eq!(reading.records[0].sequence, Sequence::First);
}

#[test]
fn a_field_frame_is_the_same_in_other_units() {
    let reading = decode(
        "units: field\nstamp: header\n",
        "0105231114\n0106221320\n0116 5\n0118 2\n0121 1000\n0113 60",
    );
    let inputs = reading.inputs.unwrap();
    assert!((inputs.weight_on_bit_kn - 22.241_108).abs() < 1e-6);
    assert!((inputs.standpipe_pressure_mpa - 6.894_757).abs() < 1e-6);
    assert!((inputs.rate_of_penetration_m_per_h - 18.288).abs() < 1e-9);
    assert_eq!(inputs.header.stamp.to_nanoseconds(), 1_700_000_000_000_000_000);
    assert!((reading.measured.unwrap().surface_torque - 2711.636).abs() < 1e-3);
}

/// Record 7 of the specification: 08 is the depth of the survey, 13 its inclination, 15 its azimuth after correction; 14 is
/// the azimuth before it.
#[test]
fn the_record_of_surveys_is_a_survey() {
    let survey = decode("", "0708 2004.5\n0711 2010\n0713 57.3\n0714 12\n0715 15.5")
        .survey
        .unwrap();
    assert_eq!((survey.measured_depth, survey.quality), (2004.5, RigSurvey::GOOD));
    assert!((survey.inclination - 57.3_f64.to_radians()).abs() < 1e-12);
    assert!((survey.azimuth - 15.5_f64.to_radians()).abs() < 1e-12);
    assert!(survey.inclination_deviation.is_nan());
    assert_eq!(survey.header.stamp.to_nanoseconds(), ARRIVED);
    // Nothing of it is an input or a measured value.
    let reading = decode("units: field\n", "0708 1000\n0713 57.3\n0715 -9999");
    assert_eq!((&reading.inputs, &reading.measured), (&None, &None));
    let survey = reading.survey.unwrap();
    assert!((survey.measured_depth - 304.8).abs() < 1e-9 && survey.azimuth.is_nan());
    assert_eq!(decode("", "0708 2004.5\n0715 15.5").survey, None, "no inclination");
    let wrong = decode("", "0708 2004.5\n0713 190");
    assert!(wrong.survey.is_none() && wrong.faults[0].to_string().contains("0713: out of range"));
}

#[test]
fn a_maximum_serves_only_without_its_mean_and_is_doubtful() {
    let both = decode("", "0114 40\n0115 44\n0120 30").measured.unwrap();
    assert_eq!((both.hook_load, both.quality), (400e3, RigMeasured::GOOD));
    let alone = decode("", "0115 44\n0120 30");
    assert_eq!(alone.measured.unwrap().quality, RigMeasured::SUSPECT);
    assert_eq!(alone.inputs.unwrap().quality, RigInputs::GOOD);
}

#[test]
fn what_cannot_be_used_is_reported_and_leaves_the_rest() {
    let text = "0108 -999.25\n0110\n0114 1,5\n0116 900000\nhello\u{1b}[2J\n0118 2\n0118 3\n0104 x";
    let reading = decode("", text);
    assert_eq!(reading.outcome, FrameUse::Used { values: 1 });
    assert_eq!(reading.measured.unwrap().surface_torque, 2000.0);
    assert_eq!(reading.nulls, 2);
    let texts: Vec<String> = reading.faults.iter().map(ToString::to_string).collect();
    let all = texts.join("\n");
    for words in [
        "0114: no number: \"1,5\"",
        "0116: out of range",
        "hello\\x1b[2J",
        "0118: item twice",
        "0104: unread",
    ] {
        assert!(all.contains(words), "{words} in {all}");
    }
    assert!(!all.contains('\u{1b}'));
}

/// Some rigs write nulls with one digit or none.
#[test]
fn a_rounded_null_is_a_null() {
    let nulls = [
        "-999.25",
        "-999.250",
        "-999.2",
        "-999.3",
        "-999",
        "-9999",
        "-9999.0",
        "-9.999e3",
        "-8888.00",
        "-999.25000",
    ];
    for null in nulls {
        let reading = decode("", &format!("0108 {null}\n0120 40"));
        assert_eq!((reading.nulls, reading.measured), (1, None), "{null}");
        assert!(reading.faults.is_empty(), "{null}");
    }
    // Not rounded, or of fewer than three common digits.
    for value in ["-999.1", "-998", "-1000", "-9998.9", "-999.26"] {
        let reading = decode("", &format!("0108 {value}\n0120 40"));
        assert_eq!(reading.nulls, 0, "{value}");
    }
    let reading = decode("nulls: [99.9]\n", "0108 100\n0110 99.90");
    assert_eq!((reading.nulls, reading.measured.unwrap().bit_depth), (1, 100.0));
}

#[test]
fn the_source_keeps_the_well_where_a_frame_does_not_name_it() {
    let mut decoder = Decoder::new(&Mapping::default(), "rig");
    let mut source = |text: &str| decoder.decode(&frame(text), ARRIVED).inputs.unwrap().source;
    assert_eq!(source("0101 Well 7\n0120 40"), "wits rig, well Well 7");
    assert_eq!(source("0120 41"), "wits rig, well Well 7");
}

#[test]
fn a_frame_without_values_says_why() {
    let not_used = |text: &str| match decode("", text).outcome {
        FrameUse::NotUsed(reason) => reason,
        FrameUse::Used { values } => panic!("{values} used of {text}"),
    };
    assert_eq!(not_used(""), NotUsed::Empty);
    assert_eq!(not_used("0199 1"), NotUsed::NothingMapped);
    assert_eq!(not_used("0120 -9999"), NotUsed::NoGoodValue);
    let mut decoder = Decoder::new(&Mapping::default(), "rig");
    let mut outcome = |text: &str| decoder.decode(&frame(text), ARRIVED).outcome;
    assert_eq!(outcome("0104 5\n0120 40"), FrameUse::Used { values: 1 });
    assert_eq!(outcome("0104 5\n0120 40"), FrameUse::NotUsed(NotUsed::Repeated));
    assert_eq!(outcome("0104 3\n0120 40"), FrameUse::NotUsed(NotUsed::Late));
    let jumped = outcome("0104 900000000000000\n0120 40");
    assert_eq!(jumped, FrameUse::NotUsed(NotUsed::Jumped));
    // Equal numbers with other contents are other records.
    assert_eq!(outcome("0104 5\n0120 41"), FrameUse::Used { values: 1 });
    // Another record counts for itself.
    assert_eq!(outcome("0904 3\n0917 4"), FrameUse::Used { values: 1 });
}

#[test]
fn a_mapping_may_ignore_the_sequence_and_its_unreadable_numbers_are_reported_once() {
    let mut decoder = Decoder::new(&Mapping::default(), "rig");
    let mut faults = |text: &str| decoder.decode(&frame(text), ARRIVED).faults.len();
    let found = [
        faults("0104 2026-09-25 08:37:24\n0120 40"),
        faults("0104 2026-09-25 08:37:25\n0120 41"),
    ];
    assert_eq!(found, [1, 0]);
    let ignoring = Mapping::from_text("site.yaml", "sequence: ignore\n").unwrap();
    let mut decoder = Decoder::new(&ignoring, "rig");
    for text in [
        "0104 x\n0120 40",
        "0104 5\n0120 40",
        "0104 5\n0120 40",
        "0104 3\n0120 40",
    ] {
        let reading = decoder.decode(&frame(text), ARRIVED);
        assert_eq!(
            (reading.outcome, reading.faults.len()),
            (FrameUse::Used { values: 1 }, 0),
            "{text}"
        );
    }
}

#[test]
fn two_counters_on_a_line_make_its_values_suspect() {
    let mut decoder = Decoder::new(&Mapping::default(), "rig");
    let mut last = None;
    for number in 0..10 {
        decoder.decode(&frame(&format!("0104 {}\n0120 40", 5 + number)), ARRIVED);
        last = decoder
            .decode(&frame(&format!("0104 {}\n0120 100", 1000 + number)), ARRIVED)
            .inputs;
    }
    assert_eq!(last.unwrap().quality, RigInputs::SUSPECT);
}

#[test]
fn a_clock_of_another_time_zone_is_named_once() {
    // 22:13:20 UTC. The clock of the rig is 5.5 h ahead, and the frame needs 0.5 s.
    let found = |mapping: &str, clocks: &[&str]| {
        let mapping = Mapping::from_text("site.yaml", mapping).unwrap();
        let mut decoder = Decoder::new(&mapping, "rig");
        let mut read = |clock: &&str| {
            decoder
                .decode(&frame(&format!("0105231115\n0106{clock}\n0120 40")), ARRIVED)
                .clock
        };
        clocks
            .iter()
            .filter_map(&mut read)
            .map(|clock| clock.utc_offset_h)
            .collect::<Vec<_>>()
    };
    let ahead = ["034320", "034320", "034320"];
    assert_eq!(found("stamp: header\n", &ahead), [5.5]);
    assert_eq!(found("stamp: header\nutc_offset_h: 1\n", &ahead), [5.5]);
    assert!(found("stamp: header\nutc_offset_h: 5.5\n", &ahead).is_empty());
    assert!(found("", &ahead).is_empty(), "stamps of arrival need no zone");
    assert!(
        found("stamp: header\n", &["034324", "034324"]).is_empty(),
        "no whole quarter"
    );
    assert!(
        found("stamp: header\n", &["034320"]).is_empty(),
        "one frame may be by chance"
    );
}
