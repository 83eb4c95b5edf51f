//! Mud that moves with the pipes: its energy is in the audit, both forms of the equations move alike, parts of steps and
//! checkpoints keep the motion.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::Instructions;
use flexdrill_core::dynamics::Scheme;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::{MOST_REFINEMENT, SolverKind};
use flexdrill_core::tool::{
    AddedMass, Body, MudDamping, MudDescription, MudFilm, Rayleigh, ToolDescription, WellSection,
};
use flexdrill_core::twin::{Simulation, SimulationSettings};
use support::{coarse, tiny};

const MUD: MudDescription = MudDescription {
    density: 1100.0,
    viscosity: 0.02,
    frequency: 4.0 / 3.0,
    added_mass: AddedMass::Concentric,
    damping: MudDamping::Viscous,
    film: MudFilm::None,
};

const TURNING: Inputs = Inputs {
    rotary_speed: 40.0 * std::f64::consts::TAU / 60.0,
    weight_on_bit: 10e3,
    ..Inputs::ZERO
};

fn with(tool: &ToolDescription, settings: &SimulationSettings, solver: SolverKind) -> Simulation {
    Simulation::with_solver(tool, settings, solver, Instructions::best()).unwrap()
}

/// A pipe that swings in a straight guide, with nothing but mud around it: what it loses, the mud has taken. Over the
/// chain and over all stations.
#[test]
fn viscosity_takes_what_a_swing_loses() {
    let mut tool = tiny();
    tool.well.sections = vec![WellSection::Straight { length: 2.0 }];
    (tool.inner.stiffness, tool.outer.stiffness) = (0.0, 0.0);
    tool.rayleigh = Rayleigh { alpha: 0.0, beta: 0.0 };
    (tool.gravity, tool.drive_top, tool.static_start) = (0.0, false, false);
    tool.initial_pipe_velocity = [0.0, 0.05, 0.1];
    // No stop is reached.
    tool.joint.limit = 1.0;
    let settings = SimulationSettings::default().with(|settings| settings.scheme = Scheme::newmark(0.5));
    let taken = [SolverKind::Chain, SolverKind::Stations].map(|solver| {
        let run = |mud: MudDescription| {
            let mut tool = tool.clone();
            tool.mud = Some(mud);
            let mut simulation = with(&tool, &settings, solver);
            while simulation.time() < 1.0 {
                simulation.advance(&Inputs::ZERO).ok().unwrap();
            }
            *simulation.energy()
        };
        let audit = run(MUD);
        println!("{solver:?}: {audit:?}");
        assert!(audit.mud > 0.05, "{audit:?}");
        // The trapezoid rule is exact for it; Newton leaves 1 N at speeds of 0.1 m/s.
        assert!((audit.mud + audit.stored).abs() < 1e-3 * audit.mud, "{audit:?}");
        assert!(audit.error.abs() < 1e-3 * audit.mud, "{audit:?}");
        let ideal = run(MudDescription {
            damping: MudDamping::None,
            ..MUD
        });
        assert!(ideal.mud == 0.0 && ideal.stored.abs() < 1e-3 * audit.mud, "{ideal:?}");
        audit.mud
    });
    // Both forms solve the same equations, where a span has no inner stations.
    assert!((taken[0] / taken[1] - 1.0).abs() < 1e-3, "{taken:?}");
}

