//! The ensemble slice by slice: members run, are weighed once per window, and are renewed once per minute.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::evidence::{Compared, Errors, WINDOW, channel};
use super::judgement::prior_of_friction;
use super::member::Member;
use super::message::band_factors;
use super::place::{Place, State, Threads, in_parallel};
use super::replacing::Choice;
use super::trust::{Doubt, Trust};
use crate::residuals::{Judgement, predicted};
use flexdrill_calibration::residual::RigQuantity;
use flexdrill_config::{Config, Members};
use flexdrill_core::twin::RunInputs;
use flexdrill_messages::Bands;
use flexdrill_realtime::monotonic;
use flexdrill_text::log_ending;
use flexdrill_uncertainty::{Posterior, Priors, UncertaintyError};

/// Model time of a slice (s).
pub(super) const SLICE: f64 = 0.5;
/// Slices between two messages: one second.
const PER_SECOND: u64 = 2;
/// Model time after which members may give way to others, and for which those are prepared: the motion and the means of a
/// tool that begins in the middle of a run have settled after it (s).
pub(super) const PREPARED: f64 = 60.0;
/// What the ensemble hears of the twin, in the order of its ticks.
#[derive(Debug, Clone)]
pub enum Told {
    /// What acts from these ticks on, under a configuration.
    Applied(u64, Box<RunInputs>, Arc<Config>),
    /// The rig was compared with the twin at these ticks.
    Compared(u64, Compared),
    /// The twin has come to these ticks.
    Reached(u64),
}

/// A set of members from its beginning, and how many there are.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Generation {
    /// Ticks at which they begin.
    pub begun: u64,
    /// How many; none where there are no bands.
    pub members: u32,
    /// Why there are none; empty where there are.
    pub why: String,
}

/// The bands of a second.
#[derive(Debug, Clone)]
pub struct Found {
    /// Ticks at its end.
    pub ticks: u64,
    /// Ticks at which the members began.
    pub begun: u64,
    /// All but the header and the instant at which the members began.
    pub bands: Bands,
    /// What the members say of the rig.
    pub judgement: Judgement,
}

/// A piece of model time.
pub(super) struct Slice<'a> {
    /// First tick.
    pub(super) from: u64,
    /// The tick after the last.
    pub(super) to: u64,
    /// What acts from these ticks on.
    pub(super) applied: &'a [(u64, RunInputs)],
}

/// What a message says of the members themselves.
#[derive(Debug, Clone, Default)]
pub(super) struct Counts {
    pub(super) members: u32,
    pub(super) failed: u32,
    pub(super) prepared: u32,
    pub(super) effective: f64,
    pub(super) renewals: u32,
    pub(super) why: String,
}

/// The ensemble of a run.
pub struct Ensemble {
    /// The configuration in force, but for the friction that `calibration.follow` moves.
    pub(super) config: Arc<Config>,
    /// The newest one that was heard of.
    heard: Arc<Config>,
    /// What a calibration has found, where members are drawn from it.
    posterior: Option<Arc<Posterior>>,
    pub(super) priors: Priors,
    pub(super) errors: Errors,
    /// The friction that the priors hold for possible.
    pub(super) prior_friction: [f64; 2],
    pub(super) seed: u64,
    /// What acts at `at`, once that is known.
    pub(super) acts: Option<RunInputs>,
    pub(super) generation: Generation,
    pub(super) places: Vec<Place>,
    /// Members that others have replaced, and that run on as the outermost of those drawn before anything was measured.
    pub(super) outermost: Vec<Place>,
    pub(super) choice: Option<Choice>,
    pub(super) renewals: u32,
    /// Ticks that all members have come to.
    pub(super) at: u64,
    /// Ticks that the twin has come to.
    reached: u64,
    applied: VecDeque<(u64, RunInputs, Arc<Config>)>,
    compared: VecDeque<(u64, Compared)>,
    /// The newest comparison that members were weighed by.
    pub(super) newest: Option<Compared>,
    /// Which sensors members are weighed by.
    pub(super) trust: Trust,
    /// Whether members were chosen by what is withdrawn since. Those of the beginning replace them.
    pub(super) misled: bool,
    /// Factors on the bands, by [`flexdrill_outputs::figures::OverTools::known`].
    pub(super) factors: Vec<f64>,
}

