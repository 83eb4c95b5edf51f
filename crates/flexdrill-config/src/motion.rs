//! The part of a configuration that determines the tool's motion and the alarms called by it.

use serde_json::{Map, Value};

use super::string::Model;
use super::{Config, keys, sha256};

/// Sections that determine the motion or its levels.
const SECTIONS: &[&str] = &[
    "well",
    "tool",
    "contact",
    "environment",
    "boundary",
    "rock",
    "string",
    "loads",
    "masses",
    "start",
    "initial",
    "solver",
    "whirl",
    "stick_slip",
    "shock",
    "joint_load",
    "chaotic_whirl",
    "transfer",
    "guide_preload",
    "pressure_folding",
];

/// Sections that say which tool in which hole it is: those of the mechanics, without its start, its steps, and the
/// thresholds of alarms.
const TOOL: &[&str] = &[
    "well",
    "tool",
    "contact",
    "environment",
    "boundary",
    "rock",
    "string",
    "loads",
    "masses",
];

/// Alarms of the motion: their delays and whether they are in service.
const ALARMS: &[&str] = &[
    "backward_whirl",
    "forward_whirl",
    "shock",
    "stick_slip",
    "joint_load",
    "chaotic_whirl",
    "weight_transfer",
    "torque_transfer",
    "guide_preload",
    "pressure_folding",
    "bit_stuck",
    "model_quality",
];

/// Longest off-delay (s) in a run that is judged: how long an alarm is held for an operator changes nothing of what a run
/// finds.
pub const PROMPT_OFF_DELAY: f64 = 1.0;

impl Config {
    /// SHA-256, in hex, over what determines the tool's motion and the alarms called by it. Title, inputs, network,
    /// outputs, look-ahead, advice and the alarms of the node are left out: a result that was computed for one
    /// configuration holds for every other of the same motion.
    pub fn motion_hash(&self) -> String {
        // The tree has the keys as the file has them, defaults included, so
        // that a default that is written out changes nothing.
        let tree = self.to_tree();
        // Sections are chosen and not removed, so that a new section is not part of the motion before it is listed.
        let mut motion = chosen(&tree, SECTIONS);
        let mut alarms = tree
            .get("alarms")
            .map(|alarms| chosen(alarms, ALARMS))
            .unwrap_or_default();
        // An off-delay holds an alarm for the operator. Runs are judged with
        // at most this one, so longer ones give the same result.
        for alarm in alarms.values_mut() {
            if let Some(delay) = alarm.get_mut("off_delay") {
                *delay = Value::from(delay.as_f64().unwrap_or_default().min(PROMPT_OFF_DELAY));
            }
        }
        motion.insert("alarms".to_owned(), Value::Object(alarms));
        // What changes nothing is left out, and a file without it has the hash that it had before the keys existed.
        if self.contact.wall_friction_factors.are_one()
            && let Some(contact) = motion.get_mut("contact").and_then(Value::as_object_mut)
        {
            contact.remove("wall_friction_factors");
        }
        self.leave_out_idle_of_guide(&mut motion);
        leave_out_what_only_judges(&mut motion);
        // Without a string there is no drive that could stall, and no hoist that is asked for a weight.
        if self.string.model != Model::Line {
            for (section, key) in [
                ("transfer", "stalled"),
                ("transfer", "weight_short"),
                ("alarms", "bit_stuck"),
            ] {
                if let Some(section) = motion.get_mut(section).and_then(Value::as_object_mut) {
                    section.remove(key);
                }
            }
        }
        // The factor of the calibration acts on the motion, although its section does not as a whole.
        let factor = self.calibration.friction_factor;
        if factor != 1.0 {
            motion.insert("friction_factor".to_owned(), Value::from(factor));
        }
        // As for `hash`: plain numbers, strings and lists can be serialised.
        sha256(&serde_json::to_vec(&motion).unwrap_or_default())
    }

