//! Joints one after the other, as the witness over all stations reads them.

use super::{JointGroup, Joints, pin_lanes, rotations};
use crate::dynamics::state::State;
use crate::model::JointPlaces;
use crate::simd::Kernel;
use crate::simd::vector::Vector;

impl Joints {
    /// Linearises rows, stops, play and friction of all joints at `state`, whose rotations are at `places`, and hands each
    /// joint with its number to `visit`.
    pub(crate) fn linearise(
        &mut self,
        places: &[JointPlaces],
        state: &State,
        visit: impl FnMut(usize, &JointLinearisation<'_>),
    ) {
        self.instructions.run(LineariseJoints {
            groups: &mut self.groups,
            places,
            state,
            visit,
        });
    }
}

/// A joint as linearised by the last residual.
pub(crate) struct JointLinearisation<'a> {
    group: &'a JointGroup,
    lane: usize,
}

impl JointLinearisation<'_> {
    /// Number of its rotational rows that are constraints.
    #[inline(always)]
    pub fn rows(&self) -> usize {
        if self.group.has_play() {
            0
        } else {
            self.group.rows().len()
        }
    }

    /// Value of rotational row `r` (-).
    #[inline(always)]
    pub fn value(&self, r: usize) -> f64 {
        self.group.rows()[r].value[self.lane]
    }

    /// Its gradient in the six rotations.
    #[inline(always)]
    pub fn gradient(&self, r: usize) -> [f64; 6] {
        let gradient = &self.group.rows()[r].gradient;
        [0, 1, 2, 3, 4, 5].map(|k| gradient[k][self.lane])
    }

    /// Moments of the stop on the six rotations (N m); `None` where no stop of its group of eight is shut.
    #[inline(always)]
    pub fn stop_moments(&self) -> Option<[f64; 6]> {
        let (stop, lane) = (self.group.shut_stop()?, self.lane);
        Some([0, 1, 2, 3, 4, 5].map(|k| stop.gradient[k][lane] * stop.moment[lane]))
    }

    /// Moments of play and friction on the six rotations (N m); `None` where there is neither.
    #[inline(always)]
    pub fn further_moments(&self) -> Option<[f64; 6]> {
        self.group.further_moments(self.lane)
    }
}

/// Rotational rows and stops, eight joints at a time.
struct LineariseJoints<'a, F> {
    groups: &'a mut [JointGroup],
    places: &'a [JointPlaces],
    state: &'a State,
    visit: F,
}

impl<F: FnMut(usize, &JointLinearisation<'_>)> Kernel for LineariseJoints<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self {
            groups,
            places,
            state,
            mut visit,
        } = self;
        for (g, group) in groups.iter_mut().enumerate() {
            let first = 8 * g;
            let places = &places[first..];
            let count = places.len().min(8);
            let (q, rate) = rotations(&places[..count], state);
            group.linearise::<V>(&q, &rate, &pin_lanes(&state.pin_moments, first));
            for lane in 0..count {
                visit(first + lane, &JointLinearisation { group, lane });
            }
        }
    }
}
