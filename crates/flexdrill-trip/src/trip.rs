//! Hook load and torque of string and tool at a depth of the bit.

use flexdrill_config::Config;
use flexdrill_hole::{HoleError, Sense, Sliding};

use crate::soft_string::{Load, Motion};
use crate::string::Line;
use crate::tool::Tool;

/// String and tool.
#[derive(Debug, Clone)]
pub struct Assembly {
    line: Line,
    tool: Tool,
}

/// Why nothing can be computed for a configuration.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The guide is held at every node.
    #[error(
        "tool.guide.fixed = true: must be false: a guide that is held at every node makes no trip. Set fixed: false"
    )]
    Fixed,
    /// The bit is above the depth at which the string ends, or below the bottom.
    #[error(
        "the depth of the bit = {depth:.3} m: must be {least:.3} to {most:.3} m below the kick-off: the hole ends there, and \
         above it the string is out of the hole"
    )]
    Depth {
        /// Depth asked for (m).
        depth: f64,
        /// Smallest (m).
        least: f64,
        /// Largest (m).
        most: f64,
    },
    /// The statics of the guide have no solution.
    #[error(transparent)]
    Hole(#[from] HoleError),
}

/// Tension and torque at a depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Measured depth from the kick-off (m); below 0 above it.
    pub depth: f64,
    /// Tension just above it (N), below 0 a push.
    pub tension: f64,
    /// Torque that turns what is below it (N m); not a number below the tool's top.
    pub torque: f64,
}

/// Loads of a trip with the bit at a depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Loads {
    /// From the rig to the bit.
    pub stations: Vec<Station>,
    /// Place of the tool's top among them.
    pub tool_top: usize,
}

impl Loads {
    /// Hook load (N), without the block. Of a tool without a string it is the tension at the tool's top.
    pub fn hook_load(&self) -> f64 {
        self.stations.first().map_or(f64::NAN, |rig| rig.tension)
    }

    /// Torque at the rig (N m).
    pub fn torque(&self) -> f64 {
        self.stations.first().map_or(f64::NAN, |rig| rig.torque)
    }

    /// Tension of the guide at its top (N).
    pub fn guide_tension(&self) -> f64 {
        self.stations.get(self.tool_top).map_or(f64::NAN, |top| top.tension)
    }

    /// Largest push along string and guide (N); 0 where all is under tension.
    pub fn largest_push(&self) -> f64 {
        self.stations.iter().fold(0.0, |most, at| most.max(-at.tension))
    }
}

/// All loads of a trip with the bit at a depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Trip {
    /// Pulling out, without rotation and with it.
    pub out: [Loads; 2],
    /// Running in, without rotation and with it.
    pub into: [Loads; 2],
    /// Hook load without any friction (N).
    pub weight: f64,
}

impl Assembly {
    /// Of a configuration.
    ///
    /// # Errors
    /// [`Refusal::Fixed`].
    pub fn of(config: &Config) -> Result<Self, Refusal> {
        if config.tool.guide.fixed {
            return Err(Refusal::Fixed);
        }
        Ok(Self {
            line: Line::of(config),
            tool: Tool::of(config),
        })
    }

    /// The same with the friction of string, guide and pipe multiplied by a factor.
    #[must_use]
    pub fn with_friction(&self, factor: f64) -> Self {
        Self {
            line: self.line.clone().with_friction(factor),
            tool: self.tool.clone().with_friction(factor),
        }
    }

    /// The tool.
    pub fn tool(&self) -> &Tool {
        &self.tool
    }

    /// The string.
    pub fn line(&self) -> &Line {
        &self.line
    }

    /// Depths of the bit (m) for which there are loads: from the kick-off, or from where a short string is out of the hole, to
    /// the bottom. A tool without a string has all of them.
    pub fn depths(&self) -> [f64; 2] {
        let most = self.tool.length();
        let string = self.line.length();
        let least = if string > 0.0 { (most - string).max(0.0) } else { 0.0 };
        [least, most]
    }

    /// Loads of a trip while a tension (N) acts on the bit from below: 0 for a free one.
    ///
    /// # Errors
    /// [`Refusal::Depth`] or [`Refusal::Hole`].
    pub fn loads(&self, depth: f64, tension: f64, motion: &Motion) -> Result<Loads, Refusal> {
        self.check(depth)?;
        let (depths, slides) = self.tool.slides(depth, tension, motion.sense)?;
        let torque = if motion.spin == 0.0 {
            0.0
        } else {
            self.tool.torque(depth)
        };
        Ok(self.over(depth, &depths, &slides, torque, motion))
    }

    /// Loads of a trip with a free bit, along the hole at a speed (m/s), without rotation and with an angular speed (rad/s).
    ///
    /// # Errors
    /// [`Refusal::Depth`] or [`Refusal::Hole`].
    pub fn trip(&self, depth: f64, along: f64, spin: f64) -> Result<Trip, Refusal> {
        self.check(depth)?;
        let torque = self.tool.torque(depth);
        // The guide does not turn: it slides alike in both.
        let both = |sense| -> Result<[Loads; 2], Refusal> {
            let (depths, slides) = self.tool.slides(depth, 0.0, sense)?;
            let turning = Motion { sense, along, spin };
            Ok([
                self.over(depth, &depths, &slides, 0.0, &Motion::sliding(sense)),
                self.over(depth, &depths, &slides, torque, &turning),
            ])
        };
        Ok(Trip {
            out: both(Sense::Out)?,
            into: both(Sense::In)?,
            weight: self.weight(depth),
        })
    }

    fn check(&self, depth: f64) -> Result<(), Refusal> {
        let [least, most] = self.depths();
        // NaN fails the comparison.
        if depth >= least && depth <= most {
            return Ok(());
        }
        Err(Refusal::Depth { depth, least, most })
    }

    /// String over a guide that slides, with the depths of its points (m), whose pipe needs a torque (N m).
    fn over(&self, depth: f64, depths: &[f64], slides: &Sliding, torque: f64, motion: &Motion) -> Loads {
        let raised = self.tool.length() - depth;
        let top = Load {
            tension: slides.top_tension(),
            torque,
        };
        let hangs = self.line.length();
        let string = self.line.up(raised, top, motion).into_iter().rev();
        let mut stations: Vec<Station> = string
            .map(|(below_rig, load)| Station {
                depth: below_rig - hangs,
                tension: load.tension,
                torque: load.torque,
            })
            .collect();
        let tool_top = stations.len() - 1;
        // The pipe carries the torque and not the guide: what it loses on its way is known for the pipe as a whole.
        let of_guide = depths.iter().zip(&slides.tensions).skip(1);
        stations.extend(of_guide.map(|(&depth, &tension)| Station {
            depth,
            tension,
            torque: f64::NAN,
        }));
        Loads { stations, tool_top }
    }

    /// Tension of the string at the rig without any friction (N): the weight in mud that hangs.
    pub fn weight(&self, depth: f64) -> f64 {
        let raised = self.tool.length() - depth;
        let top = Load {
            tension: self.tool.hanging(depth),
            torque: 0.0,
        };
        let at_rig = self.line.up(raised, top, &Motion::TURNING);
        at_rig.last().map_or(top.tension, |(_, load)| load.tension)
    }
}
