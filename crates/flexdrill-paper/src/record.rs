//! The record of a run for the figures: sampled series at every station, and sums over every step.

use flexdrill_core::dynamics::Energies;
use flexdrill_core::tool::{Body, Direction};
use flexdrill_core::twin::{Simulation, SolverCounters, StationGeometry};
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

/// One number per sample and station.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    stations: usize,
    values: Vec<f64>,
}

impl Series {
    /// Empty, for `stations` stations.
    pub fn new(stations: usize) -> Self {
        Self {
            stations,
            values: Vec::new(),
        }
    }

    /// Adds a sample.
    pub fn push(&mut self, row: impl Iterator<Item = f64>) {
        self.values.extend(row);
    }

    /// Samples taken.
    pub fn samples(&self) -> usize {
        self.values.len() / self.stations.max(1)
    }

    /// All stations at one sample.
    pub fn row(&self, sample: usize) -> &[f64] {
        &self.values[sample * self.stations..(sample + 1) * self.stations]
    }

    /// One station over time.
    pub fn at(&self, station: usize) -> impl ExactSizeIterator<Item = f64> + Clone {
        self.values.iter().skip(station).step_by(self.stations.max(1)).copied()
    }
}

/// Constant geometry of the stations.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Stations {
    /// Measured depth (m).
    pub depth: Vec<f64>,
    /// Inclination (rad).
    pub inclination: Vec<f64>,
    /// Whether the station has a joint.
    pub joint: Vec<bool>,
    /// Point on the bore's axis: horizontal, down (m).
    pub position: Vec<[f64; 2]>,
    /// Towards the low side: horizontal, down.
    pub low_side: Vec<[f64; 2]>,
    /// Lateral position of the undeflected pipe: y, z (m).
    pub offset: Vec<[f64; 2]>,
    /// Clearance between pipe and guide (m).
    pub inner_clearance: Vec<f64>,
    /// Clearance between guide and wall (m).
    pub outer_clearance: f64,
    /// Outer diameter of the pipe (m).
    pub pipe_diameter: Vec<f64>,
    /// Outer diameter of the guide (m).
    pub guide_diameter: f64,
}

impl Stations {
    /// Of a tool.
    pub fn of(simulation: &Simulation) -> Self {
        let all: Vec<StationGeometry> = simulation.stations().collect();
        let last = all.last();
        Self {
            depth: all.iter().map(|s| s.measured_depth).collect(),
            inclination: all.iter().map(|s| s.inclination).collect(),
            joint: all.iter().map(|s| s.joint.is_some()).collect(),
            position: all.iter().map(|s| [s.position[0], s.position[2]]).collect(),
            low_side: all.iter().map(|s| [s.low_side[0], s.low_side[2]]).collect(),
            offset: all.iter().map(|s| s.offset).collect(),
            inner_clearance: all.iter().map(|s| s.clearance[0]).collect(),
            // The guide is the same everywhere.
            outer_clearance: last.map_or(f64::NAN, |s| s.clearance[1]),
            pipe_diameter: all.iter().map(|s| s.diameter[0]).collect(),
            guide_diameter: last.map_or(f64::NAN, |s| s.diameter[1]),
        }
    }

    /// Number of stations.
    pub fn len(&self) -> usize {
        self.inclination.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.inclination.is_empty()
    }

    /// The station nearest to an inclination (deg).
    pub fn nearest(&self, inclination_deg: f64) -> usize {
        let wanted = deg_to_rad(inclination_deg);
        let distance = |s: &usize| (self.inclination[*s] - wanted).abs();
        (0..self.len())
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(0)
    }

    /// Inclination in degrees.
    pub fn degrees(&self, station: usize) -> f64 {
        rad_to_deg(self.inclination[station])
    }
}

