//! Whether a person has compared what a mapping makes of a source with the rig's display: a small file per mapping and
//! source, and a line in a journal. A mapping that was changed has another file, so that it counts as not compared.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};

use crate::state_file::{plain, replace_shared};
use flexdrill_text::{date_time, printable};

/// Digits of the hash that people see and that a file's name has: enough that two mappings of a site never share them.
const HASH: usize = 16;
/// Most bytes of a source in a file's name; file systems allow 255.
const LONGEST_SOURCE: usize = 150;
/// Most bytes of a confirmation; what is longer is none of ours.
const LONGEST_FILE: u64 = 8 << 10;
/// What was confirmed, when and by whom; lines are added only.
const JOURNAL: &str = "wits_mappings.journal";

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

    /// The mapping as people compare it: the first digits of its hash.
    pub fn short_hash(&self) -> &str {
        self.hash.get(..HASH).unwrap_or(&self.hash)
    }

    /// The mapping's name for people.
    pub fn mapping(&self) -> &str {
        &self.mapping
    }

    /// When and by whom the mapping was confirmed for a source; none where it was not.
    ///
    /// # Errors
    /// When its file is there and cannot be read, or is of another mapping or source. It counts as not confirmed then.
    pub fn of(&self, source: &str) -> Result<Option<String>, String> {
        let Some(path) = self.file(source) else {
            return Ok(None);
        };
        let why = |why: &dyn std::fmt::Display| {
            format!(
                "{}: {why}; the mapping counts as not confirmed, and confirming it writes the file again",
                path.display()
            )
        };
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(why(&error)),
        };
        let mut text = String::new();
        file.take(LONGEST_FILE)
            .read_to_string(&mut text)
            .map_err(|error| why(&error))?;
        // A file that was cut lacks the end of its last line.
        let confirmed = text
            .strip_prefix(&self.head(source))
            .and_then(|rest| rest.strip_prefix("confirmed "))
            .and_then(|rest| rest.strip_suffix('\n'))
            .filter(|when| !when.is_empty() && !when.contains('\n'));
        match confirmed {
            Some(when) => Ok(Some(printable(when).into_owned())),
            None => Err(why(&"damaged, or of another mapping or source")),
        }
    }

    /// Keeps that `by` has confirmed the mapping for a source at `now` (ns since 1970). Returns the file, and when and by whom
    /// as [`Confirmations::of`] has it.
    ///
    /// # Errors
    /// When there is no folder, or the disk refuses the journal or the file.
    pub fn add(&self, source: &str, by: &str, now: i64) -> Result<PathBuf, String> {
        let none = "there is no home folder for it; --state-dir names a folder, and the confirmation holds until the \
                    bridge ends";
        let file = self.file(source).ok_or(none)?;
        let failed = |path: &Path, error: std::io::Error| {
            format!(
                "{}: {error}; --state-dir names another folder, and the confirmation holds until the bridge ends",
                path.display()
            )
        };
        let folder = file.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
        // The journal first: no confirmation is kept that it does not have.
        let when = Self::words(by, now);
        let entry = format!(
            "{when}: mapping {} ({}) for {}\n",
            self.short_hash(),
            printable(&self.mapping),
            printable(source)
        );
        let journal = folder.join(JOURNAL);
        append(&journal, &entry).map_err(|error| failed(&journal, error))?;
        let text = format!("{}confirmed {when}\n", self.head(source));
        // Complete or absent, also when the power fails; two bridges may write it.
        replace_shared(&file, text.as_bytes()).map_err(|error| failed(&file, error))?;
        Ok(file)
    }

    /// When and by whom, on one line.
    pub fn words(by: &str, now: i64) -> String {
        format!("{} by {}", date_time(now), printable(by))
    }

    /// The first lines of a confirmation. The mapping's name is not among them: a file may be named in several ways.
    fn head(&self, source: &str) -> String {
        format!("mapping {}\nsource {}\n", self.hash, printable(source))
    }

    /// The file of a source.
    fn file(&self, source: &str) -> Option<PathBuf> {
        let mut plain = plain(source, b"-_.");
        // The head in the file distinguishes two long names that begin alike.
        plain.truncate(LONGEST_SOURCE);
        let name = format!("wits_mapping_{}_{plain}.confirmed", self.short_hash());
        Some(self.folder.as_ref()?.join(name))
    }
}

