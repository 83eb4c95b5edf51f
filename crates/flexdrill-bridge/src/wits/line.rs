//! One connection from its first byte to its last: frames are split, read and counted.

use super::{Counts, Decoder, Discarded, FrameReader, Mapping, Piece, RawFrame, Reading};

/// What a connection carried.
#[derive(Debug, Clone, PartialEq)]
pub enum LineEvent {
    /// A frame and what it means.
    Frame(RawFrame, Box<Reading>),
    /// Bytes that belong to no frame.
    Discarded(Discarded),
}

/// Reads one connection. The sequence of every record begins with it.
#[derive(Debug)]
pub struct Line {
    frames: FrameReader,
    decoder: Decoder,
}

impl Line {
    /// The beginning of a connection. `peer` names its other end.
    pub fn new(mapping: &Mapping, peer: &str) -> Self {
        Self {
            frames: FrameReader::new(),
            decoder: Decoder::new(mapping, peer),
        }
    }

    /// Reads bytes that arrived at `arrived` (ns since 1970), and adds what they are to `counts`.
    pub fn push(&mut self, bytes: &[u8], arrived: i64, counts: &mut Counts, mut give: impl FnMut(LineEvent)) {
        let decoder = &mut self.decoder;
        self.frames
            .push(bytes, |piece| give(event(decoder, piece, arrived, counts)));
    }

    /// Ends the connection: an unfinished frame is discarded.
    pub fn finish(mut self, arrived: i64, counts: &mut Counts, mut give: impl FnMut(LineEvent)) {
        let decoder = &mut self.decoder;
        self.frames.finish(|piece| give(event(decoder, piece, arrived, counts)));
    }
}

fn event(decoder: &mut Decoder, piece: Piece, arrived: i64, counts: &mut Counts) -> LineEvent {
    match piece {
        Piece::Frame(frame) => {
            let reading = decoder.decode(&frame, arrived);
            counts.frame(frame.bytes, &reading);
            LineEvent::Frame(frame, Box::new(reading))
        }
        Piece::Discarded(discarded) => {
            counts.discarded(&discarded);
            LineEvent::Discarded(discarded)
        }
    }
}
