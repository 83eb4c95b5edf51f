//! Reach: torque and weight at the bit against the length of the hole.
//!
//! The configuration's tool and hole are lengthened by links in a straight part. Every point, a length with a friction
//! coefficient, with or without rotation, is a run of the twin until its means are steady ([`point`]). Beside it are the
//! closed form of a soft string ([`soft_string`]) and the depth from which the tool is compressed beyond buckling. A run
//! that fails or does not become steady is unknown, with its cause.

pub mod kept;
pub mod picture;
pub mod point;
pub mod soft_string;
pub mod table;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use flexdrill_config::{Config, ConfigError};

pub use kept::{KeepError, Kept};
pub use point::{Found, Load, Point};
use soft_string::SoftString;

/// What is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Numbers of links, rising.
    pub links: Vec<usize>,
    /// Friction coefficients of both layers, rising.
    pub frictions: Vec<f64>,
    /// Speed, weight and duration of every run.
    pub load: Load,
    /// Threads.
    pub jobs: usize,
}

/// A point with its result.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Length of the hole from the kick-off (m).
    pub length: f64,
    /// Links.
    pub links: usize,
    /// Friction coefficient.
    pub friction: f64,
    /// Whether the tool rotates.
    pub rotates: bool,
    /// Closed form of a soft string.
    pub soft: SoftString,
    /// The twin's figures, or why there are none.
    pub found: Result<Found, String>,
}

/// Why a study cannot be made. A run that fails is part of its results.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The configuration cannot be lengthened or loaded as the plan says.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A point cannot be kept.
    #[error(transparent)]
    Keep(#[from] KeepError),
}

/// Runs all points, on as many threads as the plan has. The rows are in the order of lengths, with rotation first, then
/// of friction; they do not depend on the number of threads. At most one tool per thread is in memory. `progress` gets
/// the share of the work that is done, 0 to 1. Points that are `kept` are not run, and every run is kept.
///
/// # Errors
/// When the configuration cannot be lengthened or loaded as the plan says, or a point cannot be kept.
pub fn study(
    config: &Config,
    plan: &Plan,
    kept: Option<&Kept>,
    mut progress: impl FnMut(f64),
) -> Result<Vec<Row>, StudyError> {
    let mut points = Vec::new();
    for &links in &plan.links {
        for rotates in [true, false] {
            for &friction in &plan.frictions {
                points.push(Point::new(config, links, friction, rotates, &plan.load)?);
            }
        }
    }
    // The cost of a step grows with the links. The most expensive points come first, so that no thread waits for one.
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|&index| std::cmp::Reverse(points[index].links));
    let whole: usize = points.iter().map(|point| point.links).sum();
    let next = AtomicUsize::new(0);
    let found = Mutex::new(vec![None; points.len()]);
    let unkept = Mutex::new(None);
    std::thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel::<f64>();
        for _ in 0..plan.jobs.clamp(1, points.len().max(1)) {
            let (sender, points, order, next) = (sender.clone(), &points, &order, &next);
            let (found, unkept) = (&found, &unkept);
            scope.spawn(move || {
                while let Some(&index) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let point = &points[index];
                    let mut reported = 0.0;
                    // Progress is counted in links: the cost of a point grows with them. Only the increase is sent, as
                    // all threads share one sum.
                    let mut report = |share: f64| {
                        // The receiver outlives all threads of this scope.
                        let _ = sender.send((share - reported) * point.links as f64);
                        reported = share;
                    };
                    let result = kept.and_then(|kept| kept.read(point)).unwrap_or_else(|| {
                        let result = point.run(&plan.load, &mut report);
                        if let Some(Err(error)) = kept.map(|kept| kept.write(point, &result)) {
                            *unkept.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = Some(error);
                            // What cannot be kept is not worth hours.
                            next.store(order.len(), Ordering::Relaxed);
                        }
                        result
                    });
                    // A point that was kept reports its whole share here; one that became steady early, the rest.
                    report(1.0);
                    let mut found = found.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    found[index] = Some(result);
                }
            });
        }
        // The loop below ends with the last sender of the threads.
        drop(sender);
        let mut done = 0.0;
        for part in receiver {
            done += part;
            progress((done / whole as f64).min(1.0));
        }
    });
    if let Some(error) = unkept.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
        return Err(error.into());
    }
    let found = found.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    Ok(points
        .iter()
        .zip(found)
        // The closed form costs nothing and is computed again, so a kept point does not depend on its version.
        .map(|(point, found)| Row {
            length: point.config.well.length(),
            links: point.links,
            friction: point.friction,
            rotates: point.rotates,
            soft: SoftString::of(&point.config.tool(), &plan.load, point.rotates),
            found: found.unwrap_or_else(|| Err("the run did not take place".to_owned())),
        })
        .collect())
}
