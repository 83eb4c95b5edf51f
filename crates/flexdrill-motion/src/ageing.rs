//! Relative ageing of the tool: damage of joints and links by counted load cycles, work of the friction at every
//! station.
//!
//! The damage of a cycle is (range / rated moment)^slope, Palmgren and Miner's sum with a Woehler line of that slope, and
//! less below the knee of a line that has one. It compares stations and drilling parameters. With the position of the line
//! it is a part of a life: [`Detail`](super::Detail).

use serde::{Deserialize, Serialize};

use super::rainflow::Rainflow;
use super::woehler::cycle_weight;

/// Part of the rated moment below which a cycle is not counted: at a slope of 5 a million of them equal one.
const LEAST_RANGE: f64 = 0.05;

/// How ageing is counted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct AgeingSettings {
    /// Slope m of the Woehler line: 3 for welds and sharp notches, 5 for machined steel.
    pub slope: f64,
    /// Moment that a range is compared with (N m), see [`JointLoadSettings`](super::JointLoadSettings).
    pub rated_moment: f64,
    /// Range over the rated moment at the knee of the line, for a stop and for a link; 0 for a line without a knee.
    pub knees: [f64; 2],
    /// Slope below the knee.
    pub slope_below_knee: f64,
}

impl Default for AgeingSettings {
    fn default() -> Self {
        Self {
            slope: 5.0,
            rated_moment: 100.0,
            knees: [0.0; 2],
            slope_below_knee: 5.0,
        }
    }
}

/// Sums since the start.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ageing {
    /// Settings of the counting.
    pub settings: AgeingSettings,
    /// Model time of the sums (s).
    pub duration: f64,
    /// Per joint: damage of its stop.
    pub stop_damage: Vec<f64>,
    /// Per joint: damage of the link below it by bending, at the middle of the link, on its worse side.
    pub bending_damage: Vec<f64>,
    /// Per station: work of the friction between pipe and guide, and between guide and wall (J).
    pub friction_work: [Vec<f64>; 2],
}

impl Ageing {
    /// Per joint: the larger damage of its stop and of the link below it, over that of the joint that ages fastest; 0
    /// while none does.
    pub fn relative_damage(&self) -> impl Iterator<Item = f64> {
        let larger = || {
            self.stop_damage
                .iter()
                .zip(&self.bending_damage)
                .map(|(a, b)| a.max(*b))
        };
        let most = larger().fold(0.0, f64::max);
        larger().map(move |damage| if most > 0.0 { damage / most } else { 0.0 })
    }
}

/// Counts while the tool runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AgeingWatch {
    settings: AgeingSettings,
    duration: f64,
    joints: Vec<JointAgeing>,
    friction_work: [Vec<f64>; 2],
}

/// Load channels of one joint: its stop, and the link below bent about two directions that turn with the pipe.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct JointAgeing {
    /// Integral of the stop's moment since the sample before (N m s).
    angular_impulse: f64,
    channels: [Rainflow; 3],
    damage: [f64; 3],
}

impl AgeingWatch {
    /// A watch of `joints` joints and `stations` stations.
    pub fn new(settings: &AgeingSettings, joints: usize, stations: usize) -> Self {
        let joint = || JointAgeing {
            angular_impulse: 0.0,
            channels: [Rainflow::new(), Rainflow::new(), Rainflow::new()],
            damage: [0.0; 3],
        };
        Self {
            settings: *settings,
            duration: 0.0,
            joints: (0..joints).map(|_| joint()).collect(),
            friction_work: [vec![0.0; stations], vec![0.0; stations]],
        }
    }

    /// Takes the work (J) of the friction in a step; `layer` 0 is the pipe in the guide, 1 the guide in the hole.
    pub fn rub(&mut self, layer: usize, station: usize, work: f64) {
        self.friction_work[layer][station] += work;
    }

    /// Takes the moment (N m) of a joint's stop over a step of `dt` (s).
    pub fn stop(&mut self, joint: usize, dt: f64, moment: f64) {
        self.joints[joint].angular_impulse += moment * dt;
    }

