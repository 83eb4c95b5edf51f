//! What comes from the rig, from sample to target: who sends it ([`Drivers`]), when it was measured ([`stamped`]), and
//! what is told of it ([`Announcer`]). It knows no middleware; times are handed in.
//!
//! [`Intake`] joins them: a sample goes in, and is taken by the conditioner or refused in words.

mod announcer;
mod driver;
mod drivers;
mod intake;
pub mod stamped;

pub use announcer::{Announcement, Announcer};
pub use driver::{Driver, DriverId};
pub use drivers::{DriverSummary, Drivers, NotDriving, Rule};
pub use intake::{Intake, RigSample, SampleRefused, Sent};
