//! One log line when an input leaves the rig's value for its safe value, and one when good samples act again.

use flexdrill_core::inputs::{Conditioner, InputKind};

/// An input that begins its ramp to the safe value, or ends it. The text is the log line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SafeValueEvent {
    /// The input ramps to its safe value.
    RampBegan(String),
    /// Good samples act again.
    Recovered(String),
}

/// Reports each ramp to a safe value once.
#[derive(Debug, Clone, Default)]
pub struct SafeValueWatch {
    /// When the last good sample came, while a ramp that was reported lasts; by [`InputKind::index`].
    ramps: [Option<f64>; InputKind::COUNT],
}

impl SafeValueWatch {
    /// The change of an input by `now` (s, the conditioner's clock), if there is one.
    pub fn update(&mut self, kind: InputKind, conditioner: &Conditioner, now: f64) -> Option<SafeValueEvent> {
        let last_good = &mut self.ramps[kind.index()];
        let (name, unit) = (kind.name(), kind.unit());
        match (conditioner.is_brought_to_safe(kind, now), *last_good) {
            (true, None) => {
                let rule = conditioner.rule(kind);
                let silence = conditioner.without_good(kind, now).unwrap_or_default();
                *last_good = Some(now - silence);
                let held = conditioner.last_good(kind).unwrap_or(rule.initial);
                Some(SafeValueEvent::RampBegan(format!(
                    "{name}: no good sample for {silence:.1} s, max_age {} s and hold_before_safe {} s are over: the model is \
                     brought from {held:.1} to the safe {:.1} {unit} at {} {unit} per s",
                    rule.max_age, rule.hold_before_safe, rule.safe, rule.safe_ramp
                )))
            }
            (false, Some(since)) => {
                *last_good = None;
                Some(SafeValueEvent::Recovered(format!(
                    "{name}: good samples are back after {:.1} s: {:.1} {unit} acts again",
                    (now - since).max(0.0),
                    conditioner.target(kind, now)
                )))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use InputKind::RotarySpeed;
    use flexdrill_config::InputsConfig;

    #[test]
    fn one_line_when_the_ramp_begins_and_one_when_the_rig_is_back() {
        let mut conditioner = Conditioner::new(InputsConfig::default().rules());
        let mut watch = SafeValueWatch::default();
        let mut events = Vec::new();
        conditioner.offer(RotarySpeed, 40.0, 100.0).unwrap();
        for tenth in 0..400 {
            let now = 100.0 + f64::from(tenth) * 0.1;
            if tenth == 300 {
                conditioner.offer(RotarySpeed, 35.0, now).unwrap();
            }
            events.extend(watch.update(RotarySpeed, &conditioner, now).map(|event| (tenth, event)));
        }
        let [
            (151, SafeValueEvent::RampBegan(began)),
            (300, SafeValueEvent::Recovered(recovered)),
        ] = events.as_slice()
        else {
            panic!("{events:?}");
        };
        assert_eq!(
            began,
            "rotary_speed: no good sample for 15.1 s, max_age 5 s and hold_before_safe 10 s are over: the model is brought \
             from 40.0 to the safe 0.0 r/min at 5 r/min per s"
        );
        assert_eq!(
            recovered,
            "rotary_speed: good samples are back after 30.0 s: 35.0 r/min acts again"
        );
    }

    #[test]
    fn an_input_that_never_came_reports_no_ramp() {
        let conditioner = Conditioner::new(InputsConfig::default().rules());
        assert_eq!(SafeValueWatch::default().update(RotarySpeed, &conditioner, 1e6), None);
    }
}
