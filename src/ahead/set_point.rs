//! What a driller has set, from inputs of a rig that wavers, and the wavering itself.

use std::collections::VecDeque;
use std::sync::Arc;

use super::member::LOOK;
use crate::rig_inputs::Fluctuation;
use flexdrill_config::InputsConfig;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Applied;

/// Time whose median is the set point (s): half of it passes before a change counts, and single samples of a rig that
/// reports once a second do not.
const FILTER: f64 = 10.0;
/// Time (s) after which the median is that of the instants around a change.
pub(super) const LAG: f64 = 0.5 * FILTER;
/// Time whose wavering the members repeat (s).
const REMEMBERED: f64 = 60.0;

/// Speed (rad/s), weight (N), rate of penetration (m/s) and pressure (Pa).
type Values = [f64; 4];

/// Inputs at an instant.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// s of the run.
    time: f64,
    values: Values,
    /// The set point at this instant.
    about: Values,
}

/// The inputs of the last minute, ten times a second: what was set, and how the rig wavered about it.
#[derive(Debug, Clone)]
pub struct SetPoint {
    fluctuation: Fluctuation,
    samples: VecDeque<Sample>,
}

impl SetPoint {
    /// Of a rig with these inputs, before its first sample.
    pub fn new(inputs: &InputsConfig) -> Self {
        Self {
            fluctuation: Fluctuation::of(inputs),
            samples: VecDeque::new(),
        }
    }

    /// Takes what acts at `time` (s of the run). Samples closer than a look are one; a time before the newest begins a
    /// new run.
    pub fn take(&mut self, time: f64, applied: &Applied) {
        let newest = self.samples.back().map_or(f64::NEG_INFINITY, |sample| sample.time);
        if time < newest {
            self.samples.clear();
        } else if time - newest < 0.5 * LOOK {
            return;
        }
        while self.samples.front().is_some_and(|first| time - first.time > REMEMBERED) {
            self.samples.pop_front();
        }
        let values = [
            applied.rotary_speed,
            applied.weight_set,
            applied.rate_of_penetration,
            applied.standpipe_pressure,
        ];
        self.samples.push_back(Sample {
            time,
            values,
            about: values,
        });
        let about = std::array::from_fn(|of| self.median(of, time));
        if let Some(newest) = self.samples.back_mut() {
            newest.about = about;
        }
    }

    /// Median of one input over the last seconds before `time`; of two in the middle the later in order, which is a
    /// value that was there.
    fn median(&self, of: usize, time: f64) -> f64 {
        let within = self
            .samples
            .iter()
            .rev()
            .take_while(|sample| time - sample.time <= FILTER);
        let mut values: Vec<f64> = within.map(|sample| sample.values[of]).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// What is set now; `None` before the first sample.
    pub fn inputs(&self) -> Option<Inputs> {
        let [rotary_speed, weight_on_bit, rate_of_penetration, standpipe_pressure] = self.samples.back()?.about;
        Some(Inputs {
            rotary_speed,
            weight_on_bit,
            rate_of_penetration,
            standpipe_pressure,
        })
    }

    /// Whether what acts now counts as what is set; not before the first sample.
    pub fn is_settled(&self) -> bool {
        let newest = self.samples.back();
        newest.is_some_and(|newest| self.is_about([newest.values[0], newest.values[1]]))
    }

    /// Whether speed (rad/s) and weight (N) count as those that are set.
    fn is_about(&self, values: [f64; 2]) -> bool {
        self.samples
            .back()
            .is_some_and(|newest| self.fluctuation.covers([newest.about[0], newest.about[1]], values))
    }

    /// By how much the inputs differed from what was set, look by look, while that was what is set now; empty where they
    /// did not waver.
    pub(super) fn wavering(&self) -> Arc<[Values]> {
        let steady = self
            .samples
            .iter()
            .filter(|sample| self.is_about([sample.about[0], sample.about[1]]));
        let deviations: Vec<Values> = steady
            .map(|sample| std::array::from_fn(|of| sample.values[of] - sample.about[of]))
            .collect();
        if deviations.iter().flatten().all(|deviation| *deviation == 0.0) {
            return Arc::default();
        }
        deviations.into()
    }
}

/// The wavering of a rig as a member repeats it.
#[derive(Debug, Clone, Default)]
pub(super) struct Wavering {
    deviations: Arc<[Values]>,
    next: usize,
}

impl Wavering {
    /// Begins at the look `offset`, so that members differ.
    pub fn from(deviations: &Arc<[Values]>, offset: u64) -> Self {
        let next = match deviations.len() {
            0 => 0,
            looks => (offset % looks as u64) as usize,
        };
        Self {
            deviations: Arc::clone(deviations),
            next,
        }
    }

