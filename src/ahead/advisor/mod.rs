//! Advice from look-aheads, between the alarms, which a node has on another thread, and who looks ahead.
//!
//! Time is that of a clock of the host (s): a node's steady clock, a replay's model time.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::advice::SearchProgress;
use crate::alarms::{AlarmBook, Leading, Tested, Trial};
use crate::rig_inputs::Fluctuation;
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::LiveParameters;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_motion::WhirlSettings;

/// Time for which the same alarm leads at the same speed and weight before a search begins (s).
const SETTLED: f64 = 2.0;
/// Time (s) for which what is set must count as another, where it is near. Of a weight of 18 kN that scatters by 1.2 kN, medians
/// of ten seconds differ by a deviation of 0.7 kN: one pair in forty by the 1.5 kN that count as another weight, and a
/// search that ends with each of them has no answer for minutes. Ten seconds later none of the samples is the same.
const AWAY: f64 = 10.0;
/// Model time (s) that a search takes until its first answer, where one direction of change helps: two changes that show
/// which, two that show how much, and four members that confirm it.
const USUAL: f64 = 180.0;
/// Part of a coefficient of friction by which it may change: a torque follows it by as much, and a torque gauge shows
/// no less.
const SAME_FRICTION: f64 = 0.05;
/// Part of a rate of penetration and of a pressure by which they may change, and changes (m/s, Pa) that are none: a
/// block moves in jerks, and a pump's strokes ripple the pressure.
const SAME_FEED: f64 = 0.1;
const LEAST_FEED: f64 = 1.0 / 3600.0;
const LEAST_PRESSURE: f64 = 0.2e6;

/// The parameters in force that an answer depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InForce {
    /// Friction and bit coefficients.
    live: LiveParameters,
    /// Thresholds of the whirl analysis.
    whirl: WhirlSettings,
    /// Slew limits of the inputs.
    slew: [f64; 4],
    /// Limits of speed (r/min) and weight (kN).
    limits: [[f64; 2]; 2],
    /// Speeds and weights that count as the same.
    fluctuation: Fluctuation,
}

impl InForce {
    /// Of a configuration.
    pub fn of(config: &Config) -> Self {
        let (speed, weight) = (&config.inputs.rotary_speed, &config.inputs.weight_on_bit);
        Self {
            live: config.live(),
            whirl: config.whirl_settings(),
            slew: config.simulation().slew(),
            limits: [[speed.min_rpm, speed.max_rpm], [weight.min_kn, weight.max_kn]],
            fluctuation: Fluctuation::of(&config.inputs),
        }
    }

    /// The coefficients, which may follow the rig by small moves; all others change by hand.
    fn coefficients(&self) -> [f64; 5] {
        let LiveParameters {
            inner_friction: [a, b],
            outer_friction: [c, d],
            bit_friction_factor,
        } = self.live;
        [a, b, c, d, bit_friction_factor]
    }

    fn has_stayed(&self, now: &Self) -> bool {
        let mut coefficients = self.coefficients().into_iter().zip(now.coefficients());
        coefficients.all(|(then, now)| near([then, now], SAME_FRICTION, 0.0))
            && *self
                == Self {
                    live: self.live,
                    ..*now
                }
    }
}

/// What acts on the tool while an alarm stands, and what its motion is judged by. Advice holds for as long as that
/// stays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Acting {
    /// What the driller has set.
    set: Inputs,
    parameters: InForce,
}

impl Acting {
    /// Under what is set, with the parameters in force.
    pub fn new(set: Inputs, parameters: &InForce) -> Self {
        Self {
            set,
            parameters: *parameters,
        }
    }

    /// Whether all but speed and weight has stayed.
    fn has_stayed(&self, now: &Self) -> bool {
        let (then, new) = (&self.set, &now.set);
        let feeds = [then.rate_of_penetration, new.rate_of_penetration];
        let pressures = [then.standpipe_pressure, new.standpipe_pressure];
        near(feeds, SAME_FEED, LEAST_FEED)
            && near(pressures, SAME_FEED, LEAST_PRESSURE)
            && self.parameters.has_stayed(&now.parameters)
    }

    /// Whether all of it is the same.
    fn is(&self, now: &Self) -> bool {
        self.is_within(now, 1.0)
    }

    /// Whether all of it may be the same on a rig that wavers: speed and weight differ by twice what counts as the same.
    fn may_be(&self, now: &Self) -> bool {
        self.is_within(now, 2.0)
    }

    /// Whether speed and weight differ by `times` what counts as the same, and all else has stayed.
    fn is_within(&self, now: &Self, times: f64) -> bool {
        let at = |set: &Inputs| [set.rotary_speed, set.weight_on_bit];
        let (then, now_at) = (at(&self.set), at(&now.set));
        let part = [0, 1].map(|of| then[of] + (now_at[of] - then[of]) / times);
        self.parameters.fluctuation.covers(then, part) && self.has_stayed(now)
    }
}

