//! Messages as CDR bytes, which are encoded once for DDS, recording and viewers.

use std::fmt;

use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeTuple, Serializer};

/// The CDR body of a message (little endian, without the four bytes of the encapsulation header).
///
/// Serialising writes the bytes unchanged. Deserialising reads the rest of the input, including the padding at its end.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RawCdr(pub Vec<u8>);

impl Serialize for RawCdr {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // Eight bytes at a time: aligned from the start of the body, so that CDR adds no padding between them.
        let (words, rest) = self.0.as_chunks::<8>();
        let mut tuple = serializer.serialize_tuple(words.len() + rest.len())?;
        for word in words {
            tuple.serialize_element(&u64::from_le_bytes(*word))?;
        }
        for byte in rest {
            tuple.serialize_element(byte)?;
        }
        tuple.end()
    }
}

impl<'de> Deserialize<'de> for RawCdr {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Rest;
        impl<'de> Visitor<'de> for Rest {
            type Value = RawCdr;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("bytes")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<RawCdr, A::Error> {
                let mut bytes = Vec::new();
                // Words first, so that numbers of eight bytes from a sender with the other byte order come out right. The
                // end of the input shows as an error of the next element: CDR does not say how long it is.
                while let Ok(Some(word)) = seq.next_element::<u64>() {
                    bytes.extend(word.to_le_bytes());
                }
                while let Ok(Some(byte)) = seq.next_element() {
                    bytes.push(byte);
                }
                Ok(RawCdr(bytes))
            }
        }
        deserializer.deserialize_tuple(usize::MAX, Rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::{from_cdr_body, to_cdr_body};

    #[test]
    fn bytes_go_through_unchanged() {
        for length in [0, 1, 7, 8, 9, 64, 1001] {
            let bytes: Vec<u8> = (0..length).map(|i| (i * 7 + 3) as u8).collect();
            let raw = RawCdr(bytes.clone());
            assert_eq!(to_cdr_body(&raw).unwrap(), bytes, "length {length}");
            assert_eq!(from_cdr_body::<RawCdr>(&bytes).unwrap().0, raw, "length {length}");
        }
    }
}
