//! `alarms`: which of them there are, their delays, and the rules of the driller's advice.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::section::section;

section! {
    /// Alarms; `docs/alarms.md` explains each of them.
    pub struct Alarms(this) {
        /// Longest time for which an operator can shelve an alarm (s).
        longest_shelving: f64 = 3600.0, within(1.0, 86_400.0), "s", "a shift's end must not be forgotten; a day";
        /// Time after the start of the node during which an input that has never sent a sample raises no alarm (s). The
        /// status shows it as not received from the beginning.
        first_sample_within: f64 = 300.0, within(0.0, 86_400.0), "s", "a rig is connected within minutes of the twin's start; a day";
        /// The pipe whirls against the rotation.
        backward_whirl: ToolAlarm = ToolAlarm::default(), below;
        /// The pipe whirls with the rotation.
        forward_whirl: ToolAlarm = ToolAlarm::default(), below;
        /// Strong collisions of the pipes with each other or with the wall.
        shock: ToolAlarm = ToolAlarm::default(), below;
        /// The bit sticks and slips.
        stick_slip: ToolAlarm = ToolAlarm::default(), below;
        /// The stop of a joint carries more than its rated moment.
        joint_load: ToolAlarm = ToolAlarm::default(), below;
        /// The pipe bounces without a steady direction.
        chaotic_whirl: ToolAlarm = ToolAlarm::default(), below;
        /// Most of the weight at the surface does not arrive at the bit.
        weight_transfer: ToolAlarm = ToolAlarm::default(), below;
        /// Most of the torque at the surface does not arrive at the bit.
        torque_transfer: ToolAlarm = ToolAlarm::default(), below;
        /// The guide is bent beyond its rating.
        guide_preload: ToolAlarm = ToolAlarm::default(), below;
        /// Pressure compresses the pipe beyond its rating.
        pressure_folding: ToolAlarm = ToolAlarm::default(), below;
        /// The bit is stuck, and the top drive stalls at its torque limit.
        bit_stuck: ToolAlarm = ToolAlarm::default(), below;
        /// The energy errors of the steps make the motion doubtful.
        model_quality: ToolAlarm = ToolAlarm::default(), below;
        /// Speed and weight are outside the part of the map (`map.file`) in which no alarm must be expected.
        known_window: ToolAlarm = ToolAlarm { on_delay: 5.0, off_delay: 1.0, ..ToolAlarm::default() }, below;
        /// What the rig measures is beyond the band that the twin expects.
        rig_disagrees: ToolAlarm = ToolAlarm { on_delay: 10.0, off_delay: 30.0, ..ToolAlarm::default() }, below;
        /// The plan of the hole (`well.plan`) is outside the range in which plausible tools drill.
        hole_leaves_plan: ToolAlarm = ToolAlarm { on_delay: 5.0, off_delay: 10.0, ..ToolAlarm::default() }, below;
        /// Friction rises towards where the largest pull (`string.largest_pull_kn`) no longer reaches the bit.
        friction_near_stuck: ToolAlarm = ToolAlarm { on_delay: 30.0, off_delay: 30.0, ..ToolAlarm::default() }, below;
        /// A client has changed values that alarms depend on, and the twin differs from its configuration.
        changed_parameters: ToolAlarm = ToolAlarm { off_delay: 1.0, ..ToolAlarm::default() }, below;
        /// The rotary speed is not received, refused or stale.
        rotary_speed_input: NodeAlarm = NodeAlarm::default(), below;
        /// The weight on bit is not received, refused or stale.
        weight_on_bit_input: NodeAlarm = NodeAlarm::default(), below;
        /// The rate of penetration was sent, and is refused or stale.
        rate_of_penetration_input: NodeAlarm = NodeAlarm::default(), below;
        /// The standpipe pressure was sent, and is refused or stale.
        standpipe_pressure_input: NodeAlarm = NodeAlarm::default(), below;
        /// More than one publisher sends an input.
        two_drivers: NodeAlarm = NodeAlarm::default(), below;
        /// The computer is too slow for the model.
        real_time: NodeAlarm = NodeAlarm::default(), below;
        /// A step failed, and the model stands still.
        solver: NodeAlarm = NodeAlarm::default(), below;
        /// The recording stopped or lost messages.
        recording: NodeAlarm = NodeAlarm::default(), below;
        /// DDS was restarted.
        network: NodeAlarm = NodeAlarm { on_delay: 0.0, ..NodeAlarm::default() }, below;
        /// Limits that the driller is advised to bring the speed and the weight on bit to.
        advice: AdviceTable = AdviceTable::default();
    }
}

section! {
    /// An alarm of the tool's motion or of the model quality, in model time.
    #[derive(Copy)]
    pub struct ToolAlarm(this) {
        /// `false` takes the alarm out of service: it is listed but never annunciates. Default true.
        in_service: bool = true;
        /// Time for which a level must stand before the alarm annunciates (s).
        on_delay: f64 = 0.0, within(0.0, 600.0), "s", "levels have their own duration; longer would call too late";
        /// Time for which it must be absent before the alarm returns to normal (s).
        off_delay: f64 = 30.0, within(0.0, 600.0), "s", "motion that comes and goes within it is one alarm; longer says nothing of now";
    }
}

