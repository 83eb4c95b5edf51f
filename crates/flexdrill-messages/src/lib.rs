//! The ROS 2 messages of flexdrill: types generated from `msg/*.msg` and `external/`, their CDR bytes, and the topics. The
//! crate knows no network and no file, and nothing of the twin: `flexdrill-outputs` fills the messages.
//!
//! `external/` has the fields and constants of other packages' types as far as the node uses them, in words of this project.
//! Those of `simulation_interfaces` are the same in its versions 1.5 to 2.1 (Apache-2.0).

mod cdr;
mod grown;
mod journal;
pub mod large_array;
mod message;
mod moment;
mod time;
pub mod topics;

#[expect(
    missing_docs,
    reason = "fields are documented where their .msg file documents them; those of other packages often do not"
)]
#[rustfmt::skip]
pub mod generated;

pub use cdr::{
    CdrError, MOST_PADDING, from_cdr, from_cdr_body, message_from_cdr_body, to_cdr, to_cdr_body, to_cdr_into,
};
pub use generated::flexdrill::*;
pub use generated::{
    action_msgs, builtin_interfaces, diagnostic_msgs, geometry_msgs, lifecycle_msgs, rcl_interfaces, rosgraph_msgs,
    sensor_msgs, simulation_interfaces, std_msgs, std_srvs, tf2_msgs, type_description_interfaces,
    unique_identifier_msgs, visualization_msgs,
};
pub use message::{ActionInfo, Message, ServiceInfo, TypeInfo, find_action, find_service, find_type};
pub use moment::AlarmMoment;
