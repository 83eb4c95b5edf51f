//! The samples of a bag.

use std::path::Path;

use super::{MeasuredSample, Sample, Samples};
use crate::bag;
use crate::cli::output::tell;
use crate::messages::std_msgs::Float64;
use crate::messages::{Message, RigInputs, RigMeasured, topics};
use crate::rig_inputs::stamped;
use flexdrill_core::inputs::InputKind;

/// Where the topics follow on those of the plain inputs.
const STAMPED: usize = InputKind::COUNT;
const MEASURED: usize = InputKind::COUNT + 1;

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

/// The inputs and measured values of a bag.
///
/// # Errors
/// When it cannot be read, or lacks rotary speed or weight on bit.
pub(super) fn read(path: &Path) -> anyhow::Result<Samples> {
    let mut bag = bag::open(path)?;
    let plain = InputKind::ALL.map(|kind| bag.topic(kind.topic()).map(|topic| topic.name.clone()));
    let stamped = bag.topic(topics::RIG_INPUTS.name).map(|topic| topic.name.clone());
    let measured = bag
        .topic(topics::RIG_MEASURED.name)
        .map(|topic| topic.name.clone())
        .ok();
    // Rotary speed and weight drive the model and must come from somewhere; all else has an assumed value.
    let [speed, weight, advance, pressure] = plain;
    // The optional inputs may be missing.
    let [advance, pressure] = [advance.ok(), pressure.ok()];
    let names: [Option<String>; InputKind::COUNT + 2] = match (speed, weight, stamped) {
        (Ok(speed), Ok(weight), stamped) => [Some(speed), Some(weight), advance, pressure, stamped.ok(), measured],
        // Without the plain topics, the stamped topic has the inputs.
        (speed, weight, Ok(stamped)) => [speed.ok(), weight.ok(), advance, pressure, Some(stamped), measured],
        (speed, weight, Err(_)) => {
            let error = speed.and(weight).err().map(anyhow::Error::from);
            let missing = error.unwrap_or_else(|| anyhow::anyhow!("no inputs"));
            return Err(missing.context(format!(
                "{}: the bag needs rotary speed and weight on bit",
                path.display()
            )));
        }
    };
    // A topic counts by name and type: another program may use the name for another type.
    let role = |name: &str, ros_type: &str| {
        names.iter().enumerate().position(|(index, known)| {
            let wanted = match index {
                STAMPED => RigInputs::ROS_TYPE,
                MEASURED => RigMeasured::ROS_TYPE,
                _ => Float64::ROS_TYPE,
            };
            known.as_deref() == Some(name) && wanted == ros_type
        })
    };
    bag.select(|topic| role(&topic.name, &topic.ros_type).is_some());
    let mut samples = Samples::default();
    for message in bag.by_ref() {
        let message = message?;
        let time = message.log_time;
        match role(&message.topic.name, &message.topic.ros_type) {
            Some(MEASURED) => samples.measured.push(MeasuredSample {
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
