//! One line when the model leaves the rig's values for the safe ones, one when the rig is back.

use flexdrill_core::inputs::{Conditioner, InputKind};

/// What is to be told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Announcement {
    /// The input is on its way to its safe value.
    Leaving(String),
    /// Good samples act again.
    Back(String),
}

/// Keeps what was told.
#[derive(Debug, Clone, Default)]
pub struct Announcer {
    /// Since when there is no good sample, while this has been told.
    told: [Option<f64>; 2],
}

impl Announcer {
    /// What has changed of an input by `now` (s, the conditioner's clock).
    pub fn look(&mut self, kind: InputKind, conditioner: &Conditioner, now: f64) -> Option<Announcement> {
        let told = &mut self.told[kind.index()];
        let (name, unit) = (kind.name(), kind.unit());
        let gone = conditioner.is_brought_to_safe(kind, now);
        match (gone, *told) {
            (true, None) => {
                let rule = conditioner.rule(kind);
                let silence = conditioner.without_good(kind, now).unwrap_or_default();
                *told = Some(now - silence);
                let held = conditioner.last_good(kind).unwrap_or(rule.initial);
                Some(Announcement::Leaving(format!(
                    "{name}: no good sample for {silence:.1} s, max_age {} s and hold_before_safe {} s are over: the model is \
                     brought from {held:.1} to the safe {:.1} {unit} at {} {unit} per s",
                    rule.max_age, rule.hold_before_safe, rule.safe, rule.safe_ramp
                )))
            }
            (false, Some(since)) => {
                *told = None;
                Some(Announcement::Back(format!(
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
        let mut announcer = Announcer::default();
        let mut told = Vec::new();
        conditioner.offer(RotarySpeed, 40.0, 100.0).unwrap();
        for tenth in 0..400 {
            let now = 100.0 + f64::from(tenth) * 0.1;
            if tenth == 300 {
                conditioner.offer(RotarySpeed, 35.0, now).unwrap();
            }
            told.extend(announcer.look(RotarySpeed, &conditioner, now).map(|what| (tenth, what)));
        }
        let [(151, Announcement::Leaving(leaving)), (300, Announcement::Back(back))] = told.as_slice() else {
            panic!("{told:?}");
        };
        assert_eq!(
            leaving,
            "rotary_speed: no good sample for 15.1 s, max_age 5 s and hold_before_safe 10 s are over: the model is brought \
             from 40.0 to the safe 0.0 r/min at 5 r/min per s"
        );
        assert_eq!(
            back,
            "rotary_speed: good samples are back after 30.0 s: 35.0 r/min acts again"
        );
    }

    #[test]
    fn an_input_that_never_came_is_not_announced() {
        let conditioner = Conditioner::new(InputsConfig::default().rules());
        assert_eq!(Announcer::default().look(RotarySpeed, &conditioner, 1e6), None);
    }
}
