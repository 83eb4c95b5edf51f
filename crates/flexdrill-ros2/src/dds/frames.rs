//! The protocol on the socket between the node and its DDS process. A frame is a length of four bytes and a value as
//! postcard.

use std::io::{self, Read, Write};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::plan::{Guid, GuidPrefix, Plan};

/// Longest frame. The longest message of a tool of 200 stations has 80 kB.
pub const MOST_BYTES: usize = 16 << 20;

/// To the DDS process.
#[derive(Debug, Serialize, Deserialize)]
pub enum ToSide {
    /// Create these endpoints. This is the first frame.
    Begin(Plan),
    /// Publish a CDR body.
    Publish {
        /// Number of the writer in the plan.
        writer: u16,
        /// Without the CDR header.
        #[serde(with = "serde_bytes")]
        body: Vec<u8>,
    },
    /// Answer a request.
    Reply {
        /// Number of the service in the plan.
        service: u16,
        /// The request that it answers.
        to: RequestId,
        /// Without the CDR header.
        #[serde(with = "serde_bytes")]
        body: Vec<u8>,
    },
    /// Leave the network, and end.
    End,
}

/// From the DDS process.
#[derive(Debug, Serialize, Deserialize)]
pub enum FromSide {
    /// All endpoints exist.
    Up(GuidPrefix),
    /// The process ends, for this reason.
    Failed(String),
    /// A sample was received.
    Sample {
        /// Number of the reader in the plan.
        reader: u16,
        /// Its writer.
        writer: Guid,
        /// The CDR body, as little endian.
        #[serde(with = "serde_bytes")]
        body: Vec<u8>,
    },
    /// A sample was received that cannot be decoded.
    Unreadable {
        /// Number of the reader in the plan.
        reader: u16,
        /// The reason.
        why: String,
    },
    /// A request was received.
    Request {
        /// Number of the service in the plan.
        service: u16,
        /// What the client knows the request by.
        id: RequestId,
        /// The client.
        client: Peer,
        /// Number of the request among all of its writer's.
        sequence: i64,
        /// When it was sent, by the client's clock (ns since 1970); none where the request does not state it.
        sent: Option<i64>,
        /// The CDR body.
        #[serde(with = "serde_bytes")]
        body: Vec<u8>,
    },
    /// A reply was sent long enough ago for its client to have it.
    Replied {
        /// Number of the service in the plan.
        service: u16,
        /// The request that it answered.
        to: RequestId,
    },
    /// DDS works: a sample has just passed through it.
    Beat(Beat),
    /// The endpoints of other programs have changed.
    Peers(Peers),
    /// A line for the log.
    Log {
        /// Its severity.
        level: LogLevel,
        /// Its text.
        text: String,
    },
    /// Reliable readers do not acknowledge samples; the writer of their topic was replaced.
    Stalled(Stall),
}

/// What a client knows its request by, and finds in the reply. It holds for any DDS process of the node: a request that is
/// open when the process is replaced is answered through the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct RequestId {
    /// The writer that the client states: that of the request, or of another endpoint of the client.
    pub writer: Guid,
    /// The number that the client states.
    pub number: i64,
}

/// Severity of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LogLevel {
    /// A function has failed.
    Error,
    /// A function may not work as intended.
    Warning,
    /// Information.
    Info,
    /// Details for the search of a cause.
    Debug,
}

/// The work of the DDS process since it was started.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Beat {
    /// Per writer: samples accepted by DDS, and samples refused.
    pub written: Vec<(u64, u64)>,
    /// Resident memory (bytes).
    pub memory: u64,
}

/// The endpoints of other programs on the topics of the node.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Peers {
    /// Per reader of the plan: its writers.
    pub writers: Vec<Vec<Peer>>,
    /// Per writer of the plan: the number of its readers.
    pub readers: Vec<u32>,
    /// Other nodes with the name of this one.
    pub namesakes: Vec<Peer>,
}

/// An endpoint of another program.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Peer {
    /// Its GUID.
    pub id: Guid,
    /// Absolute name of its ROS 2 node, where known. A client that is no node has a description instead.
    pub node: Option<String>,
    /// Its address, such as `192.168.1.7`.
    pub address: Option<String>,
}

