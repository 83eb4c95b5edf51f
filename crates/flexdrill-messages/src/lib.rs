//! ROS 2 message types: generated from `msg/*.msg` and `external/`, their bytes, how they are filled from a snapshot of
//! the twin, and their codes in words.

mod cdr;
pub mod fill;
mod journal;
pub mod large_array;
mod message;
pub mod outputs;
mod time;
pub mod topics;
pub mod words;

#[expect(
    missing_docs,
    reason = "fields are documented where their .msg file documents them; those of other packages often do not"
)]
#[rustfmt::skip]
pub mod generated;

pub use cdr::{CdrError, MOST_PADDING, from_cdr, from_cdr_body, to_cdr, to_cdr_body, to_cdr_into};
pub use generated::flexdrill::*;
pub use generated::{
    builtin_interfaces, diagnostic_msgs, geometry_msgs, lifecycle_msgs, rcl_interfaces, rosgraph_msgs, sensor_msgs,
    std_msgs, std_srvs, tf2_msgs, type_description_interfaces, visualization_msgs,
};
pub use message::{Message, ServiceInfo, TypeInfo, find_service, find_type};