impl Ensemble {
    /// The ensemble of a configuration; `None` where it has none. `posterior` is what its key `ensemble.from` names, where it
    /// names a file.
    ///
    /// # Errors
    /// When nothing can be drawn or a factor is of no figure, which the check of a configuration finds too, or the posterior does
    /// not fit its priors.
    pub fn of(config: &Arc<Config>, posterior: Option<Arc<Posterior>>) -> Result<Option<Self>, UncertaintyError> {
        let Some(stated) = &config.ensemble else {
            return Ok(None);
        };
        let priors = match (stated.posterior(), &posterior) {
            (None, _) => Priors::of(config)?,
            (Some(_), Some(posterior)) => Priors::of(config)?.drawn_from(posterior)?,
            (Some(file), None) => return Err(UncertaintyError::NotGiven { file: file.to_owned() }),
        };
        Ok(Some(Self {
            errors: Errors::of(config, &priors),
            prior_friction: prior_of_friction(config, &priors),
            priors,
            posterior: posterior.filter(|_| stated.posterior().is_some()),
            config: Arc::clone(config),
            heard: Arc::clone(config),
            seed: stated.seed,
            acts: None,
            generation: Generation {
                begun: 0,
                members: 0,
                why: "the plausible tools have not begun yet".to_owned(),
            },
            places: Vec::new(),
            outermost: Vec::new(),
            choice: None,
            renewals: 0,
            at: 0,
            reached: 0,
            applied: VecDeque::new(),
            compared: VecDeque::new(),
            newest: None,
            trust: Trust::default(),
            misled: false,
            factors: band_factors(config)?,
        }))
    }

    /// The number of members that the configuration asks for; `None` where the computer decides.
    pub fn asked(&self) -> Option<u32> {
        match self.config.ensemble.as_ref()?.members {
            Members::Count(count) => Some(count),
            Members::Auto(_) => None,
        }
    }

    /// Hears of the twin.
    pub fn hear(&mut self, told: Told) {
        match told {
            Told::Applied(ticks, inputs, config) => self.applied.push_back((ticks, *inputs, config)),
            Told::Compared(ticks, compared) => self.compared.push_back((ticks, compared)),
            Told::Reached(ticks) => self.reached = self.reached.max(ticks),
        }
    }

    /// Ticks that all members have come to, and those that the twin has come to.
    pub fn ticks(&self) -> [u64; 2] {
        [self.at, self.reached]
    }

    /// Ticks of a time (s).
    pub fn ticks_of(&self, time: f64) -> u64 {
        ((time / self.config.solver.time_step).round() as u64).max(1)
    }

    /// Ticks at which the first members can begin: those from which on it is known what acts.
    pub fn first(&self) -> Option<u64> {
        let (ticks, ..) = self.applied.front()?;
        Some(ticks.next_multiple_of(self.ticks_of(SLICE)))
    }

    /// Ticks at which other members can begin now: the last end of a slice that the twin has passed.
    pub fn latest(&self) -> u64 {
        let slice = self.ticks_of(SLICE);
        self.reached.saturating_sub(1) / slice * slice
    }

