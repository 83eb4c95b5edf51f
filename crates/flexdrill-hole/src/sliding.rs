//! A guide that slides along its hole on a trip: what its friction on the wall asks for at its upper end.
//!
//! The wall forces are those of the statics: of the weight, of the axial force on the curve, and of the guide that the hole
//! bends to another curvature than it was made with. The last need no axial force: a guide of free curvature kf in a straight
//! hole bears on the wall with F = EI kf / l at the bit and at the wall l = sqrt(6 c / kf) behind it, and alike at its upper
//! end.

use crate::error::HoleError;
use crate::guide::Guide;
use crate::hole::Hole;
use crate::statics::{AtBit, Equilibrium, Statics};
use crate::{BitLaw, Gravity};
use flexdrill_base::validation::{Bound, require};

/// Sense of a trip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sense {
    /// Out of the hole: friction adds to the tension from the bit up.
    Out,
    /// Into the hole: friction takes from the tension from the bit up.
    In,
}

impl Sense {
    /// +1 out of the hole, -1 into it: the sign with which friction adds to the tension from below to above.
    pub const fn sign(self) -> f64 {
        match self {
            Self::Out => 1.0,
            Self::In => -1.0,
        }
    }

    /// The other sense.
    #[must_use]
    pub const fn opposite(self) -> Self {
        match self {
            Self::Out => Self::In,
            Self::In => Self::Out,
        }
    }
}

/// A guide that slides.
#[derive(Debug, Clone, PartialEq)]
pub struct Sliding {
    /// Tension just above each point (N), from the upper end to the bit; below 0 the guide is pushed. Friction at the point is
    /// in it.
    pub tensions: Vec<f64>,
    /// Wall forces, offsets and forces at both ends.
    pub equilibrium: Equilibrium,
}

impl Sliding {
    /// Tension with which the string holds the guide's upper end (N).
    pub fn top_tension(&self) -> f64 {
        self.tensions.first().copied().unwrap_or(f64::NAN)
    }

    /// Sum of the sizes of all forces across the hole, those at both ends with them (N).
    pub fn normal_force(&self) -> f64 {
        let Equilibrium {
            side_force,
            top_force,
            wall_forces,
            ..
        } = &self.equilibrium;
        side_force.norm() + top_force.norm() + wall_forces.iter().map(|force| force.norm()).sum::<f64>()
    }
}

/// Solutions with which the friction of the bit is found: each leaves mu kb l / 2, some 5 %, of its error.
const SOLUTIONS: usize = 12;
/// Share of the weight and of the force that straightens the guide by which the last solution may change the friction of the
/// bit.
const TOLERANCE: f64 = 1e-5;

/// A guide that slides along a hole while a tension (N) acts on the bit from below: 0 for a free bit, below 0 for one that is
/// pushed. Bit and upper end are on the hole's axis, turn freely, and rub on the wall as the guide does.
///
/// # Errors
/// [`HoleError::Invalid`] for numbers out of bounds; [`HoleError::HoleTooShort`]; [`HoleError::NoEquilibrium`].
pub fn sliding(guide: &Guide, tension: f64, hole: &Hole, sense: Sense) -> Result<Sliding, HoleError> {
    guide.check()?;
    Bound::Finite.check("tension", tension, "N")?;
    require(
        guide.gravity == Gravity::Down,
        "guide.gravity",
        "a trip needs the weight along the hole: set Gravity::Down",
    )?;
    require(hole.points().len() > 2, "hole", "fewer than two chords: shorten them")?;
    // Friction acts on the thrust, which falls from the bit up where the tension rises.
    let rubbing = -sense.sign() * guide.wall_friction;
    let guide = Guide {
        wall_friction: rubbing,
        ..*guide
    };
    let loads = guide.weight_per_metre * guide.length
        + guide.bending_stiffness * guide.free_curvature.abs() / guide.length
        + tension.abs();
    let mut statics = Statics::default();
    let mut of_bit = 0.0;
    for _ in 0..SOLUTIONS {
        let law = BitLaw::sharp(of_bit - tension, 1.0);
        statics.solve(&guide, &law, hole, &AtBit::Held)?;
        let next = rubbing * statics.side_force().norm();
        let change = next - of_bit;
        of_bit = next;
        if change.abs() <= TOLERANCE * loads {
            let equilibrium = statics.equilibrium(&guide);
            let mut tensions: Vec<f64> = statics.axial.iter().map(|thrust| -thrust).collect();
            if let Some(top) = tensions.first_mut() {
                *top -= rubbing * equilibrium.top_force.norm();
            }
            return Ok(Sliding { tensions, equilibrium });
        }
    }
    Err(HoleError::NoEquilibrium {
        depth: hole.length(),
        weight: -tension,
        iterations: statics.solves,
    })
}
