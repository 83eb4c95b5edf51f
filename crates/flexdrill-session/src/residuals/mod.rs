//! What the rig measures against what the twin computes, once per second of model time: `twin/residuals` and the condition
//! of the alarm `rig_disagrees`, and the parameters that follow the rig (`calibration.follow`). The mathematics is
//! [`flexdrill_calibration::monitor`] and [`flexdrill_calibration::following`].
//!
//! A comparison is a function of the frame and of the samples that have come since the one before. The message keeps these
//! samples, so that a replay of the recording compares the same numbers.

mod following;
mod tools;
mod words;

use flexdrill_calibration::follow::Instant;
use flexdrill_calibration::monitor::{Compared, Monitor, MonitorSettings, Reading};
use flexdrill_calibration::plausible;
use flexdrill_calibration::residual::{Residual, RigQuantity};
use flexdrill_config::Config;
use flexdrill_core::inputs::{InputState, MeasuredKind};
use flexdrill_core::twin::{Frame, Snapshot};
use flexdrill_motion::{BIT, KICK_OFF, SURFACE};

pub use crate::alarms::FOLLOW;
use crate::alarms::{Followed, Judged, in_words};
use crate::messages;
use crate::messages::std_msgs::Header;
use crate::rig_inputs::Measured;
pub use flexdrill_config::FOLLOWED;
use following::Estimate;
pub use following::{changes, followed};
pub use tools::{Friction, Judgement};
use tools::{Said, Tools};

/// Model time between two comparisons (s).
const INTERVAL: f64 = 1.0;
/// Age of the newest depth of the bit (s) beyond which it is not known.
const DEPTH_AGE: f64 = 60.0;

/// What rig and twin are compared in, as the rig measures it.
const fn kind(quantity: RigQuantity) -> MeasuredKind {
    match quantity {
        RigQuantity::SurfaceTorque => MeasuredKind::SurfaceTorque,
        RigQuantity::HookLoad => MeasuredKind::HookLoad,
        RigQuantity::DownholeSpeed => MeasuredKind::DownholeRotarySpeed,
        RigQuantity::DownholeTorque => MeasuredKind::DownholeTorque,
        RigQuantity::DownholeWeight => MeasuredKind::DownholeWeightOnBit,
    }
}

/// What the twin computes for each quantity (SI), as means over the window of transfer. A tool without a string above has
/// its drive at the kick-off.
pub fn predicted(snapshot: &Snapshot) -> [f64; RigQuantity::COUNT] {
    let mean = &snapshot.transfer.mean;
    let top = if mean.torque[SURFACE].is_finite() {
        SURFACE
    } else {
        KICK_OFF
    };
    // Before the first window the means are zeros that nothing has filled.
    if snapshot.transfer.duration <= 0.0 {
        return [f64::NAN; RigQuantity::COUNT];
    }
    [
        mean.torque[top],
        mean.hook_load,
        mean.speed,
        mean.torque[BIT],
        mean.weight[BIT],
    ]
}

/// What the rig has measured since the comparison before; NaN where nothing came.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Samples {
    /// In the order of [`RigQuantity::ALL`] (SI).
    pub values: [f64; RigQuantity::COUNT],
    /// Measured depth of the bit (m), the newest that is known.
    pub bit_depth: f64,
    /// A recorded run had plausible tools, which came too late for this comparison.
    pub tools_late: bool,
}

impl Samples {
    /// The samples of a recorded comparison.
    pub fn of(message: &messages::Residuals) -> Self {
        let mut values = [f64::NAN; RigQuantity::COUNT];
        for quantity in RigQuantity::ALL {
            let name = kind(quantity).name();
            if let Some(of) = message.residuals.iter().find(|of| of.name == name) {
                values[quantity as usize] = of.sample;
            }
        }
        Self {
            values,
            bit_depth: message.bit_depth,
            tools_late: message.estimate_frozen == following::LATE,
        }
    }
}

/// What a comparison gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Time since the comparison before (s).
    pub step: f64,
    /// The rig against the twin.
    pub compared: Compared,
    /// The rig against plausible tools, a little earlier, where the alarm is judged by them: `Some(None)` while they have not
    /// come to an instant that can be judged.
    pub tools: Option<Option<plausible::Compared>>,
    /// For publication.
    pub message: messages::Residuals,
    /// The values of [`FOLLOWED`] in force and those that are to be, where they follow the rig.
    pub moved: Option<[[f64; 2]; 2]>,
    /// The limit that has begun to stop them, in words.
    pub stopped: Option<String>,
    /// Whether a limit stops them.
    pub at_limit: bool,
}

