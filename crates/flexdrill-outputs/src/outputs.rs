//! From a frame to the messages that are due, in the order in which they are published. The node and a replay both
//! use this, so that they give the same bytes.

use std::collections::BTreeMap;

use crate::fill::{self, ShapeStyle};
use flexdrill_config::{Config, Rates};
use flexdrill_core::twin::{Frame, Output, RunInputs, Schedule, Timeline};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::geometry_msgs::{Quaternion, Transform, TransformStamped, Vector3};
use flexdrill_messages::sensor_msgs::JointState;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::tf2_msgs::TFMessage;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::visualization_msgs::MarkerArray;
use flexdrill_messages::{
    Ageing, AppliedInputs, BitState, CdrError, ContactForces, JointDeflections, Reactions, SessionInfo, Transfer,
    WhirlState, WhirlWarning, to_cdr_into,
};

/// How often the alarms of the tool are judged, per second of model time: ten times within the shortest duration that a
/// level has by default.
const ALARM_RATE: f64 = 10.0;

/// How often the applied inputs are sent again while they do not change (s on the rig's clock), for subscribers and
/// recordings that begin later.
const REPEAT: f64 = 1.0;

/// A message ready to be sent and recorded.
#[derive(Debug, Clone, Copy)]
pub struct Encoded<'a> {
    /// Its topic.
    pub topic: &'static TopicInfo,
    /// Instant on the rig's clock (ns since 1970).
    pub stamp: i64,
    /// CDR with its header of four bytes.
    pub cdr: &'a [u8],
}

/// A parameter that was changed while running.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterChange {
    /// Dotted name.
    pub name: String,
    /// In the parameter's unit.
    pub value: f64,
    /// Service and client that requested the change; empty where they are not known.
    pub asked_by: String,
}

/// The applied inputs of the last message.
struct LastApplied {
    inputs: RunInputs,
    /// Parameters changed since the start.
    changes: BTreeMap<String, ParameterChange>,
    /// Ticks at the last message.
    ticks: u64,
}

/// Fills and encodes the messages of a run, and reuses their memory.
pub struct Outputs {
    timeline: Timeline,
    style: ShapeStyle,
    header: Header,
    parent_frame: String,
    bytes: Vec<u8>,
    joint_deflections: JointDeflections,
    joint_states: JointState,
    contact_forces: ContactForces,
    bit_state: BitState,
    whirl: WhirlState,
    warning: WhirlWarning,
    tool_shape: MarkerArray,
    ageing: Ageing,
    reactions: Reactions,
    transfer: Transfer,
    /// Sequence of the level that was sent last, and whether it was suppressed.
    warned: Option<(u64, bool)>,
    /// How often a warning was suppressed or released; counts as a change too.
    suppressions: u64,
    /// `None` before the first.
    last_applied: Option<LastApplied>,
}

/// The schedule of recordings and viewers, from a configuration and the rates with which the run began. Lower rates that are
/// set while the twin runs act on DDS only, so that no parameter removes an output from a recording.
pub fn schedule(config: &Config, begun: &Rates) -> Schedule {
    schedule_of(config, &config.outputs.rates.at_least(begun))
}

/// The schedule of DDS, from a configuration.
pub fn published(config: &Config) -> Schedule {
    schedule_of(config, &config.outputs.rates)
}

fn schedule_of(config: &Config, rates: &Rates) -> Schedule {
    Schedule::new(config.solver.time_step, |output| match output {
        Output::JointDeflections => rates.joint_deflections,
        Output::JointStates => rates.joint_states,
        Output::ContactForces => rates.contact_forces,
        Output::BitState => rates.bit_state,
        Output::Whirl => rates.whirl,
        Output::ToolShape => rates.tool_shape,
        Output::Ageing => rates.ageing,
        Output::Reactions => rates.reactions,
        Output::Transfer => rates.transfer,
        Output::Alarms => ALARM_RATE,
    })
}

impl Outputs {
    /// The outputs of a run that began at `start` (ns since 1970, on the rig's clock).
    pub fn new(config: &Config, start: i64) -> Self {
        Self {
            timeline: Timeline {
                start,
                time_step: config.solver.time_step,
            },
            style: ShapeStyle::new(config.outputs.exaggeration),
            header: Header {
                frame_id: config.outputs.frame_id.clone(),
                ..Header::default()
            },
            parent_frame: config.outputs.parent_frame.clone(),
            bytes: Vec::new(),
            joint_deflections: JointDeflections::default(),
            joint_states: JointState::default(),
            contact_forces: ContactForces::default(),
            bit_state: BitState::default(),
            whirl: WhirlState::default(),
            warning: WhirlWarning::default(),
            tool_shape: MarkerArray::default(),
            ageing: Ageing::default(),
            reactions: Reactions::default(),
            transfer: Transfer::default(),
            warned: None,
            suppressions: 0,
            last_applied: None,
        }
    }

