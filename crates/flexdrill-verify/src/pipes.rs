//! Beams: statics, frequencies, the hinged beam in a tube, the curved guide.

use std::f64::consts::PI;

use super::case::{CaseTwin, crossing_frequency};
use super::{HingedBeam, Row, VerifyError};
use flexdrill_core::tool::SectionProperties;
use flexdrill_core::tool::{Body, Direction};

/// Statics of a linear beam: rounding of the solve.
const STATICS: f64 = 1e-9;
/// Pipe and sliding guide: what Newton's iteration may leave of their forces in motion, 0.1 N of 100 kN, 1 mN of 1 kN.
const SHARED: f64 = 1e-6;
/// Frequencies.
const FREQUENCY: f64 = 1e-3;

fn section(twin: &CaseTwin) -> SectionProperties {
    let tool = twin.config.tool();
    SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0)
}

pub(super) fn cantilever() -> Result<Vec<Row>, VerifyError> {
    let case = "cantilever";
    let twin = CaseTwin::new(case)?;
    let (ei, force, l) = (section(&twin).bending, 100.0_f64, twin.config.well.length());
    let tip = |direction| twin.displacement(twin.last(), Body::Pipe, direction);
    let (deflection, tilt) = (force * l.powi(3) / (3.0 * ei), -force * l * l / (2.0 * ei));
    Ok(vec![
        Row::relative(
            case,
            "tip deflection F L^3 / 3EI (m)",
            deflection,
            tip(Direction::W),
            STATICS,
        ),
        Row::relative(case, "tip tilt -F L^2 / 2EI (rad)", tilt, tip(Direction::PhiY), STATICS),
    ])
}

pub(super) fn axial_rod() -> Result<Vec<Row>, VerifyError> {
    let case = "axial_rod";
    let twin = CaseTwin::new(case)?;
    let s = section(&twin);
    let l = twin.config.well.length();
    rod(
        case,
        twin,
        Direction::U,
        100e3 * l / s.axial,
        (s.axial / s.mass).sqrt() / (4.0 * l),
    )
}

/// Two rods in parallel share a force by their stiffness; the guide slides, the pipe has joints.
pub(super) fn tied_rods() -> Result<Vec<Row>, VerifyError> {
    let case = "tied_rods";
    let mut twin = CaseTwin::new(case)?;
    let tool = twin.config.tool();
    let pipe = section(&twin).axial;
    let guide = SectionProperties::of(tool.guide_section, tool.material, 1.0).axial;
    let (force, l) = (100e3, twin.config.well.length());
    // A hundred steps at rest: the answer is the steps' as much as the start's.
    twin.run_to(0.05)?;
    let joints = twin.simulation.joints();
    let carried = joints.axial_force.iter().fold(0.0, |sum, force| sum + force) / joints.axial_force.len() as f64;
    let end = twin.displacement(twin.last(), Body::Guide, Direction::U);
    Ok(vec![
        Row::relative(
            case,
            "end of both, F L / (E A_pipe + E A_guide) (m)",
            force * l / (pipe + guide),
            end,
            SHARED,
        ),
        Row::relative(
            case,
            "the pipe's share of the force at its joints (N)",
            force * pipe / (pipe + guide),
            carried,
            SHARED,
        ),
    ])
}

/// Weight per length (N/m) and bending stiffness (N m2) of pipe and guide, without fluid.
fn beams(twin: &CaseTwin) -> [(f64, f64); 2] {
    let tool = twin.config.tool();
    [tool.pipe_sections[0], tool.guide_section].map(|tube| {
        let section = SectionProperties::of(tube, tool.material, 1.0);
        (section.mass * tool.gravity, section.bending)
    })
}

/// A pipe that nothing but the guide carries: both bend as one beam.
pub(super) fn pipe_in_guide() -> Result<Vec<Row>, VerifyError> {
    let case = "pipe_in_guide";
    let mut twin = CaseTwin::new(case)?;
    let [(w_pipe, ei_pipe), (w_guide, ei_guide)] = beams(&twin);
    let (last, l) = (twin.last(), twin.config.well.length());
    // A hundred steps at rest: the answer is the steps' as much as the start's.
    twin.run_to(0.05)?;
    let down = |station, body| twin.displacement(station, body, Direction::W);
    let of_guide = down(last / 2, Body::Guide);
    let of_pipe = down(last / 2, Body::Pipe) - 0.5 * (down(0, Body::Pipe) + down(last, Body::Pipe));
    let expected = 5.0 * (w_pipe + w_guide) * l.powi(4) / (384.0 * (ei_pipe + ei_guide));
    let carried: f64 = (0..=last).map(|station| twin.inner_normal(station)).sum();
    Ok(vec![
        // 1.1 kN presses 1.1 um into a contact of 1e9 N/m at each end, against a deflection of 7 mm.
        Row::relative(case, "mid-span of the guide (m)", expected, of_guide, 1e-4),
        Row::relative(
            case,
            "5 (w_p + w_g) L^4 / 384, by both (N m3)",
            expected * (ei_pipe + ei_guide),
            ei_pipe * of_pipe + ei_guide * of_guide,
            SHARED,
        ),
        Row::relative(case, "weight that the guide carries (N)", w_pipe * l, carried, SHARED),
    ])
}

