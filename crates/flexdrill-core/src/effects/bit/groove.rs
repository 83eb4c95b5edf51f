//! The bottom of the hole as the blades have left it, by the angle of the bit.
//!
//! A blade leaves the rock as deep as it found it, or as deep as it came itself: the deeper of both. That depth is kept on
//! a grid of the bit's angles, and the next blade meets it one spacing of the blades later. The bottom of the hole so never
//! rises again, however long the bit is off it.
//!
//! A bit that turns back removes nothing: its cutters leave the rock that they cut last, and meet it again when the bit has come
//! forward to there. In between only the wear flats act. Blades are alike, so that a bit that has turned back by the spacing of
//! its blades stands as before, each blade in the path of another.

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
    /// Grid points by which the ring has been turned back, blade by blade.
    turned_back: i64,
    /// Angle up to which the cutters have come (rad).
    front: f64,
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
            turned_back: 0,
            front: 0.0,
            angle: 0.0,
            depth: 0.0,
            pressed: 0.0,
        }
    }

    /// Begins with a flat bottom at `depth` (m), the bit at `angle` (rad).
    pub fn begin(&mut self, angle: f64, depth: f64) {
        self.depths.fill(depth);
        self.last = (angle / self.spacing()).floor() as i64;
        self.turned_back = 0;
        (self.angle, self.depth, self.pressed) = (angle, depth, depth);
        self.front = angle;
    }

    /// Part of the cutters' faces that is in the rock while the cutters are at `angle` (rad): 1 at the front that they cut last, and
    /// 0 from one grid spacing behind it on.
    pub fn share(&self, angle: f64) -> f64 {
        (1.0 - (self.front - angle) / self.spacing()).clamp(0.0, 1.0)
    }

    /// Takes note of the cutters at `angle` (rad).
    pub fn slide_to(&mut self, angle: f64) {
        self.front = self.front.max(angle);
        let blade = self.spacing() * PER_BLADE as f64;
        // Half a spacing later than the blades stand alike, so that cutters that turn back meet no front on their way.
        while self.front - angle > 1.5 * blade {
            self.front -= blade;
            self.last -= PER_BLADE;
            self.turned_back += PER_BLADE;
        }
    }

    /// Angle between grid points (rad).
    fn spacing(&self) -> f64 {
        TAU / (self.blades * PER_BLADE) as f64
    }

    /// Index of a grid point in the ring.
    fn index(&self, point: i64) -> usize {
        (point + self.turned_back).rem_euclid(self.depths.len() as i64) as usize
    }

    fn at(&self, point: i64) -> f64 {
        self.depths[self.index(point.clamp(self.last + 1 - self.depths.len() as i64, self.last))]
    }

    /// Depth (m) of the rock that a blade meets while the bit is at `angle` (rad), and its slope (m/rad).
    pub fn path(&self, angle: f64) -> (f64, f64) {
        let at = angle / self.spacing();
        let (behind, part) = (at.floor() as i64 - PER_BLADE, at - at.floor());
        let (from, to) = (self.at(behind), self.at(behind + 1));
        (from + part * (to - from), (to - from) / self.spacing())
    }

    /// Mean depth of the bottom (m).
    #[cfg(test)]
    pub(super) fn bottom(&self) -> f64 {
        (0..PER_BLADE).map(|k| self.at(self.last - k)).sum::<f64>() / PER_BLADE as f64
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
        for point in self.last + 1..=reached {
            let part = if turned > 0.0 {
                ((point as f64 * self.spacing() - self.angle) / turned).clamp(0.0, 1.0)
            } else {
                1.0
            };
            let reached = self.depth + part * (depth - self.depth);
            // The blade before has left the rock here as deep as it is one spacing back.
            let index = self.index(point);
            self.depths[index] = reached.max(self.at(point - PER_BLADE));
            self.last = point;
        }
        (self.angle, self.depth) = (angle, depth);
    }

    /// Takes `turns` whole turns, an even number, off the angle.
    pub fn unwind(&mut self, turns: f64) {
        debug_assert!(turns % EVEN == 0.0, "an odd number of turns would shift the ring");
        self.angle -= turns * TAU;
        self.front -= turns * TAU;
        self.last -= turns as i64 * self.blades * PER_BLADE;
    }

    /// What a retreat needs: the points that a step writes lie ahead of all that is read, so that they need not be kept.
    pub fn mark(&self) -> GrooveMark {
        GrooveMark {
            last: self.last,
            turned_back: self.turned_back,
            front: self.front,
            angle: self.angle,
            depth: self.depth,
            pressed: self.pressed,
        }
    }

    /// Goes back to a mark of the present step.
    pub fn rewind(&mut self, mark: &GrooveMark) {
        (self.last, self.angle) = (mark.last, mark.angle);
        (self.turned_back, self.front) = (mark.turned_back, mark.front);
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
    turned_back: i64,
    front: f64,
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
    fn cutters_that_turn_back_leave_the_rock_and_meet_it_again_at_the_front() {
        let mut groove = Groove::new(4);
        groove.begin(0.0, 0.0);
        let (pitch, blade) = (2e-4, TAU / 4.0);
        let mut angle = 0.0;
        let mut turn = |groove: &mut Groove, to: f64, by: f64| {
            let (mut least, mut most) = (1.0_f64, 0.0_f64);
            while (to - angle) * by > 0.0 {
                angle += by;
                let share = groove.share(angle - by);
                (least, most) = (least.min(share), most.max(share));
                groove.record(angle, pitch * angle.max(20.0), 0.0);
                groove.slide_to(angle);
            }
            (least, most)
        };
        // Rounding of angles over the spacing.
        assert!(turn(&mut groove, 20.0, 1e-3).0 > 1.0 - 1e-9);
        let before = groove.path(20.0).0;
        // Three turns back: the first steps, of a thousandth each, are within the spacing of the grid.
        turn(&mut groove, 20.0 - 3e-3, -1e-3);
        let (_, most) = turn(&mut groove, 20.0 - 3.0 * TAU, -1e-3);
        assert_eq!(most, 0.0, "no cutter cuts on its way back");
        // The next front is 0.5 to 1.5 blades ahead, and the rock there is as the blades have left it.
        let (least, most) = turn(&mut groove, 20.0 - 3.0 * TAU + 1.6 * blade, 1e-3);
        assert_eq!((least, most), (0.0, 1.0));
        let mut last = before;
        for k in 0..4 {
            // Without a further advance the helix is cut down to the bit's depth within one turn.
            let to = 20.0 - 2.0 * TAU + f64::from(k) * blade;
            turn(&mut groove, to, 1e-3);
            let path = groove.path(to).0;
            assert!(path >= last - 1e-12, "the bottom rises from {last} to {path}");
            last = path;
        }
        assert!((last - pitch * 20.0).abs() < 1e-12, "{last} after a turn");
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
