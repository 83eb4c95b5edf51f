//! The hoist: travelling block and lines as a spring, and the auto-driller that lowers the block.
//!
//! The auto-driller holds the weight that is slacked off at the surface, W = (weight of the hanging string) - (hook load),
//! at the weight asked for. The string is a spring k between block and rock, so that W' = k (V_set - V_rock). With
//!
//! ```text
//! V_set = 2 e / (k t) + int e / (k t^2) dt,       e = W_asked - W
//! ```
//!
//! the error decays critically damped with the response time t, whatever the rate at which the rock yields. A bit that has not
//! yet its weight is lowered slowly, so that it does not dig into the bottom of the hole:
//!
//! ```text
//! V_set <= V_touch + (V_most - V_touch) W / W_asked
//! ```
//!
//! Without a weight asked for, the block lifts the bit off bottom: a bit that only just touches the rock would chatter. It
//! rises by the height that takes the weight W_0 off the spring, by half of that again for the tool, which is compressed
//! too, and by the distance c:
//!
//! ```text
//! R = c + 1.5 W_0 / k,       V_set = -2 (R - raised) / t - 2 (F - F_smooth) / (k t)
//! ```
//!
//! The second term lets the block take up waves: F is the force in the string, F_smooth its mean over the response time.
//!
//! Friction carries a part of a tool that does not turn. Once it turns off bottom, the hook carries all of it: a driller
//! then sets the weight on bit to zero, and so does the auto-driller, within a few response times.

use serde::{Deserialize, Serialize};

use crate::tool::description::{Feed, Hoist};

/// How the hoist moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct HoistState {
    /// Speed of the block, down (m/s).
    pub block: f64,
    /// Integral part of that speed (m/s).
    pub learned: f64,
    /// Rate of advance of the frame that the tool's displacements are measured in (m/s): that of the tool's top, smoothed.
    pub advance: f64,
    /// Distance by which the frame has advanced (m).
    pub depth: f64,
    /// Height that the block still has to rise (m).
    pub to_rise: f64,
    /// Compression of the spring between block and string (m); negative while the string hangs.
    pub compression: f64,
    /// Wave from below (m/s).
    pub arriving: f64,
    /// Force (N, compressing) in the string while the tool hangs: negative, its weight.
    pub tare: f64,
    /// Force in the string, smoothed over the response time (N, compressing).
    pub smooth: f64,
    /// Weight that is slacked off at the surface (N): the force in the string less that of hanging.
    pub weight: f64,
}

/// Time (s) over which the frame follows the tool's top. A change of the top's speed by V moves the top by V t / e off the
/// frame, and accelerates the frame, which the tool's equations of motion leave out, by 2 V / t: 3 mm and 0.004 m/s2 when a
/// bit begins to drill 15 m/h, less than a thousandth of gravity.
const FRAME_LAG: f64 = 2.0;

/// Height that the block rises over the compression of string and block. In the quarter circle of the paper the tool itself
/// is compressed by a fifth of what 1000 m of string are.
const LIFTED_PER_COMPRESSION: f64 = 1.5;

impl Hoist {
    /// Stiffness of string and block in series (N/m), for a string of stiffness `string`.
    fn combined(&self, string: f64) -> f64 {
        string * self.stiffness / (string + self.stiffness)
    }

    /// Speeds of the block and of what it has learned (m/s) for the step that begins at `from`, with a string of stiffness
    /// `string` (N/m): towards the weight `asked` for (N), or at the `rate` asked for (m/s).
    fn speeds(&self, from: &HoistState, h: f64, string: f64, [asked, rate]: [f64; 2]) -> [f64; 2] {
        if self.feed == Feed::Rate {
            return [rate.clamp(-self.fastest, self.fastest), 0.0];
        }
        let per_second = 1.0 / (self.combined(string) * self.response_time);
        if asked <= 0.0 {
            let wave = from.weight + from.tare - from.smooth;
            let rising = 2.0 * from.to_rise / self.response_time + 2.0 * wave * per_second;
            return [(-rising).clamp(-self.fastest, self.fastest), 0.0];
        }
        let error = asked - from.weight;
        let learned = from.learned + h * error * per_second / self.response_time;
        let wanted = 2.0 * error * per_second + learned;
        let carried = (from.weight / asked).clamp(0.0, 1.0);
        let most = self.touch_down + (self.fastest - self.touch_down) * carried;
        let block = wanted.clamp(-self.fastest, most);
        // At its limit the block learns nothing, or the weight would overshoot.
        let learned = if block == wanted { learned } else { from.learned };
        [block, learned]
    }

