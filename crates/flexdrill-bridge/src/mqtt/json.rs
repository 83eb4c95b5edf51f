//! The contents of the documents: SI values with their units, times of the rig's clock in RFC 3339, words instead of codes.
//! What is not known is `null`.

use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::{Alarm, AlarmChance, AlarmList, Bands, Forecast, Residuals, SafeWindow, TwinStatus};
use flexdrill_outputs::words;
use jiff::Timestamp;
use serde_json::{Map, Value, json};

use crate::{Figure, Quantity, TwinFigures};

fn quantity(value: f64, unit: &str) -> Value {
    json!({"value": value, "unit": unit_name(unit)})
}

/// The messages write `N m`, files and other protocols `N.m`.
fn unit_name(unit: &str) -> String {
    match unit {
        "" => "1".to_owned(),
        unit => unit.replace("N m", "N.m"),
    }
}

/// A time in RFC 3339 with milliseconds; `null` for zero, which is "never" in the messages.
fn time(time: &Time) -> Value {
    match time.to_nanoseconds() {
        0 => Value::Null,
        nanoseconds => at(nanoseconds),
    }
}

/// An instant (ns since 1970) in RFC 3339 with milliseconds.
pub fn at(nanoseconds: i64) -> Value {
    let milliseconds = nanoseconds.div_euclid(1_000_000);
    Timestamp::from_millisecond(milliseconds).map_or(Value::Null, |time| json!(format!("{time:.3}")))
}

/// `null` for an empty text.
fn text(text: &str) -> Value {
    if text.is_empty() { Value::Null } else { json!(text) }
}

/// The document of `bridge`.
pub fn bridge(now: i64, twin: &str, since: i64) -> Value {
    json!({
        "state": "online",
        "twin": twin,
        "since": at(since),
        "time": at(now),
        "version": env!("CARGO_PKG_VERSION"),
    })
}

/// The document of `status`.
pub fn status(status: &TwinStatus) -> Value {
    let inputs: Vec<Value> = (0..status.input_name.len())
        .map(|input| one_input(status, input))
        .collect();
    json!({
        "stamp": time(&status.header.stamp),
        "sequence": status.sequence,
        "state": words::twin_state(status.state),
        "model_time": quantity(status.model_time, "s"),
        "real_time_factor": quantity(status.real_time_factor, "1"),
        "lateness": quantity(status.lateness, "s"),
        "steps_skipped": status.steps_skipped,
        "model_quality": words::model_quality(status.model_quality),
        "model_quality_cause": text(&status.model_quality_cause),
        "inputs": inputs,
        "surveys": {
            "known": status.surveys_known,
            "waiting": status.surveys_waiting,
            "refused": status.surveys_refused,
        },
        "recording": words::recording_state(status.recording_state),
        "recording_messages_lost": status.recording_drops,
        "config_hash": status.config_hash,
        "changed_parameters": status.changed_parameter,
        "version": status.version,
    })
}

fn one_input(status: &TwinStatus, input: usize) -> Value {
    let name = status.input_name[input].as_str();
    let unit = Quantity::try_from(name.to_owned()).map_or("", |quantity| quantity.dimension().si().name());
    let number = |values: &[f64]| values.get(input).copied().unwrap_or(f64::NAN);
    json!({
        "name": name,
        "state": status.input_state.get(input).map(|code| words::input_state(*code)),
        "applied": quantity(number(&status.input_applied), unit),
        "received": quantity(number(&status.input_received), unit),
        "age": quantity(number(&status.input_age), "s"),
        "at_safe_value": status.input_safe.get(input),
        "suspect": status.input_suspect.get(input),
        "driver": status.input_driver.get(input).map(|driver| text(driver)),
    })
}

/// The document of `figures`.
pub fn figures(twin: &TwinFigures, now: i64) -> Value {
    let figures: Map<String, Value> = Figure::all()
        .map(|figure| {
            let value = twin.value(figure).unwrap_or(f64::NAN);
            (figure.name.to_owned(), quantity(value, figure.dimension.si().name()))
        })
        .collect();
    json!({"time": at(now), "figures": figures})
}

