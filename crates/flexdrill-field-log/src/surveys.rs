//! The surveys of a log: rare rows, or the newest survey repeated in each row.

use crate::mapping::{Column, Mapping, SurveyColumns};
use flexdrill_core::inputs::Unit;

/// A survey of a log. A tool without an azimuth has NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurveyRow {
    /// Since the first row of the range that was read (s).
    pub time: f64,
    /// Row in the log, as an editor numbers it.
    pub row: u64,
    /// Measured depth, from the rig's own zero (m).
    pub measured_depth: f64,
    /// Inclination (rad).
    pub inclination: f64,
    /// Azimuth (rad).
    pub azimuth: f64,
}

/// Indices of the columns in the header with their units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurveyIndices([Option<(usize, Unit)>; 3]);

/// Measured depth, inclination and azimuth (SI).
pub(crate) type Values = [f64; 3];

impl SurveyColumns {
    fn all(&self) -> [(&'static str, Option<&Column>); 3] {
        [
            ("measured_depth", Some(&self.measured_depth)),
            ("inclination", Some(&self.inclination)),
            ("azimuth", self.azimuth.as_ref()),
        ]
    }

    /// The columns that are there, by key.
    pub(crate) fn columns(&self) -> impl Iterator<Item = (&'static str, &Column)> {
        self.all().into_iter().filter_map(|(key, column)| Some((key, column?)))
    }
}

impl SurveyIndices {
    /// Those of a mapping; none without surveys.
    pub(crate) fn find<E>(mapping: &Mapping, find: impl Fn(&str, &str) -> Result<usize, E>) -> Result<Option<Self>, E> {
        let Some(surveys) = &mapping.columns.surveys else {
            return Ok(None);
        };
        let mut indices = [None; 3];
        for (index, (key, column)) in indices.iter_mut().zip(surveys.all()) {
            if let Some(column) = column {
                let found = find(&column.column, &format!("columns.surveys.{key}.column"))?;
                *index = Some((found, column.unit));
            }
        }
        Ok(Some(Self(indices)))
    }

    /// The survey of a row; none where it has no depth or no inclination.
    pub(crate) fn values(&self, mut value: impl FnMut(usize) -> Option<f64>) -> Option<Values> {
        let mut of = |index: Option<(usize, Unit)>| index.and_then(|(index, unit)| Some(unit.to_si(value(index)?)));
        let [depth, inclination, azimuth] = self.0.map(&mut of);
        Some([depth?, inclination?, azimuth.unwrap_or(f64::NAN)])
    }
}

/// The surveys of rows with their times (s) and numbers, without repetitions of the one before.
pub(crate) fn without_repetitions(rows: impl Iterator<Item = (f64, u64, Values)>) -> Vec<SurveyRow> {
    let mut surveys: Vec<SurveyRow> = Vec::new();
    let mut last: Option<[u64; 3]> = None;
    for (time, row, values) in rows {
        // By bits: an azimuth that is not there is not equal to itself.
        let bits = values.map(f64::to_bits);
        if last.replace(bits) == Some(bits) {
            continue;
        }
        let [measured_depth, inclination, azimuth] = values;
        surveys.push(SurveyRow {
            time,
            row,
            measured_depth,
            inclination,
            azimuth,
        });
    }
    surveys
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;
    use crate::{Range, read_bytes};

    const MAPPING: &str = "columns:
  time: {column: t, format: seconds}
  rotary_speed: {column: rpm, unit: r/min}
  weight_on_bit: {direct: {column: wob, unit: kN}}
  surveys:
    measured_depth: {column: md, unit: ft}
    inclination: {column: inc, unit: deg}
    azimuth: {column: azi, unit: deg}
";

    fn read(rows: [&str; 6], range: &Range) -> (Vec<SurveyRow>, String) {
        let mut log = "t,rpm,wob,md,inc,azi\n".to_owned();
        for (second, row) in rows.iter().enumerate() {
            writeln!(log, "{second},60,10,{row}").unwrap();
        }
        let mapping = Mapping::from_text("mapping.yaml", MAPPING).unwrap();
        let (sequence, report) = read_bytes("log.csv".to_owned(), log.as_bytes(), &mapping, range).unwrap();
        (sequence.surveys, report.to_string())
    }

    #[test]
    fn rare_rows_have_surveys_and_empty_cells_are_no_fault() {
        let rows = [
            ",,",
            "6561.68,20,350",
            ",,",
            "-999.25,-999.25,-999.25",
            "6564.96,25,",
            ",30,12",
        ];
        let (surveys, report) = read(rows, &Range::ALL);
        let found: Vec<(f64, u64)> = surveys.iter().map(|survey| (survey.time, survey.row)).collect();
        assert_eq!(found, [(1.0, 3), (4.0, 6)]);
        // 6561.68 ft of 0.3048 m.
        assert!((surveys[0].measured_depth - 2000.000064).abs() < 1e-6, "{surveys:?}");
        assert!((surveys[0].azimuth - 350_f64.to_radians()).abs() < 1e-12);
        assert!((surveys[1].inclination - 25_f64.to_radians()).abs() < 1e-12 && surveys[1].azimuth.is_nan());
        assert!(!report.contains("`md`") && !report.contains("inc:"), "{report}");
    }

    #[test]
    fn a_survey_that_is_repeated_in_each_row_is_one() {
        let rows = [
            "6561,20,",
            "6561,20,",
            "6561,20,",
            "6564,25,10",
            "6564,25,10",
            "6561,20,",
        ];
        let (surveys, _) = read(rows, &Range::ALL);
        let found: Vec<u64> = surveys.iter().map(|survey| survey.row).collect();
        assert_eq!(found, [2, 5, 7]);
        // A range begins with the survey that its first row repeats.
        let range = Range {
            from: Some(crate::Position::Row(4)),
            to: None,
        };
        assert_eq!(read(rows, &range).0[0].row, 4);
    }

    #[test]
    fn a_unit_of_another_quantity_is_refused() {
        let wrong = MAPPING.replace("{column: inc, unit: deg}", "{column: inc, unit: m}");
        let said = Mapping::from_text("mapping.yaml", &wrong).unwrap_err().to_string();
        assert!(
            said.contains("columns.surveys.inclination.unit") && said.contains("the unit belongs to another quantity"),
            "{said}"
        );
    }
}
