//! Crates that wrap a foreign library are the only ones that depend on it, and the crates of the workspace use each other as
//! `docs/architecture.md` says.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "helpers of tests fail by panicking"
)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A foreign crate, and the crate of the workspace that may use it.
const OWNERS: [(&str, &str); 13] = [
    ("rustdds", "flexdrill-ros2"),
    ("ros2-client", "flexdrill-ros2"),
    ("foxglove", "flexdrill-live"),
    ("tokio-tungstenite", "flexdrill-live"),
    ("mcap", "flexdrill-bag"),
    ("rusqlite", "flexdrill-sqlite"),
    ("csv-core", "flexdrill-field-log"),
    ("serial2-tokio", "flexdrill-bridge"),
    ("rumqttc", "flexdrill-bridge"),
    ("async-opcua", "flexdrill-bridge"),
    ("maud", "flexdrill-report"),
    ("numpy", "flexdrill-python"),
    ("pyo3", "flexdrill-python"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Name and manifest of every crate of the workspace.
fn manifests() -> Vec<(String, String)> {
    let crates = std::fs::read_dir(root().join("crates")).unwrap();
    let mut folders: Vec<PathBuf> = crates.map(|entry| entry.unwrap().path()).collect();
    folders.extend(
        [
            "",
            "xtask",
            "xtask/measurements",
            "xtask/pages",
            "xtask/studies",
            "benches",
        ]
        .map(|folder| root().join(folder)),
    );
    folders
        .iter()
        .filter_map(|folder| std::fs::read_to_string(folder.join("Cargo.toml")).ok())
        .map(|text| {
            let name = text.lines().find_map(|line| line.strip_prefix("name = "));
            (name.unwrap().trim_matches('"').to_owned(), text)
        })
        .collect()
}

/// The crates that a manifest lists under its `[dependencies]`, those for tests left out.
fn dependencies(manifest: &str) -> Vec<&str> {
    listed(manifest, "[dependencies]")
}

/// The crates that a manifest lists in a section.
fn listed<'a>(manifest: &'a str, wanted: &str) -> Vec<&'a str> {
    let mut section = "";
    let mut found = Vec::new();
    for line in manifest.lines() {
        if line.starts_with('[') {
            section = line;
        } else if section == wanted
            && let Some((name, _)) = line.split_once(['=', '.'])
        {
            found.push(name.trim());
        }
    }
    found
}

#[test]
fn a_foreign_library_has_one_user() {
    let manifests = manifests();
    assert!(manifests.len() > 10, "{} crates", manifests.len());
    for (library, owner) in OWNERS {
        let users: Vec<&str> = manifests
            .iter()
            .filter(|(_, manifest)| dependencies(manifest).contains(&library))
            .map(|(name, _)| name.as_str())
            .collect();
        assert!(
            users.iter().all(|user| *user == owner),
            "only {owner} may depend on {library}, not {users:?}"
        );
    }
    // The check reads manifests as they are written.
    let ros2 = manifests.iter().find(|(name, _)| name == "flexdrill-ros2");
    assert!(dependencies(&ros2.unwrap().1).contains(&"rustdds"));
}

#[test]
fn no_crate_uses_the_product_or_the_workshop() {
    for (name, manifest) in manifests() {
        for above in ["flexdrill", "xtask"] {
            assert!(!dependencies(&manifest).contains(&above), "{name} depends on {above}");
        }
    }
}

/// Words of the column "may use" that are no crate of the workspace.
const OTHERS: [&str; 4] = ["all of these", "none of these", "numeric crates", "serde"];

/// Rows of the table of crates: name and the words of the column "may use".
fn table(page: &str) -> Vec<(&str, Vec<&str>)> {
    let (_, section) = page.split_once("## Crates and arrows").unwrap();
    let rows = section.lines().skip_while(|line| !line.starts_with("| `"));
    rows.take_while(|line| line.starts_with('|'))
        .map(|row| {
            let name = row.split('`').nth(1).unwrap();
            let (_, column) = row.trim_end_matches('|').rsplit_once('|').unwrap();
            let words = column.split(',').map(str::trim).filter(|word| !word.is_empty());
            (name, words.collect())
        })
        .collect()
}

