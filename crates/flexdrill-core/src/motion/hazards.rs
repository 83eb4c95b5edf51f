//! What endangers the tool, one by one: how bad it is, where it is worst, and by which figure.

use serde::{Deserialize, Serialize};

use super::Severity;
use super::drive::DriveState;
use super::episodes::ToolLocation;

/// A danger that an operator can do something about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum HazardKind {
    /// The pipe goes round the guide against the rotation: each link is bent several times per turn.
    BackwardWhirl = 0,
    /// The pipe goes round with the rotation: one side of it rubs.
    ForwardWhirl = 1,
    /// Collisions, by their impulse and number.
    Shock = 2,
    /// The bit stops, or nearly, and springs forward.
    StickSlip = 3,
    /// The stop of a joint carries more than the joint is rated for.
    JointLoad = 4,
    /// The pipe is thrown about without direction, and its collisions take many times the power of steady drilling.
    ChaoticWhirl = 5,
}

impl HazardKind {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::BackwardWhirl,
        Self::ForwardWhirl,
        Self::Shock,
        Self::StickSlip,
        Self::JointLoad,
        Self::ChaoticWhirl,
    ];

    /// As in sentences: `backward whirl`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BackwardWhirl => "backward whirl",
            Self::ForwardWhirl => "forward whirl",
            Self::Shock => "lateral shock",
            Self::StickSlip => "stick-slip",
            Self::JointLoad => "joint load",
            Self::ChaoticWhirl => "chaotic whirl",
        }
    }
}

/// How one danger stands. While a level stands, place and figures are those of its worst moment since it was reached:
/// the motion of the present instant may be another one already, and would say the opposite of the level. While all is
/// well they are those of the present.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hazard {
    /// Which one.
    pub kind: HazardKind,
    /// Its level, with duration, hysteresis and hold-off in it.
    pub severity: Severity,
    /// Where it is worst; none for the bit, and for whirl while there is none.
    pub place: Option<ToolLocation>,
    /// What it is judged by: bending cycles per turn of the tool, friction power (W/m), impulse (N s), stick-slip
    /// index, stop moment over its rating, collision power of the chaotic part (W/m).
    pub value: f64,
    /// Threshold of the level reached, or of the first one while all is well, in the same unit.
    pub threshold: f64,
    /// Whirl rate over rotary speed at the place; NaN where there is none.
    pub whirl_ratio: f64,
    /// Whirl rate over that of rolling without slip, for backward whirl of the driven pipe; NaN elsewhere.
    pub rolling_share: f64,
    /// Speed of the pipe's centre on its orbit at the place (m/s), for whirl; NaN elsewhere.
    pub orbit_speed: f64,
    /// Largest impulse above the resting one in the window at the place (N s); NaN where it is not known.
    pub impulse: f64,
    /// Impacts per second at the place (1/s), for whirl; NaN elsewhere.
    pub impact_rate: f64,
    /// Work of the friction per second and metre at the place (W/m), for whirl; NaN elsewhere.
    pub friction_power: f64,
    /// 0 to 1, lowered by doubtful inputs; 1 where nothing is estimated.
    pub confidence: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Model time of place and figures (s).
    pub seen: f64,
    /// Model time at which the condition of the level was last met (s), once that is [`ENDED_AFTER`] ago: the level is
    /// only held. None while the condition is met, and while all is well.
    pub ended: Option<f64>,
}

/// Time without its condition after which what holds a level counts as ended (s): a turn of the tool at 40 r/min, so
/// that a pipe that bounces does not end and begin with every turn. Assumption.
pub const ENDED_AFTER: f64 = 1.5;

/// When the condition of a level ended: `met` is when it was met last, `now` the present (both model time, s).
pub(crate) fn ended(severity: Severity, met: f64, now: f64) -> Option<f64> {
    (severity > Severity::Ok && now - met >= ENDED_AFTER).then_some(met)
}

impl Hazard {
    /// Nothing to say of it.
    pub fn calm(kind: HazardKind) -> Self {
        Self {
            kind,
            severity: Severity::Ok,
            place: None,
            value: 0.0,
            threshold: f64::NAN,
            whirl_ratio: f64::NAN,
            rolling_share: f64::NAN,
            orbit_speed: f64::NAN,
            impulse: f64::NAN,
            impact_rate: f64::NAN,
            friction_power: f64::NAN,
            confidence: 1.0,
            since: 0.0,
            seen: 0.0,
            ended: None,
        }
    }
}

/// All dangers, and whether the drive turns: while it does not, no level rises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hazards {
    /// In the order of [`HazardKind::ALL`].
    pub list: [Hazard; HazardKind::ALL.len()],
    /// What the drive does.
    pub drive: DriveState,
}

impl Hazards {
    /// How one danger stands.
    pub fn of(&self, kind: HazardKind) -> &Hazard {
        &self.list[kind as usize]
    }
}

impl Default for Hazards {
    fn default() -> Self {
        Self {
            list: HazardKind::ALL.map(Hazard::calm),
            drive: DriveState::default(),
        }
    }
}
