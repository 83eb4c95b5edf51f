//! What acts on a plausible tool where the rig's sensors of the inputs show a reading.

use flexdrill_core::twin::RunInputs;

use crate::member::Member;
use crate::sensors::{Channel, SensorError};

/// The sensors of the inputs of one plausible rig: its rotary speed and its weight indicator.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Readings {
    speed: Option<SensorError>,
    weight: Option<SensorError>,
}

impl Readings {
    /// The sensors of a draw.
    pub fn of(drawn: &Member) -> Self {
        let sensor = |channel| drawn.sensors.iter().copied().find(|sensor| sensor.channel == channel);
        Self {
            speed: sensor(Channel::RotarySpeed),
            weight: sensor(Channel::WeightIndicator),
        }
    }

    /// What acts where `shown` is what the rig shows: speed and weight over their factors, the weight without its tare; slew
    /// limits alike.
    pub fn acting(&self, shown: &RunInputs) -> RunInputs {
        let factor = |sensor: Option<SensorError>| sensor.map_or(1.0, |sensor| sensor.factor);
        let tare = self.weight.map_or(0.0, |sensor| sensor.tare);
        let mut acts = *shown;
        acts.inputs.rotary_speed /= factor(self.speed);
        // A reading of nothing is a bit off bottom, which the block shows too.
        if acts.inputs.weight_on_bit > 0.0 {
            acts.inputs.weight_on_bit = ((acts.inputs.weight_on_bit - tare) / factor(self.weight)).max(0.0);
        }
        acts.slew[0] /= factor(self.speed);
        acts.slew[1] /= factor(self.weight);
        acts
    }
}
