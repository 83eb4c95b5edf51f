//! Torsional modes of drive, string and tool, from the exact condition of impedance.
//!
//! With s = - decay + i frequency, a free bit (no torque but that of its inertia, T = J s w) and the waves of each piece, which
//! grow by e = exp(s tau) from its lower end to its upper,
//!
//! ```text
//! w_top = w (e + 1/e) / 2 + T / z (e - 1/e) / 2        T_top = T (e + 1/e) / 2 + z w (e - 1/e) / 2
//! drive:  s T + (J s^2 + P s + I) w = 0                 or w = 0 for a rigid one
//! ```
//!
//! A loss b at a piece's lower end adds b w t s / (1 + t s) to T there. Above its pole at - 1 / t, which is real, the left side
//! has none, so that the change of its phase around a rectangle counts the
//! roots in it. Rectangles are halved until each holds one root, which Newton's method then finds. Friction, rock and the
//! damping of the tool's own material are left out: these are the modes of a bit off bottom.

use nalgebra::Complex;

use super::line::FOLLOWS_WITHIN;
use crate::tool::description::{HangingTool, StringDescription, TopDrive, TorsionalMode};

type C = Complex<f64>;

/// Roots are sought down to decays of this many e-foldings per time of travel along string and tool: faster ones do not ring.
const FASTEST_DECAY: f64 = 3.0;
/// Growth up to which roots are sought, as above. There are none but by rounding: everything here takes energy.
const GROWTH: f64 = 0.05;
/// Lowest angular frequency, over that of a quarter wave: a heavy tool under a soft drive has a tenth of it.
const LOWEST: f64 = 0.02;
/// Largest change of phase between points of a contour (rad).
const TURN: f64 = 0.7;
/// Most halvings of a contour's interval, or of a rectangle.
const DEEPEST: u32 = 60;
/// Most corrections by Newton's method; it ends at rounding after some eight.
const MOST_CORRECTIONS: u32 = 60;

fn exp(x: C) -> C {
    let size = libm::exp(x.re);
    C::new(size * libm::cos(x.im), size * libm::sin(x.im))
}

struct Condition<'a> {
    string: &'a StringDescription,
    tool: &'a HangingTool,
}

