//! The hole ahead of a live twin: `twin/hole_ahead`.
//!
//! Once per second of model time a message has the means of what the bit does across the hole (`means`). Where they can say
//! where the tool drills (`answer`), the next metres are computed on another thread (`worker`) for the weight of an instant,
//! and used [`DELAY`] of model time later, until the weight has moved or a survey has come. Which answer a message has is a
//! function of the frames and surveys alone: where it is not there in time, the message and those behind it wait. A replay
//! gives the same messages. What was drilled is kept point by point (`drilled`), also in the file of a checkpoint (`saved`).
//! All of it reads the twin and acts on nothing.

mod answer;
mod drilled;
mod means;
mod message;
#[cfg(test)]
mod plan_tests;
mod saved;
#[cfg(test)]
mod survey_tests;
mod surveyed;
#[cfg(test)]
mod tests;
mod worker;

use std::cmp::Reverse;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use flexdrill_config::Config;
use flexdrill_core::twin::Frame;
use flexdrill_core::units::n_to_kn;
use flexdrill_hole::Survey;
use flexdrill_messages::HoleAhead;

use self::answer::standing;
use self::means::Window;
use self::worker::{Asked, Found, Worker};
use crate::drilling::tool;

pub use answer::{Ahead, Question, compute, refusal, side_force_doubt};
pub use drilled::{Appended, DrilledHole, Point, SharedPoints};
pub use means::Means;
pub use message::surveys_of;
pub use saved::{Damaged, split, with_points};

/// Model time after which an answer is used (s): several times what it takes.
pub const DELAY: f64 = 5.0;
/// Tenths of a second between two messages.
const MESSAGE: u32 = 10;
/// Share by which the weight differs from that of an answer before another is asked for.
const MOVED: f64 = 0.03;
/// Share by which it differs before that answer is no longer shown. Half of what the plausible tools differ by.
const OTHER: f64 = 0.06;
/// Seed of the plausible tools of a configuration without `ensemble`.
const SEED: u64 = 1;
/// Answers that are kept. A weight that wavers comes back to each of them: with steps of twice [`MOVED`] they reach from any
/// weight to forty times of it.
const KEPT: usize = 64;
/// Messages that may wait: half a minute. A computer that is later does not keep up.
const WAITING: usize = 30;

/// Seed of the plausible tools of a configuration.
pub fn seed(config: &Config) -> u64 {
    config.ensemble.as_ref().map_or(SEED, |ensemble| ensemble.seed)
}

/// A message before its answer.
#[derive(Debug, Clone)]
struct Draft {
    ticks: u64,
    means: Means,
    weight_that_cuts: f64,
    /// Direction of the hole at the bit against the hole's (right, low) (rad); NaN where nothing cuts.
    turn: [f64; 2],
    measured_depth: f64,
    inclination: f64,
    /// Surveys that are known.
    surveys: Arc<[Survey]>,
    /// Length of hole since the run began (m).
    drilled: f64,
    /// Ticks of the means whose answer it has, or why it has none.
    answer: Result<u64, String>,
}

/// A weight for which an answer was asked, with the surveys that were known.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Request {
    ticks: u64,
    weight: f64,
    /// Ticks from which on these surveys were known.
    surveyed: u64,
}

/// A message that is ready.
pub struct Ready {
    /// Ticks at which its means end.
    pub ticks: u64,
    /// Ticks of the means that its answer is for; none without an answer.
    pub answered: Option<u64>,
    /// All but the header and the instant of the answer.
    pub message: HoleAhead,
    /// Points of the hole that are complete with it.
    pub appended: Vec<Appended>,
}

/// What the session keeps.
pub struct LiveHole {
    config: Arc<Config>,
    /// Why nothing is known, whatever the load.
    refusal: Option<String>,
    /// Force of the wear flats (N).
    flats: f64,
    /// Ticks of [`DELAY`].
    delay: u64,
    window: Window,
    /// Surveys that are known, and the ticks from which on.
    surveys: Arc<[Survey]>,
    surveyed: u64,
    /// Tenths since the last message.
    tenths: u32,
    /// Answers that messages may have, the newest last, and the one that follows.
    current: VecDeque<Request>,
    next: Option<Request>,
    drafts: VecDeque<Draft>,
    found: BTreeMap<u64, Result<Ahead, String>>,
    worker: Option<Worker>,
    /// Whether the run waits for answers.
    waits: bool,
    /// Why there are no answers any more.
    ended: Option<String>,
    /// The hole as drilled.
    drilled: DrilledHole,
}

