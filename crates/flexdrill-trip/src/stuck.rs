//! Which pull and torque at the surface reach a stuck tool, and how much friction they overcome.
//!
//! The tool has been run in, so that friction holds string and guide up everywhere. A pull at the rig turns friction round from
//! the rig down: above the place where its tension meets that of the run-in nothing rests any more, below it nothing has felt
//! the pull. A pull that is larger than that of pulling out reaches the bit: what arrives there acts on what holds it.

use flexdrill_hole::Sense;

use crate::soft_string::{Load, Motion};
use crate::trip::{Assembly, Loads, Refusal, Station};

/// What the rig may do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Largest hook load without the block (N).
    pub pull: f64,
    /// Largest tension of the guide at its top (N): what slots leave of its section. None where it is not known.
    pub guide: Option<f64>,
    /// Largest torque of the top drive (N m).
    pub torque: f64,
}

/// What reaches a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// Measured depth from the kick-off (m); below 0 above it.
    pub depth: f64,
    /// Tension that arrives from above (N), below 0 a push.
    pub tension: f64,
    /// Part of it that is left over once all below slides out freely (N): it acts on what is stuck there. Below 0 the pull does
    /// not even move what is free.
    pub overpull: f64,
    /// Torque that arrives while nothing slides along the hole (N m); not a number below the tool's top but for the bit.
    pub torque: f64,
}

/// What the largest pull and torque do with the bit at a depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Stuck {
    /// Depth of the bit below the kick-off (m).
    pub depth: f64,
    /// Hook load that the limits allow (N).
    pub pull: f64,
    /// Whether the guide limits it, and not the rig.
    pub guide_limits: bool,
    /// Pull on what holds the bit (N), less the friction of the bit; 0 where none arrives.
    pub at_bit: f64,
    /// From the rig to the bit.
    pub reached: Vec<Reached>,
    /// Measured depth (m) below which the pull is not felt, because friction has taken all of it; none where it reaches the bit.
    pub holds_at: Option<f64>,
    /// Measured depth (m) from which on the torque does not turn what is above; none where it reaches the bit.
    pub turns_to: Option<f64>,
    /// Factor on all friction at which the largest pull no longer reaches the bit; none where the pull reaches it up to
    /// `tried_factor`.
    pub critical_factor: Option<f64>,
    /// Largest factor for which that was computed: beyond it the statics of the guide have no solution, or nothing was tried.
    pub tried_factor: f64,
}

impl Stuck {
    /// Torque at the bit (N m); 0 where none arrives.
    pub fn torque_at_bit(&self) -> f64 {
        self.reached.last().map_or(0.0, |bit| bit.torque.max(0.0))
    }
}

/// Share of the pull to which the tension at the bit is found, and evaluations of the statics for it.
const FOUND: f64 = 1e-5;
const EVALUATIONS: usize = 40;
/// Largest factor on friction that is tried: friction of 0.25 becomes 5. Shortest step towards one without a solution.
const MOST_FACTOR: f64 = 20.0;
const SHORTEST_STEP: f64 = 0.1;

