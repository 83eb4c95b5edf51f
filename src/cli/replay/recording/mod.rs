//! Replays a recording of flexdrill: its configuration and its applied inputs, step by step, give the same outputs to
//! the bit.
//!
//! A bag that another program began to record while the twin ran (`ros2 bag record -a`) begins with the first applied
//! inputs that the program received. No message holds the model's state at that step, so its replay begins with the
//! tool at rest.

#[cfg(test)]
mod tests;

use std::path::Path;
use std::sync::Arc;

use anyhow::Context as _;

use super::player::{Player, asks_for_members};
use super::steps::{Base, Pace, step_of};
use crate::bag::{self, Bag, BagError, Gap, Gaps, PartFault};
use crate::cli::output::{say, tell};
use crate::cli::progress::Progress;
use crate::cli::source::{FromRig, MeasuredSample, SurveySample};
use crate::drilling::live::surveys_of;
use crate::ensemble::Generation;
use crate::messages::topics::{self, TopicInfo};
use crate::messages::{
    Ageing, AppliedInputs, Bands, HoleAhead, JointDeflections, Message, Residuals, RigInputs, RigMeasured, RigSurvey,
    SafeWindow as WindowMessage, SessionInfo, TwinStatus,
};
use crate::residuals::Samples;
use crate::safe_window::SafeWindow;
use flexdrill_config::Config;
use flexdrill_core::twin::RunInputs;
use flexdrill_hole::Survey;
use flexdrill_life::LivingJoints;
use flexdrill_outputs::{ParameterChange, run_inputs};
use flexdrill_text::printable;
use flexdrill_uncertainty::Posterior;

/// Possible differences between a replay and the recorded run.
#[derive(Debug, Default)]
pub(super) struct Exactness {
    /// Reasons why it is not the same to the bit.
    pub departures: Vec<String>,
    /// Further notes.
    pub notes: Vec<String>,
}

