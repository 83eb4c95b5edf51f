//! Torque buckling of a hanging chain, by kind of joint. The closed forms are derived in `docs/mechanics.md`.

use nalgebra::DMatrix;

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction};

/// Relative error. The chain is linear up to the squares of its tilts, 1e-5 at the end of the search, and the last
/// extrapolation spans some thousandths of the torque.
const LIMIT: f64 = 1e-4;
/// The search ends when the extrapolation is within this part of the squared torque.
const LEFT: f64 = 2e-3;
/// Fraction of the distance to the extrapolated squared torque that a step covers, and the largest relative growth of
/// the square. The extrapolation overestimates at first, because higher modes contribute: for eight links by a factor
/// of three. With both limits no step exceeds the buckling torque, as the same search over the equations in
/// `docs/mechanics.md` shows.
const PART: f64 = 0.25;
const GROWTH: f64 = 0.1;
/// Effective tension in the chains (N), as in their configurations.
const PULL: f64 = 1000.0;
/// First torque of a search, over pull times length of a link: all chains buckle above 0.4.
const FIRST: f64 = 0.2;

/// A chain of links that hangs under [`PULL`], pinned at both ends.
#[derive(Debug, Clone, Copy)]
struct Chain {
    case: &'static str,
    links: u32,
    joints: &'static str,
    /// From cross to cross (degrees).
    phase_step: f64,
    /// Of the torque on the lower end about the axis that points down the hole: 1 or -1.
    sense: f64,
}

impl Chain {
    fn twin(&self, torque: f64) -> Result<CaseTwin, VerifyError> {
        CaseTwin::with(self.case, |config| {
            config
                .with_value("tool.links", self.links)?
                .with_value("tool.joint.kind", self.joints)?
                .with_value("tool.joint.cross_phase_step_deg", self.phase_step)?
                .with_value("loads.0.history.constant", self.sense * torque)
        })
    }

    /// Deflection (m) of the first joint at rest under `torque` (N m).
    fn deflection(&self, torque: f64) -> Result<f64, VerifyError> {
        let twin = self.twin(torque)?;
        let joint = twin.simulation.joint_stations()[0];
        Ok(twin.displacement(joint, Body::Pipe, Direction::W))
    }

    /// Pull times length of a link (N m).
    fn unit(&self) -> Result<f64, VerifyError> {
        let config = self.twin(0.0)?.config.clone();
        Ok(PULL * config.well.length() / f64::from(self.links))
    }

    /// The torque (N m) at which the chain's lateral stiffness vanishes. For crosses in phase or a quarter turn apart it is
    /// even in the torque, and nearly linear in its square; for others it is smooth in the square beyond zero. It is
    /// extrapolated so from two torques, and approached from below.
    fn buckling_torque(&self) -> Result<f64, VerifyError> {
        let stiffness = |square: f64| self.deflection(square.sqrt()).map(|deflection| 1.0 / deflection);
        let mut before = (0.0, stiffness(0.0)?);
        let mut square = (FIRST * self.unit()?).powi(2);
        for _ in 0..100 {
            let now = (square, stiffness(square)?);
            let vanishes = now.0 + now.1 * (now.0 - before.0) / (before.1 - now.1);
            if vanishes - square < LEFT * vanishes {
                return Ok(vanishes.sqrt());
            }
            square += (PART * (vanishes - square)).min(GROWTH * square);
            before = now;
        }
        Err(VerifyError::Missing {
            case: self.case,
            what: "buckling",
        })
    }

    fn row(&self, quantity: &str, factor: f64) -> Result<Row, VerifyError> {
        let expected = factor * self.unit()?;
        Ok(Row::relative(
            self.case,
            quantity,
            expected,
            self.buckling_torque()?,
            LIMIT,
        ))
    }
}

/// Three links, by kind of joint.
pub(super) fn torque() -> Result<Vec<Row>, VerifyError> {
    let root = 3.0_f64.sqrt();
    let chain = |joints, phase_step| Chain {
        case: "torque_buckling",
        links: 3,
        joints,
        phase_step,
        sense: 1.0,
    };
    Ok(vec![
        chain("ball_cage", 90.0).row("ball cage, sqrt(3) N L (N m)", root)?,
        chain("universal", 90.0).row("crosses at 90 deg, 2 sqrt(3) N L / 5 (N m)", 0.4 * root)?,
        chain("universal", 0.0).row(
            "crosses in phase, (8 sqrt(3) - 6) N L / 13 (N m)",
            (8.0 * root - 6.0) / 13.0,
        )?,
    ])
}

/// Longer chains of universal joints.
pub(super) fn folding() -> Result<Vec<Row>, VerifyError> {
    let chain = |links, phase_step| Chain {
        case: "torque_folding",
        links,
        joints: "universal",
        phase_step,
        sense: 1.0,
    };
    let against = |chain| Chain { sense: -1.0, ..chain };
    let [with_axis, against_axis] = folding_torques(6, 60.0);
    Ok(vec![
        chain(4, 90.0).row(
            "4 links, crosses at 90 deg, 0.6037 N L (N m)",
            folding_torques(4, 90.0)[0],
        )?,
        chain(4, 0.0).row(
            "4 links, in phase, 4 / (1 + sqrt(39)) N L (N m)",
            4.0 / (1.0 + 39.0_f64.sqrt()),
        )?,
        chain(8, 90.0).row(
            "8 links, crosses at 90 deg, 0.5301 N L (N m)",
            folding_torques(8, 90.0)[0],
        )?,
        chain(6, 60.0).row(
            "6 links, crosses at 60 deg, torque along the axis, 0.7597 N L (N m)",
            with_axis,
        )?,
        against(chain(6, 60.0)).row(
            "6 links, crosses at 60 deg, torque against the axis, 0.4626 N L (N m)",
            against_axis,
        )?,
    ])
}