    /// SHA-256, in hex, over what says which tool in which hole it is, without the keys `fitted` (dotted paths) whose
    /// values were found by a calibration. A sample of these keys holds for every configuration of the same hash: also for
    /// one that has their fitted values, another start, another step, or other thresholds.
    pub fn tool_hash<'a>(&self, fitted: impl IntoIterator<Item = &'a str>) -> String {
        let mut tree = self.to_tree();
        let mut factor = self.calibration.friction_factor;
        for key in fitted {
            if key == "calibration.friction_factor" {
                factor = 1.0;
            }
            let (parent, name) = keys::parent(key);
            match tree.pointer_mut(&parent) {
                Some(Value::Object(section)) => {
                    section.remove(name);
                }
                // An item keeps its place, so that the others remain where they are.
                Some(Value::Array(items)) => {
                    if let Some(item) = name.parse().ok().and_then(|place: usize| items.get_mut(place)) {
                        *item = Value::Null;
                    }
                }
                _ => {}
            }
        }
        let mut tool = chosen(&tree, TOOL);
        // As in the motion, what changes nothing is left out: a key that is new in a version keeps the hash of a tool.
        if let Some(contact) = tool.get_mut("contact").and_then(Value::as_object_mut) {
            let factors = contact.get("wall_friction_factors").and_then(Value::as_object);
            if factors.is_some_and(|factors| factors.values().all(|factor| factor.as_f64() == Some(1.0))) {
                contact.remove("wall_friction_factors");
            }
        }
        self.leave_out_idle_of_guide(&mut tool);
        leave_out_what_only_judges(&mut tool);
        if factor != 1.0 {
            tool.insert("friction_factor".to_owned(), Value::from(factor));
        }
        sha256(&serde_json::to_vec(&tool).unwrap_or_default())
    }

    /// Removes the keys of a guide whose slots do not close, and whose spine is on its axis.
    fn leave_out_idle_of_guide(&self, sections: &mut Map<String, Value>) {
        let of_tool = &self.tool.guide;
        if let Some(guide) = sections.get_mut("tool").and_then(|tool| tool.get_mut("guide"))
            && let Some(guide) = guide.as_object_mut()
        {
            if !of_tool.closes_slots() {
                guide.remove("slots_close_at");
            }
            if !of_tool.has_spine_off_axis() {
                guide.retain(|key, _| !SPINE.contains(&key.as_str()));
            }
        }
    }
}

/// Keys of a guide's spine.
const SPINE: [&str; 2] = ["spine_offset", "spine_toolface_deg"];

/// Keys of the bit that only `flexdrill ahead` reads.
const HOLE_AHEAD: [&str; 4] = [
    "lateral_resistance",
    "lateral_resistance_range",
    "walk_angle_deg",
    "axis",
];

/// Keys of the well that only the hole ahead reads: the plan, and what surveys count from.
const OF_THE_HOLE: [&str; 3] = ["plan", "drilled_from", "kick_off_depth"];

/// Keys of the joints that only say how their life is judged.
const LIFE: [&str; 2] = ["serial_numbers", "life"];

/// Removes what acts on no motion: the keys of bit and well for the hole ahead, and the life of the joints.
fn leave_out_what_only_judges(sections: &mut Map<String, Value>) {
    if let Some(well) = sections.get_mut("well").and_then(Value::as_object_mut) {
        well.retain(|key, _| !OF_THE_HOLE.contains(&key.as_str()));
    }
    for (part, keys) in [("bit", &HOLE_AHEAD[..]), ("joint", &LIFE[..])] {
        if let Some(tool) = sections.get_mut("tool")
            && let Some(part) = tool.get_mut(part).and_then(Value::as_object_mut)
        {
            part.retain(|key, _| !keys.contains(&key.as_str()));
        }
    }
}

