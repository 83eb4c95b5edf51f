//! The results as a table (CSV) and in words.

use flexdrill_text::six_digits;
use flexdrill_uncertainty::Effects;

const COLUMNS: &str = "key,quantile,value,unit,output,output_unit,nominal,result,change,scatter,cause\n";

/// The table: a line for each run and output. What is unknown is an empty cell.
pub fn csv(effects: &Effects) -> String {
    let mut out = COLUMNS.to_owned();
    let cell = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    for row in &effects.rows {
        for (index, output) in effects.outputs.iter().enumerate() {
            let cells = [
                row.key.clone(),
                row.quantile.to_string(),
                row.value.to_string(),
                row.unit.clone(),
                output.name.clone(),
                output.unit.clone(),
                cell(output.nominal),
                cell(row.results.get(index).copied().flatten()),
                cell(effects.change(row, index)),
                cell(output.scatter),
                quoted(&row.cause),
            ];
            out.push_str(&cells.join(","));
            out.push('\n');
        }
    }
    out
}

fn quoted(text: &str) -> String {
    if text.is_empty() {
        String::new()
    } else {
        format!("\"{}\"", text.replace('"', "\"\""))
    }
}

/// A number with its unit.
fn with_unit(value: f64, unit: &str) -> String {
    let space = if unit.is_empty() { "" } else { " " };
    format!("{}{space}{unit}", six_digits(value))
}

/// The results in words, a line each.
pub fn words(effects: &Effects) -> Vec<String> {
    let mut lines = vec![format!(
        "At {} r/min and {} kN, over the second half of {} s:",
        six_digits(effects.rotary_speed_rpm),
        six_digits(effects.weight_on_bit_kn),
        effects.seconds
    )];
    for output in &effects.outputs {
        // A tool without the quantity has no line of it.
        let Some(nominal) = output.nominal else { continue };
        let scatter = output
            .scatter
            .map_or_else(|| "unknown".to_owned(), |scatter| with_unit(scatter, &output.unit));
        lines.push(format!(
            "{}: {}, equal runs scatter by {scatter}",
            output.name,
            with_unit(nominal, &output.unit)
        ));
    }
    lines.push("What each key moves most, at 5 % and at 95 % of its distribution:".to_owned());
    for key in effects.keys() {
        lines.push(format!("  {key}: {}", effects.largest_in_words(key)));
    }
    for row in effects.rows.iter().filter(|row| !row.cause.is_empty()) {
        lines.push(format!(
            "Unknown with {} at {}: {}",
            row.key,
            with_unit(row.value, &row.unit),
            row.cause
        ));
    }
    lines
}