impl Comparison {
    /// For the alarm: what the rig is compared with.
    pub fn judged(&self) -> Judged<'_> {
        match &self.tools {
            Some(tools) => Judged::Tools(tools.as_ref()),
            None => Judged::Twin(&self.compared),
        }
    }

    /// The friction that the twin has followed the rig to.
    pub fn followed(&self) -> Followed {
        if !self.message.following {
            return Followed::default();
        }
        Followed {
            factors: [
                self.message.applied_friction_factor,
                self.message.configured_friction_factor,
            ],
            at_limit: self.at_limit,
            by_tools: self.tools.is_some(),
        }
    }
}

/// The comparison of a run.
pub struct RigComparison {
    monitor: Monitor,
    settings: MonitorSettings,
    estimate: Estimate,
    /// Plausible tools, where they run with the twin.
    tools: Option<Tools>,
    time_step: f64,
    /// Stamps of the newest samples that were taken (ns).
    taken: [i64; RigQuantity::COUNT],
    /// Time of the last comparison (s of model time, skipped steps included), once there was one.
    last: Option<f64>,
    /// The rig has measured one of the quantities.
    heard: bool,
}

impl RigComparison {
    /// A comparison with the tares and errors of a configuration.
    pub fn new(config: &Config) -> Self {
        let settings = MonitorSettings::stated(&flexdrill_calibration::stated(config));
        Self {
            monitor: Monitor::new(settings),
            estimate: Estimate::new(config),
            tools: None,
            settings,
            time_step: config.solver.time_step,
            taken: [i64::MIN; RigQuantity::COUNT],
            last: None,
            heard: false,
        }
    }

    /// Plausible tools run with the twin. The alarm is judged by them, and friction follows them.
    pub fn judge_by_tools(&mut self) {
        self.tools = Some(Tools::new(self.time_step));
    }

    /// Takes what plausible tools say of the second that ends at these ticks.
    pub fn hear_tools(&mut self, ticks: u64, judgement: Judgement) {
        if let Some(tools) = &mut self.tools {
            tools.hear(ticks, judgement);
        }
    }

    /// Adopts the values in force of what follows the rig.
    pub fn reconfigure(&mut self, config: &Config) {
        self.monitor.set_tare(flexdrill_calibration::stated(config).tare);
        self.estimate.reconfigure(config);
    }

    /// Forgets what was estimated, after a reset of the model.
    pub fn restart(&mut self) {
        self.estimate.restart();
    }

    /// Whether a second has passed since the last comparison.
    pub fn is_due(&self, ticks: u64) -> bool {
        let time = ticks as f64 * self.time_step;
        // Looks at the tool are a tenth of a second apart.
        self.last
            .is_none_or(|last| time - last >= INTERVAL - 0.5 * self.time_step)
    }

    /// What has come since the last call, at an instant of the run (ns). Values that their source doubts are left out.
    pub fn samples(&mut self, measured: &Measured, instant: i64) -> Samples {
        let known = |kind: MeasuredKind, longest: f64| {
            let newest = measured.newest(kind).filter(|newest| !newest.suspect);
            newest.filter(|newest| instant.saturating_sub(newest.stamp) as f64 * 1e-9 <= longest)
        };
        let mut values = [f64::NAN; RigQuantity::COUNT];
        for quantity in RigQuantity::ALL {
            let index = quantity as usize;
            let newest = known(kind(quantity), self.settings.longest_age[index]);
            if let Some(newest) = newest.filter(|newest| newest.stamp != self.taken[index]) {
                self.taken[index] = newest.stamp;
                values[index] = newest.value;
            }
        }
        let depth = known(MeasuredKind::BitDepth, DEPTH_AGE);
        Samples {
            values,
            bit_depth: depth.map_or(f64::NAN, |depth| depth.value),
            tools_late: false,
        }
    }

