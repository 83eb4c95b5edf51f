//! One run of the twin, until its means are steady.

use std::f64::consts::TAU;

use flexdrill_config::{Config, ConfigError, Law};
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{Body, PressureSource, SectionProperties, ToolDescription, WellPath};
use flexdrill_core::twin::{Simulation, Snapshot};
use flexdrill_core::units::n_to_kn;
use flexdrill_motion::{BIT, KICK_OFF};
use flexdrill_trip::soft_string::buckling_load;

use crate::drilling::loads::weights;

/// Shortest time of a mean (s): two turns at 40 r/min.
const SHORTEST_WINDOW: f64 = 3.0;
/// The watch of transfer divides its window into this many parts, each a whole number of steps.
const PARTS: f64 = 50.0;
/// Consecutive means that must agree.
const WINDOWS: usize = 3;
/// Largest range of these means of the weight at the bit, relative to the weight that is put in.
const STEADY_WEIGHT: f64 = 0.03;
/// Largest range of these means of both torques, relative to the torque at the kick-off: a whirling pipe scatters.
const STEADY_TORQUE: f64 = 0.06;
/// Torque (N m) whose range counts as steady in any case, where a tool without rotation carries next to none.
const SMALL_TORQUE: f64 = 1.0;
/// Model time between two samples of the forces along the tool (s).
const SAMPLE: f64 = 0.02;

/// Response times of the auto-driller before its result counts: e^-8 is 0.03 %.
const RESPONSES: f64 = 8.0;

/// What a window has a mean of.
const FIGURES: [&str; 4] = [
    "weight at the kick-off",
    "weight at the bit",
    "torque at the kick-off",
    "torque at the bit",
];

/// What every run is loaded with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// Rotary speed of the points that rotate (rad/s), above 0.
    pub speed: f64,
    /// Weight that is put in (N): slacked off at the surface above a hoist, otherwise the axial force at the kick-off.
    pub weight: f64,
    /// Rate of penetration (m/s) of a tool without a hoist.
    pub advance: f64,
    /// Longest model time of a run (s).
    pub longest: f64,
}

/// A point to be run.
#[derive(Debug, Clone)]
pub struct Point {
    /// The lengthened configuration with its friction.
    pub config: Config,
    /// Links.
    pub links: usize,
    /// Friction coefficient of both layers, around and along; not a number where they have those of the configuration.
    pub friction: f64,
    /// Whether the tool rotates.
    pub rotates: bool,
}

/// Steady means of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Weight at the kick-off and at the bit (N).
    pub weight: [f64; 2],
    /// Torque at the kick-off and at the bit (N m).
    pub torque: [f64; 2],
    /// Range of the means of the weight at the bit (N) and of the torque at the bit (N m) over the last three windows.
    pub range: [f64; 2],
    /// Measured depth from which the guide's compression exceeds the load at which it buckles sideways (m).
    pub guide_buckles_at: Option<f64>,
    /// Measured depth of the first joint that torque folds: T > N_eff L / 2 (m).
    pub chain_folds_at: Option<f64>,
    /// Rate of penetration (m/s).
    pub advance: f64,
    /// Model time that it took (s).
    pub time: f64,
}

impl Point {
    /// A configuration of `links` links with a friction coefficient.
    ///
    /// # Errors
    /// When the configuration does not allow it.
    pub fn new(config: &Config, links: usize, friction: f64, rotates: bool, load: &Load) -> Result<Self, ConfigError> {
        let layers = ["inner", "outer"].into_iter();
        let keys = layers
            .flat_map(|layer| ["tangential", "axial"].map(|direction| format!("contact.{layer}.friction_{direction}")));
        let values = keys.map(|key| (key, friction)).collect();
        let point = Self::with(config, links, values, rotates, load)?;
        Ok(Self { friction, ..point })
    }

    /// A configuration of `links` links with its own friction.
    ///
    /// # Errors
    /// When the configuration does not allow it.
    pub fn as_it_is(config: &Config, links: usize, rotates: bool, load: &Load) -> Result<Self, ConfigError> {
        Self::with(config, links, Vec::new(), rotates, load)
    }

