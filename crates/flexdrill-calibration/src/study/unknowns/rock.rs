//! What the bit does in the rock: friction and force of its wear flats, inclination of its cutters, energy of the rock.

use super::Modelled;
use crate::CalibrationError;
use crate::unknown::{Shape, Unknown};
use flexdrill_config::{Config, Law};

/// Torque over weight and the rate of penetration at two weights tell these four apart, where the law has them all
/// (Detournay and Defourny 1992). Taken as exact, another force or inclination would be explained by a friction that no bit
/// has.
pub(super) fn of(
    config: &Config,
    left_out: &mut Vec<(&'static str, &'static str)>,
) -> Result<Vec<Modelled>, CalibrationError> {
    let (ranges, cut) = (&config.calibration, &config.rock.depth_of_cut);
    let bit = "friction of the bit on the rock";
    // The priors are relative to the configured values, since those of bits and rocks differ by much more than their ranges.
    let mut wanted = Vec::new();
    if config.rock.law == Law::DepthOfCut {
        wanted.extend([
            (
                bit,
                "",
                "rock.depth_of_cut.wear_flat_friction",
                cut.wear_flat_friction,
                ranges.bit,
            ),
            (
                "inclination of the cutters",
                "",
                "rock.depth_of_cut.cutter_inclination",
                cut.cutter_inclination,
                ranges.cutter_inclination,
            ),
            (
                "force that the wear flats carry",
                "N",
                "rock.depth_of_cut.wear_flat_force",
                cut.wear_flat_force,
                ranges.wear_flat_force,
            ),
            (
                "specific energy of the rock",
                "Pa",
                "rock.depth_of_cut.specific_energy",
                cut.specific_energy,
                ranges.specific_energy,
            ),
        ]);
    } else {
        let factor = config.tool.bit.friction_factor;
        wanted.push((bit, "", "tool.bit.friction_factor", factor, ranges.bit));
    }
    let mut all = Vec::new();
    for (name, unit, key, configured, range) in wanted {
        // Flats without a force rub with no friction, whatever their coefficient.
        let acts = configured > 0.0 && (name != bit || config.rock.law != Law::DepthOfCut || cut.wear_flat_force > 0.0);
        if !acts {
            left_out.push((
                name,
                "the configured value is 0, or that of the force that it acts with",
            ));
            continue;
        }
        let ends = range.ends().map(|factor| factor * configured);
        all.push(Modelled {
            unknown: Unknown::new(name, unit, Shape::LogNormal, ends)?,
            keys: vec![key],
            per_value: 1.0,
            drilling_alone: true,
        });
    }
    Ok(all)
}
