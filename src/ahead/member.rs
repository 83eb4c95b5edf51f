//! One future: a run of one candidate, judged as the node judges the live run.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::calm::Calm;
use super::early::Early;
use super::goal::Ends;
use super::measured::Measured;
use super::set_point::Wavering;
use super::tally::{Tally, damage};
use super::trace::Trace;
use crate::alarms::{AlarmBook, AlarmId, AlarmSet};
use crate::session::Session;
use flexdrill_alarms::{Priority, span};
use flexdrill_config::Config;
use flexdrill_core::dynamics::{StepFailure, StepOutcome};
use flexdrill_core::tool::{Body, Direction};
use flexdrill_core::twin::{QualityLevel, Run, RunInputs, Snapshot};

/// Largest lateral velocity (m/s) by which members differ at the beginning. It is a ten-thousandth of the velocities that
/// the pipe has in drilling, and no instrument in a well resolves it; a turn later the places of the pipe differ by
/// millimetres (test `a_small_disturbance_parts_forks_within_a_turn`).
pub const DISTURBANCE: f64 = 1e-5;

/// Time between two looks at a run (s): as often as alarms are observed in the node.
pub(super) const LOOK: f64 = 0.1;

flexdrill_base::listed! {
    /// A figure of a member over its horizon.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[repr(usize)]
    pub enum Figure: 2 {
        /// Mean of (max - min) / (2 mean) of the bit's speed.
        Ripple: "bit_speed_ripple", "";
        /// Largest normal force of pipe and guide at a station (N).
        PipeGuideForce: "pipe_guide_force", "N";
        /// Largest normal force of guide and wall at a station (N).
        GuideWallForce: "guide_wall_force", "N";
        /// Largest moment of a joint's stop (N m).
        StopMoment: "stop_moment", "N m";
        /// Bending cycles per hour of the link that whirl bends most often, in the mean.
        BendingCycles: "bending_cycles", "1/h";
        /// Damage per hour of the joint that ages fastest, by its stop or the link below it.
        Damage: "damage", "1/h";
        /// Mean torque at the bit over that at the surface, or at the kick-off without a string; NaN where there is none.
        TorqueTransfer: "torque_transfer", "";
        /// Mean weight at the bit over that at the surface, or at the kick-off without a hoist; NaN where there is none.
        WeightTransfer: "weight_transfer", "";
    }
}

impl Figure {
    /// Name and unit, as in messages.
    pub const fn name_and_unit(self) -> (&'static str, &'static str) {
        let [name, unit] = self.row();
        (name, unit)
    }
}

/// What one alarm did in a member.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Called {
    /// Highest priority with which it was raised, or stood while it must have ended; none where it did neither.
    pub worst: Option<Priority>,
    /// Time from the beginning of the horizon to the first of it (s).
    pub first: f64,
}

/// What a member brought.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Member {
    /// By [`AlarmId::ALL`].
    pub alarms: Vec<Called>,
    /// By [`Figure::ALL`].
    pub figures: [f64; Figure::ALL.len()],
    /// The worst quality of its motion.
    pub quality: QualityLevel,
    /// Its seconds; none unless it was traced.
    pub trace: Trace,
    /// Its motion while every alarm must have ended, unless it ended early; none unless it was measured.
    pub measured: Option<Measured>,
    /// Model time that it was judged over (s).
    pub judged: f64,
    /// Model time of its way to the judged time (s).
    pub way: f64,
}

impl Member {
    /// Whether it saw the alarm that ends a member.
    pub fn saw(&self, ends: Ends) -> bool {
        let least = ends.priority();
        least.is_some() && self.alarms.iter().any(|called| called.worst >= least)
    }
}

/// How long a member is judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Horizon {
    /// So long (s): what lasts into its second half has not ended.
    Of(f64),
    /// Until the condition of none of the alarms is met, and for `within` (s) at most; what stands within `lasting` (s) from then
    /// on, or before `least` (s), has not ended. With `lasting`, the alarms themselves must have ended too.
    Settling {
        /// The alarms that are to end, and those that may come with the change for a moment.
        alarms: AlarmSet,
        /// Time that they have to end (s).
        within: f64,
        /// Time for which they must stay away (s); 0: the member ends with them.
        lasting: f64,
        /// Least time of the member (s).
        least: f64,
        /// An alarm without whose end the rest of the member says nothing more, and the time (s) for which it outlasts its
        /// condition at least.
        leading: (AlarmId, f64),
    },
}

/// Why a member ended early.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Ended {
    /// A step failed: what would have come is unknown.
    Failed(StepFailure),
    /// The speed or the weight did not reach the candidate's.
    NotReached,
    /// There is no such tool: in words.
    NoTool(String),
    /// A stop was requested.
    Stopped,
}

