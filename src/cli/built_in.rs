//! Configurations compiled into the program, so that every command works without files.

use std::path::Path;

use crate::cli::output::tell;
use crate::field_log::Mapping;
use flexdrill_config::{Config, ConfigError};

flexdrill_base::listed! {
    /// A configuration of `config/`, as of the build.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(super) enum BuiltIn: 2 {
        /// The paper's case.
        Default: "config/default.yaml (built in)", "config/default.yaml";
        /// The same tool in a coarse mesh.
        Coarse: "config/coarse.yaml (built in)", "config/coarse.yaml";
        /// The parameter set that agrees best with the paper's figures.
        Paper: "config/paper.yaml (built in)", "config/paper.yaml";
        /// A rig's tool, with the physics that the paper leaves out.
        Rig: "config/rig.yaml (built in)", "config/rig.yaml";
    }
}

/// The demonstration's log, its mapping, and their files in the repository.
const DEMO: [(&str, &str); 2] = [
    (
        "config/field_logs/demo.csv",
        include_str!("../../config/field_logs/demo.csv"),
    ),
    (
        "config/field_logs/rig_1hz.yaml",
        include_str!("../../config/field_logs/rig_1hz.yaml"),
    ),
];

/// Whether a path that is no file means one of the repository, such as `rig`, `rig.yaml` or `config/rig.yaml`.
fn means(path: &Path, file: &str) -> bool {
    let short = file.rsplit('/').next().unwrap_or(file);
    let stem = short.split('.').next().unwrap_or(short);
    let path = path.to_str().map(|path| path.strip_prefix("./").unwrap_or(path));
    let path = path.map(|path| path.strip_suffix(" (built in)").unwrap_or(path));
    path.is_some_and(|path| [file, short, stem].contains(&path))
}

/// The built-in demonstration log, where a path that is no file means it.
pub(super) struct DemoLog;

impl DemoLog {
    /// The log, if `path` means it.
    pub(super) fn at(path: &Path) -> Option<Self> {
        (means(path, DEMO[0].0) && !path.exists()).then_some(Self)
    }

    /// Name of the log in errors and reports.
    pub(super) fn name(&self) -> String {
        format!("{} (built in)", DEMO[0].0)
    }

    /// Its bytes.
    pub(super) fn content(&self) -> &'static [u8] {
        DEMO[0].1.as_bytes()
    }

    /// The text of the mapping of its columns.
    pub(super) fn mapping_text(&self) -> &'static str {
        DEMO[1].1
    }

    /// The mapping of its columns.
    ///
    /// # Errors
    /// Never: a test reads it.
    pub(super) fn mapping(&self) -> Result<Mapping, ConfigError> {
        Mapping::from_text(&format!("{} (built in)", DEMO[1].0), DEMO[1].1)
    }
}

impl BuiltIn {
    /// Its file in the repository.
    pub(super) const fn file(self) -> &'static str {
        self.row()[1]
    }

    /// Its name in errors and in the node.
    pub(super) const fn name(self) -> &'static str {
        self.row()[0]
    }

    const fn text(self) -> &'static str {
        match self {
            Self::Default => include_str!("../../config/default.yaml"),
            Self::Coarse => include_str!("../../config/coarse.yaml"),
            Self::Paper => include_str!("../../config/paper.yaml"),
            Self::Rig => include_str!("../../config/rig.yaml"),
        }
    }

    /// The configuration in `path`, or this one without a path.
    ///
    /// # Errors
    /// When the file cannot be read, or the configuration is refused.
    pub(super) fn or_file(self, path: Option<&Path>) -> Result<Config, ConfigError> {
        match path {
            Some(path) => load(path).map(|(config, _)| config),
            None => self.config(),
        }
    }

    fn config(self) -> Result<Config, ConfigError> {
        Config::from_text(self.name(), self.text())
    }
}

/// The configuration in a file, and the name of its source. Where there is no such file and the name is that of a built-in
/// one (`rig`, `rig.yaml`, `config/rig.yaml`), that one is taken, and a line on standard error says so.
///
/// # Errors
/// When the file cannot be read, or the configuration is refused.
pub(super) fn load(path: &Path) -> Result<(Config, String), ConfigError> {
    let built_in = BuiltIn::ALL.into_iter().find(|built_in| means(path, built_in.file()));
    match built_in.filter(|_| !path.exists()) {
        Some(built_in) => {
            tell!(
                "{} is no file here: the built-in {} is used",
                path.display(),
                built_in.file()
            );
            Ok((built_in.config()?, built_in.name().to_owned()))
        }
        None => Ok((Config::load(path)?, path.display().to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_configuration_is_accepted() {
        for built_in in BuiltIn::ALL {
            built_in.or_file(None).unwrap();
            assert_eq!(built_in.name(), format!("{} (built in)", built_in.file()));
        }
    }

    /// After `cargo install` there is no folder `config/`. The tests run in the repository, which has no `rig.yaml` at its
    /// top.
    #[test]
    fn a_name_that_is_no_file_is_the_built_in_one() {
        for path in ["rig", "rig.yaml", "./rig.yaml", "config/rig.yaml (built in)"] {
            let (config, name) = load(Path::new(path)).unwrap();
            assert_eq!(name, "config/rig.yaml (built in)");
            assert_eq!(config, BuiltIn::Rig.config().unwrap());
        }
        // A file comes first, and what is neither is refused.
        assert_eq!(load(Path::new("config/rig.yaml")).unwrap().1, "config/rig.yaml");
        for path in ["rigs.yaml", "nowhere/rig.yaml", "", "yaml"] {
            assert!(load(Path::new(path)).is_err(), "{path}");
        }
    }

    #[test]
    fn the_demonstration_log_is_built_in_with_its_mapping() {
        for path in ["demo", "demo.csv", "nowhere/../demo.csv"] {
            let demo = DemoLog::at(Path::new(path));
            assert_eq!(demo.is_some(), !path.contains('/'), "{path}");
        }
        assert!(
            DemoLog::at(Path::new("config/field_logs/demo.csv")).is_none(),
            "it is a file here"
        );
        let demo = DemoLog::at(Path::new("demo")).unwrap();
        let all = crate::field_log::Range { from: None, to: None };
        let mapping = demo.mapping().unwrap();
        let (sequence, _) = crate::field_log::read_bytes(demo.name(), demo.content(), &mapping, &all).unwrap();
        assert!(sequence.inputs.len() > 100, "{}", sequence.inputs.len());
    }
}