/// Whether an alarm is one of the document.
pub fn is_raised(alarm: &Alarm) -> bool {
    !matches!(
        alarm.state,
        Alarm::NORMAL | Alarm::SUPPRESSED_BY_DESIGN | Alarm::OUT_OF_SERVICE
    )
}

/// The document of `alarms`: those that stand, wait to be acknowledged or are shelved, the worst first.
pub fn alarms(list: &AlarmList) -> Value {
    let raised: Vec<Value> = list.alarms.iter().filter(|alarm| is_raised(alarm)).map(alarm).collect();
    json!({
        "stamp": time(&list.header.stamp),
        "sequence": list.sequence,
        "active": list.alarms.iter().filter(|alarm| alarm.active).count(),
        "unacknowledged": list.unacknowledged,
        "flood": list.flood,
        "alarms": raised,
    })
}

fn alarm(alarm: &Alarm) -> Value {
    let body = match alarm.body {
        Alarm::PIPE => Some("flexible pipe"),
        Alarm::GUIDE => Some("guide pipe"),
        _ => None,
    };
    json!({
        "id": alarm.id,
        "name": alarm.name,
        "state": words::alarm_state(alarm.state),
        "priority": words::alarm_priority(alarm.priority),
        "for": if alarm.category == Alarm::DRILLING { "driller" } else { "administrator" },
        "active": alarm.active,
        "acknowledged": alarm.acknowledged,
        "since": time(&alarm.since),
        "shelved_until": time(&alarm.shelved_until),
        "ended": alarm.ended,
        "ended_at": time(&alarm.ended_at),
        "less_severe_since": time(&alarm.less_severe_since),
        "episodes": alarm.episodes,
        "follows": text(&alarm.follows),
        "worst_at": time(&alarm.worst_at),
        "from_earlier_run": alarm.from_earlier_run,
        "body": body,
        "measured_depth": quantity(alarm.measured_depth, "m"),
        "inclination": quantity(alarm.inclination, "rad"),
        "value": quantity(alarm.value, &alarm.unit),
        "threshold": quantity(alarm.threshold, &alarm.unit),
        "confidence": quantity(alarm.confidence, "1"),
        "evidence": text(&alarm.evidence),
        "cause": text(&alarm.cause),
        "consequence": text(&alarm.consequence),
        "what_to_do": text(&alarm.what_to_do),
        "what_the_engineer_can_do": text(&alarm.what_the_engineer_can_do),
    })
}

/// The chance of an alarm of a priority or a higher one, with its 95 % interval and the members that had it.
fn chance(of: &AlarmChance) -> Value {
    json!({
        "id": of.id,
        "name": of.name,
        "priority": words::alarm_priority(of.priority),
        "probability": of.probability,
        "lower": of.lower,
        "upper": of.upper,
        "seen": of.seen,
        "members": of.members,
    })
}

/// The chance of an alarm in the next minute, with the median of the time to it.
fn in_the_next_minute(of: &AlarmChance) -> Value {
    let mut document = chance(of);
    // `quantity` turns NaN into null with its unit: JSON has no NaN.
    document["time_to_first"] = quantity(of.time_to_first, "s");
    document
}

/// A figure over members: numbers, or a number by second.
fn band(name: &str, unit: &str, [p5, p50, p95]: [&impl serde::Serialize; 3]) -> Value {
    json!({"name": name, "unit": unit_name(unit), "p5": p5, "p50": p50, "p95": p95})
}

/// The document of `bands`.
pub fn bands(bands: &Bands) -> Value {
    let each = bands.bands.iter();
    let each: Vec<Value> = each
        .map(|of| band(&of.name, &of.unit, [&of.p5, &of.p50, &of.p95]))
        .collect();
    json!({
        "stamp": time(&bands.header.stamp),
        "members": bands.members,
        "failed": bands.failed,
        "effective": bands.effective,
        "no_bands": text(&bands.no_bands),
        "any_alarm": {
            "probability": bands.any_alarm,
            "lower": bands.any_alarm_lower,
            "upper": bands.any_alarm_upper,
        },
        "alarms": bands.alarms.iter().map(chance).collect::<Vec<_>>(),
        "bands": each,
    })
}

