//! Whirl at every watched station, and the level of the tool.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::classify::{Gates, Rotation, View, judge};
use super::drive::{DriveState, DriveWatch};
use super::full_spectrum::{FullSpectrum, Lines};
use super::hazards::{Hazard, HazardKind};
use super::orbit::{measure_and_stretch, repetition, turning};
use super::orbit_window::{OrbitWindow, Points, Round};
use super::settings::WhirlSettings;
use super::severity::{Elapsed, Evidence};
use super::tool_level::Lead;
use super::watched_station::{Circumstances, StationWatch};
use super::{Severity, StationSample, WatchedStation, WhirlKind, WhirlReport, WhirlWarningLevel};
use flexdrill_base::Body;

/// Part of the long window that must be filled before the first evaluation.
const MIN_FILL: f64 = 0.5;

/// Part of the long window for which motion must appear chaotic to be classified so: a whirl that has just begun has no
/// direction either until it fills enough of the window.
const CHAOS_PART: f64 = 0.25;

/// Evaluations of a station per turn of the tool: three per turn of a whirl at ten times its speed.
const EVALUATIONS_PER_TURN: f64 = 30.0;

/// Turns of the tool after which a motion may repeat itself: one and two, and one and a half, since a joint's cross
/// drives the next link twice per turn and pipes respond at two thirds of the tool's rate.
const REPETITION_TURNS: [f64; 3] = [1.0, 1.5, 2.0];

/// Fewest samples of a short window.
const MIN_SHORT_SAMPLES: usize = 32;

/// Watches the orbits of many stations. Everything is allocated by [`WhirlAnalysis::new`]; the same samples give the
/// same bits.
///
/// Frames: y is horizontal, z points to the low side, x down the hole, so a positive rotary speed turns y towards z.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WhirlAnalysis {
    settings: WhirlSettings,
    sample_interval: f64,
    watches: Vec<StationWatch>,
    /// Angle of the drive at the newest samples, to get its mean speed over any window.
    drive_angle: Vec<f64>,
    drive_next: usize,
    drive_filled: usize,
    rotary_speed: f64,
    last_time: Option<f64>,
    next_watch: usize,
    /// Part of an evaluation that is due, carried from sample to sample.
    due: f64,
    input_trust: f64,
    drive: DriveWatch,
    backward: Lead,
    forward: Lead,
    level: WhirlWarningLevel,
    chaotic_share: f64,
    #[serde(skip, default = "Points::new")]
    points: Points,
    #[serde(skip, default = "FullSpectrum::new")]
    spectrum: FullSpectrum,
}

impl WhirlAnalysis {
    /// An analysis of samples `sample_interval` (s) apart, 2 to 5 ms for a tool at 20 to 120 r/min.
    pub fn new(settings: &WhirlSettings, sample_interval: f64, stations: Vec<WatchedStation>) -> Self {
        let capacity = ((settings.max_window / sample_interval).ceil() as usize).max(MIN_SHORT_SAMPLES);
        let watches = stations
            .into_iter()
            .map(|station| StationWatch::new(station, OrbitWindow::new(settings.max_window, sample_interval)))
            .collect();
        Self {
            settings: *settings,
            sample_interval,
            watches,
            drive_angle: vec![0.0; capacity + 1],
            drive_next: 0,
            drive_filled: 0,
            rotary_speed: 0.0,
            last_time: None,
            next_watch: 0,
            due: 0.0,
            input_trust: 1.0,
            drive: DriveWatch::default(),
            backward: Lead::default(),
            forward: Lead::default(),
            level: WhirlWarningLevel::default(),
            chaotic_share: 0.0,
            points: Points::new(),
            spectrum: FullSpectrum::new(),
        }
    }

