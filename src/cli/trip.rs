//! `flexdrill trip`: hook load and torque over the depth of the bit, and what reaches a stuck tool.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::progress::Progress;
use super::{WrongUse, built_in, numbers, whole_file};
use crate::cli::output::say;
use crate::trip::{Plan, picture, reached, stuck, study, table, words};
use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_text::counted;
use flexdrill_trip::{Assembly, Limits};

/// Computes hook load and torque of pulling out and running in over the depth of the bit, with rotation and without, with the
/// range of plausible tools, and writes them as trip.csv and trip.svg. With a largest pull, what of it and of the largest
/// torque reaches a stuck tool, as stuck.csv, stuck.svg and reached.csv.
///
/// Depths count from the kick-off; the bit moves from the bottom of the configured hole to the kick-off.
#[derive(Debug, Args)]
pub struct TripArgs {
    /// The tool in its hole, with the string above it (YAML).
    config: PathBuf,
    /// Folder for the results, created if necessary.
    #[arg(long)]
    out: PathBuf,
    /// Distance between two depths of the bit (m).
    #[arg(long, default_value_t = 0.5, value_parser = numbers::distance)]
    every: f64,
    /// Speed along the hole (m/s).
    #[arg(long, default_value_t = 0.1, value_parser = numbers::trip_speed)]
    speed: f64,
    /// Rotary speed of the loads with rotation (r/min).
    #[arg(long, default_value_t = 40.0, value_parser = numbers::drilling_rpm)]
    rpm: f64,
    /// Largest hook load without the block (kN) to free a stuck tool; string.largest_pull_kn by default.
    #[arg(long, value_parser = numbers::pull)]
    max_pull: Option<f64>,
    /// Largest tension of the guide at its top (kN); string.largest_guide_pull_kn by default.
    #[arg(long, value_parser = numbers::pull)]
    max_guide_pull: Option<f64>,
    /// Largest torque at the rig (N m); string.top_drive.torque_limit by default.
    #[arg(long, value_parser = numbers::torque)]
    max_torque: Option<f64>,
    /// Plausible tools, drawn from what is not known.
    #[arg(long, default_value_t = 100, value_parser = numbers::members())]
    members: usize,
    /// Seed of the draws: the same seed gives the same results.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Tools computed at the same time, one thread each. The results do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = numbers::jobs())]
    jobs: usize,
}

/// Most depths of a trip.
const MOST_DEPTHS: f64 = 2000.0;

/// Runs the subcommand.
///
/// # Errors
/// When the configuration is refused, nothing can be computed for it, or a file cannot be written. A depth without a result is
/// part of the results.
pub fn run(args: &TripArgs) -> anyhow::Result<()> {
    let (config, name) = built_in::load(&args.config)?;
    let assembly = Assembly::of(&config).with_context(|| name.clone())?;
    let plan = plan(args, &config, &assembly)?;
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot create {}", args.out.display()))?;
    let mut progress = Progress::share();
    let rows = study(&config, &plan, |share| progress.at(share)).with_context(|| name.clone())?;
    progress.done();
    whole_file::write(&args.out, "trip.csv", &table::csv(&rows))?;
    whole_file::write(&args.out, "trip.svg", &flexdrill_plot::sheet(&picture::figure(&rows))?)?;
    let limits = limits(args, &config);
    let freed = match limits {
        Some(limits) => Some(stuck::study(&config, &plan, limits, |_| ()).with_context(|| name.clone())?),
        None => None,
    };
    if let Some(freed) = &freed {
        whole_file::write(&args.out, "stuck.csv", &stuck::csv(freed))?;
        whole_file::write(&args.out, "reached.csv", &reached::csv(&freed.along))?;
        whole_file::write(&args.out, "stuck.svg", &flexdrill_plot::sheet(&stuck::figure(freed))?)?;
    }
    for line in words::words(&config, &plan, &rows, assembly.tool().as_built) {
        say!("{line}");
    }
    for line in freed.iter().flat_map(stuck::words) {
        say!("{line}");
    }
    if freed.is_none() {
        say!("What frees a stuck tool is not computed: give --max-pull or string.largest_pull_kn.");
    }
    say!(
        "{} in {:.1} s: {} and trip.svg",
        counted(rows.len() as u64, "depth"),
        progress.elapsed(),
        args.out.join("trip.csv").display()
    );
    anyhow::ensure!(
        rows.iter().any(|row| row.nominal.is_ok()),
        "no depth has a result; the table has the causes"
    );
    Ok(())
}

/// Limits of the rig, SI; none without a largest pull.
fn limits(args: &TripArgs, config: &Config) -> Option<Limits> {
    let string = &config.string;
    Some(Limits {
        pull: kn_to_n(args.max_pull.or(string.largest_pull_kn)?),
        guide: args.max_guide_pull.or(string.largest_guide_pull_kn).map(kn_to_n),
        torque: args.max_torque.unwrap_or(string.top_drive.torque_limit),
    })
}

/// What is asked, SI.
fn plan(args: &TripArgs, config: &Config, assembly: &Assembly) -> Result<Plan, WrongUse> {
    let most = config.inputs.rotary_speed.max_rpm;
    if args.rpm > most {
        return Err(WrongUse::new(format!(
            "--rpm {} r/min: must be at most inputs.rotary_speed.max_rpm, {most} r/min",
            args.rpm
        )));
    }
    let [least, bottom] = assembly.depths();
    let steps = ((bottom - least) / args.every).floor();
    if steps > MOST_DEPTHS {
        return Err(WrongUse::new(format!(
            "--every {} m: must be at least {:.3} m, so that the {:.2} m of the hole have at most {MOST_DEPTHS} depths",
            args.every,
            (bottom - least) / MOST_DEPTHS,
            bottom - least
        )));
    }
    let mut depths: Vec<f64> = (0..=steps as usize)
        .map(|step| bottom - step as f64 * args.every)
        .collect();
    // The trip ends at the kick-off, whatever the distance leaves.
    if depths.last().is_some_and(|last| last - least > 1e-6) {
        depths.push(least);
    }
    Ok(Plan {
        depths,
        along: args.speed,
        spin: rpm_to_rad_per_s(args.rpm),
        members: args.members,
        seed: args.seed,
        jobs: args.jobs,
    })
}
