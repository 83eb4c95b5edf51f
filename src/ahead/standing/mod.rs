//! The standing forecast, between who looks ahead and who knows what came, which a node has on different threads.
//!
//! Time is that of a clock of the host (s), where it is not said to be of the run.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use super::answer::AlarmChance;
use super::forecast::{Compared, Forecast, HORIZON, LEADS, Least, Widening};
use super::held::Held;
use super::trace::{SIGNALS, Signal};
use flexdrill_config::Config;
use flexdrill_core::twin::{Frame, Output, RunInputs};
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::diagnostic_msgs::DiagnosticStatus;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::{self as messages, ForecastBand};

/// A forecast with the state that it begins from.
#[derive(Debug, Clone)]
pub struct Issued {
    /// Ticks of the state.
    pub ticks: u64,
    /// Model step of the state.
    pub step: u64,
    /// Speed (rad/s) and weight (N) that are asked for.
    pub targets: [f64; 2],
    /// What the members say, or why there are none.
    pub forecast: Result<Forecast, String>,
}

/// From the beginning of a forecast to that of the next (s).
pub const FORECAST_INTERVAL: f64 = 30.0;
/// Fixed, so that the same state gives the same forecast.
pub const FORECAST_SEED: u64 = 1;
/// A forecast is late after so long without one (s).
const LATE: f64 = 3.0 * FORECAST_INTERVAL;
/// Time over which what is asked for is compared with what a forecast assumes (s): some samples of a rig, whose weight wavers.
const WAVERS: f64 = 5.0;

/// What the look-ahead does while no forecast comes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Busy {
    /// The node starts.
    #[default]
    Starting,
    /// Model time stands still.
    StandsStill,
    /// Speed or weight is being changed.
    Changing,
    /// It answers goals of `~/what_if`.
    Goals,
    /// It searches for advice on an alarm.
    Advice,
    /// It makes the forecast.
    Forecast,
}

impl Busy {
    fn words(self) -> &'static str {
        match self {
            Self::Starting => "the node has just started",
            Self::StandsStill => "model time stands still",
            Self::Changing => "speed or weight is being changed",
            Self::Goals => "the look-ahead answers goals of ~/what_if; cancel those that are not needed",
            Self::Advice => "the look-ahead searches for advice on an alarm",
            Self::Forecast => "the computer is busy with other work, or searches for advice interrupt the forecast",
        }
    }
}

/// The newest forecast, until the publisher takes it, and what the look-ahead does meanwhile.
#[derive(Debug, Default)]
pub struct Forecasts {
    newest: Mutex<Option<Issued>>,
    busy: Mutex<Busy>,
}

impl Forecasts {
    /// Leaves a forecast for the publisher.
    pub fn put(&self, issued: Issued) {
        *self.newest.lock().unwrap_or_else(PoisonError::into_inner) = Some(issued);
    }

    /// Says what the look-ahead does now.
    pub fn note(&self, busy: Busy) {
        *self.busy.lock().unwrap_or_else(PoisonError::into_inner) = busy;
    }

    fn take(&self) -> Option<Issued> {
        self.newest.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn why_none(&self, since: f64) -> String {
        let busy = *self.busy.lock().unwrap_or_else(PoisonError::into_inner);
        format!("no forecast for {} s: {}", since as u64, busy.words())
    }
}

/// What came and the forecasts that it is compared with.
pub struct ForecastDesk {
    forecasts: Arc<Forecasts>,
    time_step: f64,
    held: Held,
    /// When the newest forecast came, and when its absence was last reported.
    came: f64,
    missed: f64,
    /// Ticks and step of the newest frame.
    newest: [u64; 2],
    /// Speeds (rad/s) and weights (N) that were asked for within the last [`WAVERS`], the newest last, each with its time (s of
    /// the run).
    asked: VecDeque<(f64, [f64; 2])>,
    /// What the published forecast is of, until it is given up.
    standing: Option<Minute>,
}

/// The minute that a forecast is of.
#[derive(Debug, Clone, Copy)]
struct Minute {
    /// Ticks and model step of the state that it begins from.
    from: (u64, u64),
    /// Its end (s of the run).
    end: f64,
    /// Speed (rad/s) and weight (N) that it assumes.
    targets: [f64; 2],
}

impl ForecastDesk {
    /// A desk that takes `forecasts` from `now` on.
    pub fn new(forecasts: Arc<Forecasts>, config: &Config, now: f64) -> Self {
        Self {
            forecasts,
            time_step: config.solver.time_step,
            held: Held::new(&config.inputs),
            came: now,
            missed: now,
            newest: [0; 2],
            asked: VecDeque::new(),
            standing: None,
        }
    }

