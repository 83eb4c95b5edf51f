//! The results as a table (CSV).

use flexdrill_core::units::rad_to_deg;
use flexdrill_hole::Survey;
use flexdrill_text::fixed;

use super::surveys::DEVIATIONS;
use super::{Answer, Band, Plan, SPACING, advice};
use crate::drilling::table::COLUMNS as DIRECTION;

const COLUMNS: &str = "ahead_m,measured_depth_m,inclination_deg,inclination_low_deg,inclination_median_deg,\
                       inclination_high_deg,azimuth_deg,azimuth_low_deg,azimuth_median_deg,azimuth_high_deg,x_m,y_m,z_m,\
                       half_width_high_side_m,half_width_right_m,to_plan_m,above_plan_m,right_of_plan_m\n";

/// The table, a line for each station. `low` and `high` are the ends of 90 % of the members. What is unknown is an empty cell,
/// as is the distance to a plan where there is none.
pub fn csv(answer: &Answer, plan: Option<&Plan>) -> String {
    let mut out = COLUMNS.to_owned();
    let number = |value: f64| fixed(value, 4);
    let cells = |band: Option<Band>| match band {
        Some(band) => [band.low, band.median, band.high].map(|angle| number(rad_to_deg(angle))),
        None => [const { String::new() }; 3],
    };
    for (index, at) in answer.nominal.iter().enumerate() {
        let ahead = index as f64 * SPACING;
        let spread = answer.spread.get(index);
        let mut line = vec![number(ahead), number(answer.depth + ahead)];
        line.push(number(rad_to_deg(at.inclination)));
        line.extend(cells(spread.map(|spread| spread.inclination)));
        line.push(number(rad_to_deg(at.azimuth)));
        line.extend(cells(spread.map(|spread| spread.azimuth)));
        line.extend(at.position.map(number));
        for band in [spread.map(|spread| spread.high), spread.map(|spread| spread.right)] {
            line.push(band.map_or_else(String::new, |band| number(band.half())));
        }
        // Beyond the end of a plan there is no distance to it.
        let compared = plan.filter(|plan| index <= advice::last_station(plan));
        line.extend(match compared.map(|plan| plan.distance(at)) {
            Some(distance) => [distance.whole, distance.high, distance.right].map(number),
            None => [const { String::new() }; 3],
        });
        out.push_str(&line.join(","));
        out.push('\n');
    }
    out
}

/// The table of surveys: `corrects` is what a survey corrected.
pub fn surveys_csv<'a>(used: impl Iterator<Item = (&'a Survey, &'static str)>) -> String {
    let mut out = [DIRECTION.as_slice(), &DEVIATIONS, &["corrects"]].concat().join(",") + "\n";
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
