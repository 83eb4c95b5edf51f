//! The states that members begin from: one for all, or a plausible tool for each.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::draws::Draws;
use super::engine::seed;
use super::goal::Candidate;
use super::member::Ended;
use super::set_point::{SetPoint, Wavering};
use crate::alarms::AlarmSet;
use crate::ensemble::{Fork, Forks};
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::{BuildError, Run, RunInputs, Simulation};
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_uncertainty::Readings;

/// Why no member can begin.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The tool cannot be built, or the state is not one of it.
    #[error("the state to look ahead from: {0}")]
    Build(#[from] BuildError),
}

/// Why a member has no tool.
#[derive(Debug, Clone, PartialEq)]
pub enum NoTool {
    /// What would have come is unknown: in words.
    Unknown(String),
    /// A stop was requested.
    Stopped,
}

/// Gives the state that a member of a number begins from; it looks at the flag that stops it.
type Made = Arc<dyn Fn(u32, &AtomicBool) -> Result<Start, NoTool> + Send + Sync>;

/// What members begin from.
#[derive(Clone)]
enum Tools {
    /// All from this state.
    This,
    /// Each from a state that is made for its number.
    Made(Made),
    /// Each from the plausible tool that is drawn for its number.
    Forked(Arc<Forked>),
}

/// Plausible tools, and which of them a member of a number has.
struct Forked {
    forks: Forks,
    draws: Draws,
    set_point: SetPoint,
}

/// The state that all members begin from, or each its own.
pub struct Start {
    config: Arc<Config>,
    /// The state, under what the rig's readings amount to.
    run: Run,
    /// What the rig shows: of speed and weight not what acts.
    shown: RunInputs,
    readings: Readings,
    /// Time of the run (s), where the state does not count it from the twin's start.
    time: Option<f64>,
    tools: Tools,
    /// How the rig's inputs waver about what is set.
    wavering: Arc<[[f64; 4]]>,
    /// Alarms that stand in the tool.
    standing: AlarmSet,
}

impl Start {
    /// From a simulation of the configuration's tool: its present state, under what acts on it.
    pub fn new(config: Arc<Config>, simulation: Simulation, applied: &RunInputs) -> Self {
        let run = Run::resumed(simulation, applied);
        Self {
            shown: run.applied(),
            run,
            readings: Readings::default(),
            time: None,
            tools: Tools::This,
            config,
            wavering: Arc::default(),
            standing: AlarmSet::EMPTY,
        }
    }

    /// The same state on a rig whose sensors show something else than what acts.
    #[must_use]
    pub fn on_rig(self, readings: Readings) -> Self {
        Self { readings, ..self }
    }

    /// Members are other tools: `tools` gives the state that a member of a number begins from, the same for each candidate.
    #[must_use]
    pub fn with_tools(self, tools: impl Fn(u32, &AtomicBool) -> Result<Self, NoTool> + Send + Sync + 'static) -> Self {
        Self {
            tools: Tools::Made(Arc::new(tools)),
            ..self
        }
    }

    /// The same state on a rig whose driller has set `set_point`: a sample that wavers about it is no target, and members
    /// waver as the rig did within the last minute.
    #[must_use]
    pub fn about(mut self, set_point: &SetPoint) -> Self {
        if let Some(inputs) = set_point.inputs() {
            self.shown.inputs = inputs;
            let refinement = self.run.applied().refinement;
            self.run.apply(&RunInputs {
                refinement,
                ..self.readings.acting(&self.shown)
            });
            self.wavering = set_point.wavering();
        }
        self
    }

    /// Members are the plausible tools of `forks`, about what the driller has set, drawn by their weights: which of them a member
    /// of a number has follows from `seed` alone, and is the same for each candidate. A tool that failed is drawn as often
    /// as one of mean weight, and its member is unknown.
    #[must_use]
    pub fn among(self, forks: Forks, seed: u64, set_point: &SetPoint) -> Self {
        let draws = Draws::new(&forks.weights(), seed);
        Self {
            time: Some(forks.time),
            tools: Tools::Forked(Arc::new(Forked {
                forks,
                draws,
                set_point: set_point.clone(),
            })),
            ..self
        }
    }

    /// The same state, for all members, with other coefficients of friction of both layers: those in force times `factor`.
    #[must_use]
    pub fn rubbing(&self, factor: f64) -> Self {
        let mut run = self.run.fork();
        let mut live = run.applied().live;
        for friction in [&mut live.inner_friction, &mut live.outer_friction] {
            *friction = friction.map(|own| factor * own);
        }
        run.apply(&RunInputs { live, ..run.applied() });
        Self {
            config: Arc::clone(&self.config),
            run,
            shown: RunInputs { live, ..self.shown },
            readings: self.readings,
            time: None,
            tools: Tools::This,
            wavering: Arc::clone(&self.wavering),
            standing: self.standing,
        }
    }