impl Condition<'_> {
    /// The left side at `s`.
    fn at(&self, s: C) -> C {
        let (mut speed, mut torque) = (C::new(1.0, 0.0), s * self.tool.inertia);
        let string = self.string.pieces.iter().map(|piece| piece.torsion);
        let waves = string.chain(self.tool.pieces.iter().copied());
        for wave in waves.rev() {
            // The loss at the piece's lower end, on a body that follows.
            torque += speed * s * (wave.drag * FOLLOWS_WITHIN) / (s * FOLLOWS_WITHIN + 1.0);
            let grows = exp(s * wave.delay);
            let (up, down) = (grows, C::new(1.0, 0.0) / grows);
            let (even, odd) = ((up + down) * 0.5, (up - down) * 0.5);
            (speed, torque) = (
                speed * even + torque * odd / wave.impedance,
                torque * even + speed * odd * wave.impedance,
            );
        }
        match self.string.drive {
            TopDrive::Rigid => speed,
            TopDrive::Controlled(drive) => {
                s * torque + (s * s * drive.inertia + s * drive.proportional + drive.integral) * speed
            }
        }
    }

    /// Change of the phase from `from` to `to` (rad), where the left side has these values.
    fn phase(&self, [from, to]: [C; 2], [a, b]: [C; 2], depth: u32) -> f64 {
        let middle = (from + to) * 0.5;
        let m = self.at(middle);
        let (first, second) = ((m / a).arg(), (b / m).arg());
        if depth == 0 || (first.abs() < TURN && second.abs() < TURN) {
            return first + second;
        }
        self.phase([from, middle], [a, m], depth - 1) + self.phase([middle, to], [m, b], depth - 1)
    }

    /// Roots in the rectangle between two corners.
    fn count(&self, low: C, high: C) -> i64 {
        let corners = [low, C::new(high.re, low.im), high, C::new(low.re, high.im), low];
        let values = corners.map(|corner| self.at(corner));
        let turns: f64 = (0..4)
            .map(|k| {
                // Eight intervals at least, so that no whole turn hides between two points.
                let edge = corners[k + 1] - corners[k];
                let points: [C; 9] = std::array::from_fn(|j| corners[k] + edge * (j as f64 / 8.0));
                let at: [C; 9] = std::array::from_fn(|j| match j {
                    0 => values[k],
                    8 => values[k + 1],
                    _ => self.at(points[j]),
                });
                (0..8)
                    .map(|j| self.phase([points[j], points[j + 1]], [at[j], at[j + 1]], DEEPEST))
                    .sum::<f64>()
            })
            .sum();
        (turns / std::f64::consts::TAU).round() as i64
    }

    /// The root near `from` within the rectangle between two corners, if Newton's method finds one.
    fn root(&self, from: C, low: C, high: C) -> Option<C> {
        let mut s = from;
        for _ in 0..MOST_CORRECTIONS {
            let h = 1e-6 * s.norm();
            let slope = (self.at(s + h) - self.at(s - h)) / (2.0 * h);
            let change = self.at(s) / slope;
            s -= change;
            // A rest of the size of rounding, as the difference quotient leaves it.
            if change.norm() <= 1e-12 * s.norm() {
                let inside = (low.re..=high.re).contains(&s.re) && (low.im..=high.im).contains(&s.im);
                return inside.then_some(s);
            }
        }
        None
    }

    /// Adds the roots between two corners, of which there are `count`.
    fn collect(&self, low: C, high: C, count: i64, depth: u32, roots: &mut Vec<C>) {
        if count <= 0 {
            return;
        }
        if count == 1
            && let Some(root) = self.root((low + high) * 0.5, low, high)
        {
            roots.push(root);
            return;
        }
        if depth == 0 {
            return;
        }
        // Not in the middle, where symmetric systems have roots.
        let part = 0.4871;
        let size = high - low;
        let (left, right) = if size.re > size.im {
            let at = low.re + part * size.re;
            (C::new(at, high.im), C::new(at, low.im))
        } else {
            let at = low.im + part * size.im;
            (C::new(high.re, at), C::new(low.re, at))
        };
        let first = self.count(low, left);
        self.collect(low, left, first, depth - 1, roots);
        self.collect(right, high, count - first, depth - 1, roots);
    }
}

impl StringDescription {
    /// The lowest `most` torsional modes of drive, string and what hangs below, by frequency. What dies out within a sixth of
    /// its turn, or a third of the time of travel, is left out.
    pub fn torsional_modes(&self, tool: &HangingTool, most: usize) -> Vec<TorsionalMode> {
        let condition = Condition { string: self, tool };
        let string = self.pieces.iter().map(|piece| piece.torsion.delay);
        let delay: f64 = string.chain(tool.pieces.iter().map(|wave| wave.delay)).sum();
        let half_wave = std::f64::consts::PI / delay;
        let mut roots = Vec::new();
        let mut from = 0.5 * LOWEST * half_wave;
        // A band of half a wave's frequency holds one mode of the string, or two with one of the drive.
        while roots.len() < most && from < (most as f64 + 2.0) * half_wave {
            let low = C::new(-FASTEST_DECAY / delay, from);
            let high = C::new(GROWTH / delay, from + 0.973 * half_wave);
            condition.collect(low, high, condition.count(low, high), DEEPEST, &mut roots);
            // What is gone within a sixth of its turn does not ring.
            roots.retain(|root| root.im > -root.re);
            from = high.im;
        }
        roots.sort_by(|a, b| a.im.total_cmp(&b.im));
        roots.truncate(most);
        let mode = |root: C| TorsionalMode {
            decay: -root.re,
            frequency: root.im,
        };
        roots.into_iter().map(mode).collect()
    }
}
