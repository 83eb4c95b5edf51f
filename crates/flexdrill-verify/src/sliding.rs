//! Sliding along the hole and sticking: advance round the arc, a push on a guide that sticks, a block on a slope.

use std::f64::consts::FRAC_PI_2;

use super::case::CaseTwin;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties, WellSection};

/// Rate of penetration of these cases (m/s).
pub const ADVANCE: f64 = 0.010;

/// Axial force on the guide at the kick-off (N), averaged over the last tenth of a run at [`ADVANCE`].
///
/// # Errors
/// When a step fails, or the guide is not held at the kick-off.
pub fn weight_at_kickoff(case: &'static str, twin: &mut CaseTwin) -> Result<f64, VerifyError> {
    let missing = |what| VerifyError::Missing { case, what };
    let duration = twin.config.run.duration.ok_or(missing("the end of the run"))?;
    twin.set_rate_of_penetration(ADVANCE);
    twin.run_to(0.9 * duration)?;
    let (mut sum, mut steps) = (0.0, 0_u32);
    while twin.time() < duration {
        twin.step()?;
        let weight = twin.simulation.weight_at_kickoff();
        sum += weight.ok_or(missing("the support of the guide at the kick-off"))?;
        steps += 1;
    }
    Ok(sum / f64::from(steps))
}

pub(super) fn capstan() -> Result<Vec<Row>, VerifyError> {
    let case = "capstan";
    let mut twin = CaseTwin::new(case)?;
    let got = weight_at_kickoff(case, &mut twin)?;
    let weight = twin.config.simulation().initial_inputs.weight_on_bit;
    let expected = (twin.config.tool().outer.friction_axial * FRAC_PI_2).exp();
    // The regularisation takes 2.4e-5, chords instead of the arc (mu l / R)^2 / 12.
    Ok(vec![Row::relative(
        case,
        "force at the kick-off over weight, e^(mu pi / 2)",
        expected,
        got / weight,
        1e-3,
    )])
}

pub(super) fn slid_in() -> Result<Vec<Row>, VerifyError> {
    let case = "capstan_slid_in";
    let mut twin = CaseTwin::new(case)?;
    let missing = |what| VerifyError::Missing { case, what };
    let duration = twin.config.run.duration.ok_or(missing("the end of the run"))?;
    let weight = twin.config.simulation().initial_inputs.weight_on_bit;
    let expected = (twin.config.tool().outer.friction_axial * FRAC_PI_2).exp();
    let mut rows = Vec::new();
    for (time, quantity) in [(0.0, "at the start"), (duration, "after some steps at rest")] {
        twin.run_to(time)?;
        let at_top = twin.simulation.weight_at_kickoff();
        let got = at_top.ok_or(missing("the support of the guide at the kick-off"))? / weight;
        let quantity = format!("force at the kick-off over weight {quantity}");
        rows.push(Row::relative(case, quantity, expected, got, 1e-3));
    }
    Ok(rows)
}

/// Weight (N/m in mud) of pipe and guide, friction coefficient, radius (m) and weight on bit (N) of a case.
pub(super) struct Heavy {
    pipe: f64,
    pub(super) guide: f64,
    pub(super) friction: f64,
    pub(super) radius: f64,
    pub(super) weight_on_bit: f64,
}

impl Heavy {
    pub(super) fn of(twin: &CaseTwin) -> Self {
        let tool = twin.config.tool();
        let weight = |tube| tool.gravity * SectionProperties::of(tube, tool.material, 1.0).mass;
        Self {
            pipe: weight(tool.pipe_sections[0]),
            guide: weight(tool.guide_section),
            friction: tool.outer.friction_axial,
            radius: twin.config.well.length() / FRAC_PI_2,
            weight_on_bit: twin.config.simulation().initial_inputs.weight_on_bit,
        }
    }

    /// Force at the kick-off (N): the guide's weight, and with `chain` that of the pipe in it, which hangs from its own
    /// top.
    fn at_kickoff(&self, chain: bool) -> f64 {
        let mu = self.friction;
        let e = (-mu * FRAC_PI_2).exp();
        let (c, s) = ((e + mu) / (1.0 + mu * mu), (1.0 - mu * e) / (1.0 + mu * mu));
        let pipe = if chain {
            self.pipe * (2.0 * c - (1.0 - e) / mu)
        } else {
            0.0
        };
        (self.weight_on_bit + self.radius * (mu * (self.guide * c + pipe) - self.guide * s)) / e
    }
}

pub(super) fn capstan_weight() -> Result<Vec<Row>, VerifyError> {
    heavy("capstan_weight", false)
}

pub(super) fn capstan_chain() -> Result<Vec<Row>, VerifyError> {
    heavy("capstan_chain", true)
}

fn heavy(case: &'static str, chain: bool) -> Result<Vec<Row>, VerifyError> {
    let mut twin = CaseTwin::new(case)?;
    let got = weight_at_kickoff(case, &mut twin)?;
    let expected = Heavy::of(&twin).at_kickoff(chain);
    // As the case `capstan`. The weight of half a chord or a link at the ends of the tool is 0.1 % of the force.
    Ok(vec![Row::relative(
        case,
        "force at the kick-off (N)",
        expected,
        got,
        1e-3,
    )])
}

/// A hole of a straight section, an arc that ends level and a level section, with a heavy guide on its low side.
struct Intervals {
    /// Weight of the guide (N/m in mud).
    guide: f64,
    /// Lengths of both straight sections (m), and the radius of the arc (m).
    straight: [f64; 2],
    radius: f64,
    /// Inclination at which the arc begins (rad).
    inclination: f64,
    weight_on_bit: f64,
}

