//! A parsed interface definition: what `.msg` and `.srv` files say, before it becomes code, schema or hash.

use std::fmt;

/// Name of a type: `package/kind/name`, where kind is `msg` or `srv`.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeName {
    /// ROS package.
    pub package: String,
    /// `msg`, `srv` or `action`.
    pub kind: &'static str,
    /// Name within the package; halves of a service end in `_Request` and `_Response`.
    pub name: String,
}

impl TypeName {
    /// A message's name.
    pub fn message(package: &str, name: &str) -> Self {
        Self {
            package: package.to_owned(),
            kind: "msg",
            name: name.to_owned(),
        }
    }

    /// The name of the DDS type, as every ROS 2 middleware forms it.
    pub fn dds(&self) -> String {
        format!("{}::{}::dds_::{}_", self.package, self.kind, self.name)
    }

    /// The name that `MSG:` lines of a `ros2msg` schema carry: without the kind.
    pub fn short(&self) -> String {
        format!("{}/{}", self.package, self.name)
    }

    /// The name of the Rust struct.
    pub fn rust(&self) -> String {
        self.name.replace('_', "")
    }
}

impl fmt::Display for TypeName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}/{}", self.package, self.kind, self.name)
    }
}

/// Types that the language of interface definitions has built in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Primitive {
    /// `bool`.
    Bool,
    /// `byte`: an octet.
    Byte,
    /// `int8`.
    Int8,
    /// `uint8`, and `char`, which ROS 2 maps to it.
    Uint8,
    /// `int16`.
    Int16,
    /// `uint16`.
    Uint16,
    /// `int32`.
    Int32,
    /// `uint32`.
    Uint32,
    /// `int64`.
    Int64,
    /// `uint64`.
    Uint64,
    /// `float32`.
    Float32,
    /// `float64`.
    Float64,
    /// `string` or `string<=N`.
    String {
        /// Most bytes, if bounded.
        bound: Option<u64>,
    },
}

/// What a field holds one or several of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Base {
    /// A built-in type.
    Primitive(Primitive),
    /// Another message.
    Nested(TypeName),
}

/// How many of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Array {
    /// One.
    Single,
    /// Exactly so many.
    Fixed(u64),
    /// Up to so many.
    Bounded(u64),
    /// Any number.
    Unbounded,
}

/// Type of a field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldType {
    /// Of what.
    pub base: Base,
    /// How many.
    pub array: Array,
}

/// A literal of a constant or a default.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `true`, `false`, `1`, `0`.
    Bool(bool),
    /// Any integer type.
    Integer(i128),
    /// `float32`, `float64`.
    Float(f64),
    /// `string`.
    Text(String),
    /// Default of an array.
    List(Vec<Value>),
}

/// One field.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Comment lines that belong to it.
    pub docs: Vec<String>,
    /// Name.
    pub name: String,
    /// Type.
    pub kind: FieldType,
    /// Value that a new message starts with, if not zero.
    pub default: Option<Value>,
}

/// One constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Comment lines that belong to it.
    pub docs: Vec<String>,
    /// Name.
    pub name: String,
    /// Type.
    pub kind: Primitive,
    /// Value.
    pub value: Value,
}

/// Where the text of a definition stands, for the schema.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// A `.msg` file, by its path from the repository's root with `/` between folders.
    File(String),
    /// Half of a `.srv` file.
    Text,
}

/// One message, or one half of a service.
#[derive(Debug, Clone, PartialEq)]
pub struct Definition {
    /// Its name.
    pub name: TypeName,
    /// Comment at the head of the file.
    pub docs: Vec<String>,
    /// Constants in order.
    pub constants: Vec<Constant>,
    /// Fields in order.
    pub fields: Vec<Field>,
    /// The text it was parsed from, ending in a newline unless empty.
    pub text: String,
    /// Where that text stands.
    pub source: Source,
}

impl Definition {
    /// Messages that its fields name, in order, repeated as they are.
    pub fn nested(&self) -> impl Iterator<Item = &TypeName> {
        self.fields.iter().filter_map(|field| match &field.kind.base {
            Base::Nested(name) => Some(name),
            Base::Primitive(_) => None,
        })
    }
}