/// Whether two values differ by a part of the larger, or by `least`, at most.
fn near([a, b]: [f64; 2], part: f64, least: f64) -> bool {
    (a - b).abs() <= (part * a.abs().max(b.abs())).max(least)
}

/// What a search is for.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// The alarm that leads, and those that stand.
    pub leading: Leading,
    /// What acts.
    acting: Acting,
    since: f64,
}

impl Asked {
    /// Whether it is for these alarms or for more: one that ends meanwhile does not end the search, one that returns
    /// was searched for, and which of them leads changes nothing, because all that stand are to end.
    fn covers(&self, leading: &Leading) -> bool {
        let Leading { standing, shelved, .. } = self.leading;
        leading.standing.is_within(standing) && leading.shelved.is_within(standing.union(shelved))
    }

    fn is_for(&self, leading: &Leading, acting: &Acting) -> bool {
        self.covers(leading) && self.acting.is(acting)
    }
}

/// How far a search is.
#[derive(Debug, Clone, Copy)]
struct Course {
    began: f64,
    /// Model time of its members (s).
    seconds: f64,
    /// Model time of members per second, of this search or of the one before; none before the first members.
    speed: Option<f64>,
    /// Whether its first answer is out.
    has_said: bool,
}

impl Course {
    /// Seconds until an answer, in tens; none before that is known, and once the search takes longer than others.
    fn remaining(&self, now: f64) -> Option<u64> {
        let since = now - self.began;
        let whole = USUAL / self.speed.filter(|speed| *speed > 0.0)?;
        (whole > since).then(|| 10 * ((whole - since) / 10.0).ceil() as u64)
    }
}

#[derive(Debug, Default)]
struct Exchange {
    asked: Option<Asked>,
    /// The last search that came to its end, and what it found.
    answered: Option<(Asked, Option<Tested>)>,
    /// What a search has found that more of its members are to confirm.
    first: Option<(Asked, Tested)>,
    /// Whether that search tried anything: the state of the run may not be had.
    tried: bool,
    /// When the last search began, how much model time its members have taken (s), and whether it has said something.
    course: Option<Course>,
    /// Since when what is set counts as another one that is near.
    away: Option<f64>,
    /// Ends the running search.
    stop: Option<Arc<AtomicBool>>,
    /// Ends the running forecast, which yields to goals and searches.
    forecast: Option<Arc<AtomicBool>>,
    /// Whether no goal interrupts the search and the forecast.
    kept: bool,
}

/// What is asked and what was found.
#[derive(Debug, Default)]
pub struct Advisor(Mutex<Exchange>);

impl Advisor {
    fn lock(&self) -> MutexGuard<'_, Exchange> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the alarm that leads, with those that stand, and what acts `now`. Returns what was found for it. A search for
    /// anything else stops.
    fn follow(&self, leading: Option<Leading>, acting: &Acting, now: f64) -> Option<Tested> {
        let mut exchange = self.lock();
        let Some(leading) = leading else {
            exchange.interrupt();
            (exchange.asked, exchange.answered, exchange.first) = (None, None, None);
            return None;
        };
        let set = [
            rad_per_s_to_rpm(acting.set.rotary_speed),
            n_to_kn(acting.set.weight_on_bit),
        ];
        let acting = &exchange.settled(acting, now);
        if !exchange
            .asked
            .as_ref()
            .is_some_and(|asked| asked.is_for(&leading, acting))
        {
            exchange.interrupt();
            // Alarms that come and go do not begin the search again each time.
            let before = exchange
                .asked
                .take()
                .filter(|asked| !asked.leading.standing.common(leading.standing).is_empty());
            let before = before.filter(|asked| asked.acting.is(acting));
            let standing = before.map_or(leading.standing, |asked| asked.leading.standing.union(leading.standing));
            exchange.asked = Some(Asked {
                leading: Leading { standing, ..leading },
                acting: *acting,
                since: now,
            });
        }
        if exchange.stop.is_none() && exchange.search(now).is_some() {
            stop(&mut exchange.forecast);
        }
        let answered = exchange
            .answered
            .iter()
            .filter_map(|(asked, tested)| Some((asked, (*tested)?)));
        let first = exchange.first.iter().map(|(asked, tested)| (asked, *tested));
        let mut found = answered.chain(first);
        let holds = found.find(|(asked, tested)| asked.is_for(&leading, acting) && tested.lies_ahead(set));
        holds.map(|(_, tested)| tested)
    }

    /// Gives the alarms that stand what look-aheads have found for them, under what acts `now`.
    pub fn advise(&self, book: &mut AlarmBook, acting: &Acting, now: f64) {
        let tested = self.follow(book.leading(), acting, now);
        book.set_tested(tested, self.trial(now));
    }

