//! Who may pause the model, and which sets of parameters are refused.

use super::*;
use crate::node::clocks::Clocks;
use crate::node::parameters::declare;
use flexdrill_realtime::link::{LoopEnd, PublisherEnd, Targets, link};
use std::sync::mpsc::{Receiver, channel};

struct Bench {
    control: Arc<Control>,
    store: ParameterStore,
    updates: Receiver<ParameterUpdate>,
    _solver: (LoopEnd, PublisherEnd),
}

/// A control whose solver reads no commands, as during the build of the model.
fn bench() -> Bench {
    let text = include_str!("../../../config/default.yaml");
    let config = Arc::new(Config::from_text("default.yaml", text).unwrap());
    let gauges = Arc::new(Gauges::default());
    let targets = Targets::new(config.simulation().initial_inputs);
    let (loop_end, publisher_end, commands) = link(Arc::clone(&targets), Arc::clone(&gauges));
    let (sender, updates) = channel();
    let rig_inputs = RigInputs::new(&config, targets, Clocks::new(true));
    Bench {
        store: declare(&config, "default.yaml", false),
        control: Control::new(commands, config, sender, rig_inputs, gauges),
        updates,
        _solver: (loop_end, publisher_end),
    }
}

fn set(bench: &mut Bench, key: &str, value: f64) -> Result<Vec<Parameter>, Refusal> {
    let parameter = Parameter {
        name: key.into(),
        value: ParameterValue::Double(value),
    };
    let control = Arc::clone(&bench.control);
    bench
        .store
        .set_atomically(&[parameter], |store, changed| control.apply(store, changed, "a test"))
}

#[test]
fn a_managed_node_resumes_in_the_active_state_only() {
    let control = bench().control;
    let sent = || control.commands.lock().unwrap().sent;
    for (commands, state) in [(1, "unconfigured"), (2, "inactive")] {
        control.set_inactive(Some(state)).unwrap();
        let refused = control.answer_pause(false);
        assert!(
            !refused.success && refused.message.contains(state) && refused.message.contains("activate"),
            "{}",
            refused.message
        );
        assert_eq!(sent(), commands, "a refused request reaches the solver");
    }
    assert!(control.answer_pause(true).success, "an inactive node may be paused");
    control.set_inactive(None).unwrap();
    // Its state says that it computes.
    let refused = control.answer_pause(true);
    assert!(
        !refused.success && refused.message.contains("deactivate"),
        "{}",
        refused.message
    );
    assert!(control.answer_pause(false).success);
    assert_eq!(sent(), 5);
}

/// A set that the queue has no room for is refused and changes nothing, since "successful" means that the values act.
#[test]
fn what_cannot_be_passed_on_is_refused_and_changes_nothing() {
    let mut bench = bench();
    let key = "contact.inner.friction_axial";
    let friction = |number: u32| 0.2 + 1e-4 * f64::from(number);
    let mut accepted = 0;
    let refusal = loop {
        match set(&mut bench, key, friction(accepted + 1)) {
            Ok(_) => accepted += 1,
            Err(refusal) => break refusal.to_string(),
        }
    };
    // One command per set.
    assert!(accepted >= 120, "{accepted}");
    assert!(
        refusal.contains("cannot be passed on") && refusal.contains("nothing was changed"),
        "{refusal}"
    );
    assert_eq!(bench.store.number(key), Some(friction(accepted)));
    assert_eq!(bench.control.config().contact.inner.friction_axial, friction(accepted));
    let updates: Vec<ParameterUpdate> = bench.updates.try_iter().collect();
    assert_eq!(updates.len(), accepted as usize);
    for (number, change) in (1..).zip(&updates) {
        assert_eq!(change.command, number);
        let expected = ParameterChange {
            name: key.to_owned(),
            value: friction(number as u32),
            asked_by: "a test".to_owned(),
        };
        assert_eq!(change.values, [expected]);
    }
}

/// One call must not empty the recording, nor make the model of a silent rig rotate.
#[test]
fn no_parameter_takes_an_output_out_of_the_recording() {
    use flexdrill_core::twin::Output;
    let mut bench = bench();
    for key in ["outputs.rates.status", "outputs.rates.diagnostics"] {
        let refusal = set(&mut bench, key, 0.0).unwrap_err().to_string();
        assert!(refusal.contains("must be 1 to 1000 Hz"), "{refusal}");
    }
    for (key, value) in [
        ("inputs.rotary_speed.safe_rpm", 120.0),
        ("inputs.weight_on_bit.safe_kn", 60.0),
    ] {
        let refusal = set(&mut bench, key, value).unwrap_err().to_string();
        assert!(refusal.contains("must be at most 0"), "{refusal}");
    }
    for (key, output, rate) in [
        ("outputs.rates.contact_forces", Output::ContactForces, 50.0),
        ("outputs.rates.whirl", Output::Whirl, 10.0),
    ] {
        // The recording keeps its rate where the output is switched off or slowed down, and follows a higher rate.
        for (live, recorded) in [(0.0, rate), (1.0, rate), (100.0, 100.0)] {
            set(&mut bench, key, live).unwrap();
            let sent = settings(&bench.control.config(), &bench.control.initial_rates);
            assert_eq!(sent.schedule.rate(output, 0.5e-3), recorded, "{key} = {live} Hz");
        }
    }
}

#[test]
fn hard_limits_hold_for_every_client() {
    let mut bench = bench();
    let key = "inputs.rotary_speed.max_rpm";
    let refusal = set(&mut bench, key, 1000.0).unwrap_err().to_string();
    assert!(refusal.contains("inputs.hard_limits.max_rpm"), "{refusal}");
    // The limit holds for several changes, too.
    set(&mut bench, key, 300.0).unwrap();
    let refusal = set(&mut bench, key, 300.5).unwrap_err().to_string();
    assert!(refusal.contains("at most 300 r/min"), "{refusal}");
    assert_eq!(bench.store.number(key), Some(300.0));
    assert_eq!(bench.store.describe(key).floating_point_range[0].to_value, 300.0);
    assert_eq!(bench.updates.try_iter().count(), 1);
}
