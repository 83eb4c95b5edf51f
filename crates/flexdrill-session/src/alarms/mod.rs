//! Alarms, from condition to message: the conditions and the texts. The life of an alarm is the crate
//! [`flexdrill_alarms`].
//!
//! # Layout
//! - [`AlarmBook`] joins them: conditions and requests in, lists and events out.
//! - `catalogue`: the alarms that exist. `finding`: a condition with its texts.
//! - `tool`: conditions from a snapshot, in model time, so that a replay has the same alarms. The conditions of a node come
//!   from the node. `worst_moment`: a standing alarm shows its worst moment.
//!   `window`: speed and weight against the map. `rig`: what the rig measures against what the twin computes;
//!   `adjusted`: what followed from it. `plan`: where the tool drills against the plan of the hole. `changed`: what clients have changed of the configuration.
//!   `advice`: what the driller can do, for all alarms together, by the rules of the configuration. `plausible`: in how
//!   many plausible tools an alarm stands. `sentence`: parts of sentences. `set`: sets of alarms.
//! - `journal`: events and list, published. `fill`: messages.
//!
//! `docs/alarms.md` is for operators.

mod adjusted;
mod advice;
mod catalogue;
mod changed;
mod fill;
mod finding;
mod friction;
mod journal;
mod plan;
mod plausible;
mod request;
mod rig;
pub mod sentence;
mod set;
mod tool;
mod window;
mod worst_moment;

pub use advice::{Change, Knob, Leading, TRIED_SPEED, TRIED_WEIGHT, Tested, Trial, Unknown};
pub use catalogue::AlarmId;
pub use changed::FOLLOW;
pub use finding::Finding;
pub use request::Request;
pub use rig::{Followed, Judged, in_words};
pub use set::AlarmSet;
pub use tool::called_at;

use std::sync::Arc;

use crate::messages::{AlarmEvent, Bands, HoleAhead, Residuals};
use flexdrill_alarms::{AlarmSystem, Figures, Observation, Operator, Priority, Saved, SavedError, Statistics, Time};
use flexdrill_config::{Advice, AdviceTable, Config, PROMPT_OFF_DELAY};
use flexdrill_core::inputs::InputState;
use flexdrill_core::twin::Snapshot;
use flexdrill_motion::HazardKind;
use flexdrill_outputs::ParameterChange;

use crate::safe_window::SafeWindow;
use adjusted::Adjusted;
use advice::{Ahead, Demand, Operating};
use changed::Changed;
use plausible::Plausible;
use worst_moment::WorstMoment;

/// All alarms with their conditions. A copy is the book of a fork: both continue from the same state.
#[derive(Clone)]
pub struct AlarmBook {
    system: AlarmSystem,
    config: Arc<Config>,
    /// The worst moment of each alarm that stands or is not yet acknowledged.
    moments: Vec<WorstMoment>,
    /// Whether alarms are held for an operator.
    holds: bool,
    /// The operating point of the newest snapshot.
    operating: Operating,
    /// The map of speed and weight, where one is loaded.
    window: Option<Arc<SafeWindow>>,
    /// What look-aheads have found for the present state, and what they do.
    tested: Option<Tested>,
    trial: Trial,
    /// What plausible tools did.
    tools: Plausible,
    /// The alarm that leads the advice.
    lead: Option<AlarmId>,
    /// Which of the rig's values the twin does not know.
    unknown: Unknown,
    /// Whether no input that the run uses is stale or was never received.
    inputs_known: bool,
    /// When rig and twin were compared last in steady motion.
    rig_judged: Time,
    /// When the hole ahead was compared last with its plan.
    plan_judged: Time,
    /// What the largest pull does against friction, once it was asked for; none where there is nothing to judge.
    reserve: Option<Option<friction::Reserve>>,
    /// When friction was judged last.
    friction_judged: Time,
    /// What the twin expects of the rig, as the journal has it.
    adjusted: Adjusted,
    /// What clients have changed of the configuration.
    changed: Changed,
    /// Per alarm: whether its present state began in an earlier run.
    restored: Vec<bool>,
    /// Events that are not yet published.
    journal: Vec<AlarmEvent>,
    /// Stamp of the newest event. The tool's events have the model's instants and the node's the present time; stamps
    /// that never decrease keep a journal that is read by time in sequence.
    newest: Time,
    /// The last publication of the list: its time and the number of the newest event.
    listed: Option<(Time, u64)>,
    bytes: Vec<u8>,
}

