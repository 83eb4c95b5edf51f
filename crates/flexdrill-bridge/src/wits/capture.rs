//! Captures: the bytes of a line as they came, with their times and connections.
//!
//! A capture is a text header line, then blocks: a line `TIME CONNECTION LENGTH` (ns since 1970), the bytes, a line end. A
//! length of 0 ends the connection. A file without the header line is read as the bytes of one connection without times.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, BufWriter, Read, Write as _};
use std::path::{Path, PathBuf};

/// The first line of a capture.
const MAGIC: &[u8] = b"flexdrill wits capture 1\n";
/// Longest block (bytes).
const LONGEST_BLOCK: usize = 1 << 20;
/// Longest line of a block's numbers (bytes).
const LONGEST_NUMBERS: u64 = 64;
/// Bytes of a file without times that are given at a time.
const RAW_BLOCK: usize = 4096;

/// Bytes of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// When they arrived (ns since 1970); `None` in a file without times.
    pub time: Option<i64>,
    /// The connection, counted from 1.
    pub connection: u64,
    /// The bytes; none where the connection ends.
    pub bytes: Vec<u8>,
}

/// A capture that cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum CaptureError {
    /// The file cannot be opened, written or read.
    #[error("{path}: {reason}")]
    File {
        /// The file.
        path: PathBuf,
        /// The reason, in words for a log.
        reason: io::Error,
    },
    /// The file is damaged from there on.
    #[error("{path}: byte {at}: {wrong}; what is before it was read")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where.
        at: u64,
        /// What is wrong.
        wrong: String,
    },
}

/// Writes a capture.
#[derive(Debug)]
pub struct CaptureWriter {
    path: PathBuf,
    file: BufWriter<File>,
}

impl CaptureWriter {
    /// Creates the file; an existing one is not overwritten.
    ///
    /// # Errors
    /// When the file exists or cannot be written.
    pub fn create(path: &Path) -> Result<Self, CaptureError> {
        let file = File::create_new(path).map_err(|reason| failed(path, reason))?;
        let mut writer = Self {
            path: path.to_owned(),
            file: BufWriter::new(file),
        };
        writer.file.write_all(MAGIC).map_err(|reason| failed(path, reason))?;
        Ok(writer)
    }

    /// Writes bytes that arrived at `time` (ns since 1970); none end the connection. They are in the file when this returns.
    ///
    /// # Errors
    /// When the disk refuses the write.
    pub fn write(&mut self, time: i64, connection: u64, bytes: &[u8]) -> Result<(), CaptureError> {
        let mut write = || {
            writeln!(self.file, "{time} {connection} {}", bytes.len())?;
            if !bytes.is_empty() {
                self.file.write_all(bytes)?;
                self.file.write_all(b"\n")?;
            }
            self.file.flush()
        };
        write().map_err(|reason| failed(&self.path, reason))
    }
}

fn failed(path: &Path, reason: io::Error) -> CaptureError {
    CaptureError::File {
        path: path.to_owned(),
        reason,
    }
}

/// Reads a capture block by block.
#[derive(Debug)]
pub struct CaptureReader {
    path: PathBuf,
    file: BufReader<File>,
    timed: bool,
    at: u64,
    ended: bool,
}

