//! The figures of the bit.

use maud::{Markup, html};

use super::text::{capital, number};
use crate::figures::{FigureHistories, FigureHistory};
use crate::reading::Summary;
use flexdrill_messages::BitState;
use flexdrill_outputs::figures::{Group, Window};

/// The time that a value covers, without its full stop.
fn covers(window: Window) -> &'static str {
    match window {
        Window::Instant => "the instant",
        window => window.words().trim_end_matches('.'),
    }
}

/// A row; a figure that is unknown has none.
fn row(of: &FigureHistory<BitState>) -> Markup {
    let (unit, factor) = of.figure.kind.unit();
    html! {
        @if let Some(range) = of.range() {
            tr {
                td { (of.shown.label) }
                @for value in [range.min, range.mean, range.max] { td.n { (number(factor * value)) } }
                td { (unit) }
                td { (capital(covers(of.figure.window))) }
            }
        }
    }
}

/// The section about the bit: every figure that its table has.
pub(super) fn section(summary: &Summary) -> Markup {
    html! {
        section {
            h2 { "Bit" }
            @if summary.bit.all.iter().any(|figure| figure.range().is_some()) {
                (table(&summary.bit))
                p { "Means are over the whole recording; that of root mean squares is a root mean square." }
            } @else {
                p { "Not in the bag." }
            }
        }
    }
}

fn table(figures: &FigureHistories<BitState>) -> Markup {
    html! {
        table {
            thead { tr {
                th { "quantity" } th.n { "least" } th.n { "mean" } th.n { "largest" } th { "unit" } th { "a value covers" }
            } }
            tbody { @for figure in figures.group(Group::Bit) { (row(figure)) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_outputs::figures::BIT_STATE;

    /// Every figure that the table has stands on the page with label, unit and value: one that is added appears.
    #[test]
    fn every_figure_of_the_bit_has_its_row() {
        let mut message = BitState::default();
        // Values of which no two have the same digits in their units.
        for (at, figure) in BIT_STATE.iter().enumerate() {
            let (_, factor) = figure.kind.unit();
            (figure.write)(&mut message, (at + 1) as f64 / factor);
        }
        let mut figures = FigureHistories::of(BIT_STATE);
        figures.push(0.0, &message);
        let page = table(&figures).into_string();
        for (at, figure) in BIT_STATE.iter().enumerate() {
            let (unit, _) = figure.kind.unit();
            let value = number((at + 1) as f64);
            let row = format!(
                "<tr><td>{}</td><td class=\"n\">{value}</td><td class=\"n\">{value}</td><td class=\"n\">{value}</td>\
                 <td>{unit}</td>",
                figure.shown.unwrap().label
            );
            assert!(page.contains(&row), "{row}\n{page}");
        }
        assert_eq!(page.matches("<tr>").count(), BIT_STATE.len() + 1);
    }
}
