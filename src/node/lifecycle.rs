//! A managed node (`--lifecycle`): ROS 2's states and transitions, as launch systems and supervisors use them.
//!
//! | state | the twin |
//! |---|---|
//! | unconfigured | the tool is at its start; model time stands still |
//! | inactive | model time stands still |
//! | active | model time runs, outputs are published |
//! | finalized | the node ends in order, as after a signal |
//!
//! Status, diagnostics and alarms are published in every state.

use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::Notify;

use super::NodeError;
use super::control::{Control, ControlError};
use flexdrill_messages::lifecycle_msgs::{
    ChangeStateRequest, ChangeStateResponse, GetAvailableStatesRequest, GetAvailableStatesResponse,
    GetAvailableTransitionsRequest, GetAvailableTransitionsResponse, GetStateRequest, GetStateResponse, State,
    Transition, TransitionDescription, TransitionEvent,
};
use flexdrill_messages::{Message, to_cdr_body};
use flexdrill_realtime::clock::rig_clock;
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::plan::Offer;
use flexdrill_ros2::dds::port::{PortBuilder, TopicPublisher};
use flexdrill_ros2::service::{ServiceMapping, ServiceServer, Task, at_once};
use flexdrill_text::log_ending;

const STATES: [(u8, &str); 4] = [
    (State::PRIMARY_STATE_UNCONFIGURED, "unconfigured"),
    (State::PRIMARY_STATE_INACTIVE, "inactive"),
    (State::PRIMARY_STATE_ACTIVE, "active"),
    (State::PRIMARY_STATE_FINALIZED, "finalized"),
];

/// The transition that ends the node.
const SHUTDOWN: &str = "shutdown";

/// The transitions that a client can request: number, label, from, to.
const TRANSITIONS: [(u8, &str, u8, u8); 7] = [
    (Transition::TRANSITION_CONFIGURE, "configure", 1, 2),
    (Transition::TRANSITION_CLEANUP, "cleanup", 2, 1),
    (Transition::TRANSITION_ACTIVATE, "activate", 2, 3),
    (Transition::TRANSITION_DEACTIVATE, "deactivate", 3, 2),
    (Transition::TRANSITION_UNCONFIGURED_SHUTDOWN, SHUTDOWN, 1, 4),
    (Transition::TRANSITION_INACTIVE_SHUTDOWN, SHUTDOWN, 2, 4),
    (Transition::TRANSITION_ACTIVE_SHUTDOWN, SHUTDOWN, 3, 4),
];

/// The state machine of a managed node.
pub struct Lifecycle {
    state: Mutex<u8>,
    control: Arc<Control>,
    events: TopicPublisher,
    shut_down: Arc<Notify>,
}

