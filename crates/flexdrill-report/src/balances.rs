//! Balances of the whole tool from the recorded figures: forces, power, torque, hook load and rock.
//!
//! A balance holds whatever the model computes inside: what does not balance is wrong somewhere. Forces and power must
//! balance at any time. Torque, hook load and rock do so as means while the inputs stay, so that only such messages are
//! judged. `docs/mechanics.md`, "Balances of the whole tool", gives the limits with their reasons;
//! `tests/python/balances.py` holds these and the moments, which need the place of every contact.

use std::collections::VecDeque;
use std::f64::consts::{SQRT_2, TAU};

use flexdrill_config::Config;
use flexdrill_core::tool::{DepthOfCut, RockLaw};
use flexdrill_messages::{AppliedInputs, BitState, Reactions, Transfer};

/// Part by which an input may waver and counts as constant: a rig's weight wavers by 2 %.
const STAYS: f64 = 0.05;
/// Time that a tool takes to follow an input (s), and the same in response times of the hoist.
const FOLLOWS: (f64, f64) = (2.0, 8.0);
/// Stick-slip index up to which a bit turns evenly: its speed stays within half of its mean.
const EVEN: f64 = 0.5;
/// Samples that are kept to compare with a mean: more than a minute at 50 Hz.
const KEPT: usize = 4096;

/// One balance over a recording.
#[derive(Debug)]
pub(crate) struct Balance {
    pub name: &'static str,
    pub unit: &'static str,
    /// Why its limit is not zero.
    pub reason: &'static str,
    /// Number of messages that were judged, and of those beyond the limit.
    pub judged: u64,
    pub beyond: u64,
    /// The message that comes nearest to its limit, or is furthest beyond.
    pub worst: Option<Rest>,
}

/// The remainder of a balance at one time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rest {
    /// s from the beginning.
    pub time: f64,
    pub rest: f64,
    /// Size of what balances, and how much may be left.
    pub size: f64,
    pub limit: f64,
}

impl Rest {
    fn share(&self) -> f64 {
        self.rest.abs() / self.limit
    }

    /// Whether more is left than may be.
    pub(crate) fn is_beyond(&self) -> bool {
        self.share() > 1.0
    }
}

impl Balance {
    fn new(name: &'static str, unit: &'static str, reason: &'static str) -> Self {
        Self {
            name,
            unit,
            reason,
            judged: 0,
            beyond: 0,
            worst: None,
        }
    }

    /// Judges a message; a figure that the tool does not have is not a number, and no balance.
    fn judge(&mut self, time: f64, rest: f64, size: f64, limit: f64) {
        let found = Rest {
            time,
            rest,
            size,
            limit,
        };
        if !found.share().is_finite() {
            return;
        }
        self.judged += 1;
        self.beyond += u64::from(found.is_beyond());
        if self.worst.is_none_or(|worst| found.share() > worst.share()) {
            self.worst = Some(found);
        }
    }
}

/// A string below a hoist.
#[derive(Debug, Clone, Copy)]
struct Hoisted {
    /// Weight along the hole (N), and the mass that has it (kg).
    weight: f64,
    mass: f64,
    /// Time that an axial wave takes along it (s).
    travel: f64,
    /// Response time of the hoist (s).
    response: f64,
}

/// What the balances have to know of the tool.
#[derive(Debug)]
struct Tool {
    /// Nodes of both pipes.
    nodes: f64,
    hoist: Option<Hoisted>,
    /// The rock that holds the bit, and the bit's radius (m).
    rock: Option<(DepthOfCut, f64)>,
}

impl Tool {
    fn of(config: &Config) -> Self {
        let tool = config.tool();
        let string = tool.string.as_ref();
        let hoist = string.and_then(|string| Some((string, string.hoist?)));
        Self {
            nodes: 2.0 * (tool.links * tool.elements_per_link + 1) as f64,
            hoist: hoist.map(|(string, hoist)| Hoisted {
                weight: string.weight,
                mass: string.weight / tool.gravity,
                travel: string.pieces.iter().map(|piece| piece.axial.delay).sum(),
                response: hoist.response_time,
            }),
            rock: match tool.rock {
                RockLaw::DepthOfCut(rock) => Some((rock, 0.5 * tool.bit.diameter)),
                _ => None,
            },
        }
    }
}

/// Samples of the last means' time, each with its time (s).
#[derive(Debug)]
struct Recent<const N: usize>(VecDeque<(f64, [f64; N])>);

impl<const N: usize> Recent<N> {
    fn push(&mut self, time: f64, values: [f64; N]) {
        if self.0.len() == KEPT {
            self.0.pop_front();
        }
        self.0.push_back((time, values));
    }

    /// Mean and standard deviation of value `of` after `from` (s); `None` with fewer than two samples.
    fn since(&self, from: f64, of: usize) -> Option<[f64; 2]> {
        let values = || {
            self.0
                .iter()
                .filter(|(time, _)| *time > from)
                .map(|(_, values)| values[of])
        };
        let count = values().count() as f64;
        let mean = values().sum::<f64>() / count;
        let spread = values().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        (count >= 2.0).then(|| [mean, spread.sqrt()])
    }
}

