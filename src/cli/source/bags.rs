//! The samples of a bag.

use std::path::Path;

use anyhow::{anyhow, ensure};

use super::{MeasuredSample, Sample, Samples, SurveySample};
use crate::bag::{self, BagError};
use crate::cli::output::tell;
use crate::messages::std_msgs::Float64;
use crate::messages::{Message, RigInputs, RigMeasured, RigSurvey, topics};
use crate::rig_inputs::stamped;
use flexdrill_core::inputs::InputKind;
use flexdrill_text::printable;

/// Where the topics follow on those of the plain inputs.
const STAMPED: usize = InputKind::COUNT;
const MEASURED: usize = InputKind::COUNT + 1;
const SURVEYS: usize = InputKind::COUNT + 2;

/// The inputs of a message with a stamp that arrived at `time`; the configuration sets the allowed skew.
pub(super) fn of_message(message: &RigInputs, time: i64) -> impl Iterator<Item = Sample> {
    let given = InputKind::ALL.into_iter().zip(stamped::values(message, time, 0.0));
    given.filter_map(move |(kind, value)| {
        let (value, stamp) = value?;
        Some(Sample {
            time,
            kind,
            value,
            stamp: Some(stamp),
        })
    })
}

/// What to do with a bag of which a part cannot be read.
fn remedy(path: &Path) -> String {
    format!(
        "flexdrill recover {} --out NEW writes a bag of all that can be read, and names the rest",
        path.display()
    )
}

/// The inputs and measured values of a bag.
///
/// # Errors
/// When it or a part of it cannot be read, it lacks rotary speed or weight on bit, or has an input as another type.
pub(super) fn read(path: &Path) -> anyhow::Result<Samples> {
    let mut bag = bag::open(path)?;
    for fault in bag.faults() {
        // A run on half of the inputs would be taken for one on all of them.
        ensure!(!fault.loses(), "{fault}; {}", remedy(path));
        tell!("{}", printable(&fault.to_string()));
    }
    let mut unfit = Vec::new();
    let mut named = |name: &str, ros_type| match bag.topic_of_type(name, ros_type) {
        Ok(topic) => Some(topic.name.clone()),
        Err(BagError::NoTopic { .. }) => None,
        Err(error) => {
            unfit.push(error);
            None
        }
    };
    let stamped = named(topics::RIG_INPUTS.name, RigInputs::ROS_TYPE);
    let measured = named(topics::RIG_MEASURED.name, RigMeasured::ROS_TYPE);
    let surveys = named(topics::RIG_SURVEY.name, RigSurvey::ROS_TYPE);
    let plain = InputKind::ALL.map(|kind| named(kind.topic(), Float64::ROS_TYPE));
    for error in unfit {
        // An input that cannot be read is not one that the rig did not send: the model would assume a value for it.
        if stamped.is_none() {
            let why = format!("{}: a topic of the rig's inputs cannot be read", path.display());
            return Err(anyhow::Error::from(error).context(why));
        }
        tell!("not used: {}", printable(&error.to_string()));
    }
    // Rotary speed and weight drive the model and must come from somewhere; all else has an assumed value.
    let [speed, weight, ..] = &plain;
    if stamped.is_none() && (speed.is_none() || weight.is_none()) {
        let missing = [InputKind::RotarySpeed, InputKind::WeightOnBit].map(|kind| bag.topic(kind.topic()).err());
        let missing = missing.into_iter().flatten().next().map(anyhow::Error::from);
        let missing = missing.unwrap_or_else(|| anyhow!("no inputs"));
        return Err(missing.context(format!(
            "{}: the bag needs rotary speed and weight on bit",
            path.display()
        )));
    }
    let [speed, weight, advance, pressure] = plain;
    let names: [Option<String>; InputKind::COUNT + 3] = [speed, weight, advance, pressure, stamped, measured, surveys];
    // A topic counts by name and type: another program may use the name for another type.
    let role = |name: &str, ros_type: &str| {
        names.iter().enumerate().position(|(index, known)| {
            let wanted = match index {
                STAMPED => RigInputs::ROS_TYPE,
                MEASURED => RigMeasured::ROS_TYPE,
                SURVEYS => RigSurvey::ROS_TYPE,
                _ => Float64::ROS_TYPE,
            };
            known.as_deref() == Some(name) && wanted == ros_type
        })
    };
    bag.select(|topic| role(&topic.name, &topic.ros_type).is_some());
    let mut samples = Samples::default();
    for message in bag.by_ref() {
        let message = message.map_err(|error| anyhow!("{error}; {}", remedy(path)))?;
        let time = message.log_time;
        match role(&message.topic.name, &message.topic.ros_type) {
            Some(MEASURED) => samples.measured.push(MeasuredSample {
                time,
                message: message.decode()?,
            }),
            Some(SURVEYS) => samples.surveys.push(SurveySample {
                time,
                message: message.decode()?,
            }),
            Some(STAMPED) => samples.inputs.extend(of_message(&message.decode()?, time)),
            Some(index) => samples.inputs.push(Sample {
                time,
                kind: InputKind::ALL[index],
                value: message.decode::<Float64>()?.data,
                stamp: None,
            }),
            None => {}
        }
    }
    for cut in bag.cuts() {
        tell!(
            "{} was cut short ({}); the samples up to there are used",
            cut.path.display(),
            cut.reason
        );
    }
    Ok(samples)
}
