//! Splits arbitrary bytes into MCAP records.

use mcap::parse_record;
use mcap::records::{MessageHeader, Record, op};

/// A cursor over little-endian fields. Every method returns `None` when the bytes end too early.
pub(super) struct Fields<'a>(pub &'a [u8]);

impl<'a> Fields<'a> {
    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.0.split_at_checked(count)?;
        self.0 = tail;
        Some(head)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.bytes(N)?.try_into().ok()
    }

    fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// The bytes of a text or map, after its 32-bit length.
    pub fn counted(&mut self) -> Option<&'a [u8]> {
        let length = self.u32()?;
        self.bytes(usize::try_from(length).ok()?)
    }
}

/// Opcode and body of a record.
pub(super) type RawRecord<'a> = (u8, &'a [u8]);

/// Splits bytes into records; the last item is `None` if the bytes end within a record.
pub(super) fn records(mut bytes: &[u8]) -> impl Iterator<Item = Option<RawRecord<'_>>> {
    std::iter::from_fn(move || {
        if bytes.is_empty() {
            return None;
        }
        let mut fields = Fields(bytes);
        let record = (|| {
            let opcode = fields.bytes(1)?[0];
            let length = usize::try_from(fields.u64()?).ok()?;
            Some((opcode, fields.bytes(length)?))
        })();
        bytes = if record.is_some() { fields.0 } else { &[] };
        Some(record)
    })
}

/// Whether the texts of a schema or channel record lie within it. `mcap` allocates a text's claimed length, up to
/// 4 GiB, before it checks that the record has so many bytes.
pub(super) fn texts_fit(opcode: u8, body: &[u8]) -> bool {
    let mut fields = Fields(body);
    let walked = (|| {
        match opcode {
            op::SCHEMA => {
                let _id = fields.bytes(2)?;
                let (_name, _encoding) = (fields.counted()?, fields.counted()?);
            }
            op::CHANNEL => {
                let _ids = fields.bytes(4)?;
                let (_topic, _encoding) = (fields.counted()?, fields.counted()?);
                let mut metadata = Fields(fields.counted()?);
                while !metadata.0.is_empty() {
                    metadata.counted()?;
                }
            }
            _ => {}
        }
        Some(())
    })();
    walked.is_some()
}

/// Bytes of a message record before its data.
pub(super) const MESSAGE_HEAD: usize = 22;

/// The head of a message record.
pub(super) fn message_header(body: &[u8]) -> Option<MessageHeader> {
    match parse_record(op::MESSAGE, body.get(..MESSAGE_HEAD)?) {
        Ok(Record::Message { header, .. }) => Some(header),
        _ => None,
    }
}

/// The fields before a chunk's records. `mcap` parses them only together with a whole chunk.
pub(super) struct ChunkHead {
    pub uncompressed_size: u64,
    pub crc: u32,
    pub compression: String,
    pub compressed_size: u64,
}

impl ChunkHead {
    /// Parses the head; returns it with the bytes after it.
    pub fn parse(body: &[u8]) -> Option<(Self, &[u8])> {
        let mut fields = Fields(body);
        let _start_and_end = fields.bytes(16)?;
        let (uncompressed_size, crc) = (fields.u64()?, fields.u32()?);
        let name_length = fields.u32()? as usize;
        let head = Self {
            uncompressed_size,
            crc,
            compression: String::from_utf8(fields.bytes(name_length)?.to_vec()).ok()?,
            compressed_size: fields.u64()?,
        };
        Some((head, fields.0))
    }
}
