//! The ranges of the search and how a point of the unit cube becomes a case.

use serde_json::json;

use flexdrill_config::{Config, ConfigError};

use flexdrill_paper::Setup;

/// How a coordinate from 0 to 1 is spread over a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly in the logarithm.
    Log,
    /// Whole numbers from the lower to the upper bound, in equal parts.
    Whole,
    /// In equal parts, one per choice.
    Choice(&'static [&'static str]),
}

/// One dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimension {
    /// Name, in the CSV's header.
    pub name: &'static str,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// Spread.
    pub scale: Scale,
    /// Why these bounds.
    pub why: &'static str,
}

const fn linear(name: &'static str, low: f64, high: f64, why: &'static str) -> Dimension {
    Dimension {
        name,
        low,
        high,
        scale: Scale::Linear,
        why,
    }
}

const fn log(name: &'static str, low: f64, high: f64, why: &'static str) -> Dimension {
    Dimension {
        name,
        low,
        high,
        scale: Scale::Log,
        why,
    }
}

const fn whole(name: &'static str, low: f64, high: f64, why: &'static str) -> Dimension {
    Dimension {
        name,
        low,
        high,
        scale: Scale::Whole,
        why,
    }
}

const fn choice(name: &'static str, choices: &'static [&'static str], why: &'static str) -> Dimension {
    Dimension {
        name,
        low: 0.0,
        high: choices.len() as f64,
        scale: Scale::Choice(choices),
        why,
    }
}

/// The space.
pub const DIMENSIONS: &[Dimension] = &[
    linear("wob_kn", 5.0, 60.0, "what a bit of 118 mm is given"),
    choice(
        "wob_path",
        &["guide", "shared"],
        "the text's path, and the pipe compressed too",
    ),
    choice(
        "joint",
        &["universal", "ball_cage", "revolute", "as_built"],
        "Eq. 13 as a limit; constant velocity; Eq. 13 as equalities, its theta 90 degrees or as built in the well",
    ),
    linear(
        "limit_deg",
        2.0,
        10.0,
        "from below the 2.7 degrees that the arc takes to far above",
    ),
    log(
        "stop_stiffness",
        2e4,
        2e6,
        "N m/rad, a tenth to ten times 4EI/l of a link",
    ),
    linear(
        "pipe_od",
        0.040,
        0.073,
        "m, what fits into the guide with a bore left for flow",
    ),
    linear("pipe_bore", 0.3, 0.7, "inner over outer diameter of the pipe"),
    linear("inner_clearance", 0.002, 0.012, "m, tight to loose"),
    linear(
        "outer_clearance",
        0.001,
        0.010,
        "m, a guide that just passes the hole of 118 mm to a loose one",
    ),
    whole(
        "links",
        20.0,
        44.0,
        "0.25 to 0.114 m long, 4.5 to 2.0 degrees each: from about 2 to 4 diameters of the pipe",
    ),
    log(
        "guide_bending",
        0.01,
        1.0,
        "plain guide to one slotted or jointed so that it enters the curve by itself",
    ),
    log("inner_stiffness", 1e6, 1e8, "N/m, 44 kN on 44 mm to 0.4 mm"),
    log(
        "outer_stiffness",
        5e6,
        5e8,
        "N/m; soft rock to E L / 2 of 30 GPa over a station's 30 mm",
    ),
    log(
        "inner_friction",
        0.02,
        0.5,
        "around; roller sleeves or full film to dry steel",
    ),
    log("inner_axial", 0.02, 0.5, "along; the paper's second coefficient"),
    linear("outer_friction", 0.1, 0.6, "mud cake to bare rock"),
    linear("phase_deg", 0.0, 180.0, "of the first cross"),
    choice(
        "phase_step_deg",
        &["90", "0"],
        "crosses turned by a quarter, or in line",
    ),
    log("beta", 1e-5, 1e-3, "s, stiffness-proportional damping"),
    choice(
        "guide_top",
        &["free", "held"],
        "whether the guide's top may turn: Table 1 does not list what the guide hangs on",
    ),
];

/// Thinnest wall of the guide (m); where the clearances leave less, the pipe is made thinner.
const WALL: f64 = 0.005;

/// Values by name.
type Values = &'static [(&'static str, f64)];

