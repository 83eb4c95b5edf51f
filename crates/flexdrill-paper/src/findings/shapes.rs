//! Deflected shapes and whirl: Fig. 10 and 11.

use super::finding::{Finding, Paper, Verdict, closeness, finding, ratio};
use crate::motion::{Motion, Whirl};
use crate::record::Record;
use flexdrill_motion::WhirlKind;

pub(super) fn findings(record: &Record, pipe: &Motion, guide: &Motion) -> Vec<Finding> {
    let stations = &record.stations;
    // Means over thirds, because single stations scatter by their joints.
    let mean_between = |low: f64, high: f64| {
        let inside: Vec<f64> = (0..stations.len())
            .filter(|&s| (low..=high).contains(&stations.degrees(s)))
            .map(|s| pipe.radius[s])
            .collect();
        inside.iter().sum::<f64>() / inside.len().max(1) as f64
    };
    let end = stations.degrees(stations.len() - 1);
    // The thirds are of inclination, the paper's axis.
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
            // Ratios with two limits: from the first on it agrees, from the second on partly.
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
                // The divisor has a floor, for a tool that does not move in its upper third.
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
