//! A recording of ours again: its configuration, its applied inputs step by step, the same outputs to the bit.

use std::path::Path;

use anyhow::{Context as _, bail};

use super::player::Player;
use crate::bag::{self, Bag};
use crate::cli::progress::Progress;
use crate::messages::outputs::{ParameterChange, run_inputs};
use crate::messages::topics::{self, TopicInfo};
use crate::messages::{AppliedInputs, JointDeflections, Message, SessionInfo, TwinStatus};
use crate::told::printable;
use flexdrill_config::Config;

/// What of a recording is needed.
pub(super) struct Script {
    session: SessionInfo,
    applied: Vec<AppliedInputs>,
    /// Names of the recorded topics by relative name.
    names: Vec<(&'static str, String)>,
    /// Steps taken at the end, since the last reset.
    last_step: u64,
}

/// Whether a bag is a recording of ours.
pub(super) fn is_ours(bag: &Bag) -> bool {
    let has = |ros_type: &str| bag.topics().iter().any(|topic| topic.ros_type == ros_type);
    has(SessionInfo::ROS_TYPE) && has(AppliedInputs::ROS_TYPE)
}

impl Script {
    /// Reads what drives the run.
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let mut bag = bag::open(path)?;
        let wanted = [
            SessionInfo::ROS_TYPE,
            AppliedInputs::ROS_TYPE,
            TwinStatus::ROS_TYPE,
            JointDeflections::ROS_TYPE,
        ];
        bag.select(|topic| wanted.contains(&topic.ros_type.as_str()));
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
        let (mut session, mut applied) = (None, Vec::new());
        let (mut status_step, mut newest_stamp) = (0, None);
        for message in bag.by_ref() {
            // A damaged part loses what is in it; a lost AppliedInputs shows by its step.
            let message = message?;
            match message.topic.ros_type.as_str() {
                SessionInfo::ROS_TYPE => {
                    session.get_or_insert(message.decode::<SessionInfo>()?);
                }
                AppliedInputs::ROS_TYPE => {
                    let inputs: AppliedInputs = message.decode()?;
                    if inputs.reset {
                        status_step = 0;
                        newest_stamp = None;
                    }
                    applied.push(inputs);
                }
                TwinStatus::ROS_TYPE => {
                    status_step = message.decode::<TwinStatus>()?.step_count;
                }
                _ => newest_stamp = Some(message.decode::<JointDeflections>()?.header.stamp.to_nanoseconds()),
            }
        }
        for cut in bag.cuts() {
            eprintln!(
                "{} was cut short ({}); what is there is replayed",
                cut.path.display(),
                cut.reason
            );
        }
        let session = session.with_context(|| format!("{}: it holds no {}", path.display(), topics::SESSION.name))?;
        if applied.is_empty() {
            bail!(
                "{}: it holds no {}; the run ended before the first step",
                path.display(),
                topics::APPLIED_INPUTS.name
            );
        }
        let last_step = status_step.max(step_of(newest_stamp, &session, &applied));
        Ok(Self {
            session,
            applied,
            names,
            last_step,
        })
    }

    /// The recorded name of a topic.
    fn name(&self, topic: &TopicInfo) -> String {
        self.names
            .iter()
            .find(|(name, _)| *name == topic.name)
            .map_or_else(|| format!("/{}", topic.name), |(_, name)| name.clone())
    }

    /// Replays it into `out`, at most `duration` s of model time.
    pub(super) fn replay(&self, out: &Path, duration: Option<f64>) -> anyhow::Result<(Player, Progress)> {
        let config = Config::from_text("the recorded configuration", &self.session.configuration)?;
        let start = self.session.start.to_nanoseconds();
        if self.session.version != env!("CARGO_PKG_VERSION") {
            eprintln!(
                "recorded with flexdrill {}, replayed with {}: outputs may differ",
                printable(&self.session.version),
                env!("CARGO_PKG_VERSION")
            );
        }
        let time_step = config.solver.time_step;
        println!(
            "recording of configuration {}, {} changes of inputs, {} s",
            printable(short(&self.session.config_hash)),
            self.applied.len(),
            self.total(time_step)
        );
        let mut player = Player::new(config, start, out, |topic| self.name(topic))?;
        let most = duration.map_or(u64::MAX, |duration| (duration / time_step).round() as u64);
        let mut progress = Progress::new(self.total(time_step).min(duration.unwrap_or(f64::INFINITY)));
        let mut taken = 0_u64;
        for (index, message) in self.applied.iter().enumerate() {
            if message.step != player.step() {
                bail!(
                    "{}: the inputs of step {} are missing; the recording lost messages",
                    topics::APPLIED_INPUTS.name,
                    player.step()
                );
            }
            let changes = changes_of(message);
            if !changes.is_empty() {
                let values = changes.iter().map(|(name, value)| (name, *value));
                let changed = player.config().with_values("recorded parameters", values)?;
                player.reconfigure(changed);
            }
            let inputs = run_inputs(message, player.config());
            player.apply(&inputs, &changes, index == 0)?;
            let until = self.applied.get(index + 1).map_or(self.last_step, |next| next.step);
            while player.step() < until && taken < most {
                player.advance_surely()?;
                taken += 1;
                progress.at(taken as f64 * time_step);
            }
            if taken >= most {
                break;
            }
        }
        Ok((player, progress))
    }

    /// Model time that the recording spans, over all resets (s).
    fn total(&self, time_step: f64) -> f64 {
        let before_resets: u64 = self
            .applied
            .iter()
            .filter(|inputs| inputs.reset)
            .map(|inputs| inputs.step)
            .sum();
        (before_resets + self.last_step) as f64 * time_step
    }
}

/// Steps since the last reset at the newest output, for recordings whose last status is older than that.
fn step_of(newest: Option<i64>, session: &SessionInfo, applied: &[AppliedInputs]) -> u64 {
    let (Some(newest), Some(last)) = (newest, applied.last()) else {
        return 0;
    };
    let ticks = ((newest - session.start.to_nanoseconds()) as f64 * 1e-9 / session.time_step)
        .round()
        .max(0.0) as u64;
    let before_resets: u64 = applied
        .iter()
        .filter(|inputs| inputs.reset)
        .map(|inputs| inputs.step)
        .sum();
    let since = ticks.saturating_sub(before_resets + last.skipped_steps);
    // An output older than the last change of inputs says nothing of the steps after it.
    if since >= last.step || last.reset {
        since
    } else {
        last.step
    }
}

fn changes_of(message: &AppliedInputs) -> Vec<ParameterChange> {
    message
        .parameter_name
        .iter()
        .cloned()
        .zip(message.parameter_value.iter().copied())
        .collect()
}

fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}
