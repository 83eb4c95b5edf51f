//! Conditions of the alarms on the node itself: inputs, real time, solver, recording, network.

use crate::alarms::sentence::{self, number};
use crate::alarms::{AlarmBook, AlarmId, Finding, Unknown};
use crate::bag::{Losses, Problem};
use crate::dds::port::Health;
use crate::rig_inputs::DriverSummary;
use flexdrill_alarms::{Priority, Time};
use flexdrill_config::Alarms;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::inputs::{Conditioner, InputKind, InputState};
use flexdrill_realtime::link::RunState;
use flexdrill_realtime::{FAR_BEHIND, KEEPS_UP, Pace, PaceReading};
use flexdrill_text::counted;

/// How long a loss of messages remains a condition (s): longer than the alarm's default on-delay, so that a short loss
/// raises the alarm too.
const LOSS_LASTS: f64 = 5.0;

/// The state of the node at an instant.
#[derive(Debug)]
pub struct NodeState<'a> {
    /// Conditions the inputs.
    pub conditioner: &'a Conditioner,
    /// Present time as the conditioner counts it (s).
    pub now: f64,
    /// The publishers of each input, by [`InputKind::index`].
    pub drivers: [DriverSummary; InputKind::COUNT],
    /// Whether the solver runs.
    pub run_state: RunState,
    /// Cause and location of the failed step, while the model is stopped by it.
    pub failure: Option<StepFailure>,
    /// How the model keeps up with the clock.
    pub pace: PaceReading,
    /// The recording, if there is one.
    pub recording: Option<RecordingState>,
    /// The state of DDS.
    pub dds: Health,
    /// Other nodes with the name of this one.
    pub namesakes: Vec<String>,
}

/// The state of the recording.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RecordingState {
    /// Why nothing can be written at present.
    pub error: Option<Problem>,
    /// A recent problem, after which the recording continues in another file.
    pub notice: Option<Problem>,
    /// Messages lost so far.
    pub losses: Losses,
}

/// Judges the state of a node. It keeps what later observations need of earlier ones.
#[derive(Debug, Clone, Default)]
pub struct NodeConditions {
    /// Time of the first observation (s, the conditioner's clock).
    began: Option<f64>,
    /// Messages that the recording had lost at the last observation.
    lost: Losses,
    /// Messages of the present series of losses, and the time until which the series remains a condition (s).
    losses: Option<(Losses, f64)>,
}

impl NodeConditions {
    /// Has `book` observe the alarms on a node in this state, at the present time on the rig's clock.
    pub fn observe(&mut self, book: &mut AlarmBook, state: &NodeState<'_>, time: Time) {
        book.set_unknown(Unknown::of(state.conditioner, state.now));
        let findings = findings(state, &book.config().alarms, self);
        book.observe(findings, time);
    }
}

/// The findings on the node's state, one per alarm of the node.
fn findings(state: &NodeState<'_>, alarms: &Alarms, memory: &mut NodeConditions) -> [(AlarmId, Finding); 9] {
    // A simulated clock is 0 before its first tick and may be set back.
    let began = memory
        .began
        .filter(|began| *began > 0.0)
        .map_or(state.now, |began| began.min(state.now));
    memory.began = Some(began);
    let [speed, weight, advance, pressure] = InputKind::ALL.map(|kind| {
        (
            AlarmId::of_input(kind),
            input(kind, state, began, alarms.first_sample_within),
        )
    });
    [
        speed,
        weight,
        advance,
        pressure,
        (AlarmId::TwoDrivers, two_drivers(&state.drivers)),
        (AlarmId::RealTime, real_time(state)),
        (AlarmId::Solver, solver(state.failure)),
        (
            AlarmId::Recording,
            recording(state.recording.as_ref(), memory, state.now),
        ),
        (AlarmId::Network, network(&state.dds, &state.namesakes)),
    ]
}