/// A chain whose links rest on the guide at every joint.
pub(super) fn chain_in_guide() -> Result<Vec<Row>, VerifyError> {
    let case = "chain_in_guide";
    let mut twin = CaseTwin::new(case)?;
    let [(w_pipe, _), (w_guide, ei)] = beams(&twin);
    // Weights come from the case itself, so that the closed form has the numbers that the twin has.
    let tool = twin.config.tool();
    let l = twin.config.well.length();
    let link = l / tool.links as f64;
    let load = w_pipe * link;
    // Long enough for the chain to come to rest under its damping.
    twin.run_to(0.05)?;
    let joints: Vec<usize> = twin.simulation.joint_stations().to_vec();
    // Beam on two supports, by superposition.
    let deflection = |x: f64| {
        let by_weight = w_guide * x * (l.powi(3) - 2.0 * l * x * x + x.powi(3)) / (24.0 * ei);
        let by_loads = (1..tool.links).map(|j| {
            let at = link * j as f64;
            // The formula holds left of the load; right of it the beam is seen from its other end.
            let (x, b) = if x <= at { (x, l - at) } else { (l - x, at) };
            load * b * x * (l * l - b * b - x * x) / (6.0 * l * ei)
        });
        by_weight + by_loads.sum::<f64>()
    };
    let mut rows = Vec::new();
    // The first joint lies near a support, the fourth in the middle, where the guide's deflection is largest.
    for number in [1, 4] {
        let station = joints[number - 1];
        let gap = twin.simulation.clearance(station, Body::Pipe).unwrap_or(f64::NAN);
        let guide = deflection(link * number as f64);
        // The chain lies on the guide: guide, clearance, and the penetration of the contact under one link's weight.
        let pipe = guide + gap + load / tool.inner.stiffness;
        let down = |body| twin.displacement(station, body, Direction::W);
        rows.push(Row::relative(
            case,
            format!("guide at joint {number} (m)"),
            guide,
            down(Body::Guide),
            SHARED,
        ));
        rows.push(Row::relative(
            case,
            format!("chain at joint {number} (m)"),
            pipe,
            down(Body::Pipe),
            SHARED,
        ));
        rows.push(Row::relative(
            case,
            format!("weight of a link on joint {number} (N)"),
            load,
            twin.inner_normal(station),
            SHARED,
        ));
    }
    Ok(rows)
}

pub(super) fn torsion_rod() -> Result<Vec<Row>, VerifyError> {
    let case = "torsion_rod";
    let twin = CaseTwin::new(case)?;
    let s = section(&twin);
    let l = twin.config.well.length();
    rod(
        case,
        twin,
        Direction::Psi,
        50.0 * l / s.torsion,
        (s.torsion / s.spin_inertia).sqrt() / (4.0 * l),
    )
}

/// A rod held at one end, at rest under its load, then let go.
fn rod(
    case: &'static str,
    mut twin: CaseTwin,
    direction: Direction,
    at_rest: f64,
    frequency: f64,
) -> Result<Vec<Row>, VerifyError> {
    let last = twin.last();
    let mut rows = vec![Row::relative(
        case,
        "end at rest under its load (m or rad)",
        at_rest,
        twin.displacement(last, Body::Pipe, direction),
        STATICS,
    )];
    twin.run_to(0.001)?;
    // The first mode of the fixed-free rod, sin(pi x / 2L), out of the many that a sudden release excites.
    let mut samples = Vec::new();
    while twin.time() < 0.05 {
        twin.step()?;
        let mode = |s: usize| (0.5 * PI * s as f64 / last as f64).sin();
        let sum = (0..last)
            .map(|s| mode(s) * twin.displacement(s, Body::Pipe, direction))
            .sum::<f64>();
        samples.push(sum + 0.5 * twin.displacement(last, Body::Pipe, direction));
    }
    let got = crossing_frequency(&samples, twin.simulation.settings().time_step)
        .ok_or(VerifyError::Missing { case, what: "a swing" })?;
    rows.push(Row::relative(
        case,
        "frequency of the first mode (Hz)",
        frequency,
        got,
        FREQUENCY,
    ));
    Ok(rows)
}

