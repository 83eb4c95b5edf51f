//! The tests of the rig page decode bytes that our own encoder wrote. Those bytes and their meaning are checked in with
//! the page; this test compares them with what the encoder gives now.
//!
//! `FLEXDRILL_WRITE_REFERENCE=1 cargo test --release -p flexdrill-messages` writes them again after a change in msg/.

use std::fmt::Write as _;
use std::path::Path;

use flexdrill_messages::{
    Ageing, Alarm, AlarmChance, AlarmEvent, AlarmList, AppliedInputs, Bands, BitState, ContactForces, FigureBand,
    Forecast, ForecastBand, HoleAhead, HoleDrilled, JointDeflections, Message, Reactions, Residual, Residuals,
    RigInputs, RigMeasured, RigSurvey, SafeWindow, SessionInfo, Transfer, TwinStatus, WhatIfAnswer, WhatIfCandidate,
    WhirlState, WhirlWarning, to_cdr, visualization_msgs::MarkerArray,
};
use serde::Serialize;
use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, SeqAccess, Visitor, value::Error};

const REFERENCE: &str = "crates/flexdrill-dashboard/web/test/reference.json";

/// Makes up a value of any message: every field another one, strings and sequences of changing length, a NaN here and
/// there. All numbers are exact in JSON.
struct Maker {
    count: u32,
}

impl Maker {
    fn next(&mut self) -> u32 {
        self.count += 1;
        self.count
    }
}

macro_rules! numbers {
    ($($method:ident $visit:ident $kind:ty),*) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            let value = self.next();
            visitor.$visit((value % 100) as $kind)
        })*
    };
}

impl<'de> Deserializer<'de> for &mut Maker {
    type Error = Error;

    numbers!(
        deserialize_u8 visit_u8 u8, deserialize_u16 visit_u16 u16, deserialize_i8 visit_i8 i8,
        deserialize_i16 visit_i16 i16
    );

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Error> {
        unreachable!("messages say what they are made of")
    }
    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_bool(!value.is_multiple_of(3))
    }
    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_u32(4_000_000_000 + value)
    }
    fn deserialize_i32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_i32(-2_000_000_000 + i32::try_from(value).unwrap())
    }
    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_u64((1 << 50) + u64::from(value))
    }
    fn deserialize_i64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_i64(-(1 << 50) + i64::from(value))
    }
    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_f32(value as f32 + 0.5)
    }
    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_f64(if value.is_multiple_of(11) {
            f64::NAN
        } else {
            f64::from(value) - 20.25
        })
    }
    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let value = self.next();
        visitor.visit_string("gestänge"[..].chars().take(value as usize % 9).collect())
    }
    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }
    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let left = self.next() as usize % 4;
        visitor.visit_seq(Made { maker: self, left })
    }
    fn deserialize_tuple<V: Visitor<'de>>(self, left: usize, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_seq(Made { maker: self, left })
    }
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_tuple(fields.len(), visitor)
    }

    serde::forward_to_deserialize_any! {
        char bytes byte_buf option unit unit_struct newtype_struct tuple_struct map enum identifier ignored_any
    }
}

struct Made<'a> {
    maker: &'a mut Maker,
    left: usize,
}

impl<'de> SeqAccess<'de> for Made<'_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        seed.deserialize(&mut *self.maker).map(Some)
    }
}

/// One line of the file: schema, bytes as hexadecimal digits, the message.
fn reference<M: Message + Serialize + DeserializeOwned>(maker: &mut Maker) -> String {
    let message = M::deserialize(maker).unwrap();
    let mut bytes = String::new();
    for byte in to_cdr(&message).unwrap() {
        write!(bytes, "{byte:02x}").unwrap();
    }
    format!(
        "{{\"schema\":\"{}\",\"bytes\":\"{bytes}\",\"message\":{}}}",
        M::ROS_TYPE,
        serde_json::to_string(&message).unwrap()
    )
    // The page's types have ROS's own names; Rust's `type` is a keyword.
    .replace("\"type_\":", "\"type\":")
}

#[test]
fn the_pages_reference_is_what_the_encoder_gives() {
    let mut maker = Maker { count: 0 };
    let lines = [
        reference::<Ageing>(&mut maker),
        reference::<Alarm>(&mut maker),
        reference::<AlarmEvent>(&mut maker),
        reference::<AlarmList>(&mut maker),
        reference::<AppliedInputs>(&mut maker),
        reference::<Bands>(&mut maker),
        reference::<BitState>(&mut maker),
        reference::<ContactForces>(&mut maker),
        reference::<JointDeflections>(&mut maker),
        reference::<Reactions>(&mut maker),
        reference::<RigInputs>(&mut maker),
        reference::<SessionInfo>(&mut maker),
        reference::<Transfer>(&mut maker),
        reference::<AlarmChance>(&mut maker),
        reference::<FigureBand>(&mut maker),
        reference::<WhatIfAnswer>(&mut maker),
        reference::<WhatIfCandidate>(&mut maker),
        reference::<TwinStatus>(&mut maker),
        reference::<WhirlState>(&mut maker),
        reference::<WhirlWarning>(&mut maker),
        reference::<MarkerArray>(&mut maker),
        reference::<Forecast>(&mut maker),
        reference::<ForecastBand>(&mut maker),
        reference::<SafeWindow>(&mut maker),
        reference::<RigMeasured>(&mut maker),
        reference::<Residual>(&mut maker),
        reference::<Residuals>(&mut maker),
        reference::<HoleAhead>(&mut maker),
        reference::<RigSurvey>(&mut maker),
        reference::<HoleDrilled>(&mut maker),
    ];
    let fresh = format!("[\n{}\n]\n", lines.join(",\n"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(REFERENCE);
    if std::env::var_os("FLEXDRILL_WRITE_REFERENCE").is_some() {
        std::fs::write(&path, &fresh).unwrap();
    }
    let checked_in = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        fresh == checked_in,
        "{REFERENCE} is old: run FLEXDRILL_WRITE_REFERENCE=1 cargo test --release -p flexdrill-messages"
    );
}
