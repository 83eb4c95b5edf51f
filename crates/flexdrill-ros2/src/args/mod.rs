//! ROS 2 command line arguments: `--ros-args -r from:=to -p name:=value --params-file FILE --log-level LEVEL --`.
//!
//! The forms are those of `ros2 run`. Options that only make sense for the ROS 2 client libraries' own logging are
//! accepted and have no effect.

pub mod names;
pub mod params;
pub mod value;

use std::ffi::OsStr;
use std::path::PathBuf;

pub use names::{NameProblem, NodeIdentity, Remapping};
pub use params::{Override, Overrides};

/// What is wrong with the ROS 2 arguments.
#[derive(Debug, thiserror::Error)]
pub enum ArgsError {
    /// An unknown option.
    #[error(
        "unknown ROS argument '{0}' after --ros-args; known: -r, -p, --params-file, --log-level, --enable/--disable-{{rosout,stdout,external-lib}}-logs, --log-config-file, --log-file-name, -e"
    )]
    Unknown(String),
    /// An option without its value.
    #[error("{0} needs a value after it")]
    NoValue(String),
    /// A malformed remapping rule.
    #[error("remapping rule '{rule}': {why}")]
    Rule {
        /// The rule.
        rule: String,
        /// The problem and the remedy.
        why: String,
    },
    /// A name that ROS 2 does not allow.
    #[error("{what} '{name}': {problem}")]
    Name {
        /// Which kind of name.
        what: &'static str,
        /// Name, as it was given.
        name: String,
        /// What is wrong.
        problem: NameProblem,
    },
    /// A parameter override that cannot be read.
    #[error("parameter '{parameter}': {why}")]
    Parameter {
        /// Parameter and value, as they were given.
        parameter: String,
        /// What is wrong.
        why: String,
    },
    /// A parameter file that cannot be used.
    #[error("parameter file {path}: {why}", path = path.display())]
    File {
        /// File or folder that it is about.
        path: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// An unknown log level.
    #[error("log level '{0}': use debug, info, warn, error or fatal, or logger:=level")]
    LogLevel(String),
}

/// The ROS 2 arguments of a command line.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RosArgs {
    /// `-r`.
    pub remapping: Remapping,
    /// `-p` and `--params-file`.
    pub overrides: Overrides,
    /// `--log-level` without a logger name, in the words of a log filter: `debug`, `info`, `warn`, `error`.
    pub log_level: Option<String>,
    /// `--log-level logger:=level`, as (logger, level).
    pub logger_levels: Vec<(String, String)>,
    /// False after `--disable-rosout-logs`.
    pub rosout: Option<bool>,
}

/// Splits a command line into the arguments outside and inside of `--ros-args ... [--]` sections.
pub fn split<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>) -> (Vec<A>, Vec<A>) {
    let (mut outside, mut inside, mut ros) = (Vec::new(), Vec::new(), false);
    for argument in arguments {
        // File names need not be UTF-8, but the markers are.
        match (ros, argument.as_ref().to_str().unwrap_or_default()) {
            (false, "--ros-args") => ros = true,
            (true, "--") => ros = false,
            (true, "--ros-args") => {}
            (true, _) => inside.push(argument),
            (false, _) => outside.push(argument),
        }
    }
    (outside, inside)
}

