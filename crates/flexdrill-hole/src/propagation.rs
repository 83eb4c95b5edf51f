//! The hole in depth: chords that the bit adds in the direction that it cuts.
//!
//! Per chord of length h, with A the hole's direction at the bit before and after, and u the bit's offset from the end of
//! the hole that continues along A_old:
//!
//! ```text
//! chord = A_old + u/h,      A_new = A_old + u/(theta h)     (trapezoidal: theta = 1/2)
//! ```
//!
//! The law of the bit for A_new makes a condition on the guide's end in place of u = 0, with its slope phi against the
//! tangent T of the continued hole:
//!
//! ```text
//! F = W phi + eta W_a Rot(-walk) [u/(theta h) + (A_old - T) - phi]
//! ```
//!
//! The new chord is an unknown of the statics. An explicit step, which cuts along the direction of the last equilibrium,
//! grows without bound where h exceeds the relaxation length eta W_a l3/(3 EI).

use flexdrill_base::validation::{Bound, require};
use nalgebra::{Matrix2, Vector2, Vector3};

use crate::hole::{azimuth, inclination};
use crate::statics::{AtBit, Statics};
use crate::{BitLaw, Guide, Hole, HoleError};

/// Share of the new direction in a chord. 1/2 is of second order; more damps, and adds curvature.
const THETA: f64 = 0.5;

/// The bit after a chord, or before the first one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advance {
    /// Depth drilled since the start (m).
    pub drilled: f64,
    /// Position of the bit (m), in the world's frame.
    pub position: Vector3<f64>,
    /// Inclination of the hole at the bit (rad).
    pub inclination: f64,
    /// Azimuth of the hole at the bit (rad).
    pub azimuth: f64,
    /// Curvature of the hole over the last chord (1/m) towards the high side of the hole's frame; 0 before the first chord.
    pub build: f64,
    /// Its curvature to the right of the hole's frame (1/m).
    pub walk: f64,
    /// F: force of the bit on the rock across the hole (right, low) (N).
    pub side_force: Vector2<f64>,
    /// t: tilt of the bit's axis against the hole's tangent (right, low) (rad).
    pub tilt: Vector2<f64>,
    /// Length between the bit and the first contact of the guide (m).
    pub free_length: f64,
}

/// A guide that drills.
#[derive(Debug, Clone)]
pub struct Propagation {
    guide: Guide,
    law: BitLaw,
    hole: Hole,
    /// A: direction of the hole at the bit.
    direction: Vector3<f64>,
    chord: f64,
    drilled: f64,
    statics: Statics,
}

impl Propagation {
    /// A guide in a hole as found. Its first direction is that of the law with the bit held at the hole's end, which may
    /// kink the hole there.
    ///
    /// `chord` (m) is the length of new chords: 0.02 to 0.04 m resolve a free length of 1 m.
    ///
    /// # Errors
    /// [`HoleError::Invalid`] for numbers out of bounds; [`HoleError::HoleTooShort`]; [`HoleError::NoEquilibrium`].
    pub fn begin(guide: Guide, law: BitLaw, hole: Hole, chord: f64) -> Result<(Self, Advance), HoleError> {
        guide.check()?;
        law.check()?;
        Bound::Above(0.0, 0.1 * guide.length).check("chord", chord, "m")?;
        require(hole.points().len() > 2, "hole", "fewer than two chords: shorten them")?;
        let mut statics = Statics::default();
        statics.solve(&guide, &law, &hole, &AtBit::Held)?;
        let end = hole.end();
        let (tilt, side_force) = (statics.tilt(), statics.side_force());
        let direction = (end.tangent + end.vector(law.turn(tilt, side_force))).normalize();
        let start = Self {
            guide,
            law,
            hole,
            direction,
            chord,
            drilled: 0.0,
            statics,
        };
        let at = start.state(Vector2::zeros(), side_force, tilt);
        Ok((start, at))
    }

    /// Changes the bit's load or the bit from here on.
    ///
    /// # Errors
    /// [`HoleError::Invalid`] for numbers out of bounds.
    pub fn set_law(&mut self, law: BitLaw) -> Result<(), HoleError> {
        law.check()?;
        self.law = law;
        Ok(())
    }

    /// The hole as drilled.
    pub const fn hole(&self) -> &Hole {
        &self.hole
    }

    /// Linear systems solved since the start: the measure of the work.
    pub const fn solves(&self) -> usize {
        self.statics.solves
    }

    /// Drills a chord.
    ///
    /// # Errors
    /// [`HoleError::NoEquilibrium`], after which the hole is as before.
    pub fn advance(&mut self) -> Result<Advance, HoleError> {
        let h = self.chord;
        let mut hole = std::mem::replace(&mut self.hole, Hole::empty());
        hole.extend(self.direction, h);
        let end = hole.end();
        let old = end.deviation(self.direction);
        let solved = self.statics.solve(&self.guide, &self.law, &hole, &self.condition(old));
        if let Err(error) = solved {
            hole.remove_last();
            self.hole = hole;
            return Err(error);
        }
        let offset = self.statics.bit_offset();
        hole.turn_last((self.direction + end.vector(offset / h)).normalize());
        self.hole = hole;
        let turn = offset / (THETA * h);
        self.direction = (end.tangent + end.vector(old + turn)).normalize();
        self.drilled += h;
        // Slope and force of the statics are against the tangent of the continued hole, which is only a frame. The reported
        // ones are against the direction drilled: W has a component across it.
        let drilled = old + turn;
        let tilt = self.statics.tilt() - drilled;
        let side_force = self.statics.side_force() - drilled * self.law.weight;
        Ok(self.state(turn / h, side_force, tilt))
    }

    /// Drills `metres` in whole chords, and reports each.
    ///
    /// # Errors
    /// As [`Propagation::advance`]; [`HoleError::Invalid`] for a length below 0.
    pub fn drill(&mut self, metres: f64) -> Result<Vec<Advance>, HoleError> {
        Bound::NotNegative.check("metres", metres, "m")?;
        let chords = (metres / self.chord).round();
        Bound::Within(0.0, 1e6).check("chords", chords, "")?;
        (0..chords as usize).map(|_| self.advance()).collect()
    }

    /// The law of the bit as a condition on the guide's end. `old` is A_old against the end's tangent (rad).
    fn condition(&self, old: Vector2<f64>) -> AtBit {
        let cutting = self.law.walk().transpose() * self.law.steering_resistance();
        AtBit::Cutting {
            offset: cutting / (THETA * self.chord),
            slope: Matrix2::identity() * self.law.weight - cutting,
            constant: cutting * old,
        }
    }

    /// What is reported of the bit, with the curvature (right, low) of the last chord (1/m).
    fn state(&self, curvature: Vector2<f64>, side_force: Vector2<f64>, tilt: Vector2<f64>) -> Advance {
        let points = self.hole.points();
        Advance {
            drilled: self.drilled,
            position: points[points.len() - 1],
            inclination: inclination(self.direction),
            azimuth: azimuth(self.direction),
            build: -curvature.y,
            walk: curvature.x,
            side_force,
            tilt,
            free_length: self.statics.free_length(&self.guide),
        }
    }
}
