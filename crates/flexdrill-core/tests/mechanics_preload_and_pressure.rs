//! The energy of a guide's preload and the work of the pressure in the pipe are in the audit, which closes with them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{
    Body, Direction, FreeCurvature, LoadHistory, Location, PointLoad, PressureDescription, PressureEnd, PressureSource,
    Rayleigh, Shortening, Support, ToolDescription, WellSection,
};
use support::{simulation, tiny};

/// Without anything that touches or damps.
fn alone(mut tool: ToolDescription) -> ToolDescription {
    (tool.inner.stiffness, tool.outer.stiffness) = (0.0, 0.0);
    tool.rayleigh = Rayleigh { alpha: 0.0, beta: 0.0 };
    tool.gravity = 0.0;
    tool.drive_top = false;
    tool
}

/// A guide with a preload that loads bend and turn out of the plane: what they do is stored and damped, nothing else.
#[test]
fn the_energy_of_a_preload_closes_the_audit() {
    let work = |curvature: Option<f64>| {
        let mut tool = alone(tiny());
        tool.guide_free_curvature = curvature.map(|curvature| FreeCurvature { curvature, phase: 0.0 });
        let ramp = |direction, rate| PointLoad {
            location: Location::Station(1),
            body: Body::Guide,
            direction,
            history: LoadHistory::Ramp {
                rate,
                start: 0.0,
                end: 0.1,
            },
        };
        tool.supports.push(Support {
            location: Location::Top,
            body: Body::Guide,
            directions: vec![Direction::Psi],
        });
        tool.loads = vec![ramp(Direction::V, 2e5), ramp(Direction::Psi, 2e3)];
        let mut simulation = simulation(&tool);
        while simulation.time() < 0.2 {
            simulation.advance(&Inputs::ZERO).ok().unwrap();
        }
        let audit = *simulation.energy();
        assert!(audit.loads > 0.1, "{audit:?}");
        // Newton leaves up to 1 N of the 20 kN.
        let without_law = audit.error - audit.axial_foresight;
        assert!(without_law.abs() < 1e-4 * audit.loads, "{audit:?}");
        audit.loads
    };
    let works = [None, Some(0.1), Some(0.0)].map(work);
    println!("{works:?} J");
    // A preload gives way to a turn.
    assert!(works[0] < works[1] && works[1] < works[2], "{works:?} J");
}

/// Slots that open and close as the guide swings: what they store they give back, in the plane and out of it.
#[test]
fn the_energy_of_slots_that_close_is_in_the_audit() {
    let work = |close_at: Option<f64>| {
        let mut tool = alone(tiny());
        (tool.guide_bending_factor, tool.guide_slots_close_at) = (0.05, close_at);
        let sine = |direction, amplitude| PointLoad {
            location: Location::Station(1),
            body: Body::Guide,
            direction,
            history: LoadHistory::Sine {
                amplitude,
                frequency: 5.0,
                phase: 0.0,
            },
        };
        tool.loads = vec![sine(Direction::V, 3e3), sine(Direction::W, 4e3)];
        let mut simulation = simulation(&tool);
        let (mut work, mut farthest) = (0.0, 0.0_f64);
        while simulation.time() < 0.15 {
            simulation.advance(&Inputs::ZERO).ok().unwrap();
            let audit = simulation.energy();
            work = f64::max(work, audit.loads);
            let side = simulation.displacement(1, Body::Guide, Direction::V).unwrap();
            farthest = farthest.max(side.abs());
        }
        let audit = *simulation.energy();
        // Newton leaves up to 1 N of some kN; a slot that opens or closes within a step makes the trapezoid's work of
        // that step wrong in third order.
        let without_law = audit.error - audit.axial_foresight;
        println!("{close_at:?}: work {work} J, {farthest} m to the side, error {without_law} J");
        assert!(without_law.abs() < 1e-3 * work, "{audit:?}");
        farthest
    };
    let [open, closing] = [None, Some(0.01)].map(work);
    assert!(closing < 0.7 * open, "{closing} m, {open} m");
}