/// The finding on an input. `began` is when the node began (s, the conditioner's clock): an input that has never sent a
/// sample raises its alarm only `first_sample_within` (s) later.
fn input(kind: InputKind, state: &NodeState<'_>, began: f64, first_sample_within: f64) -> Finding {
    let (conditioner, topic) = (state.conditioner, kind.topic());
    let rule = conditioner.rule(kind);
    // A rate of penetration that was sent acts on the friction at the wall under every law.
    let acts = rule.used || kind == InputKind::RateOfPenetration;
    // Without any good sample, the time counts from the first that was refused.
    let silence = conditioner.without_good(kind, state.now);
    let fallback = format!(
        "the model uses {:.1} {}",
        conditioner.target(kind, state.now),
        kind.unit()
    );
    let (priority, evidence, cause) = match conditioner.state(kind, state.now) {
        InputState::Ok | InputState::Slow | InputState::Assumed => return Finding::default(),
        // During the start an absent input is normal. `suppressed` keeps the
        // alarm out of the journal without saying that all is well.
        InputState::NotReceived if state.now - began < first_sample_within => {
            return Finding {
                suppressed: true,
                ..Finding::default()
            };
        }
        InputState::NotReceived => (
            Priority::Low,
            format!("No sample received on {topic}; {fallback}."),
            "The rig's publisher is not running, or it uses another DDS domain or namespace.",
        ),
        InputState::Rejected => (
            Priority::Low,
            match conditioner.last_rejection(kind) {
                Some(rejection) => format!("{rejection}."),
                None => format!("The newest sample on {topic} was refused; {fallback}."),
            },
            "The sensor or its publisher is faulty, or the configured limits are too narrow.",
        ),
        InputState::Stale => {
            let silence = silence.unwrap_or_default();
            // On safe values the model no longer represents the tool, which is worse than a value that is held.
            let safe = conditioner.is_brought_to_safe(kind, state.now);
            let refused = conditioner.last_rejection(kind);
            // An input that is refused is stale too, but its remedy is another: the line works and the values do not.
            let (refused, cause) = match refused.filter(|refused| state.now - refused.time < rule.max_age) {
                Some(refused) => (
                    format!(" The newest sample: {refused}."),
                    "The sensor or its publisher is faulty, or the configured limits are too narrow.",
                ),
                None => (String::new(), "The rig's software or the network has stopped."),
            };
            (
                match (acts, kind.is_optional(), safe) {
                    (false, ..) => Priority::Low,
                    (true, false, true) => Priority::High,
                    // Without it the model continues to follow speed and weight.
                    _ => Priority::Medium,
                },
                format!("No good sample on {topic} for {silence:.0} s; {fallback}.{refused}"),
                cause,
            )
        }
    };
    // The consequence depends on the input, not on its state: what the model does without it.
    let (consequence, what_to_do) = match kind {
        _ if !acts => (
            "None: the present model does not use this value.",
            "No action at the rig. Inform the engineer.",
        ),
        InputKind::RotarySpeed | InputKind::WeightOnBit => (
            "The model no longer follows the rig; whirl and shock may be missed.",
            "Rely on the rig's own instruments until the signal returns, and call the engineer.",
        ),
        InputKind::RateOfPenetration => (
            "The axial friction of the tool is computed with a wrong advance; the weight at the bit may be wrong.",
            "Do not rely on the computed weight at the bit until the signal returns, and call the engineer.",
        ),
        InputKind::StandpipePressure => (
            "The tool's axial force is computed with a wrong pressure; bending and contact forces may be wrong.",
            "Do not rely on the computed forces until the signal returns, and call the engineer.",
        ),
    };
    Finding {
        priority: Some(priority),
        // Without any sample there is no age to compare with the threshold.
        value: silence.unwrap_or(f64::NAN),
        threshold: rule.max_age,
        unit: "s",
        evidence,
        cause: cause.to_owned(),
        consequence: consequence.to_owned(),
        what_to_do: what_to_do.to_owned(),
        what_the_engineer_can_do: format!("Check the sensor and the program that publishes {topic}."),
        ..Finding::default()
    }
}

