//! `flexdrill reach`: torque and weight at the bit against the length of the hole.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::progress::Progress;
use super::{WrongUse, built_in, numbers, priors as priors_in_words, whole_file};
use crate::cli::output::{say, tell};
use crate::reach::plausible::{self, Drawn};
use crate::reach::{Load, Plan, picture, study, table};
use crate::runs::Kept;
use flexdrill_config::{Config, Law};
use flexdrill_core::tool::FrictionLaw;
use flexdrill_core::units::{kn_to_n, m_per_h_to_m_per_s, rpm_to_rad_per_s};
use flexdrill_text::counted;
use flexdrill_uncertainty::Priors;

/// Computes torque and weight at the bit against the length of the hole, with rotation and without, and writes them as
/// reach.csv and reach.svg.
#[derive(Debug, Args)]
pub struct ReachArgs {
    /// The tool and the beginning of its hole (YAML); both go on straight, by links of the same length.
    config: PathBuf,
    /// Folder for the results, created if necessary.
    #[arg(long)]
    out: PathBuf,
    /// Lengths of the hole from the kick-off, arc included (m), each to the nearest whole link.
    #[arg(long, value_delimiter = ',', value_parser = numbers::length, default_value = "5,10,15,20,30,40,50,60")]
    lengths: Vec<f64>,
    /// Friction coefficients, of pipe and guide and of guide and wall, around and along.
    #[arg(long, value_delimiter = ',', value_parser = numbers::friction, default_value = "0.2,0.3,0.4")]
    friction: Vec<f64>,
    /// Rotary speed of the points with rotation (r/min).
    #[arg(long, default_value_t = 40.0, value_parser = numbers::drilling_rpm)]
    rpm: f64,
    /// Weight put in (kN): at the surface above a hoist, otherwise at the kick-off.
    #[arg(long, default_value_t = 10.0, value_parser = numbers::kilonewton)]
    wob: f64,
    /// Rate of penetration (m/h) of a tool without a hoist; a hoist finds its own.
    #[arg(long, default_value_t = 3.0, value_parser = numbers::advance)]
    advance: f64,
    /// Plausible tools too, drawn as `ensemble.from` of the configuration says: 90 % of what arrives at their bits, in
    /// reach_plausible.csv. Each has a run for each length, with rotation and without.
    #[arg(long)]
    plausible: bool,
    /// Plausible tools for each length; fewer than 19 have no band.
    #[arg(long, default_value_t = 19, value_parser = numbers::members(), requires = "plausible")]
    members: usize,
    /// Seed of the draws: the same seed gives the same results.
    #[arg(long, default_value_t = 1, requires = "plausible")]
    seed: u64,
    /// Longest model time of a run (s); one that is not steady by then is unknown.
    #[arg(long, default_value_t = 60.0, value_parser = numbers::seconds)]
    seconds: f64,
    /// Keeps every point that is done in the folder `points` of --out, and takes those that are there: the same command
    /// continues an interrupted study.
    #[arg(long)]
    resume: bool,
    /// Runs at the same time, one thread each. The results do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = numbers::jobs())]
    jobs: usize,
}

/// Fewest links of a tool: one joint.
const FEWEST_LINKS: usize = 2;
/// Most links that a configuration may have.
const MOST_LINKS: usize = 500;

/// Runs the subcommand.
///
/// # Errors
/// When the configuration is refused or cannot be lengthened as asked, or a file cannot be written. A run without a
/// steady result is part of the results.
pub fn run(args: &ReachArgs) -> anyhow::Result<()> {
    let (config, _) = built_in::load(&args.config)?;
    let plan = plan(args, &config)?;
    // A sample that does not fit is refused before minutes are computed.
    let drawn = args.plausible.then(|| drawn(args, &config)).transpose()?;
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    if config.contact.outer.friction == FrictionLaw::Separate {
        tell!(
            "warning: contact.outer.friction is separate: the wall's friction on a guide that advances slowly is far too \
             small; choose bristle"
        );
    }
    // The configured tool first, then plausible ones, whose runs take the most time.
    let mut progress = Progress::share();
    let kept = args.resume.then(|| Kept::open(&args.out.join("points"))).transpose()?;
    let rows = study(&config, &plan, kept.as_ref(), |share| progress.at(share))?;
    progress.done();
    let mut arrives = Vec::new();
    if let Some((drawn, _)) = &drawn {
        let mut progress = Progress::share();
        arrives = plausible::study(&config, drawn, &plan, kept.as_ref(), |share| progress.at(share))?;
        progress.done();
        whole_file::write(&args.out, "reach_plausible.csv", &plausible::csv(&arrives))?;
    }
    whole_file::write(&args.out, "reach.csv", &table::csv(&rows))?;
    whole_file::write(
        &args.out,
        "reach.svg",
        &flexdrill_plot::sheet(&picture::figure(&plan, &rows, &arrives))?,
    )?;
    // In words what is in the files.
    for line in table::words(&plan, &rows) {
        say!("{line}");
    }
    if let Some((_, from)) = &drawn {
        for line in plausible::words(&arrives).iter().chain([from]) {
            say!("{line}");
        }
    }
    say!(
        "{} in {:.0} s: {} and {}",
        counted(rows.len() as u64, "run"),
        progress.elapsed(),
        args.out.join("reach.csv").display(),
        args.out.join("reach.svg").display()
    );
    anyhow::ensure!(
        rows.iter().any(|row| row.found.is_ok()),
        "no run became steady; the table has the causes"
    );
    Ok(())
}

