//! Frames on a line: `&&`, lines of data, `!!`.
//!
//! The reader keeps nothing beyond the frame that it reads, and every byte leaves it as part of a frame or of a piece that
//! is discarded with its reason.

use std::mem;

/// Longest line of data that is read (bytes). Items have at most some tens of characters.
pub const LONGEST_LINE: usize = 1024;
/// Longest frame that is read (bytes): a hundred items of each of a hundred records would have less.
pub const LONGEST_FRAME: usize = 64 << 10;
/// Bytes of a discarded piece that are kept for the log.
const SAMPLE: usize = 40;

/// Bytes of the mark with which some programs begin UTF-8.
const BYTE_ORDER_MARK: [u8; 3] = [0xef, 0xbb, 0xbf];

flexdrill_base::listed! {
    /// Why bytes were discarded.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum DiscardReason: 1 {
        /// They lie outside of any frame.
        Outside: "bytes outside of frames";
        /// The frame ended without `!!`: another began.
        CutByNext: "frame cut by the next one";
        /// The frame ended without `!!`: the connection ended.
        CutByEnd: "frame cut by the end of the connection";
        /// The frame is longer than [`LONGEST_FRAME`].
        LongFrame: "frame too long";
    }
}

impl DiscardReason {
    /// In words, for logs and diagnostics.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }
}

/// Bytes that belong to no frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Discarded {
    /// The reason, in words for a log.
    pub reason: DiscardReason,
    /// How many.
    pub bytes: u64,
    /// The first of them, for the log.
    pub sample: Vec<u8>,
}

/// What a line carries.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece {
    /// A frame.
    Frame(RawFrame),
    /// Bytes that belong to none.
    Discarded(Discarded),
}

/// A frame as it came, without its marks.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RawFrame {
    /// Its lines, without line ends and surrounding blanks; empty ones are left out.
    pub lines: Vec<Vec<u8>>,
    /// Lines longer than [`LONGEST_LINE`], which are left out.
    pub long_lines: u32,
    /// All its bytes, marks and line ends included.
    pub bytes: u64,
}

/// Splits the bytes of one connection into frames.
#[derive(Debug, Default)]
pub struct FrameReader {
    /// The line so far.
    line: Vec<u8>,
    /// The line is too long; its rest is passed over.
    overlong: bool,
    /// The frame so far.
    frame: Option<RawFrame>,
    /// Bytes outside of a frame so far, and the first of them.
    outside: (u64, Vec<u8>),
}

impl FrameReader {
    /// A reader at the beginning of a connection.
    pub fn new() -> Self {
        Self::default()
    }

    /// Reads bytes as they come, in pieces of any size.
    pub fn push(&mut self, bytes: &[u8], mut give: impl FnMut(Piece)) {
        for &byte in bytes {
            self.count(byte, &mut give);
            if matches!(byte, b'\r' | b'\n') {
                self.end_line();
                continue;
            }
            if self.overlong || self.line.is_empty() && self.is_padding(byte) {
                continue;
            }
            self.line.push(byte);
            match self.line.as_slice() {
                b"&&" => self.begin(&mut give),
                b"!!" if self.frame.is_some() => self.end(&mut give),
                line if line.len() > LONGEST_LINE => {
                    self.overlong = true;
                    self.line.clear();
                    if let Some(frame) = &mut self.frame {
                        frame.long_lines += 1;
                    }
                }
                _ => {}
            }
        }
    }

    /// Ends the connection and discards the bytes of an unfinished frame.
    pub fn finish(&mut self, mut give: impl FnMut(Piece)) {
        self.flush_outside(&mut give);
        if let Some(frame) = self.frame.take() {
            give(Piece::Discarded(cut(&frame, &self.line, DiscardReason::CutByEnd)));
        }
        *self = Self::default();
    }

