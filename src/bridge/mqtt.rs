//! `flexdrill bridge mqtt`: the twin's outputs on a broker. A broker sends nothing to the twin.

use std::sync::Arc;
use std::time::{Duration, Instant};

use flexdrill_bridge::mqtt::{
    Broker, Documents, LinkCounts, LinkEvent, LinkTimes, Shared, SparkplugNode, documents, json, link,
};
use flexdrill_bridge::{TwinFigures, lines};
use flexdrill_messages::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{Message, message_from_cdr_body};
use flexdrill_text::{counted, log_ending, printable};
use tokio::sync::{mpsc, watch};
use tokio::time::{MissedTickBehavior, interval};

use super::diagnostics::{array, counts as counts_of, item};
use super::{BridgeNode, mqtt_figures};

/// Time between two looks at what DDS brought.
const POLL: Duration = Duration::from_millis(100);
/// Time between two messages on `/diagnostics`.
const DIAGNOSTICS: Duration = Duration::from_secs(1);
/// The twin's status comes five times a second; without one for this long it is silent.
const SILENCE: Duration = Duration::from_secs(3);
/// Events of a connection that wait to be logged.
const EVENTS: usize = 16;

/// What the bridge receives: the topics that have figures, and these.
const MORE_TOPICS: [&TopicInfo; 4] = [
    &topics::FORECAST,
    &topics::SAFE_WINDOW,
    &topics::RESIDUALS,
    &topics::BANDS,
];

/// Names of the two connections: an MQTT connection has one will, and JSON and Sparkplug need one each.
const NAMES: [&str; 2] = ["mqtt", "sparkplug"];

/// The bridge.
pub struct MqttBridge {
    node: BridgeNode,
    node_name: String,
    broker: Broker,
    documents: Arc<Shared<Documents>>,
    sparkplug: Option<Arc<Shared<SparkplugNode>>>,
    every: Duration,
    twin: TwinFigures,
    /// When the newest status arrived.
    heard: Option<Instant>,
    state: &'static str,
    since: i64,
    /// Why each connection was last lost; empty before the first loss.
    losses: [String; 2],
    unreadable: u64,
}