    /// What is to be searched `now`, with the flag that stops the search.
    pub fn due(&self, now: f64) -> Option<(Asked, Arc<AtomicBool>)> {
        let mut exchange = self.lock();
        let asked = exchange.search(now)?.clone();
        let stop = Arc::new(AtomicBool::new(false));
        exchange.stop = Some(Arc::clone(&stop));
        exchange.course = Some(Course {
            began: now,
            seconds: 0.0,
            speed: exchange.course.and_then(|before| before.speed),
            has_said: false,
        });
        Some((asked, stop))
    }

    /// Takes how far a search is `now` that was not stopped. Its first answer holds until its last one is there, unless more of
    /// its members refute it.
    pub fn hear(&self, asked: &Asked, progress: &SearchProgress, now: f64) {
        let mut exchange = self.lock();
        let Some(course) = &mut exchange.course else { return };
        let took = now - course.began;
        course.seconds = progress.seconds;
        course.speed = (took > 0.0).then(|| progress.seconds / took);
        let is_refuted = course.has_said && progress.first.is_none();
        course.has_said = progress.first.is_some();
        if is_refuted {
            exchange.first = None;
        }
        if let Some(tested) = progress.first {
            exchange.first = Some((asked.clone(), tested));
        }
    }

    /// Takes what a search found that was not stopped.
    pub fn answer(&self, asked: Asked, tested: Option<Tested>) {
        let mut exchange = self.lock();
        exchange.stop = None;
        exchange.answered = Some((asked, tested));
        (exchange.first, exchange.tried) = (None, true);
    }

    /// Ends a search that could not try anything.
    pub fn give_up(&self, asked: Asked) {
        let mut exchange = self.lock();
        exchange.stop = None;
        exchange.answered = Some((asked, None));
        exchange.tried = false;
    }

    /// What is done `now` for the alarms of the last [`Advisor::follow`].
    fn trial(&self, now: f64) -> Trial {
        let exchange = self.lock();
        let is_answered = || {
            let (asked, answered) = (exchange.asked.as_ref()?, exchange.answered.as_ref()?);
            answered.0.is_for(&asked.leading, &asked.acting).then_some(answered.1)
        };
        match (&exchange.stop, is_answered()) {
            (Some(_), _) => Trial::Runs {
                seconds: exchange.course.and_then(|course| course.remaining(now)),
            },
            (None, Some(None)) if exchange.tried => Trial::NothingFound,
            (None, _) => Trial::Waits,
        }
    }

    /// Stops the search and the forecast that run; they begin again later if they are due.
    pub fn interrupt(&self) {
        let mut exchange = self.lock();
        exchange.interrupt();
        stop(&mut exchange.forecast);
    }

    /// As [`Advisor::interrupt`], for a goal that has come; a turn that is kept continues.
    pub fn yield_to_goal(&self) {
        let mut exchange = self.lock();
        if !exchange.kept {
            exchange.interrupt();
            stop(&mut exchange.forecast);
        }
    }

    /// Begins or ends a turn that no goal interrupts.
    pub fn keep(&self, kept: bool) {
        self.lock().kept = kept;
    }

    /// Whether no goal interrupts the search and the forecast now.
    pub fn is_kept(&self) -> bool {
        self.lock().kept
    }

    /// The flag that stops a forecast that begins now.
    pub fn forecasts(&self) -> Arc<AtomicBool> {
        let stop = Arc::new(AtomicBool::new(false));
        self.lock().forecast = Some(Arc::clone(&stop));
        stop
    }
}

impl Exchange {
    /// What is to be searched `now`.
    fn search(&self, now: f64) -> Option<&Asked> {
        let asked = self.asked.as_ref()?;
        let known = |(answered, _): &(Asked, _)| answered.is_for(&asked.leading, &asked.acting);
        let is_known = self.answered.as_ref().is_some_and(known);
        (!is_known && now - asked.since >= SETTLED).then_some(asked)
    }

    /// What acts, where a rig that wavers makes it seem another for a moment: what the search is for.
    fn settled(&mut self, acting: &Acting, now: f64) -> Acting {
        let near = self.asked.as_ref().map(|asked| asked.acting);
        let near = near.filter(|asked| !asked.is(acting) && asked.may_be(acting));
        let Some(asked) = near else {
            self.away = None;
            return *acting;
        };
        let since = *self.away.get_or_insert(now);
        if now - since < AWAY { asked } else { *acting }
    }

    fn interrupt(&mut self) {
        stop(&mut self.stop);
    }
}

fn stop(flag: &mut Option<Arc<AtomicBool>>) {
    if let Some(stop) = flag.take() {
        stop.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests;
