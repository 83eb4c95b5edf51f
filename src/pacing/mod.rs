//! Pacing by absolute deadlines. What to do is decided by pure functions of the time handed in ([`Pacer`],
//! [`RealTimeFactor`]); only [`clock`] looks at a clock. Nothing allocates after construction.
//!
//! ```no_run
//! use flexdrill::pacing::{Pacer, clock};
//! let mut pacer = Pacer::new(clock::now(), 0.0005, 20);
//! loop {
//!     clock::sleep_until(pacer.deadline());
//!     // advance the model by one step
//!     let paced = pacer.step_done(clock::now());
//!     if paced.skipped > 0 {
//!         // tell it: the model stands still for so many periods
//!     }
//! }
//! ```

pub mod clock;
mod pacer;
mod real_time_factor;

pub use pacer::{Paced, Pacer, whole_periods};
pub use real_time_factor::RealTimeFactor;
