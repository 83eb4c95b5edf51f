//! Balances of the whole tool below a string, in a curved hole: pieces that are right alone must be right together.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::inputs::Inputs;
use flexdrill_core::tool::{
    DepthOfCut, Direction, Feed, Hoist, Location, Material, Piece, PressureDescription, PressureEnd, PressureSource,
    RockLaw, SectionProperties, SpeedController, StringDescription, ToolDescription, TopDrive, Tube, Weakening,
};
use flexdrill_core::twin::{Simulation, SimulationSettings};
use support::{coarse, figure, scaled_figure};

const STEEL: Material = Material {
    youngs_modulus: 206e9,
    poisson_ratio: 0.3,
    density: 7850.0,
};

/// The paper's tool in its quarter circle, below `length` (m) of 73.0/54.6 mm, on rock, its guide without friction on the
/// wall.
fn on_a_smooth_wall(length: f64) -> ToolDescription {
    let mut tool = coarse();
    let tube = Tube {
        outer_diameter: 0.0730,
        inner_diameter: 0.0546,
    };
    tool.string = Some(StringDescription {
        pieces: vec![Piece::of(&SectionProperties::of(tube, STEEL, 1.0), length)],
        drive: TopDrive::Controlled(SpeedController {
            inertia: 50.0,
            proportional: 200.0,
            integral: 400.0,
            torque_limit: 5000.0,
        }),
        hoist: Some(Hoist {
            stiffness: 5e6,
            response_time: 2.0,
            fastest: 30e-3,
            touch_down: 5e-3,
            clearance: 10e-3,
            feed: Feed::Weight,
        }),
        weight: 80e3,
    });
    tool.rock = RockLaw::DepthOfCut(DepthOfCut {
        blades: 4,
        specific_energy: 120e6,
        cutter_inclination: 2.0,
        wear_flat_force: 1000.0,
        wear_flat_friction: 0.1,
        wear_flat_travel: 1e-4,
        cutting_weakening: 0.0,
        weakening: Weakening::NONE,
    });
    for support in &mut tool.supports {
        if support.location == Location::Top {
            support.directions.retain(|&direction| direction != Direction::U);
        }
    }
    (tool.outer.friction_tangential, tool.outer.friction_axial) = (0.0, 0.0);
    tool
}

fn run(tool: &ToolDescription, inputs: Inputs, until: f64) -> Simulation {
    let mut twin = Simulation::new(tool, &SimulationSettings::default()).unwrap();
    while twin.time() < until {
        twin.advance(&inputs).ok().unwrap();
    }
    twin
}

/// Weight at the kick-off, weight at the bit, sum of the magnitudes of the wall's forces on the guide: means over two
/// seconds (N).
fn forces(twin: &mut Simulation, inputs: Inputs) -> [f64; 3] {
    let (mut sums, mut count, end) = ([0.0; 3], 0.0, twin.time() + 2.0);
    while twin.time() < end {
        twin.advance(&inputs).ok().unwrap();
        let wall: f64 = (0..=twin.last_station())
            .map(|station| twin.normal_force(station, flexdrill_core::tool::Body::Guide).unwrap())
            .sum();
        let now = [twin.weight_at_kickoff().unwrap(), twin.bit().weight_on_bit, wall];
        sums.iter_mut().zip(now).for_each(|(sum, x)| *sum += x);
        count += 1.0;
    }
    sums.map(|sum| sum / count)
}

/// A wall without friction and the supports at both ends push towards the arc's centre. Moments about it: kick-off less
/// bit = - w R for a weight w per length of both pipes, whatever hangs above and however far that is compressed. Nothing
/// turns. Tolerance 0.5 % of w R: the guide itself is shortened by 0.15 mm, which moves 0.7 N.
#[test]
fn a_smooth_wall_passes_the_weight_by_gravity_alone() {
    for (length, weight) in [(100.0, 20e3), (1000.0, 20e3), (3000.0, 20e3), (1000.0, 40e3)] {
        let tool = on_a_smooth_wall(length);
        let inputs = Inputs {
            weight_on_bit: weight,
            ..Inputs::ZERO
        };
        let mut twin = run(&tool, inputs, 40.0);
        let [kick_off, bit, _] = forces(&mut twin, inputs);
        // The quarter circle is pi R / 2 long.
        let expected = -twin.mass() * tool.gravity * std::f64::consts::FRAC_2_PI;
        assert!(bit > 0.8 * weight, "the weight is there: {bit} N");
        figure(
            &format!("kick-off less bit, {length} m of string, {weight} N (N)"),
            expected,
            kick_off - bit,
            5e-3,
        );
    }
}

/// The pressure on the pipe's end in its seal pulls the guide, which holds the seal: kick-off and bit do not feel the pump.
/// Nothing turns. Tolerances, over the force in the seal, p A_s = 24.9 kN: 1e-3, the second order in the 2 to 6 mrad by which
/// both pipes have moved along the arc. The wall's 1e-2: the pipe is centred at both ends and lies 8.5 mm off the guide's axis
/// between them, a couple of p A_s 8.5 mm = 212 N m at each end, which over 1.9 m of guide that does not touch the wall takes 112 N.
#[test]
fn a_pump_changes_no_wall_force_and_no_weight() {
    let inputs = Inputs {
        weight_on_bit: 15e3,
        ..Inputs::ZERO
    };
    let forces_with = |pressure: f64| {
        let mut tool = on_a_smooth_wall(200.0);
        tool.pressure = Some(PressureDescription {
            at_top: PressureSource::Constant(pressure),
            drop_per_metre: 0.0,
            end: PressureEnd::Sealed { diameter: 0.063 },
            joint_seal_diameter: 0.062,
        });
        let mut twin = run(&tool, inputs, 25.0);
        forces(&mut twin, inputs)
    };
    let (off, on) = (forces_with(0.0), forces_with(8e6));
    let seal = 8e6 * std::f64::consts::FRAC_PI_4 * 0.063 * 0.063;
    for (what, k, tolerance) in [("kick-off", 0, 1e-3), ("bit", 1, 1e-3), ("wall", 2, 1e-2)] {
        scaled_figure(&format!("{what} with 8 MPa (N)"), off[k], on[k], seal, tolerance);
    }
}
