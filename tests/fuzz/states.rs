//! What the program kept for itself, and what it says to its own DDS process: others may have changed it.

use std::sync::Arc;

use flexdrill::alarms::AlarmBook;
use flexdrill::dds::frames::{self, Beat, FromSide, LogLevel, Peer, Peers, RequestId, Stall, ToSide};
use flexdrill::dds::network::{Network, Reach};
use flexdrill::dds::plan::{Offer, Plan, ReaderPlan, ServicePlan, WriterPlan};
use flexdrill::messages::std_msgs::Header;
use flexdrill::state_file;
use flexdrill_alarms::{AlarmSystem, Observation, Priority, Saved};
use flexdrill_config::Config;
use flexdrill_core::inputs::Inputs;
use flexdrill_core::twin::Simulation;
use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest as _, Sha256};

use crate::engine::Target;
use crate::{file, folder, says_why};

fn small() -> Config {
    Config::from_text("small.yaml", &String::from_utf8(file("tests/data/small.yaml")).unwrap()).unwrap()
}

/// The bytes as they come and, as checksums stop nearly all of them, with a checksum that fits.
#[test]
fn checkpoint() {
    let config = small();
    let mut twin = Simulation::new(&config.tool(), &config.simulation()).unwrap();
    let inputs = Inputs {
        rotary_speed: 4.0,
        weight_on_bit: 10e3,
        ..Inputs::default()
    };
    let mut seeds = vec![twin.checkpoint().unwrap()];
    for _ in 0..400 {
        twin.advance(&inputs).ok().unwrap();
    }
    let whole = twin.checkpoint().unwrap();
    seeds.push(whole.clone());
    let mut snapshot = twin.new_snapshot();
    Target {
        name: "checkpoint",
        seeds,
        words: &["flexdrCP"],
        run: &mut |bytes| {
            let mut accepted = match twin.restore(bytes) {
                Ok(()) => true,
                Err(error) => says_why(&error),
            };
            if let Some((content, _)) = bytes.split_last_chunk::<32>() {
                let forged = [content, &Sha256::digest(content)].concat();
                match twin.restore(&forged) {
                    Ok(()) => {
                        // Whatever the state is, a step is a step or has failed.
                        for _ in 0..20 {
                            let _ = twin.advance(&inputs);
                        }
                        twin.snapshot(&mut snapshot, true);
                        accepted = true;
                    }
                    Err(error) => {
                        says_why(&error);
                    }
                }
            }
            twin.restore(&whole).unwrap();
            assert!(
                twin.checkpoint().unwrap() == whole,
                "a good checkpoint does not bring everything back"
            );
            accepted
        },
    }
    .fuzz();
}