    /// Takes one sample per watched station at model time `time` (s), with the rotary speed of the drive (rad/s).
    ///
    /// Samples are expected at the interval given to [`WhirlAnalysis::new`]. A short gap is bridged by straight lines;
    /// after a long one, or when time runs backwards, the windows restart. A repeated time is ignored.
    pub fn push(&mut self, time: f64, rotary_speed: f64, samples: &[StationSample]) {
        // The first sample counts as one step after nothing.
        let steps = self
            .last_time
            .map_or(1.0, |last| ((time - last) / self.sample_interval).round());
        // The same time again is a repetition of the message, and would count the motion twice.
        if steps == 0.0 {
            return;
        }
        let longest = (self.settings.max_bridged_gap / self.sample_interval).max(1.0);
        // Negative steps are a clock that was set back, long ones a pause; lines across either would invent a motion.
        if !(1.0..=longest).contains(&steps) {
            self.restart_windows();
        } else {
            // The missing samples lie on straight lines: windows need equal spacing.
            let last_speed = self.rotary_speed;
            for step in 1..steps as usize {
                let part = step as f64 / steps;
                self.store(last_speed + (rotary_speed - last_speed) * part, samples, part);
            }
        }
        self.last_time = Some(time);
        // A gap that was not bridged counts as the longest that is, so that hold-offs advance but do not end at once.
        let elapsed = steps.clamp(1.0, longest) * self.sample_interval;
        let WhirlSettings {
            min_rotary_speed,
            standstill_time,
            ..
        } = self.settings;
        // The drive is judged before the stations, which are only judged while it turns.
        self.drive
            .update(elapsed, rotary_speed, min_rotary_speed, standstill_time);
        self.store(rotary_speed, samples, 1.0);
        for (watch, sample) in self.watches.iter_mut().zip(samples) {
            watch.last = *sample;
        }
        // Stations take turns within an evaluation interval, which spreads the cost evenly over the steps.
        self.due += self.watches.len() as f64 * self.sample_interval / self.evaluation_interval();
        let mut evaluated = 0;
        // At most one round per call, also after a gap.
        while self.due >= 1.0 && evaluated < self.watches.len() {
            self.due -= 1.0;
            evaluated += 1;
            self.evaluate(self.next_watch, time);
            self.next_watch = (self.next_watch + 1) % self.watches.len();
        }
        // The tool's levels follow only from new verdicts.
        if evaluated > 0 {
            self.chaotic_share = chaotic_share(&self.watches);
            self.backward.update(time, elapsed, WhirlKind::Backward, &self.watches);
            self.forward.update(time, elapsed, WhirlKind::Forward, &self.watches);
            self.level
                .update(&self.backward, &self.forward, &self.watches, self.input_trust);
        }
    }

    /// Sets the trust in the inputs behind the motion, 0 to 1. It lowers the reported confidence from now on; with too
    /// little confidence no level rises.
    pub fn set_input_trust(&mut self, trust: f64) {
        let trust = trust.clamp(0.0, 1.0);
        if trust != self.input_trust {
            self.input_trust = trust;
            // The sequence number announces the changed confidence of the standing warning at once.
            self.level.sequence += 1;
            self.level.update(&self.backward, &self.forward, &self.watches, trust);
        }
    }

    /// Continues the sequence after `newest`, when an older state was restored, so that subscribers notice the change.
    pub fn continue_sequence(&mut self, newest: u64) {
        if newest > self.level.sequence {
            self.level.sequence = newest + 1;
        }
    }

    /// Replaces the thresholds and window lengths. The memory of the longest window is fixed, so it cannot grow.
    pub fn set_settings(&mut self, settings: &WhirlSettings) {
        let max_window = settings.max_window.min(self.settings.max_window);
        self.settings = WhirlSettings {
            max_window,
            ..*settings
        };
    }

    /// The settings in use.
    pub fn settings(&self) -> &WhirlSettings {
        &self.settings
    }

    /// The watched stations in the order of the samples.
    pub fn stations(&self) -> impl ExactSizeIterator<Item = &WatchedStation> {
        self.watches.iter().map(|watch| &watch.station)
    }

