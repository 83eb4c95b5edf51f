//! The payload of Sparkplug B, as its specification 3.0 gives it, as far as it is used here. Unknown fields are passed over.

use prost::{Message, Oneof};

/// A payload.
#[derive(Clone, PartialEq, Message)]
pub struct Payload {
    /// When it was sent (ms since 1970).
    #[prost(uint64, optional, tag = "1")]
    pub timestamp: Option<u64>,
    /// Its metrics.
    #[prost(message, repeated, tag = "2")]
    pub metrics: Vec<Metric>,
    /// Number of the message, 0 to 255; none in deaths and commands.
    #[prost(uint64, optional, tag = "3")]
    pub seq: Option<u64>,
}

/// A metric.
#[derive(Clone, PartialEq, Message)]
pub struct Metric {
    /// Its name; in births only.
    #[prost(string, optional, tag = "1")]
    pub name: Option<String>,
    /// A number for its name.
    #[prost(uint64, optional, tag = "2")]
    pub alias: Option<u64>,
    /// When its value was taken (ms since 1970).
    #[prost(uint64, optional, tag = "3")]
    pub timestamp: Option<u64>,
    /// Its [`DataType`]; in births only.
    #[prost(uint32, optional, tag = "4")]
    pub datatype: Option<u32>,
    /// It has no value now.
    #[prost(bool, optional, tag = "7")]
    pub is_null: Option<bool>,
    /// Its properties; in births only.
    #[prost(message, optional, tag = "9")]
    pub properties: Option<PropertySet>,
    /// Its value.
    #[prost(oneof = "Value", tags = "10, 11, 12, 13, 14, 15")]
    pub value: Option<Value>,
}

/// A value.
#[derive(Clone, PartialEq, Oneof)]
pub enum Value {
    /// Integers of up to 32 bits.
    #[prost(uint32, tag = "10")]
    Int(u32),
    /// Integers of 64 bits.
    #[prost(uint64, tag = "11")]
    Long(u64),
    /// A number of 32 bits.
    #[prost(float, tag = "12")]
    Float(f32),
    /// A number of 64 bits.
    #[prost(double, tag = "13")]
    Double(f64),
    /// Yes or no.
    #[prost(bool, tag = "14")]
    Boolean(bool),
    /// A text.
    #[prost(string, tag = "15")]
    Text(String),
}

/// Properties of a metric: names, and as many values.
#[derive(Clone, PartialEq, Message)]
pub struct PropertySet {
    /// Names.
    #[prost(string, repeated, tag = "1")]
    pub keys: Vec<String>,
    /// Values.
    #[prost(message, repeated, tag = "2")]
    pub values: Vec<PropertyValue>,
}

/// The value of a property.
#[derive(Clone, PartialEq, Message)]
pub struct PropertyValue {
    /// Its [`DataType`].
    #[prost(uint32, optional, tag = "1")]
    pub kind: Option<u32>,
    /// A text; the other kinds are not used here.
    #[prost(string, optional, tag = "8")]
    pub text: Option<String>,
}

/// Kinds of values, as the specification numbers them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DataType {
    /// A signed integer of 32 bits.
    Int32 = 3,
    /// A signed integer of 64 bits.
    Int64 = 4,
    /// A number of 64 bits.
    Double = 10,
    /// Yes or no.
    Boolean = 11,
    /// A text.
    String = 12,
}
