//! Figures 10 and 11: shapes, orbits and displacements in time.

use crate::motion::Motion;
use crate::record::{Axis, Record};
use flexdrill_core::tool::Body;
use flexdrill_plot::{Figure, Line, Panel};

/// The paper's exaggeration of displacements.
const EXAGGERATION: f64 = 50.0;

/// Shape of a pipe with its displacements exaggerated, and motion at the two stations of largest motion.
pub(super) fn shapes(record: &Record, motion: &Motion, body: Body) -> Figure {
    let (name, number, what, letter, axis) = match body {
        Body::Pipe => ("fig10_pipe_displacement", 10, "flexible pipe", "r", &record.pipe),
        Body::Guide => ("fig11_guide_displacement", 11, "guide pipe", "d", &record.guide),
    };
    let marks = [1, 2].map(|i| format!("D{letter}{i}"));
    let mut panels = vec![plane(record, motion, axis, body, &marks)];
    for (i, (&station, letters)) in motion.places.iter().zip([["b", "c"], ["d", "e"]]).enumerate() {
        let place = format!("{}, {:.1} deg", marks[i], record.stations.degrees(station));
        panels.push(orbit(
            record,
            axis,
            body,
            station,
            &format!("({}) Path, {place}", letters[0]),
        ));
        panels.push(in_time(
            record,
            axis,
            station,
            &format!("({}) Displacement, {place}", letters[1]),
        ));
        if i == 0 {
            panels.push(horizontal(record, motion, axis, body, &marks));
        }
    }
    let words = motion.places.map(|s| motion.whirl[s].words());
    Figure {
        name,
        title: format!("Figure {number}. Displacement of the {what}"),
        caption: format!(
            "Shape with displacements from the bore's axis exaggerated {EXAGGERATION} times, at the end of the record; paths and \
             displacements at the two places of largest RMS motion. {}: {}. {}: {}.",
            marks[0], words[0], marks[1], words[1]
        ),
        columns: 3,
        height: 400,
        panels,
    }
}

/// Displacement without the chord's offset, (y, z) in m.
fn displaced(record: &Record, axis: &Axis, body: Body, sample: usize, station: usize) -> [f64; 2] {
    let offset = match body {
        Body::Pipe => record.stations.offset[station],
        Body::Guide => [0.0; 2],
    };
    [
        axis.y.row(sample)[station] - offset[0],
        axis.z.row(sample)[station] - offset[1],
    ]
}

fn plane(record: &Record, motion: &Motion, axis: &Axis, body: Body, marks: &[String; 2]) -> Panel {
    let stations = &record.stations;
    let last = record.time.len().saturating_sub(1);
    let bore = stations.position.iter().map(|&[x, z]| (x, z)).collect();
    let at = |s: usize| {
        let w = EXAGGERATION * displaced(record, axis, body, last, s)[1];
        let ([x, z], [low_x, low_z]) = (stations.position[s], stations.low_side[s]);
        (x + w * low_x, z + w * low_z)
    };
    let shape = (0..stations.len()).map(at).collect();
    Panel::new("(a1) In the well's plane, 50 x", "horizontal (m)", "depth (m)")
        .line(Line::new("bore axis", bore).dashed().color(6))
        .line(Line::new(name(body), shape).color(0))
        .line(Line::new(marks[0].clone(), vec![at(motion.places[0])]).dots().color(1))
        .line(
            Line::new(marks[1].clone(), vec![at(motion.places[1])])
                .diamond()
                .color(2),
        )
        .equal()
        .down()
}

/// Of the pipe in legends.
fn name(body: Body) -> &'static str {
    match body {
        Body::Pipe => "pipe",
        Body::Guide => "guide",
    }
}

fn horizontal(record: &Record, motion: &Motion, axis: &Axis, body: Body, marks: &[String; 2]) -> Panel {
    let last = record.time.len().saturating_sub(1);
    let at = |s: usize| (record.stations.degrees(s), 1e3 * axis.y.row(last)[s]);
    let shape = (0..record.stations.len()).map(at).collect();
    Panel::new("(a2) Normal to it, same instant", "inclination (deg)", "y (mm)")
        .line(Line::new(name(body), shape).color(0))
        .line(Line::new(marks[0].clone(), vec![at(motion.places[0])]).dots().color(1))
        .line(
            Line::new(marks[1].clone(), vec![at(motion.places[1])])
                .diamond()
                .color(2),
        )
}

fn orbit(record: &Record, axis: &Axis, body: Body, station: usize, title: &str) -> Panel {
    let path = axis
        .y
        .at(station)
        .zip(axis.z.at(station))
        .map(|(y, z)| (1e3 * y, 1e3 * z))
        .collect();
    let clearance = match body {
        Body::Pipe => record.stations.inner_clearance[station],
        Body::Guide => record.stations.outer_clearance,
    };
    let circle = (0..=120)
        .map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 120.0).sin_cos();
            (1e3 * clearance * cos, 1e3 * clearance * sin)
        })
        .collect();
    let centred = match body {
        Body::Pipe => "clearance, guide centred",
        Body::Guide => "clearance",
    };
    Panel::new(title, "y (mm)", "z, to the low side (mm)")
        .line(Line::new(centred, circle).dashed().color(6))
        .line(Line::new("path", path).thin().color(0))
        .equal()
        .down()
}

fn in_time(record: &Record, axis: &Axis, station: usize, title: &str) -> Panel {
    let history = |series: &crate::Series| {
        record
            .time
            .iter()
            .copied()
            .zip(series.at(station).map(|x| 1e3 * x))
            .collect::<Vec<_>>()
    };
    Panel::new(title, "time (s)", "displacement (mm)")
        .line(Line::new("y", history(&axis.y)).thin().color(0))
        .line(Line::new("z", history(&axis.z)).thin().color(1))
}
