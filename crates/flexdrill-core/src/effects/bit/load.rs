//! The rock's torque and weight on the bit at the last residual, with what the tangent needs of them.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::bristle::Held;
use super::groove::GrooveMark;
use super::law::Answer;
use super::{Bristle, Groove};
use crate::elements::slip::{Slip, SlipMemory};
use crate::tool::description::{RockLaw, Weakening};

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

/// How the bit holds the rock at the end of a step: all that a run needs to continue.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BitState {
    /// `None` for the paper's law.
    bristle: Option<Bristle>,
    /// Of the law with depth of cut.
    groove: Option<Groove>,
}

#[cfg(test)]
impl BitState {
    /// A bit that holds the rock by `bristle` over the paths in `groove`.
    pub(super) fn of(bristle: Bristle, groove: Groove) -> Self {
        Self {
            bristle: Some(bristle),
            groove: Some(groove),
        }
    }
}

/// Torque and weight with their derivatives at the last residual, and the memory of the step's corrections.
#[derive(Debug, Clone)]
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
    /// Elastic energy of the bit's twist (J).
    pub elastic: f64,
    /// Angle and depth of the bit at the last residual (rad, m), and depth down to which the wear flats press (m).
    at: [f64; 3],
    /// `None` before the first residual of a step.
    memory: Option<SlipMemory>,
    state: BitState,
    /// Size of the step (s); 0 at rest.
    step: f64,
    /// The bristle at the last residual of the step.
    held: Option<Held>,
}

/// See [`BitLoad::mark`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BitMark {
    bristle: Option<Bristle>,
    groove: Option<GrooveMark>,
}

/// What the rock resists with, before it is known in which sense the bit turns or whether it sticks.
struct Resistance {
    answer: Answer,
    /// P and dP/domega (s/rad) of the friction.
    factor: [f64; 2],
    /// The same of cutting.
    of_cutting: [f64; 2],
}

impl BitLoad {
    /// Room for what `law` keeps.
    pub fn new(law: &RockLaw) -> Self {
        let groove = match law {
            RockLaw::DepthOfCut(cut) => Some(Groove::new(cut.blades)),
            _ => None,
        };
        let bristle = match law {
            RockLaw::Paper => None,
            _ => Some(Bristle::default()),
        };
        Self {
            torque: 0.0,
            slope: 0.0,
            torque_by: [0.0; 2],
            weight: 0.0,
            weight_by: [0.0; 2],
            depth_of_cut: 0.0,
            elastic: 0.0,
            at: [0.0; 3],
            memory: None,
            state: BitState { bristle, groove },
            step: 0.0,
            held: None,
        }
    }

    /// Clears the memory at the start of a step of size `step` (s), or with 0 of a state at rest, in which the torque of a bit
    /// that sticks stays.
    pub fn begin(&mut self, step: f64) {
        self.memory = None;
        self.held = None;
        self.step = step;
    }

    /// Evaluates torque, weight and slopes.
    pub fn evaluate(&mut self, law: &RockLaw, bit: &BitAt) {
        let resistance = self.resistance(law, bit);
        match self.state.bristle {
            Some(bristle) => self.stick(&bristle, bit, &resistance),
            None => self.slide(bit, &resistance.answer),
        }
        let answer = &resistance.answer;
        (self.weight, self.weight_by) = (answer.weight, answer.weight_by);
        self.depth_of_cut = answer.depth_of_cut;
        self.at = [bit.angle, bit.depth, answer.pressed];
    }

    fn resistance(&self, law: &RockLaw, bit: &BitAt) -> Resistance {
        let [full, weight] = bit.given;
        let (answer, weakening, part) = match (law, &self.state.groove) {
            (RockLaw::DepthOfCut(cut), Some(groove)) => {
                // Where the cutters were at the start of the step: the share does not change within it.
                let share = self.state.bristle.map_or(1.0, |bristle| groove.share(bristle.root()));
                let answer = cut.answer(bit.radius, bit.depth, bit.angle, groove, share);
                (answer, &cut.weakening, cut.cutting_weakening)
            }
            (RockLaw::Weakening(weakening), _) => (
                Answer {
                    torque: 0.0,
                    friction: full,
                    weight,
                    ..Answer::default()
                },
                weakening,
                0.0,
            ),
            _ => (
                Answer {
                    torque: full,
                    weight,
                    ..Answer::default()
                },
                &Weakening::NONE,
                0.0,
            ),
        };
        let (factor, slope) = if weakening.ratio > 1.0 {
            weakening.at(bit.speed)
        } else {
            (1.0, 0.0)
        };
        Resistance {
            answer,
            factor: [factor, slope],
            of_cutting: [1.0 + part * (factor - 1.0), part * slope],
        }
    }