    /// A plausible tool in its present state.
    fn of_fork(fork: &Fork, time: f64) -> Self {
        Self {
            config: Arc::clone(&fork.config),
            run: fork.run.fork(),
            shown: fork.shown,
            readings: fork.readings,
            time: Some(time),
            tools: Tools::This,
            wavering: Arc::default(),
            standing: fork.standing,
        }
    }

    /// From the bytes of a checkpoint. `tool` is a simulation of the configuration's tool in any state.
    ///
    /// # Errors
    /// When the checkpoint is one of another tool, or damaged.
    pub fn restored(
        config: Arc<Config>,
        tool: &Simulation,
        checkpoint: &[u8],
        applied: &RunInputs,
    ) -> Result<Self, StartError> {
        let mut simulation = tool.fork();
        simulation.restore(checkpoint).map_err(BuildError::from)?;
        Ok(Self::new(config, simulation, applied))
    }

    /// The configuration of the tool.
    pub fn config(&self) -> &Arc<Config> {
        &self.config
    }

    /// What the rig shows now; it acts as the rig's sensors have it.
    pub fn applied(&self) -> RunInputs {
        self.shown
    }

    /// A run in this state.
    pub(super) fn run(&self) -> Run {
        self.run.fork()
    }

    /// The run in this state.
    pub(super) fn state(&self) -> &Run {
        &self.run
    }

    /// Time of the state since the twin's start (s).
    pub(super) fn time(&self) -> f64 {
        self.time
            .unwrap_or_else(|| self.run.ticks() as f64 * self.config.solver.time_step)
    }

    /// Alarms that stand in the tool, where it is a plausible one.
    pub(super) fn standing(&self) -> AlarmSet {
        self.standing
    }

    /// Whether all members begin from this state.
    pub(super) fn is_shared(&self) -> bool {
        matches!(self.tools, Tools::This)
    }

    /// Whether each member has a state that is made for it.
    pub(super) fn is_made(&self) -> bool {
        matches!(self.tools, Tools::Made(_))
    }

    /// How many tools these members have; 0 where none is drawn.
    pub(super) fn tools(&self, members: impl Iterator<Item = u32>) -> u32 {
        let Tools::Forked(forked) = &self.tools else { return 0 };
        let mut drawn: Vec<usize> = members.filter_map(|member| forked.draws.of(member)).collect();
        drawn.sort_unstable();
        drawn.dedup();
        drawn.len() as u32
    }

    /// Lends the state that a member begins from.
    pub(super) fn with_tool<T>(
        &self,
        member: u32,
        stop: &AtomicBool,
        work: impl FnOnce(&Self) -> Result<T, Ended>,
    ) -> Result<T, Ended> {
        match &self.tools {
            Tools::This => work(self),
            Tools::Made(tools) => match tools(member, stop) {
                Ok(own) => work(&own),
                Err(NoTool::Unknown(why)) => Err(Ended::NoTool(why)),
                Err(NoTool::Stopped) => Err(Ended::Stopped),
            },
            Tools::Forked(forked) => {
                let drawn = forked.draws.of(member).and_then(|tool| forked.forks.tools.get(tool));
                match drawn {
                    Some(Ok(fork)) => work(&Self::of_fork(fork, forked.forks.time).about(&forked.set_point)),
                    Some(Err(why)) => Err(Ended::NoTool(why.clone())),
                    None => Err(Ended::NoTool("no plausible tool can be drawn".to_owned())),
                }
            }
        }
    }

    /// The wavering of a member, which begins at its own look.
    pub(super) fn wavering(&self, of_goal: u64, candidate: usize, member: u32) -> Wavering {
        Wavering::from(&self.wavering, seed(of_goal, candidate, member))
    }

    /// What acts from here on under a candidate.
    pub(super) fn target(&self, candidate: &Candidate) -> RunInputs {
        let applied = self.shown;
        let mut slew = applied.slew;
        if candidate.speed_ramp > 0.0 {
            slew[0] = rpm_to_rad_per_s(candidate.speed_ramp);
        }
        if candidate.weight_ramp > 0.0 {
            slew[1] = kn_to_n(candidate.weight_ramp);
        }
        let acts = self.readings.acting(&RunInputs {
            inputs: Inputs {
                rotary_speed: rpm_to_rad_per_s(candidate.rotary_speed),
                weight_on_bit: kn_to_n(candidate.weight_on_bit),
                ..applied.inputs
            },
            slew,
            ..applied
        });
        RunInputs {
            refinement: self.run.applied().refinement,
            ..acts
        }
    }
}
