//! The start: the tool as given, or at rest under gravity and weight on bit.

use super::Stepper;
use crate::chain::{Chain, Effect};
use crate::dynamics::carried::Carried;
use crate::dynamics::conditions::Conditions;
use crate::dynamics::energy::LedgerPoint;
use crate::dynamics::newton::{self, Rejected, Singular, Stride};
use crate::dynamics::outcome::StepFailure;
use crate::dynamics::scheme::Scheme;
use crate::dynamics::state::State;
use crate::dynamics::tolerances::Accuracy;
use crate::effects::Effects;
use crate::inputs::Inputs;

/// Why the tool could not be started.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StartError {
    /// The mass matrix with the constraints is singular.
    #[error("station {}: the accelerations at the start have no solution (pivot {:e}); \
         is there a body without mass?", .0.station, .0.pivot)]
    Singular(Singular),
    /// No step size brought the tool closer to rest.
    #[error("the tool did not come to rest: {} after {:.3} s of settling", .0, .0.time)]
    Step(#[source] StepFailure),
    /// Still moving after all steps.
    #[error(
        "the tool did not come to rest within {steps} steps: fastest node still moves at {speed:e} m/s (limit {limit:e}); \
         is it supported in every direction?"
    )]
    Moving {
        /// Steps made before giving up.
        steps: u32,
        /// Largest velocity left (m/s or rad/s).
        speed: f64,
        /// Limit (m/s or rad/s).
        limit: f64,
    },
}

/// Mass-proportional damping while settling (1/s): the softest motions have periods of a few tenths of a second.
const SETTLING_ALPHA: f64 = 30.0;
/// First and largest pseudo time step (s).
const STEPS: [f64; 2] = [1e-3, 5.0];
/// At rest when nothing moves faster (m/s, rad/s) over steps of the largest size: ten times what Newton's tolerance
/// lets through there.
const REST: f64 = 1e-6;
/// Steps before giving up.
const MOST_STEPS: u32 = 2000;

impl Stepper {
    /// Starts from the description's initial displacement and velocity, with the accelerations that steps of size `h`
    /// (s) can follow; at 0 with those in balance at that instant.
    ///
    /// A bit that turns under weight with nothing twisted behind it is braked by its torque at half a million rad/s2, for
    /// the few microseconds until the wave is on its way. The scheme would carry that on through the whole first step.
    /// Gives the state over all stations.
    ///
    /// # Errors
    /// [`StartError::Singular`].
    pub fn start_as_given(&mut self, inputs: &Inputs, h: f64) -> Result<State, StartError> {
        let mut tool = self.chain_over_stations();
        let mut state = self.as_given(&mut tool, inputs, h)?;
        let conditions = self.conditions(0.0, inputs);
        let state = self.in_full(&mut tool, &mut state, &conditions);
        self.start_from(&state, inputs);
        Ok(state)
    }

    /// The state as given in the numbering of the chain of `tool`, its accelerations as far as steps of size `h` (s) can follow them.
    fn as_given(&mut self, tool: &mut (Chain, Effects), inputs: &Inputs, h: f64) -> Result<State, StartError> {
        let conditions = self.conditions(0.0, inputs);
        tool.1.hold();
        let model = self.model();
        let mut given = State::at_rest(model);
        let d = &model.description;
        for station in &model.stations {
            let to_node = station.pipe_to_station.transpose();
            let displacement = to_node * nalgebra::Vector3::from(d.initial_pipe_displacement);
            let velocity = to_node * nalgebra::Vector3::from(d.initial_pipe_velocity);
            for k in 0..3 {
                given.q[station.pipe_above + k] = displacement[k];
                given.v[station.pipe_above + k] = velocity[k];
            }
            for first in [station.pipe_above, station.pipe_below] {
                given.v[first + 3] = d.initial_spin_rate;
            }
        }
        for &unknown in &model.held {
            given.q[unknown] = 0.0;
            given.v[unknown] = 0.0;
        }
        let mut state = tool.0.state(model);
        tool.0.take(model, &given, &mut state);
        let mut equations = self.equations_of(tool);
        // Where the stiffness has no numbers, the mass may; the first step then says what is wrong.
        equations
            .balance_accelerations(&mut state, &conditions, h)
            .or_else(|_| equations.balance_accelerations(&mut state, &conditions, 0.0))
            .map_err(StartError::Singular)?;
        Ok(state)
    }