/// All alarms come, go and are told.
fn live(saved: &Saved, config: &Arc<Config>, ids: &[&'static str]) {
    for time in [0, 1_700_000_000_000_000_000] {
        match AlarmBook::new(Arc::clone(config), Some(saved), time) {
            Ok(mut book) => {
                book.advance(time + 1_000_000_000);
                book.list(Header::default());
                book.figures();
                assert_eq!(Some(book.save()).as_ref().map(|_| ()), Some(()));
            }
            Err(error) => {
                says_why(&error);
            }
        }
        let definitions = ids.iter().map(|id| flexdrill_alarms::Definition {
            id,
            delays: flexdrill_alarms::Delays::default(),
            in_service: true,
        });
        let mut system = AlarmSystem::new(definitions.collect(), 60.0);
        if system.restore(saved).is_err() {
            continue;
        }
        let mut events = Vec::new();
        for (second, priority) in [Some(Priority::Low), Some(Priority::High), None, Some(Priority::Medium)]
            .into_iter()
            .enumerate()
        {
            let observed = Observation {
                priority,
                suppressed: second == 3,
                evidence: "a test",
            };
            for index in 0..ids.len() {
                system.observe(index, time + second as i64 * 1_000_000_000, &observed, &mut events);
            }
            system.advance(time + second as i64 * 1_000_000_000, &mut events);
        }
        system.statistics().figures();
    }
}

#[test]
fn alarm_state() {
    let config = Arc::new(small());
    let ids = flexdrill::alarms::AlarmId::ALL.map(|id| id.id());
    let folder = folder();
    let (path, again) = (folder.path().join("state.json"), folder.path().join("again.json"));
    let fresh = AlarmBook::fresh(Arc::clone(&config), 1_700_000_000_000_000_000).save();
    let definitions = ids.map(|id| flexdrill_alarms::Definition {
        id,
        delays: flexdrill_alarms::Delays::default(),
        in_service: true,
    });
    let mut busy = AlarmSystem::new(definitions.to_vec(), 60.0);
    for index in 0..5 {
        let observed = Observation {
            priority: Some(Priority::High),
            suppressed: false,
            evidence: "a test",
        };
        busy.observe(index, 1_700_000_000_000_000_000, &observed, &mut Vec::new());
    }
    let seeds = [fresh, busy.save()].map(|saved| {
        state_file::write(&path, &saved).unwrap();
        std::fs::read(&path).unwrap()
    });
    Target {
        name: "alarm_state",
        seeds: seeds.to_vec(),
        words: &[
            "null",
            "[",
            "]",
            "{",
            "}",
            ",",
            ":",
            "\"",
            "\"High\"",
            "\"Low\"",
            "-1",
            "true",
            "[[[[[[[[[[",
            "9223372036854775807",
        ],
        run: &mut |bytes| {
            std::fs::write(&path, bytes).unwrap();
            let saved: flexdrill_alarms::Saved = match state_file::read(&path) {
                Ok(saved) => saved.unwrap(),
                Err(error) => return says_why(&error),
            };
            state_file::write(&again, &saved).unwrap();
            assert_eq!(state_file::read(&again).unwrap().as_ref(), Some(&saved));
            live(&saved, &config, &ids);
            true
        },
    }
    .fuzz();
}

/// All frames of a stream up to its end or what is no frame; those that are frames come out as they went in.
fn frames_of<T: DeserializeOwned + Serialize>(bytes: &[u8]) -> bool {
    let mut from = bytes;
    loop {
        match frames::read::<T>(&mut from) {
            Ok(Some(frame)) => {
                let written = frames::encode(&frame).unwrap();
                let again: T = frames::read(&mut written.as_slice()).unwrap().unwrap();
                assert!(frames::encode(&again).unwrap() == written, "another frame");
            }
            Ok(None) => return true,
            Err(error) => return says_why(&error),
        }
    }
}

fn stream<T: Serialize>(frames: &[T]) -> Vec<u8> {
    frames.iter().flat_map(|frame| frames::encode(frame).unwrap()).collect()
}

/// Whether the stream is of either direction.
#[test]
fn frames() {
    let peer = Peer {
        id: [7; 16],
        node: Some("/plot".into()),
        address: Some("10.0.0.3".into()),
    };
    let plan = Plan {
        network: Network {
            domain_id: 3,
            reach: Reach::Subnet,
            interfaces: vec!["10.0.0.1".parse().unwrap(), "::1".parse().unwrap()],
            peers: vec!["plot.lan".to_owned(), "10.0.0.7".to_owned()],
            keys: None,
        },
        namespace: "/rig_7".into(),
        node: "flexdrill".into(),
        writers: vec![WriterPlan {
            topic: "/twin/status".into(),
            dds_type: "flexdrill::msg::dds_::TwinStatus_".into(),
            offer: Offer {
                reliable: true,
                latched: true,
                depth: 1,
                rate: 50.0,
                lifespan: Some(1.0),
            },
        }],
        readers: vec![ReaderPlan {
            topic: "/rig/rotary_speed_rpm".into(),
            dds_type: "std_msgs::msg::dds_::Float64_".into(),
            latched: false,
            reliable: false,
        }],
        services: vec![ServicePlan {
            name: "/flexdrill/reset".into(),
            ros_type: "std_srvs/srv/Trigger".into(),
        }],
        former: vec![[1; 12]],
    };
    let id = RequestId {
        writer: [5; 16],
        number: 1 << 40,
    };
    let to = stream(&[
        ToSide::Begin(plan),
        ToSide::Publish {
            writer: 1,
            body: vec![3; 40],
        },
        ToSide::Reply {
            service: 2,
            to: id,
            body: vec![1; 5],
        },
        ToSide::End,
    ]);
    let from = stream(&[
        FromSide::Up([9; 12]),
        FromSide::Failed("it is sick".into()),
        FromSide::Sample {
            reader: 1,
            writer: [2; 16],
            body: vec![0; 8],
        },
        FromSide::Unreadable {
            reader: 0,
            why: "no sample".into(),
        },
        FromSide::Request {
            service: 1,
            id,
            client: Peer {
                id: [3; 16],
                node: Some("/rqt".into()),
                address: None,
            },
            sequence: 5,
            sent: Some(1_700_000_000_000_000_000),
            body: vec![1; 20],
        },
        FromSide::Replied { service: 1, to: id },
        FromSide::Beat(Beat {
            written: vec![(1, 2), (3, 4)],
            memory: 18 << 20,
        }),
        FromSide::Peers(Peers {
            writers: vec![vec![peer.clone()], vec![]],
            readers: vec![1, 2],
            namesakes: vec![peer.clone()],
        }),
        FromSide::Log {
            level: LogLevel::Info,
            text: "a line".into(),
        },
        FromSide::Stalled(Stall {
            topic: "/tf".into(),
            readers: vec![peer],
            is_certain: false,
        }),
    ]);
    Target {
        name: "frames",
        seeds: vec![to, from],
        words: &["\u{1}\0\0\0", "\0\0\u{1}\0", "/plot"],
        run: &mut |bytes| {
            let to = frames_of::<ToSide>(bytes);
            frames_of::<FromSide>(bytes) || to
        },
    }
    .fuzz();
}
