//! Motions of a known kind, drawn at random.

use super::*;

/// A generated motion with the kind it should be called.
pub struct Labelled {
    pub family: &'static str,
    pub kind: WhirlKind,
    /// Whirl rate over rotary speed, where there is one line.
    pub ratio: Option<f64>,
    pub rotary_speed: f64,
    motion: Motion,
    drift: [f64; 2],
    centre: [f64; 2],
    /// Relative change of the rotary speed per second; whirl rates go with it.
    ramp: f64,
    /// Beginning and end of times without samples (s).
    gaps: Vec<[f64; 2]>,
    /// Standard deviation per axis (m), 20 dB below the motion.
    noise: f64,
}

enum Motion {
    Lines(Vec<Ellipse>),
    /// A rotor whose direction changes at random times.
    Turning {
        radius: f64,
        rate: f64,
        switches: Vec<f64>,
    },
    /// To and fro along a wall: amplitude (rad) about the low side.
    Rocking {
        radius: f64,
        rate: f64,
        amplitude: f64,
    },
    /// Thrown from wall to wall: straight flights between the points at which it leaves and meets the wall, which it
    /// rolls along in between.
    Bouncing {
        /// Time and angle of leaving (s, rad), then of meeting the wall, in turn.
        points: Vec<[f64; 2]>,
    },
    /// Along the wall at a rate that wavers.
    Slipping {
        rate: f64,
        /// Part of the rate, and rate (rad/s) of the wavering.
        wavering: [f64; 2],
    },
}