/// A pipe on two supports that swings through most of the gap, where its mass grows by a half: over ten thousand periods
/// it keeps its energy. Newmark's rule at 1/2 is not made for a mass that changes; the energy swings within a period, by
/// (omega h)^2, and must not drift.
#[test]
fn a_mass_that_grows_near_the_wall_keeps_the_energy() {
    let mut tool = tiny().with_mesh(1, 2);
    tool.well.sections = vec![WellSection::Straight { length: 2.0 }];
    (tool.inner.stiffness, tool.outer.stiffness) = (0.0, 0.0);
    tool.rayleigh = Rayleigh { alpha: 0.0, beta: 0.0 };
    (tool.gravity, tool.drive_top, tool.static_start, tool.guide_fixed) = (0.0, false, false, true);
    tool.initial_pipe_velocity = [0.0, 0.3, 1.15];
    tool.mud = Some(MudDescription {
        added_mass: AddedMass::Eccentric,
        damping: MudDamping::None,
        ..MUD
    });
    let settings = SimulationSettings::default().with(|settings| {
        settings.scheme = Scheme::newmark(0.5);
        settings.time_step = 1e-3;
        // What Newton may leave in motion, 1 N, feeds the swing by 1e-6 J a step.
        settings.residual_factor = 1e-4;
    });
    let mut simulation = with(&tool, &settings, SolverKind::Chain);
    let (mut farthest, mut periods, mut side) = (0.0_f64, 0, true);
    let mut means = Vec::new();
    while periods < 10_000 {
        let (mut sum, mut steps) = (0.0, 0);
        let until = periods + 500;
        while periods < until {
            simulation.advance(&Inputs::ZERO).ok().unwrap();
            let [y, z] = simulation.lateral(1, Body::Pipe).unwrap();
            farthest = farthest.max(y.hypot(z));
            periods += i32::from(!side && z > 0.0);
            side = z > 0.0;
            sum += simulation.energy().stored;
            steps += 1;
        }
        means.push(sum / f64::from(steps));
    }
    let audit = *simulation.energy();
    println!(
        "{farthest:.2e} m, mean change {means:?} J, {:.0} s, {audit:?}",
        simulation.time()
    );
    // Between 0.6 and 0.95 of the gap, so that the mass grows by a tenth to a half and the largest eps is not reached.
    assert!(farthest > 0.6 * 8.5e-3 && farthest < 0.95 * 8.5e-3, "{farthest}");
    // 33 kg/m x 1 m at the middle station x 0.95^2 / 2.
    let energy = 15.0;
    let drift = means.iter().map(|mean| (mean - means[0]).abs()).fold(0.0, f64::max);
    // A ten-thousandth of what Newton leaves in motion made 1.6e-5 J.
    assert!(drift < 1e-5 * energy, "{drift} J");
    assert!(audit.error.abs() < 1e-3 * energy, "{audit:?}");
}

/// Drilling in mud: the audit's error is not larger than without it, and the mud takes energy all the time.
#[test]
fn the_audit_closes_while_drilling_in_mud() {
    let run = |mud: Option<MudDescription>| {
        let mut tool = coarse();
        tool.mud = mud;
        let mut simulation = with(&tool, &SimulationSettings::default(), SolverKind::Chain);
        while simulation.time() < 6.0 {
            simulation.advance(&TURNING).ok().unwrap();
        }
        let mut seen = simulation.new_snapshot();
        simulation.snapshot(&mut seen, false);
        // The powers that are published are the audit's, with all of its terms.
        let power = &seen.transfer.power;
        let put_in = power.drive + power.weight_on_bit + power.gravity + power.axial_update;
        let damped = power.contact_damping + power.rayleigh_damping + power.numerical_damping + power.mud;
        let taken = power.bit + power.friction + damped;
        assert!(
            (put_in - taken - power.stored - power.error).abs() < 1e-6 * power.drive,
            "{power:?}"
        );
        *simulation.energy()
    };
    let (dry, wet) = (run(None), run(Some(MUD)));
    let share = |audit: &flexdrill_core::dynamics::Energies| (audit.error / audit.drive).abs();
    assert_eq!(dry.mud, 0.0);
    assert!(wet.mud > 0.0, "{wet:?}");
    // Collisions make the error, of either sign: 1 % of the drive's work is ten times what either run has.
    assert!(share(&dry) < 0.01 && share(&wet) < 0.01, "{dry:?} {wet:?}");
}

/// Lateral positions of all joints.
fn joints(simulation: &Simulation) -> Vec<f64> {
    let stations = simulation.joint_stations().iter();
    stations
        .flat_map(|&station| simulation.lateral(station, Body::Pipe).unwrap())
        .collect()
}

