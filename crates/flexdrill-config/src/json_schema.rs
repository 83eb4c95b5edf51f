//! The schema as JSON Schema, for editors and for the reference: from the same types and doc comments.
//!
//! Words of the mechanics stand here again, since `flexdrill-core` knows nothing of files; a test holds them together.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

/// The schema of a configuration file: JSON Schema, draft 2020-12. `minimum` and `maximum` are the bounds of the
/// checks; limits that depend on other keys stand in the descriptions only.
pub fn json_schema() -> Value {
    let generator = SchemaSettings::draft2020_12().into_generator();
    let mut schema = generator.into_root_schema_for::<super::Schema>().to_value();
    if let Some(root) = schema.as_object_mut() {
        root.insert("title".to_owned(), "Configuration of flexdrill".into());
    }
    // Each layer's keys have defaults of their own, which the type cannot know.
    if let Some(layer) = schema.pointer_mut("/$defs/Layer").and_then(Value::as_object_mut) {
        layer.remove("required");
    }
    without_noise(&mut schema);
    schema
}

/// Takes out what says nothing to an editor, and joins the lines of each description.
fn without_noise(value: &mut Value) {
    match value {
        Value::Object(map) => {
            if map.get("format").is_some_and(|format| format == "double") {
                map.shift_remove("format");
            }
            if let Some(Value::String(text)) = map.get_mut("description") {
                *text = joined(text);
            }
            map.values_mut().for_each(without_noise);
        }
        Value::Array(items) => items.iter_mut().for_each(without_noise),
        _ => {}
    }
}

/// Paragraphs stay, lines within them are joined.
fn joined(text: &str) -> String {
    let paragraphs: Vec<String> = text
        .split("\n\n")
        .map(|paragraph| paragraph.split_whitespace().collect::<Vec<_>>().join(" "))
        .filter(|paragraph| !paragraph.is_empty())
        .map(|paragraph| bounds_for_a_reader(&paragraph).unwrap_or(paragraph))
        .collect();
    paragraphs.join("\n\n")
}

/// The bounds of a number as a reader of the file writes them: `86400` for `86_400.0`, a key for `this.key`.
fn bounds_for_a_reader(paragraph: &str) -> Option<String> {
    let bounds = paragraph.strip_prefix("Allowed: ")?;
    let words = bounds.split(' ').map(|word| {
        if word.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
            word.replace('_', "").trim_end_matches(".0").to_owned()
        } else {
            word.trim_start_matches("this.").to_owned()
        }
    });
    Some(format!("Allowed: {}.", words.collect::<Vec<_>>().join(" ")))
}

/// Which of the two pipes.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum Body {
    /// The flexible, rotating, jointed pipe.
    Pipe,
    /// The continuous guide pipe around it.
    Guide,
}

/// One of a node's six degrees of freedom.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum Direction {
    /// Along the axis.
    U,
    /// Horizontal transverse.
    V,
    /// Transverse in the well plane, towards the low side.
    W,
    /// Spin about the axis.
    Psi,
    /// Tilt about y.
    PhiY,
    /// Tilt about z.
    PhiZ,
}

/// How the weight on bit reaches the tool.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum WobPath {
    /// Upward on the guide's last node.
    Guide,
    /// The pipes' ends are tied axially.
    Shared,
}

/// How the friction of a gap layer follows from sliding.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum FrictionLaw {
    /// Around and along by themselves.
    Separate,
    /// Against the whole sliding velocity.
    Vector,
    /// Against the whole sliding velocity, and able to stick.
    Bristle,
}

/// How much mud moves with the pipes.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum AddedMass {
    /// None.
    None,
    /// As with small motion about the centre of each annulus.
    Concentric,
    /// More near the walls.
    Eccentric,
}

/// What mud takes from a body that squeezes it out.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum MudFilm {
    /// As about the centre.
    None,
    /// The full film of lubrication.
    Squeeze,
}

/// Damping by the mud's viscosity.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum MudDamping {
    /// None.
    None,
    /// Proportional to the relative velocity of the walls of an annulus.
    Viscous,
}

