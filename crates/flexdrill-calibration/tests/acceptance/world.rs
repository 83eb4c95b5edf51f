//! The truth of the logs: a soft string on a bit of Detournay and Defourny, both in closed form.
//!
//! What a log has, as real sensors do:
//! - a weight indicator, whose factor lies within 5 % and whose tare within 5 kN, 90 % of the time; the hook load, which the
//!   weight is derived from, has the same factor;
//! - torque of the top drive: white noise of 15 N m (4 % of 350 N m) at 1 Hz, a drift of 5 N m per root of an hour, and an
//!   offset that 90 % of the time is within 50 N m;
//! - hook load: 2 kN, 1 kN per root of an hour, an offset within 20 kN;
//! - torque and weight above the bit, where there is such a tool: 10 N m and 400 N, no drift: they are tared downhole;
//! - the rate of penetration: 1.8 m/h from second to second, as of a block that is read to 5 mm over ten seconds, and a rock
//!   that differs by 15 % from what is configured, a half of that variance from part to part of the log.

use flexdrill_calibration::fit::{Outcome, Problem, observations};
use flexdrill_calibration::sensor::Sensor;
use flexdrill_calibration::smoother::SmootherSettings;
use flexdrill_calibration::study;
use flexdrill_calibration::study::point::{Figures, Load};
use flexdrill_calibration::study::points::{Cover, design};
use flexdrill_calibration::study::unknowns::Unknowns;
use flexdrill_calibration::study::unknowns::sensors::{Of, Part};
use flexdrill_calibration::surrogate::usual_points;
use flexdrill_calibration::windows::{Activity, Channel, Sample, WindowSettings, Windows, find};
use flexdrill_config::Config;
use flexdrill_core::tool::SectionProperties;

/// Radius of the arc (m), and of the bit.
const ARC: f64 = 3.2;
const BIT: f64 = 0.059;
/// Hook load of the tool that hangs (N).
const HANGING: f64 = 130e3;
/// Deviation of the rock from part to part. With that of the whole log it is 15 %.
const ROCK: f64 = 0.106;

/// Members of the smoother, half of the usual number: a posterior's deviation is known to 3 % (1 / sqrt(2 N)).
const MEMBERS: usize = 500;

pub struct World {
    pub config: Config,
    pub unknowns: Unknowns,
    /// Of every channel.
    pub problem: Problem,
}

/// A tool in a right angle of 3.2 m, and 20 m of level hole after it where `level`. The weight at the bit is what the
/// wall's friction leaves of that at the surface, as `flexdrill verify --only capstan_intervals` holds the twin to.
pub fn world(level: bool) -> World {
    let text = include_str!("../../../../tests/data/short_rig.yaml")
        .replace("radius: 1.2, build_angle_deg: 60", "radius: 3.2, build_angle_deg: 90")
        .replace("limit_deg: 13.0", "limit_deg: 13.0, friction: 0.1")
        .replace("links: 6", "links: 33");
    let arc = Config::from_text("arc.yaml", &text).unwrap();
    let config = if level { arc.with_links(165).unwrap() } else { arc };
    let unknowns = Unknowns::of(&config).unwrap();
    let rpm = |rpm: f64| rpm * std::f64::consts::TAU / 60.0;
    let mut points = Vec::new();
    for (motion, shown, loads) in [(Activity::OffBottom, [0.0; 2], 1), (Activity::Drilling, [7e3, 20e3], 2)] {
        let weight = match motion {
            Activity::OffBottom => shown,
            Activity::Drilling => unknowns.acting_range(shown).map(|weight| weight.max(1e3)),
        };
        let cover = Cover {
            motion,
            rotary_speed: [rpm(35.0), rpm(65.0)],
            weight,
            points: usual_points(unknowns.acting(motion).len() + loads),
        };
        points.extend(design(&unknowns, &cover, 1));
    }
    for point in &mut points {
        let truth = Truth::of(&config, &unknowns, &point.z);
        point.found = Some(Ok(truth.figures(&point.load)));
    }
    let problem = study::problem(&config, &unknowns, &everywhere(), &points).unwrap();
    World {
        config,
        unknowns,
        problem,
    }
}

/// Values of a soft string and its bit.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    inside: f64,
    arc: f64,
    after: f64,
    joints: f64,
    pub bit: f64,
    pub inclination: f64,
    /// N.
    pub flats: f64,
    /// Pa.
    energy: f64,
    /// Weight per length of guide, and of guide and pipe (N/m).
    guide: f64,
    whole: f64,
    /// Length after the arc (m).
    level: f64,
    /// Another law of friction: share that the friction along the wall falls by from 50 to 70 r/min. 0 for the twin's.
    pub falls: f64,
}

