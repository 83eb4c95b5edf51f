//! Alarms of the node itself: inputs, pace, solver, recording.

use super::catalogue::AlarmId;
use super::finding::Finding;
use super::sentence::number;
use crate::bag::{Losses, Problem};
use crate::dds::port::Health;
use crate::rig_inputs::DriverSummary;
use flexdrill_alarms::Priority;
use flexdrill_config::Alarms;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::inputs::{Conditioner, InputKind, InputState};
use flexdrill_realtime::link::RunState;
use flexdrill_realtime::{FAR_BEHIND, KEEPS_UP, Pace, PaceReading};

/// How long a loss of messages counts (s): longer than the alarm's default delay, which a loss of a moment would not
/// outlast.
const LOSS_COUNTS: f64 = 5.0;

/// What the node knows of itself at an instant.
#[derive(Debug)]
pub struct NodeState<'a> {
    /// Inputs.
    pub conditioner: &'a Conditioner,
    /// Present time as the conditioner counts it (s).
    pub now: f64,
    /// Who sends each input, by [`InputKind::index`].
    pub drivers: [DriverSummary; 2],
    /// What the solver does.
    pub run_state: RunState,
    /// Why and where the last step failed, while the model stands still for it.
    pub failure: Option<StepFailure>,
    /// How the model keeps up with the clock.
    pub pace: PaceReading,
    /// The recording, if there is one.
    pub recording: Option<RecordingState>,
    /// DDS.
    pub dds: Health,
}

/// How the recording is.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RecordingState {
    /// Why nothing can be written at present.
    pub error: Option<Problem>,
    /// What was wrong a moment ago, when the recording goes on in another file since.
    pub notice: Option<Problem>,
    /// Messages lost so far.
    pub losses: Losses,
}

/// What judging needs from one time to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Memory {
    /// When the node was first looked at (s, the conditioner's clock).
    began: Option<f64>,
    /// Messages that the recording had lost when it was last looked at.
    lost: Losses,
    /// Messages that it lost in a row of losses, and until when that counts (s).
    losses: Option<(Losses, f64)>,
}

/// What the node's state says of every alarm of the node.
pub(super) fn findings(state: &NodeState<'_>, alarms: &Alarms, memory: &mut Memory) -> [(AlarmId, Finding); 7] {
    // A simulated clock stands at 0 before its first tick and may be set back.
    let began = memory
        .began
        .filter(|began| *began > 0.0)
        .map_or(state.now, |began| began.min(state.now));
    memory.began = Some(began);
    let [speed, weight] = InputKind::ALL.map(|kind| {
        (
            AlarmId::of_input(kind),
            input(kind, state, began, alarms.first_sample_within),
        )
    });
    [
        speed,
        weight,
        (AlarmId::TwoDrivers, two_drivers(&state.drivers)),
        (AlarmId::RealTime, real_time(state)),
        (AlarmId::Solver, solver(state.failure)),
        (
            AlarmId::Recording,
            recording(state.recording.as_ref(), memory, state.now),
        ),
        (AlarmId::Network, network(&state.dds)),
    ]
}