impl AlarmBook {
    /// The alarms in the state that an earlier run saved, all normal without one.
    ///
    /// # Errors
    /// When another version saved it.
    pub fn new(config: Arc<Config>, saved: Option<&Saved>, time: Time) -> Result<Self, SavedError> {
        let mut system = system(&config);
        if let Some(saved) = saved {
            system.restore(saved)?;
        }
        Ok(Self::with(system, config, time))
    }

    /// All alarms normal, defined by a configuration.
    pub fn fresh(config: Arc<Config>, time: Time) -> Self {
        Self::with(system(&config), config, time)
    }

    /// All alarms normal, for a run that is to find out whether a motion has ended: the alarms return within [`PROMPT_OFF_DELAY`]
    /// of it, and are not held as those of an operator are.
    pub fn prompt(config: Arc<Config>, time: Time) -> Self {
        let mut definitions = AlarmId::ALL.map(|id| id.define(&config.alarms)).to_vec();
        let of_motion = HazardKind::ALL.into_iter().map(AlarmId::of_hazard);
        for id in of_motion.chain([AlarmId::ModelQuality]) {
            let delays = &mut definitions[id as usize].delays;
            delays.off = delays.off.min(PROMPT_OFF_DELAY);
        }
        let system = AlarmSystem::new(definitions, config.alarms.longest_shelving);
        Self {
            holds: false,
            ..Self::with(system, config, time)
        }
    }

    fn with(system: AlarmSystem, config: Arc<Config>, time: Time) -> Self {
        let mut book = Self {
            moments: vec![WorstMoment::default(); AlarmId::ALL.len()],
            holds: true,
            operating: Operating::default(),
            window: None,
            tested: None,
            trial: Trial::default(),
            tools: Plausible::default(),
            lead: None,
            unknown: Unknown::default(),
            inputs_known: true,
            rig_judged: Time::MIN,
            plan_judged: Time::MIN,
            reserve: None,
            friction_judged: Time::MIN,
            adjusted: Adjusted::default(),
            changed: Changed::new(Arc::clone(&config)),
            restored: (0..AlarmId::ALL.len())
                .map(|index| system.alarm(index).since != 0)
                .collect(),
            journal: Vec::new(),
            newest: Time::MIN,
            listed: None,
            bytes: Vec::new(),
            system,
            config,
        };
        let mut events = Vec::new();
        book.system.follow_definitions(time, &mut events);
        book.keep(events);
        book
    }

    /// Adopts the limits and rules of a configuration that changed while the node runs, by these requests.
    pub fn reconfigure(&mut self, config: &Arc<Config>, changes: &[ParameterChange]) {
        self.changed.reconfigure(&self.config, config, changes);
        self.config = Arc::clone(config);
    }

    /// The configuration that defines them.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Judges speed and weight by a map.
    pub fn set_window(&mut self, window: Arc<SafeWindow>) {
        self.window = Some(window);
    }

    /// Takes the worst state of the inputs that the run uses, in the message's INPUT_ constants. It is part of the applied
    /// inputs, so that a replay has the one of the recorded run.
    pub fn set_input_quality(&mut self, quality: u8) {
        self.inputs_known = ![InputState::Stale as u8, InputState::NotReceived as u8].contains(&quality);
    }

    /// Advances the clock of requests. Call it before the observations of that time.
    pub fn advance(&mut self, time: Time) {
        let mut events = Vec::new();
        self.system.advance(time, &mut events);
        self.keep(events);
    }

    /// Observes the hazards of a snapshot at its stamp.
    pub fn observe_tool(&mut self, snapshot: &Snapshot, stamp: Time) {
        let stands = |id: AlarmId| self.system.alarm(id as usize).standing.active().is_some();
        let mut findings = tool::findings(snapshot, stamp, &self.config, stands);
        if let Some(window) = &self.window {
            findings.push((
                AlarmId::KnownWindow,
                window::finding(window, snapshot, self.inputs_known),
            ));
        }
        findings.push((AlarmId::ChangedParameters, self.changed.finding()));
        self.operating = Operating::of(&snapshot.applied, self.unknown);
        self.observe(findings, stamp);
        for entry in self.changed.due(stamp) {
            self.enter(AlarmId::ChangedParameters, &entry.by, &entry.reason, stamp);
        }
    }