/// A chain that is pulled by twice as much, of which pressure on a sealed end takes half.
pub(super) fn under_pressure() -> Result<Vec<Row>, VerifyError> {
    let chain = Chain {
        case: "pressure_folding",
        links: 4,
        joints: "universal",
        phase_step: 90.0,
        sense: 1.0,
    };
    Ok(vec![chain.row("0.6037 N_eff L (N m)", folding_torques(4, 90.0)[0])?])
}

/// Torques at which a chain of links with universal joints folds, over tension times length of a link: where the torque
/// acts on the lower end about the axis that points down the hole, and where it acts against it, which is how a bit
/// brakes a tool that turns forward. `phase_step` is the angle from one cross to the next (degrees). Both senses are
/// alike for crosses in phase or a quarter turn apart, and differ by up to a factor of two between.
///
/// They are the inverse of the largest and of the lowest eigenvalue of the symmetric map from slopes to slopes in
/// `docs/mechanics.md`.
///
/// # Panics
/// For fewer than two links, which have no joint.
pub fn folding_torques(links: usize, phase_step: f64) -> [f64; 2] {
    assert!(links > 1, "{links} links have no joint");
    // Columns of the map, for one slope after the other; the mean over the links is removed on both sides.
    let mut map = DMatrix::zeros(2 * links, 2 * links);
    for column in 0..2 * links {
        let mut slopes = vec![[0.0; 2]; links];
        slopes[column / 2][column % 2] = 1.0;
        without_mean(&mut slopes);
        let mut mapped = balance(&slopes, phase_step);
        without_mean(&mut mapped);
        map.column_mut(column)
            .iter_mut()
            .zip(mapped.iter().flatten())
            .for_each(|(entry, image)| *entry = *image);
    }
    let eigenvalues = map.symmetric_eigenvalues();
    [eigenvalues.max(), -eigenvalues.min()].map(f64::recip)
}

/// -i (m_k - m_(k-1)) / T of each link, of the moments m across the chain at both ends of the link.
fn balance(slopes: &[[f64; 2]], phase_step: f64) -> Vec<[f64; 2]> {
    let moment = |joint: usize| match (joint.checked_sub(1), slopes.get(joint)) {
        (Some(above), Some(&[x_b, y_b])) => {
            let [x_a, y_a] = slopes[above];
            let (sin, cos) = (2.0 * above as f64 * phase_step.to_radians()).sin_cos();
            let (x, y) = (x_a - x_b, y_a - y_b);
            [
                0.5 * (x_a + x_b + cos * x + sin * y),
                0.5 * (y_a + y_b + sin * x - cos * y),
            ]
        }
        (None, Some(&[x, y])) => [0.5 * x, 0.5 * y],
        _ => slopes.last().map_or([0.0; 2], |[x, y]| [0.5 * x, 0.5 * y]),
    };
    (0..slopes.len())
        .map(|link| {
            let ([x_above, y_above], [x_below, y_below]) = (moment(link), moment(link + 1));
            [y_below - y_above, x_above - x_below]
        })
        .collect()
}

fn without_mean(slopes: &mut [[f64; 2]]) {
    let count = slopes.len() as f64;
    for axis in 0..2 {
        let mean = slopes.iter().map(|slope| slope[axis]).sum::<f64>() / count;
        slopes.iter_mut().for_each(|slope| slope[axis] -= mean);
    }
}

#[cfg(test)]
mod tests {
    use super::folding_torques;

    /// Against the chains that are solved by hand in `docs/mechanics.md`.
    #[test]
    fn short_chains_fold_at_their_closed_forms() {
        let root = 3.0_f64.sqrt();
        for (links, phase_step, exact) in [
            (2, 90.0, 1.0),
            (2, 0.0, 1.0),
            (3, 90.0, 0.4 * root),
            (3, 0.0, (8.0 * root - 6.0) / 13.0),
            (4, 0.0, 4.0 / (1.0 + 39.0_f64.sqrt())),
        ] {
            // Both senses, to the rounding of the eigenvalues.
            for got in folding_torques(links, phase_step) {
                assert!(
                    (got - exact).abs() < 1e-12,
                    "{links} links at {phase_step} deg: {got}, {exact}"
                );
            }
        }
        // 1 / factor of four links at 90 degrees is a root of a cubic.
        let inverse = 1.0 / folding_torques(4, 90.0)[0];
        assert!(
            (((16.0 * inverse - 16.0) * inverse - 18.0) * inverse + 1.0).abs() < 1e-9,
            "{inverse}"
        );
        // Figures that the documents quote.
        for (links, phase_step, rounded) in [(4, 90.0, 0.604), (8, 90.0, 0.530), (4, 0.0, 0.552), (33, 90.0, 0.502)] {
            assert!((folding_torques(links, phase_step)[0] - rounded).abs() < 6e-4);
        }
        // The mirror image of a chain folds under the other sense.
        let [one, other] = folding_torques(8, 60.0);
        let [mirrored_other, mirrored_one] = folding_torques(8, -60.0);
        assert!((one - mirrored_one).abs() < 1e-12 && (other - mirrored_other).abs() < 1e-12);
        assert!(
            (one - 0.755).abs() < 6e-4 && (other - 0.445).abs() < 6e-4,
            "{one} {other}"
        );
    }
}