impl Intervals {
    fn of(twin: &CaseTwin) -> Option<Self> {
        let (well, heavy) = (&twin.config.tool().well, Heavy::of(twin));
        let &[
            WellSection::Straight { length: before },
            WellSection::Arc { radius, .. },
            WellSection::Straight { length: after },
        ] = well.sections.as_slice()
        else {
            return None;
        };
        Some(Self {
            guide: heavy.guide,
            straight: [before, after],
            radius,
            inclination: well.start_inclination,
            weight_on_bit: heavy.weight_on_bit,
        })
    }

    /// Force at the kick-off (N) with friction coefficients before, in and after the arc.
    fn at_kickoff(&self, [before, mu, after]: [f64; 3]) -> f64 {
        let (w, [above, below]) = (self.guide, self.straight);
        let end_of_arc = self.weight_on_bit + after * w * below;
        // The weight in the arc: integral of e^(mu i) (cos i - mu sin i).
        let weight = |i: f64| (mu * i).exp() * (2.0 * mu * i.cos() + (1.0 - mu * mu) * i.sin()) / (1.0 + mu * mu);
        let begin = self.inclination;
        let carried = end_of_arc * (mu * FRAC_PI_2).exp() - self.radius * w * (weight(FRAC_PI_2) - weight(begin));
        carried * (-mu * begin).exp() + w * above * (before * begin.sin() - begin.cos())
    }
}

pub(super) fn capstan_intervals() -> Result<Vec<Row>, VerifyError> {
    let case = "capstan_intervals";
    let mut rows = Vec::new();
    for factors in [
        [1.0, 1.0, 1.0],
        [3.0, 1.0, 1.0],
        [1.0, 2.0, 1.0],
        [1.0, 1.0, 3.0],
        [1.5, 0.5, 2.0],
    ] {
        let mut twin = CaseTwin::with(case, |config| {
            let keys = ["before_arc", "arc", "after_arc"].map(|key| format!("contact.wall_friction_factors.{key}"));
            config.with_values(case, keys.into_iter().zip(factors))
        })?;
        let of = Intervals::of(&twin).ok_or(VerifyError::Missing {
            case,
            what: "a hole of straight section, arc and straight section",
        })?;
        let friction = Heavy::of(&twin).friction;
        let got = weight_at_kickoff(case, &mut twin)?;
        let [before, arc, after] = factors;
        // As the case `capstan_weight`, with the load of the arc that chords carry over its boundaries.
        rows.push(Row::relative(
            case,
            format!("force at the kick-off (N), factors {before}, {arc}, {after}"),
            of.at_kickoff(factors.map(|factor| friction * factor)),
            got,
            2e-3,
        ));
    }
    Ok(rows)
}

pub(super) fn stuck_guide() -> Result<Vec<Row>, VerifyError> {
    let case = "stuck_guide";
    // A station holds 0.7 N: Newton's limits, which are for forces of kilonewtons, are too wide.
    let mut twin = CaseTwin::within(case, 1e-3, Ok)?;
    let tool = twin.config.tool();
    let section = SectionProperties::of(tool.guide_section, tool.material, 1.0);
    let friction = tool.outer.friction_axial * tool.gravity * section.mass;
    let push = 70.0;
    let end = |twin: &CaseTwin| -twin.displacement(twin.last(), Body::Guide, Direction::U);
    twin.run_to(3.2)?;
    let pushed = end(&twin);
    // The push reaches up to where the guide has moved by the part 1e-4 of its end; it falls with the square of the
    // distance from there, so that this is 1e-2 of the length short.
    let length = twin.config.well.length();
    let stations: Vec<_> = twin.simulation.stations().map(|at| at.measured_depth).collect();
    let moved = (0..stations.len()).find(|&s| -twin.displacement(s, Body::Guide, Direction::U) > 1e-4 * pushed);
    let reach = moved.map_or(f64::NAN, |s| length - stations[s]);
    twin.run_to(6.4)?;
    let expected = push * push / (2.0 * section.axial * friction);
    Ok(vec![
        Row::relative(case, "movement F^2 / (2 EA mu w) (m)", expected, pushed, 1e-3),
        Row::relative(case, "half of it stays (m)", 0.5 * expected, end(&twin), 1e-3),
        Row::relative(case, "reach F / (mu w) (m)", push / friction, reach, 0.02),
    ])
}

pub(super) fn block_on_slope() -> Result<Vec<Row>, VerifyError> {
    let case = "block_on_slope";
    let mut twin = CaseTwin::new(case)?;
    let travelled = |twin: &CaseTwin| twin.displacement(0, Body::Pipe, Direction::U);
    twin.run_to(10.0)?;
    let rested = travelled(&twin);
    twin.run_to(1e3)?;
    let crept = travelled(&twin) - rested;
    let axial = twin.simulation.axial_friction(0, Body::Pipe).unwrap_or(f64::NAN);
    let tool = twin.config.tool();
    let mass = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0).mass * twin.config.well.length();
    let down = 0.5 * mass * tool.gravity * twin.config.well.start_inclination_deg.to_radians().cos();
    Ok(vec![
        Row::scaled(case, "creep in 10^3 s (m)", 0.0, crept, 1e-10, 1.0),
        Row::relative(case, "friction m g sin 30 deg / 2 per station (N)", -down, axial, 1e-6),
    ])
}
