//! A planned hole: read from a table or made as an arc, and the distance to it.

use std::f64::consts::PI;

use flexdrill_config::{PlannedStation, Well, WellPlan};
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

use super::table::{self, COLUMNS, Kind, TableError};
use super::tool::Drilling;
use super::{Station, USUAL_LENGTH, across};

/// Tables of a plan.
const TABLE: Kind = Kind {
    what: "the plan",
    least: 2,
    give: "the stations of the plan around the bit",
};
/// Distance of two points of the plan (m).
const STEP: f64 = 0.02;

/// A row of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Measured depth from the kick-off (m).
    pub depth: f64,
    /// Inclination (rad).
    pub inclination: f64,
    /// Azimuth (rad).
    pub azimuth: f64,
}

impl From<&Row> for PlannedStation {
    fn from(row: &Row) -> Self {
        Self {
            measured_depth: row.depth,
            inclination_deg: rad_to_deg(row.inclination),
            azimuth_deg: rad_to_deg(row.azimuth),
        }
    }
}

impl From<&PlannedStation> for Row {
    fn from(station: &PlannedStation) -> Self {
        Self {
            depth: station.measured_depth,
            inclination: deg_to_rad(station.inclination_deg),
            azimuth: deg_to_rad(station.azimuth_deg),
        }
    }
}

/// Why a plan is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// It does not begin on the hole as configured.
    #[error(
        "{file}: measured_depth_m of the first row = {depth} m: must be 0 to {bit:.3} m, the bit: depths count from the \
         kick-off, where well.sections begins, and the first row is a point of that hole"
    )]
    Begin {
        /// The table.
        file: String,
        /// Of the first row (m).
        depth: f64,
        /// Of the bit (m).
        bit: f64,
    },
    /// It ends near the bit.
    #[error(
        "{file}: measured_depth_m of the last row = {depth} m: must be at least {least:.3} m, a metre below the bit; \
         continue the plan"
    )]
    End {
        /// The table.
        file: String,
        /// Of the last row (m).
        depth: f64,
        /// What is needed (m).
        least: f64,
    },
}

/// A planned hole in the world of the kick-off.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Points in distances of at most [`STEP`], with their measured depths (m).
    points: Vec<(f64, [f64; 3])>,
    /// Inclination at the bit and at the end that is compared (rad).
    inclinations: [f64; 2],
    /// Measured depths of both (m).
    between: [f64; 2],
}

/// Distance to a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// To the nearest point (m).
    pub whole: f64,
    /// Of the bit from the plan, towards the high side (m).
    pub high: f64,
    /// The same to the right (m).
    pub right: f64,
}

/// The rows of a table.
///
/// # Errors
/// [`TableError`] with file, line, column, value and bound.
pub fn read(file: &str, text: &str) -> Result<Vec<Row>, TableError> {
    table::read(file, text, TABLE, |cells, before: Option<&Row>| {
        // A depth that falls would turn the plan back on itself, and an equal one has no curvature.
        let (least, bound) = match before {
            Some(before) => (
                before.depth.next_up(),
                format!("above {} m, the row before", before.depth),
            ),
            None => (-1e5, "a depth in metres, counted from the kick-off".to_owned()),
        };
        let [depth, _, azimuth] = COLUMNS;
        Ok(Row {
            depth: cells.number(depth, least..=1e5, bound)?,
            inclination: deg_to_rad(cells.inclination_deg()?),
            azimuth: deg_to_rad(cells.number(azimuth, -360.0..=360.0, "-360 to 360 deg")?),
        })
    })
}

/// Checks that rows begin on the hole above a bit at a depth (m), and end a metre below it.
///
/// # Errors
/// [`PlanError::Begin`], [`PlanError::End`].
pub fn covers(file: &str, rows: &[Row], bit: f64) -> Result<(), PlanError> {
    let (first, last) = (rows.first(), rows.last());
    let depth = first.map_or(f64::NAN, |row| row.depth);
    if !(0.0..=bit).contains(&depth) {
        return Err(PlanError::Begin {
            file: file.to_owned(),
            depth,
            bit,
        });
    }
    let depth = last.map_or(f64::NAN, |row| row.depth);
    if depth < bit + 1.0 {
        return Err(PlanError::End {
            file: file.to_owned(),
            depth,
            least: bit + 1.0,
        });
    }
    Ok(())
}

/// Unit vector of a direction.
pub(crate) fn tangent(inclination: f64, azimuth: f64) -> [f64; 3] {
    let ((sine, cosine), (east, north)) = (libm::sincos(inclination), libm::sincos(azimuth));
    [sine * north, sine * east, cosine]
}

