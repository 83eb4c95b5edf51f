//! Envelopes along the tool, whirl by station, and the orbits of the worst joints around their worst instants.

use std::collections::{BTreeMap, VecDeque};

use crate::envelope::Envelope;
use crate::is_quantity;
use flexdrill_messages::{ContactForces, JointDeflections, WhirlState};

/// Number of samples of an orbit: four seconds at the usual 50 Hz.
const WINDOW: usize = 200;
/// Number of locations listed by each measure.
pub(crate) const NAMED: usize = 3;
/// Share of the tool's length within which two locations count as one.
const APART: f64 = 0.1;

/// The measures by which a location is the worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measure {
    PipeGuide,
    GuideWall,
    Whirl,
}

impl Measure {
    pub(crate) const ALL: [Self; 3] = [Self::PipeGuide, Self::GuideWall, Self::Whirl];
}

/// Time (s), and for each joint its lateral position (m) and the spin of the link below (rad/s).
type Sample = (f64, Vec<[f64; 2]>, Vec<f64>);

/// Path of a joint around its worst instant: horizontal and towards the low side, from the bore's axis (m).
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Orbit {
    pub points: Vec<[f64; 2]>,
    /// First and last sample (s from the beginning).
    pub span: [f64; 2],
    /// Mean spin of the link (rad/s).
    pub spin: f64,
}

/// The worst instant of one joint by one measure, and the orbit around it once its samples are complete.
#[derive(Debug, Clone, Default)]
struct WorstInstant {
    score: f64,
    /// Number of samples until the orbit is complete.
    wait: Option<usize>,
    orbit: Orbit,
}

/// Whirl at one watched station of one pipe.
#[derive(Debug, Clone, Default)]
pub(crate) struct WhirlStation {
    pub body: u8,
    pub measured_depth: f64,
    pub inclination: f64,
    /// Evaluations by kind.
    pub kinds: BTreeMap<u8, u64>,
    pub evaluations: u64,
    pub severity: u8,
    /// Kind at the worst instant, as all fields below.
    pub kind: u8,
    pub time: f64,
    pub ratio: f64,
    pub clearance_ratio: f64,
    pub duty: f64,
    pub friction_power: f64,
}

impl WhirlStation {
    fn score(&self) -> (u8, f64) {
        (self.severity, self.clearance_ratio)
    }
}

/// Everything by location along the tool.
#[derive(Debug, Default)]
pub(crate) struct Locations {
    pub joint_depth: Vec<f64>,
    pub joint_inclination: Vec<f64>,
    pub bend: Envelope,
    /// Bend at which the stop begins (rad).
    pub limit: Vec<f64>,
    pub stop_moment: Envelope,
    pub axial_force: Envelope,
    pub shear_force: Envelope,
    pub torque: Envelope,

    pub station_depth: Vec<f64>,
    pub station_inclination: Vec<f64>,
    /// Largest force in each publishing interval: pipe on guide, guide on wall.
    pub peak: [Envelope; 2],
    /// RMS force over each publishing interval.
    pub rms: [Envelope; 2],
    pub shock: [Envelope; 2],
    /// 1 while the layer touches.
    pub contact: [Envelope; 2],

    pub whirl: Vec<WhirlStation>,

    /// Number of messages with another mesh than the first, which were left out.
    pub other_mesh: u64,

    recent: VecDeque<Sample>,
    instants: [Vec<WorstInstant>; 3],
    /// Joint nearest to each station.
    nearest: Vec<usize>,
}

/// Whether the depths are plausible, and all arrays have one entry for each.
fn complete<const N: usize>(depths: &[f64], arrays: [&Vec<f64>; N]) -> bool {
    depths.iter().all(|depth| is_quantity(*depth)) && arrays.iter().all(|array| array.len() == depths.len())
}

/// The index of the entry nearest to a depth.
fn nearest(depths: &[f64], depth: f64) -> Option<usize> {
    (0..depths.len()).min_by(|a, b| (depths[*a] - depth).abs().total_cmp(&(depths[*b] - depth).abs()))
}

