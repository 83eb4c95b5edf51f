//! Contact forces: Fig. 14 and 15.

use super::SHORTEST;
use super::finding::{Finding, Paper, number, periodic, place};
use crate::record::{Layer, Record};
use crate::series::{contact_episodes, dominant_period, largest, range};
use flexdrill_core::units::n_to_kn;

/// Effective value, place, peak, period and contact time of a layer at its worst place.
struct Worst {
    station: usize,
    force: f64,
    peak: f64,
    period: f64,
    strength: f64,
    contact: f64,
    collisions: f64,
}

impl Worst {
    fn of(record: &Record, layer: &Layer) -> Self {
        let station = largest(&layer.square);
        let history: Vec<f64> = layer.mean.at(station).collect();
        let period = dominant_period(&history, record.interval, SHORTEST * record.turn());
        Self {
            station,
            force: layer.square[station].sqrt(),
            peak: range(layer.peak.at(station))[1],
            period: period.period,
            strength: period.strength,
            contact: layer.contact[station] * record.turn(),
            collisions: contact_episodes(history.into_iter()) as f64 * record.turn() / record.duration(),
        }
    }
}

/// The station with the largest effective force.
pub(crate) fn worst_place(layer: &Layer) -> usize {
    largest(&layer.square)
}

pub(super) fn findings(record: &Record) -> Vec<Finding> {
    // Each finding quotes the paper's number and defines how ours is
    // measured, because the paper does not say how it has its own.
    let mut all = Vec::new();
    let inner = Worst::of(record, &record.inner);
    let outer = Worst::of(record, &record.outer);
    let degrees = |worst: &Worst| record.stations.degrees(worst.station);
    let text = |key, figure, says, definition| Paper {
        key,
        figure,
        says,
        definition,
    };
    // The definitions are shared, so that both contacts are measured alike.
    const FORCE: &str = "largest RMS normal force of a station (kN)";
    const PLACE: &str = "inclination of that station (deg)";
    const PEAK: &str = "largest normal force there (kN)";
    const PERIOD: &str = "dominant period (autocorrelation) of the force there (s)";
    const CONTACT: &str = "time in contact there per turn of the drive (s)";
    // Pipe and guide first, then guide and wall, in the order of the figures.
    all.push(number(
        text(
            "inner_force",
            "14a",
            "largest effective pipe-guide force 19.97 kN",
            FORCE,
        ),
        "kN",
        3,
        n_to_kn(inner.force),
        19.97,
    ));
    // The location of the largest force is a separate finding: a right number at a wrong location would not agree.
    all.push(place(
        text("inner_place", "14a", "at 88 degrees, the lowermost section", PLACE),
        degrees(&inner),
        88.0,
    ));
    all.push(number(
        text("inner_peak", "14b", "largest force there 44.42 kN", PEAK),
        "kN",
        3,
        n_to_kn(inner.peak),
        44.42,
    ));
    // A period counts by the strength of its autocorrelation, since every record has some period.
    all.push(periodic(
        text("inner_period", "14b", "collides every 1.5 s, one turn", PERIOD),
        inner.period,
        inner.strength,
        record.turn(),
    ));
    all.push(contact(
        text("inner_contact", "14b", "each collision lasts 1.27 s", CONTACT),
        &inner,
        1.27,
    ));
    all.push(number(
        text(
            "outer_force",
            "15a",
            "largest effective guide-wall force 4.82 kN",
            FORCE,
        ),
        "kN",
        3,
        n_to_kn(outer.force),
        4.82,
    ));
    all.push(place(
        text("outer_place", "15a", "at 81 degrees", PLACE),
        degrees(&outer),
        81.0,
    ));
    all.push(number(
        text("outer_peak", "15b", "largest force there 12.81 kN", PEAK),
        "kN",
        3,
        n_to_kn(outer.peak),
        12.81,
    ));
    all.push(periodic(
        text("outer_period", "15b", "collides every 1.5 s", PERIOD),
        outer.period,
        outer.strength,
        record.turn(),
    ));
    all.push(contact(
        text("outer_contact", "15b", "each collision lasts 0.56 s", CONTACT),
        &outer,
        0.56,
    ));
    all
}

fn contact(paper: Paper, worst: &Worst, expected: f64) -> Finding {
    let mut found = number(paper, "s", 2, worst.contact, expected);
    found.ours = format!("{:.2} s per turn, in {:.1} collisions", worst.contact, worst.collisions);
    found
}
