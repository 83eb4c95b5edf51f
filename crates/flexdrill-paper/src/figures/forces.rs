//! Figures 14 to 17: contact forces and accelerations over inclination, and their histories.

use crate::findings::worst_place;
use crate::record::{Axis, Layer, Record};
use flexdrill_core::units::n_to_kn;
use flexdrill_plot::{Figure, Line, Panel};

/// Pipe on guide, Fig. 14.
pub(super) fn inner(record: &Record) -> Figure {
    let text = Text {
        name: "fig14_pipe_guide_force",
        title: "Figure 14. Contact force between flexible pipe and guide pipe",
        mark: "Cr",
    };
    contact(record, &record.inner, text, (88.0, 19.97))
}

/// Guide on wall, Fig. 15.
pub(super) fn outer(record: &Record) -> Figure {
    let text = Text {
        name: "fig15_guide_wall_force",
        title: "Figure 15. Contact force between guide pipe and wall",
        mark: "Cd",
    };
    contact(record, &record.outer, text, (81.0, 4.82))
}

/// Pipe, Fig. 16.
pub(super) fn pipe_acceleration(record: &Record) -> Figure {
    let text = Text {
        name: "fig16_pipe_acceleration",
        title: "Figure 16. Acceleration of the flexible pipe",
        mark: "Ary",
    };
    acceleration(record, &record.pipe, text, 3)
}

/// Guide, Fig. 17.
pub(super) fn guide_acceleration(record: &Record) -> Figure {
    let text = Text {
        name: "fig17_guide_acceleration",
        title: "Figure 17. Acceleration of the guide pipe",
        mark: "Ady",
    };
    acceleration(record, &record.guide, text, 1)
}

struct Text {
    name: &'static str,
    title: &'static str,
    mark: &'static str,
}

fn contact(record: &Record, layer: &Layer, text: Text, paper: (f64, f64)) -> Figure {
    let stations = &record.stations;
    // The effective value of the paper is the root mean square over the record.
    let force = |s: usize| (stations.degrees(s), n_to_kn(layer.square[s].sqrt()));
    let pick = |joint: bool| {
        (0..stations.len())
            .filter(|&s| stations.joint[s] == joint)
            .map(force)
            .collect::<Vec<_>>()
    };
    // All stations as a line and the joints as dots: the paper's claim is that the joints stand out.
    let all = (0..stations.len()).map(force).collect();
    let worst = worst_place(layer);
    let mut profile = Panel::new("(a) Effective force", "inclination (deg)", "RMS force (kN)")
        .line(Line::new("", all).thin().color(0))
        .line(Line::new("joint", pick(true)).dots().color(1))
        .line(Line::new(text.mark, vec![force(worst)]).diamond().color(2))
        .from_zero();
    // A point far above everything would flatten the curve.
    let caption = if paper.1 < 4.0 * force(worst).1 {
        profile = profile.line(Line::new("paper's largest", vec![paper]).diamond().color(6));
        String::new()
    } else {
        format!(
            " The paper's largest, {} kN at {} deg, is off the scale.",
            paper.1, paper.0
        )
    };
    // The largest force within each sample, or the short collisions would fall between the samples.
    let history = record
        .time
        .iter()
        .copied()
        .zip(layer.peak.at(worst).map(n_to_kn))
        .collect();
    Figure {
        name: text.name,
        title: text.title.to_owned(),
        caption: format!(
            "Root mean square over the record per station; largest value in each sample's {:.0} ms at the worst place.{caption}",
            1e3 * record.interval
        ),
        columns: 2,
        height: 400,
        panels: vec![
            profile,
            Panel::new(
                format!("(b) History at {}, {:.1} deg", text.mark, stations.degrees(worst)),
                "time (s)",
                "force (kN)",
            )
            .line(Line::new("", history).thin().color(0))
            .from_zero(),
        ],
    }
}

fn acceleration(record: &Record, axis: &Axis, text: Text, places: usize) -> Figure {
    let stations = &record.stations;
    let names = ["x, along the hole", "y, horizontal", "z, to the low side"];
    let mut profile = Panel::new(
        "(a) Effective acceleration",
        "inclination (deg)",
        "RMS acceleration (m/s²)",
    )
    .from_zero();
    for (k, name) in names.into_iter().enumerate() {
        let points = (0..stations.len())
            .map(|s| (stations.degrees(s), axis.acceleration_square[k][s].sqrt()))
            .collect();
        profile = profile.line(Line::new(name, points).color([2, 0, 1][k]));
    }
    // Parts are equal in inclination, as the paper's places are.
    let end = stations.degrees(stations.len() - 1);
    let mut panels = vec![profile];
    for place in 0..places {
        // The worst of each part of the tool.
        let part = end / places as f64 * (1.0 + 1e-9);
        let station = (0..stations.len())
            .filter(|&s| (stations.degrees(s) / part) as usize == place)
            .max_by(|&a, &b| axis.acceleration_square[1][a].total_cmp(&axis.acceleration_square[1][b]))
            .unwrap_or(0);
        let mark = if places > 1 {
            format!("{}{}", text.mark, place + 1)
        } else {
            text.mark.to_owned()
        };
        let letter = ["b", "c", "d"][place];
        let history = record
            .time
            .iter()
            .copied()
            .zip(axis.acceleration[1].at(station))
            .collect();
        panels.push(
            Panel::new(
                format!("({letter}) History at {mark}, {:.1} deg", stations.degrees(station)),
                "time (s)",
                "y acceleration (m/s²)",
            )
            .line(Line::new("", history).thin().color(0)),
        );
    }
    Figure {
        name: text.name,
        title: text.title.to_owned(),
        caption: format!(
            "Root mean square over all steps of the record per station; histories show the value of largest size in each sample's {:.0} ms, \
             where the RMS along y is largest{}.",
            1e3 * record.interval,
            if places > 1 { " in each third of the tool" } else { "" }
        ),
        columns: 2,
        height: 380,
        panels,
    }
}