/// The direction at a share of the way between two, on the great circle (minimum curvature).
fn between(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    let cosine: f64 = (0..3).map(|axis| from[axis] * to[axis]).sum();
    let angle = libm::acos(cosine.clamp(-1.0, 1.0));
    if angle < 1e-9 || PI - angle < 1e-6 {
        return to;
    }
    let [a, b] = [libm::sin((1.0 - share) * angle), libm::sin(share * angle)].map(|part| part / libm::sin(angle));
    std::array::from_fn(|axis| a * from[axis] + b * to[axis])
}

fn inclination(direction: [f64; 3]) -> f64 {
    libm::atan2(libm::hypot(direction[0], direction[1]), direction[2])
}

/// The direction of rows at a depth (m).
fn direction(rows: &[Row], depth: f64) -> [f64; 3] {
    let of = |row: &Row| tangent(row.inclination, row.azimuth);
    let after = rows.partition_point(|row| row.depth < depth).clamp(1, rows.len() - 1);
    let (above, below) = (&rows[after - 1], &rows[after]);
    let share = ((depth - above.depth) / (below.depth - above.depth)).clamp(0.0, 1.0);
    between(of(above), of(below), share)
}

/// Azimuth of rows at a depth (rad): that of the plane in which the hole as configured lies.
pub fn azimuth(rows: &[Row], depth: f64) -> f64 {
    let [x, y, _] = direction(rows, depth);
    libm::atan2(y, x)
}

/// Inclination and azimuth of rows at a depth (rad).
pub fn heading(rows: &[Row], depth: f64) -> [f64; 2] {
    [inclination(direction(rows, depth)), azimuth(rows, depth)]
}

/// Rows turned about the vertical, so that the plan at a depth (m) lies in the plane of a hole without an azimuth.
pub fn in_plane_at(rows: &[Row], depth: f64) -> Vec<Row> {
    let plane = azimuth(rows, depth);
    let turned = |row: &Row| Row {
        azimuth: row.azimuth - plane,
        ..*row
    };
    rows.iter().map(turned).collect()
}

/// Position of the hole as configured at a depth (m).
fn on_hole(drilling: &Drilling, depth: f64) -> [f64; 3] {
    let mut left = depth;
    let points = drilling.hole.points();
    for pair in points.windows(2) {
        let way = pair[1] - pair[0];
        let length = way.norm();
        if left <= length {
            let at = pair[0] + way * (left / length);
            return [at.x, at.y, at.z];
        }
        left -= length;
    }
    points.last().map_or([0.0; 3], |at| [at.x, at.y, at.z])
}

/// The points of rows from one depth to another (m), laid from a position there in steps of at most [`STEP`], each with its
/// depth.
fn lay(rows: &[Row], [begin, end]: [f64; 2], mut at: [f64; 3]) -> Vec<(f64, [f64; 3])> {
    let count = ((end - begin) / STEP).ceil().max(1.0);
    let step = (end - begin) / count;
    let mut points = vec![(begin, at)];
    for index in 0..count as usize {
        let middle = direction(rows, begin + (index as f64 + 0.5) * step);
        at = std::array::from_fn(|axis| at[axis] + step * middle[axis]);
        points.push((begin + (index + 1) as f64 * step, at));
    }
    points
}

/// The plan of a well whose kick-off moves down by a length (m), in the frame of the new kick-off, which is at `top` (m) in that of
/// the old one. What lies above is left out; the rest remains where it is, however far the hole has left it. None where the plan
/// names a file, or ends above.
pub fn moved_down(plan: &WellPlan, well: &Well, by: f64, top: [f64; 3]) -> Option<WellPlan> {
    let rows: Vec<Row> = plan.stations.iter().map(Row::from).collect();
    let (first, last) = (rows.first()?, rows.last()?);
    if last.depth <= by {
        return None;
    }
    let mut offset = plan.offset;
    let mut kept: Vec<Row> = rows.iter().copied().filter(|row| row.depth > by).collect();
    if first.depth < by {
        // The plan at the new kick-off, in the plane of the hole, and how far that is from the hole there.
        let laid = in_plane_at(&rows, well.length());
        let begin = well.course_to(first.depth).position;
        let begin = std::array::from_fn(|axis| begin[axis] + offset[axis]);
        let points = lay(&laid, [first.depth, by], begin);
        let at = points.last().map_or(begin, |(_, at)| *at);
        offset = std::array::from_fn(|axis| at[axis] - top[axis]);
        let [inclination, azimuth] = heading(&rows, by);
        let at = Row {
            depth: by,
            inclination,
            azimuth,
        };
        kept.insert(0, at);
    } else if first.depth == by {
        kept.insert(0, *first);
    }
    let station = |row: &Row| {
        PlannedStation::from(&Row {
            depth: row.depth - by,
            ..*row
        })
    };
    Some(WellPlan {
        stations: kept.iter().map(station).collect(),
        offset,
        ..plan.clone()
    })
}

