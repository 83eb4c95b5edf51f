//! What the largest pull and torque do with a stuck tool: at each depth of the bit, and over the string with the bit on the
//! bottom; table, picture and words.

use flexdrill_config::Config;
use flexdrill_core::units::n_to_kn;
use flexdrill_drilling::Band;
use flexdrill_plot::{Figure as Drawn, Legend, Line, Panel};
use flexdrill_text::fixed;
use flexdrill_trip::unknowns::priors;
use flexdrill_trip::{Assembly, Limits, Reached, Stuck};

use super::reached::{self, Along};
use super::{Plan, StudyError};
use crate::runs::{KeptAs, Work, run_all};

/// Figures of a plausible tool at a depth: pull and torque at the bit (N, N m), and 1 where the pull does not reach it.
const FIGURES: usize = 3;

/// A depth of the bit.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Depth of the bit below the kick-off (m).
    pub depth: f64,
    /// Of the tool as configured, or why there is nothing.
    pub stuck: Result<Stuck, String>,
    /// Pull and torque at the bit in 90 % of the plausible tools (N, N m); none of too few.
    pub at_bit: [Option<Band>; 2],
    /// Plausible tools with a result, and those of them whose bit the pull does not reach.
    pub members: [usize; 2],
}

/// The results.
#[derive(Debug, Clone, PartialEq)]
pub struct Freed {
    /// What the rig may do.
    pub limits: Limits,
    /// From the bottom up.
    pub rows: Vec<Row>,
    /// From the rig down, with the bit at the first depth; empty where nothing is known there.
    pub along: Vec<Along>,
    /// Plausible tools that were drawn.
    pub drawn: usize,
}

/// A plausible tool at all depths.
struct Run<'a> {
    assembly: Result<Assembly, String>,
    depths: &'a [f64],
    limits: &'a Limits,
}

impl Work for Run<'_> {
    /// [`FIGURES`] of each depth, not a number where there are none; then the stations with the bit at the first depth.
    type Found = Vec<f64>;

    fn cost(&self) -> f64 {
        1.0
    }

    /// A run takes less time than a file.
    fn kept_as(&self) -> Option<KeptAs> {
        None
    }

    fn run(&self, report: &mut impl FnMut(f64)) -> Result<Vec<f64>, String> {
        let assembly = self.assembly.as_ref().map_err(Clone::clone)?;
        let mut figures = Vec::with_capacity(FIGURES * self.depths.len());
        let mut along = Vec::new();
        for (index, &depth) in self.depths.iter().enumerate() {
            // A depth without a solution leaves the others as they are.
            figures.extend(match assembly.pull(depth, self.limits) {
                Ok(stuck) => {
                    if index == 0 {
                        along.extend(reached::numbers(&stuck.reached));
                    }
                    let lost = if stuck.holds_at.is_some() { 1.0 } else { 0.0 };
                    [stuck.at_bit, stuck.torque_at_bit(), lost]
                }
                Err(_) => [f64::NAN; FIGURES],
            });
            report((index + 1) as f64 / self.depths.len() as f64);
        }
        figures.append(&mut along);
        Ok(figures)
    }

    fn figures(found: &Vec<f64>) -> Vec<f64> {
        found.clone()
    }

    fn found(figures: Vec<f64>) -> Option<Vec<f64>> {
        Some(figures)
    }
}

/// Computes it for all depths of a plan, and for its plausible tools.
///
/// # Errors
/// When nothing can be computed for the configuration, or its priors cannot be drawn.
pub fn study(config: &Config, plan: &Plan, limits: Limits, progress: impl FnMut(f64)) -> Result<Freed, StudyError> {
    let assembly = Assembly::of(config)?;
    let priors = priors(config)?;
    // Plausible tools first, on threads: the ranges of all depths and stations need all of them.
    let runs: Vec<Run<'_>> = super::members(&priors, plan)
        .map(|assembly| Run {
            assembly,
            depths: &plan.depths,
            limits: &limits,
        })
        .collect();
    let found = run_all(&runs, plan.jobs, None, progress)?;
    // A tool without a solution at one depth counts at the others.
    let row = |(index, &depth): (usize, &f64)| {
        let of_depth = found
            .iter()
            .flatten()
            .filter_map(|of| of.chunks_exact(FIGURES).nth(index));
        let known: Vec<&[f64]> = of_depth.filter(|of| of[0].is_finite()).collect();
        let band = |at: usize| Band::of(known.iter().map(|of| of[at]).collect());
        Row {
            depth,
            stuck: assembly.stuck(depth, &limits).map_err(|error| error.to_string()),
            at_bit: [band(0), band(1)],
            members: [known.len(), known.iter().filter(|of| of[2] > 0.0).count()],
        }
    };
    let rows: Vec<Row> = plan.depths.iter().enumerate().map(row).collect();
    // The stations follow the figures of all depths.
    let first = FIGURES * plan.depths.len();
    let members: Vec<Vec<Reached>> = found
        .iter()
        .map(|of| reached::stations(of.as_ref().ok().and_then(|of| of.get(first..)).unwrap_or_default()))
        .collect();
    let on_bottom = rows.first().and_then(|row| row.stuck.as_ref().ok());
    let along = on_bottom.map_or_else(Vec::new, |stuck| reached::rows(&stuck.reached, &members));
    Ok(Freed {
        limits,
        along,
        rows,
        drawn: plan.members,
    })
}

