//! The action `~/what_if` over DDS, as the action clients of ROS 2 use it: a goal, its feedback, its state and its result;
//! goals that cannot be answered, that wait, and that are cancelled.

use std::time::{Duration, Instant};

use crate::common::{Network, Peer, Program, small_config};
use flexdrill::messages::action_msgs::GoalStatus;
use serde_json::{Value, json};

const ACTION: &str = "/flexdrill/what_if/_action";
const TYPE: &str = "flexdrill/action/WhatIf";

fn candidate(rpm: f64, kn: f64) -> Value {
    json!({"rotary_speed": rpm, "weight_on_bit": kn})
}

fn id(number: u8) -> Value {
    json!({"uuid": vec![number; 16]})
}

/// Sends a goal; whether it was accepted.
fn send(peer: &mut Peer, number: u8, goal: Value) -> bool {
    let request = json!({"goal_id": id(number), "goal": goal});
    let reply = peer.call(&format!("{ACTION}/send_goal"), &format!("{TYPE}_SendGoal"), request);
    reply["accepted"].as_bool().unwrap()
}

/// Waits for the end of a goal; its state and result.
fn result(peer: &mut Peer, number: u8) -> (i64, Value) {
    let reply = peer.command(json!({
        "do": "call",
        "service": format!("{ACTION}/get_result"),
        "type": format!("{TYPE}_GetResult"),
        "request": {"goal_id": id(number)},
        "seconds": 50.0,
    }))["reply"]
        .clone();
    (reply["status"].as_i64().unwrap(), reply["result"].clone())
}

fn cancel(peer: &mut Peer, number: u8) -> (i64, usize) {
    let request = json!({"goal_info": {"goal_id": id(number)}});
    let reply = peer.call(&format!("{ACTION}/cancel_goal"), "action_msgs/srv/CancelGoal", request);
    (
        reply["return_code"].as_i64().unwrap(),
        reply["goals_canceling"].as_array().unwrap().len(),
    )
}

#[test]
fn a_goal_is_answered_while_the_live_run_goes_on() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let feedback = format!("{ACTION}/feedback");
    peer.subscribe(&feedback, &format!("{TYPE}_FeedbackMessage"), "reliable");
    peer.send("/rig/rotary_speed_rpm", json!(60.0));
    peer.send("/rig/weight_on_bit_kn", json!(5.0));

    let goal = json!({
        "candidates": [candidate(60.0, 5.0), candidate(90.0, 8.0)], "horizon": 10.0, "members": 3, "run_all": true, "seed": 5,
    });
    assert!(send(&mut peer, 1, goal.clone()));
    assert!(!send(&mut peer, 1, goal), "an identifier is used once");
    let (status, answer) = result(&mut peer, 1);
    assert_eq!(status, i64::from(GoalStatus::STATUS_SUCCEEDED), "{answer}");
    assert_eq!(answer["complete"], true);
    let answers = answer["answers"].as_array().unwrap();
    assert_eq!(answers.len(), 2);
    for (of, rpm) in answers.iter().zip([60.0, 90.0]) {
        assert_eq!(of["candidate"]["rotary_speed"], rpm);
        assert_eq!((&of["members"], &of["failed"]), (&json!(3), &json!(0)), "{of}");
        let chance = of["any_alarm"].as_f64().unwrap();
        assert!(of["any_alarm_lower"].as_f64().unwrap() <= chance && chance <= of["any_alarm_upper"].as_f64().unwrap());
        let force = &of["figures"][1];
        assert_eq!(
            (&force["name"], &force["unit"]),
            (&json!("pipe_guide_force"), &json!("N"))
        );
        assert!(force["p50"].as_f64().unwrap() > 0.0, "{force}");
        // Nothing says which shape the guide of this tool was made with.
        assert_eq!(of["hole_known"], false, "{of}");
        let because = of["hole_because"].as_str().unwrap();
        assert!(
            !because.is_empty() && !because.contains("comes with the result"),
            "{because}"
        );
    }
    assert!(
        answer["message"].as_str().unwrap().contains("60 r/min and 5 kN"),
        "{answer}"
    );
    assert!(answer["from_step"].as_u64().unwrap() > 0 && answer["from_stamp"]["sec"].as_i64().unwrap() > 0);
    let heard = peer.take(&feedback, 1, 5.0);
    let first = heard.first().expect("feedback");
    assert_eq!(first["goal_id"], id(1));
    assert!(first["feedback"]["done"].as_u64().unwrap() >= 1, "{first}");

    // The states are latched: who comes late sees them, the newest last.
    let states = format!("{ACTION}/status");
    peer.subscribe(&states, "action_msgs/msg/GoalStatusArray", "latched");
    let seen = peer.take(&states, 10, 2.0);
    let last = &seen.last().expect("states")["status_list"][0];
    assert_eq!(
        (&last["goal_info"]["goal_id"], &last["status"]),
        (&id(1), &json!(GoalStatus::STATUS_SUCCEEDED))
    );
    // The result stays for those who ask again, and no other goal has one.
    assert_eq!(result(&mut peer, 1).0, i64::from(GoalStatus::STATUS_SUCCEEDED));
    let (status, unknown) = result(&mut peer, 77);
    assert_eq!(status, i64::from(GoalStatus::STATUS_UNKNOWN));
    assert!(unknown["message"].as_str().unwrap().contains("no such goal"));
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
}

