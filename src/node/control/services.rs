//! The services `~/reset`, `~/pause` and `~/save_checkpoint`.

use std::path::PathBuf;
use std::sync::{Arc, PoisonError};
use std::time::Instant;

use super::{CHECKPOINT_INTERVAL, Control, ControlError};
use crate::drilling::live::with_points;
use crate::node::NodeError;
use crate::node::states::SavedRun;
use crate::state_file::replace;
use flexdrill_messages::std_srvs::{SetBoolRequest, SetBoolResponse, TriggerRequest, TriggerResponse};
use flexdrill_realtime::link::RunState;
use flexdrill_ros2::args::ArgsError;
use flexdrill_ros2::dds::port::PortBuilder;
use flexdrill_ros2::service::{ServiceMapping, ServiceServer, Task, at_once, shared};
use flexdrill_text::log_ending;

impl Control {
    pub(super) fn answer_reset(&self) -> TriggerResponse {
        let done = self.reset();
        answer(done.map(|_| "the model returns to its state after the start".to_owned()))
    }

    pub(super) fn answer_pause(&self, pause: bool) -> SetBoolResponse {
        let state = if pause { "paused" } else { "running" };
        let TriggerResponse { success, message } = answer(self.pause(pause).map(|_| state.to_owned()));
        SetBoolResponse { success, message }
    }

    async fn save_checkpoint(self: Arc<Self>) -> TriggerResponse {
        // Before the first step there is no state to save.
        if self.gauges.run_state() == RunState::Starting {
            return answer(Err(ControlError::Starting));
        }
        // The lock ends before the file is written, or requests in the
        // meantime would wait for the disk instead of being refused.
        {
            let mut last = self.checkpoint.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(passed) = last
                .map(|at: Instant| at.elapsed())
                .filter(|passed| *passed < CHECKPOINT_INTERVAL)
            {
                return answer(Err(ControlError::TooOften(passed.as_secs_f64())));
            }
            // The interval counts from the attempt. A disk that fails must not be written to without pause.
            *last = Some(Instant::now());
        }
        // The state comes from the solver, and the disk may be slow: both would block a worker of the runtime.
        let saved = tokio::task::spawn_blocking(move || {
            let SavedRun {
                checkpoint, applied, ..
            } = self.state()?;
            let step = applied.step;
            // Hash and step name the file, so that a checkpoint fits its configuration and none overwrites another.
            let path = PathBuf::from(format!(
                "flexdrill_{}_step{step}.checkpoint",
                &self.config().hash()[..12]
            ));
            let file = with_points(checkpoint, &self.drilled.get());
            if let Err(source) = replace(&path, &file) {
                return Err(ControlError::Write { path, source });
            }
            // The client may run on another machine, where a relative path means nothing.
            let absolute = std::path::absolute(&path).unwrap_or(path);
            Ok(format!("{} ({} bytes)", absolute.display(), file.len()))
        });
        let result = saved.await.unwrap_or_else(|error| Err(error.into()));
        let kind = if result.is_ok() {
            "checkpoint saved"
        } else {
            "no checkpoint"
        };
        if let Some(more) = log_ending(kind) {
            match &result {
                Ok(message) => tracing::info!("checkpoint saved: {message}{more}"),
                Err(why) => tracing::warn!("no checkpoint: {why}{more}"),
            }
        }
        answer(result)
    }
}

fn answer(result: Result<String, ControlError>) -> TriggerResponse {
    match result {
        Ok(message) => TriggerResponse { success: true, message },
        Err(error) => TriggerResponse {
            success: false,
            message: error.to_string(),
        },
    }
}

/// Creates `~/reset`, `~/pause` and `~/save_checkpoint`; `name` makes a private name absolute.
///
/// # Errors
/// When a remapped name is not allowed.
pub fn serve(
    port: &mut PortBuilder,
    mapping: ServiceMapping,
    control: &Arc<Control>,
    name: impl Fn(&str) -> Result<String, ArgsError>,
) -> Result<Vec<Task>, NodeError> {
    let mut server = |private: &str, kind: &str| -> Result<ServiceServer, NodeError> {
        let kind = format!("std_srvs/srv/{kind}");
        Ok(ServiceServer::new(port, &name(private)?, &kind, mapping))
    };
    let (reset, pause) = (Arc::clone(control), Arc::clone(control));
    Ok(vec![
        Box::pin(server("~/reset", "Trigger")?.serve(at_once(move |_: TriggerRequest| reset.answer_reset()))),
        Box::pin(
            server("~/pause", "SetBool")?
                .serve(at_once(move |request: SetBoolRequest| pause.answer_pause(request.data))),
        ),
        Box::pin(
            server("~/save_checkpoint", "Trigger")?.serve(shared(Arc::clone(control), |control, _: TriggerRequest| {
                control.save_checkpoint()
            })),
        ),
    ])
}
