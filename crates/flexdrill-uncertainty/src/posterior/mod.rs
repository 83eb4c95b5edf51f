//! What a calibration has found, as a sample: the file `posterior.csv`.
//!
//! The file has comment lines with its provenance, a line of names, and a row per member: its weight, and the value of each
//! key that the log determines. One file has both, so that no copy has values without their provenance, and one rename makes
//! it complete. `pandas.read_csv(file, comment="#")` and every spreadsheet read it.
//!
//! ```text
//! # flexdrill posterior: 1
//! # flexdrill: 0.3.0
//! # tool: 5a31...
//! # configuration: 771e...
//! # log: rig.csv
//! # log SHA-256: 90c4...
//! # log rows: 1 to 3600
//! # seed: 1
//! # usable: yes
//! weight,contact.inner.friction_tangential,tool.joint.friction
//! 1,0.2913,0.0871
//! ```

mod error;
mod reading;
mod sample;

use std::fmt::Write as _;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use flexdrill_config::Config;
use flexdrill_config::checker::number;
use flexdrill_config::reading::nearest;

pub use error::PosteriorError;
pub(crate) use sample::Sample;

/// Name of the file in the folder of a calibration.
pub const FILE: &str = "posterior.csv";
/// The format that this build writes and reads.
pub const FORMAT: u32 = 1;
/// Most keys: a calibration fits ten.
pub const MOST_KEYS: usize = 64;
/// Most members: as many as a calibration draws at most.
pub const MOST_MEMBERS: usize = 100_000;
/// Largest file that is read (bytes).
pub const MOST_BYTES: u64 = 64 << 20;
/// Least effective number of members: as many as a band needs.
pub const LEAST_EFFECTIVE: f64 = 8.0;
/// Name of the column of the weights.
const WEIGHT: &str = "weight";

/// Where a sample comes from.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Provenance {
    /// Version of the program that wrote it.
    pub version: String,
    /// Hash of the tool without the sample's keys ([`Config::tool_hash`]).
    pub tool: String,
    /// Hash of the configuration that was fitted.
    pub configuration: String,
    /// File name of the log.
    pub log: String,
    /// SHA-256 of the log.
    pub sha256: String,
    /// First and last row of the log that was read.
    pub rows: [u64; 2],
    /// Seed of the calibration.
    pub seed: u64,
    /// Why the calibration is not to be used; empty where it may be.
    pub objections: Vec<String>,
}

/// A weighted sample of the values of some keys of a configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Posterior {
    /// Where it comes from.
    pub provenance: Provenance,
    /// The file that it was read from, for errors.
    file: String,
    /// SHA-256 of the file.
    sha256: String,
    keys: Vec<String>,
    members: Vec<Weighted>,
}

/// A member of the sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Weighted {
    /// Its weight, at least 0; only ratios of weights matter.
    pub weight: f64,
    /// Its values, by [`Posterior::keys`], in the units of the keys.
    pub values: Vec<f64>,
    /// Line in the file.
    line: usize,
}

/// The text of a file for these rows: weight, then the values by key.
pub fn to_csv<'a>(provenance: &Provenance, keys: &[&str], rows: impl IntoIterator<Item = (f64, &'a [f64])>) -> String {
    // A name of a file or an objection may hold anything, and a comment ends with its line.
    let plain = |text: &str| text.replace(char::is_control, " ");
    let usable = match provenance.objections.is_empty() {
        true => "yes".to_owned(),
        false => format!("no: {}", plain(&provenance.objections.join("; "))),
    };
    let [first, last] = provenance.rows;
    let mut text = format!(
        "# flexdrill posterior: {FORMAT}\n# flexdrill: {}\n# tool: {}\n# configuration: {}\n# log: {}\n# log SHA-256: {}\n\
         # log rows: {first} to {last}\n# seed: {}\n# usable: {usable}\n{WEIGHT}",
        plain(&provenance.version),
        plain(&provenance.tool),
        plain(&provenance.configuration),
        plain(&provenance.log),
        plain(&provenance.sha256),
        provenance.seed
    );
    for key in keys {
        let _ = write!(text, ",{key}");
    }
    text.push('\n');
    for (weight, values) in rows {
        text.push_str(&number(weight));
        for value in values {
            // Nine digits are more than any calibration knows, and half of what the bits have.
            let rounded = format!("{value:.8e}").parse().unwrap_or(*value);
            let _ = write!(text, ",{}", number(rounded));
        }
        text.push('\n');
    }
    text
}

