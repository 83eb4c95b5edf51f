//! A guide that thrust bends, because its spine lies off its axis.

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// Ten cubic elements have (k L / 10)^4 / 720 = 2e-7 of the deflection under this thrust, and the thrust shortens the spine by
/// C / EA = 6e-5 of its length, which the closed form leaves out.
const COLUMN: f64 = 1e-4;
/// Thrust of the case (N).
const THRUST: f64 = 40e3;

pub(super) fn between_pinned_ends() -> Result<Vec<Row>, VerifyError> {
    let case = "spine_column";
    let mut rows = Vec::new();
    for (toolface, side, direction, tilting) in [
        (180.0, "on the low side", Direction::W, Direction::PhiY),
        (90.0, "on the right", Direction::V, Direction::PhiZ),
    ] {
        let twin = CaseTwin::with(case, |config| {
            config.with_value("tool.guide.spine_toolface_deg", toolface)
        })?;
        let tool = twin.config.tool();
        let bending = SectionProperties::of(tool.guide_section, tool.material, tool.guide_bending_factor).bending;
        let offset = tool.guide_spine.map_or(f64::NAN, |spine| spine.offset);
        let (k, length, last) = ((THRUST / bending).sqrt(), twin.config.well.length(), twin.last());
        let half = 0.5 * k * length;
        let middle = twin.displacement(last / 2, Body::Guide, direction);
        let expected = offset * (1.0 / half.cos() - 1.0);
        rows.push(Row::relative(
            case,
            format!("spine {side}: middle (m)"),
            expected,
            middle,
            COLUMN,
        ));
        // Towards the spine's side the upper end tilts: phi_y = -dw/dx, phi_z = dv/dx.
        let slope = offset * k * half.tan();
        let expected = if direction == Direction::W { -slope } else { slope };
        let tilt = twin.displacement(0, Body::Guide, tilting);
        rows.push(Row::relative(
            case,
            format!("spine {side}: tilt of the upper end (rad)"),
            expected,
            tilt,
            COLUMN,
        ));
    }
    Ok(rows)
}
