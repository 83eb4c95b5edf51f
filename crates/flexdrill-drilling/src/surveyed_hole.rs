//! Hole as drilled from a table of its directions (CSV): measured depth, inclination, azimuth. Between two stations it is an arc
//! (minimum curvature).

use flexdrill_config::{Config, ConfigError, Drilled, Interval, Section};
use flexdrill_core::tool::Course;
use flexdrill_core::units::{deg_to_rad, rad_to_deg};

use super::plan::Row;
use super::table::{self, COLUMNS, Kind, TableError};
use super::{STEEP, plan};

/// Tables of a hole.
const TABLE: Kind = Kind {
    what: "the hole",
    least: 2,
    give: "the stations of the hole from its kick-off to the bit",
};
/// Shortest interval (m): 0.2 deg of each of two inclinations over it are a curvature of 0.05 1/m, a sixth of that of this tool.
const SHORTEST: f64 = 0.1;
/// Longest interval in which the hole turns (m). A curvature that changes by a tenth over it leaves 35 mm off the arc, four times
/// what the guide has room for.
const LONGEST: f64 = 3.0;
/// Turn of an interval (rad) up to which it counts as straight, and may be longer.
const STRAIGHT: f64 = 1.0 * std::f64::consts::PI / 180.0;
/// How far the table's first direction may be off that of the configured hole there (rad).
const BREAK: f64 = 2.0 * std::f64::consts::PI / 180.0;
/// Longest piece of hole per point (m): an interval is an arc, whose points are alike.
const POINT: f64 = 0.25;

/// Why a table is no hole of a tool.
#[derive(Debug, thiserror::Error)]
pub enum HoleError {
    /// Two stations are too near to each other, or too far apart.
    #[error("{file}: {length:.3} m from {above} to {below} m: must be {bound}; {reason}")]
    Spacing {
        /// The table.
        file: String,
        /// Measured depths of both (m).
        above: f64,
        /// Of the lower one (m).
        below: f64,
        /// Their distance (m).
        length: f64,
        /// What is allowed.
        bound: String,
        /// Why.
        reason: &'static str,
    },
    /// The tool does not pass.
    #[error(
        "{file}: a curvature of {curvature:.3} 1/m from {above} to {below} m: must be at most {bound:.3} 1/m, at which each joint \
         of the pipe bends to its limit (tool.joint.limit_deg = {limit_deg}); correct the stations"
    )]
    Bend {
        /// The table.
        file: String,
        /// Measured depths of both (m).
        above: f64,
        /// Of the lower one (m).
        below: f64,
        /// Their curvature (1/m).
        curvature: f64,
        /// What is allowed (1/m).
        bound: f64,
        /// `tool.joint.limit_deg`.
        limit_deg: f64,
    },
    /// The first station is no point of the configured hole.
    #[error(
        "{file}: the first row, at {depth} m, has a direction {off_deg:.1} deg off that of well.sections there: must be within \
         {:.0} deg; correct well.sections, or begin the table higher up",
        rad_to_deg(BREAK)
    )]
    Break {
        /// The table.
        file: String,
        /// Of the first row (m).
        depth: f64,
        /// Between both directions (deg).
        off_deg: f64,
    },
    /// The bit is where no hole is.
    #[error("{file}: a bit at {bit:.3} m: must be {least:.3} to {most:.3} m; {reason}")]
    Bit {
        /// The table.
        file: String,
        /// Of the bit (m).
        bit: f64,
        /// What is allowed (m).
        least: f64,
        /// What is allowed (m).
        most: f64,
        /// Why.
        reason: String,
    },
    /// The configuration refuses it.
    #[error("{file}: {error}")]
    Config {
        /// The table.
        file: String,
        /// Why.
        error: ConfigError,
    },
}

