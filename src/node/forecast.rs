//! The standing forecast, between the thread that looks ahead and the publisher's thread, which knows what came.

use std::sync::{Arc, Mutex, PoisonError};

use super::what_if_messages::of_alarm;
use crate::ahead::{Forecast, Held, Signal, widened};
use flexdrill_config::Config;
use flexdrill_core::twin::{Frame, Output};
use flexdrill_messages::builtin_interfaces::Time;
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

/// The newest forecast, until the publisher takes it.
#[derive(Debug, Default)]
pub struct Forecasts(Mutex<Option<Issued>>);

impl Forecasts {
    /// Leaves a forecast for the publisher.
    pub fn put(&self, issued: Issued) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(issued);
    }

    fn take(&self) -> Option<Issued> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// What came and the forecasts that it is compared with, on the publisher's thread.
pub struct ForecastDesk {
    forecasts: Arc<Forecasts>,
    time_step: f64,
    held: Held,
}

impl ForecastDesk {
    /// A desk that takes `forecasts`.
    pub fn new(forecasts: Arc<Forecasts>, config: &Config) -> Self {
        Self {
            forecasts,
            time_step: config.solver.time_step,
            held: Held::new(&config.inputs),
        }
    }

    /// Takes what came.
    pub fn observe(&mut self, frame: &Frame) {
        let time = frame.ticks as f64 * self.time_step;
        if frame.ends_interval.contacts {
            self.held.peaks(time, &frame.snapshot);
        }
        if frame.due.has(Output::Alarms) {
            self.held.look(time, &frame.snapshot);
        }
    }

    /// The forecast that has arrived, as a message; `instant` gives the time of a tick (ns).
    pub fn take(&mut self, frame_id: &str, instant: impl Fn(u64) -> i64) -> Option<messages::Forecast> {
        let issued = self.forecasts.take()?;
        let header = Header {
            stamp: Time::from_nanoseconds(instant(issued.ticks)),
            frame_id: frame_id.to_owned(),
        };
        let [rotary_speed, weight_on_bit] = issued.targets;
        let mut message = messages::Forecast {
            header,
            from_step: issued.step,
            rotary_speed,
            weight_on_bit,
            interval: 1.0,
            any_alarm: f64::NAN,
            any_alarm_lower: 0.0,
            any_alarm_upper: 1.0,
            ..messages::Forecast::default()
        };
        match issued.forecast {
            Err(why) => message.failure = why,
            Ok(forecast) => {
                let first = (forecast.first as f64 / self.time_step).round() as u64;
                message.bands_from = Time::from_nanoseconds(instant(first));
                (message.members, message.failed) = (forecast.members, forecast.failed);
                message.failure.clone_from(&forecast.failure);
                message.bands = Signal::ALL.map(|signal| self.band(signal, &forecast)).into();
                message.alarms = forecast.alarms.iter().map(of_alarm).collect();
                message.any_alarm = forecast.any_alarm.probability;
                [message.any_alarm_lower, message.any_alarm_upper] = forecast.any_alarm.interval;
                self.held.hold(forecast, issued.targets);
            }
        }
        Some(message)
    }

    fn band(&self, signal: Signal, forecast: &Forecast) -> ForecastBand {
        let (name, unit) = signal.name_and_unit();
        let of = self.held.calibration().of(signal);
        let width = of.width();
        let bands = forecast.seconds.iter();
        let bands: Vec<[f64; 3]> = bands
            .map(|bands| widened(signal, &bands[signal as usize], width))
            .collect();
        let quantile = |index: usize| bands.iter().map(|band| band[index]).collect();
        ForecastBand {
            name: name.to_owned(),
            unit: unit.to_owned(),
            p5: quantile(0),
            p50: quantile(1),
            p95: quantile(2),
            width,
            compared: of.compared,
            inside: of.inside,
            inside_members: of.inside_members,
        }
    }
}
