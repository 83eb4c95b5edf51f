//! The results as a picture: a tornado for each output.

use flexdrill_plot::{Figure, Legend, Line, Panel};
use flexdrill_uncertainty::effects::Effects;

/// Most bars of an output: further ones are small and would not be read.
const MOST_BARS: usize = 12;
/// Half of the height of a bar, in the distance of two.
const HALF: f64 = 0.36;
/// Places in the palette: blue at 5 %, orange at 95 %, dark grey for the scatter.
const COLORS: [usize; 2] = [0, 1];
const SCATTER: usize = 6;

/// A panel for each output that some key moves, the largest change on top.
pub fn figure(effects: &Effects) -> Figure {
    let panels = (0..effects.outputs.len()).filter_map(|output| panel(effects, output));
    Figure {
        name: "sensitivity",
        title: "Sensitivity".to_owned(),
        caption: "Change of an output with each key at 5 % and at 95 % of its distribution".to_owned(),
        columns: 1,
        height: 420,
        panels: panels.collect(),
    }
}

fn panel(effects: &Effects, index: usize) -> Option<Panel> {
    let output = effects.outputs.get(index)?;
    let keys: Vec<&str> = effects.ranked(index).into_iter().take(MOST_BARS).collect();
    if keys.is_empty() {
        return None;
    }
    let unit = if output.unit.is_empty() {
        String::new()
    } else {
        format!(" ({})", output.unit)
    };
    let title = format!(
        "{}{unit}, {} as configured",
        output.name,
        output.nominal.map_or(f64::NAN, rounded)
    );
    let mut panel = Panel::new(title, &format!("change{unit}"), "")
        .rows(keys.iter().map(|key| (*key).to_owned()).collect())
        .legend(Legend::Row);
    // The band of equal runs lies under the bars, over the height of all.
    if let Some(scatter) = output.scatter.filter(|scatter| *scatter > 0.0) {
        let [top, bottom] = [-0.5, keys.len() as f64 - 0.5];
        let around = vec![(-scatter, top), (scatter, top), (scatter, bottom), (-scatter, bottom)];
        panel = panel.line(Line::new("scatter of equal runs", around).area().color(SCATTER));
    }
    for (end, (name, color)) in ["at 5 %", "at 95 %"].into_iter().zip(COLORS).enumerate() {
        // A run that failed has no bar; the table names it.
        let bars = keys
            .iter()
            .enumerate()
            .filter_map(|(row, key)| Some((row, effects.changes(key, index)[end]?)));
        for (count, (row, change)) in bars.enumerate() {
            let name = if count == 0 { name } else { "" };
            let bar = Line::new(name, vec![(0.5 * change, row as f64)]).cells([0.5 * change.abs(), HALF]);
            panel = panel.line(bar.color(color));
        }
    }
    Some(panel)
}

/// A number of three digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
