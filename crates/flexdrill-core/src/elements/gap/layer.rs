//! All contacts of a layer: the law of the gap over eight touching stations at a time.

use super::{GapLaw, Touch};
use crate::simd::aligned::Aligned;
use crate::simd::number::{Eight, Lane, Number};
use crate::simd::vector::Vector;

/// What touches in a layer, at the last residual.
#[derive(Debug)]
pub struct Layer {
    /// Touching stations, in the order in which they were found.
    stations: Vec<usize>,
    /// Their contacts, eight to a group. Lanes beyond the last are of no use.
    touches: Vec<Touch<Lane>>,
    /// Per station one more than its place in `stations`, or 0 where the gap is open.
    places: Vec<usize>,
    /// Motion of the stations of the group that is not full yet; lanes beyond hold that of others.
    lateral: [Lane; 2],
    clearance: Lane,
    velocity: [Lane; 6],
}

impl Layer {
    /// Room for so many stations.
    pub(crate) fn new(stations: usize) -> Self {
        Self {
            stations: Vec::with_capacity(stations),
            touches: vec![Touch::default(); stations.div_ceil(8)],
            places: vec![0; stations],
            // Any distance but zero will do.
            lateral: [Aligned([1.0; 8]); 2],
            clearance: Lane::default(),
            velocity: [Lane::default(); 6],
        }
    }

    /// Opens all gaps.
    pub(crate) fn clear(&mut self) {
        for &station in &self.stations {
            self.places[station] = 0;
        }
        self.stations.clear();
    }

    /// Adds the closed gap of a station with its motion, see [`GapLaw::touch`]; what touches is known after
    /// [`Layer::finish`].
    #[inline(always)]
    pub(crate) fn push<V: Vector>(
        &mut self,
        law: &GapLaw,
        station: usize,
        lateral: [f64; 2],
        clearance: f64,
        velocity: &[f64; 6],
    ) {
        let lane = self.stations.len() % 8;
        for (lanes, x) in self.lateral.iter_mut().zip(lateral) {
            lanes[lane] = x;
        }
        self.clearance[lane] = clearance;
        for (lanes, x) in self.velocity.iter_mut().zip(velocity) {
            lanes[lane] = *x;
        }
        self.stations.push(station);
        self.places[station] = self.stations.len();
        if lane == 7 {
            self.evaluate::<V>(law);
        }
    }

    /// Evaluates what is left of the last group.
    #[inline(always)]
    pub(crate) fn finish<V: Vector>(&mut self, law: &GapLaw) {
        if !self.stations.len().is_multiple_of(8) {
            self.evaluate::<V>(law);
        }
    }

    #[inline(always)]
    fn evaluate<V: Vector>(&mut self, law: &GapLaw) {
        let Some(to) = self.touches.get_mut(self.stations.len().saturating_sub(1) / 8) else {
            return;
        };
        let mut velocity = [Eight::<V>::of(0.0); 6];
        for (x, lanes) in velocity.iter_mut().zip(&self.velocity) {
            *x = Eight::load(lanes);
        }
        let lateral = [Eight::load(&self.lateral[0]), Eight::load(&self.lateral[1])];
        law.touch(lateral, Eight::load(&self.clearance), &velocity).store(to);
    }

    /// How many gaps are closed.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.stations.len()
    }

    /// The contact at a station, or `None` where the gap is open.
    #[inline(always)]
    pub fn get(&self, station: usize) -> Option<Touch> {
        let place = self.places.get(station)?.checked_sub(1)?;
        Some(self.touches[place / 8].lane(place % 8))
    }

    /// Touching stations with their contacts.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (usize, Touch)> + '_ {
        let touch = |place: usize| self.touches[place / 8].lane(place % 8);
        self.stations
            .iter()
            .enumerate()
            .map(move |(place, &station)| (station, touch(place)))
    }
}