/// The stations of a table, from above, in the plane of the first that is steep. With `in_plane` azimuths may be empty, and are
/// left out.
///
/// # Errors
/// [`TableError`] with file, line, column, value and bound.
pub fn read(file: &str, text: &str, in_plane: bool) -> Result<Vec<Row>, TableError> {
    let mut rows = table::read(file, text, TABLE, |cells, before: Option<&Row>| {
        let (least, bound) = match before {
            Some(before) => (
                before.depth.next_up(),
                format!("above {} m, the row before", before.depth),
            ),
            None => (0.0, "0 m, the kick-off, or deeper".to_owned()),
        };
        let [depth, _, azimuth] = COLUMNS;
        Ok(Row {
            depth: cells.number(depth, least..=1e5, bound)?,
            inclination: deg_to_rad(cells.inclination_deg()?),
            azimuth: if in_plane {
                0.0
            } else {
                deg_to_rad(cells.number(azimuth, -360.0..=360.0, "-360 to 360 deg; --in-plane needs none")?)
            },
        })
    })?;
    // A hole that begins vertical has the plane into which it builds.
    let plane = rows.iter().find(|row| libm::sin(row.inclination) >= STEEP);
    let plane = plane.map_or(0.0, |row| row.azimuth);
    for row in &mut rows {
        row.azimuth = if libm::sin(row.inclination) < 1e-9 {
            0.0
        } else {
            row.azimuth - plane
        };
    }
    Ok(rows)
}

/// A tool in the hole of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Laid {
    /// The configuration.
    pub config: Config,
    /// How far its kick-off lies down the hole from that of the configuration before (m).
    pub moved: f64,
    /// Where, from that (m): along the plane, to the right, down.
    pub top: [f64; 3],
}

/// The tool of a configuration with its bit at a measured depth (m) of the hole of a table, from the kick-off of the
/// configuration. Above the first row the hole is that of the configuration; below the last one it continues the last arc.
///
/// # Errors
/// Why the table is no hole of the tool.
pub fn laid(file: &str, rows: &[Row], config: &Config, bit: Option<f64>) -> Result<Laid, HoleError> {
    let named = || file.to_owned();
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return Ok(Laid {
            config: config.clone(),
            moved: 0.0,
            top: [0.0; 3],
        });
    };
    let length = config.well.length();
    let bit = bit.unwrap_or(last.depth);
    // The tool fills its hole from the kick-off or from below it.
    if !(length - 1e-6..=last.depth + LONGEST).contains(&bit) || bit <= first.depth {
        return Err(HoleError::Bit {
            file: named(),
            bit,
            least: length.max(first.depth),
            most: last.depth + LONGEST,
            reason: format!(
                "the tool is {length:.3} m long, and the hole is known to {} m: give more stations, or the bit's depth as --bit",
                last.depth
            ),
        });
    }
    let top = (bit - length).max(0.0);
    // Hole of the configuration that the tool lies in above the table.
    let keeps = first.depth > top;
    let begin = config.well.course_to(first.depth);
    let mut course = Course {
        position: begin.position,
        ..Course::begin(first.inclination, first.azimuth)
    };
    if keeps {
        let is: [f64; 3] = begin.frame.column(0).into_owned().into();
        let wanted = plan::tangent(first.inclination, first.azimuth);
        let off = rad_to_deg(angle(is, wanted));
        if off > rad_to_deg(BREAK) {
            return Err(HoleError::Break {
                file: named(),
                depth: first.depth,
                off_deg: off,
            });
        }
        course = begin;
    }
    // Each interval begins where the one before has ended, so that a direction that is off at the first row is not carried on.
    let mut below = Vec::new();
    let mut at_top = config.well.course_to(top).position;
    let mut turned = keeps && course.inclination() - deg_to_rad(config.well.start_inclination_deg) > STRAIGHT;
    for pair in rows.windows(2) {
        let (above, to) = (&pair[0], &pair[1]);
        let piece = to.depth - above.depth;
        let curvatures = arc(&course, plan::tangent(to.inclination, to.azimuth), piece);
        check(file, [above.depth, to.depth], curvatures, config)?;
        // The last arc continues to the bit.
        let ends = if std::ptr::eq(to, last) { bit } else { to.depth.min(bit) };
        if ends <= above.depth {
            break;
        }
        let turns = libm::hypot(curvatures[0], curvatures[1]) * piece > STRAIGHT;
        turned |= turns;
        let interval = match (turned, turns) {
            (false, _) => Interval::BeforeArc,
            (true, true) => Interval::Arc,
            (true, false) => Interval::AfterArc,
        };
        below.push(points(ends - above.depth, curvatures, interval));
        // A plan is laid from the new kick-off, wherever on the table that is.
        if (above.depth..to.depth).contains(&top) {
            let mut cut = course;
            cut.advance(top - above.depth, curvatures);
            at_top = cut.position;
        }
        course.advance(piece, curvatures);
    }
    // Without hole of the configuration the first row alone says how the hole begins.
    let start = if keeps {
        None
    } else {
        Some(rad_to_deg(first.inclination))
    };
    let config = config
        .with_hole_below(start, first.depth, below, bit)
        .map_err(|error| HoleError::Config { file: named(), error })?;
    Ok(Laid {
        config,
        moved: top,
        top: at_top.into(),
    })
}

