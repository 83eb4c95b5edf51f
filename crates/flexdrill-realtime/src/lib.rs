//! Pacing by absolute deadlines. The decisions are pure functions of the time that the caller passes ([`Pacer`],
//! [`RealTimeFactor`]); only [`monotonic`], of the crate `flexdrill-clock`, and
//! [`clock`] read a clock. Nothing allocates after construction.
//!
//! ```no_run
//! use flexdrill_realtime::{Pacer, monotonic};
//! let mut pacer = Pacer::new(monotonic::now(), 0.0005, 20);
//! loop {
//!     monotonic::sleep_until(pacer.deadline());
//!     // advance the model by one step
//!     let paced = pacer.step_done(monotonic::now());
//!     if paced.skipped > 0 {
//!         // report the number of periods for which the model stands still
//!     }
//! }
//! ```

pub mod clock;
pub mod link;
mod pace_watch;
mod pacer;
pub mod priority;
mod real_time_factor;
mod real_time_loop;
mod step_pace;

/// Length of a period of the solver (s): the delay of an input at most, live and in replays of foreign inputs.
pub const INPUT_PERIOD: f64 = 5e-3;

pub use flexdrill_clock::monotonic;
pub use pace_watch::{FAR_BEHIND, KEEPS_UP, Pace, PaceReading, PaceWatch};
pub use pacer::{Paced, Pacer, whole_periods};
pub use real_time_factor::RealTimeFactor;
pub use real_time_loop::RealTimeLoop;
pub use step_pace::StepPace;
