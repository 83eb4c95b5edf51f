//! The results in words.

use flexdrill_config::Config;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_text::counted;

use super::{Figure, Plan, Row};

/// A force or torque with its range, and the unit.
fn with_range(row: &Row, figure: Figure) -> String {
    let (unit, digits) = if figure.is_torque() { ("N m", 0) } else { ("kN", 1) };
    let shown = |value: f64| {
        let value = if figure.is_torque() { value } else { n_to_kn(value) };
        format!("{value:.digits$}")
    };
    match (row.figure(figure), row.band(figure)) {
        (Some(value), Some(band)) => format!("{} ({} to {}) {unit}", shown(value), shown(band.low), shown(band.high)),
        (Some(value), None) => format!("{} {unit}", shown(value)),
        (None, _) => "unknown".to_owned(),
    }
}

/// The depth at which a figure is largest.
fn worst(rows: &[Row], figure: Figure) -> Option<&Row> {
    rows.iter().filter(|row| row.figure(figure).is_some()).max_by(|a, b| {
        let of = |row: &Row| row.figure(figure).unwrap_or(f64::NEG_INFINITY);
        of(a).total_cmp(&of(b))
    })
}

/// The results, a line each. `as_built` says that the guide has the curvature of the hole because none is configured.
pub fn words(config: &Config, plan: &Plan, rows: &[Row], as_built: bool) -> Vec<String> {
    let above = if config.string.sections.is_empty() || config.string.model != flexdrill_config::Model::Line {
        "at the tool's top, because the configuration has no string (string.model: line)"
    } else {
        "at the hook, without the block"
    };
    let range = if rows.iter().any(|row| row.bands.iter().any(Option::is_some)) {
        format!(
            "; in brackets 90 % of {}",
            counted(plan.members as u64, "plausible tool")
        )
    } else {
        String::new()
    };
    let mut lines = vec![format!(
        "Loads {above}, off bottom, at {:.2} m/s along the hole; with rotation at {:.0} r/min{range}:",
        plan.along,
        rad_per_s_to_rpm(plan.spin)
    )];
    // The ends of the trip; the table has all between.
    for row in [rows.first(), rows.last()].into_iter().flatten() {
        lines.push(format!(
            "Bit at {:.2} m: pulling out {}, with rotation {}; running in {}, with rotation {}; {:.1} kN hang without friction.",
            row.depth,
            with_range(row, Figure::Out),
            with_range(row, Figure::OutTurning),
            with_range(row, Figure::In),
            with_range(row, Figure::InTurning),
            n_to_kn(row.weight)
        ));
    }
    if let Some(row) = worst(rows, Figure::OutTorque) {
        lines.push(format!(
            "The rotation takes most torque with the bit at {:.2} m: {} pulling out, {} running in.",
            row.depth,
            with_range(row, Figure::OutTorque),
            with_range(row, Figure::InTorque)
        ));
    }
    if let Some(row) = worst(rows, Figure::Guide) {
        lines.push(format!(
            "The guide's top bears most on the way out with the bit at {:.2} m: {}. Hold it against what the slots leave of the \
             guide's section.",
            row.depth,
            with_range(row, Figure::Guide)
        ));
    }
    lines.extend(push(rows));
    if as_built {
        lines.push(
            "The guide has no curvature as made (tool.guide.free_curvature), so that of the hole at the bit is taken: where the \
             hole bends it otherwise, these loads follow from it."
                .to_owned(),
        );
    }
    let unknown = rows.iter().map(|row| row.unknown).max().unwrap_or(0);
    if unknown > 0 {
        lines.push(format!(
            "{} of {} without a result at some depth.",
            unknown,
            counted(plan.members as u64, "plausible tool")
        ));
    }
    lines.push(
        "Not in these loads: the force that starts a motion, swab and surge of the mud, cuttings, ledges, key seats, and \
         differential sticking. A load outside of the range has a cause of this kind."
            .to_owned(),
    );
    for row in rows {
        if let Err(cause) = &row.nominal {
            lines.push(format!("Unknown at {:.2} m: {cause}", row.depth));
        }
    }
    lines
}

/// Whether the weight of string and tool runs the tool in.
fn push(rows: &[Row]) -> Option<String> {
    let pushed = |figure: Figure| {
        let stuck = rows
            .iter()
            .filter(|row| row.figure(figure).is_some_and(|hook| hook < 0.0));
        stuck.map(|row| row.depth).fold(f64::INFINITY, f64::min)
    };
    let [sliding, turning] = [Figure::In, Figure::InTurning].map(pushed);
    if sliding.is_finite() {
        let with = if turning.is_finite() {
            "nor with rotation"
        } else {
            "but with rotation it does"
        };
        return Some(format!(
            "From a bit at {sliding:.2} m on the tool does not run in by the weight of the string, {with}: the friction takes \
             more than hangs."
        ));
    }
    let row = worst(rows, Figure::Push)?;
    let push = row.figure(Figure::Push)?;
    (push > 0.0).then(|| {
        format!(
            "Running in, the tool is pushed by up to {}, with the bit at {:.2} m.",
            with_range(row, Figure::Push),
            row.depth
        )
    })
}
