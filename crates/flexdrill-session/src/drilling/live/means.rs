//! Means over the whole turns of the bit within the last seconds: what changes once per turn drops out of them.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use flexdrill_core::twin::Steering;

/// Longest time that means cover (s).
pub const WINDOW: f64 = 5.0;
/// Fewest turns whose scatter gives a standard error.
const TURNS_FOR_ERROR: u32 = 3;
/// A time (s) by which the parts of a window may add up to more, by rounding.
const ROUNDING: f64 = 1e-6;

/// Torque, weight, side force (right, low) and tilt (right, low).
type Values = [f64; 6];

/// Means of what the bit does across the hole. Components are (right, low).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Means {
    /// Time that they cover (s).
    pub window: f64,
    /// Whole turns in it; 0 where there was less than one, and the means cover all that is there.
    pub turns: u32,
    /// Speed of the bit (rad/s).
    pub rotary_speed: f64,
    /// Torque of the rock against the bit (N m).
    pub torque: f64,
    /// Weight on the bit (N).
    pub weight: f64,
    /// Force of the bit on the rock (N).
    pub side_force: [f64; 2],
    /// Standard errors of the side force (N), from the scatter of the turns; NaN with fewer than three.
    pub side_force_error: [f64; 2],
    /// Tilt of the guide's last node (rad).
    pub tilt: [f64; 2],
}

/// The last seconds, a tenth of a second each.
#[derive(Debug, Clone, Default)]
pub struct Window {
    /// The oldest first.
    parts: VecDeque<Steering>,
}

/// Integrals over a time (s).
#[derive(Debug, Clone, Copy, Default)]
struct Integral {
    time: f64,
    values: Values,
}

impl Integral {
    fn add(&mut self, part: &Steering, time: f64) {
        let Steering {
            torque,
            weight_on_bit,
            side_force: [right, low],
            tilt: [tilt_right, tilt_low],
            ..
        } = *part;
        let values = [torque, weight_on_bit, right, low, tilt_right, tilt_low];
        for (integral, value) in self.values.iter_mut().zip(values) {
            *integral += value * time;
        }
        self.time += time;
    }

    fn join(&mut self, other: &Self) {
        for (integral, value) in self.values.iter_mut().zip(other.values) {
            *integral += value;
        }
        self.time += other.time;
    }

    fn means(&self) -> Values {
        self.values.map(|integral| integral / self.time)
    }
}

impl Window {
    /// Takes the next part; one without steps is none.
    pub fn push(&mut self, part: Steering) {
        if part.duration > 0.0 {
            self.parts.push_back(part);
        }
        let mut time: f64 = self.parts.iter().map(|part| part.duration).sum();
        while time > WINDOW + ROUNDING {
            time -= self.parts.pop_front().map_or(time, |part| part.duration);
        }
    }

    /// Forgets all: the motion begins again.
    pub fn clear(&mut self) {
        self.parts.clear();
    }

    /// Means of the whole turns, counted back from the newest part; none before the first part.
    pub fn means(&self) -> Option<Means> {
        // Turns are filled one after the other, backwards in time; a part in which one begins belongs to both by its time.
        let (mut turns, mut turn, mut angle) = (Vec::new(), Integral::default(), 0.0);
        let (mut all, mut whole_angle) = (Integral::default(), 0.0);
        for part in self.parts.iter().rev() {
            all.add(part, part.duration);
            whole_angle += part.rotary_speed * part.duration;
            let mut time = part.duration;
            let speed = part.rotary_speed.abs();
            while angle + speed * time >= TAU {
                let used = ((TAU - angle) / speed).min(time);
                turn.add(part, used);
                turns.push(std::mem::take(&mut turn));
                (angle, time) = (0.0, time - used);
            }
            turn.add(part, time);
            angle += speed * time;
        }
        let mut over = Integral::default();
        turns.iter().for_each(|turn| over.join(turn));
        if turns.is_empty() {
            over = all;
        }
        if over.time <= 0.0 {
            return None;
        }
        let [torque, weight, right, low, tilt_right, tilt_low] = over.means();
        let error = |index: usize, mean: f64| standard_error(turns.iter().map(|turn| turn.means()[index]), mean);
        Some(Means {
            window: over.time,
            turns: u32::try_from(turns.len()).unwrap_or(u32::MAX),
            rotary_speed: whole_angle / all.time,
            torque,
            weight,
            side_force: [right, low],
            side_force_error: [error(2, right), error(3, low)],
            tilt: [tilt_right, tilt_low],
        })
    }
}

