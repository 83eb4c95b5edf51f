//! The episodes of the motion in a replay, as a table for a person and as JSON for a program. The command line calls
//! them incidents.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Context as _;
use serde::Serialize;

use super::log::LogPlace;
use crate::cli::output::say;
use flexdrill_core::units::{n_to_kn, rad_to_deg};
use flexdrill_motion::{Episode, EpisodeKind, Severity, WhirlKind};
use flexdrill_outputs::words;

/// Most rows that are printed; the JSON has all.
const ROWS: usize = 40;

/// Stations of the joints, top to bottom, to call stations by their joint.
pub(super) struct Joints(pub(super) Vec<usize>);

impl Joints {
    /// Number of the joint at a station, from 1 at the top as in `joint_01`.
    fn number(&self, station: usize) -> Option<usize> {
        self.0.iter().position(|at| *at == station).map(|index| index + 1)
    }

    fn name(&self, station: usize) -> String {
        match self.number(station) {
            Some(joint) => format!("joint {joint:02}"),
            None => format!("station {station}"),
        }
    }

    fn range(&self, [first, last]: [usize; 2]) -> String {
        if first == last {
            return self.name(first);
        }
        match (self.number(first), self.number(last)) {
            (Some(first), Some(last)) => format!("joints {first:02}-{last:02}"),
            _ => format!("stations {first}-{last}"),
        }
    }
}

fn kind(kind: EpisodeKind) -> &'static str {
    match kind {
        EpisodeKind::ForwardWhirl => WhirlKind::Forward.name(),
        EpisodeKind::BackwardWhirl => WhirlKind::Backward.name(),
        EpisodeKind::RollingWhirl => "rolling whirl",
        EpisodeKind::ChaoticWhirl => WhirlKind::Chaotic.name(),
        EpisodeKind::StickSlip => "stick-slip",
        EpisodeKind::Shock => "shock",
    }
}

/// The severity's word; in capitals when something is to be done.
fn severity(severity: Severity) -> String {
    let word = severity.name();
    if severity >= Severity::Warning {
        word.to_uppercase()
    } else {
        word.to_owned()
    }
}

fn evidence(episode: &Episode) -> String {
    match episode.kind {
        EpisodeKind::StickSlip => format!("index up to {:.2}", episode.strength),
        EpisodeKind::Shock => format!("up to {:.1} N s in an interval", episode.strength),
        _ => {
            let mut text = String::new();
            // Chaos has no rate.
            if episode.whirl_ratio.abs() > 0.0 {
                let _ = write!(text, "x{:.2} of the speed, ", episode.whirl_ratio);
            }
            let _ = write!(
                text,
                "{:.0} % of the gap, contact {:.0} %, {:.2} kN",
                100.0 * episode.clearance_ratio,
                100.0 * episode.contact_duty,
                n_to_kn(episode.peak_force)
            );
            if episode.rolling_share > 0.0 {
                let _ = write!(text, ", {:.0} % of rolling", 100.0 * episode.rolling_share);
            }
            text
        }
    }
}

/// The table, one line per episode, in the order of their beginning.
/// Where a field log drove the run, each has its row.
pub(super) fn table(episodes: &[Episode], joints: &Joints, log: &LogPlace) -> String {
    if episodes.is_empty() {
        return "  incidents              none\n".to_owned();
    }
    let mut text = format!(
        "\nincidents: {}\n  {:>9} {:>10}  {:<9} {:<15} {:<5} {:<14} {:>6} {:>5}  evidence\n",
        episodes.len(),
        "at s",
        "for s",
        "severity",
        "kind",
        "of",
        "place",
        "m",
        "deg"
    );
    // The worst ones when there are too many.
    let mut shown: Vec<usize> = (0..episodes.len()).collect();
    shown.sort_by_key(|index| std::cmp::Reverse(episodes[*index].severity));
    shown.truncate(ROWS);
    shown.sort_unstable();
    for episode in shown.iter().map(|index| &episodes[*index]) {
        // `>` marks an episode that the end of the run cut: its duration is a lower bound.
        let lasts = format!("{}{:.2}", if episode.lasting { ">" } else { "" }, episode.duration);
        let _ = writeln!(
            text,
            "  {:>9.2} {lasts:>10}  {:<9} {:<15} {:<5} {:<14} {:>6.2} {:>5.0}  {}",
            episode.start,
            severity(episode.severity),
            kind(episode.kind),
            words::body(episode.place.body),
            joints.range(episode.stations),
            episode.place.measured_depth,
            rad_to_deg(episode.place.inclination),
            match log.row(episode.start).as_str() {
                "" => evidence(episode),
                row => format!("{}; from {row} of the log", evidence(episode)),
            }
        );
    }
    if episodes.len() > shown.len() {
        let _ = writeln!(
            text,
            "  and {} more, none worse than these; --incidents FILE.json has all",
            episodes.len() - shown.len()
        );
    }
    text
}