#[test]
fn goals_out_of_bounds_are_not_accepted_and_cancelled_ones_end_at_once() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let mut twin = network.twin(&[]);
    twin.wait_for("model time runs");
    let asked = |horizon: f64, rpm: f64| json!({"candidates": [candidate(rpm, 5.0)], "horizon": horizon, "members": 200, "run_all": true, "seed": 5});
    for (number, goal, words) in [
        (1, asked(1e9, 60.0), "give 10 to 600 s"),
        (2, asked(30.0, 1e6), "inputs.rotary_speed"),
        (3, json!({"horizon": 30.0, "members": 1}), "1 to 16"),
    ] {
        assert!(!send(&mut peer, number, goal));
        // ROS 2 has no words for a refusal; who asks for the result gets them.
        let (status, answer) = result(&mut peer, number);
        assert_eq!(status, i64::from(GoalStatus::STATUS_UNKNOWN), "{answer}");
        let message = answer["message"].as_str().unwrap();
        assert!(
            message.contains("was not accepted") && message.contains(words),
            "{answer}"
        );
    }
    // The log has one line of the kind in ten seconds.
    assert!(
        twin.said().contains("a goal is refused: a horizon of"),
        "{}",
        twin.said()
    );

    // One runs, four wait, the sixth is refused; all are cancelled at once.
    for number in 10..15 {
        assert!(send(&mut peer, number, asked(300.0, 60.0)), "{number}");
    }
    assert!(!send(&mut peer, 15, asked(300.0, 60.0)));
    let told = Instant::now();
    assert_eq!(cancel(&mut peer, 10), (0, 1));
    let (status, answer) = result(&mut peer, 10);
    assert_eq!(status, i64::from(GoalStatus::STATUS_CANCELED), "{answer}");
    assert!(answer["complete"] == false && answer["message"].as_str().unwrap().starts_with("cancelled"));
    // A busy machine gets ten times the half second that clients are promised.
    assert!(told.elapsed().as_secs_f64() < 5.0);
    assert_eq!(cancel(&mut peer, 99), (2, 0));
    let request = json!({"goal_info": {}});
    let all = peer.call(&format!("{ACTION}/cancel_goal"), "action_msgs/srv/CancelGoal", request);
    assert_eq!(all["goals_canceling"].as_array().unwrap().len(), 4, "{all}");
    // At least three of them waited, and each has its end in the very next message of states.
    let states = format!("{ACTION}/status");
    peer.subscribe(&states, "action_msgs/msg/GoalStatusArray", "latched");
    let seen = peer.take(&states, 1, 5.0);
    let list = seen.last().unwrap()["status_list"].as_array().unwrap();
    let ended = list
        .iter()
        .filter(|state| state["status"] == json!(GoalStatus::STATUS_CANCELED));
    assert!(ended.count() >= 4, "{list:?}");
    for number in 11..15 {
        let (status, answer) = result(&mut peer, number);
        assert_eq!(status, i64::from(GoalStatus::STATUS_CANCELED));
        assert!(answer["message"].as_str().unwrap().starts_with("cancelled"), "{answer}");
    }

    // A client that ends right after its goal was accepted has heard that it runs, and can cancel it.
    peer.take(&states, 1000, 0.0);
    assert!(send(&mut peer, 19, asked(300.0, 60.0)));
    let accepted = Instant::now();
    let runs = |message: &Value| {
        let list = message["status_list"].as_array().unwrap();
        list.iter().any(|state| {
            state["goal_info"]["goal_id"] == id(19) && state["status"] == json!(GoalStatus::STATUS_EXECUTING)
        })
    };
    peer.take(&states, 1000, 0.0);
    while !peer.take(&states, 1, 1.0).iter().any(runs) {
        // Two signs; a busy machine gets ten times that.
        assert!(accepted.elapsed().as_secs_f64() < 4.0, "no state after the reply");
    }
    assert_eq!(cancel(&mut peer, 19), (0, 1));

    // The answer of a paused twin says so.
    let paused = peer.call("/flexdrill/pause", "std_srvs/srv/SetBool", json!({"data": true}));
    assert_eq!(paused["success"], true, "{paused}");
    let short = json!({"candidates": [candidate(60.0, 5.0)], "horizon": 10.0, "members": 1});
    assert!(send(&mut peer, 21, short));
    let (status, answer) = result(&mut peer, 21);
    assert_eq!(status, i64::from(GoalStatus::STATUS_SUCCEEDED), "{answer}");
    assert!(
        answer["message"].as_str().unwrap().starts_with("the twin is paused"),
        "{answer}"
    );

    // A goal that runs does not hold up the end of the node.
    assert!(send(&mut peer, 20, asked(300.0, 60.0)));
    let told = Instant::now();
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
    assert!(told.elapsed().as_secs_f64() < 15.0);
}