/// The document of `forecast`.
pub fn forecast(forecast: &Forecast) -> Value {
    // Bands and alarms are lists, because a later version may have more; a reader finds its own by name.
    let bands = forecast.bands.iter();
    let bands: Vec<Value> = bands
        .map(|of| band(&of.name, &of.unit, [&of.p5, &of.p50, &of.p95]))
        .collect();
    // One document per topic, complete: a client that joins gets the retained one and needs no history.
    json!({
        "stamp": time(&forecast.header.stamp),
        "rotary_speed": quantity(forecast.rotary_speed, "rad/s"),
        "weight_on_bit": quantity(forecast.weight_on_bit, "N"),
        "members": forecast.members,
        "failed": forecast.failed,
        "failure": text(&forecast.failure),
        "any_alarm": {
            "probability": forecast.any_alarm,
            "lower": forecast.any_alarm_lower,
            "upper": forecast.any_alarm_upper,
        },
        "alarms": forecast.alarms.iter().map(in_the_next_minute).collect::<Vec<_>>(),
        // The bands are by whole seconds of model time, and begin with the first after the state.
        "bands_from": time(&forecast.bands_from),
        "interval": quantity(forecast.interval, "s"),
        "bands": bands,
    })
}

/// The document of `residuals`.
pub fn residuals(residuals: &Residuals) -> Value {
    let each: Vec<Value> = residuals
        .residuals
        .iter()
        .map(|residual| {
            json!({
                "name": residual.name,
                "unit": unit_name(&residual.unit),
                "sample": residual.sample,
                "measured": residual.measured,
                "predicted": residual.predicted,
                "low": residual.low,
                "high": residual.high,
                "ratio": residual.ratio,
            })
        })
        .collect();
    json!({
        "stamp": time(&residuals.header.stamp),
        "steady": residuals.steady,
        "drilling": residuals.drilling,
        "bit_depth": quantity(residuals.bit_depth, "m"),
        "residuals": each,
        "friction_factor": {
            "value": residuals.friction_factor,
            "low": residuals.friction_factor_low,
            "high": residuals.friction_factor_high,
            "unit": "1",
        },
        "torque_tare": {
            "value": residuals.torque_tare,
            "low": residuals.torque_tare_low,
            "high": residuals.torque_tare_high,
            "unit": "N.m",
        },
        "likely_causes": residuals.likely_causes,
    })
}