/// Without bit torque, which lets small differences grow, the chain moves as all stations do, and parts of a step are
/// shorter steps.
#[test]
fn calm_joints_in_mud_are_where_they_are_with_all_stations_and_shorter_steps() {
    let mut tool = ToolDescription::paper();
    tool.bit.friction_factor = 0.0;
    tool.mud = Some(MUD);
    let mut settings = SimulationSettings::default();
    settings.initial_inputs.weight_on_bit = 10e3;
    let shorter = settings.clone().with(|settings| settings.time_step *= 0.5);
    let mut chain = with(&tool, &settings, SolverKind::Chain);
    let mut whole = with(&tool, &settings, SolverKind::Stations);
    let mut refined = with(&tool, &settings, SolverKind::Chain);
    let mut short = with(&tool, &shorter, SolverKind::Chain);
    refined.set_refinement(1);
    let start = joints(&chain);
    let (mut moved, mut of_solver, mut of_parts, mut of_step) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for step in 0..3000 {
        for simulation in [&mut chain, &mut whole, &mut refined, &mut short] {
            simulation.advance(&TURNING).ok().unwrap();
        }
        short.advance(&TURNING).ok().unwrap();
        if step % 20 == 0 {
            let at = [&chain, &whole, &refined, &short].map(joints);
            let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            moved = moved.max(apart(&at[0], &start));
            of_solver = of_solver.max(apart(&at[0], &at[1]));
            of_parts = of_parts.max(apart(&at[2], &at[3]));
            of_step = of_step.max(apart(&at[0], &at[3]));
        }
    }
    println!("moved {moved:.1e} m, stations {of_solver:.1e}, parts {of_parts:.1e}, step {of_step:.1e} m");
    // What the slaving is promised to change, and rounding against what the step does.
    assert!(of_solver < 5e-4 * moved, "{of_solver:e} m of {moved:e} m");
    assert!(of_parts < 1e-3 * of_step, "{of_parts:e} m, whole step {of_step:e} m");
}

/// A checkpoint continues to the bit, with the mud's mass and damping in it; mud is part of the tool's identity.
#[test]
fn a_checkpoint_continues_in_mud() {
    let mut tool = coarse();
    tool.mud = Some(MUD);
    let settings = SimulationSettings::default();
    let mut first = with(&tool, &settings, SolverKind::Chain);
    (0..400).for_each(|_| first.advance(&TURNING).ok().unwrap());
    let saved = first.checkpoint().unwrap();
    let mut second = with(&tool, &settings, SolverKind::Chain);
    second.restore(&saved).unwrap();
    for simulation in [&mut first, &mut second] {
        (0..200).for_each(|_| simulation.advance(&TURNING).ok().unwrap());
    }
    assert_eq!(first.checkpoint().unwrap(), second.checkpoint().unwrap());
    tool.mud = Some(MudDescription {
        viscosity: 0.021,
        ..MUD
    });
    assert!(with(&tool, &settings, SolverKind::Chain).restore(&saved).is_err());
}

/// Mud slows the inner stations down: a soft guide has nodes inside its spans, and fewer parts of steps.
#[test]
fn mud_counts_where_spans_are_judged() {
    let finest = |factor: f64, mud: Option<MudDescription>| {
        let mut tool = ToolDescription::paper();
        (tool.guide_bending_factor, tool.mud) = (factor, mud);
        let mut simulation = with(&tool, &SimulationSettings::default(), SolverKind::Chain);
        simulation.set_refinement(MOST_REFINEMENT);
        (simulation.quality().choice.in_force, simulation.chain_nodes())
    };
    let ideal = MudDescription {
        damping: MudDamping::None,
        ..MUD
    };
    // Slowest inner frequency times the step: 43 without mud, 32 with it; 19 and 9 with a twentieth of the stiffness.
    assert_eq!(finest(1.0, None), (2, 34));
    assert_eq!(finest(1.0, Some(ideal)).1, 34);
    assert_eq!(finest(0.05, None), (1, 34));
    assert_eq!(finest(0.05, Some(ideal)), (0, 34));
}