impl RosArgs {
    /// Reads the arguments inside of `--ros-args`.
    ///
    /// # Errors
    /// Names the argument and what is wrong with it. Parameter files are read here.
    pub fn parse(arguments: &[String]) -> Result<Self, ArgsError> {
        let mut parsed = Self::default();
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            let mut value = || {
                rest.next()
                    .map(String::as_str)
                    .ok_or_else(|| ArgsError::NoValue(argument.clone()))
            };
            match argument.as_str() {
                "-r" | "--remap" => names::read_rule(value()?, &mut parsed.remapping)?,
                "-p" | "--param" => params::read_override(value()?, &mut parsed.overrides)?,
                "--params-file" => params::read_file(value()?.as_ref(), &mut parsed.overrides)?,
                "--log-level" => parsed.read_log_level(value()?)?,
                "--enable-rosout-logs" => parsed.rosout = Some(true),
                "--disable-rosout-logs" => parsed.rosout = Some(false),
                "--enable-stdout-logs" | "--disable-stdout-logs" => {}
                "--enable-external-lib-logs" | "--disable-external-lib-logs" => {}
                "--log-config-file" | "--log-file-name" | "-e" | "--enclave" => {
                    value()?;
                }
                rule if rule.contains(":=") => names::read_rule(rule, &mut parsed.remapping)?,
                _ => return Err(ArgsError::Unknown(argument.clone())),
            }
        }
        Ok(parsed)
    }

    fn read_log_level(&mut self, text: &str) -> Result<(), ArgsError> {
        let level = |word: &str| match word.to_ascii_lowercase().as_str() {
            "unset" | "info" => Ok("info".to_owned()),
            "debug" => Ok("debug".to_owned()),
            "warn" | "warning" => Ok("warn".to_owned()),
            "error" | "fatal" => Ok("error".to_owned()),
            _ => Err(ArgsError::LogLevel(text.to_owned())),
        };
        match text.split_once(":=") {
            Some((logger, word)) => self.logger_levels.push((logger.to_owned(), level(word)?)),
            None => self.log_level = Some(level(text)?),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<RosArgs, ArgsError> {
        RosArgs::parse(&line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn sections_open_and_close() {
        let line = [
            "run",
            "--ros-args",
            "-p",
            "a:=1",
            "--",
            "--domain",
            "3",
            "--ros-args",
            "-r",
            "x:=y",
        ];
        let (outside, inside) = split(line.map(str::to_owned));
        assert_eq!(outside, ["run", "--domain", "3"]);
        assert_eq!(inside, ["-p", "a:=1", "-r", "x:=y"]);
    }

    #[test]
    fn namespace_node_and_topics_are_remapped() {
        let args = parse("-r __ns:=/rig_7 --remap __node:=twin2 -r rig/rotary_speed_rpm:=/drive/rpm -r ~/reset:=again")
            .unwrap();
        let identity = args.remapping.identity("/", "flexdrill").unwrap();
        assert_eq!(identity.full_name(), "/rig_7/twin2");
        let topic = |name: &str| args.remapping.topic(&identity, "flexdrill", name).unwrap();
        assert_eq!(topic("rig/rotary_speed_rpm"), "/drive/rpm");
        assert_eq!(topic("rig/weight_on_bit_kn"), "/rig_7/rig/weight_on_bit_kn");
        assert_eq!(topic("/diagnostics"), "/diagnostics");
        assert_eq!(
            args.remapping.service(&identity, "flexdrill", "~/reset").unwrap(),
            "/rig_7/again"
        );
    }

    #[test]
    fn rules_for_other_nodes_and_kinds_are_left_alone() {
        let args =
            parse("-r other:__ns:=/far -r other:twin/status:=s -r rosservice://twin/status:=t -r flexdrill:a:=b")
                .unwrap();
        let identity = args.remapping.identity("/", "flexdrill").unwrap();
        assert_eq!(identity.namespace, "/");
        let topic = |name: &str| args.remapping.topic(&identity, "flexdrill", name).unwrap();
        assert_eq!(topic("twin/status"), "/twin/status");
        assert_eq!(topic("a"), "/b");
    }

    #[test]
    fn errors_name_the_argument() {
        let error = |line: &str| parse(line).unwrap_err().to_string();
        assert!(error("-q").contains("'-q'"));
        assert!(error("-p").contains("-p needs a value"));
        assert!(error("-p rate").contains("name:=value"));
        assert!(error("-r a:=").contains("empty"));
        assert!(error("-r __ns:=rig").contains("begin with '/'"));
        assert!(error("-r a:=7b").contains("'7'"));
        assert!(error("-r a/*:=b").contains("wildcards"));
        assert!(error("--log-level loud").contains("loud"));
        assert!(error("--params-file /nowhere.yaml").contains("/nowhere.yaml"));
    }

    #[test]
    fn logging_options_are_accepted() {
        let args =
            parse("--log-level WARN --log-level rcl:=debug --enable-rosout-logs --disable-stdout-logs -e /x").unwrap();
        assert_eq!(args.log_level.as_deref(), Some("warn"));
        assert_eq!(args.rosout, Some(true));
    }
}
