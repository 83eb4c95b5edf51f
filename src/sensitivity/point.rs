//! One run of the twin at constant inputs, of which the second half is measured.

use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{Simulation, Snapshot};
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn};

/// Model time between two looks at the motion (s): the whirl analysis has a report ten times per second.
const LOOK: f64 = 0.1;

/// What a run is loaded with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// Rotary speed (rad/s).
    pub speed: f64,
    /// Weight on bit (N), as the configuration's input is meant: above a hoist slacked off at the surface.
    pub weight: f64,
    /// Model time (s).
    pub seconds: f64,
}

impl Load {
    /// Under another weight (N), at least 0: no rig pulls at a bit on bottom.
    pub fn with_weight(self, weight: f64) -> Self {
        Self {
            weight: weight.max(0.0),
            ..self
        }
    }

    /// At another speed (rad/s).
    pub fn with_speed(self, speed: f64) -> Self {
        Self { speed, ..self }
    }
}

flexdrill_base::listed! {
    /// What a run is measured by.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Figure: 2 {
        /// Mean torque at the bit (N m).
        BitTorque: "bit_torque", "N m";
        /// Mean weight at the bit (N).
        BitWeight: "bit_weight", "kN";
        /// Normal force of pipe and guide per station, root mean square over time and stations (N).
        PipeGuideForce: "pipe_guide_force", "N";
        /// The same of guide and wall (N).
        GuideWallForce: "guide_wall_force", "N";
        /// Mean of (max - min) / (2 mean) of the bit's speed.
        Ripple: "bit_speed_ripple", "";
        /// Mean whirl ratio of the station that whirl bends most often; a time without whirl of one rate counts as 0.
        WhirlRatio: "whirl_ratio", "";
        /// Mean rate of penetration (m/s), where the rock answers the advance.
        RateOfPenetration: "rate_of_penetration", "m/h";
    }
}

/// The figures of a run, by [`Figure`]; not a number where the tool has no such quantity.
pub type Found = [f64; Figure::ALL.len()];

impl Figure {
    /// Name and unit in the table.
    pub const fn name_and_unit(self) -> (&'static str, &'static str) {
        let [name, unit] = self.row();
        (name, unit)
    }

    /// A value in the unit of the table.
    pub fn shown(self, value: f64) -> f64 {
        match self {
            Self::BitWeight => n_to_kn(value),
            Self::RateOfPenetration => m_per_s_to_m_per_h(value),
            _ => value,
        }
    }
}

/// A run to be made.
#[derive(Debug, Clone)]
pub struct Point {
    /// The configuration, which begins with the weight.
    pub config: Config,
    /// Speed, weight and time.
    pub load: Load,
}

/// Sums over the looks of a run.
#[derive(Default)]
struct Sums {
    looks: f64,
    of: Found,
}

impl Point {
    /// A run of a configuration under a load.
    ///
    /// # Errors
    /// Why the configuration refuses the weight, in words.
    pub fn new(config: Config, load: Load) -> Result<Self, String> {
        let config = config
            .with_value("inputs.weight_on_bit.initial_kn", n_to_kn(load.weight))
            .map_err(|error| error.to_string())?;
        Ok(Self { config, load })
    }

