//! The smallest change of speed or weight that ends an alarm, found by looking ahead.

use std::sync::atomic::{AtomicBool, Ordering};

use super::engine::{CandidateAnswer, Enough, Start, run_goal};
use super::goal::{Candidate, Goal};
use crate::alarms::{AlarmId, Change, Quantity, Tested};
use flexdrill_config::Config;
use flexdrill_core::units::{n_to_kn, rad_per_s_to_rpm};

/// Members that a change has to convince.
const MEMBERS: u32 = 20;
/// Most of them in which the alarm may go on, or another may come: the change then ends it in at least 9 of 10.
const MOST_AGAINST: u32 = 2;
/// Model time over which a change is judged (s): the slowest alarm, stick-slip, needs its window of 10 s and its delays to
/// end within the first half.
const HORIZON: f64 = 30.0;
/// Changes that are tried, as parts of the present value, the smallest first. A larger raise than the last would be another
/// drilling programme.
const LOWER: [f64; 7] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
const RAISE: [f64; 3] = [0.15, 0.3, 0.5];

/// The changes that are tried from a speed (r/min) and a weight (kN), the smallest first. Where two are equally small, less
/// comes before more, and speed before weight: less speed takes energy out of every motion of the tool.
fn changes(config: &Config, rpm: f64, kn: f64) -> Vec<Change> {
    let inputs = &config.inputs;
    let mut found: Vec<(f64, Change)> = Vec::new();
    let parts = LOWER
        .map(|part| (part, -part))
        .into_iter()
        .chain(RAISE.map(|part| (part, part)));
    for (size, part) in parts {
        for (quantity, value, step, [least, most]) in [
            (
                Quantity::Speed,
                rpm,
                1.0,
                [inputs.rotary_speed.min_rpm, inputs.rotary_speed.max_rpm],
            ),
            (
                Quantity::Weight,
                kn,
                0.5,
                [inputs.weight_on_bit.min_kn, inputs.weight_on_bit.max_kn],
            ),
        ] {
            // What a driller can set: whole turns per minute, half kilonewtons.
            let to = (value * (1.0 + part) / step).round() * step;
            if to > 0.0 && to != value && (least..=most).contains(&to) {
                found.push((size, Change { quantity, to }));
            }
        }
    }
    found.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    found.into_iter().map(|(_, change)| change).collect()
}

/// Whether a change ends `alarm` in at least 9 of 10 members and brings no alarm that does not stand already.
fn convinces(answer: &CandidateAnswer, alarm: AlarmId, standing: &[AlarmId]) -> Option<u32> {
    if answer.failed > 0 || answer.members < MEMBERS {
        return None;
    }
    let against = |id: AlarmId| answer.seen(id);
    let others = AlarmId::ALL
        .into_iter()
        .filter(|id| *id != alarm && !standing.contains(id));
    let raised = others.map(against).max().unwrap_or(0);
    let stands = against(alarm);
    (stands <= MOST_AGAINST && raised <= MOST_AGAINST).then_some(MEMBERS - stands)
}

/// The smallest change that ends `alarm` from `start`, where `standing` are the alarms that stand; `None` where none of those
/// tried does, or `stop` was set.
pub fn search(
    start: &Start,
    alarm: AlarmId,
    standing: &[AlarmId],
    seed: u64,
    threads: usize,
    stop: &AtomicBool,
) -> Option<Tested> {
    let inputs = start.applied().inputs;
    let (rpm, kn) = (rad_per_s_to_rpm(inputs.rotary_speed), n_to_kn(inputs.weight_on_bit));
    let enough = Enough::Against {
        alarm,
        standing,
        most: MOST_AGAINST,
    };
    for change in changes(start.config(), rpm, kn) {
        let (rotary_speed, weight_on_bit) = match change.quantity {
            Quantity::Speed => (change.to, kn),
            Quantity::Weight => (rpm, change.to),
        };
        let goal = Goal {
            candidates: vec![Candidate {
                rotary_speed,
                weight_on_bit,
                speed_ramp: 0.0,
                weight_ramp: 0.0,
            }],
            horizon: HORIZON,
            members: MEMBERS,
            run_all: false,
            seed,
        };
        let answer = run_goal(start, &goal, enough, threads, stop, |_| {});
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        if let Some(ended) = convinces(&answer.candidates[0], alarm, standing) {
            return Some(Tested {
                alarm,
                from: [rpm, kn],
                change,
                ended,
                of: MEMBERS,
            });
        }
    }
    None
}
