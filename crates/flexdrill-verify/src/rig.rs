//! String above the tool and rock under it.

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, RockLaw, SectionProperties};

/// The vibration of the start has not died out fully after the run; the closed forms are those of steady motion.
const STEADY: f64 = 1e-3;

/// The bit continues to vibrate by micrometres: its wear flats then bear less than their full force now and then, and it cuts
/// deeper for it, by half a per cent of the torque.
const VIBRATING: f64 = 1e-2;

/// Means over `seconds` of what `read` gives.
fn means<const N: usize>(
    twin: &mut CaseTwin,
    seconds: f64,
    read: impl Fn(&CaseTwin) -> [f64; N],
) -> Result<[f64; N], VerifyError> {
    let (mut sums, mut count) = ([0.0; N], 0.0);
    let end = twin.time() + seconds;
    while twin.time() < end {
        twin.step()?;
        for (sum, x) in sums.iter_mut().zip(read(twin)) {
            *sum += x;
        }
        count += 1.0;
    }
    Ok(sums.map(|sum| sum / count))
}

pub(super) fn windup() -> Result<Vec<Row>, VerifyError> {
    let case = "string_windup";
    let mut twin = CaseTwin::new(case)?;
    let (tool, last) = (twin.config.tool(), twin.last());
    let pipe = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let string = tool
        .string
        .as_ref()
        .map_or(f64::NAN, |string| string.torsional_stiffness());
    twin.run_to(30.0)?;
    let [ahead, at_the_drive, at_the_bit] = means(&mut twin, 3.0, |twin| {
        let snapshot = twin.simulation.new_snapshot();
        let bit = twin.displacement(last, Body::Pipe, Direction::Psi);
        [
            snapshot.applied.drive_angle - bit,
            snapshot.applied.drive_torque,
            snapshot.bit.torque,
        ]
    })?;
    let speed = twin.config.inputs.rotary_speed.initial_rpm * std::f64::consts::TAU / 60.0;
    // Eq. 1 with the smooth sign of the speed.
    let sign = speed / speed.hypot(tool.bit.slip_rate);
    let torque = twin.config.tool.bit.torque_arm() * 1e3 * twin.config.inputs.weight_on_bit.initial_kn * sign;
    let expected = torque * (1.0 / string + twin.config.well.length() / pipe.torsion);
    Ok(vec![
        Row::relative(case, "torque at the bit (N m)", torque, at_the_bit, STEADY),
        Row::relative(case, "torque at the drive (N m)", torque, at_the_drive, STEADY),
        Row::relative(case, "wind-up of string and tool (rad)", expected, ahead, STEADY),
    ])
}

pub(super) fn depth_of_cut() -> Result<Vec<Row>, VerifyError> {
    let case = "depth_of_cut";
    let mut twin = CaseTwin::new(case)?;
    let tool = twin.config.tool();
    let RockLaw::DepthOfCut(cut) = tool.rock else {
        return Err(VerifyError::Missing {
            case,
            what: "a depth of cut",
        });
    };
    twin.run_to(40.0)?;
    let [weight, torque] = means(&mut twin, 3.0, |twin| {
        let bit = twin.simulation.bit();
        [bit.weight_on_bit, bit.torque]
    })?;
    let asked = 1e3 * twin.config.inputs.weight_on_bit.initial_kn;
    let radius = 0.5 * tool.bit.diameter;
    let cutting = cut.cutter_inclination * cut.specific_energy * radius;
    let depth = (asked - cut.wear_flat_force) / cutting;
    let expected = 0.5 * cut.specific_energy * radius * radius * depth
        + 0.5 * cut.wear_flat_friction * radius * cut.wear_flat_force;
    Ok(vec![
        Row::relative(case, "weight on the bit (N)", asked, weight, STEADY),
        Row::relative(case, "torque on the bit (N m)", expected, torque, VIBRATING),
    ])
}