impl Truth {
    /// With standardised unknowns.
    pub fn of(config: &Config, unknowns: &Unknowns, z: &[f64]) -> Self {
        let value = |name: &str| {
            let mut all = unknowns.modelled.iter().zip(z);
            let found = all.find(|(modelled, _)| modelled.unknown.name == name);
            found.map(|(modelled, z)| modelled.unknown.value(*z))
        };
        let tool = config.tool();
        let weight = |tube| tool.gravity * SectionProperties::of(tube, tool.material, 1.0).mass;
        let guide = weight(tool.guide_section);
        let wall = value("friction of guide on wall").or(value("friction of guide on wall in the arc"));
        Self {
            inside: value("friction of pipe in guide").unwrap(),
            arc: wall.unwrap(),
            after: value("friction of guide on wall after the arc").unwrap_or(0.0),
            joints: value("friction in the joints").unwrap(),
            bit: value("friction of the bit on the rock").unwrap(),
            inclination: value("inclination of the cutters").unwrap(),
            flats: value("force that the wear flats carry").unwrap(),
            energy: value("specific energy of the rock").unwrap(),
            guide,
            whole: guide + weight(tool.pipe_sections[0]),
            level: config.well.length() - ARC * std::f64::consts::FRAC_PI_2,
            falls: 0.0,
        }
    }

    /// The figures of a load. Torques along the tool are of the size of a rig's.
    pub fn figures(&self, load: &Load) -> Figures {
        let slower = (load.rotary_speed * 60.0 / std::f64::consts::TAU - 50.0) / 20.0;
        let arc = self.arc * (1.0 - self.falls * slower);
        // In small steps down the arc, as in `flexdrill reach`.
        let (mut on_bit, steps) = (load.weight, 2000);
        let turn = std::f64::consts::FRAC_PI_2 / f64::from(steps);
        for step in 0..steps {
            let (sin, cos) = ((f64::from(step) + 0.5) * turn).sin_cos();
            on_bit += (ARC * self.guide * cos - arc * (on_bit + ARC * self.whole * sin)) * turn;
        }
        let on_bit = match load.motion {
            Activity::OffBottom => 0.0,
            Activity::Drilling => on_bit - self.after * self.whole * self.level.max(0.0),
        };
        // The wear flats carry up to their force; what is beyond cuts.
        let on_flats = on_bit.min(self.flats);
        let cutting = (on_bit - on_flats) / self.inclination;
        let bit_torque = 0.5 * BIT * (self.bit * on_flats + cutting);
        let torque = bit_torque * (1.0 + 0.6 * self.joints) + 40.0 * self.inside + 20.0 * self.joints;
        let depth_of_cut = cutting / (self.energy * BIT);
        let rate = load.rotary_speed / std::f64::consts::TAU * depth_of_cut;
        let rate = if load.motion == Activity::Drilling {
            rate
        } else {
            f64::NAN
        };
        [torque, HANGING - load.weight, bit_torque, on_bit, rate]
    }
}

/// Windows of both states of motion that have every channel.
fn everywhere() -> Windows {
    let mut samples = Vec::new();
    for weight in [0.0, 10e3] {
        for second in 0..80 {
            let ripple = 0.01 * f64::from(second % 3);
            samples.push(Sample {
                time: samples.len() as f64,
                row: samples.len() as u64,
                rotary_speed: 5.0,
                weight,
                measured: [1.0 + ripple; Channel::COUNT],
            });
        }
    }
    find(&samples, &WindowSettings::default())
}

/// Standard normal numbers of a seed.
pub struct Normal(fastrand::Rng);

impl Normal {
    pub fn new(seed: u64) -> Self {
        Self(fastrand::Rng::with_seed(seed))
    }

    pub fn next(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.0.f64()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.0.f64()).cos()
    }
}

/// Parts of the log: speed (r/min), weight that the indicator shows (kN), seconds. 40 minutes with three times off bottom. At
/// the lightest weights no usual tool of the prior cuts, at the heaviest every one does.
pub fn schedule() -> Vec<(f64, f64, u32)> {
    let mut all = Vec::new();
    for (rpm, kn) in [(40.0, 10.0), (60.0, 20.0), (50.0, 14.0)] {
        all.push((rpm, 0.0, 90));
        all.push((rpm, kn, 240));
        all.push((rpm + 4.0, kn - 1.0, 240));
        all.push((rpm, kn - 3.0 + 0.3 * (kn - 10.0), 240));
    }
    all
}

/// What a log is made of.
pub struct Log {
    pub seed: u64,
    /// Standardised unknowns, those of the sensors with them.
    pub z: Vec<f64>,
    pub truth: Truth,
}

impl Log {
    /// Of a rig that the priors have.
    pub fn plausible(world: &World, seed: u64) -> Self {
        let mut random = Normal::new(seed);
        let count = world.problem.unknowns.len();
        let z: Vec<f64> = (0..count).map(|_| random.next().clamp(-2.0, 2.0)).collect();
        Self {
            seed,
            truth: Truth::of(&world.config, &world.unknowns, &z),
            z,
        }
    }

