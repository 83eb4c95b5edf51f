//! Reads the text of a sample: comment lines, names, rows.

use super::error::PosteriorError;
use super::{
    FORMAT, LEAST_EFFECTIVE, MOST_BYTES, MOST_KEYS, MOST_MEMBERS, Posterior, Provenance, WEIGHT, Weighted,
    effective_number,
};

/// What a line is to say, and does not.
type Wrong = String;

/// Reads the bytes of a file; `file` stands for it in errors.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<Posterior, PosteriorError> {
    let wrong = |line: usize, reason: Wrong| PosteriorError::Line {
        file: file.to_owned(),
        line,
        reason,
    };
    if bytes.len() as u64 > MOST_BYTES {
        return Err(wrong(1, format!("larger than {MOST_BYTES} bytes")));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        wrong(line, "must be text in UTF-8".to_owned())
    })?;
    // Spreadsheets write a mark of the byte order before the text.
    let text = text.trim_start_matches('\u{feff}');
    let mut heading = Heading::default();
    let mut names: Option<Vec<String>> = None;
    let mut members: Vec<Weighted> = Vec::new();
    let mut last = 1;
    for (index, line) in text.lines().enumerate() {
        let at = index + 1;
        last = at;
        // A spreadsheet fills short lines with commas and may put them in quotes.
        let comment = line.trim_matches([' ', ',', '"', '\r']);
        if comment.is_empty() {
            continue;
        }
        match (&names, comment.strip_prefix('#')) {
            (None, Some(said)) => heading.take(said).map_err(|reason| wrong(at, reason))?,
            (None, None) => names = Some(columns(line).map_err(|reason| wrong(at, reason))?),
            (Some(names), _) => {
                if members.len() == MOST_MEMBERS {
                    return Err(wrong(at, format!("must have at most {MOST_MEMBERS} members")));
                }
                members.push(member(names, line, at).map_err(|reason| wrong(at, reason))?);
            }
        }
    }
    let provenance = heading.complete().map_err(|reason| wrong(last, reason))?;
    let keys = names.ok_or_else(|| wrong(last, "it has no line of names".to_owned()))?;
    if members.is_empty() {
        return Err(wrong(last, "it has no members".to_owned()));
    }
    if members.iter().all(|member| member.weight == 0.0) {
        return Err(wrong(
            last,
            "all weights are 0: at least one must be above 0".to_owned(),
        ));
    }
    let effective = effective_number(&members);
    if effective < LEAST_EFFECTIVE {
        return Err(PosteriorError::TooFew {
            file: file.to_owned(),
            effective,
            least: LEAST_EFFECTIVE,
        });
    }
    Ok(Posterior {
        provenance,
        file: file.to_owned(),
        sha256: flexdrill_config::sha256(bytes),
        keys,
        members,
    })
}

/// The comment lines.
#[derive(Default)]
struct Heading {
    format: Option<String>,
    tool: Option<String>,
    usable: Option<String>,
    of: Provenance,
}

impl Heading {
    /// Takes a comment line. One that this version does not know says something for readers.
    fn take(&mut self, said: &str) -> Result<(), Wrong> {
        let Some((name, value)) = said.split_once(':') else {
            return Ok(());
        };
        let value = value.trim().to_owned();
        match name.trim() {
            "flexdrill posterior" => self.format = Some(value),
            "flexdrill" => self.of.version = value,
            "tool" => self.tool = Some(value),
            "configuration" => self.of.configuration = value,
            "log" => self.of.log = value,
            "log SHA-256" => self.of.sha256 = value,
            "log rows" => {
                let ends = value.split_once(" to ");
                let ends = ends.and_then(|(first, last)| Some([first.parse().ok()?, last.parse().ok()?]));
                self.of.rows = ends.ok_or_else(|| format!("log rows: {value}: must be two numbers with `to`"))?;
            }
            "seed" => {
                let seed = value.parse();
                self.of.seed = seed.map_err(|_| format!("seed: {value}: must be a whole number from 0"))?;
            }
            "usable" => self.usable = Some(value),
            _ => {}
        }
        Ok(())
    }

    /// What they say together.
    fn complete(mut self) -> Result<Provenance, Wrong> {
        let missing = |name: &str| format!("the comment line `# {name}: ...` is missing");
        let format = self.format.ok_or_else(|| missing("flexdrill posterior"))?;
        if format.parse() != Ok(FORMAT) {
            return Err(format!("format {format}: must be {FORMAT}"));
        }
        self.of.tool = self.tool.ok_or_else(|| missing("tool"))?;
        let usable = self.usable.ok_or_else(|| missing("usable"))?;
        if usable != "yes" {
            let why = usable.trim_start_matches("no").trim_start_matches(':').trim();
            self.of.objections = vec![if why.is_empty() { "no reason given" } else { why }.to_owned()];
        }
        Ok(self.of)
    }
}

/// The fields of a line.
fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|field| field.trim().trim_matches('"'))
}

/// The keys from the line of names.
fn columns(line: &str) -> Result<Vec<String>, Wrong> {
    let mut names = fields(line);
    let first = names.next().unwrap_or_default();
    if first != WEIGHT {
        return Err(format!("the first column is `{first}`: must be `{WEIGHT}`"));
    }
    let keys: Vec<String> = names.by_ref().take(MOST_KEYS).map(str::to_owned).collect();
    if names.next().is_some() {
        return Err(format!("must have at most {MOST_KEYS} keys"));
    }
    if keys.is_empty() {
        return Err("it has no keys: the log determined none".to_owned());
    }
    for (index, key) in keys.iter().enumerate() {
        if key.is_empty() {
            return Err(format!("column {} has no name", index + 2));
        }
        if keys[..index].contains(key) {
            return Err(format!("{key} has two columns: must have one"));
        }
    }
    Ok(keys)
}

/// A member from its line.
fn member(keys: &[String], line: &str, at: usize) -> Result<Weighted, Wrong> {
    let count = line.split(',').count();
    if count != keys.len() + 1 {
        return Err(format!(
            "{count} values: must be {}, a weight and one per key",
            keys.len() + 1
        ));
    }
    let number = |name: &str, field: &str| match field.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => {
            // A damaged file may have a field of any length.
            let shown: String = field.chars().take(40).filter(|c| !c.is_control()).collect();
            Err(format!("{name}: {shown}: must be a finite number"))
        }
    };
    let mut fields = fields(line);
    let weight = number(WEIGHT, fields.next().unwrap_or_default())?;
    if weight < 0.0 {
        return Err(format!("{WEIGHT}: {weight}: must be at least 0"));
    }
    let values = keys.iter().zip(fields).map(|(key, field)| number(key, field));
    Ok(Weighted {
        weight,
        values: values.collect::<Result<_, _>>()?,
        line: at,
    })
}
