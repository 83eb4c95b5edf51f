//! Parser of ROS 2 interface definitions (`.msg`, and `.srv` as two of them): constants, defaults, bounded strings,
//! fixed, bounded and unbounded arrays. What it does not know it refuses; it never drops a line.

use super::definition::{Array, Base, Constant, Definition, Field, FieldType, Primitive, Source, TypeName, Value};

/// What is wrong in which line (1-based).
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct ParseError {
    /// Line in the file.
    pub line: usize,
    /// What is wrong and what would be right.
    pub problem: String,
}

/// Parses the text of one message. `first_line` is the number of its first line in the file (1 for a `.msg`).
///
/// # Errors
/// When a line is not a comment, a constant or a field, or names a type or value that does not exist.
pub fn parse(name: TypeName, text: &str, source: Source, first_line: usize) -> Result<Definition, ParseError> {
    let mut definition = Definition {
        name,
        docs: Vec::new(),
        constants: Vec::new(),
        fields: Vec::new(),
        text: text.to_owned(),
        source,
    };
    let mut docs: Vec<String> = Vec::new();
    let mut at_head = true;
    for (index, line) in text.lines().enumerate() {
        let (code, comment) = split_comment(line);
        let code = code.trim();
        if code.is_empty() {
            match comment {
                Some(comment) => docs.push(comment.trim().to_owned()),
                // A blank line ends the file's head; elsewhere it parts a comment from what it does not belong to.
                None if at_head => {
                    definition.docs = std::mem::take(&mut docs);
                    at_head = false;
                }
                None => docs.clear(),
            }
            continue;
        }
        at_head = false;
        let mut own_docs = std::mem::take(&mut docs);
        own_docs.extend(comment.map(|comment| comment.trim().to_owned()));
        member(&mut definition, code, own_docs).map_err(|problem| ParseError {
            line: first_line + index,
            problem,
        })?;
    }
    Ok(definition)
}

/// Parts a line at the first `#` outside quotes.
fn split_comment(line: &str) -> (&str, Option<&str>) {
    let mut quote: Option<char> = None;
    for (position, character) in line.char_indices() {
        match (quote, character) {
            (None, '#') => return (&line[..position], Some(&line[position + 1..])),
            (None, '"' | '\'') => quote = Some(character),
            (Some(open), _) if open == character => quote = None,
            _ => {}
        }
    }
    (line, None)
}

/// Adds the constant or field that `code` declares.
fn member(definition: &mut Definition, code: &str, docs: Vec<String>) -> Result<(), String> {
    // Type, name and value are separated step by step, because a default may
    // have spaces and a constant needs none around its `=`.
    let (kind, rest) = code
        .split_once(char::is_whitespace)
        .ok_or_else(|| format!("`{code}` has a type but no name"))?;
    let rest = rest.trim();
    let kind = field_type(kind, &definition.name.package)?;
    let name_end = rest
        .find(|character: char| character.is_whitespace() || character == '=')
        .unwrap_or(rest.len());
    let (name, after) = rest.split_at(name_end);
    let after = after.trim_start();
    // Two members of one name would not compile in Rust.
    if definition.fields.iter().any(|field| field.name == name)
        || definition.constants.iter().any(|constant| constant.name == name)
    {
        return Err(format!("`{name}` is declared twice"));
    }
    if let Some(value) = after.strip_prefix('=') {
        // ROS 2 has no constants of arrays or messages.
        let (Base::Primitive(kind), Array::Single) = (&kind.base, kind.array) else {
            return Err(format!("constant `{name}` must be of a single built-in type"));
        };
        if !is_constant_name(name) {
            return Err(format!(
                "constant `{name}`: use capitals, digits and single underscores"
            ));
        }
        definition.constants.push(Constant {
            docs,
            name: name.to_owned(),
            kind: *kind,
            value: scalar(*kind, value.trim())?,
        });
        return Ok(());
    }
    // The rules for names are those of rosidl, which would refuse the file only in the user's workspace.
    if !is_field_name(name) {
        return Err(format!(
            "field `{name}`: use small letters, digits and single underscores, a letter first"
        ));
    }
    let default = match after {
        "" => None,
        text => Some(default_value(&kind, text)?),
    };
    definition.fields.push(Field {
        docs,
        name: name.to_owned(),
        kind,
        default,
    });
    Ok(())
}

