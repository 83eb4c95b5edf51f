//! Observation of the mechanics: statistics updated at every step, and the snapshot made from them and the state.

use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use super::fill::{fill_joints, fill_layer, fill_reactions, new_reactions};
use super::quality::{ModelQuality, QualityWatch};
use super::settings::SimulationSettings;
use super::snapshot::{Applied, Bit, ContactLayer, Contacts, Joints, Shape, Snapshot};
use crate::dynamics::state::{State, inner_lateral, translation};
use crate::dynamics::stepper::Stepper;
use crate::elements::gap::gap;
use crate::model::Model;
use crate::motion::{
    AgeingWatch, ChaoticWhirlWatch, ContactStatistics, DriveState, Hazard, HazardKind, Hazards, JointLoadWatch,
    RootMeanSquare, ShockWatch, StationSample, StickSlip, ToolLocation, WatchedStation, WhirlAnalysis, WhirlSettings,
    ended,
};
use crate::tool::{Body, Direction};

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
        let watched: Vec<(usize, Body)> = if settings.watched.is_empty() {
            model
                .joint_stations
                .iter()
                .flat_map(|&s| [(s, Body::Pipe), (s, Body::Guide)])
                .collect()
        } else {
            settings.watched.clone()
        };
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
            stick_slip: StickSlip::new(settings.stick_slip),
            shock: ShockWatch::new(&settings.shock, stations),
            joint_load: JointLoadWatch::new(&settings.joint_load, model.joints.len()),
            chaotic_whirl: ChaoticWhirlWatch::new(
                &settings.chaotic_whirl,
                model.stations[model.last()].depth,
                stations,
            ),
            ageing: AgeingWatch::new(&settings.ageing, model.joints.len(), stations),
            whirl: WhirlAnalysis::new(&settings.whirl, decimation as f64 * settings.time_step, described),
            quality: QualityWatch::new(settings.step, stepper.finest_refinement()),
            input_trust: 1.0,
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

    pub(super) fn reset(&mut self) {
        self.end_interval();
        self.stick_slip.reset();
        self.shock.reset();
        self.joint_load.reset();
        self.chaotic_whirl.reset();
        self.ageing.reset();
        self.whirl.reset();
        self.quality.reset();
        self.update_trust();
        self.samples.fill(StationSample::default());
        self.last_iterations = 0;
    }

    pub(super) fn end_interval(&mut self) {
        self.inner.restart();
        self.outer.restart();
        self.tangential.restart();
        self.axial.restart();
        self.lateral.restart();
        self.shock.restart();
    }

    pub(super) fn after_step(&mut self, stepper: &mut Stepper, applied: &Applied, step: u64, dt: f64, iterations: u32) {
        self.last_iterations = iterations;
        if self.quality.push(dt, stepper.audit()) {
            self.update_trust();
        }
        let (model, forces) = (stepper.model(), stepper.interactions());
        for (layer, (touches, statistics)) in [(&forces.inner, &mut self.inner), (&forces.outer, &mut self.outer)]
            .into_iter()
            .enumerate()
        {
            for (station, touch) in touches.iter() {
                statistics.touch(station, dt, touch.normal);
                self.shock.push(layer, station, dt, touch.normal);
                if layer == 0 {
                    self.chaotic_whirl.push(station, touch.dissipation * dt);
                }
                self.ageing.rub(layer, station, touch.friction_power * dt);
            }
            statistics.advance(dt);
        }
        let (time, judged) = (step as f64 * dt, self.whirl.drive() == DriveState::Turning);
        self.shock.advance(time, dt, judged);
        for (joint, stop) in forces.joints.stops().enumerate() {
            self.joint_load.push(joint, dt, stop.moment);
            self.ageing.stop(joint, dt, stop.moment);
        }
        self.joint_load.advance(time, dt, judged);
        let (taken, share) = (stepper.audit().contact_damping, self.whirl.chaotic_share());
        self.chaotic_whirl.advance(time, dt, taken, share, judged);

        let bottom = stepper.bottom_motion();
        let radius = 0.5 * model.description.bit.diameter;
        self.tangential.push(dt, radius * bottom.spin_acceleration);
        self.axial.push(dt, bottom.axial_acceleration);
        self.lateral.push_square(dt, bottom.lateral_square);
        self.stick_slip
            .push(time, dt, bottom.spin_rate, applied.rotary_speed, judged);

        let share = 1.0 / self.decimation as f64;
        for (sample, &(station, body)) in self.samples.iter_mut().zip(&self.watched) {
            let touch = match body {
                Body::Pipe => forces.inner.get(station),
                Body::Guide => forces.outer.get(station),
            };
            if let Some(touch) = touch {
                sample.normal_force = sample.normal_force.max(touch.normal);
                sample.contact_share += share;
                sample.impulse += touch.normal * dt;
                sample.friction_work += touch.friction_power * dt;
            }
        }
        if step.is_multiple_of(self.decimation) {
            stepper.refresh_view();
            let (model, state) = (stepper.model(), stepper.view());
            for (sample, &(station, body)) in self.samples.iter_mut().zip(&self.watched) {
                let lateral = gap_lateral(model, state, station, body);
                (sample.y, sample.z) = (lateral.x, lateral.y);
                sample.contact_share = sample.contact_share.min(1.0);
            }
            self.whirl.push(time, applied.rotary_speed, &self.samples);
            self.samples.fill(StationSample::default());
            self.ageing
                .sample(self.decimation as f64 * dt, |joint| bending_below(model, state, joint));
        }
    }

    /// A snapshot with all arrays at their size.
    pub(super) fn new_snapshot(&self, model: &Model) -> Snapshot {
        let joints = || vec![0.0; model.joints.len()];
        let stations = || vec![0.0; model.stations.len()];
        let layer = || ContactLayer {
            gap: stations(),
            normal: stations(),
            tangential: stations(),
            axial: stations(),
            normal_peak: stations(),
            normal_rms: stations(),
            shock: stations(),
        };
        let mut out = Snapshot {
            joints: Joints {
                measured_depth: model.joint_stations.iter().map(|&s| model.stations[s].depth).collect(),
                inclination: model
                    .joint_stations
                    .iter()
                    .map(|&s| model.stations[s].inclination)
                    .collect(),
                bend_angle: joints(),
                bend_direction: joints(),
                limit_angle: model.joints.iter().map(|joint| joint.law.limit).collect(),
                stop_moment: joints(),
                lateral_y: joints(),
                lateral_z: joints(),
                spin_rate: joints(),
                axial_force: joints(),
                shear_force: joints(),
                torque: joints(),
            },
            contacts: Contacts {
                measured_depth: model.stations.iter().map(|s| s.depth).collect(),
                inclination: model.stations.iter().map(|s| s.inclination).collect(),
                state: vec![0; model.stations.len()],
                pipe_guide: layer(),
                guide_wall: layer(),
            },
            shape: Shape {
                bore: model.stations.iter().map(|s| s.position.into()).collect(),
                low_side: model
                    .stations
                    .iter()
                    .map(|s| s.frame.column(2).into_owned().into())
                    .collect(),
                pipe: vec![[0.0; 2]; model.stations.len()],
                guide: vec![[0.0; 2]; model.stations.len()],
            },
            reactions: new_reactions(model),
            ..Snapshot::default()
        };
        self.whirl.report(&mut out.whirl);
        self.ageing.write(&mut out.ageing);
        out
    }

    /// Fills a snapshot from the state and the statistics; the contacts' states are those of Table 2.
    pub(super) fn fill(&self, stepper: &Stepper, state: &State, applied: &Applied, out: &mut Snapshot) {
        let (model, forces) = (stepper.model(), stepper.interactions());
        fill_joints(model, state, forces, &mut out.joints);
        let contacts = &mut out.contacts;
        fill_layer(&mut contacts.pipe_guide, &forces.inner, &self.inner, |s| {
            let station = &model.stations[s];
            gap(inner_lateral(station, state), station.inner_clearance)
        });
        fill_layer(&mut contacts.guide_wall, &forces.outer, &self.outer, |s| {
            gap(gap_lateral(model, state, s, Body::Guide), model.outer_clearance)
        });
        self.shock.write(0, &mut contacts.pipe_guide.shock);
        self.shock.write(1, &mut contacts.guide_wall.shock);
        out.shock = self.shock.level();
        for (s, station) in model.stations.iter().enumerate() {
            contacts.state[s] = u8::from(forces.inner.get(s).is_some()) + 2 * u8::from(forces.outer.get(s).is_some());
            let guide = translation(&state.q, station.guide);
            let pipe = station.pipe_to_station * translation(&state.q, station.pipe_above);
            out.shape.pipe[s] = [station.offset.x + pipe.y, station.offset.y + pipe.z];
            out.shape.guide[s] = [guide.y, guide.z];
        }
        let bottom = &model.stations[model.last()];
        out.bit = Bit {
            torque: forces.bit.torque,
            rotary_speed: state.v[bottom.pipe_above + Direction::Psi as usize],
            weight_on_bit: applied.weight_on_bit,
            stick_slip_index: self.stick_slip.index(),
            tangential_acceleration: self.tangential.value(),
            axial_acceleration: self.axial.value(),
            lateral_acceleration: self.lateral.value(),
            lateral_acceleration_peak: self.lateral.peak(),
            lateral_impulse: self.lateral.impulse(),
            stick_slip: self.stick_slip.severity(),
        };
        fill_reactions(stepper, &mut out.reactions);
        self.whirl.report(&mut out.whirl);
        out.warning = self.whirl.level();
        out.hazards = self.hazards(model, out.time);
        self.ageing.write(&mut out.ageing);
        out.quality = self.quality();
    }

    /// Every hazard at model time `time` (s), with its worst location.
    fn hazards(&self, model: &Model, time: f64) -> Hazards {
        let place = |station: usize, body: Body| {
            model.stations.get(station).map(|at| ToolLocation {
                station,
                body,
                measured_depth: at.depth,
                inclination: at.inclination,
            })
        };
        let (shock, chaotic) = (self.shock.level(), self.chaotic_whirl.level());
        let (joint_load, joint_settings) = (self.joint_load.level(), self.joint_load.settings());
        let list = HazardKind::ALL.map(|kind| match kind {
            HazardKind::BackwardWhirl => self.whirl.backward(),
            HazardKind::ForwardWhirl => self.whirl.forward(),
            HazardKind::Shock => Hazard {
                severity: shock.severity,
                place: place(shock.station, if shock.layer == 0 { Body::Pipe } else { Body::Guide }),
                value: shock.impulse,
                threshold: self.shock.settings().thresholds.of(shock.severity),
                impulse: shock.impulse,
                since: shock.since,
                seen: shock.seen,
                ended: shock.ended,
                ..Hazard::calm(kind)
            },
            HazardKind::StickSlip => {
                let (severity, (worst, seen)) = (self.stick_slip.severity(), self.stick_slip.worst());
                Hazard {
                    severity,
                    value: worst,
                    threshold: self.stick_slip.settings().thresholds.of(severity),
                    since: self.stick_slip.since(),
                    seen,
                    ended: ended(severity, self.stick_slip.met(), time),
                    ..Hazard::calm(kind)
                }
            }
            HazardKind::JointLoad => Hazard {
                severity: joint_load.severity,
                place: model
                    .joint_stations
                    .get(joint_load.joint)
                    .and_then(|&station| place(station, Body::Pipe)),
                value: joint_load.ratio,
                threshold: joint_settings.thresholds.of(joint_load.severity),
                since: joint_load.since,
                seen: joint_load.seen,
                ended: joint_load.ended,
                ..Hazard::calm(kind)
            },
            HazardKind::ChaoticWhirl => Hazard {
                severity: chaotic.severity,
                place: place(chaotic.station, Body::Pipe),
                value: chaotic.power,
                threshold: self.chaotic_whirl.settings().thresholds.of(chaotic.severity),
                since: chaotic.since,
                seen: chaotic.seen,
                ended: chaotic.ended,
                ..Hazard::calm(kind)
            },
        });
        Hazards {
            list,
            drive: self.whirl.drive(),
        }
    }
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

/// Bending moment (N m) in the middle of the link below a joint, from its curvature, about two transverse axes that
/// turn with the pipe: the load history of a material point.
fn bending_below(model: &Model, state: &State, joint: usize) -> [f64; 2] {
    let per_link = model.description.elements_per_link;
    let upper = model.joint_stations[joint] + (per_link - 1) / 2;
    let beam = &model.pipe[upper].beam;
    let (from, to) = (model.stations[upper].pipe_below, model.stations[upper + 1].pipe_above);
    let per_curvature = beam.section.bending / beam.length;
    let about = |direction: Direction| {
        let direction = direction as usize;
        per_curvature * (state.q[to + direction] - state.q[from + direction])
    };
    let (about_y, about_z) = (about(Direction::PhiY), about(Direction::PhiZ));
    let (sin, cos) = libm::sincos(state.q[from + Direction::Psi as usize]);
    [about_y * cos + about_z * sin, about_z * cos - about_y * sin]
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
