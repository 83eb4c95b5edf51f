//! Surveys: their table (CSV), and the plane that they lie in.

use flexdrill_core::units::deg_to_rad;
use flexdrill_hole::{Survey, USUAL_INCLINATION_DEVIATION, usual_azimuth_deviation};

use super::table::{self, COLUMNS, Kind, TableError};

/// Columns that a table may have: standard deviations.
pub const DEVIATIONS: [&str; 2] = ["inclination_sd_deg", "azimuth_sd_deg"];
/// Tables of surveys.
const TABLE: Kind = Kind {
    what: "the surveys",
    least: 1,
    give: "the surveys of the hole above the bit",
};

/// The surveys of a table above a bit at a measured depth (m), in the order of the table. An empty cell of the azimuth is a
/// survey without one, an empty cell of a standard deviation is the usual one.
///
/// # Errors
/// [`TableError`] with file, line, column, value and bound.
pub fn read(file: &str, text: &str, bit: f64) -> Result<Vec<Survey>, TableError> {
    let within = format!("0 m, the kick-off, to {bit:.3} m, the bit");
    table::read(file, text, TABLE, |cells, _| {
        let deviation = |column: &'static str, usual: f64| {
            if cells.text(column).is_empty() {
                return Ok(usual);
            }
            let bound = "above 0 deg and at most 180 deg";
            cells.number(column, f64::MIN_POSITIVE..=180.0, bound).map(deg_to_rad)
        };
        let [depth, _, azimuth] = COLUMNS;
        let depth = cells.number(depth, 0.0..=bit, within.as_str())?;
        Ok(Survey {
            depth,
            inclination: deg_to_rad(cells.inclination_deg()?),
            inclination_deviation: deviation(DEVIATIONS[0], USUAL_INCLINATION_DEVIATION)?,
            azimuth: if cells.text(azimuth).is_empty() {
                None
            } else {
                let azimuth = cells.number(azimuth, -360.0..=360.0, "-360 to 360 deg, or empty")?;
                Some([
                    deg_to_rad(azimuth),
                    deviation(DEVIATIONS[1], usual_azimuth_deviation(depth))?,
                ])
            },
        })
    })
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

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_core::units::rad_to_deg;

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
