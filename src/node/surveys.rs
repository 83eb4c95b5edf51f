//! Surveys over a restart of the node: the file that an earlier run has left, and the writer for this one.

use std::path::Path;

use super::inputs::RigInputs;
use crate::rig_inputs::{KeptSurveys, Restored};
use crate::state_file::{self, Kept, StateError, StateWriter, Words};
use flexdrill_text::{counted, date_time};

/// A table of the surveys, under a head that says which hole they are of.
impl Kept for KeptSurveys {
    const WORDS: Words = Words {
        state: "the surveys' state",
        of_node: "the surveys",
        without: "the run begins without surveys: send them again",
        lost: "surveys",
    };

    fn encode(&self) -> std::io::Result<Vec<u8>> {
        Self::encode(self)
    }

    fn decode(bytes: &[u8]) -> Result<Self, String> {
        Self::decode(bytes)
    }
}

/// Writes the surveys for the next run.
pub type SurveyFile = StateWriter<KeptSurveys>;

/// Gives the inputs the surveys that an earlier run has left in a file, and returns the writer for this run; none where another
/// node uses the file. A problem of the file is logged, and the run begins without them.
pub fn open(path: &Path, inputs: &RigInputs) -> Option<SurveyFile> {
    let logged = |error: StateError| tracing::warn!("{error}");
    let writer = match SurveyFile::start(path.to_owned()) {
        Err(error @ StateError::Owned { .. }) => {
            logged(error);
            return None;
        }
        writer => writer.map_err(logged).ok(),
    };
    match state_file::read::<KeptSurveys>(path) {
        Ok(Some(kept)) if !kept.is_empty() => take(path, &kept, inputs),
        Ok(_) => {}
        Err(error) => logged(error),
    }
    writer
}

/// Takes surveys and says so, because they act on the forecast without having come in this run.
fn take(path: &Path, kept: &KeptSurveys, inputs: &RigInputs) {
    let file = path.display();
    let surveys = counted(kept.len() as u64, "survey");
    let Some(restored) = inputs.restore_surveys(kept) else {
        tracing::warn!(
            "{file}: {surveys} of another hole are left out, and the next survey replaces them; give the well a name (run.well) for \
             surveys that last from one configuration of it to the next"
        );
        return;
    };
    let Restored {
        known,
        waiting,
        left_out,
    } = restored;
    let newest = kept.newest().map_or_else(String::new, date_time);
    tracing::info!(
        "{file}: {surveys} of an earlier run, the newest of {newest}: {known} correct the hole ahead, {waiting} lie below the bit and \
         wait, {left_out} lie outside the hole; if the hole is another one, end the node and remove the file"
    );
}