    /// Fills `out`, one entry per watched station. Does not allocate once `out` has the right size.
    pub fn report(&self, out: &mut WhirlReport) {
        // `clear` and `extend` keep the capacity: nothing allocates while the model runs.
        fn fill<T>(out: &mut Vec<T>, values: impl Iterator<Item = T>) {
            out.clear();
            out.extend(values);
        }
        // All columns are in the order of the stations, which is fixed for a run.
        let watches = self.watches.iter();
        fill(&mut out.station, watches.clone().map(|at| at.station.station));
        fill(
            &mut out.measured_depth,
            watches.clone().map(|at| at.station.measured_depth),
        );
        fill(&mut out.inclination, watches.clone().map(|at| at.station.inclination));
        fill(&mut out.body, watches.clone().map(|at| at.station.body));
        fill(&mut out.kind, watches.clone().map(|at| at.kind));
        fill(&mut out.whirl_rate, watches.clone().map(|at| at.whirl_rate));
        fill(
            // NaN where the quantity does not exist; zero would be a ratio.
            &mut out.whirl_ratio,
            watches.clone().map(|at| at.whirl_ratio.unwrap_or(f64::NAN)),
        );
        fill(&mut out.orbit_radius, watches.clone().map(|at| at.orbit_radius));
        fill(
            &mut out.clearance_ratio,
            watches.clone().map(|at| at.evidence.clearance_ratio),
        );
        fill(
            &mut out.contact_duty,
            watches.clone().map(|at| at.evidence.contact_duty),
        );
        // The trust in the inputs scales the confidence of all stations alike.
        let trust = self.input_trust;
        fill(
            &mut out.confidence,
            watches.clone().map(|at| at.evidence.confidence * trust),
        );
        fill(&mut out.severity, watches.clone().map(|at| at.level()));
        fill(&mut out.level_kind, watches.clone().map(StationWatch::level_kind));
        fill(&mut out.rolling, watches.clone().map(|at| at.evidence.rolling));
        fill(&mut out.rolling_share, watches.clone().map(StationWatch::rolling_share));
        fill(&mut out.peak_force, watches.clone().map(|at| at.evidence.peak_force));
        fill(
            &mut out.gap_turns,
            watches.clone().map(|at| at.gap_turns.unwrap_or(f64::NAN)),
        );
        fill(&mut out.bending_cycles, watches.clone().map(|at| at.evidence.cycles));
        fill(&mut out.impulse, watches.clone().map(|at| at.evidence.impulse));
        fill(&mut out.impact_rate, watches.clone().map(|at| at.evidence.impact_rate));
        fill(
            &mut out.friction_power,
            watches.clone().map(|at| at.evidence.friction_power),
        );
    }

    /// The level of the whirl warning.
    pub fn level(&self) -> WhirlWarningLevel {
        self.level
    }

    /// State of the drive. Levels rise only while it turns.
    pub fn drive(&self) -> DriveState {
        self.drive.state
    }

    /// Share of the watched stations of the pipe that move chaotically, 0 to 1; 0 if none is watched.
    pub fn chaotic_share(&self) -> f64 {
        self.chaotic_share
    }

    /// The hazard of backward whirl, at its worst station.
    pub fn backward(&self) -> Hazard {
        let kind = HazardKind::BackwardWhirl;
        self.backward
            .hazard(self.now(), kind, &self.watches, self.input_trust, &self.settings)
    }

    /// The hazard of forward whirl, at its worst station.
    pub fn forward(&self) -> Hazard {
        let kind = HazardKind::ForwardWhirl;
        self.forward
            .hazard(self.now(), kind, &self.watches, self.input_trust, &self.settings)
    }

    /// Model time of the newest sample (s).
    fn now(&self) -> f64 {
        self.last_time.unwrap_or_default()
    }

    /// Resets everything except the settings and the trust in the inputs. The sequence of the warnings continues, so
    /// that subscribers notice the change.
    pub fn reset(&mut self) {
        let sequence = self.level.sequence;
        self.restart_windows();
        self.watches.iter_mut().for_each(StationWatch::reset);
        self.last_time = None;
        self.rotary_speed = 0.0;
        self.drive = DriveWatch::default();
        (self.backward, self.forward) = (Lead::default(), Lead::default());
        self.chaotic_share = 0.0;
        (self.next_watch, self.due) = (0, 0.0);
        let changed = u64::from(self.level.severity != Severity::Ok);
        self.level = WhirlWarningLevel {
            sequence: sequence + changed,
            ..WhirlWarningLevel::default()
        };
    }

