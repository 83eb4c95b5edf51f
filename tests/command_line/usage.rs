//! The command line as people meet it: the first start, words that are no commands, completions, man pages, the schema,
//! and every command that the documents show.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::flexdrill;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Exit code, standard output and standard error.
fn said(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = flexdrill(arguments);
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn without_arguments_it_says_what_it_is_and_what_to_type() {
    let (code, out, err) = said(&[]);
    assert_eq!((code, out.as_str()), (Some(2), ""));
    assert!(err.contains("digital twin"), "{err}");
    let commands: Vec<&str> = err.lines().filter(|line| line.starts_with("  flexdrill ")).collect();
    assert!(commands.len() >= 5, "{err}");
    for line in commands {
        let command = line.trim().split("  ").next().unwrap();
        flexdrill::cli::understand(command.split(' ').map(str::to_owned))
            .unwrap_or_else(|why| panic!("{line}: {}", why.text));
    }
}

#[test]
fn wrong_use_is_told_the_nearest_right_command() {
    for (arguments, expected) in [
        (&["rnu"][..], "flexdrill run"),
        (&["reprot", "bag"], "flexdrill report"),
        (&["run", "--recrod", "x"], "'--record'"),
        (&["check", "--ful", "x.yaml"], "'--full'"),
        (&["validate", "x.yaml"], "flexdrill check CONFIG"),
        (&["my_tool.yaml"], "flexdrill run --config my_tool.yaml"),
        (&["play", "log.csv"], "flexdrill rig LOG"),
        (&["run.mcap"], "flexdrill report run.mcap --out DIR"),
    ] {
        let (code, _, err) = said(arguments);
        assert_eq!(code, Some(2), "{arguments:?}: {err}");
        assert!(err.contains(expected), "{arguments:?}: {err}");
    }
    // A terminal's commands in a file's name are shown and not obeyed.
    let (_, _, err) = said(&["\u{1b}[2Jx.yaml"]);
    assert!(!err.contains('\u{1b}'), "{err:?}");
}

/// A name of a file is bytes; whatever a command does with it, it does not panic.
#[test]
fn a_file_name_that_is_not_utf_8_is_a_name_as_any_other() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let name = std::ffi::OsStr::from_bytes(b"tool_\xff.yaml");
    let path = folder.path().join(name);
    std::fs::copy(root().join("config/default.yaml"), &path).unwrap();
    let run = |arguments: &[&std::ffi::OsStr]| {
        let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
            .args(arguments)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{arguments:?}: {said}");
        (output.status.code(), said)
    };
    let (code, said) = run(&["check".as_ref(), path.as_os_str()]);
    assert_eq!(code, Some(0), "{said}");
    let missing = folder.path().join(std::ffi::OsStr::from_bytes(b"no_\xff"));
    for command in ["rig", "replay", "report", "recover", "check"] {
        let (code, said) = run(&[
            command.as_ref(),
            missing.as_os_str(),
            "--out".as_ref(),
            folder.path().as_ref(),
        ]);
        assert!(matches!(code, Some(1 | 2)), "{command}: {said}");
    }
    // ROS 2 arguments are text.
    let (code, said) = run(&["run".as_ref(), "--ros-args".as_ref(), "-r".as_ref(), name]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("is not UTF-8; ROS 2 arguments are text"), "{said}");
}