/// Adds a line to a file in one write, so that lines of two bridges do not mix.
fn append(file: &Path, line: &str) -> std::io::Result<()> {
    let mut journal = OpenOptions::new().create(true).append(true).open(file)?;
    journal.write_all(line.as_bytes())?;
    journal.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn site(folder: &Path, content: &[u8]) -> Confirmations {
        Confirmations::new(Some(folder.to_owned()), content, "site.yaml".to_owned())
    }

    #[test]
    fn a_confirmation_is_of_one_mapping_and_one_source() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("deep");
        let first = site(&deep, b"items: {}");
        assert_eq!(first.of("10.0.0.7"), Ok(None));
        let file = first.add("10.0.0.7", "ann", 1_700_000_000_000_000_000).unwrap();
        // 1.7e9 s after 1970, by `date -u -d @1700000000`.
        let when = Ok(Some("2023-11-14 22:13:20 UTC by ann".to_owned()));
        assert_eq!(first.of("10.0.0.7"), when);
        // The same content under another name of the file is the same mapping.
        let again = Confirmations::new(Some(deep.clone()), b"items: {}", "./site.yaml".to_owned());
        assert_eq!(again.of("10.0.0.7"), when);
        // A changed mapping, and another source.
        assert_eq!(site(&deep, b"items: {} ").of("10.0.0.7"), Ok(None));
        for other in ["10.0.0.70", "10.0.0", "/dev/ttyS0", "../10.0.0.7", ""] {
            assert_eq!(first.of(other), Ok(None), "{other}");
        }
        // Nothing but the confirmation and the journal is in the folder.
        assert_eq!(std::fs::read_dir(&deep).unwrap().count(), 2);
        let journal = std::fs::read_to_string(deep.join(JOURNAL)).unwrap();
        let hash = first.short_hash();
        assert_eq!(
            journal,
            format!("2023-11-14 22:13:20 UTC by ann: mapping {hash} (site.yaml) for 10.0.0.7\n")
        );
        assert!(file.to_string_lossy().contains(hash));
    }

    #[test]
    fn a_damaged_file_is_no_confirmation_and_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let first = site(folder.path(), b"items: {}");
        let file = first.add("10.0.0.7", "ann", 0).unwrap();
        let whole = std::fs::read(&file).unwrap();
        // Cut anywhere, with other bytes, of another mapping, with more lines, or endless.
        let mut damaged: Vec<Vec<u8>> = (0..whole.len()).map(|bytes| whole[..bytes].to_vec()).collect();
        damaged.push(b"\xff\xfe".to_vec());
        damaged.push([&whole[..], b"more\n"].concat());
        damaged.push(vec![b'x'; 1 << 20]);
        let of_another = site(folder.path(), b"other").add("10.0.0.7", "ann", 0).unwrap();
        damaged.push(std::fs::read(of_another).unwrap());
        for content in damaged {
            std::fs::write(&file, &content).unwrap();
            let error = first.of("10.0.0.7").unwrap_err();
            assert!(
                error.contains("counts as not confirmed") && error.contains("10.0.0.7"),
                "{error}"
            );
        }
        // A folder in its place.
        std::fs::remove_file(&file).unwrap();
        std::fs::create_dir(&file).unwrap();
        assert!(first.of("10.0.0.7").is_err());
        assert!(first.add("10.0.0.7", "ann", 0).unwrap_err().contains("--state-dir"));
        // Confirming again writes a damaged file again.
        std::fs::remove_dir(&file).unwrap();
        std::fs::write(&file, "x").unwrap();
        first.add("10.0.0.7", "ann", 0).unwrap();
        assert!(first.of("10.0.0.7").unwrap().is_some());
    }

    #[test]
    fn without_a_folder_nothing_is_confirmed_and_the_error_says_what_to_do() {
        let none = Confirmations::new(None, b"", "default".to_owned());
        assert_eq!(none.of("a"), Ok(None));
        assert!(none.add("a", "ann", 0).unwrap_err().contains("--state-dir"));
        let folder = tempfile::tempdir().unwrap();
        let blocked = folder.path().join("file");
        std::fs::write(&blocked, "").unwrap();
        let blocked = site(&blocked, b"");
        assert!(blocked.add("a", "ann", 0).unwrap_err().contains("--state-dir"));
    }

    #[test]
    fn sources_and_operators_are_text_of_one_line() {
        let folder = tempfile::tempdir().unwrap();
        let first = site(folder.path(), b"");
        let long = "x".repeat(400);
        for source in ["/dev/serial/by-id/x", "..", "rig:5555", "::1", &long, "a\nb", "ö"] {
            let file = first.add(source, "a\nconfirmed never", 0).unwrap();
            assert_eq!(file.parent(), Some(folder.path()), "{source}");
            assert!(first.of(source).unwrap().is_some(), "{source}");
        }
        // Two long names that begin alike: the second is not confirmed by the first.
        assert!(first.of(&format!("{long}y")).is_err());
    }
}
