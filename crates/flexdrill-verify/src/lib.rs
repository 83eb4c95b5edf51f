//! The closed-form verification cases of `flexdrill verify` and the tests: configurations in `config/verify/`, run by
//! the same code as the node and compared with the closed forms. Also the [error of the time step](step_error).

mod bodies;
mod buckling;
mod case;
mod contacts;
mod foreign;
mod helix;
mod hinged_beam;
mod integration;
mod joints;
mod mud;
mod pins;
mod pipes;
mod preload;
mod pressure;
mod rig;
mod runs;
mod shortening;
mod sliding;
mod slots;
mod spine;
pub mod step_error;
mod validation;

use std::fmt;

pub use buckling::folding_torques;
pub use case::{CaseTwin, head};
pub use foreign::{SOFT_STRINGS, SoftString, SoftStringInputs, WELLENG};
pub use hinged_beam::HingedBeam;
pub use runs::{CaseRun, with_runs};
pub use sliding::{ADVANCE, weight_at_kickoff};
pub use validation::{VALIDATIONS, Validation};

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
    /// Why its limits are what they are.
    pub reason: &'static str,
    /// Runs it.
    pub run: fn() -> Result<Vec<Row>, VerifyError>,
}

/// All cases, in the order of their physics: statics, dynamics, joints, contact, integration.
pub const CASES: &[Case] = &[
    Case {
        name: "cantilever",
        shows: "bending at rest",
        reason: "A linear beam at rest: the rounding of the solve.",
        run: pipes::cantilever,
    },
    Case {
        name: "axial_rod",
        shows: "stretch at rest and its swing",
        reason: "At rest the rounding of the solve; the swing has the elements' and the step's error, below \
                 1e-3.",
        run: pipes::axial_rod,
    },
    Case {
        name: "tied_rods",
        shows: "pipe with joints and sliding guide share a force",
        reason: "Newton's iteration may leave 0.1 N of 100 kN unbalanced.",
        run: pipes::tied_rods,
    },
    Case {
        name: "pipe_in_guide",
        shows: "pipe and sliding guide bent by their weight",
        reason: "Newton's iteration may leave 1 mN of 1 kN unbalanced; the guide alone bends at its ends \
                 by the contact's 1.1 um of 7 mm.",
        run: pipes::pipe_in_guide,
    },
    Case {
        name: "chain_in_guide",
        shows: "a chain of links that hangs into a bent guide",
        reason: "Newton's iteration may leave 1 mN of 1 kN unbalanced.",
        run: pipes::chain_in_guide,
    },
    Case {
        name: "torsion_rod",
        shows: "twist at rest and its swing",
        reason: "At rest the rounding of the solve; the swing has the elements' and the step's error, below \
                 1e-3.",
        run: pipes::torsion_rod,
    },
    Case {
        name: "beam_frequencies",
        shows: "first three bending frequencies",
        reason: "20 elements give the third frequency within 0.01 %, and Newmark's error of its period is \
                 0.015 %.",
        run: pipes::beam_frequencies,
    },
    Case {
        name: "hinged_beam_in_tube",
        shows: "Fig. 8, Eq. 45 corrected",
        reason: "The load grows slowly, and the beam's own swing dies before the loads that are compared.",
        run: pipes::hinged_beam,
    },
    Case {
        name: "curved_guide",
        shows: "wall reaction N / R",
        reason: "The mean over stations that lie on the wall, far from the ends of the guide.",
        run: pipes::curved_guide,
    },
    Case {
        name: "preload_chord",
        shows: "a straight guide in an arc is a chord",
        reason: "Chords of 20 elements depart from the arc by (L / 20 R)^2 / 12 = 2e-5.",
        run: preload::at_its_ends,
    },
    Case {
        name: "preload_wall",
        shows: "its force on the wall",
        reason: "The thrust that the shear becomes softens a tube of that length by 0.15 %; the closed form \
                 has none.",
        run: preload::on_the_wall,
    },
    Case {
        name: "preload_tool",
        shows: "a straight guide in the paper's arc",
        reason: "The independent program has the beam's curve where the model has chords.",
        run: preload::in_the_tool,
    },
    Case {
        name: "preload_turning",
        shows: "what holds a guide against turning",
        reason: "Chords turn about axes that are half the turn of an element off the tube's, 6e-5; the \
                 elements resolve the turn within 3e-5.",
        run: preload::turning,
    },
    Case {
        name: "slots_couples",
        shows: "bending of a guide whose slots close",
        reason: "All elements bend alike: what the iteration leaves of the couples.",
        run: slots::under_couples,
    },
    Case {
        name: "slots_wall",
        shows: "its force on the wall of an arc",
        reason: "Within an element the curvature varies as with open slots, 0.2 % of the way; the force falls by three \
                 times that, because closing the slots takes most of the way. The thrust that the shear becomes takes \
                 0.1 %.",
        run: slots::on_the_wall,
    },
    Case {
        name: "spine_column",
        shows: "a guide that thrust bends",
        reason: "Ten cubic elements have 2e-7 of the deflection, and the thrust shortens the spine by 6e-5, which the \
                 closed form leaves out.",
        run: spine::between_pinned_ends,
    },
    Case {
        name: "hooke_single",
        shows: "ripple of one cross joint",
        reason: "A thousandth of the ripple's amplitude.",
        run: joints::single,
    },
    Case {
        name: "hooke_pair",
        shows: "two crosses a quarter turn apart",
        reason: "A thousandth of the amplitude of one joint's ripple.",
        run: joints::pair,
    },
    Case {
        name: "hooke_chain",
        shows: "four crosses in phase",
        reason: "A thousandth of the ripple's amplitude.",
        run: joints::chain,
    },
    Case {
        name: "torque_buckling",
        shows: "a twisted chain of three links",
        reason: "The chain is linear up to the squares of its tilts, 1e-5, and the last extrapolation spans \
                 some thousandths of the torque.",
        run: buckling::torque,
    },
    Case {
        name: "torque_folding",
        shows: "twisted chains of four, six and eight links",
        reason: "As torque_buckling.",
        run: buckling::folding,
    },
    Case {
        name: "pin_friction",
        shows: "torque lost in the pins of a joint",
        reason: "The regularised friction falls short of Coulomb's by 4e-4, and friction about the upper arm \
                 carries up to 3.1e-3 of the torque.",
        run: pins::friction,
    },
    Case {
        name: "pin_holding",
        shows: "pin friction holds a bent joint",
        reason: "The pin force is that of the step before, 6e-3, and the regularised friction is not at its full value \
                 below the slip rate, 6e-3. Creep: Newton leaves 1e-3 of the rate.",
        run: pins::holding,
    },
    Case {
        name: "joint_play",
        shows: "lost motion of joints with play",
        reason: "The static start leaves some 1 mN m of 10 N m per node.",
        run: pins::play,
    },
    Case {
        name: "play_rotor",
        shows: "a rotor in the play of a joint",
        reason: "Entering and leaving a contact within a step of 0.1 ms, four times in 55 ms.",
        run: pins::rotor,
    },
    Case {
        name: "pressure_buckling",
        shows: "a pipe that buckles by its pressure",
        reason: "20 elements buckle within 1e-6; the last extrapolation spans a hundredth of the pressure.",
        run: pressure::buckling,
    },
    Case {
        name: "pressure_closed",
        shows: "a closed pipe's shape and pins; a held pipe",
        reason: "Static corrections end where rounding keeps the residual from falling; 1 mN of some kN may \
                 stay unbalanced.",
        run: pressure::closed,
    },
    Case {
        name: "pressure_seal",
        shows: "a pipe that slides in a seal",
        reason: "Static corrections end where rounding keeps the residual from falling.",
        run: pressure::seal,
    },
    Case {
        name: "pressure_folding",
        shows: "a chain folds by its effective tension",
        reason: "As torque_buckling.",
        run: buckling::under_pressure,
    },
    Case {
        name: "toggle",
        shows: "two links in line, pushed across",
        reason: "The static start leaves some 10 mN of 1.2 kN.",
        run: shortening::toggle,
    },
    Case {
        name: "tilted_link",
        shows: "a tilted link is shorter",
        reason: "The static start leaves 10 mN of 56 N.",
        run: shortening::tilted,
    },
    Case {
        name: "hanging_link",
        shows: "a hanging link swings by its weight once",
        reason: "To second order the inertia grows with a quarter of the tilt's square, 2e-5 of the \
                 frequency. Of the audit only the quadrature over a step is lost.",
        run: shortening::hanging,
    },
    Case {
        name: "mud_pipe",
        shows: "a pipe in mud: its frequency and damping",
        reason: "Newmark's own error is 2e-5 and the crossings give the frequency to 1e-5; higher modes add \
                 some 1e-3 to the first amplitudes, of which the damping is taken.",
        run: mud::pipe,
    },
    Case {
        name: "mud_coupled",
        shows: "pipe and guide coupled by mud",
        reason: "Newmark's own error is 2e-5, and the crossings give the frequency to 1e-5.",
        run: mud::coupled,
    },
    Case {
        name: "mud_together",
        shows: "pipe and guide that move as one through mud",
        reason: "A hundredth of the mass is compared: Newton leaves up to 1e-5 of the force.",
        run: mud::together,
    },
    Case {
        name: "mud_squeeze",
        shows: "mud that a pipe squeezes out",
        reason: "The inertia takes 5e-4 of the force at the start of the way; steps are a thousandth of its time.",
        run: mud::squeeze,
    },
    Case {
        name: "torsion_pendulum",
        shows: "rotary inertia at the end of a rod",
        reason: "20 elements give the first frequency within 1e-4, the step within 1e-5.",
        run: bodies::torsion_pendulum,
    },
    Case {
        name: "unbalanced_rotor",
        shows: "whirl of an unbalance",
        reason: "Newmark follows the frequency with an error of 1e-4, which the distance to the critical \
                 speed doubles.",
        run: bodies::unbalanced_rotor,
    },
    Case {
        name: "mass_onto_gap",
        shows: "contact time and rebound",
        reason: "A contact begins and ends within a step.",
        run: contacts::mass_onto_gap,
    },
    Case {
        name: "sliding_mass",
        shows: "Coulomb's stopping distance",
        reason: "The regularised friction vanishes with the speed.",
        run: contacts::sliding_mass,
    },
    Case {
        name: "rolling_rotor",
        shows: "backward whirl by rolling",
        reason: "The rotor swings about its path while the contact settles.",
        run: contacts::rolling_rotor,
    },
    Case {
        name: "string_windup",
        shows: "twist of a string above the tool",
        reason: "The vibration of the start has not died out fully after the run.",
        run: rig::windup,
    },
    Case {
        name: "depth_of_cut",
        shows: "weight and torque of a rock that is cut",
        reason: "The vibration of the start has not died out fully; the bit keeps vibrating by micrometres, which \
                 cuts deeper by half a per cent of the torque.",
        run: rig::depth_of_cut,
    },
    Case {
        name: "capstan",
        shows: "friction of a guide that advances round the arc",
        reason: "The regularised friction takes 2.4e-5, chords instead of the arc (mu l / R)^2 / 12.",
        run: sliding::capstan,
    },
    Case {
        name: "capstan_weight",
        shows: "the same with the guide's weight",
        reason: "As capstan; the weight of half a chord at the ends of the tool is 0.1 % of the force.",
        run: sliding::capstan_weight,
    },
    Case {
        name: "capstan_chain",
        shows: "the same with the pipe in the guide",
        reason: "As capstan; the weight of a link at the ends of the tool is 0.1 % of the force.",
        run: sliding::capstan_chain,
    },
    Case {
        name: "capstan_slid_in",
        shows: "friction that holds at rest what slid in",
        reason: "As capstan: friction at the surface of the guide makes 5e-4 of the angle. Bristles keep the forces of \
                 the start to what its rest leaves.",
        run: sliding::slid_in,
    },
    Case {
        name: "capstan_intervals",
        shows: "another friction of the wall in each interval of the hole",
        reason: "As capstan_weight; chords over the boundaries carry a part of the arc's load to stations of the other \
                 interval, 0.1 % of the force.",
        run: sliding::capstan_intervals,
    },
    Case {
        name: "stuck_guide",
        shows: "how far a push reaches along a guide that sticks",
        reason: "The bristles' own slip is 0.9 nm of 47 um; the reach ends where the movement has fallen to \
                 1e-4 of its end, 1e-2 of the length before its end.",
        run: sliding::stuck_guide,
    },
    Case {
        name: "block_on_slope",
        shows: "a block that sticks does not creep",
        reason: "The creep is compared with 0.1 nm in 10^3 s; Newton's iteration leaves 1e-6 of the friction.",
        run: sliding::block_on_slope,
    },
    Case {
        name: "free_vibration",
        shows: "order of Newmark, no drift",
        reason: "Order and drift are those of the rule: the rest is the rounding of corrections in single \
                 precision, and the next order of the step.",
        run: integration::free_vibration,
    },
];
