//! The table of `flexdrill sensitivity`: what each prior moves, one at a time.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use flexdrill_config::checker::number;
use serde::{Deserialize, Serialize};

/// The format that this build writes and reads.
pub const FORMAT: u32 = 1;
/// Name of the file in the folder of the results.
pub const FILE: &str = "sensitivity.json";
/// Largest file that is read (bytes): one of 200 keys has a twentieth of it.
const MOST_BYTES: u64 = 4 << 20;

/// What each prior moves, one at a time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Effects {
    /// [`FORMAT`].
    pub format: u32,
    /// The program that computed it, with its version.
    pub program: String,
    /// Hash of the configuration, priors included.
    pub configuration: String,
    /// Rotary speed of all runs, as the rig shows it (r/min).
    pub rotary_speed_rpm: f64,
    /// Weight on bit of all runs, as the rig shows it (kN).
    pub weight_on_bit_kn: f64,
    /// Model time of each run (s); the second half is measured.
    pub seconds: f64,
    /// What is measured.
    pub outputs: Vec<Output>,
    /// The runs, two per prior, in the order of the configuration.
    pub rows: Vec<Row>,
}

/// A quantity that is measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Empty if dimensionless.
    pub unit: String,
    /// Its value with all keys as configured; none where that run failed or the tool has no such quantity.
    pub nominal: Option<f64>,
    /// Largest distance from it of runs that differ by 1 N of weight: a smaller change says nothing.
    pub scatter: Option<f64>,
}

/// A run with one prior at one of its ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The key that the prior is named after, or the sensor with the part of its error.
    pub key: String,
    /// Share of the prior below the value.
    pub quantile: f64,
    /// Value of the key.
    pub value: f64,
    /// Of the value; empty if dimensionless.
    pub unit: String,
    /// The measured quantities, by [`Effects::outputs`].
    pub results: Vec<Option<f64>>,
    /// Why there are none; empty where there are.
    pub cause: String,
}

/// What a prior moves most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest<'a> {
    /// The quantity.
    pub output: &'a Output,
    /// Its changes at both ends of the prior; none where a run failed.
    pub changes: [Option<f64>; 2],
}

/// Why a table is not read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EffectsError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// It is no table of this build.
    #[error("{}: no table of `flexdrill sensitivity`: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

impl Effects {
    /// Reads the table in a folder; none where there is none.
    ///
    /// # Errors
    /// When the file cannot be read, or is no table.
    pub fn load(folder: &Path) -> Result<Option<Self>, EffectsError> {
        let path = folder.join(FILE);
        let mut bytes = Vec::new();
        let read = File::open(&path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes));
        match read {
            Ok(_) => {}
            Err(source) if source.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(EffectsError::Read { path, source }),
        }
        Self::from_json(&bytes)
            .map(Some)
            .map_err(|reason| EffectsError::Damaged { path, reason })
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn from_json(bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() as u64 > MOST_BYTES {
            return Err(format!("larger than {MOST_BYTES} bytes"));
        }
        let read: Self = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
        if read.format != FORMAT {
            return Err(format!("format {}: must be {FORMAT}", read.format));
        }
        let holed = read.rows.iter().find(|row| row.results.len() != read.outputs.len());
        if let Some(row) = holed {
            let (found, wanted) = (row.results.len(), read.outputs.len());
            return Err(format!(
                "{} has {found} results: must be {wanted}, one per output",
                row.key
            ));
        }
        Ok(read)
    }

    /// As a file has it.
    ///
    /// # Errors
    /// When the serialiser fails, which it does not.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }

    /// The keys of the priors, each once, in the order of the rows.
    pub fn keys(&self) -> Vec<&str> {
        let mut keys: Vec<&str> = self.rows.iter().map(|row| row.key.as_str()).collect();
        keys.dedup();
        keys
    }

    /// The change of a quantity in a run against the configured values.
    pub fn change(&self, row: &Row, output: usize) -> Option<f64> {
        let nominal = self.outputs.get(output)?.nominal?;
        Some((*row.results.get(output)?)? - nominal)
    }

    /// The changes of a quantity at both ends of a prior.
    pub fn changes(&self, key: &str, output: usize) -> [Option<f64>; 2] {
        let mut rows = self.rows.iter().filter(|row| row.key == key);
        [rows.next(), rows.next()].map(|row| self.change(row?, output))
    }

    /// The larger of both changes beyond the scatter of equal runs; none where neither is.
    fn beyond(&self, key: &str, output: usize) -> Option<f64> {
        let scatter = self.outputs.get(output)?.scatter.unwrap_or(0.0);
        let changes = self.changes(key, output).into_iter().flatten().map(f64::abs);
        changes.filter(|change| *change > scatter).reduce(f64::max)
    }

