use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock};

use super::*;
use crate::messages::Bands;
use flexdrill_calibration::residual::RigQuantity;
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::twin::{Run, RunInputs, Simulation};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_outputs::figures::OverTools;
use flexdrill_uncertainty::Posterior;

mod factors;
mod fork;
mod measured;

/// A short tool in a nearly horizontal hole under ten times the weight, so that friction takes much of its torque, with what
/// is not known of it. Steps are few and whole: what is tested here is the ensemble, not the mechanics.
const TOOL: &str = "\
well: {start_inclination_deg: 70, sections: [{arc: {radius: 6.4, build_angle_deg: 9}}], hole_diameter: 0.118}
tool:
  links: 6
  elements_per_link: 2
  pipe: {outer_diameter: 0.063, inner_diameter: 0.032}
  guide: {outer_diameter: 0.102, inner_diameter: 0.080}
  joint: {limit_deg: 6.0}
  bit: {diameter: 0.118}
contact: {inner: {friction_tangential: 0.4, friction_axial: 0.4}}
environment: {gravity: 100}
solver: {time_step: 0.001, step: fixed}
calibration: {torque_noise_nm: 1, torque_drift_nm: 0.1, torque_tare_range_nm: 1, model_error: 0.01}
";
/// Steps per second.
const SECOND: u64 = 1000;

fn config(uncertainty: &str, members: u32) -> Arc<Config> {
    let text = format!("{TOOL}uncertainty:\n{uncertainty}\nensemble: {{members: {members}}}\n");
    Arc::new(Config::from_text("tool.yaml", &text).unwrap())
}

/// Friction of both layers between 0.2 and 0.6, from one draw.
const FRICTION: &str = "  keys:
    - key: contact.inner.friction_tangential
      also: [contact.inner.friction_axial, contact.outer.friction_tangential, contact.outer.friction_axial]
      distribution: {uniform: {low: 0.2, high: 0.6}}
      source: a test";

static WIDE: LazyLock<Arc<Config>> = LazyLock::new(|| config(FRICTION, 12));

/// A rotary speed (r/min) and a weight on bit (kN) that act from these ticks on.
fn acts(config: &Config, from: u64, speed: f64, weight: f64) -> (u64, RunInputs) {
    let simulation = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let mut applied = Run::new(simulation, flexdrill_outputs::schedule(config, &config.outputs.rates)).applied();
    applied.inputs.rotary_speed = rpm_to_rad_per_s(speed);
    applied.inputs.weight_on_bit = kn_to_n(weight);
    (from, applied)
}

fn told(config: &Arc<Config>, (ticks, inputs): (u64, RunInputs)) -> Told {
    Told::Applied(ticks, Box::new(inputs), Arc::clone(config))
}

fn ensemble(config: &Arc<Config>) -> Ensemble {
    Ensemble::of(config, None).unwrap().unwrap()
}

fn generation(members: u32) -> Generation {
    Generation {
        members,
        ..Generation::default()
    }
}

/// The ensemble of a configuration whose members act under the first of a plan from the beginning on.
fn begun(config: &Arc<Config>, plan: &[(u64, RunInputs)], members: u32) -> Ensemble {
    let mut ensemble = ensemble(config);
    ensemble.hear(told(config, plan[0]));
    ensemble.hear(Told::Reached(1));
    ensemble.begin(generation(members));
    plan[1..].iter().for_each(|acts| ensemble.hear(told(config, *acts)));
    ensemble
}

/// Lets an ensemble hear what a rig measures in a second, where the twin computes `predicted`, and run up to its end.
fn second_of(
    ensemble: &mut Ensemble,
    second: usize,
    steady: bool,
    predicted: &[f64; RigQuantity::COUNT],
    measured: &[(RigQuantity, f64)],
) -> Vec<Found> {
    let ticks = SECOND * (second as u64 + 1);
    let mut compared = Compared {
        step: 1.0,
        steady,
        drilling: true,
        measured: [f64::NAN; RigQuantity::COUNT],
        predicted: *predicted,
    };
    for (quantity, value) in measured {
        compared.measured[*quantity as usize] = *value;
    }
    ensemble.hear(Told::Compared(ticks, compared));
    ensemble.hear(Told::Reached(ticks));
    found_seconds(ensemble, 2)
}

