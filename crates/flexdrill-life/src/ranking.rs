//! Joints to inspect: the most damaged first, each with what to do.

use std::collections::BTreeMap;

use flexdrill_base::Band;

use super::{Counted, Kind, LifeError, Lives, Row};
use crate::run::damages;

/// What no class knows, for whoever reads a ranking.
pub const UNKNOWN_TO_A_CLASS: &str = "A damage of 1 is a life: half of such details have a crack by then. The band has the \
    scatter of the class and of the stress concentration. It has neither the choice of the class, nor corrosion pits, wear \
    of the stop and of the pins, torsion, assembly and make-up, overloads, straightening and transport, nor what the joint \
    had drilled before its first run here. An inspection that finds a crack is right, whatever stands here.";

/// Median of a damage with the ends of its band, such as `0.42 (0.11 to 1.6)`.
pub fn damage_with_band(damage: Band) -> String {
    let [median, low, high] = [damage.median, damage.low, damage.high].map(damage_in_words);
    format!("{median} ({low} to {high})")
}

/// A damage with two digits; above a whole life with as many as it has.
pub fn damage_in_words(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        ..1e-4 => "below 0.0001".to_owned(),
        ..1.0 => {
            let digits = (1.0 - value.log10().floor()).max(1.0) as usize;
            format!("{value:.digits$}")
        }
        ..10.0 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// Which part of a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Its stop.
    Stop,
    /// The link below it, bent at its middle.
    Link,
}

impl Part {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Stop => "stop",
            Self::Link => "link below",
        }
    }
}

/// What to do with a joint. The worst is the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Its 95 % is below the listed part of a life.
    Sound,
    /// Its 95 % is a listed part of a life.
    Listed,
    /// Its 95 % is a life.
    Possible,
    /// Its median is a life.
    Expected,
}

impl Verdict {
    /// For the driller.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sound => "No inspection is due by fatigue.",
            Self::Listed => "Inspect it at the next opportunity.",
            Self::Possible => "A crack is possible: inspect it before the next run.",
            Self::Expected => "A crack is expected: take it out, and inspect it before it drills again.",
        }
    }
}

/// What to do at a damage, where a joint is listed from `1 / design_factor` on.
pub fn verdict(damage: Band, design_factor: f64) -> Verdict {
    if damage.median >= 1.0 {
        Verdict::Expected
    } else if damage.high >= 1.0 {
        Verdict::Possible
    } else if damage.high >= 1.0 / design_factor {
        Verdict::Listed
    } else {
        Verdict::Sound
    }
}

/// The damages of both parts of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Damages {
    pub(crate) stop: Band,
    pub(crate) link: Band,
}

impl Damages {
    fn of(kind: &Kind, [stop, link]: [f64; 2]) -> Self {
        let factors = kind.details.map(|detail| detail.band());
        Self {
            stop: Band::within_factor(stop, factors[0]),
            link: Band::within_factor(link, factors[1]),
        }
    }

    fn worst(&self) -> (Part, Band) {
        if self.stop.high > self.link.high {
            (Part::Stop, self.stop)
        } else {
            (Part::Link, self.link)
        }
    }
}

/// A joint of a table, over all its runs.
#[derive(Debug, Clone, PartialEq)]
pub struct JointOfFile {
    /// Serial number.
    pub serial: String,
    /// Model time of its runs (h).
    pub hours: f64,
    /// Number of its runs.
    pub runs: usize,
    /// Its place from the bit up in each run, the newest last.
    pub places: Vec<u32>,
    /// Damage of its stop.
    pub stop: Band,
    /// Damage of the link below it.
    pub link: Band,
    /// The more damaged part.
    pub part: Part,
    /// Damage of that part.
    pub damage: Band,
    /// What to do.
    pub verdict: Verdict,
    /// Hours at its mean rate until the 95 % of its damage is a life; 0 from then on, none without damage.
    pub hours_left: Option<f64>,
}

impl Lives {
    /// The joints, the most damaged first.
    pub fn ranked(&self) -> Vec<JointOfFile> {
        let mut by_serial: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
        for row in &self.rows {
            by_serial.entry(&row.serial).or_default().push(row);
        }
        let joints = by_serial.into_iter().map(|(serial, mut rows)| {
            rows.sort_by_key(|row| row.start);
            let sum = |of: fn(&Row) -> f64| rows.iter().map(|row| of(row)).sum::<f64>();
            let hours = sum(|row| row.hours);
            // The scatter is that of the joint, the same in all its runs: its bands add up as they are.
            let damages = Damages::of(&self.kind, [sum(|row| row.stop), sum(|row| row.link)]);
            let places = rows.iter().map(|row| row.place).collect();
            joint(serial, hours, places, damages, &self.kind)
        });
        let mut joints: Vec<JointOfFile> = joints.collect();
        sort(&mut joints);
        joints
    }
}

/// The joints of a run alone, the most damaged first. Without `serials`, from the bit up, a joint has its place as a name.
///
/// # Errors
/// When nothing was counted, or with another slope than the class has.
pub fn ranked(kind: &Kind, counted: &Counted, serials: &[String]) -> Result<Vec<JointOfFile>, LifeError> {
    let damages = damages(kind, counted)?;
    let from_bit = (1..).zip(damages.into_iter().rev());
    let mut joints: Vec<JointOfFile> = from_bit
        .map(|(place, damage): (u32, _)| {
            let named = serials.get(place as usize - 1).cloned();
            let serial = named.unwrap_or_else(|| format!("place {place}"));
            joint(
                &serial,
                counted.duration() / 3600.0,
                vec![place],
                Damages::of(kind, damage),
                kind,
            )
        })
        .collect();
    sort(&mut joints);
    Ok(joints)
}

fn joint(serial: &str, hours: f64, places: Vec<u32>, damages: Damages, kind: &Kind) -> JointOfFile {
    let (part, damage) = damages.worst();
    JointOfFile {
        serial: serial.to_owned(),
        hours,
        runs: places.len(),
        places,
        stop: damages.stop,
        link: damages.link,
        part,
        damage,
        verdict: verdict(damage, kind.design_factor),
        hours_left: (damage.high > 0.0).then(|| (hours * (1.0 / damage.high - 1.0)).max(0.0)),
    }
}

fn sort(joints: &mut [JointOfFile]) {
    joints.sort_by(|a, b| {
        b.damage
            .high
            .total_cmp(&a.damage.high)
            .then_with(|| a.serial.cmp(&b.serial))
    });
}

#[cfg(test)]
mod tests {
    use super::damage_in_words;

    #[test]
    fn damages_have_two_digits() {
        for (value, text) in [
            (0.0, "0"),
            (3e-5, "below 0.0001"),
            (0.000_123, "0.00012"),
            (0.0346, "0.035"),
            (0.42, "0.42"),
            (3.21, "3.2"),
            (41.6, "42"),
        ] {
            assert_eq!(damage_in_words(value), text, "{value}");
        }
    }
}
