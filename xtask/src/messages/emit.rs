//! Rust source of the messages.

use std::fmt::Write as _;

use super::catalogue::Catalogue;
use super::definition::{Array, Base, Definition, Field, FieldType, Primitive, Source, TypeName, Value};
use super::{EMPTY_STRUCT_MEMBER, GenerateError, hash, schema};

/// Arrays up to this length have `Default` and serde support in the standard library and in serde.
const LARGEST_PLAIN_ARRAY: u64 = 32;

/// Words that a Rust field cannot be called; they get an underscore behind.
const KEYWORDS: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn", "else",
    "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod",
    "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super", "trait", "true",
    "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// The whole file: one module per package, then the table of all types.
pub(super) fn source(catalogue: &Catalogue) -> Result<String, GenerateError> {
    let mut out = String::from(concat!(
        "//! Generated from `msg/` and `crates/flexdrill-messages/external/` by `cargo xtask messages`. Do not edit.\n\n",
        "use super::{ActionInfo, ServiceInfo, TypeInfo};\n",
    ));
    let mut table = String::new();
    let mut package = "";
    for definition in catalogue.iter() {
        if definition.name.package != package {
            if !package.is_empty() {
                out.push_str("}\n");
            }
            package = &definition.name.package;
            let _ = write!(
                out,
                "\n/// Messages of the ROS package `{package}`.\npub mod {package} {{\n    use serde::{{Deserialize, \
                 Serialize}};\n\n    use crate::Message;\n"
            );
        }
        message(&mut out, definition, catalogue)?;
        let _ = writeln!(
            table,
            "    <{package}::{} as super::Message>::INFO,",
            definition.name.rust()
        );
    }
    let _ = write!(
        out,
        "}}\n\n/// Every generated type, sorted by name.\npub const TYPES: &[TypeInfo] = &[\n{table}];\n"
    );
    services(&mut out, catalogue)?;
    actions(&mut out, catalogue)?;
    Ok(out)
}

fn services(out: &mut String, catalogue: &Catalogue) -> Result<(), GenerateError> {
    out.push_str("\n/// Every service, sorted by name.\npub const SERVICES: &[ServiceInfo] = &[\n");
    for service in catalogue.services() {
        let whole = &service.whole;
        let _ = write!(
            out,
            concat!(
                "    ServiceInfo {{\n",
                "        ros_type: {:?},\n",
                "        rihs01: {:?},\n",
                "        source: {},\n",
                "        description: {},\n",
                "        event_type: {:?},\n",
                "        event_description: {},\n    }},\n",
            ),
            whole.name.to_string(),
            hash::rihs01(whole, catalogue)?,
            own_text(whole),
            raw(&hash::alone(whole)),
            service.event.name.to_string(),
            raw(&hash::alone(&service.event)),
        );
    }
    out.push_str("];\n");
    Ok(())
}

fn actions(out: &mut String, catalogue: &Catalogue) -> Result<(), GenerateError> {
    out.push_str("\n/// Every action, sorted by name.\npub const ACTIONS: &[ActionInfo] = &[\n");
    for action in catalogue.actions() {
        let _ = write!(
            out,
            concat!(
                "    ActionInfo {{\n",
                "        ros_type: {:?},\n",
                "        rihs01: {:?},\n",
                "        source: {},\n",
                "        description: {},\n    }},\n",
            ),
            action.name.to_string(),
            hash::rihs01(action, catalogue)?,
            own_text(action),
            raw(&hash::alone(action)),
        );
    }
    out.push_str("];\n");
    Ok(())
}

fn message(out: &mut String, definition: &Definition, catalogue: &Catalogue) -> Result<(), GenerateError> {
    let name = definition.name.rust();
    out.push('\n');
    // A type without a comment of its author is documented by its name, since the lints ask for a text.
    let title = [format!("`{}`.", definition.name)];
    let head = if definition.docs.is_empty() {
        &title[..]
    } else {
        &definition.docs[..]
    };
    docs(out, "    ", head);
    // Arrays beyond this size have no `Default` in Rust, and fields with a default need its value.
    let plain_default = definition.fields.iter().all(|field| {
        field.default.is_none() && !matches!(field.kind.array, Array::Fixed(size) if size > LARGEST_PLAIN_ARRAY)
    });
    let default = if plain_default { "Default, " } else { "" };
    let _ = writeln!(
        out,
        "    #[derive(Clone, Debug, {default}PartialEq, Serialize, Deserialize)]\n    pub struct {name} {{"
    );
    // IDL has no empty struct. rosidl adds this member, so that the bytes agree only with it.
    if definition.fields.is_empty() {
        docs(
            out,
            "        ",
            &["Carries nothing; DDS has no empty struct.".to_owned()],
        );
        let _ = writeln!(out, "        pub {EMPTY_STRUCT_MEMBER}: u8,");
    }
    for field in &definition.fields {
        docs(out, "        ", &field.docs);
        // serde knows fixed arrays up to 32 elements; longer ones have their own functions.
        if matches!(field.kind.array, Array::Fixed(size) if size > LARGEST_PLAIN_ARRAY) {
            out.push_str("        #[serde(with = \"crate::large_array\")]\n");
        }
        let _ = writeln!(
            out,
            "        pub {}: {},",
            rust_name(&field.name),
            rust_type(&field.kind, &definition.name)
        );
    }
    out.push_str("    }\n");
    if !plain_default {
        default_impl(out, definition);
    }
    if !definition.constants.is_empty() {
        let _ = write!(out, "\n    impl {name} {{\n");
        for constant in &definition.constants {
            docs(out, "        ", &constant.docs);
            // A constant string cannot be owned.
            let kind = match constant.kind {
                Primitive::String { .. } => "&'static str".to_owned(),
                other => primitive(other).to_owned(),
            };
            let _ = writeln!(
                out,
                "        pub const {}: {kind} = {};",
                constant.name,
                literal(&constant.value)
            );
        }
        out.push_str("    }\n");
    }
    // The names go in as literals: nothing is looked up while the twin runs.
    let _ = write!(
        out,
        concat!(
            "\n    impl Message for {} {{\n",
            "        const PACKAGE: &'static str = {:?};\n",
            "        const NAME: &'static str = {:?};\n",
            "        const ROS_TYPE: &'static str = {:?};\n",
            "        const DDS_TYPE: &'static str = {:?};\n",
            "        const RIHS01: &'static str = {:?};\n",
            "        const SCHEMA: &'static str = {};\n",
            "        const DESCRIPTION: &'static str = {};\n    }}\n",
        ),
        name,
        definition.name.package,
        definition.name.name,
        definition.name.to_string(),
        definition.name.dds(),
        hash::rihs01(definition, catalogue)?,
        schema_expression(definition, catalogue)?,
        raw(&hash::alone(definition)),
    );
    Ok(())
}

