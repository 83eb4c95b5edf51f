//! The inputs and the transfer of torque.

use maud::{Markup, html};

use super::drawn;
use super::health::shares;
use super::text::{number, percent};
use crate::ReportError;
use crate::drive::OptionalInput;
use crate::history::History;
use crate::plots;
use crate::reading::Summary;
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn, pa_to_mpa, rad_per_s_to_rpm};
use flexdrill_outputs::words;

/// A row of the table; the mean is taken over `window` (s), or over the whole recording without one.
fn row(what: &str, unit: &str, history: &History, factor: f64, window: Option<[f64; 2]>) -> Markup {
    html! {
        @if let Some(range) = history.range() {
            @let mean = window.map_or(Some(range.mean), |[from, to]| history.mean_between(from, to));
            tr {
                td { (what) }
                @for value in [range.min, mean.unwrap_or(f64::NAN), range.max] { td.n { (number(factor * value)) } }
                td { (unit) }
            }
        }
    }
}

/// The rows of an optional input; none where it was not sent and did not act.
fn optional(what: &str, unit: &str, input: &OptionalInput, factor: f64) -> Markup {
    let sent = input.received.range().is_some();
    html! {
        @if input.concerns() {
            (row(&format!("{what}, received"), unit, &input.received, factor, None))
            (row(&format!("{what}, {}", if sent { "accepted" } else { "assumed" }), unit, &input.accepted, factor, None))
        }
    }
}

fn head(what: &str) -> Markup {
    html! { thead { tr { th { (what) } th.n { "least" } th.n { "mean" } th.n { "largest" } th { "unit" } } } }
}

/// The section about the inputs.
pub(super) fn inputs(summary: &Summary) -> Result<Markup, ReportError> {
    let drive = &summary.drive;
    let (rpm, kn) = (rad_per_s_to_rpm(1.0), n_to_kn(1.0));
    let newest = summary.health.newest.as_ref();
    // Means are compared with each other, so they are over the time in which all quantities are known.
    let window = drive.common_window();
    let figure = drawn(
        plots::inputs(summary),
        "Received: as the rig sent it. Accepted: after the checks, before the slew limit. Pale: least to largest.",
    )?;
    Ok(html! {
        section {
            h2 { "Inputs" }
            table {
                (head("quantity"))
                tbody {
                    (row("rotary speed, received", "r/min", &drive.received.rotary_speed, rpm, window))
                    (row("rotary speed, accepted", "r/min", &drive.accepted.rotary_speed, rpm, window))
                    (row("weight on bit, received", "kN", &drive.received.weight_on_bit, kn, window))
                    (row("weight on bit, accepted", "kN", &drive.accepted.weight_on_bit, kn, window))
                    (row("weight on bit, at the bit", "kN", &drive.bit.weight_on_bit, kn, window))
                    // Optional inputs have a row only where they were used.
                    (optional("rate of penetration", "m/h", &drive.rate_of_penetration, m_per_s_to_m_per_h(1.0)))
                    (optional("standpipe pressure", "MPa", &drive.standpipe_pressure, pa_to_mpa(1.0)))
                }
            }
            // The window is stated, or a reader would take the means for those of the whole recording.
            @if let Some([from, to]) = window {
                p {
                    "Means are over time, from " (number(from)) " to " (number(to)) " s, in which all of these are known. \
                     Least and largest values are those of the whole recording."
                }
            }
            // The status has the state of every input; a recording without it has the worst of all only.
            @if !summary.health.inputs.is_empty() {
                table {
                    thead { tr { th { "input" } th { "state, share of the time" } th { "driven by" } th.n { "refused" } } }
                    tbody {
                        @for (name, states) in &summary.health.inputs {
                            @let index = newest.and_then(|status| status.input_name.iter().position(|known| known == name));
                            tr {
                                td { code { (name) } }
                                td { (shares(states, words::input_state)) }
                                td { @for (at, driver) in summary.health.drivers.get(name).into_iter().flatten().enumerate() { @if at > 0 { ", " } (driver) } }
                                td.n { @if let Some(count) = index.and_then(|index| newest?.input_rejected.get(index)) { (count) } }
                            }
                        }
                    }
                }
            } @else if !drive.input_quality.is_empty() {
                p {
                    "State of the inputs, the worst of them: " (shares(&drive.input_quality, words::input_state)) "."
                }
            }
            (figure)
        }
    })
}

/// The section about the torque at the bit.
pub(super) fn torque(summary: &Summary) -> Result<Markup, ReportError> {
    let drive = &summary.drive;
    let figure = drawn(
        plots::torque(summary),
        "Torque through the uppermost joint, and torque of the rock on the bit. At a stick-slip index of 1 or more the \
         bit stops at times.",
    )?;
    Ok(html! {
        section {
            h2 { "Transfer of torque" }
            @match drive.transfer.means() {
                Some([top, bit]) => p {
                    "While the drive turned, the mean torque was " (number(top)) " N m at the uppermost joint and " (number(bit))
                    " N m at the bit: " b { (percent(bit / top)) } ". Friction along the tool consumed "
                    (number(top - bit)) " N m."
                },
                None => p { "The drive did not turn, or the bag lacks one of the two torques." },
            }
            table {
                (head("quantity"))
                tbody {
                    (row("torque at the uppermost joint", "N m", &drive.top_torque, 1.0, None))
                    (row("torque at the bit", "N m", &drive.bit_torque, 1.0, None))
                }
            }
            (figure)
        }
    })
}
