//! `flexdrill rig`: publishes a log's inputs in real time, as a rig does.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;

use super::source::{self, Sample};
use super::{WrongUse, numbers, signals};
use crate::cli::output::say;
use crate::dds::network::Network;
use crate::node::demonstration_rig::{RIG_NODE_NAME, RigNode};
use crate::ros::args::RosArgs;
use crate::ros::logging;
use flexdrill_core::inputs::InputKind;

/// Time between two lines of progress.
const REPORT_INTERVAL: Duration = Duration::from_secs(5);
/// Shortest time between two samples: overdue samples are left out instead of sent in a burst.
const LEAST_GAP: Duration = Duration::from_millis(2);
/// Time for discovery before the first sample, and for delivery after the last.
const DISCOVERY: Duration = Duration::from_millis(300);

/// Publish a field log's or a bag's inputs in real time.
#[derive(Debug, Args)]
pub(super) struct RigArgs {
    /// Field log (CSV) or bag (MCAP, SQLite or their folder).
    log: PathBuf,
    /// Speed relative to real time; 2 plays twice as fast.
    #[arg(long, default_value_t = 1.0, value_parser = numbers::rate)]
    rate: f64,
    /// Restart at the end of the log.
    #[arg(long = "loop")]
    again: bool,
    /// DDS domain, 0 to 232; overrides ROS_DOMAIN_ID.
    #[arg(long, value_name = "ID")]
    domain: Option<u16>,
    /// Namespace of the node and its topics.
    #[arg(long, value_name = "NS", default_value = "/")]
    namespace: String,
    #[command(flatten)]
    source: source::SourceArgs,
}

/// # Errors
/// When the log or the network cannot be used.
pub(super) fn run(args: &RigArgs, ros_args: &[String]) -> anyhow::Result<()> {
    let ros_args = RosArgs::parse(ros_args).map_err(WrongUse::new)?;
    logging::start(&ros_args);
    let samples = args.source.read(&args.log)?;
    let (network, notes) = Network::read(args.domain, |name| std::env::var(name).ok()).map_err(WrongUse::new)?;
    let identity = ros_args
        .remapping
        .identity(&args.namespace, RIG_NODE_NAME)
        .map_err(WrongUse::new)?;
    for note in notes {
        tracing::warn!("{note}");
    }
    let node = RigNode::new(&network, &identity, &ros_args.remapping)?;
    say!(
        "playing {} ({} samples) at {} x real time",
        args.log.display(),
        samples.len(),
        args.rate
    );
    say!(
        "to {}, domain {}; Ctrl-C ends it",
        sent_topics(&node, &samples).join(", "),
        network.domain_id
    );
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let shutdown = signals::shutdown(false)?;
        tokio::select! {
            () = shutdown => {}
            () = play(&node, &samples, args.rate, args.again) => {}
        }
        anyhow::Ok(())
    })?;
    say!("stopped");
    Ok(())
}

/// The topics of the inputs that the samples have.
fn sent_topics<'a>(node: &'a RigNode, samples: &[Sample]) -> Vec<&'a str> {
    let sent = |kind: &InputKind| samples.iter().any(|sample| sample.kind == *kind);
    let kinds = InputKind::ALL.into_iter().filter(sent);
    kinds.map(|kind| node.topics()[kind.index()].as_str()).collect()
}

async fn play(node: &RigNode, samples: &[Sample], rate: f64, again: bool) {
    tokio::time::sleep(DISCOVERY).await;
    loop {
        play_once(node, samples, rate).await;
        if !again {
            return;
        }
        say!("restarted from the beginning");
    }
}

async fn play_once(node: &RigNode, samples: &[Sample], rate: f64) {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
        return;
    };
    let at = |sample: &Sample| sample.since(first);
    let began = Instant::now();
    let mut reported = began;
    let mut newest: [Option<f64>; InputKind::COUNT] = [None; InputKind::COUNT];
    let (mut next, mut sent, mut left_out) = (0, 0_u64, 0_u64);
    while let Some(sample) = samples.get(next) {
        let due = Duration::from_secs_f64(at(sample) / rate);
        tokio::time::sleep_until((began + due).into()).await;
        let now = began.elapsed().as_secs_f64() * rate;
        // Of all samples due by now, only the newest of each input is sent.
        let mut batch: [Option<f64>; InputKind::COUNT] = [None; InputKind::COUNT];
        while let Some(sample) = samples.get(next).filter(|sample| at(sample) <= now) {
            next += 1;
            // The topic carries a bare number, which cannot be marked as bad, so a bad sample is not sent.
            if sample.stamp.is_none_or(|stamp| !stamp.bad) {
                left_out += u64::from(batch[sample.kind.index()].replace(sample.value).is_some());
            }
        }
        for kind in InputKind::ALL {
            if let Some(value) = batch[kind.index()] {
                sent += u64::from(node.publish(kind, value));
                newest[kind.index()] = Some(value);
            }
        }
        if reported.elapsed() >= REPORT_INTERVAL {
            reported = Instant::now();
            let show = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}"));
            let late = if left_out > 0 {
                format!(", {left_out} left out because a newer one was due at the same time")
            } else {
                String::new()
            };
            let optional: String = InputKind::ALL
                .into_iter()
                .filter(|kind| kind.is_optional())
                .filter_map(|kind| newest[kind.index()].map(|value| format!(" {value:.1} {},", kind.unit())))
                .collect();
            say!(
                "{now:.0} of {:.0} s: {} r/min, {} kN,{optional} {sent} samples sent{late}, subscribers: {}",
                at(last),
                show(newest[0]),
                show(newest[1]),
                node.subscribers()
            );
        }
        tokio::time::sleep(LEAST_GAP).await;
    }
    // The last samples need time to arrive before the node leaves the network.
    tokio::time::sleep(DISCOVERY).await;
    say!("end of the log after {:.1} s: {sent} samples sent", at(last));
}