/// `began` is when the node began (s, the conditioner's clock); an input that has never sent calls only when
/// `first_sample_within` (s) has passed since.
fn input(kind: InputKind, state: &NodeState<'_>, began: f64, first_sample_within: f64) -> Finding {
    let (conditioner, topic) = (state.conditioner, kind.topic());
    let rule = conditioner.rule(kind);
    // Where no sample was ever good, since the first that was refused.
    let silence = conditioner.without_good(kind, state.now);
    let acts = format!(
        "{:.1} {} asked for instead",
        conditioner.target(kind, state.now),
        kind.unit()
    );
    let (priority, evidence, cause) = match conditioner.state(kind, state.now) {
        InputState::Ok | InputState::Slow => return Finding::default(),
        InputState::NotReceived if state.now - began < first_sample_within => {
            return Finding {
                suppressed: true,
                ..Finding::default()
            };
        }
        InputState::NotReceived => (
            Priority::Low,
            format!("Nothing received on {topic}, {acts}."),
            "The rig's publisher is not running, or it is in another domain or namespace.",
        ),
        InputState::Rejected => (
            Priority::Low,
            match conditioner.last_rejection(kind) {
                Some(rejection) => format!("{rejection}."),
                None => format!("The newest sample on {topic} was refused, {acts}."),
            },
            "The sensor or what sends it is out of order, or the limits are too narrow.",
        ),
        InputState::Stale => {
            let silence = silence.unwrap_or_default();
            // Then the model no longer holds what was, and what it says of the tool is not the tool's.
            let safe = conditioner.is_brought_to_safe(kind, state.now);
            let refused = conditioner.last_rejection(kind);
            let (refused, cause) = match refused.filter(|refused| state.now - refused.time < rule.max_age) {
                Some(refused) => (
                    format!(" The newest: {refused}."),
                    "The sensor or what sends it is out of order, or the limits are too narrow.",
                ),
                None => (String::new(), "The rig's software or the network has stopped."),
            };
            (
                if safe { Priority::High } else { Priority::Medium },
                format!("No good sample on {topic} for {silence:.0} s, {acts}.{refused}"),
                cause,
            )
        }
    };
    Finding {
        priority: Some(priority),
        value: silence.unwrap_or(f64::NAN),
        threshold: rule.max_age,
        unit: "s",
        evidence,
        cause: cause.to_owned(),
        consequence: "The model no longer follows the rig: its hazards may be missed.".to_owned(),
        what_to_do: "Go by the rig's own instruments until it is back, and call the engineer.".to_owned(),
        what_the_engineer_can_do: format!("Check the sensor and the program that publishes {topic}."),
        ..Finding::default()
    }
}

fn two_drivers(drivers: &[DriverSummary; 2]) -> Finding {
    let several = InputKind::ALL
        .into_iter()
        .zip(drivers)
        .filter(|(_, drivers)| drivers.several);
    let said: Vec<String> = several
        .map(|(kind, drivers)| {
            let driving = match drivers.driving.as_str() {
                "" => "nobody drives".to_owned(),
                driving => format!("{driving} drives"),
            };
            format!("{kind} is sent by {} at once, {driving}", drivers.heard.join(" and "))
        })
        .collect();
    if said.is_empty() {
        return Finding::default();
    }
    let most = drivers
        .iter()
        .map(|drivers| drivers.heard.len())
        .max()
        .unwrap_or_default();
    Finding {
        priority: Some(Priority::Medium),
        value: most as f64,
        threshold: 1.0,
        unit: "publishers",
        evidence: format!("{}.", said.join("; ")),
        cause: "A second rig, a replayed log or a test publishes in the same domain and namespace.".to_owned(),
        consequence: "The model may follow what the tool does not do: its hazards may be missed or made up.".to_owned(),
        what_to_do: "Go by the rig's own instruments until one source is left, and call the engineer.".to_owned(),
        what_the_engineer_can_do:
            "Stop all publishers but the rig's own, or set inputs.driver.policy to named with its \
                                   node or id."
                .to_owned(),
        ..Finding::default()
    }
}

fn real_time(state: &NodeState<'_>) -> Finding {
    let (priority, threshold) = match state.pace.level {
        Pace::NotJudged | Pace::Kept => {
            return Finding {
                suppressed: state.run_state != RunState::Running,
                ..Finding::default()
            };
        }
        Pace::Late => (Priority::Low, KEEPS_UP),
        Pace::FarBehind => (Priority::Medium, FAR_BEHIND),
    };
    let factor = state.pace.factor.unwrap_or(f64::NAN);
    Finding {
        priority: Some(priority),
        value: factor,
        threshold,
        unit: "s/s",
        evidence: match number(factor, 2) {
            Some(factor) => format!("The model gained {factor} s per second over the last 10 s and skipped the rest."),
            None => "The model does not keep up with the clock and skips the rest.".to_owned(),
        },
        cause: "This computer is too slow for the tool and its motion, or other programs take its processors."
            .to_owned(),
        consequence:
            "The outputs keep to the clock and show a tool that drills slower in time; hazards may be seen late."
                .to_owned(),
        what_to_do: "Nothing at the rig: tell whoever runs the twin's computer.".to_owned(),
        what_the_engineer_can_do:
            "End other programs on the computer, or take one with faster cores that have AVX2 or AVX-512. With \
             solver.step: auto the twin takes whole steps by itself while time is short."
                .to_owned(),
        ..Finding::default()
    }
}