#[derive(Debug)]
pub(crate) struct Balances {
    forces: Balance,
    power: Balance,
    audit: Balance,
    torque: Balance,
    hook: Balance,
    rock: Balance,
    tool: Option<Tool>,
    /// Inputs that stay, and from when on the tool has followed them (s).
    inputs: Option<[f64; 4]>,
    followed: f64,
    /// Speed (rad/s), weight (N) and stick-slip index of the bit.
    bit: Recent<3>,
    /// Force of the support of the pipe's top down the hole (N).
    pipe_top: Recent<1>,
}

impl Default for Balances {
    fn default() -> Self {
        Self {
            forces: Balance::new(
                "forces on the tool, with inertia and damping",
                "N",
                "Newton's iteration stops with up to 1 N left at a node; below a hoist the string pulls a thousandth of the \
                 weight up or down",
            ),
            power: Balance::new("power put in, taken and stored", "W", "rounding"),
            audit: Balance::new(
                "error of the energy audit",
                "W",
                "a hundredth of the power, and half of what damping takes",
            ),
            torque: Balance::new(
                "torque from the kick-off to the bit",
                "N m",
                "5 % of the losses, 1 % of the torque, and what the tool stores meanwhile",
            ),
            hook: Balance::new(
                "hook load, string and weight at the kick-off",
                "N",
                "0.01 %, 5 N, the string's mass at 1 mm/s², the momentum of its waves, and six standard errors of the support's \
                 samples",
            ),
            rock: Balance::new(
                "advance and rock that the blades remove",
                "m/h",
                "1 %, one blade's cut, and the swings of depth and speed together",
            ),
            tool: None,
            inputs: None,
            followed: 0.0,
            bit: Recent(VecDeque::new()),
            pipe_top: Recent(VecDeque::new()),
        }
    }
}

impl Balances {
    /// The tool that the recording is of.
    pub(crate) fn tool(&mut self, config: &Config) {
        self.tool = Some(Tool::of(config));
    }

    pub(crate) fn all(&self) -> [&Balance; 6] {
        [
            &self.forces,
            &self.power,
            &self.audit,
            &self.torque,
            &self.hook,
            &self.rock,
        ]
    }

    /// Takes inputs, from which on the tool has to follow.
    pub(crate) fn applied(&mut self, time: f64, m: &AppliedInputs) {
        let now = [
            m.rotary_speed,
            m.weight_on_bit,
            m.rate_of_penetration,
            m.standpipe_pressure,
        ];
        let slews = [
            m.rotary_speed_slew,
            m.weight_on_bit_slew,
            m.rate_of_penetration_slew,
            m.standpipe_pressure_slew,
        ];
        let before = self.inputs.unwrap_or_default();
        let changed = |k: usize| (now[k] - before[k]).abs() > STAYS * now[k].abs().max(before[k].abs());
        if self.inputs.is_some() && !m.reset && !(0..4).any(changed) {
            return;
        }
        let slewed = (0..4).map(|k| (now[k] - before[k]).abs() / slews[k]);
        let slewed = slewed.filter(|time| time.is_finite()).fold(0.0, f64::max);
        let hoist = self
            .tool
            .as_ref()
            .and_then(|tool| tool.hoist)
            .map_or(0.0, |hoist| hoist.response);
        self.followed = time + slewed + FOLLOWS.0 + FOLLOWS.1 * hoist;
        self.inputs = Some(now);
    }

    pub(crate) fn bit(&mut self, time: f64, m: &BitState) {
        self.bit
            .push(time, [m.rotary_speed, m.weight_on_bit, m.stick_slip_index]);
    }

    /// Forces on the tool at an instant.
    pub(crate) fn reactions(&mut self, time: f64, m: &Reactions) {
        let parts = [
            m.support_force,
            m.weight,
            m.wall_force,
            m.bit_force,
            m.load_force,
            m.inertia_force,
            m.damping_force,
        ];
        let sum = std::array::from_fn(|k| parts.iter().map(|part| part[k]).sum());
        if let Some(tool) = &self.tool {
            let hoist = tool.hoist.map_or(0.0, |_| 1e-3 * norm(m.weight));
            let limit = tool.nodes.sqrt() + hoist;
            self.forces
                .judge(time, norm(sum), norm(m.support_force) + norm(m.wall_force), limit);
        }
        let at_top =
            (0..m.body.len()).filter(|&i| m.body[i] == Reactions::PIPE && m.measured_depth.get(i) == Some(&0.0));
        let along = at_top.filter_map(|i| {
            let (sine, cosine) = m.inclination.get(i)?.sin_cos();
            Some(m.force_x.get(i)? * sine + m.force_z.get(i)? * cosine)
        });
        self.pipe_top.push(time, [along.sum()]);
    }