impl Labelled {
    /// The `family` is chosen by the index, everything else at random.
    pub fn generate(index: usize, random: &mut Random) -> Self {
        let rpm = random.within(20.0, 120.0);
        let rotary_speed = rpm * TAU / 60.0;
        let sign = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
        let whirl = if sign > 0.0 {
            WhirlKind::Forward
        } else {
            WhirlKind::Backward
        };
        let radius = CLEARANCE * random.within(0.2, 1.0);
        let turn = TAU / rotary_speed;
        let (mut drift, mut ramp, mut gaps) = ([0.0; 2], 0.0, Vec::new());
        // Where the mean of the motion lies, from the gap's centre; by default so that the motion goes round that.
        let mut centre = None;
        let on_side = |distance: f64, random: &mut Random| {
            let angle = random.within(0.0, TAU);
            Some([CLEARANCE * distance * angle.cos(), CLEARANCE * distance * angle.sin()])
        };
        let (family, kind, ratio, motion) = match index / 2 % 20 {
            0 => (
                "circle at the tool's rate",
                whirl,
                Some(sign),
                Motion::Lines(vec![circle(radius, sign * rotary_speed, random)]),
            ),
            1 => {
                let ratio = sign * random.within(0.35, 0.9);
                (
                    "sub-synchronous circle",
                    whirl,
                    Some(ratio),
                    Motion::Lines(vec![circle(radius, ratio * rotary_speed, random)]),
                )
            }
            2 => {
                let ratio = sign * random.within(1.2, 5.0);
                (
                    "fast circle, rolling among them",
                    whirl,
                    Some(ratio),
                    Motion::Lines(vec![circle(radius, ratio * rotary_speed, random)]),
                )
            }
            3 => {
                let ratio = sign * random.within(0.5, 4.0);
                let mut line = circle(radius, ratio * rotary_speed, random);
                line.minor *= random.within(0.4, 0.95);
                ("ellipse", whirl, Some(ratio), Motion::Lines(vec![line]))
            }
            4 => {
                let ratio = sign * random.within(0.5, 4.0);
                let line = circle(radius, ratio * rotary_speed, random);
                let angle = random.within(0.0, TAU);
                let size = radius * random.within(0.2, 1.0) / (4.0 * turn);
                drift = [size * angle.cos(), size * angle.sin()];
                // It is at the gap's centre in the middle of the last four turns.
                let middle = duration(rotary_speed) - 2.0 * turn;
                centre = Some(drift.map(|drift| -drift * middle));
                (
                    "circle with a drifting centre",
                    whirl,
                    Some(ratio),
                    Motion::Lines(vec![line]),
                )
            }
            5 => {
                let ratio = sign * random.within(0.8, 4.0);
                let line = circle(radius, ratio * rotary_speed, random);
                let other = circle(
                    radius * random.within(0.1, 0.4),
                    -ratio * random.within(1.3, 3.0) * rotary_speed,
                    random,
                );
                (
                    "two lines, the larger one leads",
                    whirl,
                    Some(ratio),
                    Motion::Lines(vec![line, other]),
                )
            }
            6 if sign > 0.0 => {
                let mut line = circle(radius, random.within(0.5, 4.0) * random.sign() * rotary_speed, random);
                line.minor *= random.within(0.0, 0.12);
                ("planar vibration", WhirlKind::None, None, Motion::Lines(vec![line]))
            }
            6 => {
                let line = circle(
                    CLEARANCE * random.within(0.0, 0.08),
                    random.sign() * rotary_speed,
                    random,
                );
                ("trembling at rest", WhirlKind::None, None, Motion::Lines(vec![line]))
            }
            7 if sign > 0.0 => {
                let angle = random.within(0.0, TAU);
                let size = CLEARANCE * random.within(0.1, 1.0) / (4.0 * turn);
                drift = [size * angle.cos(), size * angle.sin()];
                (
                    "slow drift",
                    WhirlKind::None,
                    None,
                    Motion::Lines(vec![circle(0.02 * CLEARANCE, rotary_speed, random)]),
                )
            }
            7 => {
                let noise = circle(CLEARANCE * random.within(0.0, 0.05), rotary_speed, random);
                let beat = Ellipse {
                    minor: 0.0,
                    major: radius,
                    rate: 1.9 * rotary_speed,
                    ..noise
                };
                let second = Ellipse {
                    minor: 0.0,
                    major: 0.5 * radius,
                    rate: 3.1 * rotary_speed,
                    ..noise
                };
                (
                    "two vibrations in one plane",
                    WhirlKind::None,
                    None,
                    Motion::Lines(vec![noise, beat, second]),
                )
            }
            8 => {
                let ratio = sign * random.within(0.5, 4.0);
                // Over the whole run, up to a third up or down.
                ramp = random.within(0.1, 0.33) * random.sign() / duration(rotary_speed);
                (
                    "circle while the speed changes",
                    whirl,
                    Some(ratio),
                    Motion::Lines(vec![circle(radius, ratio * rotary_speed, random)]),
                )
            }
            9 => {
                let ratio = sign * random.within(0.5, 4.0);
                let mut at = random.within(0.1, 1.0);
                while at < duration(rotary_speed) {
                    let end = at + random.within(0.02, 0.09);
                    gaps.push([at, end]);
                    at = end + random.within(0.3, 1.5);
                }
                (
                    "circle with gaps in the samples",
                    whirl,
                    Some(ratio),
                    Motion::Lines(vec![circle(radius, ratio * rotary_speed, random)]),
                )
            }
            10 if sign > 0.0 => (
                "rocking along the wall",
                WhirlKind::None,
                None,
                Motion::Rocking {
                    radius: CLEARANCE,
                    rate: random.within(1.0, 2.0).round() * rotary_speed,
                    amplitude: random.within(0.3, 1.9),
                },
            ),
            10 => {
                let mut noise = circle(0.0, rotary_speed, random);
                // Sets the noise below: it is all there is.
                noise.major = CLEARANCE * random.within(0.05, 0.6);
                noise.rate = 0.0;
                ("noise at rest", WhirlKind::None, None, Motion::Lines(vec![noise]))
            }
            11 => {
                let radius = CLEARANCE * random.within(0.6, 1.0);
                // Many lines of both directions: band-limited noise that repeats only after minutes.
                let lines = (0..60)
                    .map(|_| {
                        let rate = random.within(0.5, 6.0) * random.sign() * rotary_speed;
                        circle(radius * random.within(0.5, 1.5) / 60f64.sqrt(), rate, random)
                    })
                    .collect();
                ("broad-band motion", WhirlKind::Chaotic, None, Motion::Lines(lines))
            }
            12 => {
                let radius = CLEARANCE * random.within(0.6, 1.0);
                let rate = random.within(1.5, 5.0) * rotary_speed;
                let mut at = 0.0;
                let mut switches = Vec::new();
                while at < 20.0 * turn {
                    at += random.within(0.25, 0.9) * TAU / rate;
                    switches.push(at);
                }
                (
                    "direction that changes at random",
                    WhirlKind::Chaotic,
                    None,
                    Motion::Turning { radius, rate, switches },
                )
            }
            13 => {
                let times = [1.0, 2.0, 4.0][random.next_u64() as usize % 3];
                let size = random.within(0.13, 0.3);
                centre = on_side(1.0 - size, random);
                let line = circle(CLEARANCE * size, sign * times * rotary_speed, random);
                if times == 2.0 {
                    let family = "small circle at rest, twice the spin";
                    (family, WhirlKind::JointVibration, None, Motion::Lines(vec![line]))
                } else {
                    let family = "small circle at rest, once or four times the spin";
                    (family, WhirlKind::None, None, Motion::Lines(vec![line]))
                }
            }
            14 => {
                let size = random.within(0.2, 0.4);
                centre = on_side(1.0 - size, random);
                let mut line = circle(CLEARANCE * size, sign * 2.0 * rotary_speed, random);
                line.minor *= random.within(0.35, 0.9);
                let family = "ellipse at the wall, twice the spin";
                (family, WhirlKind::JointVibration, None, Motion::Lines(vec![line]))
            }
            15 | 16 => {
                let ratio = -random.within(1.5, 4.0);
                centre = Some([0.0; 2]);
                let family = "bouncing backward whirl, in contact 2 to 30 % of the time";
                let motion = bouncing(ratio * rotary_speed, duration(rotary_speed), random);
                (family, WhirlKind::Backward, Some(ratio), motion)
            }
            17 => {
                let ratio = -random.within(0.3, 0.95) * 63.0 / 17.0;
                centre = Some([0.0; 2]);
                let wavering = [random.within(0.0, 0.2), random.within(0.3, 2.0) * rotary_speed];
                let rate = ratio * rotary_speed;
                (
                    "rolling with slip",
                    WhirlKind::Backward,
                    Some(ratio),
                    Motion::Slipping { rate, wavering },
                )
            }
            18 => {
                let size = random.within(0.56, 0.66);
                centre = on_side(1.0 - size, random);
                let ratio = sign * random.within(0.5, 4.0);
                let line = circle(CLEARANCE * size, ratio * rotary_speed, random);
                (
                    "circle of more than half the clearance, against one side",
                    whirl,
                    Some(ratio),
                    Motion::Lines(vec![line]),
                )
            }
            _ => {
                let size = random.within(0.13, 0.4);
                centre = on_side(1.0 - size, random);
                let ratio = if random.sign() > 0.0 {
                    random.within(0.5, 1.6)
                } else {
                    random.within(2.5, 5.0)
                };
                let line = circle(CLEARANCE * size, sign * ratio * rotary_speed, random);
                (
                    "circle of less than half the clearance, against one side",
                    WhirlKind::None,
                    None,
                    Motion::Lines(vec![line]),
                )
            }
        };
        let power = match &motion {
            Motion::Lines(lines) => lines.iter().map(Ellipse::power).sum::<f64>(),
            Motion::Turning { radius, .. } => radius * radius,
            // About the middle of the arc, at most.
            Motion::Rocking { radius, amplitude, .. } => (radius * amplitude.min(1.0)).powi(2),
            Motion::Bouncing { .. } | Motion::Slipping { .. } => CLEARANCE * CLEARANCE,
        };
        let least = match &motion {
            Motion::Lines(lines) => lines.first().map_or(CLEARANCE, |line| line.minor),
            _ => CLEARANCE,
        };
        let centre = centre.unwrap_or_else(|| {
            let most = if matches!(kind, WhirlKind::Forward | WhirlKind::Backward) {
                0.4 * least
            } else {
                0.3 * CLEARANCE
            };
            [most * random.next(), most * random.next()]
        });
        Self {
            family,
            kind,
            ratio,
            rotary_speed,
            motion,
            drift,
            centre,
            ramp,
            gaps,
            noise: (power / 100.0 / 2.0).sqrt(),
        }
    }

