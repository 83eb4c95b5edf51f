//! The report's figures as data.

use std::f64::consts::TAU;

use crate::history::{History, Segment};
use crate::is_quantity;
use crate::locations::{Measure, Orbit};
use crate::reading::Summary;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm, rad_to_deg};
use flexdrill_outputs::figures::Group;
use flexdrill_plot::{Figure, Legend, Line, Panel};

/// Samples per turn from which they are joined by a line; with fewer, the line would show a path that is not known.
const LINE_FROM: f64 = 8.0;
/// Height of a row of panels, for a width of 1080.
pub(crate) const ROW: u32 = 300;

/// A time axis in seconds, minutes or hours, depending on the recording's length.
pub(crate) struct Axis {
    label: &'static str,
    unit: f64,
    end: f64,
}

impl Axis {
    fn of(summary: &Summary) -> Self {
        Self::over(summary.seconds())
    }

    /// An axis of `length` seconds.
    pub(crate) fn over(length: f64) -> Self {
        let (label, unit) = match length {
            ..300.0 => ("time (s)", 1.0),
            ..10_800.0 => ("time (min)", 60.0),
            _ => ("time (h)", 3600.0),
        };
        Self {
            label,
            unit,
            end: (length / unit).max(1e-3),
        }
    }

    pub(crate) fn panel(&self, title: &str, y: &str) -> Panel {
        Panel::new(title, self.label, y).over(0.0, self.end)
    }

    fn scaled(&self, points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
        points.into_iter().map(|(time, y)| (time / self.unit, y)).collect()
    }

    /// Adds the area between the first and the last of three histories of the same instants, and the one between.
    fn between(&self, mut panel: Panel, name: &str, color: usize, histories: &[History; 3], factor: f64) -> Panel {
        let [low, middle, high] = histories.each_ref().map(|history| history.segments(factor));
        for (index, ((low, middle), high)) in low.into_iter().zip(middle).zip(high).enumerate() {
            let name = if index == 0 { name } else { "" };
            let outline = high.mean.into_iter().chain(low.mean.into_iter().rev()).collect();
            panel = panel
                .line(Line::new("", self.scaled(outline)).area().color(color))
                .line(Line::new(name, self.scaled(middle.mean)).color(color));
        }
        panel
    }

    /// Adds a history as a band between its extremes, and its mean.
    pub(crate) fn draw(&self, mut panel: Panel, name: &str, color: usize, history: &History, factor: f64) -> Panel {
        for (index, Segment { mean, outline }) in history.segments(factor).into_iter().enumerate() {
            let name = if index == 0 { name } else { "" };
            panel = panel
                .line(Line::new("", self.scaled(outline)).area().color(color))
                .line(Line::new(name, self.scaled(mean)).color(color));
        }
        panel
    }
}

/// Figures of plausible tools whose bands are drawn: fields of `twin/transfer`.
const OF_TOOLS: [(&str, &str); 4] = [
    ("bit_torque", "Torque at the bit"),
    ("surface_torque", "Torque at the surface"),
    ("bit_weight", "Weight at the bit"),
    ("rate_of_penetration", "Rate of penetration"),
];

/// Bands of plausible tools with the twin's own values, and the share of them in which an alarm stands.
pub(crate) fn tools(summary: &Summary) -> Option<Figure> {
    let axis = Axis::of(summary);
    let tools = &summary.tools;
    let mut panels = Vec::new();
    for (field, title) in OF_TOOLS {
        let own = summary.transfer.figures.field(field);
        let (Some(band), Some(own)) = (tools.of_transfer(field), own) else {
            continue;
        };
        // Without bands the twin's value alone would be the figure of the section before.
        if band.quantiles[1].range().is_none() {
            continue;
        }
        let (unit, factor) = band.kind.unit();
        let panel = axis.between(
            axis.panel(title, unit),
            "median of the tools",
            0,
            &band.quantiles,
            factor,
        );
        panels.push(axis.draw(panel, "the twin", 6, &own.history, factor));
    }
    let any = axis.panel("Plausible tools in which an alarm stands", "%").from_zero();
    panels.push(axis.draw(any, "", 1, &tools.any_alarm, 100.0));
    figure("tools", 2, ROW, panels)
}

