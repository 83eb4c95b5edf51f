//! Many runs on threads.

use pyo3::prelude::*;

use super::errors;
use super::recorder::Recorder;
use super::twin::{Changes, Twin, plan};
use crate::rollout::{Member, rollout as run};

/// Runs the twins side by side without Python's lock. `progress` is called with the number of runs that ended, some times
/// per second. Returns per run None or the exception of its failed step.
#[pyfunction]
#[pyo3(signature = (twins, steps, changes, recorders, threads, progress=None))]
pub(super) fn rollout(
    py: Python<'_>,
    mut twins: Vec<PyRefMut<'_, Twin>>,
    steps: Vec<u64>,
    changes: Vec<Changes>,
    mut recorders: Vec<PyRefMut<'_, Recorder>>,
    threads: usize,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Vec<Option<Py<PyAny>>>> {
    let count = twins.len();
    // The lists come from Python, whose caller may have built them apart from each other.
    if steps.len() != count || changes.len() != count || recorders.len() != count {
        return Err(pyo3::exceptions::PyValueError::new_err(
            "twins, steps, changes and recorders must be of the same length",
        ));
    }
    // All plans are checked before any run begins: an error in the last must not leave the others advanced.
    let mut plans = Vec::with_capacity(count);
    for ((twin, steps), changes) in twins.iter().zip(&steps).zip(&changes) {
        plans.push(plan(&twin.inner, *steps, changes).map_err(|error| errors::input(py, &error))?);
    }
    let mut members = Vec::with_capacity(count);
    for ((twin, plan), keeper) in twins.iter_mut().zip(plans).zip(&mut recorders) {
        // A recorder belongs to its member while it runs; a second use of it in the same call fails here.
        let recorder = keeper.take()?;
        recorder
            .check_size(twin.inner.sizes(), plan.steps)
            .map_err(|error| errors::recorder(py, &error))?;
        members.push(Member {
            twin: twin.inner.as_mut(),
            plan,
            recorder,
        });
    }
    let progress = progress.map(Bound::unbind);
    // Without the lock of the interpreter the runs are parallel, and other Python threads continue.
    let (outcomes, interrupted) = py.detach(|| {
        let mut interrupted = None;
        let outcomes = run(members, threads, |ended| {
            // The lock is taken for the progress only, which is also where Ctrl-C is noticed.
            let heard = Python::attach(|py| {
                py.check_signals()?;
                progress
                    .as_ref()
                    .map_or(Ok(()), |progress| progress.call1(py, (ended,)).map(drop))
            });
            match heard {
                // `false` ends all runs; the first error is the one that Python gets.
                Ok(()) => interrupted.is_none(),
                Err(error) => {
                    interrupted.get_or_insert(error);
                    false
                }
            }
        });
        (outcomes, interrupted)
    });
    if let Some(error) = interrupted {
        return Err(error);
    }
    let mut failures = Vec::with_capacity(count);
    // Recorders return to Python also when their run failed: what was recorded until then is of use.
    for (outcome, keeper) in outcomes.into_iter().zip(&mut recorders) {
        keeper.put(outcome.recorder);
        let failure = outcome
            .failure
            .map(|failure| errors::step(py, &failure).into_value(py).into_any());
        failures.push(failure);
    }
    Ok(failures)
}
