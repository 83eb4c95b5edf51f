//! A sweep's directory: the plan, and a file per point that has a result.
//!
//! ```text
//! DIR/sweep.json                  the plan
//! DIR/points/ab/cdef....jsonl     the result of point abcdef...
//! DIR/points/ab/.part-XXXXXX      a result that is being written, or was when its worker was killed
//! ```
//!
//! A file gets its name when it is complete. Two workers that compute the same point write the same bytes.

use std::fs::File;
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::error::SweepError;
use crate::outcome::{self, Damage, Outcome};
use crate::plan::{FORMAT, Plan, Point};

/// Largest plan that is read (bytes).
pub const MOST_PLAN_BYTES: u64 = 256 << 20;
/// Name of the plan in its directory.
pub const PLAN: &str = "sweep.json";
/// Name of the folder of points.
const POINTS: &str = "points";
/// Beginning of the name of a file that is being written.
const PART: &str = ".part-";

/// A directory with its plan.
#[derive(Debug, Clone)]
pub struct Directory {
    path: PathBuf,
    plan: Plan,
    points: Vec<Point>,
}

/// What is known of a point.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// It has no result.
    Missing,
    /// It has one.
    Done(Box<Outcome>),
    /// Its file is not a result.
    Damaged(Damage),
}

/// What is in a directory.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Status {
    /// Points of the plan.
    pub points: usize,
    /// Points with a result.
    pub done: usize,
    /// Points among these in which a member failed.
    pub failed: usize,
    /// Files that are damaged, with what is wrong.
    pub damaged: Vec<(PathBuf, Damage)>,
    /// Files of workers that write, or that were killed while they wrote.
    pub unfinished: usize,
    /// Other files and folders among the points.
    pub foreign: usize,
}

impl Status {
    /// Points without a result.
    pub fn missing(&self) -> usize {
        self.points - self.done - self.damaged.len()
    }
}

impl Directory {
    /// Creates a directory for a plan. One that has the same plan is opened.
    ///
    /// # Errors
    /// When the plan has a problem, the directory has another plan, or the disk refuses it.
    pub fn create(path: &Path, plan: &Plan) -> Result<Self, SweepError> {
        let file = path.join(PLAN);
        if let Some(problem) = plan.problem() {
            let name = file.display().to_string();
            return Err(SweepError::Plan { name, problem });
        }
        std::fs::create_dir_all(path).map_err(|reason| unwritten(path, reason))?;
        if !file.exists() {
            let text = serde_json::to_string(plan).map_err(|error| SweepError::Damaged {
                path: file.clone(),
                reason: error.to_string(),
            })?;
            let part = part(path, &[text.as_bytes(), b"\n"])?;
            match part.persist_noclobber(&file) {
                Ok(_) => {}
                // Another program planned at the same time; the comparison below decides.
                Err(error) if error.error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(unwritten(&file, error.error)),
            }
        }
        let there = Self::open(path)?;
        match there.plan.difference(plan) {
            None => Ok(there),
            Some(what) => Err(SweepError::AnotherPlan { path: file, what }),
        }
    }

    /// Opens a directory.
    ///
    /// # Errors
    /// When it has no plan, or one that is damaged or of another format.
    pub fn open(path: &Path) -> Result<Self, SweepError> {
        let file = path.join(PLAN);
        let bytes = match read_bounded(&file, MOST_PLAN_BYTES) {
            Ok(bytes) => bytes,
            Err(reason) if reason.kind() == ErrorKind::NotFound => {
                return Err(SweepError::NoPlan { path: path.to_owned() });
            }
            Err(reason) => return Err(SweepError::Read { path: file, reason }),
        };
        Ok(Self::of(path, plan_from_bytes(&file, &bytes)?))
    }

    fn of(path: &Path, plan: Plan) -> Self {
        Self {
            points: plan.points(),
            plan,
            path: path.to_owned(),
        }
    }

    /// Refuses a plan that another program made.
    ///
    /// # Errors
    /// When the plan's program or arithmetic is another one.
    pub fn belongs_to(&self, program: &str, arithmetic: &str) -> Result<(), SweepError> {
        let named = |program: &str, arithmetic: &str| format!("{program} ({arithmetic} arithmetic)");
        let runs = &self.plan.runs;
        if (runs.program.as_str(), runs.arithmetic.as_str()) == (program, arithmetic) {
            return Ok(());
        }
        Err(SweepError::AnotherProgram {
            path: self.path.join(PLAN),
            found: named(&runs.program, &runs.arithmetic),
            here: named(program, arithmetic),
        })
    }

