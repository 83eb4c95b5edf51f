//! Episodes of a run: a motion that reached a level, with its kind, location, severity and duration.

use serde::Serialize;

use super::{Severity, ShockLevel, WhirlKind, WhirlReport};
use flexdrill_base::Body;

/// The kind of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EpisodeKind {
    /// Whirl in the sense of the rotation.
    ForwardWhirl,
    /// Whirl against it, sliding.
    BackwardWhirl,
    /// Whirl against it at the rate of rolling without slip.
    RollingWhirl,
    /// Large motion without direction that does not repeat itself.
    ChaoticWhirl,
    /// The bit stops, or nearly, and springs forward.
    StickSlip,
    /// Lateral shock: the impulse of collisions.
    Shock,
}

/// A location on the tool.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ToolLocation {
    /// Station index from the top.
    pub station: usize,
    /// Which pipe moved.
    pub body: Body,
    /// m from the kick-off.
    pub measured_depth: f64,
    /// Inclination there (rad).
    pub inclination: f64,
}

/// One row of the table. Neighbouring stations with the same motion at the same time are one episode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Episode {
    /// Kind at the worst moment.
    pub kind: EpisodeKind,
    /// Highest level reached.
    pub severity: Severity,
    /// Model time of the first level above OK (s).
    pub start: f64,
    /// Until the level was OK again, the hold-off included, or until the run ended (s).
    pub duration: f64,
    /// Whether it stood when the run ended.
    pub lasting: bool,
    /// Where it was worst.
    pub place: ToolLocation,
    /// First and last station from the top that took part.
    pub stations: [usize; 2],
    /// Whirl rate over rotary speed at the worst moment; NaN where whirl had no one rate then, 0 for other kinds.
    pub whirl_ratio: f64,
    /// Whirl rate over that of rolling without slip, for backward whirl.
    pub rolling_share: f64,
    /// Largest distance from the gap's centre over the clearance; 0 for other kinds than whirl.
    pub clearance_ratio: f64,
    /// Largest part of the time in contact.
    pub contact_duty: f64,
    /// Largest normal force (N); 0 for stick-slip and shock.
    pub peak_force: f64,
    /// Largest stick-slip index, or impulse of a shock (N s); 0 for whirl.
    pub strength: f64,
    /// Lowest confidence while it stood; 1 for kinds that have none.
    pub confidence: f64,
}

/// The state of a run at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Observation<'a> {
    /// Model time (s).
    pub time: f64,
    /// Every watched place.
    pub whirl: &'a WhirlReport,
    /// Level and index of the bit's stick-slip.
    pub stick_slip: (Severity, f64),
    /// The bit's place.
    pub bit: ToolLocation,
    /// Level of the shock watch.
    pub shock: ShockLevel,
    /// Where that shock was.
    pub shock_place: ToolLocation,
}

/// Collects the table. It allocates, so that the solver's step cannot use it.
#[derive(Debug, Clone, Default)]
pub struct EpisodeLog {
    /// Per watched place, then stick-slip, then shock.
    open: Vec<Option<Episode>>,
    closed: Vec<Episode>,
    /// Watched places in order, to know neighbours.
    watched: Vec<(Body, usize)>,
    time: f64,
}

impl EpisodeLog {
    /// Adds the next instant. A time that steps back (a reset) ends all open episodes.
    pub fn push(&mut self, at: &Observation<'_>) {
        let places = at.whirl.kind.len();
        if self.open.len() != places + 2 || at.time < self.time {
            self.close_all(false);
            self.open = vec![None; places + 2];
            self.watched = at
                .whirl
                .body
                .iter()
                .copied()
                .zip(at.whirl.station.iter().copied())
                .collect();
        }
        self.time = at.time;
        for index in 0..places {
            let severity = at.whirl.severity[index];
            self.update(index, severity, at.time, || whirl_episode(at, index));
        }
        let (severity, index) = at.stick_slip;
        self.update(places, severity, at.time, || Episode {
            strength: index,
            ..episode(EpisodeKind::StickSlip, at.time, at.bit)
        });
        self.update(places + 1, at.shock.severity, at.time, || Episode {
            strength: at.shock.impulse,
            ..episode(EpisodeKind::Shock, at.time, at.shock_place)
        });
    }

    /// Ends the run, which leaves open episodes lasting. Returns the episodes in the order of their start, with neighbours
    /// merged.
    pub fn finish(mut self) -> Vec<Episode> {
        self.close_all(true);
        let mut merged: Vec<Episode> = Vec::new();
        let mut rest = std::mem::take(&mut self.closed);
        rest.sort_by(|a, b| a.start.total_cmp(&b.start).then(a.place.station.cmp(&b.place.station)));
        for episode in rest {
            match merged.iter_mut().find(|other| self.belong_together(other, &episode)) {
                Some(other) => join(other, episode),
                None => merged.push(episode),
            }
        }
        // A station between two groups joins them.
        let mut index = 0;
        while index < merged.len() {
            let found = (index + 1..merged.len()).find(|other| self.belong_together(&merged[index], &merged[*other]));
            match found {
                Some(other) => {
                    let episode = merged.remove(other);
                    join(&mut merged[index], episode);
                }
                None => index += 1,
            }
        }
        merged.sort_by(|a, b| a.start.total_cmp(&b.start));
        merged
    }

