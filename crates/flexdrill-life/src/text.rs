//! The table as text: a heading of comment lines, names, and a row per joint and run.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use flexdrill_motion::Detail;

use super::{Kind, LifeError, Lives, MOST_BYTES, Row};

/// The format that this build writes and reads.
const FORMAT: u32 = 1;
/// Name of the first line.
const FIRST: &str = "flexdrill life";
/// Names of the columns. Damages are medians; the band follows from the heading.
const COLUMNS: &str = "serial_number,start_ns,end_ns,configuration,place_from_bit,hours,stop_damage,link_damage";

/// A number as it stands in the table; reads back to the bit.
pub(crate) fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        ..1e-3 => format!("{value:e}"),
        _ => format!("{value}"),
    }
}

/// With nine digits.
pub(crate) fn rounded(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

impl Lives {
    /// The text of the file.
    pub fn to_csv(&self) -> String {
        let mut text = format!("# {FIRST}: {FORMAT}\n");
        for (name, value) in self.kind.lines() {
            let _ = writeln!(text, "# {name}: {value}");
        }
        text.push_str(COLUMNS);
        text.push('\n');
        for row in &self.rows {
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{}",
                row.serial,
                row.start,
                row.end,
                row.configuration,
                row.place,
                number(row.hours),
                number(row.stop),
                number(row.link)
            );
        }
        text
    }

    /// Reads the bytes of a file; `file` stands for it in errors.
    ///
    /// # Errors
    /// When they are no table of lives, with file and line.
    pub fn from_csv(file: &str, bytes: &[u8]) -> Result<Self, LifeError> {
        let wrong = |line: usize, reason: String| LifeError::Line {
            file: file.to_owned(),
            line,
            reason,
        };
        if bytes.len() as u64 > MOST_BYTES {
            return Err(wrong(
                1,
                format!("larger than {MOST_BYTES} bytes: no table of lives is that large"),
            ));
        }
        let text = std::str::from_utf8(bytes).map_err(|_| wrong(1, "must be text in UTF-8".to_owned()))?;
        // Spreadsheets write a mark of the byte order before the text.
        let text = text.trim_start_matches('\u{feff}');
        let (mut heading, mut rows, mut named, mut last) = (Heading::default(), Vec::new(), false, 1);
        for (index, line) in text.lines().enumerate() {
            last = index + 1;
            // A spreadsheet fills short lines with commas, puts them in quotes, and doubles quotes within.
            let plain = line.trim_matches([' ', ',', '\r']);
            match (named, plain.trim_start_matches('"').strip_prefix('#')) {
                _ if plain.is_empty() => {}
                (false, Some(said)) => {
                    let quoted = plain.starts_with('"');
                    heading.take(said, quoted).map_err(|reason| wrong(last, reason))?;
                }
                (false, None) if plain == COLUMNS => named = true,
                (false, None) => return Err(wrong(last, format!("must be the names {COLUMNS}"))),
                (true, _) => rows.push(row(plain).map_err(|reason| wrong(last, reason))?),
            }
        }
        if !named {
            return Err(wrong(last, format!("the line of names is missing: {COLUMNS}")));
        }
        let mut seen = BTreeSet::new();
        if let Some(twice) = rows
            .iter()
            .find(|row| !seen.insert((&row.serial, row.start, &row.configuration)))
        {
            let reason = format!(
                "{} stands twice in the run that began at {} ns",
                twice.serial, twice.start
            );
            return Err(wrong(last, reason));
        }
        Ok(Self {
            file: file.to_owned(),
            kind: heading.complete().map_err(|reason| wrong(1, reason))?,
            rows,
        })
    }
}

/// The comment lines, by their names.
#[derive(Default)]
struct Heading {
    lines: Vec<(String, String)>,
}

impl Heading {
    /// Takes a comment line. One that this version does not know says something for readers.
    fn take(&mut self, said: &str, quoted: bool) -> Result<(), String> {
        let said = if quoted {
            said.trim_end_matches('"').replace("\"\"", "\"")
        } else {
            said.to_owned()
        };
        let Some((name, value)) = said.split_once(':') else {
            return Ok(());
        };
        let (name, value) = (name.trim().to_owned(), value.trim().to_owned());
        if name == FIRST && value.parse() != Ok(FORMAT) {
            return Err(format!(
                "format {value}: must be {FORMAT}; another version of flexdrill wrote it"
            ));
        }
        self.lines.push((name, value));
        Ok(())
    }

    fn get(&self, name: &str) -> Result<&str, String> {
        let found = self.lines.iter().find(|(known, _)| known == name);
        found
            .map(|(_, value)| value.as_str())
            .ok_or_else(|| format!("the comment line `# {name}: ...` is missing: this is no table of `flexdrill life`"))
    }

    fn complete(&self) -> Result<Kind, String> {
        self.get(FIRST)?;
        let text = |name: &str| self.get(name).map(str::to_owned);
        let detail = |name: &str| -> Result<Detail, String> {
            let detail: Detail = serde_json::from_str(self.get(name)?).map_err(|error| format!("# {name}: {error}"))?;
            let line = detail.line;
            let positive = [
                line.slope,
                line.slope_below_knee,
                detail.section_modulus,
                detail.stress_concentration,
            ];
            let others = [line.knee, line.scatter, detail.stress_concentration_scatter];
            let good = positive.into_iter().all(|value| value > 0.0 && value.is_finite())
                && others.into_iter().all(|value| value >= 0.0 && value.is_finite())
                && line.log_cycles.is_finite();
            good.then_some(detail)
                .ok_or_else(|| format!("# {name}: must have numbers above 0, and scatters and a knee of at least 0"))
        };
        Ok(Kind {
            pipe: text("tool.pipe")?,
            joint: text("tool.joint.kind")?,
            class: text("class")?,
            environment: text("environment")?,
            details: [detail("stop")?, detail("link")?],
            design_factor: quantity("design factor", self.get("design factor")?)?.max(1.0),
        })
    }
}

/// A number of at least 0.
fn quantity(name: &str, value: &str) -> Result<f64, String> {
    let number = value
        .parse()
        .ok()
        .filter(|value: &f64| value.is_finite() && *value >= 0.0);
    number.ok_or_else(|| format!("{name} = {value}: must be a number of at least 0"))
}

/// A row of the table.
fn row(line: &str) -> Result<Row, String> {
    let fields: Vec<&str> = line.split(',').map(|field| field.trim().trim_matches('"')).collect();
    let [serial, start, end, configuration, place, hours, stop, link] = fields[..] else {
        return Err(format!("has {} fields: must have 8, {COLUMNS}", fields.len()));
    };
    let instant = |name: &str, value: &str| -> Result<i64, String> {
        let parsed = value.parse();
        parsed.map_err(|_| format!("{name} = {value}: must be a whole number of nanoseconds"))
    };
    if serial.is_empty() {
        return Err("serial_number is empty".to_owned());
    }
    Ok(Row {
        serial: serial.to_owned(),
        start: instant("start_ns", start)?,
        end: instant("end_ns", end)?,
        configuration: configuration.to_owned(),
        place: (place.parse().ok().filter(|place| *place > 0))
            .ok_or_else(|| format!("place_from_bit = {place}: must be a whole number from 1"))?,
        hours: quantity("hours", hours)?,
        stop: quantity("stop_damage", stop)?,
        link: quantity("link_damage", link)?,
    })
}