/// A run that is being looked at.
pub(super) struct Watched<'a> {
    run: Run,
    config: &'a Arc<Config>,
    stop: &'a AtomicBool,
    snapshot: Snapshot,
    /// Model steps between two looks at the refinement that the motion asks for.
    period: u64,
    /// Periods per look.
    periods: u64,
    /// The trace, and the time of the run at tick 0 of this one (s).
    trace: Option<(Trace, f64)>,
    measured: Option<Measured>,
    wavering: Wavering,
    /// Time (s) after which it ends where its motion is calm.
    calm_after: Option<f64>,
}

impl<'a> Watched<'a> {
    pub(super) fn new(run: Run, config: &'a Arc<Config>, stop: &'a AtomicBool) -> Self {
        let snapshot = run.simulation().new_snapshot();
        let step = config.solver.time_step;
        // The live loop chooses the refinement every 5 ms; so does this one.
        let period = ((5e-3 / step).round() as u64).max(1);
        let periods = ((LOOK / (period as f64 * step)).round() as u64).max(1);
        Self {
            run,
            config,
            stop,
            snapshot,
            period,
            periods,
            trace: None,
            measured: None,
            wavering: Wavering::default(),
            calm_after: None,
        }
    }

    /// Keeps the figures of every second of a run whose time is `time` (s) now.
    pub(super) fn traced(mut self, time: f64) -> Self {
        let counted = self.run.ticks() as f64 * self.config.solver.time_step;
        self.trace = Some((Trace::default(), time - counted));
        self
    }

    /// Measures the motion while every alarm must have ended.
    pub(super) fn measured(mut self, measured: Measured) -> Self {
        self.measured = Some(measured);
        self
    }

    /// Lets the inputs waver about what is set while the run is judged.
    pub(super) fn wavering(mut self, wavering: Wavering) -> Self {
        self.wavering = wavering;
        self
    }

    /// Ends it after so long (s) where its motion is calm.
    pub(super) fn ending(mut self, ends: Ends) -> Self {
        self.calm_after = match ends {
            Ends::Horizon => None,
            Ends::FirstAlarm { calm_after, .. } => Some(calm_after),
        };
        self
    }

    /// Advances by one look.
    fn advance(&mut self) -> Result<(), Ended> {
        for _ in 0..self.periods {
            let applied = self.run.applied();
            let refinement = self.run.wanted_refinement();
            if refinement != applied.refinement {
                self.run.apply(&RunInputs { refinement, ..applied });
            }
            for _ in 0..self.period {
                if let StepOutcome::Failed(failure) = self.run.advance() {
                    return Err(Ended::Failed(failure));
                }
                if let Some(measured) = &mut self.measured {
                    let simulation = self.run.simulation();
                    let speed = simulation.velocity(simulation.last_station(), Body::Pipe, Direction::Psi);
                    measured.step(speed.unwrap_or(f64::NAN));
                }
            }
        }
        if self.stop.load(Ordering::Relaxed) {
            return Err(Ended::Stopped);
        }
        self.run.look(&mut self.snapshot);
        Ok(())
    }

    /// Changes speed and weight to those of `target`, for at most `most` (s). Returns the run and the time it took.
    pub(super) fn run_up(mut self, target: &RunInputs, most: f64) -> Result<(Run, f64), Ended> {
        self.run.apply(target);
        let begun = self.run.simulation().time();
        loop {
            let applied = self.run.simulation().applied();
            let gone = self.run.simulation().time() - begun;
            if applied.rotary_speed == target.inputs.rotary_speed && applied.weight_set == target.inputs.weight_on_bit {
                return Ok((self.run, gone));
            }
            if gone > most {
                return Err(Ended::NotReached);
            }
            self.advance()?;
        }
    }