/// All slices that are due.
fn found_seconds(ensemble: &mut Ensemble, count: usize) -> Vec<Found> {
    let threads = Threads { count, idle: false };
    let mut all = Vec::new();
    while ensemble.is_due() {
        all.extend(ensemble.slice(threads, &AtomicBool::new(false)));
    }
    all
}

/// The bands of all slices that are due.
fn found(ensemble: &mut Ensemble, count: usize) -> Vec<Bands> {
    found_seconds(ensemble, count)
        .into_iter()
        .map(|found| found.bands)
        .collect()
}

/// p5, p50 and p95 of a figure.
fn band(bands: &Bands, name: &str) -> [f64; 3] {
    let band = bands
        .bands
        .iter()
        .find(|band| band.name == name)
        .unwrap_or_else(|| panic!("{name}: {bands:?}"));
    [band.p5, band.p50, band.p95]
}

/// Bands without what they say of sensors.
fn believing(bands: Bands) -> Bands {
    Bands {
        distrusted: Vec::new(),
        distrusted_why: Vec::new(),
        ..bands
    }
}

/// The bytes of messages: values that are not known are not equal to themselves.
fn bytes(all: &[Bands]) -> Vec<Vec<u8>> {
    all.iter()
        .map(|bands| crate::messages::to_cdr(bands).unwrap())
        .collect()
}

/// What the twin itself does: seconds of its figures and of what the rig would measure, under what acts.
fn run(config: &Config, applied: &[(u64, RunInputs)], seconds: u64) -> Vec<(Vec<f64>, [f64; RigQuantity::COUNT])> {
    // A node begins with its initial inputs, which are the first that act.
    let settings = config
        .simulation()
        .with(|settings| settings.initial_inputs = applied[0].1.inputs);
    let simulation = Simulation::new(&config.tool(), &settings).unwrap();
    let mut run = Run::new(simulation, flexdrill_outputs::schedule(config, &config.outputs.rates));
    let mut snapshot = run.simulation().new_snapshot();
    let mut figures = OverTools::default();
    let (mut all, mut applied) = (Vec::new(), applied.iter().peekable());
    for tick in 0..seconds * SECOND {
        while let Some((_, inputs)) = applied.next_if(|(at, _)| *at <= tick) {
            let refinement = run.applied().refinement;
            let live = config.live();
            run.apply(&RunInputs {
                refinement,
                live,
                ..*inputs
            });
        }
        if tick.is_multiple_of(SECOND / 200) {
            let (refinement, now) = (run.wanted_refinement(), run.applied());
            run.apply(&RunInputs { refinement, ..now });
        }
        assert!(matches!(run.advance(), StepOutcome::Advanced { .. }));
        if (tick + 1).is_multiple_of(SECOND / 10) {
            run.look(&mut snapshot);
            figures.add(&snapshot);
        }
        if (tick + 1).is_multiple_of(SECOND) {
            all.push((figures.take(), crate::residuals::predicted(&snapshot)));
        }
    }
    all
}

/// Where nothing is unknown every member does what the twin does.
#[test]
fn members_of_a_known_tool_do_what_the_twin_does() {
    let known =
        "  keys: [{key: calibration.torque_noise_nm, distribution: {uniform: {low: 1, high: 2}}, source: a test}]";
    let config = config(known, 8);
    let plan = [
        acts(&config, 0, 60.0, 6.0),
        acts(&config, 2001, 80.0, 8.0),
        acts(&config, 3999, 40.0, 8.0),
    ];
    let mut ensemble = ensemble(&config);
    for applied in plan {
        ensemble.hear(told(&config, applied));
    }
    ensemble.hear(Told::Reached(6 * SECOND));
    ensemble.begin(generation(8));
    let all = found(&mut ensemble, 2);
    let twin = run(&config, &plan, 6);
    assert_eq!(all.len(), twin.len());
    for (second, (bands, (figures, _))) in all.iter().zip(&twin).enumerate() {
        for (known, value) in OverTools::known().iter().zip(figures) {
            let [low, middle, high] = band(bands, &known.name);
            // A quantile between equal values rounds.
            let close = |end: f64| (end - value).abs() <= 1e-12 * value.abs();
            let same = [low, middle, high].into_iter().all(close) || !value.is_finite() && middle.is_nan();
            assert!(
                same,
                "{} at {second} s: {low} {middle} {high}, twin {value}",
                known.name
            );
        }
    }
}

