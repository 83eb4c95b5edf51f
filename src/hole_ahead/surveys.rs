//! Surveys as a table (CSV).

use flexdrill_core::units::{deg_to_rad, rad_to_deg};
use flexdrill_hole::{Survey, USUAL_INCLINATION_DEVIATION, usual_azimuth_deviation};
use flexdrill_text::fixed;

/// Columns that a table must have.
pub const COLUMNS: [&str; 3] = ["measured_depth_m", "inclination_deg", "azimuth_deg"];
/// Columns that it may have: standard deviations.
pub const DEVIATIONS: [&str; 2] = ["inclination_sd_deg", "azimuth_sd_deg"];
/// Most rows: a survey per metre of the deepest well has less.
const MOST_ROWS: usize = 20_000;

/// Why surveys are refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurveyError {
    /// The header lacks a column.
    #[error(
        "{file}:1: no column {column}: must have the columns measured_depth_m, inclination_deg and azimuth_deg; name them \
         in the first line"
    )]
    Column {
        /// The table.
        file: String,
        /// What is missing.
        column: &'static str,
    },
    /// A value that is none, or out of its bounds.
    #[error("{file}:{line}: {column} = {value}: must be {bound}; correct the line or remove it")]
    Value {
        /// The table.
        file: String,
        /// Line, from 1.
        line: u64,
        /// Column.
        column: &'static str,
        /// As in the file.
        value: String,
        /// What is allowed.
        bound: String,
    },
    /// It is no table.
    #[error("{file}: {reason}: must be a table with a header, separated by commas; export the surveys as CSV")]
    Table {
        /// The file.
        file: String,
        /// What the reader says.
        reason: String,
    },
    /// Too few or too many rows.
    #[error("{file}: {rows} rows: must be 1 to {MOST_ROWS}: give the surveys of the hole above the bit")]
    Rows {
        /// The table.
        file: String,
        /// Rows found.
        rows: usize,
    },
}

/// The surveys of a table above a bit at a measured depth (m), in the order of the table. An empty cell of the azimuth is a
/// survey without one, an empty cell of a standard deviation is the usual one.
///
/// # Errors
/// [`SurveyError`] with file, line, column, value and bound.
pub fn read(file: &str, text: &str, bit: f64) -> Result<Vec<Survey>, SurveyError> {
    let table = |error: csv::Error| SurveyError::Table {
        file: file.to_owned(),
        reason: error.to_string(),
    };
    // Programs export columns in any order, with more of them, and with comments.
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(table)?.clone();
    let place = |column: &str| {
        header
            .iter()
            .position(|name| name.trim_start_matches('\u{feff}') == column)
    };
    for column in COLUMNS {
        if place(column).is_none() {
            return Err(SurveyError::Column {
                file: file.to_owned(),
                column,
            });
        }
    }
    let mut surveys = Vec::new();
    for record in reader.records() {
        let record = record.map_err(table)?;
        let line = record.position().map_or(0, csv::Position::line);
        let cell = |column: &str| place(column).and_then(|at| record.get(at)).unwrap_or_default();
        let number = |column: &'static str, low: f64, high: f64, bound: &str| {
            let text = cell(column);
            match text.parse::<f64>() {
                // NaN fails both comparisons.
                Ok(value) if value >= low && value <= high => Ok(value),
                _ => Err(SurveyError::Value {
                    file: file.to_owned(),
                    line,
                    column,
                    value: text.to_owned(),
                    bound: bound.to_owned(),
                }),
            }
        };
        let deviation = |column: &'static str, usual: f64| {
            if cell(column).is_empty() {
                return Ok(usual);
            }
            number(column, f64::MIN_POSITIVE, 180.0, "above 0 deg and at most 180 deg").map(deg_to_rad)
        };
        let within = format!("0 m, the kick-off, to {bit:.3} m, the bit");
        let depth = number(COLUMNS[0], 0.0, bit, &within)?;
        surveys.push(Survey {
            depth,
            inclination: deg_to_rad(number(COLUMNS[1], 0.0, 180.0, "0 to 180 deg")?),
            inclination_deviation: deviation(DEVIATIONS[0], USUAL_INCLINATION_DEVIATION)?,
            azimuth: if cell(COLUMNS[2]).is_empty() {
                None
            } else {
                let azimuth = number(COLUMNS[2], -360.0, 360.0, "-360 to 360 deg, or empty")?;
                Some([
                    deg_to_rad(azimuth),
                    deviation(DEVIATIONS[1], usual_azimuth_deviation(depth))?,
                ])
            },
        });
        // Reading ends one row beyond the limit, which is then refused.
        if surveys.len() > MOST_ROWS {
            break;
        }
    }
    if !(1..=MOST_ROWS).contains(&surveys.len()) {
        return Err(SurveyError::Rows {
            file: file.to_owned(),
            rows: surveys.len(),
        });
    }
    Ok(surveys)
}