/// Everything in a recording that drives a replay.
pub(super) struct Script {
    session: SessionInfo,
    applied: Vec<AppliedInputs>,
    /// What the rig sent, in the order of arrival; of the inputs, those on `rig/inputs`, which carry their source.
    from_rig: FromRig,
    /// What the rig had measured when it was compared with the twin, by stamp.
    samples: Vec<(i64, Samples)>,
    /// The surveys that were known at an instant (ns since 1970), from there on until others were, in the order of time.
    surveys: Vec<(i64, Arc<[Survey]>)>,
    /// The first ageing, which says what the joints had lived before the run.
    ageing: Option<Ageing>,
    /// The map that speed and weight were judged by, where the run had one.
    window: Option<Arc<SafeWindow>>,
    /// Plausible tools that ran with it, by the instant at which they began (ns since 1970), in the order of time.
    ensembles: Vec<(i64, Generation)>,
    /// Names of the recorded topics by relative name.
    names: Vec<(&'static str, String)>,
    /// Steps taken at the end, since the last reset.
    last_step: u64,
    /// Messages that the recording lost.
    gaps: Vec<Gap>,
    /// Damaged parts of the recording.
    damaged: Vec<String>,
    /// Differences between its files and its metadata.
    faults: Vec<PartFault>,
}

/// Whether a bag is a recording of the twin: it holds the session with the configuration.
pub(super) fn is_ours(bag: &Bag) -> bool {
    bag.topics().iter().any(|topic| topic.ros_type == SessionInfo::ROS_TYPE)
}

impl Script {
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let mut bag = bag::open(path)?;
        let wanted = [
            SessionInfo::ROS_TYPE,
            AppliedInputs::ROS_TYPE,
            TwinStatus::ROS_TYPE,
            JointDeflections::ROS_TYPE,
            RigInputs::ROS_TYPE,
            RigMeasured::ROS_TYPE,
            RigSurvey::ROS_TYPE,
            HoleAhead::ROS_TYPE,
            Residuals::ROS_TYPE,
            Bands::ROS_TYPE,
            Ageing::ROS_TYPE,
            WindowMessage::ROS_TYPE,
        ];
        // Only these types are decoded: they drive the model or say where
        // it was; the rest of a recording is far larger.
        bag.select(|topic| wanted.contains(&topic.ros_type.as_str()));
        // Names may be remapped, so the type finds the topic and the configured name decides between several.
        let names = topics::ALL
            .iter()
            .filter_map(|known| {
                let mut same = bag
                    .topics()
                    .iter()
                    .filter(|topic| topic.ros_type == known.kind.ros_type);
                let found = same
                    .clone()
                    .find(|topic| topic.is(known.name))
                    .or_else(|| same.next())?;
                Some((known.name, found.name.clone()))
            })
            .collect();
        let (mut session, mut applied, mut gaps) = (None, Vec::new(), Gaps::default());
        let (mut damaged, mut from_rig, mut samples) = (Vec::new(), FromRig::default(), Vec::new());
        let (mut status_step, mut newest_stamp) = (0, None);
        let mut ensembles: Vec<(i64, Generation)> = Vec::new();
        let mut surveys: Vec<(i64, Arc<[Survey]>)> = Vec::new();
        let mut ageing: Option<Ageing> = None;
        let mut window: Option<Arc<SafeWindow>> = None;
        for message in bag.by_ref() {
            let message = match message {
                // The sequence numbers of the messages around a damaged part show the loss.
                Err(error @ BagError::Damaged { .. }) => {
                    damaged.push(error.to_string());
                    continue;
                }
                message => message?,
            };
            gaps.observe(&message);
            match message.topic.ros_type.as_str() {
                SessionInfo::ROS_TYPE => {
                    session.get_or_insert(message.decode::<SessionInfo>()?);
                }
                AppliedInputs::ROS_TYPE => {
                    let inputs = message.decode::<AppliedInputs>()?;
                    // A reset begins the count of steps again, so what was seen before says nothing about the end.
                    if inputs.reset {
                        status_step = 0;
                        newest_stamp = None;
                    }
                    applied.push(inputs);
                }
                RigInputs::ROS_TYPE => from_rig.inputs.push((message.log_time, message.decode()?)),
                RigMeasured::ROS_TYPE => from_rig.measured.push(MeasuredSample {
                    time: message.log_time,
                    message: message.decode()?,
                }),
                RigSurvey::ROS_TYPE => from_rig.surveys.push(SurveySample {
                    time: message.log_time,
                    message: message.decode()?,
                }),
                HoleAhead::ROS_TYPE => {
                    // Twins that knew no surveys did not list them.
                    let Ok(hole) = message.decode::<HoleAhead>() else {
                        continue;
                    };
                    let known = surveys_of(&hole);
                    let before = surveys.last().map_or(&[] as &[Survey], |(_, known)| known);
                    if *before != *known {
                        surveys.push((hole.header.stamp.to_nanoseconds(), known.into()));
                    }
                }
                Ageing::ROS_TYPE => {
                    // What was lived before is the same in all of them. Twins that knew no lives say none.
                    if ageing.is_none() {
                        ageing = message.decode().ok();
                    }
                }
                // The recording has all of the map, so that a replay needs no file.
                WindowMessage::ROS_TYPE => match SafeWindow::of_recording(message.decode()?) {
                    Ok(found) => window = Some(Arc::new(found)),
                    Err(error) => damaged.push(error.to_string()),
                },
                TwinStatus::ROS_TYPE => {
                    status_step = message.decode::<TwinStatus>()?.step_count;
                }
                Residuals::ROS_TYPE => {
                    let residuals = message.decode::<Residuals>()?;
                    samples.push((residuals.header.stamp.to_nanoseconds(), Samples::of(&residuals)));
                }
                Bands::ROS_TYPE => {
                    let bands = message.decode::<Bands>()?;
                    let begun = bands.begun.to_nanoseconds();
                    if ensembles.last().is_none_or(|(last, _)| *last < begun) {
                        let why = if bands.members == 0 {
                            bands.no_bands
                        } else {
                            String::new()
                        };
                        let of = Generation {
                            members: bands.members,
                            why,
                            ..Generation::default()
                        };
                        ensembles.push((begun, of));
                    }
                }
                // The last output bounds the run where the status, once a second, came too early.
                _ => newest_stamp = Some(message.decode::<JointDeflections>()?.header.stamp.to_nanoseconds()),
            }
        }
        // A file that was cut in a crash is the usual reason to replay it, so it is used as far as it reaches.
        for cut in bag.cuts() {
            tell!(
                "{} was cut short ({}); the replay ends there",
                cut.path.display(),
                cut.reason
            );
        }
        let session = session.with_context(|| format!("{}: it has no {}", path.display(), topics::SESSION.name))?;
        // Whichever message came last shows how far the run had got.
        let last_step = status_step.max(step_of(newest_stamp, &session, &applied));
        Ok(Self {
            session,
            applied,
            from_rig,
            samples,
            surveys,
            ageing,
            window,
            ensembles,
            names,
            last_step,
            gaps: gaps.found(),
            damaged,
            faults: bag.faults().to_vec(),
        })
    }