impl Freed {
    /// With the bit on the bottom.
    fn on_bottom(&self) -> Option<&Stuck> {
        self.rows.first()?.stuck.as_ref().ok()
    }
}

/// A cell; empty for what is not known.
pub(super) fn cell(value: Option<f64>, digits: usize) -> String {
    value
        .filter(|value| value.is_finite())
        .map_or_else(String::new, |value| fixed(value, digits))
}

/// The table by depth of the bit.
pub fn csv(freed: &Freed) -> String {
    let mut out = "bit_depth_m,pull_kn,pull_at_bit_kn,torque_at_bit_nm,holds_at_m,critical_friction_factor,\
                   pull_at_bit_low_kn,pull_at_bit_high_kn,torque_at_bit_low_nm,torque_at_bit_high_nm,tools_not_reached,\
                   tools_unknown,cause\n"
        .to_owned();
    for row in &freed.rows {
        let mut line = vec![fixed(row.depth, 4)];
        let [pull, torque] = row.at_bit;
        let ends = |band: Option<Band>| [band.map(|band| band.low), band.map(|band| band.high)];
        let [known, lost] = row.members;
        let mut of_members: Vec<String> = ends(pull).map(|end| cell(end.map(n_to_kn), 4)).to_vec();
        of_members.extend(ends(torque).map(|end| cell(end, 2)));
        of_members.extend([lost.to_string(), (freed.drawn - known).to_string()]);
        match &row.stuck {
            Ok(stuck) => line.extend([
                cell(Some(n_to_kn(stuck.pull)), 4),
                cell(Some(n_to_kn(stuck.at_bit)), 4),
                cell(Some(stuck.torque_at_bit()), 2),
                cell(stuck.holds_at, 3),
                cell(stuck.critical_factor, 4),
            ]),
            Err(_) => line.extend(vec![String::new(); 5]),
        }
        line.extend(of_members);
        let cause = row.stuck.as_ref().err();
        line.push(cause.map_or_else(String::new, |cause| format!("\"{}\"", cause.replace('"', "\"\""))));
        out.push_str(&line.join(","));
        out.push('\n');
    }
    out
}

/// Pull and overpull along string and tool with the bit on the bottom, and the pull at the bit over its depth.
pub fn figure(freed: &Freed) -> Drawn {
    let along = |title: &str, x: &str, of_tool: bool| {
        // The tool's top is the last station at or above the kick-off, where the bit is on the bottom.
        let stations = || {
            let within = move |row: &&Along| {
                let depth = row.at.depth;
                if of_tool { depth >= 0.0 } else { depth <= 0.0 }
            };
            freed.along.iter().filter(within)
        };
        let points = |of: &dyn Fn(&Along) -> Option<f64>| -> Vec<(f64, f64)> {
            let known = stations().filter_map(|row| Some((row.at.depth, of(row)?)));
            known.map(|(depth, force)| (depth, n_to_kn(force))).collect()
        };
        let mut panel = Panel::new(title, x, "kN").legend(Legend::Stacked);
        // Ranges come first: they would cover the curves.
        for index in [0, 1] {
            let low = points(&|row| Some(row.bands[index]?.low));
            let high = points(&|row| Some(row.bands[index]?.high));
            if low.len() > 1 {
                let around = high.into_iter().chain(low.into_iter().rev()).collect();
                panel = panel.line(Line::new("", around).area().color(index));
            }
        }
        panel
            .line(Line::new("pull that arrives", points(&|row| Some(row.at.tension))).color(0))
            .line(Line::new("beyond what slides out freely", points(&|row| Some(row.at.overpull))).color(1))
    };
    let below = "measured depth below the kick-off (m)";
    let at_bit = freed.rows.iter().filter_map(|row| {
        let stuck = row.stuck.as_ref().ok()?;
        Some((row.depth, n_to_kn(stuck.at_bit)))
    });
    let end = |of: fn(&Band) -> f64| -> Vec<(f64, f64)> {
        let bands = freed
            .rows
            .iter()
            .filter_map(|row| Some((row.depth, row.at_bit[0].as_ref()?)));
        bands.map(|(depth, band)| (depth, n_to_kn(of(band)))).collect()
    };
    let mut over_depth = Panel::new("Pull at the bit", "depth of the bit below the kick-off (m)", "kN")
        .from_zero()
        .span(2)
        .legend(Legend::Stacked)
        .line(Line::new("of the largest pull", at_bit.collect()).color(0));
    for (name, points) in [
        ("5 % of the plausible tools are below", end(|band| band.low)),
        ("5 % are above", end(|band| band.high)),
    ] {
        if points.len() > 1 {
            over_depth = over_depth.line(Line::new(name, points).color(1));
        }
    }
    let mut panels = vec![
        along("Along the string", "measured depth from the kick-off (m)", false),
        along("Along the tool", below, true),
        over_depth,
    ];
    // A tool without a string has one point above the kick-off.
    panels.retain(|panel| panel.lines.iter().any(|line| line.points.len() > 1));
    Drawn {
        name: "stuck",
        title: "What reaches a stuck tool".to_owned(),
        caption: "The largest pull along string and tool with the bit on the bottom, and at the bit over its depth"
            .to_owned(),
        columns: 2,
        height: 420,
        panels,
    }
}

