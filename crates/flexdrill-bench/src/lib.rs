//! Speed and figures of a configuration at constant inputs.
//!
//! [`measure::run`] runs a configuration as fast as it goes, [`real_time::tables`] the cases that the twin must keep pace
//! with, [`batch::tables`] how many members of look-aheads run. `flexdrill bench` shows them; the
//! measurements that take minutes to hours (`cargo xtask measure`) build on them.

pub mod batch;
pub mod cases;
pub mod figures;
pub mod machine;
pub mod measure;
pub mod parallel;
pub mod real_time;
pub mod table;

use flexdrill_config::{Config, ConfigError};

/// Why a change of a configuration cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ChangeError {
    /// It has no `=`.
    #[error("--set {0}: expected KEY=VALUE")]
    NoPair(String),
    /// The configuration refuses it.
    #[error("--set {change}: {source}")]
    Refused {
        /// As it was given.
        change: String,
        /// Why.
        source: ConfigError,
    },
    /// The step is refused.
    #[error(transparent)]
    Step(#[from] ConfigError),
}

/// `config` with another step (s) and other values, each as KEY=VALUE with the key's dotted path.
///
/// # Errors
/// When a change is not KEY=VALUE, or its key or value is refused.
pub fn changed(mut config: Config, time_step: Option<f64>, changes: &[String]) -> Result<Config, ChangeError> {
    if let Some(step) = time_step {
        config = config.with_value("solver.time_step", step)?;
    }
    for change in changes {
        let (key, value) = change
            .split_once('=')
            .ok_or_else(|| ChangeError::NoPair(change.clone()))?;
        // A value that is no number, true or false is a word, such as `shared`.
        let value = serde_json::from_str(value).unwrap_or_else(|_| serde_json::Value::from(value));
        config = config.with_value(key, value).map_err(|source| ChangeError::Refused {
            change: change.clone(),
            source,
        })?;
    }
    Ok(config)
}
