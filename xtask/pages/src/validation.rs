//! Every published figure and every closed form that the twin is held against, as computed now.

use std::fmt::Write as _;

use flexdrill_verify::{CASES, Row, VALIDATIONS, head};

use crate::cell;
use crate::laws::{self, ANALYTIC, Figures, Law, VAL};

/// Names of all entries in the order of the page.
pub fn names() -> Vec<String> {
    let whole = VALIDATIONS.iter().map(|validation| validation.name.to_owned());
    let laws = |prefix| laws::named(prefix).into_iter().map(|law| law.name);
    whole
        .chain(laws(VAL))
        .chain(CASES.iter().map(|case| case.name.to_owned()))
        .chain(laws(ANALYTIC))
        .collect()
}

/// The page, for which all cases and the tests of single laws run.
///
/// # Errors
/// When a case cannot be run, or a test of a law fails or prints no figure.
pub fn page() -> std::io::Result<String> {
    let failed = std::io::Error::other;
    let mut out = String::from(
        "# Validation\n\n\
         Written by `cargo xtask reference validation`, which runs every case. Figures are rounded to three digits, so that\n\
         they are the same on every machine; the difference is that of the unrounded ones, over the figure unless a table\n\
         says otherwise, and the tests hold it within the tolerance.\n\n\
         No bench figure of torque or weight through a flexible drill pipe is publicly readable. What the twin has of the\n\
         paper's own figures is in [the paper](paper.md).\n\n\
         Figures of programs of others (`val_soft_string_of_welleng`) are those of a pinned version. A test runs the\n\
         program again where Python has it (`cargo test --release -p flexdrill-verify --test foreign`).\n\n\
         `flexdrill verify --record DIR` runs the closed forms and the published figures, and leaves a bag of every run in\n\
         DIR, for comparison with another program. Two tables (CSV) have the figures in full, and steps and time of\n\
         each bag. A bag holds its configuration and its inputs; where `residual_factor` is 1, `flexdrill replay` repeats\n\
         it to the bit. Tests of single laws have no run, and therefore no bag.\n\n\
         Tests against figures from outside are named `val_*`, tests of a law against a closed form `analytic_*`, and tests\n\
         against our own earlier figures `regress_*`.\n\n\
         ## Published figures\n",
    );
    // Validations come first: figures from outside weigh more than closed forms.
    for validation in VALIDATIONS {
        let _ = write!(
            out,
            "\n### {}\n{}.\n\n{}{}- Command: `{}`\n\n",
            validation.name,
            capital(validation.shows),
            item("Source", validation.source),
            item("Tolerance", validation.reason),
            validation.command
        );
        table(&mut out, "published", &(validation.run)().map_err(failed)?);
    }
    // Both kinds of laws run in one call, since each call builds and starts the tests.
    let (published, analytic) = (laws::named(VAL), laws::named(ANALYTIC));
    let figures = laws::figures(published.iter().chain(&analytic))?;
    out.push_str(
        "\n## Published figures of single laws\n\
         Tests of a law alone, with their comments: source, figure, tolerance and its reason.\n",
    );
    of_laws(&mut out, "published", &published, &figures);
    out.push_str(
        "\n## Closed forms\nThe cases of `flexdrill verify`. The text of each is the head of its configuration.\n",
    );
    for case in CASES {
        let _ = write!(
            out,
            "\n### {}\n```text\n{}\n```\n\n{}- Command: `flexdrill verify --only {}`\n\n",
            case.name,
            head(case.name).unwrap_or_default(),
            item("Tolerance", case.reason),
            case.name
        );
        table(&mut out, "closed form", &(case.run)().map_err(failed)?);
    }
    out.push_str("\n## Closed forms of single laws\nTests of a law alone, with their comments.\n");
    of_laws(&mut out, "closed form", &analytic, &figures);
    // The page ends with what nothing validates, because a reader would otherwise take it for covered.
    out.push_str(NOT_COVERED);
    Ok(out)
}

/// What others have published and no test holds.
const NOT_COVERED: &str = "
## What is not covered
Figures and findings that others have published and no test holds, with the reason, and what is held of the same effect.