/// Force (N) that a straight guide with open slots up to the curvature `close_at` presses on the wall with near its end, by
/// straight beams: from the end to where it lies on the wall, a = sqrt(c / I) away, the moment grows to that of the arc,
/// with I the integral of x (1/R - k) over x from 0 to 1, k the curvature under x times that moment.
fn estimate_near_an_end(close_at: f64) -> f64 {
    let (open, whole, path, clearance) = (3.4019e4, 6.8037e5, 1.0 / 3.2, 8e-3);
    let closing = open * close_at;
    let in_the_arc = open * path + (whole - open) * f64::max(path - close_at, 0.0);
    let curvature = |moment: f64| f64::min(moment, closing) / open + f64::max(moment - closing, 0.0) / whole;
    let step = 1e-4;
    let integral: f64 = (0..10_000)
        .map(|i| step * (f64::from(i) + 0.5))
        .map(|x| step * x * (path - curvature(x * in_the_arc)))
        .sum();
    in_the_arc / (clearance / integral).sqrt()
}

/// The path alone closes the slots: the tool comes to rest all the same, and runs on. It presses on the wall as straight
/// beams would, over open slots. Tolerance 15 %: the estimate leaves out that the shear becomes thrust, which takes 10 % of
/// it with open slots, and more where the guide leaves the wall further from its end.
#[test]
fn a_guide_whose_slots_the_path_closes_comes_to_rest() {
    let on_the_wall = |close_at: Option<f64>| {
        let mut tool = ToolDescription::paper();
        (tool.guide_bending_factor, tool.guide_slots_close_at) = (0.05, close_at);
        tool.guide_free_curvature = Some(FreeCurvature {
            curvature: 0.0,
            phase: 0.0,
        });
        let mut simulation = simulation(&tool);
        let stations = 0..=simulation.last_station();
        let forces = stations.filter_map(|at| simulation.normal_force(at, Body::Guide));
        let at_rest: f64 = forces.sum();
        let turning = Inputs {
            rotary_speed: 2.0,
            weight_on_bit: 5e3,
            ..Inputs::ZERO
        };
        for _ in 0..400 {
            simulation.advance(&turning).ok().unwrap();
        }
        at_rest
    };
    let open = on_the_wall(None);
    for close_at in [0.3, 0.2] {
        let got = on_the_wall(Some(close_at)) / open;
        let expected = estimate_near_an_end(close_at) / estimate_near_an_end(1.0);
        println!("slots close at {close_at} 1/m: {got} of the force with open ones, estimate {expected}");
        assert!((got / expected - 1.0).abs() < 0.15, "{got}, {expected}");
    }
}

/// The pump runs up to 0.5 MPa on a sealed end, which shortens a chain that is pulled by 4 kN, and stops again: with
/// links that keep their length when they tilt, and with those that shorten.
#[test]
fn the_work_of_a_changing_pressure_is_in_the_audit() {
    for shortening in [Shortening::None, Shortening::SecondOrder] {
        let mut tool = alone(tiny());
        tool.shortening = shortening;
        a_pump_that_starts_and_stops(tool);
    }
}

