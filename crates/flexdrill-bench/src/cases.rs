//! The default tool and the hard cases.

use flexdrill_config::{Config, ConfigError};

/// A tool and a load that the twin must keep pace with.
pub struct Case {
    /// Name in tables.
    pub name: &'static str,
    /// Weight on bit (kN).
    pub wob: f64,
    /// Rotary speed (r/min), where it is another than that of the bench.
    pub rpm: Option<f64>,
    /// What makes it of a configuration.
    pub changes: fn(&Config) -> Result<Config, ConfigError>,
}

/// The paper's case, and what makes it harder: a compressed pipe, stiffer contact, a guide soft enough to lie on the
/// wall.
pub const CASES: &[Case] = &[
    Case {
        name: "as it is, 10 kN",
        wob: 10.0,
        rpm: None,
        changes: |config| Ok(config.clone()),
    },
    Case {
        name: "`wob_path: shared`, 30 kN",
        wob: 30.0,
        rpm: None,
        changes: |config| config.with_value("boundary.wob_path", "shared"),
    },
    Case {
        name: "contact 3e7 / 5e7 N/m, 10 kN",
        wob: 10.0,
        rpm: None,
        changes: |config| {
            config
                .with_value("contact.inner.stiffness", 3e7)?
                .with_value("contact.outer.stiffness", 5e7)
        },
    },
    Case {
        name: "guide `bending_factor: 0.05`, 20 kN",
        wob: 20.0,
        rpm: None,
        changes: |config| config.with_value("tool.guide.bending_factor", 0.05),
    },
];

/// Backward whirl, the motion that alarms are for: the pipe is thrown round the guide and rolls where it touches, so that
/// friction at small slip turns its direction in every collision. What depends on the step is measured on [`CASES`] only,
/// whose statistics scatter less.
pub const WHIRLING: Case = Case {
    name: "whirling: pipe-guide friction 0.7, 120 r/min, 10 kN",
    wob: 10.0,
    rpm: Some(120.0),
    changes: |config| {
        config
            .with_value("contact.inner.friction_tangential", 0.7)?
            .with_value("contact.inner.friction_axial", 0.7)
    },
};