/// Rust's runtime opens /dev/null in the place of a standard output that is not open: without a look before that, a
/// command whose result went nowhere would succeed.
#[test]
fn a_closed_standard_output_is_a_failure_with_a_word() {
    for arguments in [
        "check config/default.yaml",
        "completions bash",
        "--version",
        "verify --help",
    ] {
        let shell = format!("exec \"$0\" {arguments} >&-");
        let mut command = Command::new("sh");
        command
            .args(["-c", &shell, env!("CARGO_BIN_EXE_flexdrill")])
            .current_dir(root());
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{arguments}: {said}");
        assert!(
            said.contains("cannot write to standard output: Bad file descriptor"),
            "{said}"
        );
        // What the system says is said once.
        assert_eq!(said.matches("Bad file descriptor").count(), 1, "{said}");
    }
    // Whoever sends it to /dev/null wants none of it.
    let output = Command::new(env!("CARGO_BIN_EXE_flexdrill"))
        .arg("--version")
        .stdout(std::process::Stdio::null())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn an_error_of_the_system_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let (file, below) = (file.to_str().unwrap(), format!("{}/report", file.display()));
    for arguments in [
        &["check", "/does/not/exist.yaml"][..],
        &["replay", "/does/not/exist.csv", "--out", &below],
        &["report", "/does/not/exist.mcap", "--out", &below],
        &["recover", "/does/not/exist.mcap", "--out", &below],
        &["rig", "/does/not/exist.csv"],
        &["paper", "--out", &below],
        &["man", "--out", &below],
        &[
            "run",
            "--config",
            file,
            "--token-file",
            "/does/not/exist",
            "--foxglove",
            "127.0.0.1:0",
            "--allow-control",
        ],
        &["run", "--ros-args", "--params-file", "/does/not/exist.yaml"],
    ] {
        let (code, _, err) = said(arguments);
        assert!(matches!(code, Some(1 | 2)), "{arguments:?}: {err}");
        for words in ["No such file or directory", "Not a directory", "os error"] {
            assert!(err.matches(words).count() <= 1, "{arguments:?}: {err}");
        }
    }
}

/// As `run`, these need no file of the repository.
#[test]
fn bench_and_paper_work_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_flexdrill"));
        let output = command.args(arguments).current_dir(folder.path()).output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let (code, out, err) = run(&["bench", "--duration", "0.1"]);
    assert_eq!(code, Some(0), "{err}");
    assert!(
        out.contains("### config/default.yaml") && out.contains("### config/coarse.yaml"),
        "{out}"
    );
    // The configuration is read and then refused for what is asked of it, before anything runs.
    let (code, _, err) = run(&["paper", "--out", "paper", "--set", "tool.links=0"]);
    assert_eq!(code, Some(1), "{err}");
    assert!(err.contains("tool.links = 0"), "{err}");
}

#[test]
fn completions_and_man_pages_know_every_command() {
    let (_, help, _) = said(&["--help"]);
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.trim().split(' ').next())
        .filter(|command| *command != "help")
        .collect();
    assert!(commands.contains(&"run") && commands.contains(&"report"), "{help}");
    let folder = tempfile::tempdir().unwrap();
    let (code, _, err) = said(&["man", "--out", folder.path().to_str().unwrap()]);
    assert_eq!(code, Some(0), "{err}");
    for shell in ["bash", "zsh", "fish"] {
        let (code, out, err) = said(&["completions", shell]);
        assert_eq!(code, Some(0), "{err}");
        for command in &commands {
            assert!(out.contains(command), "{shell}: {command}");
        }
    }
    for command in commands {
        let page = std::fs::read_to_string(folder.path().join(format!("flexdrill-{command}.1"))).unwrap();
        assert!(page.contains(".SH SYNOPSIS"), "{command}");
    }
    assert!(folder.path().join("flexdrill.1").exists());
}

/// Rewritten by: flexdrill check --schema > config/flexdrill.schema.json
#[test]
fn the_schema_that_is_checked_in_is_that_of_this_version() {
    let (code, out, err) = said(&["check", "--schema"]);
    assert_eq!(code, Some(0), "{err}");
    let path = root().join("config/flexdrill.schema.json");
    assert!(
        std::fs::read_to_string(&path).unwrap() == out,
        "{} is old; flexdrill check --schema > config/flexdrill.schema.json",
        path.display()
    );
    // Editors find it from the file that people begin with.
    let config = std::fs::read_to_string(root().join("config/default.yaml")).unwrap();
    assert!(config.contains("# yaml-language-server: $schema=flexdrill.schema.json"));
}

/// Markdown files of the repository and the pages of the manual.
fn documents() -> Vec<PathBuf> {
    let mut found = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    let mut folders = vec![root().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path
                .extension()
                .is_some_and(|extension| extension == "md" || extension == "py" || extension == "yaml")
            {
                found.push(path);
            }
        }
    }
    found
}

