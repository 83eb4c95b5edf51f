//! Recovers a bag: copies everything that can be read into a new bag with index and metadata.

use std::path::Path;

use crate::{BagError, Cut, Gap, Gaps, PartFault, Recorder, Recording, Topic, open};

/// Result of a recovery.
#[derive(Debug)]
pub struct Recovered {
    /// The new bag.
    pub recording: Recording,
    /// Topics, in the order of [`Recording::per_topic`].
    pub topics: Vec<Topic>,
    /// Files that are missing, unreadable, or not listed.
    pub faults: Vec<PartFault>,
    /// Truncated files.
    pub cuts: Vec<Cut>,
    /// Damaged parts, which are not in the new bag.
    pub damaged: Vec<BagError>,
    /// Topics of which the original recording had lost messages.
    pub gaps: Vec<Gap>,
}

/// Copies everything that can be read of the bag `input` to a new one at `output`.
///
/// # Errors
/// When `input` is not a bag, or `output` cannot be written.
pub fn recover(input: &Path, output: &Path) -> Result<Recovered, BagError> {
    recover_with(input, output, |_, _| {})
}

/// Like [`recover`]; `progress` receives the number of messages copied and, if known, of all messages.
///
/// # Errors
/// As [`recover`].
pub fn recover_with(
    input: &Path,
    output: &Path,
    mut progress: impl FnMut(u64, Option<u64>),
) -> Result<Recovered, BagError> {
    let mut bag = open(input)?;
    // The new bag announces its topics at its beginning.
    bag.describe();
    let topics: Vec<Topic> = bag.topics().iter().map(|topic| Topic::clone(topic)).collect();
    let faults = bag.faults().to_vec();
    let cuts = bag.cuts().cloned().collect();
    let total = bag.message_count();
    let mut recorder = Recorder::create(output, &topics)?;
    let mut damaged = Vec::new();
    let mut gaps = Gaps::default();
    for message in bag {
        match message {
            // The first pass over the file did not find this message's channel.
            Ok(message) if message.topic_index >= topics.len() => damaged.push(BagError::NoSuchIndex {
                path: input.to_owned(),
                index: message.topic_index,
                count: topics.len(),
            }),
            Ok(message) => {
                gaps.observe(&message);
                recorder.record_as(
                    message.topic_index,
                    message.sequence,
                    message.log_time,
                    message.publish_time,
                    &message.data,
                )?;
                progress(recorder.messages(), total);
            }
            Err(error) => damaged.push(error),
        }
    }
    Ok(Recovered {
        recording: recorder.finish()?,
        topics,
        faults,
        cuts,
        damaged,
        gaps: gaps.found(),
    })
}
