//! Small disturbances, by which runs from one state part.

use super::Stepper;
use crate::tool::description::Direction;

impl Stepper {
    /// Adds to the lateral velocity of the pipe (m/s), at every node and in both directions that are free, top to bottom
    /// and horizontal first, what `velocity` returns. Positions, forces and the energy audit
    /// stay as they are: the audit misses the kinetic energy that this adds.
    pub fn disturb(&mut self, mut velocity: impl FnMut() -> f64) {
        for station in &self.model.stations {
            for direction in [Direction::V, Direction::W] {
                let unknown = station.pipe_above + direction as usize;
                if let Some(place) = self.chain.model.place(unknown)
                    && self.model.held.binary_search(&unknown).is_err()
                {
                    self.track.state.v[place] += velocity();
                }
            }
        }
        self.view_is_current = false;
    }
}
