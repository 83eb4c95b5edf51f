//! Hand-made logs, the demonstration's and a real one.

use flexdrill_core::inputs::{InputKind, Unit};
use flexdrill_field_log::{Guess, Quantity, Range, Sure, guess, guess_bytes, is_proposed, read_bytes};

use crate::rig::{Random, Second, rig};

const DEMO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/field_logs/demo.csv");

/// Rows of a log: the hole grows by some metres.
const SECONDS: usize = 3600;

/// A log with this header, of an hour of a rig.
fn log(header: &str, fields: impl Fn(&Second) -> String) -> String {
    let rows: String = rig(&mut Random::new(7), SECONDS)
        .iter()
        .map(|now| fields(now) + "\n")
        .collect();
    format!("{header}\n{rows}")
}

fn guessed(text: &str) -> Guess {
    guess_bytes("log.csv".to_owned(), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// The column and unit of a quantity, and how sure.
fn of(guess: &Guess, quantity: Quantity) -> Option<(&str, Unit, Sure)> {
    let found = guess.proposals().iter().find(|proposal| proposal.quantity == quantity);
    found.map(|proposal| (&*proposal.column, proposal.unit, proposal.sure))
}

/// Why a column is left out.
fn why<'a>(guess: &'a Guess, column: &str) -> &'a str {
    let found = guess.left_out().iter().find(|left| left.column == column);
    &found
        .unwrap_or_else(|| panic!("`{column}` is not left out\n{}", guess.table()))
        .why
}

#[test]
fn names_and_imperial_units_are_confirmed_by_the_numbers_and_can_be_run() {
    let text = log(
        "Time (s),Hookload (klbf),WOB (klbf),Rotary Speed (rpm),Torque (ft-lbs),ROP (ft/hr),Bit Depth (ft),Hole Depth (ft),SPP (psi)",
        |now| {
            format!(
                "{:.2},{:.2},{:.2},{:.1},{:.0},{:.1},{:.2},{:.2},{:.0}",
                now.time_s,
                now.hook_kn / 4.448_222,
                now.weight_kn / 4.448_222,
                now.speed_rpm,
                now.torque_knm / 1.355_818e-3,
                now.rate_mph / 0.3048,
                now.bit_m / 0.3048,
                now.hole_m / 0.3048,
                now.pressure_kpa / 6.894_757
            )
        },
    );
    let guess = guessed(&text);
    assert!(guess.lacks().is_empty(), "{}", guess.table());
    assert_eq!(guess.time(), Some(("Time (s)".to_owned(), "seconds".to_owned())));
    for (quantity, column, unit) in [
        (Quantity::HookLoad, "Hookload (klbf)", Unit::Kilopound),
        (Quantity::WeightOnBit, "WOB (klbf)", Unit::Kilopound),
        (Quantity::RotarySpeed, "Rotary Speed (rpm)", Unit::TurnPerMinute),
        (Quantity::Torque, "Torque (ft-lbs)", Unit::FootPound),
        (Quantity::BitDepth, "Bit Depth (ft)", Unit::Foot),
        (Quantity::HoleDepth, "Hole Depth (ft)", Unit::Foot),
    ] {
        assert_eq!(
            of(&guess, quantity),
            Some((column, unit, Sure::Sure)),
            "{}",
            guess.table()
        );
    }
    let pressure = of(&guess, Quantity::StandpipePressure);
    assert_eq!(pressure, Some(("SPP (psi)", Unit::Psi, Sure::Likely)));
    let file = guess.mapping_file();
    assert!(is_proposed(&file), "{file}");
    let (sequence, report) = read_bytes(
        "log.csv".to_owned(),
        text.as_bytes(),
        &guess.mapping().unwrap(),
        &Range::ALL,
    )
    .unwrap();
    assert_eq!(report.left_out, 0, "{report}");
    // Values of the rig come back in its units, to the digits that were written.
    let written = rig(&mut Random::new(7), SECONDS);
    let weights: Vec<f64> = sequence
        .inputs
        .iter()
        .filter(|input| input.kind == InputKind::WeightOnBit)
        .map(|input| input.value)
        .collect();
    assert_eq!(weights.len(), written.len());
    for (read, now) in weights.iter().zip(&written) {
        assert!((read - now.weight_kn).abs() <= 0.005 * 4.45, "{read} {}", now.weight_kn);
    }
}

