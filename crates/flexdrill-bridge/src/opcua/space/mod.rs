//! The nodes of the server: what each variable is, and its value from the twin's messages.

mod status;

use ::opcua::types::{DataTypeId, Variant};
use flexdrill_core::inputs::{InputKind, Unit};
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{Bands, FigureBand, Residual, SafeWindow};
use flexdrill_outputs::figures::OverTools;

use super::state::{Meaning, TwinState};
use crate::Figure;

/// The namespace of the nodes.
pub const NAMESPACE: &str = "urn:flexdrill:twin";
/// Node of the object that all others are below.
pub const ROOT: &str = "twin";
/// Folder of the alarms.
pub const ALARMS: &str = "alarms";
/// Folder of the targets that a user may write.
pub const TARGETS: &str = "targets";

/// The type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number with a unit.
    Number(Unit),
    /// Several of them.
    Numbers(Unit),
    /// A text.
    Text,
    /// Yes or no.
    Flag,
    /// A code or a count.
    Count,
    /// Several codes.
    Codes,
}

impl Kind {
    /// The type of its values.
    pub const fn data_type(self) -> DataTypeId {
        match self {
            Self::Number(_) | Self::Numbers(_) => DataTypeId::Double,
            Self::Text => DataTypeId::String,
            Self::Flag => DataTypeId::Boolean,
            Self::Count => DataTypeId::UInt64,
            Self::Codes => DataTypeId::Byte,
        }
    }

    /// Whether its values are arrays.
    pub const fn is_array(self) -> bool {
        matches!(self, Self::Numbers(_) | Self::Codes)
    }

    /// The unit, if it has one.
    pub const fn unit(self) -> Option<Unit> {
        match self {
            Self::Number(unit) | Self::Numbers(unit) => Some(unit),
            Self::Text | Self::Flag | Self::Count | Self::Codes => None,
        }
    }
}

type Read = Box<dyn Fn(&TwinState) -> Option<Variant> + Send + Sync>;

/// A variable.
pub struct Variable {
    /// Its folder below the root.
    pub folder: &'static str,
    /// Its name in the folder; `folder/name` is its node id. A name with a slash is in a folder of its own below.
    pub name: String,
    /// What it is.
    pub description: String,
    /// Its type.
    pub kind: Kind,
    /// The topic that it comes from.
    pub topic: &'static TopicInfo,
    /// What makes it doubtful.
    pub meaning: Meaning,
    figure: Option<Figure>,
    read: Read,
}

impl Variable {
    /// The value; `None` where the twin has none.
    pub fn value(&self, twin: &TwinState) -> Option<Variant> {
        (self.read)(twin)
    }

    /// When the twin computed the value (ns since 1970, on the rig's clock).
    pub fn stamp(&self, twin: &TwinState) -> Option<i64> {
        if let Some(figure) = self.figure {
            return twin.figures().stamp(figure);
        }
        let header = match self.topic.name {
            name if name == topics::STATUS.name => &twin.status()?.header,
            name if name == topics::RESIDUALS.name => &twin.residuals()?.header,
            name if name == topics::SAFE_WINDOW.name => &twin.window()?.header,
            name if name == topics::BANDS.name => &twin.bands()?.header,
            _ => return None,
        };
        Some(header.stamp.to_nanoseconds())
    }

    fn new(
        folder: &'static str,
        name: impl Into<String>,
        description: impl Into<String>,
        kind: Kind,
        topic: &'static TopicInfo,
        read: impl Fn(&TwinState) -> Option<Variant> + Send + Sync + 'static,
    ) -> Self {
        Self {
            folder,
            name: name.into(),
            description: description.into(),
            kind,
            topic,
            meaning: Meaning::Stated,
            figure: None,
            read: Box::new(read),
        }
    }

    fn meaning(mut self, meaning: Meaning) -> Self {
        self.meaning = meaning;
        self
    }
}

/// A number, if it is one.
pub(super) fn number(value: f64) -> Option<Variant> {
    value.is_finite().then(|| Variant::from(value))
}