    /// Whether the recording has no applied inputs: it began and ended between two such messages.
    pub(super) fn is_empty(&self) -> bool {
        self.applied.is_empty()
    }

    /// The configuration at the start of the run.
    ///
    /// # Errors
    /// When this version cannot read it.
    pub(super) fn config(&self) -> anyhow::Result<Config> {
        Ok(Config::from_text(
            "the recorded configuration",
            &self.session.configuration,
        )?)
    }

    /// The map that speed and weight were judged by, where the run had one.
    pub(super) fn window(&self) -> Option<Arc<SafeWindow>> {
        self.window.clone()
    }

    /// The posterior that its plausible tools were drawn from, if they were: in the file `given`, or in the recorded one next
    /// to the recording `at`.
    ///
    /// # Errors
    /// When the file is not there, or is another one: the replay would have other plausible tools.
    pub(super) fn posterior(
        &self,
        config: &Config,
        given: Option<&Path>,
        at: &Path,
    ) -> anyhow::Result<Option<Arc<Posterior>>> {
        let stated = config.ensemble.as_ref();
        let Some((stated, file)) = stated.and_then(|stated| Some((stated, stated.posterior()?))) else {
            return Ok(None);
        };
        if self.ensembles.is_empty() && !asks_for_members(config) {
            return Ok(None);
        }
        let path = given.map_or_else(|| at.with_file_name(file), Path::to_owned);
        let posterior = Posterior::load(&path, config).with_context(|| {
            format!(
                "the recorded run drew its plausible tools from {} (SHA-256 {}); give that file with --posterior",
                printable(file),
                printable(stated.posterior_sha256.as_deref().unwrap_or("not recorded"))
            )
        })?;
        Ok(Some(Arc::new(posterior)))
    }

    /// Possible differences between its replay and the recorded run.
    pub(super) fn exactness(&self) -> Exactness {
        let mut exactness = Exactness::default();
        // Departures make the outputs differ; notes are losses that do not reach the model.
        let Some(first) = self.applied.first() else {
            exactness.departures.push(format!(
                "the recording has no {}: the inputs are used as received, and conditioned again",
                topics::APPLIED_INPUTS.name
            ));
            return exactness;
        };
        // A recording that another program began later lacks the state at its first step.
        if first.step > 0 && !first.reset {
            exactness.departures.push(format!(
                "the recording begins at step {} of the run and does not have the model's state at that step: \
                 the replay begins there with the tool at rest",
                first.step
            ));
        }
        // Recorders of other programs that were started late, or without transient durability, have no latched message.
        let names_a_map = self.config().is_ok_and(|config| config.map.file.is_some());
        if names_a_map && self.window.is_none() {
            exactness.departures.push(format!(
                "the recording has no {}, the map of its run (map.file): known_window is not judged",
                topics::SAFE_WINDOW.name
            ));
        }
        // Applied inputs and residuals act on the replay; gaps of all other
        // topics are losses of outputs, which the replay makes again.
        for gap in &self.gaps {
            if gap.topic.ros_type == AppliedInputs::ROS_TYPE {
                exactness.departures.push(format!(
                    "the recording has a gap in the applied inputs ({gap}): \
                     the replay continues with the inputs before it"
                ));
            } else if gap.topic.ros_type == Residuals::ROS_TYPE {
                exactness.departures.push(format!(
                    "the recording has a gap in what the rig measured ({gap}): the comparison with the twin differs from there on"
                ));
            } else if gap.topic.ros_type == HoleAhead::ROS_TYPE && !self.surveys.is_empty() {
                exactness.departures.push(format!(
                    "the recording has a gap in the hole ahead ({gap}), which says when a survey was used: the hole ahead may differ \
                     there"
                ));
            } else {
                exactness.notes.push(format!("the recording has a gap ({gap})"));
            }
        }
        for fault in &self.faults {
            if fault.loses() {
                exactness
                    .departures
                    .push(format!("a part of the recording is missing: {fault}"));
            } else {
                exactness.notes.push(fault.to_string());
            }
        }
        let damaged = self.damaged.iter();
        exactness
            .notes
            .extend(damaged.map(|damage| format!("the recording is damaged: {damage}")));
        // Another version may round or order differently, so equal bits are no promise.
        if self.session.version != env!("CARGO_PKG_VERSION") {
            exactness.departures.push(format!(
                "recorded with flexdrill {}, replayed with {}: outputs may differ",
                self.session.version,
                env!("CARGO_PKG_VERSION")
            ));
        }
        exactness
    }

