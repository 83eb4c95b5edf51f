//! Observation of the mechanics: statistics updated at every step, and the snapshot made from them and the state.

mod hazards;
mod output;
mod steering;
mod step;

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use self::steering::SteeringMeans;
use crate::dynamics::state::{State, inner_lateral};
use crate::model::Model;
use crate::step::Stepper;
use crate::tool::Body;
use crate::twin::quality::{ModelQuality, QualityWatch};
use crate::twin::schedule::EndsInterval;
use crate::twin::settings::SimulationSettings;
use flexdrill_motion::{
    AgeingWatch, ChaoticWhirlWatch, ContactStatistics, JointLoadWatch, LoadWatch, Means, RootMeanSquare, ShockWatch,
    StationSample, StickSlip, StickSlipSettings, TransferWatch, WatchedStation, WhirlAnalysis, WhirlSettings,
};

/// Statistics between outputs, and the analysis.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Observer {
    inner: ContactStatistics,
    outer: ContactStatistics,
    tangential: RootMeanSquare,
    axial: RootMeanSquare,
    lateral: RootMeanSquare,
    stick_slip: StickSlip,
    shock: ShockWatch,
    joint_load: JointLoadWatch,
    chaotic_whirl: ChaoticWhirlWatch,
    transfer: TransferWatch,
    /// Depth of the hole (m), with a hoist: the deepest that the bit has come.
    hole_depth: Option<f64>,
    /// Of the bit's torque (N m), speed (rad/s) and weight (N).
    bit: Means,
    /// Of what the bit does across the hole.
    steering: SteeringMeans,
    /// Of a preloaded guide with a rating.
    guide_preload: Option<LoadWatch>,
    /// Of a pipe under pressure with a rating.
    pressure_folding: Option<LoadWatch>,
    ageing: AgeingWatch,
    whirl: WhirlAnalysis,
    quality: QualityWatch,
    input_trust: f64,
    watched: Vec<(usize, Body)>,
    samples: Vec<StationSample>,
    /// Steps between samples of the whirl analysis.
    decimation: u64,
    last_iterations: u32,
}

impl Observer {
    pub(super) fn new(stepper: &Stepper, settings: &SimulationSettings) -> Self {
        let model = stepper.model();
        // By default pipe and guide at all joints are watched, the stations that every tool has.
        let watched: Vec<(usize, Body)> = if settings.watched.is_empty() {
            model
                .joint_stations
                .iter()
                .flat_map(|&s| [(s, Body::Pipe), (s, Body::Guide)])
                .collect()
        } else {
            settings.watched.clone()
        };
        // The whirl analysis takes every so many steps a sample, as a motion of a few hertz needs no more.
        let decimation = settings.whirl_sample_steps();
        let described = watched
            .iter()
            .map(|&(station, body)| watched_station(model, station, body))
            .collect();
        let stations = model.stations.len();
        Self {
            inner: ContactStatistics::new(stations),
            outer: ContactStatistics::new(stations),
            tangential: RootMeanSquare::default(),
            axial: RootMeanSquare::default(),
            lateral: RootMeanSquare::default(),
            // The windows of stick-slip must be longer than a swing of the string, which its length decides.
            stick_slip: StickSlip::new(for_string(settings.stick_slip, stepper)),
            shock: ShockWatch::new(&settings.shock, stations),
            joint_load: JointLoadWatch::new(&settings.joint_load, model.joints.len()),
            chaotic_whirl: ChaoticWhirlWatch::new(
                &settings.chaotic_whirl,
                model.stations[model.last()].depth,
                stations,
            ),
            transfer: TransferWatch::new(&settings.transfer, hoist_response(stepper)),
            hole_depth: stepper.bit_depth(),
            bit: Means::default(),
            steering: SteeringMeans::default(),
            // A guide as curved as the hole has no preload, whatever the settings say.
            guide_preload: (settings.guide_preload.filter(|_| stepper.guide_is_bent()))
                .map(|load| LoadWatch::new(&load, model.guide.len())),
            pressure_folding: (settings.pressure_folding.filter(|_| stepper.pipe_is_pushed().is_some()))
                .map(|load| LoadWatch::new(&load, model.pipe.len())),
            ageing: AgeingWatch::new(&settings.ageing, model.joints.len(), stations),
            whirl: WhirlAnalysis::new(&settings.whirl, decimation as f64 * settings.time_step, described),
            // The choice of the step is bounded by what the chain can be refined to.
            quality: QualityWatch::new(settings.step, stepper.finest_refinement()),
            input_trust: 1.0,
            // One sample per watched station is reused, since nothing may allocate in a step.
            samples: vec![StationSample::default(); watched.len()],
            watched,
            decimation,
            last_iterations: 0,
        }
    }

