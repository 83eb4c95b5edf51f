//! The steady parts of a log.
//!
//! Torque and weight are those of the twin's steady state only where nothing changes: where a speed or a weight changes,
//! the string winds up, contacts reverse and sensors lag. A window is a time in which speed and weight stay within a band
//! about their means, in one state of motion; the time after each change is left out. Everything that is left out is
//! listed with its reason.

use std::fmt;

/// Samples on each side that a running median of speed and weight covers: seven seconds at 1 Hz, half of the settling.
const NEIGHBOURS: usize = 7;

/// What a rig measures besides speed and weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// Torque of the top drive (N m).
    SurfaceTorque,
    /// Load on the hook (N).
    HookLoad,
    /// Torque measured above the bit (N m).
    BitTorque,
    /// Weight measured above the bit (N).
    BitWeight,
    /// Rate at which the hole deepens (m/s).
    RateOfPenetration,
}

impl Channel {
    /// All channels.
    pub const ALL: [Self; Self::COUNT] = [
        Self::SurfaceTorque,
        Self::HookLoad,
        Self::BitTorque,
        Self::BitWeight,
        Self::RateOfPenetration,
    ];
    /// Their number.
    pub const COUNT: usize = 5;

    /// Name and SI unit.
    pub const fn name_and_unit(self) -> (&'static str, &'static str) {
        match self {
            Self::SurfaceTorque => ("surface torque", "N m"),
            Self::HookLoad => ("hook load", "N"),
            Self::BitTorque => ("torque at the bit", "N m"),
            Self::BitWeight => ("weight at the bit", "N"),
            Self::RateOfPenetration => ("rate of penetration", "m/s"),
        }
    }

    /// Whether it says something only while the bit drills.
    pub const fn is_of_the_bit(self) -> bool {
        matches!(self, Self::BitTorque | Self::BitWeight | Self::RateOfPenetration)
    }
}

/// An instant of a log. What was not measured is NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// s from the beginning of the log.
    pub time: f64,
    /// Row of the log, as an editor numbers it; of a bag, the number of the message.
    pub row: u64,
    /// Speed of the top drive (rad/s).
    pub rotary_speed: f64,
    /// Weight that the indicator shows (N).
    pub weight: f64,
    /// What was measured, in the order of [`Channel::ALL`].
    pub measured: [f64; Channel::COUNT],
}

/// State of motion of a window. It decides which contacts slide in which direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Activity {
    /// Rotating without weight: friction and tare alone.
    OffBottom,
    /// Rotating with weight.
    Drilling,
}

/// Bounds of what is steady.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowSettings {
    /// Shortest window (s).
    pub shortest: f64,
    /// Longest window (s); a longer steady time is several windows.
    pub longest: f64,
    /// Time after a change that is left out (s): the string's waves and the auto-driller settle in it.
    pub settle: f64,
    /// Longest time between two samples (s).
    pub gap: f64,
    /// Largest deviation of the speed from its mean (rad/s), and as a share of the mean; the larger one counts.
    pub speed_band: (f64, f64),
    /// Largest deviation of the weight from its mean (N), and as a share of the mean; the larger one counts.
    pub weight_band: (f64, f64),
    /// Weight below which the bit counts as off bottom (N).
    pub off_bottom: f64,
    /// Speed below which the drive counts as standing (rad/s).
    pub standing: f64,
    /// Largest difference of a channel between the halves of a window, as a share of the mean, once it is above three
    /// standard errors.
    pub trend: f64,
}

impl Default for WindowSettings {
    fn default() -> Self {
        Self {
            // Twenty turns at 40 r/min: means over the joints' ripple of two per turn.
            shortest: 30.0,
            longest: 120.0,
            settle: 15.0,
            gap: 3.0,
            // 2 r/min.
            speed_band: (0.21, 0.03),
            weight_band: (1.0e3, 0.15),
            off_bottom: 1.0e3,
            // 5 r/min.
            standing: 0.52,
            trend: 0.03,
        }
    }
}