impl std::fmt::Display for Peer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.node {
            Some(node) if node.starts_with('/') => write!(f, "node {node}")?,
            Some(other) => f.write_str(other)?,
            None => f.write_str("a DDS program")?,
        }
        if let Some(address) = &self.address {
            write!(f, " at {address}")?;
        }
        f.write_str(" (id ")?;
        for byte in self.id {
            write!(f, "{byte:02x}")?;
        }
        f.write_str(")")
    }
}

/// A topic whose readers did not acknowledge samples.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stall {
    /// Its absolute name.
    pub topic: String,
    /// The stalled readers, or all reliable readers where these could not be identified.
    pub readers: Vec<Peer>,
    /// Whether all of `readers` are stalled, or at least one of them.
    pub is_certain: bool,
}

/// Encodes a value as a frame.
///
/// # Errors
/// When it cannot be encoded or is longer than [`MOST_BYTES`].
pub fn encode<T: Serialize>(value: &T) -> io::Result<Vec<u8>> {
    let frame = postcard::to_extend(value, vec![0; 4]).map_err(io::Error::other)?;
    let length = frame.len() - 4;
    if length > MOST_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            format!("a frame of {length} bytes is longer than {MOST_BYTES}"),
        ));
    }
    let mut frame = frame;
    frame[..4].copy_from_slice(&(length as u32).to_le_bytes());
    Ok(frame)
}

/// Writes a value as a frame.
///
/// # Errors
/// When it cannot be encoded, is too long, or the other process has closed the socket.
pub fn write<T: Serialize>(to: &mut impl Write, value: &T) -> io::Result<()> {
    to.write_all(&encode(value)?)
}

/// Reads the next frame; `None` at the end.
///
/// # Errors
/// When the stream ends within a frame, or the frame is too long or no such value.
pub fn read<T: DeserializeOwned>(from: &mut impl Read) -> io::Result<Option<T>> {
    let mut length = [0; 4];
    match from.read(&mut length[..1])? {
        0 => return Ok(None),
        _ => from.read_exact(&mut length[1..])?,
    }
    let length = u32::from_le_bytes(length) as usize;
    if length > MOST_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            format!("a frame of {length} bytes is longer than {MOST_BYTES}"),
        ));
    }
    let mut bytes = vec![0; length];
    from.read_exact(&mut bytes)?;
    postcard::from_bytes(&bytes).map(Some).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_read_as_written_and_long_ones_are_refused() {
        let mut pipe = Vec::new();
        for body in [vec![], vec![7; 1000], vec![9; 100_000]] {
            write(&mut pipe, &ToSide::Publish { writer: 3, body }).unwrap();
        }
        write(&mut pipe, &ToSide::End).unwrap();
        let mut from = pipe.as_slice();
        for length in [0, 1000, 100_000] {
            let Some(ToSide::Publish { writer: 3, body }) = read(&mut from).unwrap() else {
                panic!("another frame");
            };
            assert_eq!(body.len(), length);
        }
        assert!(matches!(read(&mut from).unwrap(), Some(ToSide::End)));
        assert!(read::<ToSide>(&mut from).unwrap().is_none());
        let too_long = ToSide::Publish {
            writer: 0,
            body: vec![0; MOST_BYTES + 1],
        };
        assert!(write(&mut Vec::new(), &too_long).is_err());
    }

    #[test]
    fn wrong_bytes_are_an_error() {
        assert!(read::<ToSide>(&mut [255, 255, 255, 255, 0].as_slice()).is_err());
        assert!(read::<ToSide>(&mut [4, 0, 0, 0, 1].as_slice()).is_err());
        assert!(read::<ToSide>(&mut [1, 0, 0, 0, 200].as_slice()).is_err());
    }

    #[test]
    fn a_peer_shows_what_is_known() {
        let peer = Peer {
            id: [1; 16],
            node: Some("/plot".into()),
            address: Some("10.0.0.3".into()),
        };
        let id = "01".repeat(16);
        assert_eq!(peer.to_string(), format!("node /plot at 10.0.0.3 (id {id})"));
        let unknown = Peer {
            node: None,
            address: None,
            ..peer
        };
        assert_eq!(unknown.to_string(), format!("a DDS program (id {id})"));
    }
}
