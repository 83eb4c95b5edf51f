//! The energy ledger's terms: each is one row of a table, which gives its field, its side of the balance and its words.

use serde::{Deserialize, Serialize};

/// Side of the balance on which a term of [`Energies`] stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Put into the tool and the string above it.
    PutIn,
    /// Taken from them.
    Taken,
    /// Of the balance no part: what is stored and left over, or a part of another term.
    Apart,
}

/// A row of the ledger.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    /// Its field in [`Energies`].
    pub name: &'static str,
    /// Its name in a table of energies, with the unit.
    pub joules: &'static str,
    /// Its side of the balance.
    pub side: Side,
    /// Its value.
    pub of: fn(&Energies) -> f64,
}

macro_rules! ledger {
    ($($(#[doc = $text:literal])+ $name:ident: $side:ident;)+) => {
        /// Energies since the start (J), or mean powers over a time (W): the terms of the ledger, see [`Energies::TERMS`].
        #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
        #[non_exhaustive]
        pub struct Energies {
            $($(#[doc = $text])+ pub $name: f64,)+
        }

        impl Energies {
            /// The rows, in the order in which the balance adds them.
            pub const TERMS: [Term; [$(stringify!($name)),+].len()] = [$(Term {
                name: stringify!($name),
                joules: concat!(stringify!($name), "_j"),
                side: Side::$side,
                of: |energies| energies.$name,
            }),+];

            /// From the values of all rows, in their order.
            pub const fn of([$($name),+]: [f64; Self::COUNT]) -> Self {
                Self { $($name),+ }
            }

            /// The values of all rows, in their order; [`Energies::of`] reverses it.
            pub const fn values(&self) -> [f64; Self::COUNT] {
                [$(self.$name),+]
            }
        }
    };
}

ledger! {
    /// Work of the top drive.
    drive: PutIn;
    /// Work of the weight on bit; below a hoist over the whole way of the bit, the advance of the frame included.
    weight_on_bit: PutIn;
    /// Work of gravity.
    gravity: PutIn;
    /// Work of the configured point loads.
    loads: PutIn;
    /// Work of the advance against the axial friction of the wall; below a hoist with that of the weight on bit and less that
    /// of the string's force over the advance. The tool moves in a frame that advances, string and rock in that of the hole.
    feed: PutIn;
    /// Work of updating the axial force in the geometric stiffness between steps.
    axial_update: PutIn;
    /// Work of the pressure in the pipe: on its lower end, and by stretching its wall.
    pressure: PutIn;
    /// Work of the hoist on the string above.
    hoist: PutIn;
    /// Energy taken by the rock.
    bit: Taken;
    /// Energy taken by friction in both layers and in the joints' pins.
    friction: Taken;
    /// Energy taken by the damping of contacts, joint stops and joints with play.
    contact_damping: Taken;
    /// Energy taken by Rayleigh damping.
    rayleigh_damping: Taken;
    /// Energy taken by the time integration itself.
    numerical_damping: Taken;
    /// Energy that the string above has lost, to friction on the wall and inside.
    string: Taken;
    /// Energy taken by the viscosity of the mud around the pipes.
    mud: Taken;
    /// Part of `friction` that the joints' pins took.
    joint_friction: Apart;
    /// Part of `axial_update` that belongs to no physical law: the work of the foreseen axial forces less that of the axial
    /// forces of the displacements at the end of each step. Positive feeds the motion.
    axial_foresight: Apart;
    /// Magnitudes of `error` less `axial_foresight`, sub-step by sub-step: what cancels over time counts here.
    against_laws: Apart;
    /// Change of kinetic plus elastic plus contact energy since the start.
    stored: Apart;
    /// Work in, less energy out, less stored: zero for an exact integration.
    error: Apart;
}

impl Energies {
    /// Number of rows.
    pub const COUNT: usize = Self::TERMS.len();

    /// No row is known.
    pub const UNKNOWN: Self = Self::of([f64::NAN; Self::COUNT]);

    /// Sum of the rows of one side.
    pub fn sum(&self, side: Side) -> f64 {
        let rows = Self::TERMS.iter().zip(self.values());
        rows.filter(|(term, _)| term.side == side).map(|(_, value)| value).sum()
    }

    /// What damping takes: that of contacts, of the steel, of the scheme, and of effects.
    pub fn damped(&self) -> f64 {
        self.contact_damping + self.rayleigh_damping + self.numerical_damping + self.damped_by_effects()
    }

    /// The part of that which effects take: the viscosity of the mud.
    pub fn damped_by_effects(&self) -> f64 {
        self.mud
    }

    /// What is put in, less what is taken, less what is stored: the value of `error` for these rows.
    pub fn unbalanced(&self) -> f64 {
        self.sum(Side::PutIn) - self.sum(Side::Taken) - self.stored
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_places_and_their_sides() {
        let numbered = std::array::from_fn(|row| (row + 1) as f64);
        let energies = Energies::of(numbered);
        assert_eq!(energies.values(), numbered);
        for (term, value) in Energies::TERMS.iter().zip(numbered) {
            assert_eq!((term.of)(&energies), value, "{}", term.name);
        }
        // By hand: what is put in, less what is taken, less what is stored.
        let mut by_hand = Energies::default();
        (by_hand.drive, by_hand.hoist, by_hand.axial_update) = (100.0, 10.0, 1.0);
        (by_hand.bit, by_hand.mud, by_hand.stored) = (50.0, 5.0, 16.0);
        (by_hand.joint_friction, by_hand.against_laws) = (1e3, 1e3);
        assert_eq!(by_hand.unbalanced(), 40.0);
        assert!(Energies::UNKNOWN.values().iter().all(|value| value.is_nan()));
    }
}
