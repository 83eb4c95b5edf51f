//! The twin's results at the points of a design, run on threads and kept in a file, so that an interrupted study continues
//! where it stopped.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use super::point::{self, Figures, Load};
use super::unknowns::Unknowns;
use crate::design::latin_hypercube;
use crate::fit::DESIGN;
use crate::windows::{Activity, Channel};
use flexdrill_config::Config;

/// A point: standardised unknowns and load, with the twin's figures or why there are none.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Standardised modelled unknowns; those that runs in its state of motion do not depend on are 0.
    pub z: Vec<f64>,
    /// Load.
    pub load: Load,
    /// Settled means.
    pub found: Option<Result<Figures, String>>,
}

impl Point {
    /// Inputs of the surrogate of its state of motion, which depends on the unknowns `acting`.
    pub fn inputs(&self, acting: &[usize]) -> Vec<f64> {
        let mut inputs: Vec<f64> = acting.iter().map(|unknown| self.z[*unknown]).collect();
        inputs.extend(crate::fit::load(
            self.load.motion,
            self.load.rotary_speed,
            self.load.weight,
        ));
        inputs
    }
}

/// What the points of a state of motion cover.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cover {
    /// State of motion.
    pub motion: Activity,
    /// Range of the speed (rad/s).
    pub rotary_speed: [f64; 2],
    /// Range of the weight (N).
    pub weight: [f64; 2],
    /// Number of points.
    pub points: usize,
}

/// The points of a design: a Latin hypercube over the priors and the loads.
pub fn design(unknowns: &Unknowns, cover: &Cover, seed: u64) -> Vec<Point> {
    let acting = unknowns.acting(cover.motion);
    let loads = crate::fit::load(cover.motion, 1.0, 1.0).len();
    // The states of motion get different hypercubes.
    let seed = seed.wrapping_mul(2).wrapping_add(cover.motion as u64);
    let between = |[low, high]: [f64; 2], share: f64| low + share * (high - low);
    latin_hypercube(cover.points, acting.len() + loads, seed)
        .into_iter()
        .map(|shares| {
            let (of_unknowns, of_loads) = shares.split_at(acting.len());
            let mut z = vec![0.0; unknowns.modelled.len()];
            for (unknown, share) in acting.iter().zip(of_unknowns) {
                z[*unknown] = between([-DESIGN, DESIGN], *share);
            }
            Point {
                z,
                load: Load {
                    motion: cover.motion,
                    rotary_speed: between(cover.rotary_speed, of_loads[0]),
                    weight: match cover.motion {
                        Activity::OffBottom => 0.0,
                        Activity::Drilling => between(cover.weight, of_loads[1]),
                    },
                },
                found: None,
            }
        })
        .collect()
}

/// Runs the points that have no result yet, on `jobs` threads. The results do not depend on their number. After each
/// point `done` gets all points, and the number that is left.
pub fn run(
    config: &Config,
    unknowns: &Unknowns,
    points: Vec<Point>,
    jobs: usize,
    mut done: impl FnMut(&[Point], usize),
) -> Vec<Point> {
    let open: Vec<usize> = (0..points.len())
        .filter(|index| points[*index].found.is_none())
        .collect();
    let next = AtomicUsize::new(0);
    let shared = Mutex::new(points);
    let get = || shared.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    std::thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel::<()>();
        for _ in 0..jobs.clamp(1, open.len().max(1)) {
            let (sender, open, next) = (sender.clone(), &open, &next);
            scope.spawn(move || {
                while let Some(&index) = open.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let point = get()[index].clone();
                    let values: Vec<f64> = unknowns
                        .modelled
                        .iter()
                        .zip(&point.z)
                        .map(|(modelled, z)| modelled.unknown.value(*z))
                        .collect();
                    let found = unknowns
                        .apply(config, &values)
                        .map_err(|error| error.to_string())
                        .and_then(|config| point::run(&config, &point.load));
                    get()[index].found = Some(found);
                    // The receiver outlives all threads of this scope.
                    let _ = sender.send(());
                }
            });
        }
        drop(sender);
        let mut left = open.len();
        for () in receiver {
            left = left.saturating_sub(1);
            done(&get(), left);
        }
    });
    shared.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// First line of a file of points: what they are points of. Points of another configuration, version or design are not
