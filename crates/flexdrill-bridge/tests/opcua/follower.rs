//! A client of ours.

use std::time::Duration;

use flexdrill_bridge::lines::now;
use flexdrill_bridge::opcua::client::{Place, RigClient, RigEvent};
use flexdrill_bridge::opcua::keys::{Application, Keys};
use flexdrill_bridge::opcua::mapping::NodeMapping;
use flexdrill_bridge::opcua::values::Collector;
use flexdrill_messages::RigInputs;
use tokio::sync::mpsc;

/// A client of ours that follows a rig.
pub struct Follower {
    events: mpsc::Receiver<RigEvent>,
    pub collector: Collector,
    task: tokio::task::JoinHandle<()>,
    _folder: tempfile::TempDir,
}

impl Drop for Follower {
    fn drop(&mut self) {
        self.task.abort();
    }
}

impl Follower {
    pub fn new(url: &str, mapping: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mapping = NodeMapping::from_text("site.yaml", mapping).unwrap();
        let application = Application {
            name: "flexdrill",
            uri: "urn:test:bridge",
            host: None,
        };
        let place = Place {
            url: url.to_owned(),
            encrypt: false,
            user: None,
            keys: Keys::open(folder.path(), application).unwrap().folder().to_owned(),
            application_uri: application.uri.to_owned(),
        };
        let (sender, events) = mpsc::channel(1000);
        let client = RigClient::new(place, &mapping, sender);
        Self {
            events,
            collector: Collector::new(&mapping, "rig"),
            task: tokio::spawn(async move { client.run().await }),
            _folder: folder,
        }
    }

    /// Takes events until one is found, for at most so long.
    pub async fn until<T>(&mut self, seconds: u64, mut find: impl FnMut(&mut Collector, &RigEvent) -> Option<T>) -> T {
        let end = tokio::time::Instant::now() + Duration::from_secs(seconds);
        let mut seen = Vec::new();
        loop {
            let event = tokio::time::timeout_at(end, self.events.recv()).await;
            let event = event
                .unwrap_or_else(|_| panic!("not within {seconds} s: {seen:?}"))
                .unwrap();
            if let RigEvent::Value(raw) = &event {
                let _ = self.collector.take(raw);
            }
            if let Some(found) = find(&mut self.collector, &event) {
                return found;
            }
            seen.push(format!("{event:?}"));
        }
    }

    /// The next message with inputs that fits.
    pub async fn inputs(&mut self, seconds: u64, fits: impl Fn(&RigInputs) -> bool) -> RigInputs {
        self.until(seconds, |collector, _| {
            let due = collector.due(now(), true);
            due.into_iter()
                .filter_map(|(inputs, _)| inputs)
                .find(|inputs| fits(inputs))
        })
        .await
    }
}