/// Motion of one pipe in the bore, in the stations' frames: x down the hole, y horizontal, z towards the low side.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// Horizontal distance from the bore's axis (m).
    pub y: Series,
    /// Distance towards the low side (m).
    pub z: Series,
    /// Spin rate (rad/s).
    pub spin: Series,
    /// Acceleration along x, y, z (m/s2): the value of largest magnitude since the last sample.
    pub acceleration: [Series; 3],
    /// Mean square of the acceleration over all steps (m2/s4), per direction and station.
    pub acceleration_square: [Vec<f64>; 3],
}

/// Normal contact force of one layer of gaps.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Layer {
    /// Mean since the last sample (N).
    pub mean: Series,
    /// Largest since the last sample (N).
    pub peak: Series,
    /// Mean square over all steps (N2), per station.
    pub square: Vec<f64>,
    /// Part of all steps in contact, 0 to 1, per station.
    pub contact: Vec<f64>,
}

/// A recorded run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// Geometry of the stations.
    pub stations: Stations,
    /// Time between samples (s).
    pub interval: f64,
    /// Model time of the samples (s).
    pub time: Vec<f64>,
    /// Speed of the drive (rad/s).
    pub rotary_speed: f64,
    /// Flexible pipe, at a joint the end of the link above.
    pub pipe: Axis,
    /// Guide pipe.
    pub guide: Axis,
    /// Pipe in guide.
    pub inner: Layer,
    /// Guide in bore.
    pub outer: Layer,
    /// Torque of the drive (N m).
    pub drive_torque: Vec<f64>,
    /// Energy from the start of the run to its end.
    pub energy: Energies,
    /// Counters of the solver.
    pub solver: SolverCounters,
    /// Steps of the whole run.
    pub steps: u64,
}

impl Record {
    /// Duration (s).
    pub fn duration(&self) -> f64 {
        self.interval * self.time.len() as f64
    }

    /// One turn of the drive (s).
    pub fn turn(&self) -> f64 {
        std::f64::consts::TAU / self.rotary_speed.abs()
    }

    /// |error| of the energy audit over the drive's work.
    pub fn energy_error(&self) -> f64 {
        self.energy.error.abs() / self.energy.drive.abs().max(f64::MIN_POSITIVE)
    }
}

/// Collects a [`Record`] step by step.
pub struct Recorder {
    record: Record,
    per_sample: u64,
    steps: u64,
    inner: Sums,
    outer: Sums,
    pipe: [Vec<f64>; 3],
    guide: [Vec<f64>; 3],
}

/// Sums of one layer since the last sample.
struct Sums {
    sum: Vec<f64>,
    peak: Vec<f64>,
}

impl Recorder {
    /// For samples every `per_sample` steps of `time_step` (s) of a tool that the drive turns at `rotary_speed`
    /// (rad/s).
    pub fn new(simulation: &Simulation, rotary_speed: f64, time_step: f64, per_sample: u64) -> Self {
        let stations = Stations::of(simulation);
        let n = stations.len();
        let zeros = || vec![0.0; n];
        let three = || [zeros(), zeros(), zeros()];
        let axis = || Axis {
            y: Series::new(n),
            z: Series::new(n),
            spin: Series::new(n),
            acceleration: [Series::new(n), Series::new(n), Series::new(n)],
            acceleration_square: three(),
        };
        let layer = || Layer {
            mean: Series::new(n),
            peak: Series::new(n),
            square: zeros(),
            contact: zeros(),
        };
        let sums = || Sums {
            sum: zeros(),
            peak: zeros(),
        };
        Self {
            record: Record {
                stations,
                interval: time_step * per_sample as f64,
                rotary_speed,
                pipe: axis(),
                guide: axis(),
                inner: layer(),
                outer: layer(),
                ..Record::default()
            },
            per_sample,
            steps: 0,
            inner: sums(),
            outer: sums(),
            pipe: three(),
            guide: three(),
        }
    }