/// The keys of a section that are there.
fn chosen(value: &Value, keys: &[&str]) -> Map<String, Value> {
    let present = keys
        .iter()
        .filter_map(|key| Some(((*key).to_owned(), value.get(key)?.clone())));
    present.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sections that change neither the motion nor its levels, but for the factor of friction in `calibration`.
    const OTHERS: &[&str] = &[
        "run",
        "inputs",
        "network",
        "alarms",
        "calibration",
        "look_ahead",
        "map",
        "outputs",
        "uncertainty",
        "ensemble",
    ];

    fn config() -> Config {
        Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/coarse.yaml")).unwrap()
    }

    #[test]
    fn every_section_is_in_one_of_the_two_lists() {
        let tree = config().to_tree();
        for section in tree.as_object().unwrap().keys() {
            let known = SECTIONS.contains(&section.as_str()) || OTHERS.contains(&section.as_str());
            assert!(
                known,
                "does `{section}` determine the motion? Add it to SECTIONS or to OTHERS"
            );
        }
        for section in SECTIONS {
            assert!(tree.get(section).is_some(), "{section}");
        }
        for alarm in ALARMS {
            assert!(tree["alarms"].get(alarm).is_some(), "{alarm}");
        }
    }

    /// A map of an earlier build remains one of the same tool: the hash is that of version 0.2.0 at 7dee8f8. A key that is
    /// new and changes nothing by default is to be left out; a law that changes the motion changes this hash.
    #[test]
    fn regress_hash_of_an_earlier_build() {
        let small = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/small.yaml")).unwrap();
        let earlier = "771ef34e5e48d05dd3de23b72b2edf58cd0c021b95e134f3bf7b90ba034f7960";
        assert_eq!(small.motion_hash(), earlier);
        let soft = small.with_value("tool.guide.bending_factor", 0.5).unwrap();
        let closing = soft.with_value("tool.guide.slots_close_at", 0.4).unwrap();
        assert_ne!(closing.motion_hash(), soft.motion_hash());
        let bending = soft.with_value("tool.guide.spine_offset", 0.02).unwrap();
        assert_ne!(bending.motion_hash(), soft.motion_hash());
    }

    #[test]
    fn the_tool_changes_it_and_the_outputs_do_not() {
        let config = config();
        let other = |key: &str, value: Value| config.with_value(key, value).unwrap();
        let hash = config.motion_hash();
        assert_eq!(hash.len(), 64);
        for (key, value) in [
            ("run.title", Value::from("another")),
            ("inputs.rotary_speed.max_rpm", Value::from(100.0)),
            ("alarms.longest_shelving", Value::from(60.0)),
            ("calibration.follow", Value::from(true)),
            ("tool.bit.lateral_resistance", Value::from(30.0)),
            ("tool.bit.lateral_resistance_range", Value::from(vec![6.0, 90.0])),
            ("tool.bit.walk_angle_deg", Value::from(-5.0)),
            ("tool.bit.axis", Value::from("link")),
        ] {
            assert_eq!(other(key, value).motion_hash(), hash, "{key}");
        }
        for (key, value) in [
            ("well.hole_diameter", Value::from(0.12)),
            ("contact.inner.friction_tangential", Value::from(0.31)),
            ("calibration.friction_factor", Value::from(1.1)),
            ("contact.wall_friction_factors.arc", Value::from(1.1)),
            ("alarms.shock.on_delay", Value::from(3.0)),
            ("stick_slip.gate_speed_rpm", Value::from(12.0)),
        ] {
            assert_ne!(other(key, value).motion_hash(), hash, "{key}");
        }
        let planned = {
            let mut schema = (*config).clone();
            schema.well.plan = Some(serde_json::from_str(r#"{"file": "plan.csv"}"#).unwrap());
            (schema.well.drilled_from, schema.well.kick_off_depth) = (Some(1.0), 2000.0);
            Config::from_schema("planned", schema).unwrap()
        };
        assert_eq!(planned.motion_hash(), hash);
        assert_eq!(planned.tool_hash([]), config.tool_hash([]));
        assert_ne!(planned.hash(), config.hash());
        // A drive stalls below a string only.
        let stalled = |config: &Config| config.with_value("transfer.stalled.watch", Value::from(3.0)).unwrap();
        assert_eq!(stalled(&config).motion_hash(), hash);
        let rig = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        assert_ne!(stalled(&rig).motion_hash(), rig.motion_hash());
    }

    #[test]
    fn a_tool_remains_the_same_whatever_a_calibration_found() {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        let fitted = [
            "contact.inner.friction_tangential",
            "contact.wall_friction_factors.arc",
            "calibration.torque_tare_nm",
        ];
        let hash = |config: &Config| config.tool_hash(fitted);
        let own = hash(&config);
        for (key, value) in [
            (fitted[0], Value::from(0.31)),
            (fitted[1], Value::from(1.2)),
            (fitted[2], Value::from(12.0)),
            ("solver.time_step", Value::from(1e-4)),
            ("alarms.shock.on_delay", Value::from(3.0)),
            ("run.title", Value::from("another")),
            ("tool.bit.lateral_resistance", Value::from(30.0)),
        ] {
            assert_eq!(hash(&config.with_value(key, value).unwrap()), own, "{key}");
        }
        for (key, value) in [
            ("contact.inner.friction_axial", Value::from(0.31)),
            ("contact.wall_friction_factors.before_arc", Value::from(1.2)),
            ("well.hole_diameter", Value::from(0.1185)),
            ("calibration.friction_factor", Value::from(1.1)),
        ] {
            assert_ne!(hash(&config.with_value(key, value).unwrap()), own, "{key}");
        }
        assert_ne!(config.tool_hash([]), own);
    }
}
