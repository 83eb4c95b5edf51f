//! `calibration.follow`: the twin's friction and the tare of its torque follow the running estimate.

use flexdrill_calibration::BAND;
use flexdrill_calibration::follow::{Follow, FollowSettings, Frozen, Instant};
use flexdrill_calibration::following::{Estimated, Following, FollowingSettings, Held, Moved};
use flexdrill_config::{Config, FOLLOWED};

use super::tools::Friction;
use super::words::{frozen_in_words, held_in_words};
use crate::alarms::FOLLOW;
use crate::messages;
use flexdrill_outputs::ParameterChange;

/// Why nothing follows plausible tools.
const TOO_FEW: &str = "the plausible tools say nothing of friction: too few of them run or have weight";
/// The same, and why nothing was estimated. A replay finds it in a recording, and leaves out what the run did not have.
pub(super) const LATE: &str = "the plausible tools have not come to the second that is due";
const NOT_DRAWN: &str = "the plausible tools all have the same friction, since it is not in the section uncertainty";

/// Plausible tools that have not come to the second that is due.
#[derive(Debug, Clone, Copy)]
pub(super) struct Late;

/// Values of the parameters that follow, in the order of [`FOLLOWED`] as every array here.
pub fn followed(config: &Config) -> [f64; 2] {
    [config.calibration.friction_factor, config.calibration.torque_tare_nm]
}

/// The parameters of [`FOLLOWED`] with values, as changes that following asks for. Values that stay are left out.
pub fn changes(from: [f64; 2], to: [f64; 2]) -> Vec<ParameterChange> {
    let changed = (0..2).filter(|k| from[*k] != to[*k]);
    changed
        .map(|k| ParameterChange {
            name: FOLLOWED[k].to_owned(),
            value: to[k],
            asked_by: FOLLOW.to_owned(),
        })
        .collect()
}

/// The running estimate and the parameters on their way to it.
pub(super) struct Estimate {
    follow: Follow,
    /// None without `calibration.follow`.
    following: Option<Following>,
    settings: FollowSettings,
    rules: FollowingSettings,
    /// Values at the start of the run.
    configured: [f64; 2],
    /// Distance from the configured tare within which 90 % of the tares lie (N m).
    tare_range: f64,
    /// Values in force.
    applied: [f64; 2],
    /// The factor that the motion has ([`Config::motion_factor`]).
    in_motion: f64,
    /// A limit stops it.
    stopped: bool,
}

/// What a sample means.
pub(super) struct Pushed {
    pub(super) message: messages::Residuals,
    /// The values in force and those that are to be, where they change.
    pub(super) moved: Option<[[f64; 2]; 2]>,
    /// The limit that has begun to stop it.
    pub(super) stopped: Option<String>,
    /// Whether a limit stops it.
    pub(super) at_limit: bool,
}

impl Estimate {
    pub(super) fn new(config: &Config) -> Self {
        let (settings, rules) = settings(config);
        let configured = followed(config);
        Self {
            follow: Follow::new(settings, configured),
            following: config.calibration.follow.then(|| Following::new(rules)),
            settings,
            rules,
            configured,
            tare_range: config.calibration.torque_tare_range_nm,
            applied: configured,
            in_motion: config.motion_factor(),
            stopped: false,
        }
    }

    /// Adopts the values in force.
    pub(super) fn reconfigure(&mut self, config: &Config) {
        self.applied = followed(config);
        self.in_motion = config.motion_factor();
    }

    /// Forgets what was estimated.
    pub(super) fn restart(&mut self) {
        self.follow = Follow::new(self.settings, self.configured);
        self.following = self.following.map(|_| Following::new(self.rules));
        self.stopped = false;
    }

    /// Factor of friction that the motion has.
    pub(super) fn motion_factor(&self) -> f64 {
        self.in_motion
    }

    /// Torque (N m) to subtract from that of a motion whose friction takes `friction` (N m), where the motion has more
    /// friction than the value in force.
    pub(super) fn excess(&self, friction: f64) -> f64 {
        (1.0 - self.applied[0] / self.in_motion) * friction
    }

    /// Takes a sample and adds to the message what it means.
    pub(super) fn push(&mut self, instant: &Instant, message: messages::Residuals) -> Pushed {
        let frozen = self.follow.push(instant);
        let estimated = Estimated::from(&self.follow);
        let bands = [0, 1].map(|k| [-1.0, 1.0].map(|side| estimated.values[k] + side * estimated.halves[k]));
        let applied = self.applied;
        let moved = self
            .following
            .as_mut()
            .map(|following| following.step(instant.step, applied, estimated, frozen));
        self.pushed(moved, [estimated.values, bands[0], bands[1]], frozen, None, message)
    }

