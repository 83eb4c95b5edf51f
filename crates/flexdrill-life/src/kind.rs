//! What a damage means: of which joint, of which class. Damages of one kind add up.

use flexdrill_config::Config;
use flexdrill_motion::Detail;

use super::{LifeError, text};

/// The kind of the joints in a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Kind {
    /// Sections of the pipe, as JSON.
    pub pipe: String,
    /// Kind of joint.
    pub joint: String,
    /// The class in words.
    pub class: String,
    /// What surrounds the joints.
    pub environment: String,
    /// The stop, and the middle of the link below it.
    pub details: [Detail; 2],
    /// Inverse of the part of a life after which a joint is listed. Tables of one kind may differ in it.
    pub design_factor: f64,
}

impl Kind {
    /// The kind of the joints of a configuration.
    ///
    /// # Errors
    /// When it states no class.
    pub fn of(config: &Config) -> Result<Self, LifeError> {
        let (Some(life), Some(details)) = (config.tool.joint.life, config.joint_details()) else {
            return Err(LifeError::NoClass);
        };
        let tree = config.to_tree();
        let at = |pointer: &str| tree.pointer(pointer).map(ToString::to_string).unwrap_or_default();
        Ok(Self {
            pipe: at("/tool/pipe"),
            joint: at("/tool/joint/kind").trim_matches('"').to_owned(),
            class: life.class_in_words(),
            environment: life.environment.word().to_owned(),
            details: details.map(rounded),
            design_factor: life.design_factor,
        })
    }

    /// Its lines in a table: names with what they are.
    pub fn lines(&self) -> [(&'static str, String); 7] {
        let detail = |detail: &Detail| serde_json::to_string(detail).unwrap_or_default();
        [
            ("tool.pipe", self.pipe.clone()),
            ("tool.joint.kind", self.joint.clone()),
            ("class", self.class.clone()),
            ("environment", self.environment.clone()),
            ("stop", detail(&self.details[0])),
            ("link", detail(&self.details[1])),
            ("design factor", text::number(self.design_factor)),
        ]
    }

    /// The first line that differs from another kind's; the design factor may.
    ///
    /// # Errors
    /// When one does. `file` stands for this one's table.
    pub(crate) fn is_of(&self, file: &str, run: &Self) -> Result<(), LifeError> {
        let mut pairs = self.lines().into_iter().zip(run.lines()).take(6);
        match pairs.find(|(of_file, of_run)| of_file != of_run) {
            None => Ok(()),
            Some(((what, of_file), (_, of_run))) => Err(LifeError::OtherKind {
                file: file.to_owned(),
                what,
                of_file,
                of_run,
            }),
        }
    }
}

/// With nine digits, which are more than any class has: machines differ in the last digits of logarithms.
fn rounded(detail: Detail) -> Detail {
    let mut out = detail;
    for value in [
        &mut out.line.log_cycles,
        &mut out.line.slope,
        &mut out.line.knee,
        &mut out.line.slope_below_knee,
        &mut out.line.scatter,
        &mut out.section_modulus,
        &mut out.stress_concentration,
        &mut out.stress_concentration_scatter,
    ] {
        *value = text::rounded(*value);
    }
    out
}
