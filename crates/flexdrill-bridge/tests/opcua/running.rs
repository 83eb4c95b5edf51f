//! A server of ours, and a twin for it.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use flexdrill_bridge::lines::now;
use flexdrill_bridge::opcua::event::ServerEvent;
use flexdrill_bridge::opcua::keys::{Application, Keys};
use flexdrill_bridge::opcua::server::{self, Setup};
use flexdrill_bridge::opcua::state::TwinState;
use flexdrill_bridge::opcua::users::Users;
use flexdrill_messages::builtin_interfaces::Time;
use flexdrill_messages::std_msgs::Header;
use flexdrill_messages::topics::{self, TopicInfo};
use flexdrill_messages::{
    Alarm, AlarmList, BitState, Message, Residual, Residuals, SafeWindow, TwinStatus, to_cdr_body,
};
use tokio::net::TcpListener;
use tokio::sync::mpsc;

/// A user of the tests, and what stands in the file of passwords.
pub const USER: [&str; 2] = ["ann", "correct horse"];

/// A server with the twin's values, for as long as it is kept.
pub struct Running {
    pub address: SocketAddr,
    twin: Arc<Mutex<TwinState>>,
    pub events: Arc<Mutex<Vec<ServerEvent>>>,
    pub folder: tempfile::TempDir,
    tasks: [tokio::task::JoinHandle<()>; 2],
}

impl Drop for Running {
    fn drop(&mut self) {
        self.tasks.iter().for_each(tokio::task::JoinHandle::abort);
    }
}

impl Running {
    pub async fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let passwords = folder.path().join("users");
        std::fs::write(&passwords, format!("{}:{}\n", USER[0], USER[1])).unwrap();
        std::fs::set_permissions(&passwords, std::os::unix::fs::PermissionsExt::from_mode(0o600)).unwrap();
        let application = Application {
            name: "flexdrill",
            uri: "urn:test:flexdrill",
            host: Some("127.0.0.1"),
        };
        let setup = Setup {
            host: "127.0.0.1".into(),
            application_uri: "urn:test:flexdrill".into(),
            keys: Keys::open(&folder.path().join("keys"), application).unwrap(),
            users: Users::load(&passwords).unwrap(),
            allow_write: true,
            unencrypted: true,
            plain_passwords: true,
        };
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        let (sender, mut received) = mpsc::channel(1000);
        let (mut server, prepared) = server::prepare(&setup, sender).await.unwrap();
        let twin = Arc::new(Mutex::new(TwinState::default()));
        let events: Arc<Mutex<Vec<ServerEvent>>> = Arc::default();
        let (of_server, all) = (Arc::clone(&twin), Arc::clone(&events));
        let run = tokio::spawn(async move {
            let why = prepared.run(&listener).await;
            panic!("the server ended: {why}");
        });
        let update = tokio::spawn(async move {
            loop {
                let _ = tokio::time::timeout(Duration::from_millis(50), async {
                    while let Some(event) = received.recv().await {
                        all.lock().unwrap().push(event);
                    }
                })
                .await;
                server.update(&of_server.lock().unwrap(), now()).unwrap();
            }
        });
        Self {
            address,
            twin,
            events,
            folder,
            tasks: [run, update],
        }
    }

    pub fn url(&self) -> String {
        format!("opc.tcp://{}/", self.address)
    }

    /// The twin sends a message that will be fresh for a minute.
    pub fn send<M: Message>(&self, topic: &'static TopicInfo, message: &M) {
        let body = to_cdr_body(message).unwrap();
        self.twin
            .lock()
            .unwrap()
            .take(topic, &body, now() + 60_000_000_000)
            .unwrap();
    }

    pub fn count(&self, of: impl Fn(&ServerEvent) -> bool) -> usize {
        self.events.lock().unwrap().iter().filter(|event| of(event)).count()
    }
}

/// 2023-11-14 22:13:20 UTC.
const AT: i64 = 1_700_000_000_000_000_000;

pub fn header() -> Header {
    Header {
        stamp: Time::from_nanoseconds(AT),
        ..Header::default()
    }
}

pub fn status(change: impl FnOnce(&mut TwinStatus)) -> TwinStatus {
    let mut status = TwinStatus {
        header: header(),
        state: TwinStatus::RUNNING,
        version: "9.9".into(),
        input_name: vec!["rotary_speed".into(), "weight_on_bit".into()],
        input_state: vec![TwinStatus::INPUT_OK, TwinStatus::INPUT_STALE],
        input_age: vec![0.1, 9.0],
        input_received: vec![8.0, f64::NAN],
        input_applied: vec![8.0, 25e3],
        ..TwinStatus::default()
    };
    change(&mut status);
    status
}

pub fn alarm() -> Alarm {
    Alarm {
        id: "backward_whirl".into(),
        name: "Backward whirl".into(),
        state: Alarm::ACTIVE_UNACKNOWLEDGED,
        priority: Alarm::HIGH,
        active: true,
        measured_depth: 1.5,
        evidence: "Backward whirl of the pipe at 1.5 m.".into(),
        what_to_do: "Lower the speed below 80 r/min.".into(),
        ..Alarm::default()
    }
}

/// A twin that has sent everything once.
pub fn speak(running: &Running) {
    running.send(
        &topics::STATUS,
        &status(|status| status.input_state[1] = TwinStatus::INPUT_OK),
    );
    let bit = BitState {
        header: header(),
        torque: 350.0,
        stick_slip_index: f64::NAN,
        ..BitState::default()
    };
    running.send(&topics::BIT_STATE, &bit);
    let list = AlarmList {
        header: header(),
        alarms: vec![
            alarm(),
            Alarm {
                id: "late".into(),
                name: "Late".into(),
                acknowledged: true,
                ..Alarm::default()
            },
        ],
        unacknowledged: 1,
        ..AlarmList::default()
    };
    running.send(&topics::ALARMS, &list);
    let hook_load = Residual {
        name: "hook_load".into(),
        unit: "N".into(),
        measured: 412e3,
        predicted: 400e3,
        low: 390e3,
        high: 410e3,
        ratio: 1.2,
        ..Residual::default()
    };
    let residuals = Residuals {
        header: header(),
        residuals: vec![hook_load],
        steady: true,
        ..Residuals::default()
    };
    running.send(&topics::RESIDUALS, &residuals);
    let window = SafeWindow {
        header: header(),
        rotary_speed_rpm: vec![40.0, 80.0],
        weight_on_bit_kn: vec![20.0],
        verdict: vec![SafeWindow::CLEAR, SafeWindow::ALARM],
        chance: vec![0.0, 0.7],
        limit: 0.05,
        ..SafeWindow::default()
    };
    running.send(&topics::SAFE_WINDOW, &window);
}
