//! A run second by second: the figures that a forecast has and that what came is compared in.

use std::collections::VecDeque;

use flexdrill_core::twin::Snapshot;

flexdrill_base::listed! {
    /// A figure of a second, in the order of its values.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[repr(usize)]
    pub enum Signal: 2 {
        /// Mean rotary speed of the bit (rad/s).
        BitSpeed: "bit_speed", "rad/s";
        /// Mean torque of the rock against the bit (N m).
        BitTorque: "bit_torque", "N m";
        /// Mean weight on the bit (N).
        WeightOnBit: "weight_on_bit", "N";
        /// Largest normal force of pipe and guide at a station (N).
        PipeGuideForce: "pipe_guide_force", "N";
        /// Largest normal force of guide and wall at a station (N).
        GuideWallForce: "guide_wall_force", "N";
    }
}

/// Number of signals.
pub const SIGNALS: usize = Signal::ALL.len();

impl Signal {
    /// Name and unit, as in messages.
    pub const fn name_and_unit(self) -> (&'static str, &'static str) {
        let [name, unit] = self.row();
        (name, unit)
    }

    /// Its name among the figures of `twin/bands`.
    pub const fn of_tools(self) -> &'static str {
        match self {
            Self::BitSpeed => "bit_state/rotary_speed",
            Self::BitTorque => "bit_state/torque",
            Self::WeightOnBit => "bit_state/weight_on_bit",
            Self::PipeGuideForce => "contact_forces/max_pipe_guide_force",
            Self::GuideWallForce => "contact_forces/max_guide_wall_force",
        }
    }

    /// Whether it is the largest contact force, which is never negative.
    pub const fn is_force(self) -> bool {
        matches!(self, Self::PipeGuideForce | Self::GuideWallForce)
    }

    /// A difference that no driller would see on a gauge: a tenth of a turn per minute, a newton metre, ten newtons; for
    /// peak forces, which are those of single impacts, ten newtons too.
    pub const fn resolution(self) -> f64 {
        match self {
            Self::BitSpeed => 0.01,
            Self::BitTorque => 1.0,
            Self::WeightOnBit | Self::PipeGuideForce | Self::GuideWallForce => 10.0,
        }
    }
}

/// A second of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Second {
    /// Its number: whole seconds of the run's time, skipped steps included.
    pub number: u64,
    sums: [f64; 3],
    looks: u32,
    peaks: [f64; 2],
}

impl Second {
    const fn new(number: u64) -> Self {
        Self {
            number,
            sums: [0.0; 3],
            looks: 0,
            peaks: [0.0; 2],
        }
    }

    /// Its figures, by [`Signal::ALL`]; means are NaN without a look.
    pub fn values(&self) -> [f64; SIGNALS] {
        let [speed, torque, weight] = self.sums.map(|sum| sum / f64::from(self.looks));
        [speed, torque, weight, self.peaks[0], self.peaks[1]]
    }
}

/// The seconds of a run, the newest last.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    seconds: VecDeque<Second>,
}

impl Trace {
    /// Seconds in the order of their numbers. The first and the last may be parts.
    pub fn seconds(&self) -> &VecDeque<Second> {
        &self.seconds
    }

    /// Looks at the run, ten times a second of model time; `time` (s) is the run's.
    pub fn look(&mut self, time: f64, snapshot: &Snapshot) {
        let second = self.second(time);
        let bit = &snapshot.bit;
        for (sum, value) in second
            .sums
            .iter_mut()
            .zip([bit.rotary_speed, bit.torque, bit.weight_on_bit])
        {
            *sum += value;
        }
        second.looks += 1;
    }

    /// Takes the peaks of an interval that ends at `time` (s).
    pub fn peaks(&mut self, time: f64, snapshot: &Snapshot) {
        let second = self.second(time);
        let layers = [&snapshot.contacts.pipe_guide, &snapshot.contacts.guide_wall];
        for (peak, layer) in second.peaks.iter_mut().zip(layers) {
            *peak = layer.normal_peak.iter().copied().fold(*peak, f64::max);
        }
    }

    /// Keeps the newest seconds only.
    pub fn keep(&mut self, most: usize) {
        while self.seconds.len() > most {
            self.seconds.pop_front();
        }
    }

    fn second(&mut self, time: f64) -> &mut Second {
        let number = time.max(0.0) as u64;
        if self.seconds.back().is_none_or(|last| last.number != number) {
            self.seconds.push_back(Second::new(number));
        }
        let last = self.seconds.len() - 1;
        &mut self.seconds[last]
    }
}
