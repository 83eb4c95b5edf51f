//! The history as the page receives it: a length of four bytes, JSON that names the columns, frames of 32-bit floats.

use serde_json::json;

use super::columns::{COLUMNS, Column};
use super::{History, SECOND};

impl History {
    /// All frames, for the page; `None` without any.
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        let layout = self.layout.as_ref()?;
        // The open frame is sent with the whole ones, so that the newest values are never a period late.
        let open = self.open.as_ref().map(|open| (open.period, &open.values));
        let frames = || self.frames.iter().map(|(period, values)| (*period, values)).chain(open);
        // Times are relative to the first frame: nanoseconds since 1970 do not fit into the 32 bits of a float.
        let (base, _) = frames().next()?;
        let count = frames().count();
        let columns: Vec<_> = COLUMNS
            .iter()
            .zip(&layout.offsets)
            .map(|((name, unit, _, count), offset)| {
                json!({"name": name, "unit": unit, "offset": offset, "length": layout.length(*count)})
            })
            .collect();
        // As text, because JavaScript's numbers lose nanoseconds since 1970.
        let mut head = json!({
            "base_ns": (base * self.period).to_string(),
            "period_s": self.period / SECOND,
            "capacity": layout.capacity(),
            "count": count,
            "stride": layout.stride,
            "complete": self.complete,
            "watched_body": self.watched.0,
            "watched_depth": self.watched.1,
            "columns": columns,
        })
        .to_string();
        // The numbers are aligned for a typed array of any size.
        while !(4 + head.len()).is_multiple_of(8) {
            head.push(' ');
        }
        // Allocated once, because a long history has megabytes.
        let mut bytes = Vec::with_capacity(4 + head.len() + count * layout.stride * 4);
        bytes.extend((head.len() as u32).to_le_bytes());
        bytes.extend(head.as_bytes());
        for (period, values) in frames() {
            let time = ((period - base) * (self.period / SECOND)) as f32;
            bytes.extend(time.to_le_bytes());
            bytes.extend(
                // The time column was written above, relative to the base.
                values
                    .iter()
                    .skip(Column::Time as usize + 1)
                    .flat_map(|value| value.to_le_bytes()),
            );
        }
        Some(bytes)
    }
}
