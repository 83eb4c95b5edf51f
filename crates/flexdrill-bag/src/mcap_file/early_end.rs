//! The end of a file whose last chunks could not be written.
//!
//! The MCAP writer's own end describes every chunk that the writer has produced. The end built here describes only
//! those in the file.

use std::collections::BTreeMap;

use mcap::records::op;

use super::RECORD_HEAD;
use super::records::{Fields, records};

pub(crate) struct Content {
    /// End of the last whole chunk (bytes).
    pub length: u64,
    /// Number of messages by channel.
    pub counts: BTreeMap<u16, u64>,
    /// First and last log time (ns).
    pub bounds: (u64, u64),
    /// Number of schemas.
    pub schemas: u16,
}

/// The end of a file with this content, with an index: the schemas, channels and chunk indices of the writer's own end
/// (`end`), without those of chunks that are not in the file.
pub(crate) fn indexed(end: &[u8], content: &Content) -> Vec<u8> {
    let mut data_ended = false;
    let mut chunks = Vec::new();
    let mut described = Vec::new();
    for (opcode, body) in records(end).map_while(|record| record) {
        match opcode {
            op::DATA_END => data_ended = true,
            op::FOOTER => break,
            op::SCHEMA | op::CHANNEL if data_ended => add(&mut described, opcode, body),
            op::CHUNK_INDEX if chunk_offset(body).is_some_and(|offset| offset < content.length) => chunks.push(body),
            _ => {}
        }
    }
    let mut bytes = Vec::new();
    // A checksum of zero means that there is none.
    add(&mut bytes, op::DATA_END, &[0; 4]);
    let summary_start = content.length + bytes.len() as u64;
    bytes.extend(described);
    add(&mut bytes, op::STATISTICS, &statistics(content, chunks.len() as u32));
    for chunk in chunks {
        add(&mut bytes, op::CHUNK_INDEX, chunk);
    }
    close(bytes, summary_start)
}

/// The shortest valid end, without an index.
pub(crate) fn shortest() -> Vec<u8> {
    let mut bytes = Vec::new();
    add(&mut bytes, op::DATA_END, &[0; 4]);
    close(bytes, 0)
}

fn close(mut bytes: Vec<u8>, summary_start: u64) -> Vec<u8> {
    // The footer has neither an offset table nor a checksum of the summary.
    let footer = [&summary_start.to_le_bytes()[..], &[0; 8], &[0; 4]].concat();
    add(&mut bytes, op::FOOTER, &footer);
    bytes.extend_from_slice(mcap::MAGIC);
    bytes
}

fn add(bytes: &mut Vec<u8>, opcode: u8, body: &[u8]) {
    bytes.reserve(RECORD_HEAD as usize + body.len());
    bytes.push(opcode);
    bytes.extend_from_slice(&(body.len() as u64).to_le_bytes());
    bytes.extend_from_slice(body);
}

/// Offset of a chunk, from its index record: the field after the earliest and latest time.
fn chunk_offset(index: &[u8]) -> Option<u64> {
    let mut fields = Fields(index);
    let _earliest_and_latest = (fields.u64()?, fields.u64()?);
    fields.u64()
}

fn statistics(content: &Content, chunks: u32) -> Vec<u8> {
    let counted: Vec<u8> = content
        .counts
        .iter()
        .flat_map(|(channel, count)| [&channel.to_le_bytes()[..], &count.to_le_bytes()].concat())
        .collect();
    [
        &content.counts.values().sum::<u64>().to_le_bytes()[..],
        &content.schemas.to_le_bytes(),
        &(content.counts.len() as u32).to_le_bytes(),
        // The file has neither attachments nor metadata.
        &[0; 8],
        &chunks.to_le_bytes(),
        &content.bounds.0.to_le_bytes(),
        &content.bounds.1.to_le_bytes(),
        &(counted.len() as u32).to_le_bytes(),
        &counted,
    ]
    .concat()
}
