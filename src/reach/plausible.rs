//! Reach of plausible tools: 90 % of what arrives at their bits.
//!
//! A member is a draw of what is not known of the tool and its rig, lengthened as the tool of the configuration is, with its own
//! friction: it runs under what the drawn sensors make of the load that the rig shows.

use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::units::n_to_kn;
use flexdrill_drilling::Band;
use flexdrill_text::counted;
use flexdrill_uncertainty::{Priors, Readings};

use super::{Load, Loaded, Plan, Point};
use crate::runs::{KeepError, Kept, run_all};

/// Which plausible tools.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// What they are drawn from.
    pub priors: Priors,
    /// How many for each point.
    pub members: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// What arrives at the bits of plausible tools in a hole.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrives {
    /// Length of the hole from the kick-off (m).
    pub length: f64,
    /// Links.
    pub links: usize,
    /// Whether the tools rotate.
    pub rotates: bool,
    /// Weight at the bit (N); none of too few.
    pub weight: Option<Band>,
    /// Torque at the kick-off and at the bit (N m), likewise.
    pub torque: [Option<Band>; 2],
    /// Tools with a steady result.
    pub known: usize,
    /// Tools without one, and why the first of them has none.
    pub unknown: usize,
    /// Empty where all are known.
    pub cause: String,
}

/// A tool in a hole under its load, or why there is none.
type Member = Result<(Point, Load), String>;

impl Drawn {
    /// The member of a number in a hole of `links` links.
    fn member(&self, number: usize, links: usize, rotates: bool, load: &Load) -> Member {
        let drawn = self
            .priors
            .member(self.seed, number as u64)
            .map_err(|error| error.to_string())?;
        let acts = Readings::of(&drawn).acting_inputs(Inputs {
            rotary_speed: load.speed,
            weight_on_bit: load.weight,
            ..Inputs::default()
        });
        let load = Load {
            speed: acts.rotary_speed,
            weight: acts.weight_on_bit,
            ..*load
        };
        if load.weight <= 0.0 {
            return Err("no weight acts where this rig shows the weight that is put in".to_owned());
        }
        let point = Point::as_it_is(&drawn.config, links, rotates, &load).map_err(|error| error.to_string())?;
        Ok((point, load))
    }
}

/// Runs the plausible tools of all lengths, with rotation and without, in the order of lengths.
///
/// # Errors
/// When a run cannot be kept.
pub fn study(
    config: &Config,
    drawn: &Drawn,
    plan: &Plan,
    kept: Option<&Kept>,
    progress: impl FnMut(f64),
) -> Result<Vec<Arrives>, KeepError> {
    let holes: Vec<(usize, bool)> = plan
        .links
        .iter()
        .flat_map(|links| [true, false].map(|rotates| (*links, rotates)))
        .collect();
    let members: Vec<Member> = holes
        .iter()
        .flat_map(|(links, rotates)| {
            (0..drawn.members).map(|number| drawn.member(number, *links, *rotates, &plan.load))
        })
        .collect();
    let numbered = members.iter().enumerate();
    let runs: Vec<Loaded<'_>> = numbered
        .filter_map(|(index, member)| {
            let (point, load) = member.as_ref().ok()?;
            Some(Loaded {
                point,
                load,
                member: Some(index % drawn.members),
            })
        })
        .collect();
    let mut found = run_all(&runs, plan.jobs, kept, progress)?.into_iter();
    let link = config.link_length();
    let mut rows = Vec::with_capacity(holes.len());
    for ((links, rotates), members) in holes.into_iter().zip(members.chunks(drawn.members)) {
        let mut results = Vec::with_capacity(members.len());
        for member in members {
            // Each member that could be made has a run, in their order.
            results.push(match member {
                Ok(_) => found
                    .next()
                    .unwrap_or_else(|| Err("the run did not take place".to_owned())),
                Err(cause) => Err(cause.clone()),
            });
        }
        let known: Vec<_> = results.iter().flatten().collect();
        let cause = results.iter().find_map(|result| result.as_ref().err());
        rows.push(Arrives {
            length: links as f64 * link,
            links,
            rotates,
            weight: Band::of(known.iter().map(|found| found.weight[1]).collect()),
            torque: [0, 1].map(|end| Band::of(known.iter().map(|found| found.torque[end]).collect())),
            known: known.len(),
            unknown: results.len() - known.len(),
            cause: cause.cloned().unwrap_or_default(),
        });
    }
    Ok(rows)
}

const COLUMNS: &str = "length_m,links,rotates,known,unknown,weight_at_bit_low_kn,weight_at_bit_median_kn,\
                       weight_at_bit_high_kn,torque_at_kickoff_low_nm,torque_at_kickoff_median_nm,\
                       torque_at_kickoff_high_nm,torque_at_bit_low_nm,torque_at_bit_median_nm,torque_at_bit_high_nm,cause\n";

/// The table. `low` and `high` are the ends of 90 %; cells are empty where too few tools are known for a band.
pub fn csv(rows: &[Arrives]) -> String {
    let mut out = COLUMNS.to_owned();
    for row in rows {
        let ends = |band: Option<Band>, unit: fn(f64) -> f64| match band {
            Some(band) => [band.low, band.median, band.high].map(|value| format!("{:.6}", unit(value))),
            None => [const { String::new() }; 3],
        };
        let mut cells = vec![
            format!("{:.6}", row.length),
            row.links.to_string(),
            row.rotates.to_string(),
            row.known.to_string(),
            row.unknown.to_string(),
        ];
        cells.extend(ends(row.weight, n_to_kn));
        cells.extend(row.torque.into_iter().flat_map(|band| ends(band, |torque| torque)));
        cells.push(match row.cause.as_str() {
            "" => String::new(),
            cause => format!("\"{}\"", cause.replace('"', "\"\"")),
        });
        out.push_str(&cells.join(","));
        out.push('\n');
    }
    out
}

/// The bands in words, a line for each length.
pub fn words(rows: &[Arrives]) -> Vec<String> {
    let mut lines = vec!["In 90 % of the plausible tools:".to_owned()];
    let range = |band: Option<Band>, unit: &str, of: fn(f64) -> f64| match band {
        Some(band) => format!(
            "{:.2} ({:.2} to {:.2}) {unit}",
            of(band.median),
            of(band.low),
            of(band.high)
        ),
        None => format!("no band of fewer than {}", Band::LEAST),
    };
    for row in rows {
        let turns = if row.rotates {
            "with rotation"
        } else {
            "without rotation"
        };
        let torque = match row.rotates {
            true => format!("torque at the bit {}, ", range(row.torque[1], "N m", |torque| torque)),
            false => String::new(),
        };
        let unknown = match row.unknown {
            0 => String::new(),
            unknown => format!(" ({unknown} more unknown: {})", row.cause),
        };
        lines.push(format!(
            "{:6.2} m {turns}: {torque}weight at the bit {}, of {}{unknown}.",
            row.length,
            range(row.weight, "kN", n_to_kn),
            counted(row.known as u64, "tool")
        ));
    }
    lines
}
