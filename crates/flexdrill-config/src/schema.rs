//! The sections of a configuration.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Alarms, Boundary, Calibration, ChaoticWhirl, Contact, DrillString, Ensemble, Environment, GuidePreload, Initial,
    InputsConfig, JointLoad, Load, LookAhead, Mass, Network, Outputs, PressureFolding, Rock, Run, SafeMap, Shock,
    Solver, Start, StickSlip, Tool, Transfer, Uncertainty, Well, Whirl,
};

/// The whole schema, top level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Schema {
    /// Title and duration of a run.
    #[serde(default)]
    pub run: Run,
    /// The bore. Required.
    pub well: Well,
    /// The tool in the bore. Required.
    pub tool: Tool,
    /// Contact between pipe and guide and between guide and wall.
    #[serde(default)]
    pub contact: Contact,
    /// Gravity and buoyancy.
    #[serde(default)]
    pub environment: Environment,
    /// Supports, drive and load path.
    #[serde(default)]
    pub boundary: Boundary,
    /// How the rock answers the bit.
    #[serde(default)]
    pub rock: Rock,
    /// The drill string above the tool, up to top drive and hoist.
    #[serde(default)]
    pub string: DrillString,
    /// Loads in addition to gravity, drive and bit. Default none.
    #[serde(default)]
    pub loads: Vec<Load>,
    /// Rigid bodies added to nodes. Default none.
    #[serde(default)]
    pub masses: Vec<Mass>,
    /// Beginning of a run: `static` from rest under gravity and the initial weight on bit, `slid_in` the same with the
    /// friction of the wall against an advance that has just ended, or `as_given` with `initial`. Default static.
    #[serde(default)]
    pub start: Start,
    /// Motion at the beginning; only with `start: as_given`.
    #[serde(default)]
    pub initial: Initial,
    /// Time integration.
    #[serde(default)]
    pub solver: Solver,
    /// The inputs from the rig: limits, ages, safe values, publishers.
    #[serde(default)]
    pub inputs: InputsConfig,
    /// Reach of DDS.
    #[serde(default)]
    pub network: Network,
    /// Whirl analysis and its levels.
    #[serde(default)]
    pub whirl: Whirl,
    /// Stick-slip of the bit and its levels.
    #[serde(default)]
    pub stick_slip: StickSlip,
    /// Lateral shock and its levels.
    #[serde(default)]
    pub shock: Shock,
    /// Load of the joints' stops and its levels.
    #[serde(default)]
    pub joint_load: JointLoad,
    /// Chaotic whirl, judged by the power of the collisions, and its levels.
    #[serde(default)]
    pub chaotic_whirl: ChaoticWhirl,
    /// Torque, weight and power from the surface to the bit, and the levels of what does not arrive.
    #[serde(default)]
    pub transfer: Transfer,
    /// Bending of a preloaded guide against its rating.
    #[serde(default)]
    pub guide_preload: GuidePreload,
    /// Effective compression of a pipe under pressure against its rating.
    #[serde(default)]
    pub pressure_folding: PressureFolding,
    /// Alarms: delays, service, advice.
    #[serde(default)]
    pub alarms: Alarms,
    /// Runs from forks of the present state: what would be under other speeds and weights.
    #[serde(default)]
    pub look_ahead: LookAhead,
    /// The map of speed and weight that the node loads.
    #[serde(default)]
    pub map: SafeMap,
    /// What `flexdrill calibrate` fits to a log, and what follows the rig while it drills.
    #[serde(default)]
    pub calibration: Calibration,
    /// What is not known: distributions of keys, errors of sensors. Default none: nothing is drawn.
    // Left out where there is none, so that such a file has the hash that it had before the section existed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<Uncertainty>,
    /// Plausible tools that run with the twin. Default none.
    // As above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ensemble: Option<Ensemble>,
    /// Frames and publishing rates of the outputs.
    #[serde(default)]
    pub outputs: Outputs,
}
