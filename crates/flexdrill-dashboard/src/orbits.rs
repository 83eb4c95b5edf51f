//! The joints' motion beyond the last minute: for an hour, the last three of every ten seconds, at 25 positions per
//! second.
//!
//! A position has two bytes in each direction: an hour of one joint has 108 kB, and of the default tool's 32 joints
//! 3.5 MB.

use std::collections::VecDeque;

use serde_json::{Value, json};

use flexdrill_messages::JointDeflections;

/// Time from one window to the next (ns).
const EVERY: i64 = 10_000_000_000;
/// Length of a window (ns): two turns at 40 r/min.
const LENGTH: i64 = 3_000_000_000;
/// Shortest time between two positions (ns): every second sample of 50 Hz, with a tolerance for early stamps.
const BETWEEN: i64 = 38_000_000;
/// Number of windows kept: an hour.
const MOST: usize = 360;
/// Largest size of all positions (bytes). For a tool with more joints, less than an hour is kept.
const MOST_BYTES: usize = 32 << 20;
/// Number of positions in a window.
const POSITIONS: usize = (LENGTH / BETWEEN) as usize + 1;
/// A message further back in time than this belongs to another run (ns).
const ANOTHER_RUN: i64 = 2_000_000_000;
/// Largest value of a position's two bytes.
const FULL: f32 = i16::MAX as f32;

#[derive(Debug, Default)]
struct OpenWindow {
    /// Number of the period since 1970.
    number: i64,
    /// ns since 1970.
    times: Vec<i64>,
    /// For each time: y of all joints, then z (m).
    positions: Vec<f32>,
}

#[derive(Debug)]
struct OrbitWindow {
    times: Vec<i64>,
    /// As in [`OpenWindow`], in units of `largest` / [`FULL`].
    positions: Box<[i16]>,
    /// The largest magnitude (m).
    largest: f32,
}

/// The windows of an hour.
#[derive(Debug, Default)]
pub(crate) struct Orbits {
    joints: usize,
    open: OpenWindow,
    windows: VecDeque<OrbitWindow>,
}

impl Orbits {
    /// Adds the joints at an instant (ns since 1970).
    pub fn observe(&mut self, time: i64, message: &JointDeflections) {
        let joints = message.lateral_y.len();
        let newest = self.open.times.last().copied().unwrap_or(time);
        if joints != self.joints || message.lateral_z.len() != joints || time < newest - ANOTHER_RUN {
            *self = Self {
                joints: if message.lateral_z.len() == joints { joints } else { 0 },
                ..Self::default()
            };
        }
        if self.joints == 0 {
            return;
        }
        let number = time.div_euclid(EVERY);
        if number != self.open.number {
            self.close();
            self.open.number = number;
        }
        let is_last = time.rem_euclid(EVERY) >= EVERY - LENGTH;
        let is_due = self.open.times.last().is_none_or(|last| time - last >= BETWEEN);
        if is_last && is_due && self.open.times.len() < POSITIONS {
            self.open.times.push(time);
            let positions = message.lateral_y.iter().chain(&message.lateral_z);
            self.open.positions.extend(positions.map(|value| *value as f32));
        }
    }

    fn close(&mut self) {
        let OpenWindow { times, positions, .. } = std::mem::take(&mut self.open);
        if times.len() < 2 {
            return;
        }
        let most = MOST.min(MOST_BYTES / (POSITIONS * 4 * self.joints)).max(1);
        while self.windows.len() >= most {
            self.windows.pop_front();
        }
        let finite = positions.iter().filter(|value| value.is_finite());
        let largest = finite.fold(0.0, |most: f32, value| most.max(value.abs()));
        let part = |value: f32| if largest > 0.0 { value / largest * FULL } else { 0.0 };
        self.windows.push_back(OrbitWindow {
            positions: positions.into_iter().map(|value| part(value) as i16).collect(),
            times,
            largest,
        });
    }

