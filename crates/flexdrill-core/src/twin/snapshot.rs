//! The state of the tool at one instant: plain arrays, allocated once, filled in place.
//!
//! Every output (messages, bags, the terminal view, plots) is made from a [`Snapshot`] and nothing else.

use serde::{Deserialize, Serialize};

use super::quality::ModelQuality;
use crate::dynamics::Energies;
use crate::dynamics::outcome::StepFailure;
use crate::inputs::Inputs;
use crate::tool::Body;
use flexdrill_motion::{Ageing, Hazards, Severity, ShockLevel, Transfer, WhirlReport, WhirlWarningLevel};

/// State of the tool at the end of a step, with statistics over the publishing interval.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Snapshot {
    /// Model steps taken since the start.
    pub step: u64,
    /// Model time since the start (s).
    pub time: f64,
    /// Drive and load as applied after slew limits.
    pub applied: Applied,
    /// Joints, top to bottom.
    pub joints: Joints,
    /// Stations, top to bottom.
    pub contacts: Contacts,
    /// Torque, speed, load and accelerations of the bit.
    pub bit: Bit,
    /// What the bit does across the hole.
    pub steering: Steering,
    /// Forces of the supports and all others from outside.
    pub reactions: Reactions,
    /// Torque, weight and power from the surface to the bit.
    pub transfer: Transfer,
    /// Deflected lines of both pipes in the world frame.
    pub shape: Shape,
    /// Whirl at every watched station.
    pub whirl: WhirlReport,
    /// The level of the whirl warning.
    pub warning: WhirlWarningLevel,
    /// The level of lateral shock.
    pub shock: ShockLevel,
    /// Every hazard with its level and its worst location.
    pub hazards: Hazards,
    /// Ageing since the start, by joint and by station.
    pub ageing: Ageing,
    /// Counters of the solver since the start.
    pub solver: SolverCounters,
    /// Energy since the start (J).
    pub energy: Energies,
    /// Quality of the computed motion.
    pub quality: ModelQuality,
}

/// Inputs as they act on the model in this step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Applied {
    /// Speed of the top drive (rad/s).
    pub rotary_speed: f64,
    /// Angle of the top drive (rad).
    pub drive_angle: f64,
    /// Weight at the bit (N).
    pub weight_on_bit: f64,
    /// Torque of the drive on the pipe (N m), positive in the sense of the rotation.
    pub drive_torque: f64,
    /// Rate of penetration (m/s), negative when the tool is pulled back.
    pub rate_of_penetration: f64,
    /// Standpipe pressure (Pa), inside minus outside.
    pub standpipe_pressure: f64,
    /// Weight that is asked for, after the slew limit (N): at the bit, or at the kick-off with
    /// [`WeightPlace::Kickoff`](crate::tool::WeightPlace::Kickoff).
    pub weight_set: f64,
    /// Axial force on the guide at the kick-off (N), positive where it pushes down the hole; `None` where the guide is
    /// not held there.
    pub weight_at_kickoff: Option<f64>,
}

impl Applied {
    /// The four inputs.
    pub fn inputs(&self) -> Inputs {
        Inputs {
            rotary_speed: self.rotary_speed,
            weight_on_bit: self.weight_on_bit,
            rate_of_penetration: self.rate_of_penetration,
            standpipe_pressure: self.standpipe_pressure,
        }
    }
}

/// Per joint, all arrays of the same length. Forces are those of the link above on the link below, in the upper
/// link's frame.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Joints {
    /// Along the path from the kick-off (m).
    pub measured_depth: Vec<f64>,
    /// Inclination of the bore (rad).
    pub inclination: Vec<f64>,
    /// Angle between the axes of the two links (rad, >= 0).
    pub bend_angle: Vec<f64>,
    /// Toolface of the bend: direction in which the lower link turns away, from the high side (rad, clockwise looking
    /// down the hole, -pi..pi).
    pub bend_direction: Vec<f64>,
    /// Bend angle at which the stop begins (rad).
    pub limit_angle: Vec<f64>,
    /// Moment of the limit stop (N m, >= 0).
    pub stop_moment: Vec<f64>,
    /// Horizontal transverse displacement from the bore axis (m).
    pub lateral_y: Vec<f64>,
    /// Displacement towards the low side from the bore axis (m).
    pub lateral_z: Vec<f64>,
    /// Spin rate of the link below the joint (rad/s).
    pub spin_rate: Vec<f64>,
    /// Axial force, tension positive (N).
    pub axial_force: Vec<f64>,
    /// Magnitude of the shear force (N).
    pub shear_force: Vec<f64>,
    /// Torque carried through the joint (N m), positive in the drive's sense.
    pub torque: Vec<f64>,
}

/// Per station, all arrays of the same length.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Contacts {
    /// Measured depth from the kick-off (m).
    pub measured_depth: Vec<f64>,
    /// Inclination of the bore (rad).
    pub inclination: Vec<f64>,
    /// Table 2: 0 free, 1 inner, 2 outer, 3 both.
    pub state: Vec<u8>,
    /// Between pipe and guide.
    pub pipe_guide: ContactLayer,
    /// Between guide and wall.
    pub guide_wall: ContactLayer,
}

/// One gap layer, per station.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct ContactLayer {
    /// Gap (m), negative is penetration.
    pub gap: Vec<f64>,
    /// Normal force (N, >= 0).
    pub normal: Vec<f64>,
    /// Tangential friction on the inner body of the layer, in the spin's sense (N).
    pub tangential: Vec<f64>,
    /// Axial friction on the inner body of the layer, downhole positive (N).
    pub axial: Vec<f64>,
    /// Largest normal force since the last contact output (N).
    pub normal_peak: Vec<f64>,
    /// Root mean square of the normal force since the last contact output (N).
    pub normal_rms: Vec<f64>,
    /// Largest impulse of a short interval above the resting force since the last contact output (N s).
    pub shock: Vec<f64>,
}