fn solver(failure: Option<StepFailure>) -> Finding {
    let Some(failure) = failure else {
        return Finding::default();
    };
    Finding {
        priority: Some(Priority::High),
        evidence: format!("A step failed at model time {:.4} s: {failure}.", failure.time),
        cause: "The motion is too hard for the step at its smallest size.".to_owned(),
        consequence: "The outputs stand still: no hazard is seen.".to_owned(),
        what_to_do: "Go by the rig's own instruments and call the engineer.".to_owned(),
        what_the_engineer_can_do: "Call ~/reset, or wait for other inputs; take a smaller solver.time_step or softer \
                                   contact for the next run."
            .to_owned(),
        ..Finding::default()
    }
}

/// Restarts of DDS within a minute from which on it is not a single event.
const MANY_RESTARTS: usize = 3;

fn network(dds: &Health) -> Finding {
    let recent = dds.recent_restarts();
    let Some(cause) = dds.cause().filter(|_| recent > 0) else {
        return Finding::default();
    };
    let many = recent >= MANY_RESTARTS;
    Finding {
        priority: Some(if many { Priority::Medium } else { Priority::Low }),
        value: recent as f64,
        threshold: if many { MANY_RESTARTS as f64 } else { 1.0 },
        unit: "1/min",
        evidence: format!("DDS was started again {recent} times within a minute; the last time {cause}."),
        cause: "A packet of another program, a stopped process, a clock that was set, or too little memory.".to_owned(),
        consequence:
            "Dashboards and the rig's values are cut off for up to 3 s each time; the model and its recording \
                      go on."
                .to_owned(),
        what_to_do: if many {
            "Go by the rig's own instruments while values stand still, and call the engineer."
        } else {
            "Call the engineer if it comes again."
        }
        .to_owned(),
        what_the_engineer_can_do: "Read the cause in the log. Look for a program that sends broken packets; \
                                   ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST keeps other machines out."
            .to_owned(),
        ..Finding::default()
    }
}

fn recording(recording: Option<&RecordingState>, memory: &mut Memory, now: f64) -> Finding {
    let Some(recording) = recording else {
        return Finding::default();
    };
    let lost = recording.losses.since(&memory.lost);
    memory.lost = recording.losses;
    let row = memory.losses.filter(|(_, until)| now < *until);
    memory.losses = if lost.total() > 0 {
        let before = row.map(|(lost, _)| lost).unwrap_or_default();
        Some((before.and(&lost), now + LOSS_COUNTS))
    } else {
        row
    };
    let (priority, evidence, cause) = match (&recording.error, &recording.notice) {
        (Some(problem), _) => (
            Priority::Medium,
            format!("The recording stopped: {}.", problem.text),
            problem.cause.to_owned(),
        ),
        (None, Some(problem)) => (
            Priority::Medium,
            format!(
                "The recording had stopped and goes on in another file: {}.",
                problem.text
            ),
            problem.cause.to_owned(),
        ),
        (None, None) => match memory.losses {
            Some((lost, _)) => (
                Priority::Low,
                format!(
                    "{} messages did not get into the recording, {} so far.",
                    lost.total(),
                    recording.losses.total()
                ),
                format!("Of these, {lost}."),
            ),
            None => return Finding::default(),
        },
    };
    let healthy = recording.error.is_none() && recording.notice.is_none();
    let flooded = healthy && memory.losses.is_some_and(|(lost, _)| lost.flooded == lost.total());
    Finding {
        priority: Some(priority),
        evidence,
        cause,
        consequence: "The run cannot be replayed to the bit, and the journal of alarms has gaps.".to_owned(),
        what_to_do: "Nothing at the rig: tell whoever runs the twin's computer.".to_owned(),
        what_the_engineer_can_do: if flooded {
            "Find the program that floods an input: twin/status names the publishers of each."
        } else {
            "Free the disk: the recording then goes on in another file by itself. Or start the node again with \
             --record on another disk."
        }
        .to_owned(),
        ..Finding::default()
    }
}
