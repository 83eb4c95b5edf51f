//! `solver`: time integration.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use flexdrill_core::dynamics::Scheme;
use flexdrill_core::twin::StepRule;

const TIME_STEP: Bound = Bound::within(1e-7, 0.01);
const GAMMA: Bound = Bound::within(0.5, 1.0);
/// Over all schemes; HHT's begins at [`HHT_LEAST`].
const RHO_INFINITY: Bound = Bound::within(0.0, 1.0);
const ITERATIONS: Bound = Bound::within(2.0, 100.0);
const HALVINGS: Bound = Bound::within(0.0, 20.0);

/// Time scheme with Newton-Raphson, Eq. 36 to 44.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "Given")]
#[schemars(!from, default, deny_unknown_fields)]
pub struct Solver {
    /// Model step (s). Larger steps lose accuracy in collisions. Default 0.0005.
    #[schemars(transform = TIME_STEP.in_schema())]
    pub time_step: f64,
    /// `auto` solves each step in two parts, in four where the motion requires it, or whole where the machine is too
    /// slow; `fixed` always whole. Default `auto`.
    pub step: StepTaken,
    /// Time integration scheme. Default `generalised_alpha`.
    pub scheme: TimeScheme,
    /// Newmark's gamma; beta = (gamma + 1/2)^2 / 4. Values above 1/2 add numerical damping. Default 0.55. Without
    /// `scheme`, this key selects `scheme: newmark`.
    #[schemars(transform = GAMMA.in_schema())]
    pub gamma: f64,
    /// Spectral radius at infinite frequency of the other schemes: the share of the amplitude at the highest
    /// frequencies that remains after a step. A smaller value damps more. Default 0.45; for `hht` 0.5.
    #[schemars(transform = RHO_INFINITY.in_schema())]
    pub rho_infinity: f64,
    /// Largest number of Newton iterations per sub-step. Default 15.
    #[schemars(transform = ITERATIONS.in_schema())]
    pub max_iterations: u32,
    /// Largest number of times that a step without convergence is halved. Default 6.
    #[schemars(transform = HALVINGS.in_schema())]
    pub max_halvings: u32,
}

/// `solver.step`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StepTaken {
    /// In two parts; in four where the motion requires it, whole where the machine is too slow.
    Auto,
    /// Whole.
    Fixed,
}

/// `solver.scheme`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TimeScheme {
    /// The paper's, with `gamma`.
    Newmark,
    /// HHT-alpha, with `rho_infinity` of 0.5 to 1.
    Hht,
    /// Generalised-alpha, with `rho_infinity` of 0 to 1.
    GeneralisedAlpha,
}

/// HHT's least spectral radius at infinite frequency: at alpha 1/3, beyond which it damps less again.
const HHT_LEAST: f64 = 0.5;

/// The keys as a file gives them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Solver")]
struct Given {
    time_step: Option<f64>,
    step: Option<StepTaken>,
    scheme: Option<TimeScheme>,
    gamma: Option<f64>,
    rho_infinity: Option<f64>,
    max_iterations: Option<u32>,
    max_halvings: Option<u32>,
}

impl From<Given> for Solver {
    fn from(given: Given) -> Self {
        let default = Self::default();
        // Files older than `scheme` say Newmark by its parameter.
        let implied = if given.gamma.is_some() && given.rho_infinity.is_none() {
            TimeScheme::Newmark
        } else {
            default.scheme
        };
        let scheme = given.scheme.unwrap_or(implied);
        let rho_infinity = match scheme {
            TimeScheme::Hht => default.rho_infinity.max(HHT_LEAST),
            TimeScheme::Newmark | TimeScheme::GeneralisedAlpha => default.rho_infinity,
        };
        Self {
            time_step: given.time_step.unwrap_or(default.time_step),
            step: given.step.unwrap_or(default.step),
            scheme,
            gamma: given.gamma.unwrap_or(default.gamma),
            rho_infinity: given.rho_infinity.unwrap_or(rho_infinity),
            max_iterations: given.max_iterations.unwrap_or(default.max_iterations),
            max_halvings: given.max_halvings.unwrap_or(default.max_halvings),
        }
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            time_step: 0.0005,
            step: StepTaken::Auto,
            scheme: TimeScheme::GeneralisedAlpha,
            gamma: 0.55,
            rho_infinity: 0.45,
            max_iterations: 15,
            max_halvings: 6,
        }
    }
}

impl Solver {
    pub(super) fn describe(&self) -> Scheme {
        match self.scheme {
            TimeScheme::Newmark => Scheme::newmark(self.gamma),
            TimeScheme::Hht => Scheme::hht(self.rho_infinity),
            TimeScheme::GeneralisedAlpha => Scheme::generalised_alpha(self.rho_infinity),
        }
    }

    pub(super) fn rule(&self) -> StepRule {
        match self.step {
            StepTaken::Auto => StepRule::Auto,
            StepTaken::Fixed => StepRule::Fixed,
        }
    }

    /// The scheme and its parameter, as text for displays.
    pub fn scheme_in_words(&self) -> String {
        match self.scheme {
            TimeScheme::Newmark => format!("Newmark gamma {}", self.gamma),
            TimeScheme::Hht => format!("HHT-alpha, rho_infinity {}", self.rho_infinity),
            TimeScheme::GeneralisedAlpha => format!("generalised-alpha, rho_infinity {}", self.rho_infinity),
        }
    }

    /// The step and its division, as text for displays.
    pub fn step_in_words(&self) -> String {
        let whole = self.time_step * 1e3;
        match self.step {
            StepTaken::Fixed => format!("{whole} ms"),
            StepTaken::Auto => format!(
                "{whole} ms, in parts of {} or {} ms (step: auto)",
                whole / 2.0,
                whole / 4.0
            ),
        }
    }

    pub(super) fn check(&self, c: &mut Checker) {
        let reason = "a stiff contact lasts some milliseconds: a longer step would jump over it";
        c.number("time_step", self.time_step, TIME_STEP, "s", reason);
        let reason = "below 1/2 the integration gains energy, above 1 it takes nearly all motion";
        c.number("gamma", self.gamma, GAMMA, "", reason);
        let newmark = self.scheme == TimeScheme::Newmark;
        let default = Self::default();
        if !newmark {
            let bound = format!("left at {} unless solver.scheme is newmark", default.gamma);
            let reason = "the other schemes have rho_infinity instead";
            c.require(self.gamma == default.gamma, "gamma", self.gamma, "", bound, reason);
        }
        let reason =
            "above 1 high frequencies grow; below 0 they change sign with every step, and hht damps no more below 0.5";
        let bound = if self.scheme == TimeScheme::Hht {
            Bound::within(HHT_LEAST, 1.0)
        } else {
            RHO_INFINITY
        };
        c.number("rho_infinity", self.rho_infinity, bound, "", reason);
        if newmark {
            let bound = format!("left at {} with solver.scheme newmark", default.rho_infinity);
            let reason = "Newmark has gamma instead";
            let given = self.rho_infinity;
            c.require(given == default.rho_infinity, "rho_infinity", given, "", bound, reason);
        }
        let reason = "a linear step takes 2, a healthy contact 3 to 5";
        c.count("max_iterations", self.max_iterations as usize, ITERATIONS, reason);
        c.count(
            "max_halvings",
            self.max_halvings as usize,
            HALVINGS,
            "each doubles the work of a step",
        );
    }
}