/// Mean of a channel over a window with the standard deviation of that mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Mean.
    pub value: f64,
    /// Its standard deviation, from the scatter and the correlation of the samples.
    pub scatter: f64,
}

/// A steady part of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Begin and end (s from the beginning of the log).
    pub span: [f64; 2],
    /// First and last row.
    pub rows: [u64; 2],
    /// Samples.
    pub samples: usize,
    /// State of motion.
    pub motion: Activity,
    /// Mean speed (rad/s).
    pub rotary_speed: f64,
    /// Mean weight that the indicator shows (N).
    pub weight: f64,
    /// Means in the order of [`Channel::ALL`]; `None` where a channel is not measured, frozen or not steady.
    pub measured: [Option<Mean>; Channel::COUNT],
}

/// Why a part of a log is in no window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reason {
    /// Speed or weight is missing.
    Missing,
    /// Time does not advance, or a gap lies before the next sample.
    Gap,
    /// The drive does not turn: friction may point anywhere.
    Standing,
    /// The time after a change.
    Settling,
    /// Speed or weight leaves its band before the window is long enough.
    Unsteady,
    /// A channel of a window has one value throughout: the sensor does not move.
    Frozen(Channel),
    /// A channel of a window has a trend.
    Trend(Channel),
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("speed or weight is missing"),
            Self::Gap => f.write_str("a gap in time"),
            Self::Standing => f.write_str("the drive does not turn"),
            Self::Settling => f.write_str("settling after a change"),
            Self::Unsteady => f.write_str("speed or weight changes"),
            Self::Frozen(channel) => write!(f, "{} does not change at all", channel.name_and_unit().0),
            Self::Trend(channel) => write!(f, "{} has a trend", channel.name_and_unit().0),
        }
    }
}

/// A part of a log that is not used, or a channel of it.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// First and last row.
    pub rows: [u64; 2],
    /// Samples.
    pub samples: usize,
    /// Why.
    pub reason: Reason,
}

/// Windows and the rest of a log.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Windows {
    /// The steady parts in their order.
    pub steady: Vec<Window>,
    /// Parts that are in no window, in their order; every sample is in a window or here. Then channels of windows.
    pub left_out: Vec<LeftOut>,
}

impl Windows {
    /// Samples left out by reason, the most first.
    pub fn left_out_by_reason(&self) -> Vec<(Reason, usize)> {
        let mut sums = std::collections::BTreeMap::<Reason, usize>::new();
        for part in &self.left_out {
            *sums.entry(part.reason).or_default() += part.samples;
        }
        let mut all: Vec<_> = sums.into_iter().collect();
        all.sort_by_key(|(_, samples)| std::cmp::Reverse(*samples));
        all
    }

    /// The windows in a state of motion that have a channel.
    pub fn having(&self, motion: Activity, channel: Channel) -> impl Iterator<Item = (&Window, Mean)> {
        self.steady
            .iter()
            .filter(move |window| window.motion == motion)
            .filter_map(move |window| Some((window, window.measured[channel as usize]?)))
    }
}

/// The steady windows of a log, whose samples are in the order of the log.
///
/// Steadiness is judged by running medians of speed and weight: a weight that is derived from a hook load scatters by
/// several kN from second to second, and steps less than that are no change.
pub fn find(samples: &[Sample], settings: &WindowSettings) -> Windows {
    let smooth = smoothed(samples, settings);
    let judged = smooth.as_slice();
    let mut found = Windows::default();
    let mut begin = 0;
    // The begin of the log counts as a change.
    let mut changed = true;
    while begin < samples.len() {
        let first = &judged[begin];
        let motion = match motion(first, settings) {
            Ok(motion) => motion,
            Err(reason) => {
                found.leave_out(&samples[begin..=begin], reason);
                begin += 1;
                changed = true;
                continue;
            }
        };
        let end = steady_until(judged, begin, motion, settings);
        let mut part = &samples[begin..end];
        if changed {
            let settled = part.partition_point(|sample| sample.time - first.time < settings.settle);
            found.leave_out(&part[..settled], Reason::Settling);
            part = &part[settled..];
        }
        found.add_windows(part, motion, settings);
        // Whatever ended it is a change.
        changed = true;
        begin = end;
    }
    found
}

