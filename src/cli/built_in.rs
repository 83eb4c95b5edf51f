//! Configurations compiled into the program, so that every command works without files.

use std::path::Path;

use flexdrill_config::{Config, ConfigError};

/// A configuration of `config/`, as of the build.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BuiltIn {
    /// The paper's case.
    Default,
    /// The same tool in a coarse mesh.
    Coarse,
    /// The parameter set that agrees best with the paper's figures.
    Paper,
}

impl BuiltIn {
    /// Its file in the repository.
    pub(super) const fn file(self) -> &'static str {
        match self {
            Self::Default => "config/default.yaml",
            Self::Coarse => "config/coarse.yaml",
            Self::Paper => "config/paper.yaml",
        }
    }

    /// Its name in errors and in the node.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Default => "config/default.yaml (built in)",
            Self::Coarse => "config/coarse.yaml (built in)",
            Self::Paper => "config/paper.yaml (built in)",
        }
    }

    const fn text(self) -> &'static str {
        match self {
            Self::Default => include_str!("../../config/default.yaml"),
            Self::Coarse => include_str!("../../config/coarse.yaml"),
            Self::Paper => include_str!("../../config/paper.yaml"),
        }
    }

    /// The configuration in `path`, or this one without a path.
    ///
    /// # Errors
    /// When the file cannot be read, or the configuration is refused.
    pub(super) fn or_file(self, path: Option<&Path>) -> Result<Config, ConfigError> {
        match path {
            Some(path) => Config::load(path),
            None => Config::from_text(self.name(), self.text()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_configuration_is_accepted() {
        for built_in in [BuiltIn::Default, BuiltIn::Coarse, BuiltIn::Paper] {
            built_in.or_file(None).unwrap();
            assert_eq!(built_in.name(), format!("{} (built in)", built_in.file()));
        }
    }
}