    fn with(
        config: &Config,
        links: usize,
        mut values: Vec<(String, f64)>,
        rotates: bool,
        load: &Load,
    ) -> Result<Self, ConfigError> {
        let window = load.window(config.solver.time_step, rotates);
        let mut config = config.with_links(links)?;
        // A bit that does not turn cuts nothing, and would stop the advance.
        if !rotates && config.rock.law == Law::DepthOfCut {
            config = config.with_value("rock.law", "paper")?;
        }
        if config.rock.law != Law::DepthOfCut {
            config = config.with_value("boundary.weight_on_bit_at", "kickoff")?;
        }
        values.push(("inputs.weight_on_bit.initial_kn".to_owned(), n_to_kn(load.weight)));
        values.push(("transfer.window".to_owned(), window));
        Ok(Self {
            config: config.with_values("reach", values)?,
            links,
            friction: f64::NAN,
            rotates,
        })
    }

    /// Runs it until its means are steady. `report` gets the share of the longest model time that is done, 0 to 1.
    ///
    /// # Errors
    /// Why there is no figure, in words.
    pub fn run(&self, load: &Load, report: &mut impl FnMut(f64)) -> Result<Found, String> {
        let tool = self.config.tool();
        let mut simulation = Simulation::new(&tool, &self.config.simulation()).map_err(|error| error.to_string())?;
        // Whole steps and whole turns in each window: a mean over a part of a turn would differ from window to window.
        let step = simulation.settings().time_step;
        let steps = (load.window(step, self.rotates) / step).round() as u64;
        let per_sample = ((SAMPLE / step).round() as u64).max(1);
        let per_second = ((1.0 / step).round() as u64).max(1);
        // Above a hoist the advance follows from the weight; without one it is an input.
        let inputs = Inputs {
            rotary_speed: if self.rotates { load.speed } else { 0.0 },
            weight_on_bit: load.weight,
            rate_of_penetration: if self.has_hoist() { 0.0 } else { load.advance },
            ..Inputs::default()
        };
        // As a run that need not keep a pace: the step that the motion needs.
        simulation.set_refinement(simulation.quality().choice.wanted);
        let mut snapshot = simulation.new_snapshot();
        let mut windows: Vec<[f64; 4]> = Vec::new();
        // The forces are summed for each window from zero, so that the onset of
        // buckling belongs to the steady motion and not to the start.
        loop {
            let mut forces = Forces::new(&simulation, &snapshot);
            for count in 0..steps {
                if let StepOutcome::Failed(failure) = simulation.advance(&inputs) {
                    return Err(format!("the step at {:.1} s failed: {failure}", simulation.time()));
                }
                // The step is chosen once per second, as the node does: a
                // choice within a second would follow single impacts.
                if simulation.step().is_multiple_of(per_second) {
                    simulation.set_refinement(simulation.quality().choice.wanted);
                    report(simulation.time() / load.longest);
                }
                if count.is_multiple_of(per_sample) {
                    simulation.snapshot(&mut snapshot, false);
                    forces.add(&simulation, &snapshot);
                }
            }
            // With `true` the snapshot ends the interval of the means, so that the windows are disjoint.
            simulation.snapshot(&mut snapshot, true);
            let mean = &snapshot.transfer.mean;
            windows.push([
                mean.weight[KICK_OFF],
                mean.weight[BIT],
                mean.torque[KICK_OFF],
                mean.torque[BIT],
            ]);
            // A mean without a value, at a tool without the sensor's place, would never become steady.
            let last = windows.last().into_iter().flatten();
            if let Some((missing, _)) = FIGURES.iter().zip(last).find(|(_, value)| !value.is_finite()) {
                return Err(format!("the tool has no {missing}"));
            }
            let judged = Judged::of(&windows, load);
            // Before this time an auto-driller has not arrived at its weight, however slowly the means change.
            if judged.is_steady && simulation.time() >= self.settling() {
                let [weight_at_top, weight, torque_at_top, torque] = judged.means;
                let (guide, chain) = forces.onsets(&tool, weight_at_top);
                return Ok(Found {
                    weight: [weight_at_top, weight],
                    torque: [torque_at_top, torque],
                    range: [judged.ranges[1], judged.ranges[3]],
                    guide_buckles_at: guide,
                    chain_folds_at: chain,
                    advance: forces.advance / forces.samples,
                    time: simulation.time(),
                });
            }
            // The next window would end beyond the longest time: the result could only be another "not steady".
            if simulation.time() + steps as f64 * step > load.longest {
                return Err(judged.unsteady(simulation.time()));
            }
        }
    }