/// A chain that is pulled by 10 kN and pushed across by up to 500 N as the pump runs up to 1 MPa: its links tilt by more
/// than a degree, and the pressure works on what they shorten. With the links' own energy the audit closes to what
/// Newton leaves.
#[test]
fn the_work_of_the_pressure_on_links_that_shorten_is_in_the_audit() {
    for end in [PressureEnd::Closed, PressureEnd::Sealed { diameter: 0.040 }] {
        let mut tool = alone(tiny());
        tool.shortening = Shortening::SecondOrder;
        tool.rayleigh = Rayleigh { alpha: 5.0, beta: 1e-4 };
        tool.well.sections = vec![WellSection::Straight { length: 5.0 }];
        tool.guide_fixed = true;
        tool.supports.push(Support {
            location: Location::Top,
            body: Body::Pipe,
            directions: vec![Direction::Psi],
        });
        tool.pressure = Some(PressureDescription {
            at_top: PressureSource::Standpipe,
            drop_per_metre: 0.02,
            end,
            joint_seal_diameter: 0.062,
        });
        let load = |location, direction, history| PointLoad {
            location,
            body: Body::Pipe,
            direction,
            history,
        };
        let push = LoadHistory::Ramp {
            rate: 500.0,
            start: 0.0,
            end: 1.0,
        };
        tool.loads = vec![
            load(Location::Bottom, Direction::U, LoadHistory::Constant(1e4)),
            load(Location::Joint(0), Direction::W, push),
        ];
        let mut simulation = simulation(&tool);
        let mut on = Inputs::ZERO;
        on.standpipe_pressure = 5e6;
        let (mut pushed, mut before) = (0.0, (0.0, 0.0));
        while simulation.time() < 1.0 {
            simulation.advance(&on).ok().unwrap();
            let at_end = simulation
                .displacement(simulation.last_station(), Body::Pipe, Direction::U)
                .unwrap();
            let pressure = simulation.applied().standpipe_pressure;
            pushed += 0.5 * (pressure + before.1) * (before.0 - at_end);
            before = (at_end, pressure);
        }
        let station = simulation.joint_stations()[0];
        let deflection = simulation.displacement(station, Body::Pipe, Direction::W).unwrap();
        let audit = *simulation.energy();
        println!("{deflection} m, {audit:?}");
        assert!(deflection.abs() > 0.01, "{deflection} m");
        // The seal pushes through the end's way, with a tenth of the pressure lost along the 5 m. The strain of a pipe
        // changes with the pressure by some micrometres only: 0.5 mJ of work. Were the shortening left out of the
        // strain, it would be 0.29 J.
        let expected = match end {
            PressureEnd::Sealed { diameter } => 0.9 * 0.25 * std::f64::consts::PI * diameter * diameter * pushed,
            _ => 0.0,
        };
        println!("{} J, expected {expected} J", audit.pressure);
        assert!((audit.pressure - expected).abs() < 2e-3, "{} J", audit.pressure);
        // Newton leaves up to 1 N of 10 kN on ways of a millimetre.
        assert!(audit.error.abs() < 1e-5 * audit.rayleigh_damping, "{audit:?}");
    }
}

fn a_pump_that_starts_and_stops(mut tool: ToolDescription) {
    tool.well.sections = vec![WellSection::Straight { length: 5.0 }];
    tool.guide_fixed = true;
    tool.supports.push(Support {
        location: Location::Top,
        body: Body::Pipe,
        directions: vec![Direction::Psi],
    });
    tool.loads.push(PointLoad {
        location: Location::Bottom,
        body: Body::Pipe,
        direction: Direction::U,
        history: LoadHistory::Constant(4000.0),
    });
    tool.pressure = Some(PressureDescription {
        at_top: PressureSource::Standpipe,
        drop_per_metre: 0.02,
        end: PressureEnd::Sealed { diameter: 0.063 },
        joint_seal_diameter: 0.062,
    });
    let area = |diameter: f64| std::f64::consts::PI / 4.0 * diameter * diameter;
    let mut simulation = simulation(&tool);
    let at_rest = simulation.joints().axial_force[0];
    assert!((at_rest - 4000.0).abs() < 0.1, "{at_rest} N");
    let mut on = Inputs::ZERO;
    on.standpipe_pressure = 5e5;
    while simulation.time() < 2.0 {
        simulation.advance(&on).ok().unwrap();
    }
    // The pull less the push of the seal, and what the joint's own seal adds; its rod still swings by some newtons.
    let expected = 4000.0 - 0.9 * 5e5 * area(0.063) + 0.95 * 5e5 * area(0.062);
    let pins = simulation.joints().axial_force[0];
    assert!((pins - expected).abs() < 20.0, "{pins} N, expected {expected} N");
    let audit = *simulation.energy();
    // Two loads that grow together do half of force times way: 1.4 kN over 13 um, upwards.
    assert!(audit.pressure > 5e-3, "{audit:?}");
    // Newton leaves up to 1 N of the 1.4 kN.
    assert!(audit.error.abs() < 1e-3 * audit.pressure, "{audit:?}");
    while simulation.time() < 4.0 {
        simulation.advance(&Inputs::ZERO).ok().unwrap();
    }
    let after = *simulation.energy();
    assert!(after.pressure.abs() < 0.05 * audit.pressure, "{after:?}");
    assert!(after.error.abs() < 1e-3 * audit.pressure, "{after:?}");
}