/// A text with many quotes.
fn raw(text: &str) -> String {
    format!("r#\"{text}\"#")
}

/// The schema as an expression; files are included, so that their text stands in one place only.
fn schema_expression(definition: &Definition, catalogue: &Catalogue) -> Result<String, GenerateError> {
    let dependencies = catalogue.dependencies(definition)?;
    if dependencies.is_empty() {
        return Ok(own_text(definition));
    }
    let mut pieces = format!("concat!(\n            {},\n", own_text(definition));
    for dependency in dependencies {
        let _ = write!(
            pieces,
            "            {:?},\n            {},\n",
            schema::head(dependency),
            own_text(dependency)
        );
    }
    pieces.push_str("        )");
    Ok(pieces)
}

/// The text of a definition as an expression.
fn own_text(definition: &Definition) -> String {
    match &definition.source {
        Source::File(path) => format!("include_str!(\"../../../{path}\")"),
        Source::Text => format!("{:?}", definition.text),
    }
}

fn default_impl(out: &mut String, definition: &Definition) {
    let _ = write!(
        out,
        "\n    impl Default for {} {{\n        fn default() -> Self {{\n            Self {{\n",
        definition.name.rust()
    );
    for field in &definition.fields {
        let _ = writeln!(
            out,
            "                {}: {},",
            rust_name(&field.name),
            default_expression(field)
        );
    }
    out.push_str("            }\n        }\n    }\n");
}

fn default_expression(field: &Field) -> String {
    match (&field.default, field.kind.array) {
        (None, Array::Fixed(_)) => "std::array::from_fn(|_| Default::default())".to_owned(),
        (None, _) => "Default::default()".to_owned(),
        (Some(Value::Text(text)), _) => format!("{text:?}.to_owned()"),
        (Some(Value::List(values)), array) => {
            let items: Vec<String> = values
                .iter()
                .map(|value| match value {
                    Value::Text(text) => format!("{text:?}.to_owned()"),
                    other => literal(other),
                })
                .collect();
            let open = if matches!(array, Array::Fixed(_)) { "[" } else { "vec![" };
            format!("{open}{}]", items.join(", "))
        }
        (Some(value), _) => literal(value),
    }
}

fn literal(value: &Value) -> String {
    match value {
        Value::Bool(flag) => flag.to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::Text(text) => format!("{text:?}"),
        Value::List(values) => format!("[{}]", values.iter().map(literal).collect::<Vec<_>>().join(", ")),
    }
}

fn rust_name(name: &str) -> String {
    if KEYWORDS.contains(&name) {
        format!("{name}_")
    } else {
        name.to_owned()
    }
}

fn rust_type(kind: &FieldType, within: &TypeName) -> String {
    let base = match &kind.base {
        Base::Primitive(kind) => primitive(*kind).to_owned(),
        Base::Nested(name) if name.package == within.package => name.rust(),
        Base::Nested(name) => format!("super::{}::{}", name.package, name.rust()),
    };
    match kind.array {
        Array::Single => base,
        Array::Fixed(size) => format!("[{base}; {size}]"),
        Array::Bounded(_) | Array::Unbounded => format!("Vec<{base}>"),
    }
}

fn primitive(kind: Primitive) -> &'static str {
    match kind {
        Primitive::Bool => "bool",
        Primitive::Byte | Primitive::Uint8 => "u8",
        Primitive::Int8 => "i8",
        Primitive::Int16 => "i16",
        Primitive::Uint16 => "u16",
        Primitive::Int32 => "i32",
        Primitive::Uint32 => "u32",
        Primitive::Int64 => "i64",
        Primitive::Uint64 => "u64",
        Primitive::Float32 => "f32",
        Primitive::Float64 => "f64",
        // Spelled out, since std_msgs has a message of that name.
        Primitive::String { .. } => "std::string::String",
    }
}

/// Doc comments. Brackets are escaped, since rustdoc takes them for links or tags.
fn docs(out: &mut String, indent: &str, lines: &[String]) {
    for line in lines {
        let mut escaped = String::with_capacity(line.len());
        for character in line.chars() {
            if matches!(character, '[' | ']' | '<' | '>') {
                escaped.push('\\');
            }
            escaped.push(character);
        }
        let _ = writeln!(out, "{indent}/// {}", escaped.trim_end());
    }
}
