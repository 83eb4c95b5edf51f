//! Torque, weight and power from the surface to the bit.

use maud::{Markup, html};

use super::drawn;
use super::text::{number, percent};
use crate::ReportError;
use crate::figures::FigureHistory;
use crate::plots;
use crate::reading::Summary;
use flexdrill_messages::Transfer;
use flexdrill_outputs::figures::Group;

/// A row; a quantity that is unknown, or zero throughout, has none.
fn row(quantity: &FigureHistory<Transfer>) -> Markup {
    let (unit, factor) = quantity.figure.kind.unit();
    html! {
        @if let Some(range) = quantity.range().filter(|range| range.min != 0.0 || range.max != 0.0) {
            tr {
                td { (quantity.shown.label) }
                @for value in [range.min, range.mean, range.max] { td.n { (number(factor * value)) } }
                td { (unit) }
            }
        }
    }
}

/// A mean power (W) and its share of all that is put in.
fn power(quantity: &FigureHistory<Transfer>, put_in: f64) -> Markup {
    html! {
        @if let Some(mean) = quantity.range().map(|range| range.mean).filter(|mean| *mean != 0.0) {
            tr { td { (quantity.shown.label) } td.n { (number(mean)) } td.n { (percent(mean / put_in)) } }
        }
    }
}

pub(super) fn section(summary: &Summary) -> Result<Markup, ReportError> {
    let transfer = &summary.transfer;
    let figure = drawn(
        plots::transfer(summary),
        "Means over the window of the twin. Places from the surface to the bit; a place that the tool does not have is left \
         out.",
    )?;
    // A quantity that the tool does not have counts as zero in the sum.
    let mean = |quantity: &FigureHistory<Transfer>| quantity.range().map_or(0.0, |range| range.mean);
    // Both tables relate to the power put in, so that their shares can be compared.
    let put_in = transfer.group(Group::PutIn).map(mean).sum();
    Ok(html! {
        section {
            h2 { "Transfer from the surface to the bit" }
            @if transfer.is_known() {
                @if let Some(share) = transfer.torque_efficiency() {
                    p {
                        "Of the mean torque that was put in, " b { (percent(share)) } " arrived at the bit."
                        @if transfer.window.is_finite() {
                            " Each value is a mean over up to " (number(transfer.window)) " s in which every step counts."
                        }
                    }
                }
                table {
                    thead { tr { th { "quantity" } th.n { "least" } th.n { "mean" } th.n { "largest" } th { "unit" } } }
                    tbody {
                        @for group in [Group::Torque, Group::Friction, Group::Weight, Group::Drag, Group::Whole] {
                            @for quantity in transfer.group(group) { (row(quantity)) }
                        }
                    }
                }
                h3 { "Power put in and taken" }
                table {
                    thead { tr { th { "put in by" } th.n { "mean (W)" } th.n { "share" } } }
                    tbody { @for quantity in transfer.group(Group::PutIn) { (power(quantity, put_in)) } }
                    thead { tr { th { "taken by" } th.n { "mean (W)" } th.n { "share" } } }
                    tbody { @for quantity in transfer.group(Group::Taken) { (power(quantity, put_in)) } }
                }
                (figure)
            } @else {
                p { "Not in the bag." }
            }
        }
    })
}
