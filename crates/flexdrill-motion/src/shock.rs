//! Lateral shock: the impulse of collisions above the resting load.
//!
//! The measure is the impulse of the normal force within a short interval, minus the impulse of the mean force over the
//! last tenth of a second: a pipe that rests on the wall, however heavy, has no shock. Divided by the mass involved it
//! is the jump of the lateral speed. Unlike the peak force, it does not depend on the stiffness of the contact.
//!
//! A level requires a number of such impulses within a span of time: a single impulse is over before a driller could
//! react.

use serde::{Deserialize, Serialize};

use super::hazards::{ENDED_AFTER, Hold};
use super::hysteresis::{AlarmThresholds, Hysteresis, Transition};
use super::{Severity, ShockLevel};

/// Largest number of impulses that a level can require.
pub const MOST_REPEATS: usize = 64;

/// How shocks are measured and judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
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
    /// How many of them within `span` reach the level, WATCH, WARNING, CRITICAL; at most [`MOST_REPEATS`]. One a second
    /// wears the joints; of those that bend a link three are a pattern; one that may break it is enough.
    pub repeats: [u32; 3],
    /// Span of time in which they are counted (s).
    pub span: f64,
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
            repeats: [10, 3, 1],
            span: 10.0,
        }
    }
}

/// Times of the newest impulses that reach a threshold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Recent {
    /// Model times (s); the next one replaces the oldest.
    times: Vec<f64>,
    next: usize,
}

impl Recent {
    fn new(count: u32) -> Self {
        Self {
            times: vec![f64::NEG_INFINITY; (count as usize).clamp(1, MOST_REPEATS)],
            next: 0,
        }
    }

    fn push(&mut self, time: f64) {
        self.times[self.next] = time;
        self.next = (self.next + 1) % self.times.len();
    }

    /// Whether all of them are after `time` (s).
    fn are_after(&self, time: f64) -> bool {
        self.times[self.next] > time
    }

    fn clear(&mut self) {
        self.times.fill(f64::NEG_INFINITY);
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

    /// Ends an interval of `duration` (s); returns its largest shock (N s) and the station.
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

/// A collision: the largest impulse of an interval.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Collision {
    /// Model time of the interval's end (s).
    time: f64,
    /// N s.
    impulse: f64,
    layer: usize,
    station: usize,
}

/// Both layers and the level of the tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShockWatch {
    settings: ShockSettings,
    /// Pipe in guide, guide in hole.
    layers: [Shocks; 2],
    elapsed: f64,
    hysteresis: Hysteresis,
    /// Impulses that reach each level, and those that hold it.
    reaching: [Recent; 3],
    holding: [Recent; 3],
    /// Per level the newest collision that holds it.
    newest: [Collision; 3],
    level: ShockLevel,
}

impl ShockWatch {
    /// For that many stations.
    pub fn new(settings: &ShockSettings, stations: usize) -> Self {
        Self {
            settings: *settings,
            layers: [Shocks::new(stations), Shocks::new(stations)],
            elapsed: 0.0,
            hysteresis: Hysteresis::default(),
            reaching: settings.repeats.map(Recent::new),
            holding: settings.repeats.map(Recent::new),
            newest: [Collision::default(); 3],
            level: ShockLevel::default(),
        }
    }

    /// Takes the normal force (N) of a touching station over a step of `dt` (s); `layer` 0 is the pipe in the guide, 1
    /// the guide in the hole.
    pub fn push(&mut self, layer: usize, station: usize, dt: f64, normal: f64) {
        self.layers[layer].push(station, normal * dt);
    }

    /// Ends a step of `dt` (s) at model time `time` (s). While the drive does not turn steadily (`judged` is false) no
    /// impulse counts for a level.
    pub fn advance(&mut self, time: f64, dt: f64, judged: bool) {
        self.elapsed += dt;
        // Half a step of slack, so that rounding in the sum does not make intervals of different lengths.
        if self.elapsed + 0.5 * dt < self.settings.interval {
            return;
        }
        let mut worst = Collision {
            time,
            ..Collision::default()
        };
        for (layer, shocks) in self.layers.iter_mut().enumerate() {
            let (impulse, station) = shocks.end_interval(self.elapsed, &self.settings);
            if impulse > worst.impulse {
                (worst.impulse, worst.layer, worst.station) = (impulse, layer, station);
            }
        }
        let (before, elapsed) = (self.hysteresis.level, self.elapsed);
        self.elapsed = 0.0;
        let (raised, held) = self.count(&worst, judged);
        let hold_off = self.settings.thresholds.hold_off;
        let change = self.hysteresis.update(time, elapsed, raised, held, hold_off);
        let now = self.hysteresis.level;
        (self.level.severity, self.level.since) = (now, self.hysteresis.since);
        // After a fall, the report is of the collision that holds the lower level.
        let newest = match now {
            Severity::Ok => None,
            level => Some(self.newest[level as usize - 1]),
        };
        match newest {
            None => self.report(&worst),
            Some(newest) if now < before => self.report(&newest),
            Some(_) if change == Transition::Rose => self.report(&worst),
            Some(_) if change == Transition::Stands && worst.impulse > self.level.impulse => self.report(&worst),
            Some(_) => {}
        }
        let met = self.newest.map(|newest| newest.time);
        self.level.hold = Hold::with_gaps(now, met, time, |level| self.gap(level));
    }