    /// Time (s) before which an auto-driller has not arrived at its weight, however slowly the means change.
    fn settling(&self) -> f64 {
        if self.has_hoist() {
            RESPONSES * self.config.string.hoist.response_time
        } else {
            0.0
        }
    }

    fn has_hoist(&self) -> bool {
        self.config.rock.law == Law::DepthOfCut
    }
}

impl Load {
    /// Time of a mean (s): whole turns, but for half a step in each of the parts of the watch.
    fn window(&self, step: f64, rotates: bool) -> f64 {
        let turn = TAU / self.speed;
        let whole = if rotates {
            (SHORTEST_WINDOW / turn - 1e-9).ceil().max(1.0) * turn
        } else {
            SHORTEST_WINDOW
        };
        PARTS * step * (whole / PARTS / step).round().max(1.0)
    }
}

/// The last means of a run, in the order weight at kick-off and bit, torque at kick-off and bit.
struct Judged {
    means: [f64; 4],
    ranges: [f64; 4],
    limits: [f64; 4],
    /// Number of means so far.
    windows: usize,
    is_steady: bool,
}

impl Judged {
    fn of(windows: &[[f64; 4]], load: &Load) -> Self {
        let last = &windows[windows.len().saturating_sub(WINDOWS)..];
        let of = |k: usize| last.iter().map(move |window| window[k]);
        let means = [0, 1, 2, 3].map(|k| of(k).sum::<f64>() / last.len() as f64);
        let ranges = [0, 1, 2, 3].map(|k| of(k).fold(f64::MIN, f64::max) - of(k).fold(f64::MAX, f64::min));
        let torque = (STEADY_TORQUE * means[2].abs()).max(SMALL_TORQUE);
        let weight = STEADY_WEIGHT * load.weight;
        let limits = [weight, weight, torque, torque];
        // The first window has the start.
        let is_steady = windows.len() > WINDOWS && ranges.iter().zip(limits).all(|(range, limit)| *range <= limit);
        Self {
            means,
            ranges,
            limits,
            windows: windows.len(),
            is_steady,
        }
    }

    fn unsteady(&self, time: f64) -> String {
        let worst =
            (0..4).max_by(|&a, &b| (self.ranges[a] / self.limits[a]).total_cmp(&(self.ranges[b] / self.limits[b])));
        let k = worst.unwrap_or(0);
        let unit = if k < 2 { "N" } else { "N m" };
        let (figure, range, limit) = (FIGURES[k], self.ranges[k], self.limits[k]);
        if range <= limit {
            return format!(
                "not judged after {time:.1} s: {} of the {} means that a judgement needs were taken (the largest \
                 variation so far is within its limit); --seconds gives it longer",
                self.windows,
                WINDOWS + 1
            );
        }
        format!(
            "not steady after {time:.1} s: the mean {figure} varies by {range:.1} {unit}, more than the {limit:.1} {unit} \
             of a steady one"
        )
    }
}

/// Means of forces along the tool over a window.
struct Forces {
    samples: f64,
    depth: Vec<f64>,
    /// Friction down the hole on the guide per station (N).
    guide: Vec<f64>,
    joint_depth: Vec<f64>,
    /// Tension (N) and torque (N m) per joint.
    joints: Vec<[f64; 2]>,
    /// Pressure at the top (Pa).
    pressure: f64,
    /// Rate of penetration (m/s), summed as all others.
    advance: f64,
}

impl Forces {
    fn new(simulation: &Simulation, snapshot: &Snapshot) -> Self {
        let depth: Vec<f64> = simulation.stations().map(|at| at.measured_depth).collect();
        Self {
            samples: 0.0,
            guide: vec![0.0; depth.len()],
            depth,
            joint_depth: snapshot.joints.measured_depth.clone(),
            joints: vec![[0.0; 2]; snapshot.joints.measured_depth.len()],
            pressure: 0.0,
            advance: 0.0,
        }
    }

