//! What came over a connection, in numbers: every byte and every frame is in one of them.

use super::decode::Reading;
use super::frame::{DiscardReason, Discarded};
use super::report::NotUsed;
use super::{FrameUse, ItemFaultKind, Sequence};

/// The counts of a connection or of all of them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Complete frames.
    pub frames: u64,
    /// Bytes of complete frames.
    pub frame_bytes: u64,
    /// Frames that gave at least one value.
    pub used: u64,
    /// Complete frames that gave no value, by [`NotUsed::ALL`].
    pub not_used: [u64; NotUsed::ALL.len()],
    /// Pieces that are no frame, by [`DiscardReason::ALL`].
    pub discarded: [u64; DiscardReason::ALL.len()],
    /// Bytes of those pieces.
    pub discarded_bytes: u64,
    /// Values that were used.
    pub values: u64,
    /// Items that the mapping does not name.
    pub unmapped: u64,
    /// Items that mean "no value".
    pub nulls: u64,
    /// Items and lines that could not be used, by [`ItemFaultKind::ALL`].
    pub faults: [u64; ItemFaultKind::ALL.len()],
    /// Records that came twice.
    pub duplicates: u64,
    /// Records that came late.
    pub out_of_order: u64,
    /// Records that the sequence numbers say are missing.
    pub missing: u64,
}

impl Counts {
    /// Counts a frame that was read.
    pub fn frame(&mut self, bytes: u64, reading: &Reading) {
        self.frames += 1;
        self.frame_bytes += bytes;
        match reading.outcome {
            FrameUse::Used { values } => {
                self.used += 1;
                self.values += u64::from(values);
            }
            FrameUse::NotUsed(reason) => self.not_used[reason as usize] += 1,
        }
        self.unmapped += u64::from(reading.unmapped);
        self.nulls += u64::from(reading.nulls);
        for fault in &reading.faults {
            self.faults[fault.kind as usize] += 1;
        }
        self.faults[ItemFaultKind::LongLine as usize] += u64::from(reading.more_faults);
        for record in &reading.records {
            match record.sequence {
                Sequence::Duplicate => self.duplicates += 1,
                Sequence::OutOfOrder { .. } => self.out_of_order += 1,
                Sequence::Gap { missing } => self.missing = self.missing.saturating_add(missing),
                // The frame is counted with its reason.
                Sequence::Jump { .. }
                | Sequence::Unnumbered
                | Sequence::First
                | Sequence::Next
                | Sequence::Stalled
                | Sequence::Restarted => {}
            }
            self.missing = self.missing.saturating_sub(record.retracted);
        }
    }

    /// Counts a piece that is no frame.
    pub fn discarded(&mut self, discarded: &Discarded) {
        self.discarded[discarded.reason as usize] += 1;
        self.discarded_bytes += discarded.bytes;
    }

    /// Complete frames that gave no value.
    pub fn frames_not_used(&self) -> u64 {
        self.not_used.iter().sum()
    }

    /// Items and lines that could not be used.
    pub fn all_faults(&self) -> u64 {
        self.faults.iter().sum()
    }
}
