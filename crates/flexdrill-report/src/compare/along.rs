//! Quantities along the tool in both runs.

use super::Pair;
use crate::envelope::{Envelope, Statistics};
use crate::locations::Locations;
use flexdrill_core::units::{n_to_kn, rad_to_deg};

/// Points of a curve along the tool: measured depth (m) and value (SI).
pub(crate) type Curve = Vec<(f64, f64)>;

/// The comparison of one quantity along the tool.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Along {
    pub name: &'static str,
    /// Unit in which it is shown, and the factor from SI.
    pub unit: (&'static str, f64),
    /// Whether it is a mean or RMS over time, which a tolerance applies to. Extremes of a chaotic motion differ between
    /// any two runs.
    pub judged: bool,
    pub curves: Pair<Curve>,
    /// Difference over depth, where both runs are known.
    pub worst: Option<Worst>,
}

/// How far two curves are apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Worst {
    /// RMS of the difference over the depths of A, relative to the larger RMS of the two curves (0 to 2).
    pub relative: f64,
    /// Measured depth of the largest difference (m).
    pub measured_depth: f64,
    /// The values there (SI).
    pub values: [f64; 2],
}

impl Along {
    /// B less A at the depths of A where both are known.
    pub(crate) fn difference(&self) -> Curve {
        let Pair { a, b } = &self.curves;
        let difference = |(depth, value): &(f64, f64)| Some((*depth, at(b, *depth)? - value));
        a.iter().filter_map(difference).collect()
    }

    /// Whether the runs agree.
    pub(crate) fn agrees(&self, tolerance: f64) -> bool {
        if self.curves.a.is_empty() && self.curves.b.is_empty() {
            return true;
        }
        if tolerance == 0.0 {
            return self.curves.a == self.curves.b;
        }
        !self.judged || self.worst.is_some_and(|worst| worst.relative <= tolerance)
    }
}

/// The value of a curve at a depth, by linear interpolation; `None` outside it.
fn at(curve: &Curve, depth: f64) -> Option<f64> {
    let next = curve.partition_point(|(x, _)| *x < depth);
    let (after, value) = *curve.get(next)?;
    if after == depth {
        return Some(value);
    }
    let (before, lower) = *curve.get(next.checked_sub(1)?)?;
    Some(lower + (value - lower) * (depth - before) / (after - before))
}

fn worst(a: &Curve, b: &Curve) -> Option<Worst> {
    let common: Vec<(f64, [f64; 2])> = a
        .iter()
        .filter_map(|(depth, value)| Some((*depth, [*value, at(b, *depth)?])))
        .collect();
    let largest = common
        .iter()
        .max_by(|(_, [a, b]), (_, [c, d])| (a - b).abs().total_cmp(&(c - d).abs()))?;
    let rms = |of: &dyn Fn(&[f64; 2]) -> f64| {
        (common.iter().map(|(_, values)| of(values).powi(2)).sum::<f64>() / common.len() as f64).sqrt()
    };
    let size = rms(&|[a, _]| *a).max(rms(&|[_, b]| *b));
    Some(Worst {
        relative: if size > 0.0 { rms(&|[a, b]| b - a) / size } else { 0.0 },
        measured_depth: largest.0,
        values: largest.1,
    })
}

/// A name, unit and factor, whether it is judged, the envelope, and the figure of it; joints or stations.
type Known = (
    &'static str,
    (&'static str, f64),
    bool,
    fn(&Locations) -> (&Envelope, &Vec<f64>),
    fn(&Statistics) -> f64,
);

/// All quantities along the tool.
pub(crate) fn all(a: &Locations, b: &Locations) -> Vec<Along> {
    let (kn, nm) = (("kN", n_to_kn(1.0)), ("N m", 1.0));
    let (deg, share) = (("deg", rad_to_deg(1.0)), ("%", 100.0));
    // Mean values are judged, largest ones only shown: two chaotic runs differ in every peak.
    let known: [Known; 12] = [
        (
            "normal force, pipe on guide, largest",
            kn,
            false,
            |l| (&l.peak[0], &l.station_depth),
            |s| s.max,
        ),
        (
            "normal force, pipe on guide, RMS",
            kn,
            true,
            |l| (&l.rms[0], &l.station_depth),
            Statistics::rms,
        ),
        (
            "normal force, guide on wall, largest",
            kn,
            false,
            |l| (&l.peak[1], &l.station_depth),
            |s| s.max,
        ),
        (
            "normal force, guide on wall, RMS",
            kn,
            true,
            |l| (&l.rms[1], &l.station_depth),
            Statistics::rms,
        ),
        (
            "time in contact, pipe on guide",
            share,
            true,
            |l| (&l.contact[0], &l.station_depth),
            Statistics::mean,
        ),
        (
            "time in contact, guide on wall",
            share,
            true,
            |l| (&l.contact[1], &l.station_depth),
            Statistics::mean,
        ),
        (
            "axial force, mean",
            kn,
            true,
            |l| (&l.axial_force, &l.joint_depth),
            Statistics::mean,
        ),
        (
            "torque through the joints, mean",
            nm,
            true,
            |l| (&l.torque, &l.joint_depth),
            Statistics::mean,
        ),
        (
            "shear force through the joints, RMS",
            kn,
            true,
            |l| (&l.shear_force, &l.joint_depth),
            Statistics::rms,
        ),
        (
            "bend of the joints, largest",
            deg,
            false,
            |l| (&l.bend, &l.joint_depth),
            |s| s.max,
        ),
        (
            "bend of the joints, mean",
            deg,
            true,
            |l| (&l.bend, &l.joint_depth),
            Statistics::mean,
        ),
        (
            "moment of the joints' stops, RMS",
            nm,
            true,
            |l| (&l.stop_moment, &l.joint_depth),
            Statistics::rms,
        ),
    ];
    known
        // The envelope of both runs is formed by the same function; a difference is that of the runs.
        .into_iter()
        .map(|(name, unit, judged, envelope, of)| {
            let curve = |locations: &Locations| {
                let (envelope, depths) = envelope(locations);
                envelope.curve(depths, 1.0, of)
            };
            let curves = Pair {
                a: curve(a),
                b: curve(b),
            };
            Along {
                name,
                unit,
                judged,
                // The worst difference gives the page its place to look at.
                worst: worst(&curves.a, &curves.b),
                curves,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_of_other_stations_are_compared_where_both_are_known() {
        let a: Curve = vec![(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (9.0, 50.0)];
        let b: Curve = vec![(0.0, 1.0), (0.5, 1.5), (2.0, 4.0)];
        let worst = worst(&a, &b).unwrap();
        // B at 1 m: 1.5 + 2.5 / 3.
        assert_eq!((worst.measured_depth, worst.values), (2.0, [3.0, 4.0]));
        let at_one: f64 = 1.5 + 2.5 / 3.0;
        let difference = (((at_one - 2.0).powi(2) + 1.0) / 3.0).sqrt();
        let size = ((1.0 + at_one.powi(2) + 16.0) / 3.0).sqrt();
        assert!((worst.relative - difference / size).abs() < 1e-12);
        assert_eq!(at(&b, 5.0), None);
    }
}