/// A number between two of which a rising function is below and above 0: regula falsi with the Illinois rule.
///
/// # Errors
/// What the function says.
fn root<E>(
    [mut low, mut high]: [f64; 2],
    [mut at_low, mut at_high]: [f64; 2],
    within: f64,
    of: impl Fn(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let mut last = 0.0;
    let mut at = f64::midpoint(low, high);
    for _ in 0..EVALUATIONS {
        at = low - at_low * (high - low) / (at_high - at_low);
        let found = of(at)?;
        if found.abs() <= within {
            break;
        }
        // The end that has not moved twice counts half, or it would never move.
        if found < 0.0 {
            (low, at_low) = (at, found);
            at_high *= if last < 0.0 { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (at, found);
            at_low *= if last > 0.0 { 0.5 } else { 1.0 };
        }
        last = found;
    }
    Ok(at)
}

impl Assembly {
    /// What the limits of a rig do with a tool that is stuck with its bit at a depth (m).
    ///
    /// # Errors
    /// [`Refusal::Depth`] or [`Refusal::Hole`].
    pub fn stuck(&self, depth: f64, limits: &Limits) -> Result<Stuck, Refusal> {
        let stuck = self.pull(depth, limits)?;
        let (critical_factor, tried_factor) = self.critical_factor(depth, stuck.pull)?;
        Ok(Stuck {
            critical_factor,
            tried_factor,
            ..stuck
        })
    }

    /// The same without the critical factor.
    ///
    /// # Errors
    /// [`Refusal::Depth`] or [`Refusal::Hole`].
    pub fn pull(&self, depth: f64, limits: &Limits) -> Result<Stuck, Refusal> {
        let [out, run_in] = [Sense::Out, Sense::In].map(|sense| self.loads(depth, 0.0, &Motion::sliding(sense)));
        let (out, run_in) = (out?, run_in?);
        let rigs = limits.pull;
        // What the guide bears at its top, the string carries up to the rig: both tensions differ by that of pulling out, since
        // the string is straight but for its bends, which friction makes larger.
        let of_guide = limits.guide.map(|most| self.rig_pull(depth, most));
        let pull = of_guide.map_or(rigs, |of_guide| of_guide.min(rigs));
        let (at_bit, profile) = self.pulled(depth, pull, &out)?;
        let torques = self.torques(depth, limits.torque, profile.len());
        let reached: Vec<Reached> = profile
            .iter()
            .zip(&out.stations)
            .zip(torques)
            .map(|((at, free), torque)| Reached {
                depth: at.depth,
                tension: at.tension,
                overpull: at.tension - free.tension,
                torque,
            })
            .collect();
        let turns_to = reached.iter().find(|at| at.torque <= 0.0).map(|at| at.depth);
        Ok(Stuck {
            depth,
            pull,
            guide_limits: pull < rigs,
            at_bit,
            holds_at: holds(&profile, &run_in, pull > out.hook_load()),
            reached,
            turns_to,
            critical_factor: None,
            tried_factor: 1.0,
        })
    }

    /// Hook load (N) that holds a tension of the guide at its top (N) while pulling out.
    fn rig_pull(&self, depth: f64, guide: f64) -> f64 {
        let top = Load {
            tension: guide,
            torque: 0.0,
        };
        let raised = self.tool().length() - depth;
        let string = self.line().up(raised, top, &Motion::sliding(Sense::Out));
        string.last().map_or(guide, |(_, rig)| rig.tension)
    }

    /// Pull on what holds the bit under a pull at the rig (N), and the tensions at the stations of pulling out.
    fn pulled(&self, depth: f64, pull: f64, out: &Loads) -> Result<(f64, Vec<Station>), Refusal> {
        let motion = Motion::sliding(Sense::Out);
        let missing = pull - out.hook_load();
        if missing >= 0.0 {
            // Friction only adds from the bit up, so that not more than the difference arrives there.
            let more =
                |tension: f64| -> Result<f64, Refusal> { Ok(self.loads(depth, tension, &motion)?.hook_load() - pull) };
            let at_most = more(missing)?;
            let at_bit = match at_most > FOUND * pull.abs() {
                true => root([0.0, missing], [-missing, at_most], FOUND * pull.abs(), more)?,
                false => missing,
            };
            return Ok((at_bit, self.loads(depth, at_bit, &motion)?.stations));
        }
        let raised = self.tool().length() - depth;
        let string = self.line().down(raised, pull, Sense::Out);
        let mut stations: Vec<Station> = out.stations.clone();
        for (station, (_, tension)) in stations.iter_mut().zip(&string) {
            station.tension = *tension;
        }
        // What lacks at the guide's top lacks below too, less what friction takes of it in the arcs. This leaves out that the
        // missing pull may change the contacts of the guide.
        let mut lacks = string.last().map_or(missing, |(_, top)| top - out.guide_tension());
        for index in out.tool_top + 1..stations.len() {
            lacks *= self.tool().passes(stations[index - 1].depth, stations[index].depth);
            stations[index].tension += lacks;
        }
        Ok((0.0, stations))
    }

    /// Torque (N m) that arrives at each of so many [`Loads::stations`] of a torque at the rig, while the string hangs without
    /// friction along the hole: the largest friction around it.
    fn torques(&self, depth: f64, torque: f64, stations: usize) -> Vec<f64> {
        let raised = self.tool().length() - depth;
        let top = Load {
            tension: self.tool().hanging(depth),
            torque: 0.0,
        };
        let string: Vec<(f64, Load)> = self.line().up(raised, top, &Motion::TURNING);
        let whole = string.last().map_or(0.0, |(_, rig)| rig.torque);
        let mut arrives: Vec<f64> = string
            .iter()
            .rev()
            .map(|(_, at)| torque - (whole - at.torque))
            .collect();
        let at_bit = arrives.last().copied().unwrap_or(torque) - self.tool().torque(depth);
        // Between the tool's top and the bit the pipe's friction is known as a whole.
        arrives.resize(stations - 1, f64::NAN);
        arrives.push(at_bit);
        arrives
    }

    /// Factor on all friction at which pulling out needs a hook load (N), none where no factor that is tried does; and the
    /// largest factor that was tried.
    ///
    /// # Errors
    /// When the statics of the guide have no solution without friction.
    pub fn critical_factor(&self, depth: f64, pull: f64) -> Result<(Option<f64>, f64), Refusal> {
        let needs = |factor: f64| -> Result<f64, Refusal> {
            let motion = Motion::sliding(Sense::Out);
            Ok(self.with_friction(factor).loads(depth, 0.0, &motion)?.hook_load() - pull)
        };
        let mut at_low = needs(0.0)?;
        if at_low >= 0.0 {
            return Ok((Some(0.0), 0.0));
        }
        let (mut low, mut step) = (0.0, 1.0);
        let most = MOST_FACTOR.min(self.tool().most_factor());
        // What hangs does not change, so that the load rises with the factor. A guide under very large friction locks: its
        // statics have no solution, and the steps towards there become shorter.
        while step >= SHORTEST_STEP && low < most {
            let high = f64::min(low + step, most);
            match needs(high) {
                Ok(at_high) if at_high >= 0.0 => {
                    let within = FOUND * pull.abs();
                    return Ok((Some(root([low, high], [at_low, at_high], within, needs)?), high));
                }
                Ok(at_high) => {
                    (low, at_low) = (high, at_high);
                    step *= 2.0;
                }
                Err(_) => step *= 0.25,
            }
        }
        Ok((None, low))
    }
}

/// The place at which a pull meets the tension of the run-in, between two stations by a straight line; none where it `moves` all.
fn holds(pulled: &[Station], run_in: &Loads, moves: bool) -> Option<f64> {
    if moves {
        return None;
    }
    let mut before: Option<(f64, f64)> = None;
    for (at, resting) in pulled.iter().zip(&run_in.stations) {
        let more = at.tension - resting.tension;
        if more <= 0.0 {
            return Some(match before {
                Some((depth, was)) => depth + (at.depth - depth) * was / (was - more),
                None => at.depth,
            });
        }
        before = Some((at.depth, more));
    }
    // A pull that lacks less than the two frictions differ at the bit holds there.
    pulled.last().map(|bit| bit.depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_of_a_convex_function_is_found() {
        let of = |x: f64| Ok::<f64, ()>(x.exp() - 20.0);
        let found = root([0.0, 10.0], [-19.0, 10.0_f64.exp() - 20.0], 1e-6, of).unwrap();
        assert!((found - 20.0_f64.ln()).abs() < 1e-7, "{found}");
    }
}