/// The first points: the values of `config/default.yaml`, with other joints where a start says so, as (name, value).
const USUAL: Values = &[
    ("wob_kn", 10.0),
    ("limit_deg", 6.0),
    ("stop_stiffness", 2e5),
    ("pipe_od", 0.063),
    ("pipe_bore", 0.508),
    ("inner_clearance", 0.0085),
    ("outer_clearance", 0.008),
    ("links", 33.0),
    ("guide_bending", 0.999),
    ("inner_stiffness", 1e7),
    ("outer_stiffness", 2e7),
    ("inner_friction", 0.2),
    ("inner_axial", 0.2),
    ("outer_friction", 0.3),
    ("beta", 1e-4),
];
/// A crooked pipe in a soft guide: the best set of an earlier search.
const CROOKED: Values = &[
    ("joint", 3.0),
    ("wob_kn", 18.8),
    ("pipe_od", 0.0703),
    ("pipe_bore", 0.656),
    ("inner_clearance", 0.0027),
    ("outer_clearance", 0.00947),
    ("guide_bending", 0.08),
    ("inner_stiffness", 2.74e7),
    ("outer_stiffness", 9.71e7),
    ("inner_friction", 0.423),
    ("inner_axial", 0.423),
    ("outer_friction", 0.195),
    ("phase_deg", 147.0),
    ("beta", 2.62e-5),
];
/// What a guide whose top cannot turn changes.
const HELD: Values = &[
    ("wob_kn", 7.0),
    ("inner_clearance", 0.002),
    ("outer_clearance", 0.001),
    ("guide_bending", 0.012),
    ("inner_stiffness", 1.95e7),
    ("outer_stiffness", 3.5e8),
    ("inner_friction", 0.33),
    ("inner_axial", 0.33),
    ("phase_deg", 118.0),
    ("beta", 9.9e-4),
    ("guide_top", 1.0),
];
/// What starts change, and of which values.
const STARTS: &[(Values, Values)] = &[
    (&[("joint", 0.0)], USUAL),
    (&[("joint", 1.0)], USUAL),
    (&[("joint", 2.0)], USUAL),
    (&[("joint", 2.0), ("phase_step_deg", 1.0)], USUAL),
    (&[("joint", 3.0)], USUAL),
    (&[("joint", 3.0), ("phase_step_deg", 1.0), ("phase_deg", 45.0)], USUAL),
    (&[], CROOKED),
    // By hand from it, one change at a time: less clearance with softer contacts, so that the guide is pressed for
    // longer; little weight, so that it leaves the wall and the pipe hangs at the top; the crosses turned until y
    // leads.
    (
        &[
            ("wob_kn", 7.5),
            ("inner_clearance", 0.00201),
            ("outer_clearance", 0.004),
            ("guide_bending", 0.05),
            ("inner_stiffness", 1.6e7),
            ("outer_stiffness", 1.8e8),
            ("phase_deg", 127.0),
            ("beta", 9.9e-4),
        ],
        CROOKED,
    ),
    // The same with hardly any friction between the pipes, so that they do not turn the guide, a stiffer guide, and the
    // crosses a little less turned.
    (
        &[
            ("wob_kn", 14.0),
            ("inner_clearance", 0.00201),
            ("outer_clearance", 0.005),
            ("guide_bending", 0.2),
            ("inner_stiffness", 1.5e7),
            ("outer_stiffness", 4.99e8),
            ("inner_friction", 0.0201),
            ("inner_axial", 0.0201),
            ("phase_deg", 95.0),
            ("beta", 9.9e-4),
        ],
        CROOKED,
    ),
    // By hand from the one before the last: the guide's top held against turning, a softer guide that fills the hole, and a
    // harder wall.
    (HELD, CROOKED),
];

/// Points to begin with.
pub fn starts() -> Vec<Vec<f64>> {
    let point = |(changes, usual): &(Values, Values)| {
        DIMENSIONS
            .iter()
            .map(|dimension| {
                let given = changes
                    .iter()
                    .chain(*usual)
                    .chain(USUAL)
                    .find(|(name, _)| *name == dimension.name);
                coordinate(dimension, given.map_or(dimension.low, |&(_, value)| value))
            })
            .collect()
    };
    STARTS.iter().map(point).collect()
}

/// Coordinate of a value; a choice by its number.
fn coordinate(dimension: &Dimension, value: f64) -> f64 {
    match dimension.scale {
        Scale::Linear => (value - dimension.low) / (dimension.high - dimension.low),
        Scale::Log => (value / dimension.low).ln() / (dimension.high / dimension.low).ln(),
        Scale::Whole => (value - dimension.low + 0.5) / (dimension.high - dimension.low + 1.0),
        Scale::Choice(choices) => (value + 0.5) / choices.len() as f64,
    }
}

