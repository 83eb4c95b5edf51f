//! Looking ahead: what the tool would do under other speeds and weights, from forks of the present state.
//!
//! # Layout
//! - [`Goal`]: candidates, horizon, members; checked against the configuration before anything runs.
//! - [`Start`]: the states from which members begin: one for all, or a plausible tool for each (`draws`).
//! - [`SetPoint`]: what the driller has set, and how the rig wavers about it; members waver alike.
//! - `member`: one run of one candidate, judged by the alarms that the node itself uses; `early`, `calm`, `tally`: when
//!   it ends before its horizon, and its figures.
//! - `measured`: the motion of a member without the gates of the alarms.
//! - `chance`: from counts to probabilities with their intervals, and when enough members have run.
//! - [`look_ahead`]: runs the members on some threads (`engine`) and gathers an [`Answer`].
//! - [`search`]: the smallest change of speed or weight that ends the alarms that stand.
//! - [`forecast`]: the next minute at the present speed and weight, second by second. [`Held`] compares it with what came.
//! - [`Advisor`], [`ForecastDesk`]: what is asked, what was found and for how long it holds, for a node and for a replay.
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
mod advisor;
mod answer;
mod calm;
mod chance;
mod draws;
mod early;
mod engine;
mod forecast;
mod goal;
mod held;
mod measured;
mod member;
#[cfg(test)]
mod plausible_tests;
mod set_point;
mod standing;
mod start;
mod tally;
mod trace;

pub use advice::{ADVICE_SEED, SearchProgress, Searched, search, tools_in_which};
pub use advisor::{Acting, Advisor, Asked, InForce};
pub use answer::{AlarmChance, Answer, CandidateAnswer, Progress};
pub use chance::{Band, Chance};
pub use engine::{Members, keep_priority, look_ahead, look_further};
pub use forecast::{Bands, Calibration, Compared, Forecast, HORIZON, LEADS, Least, Widening, Widths, forecast, lead};
pub use goal::{Candidate, Ends, Goal, GoalError, MOST_CANDIDATES, MOST_HORIZON, MOST_MEMBERS};
pub use held::Held;
pub use member::{DISTURBANCE, Figure};
pub use set_point::SetPoint;
pub use standing::{Busy, FORECAST_INTERVAL, FORECAST_SEED, ForecastDesk, Forecasts, Issued};
pub use start::{NoTool, Start, StartError};
pub use trace::{SIGNALS, Second, Signal, Trace};
