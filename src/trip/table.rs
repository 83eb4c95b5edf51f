//! The results as a table (CSV).

use flexdrill_core::units::n_to_kn;
use flexdrill_drilling::Band;
use flexdrill_text::fixed;

use super::{FIGURES, Figure, Row};

/// A figure's name in the columns, with its unit.
const fn column(figure: Figure) -> (&'static str, &'static str) {
    match figure {
        Figure::Out => ("hook_out", "kn"),
        Figure::OutTurning => ("hook_out_rotating", "kn"),
        Figure::In => ("hook_in", "kn"),
        Figure::InTurning => ("hook_in_rotating", "kn"),
        Figure::OutTorque => ("torque_out_rotating", "nm"),
        Figure::InTorque => ("torque_in_rotating", "nm"),
        Figure::Guide => ("guide_out", "kn"),
        Figure::Push => ("push_in", "kn"),
    }
}

/// The table, a line for each depth. `low` and `high` are the ends of 90 % of the plausible tools. What is unknown is an empty
/// cell, with its cause in the last column.
pub fn csv(rows: &[Row]) -> String {
    let mut out = "bit_depth_m,weight_kn".to_owned();
    for (name, unit) in FIGURES.map(column) {
        out.push_str(&format!(
            ",{name}_{unit},{name}_low_{unit},{name}_median_{unit},{name}_high_{unit}"
        ));
    }
    out.push_str(",tools_unknown,cause\n");
    for row in rows {
        let mut line = vec![fixed(row.depth, 4), known(row.weight, false)];
        for figure in FIGURES {
            let torque = figure.is_torque();
            line.push(known(row.figure(figure).unwrap_or(f64::NAN), torque));
            line.extend(match row.band(figure) {
                Some(Band { low, median, high }) => [low, median, high].map(|value| known(value, torque)),
                None => [const { String::new() }; 3],
            });
        }
        line.push(row.unknown.to_string());
        line.push(match &row.nominal {
            Ok(_) => String::new(),
            Err(cause) => format!("\"{}\"", cause.replace('"', "\"\"")),
        });
        out.push_str(&line.join(","));
        out.push('\n');
    }
    out
}

/// A cell; empty for what is not known.
fn known(value: f64, torque: bool) -> String {
    match value.is_finite() {
        true if torque => fixed(value, 2),
        true => fixed(n_to_kn(value), 4),
        false => String::new(),
    }
}