/// Azimuth of the plane in which surveys lie, with its standard deviation (rad): the mean of their horizontal directions, each
/// by its precision. None without an azimuth.
pub fn plane(surveys: &[Survey]) -> Option<[f64; 2]> {
    let (mut north, mut east, mut precision) = (0.0, 0.0, 0.0);
    for survey in surveys {
        if let Some([azimuth, deviation]) = survey.azimuth {
            // Near the vertical an azimuth says little.
            let sine = libm::sin(survey.inclination);
            let weight = sine * sine / (deviation * deviation);
            north += weight * libm::cos(azimuth);
            east += weight * libm::sin(azimuth);
            precision += weight;
        }
    }
    (precision > 0.0).then(|| [libm::atan2(east, north), libm::sqrt(1.0 / precision)])
}

/// The table of what was used: `corrects` is what a survey corrected.
pub fn csv<'a>(used: impl Iterator<Item = (&'a Survey, &'static str)>) -> String {
    let mut out = [COLUMNS.as_slice(), &DEVIATIONS, &["corrects"]].concat().join(",") + "\n";
    let degrees = |angle: f64| fixed(rad_to_deg(angle), 4);
    for (survey, corrects) in used {
        let [azimuth, deviation] = match survey.azimuth {
            Some(azimuth) => azimuth.map(degrees),
            None => [const { String::new() }; 2],
        };
        let line = [
            fixed(survey.depth, 4),
            degrees(survey.inclination),
            azimuth,
            degrees(survey.inclination_deviation),
            deviation,
            corrects.to_owned(),
        ];
        out.push_str(&line.join(","));
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_with_empty_cells_has_the_usual_deviations() {
        let text = "azimuth_deg,measured_depth_m,inclination_deg,azimuth_sd_deg\n350,4.5,20,0.5\n,5,25,\n10,5,26,\n";
        let read = read("s.csv", text, 5.0).unwrap();
        let usual = USUAL_INCLINATION_DEVIATION;
        assert_eq!(
            read.iter()
                .map(|survey| survey.inclination_deviation)
                .collect::<Vec<_>>(),
            [usual; 3]
        );
        let gyro = read[0].azimuth.unwrap()[1];
        assert!((rad_to_deg(gyro) - 0.5).abs() < 1e-12);
        assert_eq!(read[1].azimuth, None);
        // Near the casing.
        assert!((rad_to_deg(read[2].azimuth.unwrap()[1]) - 5.0).abs() < 1e-12);
    }

    #[test]
    fn the_plane_is_that_of_the_azimuths() {
        let survey = |degrees: f64, deviation: f64| Survey {
            depth: 1.0,
            inclination: deg_to_rad(90.0),
            inclination_deviation: 1e-3,
            azimuth: Some([deg_to_rad(degrees), deg_to_rad(deviation)]),
        };
        // Across north, and two of them halve the variance.
        let [azimuth, deviation] = plane(&[survey(359.0, 5.0), survey(3.0, 5.0)]).unwrap();
        assert!((rad_to_deg(azimuth) - 1.0).abs() < 1e-9);
        assert!((rad_to_deg(deviation) - 5.0 / 2.0_f64.sqrt()).abs() < 1e-9);
        // A gyro decides against a magnetic tool.
        let [azimuth, _] = plane(&[survey(10.0, 0.5), survey(20.0, 5.0)]).unwrap();
        assert!((rad_to_deg(azimuth) - 10.1).abs() < 0.01, "{azimuth}");
        assert_eq!(plane(&[]), None);
    }

    #[test]
    fn what_is_no_survey_is_refused_with_line_and_bound() {
        let head = "measured_depth_m,inclination_deg,azimuth_deg,inclination_sd_deg\n";
        for (row, said) in [
            (
                "6,20,0,",
                "s.csv:2: measured_depth_m = 6: must be 0 m, the kick-off, to 5.000 m, the bit",
            ),
            ("-0.1,20,0,", "measured_depth_m = -0.1"),
            ("4,181,0,", "inclination_deg = 181: must be 0 to 180 deg"),
            ("4,nan,0,", "inclination_deg = nan"),
            ("4,20,north,", "azimuth_deg = north"),
            ("4,20,0,0", "inclination_sd_deg = 0: must be above 0 deg"),
            ("4,20,0,-1", "inclination_sd_deg = -1"),
            ("", "0 rows: must be 1 to"),
        ] {
            let refused = read("s.csv", &format!("{head}{row}\n"), 5.0).unwrap_err().to_string();
            assert!(refused.contains(said), "{said}: {refused}");
        }
        let refused = read("s.csv", "depth,inclination_deg\n1,2\n", 5.0)
            .unwrap_err()
            .to_string();
        assert!(refused.contains("no column measured_depth_m"), "{refused}");
    }
}