    /// Makes the run. `report` gets the share of its model time that is done, 0 to 1.
    ///
    /// # Errors
    /// Why there are no figures, in words.
    pub fn run(&self, report: &mut impl FnMut(f64)) -> Result<Found, String> {
        let settings = self.config.simulation();
        let mut simulation = Simulation::new(&self.config.tool(), &settings).map_err(|error| error.to_string())?;
        let inputs = Inputs {
            rotary_speed: self.load.speed,
            weight_on_bit: self.load.weight,
            // What the rig need not send is as configured.
            ..settings.initial_inputs
        };
        let step = simulation.settings().time_step;
        let per_look = ((LOOK / step).round() as u64).max(1);
        let looks = (self.load.seconds / (per_look as f64 * step)).ceil().max(2.0) as u64;
        let per_second = ((1.0 / step).round() as u64).max(1);
        // As a run that need not keep a pace: the step that the motion needs.
        simulation.set_refinement(simulation.quality().choice.wanted);
        let mut snapshot = simulation.new_snapshot();
        let mut sums = Sums::default();
        for look in 0..looks {
            for _ in 0..per_look {
                if let StepOutcome::Failed(failure) = simulation.advance(&inputs) {
                    return Err(format!("the step at {:.1} s failed: {failure}", simulation.time()));
                }
                // The step is chosen once per second, as the node does: a choice within a second would follow single
                // impacts.
                if simulation.step().is_multiple_of(per_second) {
                    simulation.set_refinement(simulation.quality().choice.wanted);
                    report(simulation.time() / self.load.seconds);
                }
            }
            // Each look ends an interval of the statistics, so that the intervals are disjoint. The first half of the
            // run is that of the start.
            simulation.snapshot(&mut snapshot, true);
            if 2 * look >= looks {
                sums.add(&snapshot, simulation.advance_rate());
            }
        }
        Ok(sums.figures())
    }
}

/// Mean square over stations.
fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64
}

/// Whirl ratio of the station that whirl bends most often, 0 where none whirls at one rate.
fn worst_ratio(snapshot: &Snapshot) -> f64 {
    let whirl = &snapshot.whirl;
    let stations = whirl.bending_cycles.iter().zip(&whirl.whirl_ratio);
    let whirling = stations.filter(|(cycles, ratio)| **cycles > 0.0 && ratio.is_finite());
    whirling
        .max_by(|a, b| a.0.total_cmp(b.0))
        .map_or(0.0, |(_, ratio)| *ratio)
}

impl Sums {
    fn add(&mut self, snapshot: &Snapshot, advance: Option<f64>) {
        self.looks += 1.0;
        for figure in Figure::ALL {
            self.of[figure as usize] += match figure {
                Figure::BitTorque => snapshot.bit.mean_torque,
                Figure::BitWeight => snapshot.bit.mean_weight_on_bit,
                Figure::PipeGuideForce => mean_square(&snapshot.contacts.pipe_guide.normal_rms),
                Figure::GuideWallForce => mean_square(&snapshot.contacts.guide_wall.normal_rms),
                Figure::Ripple => snapshot.bit.stick_slip_index,
                Figure::WhirlRatio => worst_ratio(snapshot),
                // Where it is an input, no key moves it.
                Figure::RateOfPenetration => advance.unwrap_or(f64::NAN),
            };
        }
    }

    fn figures(&self) -> Found {
        Figure::ALL.map(|figure| {
            let mean = self.of[figure as usize] / self.looks;
            match figure {
                Figure::PipeGuideForce | Figure::GuideWallForce => mean.sqrt(),
                _ => mean,
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_means_and_roots_of_mean_squares() {
        let mut snapshot = Snapshot::default();
        let mut sums = Sums::default();
        for (force, torque) in [(3.0, 1.0), (4.0, 2.0)] {
            snapshot.contacts.pipe_guide.normal_rms = vec![force, 0.0];
            snapshot.bit.mean_torque = torque;
            snapshot.whirl.bending_cycles = vec![0.0, 3.0, 2.0];
            snapshot.whirl.whirl_ratio = vec![f64::NAN, -torque, -5.0];
            sums.add(&snapshot, None);
        }
        let found = sums.figures();
        assert_eq!(found[Figure::BitTorque as usize], 1.5);
        // Of 9 and 16 over two stations.
        assert_eq!(found[Figure::PipeGuideForce as usize], 6.25_f64.sqrt());
        assert_eq!(found[Figure::WhirlRatio as usize], -1.5);
        assert!(found[Figure::RateOfPenetration as usize].is_nan());
    }
}