impl Plan {
    /// Rows that [`covers`] accepts, laid from the hole as configured, `offset` (m) from its point at the first row. What is
    /// compared ends `ahead` (m) below the bit at the latest.
    pub fn laid(rows: &[Row], offset: [f64; 3], drilling: &Drilling, bit: f64, ahead: f64) -> Self {
        let begin = rows.first().map_or(0.0, |row| row.depth);
        let last = rows.last().map_or(0.0, |row| row.depth);
        // A metre more than what is compared, so that the nearest point is not an end.
        let end = last.min(bit + ahead + 1.0);
        let compared = last.min(bit + ahead);
        let on_hole = on_hole(drilling, begin);
        let at = std::array::from_fn(|axis| on_hole[axis] + offset[axis]);
        Self {
            points: lay(rows, [begin, end], at),
            inclinations: [bit, compared].map(|depth| inclination(direction(rows, depth))),
            between: [bit, compared],
        }
    }

    /// The mean build curvature (1/m) that rows need over the usual length below a bit at a depth (m), and that length (m); none
    /// where they end less than a metre below it.
    pub fn needs(rows: &[Row], bit: f64) -> Option<(f64, f64)> {
        let end = rows.last()?.depth.min(bit + USUAL_LENGTH);
        (end >= bit + 1.0).then(|| {
            let [first, last] = [bit, end].map(|depth| inclination(direction(rows, depth)));
            ((last - first) / (end - bit), end - bit)
        })
    }

    /// An arc of a radius (m) that continues the hole as configured in its plane, as rows.
    pub fn arc(radius: f64, drilling: &Drilling, bit: f64, ahead: f64) -> Self {
        let end = drilling.hole.end();
        let (tangent, high) = (end.tangent, -end.low);
        let points = drilling.hole.points();
        let last = points.last().copied().unwrap_or_else(|| end.tangent * 0.0);
        let count = ((ahead + 1.0) / STEP).ceil();
        let at = |index: f64| {
            let depth = index / count * (ahead + 1.0);
            let (sine, cosine) = libm::sincos(depth / radius);
            let at = last + tangent * (radius * sine) + high * (radius * (1.0 - cosine));
            (bit + depth, [at.x, at.y, at.z])
        };
        let along = |depth: f64| {
            let (sine, cosine) = libm::sincos(depth / radius);
            let way = tangent * cosine + high * sine;
            inclination([way.x, way.y, way.z])
        };
        let first = along(0.0);
        Self {
            points: (0..=count as usize).map(|index| at(index as f64)).collect(),
            // An arc that passes the level builds on: its inclination is counted on beyond 180 deg.
            inclinations: [first, first + ahead / radius],
            between: [bit, bit + ahead],
        }
    }

    /// How far ahead of the bit it is compared (m).
    pub fn ahead(&self) -> f64 {
        self.between[1] - self.between[0]
    }

    /// Its mean build curvature over what is compared (1/m).
    pub fn curvature(&self) -> f64 {
        (self.inclinations[1] - self.inclinations[0]) / self.ahead()
    }

    /// Its points.
    pub fn points(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.points.iter().map(|(_, at)| *at)
    }

    /// Distance of a bit to it.
    pub fn distance(&self, bit: &Station) -> Distance {
        let mut nearest = (f64::INFINITY, [0.0; 3]);
        for pair in self.points.windows(2) {
            let ((_, from), (_, to)) = (pair[0], pair[1]);
            let way: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
            let square: f64 = way.iter().map(|part| part * part).sum();
            let along: f64 = (0..3).map(|axis| (bit.position[axis] - from[axis]) * way[axis]).sum();
            let share = (along / square).clamp(0.0, 1.0);
            let off: [f64; 3] = std::array::from_fn(|axis| bit.position[axis] - from[axis] - share * way[axis]);
            let distance = libm::sqrt(off.iter().map(|part| part * part).sum());
            if distance < nearest.0 {
                nearest = (distance, off);
            }
        }
        let [high, right] = across(bit).map(|unit| (0..3).map(|axis| nearest.1[axis] * unit[axis]).sum::<f64>());
        Distance {
            whole: nearest.0,
            high,
            right,
        }
    }

    /// Whether a track stays within a radius (m) of it at the stations from the second to `last`.
    pub fn keeps(&self, track: &[Station], last: usize, radius: f64) -> bool {
        let mut stations = track.iter().take(last + 1).skip(1);
        stations.all(|bit| self.distance(bit).whole <= radius)
    }
}

#[cfg(test)]
mod tests;
