//! One plausible tool: its run under the twin's inputs, as its rig takes them, judged as the node judges the twin.

use std::sync::Arc;

use super::engine::Slice;
use super::evidence::Windows;
use super::fork::Fork;
use crate::alarms::{AlarmBook, AlarmId};
use flexdrill_alarms::{Priority, span};
use flexdrill_config::Config;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::tool::LiveParameters;
use flexdrill_core::twin::{Run, RunInputs, Simulation, Snapshot};
use flexdrill_outputs::figures::OverTools;
use flexdrill_uncertainty::{Member as Drawn, Readings};

/// Time between two choices of the step's refinement (s): that of the live run.
const CHOICE: f64 = 5e-3;
/// Time between two looks at the motion (s): that between two judgements of the live run's alarms.
pub(super) const LOOK: f64 = 0.1;

/// A plausible tool that runs.
pub(super) struct Member {
    config: Arc<Config>,
    /// Friction and bit as drawn, which no change of the twin's moves.
    live: LiveParameters,
    /// Errors of the sensors of the inputs.
    readings: Readings,
    run: Run,
    snapshot: Snapshot,
    alarms: AlarmBook,
    figures: OverTools,
    /// Largest normal forces of both layers since they were taken, by station.
    peaks: [Vec<f64>; 2],
    pub(super) windows: Windows,
}

/// What a member did in a second.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Second {
    /// By [`OverTools::known`].
    pub(super) figures: Vec<f64>,
    /// Measured depth of the stations (m).
    pub(super) measured_depth: Vec<f64>,
    /// Largest normal forces of both layers (N), by station.
    pub(super) peaks: [Vec<f64>; 2],
    /// Alarms that stand, by [`AlarmId::ALL`].
    pub(super) alarms: Vec<Option<Priority>>,
}

impl Member {
    /// Builds the tool and lets it come to rest under what acts.
    ///
    /// # Errors
    /// Why there is no such tool, in words.
    pub(super) fn new(drawn: &Drawn, applied: &RunInputs) -> Result<Self, String> {
        let config = Arc::new(drawn.config.clone());
        let readings = Readings::of(drawn);
        let live = config.live();
        let acts = taken(applied, live, readings);
        let settings = config
            .simulation()
            .with(|settings| settings.initial_inputs = acts.inputs);
        let simulation = Simulation::new(&config.tool(), &settings).map_err(|error| error.to_string())?;
        let snapshot = simulation.new_snapshot();
        let refinement = simulation.quality().choice.wanted;
        let time = span(snapshot.time);
        Ok(Self {
            run: Run::resumed(simulation, &RunInputs { refinement, ..acts }),
            alarms: AlarmBook::fresh(Arc::clone(&config), time),
            live,
            readings,
            snapshot,
            figures: OverTools::default(),
            peaks: Default::default(),
            windows: Windows::new(drawn),
            config,
        })
    }

    /// The newest look at the motion.
    pub(super) fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    /// Adopts the thresholds and parameters of a drawn configuration in which other keys than the drawn ones changed.
    pub(super) fn reconfigure(&mut self, config: &Config) {
        self.config = Arc::new(config.clone());
        self.live = self.config.live();
        self.alarms.reconfigure(&self.config, &[]);
    }

    /// Runs a slice: every tick is a step, also one that the live run has skipped.
    ///
    /// # Errors
    /// Why a step failed, in words.
    pub(super) fn advance(&mut self, slice: &Slice<'_>) -> Result<(), String> {
        let step = self.config.solver.time_step;
        let every = |time: f64| ((time / step).round() as u64).max(1);
        let (choice, look) = (every(CHOICE), every(LOOK));
        let mut applied = slice.applied.iter().peekable();
        for tick in slice.from..slice.to {
            while let Some((_, inputs)) = applied.next_if(|(at, _)| *at <= tick) {
                self.apply(inputs);
            }
            if tick.is_multiple_of(choice) {
                let applied = self.run.applied();
                let refinement = self.run.wanted_refinement();
                if refinement != applied.refinement {
                    self.run.apply(&RunInputs { refinement, ..applied });
                }
            }
            if let StepOutcome::Failed(failure) = self.run.advance() {
                return Err(format!("the step at {:.1} s failed: {failure}", failure.time));
            }
            if (tick + 1).is_multiple_of(look) {
                self.look();
            }
        }
        Ok(())
    }

    fn apply(&mut self, inputs: &RunInputs) {
        let refinement = self.run.applied().refinement;
        let acts = taken(inputs, self.live, self.readings);
        self.run.apply(&RunInputs { refinement, ..acts });
        if inputs.reset {
            self.run.look(&mut self.snapshot);
            self.alarms = AlarmBook::fresh(Arc::clone(&self.config), span(self.snapshot.time));
            self.windows.restart();
        }
    }

    fn look(&mut self) {
        self.run.look(&mut self.snapshot);
        self.alarms.observe_tool(&self.snapshot, span(self.snapshot.time));
        // Nobody reads the journal of a member.
        drop(self.alarms.take_events());
        self.figures.add(&self.snapshot);
        let contacts = &self.snapshot.contacts;
        for (peaks, layer) in self.peaks.iter_mut().zip([&contacts.pipe_guide, &contacts.guide_wall]) {
            peaks.resize(layer.normal_peak.len(), 0.0);
            for (peak, value) in peaks.iter_mut().zip(&layer.normal_peak) {
                *peak = peak.max(*value);
            }
        }
    }

    /// Its present state, while the rig shows `shown`.
    pub(super) fn fork(&self, shown: &RunInputs) -> Fork {
        let stands = |id: &AlarmId| self.alarms.active(*id).is_some();
        Fork {
            config: Arc::clone(&self.config),
            run: self.run.fork(),
            shown: RunInputs {
                live: self.live,
                ..*shown
            },
            readings: self.readings,
            standing: AlarmId::ALL.into_iter().filter(stands).collect(),
        }
    }

    /// What it did since the last call.
    pub(super) fn second(&mut self) -> Second {
        Second {
            figures: self.figures.take(),
            measured_depth: self.snapshot.contacts.measured_depth.clone(),
            peaks: std::mem::take(&mut self.peaks),
            alarms: AlarmId::ALL.map(|id| self.alarms.active(id)).to_vec(),
        }
    }
}

/// What acts on a member where `applied` acts on the twin: the rig's readings are those of its sensors, friction and bit its
/// drawn ones.
fn taken(applied: &RunInputs, live: LiveParameters, readings: Readings) -> RunInputs {
    RunInputs {
        live,
        ..readings.acting(applied)
    }
}
