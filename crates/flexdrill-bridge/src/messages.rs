//! Values of a rig as messages for the twin.

use flexdrill_core::inputs::InputKind;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{RigInputs, RigMeasured, RigSurvey};
use flexdrill_outputs::{InputValues as _, MeasuredValues as _};

use crate::{Quantity, SurveyKind};

/// The inputs among the values (SI) of a rig; `None` where there is none.
pub fn rig_inputs(
    value: impl Fn(Quantity) -> Option<f64>,
    header: Header,
    quality: u8,
    source: &str,
) -> Option<RigInputs> {
    let given = InputKind::ALL.map(|kind| {
        let quantity = Quantity::all().find(|quantity| quantity.input() == Some(kind))?;
        Some(kind.from_si(value(quantity)?))
    });
    if given.iter().all(Option::is_none) {
        return None;
    }
    Some(RigInputs::of(header, given, quality, source.to_owned()))
}

/// The measured quantities among the values (SI) of a rig; `None` where there is none.
pub fn rig_measured(
    value: impl Fn(Quantity) -> Option<f64>,
    header: Header,
    quality: u8,
    source: &str,
) -> Option<RigMeasured> {
    let mut message = RigMeasured::not_given(header, quality, source.to_owned());
    for quantity in Quantity::all() {
        if let Quantity::Measured(kind) = quantity
            && let Some(value) = value(quantity)
        {
            message.set(kind, value);
        }
    }
    (!message.is_empty()).then_some(message)
}

/// The survey among the values (SI) of a rig; `None` without a depth or an inclination.
pub fn rig_survey(
    value: impl Fn(Quantity) -> Option<f64>,
    header: Header,
    quality: u8,
    source: &str,
) -> Option<RigSurvey> {
    let of = |kind| value(Quantity::Survey(kind));
    Some(RigSurvey {
        header,
        measured_depth: of(SurveyKind::Depth)?,
        inclination: of(SurveyKind::Inclination)?,
        azimuth: of(SurveyKind::Azimuth).unwrap_or(f64::NAN),
        // No rig sends them.
        inclination_deviation: f64::NAN,
        azimuth_deviation: f64::NAN,
        quality,
        source: source.to_owned(),
    })
}