impl Locations {
    pub(crate) fn joints(&mut self, time: f64, m: JointDeflections) {
        // The first complete message sets the mesh. All later ones are compared with it.
        if self.joint_depth.is_empty() && complete(&m.measured_depth, []) {
            self.joint_depth.clone_from(&m.measured_depth);
            self.joint_inclination.clone_from(&m.inclination);
            self.limit.clone_from(&m.limit_angle);
            for instants in &mut self.instants {
                instants.resize(m.measured_depth.len(), WorstInstant::default());
            }
        }
        let arrays = [
            &m.inclination,
            &m.bend_angle,
            &m.limit_angle,
            &m.stop_moment,
            &m.lateral_y,
            &m.lateral_z,
            &m.spin_rate,
            &m.axial_force,
            &m.shear_force,
            &m.torque,
        ];
        // A second run with another tool in the same bag would be averaged into the first.
        if m.measured_depth != self.joint_depth || !complete(&self.joint_depth, arrays) {
            self.other_mesh += 1;
            return;
        }
        self.bend.push(time, m.bend_angle);
        self.stop_moment.push(time, m.stop_moment);
        self.axial_force.push(time, m.axial_force);
        self.shear_force.push(time, m.shear_force);
        self.torque.push(time, m.torque);
        // The last seconds are kept, because the worst instant is shown with what came before and after it.
        if self.recent.len() == WINDOW {
            self.recent.pop_front();
        }
        let at = m.lateral_y.into_iter().zip(m.lateral_z).map(|(y, z)| [y, z]).collect();
        self.recent.push_back((time, at, m.spin_rate));
        // An instant waits until the samples after it have come, and then keeps the window around it.
        for instants in &mut self.instants {
            for (joint, instant) in instants.iter_mut().enumerate() {
                match instant.wait {
                    Some(0) => instant.keep(&self.recent, joint),
                    Some(samples) => instant.wait = Some(samples - 1),
                    None => {}
                }
            }
        }
    }

    pub(crate) fn contacts(&mut self, time: f64, m: ContactForces) {
        if self.station_depth.is_empty() && complete(&m.measured_depth, []) {
            self.station_depth.clone_from(&m.measured_depth);
            self.station_inclination.clone_from(&m.inclination);
        }
        let arrays = [
            &m.inclination,
            &m.pipe_guide_normal_peak,
            &m.pipe_guide_normal_rms,
            &m.guide_wall_normal_peak,
            &m.guide_wall_normal_rms,
        ];
        let stations = self.station_depth.len();
        if m.measured_depth != self.station_depth || !complete(&self.station_depth, arrays) || m.state.len() != stations
        {
            self.other_mesh += 1;
            return;
        }
        // Contacts are counted by station, orbits are recorded at joints: each station belongs to its nearest joint.
        // The joints' message may come later.
        if self.nearest.is_empty() && !self.joint_depth.is_empty() {
            self.nearest = self
                .station_depth
                .iter()
                .filter_map(|depth| nearest(&self.joint_depth, *depth))
                .collect();
        }
        // The largest forces decide which joints' orbits are kept.
        for (measure, peaks) in [
            (Measure::PipeGuide, &m.pipe_guide_normal_peak),
            (Measure::GuideWall, &m.guide_wall_normal_peak),
        ] {
            for (station, peak) in peaks.iter().enumerate() {
                if let Some(joint) = self.nearest.get(station) {
                    self.score(measure, *joint, *peak);
                }
            }
        }
        // The share of time in contact is the mean of a flag at the messages.
        let touches = |layer: u8| {
            let touching = [layer, ContactForces::BOTH];
            m.state
                .iter()
                .map(move |state| f64::from(u8::from(touching.contains(state))))
        };
        self.contact[0].push(time, touches(ContactForces::INNER));
        self.contact[1].push(time, touches(ContactForces::OUTER));
        let [inner, outer] = &mut self.peak;
        inner.push(time, m.pipe_guide_normal_peak);
        outer.push(time, m.guide_wall_normal_peak);
        let [inner, outer] = &mut self.rms;
        inner.push(time, m.pipe_guide_normal_rms);
        outer.push(time, m.guide_wall_normal_rms);
        let [inner, outer] = &mut self.shock;
        inner.push(time, m.pipe_guide_shock);
        outer.push(time, m.guide_wall_shock);
    }