    fn update(&mut self, index: usize, severity: Severity, time: f64, now: impl FnOnce() -> Episode) {
        let open = &mut self.open[index];
        if severity == Severity::Ok {
            if let Some(mut episode) = open.take() {
                episode.duration = time - episode.start;
                self.closed.push(episode);
            }
            return;
        }
        let now = Episode { severity, ..now() };
        match open {
            None => *open = Some(now),
            Some(episode) => {
                // A held level brings no new kind: the kind is that of the worst moment.
                if severity > episode.severity || (severity == episode.severity && worse(&now, episode)) {
                    let lead = [
                        episode.clearance_ratio,
                        episode.contact_duty,
                        episode.peak_force,
                        episode.strength,
                    ];
                    let (start, confidence) = (episode.start, episode.confidence);
                    *episode = Episode {
                        start,
                        confidence: confidence.min(now.confidence),
                        ..now
                    };
                    widen(episode, lead);
                } else {
                    let lead = [now.clearance_ratio, now.contact_duty, now.peak_force, now.strength];
                    widen(episode, lead);
                }
            }
        }
    }

    fn close_all(&mut self, lasting: bool) {
        for open in &mut self.open {
            if let Some(mut episode) = open.take() {
                episode.duration = self.time - episode.start;
                episode.lasting = lasting;
                self.closed.push(episode);
            }
        }
    }

    fn belong_together(&self, a: &Episode, b: &Episode) -> bool {
        let (end_a, end_b) = (a.start + a.duration, b.start + b.duration);
        let whirl = !matches!(a.kind, EpisodeKind::StickSlip | EpisodeKind::Shock);
        whirl
            && a.kind == b.kind
            && a.place.body == b.place.body
            && a.severity == b.severity
            && a.start <= end_b
            && b.start <= end_a
            && self.are_neighbours(a, b)
    }

    /// Whether no watched station of the same pipe lies between them.
    fn are_neighbours(&self, a: &Episode, b: &Episode) -> bool {
        let (low, high) = if a.stations[0] <= b.stations[0] { (a, b) } else { (b, a) };
        let (from, to) = (low.stations[1], high.stations[0]);
        !self
            .watched
            .iter()
            .any(|(body, station)| *body == a.place.body && *station > from && *station < to)
    }
}

/// Whether `now` is a worse moment of an episode: of the same kind, with a larger force.
fn worse(now: &Episode, before: &Episode) -> bool {
    now.kind == before.kind && now.peak_force.max(now.strength) > before.peak_force.max(before.strength)
}

fn widen(episode: &mut Episode, [clearance_ratio, contact_duty, peak_force, strength]: [f64; 4]) {
    episode.clearance_ratio = episode.clearance_ratio.max(clearance_ratio);
    episode.contact_duty = episode.contact_duty.max(contact_duty);
    episode.peak_force = episode.peak_force.max(peak_force);
    episode.strength = episode.strength.max(strength);
}

fn join(one: &mut Episode, other: Episode) {
    let start = one.start.min(other.start);
    let end = (one.start + one.duration).max(other.start + other.duration);
    let stations = [
        one.stations[0].min(other.stations[0]),
        one.stations[1].max(other.stations[1]),
    ];
    let lasting = one.lasting || other.lasting;
    let confidence = one.confidence.min(other.confidence);
    let (mut lead, less) = if other.peak_force > one.peak_force {
        (other, one.clone())
    } else {
        (one.clone(), other)
    };
    widen(
        &mut lead,
        [less.clearance_ratio, less.contact_duty, less.peak_force, less.strength],
    );
    *one = Episode {
        start,
        duration: end - start,
        lasting,
        stations,
        confidence,
        ..lead
    };
}

fn episode(kind: EpisodeKind, time: f64, place: ToolLocation) -> Episode {
    Episode {
        kind,
        severity: Severity::Ok,
        start: time,
        duration: 0.0,
        lasting: false,
        place,
        stations: [place.station; 2],
        whirl_ratio: 0.0,
        rolling_share: 0.0,
        clearance_ratio: 0.0,
        contact_duty: 0.0,
        peak_force: 0.0,
        strength: 0.0,
        confidence: 1.0,
    }
}

