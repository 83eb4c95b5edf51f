//! The logger services of a ROS 2 node: `~/get_logger_levels` and `~/set_logger_levels`.
//!
//! The node has one logger with its own name. The name of a part of the program (`flexdrill_bag`) or of a library (`rustdds`)
//! is a logger for that part.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::logging;
use super::service::{ServiceMapping, ServiceServer, Task, at_once};
use crate::dds::port::PortBuilder;
use flexdrill_messages::rcl_interfaces::{
    GetLoggerLevelsRequest, GetLoggerLevelsResponse, LoggerLevel, SetLoggerLevelsRequest, SetLoggerLevelsResponse,
    SetLoggerLevelsResult,
};

/// The target of this program's lines.
const OURS: &str = "flexdrill";

/// Why a level is not set.
#[derive(Debug, thiserror::Error)]
enum LevelError {
    #[error("{0} is not a level; use 10 (debug), 20 (info), 30 (warn), 40 (error) or 50 (fatal)")]
    Level(u32),
    #[error("'{0}' is not the name of a logger; use the node's, or letters, digits, _ and ::")]
    Name(String),
    #[error("logging was not started by this program")]
    NotOurs,
}

/// The levels that were set.
struct Loggers {
    /// The node's name, as a logger's: `rig_7.flexdrill`.
    node: String,
    set: Mutex<BTreeMap<String, u32>>,
}

impl Loggers {
    fn target<'a>(&self, name: &'a str) -> Result<&'a str, LevelError> {
        if name.is_empty() || name == self.node {
            return Ok(OURS);
        }
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == ':';
        if name.chars().all(plain) {
            Ok(name)
        } else {
            Err(LevelError::Name(name.escape_default().to_string()))
        }
    }

    fn level(&self, name: &str) -> u32 {
        let set = self.set.lock().unwrap_or_else(PoisonError::into_inner);
        let target = self.target(name).unwrap_or_default();
        set.get(target)
            .copied()
            .unwrap_or(u32::from(LoggerLevel::LOG_LEVEL_UNKNOWN))
    }

    fn set_level(&self, LoggerLevel { name, level }: &LoggerLevel) -> Result<(), LevelError> {
        let target = self.target(name)?;
        filter_word(*level)?;
        let mut set = self.set.lock().unwrap_or_else(PoisonError::into_inner);
        set.insert(target.to_owned(), *level);
        let directives: Vec<String> = set
            .iter()
            .filter_map(|(target, level)| Some(format!("{target}={}", filter_word(*level).ok()?)))
            .collect();
        if !logging::add_directives(&directives) {
            return Err(LevelError::NotOurs);
        }
        Ok(())
    }
}

fn filter_word(level: u32) -> Result<&'static str, LevelError> {
    match level {
        10 => Ok("debug"),
        20 => Ok("info"),
        30 => Ok("warn"),
        40 | 50 => Ok("error"),
        other => Err(LevelError::Level(other)),
    }
}

/// Creates both servers; `node` is the node's full name.
pub fn serve(port: &mut PortBuilder, mapping: ServiceMapping, node: &str) -> Vec<Task> {
    let loggers = Arc::new(Loggers {
        node: node.trim_start_matches('/').replace('/', "."),
        set: Mutex::default(),
    });
    let mut server = |name: &str, kind: &str| {
        let kind = format!("rcl_interfaces/srv/{kind}");
        ServiceServer::new(port, &format!("{node}/{name}"), &kind, mapping)
    };
    let (get, set) = (Arc::clone(&loggers), loggers);
    vec![
        Box::pin(server("get_logger_levels", "GetLoggerLevels").serve(at_once(
            move |request: GetLoggerLevelsRequest| {
                let levels = request.names.into_iter().map(|name| LoggerLevel {
                    level: get.level(&name),
                    name,
                });
                GetLoggerLevelsResponse {
                    levels: levels.collect(),
                }
            },
        ))),
        Box::pin(server("set_logger_levels", "SetLoggerLevels").serve(at_once(
            move |request: SetLoggerLevelsRequest| {
                let results = request.levels.iter().map(|asked| {
                    let reason = set.set_level(asked).err().map(|error| error.to_string());
                    SetLoggerLevelsResult {
                        successful: reason.is_none(),
                        reason: reason.unwrap_or_default(),
                    }
                });
                SetLoggerLevelsResponse {
                    results: results.collect(),
                }
            },
        ))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_names_and_levels_are_refused() {
        let loggers = Loggers {
            node: "rig_7.flexdrill".to_owned(),
            set: Mutex::default(),
        };
        assert_eq!(loggers.target("rig_7.flexdrill").ok(), Some(OURS));
        assert_eq!(loggers.target("flexdrill_bag").ok(), Some("flexdrill_bag"));
        assert!(loggers.target("a=trace,b").is_err());
        assert_eq!(loggers.level("flexdrill_bag"), 0);
        for (level, word) in [(10, Some("debug")), (50, Some("error")), (11, None)] {
            assert_eq!(filter_word(level).ok(), word);
        }
    }
}
