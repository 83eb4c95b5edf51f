//! The runs of `docs/physics.md`, each with the keys that it changes.

/// 1000 m of 2 7/8 in drill pipe in a vertical hole.
const SECTIONS: &str = r#"string.sections=[{"length": 1000.0, "outer_diameter": 0.0730, "inner_diameter": 0.0546}]"#;
/// The string with a drive that takes up its waves.
const STRING: [&str; 5] = [
    SECTIONS,
    "string.top_drive.tuning=soft_torque",
    "string.top_drive.inertia=50",
    "string.top_drive.torque_limit=5000",
    "string.model=line",
];

/// A run.
pub(super) struct Case {
    /// In legends and in the table.
    pub name: &'static str,
    pub changes: &'static [&'static str],
    /// r/min.
    pub rpm: f64,
    /// m/h.
    pub rate_of_penetration: f64,
}

const fn case(name: &'static str, changes: &'static [&'static str]) -> Case {
    Case {
        name,
        changes,
        rpm: 40.0,
        rate_of_penetration: 0.0,
    }
}

/// The runs, in the order of the table.
pub(super) const CASES: [Case; 18] = [
    case("paper's tool", &[]),
    case(
        "string, soft torque",
        &[STRING[0], STRING[1], STRING[2], STRING[3], STRING[4]],
    ),
    case("string, stiff drive", &[SECTIONS, "string.model=line"]),
    case("weakening rock", &["rock.law=weakening", "rock.weakening.ratio=2"]),
    case(
        "string and depth of cut",
        &[
            STRING[0],
            STRING[1],
            STRING[2],
            STRING[3],
            STRING[4],
            "rock.law=depth_of_cut",
        ],
    ),
    case("vector inside", &["contact.inner.friction=vector"]),
    Case {
        name: "advance of 3 m/h",
        changes: &["contact.outer.friction=bristle"],
        rpm: 40.0,
        rate_of_penetration: 3.0,
    },
    Case {
        name: "advance of 3 m/h, 0 r/min",
        changes: &["contact.outer.friction=bristle"],
        rpm: 0.0,
        rate_of_penetration: 3.0,
    },
    case("soft guide, as built", &["tool.guide.bending_factor=0.05"]),
    case(
        "soft guide, straight as made",
        &["tool.guide.bending_factor=0.05", "tool.guide.free_curvature=0"],
    ),
    case(
        "5 MPa, closed end",
        &[r#"environment.pressure={"at_top": 5e6, "end": "closed", "joint_seal_diameter": 0.062}"#],
    ),
    case(
        "5 MPa, seal of 63 mm",
        &[
            r#"environment.pressure={"at_top": 5e6, "end": "sealed", "seal_diameter": 0.063, "joint_seal_diameter": 0.062}"#,
        ],
    ),
    case("pins with friction 0.1", &["tool.joint.friction=0.1"]),
    case("pins with friction 0.3", &["tool.joint.friction=0.3"]),
    case("play of 0.3 deg", &["tool.joint.play_deg=0.3"]),
    case(
        "mud, ideal fluid",
        &[r#"environment.mud={"viscosity": 0, "damping": "none"}"#],
    ),
    case("mud of 20 mPa s", &[r#"environment.mud={"viscosity": 0.02}"#]),
    case("shortening", &["tool.shortening=second_order"]),
];

/// Numbers in [`CASES`].
pub(super) mod number {
    pub const PAPER: usize = 0;
    pub const SOFT_TORQUE: usize = 1;
    pub const STIFF: usize = 2;
    pub const WEAKENING: usize = 3;
    pub const DEPTH_OF_CUT: usize = 4;
    pub const ADVANCE: usize = 6;
    pub const SLIDING: usize = 7;
    pub const AS_BUILT: usize = 8;
    pub const STRAIGHT: usize = 9;
    pub const CLOSED: usize = 10;
    pub const SEALED: usize = 11;
    pub const PINS: usize = 12;
    pub const WORN_PINS: usize = 13;
    pub const PLAY: usize = 14;
    pub const MUD: usize = 16;
    pub const SHORTENING: usize = 17;
}
