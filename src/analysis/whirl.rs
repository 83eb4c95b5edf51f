//! Whirl of every watched place, and the level of the whole tool.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::classify::{Verdict, View, judge};
use super::full_spectrum::FullSpectrum;
use super::orbit::measure_and_stretch;
use super::orbit_window::{OrbitWindow, Points};
use super::settings::WhirlSettings;
use super::severity::{Evidence, PlaceSeverity};
use super::{Severity, WhirlKind, WhirlReport, WhirlWarningLevel};
use crate::mechanics::Body;

/// Part of the long window that must be filled before anything is said.
const MIN_FILL: f64 = 0.5;

/// Part of the long window for which motion must look chaotic to be called so: a whirl that has just begun has no
/// direction either until it fills a good part of the window.
const CHAOS_PART: f64 = 0.25;

/// Fewest samples of a short window.
const MIN_SHORT_SAMPLES: usize = 32;

/// A place whose orbit is watched.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WatchedPlace {
    /// Station index from the top.
    pub station: usize,
    /// Which pipe moves: the flexible pipe in the guide, or the guide in the hole.
    pub body: Body,
    /// Along the path from the kick-off (m).
    pub measured_depth: f64,
    /// rad.
    pub inclination: f64,
    /// Half the difference of the diameters (m), Eq. 27 or 31.
    pub clearance: f64,
    /// Outer diameter of the moving body where it touches (m), for the rate of rolling without slip.
    pub body_diameter: f64,
}

impl WatchedPlace {
    /// Whirl rate over rotary speed of rolling without slip, `-d / (D - d)`. The guide is not driven, so its rate is not
    /// tied to the rotary speed.
    pub fn rolling_ratio(&self) -> Option<f64> {
        (self.body == Body::Pipe && self.clearance > 0.0).then(|| -self.body_diameter / (2.0 * self.clearance))
    }
}

/// One sample of one watched place.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PlaceSample {
    /// Horizontal displacement of the body from the gap's centre (m).
    pub y: f64,
    /// Displacement towards the low side (m).
    pub z: f64,
    /// Largest normal force since the sample before (N).
    pub normal_force: f64,
    /// Part of the time since the sample before in contact, 0 to 1; 0 or 1 where only the instant is known.
    pub contact_share: f64,
}