    /// Enters that a person has confirmed how a bridge reads the rig's line: from then on `rig/measured` is compared.
    pub fn enter_confirmed(&mut self, by: &str, reason: &str, time: Time) {
        self.enter(AlarmId::RigDisagrees, by, reason, time);
    }

    /// Enters what an alarm is judged against from now on into the journal.
    fn enter(&mut self, id: AlarmId, by: &str, reason: &str, time: Time) {
        let mut events = Vec::new();
        self.system
            .adjusted(id as usize, time, &Operator { name: by, reason }, &mut events);
        self.keep(events);
    }

    /// Observes the comparison of the rig with the twin, or with plausible tools, at the stamp of its snapshot. A standing alarm outlasts connections and
    /// other times in which nothing can be judged; a condition that has not annunciated begins again after them.
    /// `followed` is the friction that the twin has followed the rig to.
    pub fn observe_rig(&mut self, judged: Judged<'_>, followed: &Followed, bit_depth: f64, stamp: Time) {
        let differs = judged
            .finding(bit_depth)
            .filter(|finding| finding.priority.is_some() || !followed.is_far());
        match differs.or_else(|| followed.finding()) {
            Some(finding) => {
                self.rig_judged = stamp;
                self.observe([(AlarmId::RigDisagrees, finding)], stamp);
            }
            None => {
                let stands = self.active(AlarmId::RigDisagrees).is_some();
                if !stands || stamp.saturating_sub(self.rig_judged) > rig::OUTLASTS {
                    self.observe([(AlarmId::RigDisagrees, Finding::default())], stamp);
                }
            }
        }
    }

    /// Observes where the tool drills against the plan of the hole, at the message's stamp. A standing alarm outlasts a change
    /// of the weight, until whose answer nothing is known.
    pub fn observe_hole(&mut self, hole: &HoleAhead, stamp: Time) {
        let stands = self.active(AlarmId::HoleLeavesPlan).is_some();
        let lead = self.leading().map(|leading| leading.alarm);
        let finding = plan::finding(hole, stands, lead, self.unknown);
        if finding.is_some() {
            self.plan_judged = stamp;
        } else if stands && stamp.saturating_sub(self.plan_judged) <= plan::OUTLASTS {
            return;
        }
        self.observe([(AlarmId::HoleLeavesPlan, finding.unwrap_or_default())], stamp);
    }

    /// Observes the friction of a comparison with the rig against what the largest pull overcomes, at its stamp. A standing alarm
    /// outlasts connections, as that on the comparison does.
    pub fn observe_friction(&mut self, residuals: &Residuals, stamp: Time) {
        // The statics behind it take as long as some frames, and only the book of a rig needs them.
        let config = &self.config;
        let Some(reserve) = *self.reserve.get_or_insert_with(|| friction::Reserve::of(config)) else {
            return;
        };
        let stands = self.active(AlarmId::FrictionNearStuck);
        let finding = reserve.finding(residuals, stands);
        if finding.is_some() {
            self.friction_judged = stamp;
        } else if stands.is_some() && stamp.saturating_sub(self.friction_judged) <= friction::OUTLASTS {
            return;
        }
        self.observe([(AlarmId::FrictionNearStuck, finding.unwrap_or_default())], stamp);
    }

    /// Enters what changed of what the twin expects of the rig, as a comparison has it at its stamp.
    pub fn observe_adjusted(&mut self, residuals: &Residuals, stamp: Time) {
        if let Some(reason) = self.adjusted.observe(residuals, stamp) {
            self.enter(AlarmId::RigDisagrees, "", &reason, stamp);
        }
    }

    /// Observes findings at the present time, such as those on the state of a node, which the node makes.
    pub fn observe(&mut self, findings: impl IntoIterator<Item = (AlarmId, Finding)>, time: Time) {
        let mut events = Vec::new();
        for (id, finding) in findings {
            let moment = &self.moments[id as usize];
            let active = self.system.alarm(id as usize).standing.active();
            let observed = Observation {
                priority: match self.holds {
                    true => moment.held(finding.priority, active, time),
                    false => finding.priority,
                },
                suppressed: finding.suppressed,
                evidence: &finding.evidence,
            };
            self.system.observe(id as usize, time, &observed, &mut events);
            let standing = self.system.alarm(id as usize).standing;
            self.moments[id as usize].observe(finding, time, &standing);
        }
        self.keep(events);
    }