/// Which plausible tools, and what they are drawn from, in words.
fn drawn(args: &ReachArgs, config: &Config) -> anyhow::Result<(Drawn, String)> {
    let (config, posterior) = crate::ensemble::named_by(config, &args.config)?;
    let mut priors = Priors::of(&config)?;
    if priors.is_empty() {
        let why = "--plausible: the configuration has no section uncertainty, so that all tools would be one; leave \
                   --plausible out, or state what is not known (config/rig.yaml has an example)";
        return Err(WrongUse::new(why).into());
    }
    let from = match posterior {
        Some(posterior) => {
            priors = priors.drawn_from(&posterior)?;
            priors_in_words::posterior(&posterior)
        }
        None => "Plausible tools are drawn from uncertainty of the configuration, without a calibration.".to_owned(),
    };
    let drawn = Drawn {
        priors,
        members: args.members,
        seed: args.seed,
    };
    Ok((drawn, from))
}

fn plan(args: &ReachArgs, config: &Config) -> anyhow::Result<Plan> {
    // A tool has whole links. Lengths that round to the same tool are computed once.
    let link = config.link_length();
    let mut links = Vec::new();
    for &length in &args.lengths {
        let count = (length / link).round() as usize;
        if !(FEWEST_LINKS..=MOST_LINKS).contains(&count) {
            let why = format!(
                "--lengths: {length} m are {count} links of {link:.4} m: must be {:.2} to {:.2} m, {FEWEST_LINKS} to \
                 {MOST_LINKS} links",
                FEWEST_LINKS as f64 * link,
                MOST_LINKS as f64 * link
            );
            return Err(WrongUse::new(why).into());
        }
        links.push(count);
    }
    links.sort_unstable();
    links.dedup();
    // Equal values would be the same runs twice.
    let mut frictions = args.friction.clone();
    frictions.sort_by(f64::total_cmp);
    frictions.dedup();
    let (speed, weight) = (&config.inputs.rotary_speed, &config.inputs.weight_on_bit);
    if args.rpm > speed.max_rpm {
        let why = format!(
            "--rpm {} r/min: must be at most inputs.rotary_speed.max_rpm, {} r/min",
            args.rpm, speed.max_rpm
        );
        return Err(WrongUse::new(why).into());
    }
    // Without weight nothing is transferred, and the share at the bit is undefined.
    if !(args.wob > 0.0 && (weight.min_kn..=weight.max_kn).contains(&args.wob)) {
        let why = format!(
            "--wob {} kN: must be above 0 kN and within inputs.weight_on_bit, {} to {} kN",
            args.wob, weight.min_kn, weight.max_kn
        );
        return Err(WrongUse::new(why).into());
    }
    // Checked here and not in the runs: each would fail at its start, after the others had been paid for.
    anyhow::ensure!(
        config.rock.law == Law::DepthOfCut || config.boundary.preset == flexdrill_config::Preset::Paper,
        "boundary.preset: none: reach needs the support of the guide at the kick-off, which the preset `paper` has"
    );
    // From here on all values are SI.
    Ok(Plan {
        links,
        frictions,
        load: Load {
            speed: rpm_to_rad_per_s(args.rpm),
            weight: kn_to_n(args.wob),
            advance: m_per_h_to_m_per_s(args.advance),
            longest: args.seconds,
        },
        jobs: args.jobs,
    })
}
