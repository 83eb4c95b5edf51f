//! The closed-form verification cases of `flexdrill verify` and the tests: configurations in `config/verify/`, run by
//! the same code as the node and compared with the closed forms. Also the [error of the time step](step_error).

mod bench;
mod bodies;
mod buckling;
mod contacts;
mod hinged_beam;
mod integration;
mod joints;
mod pipes;
pub mod step_error;

use std::fmt;

pub use bench::Bench;
pub use hinged_beam::HingedBeam;

use flexdrill_config::ConfigError;
use flexdrill_core::dynamics::StepFailure;
use flexdrill_core::twin::BuildError;

/// One compared number.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Case, the name of its configuration.
    pub case: &'static str,
    /// What is compared, with its unit.
    pub quantity: String,
    /// Closed form.
    pub expected: f64,
    /// Computed.
    pub got: f64,
    /// Reference of the error.
    pub scale: f64,
    /// Largest error allowed.
    pub limit: f64,
}

impl Row {
    /// A number compared relative to its closed form.
    pub fn relative(case: &'static str, quantity: impl Into<String>, expected: f64, got: f64, limit: f64) -> Self {
        Self::scaled(case, quantity, expected, got, expected.abs(), limit)
    }

    /// A number whose error is counted relative to `scale`.
    pub fn scaled(
        case: &'static str,
        quantity: impl Into<String>,
        expected: f64,
        got: f64,
        scale: f64,
        limit: f64,
    ) -> Self {
        Self {
            case,
            quantity: quantity.into(),
            expected,
            got,
            scale,
            limit,
        }
    }

    /// |got - expected| / scale.
    pub fn error(&self) -> f64 {
        (self.got - self.expected).abs() / self.scale
    }

    /// Whether the error is within the limit.
    pub fn passed(&self) -> bool {
        self.error() <= self.limit
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.passed() { "ok" } else { "FAILED" };
        write!(
            f,
            "{:<22} {:<50} {:>14.6e} {:>14.6e} {:>10.2e} {:>10.2e}  {verdict}",
            self.case,
            self.quantity,
            self.expected,
            self.got,
            self.error(),
            self.limit
        )
    }
}

/// Column titles for [`Row`]'s lines.
pub fn title() -> String {
    format!(
        "{:<22} {:<50} {:>14} {:>14} {:>10} {:>10}",
        "case", "quantity", "expected", "got", "error", "limit"
    )
}

/// Why a case could not be run.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// Its configuration is refused.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Its tool cannot be built or started.
    #[error("verification case {case}: {source}")]
    Build {
        /// Name of the verification case.
        case: &'static str,
        /// The error behind it.
        source: BuildError,
    },
    /// A step failed.
    #[error("verification case {case}: step failed: {failure}")]
    Step {
        /// Name of the verification case.
        case: &'static str,
        /// Why and where.
        failure: StepFailure,
    },
    /// A necessary event of the case did not happen, so that nothing can be compared.
    #[error("verification case {case}: {what} did not happen")]
    Missing {
        /// Name of the verification case.
        case: &'static str,
        /// What is missing.
        what: &'static str,
    },
}

/// A case: its name and how it is run.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Name, also of its file in `config/verify/`.
    pub name: &'static str,
    /// What it shows.
    pub shows: &'static str,
    /// Runs it.
    pub run: fn() -> Result<Vec<Row>, VerifyError>,
}

/// All cases, in the order of their physics: statics, dynamics, joints, contact, integration.
pub const CASES: &[Case] = &[
    Case {
        name: "cantilever",
        shows: "bending at rest",
        run: pipes::cantilever,
    },
    Case {
        name: "axial_rod",
        shows: "stretch at rest and its swing",
        run: pipes::axial_rod,
    },
    Case {
        name: "tied_rods",
        shows: "pipe with joints and sliding guide share a force",
        run: pipes::tied_rods,
    },
    Case {
        name: "pipe_in_guide",
        shows: "pipe and sliding guide bent by their weight",
        run: pipes::pipe_in_guide,
    },
    Case {
        name: "chain_in_guide",
        shows: "a chain of links that hangs into a bent guide",
        run: pipes::chain_in_guide,
    },
    Case {
        name: "torsion_rod",
        shows: "twist at rest and its swing",
        run: pipes::torsion_rod,
    },
    Case {
        name: "beam_frequencies",
        shows: "first three bending frequencies",
        run: pipes::beam_frequencies,
    },
    Case {
        name: "hinged_beam_in_tube",
        shows: "Fig. 8, Eq. 45 corrected",
        run: pipes::hinged_beam,
    },
    Case {
        name: "curved_guide",
        shows: "wall reaction N / R",
        run: pipes::curved_guide,
    },
    Case {
        name: "hooke_single",
        shows: "ripple of one cross joint",
        run: joints::single,
    },
    Case {
        name: "hooke_pair",
        shows: "two crosses a quarter turn apart",
        run: joints::pair,
    },
    Case {
        name: "hooke_chain",
        shows: "four crosses in phase",
        run: joints::chain,
    },
    Case {
        name: "torque_buckling",
        shows: "a twisted chain of three links",
        run: buckling::torque,
    },
    Case {
        name: "torque_folding",
        shows: "twisted chains of four and eight links",
        run: buckling::folding,
    },
    Case {
        name: "torsion_pendulum",
        shows: "rotary inertia at the end of a rod",
        run: bodies::torsion_pendulum,
    },
    Case {
        name: "unbalanced_rotor",
        shows: "whirl of an unbalance",
        run: bodies::unbalanced_rotor,
    },
    Case {
        name: "mass_onto_gap",
        shows: "contact time and rebound",
        run: contacts::mass_onto_gap,
    },
    Case {
        name: "sliding_mass",
        shows: "Coulomb's stopping distance",
        run: contacts::sliding_mass,
    },
    Case {
        name: "rolling_rotor",
        shows: "backward whirl by rolling",
        run: contacts::rolling_rotor,
    },
    Case {
        name: "free_vibration",
        shows: "order of Newmark, no drift",
        run: integration::free_vibration,
    },
];