#[test]
fn opaque_names_are_told_apart_by_units_and_numbers_or_left_out() {
    let row = |now: &Second| {
        format!(
            "{:.2};{:.2};{:.2};{:.1};{:.2};{:.0}",
            now.time_s, now.weight_kn, now.hook_kn, now.speed_rpm, now.torque_knm, now.strokes_spm
        )
    };
    let guess = guessed(&log("A1;A2 (kN);A3 (kN);A4 (rpm);A5 (kN.m);A6", row));
    assert_eq!(
        guess.time().map(|time| time.0).as_deref(),
        Some("A1"),
        "{}",
        guess.table()
    );
    for (quantity, column, unit) in [
        (Quantity::WeightOnBit, "A2 (kN)", Unit::Kilonewton),
        (Quantity::HookLoad, "A3 (kN)", Unit::Kilonewton),
        (Quantity::RotarySpeed, "A4 (rpm)", Unit::TurnPerMinute),
        (Quantity::Torque, "A5 (kN.m)", Unit::KilonewtonMetre),
    ] {
        assert_eq!(
            of(&guess, quantity),
            Some((column, unit, Sure::Weak)),
            "{}",
            guess.table()
        );
    }
    assert!(why(&guess, "A6").contains("numbers alone"));
    // Without units, the same numbers are none that can be believed.
    let guess = guessed(&log("A1;A2;A3;A4;A5;A6", row));
    assert!(guess.proposals().is_empty(), "{}", guess.table());
    assert_eq!(guess.lacks(), ["rotary_speed", "weight_on_bit"]);
    let file = guess.mapping_file();
    assert!(file.contains("# rotary_speed:") && file.contains("\"A4\""), "{file}");
    assert!(guess.mapping().is_err());
}

#[test]
fn columns_that_were_exchanged_and_columns_that_fit_equally_are_left_out() {
    // The names of weight and speed are exchanged; the hook load shows it.
    let guess = guessed(&log("time_s,wob_kN,rpm,hookload_kN", |now| {
        format!(
            "{:.2},{:.1},{:.2},{:.2}",
            now.time_s, now.speed_rpm, now.weight_kn, now.hook_kn
        )
    }));
    assert_eq!(of(&guess, Quantity::WeightOnBit), None, "{}", guess.table());
    assert_eq!(of(&guess, Quantity::RotarySpeed), None, "{}", guess.table());
    assert!(
        why(&guess, "wob_kN").contains("mirrors the hook load"),
        "{}",
        guess.table()
    );
    // Hook load and weight are exchanged.
    let guess = guessed(&log("time_s,wob_kN,hookload_kN,rpm", |now| {
        format!(
            "{:.2},{:.1},{:.2},{:.2}",
            now.time_s, now.hook_kn, now.weight_kn, now.speed_rpm
        )
    }));
    assert!(of(&guess, Quantity::WeightOnBit).is_none(), "{}", guess.table());
    assert!(of(&guess, Quantity::HookLoad).is_none());
    // Two speeds by name: neither is chosen.
    let guess = guessed(&log("time_s,rpm,Rotary Speed (rpm),wob_kN", |now| {
        format!(
            "{:.2},{:.1},{:.1},{:.2}",
            now.time_s,
            now.speed_rpm,
            0.9 * now.speed_rpm,
            now.weight_kn
        )
    }));
    assert_eq!(of(&guess, Quantity::RotarySpeed), None);
    assert!(why(&guess, "rpm").contains("`rpm` and `Rotary Speed (rpm)` fit equally"));
    // The bit is below the end of the hole.
    let guess = guessed(&log("time_s,bit_depth_m,hole_depth_m", |now| {
        format!("{:.2},{:.2},{:.2}", now.time_s, now.hole_m, now.bit_m)
    }));
    assert!(guess.proposals().is_empty(), "{}", guess.table());
}