/// Deadlines of the live run of the whole tool while goals are answered all the time, on one core and on two, in turn with
/// the same time without a goal:
///
///     cargo test --release --test node what_if::deadlines -- --ignored --nocapture
#[test]
#[ignore = "measures for five minutes; run it alone"]
fn deadlines_while_looking_ahead() {
    for cores in ["0", "0,1"] {
        let Some(network) = Network::new() else { return };
        let Some(mut peer) = network.peer() else { return };
        let mut command = network.command("taskset");
        command.args(["-c", cores, env!("CARGO_BIN_EXE_flexdrill"), "run"]);
        command.args(["--config", "config/default.yaml"]);
        let mut twin = Program::start(command);
        twin.wait_for("model time runs");
        peer.subscribe("/twin/status", "flexdrill/msg/TwinStatus", "reliable");
        let drill = |peer: &mut Peer| {
            peer.send("/rig/rotary_speed_rpm", json!(60.0));
            peer.send("/rig/weight_on_bit_kn", json!(10.0));
        };
        // Late periods and skipped steps so far.
        let counted = |peer: &mut Peer| {
            let status = peer.status_with("/twin/status", |status| status["deadline_misses"].is_u64());
            ["deadline_misses", "steps_skipped"].map(|name| status[name].as_u64().unwrap())
        };
        let more = |before: [u64; 2], after: [u64; 2]| [after[0] - before[0], after[1] - before[1]];
        drill(&mut peer);
        // The tool gets from rest to its motion.
        std::thread::sleep(Duration::from_secs(10));
        let feedback = format!("{ACTION}/feedback");
        peer.subscribe(&feedback, &format!("{TYPE}_FeedbackMessage"), "reliable");
        let (mut alone, mut with_goals, mut members) = (Vec::new(), Vec::new(), 0);
        let (mut first, mut whole) = (Vec::new(), Vec::new());
        for number in 1..=8 {
            drill(&mut peer);
            let before = counted(&mut peer);
            let begun = Instant::now();
            let goal = json!({
                "candidates": [candidate(60.0, 10.0)], "horizon": 10.0, "members": 6, "run_all": true, "seed": number,
            });
            assert!(send(&mut peer, number, goal));
            assert_eq!(peer.take(&feedback, 1, 30.0).len(), 1, "no member ended");
            first.push(begun.elapsed().as_secs_f64());
            let (_, answer) = result(&mut peer, number);
            peer.take(&feedback, 100, 0.1);
            members += answer["answers"][0]["members"].as_u64().unwrap();
            let took = begun.elapsed();
            let after = counted(&mut peer);
            with_goals.push(more(before, after));
            whole.push(took.as_secs_f64());
            drill(&mut peer);
            std::thread::sleep(took);
            alone.push(more(after, counted(&mut peer)));
        }
        println!(
            "cores {cores}: {members} members of 10 s; first answer after {first:.1?} s, the whole after {whole:.1?} s"
        );
        println!("late periods and skipped steps");
        println!("  with a goal    {with_goals:?}");
        println!("  without a goal {alone:?}");
        twin.signal("TERM");
        assert_eq!(twin.end(), Some(0));
    }
}