    /// Takes what is asked for from now on.
    pub fn ask(&mut self, inputs: &RunInputs) {
        let time = self.newest[0] as f64 * self.time_step;
        let values = [inputs.inputs.rotary_speed, inputs.inputs.weight_on_bit];
        self.asked.push_back((time, values));
        self.forget(time);
    }

    /// Forgets what was asked for before the last [`WAVERS`]; the value that was in force when they began stays.
    fn forget(&mut self, now: f64) {
        while self.asked.get(1).is_some_and(|(time, _)| now - time >= WAVERS) {
            self.asked.pop_front();
        }
    }

    /// Takes what came.
    pub fn observe(&mut self, frame: &Frame) {
        let time = frame.ticks as f64 * self.time_step;
        self.newest = [frame.ticks, frame.snapshot.step];
        self.forget(time);
        if frame.ends_interval.contacts {
            self.held.peaks(time, &frame.snapshot);
        }
        if frame.due.has(Output::Alarms) {
            self.held.look(time, &frame.snapshot);
        }
    }

    /// What is to be published `now`, as a message: the forecast that has arrived, why the published one is given up, or after
    /// 90 s why none has arrived. `tools` are the newest seconds of plausible tools, and `instant` gives the time of a tick
    /// (ns).
    pub fn take<'a>(
        &mut self,
        now: f64,
        frame_id: &str,
        tools: impl Iterator<Item = &'a messages::Bands>,
        instant: impl Fn(u64) -> i64,
    ) -> Option<messages::Forecast> {
        let Some(issued) = self.issued(now) else {
            let minute = self.standing?;
            let why = self.gone(&minute)?;
            self.standing = None;
            return Some(messages::Forecast {
                failure: why,
                ..unknown(minute.from, minute.targets, frame_id, &instant)
            });
        };
        let from = (issued.ticks, issued.step);
        let mut message = unknown(from, issued.targets, frame_id, &instant);
        self.standing = None;
        match issued.forecast {
            Err(why) => message.failure = why,
            Ok(forecast) => {
                let minute = Minute {
                    from,
                    end: (forecast.first + HORIZON) as f64,
                    targets: issued.targets,
                };
                // Its runs took so long on a busy machine, or the rig has set other values meanwhile.
                if let Some(why) = self.gone(&minute) {
                    message.failure = why;
                    return Some(message);
                }
                self.standing = Some(minute);
                let first = (forecast.first as f64 / self.time_step).round() as u64;
                message.bands_from = Time::from_nanoseconds(instant(first));
                (message.members, message.failed) = (forecast.members, forecast.failed);
                message.tools = forecast.tools;
                message.failure.clone_from(&forecast.failure);
                let widening = self.held.widening(spread(tools));
                message.bands = Signal::ALL.map(|signal| self.band(signal, &forecast, &widening)).into();
                message.alarms = forecast.alarms.iter().map(AlarmChance::message).collect();
                message.any_alarm = forecast.any_alarm.probability;
                [message.any_alarm_lower, message.any_alarm_upper] = forecast.any_alarm.interval;
                self.held.hold(forecast, issued.targets, widening);
            }
        }
        Some(message)
    }

    /// Why a forecast is not one of the next minute at the speed and weight that are asked for; `None` where it is.
    fn gone(&self, minute: &Minute) -> Option<String> {
        let [ticks, step] = self.newest;
        let time = ticks as f64 * self.time_step;
        let words =
            |[speed, weight]: [f64; 2]| format!("{:.1} r/min and {:.1} kN", rad_per_s_to_rpm(speed), n_to_kn(weight));
        let made_for = words(minute.targets);
        // A rig's weight wavers by some percent: what was asked for differs when none of the last seconds' values is close.
        let is_for = |(_, asked): &(f64, [f64; 2])| self.held.is_for(&minute.targets, *asked);
        let asked = match self.asked.back() {
            Some((_, newest)) if !self.asked.iter().any(is_for) => Some(*newest),
            _ => None,
        };
        if step < minute.from.1 {
            Some(format!("the model was reset since the forecast for {made_for} began"))
        } else if let Some(asked) = asked {
            Some(format!(
                "the forecast was made for {made_for}, and {} are asked for now; the next one follows",
                words(asked)
            ))
        } else if time >= minute.end {
            let age = time - minute.from.0 as f64 * self.time_step;
            Some(format!(
                "the forecast for {made_for} began {age:.0} s ago and its minute is over; a newer one was not ready, because \
                 the machine was busy or other look-aheads came first"
            ))
        } else {
            None
        }
    }