    /// Whether a byte before the text of a line means nothing: control characters such as STX and XON, and between frames
    /// also bytes beyond ASCII, such as a byte order mark or what a terminal server negotiates.
    fn is_padding(&self, byte: u8) -> bool {
        byte.is_ascii_control() || byte == b' ' || self.frame.is_none() && !byte.is_ascii()
    }

    /// Counts a byte to the frame or to what lies outside of frames.
    fn count(&mut self, byte: u8, give: &mut impl FnMut(Piece)) {
        match &mut self.frame {
            Some(frame) => {
                frame.bytes += 1;
                if frame.bytes > LONGEST_FRAME as u64 {
                    let discarded = cut(frame, &self.line, DiscardReason::LongFrame);
                    self.frame = None;
                    give(Piece::Discarded(discarded));
                    // The rest of this frame lies outside of frames.
                    self.line.clear();
                    self.overlong = !matches!(byte, b'\r' | b'\n');
                }
            }
            None => {
                let (count, sample) = &mut self.outside;
                *count += 1;
                if sample.len() < SAMPLE {
                    sample.push(byte);
                }
                // A mark that begins here must not lose its first byte.
                if *count >= LONGEST_FRAME as u64 && byte != b'&' {
                    self.flush_outside(give);
                }
            }
        }
    }

    fn begin(&mut self, give: &mut impl FnMut(Piece)) {
        self.line.clear();
        // The two bytes of the mark were counted to what was before.
        if let Some(mut frame) = self.frame.take() {
            frame.bytes -= 2;
            give(Piece::Discarded(cut(&frame, &[], DiscardReason::CutByNext)));
        } else {
            self.outside.0 = self.outside.0.saturating_sub(2);
            let kept = self
                .outside
                .1
                .len()
                .min(usize::try_from(self.outside.0).unwrap_or(SAMPLE));
            self.outside.1.truncate(kept);
            self.flush_outside(give);
        }
        self.frame = Some(RawFrame {
            bytes: 2,
            ..RawFrame::default()
        });
    }

    fn end(&mut self, give: &mut impl FnMut(Piece)) {
        self.line.clear();
        if let Some(frame) = self.frame.take() {
            give(Piece::Frame(frame));
        }
    }

    fn end_line(&mut self) {
        self.overlong = false;
        let line = mem::take(&mut self.line);
        if let Some(frame) = &mut self.frame {
            let text = line.trim_ascii();
            if !text.is_empty() {
                frame.lines.push(text.to_vec());
            }
        }
    }

    fn flush_outside(&mut self, give: &mut impl FnMut(Piece)) {
        let (bytes, sample) = mem::take(&mut self.outside);
        // Line ends and control characters between frames are no fault.
        let is_padding = |byte: &u8| byte.is_ascii_control() || *byte == b' ' || BYTE_ORDER_MARK.contains(byte);
        if bytes > 0 && (bytes > SAMPLE as u64 || !sample.iter().all(is_padding)) {
            give(Piece::Discarded(Discarded {
                reason: DiscardReason::Outside,
                bytes,
                sample,
            }));
        }
    }
}

