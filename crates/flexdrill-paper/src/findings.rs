//! The paper's findings as numbers of a record, and whether they agree.
//!
//! "Effective value" is the root mean square over the record. All definitions stand with their findings and in the report.

use super::motion::{Motion, Whirl, motion};
use super::record::{Layer, Record};
use super::series::{contact_episodes, dominant_period, largest, range, spread};
use flexdrill_core::motion::WhirlKind;
use flexdrill_core::tool::Body;
use flexdrill_core::units::rad_per_s_to_rpm;

/// Whether a finding of the paper is one of ours too.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Yes; a number within 20 %.
    Agrees,
    /// In part; a number within a factor of two.
    Partly,
    /// No.
    No,
}

impl Verdict {
    /// As the report says it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Partly => "partly",
            Self::No => "no",
        }
    }
}

/// One finding.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Finding {
    /// Short name, for tables.
    pub key: &'static str,
    /// The paper's figure.
    pub figure: &'static str,
    /// What the paper found.
    pub paper: &'static str,
    /// What is measured here.
    pub definition: &'static str,
    /// Our number, in the unit of the definition.
    pub value: f64,
    /// What was found here, in words and numbers.
    pub ours: String,
    /// Whether they agree.
    pub verdict: Verdict,
    /// Why (not).
    pub why: String,
    /// 0 to 1: 1 agrees, less the further away. For the search.
    pub closeness: f64,
}

/// A number within this factor of the paper's agrees: the paper's parameters are unpublished and the motion is chaotic.
const AGREES: f64 = 1.2;
/// Within this factor it agrees partly.
const PARTLY: f64 = 2.0;
/// From this factor on it is not close at all.
const FAR: f64 = 100.0;
/// A place agrees within (deg): two links.
const PLACE_AGREES: f64 = 5.0;
/// And partly within (deg).
const PLACE_PARTLY: f64 = 15.0;
/// Autocorrelation from which a history counts as periodic.
const PERIODIC: f64 = 0.3;
/// Shortest period looked for, in turns: twenty times the turning rate is noise of single impacts.
const SHORTEST: f64 = 0.05;
/// Most closeness that a finding which does not agree can have.
const NEAR_MISS: f64 = 0.9;

/// What the paper says, for [`number`] and its like.
struct Paper {
    key: &'static str,
    figure: &'static str,
    says: &'static str,
    definition: &'static str,
}

/// All findings of model, in the order of the figures.
pub fn findings(record: &Record) -> Vec<Finding> {
    let pipe = motion(record, Body::Pipe);
    let guide = motion(record, Body::Guide);
    let mut all = shapes(record, &pipe, &guide);
    all.extend(speeds(record, &guide));
    all.extend(forces(record));
    all.extend(accelerations(record));
    all
}

/// Mean closeness, 0 to 1, and the number of findings that agree.
pub fn score(findings: &[Finding]) -> (f64, usize) {
    let sum: f64 = findings.iter().map(|finding| finding.closeness).sum();
    let agree = findings.iter().filter(|f| f.verdict == Verdict::Agrees).count();
    (sum / findings.len().max(1) as f64, agree)
}

/// A positive number against the paper's.
fn number(paper: Paper, unit: &str, digits: usize, value: f64, expected: f64) -> Finding {
    let ratio = value / expected;
    let off = if ratio > 0.0 {
        ratio.max(1.0 / ratio)
    } else {
        f64::INFINITY
    };
    let verdict = if off <= AGREES {
        Verdict::Agrees
    } else if off <= PARTLY {
        Verdict::Partly
    } else {
        Verdict::No
    };
    let why = match verdict {
        Verdict::Agrees => format!("{:+.0} %, within 20 %", 100.0 * (ratio - 1.0)),
        Verdict::Partly => format!("{ratio:.2} of the paper's, within a factor of 2"),
        Verdict::No => format!("{ratio:.3} of the paper's"),
    };
    let closeness = closeness(verdict, 1.0 - off.ln() / FAR.ln());
    finding(
        paper,
        value,
        format!("{value:.digits$} {unit}"),
        verdict,
        why,
        closeness,
    )
}