    /// Eq. 1 with a smooth sign of the speed.
    fn slide(&mut self, bit: &BitAt, answer: &Answer) {
        let full = answer.torque;
        let mut slip = Slip::at(bit.speed, full, bit.slip_rate);
        match &mut self.memory {
            Some(memory) => memory.follow(&mut slip, full, bit.slip_rate),
            None => self.memory = Some(SlipMemory::new(slip)),
        }
        (self.torque, self.slope) = (slip.friction, slip.slope);
    }

    /// Sticks on the bristle or slips with the rock's torque.
    fn stick(&mut self, bristle: &Bristle, bit: &BitAt, resistance: &Resistance) {
        let Resistance {
            answer,
            factor: [factor, factor_slope],
            of_cutting: [cutting, cutting_slope],
        } = resistance;
        let friction = answer.friction * factor;
        let limits = [answer.torque * cutting + friction, friction];
        let held = bristle.turned(bit.radius, self.step, bit.angle, limits);
        self.torque = held.bristle.torque();
        self.elastic = held.bristle.energy(bit.radius);
        let sense = f64::from(held.slips);
        // Only a bit that slips ahead cuts.
        let (cut, cut_slope) = if held.slips > 0 {
            (answer.torque_by.map(|by| by * cutting), answer.torque * cutting_slope)
        } else {
            ([0.0; 2], 0.0)
        };
        self.slope = sense * answer.friction * factor_slope + cut_slope;
        self.torque_by = [
            cut[0] + sense * factor * answer.friction_by_depth,
            cut[1] + held.by_angle,
        ];
        // Newton's tangent of a slipping bit leads far to the other side of sticking, and back from there, without end. A bit
        // that has crossed so gets the stiffness of the line through both.
        if self.held.is_some_and(|last| last.slips * held.slips < 0) {
            self.torque_by[1] = held.secant;
        }
        self.held = Some(held);
    }

    /// Whether the tangent has derivatives by angle and depth.
    pub fn holds(&self) -> bool {
        self.state.bristle.is_some()
    }

    /// Begins with a flat bottom of the hole at `depth` (m), the bit at `angle` (rad) without torque.
    pub fn start(&mut self, angle: f64, depth: f64) {
        if let Some(groove) = &mut self.state.groove {
            groove.begin(angle, depth);
        }
        if let Some(bristle) = &mut self.state.bristle {
            *bristle = Bristle::at(angle);
        }
        self.held = None;
    }

    /// Takes the last residual as the end of a step: the blades have left their paths.
    pub fn accept(&mut self) {
        let [angle, depth, pressed] = self.at;
        if let (Some(bristle), Some(held)) = (&mut self.state.bristle, self.held) {
            *bristle = held.bristle;
        }
        if let Some(groove) = &mut self.state.groove {
            groove.record(angle, depth, pressed);
            groove.slide_to(self.state.bristle.map_or(angle, |bristle| bristle.root()));
        }
    }

    /// What a retreat from a step needs.
    pub fn mark(&self) -> BitMark {
        BitMark {
            bristle: self.state.bristle,
            groove: self.state.groove.as_ref().map(Groove::mark),
        }
    }

    /// Goes back to a mark of the present step.
    pub fn rewind(&mut self, mark: &BitMark) {
        self.state.bristle = mark.bristle;
        if let (Some(groove), Some(mark)) = (&mut self.state.groove, &mark.groove) {
            groove.rewind(mark);
        }
    }

    /// Takes whole turns off the angle.
    pub fn unwind(&mut self, turns: f64) {
        if let Some(groove) = &mut self.state.groove {
            groove.unwind(turns);
        }
        if let Some(bristle) = &mut self.state.bristle {
            bristle.unwind(turns * TAU);
        }
    }

    /// How the bit holds the rock, to be saved.
    #[cfg(feature = "checkpoints")]
    pub fn state(&self) -> &BitState {
        &self.state
    }

    /// The paths of the blades, of the law with depth of cut.
    #[cfg(test)]
    pub(super) fn groove(&self) -> Option<&Groove> {
        self.state.groove.as_ref()
    }

    /// Whether a saved state is one of this bit.
    #[cfg(feature = "checkpoints")]
    pub fn fits(&self, saved: &BitState) -> bool {
        let bristles = self.state.bristle.is_some() == saved.bristle.is_some();
        let grooves = match (&self.state.groove, &saved.groove) {
            (Some(groove), Some(saved)) => groove.fits(saved),
            (None, None) => true,
            _ => false,
        };
        bristles && grooves
    }

    /// Continues with a saved state that fits.
    #[cfg(feature = "checkpoints")]
    pub fn restore(&mut self, saved: &BitState) {
        self.state.bristle = saved.bristle;
        if let (Some(groove), Some(saved)) = (&mut self.state.groove, &saved.groove) {
            groove.copy_from(saved);
        }
        self.held = None;
    }
}