/// Where the weight on bit of the inputs is measured.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum WeightPlace {
    /// At the bit.
    Bit,
    /// At the kick-off, above the friction of the guide.
    Kickoff,
}

/// Kinds of joint between two links.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum JointKind {
    /// Cross (Hooke) joint with a bend limit.
    Universal,
    /// Constant velocity, with a bend limit.
    BallCage,
    /// A hinge with one free axis, for comparison only.
    Revolute,
}

/// The angle that a hinge keeps.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum HingeAngle {
    /// Links that are in line at rest.
    Straight,
    /// Links that keep the well's bend.
    AsBuilt,
}

/// How a link that tilts across its chord shortens along it.
#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[allow(dead_code, reason = "a schema only")]
pub(super) enum Shortening {
    /// Not at all, as in the paper.
    None,
    /// By the square of the tilt.
    SecondOrder,
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::de::DeserializeOwned;

    #[test]
    fn bounds_read_as_a_file_writes_them() {
        let text = joined("How long (s).\n\nAllowed: within 1.0 to 86_400.0 s");
        assert_eq!(text, "How long (s).\n\nAllowed: within 1 to 86400 s.");
        let text = joined("Allowed: above this.min_rpm to 1e-4 ");
        assert_eq!(text, "Allowed: above min_rpm to 1e-4.");
    }

    /// Words of an enumeration in the schema.
    fn words(schema: &Value) -> Vec<String> {
        let each = schema["oneOf"].as_array().map(Vec::as_slice).unwrap_or_default();
        each.iter()
            .map(|word| word["const"].as_str().unwrap().to_owned())
            .collect()
    }

    fn holds<Schema: JsonSchema, Real: DeserializeOwned>(count: usize) {
        let schema = SchemaSettings::draft2020_12()
            .into_generator()
            .into_root_schema_for::<Schema>()
            .to_value();
        let words = words(&schema);
        assert_eq!(words.len(), count, "{words:?}");
        for word in words {
            serde_json::from_value::<Real>(word.clone().into()).unwrap_or_else(|error| panic!("{word}: {error}"));
        }
    }

    #[test]
    fn words_are_those_of_the_mechanics() {
        use flexdrill_core::tool;
        // As many as `flexdrill_core::tool` has of each: a match there that is not whole does not compile.
        let bodies = |body| match body {
            tool::Body::Pipe | tool::Body::Guide => 2,
        };
        holds::<Body, tool::Body>(bodies(tool::Body::Pipe));
        let directions = |direction| match direction {
            tool::Direction::U
            | tool::Direction::V
            | tool::Direction::W
            | tool::Direction::Psi
            | tool::Direction::PhiY
            | tool::Direction::PhiZ => 6,
        };
        holds::<Direction, tool::Direction>(directions(tool::Direction::U));
        let paths = |path| match path {
            tool::WobPath::Guide | tool::WobPath::Shared => 2,
        };
        holds::<WobPath, tool::WobPath>(paths(tool::WobPath::Guide));
        let laws = |law| match law {
            tool::FrictionLaw::Separate | tool::FrictionLaw::Vector | tool::FrictionLaw::Bristle => 3,
        };
        holds::<FrictionLaw, tool::FrictionLaw>(laws(tool::FrictionLaw::Separate));
        let masses = |mass| match mass {
            tool::AddedMass::None | tool::AddedMass::Concentric | tool::AddedMass::Eccentric => 3,
        };
        holds::<AddedMass, tool::AddedMass>(masses(tool::AddedMass::None));
        let films = |film| match film {
            tool::MudFilm::None | tool::MudFilm::Squeeze => 2,
        };
        holds::<MudFilm, tool::MudFilm>(films(tool::MudFilm::None));
        let dampings = |damping| match damping {
            tool::MudDamping::None | tool::MudDamping::Viscous => 2,
        };
        holds::<MudDamping, tool::MudDamping>(dampings(tool::MudDamping::None));
        let places = |place| match place {
            tool::WeightPlace::Bit | tool::WeightPlace::Kickoff => 2,
        };
        holds::<WeightPlace, tool::WeightPlace>(places(tool::WeightPlace::Bit));
        let kinds = |kind| match kind {
            tool::JointKind::Universal | tool::JointKind::BallCage | tool::JointKind::Revolute => 3,
        };
        holds::<JointKind, tool::JointKind>(kinds(tool::JointKind::Universal));
        let angles = |angle| match angle {
            tool::HingeAngle::Straight | tool::HingeAngle::AsBuilt => 2,
        };
        holds::<HingeAngle, tool::HingeAngle>(angles(tool::HingeAngle::Straight));
        let shortenings = |shortening| match shortening {
            tool::Shortening::None | tool::Shortening::SecondOrder => 2,
        };
        holds::<Shortening, tool::Shortening>(shortenings(tool::Shortening::None));
    }

