//! Lateral motion of one pipe: its amplitude along the tool, its direction of whirl, and the kinks of its shape.

use flexdrill_core::tool::Body;
use flexdrill_motion::{StationSample, WatchedStation, WhirlAnalysis, WhirlKind, WhirlReport, WhirlSettings};

use super::record::{Axis, Record};
use super::series::{spread, two_peaks};

/// Smallest distance between the two stations of largest displacement (rad): ten degrees, three or four links.
const APART: f64 = 0.1745;

/// Whirl at one station over the record.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Whirl {
    /// Part of the judgements that said forward, 0 to 1.
    pub forward: f64,
    /// Backward.
    pub backward: f64,
    /// Mean of the whirl rate over the rotary speed while it was forward or backward, positive forward.
    pub ratio: f64,
}

impl Whirl {
    /// The kind that stood for more than half of the record.
    pub fn kind(&self) -> Option<WhirlKind> {
        if self.forward > 0.5 {
            Some(WhirlKind::Forward)
        } else if self.backward > 0.5 {
            Some(WhirlKind::Backward)
        } else {
            None
        }
    }

    /// The direction as a word and part of the record.
    pub fn words(&self) -> String {
        if self.forward.max(self.backward) < 0.05 {
            return "no steady direction".to_owned();
        }
        let (word, share) = if self.forward >= self.backward {
            ("forward", self.forward)
        } else {
            ("backward", self.backward)
        };
        format!(
            "{word} for {:.0} % of the record, ratio {:.2}",
            100.0 * share,
            self.ratio
        )
    }
}

/// Motion of one pipe in the bore.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// RMS distance from its own mean position, per station (m).
    pub radius: Vec<f64>,
    /// Largest distance from the bore's axis, per station (m).
    pub reach: Vec<f64>,
    /// Stations of the two largest motions, at least ten degrees apart, the upper one first.
    pub places: [usize; 2],
    /// Whirl per station.
    pub whirl: Vec<Whirl>,
    /// Part of the shape's kinks that is at joint stations, 0 to 1.
    pub broken: f64,
    /// RMS kink of the shape between neighbouring elements (rad).
    pub kink: f64,
}

/// Motion of a pipe. Whirl is judged by [`WhirlAnalysis`], of the pipe's position in the bore.
pub fn motion(record: &Record, body: Body) -> Motion {
    let axis = match body {
        Body::Pipe => &record.pipe,
        Body::Guide => &record.guide,
    };
    let stations = &record.stations;
    let n = stations.len();
    let radius: Vec<f64> = (0..n)
        .map(|s| spread(axis.y.at(s)).hypot(spread(axis.z.at(s))))
        .collect();
    let reach = (0..n)
        .map(|s| {
            axis.y
                .at(s)
                .zip(axis.z.at(s))
                .fold(0.0_f64, |r, (y, z)| r.max(y.hypot(z)))
        })
        .collect();
    let places = two_peaks(&radius, &stations.inclination, APART);
    let (broken, kink) = kinks(record, axis, body);
    Motion {
        radius,
        reach,
        places,
        whirl: whirl(record, axis, body),
        broken,
        kink,
    }
}

fn whirl(record: &Record, axis: &Axis, body: Body) -> Vec<Whirl> {
    let stations = &record.stations;
    let n = stations.len();
    let places = (0..n)
        .map(|s| WatchedStation {
            station: s,
            body,
            measured_depth: stations.depth[s],
            inclination: stations.inclination[s],
            clearance: match body {
                Body::Pipe => stations.inner_clearance[s],
                Body::Guide => stations.outer_clearance,
            },
            body_diameter: match body {
                Body::Pipe => stations.pipe_diameter[s],
                Body::Guide => stations.guide_diameter,
            },
            // Only for the power of the friction, which a record of positions does not have.
            length: 1.0,
        })
        .collect();
    // The analysis of the node with its own settings, so that the finding is what an operator would be shown.
    let settings = WhirlSettings::default();
    let mut analysis = WhirlAnalysis::new(&settings, record.interval, places);
    let mut report = WhirlReport::default();
    let mut found = vec![Whirl::default(); n];
    // The verdicts are read as often as they change.
    let every = ((settings.evaluation_interval / record.interval).round() as usize).max(1);
    // The analysis has no result before half of the window is filled.
    let first = record
        .time
        .len()
        .min((0.5 * settings.max_window / record.interval) as usize + every);
    let mut judgements = 0.0;
    let mut samples = vec![StationSample::default(); n];
    for (sample, &time) in record.time.iter().enumerate() {
        for (place, (&y, &z)) in samples
            .iter_mut()
            .zip(axis.y.row(sample).iter().zip(axis.z.row(sample)))
        {
            (place.y, place.z) = (y, z);
        }
        // The analysis runs on the record's samples, whose interval it was built for.
        analysis.push(time, record.rotary_speed, &samples);
        if sample < first || !sample.is_multiple_of(every) {
            continue;
        }
        analysis.report(&mut report);
        judgements += 1.0;
        for (s, whirl) in found.iter_mut().enumerate() {
            // Only verdicts with a direction count. The shares are of all judgements, so that chaos lowers both.
            match report.kind[s] {
                WhirlKind::Forward => whirl.forward += 1.0,
                WhirlKind::Backward => whirl.backward += 1.0,
                WhirlKind::None | WhirlKind::Chaotic | WhirlKind::JointVibration => continue,
            }
            whirl.ratio += report.whirl_ratio[s];
        }
    }
    // A station that never whirled keeps zeros instead of NaN.
    for whirl in &mut found {
        let turning = whirl.forward + whirl.backward;
        if turning > 0.0 {
            whirl.ratio /= turning;
            whirl.forward /= judgements;
            whirl.backward /= judgements;
        }
    }
    found
}

/// Part of the kinks at joints, and the RMS kink. A kink is the change of slope of the displacement (without the
/// chord's offset, which is no displacement) from one element to the next.
fn kinks(record: &Record, axis: &Axis, body: Body) -> (f64, f64) {
    let stations = &record.stations;
    let n = stations.len();
    let offset = |s: usize, k: usize| match body {
        Body::Pipe => stations.offset[s][k],
        Body::Guide => 0.0,
    };
    let (mut at_joints, mut all, mut count) = (0.0, 0.0, 0.0);
    // Ten shapes per turn suffice.
    let every = ((0.1 * record.turn() / record.interval) as usize).max(1);
    for sample in (0..record.time.len()).step_by(every) {
        for s in 1..n.saturating_sub(1) {
            let kink = |series: &super::Series, k: usize| {
                let row = series.row(sample);
                let at = |i: usize| row[i] - offset(i, k);
                let slope = |i: usize| (at(i + 1) - at(i)) / (stations.depth[i + 1] - stations.depth[i]);
                slope(s) - slope(s - 1)
            };
            let square = kink(&axis.y, 0).powi(2) + kink(&axis.z, 1).powi(2);
            all += square;
            count += 1.0;
            if stations.joint[s] {
                at_joints += square;
            }
        }
    }
    let broken = if all > 0.0 { at_joints / all } else { 0.0 };
    (broken, (all / f64::max(count, 1.0)).sqrt())
}
