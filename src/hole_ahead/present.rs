//! What a recording of the twin, or a state that it saved, says of the tool at its end: the parameters in force, the mean
//! weight that arrives at the bit, and the side force there.

use std::path::Path;

use flexdrill_config::{ChangedNumber, Config, ConfigError, FOLLOWED};
use flexdrill_core::tool::LiveParameters;
use flexdrill_core::twin::{BuildError, CheckpointError, Simulation};
use flexdrill_core::units::n_to_kn;
use flexdrill_hole::{HoleError, at_rest};
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{AppliedInputs, HoleAhead, Message, SessionInfo, Transfer};
use flexdrill_motion::BIT;

use super::{Drilling, tool};
use crate::bag::{self, BagError, BagMessage};
use crate::drilling::live::side_force_doubt;

/// A message of `twin/hole_ahead` is not used where one of `twin/transfer` is newer by more (ns): it waits up to half a minute
/// for its next metres, and a recording that ends leaves out those that wait.
const LATE: i64 = 10_000_000_000;
/// Digits of a configuration's hash in words.
const DIGITS: usize = 12;

/// Why nothing can be taken from a run.
#[derive(Debug, thiserror::Error)]
pub enum PresentError {
    /// The file cannot be read as a bag.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The file cannot be read at all.
    #[error("cannot read it: {0}; name a recording of the twin or a state that ~/save_checkpoint has written")]
    Read(#[from] std::io::Error),
    /// The bag lacks a topic that every recording of the twin has.
    #[error(
        "no message on {topic}: must be a recording of the twin; record with flexdrill run --record or ros2 bag record -a"
    )]
    Lacks {
        /// The topic.
        topic: &'static str,
    },
    /// The parameters of the run do not fit the configuration.
    #[error("the parameters in force: {0}; give the configuration of the run")]
    Config(#[from] ConfigError),
    /// The tool of the configuration cannot be built.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The state is not one of this tool.
    #[error(transparent)]
    State(#[from] CheckpointError),
}

/// A tool at the end of a run.
#[derive(Debug, Clone)]
pub struct Present {
    /// The configuration that was given, with the parameters in force.
    pub config: Config,
    /// Mean weight on the bit (N); 0 off bottom.
    pub weight: f64,
    /// Time that this mean covers (s); 0 for the weight of an instant.
    window: f64,
    /// What has the weight: a topic, or the state.
    source: &'static str,
    /// Force of the bit to the low side (N) and its standard error, which is NaN with fewer than three turns; none where the run
    /// does not have it.
    side_force: Option<[f64; 2]>,
    /// Configuration of the run (its hash), where it is not the one that was given.
    other: Option<String>,
    /// What changed the configuration.
    changed: Vec<String>,
    /// What could not be read.
    missing: Vec<String>,
}

impl Present {
    /// The end of the recording or the state in `path`, for the tool of a configuration.
    ///
    /// # Errors
    /// [`PresentError`], for a file that is neither or is one of another tool.
    pub fn read(path: &Path, config: &Config) -> Result<Self, PresentError> {
        if bag::is_bag(path)? {
            recorded(path, config)
        } else {
            saved(&std::fs::read(path)?, config)
        }
    }

    /// What was taken, in sentences. `origin` is the run and `given` the configuration, as named by the user; `asked` is a weight
    /// (N) that counts in place of the one that arrived.
    pub fn words(&self, origin: &str, given: &str, asked: Option<f64>) -> Vec<String> {
        let over = if self.window > 0.0 {
            format!("mean over its last {:.1} s", self.window)
        } else {
            "of its last instant".to_owned()
        };
        let instead = asked.map_or_else(String::new, |asked| {
            format!(", in place of which --weight asks for {:.2} kN", n_to_kn(asked))
        });
        let mut lines = vec![format!(
            "From {origin}: {:.2} kN arrive at the bit, {over} ({}){instead}.",
            n_to_kn(self.weight),
            self.source
        )];
        lines.push(if self.changed.is_empty() {
            format!("The parameters in force at its end are those of {given}.")
        } else {
            format!("Parameters in force at its end: {}.", self.changed.join("; "))
        });
        if let Some(hash) = &self.other {
            let hash = hash.get(..DIGITS).unwrap_or(hash);
            lines.push(format!(
                "The run had another configuration ({hash}): tool, hole and plan here are those of {given}."
            ));
        }
        lines.extend(self.missing.iter().map(|missing| format!("Not read: {missing}.")));
        lines
    }

    /// How the side force of the run compares with that of the guide at rest in the hole, which is grown with it, in a sentence;
    /// none off bottom, and where the run does not have it.
    ///
    /// # Errors
    /// When the statics have no solution.
    pub fn side_force(&self, drilling: &Drilling) -> Result<Option<String>, HoleError> {
        let Some([force, error]) = self.side_force.filter(|_| self.weight > 0.0) else {
            return Ok(None);
        };
        // The run had the weight that arrived, whatever weight is asked for.
        let rest = at_rest(&tool::guide(&self.config, self.weight), self.weight, &drilling.hole)?
            .side_force
            .y;
        let doubt = side_force_doubt(rest, self.weight, [force, error]);
        Ok(Some(doubt.map_or_else(
            || {
                format!(
                    "The bit of the run pushes {force:.0} N to the low side, and the guide at rest {rest:.0} N: they agree."
                )
            },
            |why| format!("Doubtful: {why}."),
        )))
    }
}

/// The newest messages of a recording.
#[derive(Default)]
struct Newest {
    session: Option<BagMessage>,
    applied: Option<BagMessage>,
    transfer: Option<BagMessage>,
    hole: Option<BagMessage>,
}

fn newest<M: Message>(message: Option<&BagMessage>) -> Result<Option<M>, BagError> {
    message.map(BagMessage::decode).transpose()
}

fn recorded(path: &Path, config: &Config) -> Result<Present, PresentError> {
    let mut bag = bag::open(path)?;
    // The names decide where there are several topics of a type; two twins in one bag are refused by `topic_of_type`.
    let named = |topic: &TopicInfo| match bag.topic_of_type(topic.name, topic.kind.ros_type) {
        Ok(found) => Ok(Some(found.name.clone())),
        Err(BagError::NoTopic { .. }) => Ok(None),
        Err(error) => Err(error),
    };
    let [session, applied, transfer, hole] = [
        named(&topics::SESSION)?,
        named(&topics::APPLIED_INPUTS)?,
        named(&topics::TRANSFER)?,
        named(&topics::HOLE_AHEAD)?,
    ];
    let mut missing: Vec<String> = bag.faults().iter().map(ToString::to_string).collect();
    let wanted = [session, applied, transfer, hole];
    bag.select(|topic| wanted.iter().flatten().any(|name| *name == topic.name));
    let mut found = Newest::default();
    for message in bag.by_ref() {
        let message = match message {
            Err(error @ BagError::Damaged { .. }) => {
                missing.push(error.to_string());
                continue;
            }
            message => message?,
        };
        let kept = [
            &mut found.session,
            &mut found.applied,
            &mut found.transfer,
            &mut found.hole,
        ];
        let of = wanted
            .iter()
            .position(|name| name.as_deref() == Some(&message.topic.name));
        for (index, newest) in kept.into_iter().enumerate() {
            if of == Some(index) {
                *newest = Some(message.clone());
            }
        }
    }
    missing.extend(
        bag.cuts()
            .map(|cut| format!("{} after a cut ({})", cut.path.display(), cut.reason)),
    );
    let lacks = |topic: &TopicInfo| PresentError::Lacks { topic: topic.name };
    let session: SessionInfo = newest(found.session.as_ref())?.ok_or_else(|| lacks(&topics::SESSION))?;
    let applied: AppliedInputs = newest(found.applied.as_ref())?.ok_or_else(|| lacks(&topics::APPLIED_INPUTS))?;
    let transfer: Transfer = newest(found.transfer.as_ref())?.ok_or_else(|| lacks(&topics::TRANSFER))?;
    // Means over whole turns are the better ones, where they are as new.
    let hole = newest::<HoleAhead>(found.hole.as_ref())?.filter(|hole| {
        let [hole, transfer] = [&hole.header, &transfer.header].map(|header| header.stamp.to_nanoseconds());
        transfer - hole <= LATE
    });
    let names = applied.parameter_name.iter().zip(applied.parameter_value);
    let live = LiveParameters {
        inner_friction: applied.inner_friction,
        outer_friction: applied.outer_friction,
        bit_friction_factor: applied.bit_friction_factor,
    };
    let now = in_force(&config.with_live_values("recorded parameters", names)?, &live)?;
    let (weight, window, source) = match &hole {
        Some(hole) => (hole.weight_on_bit, hole.window, topics::HOLE_AHEAD.name),
        None => (transfer.bit_weight, transfer.duration, topics::TRANSFER.name),
    };
    Ok(Present {
        changed: changes(config, &now),
        config: now,
        weight,
        window,
        source,
        side_force: hole.map(|hole| [hole.side_force_low, hole.side_force_low_error]),
        other: Some(session.config_hash).filter(|hash| *hash != config.hash()),
        missing,
    })
}

fn saved(bytes: &[u8], config: &Config) -> Result<Present, PresentError> {
    let mut simulation = Simulation::new(&config.tool(), &config.simulation())?;
    simulation.restore(bytes)?;
    let mut snapshot = simulation.new_snapshot();
    simulation.snapshot(&mut snapshot, false);
    let now = in_force(config, &simulation.live())?;
    // Before the first tenth of a second there are no means.
    let transfer = &snapshot.transfer;
    let (weight, window) = if transfer.duration > 0.0 {
        (transfer.weight.mean[BIT], transfer.duration)
    } else {
        (snapshot.applied.weight_on_bit, 0.0)
    };
    Ok(Present {
        changed: changes(config, &now),
        config: now,
        weight,
        window,
        source: "the state",
        // A state has no means over whole turns of the bit.
        side_force: None,
        other: None,
        missing: Vec::new(),
    })
}

/// A configuration whose friction and bit have these coefficients.
fn in_force(config: &Config, live: &LiveParameters) -> Result<Config, ConfigError> {
    let now = config.live();
    // The coefficients that act have the factors of the calibration, the keys do not.
    let factors = [config.motion_factor(), config.calibration.friction_factor];
    let layers = [
        ("inner", now.inner_friction, live.inner_friction),
        ("outer", now.outer_friction, live.outer_friction),
    ];
    let mut values = Vec::new();
    for (layer, now, live) in layers {
        for (index, direction) in ["tangential", "axial"].into_iter().enumerate() {
            // A value that stays keeps its bits, which a division by the factor may change.
            if now[index] != live[index] {
                let key = format!("contact.{layer}.friction_{direction}");
                values.push((key, live[index] / factors[index]));
            }
        }
    }
    if now.bit_friction_factor != live.bit_friction_factor {
        values.push(("tool.bit.friction_factor".to_owned(), live.bit_friction_factor));
    }
    config.with_live_values("parameters in force", values)
}

/// What a configuration differs in from the one that was given, by keys.
fn changes(given: &Config, now: &Config) -> Vec<String> {
    let [before, after] = [given, now].map(Config::numbers);
    let value = |numbers: &[flexdrill_config::NumberKey], key: &str| {
        numbers
            .iter()
            .find(|number| number.key == key)
            .map(|number| number.value)
    };
    let followed = FOLLOWED.iter().filter_map(|key| {
        let (from, to) = value(&before, key).zip(value(&after, key))?;
        Some(ChangedNumber {
            key: (*key).to_owned(),
            from,
            to,
            unit: "",
        })
    });
    let followed = followed.filter(|change| given.calibration.follow && change.from != change.to);
    now.changed_since(given)
        .into_iter()
        .chain(followed)
        .map(|change| change.to_string())
        .collect()
}