    /// Begins again with other members, at the end of a slice that the twin has passed ([`Ensemble::first`],
    /// [`Ensemble::latest`]), so that all that acts there is known.
    pub fn begin(&mut self, generation: Generation) {
        let slice = self.ticks_of(SLICE);
        let begun = generation.begun;
        // What came before acts from the beginning on.
        while self.at < begun {
            self.at += slice;
            self.take_applied(self.at);
        }
        self.take_applied(begun + 1);
        self.places = (0..u64::from(generation.members))
            .map(|number| self.priors.member(self.seed, number).map_err(|error| error.to_string()))
            .map(|drawn| Place::new(drawn, true))
            .collect();
        self.outermost.clear();
        (self.newest, self.trust, self.misled) = (None, Trust::default(), false);
        // What was compared before says nothing of members that begin now.
        self.compared.retain(|(ticks, _)| *ticks > begun);
        self.generation = Generation { begun, ..generation };
        (self.choice, self.renewals, self.at) = (None, 0, begun);
    }

    /// The members of now.
    pub fn generation(&self) -> &Generation {
        &self.generation
    }

    /// Processor time (s) that a second of a member's model time takes here, measured with its first member.
    ///
    /// # Errors
    /// Why it cannot be measured, in words.
    pub fn cost(&mut self) -> Result<f64, String> {
        /// Model time that is measured, after as much that is not (s).
        const MEASURED: f64 = 1.0;
        let begun = self.at;
        let length = self.ticks_of(MEASURED);
        let acts = self.acts.or_else(|| self.applied.front().map(|(_, inputs, _)| *inputs));
        let acts = acts.ok_or("nothing acts on the twin yet")?;
        let drawn = self.priors.member(self.seed, 0).map_err(|error| error.to_string())?;
        let mut member = Member::new(&drawn, &acts)?;
        let mut run = |from: u64| {
            member.advance(&Slice {
                from,
                to: from + length,
                applied: &[],
            })
        };
        run(begun)?;
        let before = monotonic::processor_time();
        run(begun + length)?;
        Ok((monotonic::processor_time() - before) as f64 * 1e-9 / MEASURED)
    }

    /// Whether the twin has come to the end of the next slice.
    pub fn is_due(&self) -> bool {
        self.acts.is_some() && self.at + self.ticks_of(SLICE) <= self.reached
    }

    /// Runs the next slice on these threads. Returns the bands where a second ends. Once `stop` is set it
    /// returns soon, and the ensemble is of no further use.
    pub fn slice(&mut self, threads: Threads, stop: &AtomicBool) -> Option<Found> {
        let length = self.ticks_of(SLICE);
        let (from, to) = (self.at, self.at + length);
        let begins = self.acts?;
        let applied = self.take_applied(to);
        let slice = Slice {
            from,
            to,
            applied: &applied,
        };
        let prepared = self.choice.iter_mut().flat_map(|choice| &mut choice.prepared);
        let prepared = prepared.map(|prepared| &mut prepared.place);
        let places = self.places.iter_mut().chain(&mut self.outermost).chain(prepared);
        in_parallel(places.collect(), threads, |place| {
            if !stop.load(Ordering::Relaxed) {
                place.advance(&slice, &begins);
            }
        });
        self.at = to;
        self.weigh(to);
        let since = to - self.generation.begun;
        if since.is_multiple_of(self.ticks_of(WINDOW)) {
            self.end_window();
        }
        if since.is_multiple_of(self.ticks_of(PREPARED)) {
            self.replace();
            self.choose(to);
        }
        to.is_multiple_of(PER_SECOND * length).then(|| Found {
            ticks: to,
            begun: self.generation.begun,
            judgement: self.judgement(),
            bands: self.message(),
        })
    }

    /// What acts from ticks before `to` on, and makes the last of it what acts.
    fn take_applied(&mut self, to: u64) -> Vec<(u64, RunInputs)> {
        let mut applied = Vec::new();
        while let Some((ticks, inputs, config)) = self.applied.pop_front_if(|(ticks, ..)| *ticks < to) {
            if !Arc::ptr_eq(&config, &self.heard) {
                self.heard = Arc::clone(&config);
                self.reconfigure(config);
            }
            self.acts = Some(RunInputs { reset: false, ..inputs });
            applied.push((ticks, inputs));
        }
        applied
    }