    /// The clock of stamps was set: tick 0 is at `start` (ns since 1970) on it.
    pub fn set_start(&mut self, start: i64) {
        self.timeline.start = start;
    }

    /// Adopts the settings of a changed configuration that concern the messages themselves.
    pub fn reconfigure(&mut self, config: &Config) {
        self.style = ShapeStyle::new(config.outputs.exaggeration);
    }

    /// The header of a message at an instant of the run.
    pub fn header_at(&mut self, ticks: u64) -> Header {
        self.header.stamp = Time::from_nanoseconds(self.timeline.at(ticks));
        self.header.clone()
    }

    /// The instant of a tick (ns since 1970).
    pub fn instant(&self, ticks: u64) -> i64 {
        self.timeline.at(ticks)
    }

    /// Sends the messages that are due with a frame. A whirl warning is sent at the start and when its level has changed. `complete`
    /// adds to the ageing what a snapshot does not have.
    ///
    /// # Errors
    /// When a message cannot be encoded, and those of `send`.
    pub fn frame<E: From<CdrError>>(
        &mut self,
        frame: &Frame,
        mut complete: impl FnMut(&mut Ageing),
        mut send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        // One header for all messages of a frame, as they are of one instant.
        let header = self.header_at(frame.ticks);
        let stamp = self.timeline.at(frame.ticks);
        let snapshot = &frame.snapshot;
        // Messages are filled in place and encoded into one buffer: their arrays have their size after the first frame.
        macro_rules! filled {
            ($fill:ident($($more:expr)?) in $message:ident: $topic:ident) => {{
                fill::$fill(snapshot, &header, $($more,)? &mut self.$message);
                to_cdr_into(&self.$message, &mut self.bytes)?;
                &topics::$topic
            }};
        }
        // The order is that of the schedule, so that node and replay give the same sequence of messages.
        for output in frame.due.iter() {
            let topic = match output {
                Output::JointDeflections => filled!(joint_deflections() in joint_deflections: JOINT_DEFLECTIONS),
                Output::JointStates => filled!(joint_state() in joint_states: JOINT_STATES),
                Output::ContactForces => filled!(contact_forces() in contact_forces: CONTACT_FORCES),
                Output::BitState => filled!(bit_state() in bit_state: BIT_STATE),
                Output::Whirl => filled!(whirl_state() in whirl: WHIRL),
                Output::ToolShape => filled!(tool_shape(&self.style) in tool_shape: TOOL_SHAPE),
                Output::Ageing => {
                    fill::ageing(snapshot, &header, &mut self.ageing);
                    complete(&mut self.ageing);
                    to_cdr_into(&self.ageing, &mut self.bytes)?;
                    &topics::AGEING
                }
                Output::Reactions => filled!(reactions() in reactions: REACTIONS),
                Output::Transfer => filled!(transfer() in transfer: TRANSFER),
                // Alarms are due with a frame, but are published by their book, which decides what is new.
                Output::Alarms => continue,
            };
            send(Encoded {
                topic,
                stamp,
                cdr: &self.bytes,
            })?;
        }
        // A warning is news if its level has changed, or if it is suppressed
        // or released: an operator must see why it has gone.
        let suppressed = fill::whirl_warning_is_suppressed(snapshot);
        let warning = Some((snapshot.warning.sequence, suppressed));
        // At step 0 the warning is sent in any case, so that a client that waits for one knows the level.
        if snapshot.step == 0 || self.warned != warning {
            if self.warned.is_some_and(|(_, before)| before != suppressed) {
                self.suppressions += 1;
            }
            self.warned = warning;
            fill::whirl_warning(snapshot, &header, frame.input_quality, &mut self.warning);
            // The sequence counts both causes, since a client takes the same number as a repetition.
            self.warning.sequence += self.suppressions;
            to_cdr_into(&self.warning, &mut self.bytes)?;
            send(Encoded {
                topic: &topics::WHIRL_WARNINGS,
                stamp,
                cdr: &self.bytes,
            })?;
        }
        Ok(())
    }

    /// Sends the inputs that are applied from `ticks` on.
    ///
    /// # Errors
    /// As [`Outputs::frame`].
    pub fn applied<E: From<CdrError>>(
        &mut self,
        inputs: &RunInputs,
        changes: &[ParameterChange],
        ticks: u64,
        send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut known = self.last_applied.take().map(|last| last.changes).unwrap_or_default();
        known.extend(changes.iter().map(|change| (change.name.clone(), change.clone())));
        self.last_applied = Some(LastApplied {
            inputs: *inputs,
            changes: known,
            ticks,
        });
        self.send_applied(inputs, changes, ticks, send)
    }

