//! Figures that others have published, which the twin is held against: one table, from which the tests `val_*` assert and
//! `cargo xtask reference validation` prints `docs/validation.md`.

use super::case::CaseTwin;
use super::sliding::weight_at_kickoff;
use super::{Row, VerifyError};
use flexdrill_core::tool::{Body, Direction, SectionProperties};

/// A published figure, or several of one kind.
#[derive(Debug, Clone, Copy)]
pub struct Validation {
    /// Name of its test.
    pub name: &'static str,
    /// What it shows.
    pub shows: &'static str,
    /// Where the figures are published.
    pub source: &'static str,
    /// Why the tolerance is what it is.
    pub reason: &'static str,
    /// What runs it.
    pub command: &'static str,
    /// Runs it: published figure, ours and tolerance of each.
    pub run: fn() -> Result<Vec<Row>, VerifyError>,
}

/// All of them.
pub const VALIDATIONS: &[Validation] = &[
    Validation {
        name: "val_capstan_with_advance",
        shows: "force at the kick-off over weight on bit of a guide that advances round a quarter circle",
        source: "Euler and Eytelwein: e^(mu pi / 2). Johancsik, Friesen and Dawson, J. Pet. Tech. 36 (6), 1984, have the \
                 balance of a pipe in a curved hole, which is this where the pipe has no weight.",
        reason: "The published values have four digits, 0.03 %. The regularised friction takes up to 3e-5 of the \
                 exponent, and 144 chords for the arc 1e-6.",
        command: "cargo test --release -p flexdrill-verify --test validation val_capstan_with_advance",
        run: capstan,
    },
    Validation {
        name: "val_sinusoidal_buckling",
        shows: "axial load at which a pipe on the low side of a level hole buckles sideways",
        source: "Dawson and Paslay, J. Pet. Tech. 36 (10), 1984: 2 sqrt(EI w sin(i) / r).",
        reason: "The last extrapolation of the stiffness spans less than a fifth of the load; the modes that do not \
                 buckle, of which the next one would at 2.1 times the load, bend its line by 0.3 %.",
        command: "cargo test --release -p flexdrill-verify --test validation val_sinusoidal_buckling",
        run: sinusoidal,
    },
    Validation {
        name: "val_helical_buckling",
        shows: "axial load at which a helix on the wall of a level hole has the energy of the straight pipe",
        source: "Chen, Lin and Cheatham, J. Energy Resour. Technol. 112 (3), 1990: 2 sqrt(2) sqrt(EI w sin(i) / r); the \
                 helix's force on the wall per length is r F^2 / 4EI. Dawson and Paslay, J. Pet. Tech. 36 (10), 1984, \
                 have the sinusoidal load.",
        reason: "The published helix is even. Gravity makes a turn uneven by w / (5 EI r k^4) = 0.1 rad, which lowers \
                 the energy by 2.5 % of w r and so the load by 1.25 %.",
        command: "cargo test --release -p flexdrill-verify --test validation val_helical_buckling",
        run: super::helix::buckling,
    },
    Validation {
        name: "val_soft_string_of_welleng",
        shows: "force at the kick-off (N) of a guide that advances round a quarter circle of 32 m, by a program of others",
        source: "welleng 0.30.0 (PyPI), its soft string after Johancsik, Friesen and Dawson (SPE 11380), 2000 stations, \
                 run by `tests/python/soft_string.py`. The package counts the change of inclination downwards, and \
                 so has the weight press to the wrong side of a hole that builds: the figures are with the change \
                 counted from the bit upwards, as in the source; those as released are in the names.",
        reason: "welleng's 2000 steps of first order lack 6e-5 of the force. Our friction acts at the surface of the \
                 guide, 5e-4 of the angle of the arc, and the weight of half a chord at the ends of the tool is 0.1 % \
                 of the force.",
        command: "cargo test --release -p flexdrill-verify --test validation val_soft_string_of_welleng",
        run: super::foreign::soft_strings,
    },
];

fn capstan() -> Result<Vec<Row>, VerifyError> {
    let case = "capstan";
    let mut rows = Vec::new();
    for law in ["vector", "bristle"] {
        for (friction, published) in [(0.1, 1.170), (0.2, 1.369), (0.235, 1.447), (0.3, 1.602), (0.4, 1.875)] {
            let mut twin = CaseTwin::with(case, |config| {
                config
                    .with_value("contact.outer.friction_axial", friction)?
                    .with_value("contact.outer.friction_tangential", friction)?
                    .with_value("contact.outer.friction", law)
            })?;
            let weight = twin.config.simulation().initial_inputs.weight_on_bit;
            let got = weight_at_kickoff(case, &mut twin)? / weight;
            let quantity = format!("mu {friction}, friction: {law} (-)");
            rows.push(Row::relative(case, quantity, published, got, 1e-3));
        }
    }
    Ok(rows)
}

fn sinusoidal() -> Result<Vec<Row>, VerifyError> {
    let case = "sinusoidal_buckling";
    let (stiffness, expected) = (side_stiffness(case), sideways_load(case)?);
    let (mut before, mut load) = ((0.0, stiffness(0.0)?), 0.5 * expected);
    for _ in 0..8 {
        let now = (load, stiffness(load)?);
        let vanishes = now.0 + now.1 * (now.0 - before.0) / (before.1 - now.1);
        if vanishes - load < 0.2 * vanishes {
            let quantity = "2 sqrt(EI w / r) (N)";
            return Ok(vec![Row::relative(case, quantity, expected, vanishes, 0.01)]);
        }
        (before, load) = (now, load + 0.7 * (vanishes - load));
    }
    Err(VerifyError::Missing { case, what: "buckling" })
}

/// Dawson and Paslay's load of the case (N).
fn sideways_load(case: &'static str) -> Result<f64, VerifyError> {
    let config = CaseTwin::new(case)?.config.clone();
    let tool = config.tool();
    let section = SectionProperties::of(tool.pipe_sections[0], tool.material, 1.0);
    let weight = section.mass * tool.gravity;
    Ok(2.0 * (section.bending * weight / config.inner_clearance()).sqrt())
}

/// Stiffness of the pipe's middle against a force sideways (N/m), by axial load (N).
fn side_stiffness(case: &'static str) -> impl Fn(f64) -> Result<f64, VerifyError> {
    move |load| {
        let mut twin = CaseTwin::within(case, 1e-3, |config| {
            config.with_value("loads.0.history.constant", -load)
        })?;
        twin.run_to(4.0)?;
        let middle = twin.last() / 2;
        Ok(0.02 / twin.displacement(middle, Body::Pipe, Direction::V))
    }
}