    fn store(&mut self, rotary_speed: f64, samples: &[StationSample], part: f64) {
        let length = self.drive_angle.len();
        let newest = self.drive_angle[(self.drive_next + length - 1) % length];
        let angle = if self.drive_filled == 0 {
            0.0
        } else {
            newest + rotary_speed * self.sample_interval
        };
        self.drive_angle[self.drive_next] = angle;
        self.drive_next = (self.drive_next + 1) % length;
        self.drive_filled = (self.drive_filled + 1).min(length);
        self.rotary_speed = rotary_speed;
        for (watch, sample) in self.watches.iter_mut().zip(samples) {
            if part < 1.0 {
                let bridged = watch.last.between(sample, part);
                watch.window.push(&bridged);
            } else {
                watch.window.push(sample);
            }
        }
    }

    fn restart_windows(&mut self) {
        self.drive_filled = 0;
        self.watches.iter_mut().for_each(StationWatch::restart);
    }

    /// Mean rotary speed over the newest `window` (s); that of the newest sample when there is no other.
    fn mean_rotary_speed(&self, window: f64) -> f64 {
        let steps = ((window / self.sample_interval) as usize).min(self.drive_filled.saturating_sub(1));
        if steps == 0 {
            return self.rotary_speed;
        }
        let length = self.drive_angle.len();
        let newest = self.drive_angle[(self.drive_next + length - 1) % length];
        let oldest = self.drive_angle[(self.drive_next + 2 * length - 1 - steps) % length];
        (newest - oldest) / (steps as f64 * self.sample_interval)
    }

    fn long_window(&self) -> f64 {
        let settings = &self.settings;
        if self.rotary_speed.abs() < settings.min_rotary_speed {
            return settings.max_window;
        }
        let window = settings.window_turns * TAU / self.rotary_speed.abs();
        window.max(settings.min_window).min(settings.max_window)
    }

    fn evaluation_interval(&self) -> f64 {
        let turn = TAU / self.rotary_speed.abs().max(self.settings.min_rotary_speed);
        self.settings.evaluation_interval.min(turn / EVALUATIONS_PER_TURN)
    }

    fn evaluate(&mut self, index: usize, time: f64) {
        self.judge(index);
        let watch = &mut self.watches[index];
        let seconds = (time - watch.evaluated)
            .max(0.0)
            .min(2.0 * self.settings.evaluation_interval);
        watch.evaluated = time;
        let elapsed = Elapsed {
            time,
            seconds,
            turns: seconds * self.rotary_speed.abs() / TAU,
        };
        let trust = match self.drive.state {
            DriveState::Turning => self.input_trust,
            DriveState::Standing | DriveState::RunningUp => 0.0,
        };
        watch.grade(elapsed, trust, &self.settings);
    }