/// All variables but those of the alarms, which the twin names.
pub fn variables() -> Vec<Variable> {
    let mut all: Vec<Variable> = Figure::all().map(of_figure).collect();
    all.extend(status::of_status());
    all.extend(InputKind::ALL.into_iter().flat_map(status::of_input));
    all.extend(of_residuals());
    all.extend(of_window());
    all.extend(of_bands());
    all
}

fn of_figure(figure: Figure) -> Variable {
    let topic = figure.topic;
    let kind = Kind::Number(figure.dimension.si());
    let read = move |twin: &TwinState| twin.figures().value(figure).map(Variant::from);
    let stated = topic.name == topics::STATUS.name || topic.name == topics::ALARMS.name;
    let on_change = topic.name == topics::WHIRL_WARNINGS.name || topic.name == topics::ALARMS.name;
    let mut variable = Variable::new("figures", figure.name, figure.description, kind, topic, read).meaning(
        match (stated, on_change) {
            (true, true) => Meaning::StatedOnChange,
            (true, false) => Meaning::Stated,
            (false, true) => Meaning::ComputedOnChange,
            (false, false) => Meaning::Computed,
        },
    );
    variable.figure = Some(figure);
    variable
}

/// The quantities that are compared, in their SI units.
const COMPARED: [(&str, Unit); 5] = [
    ("surface_torque", Unit::NewtonMetre),
    ("hook_load", Unit::Newton),
    ("downhole_rotary_speed", Unit::RadianPerSecond),
    ("downhole_torque", Unit::NewtonMetre),
    ("downhole_weight_on_bit", Unit::Newton),
];

fn of_residuals() -> Vec<Variable> {
    let mut all = Vec::new();
    // All quantities have the same five variables; those that the rig does not measure have no value.
    for (quantity, unit) in COMPARED {
        let mut add = |name: &str, description: &str, unit, read: fn(&Residual) -> f64| {
            let read = move |twin: &TwinState| {
                // By name: the message has only what was compared.
                let residuals = &twin.residuals()?.residuals;
                number(read(residuals.iter().find(|residual| residual.name == quantity)?))
            };
            let name = format!("{quantity}/{name}");
            all.push(
                Variable::new(
                    "residuals",
                    name,
                    description,
                    Kind::Number(unit),
                    &topics::RESIDUALS,
                    read,
                )
                // As `Computed` it is as good as the inputs and the model, and the client sees that in its quality.
                .meaning(Meaning::Computed),
            );
        };
        add("measured", "Sliding mean of what the rig measures", unit, |residual| {
            residual.measured
        });
        add("predicted", "The same of what the twin computes", unit, |residual| {
            residual.predicted
        });
        add("low", "Lower end of the band of nine means of ten", unit, |residual| {
            residual.low
        });
        add("high", "Upper end of the band of nine means of ten", unit, |residual| {
            residual.high
        });
        add(
            "ratio",
            "Measured less predicted over half of the band; one of ten lies beyond -1 to 1",
            Unit::One,
            |residual| residual.ratio,
        );
    }
    // Without steady motion the residuals say nothing, so a client must read this one first.
    all.push(
        Variable::new(
            "residuals",
            "steady",
            "Speed and weight are steady, and all inputs are good",
            Kind::Flag,
            &topics::RESIDUALS,
            |twin| Some(Variant::from(twin.residuals()?.steady)),
        )
        .meaning(Meaning::Computed),
    );
    all.push(
        Variable::new(
            "residuals",
            "likely_causes",
            "What residuals beyond their bands may mean, the likeliest first",
            Kind::Text,
            &topics::RESIDUALS,
            // A list as one text: many clients of historians store no arrays of text.
            |twin| Some(Variant::from(twin.residuals()?.likely_causes.join("; "))),
        )
        .meaning(Meaning::Computed),
    );
    all
}