/// A calibration that has found the friction draws members near it, whose bands lie about the run of the tool with it;
/// without its file nothing is drawn.
#[test]
fn members_are_drawn_from_what_a_calibration_has_found() {
    const FOUND: f64 = 0.3;
    let key = "contact.inner.friction_tangential";
    let wide = &*WIDE;
    let ensemble_of = flexdrill_config::Ensemble {
        from: flexdrill_config::DrawnFrom::Posterior("posterior.csv".to_owned()),
        ..wide.ensemble.clone().unwrap()
    };
    let section = serde_json::to_string(&ensemble_of).unwrap();
    let text = format!("{TOOL}uncertainty:\n{FRICTION}\nensemble: {section}\n");
    let config = Arc::new(Config::from_text("tool.yaml", &text).unwrap());
    let missing = Ensemble::of(&config, None).err().unwrap().to_string();
    assert!(missing.contains("posterior.csv"), "{missing}");

    let provenance = flexdrill_uncertainty::posterior::Provenance {
        tool: config.tool_hash([key]),
        configuration: config.hash(),
        sha256: "ab".repeat(32),
        rows: [1, 100],
        ..Default::default()
    };
    let rows: Vec<(f64, [f64; 1])> = (0..40)
        .map(|k| (1.0, [FOUND + 0.0005 * (f64::from(k) - 19.5)]))
        .collect();
    let rows = rows.iter().map(|(weight, values)| (*weight, values.as_slice()));
    let csv = flexdrill_uncertainty::posterior::to_csv(&provenance, &[key], rows);
    let posterior = Posterior::from_csv("posterior.csv", csv.as_bytes()).unwrap();
    posterior.belongs_to(&config).unwrap();

    let plan = acts(&config, 0, 60.0, 8.0);
    let bands_of = |mut ensemble: Ensemble, config: &Arc<Config>| {
        ensemble.hear(told(config, plan));
        ensemble.hear(Told::Reached(4 * SECOND));
        ensemble.begin(generation(12));
        found(&mut ensemble, 2)
    };
    let drawn = Ensemble::of(&config, Some(Arc::new(posterior))).unwrap().unwrap();
    let (near, prior) = (bands_of(drawn, &config), bands_of(ensemble(wide), wide));
    let keys = [
        key,
        "contact.inner.friction_axial",
        "contact.outer.friction_tangential",
        "contact.outer.friction_axial",
    ];
    let tool = wide.with_values("a test", keys.map(|key| (key, FOUND))).unwrap();
    let figures = &run(&tool, &[plan], 4)[3].0;
    let name = "transfer/kickoff_torque";
    let index = OverTools::known().iter().position(|known| known.name == name).unwrap();
    let ([low, middle, high], [from, _, to]) = (band(&near[3], name), band(&prior[3], name));
    // The sample is 0.02 wide and scatters by a tenth of that; the prior is 0.4 wide.
    assert!(high - low < 0.15 * (to - from), "{low} to {high}, prior {from} to {to}");
    let value = figures[index];
    assert!((low..=high).contains(&value), "{low} {middle} {high}: {value}");
}