#[derive(Serialize)]
struct Row<'a> {
    #[serde(flatten)]
    episode: &'a Episode,
    /// Joint at the worst place, from 1 at the top.
    joint: Option<usize>,
    inclination_deg: f64,
}

/// Writes all episodes: an array of objects, SI units.
///
/// # Errors
/// When the file cannot be written.
pub(super) fn write_json(path: &Path, episodes: &[Episode], joints: &Joints) -> anyhow::Result<()> {
    let rows: Vec<_> = episodes
        .iter()
        .map(|episode| Row {
            episode,
            joint: joints.number(episode.place.station),
            inclination_deg: rad_to_deg(episode.place.inclination),
        })
        .collect();
    let text = serde_json::to_string_pretty(&rows)?;
    std::fs::write(path, text + "\n")
        .with_context(|| format!("the incidents could not be written to {}", path.display()))?;
    say!("wrote {} incidents to {}", rows.len(), path.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_core::tool::Body;
    use flexdrill_motion::ToolLocation;

    fn rolling() -> Episode {
        Episode {
            kind: EpisodeKind::RollingWhirl,
            severity: Severity::Critical,
            start: 12.5,
            duration: 3.25,
            lasting: true,
            place: ToolLocation {
                station: 150,
                body: Body::Pipe,
                measured_depth: 4.57,
                inclination: 1.43,
            },
            stations: [145, 155],
            whirl_ratio: -3.6,
            rolling_share: 0.97,
            clearance_ratio: 1.02,
            contact_duty: 0.9,
            peak_force: 25e3,
            strength: 0.0,
            confidence: 0.95,
        }
    }

    #[test]
    fn a_row_says_when_where_what_how_bad_and_how_long() {
        let joints = Joints((1..33).map(|joint| 5 * joint).collect());
        let text = table(&[rolling()], &joints, &LogPlace::default());
        for part in [
            "12.50",
            ">3.25",
            "CRITICAL",
            "rolling whirl",
            "pipe",
            "joints 29-31",
            "4.57",
            "82",
            "x-3.60",
            "25.00 kN",
            "97 % of rolling",
        ] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
        assert!(table(&[], &joints, &LogPlace::default()).contains("none"));
        let many = vec![rolling(); ROWS + 3];
        assert!(table(&many, &joints, &LogPlace::default()).contains("and 3 more"));
    }

    #[test]
    fn json_holds_everything_in_si() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("incidents.json");
        let stick = Episode {
            kind: EpisodeKind::StickSlip,
            stations: [165; 2],
            place: ToolLocation {
                station: 165,
                ..rolling().place
            },
            ..rolling()
        };
        write_json(&path, &[rolling(), stick], &Joints(vec![150])).unwrap();
        let rows: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
        assert_eq!(rows[0]["kind"], "rolling_whirl");
        assert_eq!(rows[0]["severity"], "critical");
        assert_eq!(rows[0]["joint"], 1);
        assert_eq!(rows[0]["place"]["body"], "pipe");
        assert_eq!(rows[1]["joint"], serde_json::Value::Null);
        assert_eq!(rows[1]["start"], 12.5);
    }
}
