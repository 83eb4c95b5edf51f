//! The alarm "friction near stuck": friction rises towards where the largest pull at the rig no longer reaches the bit.
//!
//! The friction is that of the running estimate, or of the plausible tools, as `twin/residuals` has it. The factor at which
//! nothing more arrives is computed once, by [`flexdrill_trip`].

use super::finding::Finding;
use super::sentence::number;
use crate::messages::Residuals;
use flexdrill_alarms::{Priority, Time};
use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, n_to_kn};
use flexdrill_trip::{Assembly, Limits};

/// Time without a known friction for which a standing alarm remains (ns): a connection lasts some minutes.
pub(super) const OUTLASTS: Time = 600_000_000_000;
/// Shares of the critical friction from which on the alarm has a priority.
const LEVELS: [(f64, Priority); 3] = [(0.95, Priority::High), (0.85, Priority::Medium), (0.7, Priority::Low)];
/// Part of the critical friction by which friction must fall below a level before its priority ends.
const HYSTERESIS: f64 = 0.05;
/// Half width of the band of the friction, over the friction, above which it is not known well enough to be judged: the
/// estimate begins with 0.33, before anything was measured.
const KNOWN: f64 = 0.25;

/// What the largest pull does against friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reserve {
    /// Factor on the friction of the configuration without `calibration.friction_factor` at which the pull no longer reaches
    /// the bit.
    critical: f64,
    /// Hook load that the limits allow (N).
    pull: f64,
    /// Pull at the bit by the friction of the configuration (N).
    at_bit: f64,
}

impl Reserve {
    /// Of a configuration with the bit on the bottom. None without `string.largest_pull_kn`, and where nothing can be computed
    /// or friction cannot become so large.
    pub(super) fn of(config: &Config) -> Option<Self> {
        let limits = Limits {
            pull: kn_to_n(config.string.largest_pull_kn?),
            guide: config.string.largest_guide_pull_kn.map(kn_to_n),
            torque: config.string.top_drive.torque_limit,
        };
        // The estimate is a factor on the friction of both layers without the factor in force.
        let without = config.with_value("calibration.friction_factor", 1.0).ok()?;
        let assembly = Assembly::of(&without).ok()?;
        let [_, bottom] = assembly.depths();
        let stuck = assembly.stuck(bottom, &limits).ok()?;
        Some(Self {
            critical: stuck.critical_factor?,
            pull: stuck.pull,
            at_bit: stuck.at_bit,
        })
    }

    /// The finding on a friction; none while that is not known. `stands` is the priority with which the alarm stands.
    pub(super) fn finding(&self, residuals: &Residuals, stands: Option<Priority>) -> Option<Finding> {
        let friction = residuals.friction_factor;
        let half = 0.5 * (residuals.friction_factor_high - residuals.friction_factor_low);
        // NaN fails the comparison.
        let is_known = half <= KNOWN * friction;
        if !is_known {
            return None;
        }
        // A pull that lifts less than hangs is near stuck at any friction.
        let share = if self.critical > 0.0 {
            friction / self.critical
        } else {
            f64::INFINITY
        };
        let level = LEVELS.into_iter().find_map(|(level, priority)| {
            let held = stands.is_some_and(|stands| stands >= priority);
            let level = if held { level - HYSTERESIS } else { level };
            (share >= level).then_some((level, priority))
        });
        Some(level.map_or_else(Finding::default, |(threshold, priority)| {
            self.finding_at(share, threshold, priority, residuals)
        }))
    }

    fn finding_at(&self, share: f64, threshold: f64, priority: Priority, residuals: &Residuals) -> Finding {
        let write = |value: f64, digits| number(value, digits).unwrap_or_else(|| "an unknown value".to_owned());
        let [friction, low, high] = [
            residuals.friction_factor,
            residuals.friction_factor_low,
            residuals.friction_factor_high,
        ]
        .map(|factor| write(factor, 2));
        let pull = write(n_to_kn(self.pull), 0);
        let critical = write(self.critical, 2);
        Finding {
            priority: Some(priority),
            value: share.min(10.0),
            threshold,
            unit: "of the friction that takes all of the pull",
            evidence: format!(
                "Friction is {friction} times that of the configuration ({low} to {high}). At {critical} times, a hook load of {pull} \
                 kN no longer reaches the bit."
            ),
            cause: "Cuttings, a tight hole or another mud raise the friction of string and tool.".to_owned(),
            consequence: format!(
                "If the tool gets stuck now, little or nothing of the largest pull arrives at the bit; by the friction of the \
                 configuration {} kN do.",
                write(n_to_kn(self.at_bit), 0)
            ),
            what_to_do: "Pick up off bottom, rotate and circulate until torque and hook load are those of the last connection. Do \
                         not stop the string for long. If friction rises on, pull out to the kick-off and call the engineer."
                .to_owned(),
            what_the_engineer_can_do: "Compare with flexdrill trip, which says where the pull ends and which range plausible tools \
                                       have. Check string.largest_pull_kn, string.largest_guide_pull_kn and \
                                       string.friction.coefficient; the same factor is taken for the string and the tool. \
                                       Differential sticking and a bed of cuttings hold with forces that friction does not show."
                .to_owned(),
            ..Finding::default()
        }
    }
}
