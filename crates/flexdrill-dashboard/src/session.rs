//! The run's tool and limits, for the page: stations along the tool and limits of the inputs, from the configuration in
//! `twin/session`.

use serde_json::{Value, json};

use flexdrill_config::{Config, WellPlan};
use flexdrill_core::tool::{ToolDescription, WellPath, frame_along, tangent};
use flexdrill_core::units::deg_to_rad;
use flexdrill_messages::SessionInfo;

/// Longest configuration that is read (bytes): ten times that of the default tool with all its comments.
const LONGEST: usize = 256 << 10;

/// Range and slew limit of an input, in the unit of its topic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limit {
    pub min: f64,
    pub max: f64,
    /// Per second.
    pub slew: f64,
}

impl Limit {
    fn json(&self) -> Value {
        json!({"min": self.min, "max": self.max, "slew_per_s": self.slew})
    }
}

/// The bore at a station: a point of its axis and the direction of the low side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoreFrame {
    /// Position (m), in the frame of all headers.
    position: [f64; 3],
    /// Unit vector towards the low side.
    low_side: [f64; 3],
}

impl BoreFrame {
    /// Displacement of a point of the tool's shape from the axis: horizontally, and towards the low side (m).
    pub fn displacement(&self, point: [f64; 3]) -> [f64; 2] {
        let away: [f64; 3] = std::array::from_fn(|axis| point[axis] - self.position[axis]);
        let low = (0..3).map(|axis| away[axis] * self.low_side[axis]).sum();
        [away[1] - low * self.low_side[1], low]
    }
}

/// A run.
#[derive(Debug, Clone)]
pub(crate) struct Session {
    pub config_hash: String,
    /// ns since 1970.
    pub start: i64,
    /// Speed (r/min) and weight (kN).
    pub limits: [Limit; 2],
    /// The bore at each station, top to bottom.
    pub stations: Vec<BoreFrame>,
    /// Number of joints.
    pub joints: usize,
    /// Factor on displacements in the tool's shape.
    pub exaggeration: f64,
    tool: Value,
}

impl Session {
    /// The session of a message.
    ///
    /// # Errors
    /// Why this version cannot read the configuration.
    pub fn new(info: &SessionInfo) -> Result<Self, String> {
        let refused = |why: String| format!("the configuration in twin/session cannot be read: {why}");
        let length = info.configuration.len();
        if length > LONGEST {
            return Err(refused(format!("it has {length} bytes, at most {LONGEST} are read")));
        }
        let config =
            Config::from_text("twin/session", &info.configuration).map_err(|error| refused(error.to_string()))?;
        let description = config.tool();
        let stations = stations(&description);
        let (speed, weight) = (&config.inputs.rotary_speed, &config.inputs.weight_on_bit);
        let frames = stations.iter().map(|station| BoreFrame {
            position: station.position,
            low_side: frame_along(tangent(station.inclination)).column(2).into_owned().into(),
        });
        Ok(Self {
            config_hash: info.config_hash.clone(),
            start: info.start.to_nanoseconds(),
            limits: [
                Limit {
                    min: speed.min_rpm,
                    max: speed.max_rpm,
                    slew: speed.slew_rpm_per_s,
                },
                Limit {
                    min: weight.min_kn,
                    max: weight.max_kn,
                    slew: weight.slew_kn_per_s,
                },
            ],
            stations: frames.collect(),
            joints: description.links.saturating_sub(1),
            exaggeration: config.outputs.exaggeration,
            tool: tool(&config, &description, &stations),
        })
    }

    /// Both limits, as the page gets them.
    pub fn limits_json(&self) -> Value {
        json!({"rotary_speed_rpm": self.limits[0].json(), "weight_on_bit_kn": self.limits[1].json()})
    }

    /// The tool in its well, as the page gets it.
    pub fn tool_json(&self) -> &Value {
        &self.tool
    }
}

struct Station {
    /// Measured depth (m).
    depth: f64,
    /// Inclination (rad).
    inclination: f64,
    /// Position (m), in the frame of all headers.
    position: [f64; 3],
}

/// The stations of the model: evenly spaced along the bore, with the same number in each link.
fn stations(tool: &ToolDescription) -> Vec<Station> {
    let path = WellPath::new(&tool.well);
    let last = tool.links * tool.elements_per_link;
    let at = |number: usize| {
        let depth = path.length() / last as f64 * number as f64;
        Station {
            depth,
            inclination: path.inclination(depth),
            position: path.position(depth).into(),
        }
    };
    (0..=last).map(at).collect()
}