    /// The same with another value of an unknown.
    pub fn with(mut self, world: &World, name: &str, value: f64) -> Self {
        let at = place(world, name);
        self.z[at] = world.problem.unknowns[at].standard(value);
        self.truth = Truth::of(&world.config, &world.unknowns, &self.z);
        self
    }
}

/// Number of an unknown.
pub fn place(world: &World, name: &str) -> usize {
    let mut all = world.problem.unknowns.iter();
    all.position(|unknown| unknown.name == name).unwrap()
}

/// The samples of a schedule with the errors of the sensors.
fn samples(world: &World, log: &Log, schedule: &[(f64, f64, u32)]) -> Vec<Sample> {
    let mut random = Normal::new(1_000_003 * log.seed + 1);
    let of_sensor = |of: Of, part: Part| {
        let at = world
            .unknowns
            .sensors
            .iter()
            .position(|known| known.of == of && known.part == part);
        let at = at.unwrap() + world.unknowns.modelled.len();
        world.problem.unknowns[at].value(log.z[at])
    };
    let (factor, tare) = (
        of_sensor(Of::Indicator, Part::Factor),
        of_sensor(Of::Indicator, Part::Tare),
    );
    let tares = [Channel::SurfaceTorque, Channel::HookLoad].map(|channel| of_sensor(Of::Channel(channel), Part::Tare));
    let noise = [15.0, 2e3, 10.0, 400.0, 5e-4];
    let drift = [5.0, 1e3, 0.0, 0.0, 0.0].map(|hour: f64| hour / 60.0);
    let (mut walk, mut samples) = ([0.0; Channel::COUNT], Vec::new());
    let of_log = of_sensor(Of::Channel(Channel::RateOfPenetration), Part::Factor);
    for &(rpm, kn, seconds) in schedule {
        let shown = 1e3 * kn;
        let load = Load {
            motion: if kn > 0.0 {
                Activity::Drilling
            } else {
                Activity::OffBottom
            },
            rotary_speed: rpm * std::f64::consts::TAU / 60.0,
            weight: if kn > 0.0 { (shown - tare) / factor } else { 0.0 },
        };
        let [torque, hook_load, bit_torque, on_bit, rate] = log.truth.figures(&load);
        let of_part = of_log * (1.0 + ROCK * random.next());
        let exact = [
            torque + tares[0],
            HANGING + factor * (hook_load - HANGING) + tares[1],
            bit_torque,
            on_bit,
            rate * of_part,
        ];
        for _ in 0..seconds {
            let mut measured = [f64::NAN; Channel::COUNT];
            for k in 0..measured.len() {
                walk[k] += drift[k] * random.next();
                measured[k] = exact[k] + walk[k] + noise[k] * random.next();
            }
            let row = samples.len() as u64;
            samples.push(Sample {
                time: row as f64,
                row: row + 2,
                rotary_speed: load.rotary_speed,
                weight: shown,
                measured,
            });
        }
    }
    samples
}

/// What one log gives, with its truth.
pub struct Trial {
    /// Standardised.
    pub truth: Vec<f64>,
    pub problem: Problem,
    pub outcome: Outcome,
    pub windows: Windows,
}

impl Trial {
    /// Whether the band of an unknown holds its truth.
    pub fn holds(&self, unknown: usize) -> bool {
        let truth = self.problem.unknowns[unknown].value(self.truth[unknown]);
        let [low, high] = self.outcome.estimates[unknown].band;
        (low..=high).contains(&truth)
    }
}

pub fn trial(world: &World, log: &Log, channels: &[Channel], schedule: &[(f64, f64, u32)]) -> Trial {
    trial_of(world, &world.problem, log, channels, schedule)
}

/// The problem of a rig whose weight indicator is taken for exact.
pub fn with_exact_indicator(world: &World) -> Problem {
    let mut exact = world.problem.clone();
    exact.indicator = Sensor::default();
    for quantity in exact.quantities.iter_mut().filter(|of| of.channel == Channel::HookLoad) {
        quantity.sensor.factor = None;
    }
    exact
}

/// The same with another problem: surrogates with other assumptions about the sensors.
pub fn trial_of(
    world: &World,
    problem: &Problem,
    log: &Log,
    channels: &[Channel],
    schedule: &[(f64, f64, u32)],
) -> Trial {
    let mut samples = samples(world, log, schedule);
    for sample in &mut samples {
        for channel in Channel::ALL.into_iter().filter(|channel| !channels.contains(channel)) {
            sample.measured[channel as usize] = f64::NAN;
        }
    }
    let windows = find(&samples, &WindowSettings::default());
    let mut problem = problem.clone();
    problem.observations = observations(&windows, &problem.quantities);
    let smoother = SmootherSettings {
        members: MEMBERS,
        seed: log.seed,
        ..SmootherSettings::default()
    };
    let outcome = problem.fit(&smoother).unwrap();
    Trial {
        truth: log.z.clone(),
        problem,
        outcome,
        windows,
    }
}