/// Angle between two unit vectors (rad).
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let half: f64 = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum();
    2.0 * libm::asin((0.5 * libm::sqrt(half)).min(1.0))
}

/// Curvatures (build, right) (1/m) of the arc of a length (m) that turns the end of a hole to a direction.
fn arc(course: &Course, to: [f64; 3], length: f64) -> [f64; 2] {
    let along = |axis: usize| -> f64 { (0..3).map(|of| course.frame[(of, axis)] * to[of]).sum() };
    let [x, y, z] = [0, 1, 2].map(along);
    let across = libm::hypot(y, z);
    if across == 0.0 {
        return [0.0; 2];
    }
    // The arc lies in the plane of both directions.
    let curvature = libm::atan2(across, x) / length;
    [-curvature * z / across, curvature * y / across]
}

/// # Errors
/// When the tool does not pass two stations at these depths (m), or they say too little of the hole between them.
fn check(file: &str, [above, below]: [f64; 2], curvatures: [f64; 2], config: &Config) -> Result<(), HoleError> {
    let length = below - above;
    let curvature = libm::hypot(curvatures[0], curvatures[1]);
    let spacing = |bound: String, reason| {
        Err(HoleError::Spacing {
            file: file.to_owned(),
            above,
            below,
            length,
            bound,
            reason,
        })
    };
    if length < SHORTEST {
        return spacing(
            format!("at least {SHORTEST} m"),
            "the error of a survey would be a bend of the hole: leave stations out",
        );
    }
    if length > LONGEST && curvature * length > STRAIGHT {
        return spacing(
            format!("at most {LONGEST} m where the hole turns"),
            "one arc is not the hole of a tool that turns by 18 deg per metre: give the stations between",
        );
    }
    let limit_deg = config.tool.joint.limit_deg;
    let link = config.well.length() / config.tool.links.max(1) as f64;
    let bound = deg_to_rad(limit_deg) / link;
    if curvature > bound {
        return Err(HoleError::Bend {
            file: file.to_owned(),
            above,
            below,
            curvature,
            bound,
            limit_deg,
        });
    }
    Ok(())
}