    /// What acts in the next look about `set`; `None` where nothing wavers.
    pub fn next(&mut self, set: &Inputs) -> Option<Inputs> {
        let [speed, weight, feed, pressure] = *self.deviations.get(self.next)?;
        self.next = (self.next + 1) % self.deviations.len();
        // Wavering turns no drive round and lifts no bit that a driller has set down: what is off stays off.
        let same_sign = |set: f64, by: f64| if (set + by) * set > 0.0 { set + by } else { set };
        Some(Inputs {
            rotary_speed: same_sign(set.rotary_speed, speed),
            weight_on_bit: same_sign(set.weight_on_bit, weight),
            rate_of_penetration: same_sign(set.rate_of_penetration, feed),
            standpipe_pressure: same_sign(set.standpipe_pressure, pressure),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_config::Config;
    use flexdrill_core::twin::Snapshot;
    use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

    fn set_point() -> SetPoint {
        let config = Config::from_text("rig.yaml", include_str!("../../config/rig.yaml")).unwrap();
        SetPoint::new(&config.inputs)
    }

    fn applied(rpm: f64, kn: f64) -> Applied {
        let mut applied = Snapshot::default().applied;
        (applied.rotary_speed, applied.weight_set) = (rpm_to_rad_per_s(rpm), kn_to_n(kn));
        applied
    }

    /// Weight (kN) that counts as set after each second of a rig whose indicator has a deviation of 2 kN, and once reads
    /// nothing. The change from 10 to 14 kN comes at 30 s.
    fn followed(set_point: &mut SetPoint) -> Vec<f64> {
        let mut random = fastrand::Rng::with_seed(7);
        let mut found = Vec::new();
        for second in 0..80 {
            // The sum of twelve uniform numbers is nearly normal (Irwin and Hall).
            let noise: f64 = (0..12).map(|_| random.f64() - 0.5).sum();
            let weight = if second < 30 { 10.0 } else { 14.0 } + 2.0 * noise;
            let weight = if second == 20 { 0.0 } else { weight };
            for look in 0..10 {
                set_point.take(f64::from(second) + 0.1 * f64::from(look), &applied(40.0, weight));
            }
            found.push(set_point.inputs().unwrap().weight_on_bit / 1e3);
        }
        found
    }

    #[test]
    fn a_wavering_weight_is_followed_by_its_median() {
        let found = followed(&mut set_point());
        // The median of ten values has a deviation of 1.25 / sqrt(10) of theirs: 0.8 kN; three of it.
        for (second, expected) in [(15, 10.0), (20, 10.0), (29, 10.0), (45, 14.0), (79, 14.0)] {
            let difference: f64 = found[second] - expected;
            assert!(difference.abs() < 2.4, "{second} s: {}", found[second]);
        }
        // Before half of the time has passed it is the old one.
        assert!(found[32] < 12.0 && found[38] > 12.0, "{:?}", &found[28..40]);
    }

    #[test]
    fn members_waver_as_the_rig_did_about_what_is_set_now() {
        let mut set_point = set_point();
        followed(&mut set_point);
        let deviations = set_point.wavering();
        // Of the last minute, 30 s at most are at the new weight; the change itself is not among them.
        assert!((200..=510).contains(&deviations.len()), "{}", deviations.len());
        let squares: f64 = deviations.iter().map(|by| by[1] * by[1]).sum();
        let rms = (squares / deviations.len() as f64).sqrt() / 1e3;
        // 2 kN about the true weight; the median itself has 0.8 kN, and takes part of it.
        assert!((1.2..2.8).contains(&rms), "{rms}");
        let set = Inputs {
            rotary_speed: 4.0,
            weight_on_bit: 1e3,
            ..Inputs::ZERO
        };
        let mut wavering = Wavering::from(&deviations, 3);
        let weights: Vec<f64> = (0..deviations.len())
            .map(|_| wavering.next(&set).unwrap().weight_on_bit)
            .collect();
        assert!(weights.iter().all(|weight| *weight > 0.0));
        assert_eq!(
            wavering.next(&set).unwrap().weight_on_bit,
            weights[0],
            "it begins again"
        );
        assert_eq!(
            Wavering::from(&deviations, 4).next(&set).unwrap().weight_on_bit,
            weights[1],
            "members begin at other looks"
        );
        // What is off stays off.
        assert_eq!(wavering.next(&Inputs::ZERO), Some(Inputs::ZERO));
    }

    #[test]
    fn a_rig_that_does_not_waver_leaves_its_members_alone_and_a_new_run_begins_again() {
        let mut set_point = set_point();
        for look in 0..100 {
            set_point.take(0.1 * f64::from(look), &applied(40.0, 10.0));
        }
        assert!(set_point.wavering().is_empty());
        assert_eq!(Wavering::from(&set_point.wavering(), 9).next(&Inputs::ZERO), None);
        assert!(set_point.is_about([rpm_to_rad_per_s(41.0), kn_to_n(10.4)]));
        assert!(!set_point.is_about([rpm_to_rad_per_s(60.0), kn_to_n(10.0)]));
        set_point.take(1.0, &applied(60.0, 10.0));
        assert_eq!(set_point.inputs().unwrap().rotary_speed, rpm_to_rad_per_s(60.0));
    }
}
