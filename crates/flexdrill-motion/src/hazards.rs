//! Hazards to the tool, each with its level, its worst location and the figure that it is judged by.

use serde::{Deserialize, Serialize};

use super::Severity;
use super::drive::DriveState;
use super::episodes::ToolLocation;

flexdrill_base::listed! {
    /// A hazard that the crew can act on.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    #[repr(u8)]
    pub enum HazardKind: 1 {
        /// The pipe runs round the guide against the rotation: each link is bent several times per turn.
        BackwardWhirl = 0: "backward whirl";
        /// The pipe runs round with the rotation: one side of it rubs.
        ForwardWhirl = 1: "forward whirl";
        /// Collisions, by their impulse and number.
        Shock = 2: "lateral shock";
        /// The bit stops, or nearly, and springs forward.
        StickSlip = 3: "stick-slip";
        /// The stop of a joint carries more than the joint is rated for.
        JointLoad = 4: "joint load";
        /// The pipe bounces without direction, and its collisions take many times the power of steady drilling.
        ChaoticWhirl = 5: "chaotic whirl";
        /// Most of the weight slacked off at the surface does not arrive at the bit.
        WeightTransfer = 6: "weight transfer";
        /// Most of the torque at the surface does not arrive at the bit.
        TorqueTransfer = 7: "torque transfer";
        /// The guide is bent beyond its rating.
        GuidePreload = 8: "guide preload";
        /// Pressure in the pipe compresses the chain of links beyond its rating.
        PressureFolding = 9: "folding under pressure";
        /// The bit does not turn, and the top drive stalls at its torque limit.
        BitStuck = 10: "stuck bit";
    }
}

impl HazardKind {
    /// The name in sentences: `backward whirl`.
    pub const fn name(self) -> &'static str {
        self.row()[0]
    }
}

/// State of one hazard. While a level stands, location and figures are those of the worst instant since it was reached:
/// the present motion may already differ and contradict the level. While the level is OK they are the present ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hazard {
    /// Kind of hazard.
    pub kind: HazardKind,
    /// Its level, after duration, hysteresis and hold-off.
    pub severity: Severity,
    /// Worst location; none for the bit, and for whirl while there is no whirl.
    pub place: Option<ToolLocation>,
    /// The judged figure: bending cycles per turn of the tool, friction power (W/m), impulse (N s), stick-slip
    /// index, stop moment over its rating, collision power of the chaotic part (W/m), lost share of weight or torque,
    /// moment of the guide over its rating, effective compression of the pipe over its rating, time of a stall (s).
    pub value: f64,
    /// Threshold of the level, of WATCH while the level is OK, in the same unit.
    pub threshold: f64,
    /// Whirl rate over rotary speed at the location; NaN without whirl.
    pub whirl_ratio: f64,
    /// Whirl rate over that of rolling without slip, for backward whirl of the driven pipe; otherwise NaN.
    pub rolling_share: f64,
    /// Speed of the pipe's centre on its orbit at the location (m/s), for whirl; otherwise NaN.
    pub orbit_speed: f64,
    /// Largest impulse above the resting one in the window at the location (N s); NaN if unknown.
    pub impulse: f64,
    /// Impacts per second at the location (1/s), for whirl; otherwise NaN.
    pub impact_rate: f64,
    /// Work of the friction per second and metre at the location (W/m), for whirl; otherwise NaN.
    pub friction_power: f64,
    /// Confidence, 0 to 1, lowered by doubtful inputs; 1 for figures that are not estimates.
    pub confidence: f64,
    /// Model time at which the level was reached (s).
    pub since: f64,
    /// Model time of location and figures (s).
    pub seen: f64,
    /// Whether the condition of the level is met.
    pub hold: Hold,
    /// Least speed of the bit in the window over the mean speed of the drive, in the drive's sense, for stick-slip: below
    /// 0 the bit spins back. NaN for other hazards.
    pub least_speed: f64,
}

/// Time (s) after which the condition of a level counts as ended: a turn of the tool at 40 r/min, so that a bouncing
/// pipe does not end and begin with every turn. Assumption.
pub const ENDED_AFTER: f64 = 1.5;

/// What holds a level: its condition, or the hold-off alone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub enum Hold {
    /// The condition of the level is met, or was within [`ENDED_AFTER`]; the level may be OK.
    #[default]
    Met,
    /// The condition of a lower level only.
    Less {
        /// That level, above OK.
        severity: Severity,
        /// Model time at which the condition of the level itself was met last (s).
        since: f64,
    },
    /// No condition: the motion has ended.
    Ended {
        /// Model time at which the condition of any level was met last (s).
        at: f64,
    },
}

impl Hold {
    /// What holds a level at model time `now` (s), where the conditions of WATCH, WARNING and CRITICAL were last met at
    /// model time `met` (s).
    pub(super) fn of(severity: Severity, met: [f64; 3], now: f64) -> Self {
        Self::with_gaps(severity, met, now, |_| ENDED_AFTER)
    }

    /// The same with the time (s) after which the condition of a level counts as ended.
    pub(super) fn with_gaps(severity: Severity, met: [f64; 3], now: f64, gap: impl Fn(Severity) -> f64) -> Self {
        let levels = || {
            Severity::RAISED
                .into_iter()
                .zip(met)
                .filter(|(level, _)| *level <= severity)
        };
        let last = |(level, met): &(Severity, f64)| now - met < gap(*level);
        match (levels().next_back(), levels().rev().find(last)) {
            (Some((_, since)), Some((lower, _))) if lower < severity => Self::Less { severity: lower, since },
            (Some(_), None) => Self::Ended {
                at: levels().map(|(_, met)| met).fold(f64::NEG_INFINITY, f64::max),
            },
            _ => Self::Met,
        }
    }
}

impl Hazard {
    /// The hazard at level OK.
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
            hold: Hold::Met,
            least_speed: f64::NAN,
        }
    }
}

/// All hazards, and the state of the drive: levels rise only while it turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hazards {
    /// In the order of [`HazardKind::ALL`].
    pub list: [Hazard; HazardKind::ALL.len()],
    /// State of the drive.
    pub drive: DriveState,
}

impl Hazards {
    /// State of one hazard.
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