/// Standard error of a mean of turns, as if each were independent of the others.
fn standard_error(turns: impl ExactSizeIterator<Item = f64>, mean: f64) -> f64 {
    let count = turns.len();
    if count < TURNS_FOR_ERROR as usize {
        return f64::NAN;
    }
    let squares: f64 = turns.map(|value| (value - mean) * (value - mean)).sum();
    (squares / (count as f64 * (count as f64 - 1.0))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tenth of a second at `turns` per second, with a side force of `force` N to the low side.
    fn part(turns: f64, force: f64) -> Steering {
        let mut part = Steering::default();
        part.duration = 0.1;
        part.rotary_speed = turns * TAU;
        part.weight_on_bit = 10e3;
        part.side_force = [0.0, force];
        part
    }

    /// 4000 N and 500 N once per turn, at 0.7 turns per second: 3 turns in 4.29 s. The mean over each tenth is exact.
    #[test]
    fn what_changes_once_per_turn_drops_out() {
        let turns = 0.7;
        let mut window = Window::default();
        for tenth in 0..80 {
            // The integral of sin over the tenth, over its length.
            let [from, to] = [tenth, tenth + 1].map(|edge| TAU * turns * 0.1 * f64::from(edge));
            window.push(part(turns, 4000.0 + 500.0 * (from.cos() - to.cos()) / (to - from)));
        }
        let means = window.means().unwrap();
        assert_eq!(means.turns, 3);
        assert!((means.window - 3.0 / turns).abs() < 1e-9, "{means:?}");
        // The oldest tenth counts by its time: at most a tenth of a second of 500 N in 4.3 s is wrong.
        assert!((means.side_force[1] - 4000.0).abs() < 500.0 * 0.1 / 4.28, "{means:?}");
        // Over all of the 5 s it is 500 N (cos a - cos b) / (2 pi 3.5), up to 45 N, off.
        let all: f64 = window.parts.iter().map(|part| part.side_force[1]).sum::<f64>() / 50.0;
        assert!((all - 4000.0).abs() > 30.0, "{all}");
        assert!((means.weight - 10e3).abs() < 1e-6 && (means.rotary_speed - TAU * turns).abs() < 1e-9);
    }

    /// Turns of 1 to 5 N: variance 2.5 N2, error of their mean sqrt(0.5) N.
    #[test]
    fn turns_give_the_standard_error() {
        let mut window = Window::default();
        for turn in 1..=5 {
            (0..10).for_each(|_| window.push(part(1.0 + 1e-9, f64::from(turn))));
        }
        let means = window.means().unwrap();
        assert_eq!(means.turns, 5);
        assert!((means.side_force[1] - 3.0).abs() < 1e-6, "{means:?}");
        assert!((means.side_force_error[1] - 0.5_f64.sqrt()).abs() < 1e-6, "{means:?}");
        assert!(means.side_force_error[0].abs() < 1e-12);
    }

    #[test]
    fn a_bit_that_stands_has_means_over_all_that_is_there() {
        let mut window = Window::default();
        assert_eq!(window.means(), None);
        window.push(Steering::default());
        assert_eq!(window.means(), None, "a part of no time");
        (0..10).for_each(|_| window.push(part(0.0, 4104.0)));
        let means = window.means().unwrap();
        assert_eq!((means.turns, means.rotary_speed), (0, 0.0));
        assert!((means.window - 1.0).abs() < 1e-9 && (means.side_force[1] - 4104.0).abs() < 1e-9);
        assert!(means.side_force_error[1].is_nan());
        window.clear();
        assert_eq!(window.means(), None);
    }

    #[test]
    fn several_turns_in_a_tenth_are_counted() {
        let mut window = Window::default();
        // 31 turns per second over 5 s: 155, of which rounding may take one.
        (0..50).for_each(|_| window.push(part(31.0, 100.0)));
        let means = window.means().unwrap();
        assert!((154..=155).contains(&means.turns), "{means:?}");
        assert!((means.side_force[1] - 100.0).abs() < 1e-9 && means.window <= WINDOW + 1e-6);
    }
}
