//! For how long a forecast stands, and how wide its bands are.

use super::*;
use crate::ahead::chance::Chance;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

const TARGETS: (f64, f64) = (40.0, 8.0);

fn targets((rpm, kn): (f64, f64)) -> [f64; 2] {
    [rpm_to_rad_per_s(rpm), kn_to_n(kn)]
}

fn desk() -> (ForecastDesk, Arc<Forecasts>) {
    let forecasts = Arc::<Forecasts>::default();
    let text = include_str!("../../../config/default.yaml");
    let config = Config::from_text("default.yaml", text).unwrap();
    let mut desk = ForecastDesk::new(Arc::clone(&forecasts), &config, 0.0);
    desk.asked.push_back((0.0, targets(TARGETS)));
    (desk, forecasts)
}

/// A forecast from the state after so many seconds.
fn issued(desk: &ForecastDesk, second: u64) -> Issued {
    let steps = (second as f64 / desk.time_step) as u64;
    Issued {
        ticks: steps,
        step: steps,
        targets: targets(TARGETS),
        forecast: Ok(Forecast {
            first: second + 1,
            seconds: Vec::new(),
            members: 4,
            tools: 0,
            failed: 0,
            failure: String::new(),
            alarms: Vec::new(),
            any_alarm: Chance::new(0, 4),
        }),
    }
}

fn at(desk: &mut ForecastDesk, second: f64) {
    let steps = (second / desk.time_step) as u64;
    let mut frame = Frame {
        ticks: steps,
        ..Frame::default()
    };
    frame.snapshot.step = steps;
    desk.observe(&frame);
}

fn taken(desk: &mut ForecastDesk) -> Option<(u32, String)> {
    let message = desk.take(0.0, "tool", std::iter::empty(), |ticks| ticks as i64)?;
    Some((message.members, message.failure))
}

#[test]
fn a_forecast_stands_for_its_minute_and_is_given_up_once() {
    let (mut desk, forecasts) = desk();
    forecasts.put(issued(&desk, 100));
    at(&mut desk, 104.0);
    assert_eq!(taken(&mut desk), Some((4, String::new())));
    at(&mut desk, 160.0);
    assert_eq!(taken(&mut desk), None);
    at(&mut desk, 161.0);
    let (members, why) = taken(&mut desk).unwrap();
    assert_eq!(members, 0);
    assert!(
        why.contains("40.0 r/min and 8.0 kN began 61 s ago and its minute is over"),
        "{why}"
    );
    assert_eq!(taken(&mut desk), None);
}

#[test]
fn a_forecast_that_comes_too_late_is_not_shown() {
    let (mut desk, forecasts) = desk();
    at(&mut desk, 197.0);
    forecasts.put(issued(&desk, 100));
    let (members, why) = taken(&mut desk).unwrap();
    assert!(members == 0 && why.contains("began 97 s ago"), "{why}");
    assert_eq!(taken(&mut desk), None);
}

#[test]
fn a_forecast_for_other_targets_is_given_up() {
    let (mut desk, forecasts) = desk();
    forecasts.put(issued(&desk, 100));
    at(&mut desk, 104.0);
    assert_eq!(taken(&mut desk).unwrap().0, 4);
    // A rig's weight wavers: a value close to that of the forecast comes every few seconds.
    for second in 104..140 {
        let weight = if second % 4 == 3 { 8.2 } else { 5.0 };
        desk.asked.push_back((f64::from(second), targets((40.9, weight))));
        at(&mut desk, f64::from(second));
        assert_eq!(taken(&mut desk), None, "{second}");
    }
    desk.asked.push_back((140.0, targets((60.0, 8.2))));
    at(&mut desk, 140.0 + 0.9 * WAVERS);
    assert_eq!(taken(&mut desk), None);
    at(&mut desk, 140.0 + 1.1 * WAVERS);
    let (members, why) = taken(&mut desk).unwrap();
    assert!(
        members == 0 && why.contains("60.0 r/min and 8.2 kN are asked for now"),
        "{why}"
    );
    // One that is made before the change and arrives after it is not shown.
    forecasts.put(issued(&desk, 103));
    let (members, why) = taken(&mut desk).unwrap();
    assert!(members == 0 && why.contains("are asked for now"), "{why}");
}

/// A second of plausible tools. Their torque lies 60 below the median and `above` over it; the weight has no number.
fn tools(above: f64) -> messages::Bands {
    let figure = |signal: Signal, [p5, p50, p95]: [f64; 3]| messages::FigureBand {
        name: signal.of_tools().to_owned(),
        unit: String::new(),
        p5,
        p50,
        p95,
    };
    messages::Bands {
        bands: vec![
            figure(Signal::BitTorque, [140.0, 200.0, 200.0 + above]),
            figure(Signal::WeightOnBit, [f64::NAN; 3]),
        ],
        ..messages::Bands::default()
    }
}

#[test]
fn plausible_tools_differ_by_the_mean_of_their_seconds() {
    let seconds = [tools(20.0), messages::Bands::default(), tools(40.0)];
    let least = spread(seconds.iter());
    assert_eq!(least[Signal::BitTorque as usize], [60.0, 30.0]);
    for signal in [Signal::WeightOnBit, Signal::BitSpeed] {
        assert_eq!(least[signal as usize], [0.0; 2], "{signal:?}");
    }
    assert_eq!(spread([messages::Bands::default()].iter()), [[0.0; 2]; SIGNALS]);
}

#[test]
fn every_figure_of_a_forecast_is_one_of_plausible_tools() {
    let known = flexdrill_outputs::figures::OverTools::known();
    for signal in Signal::ALL {
        assert!(
            known.iter().any(|figure| figure.name == signal.of_tools()),
            "{signal:?}"
        );
    }
}

#[test]
fn a_reset_ends_a_forecast() {
    let (mut desk, forecasts) = desk();
    forecasts.put(issued(&desk, 100));
    at(&mut desk, 104.0);
    assert_eq!(taken(&mut desk).unwrap().0, 4);
    at(&mut desk, 1.0);
    assert!(taken(&mut desk).unwrap().1.contains("was reset"));
}

#[test]
fn a_forecast_that_stays_away_is_reported_with_its_reason() {
    let (mut desk, forecasts) = desk();
    forecasts.note(Busy::Goals);
    assert!(desk.issued(89.0).is_none());
    let why = desk.issued(90.0).unwrap().forecast.unwrap_err();
    assert!(
        why.starts_with("no forecast for 90 s") && why.contains("~/what_if"),
        "{why}"
    );
    assert_eq!(desk.item("/twin", 95.0).message, why.replace("90 s", "95 s"));
    // It is reported again, and one that comes ends it.
    assert!(desk.issued(100.0).is_none() && desk.issued(180.0).is_some());
    forecasts.put(Issued {
        ticks: 1,
        step: 1,
        targets: [0.0; 2],
        forecast: Err("the model failed".to_owned()),
    });
    assert_eq!(desk.issued(190.0).unwrap().ticks, 1);
    assert!(desk.issued(279.0).is_none());
    assert_eq!(desk.item("/twin", 191.0).message, "the newest forecast came 1 s ago");
}