/// Build rate of the next metre with its range, and the plan of the hole.
pub(crate) fn hole(summary: &Summary) -> Option<Figure> {
    let axis = Axis::of(summary);
    let hole = &summary.hole;
    let build = axis.panel("Build rate of the next metre", "°/m");
    let build = axis.between(build, "as configured", 0, &hole.build, rad_to_deg(1.0));
    let build = axis.draw(build, "the plan", 6, &hole.planned, rad_to_deg(1.0));
    let distance = axis.panel("Distance to the plan ahead", "m").from_zero();
    let distance = axis.draw(distance, "", 1, &hole.distance, 1.0);
    figure("hole", 2, ROW, vec![build, distance])
}

fn has_lines(panel: &Panel) -> bool {
    panel.lines.iter().any(|line| !line.points.is_empty())
}

/// A figure of the panels that have lines; `None` without any.
pub(crate) fn figure(name: &'static str, columns: usize, height: u32, panels: Vec<Panel>) -> Option<Figure> {
    let panels: Vec<Panel> = panels.into_iter().filter(has_lines).collect();
    (!panels.is_empty()).then(|| Figure {
        name,
        title: String::new(),
        caption: String::new(),
        columns: columns.min(panels.len()),
        height,
        panels,
    })
}

pub(crate) fn rpm() -> f64 {
    rad_per_s_to_rpm(1.0)
}

pub(crate) fn kn() -> f64 {
    n_to_kn(1.0)
}

/// Speeds and weight over time.
pub(crate) fn inputs(summary: &Summary) -> Option<Figure> {
    let axis = Axis::of(summary);
    let drive = &summary.drive;
    let mut speed = axis.panel("Rotary speed", "r/min");
    speed = axis.draw(speed, "bit", 0, &drive.bit.rotary_speed, rpm());
    speed = axis.draw(speed, "accepted", 1, &drive.accepted.rotary_speed, rpm());
    speed = axis.draw(speed, "received", 6, &drive.received.rotary_speed, rpm());
    let mut weight = axis.panel("Weight on bit", "kN");
    weight = axis.draw(weight, "at the bit", 0, &drive.bit.weight_on_bit, kn());
    weight = axis.draw(weight, "accepted", 1, &drive.accepted.weight_on_bit, kn());
    weight = axis.draw(weight, "received", 6, &drive.received.weight_on_bit, kn());
    figure("inputs", 1, ROW, vec![speed, weight])
}

/// Torque at the uppermost joint and at the bit, stick-slip and lateral acceleration.
pub(crate) fn torque(summary: &Summary) -> Option<Figure> {
    let axis = Axis::of(summary);
    let drive = &summary.drive;
    let mut torque = axis.panel("Torque", "N m");
    torque = axis.draw(torque, "at the uppermost joint", 1, &drive.top_torque, 1.0);
    torque = axis.draw(torque, "at the bit", 0, &drive.bit_torque, 1.0);
    let mut index = axis.panel("Stick-slip index of the bit", "-").from_zero();
    index = axis.draw(index, "", 3, &drive.stick_slip, 1.0);
    let mut lateral = axis
        .panel("Lateral acceleration above the bit, largest", "m/s²")
        .from_zero();
    lateral = axis.draw(lateral, "", 2, &drive.lateral_acceleration, 1.0);
    figure("torque", 2, ROW, vec![torque.span(2), index, lateral])
}

/// Torque and weight from the surface to the bit, and what friction takes.
pub(crate) fn transfer(summary: &Summary) -> Option<Figure> {
    let axis = Axis::of(summary);
    let transfer = &summary.transfer;
    // Places from the surface to the bit have the colours of the other figures, the bit the first.
    let panel = |title: &str, group: Group, colors: &[usize]| {
        let (unit, factor) = transfer
            .group(group)
            .next()
            .map_or(("", 1.0), |one| one.figure.kind.unit());
        let drawn = transfer.group(group).zip(colors);
        drawn.fold(axis.panel(title, unit), |panel, (quantity, color)| {
            axis.draw(panel, quantity.shown.short, *color, &quantity.history, factor)
        })
    };
    figure(
        "transfer",
        2,
        ROW,
        vec![
            panel("Torque", Group::Torque, &[6, 1, 0]),
            panel("Weight", Group::Weight, &[6, 1, 0]),
            panel("Torque that friction takes", Group::Friction, &[0, 1, 2, 3]),
            panel("Axial drag", Group::Drag, &[0, 1, 2]),
        ],
    )
}

