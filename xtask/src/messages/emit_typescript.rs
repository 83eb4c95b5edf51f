//! TypeScript source of the messages that the rig page reads: types, constants and decoders.
//!
//! Numbers of 64 bits become `number`: exact up to 2^53, which no counter of ours reaches. Arrays of numbers become
//! typed arrays, which look at the message's bytes in place.

use std::fmt::Write as _;

use super::GenerateError;
use super::catalogue::Catalogue;
use super::definition::{Array, Base, Definition, FieldType, Primitive, TypeName, Value};

/// Package whose messages the page reads, all of them.
const PACKAGE: &str = "flexdrill";
/// Foreign messages that it reads besides.
const FOREIGN: &[(&str, &str)] = &[("visualization_msgs", "MarkerArray")];

/// The whole file: interfaces and decoders, what a message is made of before it, then the table of decoders by schema.
pub(super) fn source(catalogue: &Catalogue) -> Result<String, GenerateError> {
    let mut wanted: Vec<&Definition> = Vec::new();
    let mut roots: Vec<&Definition> = Vec::new();
    for definition in catalogue.iter() {
        let name = &definition.name;
        let foreign = FOREIGN.contains(&(name.package.as_str(), name.name.as_str()));
        if name.kind != "msg" || (name.package != PACKAGE && !foreign) {
            continue;
        }
        roots.push(definition);
        let mut parts = catalogue.dependencies(definition)?;
        parts.reverse();
        for part in parts.into_iter().chain([definition]) {
            if !wanted.iter().any(|known| known.name == part.name) {
                wanted.push(part);
            }
        }
    }
    let mut out = String::from(concat!(
        "// Generated from `msg/` and `crates/flexdrill-messages/external/` by `cargo xtask messages`. Do not edit.\n\n",
        "import { CdrReader } from \"./cdr\";\n",
    ));
    for definition in &wanted {
        message(&mut out, definition);
    }
    out.push_str("\n/** Decoders by the name of the schema. */\nexport const DECODERS = {\n");
    for definition in roots {
        let name = typescript_name(&definition.name);
        let _ = writeln!(out, "  {:?}: decode{name},", definition.name.to_string());
    }
    out.push_str("} as const;\n");
    Ok(out)
}

fn message(out: &mut String, definition: &Definition) {
    let name = typescript_name(&definition.name);
    out.push('\n');
    docs(out, "", &definition.docs);
    let _ = writeln!(out, "export interface {name} {{");
    for field in &definition.fields {
        docs(out, "  ", &field.docs);
        let _ = writeln!(out, "  {}: {};", field.name, field_type(&field.kind));
    }
    out.push_str("}\n");
    if !definition.constants.is_empty() {
        let _ = writeln!(out, "export const {name} = {{");
        for constant in &definition.constants {
            docs(out, "  ", &constant.docs);
            let _ = writeln!(out, "  {}: {},", constant.name, literal(&constant.value));
        }
        out.push_str("} as const;\n");
    }
    let _ = writeln!(
        out,
        "/** Reads a `{}`. */\nexport function decode{name}(reader: CdrReader): {name} {{\n  return {{",
        definition.name
    );
    for field in &definition.fields {
        let _ = writeln!(out, "    {}: {},", field.name, read(&field.kind));
    }
    out.push_str("  };\n}\n");
}

fn typescript_name(name: &TypeName) -> String {
    name.rust()
}

fn field_type(kind: &FieldType) -> String {
    let single = match &kind.base {
        Base::Nested(name) => typescript_name(name),
        Base::Primitive(Primitive::Bool) => "boolean".to_owned(),
        Base::Primitive(Primitive::String { .. }) => "string".to_owned(),
        Base::Primitive(_) => "number".to_owned(),
    };
    if kind.array == Array::Single {
        return single;
    }
    match &kind.base {
        Base::Primitive(primitive) => typed_array(*primitive).map_or(format!("{single}[]"), str::to_owned),
        Base::Nested(_) => format!("{single}[]"),
    }
}

/// The typed array that holds several of them; 64-bit integers have none of numbers.
fn typed_array(primitive: Primitive) -> Option<&'static str> {
    Some(match primitive {
        Primitive::Byte | Primitive::Uint8 => "Uint8Array",
        Primitive::Int8 => "Int8Array",
        Primitive::Int16 => "Int16Array",
        Primitive::Uint16 => "Uint16Array",
        Primitive::Int32 => "Int32Array",
        Primitive::Uint32 => "Uint32Array",
        Primitive::Float32 => "Float32Array",
        Primitive::Float64 => "Float64Array",
        Primitive::Bool | Primitive::Int64 | Primitive::Uint64 | Primitive::String { .. } => return None,
    })
}

/// The reader's method of one value.
fn method(primitive: Primitive) -> &'static str {
    match primitive {
        Primitive::Bool => "bool",
        Primitive::Byte | Primitive::Uint8 => "uint8",
        Primitive::Int8 => "int8",
        Primitive::Int16 => "int16",
        Primitive::Uint16 => "uint16",
        Primitive::Int32 => "int32",
        Primitive::Uint32 => "uint32",
        Primitive::Int64 => "int64",
        Primitive::Uint64 => "uint64",
        Primitive::Float32 => "float32",
        Primitive::Float64 => "float64",
        Primitive::String { .. } => "string",
    }
}

fn read(kind: &FieldType) -> String {
    let length = match kind.array {
        Array::Single => None,
        Array::Fixed(size) => Some(size.to_string()),
        Array::Bounded(_) | Array::Unbounded => Some("reader.length()".to_owned()),
    };
    let one = match &kind.base {
        Base::Nested(name) => format!("decode{}(reader)", typescript_name(name)),
        Base::Primitive(primitive) => format!("reader.{}()", method(*primitive)),
    };
    match (&kind.base, length) {
        (_, None) => one,
        (Base::Primitive(primitive), Some(length)) if typed_array(*primitive).is_some() => {
            format!("reader.{}Array({length})", method(*primitive))
        }
        (_, Some(length)) => format!("reader.many({length}, () => {one})"),
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

fn docs(out: &mut String, indent: &str, lines: &[String]) {
    match lines {
        [] => {}
        [line] => {
            let _ = writeln!(out, "{indent}/** {} */", line.trim_end());
        }
        lines => {
            let _ = writeln!(out, "{indent}/**");
            for line in lines {
                let _ = writeln!(out, "{indent} * {}", line.trim_end());
            }
            let _ = writeln!(out, "{indent} */");
        }
    }
}
