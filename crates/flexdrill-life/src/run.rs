//! The damages of a run, by serial number.

use flexdrill_config::Config;

use super::{Counted, Kind, LifeError, text};

/// A joint in a run.
#[derive(Debug, Clone, PartialEq)]
pub struct JointOfRun {
    /// Serial number.
    pub serial: String,
    /// Place in the tool, counted from the bit up: 1 is next to the bit.
    pub place: u32,
    /// Median damage of its stop.
    pub stop: f64,
    /// Median damage of the link below it.
    pub link: f64,
}

/// A run with the damage of each of its joints.
#[derive(Debug, Clone, PartialEq)]
pub struct RunLife {
    /// Begin on the rig's clock (ns).
    pub start: i64,
    /// Stamp of the last count (ns).
    pub end: i64,
    /// Hash of its configuration.
    pub configuration: String,
    /// Model time (h).
    pub hours: f64,
    /// What the damages mean.
    pub kind: Kind,
    /// From the bit up.
    pub joints: Vec<JointOfRun>,
}

impl RunLife {
    /// A run that has begun at `start` (ns) and counted nothing, to ask a table whether it takes the run.
    ///
    /// # Errors
    /// When the configuration has no class or no serial numbers, or counts nothing.
    pub fn begun(config: &Config, start: i64) -> Result<Self, LifeError> {
        let kind = Kind::of(config)?;
        let serials = &config.tool.joint.serial_numbers;
        if serials.is_empty() {
            return Err(LifeError::NoSerials);
        }
        if config.outputs.rates.ageing <= 0.0 {
            return Err(LifeError::NothingCounted);
        }
        let joint = |(place, serial): (u32, &String)| JointOfRun {
            serial: serial.clone(),
            place,
            stop: 0.0,
            link: 0.0,
        };
        Ok(Self {
            start,
            end: start,
            configuration: config.hash(),
            hours: 0.0,
            joints: (1..).zip(serials).map(joint).collect(),
            kind,
        })
    }

    /// The damages of a run that began at `start` (ns) and counted these cycles.
    ///
    /// # Errors
    /// When the configuration has no class or no serial numbers, nothing was counted, or the count is of another class or
    /// tool.
    pub fn of(config: &Config, counted: &Counted, start: i64) -> Result<Self, LifeError> {
        let serials = &config.tool.joint.serial_numbers;
        let kind = Kind::of(config)?;
        if serials.is_empty() {
            return Err(LifeError::NoSerials);
        }
        let damages = damages(&kind, counted)?;
        if damages.len() != serials.len() {
            return Err(LifeError::OtherJoints {
                found: damages.len(),
                expected: serials.len(),
            });
        }
        // Messages count joints from the top, and serial numbers stand from the bit up.
        let joints = (1..).zip(serials).zip(damages.into_iter().rev());
        Ok(Self {
            start,
            end: counted.end(),
            configuration: config.hash(),
            hours: text::rounded(counted.duration() / 3600.0),
            joints: joints
                .map(|((place, serial), [stop, link])| JointOfRun {
                    serial: serial.clone(),
                    place,
                    stop,
                    link,
                })
                .collect(),
            kind,
        })
    }
}

/// Per joint from the top: median damages of its stop and of the link below it.
///
/// # Errors
/// When nothing was counted, or with another slope than the class has.
pub(crate) fn damages(kind: &Kind, counted: &Counted) -> Result<Vec<[f64; 2]>, LifeError> {
    if counted.duration() <= 0.0 {
        return Err(LifeError::NothingCounted);
    }
    let class = kind.details[0].line.slope;
    if (counted.slope() - class).abs() > 1e-9 {
        return Err(LifeError::OtherSlope {
            counted: counted.slope(),
            class,
        });
    }
    let damage = |of: usize, weight: f64| text::rounded(kind.details[of].damage(weight, counted.rated_moment()));
    let weights = counted.weights().into_iter();
    Ok(weights.map(|[stop, link]| [damage(0, stop), damage(1, link)]).collect())
}