    /// Runs over a horizon and judges it; ends early once `enough` says so of the alarms so far ([`AlarmId::ALL`]).
    pub(super) fn judge(mut self, horizon: Horizon, enough: impl Fn(&[Called]) -> bool) -> Result<Member, Ended> {
        // Alarms caused by the earlier state appear within `SETTLING`. They count only if they last or return.
        self.run.look(&mut self.snapshot);
        let begun = self.snapshot.time;
        let stamp = |snapshot: &Snapshot| span(snapshot.time);
        let book = AlarmBook::prompt(Arc::clone(self.config), stamp(&self.snapshot));
        let mut session = Session::new(Arc::clone(self.config), book);
        // Damage accumulates over the life of the tool, so only the difference belongs to this member.
        let damage_before = damage(&self.snapshot);
        let mut alarms = vec![Called::default(); AlarmId::ALL.len()];
        let mut stood = vec![true; AlarmId::ALL.len()];
        let mut tally = Tally::default();
        let mut quality = QualityLevel::Good;
        let per_look = self.periods as f64 * self.period as f64 * self.config.solver.time_step;
        let looks = |time: f64| (time / per_look).ceil() as u64;
        // Looks at which the alarms must have ended at the latest, and for which they must stay away from then on.
        let (all, mut early) = match horizon {
            Horizon::Of(horizon) => (looks(horizon), None),
            Horizon::Settling {
                alarms,
                within,
                lasting,
                least,
                leading: (leading, hold),
            } => (
                looks(within) + looks(lasting),
                Some(Early {
                    alarms,
                    lasting,
                    least: looks(least),
                    leading,
                    // A look more for each of the two rounded times, and one for the alarm that follows the analysis.
                    hopeless: (looks(within) + 3).saturating_sub(looks(hold)),
                    over: None,
                }),
            ),
        };
        let latest = early
            .as_ref()
            .map_or(all.div_ceil(2), |early| all - looks(early.lasting));
        let mut calm = self.calm_after.map(|after| Calm::new(looks(after), all));
        let mut end = all;
        let mut lasts = false;
        let set = self.run.applied().inputs;
        let mut look = 0;
        while look < end {
            look += 1;
            if let Some(inputs) = self.wavering.next(&set) {
                let applied = self.run.applied();
                self.run.apply(&RunInputs { inputs, ..applied });
            }
            self.advance()?;
            let snapshot = &self.snapshot;
            // The events of a fork have no reader.
            drop(session.judge(snapshot, stamp(snapshot)));
            // What stands before belongs to the transition. Where all has ended early, the rest of the transition says
            // nothing more.
            let gone = snapshot.time - begun;
            if let Some(early) = &mut early
                && !lasts
                && gone >= SETTLING
            {
                early.follow(snapshot, session.alarms());
                if let Some(over) = early.over {
                    // A member that only chooses asks whether the motion ends. How long it stays away is for others.
                    if early.lasting == 0.0 {
                        break;
                    }
                    if early.alarms.iter().all(|id| session.alarms().active(id).is_none()) {
                        lasts = true;
                        end = looks(over - begun + early.lasting).max(early.least).clamp(look, all);
                    }
                } else if look >= early.hopeless
                    && let Some(priority) = early.is_met(snapshot, session.alarms())
                {
                    // Its condition keeps the alarm for longer than the time that is left.
                    let called = &mut alarms[early.leading as usize];
                    (called.worst, called.first) = (Some(priority), gone);
                    break;
                }
            }
            lasts |= look >= latest;
            for ((id, called), stood) in AlarmId::ALL.into_iter().zip(&mut alarms).zip(&mut stood) {
                let active = session.alarms().active(id);
                // An alarm needs its delay before it stands; what the beginning brought is up by then.
                if gone < SETTLING {
                    *stood = active.is_some();
                } else if let Some(priority) = active
                    && (!*stood || lasts)
                {
                    if called.worst.is_none() {
                        called.first = gone;
                    }
                    called.worst = called.worst.max(Some(priority));
                } else if active.is_none() {
                    *stood = false;
                }
            }
            // Only the time in which every alarm must have ended is measured: a
            // motion of the transition would count as one that lasts.
            match &mut self.measured {
                Some(measured) if lasts => measured.look(snapshot),
                Some(measured) => measured.skip(),
                None => {}
            }
            tally.add(snapshot);
            if let Some((trace, origin)) = &mut self.trace {
                // The run counts its steps from its start, not from the fork, so that the trace continues that of the
                // live run; a plausible tool has begun later than the twin.
                let time = *origin + self.run.ticks() as f64 * self.config.solver.time_step;
                trace.look(time, snapshot);
                trace.peaks(time, snapshot);
            }
            quality = quality.max(snapshot.quality.level);
            let is_calm = calm
                .as_mut()
                .is_some_and(|calm| calm.ends(look, snapshot, session.alarms()));
            if is_calm || enough(&alarms) {
                break;
            }
        }
        // The time that was run, not the horizon: a member that ended early
        // would otherwise show too little damage per hour.
        let judged = self.snapshot.time - begun;
        let figures = tally.figures((damage(&self.snapshot) - damage_before) / (judged / 3600.0));
        Ok(Member {
            alarms,
            figures,
            quality,
            trace: self.trace.map_or_else(Trace::default, |(trace, _)| trace),
            measured: self.measured,
            judged,
            way: 0.0,
        })
    }
}

/// Time (s) within which an alarm caused by the earlier motion stands: the longest on-delay of an alarm of the motion.
const SETTLING: f64 = 5.0;