    /// Ends an interval of `elapsed` (s): the stops' mean moments in it and `bending`, the moment (N m) in the middle
    /// of the link below each joint about two axes that turn with it, are the next values of the loads.
    pub fn sample(&mut self, elapsed: f64, bending: impl Fn(usize) -> [f64; 2]) {
        self.duration += elapsed;
        let AgeingSettings {
            slope,
            rated_moment,
            knees: [of_stop, of_link],
            slope_below_knee,
        } = self.settings;
        for (index, joint) in self.joints.iter_mut().enumerate() {
            let [about_y, about_z] = bending(index);
            let loads = [joint.angular_impulse / elapsed, about_y, about_z];
            joint.angular_impulse = 0.0;
            let channels = joint.channels.iter_mut().zip(&mut joint.damage);
            for (((flow, damage), load), knee) in channels.zip(loads).zip([of_stop, of_link, of_link]) {
                flow.push(load / rated_moment, LEAST_RANGE, |range| {
                    *damage += cycle_weight(range, [slope, slope_below_knee], knee);
                });
            }
        }
    }

    /// Fills `out`. Does not allocate once it has the right size.
    pub fn write(&self, out: &mut Ageing) {
        (out.settings, out.duration) = (self.settings, self.duration);
        out.stop_damage.clear();
        out.stop_damage.extend(self.joints.iter().map(|joint| joint.damage[0]));
        out.bending_damage.clear();
        out.bending_damage
            .extend(self.joints.iter().map(|joint| joint.damage[1].max(joint.damage[2])));
        for (out, work) in out.friction_work.iter_mut().zip(&self.friction_work) {
            out.clear();
            out.extend_from_slice(work);
        }
    }

    /// Resets all sums.
    pub fn reset(&mut self) {
        self.duration = 0.0;
        for joint in &mut self.joints {
            joint.angular_impulse = 0.0;
            joint.channels.iter_mut().for_each(Rainflow::clear);
            joint.damage = [0.0; 3];
        }
        self.friction_work.iter_mut().for_each(|work| work.fill(0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of a joint whose link turns in a bend once per second, `seconds` long, with a moment of `moment` (N m).
    fn turned(moment: f64, slope: f64, seconds: u32) -> Ageing {
        let settings = AgeingSettings {
            slope,
            ..AgeingSettings::default()
        };
        let mut watch = AgeingWatch::new(&settings, 2, 3);
        for step in 0..seconds * 250 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(step) / 250.0).sin_cos();
            watch.rub(1, 2, 0.5);
            watch.sample(4e-3, |joint| {
                if joint == 1 {
                    [moment * cos, 0.5 * moment * sin]
                } else {
                    [0.0; 2]
                }
            });
        }
        let mut out = Ageing::default();
        watch.write(&mut out);
        out
    }

    #[test]
    fn a_turning_bend_is_one_cycle_per_turn_of_the_worse_side() {
        let ageing = turned(100.0, 5.0, 51);
        // Twice the rated moment from side to side; the first and the last half cycle have no partner yet.
        assert!(
            (ageing.bending_damage[1] / (50.0 * 32.0) - 1.0).abs() < 0.05,
            "{ageing:?}"
        );
        assert_eq!((ageing.bending_damage[0], ageing.stop_damage[1]), (0.0, 0.0));
        assert_eq!(ageing.relative_damage().collect::<Vec<_>>(), [0.0, 1.0]);
        assert!((ageing.duration - 51.0).abs() < 1e-9);
        assert!((ageing.friction_work[1][2] - 0.5 * 51.0 * 250.0).abs() < 1e-6);
    }

    #[test]
    fn twice_the_load_is_two_to_the_slope_of_damage() {
        for slope in [3.0, 5.0] {
            let ratio = turned(80.0, slope, 30).bending_damage[1] / turned(40.0, slope, 30).bending_damage[1];
            assert!((ratio / 2f64.powf(slope) - 1.0).abs() < 1e-6, "{ratio}");
        }
    }

    #[test]
    fn a_stop_that_strikes_counts_by_its_mean() {
        let mut watch = AgeingWatch::new(&AgeingSettings::default(), 1, 1);
        for step in 0..10_000 {
            // 500 N m in one of eight steps every tenth sample: 62.5 N m.
            if step % 10 == 0 {
                watch.stop(0, 5e-4, 500.0);
            }
            watch.sample(4e-3, |_| [0.0; 2]);
        }
        let mut out = Ageing::default();
        watch.write(&mut out);
        assert!(
            (out.stop_damage[0] / (998.0 * 0.625f64.powi(5)) - 1.0).abs() < 0.01,
            "{out:?}"
        );
        watch.reset();
        watch.write(&mut out);
        assert_eq!((out.stop_damage[0], out.duration), (0.0, 0.0));
    }
}
