//! The journal of the alarms: their events and their list, published.

use super::worst_moment::WorstMoment;
use super::{AlarmBook, fill};
use crate::messages::std_msgs::Header;
use crate::messages::topics;
use crate::messages::{AlarmEvent, AlarmList, CdrError, to_cdr_into};
use flexdrill_alarms::{Event, Time};
use flexdrill_outputs::Encoded;

/// Step back of the clock beyond which the journal's stamps follow it (ns).
const SET_BACK: Time = 60_000_000_000;
/// Longest time between two lists (ns).
const LIST_INTERVAL: Time = 1_000_000_000;

impl AlarmBook {
    /// Keeps events until they are published, after the advice that they carry is written again.
    pub(super) fn keep(&mut self, events: Vec<Event>) {
        self.advise();
        let frame_id = &self.config.outputs.frame_id;
        let normal = WorstMoment::default();
        for event in &events {
            let moment = self.moments.get(event.alarm).unwrap_or(&normal);
            // The tool's events are published shortly after their instants: a larger step back means that the clock was set.
            self.newest = if self.newest.saturating_sub(event.time) > SET_BACK {
                event.time
            } else {
                self.newest.max(event.time)
            };
            if event.from != event.to
                && let Some(restored) = self.restored.get_mut(event.alarm)
            {
                *restored = false;
            }
            self.journal.push(fill::event(event, self.newest, moment, frame_id));
        }
        for (index, moment) in self.moments.iter_mut().enumerate() {
            if self.system.alarm(index).standing.priority().is_none() {
                *moment = WorstMoment::default();
            }
        }
    }

    /// Takes the new events, for a caller that publishes nothing. [`AlarmBook::publish`] sends them otherwise.
    pub fn take_events(&mut self) -> Vec<AlarmEvent> {
        std::mem::take(&mut self.journal)
    }

    /// Whether events or the list are due at an instant of any steady clock (ns). The list is published with every event
    /// and every second.
    pub fn is_due(&self, clock: Time) -> bool {
        !self.journal.is_empty() || self.list_is_due(clock)
    }

    fn list_is_due(&self, clock: Time) -> bool {
        self.listed.is_none_or(|(at, sequence)| {
            sequence != self.system.sequence() || !(0..LIST_INTERVAL).contains(&(clock - at))
        })
    }

    /// Sends the new events, and the list when it is due. Returns the events.
    ///
    /// # Errors
    /// When a message cannot be encoded, or what `send` says.
    pub fn publish<E: From<CdrError>>(
        &mut self,
        header: Header,
        clock: Time,
        mut send: impl FnMut(Encoded<'_>) -> Result<(), E>,
    ) -> Result<Vec<AlarmEvent>, E> {
        let events = self.take_events();
        for event in &events {
            to_cdr_into(event, &mut self.bytes)?;
            send(Encoded {
                topic: &topics::ALARM_EVENTS,
                stamp: event.header.stamp.to_nanoseconds(),
                cdr: &self.bytes,
            })?;
        }
        if self.list_is_due(clock) {
            self.listed = Some((clock, self.system.sequence()));
            let stamp = header.stamp.to_nanoseconds();
            to_cdr_into(&self.list(header), &mut self.bytes)?;
            send(Encoded {
                topic: &topics::ALARMS,
                stamp,
                cdr: &self.bytes,
            })?;
        }
        Ok(events)
    }

    /// The present state of all alarms, the worst first.
    pub fn list(&self, header: Header) -> AlarmList {
        fill::list(&self.system, &self.moments, &self.restored, &self.tools, header)
    }

    /// Events so far.
    pub fn sequence(&self) -> u64 {
        self.system.sequence()
    }
}
