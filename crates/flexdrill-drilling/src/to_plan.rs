//! The next metres against the plan of a configuration: how far the hole is from it, whether it leaves it, and the weight that
//! brings it back.
//!
//! The hole leaves its plan where the plan is outside the range of the plausible tools. Only the weight is varied: with the
//! bit's axis held by the guide, the rotary speed acts on the hole through the weight that arrives alone.

use std::sync::atomic::{AtomicBool, Ordering};

use flexdrill_config::{Config, WellPlan};
use flexdrill_core::units::{deg_to_rad, kn_to_n, n_to_kn};

use super::plan::{Row, covers, heading, in_plane_at};
use super::range::{Excluded, Range};
use super::weights::{Tried, allowed, best};
use super::{Band, Drilling, NEXT_METRE, Plan, SPACING, STEEP, Spread, Station, Track, curvature, drill, turned};

/// Distance of a plan from the middle of the range, in half widths of it, up to which the hole is back on its plan: a tenth of
/// the range is to spare.
pub const BACK: f64 = 0.9;
/// Weights that are tried over the whole range: the search is part of an answer that takes a second.
const COARSE: usize = 8;
/// Least half width of a range of inclinations: 0.5 deg. No survey knows a hole better.
const LEAST_ANGLE: f64 = 0.5;
/// Least half width of a range of positions (m).
const LEAST_WIDTH: f64 = 0.05;

/// The tool as configured against the plan at a station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct At {
    /// Distance of the bit from the plan, towards the high side (m).
    pub high: f64,
    /// The same to the right (m).
    pub right: f64,
    /// Inclination less that of the plan at the same measured depth (rad).
    pub inclination: f64,
    /// Azimuth less that of the plan (rad); NaN near the vertical.
    pub azimuth: f64,
    /// Share of the plausible tools that stay within the target from the bit up to here.
    pub within: f64,
}

/// The weight under which the hole is nearest to the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The weight (N).
    pub weight: f64,
    /// [`ToPlan::off`] under it.
    pub off: f64,
    /// Curvature of the next metre (1/m).
    pub curvature: f64,
}

/// The next metres against a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct ToPlan {
    /// Radius around the plan within which the bit is on plan (m).
    pub target: f64,
    /// Build rate of the plan over the next metre (rad/m).
    pub build: f64,
    /// By stations, up to the end of the plan.
    pub stations: Vec<At>,
    /// How far the plan is from the middle of the range of the plausible tools, in half widths of it: the largest of the
    /// inclination and, outside the target, of the position, from a metre ahead on. Above 1 the hole leaves its plan.
    pub off: f64,
    /// The weights that were searched (kN); none where the hole is on its plan or the guide cannot drill it.
    pub tried: Option<Tried>,
    /// The best of them; none where none has a known result.
    pub nearest: Option<Nearest>,
    /// Whether no bit and no rock makes the guide drill the plan, at the largest weight or below it.
    pub no_guide: bool,
}

impl ToPlan {
    /// The weight that brings the hole back (N).
    pub fn weight(&self) -> Option<f64> {
        self.nearest
            .filter(|nearest| nearest.off <= BACK)
            .map(|nearest| nearest.weight)
    }

    /// Whether no allowed weight brings it back.
    pub fn no_weight(&self) -> bool {
        self.off > BACK && self.weight().is_none()
    }
}

/// What a plan is compared with.
struct Cone<'a> {
    plan: &'a Plan,
    rows: &'a [Row],
    /// Measured depth of the bit (m).
    bit: f64,
    target: f64,
    nominal: &'a [Station],
    spread: &'a [Spread],
    /// The last station that is compared.
    last: usize,
}

/// How far a value is from the middle of a range that is moved by `moved`, in half widths.
fn beyond(value: f64, range: &Band, moved: f64, least: f64) -> f64 {
    let middle = f64::midpoint(range.low, range.high) + moved;
    (value - middle).abs() / range.half().max(least)
}