    /// Compares a frame with samples; `None` until the rig has measured one of the quantities.
    pub fn compare(&mut self, frame: &Frame, samples: &Samples, header: Header) -> Option<Comparison> {
        let time = frame.ticks as f64 * self.time_step;
        // A recording begins with the first samples; what was before them must not matter.
        let step = self.last.filter(|_| self.heard).map_or(INTERVAL, |last| time - last);
        self.last = Some(time);
        self.heard |= samples.values.iter().any(|value| value.is_finite());
        if !self.heard {
            return None;
        }
        let snapshot = &frame.snapshot;
        let good = [InputState::Ok as u8, InputState::Slow as u8].contains(&frame.input_quality);
        let (computed, friction) = (predicted(snapshot), layers_friction(snapshot));
        let surface = RigQuantity::SurfaceTorque as usize;
        let mut expected = computed;
        expected[surface] -= self.estimate.excess(friction);
        let compared = self.monitor.push(&Reading {
            step,
            rotary_speed: snapshot.applied.rotary_speed,
            weight: snapshot.applied.weight_set,
            good,
            measured: samples.values,
            predicted: expected,
        });
        let instant = Instant {
            step,
            measured: samples.values[surface],
            predicted: computed[surface],
            friction,
            applied: self.estimate.motion_factor(),
            good,
            steady: compared.steady,
        };
        let late = samples.tools_late;
        let said = self.tools.as_mut().map(|tools| tools.at(frame.ticks, late));
        let message = message(header, &compared, samples);
        let pushed = match &said {
            None => self.estimate.push(&instant, message),
            Some(said) => {
                let known = match said {
                    Said::Judgement(judgement) => Ok(judgement.friction),
                    Said::Later | Said::Nothing => Err(following::Late),
                };
                self.estimate.push_by_tools(&instant, known, message)
            }
        };
        Some(Comparison {
            step,
            compared,
            tools: match said {
                None | Some(Said::Nothing) => None,
                Some(Said::Later) => Some(None),
                // Too few tools run to speak of what none of them does.
                Some(Said::Judgement(judgement)) => judgement.compared.map(Some),
            },
            message: pushed.message,
            moved: pushed.moved,
            stopped: pushed.stopped,
            at_limit: pushed.at_limit,
        })
    }
}

/// Torque that friction takes in both layers of the tool (N m).
fn layers_friction(snapshot: &Snapshot) -> f64 {
    let [pipe_guide, guide_wall, ..] = snapshot.transfer.friction_torque;
    pipe_guide + guide_wall
}