fn two_drivers(drivers: &[DriverSummary; InputKind::COUNT]) -> Finding {
    // Only inputs with several publishers at once; one that changes its publisher is the normal handover.
    let several = InputKind::ALL
        .into_iter()
        .zip(drivers)
        .filter(|(_, drivers)| drivers.several);
    let conflicts: Vec<String> = several
        .map(|(kind, drivers)| {
            // An empty name means that the policy of `inputs.driver` accepts none of them.
            let driving = match drivers.driving.as_str() {
                "" => "the model follows none of them".to_owned(),
                driving => format!("the model follows {driving}"),
            };
            format!(
                "{} is published by {} at the same time; {driving}.",
                sentence::capitalized(&kind.name().replace('_', " ")),
                drivers.heard.join(" and ")
            )
        })
        .collect();
    if conflicts.is_empty() {
        return Finding::default();
    }
    // One alarm stands for all inputs, so its value is that of the worst.
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
        evidence: conflicts.join(" "),
        cause: "A second rig, a replayed log or a test publishes in the same domain and namespace.".to_owned(),
        consequence: "The model may follow the wrong source; alarms may be missing or false.".to_owned(),
        what_to_do: "Rely on the rig's own instruments until this alarm clears, and call the engineer.".to_owned(),
        what_the_engineer_can_do:
            "Stop all publishers except the rig's own, or set inputs.driver.policy to named with the node or the id of \
             the rig's publisher."
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
        evidence: format!("{}.", sentence::capitalized(&not_in_real_time(factor))),
        cause: "The twin's computer is too slow for this motion of the tool, or other programs use its processor."
            .to_owned(),
        consequence:
            "The model shows less time of motion than the rig has drilled; whirl and shock may be detected late."
                .to_owned(),
        what_to_do: "No action at the rig. Inform the person who runs the twin's computer.".to_owned(),
        what_the_engineer_can_do:
            "Close other programs and viewers on the computer, set solver.step: fixed for the next run, or use a \
             computer with faster cores and AVX2 or AVX-512."
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
        evidence: format!("The model stopped at model time {:.4} s: {failure}.", failure.time),
        cause: "The motion changes too fast for the smallest time step.".to_owned(),
        consequence: "All outputs are frozen; whirl and shock are not detected.".to_owned(),
        what_to_do: "Rely on the rig's own instruments and call the engineer.".to_owned(),
        what_the_engineer_can_do: "Call ~/reset, or wait until the inputs change. Set a smaller solver.time_step or a \
                                   softer contact for the next run."
            .to_owned(),
        ..Finding::default()
    }
}

/// Restarts of DDS within a minute from which on the fault is not a single event.
const MANY_RESTARTS: usize = 3;

fn network(dds: &Health, namesakes: &[String]) -> Finding {
    let recent = dds.recent_restarts();
    let Some(cause) = dds.cause().filter(|_| recent > 0) else {
        return two_nodes(namesakes);
    };
    let many = recent >= MANY_RESTARTS;
    Finding {
        priority: Some(if many { Priority::Medium } else { Priority::Low }),
        value: recent as f64,
        threshold: if many { MANY_RESTARTS as f64 } else { 1.0 },
        unit: "1/min",
        evidence: match recent {
            1 => format!("DDS restarted within the last minute: {cause}."),
            _ => format!("DDS restarted {recent} times within the last minute; the last cause: {cause}."),
        },
        cause: "A malformed packet of another program, a suspended process, a changed clock, or too little memory."
            .to_owned(),
        consequence:
            "Dashboards and rig data are interrupted for up to 3 s each time; the model and its recording continue."
                .to_owned(),
        what_to_do: if many {
            "Rely on the rig's own instruments while values are frozen, and call the engineer."
        } else {
            "Call the engineer if this alarm returns."
        }
        .to_owned(),
        what_the_engineer_can_do: "Read the cause in the log. Look for a program that sends malformed packets; \
                                   ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST excludes other machines."
            .to_owned(),
        ..Finding::default()
    }
}

