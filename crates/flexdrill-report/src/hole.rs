//! Where the tool drilled next over time, and the plan of the hole.

use crate::history::History;
use flexdrill_messages::HoleAhead;

/// A build rate, and how far the hole is from its plan, at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instant {
    /// Time (s).
    pub time: f64,
    /// Radius of the next metre with 5 and 95 % of the plausible tools (m); infinite where it is straight.
    pub radius: [f64; 3],
}

/// Everything that the report says of `twin/hole_ahead`.
#[derive(Debug, Default)]
pub(crate) struct HoleHistory {
    /// Build rate of the next metre: 5 % of the plausible tools, the tool as configured, 95 % (rad/m).
    pub build: [History; 3],
    /// Build rate of the plan over the next metre (rad/m).
    pub planned: History,
    /// Distance to the plan at the last depth that is compared (m).
    pub distance: History,
    /// How far ahead that is (m).
    pub ahead: f64,
    /// Messages, and those in which the hole ahead was known.
    pub messages: u64,
    pub known: u64,
    /// Messages in which the plan was compared, and those in which it was outside the range of the plausible tools.
    pub compared: u64,
    pub off: u64,
    /// The first and the last known hole.
    pub first: Option<Instant>,
    pub last: Option<Instant>,
    /// Why the hole was not known, and why the plan was not compared: the newest reasons.
    pub because: String,
    pub plan_because: String,
}

impl HoleHistory {
    pub(crate) fn push(&mut self, time: f64, message: &HoleAhead) {
        self.messages += 1;
        if !message.known {
            self.because.clone_from(&message.because);
            return;
        }
        self.known += 1;
        let rates = [message.build_rate_low, message.build_rate, message.build_rate_high];
        for (history, rate) in self.build.iter_mut().zip(rates) {
            history.push(time, rate);
        }
        let now = Instant {
            time,
            radius: [message.radius, message.radius_low, message.radius_high],
        };
        self.first.get_or_insert(now);
        self.last = Some(now);
        if !message.plan_off.is_finite() {
            self.plan_because.clone_from(&message.plan_because);
            return;
        }
        self.compared += 1;
        self.off += u64::from(message.plan_off > 1.0);
        self.planned.push(time, message.plan_build_rate);
        // Beyond the end of a plan there is no distance to it.
        let across = message.plan_high.iter().zip(&message.plan_right);
        let mut stations = across.zip(&message.measured_depths);
        let last = stations.rfind(|((high, _), _)| high.is_finite());
        if let (Some(((high, right), depth)), Some(bit)) = (last, message.measured_depths.first()) {
            self.distance.push(time, high.hypot(*right));
            self.ahead = depth - bit;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(known: bool) -> HoleAhead {
        HoleAhead {
            known,
            because: if known { "" } else { "the bit is off bottom" }.to_owned(),
            build_rate: 0.3,
            build_rate_low: 0.28,
            build_rate_high: 0.32,
            radius: 1.0 / 0.3,
            radius_low: 1.0 / 0.32,
            radius_high: f64::INFINITY,
            measured_depths: vec![5.0, 7.5, 10.0],
            plan_off: f64::NAN,
            ..HoleAhead::default()
        }
    }

    #[test]
    fn what_is_known_is_kept_and_what_is_not_is_counted_with_its_reason() {
        let mut hole = HoleHistory::default();
        hole.push(1.0, &message(false));
        hole.push(2.0, &message(true));
        let compared = |plan_off| HoleAhead {
            plan_off,
            plan_build_rate: 0.31,
            // The plan ends 2.5 m ahead.
            plan_high: vec![0.0, -0.3, f64::NAN],
            plan_right: vec![0.0, 0.4, f64::NAN],
            ..message(true)
        };
        hole.push(3.0, &compared(0.5));
        hole.push(4.0, &compared(1.5));
        assert_eq!((hole.messages, hole.known, hole.compared, hole.off), (4, 3, 2, 1));
        assert_eq!(hole.because, "the bit is off bottom");
        assert_eq!((hole.first.unwrap().time, hole.last.unwrap().time), (2.0, 4.0));
        assert_eq!(hole.build[1].range().unwrap().mean, 0.3);
        // 0.3 and 0.4 m across are 0.5 m.
        assert_eq!((hole.distance.range().unwrap().max, hole.ahead), (0.5, 2.5));
    }
}