/// Type of a field, `package` being where names without a package belong.
fn field_type(text: &str, package: &str) -> Result<FieldType, String> {
    let (base, array) = match text.split_once('[') {
        None => (text, Array::Single),
        Some((base, size)) => {
            let size = size
                .strip_suffix(']')
                .ok_or_else(|| format!("type `{text}`: the array's `[` is not closed"))?;
            let array = match size.strip_prefix("<=") {
                Some(most) => Array::Bounded(count(text, most)?),
                None if size.is_empty() => Array::Unbounded,
                None => Array::Fixed(count(text, size)?),
            };
            (base, array)
        }
    };
    Ok(FieldType {
        base: base_type(base, package)?,
        array,
    })
}

fn count(kind: &str, text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(number) if number > 0 => Ok(number),
        _ => Err(format!("type `{kind}`: `{text}` is not a length of 1 or more")),
    }
}

fn base_type(text: &str, package: &str) -> Result<Base, String> {
    let primitive = match text {
        "bool" => Primitive::Bool,
        "byte" => Primitive::Byte,
        "char" | "uint8" => Primitive::Uint8,
        "int8" => Primitive::Int8,
        "int16" => Primitive::Int16,
        "uint16" => Primitive::Uint16,
        "int32" => Primitive::Int32,
        "uint32" => Primitive::Uint32,
        "int64" => Primitive::Int64,
        "uint64" => Primitive::Uint64,
        "float32" => Primitive::Float32,
        "float64" => Primitive::Float64,
        "string" => Primitive::String { bound: None },
        "Header" => return Ok(Base::Nested(TypeName::message("std_msgs", "Header"))),
        _ => {
            if let Some(bound) = text.strip_prefix("string<=") {
                let bound = Some(count(text, bound)?);
                return Ok(Base::Primitive(Primitive::String { bound }));
            }
            let (package, name) = match text.split('/').collect::<Vec<_>>()[..] {
                [name] => (package, name),
                [package, name] | [package, "msg", name] => (package, name),
                _ => return Err(format!("`{text}` is not a type")),
            };
            if !is_field_name(package) || !is_type_name(name) {
                return Err(format!(
                    "`{text}` is not a type (message names begin with a capital; wstring is not supported)"
                ));
            }
            return Ok(Base::Nested(TypeName::message(package, name)));
        }
    };
    Ok(Base::Primitive(primitive))
}

fn default_value(kind: &FieldType, text: &str) -> Result<Value, String> {
    let Base::Primitive(primitive) = &kind.base else {
        return Err("a field that is a message cannot have a default".to_owned());
    };
    if kind.array == Array::Single {
        return scalar(*primitive, text);
    }
    let inner = text
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'))
        .ok_or_else(|| format!("default `{text}` of an array must be in [ ]"))?;
    let values = split_list(inner)
        .into_iter()
        .map(|item| scalar(*primitive, item.trim()))
        .collect::<Result<Vec<_>, _>>()?;
    let length = values.len() as u64;
    match kind.array {
        Array::Fixed(size) if size != length => Err(format!("default has {length} entries, the array {size}")),
        Array::Bounded(most) if length > most => Err(format!("default has {length} entries, the array at most {most}")),
        _ => Ok(Value::List(values)),
    }
}

/// Entries between commas outside quotes; none for blank text.
fn split_list(text: &str) -> Vec<&str> {
    let mut items = Vec::new();
    let mut quote: Option<char> = None;
    let mut start = 0;
    for (position, character) in text.char_indices() {
        match (quote, character) {
            (None, ',') => {
                items.push(&text[start..position]);
                start = position + 1;
            }
            (None, '"' | '\'') => quote = Some(character),
            (Some(open), _) if open == character => quote = None,
            _ => {}
        }
    }
    if !text[start..].trim().is_empty() {
        items.push(&text[start..]);
    }
    items
}