    pub(crate) fn whirl(&mut self, time: f64, m: &WhirlState) {
        let stations = m.measured_depth.len();
        let arrays = [
            &m.inclination,
            &m.whirl_ratio,
            &m.clearance_ratio,
            &m.contact_duty,
            &m.friction_power,
        ];
        // The stations that are watched do not change during a run; another number is another tool.
        if self.whirl.is_empty() {
            self.whirl.resize(stations, WhirlStation::default());
        }
        let codes = [&m.body, &m.kind, &m.severity];
        if self.whirl.len() != stations
            || !complete(&m.measured_depth, arrays)
            || codes.iter().any(|codes| codes.len() != stations)
        {
            self.other_mesh += 1;
            return;
        }
        for (index, station) in self.whirl.iter_mut().enumerate() {
            station.body = m.body[index];
            station.measured_depth = m.measured_depth[index];
            station.inclination = m.inclination[index];
            // Shares of kinds count evaluations, since these are equally spaced in time.
            station.evaluations += 1;
            *station.kinds.entry(m.kind[index]).or_default() += 1;
            let now = (m.severity[index], m.clearance_ratio[index]);
            // The worst moment is by level first, and by clearance within a level. Motion without whirl has none.
            if m.kind[index] != WhirlState::NONE && now > station.score() {
                (station.severity, station.clearance_ratio) = now;
                station.kind = m.kind[index];
                station.time = time;
                station.ratio = m.whirl_ratio[index];
                station.duty = m.contact_duty[index];
                station.friction_power = m.friction_power[index];
            }
        }
        // Only the pipe has orbits.
        for index in
            (0..stations).filter(|index| m.body[*index] == WhirlState::PIPE && m.kind[*index] != WhirlState::NONE)
        {
            if let Some(joint) = nearest(&self.joint_depth, m.measured_depth[index]) {
                // A level outweighs any clearance ratio.
                self.score(
                    Measure::Whirl,
                    joint,
                    f64::from(m.severity[index]) * 100.0 + m.clearance_ratio[index],
                );
            }
        }
    }

    fn score(&mut self, measure: Measure, joint: usize, score: f64) {
        if let Some(instant) = self.instants[measure as usize].get_mut(joint)
            && score > instant.score
        {
            instant.score = score;
            instant.wait = Some(WINDOW / 2);
        }
    }

    /// Keeps the orbits that the end of the recording has cut short.
    pub(crate) fn finish(&mut self) {
        for instants in &mut self.instants {
            for (joint, instant) in instants.iter_mut().enumerate() {
                if instant.wait.is_some() {
                    instant.keep(&self.recent, joint);
                }
            }
        }
        self.recent.clear();
    }

    /// Distance along the bore within which two locations count as one (m).
    fn apart(depths: &[f64]) -> f64 {
        APART * (depths.last().copied().unwrap_or(0.0) - depths.first().copied().unwrap_or(0.0)).abs()
    }

    /// Stations with the largest peak forces of a layer: 0 pipe on guide, 1 guide on wall.
    pub(crate) fn worst_stations(&self, layer: usize) -> Vec<usize> {
        let apart = Self::apart(&self.station_depth);
        self.peak[layer].largest(&self.station_depth, apart, NAMED)
    }

    /// Stations with the worst whirl, at least at the level WATCH.
    pub(crate) fn worst_whirl(&self) -> Vec<&WhirlStation> {
        let mut order: Vec<&WhirlStation> = self.whirl.iter().filter(|station| station.severity > 0).collect();
        order.sort_by(|a, b| {
            b.severity
                .cmp(&a.severity)
                .then(b.clearance_ratio.total_cmp(&a.clearance_ratio))
        });
        let apart = Self::apart(&self.joint_depth);
        let mut found: Vec<&WhirlStation> = Vec::new();
        for station in order {
            let near = |other: &&WhirlStation| {
                other.body == station.body && (other.measured_depth - station.measured_depth).abs() < apart
            };
            if found.len() < NAMED && !found.iter().any(near) {
                found.push(station);
            }
        }
        found
    }

