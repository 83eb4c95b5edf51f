//! The next minute at the present speed and weight, second by second, with bands that are held against what came.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};

use super::chance::{Band, Chance};
use super::engine::{AlarmChance, Start, alarm_chances, any_alarm, disturbed, on_threads, sentence};
use super::member::{Ended, Horizon, Member, Watched};
use super::trace::{SIGNALS, Signal};

/// Length of a forecast (s).
pub const HORIZON: u64 = 60;
/// A band at a second is taken over the members and over the seconds up to this many away: a few members alone have no
/// quantiles, and a motion that lasts has those of its neighbours.
const NEIGHBOURS: u64 = 3;
/// Compared seconds that the width of the bands follows: a programme of speed and weight lasts some minutes, and the width
/// is to follow within it.
const REMEMBERED: usize = 1200;
/// Compared seconds before the width leaves 1.
const LEAST: usize = 60;
/// Share of the seconds that a band is to hold.
const COVERAGE: f64 = 0.9;
/// Narrowest half of a band, as a part of the median: the members of a motion without collisions are equal to the last
/// digit, and a rig's speed and weight are not steady to a thousandth.
const LEAST_HALF: f64 = 1e-3;

/// The bands of a second, by [`Signal::ALL`].
pub type Bands = [Band; SIGNALS];

/// What the members say of the next minute.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// Number of the first second of `seconds`: the first whole one after the start.
    pub first: u64,
    /// The members' bands, by second.
    pub seconds: Vec<Bands>,
    /// Members that ended.
    pub members: u32,
    /// Members that failed: what would have come is unknown.
    pub failed: u32,
    /// Why the first of these failed; empty where none did.
    pub failure: String,
    /// Alarms that a member saw.
    pub alarms: Vec<AlarmChance>,
    /// Chance that a member saw any.
    pub any_alarm: Chance,
}

/// The next minute from `start` under what is asked for there; `None` once `stop` is set. The same start and seed give the
/// same forecast, with any number of threads.
pub fn forecast(start: &Start, members: u32, seed: u64, threads: usize, stop: &AtomicBool) -> Option<Forecast> {
    let run = start.run();
    let time = run.ticks() as f64 * start.config().solver.time_step;
    let first = time.max(0.0) as u64 + 1;
    // The last whole second has to end.
    let horizon = (first + HORIZON) as f64 - time;
    let numbers: Vec<u32> = (0..members).collect();
    let results: Vec<Result<Member, Ended>> = on_threads(&numbers, threads, |member| {
        let watched = Watched::new(disturbed(&run, seed, 0, *member), start.config(), stop);
        let watched = watched.wavering(start.wavering(seed, 0, *member));
        watched.traced().judge(Horizon::Of(horizon), |_| false)
    });
    if stop.load(Ordering::Relaxed) {
        return None;
    }
    let ended: Vec<&Member> = results.iter().filter_map(|result| result.as_ref().ok()).collect();
    let failures = results.iter().filter_map(|result| result.as_ref().err());
    let failure = failures.clone().next().map_or(String::new(), sentence);
    Some(Forecast {
        first,
        seconds: (first..first + HORIZON)
            .map(|second| bands(&ended, second, first))
            .collect(),
        members: ended.len() as u32,
        failed: failures.count() as u32,
        failure,
        alarms: alarm_chances(&ended),
        any_alarm: any_alarm(&ended),
    })
}

/// The members' bands of a second; `first` is the first whole one.
fn bands(members: &[&Member], second: u64, first: u64) -> Bands {
    let near = second.saturating_sub(NEIGHBOURS).max(first)..=(second + NEIGHBOURS).min(first + HORIZON - 1);
    let seconds = members.iter().flat_map(|member| member.trace.seconds());
    let values: Vec<[f64; SIGNALS]> = seconds
        .filter(|of| near.contains(&of.number))
        .map(|of| of.values())
        .collect();
    Signal::ALL.map(|signal| Band::of(values.iter().map(|values| values[signal as usize])))
}

/// How what came compares with the bands, and how wide these have to be to hold nine seconds of ten (split conformal
/// prediction over the newest seconds; Vovk, Gammerman and Shafer, Algorithmic Learning in a Random World, 2005).
#[derive(Debug, Clone, Default)]
pub struct Calibration {
    signals: [Compared; SIGNALS],
}

/// The comparison of one signal.
#[derive(Debug, Clone, Default)]
pub struct Compared {
    /// Seconds compared.
    pub compared: u32,
    /// In the published band.
    pub inside: u32,
    /// In the members' band.
    pub inside_members: u32,
    /// Of the newest seconds, the factor on the members' band that would just have held the value.
    needed: VecDeque<f64>,
}

