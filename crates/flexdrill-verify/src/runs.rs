//! What the cases ran: configuration, inputs and steps of each run, so that others can repeat it.

use std::cell::RefCell;

use super::{Row, VerifyError};
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::SimulationSettings;

/// One run of a case. Its inputs are constant.
#[derive(Debug, Clone)]
pub struct CaseRun {
    /// The configuration.
    pub config: Config,
    /// Its settings, where the case changes those of the configuration too.
    pub settings: SimulationSettings,
    /// The inputs.
    pub inputs: Inputs,
    /// Steps taken.
    pub steps: u64,
}

thread_local! {
    // The cases are functions without arguments, which the tests, the command and the manual call: the list is on only
    // while `with_runs` calls one.
    static RUNS: RefCell<Option<Vec<CaseRun>>> = const { RefCell::new(None) };
}

/// Runs a case, and lists its runs in the order in which they ended. Runs without a step are left out.
///
/// # Errors
/// Those of the case.
pub fn with_runs(case: fn() -> Result<Vec<Row>, VerifyError>) -> Result<(Vec<Row>, Vec<CaseRun>), VerifyError> {
    RUNS.replace(Some(Vec::new()));
    let rows = case();
    let runs = RUNS.take().unwrap_or_default();
    Ok((rows?, runs))
}

/// Whether runs are listed at present.
pub(super) fn wanted() -> bool {
    RUNS.with_borrow(Option::is_some)
}

/// Lists a run that has ended.
pub(super) fn ended(run: CaseRun) {
    if run.steps > 0 {
        RUNS.with_borrow_mut(|runs| {
            if let Some(runs) = runs {
                runs.push(run);
            }
        });
    }
}