    /// Adopts a configuration that was changed while the twin runs. Members keep what they have drawn.
    fn reconfigure(&mut self, config: Arc<Config>) {
        let config = self.unfollowed(config);
        if config == self.config {
            return;
        }
        // A change that leaves nothing to draw from is refused by the check of the configuration.
        if let Ok(priors) = Priors::of(&config) {
            self.errors = Errors::of(&config, &priors);
            self.priors = match &self.posterior {
                Some(posterior) => priors.drawn_from_what_holds(posterior),
                None => priors,
            };
        }
        self.config = config;
        let priors = &self.priors;
        let prepared = self.choice.iter_mut().flat_map(|choice| &mut choice.prepared);
        for place in self
            .places
            .iter_mut()
            .chain(&mut self.outermost)
            .chain(prepared.map(|prepared| &mut prepared.place))
        {
            if let Ok(drawn) = &mut place.drawn
                && let Ok(config) = priors.config(&drawn.draws)
            {
                // One that is built later begins with the values of now, too.
                drawn.config = config;
                if let State::Runs(member) = &mut place.state {
                    member.reconfigure(&drawn.config);
                }
            }
        }
    }

    fn members(&mut self, mut each: impl FnMut(&mut Member)) {
        for place in self.places.iter_mut().chain(&mut self.outermost) {
            if let State::Runs(member) = &mut place.state {
                each(member);
            }
        }
    }

    /// Takes the comparisons up to the end of a slice. A member that is prepared has no steady motion yet.
    fn weigh(&mut self, to: u64) {
        let settled = self.generation.begun + self.ticks_of(PREPARED);
        while let Some((ticks, compared)) = self.compared.pop_front_if(|(ticks, _)| *ticks <= to) {
            let errors = self.errors;
            self.newest = Some(compared);
            let restarted = self.trust.measured(&compared, |quantity| errors.sample(quantity)[0]);
            self.members(|member| {
                let computed = predicted(member.snapshot());
                member.windows.add(&errors, &compared, &computed);
                // A tool that begins moves until it has settled, whatever the rig does.
                if ticks > settled {
                    member.windows.follow(compared.step, &computed, &restarted);
                }
            });
            for quantity in RigQuantity::ALL {
                let running = self.places.iter().chain(&self.outermost).filter_map(Place::member);
                let moved = running.map(|member| member.windows.moved(quantity));
                if self
                    .trust
                    .moved(quantity, compared.step, moved, errors.sample(quantity))
                {
                    self.stop_believing(quantity);
                }
            }
            self.withdraw();
        }
    }

    /// Ends the window of all members. A sensor that shows what none of them does is not believed in it.
    fn end_window(&mut self) {
        let mut residuals = Vec::new();
        self.members(|member| residuals.push(member.windows.residuals()));
        let doubted = self.trust.window(&residuals);
        for quantity in RigQuantity::ALL {
            if self.trust.doubt(quantity) == Some(Doubt::Beyond) {
                self.stop_believing(quantity);
            }
        }
        self.members(|member| member.windows.end(&doubted));
        self.withdraw();
    }

    /// Logs why a sensor is not believed.
    fn stop_believing(&self, quantity: RigQuantity) {
        let (name, doubt) = (channel(quantity).name(), self.trust.doubt(quantity));
        let why = doubt.map_or("", Doubt::words);
        if let Some(more) = log_ending(format!("the plausible tools do not believe the {name}: {why}")) {
            tracing::warn!("the plausible tools do not believe the {name}: {why}. Check the sensor{more}");
        }
    }

    /// Withdraws what sensors have said that turned out to be wrong. Members that were chosen by it are replaced by those of the
    /// beginning; weights alone need no replacement.
    fn withdraw(&mut self) {
        for quantity in self.trust.withdrawn() {
            self.members(|member| member.windows.evidence.forget(quantity as usize));
            self.misled |= self.places.iter().any(|place| !place.first);
            self.choice = None;
        }
    }
}
