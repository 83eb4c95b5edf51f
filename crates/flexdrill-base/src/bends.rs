//! The curvature of a tube as made, piece by piece from its lower end up.

use serde::{Deserialize, Serialize};

use crate::validation::{Bound, ValidationError, require};

/// Where a tube changes its curvature.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Bend {
    /// Distance from the lower end (m).
    pub from: f64,
    /// Curvature of the tube as made above it (1/m).
    pub curvature: f64,
}

/// Curvatures of a tube above the piece at its lower end, from below; none in a tube of one curvature. The curvature of
/// that piece is not in here: methods take it as `end` (1/m). The last piece reaches to the upper end.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Bends {
    changes: [Bend; Self::MOST],
    count: usize,
}

impl Bends {
    /// Most changes of curvature along a tube.
    pub const MOST: usize = 8;

    /// Of these changes.
    ///
    /// # Errors
    /// [`ValidationError`] for more than [`Bends::MOST`], distances that do not rise from above 0, and curvatures that are not
    /// finite.
    pub fn new(changes: &[Bend]) -> Result<Self, ValidationError> {
        let mut bends = Self::default();
        require(
            changes.len() <= Self::MOST,
            "bends",
            "more than 8 changes of curvature: join pieces",
        )?;
        for (to, change) in bends.changes.iter_mut().zip(changes) {
            *to = *change;
        }
        bends.count = changes.len();
        bends.check()?;
        Ok(bends)
    }

    /// Checks the numbers, which may have been read from a file.
    ///
    /// # Errors
    /// As [`Bends::new`].
    pub fn check(&self) -> Result<(), ValidationError> {
        require(
            self.count <= Self::MOST,
            "bends",
            "more than 8 changes of curvature: join pieces",
        )?;
        let mut before = 0.0;
        for change in self.changes() {
            Bound::Over(before).check("bends.from", change.from, "m")?;
            Bound::Finite.check("bends.curvature", change.curvature, "1/m")?;
            before = change.from;
        }
        Ok(())
    }

    /// The changes, from below.
    pub fn changes(&self) -> &[Bend] {
        self.changes.get(..self.count).unwrap_or(&self.changes)
    }

    /// Whether the tube has one curvature.
    pub const fn is_none(&self) -> bool {
        self.count == 0
    }

    /// Curvature at a distance from the lower end (1/m).
    pub fn at(&self, end: f64, distance: f64) -> f64 {
        let below = self.changes().iter().take_while(|change| change.from <= distance);
        below.last().map_or(end, |change| change.curvature)
    }

    /// Mean curvature between two distances from the lower end (1/m). Within a piece, and over pieces that are alike, it is
    /// that of the piece to the bit.
    pub fn mean(&self, end: f64, near: f64, far: f64) -> f64 {
        let mut mean = self.at(end, near);
        let mut before = mean;
        let within = self.changes().iter().skip_while(|change| change.from <= near);
        for change in within.take_while(|change| change.from < far) {
            mean += (change.curvature - before) * (far - change.from) / (far - near);
            before = change.curvature;
        }
        mean
    }

    /// Integrals of the curvature (1), and of the curvature times the distance from the lower end (m), up to a distance (m).
    pub fn integrals(&self, end: f64, distance: f64) -> [f64; 2] {
        let mut integrals = [end * distance, 0.5 * end * distance * distance];
        let mut before = end;
        for change in self.changes().iter().take_while(|change| change.from < distance) {
            let more = change.curvature - before;
            integrals[0] += more * (distance - change.from);
            integrals[1] += 0.5 * more * (distance * distance - change.from * change.from);
            before = change.curvature;
        }
        integrals
    }

    /// The same tube with all curvatures times a factor.
    #[must_use]
    pub fn times(mut self, factor: f64) -> Self {
        for change in &mut self.changes {
            change.curvature *= factor;
        }
        self
    }

    /// The same tube with a curvature (1/m) more all along.
    #[must_use]
    pub fn plus(mut self, curvature: f64) -> Self {
        for change in &mut self.changes {
            change.curvature += curvature;
        }
        self
    }

    /// Largest size of a curvature (1/m).
    pub fn most(&self, end: f64) -> f64 {
        let sizes = self.changes().iter().map(|change| change.curvature.abs());
        sizes.fold(end.abs(), f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bends(changes: &[(f64, f64)]) -> Bends {
        let changes: Vec<Bend> = changes
            .iter()
            .map(|&(from, curvature)| Bend { from, curvature })
            .collect();
        Bends::new(&changes).unwrap()
    }

    #[test]
    fn means_and_integrals_are_those_of_the_pieces() {
        // 0.2 up to 1 m, 0.5 up to 3 m, 0 above.
        let tube = bends(&[(1.0, 0.5), (3.0, 0.0)]);
        assert_eq!(
            [0.0, 0.99, 1.0, 2.0, 3.0, 9.0].map(|at| tube.at(0.2, at)),
            [0.2, 0.2, 0.5, 0.5, 0.0, 0.0]
        );
        assert!((tube.mean(0.2, 0.5, 1.5) - 0.35).abs() < 1e-15);
        assert!((tube.mean(0.2, 0.0, 4.0) - (0.2 + 1.0) / 4.0).abs() < 1e-15);
        assert_eq!(tube.mean(0.2, 1.2, 2.9).to_bits(), 0.5_f64.to_bits());
        let [whole, moment] = tube.integrals(0.2, 4.0);
        // 0.2 * 1 + 0.5 * 2, and 0.2 * 1/2 + 0.5 * (9 - 1)/2.
        assert!(
            (whole - 1.2).abs() < 1e-15 && (moment - 2.1).abs() < 1e-15,
            "{whole} {moment}"
        );
        assert_eq!((tube.most(-0.7), tube.times(2.0).at(0.2, 1.0)), (0.7, 1.0));
    }

    #[test]
    fn pieces_that_are_alike_are_one_to_the_bit() {
        let (one, alike) = (Bends::default(), bends(&[(0.7, 0.3125), (1.9, 0.3125)]));
        for (near, far) in [(0.0, 0.1), (0.65, 0.71), (0.1, 3.0), (1.9, 1.95)] {
            assert_eq!(
                alike.mean(0.3125, near, far).to_bits(),
                one.mean(0.3125, near, far).to_bits()
            );
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let of = |changes: &[(f64, f64)]| {
            let changes: Vec<Bend> = changes
                .iter()
                .map(|&(from, curvature)| Bend { from, curvature })
                .collect();
            Bends::new(&changes).is_ok()
        };
        assert!(of(&[]) && of(&[(0.1, 0.0)]));
        for wrong in [
            &[(0.0, 0.1)][..],
            &[(1.0, 0.1), (1.0, 0.2)],
            &[(1.0, f64::NAN)],
            &[(f64::NAN, 0.1)],
        ] {
            assert!(!of(wrong), "{wrong:?}");
        }
        let nine: Vec<(f64, f64)> = (1..=9).map(|from| (f64::from(from), 0.1)).collect();
        assert!(of(&nine[..8]) && !of(&nine));
    }
}