#[test]
fn pump_strokes_of_a_plausible_size_are_no_speed() {
    for name in [
        "SPM",
        "spm_rpm",
        "Pump 1 SPM (rpm)",
        "Strokes (1/min)",
        "Pump RPM",
        "CH4",
    ] {
        let guess = guessed(&log(&format!("time_s,{name},wob_kN,torque_kNm"), |now| {
            format!(
                "{:.2},{:.0},{:.2},{:.2}",
                now.time_s, now.strokes_spm, now.weight_kn, now.torque_knm
            )
        }));
        assert_eq!(of(&guess, Quantity::RotarySpeed), None, "{name}\n{}", guess.table());
        assert_eq!(guess.lacks(), ["rotary_speed"], "{name}");
        assert!(!why(&guess, name).is_empty());
    }
}

#[test]
fn units_that_are_missing_ambiguous_or_of_another_size_are_not_believed() {
    let row = |now: &Second| format!("{:.2},{:.1},{:.2}", now.time_s, now.speed_rpm, now.weight_kn);
    for (header, words) in [
        ("time_s,rpm,WOB", "its unit is not in the log"),
        ("time_s,rpm,WOB (ton)", "write tf for a tonne"),
        ("time_s,rpm,WOB (furlong)", "is not known"),
        ("time_s,rpm,WOB (psi)", "is none of N, kN"),
    ] {
        let guess = guessed(&log(header, row));
        let column = header.rsplit(',').next().unwrap();
        assert!(why(&guess, column).contains(words), "{}", guess.table());
        assert_eq!(of(&guess, Quantity::RotarySpeed).map(|found| found.0), Some("rpm"));
    }
    // Newtons under the name of kilonewtons.
    let guess = guessed(&log("time_s,rpm,WOB (kN)", |now| {
        format!("{:.2},{:.1},{:.0}", now.time_s, now.speed_rpm, 1e3 * now.weight_kn)
    }));
    assert!(
        why(&guess, "WOB (kN)").contains("is not that of a rig"),
        "{}",
        guess.table()
    );
    // A rate in feet under the name of metres: the depth does not grow by it.
    let guess = guessed(&log("time_s,ROP (m/h),hole_depth_m", |now| {
        format!("{:.2},{:.1},{:.3}", now.time_s, now.rate_mph / 0.3048, now.hole_m)
    }));
    let grown = rig(&mut Random::new(7), SECONDS);
    assert!(
        grown[SECONDS - 1].hole_m - grown[0].hole_m > 2.0,
        "the log is too short for this"
    );
    assert!(
        why(&guess, "ROP (m/h)").contains("one of their units is wrong"),
        "{}",
        guess.table()
    );
}

