//! The runs of a bag with the cycles that they counted.

use std::path::Path;

use anyhow::Context as _;
use flexdrill_bag::{BagError, BagMessage};
use flexdrill_config::Config;
use flexdrill_life::{Counted, RunLife};
use flexdrill_messages::{Ageing, Message as _, SessionInfo, topics};

/// A run of a bag.
#[derive(Debug, Default)]
pub(super) struct Recorded {
    session: Option<SessionInfo>,
    counted: Counted,
}

/// The runs of a bag, and what it lacks, each as a sentence.
#[derive(Debug, Default)]
pub(super) struct Runs {
    pub(super) runs: Vec<Recorded>,
    pub(super) missing: Vec<String>,
    /// Messages that cannot be read.
    unreadable: u64,
}

impl Recorded {
    fn start(&self) -> i64 {
        self.session
            .as_ref()
            .map_or(i64::MAX, |session| session.start.to_nanoseconds())
    }

    /// The damages of its joints.
    ///
    /// # Errors
    /// When the bag does not say which tool it was, the configuration cannot be read, or states no class or no serial
    /// numbers.
    pub(super) fn life(&self) -> anyhow::Result<RunLife> {
        let session = self
            .session
            .as_ref()
            .with_context(|| format!("no {}: it is not known whose counts these are", topics::SESSION.name))?;
        let config = Config::from_text("the recorded configuration", &session.configuration)?;
        Ok(RunLife::of(&config, &self.counted, self.start())?)
    }
}

impl Runs {
    fn session(&mut self, message: &BagMessage) -> Result<(), BagError> {
        let session: SessionInfo = message.decode()?;
        // A session may be in the bag several times; only another start or configuration is another run.
        let same = |known: &SessionInfo| known.start == session.start && known.config_hash == session.config_hash;
        match self.runs.last_mut() {
            Some(last) if last.session.as_ref().is_some_and(same) => {}
            // A recording may have begun with a count.
            Some(last) if last.session.is_none() => last.session = Some(session),
            _ => self.runs.push(Recorded {
                session: Some(session),
                counted: Counted::default(),
            }),
        }
        Ok(())
    }

    fn count(&mut self, message: &BagMessage) -> Result<(), BagError> {
        let ageing: Ageing = message.decode()?;
        if self.runs.is_empty() {
            self.runs.push(Recorded::default());
        }
        if let Some(run) = self.runs.last_mut() {
            // A count before its session is of a run whose beginning is not known: all of it belongs to the run.
            let start = if run.session.is_some() { run.start() } else { i64::MIN };
            if !run.counted.push(&ageing, start) {
                self.unreadable += 1;
            }
        }
        Ok(())
    }
}

/// Reads the runs of the twin in `namespace`, which may be none if the bag has one twin. `progress` receives the share of
/// the recorded time that has been read.
///
/// # Errors
/// When the bag cannot be read, or has no counts of one twin.
pub(super) fn runs(path: &Path, namespace: Option<&str>, mut progress: impl FnMut(f64)) -> anyhow::Result<Runs> {
    let mut bag = flexdrill_bag::open(path)?;
    let name = |relative: &str| match namespace.map(|namespace| namespace.trim_matches('/')) {
        None => relative.to_owned(),
        Some("") => format!("/{relative}"),
        Some(namespace) => format!("/{namespace}/{relative}"),
    };
    // Names with their types: another program may use a name for something else.
    let wanted = [
        bag.topic_of_type(&name(topics::SESSION.name), SessionInfo::ROS_TYPE)?
            .name
            .clone(),
        bag.topic_of_type(&name(topics::AGEING.name), Ageing::ROS_TYPE)?
            .name
            .clone(),
    ];
    bag.select(|topic| wanted.contains(&topic.name));
    let bounds = bag.bounds().filter(|(start, end)| end > start);
    let mut found = Runs::default();
    for message in bag.by_ref() {
        let message = match message {
            // A damaged part costs the counts in it; later counts have their sums again.
            Err(error @ BagError::Damaged { .. }) => {
                found.missing.push(error.to_string());
                continue;
            }
            message => message?,
        };
        if let Some((start, end)) = bounds {
            progress(message.log_time.saturating_sub(start) as f64 / end.saturating_sub(start) as f64);
        }
        let read = if message.topic.name == wanted[0] {
            found.session(&message)
        } else {
            found.count(&message)
        };
        found.unreadable += u64::from(read.is_err());
    }
    let faults = bag.faults().iter().map(ToString::to_string);
    let cuts = bag
        .cuts()
        .map(|cut| format!("cut short ({}): the lives have its counts up to there", cut.reason));
    found.missing.extend(faults.chain(cuts).collect::<Vec<_>>());
    if found.unreadable > 0 {
        let text = format!("{} of {} could not be read", found.unreadable, wanted.join(" and "));
        found.missing.push(text);
    }
    // A recording that was continued after a restart may have a session that counted nothing.
    if found.runs.len() > 1 {
        found.runs.retain(|run| run.counted.duration() > 0.0);
    }
    anyhow::ensure!(!found.runs.is_empty(), "{}: no run in it", path.display());
    Ok(found)
}
