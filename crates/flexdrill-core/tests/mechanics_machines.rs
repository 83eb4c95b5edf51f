//! A machine with AVX2 and one with AVX-512 compute the same to the bit, so that a bag recorded on one replays on the
//! other.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

mod support;

use flexdrill_core::Instructions;
use flexdrill_core::dynamics::StepOutcome;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::step::SolverKind;
use flexdrill_core::tool::ToolDescription;
use flexdrill_core::twin::{Simulation, SimulationSettings, Snapshot};
use support::hinged;

/// State and snapshot after `steps` steps at 40 r/min and 20 kN from rest under that weight.
fn run(tool: &ToolDescription, instructions: Instructions, steps: u64) -> (Vec<f64>, Snapshot) {
    let mut settings = SimulationSettings::default();
    settings.initial_inputs.weight_on_bit = 20e3;
    let mut simulation = Simulation::with_solver(tool, &settings, SolverKind::default(), instructions).unwrap();
    for _ in 0..steps {
        let outcome = simulation.advance(&Inputs {
            rotary_speed: 40.0 * std::f64::consts::TAU / 60.0,
            weight_on_bit: 20e3,
            ..Inputs::default()
        });
        assert!(matches!(outcome, StepOutcome::Advanced { .. }), "{outcome:?}");
    }
    let mut snapshot = simulation.new_snapshot();
    simulation.snapshot(&mut snapshot, false);
    (simulation.state().q, snapshot)
}

#[test]
fn machines_agree_to_the_bit() {
    let default = ToolDescription::paper();
    // The guide on the wall at many stations: spans eliminated together and alone.
    let soft = default.clone().with(|tool| tool.guide_bending_factor = 0.05);
    // Joints with two rotational rows.
    let hinged = hinged();
    for (name, tool) in [("default", &default), ("soft guide", &soft), ("hinged", &hinged)] {
        let (plain, _) = run(tool, Instructions::PORTABLE, 100);
        let available: Vec<Instructions> = Instructions::available().collect();
        assert_eq!(available[0], Instructions::PORTABLE);
        let vectors = &available[1..];
        for &instructions in vectors {
            let (q, _) = run(tool, instructions, 100);
            let scale = plain.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (i, (x, expected)) in q.iter().zip(&plain).enumerate() {
                // Newton leaves 1e-6 of the forces, the motion multiplies differences by e every 15 ms: 28 times in 50
                // ms.
                assert!(
                    (x - expected).abs() < 1e-4 * scale,
                    "{name}, {instructions:?}: q[{i}] = {x} against {expected}"
                );
            }
        }
        let [first, others @ ..] = vectors else {
            eprintln!("skipped: this machine has no AVX2");
            return;
        };
        // Longer, since nothing may differ.
        let expected = run(tool, *first, 1000);
        for &instructions in others {
            let got = run(tool, instructions, 1000);
            assert!(
                got.0 == expected.0,
                "{name}: {instructions:?} gives another state than {first:?}"
            );
            assert!(
                support::same_bits(&got.1, &expected.1),
                "{name}: {instructions:?} gives another snapshot than {first:?}"
            );
        }
    }
}

/// A vector instruction is a function where a kernel's closure was compiled by itself, without the instructions that the
/// kernel around it has: a call for each product. The names of functions are in the symbol table of this test's program.
#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
#[test]
#[cfg_attr(debug_assertions, ignore = "without optimisation every instruction is a function")]
fn vector_instructions_are_compiled_into_the_kernels() {
    let program = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    let names = program.split(|byte| !byte.is_ascii_alphanumeric() && !b"_.$".contains(byte));
    let names: Vec<_> = names.filter_map(|name| std::str::from_utf8(name).ok()).collect();
    let kernels = names.iter().filter(|name| name.contains("with_avx2")).count();
    assert!(kernels > 20, "{kernels} kernels: the program has no symbols");
    // Joined here, so that the test does not find its own strings in the program.
    let groups = ["arch3x863avx", "arch3x863fma", "arch3x867avx512"].map(|group| ["core", group].join("_"));
    let called: std::collections::BTreeSet<_> = (names.iter())
        .filter(|name| groups.iter().any(|group| name.contains(group)))
        .collect();
    assert!(called.is_empty(), "{called:#?}");
}