    /// Every key that a configuration can have is in the schema, with a description.
    #[test]
    fn every_key_is_described() {
        let schema = json_schema();
        let missing = undescribed(&schema, &schema, "");
        assert!(missing.is_empty(), "without a description: {}", missing.join(", "));
        for key in ["well", "tool", "inputs", "alarms", "outputs", "solver"] {
            assert!(schema["properties"].get(key).is_some(), "{key}");
        }
        let required = schema["required"].as_array().unwrap();
        assert_eq!(required.len(), 2, "{required:?}");
        assert_eq!(schema["additionalProperties"], false);
    }

    /// What in `value` the schema would refuse by its keys: unknown ones, and those that are missing.
    fn refused(root: &Value, schema: &Value, value: &Value, path: &str, wrong: &mut Vec<String>) {
        let schema = match schema.get("$ref").and_then(Value::as_str) {
            Some(reference) => root.pointer(reference.trim_start_matches('#')).unwrap(),
            None => schema,
        };
        if let (Some(properties), Some(keys)) = (schema["properties"].as_object(), value.as_object()) {
            for (key, below) in keys {
                match properties.get(key) {
                    Some(schema) => refused(root, schema, below, &format!("{path}.{key}"), wrong),
                    None => wrong.push(format!("{path}.{key} is unknown")),
                }
            }
            let required = schema["required"]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_str);
            let missing = required.filter(|key| !keys.contains_key(*key));
            wrong.extend(missing.map(|key| format!("{path}.{key} is missing")));
        }
        if let (Some(items), Some(values)) = (schema.get("items"), value.as_array()) {
            for value in values {
                refused(root, items, value, &format!("{path}[]"), wrong);
            }
        }
    }

    #[test]
    fn the_configurations_here_are_those_of_the_schema() {
        let schema = json_schema();
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config");
        let mut count = 0;
        for folder in [folder.to_owned(), format!("{folder}/verify")] {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.extension().is_some_and(|extension| extension == "yaml") {
                    let text = std::fs::read_to_string(&path).unwrap();
                    let mut wrong = Vec::new();
                    refused(
                        &schema,
                        &schema,
                        &serde_saphyr::from_str(&text).unwrap(),
                        "",
                        &mut wrong,
                    );
                    assert!(wrong.is_empty(), "{}: {}", path.display(), wrong.join(", "));
                    count += 1;
                }
            }
        }
        assert!(count > 10, "{count}");
        let (mut wrong, misspelt) = (Vec::new(), serde_json::json!({"well": {}, "tol": 1}));
        refused(&schema, &schema, &misspelt, "", &mut wrong);
        for part in [".tol is unknown", ".tool is missing", ".well.hole_diameter is missing"] {
            assert!(wrong.iter().any(|wrong| wrong == part), "{wrong:?}");
        }
    }

    fn undescribed(root: &Value, schema: &Value, path: &str) -> Vec<String> {
        let schema = match schema.get("$ref").and_then(Value::as_str) {
            Some(reference) => root.pointer(reference.trim_start_matches('#')).unwrap(),
            None => schema,
        };
        let mut missing = Vec::new();
        for (key, below) in schema["properties"].as_object().into_iter().flatten() {
            let path = format!("{path}.{key}");
            if below.get("description").is_none() {
                missing.push(path.clone());
            }
            missing.extend(undescribed(root, below, &path));
        }
        missing
    }
}
