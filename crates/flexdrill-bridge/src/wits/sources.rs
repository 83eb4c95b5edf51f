//! Which connection serves each quantity: two programs that send one quantity over one bridge would drive the twin in turn.

use std::collections::BTreeMap;

use flexdrill_core::inputs::InputKind;
use flexdrill_messages::{RigInputs, RigSurvey};
use flexdrill_outputs::MeasuredValues as _;

use super::Reading;
use crate::{Quantity, SurveyKind};

/// After so long without a value of it, another connection may serve a quantity (ns). Rigs send every second, slow ones
/// every few seconds; the twin's inputs are stale by then.
const SILENT_AFTER: i64 = 10_000_000_000;

/// Values of a frame that were left out, because another connection serves their quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refused {
    /// The quantities.
    pub quantities: Vec<Quantity>,
    /// The connection that serves the first of them.
    pub serving: u64,
}

/// The connections that serve the quantities of a line.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    serving: BTreeMap<Quantity, Serving>,
    /// When a value of an input was refused last (ns since 1970).
    disputed: Option<i64>,
}

#[derive(Debug, Clone, Copy)]
struct Serving {
    connection: u64,
    /// When its newest value came (ns since 1970).
    newest: i64,
}

impl Sources {
    /// Leaves out the values of a frame of `connection`, arrived at `arrived` (ns since 1970), whose quantities another
    /// connection serves; none where all are its own. While an input is disputed, all inputs are marked as doubtful: the
    /// bridge cannot know which of the sources is the rig.
    pub fn sort(&mut self, connection: u64, arrived: i64, reading: &mut Reading) -> Option<Refused> {
        let mut refused: Option<Refused> = None;
        for quantity in Quantity::all() {
            if !is_given(reading, quantity) {
                continue;
            }
            let serving = self.serving.entry(quantity).or_insert(Serving {
                connection,
                newest: arrived,
            });
            let is_silent = arrived.saturating_sub(serving.newest) > SILENT_AFTER;
            if serving.connection == connection || is_silent {
                *serving = Serving {
                    connection,
                    newest: arrived,
                };
                continue;
            }
            let serving = serving.connection;
            leave_out(reading, quantity);
            if quantity.input().is_some() {
                self.disputed = Some(arrived);
            }
            let refused = refused.get_or_insert_with(|| Refused {
                quantities: Vec::new(),
                serving,
            });
            refused.quantities.push(quantity);
        }
        reading.measured.take_if(|measured| measured.is_empty());
        reading
            .survey
            .take_if(|survey| survey.measured_depth.is_nan() || survey.inclination.is_nan());
        reading
            .inputs
            .take_if(|inputs| !InputKind::ALL.into_iter().any(|kind| !field(inputs, kind).is_nan()));
        if let Some(inputs) = reading.inputs.as_mut().filter(|_| self.is_disputed(arrived)) {
            inputs.quality = RigInputs::SUSPECT;
        }
        refused
    }

    /// Whether two connections send one input at `now` (ns since 1970).
    pub fn is_disputed(&self, now: i64) -> bool {
        self.disputed.is_some_and(|at| now.saturating_sub(at) <= SILENT_AFTER)
    }

    /// A connection has ended: others may serve its quantities.
    pub fn closed(&mut self, connection: u64) {
        self.serving.retain(|_, serving| serving.connection != connection);
    }
}

fn field(inputs: &mut RigInputs, kind: InputKind) -> &mut f64 {
    match kind {
        InputKind::RotarySpeed => &mut inputs.rotary_speed_rpm,
        InputKind::WeightOnBit => &mut inputs.weight_on_bit_kn,
        InputKind::RateOfPenetration => &mut inputs.rate_of_penetration_m_per_h,
        InputKind::StandpipePressure => &mut inputs.standpipe_pressure_mpa,
    }
}

fn surveyed(survey: &mut RigSurvey, kind: SurveyKind) -> &mut f64 {
    match kind {
        SurveyKind::Depth => &mut survey.measured_depth,
        SurveyKind::Inclination => &mut survey.inclination,
        SurveyKind::Azimuth => &mut survey.azimuth,
    }
}