/// Value of a coordinate.
pub fn value(dimension: &Dimension, at: f64) -> f64 {
    match dimension.scale {
        Scale::Linear => dimension.low + (dimension.high - dimension.low) * at,
        Scale::Log => dimension.low * (dimension.high / dimension.low).powf(at),
        Scale::Whole => (dimension.low + (at * (dimension.high - dimension.low + 1.0)).floor()).min(dimension.high),
        Scale::Choice(choices) => (at * choices.len() as f64).floor().min(choices.len() as f64 - 1.0),
    }
}

/// The value as it is written, choices by name.
pub fn written(dimension: &Dimension, at: f64) -> String {
    let value = value(dimension, at);
    match dimension.scale {
        Scale::Choice(choices) => choices[value as usize].to_owned(),
        Scale::Whole => format!("{value:.0}"),
        Scale::Linear | Scale::Log => format!("{value:.5e}"),
    }
}

/// The case at a point of the unit cube, on the mesh of `base`.
///
/// # Errors
/// When a value is refused.
pub fn case(base: &Config, point: &[f64]) -> Result<Setup, ConfigError> {
    let at = |name: &str| DIMENSIONS.iter().position(|d| d.name == name).unwrap_or_default();
    let number = |name: &str| value(&DIMENSIONS[at(name)], point[at(name)]);
    let word = |name: &str| written(&DIMENSIONS[at(name)], point[at(name)]);
    // Diameters depend on each other: the guide follows from the hole, and the pipe must fit into the guide with its
    // wall.
    let hole = base.well.hole_diameter;
    let guide_od = hole - 2.0 * number("outer_clearance");
    let most = guide_od - 2.0 * WALL - 2.0 * number("inner_clearance");
    let pipe_od = number("pipe_od").min(most);
    let numbers = [
        ("tool.joint.limit_deg", number("limit_deg")),
        ("tool.joint.stop_stiffness", number("stop_stiffness")),
        ("tool.joint.cross_phase_deg", number("phase_deg")),
        (
            "tool.joint.cross_phase_step_deg",
            if word("phase_step_deg") == "90" { 90.0 } else { 0.0 },
        ),
        ("tool.pipe.outer_diameter", pipe_od),
        ("tool.pipe.inner_diameter", pipe_od * number("pipe_bore")),
        ("tool.guide.outer_diameter", guide_od),
        ("tool.guide.inner_diameter", pipe_od + 2.0 * number("inner_clearance")),
        ("tool.guide.bending_factor", number("guide_bending")),
        ("tool.damping.beta", number("beta")),
        ("contact.inner.stiffness", number("inner_stiffness")),
        ("contact.outer.stiffness", number("outer_stiffness")),
        ("contact.inner.friction_tangential", number("inner_friction")),
        ("contact.inner.friction_axial", number("inner_axial")),
        ("contact.outer.friction_tangential", number("outer_friction")),
        ("contact.outer.friction_axial", number("outer_friction")),
    ];
    // `as_built` is a revolute joint whose hinge keeps its angle in the curved tool.
    let (kind, hinge) = match word("joint").as_str() {
        "as_built" => ("revolute".to_owned(), "as_built"),
        kind => (kind.to_owned(), "straight"),
    };
    let words = [
        ("tool.joint.kind", kind),
        ("tool.joint.hinge_angle", hinge.to_owned()),
        ("boundary.wob_path", word("wob_path")),
    ];
    let values = numbers
        .into_iter()
        .map(|(key, value)| (key, json!(value)))
        .chain(words.into_iter().map(|(key, value)| (key, json!(value))))
        .chain([
            ("tool.links", json!(number("links") as u64)),
            ("boundary.supports", supports(&word("guide_top"))),
        ]);
    // Checked as a whole: combinations that no tool can have are refused here.
    let mut case = Setup::new(base.with_values("parameter", values)?);
    case.weight_on_bit_kn = number("wob_kn");
    case.settling_turns = 1.0;
    case.impatient = true;
    Ok(case)
}

/// Supports in addition to those of Table 1.
fn supports(guide_top: &str) -> serde_json::Value {
    match guide_top {
        "held" => json!([{"at": "top", "body": "guide", "fix": ["psi"]}]),
        _ => json!([]),
    }
}
