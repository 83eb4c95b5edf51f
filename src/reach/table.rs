//! The results as a table (CSV) and in words.

use flexdrill_core::units::n_to_kn;

use super::{Plan, Row};
use flexdrill_text::counted;

const COLUMNS: &str = "length_m,links,friction,rotates,state,weight_at_kickoff_kn,weight_at_bit_kn,\
                       weight_at_bit_range_kn,torque_at_kickoff_nm,torque_at_bit_nm,torque_at_bit_range_nm,\
                       soft_weight_at_bit_kn,soft_torque_at_kickoff_nm,soft_torque_at_bit_nm,guide_buckles_at_m,\
                       chain_folds_at_m,advance_m_per_h,model_time_s,cause\n";

/// Rate of penetration (m/s) below which a bit hardly advances: a tenth of a metre per hour.
const HARDLY: f64 = 0.1 / 3600.0;

/// The table. What is unknown has empty cells and its cause in the last column; an empty depth of buckling is a tool that
/// does not buckle.
pub fn csv(rows: &[Row]) -> String {
    let mut out = COLUMNS.to_owned();
    for row in rows {
        let number = |value: f64| format!("{value:.6}");
        let kilo = |value: f64| number(n_to_kn(value));
        let mut cells = vec![
            number(row.length),
            row.links.to_string(),
            row.friction.to_string(),
            row.rotates.to_string(),
        ];
        let soft = [
            kilo(row.soft.weight_at_bit),
            number(row.soft.torque_at_top),
            number(row.soft.torque_at_bit),
        ];
        match &row.found {
            Ok(found) => {
                cells.push("steady".to_owned());
                cells.extend(found.weight.map(kilo));
                cells.push(kilo(found.range[0]));
                cells.extend(found.torque.map(number));
                cells.push(number(found.range[1]));
                cells.extend(soft);
                cells.extend([found.guide_buckles_at, found.chain_folds_at].map(|at| at.map_or(String::new(), number)));
                cells.extend([number(3600.0 * found.advance), number(found.time), String::new()]);
            }
            Err(cause) => {
                cells.push("unknown".to_owned());
                cells.extend(vec![String::new(); 6]);
                cells.extend(soft);
                cells.extend(vec![String::new(); 4]);
                cells.push(format!("\"{}\"", cause.replace('"', "\"\"")));
            }
        }
        out.push_str(&cells.join(","));
        out.push('\n');
    }
    out
}

/// Rows of a length, with or without rotation.
pub(super) fn rows_of(rows: &[Row], links: usize, rotates: bool) -> impl Iterator<Item = &Row> {
    rows.iter()
        .filter(move |row| row.links == links && row.rotates == rotates)
}

/// The friction coefficient whose curve is drawn: the middle one.
pub(super) fn middle(plan: &Plan) -> f64 {
    plan.frictions
        .get(plan.frictions.len() / 2)
        .copied()
        .unwrap_or(f64::NAN)
}

/// The value at the middle friction and the range over all, of the points that are known, with the unit of what is known.
fn over_friction(rows: &[&Row], middle: f64, unit: &str, of: impl Fn(&Row) -> Option<f64>) -> String {
    let known: Vec<f64> = rows.iter().filter_map(|row| of(row)).collect();
    let at = rows.iter().find(|row| row.friction == middle).and_then(|row| of(row));
    let first = at.map_or("unknown".to_owned(), |value| format!("{value:.2}"));
    if known.is_empty() {
        return first;
    }
    if rows.len() < 2 {
        return format!("{first} {unit}");
    }
    let low = known.iter().copied().fold(f64::MAX, f64::min);
    let high = known.iter().copied().fold(f64::MIN, f64::max);
    format!("{first} ({low:.2} to {high:.2}) {unit}")
}

