//! The rig's inputs from sample to target: the publisher of a sample ([`Drivers`]), its age ([`stamped`]), its value (the
//! conditioner of the core), and the log lines about safe values ([`SafeValueWatch`]). The room knows no middleware and
//! no clock: the caller passes times in.
//!
//! [`Intake`] owns all of them: it accepts a sample, or refuses it with a reason. It also keeps what the rig measures
//! besides ([`Measured`]), and the surveys of the hole ([`Surveys`]).

mod driver;
mod drivers;
mod fluctuation;
mod intake;
mod measured;
mod safe_value_watch;
pub mod stamped;
mod surveys;
mod time_zone;

pub use driver::{Driver, DriverId};
pub use drivers::{DriverSummary, Drivers, NotDriving, Rule};
pub use fluctuation::Fluctuation;
pub use intake::{Carried, Intake, RigSample, SampleRefused, SampleSource};
pub use measured::{Measured, MeasuredRefused, MeasuredValue};
pub use safe_value_watch::{SafeValueEvent, SafeValueWatch};
pub use surveys::{KeptSurveys, OfHole, Restored, SurveyCounts, SurveyRefused, Surveys, Taken};
