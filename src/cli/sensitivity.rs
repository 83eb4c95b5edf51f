//! `flexdrill sensitivity`: what each uncertain key of a configuration moves, one at a time.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::progress::Progress;
use super::{WrongUse, built_in, numbers, priors as named, whole_file};
use crate::cli::output::say;
use crate::runs::Kept;
use crate::sensitivity::{Load, picture, study, table};
use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};
use flexdrill_text::counted;
use flexdrill_uncertainty::Priors;
use flexdrill_uncertainty::effects::FILE;

/// Computes what each uncertain key of a configuration moves, at 5 % and at 95 % of its distribution with all others as
/// configured, and writes sensitivity.csv, sensitivity.svg and sensitivity.json. `flexdrill check` shows the effects.
#[derive(Debug, Args)]
pub struct SensitivityArgs {
    /// The configuration, with the section `uncertainty` (YAML).
    config: PathBuf,
    /// Folder for the results, created if necessary. Default: next to the configuration, its name with `_sensitivity`,
    /// where `flexdrill check` looks for them.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Rotary speed (r/min).
    #[arg(long, default_value_t = 40.0, value_parser = numbers::drilling_rpm)]
    rpm: f64,
    /// Weight on bit (kN): at the surface above a hoist, otherwise as boundary.weight_on_bit_at says.
    #[arg(long, default_value_t = 10.0, value_parser = numbers::kilonewton)]
    wob: f64,
    /// Model time of a run (s), of which the second half is measured.
    #[arg(long, default_value_t = 40.0, value_parser = numbers::seconds)]
    seconds: f64,
    /// Keeps every run that is done in the folder `points` of the results, and takes those that are there: the same command
    /// continues an interrupted study.
    #[arg(long)]
    resume: bool,
    /// Runs at the same time, one thread each. The results do not depend on it.
    #[arg(long, default_value_t = 1, value_parser = numbers::jobs())]
    jobs: usize,
}

/// Runs the subcommand.
///
/// # Errors
/// When the configuration is refused or has no priors, or a file cannot be written. A run that fails is part of the
/// results.
pub fn run(args: &SensitivityArgs) -> anyhow::Result<()> {
    let (config, _) = built_in::load(&args.config)?;
    let load = load(args, &config)?;
    // As a run records it: with the checksum of the sample of a calibration, where one is named.
    let (config, posterior) = crate::ensemble::named_by(&config, &args.config)?;
    let mut priors = Priors::of(&config)?;
    if let Some(posterior) = &posterior {
        priors = priors.drawn_from(posterior)?;
    }
    anyhow::ensure!(
        !priors.entries().is_empty(),
        "{}: uncertainty.keys is empty: nothing is uncertain, and nothing is computed",
        args.config.display()
    );
    let out = args.out.clone().unwrap_or_else(|| named::folder(&args.config));
    std::fs::create_dir_all(&out).with_context(|| format!("cannot create {}", out.display()))?;
    // Runs that an interrupted study has left are not made again.
    let kept = args.resume.then(|| Kept::open(&out.join("points"))).transpose()?;
    let mut progress = Progress::share();
    let effects = study(config.hash(), &priors, &load, args.jobs, kept.as_ref(), |share| {
        progress.at(share)
    })?;
    progress.done();
    let svg = flexdrill_plot::sheet(&picture::figure(&effects))?;
    whole_file::write(&out, "sensitivity.csv", &table::csv(&effects))?;
    whole_file::write(&out, "sensitivity.svg", &svg)?;
    whole_file::write(&out, FILE, &effects.to_json()?)?;
    for line in table::words(&effects) {
        say!("{line}");
    }
    say!(
        "{} in {:.0} s: {}, sensitivity.svg and {FILE}",
        counted(effects.rows.len() as u64 + 3, "run"),
        progress.elapsed(),
        out.join("sensitivity.csv").display()
    );
    if let Some(posterior) = &posterior {
        say!("{}", named::posterior(posterior));
    }
    anyhow::ensure!(
        effects.outputs.iter().any(|output| output.nominal.is_some()),
        "the run with all keys as configured failed, so that no change is known"
    );
    Ok(())
}

/// The load of the runs, SI.
fn load(args: &SensitivityArgs, config: &Config) -> Result<Load, WrongUse> {
    let (speed, weight) = (&config.inputs.rotary_speed, &config.inputs.weight_on_bit);
    if !(speed.min_rpm..=speed.max_rpm).contains(&args.rpm) {
        return Err(WrongUse::new(format!(
            "--rpm {} r/min: must be within inputs.rotary_speed, {} to {} r/min",
            args.rpm, speed.min_rpm, speed.max_rpm
        )));
    }
    if !(weight.min_kn..=weight.max_kn).contains(&args.wob) {
        return Err(WrongUse::new(format!(
            "--wob {} kN: must be within inputs.weight_on_bit, {} to {} kN",
            args.wob, weight.min_kn, weight.max_kn
        )));
    }
    Ok(Load {
        speed: rpm_to_rad_per_s(args.rpm),
        weight: kn_to_n(args.wob),
        seconds: args.seconds,
    })
}
