//! `flexdrill rebase BAG --out FILE`: the configuration of the same tool in the hole that it has drilled.

use std::path::PathBuf;

use anyhow::{Context as _, bail};
use flexdrill_config::{Config, FreeBend};
use flexdrill_core::units::rad_to_deg;

use crate::bag;
use crate::cli::new_file;
use crate::cli::output::say;
use crate::messages::{HoleDrilled, Message, SessionInfo};
use flexdrill_text::counted;

/// Write the configuration of a tool in the hole that it has drilled, from a recording of the twin.
#[derive(Debug, clap::Args)]
pub struct RebaseArgs {
    /// Recording of the twin.
    #[arg(value_name = "BAG")]
    input: PathBuf,
    /// Configuration to write; a file that exists is not replaced.
    #[arg(long, value_name = "FILE.yaml")]
    out: PathBuf,
    /// Lay a hole that walks into its vertical plane, with the curvatures to the right left out.
    #[arg(long)]
    in_plane: bool,
    /// Accept points at which the hole ahead was not known.
    #[arg(long)]
    accept_unknown: bool,
}

/// Session and points of a recording, of the newest of its runs.
struct Recorded {
    config: Config,
    points: Vec<HoleDrilled>,
}

impl Recorded {
    /// # Errors
    /// When the bag cannot be read, or is no recording of the twin.
    fn read(args: &RebaseArgs) -> anyhow::Result<Self> {
        let mut bag = bag::open(&args.input)?;
        let wanted = [SessionInfo::ROS_TYPE, HoleDrilled::ROS_TYPE];
        bag.select(|topic| wanted.contains(&topic.ros_type.as_str()));
        let (mut session, mut points) = (None, Vec::<HoleDrilled>::new());
        for message in bag.by_ref() {
            let message = message?;
            match message.topic.ros_type.as_str() {
                SessionInfo::ROS_TYPE => {
                    session.get_or_insert(message.decode::<SessionInfo>()?);
                }
                _ => {
                    let point = message.decode::<HoleDrilled>()?;
                    // The motion has begun again, with the tool in its configured hole.
                    if point.point == 0 {
                        points.clear();
                    }
                    // A point that is missing would shift all below it.
                    if point.point as usize != points.len() {
                        bail!(
                            "{}: twin/hole_drilled has point {} where {} is expected: the hole between them is lost. Take a \
                             recording from the start of the run",
                            args.input.display(),
                            point.point,
                            points.len()
                        );
                    }
                    points.push(point);
                }
            }
        }
        let Some(session) = session else {
            bail!(
                "{}: no recording of the twin: it has no topic of type {}",
                args.input.display(),
                SessionInfo::ROS_TYPE
            );
        };
        let name = format!("the configuration in {}", args.input.display());
        let config = Config::from_text(&name, &session.configuration)?;
        Ok(Self { config, points })
    }
}

/// # Errors
/// When the recording has no hole as drilled, the hole cannot be a configuration's, or the file exists or cannot be written.
pub fn run(args: &RebaseArgs) -> anyhow::Result<()> {
    let Recorded { config, points } = Recorded::read(args)?;
    let Some(last) = points.last() else {
        bail!(
            "{}: no point of the hole as drilled (twin/hole_drilled): the bit has made less than 0.02 m of hole. A point is \
             0.02 m at the rate of penetration of the rig; nothing is written",
            args.input.display()
        );
    };
    // The shape belongs to the guide: in another hole `as_built` would be another guide.
    if matches!(config.tool.guide.free_curvature, FreeBend::Path(_)) {
        bail!(
            "tool.guide.free_curvature = as_built: must be a number: in the hole as drilled it would be a guide of another \
             shape. Measure the guide on a template, set its curvature and run again"
        );
    }
    // Points that are not known repeat the curvature above them: whoever takes them says so.
    let unknown: Vec<&HoleDrilled> = points.iter().filter(|point| !point.known).collect();
    if let Some(first) = unknown.first().filter(|_| !args.accept_unknown) {
        bail!(
            "{}: {} of {} of the hole as drilled are not known, the first at a measured depth of {:.2} m: {}. \
             --accept-unknown takes them with the curvatures that they have",
            args.input.display(),
            unknown.len(),
            counted(points.len() as u64, "point"),
            first.measured_depth,
            first.because
        );
    }
    // Whether the hole can be one of a configuration is the check of `well.sections`, which says what is wrong with it.
    let walk = |right: f64| if args.in_plane { 0.0 } else { right };
    let curvatures: Vec<[f64; 2]> = points.iter().map(|point| [point.build, walk(point.right)]).collect();
    let rebased = config
        .rebased(&curvatures, last.length)
        .context("the hole as drilled is no hole of a configuration; --in-plane leaves out what it walks")?;
    let text = format!(
        "# The tool of {} in the hole that it has drilled: {} of {} m.\n{}",
        args.input.display(),
        counted(points.len() as u64, "point"),
        last.length,
        rebased.to_yaml()?
    );
    if !new_file::write(&args.out, &text, "--out")? {
        bail!("--out {}: the file exists; give another name", args.out.display());
    }
    // What the driller compares with surveys: direction and position of the bit in the new hole.
    let course = rebased.well.course();
    say!(
        "{}: {:.2} m drilled in {}; the bit at an inclination of {:.2} deg, azimuth {:.2} deg of the plane, {:.3} m along \
         and {:.3} m below the new kick-off, which lies {:.2} m down the old hole",
        args.out.display(),
        last.drilled,
        counted(points.len() as u64, "point"),
        rad_to_deg(course.inclination()),
        rad_to_deg(course.azimuth()),
        course.position.x,
        course.position.z,
        last.drilled
    );
    if config.well.plan.is_some() {
        say!("well.plan is left out: its depths count from the old kick-off");
    }
    Ok(())
}