impl Lifecycle {
    fn state(&self) -> u8 {
        *self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ends the node by the transition `shutdown` of the present state. Returns whether there was one.
    pub(super) fn shut_down(&self) -> bool {
        self.change(&Transition {
            id: 0,
            label: SHUTDOWN.to_owned(),
        })
    }

    /// Carries out a transition, requested by number or by label. Returns whether it was carried out.
    fn change(&self, requested: &Transition) -> bool {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(transition) = find(*state, requested) else {
            if let Some(more) = log_ending("change of state refused") {
                tracing::warn!(
                    "a change of state was refused: state {} has no transition {} '{}'; see `ros2 lifecycle list`{more}",
                    label(*state),
                    requested.id,
                    requested.label.escape_default()
                );
            }
            return false;
        };
        let (_, name, from, to) = *transition;
        if let Err(why) = self.carry_out(name, to) {
            if let Some(more) = log_ending(format!("{name} refused")) {
                tracing::warn!("{name} was refused: {why}{more}");
            }
            return false;
        }
        *state = to;
        if let Some(more) = log_ending(name) {
            tracing::info!("{name}: the node is {}{more}", label(to));
        }
        let description = describe(transition);
        let event = TransitionEvent {
            timestamp: rig_clock(),
            transition: description.transition,
            start_state: described(from),
            goal_state: described(to),
        };
        if let Ok(body) = to_cdr_body(&event) {
            self.events.publish(body);
        }
        true
    }

    fn carry_out(&self, name: &str, to: u8) -> Result<(), ControlError> {
        match name {
            "activate" => self.control.set_inactive(None),
            "configure" | "deactivate" => self.control.set_inactive(Some(label(to))),
            "cleanup" => {
                self.control.set_inactive(Some(label(to)))?;
                self.control.reset().map(drop)
            }
            SHUTDOWN => {
                self.shut_down.notify_one();
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

fn label(state: u8) -> &'static str {
    STATES
        .iter()
        .find(|(id, _)| *id == state)
        .map_or("unknown", |(_, label)| label)
}

fn described(id: u8) -> State {
    State {
        id,
        label: label(id).to_owned(),
    }
}

fn describe(&(id, name, from, to): &(u8, &str, u8, u8)) -> TransitionDescription {
    TransitionDescription {
        transition: Transition {
            id,
            label: name.to_owned(),
        },
        start_state: described(from),
        goal_state: described(to),
    }
}

/// The requested transition, if this state has it. A label has precedence over a number, as in rclcpp.
fn find(state: u8, requested: &Transition) -> Option<&'static (u8, &'static str, u8, u8)> {
    TRANSITIONS
        .iter()
        .filter(|(_, _, from, _)| *from == state)
        .find(|(id, name, ..)| {
            if requested.label.is_empty() {
                *id == requested.id
            } else {
                *name == requested.label
            }
        })
}

/// Makes a node managed, and returns its states, and its services as tasks. The node begins unconfigured, with model time
/// standing still. The transition `shutdown` notifies `shut_down`. `name` makes a private name absolute.
///
/// # Errors
/// When a remapped name is not allowed.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    control: &Arc<Control>,
    shut_down: &Arc<Notify>,
    name: impl Fn(&str) -> Result<String, ArgsError>,
) -> Result<(Arc<Lifecycle>, Vec<Task>), NodeError> {
    // Transition events are not latched: a tool that joins later asks for the state, as `ros2 lifecycle` does.
    let offer = Offer::usual(1.0);
    let events = port.publisher(&name("~/transition_event")?, TransitionEvent::DDS_TYPE, offer);
    // Time is stopped before the services exist, so that no step is taken in a state that a supervisor has not chosen.
    control
        .set_inactive(Some(label(State::PRIMARY_STATE_UNCONFIGURED)))
        .map_err(|why| NodeError::Stopped(format!("the node cannot start as a managed node: {why}")))?;
    let lifecycle = Arc::new(Lifecycle {
        state: Mutex::new(State::PRIMARY_STATE_UNCONFIGURED),
        control: Arc::clone(control),
        events,
        shut_down: Arc::clone(shut_down),
    });
    let mut server = |private: &str, kind: &str| -> Result<ServiceServer, NodeError> {
        let kind = format!("lifecycle_msgs/srv/{kind}");
        Ok(ServiceServer::new(port, &name(private)?, &kind, mapping))
    };
    // Three closures need the state for as long as the node runs.
    let (change, state, possible) = (Arc::clone(&lifecycle), Arc::clone(&lifecycle), Arc::clone(&lifecycle));
    let tasks: Vec<Task> = vec![
        Box::pin(
            server("~/change_state", "ChangeState")?.serve(at_once(move |request: ChangeStateRequest| {
                ChangeStateResponse {
                    success: change.change(&request.transition),
                }
            })),
        ),
        Box::pin(
            server("~/get_state", "GetState")?.serve(at_once(move |_: GetStateRequest| GetStateResponse {
                current_state: described(state.state()),
            })),
        ),
        Box::pin(server("~/get_available_states", "GetAvailableStates")?.serve(at_once(
            move |_: GetAvailableStatesRequest| GetAvailableStatesResponse {
                available_states: STATES.map(|(id, _)| described(id)).to_vec(),
            },
        ))),
        Box::pin(
            server("~/get_available_transitions", "GetAvailableTransitions")?.serve(at_once(
                // The state is read once: between two readings a transition could change it.
                move |_: GetAvailableTransitionsRequest| {
                    let now = possible.state();
                    let from_here = TRANSITIONS.iter().filter(|(_, _, from, _)| *from == now);
                    GetAvailableTransitionsResponse {
                        available_transitions: from_here.map(describe).collect(),
                    }
                },
            )),
        ),
        Box::pin(
            server("~/get_transition_graph", "GetAvailableTransitions")?.serve(at_once(
                move |_: GetAvailableTransitionsRequest| GetAvailableTransitionsResponse {
                    available_transitions: TRANSITIONS.iter().map(describe).collect(),
                },
            )),
        ),
    ];
    Ok((lifecycle, tasks))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transitions_are_found_by_number_or_label_from_their_state_only() {
        let transition = |id: u8, label: &str| Transition {
            id,
            label: label.to_owned(),
        };
        let to = |state, id, label| find(state, &transition(id, label)).map(|found| found.3);
        assert_eq!(to(1, 1, ""), Some(2));
        assert_eq!(to(2, 0, "activate"), Some(3));
        assert_eq!(to(3, 0, "shutdown"), Some(4));
        assert_eq!(to(3, 5, ""), None, "the shutdown of another state");
        assert_eq!(to(1, 3, ""), None);
        assert_eq!(to(4, 1, ""), None, "nothing leads back");
    }
}
