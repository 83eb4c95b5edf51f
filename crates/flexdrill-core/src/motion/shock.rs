//! Lateral shock: what a collision puts into the pipes beyond the load that they rest with.
//!
//! The measure is the impulse of the normal force within a short interval, less what the mean force of the last tenth
//! of a second would have given in it: a pipe that lies on the wall is not struck, however heavy it is. Over the mass
//! that takes part it is the jump of the lateral speed.

use serde::{Deserialize, Serialize};

use super::hysteresis::{Alarm, AlarmThresholds};
use super::{Severity, ShockLevel};

/// How shocks are measured and judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ShockSettings {
    /// Interval over which the force is summed up (s). Longer than a collision, pi sqrt(m / k) = 1.7 ms of a link on
    /// the default contact with its rebounds, and shorter than a quarter turn of a rolling whirl (0.1 s at 40 r/min).
    pub interval: f64,
    /// Time over which the resting force is averaged (s): several intervals, yet short enough to follow a pipe that is
    /// pressed against the wall by a slow whirl.
    pub mean_time: f64,
    /// Impulses (N s) of the levels. 5.5 N s turn round a link of 2.8 kg that strikes with 1 m/s. The paper's largest
    /// force, 44 kN, as half a sine of 1.7 ms is 48 N s. Between them their geometric mean.
    pub thresholds: AlarmThresholds,
}

impl Default for ShockSettings {
    fn default() -> Self {
        Self {
            interval: 0.02,
            mean_time: 0.1,
            thresholds: AlarmThresholds {
                levels: [5.0, 15.0, 45.0],
                hysteresis: 0.15,
                hold_off: 5.0,
            },
        }
    }
}

/// Shocks at every station of one gap layer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shocks {
    impulse: Vec<f64>,
    mean_force: Vec<f64>,
    largest: Vec<f64>,
}

impl Shocks {
    /// For that many stations.
    pub fn new(stations: usize) -> Self {
        Self {
            impulse: vec![0.0; stations],
            mean_force: vec![0.0; stations],
            largest: vec![0.0; stations],
        }
    }

    /// Takes the impulse (N s) of one station in a step.
    pub fn push(&mut self, station: usize, impulse: f64) {
        self.impulse[station] += impulse;
    }

    /// Ends an interval of `duration` (s); gives the largest shock (N s) in it and its station.
    pub fn end_interval(&mut self, duration: f64, settings: &ShockSettings) -> (f64, usize) {
        let weight = (duration / settings.mean_time).min(1.0);
        let mut worst = (0.0, 0);
        for (station, ((impulse, mean), largest)) in self
            .impulse
            .iter_mut()
            .zip(&mut self.mean_force)
            .zip(&mut self.largest)
            .enumerate()
        {
            let shock = (*impulse - *mean * duration).max(0.0);
            *mean += (*impulse / duration - *mean) * weight;
            *impulse = 0.0;
            *largest = largest.max(shock);
            if shock > worst.0 {
                worst = (shock, station);
            }
        }
        worst
    }

    /// Writes the largest shock (N s) of every station since the last [`Shocks::restart`].
    pub fn write(&self, out: &mut [f64]) {
        out.copy_from_slice(&self.largest);
    }

    /// Forgets the largest shocks.
    pub fn restart(&mut self) {
        self.largest.fill(0.0);
    }

    /// Forgets resting forces, impulses and level, as at the start of a run.
    pub fn reset(&mut self) {
        self.impulse.fill(0.0);
        self.mean_force.fill(0.0);
        self.largest.fill(0.0);
    }
}

/// Both layers and the level of the tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShockWatch {
    settings: ShockSettings,
    /// Pipe in guide, guide in hole.
    layers: [Shocks; 2],
    elapsed: f64,
    alarm: Alarm,
    level: ShockLevel,
}

impl ShockWatch {
    /// For that many stations.
    pub fn new(settings: &ShockSettings, stations: usize) -> Self {
        Self {
            settings: *settings,
            layers: [Shocks::new(stations), Shocks::new(stations)],
            elapsed: 0.0,
            alarm: Alarm::default(),
            level: ShockLevel::default(),
        }
    }