    /// The directory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The plan's points, by their numbers.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// File of a point's result.
    pub fn file(&self, point: &Point) -> PathBuf {
        let (folder, name) = point.id.split_at(2);
        self.path.join(POINTS).join(folder).join(format!("{name}.jsonl"))
    }

    /// Whether a point has a file, which is cheaper than reading it.
    pub fn has_file(&self, point: &Point) -> bool {
        self.file(point).exists()
    }

    /// What is known of a point.
    ///
    /// # Errors
    /// When its file cannot be read.
    pub fn find(&self, point: &Point) -> Result<Found, SweepError> {
        let file = self.file(point);
        self.ensure_own(&file)?;
        match read_bounded(&file, outcome::MOST_BYTES) {
            Ok(bytes) => Ok(match outcome::from_bytes(&self.plan, point, &bytes) {
                Ok(outcome) => Found::Done(Box::new(outcome)),
                Err(damage) => Found::Damaged(damage),
            }),
            Err(reason) if reason.kind() == ErrorKind::NotFound => Ok(Found::Missing),
            Err(_) if is_another_kind(&file) => Ok(Found::Damaged(Damage::NotAFile)),
            Err(reason) => Err(SweepError::Read { path: file, reason }),
        }
    }

    /// Refuses a point's file whose folders are links: they may lead out of the directory.
    fn ensure_own(&self, file: &Path) -> Result<(), SweepError> {
        let folders = [self.path.join(POINTS), file.parent().unwrap_or(&self.path).to_owned()];
        match folders.into_iter().find(|folder| is_link(folder)) {
            Some(path) => Err(SweepError::Link { path }),
            None => Ok(()),
        }
    }

    /// Writes the result of a point: under a temporary name, to the disk, then under its own name.
    ///
    /// # Errors
    /// When the disk refuses the write, or a number of the outcome is not finite.
    pub fn put(&self, point: &Point, outcome: &Outcome) -> Result<(), SweepError> {
        let bytes = outcome::to_bytes(&self.plan, point, outcome).map_err(|error| SweepError::NoJson {
            point: point.id.clone(),
            reason: error.to_string(),
        })?;
        let file = self.file(point);
        self.ensure_own(&file)?;
        let folder = file.parent().unwrap_or(&self.path);
        std::fs::create_dir_all(folder).map_err(|reason| unwritten(folder, reason))?;
        let part = part(folder, &[&bytes])?;
        part.persist(&file).map_err(|error| unwritten(&file, error.error))?;
        Ok(())
    }

    /// What is in the directory. Every result is read.
    ///
    /// # Errors
    /// When a file or folder cannot be read.
    pub fn status(&self) -> Result<Status, SweepError> {
        let mut status = Status {
            points: self.points.len(),
            ..Status::default()
        };
        for point in &self.points {
            match self.find(point)? {
                Found::Missing => {}
                Found::Done(outcome) => {
                    status.done += 1;
                    status.failed += usize::from(outcome.failed > 0 || outcome.members == 0);
                }
                Found::Damaged(damage) => status.damaged.push((self.file(point), damage)),
            }
        }
        let mut files = 0;
        self.each_file(|name| {
            if name.starts_with(PART) {
                status.unfinished += 1;
            } else {
                files += 1;
            }
        })?;
        status.foreign = usize::saturating_sub(files, status.done + status.damaged.len());
        Ok(status)
    }

    /// Calls `each` with the name of every file in the folders of points.
    fn each_file(&self, mut each: impl FnMut(&str)) -> Result<(), SweepError> {
        let entries = |path: &Path| match std::fs::read_dir(path) {
            Ok(entries) => entries.collect::<Result<Vec<_>, _>>(),
            Err(reason) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&reason.kind()) => Ok(Vec::new()),
            Err(reason) => Err(reason),
        };
        let unread = |path: &Path, reason| SweepError::Read {
            path: path.to_owned(),
            reason,
        };
        let points = self.path.join(POINTS);
        if is_link(&points) {
            return Err(SweepError::Link { path: points });
        }
        for folder in entries(&points).map_err(|reason| unread(&points, reason))? {
            let folder = folder.path();
            if is_link(&folder) {
                each(&folder.file_name().unwrap_or_default().to_string_lossy());
                continue;
            }
            for file in entries(&folder).map_err(|reason| unread(&folder, reason))? {
                each(&file.file_name().to_string_lossy());
            }
        }
        Ok(())
    }
}

