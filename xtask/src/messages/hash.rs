//! RIHS01, ROS 2's type hash (REP-2016): SHA-256 over a canonical JSON of the type and all types it is made of.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use super::GenerateError;
use super::catalogue::Catalogue;
use super::definition::{Array, Base, Definition, Field, FieldType, Primitive, Value};

/// The hash of `definition` as ROS 2 writes it, `RIHS01_` and 64 hexadecimal digits.
///
/// # Errors
/// When it names a message that the catalogue does not have.
pub fn rihs01(definition: &Definition, catalogue: &Catalogue) -> Result<String, GenerateError> {
    let mut hash = String::from("RIHS01_");
    for byte in Sha256::digest(description(definition, catalogue)?) {
        let _ = write!(hash, "{byte:02x}");
    }
    Ok(hash)
}

/// The canonical JSON: keys in a fixed order, `, ` and `: ` between, referenced types sorted by name.
fn description(definition: &Definition, catalogue: &Catalogue) -> Result<String, GenerateError> {
    let referenced: BTreeSet<_> = catalogue
        .dependencies(definition)?
        .into_iter()
        .map(|dependency| (dependency.name.to_string(), individual(dependency)))
        .collect();
    let referenced: Vec<_> = referenced.into_iter().map(|(_, text)| text).collect();
    Ok(format!(
        r#"{{"type_description": {}, "referenced_type_descriptions": [{}]}}"#,
        individual(definition),
        referenced.join(", ")
    ))
}

fn individual(definition: &Definition) -> String {
    with_fields(definition, |each| field(&each.name, &each.kind))
}

/// The type alone as that JSON, with `default_value` where a field has one; the hash leaves those out.
pub(super) fn alone(definition: &Definition) -> String {
    with_fields(definition, |each| {
        let mut text = field(&each.name, &each.kind);
        if let Some(value) = &each.default {
            let closed = text.pop();
            let _ = write!(text, r#", "default_value": {:?}"#, shown(value));
            text.extend(closed);
        }
        text
    })
}

/// A default value as rosidl writes it.
fn shown(value: &Value) -> String {
    match value {
        Value::Bool(true) => "True".to_owned(),
        Value::Bool(false) => "False".to_owned(),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::Text(text) => text.clone(),
        Value::List(values) => format!("({})", values.iter().map(shown).collect::<Vec<_>>().join(", ")),
    }
}

fn with_fields(definition: &Definition, of: impl Fn(&Field) -> String) -> String {
    let mut fields: Vec<String> = definition.fields.iter().map(of).collect();
    if fields.is_empty() {
        let filler = FieldType {
            base: Base::Primitive(Primitive::Uint8),
            array: Array::Single,
        };
        fields.push(field(super::EMPTY_STRUCT_MEMBER, &filler));
    }
    format!(
        r#"{{"type_name": "{}", "fields": [{}]}}"#,
        definition.name,
        fields.join(", ")
    )
}

fn field(name: &str, kind: &FieldType) -> String {
    let (offset, capacity) = match kind.array {
        Array::Single => (0, 0),
        Array::Fixed(size) => (48, size),
        Array::Bounded(most) => (96, most),
        Array::Unbounded => (144, 0),
    };
    let (id, string_capacity, nested) = match &kind.base {
        Base::Nested(name) => (1, 0, name.to_string()),
        Base::Primitive(primitive) => {
            let (id, string_capacity) = type_id(*primitive);
            (id, string_capacity, String::new())
        }
    };
    format!(
        concat!(
            r#"{{"name": "{}", "type": {{"type_id": {}, "capacity": {}, "#,
            r#""string_capacity": {}, "nested_type_name": "{}"}}}}"#
        ),
        name,
        offset + id,
        capacity,
        string_capacity,
        nested
    )
}

/// Number of a built-in type in `type_description_interfaces/FieldType`, and a string's bound.
fn type_id(primitive: Primitive) -> (u32, u64) {
    match primitive {
        Primitive::Int8 => (2, 0),
        Primitive::Uint8 => (3, 0),
        Primitive::Int16 => (4, 0),
        Primitive::Uint16 => (5, 0),
        Primitive::Int32 => (6, 0),
        Primitive::Uint32 => (7, 0),
        Primitive::Int64 => (8, 0),
        Primitive::Uint64 => (9, 0),
        Primitive::Float32 => (10, 0),
        Primitive::Float64 => (11, 0),
        Primitive::Bool => (15, 0),
        Primitive::Byte => (16, 0),
        Primitive::String { bound: None } => (17, 0),
        Primitive::String { bound: Some(most) } => (21, most),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::definition::Source;

    /// Against hashes that ROS 2 itself has given: `example_interfaces/srv/AddTwoInts` in the design of rmw_zenoh, and
    /// `std_srvs/srv/Trigger` in the key of a service that rmw_zenoh called.
    #[test]
    fn services_have_the_hashes_that_ros_2_gives_them() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let mut catalogue = Catalogue::read(&root).unwrap();
        let text = "int64 a\nint64 b\n---\nint64 sum\n";
        catalogue
            .add_service("example_interfaces", "AddTwoInts", text, Source::Text)
            .unwrap();
        let hash = |name: &str| {
            let mut services = catalogue.services();
            let service = services.find(|service| service.whole.name.to_string() == name).unwrap();
            rihs01(&service.whole, &catalogue).unwrap()
        };
        assert_eq!(
            hash("example_interfaces/srv/AddTwoInts"),
            "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
        );
        assert_eq!(
            hash("std_srvs/srv/Trigger"),
            "RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f"
        );
    }
}