/// The bit at one instant, with statistics since the last output.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Bit {
    /// Torque of the rock against the bit at this instant (N m), negative in reverse.
    pub torque: f64,
    /// Speed of the bit at this instant (rad/s).
    pub rotary_speed: f64,
    /// Weight on bit at this instant (N): given, or what the rock carries.
    pub weight_on_bit: f64,
    /// Mean of [`Bit::torque`] over the publishing interval (N m); at the start of an interval the instant's, as for the
    /// next two.
    pub mean_torque: f64,
    /// Mean of [`Bit::rotary_speed`] over the publishing interval (rad/s).
    pub mean_rotary_speed: f64,
    /// Mean of [`Bit::weight_on_bit`] over the publishing interval (N).
    pub mean_weight_on_bit: f64,
    /// (max - min) / (2 mean) over its window; 0 while the drive is below the gate.
    pub stick_slip_index: f64,
    /// Root mean square over the publishing interval (m/s2): spin acceleration times bit radius.
    pub tangential_acceleration: f64,
    /// Root mean square over the publishing interval (m/s2).
    pub axial_acceleration: f64,
    /// Root mean square over the publishing interval of the lateral acceleration one station above the bit, which is
    /// itself held by the hole (m/s2).
    pub lateral_acceleration: f64,
    /// Largest magnitude of the same over the publishing interval (m/s2).
    pub lateral_acceleration_peak: f64,
    /// Integral of its magnitude over the publishing interval (m/s).
    pub lateral_impulse: f64,
    /// Level that the stick-slip index has reached.
    pub stick_slip: Severity,
}

/// What the bit does across the hole: means over all steps since the alarms were last judged, a tenth of a second. Components
/// are (right, low), seen down the hole.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Steering {
    /// Time of the steps (s); 0 where there were none, and the values are those of the instant.
    pub duration: f64,
    /// Torque of the rock against the bit (N m), negative in reverse.
    pub torque: f64,
    /// Speed of the bit (rad/s).
    pub rotary_speed: f64,
    /// Weight on bit (N).
    pub weight_on_bit: f64,
    /// Force of the bit on the rock across the hole (N): minus that of both lower supports.
    pub side_force: [f64; 2],
    /// Tilt of the guide's last node against the hole (rad).
    pub tilt: [f64; 2],
    /// Length of hole that the bit has made since the run began (m), of all steps.
    pub drilled: f64,
}

/// What holds the tool at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Holder {
    /// A support of that pipe.
    Support(Body),
    /// The string above, which pulls at the guide's top along the hole.
    String,
}

/// The forces on the tool from outside, in the world frame (X horizontal in the build's direction, Y horizontal, Z
/// down). The sums of forces and [`Reactions::inertia`] and [`Reactions::damping`] balance but for
/// [`Reactions::unbalance`].
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Reactions {
    /// Per support, a node held in some directions, and last the string above where a hoist carries it: measured depth
    /// from the kick-off (m).
    pub measured_depth: Vec<f64>,
    /// Inclination of the bore there (rad).
    pub inclination: Vec<f64>,
    /// What holds the tool there.
    pub holder: Vec<Holder>,
    /// Force on the pipe (N).
    pub force: Vec<[f64; 3]>,
    /// Moment on the pipe (N m), without the torque on the top of the pipe.
    pub moment: Vec<[f64; 3]>,
    /// Torque on the top of the pipe (N m), negative in reverse: the drive's, or below a string the string's.
    pub top_torque: f64,
    /// Sum of the forces in the list (N).
    pub supports: [f64; 3],
    /// Weight of both pipes and of all masses (N).
    pub weight: [f64; 3],
    /// Sum of the wall's forces on the guide, friction included (N).
    pub wall: [f64; 3],
    /// Force of the rock on the tool (N).
    pub bit: [f64; 3],
    /// Sum of the point loads (N).
    pub loads: [f64; 3],
    /// Minus mass times acceleration, summed over the tool (N).
    pub inertia: [f64; 3],
    /// Damping of the motion as a whole (N).
    pub damping: [f64; 3],
    /// Sum of all of these: the solver's residual (N).
    pub unbalance: [f64; 3],
}

/// Lines in the world frame (X horizontal in the build's direction, Y horizontal, Z down), m.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Shape {
    /// Bore axis at each station.
    pub bore: Vec<[f64; 3]>,
    /// Station frame's z (low side) in the world, to draw displacements exaggerated; y is world Y.
    pub low_side: Vec<[f64; 3]>,
    /// Lateral displacement (y, z) of the pipe from the bore axis.
    pub pipe: Vec<[f64; 2]>,
    /// Lateral displacement (y, z) of the guide from the bore axis.
    pub guide: Vec<[f64; 2]>,
}

/// Counters since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct SolverCounters {
    /// Newton iterations of all accepted steps and sub-steps.
    pub newton_iterations: u64,
    /// Newton iterations of the last step.
    pub last_iterations: u32,
    /// Sub-steps rejected because they did not converge.
    pub rejected: u64,
    /// Steps that had to be split.
    pub halved_steps: u64,
    /// Deepest split so far (step / 2^depth).
    pub deepest_halving: u32,
    /// Steps that failed even at the smallest sub-step.
    pub failed_steps: u64,
    /// Why and where a sub-step was last rejected.
    pub last_rejection: Option<StepFailure>,
}