/// The command line of a line of a code block, if it is one of flexdrill.
fn command(line: &str) -> Option<Vec<String>> {
    let line = line
        .trim()
        .trim_start_matches("# ")
        .trim_start_matches("$ ")
        .trim_start_matches("sudo ")
        .trim();
    let mut words: Vec<String> = Vec::new();
    let mut quote = None;
    let mut word = String::new();
    for letter in line.chars() {
        match (letter, quote) {
            ('\'' | '"', None) => quote = Some(letter),
            (_, Some(open)) if letter == open => quote = None,
            (' ', None) => words.push(std::mem::take(&mut word)),
            // What follows is a comment, or for the shell.
            ('#' | '|' | '&' | ';' | '>' | '<', None) => break,
            _ => word.push(letter),
        }
    }
    words.push(word);
    words.retain(|word| !word.is_empty());
    let is_setting = |word: &String| {
        word.split_once('=')
            .is_some_and(|(name, _)| name.chars().all(|c| c.is_ascii_uppercase() || c == '_'))
    };
    let mut words: Vec<String> = words.into_iter().skip_while(is_setting).collect();
    let program = words.first()?;
    // A sentence may begin with the program's name too; a command has no full stop or comma behind a word.
    let is_command =
        ["flexdrill", "target/release/flexdrill", "./target/release/flexdrill"].contains(&program.as_str());
    if !is_command || words.len() < 2 || words.iter().any(|word| word == "..." || word.ends_with(',')) {
        return None;
    }
    words[0] = "flexdrill".to_owned();
    Some(words)
}

/// Commands of a document: those in code blocks, which are whole, and those in a sentence, which may be a part.
fn commands(file: &Path, text: &str) -> Vec<(bool, Vec<String>)> {
    let markdown = file.extension().is_some_and(|extension| extension == "md");
    let (mut found, mut sentences) = (Vec::new(), String::new());
    let mut fenced = false;
    for line in text.lines() {
        if markdown && line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if fenced || line.starts_with("    ") || (!markdown && line.starts_with("#     ")) {
            found.extend(command(line).map(|words| (true, words)));
        } else if markdown {
            sentences.push_str(line);
            sentences.push(' ');
        }
    }
    let quoted = sentences.split('`').skip(1).step_by(2);
    found.extend(quoted.filter_map(command).map(|words| (false, words)));
    found
}

#[test]
fn commands_in_the_documents_are_understood() {
    let (mut wrong, mut whole, mut parts) = (Vec::new(), 0, 0);
    for file in documents() {
        let text = std::fs::read_to_string(&file).unwrap();
        for (is_whole, words) in commands(&file, &text) {
            *(if is_whole { &mut whole } else { &mut parts }) += 1;
            match flexdrill::cli::understand(words.clone()) {
                Err(why) if is_whole || !why.incomplete => {
                    let why = why.text.lines().next().unwrap_or_default().to_owned();
                    wrong.push(format!("{}: {}: {why}", file.display(), words.join(" ")));
                }
                _ => {}
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "commands that flexdrill does not understand:\n{}",
        wrong.join("\n")
    );
    // Fewer would mean that they are no longer found.
    assert!(whole >= 10 && parts >= 40, "{whole} whole, {parts} in sentences");
}

#[test]
fn a_command_in_a_document_is_found() {
    let words = |line: &str| command(line).map(|words| words.join(" "));
    assert_eq!(
        words("    $ flexdrill rig LOG  # in real time").unwrap(),
        "flexdrill rig LOG"
    );
    assert_eq!(
        words("ROS_DOMAIN_ID=3 flexdrill run --ros-args -r __ns:=/rig_7").unwrap(),
        "flexdrill run --ros-args -r __ns:=/rig_7"
    );
    assert_eq!(
        words("flexdrill completions bash > file").unwrap(),
        "flexdrill completions bash"
    );
    assert_eq!(words("cargo build"), None);
}