fn whirl_episode(at: &Observation<'_>, index: usize) -> Episode {
    let whirl = at.whirl;
    let kind = match (whirl.level_kind[index], whirl.rolling[index]) {
        (WhirlKind::Forward, _) => EpisodeKind::ForwardWhirl,
        (WhirlKind::Backward, true) => EpisodeKind::RollingWhirl,
        (WhirlKind::Backward, false) => EpisodeKind::BackwardWhirl,
        // A level needs a kind; none is left only between a restart of the windows and the end of the hold-off.
        (WhirlKind::Chaotic | WhirlKind::JointVibration | WhirlKind::None, _) => EpisodeKind::ChaoticWhirl,
    };
    let place = ToolLocation {
        station: whirl.station[index],
        body: whirl.body[index],
        measured_depth: whirl.measured_depth[index],
        inclination: whirl.inclination[index],
    };
    Episode {
        whirl_ratio: whirl.whirl_ratio[index],
        rolling_share: whirl.rolling_share[index],
        clearance_ratio: whirl.clearance_ratio[index],
        contact_duty: whirl.contact_duty[index],
        peak_force: whirl.peak_force[index],
        confidence: whirl.confidence[index],
        ..episode(kind, at.time, place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(station: usize) -> ToolLocation {
        ToolLocation {
            station,
            body: Body::Pipe,
            measured_depth: station as f64,
            inclination: 0.0,
        }
    }

    /// Pipe places at stations 5, 10, 15, 20.
    fn report(severity: [Severity; 4], kind: WhirlKind, force: f64) -> WhirlReport {
        WhirlReport {
            station: vec![5, 10, 15, 20],
            measured_depth: vec![0.5, 1.0, 1.5, 2.0],
            inclination: vec![0.0; 4],
            body: vec![Body::Pipe; 4],
            kind: vec![kind; 4],
            level_kind: vec![kind; 4],
            rolling: vec![false; 4],
            whirl_rate: vec![0.0; 4],
            whirl_ratio: vec![1.0; 4],
            orbit_radius: vec![0.0; 4],
            clearance_ratio: vec![1.0; 4],
            contact_duty: vec![0.3; 4],
            confidence: vec![0.9; 4],
            severity: severity.to_vec(),
            rolling_share: vec![0.0; 4],
            peak_force: vec![force; 4],
            ..WhirlReport::default()
        }
    }

    fn observe(log: &mut EpisodeLog, time: f64, whirl: &WhirlReport, shock: Severity) {
        log.push(&Observation {
            time,
            whirl,
            stick_slip: (Severity::Ok, 0.0),
            bit: place(25),
            shock: ShockLevel {
                severity: shock,
                impulse: 7.0,
                ..ShockLevel::default()
            },
            shock_place: place(7),
        });
    }

    #[test]
    fn neighbours_are_one_episode_and_a_shock_is_another() {
        use Severity::{Ok, Watch};
        let mut log = EpisodeLog::default();
        let calm = report([Ok; 4], WhirlKind::None, 0.0);
        observe(&mut log, 0.0, &calm, Ok);
        observe(
            &mut log,
            1.0,
            &report([Ok, Watch, Watch, Ok], WhirlKind::Forward, 100.0),
            Ok,
        );
        observe(
            &mut log,
            2.0,
            &report([Ok, Watch, Watch, Ok], WhirlKind::Forward, 300.0),
            Watch,
        );
        observe(&mut log, 3.5, &calm, Ok);
        observe(
            &mut log,
            5.0,
            &report([Watch, Ok, Watch, Ok], WhirlKind::Chaotic, 50.0),
            Ok,
        );
        let episodes = log.finish();
        assert_eq!(episodes.len(), 4, "{episodes:?}");
        let whirl = &episodes[0];
        assert_eq!((whirl.kind, whirl.stations), (EpisodeKind::ForwardWhirl, [10, 15]));
        assert_eq!((whirl.start, whirl.duration, whirl.lasting), (1.0, 2.5, false));
        assert_eq!(whirl.peak_force, 300.0);
        assert_eq!((episodes[1].kind, episodes[1].strength), (EpisodeKind::Shock, 7.0));
        // Not neighbours: station 10 lies between them.
        assert!(
            episodes[2..]
                .iter()
                .all(|i| i.kind == EpisodeKind::ChaoticWhirl && i.lasting)
        );
    }

    #[test]
    fn the_worst_moment_names_the_kind_and_a_reset_ends_what_stands() {
        use Severity::{Ok, Warning, Watch};
        let mut log = EpisodeLog::default();
        observe(
            &mut log,
            1.0,
            &report([Watch, Ok, Ok, Ok], WhirlKind::Forward, 100.0),
            Ok,
        );
        observe(
            &mut log,
            2.0,
            &report([Warning, Ok, Ok, Ok], WhirlKind::Backward, 900.0),
            Ok,
        );
        observe(
            &mut log,
            3.0,
            &report([Warning, Ok, Ok, Ok], WhirlKind::Forward, 10.0),
            Ok,
        );
        observe(&mut log, 0.5, &report([Ok; 4], WhirlKind::None, 0.0), Ok);
        let episodes = log.finish();
        assert_eq!(episodes.len(), 1);
        let only = &episodes[0];
        assert_eq!((only.kind, only.severity), (EpisodeKind::BackwardWhirl, Warning));
        assert_eq!((only.start, only.duration, only.lasting), (1.0, 2.0, false));
    }
}