fn cut(frame: &RawFrame, line: &[u8], reason: DiscardReason) -> Discarded {
    let mut sample: Vec<u8> = frame.lines.first().map_or(line, Vec::as_slice).to_vec();
    sample.truncate(SAMPLE);
    Discarded {
        reason,
        bytes: frame.bytes,
        sample,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(chunks: &[&[u8]]) -> Vec<Piece> {
        let (mut reader, mut pieces) = (FrameReader::new(), Vec::new());
        for chunk in chunks {
            reader.push(chunk, |piece| pieces.push(piece));
        }
        reader.finish(|piece| pieces.push(piece));
        pieces
    }

    fn lines(piece: &Piece) -> Vec<&str> {
        match piece {
            Piece::Frame(frame) => frame.lines.iter().map(|line| str::from_utf8(line).unwrap()).collect(),
            Piece::Discarded(discarded) => panic!("{discarded:?}"),
        }
    }

    fn discarded(piece: &Piece) -> (DiscardReason, u64) {
        match piece {
            Piece::Discarded(discarded) => (discarded.reason, discarded.bytes),
            Piece::Frame(frame) => panic!("{frame:?}"),
        }
    }

    #[test]
    fn frames_of_all_line_ends_and_chunks_are_the_same() {
        for end in ["\r\n", "\n", "\r", "\n\r"] {
            let text = format!("&&{end}01081234.5{end}{end} 0120 40 {end}!!{end}&&{end}!!{end}");
            let whole = read(&[text.as_bytes()]);
            assert_eq!(whole.len(), 2, "{end:?}");
            assert_eq!(lines(&whole[0]), ["01081234.5", "0120 40"]);
            assert!(lines(&whole[1]).is_empty());
            let single: Vec<&[u8]> = text.as_bytes().chunks(1).collect();
            assert_eq!(read(&single), whole);
        }
    }

    #[test]
    fn marks_count_at_the_begin_of_a_line_only_and_may_share_it() {
        let pieces = read(&[b"&&\r\n0101well &&!! 7\r\n0120 40\r\n!!&&0121 100\r\n!!"]);
        assert_eq!(lines(&pieces[0]), ["0101well &&!! 7", "0120 40"]);
        assert_eq!(lines(&pieces[1]), ["0121 100"]);
    }

    /// Framed serial protocols, flow control, byte order marks, terminal servers.
    #[test]
    fn control_characters_before_a_mark_are_skipped() {
        let text =
            b"\xef\xbb\xbf&&\r\n0120 40\r\n!!\r\n\x03\x02&&\r\n\x110120 41\r\n\x13!!\r\n\0 &&\r\n0120 42\r\n!!\x03\r\n";
        let pieces = read(&[text]);
        assert_eq!(pieces.len(), 3, "{pieces:?}");
        for (piece, expected) in pieces.iter().zip(["0120 40", "0120 41", "0120 42"]) {
            assert_eq!(lines(piece), [expected]);
        }
        let negotiated = read(&[b"\xff\xfd\x01\xff\xfb\x03&&\r\n0120 40\r\n!!\r\n"]);
        assert_eq!(discarded(&negotiated[0]), (DiscardReason::Outside, 6));
        assert_eq!(lines(&negotiated[1]), ["0120 40"]);
    }

    #[test]
    fn what_is_no_frame_is_discarded_with_its_reason_and_size() {
        let pieces = read(&[b"noise\r\n&&\r\n0120 40\r\n&&\r\n0120 41\r\n!!\r\n!!\r\n&&\r\n0120 4"]);
        assert_eq!(discarded(&pieces[0]), (DiscardReason::Outside, 7));
        assert_eq!(discarded(&pieces[1]), (DiscardReason::CutByNext, 13));
        assert_eq!(lines(&pieces[2]), ["0120 41"]);
        // The second mark of an end, and the line ends around it.
        assert_eq!(discarded(&pieces[3]), (DiscardReason::Outside, 6));
        assert_eq!(discarded(&pieces[4]), (DiscardReason::CutByEnd, 10));
    }

    #[test]
    fn lines_and_frames_without_end_use_bounded_memory() {
        let mut text = b"&&\r\n0120".to_vec();
        text.extend(vec![b'7'; 2 * LONGEST_LINE]);
        text.extend(b"\r\n0121 5\r\n!!\r\n");
        let pieces = read(&[&text]);
        let Piece::Frame(frame) = &pieces[0] else { panic!() };
        assert_eq!((frame.long_lines, frame.lines.len()), (1, 1));
        let mut endless = b"&&\r\n".to_vec();
        endless.extend(b"0120 40\r\n".repeat(LONGEST_FRAME));
        endless.extend(b"&&\r\n0120 41\r\n!!\r\n");
        let pieces = read(&[&endless]);
        assert_eq!(discarded(&pieces[0]).0, DiscardReason::LongFrame);
        assert_eq!(lines(pieces.last().unwrap()), ["0120 41"]);
    }
}