impl Posterior {
    /// The sample that `ensemble.from` of a configuration names, if it names one, held against that configuration. A
    /// relative path is relative to `folder`, that of the configuration.
    ///
    /// # Errors
    /// When the file cannot be read, is no sample, is another file than `ensemble.posterior_sha256` says, or does not
    /// belong to the configuration's tool.
    pub fn named_by(config: &Config, folder: &Path) -> Result<Option<Self>, PosteriorError> {
        match config.ensemble.as_ref().and_then(|ensemble| ensemble.posterior()) {
            Some(file) => Self::load(&folder.join(file), config).map(Some),
            None => Ok(None),
        }
    }

    /// Reads a file, and holds it against a configuration.
    ///
    /// # Errors
    /// As [`Posterior::named_by`].
    pub fn load(path: &Path, config: &Config) -> Result<Self, PosteriorError> {
        let mut bytes = Vec::new();
        File::open(path)
            .and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes))
            .map_err(|source| PosteriorError::Read {
                path: PathBuf::from(path),
                source,
            })?;
        let read = Self::from_csv(&path.display().to_string(), &bytes)?;
        read.belongs_to(config)?;
        Ok(read)
    }

    /// Reads the bytes of a file; `file` stands for it in errors.
    ///
    /// # Errors
    /// When they are no sample, with file and line.
    pub fn from_csv(file: &str, bytes: &[u8]) -> Result<Self, PosteriorError> {
        reading::read(file, bytes)
    }

    /// The file that it was read from.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// SHA-256 of the file, in hex.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// Its keys, by their dotted paths.
    pub fn keys(&self) -> &[String] {
        &self.keys
    }

    /// Its members.
    pub fn members(&self) -> &[Weighted] {
        &self.members
    }

    /// Number of members alike that it amounts to.
    pub fn effective_number(&self) -> f64 {
        effective_number(&self.members)
    }

    /// Holds it against a configuration: it may be used, is of the same tool, and each value is within the limits of its
    /// key.
    ///
    /// # Errors
    /// With file, line, key, value and bound of what does not hold.
    pub fn belongs_to(&self, config: &Config) -> Result<(), PosteriorError> {
        let file = || self.file.clone();
        if let Some(wanted) = config.ensemble.as_ref().and_then(|of| of.posterior_sha256.as_ref())
            && *wanted != self.sha256
        {
            return Err(PosteriorError::OtherFile {
                file: file(),
                found: self.sha256.clone(),
                wanted: wanted.clone(),
            });
        }
        if !self.provenance.objections.is_empty() {
            return Err(PosteriorError::NotToBeUsed {
                file: file(),
                why: self.provenance.objections.join("; "),
            });
        }
        // Keys come before the tool: the hash of the tool depends on which keys are known.
        let numbers = config.numbers();
        let mut limits = Vec::new();
        for key in &self.keys {
            let known = numbers.iter().find(|known| known.key == *key);
            limits.push(known.ok_or_else(|| PosteriorError::UnknownKey {
                file: file(),
                key: key.clone(),
                meant: nearest(key, numbers.iter().map(|known| known.key.as_str())).map(str::to_owned),
            })?);
        }
        let own = config.tool_hash(self.keys.iter().map(String::as_str));
        if self.provenance.tool != own {
            return Err(PosteriorError::OtherTool {
                file: file(),
                log: self.provenance.log.clone(),
                found: self.provenance.tool.clone(),
                own,
            });
        }
        for member in &self.members {
            for (limit, value) in limits.iter().zip(&member.values) {
                if !limit.bound().holds(*value) {
                    return Err(PosteriorError::Value {
                        file: file(),
                        line: member.line,
                        key: limit.key.clone(),
                        value: *value,
                        unit: limit.unit,
                        rule: format!("{} ({})", limit.bound().words(limit.unit), limit.reason),
                    });
                }
            }
        }
        Ok(())
    }
}

/// Number of members alike that weights amount to: the square of their sum over the sum of their squares.
fn effective_number(members: &[Weighted]) -> f64 {
    let most = members.iter().map(|member| member.weight).fold(0.0, f64::max);
    // Shares of the largest weight, since squares of weights may overflow.
    let shares = || members.iter().map(|member| member.weight / most);
    shares().sum::<f64>().powi(2) / shares().map(|share| share * share).sum::<f64>()
}