/// A range in words, with its unit.
fn in_range(band: Option<Band>, digits: usize, shown: impl Fn(f64) -> f64) -> String {
    band.map_or_else(String::new, |band| {
        format!(" ({:.digits$} to {:.digits$})", shown(band.low), shown(band.high))
    })
}

/// The depth at which the least pull arrives, where that is not the bottom; none where it is.
fn weakest(freed: &Freed) -> Option<String> {
    let known = freed
        .rows
        .iter()
        .filter_map(|row| Some((row, row.stuck.as_ref().ok()?)));
    let (row, stuck) = known.min_by(|a, b| a.1.at_bit.total_cmp(&b.1.at_bit))?;
    let bottom = freed.on_bottom()?;
    // A tenth of a kilonewton is what words show.
    (n_to_kn(bottom.at_bit - stuck.at_bit) >= 0.1).then(|| {
        format!(
            "Least arrives with the bit at {:.2} m: {:.1} kN{}.",
            row.depth,
            n_to_kn(stuck.at_bit),
            in_range(row.at_bit[0], 1, n_to_kn)
        )
    })
}

/// The results in words, a line each.
pub fn words(freed: &Freed) -> Vec<String> {
    let mut lines = Vec::new();
    let Some(stuck) = freed.on_bottom() else {
        let cause = freed.rows.first().and_then(|row| row.stuck.as_ref().err());
        lines.extend(cause.map(|cause| format!("Unknown what reaches a stuck tool: {cause}")));
        return lines;
    };
    // Which limit decides comes first: more pull at the rig helps only where the guide does not end it.
    let limit = if stuck.guide_limits {
        format!(
            "which brings the guide's top to its {:.1} kN",
            n_to_kn(freed.limits.guide.unwrap_or(f64::NAN))
        )
    } else {
        "the rig's limit".to_owned()
    };
    let pull = n_to_kn(stuck.pull);
    let [at_bit, torque_at_bit] = freed.rows.first().map_or([None; 2], |row| row.at_bit);
    lines.push(match stuck.holds_at {
        None => format!(
            "Stuck at {:.2} m: of a hook load of {pull:.1} kN, {limit}, {:.1} kN{} pull at the bit.",
            stuck.depth,
            n_to_kn(stuck.at_bit),
            in_range(at_bit, 1, n_to_kn)
        ),
        Some(at) => format!(
            "Stuck at {:.2} m: a hook load of {pull:.1} kN, {limit}, does not reach the bit. Friction takes all of it down to a \
             measured depth of {at:.2} m; nothing of it arrives deeper.",
            stuck.depth
        ),
    });
    let [known, lost] = freed.rows.first().map_or([0; 2], |row| row.members);
    if lost > 0 {
        lines.push(format!(
            "In {lost} of {known} plausible tools the pull does not reach the bit."
        ));
    }
    lines.extend(weakest(freed));
    // Torque by itself: the pull that presses the string into the bends would take more of it.
    lines.push(match stuck.turns_to {
        None => format!(
            "Of {:.0} N m at the top drive {:.0}{} N m arrive at the bit while nothing moves along the hole.",
            freed.limits.torque,
            stuck.torque_at_bit(),
            in_range(torque_at_bit, 0, |torque| torque)
        ),
        Some(at) => format!(
            "{:.0} N m at the top drive do not turn the bit: friction takes all of them down to a measured depth of {at:.2} m.",
            freed.limits.torque
        ),
    });
    // The reserve against a hole that becomes worse.
    lines.push(match stuck.critical_factor {
        Some(factor) if factor <= 0.0 => {
            "Even without friction this pull lifts less than hangs: it frees nothing.".to_owned()
        }
        Some(factor) => format!(
            "Friction {factor:.2} times as large as configured takes all of this pull on the way to the bit: from there on \
             pulling frees nothing at the bit."
        ),
        None => format!(
            "Friction {:.1} times as large as configured, the largest that was computed, does not take this pull.",
            stuck.tried_factor
        ),
    });
    lines.push(
        "This is the pull that arrives, and not what it takes to free the tool: differential sticking, a bed of cuttings and key \
         seats hold with forces that no measurement here knows. Pull and torque together strain the pipe more than each alone."
            .to_owned(),
    );
    lines
}
