//! Timed inputs of a field log or of another program's bag, passed through the same conditioner as live samples.

use std::path::Path;
use std::sync::Arc;

use super::player::Player;
use crate::alarms::Unknown;
use crate::cli::output::tell;
use crate::cli::progress::Progress;
use crate::cli::source::{FromRig, Samples};
use crate::messages::topics::TopicInfo;
use crate::safe_window::SafeWindow;
use flexdrill_config::Config;
use flexdrill_core::inputs::{Conditioner, InputKind, Stamp};
use flexdrill_core::twin::RunInputs;
use flexdrill_life::LivingJoints;
use flexdrill_realtime::INPUT_PERIOD;
use flexdrill_text::{counted, fixed};
use flexdrill_uncertainty::Posterior;

/// Model time after the last sample (s).
const TAIL: f64 = 1.0;

/// What a replay has next to its inputs.
#[derive(Default)]
pub(super) struct Along {
    /// What plausible tools are drawn from, where the configuration names a posterior.
    pub posterior: Option<Arc<Posterior>>,
    /// The lives of the joints, where a table has them.
    pub lives: Option<LivingJoints>,
    /// What speed and weight are judged by, where there is a map.
    pub window: Option<Arc<SafeWindow>>,
    /// Whether it searches for advice and forecasts.
    pub looks_ahead: bool,
}

/// Runs the model through the samples, which are in the order of their times.
pub(super) fn replay(
    config: Config,
    samples: Samples,
    out: &Path,
    duration: Option<f64>,
    along: Along,
) -> anyhow::Result<(Player, Progress)> {
    // The messages are formed before the samples are taken apart: the recording
    // gets them as received, the conditioner gets their values.
    let inputs = samples.messages();
    let Samples {
        inputs: samples,
        measured,
        surveys,
        ..
    } = samples;
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        anyhow::bail!("there is no sample of rotary speed or weight on bit to replay");
    };
    let time_step = config.solver.time_step;
    // The tail lets the model react to the last sample.
    let span = last.since(first) + TAIL;
    let span = duration.map_or(span, |duration| duration.min(span));
    let steps = (span / time_step).round() as u64;
    let per_period = ((INPUT_PERIOD / time_step).round() as u64).max(1);
    // The conditioner is the node's own, so that a replay shows what limits, ages and ramps would have done at the rig.
    let mut conditioner = Conditioner::new(config.inputs.rules_of(config.used_inputs()));
    let max_skew = config.inputs.stamp.max_skew;
    let mut player = Player::new(
        config,
        first.time,
        FromRig {
            inputs,
            measured,
            surveys,
        },
        along.window,
        out,
        |topic: &TopicInfo| {
            if topic.name.starts_with('/') {
                topic.name.to_owned()
            } else {
                format!("/{}", topic.name)
            }
        },
    )?;
    player.end_by_signal()?;
    player.run_ensemble(Vec::new(), along.posterior)?;
    if along.looks_ahead {
        player.look_ahead();
    }
    if let Some(lives) = along.lives {
        player.continue_lives(lives);
    }
    // An optional input that is missing everywhere is said once; each sample that lacks it would repeat it.
    for kind in InputKind::ALL.into_iter().filter(|kind| kind.is_optional()) {
        if conditioner.is_of_interest(kind) && !samples.iter().any(|sample| sample.kind == kind) {
            tell!(
                "{kind} is not in the source; the model assumes {} {} (inputs.{kind})",
                conditioner.rule(kind).initial,
                kind.unit()
            );
        }
    }
    let mut progress = Progress::new(span);
    let mut remaining = samples.iter().peekable();
    let mut applied: Option<RunInputs> = None;
    let mut refused = 0_u64;
    while player.step() < steps && !player.is_stopped() {
        let now = player.time_of(player.step());
        // All samples up to now, in the order of their times: as at the rig, the newest good one is in force.
        while let Some(sample) = remaining.next_if(|sample| sample.since(first) <= now) {
            let at = sample.since(first);
            let offered = match sample.stamp {
                None => conditioner.offer(sample.kind, sample.value, at),
                Some(stamp) => conditioner.offer_stamped(sample.kind, sample.value, at, &Stamp { max_skew, ..stamp }),
            };
            if let Err(rejection) = offered {
                refused += 1;
                // Ten are enough to see the pattern; the total follows at the end.
                if refused <= 10 {
                    tell!("at {} s: {rejection}", fixed(at, 2));
                }
            }
        }
        // Parameters that follow the rig act between periods, as in the node:
        // a change within a period would depend on its length.
        let changes = player.take_followed();
        if !changes.is_empty() {
            let values = changes.iter().map(|change| (&change.name, change.value));
            let followed = player.config().with_live_values("what follows the rig", values)?;
            player.reconfigure(followed, &changes);
        }
        player.set_unknown(Unknown::of(&conditioner, now));
        let inputs = RunInputs {
            live: player.config().live(),
            inputs: conditioner.targets(now),
            input_quality: conditioner.quality(now) as u8,
            refinement: player.wanted_refinement(),
            ..player.inputs()
        };
        // The step always differs, so it is set aside. Only changes are applied, as in the node, because each is a
        // message in the recording.
        let same = applied.is_some_and(|applied| {
            RunInputs {
                step: applied.step,
                ..inputs
            } == applied
        });
        if !same || !changes.is_empty() {
            player.apply(&inputs, &changes, applied.is_none())?;
            applied = Some(inputs);
        }
        // The last period may be short, so that the run ends at the step that `duration` gives.
        for _ in 0..per_period.min(steps - player.step()) {
            player.advance_or_fail()?;
        }
        progress.at(player.time_of(player.step()));
    }
    if refused > 0 {
        tell!("refused in total: {}", counted(refused, "sample"));
    }
    Ok((player, progress))
}