/// The document of `safe_window`.
pub fn safe_window(map: &SafeWindow) -> Value {
    let verdicts: Vec<&str> = map
        .verdict
        .iter()
        .map(|verdict| match *verdict {
            SafeWindow::CLEAR => "clear",
            SafeWindow::ALARM => "alarm",
            SafeWindow::DEPENDS_ON_START => "depends on the start",
            SafeWindow::NOT_KNOWN => "not known",
            _ => "unknown",
        })
        .collect();
    json!({
        "stamp": time(&map.header.stamp),
        "title": map.title,
        "motion": map.motion,
        "horizon": quantity(map.horizon, "s"),
        "members": {"most_asked": map.members, "least_ended": map.least_members, "most_ended": map.most_members},
        "limit": map.limit,
        "priority": words::alarm_priority(map.priority),
        "rotary_speed": {"values": map.rotary_speed_rpm, "unit": "r/min"},
        "weight_on_bit": {"values": map.weight_on_bit_kn, "unit": "kN"},
        "verdict": verdicts,
        "chance": map.chance,
        "alarm": map.alarm,
        "was_run": map.was_run,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_is_null_and_foreign_text_is_escaped() {
        let list = AlarmList {
            alarms: vec![
                Alarm::default(),
                Alarm {
                    id: "a".into(),
                    state: Alarm::ACTIVE_UNACKNOWLEDGED,
                    priority: Alarm::HIGH,
                    active: true,
                    value: 2.0,
                    unit: "N m".into(),
                    measured_depth: f64::NAN,
                    evidence: "\"x\"\u{1b}[2J\n".into(),
                    ended: true,
                    ended_at: Time::from_nanoseconds(1_700_000_000_250_000_000),
                    episodes: 4,
                    follows: "stick_slip".into(),
                    ..Alarm::default()
                },
            ],
            unacknowledged: 1,
            ..AlarmList::default()
        };
        let written = alarms(&list).to_string();
        assert!(!written.contains(|c: char| c.is_control()), "{written}");
        let read: Value = serde_json::from_str(&written).unwrap();
        assert_eq!(read["active"], 1);
        let [alarm] = read["alarms"].as_array().unwrap().as_slice() else {
            panic!("{written}");
        };
        assert_eq!(alarm["evidence"], "\"x\"\u{1b}[2J\n");
        assert_eq!(alarm["value"], json!({"value": 2.0, "unit": "N.m"}));
        assert_eq!(alarm["measured_depth"], json!({"value": null, "unit": "m"}));
        assert_eq!(alarm["since"], Value::Null);
        assert_eq!(alarm["priority"], "high");
        // A display that shows an alarm as standing when its condition has ended says what is not true.
        assert_eq!(
            [&alarm["ended"], &alarm["ended_at"], &alarm["less_severe_since"]],
            [&json!(true), &json!("2023-11-14T22:13:20.250Z"), &Value::Null]
        );
        assert_eq!(
            [&alarm["episodes"], &alarm["follows"]],
            [&json!(4), &json!("stick_slip")]
        );
    }

    #[test]
    fn times_are_rfc_3339_and_inputs_have_the_units_of_their_quantity() {
        let message = TwinStatus {
            header: flexdrill_messages::std_msgs::Header {
                stamp: Time::from_nanoseconds(1_700_000_000_250_999_999),
                ..Default::default()
            },
            state: TwinStatus::RUNNING,
            input_name: vec!["rotary_speed".into(), "weight_on_bit".into()],
            input_state: vec![TwinStatus::INPUT_OK],
            input_applied: vec![6.0, 20e3],
            surveys_known: 2,
            surveys_refused: 1,
            ..TwinStatus::default()
        };
        let document = status(&message);
        assert_eq!(document["stamp"], "2023-11-14T22:13:20.250Z");
        assert_eq!(document["state"], "running");
        assert_eq!(document["inputs"][0]["applied"], json!({"value": 6.0, "unit": "rad/s"}));
        assert_eq!(document["inputs"][1]["applied"], json!({"value": 20e3, "unit": "N"}));
        assert_eq!(document["surveys"], json!({"known": 2, "waiting": 0, "refused": 1}));
        // Arrays of a damaged message may differ in length.
        assert_eq!(document["inputs"][1]["state"], Value::Null);
        let figures = figures(&TwinFigures::default(), 0);
        assert_eq!(figures["figures"]["bit_torque"], json!({"value": null, "unit": "N.m"}));
    }

    #[test]
    fn plausible_tools_say_how_many_they_are_and_why_there_are_no_bands() {
        let known = Bands {
            members: 12,
            effective: 9.5,
            any_alarm: 0.25,
            bands: vec![flexdrill_messages::FigureBand {
                name: "transfer/bit_torque".into(),
                unit: "N m".into(),
                p5: 80.0,
                p50: 92.0,
                p95: f64::NAN,
            }],
            alarms: vec![AlarmChance {
                id: "stick_slip".into(),
                priority: Alarm::HIGH,
                seen: 3,
                members: 12,
                probability: 0.25,
                ..AlarmChance::default()
            }],
            ..Bands::default()
        };
        let document = bands(&known);
        let band = &document["bands"][0];
        assert_eq!(
            (&band["unit"], &band["p50"], &band["p95"]),
            (&json!("N.m"), &json!(92.0), &Value::Null)
        );
        let alarm = &document["alarms"][0];
        assert_eq!((&alarm["seen"], &alarm["members"]), (&json!(3), &json!(12)));
        assert_eq!(alarm["priority"], "high");
        assert_eq!(
            (&document["no_bands"], &document["stamp"]),
            (&Value::Null, &Value::Null)
        );
        let unknown = Bands {
            no_bands: "too few members".into(),
            any_alarm: f64::NAN,
            ..Bands::default()
        };
        let document = bands(&unknown);
        assert_eq!(document["no_bands"], "too few members");
        assert_eq!(document["any_alarm"]["probability"], Value::Null);
        assert_eq!(document["bands"], json!([]));
    }
}
