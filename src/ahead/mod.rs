//! Looking ahead: what the tool would do under other speeds and weights, from forks of the present state.
//!
//! # Layout
//! - [`Goal`]: candidates, horizon, members; checked against the configuration before anything runs.
//! - [`Start`]: the state from which all members begin.
//! - [`SetPoint`]: what the driller has set, and how the rig wavers about it; members waver alike.
//! - `member`: one run of one candidate, judged by the alarms that the node itself uses.
//! - `measured`: the motion of a member without the gates of the alarms.
//! - `chance`: from counts to probabilities with their intervals, and when enough members have run.
//! - [`look_ahead`]: runs the members on some threads and gathers an [`Answer`].
//! - [`search`]: the smallest change of speed or weight that ends the alarms that stand.
//! - [`forecast`]: the next minute at the present speed and weight, second by second. [`Held`] compares it with what came.
//!
//! # Choices
//! - **Same bytes.** A member is determined by start, candidate, seed and its number. Results count in the order of these
//!   numbers, and a candidate ends at the first number at which its test is decided, so that threads and their timing
//!   change nothing.
//! - **Unknown is not safe.** A member whose step fails counts as failed; it is in no probability, and the answer says how
//!   many failed and why.
//! - **The way is part of the chance.** Members part by lateral velocities of [`DISTURBANCE`] before the way to the candidate,
//!   since the way may decide whether a motion ends. Only a long way is run once for all.

mod advice;
mod chance;
mod engine;
mod forecast;
mod goal;
mod held;
mod measured;
mod member;
mod set_point;
mod trace;

pub use advice::{SearchProgress, Searched, search};
pub use chance::{Band, Chance};
pub use engine::{
    AlarmChance, Answer, CandidateAnswer, NoTool, Progress, Start, StartError, keep_priority, look_ahead,
};
pub use forecast::{Bands, Calibration, Compared, Forecast, HORIZON, forecast, widened};
pub use goal::{Candidate, Ends, Goal, GoalError, MOST_CANDIDATES, MOST_HORIZON, MOST_MEMBERS};
pub use held::Held;
pub use member::{DISTURBANCE, Figure};
pub use set_point::SetPoint;
pub use trace::{SIGNALS, Second, Signal, Trace};