    /// The joint nearest to a depth, and its orbit around its worst instant.
    pub(crate) fn orbit(&self, measure: Measure, depth: f64) -> Option<(usize, &Orbit)> {
        let joint = nearest(&self.joint_depth, depth)?;
        let orbit = &self.instants[measure as usize].get(joint)?.orbit;
        (orbit.points.len() > 1).then_some((joint, orbit))
    }

    pub(crate) fn nearest_joint(&self, depth: f64) -> Option<usize> {
        nearest(&self.joint_depth, depth)
    }
}

impl WorstInstant {
    fn keep(&mut self, recent: &VecDeque<Sample>, joint: usize) {
        self.wait = None;
        let samples = || {
            recent
                .iter()
                .filter_map(|(time, at, spin)| Some((*time, *at.get(joint)?, *spin.get(joint)?)))
        };
        let points: Vec<[f64; 2]> = samples().map(|(_, at, _)| at).collect();
        let spin = samples().map(|(_, _, spin)| spin).sum::<f64>() / points.len().max(1) as f64;
        let (first, last) = (samples().next(), samples().next_back());
        self.orbit = Orbit {
            points,
            span: [first.map_or(0.0, |s| s.0), last.map_or(0.0, |s| s.0)],
            spin,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joints(index: usize) -> JointDeflections {
        let zeros = || vec![0.0; 2];
        JointDeflections {
            measured_depth: vec![0.5, 1.5],
            inclination: zeros(),
            bend_angle: zeros(),
            limit_angle: zeros(),
            stop_moment: zeros(),
            lateral_y: vec![index as f64, -(index as f64)],
            lateral_z: zeros(),
            spin_rate: vec![2.0, 2.0],
            axial_force: zeros(),
            shear_force: zeros(),
            torque: zeros(),
            ..JointDeflections::default()
        }
    }

    fn contacts(peak: f64) -> ContactForces {
        let row = |value: f64| vec![0.1, 0.2, value, 0.3];
        ContactForces {
            measured_depth: vec![0.0, 0.5, 1.4, 2.0],
            inclination: vec![0.0; 4],
            state: vec![ContactForces::INNER; 4],
            pipe_guide_normal_peak: row(peak),
            pipe_guide_normal_rms: row(peak),
            guide_wall_normal_peak: vec![0.0; 4],
            guide_wall_normal_rms: vec![0.0; 4],
            ..ContactForces::default()
        }
    }

    #[test]
    fn the_orbit_surrounds_the_worst_instant() {
        let mut locations = Locations::default();
        for index in 0..1000 {
            locations.joints(index as f64, joints(index));
            locations.contacts(index as f64, contacts(if index == 400 { 9.0 } else { 1.0 }));
        }
        locations.finish();
        assert_eq!(locations.worst_stations(0)[0], 2);
        let (joint, orbit) = locations.orbit(Measure::PipeGuide, 1.4).unwrap();
        assert_eq!(joint, 1);
        assert_eq!(orbit.points.len(), WINDOW);
        let middle = 0.5 * (orbit.span[0] + orbit.span[1]);
        // The window is even, and the forces follow the joints, so the instant is within two samples of the middle.
        assert!((middle - 400.0).abs() <= 2.0, "{middle}");
        assert!(orbit.points.contains(&[-400.0, 0.0]));
        assert_eq!(locations.orbit(Measure::Whirl, 1.4), None);
    }

    #[test]
    fn a_message_of_another_mesh_or_without_its_arrays_is_left_out() {
        let mut locations = Locations::default();
        locations.joints(0.0, joints(0));
        let mut other = joints(1);
        other.measured_depth = vec![0.5, 1.6];
        locations.joints(1.0, other);
        let mut cut = joints(2);
        cut.torque.pop();
        locations.joints(2.0, cut);
        locations.contacts(0.0, contacts(1.0));
        let mut cut = contacts(7.0);
        cut.state.clear();
        locations.contacts(1.0, cut);
        assert_eq!(locations.other_mesh, 3);
        assert_eq!(locations.peak[0].at(2).unwrap().max, 1.0);
    }
}
