//! The publishers of each input, and which of them drives it.

use std::fmt;

use super::driver::{Driver, DriverId};
use flexdrill_config::{DriverPolicy, InputsConfig};
use flexdrill_core::inputs::{InputKind, InputRoute};
use flexdrill_text::six_digits;

/// Most publishers kept per input; a further one replaces the one that has been silent longest.
const MOST_PUBLISHERS: usize = 16;
/// Most descriptions kept.
const MOST_KNOWN: usize = 64;
/// Most publishers named in a status.
const MOST_NAMED: usize = 4;

/// Which publishers may drive an input.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// The choice among several.
    pub policy: DriverPolicy,
    /// Absolute names of nodes, or ids, for [`DriverPolicy::Named`].
    pub named: Vec<String>,
    /// Silence (s) after which a publisher counts as gone, by [`InputKind::index`].
    pub silent_after: [f64; InputKind::COUNT],
}

impl Rule {
    /// The rule of a configuration: a publisher is gone after the age at which its input is stale.
    pub fn of(inputs: &InputsConfig) -> Self {
        Self {
            policy: inputs.driver.policy,
            named: inputs.driver.named.clone(),
            silent_after: inputs.rules().map(|rule| rule.max_age),
        }
    }
}

/// A sample whose publisher does not drive the input. `Display` is a sentence that ends with the remedy.
#[derive(Debug, Clone, PartialEq)]
pub struct NotDriving {
    /// Of which input.
    pub kind: InputKind,
    /// On which topic.
    pub route: InputRoute,
    /// As received, in the unit of the input's topic.
    pub value: f64,
    /// Its publisher.
    pub sender: Driver,
    /// The publisher that drives; none where the rule excludes this one.
    pub driving: Option<Driver>,
    /// Silence after which another publisher may drive (s).
    pub silent_after: f64,
}

impl fmt::Display for NotDriving {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (topic, unit) = (self.route.topic(self.kind), self.kind.unit());
        let value = six_digits(self.value);
        write!(f, "{topic}: {value} {unit} of {} refused: ", self.sender)?;
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

/// One publisher of an input: a writer, and the source that its messages name.
#[derive(Debug, Clone)]
struct Publisher {
    id: DriverId,
    source: String,
    route: InputRoute,
    /// First sample after its last silence (s).
    since: f64,
    /// Newest sample (s).
    last: f64,
    /// Newest sample that was a number (s).
    last_number: Option<f64>,
}

#[derive(Debug, Clone, Default)]
struct Channel {
    heard: Vec<Publisher>,
    driving: Option<(DriverId, String)>,
    refused: u64,
}

/// Decides which publisher drives each input. Times are in s on the conditioner's clock.
#[derive(Debug, Clone)]
pub struct Drivers {
    rule: Rule,
    channels: [Channel; InputKind::COUNT],
    known: Vec<Driver>,
}

/// The publishers of an input at one moment.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DriverSummary {
    /// The publisher that drives; empty while none does.
    pub driving: String,
    /// All publishers that are present, the driving one first.
    pub heard: Vec<String>,
    /// Two or more publish at the same time.
    pub several: bool,
    /// Samples refused because their publisher does not drive.
    pub refused: u64,
}

impl Drivers {
    /// No publisher yet.
    pub fn new(rule: Rule) -> Self {
        Self {
            rule,
            channels: Default::default(),
            known: Vec::new(),
        }
    }

    /// Adopts a changed rule.
    pub fn set_rule(&mut self, rule: Rule) {
        self.rule = rule;
    }

    /// Adds what discovery knows of a publisher.
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

    fn driver(&self, id: DriverId, source: &str) -> Driver {
        let known = self.known.iter().find(|known| known.id == id);
        Driver {
            source: source.to_owned(),
            ..known.cloned().unwrap_or_else(|| Driver::unknown(id))
        }
    }

    /// Judges a sample, in the unit of the input's topic, by its publisher and the `source` that it names, at the time of
    /// its arrival.
    ///
    /// # Errors
    /// When another publisher drives, or this one may not.
    pub fn offer(
        &mut self,
        kind: InputKind,
        route: InputRoute,
        id: DriverId,
        source: &str,
        time: f64,
        value: f64,
    ) -> Result<(), Box<NotDriving>> {
        let silent_after = self.rule.silent_after[kind.index()];
        let not_named = self.rule.policy == DriverPolicy::Named && !self.is_named(id);
        let channel = &mut self.channels[kind.index()];
        channel.note((id, source), route, time, value, silent_after);
        let present = match self.rule.policy {
            DriverPolicy::First => channel.present_driver(time, silent_after),
            DriverPolicy::Newest | DriverPolicy::Named => None,
        };
        let is_other = present
            .as_ref()
            .is_some_and(|present| !is_one(present, id, source, route));
        if not_named || is_other {
            channel.refused += 1;
            return Err(Box::new(NotDriving {
                kind,
                route,
                value,
                sender: self.driver(id, source),
                driving: present.map(|present| self.driver(present.id, &present.source)),
                silent_after,
            }));
        }
        // A publisher of NaN does not become the driver.
        if value.is_finite() && present.is_none() {
            channel.driving = Some((id, source.to_owned()));
        }
        Ok(())
    }