    /// What a prior moves most, by the share of the largest change that any prior brings to the quantity; none where it
    /// moves nothing beyond the scatter of equal runs.
    pub fn largest(&self, key: &str) -> Option<Largest<'_>> {
        let keys = self.keys();
        let share = |output: usize| {
            let own = self.beyond(key, output)?;
            let most = keys
                .iter()
                .filter_map(|key| self.beyond(key, output))
                .fold(0.0, f64::max);
            Some((own / most, output))
        };
        let shares = (0..self.outputs.len()).filter_map(share);
        let (_, output) = shares.reduce(|best, other| if other.0 > best.0 { other } else { best })?;
        Some(Largest {
            output: self.outputs.get(output)?,
            changes: self.changes(key, output),
        })
    }

    /// The same in words.
    pub fn largest_in_words(&self, key: &str) -> String {
        let Some(Largest { output, changes }) = self.largest(key) else {
            return "nothing beyond the scatter of equal runs".to_owned();
        };
        let [low, high] = changes.map(|change| change.map_or_else(|| "unknown".to_owned(), three_digits));
        let space = if output.unit.is_empty() { "" } else { " " };
        format!("{} {low} to {high}{space}{}", output.name, output.unit)
    }

    /// The keys that move a quantity, the largest change first, without those that move it by less than the scatter.
    pub fn ranked(&self, output: usize) -> Vec<&str> {
        let moves = |key| Some((self.beyond(key, output)?, key));
        let mut moving: Vec<(f64, &str)> = self.keys().into_iter().filter_map(moves).collect();
        moving.sort_by(|a, b| b.0.total_cmp(&a.0));
        moving.into_iter().map(|(_, key)| key).collect()
    }
}

/// A change with its sign, in three digits: chaotic motion has no more.
fn three_digits(value: f64) -> String {
    let rounded = format!("{value:.2e}").parse().unwrap_or(value);
    let sign = if rounded >= 0.0 { "+" } else { "" };
    format!("{sign}{}", number(rounded))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn effects() -> Effects {
        let output = |name: &str, nominal, scatter| Output {
            name: name.to_owned(),
            unit: "N".to_owned(),
            nominal,
            scatter,
        };
        let row = |key: &str, quantile, results: [Option<f64>; 2]| Row {
            key: key.to_owned(),
            quantile,
            value: 1.0,
            unit: String::new(),
            results: results.to_vec(),
            cause: String::new(),
        };
        Effects {
            format: FORMAT,
            program: "flexdrill".to_owned(),
            configuration: String::new(),
            rotary_speed_rpm: 40.0,
            weight_on_bit_kn: 10.0,
            seconds: 40.0,
            outputs: vec![output("a", Some(10.0), Some(1.0)), output("b", Some(1000.0), Some(1.0))],
            rows: vec![
                row("x", 0.05, [Some(8.0), Some(1002.0)]),
                row("x", 0.95, [Some(14.0), None]),
                row("y", 0.05, [Some(10.5), Some(900.0)]),
                row("y", 0.95, [Some(9.5), Some(1100.0)]),
                row("z", 0.05, [Some(10.5), Some(1000.0)]),
                row("z", 0.95, [None, None]),
            ],
        }
    }

    #[test]
    fn the_largest_effect_is_a_share_of_what_others_bring() {
        let effects = effects();
        assert_eq!(effects.keys(), ["x", "y", "z"]);
        let largest = |key| effects.largest(key).map(|of| (of.output.name.as_str(), of.changes));
        assert_eq!(largest("x"), Some(("a", [Some(-2.0), Some(4.0)])));
        assert_eq!(largest("y"), Some(("b", [Some(-100.0), Some(100.0)])));
        assert_eq!(largest("z"), None);
        assert_eq!(effects.largest_in_words("x"), "a -2 to +4 N");
        assert_eq!(
            effects.largest_in_words("z"),
            "nothing beyond the scatter of equal runs"
        );
        assert_eq!((effects.ranked(0), effects.ranked(1)), (vec!["x"], vec!["y", "x"]));
    }

    #[test]
    fn a_file_reads_back_and_another_is_refused() {
        let effects = effects();
        let text = effects.to_json().unwrap();
        assert_eq!(Effects::from_json(text.as_bytes()), Ok(effects));
        for (from, to, why) in [
            ("\"format\": 1", "\"format\": 2", "format 2: must be 1"),
            ("10.5,", "10.5, 3.0,", "has 3 results: must be 2"),
            ("\"seconds\"", "\"second\"", "unknown field"),
        ] {
            let changed = text.replacen(from, to, 1);
            let error = Effects::from_json(changed.as_bytes()).unwrap_err();
            assert!(error.contains(why), "{error}");
        }
        let folder = std::env::temp_dir().join(format!("flexdrill_no_effects_{}", std::process::id()));
        assert!(Effects::load(&folder).unwrap().is_none());
    }
}