#[test]
fn las_by_time_preambles_and_decimal_commas_are_read() {
    let rows: String = rig(&mut Random::new(3), 300)
        .iter()
        .map(|now| {
            format!(
                " {:.2} {:.1} {:.2} -999.25\n",
                now.time_s,
                now.speed_rpm,
                now.weight_kn / 10.0
            )
        })
        .collect();
    let las = format!(
        "~Version\n VERS. 2.0 : LAS\n WRAP. NO : one line\n~Well\n NULL. -999.25 : no value\n~Curve\n TIME.S : time\n \
         RPMA.RPM : speed\n WOBA.KDN : weight\n TQA.KNM : torque\n~Ascii\n{rows}"
    );
    let guess = guessed(&las);
    assert!(guess.lacks().is_empty(), "{}", guess.table());
    assert_eq!(guess.time(), Some(("TIME".to_owned(), "seconds".to_owned())));
    let weight = of(&guess, Quantity::WeightOnBit).unwrap();
    assert_eq!((weight.0, weight.1), ("WOBA", Unit::Kilodecanewton));
    assert!(why(&guess, "TQA").contains("no value"), "{}", guess.table());
    read_bytes(
        "log.las".to_owned(),
        las.as_bytes(),
        &guess.mapping().unwrap(),
        &Range::ALL,
    )
    .unwrap();

    let rows: String = rig(&mut Random::new(3), 300)
        .iter()
        .map(|now| format!("{:.2};{:.1};{:.2}\n", now.time_s, now.speed_rpm, now.weight_kn).replace('.', ","))
        .collect();
    let text = format!("Rig 7\nWell: nine; ten\n\nTime;RPM;WOB\ns;r/min;kN\n{rows}");
    let guess = guessed(&text);
    assert!(guess.lacks().is_empty(), "{}", guess.table());
    let (sequence, _) = read_bytes(
        "log.csv".to_owned(),
        text.as_bytes(),
        &guess.mapping().unwrap(),
        &Range::ALL,
    )
    .unwrap_or_else(|error| panic!("{error}\n{}", guess.mapping_file()));
    assert_eq!(sequence.rows.len(), 300);
}

#[test]
fn times_that_fit_several_formats_are_left_out() {
    let rows: String = (0..60)
        .map(|row| format!("01/02/2026,11:59:{row:02},{row},40,2.5\n"))
        .collect();
    let guess = guessed(&format!("Date,Clock,n,rpm,wob_kN\n{rows}"));
    // Day and month are not known; on one day the clock alone is enough.
    assert_eq!(
        guess.time(),
        Some(("Clock".to_owned(), "time_of_day".to_owned())),
        "{}",
        guess.table()
    );
    assert!(why(&guess, "Date").contains("fit several formats equally"));
    let rows: String = (0..60).map(|row| format!("01/02/2026 11:59:{row:02},40\n")).collect();
    let guess = guessed(&format!("Date Time,rpm\n{rows}"));
    assert_eq!(guess.time(), None);
    assert!(why(&guess, "Date Time").contains("%d/%m/%Y") && why(&guess, "Date Time").contains("%m/%d/%Y"));
    // Rows a minute apart, and a fifth of a second apart, without a unit.
    for (step, words) in [(60.0, "seconds and milliseconds"), (0.2, "seconds and minutes")] {
        let rows: String = (0..60)
            .map(|row| format!("{:.1},40\n", step * f64::from(row)))
            .collect();
        let guess = guessed(&format!("Time,rpm\n{rows}"));
        assert_eq!(guess.time(), None, "{}", guess.table());
        assert!(why(&guess, "Time").contains(words), "{}", guess.table());
    }
    // A count of the rows, and a depth by steps of a foot.
    for step in [1.0, 0.3048] {
        let rows: String = (0..60)
            .map(|row| format!("{:.4},40\n", step * f64::from(row)))
            .collect();
        assert_eq!(guessed(&format!("x,rpm\n{rows}")).time(), None, "{step}");
    }
}

#[test]
fn damaged_and_foreign_files_are_refused_or_give_nothing() {
    for text in ["", "\n\n", "1,2,3\n4,5,6\n", "one line of words", "\u{0}\u{0}", "a,b\n"] {
        match guess_bytes("log.csv".to_owned(), text.as_bytes()) {
            Ok(guess) => assert!(
                guess.proposals().is_empty() && guess.time().is_none(),
                "{text:?}\n{}",
                guess.table()
            ),
            Err(error) => assert!(error.to_string().starts_with("log.csv"), "{error}"),
        }
    }
    // Names with everything that YAML and terminals read otherwise.
    let rows: String = (0..60).map(|row| format!("{row}.5,{},2.5\n", 40 + row % 3)).collect();
    let guess = guessed(&format!("\"time: #\\ 'x'\" (s),rpm,wob_kN\n{rows}"));
    assert!(!guess.table().contains('\u{1b}'));
    let guess = guessed(&format!("time {{# : }} (s),\u{1b}[2J rpm,wob_kN\n{rows}"));
    assert!(
        !guess.table().contains('\u{1b}') && !guess.mapping_file().contains('\u{1b}'),
        "{}",
        guess.table()
    );
}

