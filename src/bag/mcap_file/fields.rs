//! Fields of MCAP records, little endian, out of bytes that may be anything.

use std::collections::BTreeMap;

/// The rest of a record's body. Every method gives `None` where the bytes end too early or are not what they should be.
pub(super) struct Fields<'a>(pub &'a [u8]);

impl<'a> Fields<'a> {
    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (head, tail) = self.0.split_at_checked(count)?;
        self.0 = tail;
        Some(head)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.bytes(N)?.try_into().ok()
    }

    pub fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// Bytes behind their 32-bit length.
    pub fn sized(&mut self) -> Option<&'a [u8]> {
        let length = self.u32()?;
        self.bytes(length as usize)
    }

    pub fn string(&mut self) -> Option<String> {
        String::from_utf8(self.sized()?.to_vec()).ok()
    }

    pub fn string_map(&mut self) -> Option<BTreeMap<String, String>> {
        let mut map = BTreeMap::new();
        let mut entries = Fields(self.sized()?);
        while !entries.0.is_empty() {
            map.insert(entries.string()?, entries.string()?);
        }
        Some(map)
    }
}

/// A record in a row of records: opcode and body.
pub(super) type RawRecord<'a> = (u8, &'a [u8]);

/// Splits bytes into records; the last item is `None` if bytes are left over that are not a whole record.
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

/// A schema record.
pub(super) struct Schema {
    pub id: u16,
    pub name: String,
    pub encoding: String,
    pub text: String,
}

impl Schema {
    pub fn parse(body: &[u8]) -> Option<Self> {
        let mut fields = Fields(body);
        Some(Self {
            id: fields.u16()?,
            name: fields.string()?,
            encoding: fields.string()?,
            text: String::from_utf8_lossy(fields.sized()?).into_owned(),
        })
    }
}

/// A channel record.
pub(super) struct Channel {
    pub id: u16,
    pub schema_id: u16,
    pub topic: String,
    pub encoding: String,
    pub metadata: BTreeMap<String, String>,
}

impl Channel {
    pub fn parse(body: &[u8]) -> Option<Self> {
        let mut fields = Fields(body);
        Some(Self {
            id: fields.u16()?,
            schema_id: fields.u16()?,
            topic: fields.string()?,
            encoding: fields.string()?,
            metadata: fields.string_map()?,
        })
    }
}

/// A message record.
pub(super) struct Message<'a> {
    pub channel_id: u16,
    pub log_time: u64,
    pub publish_time: u64,
    pub data: &'a [u8],
}

impl<'a> Message<'a> {
    pub fn parse(body: &'a [u8]) -> Option<Self> {
        let mut fields = Fields(body);
        let channel_id = fields.u16()?;
        let _sequence = fields.u32()?;
        Some(Self {
            channel_id,
            log_time: fields.u64()?,
            publish_time: fields.u64()?,
            data: fields.0,
        })
    }
}

/// What stands before the records of a chunk.
pub(super) struct ChunkHead {
    pub uncompressed_size: u64,
    pub crc: u32,
    pub compression: String,
    pub compressed_size: u64,
}

impl ChunkHead {
    /// The head and what follows it.
    pub fn parse(body: &[u8]) -> Option<(Self, &[u8])> {
        let mut fields = Fields(body);
        let _start_and_end = fields.bytes(16)?;
        let head = Self {
            uncompressed_size: fields.u64()?,
            crc: fields.u32()?,
            compression: fields.string()?,
            compressed_size: fields.u64()?,
        };
        Some((head, fields.0))
    }
}