    /// What is to be published at `now`.
    fn issued(&mut self, now: f64) -> Option<Issued> {
        if let Some(issued) = self.forecasts.take() {
            (self.came, self.missed) = (now, now);
            return Some(issued);
        }
        if now - self.missed < LATE {
            return None;
        }
        self.missed = now;
        let [ticks, step] = self.newest;
        Some(Issued {
            ticks,
            step,
            targets: [f64::NAN; 2],
            forecast: Err(self.forecasts.why_none(now - self.came)),
        })
    }

    /// The item of `/diagnostics` on the look-ahead of the node with this name. The alarms alone decide levels.
    pub fn item(&self, node: &str, now: f64) -> DiagnosticStatus {
        let since = now - self.came;
        DiagnosticStatus {
            level: DiagnosticStatus::OK,
            name: format!("{node}: look_ahead"),
            message: if since < LATE {
                format!("the newest forecast came {} s ago", since as u64)
            } else {
                self.forecasts.why_none(since)
            },
            hardware_id: "flexdrill".into(),
            ..DiagnosticStatus::default()
        }
    }

    fn band(&self, signal: Signal, forecast: &Forecast, widening: &Widening) -> ForecastBand {
        let (name, unit) = signal.name_and_unit();
        let of = self.held.calibration().of(signal);
        let widths = widening.factors[signal as usize];
        let bands: Vec<[f64; 3]> = (0..)
            .zip(&forecast.seconds)
            .map(|(second, bands)| widening.band(signal, second, &bands[signal as usize]))
            .collect();
        let sum = |count: fn(&Compared) -> u32| of.iter().map(count).sum();
        let quantile = |index: usize| bands.iter().map(|band| band[index]).collect();
        ForecastBand {
            name: name.to_owned(),
            unit: unit.to_owned(),
            p5: quantile(0),
            p50: quantile(1),
            p95: quantile(2),
            width: widths[0],
            compared: sum(|of| of.compared),
            inside: sum(|of| of.inside),
            inside_members: sum(|of| of.inside_members),
            lead_until: LEADS.map(|until| until as f64).into(),
            lead_width: widths.into(),
            lead_calibrated: of.each_ref().map(Compared::is_calibrated).into(),
            lead_compared: of.each_ref().map(|of| of.compared).into(),
            lead_inside: of.each_ref().map(|of| of.inside).into(),
        }
    }
}

/// By how much plausible tools differ, in the mean over some seconds of theirs: that of one second is chance. A second without
/// bands, and a figure that no tool has, say nothing.
fn spread<'a>(tools: impl Iterator<Item = &'a messages::Bands>) -> Least {
    let (mut sums, mut count) = ([[0.0; 2]; SIGNALS], 0.0);
    for second in tools.filter(|second| !second.bands.is_empty()) {
        count += 1.0;
        for (signal, sum) in Signal::ALL.into_iter().zip(&mut sums) {
            let of_tools = second.bands.iter().find(|band| band.name == signal.of_tools());
            let [below, above] = of_tools.map_or([0.0; 2], |band| [band.p50 - band.p5, band.p95 - band.p50]);
            sum[0] += below.max(0.0);
            sum[1] += above.max(0.0);
        }
    }
    sums.map(|sum| sum.map(|sum| sum / f64::max(count, 1.0)))
}

/// A forecast that says nothing yet, from the state at these ticks and this step.
fn unknown(
    (ticks, from_step): (u64, u64),
    [rotary_speed, weight_on_bit]: [f64; 2],
    frame_id: &str,
    instant: impl Fn(u64) -> i64,
) -> messages::Forecast {
    messages::Forecast {
        header: Header {
            stamp: Time::from_nanoseconds(instant(ticks)),
            frame_id: frame_id.to_owned(),
        },
        from_step,
        rotary_speed,
        weight_on_bit,
        interval: 1.0,
        any_alarm: f64::NAN,
        any_alarm_lower: 0.0,
        any_alarm_upper: 1.0,
        ..messages::Forecast::default()
    }
}

#[cfg(test)]
mod tests;