#[test]
fn crates_use_each_other_as_the_architecture_says() {
    let page = std::fs::read_to_string(root().join("docs/architecture.md")).unwrap();
    let table = table(&page);
    // docs/upstream/rustdds.md describes the changed RustDDS.
    let manifests: Vec<(String, String)> = manifests().into_iter().filter(|(name, _)| name != "rustdds").collect();
    let names: BTreeSet<&str> = manifests.iter().map(|(name, _)| name.as_str()).collect();
    let rows: BTreeSet<&str> = table.iter().map(|(name, _)| *name).collect();
    assert_eq!(rows, names, "one row per crate");
    for (name, words) in &table {
        let (_, manifest) = manifests.iter().find(|(found, _)| found == name).unwrap();
        let mut uses: BTreeSet<&str> = dependencies(manifest).into_iter().collect();
        if *name == "flexdrill-benches" {
            // Benchmarks are compiled like tests.
            uses.extend(listed(manifest, "[dev-dependencies]"));
        }
        uses.retain(|used| names.contains(used));
        if words.contains(&"all of these") {
            continue;
        }
        let crates = words.iter().filter(|word| !OTHERS.contains(word));
        let allowed: BTreeSet<String> = crates.map(|word| format!("flexdrill-{word}")).collect();
        let allowed: BTreeSet<&str> = allowed.iter().map(String::as_str).collect();
        assert_eq!(
            uses, allowed,
            "{name}: its Cargo.toml, and its row of docs/architecture.md"
        );
    }
}

/// Rooms of the core, from the ground up. A room may use those before it.
const FLOORS: [&str; 10] = [
    "simd", "tool", "inputs", "elements", "model", "dynamics", "chain", "effects", "step", "twin",
];
/// Rooms of the session, the same.
const FLOORS_OF_SESSION: [&str; 7] = [
    "safe_window",
    "rig_inputs",
    "alarms",
    "drilling",
    "residuals",
    "ensemble",
    "session",
];

/// Rust files of a room, a folder or a file; those in tests left out.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let file = folder.with_extension("rs");
    if file.is_file() {
        return vec![file];
    }
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .filter(|path| !path.ends_with("tests") && !path.ends_with("tests.rs"))
        .flat_map(|path| match path.is_dir() {
            true => sources(&path),
            false => vec![path],
        })
        .collect()
}

/// A file's code: its tests and its comments left out.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let (code, _) = text.split_once("#[cfg(test)]\nmod tests {").unwrap_or((&text, ""));
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// Checks the rooms of a crate, which have at least so many arrows down.
fn uses_no_room_above(name: &str, floors: &[&str], arrows: usize) {
    let sources_of = root().join("crates").join(name).join("src");
    let mut seen = 0;
    for (floor, room) in floors.iter().enumerate() {
        for path in sources(&sources_of.join(room)) {
            let code = code(&path);
            let uses = |other: &&&str| code.contains(&format!("crate::{other}::"));
            let above = floors[floor + 1..].iter().find(uses);
            assert_eq!(above, None, "{} uses a room above {room}", path.display());
            seen += floors[..floor].iter().filter(uses).count();
        }
    }
    // Rooms below are found as they are written.
    assert!(seen >= arrows, "{name}: {seen} arrows down");
    // What is new has its floor, but for the room of the core that is compiled in tests alone.
    let rooms = std::fs::read_dir(&sources_of)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    for room in rooms.filter(|path| !path.ends_with("lib.rs") && !path.ends_with("stations")) {
        let room = room.file_stem().unwrap().to_str().unwrap();
        assert!(floors.contains(&room), "{name}: {room} has no floor");
    }
}

#[test]
fn no_room_uses_a_room_above_it() {
    uses_no_room_above("flexdrill-core", &FLOORS, 100);
    uses_no_room_above("flexdrill-session", &FLOORS_OF_SESSION, 12);
}

/// An effect: its files, the words by which code names it, and those that contain such a word but name something else: the
/// input of the rig by which a pressure can be set, and a hazard that has the pressure in its name.
struct OfEffect {
    own: &'static [&'static str],
    words: &'static [&'static str],
    others: &'static [&'static str],
    /// How many other files of the core may name it, tests and the witness left out.
    most: usize,
}

const fn effect(own: &'static [&'static str], words: &'static [&'static str]) -> OfEffect {
    OfEffect {
        own,
        words,
        others: &[],
        most: MOST_OTHER_FILES,
    }
}