/// The results in words, a line each.
pub fn words(plan: &Plan, rows: &[Row]) -> Vec<String> {
    // One friction in the sentence; the range of the others follows in brackets.
    let middle = middle(plan);
    let mut lines = vec![format!(
        "At {:.2} kN put in and a friction coefficient of {middle}{}:",
        n_to_kn(plan.load.weight),
        match (plan.frictions.first(), plan.frictions.last()) {
            (Some(low), Some(high)) if low < high => format!(" ({low} to {high} in brackets)"),
            _ => String::new(),
        }
    )];
    for &links in &plan.links {
        let turning: Vec<&Row> = rows_of(rows, links, true).collect();
        let standing: Vec<&Row> = rows_of(rows, links, false).collect();
        let Some(length) = turning.first().map(|row| row.length) else {
            continue;
        };
        // A row that failed has no figure here, and its reason at the end.
        let torque = |row: &Row| row.found.as_ref().ok().map(|found| found.torque[1]);
        let top = |row: &Row| row.found.as_ref().ok().map(|found| found.torque[0]);
        let weight = |row: &Row| row.found.as_ref().ok().map(|found| n_to_kn(found.weight[1]));
        lines.push(format!(
            "{length:6.2} m: torque at the bit {}, at the kick-off {}; weight at the bit {} with rotation, {} without.",
            over_friction(&turning, middle, "N m", torque),
            over_friction(&turning, middle, "N m", top),
            over_friction(&turning, middle, "kN", weight),
            over_friction(&standing, middle, "kN", weight),
        ));
    }
    lines.push(onset(rows, "The guide buckles sideways", |row| {
        row.found.as_ref().ok()?.guide_buckles_at
    }));
    lines.push(onset(rows, "The chain of links folds (T > N_eff L / 2)", |row| {
        row.found.as_ref().ok()?.chain_folds_at
    }));
    // A bit that hardly advances has not reached the state that the figures assume, so its points are named.
    let slow = |row: &&Row| row.rotates && row.found.as_ref().is_ok_and(|found| found.advance < HARDLY);
    let still: Vec<f64> = rows.iter().filter(slow).map(|row| row.length).collect();
    if let (Some(first), count) = (still.first(), still.len()) {
        lines.push(format!(
            "At {} with rotation, the first at {first:.2} m, the bit hardly advances: the guide sticks, and its friction \
             depends on how the weight was put on.",
            counted(count as u64, "point")
        ));
    }
    // Failures come last and completely: an unknown point must not look like one that was left out on purpose.
    for row in rows {
        if let Err(cause) = &row.found {
            lines.push(format!(
                "Unknown at {:.2} m, friction {}, {}: {cause}",
                row.length,
                row.friction,
                rotation(row.rotates)
            ));
        }
    }
    lines
}

/// "with rotation" or "without rotation".
fn rotation(rotates: bool) -> &'static str {
    if rotates { "with rotation" } else { "without rotation" }
}

/// From which length on and where along the tool something sets in.
fn onset(rows: &[Row], what: &str, at: impl Fn(&Row) -> Option<f64>) -> String {
    let known = rows.iter().filter(|row| row.found.is_ok()).count();
    let first = rows
        .iter()
        .filter_map(|row| Some((row, at(row)?)))
        .min_by(|(a, _), (b, _)| a.length.total_cmp(&b.length));
    match first {
        _ if known == 0 => format!("{what}: unknown."),
        None => format!("{what} at none of the {known} known points."),
        Some((row, depth)) => format!(
            "{what} from a length of {:.2} m on (friction {}, {}), first at a measured depth of {depth:.2} m.",
            row.length,
            row.friction,
            rotation(row.rotates)
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::soft_string::SoftString;

    #[test]
    fn what_is_unknown_has_no_unit() {
        let soft = SoftString {
            weight_at_bit: 0.0,
            torque_at_bit: 0.0,
            torque_at_top: 0.0,
        };
        let row = Row {
            length: 5.0,
            links: 30,
            friction: 0.2,
            rotates: true,
            soft,
            found: Err("a step failed".to_owned()),
        };
        let failed = |_: &Row| None;
        assert_eq!(over_friction(&[&row], 0.2, "N m", failed), "unknown");
        assert_eq!(over_friction(&[&row, &row], 0.2, "N m", failed), "unknown");
        assert_eq!(over_friction(&[&row], 0.2, "N m", |_| Some(12.0)), "12.00 N m");
        let both = over_friction(&[&row, &row], 0.2, "N m", |_| Some(12.0));
        assert_eq!(both, "12.00 (12.00 to 12.00) N m");
    }
}