impl LiveHole {
    /// For a run with a configuration.
    pub fn new(config: &Arc<Config>) -> Self {
        Self {
            refusal: refusal(config),
            flats: tool::wear_flats(config),
            drilled: DrilledHole::new(&config.well),
            delay: (DELAY / config.solver.time_step).round() as u64,
            config: Arc::clone(config),
            window: Window::default(),
            surveys: Arc::default(),
            surveyed: 0,
            tenths: 0,
            current: VecDeque::new(),
            next: None,
            drafts: VecDeque::new(),
            found: BTreeMap::new(),
            worker: None,
            waits: false,
            ended: None,
        }
    }

    /// Adopts a configuration that was changed while the twin runs.
    ///
    /// Parameters that change then are frictions and limits. Of these the limits of the weight move what is said of the plan:
    /// a weight outside them must not be advised, so that an answer with the old ones is not used any more.
    pub fn reconfigure(&mut self, config: &Arc<Config>) {
        let limits = |config: &Config| [config.inputs.weight_on_bit.min_kn, config.inputs.weight_on_bit.max_kn];
        if self.config.well.plan.is_some() && limits(&self.config) != limits(config) {
            self.current.clear();
            self.next = None;
        }
        self.config = Arc::clone(config);
    }

    /// The motion begins again, in the same hole: its surveys remain.
    pub fn reset(&mut self) {
        self.window.clear();
        self.tenths = 0;
    }

    /// Takes a frame at which the alarms are judged, ten times per second: once a second it becomes a message, for which
    /// `surveys` gives those that are known.
    pub fn observe(&mut self, frame: &Frame, surveys: impl FnOnce() -> Arc<[Survey]>) {
        let snapshot = &frame.snapshot;
        self.window.push(snapshot.steering);
        if snapshot.steering.duration <= 0.0 {
            return;
        }
        self.tenths += 1;
        if self.tenths < MESSAGE {
            return;
        }
        self.tenths = 0;
        let Some(means) = self.window.means() else { return };
        let surveys = surveys();
        if surveys != self.surveys {
            (self.surveys, self.surveyed) = (surveys, frame.ticks);
        }
        let answer = self.answer_for(&means, frame.ticks);
        let law = tool::bit(&self.config, means.weight).ok();
        let turn = law.map(|law| law.turn(means.tilt.into(), means.side_force.into()));
        let last = |values: &[f64]| values.last().copied().unwrap_or(f64::NAN);
        self.drafts.push_back(Draft {
            ticks: frame.ticks,
            means,
            weight_that_cuts: law.map_or(0.0, |law| law.active_weight),
            turn: turn.map_or([f64::NAN; 2], Into::into),
            measured_depth: last(&snapshot.contacts.measured_depth),
            inclination: last(&snapshot.contacts.inclination),
            surveys: Arc::clone(&self.surveys),
            drilled: snapshot.steering.drilled,
            answer,
        });
    }

    /// The answer that means at these ticks have. Asks for another one where the weight has moved or the surveys are others.
    fn answer_for(&mut self, means: &Means, ticks: u64) -> Result<u64, String> {
        if let Some(next) = self.next.take_if(|next| next.ticks + self.delay <= ticks) {
            self.current.push_back(next);
            // A weight that is lifted and set again has its answer already.
            if self.current.len() > KEPT {
                self.current.pop_front();
            }
        }
        if let Some(why) = &self.refusal {
            return Err(why.clone());
        }
        if let Some(why) = standing(means, self.flats) {
            return Err(why);
        }
        // One answer at a time is computed: a weight that changes all the time asks once per delay.
        let weight = means.weight;
        let off = |request: &Request| (weight - request.weight).abs() / request.weight;
        // An answer for this weight counts before one with newer surveys, which follows.
        let rank = |request: &Request| (off(request) > OTHER, Reverse(request.surveyed));
        let nearer = |a: &Request, b: &Request| rank(a).cmp(&rank(b)).then(off(a).total_cmp(&off(b)));
        let best = self.current.iter().copied().min_by(nearer);
        let is_old = |request: Request| off(&request) > MOVED || request.surveyed != self.surveyed;
        let asks = self.next.is_none() && best.is_none_or(is_old);
        // An answer for another weight would look like one for this.
        let answer = match best {
            None => Err(format!(
                "the next metres are being computed: they follow within {DELAY:.0} s"
            )),
            Some(other) if off(&other) > OTHER => Err(format!(
                "the weight has changed from {:.2} to {:.2} kN: the next metres for it follow within {:.0} s",
                n_to_kn(other.weight),
                n_to_kn(weight),
                2.0 * DELAY
            )),
            Some(request) => Ok(request.ticks),
        };
        if asks {
            self.next = Some(Request {
                ticks,
                weight,
                surveyed: self.surveyed,
            });
            self.ask(ticks, weight);
        }
        answer
    }