fn of_window() -> Vec<Variable> {
    let new = |name: &str, description: &str, kind, read: fn(&SafeWindow) -> Variant| {
        Variable::new(
            "safe_window",
            name,
            description,
            kind,
            &topics::SAFE_WINDOW,
            move |twin| Some(read(twin.window()?)),
        )
        // The map is stated once and holds until another is loaded, so its
        // quality depends on the heartbeat and not on its own age.
        .meaning(Meaning::StatedOnChange)
    };
    vec![
        new(
            "rotary_speed",
            "Rotary speeds of the cells, rising",
            Kind::Numbers(Unit::TurnPerMinute),
            |window| Variant::from(window.rotary_speed_rpm.clone()),
        ),
        new(
            "weight_on_bit",
            "Weights on bit of the cells, rising",
            Kind::Numbers(Unit::Kilonewton),
            |window| Variant::from(window.weight_on_bit_kn.clone()),
        ),
        new(
            "verdict",
            "Row by row of the weight: 0 clear, 1 alarm, 2 depends on the start, 3 unknown (a run failed), 4 not known",
            Kind::Codes,
            |window| Variant::from(window.verdict.clone()),
        ),
        new(
            "chance",
            "Row by row of the weight: largest chance of any alarm",
            Kind::Numbers(Unit::One),
            |window| Variant::from(window.chance.clone()),
        ),
        new(
            "limit",
            "Chance above which an alarm must be expected",
            Kind::Number(Unit::One),
            |window| Variant::from(window.limit),
        ),
        new(
            "horizon",
            "Model time that each run of the map was judged over",
            Kind::Number(Unit::Second),
            |window| Variant::from(window.horizon),
        ),
    ]
}

/// The ends and the median of a band.
type Quantile = fn(&FigureBand) -> f64;
const QUANTILES: [(&str, &str, Quantile); 3] = [
    ("p5", "5 % of the plausible tools lie below", |band| band.p5),
    ("p50", "half of the plausible tools lie below", |band| band.p50),
    ("p95", "95 % of the plausible tools lie below", |band| band.p95),
];

/// Plausible tools: a variable for each quantile of each figure that is compared over them, and what they are.
fn of_bands() -> Vec<Variable> {
    let new = |name: String, description: String, kind, read: Read| {
        Variable::new("bands", name, description, kind, &topics::BANDS, read).meaning(Meaning::Computed)
    };
    let mut all = Vec::new();
    for figure in OverTools::known() {
        // A power has no unit of an input; powers are not compared.
        let Some(dimension) = figure.dimension else { continue };
        for (quantile, words, of) in QUANTILES {
            let name = figure.name.clone();
            let read: Read = Box::new(move |twin| {
                // By name: a later twin may compare others.
                let band = twin.bands()?.bands.iter().find(|band| band.name == name)?;
                number(of(band))
            });
            all.push(new(
                format!("{}/{quantile}", figure.name.replace('/', "_")),
                format!("{} Over the last second, {words}", figure.text),
                Kind::Number(dimension.si()),
                read,
            ));
        }
    }
    let mut add = |name: &str, description: &str, kind, read: fn(&Bands) -> Option<Variant>| {
        let read: Read = Box::new(move |twin| read(twin.bands()?));
        all.push(new(name.to_owned(), description.to_owned(), kind, read));
    };
    add("members", "Plausible tools that run", Kind::Count, |bands| {
        Some(Variant::from(u64::from(bands.members)))
    });
    add("failed", "Those that could not be computed", Kind::Count, |bands| {
        Some(Variant::from(u64::from(bands.failed)))
    });
    let one = Kind::Number(Unit::One);
    add(
        "effective",
        "Number of members alike that they amount to",
        one,
        |bands| number(bands.effective),
    );
    add(
        "any_alarm",
        "Share of them in which any alarm of the tool stands",
        one,
        |bands| number(bands.any_alarm),
    );
    add("any_alarm_lower", "Lower end of its 95 % interval", one, |bands| {
        number(bands.any_alarm_lower)
    });
    add("any_alarm_upper", "Upper end of its 95 % interval", one, |bands| {
        number(bands.any_alarm_upper)
    });
    add(
        "no_bands",
        "Why there are no bands; empty where there are",
        Kind::Text,
        |bands| Some(Variant::from(bands.no_bands.clone())),
    );
    all
}

#[cfg(test)]
mod tests;