/// The finding on other nodes with the name of this one.
fn two_nodes(namesakes: &[String]) -> Finding {
    if namesakes.is_empty() {
        return Finding::default();
    }
    Finding {
        priority: Some(Priority::Low),
        value: namesakes.len() as f64,
        threshold: 1.0,
        unit: "nodes",
        evidence: format!("{}.", sentence::capitalized(&another_of_this_name(namesakes))),
        cause: "A second twin runs with the same name in the same domain and namespace.".to_owned(),
        consequence: "Dashboards show the values of both twins in turn.".to_owned(),
        what_to_do: "Call the engineer.".to_owned(),
        what_the_engineer_can_do: "Stop one of the two nodes, or start it with another --namespace.".to_owned(),
        ..Finding::default()
    }
}

/// The text of log and alarm on other nodes with the name of this one.
pub(crate) fn another_of_this_name(others: &[String]) -> String {
    format!("another node has the name of this one: {}", others.join(", "))
}

/// The text of log and alarm on a model that is slower than real time, with the model time per second over the last
/// ten seconds.
pub(crate) fn not_in_real_time(factor: f64) -> String {
    match number(factor, 2) {
        Some(factor) => format!("the model advanced {factor} s per second over the last 10 s and skipped the rest"),
        None => "the model is slower than the clock and skips time".to_owned(),
    }
}

fn recording(recording: Option<&RecordingState>, memory: &mut NodeConditions, now: f64) -> Finding {
    let Some(recording) = recording else {
        return Finding::default();
    };
    // The recorder counts since its start; an alarm needs what is new, so that it can clear.
    let lost = recording.losses.since(&memory.lost);
    memory.lost = recording.losses;
    let row = memory.losses.filter(|(_, until)| now < *until);
    // Losses in bursts are one condition until `LOSS_LASTS` after the last; each burst would otherwise be an alarm.
    memory.losses = if lost.total() > 0 {
        let before = row.map(|(lost, _)| lost).unwrap_or_default();
        Some((before.and(&lost), now + LOSS_LASTS))
    } else {
        row
    };
    // A recording that stopped outranks lost messages: it loses all of them.
    let (priority, evidence, cause, remedy) = match (&recording.error, &recording.notice) {
        (Some(problem), _) => (
            Priority::Medium,
            format!("The recording stopped: {}.", problem.text),
            problem.cause.to_owned(),
            problem.remedy,
        ),
        (None, Some(problem)) => (
            Priority::Medium,
            format!("The recording stopped and continues in another file: {}.", problem.text),
            problem.cause.to_owned(),
            problem.remedy,
        ),
        (None, None) => match memory.losses {
            Some((lost, _)) => (
                Priority::Low,
                format!(
                    "Missing from the recording: {}, {} since its start.",
                    counted(lost.total(), "message"),
                    recording.losses.total()
                ),
                format!("Of these, {lost}."),
                "Free disk space, or restart the node with --record on a faster disk.",
            ),
            None => return Finding::default(),
        },
    };
    let healthy = recording.error.is_none() && recording.notice.is_none();
    // If every lost message was a flood's, the disk is sound and advice on it would mislead.
    let flooded = healthy && memory.losses.is_some_and(|(lost, _)| lost.flooded == lost.total());
    Finding {
        priority: Some(priority),
        evidence,
        cause,
        consequence: "The run cannot be replayed exactly, and the alarm journal has gaps.".to_owned(),
        what_to_do: "No action at the rig. Inform the person who runs the twin's computer.".to_owned(),
        what_the_engineer_can_do: if flooded {
            "Find the program that floods an input: twin/status names the publishers of each input."
        } else {
            remedy
        }
        .to_owned(),
        ..Finding::default()
    }
}