    /// A `state` of the chain of `tool` in the numbering of the model, with what its joints carry.
    fn in_full(&mut self, tool: &mut (Chain, Effects), state: &mut State, conditions: &Conditions) -> State {
        let mut full = State::at_rest(self.model());
        let mut carried = Carried::new(self.model(), tool.0.spans());
        let mut point = LedgerPoint::new(self.model(), tool.0.unknowns(), tool.0.spans(), tool.1.drags());
        let mut equations = self.equations_of(tool);
        equations.evaluate(state, conditions, false);
        equations.energy(&mut carried, &mut point, state, conditions);
        tool.0.show(self.model(), state, &carried.joints, &mut full);
        full
    }

    /// Brings the tool to rest under gravity and `inputs` by damped steps of growing size. Friction and bit torque of the
    /// regularised laws vanish at rest, so it is left out on the way. The tool does not advance at rest: the rate of
    /// penetration does not enter. The friction of the wall on a guide that has been slid in is at its limit all the way.
    ///
    /// # Errors
    /// When steps fail at the smallest size or the tool keeps moving.
    pub fn settle(&mut self, inputs: &Inputs) -> Result<State, StartError> {
        let inputs = &Inputs {
            rate_of_penetration: 0.0,
            ..*inputs
        };
        let mut tool = self.chain_over_stations();
        let mut state = self.as_given(&mut tool, inputs, 0.0)?;
        // A guide that was slid in lies against friction at its limit along the hole, and keeps that as its history.
        tool.1.settle(&mut state);
        let conditions = settling(self.conditions(0.0, inputs));
        let most_iterations = self.tolerances().max_iterations;
        let mut equations = self.equations_of(&mut tool);
        let mut trial = state.clone();
        let mut h = STEPS[0];
        let mut speed = f64::INFINITY;
        let mut at_largest = 0;
        let mut steps = 0;
        // The first steps are small: the tool falls onto what holds it, and a large step would pass through that.
        while steps < MOST_STEPS {
            steps += 1;
            let stride = Stride {
                // With gamma 1 the scheme damps strongly: only the rest matters, and not the motion that leads to it.
                scheme: Scheme::newmark(1.0),
                h,
                foresight: 0.0,
                // All of those of the start: at rest they are those of the end too, and the tangent knows of no others.
                foreseen_part: 1.0,
                accuracy: Accuracy::Rest,
                most_iterations,
            };
            let factors = stride.scheme.factors(h);
            equations.chain.prepare_only(equations.model, &conditions, factors);
            match newton::step(&mut equations, &stride, &conditions, &state, &mut trial) {
                Ok(iterations) => {
                    std::mem::swap(&mut state, &mut trial);
                    speed = state.v.iter().fold(0.0, |worst: f64, v| worst.max(v.abs()));
                    // Few corrections mean that the next step may be larger.
                    if iterations <= 4 {
                        h = (h * 1.5).min(STEPS[1]);
                    }
                    // At the largest step a speed below the limit is rest; three
                    // of them exclude a turning point of a swing.
                    if speed < REST && h == STEPS[1] {
                        at_largest += 1;
                        if at_largest >= 3 {
                            break;
                        }
                    }
                }
                Err(Rejected { failure, .. }) => {
                    // A failed step is tried again at a quarter; below the
                    // smallest the tool has no rest that these steps find.
                    h *= 0.25;
                    if h < 1e-7 {
                        return Err(StartError::Step(failure));
                    }
                }
            }
        }
        if at_largest < 3 {
            return Err(StartError::Moving {
                steps,
                speed,
                limit: REST,
            });
        }
        equations.effects.leave(&mut state);
        // The remaining velocities are set to zero, and what they leave out of balance is corrected below.
        let mut rest = state;
        rest.v.fill(0.0);
        rest.a.fill(0.0);
        rest.time = 0.0;
        let conditions = self.conditions(0.0, inputs);
        let mut equations = self.equations_of(&mut tool);
        equations.polish_rest(&mut rest, &mut trial, &conditions);
        // The remaining unbalanced force becomes an acceleration, so that the first step begins in balance.
        equations
            .balance_accelerations(&mut rest, &conditions, 0.0)
            .map_err(StartError::Singular)?;
        let rest = self.in_full(&mut tool, &mut rest, &conditions);
        self.start_from(&rest, inputs);
        Ok(rest)
    }
}

/// Conditions while settling: damped, and without what vanishes at rest.
fn settling(mut conditions: Conditions) -> Conditions {
    conditions.comes_to_rest = true;
    conditions.rayleigh.alpha += SETTLING_ALPHA;
    conditions
}