    /// Sends the applied inputs again, with all parameters changed since the start, when a second has passed since the last
    /// message. To be called with every frame, after [`Outputs::frame`]. The values are those in force: a replay that
    /// applies them changes nothing.
    ///
    /// # Errors
    /// As [`Outputs::frame`].
    pub fn repeat_applied<E: From<CdrError>>(
        &mut self,
        frame: &Frame,
        send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let interval = (REPEAT / self.timeline.time_step).round() as u64;
        let Some(last) = &mut self.last_applied else {
            return Ok(());
        };
        if frame.ticks < last.ticks + interval {
            return Ok(());
        }
        last.ticks = frame.ticks;
        let inputs = RunInputs {
            step: frame.snapshot.step,
            reset: false,
            ..last.inputs
        };
        let changes: Vec<ParameterChange> = last.changes.values().cloned().collect();
        self.send_applied(&inputs, &changes, frame.ticks, send)
    }

    fn send_applied<E: From<CdrError>>(
        &mut self,
        inputs: &RunInputs,
        changes: &[ParameterChange],
        ticks: u64,
        mut send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let message = AppliedInputs {
            header: self.header_at(ticks),
            step: inputs.step,
            skipped_steps: inputs.skipped,
            reset: inputs.reset,
            rotary_speed: inputs.inputs.rotary_speed,
            weight_on_bit: inputs.inputs.weight_on_bit,
            input_quality: inputs.input_quality,
            rotary_speed_slew: inputs.slew[0],
            weight_on_bit_slew: inputs.slew[1],
            inner_friction: inputs.live.inner_friction,
            outer_friction: inputs.live.outer_friction,
            bit_friction_factor: inputs.live.bit_friction_factor,
            parameter_name: changes.iter().map(|change| change.name.clone()).collect(),
            parameter_value: changes.iter().map(|change| change.value).collect(),
            parameter_asked_by: changes.iter().map(|change| change.asked_by.clone()).collect(),
            refinement: u8::try_from(inputs.refinement).unwrap_or(u8::MAX),
            rate_of_penetration: inputs.inputs.rate_of_penetration,
            standpipe_pressure: inputs.inputs.standpipe_pressure,
            rate_of_penetration_slew: inputs.slew[2],
            standpipe_pressure_slew: inputs.slew[3],
        };
        to_cdr_into(&message, &mut self.bytes)?;
        send(Encoded {
            topic: &topics::APPLIED_INPUTS,
            stamp: self.timeline.at(ticks),
            cdr: &self.bytes,
        })
    }

    /// Sends version and configuration of the run, and the transform of its frame.
    ///
    /// # Errors
    /// As [`Outputs::frame`].
    pub fn session<E: From<CdrError>>(
        &mut self,
        config_hash: &str,
        configuration: &str,
        mut send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let header = self.header_at(0);
        let message = SessionInfo {
            start: header.stamp.clone(),
            header,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            config_hash: config_hash.to_owned(),
            time_step: self.timeline.time_step,
            configuration: configuration.to_owned(),
        };
        to_cdr_into(&message, &mut self.bytes)?;
        send(Encoded {
            topic: &topics::SESSION,
            stamp: self.timeline.at(0),
            cdr: &self.bytes,
        })?;
        self.frame_transform(send)
    }

    /// Sends the transform of the frame of all headers: half a turn about X in the parent frame, whose Z points up.
    fn frame_transform<E: From<CdrError>>(
        &mut self,
        mut send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        if self.parent_frame.is_empty() {
            return Ok(());
        }
        let mut header = self.header_at(0);
        let child_frame_id = std::mem::replace(&mut header.frame_id, self.parent_frame.clone());
        let message = TFMessage {
            transforms: vec![TransformStamped {
                header,
                child_frame_id,
                transform: Transform {
                    translation: Vector3::default(),
                    rotation: Quaternion {
                        x: 1.0,
                        y: 0.0,
                        z: 0.0,
                        w: 0.0,
                    },
                },
            }],
        };
        to_cdr_into(&message, &mut self.bytes)?;
        send(Encoded {
            topic: &topics::TF_STATIC,
            stamp: self.timeline.at(0),
            cdr: &self.bytes,
        })
    }
}

/// The inputs of a run from a recorded message. The settings that the message does not contain come from `config`, in which
/// the message's parameters must already be set. `begun` are the rates with which the run began.
pub fn run_inputs(message: &AppliedInputs, config: &Config, begun: &Rates) -> RunInputs {
    RunInputs {
        step: message.step,
        skipped: message.skipped_steps,
        reset: message.reset,
        inputs: flexdrill_core::inputs::Inputs {
            rotary_speed: message.rotary_speed,
            weight_on_bit: message.weight_on_bit,
            rate_of_penetration: message.rate_of_penetration,
            standpipe_pressure: message.standpipe_pressure,
        },
        slew: [
            message.rotary_speed_slew,
            message.weight_on_bit_slew,
            message.rate_of_penetration_slew,
            message.standpipe_pressure_slew,
        ],
        live: flexdrill_core::tool::LiveParameters {
            inner_friction: message.inner_friction,
            outer_friction: message.outer_friction,
            bit_friction_factor: message.bit_friction_factor,
        },
        whirl: config.whirl_settings(),
        input_quality: message.input_quality,
        refinement: message.refinement.into(),
        schedule: schedule(config, begun),
    }
}