/// An arc as points.
fn points(length: f64, curvatures: [f64; 2], interval: Interval) -> Section {
    let count = (length / POINT - 1e-9).ceil().max(1.0);
    Section::Drilled(Drilled {
        spacing: length / count,
        points: vec![curvatures; count as usize],
        interval,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's arc: 5.026548 m.
    fn config() -> Config {
        Config::from_text("default.yaml", include_str!("../../../config/default.yaml")).unwrap()
    }

    fn table(rows: &[(f64, f64, f64)]) -> Vec<Row> {
        let rows = rows
            .iter()
            .map(|(depth, inclination, azimuth)| format!("{depth},{inclination},{azimuth}\n"));
        let text = format!("{}\n{}", COLUMNS.join(","), rows.collect::<String>());
        read("hole.csv", &text, false).unwrap()
    }

    /// Stations of an arc are that arc: direction and position of the bit in closed form.
    #[test]
    fn stations_of_a_circle_are_the_circle() {
        let config = config();
        let length = config.well.length();
        let turned = |depth: f64| rad_to_deg(depth / 3.0);
        let depths = [0.0, 1.3, 2.5, 4.0, length];
        let rows: Vec<_> = depths.iter().map(|depth| (*depth, turned(*depth), 310.0)).collect();
        let laid = laid("hole.csv", &table(&rows), &config, None).unwrap().config;
        let course = laid.well.course();
        assert!((laid.well.length() - length).abs() < 1e-9);
        assert!((course.inclination() - length / 3.0).abs() < 1e-9);
        let [x, z] = [3.0 * (1.0 - (length / 3.0).cos()), 3.0 * (length / 3.0).sin()];
        assert!((course.position.x - x).abs() < 1e-9 && (course.position.z - z).abs() < 1e-9);
        assert_eq!(laid.well.kick_off_depth, config.well.kick_off_depth);
        assert_eq!(Config::from_text("written", &laid.to_yaml().unwrap()).unwrap(), laid);
    }

    /// From 15 deg at N 20 E to 25 deg at N 45 E in 30 m, against the closed form of the method, its ratio factor.
    #[test]
    fn an_interval_is_one_of_minimum_curvature() {
        let course = Course::begin(deg_to_rad(15.0), deg_to_rad(20.0));
        let to = plan::tangent(deg_to_rad(25.0), deg_to_rad(45.0));
        let curvatures = arc(&course, to, 30.0);
        let mut end = course;
        end.advance(30.0, curvatures);
        let from = plan::tangent(deg_to_rad(15.0), deg_to_rad(20.0));
        let dog_leg = angle(from, to);
        let ratio = 2.0 / dog_leg * (dog_leg / 2.0).tan();
        for axis in 0..3 {
            let expected = 15.0 * ratio * (from[axis] + to[axis]);
            assert!(
                (end.position[axis] - expected).abs() < 1e-9,
                "{axis}: {} {expected}",
                end.position[axis]
            );
            assert!((end.frame[(axis, 0)] - to[axis]).abs() < 1e-12);
        }
    }

    /// Below the kick-off of the configuration, with a bit beyond the last station.
    #[test]
    fn a_table_continues_the_hole_and_the_last_arc_reaches_the_bit() {
        let config = config();
        let length = config.well.length();
        let curvature = 1.0 / 3.2;
        let at = |depth: f64| (depth, rad_to_deg(depth * curvature), 0.0);
        // The hole of the configuration down to 4 m, and on as the same arc: the bit 0.2 m below the last station.
        let rows = table(&[at(4.0), at(4.5), at(5.0)]);
        let bit = length + 0.1;
        let Laid {
            config: laid,
            moved,
            top,
        } = laid("hole.csv", &rows, &config, Some(bit)).unwrap();
        // The new kick-off lies 0.1 m down the old arc.
        assert!((moved - 0.1).abs() < 1e-9);
        assert!(
            (top[0] - 3.2 * (1.0 - (0.1 * curvature).cos())).abs() < 1e-9
                && (top[2] - 3.2 * (0.1 * curvature).sin()).abs() < 1e-9
        );
        assert!((laid.well.length() - length).abs() < 1e-9);
        assert!((laid.well.kick_off_depth - config.well.kick_off_depth - 0.1).abs() < 1e-9);
        assert!((deg_to_rad(laid.well.end_inclination_deg()) - bit * curvature).abs() < 1e-9);
        assert!((deg_to_rad(laid.well.start_inclination_deg) - 0.1 * curvature).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_hole_of_the_tool_is_refused_with_its_bound() {
        let config = config();
        let length = config.well.length();
        let at = |depth: f64| (depth, rad_to_deg(depth / 3.2), 0.0);
        let end = at(length);
        for (rows, bit, said) in [
            (vec![at(0.0), at(0.05), end], None, "must be at least 0.1 m"),
            (vec![at(0.0), end], None, "must be at most 3 m where the hole turns"),
            (
                vec![at(0.0), at(2.0), (2.5, rad_to_deg(2.0 / 3.2) + 40.0, 0.0), end],
                None,
                "at which each joint of the pipe bends to its limit",
            ),
            (vec![at(0.0), at(2.0), at(4.0)], None, "a bit at 4.000 m"),
            (
                vec![at(0.0), at(2.0), at(4.0), end],
                Some(length + 4.0),
                "the hole is known to",
            ),
            (
                vec![(3.0, 70.0, 0.0), at(4.0), end],
                None,
                "deg off that of well.sections there",
            ),
            (
                vec![at(0.0), at(2.0), (4.0, at(4.0).1, 5.0), (length, end.1, 8.0)],
                None,
                "one vertical plane",
            ),
        ] {
            let refused = laid("hole.csv", &table(&rows), &config, bit).unwrap_err().to_string();
            assert!(
                refused.contains(said) && refused.starts_with("hole.csv: "),
                "{said}: {refused}"
            );
        }
        // Without the azimuths it is a hole.
        let text = "measured_depth_m,inclination_deg,azimuth_deg\n0,0,\n2.5,44.762,7\n5.0265482,90,\n";
        let rows = read("hole.csv", text, true).unwrap();
        assert!(laid("hole.csv", &rows, &config, None).is_ok());
        let refused = read("hole.csv", text, false).unwrap_err().to_string();
        assert!(refused.contains("hole.csv:2: azimuth_deg = "), "{refused}");
    }
}