fn tool(config: &Config, tool: &ToolDescription, stations: &[Station]) -> Value {
    let joints: Vec<Value> = stations
        .iter()
        .enumerate()
        .step_by(tool.elements_per_link)
        .skip(1)
        .take(tool.links.saturating_sub(1))
        .map(|(number, station)| {
            json!({"measured_depth": station.depth, "inclination": station.inclination, "station": number})
        })
        .collect();
    let positions: Vec<Value> = stations
        .iter()
        .map(|station| {
            let position = station.position;
            json!({"measured_depth": station.depth, "inclination": station.inclination, "position": position})
        })
        .collect();
    let pipe = tool.pipe_contact_diameters.iter().copied().fold(0.0, f64::max);
    let build_radius = config.well.smallest_radius();
    json!({
        "title": config.run.title,
        "stations": positions,
        "joints": joints,
        "bit_depth": stations.last().map(|station| station.depth),
        "bore_radius": 0.5 * tool.hole_diameter,
        "guide_radius_outer": 0.5 * tool.guide_section.outer_diameter,
        "guide_radius_inner": 0.5 * tool.guide_section.inner_diameter,
        "pipe_radius_outer": 0.5 * pipe,
        "pipe_clearance": config.inner_clearance(),
        "guide_clearance": config.outer_clearance(),
        "build_radius": build_radius.is_finite().then_some(build_radius),
        "joint_limit": tool.joint.limit,
        "exaggeration": config.outputs.exaggeration,
        "plan": config.well.plan.as_ref().map(plan),
    })
}

/// The planned hole, SI. A file of stations is one of the twin's computer, of which the page has the name.
fn plan(plan: &WellPlan) -> Value {
    let stations: Vec<Value> = plan
        .stations
        .iter()
        .map(|station| {
            json!({
                "measured_depth": station.measured_depth,
                "inclination": deg_to_rad(station.inclination_deg),
                "azimuth": deg_to_rad(station.azimuth_deg),
            })
        })
        .collect();
    json!({"target": plan.target, "file": plan.file, "offset": plan.offset, "stations": stations})
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_tool_has_the_papers_stations() {
        let configuration = include_str!("../../../config/default.yaml").to_owned();
        let session = Session::new(&SessionInfo {
            configuration,
            ..SessionInfo::default()
        })
        .unwrap();
        assert_eq!((session.stations.len(), session.joints), (166, 32));
        assert_eq!((session.limits[0].max, session.limits[1].slew), (120.0, 10.0));
        let tool = session.tool_json();
        assert_eq!(tool["build_radius"], 3.2);
        assert_eq!(tool["joints"][0]["station"], 5);
        let near = |value: &Value, wanted: f64| (value.as_f64().unwrap() - wanted).abs() < 1e-9;
        assert!(
            near(&tool["bore_radius"], 0.059) && near(&tool["pipe_clearance"], 0.0085),
            "{tool}"
        );
        // A quarter circle ends as deep as its radius, and as far out.
        let end = &tool["stations"][165]["position"];
        assert!(near(&end[0], 3.2) && near(&end[2], 3.2), "{end}");
        // There, the low side is down.
        let [y, z] = session.stations[165].displacement([3.2, 0.001, 3.202]);
        assert!((y - 0.001).abs() < 1e-9 && (z - 0.002).abs() < 1e-9, "{y} {z}");
    }

    #[test]
    fn a_plan_has_its_stations_or_the_name_of_its_file() {
        let planned = |plan: &str| {
            let text = include_str!("../../../config/default.yaml");
            let configuration = text.replacen("\nwell:\n", &format!("\nwell:\n  plan: {plan}\n"), 1);
            assert_ne!(configuration, text);
            let info = SessionInfo {
                configuration,
                ..SessionInfo::default()
            };
            Session::new(&info).unwrap().tool_json()["plan"].clone()
        };
        let of = planned(
            "{stations: [{measured_depth: 0, inclination_deg: 0, azimuth_deg: 180}, \
             {measured_depth: 9, inclination_deg: 90, azimuth_deg: 180}], target: 0.3}",
        );
        let half_turn = std::f64::consts::PI;
        assert_eq!(
            of["stations"][1],
            json!({"measured_depth": 9.0, "inclination": half_turn / 2.0, "azimuth": half_turn})
        );
        assert_eq!((of["target"].as_f64(), of["file"].is_null()), (Some(0.3), true));
        assert_eq!(
            planned("{file: plan.csv}"),
            json!({"target": 0.5, "file": "plan.csv", "offset": [0.0, 0.0, 0.0], "stations": []})
        );
    }

    /// Any program on the network can publish a session.
    #[test]
    fn a_session_that_is_too_long_is_refused() {
        let long = SessionInfo {
            configuration: " ".repeat(LONGEST + 1),
            ..SessionInfo::default()
        };
        assert!(Session::new(&long).unwrap_err().contains("262145 bytes"));
    }

    #[test]
    fn a_foreign_configuration_is_refused() {
        let info = SessionInfo {
            configuration: "well: 3".to_owned(),
            ..SessionInfo::default()
        };
        assert!(Session::new(&info).unwrap_err().contains("twin/session"));
    }
}
