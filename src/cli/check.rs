//! `flexdrill check CONFIG`: reads a configuration, and prints a summary or every problem in it.

use std::f64::consts::TAU;
use std::fmt;
use std::path::PathBuf;

use clap::Args;

use super::drills::Drills;
use super::{built_in, priors};
use crate::cli::output::{say, say_text};
use flexdrill_config::{Config, Law};
use flexdrill_core::tool::{JointKind, TorsionalMode};
use flexdrill_core::units::kn_to_n;
use flexdrill_uncertainty::Priors;

/// Checks a configuration file and prints a summary, with what is not known of its tool.
#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// The configuration file (YAML).
    #[arg(required_unless_present = "schema")]
    config: Option<PathBuf>,
    /// Print the complete configuration, defaults included, instead of the summary.
    #[arg(long)]
    full: bool,
    /// Print the JSON Schema of configurations, for editors, and check no file.
    #[arg(long, conflicts_with_all = ["config", "full"])]
    schema: bool,
}

/// # Errors
/// When the configuration is refused; the error lists every problem.
pub(super) fn run(args: &CheckArgs) -> anyhow::Result<()> {
    let Some(path) = &args.config else {
        say!("{}", serde_json::to_string_pretty(&flexdrill_config::json_schema())?);
        return Ok(());
    };
    let (config, name) = built_in::load(path)?;
    if args.full {
        say_text!("{}", config.to_yaml()?);
    } else {
        let drills = Drills::of(&config, &name, path)?;
        say_text!("{}", Summary(&config, &drills));
        let known = Priors::of(&config)?;
        // Effects are those of the sample of a calibration, where one is named.
        let (recorded, posterior) = crate::ensemble::named_by(&config, path)?;
        for line in priors::lines(&known, path, &recorded.hash()) {
            say!("{line}");
        }
        // A node would refuse what is refused here.
        crate::ensemble::band_factors(&config)?;
        if let Some(posterior) = posterior {
            known.drawn_from(&posterior)?;
            say!("{}", priors::posterior(&posterior));
        }
    }
    Ok(())
}

struct Summary<'a>(&'a Config, &'a Drills);

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A value is formatted as one string first, so that all rows share the width of the names.
        let config = self.0;
        let tool = &config.tool;
        let mut row = |name: &str, value: String| writeln!(f, "{name:<16} {value}");
        if !config.run.title.is_empty() {
            row("title", config.run.title.clone())?;
        }
        let end = config.well.end_inclination_deg();
        row(
            "well",
            format!(
                "{:.3} m, inclination {:.1} to {end:.1} deg, hole {:.1} mm",
                config.well.length(),
                config.well.start_inclination_deg,
                config.well.hole_diameter * 1e3
            ),
        )?;
        row(
            "links",
            format!(
                "{} of {:.4} m with {} elements; {:.2} deg of build per joint, limit {} deg, {}",
                tool.links,
                config.link_length(),
                tool.elements_per_link,
                config.build_angle_per_link_deg(),
                tool.joint.limit_deg,
                joint_name(tool.joint.kind),
            ),
        )?;
        row(
            "clearance",
            format!(
                // A straight link in a curved guide is a chord: what its middle
                // needs of the clearance is not free for whirl.
                "pipe-guide {:.2} mm (a link's chord uses up to {:.2} mm of it), guide-wall {:.2} mm",
                config.inner_clearance() * 1e3,
                config.chord_sagitta() * 1e3,
                config.outer_clearance() * 1e3
            ),
        )?;
        // A guide that the hole does not bend has no row.
        let preload = config.guide_preload_moment();
        if preload > 0.0 {
            row(
                "guide preload",
                format!(
                    "{:.2} kN m where the hole bends the guide most; {:.2} % of strain at its outermost fibre {}",
                    preload * 1e-3,
                    100.0 * config.guide_bending_strain(),
                    if tool.guide.closes_slots() {
                        "beyond the slots"
                    } else {
                        "on its way through the hole"
                    },
                ),
            )?;
        }
        for (name, value) in &self.1.rows {
            row(name, value.clone())?;
        }
        // The count sets the time per step and the memory, so it is shown before a run is begun.
        let count = config.unknowns();
        row(
            "unknowns",
            format!(
                "{} = 6 x ({} pipe + {} guide nodes) + {} joint rows, supports included",
                count.total(),
                count.pipe_nodes,
                count.guide_nodes,
                count.joint_rows
            ),
        )?;
        if tool.joint.kind == JointKind::Universal && tool.links > 1 {
            row("chain", folding_in_words(tool.links, tool.joint.cross_phase_step_deg))?;
        }
        // Under the law of the depth of cut, torque follows from the advance and has no constant share of the weight.
        if config.rock.law != Law::DepthOfCut {
            row(
                "bit torque",
                format!(
                    "{:.2} N m per kN of weight on bit (Eq. 1)",
                    kn_to_n(tool.bit.torque_arm())
                ),
            )?;
        }
        let modes = config.torsional_modes();
        if !modes.is_empty() {
            row("torsional modes", modes_in_words(&modes))?;
        }
        row(
            "step",
            format!("{}, {}", config.solver.step_in_words(), config.solver.scheme_in_words()),
        )?;
        let (speed, weight) = (&config.inputs.rotary_speed, &config.inputs.weight_on_bit);
        row(
            "rotary speed",
            format!(
                "{} to {} r/min, starts at {}",
                speed.min_rpm, speed.max_rpm, speed.initial_rpm
            ),
        )?;
        row(
            "weight on bit",
            format!(
                "{} to {} kN, starts at {}",
                weight.min_kn, weight.max_kn, weight.initial_kn
            ),
        )?;
        // The hash names the configuration in recordings and calibrations, which can be compared with it.
        row("hash", config.hash())?;
        for warning in config.warnings().into_iter().chain(self.1.warnings.iter().cloned()) {
            row("warning", warning)?;
        }
        Ok(())
    }
}

/// The torque that folds the chain of links straight in the hole, by the sense in which the tool turns.
fn folding_in_words(links: usize, phase_step_deg: f64) -> String {
    // The bit brakes forward rotation by a torque against the axis that points down the hole.
    let [reverse, forward] = flexdrill_verify::folding_torques(links, phase_step_deg);
    if (reverse - forward).abs() < 1e-3 {
        format!("folds by a torque of {forward:.3} times its tension times a link's length, in both senses")
    } else {
        format!(
            "folds by a torque of {forward:.3} times its tension times a link's length when it drills, of {reverse:.3} in \
             reverse: crosses {phase_step_deg:.0} deg apart tell the senses apart"
        )
    }
}

/// Decay times (s) beyond this are shown as none.
const LONGEST_DECAY: f64 = 1000.0;

/// Frequency of each mode, and the time in which its amplitude falls to 37 %.
fn modes_in_words(modes: &[TorsionalMode]) -> String {
    let words = modes.iter().map(|mode| {
        let frequency = mode.frequency / TAU;
        if mode.decay * LONGEST_DECAY > 1.0 {
            format!("{frequency:.3} Hz decays in {:.1} s", 1.0 / mode.decay)
        } else {
            format!("{frequency:.3} Hz does not decay")
        }
    });
    format!(
        "{}; of drive, string and tool off bottom",
        words.collect::<Vec<_>>().join(", ")
    )
}

fn joint_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Universal => "universal joints",
        JointKind::BallCage => "ball cage joints",
        JointKind::Revolute => "revolute joints",
    }
}
