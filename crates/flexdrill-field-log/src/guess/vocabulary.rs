//! The words of recorders, logs and people for the quantities that the twin reads, and for those that are easily taken for
//! them.

use super::Quantity;

/// Words for a quantity: the names that are enough, and the words that may stand with them.
pub(super) struct Words {
    pub(super) quantity: Quantity,
    /// Each entry is a set of words that must all be in the name.
    pub(super) names: &'static [&'static [&'static str]],
    /// Words that do not change the meaning.
    pub(super) with: &'static [&'static str],
}

/// Words that say no more than that a sensor at the surface measured it.
pub(super) const PLAIN: &[&str] = &[
    "avg", "average", "act", "actual", "surface", "surf", "measured", "value", "rig", "the",
];

// WITS level 0 has the mnemonics of four letters, Energistics' WITSML the whole words; the others are those of recorders.
pub(super) const QUANTITIES: &[Words] = &[
    Words {
        quantity: Quantity::RotarySpeed,
        names: &[
            &["rpm"],
            &["rpma"],
            &["rotary", "speed"],
            &["rotation", "speed"],
            &["drive", "speed"],
            &["rot", "speed"],
        ],
        with: &[
            "rotary", "rotation", "rot", "table", "top", "drive", "td", "tds", "string", "drill", "pipe", "speed",
            "rpm",
        ],
    },
    Words {
        quantity: Quantity::WeightOnBit,
        names: &[&["wob"], &["woba"], &["weight", "on", "bit"], &["bit", "weight"]],
        with: &["weight", "on", "bit", "wob"],
    },
    Words {
        quantity: Quantity::HookLoad,
        names: &[&["hookload"], &["hook", "load"], &["hkld"], &["hkl"], &["hkla"]],
        with: &["hook", "load", "hkld"],
    },
    Words {
        quantity: Quantity::Torque,
        names: &[&["torque"], &["trq"], &["tq"], &["tqa"], &["torq"]],
        with: &["rotary", "top", "drive", "td", "tds", "table", "string", "torque"],
    },
    Words {
        quantity: Quantity::RateOfPenetration,
        names: &[
            &["rop"],
            &["ropa"],
            &["rate", "of", "penetration"],
            &["penetration", "rate"],
        ],
        with: &["rate", "of", "penetration", "rop"],
    },
    Words {
        quantity: Quantity::StandpipePressure,
        names: &[
            &["spp"],
            &["sppa"],
            &["standpipe", "pressure"],
            &["stand", "pipe", "pressure"],
            &["spp", "pressure"],
        ],
        with: &["standpipe", "stand", "pipe", "pressure", "press"],
    },
    Words {
        quantity: Quantity::BitDepth,
        names: &[&["bit", "depth"], &["dbtm"], &["bit", "md"], &["depth", "bit"]],
        with: &["bit", "depth", "md"],
    },
    Words {
        quantity: Quantity::HoleDepth,
        names: &[&["hole", "depth"], &["dmea"], &["depth", "hole"], &["hole", "md"]],
        with: &["hole", "depth", "md", "total"],
    },
];

/// Words that make a name something else, whatever stands with them. The most particular ones come first.
pub(super) const OTHERS: &[(&str, &[&str])] = &[
    (
        "a set point or a limit",
        &[
            "set",
            "setpoint",
            "sp",
            "limit",
            "target",
            "command",
            "demand",
            "threshold",
            "max",
            "min",
            "high",
            "low",
        ],
    ),
    (
        "something measured or computed in the hole",
        &[
            "downhole", "dh", "mwd", "lwd", "bha", "motor", "pwd", "dwob", "dtor", "collar",
        ],
    ),
    (
        "pump strokes",
        &[
            "spm", "spm1", "spm2", "spm3", "spm4", "stroke", "strokes", "stk", "stks", "strk",
        ],
    ),
    ("a pump", &["pump", "pumps", "mp", "mp1", "mp2"]),
    ("a flow", &["flow", "flowrate", "mfia", "mfoa", "gpm", "lpm"]),
    (
        "the block's position or speed",
        &["block", "bpos", "travelling", "traveling", "blockpos"],
    ),
    (
        "another pressure",
        &[
            "casing",
            "annulus",
            "annular",
            "choke",
            "differential",
            "diff",
            "wellhead",
            "chkp",
            "ecd",
            "kill",
        ],
    ),
    (
        "a count of rows or events",
        &[
            "row", "index", "instance", "record", "count", "counter", "number", "no", "id", "seq", "sequence",
        ],
    ),
    (
        "a code of an activity",
        &["state", "activity", "operation", "mode", "status", "code", "slips"],
    ),
    (
        "a direction of the hole",
        &["incl", "inclination", "azi", "azimuth", "toolface", "tf", "dls"],
    ),
    (
        "a property of mud or rock",
        &[
            "gamma",
            "gr",
            "gas",
            "temp",
            "temperature",
            "mud",
            "density",
            "pit",
            "tank",
            "volume",
            "conductivity",
            "lithology",
        ],
    ),
    (
        "a vertical depth or one of samples",
        &["tvd", "lag", "lagged", "sample", "bottoms", "svy", "survey", "dver"],
    ),
    ("a vibration", &["vibration", "vib", "shock", "accel", "acceleration"]),
    (
        "a casing or tubular connection",
        &["makeup", "tong", "tongs", "breakout", "overpull", "drag", "slack"],
    ),
    (
        "a computed index",
        &[
            "mse",
            "dxc",
            "delta",
            "ratio",
            "sum",
            "cumulative",
            "total",
            "stddev",
            "error",
            "alarm",
            "quality",
        ],
    ),
];