/// The samples with running medians of speed and weight over their neighbours. A sample without a speed or a weight stays
/// without.
fn smoothed(samples: &[Sample], settings: &WindowSettings) -> Vec<Sample> {
    let median = |index: usize, of: fn(&Sample) -> f64| {
        let around = &samples[index.saturating_sub(NEIGHBOURS)..(index + NEIGHBOURS + 1).min(samples.len())];
        let here = samples[index].time;
        let near = |sample: &&Sample| (sample.time - here).abs() <= settings.gap * NEIGHBOURS as f64;
        let mut values: Vec<f64> = around
            .iter()
            .filter(near)
            .map(of)
            .filter(|value| value.is_finite())
            .collect();
        let middle = values.len() / 2;
        match values.get(middle) {
            Some(_) if of(&samples[index]).is_finite() => *values.select_nth_unstable_by(middle, f64::total_cmp).1,
            _ => f64::NAN,
        }
    };
    (0..samples.len())
        .map(|index| Sample {
            rotary_speed: median(index, |sample| sample.rotary_speed),
            weight: median(index, |sample| sample.weight),
            ..samples[index]
        })
        .collect()
}

fn motion(sample: &Sample, settings: &WindowSettings) -> Result<Activity, Reason> {
    if !(sample.rotary_speed.is_finite() && sample.weight.is_finite() && sample.time.is_finite()) {
        Err(Reason::Missing)
    } else if sample.rotary_speed.abs() < settings.standing {
        Err(Reason::Standing)
    } else if sample.weight < settings.off_bottom {
        Ok(Activity::OffBottom)
    } else {
        Ok(Activity::Drilling)
    }
}

/// The end (exclusive) of the part from `begin` on in which the motion stays the same, time goes on, and speed and weight
/// stay within their bands about their means so far.
fn steady_until(samples: &[Sample], begin: usize, state: Activity, settings: &WindowSettings) -> usize {
    let (mut speed, mut weight) = (samples[begin].rotary_speed, samples[begin].weight);
    for next in begin + 1..samples.len() {
        let sample = &samples[next];
        let step = sample.time - samples[next - 1].time;
        let inside =
            |value: f64, mean: f64, (least, share): (f64, f64)| (value - mean).abs() <= least.max(share * mean.abs());
        let stays_steady = motion(sample, settings) == Ok(state)
            && step > 0.0
            && step <= settings.gap
            && inside(sample.rotary_speed, speed, settings.speed_band)
            && inside(sample.weight, weight, settings.weight_band);
        if !stays_steady {
            return next;
        }
        let count = (next - begin + 1) as f64;
        speed += (sample.rotary_speed - speed) / count;
        weight += (sample.weight - weight) / count;
    }
    samples.len()
}

impl Windows {
    fn leave_out(&mut self, part: &[Sample], reason: Reason) {
        let (Some(first), Some(last)) = (part.first(), part.last()) else {
            return;
        };
        match self.left_out.last_mut() {
            Some(before) if before.reason == reason && before.rows[1] + 1 == first.row => {
                before.rows[1] = last.row;
                before.samples += part.len();
            }
            _ => self.left_out.push(LeftOut {
                rows: [first.row, last.row],
                samples: part.len(),
                reason,
            }),
        }
    }

