//! `whirl`: the analysis and its warnings.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;
use super::place::Mesh;
use super::section::section;
use super::vibration::Steps;
use flexdrill_core::tool::Body;
use flexdrill_core::units::rpm_to_rad_per_s;
use flexdrill_motion::WhirlSettings;

section! {
    /// Whirl analysis and warnings.
    pub struct Whirl(this) {
        /// Length of the sliding window in turns of the tool. A longer window is more certain and slower.
        window_turns: f64 = WhirlSettings::default().window_turns, within(1.0, 100.0), "turns",
            "a window must hold a turn of the whirl";
        /// Longest window, for a slow or standing tool (s). The default is four turns at 40 r/min.
        max_window: f64 = WhirlSettings::default().max_window, within(0.5, 60.0), "s",
            "shorter than half a second shows no direction; longer than a minute warns too late";
        /// Samples of the motion per second.
        sample_rate: f64 = 250.0, within(10.0, 10_000.0), "Hz", "an orbit needs some 20 samples per turn";
        /// Watched stations: `joints`, `all` or `{stations: [5, 10]}`. Default joints, where the contacts occur.
        watched: Watched = Watched::Joints;
        /// Rotary speed below which the tool counts as standing and no ratio is given (r/min).
        gate_speed_rpm: f64 = 5.0, within(0.0, 1000.0), "r/min", "a tool that does not turn does not whirl";
        /// Time below that speed after which the drive counts as standing (s). The next start is then a run-up, during
        /// which no alarm of the tool is raised.
        standstill_time: f64 = WhirlSettings::default().standstill_time, within(0.0, 600.0), "s",
            "longer than the bit sticks in one swing of the string, shorter than a connection";
        /// RMS orbit radius, as a share of the clearance, below which no motion is called whirl.
        min_orbit_ratio: f64 = WhirlSettings::default().min_orbit_ratio, within(0.0, 1.0), "",
            "a ratio; 1 fills the gap";
        /// RMS radius about its own mean, as a share of the clearance, from which a motion is judged as whirl even if
        /// it does not circle the centre of the gap.
        large_orbit_ratio: f64 = WhirlSettings::default().large_orbit_ratio, within(0.0, 1.0), "",
            "a ratio; 1 fills the gap";
        /// Directional share of the motion, 0 to 1, from which an orbit is forward or backward and below which it is
        /// chaotic.
        steady_direction: f64 = WhirlSettings::default().steady_direction, within(0.1, 1.0), "",
            "broad-band motion scatters by 0.2";
        /// Correlation between successive turns, 0 to 1, from which a motion without direction counts as periodic and
        /// not as chaotic.
        min_repetition: f64 = WhirlSettings::default().min_repetition, within(0.1, 1.0), "",
            "broad-band motion reaches 0.5 by chance; noise keeps periodic motion from 1";
        /// Relative difference from the rate of rolling without slip within which backward whirl counts as rolling.
        rolling_tolerance: f64 = WhirlSettings::default().rolling_tolerance, within(0.0, 0.5), "",
            "wider would call sliding rolling";
        /// Factors on the confidence while an input is not OK.
        input_trust: InputTrust = InputTrust::default(), below;
        /// Confidence below which whirl raises no level.
        min_confidence: f64 = WhirlSettings::default().min_confidence, within(0.0, 1.0), "", "0 to 1";
        /// A level ends below threshold x (1 - hysteresis).
        hysteresis: f64 = WhirlSettings::default().hysteresis, within(0.0, 0.9), "", "at 1 a level would never be left";
        /// Time for which the value must stay below that before the level ends (s).
        hold_off: f64 = WhirlSettings::default().hold_off, within(0.0, 3600.0), "s", "an hour";
        /// Thresholds of backward whirl: bending cycles per turn of the tool. Default 1, 2, 3.
        backward_cycles: Steps = Steps::from(WhirlSettings::default().backward_cycles);
        /// Thresholds of forward whirl: work of the friction per second and metre (W/m).
        forward_power: ForwardPower = ForwardPower::default();
        /// Turns of the tool for which whirl must last before it reaches a level. Default 1, 1.5, 1.5.
        lasting_turns: Steps = Steps::from(WhirlSettings::default().lasting_turns);
    }
}

/// The watched stations, on both pipes.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Watched {
    /// The stations of the joints.
    #[default]
    Joints,
    /// Every station.
    All,
    /// These stations, counted from 0 at the top.
    Stations(Vec<usize>),
}

