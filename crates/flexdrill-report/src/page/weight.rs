//! Weight and torque that do not arrive at the bit, in a sentence each.

use maud::{Markup, html};

use super::text::{duration, number, percent};
use crate::reading::Summary;
use crate::weight::{SAID, Steady};
use flexdrill_config::Config;
use flexdrill_core::units::{deg_to_rad, n_to_kn};

/// The sentences; nothing where weight and torque arrive, or are not known.
pub(super) fn sentences(summary: &Summary) -> Markup {
    let Some(steady) = summary.steady.means() else {
        return html! {};
    };
    let from = if steady.from_surface { "surface" } else { "kick-off" };
    html! {
        @if steady.weight.lost() > SAID {
            p.arrival {
                b { "Weight does not all arrive: " }
                "in steady drilling (" (duration(steady.time)) ") " (number(n_to_kn(steady.weight.at_bit))) " kN of "
                (number(n_to_kn(steady.weight.put_in))) " kN at the " (from) " reached the bit, "
                (percent(steady.weight.at_bit / steady.weight.put_in)) "; " (cause(&steady)) "."
                @if let Some(config) = &summary.config { (rope(config, steady.weight.lost())) }
            }
        }
        @if steady.torque.lost() > SAID && steady.torque.put_in > 0.0 {
            p.arrival {
                b { "Torque does not all arrive: " }
                "in steady drilling " (number(steady.torque.at_bit)) " N m of " (number(steady.torque.put_in))
                " N m at the " (from) " reached the bit, " (percent(steady.torque.at_bit / steady.torque.put_in))
                "; friction of string, pipe and guide, and the joints, take the rest."
            }
        }
    }
}

/// The likely cause: the largest drag, where the drags make up at least half of what is lost.
fn cause(steady: &Steady) -> String {
    let lost = steady.weight.put_in - steady.weight.at_bit;
    let names = [
        "along the string",
        "of the pipe in the guide",
        "of the guide on the wall",
    ];
    let largest = steady.drag.into_iter().zip(names).max_by(|a, b| a.0.total_cmp(&b.0));
    match largest {
        Some((drag, name)) if steady.drag.iter().sum::<f64>() >= 0.5 * lost => {
            format!(
                "the likely cause is friction {name}, which took {} kN",
                number(n_to_kn(drag))
            )
        }
        _ => "the computed friction does not explain it: the tool hangs or stands elsewhere, or moves with the bit"
            .to_owned(),
    }
}

/// The share that a rope with the same friction would lose round the arc, in comparison: the least that a bent guide loses
/// while it slides along the hole.
fn rope(config: &Config, lost: f64) -> String {
    let turned = deg_to_rad(config.well.end_inclination_deg() - config.well.start_inclination_deg);
    let (contact, factor) = (&config.contact, config.calibration.friction_factor);
    let friction = contact.outer.friction_axial * contact.wall_friction_factors.arc * factor;
    let taken = 1.0 - (-friction * turned).exp();
    if taken.is_nan() || taken <= 0.0 {
        return String::new();
    }
    let (taken, friction) = (taken, number(friction));
    let compared = if lost > taken {
        "less than was lost: look for a guide that presses on the wall, cuttings, or a friction above that"
    } else {
        "so friction round the arc explains it"
    };
    format!(
        " With the configured friction of {friction}, a rope round this arc loses {}, {compared}.",
        percent(taken)
    )
}
