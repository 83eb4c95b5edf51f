//! Whether a person has compared what a mapping makes of a source with the rig's display: a small file per mapping and
//! source. A mapping that was changed has another file, so that it counts as not compared.

use std::fs::File;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use flexdrill_text::{date_time, printable};

/// Digits of the hash in a file's name: enough that two mappings of a site never share one.
const HASH: usize = 16;
/// Most bytes of a source in a file's name; file systems allow 255.
const LONGEST_SOURCE: usize = 150;

/// The confirmations of one mapping.
#[derive(Debug, Clone)]
pub struct Confirmations {
    /// Where they are kept; `None` where there is no folder for them.
    folder: Option<PathBuf>,
    /// SHA-256 of the mapping, in hex.
    hash: String,
    /// The mapping for people.
    mapping: String,
}

impl Confirmations {
    /// Of a mapping with this content, which people know as `mapping`.
    pub fn new(folder: Option<PathBuf>, content: &[u8], mapping: String) -> Self {
        Self {
            folder,
            hash: flexdrill_config::sha256(content),
            mapping,
        }
    }

    /// Whether the mapping is confirmed for a source: an address without its port, or a device.
    ///
    /// # Errors
    /// When its file is there and cannot be read, or is of another mapping or source. It counts as not confirmed then.
    pub fn has(&self, source: &str) -> Result<bool, String> {
        let Some(file) = self.file(source) else {
            return Ok(false);
        };
        let text = match std::fs::read_to_string(&file) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
            Err(error) => {
                return Err(format!(
                    "{}: {error}; the mapping counts as not confirmed",
                    file.display()
                ));
            }
        };
        if text.starts_with(&self.head(source)) {
            return Ok(true);
        }
        Err(format!(
            "{}: damaged, or of another mapping or source; the mapping counts as not confirmed",
            file.display()
        ))
    }

    /// Keeps that a person has confirmed the mapping for a source at `now` (ns since 1970).
    ///
    /// # Errors
    /// When there is no folder, or the disk refuses the file.
    pub fn add(&self, source: &str, now: i64) -> Result<PathBuf, String> {
        let file = self.file(source).ok_or(
            "there is no home folder for it; --state-dir names a folder, and the confirmation holds until the bridge ends",
        )?;
        let text = format!("{}confirmed {}\n", self.head(source), date_time(now));
        write(&file, &text).map_err(|error| {
            format!(
                "{}: {error}; --state-dir names another folder, and the confirmation holds until the bridge ends",
                file.display()
            )
        })?;
        Ok(file)
    }

    /// The first lines of a confirmation.
    fn head(&self, source: &str) -> String {
        format!(
            "mapping {} {}\nsource {}\n",
            self.hash,
            printable(&self.mapping),
            printable(source)
        )
    }

    /// The file of a source.
    fn file(&self, source: &str) -> Option<PathBuf> {
        let mut name = String::from("wits_mapping_");
        name.push_str(self.hash.get(..HASH).unwrap_or(&self.hash));
        name.push('_');
        let mut plain = String::new();
        for byte in source.bytes() {
            match byte {
                b'-' | b'_' | b'.' => plain.push(char::from(byte)),
                byte if byte.is_ascii_alphanumeric() => plain.push(char::from(byte)),
                byte => plain.push_str(&format!("%{byte:02x}")),
            }
        }
        // The head in the file tells two long names apart that begin alike.
        plain.truncate(LONGEST_SOURCE);
        name.push_str(&plain);
        name.push_str(".confirmed");
        Some(self.folder.as_ref()?.join(name))
    }
}

/// Writes a file next to its place and moves it there, so that it is complete or absent.
fn write(file: &Path, text: &str) -> std::io::Result<()> {
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let fresh = file.with_extension(format!("confirmed.{}", std::process::id()));
    let mut written = File::create(&fresh)?;
    written.write_all(text.as_bytes())?;
    written.sync_all()?;
    std::fs::rename(&fresh, file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_confirmation_is_of_one_mapping_and_one_source() {
        let folder = tempfile::tempdir().unwrap();
        let of = |content: &[u8]| Confirmations::new(Some(folder.path().join("deep")), content, "site.yaml".to_owned());
        let site = of(b"items: {}");
        assert_eq!(site.has("10.0.0.7"), Ok(false));
        let file = site.add("10.0.0.7", 0).unwrap();
        assert_eq!(site.has("10.0.0.7"), Ok(true));
        assert_eq!(of(b"items: {}").has("10.0.0.7"), Ok(true));
        // A changed mapping, and another source.
        assert_eq!(of(b"items: {} ").has("10.0.0.7"), Ok(false));
        for other in ["10.0.0.70", "10.0.0", "/dev/ttyS0", "../10.0.0.7", ""] {
            assert_eq!(site.has(other), Ok(false), "{other}");
        }
        // A file with another content is no confirmation, and is named.
        for content in ["", "mapping x\n", "mapping"] {
            std::fs::write(&file, content).unwrap();
            assert!(site.has("10.0.0.7").unwrap_err().contains("damaged"));
        }
    }

    #[test]
    fn without_a_folder_nothing_is_confirmed_and_the_error_says_what_to_do() {
        let none = Confirmations::new(None, b"", "default".to_owned());
        assert_eq!(none.has("a"), Ok(false));
        assert!(none.add("a", 0).unwrap_err().contains("--state-dir"));
        let folder = tempfile::tempdir().unwrap();
        let blocked = folder.path().join("file");
        std::fs::write(&blocked, "").unwrap();
        let blocked = Confirmations::new(Some(blocked), b"", "default".to_owned());
        assert!(blocked.add("a", 0).unwrap_err().contains("--state-dir"));
    }

    #[test]
    fn sources_are_names_of_files() {
        let folder = tempfile::tempdir().unwrap();
        let site = Confirmations::new(Some(folder.path().to_path_buf()), b"", "site.yaml".to_owned());
        for source in [
            "/dev/serial/by-id/x",
            "..",
            "rig:5555",
            "::1",
            &"x".repeat(400),
            "a\nb",
            "ö",
        ] {
            let file = site.add(source, 0).unwrap();
            assert_eq!(file.parent(), Some(folder.path()), "{source}");
            assert_eq!(site.has(source), Ok(true), "{source}");
        }
        // Two long names that begin alike: the second is not confirmed by the first.
        let long = "x".repeat(400);
        assert!(site.has(&format!("{long}y")).is_err());
    }
}
