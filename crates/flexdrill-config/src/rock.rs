//! `rock`: how the rock answers the bit.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Bound;
use super::section::{is_zero, section};
use flexdrill_core::tool::{DepthOfCut as Cut, RockLaw, Weakening as Falls};
use flexdrill_core::units::rpm_to_rad_per_s;

const BLADES: Bound = Bound::within(1.0, 24.0);

/// Laws of the rock's torque and weight.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// Eq. 1: the torque is proportional to the weight on bit.
    #[default]
    Paper,
    /// Eq. 1 with a torque that falls as the bit turns faster.
    Weakening,
    /// The torque and the weight follow from the depth of cut, with the paths of the blades before. Requires a string with
    /// a hoist (`string.model: line`).
    DepthOfCut,
}

section! {
    /// How the rock answers the bit.
    #[derive(Copy)]
    pub struct Rock(this) {
        /// Law: `paper` (Eq. 1), `weakening` (Eq. 1 with a torque that falls with the speed) or `depth_of_cut` (weight and
        /// torque follow from what the blades cut). Default paper.
        law: Law = Law::Paper;
        /// How the friction of the bit falls with its speed. Without effect with `paper`.
        weakening: Weakening = Weakening::default(), below;
        /// Bit and rock of the law `depth_of_cut`.
        depth_of_cut: DepthOfCut = DepthOfCut::default(), below;
    }
}

section! {
    /// Torque over that at high speed: 1 + (ratio - 1) exp(-speed / rate).
    #[derive(Copy)]
    pub struct Weakening(this) {
        /// Torque at standstill over that at high speed. 1 is no weakening; a laboratory rig measured about 2.
        ratio: f64 = 1.0, within(1.0, 5.0), "", "a ratio below 1 would be a torque that rises with the speed";
        /// Speed over which the difference falls to 37 %.
        rate_rpm: f64 = 100.0, within(0.1, 1000.0), "r/min", "slower than a tenth of a turn per minute is standstill";
    }
}

section! {
    /// Cutting and wear flats (Detournay and Defourny 1992).
    #[derive(Copy)]
    pub struct DepthOfCut(this) {
        /// Blades that cut one behind the other.
        #[schemars(transform = BLADES.in_schema())]
        blades: u32 = 4;
        /// Energy to cut a volume of rock (Pa).
        specific_energy: f64 = 30e6, within(1e5, 1e9), "Pa", "soft clay has some 1e6, the hardest rock some 5e8";
        /// Axial over tangential force of a sharp cutter.
        cutter_inclination: f64 = 0.6, within(0.05, 5.0), "", "drag bits have 0.3 to 1";
        /// Largest force of the wear flats on the rock (N). A weight below it does not drill.
        wear_flat_force: f64 = 8670.0, within(0.0, 1e6), "N", "0 is a sharp bit; no rig presses a small bit with more";
        /// Friction of the wear flats times a factor of the bit's geometry.
        wear_flat_friction: f64 = 0.106, within(0.0, 2.0), "", "0 is without friction; rock and steel rarely exceed 1";
        /// Distance over which the wear flats come to bear (m).
        wear_flat_travel: f64 = 1e-4, within(1e-6, 1e-2), "m",
            "shorter is stiffer than the guide; longer than a depth of cut has no meaning";
        /// Part of the torque of cutting that falls with the speed as the friction of the wear flats does
        /// ([`rock.weakening`](#rockweakening)).
        #[serde(skip_serializing_if = "is_zero")]
        cutting_weakening: f64 = 0.0, within(0.0, 1.0), "", "1 is all of it";
    }
}

impl Weakening {
    fn describe(&self) -> Falls {
        Falls {
            ratio: self.ratio,
            rate: rpm_to_rad_per_s(self.rate_rpm),
        }
    }
}

impl Rock {
    pub(super) fn check(&self, c: &mut super::Checker, has_line: bool) {
        self.check_numbers(c);
        c.below("depth_of_cut", |c| {
            c.count(
                "blades",
                self.depth_of_cut.blades as usize,
                BLADES,
                "bits have 3 to 9 blades",
            );
        });
        c.require(
            self.law != Law::DepthOfCut || has_line,
            "law",
            "depth_of_cut",
            "",
            "paper or weakening, or string.model: line",
            "the rock holds the bit, so that the top of the tool must be able to move along the hole",
        );
    }

    /// The law, for the mechanics.
    pub(super) fn describe(&self) -> RockLaw {
        match self.law {
            Law::Paper => RockLaw::Paper,
            Law::Weakening => RockLaw::Weakening(self.weakening.describe()),
            Law::DepthOfCut => RockLaw::DepthOfCut(Cut {
                blades: self.depth_of_cut.blades,
                specific_energy: self.depth_of_cut.specific_energy,
                cutter_inclination: self.depth_of_cut.cutter_inclination,
                wear_flat_force: self.depth_of_cut.wear_flat_force,
                wear_flat_friction: self.depth_of_cut.wear_flat_friction,
                wear_flat_travel: self.depth_of_cut.wear_flat_travel,
                weakening: self.weakening.describe(),
                cutting_weakening: self.depth_of_cut.cutting_weakening,
            }),
        }
    }
}