/// A place (deg) against the paper's.
fn place(paper: Paper, value: f64, expected: f64) -> Finding {
    let off = (value - expected).abs();
    let verdict = if off <= PLACE_AGREES {
        Verdict::Agrees
    } else if off <= PLACE_PARTLY {
        Verdict::Partly
    } else {
        Verdict::No
    };
    let why = format!("{off:.1} degrees from the paper's place");
    let closeness = closeness(verdict, 1.0 - off / 90.0);
    finding(paper, value, format!("{value:.1} deg"), verdict, why, closeness)
}

fn closeness(verdict: Verdict, near: f64) -> f64 {
    match verdict {
        Verdict::Agrees => 1.0,
        Verdict::Partly | Verdict::No => NEAR_MISS * near.clamp(0.0, 1.0),
    }
}

fn finding(paper: Paper, value: f64, ours: String, verdict: Verdict, why: String, closeness: f64) -> Finding {
    Finding {
        key: paper.key,
        figure: paper.figure,
        paper: paper.says,
        definition: paper.definition,
        value,
        ours,
        verdict,
        why,
        closeness,
    }
}

/// Three levels of a ratio: agrees from the first, partly from the second.
fn ratio(paper: Paper, ours: String, value: f64, [agrees, partly]: [f64; 2], why: &str) -> Finding {
    let verdict = if value >= agrees {
        Verdict::Agrees
    } else if value >= partly {
        Verdict::Partly
    } else {
        Verdict::No
    };
    let why = format!("{why}: {value:.2}; agrees from {agrees}, partly from {partly}");
    finding(paper, value, ours, verdict, why, closeness(verdict, value / agrees))
}

fn shapes(record: &Record, pipe: &Motion, guide: &Motion) -> Vec<Finding> {
    let stations = &record.stations;
    let mean_between = |low: f64, high: f64| {
        let inside: Vec<f64> = (0..stations.len())
            .filter(|&s| (low..=high).contains(&stations.degrees(s)))
            .map(|s| pipe.radius[s])
            .collect();
        inside.iter().sum::<f64>() / inside.len().max(1) as f64
    };
    let end = stations.degrees(stations.len() - 1);
    let (upper, lower) = (mean_between(0.0, end / 3.0), mean_between(2.0 * end / 3.0, end));
    // Where links were continuous, kinks would be spread over all stations alike.
    let even = stations.joint.iter().filter(|&&joint| joint).count() as f64 / stations.len().max(1) as f64;
    vec![
        ratio(
            Paper {
                key: "pipe_shape",
                figure: "10a",
                says: "the pipe deforms as a broken line",
                definition: "part of the shape's squared kinks (change of slope between elements) that is at joints, over that of a smooth pipe",
            },
            format!("{:.0} % of the kinks at joints", 100.0 * pipe.broken),
            pipe.broken / even.max(f64::MIN_POSITIVE),
            [1.5, 1.2],
            "ratio",
        ),
        whirl(
            Paper {
                key: "pipe_whirl",
                figure: "10b, d",
                says: "forward whirl at one place of largest motion, backward at the other",
                definition: "whirl analysis of the pipe's path in the bore at the two largest RMS motions, at least 10 degrees apart; a kind counts if it stands for more than half of the record",
            },
            record,
            pipe,
        ),
        ratio(
            Paper {
                key: "pipe_bottom",
                figure: "10",
                says: "the pipe moves more near the bottom",
                definition: "mean RMS motion in the lowest third over that in the uppermost third",
            },
            format!(
                "{:.2} mm in the lowest, {:.2} mm in the uppermost third",
                1e3 * lower,
                1e3 * upper
            ),
            lower / upper.max(f64::MIN_POSITIVE),
            [1.2, 1.0],
            "ratio",
        ),
        ratio(
            Paper {
                key: "guide_shape",
                figure: "11a",
                says: "the guide's shape is smoother than the pipe's",
                definition: "RMS kink of the pipe's shape over that of the guide's",
            },
            format!("pipe {:.2}, guide {:.2} mrad", 1e3 * pipe.kink, 1e3 * guide.kink),
            pipe.kink / guide.kink.max(f64::MIN_POSITIVE),
            [2.0, 1.2],
            "ratio",
        ),
        whirl(
            Paper {
                key: "guide_whirl",
                figure: "11b, d",
                says: "the guide whirls too, forward at one place and backward at the other",
                definition: "as for the pipe",
            },
            record,
            guide,
        ),
    ]
}

