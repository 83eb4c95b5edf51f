//! What the corrections of a step have learned of the friction of a layer's contacts.

use super::{GapLaw, Touch};
use crate::elements::slip::{Slip, SlipMemory};
use crate::simd::number::Lane;

/// Of all stations of a layer.
#[derive(Debug)]
pub(super) struct LayerMemory {
    /// Steps begun so far.
    step: u64,
    contacts: Vec<ContactMemory>,
}

/// Of one station.
#[derive(Debug, Clone, Copy)]
struct ContactMemory {
    /// The step in which it was learned.
    step: u64,
    /// Around and along.
    slip: [SlipMemory; 2],
}

impl LayerMemory {
    /// Room for so many stations.
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

    /// Begins the corrections of a step: what was learned before is forgotten.
    pub(super) fn begin(&mut self) {
        self.step += 1;
    }

    /// Sets the slopes of the friction of `touches`, the contacts at `stations` lane by lane. A contact that opened and
    /// shut again within a step continues with what was learned of it.
    #[inline(always)]
    pub(super) fn follow(&mut self, law: &GapLaw, stations: impl Iterator<Item = usize>, touches: &mut Touch<Lane>) {
        let full = law.friction();
        for (lane, station) in stations.enumerate() {
            let contact = &mut self.contacts[station];
            let known = contact.step == self.step;
            contact.step = self.step;
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
    use crate::elements::gap::{GapLaw, Layer};
    use crate::simd::vector::{Portable, Vector};
    use crate::tool::GapDescription;

    /// A contact that slides around at `speed` (m/s).
    fn slide(layer: &mut Layer, speed: f64) -> [f64; 2] {
        let law = GapLaw {
            surface: GapDescription {
                stiffness: 1e7,
                damping: 0.5,
                friction_tangential: 0.7,
                friction_axial: 0.7,
            },
            slip_speed: 0.01,
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
        let exact = |speed: f64| slide(&mut Layer::new(5), speed);
        let mut layer = Layer::new(5);
        layer.begin();
        assert_eq!(slide(&mut layer, 0.1), exact(0.1));
        let [friction, slope] = slide(&mut layer, -0.1);
        // A correction from 0.1 to -0.1 m/s changes the friction by twice the full one; the exact slope, at ten widths on
        // either side, knows of a hundredth of it.
        assert_eq!(friction, exact(-0.1)[0]);
        let chord = (exact(-0.1)[0] - exact(0.1)[0]).abs() / 0.2;
        assert!(slope > chord && slope < 2.0 * chord, "{slope} against {chord}");
        layer.begin();
        assert_eq!(slide(&mut layer, -0.1), exact(-0.1));
    }
}
