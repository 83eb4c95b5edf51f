//! All contacts of a layer. The gap law runs over eight closed gaps at a time: stations queue until eight lanes are
//! full.

use std::ops::Range;

use super::bristle::Bristles;
use super::memory::LayerMemory;
use super::vector::VectorMemory;
use super::{GapLaw, Sliding, Touch, separate, vector};
use crate::simd::Kernel;
use crate::simd::aligned::Aligned;
use crate::simd::number::{Eight, Lane, Number};
use crate::simd::vector::Vector;
use crate::tool::FrictionLaw;

/// The closed gaps of a layer at the last residual, with their contacts.
#[derive(Debug, Clone)]
pub struct LayerContacts {
    /// Stations whose gap was found closed since the layer was cleared, in this order; the index is their slot.
    found: Vec<Found>,
    /// Their contacts by slot, eight to a group. Lanes after the last slot are unused.
    touches: Vec<Touch<Lane>>,
    /// A group whose contacts belong to slots of several groups.
    scattered: Touch<Lane>,
    /// Per station one more than its slot, or 0 where it has none.
    slots: Vec<usize>,
    /// Whether only some stations are being evaluated again, so that contacts keep their slots.
    partial: bool,
    /// Factor on the coefficients of friction at each station.
    friction_factors: Vec<f64>,
    /// Slots of the contacts that wait to be evaluated.
    waiting: [usize; 8],
    count: usize,
    /// A row of each: its [`PLACE`].
    places: [Lane; 8],
    /// A row of each: its velocity, in the first six numbers.
    velocities: [Lane; 8],
    /// A row of each: its motion since the start of the step, in the same numbers; for bristles only.
    travels: [Lane; 8],
    memory: LayerMemory,
    vector_memory: VectorMemory,
    bristles: Bristles,
}

/// Numbers of a contact that waits: lateral displacement y and z, clearance, factor on the friction, forces held by its bristles
/// around and along, two that are not used. Lanes without a contact are evaluated too: any distance other than zero avoids a
/// division by zero.
const PLACE: [f64; 8] = [1.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];

/// A station with a slot.
#[derive(Debug, Clone, Copy)]
struct Found {
    station: usize,
    /// Whether its gap is closed now.
    closed: bool,
}

impl LayerContacts {
    /// A layer of `stations` stations with the same friction, all gaps open.
    pub(crate) fn new(stations: usize) -> Self {
        Self::with_friction_factors(vec![1.0; stations])
    }

    /// A layer with a factor on the coefficients of friction at each of its stations, all gaps open.
    pub(crate) fn with_friction_factors(friction_factors: Vec<f64>) -> Self {
        let stations = friction_factors.len();
        Self {
            friction_factors,
            found: Vec::with_capacity(stations),
            touches: vec![Touch::default(); stations.div_ceil(8)],
            scattered: Touch::default(),
            slots: vec![0; stations],
            partial: false,
            waiting: [0; 8],
            count: 0,
            places: [Aligned(PLACE); 8],
            velocities: [Lane::default(); 8],
            travels: [Lane::default(); 8],
            memory: LayerMemory::new(stations),
            vector_memory: VectorMemory::new(stations),
            bristles: Bristles::new(stations),
        }
    }

    /// Starts a step of size `step` (s): the friction's memory of the previous step becomes void, and bristles start
    /// from the forces `held` per station, around and along (N). With a `step` of 0 they keep these.
    pub(crate) fn begin(&mut self, held: impl Iterator<Item = [f64; 2]>, step: f64) {
        self.memory.begin();
        self.vector_memory.begin();
        self.bristles.begin(held, step);
    }

    /// Energy in the bristles of all contacts (J); 0 without bristles.
    pub(crate) fn bristle_energy(&self, law: &GapLaw) -> f64 {
        if !law.has_bristles() || law.bristle_stiffness == 0.0 {
            return 0.0;
        }
        let squares = self
            .iter()
            .map(|(_, touch)| touch.tangential * touch.tangential + touch.axial * touch.axial);
        0.5 * squares.sum::<f64>() / law.bristle_stiffness
    }

    /// Opens all gaps.
    pub(crate) fn clear(&mut self) {
        for found in &self.found {
            self.slots[found.station] = 0;
        }
        self.found.clear();
        self.partial = false;
    }

    /// Opens the gaps of some stations before these are evaluated again; the others keep their contacts.
    pub(crate) fn open(&mut self, stations: Range<usize>) {
        self.partial = true;
        for slot in &self.slots[stations] {
            if let Some(slot) = slot.checked_sub(1) {
                self.found[slot].closed = false;
            }
        }
    }

    /// Sets how the gap that is pushed next has moved since the start of the step, in six lanes.
    #[inline(always)]
    pub(crate) fn set_travel<V: Vector>(&mut self, travel: V) {
        travel.store(&mut self.travels[self.count]);
    }