    /// Means from the surface to the bit.
    pub(crate) fn transfer(&mut self, time: f64, m: &Transfer) {
        // Before the first window is full the twin sends no means.
        if m.duration.is_nan() || m.duration <= 0.0 {
            return;
        }
        let put_in = [
            m.drive_power,
            m.hoist_power,
            m.weight_on_bit_power,
            m.gravity_power,
            m.load_power,
            m.feed_power,
            m.pressure_power,
            m.axial_update_power,
        ];
        let damped = [
            m.contact_damping_power,
            m.rayleigh_damping_power,
            m.numerical_damping_power,
            m.mud_power,
        ];
        let damping: f64 = damped.iter().sum();
        let taken = m.bit_power + m.friction_power + m.string_power + damping;
        let of_damping: f64 = damped.iter().map(|power| power.abs()).sum();
        // The size of the balance is half of all that flows: what enters leaves again.
        let all = put_in.iter().map(|power| power.abs()).sum::<f64>() + of_damping;
        let size = 0.5 * (all + m.bit_power.abs() + m.friction_power.abs() + m.string_power.abs());
        // Power is balanced by the twin's own terms, so the rest is rounding and its limit is relative.
        let rest = put_in.iter().sum::<f64>() - taken - m.stored_power - m.error_power;
        self.power.judge(time, rest, size, 1e-6 * size + 1e-9);
        // The error of the audit itself belongs to the scheme; damping is
        // integrated along with the steps and bounds it.
        self.audit
            .judge(time, m.error_power, size, 0.01 * size + 0.5 * of_damping + 0.1);
        // Means that reach back before the last change of the inputs mix two states, and are not judged.
        let from = time - m.duration;
        if from < self.followed {
            return;
        }
        let below_a_hoist = self.tool.as_ref().is_some_and(|tool| tool.hoist.is_some());
        let bit = self.bit.since(from, 0).zip(self.bit.since(from, 1));
        if let Some(([_, swing], _)) = bit {
            // The losses as torques are powers over the speed of the tool's top, which says that speed.
            let speed = m.pipe_guide_friction_power / m.pipe_guide_friction_torque;
            let friction = m.pipe_guide_friction_power + m.guide_wall_friction_power + m.joint_friction_power;
            // Torque balances as power does, over the speed: what is put in
            // along the hole does not come from the torque.
            let given = m.gravity_power + m.load_power + m.feed_power + m.pressure_power + m.axial_update_power;
            let weight = if below_a_hoist { 0.0 } else { m.weight_on_bit_power };
            let lost = (friction + damping - given - weight) / speed;
            // The torque swings with the speed, and the mean of a product is not the product of the means: their
            // scatter bounds the difference.
            let rms = (m.kickoff_torque_rms.powi(2) - m.kickoff_torque.powi(2))
                .max(0.0)
                .sqrt();
            let held = ((m.stored_power.abs() + m.error_power.abs()) / speed).abs() + (rms * swing / speed).abs();
            let limit = 0.05 * lost.abs() + 0.01 * m.kickoff_torque.abs() + 0.2 + held;
            let rest = m.kickoff_torque - m.bit_torque - lost;
            self.torque.judge(time, rest, m.kickoff_torque.abs(), limit);
        }
        // Without the configuration neither string nor rock is known.
        let Some(tool) = &self.tool else {
            return;
        };
        if let (Some(string), Some([top, scatter])) = (tool.hoist, self.pipe_top.since(from, 0)) {
            let drag = if m.string_axial_drag.is_nan() {
                0.0
            } else {
                m.string_axial_drag
            };
            let rest = m.hook_load - (string.weight - drag - m.kickoff_weight - top);
            let samples = self.pipe_top.0.iter().filter(|(time, _)| *time > from).count() as f64;
            // Waves carry momentum: force times time of travel, of either sign at both ends of the window.
            let swing = (m.kickoff_weight_rms.powi(2) - m.kickoff_weight.powi(2))
                .max(0.0)
                .sqrt();
            let waves = 2.0 * SQRT_2 * swing * string.travel / m.duration;
            let scatter = 6.0 * scatter / samples.sqrt();
            let limit = 1e-4 * m.hook_load.abs() + 5.0 + 1e-3 * string.mass + waves + scatter;
            self.hook.judge(time, rest, m.hook_load.abs(), limit);
        }
        if let (Some((rock, radius)), Some(([speed, swing], [_, pressed]))) = (tool.rock, bit) {
            // A bit that chatters cuts while it is fast: the advance is not the product of the means.
            let even = self.bit.since(from, 2).is_some_and(|[index, _]| index < EVEN);
            if m.bit_weight < 1.0 || speed <= 0.0 || !even {
                return;
            }
            // In a steady state the advance per turn is the depth of cut.
            let removed = speed / TAU * m.depth_of_cut;
            let depth_swing = pressed / (rock.cutter_inclination * rock.specific_energy * radius);
            // At both ends of the window up to one blade's cut is begun or not finished.
            let cut = m.depth_of_cut.abs() / f64::from(rock.blades) / m.duration;
            let limit = 0.01 * removed + depth_swing * swing / TAU + cut + 1e-6;
            let per_hour = 3600.0;
            let rest = m.rate_of_penetration - removed;
            self.rock
                .judge(time, per_hour * rest, per_hour * removed, per_hour * limit);
        }
    }
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