/// Forces and moments along the tool.
pub(crate) fn envelopes(summary: &Summary) -> Option<Figure> {
    let locations = &summary.locations;
    let (stations, joints) = (&locations.station_depth, &locations.joint_depth);
    let along = "measured depth from the kick-off (m)";
    let mut panels = Vec::new();
    // Peak and RMS in one panel each: their distance shows whether a force is steady or made of impacts.
    for (layer, title) in ["Normal force, pipe on guide", "Normal force, guide on wall"]
        .into_iter()
        .enumerate()
    {
        panels.push(
            Panel::new(title, along, "kN")
                .line(Line::new("largest", locations.peak[layer].curve(stations, kn(), |s| s.max)).color(1))
                .line(Line::new("RMS", locations.rms[layer].curve(stations, kn(), |s| s.rms())).color(0))
                .from_zero(),
        );
    }
    // Signed quantities as bands from least to largest, because their sign matters.
    for (title, unit, envelope, factor) in [
        ("Axial force, tension positive", "kN", &locations.axial_force, kn()),
        ("Torque through the joints", "N m", &locations.torque, 1.0),
    ] {
        panels.push(
            Panel::new(title, along, unit)
                .line(
                    Line::new("least to largest", envelope.outline(joints, factor))
                        .area()
                        .color(0),
                )
                .line(Line::new("mean", envelope.curve(joints, factor, |s| s.mean())).color(0)),
        );
    }
    panels.push(
        Panel::new("Shear force through the joints", along, "kN")
            .line(Line::new("largest", locations.shear_force.curve(joints, kn(), |s| s.max)).color(1))
            .line(Line::new("RMS", locations.shear_force.curve(joints, kn(), |s| s.rms())).color(0))
            .from_zero(),
    );
    // A joint without a limit has no point on its line.
    let limit = joints
        .iter()
        .copied()
        .zip(locations.limit.iter().map(|limit| rad_to_deg(*limit)))
        .filter(|(x, y)| is_quantity(*x) && is_quantity(*y))
        .collect();
    panels.push(
        Panel::new("Bend of the joints", along, "deg")
            .line(Line::new("largest", locations.bend.curve(joints, rad_to_deg(1.0), |s| s.max)).color(1))
            .line(Line::new("mean", locations.bend.curve(joints, rad_to_deg(1.0), |s| s.mean())).color(0))
            .line(Line::new("stop begins", limit).dashed().color(6))
            .from_zero(),
    );
    panels.push(
        Panel::new("Moment of the joints' stops", along, "N m")
            .line(Line::new("largest", locations.stop_moment.curve(joints, 1.0, |s| s.max)).color(1))
            .line(Line::new("RMS", locations.stop_moment.curve(joints, 1.0, |s| s.rms())).color(0))
            .from_zero(),
    );
    // Both contacts share a panel, so that they can be compared along the tool.
    panels.push(
        Panel::new("Time in contact", along, "%")
            .line(
                Line::new(
                    "pipe on guide",
                    locations.contact[0].curve(stations, 100.0, |s| s.mean()),
                )
                .color(0),
            )
            .line(
                Line::new(
                    "guide on wall",
                    locations.contact[1].curve(stations, 100.0, |s| s.mean()),
                )
                .color(1),
            )
            .from_zero(),
    );
    figure("envelopes", 2, ROW, panels)
}

/// An orbit to show.
pub(crate) struct OrbitOf<'a> {
    pub joint: usize,
    pub measure: Measure,
    pub orbit: &'a Orbit,
}

