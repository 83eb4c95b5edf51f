//! What plausible tools did under the same inputs, over time.

use crate::history::History;
use flexdrill_messages::Bands;
use flexdrill_outputs::figures::{Group, Kind, TRANSFER};

/// Largest number of alarms with their priorities that are kept; there are some twenty alarms of three priorities.
const MOST_ALARMS: usize = 100;

/// Bands of a figure over time, SI.
#[derive(Debug)]
pub(crate) struct BandHistory {
    /// Topic and field, as in the message.
    name: String,
    /// Where the report shows the twin's own value: the field of `twin/transfer`; none where it has no such table.
    pub transfer: Option<&'static str>,
    pub label: &'static str,
    pub kind: Kind,
    /// Quantiles at 5, 50 and 95 %.
    pub quantiles: [History; 3],
}

/// An alarm of a priority in plausible tools.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AlarmOfTools {
    id: String,
    pub name: String,
    pub priority: u8,
    /// Sum of the chances over all messages.
    sum: f64,
    /// The largest chance with its time (s), and the members that had the alarm then, of those computed.
    pub most: f64,
    pub at: f64,
    pub seen: u32,
    pub members: u32,
}

/// Plausible tools over the recording.
#[derive(Debug)]
pub(crate) struct PlausibleTools {
    pub bands: Vec<BandHistory>,
    /// Share of the tools in which any alarm of the tool stands.
    pub any_alarm: History,
    pub alarms: Vec<AlarmOfTools>,
    /// Messages, and those of them without bands, with the first reason.
    pub seconds: u64,
    pub without: u64,
    pub why: String,
    /// Most members, most that failed at once, and least and most members alike.
    pub members: u32,
    pub failed: u32,
    pub effective: [f64; 2],
    /// Replacements of members of little weight.
    pub renewals: u32,
}

/// Figures without a row in the tables of transfer, with their labels.
const OTHERS: [(&str, &str, Kind); 4] = [
    (
        "bit_state/stick_slip_index",
        "stick-slip index of the bit",
        Kind::Number,
    ),
    (
        "contact_forces/max_pipe_guide_force",
        "largest force of pipe and guide",
        Kind::Force,
    ),
    (
        "contact_forces/max_guide_wall_force",
        "largest force of guide and wall",
        Kind::Force,
    ),
    (
        "joint_deflections/max_bend_angle",
        "largest bend of a joint",
        Kind::Bend,
    ),
];

impl Default for PlausibleTools {
    fn default() -> Self {
        let band = |name, transfer, label, kind| BandHistory {
            name,
            transfer,
            label,
            kind,
            quantiles: Default::default(),
        };
        let of_transfer = TRANSFER.iter().filter_map(|figure| {
            let shown = figure
                .shown
                .filter(|shown| !matches!(shown.group, Group::PutIn | Group::Taken))?;
            let name = format!("transfer/{}", figure.field);
            Some(band(name, Some(figure.field), shown.label, figure.kind))
        });
        let others = OTHERS
            .into_iter()
            .map(|(name, label, kind)| band(name.to_owned(), None, label, kind));
        Self {
            bands: of_transfer.chain(others).collect(),
            any_alarm: History::default(),
            alarms: Vec::new(),
            seconds: 0,
            without: 0,
            why: String::new(),
            members: 0,
            failed: 0,
            effective: [f64::INFINITY, 0.0],
            renewals: 0,
        }
    }
}