    /// The same where plausible tools run with the twin: they are the estimate, by what the rig measures weighs of them, and
    /// there is no other one. `known` is what they say; `None` where they say nothing of friction.
    pub(super) fn push_by_tools(
        &mut self,
        instant: &Instant,
        known: Result<Option<Friction>, Late>,
        message: messages::Residuals,
    ) -> Pushed {
        let frozen = instant.unusable();
        let [_, tare] = self.applied;
        let of_tare = [-1.0, 1.0].map(|side| self.configured[1] + side * self.tare_range);
        let unknown = [[f64::NAN, tare], [f64::NAN; 2], of_tare];
        let Friction { mean, band, prior } = match known {
            Ok(Some(friction)) => friction,
            Ok(None) => return self.pushed(None, unknown, frozen, Some(TOO_FEW), message),
            Err(Late) => {
                let mut pushed = self.pushed(None, unknown, frozen, Some(LATE), message);
                LATE.clone_into(&mut pushed.message.estimate_frozen);
                return pushed;
            }
        };
        let known = [[mean, tare], band, of_tare];
        if prior[0] >= prior[1] {
            return self.pushed(None, known, frozen, Some(NOT_DRAWN), message);
        }
        // What no tool was drawn with is not followed, however well it fits.
        let [low, high] = self.rules.limits[0];
        let low = prior[0].clamp(low, high);
        let limits = [[low, prior[1].clamp(low, high)], self.rules.limits[1]];
        // The tare is among what the tools hold for possible, and does not follow.
        let estimated = Estimated {
            values: [mean, tare],
            halves: [0.5 * (band[1] - band[0]), 0.0],
        };
        let applied = self.applied;
        let moved = self.following.as_mut().map(|following| {
            following.set_limits(limits);
            following.step(instant.step, applied, estimated, frozen)
        });
        self.pushed(moved, known, frozen, None, message)
    }

    /// Adds what is known and what moves to a message. `known` has the estimates of factor and tare (N m), and the band of each;
    /// `why` says why nothing can move.
    fn pushed(
        &mut self,
        moved: Option<Moved>,
        [[factor, tare], of_factor, of_tare]: [[f64; 2]; 3],
        frozen: Option<Frozen>,
        why: Option<&str>,
        message: messages::Residuals,
    ) -> Pushed {
        let applied = self.applied;
        let message = messages::Residuals {
            friction_factor: factor,
            friction_factor_low: of_factor[0],
            friction_factor_high: of_factor[1],
            torque_tare: tare,
            torque_tare_low: of_tare[0],
            torque_tare_high: of_tare[1],
            estimate_frozen: frozen.map_or("", frozen_in_words).to_owned(),
            following: self.following.is_some(),
            applied_friction_factor: applied[0],
            configured_friction_factor: self.configured[0],
            applied_torque_tare: applied[1],
            configured_torque_tare: self.configured[1],
            following_held: match moved {
                _ if self.following.is_none() => "calibration.follow is off".to_owned(),
                Some(moved) => moved.held.map_or_else(String::new, held_in_words),
                None => why.unwrap_or_default().to_owned(),
            },
            ..message
        };
        let before = self.stopped;
        match moved.map(|moved| moved.held) {
            // A sample that does not count says nothing of limits.
            None | Some(Some(Held::Frozen(_))) => {}
            Some(held) => self.stopped = matches!(held, Some(Held::FactorAtLimit(_) | Held::TareAtLimit(_))),
        }
        Pushed {
            stopped: (self.stopped && !before).then(|| message.following_held.clone()),
            at_limit: self.stopped,
            message,
            moved: moved.and_then(|moved| moved.to).map(|to| [applied, to]),
        }
    }
}

