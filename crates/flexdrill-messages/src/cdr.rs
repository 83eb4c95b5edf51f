//! CDR, the bytes of a message on the wire and in bags: a header of 4 bytes with the byte order, then the fields.

use byteorder::{BigEndian, LittleEndian};
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Message, grown};

/// Header of plain little-endian CDR.
const LITTLE_ENDIAN: [u8; 4] = [0, 1, 0, 0];
/// Most bytes of padding after a body: up to the next multiple of four.
pub const MOST_PADDING: usize = 3;

/// Why bytes are not a message, or a message could not be made into bytes.
#[derive(Debug, thiserror::Error)]
pub enum CdrError {
    /// Too short for the header.
    #[error("{ros_type}: {length} bytes are too few for a CDR header of 4")]
    NoHeader {
        /// Type that was expected.
        ros_type: &'static str,
        /// Number of bytes.
        length: usize,
    },
    /// Not plain CDR.
    #[error("{ros_type}: encoding 0x{kind:04x} is not plain CDR (0x0000 big endian, 0x0001 little endian)")]
    UnknownEncoding {
        /// Type that was expected.
        ros_type: &'static str,
        /// First two bytes.
        kind: u16,
    },
    /// The bytes do not fit the type.
    #[error("{ros_type}: {source}; the sender may use another definition of this type")]
    Decode {
        /// Type that was expected.
        ros_type: &'static str,
        /// Where it went wrong.
        source: cdr_encoding::Error,
    },
    /// More bytes than the type has.
    #[error("{ros_type}: {extra} bytes after the message; the sender may use another definition of this type")]
    TooLong {
        /// Type that was expected.
        ros_type: &'static str,
        /// Bytes after the message.
        extra: usize,
    },
    /// The message could not be encoded.
    #[error("{ros_type}: cannot encode: {source}")]
    Encode {
        /// Type of the message.
        ros_type: &'static str,
        /// The error behind it.
        source: cdr_encoding::Error,
    },
}

/// The message as little-endian CDR with its header.
///
/// # Errors
/// None with types from [`super::generated`]; the encoder's own error otherwise.
pub fn to_cdr<M: Message>(message: &M) -> Result<Vec<u8>, CdrError> {
    let mut bytes = Vec::new();
    to_cdr_into(message, &mut bytes)?;
    Ok(bytes)
}

/// Like [`to_cdr`], into a buffer that is cleared first and keeps its memory.
///
/// # Errors
/// As [`to_cdr`].
pub fn to_cdr_into<M: Message>(message: &M, bytes: &mut Vec<u8>) -> Result<(), CdrError> {
    bytes.clear();
    bytes.extend_from_slice(&LITTLE_ENDIAN);
    // Alignment counts from the first byte after the header, which is where the encoder begins.
    cdr_encoding::to_writer::<M, LittleEndian, _>(&mut *bytes, message).map_err(|source| CdrError::Encode {
        ros_type: M::ROS_TYPE,
        source,
    })
}

/// The body of a message or service, little endian, without the header, which DDS writes itself.
///
/// # Errors
/// When a string or sequence is longer than CDR can say (2^32 elements).
pub fn to_cdr_body<T: Serialize>(message: &T) -> Result<Vec<u8>, cdr_encoding::Error> {
    cdr_encoding::to_vec::<T, LittleEndian>(message)
}

/// Decodes a little-endian body. Also returns the number of bytes read.
///
/// # Errors
/// When the bytes are too short or do not fit the type.
pub fn from_cdr_body<T: DeserializeOwned>(body: &[u8]) -> Result<(T, usize), cdr_encoding::Error> {
    cdr_encoding::from_bytes::<T, LittleEndian>(body)
}

/// The message in a little-endian body, of a sender with the present definition or an older, shorter one.
///
/// # Errors
/// When the bytes are too short or do not fit the type.
pub fn message_from_cdr_body<M: Message>(body: &[u8]) -> Result<M, cdr_encoding::Error> {
    from_cdr_body(body)
        .map(|(message, _)| message)
        .or_else(|error| grown::complete(body, false).ok_or(error))
}

/// The message in CDR bytes with their header, of either byte order.
///
/// # Errors
/// When the header is missing or not plain CDR, or the rest does not fit the type exactly.
pub fn from_cdr<M: Message>(bytes: &[u8]) -> Result<M, CdrError> {
    let ros_type = M::ROS_TYPE;
    let Some((header, body)) = bytes.split_first_chunk::<4>() else {
        return Err(CdrError::NoHeader {
            ros_type,
            length: bytes.len(),
        });
    };
    let decoded = match [header[0], header[1]] {
        [0, 0] => cdr_encoding::from_bytes::<M, BigEndian>(body),
        [0, 1] => from_cdr_body(body),
        other => {
            return Err(CdrError::UnknownEncoding {
                ros_type,
                kind: u16::from_be_bytes(other),
            });
        }
    };
    let (message, used) = match decoded {
        Ok(decoded) => decoded,
        Err(source) => {
            return grown::complete(body, header[1] == 0).ok_or(CdrError::Decode { ros_type, source });
        }
    };
    match body.len().saturating_sub(used) {
        extra if extra > MOST_PADDING => Err(CdrError::TooLong { ros_type, extra }),
        _ => Ok(message),
    }
}