fn whirl(paper: Paper, record: &Record, motion: &Motion) -> Finding {
    let at = motion.places.map(|s| motion.whirl[s]);
    let ours = motion
        .places
        .iter()
        .zip(&at)
        .map(|(&s, whirl)| format!("{:.1} deg: {}", record.stations.degrees(s), whirl.words()))
        .collect::<Vec<_>>()
        .join("; ");
    let [a, b] = at.map(|whirl| whirl.kind());
    let everywhere = |kind| motion.whirl.iter().filter(|whirl| whirl.kind() == Some(kind)).count();
    let (forward, backward) = (everywhere(WhirlKind::Forward), everywhere(WhirlKind::Backward));
    let opposite = a.is_some() && b.is_some() && a != b;
    // How far the two places are from being opposite for the whole record.
    let against = |x: &Whirl, y: &Whirl| x.forward * y.backward;
    let near = against(&at[0], &at[1]).max(against(&at[1], &at[0])).sqrt();
    let count = format!("{forward} stations forward, {backward} backward for more than half of the record");
    let (verdict, why, near) = if opposite {
        (Verdict::Agrees, format!("opposite at the two places; {count}"), 1.0)
    } else if forward > 0 && backward > 0 {
        let why = format!("both directions occur, but not one at each of the two largest motions: {count}");
        (Verdict::Partly, why, 0.5 + 0.5 * near)
    } else if a.is_some() || b.is_some() {
        (
            Verdict::No,
            format!("whirl in one direction only: {count}"),
            0.2 + 0.5 * near,
        )
    } else {
        (
            Verdict::No,
            format!("no steady whirl at either place: {count}"),
            0.5 * near,
        )
    };
    finding(paper, near, ours, verdict, why, closeness(verdict, near))
}

fn speeds(record: &Record, guide: &Motion) -> Vec<Finding> {
    let stations = &record.stations;
    let ripples: Vec<f64> = FIVE_PLACES
        .iter()
        .map(|&degrees| rad_per_s_to_rpm(spread(record.pipe.spin.at(stations.nearest(degrees)))))
        .collect();
    let words = ripples
        .iter()
        .map(|ripple| format!("{ripple:.2}"))
        .collect::<Vec<_>>()
        .join(", ");
    let rising = ripples.windows(2).filter(|pair| pair[1] > pair[0]).count();
    let largest_last = ripples.iter().all(|&ripple| ripple <= ripples[4]);
    let verdict = if rising == 4 {
        Verdict::Agrees
    } else if largest_last {
        Verdict::Partly
    } else {
        Verdict::No
    };
    let ripple = finding(
        Paper {
            key: "ripple",
            figure: "12",
            says: "the ripple of the pipe's speed grows with inclination",
            definition: "RMS of the pipe's spin rate about its mean at 0, 22.5, 45, 67.5 and 90 degrees (r/min)",
        },
        ripples[4],
        format!("{words} r/min"),
        verdict,
        format!("rises in {rising} of 4 intervals"),
        closeness(verdict, rising as f64 / 4.0),
    );
    let spins = guide
        .places
        .map(|s| range(record.guide.spin.at(s)).map(rad_per_s_to_rpm));
    let [low, high] = [spins[0][0].min(spins[1][0]), spins[0][1].max(spins[1][1])];
    let period = guide.places.map(|s| {
        dominant_period(
            &record.guide.spin.at(s).collect::<Vec<_>>(),
            record.interval,
            SHORTEST * record.turn(),
        )
    });
    let clearer = period[usize::from(period[1].strength > period[0].strength)];
    vec![
        ripple,
        guide_range([low, high]),
        periodic(
            Paper {
                key: "guide_period",
                figure: "13",
                says: "the guide turns with the pipe's period, 1.5 s",
                definition: "dominant period (autocorrelation) of the guide's spin rate at its two largest motions, the clearer one (s)",
            },
            clearer.period,
            clearer.strength,
            record.turn(),
        ),
    ]
}

/// Inclinations of Fig. 12 (deg).
pub(super) const FIVE_PLACES: [f64; 5] = [0.0, 22.5, 45.0, 67.5, 90.0];