    /// Moves block and frame on by `h` (s), for a weight (N) and a rate of penetration (m/s) `asked` for. The frame follows
    /// the tool's `top`, whose displacement (m) and speed (m/s) in the frame are those at the start of the step: critically
    /// damped, and without a distance left at a constant speed. A frame that followed the block would leave the tool up the
    /// hole of its stations by the string's compression, and its thrust along another direction than the hole's.
    pub fn step(&self, from: &HoistState, h: f64, string: f64, asked: [f64; 2], top: [f64; 2]) -> HoistState {
        let [block, learned] = self.speeds(from, h, string, asked);
        let [displacement, speed] = top;
        let advance = from.advance + h * (2.0 * speed + displacement / FRAME_LAG) / FRAME_LAG;
        let force = from.weight + from.tare;
        let part = h / (self.response_time + h);
        let mut to = HoistState {
            block,
            learned,
            advance,
            depth: from.depth + 0.5 * h * (from.advance + advance),
            smooth: from.smooth + part * (force - from.smooth),
            ..*from
        };
        if self.feed == Feed::Weight && asked[0] > 0.0 {
            let weight = force.max(from.smooth) - from.tare;
            to.to_rise = self.clearance + LIFTED_PER_COMPRESSION * weight.max(0.0) / self.combined(string);
        } else if self.feed == Feed::Weight {
            to.to_rise = from.to_rise + h * block;
            if from.to_rise < 0.5 * self.clearance {
                to.tare += part * (force - from.tare);
            }
        }
        to
    }

    /// Lets the spring push the string, of `impedance` (N s/m), against the `arriving` wave (m/s), over the step from
    /// `from` to `to`, which is made complete. Gives the wave (m/s) that leaves downwards.
    pub fn push(&self, from: &HoistState, to: &mut HoistState, h: f64, arriving: f64, impedance: f64) -> f64 {
        // The force k c = z (f - g) and c' = block - (f + g) with f = g + k c / z, by the trapezoid rule.
        let rate = self.stiffness / impedance;
        let lowered = 0.5 * (from.block + to.block);
        let before = rate * from.compression + 2.0 * from.arriving;
        let pushed = from.compression + h * (lowered - 0.5 * before - arriving);
        to.compression = pushed / (1.0 + 0.5 * h * rate);
        to.arriving = arriving;
        to.weight = self.stiffness * to.compression - to.tare;
        arriving + rate * to.compression
    }

    /// At rest with the force `hanging` (N, compressing) in the string: that is what the weight counts from.
    pub fn at_rest(&self, hanging: f64, impedance: f64) -> HoistState {
        HoistState {
            compression: hanging / self.stiffness,
            arriving: -0.5 * hanging / impedance,
            tare: hanging,
            to_rise: self.clearance,
            smooth: hanging,
            ..HoistState::default()
        }
    }

    /// Energy of the spring (J).
    pub fn energy(&self, state: &HoistState) -> f64 {
        0.5 * self.stiffness * state.compression * state.compression
    }

