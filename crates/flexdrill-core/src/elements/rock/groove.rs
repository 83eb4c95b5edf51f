//! The bottom of the hole as the blades have left it, by the angle of the bit.
//!
//! A blade leaves the rock as deep as it found it, or as deep as it came itself: the deeper of both. That depth is kept on
//! a grid of the bit's angles, and the next blade meets it one spacing of the blades later. The bottom of the hole so never
//! rises again, however long the bit is off it.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// Grid points between two blades. The path between two points is straight: at 40 r/min with four blades a vibration of 100
/// Hz has 27 points.
const PER_BLADE: i64 = 1024;
/// Turns that the grid holds: one that the blades read, and one by which the bit may turn back.
const TURNS: i64 = 2;
/// Turns are subtracted from the angle of the pipe in multiples of this.
const EVEN: f64 = 2.0;

/// Paths of the blades.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Groove {
    blades: i64,
    /// Depth of the rock behind a blade (m, down) by grid point, as a ring.
    depths: Vec<f64>,
    /// Grid point reached last; -1 is a bit that has not turned beyond its first.
    last: i64,
    /// Angle (rad) and depth (m) of the bit when it was recorded last.
    angle: f64,
    depth: f64,
    /// Depth down to which the wear flats have pressed the rock (m).
    pressed: f64,
}

impl Groove {
    /// A flat bottom at depth 0 below a bit of so many `blades`.
    pub fn new(blades: u32) -> Self {
        let blades = i64::from(blades);
        Self {
            blades,
            depths: vec![0.0; (TURNS * blades * PER_BLADE) as usize],
            last: 0,
            angle: 0.0,
            depth: 0.0,
            pressed: 0.0,
        }
    }

    /// Begins with a flat bottom at `depth` (m), the bit at `angle` (rad).
    pub fn begin(&mut self, angle: f64, depth: f64) {
        self.depths.fill(depth);
        self.last = (angle / self.spacing()).floor() as i64;
        (self.angle, self.depth, self.pressed) = (angle, depth, depth);
    }

    /// Angle between grid points (rad).
    fn spacing(&self) -> f64 {
        TAU / (self.blades * PER_BLADE) as f64
    }

    fn at(&self, point: i64) -> f64 {
        let point = point.clamp(self.last + 1 - self.depths.len() as i64, self.last);
        self.depths[point.rem_euclid(self.depths.len() as i64) as usize]
    }

    /// Depth (m) of the rock that a blade meets while the bit is at `angle` (rad), and its slope (m/rad).
    pub fn path(&self, angle: f64) -> (f64, f64) {
        let at = angle / self.spacing();
        let (behind, part) = (at.floor() as i64 - PER_BLADE, at - at.floor());
        let (from, to) = (self.at(behind), self.at(behind + 1));
        (from + part * (to - from), (to - from) / self.spacing())
    }

    /// Depth down to which the wear flats have pressed the rock (m).
    pub fn pressed(&self) -> f64 {
        self.pressed
    }

    /// Records the bit at `angle` (rad) and `depth` (m), whose wear flats have `pressed` the rock down to a depth (m).
    pub fn record(&mut self, angle: f64, depth: f64, pressed: f64) {
        self.pressed = pressed;
        let reached = (angle / self.spacing()).floor() as i64;
        let turned = angle - self.angle;
        let size = self.depths.len() as i64;
        for point in self.last + 1..=reached {
            let part = if turned > 0.0 {
                ((point as f64 * self.spacing() - self.angle) / turned).clamp(0.0, 1.0)
            } else {
                1.0
            };
            let reached = self.depth + part * (depth - self.depth);
            // The blade before has left the rock here as deep as it is one spacing back.
            self.depths[point.rem_euclid(size) as usize] = reached.max(self.at(point - PER_BLADE));
            self.last = point;
        }
        (self.angle, self.depth) = (angle, depth);
    }

    /// Takes `turns` whole turns, an even number, off the angle.
    pub fn unwind(&mut self, turns: f64) {
        debug_assert!(turns % EVEN == 0.0, "an odd number of turns would shift the ring");
        self.angle -= turns * TAU;
        self.last -= turns as i64 * self.blades * PER_BLADE;
    }

    /// What a retreat needs: the points that a step writes lie ahead of all that is read, so that they need not be kept.
    pub fn mark(&self) -> GrooveMark {
        GrooveMark {
            last: self.last,
            angle: self.angle,
            depth: self.depth,
            pressed: self.pressed,
        }
    }

    /// Goes back to a mark of the present step.
    pub fn rewind(&mut self, mark: &GrooveMark) {
        (self.last, self.angle) = (mark.last, mark.angle);
        (self.depth, self.pressed) = (mark.depth, mark.pressed);
    }

    /// Whether it is for a bit of as many blades as `other`.
    pub fn fits(&self, other: &Self) -> bool {
        self.blades == other.blades && self.depths.len() == other.depths.len()
    }

    /// Takes another groove's paths without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.depths.copy_from_slice(&other.depths);
        self.rewind(&other.mark());
    }
}

/// Where a groove ends, see [`Groove::mark`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GrooveMark {
    last: i64,
    angle: f64,
    depth: f64,
    pressed: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_helix_is_met_one_blade_behind() {
        let mut groove = Groove::new(3);
        groove.begin(0.0, 0.0);
        let pitch = 2e-3;
        for step in 1..=20_000 {
            let angle = 1e-3 * f64::from(step);
            groove.record(angle, pitch * angle, 0.0);
        }
        let (depth, slope) = groove.path(20.0);
        // Straight pieces of a straight line: rounding.
        assert!((depth - pitch * (20.0 - TAU / 3.0)).abs() < 1e-15, "{depth}");
        assert!((slope - pitch).abs() < 1e-11, "{slope}");
        groove.unwind(2.0);
        let (again, _) = groove.path(20.0 - 2.0 * TAU);
        assert!((again - depth).abs() < 1e-15, "{again} instead of {depth}");
    }

    #[test]
    fn a_bit_that_bounced_finds_the_lowest_path() {
        let mut groove = Groove::new(2);
        groove.begin(0.0, 0.0);
        let mut angle = 0.0;
        let mut cut = |groove: &mut Groove, to: f64, depth: f64| {
            while angle < to {
                angle += 1e-3;
                groove.record(angle, depth, 0.0);
            }
        };
        cut(&mut groove, 4.0, 5e-3);
        // Lifted for many turns, in which it leaves no deeper path.
        cut(&mut groove, 104.0, -1e-2);
        assert_eq!(groove.path(104.0).0, 5e-3);
        // Set down again where it cuts for less than the spacing of the blades: there the rock is deeper afterwards.
        cut(&mut groove, 105.0, 6e-3);
        cut(&mut groove, 108.0, 0.0);
        assert_eq!((groove.path(107.0).0, groove.path(107.5).0), (5e-3, 6e-3));
    }

    #[test]
    fn a_rewound_groove_is_as_before() {
        let mut groove = Groove::new(4);
        groove.begin(0.0, 0.0);
        (1..500).for_each(|k| groove.record(f64::from(k) * 0.01, 1e-5 * f64::from(k), 0.0));
        let (mark, before) = (groove.mark(), groove.path(5.2));
        (500..508).for_each(|k| groove.record(f64::from(k) * 0.01, 1.0, 1.0));
        groove.rewind(&mark);
        assert_eq!(groove.path(5.2), before);
        assert_eq!(groove.mark(), mark);
    }
}
