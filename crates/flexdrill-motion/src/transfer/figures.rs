//! What transfer is made from, and its figures.

use crate::{Hold, Severity};
use flexdrill_base::energies::Energies;

/// The readings of one step. NaN where the tool has none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransferSample {
    /// Torque at surface, kick-off and bit (N m), positive where it turns what is below it in the sense of a positive
    /// rotary speed: negative in reverse.
    pub torque: [f64; 3],
    /// Weight at surface, kick-off and bit (N), compressing.
    pub weight: [f64; 3],
    /// Speed of the tool's top (rad/s).
    pub speed: f64,
    /// Power of the advance against the axial friction of the wall on the guide (W): part of what friction takes there.
    pub feed_power: f64,
    /// Torque that the friction of the wall takes from the string above (N m), with the sign of the rotation.
    pub string_torque: f64,
    /// Axial friction on the pipe by the guide, on the guide by the wall, and on the string above (N), positive where it
    /// pushes up the hole.
    pub axial_drag: [f64; 3],
    /// Load on the hook (N): string and tool less what stands on the bottom and on the wall.
    pub hook_load: f64,
    /// Depth of cut (m per turn).
    pub depth_of_cut: f64,
    /// Rate at which the hole deepens (m/s, at least 0): 0 off bottom.
    pub rate_of_penetration: f64,
    /// Power that friction takes between pipe and guide, between guide and wall, and in the joints (W).
    pub friction_power: [f64; 3],
    /// Speed that the drive is asked for (rad/s).
    pub asked_speed: f64,
    /// Speed of the bit (rad/s).
    pub bit_speed: f64,
    /// 1 while the torque of the top drive is at its limit, 0 while it is below.
    pub drive_at_limit: f64,
    /// Weight that the hoist is asked for (N).
    pub asked_weight: f64,
    /// Share of a weight at the kick-off that sliding friction of a clean hole lets arrive at the bit, 0 to 1.
    pub arrives: f64,
}

pub(super) const VALUES: usize = 23;

impl TransferSample {
    /// All readings in one order, so that sums and means are formed over them alike; [`TransferSample::of`] reverses it.
    pub(super) fn values(&self) -> [f64; VALUES] {
        let [surface_torque, kickoff_torque, bit_torque] = self.torque;
        let [surface_weight, kickoff_weight, bit_weight] = self.weight;
        let [pipe_drag, guide_drag, string_drag] = self.axial_drag;
        let [inner_power, outer_power, joint_power] = self.friction_power;
        [
            surface_torque,
            kickoff_torque,
            bit_torque,
            surface_weight,
            kickoff_weight,
            bit_weight,
            self.speed,
            self.feed_power,
            self.string_torque,
            pipe_drag,
            guide_drag,
            string_drag,
            inner_power,
            outer_power,
            joint_power,
            self.hook_load,
            self.depth_of_cut,
            self.rate_of_penetration,
            self.asked_speed,
            self.bit_speed,
            self.drive_at_limit,
            self.asked_weight,
            self.arrives,
        ]
    }

    pub(super) fn of(
        [
            surface_torque,
            kickoff_torque,
            bit_torque,
            surface_weight,
            kickoff_weight,
            bit_weight,
            speed,
            feed_power,
            string_torque,
            pipe_drag,
            guide_drag,
            string_drag,
            inner_power,
            outer_power,
            joint_power,
            hook_load,
            depth_of_cut,
            rate_of_penetration,
            asked_speed,
            bit_speed,
            drive_at_limit,
            asked_weight,
            arrives,
        ]: [f64; VALUES],
    ) -> Self {
        Self {
            torque: [surface_torque, kickoff_torque, bit_torque],
            weight: [surface_weight, kickoff_weight, bit_weight],
            speed,
            feed_power,
            string_torque,
            axial_drag: [pipe_drag, guide_drag, string_drag],
            hook_load,
            depth_of_cut,
            rate_of_penetration,
            friction_power: [inner_power, outer_power, joint_power],
            asked_speed,
            bit_speed,
            drive_at_limit,
            asked_weight,
            arrives,
        }
    }
}

impl Default for TransferSample {
    /// Nothing is known.
    fn default() -> Self {
        Self::of([f64::NAN; VALUES])
    }
}

/// Mean and root mean square over the window at surface, kick-off and bit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Along {
    /// Means.
    pub mean: [f64; 3],
    /// Root mean squares: their squares less those of the means are the squares of the fluctuations.
    pub rms: [f64; 3],
}

impl Default for Along {
    fn default() -> Self {
        Self {
            mean: [f64::NAN; 3],
            rms: [f64::NAN; 3],
        }
    }
}

/// Transfer over the window. NaN where the tool has no such figure, and before the first tenth of a second.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Transfer {
    /// Time that the window holds (s): up to the window of the settings.
    pub duration: f64,
    /// Torque (N m), negative in reverse, as in [`TransferSample::torque`].
    pub torque: Along,
    /// Weight (N), compressing.
    pub weight: Along,
    /// Means of all readings.
    pub mean: TransferSample,
    /// Torque of the rotation (N m) that friction takes between pipe and guide, between guide and wall, in the joints and
    /// along the string above. A loss opposes the rotation: it is positive while the tool turns forward and negative in
    /// reverse, so that surface torque less losses is the bit's in both senses. For the tool the mean power over the mean
    /// speed of the tool's top, which counts the whole motion of a whirling pipe. NaN while the tool does not turn: a
    /// power over a speed near zero says nothing of a torque.
    pub friction_torque: [f64; 4],
    /// Mean torque at the bit over that at the surface, without a string over that at the kick-off; NaN where that is
    /// near zero, and while the tool does not turn: a bit that holds a wound string takes more than the drive gives.
    pub torque_efficiency: f64,
    /// Mean powers by the terms of the ledger (W).
    pub power: Energies,
}

/// State of a condition on transfer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TransferLevel {
    /// Level.
    pub severity: Severity,
    /// Lost share (0 to 1) or time of the stall (s): the largest since the level was reached, the newest while the level
    /// is OK.
    pub value: f64,
    /// Threshold of the level, of WATCH while the level is OK, in the same unit.
    pub threshold: f64,
    /// Model time of it (s).
    pub seen: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Whether the condition of the level is met.
    pub hold: Hold,
}

impl Transfer {
    /// Before anything is known.
    pub(super) fn unknown() -> Self {
        Self {
            torque_efficiency: f64::NAN,
            friction_torque: [f64::NAN; 4],
            power: Energies::UNKNOWN,
            ..Self::default()
        }
    }
}
