//! What of the largest pull and torque arrives along string and tool with the bit on the bottom, as the tool is configured and
//! in plausible tools; the table.

use flexdrill_core::units::n_to_kn;
use flexdrill_drilling::Band;
use flexdrill_trip::Reached;

use super::stuck::cell;

/// Two stations nearer than this (m) are the same: depths of one geometry differ by rounding alone.
const SAME_DEPTH: f64 = 1e-6;
/// Numbers of a station: depth (m), tension and overpull (N), torque (N m).
const NUMBERS: usize = 4;

/// A station of string and tool.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// Of the tool as configured.
    pub at: Reached,
    /// 90 % of the plausible tools there: tension and overpull (N), torque (N m). None of too few, and of a torque that is not
    /// known below the tool's top.
    pub bands: [Option<Band>; 3],
    /// Plausible tools without a result there.
    pub unknown: usize,
}

/// Stations as numbers, for the results of runs.
pub(super) fn numbers(stations: &[Reached]) -> impl Iterator<Item = f64> {
    stations
        .iter()
        .flat_map(|at| [at.depth, at.tension, at.overpull, at.torque])
}

/// Stations with these numbers.
pub(super) fn stations(numbers: &[f64]) -> Vec<Reached> {
    let station = |of: &[f64]| match *of {
        [depth, tension, overpull, torque] => Some(Reached {
            depth,
            tension,
            overpull,
            torque,
        }),
        _ => None,
    };
    numbers.chunks_exact(NUMBERS).filter_map(station).collect()
}

/// Tension, overpull (N) and torque (N m) of a plausible tool at a station of the tool as configured; none beyond its ends.
/// Stations count from the rig down. A tool of the same geometry has the station at the same number, also where a bend has two at
/// one depth. One of another geometry has its values on the straight line between its neighbours.
fn at(member: &[Reached], number: usize, depth: f64) -> Option<[f64; 3]> {
    let values = |at: &Reached| [at.tension, at.overpull, at.torque];
    let same = member.get(number);
    if let Some(same) = same.filter(|same| (same.depth - depth).abs() < SAME_DEPTH) {
        return Some(values(same));
    }
    let below = member.partition_point(|at| at.depth < depth);
    let (above, below) = (member.get(below.checked_sub(1)?)?, member.get(below)?);
    let share = (depth - above.depth) / (below.depth - above.depth);
    let (upper, lower) = (values(above), values(below));
    Some([0, 1, 2].map(|index| upper[index] + share * (lower[index] - upper[index])))
}

/// The stations of the tool as configured with the ranges of plausible tools. A tool without a result is an empty list.
pub(super) fn rows(nominal: &[Reached], members: &[Vec<Reached>]) -> Vec<Along> {
    let row = |(number, station): (usize, &Reached)| {
        let there = members.iter().filter_map(|member| at(member, number, station.depth));
        let known: Vec<[f64; 3]> = there.filter(|values| values[0].is_finite()).collect();
        let band = |index: usize| {
            let values = known.iter().map(|values| values[index]);
            Band::of(values.filter(|value| value.is_finite()).collect())
        };
        Along {
            at: *station,
            bands: [band(0), band(1), band(2)],
            unknown: members.len() - known.len(),
        }
    };
    nominal.iter().enumerate().map(row).collect()
}

/// The table along string and tool. `low` and `high` are the ends of 90 % of the plausible tools; what is unknown is an empty
/// cell.
pub fn csv(rows: &[Along]) -> String {
    let mut out = "measured_depth_m,pull_kn,overpull_kn,torque_nm".to_owned();
    for (name, unit) in [("pull", "kn"), ("overpull", "kn"), ("torque", "nm")] {
        for end in ["low", "median", "high"] {
            out.push_str(&format!(",{name}_{end}_{unit}"));
        }
    }
    out.push_str(",tools_unknown\n");
    let force = |value: f64| cell(Some(n_to_kn(value)), 4);
    let torque = |value: f64| cell(Some(value), 2);
    let ends = |band: &Option<Band>| band.map(|Band { low, median, high }| [low, median, high]);
    let blank = [const { String::new() }; 3];
    for Along { at, bands, unknown } in rows {
        let mut line = vec![
            cell(Some(at.depth), 4),
            force(at.tension),
            force(at.overpull),
            torque(at.torque),
        ];
        let [pulls, overpulls, turns] = bands;
        for forces in [pulls, overpulls] {
            line.extend(ends(forces).map_or_else(|| blank.clone(), |ends| ends.map(force)));
        }
        line.extend(ends(turns).map_or_else(|| blank.clone(), |ends| ends.map(torque)));
        line.push(unknown.to_string());
        out.push_str(&line.join(","));
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn station(depth: f64, tension: f64) -> Reached {
        Reached {
            depth,
            tension,
            overpull: tension - 1.0,
            torque: f64::NAN,
        }
    }

    /// Rig, both sides of a bend, and bit.
    fn along(factor: f64) -> Vec<Reached> {
        [(-10.0, 8.0), (0.0, 6.0), (0.0, 4.0), (5.0, 2.0)]
            .map(|(depth, tension)| station(depth, factor * tension))
            .to_vec()
    }

    #[test]
    fn both_sides_of_a_bend_have_their_own_range() {
        let members: Vec<Vec<Reached>> = (1..=19).map(|number| along(f64::from(number))).collect();
        let rows = rows(&along(10.0), &members);
        let medians: Vec<f64> = rows.iter().map(|row| row.bands[0].unwrap().median).collect();
        assert_eq!(medians, [80.0, 60.0, 40.0, 20.0]);
        let band = rows[2].bands[0].unwrap();
        assert_eq!((band.low, band.high), (4.0, 76.0));
        assert_eq!(rows[1].bands[1].unwrap().median, 59.0);
        assert!(rows.iter().all(|row| row.unknown == 0 && row.bands[2].is_none()));
    }

    /// A tool with a longer string, one without a result, and too few others for a range.
    #[test]
    fn a_tool_of_another_geometry_is_read_between_its_stations() {
        let longer = vec![station(-20.0, 10.0), station(0.0, 6.0), station(5.0, 2.0)];
        assert_eq!(at(&longer, 0, -10.0).unwrap()[..2], [8.0, 7.0]);
        assert_eq!(at(&longer, 3, 5.0).unwrap()[0], 2.0);
        assert!(at(&longer, 3, 6.0).is_none() && at(&[], 0, 0.0).is_none());
        let rows = rows(&along(1.0), &[longer, Vec::new()]);
        assert!(rows.iter().all(|row| row.unknown == 1 && row.bands[0].is_none()));
        let table = csv(&rows);
        assert!(table.ends_with("5.0000,0.0020,0.0010,,,,,,,,,,,1\n"), "{table}");
    }

    #[test]
    fn stations_are_their_numbers() {
        let torques = along(1.0).into_iter().map(|at| Reached { torque: 3.0, ..at });
        let torques: Vec<Reached> = torques.collect();
        assert_eq!(stations(&numbers(&torques).collect::<Vec<f64>>()), torques);
    }
}