    fn judge(&mut self, index: usize) {
        let (long_window, interval) = (self.long_window(), self.sample_interval);
        // The window grows with the length of a turn, so the number of samples follows the speed.
        let wanted = (long_window / interval).round() as usize;
        let watch = &self.watches[index];
        let filled = watch.window.filled().min(wanted);
        // A window that has just begun to fill shows a part of a turn, and any arc looks like a line.
        if (filled as f64) < MIN_FILL * wanted as f64 {
            return;
        }
        let (clearance, watch_length) = (watch.station.clearance, watch.station.length);
        // The gates depend on the kind before: leaving a kind needs more than remaining in it.
        let gates = Gates::new(clearance, watch.kind, &self.settings);
        let touches = watch.window.touches(filled, interval);
        let round = watch.window.round(filled);
        // The long window comes first. Its pace sets the length of the short one.
        watch.window.long_points(filled, interval, &mut self.points);
        let mut long = self.view(round, false, &gates);
        let moves = long.orbit.radius >= gates.radius;
        // Repetition is costly and decides only where the lines have no direction.
        if moves && !gates.is_directed(&long.lines) {
            long.repetition = self.repetition();
        }
        let short_samples = if long.lines.pace > 0.0 {
            let window = self.settings.short_window_turns * TAU / long.lines.pace;
            ((window / interval) as usize).max(MIN_SHORT_SAMPLES)
        } else {
            filled
        };
        // A short window almost as long as the long one would add nothing.
        let short = (moves && short_samples < filled * 4 / 5).then(|| {
            let window = &self.watches[index].window;
            let round = window.round(short_samples);
            window.short_points(short_samples, interval, &mut self.points);
            self.view(round, true, &gates)
        });
        // A drive that turns backwards turns all directions around.
        let sense = if self.rotary_speed < 0.0 { -1.0 } else { 1.0 };
        let turning = |speed: f64| Some(speed.abs()).filter(|speed| *speed >= self.settings.min_rotary_speed);
        let rotation = Rotation {
            sense,
            // The mean over the same window as the orbit: during a change of
            // speed the present one would not fit the past orbit.
            speed: turning(self.mean_rotary_speed(long.duration)),
        };
        let verdict = judge(&long, short.as_ref(), &gates, &rotation);
        // The verdict may be of the short window, so the speed is taken again over that.
        let rotary_speed = turning(self.mean_rotary_speed(verdict.window));
        let evidence = Evidence {
            clearance_ratio: if clearance > 0.0 {
                touches.largest_distance / clearance
            } else {
                0.0
            },
            contact_duty: touches.contact_duty.min(1.0),
            peak_force: touches.peak_force,
            impulse: touches.impulse,
            impact_rate: touches.impact_rate,
            friction_power: touches.friction_power / watch_length,
            // A window that is not full yet lowers the confidence by its missing part.
            confidence: verdict.confidence * (filled as f64 / wanted as f64).min(1.0),
            ..Evidence::default()
        };
        let circumstances = Circumstances {
            rotary_speed,
            sense,
            chaos_time: CHAOS_PART * long_window,
            evaluation_interval: self.evaluation_interval(),
        };
        // Turns around the axis over those of the drive, also where the motion is no whirl.
        let turned = long.round.net * sense * TAU / long.duration.max(interval);
        self.watches[index].gap_turns = rotation.speed.map(|speed| turned / speed);
        self.watches[index].accept(&verdict, evidence, &circumstances, &self.settings);
    }

    /// Both estimators' results for the points.
    fn view(&mut self, round: Round, detrend: bool, gates: &Gates) -> View {
        let orbit = measure_and_stretch(&mut self.points, detrend, gates.radius, gates.axis_ratio);
        let lines = if orbit.radius < gates.radius {
            Lines::default()
        } else {
            self.spectrum.lines(&self.points.position, self.points.spacing)
        };
        let mut view = View {
            orbit,
            lines,
            round,
            turning: None,
            repetition: 0.0,
            duration: self.points.duration(),
        };
        if gates.is_directed(&lines) && !view.is_single_line() {
            view.turning = Some(turning(&self.points));
        }
        view
    }

    fn repetition(&self) -> f64 {
        let speed = self.mean_rotary_speed(self.points.duration()).abs();
        if speed < self.settings.min_rotary_speed {
            return 0.0;
        }
        let turn = TAU / speed / self.points.spacing;
        REPETITION_TURNS
            .map(|turns| repetition(&self.points.position, turns * turn))
            .into_iter()
            .fold(0.0, f64::max)
    }
}

/// See [`WhirlAnalysis::chaotic_share`].
fn chaotic_share(watches: &[StationWatch]) -> f64 {
    let pipes = watches.iter().filter(|watch| watch.station.body == Body::Pipe);
    let (stations, chaotic) = pipes.fold((0_u32, 0_u32), |(stations, chaotic), watch| {
        (stations + 1, chaotic + u32::from(watch.kind == WhirlKind::Chaotic))
    });
    f64::from(chaotic) / f64::from(stations.max(1))
}
