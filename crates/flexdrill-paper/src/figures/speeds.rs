//! Figures 12 and 13: speeds.

use crate::findings::FIVE_PLACES;
use crate::motion::Motion;
use crate::record::{Record, Series};
use flexdrill_core::units::rad_per_s_to_rpm;
use flexdrill_plot::{Figure, Line, Panel};

fn history(record: &Record, series: &Series, station: usize, [from, to]: [f64; 2]) -> Vec<(f64, f64)> {
    let points = record
        .time
        .iter()
        .copied()
        .zip(series.at(station).map(rad_per_s_to_rpm));
    points.filter(|(time, _)| (from..=to).contains(time)).collect()
}

/// Speed of the pipe at five inclinations.
pub(super) fn pipe(record: &Record) -> Figure {
    let (first, last) = (
        record.time.first().copied().unwrap_or_default(),
        record.time.last().copied().unwrap_or_default(),
    );
    let turn = record.turn();
    let panel = |title: &str, range: [f64; 2]| {
        // The steepest curve first, so that the calm ones stay visible.
        let lines = FIVE_PLACES.iter().enumerate().rev().map(|(i, &degrees)| {
            let station = record.stations.nearest(degrees);
            Line::new(
                format!("{degrees} deg"),
                history(record, &record.pipe.spin, station, range),
            )
            .color([6, 4, 2, 0, 1][i])
            .thin()
        });
        lines.fold(Panel::new(title, "time (s)", "speed (r/min)"), Panel::line)
    };
    Figure {
        name: "fig12_pipe_speed",
        title: "Figure 12. Speed of the flexible pipe".to_owned(),
        caption: "At five inclinations. V1 is the record's first turn, V2 its last.".to_owned(),
        columns: 2,
        height: 380,
        panels: vec![
            panel("(a) Whole record", [first, last]).span(2),
            panel("(b) V1, the first turn", [first, first + turn]),
            panel("(c) V2, the last turn", [last - turn, last]),
        ],
    }
}

/// Speed of the guide where it moves most.
pub(super) fn guide(record: &Record, motion: &Motion) -> Figure {
    let all = [f64::MIN, f64::MAX];
    let ends = [record.time.first(), record.time.last()].map(|time| time.copied().unwrap_or_default());
    let mut panel = Panel::new("Speed of the guide pipe", "time (s)", "speed (r/min)");
    for (i, &station) in motion.places.iter().enumerate() {
        let name = format!("D{}, {:.1} deg", i + 1, record.stations.degrees(station));
        let line = Line::new(name, history(record, &record.guide.spin, station, all)).color(i);
        // The guide turns nearly as one piece: the second curve lies on the first.
        panel = panel.line(if i == 0 { line.wide() } else { line.thin() });
    }
    for (i, limit) in [-0.74, 0.97].into_iter().enumerate() {
        let name = if i == 0 { "paper's range" } else { "" };
        panel = panel.line(
            Line::new(name, ends.map(|time| (time, limit)).to_vec())
                .dashed()
                .color(6),
        );
    }
    Figure {
        name: "fig13_guide_speed",
        title: "Figure 13. Speed of the guide pipe".to_owned(),
        caption: "Spin rate of the guide at the two places where it moves most.".to_owned(),
        columns: 1,
        height: 380,
        panels: vec![panel],
    }
}