const EFFECTS: [OfEffect; 10] = [
    // Its description has a file, next to that of the whole tool. What touches is published as contacts by whoever reads it,
    // and the time of what acts at stations is that of contact.
    OfEffect {
        own: &["contact"],
        words: &[
            "GapDescription",
            "FrictionLaw",
            "friction_law",
            "WallFrictionFactors",
            "wall_friction_factors",
            "inner_friction",
            "outer_friction",
            "slid_in",
            "GapLaw",
            "GapTangent",
            "LayerContacts",
            "has_bristles",
            "contact::",
            "description.inner",
            "description.outer",
        ],
        others: &["mod contact;", "use contact::*;"],
        most: 4,
    },
    // Its description has a file, next to that of the whole tool. The words are those of law, description and state: torque,
    // weight and speed at the tool's lower end are published as those of the bit by whoever reads them.
    OfEffect {
        own: &["bit"],
        words: &[
            "BitDescription",
            "RockLaw",
            "DepthOfCut",
            "Weakening",
            "BitLoad",
            "BitMark",
            "bit::Bit",
            "description.bit",
            ".rock",
            "rock:",
            "bit_torque",
            "bit_slip_rate",
            "bit_friction",
        ],
        others: &[],
        most: 4,
    },
    // Its description has a file, too. What it does to the tool's top is published as that of string, drive and hoist.
    OfEffect {
        own: &["string"],
        words: &[
            "StringDescription",
            "StringLine",
            "StringStep",
            "StringState",
            "DrillString",
            "string::Drill",
            "description.string",
            ".string",
            "string: ",
            "TopDrive",
            "TopEnd",
            "HoistState",
            "Option<Hoist>",
        ],
        others: &[],
        most: 4,
    },
    effect(
        &["bodies"],
        &[
            ".masses",
            " masses: ",
            "PointMass",
            "PointBody",
            "ResolvedMass",
            "bodies::",
            "Bodies",
        ],
    ),
    effect(
        &["mud_wall"],
        &["mud_wall", "MudWall", "NearWall", "Eccentric", "MudFilm"],
    ),
    effect(&["shortening.rs"], &["hortening", "Shortened"]),
    effect(&["slots.rs"], &["guide_slots", "SlottedGuide", "slots::"]),
    effect(
        &["preload.rs"],
        &["free_curvature", "FreeCurvature", "preload::", "Preloaded"],
    ),
    // Mud near the walls is mud.
    effect(&["mud.rs", "mud_wall"], &["mud", "Mud"]),
    OfEffect {
        own: &["pressure.rs"],
        words: &[
            "pressure",
            "PipePressure",
            "Pressurised",
            "PressureDescription",
            "PressureSource",
            "PressureEnd",
        ],
        others: &["standpipe_pressure", "standpipe pressure", "pressure_folding"],
        most: MOST_OTHER_FILES,
    },
];

/// How many files of the core other than its own most effects may be named in: the description, the description of the paper's
/// tool, the list of effects.
const MOST_OTHER_FILES: usize = 3;

#[test]
fn an_effect_is_one_file() {
    let core = root().join("crates/flexdrill-core/src");
    let files: Vec<PathBuf> = FLOORS.iter().flat_map(|room| sources(&core.join(room))).collect();
    for OfEffect {
        own,
        words,
        others,
        most,
    } in EFFECTS
    {
        let own: Vec<PathBuf> = own.iter().map(|own| core.join("effects").join(own)).collect();
        let is_own = |file: &&PathBuf| own.iter().any(|own| file.starts_with(own));
        for own in &own {
            let is_there = files.iter().any(|file| file.starts_with(own));
            assert!(is_there, "{} is not there", own.display());
        }
        let naming: Vec<&PathBuf> = files
            .iter()
            .filter(|file| !is_own(file))
            .filter(|file| {
                let code = others.iter().fold(code(file), |code, other| code.replace(other, ""));
                words.iter().any(|word| code.contains(word))
            })
            .collect();
        println!("{}: {} other files", own[0].display(), naming.len());
        assert!(!naming.is_empty(), "{}: nothing switches it on", own[0].display());
        assert!(
            naming.len() <= most,
            "{} is named in {} other files, at most {most}: {naming:#?}",
            own[0].display(),
            naming.len()
        );
    }
}

/// What makes messages, alarms and comparisons of a run, and the hosts of runs. Only the session calls it, so that an output
/// that is added there is in all of them.
const OF_THE_SESSION: [&str; 8] = [
    "Outputs::",
    "RigComparison::new",
    ".observe_tool(",
    ".observe_rig(",
    ".observe_adjusted(",
    ".observe_friction(",
    "fill::",
    "&topics::RESIDUALS",
];
const HOSTS: [&str; 4] = ["src/node", "src/cli/replay", "src/ahead", "crates/flexdrill-python/src"];

#[test]
fn hosts_publish_nothing_of_their_own() {
    for host in HOSTS {
        let files = sources(&root().join(host));
        let users = files.iter().filter(|file| code(file).contains("session::"));
        assert!(users.count() > 0, "{host} has no session");
        for file in files {
            let code = code(&file);
            for call in OF_THE_SESSION {
                assert!(
                    !code.contains(call),
                    "{}: {call} is for the session alone",
                    file.display()
                );
            }
        }
    }
}
