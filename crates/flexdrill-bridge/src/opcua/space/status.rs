//! The variables of `twin/status`: the twin as a whole, and its inputs.

use ::opcua::types::Variant;
use flexdrill_core::inputs::{InputKind, Unit};
use flexdrill_messages::TwinStatus;
use flexdrill_messages::topics;
use flexdrill_outputs::words::{input_state, twin_state};

use super::{Kind, Variable, number};

/// Of the twin as a whole.
pub(super) fn of_status() -> Vec<Variable> {
    // One constructor per type: the closures read one field, and the rest of a variable cannot differ between them.
    let text = |name: &str, description: &str, read: fn(&TwinStatus) -> String| {
        Variable::new("status", name, description, Kind::Text, &topics::STATUS, move |twin| {
            Some(Variant::from(read(twin.status()?)))
        })
    };
    let count = |name: &str, description: &str, read: fn(&TwinStatus) -> u64| {
        Variable::new("status", name, description, Kind::Count, &topics::STATUS, move |twin| {
            // `?` makes a variable without its message unknown (no value), never zero.
            Some(Variant::from(read(twin.status()?)))
        })
    };
    vec![
        // Words and not codes, because clients show the value without a table.
        text("state", "starting, running, paused or failed", |status| {
            twin_state(status.state).to_owned()
        }),
        text("version", "Version of flexdrill", |status| status.version.clone()),
        text(
            "configuration_hash",
            "SHA-256 of the configuration in force",
            |status| status.config_hash.clone(),
        ),
        text(
            "model_quality_cause",
            "Why the model quality is not good; empty if it is",
            |status| status.model_quality_cause.clone(),
        ),
        count("heartbeat", "One more in every status of the twin", |status| {
            status.sequence
        }),
        count("deadline_misses", "Steps that ended after their deadline", |status| {
            status.deadline_misses
        }),
        count("steps_skipped", "Steps skipped because the model was late", |status| {
            status.steps_skipped
        }),
        count(
            "surveys_known",
            "Surveys of the hole that are taken into account",
            |status| status.surveys_known,
        ),
        count(
            "surveys_waiting",
            "Surveys that wait for the hole below the bit",
            |status| status.surveys_waiting,
        ),
        count("surveys_refused", "Surveys refused since the twin's start", |status| {
            status.surveys_refused
        }),
    ]
}

/// Of an input.
pub(super) fn of_input(kind: InputKind) -> Vec<Variable> {
    // OPC UA carries SI here, with its unit in the node, so that no client converts twice.
    let unit = match kind {
        InputKind::RotarySpeed => Unit::RadianPerSecond,
        InputKind::WeightOnBit => Unit::Newton,
        InputKind::RateOfPenetration => Unit::MetrePerSecond,
        InputKind::StandpipePressure => Unit::Pascal,
    };
    // The status lists an input only where it plays a part.
    let of = move |status: &TwinStatus| status.input_name.iter().position(|name| name == kind.name());
    // The index is found in each message: its order is not part of the contract.
    let numbers = move |name: &str, description: &str, unit, read: fn(&TwinStatus) -> &[f64]| {
        Variable::new(
            "inputs",
            format!("{}/{name}", kind.name()),
            description,
            Kind::Number(unit),
            &topics::STATUS,
            move |twin| {
                let status = twin.status()?;
                number(*read(status).get(of(status)?)?)
            },
        )
    };
    let texts = move |name: &str, description: &str, read: fn(&TwinStatus, usize) -> Option<String>| {
        Variable::new(
            "inputs",
            format!("{}/{name}", kind.name()),
            description,
            Kind::Text,
            &topics::STATUS,
            move |twin| {
                let status = twin.status()?;
                read(status, of(status)?).map(Variant::from)
            },
        )
    };
    // The names are those of the message, so that both interfaces are described in one page.
    vec![
        numbers("applied", "Value that acts on the model", unit, |status| {
            &status.input_applied
        }),
        numbers("received", "Newest sample as received", unit, |status| {
            &status.input_received
        }),
        numbers("age", "Time since the newest good sample", Unit::Second, |status| {
            &status.input_age
        }),
        texts(
            "state",
            "not received, ok, slow, stale, rejected or assumed",
            |status, index| {
                let state = status.input_state.get(index)?;
                Some(input_state(*state).to_owned())
            },
        ),
        texts(
            "driver",
            "The publisher that drives it; empty while there is none",
            |status, index| status.input_driver.get(index).cloned(),
        ),
    ]
}