    fn report(&mut self, collision: &Collision) {
        let Collision {
            time,
            impulse,
            layer,
            station,
        } = *collision;
        self.level = ShockLevel {
            impulse,
            layer,
            station,
            seen: time,
            ..self.level
        };
    }

    /// Time (s) without a holding collision after which the collisions have ended: the mean interval between those that
    /// hold the level, at least [`ENDED_AFTER`].
    fn gap(&self, level: Severity) -> f64 {
        let repeats = self.settings.repeats[(level as usize).saturating_sub(1)];
        (self.settings.span / f64::from(repeats.saturating_add(1))).max(ENDED_AFTER)
    }

    /// Takes the largest impulse of an interval, which counts only if `judged`; returns the levels that the newest
    /// impulses reach and hold.
    fn count(&mut self, worst: &Collision, judged: bool) -> (Severity, Severity) {
        let time = worst.time;
        let impulse = if judged { worst.impulse } else { 0.0 };
        let AlarmThresholds { levels, hysteresis, .. } = self.settings.thresholds;
        let (mut raised, mut held) = (Severity::Ok, Severity::Ok);
        for (index, level) in Severity::RAISED.into_iter().enumerate() {
            if impulse >= levels[index] {
                self.reaching[index].push(time);
            }
            if impulse >= levels[index] * (1.0 - hysteresis) {
                self.holding[index].push(time);
                self.newest[index] = *worst;
            }
            let since = time - self.settings.span;
            if self.reaching[index].are_after(since) {
                raised = level;
            }
            if self.holding[index].are_after(since) {
                held = level;
            }
        }
        (raised, held)
    }

    /// The level of the tool.
    pub fn level(&self) -> ShockLevel {
        self.level
    }

    /// The settings in use.
    pub fn settings(&self) -> &ShockSettings {
        &self.settings
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
        self.hysteresis = Hysteresis::default();
        self.reaching
            .iter_mut()
            .chain(&mut self.holding)
            .for_each(Recent::clear);
        self.newest = [Collision::default(); 3];
        self.level = ShockLevel::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half sines of `peak` (N) and 2 ms every `period` steps of 0.1 ms on top of `rest` (N), from model time `from`
    /// (s).
    fn run(watch: &mut ShockWatch, from: f64, rest: f64, peak: f64, period: u32, seconds: f64) {
        let dt = 1e-4;
        for step in 0..(seconds / dt) as u32 {
            let phase = step % period;
            let strike = if phase < 20 {
                peak * (std::f64::consts::PI * f64::from(phase) / 20.0).sin()
            } else {
                0.0
            };
            watch.push(0, 3, dt, rest + strike);
            watch.advance(from + f64::from(step) * dt, dt, true);
        }
    }

    #[test]
    fn strikes_count_by_impulse_and_number_and_name_their_station() {
        let mut watch = ShockWatch::new(&ShockSettings::default(), 5);
        // 2 / pi x 15 kN x 2 ms = 19.1 N s, twice, then a third time.
        run(&mut watch, 0.0, 0.0, 15e3, 10_000, 1.9);
        assert_eq!(watch.level().severity, Severity::Ok);
        run(&mut watch, 2.0, 0.0, 15e3, 10_000, 0.5);
        let level = watch.level();
        assert_eq!((level.severity, level.layer, level.station), (Severity::Warning, 0, 3));
        assert!((level.impulse - 19.1).abs() < 0.1, "{level:?}");
        assert!((level.since - 2.0).abs() < 0.05, "{level:?}");
        let mut largest = [0.0; 5];
        watch.write(0, &mut largest);
        // The resting force that is taken off differs a little from strike to strike.
        assert!((largest[3] - level.impulse).abs() < 0.1 && largest[2] == 0.0);
        watch.restart();
        run(&mut watch, 2.5, 0.0, 0.0, 10, 16.0);
        assert_eq!(watch.level().severity, Severity::Ok);
    }

    #[test]
    fn collisions_that_have_ended_say_when() {
        let mut watch = ShockWatch::new(&ShockSettings::default(), 5);
        // At 0, 1 and 2 s.
        run(&mut watch, 0.0, 0.0, 15e3, 10_000, 2.5);
        assert_eq!(
            (watch.level().severity, watch.level().hold),
            (Severity::Warning, Hold::Met)
        );
        run(&mut watch, 2.5, 0.0, 0.0, 10, 4.0);
        let level = watch.level();
        assert_eq!(level.severity, Severity::Warning);
        // At the end of its interval of 20 ms.
        assert!(
            matches!(level.hold, Hold::Ended { at } if (at - 2.0).abs() < 0.05 && at >= level.seen),
            "{level:?}"
        );
    }

    #[test]
    fn one_that_may_break_the_tool_is_enough() {
        let mut watch = ShockWatch::new(&ShockSettings::default(), 5);
        run(&mut watch, 0.0, 0.0, 40e3, 10_000, 0.1);
        assert_eq!(watch.level().severity, Severity::Critical);
    }

    #[test]
    fn a_resting_load_is_no_shock() {
        let mut watch = ShockWatch::new(&ShockSettings::default(), 5);
        run(&mut watch, 0.0, 2e3, 0.0, 10, 20.0);
        assert_eq!(watch.level().severity, Severity::Ok);
        // 6.4 N s once a second on top of it.
        run(&mut watch, 20.0, 2e3, 5e3, 10_000, 9.5);
        assert_eq!(watch.level().severity, Severity::Watch);
    }
}
