//! The next minute at the present speed and weight, second by second, with bands that are held against what came.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};

use super::answer::{AlarmChance, alarm_chances, any_alarm, sentence};
use super::chance::{Band, Chance};
use super::engine::{disturbed, on_threads};
use super::member::{Ended, Horizon, Member, Watched};
use super::start::Start;
use super::trace::{SIGNALS, Signal};

/// Length of a forecast (s).
pub const HORIZON: u64 = 60;
/// A band at a second is taken over the members and over the seconds up to this many away: a few members alone have no
/// quantiles, and a motion that lasts has those of its neighbours.
const NEIGHBOURS: u64 = 3;
/// How far ahead a second may be (s) to be calibrated with others: what the members say of the next seconds is worth more
/// than what they say of the end of the minute.
pub const LEADS: [u64; 3] = [10, 30, HORIZON];
/// Forecasts whose compared seconds the width of the bands follows: a programme of speed and weight lasts some minutes, and
/// the width is to follow within it.
const REMEMBERED: u64 = 20;
/// Forecasts that must have been compared before the width leaves 1. Seconds of one forecast are close to each other, and of
/// fewer than nine values none is one that nine of ten lie below.
const LEAST: usize = 9;
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
    /// Plausible tools that all members are runs of; 0 where they are runs of the twin.
    pub tools: u32,
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
    let time = start.time();
    let first = time.max(0.0) as u64 + 1;
    // The last whole second has to end.
    let horizon = (first + HORIZON) as f64 - time;
    let numbers: Vec<u32> = (0..members).collect();
    let results: Vec<Result<Member, Ended>> = on_threads(&numbers, threads, |member| {
        start.with_tool(*member, stop, |start| {
            let run = disturbed(start.state(), seed, 0, *member);
            let watched = Watched::new(run, start.config(), stop).wavering(start.wavering(seed, 0, *member));
            watched.traced(time).judge(Horizon::Of(horizon), |_| false)
        })
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
        tools: start.tools(0..members),
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

/// The lead that a second of a forecast has, the first being 0, as a place in [`LEADS`].
pub fn lead(second: u64) -> usize {
    LEADS
        .iter()
        .position(|until| second < *until)
        .unwrap_or(LEADS.len() - 1)
}

/// Least half of a published band below and above its median, by [`Signal::ALL`]: by how much plausible tools differ. 0 where
/// that is not known.
pub type Least = [[f64; 2]; SIGNALS];

/// Factors on the members' bands, by [`Signal::ALL`] and [`LEADS`].
pub type Widths = [[f64; LEADS.len()]; SIGNALS];

/// How what came compares with the bands, and how wide these have to be to hold nine seconds of ten (split conformal
/// prediction over the newest seconds; Vovk, Gammerman and Shafer, Algorithmic Learning in a Random World, 2005), by how
/// far ahead they were.
#[derive(Debug, Clone, Default)]
pub struct Calibration {
    signals: [[Compared; LEADS.len()]; SIGNALS],
}

/// The comparison of one signal at one lead.
#[derive(Debug, Clone, Default)]
pub struct Compared {
    /// Seconds compared.
    pub compared: u32,
    /// In the published band.
    pub inside: u32,
    /// In the members' band.
    pub inside_members: u32,
    /// Of the newest seconds, the first second of their forecast and the factor on the members' band that would just have
    /// held the value.
    needed: VecDeque<(u64, f64)>,
}

impl Compared {
    /// Whether enough forecasts were compared for the width to be one that came of them.
    pub fn is_calibrated(&self) -> bool {
        let mut forecasts: Vec<u64> = self.needed.iter().map(|(forecast, _)| *forecast).collect();
        forecasts.sort_unstable();
        forecasts.dedup();
        forecasts.len() >= LEAST
    }

    /// The factor on the members' band; 1 before it is calibrated.
    pub fn width(&self) -> f64 {
        if !self.is_calibrated() {
            return 1.0;
        }
        let mut sorted: Vec<f64> = self.needed.iter().map(|(_, needed)| *needed).collect();
        sorted.sort_by(f64::total_cmp);
        // The quantile that holds for one more value.
        let rank = (COVERAGE * (sorted.len() + 1) as f64).ceil() as usize;
        sorted[rank.clamp(1, sorted.len()) - 1]
    }
}

impl Calibration {
    /// The comparison of a signal so far, by [`LEADS`].
    pub fn of(&self, signal: Signal) -> &[Compared; LEADS.len()] {
        &self.signals[signal as usize]
    }

    /// The factors that bands of now have.
    pub fn widths(&self) -> Widths {
        Signal::ALL.map(|signal| self.of(signal).each_ref().map(Compared::width))
    }

    /// Compares what came in a second with the members' bands, which were published as `widening` says. `second` counts
    /// from the first second of the forecast, whose number is `forecast`. Signals without a number on either side are not
    /// compared.
    pub fn compare(&mut self, forecast: u64, second: u64, bands: &Bands, widening: &Widening, came: &[f64; SIGNALS]) {
        let lead = lead(second);
        let seconds = LEADS[lead] - lead.checked_sub(1).map_or(0, |before| LEADS[before]);
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
            let [low_published, _, high_published] = widening.band(signal, second, band);
            let of = &mut self.signals[signal as usize][lead];
            of.compared += 1;
            of.inside += u32::from((low_published..=high_published).contains(&value));
            of.inside_members += u32::from((low..=high).contains(&value));
            of.needed.push_back((forecast, needed));
            if of.needed.len() as u64 > REMEMBERED * seconds {
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

/// How the members' bands become those that are published.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Widening {
    /// Factors on the members' bands, by what came of earlier forecasts.
    pub factors: Widths,
    /// What a band is never narrower than. What came is what the twin did: what plausible tools differ by is not in it.
    pub least: Least,
}

impl Widening {
    /// The published band of a second, which counts from the first of the forecast.
    pub fn band(&self, signal: Signal, second: u64, band: &Band) -> [f64; 3] {
        let factor = self.factors[signal as usize][lead(second)];
        let median = band.quantiles[1];
        let ([below, above], [least_below, least_above]) = (halves(signal, band), self.least[signal as usize]);
        let low = median - (factor * below).max(least_below);
        let low = if signal.is_force() { low.max(0.0) } else { low };
        [low, median, median + (factor * above).max(least_above)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(low: f64, median: f64, high: f64) -> Bands {
        [Band {
            quantiles: [low, median, high],
        }; SIGNALS]
    }

    /// Plausible tools that do not differ.
    const ALIKE: Least = [[0.0; 2]; SIGNALS];

    fn widening(calibration: &Calibration, least: Least) -> Widening {
        Widening {
            factors: calibration.widths(),
            least,
        }
    }

    #[test]
    fn a_band_that_is_too_narrow_is_widened_until_it_holds_nine_of_ten() {
        let mut calibration = Calibration::default();
        let mut random = fastrand::Rng::with_seed(1);
        // The members say 450 to 550; what comes is uniform in 0..1000.
        let bands = band(450.0, 500.0, 550.0);
        for forecast in 0..120 {
            let as_now = widening(&calibration, ALIKE);
            for second in 30..60 {
                calibration.compare(forecast, second, &bands, &as_now, &[1000.0 * random.f64(); SIGNALS]);
            }
        }
        let of = &calibration.of(Signal::BitTorque)[2];
        assert_eq!(of.compared, 3600);
        let share = f64::from(of.inside) / f64::from(of.compared);
        // 270 seconds were held against the members' own band, a tenth of which it holds: 0.84 in the mean. The standard
        // deviation of the rest is 0.6 %.
        assert!((0.82..0.86).contains(&share), "{share}");
        let members = f64::from(of.inside_members) / 3600.0;
        assert!((members - 0.1).abs() < 0.02, "{members}");
        // 0.9 of the range around the middle is 9 times the band; of 600 values the quantile has a deviation of 0.12.
        assert!((of.width() - 9.0).abs() < 0.4, "{}", of.width());
        let [low, _, high] = widening(&calibration, ALIKE).band(Signal::BitTorque, 59, &bands[0]);
        assert!(low < 60.0 && high > 940.0);
    }

    /// What comes spreads by 10 in the next ten seconds, by 40 until half a minute, by 90 then; the members say 10 all the
    /// time. Each lead has nine of ten inside, with a width that is its own.
    #[test]
    fn each_lead_is_calibrated_by_what_came_at_that_lead() {
        let mut calibration = Calibration::default();
        let mut random = fastrand::Rng::with_seed(2);
        let bands = band(490.0, 500.0, 510.0);
        let spreads = [10.0, 40.0, 90.0];
        let mut later = [[0_u32; 2]; 3];
        for forecast in 0..200 {
            let as_now = widening(&calibration, ALIKE);
            for second in 0..HORIZON {
                let lead = lead(second);
                let value = 500.0 + spreads[lead] * (2.0 * random.f64() - 1.0);
                let before = calibration.of(Signal::BitSpeed)[lead].inside;
                calibration.compare(forecast, second, &bands, &as_now, &[value; SIGNALS]);
                if forecast >= LEAST as u64 {
                    later[lead][0] += calibration.of(Signal::BitSpeed)[lead].inside - before;
                    later[lead][1] += 1;
                }
            }
        }
        for (lead, spread) in spreads.iter().enumerate() {
            let of = &calibration.of(Signal::BitSpeed)[lead];
            // 0.9 of the spread; the quantile of 200 values of it has a deviation of 2 %.
            assert!(
                (of.width() - 0.09 * spread).abs() < 0.007 * spread,
                "{lead}: {}",
                of.width()
            );
            let share = f64::from(later[lead][0]) / f64::from(later[lead][1]);
            // 1910 seconds at the first lead: 0.7 %, and 1 % of the widths of some tens of forecasts.
            assert!((share - 0.9).abs() < 0.035, "{lead}: {share}");
        }
    }

    #[test]
    fn eight_forecasts_calibrate_nothing_however_many_seconds_they_have() {
        let mut calibration = Calibration::default();
        let bands = band(450.0, 500.0, 550.0);
        for forecast in 0..9 {
            let of = &calibration.of(Signal::BitTorque)[1];
            assert!(!of.is_calibrated() && of.width() == 1.0, "{forecast}");
            for second in 10..30 {
                let as_now = widening(&calibration, ALIKE);
                calibration.compare(forecast, second, &bands, &as_now, &[700.0; SIGNALS]);
            }
        }
        // What came needed four times the band.
        assert_eq!(calibration.of(Signal::BitTorque)[1].width(), 4.0);
        // Nothing came at the other leads.
        assert!(!calibration.of(Signal::BitTorque)[0].is_calibrated());
        assert_eq!(
            [lead(0), lead(9), lead(10), lead(29), lead(30), lead(59)],
            [0, 0, 1, 1, 2, 2]
        );
    }

    /// The members are runs of one tool and say 490 to 510. Plausible tools differ by 60 below and 30 above.
    #[test]
    fn a_band_is_never_narrower_than_plausible_tools_differ() {
        let mut calibration = Calibration::default();
        let bands = band(490.0, 500.0, 510.0);
        let mut least = ALIKE;
        least[Signal::BitTorque as usize] = [60.0, 30.0];
        let torque = |calibration: &Calibration| widening(calibration, least).band(Signal::BitTorque, 5, &bands[0]);
        assert_eq!(torque(&calibration), [440.0, 500.0, 530.0]);
        let speed = widening(&calibration, least).band(Signal::BitSpeed, 5, &bands[0]);
        assert_eq!(speed, [490.0, 500.0, 510.0]);
        // What comes is inside the published band, outside that of the members, and the factor is that on the members'.
        for forecast in 0..20 {
            let as_now = widening(&calibration, least);
            calibration.compare(forecast, 5, &bands, &as_now, &[460.0; SIGNALS]);
        }
        let of = &calibration.of(Signal::BitTorque)[0];
        assert_eq!([of.compared, of.inside, of.inside_members], [20, 20, 0]);
        assert_eq!(of.width(), 4.0);
        // Of the speed the first nine were outside.
        assert_eq!(calibration.of(Signal::BitSpeed)[0].inside, 11);
        // A factor that asks for more than the tools differ by is taken.
        assert_eq!(torque(&calibration), [440.0, 500.0, 540.0]);
    }

    #[test]
    fn unknown_seconds_are_not_compared() {
        let mut calibration = Calibration::default();
        let unknown = band(f64::NAN, f64::NAN, f64::NAN);
        let as_now = widening(&calibration, ALIKE);
        calibration.compare(1, 0, &unknown, &as_now, &[1.0; SIGNALS]);
        calibration.compare(1, 0, &band(0.0, 1.0, 2.0), &as_now, &[f64::NAN; SIGNALS]);
        assert_eq!(calibration.of(Signal::BitSpeed)[0].compared, 0);
        assert_eq!(calibration.of(Signal::BitSpeed)[0].width(), 1.0);
    }
}