pub(super) fn beam_frequencies() -> Result<Vec<Row>, VerifyError> {
    let case = "beam_frequencies";
    let mut twin = CaseTwin::new(case)?;
    let s = section(&twin);
    let (last, l) = (twin.last(), twin.config.well.length());
    let mut modes = [vec![], vec![], vec![]];
    while twin.time() < 2.0 {
        twin.step()?;
        if twin.time() <= 0.002 {
            continue;
        }
        for (n, samples) in modes.iter_mut().enumerate() {
            // The shape sin(n pi x / L) picks its own mode out of the nodes' deflections exactly.
            let shape = |s: usize| ((n + 1) as f64 * PI * s as f64 / last as f64).sin();
            samples.push(
                (0..=last)
                    .map(|s| shape(s) * twin.displacement(s, Body::Pipe, Direction::W))
                    .sum(),
            );
        }
    }
    modes
        .iter()
        .enumerate()
        .map(|(index, samples)| {
            let n = (index + 1) as f64;
            let expected = (n * PI / l).powi(2) * (s.bending / s.mass).sqrt() / (2.0 * PI);
            let got = crossing_frequency(samples, twin.simulation.settings().time_step)
                .ok_or(VerifyError::Missing { case, what: "a swing" })?;
            Ok(Row::relative(
                case,
                format!("frequency {n} (Hz)"),
                expected,
                got,
                FREQUENCY,
            ))
        })
        .collect()
}

pub(super) fn hinged_beam() -> Result<Vec<Row>, VerifyError> {
    let case = "hinged_beam_in_tube";
    let mut twin = CaseTwin::new(case)?;
    let tool = twin.config.tool();
    let joint = twin.simulation.joint_stations()[0];
    let beam = HingedBeam::of(&twin);
    let (limit, touch) = (beam.limit_load(), beam.touch_load());
    let mut rows = Vec::new();
    // Two loads in each branch, away from its ends, where the load of 1000 N/s has let the beam's own swing die.
    let loads = [
        ("swings", 0.6 * limit),
        ("swings", 0.95 * limit),
        ("locked", limit + 0.3 * (touch - limit)),
        ("locked", limit + 0.9 * (touch - limit)),
        ("on the tube", touch + 0.3 * (1000.0 - touch)),
        ("on the tube", touch + 0.9 * (1000.0 - touch)),
    ];
    for (branch, load) in loads {
        let time = load / 1000.0;
        twin.run_to(time)?;
        let load = 1000.0 * twin.time();
        let expected = beam.corrected(load);
        let penetration = twin.inner_normal(joint) / tool.inner.stiffness;
        let got = twin.displacement(joint, Body::Pipe, Direction::W);
        let mut quantity = format!("deflection of C at {load:.1} N, {branch} (m)");
        if penetration > 0.0 {
            quantity = format!("C at {load:.0} N, {branch}, {:.2} um into it (m)", 1e6 * penetration);
        }
        rows.push(Row::relative(case, quantity, expected, got, 1e-3));
    }
    Ok(rows)
}

impl HingedBeam {
    /// Of the case `hinged_beam_in_tube`.
    pub fn of(twin: &CaseTwin) -> Self {
        let joint = twin.simulation.joint_stations()[0];
        Self {
            bending: section(twin).bending,
            length: 0.5 * twin.config.well.length(),
            limit: twin.config.tool().joint.limit,
            gap: twin.simulation.clearance(joint, Body::Pipe).unwrap_or(f64::NAN),
        }
    }
}

pub(super) fn curved_guide() -> Result<Vec<Row>, VerifyError> {
    let case = "curved_guide";
    let twin = CaseTwin::new(case)?;
    let stations: Vec<_> = twin.simulation.stations().collect();
    let wall = |s: usize| twin.simulation.normal_force(s, Body::Guide).unwrap_or(0.0);
    let touching: Vec<usize> = (0..stations.len())
        .filter(|&s| twin.simulation.in_contact(s, Body::Guide) == Some(true))
        .collect();
    let (Some(&first), Some(&last)) = (touching.first(), touching.last()) else {
        return Err(VerifyError::Missing {
            case,
            what: "contact with the wall",
        });
    };
    // The middle half of the part that rests on the wall: its ends carry what the free parts bend into it.
    let quarter = (last - first) / 4;
    let (from, to) = (first + quarter, last - quarter);
    let carried: f64 = (from..=to).map(wall).sum();
    let spacing = stations[1].measured_depth - stations[0].measured_depth;
    let got = carried / (spacing * (to - from + 1) as f64);
    let force = twin.config.simulation().initial_inputs.weight_on_bit;
    let turned = stations[to].inclination - stations[from].inclination;
    let expected = force * turned / (stations[to].measured_depth - stations[from].measured_depth);
    // N / R holds where the guide follows the wall; its own bending shifts some of it between neighbours.
    Ok(vec![Row::relative(
        case,
        "wall reaction per length N / R (N/m)",
        expected,
        got,
        0.02,
    )])
}