impl MqttBridge {
    /// The topics that the node of the bridge receives.
    pub fn topics() -> Vec<&'static TopicInfo> {
        TwinFigures::TOPICS.into_iter().chain(MORE_TOPICS).collect()
    }

    /// A bridge that sends figures and status `every` so often.
    pub fn new(
        node: BridgeNode,
        node_name: String,
        broker: Broker,
        documents: Documents,
        sparkplug: Option<SparkplugNode>,
        every: Duration,
    ) -> Self {
        Self {
            node,
            node_name,
            broker,
            documents: Arc::new(Shared::new(documents)),
            sparkplug: sparkplug.map(|node| Arc::new(Shared::new(node))),
            every,
            twin: TwinFigures::default(),
            heard: None,
            state: "not seen",
            since: lines::now(),
            losses: Default::default(),
            unreadable: 0,
        }
    }

    /// Runs until `stop` becomes true and the connections have ended.
    pub async fn run(&mut self, times: LinkTimes, stop: watch::Receiver<bool>) {
        let (sender, mut events) = mpsc::channel(EVENTS);
        let (sparkplug_sender, mut sparkplug_events) = mpsc::channel(EVENTS);
        self.greet();
        let (broker, documents, sparkplug) = (self.broker.clone(), self.documents.clone(), self.sparkplug.clone());
        let links = async {
            let first = link::run(&broker, &documents, times, &sender, stop.clone());
            let second = async {
                if let Some(node) = &sparkplug {
                    link::run(&broker, node, times, &sparkplug_sender, stop.clone()).await;
                }
            };
            tokio::join!(first, second);
        };
        let mut links = std::pin::pin!(links);
        let [mut poll, mut send, mut diagnose] = [POLL, self.every, DIAGNOSTICS].map(|period| {
            let mut ticks = interval(period);
            ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
            ticks
        });
        loop {
            tokio::select! {
                () = &mut links => return,
                Some(event) = events.recv() => self.on(0, event),
                Some(event) = sparkplug_events.recv() => self.on(1, event),
                _ = poll.tick() => self.receive(),
                _ = send.tick() => self.send(),
                _ = diagnose.tick() => self.node.diagnose(&self.diagnostics(lines::now())),
            }
        }
    }

    /// What is known before the twin has sent anything.
    fn greet(&self) {
        let document = json::bridge(lines::now(), self.state, self.since);
        self.documents
            .update(|documents| documents.put(documents::BRIDGE, &document));
        self.node_update(|node| {
            node.flag(mqtt_figures::ALIVE, Some(false));
            mqtt_figures::figures(node, &TwinFigures::default());
        });
    }

    fn node_update(&self, change: impl FnOnce(&mut SparkplugNode)) {
        if let Some(node) = &self.sparkplug {
            node.update(change);
        }
    }

    /// Takes what DDS brought. Alarms, forecast, safe window, residuals and bands are sent at once.
    fn receive(&mut self) {
        // The closure below borrows the node mutably, so the figures leave `self` for its time.
        let mut twin = std::mem::take(&mut self.twin);
        let mut heard = false;
        // A backlog may hold several of each, and a broker keeps one document per topic, so only the newest is sent.
        let (mut alarms, mut forecast, mut window) = (false, None, None);
        let (mut residuals, mut bands) = (None, None);
        let unreadable = self.node.take(|topic, body| match topic.name {
            name if name == topics::FORECAST.name => newest(&mut forecast, body),
            name if name == topics::SAFE_WINDOW.name => newest(&mut window, body),
            name if name == topics::RESIDUALS.name => newest(&mut residuals, body),
            name if name == topics::BANDS.name => newest(&mut bands, body),
            name => {
                heard |= name == topics::STATUS.name;
                // The list of alarms is latched state, sent in full; flags suffice and the figures hold the newest.
                alarms |= name == topics::ALARMS.name;
                twin.take(name, body).is_ok()
            }
        });
        self.twin = twin;
        // The time of reading, not the stamp: silence is judged on this
        // machine's clock, which the twin's need not agree with.
        if heard {
            self.heard = Some(Instant::now());
        }
        if alarms && let Some(list) = self.twin.alarms() {
            self.put("alarms", &json::alarms(list));
            self.node_update(|node| mqtt_figures::alarms(node, list));
        }
        if let Some(forecast) = forecast {
            self.put("forecast", &json::forecast(&forecast));
            self.node_update(|node| mqtt_figures::forecast(node, &forecast));
        }
        if let Some(window) = window {
            self.put("safe_window", &json::safe_window(&window));
        }
        if let Some(residuals) = residuals {
            self.put("residuals", &json::residuals(&residuals));
            self.node_update(|node| mqtt_figures::residuals(node, &residuals));
        }
        if let Some(bands) = bands {
            self.put("bands", &json::bands(&bands));
            self.node_update(|node| mqtt_figures::bands(node, &bands));
        }
        // A message that does not decode comes from another version. It is
        // counted and reported once, and does not end the bridge.
        if unreadable > 0 {
            self.unreadable += unreadable;
            log(NAMES[0], "unreadable", || {
                format!(
                    "{} of the twin could not be read; twin and bridge should have the same version",
                    counted(unreadable, "message")
                )
            });
        }
        // Judged after reading, so that a status in this batch counts before silence is declared.
        self.judge();
    }

    fn put(&self, topic: &'static str, document: &serde_json::Value) {
        self.documents.update(|documents| documents.put(topic, document));
    }

    /// Says when the twin falls silent and when it is there again.
    fn judge(&mut self) {
        let state = match self.heard {
            None => "not seen",
            Some(heard) if heard.elapsed() > SILENCE => "silent",
            Some(_) => "running",
        };
        if state == self.state {
            return;
        }
        self.state = state;
        self.since = lines::now();
        let is_alive = state == "running";
        if is_alive {
            if let Some(more) = log_ending("mqtt: the twin sends") {
                tracing::info!("mqtt: the twin sends{more}");
            }
        } else {
            log("mqtt", "silent", || {
                format!("the twin has sent no status for {} s", SILENCE.as_secs())
            });
            // What it sent is no longer true, also when it comes back.
            self.twin = TwinFigures::default();
        }
        self.put(documents::BRIDGE, &json::bridge(self.since, state, self.since));
        self.node_update(|node| {
            node.flag(mqtt_figures::ALIVE, Some(is_alive));
            if !is_alive {
                node.forget(&[mqtt_figures::ALIVE]);
            }
        });
    }

    /// Sends status and figures, while the twin does.
    fn send(&mut self) {
        if self.state != "running" {
            return;
        }
        if let Some(status) = self.twin.status() {
            self.put("status", &json::status(status));
        }
        self.put("figures", &json::figures(&self.twin, lines::now()));
        self.node_update(|node| mqtt_figures::figures(node, &self.twin));
    }

    fn on(&mut self, which: usize, event: LinkEvent) {
        let name = NAMES[which];
        match event {
            LinkEvent::Connected => {
                if let Some(more) = log_ending(format!("{name}: connected")) {
                    tracing::info!("{name}: connected to {}{more}", self.broker);
                }
            }
            LinkEvent::Waiting { why, wait } => {
                log(name, "waiting", || {
                    format!(
                        "no connection to {}: {}; the next attempt is in {} s",
                        self.broker,
                        printable(&why),
                        wait.as_secs_f64()
                    )
                });
                self.losses[which] = why;
            }
            LinkEvent::Note(note) => log(name, "note", || printable(&note).into_owned()),
        }
    }

    /// The message of `/diagnostics` at an instant (ns since 1970).
    fn diagnostics(&self, now: i64) -> DiagnosticArray {
        let replaced = self.documents.update(|documents| documents.replaced());
        let more = vec![
            ("messages_replaced", replaced),
            ("messages_unreadable", self.unreadable),
        ];
        let mut status = vec![self.item(0, &self.documents.counts(), more)];
        if let Some(node) = &self.sparkplug {
            let [births, asked, ignored, left_out] = node.update(|node| node.counts());
            let more = vec![
                ("births", births),
                ("births_asked_for", asked),
                ("commands_ignored", ignored),
                ("metrics_left_out", left_out),
            ];
            status.push(self.item(1, &node.counts(), more));
        }
        array(now, status)
    }

    fn item(&self, which: usize, counts: &LinkCounts, more: Vec<(&str, u64)>) -> DiagnosticStatus {
        let verdict = verdict(counts.is_open, &self.losses[which], self.state);
        let values = [
            ("connections_open", u64::from(counts.is_open)),
            ("connections_made", counts.made),
            ("messages_sent", counts.sent),
            ("messages_acknowledged", counts.acknowledged),
            ("messages_too_large", counts.too_large),
            ("messages_received", counts.received),
            ("bytes_sent", counts.bytes),
        ];
        let place = self.broker.to_string();
        let values = counts_of(values.into_iter().chain(more));
        item(&self.node_name, NAMES[which], verdict, &place, values)
    }
}