impl Cone<'_> {
    /// Inclination and azimuth of the plan at a station (rad).
    fn heading(&self, station: usize) -> [f64; 2] {
        heading(self.rows, self.bit + station as f64 * SPACING)
    }

    /// [`ToPlan::off`] of a track. The range is that of the plausible tools, about this track.
    fn off(&self, track: &[Station]) -> f64 {
        let at_station = |station: usize| {
            let (at, nominal, spread) = (&track[station], &self.nominal[station], &self.spread[station]);
            let moved = at.inclination - nominal.inclination;
            let [planned, _] = self.heading(station);
            let inclination = beyond(planned, &spread.inclination, moved, deg_to_rad(LEAST_ANGLE));
            let distance = self.plan.distance(at);
            // Within the target the bit is on plan, however narrow the range is.
            if distance.whole <= self.target {
                return inclination;
            }
            // The plan is where the bit would be less its distance.
            let high = beyond(-distance.high, &spread.high, 0.0, LEAST_WIDTH);
            let right = beyond(-distance.right, &spread.right, 0.0, LEAST_WIDTH);
            inclination.max(high).max(right)
        };
        (NEXT_METRE..=self.last).map(at_station).fold(0.0, f64::max)
    }

    /// The tool as configured at each station.
    fn stations(&self, members: &[&Track]) -> Vec<At> {
        // The first station after the bit at which a tool leaves the target.
        let leaves = |track: &&Track| {
            let mut stations = (1..=self.last).zip(track.iter().skip(1));
            let left = stations.find(|(_, at)| self.plan.distance(at).whole > self.target);
            left.map_or(usize::MAX, |(station, _)| station)
        };
        let leaves: Vec<usize> = members.iter().map(leaves).collect();
        let of = |(station, at): (usize, &Station)| {
            let distance = self.plan.distance(at);
            let [inclination, azimuth] = self.heading(station);
            let steep = [inclination, at.inclination]
                .map(libm::sin)
                .into_iter()
                .any(|sine| sine < STEEP);
            let stay = leaves.iter().filter(|left| **left > station).count();
            At {
                high: distance.high,
                right: distance.right,
                inclination: at.inclination - inclination,
                azimuth: if steep { f64::NAN } else { turned(at.azimuth - azimuth) },
                within: stay as f64 / members.len() as f64,
            }
        };
        self.nominal.iter().enumerate().take(self.last + 1).map(of).collect()
    }
}

/// Where the tool as configured and the plausible ones drill.
pub struct Ranges<'a> {
    /// The stations of the tool as configured.
    pub nominal: &'a [Station],
    /// Those of the plausible tools, or why one has none.
    pub members: &'a [Result<Track, String>],
    /// Where they are at each station.
    pub spread: &'a [Spread],
    /// What surveys correct in the track of the tool as configured under another weight: taken to be the same.
    pub corrected: &'a dyn Fn(Track) -> Track,
}

/// The stations of a plan, turned so that it lies in the plane of the hole at a bit at this depth (m).
fn rows(planned: &WellPlan, bit: f64) -> Result<Vec<Row>, String> {
    // Programs that run a configuration put the stations in the place of the table. No file is opened here: its folder is not
    // part of a configuration.
    if planned.file.is_some() {
        return Err("well.plan.file was not read: give the stations near the bit as well.plan.stations".to_owned());
    }
    let rows: Vec<Row> = planned.stations.iter().map(Row::from).collect();
    covers("well.plan.stations", &rows, bit).map_err(|error| error.to_string())?;
    Ok(in_plane_at(&rows, bit))
}

/// Compares the next metres with the stations of the plan of a configuration; none without a plan. Where the hole leaves it,
/// weights about a `present` one (N) are searched for the one that brings it back.
///
/// # Errors
/// Why they cannot be compared, in words.
pub fn compare(
    config: &Config,
    drilling: &Drilling,
    &Ranges {
        nominal,
        members,
        spread,
        corrected,
    }: &Ranges<'_>,
    present: Option<f64>,
    stop: &AtomicBool,
) -> Option<Result<ToPlan, String>> {
    let planned = config.well.plan.as_ref()?;
    let bit = config.well.length();
    let rows = match rows(planned, bit) {
        Ok(rows) => rows,
        Err(why) => return Some(Err(why)),
    };
    // A range needs a number of tools; without one nothing here is known either.
    let ahead = nominal.len().min(spread.len()).checked_sub(1)?;
    let plan = Plan::laid(&rows, planned.offset, drilling, bit, ahead as f64 * SPACING);
    let cone = Cone {
        last: ((plan.ahead() / SPACING + 1e-9).floor() as usize).min(ahead),
        plan: &plan,
        rows: &rows,
        bit,
        target: planned.target,
        nominal,
        spread,
    };
    let known: Vec<&Track> = members.iter().flatten().collect();
    let [first, next] = [0, NEXT_METRE].map(|station| cone.heading(station)[0]);
    let off = cone.off(nominal);
    // The bounds hold for any bit, so that they are asked before the weights, which are many runs.
    let excluded = Range::of(config).map(|range| range.excluded(config, Some(&rows)));
    let no_guide = excluded.is_some_and(|excluded| excluded.iter().any(|of| matches!(of, Excluded::Plan { .. })));
    // A hole on its plan needs no other weight, and a guide that cannot drill it has none.
    let tried = present
        .filter(|_| off > BACK && !no_guide)
        .map(|weight| allowed(config, n_to_kn(weight)));
    let nearest = tried.and_then(|tried| {
        // The tool as configured decides; its range is taken over from the present weight, which saves the other tools.
        let under = |kilonewton: f64| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let drilling = Drilling::of(config, kn_to_n(kilonewton), 0.0).ok()?;
            let track = corrected(drill(&drilling, cone.last).ok()?);
            Some((cone.off(&track), curvature(&track)))
        };
        best(tried, COARSE, under, |(off, _)| *off)
    });
    Some(Ok(ToPlan {
        target: planned.target,
        build: (next - first) / (NEXT_METRE as f64 * SPACING),
        stations: cone.stations(&known),
        off,
        tried,
        nearest: nearest.map(|(weight, (off, curvature))| Nearest {
            weight: kn_to_n(weight),
            off,
            curvature,
        }),
        no_guide,
    }))
}
