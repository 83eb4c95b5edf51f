//! Who drives: publishers of each input, and which of them the model listens to.

use std::fmt;

use super::driver::{Driver, DriverId};
use flexdrill_config::{DriverPolicy, InputsConfig};
use flexdrill_core::inputs::{InputKind, InputRoute};

/// Publishers kept per input; of more, the one that has been silent longest is forgotten.
const MOST_HEARD: usize = 16;
/// Descriptions kept.
const MOST_KNOWN: usize = 64;
/// Publishers named in a status.
const MOST_SHOWN: usize = 4;

/// Who may drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Which of several.
    pub policy: DriverPolicy,
    /// Absolute names of nodes, or ids, for [`DriverPolicy::Named`].
    pub named: Vec<String>,
    /// Silence (s) after which a publisher counts as gone, by [`InputKind::index`].
    pub silent_after: [f64; 2],
}

impl Rule {
    /// As a configuration has it: a publisher has gone when its input would be stale.
    pub fn of(inputs: &InputsConfig) -> Self {
        Self {
            policy: inputs.driver.policy,
            named: inputs.driver.named.clone(),
            silent_after: [inputs.rotary_speed.max_age, inputs.weight_on_bit.max_age],
        }
    }
}

/// A sample of a publisher that does not drive. Its `Display` is a sentence with what to do.
#[derive(Debug, Clone, PartialEq)]
pub struct NotDriving {
    /// Of which input.
    pub kind: InputKind,
    /// On which topic.
    pub route: InputRoute,
    /// As received (r/min or kN).
    pub value: f64,
    /// Who sent it.
    pub sender: Driver,
    /// Who drives; none where only others are allowed.
    pub driving: Option<Driver>,
    /// For how long the one that drives must be silent (s).
    pub silent_after: f64,
}

impl fmt::Display for NotDriving {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (topic, unit) = (self.route.topic(self.kind), self.kind.unit());
        write!(f, "{topic}: {} {unit} of {} refused: ", self.value, self.sender)?;
        match &self.driving {
            Some(driving) => write!(
                f,
                "{driving} drives until it has been silent for {} s (inputs.driver.policy first); stop one of them",
                self.silent_after
            ),
            None => write!(
                f,
                "inputs.driver.named does not list it; stop it, or add its node or id to the list"
            ),
        }
    }
}

/// One publisher of an input.
#[derive(Debug, Clone, Copy)]
struct Heard {
    id: DriverId,
    route: InputRoute,
    /// First sample since it was last gone (s).
    since: f64,
    /// Newest sample (s).
    last: f64,
    /// Newest sample that was a number (s).
    last_number: Option<f64>,
}

#[derive(Debug, Clone, Default)]
struct Channel {
    heard: Vec<Heard>,
    driving: Option<DriverId>,
    refused: u64,
}

/// Keeps who sends each input and decides who drives. Times are seconds on the clock of the inputs' ages.
#[derive(Debug, Clone)]
pub struct Drivers {
    rule: Rule,
    channels: [Channel; 2],
    known: Vec<Driver>,
}

/// How the publishers of an input are.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DriverSummary {
    /// Who drives; empty while nobody does.
    pub driving: String,
    /// All that are heard, the one that drives first.
    pub heard: Vec<String>,
    /// Two or more send at once.
    pub several: bool,
    /// Samples refused because their sender does not drive.
    pub refused: u64,
}

impl Drivers {
    /// Nobody heard yet.
    pub fn new(rule: Rule) -> Self {
        Self {
            rule,
            channels: [Channel::default(), Channel::default()],
            known: Vec::new(),
        }
    }

    /// Takes over changed times.
    pub fn set_rule(&mut self, rule: Rule) {
        self.rule = rule;
    }

    /// Keeps what discovery says of a publisher.
    pub fn describe(&mut self, driver: Driver) {
        match self.known.iter_mut().find(|known| known.id == driver.id) {
            Some(known) => {
                known.node = driver.node.or(known.node.take());
                known.host = driver.host.or(known.host.take());
            }
            None => {
                if self.known.len() >= MOST_KNOWN {
                    self.known.remove(0);
                }
                self.known.push(driver);
            }
        }
    }

    /// Whether a publisher has been described with node and host.
    pub fn is_described(&self, id: DriverId) -> bool {
        let known = self.known.iter().find(|known| known.id == id);
        known.is_some_and(|known| known.node.is_some() && known.host.is_some())
    }

    fn driver(&self, id: DriverId) -> Driver {
        let known = self.known.iter().find(|known| known.id == id);
        known.cloned().unwrap_or_else(|| Driver::unknown(id))
    }