section! {
    /// An alarm of the node, in time on the rig's clock.
    #[derive(Copy)]
    pub struct NodeAlarm(this) {
        /// `false` takes the alarm out of service: it is listed but never annunciates. Default true.
        in_service: bool = true;
        /// Time for which the condition must stand before the alarm annunciates (s).
        on_delay: f64 = 2.0, within(0.0, 600.0), "s", "a moment's lateness is nothing to act on";
        /// Time for which it must be absent before the alarm returns to normal (s).
        off_delay: f64 = 5.0, within(0.0, 600.0), "s", "longer says nothing of now";
    }
}

/// One rule per alarm of the tool. A rule in the file replaces the default rule of its alarm as a whole. Each default
/// rule was followed in runs in which it ended its alarm and raised no alarm of a higher priority; `docs/alarms.md`
/// lists these runs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AdviceTable {
    /// Rule against backward whirl. Default: below 80 r/min.
    pub backward_whirl: Advice,
    /// Rule against forward whirl. Default: below 60 r/min.
    pub forward_whirl: Advice,
    /// Rule against shock. Default: below 20 kN.
    pub shock: Advice,
    /// Rule against stick-slip. Default: below 8 kN, then above 55 r/min.
    pub stick_slip: Advice,
    /// Rule against overload of the joints. Default: below 40 kN.
    pub joint_load: Advice,
    /// Rule against chaotic whirl. Default: below 50 r/min.
    pub chaotic_whirl: Advice,
    /// Rule against weight that does not arrive. Default: none; the alarm has its own action.
    pub weight_transfer: Advice,
    /// Rule against torque that does not arrive. Default: none; the alarm has its own action.
    pub torque_transfer: Advice,
    /// Rule against a guide bent beyond its rating. Default: none; the alarm has its own action.
    pub guide_preload: Advice,
    /// Rule against folding under pressure. Default: none; the alarm has its own action.
    pub pressure_folding: Advice,
    /// Rule against a stuck bit. Default: none; the alarm has its own action.
    pub bit_stuck: Advice,
}

impl Default for AdviceTable {
    fn default() -> Self {
        Self {
            backward_whirl: Advice::lower(Some(80.0), None),
            forward_whirl: Advice::lower(Some(60.0), None),
            shock: Advice::lower(None, Some(20.0)),
            stick_slip: Advice {
                raise_rotary_speed_rpm: Some(55.0),
                ..Advice::lower(None, Some(8.0))
            },
            joint_load: Advice::lower(None, Some(40.0)),
            chaotic_whirl: Advice::lower(Some(50.0), None),
            weight_transfer: Advice::default(),
            torque_transfer: Advice::default(),
            guide_preload: Advice::default(),
            pressure_folding: Advice::default(),
            bit_stuck: Advice::default(),
        }
    }
}

/// Of a speed (r/min) and of a weight (kN).
const TARGET: Bound = Bound::within(0.0, 1000.0);

/// The limits of a rule. The twin advises on one limit at a time: the first, in the order lower speed, lower weight,
/// raise speed, raise weight, that changes the present inputs within their limits and agrees with the rules of the
/// other standing alarms.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Advice {
    /// Bring the weight on bit below this value (kN).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = TARGET.in_schema())]
    pub lower_weight_on_bit_kn: Option<f64>,
    /// Bring the weight on bit above this value (kN).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = TARGET.in_schema())]
    pub raise_weight_on_bit_kn: Option<f64>,
    /// Bring the rotary speed below this value (r/min).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = TARGET.in_schema())]
    pub lower_rotary_speed_rpm: Option<f64>,
    /// Bring the rotary speed above this value (r/min).
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = TARGET.in_schema())]
    pub raise_rotary_speed_rpm: Option<f64>,
}

impl Advice {
    const fn lower(rotary_speed_rpm: Option<f64>, weight_on_bit_kn: Option<f64>) -> Self {
        Self {
            lower_weight_on_bit_kn: weight_on_bit_kn,
            raise_weight_on_bit_kn: None,
            lower_rotary_speed_rpm: rotary_speed_rpm,
            raise_rotary_speed_rpm: None,
        }
    }

    fn check(&self, c: &mut Checker) {
        for (key, value, unit) in [
            ("lower_weight_on_bit_kn", self.lower_weight_on_bit_kn, "kN"),
            ("raise_weight_on_bit_kn", self.raise_weight_on_bit_kn, "kN"),
            ("lower_rotary_speed_rpm", self.lower_rotary_speed_rpm, "r/min"),
            ("raise_rotary_speed_rpm", self.raise_rotary_speed_rpm, "r/min"),
        ] {
            if let Some(value) = value {
                let reason = "far above any drive and any rig";
                c.number(key, value, TARGET, unit, reason);
            }
        }
    }
}

impl Alarms {
    pub(super) fn check(&self, c: &mut Checker) {
        self.check_numbers(c);
        let advice = &self.advice;
        c.below("advice", |c| {
            for (key, advice) in [
                ("backward_whirl", advice.backward_whirl),
                ("forward_whirl", advice.forward_whirl),
                ("shock", advice.shock),
                ("stick_slip", advice.stick_slip),
                ("joint_load", advice.joint_load),
                ("chaotic_whirl", advice.chaotic_whirl),
                ("weight_transfer", advice.weight_transfer),
                ("torque_transfer", advice.torque_transfer),
                ("guide_preload", advice.guide_preload),
                ("pressure_folding", advice.pressure_folding),
                ("bit_stuck", advice.bit_stuck),
            ] {
                c.below(key, |c| advice.check(c));
            }
        });
    }
}