/// The forecast over DDS: bands of a minute, a chance for every alarm, and the second one compared with what came.
#[test]
fn a_forecast_comes_every_half_minute_and_is_compared_with_what_came() {
    let Some(network) = Network::new() else { return };
    let Some(mut peer) = network.peer() else { return };
    let text = std::fs::read_to_string(small_config()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("forecast.yaml");
    std::fs::write(
        &file,
        format!("{text}\nlook_ahead: {{forecast: true, forecast_members: 2}}\n"),
    )
    .unwrap();
    let bag = folder.path().join("run.mcap");
    let mut command = network.command(env!("CARGO_BIN_EXE_flexdrill"));
    command.args(["run", "--config"]).arg(&file).arg("--record").arg(&bag);
    let mut twin = Program::start(command);
    twin.wait_for("model time runs");
    // Without inputs the tool stands, and speed and weight stay.
    peer.subscribe("/twin/forecast", "flexdrill/msg/Forecast", "latched");
    // The first is made at once; a busy machine gets a minute for each.
    let first = peer.take("/twin/forecast", 1, 60.0);
    let first = first.last().expect("a forecast");
    assert_eq!((&first["members"], &first["failed"]), (&json!(2), &json!(0)), "{first}");
    let bands = first["bands"].as_array().unwrap();
    let names: Vec<&str> = bands.iter().map(|band| band["name"].as_str().unwrap()).collect();
    assert_eq!(
        names,
        [
            "bit_speed",
            "bit_torque",
            "weight_on_bit",
            "pipe_guide_force",
            "guide_wall_force"
        ]
    );
    for band in bands {
        let edge = |name: &str| -> Vec<f64> { serde_json::from_value(band[name].clone()).unwrap() };
        let (low, median, high) = (edge("p5"), edge("p50"), edge("p95"));
        assert_eq!((low.len(), median.len(), high.len()), (60, 60, 60));
        let in_order = |at: usize| low[at] <= median[at] && median[at] <= high[at];
        assert!((0..60).all(in_order), "{band}");
    }
    let seconds = |time: &Value| time["sec"].as_f64().unwrap() + 1e-9 * time["nanosec"].as_f64().unwrap();
    let ahead = seconds(&first["bands_from"]) - seconds(&first["header"]["stamp"]);
    assert!((0.0..=1.0).contains(&ahead), "{ahead}");
    let lower = first["any_alarm_lower"].as_f64().unwrap();
    assert!(lower <= first["any_alarm"].as_f64().unwrap(), "{first}");
    // The next one knows how the first one did.
    let second = peer.take("/twin/forecast", 1, 100.0);
    let second = second.last().expect("another forecast");
    let apart = seconds(&second["header"]["stamp"]) - seconds(&first["header"]["stamp"]);
    assert!(apart >= 20.0, "{apart} s apart");
    let torque = &second["bands"][1];
    let compared = torque["compared"].as_u64().unwrap();
    assert!((10..=60).contains(&compared), "{torque}");
    assert!(torque["inside"].as_u64().unwrap() <= compared);
    twin.signal("TERM");
    assert_eq!(twin.end(), Some(0));
    let recorded = flexdrill::bag::open(&bag).unwrap().map(Result::unwrap);
    assert!(recorded.filter(|message| message.topic.is("twin/forecast")).count() >= 2);
}