    /// Judges a sample (r/min or kN) by its sender, at the time of its arrival.
    ///
    /// # Errors
    /// When another publisher drives, or this one may not.
    pub fn offer(
        &mut self,
        kind: InputKind,
        route: InputRoute,
        id: DriverId,
        time: f64,
        value: f64,
    ) -> Result<(), Box<NotDriving>> {
        let silent_after = self.rule.silent_after[kind.index()];
        let not_named = self.rule.policy == DriverPolicy::Named && !self.is_named(id);
        let channel = &mut self.channels[kind.index()];
        channel.hear(id, route, time, value, silent_after);
        let present = match self.rule.policy {
            DriverPolicy::First => channel.present_driver(time, silent_after),
            DriverPolicy::Newest | DriverPolicy::Named => None,
        };
        let is_other = present.is_some_and(|present| !is_one(&present, id, route));
        if not_named || is_other {
            channel.refused += 1;
            return Err(Box::new(NotDriving {
                kind,
                route,
                value,
                sender: self.driver(id),
                driving: present.map(|present| self.driver(present.id)),
                silent_after,
            }));
        }
        // What is no number does not drive anything.
        if value.is_finite() && present.is_none() {
            channel.driving = Some(id);
        }
        Ok(())
    }

    fn is_named(&self, id: DriverId) -> bool {
        let driver = self.driver(id);
        let text = id.to_string();
        self.rule
            .named
            .iter()
            .any(|name| *name == text || driver.node.as_ref() == Some(name))
    }

    /// How the publishers of an input are at `now` (s).
    pub fn summary(&self, kind: InputKind, now: f64) -> DriverSummary {
        let channel = &self.channels[kind.index()];
        let mut present = channel.present(now, self.rule.silent_after[kind.index()]);
        present.sort_by_key(|heard| (Some(heard.id) != channel.driving, heard.id));
        let mut shown: Vec<String> = present
            .iter()
            .take(MOST_SHOWN)
            .map(|heard| self.driver(heard.id).to_string())
            .collect();
        if present.len() > MOST_SHOWN {
            shown.push(format!("and {} more", present.len() - MOST_SHOWN));
        }
        let driving = present.iter().find(|heard| Some(heard.id) == channel.driving);
        DriverSummary {
            driving: driving.map_or_else(String::new, |heard| self.driver(heard.id).to_string()),
            heard: shown,
            several: are_several(&present),
            refused: channel.refused,
        }
    }

    /// To be called when the clock was set anew: silences count from `now` on.
    pub fn clock_set(&mut self, now: f64) {
        for heard in self.channels.iter_mut().flat_map(|channel| &mut channel.heard) {
            heard.since = now;
            heard.last = now;
            heard.last_number = heard.last_number.map(|_| now);
        }
    }
}

impl Channel {
    fn hear(&mut self, id: DriverId, route: InputRoute, time: f64, value: f64, silent_after: f64) {
        let number = value.is_finite().then_some(time);
        if let Some(heard) = self.heard.iter_mut().find(|heard| heard.id == id) {
            if time - heard.last >= silent_after {
                heard.since = time;
            }
            heard.last = heard.last.max(time);
            heard.last_number = number.or(heard.last_number);
            return;
        }
        if self.heard.len() >= MOST_HEARD {
            let (index, _) = (self.heard.iter().enumerate())
                .min_by(|(_, a), (_, b)| a.last.total_cmp(&b.last))
                .unwrap_or((0, &self.heard[0]));
            self.heard.swap_remove(index);
        }
        self.heard.push(Heard {
            id,
            route,
            since: time,
            last: time,
            last_number: number,
        });
    }

    /// The publisher that drives, unless it is silent.
    fn present_driver(&self, now: f64, silent_after: f64) -> Option<Heard> {
        let driving = self.driving?;
        let heard = self.heard.iter().find(|heard| heard.id == driving)?;
        let silent = heard.last_number.is_none_or(|last| now - last >= silent_after);
        (!silent).then_some(*heard)
    }

    fn present(&self, now: f64, silent_after: f64) -> Vec<Heard> {
        let present = |heard: &&Heard| now - heard.last < silent_after;
        self.heard.iter().filter(present).copied().collect()
    }
}

/// Whether the publisher is that one, or the same process on the input's other topic: a process that offers an input on
/// both is one.
fn is_one(heard: &Heard, id: DriverId, route: InputRoute) -> bool {
    heard.id == id || (heard.id.same_process(&id) && heard.route != route)
}

/// Whether two send at the same time: one that took over from another does not.
fn are_several(present: &[Heard]) -> bool {
    present.iter().enumerate().any(|(index, a)| {
        let others = &present[index + 1..];
        others
            .iter()
            .any(|b| !is_one(a, b.id, b.route) && a.last >= b.since && b.last >= a.since)
    })
}

#[cfg(test)]
mod tests;