    /// The recorded name of a topic.
    fn name(&self, topic: &TopicInfo) -> String {
        self.names
            .iter()
            .find(|(name, _)| *name == topic.name)
            .map_or_else(|| format!("/{}", topic.name), |(_, name)| name.clone())
    }

    /// Replays the recording into `out`, at most `duration` s of model time.
    /// Its plausible tools are drawn from `posterior` where the recorded run drew them from one.
    pub(super) fn replay(
        &self,
        out: &Path,
        duration: Option<f64>,
        posterior: Option<Arc<Posterior>>,
        looks_ahead: bool,
    ) -> anyhow::Result<(Player, Progress)> {
        let config = self.config()?;
        let time_step = config.solver.time_step;
        let total = self.total() as f64 * time_step;
        say!(
            "recording of configuration {}, {} messages of inputs, {total} s",
            printable(short(&self.session.config_hash)),
            self.applied.len(),
        );
        // Steps and skips of the messages count from the start of the node,
        // those of the player from the start of the replay.
        let mut base = Base::of(&self.session, self.applied.first());
        let (from_rig, window) = (self.from_rig.clone(), self.window());
        let mut player = Player::new(config, base.start, from_rig, window, out, |topic| self.name(topic))?;
        player.end_by_signal()?;
        player.compare_with(self.samples.iter().copied());
        player.survey_with(self.surveys.iter().cloned());
        let lives = self.ageing.as_ref();
        if let Some(lives) = lives.and_then(|ageing| LivingJoints::of_recording(player.config(), ageing)) {
            player.continue_lives(lives);
        }
        let ensembles = self.ensembles.iter().map(|(begun, generation)| Generation {
            begun: ((begun - base.start) as f64 * 1e-9 / time_step).round().max(0.0) as u64,
            ..generation.clone()
        });
        player.run_ensemble(ensembles.collect(), posterior)?;
        if looks_ahead {
            player.look_ahead();
        }
        let mut pace = Pace {
            taken: 0,
            most: duration.map_or(u64::MAX, |duration| (duration / time_step).round() as u64),
            time_step,
            progress: Progress::new(total.min(duration.unwrap_or(f64::INFINITY))),
        };
        for (index, message) in self.applied.iter().enumerate() {
            if base.step(message.step) != Some(player.step()) {
                // The steps do not fit, so a message with a reset was lost.
                let inputs = RunInputs {
                    reset: true,
                    ..player.inputs()
                };
                player.apply(&inputs, &[], false)?;
                base.step = 0;
                pace.advance(&mut player, message.step)?;
            }
            let changes = changes_of(message);
            let values = changes.iter().map(|change| (&change.name, change.value));
            let changed = player.config().with_live_values("recorded parameters", values)?;
            // The twin repeats all values every second; only a difference is a change.
            if changed != *player.config() {
                player.reconfigure(changed, &changes);
            }
            let inputs = RunInputs {
                skipped: message.skipped_steps.saturating_sub(base.skipped),
                ..run_inputs(message, player.config(), player.initial_rates())
            };
            player.apply(&inputs, &changes, index == 0)?;
            if message.reset {
                base.step = 0;
            }
            // The inputs hold until the step of the next message. After the last
            // one the recording's end is known from its outputs.
            let next = self.applied.get(index + 1).map_or(self.last_step, |next| next.step);
            if let Some(until) = base.step(next) {
                pace.advance(&mut player, until)?;
            }
            if pace.taken >= pace.most || player.is_stopped() {
                break;
            }
        }
        if pace.taken < pace.most && !player.is_stopped() {
            // What arrived after the last output.
            player.record_from_rig(i64::MAX)?;
        }
        Ok((player, pace.progress))
    }

    /// Steps that the recording spans, over all resets.
    fn total(&self) -> u64 {
        let before_resets: u64 = self
            .applied
            .iter()
            .filter(|inputs| inputs.reset)
            .map(|inputs| inputs.step)
            .sum();
        let before = match self.applied.first() {
            Some(first) => first.step,
            None => 0,
        };
        (before_resets + self.last_step).saturating_sub(before)
    }
}

fn changes_of(message: &AppliedInputs) -> Vec<ParameterChange> {
    let values = message.parameter_name.iter().zip(&message.parameter_value);
    let mut asked_by = message.parameter_asked_by.iter().cloned();
    values
        .map(|(name, value)| ParameterChange {
            name: name.clone(),
            value: *value,
            asked_by: asked_by.next().unwrap_or_default(),
        })
        .collect()
}

fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}