/// Pieces, order of arrival and threads change nothing; neither do speeds, a change of a parameter, or a reset.
#[test]
fn bands_follow_from_what_is_heard_alone() {
    let config = &*WIDE;
    let values = [("tool.bit.friction_factor", 0.5), ("whirl.hysteresis", 0.2)];
    let changed = Arc::new(config.with_live_values("a test", values).unwrap());
    let mut reset = acts(config, 3500, 50.0, 6.0);
    reset.1.reset = true;
    let plan = [
        told(config, acts(config, 0, 60.0, 8.0)),
        told(&changed, acts(&changed, 1666, 90.0, 8.0)),
        told(&changed, reset),
    ];
    let mut at_once = ensemble(config);
    plan.iter().cloned().for_each(|told| at_once.hear(told));
    at_once.hear(Told::Reached(5000));
    at_once.begin(generation(12));
    let whole = found(&mut at_once, 1);

    let mut piecewise = ensemble(config);
    piecewise.hear(plan[0].clone());
    piecewise.hear(Told::Reached(1));
    piecewise.begin(generation(12));
    let mut pieces = Vec::new();
    for (index, until) in [350, 1666, 1667, 3499, 4500, 5000].into_iter().enumerate() {
        match index {
            1 => piecewise.hear(plan[1].clone()),
            3 => piecewise.hear(plan[2].clone()),
            _ => {}
        }
        piecewise.hear(Told::Reached(until));
        pieces.extend(found(&mut piecewise, 3));
    }
    assert_eq!(whole.len(), 5);
    assert!(bytes(&whole) == bytes(&pieces));
    let [low, _, high] = band(&whole[4], "transfer/bit_torque");
    assert!(low.is_finite() && high > low, "{low} to {high}");
}

/// A tool that cannot be computed is unknown: it is counted, in no band, and others take its place.
#[test]
fn a_member_that_fails_is_counted_and_replaced() {
    // In whole steps of few iterations the stiffest draws have no solution.
    let stiff = "  keys:
    - {key: contact.outer.stiffness, distribution: {log_normal: {low: 1.0e+4, high: 1.0e+12}}, source: a test}";
    let few = TOOL.replace("step: fixed", "step: fixed, max_iterations: 4, max_halvings: 0");
    let text = format!("{few}uncertainty:\n{stiff}\nensemble: {{members: 10}}\n");
    let config = Arc::new(Config::from_text("tool.yaml", &text).unwrap());
    let mut ensemble = ensemble(&config);
    ensemble.hear(told(&config, acts(&config, 0, 120.0, 10.0)));
    ensemble.hear(told(&config, acts(&config, 110 * SECOND, 60.0, 10.0)));
    ensemble.hear(Told::Reached(SECOND * 121));
    ensemble.begin(generation(10));
    let all = found(&mut ensemble, 2);
    let failed: Vec<u32> = all.iter().map(|bands| bands.failed).collect();
    let most = failed.iter().copied().max().unwrap();
    assert!(most > 0 && most < 8, "{failed:?}");
    assert_eq!(all[70].prepared, all[59].failed, "{failed:?}");
    assert!(all[119].failed < all[118].failed, "{failed:?}");
    // A prepared member begins to count with one second, at 60 r/min, and not with its minute, most of it at 120 r/min.
    let [_, _, fastest] = band(&all[119], "bit_state/rotary_speed");
    assert!(fastest < 1.2 * rpm_to_rad_per_s(60.0), "{fastest} rad/s");
    for bands in &all {
        assert!(
            (bands.effective + f64::from(bands.failed) - 10.0).abs() < 1e-6,
            "{bands:?}"
        );
        assert!(bands.any_alarm_upper <= 1.0 && bands.any_alarm_lower >= 0.0);
    }
}

/// Where the twin does not wait and the ensemble falls behind, fewer members begin; where too few are left there are words.
#[test]
fn an_ensemble_that_falls_behind_begins_anew_with_fewer() {
    for (members, words) in [
        (12, ""),
        (8, "has fallen 30 s behind with 8 plausible tools, and bands need 8"),
    ] {
        let config = config(FRICTION, members);
        let mut running = Running::start(ensemble(&config), Pace::Clock).unwrap();
        running.tell(told(&config, acts(&config, 0, 60.0, 8.0)));
        running.reached(SECOND * 45);
        running.reached(SECOND * 47);
        let deadline = std::time::Instant::now() + std::time::Duration::from_secs(60);
        let found = loop {
            if let Some(found) = running.take().filter(|found| found.begun > 0) {
                break found;
            }
            assert!(std::time::Instant::now() < deadline);
            std::thread::sleep(std::time::Duration::from_millis(5));
        };
        assert_eq!(found.bands.members, if words.is_empty() { 9 } else { 0 });
        assert!(found.bands.no_bands.contains(words), "{}", found.bands.no_bands);
        assert_eq!(found.bands.no_bands.is_empty(), words.is_empty());
        assert!(found.begun >= SECOND * 44 && found.ticks > found.begun);
    }
}

