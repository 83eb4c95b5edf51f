//! What a Sparkplug node shows of the twin.

use flexdrill_bridge::mqtt::{SparkplugNode, json};
use flexdrill_bridge::{Figure, TwinFigures};
use flexdrill_messages::{Alarm, AlarmList, Bands, Forecast, Residuals};
use flexdrill_outputs::words;

/// Whether the twin is there; it keeps its value when the others are no longer known.
pub const ALIVE: &str = "Twin/alive";

/// The twin's figures. Called with an empty set it declares them.
pub fn figures(node: &mut SparkplugNode, twin: &TwinFigures) {
    for figure in Figure::all() {
        let value = twin.value(figure).unwrap_or(f64::NAN);
        node.number(&format!("Twin/{figure}"), figure.dimension.si().name(), value);
    }
    let status = twin.status();
    node.text("Twin/state", status.map(|status| words::twin_state(status.state)));
    node.text("Twin/version", status.map(|status| status.version.as_str()));
    node.text("Twin/config_hash", status.map(|status| status.config_hash.as_str()));
}

/// The state of every alarm, and the text of those that are raised.
pub fn alarms(node: &mut SparkplugNode, list: &AlarmList) {
    for alarm in &list.alarms {
        let raised = json::is_raised(alarm);
        let name = |what: &str| format!("Alarms/{}/{what}", alarm.id);
        node.flag(&name("active"), Some(alarm.active));
        node.flag(&name("acknowledged"), Some(alarm.acknowledged));
        let priority = if raised { alarm.priority } else { Alarm::NO_PRIORITY };
        node.code(&name("priority"), Some(priority));
        node.text(&name("state"), Some(words::alarm_state(alarm.state)));
        let text = |text: &str| if raised { text.to_owned() } else { String::new() };
        node.text(&name("evidence"), Some(&text(&alarm.evidence)));
        node.text(&name("what_to_do"), Some(&text(&alarm.what_to_do)));
    }
}

/// The next minute: the chance of an alarm, and the lowest and the highest value of each band.
pub fn forecast(node: &mut SparkplugNode, forecast: &Forecast) {
    node.number("Forecast/any_alarm", "1", forecast.any_alarm);
    for band in &forecast.bands {
        let unit = band.unit.replace("N m", "N.m");
        let name = |what: &str| format!("Forecast/{}/{what}", band.name);
        let lowest = band.p5.iter().copied().fold(f64::NAN, f64::min);
        let highest = band.p95.iter().copied().fold(f64::NAN, f64::max);
        node.number(&name("lowest"), &unit, lowest);
        node.number(&name("highest"), &unit, highest);
    }
}

/// Plausible tools: how many there are, in what share of them an alarm stands, and the bands of the twin's figures.
pub fn bands(node: &mut SparkplugNode, bands: &Bands) {
    node.number("Bands/effective", "1", bands.effective);
    node.number("Bands/any_alarm", "1", bands.any_alarm);
    node.text("Bands/no_bands", Some(&bands.no_bands));
    for band in &bands.bands {
        let unit = match band.unit.as_str() {
            "" => "1".to_owned(),
            unit => unit.replace("N m", "N.m"),
        };
        for (what, value) in [("p5", band.p5), ("p50", band.p50), ("p95", band.p95)] {
            node.number(&format!("Bands/{}/{what}", band.name), &unit, value);
        }
    }
}

/// What the rig measures less what the twin computes.
pub fn residuals(node: &mut SparkplugNode, residuals: &Residuals) {
    for residual in &residuals.residuals {
        let unit = residual.unit.replace("N m", "N.m");
        let name = |what: &str| format!("Residuals/{}/{what}", residual.name);
        node.number(&name("measured"), &unit, residual.measured);
        node.number(&name("predicted"), &unit, residual.predicted);
        node.number(&name("ratio"), "1", residual.ratio);
    }
}