/// One warning per connection and cause in ten seconds.
fn log(connection: &'static str, cause: &'static str, text: impl FnOnce() -> String) {
    if let Some(more) = log_ending(format!("{connection}: {cause}")) {
        tracing::warn!("{connection}: {}{more}", text());
    }
}

/// Level and words of a connection.
fn verdict(is_open: bool, loss: &str, twin: &str) -> (u8, String) {
    match (is_open, twin) {
        (false, _) if loss.is_empty() => (DiagnosticStatus::WARN, "not yet connected".to_owned()),
        (false, _) => (DiagnosticStatus::ERROR, format!("not connected: {loss}")),
        (true, "running") => (DiagnosticStatus::OK, "connected, the twin sends".to_owned()),
        (true, twin) => (DiagnosticStatus::WARN, format!("connected, the twin is {twin}")),
    }
}

/// Keeps a message if it can be read.
fn newest<M: Message>(kept: &mut Option<M>, body: &[u8]) -> bool {
    match message_from_cdr_body(body) {
        Ok(message) => {
            *kept = Some(message);
            true
        }
        Err(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_level_follows_connection_and_twin() {
        assert_eq!(verdict(false, "", "running").0, DiagnosticStatus::WARN);
        assert_eq!(verdict(false, "refused", "running").0, DiagnosticStatus::ERROR);
        assert_eq!(verdict(true, "refused", "running").0, DiagnosticStatus::OK);
        assert_eq!(verdict(true, "", "silent").0, DiagnosticStatus::WARN);
    }
}