/// A recorded run's members are taken from its recording, also those that began later.
#[test]
fn a_replay_has_the_members_of_the_recorded_run() {
    let config = &*WIDE;
    let recorded = vec![
        generation(9),
        Generation {
            begun: 2000,
            members: 0,
            why: "a reason".to_owned(),
        },
    ];
    let mut running = Running::start(ensemble(config), Pace::Waits(recorded)).unwrap();
    running.tell(told(config, acts(config, 0, 60.0, 8.0)));
    running.reached(4000);
    running.finish();
    let found: Vec<_> = std::iter::from_fn(|| running.take()).collect();
    let members: Vec<_> = found
        .iter()
        .map(|found| (found.ticks, found.begun, found.bands.members))
        .collect();
    assert_eq!(members, [(1000, 0, 9), (2000, 0, 9), (3000, 2000, 0), (4000, 2000, 0)]);
    assert_eq!(found[3].bands.no_bands, "a reason");
}

/// Members that began long after the run are waited for, and nothing before them.
#[test]
fn a_replay_does_not_wait_for_members_that_have_not_begun() {
    let config = &*WIDE;
    let late = Generation {
        begun: 15 * SECOND,
        ..generation(8)
    };
    let mut running = Running::start(ensemble(config), Pace::Waits(vec![late])).unwrap();
    running.tell(told(config, acts(config, 0, 60.0, 8.0)));
    for second in 1..=17 {
        running.reached(second * SECOND);
    }
    running.finish();
    let ticks: Vec<u64> = std::iter::from_fn(|| running.take()).map(|found| found.ticks).collect();
    assert_eq!(ticks, [16 * SECOND, 17 * SECOND]);
}

/// What the rig measured before members began weighs none of them.
#[test]
fn members_that_begin_later_know_nothing_of_what_was_measured_before() {
    let config = &*WIDE;
    let mut ensemble = ensemble(config);
    ensemble.hear(told(config, acts(config, 0, 60.0, 8.0)));
    for second in 1..20 {
        let compared = Compared {
            step: 1.0,
            steady: true,
            drilling: true,
            measured: [1e3; RigQuantity::COUNT],
            predicted: [1.0; RigQuantity::COUNT],
        };
        ensemble.hear(Told::Compared(second * SECOND, compared));
    }
    ensemble.hear(Told::Reached(41 * SECOND));
    ensemble.begin(Generation {
        begun: 20 * SECOND,
        ..generation(8)
    });
    let all = found(&mut ensemble, 2);
    assert_eq!(all.len(), 21);
    assert!((all[20].effective - 8.0).abs() < 1e-9, "{}", all[20].effective);
}

/// A parameter that a client changes acts on members that are not built yet, too.
#[test]
fn a_change_before_a_member_is_built_acts_on_it() {
    let config = &*WIDE;
    let doubled = 2.0 * config.tool.bit.friction_factor;
    let values = [("tool.bit.friction_factor", doubled)];
    let changed = Arc::new(config.with_live_values("a test", values).unwrap());
    let torque = |from: u64, changed: &Arc<Config>| {
        let mut ensemble = ensemble(config);
        ensemble.hear(told(config, acts(config, 0, 60.0, 8.0)));
        ensemble.hear(Told::Reached(1));
        ensemble.begin(generation(8));
        ensemble.hear(told(changed, acts(changed, from, 60.0, 8.0)));
        ensemble.hear(Told::Reached(8 * SECOND));
        band(&found(&mut ensemble, 2)[7], "bit_state/torque")[1]
    };
    // The torque of Eq. 1 is proportional to the factor.
    let ratio = torque(SECOND / 10, &changed) / torque(SECOND / 10, config);
    assert!((ratio - 2.0).abs() < 0.1, "{ratio}");
}
