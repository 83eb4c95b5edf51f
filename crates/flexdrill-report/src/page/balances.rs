//! Balances of the whole tool.

use maud::{Markup, html};

use super::text::number;
use crate::balances::Balance;
use crate::reading::Summary;

pub(super) fn section(summary: &Summary) -> Markup {
    let all = summary.balances.all();
    let (judged, left): (Vec<&Balance>, Vec<&Balance>) = all.into_iter().partition(|of| of.judged > 0);
    let beyond: Vec<&str> = judged.iter().filter(|of| of.beyond > 0).map(|of| of.name).collect();
    html! {
        section {
            h2 { "Balances" }
            @if judged.is_empty() {
                p { "Not in the bag." }
            } @else {
                p {
                    @if beyond.is_empty() {
                        "Every balance that was judged holds. "
                    } @else {
                        b.warning { "Out of balance: " (beyond.join("; ")) ". " }
                        "Do not rely on figures of these times, and report it. "
                    }
                    "Each row is computed from the recorded figures alone and shows the message that comes nearest to the \
                     limit. Torque, hook load and rock are judged while the inputs stay within 5 %, rock while the bit turns evenly."
                }
                table {
                    thead { tr {
                        th { "balance" } th.n { "left over" } th.n { "of" } th.n { "limit" } th { "unit" } th.n { "at (s)" }
                        th.n { "beyond" } th { "reason for the limit" }
                    } }
                    tbody { @for balance in judged { (row(balance)) } }
                }
                @if !left.is_empty() {
                    p.note {
                        "Not judged: " (left.iter().map(|of| of.name).collect::<Vec<_>>().join("; ")) ". The tool does not have \
                         these figures, or the inputs did not stay for as long as the tool takes to follow them, or the bit did not turn evenly."
                    }
                }
            }
        }
    }
}

fn row(balance: &Balance) -> Markup {
    html! {
        @if let Some(worst) = &balance.worst {
            tr {
                td { (balance.name) }
                td.n.warning[worst.is_beyond()] { (number(worst.rest)) }
                @for value in [worst.size, worst.limit] { td.n { (number(value)) } }
                td { (balance.unit) }
                td.n { (format!("{:.1}", worst.time)) }
                td.n { (balance.beyond) " of " (balance.judged) }
                td { small { (balance.reason) } }
            }
        }
    }
}
