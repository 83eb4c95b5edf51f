//! `flexdrill rebase BAG --out FILE`: the configuration of the same tool in the hole that it has drilled, as a recording of the
//! twin has it, or as a table of its directions does.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail};
use flexdrill_config::{Config, Drilled, FreeBend, Interval, Section, Well};
use flexdrill_core::units::rad_to_deg;

use crate::bag;
use crate::cli::output::say;
use crate::cli::{built_in, new_file, numbers, plan};
use crate::drilling::plan::moved_down;
use crate::drilling::surveyed_hole;
use crate::messages::{HoleDrilled, Message, SessionInfo};
use flexdrill_text::counted;

/// Write the configuration of a tool in the hole that it has drilled, from a recording of the twin or a table of surveys.
#[derive(Debug, clap::Args)]
pub struct RebaseArgs {
    /// Recording of the twin; with --surveys a configuration.
    #[arg(value_name = "BAG")]
    input: PathBuf,
    /// Table (CSV) of the hole: measured_depth_m from the kick-off, inclination_deg, azimuth_deg. Between two rows it is an arc.
    #[arg(long, value_name = "FILE.csv")]
    surveys: Option<PathBuf>,
    /// Measured depth of the bit from the kick-off (m), up to 3 m below the last row; default the last row.
    #[arg(long, value_name = "M", requires = "surveys", value_parser = numbers::measured_depth)]
    bit: Option<f64>,
    /// Configuration to write; a file that exists is not replaced.
    #[arg(long, value_name = "FILE.yaml")]
    out: PathBuf,
    /// Lay a hole that walks into its vertical plane, with the curvatures to the right left out.
    #[arg(long)]
    in_plane: bool,
    /// Accept points at which the hole ahead was not known.
    #[arg(long, conflicts_with = "surveys")]
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

/// A tool in another hole.
struct Rebased {
    /// In the hole before.
    before: Config,
    /// In its own hole, without a plan.
    after: Config,
    /// How far the new kick-off lies down the old hole (m), and where in its frame (m).
    moved: f64,
    top: [f64; 3],
    /// What it was made of.
    from: String,
}

/// # Errors
/// When the recording or table has no hole as drilled, the hole cannot be a configuration's, or the file exists or cannot be
/// written.
pub fn run(args: &RebaseArgs) -> anyhow::Result<()> {
    let rebased = match &args.surveys {
        Some(table) => of_table(args, table)?,
        None => of_recording(args)?,
    };
    write(args, rebased)
}

/// The shape belongs to the guide: in another hole `as_built` would be another guide.
fn check_guide(config: &Config) -> anyhow::Result<()> {
    if matches!(config.tool.guide.free_curvature, FreeBend::Path(_)) {
        bail!(
            "tool.guide.free_curvature = as_built: must be a number: in the hole as drilled it would be a guide of another \
             shape. Measure the guide on a template, set its curvature and run again"
        );
    }
    Ok(())
}

/// The tool of a configuration in the hole of a table.
fn of_table(args: &RebaseArgs, table: &Path) -> anyhow::Result<Rebased> {
    let (config, name) = built_in::load(&args.input)?;
    let before = plan::with_stations(config, &name, &args.input)?;
    check_guide(&before)?;
    let (file, text) = plan::read_table(table, "the stations of the hole from its kick-off to the bit")?;
    let rows = surveyed_hole::read(&file, &text, args.in_plane)?;
    let laid = surveyed_hole::laid(&file, &rows, &before, args.bit)
        .context("the table is no hole of this tool; --in-plane leaves out what it walks")?;
    Ok(Rebased {
        before,
        after: laid.config,
        moved: laid.moved,
        top: laid.top,
        from: format!("{} of {file}", counted(rows.len() as u64, "station")),
    })
}

/// The tool of a recording in the hole that it has drilled.
fn of_recording(args: &RebaseArgs) -> anyhow::Result<Rebased> {
    let Recorded { config, points } = Recorded::read(args)?;
    let Some(last) = points.last() else {
        bail!(
            "{}: no point of the hole as drilled (twin/hole_drilled): the bit has made less than 0.02 m of hole. A point is \
             0.02 m at the rate of penetration of the rig; nothing is written",
            args.input.display()
        );
    };
    check_guide(&config)?;
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
    let after = config
        .rebased(&curvatures, last.length)
        .context("the hole as drilled is no hole of a configuration; --in-plane leaves out what it walks")?;
    let moved = last.length * points.len() as f64;
    Ok(Rebased {
        after,
        moved,
        top: whole_hole(&config, &curvatures, last.length)
            .course_to(moved)
            .position
            .into(),
        from: format!("{} of {} m", counted(points.len() as u64, "point"), last.length),
        before: config,
    })
}

/// The hole of a configuration with points of a length (m) below it. A tool may have drilled more than its own length.
fn whole_hole(config: &Config, points: &[[f64; 2]], spacing: f64) -> Well {
    let mut well = config.well.clone();
    well.sections.push(Section::Drilled(Drilled {
        spacing,
        points: points.to_vec(),
        interval: Interval::default(),
    }));
    well
}

/// Writes the configuration, and says where the bit is.
fn write(args: &RebaseArgs, rebased: Rebased) -> anyhow::Result<()> {
    let Rebased {
        before,
        after,
        moved,
        top,
        from,
    } = rebased;
    // The plan stays where it is, and the hole has a new beginning.
    let plan = before.well.plan.as_ref();
    let kept = plan.and_then(|plan| moved_down(plan, &before.well, moved, top));
    let keeps_plan = kept.is_some();
    let after = after.with_plan("the plan from the new kick-off", kept)?;
    let text = format!(
        "# The tool of {} in the hole as drilled: {from}.\n{}",
        args.input.display(),
        after.to_yaml()?
    );
    if !new_file::write(&args.out, &text, "--out")? {
        bail!("--out {}: the file exists; give another name", args.out.display());
    }
    // What the driller compares with surveys: direction and position of the bit in the new hole.
    let course = after.well.course();
    say!(
        "{}: {from}; the bit at an inclination of {:.2} deg, azimuth {:.2} deg of the plane, {:.3} m along and {:.3} m below the \
         new kick-off, which lies {moved:.2} m down the old hole, at {:.2} m as the rig counts (well.kick_off_depth)",
        args.out.display(),
        rad_to_deg(course.inclination()),
        rad_to_deg(course.azimuth()),
        course.position.x,
        course.position.z,
        after.well.kick_off_depth
    );
    if !before.string.sections.is_empty() && moved > 0.0 {
        say!("string.sections: {moved:.2} m longer, as the tool lies deeper by that");
    }
    match plan {
        Some(_) if keeps_plan => say!("well.plan: kept where it is; its depths count from the new kick-off"),
        Some(plan) if plan.file.is_some() => say!(
            "well.plan is left out: the recording has the name of its table alone; give the stations again, {moved:.2} m less deep"
        ),
        Some(_) => say!("well.plan is left out: it ends above the new kick-off"),
        None => {}
    }
    Ok(())
}
