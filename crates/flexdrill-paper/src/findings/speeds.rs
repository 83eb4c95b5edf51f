//! Spin rates: Fig. 12 and 13.

use super::SHORTEST;
use super::finding::{Finding, Paper, Verdict, closeness, finding, number, periodic};
use crate::motion::Motion;
use crate::record::Record;
use crate::series::{dominant_period, range, spread};
use flexdrill_core::units::rad_per_s_to_rpm;

pub(super) fn findings(record: &Record, guide: &Motion) -> Vec<Finding> {
    let stations = &record.stations;
    // The five inclinations are those of the paper's figure.
    let ripples: Vec<f64> = FIVE_PLACES
        .iter()
        .map(|&degrees| rad_per_s_to_rpm(spread(record.pipe.spin.at(stations.nearest(degrees)))))
        .collect();
    let words = ripples
        .iter()
        .map(|ripple| format!("{ripple:.2}"))
        .collect::<Vec<_>>()
        .join(", ");
    // The claim is about growth, so that intervals are counted and not the values compared.
    let rising = ripples.windows(2).filter(|pair| pair[1] > pair[0]).count();
    let largest_last = ripples.iter().all(|&ripple| ripple <= ripples[4]);
    // Partly: the largest ripple is at the bit, but it does not rise everywhere.
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
    // The range is over both locations of largest motion.
    let spins = guide
        .places
        .map(|s| range(record.guide.spin.at(s)).map(rad_per_s_to_rpm));
    let [low, high] = [spins[0][0].min(spins[1][0]), spins[0][1].max(spins[1][1])];
    // The clearer of two periods: at either location the motion may hardly repeat.
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
pub(crate) const FIVE_PLACES: [f64; 5] = [0.0, 22.5, 45.0, 67.5, 90.0];

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
