//! What acts on a plausible tool where the rig's sensors of the inputs show a reading.

use flexdrill_core::inputs::Inputs;
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
        let mut acts = *shown;
        acts.inputs = self.acting_inputs(shown.inputs);
        acts.slew[0] /= factor(self.speed);
        acts.slew[1] /= factor(self.weight);
        acts
    }

    /// The same of the inputs alone.
    pub fn acting_inputs(&self, shown: Inputs) -> Inputs {
        let tare = self.weight.map_or(0.0, |sensor| sensor.tare);
        let mut acts = shown;
        acts.rotary_speed /= factor(self.speed);
        // A reading of nothing is a bit off bottom, which the block shows too.
        if acts.weight_on_bit > 0.0 {
            acts.weight_on_bit = ((acts.weight_on_bit - tare) / factor(self.weight)).max(0.0);
        }
        acts
    }
}

fn factor(sensor: Option<SensorError>) -> f64 {
    sensor.map_or(1.0, |sensor| sensor.factor)
}