impl PlausibleTools {
    /// Takes the bands of an instant (s from the beginning).
    pub(crate) fn push(&mut self, time: f64, message: &Bands) {
        self.seconds += 1;
        if !message.no_bands.is_empty() {
            self.without += 1;
            if self.why.is_empty() {
                self.why.clone_from(&message.no_bands);
            }
        }
        // The largest numbers of the run, since members are replaced while it lasts.
        self.members = self.members.max(message.members);
        self.failed = self.failed.max(message.failed);
        self.renewals = self.renewals.max(message.renewals);
        if message.effective.is_finite() {
            let [least, most] = self.effective;
            self.effective = [least.min(message.effective), most.max(message.effective)];
        }
        for of in &mut self.bands {
            if let Some(band) = message.bands.iter().find(|band| band.name == of.name) {
                for (history, value) in of.quantiles.iter_mut().zip([band.p5, band.p50, band.p95]) {
                    history.push(time, value);
                }
            }
        }
        self.any_alarm.push(time, message.any_alarm);
        // A message has only the alarms that a member has: the mean divides by all messages.
        for alarm in &message.alarms {
            let known = (self.alarms.iter()).position(|known| known.id == alarm.id && known.priority == alarm.priority);
            let index = known.unwrap_or(self.alarms.len());
            if index == self.alarms.len() {
                if index >= MOST_ALARMS {
                    continue;
                }
                self.alarms.push(AlarmOfTools {
                    id: alarm.id.clone(),
                    name: alarm.name.clone(),
                    priority: alarm.priority,
                    sum: 0.0,
                    most: 0.0,
                    at: time,
                    seen: 0,
                    members: 0,
                });
            }
            let of = &mut self.alarms[index];
            of.sum += if alarm.probability.is_finite() {
                alarm.probability
            } else {
                0.0
            };
            if alarm.probability > of.most {
                (of.most, of.at) = (alarm.probability, time);
                (of.seen, of.members) = (alarm.seen, alarm.members);
            }
        }
    }

    /// Mean chance of an alarm over all messages; it is 0 in those that do not have it.
    pub(crate) fn mean_chance(&self, alarm: &AlarmOfTools) -> f64 {
        alarm.sum / self.seconds as f64
    }

    /// Bands of a field of `twin/transfer`.
    pub(crate) fn of_transfer(&self, field: &str) -> Option<&BandHistory> {
        self.bands.iter().find(|band| band.transfer == Some(field))
    }

    /// Whether any figure has a band.
    pub(crate) fn has_bands(&self) -> bool {
        self.bands.iter().any(|band| band.quantiles[1].range().is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_messages::{AlarmChance, FigureBand};

    fn second(p50: f64, chance: f64) -> Bands {
        let alarms = if chance > 0.0 {
            vec![AlarmChance {
                id: "stick_slip".to_owned(),
                name: "stick-slip".to_owned(),
                priority: 2,
                seen: 3,
                members: 12,
                probability: chance,
                ..AlarmChance::default()
            }]
        } else {
            Vec::new()
        };
        Bands {
            members: 12,
            effective: 10.0,
            bands: vec![FigureBand {
                name: "transfer/bit_torque".to_owned(),
                unit: "N m".to_owned(),
                p5: p50 - 10.0,
                p50,
                p95: p50 + 20.0,
            }],
            alarms,
            any_alarm: chance,
            ..Bands::default()
        }
    }

    #[test]
    fn bands_and_chances_are_kept_over_time() {
        let mut tools = PlausibleTools::default();
        for (time, p50, chance) in [(0.0, 90.0, 0.0), (1.0, 100.0, 0.5), (2.0, 110.0, 0.25)] {
            tools.push(time, &second(p50, chance));
        }
        tools.push(
            3.0,
            &Bands {
                no_bands: "5 plausible tools amount to 4.0 alike".to_owned(),
                effective: 4.0,
                any_alarm: f64::NAN,
                ..Bands::default()
            },
        );
        let means = tools
            .of_transfer("bit_torque")
            .unwrap()
            .quantiles
            .each_ref()
            .map(|history| history.range().unwrap().max);
        assert_eq!(means, [100.0, 110.0, 130.0]);
        assert_eq!((tools.seconds, tools.without, tools.members), (4, 1, 12));
        assert_eq!(tools.effective, [4.0, 10.0]);
        let alarm = &tools.alarms[0];
        assert_eq!((alarm.most, alarm.at, alarm.seen), (0.5, 1.0, 3));
        assert_eq!(tools.mean_chance(alarm), 0.75 / 4.0);
        assert!(tools.has_bands() && !PlausibleTools::default().has_bands());
    }

    /// Every label stands for a figure that members are compared by.
    #[test]
    fn all_figures_are_ones_of_the_bands() {
        let known = flexdrill_outputs::figures::OverTools::known();
        for band in PlausibleTools::default().bands {
            let found = known.iter().find(|known| known.name == band.name);
            assert_eq!(found.map(|found| found.unit), Some(band.kind.si()), "{}", band.name);
        }
    }
}
