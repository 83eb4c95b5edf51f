//! Surveys over a restart of the node: a table (CSV) under a head that says which hole they are of. Numbers are written so that
//! they are read with the same bits.

use serde::{Deserialize, Serialize};

use super::Held;
use flexdrill_config::Config;
use flexdrill_hole::Survey;

/// Names of the lines of the head, in their order.
const HEAD: [&str; 4] = ["# flexdrill surveys: ", "# well: ", "# hole: ", "# sha256: "];
const FORMAT: &str = "1";

/// The hole that surveys are of.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct OfHole {
    /// Name of the well (`run.well`); empty where it has none.
    pub well: String,
    /// SHA-256 of the hole as configured, in hex.
    pub hole: String,
}

/// SHA-256 of parts, a line each, in hex.
fn sha256(parts: &[&str]) -> String {
    let lines: String = parts.iter().map(|part| format!("{part}\n")).collect();
    flexdrill_config::sha256(lines.as_bytes())
}

impl OfHole {
    /// The hole of a configuration.
    pub fn new(config: &Config) -> Self {
        let mut well = config.well.clone();
        // Neither moves the hole.
        (well.plan, well.drilled_from) = (None, None);
        let text = serde_json::to_string(&well).unwrap_or_default();
        Self {
            well: config.run.well.clone(),
            hole: sha256(&[&text]),
        }
    }

    /// Whether surveys of this hole are surveys of another one too: of the same hole, or of another stretch of the same well.
    /// A well without a name is known by its hole alone.
    pub fn holds(&self, other: &Self) -> bool {
        self.well == other.well && (!self.well.is_empty() || self.hole == other.hole)
    }
}

/// A survey as the rig sent it, with the usual deviations where it sent none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Row {
    measured_depth_m: f64,
    inclination_rad: f64,
    inclination_sd_rad: f64,
    azimuth_rad: Option<f64>,
    azimuth_sd_rad: Option<f64>,
    stamp_ns: i64,
    source: String,
}

/// The surveys of a run, for the next one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct KeptSurveys {
    /// Their hole.
    pub of: OfHole,
    rows: Vec<Row>,
}

impl KeptSurveys {
    /// Surveys of a hole, in the order of arrival.
    pub(super) fn new<'a>(of: OfHole, held: impl Iterator<Item = &'a Held>) -> Self {
        let row = |held: &Held| Row {
            measured_depth_m: held.measured_depth,
            inclination_rad: held.survey.inclination,
            inclination_sd_rad: held.survey.inclination_deviation,
            azimuth_rad: held.survey.azimuth.map(|[azimuth, _]| azimuth),
            azimuth_sd_rad: held.survey.azimuth.map(|[_, deviation]| deviation),
            stamp_ns: held.stamp,
            source: held.source.clone(),
        };
        Self {
            of,
            rows: held.map(row).collect(),
        }
    }

    /// The surveys, with their depths below a kick-off (m).
    pub(super) fn held(&self, kick_off: f64) -> impl Iterator<Item = Held> {
        self.rows.iter().map(move |row| Held {
            survey: Survey {
                depth: row.measured_depth_m - kick_off,
                inclination: row.inclination_rad,
                inclination_deviation: row.inclination_sd_rad,
                azimuth: row.azimuth_rad.zip(row.azimuth_sd_rad).map(<[f64; 2]>::from),
            },
            measured_depth: row.measured_depth_m,
            stamp: row.stamp_ns,
            source: row.source.clone(),
            is_earlier: true,
        })
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Stamp of the newest (ns since 1970); none without surveys.
    pub fn newest(&self) -> Option<i64> {
        self.rows.iter().map(|row| row.stamp_ns).max()
    }
}

impl KeptSurveys {
    /// The bytes of their file.
    ///
    /// # Errors
    /// When there is no memory.
    pub fn encode(&self) -> std::io::Result<Vec<u8>> {
        let mut table = csv::Writer::from_writer(Vec::new());
        for row in &self.rows {
            table.serialize(row).map_err(std::io::Error::other)?;
        }
        let table = table
            .into_inner()
            .map_err(|error| std::io::Error::other(error.to_string()))?;
        let table = String::from_utf8(table).map_err(std::io::Error::other)?;
        let OfHole { well, hole } = &self.of;
        let sum = sha256(&[well, hole, &table]);
        let mut text = String::new();
        for (name, value) in HEAD.into_iter().zip([FORMAT, well, hole, &sum]) {
            text += name;
            text += value;
            text.push('\n');
        }
        text += &table;
        Ok(text.into_bytes())
    }

    /// The surveys in the bytes of a file.
    ///
    /// # Errors
    /// Why the bytes are none.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
        let mut rest = text;
        let mut line = |name: &str| {
            let (line, behind) = rest.split_once('\n')?;
            rest = behind;
            line.strip_prefix(name)
        };
        let head = HEAD.map(&mut line);
        let [Some(format), Some(well), Some(hole), Some(sum)] = head else {
            return Err("it does not begin with format, well, hole and checksum".to_owned());
        };
        if format != FORMAT {
            return Err(format!("its format is {format:.20}, and this version reads {FORMAT}"));
        }
        // A digit that has changed on the disk would be another hole.
        if sha256(&[well, hole, rest]) != sum {
            return Err("its checksum does not fit".to_owned());
        }
        let rows = csv::Reader::from_reader(rest.as_bytes()).into_deserialize();
        Ok(Self {
            of: OfHole {
                well: well.to_owned(),
                hole: hole.to_owned(),
            },
            rows: rows.collect::<Result<_, _>>().map_err(|error| error.to_string())?,
        })
    }
}