    /// Whether both watch the same stations.
    #[cfg(feature = "checkpoints")]
    pub(super) fn fits(&self, other: &Self) -> bool {
        self.watched == other.watched && self.decimation == other.decimation
    }

    pub(super) fn last_iterations(&self) -> u32 {
        self.last_iterations
    }

    pub(super) fn set_whirl(&mut self, settings: &WhirlSettings) {
        self.whirl.set_settings(settings);
    }

    /// Trust in the inputs, 0 to 1.
    pub(super) fn set_input_trust(&mut self, trust: f64) {
        self.input_trust = trust;
        self.update_trust();
    }

    /// Doubtful inputs and doubtful mechanics both lower the confidence of the whirl analysis.
    fn update_trust(&mut self) {
        self.whirl
            .set_input_trust(self.input_trust * self.quality.quality().level.trust());
    }

    /// Steps have 2^`refinement` parts from now on.
    pub(super) fn set_refinement(&mut self, refinement: u32) {
        self.quality.set_refinement(refinement);
    }

    /// Quality of the computed motion.
    pub(super) fn quality(&self) -> ModelQuality {
        self.quality.quality()
    }

    /// Numbers the next warning after the last one of `before`, so that no number is used twice after a restore.
    #[cfg(feature = "checkpoints")]
    pub(super) fn continue_sequence_of(&mut self, before: &Self) {
        self.whirl.continue_sequence(before.whirl.level().sequence);
    }

    /// Begins anew with the tool at its start.
    pub(super) fn reset(&mut self, stepper: &Stepper) {
        self.end_interval(EndsInterval::ALL);
        self.stick_slip.reset();
        self.shock.reset();
        self.joint_load.reset();
        self.chaotic_whirl.reset();
        self.transfer.reset();
        self.hole_depth = stepper.bit_depth();
        self.steering = SteeringMeans::default();
        let loads = [&mut self.guide_preload, &mut self.pressure_folding];
        loads.into_iter().flatten().for_each(LoadWatch::reset);
        self.ageing.reset();
        self.whirl.reset();
        self.quality.reset();
        self.update_trust();
        self.samples.fill(StationSample::default());
        self.last_iterations = 0;
    }

    /// Forms anew what is not saved.
    #[cfg(feature = "checkpoints")]
    pub(super) fn refresh(&mut self) {
        self.transfer.refresh();
    }

    pub(super) fn end_interval(&mut self, of: EndsInterval) {
        if of.contacts {
            self.inner.restart();
            self.outer.restart();
            self.shock.restart();
        }
        if of.bit {
            self.bit.restart();
            self.tangential.restart();
            self.axial.restart();
            self.lateral.restart();
        }
        if of.steering {
            self.steering.restart();
        }
    }
}

/// Response time (s) of the hoist; 0 without one.
fn hoist_response(stepper: &Stepper) -> f64 {
    stepper.carrier().map_or(0.0, |carrier| carrier.response_time)
}

/// The settings with a window that holds two periods of the torsional swing of the string above, 4 L / c each: the window of
/// the configuration does up to 4000 m.
fn for_string(mut settings: StickSlipSettings, stepper: &Stepper) -> StickSlipSettings {
    let period = stepper.load_above().map_or(0.0, |above| 4.0 * above.delay);
    settings.window = settings.window.max(2.0 * period);
    settings
}

fn watched_station(model: &Model, station: usize, body: Body) -> WatchedStation {
    let at = &model.stations[station];
    let (clearance, body_diameter) = match body {
        Body::Pipe => (at.inner_clearance, 2.0 * at.pipe_radius),
        Body::Guide => (model.outer_clearance, 2.0 * model.guide_radii[1]),
    };
    WatchedStation {
        station,
        body,
        measured_depth: at.depth,
        inclination: at.inclination,
        clearance,
        body_diameter,
        length: tributary_length(model, station),
    }
}

/// Half of the distances to both neighbours (m).
fn tributary_length(model: &Model, station: usize) -> f64 {
    let depth = |station: usize| model.stations[station].depth;
    0.5 * (depth((station + 1).min(model.last())) - depth(station.saturating_sub(1)))
}

/// Lateral position (y, z) of a body in its gap (m): the pipe in the guide, the guide in the hole.
fn gap_lateral(model: &Model, state: &State, station: usize, body: Body) -> Vector2<f64> {
    let at = &model.stations[station];
    match body {
        Body::Pipe => inner_lateral(at, state),
        Body::Guide => Vector2::new(state.q[at.guide + 1], state.q[at.guide + 2]),
    }
}
