//! The last stages of a run: a node runs, then ends.

use std::future::Future;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use tokio::sync::{Notify, oneshot};
use tokio::task::JoinSet;

use super::clocks::steady;
use super::duration::{DurationWatch, Ended};
use super::simulator::Simulator;
use super::what_if::WhatIf;
use super::{NodeError, RunSummary};
use crate::bag::RecordingThread;
use flexdrill_core::twin::BuildError;
use flexdrill_messages::TwinStatus;
use flexdrill_realtime::link::Gauges;
use flexdrill_ros2::dds::port::{Monitor, Port};
use flexdrill_ros2::logging;
use flexdrill_ros2::parameters::Parameters;

/// Longest wait for the solver to end: a step that is split to its limit takes this long on a slow machine.
const SOLVER_END: Duration = Duration::from_secs(5);
/// Longest wait for a look-ahead to end: one that is building the tool takes this long on a slow machine.
const LOOK_AHEAD_END: Duration = Duration::from_secs(5);
/// Longest wait for the answers to requests that came before the end.
const LAST_ANSWERS: Duration = Duration::from_secs(2);
/// How often model time is compared with the duration of the run.
const DURATION_INTERVAL: Duration = Duration::from_millis(20);

/// The result of the build, as the solver's thread reports it.
pub(super) type Built = oneshot::Receiver<Result<(), BuildError>>;

pub(super) struct RunningNode {
    pub(super) port: Port,
    pub(super) tasks: JoinSet<()>,
    pub(super) parameters: Arc<Parameters>,
    pub(super) gauges: Arc<Gauges>,
    pub(super) publisher_thread: JoinHandle<(Option<RecordingThread>, TwinStatus)>,
    pub(super) solver_thread: JoinHandle<()>,
    pub(super) what_if: Arc<WhatIf>,
    pub(super) simulator: Arc<Simulator>,
    pub(super) look_ahead_thread: JoinHandle<()>,
    /// None once it was received.
    pub(super) built: Option<Built>,
    /// Makes the publisher write what is queued, and end.
    pub(super) finish: Arc<AtomicBool>,
    pub(super) shut_down: Arc<Notify>,
    pub(super) time_step: f64,
    pub(super) duration: Option<f64>,
}

impl RunningNode {
    /// Waits until `shutdown` is ready, a service shuts the node down, or the duration has passed.
    ///
    /// # Errors
    /// When the model cannot be built.
    pub(super) async fn wait(&mut self, shutdown: impl Future<Output = ()>) -> Result<(), NodeError> {
        let shut_down = Arc::clone(&self.shut_down);
        let end = async {
            tokio::select! {
                () = shutdown => {}
                () = shut_down.notified() => {}
            }
        };
        tokio::pin!(end);
        if let Some(built) = self.built.take() {
            tokio::select! {
                () = &mut end => return Ok(()),
                result = built => match result {
                    Ok(result) => result?,
                    Err(_) => return Err(NodeError::Stopped("the solver's thread ended badly".into())),
                },
            }
        }
        tokio::select! {
            () = end => {}
            () = self.duration_passed() => {}
        }
        Ok(())
    }

    /// Waits until the duration has passed; for ever where the run has none.
    async fn duration_passed(&self) {
        let Some(duration) = self.duration else {
            return std::future::pending().await;
        };
        let mut watch = DurationWatch::new(duration, steady());
        let ended = loop {
            let model_time = self.gauges.step.load(Ordering::Relaxed) as f64 * self.time_step;
            if let Some(ended) = watch.update(model_time, steady()) {
                break ended;
            }
            tokio::time::sleep(DURATION_INTERVAL).await;
        };
        match ended {
            Ended::ModelTime => tracing::info!("the configured duration of {duration} s has passed"),
            Ended::StandsStill => tracing::warn!(
                "model time has stood still for the configured duration of {duration} s; check whether /clock is published, \
                 the node is paused, or a step has failed"
            ),
        }
    }

    /// Ends the node: first the solver, so that all of its steps are published, then the tasks, then the publisher, which
    /// writes what is queued, then DDS, after the last status has gone out, and the recording.
    ///
    /// # Errors
    /// When a thread ended badly or the recording could not be finished.
    pub(super) async fn end(mut self) -> Result<RunSummary, NodeError> {
        self.what_if.end();
        // Clients that wait for steps have their answers before the solver ends.
        self.simulator.end();
        if !joined(self.look_ahead_thread, LOOK_AHEAD_END).await {
            tracing::warn!(
                "the look-ahead did not end within {} s; the node ends without it",
                LOOK_AHEAD_END.as_secs()
            );
        }
        last_answers(&self.port.monitor()).await;
        self.gauges.stop.store(true, Ordering::Relaxed);
        if !joined(self.solver_thread, SOLVER_END).await {
            tracing::warn!(
                "the solver did not end its step within {} s; the node ends without it",
                SOLVER_END.as_secs()
            );
        }
        self.tasks.shutdown().await;
        self.finish.store(true, Ordering::Release);
        let publisher_thread = self.publisher_thread;
        let (recording, status) = tokio::task::spawn_blocking(move || publisher_thread.join())
            .await
            .ok()
            .and_then(Result::ok)
            .ok_or_else(|| NodeError::Stopped("the publisher's thread ended badly".into()))?;
        drop(self.parameters);
        logging::disconnect();
        let port = self.port;
        blocking(move || drop(port)).await?;
        let recording = match recording {
            Some(recording) => Some(blocking(move || recording.finish()).await??),
            None => None,
        };
        Ok(RunSummary { status, recording })
    }
}

/// Runs `work`, which waits for a thread or a disk, off the tasks' threads.
async fn blocking<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Result<T, NodeError> {
    tokio::task::spawn_blocking(work)
        .await
        .map_err(|error| NodeError::Stopped(error.to_string()))
}

/// Waits until all requests have their answers, [`LAST_ANSWERS`] at most.
async fn last_answers(dds: &Monitor) {
    let deadline = tokio::time::Instant::now() + LAST_ANSWERS;
    while dds.open_requests() > 0 && tokio::time::Instant::now() < deadline {
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
}

/// Joins a thread, waiting `longest` at most. Returns whether the thread ended.
async fn joined(thread: JoinHandle<()>, longest: Duration) -> bool {
    let deadline = tokio::time::Instant::now() + longest;
    while !thread.is_finished() {
        if tokio::time::Instant::now() >= deadline {
            return false;
        }
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    thread.join().is_ok()
}
