//! All contacts of a layer: the law of the gap over eight touching stations at a time.

use std::ops::Range;

use super::memory::LayerMemory;
use super::{GapLaw, Touch};
use crate::simd::aligned::Aligned;
use crate::simd::number::{Eight, Lane, Number};
use crate::simd::vector::Vector;

/// What touches in a layer, at the last residual.
#[derive(Debug)]
pub struct Layer {
    /// Stations found to touch since the layer was cleared, in this order.
    found: Vec<Found>,
    /// Their contacts, eight to a group. Lanes beyond the last are of no use.
    touches: Vec<Touch<Lane>>,
    /// Per station one more than its place in `found`, or 0 where it has none.
    places: Vec<usize>,
    /// Whether some stations only are looked at again, so that contacts keep their places.
    again: bool,
    /// Places of those that wait to be evaluated.
    waiting: [usize; 8],
    count: usize,
    /// Their places in the gap, and the velocity of each in its first six lanes; what is beyond is of others.
    lateral: [Lane; 2],
    clearance: Lane,
    velocities: [Lane; 8],
    memory: LayerMemory,
}

/// A station with a place.
#[derive(Debug, Clone, Copy)]
struct Found {
    station: usize,
    /// Whether its gap is still closed.
    closed: bool,
}

impl Layer {
    /// Room for so many stations.
    pub(crate) fn new(stations: usize) -> Self {
        Self {
            found: Vec::with_capacity(stations),
            touches: vec![Touch::default(); stations.div_ceil(8)],
            places: vec![0; stations],
            again: false,
            waiting: [0; 8],
            count: 0,
            // Any distance but zero will do.
            lateral: [Aligned([1.0; 8]); 2],
            clearance: Lane::default(),
            velocities: [Lane::default(); 8],
            memory: LayerMemory::new(stations),
        }
    }

    /// Begins the corrections of a step: what those of the step before have learned is forgotten.
    pub(crate) fn begin(&mut self) {
        self.memory.begin();
    }

    /// Opens all gaps.
    pub(crate) fn clear(&mut self) {
        for found in &self.found {
            self.places[found.station] = 0;
        }
        self.found.clear();
        self.again = false;
    }

    /// Opens the gaps of some stations, which are looked at again; the others stay as they are.
    pub(crate) fn open(&mut self, stations: Range<usize>) {
        self.again = true;
        for place in &self.places[stations] {
            if let Some(place) = place.checked_sub(1) {
                self.found[place].closed = false;
            }
        }
    }

    /// Adds the closed gap of a station with its motion, the velocity in six lanes, see [`GapLaw::touch`]; what touches is
    /// known after [`Layer::finish`].
    #[inline(always)]
    pub(crate) fn push<V: Vector>(
        &mut self,
        law: &GapLaw,
        station: usize,
        lateral: [f64; 2],
        clearance: f64,
        velocity: V,
    ) {
        let known = if self.again { self.places[station] } else { 0 };
        let place = match known.checked_sub(1) {
            Some(place) => {
                self.found[place].closed = true;
                place
            }
            None => {
                self.found.push(Found { station, closed: true });
                self.places[station] = self.found.len();
                self.found.len() - 1
            }
        };
        let lane = self.count;
        for (lanes, x) in self.lateral.iter_mut().zip(lateral) {
            lanes[lane] = x;
        }
        self.clearance[lane] = clearance;
        velocity.store(&mut self.velocities[lane]);
        self.waiting[lane] = place;
        self.count += 1;
        if self.count == 8 {
            self.evaluate::<V>(law);
        }
    }

    /// Evaluates what is left of the last group.
    #[inline(always)]
    pub(crate) fn finish<V: Vector>(&mut self, law: &GapLaw) {
        if self.count > 0 {
            self.evaluate::<V>(law);
        }
    }

    #[inline(always)]
    fn evaluate<V: Vector>(&mut self, law: &GapLaw) {
        let mut velocity = [Eight::<V>::of(0.0); 6];
        for (k, x) in velocity.iter_mut().enumerate() {
            let mut lanes = Lane::default();
            for (to, from) in lanes.iter_mut().zip(&self.velocities) {
                *to = from[k];
            }
            *x = Eight::load(&lanes);
        }
        let lateral = [Eight::load(&self.lateral[0]), Eight::load(&self.lateral[1])];
        let touch = law.touch(lateral, Eight::load(&self.clearance), &velocity);
        let waiting = &self.waiting[..self.count];
        let stations = waiting.iter().map(|&place| self.found[place].station);
        if self.again {
            let mut lanes = Touch::default();
            touch.store(&mut lanes);
            self.memory.follow(law, stations, &mut lanes);
            for (lane, &place) in waiting.iter().enumerate() {
                self.touches[place / 8].put(place % 8, &lanes.lane(lane));
            }
        } else {
            let lanes = &mut self.touches[waiting[0] / 8];
            touch.store(lanes);
            self.memory.follow(law, stations, lanes);
        }
        self.count = 0;
    }

    /// How many gaps are closed.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.found.iter().filter(|found| found.closed).count()
    }

    /// The contact at a station, or `None` where the gap is open.
    #[inline(always)]
    pub fn get(&self, station: usize) -> Option<Touch> {
        let place = self.places.get(station)?.checked_sub(1)?;
        self.found[place]
            .closed
            .then(|| self.touches[place / 8].lane(place % 8))
    }

    /// Touching stations with their contacts.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (usize, Touch)> + '_ {
        self.among(|_| true)
    }

    /// Those of them that are `wanted`.
    #[inline(always)]
    pub(crate) fn among(&self, wanted: impl Fn(usize) -> bool) -> impl Iterator<Item = (usize, Touch)> {
        let touch = |place: usize| self.touches[place / 8].lane(place % 8);
        let found = self.found.iter().enumerate();
        found
            .filter(move |(_, found)| found.closed && wanted(found.station))
            .map(move |(place, found)| (found.station, touch(place)))
    }
}
