//! The sample that plausible tools are drawn from, where the configuration names one.

use std::path::Path;
use std::sync::Arc;

use flexdrill_config::Config;
use flexdrill_uncertainty::{Posterior, UncertaintyError};

/// The posterior that a configuration in `config_file` names, and the configuration as a run records it: with the checksum of
/// that file, so that a replay draws the same tools or refuses.
///
/// # Errors
/// When the file cannot be read or does not belong to the configuration.
pub fn named_by(config: &Config, config_file: &Path) -> Result<(Config, Option<Arc<Posterior>>), UncertaintyError> {
    let folder = config_file.parent().unwrap_or(Path::new(""));
    match Posterior::named_by(config, folder)? {
        Some(posterior) => {
            let config = config.with_value("ensemble.posterior_sha256", posterior.sha256())?;
            Ok((config, Some(Arc::new(posterior))))
        }
        None => Ok((config.clone(), None)),
    }
}