impl PlaceSample {
    fn between(&self, next: &Self, part: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * part;
        Self {
            y: mix(self.y, next.y),
            z: mix(self.z, next.z),
            normal_force: mix(self.normal_force, next.normal_force),
            contact_share: mix(self.contact_share, next.contact_share),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Place {
    place: WatchedPlace,
    window: OrbitWindow,
    last: PlaceSample,
    kind: WhirlKind,
    candidate: WhirlKind,
    agreeing: u32,
    whirl_rate: f64,
    whirl_ratio: f64,
    orbit_radius: f64,
    used_window: f64,
    evidence: Evidence,
    severity: PlaceSeverity,
}

/// Watches the orbits of many places. Everything is allocated by [`WhirlAnalysis::new`]; the same samples give the
/// same bits.
///
/// Frames: y is horizontal, z points to the low side, x down the hole, so a positive rotary speed turns y towards z.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WhirlAnalysis {
    settings: WhirlSettings,
    sample_interval: f64,
    places: Vec<Place>,
    /// Angle of the drive at the newest samples, to get its mean speed over any window.
    drive_angle: Vec<f64>,
    drive_next: usize,
    drive_filled: usize,
    rotary_speed: f64,
    last_time: Option<f64>,
    next_place: usize,
    /// Part of a place that is due, carried from sample to sample.
    due: f64,
    input_quality: f64,
    level: WhirlWarningLevel,
    #[serde(skip, default = "Points::new")]
    points: Points,
    #[serde(skip, default = "FullSpectrum::new")]
    spectrum: FullSpectrum,
}

impl WhirlAnalysis {
    /// For samples that are `sample_interval` (s) apart, 2 to 5 ms for a tool at 20 to 120 r/min.
    pub fn new(settings: &WhirlSettings, sample_interval: f64, places: Vec<WatchedPlace>) -> Self {
        let capacity = ((settings.max_window / sample_interval).ceil() as usize).max(MIN_SHORT_SAMPLES);
        let places = places
            .into_iter()
            .map(|place| Place {
                place,
                window: OrbitWindow::new(capacity),
                last: PlaceSample::default(),
                kind: WhirlKind::None,
                candidate: WhirlKind::None,
                agreeing: 0,
                whirl_rate: 0.0,
                whirl_ratio: 0.0,
                orbit_radius: 0.0,
                used_window: 0.0,
                evidence: Evidence::default(),
                severity: PlaceSeverity::default(),
            })
            .collect();
        Self {
            settings: *settings,
            sample_interval,
            places,
            drive_angle: vec![0.0; capacity + 1],
            drive_next: 0,
            drive_filled: 0,
            rotary_speed: 0.0,
            last_time: None,
            next_place: 0,
            due: 0.0,
            input_quality: 1.0,
            level: WhirlWarningLevel::default(),
            points: Points::new(),
            spectrum: FullSpectrum::new(),
        }
    }

    /// Takes one sample per watched place at model time `time` (s), with the rotary speed of the drive (rad/s).
    ///
    /// Samples are expected at the interval given to [`WhirlAnalysis::new`]. A short gap is bridged by straight lines;
    /// after a long one, or when time goes backwards, the windows start anew. A repeated time is ignored.
    pub fn push(&mut self, time: f64, rotary_speed: f64, samples: &[PlaceSample]) {
        let steps = self
            .last_time
            .map_or(1.0, |last| ((time - last) / self.sample_interval).round());
        if steps == 0.0 {
            return;
        }
        let longest = (self.settings.max_bridged_gap / self.sample_interval).max(1.0);
        if !(1.0..=longest).contains(&steps) {
            self.restart_windows();
        } else {
            let last_speed = self.rotary_speed;
            for step in 1..steps as usize {
                let part = step as f64 / steps;
                self.store(last_speed + (rotary_speed - last_speed) * part, samples, part);
            }
        }
        self.last_time = Some(time);
        self.store(rotary_speed, samples, 1.0);
        for (place, sample) in self.places.iter_mut().zip(samples) {
            place.last = *sample;
        }
        self.due += self.places.len() as f64 * self.sample_interval / self.settings.evaluation_interval;
        let mut evaluated = 0;
        while self.due >= 1.0 && evaluated < self.places.len() {
            self.due -= 1.0;
            evaluated += 1;
            self.evaluate(self.next_place, time);
            self.next_place = (self.next_place + 1) % self.places.len();
        }
        if evaluated > 0 {
            self.update_level(time);
        }
    }

    /// How far the inputs behind the motion can be trusted, 0 to 1; scales every confidence from the next evaluation
    /// on.
    pub fn set_input_quality(&mut self, quality: f64) {
        self.input_quality = quality.clamp(0.0, 1.0);
    }

    /// Replaces the thresholds and window lengths; the longest window keeps its memory, so it cannot grow.
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

    /// The places in the order of the samples.
    pub fn places(&self) -> impl ExactSizeIterator<Item = &WatchedPlace> {
        self.places.iter().map(|place| &place.place)
    }

    /// Fills `out`, one entry per place. Does not allocate once `out` has the right size.
    pub fn report(&self, out: &mut WhirlReport) {
        fn fill<T>(out: &mut Vec<T>, values: impl Iterator<Item = T>) {
            out.clear();
            out.extend(values);
        }
        let places = self.places.iter();
        fill(
            &mut out.measured_depth,
            places.clone().map(|at| at.place.measured_depth),
        );
        fill(&mut out.inclination, places.clone().map(|at| at.place.inclination));
        fill(&mut out.body, places.clone().map(|at| at.place.body));
        fill(&mut out.kind, places.clone().map(|at| at.kind));
        fill(&mut out.whirl_rate, places.clone().map(|at| at.whirl_rate));
        fill(&mut out.whirl_ratio, places.clone().map(|at| at.whirl_ratio));
        fill(&mut out.orbit_radius, places.clone().map(|at| at.orbit_radius));
        fill(
            &mut out.clearance_ratio,
            places.clone().map(|at| at.evidence.clearance_ratio),
        );
        fill(&mut out.contact_duty, places.clone().map(|at| at.evidence.contact_duty));
        fill(&mut out.confidence, places.clone().map(|at| at.evidence.confidence));
    }

    /// The level that the warning logic stands at.
    pub fn level(&self) -> WhirlWarningLevel {
        self.level
    }

    /// Ends the latch of CRITICAL everywhere.
    pub fn acknowledge(&mut self) {
        self.places.iter_mut().for_each(|place| place.severity.acknowledge());
    }

    /// Forgets everything but the settings; the warnings' sequence goes on, so that listeners see the change.
    pub fn reset(&mut self) {
        let sequence = self.level.sequence;
        self.restart_windows();
        for place in &mut self.places {
            place.evidence = Evidence::default();
            place.severity = PlaceSeverity::default();
        }
        self.last_time = None;
        let changed = u64::from(self.level.severity != Severity::Ok);
        self.level = WhirlWarningLevel {
            sequence: sequence + changed,
            ..WhirlWarningLevel::default()
        };
    }

    fn store(&mut self, rotary_speed: f64, samples: &[PlaceSample], part: f64) {
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
        for (place, sample) in self.places.iter_mut().zip(samples) {
            if part < 1.0 {
                let bridged = place.last.between(sample, part);
                place.window.push(&bridged);
            } else {
                place.window.push(sample);
            }
        }
    }

    fn restart_windows(&mut self) {
        self.drive_filled = 0;
        for place in &mut self.places {
            place.window.clear();
            place.kind = WhirlKind::None;
            place.candidate = WhirlKind::None;
            place.agreeing = 0;
            place.whirl_rate = 0.0;
            place.whirl_ratio = 0.0;
            place.orbit_radius = 0.0;
            place.evidence.kind = WhirlKind::None;
            place.evidence.confidence = 0.0;
        }
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

    fn evaluate(&mut self, index: usize, time: f64) {
        let wanted = (self.long_window() / self.sample_interval).round() as usize;
        let filled = self.places[index].window.filled().min(wanted);
        if (filled as f64) < MIN_FILL * wanted as f64 {
            self.judge_severity(index, time);
            return;
        }
        let long = self.view(index, filled, false);
        let (reach, peak_force, contact_duty) = (self.points.reach, self.points.peak_force, self.points.contact_duty);
        let pace = long.lines.pace;
        let short_samples = if pace > 0.0 {
            let window = self.settings.short_window_turns * TAU / pace;
            ((window / self.sample_interval) as usize).max(MIN_SHORT_SAMPLES)
        } else {
            filled
        };
        // A short window almost as long as the long one would say the same again.
        let short = (short_samples < filled * 4 / 5).then(|| self.view(index, short_samples, true));
        let sense = if self.rotary_speed < 0.0 { -1.0 } else { 1.0 };
        let place = &self.places[index];
        let clearance = place.place.clearance;
        let verdict = judge(&long, short.as_ref(), clearance, sense, place.kind, &self.settings);
        let rotary_speed = self.mean_rotary_speed(verdict.window);
        let fill = filled as f64 / wanted as f64;
        let confidence = verdict.confidence * fill.min(1.0) * self.input_quality;
        let evidence = Evidence {
            clearance_ratio: if clearance > 0.0 { reach / clearance } else { 0.0 },
            contact_duty,
            peak_force,
            confidence,
            ..place.evidence
        };
        let turns = rotary_speed.abs() >= self.settings.min_rotary_speed;
        self.accept(
            index,
            &verdict,
            evidence,
            if turns { Some(rotary_speed) } else { None },
            sense,
        );
        self.judge_severity(index, time);
    }

    fn view(&mut self, index: usize, samples: usize, detrend: bool) -> View {
        self.places[index]
            .window
            .points(samples, self.sample_interval, &mut self.points);
        let orbit = measure_and_stretch(&mut self.points, detrend, self.settings.min_axis_ratio);
        let lines = self.spectrum.lines(&self.points.position, self.points.spacing);
        View {
            orbit,
            lines,
            duration: self.points.position.len() as f64 * self.points.spacing,
        }
    }

    /// Takes over a verdict; its kind only when enough evaluations in a row agree.
    fn accept(&mut self, index: usize, verdict: &Verdict, evidence: Evidence, speed: Option<f64>, sense: f64) {
        let confirmations = self.settings.confirmations;
        let chaos_evaluations = (CHAOS_PART * self.long_window() / self.settings.evaluation_interval) as u32;
        let tolerance = self.settings.rolling_tolerance;
        let place = &mut self.places[index];
        if verdict.kind == place.candidate {
            place.agreeing = place.agreeing.saturating_add(1);
        } else {
            place.candidate = verdict.kind;
            place.agreeing = 1;
        }
        let needed = match verdict.kind {
            WhirlKind::Chaotic => confirmations.max(chaos_evaluations),
            _ => confirmations,
        };
        if place.agreeing >= needed {
            place.kind = verdict.kind;
        }
        let rate = if place.kind == verdict.kind {
            verdict.rate * sense
        } else {
            place.whirl_rate
        };
        place.whirl_rate = rate;
        place.whirl_ratio = speed.map_or(0.0, |speed| rate / speed.abs());
        place.orbit_radius = verdict.radius;
        place.used_window = verdict.window;
        place.evidence = Evidence {
            kind: place.kind,
            // While the kind is in dispute the doubt shows.
            confidence: if place.kind == verdict.kind {
                evidence.confidence
            } else {
                0.5 * evidence.confidence
            },
            rolling: place.kind == WhirlKind::Backward
                && place
                    .place
                    .rolling_ratio()
                    .is_some_and(|rolling| (place.whirl_ratio - rolling).abs() <= tolerance * rolling.abs()),
            ..evidence
        };
    }

    fn judge_severity(&mut self, index: usize, time: f64) {
        let elapsed = self.settings.evaluation_interval;
        let place = &mut self.places[index];
        place.severity.update(time, elapsed, &place.evidence, &self.settings);
    }

    /// The worst place leads; it keeps the lead against others of the same level, so that the warning does not jump.
    fn update_level(&mut self, time: f64) {
        let worst = self
            .places
            .iter()
            .map(|place| place.severity.level)
            .max()
            .unwrap_or_default();
        let entry = if worst == Severity::Ok {
            0
        } else if self
            .places
            .get(self.level.entry)
            .is_some_and(|place| place.severity.level == worst)
        {
            self.level.entry
        } else {
            let mut leader = 0;
            let mut force = f64::NEG_INFINITY;
            for (index, place) in self.places.iter().enumerate() {
                if place.severity.level == worst && place.evidence.peak_force > force {
                    (leader, force) = (index, place.evidence.peak_force);
                }
            }
            leader
        };
        let Some(place) = self.places.get(entry) else { return };
        let kind = match (worst, place.kind) {
            (Severity::Ok, _) => WhirlKind::None,
            // Held or latched: the kind that led here still names the warning.
            (_, WhirlKind::None) => self.level.kind,
            (_, kind) => kind,
        };
        let severity_changed = worst != self.level.severity;
        let changed = severity_changed || kind != self.level.kind || entry != self.level.entry;
        self.level = WhirlWarningLevel {
            severity: worst,
            kind,
            entry,
            whirl_ratio: place.whirl_ratio,
            clearance_ratio: place.evidence.clearance_ratio,
            contact_duty: place.evidence.contact_duty,
            window: place.used_window,
            since: if severity_changed { time } else { self.level.since },
            sequence: self.level.sequence + u64::from(changed),
        };
    }
}
