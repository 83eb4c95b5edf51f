//! Memory of the friction at the contacts of a layer, over the corrections of a step.

use super::{GapLaw, Touch};
use crate::elements::slip::{Slip, SlipMemory};
use crate::simd::number::Lane;

/// Memory of all stations of a layer.
#[derive(Debug, Clone)]
pub(super) struct LayerMemory {
    /// Number of the step; entries of earlier steps are void, so that starting a step clears nothing.
    step: u64,
    contacts: Vec<ContactMemory>,
}

/// Memory of one station.
#[derive(Debug, Clone, Copy)]
struct ContactMemory {
    /// The step that it belongs to.
    step: u64,
    /// Sliding around the circumference and along the axis.
    slip: [SlipMemory; 2],
}

impl LayerMemory {
    /// A memory for `stations` stations.
    pub(super) fn new(stations: usize) -> Self {
        let nothing = ContactMemory {
            step: 0,
            slip: [SlipMemory::new(Slip::default()); 2],
        };
        Self {
            step: 1,
            contacts: vec![nothing; stations],
        }
    }

    /// Starts a step: the memory of the previous one becomes void.
    pub(super) fn begin(&mut self) {
        self.step += 1;
    }

    /// Sets the slopes of the friction of `touches`, the contacts at `stations` lane by lane with their `factors` on the
    /// coefficients. A contact that opens and closes again within a step keeps its memory.
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        law: &GapLaw,
        stations: impl Iterator<Item = usize>,
        factors: &Lane,
        touches: &mut Touch<Lane>,
    ) {
        for (lane, station) in stations.enumerate() {
            let contact = &mut self.contacts[station];
            let known = contact.step == self.step;
            contact.step = self.step;
            let full = law.friction(factors[lane]);
            for ((memory, slips), full) in contact.slip.iter_mut().zip(&mut touches.slip).zip(full) {
                let mut slip = slips.lane(lane);
                if known {
                    memory.follow(&mut slip, full, law.slip_speed);
                    slips.slope[lane] = slip.slope;
                } else {
                    *memory = SlipMemory::new(slip);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::effects::contact::law::{GapLaw, LayerContacts};
    use crate::simd::vector::{Portable, Vector};
    use crate::tool::{FrictionLaw, GapDescription};

    /// A contact that slides around at `speed` (m/s).
    fn slide(friction_law: FrictionLaw, layer: &mut LayerContacts, speed: f64) -> [f64; 2] {
        let law = GapLaw {
            surface: GapDescription {
                friction_law,
                ..GapDescription::new(1e7, 0.7)
            },
            slip_speed: 0.01,
            bristle_stiffness: 8e6,
        };
        layer.clear();
        let velocity = Portable::load(&[0.0, 0.0, 0.0, speed, 0.0, 0.0, 0.0, 0.0]);
        layer.push::<Portable>(&law, 3, [8.6e-3, 0.0], 8.5e-3, velocity);
        layer.finish::<Portable>(&law);
        let touch = layer.get(3).unwrap();
        [touch.tangential, touch.tangent(0.0, 1.0).by_around]
    }

    #[test]
    fn a_turned_slide_is_remembered_within_a_step_only() {
        for law in [FrictionLaw::Separate, FrictionLaw::Vector] {
            let exact = |speed: f64| slide(law, &mut LayerContacts::new(5), speed);
            let mut layer = LayerContacts::new(5);
            let begin = |layer: &mut LayerContacts| layer.begin(std::iter::empty(), 5e-4);
            begin(&mut layer);
            assert_eq!(slide(law, &mut layer, 0.1), exact(0.1));
            let [friction, slope] = slide(law, &mut layer, -0.1);
            // A correction from 0.1 to -0.1 m/s changes the friction by twice the full one; the exact slope, at ten
            // widths on either side, knows of a hundredth of it.
            assert_eq!(friction, exact(-0.1)[0]);
            let chord = (exact(-0.1)[0] - exact(0.1)[0]).abs() / 0.2;
            assert!(slope > chord && slope < 2.0 * chord, "{slope} against {chord}");
            begin(&mut layer);
            assert_eq!(slide(law, &mut layer, -0.1), exact(-0.1));
        }
    }
}
