//! The results as a picture: the hole from the side and from above, with the range of the members and the plan.

use flexdrill_plot::{Figure, Legend, Line, Panel};

use super::{Answer, Band, Plan, Spread, Station, across};

/// Places in the palette: dark grey for the hole as it is, blue ahead, orange for the plan.
const HOLE: usize = 6;
const AHEAD: usize = 0;
const PLAN: usize = 1;

/// Section through the hole's plane, and plan view.
pub fn figure(answer: &Answer, plan: Option<&Plan>, azimuth: f64) -> Figure {
    let (east, north) = libm::sincos(azimuth);
    // Horizontal distance along the hole's plane, across it to the right, and down.
    let section = move |[x, y, z]: [f64; 3]| (x * north + y * east, z);
    let above = move |[x, y, _]: [f64; 3]| (x * north + y * east, y * north - x * east);
    let along = "along the plane of the build (m)";
    let mut side = Panel::new("From the side", along, "depth below the kick-off (m)")
        .equal()
        .down()
        .legend(Legend::Stacked);
    side = drawn(side, answer, plan, &section, 0, |spread| spread.high);
    // From above, the right side is below the line.
    let mut top = Panel::new("From above", along, "to the right (m)")
        .down()
        .legend(Legend::Stacked);
    top = drawn(top, answer, plan, &above, 1, |spread| spread.right);
    Figure {
        name: "ahead",
        title: "The hole ahead".to_owned(),
        caption: "The hole as it is, and where the tool drills, with 90 % of the plausible tools".to_owned(),
        columns: 2,
        height: 460,
        panels: vec![side, top],
    }
}

/// Band, hole, path and plan in the coordinates of a panel. `side` is the direction of the band in [`across`].
fn drawn(
    mut panel: Panel,
    answer: &Answer,
    plan: Option<&Plan>,
    at: &dyn Fn([f64; 3]) -> (f64, f64),
    side: usize,
    band: impl Fn(&Spread) -> Band,
) -> Panel {
    let off = |(station, spread): (&Station, &Spread), share: &dyn Fn(Band) -> f64| {
        let (unit, distance) = (across(station)[side], share(band(spread)));
        at(std::array::from_fn(|axis| {
            station.position[axis] + distance * unit[axis]
        }))
    };
    let stations = || answer.nominal.iter().zip(&answer.spread);
    let (range, way) = match &answer.learnt {
        Some(learnt) if learnt.corrects_curvature() => ("90 % by the surveys", "ahead, by the surveys"),
        Some(_) => ("90 % of the plausible tools", "ahead, from the surveyed direction"),
        None => ("90 % of the plausible tools", "ahead, as configured"),
    };
    let low: Vec<(f64, f64)> = stations().map(|pair| off(pair, &|band| band.low)).collect();
    let high = stations().rev().map(|pair| off(pair, &|band| band.high));
    if low.len() > 1 {
        let around = low.iter().copied().chain(high).collect();
        panel = panel.line(Line::new(range, around).area().color(AHEAD));
    }
    let hole = answer.drilling.hole.points().iter();
    let hole = hole.map(|point| at([point.x, point.y, point.z])).collect();
    panel = panel.line(Line::new("hole as it is", hole).color(HOLE));
    if let Some(learnt) = &answer.learnt {
        let places = learnt.used().map(|survey| at(on_hole(answer, survey.depth))).collect();
        panel = panel.line(Line::new("surveys", places).dots().color(HOLE));
    }
    let path = answer.nominal.iter().map(|station| at(station.position)).collect();
    panel = panel.line(Line::new(way, path).color(AHEAD));
    if let Some(plan) = plan {
        let planned = plan.points().map(at).collect();
        panel = panel.line(Line::new("plan", planned).dashed().color(PLAN));
    }
    panel
}

/// Position of the hole as configured at a measured depth (m).
fn on_hole(answer: &Answer, depth: f64) -> [f64; 3] {
    let points = answer.drilling.hole.points();
    let mut above = 0.0;
    for pair in points.windows(2) {
        let way = pair[1] - pair[0];
        let length = way.norm();
        if depth <= above + length {
            let at = pair[0] + way * ((depth - above) / length);
            return [at.x, at.y, at.z];
        }
        above += length;
    }
    points.last().map_or([0.0; 3], |at| [at.x, at.y, at.z])
}