fn is_given(reading: &mut Reading, quantity: Quantity) -> bool {
    let of_inputs = quantity
        .input()
        .zip(reading.inputs.as_mut())
        .is_some_and(|(kind, inputs)| !field(inputs, kind).is_nan());
    let of_measured = match (quantity, &reading.measured) {
        (Quantity::Measured(kind), Some(measured)) => measured.value(kind).is_some(),
        _ => false,
    };
    let of_survey = match (quantity, &mut reading.survey) {
        (Quantity::Survey(kind), Some(survey)) => !surveyed(survey, kind).is_nan(),
        _ => false,
    };
    of_inputs || of_measured || of_survey
}

fn leave_out(reading: &mut Reading, quantity: Quantity) {
    if let Some((kind, inputs)) = quantity.input().zip(reading.inputs.as_mut()) {
        *field(inputs, kind) = f64::NAN;
    }
    if let (Quantity::Measured(kind), Some(measured)) = (quantity, &mut reading.measured) {
        measured.set(kind, f64::NAN);
    }
    if let (Quantity::Survey(kind), Some(survey)) = (quantity, &mut reading.survey) {
        *surveyed(survey, kind) = f64::NAN;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wits::{Decoder, Mapping, RawFrame};

    const SECOND: i64 = 1_000_000_000;

    fn reading(text: &str) -> Reading {
        let frame = RawFrame {
            lines: text.lines().map(|line| line.as_bytes().to_vec()).collect(),
            ..RawFrame::default()
        };
        Decoder::new(&Mapping::default(), "rig").decode(&frame, 0)
    }

    #[test]
    fn one_connection_serves_a_quantity_until_it_ends_or_falls_silent() {
        let mut sources = Sources::default();
        let mut first = reading("0116 0.8\n0120 40");
        assert_eq!(sources.sort(1, 0, &mut first), None);
        // Values that are not given are NaN, which equals nothing.
        assert_eq!(format!("{first:?}"), format!("{:?}", reading("0116 0.8\n0120 40")));
        // The second sends the same quantities, and one that only it has.
        let mut second = reading("0116 3\n0120 100\n0917 4");
        let refused = sources.sort(2, SECOND, &mut second).unwrap();
        assert_eq!(refused.serving, 1);
        assert_eq!(refused.quantities, [Quantity::RotarySpeed, Quantity::WeightOnBit]);
        assert_eq!(second.inputs, None);
        assert_eq!(second.measured.unwrap().downhole_torque, 4000.0);
        let mut first = reading("0116 0.8\n0120 40");
        assert_eq!(sources.sort(1, 2 * SECOND, &mut first), None);
        let inputs = first.inputs.unwrap();
        // The conversion to rad/s and back rounds.
        assert!((inputs.rotary_speed_rpm - 40.0).abs() < 1e-9);
        assert_eq!(inputs.quality, RigInputs::SUSPECT, "two sources send the speed");
        assert!(sources.is_disputed(11 * SECOND) && !sources.is_disputed(12 * SECOND));
        // The first falls silent; later the second ends.
        let mut second = reading("0120 100");
        assert_eq!(sources.sort(2, 13 * SECOND, &mut second), None);
        assert_eq!(second.inputs.unwrap().quality, RigInputs::GOOD);
        assert!(sources.sort(1, 14 * SECOND, &mut reading("0120 40")).is_some());
        sources.closed(2);
        assert_eq!(sources.sort(1, 15 * SECOND, &mut reading("0120 40")), None);
    }

    /// The rate of penetration is an input and measured: both are one value of one item.
    #[test]
    fn a_refused_rate_is_in_neither_message() {
        let mut sources = Sources::default();
        assert_eq!(sources.sort(1, 0, &mut reading("0113 18")), None);
        let mut other = reading("0113 30");
        assert!(sources.sort(2, 1, &mut other).is_some());
        assert_eq!((other.inputs, other.measured), (None, None));
    }
}