impl Compared {
    /// The factor on the members' band.
    pub fn width(&self) -> f64 {
        if self.needed.len() < LEAST {
            return 1.0;
        }
        let mut sorted: Vec<f64> = self.needed.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        // The quantile that holds for one more value.
        let rank = (COVERAGE * (sorted.len() + 1) as f64).ceil() as usize;
        sorted[rank.clamp(1, sorted.len()) - 1]
    }
}

impl Calibration {
    /// The comparison of a signal so far.
    pub fn of(&self, signal: Signal) -> &Compared {
        &self.signals[signal as usize]
    }

    /// The factors that bands of now have, by [`Signal::ALL`].
    pub fn widths(&self) -> [f64; SIGNALS] {
        Signal::ALL.map(|signal| self.of(signal).width())
    }

    /// Compares what came in a second with the members' bands, which were published with `widths`. Signals without a number
    /// on either side are not compared.
    pub fn compare(&mut self, bands: &Bands, widths: &[f64; SIGNALS], came: &[f64; SIGNALS]) {
        for signal in Signal::ALL {
            let (band, value) = (&bands[signal as usize], came[signal as usize]);
            let [low, median, high] = band.quantiles;
            if !(value.is_finite() && median.is_finite()) {
                continue;
            }
            let [below, above] = halves(signal, band);
            let needed = if value < median {
                (median - value) / below
            } else {
                (value - median) / above
            };
            let of = &mut self.signals[signal as usize];
            of.compared += 1;
            of.inside += u32::from(needed <= widths[signal as usize]);
            of.inside_members += u32::from((low..=high).contains(&value));
            of.needed.push_back(needed);
            if of.needed.len() > REMEMBERED {
                of.needed.pop_front();
            }
        }
    }
}

/// The members' band below and above its median.
fn halves(signal: Signal, band: &Band) -> [f64; 2] {
    let [low, median, high] = band.quantiles;
    let least = (LEAST_HALF * median.abs()).max(signal.resolution());
    [(median - low).max(least), (high - median).max(least)]
}

/// The band that is published: the members' with a factor.
pub fn widened(signal: Signal, band: &Band, width: f64) -> [f64; 3] {
    let [below, above] = halves(signal, band);
    let median = band.quantiles[1];
    let low = median - width * below;
    let low = if signal.is_force() { low.max(0.0) } else { low };
    [low, median, median + width * above]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(low: f64, median: f64, high: f64) -> Bands {
        [Band {
            quantiles: [low, median, high],
        }; SIGNALS]
    }

    #[test]
    fn a_band_that_is_too_narrow_is_widened_until_it_holds_nine_of_ten() {
        let mut calibration = Calibration::default();
        let mut random = fastrand::Rng::with_seed(1);
        // The members say 450 to 550; what comes is uniform in 0..1000.
        let bands = band(450.0, 500.0, 550.0);
        for _ in 0..120 {
            let widths = calibration.widths();
            for _ in 0..30 {
                calibration.compare(&bands, &widths, &[1000.0 * random.f64(); SIGNALS]);
            }
        }
        let of = calibration.of(Signal::BitTorque);
        assert_eq!(of.compared, 3600);
        let share = f64::from(of.inside) / f64::from(of.compared);
        // 30 seconds were held against the members' own band. The standard deviation of the rest is 0.5 %.
        assert!((0.87..0.92).contains(&share), "{share}");
        let members = f64::from(of.inside_members) / 3600.0;
        assert!((members - 0.1).abs() < 0.02, "{members}");
        // 0.9 of the range around the middle is 9 times the band.
        assert!((of.width() - 9.0).abs() < 0.4, "{}", of.width());
        let [low, _, high] = widened(Signal::BitTorque, &bands[0], of.width());
        assert!(low < 60.0 && high > 940.0);
    }

    #[test]
    fn unknown_seconds_are_not_compared() {
        let mut calibration = Calibration::default();
        let unknown = band(f64::NAN, f64::NAN, f64::NAN);
        calibration.compare(&unknown, &[1.0; SIGNALS], &[1.0; SIGNALS]);
        calibration.compare(&band(0.0, 1.0, 2.0), &[1.0; SIGNALS], &[f64::NAN; SIGNALS]);
        assert_eq!(calibration.of(Signal::BitSpeed).compared, 0);
        assert_eq!(calibration.of(Signal::BitSpeed).width(), 1.0);
    }
}