impl CaptureReader {
    /// Opens a capture, or a file with the bytes of a line alone.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn open(path: &Path) -> Result<Self, CaptureError> {
        let file = File::open(path).map_err(|reason| failed(path, reason))?;
        let mut file = BufReader::new(file);
        let begin = file.fill_buf().map_err(|reason| failed(path, reason))?;
        let timed = begin.starts_with(MAGIC);
        let at = if timed { MAGIC.len() } else { 0 };
        file.consume(at);
        Ok(Self {
            path: path.to_owned(),
            file,
            timed,
            at: at as u64,
            ended: false,
        })
    }

    /// Whether the blocks have times.
    pub fn is_timed(&self) -> bool {
        self.timed
    }

    fn damaged(&self, wrong: impl Into<String>) -> CaptureError {
        CaptureError::Damaged {
            path: self.path.clone(),
            at: self.at,
            wrong: wrong.into(),
        }
    }

    /// Reads exactly `length` bytes, without asking for memory before they are there.
    fn take(&mut self, length: usize) -> Result<Vec<u8>, CaptureError> {
        let mut bytes = Vec::new();
        let read = (&mut self.file).take(length as u64).read_to_end(&mut bytes);
        read.map_err(|reason| failed(&self.path, reason))?;
        self.at += bytes.len() as u64;
        if bytes.len() < length {
            return Err(self.damaged(format!("{length} bytes are announced and {} follow", bytes.len())));
        }
        Ok(bytes)
    }

    fn timed_block(&mut self) -> Result<Option<Block>, CaptureError> {
        let mut numbers = Vec::new();
        let read = (&mut self.file).take(LONGEST_NUMBERS).read_until(b'\n', &mut numbers);
        if read.map_err(|reason| failed(&self.path, reason))? == 0 {
            return Ok(None);
        }
        let parsed = (|| {
            let mut parts = str::from_utf8(numbers.strip_suffix(b"\n")?).ok()?.split(' ');
            let block = (
                parts.next()?.parse().ok()?,
                parts.next()?.parse().ok()?,
                parts.next()?.parse().ok()?,
            );
            parts.next().is_none().then_some(block)
        })();
        let Some((time, connection, length)) = parsed else {
            return Err(self.damaged("no line of time, connection and length"));
        };
        if length > LONGEST_BLOCK {
            return Err(self.damaged(format!(
                "a block of {length} bytes; at most {LONGEST_BLOCK} are written"
            )));
        }
        self.at += numbers.len() as u64;
        let bytes = self.take(length)?;
        if length > 0 && self.take(1)? != b"\n" {
            return Err(self.damaged("the block does not end where its length says"));
        }
        Ok(Some(Block {
            time: Some(time),
            connection,
            bytes,
        }))
    }

    fn raw_block(&mut self) -> Result<Option<Block>, CaptureError> {
        let mut bytes = vec![0; RAW_BLOCK];
        let read = self
            .file
            .read(&mut bytes)
            .map_err(|reason| failed(&self.path, reason))?;
        bytes.truncate(read);
        self.at += read as u64;
        Ok((read > 0).then_some(Block {
            time: None,
            connection: 1,
            bytes,
        }))
    }
}

impl Iterator for CaptureReader {
    type Item = Result<Block, CaptureError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        let next = if self.timed {
            self.timed_block()
        } else {
            self.raw_block()
        };
        self.ended = !matches!(next, Ok(Some(_)));
        next.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capture_gives_the_bytes_as_they_came() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("line.wits");
        let mut writer = CaptureWriter::create(&path).unwrap();
        let written = [
            (5, 1, b"&&\r\n0120 40".as_slice()),
            (7, 2, b"\n3 1 5\n".as_slice()),
            (9, 1, b"".as_slice()),
        ];
        for (time, connection, bytes) in written {
            writer.write(time, connection, bytes).unwrap();
        }
        assert!(CaptureWriter::create(&path).is_err(), "a capture is not overwritten");
        let read: Vec<_> = CaptureReader::open(&path).unwrap().map(Result::unwrap).collect();
        let expected = written.map(|(time, connection, bytes)| Block {
            time: Some(time),
            connection,
            bytes: bytes.to_vec(),
        });
        assert_eq!(read, expected);
        // Cut anywhere, it gives whole blocks and then says where it ends.
        let whole = std::fs::read(&path).unwrap();
        for end in MAGIC.len()..whole.len() {
            std::fs::write(&path, &whole[..end]).unwrap();
            let read: Vec<_> = CaptureReader::open(&path).unwrap().collect();
            let good = read.iter().take_while(|block| block.is_ok()).count();
            assert!(read.len() - good <= 1 && good < written.len());
            for (block, expected) in read.iter().flatten().zip(&expected) {
                assert_eq!(block, expected);
            }
        }
    }

    #[test]
    fn bytes_alone_are_one_connection_without_times() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("raw.txt");
        let bytes = b"&&\r\n0120 40\r\n!!\r\n".repeat(1000);
        std::fs::write(&path, &bytes).unwrap();
        let reader = CaptureReader::open(&path).unwrap();
        assert!(!reader.is_timed());
        let read: Vec<u8> = reader.flat_map(|block| block.unwrap().bytes).collect();
        assert_eq!(read, bytes);
    }

    #[test]
    fn a_length_that_lies_asks_for_no_memory() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lie.wits");
        for numbers in [
            "1 1 1000000\nx\n",
            "1 1 99999999999999999999\n",
            "1 1\n",
            "a b c\n",
            "1 1 2\nabc\n",
        ] {
            std::fs::write(&path, [MAGIC, numbers.as_bytes()].concat()).unwrap();
            let mut reader = CaptureReader::open(&path).unwrap();
            let error = reader.next().unwrap().unwrap_err().to_string();
            assert!(error.contains("byte"), "{error}");
            assert!(reader.next().is_none());
        }
    }
}