    /// Seconds after which the answer is read.
    pub fn duration(&self) -> f64 {
        duration(self.rotary_speed)
    }

    /// Rotary speed (rad/s).
    pub fn speed_at(&self, time: f64) -> f64 {
        self.rotary_speed * (1.0 + self.ramp * time)
    }

    /// Feeds the whole motion and returns the kind that stands at its end.
    pub fn run(&self, bench: &mut Bench, noise: &mut Random) -> WhirlKind {
        for step in 0..(self.duration() / SAMPLE_INTERVAL) as usize {
            let time = step as f64 * SAMPLE_INTERVAL;
            if self.gaps.iter().any(|[from, to]| (*from..*to).contains(&time)) {
                bench.skip(SAMPLE_INTERVAL);
            } else {
                bench.push(self.speed_at(time), self.at(time, noise), 0.0);
            }
        }
        bench.kind()
    }

    pub fn at(&self, time: f64, random: &mut Random) -> [f64; 2] {
        let mut position =
            [0, 1].map(|axis: usize| self.centre[axis] + self.drift[axis] * time + self.noise * random.normal());
        match &self.motion {
            Motion::Rocking {
                radius,
                rate,
                amplitude,
            } => {
                let (sin, cos) = (amplitude * (rate * time).sin()).sin_cos();
                position[0] += radius * sin;
                position[1] += radius * cos;
            }
            Motion::Lines(lines) => {
                // The angle goes with the integral of the speed.
                let turned = time + 0.5 * self.ramp * time * time;
                for line in lines {
                    let [y, z] = line.at(turned);
                    position[0] += y;
                    position[1] += z;
                }
            }
            Motion::Bouncing { points } => {
                let next = points.partition_point(|[at, _]| *at <= time).clamp(1, points.len() - 1);
                let ([from, left], [to, met]) = (points[next - 1], points[next]);
                let part = ((time - from) / (to - from)).clamp(0.0, 1.0);
                // From an even point to an odd one it flies.
                let at = if next % 2 == 1 {
                    [0, 1].map(|axis: usize| {
                        let on = |angle: f64| [angle.cos(), angle.sin()][axis];
                        on(left) + (on(met) - on(left)) * part
                    })
                } else {
                    let angle = left + (met - left) * part;
                    [angle.cos(), angle.sin()]
                };
                position[0] += CLEARANCE * at[0];
                position[1] += CLEARANCE * at[1];
            }
            Motion::Slipping {
                rate,
                wavering: [part, pace],
            } => {
                let angle = rate * (time + part * (pace * time).sin() / pace);
                position[0] += CLEARANCE * angle.cos();
                position[1] += CLEARANCE * angle.sin();
            }
            Motion::Turning { radius, rate, switches } => {
                let (mut angle, mut sign, mut from) = (0.0, 1.0, 0.0);
                for &switch in switches {
                    angle += sign * rate * (switch.min(time) - from).max(0.0);
                    (sign, from) = (-sign, switch);
                }
                position[0] += radius * angle.cos();
                position[1] += radius * angle.sin();
            }
        }
        position
    }
}

/// Ten turns of the tool, at least 6 s.
fn duration(rotary_speed: f64) -> f64 {
    (10.0 * TAU / rotary_speed).max(6.0)
}

/// Flights of 50 to 150 degrees that go round at `rate` (rad/s) in the mean, each as long as its share of it, and
/// contacts in between that take 2 to 30 % of the time and roll on at the same rate.
fn bouncing(rate: f64, duration: f64, random: &mut Random) -> Motion {
    let duty = random.within(0.02, 0.3);
    let (mut time, mut angle) = (0.0, random.within(0.0, TAU));
    let mut points = vec![[time, angle]];
    while time < duration + 1.0 {
        let flight = random.within(50.0, 150.0).to_radians();
        let contact = flight * duty / (1.0 - duty);
        for part in [flight, contact] {
            time += part / rate.abs();
            angle += part.copysign(rate);
            points.push([time, angle]);
        }
    }
    Motion::Bouncing { points }
}
