//! `flexdrill rig`: sends a log's inputs and measured values in real time, as a rig does.

#[cfg(feature = "bridge")]
mod line;
#[cfg(not(feature = "bridge"))]
#[path = "no_line.rs"]
mod line;

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use clap::Args;

use self::line::WitsLine;
use super::source::{self, MeasuredSample, Sample, Samples};
use super::{WrongUse, numbers, signals};
use crate::cli::output::say;
use crate::dds::network::Network;
use crate::messages::builtin_interfaces::Time;
use crate::messages::{RigMeasured, RigSurvey};
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

/// Send the inputs and measured values of a log in real time.
///
/// They are published on the rig's topics, or written as WITS level 0 to whoever connects (--wits).
#[derive(Debug, Args)]
pub(super) struct RigArgs {
    /// Field log (CSV), bag (MCAP, SQLite or their folder) or capture of a WITS line.
    log: PathBuf,
    /// Speed relative to real time; 2 plays twice as fast.
    #[arg(long, default_value_t = 1.0, value_parser = numbers::rate)]
    rate: f64,
    /// Restart at the end of the log.
    #[arg(long = "loop")]
    again: bool,
    /// Write WITS level 0 to whoever connects to this address, instead of publishing. Whoever reaches it can read along.
    #[arg(long, value_name = "ADDRESS:PORT", conflicts_with_all = ["domain", "namespace"])]
    wits: Option<SocketAddr>,
    /// Mapping of items to quantities and units (YAML) for --wits. Default: the usual items in metric units.
    #[arg(long, value_name = "FILE", requires = "wits")]
    wits_map: Option<PathBuf>,
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
    if args.source.ends_with_guess(&args.log)? {
        return Ok(());
    }
    let samples = args.source.read(&args.log)?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let (mut to, place) = match args.wits {
            Some(address) => wits(args, address).await?,
            None => topics(args, &ros_args, &samples)?,
        };
        say!(
            "playing {} ({} samples of inputs, {} of measured values) at {} x real time",
            args.log.display(),
            samples.inputs.len(),
            samples.measured.len(),
            args.rate
        );
        say!("to {place}; Ctrl-C ends it");
        let shutdown = signals::shutdown(false)?;
        tokio::select! {
            () = shutdown => {}
            () = play(&mut to, &samples, args.rate, args.again) => {}
        }
        anyhow::Ok(())
    })?;
    say!("stopped");
    Ok(())
}

/// The present instant (ns since 1970).
fn now() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0, |since| i64::try_from(since.as_nanos()).unwrap_or(i64::MAX))
}

/// Where the samples are sent.
enum Destination {
    /// The rig's topics.
    Topics(RigNode),
    /// A line of WITS.
    Line(WitsLine),
}

/// The node, and the topics that the samples have.
fn topics(args: &RigArgs, ros_args: &RosArgs, samples: &Samples) -> anyhow::Result<(Destination, String)> {
    let (network, notes) = Network::read(args.domain, |name| std::env::var(name).ok()).map_err(WrongUse::new)?;
    let identity = ros_args
        .remapping
        .identity(&args.namespace, RIG_NODE_NAME)
        .map_err(WrongUse::new)?;
    for note in notes {
        tracing::warn!("{note}");
    }
    let node = RigNode::new(&network, &identity, &ros_args.remapping)?;
    let sent = |kind: &InputKind| samples.inputs.iter().any(|sample| sample.kind == *kind);
    let kinds = InputKind::ALL.into_iter().filter(sent).map(InputKind::index);
    let measured = (!samples.measured.is_empty()).then_some(InputKind::COUNT);
    let surveys = (!samples.surveys.is_empty()).then_some(InputKind::COUNT + 1);
    let names: Vec<&str> = kinds
        .chain(measured)
        .chain(surveys)
        .map(|index| node.topics()[index].as_str())
        .collect();
    let place = format!("{}, domain {}", names.join(", "), network.domain_id);
    Ok((Destination::Topics(node), place))
}

/// The line, and where it is.
async fn wits(args: &RigArgs, address: SocketAddr) -> anyhow::Result<(Destination, String)> {
    let line = WitsLine::open(address, args.wits_map.as_deref(), "demonstration").await?;
    let place = format!("whoever connects to {} for WITS level 0", line.address());
    Ok((Destination::Line(line), place))
}

/// Values that are due at one time.
#[derive(Default)]
struct Batch<'a> {
    /// In the unit of the input's topic, by [`InputKind::ALL`].
    inputs: [Option<f64>; InputKind::COUNT],
    /// The newest of each source.
    measured: BTreeMap<&'a str, &'a RigMeasured>,
    /// None may be left out: a survey does not come again.
    surveys: Vec<&'a RigSurvey>,
    /// Values for which a newer one was due at the same time.
    left_out: u64,
}

impl<'a> Batch<'a> {
    fn input(&mut self, sample: &Sample) {
        // The topic carries a bare number, which cannot be marked as bad, so a bad sample is not sent.
        if sample.stamp.is_none_or(|stamp| !stamp.bad) {
            self.left_out += u64::from(self.inputs[sample.kind.index()].replace(sample.value).is_some());
        }
    }

