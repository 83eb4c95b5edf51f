//! What happened where: envelopes along the tool, whirl, and the orbits at the worst places in their worst moments.

use std::collections::{BTreeMap, VecDeque};

use super::along::Envelope;
use super::is_quantity;
use crate::messages::{ContactForces, JointDeflections, WhirlState};

/// Samples of an orbit: four seconds at the usual 50 Hz.
const WINDOW: usize = 200;
/// Places that are named of each kind.
pub(super) const NAMED: usize = 3;
/// Share of the tool's length within which places count as one.
const APART: f64 = 0.1;

/// What a place can be the worst by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Worst {
    PipeGuide,
    GuideWall,
    Whirl,
}

impl Worst {
    pub(super) const ALL: [Self; 3] = [Self::PipeGuide, Self::GuideWall, Self::Whirl];
}

/// Time, and of each joint its place across the hole (m) and the spin of the link below (rad/s).
type Sample = (f64, Vec<[f64; 2]>, Vec<f64>);

/// Motion of a joint about its worst moment: horizontal and towards the low side, from the bore's axis (m).
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Orbit {
    pub points: Vec<[f64; 2]>,
    /// First and last sample (s from the beginning).
    pub span: [f64; 2],
    /// Mean spin of the link (rad/s).
    pub spin: f64,
}

/// The worst moment of one joint by one measure, and the samples about it once they are there.
#[derive(Debug, Clone, Default)]
struct Moment {
    score: f64,
    /// Samples until the window is to be kept.
    wait: Option<usize>,
    orbit: Orbit,
}

/// Whirl at one watched place of one pipe.
#[derive(Debug, Clone, Default)]
pub(super) struct WhirlPlace {
    pub body: u8,
    pub measured_depth: f64,
    pub inclination: f64,
    /// Evaluations by kind.
    pub kinds: BTreeMap<u8, u64>,
    pub evaluations: u64,
    pub severity: u8,
    /// Of the worst moment.
    pub kind: u8,
    pub time: f64,
    pub ratio: f64,
    pub clearance_ratio: f64,
    pub duty: f64,
    pub friction_power: f64,
}

impl WhirlPlace {
    fn score(&self) -> (u8, f64) {
        (self.severity, self.clearance_ratio)
    }
}

/// Everything along the tool.
#[derive(Debug, Default)]
pub(super) struct Places {
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
    /// Largest in each publishing interval, pipe on guide and guide on wall.
    pub peak: [Envelope; 2],
    /// Root mean square over each publishing interval.
    pub rms: [Envelope; 2],
    pub shock: [Envelope; 2],
    /// 1 while the layer touches.
    pub contact: [Envelope; 2],

    pub whirl: Vec<WhirlPlace>,

    /// Messages of another mesh than the first, which were left out.
    pub other_mesh: u64,

    recent: VecDeque<Sample>,
    moments: [Vec<Moment>; 3],
    /// Joint nearest to each station.
    nearest: Vec<usize>,
}

/// Whether places are where something can be, and all arrays have one entry for each.
fn complete<const N: usize>(places: &[f64], arrays: [&Vec<f64>; N]) -> bool {
    places.iter().all(|place| is_quantity(*place)) && arrays.iter().all(|array| array.len() == places.len())
}

/// The entry nearest to a place.
fn nearest(depths: &[f64], depth: f64) -> Option<usize> {
    (0..depths.len()).min_by(|a, b| (depths[*a] - depth).abs().total_cmp(&(depths[*b] - depth).abs()))
}