/// mixed with them.
fn identity(config: &Config, unknowns: &Unknowns, seed: u64) -> String {
    let priors: Vec<String> = unknowns
        .modelled
        .iter()
        .map(|modelled| {
            let [low, high] = modelled.unknown.prior();
            format!("{} {low:e} {high:e}", modelled.keys.join(" "))
        })
        .collect();
    format!(
        "# flexdrill {} calibration points; configuration {}; seed {seed}; {}",
        env!("CARGO_PKG_VERSION"),
        config.hash(),
        priors.join("; ")
    )
}

/// The points as text.
pub fn to_csv(config: &Config, unknowns: &Unknowns, seed: u64, points: &[Point]) -> String {
    let mut text = identity(config, unknowns, seed);
    text.push_str("\nmotion,rotary_speed_rad_per_s,weight_n");
    for index in 0..unknowns.modelled.len() {
        // Writing to a string cannot fail.
        let _ = write!(text, ",z{}", index + 1);
    }
    for channel in Channel::ALL {
        let (name, unit) = channel.name_and_unit();
        let _ = write!(text, ",{} ({unit})", name);
    }
    text.push_str(",problem\n");
    for point in points {
        let Some(found) = &point.found else {
            continue;
        };
        let motion = name(point.load.motion);
        let _ = write!(text, "{motion},{:e},{:e}", point.load.rotary_speed, point.load.weight);
        for z in &point.z {
            let _ = write!(text, ",{z:e}");
        }
        match found {
            Ok(figures) => {
                for figure in figures {
                    let _ = write!(text, ",{figure:e}");
                }
                text.push_str(",\n");
            }
            Err(problem) => {
                let plain = problem.replace([',', '\n', '"'], ";");
                let _ = writeln!(text, "{},{plain}", ",".repeat(Channel::COUNT));
            }
        }
    }
    text
}

/// Why points of a file are not used.
#[derive(Debug, thiserror::Error)]
pub enum PointsError {
    /// The file belongs to another study.
    #[error(
        "{file}: its points are of another configuration, version, seed or prior; name another folder with --out, or remove it"
    )]
    Other {
        /// Path of the file, for the message.
        file: String,
    },
    /// A line cannot be read.
    #[error("{file}, line {line}: not a point; remove the line or the file")]
    Line {
        /// Path of the file, for the message.
        file: String,
        /// The line, from 1.
        line: usize,
    },
}

/// Puts the results of a file into the points of a design that they are of. Returns how many were found.
///
/// # Errors
/// When the file is of another study, or a line is damaged.
pub fn fill(
    path: &Path,
    text: &str,
    config: &Config,
    unknowns: &Unknowns,
    seed: u64,
    points: &mut [Point],
) -> Result<usize, PointsError> {
    let file = || path.display().to_string();
    let mut lines = text.lines().enumerate();
    if lines.next().map(|(_, line)| line) != Some(&identity(config, unknowns, seed)) {
        return Err(PointsError::Other { file: file() });
    }
    let known: BTreeMap<String, Result<Figures, String>> = parsed(text, unknowns.modelled.len())
        .map_err(|line| PointsError::Line { file: file(), line })?
        .into_iter()
        .filter_map(|point| Some((key(&point), point.found?)))
        .collect();
    let mut count = 0;
    for point in points {
        if let Some(found) = known.get(&key(point)) {
            point.found = Some(found.clone());
            count += 1;
        }
    }
    Ok(count)
}

/// Inputs of a point as text: a number has one text, by which it is recognised.
fn key(point: &Point) -> String {
    let mut text = format!(
        "{} {:e} {:e}",
        name(point.load.motion),
        point.load.rotary_speed,
        point.load.weight
    );
    for z in &point.z {
        // Writing to a string cannot fail.
        let _ = write!(text, " {z:e}");
    }
    text
}

const fn name(motion: Activity) -> &'static str {
    match motion {
        Activity::OffBottom => "off_bottom",
        Activity::Drilling => "drilling",
    }
}