    fn ask(&mut self, ticks: u64, weight: f64) {
        let seed = seed(&self.config);
        if self.worker.is_none() && self.ended.is_none() {
            // A run that waits has nothing else to do.
            match Worker::start(seed, !self.waits) {
                Ok(worker) => self.worker = Some(worker),
                Err(error) => self.ended = Some(format!("the computer has no thread for the next metres: {error}")),
            }
        }
        if let Some(worker) = &self.worker {
            worker.ask(Asked {
                ticks,
                weight,
                surveys: Arc::clone(&self.surveys),
                config: Arc::clone(&self.config),
            });
        }
    }

    /// The next message that is ready. Where the run can `wait`, it waits for the answer; otherwise a message that has waited
    /// for half a minute says so.
    pub fn take(&mut self, wait: bool) -> Option<Ready> {
        self.waits = wait;
        let needs = self.drafts.front()?.answer.as_ref().ok().copied();
        if let Some(ticks) = needs {
            self.hear(ticks, wait);
            let late = self.drafts.len() > WAITING;
            if !self.found.contains_key(&ticks) && self.ended.is_none() && !late {
                return None;
            }
        }
        let draft = self.drafts.pop_front()?;
        let ahead = match &draft.answer {
            Err(why) => Err(why.as_str()),
            Ok(ticks) => match self.found.get(ticks) {
                Some(found) => found.as_ref().map_err(String::as_str),
                None => Err(self
                    .ended
                    .as_deref()
                    .unwrap_or("the computer does not keep up: the next metres are half a minute late")),
            },
        };
        let message = message::message(&draft, ahead);
        // What is not known of the hole ahead is not known of the hole that is drilled.
        let shown = match (needs, ahead) {
            (Some(answered), Ok(ahead)) if message.known => Ok((answered, &ahead.track)),
            _ => Err(message.because.as_str()),
        };
        Some(Ready {
            ticks: draft.ticks,
            answered: ahead.is_ok().then_some(needs).flatten(),
            appended: self.drilled.grow(draft.drilled, shown),
            message,
        })
    }

    /// The hole as drilled.
    pub fn drilled(&self) -> &DrilledHole {
        &self.drilled
    }

    /// Continues the hole of an earlier run with its points. Returns their messages.
    pub fn continue_with(&mut self, points: &[Point]) -> Vec<Appended> {
        self.drilled.continue_with(points)
    }

    /// Takes what the thread has found, and waits for the answer of these ticks where it is to.
    fn hear(&mut self, ticks: u64, wait: bool) {
        while self.ended.is_none()
            && let Some(worker) = &self.worker
        {
            let missing = !self.found.contains_key(&ticks);
            match worker.take(wait && missing) {
                Ok(Some(Found { ticks, ahead })) => {
                    self.found.insert(ticks, ahead);
                }
                Ok(None) => break,
                Err(_) => self.ended = Some("the thread that computes the next metres has ended".to_owned()),
            }
        }
        // What no message can have any more is forgotten.
        let (asked, drafts) = (self.current.iter().chain(&self.next), &self.drafts);
        let asked: Vec<u64> = asked.map(|request| request.ticks).collect();
        self.found
            .retain(|of, _| asked.contains(of) || drafts.iter().any(|draft| draft.answer.as_ref() == Ok(of)));
    }
}