    /// Takes the normal force (N) of a touching station over a step of `dt` (s); `layer` 0 is the pipe in the guide, 1
    /// the guide in the hole.
    pub fn push(&mut self, layer: usize, station: usize, dt: f64, normal: f64) {
        self.layers[layer].push(station, normal * dt);
    }

    /// Ends a step of `dt` (s) at model time `time` (s).
    pub fn advance(&mut self, time: f64, dt: f64) {
        self.elapsed += dt;
        // Half a step of slack, so that rounding in the sum does not make intervals of different lengths.
        if self.elapsed + 0.5 * dt < self.settings.interval {
            return;
        }
        let mut worst = (0.0, 0, 0);
        for (layer, shocks) in self.layers.iter_mut().enumerate() {
            let (impulse, station) = shocks.end_interval(self.elapsed, &self.settings);
            if impulse > worst.0 {
                worst = (impulse, layer, station);
            }
        }
        let before = self.alarm.severity();
        let counts = self.alarm.update(self.elapsed, worst.0, &self.settings.thresholds);
        self.elapsed = 0.0;
        if self.alarm.severity() != before {
            self.level.since = time;
            self.level.severity = self.alarm.severity();
        }
        let leads = counts && (self.alarm.severity() > before || worst.0 > self.level.impulse);
        if leads || self.alarm.severity() == Severity::Ok {
            (self.level.impulse, self.level.layer, self.level.station) = worst;
        }
    }

    /// The level of the tool.
    pub fn level(&self) -> ShockLevel {
        self.level
    }

    /// Writes the largest shocks (N s) since the last [`ShockWatch::restart`] of a layer's stations.
    pub fn write(&self, layer: usize, out: &mut [f64]) {
        self.layers[layer].write(out);
    }

    /// Starts the next publishing interval.
    pub fn restart(&mut self) {
        self.layers.iter_mut().for_each(Shocks::restart);
    }

    /// Forgets everything but the settings.
    pub fn reset(&mut self) {
        self.layers.iter_mut().for_each(Shocks::reset);
        self.elapsed = 0.0;
        self.alarm = Alarm::default();
        self.level = ShockLevel::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half sines of `peak` (N) and 2 ms every `period` steps of 0.1 ms on top of `rest` (N).
    fn run(watch: &mut ShockWatch, rest: f64, peak: f64, period: u32, seconds: f64) {
        let dt = 1e-4;
        for step in 0..(seconds / dt) as u32 {
            let phase = step % period;
            let strike = if phase < 20 {
                peak * (std::f64::consts::PI * f64::from(phase) / 20.0).sin()
            } else {
                0.0
            };
            watch.push(0, 3, dt, rest + strike);
            watch.advance(f64::from(step) * dt, dt);
        }
    }

    #[test]
    fn a_strike_counts_by_its_impulse_and_names_its_station() {
        let mut watch = ShockWatch::new(&ShockSettings::default(), 5);
        run(&mut watch, 0.0, 15e3, 10_000, 0.5);
        // 2 / pi x 15 kN x 2 ms = 19.1 N s.
        let level = watch.level();
        assert_eq!((level.severity, level.layer, level.station), (Severity::Warning, 0, 3));
        assert!((level.impulse - 19.1).abs() < 0.1, "{level:?}");
        let mut largest = [0.0; 5];
        watch.write(0, &mut largest);
        assert!((largest[3] - level.impulse).abs() < 1e-12 && largest[2] == 0.0);
        watch.restart();
        run(&mut watch, 0.0, 0.0, 10, 6.0);
        assert_eq!(watch.level().severity, Severity::Ok);
    }

    #[test]
    fn a_resting_load_is_no_shock() {
        let mut watch = ShockWatch::new(&ShockSettings::default(), 5);
        // The touch-down itself is one, and is held for a while.
        run(&mut watch, 2e3, 0.0, 10, 20.0);
        assert_eq!(watch.level().severity, Severity::Ok);
        run(&mut watch, 2e3, 5e3, 10_000, 0.5);
        assert_eq!(watch.level().severity, Severity::Watch);
    }
}
