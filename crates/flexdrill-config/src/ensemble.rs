//! `ensemble`: plausible tools that run with the twin.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Bound, Checker};
use super::section::section;
use super::{Config, ConfigError};

const MEMBERS: Bound = Bound::within(8.0, 256.0);

/// Plausible tools that run with the twin, for bands and chances on `twin/bands`: tools drawn from `uncertainty`, under the
/// same inputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Ensemble {
    /// Their number, or `auto` for as many as the computer runs in the time that the twin leaves. A replay of a recording
    /// has those of the recorded run; one of a log has none with `auto`. Default auto.
    pub members: Members,
    /// Seed of all draws. Default 1.
    pub seed: u64,
    /// What the tools are drawn from: the `prior`, which is `uncertainty`, or `{posterior: FILE}`, the sample that `flexdrill
    /// calibrate` has written for this tool. Keys that the sample leaves out come from the prior. A relative path is relative
    /// to the folder of the configuration. Default prior.
    pub from: DrawnFrom,
    /// SHA-256 of the posterior's file, in hex; another file is refused. A node adds it to the configuration that it records,
    /// so that a replay draws the same tools. Default none, any file.
    pub posterior_sha256: Option<String>,
    /// Figures whose bands are wider than those of the members, because the truth was outside too often on rigs of another
    /// structure than the model's. Default none, a factor of 1 each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub band_factors: Vec<BandFactor>,
}

section! {
    /// By how much the bands of a figure are widened.
    pub struct BandFactor(this) {
        /// Name of the figure on `twin/bands`: topic and field, such as `transfer/bit_torque`. Required.
        figure: String;
        /// Factor on the distance of both ends of the band from its middle. Required.
        factor: f64, within(1.0, 20.0), "", "a band is never narrower than the members', and one of 20 times their width says that they miss what matters";
        /// Where the factor comes from: the rigs that it was measured on, and how many. Required.
        source: String;
    }
}

/// What plausible tools are drawn from.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DrawnFrom {
    /// The distributions of `uncertainty`.
    #[default]
    Prior,
    /// `{posterior: FILE}`: the sample in a file `posterior.csv` of `flexdrill calibrate`.
    Posterior(String),
}

/// `auto`, or a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(transform = MEMBERS.in_schema())]
pub enum Members {
    /// As many as the computer runs.
    Auto(Auto),
    /// So many.
    Count(u32),
}

/// The word for a number that is found while the program runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Auto {
    /// As many as the computer runs.
    Auto,
}

impl Default for Ensemble {
    fn default() -> Self {
        Self {
            members: Members::Auto(Auto::Auto),
            seed: 1,
            from: DrawnFrom::Prior,
            posterior_sha256: None,
            band_factors: Vec::new(),
        }
    }
}

impl Ensemble {
    /// The file of the posterior, where the tools are drawn from one.
    pub fn posterior(&self) -> Option<&str> {
        match &self.from {
            DrawnFrom::Prior => None,
            DrawnFrom::Posterior(file) => Some(file),
        }
    }

    /// Checks the section; `uncertain` says whether the file states what is not known.
    pub(super) fn check(&self, c: &mut Checker, uncertain: bool) {
        if let Members::Count(count) = self.members {
            c.count(
                "members",
                count as usize,
                MEMBERS,
                "fewer than 8 have no band from 5 to 95 %, and more take more than a workstation has",
            );
        }
        // Without distributions the members would differ in nothing, and their bands would say that all is known.
        c.require(
            uncertain,
            "members",
            "ensemble",
            "",
            "given with uncertainty.keys or uncertainty.sensors",
            "all members would be the tool of the file",
        );
        let empty = self.posterior().is_some_and(|file| file.trim().is_empty());
        c.require(
            !empty,
            "from",
            "an empty name",
            "",
            "prior, or posterior with the name of a file",
            "an empty name is no sample",
        );
        self.check_band_factors(c);
        // A checksum that no file can have would refuse every file with a misleading reason.
        if let Some(digest) = &self.posterior_sha256 {
            c.require(
                digest.len() == 64 && digest.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f')),
                "posterior_sha256",
                digest,
                "",
                "64 digits from 0 to f, in small letters",
                "it is the checksum that names the file's content",
            );
            c.require(
                self.posterior().is_some(),
                "posterior_sha256",
                digest,
                "",
                "left out with from: prior",
                "a prior has no file",
            );
        }
    }
}

impl Ensemble {
    fn check_band_factors(&self, c: &mut Checker) {
        c.below("band_factors", |c| {
            for (index, of) in self.band_factors.iter().enumerate() {
                c.below(index, |c| {
                    of.check_numbers(c);
                    let before = self.band_factors[..index]
                        .iter()
                        .any(|before| before.figure == of.figure);
                    c.require(
                        !before,
                        "figure",
                        &of.figure,
                        "",
                        "given once",
                        "a figure has one factor",
                    );
                    c.require(
                        !of.source.trim().is_empty(),
                        "source",
                        "an empty text",
                        "",
                        "the rigs that the factor was measured on",
                        "a factor from nowhere is a guess",
                    );
                });
            }
        });
    }
}

impl Config {
    /// The same with so many plausible tools, also where the file has no section `ensemble`; `origin` stands for the file
    /// in errors.
    ///
    /// # Errors
    /// When the number is out of bounds, or the file does not state what is not known.
    pub fn with_members(&self, origin: &str, members: u32) -> Result<Self, ConfigError> {
        let mut with = self.clone();
        with.schema.ensemble.get_or_insert_default();
        with.with_values(origin, [("ensemble.members", members)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_given_to_a_file_with_and_without_the_section() {
        for text in [
            include_str!("../../../config/default.yaml"),
            include_str!("../../../config/rig.yaml"),
        ] {
            let config = Config::from_text("a file", text).unwrap();
            let with = config.with_members("--members", 12).unwrap();
            let members = with.ensemble.as_ref().map(|ensemble| ensemble.members);
            assert_eq!(members, Some(Members::Count(12)));
            assert!(config.with_members("--members", 7).is_err());
        }
        let known = Config::from_text("paper.yaml", include_str!("../../../config/paper.yaml")).unwrap();
        let error = known.with_members("--members", 8).unwrap_err().to_string();
        assert!(error.contains("uncertainty"), "{error}");
    }
}