/// The points of a text with this number of modelled unknowns, whatever study it belongs to.
///
/// # Errors
/// The number of the first line, from 1, that is not a point.
pub fn parsed(text: &str, modelled: usize) -> Result<Vec<Point>, usize> {
    let mut points = Vec::new();
    for (number, line) in text.lines().enumerate().skip(2).filter(|(_, line)| !line.is_empty()) {
        points.push(point_of(line, modelled).ok_or(number + 1)?);
    }
    Ok(points)
}

fn point_of(line: &str, modelled: usize) -> Option<Point> {
    let fields: Vec<&str> = line.split(',').collect();
    let (inputs, figures) = fields.split_at_checked(3 + modelled)?;
    let (figures, problem) = figures.split_at_checked(Channel::COUNT)?;
    let [problem] = problem else {
        return None;
    };
    let motion = [Activity::OffBottom, Activity::Drilling]
        .into_iter()
        .find(|motion| name(*motion) == inputs[0])?;
    let numbers: Vec<f64> = inputs[1..]
        .iter()
        .map(|field| field.parse().ok())
        .collect::<Option<_>>()?;
    let found = if figures[0].is_empty() {
        Err((*problem).to_owned())
    } else {
        let mut values = [f64::NAN; Channel::COUNT];
        for (value, field) in values.iter_mut().zip(figures) {
            *value = field.parse().ok()?;
        }
        Ok(values)
    };
    Some(Point {
        z: numbers[2..].to_vec(),
        load: Load {
            motion,
            rotary_speed: numbers[0],
            weight: numbers[1],
        },
        found: Some(found),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_found_again_and_those_of_another_study_are_refused() {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        let unknowns = Unknowns::of(&config).unwrap();
        let cover = Cover {
            motion: Activity::Drilling,
            rotary_speed: [4.0, 6.0],
            weight: [8e3, 15e3],
            points: 6,
        };
        let mut points = design(&unknowns, &cover, 1);
        points[0].found = Some(Ok([300.0, f64::NAN, 80.0, 9e3, 1e-3]));
        points[1].found = Some(Err("the step failed, at 3 s".to_owned()));
        let text = to_csv(&config, &unknowns, 1, &points);
        let mut again = design(&unknowns, &cover, 1);
        let path = Path::new("points.csv");
        assert_eq!(fill(path, &text, &config, &unknowns, 1, &mut again).unwrap(), 2);
        assert_eq!(again[0].found.as_ref().unwrap().as_ref().unwrap()[0], 300.0);
        assert_eq!(again[1].found, Some(Err("the step failed; at 3 s".to_owned())));
        assert!(again[2].found.is_none());
        let other = fill(path, &text, &config, &unknowns, 2, &mut again).unwrap_err();
        assert!(matches!(other, PointsError::Other { .. }));
        for (damage, line) in [
            ("drilling,4.0,oops", 5),
            ("", 0),
            ("drilling,1,2,3,4,5,6,7,8,9,10,11,12,x,2,3,4,5,", 5),
        ] {
            let damaged = format!("{text}{damage}\n");
            let result = fill(path, &damaged, &config, &unknowns, 1, &mut again);
            match result {
                Err(PointsError::Line { line: at, .. }) => assert_eq!(at, line),
                other => assert!(line == 0 && other.is_ok()),
            }
        }
    }

    #[test]
    fn the_design_covers_loads_and_priors() {
        let cover = Cover {
            motion: Activity::OffBottom,
            rotary_speed: [4.0, 6.0],
            weight: [0.0, 0.0],
            points: 40,
        };
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        let unknowns = Unknowns::of(&config).unwrap();
        let acting = unknowns.acting(Activity::OffBottom);
        let points = design(&unknowns, &cover, 1);
        for point in &points {
            assert!(point.load.weight == 0.0 && point.inputs(&acting).len() == acting.len() + 1);
            // The rock's unknowns do nothing off bottom.
            assert!(point.z[2..6].iter().all(|z| *z == 0.0));
        }
        let least = points.iter().map(|point| point.z[1]).fold(f64::MAX, f64::min);
        assert!((-DESIGN..-0.9 * DESIGN).contains(&least), "{least}");
    }
}