/// The range of the guide's speed, Fig. 13: the width is compared, and that it turns both ways.
fn guide_range([low, high]: [f64; 2]) -> Finding {
    const PAPER_RANGE: [f64; 2] = [-0.74, 0.97];
    let mut found = number(
        Paper {
            key: "guide_speed",
            figure: "13",
            says: "the guide's speed lies between -0.74 and 0.97 r/min",
            definition: "smallest and largest spin rate of the guide at its two largest motions; the range's width is compared (r/min)",
        },
        "r/min",
        3,
        high - low,
        PAPER_RANGE[1] - PAPER_RANGE[0],
    );
    found.ours = format!("{low:.3} to {high:.3} r/min");
    if !(low < 0.0 && high > 0.0) {
        found.verdict = Verdict::No;
        found.why = "does not turn both ways".to_owned();
        found.closeness = 0.0;
    }
    found
}

fn periodic(paper: Paper, period: f64, strength: f64, expected: f64) -> Finding {
    let mut found = number(paper, "s", 2, period, expected);
    found.ours = format!("{period:.2} s, autocorrelation {strength:.2}");
    if strength < PERIODIC && found.verdict != Verdict::No {
        found.verdict = Verdict::No;
        found.why = format!("hardly periodic: autocorrelation {strength:.2}, periodic from {PERIODIC}");
    }
    if found.verdict != Verdict::Agrees {
        found.closeness = found.closeness.min(NEAR_MISS) * (0.5 + 0.5 * strength.clamp(0.0, 1.0));
    }
    found
}

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
pub(super) fn worst_place(layer: &Layer) -> usize {
    largest(&layer.square)
}

fn forces(record: &Record) -> Vec<Finding> {
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
    const FORCE: &str = "largest RMS normal force of a station (kN)";
    const PLACE: &str = "inclination of that station (deg)";
    const PEAK: &str = "largest normal force there (kN)";
    const PERIOD: &str = "dominant period (autocorrelation) of the force there (s)";
    const CONTACT: &str = "time in contact there per turn of the drive (s)";
    let kn = 1e-3;
    all.push(number(
        text(
            "inner_force",
            "14a",
            "largest effective pipe-guide force 19.97 kN",
            FORCE,
        ),
        "kN",
        3,
        kn * inner.force,
        19.97,
    ));
    all.push(place(
        text("inner_place", "14a", "at 88 degrees, the lowermost section", PLACE),
        degrees(&inner),
        88.0,
    ));
    all.push(number(
        text("inner_peak", "14b", "largest force there 44.42 kN", PEAK),
        "kN",
        3,
        kn * inner.peak,
        44.42,
    ));
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
        kn * outer.force,
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
        kn * outer.peak,
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

fn accelerations(record: &Record) -> Vec<Finding> {
    let effective = |squares: &[Vec<f64>; 3], k: usize| squares[k].iter().fold(0.0_f64, |m, &x| m.max(x)).sqrt();
    let pipe = [0, 1, 2].map(|k| effective(&record.pipe.acceleration_square, k));
    let guide = [0, 1, 2].map(|k| effective(&record.guide.acceleration_square, k));
    let words = |a: [f64; 3]| format!("x {:.2}, y {:.2}, z {:.2} m/s2", a[0], a[1], a[2]);
    vec![
        ratio(
            Paper {
                key: "lateral",
                figure: "16",
                says: "the pipe's lateral (y) acceleration dominates",
                definition: "largest RMS acceleration of a station along y over the larger of x and z",
            },
            words(pipe),
            pipe[1] / pipe[0].max(pipe[2]).max(f64::MIN_POSITIVE),
            [1.1, 0.9],
            "ratio",
        ),
        ratio(
            Paper {
                key: "pipe_over_guide",
                figure: "17",
                says: "the pipe's acceleration is larger than the guide's",
                definition: "largest RMS acceleration of the pipe along y over the guide's",
            },
            format!(
                "pipe {:.2}, guide {:.2} m/s2 (guide: {})",
                pipe[1],
                guide[1],
                words(guide)
            ),
            pipe[1] / guide[1].max(f64::MIN_POSITIVE),
            [1.2, 1.0],
            "ratio",
        ),
    ]
}
