//! Chaotic whirl: the pipe moves through the guide without direction. It is judged by the power that collisions
//! dissipate.
//!
//! The measure is the power of all collisions per metre of the tool, from the energy audit, times the share of the
//! watched stations at which the pipe moves chaotically. Power alone does not distinguish chaotic motion from fast
//! drilling: it grows with the square of the speed. The share alone does not either: in steady drilling a few stations
//! move chaotically, with weak collisions.

use serde::{Deserialize, Serialize};

use super::Severity;
use super::hazards::Hold;
use super::hysteresis::{Alarm, AlarmThresholds};

/// Number of blocks in the sliding window.
const BLOCKS: usize = 6;

/// How chaotic whirl is judged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ChaoticWhirlSettings {
    /// Time over which the power is averaged (s): two turns at 40 r/min, so that an impact once per turn counts fully
    /// and a single one hardly.
    pub window: f64,
    /// Levels of the power of the collisions per metre of the tool, times the share of the pipe that moves chaotically
    /// (W/m). `docs/whirl.md` lists the runs behind them.
    pub thresholds: AlarmThresholds,
}

impl Default for ChaoticWhirlSettings {
    fn default() -> Self {
        Self {
            window: 3.0,
            thresholds: AlarmThresholds {
                levels: [0.6, 2.0, 6.0],
                hysteresis: 0.15,
                hold_off: 5.0,
            },
        }
    }
}

/// Level of chaotic whirl.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ChaoticWhirlLevel {
    /// Level.
    pub severity: Severity,
    /// Power that collisions dissipated in a window, per metre of the tool and times the chaotic share (W/m): the
    /// largest since the level was reached, that of the last window while the level is OK.
    pub power: f64,
    /// Share of the watched stations of the pipe that moved chaotically then, 0 to 1.
    pub share: f64,
    /// Station with the largest dissipation in collisions of the pipe, from the top.
    pub station: usize,
    /// Model time of power, share and station (s).
    pub seen: f64,
    /// Whether the condition of the level is met.
    pub hold: Hold,
    /// Model time at which the level was reached (s).
    pub since: f64,
}

/// Watches the dissipation of collisions while the pipe moves chaotically.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChaoticWhirlWatch {
    settings: ChaoticWhirlSettings,
    /// Length of the tool (m).
    length: f64,
    /// Energy dissipated in each block of the window, times the chaotic share (J).
    blocks: [f64; BLOCKS],
    current: usize,
    elapsed: f64,
    /// Integral of the chaotic share since the end of the last block (s).
    share_time: f64,
    /// Energy that collisions of the pipe dissipated at each station (J), with exponential forgetting: a third after
    /// one window.
    at: Vec<f64>,
    /// Total dissipation by the audit at the end of the last step (J).
    taken: f64,
    alarm: Alarm,
    level: ChaoticWhirlLevel,
}

impl ChaoticWhirlWatch {
    /// A watch of a tool of `length` (m) with `stations` stations.
    pub fn new(settings: &ChaoticWhirlSettings, length: f64, stations: usize) -> Self {
        Self {
            settings: *settings,
            length,
            blocks: [0.0; BLOCKS],
            current: 0,
            elapsed: 0.0,
            share_time: 0.0,
            at: vec![0.0; stations],
            taken: 0.0,
            alarm: Alarm::default(),
            level: ChaoticWhirlLevel::default(),
        }
    }

    /// Takes the energy (J) that the contact of pipe and guide dissipated at a station in a step. It determines the
    /// worst station, not the level.
    pub fn push(&mut self, station: usize, energy: f64) {
        self.at[station] += energy;
    }

    /// Ends a step of `dt` (s) at model time `time` (s); `taken` (J) is the dissipation of all collisions since the
    /// start, `share` the chaotic share of the pipe, 0 to 1. While the drive does not turn steadily (`judged` is false)
    /// nothing counts, and the window restarts.
    pub fn advance(&mut self, time: f64, dt: f64, taken: f64, share: f64, judged: bool) {
        let energy = taken - std::mem::replace(&mut self.taken, taken);
        if judged {
            self.blocks[self.current] += energy * share;
        } else {
            (self.blocks, self.current) = Default::default();
        }
        self.elapsed += dt;
        self.share_time += share * dt;
        // Half a step of slack, so that rounding in the sum does not make blocks of different lengths.
        if self.elapsed + 0.5 * dt < self.settings.window / BLOCKS as f64 {
            return;
        }
        let elapsed = std::mem::take(&mut self.elapsed);
        let share = std::mem::take(&mut self.share_time) / elapsed;
        // A window that is not full underestimates the power, so that violent motion is reported before it is full.
        let power = self.blocks.iter().sum::<f64>() / (self.settings.window * self.length);
        self.current = (self.current + 1) % BLOCKS;
        self.blocks[self.current] = 0.0;
        let station = self.worst_station();
        self.alarm.update(time, elapsed, power, &self.settings.thresholds);
        let now = self.alarm.severity();
        if now == Severity::Ok || self.alarm.worst_at() == time {
            self.level = ChaoticWhirlLevel {
                power,
                share,
                station,
                seen: time,
                ..self.level
            };
        }
        (self.level.severity, self.level.since) = (now, self.alarm.since());
        self.level.hold = self.alarm.hold(time);
    }

