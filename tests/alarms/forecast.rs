//! The standing forecast over the demonstration's log: how often what came is in its bands.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use flexdrill::ahead::{Compared, Held, Least, Signal, Start, forecast, keep_priority};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::{InputKind, Inputs};
use flexdrill_core::twin::{Run, RunInputs, Simulation};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_field_log::{InputSequence, Mapping, read};
use flexdrill_outputs::schedule;

/// Time between two looks (s), and between two forecasts (s), as in the node.
const LOOK: f64 = 0.1;
const EVERY: u64 = 30;
/// Model time between two choices of the refinement (s), as in the node.
const PERIOD: f64 = 5e-3;

fn log() -> InputSequence {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("config/field_logs");
    let mapping = Mapping::load(folder.join("rig_1hz.yaml")).unwrap();
    read(folder.join("demo.csv"), &mapping).unwrap().0
}

/// Speed and weight of the log at a time (s): the newest samples at or before it.
fn at(log: &InputSequence, time: f64) -> Inputs {
    let newest = |kind| {
        let of_kind = || log.inputs.iter().filter(move |sample| sample.kind == kind);
        let sample = of_kind().take_while(|sample| sample.time <= time).last();
        sample.or(of_kind().next()).unwrap().value
    };
    Inputs {
        rotary_speed: rpm_to_rad_per_s(newest(InputKind::RotarySpeed)),
        weight_on_bit: kn_to_n(newest(InputKind::WeightOnBit)),
        ..Inputs::ZERO
    }
}

/// Runs a tool under the log, again and again, from `from` (s) for `seconds`, with a forecast of `members` every half minute.
fn held(config: &Arc<Config>, from: f64, seconds: u64, members: u32) -> Held {
    // There is no live run to yield to.
    keep_priority();
    let log = log();
    let length = log.duration;
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut run = Run::new(simulation, schedule(config, &config.outputs.rates));
    let mut snapshot = run.simulation().new_snapshot();
    let mut held = Held::new(&config.inputs);
    let step = config.solver.time_step;
    let [period, periods] = [PERIOD / step, LOOK / PERIOD].map(|count| count.round() as u64);
    let looks_per_second = (1.0 / LOOK).round() as u64;
    for look in 0..seconds * looks_per_second {
        for _ in 0..periods {
            let inputs = at(&log, (from + run.simulation().time()) % length);
            let applied = run.applied();
            let refinement = run.wanted_refinement();
            run.apply(&RunInputs {
                inputs,
                refinement,
                ..applied
            });
            for _ in 0..period {
                assert!(matches!(run.advance(), StepOutcome::Advanced { .. }));
            }
        }
        run.look(&mut snapshot);
        let time = run.ticks() as f64 * step;
        held.peaks(time, &snapshot);
        held.look(time, &snapshot);
        if (look + 1).is_multiple_of(EVERY * looks_per_second) {
            let applied = run.applied();
            let start = Start::new(Arc::clone(config), run.simulation().fork(), &applied);
            let found = forecast(&start, members, 1, 2, &AtomicBool::new(false)).unwrap();
            assert_eq!((found.members, found.failed), (members, 0), "{}", found.failure);
            let targets = [applied.inputs.rotary_speed, applied.inputs.weight_on_bit];
            held.hold(found, targets, held.widening(Least::default()));
        }
    }
    held
}

/// The share of the compared seconds that were in the published band, and in that of the members, by signal.
fn shares(held: &Held) -> Vec<(Signal, u32, f64, f64)> {
    let of = |signal| {
        let of = held.calibration().of(signal);
        let sum = |count: fn(&Compared) -> u32| of.iter().map(count).sum::<u32>();
        let compared = sum(|of| of.compared);
        let share = |inside: u32| f64::from(inside) / f64::from(compared);
        let shares = (
            signal,
            compared,
            share(sum(|of| of.inside)),
            share(sum(|of| of.inside_members)),
        );
        println!(
            "{signal:?}: {} s compared, {:.1} % in the band, {:.1} % in that of the members, widths by lead {:.2?}",
            shares.1,
            100.0 * shares.2,
            100.0 * shares.3,
            of.each_ref().map(Compared::width)
        );
        shares
    };
    Signal::ALL.map(of).into()
}

/// A part of the log from where it drills at 40 r/min, with two forecasts.
#[test]
fn what_comes_is_compared_while_speed_and_weight_stay() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let config = Arc::new(Config::load(root.join("config/coarse.yaml")).unwrap());
    let held = held(&config, 80.0, 88, 2);
    for (signal, compared, inside, _) in shares(&held) {
        // The log changes at 110, 125 and 133 s and then stays until the run ends at 168 s (of the log): the forecast of 110 s
        // ends early, and of that of 140 s at least 15 seconds have come. Never all of the 58 and 28 that were forecast.
        assert!((15..86).contains(&compared), "{signal:?}: {compared}");
        assert!((0.0..=1.0).contains(&inside), "{signal:?}: {inside}");
    }
}

/// An hour of the demonstration's log with the default tool, as `docs/measurements.md` has it: three quarters of an hour on
/// two idle cores.
///
///     cargo test --release --test alarms forecast::an_hour -- --ignored --nocapture
///
/// `FLEXDRILL_FORECAST_SECONDS` takes another length.
#[test]
#[ignore = "takes the better part of an hour"]
fn an_hour_of_the_log_is_in_the_band_nine_seconds_of_ten() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let config = Arc::new(Config::load(root.join("config/default.yaml")).unwrap());
    let seconds = std::env::var("FLEXDRILL_FORECAST_SECONDS").map_or(3600, |text| text.parse().unwrap());
    let held = held(&config, 45.0, seconds, config.look_ahead.forecast_members);
    for (signal, compared, inside, _) in shares(&held) {
        assert!(u64::from(compared) > seconds / 4, "{signal:?}: {compared}");
        assert!((0.85..=0.95).contains(&inside), "{signal:?}: {inside}");
    }
}
