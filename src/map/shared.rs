//! What all points of a plan share: the states that they start from, and the sample of a calibration that plausible tools are
//! drawn from.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::states::States;
use crate::ahead::Members;
use flexdrill_config::Config;
use flexdrill_map::{Sample, Start};
use flexdrill_sweep::outcome::Begun;
use flexdrill_sweep::{Plan, Point};
use flexdrill_uncertainty::posterior::FILE;
use flexdrill_uncertainty::{Posterior, Priors, UncertaintyError};

/// What all points of a plan share.
#[derive(Default)]
pub struct Shared {
    /// The states that points start from.
    pub(super) states: States,
    posterior: Option<Posterior>,
    looked: Mutex<HashMap<Look, Looked>>,
}

/// Whose first look it is: row, start and seed of a point.
type Look = (usize, Start, u64);

/// The members of a first look, with the states that they began from by their numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct Looked {
    pub members: Members,
    pub begun: BTreeMap<u32, Begun>,
}

/// Why a sample is not kept next to the plan.
#[derive(Debug, thiserror::Error)]
pub enum KeepError {
    /// It cannot be used.
    #[error(transparent)]
    Sample(#[from] UncertaintyError),
    /// The file cannot be copied.
    #[error("{file}: cannot be copied to {copy}: {reason}")]
    Copy {
        /// The file.
        file: String,
        /// Where it would be.
        copy: String,
        /// The system's reason.
        reason: std::io::Error,
    },
}

impl Shared {
    /// Of a directory with a plan whose configuration is `config`: with the copy of the sample that it names, where members are
    /// plausible tools.
    ///
    /// # Errors
    /// When the copy is missing, is another file, or does not belong to the configuration.
    pub fn of(directory: &Path, plan: &Plan, config: &Config) -> Result<Self, UncertaintyError> {
        let names_one = config.ensemble.as_ref().is_some_and(|of| of.posterior().is_some());
        let posterior = match plan.runs.plausible && names_one {
            true => Some(Posterior::load(&directory.join(FILE), config)?),
            false => None,
        };
        Ok(Self::with(posterior))
    }

    /// With a sample that was read.
    pub fn with(posterior: Option<Posterior>) -> Self {
        Self {
            posterior,
            ..Self::default()
        }
    }

    /// Copies a sample next to a plan, so that other machines that share the directory draw the same tools.
    ///
    /// # Errors
    /// When the file cannot be read, or the copy not be written.
    pub fn keep(posterior: &Posterior, directory: &Path) -> Result<(), KeepError> {
        let copy = directory.join(FILE);
        std::fs::read(posterior.file())
            .and_then(|bytes| {
                std::fs::create_dir_all(directory)?;
                flexdrill_sweep::directory::write_whole(&copy, &bytes).map_err(std::io::Error::other)
            })
            .map_err(|reason| KeepError::Copy {
                file: posterior.file().to_owned(),
                copy: copy.display().to_string(),
                reason,
            })
    }

    /// Keeps a first look in memory for the run of all its members, which begins with it.
    pub(super) fn keep_look(&self, point: &Point, looked: Looked) {
        let mut all = self.looked.lock().unwrap_or_else(PoisonError::into_inner);
        all.insert((point.row, point.start, point.seed), looked);
    }

    /// The first look of a point, where this process made it; without it, its member is run again, to the same bits.
    pub(super) fn look(&self, point: &Point) -> Looked {
        let mut all = self.looked.lock().unwrap_or_else(PoisonError::into_inner);
        all.remove(&(point.row, point.start, point.seed)).unwrap_or_default()
    }

    /// What plausible tools of a configuration of the plan are drawn from.
    ///
    /// # Errors
    /// When it has no priors, or the sample has a key without one.
    pub fn priors(&self, config: &Config) -> Result<Priors, UncertaintyError> {
        let priors = Priors::of(config)?;
        match &self.posterior {
            Some(posterior) => Ok(priors.drawn_from(posterior)?),
            None => Ok(priors),
        }
    }

    /// The sample with its provenance, for a map.
    pub fn sample(&self) -> Option<Sample> {
        let of = self.posterior.as_ref()?;
        let from = &of.provenance;
        let members = of.members().len() as u32;
        Some(Sample {
            sha256: of.sha256().to_owned(),
            version: from.version.clone(),
            log: from.log.clone(),
            log_sha256: from.sha256.clone(),
            rows: from.rows,
            members,
            // Equal weights amount to all members, but for the last bit.
            effective: of.effective_number().min(f64::from(members)),
            keys: of.keys().to_vec(),
        })
    }
}