/// How the estimate moves, and how the parameters follow it.
fn settings(config: &Config) -> (FollowSettings, FollowingSettings) {
    let given = &config.calibration;
    let limits = [
        given.follow_limits.ends(),
        [-1.0, 1.0].map(|sign| given.torque_tare_nm + sign * given.follow_tare_limit_nm),
    ];
    let estimate = FollowSettings {
        noise: given.torque_noise_nm,
        model: given.model_error,
        tare_drift: given.torque_drift_nm,
        tare_prior: given.torque_tare_range_nm / BAND,
        factor_limits: limits[0],
        tare_limits: limits[1],
        ..FollowSettings::default()
    };
    let rules = FollowingSettings {
        rates: [given.follow_rate, given.follow_tare_rate_nm],
        bands: [given.follow_band, given.follow_tare_band_nm],
        limits,
    };
    (estimate, rules)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(values: &[(&str, serde_json::Value)]) -> Config {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        config.with_values("a test", values.iter().cloned()).unwrap()
    }

    /// Drilling at a measured torque (N m), with a minute off bottom every five; the twin computes 300 N m, of which 80 N m
    /// is friction, and off bottom 40 N m of friction alone.
    fn instant(second: u32, applied: f64, factor: f64) -> Instant {
        let (bit, friction) = if second % 300 < 60 { (0.0, 40.0) } else { (220.0, 80.0) };
        Instant {
            step: 1.0,
            measured: bit + factor * friction,
            predicted: bit + applied * friction,
            friction: applied * friction,
            applied,
            good: true,
            steady: true,
        }
    }

    #[test]
    fn without_the_key_nothing_moves_and_the_message_says_so() {
        let mut estimate = Estimate::new(&config(&[]));
        for second in 0..1200 {
            let Pushed { message, moved, .. } =
                estimate.push(&instant(second, 1.0, 1.3), messages::Residuals::default());
            assert_eq!(moved, None);
            assert!(!message.following);
            assert_eq!(message.following_held, "calibration.follow is off");
            assert_eq!(
                (message.applied_friction_factor, message.configured_friction_factor),
                (1.0, 1.0)
            );
        }
        assert!(estimate.follow.factor() > 1.2, "the estimate is published all the same");
    }

    #[test]
    fn with_the_key_the_values_in_force_follow_and_a_restart_forgets() {
        let config = config(&[("calibration.follow", true.into())]);
        let mut estimate = Estimate::new(&config);
        let mut now = config.clone();
        for second in 0..3600 {
            let applied = estimate.motion_factor();
            let Pushed { message, moved, .. } =
                estimate.push(&instant(second, applied, 1.3), messages::Residuals::default());
            assert!(message.following);
            if second == 0 {
                assert!(
                    message
                        .following_held
                        .starts_with("the friction factor is known to +-0.3"),
                    "{}",
                    message.following_held
                );
            }
            let Some([from, to]) = moved else { continue };
            assert_eq!(from, followed(&now));
            let changes = changes(from, to);
            assert!(!changes.is_empty() && changes.iter().all(|change| change.asked_by == FOLLOW));
            let values = changes.iter().map(|change| (&change.name, change.value));
            now = now.with_live_values("following", values).unwrap();
            estimate.reconfigure(&now);
        }
        // The estimate begins at 1 with a standard deviation of 0.2, which an hour of samples outweighs.
        assert!(
            (now.calibration.friction_factor - 1.3).abs() < 0.1,
            "{:?}",
            now.calibration
        );
        assert!(now.calibration.torque_tare_nm.abs() < 8.0, "{:?}", now.calibration);
        estimate.restart();
        assert_eq!((estimate.follow.factor(), estimate.follow.tare()), (1.0, 0.0));
    }

    /// A torque sensor that shows less than the truth moves the values, and the motion keeps the friction that it began with.
    #[test]
    fn less_friction_is_followed_by_what_is_expected_and_not_by_the_motion() {
        let begun = config(&[("calibration.follow", true.into())]);
        let mut estimate = Estimate::new(&begun);
        let mut now = begun.clone();
        for second in 0..3600 {
            let sample = instant(second, estimate.motion_factor(), 0.7);
            let friction = sample.friction;
            let pushed = estimate.push(&sample, messages::Residuals::default());
            if let Some([from, to]) = pushed.moved {
                let changes = changes(from, to);
                let values = changes.iter().map(|change| (&change.name, change.value));
                now = now.with_live_values("following", values).unwrap();
                estimate.reconfigure(&now);
            }
            let followed = now.calibration.friction_factor;
            assert!((friction - estimate.excess(friction) - followed * friction).abs() < 1e-9);
        }
        assert!(
            (now.calibration.friction_factor - 0.7).abs() < 0.1,
            "{:?}",
            now.calibration
        );
        let [was, is] = [&begun, &now].map(|config| config.live().inner_friction);
        assert_eq!(is[0], was[0], "around the hole");
        assert!(is[1] < 0.8 * was[1], "along the hole: {is:?}");
        // A client without following sets what it says.
        let set = config(&[]).with_live_values("a client", [(FOLLOWED[0], 0.7)]).unwrap();
        assert_eq!(set.live().inner_friction[0], 0.7 * was[0]);
    }

    /// Plausible tools that come to a friction by their weights, with this band, of a prior from 0.75 to 1.25.
    fn friction(mean: f64, half: f64) -> Friction {
        Friction {
            mean,
            band: [mean - half, mean + half],
            prior: [0.75, 1.25],
        }
    }

    #[test]
    fn the_value_in_force_follows_plausible_tools_within_what_was_possible_and_no_faster() {
        let config = config(&[("calibration.follow", true.into())]);
        for (mean, end) in [(1.1, 1.1), (0.9, 0.9), (1.6, 1.25), (0.5, 0.75)] {
            let mut estimate = Estimate::new(&config);
            let mut now = config.clone();
            let mut stopped = Vec::new();
            for second in 0..1200 {
                // The torque is that of twice the friction: it is the tools that are followed, and nothing else.
                let sample = instant(second, estimate.motion_factor(), 2.0);
                let pushed =
                    estimate.push_by_tools(&sample, Ok(Some(friction(mean, 0.1))), messages::Residuals::default());
                stopped.extend(pushed.stopped);
                let Some([from, to]) = pushed.moved else { continue };
                // 0.02 per minute.
                assert!(
                    (to[0] - from[0]).abs() <= 0.02 / 60.0 + 1e-12 && to[1] == from[1],
                    "{from:?} {to:?}"
                );
                let changes = changes(from, to);
                let values = changes.iter().map(|change| (&change.name, change.value));
                now = now.with_live_values("following", values).unwrap();
                estimate.reconfigure(&now);
            }
            assert!((followed(&now)[0] - end).abs() < 1e-9, "{mean}: {:?}", followed(&now));
            assert_eq!(followed(&now)[1], followed(&config)[1]);
            assert_eq!(stopped.len(), usize::from(mean != end), "{mean}: {stopped:?}");
        }
    }

    #[test]
    fn plausible_tools_that_know_little_or_nothing_are_not_followed_and_the_message_says_why() {
        let config = config(&[("calibration.follow", true.into())]);
        let mut estimate = Estimate::new(&config);
        let same = Friction {
            prior: [1.0; 2],
            ..friction(1.0, 0.0)
        };
        for (known, words) in [
            (Err(Late), LATE),
            (Ok(None), TOO_FEW),
            (Ok(Some(same)), NOT_DRAWN),
            (
                Ok(Some(friction(1.2, 0.3))),
                "the friction factor is known to +-0.30 only, +-0.15 is required",
            ),
        ] {
            let sample = instant(0, 1.0, 1.0);
            let Pushed { message, moved, .. } = estimate.push_by_tools(&sample, known, messages::Residuals::default());
            assert_eq!(moved, None);
            assert!(message.following_held.starts_with(words), "{}", message.following_held);
            assert_eq!(message.friction_factor.is_finite(), matches!(known, Ok(Some(_))));
            assert_eq!(message.estimate_frozen == LATE, known.is_err());
        }
        let unsteady = Instant {
            steady: false,
            ..instant(0, 1.0, 1.0)
        };
        let known = Some(friction(1.2, 0.1));
        let Pushed { message, moved, .. } =
            estimate.push_by_tools(&unsteady, Ok(known), messages::Residuals::default());
        assert_eq!(
            (moved, message.following_held.as_str()),
            (None, "the motion is not steady")
        );
        assert_eq!(
            [message.friction_factor_low, message.friction_factor_high],
            [1.2 - 0.1, 1.2 + 0.1]
        );
    }

    #[test]
    fn limits_and_frozen_samples_are_named() {
        let limited = [
            ("calibration.follow", true.into()),
            ("calibration.follow_limits.high", 1.1.into()),
        ];
        let mut estimate = Estimate::new(&config(&limited));
        let mut said = Vec::new();
        for second in 0..1200 {
            said.extend(
                estimate
                    .push(&instant(second, 1.0, 1.5), messages::Residuals::default())
                    .stopped,
            );
        }
        assert_eq!(said, ["the friction factor is at its limit of 1.1"], "said once");
        for (wrong, words) in [
            (
                Instant {
                    good: false,
                    steady: false,
                    ..instant(100, 1.0, 1.0)
                },
                "an input is not good",
            ),
            (
                Instant {
                    steady: false,
                    ..instant(100, 1.0, 1.0)
                },
                "the motion is not steady",
            ),
            (
                Instant {
                    measured: f64::NAN,
                    ..instant(100, 1.0, 1.0)
                },
                "a value is missing",
            ),
            (
                Instant {
                    measured: 9e3,
                    ..instant(100, 1.0, 1.0)
                },
                "the sample is far from what is expected",
            ),
        ] {
            let Pushed { message, moved, .. } = estimate.push(&wrong, messages::Residuals::default());
            assert_eq!((moved, message.following_held.as_str()), (None, words));
            assert_eq!(message.estimate_frozen, words);
        }
    }
}
