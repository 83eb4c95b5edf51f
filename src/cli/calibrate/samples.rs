//! The samples of a field log or a bag, row by row.

use std::path::Path;

use crate::cli::output::tell;
use flexdrill_bag::BagError;
use flexdrill_calibration::windows::{Channel, Sample};
use flexdrill_core::inputs::{InputKind, MeasuredKind};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_field_log::InputSequence;
use flexdrill_messages::std_msgs::Float64;
use flexdrill_messages::{Message, RigInputs, RigMeasured, topics};
use flexdrill_outputs::{InputValues as _, MeasuredValues as _};
use flexdrill_text::printable;

/// The measured quantity of a channel.
pub(super) const fn kind(channel: Channel) -> MeasuredKind {
    match channel {
        Channel::SurfaceTorque => MeasuredKind::SurfaceTorque,
        Channel::HookLoad => MeasuredKind::HookLoad,
        Channel::BitTorque => MeasuredKind::DownholeTorque,
        Channel::BitWeight => MeasuredKind::DownholeWeightOnBit,
        Channel::RateOfPenetration => MeasuredKind::RateOfPenetration,
    }
}

fn empty(time: f64, row: u64) -> Sample {
    Sample {
        time,
        row,
        rotary_speed: f64::NAN,
        weight: f64::NAN,
        measured: [f64::NAN; Channel::COUNT],
    }
}

fn set(sample: &mut Sample, input: InputKind, value: f64) {
    match input {
        InputKind::RotarySpeed => sample.rotary_speed = rpm_to_rad_per_s(value),
        InputKind::WeightOnBit => sample.weight = kn_to_n(value),
        InputKind::RateOfPenetration | InputKind::StandpipePressure => {}
    }
}

/// The rows of a field log with their inputs and measured values.
pub(super) fn of_log(sequence: &InputSequence) -> Vec<Sample> {
    let mut all = std::collections::BTreeMap::<u64, Sample>::new();
    for input in &sequence.inputs {
        let sample = all.entry(input.row).or_insert_with(|| empty(input.time, input.row));
        set(sample, input.kind, input.value);
    }
    for row in sequence.measured.rows() {
        let sample = all.entry(row.row).or_insert_with(|| empty(row.time, row.row));
        for (measured, value) in row.values() {
            if let Some(channel) = Channel::ALL.into_iter().find(|channel| kind(*channel) == measured) {
                sample.measured[channel as usize] = value;
            }
        }
    }
    let mut samples: Vec<Sample> = all.into_values().collect();
    // Rows and times rise together, except in a log that has its newest row first.
    samples.sort_by(|a, b| a.time.total_cmp(&b.time));
    samples
}

/// The messages of `rig/measured` of a bag, each with the newest inputs before it. Inputs older than `holds` seconds are
/// unknown.
///
/// # Errors
/// When the bag cannot be read, or has one of these topics as another type.
pub(super) fn of_bag(path: &Path, holds: f64) -> Result<Vec<Sample>, BagError> {
    // Topics are matched by their end, because a bag carries the namespace of its rig.
    let mut bag = flexdrill_bag::open(path)?;
    for fault in bag.faults() {
        tell!("{}", printable(&fault.to_string()));
    }
    // A fit without an input that the bag has as another type would be one to other data.
    let plain = InputKind::ALL.map(|kind| (kind.topic(), Float64::ROS_TYPE));
    let own = [
        (topics::RIG_MEASURED.name, RigMeasured::ROS_TYPE),
        (topics::RIG_INPUTS.name, RigInputs::ROS_TYPE),
    ];
    for (name, ros_type) in plain.into_iter().chain(own) {
        let found = bag.topic_of_type(name, ros_type);
        if let Err(error @ (BagError::WrongType { .. } | BagError::WrongEncoding { .. })) = found {
            return Err(error);
        }
    }
    let wanted = |name: &str, known: &topics::TopicInfo| name.trim_start_matches('/').ends_with(known.name);
    bag.select(|topic| {
        wanted(&topic.name, &topics::RIG_MEASURED)
            || wanted(&topic.name, &topics::RIG_INPUTS)
            || InputKind::ALL.iter().any(|kind| topic.is(kind.topic()))
    });
    // Age minus infinity: an input that never came is older than any `holds`.
    let mut newest = [(f64::NEG_INFINITY, f64::NAN); InputKind::COUNT];
    let (mut origin, mut samples) = (None, Vec::new());
    for message in bag.by_ref() {
        let message = match message {
            // A damaged part costs its own samples.
            Err(error @ BagError::Damaged { .. }) => {
                tell!("damaged: {}", printable(&error.to_string()));
                continue;
            }
            message => message?,
        };
        // Seconds since the first message keep the digits that nanoseconds since 1970 lose in an `f64`.
        let first = *origin.get_or_insert(message.log_time);
        let time = message.log_time.saturating_sub(first) as f64 * 1e-9;
        match message.topic.ros_type.as_str() {
            RigMeasured::ROS_TYPE => {
                let measured: RigMeasured = message.decode()?;
                // What the rig itself marks as bad is no observation, and fitting to it would move the coefficients.
                if measured.quality != RigMeasured::GOOD {
                    continue;
                }
                // A sample is made where the rig measured; inputs come at other rates and are those that held then.
                let mut sample = empty(time, samples.len() as u64 + 1);
                for (kind, (at, value)) in InputKind::ALL.into_iter().zip(newest) {
                    if time - at <= holds {
                        set(&mut sample, kind, value);
                    }
                }
                sample.measured = Channel::ALL.map(|channel| measured.value(kind(channel)).unwrap_or(f64::NAN));
                samples.push(sample);
            }
            RigInputs::ROS_TYPE => {
                let inputs: RigInputs = message.decode()?;
                // `rig/inputs` carries all quantities in one message, NaN for those that are not in it.
                for kind in InputKind::ALL {
                    if let Some(value) = inputs.value(kind).filter(|value| value.is_finite()) {
                        newest[kind.index()] = (time, value);
                    }
                }
            }
            Float64::ROS_TYPE => {
                let value = message.decode::<Float64>()?.data;
                if let Some(kind) = InputKind::ALL.into_iter().find(|kind| message.topic.is(kind.topic())) {
                    newest[kind.index()] = (time, value);
                }
            }
            _ => {}
        }
    }
    Ok(samples)
}
