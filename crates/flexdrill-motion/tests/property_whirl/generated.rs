//! Generated orbits: how often their kind is found, and what a sample costs.

use super::*;

/// A reset forgets motion and level, and the sequence goes on; so it does after a return to an older state.
#[test]
fn reset_and_restore_leave_no_ghosts() {
    let orbit = rotor(1.02 * CLEARANCE, -63.0 / 17.0 * SPEED);
    let mut bench = Bench::new();
    let early = bench.analysis.clone();
    for step in 0..3000 {
        bench.push(SPEED, orbit(f64::from(step) * SAMPLE_INTERVAL), 25e3);
    }
    let before = bench.analysis.level();
    assert_eq!(before.severity, Severity::Critical);
    bench.analysis.reset();
    let after = bench.analysis.level();
    assert_eq!((after.severity, after.kind), (Severity::Ok, WhirlKind::None));
    assert_eq!(after.sequence, before.sequence + 1);
    // The same motion from the model's new beginning gives what the first run gave.
    let (mut again, mut first) = (Bench::new(), Bench::new());
    again.analysis = bench.analysis;
    for step in 0..2000 {
        again.push(SPEED, orbit(f64::from(step) * SAMPLE_INTERVAL), 25e3);
        first.push(SPEED, orbit(f64::from(step) * SAMPLE_INTERVAL), 25e3);
        // By what they print: no ratio is NaN, which is not equal to itself.
        assert_eq!(
            format!("{:?}", again.report),
            format!("{:?}", first.report),
            "step {step}"
        );
    }
    let mut restored = early;
    restored.continue_sequence(before.sequence);
    assert!(restored.level().sequence > before.sequence);
}

/// A checkpoint goes on with the same bits.
#[test]
fn serialised_state_continues_bit_for_bit() {
    let mut random = Random(5);
    let orbit = circle(0.7 * CLEARANCE, 2.3 * SPEED, &mut random);
    let mut one = Bench::new();
    one.run(SPEED, 7.3, |time| orbit.at(time));
    let state = serde_json::to_value(&one.analysis).unwrap();
    let mut other = Bench::new();
    other.run(SPEED, 7.3, |_| [0.0; 2]);
    other.analysis = serde_json::from_value(state).unwrap();
    for bench in [&mut one, &mut other] {
        bench.run(SPEED, 3.0, |time| orbit.at(time + 7.3));
    }
    let states = [&one, &other].map(|bench| serde_json::to_value(&bench.analysis).unwrap());
    assert!(states[0] == states[1]);
    assert_eq!(format!("{:?}", one.report), format!("{:?}", other.report));
}

/// 2,000 generated orbits of each of five seeds, with noise 20 dB below the motion. Thresholds were set with other
/// seeds (2024, 1, 2, 3). Prints the table that `docs/whirl.md` shows (`cargo test --release -p flexdrill-motion --test
/// property_whirl confusion -- --nocapture`).
#[test]
fn confusion_table_of_generated_orbits() {
    const COUNT: usize = 2000;
    const SEEDS: [u64; 5] = [101, 102, 103, 104, 105];
    let kinds = [
        WhirlKind::None,
        WhirlKind::Forward,
        WhirlKind::Backward,
        WhirlKind::Chaotic,
        WhirlKind::JointVibration,
    ];
    let mut table = [[0u32; 5]; 5];
    let mut families: BTreeMap<&str, [u32; 2]> = BTreeMap::new();
    let mut ratio_errors = Vec::new();
    let mut worst = 1.0f64;
    for seed in SEEDS {
        let mut random = Random(seed);
        let mut right_of_seed = 0;
        for index in 0..COUNT {
            let labelled = Labelled::generate(index, &mut random);
            let mut bench = Bench::new();
            let got = labelled.run(&mut bench, &mut Random(seed << 32 | index as u64));
            table[labelled.kind as usize][got as usize] += 1;
            let right = got == labelled.kind;
            right_of_seed += u32::from(right);
            let counts = families.entry(labelled.family).or_default();
            counts[0] += u32::from(right);
            counts[1] += 1;
            if let (true, Some(ratio)) = (right, labelled.ratio) {
                ratio_errors.push((bench.ratio() / ratio - 1.0).abs());
            }
        }
        let part = f64::from(right_of_seed) / COUNT as f64;
        println!("seed {seed}: {right_of_seed} of {COUNT} right, {:.2} %", 100.0 * part);
        worst = worst.min(part);
    }
    println!("| is \\ called | none | forward | backward | chaotic | joint vibration |");
    for (kind, row) in kinds.iter().zip(&table) {
        let name = format!("{kind:?}").to_lowercase();
        println!(
            "| {name} | {} | {} | {} | {} | {} |",
            row[0], row[1], row[2], row[3], row[4]
        );
    }
    for (family, [right, count]) in &families {
        println!("| {family} | {right} of {count} |");
    }
    ratio_errors.sort_by(f64::total_cmp);
    let at = |part: f64| ratio_errors[(part * (ratio_errors.len() - 1) as f64) as usize];
    println!(
        "ratio error: median {:.4}, 95 % {:.4}, 99 % {:.4}",
        at(0.5),
        at(0.95),
        at(0.99)
    );
    assert!(worst >= 0.99, "{worst}");
}

/// Time per sample of 64 stations, half of which orbit with two lines and half of which rest, as the pipe's and the
/// guide's do. Prints the figure of `docs/whirl.md`; a quiet core is needed for it.
#[test]
#[ignore = "a measurement: cargo test --release -p flexdrill-motion --test property_whirl cost -- --ignored --nocapture"]
fn cost_of_a_sample() {
    const STATIONS: usize = 64;
    let watched = |index: usize| WatchedStation {
        station: index,
        body: Body::Pipe,
        measured_depth: 0.0,
        inclination: 0.0,
        clearance: CLEARANCE,
        body_diameter: 63e-3,
        length: 0.0305,
    };
    let mut analysis = WhirlAnalysis::new(
        &WhirlSettings::default(),
        SAMPLE_INTERVAL,
        (0..STATIONS).map(watched).collect(),
    );
    let mut samples = [StationSample::default(); STATIONS];
    let (mut best, mut step) = (f64::MAX, 0u32);
    for _ in 0..30 {
        let mut spent = 0.0;
        for _ in 0..500 {
            step += 1;
            let time = f64::from(step) * SAMPLE_INTERVAL;
            for (index, sample) in samples.iter_mut().enumerate().step_by(2) {
                let ([a, b], [c, d]) = (
                    rotor(0.6 * CLEARANCE, (0.5 + 0.1 * index as f64) * SPEED)(time),
                    rotor(0.3 * CLEARANCE, -1.7 * SPEED)(time),
                );
                (sample.y, sample.z) = (a + c, b + d);
            }
            let start = std::time::Instant::now();
            analysis.push(time, SPEED, &samples);
            spent += start.elapsed().as_secs_f64();
        }
        // The windows are full.
        if step > 2000 {
            best = f64::min(best, spent / 500.0);
        }
    }
    println!("{:.1} us per sample of {STATIONS} stations", 1e6 * best);
}