    /// Work of the block on the spring over a step (J).
    pub fn work(&self, from: &HoistState, to: &HoistState, h: f64) -> f64 {
        let lowered = 0.5 * (from.block + to.block);
        h * lowered * 0.5 * self.stiffness * (from.compression + to.compression)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOIST: Hoist = Hoist {
        stiffness: 5e6,
        response_time: 3.0,
        fastest: 8e-3,
        touch_down: 5e-3,
        clearance: 10e-3,
        feed: Feed::Weight,
    };
    const BY_RATE: Hoist = Hoist {
        feed: Feed::Rate,
        ..HOIST
    };
    const IMPEDANCE: f64 = 74.15e3;
    /// A tool's top that does not move in its frame.
    const AT_REST: [f64; 2] = [0.0; 2];

    /// A string of one spring below the hoist, whose end the rock lets advance at `yielding` (m/s).
    fn weight_after(seconds: f64, asked: f64, yielding: f64) -> f64 {
        let (h, string) = (1e-3, 380e3);
        let mut state = HOIST.at_rest(0.0, IMPEDANCE);
        let combined = string * HOIST.stiffness / (string + HOIST.stiffness);
        for _ in 0..(seconds / h) as usize {
            let mut next = HOIST.step(&state, h, string, [asked, 0.0], AT_REST);
            next.weight += h * combined * (state.block - yielding);
            state = next;
        }
        state.weight
    }

    #[test]
    fn the_weight_asked_for_is_reached_whatever_the_rock_yields() {
        for yielding in [0.0, 1e-3, 4e-3] {
            // Twelve response times: 12 e^-12 of the first error are left.
            let got = weight_after(36.0, 10e3, yielding);
            assert!((got - 10e3).abs() < 10.0, "{got} N at {yielding} m/s");
        }
    }

    #[test]
    fn the_block_keeps_its_fastest_speed() {
        let state = HOIST.at_rest(0.0, IMPEDANCE);
        assert_eq!(
            HOIST.step(&state, 1e-3, 380e3, [1e6, 0.0], AT_REST).block,
            HOIST.touch_down
        );
        let pressed = HoistState {
            weight: 1e6,
            to_rise: 4.0,
            smooth: 1e6,
            ..state
        };
        assert_eq!(
            HOIST.step(&pressed, 1e-3, 380e3, [1e7, 0.0], AT_REST).block,
            5e-3 + 0.1 * 3e-3
        );
        assert_eq!(
            HOIST.step(&pressed, 1e-3, 380e3, [0.0, 0.0], AT_REST).block,
            -HOIST.fastest
        );
        assert_eq!(
            BY_RATE.step(&state, 1e-3, 380e3, [0.0, -1.0], AT_REST).block,
            -HOIST.fastest
        );
    }

    /// Lifted from 10 kN: the string's 28 mm of compression and the clearance; lowered again until it touches.
    #[test]
    fn without_a_weight_the_bit_is_lifted_off_and_lowered_slowly() {
        let (h, string) = (1e-3, 380e3);
        let combined = string * HOIST.stiffness / (string + HOIST.stiffness);
        let mut state = HOIST.at_rest(0.0, IMPEDANCE);
        (state.weight, state.smooth) = (10e3, 10e3);
        state = HOIST.step(&state, h, string, [10e3, 0.0], AT_REST);
        // Distance by which the block has to be lowered until the bit touches (m).
        let mut gap = -state.weight / combined;
        let mut step = |state: &mut HoistState, asked: f64| {
            let mut next = HOIST.step(state, h, string, [asked, 0.0], AT_REST);
            gap -= h * next.block;
            next.weight = (-combined * gap).max(0.0);
            *state = next;
            gap
        };
        let mut reached = 0.0;
        for _ in 0..40_000 {
            reached = step(&mut state, 0.0);
        }
        // 20 times half the response time: nothing measurable is left to lift.
        let expected = HOIST.clearance + (LIFTED_PER_COMPRESSION - 1.0) * 10e3 / combined;
        assert!((reached - expected).abs() < 1e-6, "{reached} m");
        let mut time = 0.0;
        while step(&mut state, 10e3) > 0.0 {
            time += h;
        }
        assert!((time - expected / HOIST.touch_down).abs() < 2.0 * h, "{time} s");
    }

    /// A top that begins to advance at V = 4 mm/s leaves its frame by x = V t exp(-s / t) with the lag t, most at s = t, and is
    /// back in it afterwards. Tolerance: Euler's rule at h / t = 5e-4.
    #[test]
    fn analytic_frame_that_follows_the_tools_top() {
        let (h, speed) = (1e-3, 4e-3);
        let (mut state, mut top, mut most) = (HOIST.at_rest(0.0, IMPEDANCE), 0.0, 0.0_f64);
        for _ in 0..(12.0 * FRAME_LAG / h) as usize {
            let in_frame = speed - state.advance;
            let next = HOIST.step(&state, h, 380e3, [0.0; 2], [top, in_frame]);
            top += h * (speed - 0.5 * (state.advance + next.advance));
            most = most.max(top);
            state = next;
        }
        let expected = speed * FRAME_LAG / std::f64::consts::E;
        crate::support::figure("most that the top leaves its frame by (m)", expected, most, 1e-3);
        // 12 e^-12 of V t.
        assert!(
            top.abs() < 1e-6 && (state.advance / speed - 1.0).abs() < 1e-3,
            "{top} m, {state:?}"
        );
    }

    /// A held block on its line sends a constant axial wave g back as -g, once its stiffness has taken up 2 z g. Tolerance:
    /// rounding; two seconds are 135 time constants z / k.
    #[test]
    fn analytic_reflection_at_a_held_block() {
        use crate::support::figure;
        let mut state = HOIST.at_rest(0.0, IMPEDANCE);
        let mut sent = 0.0;
        for _ in 0..2000 {
            let mut next = BY_RATE.step(&state, 1e-3, 380e3, [0.0, 0.0], AT_REST);
            sent = HOIST.push(&state, &mut next, 1e-3, 0.02, IMPEDANCE);
            state = next;
        }
        figure("sent back of 0.02 m/s (m/s)", -0.02, sent, 1e-10);
        figure("force of the block (N)", -2.0 * IMPEDANCE * 0.02, state.weight, 1e-9);
    }
}
