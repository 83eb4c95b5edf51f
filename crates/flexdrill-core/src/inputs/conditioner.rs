//! Input conditioning: every sample from the rig is taken or refused here, ages, and becomes a target.

use super::{InputKind, InputRoute, InputRule, InputRules, InputState, Rejection, RejectionReason, Stamp};
use crate::inputs::Inputs;

/// Keeps the last good sample of each input and what became of the others.
///
/// Times are seconds on any one clock that the caller chooses; they need not begin at 0.
#[derive(Debug, Clone)]
pub struct Conditioner {
    rules: InputRules,
    channels: [Channel; 2],
}

/// What became of the samples of one input.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Samples taken.
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
    /// Of the newest sample, if that was refused.
    refused: Option<Rejection>,
    /// When the first sample since the last good one was refused.
    refusing_since: Option<f64>,
    last_rejection: Option<Rejection>,
    counts: Counts,
    /// Target at the last change of rules, while there has been no good sample since: the target goes on from here.
    carried: Option<Sample>,
}

/// A value (r/min or kN) at a time (s).
#[derive(Debug, Clone, Copy)]
struct Sample {
    value: f64,
    time: f64,
}

impl Conditioner {
    /// Without any sample yet.
    pub fn new(rules: InputRules) -> Self {
        Self {
            rules,
            channels: [Channel::default(); 2],
        }
    }

    /// Changes limits, ages and safe values at `now` (s); samples seen are kept. No change of rules raises a target: each
    /// goes on from its present value until the next good sample.
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

    /// Takes or refuses a sample (r/min or kN) received at `time` (s).
    ///
    /// # Errors
    /// Says why the sample was refused; the last good one stays.
    pub fn offer(&mut self, kind: InputKind, value: f64, time: f64) -> Result<(), Rejection> {
        let last_time = self.channels[kind.index()].good.map(|sample| sample.time);
        let judged = judge(self.rule(kind), value, time, last_time);
        self.take(kind, InputRoute::Plain, value, time, time, judged)
    }

    /// The same of a sample that says when it was measured and how good it is: its age counts from then.
    ///
    /// # Errors
    /// As [`Conditioner::offer`]; and when its source calls it bad, or its stamp is older than `max_age` or further
    /// ahead of the clock than `stamp.max_skew`.
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
        self.take(kind, InputRoute::Stamped, value, measured, time, judged)
    }

    /// Keeps what was judged; `measured` and `time` (of arrival) are on the same clock.
    fn take(
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
                // An old sample that comes late says nothing about the newest.
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
            None => InputState::NotReceived,
            Some(age) if age >= rule.slow_age => InputState::Slow,
            Some(_) => InputState::Ok,
        }
    }

    /// Time (s) for which there has been no good sample: since the last one, or since the first that was refused where
    /// there has been none; `None` before any sample.
    pub fn without_good(&self, kind: InputKind, now: f64) -> Option<f64> {
        let channel = &self.channels[kind.index()];
        let since = channel.good.map(|sample| sample.time).or(channel.refusing_since);
        since.map(|time| age(now, time))
    }

    /// Whether the input has been without a good sample for so long that it is on its way to its safe value, or there.
    pub fn is_brought_to_safe(&self, kind: InputKind, now: f64) -> bool {
        self.beyond_hold(kind, now).is_some()
    }

    /// Time (s) since the end of the hold; `None` before.
    fn beyond_hold(&self, kind: InputKind, now: f64) -> Option<f64> {
        let rule = self.rule(kind);
        let over = self.without_good(kind, now)? - rule.max_age - rule.hold_before_safe;
        (over > 0.0).then_some(over)
    }

    /// The worse of both inputs' states.
    pub fn quality(&self, now: f64) -> InputState {
        self.state(InputKind::RotarySpeed, now)
            .worse(self.state(InputKind::WeightOnBit, now))
    }

    /// Age (s) of the last good sample; `None` before the first.
    pub fn age(&self, kind: InputKind, now: f64) -> Option<f64> {
        self.channels[kind.index()].good.map(|sample| age(now, sample.time))
    }

    /// The last good sample as taken (r/min or kN); `None` before the first.
    pub fn last_good(&self, kind: InputKind) -> Option<f64> {
        self.channels[kind.index()].good.map(|sample| sample.value)
    }

    /// What became of the samples so far.
    pub fn counts(&self, kind: InputKind) -> Counts {
        self.channels[kind.index()].counts
    }

    /// The sample refused last, whatever came after it.
    pub fn last_rejection(&self, kind: InputKind) -> Option<Rejection> {
        self.channels[kind.index()].last_rejection
    }

    /// What is asked for at `now` (s), in the unit of the samples: the last good value, held while it ages, then
    /// brought to the safe value; the start value before the first good sample, held and brought to the safe value too
    /// where all samples are refused.
    ///
    /// A silent rig is never sped up or loaded further: a safe value beyond the value that is held, or of the other sign,
    /// acts as the held value or as zero. Always within the limits, except that a minimum that was raised above the held
    /// value does not raise it.
    pub fn target(&self, kind: InputKind, now: f64) -> f64 {
        let rule = self.rule(kind);
        let carried = self.channels[kind.index()].carried;
        let held = carried
            .map(|carried| carried.value)
            .or(self.last_good(kind))
            .unwrap_or(rule.initial);
        let value = match self.beyond_hold(kind, now) {
            Some(over) => {
                // A changed rule ramps from the value at the change, not from that at the end of the hold.
                let over = carried.map_or(over, |carried| over.min(age(now, carried.time)));
                towards(held, not_beyond(rule.safe, held), rule.safe_ramp * over)
            }
            None => held,
        };
        // `max` and `min` instead of `clamp`, which panics on limits that are not in order.
        let limited = value.max(rule.min).min(rule.max);
        if limited.abs() > held.abs() { held } else { limited }
    }

    /// What the twin is asked for at `now` (s), SI.
    pub fn targets(&self, now: f64) -> Inputs {
        let si = |kind: InputKind| kind.to_si(self.target(kind, now));
        Inputs {
            rotary_speed: si(InputKind::RotarySpeed),
            weight_on_bit: si(InputKind::WeightOnBit),
        }
    }

    /// To be called when the caller's clock was set anew (a simulated clock that started over): the samples' ages count
    /// from `now` on, and no sample is refused for being before them.
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

/// The value to take, or why not.
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

/// Never negative: a sample can be stamped a little after `now` is read.
fn age(now: f64, time: f64) -> f64 {
    (now - time).max(0.0)
}

/// `value` where it lies between zero and `held`, else the nearer of the two.
fn not_beyond(value: f64, held: f64) -> f64 {
    value.max(held.min(0.0)).min(held.max(0.0))
}

fn towards(from: f64, to: f64, by: f64) -> f64 {
    if from > to {
        (from - by).max(to)
    } else {
        (from + by).min(to)
    }
}