    /// A joint's motion at a time (ns since 1970), for the page: from the window whose end is nearest, within ten
    /// seconds; `None` if no window is kept there.
    pub fn at(&self, joint: usize, time: i64) -> Option<Value> {
        if joint >= self.joints {
            return None;
        }
        let end = |window: &OrbitWindow| window.times.last().copied().unwrap_or_default();
        let away = |window: &&OrbitWindow| (end(window) - time).abs();
        let window = self.windows.iter().min_by_key(away)?;
        if away(&window) > EVERY {
            return None;
        }
        let stride = 2 * self.joints;
        let column = |offset: usize| -> Vec<f32> {
            let frames = window.positions.chunks_exact(stride);
            frames
                .map(|frame| f32::from(frame[offset]) / FULL * window.largest)
                .collect()
        };
        let first = window.times.first().copied().unwrap_or_default();
        let times: Vec<f64> = window.times.iter().map(|time| (time - first) as f64 * 1e-9).collect();
        Some(json!({
            "from_ns": first.to_string(),
            "times_s": times,
            "y_m": column(joint),
            "z_m": column(self.joints + joint),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: i64 = 1_000_000_000;

    /// Joints on circles of 1 mm and more, a turn a second, 50 times a second.
    fn feed(orbits: &mut Orbits, joints: usize, from: i64, to: i64) {
        for tick in from * 50..to * 50 {
            let turn = std::f64::consts::TAU * tick as f64 / 50.0;
            let of = |value: f64| (0..joints).map(|joint| 1e-3 * (joint + 1) as f64 * value).collect();
            let message = JointDeflections {
                lateral_y: of(turn.cos()),
                lateral_z: of(turn.sin()),
                ..JointDeflections::default()
            };
            orbits.observe(tick * SECOND / 50, &message);
        }
    }

    fn numbers(value: &Value) -> Vec<f64> {
        value
            .as_array()
            .unwrap()
            .iter()
            .map(|number| number.as_f64().unwrap())
            .collect()
    }

    #[test]
    fn every_ten_seconds_the_last_three_are_kept() {
        let mut orbits = Orbits::default();
        feed(&mut orbits, 3, 100, 131);
        let motion = orbits.at(1, 118 * SECOND).unwrap();
        assert_eq!(motion["from_ns"], (117 * SECOND).to_string());
        let (times, y, z) = (
            numbers(&motion["times_s"]),
            numbers(&motion["y_m"]),
            numbers(&motion["z_m"]),
        );
        assert_eq!((times.len(), y.len(), z.len()), (75, 75, 75));
        for ((time, y), z) in times.iter().zip(y).zip(z) {
            let turn = std::f64::consts::TAU * time;
            // The resolution is one part in 32767 of the widest joint's 3 mm.
            assert!(
                (y - 2e-3 * turn.cos()).abs() < 2e-7 && (z - 2e-3 * turn.sin()).abs() < 2e-7,
                "{time}: {y}, {z}"
            );
        }
        assert!(orbits.at(3, 118 * SECOND).is_none(), "there is no such joint");
        assert!(orbits.at(1, 200 * SECOND).is_none(), "longer than ten seconds away");
        assert!(orbits.at(1, 95 * SECOND).is_none());
    }

    #[test]
    fn memory_is_bounded_and_another_run_or_tool_clears_it() {
        let mut orbits = Orbits::default();
        feed(&mut orbits, 1, 0, 3700);
        assert_eq!(orbits.windows.len(), MOST);
        assert!(orbits.at(0, 60 * SECOND).is_none() && orbits.at(0, 3600 * SECOND).is_some());
        feed(&mut orbits, 1, 100, 121);
        assert_eq!(orbits.windows.len(), 2);
        feed(&mut orbits, 2, 121, 131);
        assert_eq!(orbits.windows.len(), 1);
        // A tool of 2000 joints: 14 windows, 29 MB.
        feed(&mut orbits, 2000, 200, 500);
        let bytes: usize = orbits.windows.iter().map(|window| 2 * window.positions.len()).sum();
        assert!(bytes <= MOST_BYTES && orbits.windows.len() < 60, "{bytes} bytes");
    }
}