| finding | source | why not | held instead |
|---|---|---|---|
| Stick-slip of a laboratory rig: 2.6 to 2.8 Hz, ripple 1.2 to 1.4. Torque differs by 4 to 15 % between speeding up and \
slowing down | Real et al. 2018, Lobo et al. 2020 (see `val_measured_weakening_of_the_torque`) | Inertia, stiffness and \
motor of the rig are not known to us. A torque that depends on the speed alone has no such loop, and the depth of cut was \
not measured | the weakening of the torque with the speed, to 11 % |
| A string with depth of cut and delay is unstable from a gain of 1.729, 1.341 and 2.119, by delay | Aarsnes and van de \
Wouw, J. Sound Vib., 2019 | We have these figures without the equations behind them; lines with the stated damping (0.7) \
and ratio of wave speeds (1.6) that we tried have no real gain at the stated frequencies | `analytic_regeneration`: one \
mass, growth to 0.01 1/s |
| Radius that an articulated tool in a curved guide drills, against tool and weight | Wells of ultra-short radius with such \
tools (the paper's references; reviews of short-radius drilling) | What is publicly readable has planned radii and \
lengths, and for water jets a measured error of 2 to 3 degrees (SPE 21602); nowhere the guide's shape as made and its \
stiffness, the weight and the surveys of one well together (searched on 2026-11-29) | the closed form of the steady \
curvature, an own second program, and synthetic wells by other laws ([how](hole_ahead.md#how-it-is-tested)) |
| Natural frequencies of a drill pipe in fluid by hammer tests, within 2 % of a coefficient of added mass | Yang, Wang, \
Han and Xue, Mech. Sci. 10 (2019) 363 | We can read the abstract only, which has neither dimensions nor frequencies | \
`val_confined_oscillation_in_viscous_fluid`, `mud_pipe` |
| Tested cross joints transmit \"only a little below 100 per cent\" | SAE 150013 | A sentence without a figure. The \
friction of the pins is an input; with 0.1, a joint bent by 2.7 degrees transmits 99.8 % | `pin_friction` |
| Friction of 0.25 to 0.40 in water-base mud; two wells needed a coefficient per depth interval | Johancsik, Friesen and \
Dawson, SPE 11380 | Friction is an input, which `flexdrill calibrate` fits per interval of the hole and `flexdrill reach` \
varies over 0.2 to 0.4: there is no figure of ours to compare | |
| The same speed and weight can stick or run, by the start | Liu et al., Nonlinear Dyn. 90 (2017) 2959; a map of \
stability, arXiv 2206.14609 | A finding without a figure that a tool with joints could be compared with | [the safe \
window](safe_window.md#two-starts) runs every cell from two starts, and shows where they differ |
| Axial and torsional string with depth of cut, as a program | ExxonMobil's drillsim (Apache-2.0) | No package registry \
has it, and we could not obtain its source, so that it cannot be run with a pinned version | `val_soft_string_of_welleng` \
runs another program |
";

fn of_laws(out: &mut String, of: &str, laws: &[Law], figures: &Figures) {
    for law in laws {
        let _ = write!(
            out,
            "\n### {}\n{}\n\nCommand: `cargo test --release -p {} {}`\n\n",
            law.name, law.comment, law.package, law.target
        );
        table(out, of, figures.get(&law.name).map_or(&[], Vec::as_slice));
    }
}

fn table(out: &mut String, of: &str, rows: &[Row]) {
    let _ = writeln!(
        out,
        "| quantity | {of} | ours | difference | tolerance |\n|---|---|---|---|---|"
    );
    for row in rows {
        let difference = if row.error() < 0.01 * row.limit {
            format!("below {:.0e}", 0.01 * row.limit)
        } else {
            digits(row.error(), row.limit)
        };
        // What should be zero is rounding, whose digits are the machine's.
        let ours = if row.expected == 0.0 && row.error() < 0.01 * row.limit {
            format!("below {:.0e}", 0.01 * row.limit * row.scale)
        } else {
            three_digits(row.got)
        };
        let _ = writeln!(
            out,
            "| {} | {} | {ours} | {difference} | {} |",
            cell(&row.quantity),
            three_digits(row.expected),
            digits(row.limit, row.limit)
        );
    }
}

/// A number with one digit, or with two where the tolerance `limit` has more than one.
fn digits(number: f64, limit: f64) -> String {
    let one: f64 = format!("{limit:.0e}").parse().unwrap_or(limit);
    if (one / limit - 1.0).abs() < 1e-3 {
        format!("{number:.0e}")
    } else {
        format!("{number:.1e}")
    }
}

/// An item of a list in lines of 120 columns.
fn item(title: &str, text: &str) -> String {
    let mut lines = vec![format!("- {title}:")];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= 120 => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(format!("  {word}")),
        }
    }
    lines.join("\n") + "\n"
}

fn three_digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
        let decimals = (2 - rounded.abs().log10().floor() as i32).max(0) as usize;
        format!("{rounded:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map(|first| first.to_uppercase().chain(letters).collect())
        .unwrap_or_default()
}
