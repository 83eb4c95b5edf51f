//! Settings of the analysis: plain numbers in SI with their reasons.

use serde::{Deserialize, Serialize};

use flexdrill_base::units::rpm_to_rad_per_s;

/// How whirl is found and judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct WhirlSettings {
    /// Length of the long window in turns of the tool. Four turns contain one turn of a whirl at a quarter of the
    /// tool's speed, the slowest that can be distinguished from a drift.
    pub window_turns: f64,
    /// Shortest long window (s), for fast tools.
    pub min_window: f64,
    /// Longest long window (s), for slow or standing tools. Sets the memory: one record per sample and station.
    pub max_window: f64,
    /// Length of the short window in turns of the strongest whirl line. It follows a change of direction within two
    /// whirl turns: the new direction dominates once it fills more than half of the window. Shorter windows misclassify
    /// more broad-band motions as whirl: at 1.6 turns one in ten, at 2 one in twenty.
    pub short_window_turns: f64,
    /// Longest time between two evaluations of the same station (s); a tool faster than 40 r/min is evaluated 30
    /// times per turn. The stations alternate, so that the cost is spread over the samples.
    pub evaluation_interval: f64,
    /// Evaluations in a row that must agree before the kind changes.
    pub confirmations: u32,
    /// Turns of a new whirl for which they must agree. A broad-band motion resembles one whirl by chance, but not for
    /// long.
    pub confirmation_turns: f64,
    /// Below this rotary speed (rad/s) the tool counts as standing: ratios are 0 and the window is `max_window`. 5
    /// r/min is an eighth of the paper's speed.
    pub min_rotary_speed: f64,
    /// Time for which the drive must have been below `min_rotary_speed` to count as standing (s); a run-up follows.
    /// Half a period of the slowest oscillation that is judged as stick-slip (10 s): a bit sticks no longer than that,
    /// and a connection takes minutes.
    pub standstill_time: f64,
    /// RMS orbit radius over clearance from which a motion counts as an orbit. Below a tenth of the clearance the
    /// motion is that of a pipe at rest on the wall with a fluctuating contact.
    pub min_orbit_ratio: f64,
    /// RMS radius about its own mean over clearance from which a motion counts as whirl although it does not enclose
    /// the gap's centre. Below half the clearance an off-centre body stays on its side of the gap.
    pub large_orbit_ratio: f64,
    /// Minor over major axis below which the motion is a line, not an orbit. A pipe that rocks along the low side by
    /// 50 degrees to each side draws an arc of 0.23.
    pub min_axis_ratio: f64,
    /// Share of direction, (forward - backward) / (forward + backward) line power of the orbit stretched to a circle,
    /// from which the direction is steady. 1 is a pure whirl, 0 has no direction. Broad-band motion over four turns
    /// scatters by about 0.2 around 0.
    pub steady_direction: f64,
    /// Correlation of a motion without direction with itself after one, one and a half or two turns of the tool, from
    /// which it counts as periodic and not as chaotic. Periodic motion with noise 20 dB below it has 0.99, broad-band
    /// motion scatters by 0.2 around 0.
    pub min_repetition: f64,
    /// Part of a threshold by which a value must fall below it to leave the level, 0 to 1.
    pub hysteresis: f64,
    /// Longest gap between samples that is interpolated (s); after a longer one the window restarts.
    pub max_bridged_gap: f64,
    /// Factors on the confidence by the state of the inputs; see [`InputTrust`].
    pub input_trust: InputTrust,
    /// Confidence from which a station may raise the level.
    pub min_confidence: f64,
    /// Relative difference to the rate of rolling without slip, `- spin * d / (D - d)`, within which backward whirl
    /// counts as rolling.
    pub rolling_tolerance: f64,
    /// Backward whirl: bending cycles per turn of the tool from which to watch, warn and call critical. A link that
    /// revolves at `ratio` times the rotary speed bends |1 - ratio| times per turn; in a curved hole without whirl,
    /// once. Rolling is critical at any clearance.
    pub backward_cycles: [f64; 3],
    /// Forward whirl: work of the friction per second and metre (W/m) from which to watch and to warn. It bends the
    /// pipe little and breaks nothing by itself, so it is never critical, but the same side of the pipe wears.
    pub forward_power: [f64; 2],
    /// Turns of the tool for which the whirl must last before a level is reached: WATCH, WARNING and CRITICAL.
    pub lasting_turns: [f64; 3],
    /// Time for which a level is held after its conditions have ended (s). The window of four turns of the tool holds a
    /// level already; two turns at 60 r/min bridge the bounces of a pipe.
    pub hold_off: f64,
}

/// Factors on the confidence, 0 to 1, by the state of an input; fresh inputs have 1. The twin continues with the last
/// good value; the older the value, the less certain it is that the real tool is driven by it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InputTrust {
    /// The input is late by a sample or two, which hardly matters.
    pub slow: f64,
    /// The newest sample was refused; the held one is recent.
    pub rejected: f64,
    /// The value has been held for seconds, or is on its ramp to the safe value: with 0.6, only motion with a
    /// confidence of 0.84 raises a level.
    pub stale: f64,
    /// The configured start values act.
    pub not_received: f64,
}

impl Default for InputTrust {
    fn default() -> Self {
        Self {
            slow: 0.9,
            rejected: 0.8,
            stale: 0.6,
            not_received: 0.6,
        }
    }
}

impl Default for WhirlSettings {
    fn default() -> Self {
        Self {
            window_turns: 4.0,
            min_window: 0.5,
            max_window: 6.0,
            short_window_turns: 2.0,
            evaluation_interval: 0.05,
            confirmations: 2,
            confirmation_turns: 0.3,
            min_rotary_speed: rpm_to_rad_per_s(5.0),
            standstill_time: 5.0,
            min_orbit_ratio: 0.1,
            large_orbit_ratio: 0.5,
            min_axis_ratio: 0.25,
            steady_direction: 0.6,
            min_repetition: 0.8,
            hysteresis: 0.15,
            max_bridged_gap: 0.1,
            input_trust: InputTrust::default(),
            min_confidence: 0.5,
            rolling_tolerance: 0.15,
            // Bending by the hole's curvature alone; one revolution against each turn of the tool; two, with three
            // times the load cycles.
            backward_cycles: [1.0, 2.0, 3.0],
            // With a casing wear factor of 4e-10 per psi of side load and a friction of 0.2 steel loses 2.9e-13 m3 per
            // J of friction: 100 W/m take 1 mm off a side 10 mm wide in four days, 300 W/m in 32 h.
            forward_power: [100.0, 300.0],
            // With the two whirl turns of its detection a critical level stands within three turns of the tool.
            lasting_turns: [1.0, 1.5, 1.5],
            hold_off: 2.0,
        }
    }
}