    /// Queues the closed gap of a station with its motion, the velocity in six lanes, see [`super`]. Contacts are
    /// complete after [`LayerContacts::finish`].
    #[inline(always)]
    pub(crate) fn push<V: Vector>(
        &mut self,
        law: &GapLaw,
        station: usize,
        lateral: [f64; 2],
        clearance: f64,
        velocity: V,
    ) {
        let known = if self.partial { self.slots[station] } else { 0 };
        let slot = match known.checked_sub(1) {
            Some(slot) => {
                self.found[slot].closed = true;
                slot
            }
            None => {
                self.found.push(Found { station, closed: true });
                self.slots[station] = self.found.len();
                self.found.len() - 1
            }
        };
        // Numbers are kept by contact and read one by one: the processor would wait for a vector that is read straight after its
        // numbers were written one by one.
        let lane = self.count;
        let place = &mut self.places[lane];
        [place[0], place[1], place[2], place[3]] = [lateral[0], lateral[1], clearance, self.friction_factors[station]];
        if law.has_bristles() {
            [place[4], place[5]] = self.bristles.held(station);
        }
        velocity.store(&mut self.velocities[lane]);
        self.waiting[lane] = slot;
        self.count += 1;
        if self.count == 8 {
            self.evaluate::<V>(law);
        }
    }

    /// Evaluates the last, incomplete group.
    #[inline(always)]
    pub(crate) fn finish<V: Vector>(&mut self, law: &GapLaw) {
        if self.count > 0 {
            self.evaluate::<V>(law);
        }
    }

    #[inline(always)]
    fn evaluate<V: Vector>(&mut self, law: &GapLaw) {
        V::call(Evaluate { layer: self, law });
    }

    /// Number of closed gaps.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.found.iter().filter(|found| found.closed).count()
    }

    /// The contact at a station, or `None` where the gap is open.
    #[inline(always)]
    pub fn get(&self, station: usize) -> Option<Touch> {
        let slot = self.slots.get(station)?.checked_sub(1)?;
        self.found[slot].closed.then(|| self.touches[slot / 8].lane(slot % 8))
    }

    /// Stations with a closed gap, and their contacts.
    #[inline(always)]
    pub fn iter(&self) -> impl Iterator<Item = (usize, Touch)> + '_ {
        self.among(|_| true)
    }

    /// The `wanted` ones of them.
    #[inline(always)]
    pub(crate) fn among(&self, wanted: impl Fn(usize) -> bool) -> impl Iterator<Item = (usize, Touch)> {
        self.slots_among(wanted)
            .map(|(station, slot)| (station, self.group(slot / 8).lane(slot % 8)))
    }

    /// The `wanted` stations with a closed gap, and the slots of their contacts: eight slots are a [`LayerContacts::group`].
    #[inline(always)]
    pub(crate) fn slots_among(&self, wanted: impl Fn(usize) -> bool) -> impl Iterator<Item = (usize, usize)> {
        let found = self.found.iter().enumerate();
        found
            .filter(move |(_, found)| found.closed && wanted(found.station))
            .map(|(slot, found)| (found.station, slot))
    }

    /// The contacts of eight slots, a slot per lane.
    #[inline(always)]
    pub(crate) fn group(&self, group: usize) -> &Touch<Lane> {
        &self.touches[group]
    }
}

/// The first numbers of eight rows: each number of all rows, a row per lane.
#[inline(always)]
fn columns<V: Vector, const N: usize>(rows: &[Lane; 8]) -> [Eight<V>; N] {
    let mut out = [Eight::<V>::of(0.0); N];
    for (k, x) in out.iter_mut().enumerate() {
        let mut lanes = Lane::default();
        for (to, from) in lanes.iter_mut().zip(rows) {
            *to = from[k];
        }
        *x = Eight::load(&lanes);
    }
    out
}

/// The law of the gap for the contacts that wait.
struct Evaluate<'a> {
    layer: &'a mut LayerContacts,
    law: &'a GapLaw,
}

impl Kernel for Evaluate<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self { layer, law } = self;
        let velocity = columns::<V, 6>(&layer.velocities);
        let [y, z, clearance, factor, around, along] = columns::<V, 6>(&layer.places);
        let mut touch = law.press([y, z], clearance, &velocity);
        let sliding = Sliding::of(&touch, &velocity);
        let mut factors = Lane::default();
        factor.store(&mut factors);
        let waiting = &layer.waiting[..layer.count];
        let stations = waiting.iter().map(|&slot| layer.found[slot].station);
        // All gaps are evaluated in order: the eight slots are one group. Where only some are evaluated again, their
        // slots are scattered over the groups.
        let lanes = if layer.partial {
            &mut layer.scattered
        } else {
            &mut layer.touches[waiting[0] / 8]
        };
        // Press before friction: the normal force is the scale of the friction.
        match law.surface.friction_law {
            FrictionLaw::Separate => {
                separate::rub(law, &mut touch, sliding, factor);
                touch.store(lanes);
                layer.memory.follow(law, stations, &factors, lanes);
            }
            FrictionLaw::Vector => {
                vector::rub(law, &mut touch, sliding, factor);
                touch.store(lanes);
                touch.coupling.store(&mut lanes.coupling);
                layer.vector_memory.follow(law, stations, &factors, lanes);
            }
            FrictionLaw::Bristle => {
                let travelled = Sliding::of(&touch, &columns::<V, 6>(&layer.travels));
                layer.bristles.rub(law, &mut touch, travelled, [around, along], factor);
                touch.store(lanes);
                touch.coupling.store(&mut lanes.coupling);
                // The tangent is by travel and not by velocity, which the factors of the scheme must know.
                lanes.by_travel = true;
            }
        }
        // A partial evaluation has its lanes from anywhere; they return to their slots.
        if layer.partial {
            for (lane, &slot) in waiting.iter().enumerate() {
                layer.touches[slot / 8].set_lane(slot % 8, &layer.scattered.lane(lane));
            }
        }
        layer.count = 0;
    }
}