    fn is_named(&self, id: DriverId) -> bool {
        let driver = self.driver(id, "");
        let text = id.to_string();
        self.rule
            .named
            .iter()
            .any(|name| *name == text || driver.node.as_ref() == Some(name))
    }

    /// The publishers of an input at `now` (s).
    pub fn summary(&self, kind: InputKind, now: f64) -> DriverSummary {
        let channel = &self.channels[kind.index()];
        let mut present = channel.present(now, self.rule.silent_after[kind.index()]);
        present.sort_by_key(|heard| (!channel.is_driving(heard), heard.id));
        let mut shown: Vec<String> = present
            .iter()
            .take(MOST_NAMED)
            .map(|heard| self.driver(heard.id, &heard.source).to_string())
            .collect();
        if present.len() > MOST_NAMED {
            shown.push(format!("and {} more", present.len() - MOST_NAMED));
        }
        let driving = present.iter().find(|heard| channel.is_driving(heard));
        DriverSummary {
            driving: driving.map_or_else(String::new, |heard| self.driver(heard.id, &heard.source).to_string()),
            heard: shown,
            several: are_several(&present),
            refused: channel.refused,
        }
    }

    /// Restarts all silences at `now` (s), after the clock was set.
    pub fn clock_set(&mut self, now: f64) {
        for heard in self.channels.iter_mut().flat_map(|channel| &mut channel.heard) {
            heard.since = now;
            heard.last = now;
            heard.last_number = heard.last_number.map(|_| now);
        }
    }
}

impl Channel {
    fn is_driving(&self, heard: &Publisher) -> bool {
        let driving = self.driving.as_ref();
        driving.is_some_and(|(id, source)| heard.is(*id, source))
    }

    fn note(&mut self, (id, source): (DriverId, &str), route: InputRoute, time: f64, value: f64, silent_after: f64) {
        let number = value.is_finite().then_some(time);
        if let Some(heard) = self.heard.iter_mut().find(|heard| heard.is(id, source)) {
            if time - heard.last >= silent_after {
                heard.since = time;
            }
            heard.last = heard.last.max(time);
            heard.last_number = number.or(heard.last_number);
            return;
        }
        if self.heard.len() >= MOST_PUBLISHERS {
            // The one that drives stays: a writer that invents sources does not drive it out.
            let oldest = (self.heard.iter().enumerate())
                .filter(|(_, heard)| !self.is_driving(heard))
                .min_by(|(_, a), (_, b)| a.last.total_cmp(&b.last));
            if let Some((index, _)) = oldest {
                self.heard.swap_remove(index);
            }
        }
        self.heard.push(Publisher {
            id,
            source: source.to_owned(),
            route,
            since: time,
            last: time,
            last_number: number,
        });
    }

    /// The publisher that drives, unless it has been silent for `silent_after` (s).
    fn present_driver(&self, now: f64, silent_after: f64) -> Option<Publisher> {
        let heard = self.heard.iter().find(|heard| self.is_driving(heard))?;
        let silent = heard.last_number.is_none_or(|last| now - last >= silent_after);
        (!silent).then(|| heard.clone())
    }

    fn present(&self, now: f64, silent_after: f64) -> Vec<Publisher> {
        let present = |heard: &&Publisher| now - heard.last < silent_after;
        self.heard.iter().filter(present).cloned().collect()
    }
}

impl Publisher {
    fn is(&self, id: DriverId, source: &str) -> bool {
        self.id == id && self.source == source
    }
}

/// Whether both are one publisher: the same writer with the same source, or the same process on the input's other topic.
fn is_one(heard: &Publisher, id: DriverId, source: &str, route: InputRoute) -> bool {
    heard.is(id, source) || (heard.id.same_process(&id) && heard.route != route)
}

/// Whether two publish at the same time. A publisher that replaced another does not count.
fn are_several(present: &[Publisher]) -> bool {
    present.iter().enumerate().any(|(index, a)| {
        let others = &present[index + 1..];
        others
            .iter()
            .any(|b| !is_one(a, b.id, &b.source, b.route) && a.last >= b.since && b.last >= a.since)
    })
}

#[cfg(test)]
mod tests;