impl Places {
    pub(super) fn joints(&mut self, time: f64, m: JointDeflections) {
        if self.joint_depth.is_empty() && complete(&m.measured_depth, []) {
            self.joint_depth.clone_from(&m.measured_depth);
            self.joint_inclination.clone_from(&m.inclination);
            self.limit.clone_from(&m.limit_angle);
            for moments in &mut self.moments {
                moments.resize(m.measured_depth.len(), Moment::default());
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
        if m.measured_depth != self.joint_depth || !complete(&self.joint_depth, arrays) {
            self.other_mesh += 1;
            return;
        }
        self.bend.push(time, m.bend_angle);
        self.stop_moment.push(time, m.stop_moment);
        self.axial_force.push(time, m.axial_force);
        self.shear_force.push(time, m.shear_force);
        self.torque.push(time, m.torque);
        if self.recent.len() == WINDOW {
            self.recent.pop_front();
        }
        let at = m.lateral_y.into_iter().zip(m.lateral_z).map(|(y, z)| [y, z]).collect();
        self.recent.push_back((time, at, m.spin_rate));
        for moments in &mut self.moments {
            for (joint, moment) in moments.iter_mut().enumerate() {
                match moment.wait {
                    Some(0) => moment.keep(&self.recent, joint),
                    Some(samples) => moment.wait = Some(samples - 1),
                    None => {}
                }
            }
        }
    }

    pub(super) fn contacts(&mut self, time: f64, m: ContactForces) {
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
        if self.nearest.is_empty() && !self.joint_depth.is_empty() {
            self.nearest = self
                .station_depth
                .iter()
                .filter_map(|depth| nearest(&self.joint_depth, *depth))
                .collect();
        }
        for (worst, peaks) in [
            (Worst::PipeGuide, &m.pipe_guide_normal_peak),
            (Worst::GuideWall, &m.guide_wall_normal_peak),
        ] {
            for (station, peak) in peaks.iter().enumerate() {
                if let Some(joint) = self.nearest.get(station) {
                    self.score(worst, *joint, *peak);
                }
            }
        }
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

    pub(super) fn whirl(&mut self, time: f64, m: &WhirlState) {
        let places = m.measured_depth.len();
        let arrays = [
            &m.inclination,
            &m.whirl_ratio,
            &m.clearance_ratio,
            &m.contact_duty,
            &m.friction_power,
        ];
        if self.whirl.is_empty() {
            self.whirl.resize(places, WhirlPlace::default());
        }
        let codes = [&m.body, &m.kind, &m.severity];
        if self.whirl.len() != places
            || !complete(&m.measured_depth, arrays)
            || codes.iter().any(|codes| codes.len() != places)
        {
            self.other_mesh += 1;
            return;
        }
        for (index, place) in self.whirl.iter_mut().enumerate() {
            place.body = m.body[index];
            place.measured_depth = m.measured_depth[index];
            place.inclination = m.inclination[index];
            place.evaluations += 1;
            *place.kinds.entry(m.kind[index]).or_default() += 1;
            let now = (m.severity[index], m.clearance_ratio[index]);
            if m.kind[index] != WhirlState::NONE && now > place.score() {
                (place.severity, place.clearance_ratio) = now;
                place.kind = m.kind[index];
                place.time = time;
                place.ratio = m.whirl_ratio[index];
                place.duty = m.contact_duty[index];
                place.friction_power = m.friction_power[index];
            }
        }
        for index in
            (0..places).filter(|index| m.body[*index] == WhirlState::PIPE && m.kind[*index] != WhirlState::NONE)
        {
            if let Some(joint) = nearest(&self.joint_depth, m.measured_depth[index]) {
                // A level weighs more than any share of the gap.
                self.score(
                    Worst::Whirl,
                    joint,
                    f64::from(m.severity[index]) * 100.0 + m.clearance_ratio[index],
                );
            }
        }
    }

    fn score(&mut self, worst: Worst, joint: usize, score: f64) {
        if let Some(moment) = self.moments[worst as usize].get_mut(joint)
            && score > moment.score
        {
            moment.score = score;
            moment.wait = Some(WINDOW / 2);
        }
    }

    /// Keeps the windows that the recording's end has cut short.
    pub(super) fn finish(&mut self) {
        for moments in &mut self.moments {
            for (joint, moment) in moments.iter_mut().enumerate() {
                if moment.wait.is_some() {
                    moment.keep(&self.recent, joint);
                }
            }
        }
        self.recent.clear();
    }

    /// Length along the bore within which places count as one (m).
    fn apart(depths: &[f64]) -> f64 {
        APART * (depths.last().copied().unwrap_or(0.0) - depths.first().copied().unwrap_or(0.0)).abs()
    }

    /// Stations with the largest peaks of a layer, 0 pipe on guide, 1 guide on wall.
    pub(super) fn worst_stations(&self, layer: usize) -> Vec<usize> {
        let apart = Self::apart(&self.station_depth);
        self.peak[layer].largest(&self.station_depth, apart, NAMED)
    }

    /// Places with the worst whirl, at least at the level WATCH.
    pub(super) fn worst_whirl(&self) -> Vec<&WhirlPlace> {
        let mut order: Vec<&WhirlPlace> = self.whirl.iter().filter(|place| place.severity > 0).collect();
        order.sort_by(|a, b| {
            b.severity
                .cmp(&a.severity)
                .then(b.clearance_ratio.total_cmp(&a.clearance_ratio))
        });
        let apart = Self::apart(&self.joint_depth);
        let mut found: Vec<&WhirlPlace> = Vec::new();
        for place in order {
            let near = |other: &&WhirlPlace| {
                other.body == place.body && (other.measured_depth - place.measured_depth).abs() < apart
            };
            if found.len() < NAMED && !found.iter().any(near) {
                found.push(place);
            }
        }
        found
    }

    /// The joint nearest to a place, and its orbit in the moment that was worst there.
    pub(super) fn orbit(&self, worst: Worst, depth: f64) -> Option<(usize, &Orbit)> {
        let joint = nearest(&self.joint_depth, depth)?;
        let orbit = &self.moments[worst as usize].get(joint)?.orbit;
        (orbit.points.len() > 1).then_some((joint, orbit))
    }

    /// The joint nearest to a place.
    pub(super) fn nearest_joint(&self, depth: f64) -> Option<usize> {
        nearest(&self.joint_depth, depth)
    }
}

impl Moment {
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
    fn the_orbit_is_that_about_the_worst_moment() {
        let mut places = Places::default();
        for index in 0..1000 {
            places.joints(index as f64, joints(index));
            places.contacts(index as f64, contacts(if index == 400 { 9.0 } else { 1.0 }));
        }
        places.finish();
        assert_eq!(places.worst_stations(0)[0], 2);
        let (joint, orbit) = places.orbit(Worst::PipeGuide, 1.4).unwrap();
        assert_eq!(joint, 1);
        assert_eq!(orbit.points.len(), WINDOW);
        let middle = 0.5 * (orbit.span[0] + orbit.span[1]);
        // The window is even, and the forces come after the joints: within a sample or two of the middle.
        assert!((middle - 400.0).abs() <= 2.0, "{middle}");
        assert!(orbit.points.contains(&[-400.0, 0.0]));
        assert_eq!(places.orbit(Worst::Whirl, 1.4), None);
    }

    #[test]
    fn a_message_of_another_mesh_or_without_its_arrays_is_left_out() {
        let mut places = Places::default();
        places.joints(0.0, joints(0));
        let mut other = joints(1);
        other.measured_depth = vec![0.5, 1.6];
        places.joints(1.0, other);
        let mut cut = joints(2);
        cut.torque.pop();
        places.joints(2.0, cut);
        places.contacts(0.0, contacts(1.0));
        let mut cut = contacts(7.0);
        cut.state.clear();
        places.contacts(1.0, cut);
        assert_eq!(places.other_mesh, 3);
        assert_eq!(places.peak[0].at(2).unwrap().max, 1.0);
    }
}
