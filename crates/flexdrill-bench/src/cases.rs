//! The default tool and the hard cases.

use flexdrill_config::{Config, ConfigError, Model};
use serde_json::{Value, json};

/// A tool and a load that the twin must keep pace with.
pub struct BenchCase {
    /// Name in tables.
    pub name: &'static str,
    /// Weight on bit (kN).
    pub wob: f64,
    /// Rotary speed (r/min), where it is another than that of the bench.
    pub rpm: Option<f64>,
    /// What makes it of a configuration.
    pub changes: fn(&Config) -> Result<Config, ConfigError>,
}

const fn case(name: &'static str, wob: f64, changes: fn(&Config) -> Result<Config, ConfigError>) -> BenchCase {
    BenchCase {
        name,
        wob,
        rpm: None,
        changes,
    }
}

/// The paper's case, and what makes it harder: a compressed pipe, stiffer contact, a guide soft enough to lie on the
/// wall.
pub const CASES: &[BenchCase] = &[
    case("as it is, 10 kN", 10.0, |config| Ok(config.clone())),
    case("`wob_path: shared`, 30 kN", 30.0, |config| {
        config.with_value("boundary.wob_path", "shared")
    }),
    case("contact 3e7 / 5e7 N/m, 10 kN", 10.0, |config| {
        config
            .with_value("contact.inner.stiffness", 3e7)?
            .with_value("contact.outer.stiffness", 5e7)
    }),
    case("guide `bending_factor: 0.05`, 20 kN", 20.0, |config| {
        config.with_value("tool.guide.bending_factor", 0.05)
    }),
];

/// Backward whirl, the motion that alarms are for: the pipe runs round the guide and rolls where it touches, so that
/// friction at small slip turns its direction in every collision. What depends on the step is measured on [`CASES`] only,
/// whose statistics scatter less.
pub const WHIRLING: BenchCase = BenchCase {
    name: "whirling: pipe-guide friction 0.7, 120 r/min, 10 kN",
    wob: 10.0,
    rpm: Some(120.0),
    changes: |config| {
        config
            .with_value("contact.inner.friction_tangential", 0.7)?
            .with_value("contact.inner.friction_axial", 0.7)
    },
};

/// A tool below a string: as it is, with a string that rubs on the wall of an inclined hole, with worn joints, with stiffer
/// contact. The weight is that slacked off at the surface.
pub const BELOW_A_STRING: &[BenchCase] = &[
    case("as it is, 10 kN", 10.0, |config| Ok(config.clone())),
    case("string: 600 m vertical, 400 m at 60 deg; 10 kN", 10.0, |config| {
        config.with_value("string.sections", inclined())
    }),
    case("pin friction 0.2, play 0.5 deg; 10 kN", 10.0, |config| {
        config
            .with_value("tool.joint.friction", 0.2)?
            .with_value("tool.joint.play_deg", 0.5)
    }),
    case("contact 3e7 / 5e7 N/m, 10 kN", 10.0, |config| {
        config
            .with_value("contact.inner.stiffness", 3e7)?
            .with_value("contact.outer.stiffness", 5e7)
    }),
];

/// A string of 2 7/8 in drill pipe, the lower part of which lies on the wall.
pub fn inclined() -> Value {
    let pipe = |length: f64, inclination: f64| json!({"length": length, "outer_diameter": 0.0730, "inner_diameter": 0.0546, "inclination_deg": inclination});
    json!([pipe(600.0, 0.0), pipe(400.0, 60.0)])
}

/// The hard cases of a tool: those of the rig's below a string, those of the paper's otherwise.
pub fn hard(config: &Config) -> &'static [BenchCase] {
    if config.string.model == Model::Line {
        BELOW_A_STRING
    } else {
        CASES
    }
}
