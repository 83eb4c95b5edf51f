//! Input conditioning: accepts or refuses every sample of the rig, tracks its age, and derives the target from it.

use super::{InputKind, InputRoute, InputRule, InputRules, InputState, Rejection, RejectionReason, Stamp};
use crate::inputs::Inputs;

/// Keeps the last good sample of each input, and counts the others.
///
/// Times are seconds on any one clock that the caller chooses; they need not begin at 0.
#[derive(Debug, Clone)]
pub struct Conditioner {
    rules: InputRules,
    channels: [Channel; InputKind::COUNT],
}

/// Accepted and refused samples of one input.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Samples accepted.
    pub accepted: u64,
    /// Refused, by [`RejectionReason::index`].
    pub rejected: [u64; RejectionReason::COUNT],
}

impl Counts {
    /// Refused for any reason.
    pub fn rejected_total(&self) -> u64 {
        self.rejected.iter().sum()
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Channel {
    good: Option<Sample>,
    /// The refusal of the newest sample, if it was refused.
    refused: Option<Rejection>,
    /// Time of the first refusal since the last good sample.
    refusing_since: Option<f64>,
    last_rejection: Option<Rejection>,
    counts: Counts,
    /// Target at the last change of rules, until the next good sample: the target continues from this value.
    carried: Option<Sample>,
}

/// A value, in the unit of the input's samples, at a time (s).
#[derive(Debug, Clone, Copy)]
struct Sample {
    value: f64,
    time: f64,
}

impl Conditioner {
    /// A conditioner that has received no sample.
    pub fn new(rules: InputRules) -> Self {
        Self {
            rules,
            channels: [Channel::default(); InputKind::COUNT],
        }
    }

    /// Changes limits, ages and safe values at `now` (s); samples are kept. No change of rules raises a target: each
    /// continues from its present value until the next good sample.
    pub fn set_rules(&mut self, rules: InputRules, now: f64) {
        for kind in InputKind::ALL {
            let value = self.target(kind, now);
            self.channels[kind.index()].carried = Some(Sample { value, time: now });
        }
        self.rules = rules;
    }

    /// The rule of an input.
    pub fn rule(&self, kind: InputKind) -> &InputRule {
        &self.rules[kind.index()]
    }

    /// Accepts or refuses a sample ([`InputKind::unit`]) received at `time` (s).
    ///
    /// # Errors
    /// The reason for which the sample was refused; the last good one stays.
    pub fn offer(&mut self, kind: InputKind, value: f64, time: f64) -> Result<(), Rejection> {
        let last_time = self.channels[kind.index()].good.map(|sample| sample.time);
        let judged = judge(self.rule(kind), value, time, last_time);
        self.record(kind, InputRoute::Plain, value, time, time, judged)
    }

    /// The same for a sample with the time of its measurement and its quality: its age counts from that time.
    ///
    /// # Errors
    /// As [`Conditioner::offer`], and when its source marks it as bad, or its stamp is older than `max_age` or more
    /// than `stamp.max_skew` ahead of the clock.
    pub fn offer_stamped(&mut self, kind: InputKind, value: f64, time: f64, stamp: &Stamp) -> Result<(), Rejection> {
        let rule = self.rule(kind);
        let measured = time - stamp.age.max(0.0);
        let judged = if stamp.bad {
            Err(RejectionReason::Bad)
        } else if !stamp.age.is_finite() {
            Err(RejectionReason::NotFinite)
        } else if stamp.age < -stamp.max_skew {
            Err(RejectionReason::FromFuture {
                by: -stamp.age,
                max_skew: stamp.max_skew,
            })
        } else if stamp.age >= rule.max_age {
            Err(RejectionReason::TooOld {
                age: stamp.age,
                max_age: rule.max_age,
            })
        } else {
            let last_time = self.channels[kind.index()].good.map(|sample| sample.time);
            judge(rule, value, measured, last_time)
        };
        self.record(kind, InputRoute::Stamped, value, measured, time, judged)
    }

    /// Records the verdict on a sample; `measured` and `time` (of arrival) are on the same clock.
    fn record(
        &mut self,
        kind: InputKind,
        route: InputRoute,
        value: f64,
        measured: f64,
        time: f64,
        judged: Result<f64, RejectionReason>,
    ) -> Result<(), Rejection> {
        let channel = &mut self.channels[kind.index()];
        match judged {
            Ok(value) => {
                channel.good = Some(Sample { value, time: measured });
                channel.refused = None;
                channel.refusing_since = None;
                channel.carried = None;
                channel.counts.accepted += 1;
                Ok(())
            }
            Err(reason) => {
                let rejection = Rejection {
                    kind,
                    route,
                    value,
                    time,
                    reason,
                };
                channel.counts.rejected[reason.index()] += 1;
                channel.last_rejection = Some(rejection);
                // A late sample has no bearing on the state of the newest one.
                if !matches!(reason, RejectionReason::TimeBackwards { .. }) {
                    channel.refused = Some(rejection);
                    channel.refusing_since = channel.refusing_since.or(Some(time).filter(|time| time.is_finite()));
                }
                Err(rejection)
            }
        }
    }

    /// State of an input at `now` (s).
    pub fn state(&self, kind: InputKind, now: f64) -> InputState {
        let (channel, rule) = (&self.channels[kind.index()], self.rule(kind));
        let silence = self.without_good(kind, now);
        if silence.is_some_and(|silence| silence >= rule.max_age) {
            return InputState::Stale;
        }
        if let Some(rejection) = channel.refused
            && age(now, rejection.time) < rule.max_age
        {
            return InputState::Rejected;
        }
        match self.age(kind, now) {
            None if kind.is_optional() => InputState::Assumed,
            None => InputState::NotReceived,
            Some(age) if age >= rule.slow_age => InputState::Slow,
            Some(_) => InputState::Ok,
        }
    }

    /// Time (s) without a good sample: since the last one, or since the first refusal if none was good; `None` before
    /// any sample.
    pub fn without_good(&self, kind: InputKind, now: f64) -> Option<f64> {
        let channel = &self.channels[kind.index()];
        let since = channel.good.map(|sample| sample.time).or(channel.refusing_since);
        since.map(|time| age(now, time))
    }

    /// Whether the hold has ended, so that the target is on its ramp to the safe value, or there.
    pub fn is_brought_to_safe(&self, kind: InputKind, now: f64) -> bool {
        self.time_since_hold(kind, now).is_some()
    }

    /// Time (s) since the end of the hold; `None` before.
    fn time_since_hold(&self, kind: InputKind, now: f64) -> Option<f64> {
        let rule = self.rule(kind);
        let over = self.without_good(kind, now)? - rule.max_age - rule.hold_before_safe;
        (over > 0.0).then_some(over)
    }

    /// The worst state of the inputs that the tool uses. An optional input that was never sent does not count.
    pub fn quality(&self, now: f64) -> InputState {
        // A rate of penetration that was sent acts on the friction at the wall under every law.
        let acts = |kind: &InputKind| self.rule(*kind).used || *kind == InputKind::RateOfPenetration;
        let used = InputKind::ALL.into_iter().filter(acts);
        used.map(|kind| self.state(kind, now))
            .fold(InputState::Ok, InputState::worse)
    }

    /// Whether an input concerns the run: it is required, the tool uses it, a value other than zero is assumed, or a
    /// sample came.
    pub fn is_of_interest(&self, kind: InputKind) -> bool {
        let (rule, counts) = (self.rule(kind), self.counts(kind));
        !kind.is_optional() || rule.used || rule.initial != 0.0 || counts.accepted + counts.rejected_total() > 0
    }

    /// Age (s) of the last good sample; `None` before the first.
    pub fn age(&self, kind: InputKind, now: f64) -> Option<f64> {
        self.channels[kind.index()].good.map(|sample| age(now, sample.time))
    }

    /// The last good sample ([`InputKind::unit`]); `None` before the first.
    pub fn last_good(&self, kind: InputKind) -> Option<f64> {
        self.channels[kind.index()].good.map(|sample| sample.value)
    }

    /// Accepted and refused samples so far.
    pub fn counts(&self, kind: InputKind) -> Counts {
        self.channels[kind.index()].counts
    }

    /// The sample refused last; later good samples do not clear it.
    pub fn last_rejection(&self, kind: InputKind) -> Option<Rejection> {
        self.channels[kind.index()].last_rejection
    }

    /// The target at `now` (s), in the unit of the samples: the last good value, held while it ages, then ramped to the
    /// safe value. Before the first good sample it is the start value, which is held and ramped in the same way while
    /// all samples are refused.
    ///
    /// Silence never raises speed or load: a safe value larger than the held value acts as the held value, one of the
    /// other sign as zero. The target is always within the limits, except that a minimum raised above the held value
    /// does not raise the target.
    pub fn target(&self, kind: InputKind, now: f64) -> f64 {
        let rule = self.rule(kind);
        let carried = self.channels[kind.index()].carried;
        let held = carried
            .map(|carried| carried.value)
            .or(self.last_good(kind))
            .unwrap_or(rule.initial);
        let value = match self.time_since_hold(kind, now) {
            Some(over) => {
                // A changed rule ramps from the value at the change, not from that at the end of the hold.
                let over = carried.map_or(over, |carried| over.min(age(now, carried.time)));
                towards(held, between_zero_and(held, rule.safe), rule.safe_ramp * over)
            }
            None => held,
        };
        // `max` and `min` instead of `clamp`, which panics on limits that are not in order.
        let limited = value.max(rule.min).min(rule.max);
        if limited.abs() > held.abs() { held } else { limited }
    }

    /// The twin's targets at `now` (s), SI.
    pub fn targets(&self, now: f64) -> Inputs {
        let si = |kind: InputKind| kind.to_si(self.target(kind, now));
        Inputs {
            rotary_speed: si(InputKind::RotarySpeed),
            weight_on_bit: si(InputKind::WeightOnBit),
            rate_of_penetration: si(InputKind::RateOfPenetration),
            standpipe_pressure: si(InputKind::StandpipePressure),
        }
    }

    /// Restarts the ages of all samples at `now`, after the caller's clock was set (a simulated clock that restarted),
    /// so that no sample is refused for preceding the earlier ones.
    pub fn clock_set(&mut self, now: f64) {
        for channel in &mut self.channels {
            if let Some(sample) = &mut channel.good {
                sample.time = now;
            }
            if let Some(rejection) = &mut channel.refused {
                rejection.time = now;
            }
            if let Some(since) = &mut channel.refusing_since {
                *since = now;
            }
            if let Some(carried) = &mut channel.carried {
                carried.time = now;
            }
        }
    }
}

/// The accepted value, or the reason for a refusal.
fn judge(rule: &InputRule, value: f64, time: f64, last_time: Option<f64>) -> Result<f64, RejectionReason> {
    if let Some(last) = last_time
        && time < last
    {
        return Err(RejectionReason::TimeBackwards { by: last - time });
    }
    if !value.is_finite() || !time.is_finite() {
        return Err(RejectionReason::NotFinite);
    }
    let value = if rule.min >= 0.0 && value < 0.0 {
        if value < -rule.tare_error {
            return Err(if rule.tare_error > 0.0 {
                RejectionReason::Negative {
                    tare_error: rule.tare_error,
                }
            } else {
                RejectionReason::BelowMinimum { min: rule.min }
            });
        }
        0.0
    } else {
        value
    };
    if value < rule.min {
        return Err(RejectionReason::BelowMinimum { min: rule.min });
    }
    if value > rule.max {
        return Err(RejectionReason::AboveMaximum { max: rule.max });
    }
    Ok(value)
}

/// Age of a sample, at least 0: its stamp can be slightly later than the reading of `now`.
fn age(now: f64, time: f64) -> f64 {
    (now - time).max(0.0)
}

/// `value` limited to the range from zero to `held`.
fn between_zero_and(held: f64, value: f64) -> f64 {
    value.max(held.min(0.0)).min(held.max(0.0))
}

/// `from` moved towards `to` by at most `most`.
fn towards(from: f64, to: f64, most: f64) -> f64 {
    if from > to {
        (from - most).max(to)
    } else {
        (from + most).min(to)
    }
}