impl OrbitOf<'_> {
    /// Samples per turn of the tool; infinite if it does not turn.
    pub(crate) fn samples_per_turn(&self) -> f64 {
        let [first, last] = self.orbit.span;
        let interval = (last - first) / (self.orbit.points.len().max(2) - 1) as f64;
        TAU / (self.orbit.spin.abs() * interval)
    }
}

/// Orbits at the worst locations, each joint once per measure.
pub(crate) fn worst_orbits(summary: &Summary) -> Vec<OrbitOf<'_>> {
    let locations = &summary.locations;
    let mut found: Vec<OrbitOf<'_>> = Vec::new();
    for measure in Measure::ALL {
        let depths: Vec<f64> = match measure {
            Measure::PipeGuide => locations
                .worst_stations(0)
                .iter()
                .map(|s| locations.station_depth[*s])
                .collect(),
            Measure::GuideWall => locations
                .worst_stations(1)
                .iter()
                .map(|s| locations.station_depth[*s])
                .collect(),
            Measure::Whirl => locations
                .worst_whirl()
                .iter()
                .map(|station| station.measured_depth)
                .collect(),
        };
        // Two of each measure, so that every measure is shown.
        for depth in depths.into_iter().take(2) {
            if let Some((joint, orbit)) = locations.orbit(measure, depth)
                && !found
                    .iter()
                    .any(|known| known.joint == joint && known.orbit.span == orbit.span)
            {
                found.push(OrbitOf { joint, measure, orbit });
            }
        }
    }
    found
}

/// The orbits, with the lateral clearance of the pipe in the bore.
pub(crate) fn orbits(summary: &Summary) -> Option<Figure> {
    named_orbits(summary, "orbits")
}

/// The orbits, in a figure of this name.
pub(crate) fn named_orbits(summary: &Summary, name: &'static str) -> Option<Figure> {
    // The pipe's axis may move by both clearances: within the guide, and with it.
    let clearance = summary
        .config
        .as_ref()
        .map(|config| config.inner_clearance() + config.outer_clearance());
    let mm = 1e3;
    let panels: Vec<Panel> = worst_orbits(summary)
        .iter()
        .map(|of| {
            let points: Vec<(f64, f64)> = of
                .orbit
                .points
                .iter()
                .map(|[y, z]| (mm * y, mm * z))
                .filter(|(y, z)| is_quantity(*y) && is_quantity(*z))
                .collect();
            let path = Line::new("", points);
            // A line through few samples per turn would draw chords of an orbit that nothing has measured.
            let path = if of.samples_per_turn() < LINE_FROM {
                path.dots()
            } else {
                path.thin()
            };
            let depth = summary.locations.joint_depth.get(of.joint).copied().unwrap_or(f64::NAN);
            let why = match of.measure {
                Measure::PipeGuide => "force on the guide",
                Measure::GuideWall => "force on the wall",
                Measure::Whirl => "whirl",
            };
            let mut panel = Panel::new(
                format!("Joint {:02}, {depth:.2} m: {why}", of.joint + 1),
                "horizontal (mm)",
                "to the low side (mm)",
            )
            .line(path.color(0))
            // Equal scales and the low side below, as one looks down the hole.
            .equal()
            .down()
            .legend(Legend::Row);
            // The circle shows how much of the room is used.
            if let Some(clearance) = clearance {
                let circle = (0..=90).map(|k| {
                    let angle = TAU * f64::from(k) / 90.0;
                    (mm * clearance * angle.cos(), mm * clearance * angle.sin())
                });
                panel = panel.line(Line::new("", circle.collect()).dashed().color(6));
            }
            panel
        })
        .collect();
    figure(name, 3, 350, panels)
}

pub(crate) fn pace(summary: &Summary) -> Option<Figure> {
    let axis = Axis::of(summary);
    let health = &summary.health;
    let factor = axis.draw(
        axis.panel("Real-time factor, 1 keeps up", "-"),
        "",
        0,
        &health.real_time_factor,
        1.0,
    );
    let step = axis.draw(
        axis.panel("Computing time of a step, 99th percentile", "µs")
            .from_zero(),
        "",
        1,
        &health.step_time_p99,
        1e6,
    );
    figure("pace", 2, ROW, vec![factor, step])
}