    /// The station with the largest dissipation; all dissipations decay by one block of the window.
    fn worst_station(&mut self) -> usize {
        let mut worst = (0.0, 0);
        for (station, energy) in self.at.iter_mut().enumerate() {
            if *energy > worst.0 {
                worst = (*energy, station);
            }
            *energy *= 1.0 - 1.0 / BLOCKS as f64;
        }
        worst.1
    }

    /// Level of chaotic whirl.
    pub fn level(&self) -> ChaoticWhirlLevel {
        self.level
    }

    /// The thresholds in use.
    pub fn settings(&self) -> &ChaoticWhirlSettings {
        &self.settings
    }

    /// Resets everything except the settings; the audit restarts at zero too.
    pub fn reset(&mut self) {
        self.at.fill(0.0);
        (self.blocks, self.current) = Default::default();
        (self.elapsed, self.share_time, self.taken) = (0.0, 0.0, 0.0);
        self.alarm = Alarm::default();
        self.level = ChaoticWhirlLevel::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-3;
    const LENGTH: f64 = 5.0;
    const SHARE: f64 = 0.5;

    struct Fed {
        watch: ChaoticWhirlWatch,
        taken: f64,
        time: f64,
    }

    impl Fed {
        fn new() -> Self {
            Self {
                watch: ChaoticWhirlWatch::new(&ChaoticWhirlSettings::default(), LENGTH, 4),
                taken: 0.0,
                time: 0.0,
            }
        }

        /// Collisions take `power` (W/m) for some seconds, most of it at station 2, and half of the pipe is chaotic.
        fn run(&mut self, seconds: f64, power: f64, judged: bool) -> ChaoticWhirlLevel {
            for _ in 0..(seconds / DT).round() as u32 {
                let energy = power * LENGTH * DT;
                self.time += DT;
                self.taken += energy;
                self.watch.push(1, 0.4 * energy);
                self.watch.push(2, 0.6 * energy);
                self.watch.advance(self.time, DT, self.taken, SHARE, judged);
            }
            self.watch.level()
        }
    }

    #[test]
    fn power_over_the_window_times_the_chaotic_part_and_its_place() {
        let [watch, warning, critical] = ChaoticWhirlSettings::default()
            .thresholds
            .levels
            .map(|level| level / SHARE);
        let mut fed = Fed::new();
        assert_eq!(fed.run(10.0, 0.9 * watch, true).severity, Severity::Ok);
        let level = fed.run(4.0, 1.1 * warning, true);
        assert_eq!((level.severity, level.station), (Severity::Warning, 2));
        // Sums of steps of a millisecond.
        assert!((level.power / (1.1 * warning * SHARE) - 1.0).abs() < 1e-6, "{level:?}");
        assert!((level.share - SHARE).abs() < 1e-9, "{level:?}");
        assert_eq!(fed.run(4.0, 1.1 * critical, true).severity, Severity::Critical);
        // What is ten times as violent is called after two of the six parts of the window.
        assert_eq!(Fed::new().run(1.1, 10.0 * critical, true).severity, Severity::Critical);
        // Gone, and the window and the hold-off over.
        assert_eq!(fed.run(12.0, 0.0, true).severity, Severity::Ok);
    }

    #[test]
    fn one_blow_is_no_chaotic_whirl() {
        let mut fed = Fed::new();
        fed.run(5.0, 0.1, true);
        // 10 J at once: a link of 2.8 kg that is stopped from 2.7 m/s.
        fed.taken += 10.0;
        assert_eq!(fed.run(5.0, 0.1, true).severity, Severity::Ok);
    }

    #[test]
    fn nothing_counts_while_the_tool_is_run_up() {
        let mut fed = Fed::new();
        assert_eq!(fed.run(20.0, 1e4, false).severity, Severity::Ok);
        assert_eq!(fed.run(20.0, 0.1, true).severity, Severity::Ok);
    }
}