/// The literal of a built-in type.
fn scalar(kind: Primitive, text: &str) -> Result<Value, String> {
    // 128 bits hold the ranges of all integer types, so that one comparison serves all.
    let (low, high): (i128, i128) = match kind {
        Primitive::Bool => {
            return match text {
                "true" | "True" | "1" => Ok(Value::Bool(true)),
                "false" | "False" | "0" => Ok(Value::Bool(false)),
                _ => Err(format!("`{text}` is not true or false")),
            };
        }
        // ROS 2 accepts no infinity as a literal, and a NaN as default would never be equal to itself.
        Primitive::Float32 | Primitive::Float64 => {
            return match text.parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(Value::Float(number)),
                _ => Err(format!("`{text}` is not a finite number")),
            };
        }
        Primitive::String { bound } => {
            let text = unquote(text);
            // The bound of a string counts bytes.
            return match bound {
                Some(most) if text.len() as u64 > most => {
                    Err(format!("`{text}` has {} bytes, the string at most {most}", text.len()))
                }
                _ => Ok(Value::Text(text.to_owned())),
            };
        }
        Primitive::Byte | Primitive::Uint8 => (0, u8::MAX.into()),
        Primitive::Int8 => (i8::MIN.into(), i8::MAX.into()),
        Primitive::Int16 => (i16::MIN.into(), i16::MAX.into()),
        Primitive::Uint16 => (0, u16::MAX.into()),
        Primitive::Int32 => (i32::MIN.into(), i32::MAX.into()),
        Primitive::Uint32 => (0, u32::MAX.into()),
        Primitive::Int64 => (i64::MIN.into(), i64::MAX.into()),
        Primitive::Uint64 => (0, u64::MAX.into()),
    };
    // rosidl accepts hexadecimal numbers for constants.
    let number = match text.strip_prefix("0x") {
        Some(digits) => i128::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    };
    match number {
        Some(number) if (low..=high).contains(&number) => Ok(Value::Integer(number)),
        _ => Err(format!("`{text}` is not a whole number from {low} to {high}")),
    }
}

fn unquote(text: &str) -> &str {
    for quote in ['"', '\''] {
        if let Some(inner) = text.strip_prefix(quote).and_then(|rest| rest.strip_suffix(quote)) {
            return inner;
        }
    }
    text
}

fn is_field_name(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
        && !name.contains("__")
        && !name.ends_with('_')
}

fn is_constant_name(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_uppercase())
        && name
            .chars()
            .all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')
        && !name.contains("__")
        && !name.ends_with('_')
}

fn is_type_name(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_uppercase()) && name.chars().all(|c| c.is_ascii_alphanumeric())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse_text(text: &str) -> Result<Definition, ParseError> {
        parse(TypeName::message("demo", "Thing"), text, Source::Text, 1)
    }

    #[test]
    fn knows_every_form_of_member() {
        let definition = parse_text(concat!(
            "# Head.\n\n",
            "string NAME = \"a # b\"  # trailing\nint16 LOW=-32768\nuint8 MASK = 0x1F\n",
            "# Above.\n",
            "bool in_contact false\nstring<=5[<=3] words [\"a,b\", 'c']\nfloat64[2] pair [1.5, -2]\n",
            "Other[] others\nstd_msgs/Header header\nchar letter\n",
        ))
        .unwrap();
        assert_eq!(definition.docs, ["Head."]);
        assert_eq!(definition.constants[0].value, Value::Text("a # b".into()));
        assert_eq!(definition.constants[1].value, Value::Integer(-32768));
        assert_eq!(definition.constants[2].value, Value::Integer(31));
        assert_eq!(definition.fields[0].docs, ["Above."]);
        assert_eq!(definition.fields[0].default, Some(Value::Bool(false)));
        assert_eq!(
            definition.fields[1].default,
            Some(Value::List(vec![Value::Text("a,b".into()), Value::Text("c".into())]))
        );
        assert_eq!(definition.fields[2].kind.array, Array::Fixed(2));
        assert_eq!(
            definition.fields[3].kind.base,
            Base::Nested(TypeName::message("demo", "Other"))
        );
        assert_eq!(definition.fields[5].kind.base, Base::Primitive(Primitive::Uint8));
    }

    #[test]
    fn refuses_what_it_does_not_know_with_the_line() {
        for (text, part) in [
            ("float64 x\nfloat96 y", "not a type"),
            ("\nuint8 X = 256", "0 to 255"),
            ("\nfloat64", "no name"),
            ("\nint8[0] x", "length"),
            ("\nbool X = maybe", "true or false"),
            ("float64 x\nfloat64 x", "twice"),
            ("\nuint8[2] x [1]", "1 entries"),
            ("\nfloat64 Bad", "small letters"),
            ("\nstring<=2 x \"abc\"", "at most 2"),
            ("\nwstring x", "wstring"),
        ] {
            let error = parse_text(text).unwrap_err();
            assert_eq!(error.line, 2, "{text}");
            assert!(error.problem.contains(part), "{text}: {error}");
        }
    }
}