section! {
    /// Factors on the confidence, 0 to 1.
    #[derive(Copy)]
    pub struct InputTrust(this) {
        /// Factor while an input is SLOW: late by a sample or two.
        slow: f64 = flexdrill_motion::InputTrust::default().slow, within(0.0, 1.0), "",
            "a factor on the confidence; 0 lets no level rise";
        /// Factor while an input is REJECTED: the newest sample was refused.
        rejected: f64 = flexdrill_motion::InputTrust::default().rejected, within(0.0, 1.0), "",
            "a factor on the confidence; 0 lets no level rise";
        /// Factor while an input is STALE: held, or on the ramp to the safe value.
        stale: f64 = flexdrill_motion::InputTrust::default().stale, within(0.0, 1.0), "",
            "a factor on the confidence; 0 lets no level rise";
        /// Factor while an input is NOT_RECEIVED: the configured start value acts.
        not_received: f64 = flexdrill_motion::InputTrust::default().not_received, within(0.0, 1.0), "",
            "a factor on the confidence; 0 lets no level rise";
    }
}

impl InputTrust {
    fn describe(&self) -> flexdrill_motion::InputTrust {
        flexdrill_motion::InputTrust {
            slow: self.slow,
            rejected: self.rejected,
            stale: self.stale,
            not_received: self.not_received,
        }
    }
}

section! {
    /// Levels of forward whirl, which is never critical.
    #[derive(Copy)]
    pub struct ForwardPower(this) {
        /// Threshold of WATCH (W/m).
        watch: f64 = WhirlSettings::default().forward_power[0], above(0.0, 1e9), "W/m", "0 would always be reached";
        /// Threshold of WARNING (W/m).
        warning: f64 = WhirlSettings::default().forward_power[1], above(0.0, 1e9), "W/m", "0 would always be reached";
    }
}

impl Whirl {
    pub(super) fn check(&self, c: &mut Checker, mesh: &Mesh) {
        self.check_numbers(c);
        if let Watched::Stations(stations) = &self.watched {
            c.below("watched", |c| {
                c.require(!stations.is_empty(), "stations", "[]", "", "at least one station", "");
                c.below("stations", |c| {
                    for (index, station) in stations.iter().enumerate() {
                        let reason = "stations count from 0 at the top";
                        c.count(&index.to_string(), *station, mesh.stations(), reason);
                    }
                });
            });
        }
        c.below("backward_cycles", |c| self.backward_cycles.check(c, 1e3, ""));
        c.below("lasting_turns", |c| self.lasting_turns.check(c, 1e4, "turns"));
        c.below("forward_power", |c| {
            self.forward_power.check_numbers(c);
            let ForwardPower { watch, warning } = self.forward_power;
            let bound = format!("at least that of the level below, {watch}");
            c.require(
                watch <= warning || warning.is_nan(),
                "warning",
                warning,
                "W/m",
                bound,
                "levels rise",
            );
        });
    }

    /// Stations and pipes to watch, up to `last_station`; empty stands for both pipes at every joint.
    pub(super) fn watched_stations(&self, last_station: usize) -> Vec<(usize, Body)> {
        let both = |station: usize| [(station, Body::Pipe), (station, Body::Guide)];
        match &self.watched {
            Watched::Joints => Vec::new(),
            Watched::All => (0..=last_station).flat_map(both).collect(),
            Watched::Stations(stations) => stations.iter().copied().flat_map(both).collect(),
        }
    }

    pub(super) fn describe(&self) -> WhirlSettings {
        let mut settings = WhirlSettings::default();
        settings.window_turns = self.window_turns;
        settings.max_window = self.max_window;
        settings.min_rotary_speed = rpm_to_rad_per_s(self.gate_speed_rpm);
        settings.standstill_time = self.standstill_time;
        settings.min_orbit_ratio = self.min_orbit_ratio;
        settings.steady_direction = self.steady_direction;
        settings.min_repetition = self.min_repetition;
        settings.rolling_tolerance = self.rolling_tolerance;
        settings.input_trust = self.input_trust.describe();
        settings.min_confidence = self.min_confidence;
        settings.hysteresis = self.hysteresis;
        settings.hold_off = self.hold_off;
        settings.large_orbit_ratio = self.large_orbit_ratio;
        settings.backward_cycles = self.backward_cycles.levels();
        settings.forward_power = [self.forward_power.watch, self.forward_power.warning];
        settings.lasting_turns = self.lasting_turns.levels();
        settings
    }
}