    fn measured(&mut self, sample: &'a MeasuredSample) {
        let newest = self.measured.insert(&sample.message.source, &sample.message);
        self.left_out += u64::from(newest.is_some());
    }
}

impl Destination {
    /// Sends a batch; how many samples went out.
    fn send(&mut self, batch: &Batch<'_>) -> u64 {
        let now = now();
        match self {
            Self::Topics(node) => {
                let inputs = InputKind::ALL.into_iter().zip(batch.inputs);
                let given = inputs.filter_map(|(kind, value)| Some((kind, value?)));
                let mut sent: u64 = given.map(|(kind, value)| u64::from(node.publish(kind, value))).sum();
                for message in batch.measured.values() {
                    // A rig measures now.
                    let mut message = (*message).clone();
                    message.header.stamp = Time::from_nanoseconds(now);
                    sent += u64::from(node.publish_measured(&message));
                }
                for message in &batch.surveys {
                    let mut message = (*message).clone();
                    message.header.stamp = Time::from_nanoseconds(now);
                    sent += u64::from(node.publish_survey(&message));
                }
                sent
            }
            Self::Line(line) => line.send(batch, now),
        }
    }

    /// Who listens, for the line of progress.
    fn listeners(&self) -> String {
        match self {
            Self::Topics(node) => format!("subscribers: {}", node.subscribers()),
            Self::Line(line) => format!("connections: {}", line.connections()),
        }
    }
}

async fn play(to: &mut Destination, samples: &Samples, rate: f64, again: bool) {
    tokio::time::sleep(DISCOVERY).await;
    loop {
        play_once(to, samples, rate).await;
        if !again {
            return;
        }
        say!("restarted from the beginning");
    }
}

async fn play_once(to: &mut Destination, samples: &Samples, rate: f64) {
    let (Some(first), Some(last)) = (samples.inputs.first(), samples.inputs.last()) else {
        return;
    };
    // Times count from the first input, so that a log of last year begins now.
    let after = |time: i64| time.saturating_sub(first.time) as f64 * 1e-9;
    let began = Instant::now();
    let mut reported = began;
    let mut newest: [Option<f64>; InputKind::COUNT] = [None; InputKind::COUNT];
    let (mut inputs, mut measured) = (samples.inputs.iter().peekable(), samples.measured.iter().peekable());
    let mut surveys = samples.surveys.iter().peekable();
    let (mut sent, mut left_out) = (0_u64, 0_u64);
    // Deadlines are absolute from `began`: a late send does not shift all later ones.
    loop {
        let next = [
            inputs.peek().map(|sample| sample.time),
            measured.peek().map(|sample| sample.time),
            surveys.peek().map(|sample| sample.time),
        ];
        let Some(next) = next.into_iter().flatten().min() else {
            break;
        };
        let due = Duration::from_secs_f64((after(next) / rate).max(0.0));
        tokio::time::sleep_until((began + due).into()).await;
        // Sending takes time too, so more samples may be due by now than the one that was waited for.
        let now = began.elapsed().as_secs_f64() * rate;
        // Of all samples due by now, only the newest are sent.
        let mut batch = Batch::default();
        while let Some(sample) = inputs.next_if(|sample| after(sample.time) <= now) {
            batch.input(sample);
        }
        while let Some(sample) = measured.next_if(|sample| after(sample.time) <= now) {
            batch.measured(sample);
        }
        while let Some(sample) = surveys.next_if(|sample| after(sample.time) <= now) {
            batch.surveys.push(&sample.message);
        }
        sent += to.send(&batch);
        left_out += batch.left_out;
        // A batch has what changed; the line on the screen shows the newest of each input.
        for (newest, value) in newest.iter_mut().zip(batch.inputs) {
            *newest = value.or(*newest);
        }
        if reported.elapsed() >= REPORT_INTERVAL {
            reported = Instant::now();
            say!(
                "{now:.0} of {:.0} s: {}, {sent} samples sent{}, {}",
                after(last.time),
                shown(&newest),
                late(left_out),
                to.listeners()
            );
        }
        // After a pause of the machine the gap makes one batch of the overdue samples, not a burst.
        tokio::time::sleep(LEAST_GAP).await;
    }
    // The last samples need time to arrive before the node leaves the network.
    tokio::time::sleep(DISCOVERY).await;
    say!("end of the log after {:.1} s: {sent} samples sent", after(last.time));
}

/// The newest inputs; the optional ones where they are.
fn shown(newest: &[Option<f64>; InputKind::COUNT]) -> String {
    let shown = InputKind::ALL
        .into_iter()
        .zip(newest)
        .filter_map(|(kind, value)| match value {
            Some(value) => Some(format!("{value:.1} {}", kind.unit())),
            None if kind.is_optional() => None,
            None => Some(format!("- {}", kind.unit())),
        });
    shown.collect::<Vec<_>>().join(", ")
}

fn late(left_out: u64) -> String {
    if left_out > 0 {
        format!(", {left_out} left out because a newer one was due at the same time")
    } else {
        String::new()
    }
}
