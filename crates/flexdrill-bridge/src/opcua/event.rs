//! What the server of OPC UA reports to the bridge. Every part of the server sends these, so they know none of it.

use std::net::IpAddr;

use crate::Quantity;

/// What happens at the server.
#[derive(Debug, Clone, PartialEq)]
pub enum ServerEvent {
    /// A client connected.
    Opened {
        /// Its address.
        peer: IpAddr,
    },
    /// A connection ended.
    Closed,
    /// A connection was refused, because there are too many.
    Refused {
        /// Its address.
        peer: IpAddr,
    },
    /// A connection did not begin as OPC UA.
    NotOpcUa {
        /// Its address.
        peer: IpAddr,
    },
    /// The system refused a connection.
    NotAccepted,
    /// A user or password was wrong.
    LoginRefused {
        /// The name that was given.
        user: String,
    },
    /// A user wrote a target.
    Written {
        /// Which.
        quantity: Quantity,
        /// The value (SI).
        value: f64,
        /// Who.
        user: String,
    },
}
