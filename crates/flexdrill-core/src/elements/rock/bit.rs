//! The rock's torque and weight on the bit at the last residual, with what the tangent needs of them.

use super::{Answer, Groove, RockLaw, Weakening};
use crate::elements::slip::{Slip, SlipMemory};

/// The bit as the rock finds it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BitAt {
    /// Radius (m).
    pub radius: f64,
    /// Speed over which the torque changes its sign (rad/s).
    pub slip_rate: f64,
    /// Torque of Eq. 1 (N m, >= 0) and the weight that it belongs to (N), of the laws where the weight is given.
    pub given: [f64; 2],
    /// Angle (rad) and speed (rad/s).
    pub angle: f64,
    /// Speed (rad/s).
    pub speed: f64,
    /// Depth of the bit (m, down).
    pub depth: f64,
}

/// Torque and weight with their derivatives at the last residual, and the memory of the step's corrections.
#[derive(Debug, Clone, Default)]
pub struct BitLoad {
    /// Torque against the rotation (N m).
    pub torque: f64,
    /// d torque / d speed that the tangent uses (N m s/rad).
    pub slope: f64,
    /// Derivatives of the torque by depth (N) and angle (N m/rad).
    pub torque_by: [f64; 2],
    /// Weight on the bit (N, compressing).
    pub weight: f64,
    /// Derivatives of the weight by depth (N/m) and angle (N/rad).
    pub weight_by: [f64; 2],
    /// Depth of cut (m per turn); 0 for laws without one.
    pub depth_of_cut: f64,
    /// Angle and depth of the bit at the last residual (rad, m), and depth down to which the wear flats press (m).
    at: [f64; 3],
    /// `None` before the first residual of a step.
    memory: Option<SlipMemory>,
    groove: Option<Groove>,
}

/// See [`BitLoad::mark`].
pub type BitMark = super::groove::GrooveMark;

impl BitLoad {
    /// Room for what `law` keeps.
    pub fn new(law: &RockLaw) -> Self {
        let groove = match law {
            RockLaw::DepthOfCut(cut) => Some(Groove::new(cut.blades)),
            _ => None,
        };
        Self {
            groove,
            ..Self::default()
        }
    }

    /// Clears the memory at the start of a step.
    pub fn begin(&mut self) {
        self.memory = None;
    }

    /// Evaluates torque, weight and slopes.
    pub fn evaluate(&mut self, law: &RockLaw, bit: &BitAt) {
        let [full, weight] = bit.given;
        let given = Answer {
            torque: full,
            weight,
            ..Answer::default()
        };
        let (answer, weakening) = match (law, &self.groove) {
            (RockLaw::DepthOfCut(cut), Some(groove)) => {
                (cut.answer(bit.radius, bit.depth, bit.angle, groove), &cut.weakening)
            }
            (RockLaw::Weakening(weakening), _) => (
                Answer {
                    torque: 0.0,
                    friction: full,
                    weight,
                    ..Answer::default()
                },
                weakening,
            ),
            _ => (given, &Weakening::NONE),
        };
        let weakens = weakening.ratio > 1.0;
        let (factor, factor_slope) = if weakens { weakening.at(bit.speed) } else { (1.0, 0.0) };
        let full = answer.torque + answer.friction * factor;
        let mut slip = Slip::at(bit.speed, full, bit.slip_rate);
        match &mut self.memory {
            Some(memory) => memory.follow(&mut slip, full, bit.slip_rate),
            None => self.memory = Some(SlipMemory::new(slip)),
        }
        let sign = if full > 0.0 { slip.friction / full } else { 0.0 };
        self.torque = slip.friction;
        self.slope = if weakens {
            slip.slope + sign * answer.friction * factor_slope
        } else {
            slip.slope
        };
        self.torque_by = [
            sign * (answer.torque_by[0] + factor * answer.friction_by_depth),
            sign * answer.torque_by[1],
        ];
        (self.weight, self.weight_by) = (answer.weight, answer.weight_by);
        self.depth_of_cut = answer.depth_of_cut;
        self.at = [bit.angle, bit.depth, answer.pressed];
    }

    /// Whether the weight is a result of the rock's law.
    pub fn holds(&self) -> bool {
        self.groove.is_some()
    }

    /// Begins with a flat bottom of the hole at `depth` (m), the bit at `angle` (rad).
    pub fn start(&mut self, angle: f64, depth: f64) {
        if let Some(groove) = &mut self.groove {
            groove.begin(angle, depth);
        }
    }

    /// Takes the last residual as the end of a step: the blades have left their paths.
    pub fn accept(&mut self) {
        let [angle, depth, pressed] = self.at;
        if let Some(groove) = &mut self.groove {
            groove.record(angle, depth, pressed);
        }
    }

    /// What a retreat from a step needs.
    pub fn mark(&self) -> Option<BitMark> {
        self.groove.as_ref().map(Groove::mark)
    }

    /// Goes back to a mark of the present step.
    pub fn rewind(&mut self, mark: Option<BitMark>) {
        if let (Some(groove), Some(mark)) = (&mut self.groove, mark) {
            groove.rewind(&mark);
        }
    }

    /// Takes whole turns off the angle.
    pub fn unwind(&mut self, turns: f64) {
        if let Some(groove) = &mut self.groove {
            groove.unwind(turns);
        }
    }

    /// The paths of the blades, to be saved.
    #[cfg(feature = "checkpoints")]
    pub fn groove(&self) -> Option<&Groove> {
        self.groove.as_ref()
    }

    /// Whether saved paths are those of this bit.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, saved: Option<&Groove>) -> bool {
        match (&self.groove, saved) {
            (Some(groove), Some(saved)) => groove.fits(saved),
            (None, None) => true,
            _ => false,
        }
    }

    /// Continues with saved paths that fit.
    #[cfg(feature = "checkpoints")]
    pub fn restore(&mut self, saved: Option<&Groove>) {
        if let (Some(groove), Some(saved)) = (&mut self.groove, saved) {
            groove.copy_from(saved);
        }
    }
}
