//! Weight and torque that do not arrive at the bit in steady drilling.

use std::collections::VecDeque;

use crate::history::HELD;
use flexdrill_config::Config;
use flexdrill_core::units::kn_to_n;
use flexdrill_messages::Transfer;

/// Largest range of a weight within a window over its mean that counts as steady: setting down and picking up change it by
/// more, and a driller holds it within less.
const STEADY: f64 = 0.1;
/// Share that does not arrive from which on the report says so: a rig's weight indicator and torque sensor are read to about
/// this, so that a driller would not see less.
pub(crate) const SAID: f64 = 0.1;
/// Time for which weights must be steady, and least time of steady drilling that is judged (s): the window of the twin's
/// means, where the configuration does not set a longer one.
const LEAST_TIME: f64 = 5.0;
/// Messages that are kept for one window: a minute at 50 Hz.
const KEPT: usize = 3000;

/// What arrives at the bit of what is put in above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arrival {
    pub put_in: f64,
    pub at_bit: f64,
}

impl Arrival {
    /// The share that does not arrive.
    pub(crate) fn lost(&self) -> f64 {
        1.0 - self.at_bit / self.put_in
    }
}

/// Means over the steady drilling of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Steady {
    /// Time that they cover (s).
    pub time: f64,
    /// Whether the weights above are those at the surface, and not at the kick-off.
    pub from_surface: bool,
    /// N.
    pub weight: Arrival,
    /// N m.
    pub torque: Arrival,
    /// Weight that friction takes: of the string, of the guide on the pipe, of the wall on the guide (N).
    pub drag: [f64; 3],
}

/// Figures of one message: weight above and at the bit, torque above and at the bit, the drags.
type Figures = [f64; 7];

/// Collects the steady drilling of a recording.
#[derive(Debug, Default)]
pub(crate) struct SteadyDrilling {
    window: VecDeque<(f64, Figures)>,
    sums: Figures,
    time: f64,
    from_surface: bool,
    /// Least weight above that is judged (N).
    least: f64,
}

impl SteadyDrilling {
    /// Takes from which weight on drilling is judged (`transfer.least_weight_kn`).
    pub(crate) fn tool(&mut self, config: &Config) {
        self.least = kn_to_n(config.transfer.least_weight_kn);
    }

    /// Adds a message at its time (s).
    pub(crate) fn push(&mut self, time: f64, message: &Transfer) {
        self.from_surface = message.surface_weight.is_finite();
        let or_at_kickoff = |surface: f64, kickoff: f64| if surface.is_finite() { surface } else { kickoff };
        // A drag that the tool does not have takes nothing.
        let drag = |value: f64| if value.is_finite() { value } else { 0.0 };
        let figures = [
            or_at_kickoff(message.surface_weight, message.kickoff_weight),
            message.bit_weight,
            or_at_kickoff(message.surface_torque, message.kickoff_torque),
            message.bit_torque,
            drag(message.string_axial_drag),
            drag(message.pipe_guide_axial_drag),
            drag(message.guide_wall_axial_drag),
        ];
        let before = self.window.back().map(|(time, _)| *time);
        // A reset, or numbers that are none, begin a new window.
        if !(figures.iter().all(|value| value.is_finite()) && before.is_none_or(|before| time > before)) {
            self.window.clear();
            return;
        }
        self.window.push_back((time, figures));
        let window = message.duration.max(LEAST_TIME);
        let is_old = |(first, _): &(f64, Figures)| time - first > window;
        while self.window.len() > KEPT || self.window.front().is_some_and(is_old) {
            self.window.pop_front();
        }
        let Some(before) = before.filter(|_| self.is_steady(time, window)) else {
            return;
        };
        let held = (time - before).min(HELD);
        for (sum, value) in self.sums.iter_mut().zip(figures) {
            *sum += held * value;
        }
        self.time += held;
    }

    /// Whether the messages of the last `window` (s) have the same weights, enough to drill with. The weight at the bit is
    /// held against that above: next to nothing of it may arrive.
    fn is_steady(&self, time: f64, window: f64) -> bool {
        // The first message of the window is up to one interval younger than the window; outputs have at least 1 Hz.
        let covers = self
            .window
            .front()
            .is_some_and(|(first, _)| time - first >= window - 1.0);
        let values = |index: usize| self.window.iter().map(move |(_, figures)| figures[index]);
        let above = values(0).sum::<f64>() / self.window.len().max(1) as f64;
        let steady = |index: usize| {
            let (least, largest) = values(index).fold((f64::MAX, f64::MIN), |(least, largest), value| {
                (least.min(value), largest.max(value))
            });
            largest - least <= STEADY * above
        };
        covers && above >= self.least.max(1.0) && steady(0) && steady(1)
    }

    /// The means, where there was enough steady drilling.
    pub(crate) fn means(&self) -> Option<Steady> {
        let [weight, bit_weight, torque, bit_torque, string, pipe, wall] = self.sums.map(|sum| sum / self.time);
        (self.time >= LEAST_TIME).then_some(Steady {
            time: self.time,
            from_surface: self.from_surface,
            weight: Arrival {
                put_in: weight,
                at_bit: bit_weight,
            },
            torque: Arrival {
                put_in: torque,
                at_bit: bit_torque,
            },
            drag: [string, pipe, wall],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(weight: f64, bit_weight: f64) -> Transfer {
        Transfer {
            // As the twin adds up its steps: a hair below its window.
            duration: 4.999_999_999,
            surface_weight: weight,
            bit_weight,
            surface_torque: 130.0,
            bit_torque: 110.0,
            guide_wall_axial_drag: weight - bit_weight,
            string_axial_drag: f64::NAN,
            ..Transfer::default()
        }
    }

    #[test]
    fn weight_is_judged_in_steady_drilling_only() {
        let mut drilling = SteadyDrilling::default();
        // Setting down says nothing about what arrives.
        for step in 0..300 {
            drilling.push(f64::from(step) * 0.1, &message(1e2 * f64::from(step), 0.0));
        }
        assert_eq!(drilling.means(), None);
        for step in 300..600 {
            drilling.push(f64::from(step) * 0.1, &message(9770.0, 2900.0));
        }
        let found = drilling.means().unwrap();
        // 30 s less the window of 5 s in which the weight was changing.
        assert!((found.time - 25.0).abs() < 1.2, "{}", found.time);
        assert!((found.weight.lost() - 0.703).abs() < 1e-3 && found.from_surface);
        assert!((found.drag[2] - 6870.0).abs() < 1e-6 && found.drag[0] == 0.0);
        assert!((found.torque.lost() - 20.0 / 130.0).abs() < 1e-9);
    }

    #[test]
    fn weight_of_which_nothing_arrives_is_judged() {
        let mut drilling = SteadyDrilling::default();
        for step in 0..200 {
            drilling.push(f64::from(step) * 0.1, &message(9770.0, 0.0));
        }
        assert_eq!(drilling.means().unwrap().weight.lost(), 1.0);
    }
}