fn message(header: Header, compared: &Compared, samples: &Samples) -> messages::Residuals {
    let residual = |quantity: RigQuantity| {
        let of = compared.residuals[quantity as usize].as_ref();
        let number = |get: fn(&Residual) -> f64| of.map_or(f64::NAN, get);
        messages::Residual {
            name: kind(quantity).name().to_owned(),
            unit: kind(quantity).unit().to_owned(),
            sample: samples.values[quantity as usize],
            measured: number(|of| of.measured),
            predicted: number(|of| of.predicted),
            low: number(|of| of.predicted - of.band()),
            high: number(|of| of.predicted + of.band()),
            ratio: number(Residual::ratio),
        }
    };
    messages::Residuals {
        header,
        residuals: RigQuantity::ALL.map(residual).into(),
        steady: compared.steady,
        drilling: compared.drilling,
        bit_depth: samples.bit_depth,
        likely_causes: compared
            .causes
            .iter()
            .map(|cause| in_words(*cause).to_owned())
            .collect(),
        // The estimate adds the rest.
        ..messages::Residuals::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::RigMeasured;
    use crate::messages::builtin_interfaces::Time;
    use flexdrill_outputs::MeasuredValues as _;

    const SECOND: i64 = 1_000_000_000;
    const START: i64 = 1_700_000_000 * SECOND;

    fn config() -> Config {
        Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap()
    }

    /// A frame of steady drilling at a second.
    fn frame(config: &Config, second: u64) -> Frame {
        let mut frame = Frame {
            ticks: (second as f64 / config.solver.time_step).round() as u64,
            input_quality: InputState::Ok as u8,
            ..Frame::default()
        };
        let snapshot = &mut frame.snapshot;
        snapshot.applied.rotary_speed = 4.2;
        snapshot.applied.weight_set = 12e3;
        snapshot.transfer.duration = 5.0;
        snapshot.transfer.mean.torque = [300.0, 280.0, 200.0];
        snapshot.transfer.mean.weight = [12e3, 11e3, 10e3];
        snapshot.transfer.friction_torque = [20.0, 60.0, 0.0, 20.0];
        snapshot.transfer.mean.hook_load = 160e3;
        snapshot.transfer.mean.speed = 4.2;
        frame
    }

    fn measure(measured: &mut Measured, stamp: i64, quality: u8, values: &[(MeasuredKind, f64)]) {
        let header = Header {
            stamp: Time::from_nanoseconds(stamp),
            ..Header::default()
        };
        let mut message = RigMeasured::not_given(header, quality, "test".into());
        for (kind, value) in values {
            message.set(*kind, *value);
        }
        measured.accept(&message, stamp, 0.0, 1.0).unwrap();
    }

    /// Sixty seconds in which the rig measures 360 N m at the surface, and every twentieth second the hole.
    fn run(config: &Config) -> Vec<(Compared, messages::Residuals)> {
        let mut rig = RigComparison::new(config);
        let mut measured = Measured::default();
        let mut all = Vec::new();
        for second in 0..60_u64 {
            let instant = START + second as i64 * SECOND;
            measure(
                &mut measured,
                instant,
                RigMeasured::GOOD,
                &[(MeasuredKind::SurfaceTorque, 360.0)],
            );
            if second.is_multiple_of(20) {
                let hole = [
                    (MeasuredKind::DownholeTorque, 200.0),
                    (MeasuredKind::DownholeWeightOnBit, 10e3),
                ];
                measure(&mut measured, instant - 15 * SECOND, RigMeasured::GOOD, &hole);
            }
            let frame = frame(config, second);
            assert!(rig.is_due(frame.ticks), "{second}");
            let samples = rig.samples(&measured, instant);
            let header = Header {
                stamp: Time::from_nanoseconds(instant),
                ..Header::default()
            };
            let compared = rig.compare(&frame, &samples, header);
            all.extend(compared.map(|of| (of.compared, of.message)));
            assert!(!rig.is_due(frame.ticks), "{second}");
        }
        all
    }

    #[test]
    fn a_torque_beyond_its_band_is_friction_where_the_bit_takes_what_it_should() {
        let all = run(&config());
        let (compared, message) = all.last().unwrap();
        let [torque, hook_load, _, bit_torque, bit_weight] = &message.residuals[..] else {
            panic!("{message:?}");
        };
        assert_eq!((torque.measured, torque.predicted), (360.0, 300.0));
        assert!(
            torque.ratio > 2.0 && torque.low > 270.0 && torque.high < 330.0,
            "{torque:?}"
        );
        assert!(hook_load.measured.is_nan() && hook_load.sample.is_nan());
        assert_eq!((bit_torque.ratio, bit_weight.ratio), (0.0, 0.0));
        assert!(
            message.likely_causes[0].starts_with("friction has risen"),
            "{message:?}"
        );
        assert!(compared.steady && compared.drilling && message.bit_depth.is_nan());
        // The estimate moves towards the torque, within its band, and only while the motion is steady.
        assert!(message.torque_tare > 0.0 && message.torque_tare < 60.0, "{message:?}");
        assert!(message.friction_factor_low < message.friction_factor && message.estimate_frozen.is_empty());
        assert_eq!((all[0].1.friction_factor, all[0].1.torque_tare), (1.0, 0.0));
        assert_eq!(all[0].1.estimate_frozen, "the motion is not steady");
        // A value counts once: between two words of the tool in the hole there is no sample.
        let of_the_hole: Vec<usize> = (0..60).filter(|k| all[*k].1.residuals[3].sample.is_finite()).collect();
        assert_eq!(of_the_hole, [0, 20, 40]);
    }

    #[test]
    fn the_samples_in_the_messages_give_the_same_comparison() {
        let config = config();
        let all = run(&config);
        let mut again = RigComparison::new(&config);
        for (second, (compared, message)) in all.iter().enumerate() {
            let frame = frame(&config, second as u64);
            let same = again
                .compare(&frame, &Samples::of(message), message.header.clone())
                .unwrap();
            assert_eq!(&same.compared, compared);
            let bytes = |message| messages::to_cdr(message).unwrap();
            assert_eq!(bytes(&same.message), bytes(message));
        }
    }

    #[test]
    fn what_is_doubtful_or_old_is_left_out_and_nothing_measured_is_nothing_published() {
        let config = config();
        let mut rig = RigComparison::new(&config);
        let mut measured = Measured::default();
        let none = rig.samples(&measured, START);
        assert!(rig.compare(&frame(&config, 0), &none, Header::default()).is_none());
        measure(
            &mut measured,
            START,
            RigMeasured::SUSPECT,
            &[(MeasuredKind::SurfaceTorque, 360.0)],
        );
        measure(
            &mut measured,
            START - 6 * SECOND,
            RigMeasured::GOOD,
            &[(MeasuredKind::HookLoad, 1e5)],
        );
        assert!(rig.samples(&measured, START).values.iter().all(|value| value.is_nan()));
        measure(
            &mut measured,
            START - 4 * SECOND,
            RigMeasured::GOOD,
            &[(MeasuredKind::HookLoad, 1e5)],
        );
        let samples = rig.samples(&measured, START);
        assert_eq!(samples.values[RigQuantity::HookLoad as usize], 1e5);
        assert!(rig.compare(&frame(&config, 1), &samples, Header::default()).is_some());
        // Inputs that are not good judge nothing.
        let mut stale = frame(&config, 2);
        stale.input_quality = InputState::Stale as u8;
        let stale = rig.compare(&stale, &samples, Header::default()).unwrap();
        assert!(!stale.compared.steady);
        assert_eq!(stale.message.following_held, "calibration.follow is off");
        assert_eq!(stale.message.estimate_frozen, "an input is not good");
    }
}