#[test]
fn the_demonstration_has_no_weight_and_says_what_to_complete() {
    let guess = guess(DEMO).unwrap();
    assert_eq!(
        guess.time(),
        Some(("time_s".to_owned(), "seconds".to_owned())),
        "{}",
        guess.table()
    );
    let speed = of(&guess, Quantity::RotarySpeed).unwrap();
    assert_eq!((speed.0, speed.1), ("top_drive_rpm", Unit::TurnPerMinute));
    let hook = of(&guess, Quantity::HookLoad).unwrap();
    assert_eq!((hook.0, hook.1), ("hookload_klbf", Unit::Kilopound));
    let torque = of(&guess, Quantity::Torque).unwrap();
    assert_eq!((torque.0, torque.1), ("top_drive_torque_ftlb", Unit::FootPound));
    assert!(why(&guess, "block_height_ft").contains("block"));
    assert_eq!(guess.lacks(), ["weight_on_bit"]);
    // What the codes mean is in no log: the file has the lines to complete, and then it is the mapping of the repository.
    let file = guess.mapping_file();
    let complete: String = file
        .lines()
        .map(|line| match line.strip_prefix("  # ") {
            Some(rest) if rest.starts_with("weight_on_bit:") => format!("  {rest}\n"),
            _ => match line.strip_prefix("  #   ") {
                Some(rest) if rest.starts_with("  drilling") => format!("    {rest}\n").replace("CODES", "2"),
                Some(rest) if rest.starts_with("  off_bottom") => format!("    {rest}\n").replace("CODES", "4, 7"),
                Some(rest) => format!("    {rest}\n"),
                None => format!("{line}\n"),
            },
        })
        .collect();
    let mapping = flexdrill_field_log::Mapping::from_text("completed", &complete)
        .unwrap_or_else(|error| panic!("{error}\n{complete}"));
    let (found, _) = flexdrill_field_log::read(DEMO, &mapping).unwrap();
    let known = flexdrill_field_log::Mapping::load(DEMO.replace("demo.csv", "rig_1hz.yaml")).unwrap();
    let (expected, _) = flexdrill_field_log::read(DEMO, &known).unwrap();
    assert_eq!(found.inputs, expected.inputs);
}

#[test]
fn a_real_log_is_read_by_its_names() {
    const REAL: &str = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../../shared/data/field_log/rig_log_1hz.csv"
    );
    if !std::path::Path::new(REAL).is_file() {
        eprintln!("SKIPPED: the real log is not on this machine");
        return;
    }
    let guess = guess(REAL).unwrap();
    let columns: Vec<(Quantity, &str, Unit)> = guess
        .proposals()
        .iter()
        .map(|found| (found.quantity, &*found.column, found.unit))
        .collect();
    // As its README says; it has no weight on bit, and its depths are no columns.
    assert_eq!(
        columns,
        [
            (Quantity::RotarySpeed, "top_drive_rpm", Unit::TurnPerMinute),
            (Quantity::HookLoad, "hookload_klbf", Unit::Kilopound),
            (Quantity::Torque, "top_drive_torque_ftlb", Unit::FootPound),
            (Quantity::StandpipePressure, "spp_psi", Unit::Psi),
        ],
        "{}",
        guess.table()
    );
    assert_eq!(guess.time(), Some(("time_s".to_owned(), "seconds".to_owned())));
    assert_eq!(guess.lacks(), ["weight_on_bit"]);
    assert!(guess.mapping_file().contains("missing: [-999.25]"));
    for pump in ["spm1", "spm2"] {
        assert!(why(&guess, pump).contains("pump strokes"));
    }
}