    fn add(&mut self, simulation: &Simulation, snapshot: &Snapshot) {
        self.samples += 1.0;
        for (station, sum) in self.guide.iter_mut().enumerate() {
            let axial = |body| simulation.axial_friction(station, body).unwrap_or(f64::NAN);
            *sum += axial(Body::Guide) - axial(Body::Pipe);
        }
        let joints = snapshot.joints.axial_force.iter().zip(&snapshot.joints.torque);
        for (sum, (tension, torque)) in self.joints.iter_mut().zip(joints) {
            *sum = [sum[0] + tension, sum[1] + torque.abs()];
        }
        let given = snapshot.applied.rate_of_penetration;
        self.advance += simulation.advance_rate().unwrap_or(given);
        self.pressure = snapshot.applied.standpipe_pressure;
    }

    /// Where the guide buckles sideways and where the chain folds (m), from the compression of the guide at its top (N).
    fn onsets(&self, tool: &ToolDescription, at_top: f64) -> (Option<f64>, Option<f64>) {
        let path = WellPath::new(&tool.well);
        let [guide_weight, pipe_weight] = weights(tool);
        let bending = SectionProperties::of(tool.guide_section, tool.material, tool.guide_bending_factor).bending;
        let clearance = 0.5 * (tool.hole_diameter - tool.guide_section.outer_diameter);
        let (mut compression, mut before) = (at_top, 0.0);
        let mut guide = None;
        for (&depth, friction) in self.depth.iter().zip(&self.guide) {
            compression += guide_weight * libm::cos(path.inclination(0.5 * (depth + before))) * (depth - before);
            compression += friction / self.samples;
            before = depth;
            let across = (guide_weight + pipe_weight) * libm::sin(path.inclination(depth));
            if compression > buckling_load(bending, clearance, across, path.curvature(depth)) {
                guide = Some(depth);
                break;
            }
        }
        let link = path.length() / tool.links as f64;
        let pins = |depth: f64| {
            tool.pressure.as_ref().map_or(0.0, |pressure| {
                let at_top = match pressure.at_top {
                    PressureSource::Constant(constant) => constant,
                    PressureSource::Standpipe => self.pressure,
                };
                let area = 0.25 * std::f64::consts::PI * pressure.joint_seal_diameter.powi(2);
                at_top * (1.0 - pressure.drop_per_metre * depth) * area
            })
        };
        let folds = self
            .joints
            .iter()
            .zip(&self.joint_depth)
            .find_map(|([tension, torque], &depth)| {
                let effective = tension / self.samples - pins(depth);
                (torque / self.samples > 0.5 * effective * link).then_some(depth)
            });
        (guide, folds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_cover_whole_turns_and_must_agree() {
        let load = Load {
            speed: 40.0 * TAU / 60.0,
            weight: 10e3,
            advance: 1e-3,
            longest: 60.0,
        };
        assert!((load.window(5e-4, true) - 3.0).abs() < 1e-12);
        assert!((load.window(5e-4, false) - 3.0).abs() < 1e-12);
        let faster = Load {
            speed: 50.0 * TAU / 60.0,
            ..load
        };
        // Three turns of 1.2 s.
        assert!((faster.window(5e-4, true) - 3.6).abs() < 1e-12);
        let steady = [10e3, 8e3, 90.0, 80.0];
        let mut windows = vec![[0.0; 4], steady, steady];
        assert!(!Judged::of(&windows, &load).is_steady);
        windows.push([10e3, 8.2e3, 90.0, 80.0]);
        assert!(Judged::of(&windows, &load).is_steady);
        windows.push([10e3, 8.4e3, 90.0, 80.0]);
        let judged = Judged::of(&windows, &load);
        assert!(!judged.is_steady);
        let text = judged.unsteady(15.0);
        assert!(
            text.contains("weight at the bit varies by 400.0 N, more than the 300.0 N of a steady one"),
            "{text}"
        );
        // What varies within its limits is not the reason.
        let early = Judged::of(&windows[1..3], &load);
        assert!(!early.is_steady);
        let text = early.unsteady(6.0);
        assert!(text.starts_with("not judged after 6.0 s: 2 of the "), "{text}");
    }
}
