//! The texts for a start without arguments, or with an unknown command.

use std::path::Path;

/// The text for a start without arguments.
pub(super) const WELCOME: &str = "\
flexdrill is the real-time digital twin of a flexible drilling tool, as a ROS 2 node. It reads the rig's rotary speed
and weight on bit, solves the tool's motion in the well, and publishes bend of the joints, contact forces, the bit's
motion, and alarms for whirl, stick-slip and shock.

Begin with one of these:

  flexdrill demo                          a twin and a rig that drills by a built-in log, here in this terminal
  flexdrill run                           the twin of the paper's tool, live, on this machine's ROS 2 network
  flexdrill dashboard                     see it in a browser: the tool in its well, limits, alarms, the last hour
  flexdrill watch                         see it in a second terminal
  flexdrill rig LOG.csv                   send a field log's speed and weight to it, in a third
  flexdrill replay LOG.csv --out RUN      run a field log or a bag through the model without waiting, into a bag
  flexdrill report RUN --out DIR          make one page of a bag to pass on

  ros2 run flexdrill flexdrill run        the same twin by ROS 2's own command; --ros-args follow it as usual

  flexdrill check my_tool.yaml            is my configuration right?
  flexdrill verify                        is the model right? Closed-form cases, in a minute or two

flexdrill --help lists all commands, flexdrill COMMAND --help describes one.
";

/// Words of other programs for commands of this one.
const SYNONYMS: [(&str, &[&str]); 12] = [
    ("demo", &["demonstration", "example", "try"]),
    ("run", &["start", "node", "launch", "twin", "serve", "simulate"]),
    ("run --record FILE.mcap", &["record", "rec", "log"]),
    ("rig LOG", &["play", "publish", "send", "feed"]),
    ("replay IN --out OUT", &["convert", "process", "import"]),
    ("report BAG --out DIR", &["html", "export", "summary", "info"]),
    ("dashboard", &["web", "page", "browser", "gui", "ui", "foxglove"]),
    ("watch", &["monitor", "top", "tui", "echo", "view", "show", "status"]),
    ("check CONFIG", &["validate", "lint", "config", "configuration"]),
    ("check --schema", &["schema"]),
    ("recover IN --out OUT", &["repair", "fix", "reindex"]),
    ("--help", &["usage", "commands"]),
];

/// Largest edit distance of a misspelt word.
const LARGEST_DISTANCE: usize = 2;

/// The command probably meant by a word that is none of the `commands`; `None` if no command is similar.
pub(super) fn suggestion<'a>(word: &str, commands: impl Iterator<Item = &'a str>) -> Option<String> {
    if let Some((command, _)) = SYNONYMS.iter().find(|(_, words)| words.contains(&word)) {
        return Some(format!("flexdrill {command}"));
    }
    let path = Path::new(word);
    let extension = path
        .extension()
        .and_then(|extension| extension.to_str())
        .unwrap_or_default();
    Some(match extension {
        "yaml" | "yml" => format!("flexdrill check {word}, or flexdrill run --config {word}"),
        "csv" | "txt" if path.exists() => format!("flexdrill replay {word} --out OUT, or flexdrill rig {word}"),
        "mcap" | "db3" => format!("flexdrill report {word} --out DIR, or flexdrill replay {word} --out OUT"),
        _ if path.join("metadata.yaml").exists() => {
            format!("flexdrill report {word} --out DIR, or flexdrill replay {word} --out OUT")
        }
        _ => {
            let near = |command: &'a str| (strsim::damerau_levenshtein(word, command), command);
            let (distance, command) = commands.map(near).min()?;
            // A short word with every letter changed is another word.
            if distance > LARGEST_DISTANCE || distance >= word.chars().count() {
                return None;
            }
            format!("flexdrill {command}")
        }
    })
}

#[cfg(test)]
mod tests {
    const COMMANDS: [&str; 4] = ["run", "rig", "replay", "report"];

    fn suggested(word: &str) -> Option<String> {
        super::suggestion(word, COMMANDS.into_iter())
    }

    #[test]
    fn a_file_or_another_programs_word_finds_its_command() {
        assert_eq!(suggested("start").unwrap(), "flexdrill run");
        assert_eq!(suggested("validate").unwrap(), "flexdrill check CONFIG");
        assert!(suggested("my_tool.yaml").unwrap().contains("run --config my_tool.yaml"));
        assert!(
            suggested("night.mcap")
                .unwrap()
                .starts_with("flexdrill report night.mcap")
        );
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("metadata.yaml"), "").unwrap();
        assert!(
            suggested(&folder.path().display().to_string())
                .unwrap()
                .contains("report")
        );
        for (word, command) in [
            ("rnu", "run"),
            ("reprot", "report"),
            ("replya", "replay"),
            ("rgi", "rig"),
        ] {
            assert_eq!(suggested(word).unwrap(), format!("flexdrill {command}"));
        }
        assert_eq!(suggested("xyz"), None);
        assert_eq!(suggested("q"), None);
    }
}