    /// Takes what look-aheads have found, for as long as it holds at what is asked for, and what they do.
    pub fn set_tested(&mut self, tested: Option<Tested>, trial: Trial) {
        (self.tested, self.trial) = (tested, trial);
    }

    /// Takes what plausible tools did in a second, at its stamp: lists say where they differ.
    pub fn observe_tools(&mut self, bands: &Bands) {
        self.tools.take(bands);
    }

    /// Takes which of the rig's values the twin does not know.
    pub fn set_unknown(&mut self, unknown: Unknown) {
        (self.unknown, self.operating.unknown) = (unknown, unknown);
    }

    /// The alarm of the tool's motion that leads, and all that stand; `None` while none does.
    pub fn leading(&self) -> Option<Leading> {
        let demands = self.demands();
        let order = advice::by_rank(&demands);
        let lead = order.first()?;
        let those = |shelved: bool| {
            let some = order.iter().filter(|demand| demand.shelved == shelved);
            some.map(|demand| demand.id).collect()
        };
        (!lead.shelved && self.active(lead.id).is_some()).then(|| Leading {
            alarm: lead.id,
            standing: those(false),
            shelved: those(true),
        })
    }

    /// Writes the advice to the driller on all alarms of the tool's motion.
    fn advise(&mut self) {
        let demands = self.demands();
        let ahead = Ahead {
            trial: self.config.look_ahead.advice.then_some(self.trial),
            tested: self.tested,
        };
        let actions = advice::what_to_do(&demands, &self.operating, &self.config.inputs, &ahead);
        let followed = actions.iter().find_map(|action| action.follows);
        self.lead = followed.or_else(|| Some(advice::by_rank(&demands).first()?.id));
        for (demand, action) in demands.iter().zip(actions) {
            let index = demand.id as usize;
            let finding = &mut self.moments[index].finding;
            (finding.what_to_do, finding.follows) = match self.system.alarm(index).standing.active() {
                Some(_) => (action.text, action.follows),
                None => ("No further action: acknowledge the alarm.".to_owned(), None),
            };
        }
    }

    fn demands(&self) -> Vec<Demand> {
        let mut demands = Vec::new();
        for kind in HazardKind::ALL {
            let id = AlarmId::of_hazard(kind);
            let (moment, standing) = (&self.moments[id as usize], self.system.alarm(id as usize).standing);
            if moment.is_known() {
                demands.push(Demand {
                    id,
                    priority: standing.active().filter(|_| moment.counts.is_some()),
                    rule: tool::rule(kind, &self.config.alarms.advice),
                    shelved: standing.shelf().is_some(),
                    leads: self.lead == Some(id),
                });
            }
        }
        demands
    }

    /// The priority with which an alarm stands now.
    pub fn active(&self, id: AlarmId) -> Option<Priority> {
        self.system.alarm(id as usize).standing.active()
    }

    /// Carries out a request of an operator at the present time of its clock. Returns what was done.
    ///
    /// # Errors
    /// When it is refused.
    pub fn request(&mut self, request: &Request, time: Time) -> Result<String, flexdrill_alarms::Refusal> {
        self.advance(time);
        let mut events = Vec::new();
        let answer = request.carry_out(&mut self.system, time, &mut events);
        self.keep(events);
        answer
    }

    /// The state that outlasts a restart.
    pub fn save(&self) -> Saved {
        self.system.save()
    }

    /// The figures of the alarm system.
    pub fn figures(&self) -> Figures {
        self.system.statistics().figures()
    }

    /// The counts per alarm.
    pub fn statistics(&self) -> &Statistics {
        self.system.statistics()
    }
}

/// The rule for an alarm of the tool's motion; one without limits for any other.
pub fn rule(id: AlarmId, table: &AdviceTable) -> Advice {
    let kind = HazardKind::ALL.into_iter().find(|kind| AlarmId::of_hazard(*kind) == id);
    kind.map_or(Advice::default(), |kind| tool::rule(kind, table))
}

fn system(config: &Config) -> AlarmSystem {
    let definitions = AlarmId::ALL.map(|id| id.define(&config.alarms)).to_vec();
    AlarmSystem::new(definitions, config.alarms.longest_shelving)
}