    /// Adds the state after a step.
    pub fn after_step(&mut self, simulation: &Simulation) {
        self.inner.add(&mut self.record.inner, simulation, Body::Pipe);
        self.outer.add(&mut self.record.outer, simulation, Body::Guide);
        for s in 0..self.record.stations.len() {
            let acceleration = |body| simulation.acceleration_in_bore(s, body).unwrap_or([f64::NAN; 3]);
            let (pipe, guide) = (acceleration(Body::Pipe), acceleration(Body::Guide));
            for k in 0..3 {
                extreme(&mut self.pipe[k][s], pipe[k]);
                extreme(&mut self.guide[k][s], guide[k]);
                self.record.pipe.acceleration_square[k][s] += pipe[k] * pipe[k];
                self.record.guide.acceleration_square[k][s] += guide[k] * guide[k];
            }
        }
        self.steps += 1;
        if self.steps.is_multiple_of(self.per_sample) {
            self.sample(simulation);
        }
    }

    fn sample(&mut self, simulation: &Simulation) {
        let record = &mut self.record;
        record.time.push(simulation.time());
        record.drive_torque.push(simulation.applied().drive_torque);
        let stations = 0..record.stations.len();
        let lateral = |body: Body, k: usize| {
            let at = move |s| simulation.lateral(s, body).map_or(f64::NAN, |lateral| lateral[k]);
            stations.clone().map(at)
        };
        record.pipe.y.push(lateral(Body::Pipe, 0));
        record.pipe.z.push(lateral(Body::Pipe, 1));
        record.guide.y.push(lateral(Body::Guide, 0));
        record.guide.z.push(lateral(Body::Guide, 1));
        let spin = |body: Body| {
            let at = move |s| simulation.velocity(s, body, Direction::Psi).unwrap_or(f64::NAN);
            stations.clone().map(at)
        };
        record.pipe.spin.push(spin(Body::Pipe));
        record.guide.spin.push(spin(Body::Guide));
        for (series, values) in record.pipe.acceleration.iter_mut().zip(&mut self.pipe) {
            series.push(values.iter_mut().map(std::mem::take));
        }
        for (series, values) in record.guide.acceleration.iter_mut().zip(&mut self.guide) {
            series.push(values.iter_mut().map(std::mem::take));
        }
        self.inner.sample(&mut record.inner, self.per_sample);
        self.outer.sample(&mut record.outer, self.per_sample);
    }

    /// The record, with energy and counters of the whole run.
    pub fn finish(mut self, simulation: &Simulation) -> Record {
        let share = 1.0 / self.steps.max(1) as f64;
        let scale = |values: &mut Vec<f64>| values.iter_mut().for_each(|value| *value *= share);
        for layer in [&mut self.record.inner, &mut self.record.outer] {
            scale(&mut layer.square);
            scale(&mut layer.contact);
        }
        for axis in [&mut self.record.pipe, &mut self.record.guide] {
            axis.acceleration_square.iter_mut().for_each(scale);
        }
        self.record.energy = *simulation.energy();
        self.record.solver = simulation.solver_counters();
        self.record.solver.last_iterations = 0;
        self.record.steps = simulation.step();
        self.record
    }
}

impl Sums {
    /// Adds the forces on `body` after a step.
    fn add(&mut self, layer: &mut Layer, simulation: &Simulation, body: Body) {
        for s in 0..self.sum.len() {
            if simulation.in_contact(s, body) != Some(true) {
                continue;
            }
            let normal = simulation.normal_force(s, body).unwrap_or(f64::NAN);
            self.sum[s] += normal;
            self.peak[s] = self.peak[s].max(normal);
            layer.square[s] += normal * normal;
            layer.contact[s] += 1.0;
        }
    }

    fn sample(&mut self, layer: &mut Layer, steps: u64) {
        let share = 1.0 / steps as f64;
        layer
            .mean
            .push(self.sum.iter_mut().map(|sum| std::mem::take(sum) * share));
        layer.peak.push(self.peak.iter_mut().map(std::mem::take));
    }
}

fn extreme(kept: &mut f64, value: f64) {
    if value.abs() > kept.abs() {
        *kept = value;
    }
}
