//! The parameters that follow the comparison of rig and twin (`calibration.follow`) in the node. They change by the path of every parameter, [`Parameters`], so that the change is checked, logged, published on `/parameter_events` and
//! recorded with the applied inputs.

use std::sync::{Arc, Weak};

use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use super::control::{Control, Restore};
use crate::residuals::{FOLLOW, FOLLOWED, followed};
use flexdrill_ros2::parameters::{Parameter, ParameterValue, Parameters};
use flexdrill_ros2::service::Task;

/// Who asks for the configured values at a reset.
const RESET: &str = "the reset of the model";

/// Takes the values of [`FOLLOWED`] in force and those that are to be.
pub type Moves = UnboundedSender<[[f64; 2]; 2]>;

fn parameters_of(values: [f64; 2]) -> [Parameter; 2] {
    [0, 1].map(|k| Parameter {
        name: FOLLOWED[k].to_owned(),
        value: ParameterValue::Double(values[k]),
    })
}

/// The task that sets the parameters, off the publisher's thread, and where it takes the moves. `control` sets them back
/// before a reset.
pub fn serve(parameters: &Arc<Parameters>, control: &Control) -> (Moves, Task) {
    if control.first_config().calibration.follow {
        control.restore_with(restore(parameters, followed(control.first_config())));
    }
    let (moves, taken) = unbounded_channel();
    (moves, Box::pin(follow(Arc::clone(parameters), taken)))
}

async fn follow(parameters: Arc<Parameters>, mut moves: UnboundedReceiver<[[f64; 2]; 2]>) {
    while let Some([from, to]) = moves.recv().await {
        let changed: Vec<Parameter> = (0..2)
            .filter(|k| from[*k] != to[*k])
            .map(|k| parameters_of(to)[k].clone())
            .collect();
        // A value that is no longer the one that was compared was changed meanwhile, by a client or a reset: the next
        // comparison knows it. A refusal is logged with its reason.
        let _ = parameters.set_from(&parameters_of(from), &changed, FOLLOW);
    }
}

/// Sets the configured values. The parameters call the control, so that it does not own them.
fn restore(parameters: &Arc<Parameters>, configured: [f64; 2]) -> Box<Restore> {
    let parameters: Weak<Parameters> = Arc::downgrade(parameters);
    Box::new(move || {
        let Some(parameters) = parameters.upgrade() else {
            return Ok(());
        };
        let configured = parameters_of(configured);
        let is_set =
            |parameter: &Parameter| parameters.with(|store| store.get(&parameter.name) == Some(&parameter.value));
        if configured.iter().all(is_set) {
            return Ok(());
        }
        parameters.set_from(&[], &configured, RESET).map(drop)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::node::clocks::Clocks;
    use crate::node::control::ParameterUpdate;
    use crate::node::inputs::RigInputs;
    use crate::node::parameters::declare;
    use flexdrill_config::Config;
    use flexdrill_realtime::link::{Command, Gauges, RequestEnd, Targets, link};
    use flexdrill_ros2::dds::network::Network;
    use flexdrill_ros2::dds::port::PortBuilder;
    use std::sync::mpsc::{Receiver, channel};

    /// A control and its parameters, with the commands that a solver would get.
    struct Bench {
        control: Arc<Control>,
        parameters: Arc<Parameters>,
        updates: Receiver<ParameterUpdate>,
        solver: rtrb::Consumer<Command>,
    }

    fn bench() -> Bench {
        let text = include_str!("../../config/default.yaml");
        let config = Config::from_text("default.yaml", text).unwrap();
        let config = Arc::new(config.with_value("calibration.follow", true).unwrap());
        let gauges = Arc::new(Gauges::default());
        let targets = Targets::new(config.simulation().initial_inputs);
        let (_, _, requests) = link(Arc::clone(&targets), Arc::clone(&gauges));
        let (commands, solver) = rtrb::RingBuffer::new(8);
        let requests = RequestEnd { commands, ..requests };
        let (sender, updates) = channel();
        let inputs = RigInputs::new(&config, targets, Clocks::new(true));
        let control = Control::new(requests, Arc::clone(&config), sender, inputs, gauges);
        let (network, _) = Network::read(Some(0), |_| None).unwrap();
        let mut port = PortBuilder::new(&network, "/", "test");
        let applying = Arc::clone(&control);
        let parameters = Parameters::new(
            &mut port,
            "/test".to_owned(),
            declare(&config, "default.yaml", false),
            Box::new(move |candidate, changed, requester| applying.apply(candidate, changed, requester)),
            |_| String::new(),
        );
        Bench {
            control,
            parameters,
            updates,
            solver,
        }
    }

    #[tokio::test]
    async fn a_move_acts_from_where_it_was_made_only_and_a_reset_takes_it_back() {
        let mut bench = bench();
        let (moves, task) = serve(&bench.parameters, &bench.control);
        // The second begins where a client or a reset has changed the value meanwhile.
        moves.send([[1.0, 0.0], [1.01, 0.5]]).unwrap();
        moves.send([[1.2, 0.5], [1.21, 0.5]]).unwrap();
        moves.send([[1.01, 0.5], [1.02, 0.5]]).unwrap();
        // It refuses what the limits of the configuration do not allow.
        moves.send([[1.02, 0.5], [2.5, 0.5]]).unwrap();
        drop(moves);
        task.await;
        assert_eq!(followed(&bench.control.config()), [1.02, 0.5]);
        let changes: Vec<_> = bench.updates.try_iter().flat_map(|update| update.values).collect();
        let named: Vec<_> = changes
            .iter()
            .map(|change| (change.name.as_str(), change.value))
            .collect();
        assert_eq!(named, [(FOLLOWED[0], 1.01), (FOLLOWED[1], 0.5), (FOLLOWED[0], 1.02)]);
        assert!(changes.iter().all(|change| change.asked_by == FOLLOW));

        bench.control.reset().unwrap();
        assert_eq!(followed(&bench.control.config()), [1.0, 0.0]);
        let restored = bench.updates.try_iter().next().unwrap();
        assert!(
            restored.values.iter().all(|change| change.asked_by == RESET),
            "{restored:?}"
        );
        // The solver has the configured friction before it resets: the product of coefficient and factor acts.
        let configured = bench.control.first_config().live();
        let mut commands = Vec::new();
        while let Ok(command) = bench.solver.pop() {
            commands.push(command);
        }
        match &commands[..] {
            [
                Command::Settings(first),
                Command::Settings(second),
                Command::Settings(third),
                Command::Reset,
            ] => {
                assert_eq!(
                    first.live.inner_friction,
                    configured.inner_friction.map(|own| 1.01 * own)
                );
                assert_eq!(
                    second.live.outer_friction,
                    configured.outer_friction.map(|own| 1.02 * own)
                );
                assert_eq!(third.live, configured);
            }
            other => panic!("{other:?}"),
        }
        // A second reset has nothing to set back.
        bench.control.reset().unwrap();
        assert!(bench.updates.try_iter().next().is_none());
    }
}
