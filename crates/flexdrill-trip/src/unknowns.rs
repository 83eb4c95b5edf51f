//! Plausible tools for a trip: what is not known of friction, guide and hole.
//!
//! Keys in `uncertainty.keys` of the configuration have its distributions. The others that decide a trip have those of
//! [`UNKNOWN`].

use flexdrill_config::{Config, ConfigError, Distribution, Form, UncertainKey};
use flexdrill_uncertainty::{Priors, UncertaintyError};

/// Friction within a factor of two, as 0.20 to 0.40 in water-base mud (SPE 11380).
const FRICTION: Distribution = Distribution::LogNormal { low: 0.7, high: 1.4 };

/// A key that is not known, with the keys that have the same draw.
type Unknown = (&'static str, &'static [&'static str], Distribution, Form);

/// What decides a trip and is not known.
pub const UNKNOWN: [Unknown; 7] = [
    ("string.friction.coefficient", &[], FRICTION, Form::Factor),
    (
        "contact.outer.friction_axial",
        &["contact.outer.friction_tangential"],
        FRICTION,
        Form::Factor,
    ),
    (
        "contact.inner.friction_tangential",
        &["contact.inner.friction_axial"],
        FRICTION,
        Form::Factor,
    ),
    (
        "tool.guide.bending_factor",
        &[],
        Distribution::LogNormal { low: 0.75, high: 1.33 },
        Form::Factor,
    ),
    (
        "tool.guide.free_curvature",
        &[],
        Distribution::Normal { low: 0.98, high: 1.02 },
        Form::Factor,
    ),
    (
        "well.hole_diameter",
        &[],
        Distribution::Uniform { low: 0.0, high: 0.004 },
        Form::Offset,
    ),
    (
        "environment.buoyancy_factor",
        &[],
        Distribution::Normal {
            low: -0.0042,
            high: 0.0042,
        },
        Form::Offset,
    ),
];

/// Why there are no plausible tools.
#[derive(Debug, thiserror::Error)]
pub enum UnknownsError {
    /// A distribution does not hold for the configuration.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The priors cannot be drawn.
    #[error(transparent)]
    Priors(#[from] UncertaintyError),
}

/// The priors of a configuration with what it leaves out.
///
/// # Errors
/// When they do not hold for the configuration.
pub fn priors(config: &Config) -> Result<Priors, UnknownsError> {
    let mut schema = (**config).clone();
    let mut stated = schema.uncertainty.take().unwrap_or_default();
    let numbers = config.numbers();
    // What a file leaves out has no distribution, no factor is drawn on nothing, and a limit of a key, such as that of a tube
    // without slots, is known.
    let holds = |name: &str, distribution: &Distribution, form: Form| {
        let number = numbers.iter().find(|number| number.key == name);
        number.is_some_and(|number| {
            let ends = distribution.ends().map(|end| form.value(end, number.value));
            (form == Form::Offset || number.value != 0.0)
                && ends.iter().all(|end| (number.low..=number.high).contains(end))
        })
    };
    for (key, also, distribution, form) in UNKNOWN {
        let names = || std::iter::once(&key).chain(also).copied();
        // A key that the configuration draws keeps its distribution, whatever shares the draw here.
        let mut left: Vec<String> = names()
            .filter(|name| stated.position(name).is_none())
            .filter(|name| holds(name, &distribution, form))
            .map(str::to_owned)
            .collect();
        if left.is_empty() {
            continue;
        }
        stated.keys.push(UncertainKey {
            key: left.remove(0),
            also: left,
            distribution,
            form,
            source: "assumption of a trip".to_owned(),
        });
    }
    schema.uncertainty = Some(stated);
    let config = Config::from_schema("plausible tools", schema)?;
    Ok(Priors::of(&config)?)
}