    /// Divides a steady part into windows of equal length.
    fn add_windows(&mut self, part: &[Sample], motion: Activity, settings: &WindowSettings) {
        let (Some(first), Some(last)) = (part.first(), part.last()) else {
            return;
        };
        let length = last.time - first.time;
        if length < settings.shortest {
            self.leave_out(part, Reason::Unsteady);
            return;
        }
        let count = (length / settings.longest).ceil().max(1.0) as usize;
        let each = part.len().div_ceil(count).max(1);
        for window in part.chunks(each) {
            self.add_window(window, motion, settings);
        }
    }

    fn add_window(&mut self, part: &[Sample], motion: Activity, settings: &WindowSettings) {
        let (Some(first), Some(last)) = (part.first(), part.last()) else {
            return;
        };
        let of = |of: fn(&Sample) -> f64| mean(&part.iter().map(of).collect::<Vec<_>>());
        let mut measured = [None; Channel::COUNT];
        for channel in Channel::ALL {
            // Off bottom nothing is drilled: a rate there is the block's, or a value that was held.
            if channel == Channel::RateOfPenetration && motion == Activity::OffBottom {
                continue;
            }
            let values: Vec<f64> = part
                .iter()
                .map(|sample| sample.measured[channel as usize])
                .filter(|value| value.is_finite())
                .collect();
            // A channel that is missing in half of the window is not measured in it.
            if 2 * values.len() <= part.len() || values.len() < 8 {
                continue;
            }
            match judge(&values, channel, settings) {
                Ok(mean) => measured[channel as usize] = Some(mean),
                Err(reason) => self.leave_out_channel(part, reason),
            }
        }
        self.steady.push(Window {
            span: [first.time, last.time],
            rows: [first.row, last.row],
            samples: part.len(),
            motion,
            rotary_speed: of(|sample| sample.rotary_speed),
            weight: of(|sample| sample.weight),
            measured,
        });
    }

    fn leave_out_channel(&mut self, part: &[Sample], reason: Reason) {
        if let (Some(first), Some(last)) = (part.first(), part.last()) {
            self.left_out.push(LeftOut {
                rows: [first.row, last.row],
                samples: part.len(),
                reason,
            });
        }
    }
}

/// The mean of a channel with its standard deviation, or why it is not used.
fn judge(values: &[f64], channel: Channel, settings: &WindowSettings) -> Result<Mean, Reason> {
    let mut longest = values.chunk_by(|a, b| a == b).map(<[f64]>::len);
    if longest.by_ref().max().unwrap_or(0) * 2 > values.len() {
        return Err(Reason::Frozen(channel));
    }
    let mean = mean(values);
    let scatter = scatter(values.iter().map(|value| value - mean));
    // The trend is judged against the scatter without it.
    let (first, second) = values.split_at(values.len() / 2);
    let halves = [first, second].map(self::mean);
    let without = first
        .iter()
        .map(|value| value - halves[0])
        .chain(second.iter().map(|value| value - halves[1]));
    let step = (halves[1] - halves[0]).abs();
    // Each half has about twice the variance of the whole, their difference four times.
    if step > settings.trend * mean.abs() && step > 3.0 * 2.0 * self::scatter(without) {
        return Err(Reason::Trend(channel));
    }
    Ok(Mean { value: mean, scatter })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard deviation of the mean of values from their deviations. Samples that follow each other closely count less, by
/// the correlation of neighbours.
fn scatter(deviations: impl Iterator<Item = f64>) -> f64 {
    let deviations: Vec<f64> = deviations.collect();
    let count = deviations.len() as f64;
    let square: f64 = deviations.iter().map(|d| d * d).sum();
    if square == 0.0 {
        return 0.0;
    }
    let lagged: f64 = deviations.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let correlation = (lagged / square).clamp(0.0, 0.95);
    let effective = (count * (1.0 - correlation) / (1.0 + correlation)).max(2.0);
    (square / (count - 1.0) / effective).sqrt()
}

#[cfg(test)]
mod tests;
