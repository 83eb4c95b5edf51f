//! The number of the last pair of birth and death of a Sparkplug node, which the next start of the bridge continues: a
//! small file. With a number that began again, a death certificate that arrives late would end the new session.

use std::io::ErrorKind;
use std::path::Path;

use crate::state_file::{plain, replace_shared};

/// Most bytes of a name in a file's name; file systems allow 255.
const LONGEST_NAME: usize = 200;

/// Why a number cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum NumberError {
    /// The file exists and cannot be read.
    #[error("{file}: the number of the last Sparkplug session cannot be read: {source}; the numbers begin again at 0")]
    Read {
        /// The file.
        file: String,
        /// The cause.
        source: std::io::Error,
    },
    /// The file has another content.
    #[error(
        "{file}: damaged: it has no number from 0 to 255 of the last Sparkplug session; the numbers begin again at 0"
    )]
    Damaged {
        /// The file.
        file: String,
    },
}

/// The name of the file of a node (`GROUP/NODE`).
pub fn file_name(node: &str) -> String {
    let parts: Vec<String> = node.split('/').map(|part| plain(part, b"-_")).collect();
    let mut name = format!("sparkplug_{}", parts.join("."));
    name.truncate(LONGEST_NAME);
    name + ".bdseq"
}

/// Reads a number; none without a file.
///
/// # Errors
/// When the file cannot be read or has another content.
pub fn read(path: &Path) -> Result<Option<u8>, NumberError> {
    let file = || path.display().to_string();
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(NumberError::Read { file: file(), source }),
    };
    let number = std::str::from_utf8(&bytes)
        .ok()
        .and_then(|text| text.trim().parse().ok());
    number.map(Some).ok_or_else(|| NumberError::Damaged { file: file() })
}

/// Writes a number next to the old one and replaces the old one with it, so that one of the two is complete at any time.
///
/// # Errors
/// When the disk refuses the write.
pub fn write(path: &Path, number: u8) -> std::io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    // Two bridges of one node may write it.
    replace_shared(path, format!("{number}\n").as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_read_as_it_was_written_and_a_damaged_file_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep").join(file_name("field/rig_7"));
        assert!(path.ends_with("sparkplug_field.rig_7.bdseq"));
        assert_eq!(read(&path).unwrap(), None);
        for number in [0, 7, 255] {
            write(&path, number).unwrap();
            assert_eq!(read(&path).unwrap(), Some(number));
        }
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
        for content in [&b""[..], b"256", b"\xff\xfe", b"7 8", b"-1"] {
            std::fs::write(&path, content).unwrap();
            let error = read(&path).unwrap_err().to_string();
            assert!(error.contains("damaged") && error.contains("rig_7"), "{error}");
        }
        std::fs::remove_file(&path).unwrap();
        std::fs::create_dir(&path).unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("cannot be read"));
        assert!(write(&path, 1).is_err());
    }

    #[test]
    fn names_of_nodes_are_names_of_files() {
        assert_eq!(file_name("a.b/c"), "sparkplug_a%2eb.c.bdseq");
        assert_eq!(file_name("a/b.c"), "sparkplug_a.b%2ec.bdseq");
        assert_eq!(file_name("../ö"), "sparkplug_%2e%2e.%c3%b6.bdseq");
        assert!(file_name(&"x".repeat(300)).len() < 255);
    }
}
