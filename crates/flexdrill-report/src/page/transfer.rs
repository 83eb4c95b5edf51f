//! Torque, weight and power from the surface to the bit.

use maud::{Markup, html};

use super::drawn;
use super::text::{number, percent};
use crate::ReportError;
use crate::history::History;
use crate::plots;
use crate::reading::Summary;
use crate::transfer::Group;
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn};

/// The rows of a group; a quantity that is unknown, or zero throughout, has none.
fn rows(group: &Group, unit: &str, factor: f64) -> Markup {
    html! {
        @for quantity in &group.quantities { (row(quantity.name, unit, &quantity.history, factor)) }
    }
}

fn row(what: &str, unit: &str, history: &History, factor: f64) -> Markup {
    html! {
        @if let Some(range) = history.range().filter(|range| range.min != 0.0 || range.max != 0.0) {
            tr {
                td { (what) }
                @for value in [range.min, range.mean, range.max] { td.n { (number(factor * value)) } }
                td { (unit) }
            }
        }
    }
}

/// Mean powers (W) and their share of all that is put in.
fn power(group: &Group, put_in: f64) -> Markup {
    html! {
        @for quantity in &group.quantities {
            @if let Some(mean) = quantity.history.range().map(|range| range.mean).filter(|mean| *mean != 0.0) {
                tr { td { (quantity.name) } td.n { (number(mean)) } td.n { (percent(mean / put_in)) } }
            }
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
    let means = |group: &Group| -> f64 {
        let of = |history: &History| history.range().map_or(0.0, |range| range.mean);
        group.quantities.iter().map(|quantity| of(&quantity.history)).sum()
    };
    // Both tables relate to the power put in, so that their shares can be compared.
    let put_in = means(&transfer.put_in);
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
                        (rows(&transfer.torque, "N m", 1.0))
                        (rows(&transfer.friction, "N m", 1.0))
                        (rows(&transfer.weight, "kN", n_to_kn(1.0)))
                        (rows(&transfer.drag, "kN", n_to_kn(1.0)))
                        (row("depth of cut", "mm per turn", &transfer.depth_of_cut, 1e3))
                        (row("rate of penetration", "m/h", &transfer.rate_of_penetration, m_per_s_to_m_per_h(1.0)))
                        (row("top drive at its torque limit", "% of the time", &transfer.drive_at_limit, 100.0))
                    }
                }
                h3 { "Power put in and taken" }
                table {
                    thead { tr { th { "put in by" } th.n { "mean (W)" } th.n { "share" } } }
                    tbody { (power(&transfer.put_in, put_in)) }
                    thead { tr { th { "taken by" } th.n { "mean (W)" } th.n { "share" } } }
                    tbody { (power(&transfer.taken, put_in)) }
                }
                (figure)
            } @else {
                p { "Not in the bag." }
            }
        }
    })
}