/// The plan in the bytes of its file; `file` stands for it in errors.
///
/// # Errors
/// When they are no plan, one of another format, or one with a problem.
pub fn plan_from_bytes(file: &Path, bytes: &[u8]) -> Result<Plan, SweepError> {
    /// The one field that says how to read the others.
    #[derive(Deserialize)]
    struct Versioned {
        format: u32,
    }
    let damaged = |reason: String| SweepError::Damaged {
        path: file.to_owned(),
        reason,
    };
    if bytes.len() as u64 > MOST_PLAN_BYTES {
        return Err(damaged(format!("more than {MOST_PLAN_BYTES} bytes")));
    }
    let Versioned { format } = serde_json::from_slice(bytes).map_err(|error| damaged(error.to_string()))?;
    if format != FORMAT {
        return Err(SweepError::Format {
            path: file.to_owned(),
            found: format,
        });
    }
    let plan: Plan = serde_json::from_slice(bytes).map_err(|error| damaged(error.to_string()))?;
    match plan.problem() {
        None => Ok(plan),
        Some(problem) => Err(damaged(problem.to_string())),
    }
}

/// A regular file of at most `most` bytes, and one byte more of a larger one. Opening does not wait for the other end of a
/// pipe, and does not follow a link.
fn read_bounded(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    use rustix::fs::{Mode, OFlags};
    let flags = OFlags::RDONLY | OFlags::CLOEXEC | OFlags::NONBLOCK | OFlags::NOFOLLOW;
    let file = File::from(rustix::fs::open(path, flags, Mode::empty())?);
    if !file.metadata()?.is_file() {
        return Err(std::io::Error::new(ErrorKind::InvalidInput, "it is no regular file"));
    }
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn is_link(path: &Path) -> bool {
    std::fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink())
}

/// Whether there is something that is no regular file.
fn is_another_kind(path: &Path) -> bool {
    std::fs::symlink_metadata(path).is_ok_and(|found| !found.is_file())
}

/// A complete file on the disk, without its name yet.
fn part(folder: &Path, content: &[&[u8]]) -> Result<tempfile::NamedTempFile, SweepError> {
    use std::os::unix::fs::PermissionsExt as _;
    let failed = |reason| unwritten(folder, reason);
    // Others of the same cluster read the results: as the umask says, not only for the owner.
    let mut part = tempfile::Builder::new()
        .prefix(PART)
        .permissions(std::fs::Permissions::from_mode(0o666))
        .tempfile_in(folder)
        .map_err(failed)?;
    for bytes in content {
        part.write_all(bytes).map_err(failed)?;
    }
    // A machine that loses its power after the renaming must not leave an empty result.
    part.as_file().sync_data().map_err(|reason| unsynced(folder, reason))?;
    Ok(part)
}

/// Writes a file under a temporary name first, so that the final name never has a part of it.
///
/// # Errors
/// When the disk refuses the write.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), SweepError> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let part = part(folder, &[content])?;
    part.persist(path).map_err(|error| unwritten(path, error.error))?;
    Ok(())
}

/// A file system that does not know the request is no disk that is full.
fn unsynced(path: &Path, reason: std::io::Error) -> SweepError {
    let kinds = [
        ErrorKind::InvalidInput,
        ErrorKind::Unsupported,
        ErrorKind::PermissionDenied,
    ];
    if kinds.contains(&reason.kind()) {
        let path = path.to_owned();
        return SweepError::NotSynced { path, reason };
    }
    unwritten(path, reason)
}

fn unwritten(path: &Path, reason: std::io::Error) -> SweepError {
    SweepError::Write {
        path: path.to_owned(),
        reason,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_sync_is_told_as_what_it_is() {
        // EINVAL, ENOSYS, EPERM, EOPNOTSUPP.
        for code in [22, 38, 1, 95] {
            let text = unsynced(Path::new("points/ab"), std::io::Error::from_raw_os_error(code)).to_string();
            assert!(
                text.contains("points/ab: cannot be synced") && text.contains("file system"),
                "{text}"
            );
        }
        let full = unsynced(Path::new("points/ab"), std::io::Error::from_raw_os_error(28)).to_string();
        assert!(full.contains("cannot be written: No space left"), "{full}");
    }
}
