//! Lines and cells of the dashboard, the same for the screen and the plain output.

use std::time::{Duration, Instant};

use super::board::{Board, Heartbeat};
use crate::messages::{BitState, ContactForces, Transfer, TwinStatus, WhirlState, WhirlWarning};
use flexdrill_core::inputs::InputKind;
use flexdrill_core::units::{m_per_s_to_m_per_h, n_to_kn, rad_to_deg};
use flexdrill_outputs::words;
use flexdrill_text::percent;

pub(super) fn state(code: u8) -> &'static str {
    match code {
        TwinStatus::STARTING => "STARTING",
        TwinStatus::RUNNING => "RUNNING",
        TwinStatus::PAUSED => "PAUSED",
        TwinStatus::FAILED => "FAILED",
        _ => "?",
    }
}

/// The real-time factor of the model.
pub(super) fn pace(status: &TwinStatus) -> String {
    if status.real_time_factor.is_finite() {
        format!("x{:.3} real time", status.real_time_factor)
    } else {
        "real time not measured yet".to_owned()
    }
}

/// The input's state; in capitals when the model no longer follows the rig.
pub(super) fn input_state(code: u8) -> String {
    let word = words::input_state(code);
    match code {
        TwinStatus::INPUT_STALE | TwinStatus::INPUT_REJECTED => word.to_uppercase(),
        _ => word.to_owned(),
    }
}

pub(super) fn body(code: u8) -> &'static str {
    if code == WhirlState::GUIDE { "guide" } else { "pipe" }
}

pub(super) fn severity(code: u8) -> String {
    words::severity(code).to_uppercase()
}

/// The quality of the model in a word.
pub(super) fn quality(status: &TwinStatus) -> String {
    words::model_quality(status.model_quality).to_uppercase()
}

/// The same with share and cause.
pub(super) fn quality_with_cause(status: &TwinStatus) -> String {
    let share = match status.energy_error_share {
        share if share.is_finite() => format!(", energy error {}", percent(share)),
        _ => String::new(),
    };
    let text = format!("{}{share}", quality(status));
    if status.model_quality_cause.is_empty() {
        return text;
    }
    format!("{text}: {}", status.model_quality_cause)
}

/// The line on a silent twin; none while its heart beats.
pub(super) fn heartbeat(board: &Board, now: Instant) -> Option<String> {
    match board.heartbeat(now) {
        Heartbeat::Beating => None,
        Heartbeat::Waiting(time) => Some(format!("waiting for a twin for {}", lapse(time))),
        Heartbeat::Lost(time) => Some(format!(
            "HEARTBEAT LOST: last message {} ago; the values below are old",
            lapse(time)
        )),
    }
}

fn lapse(time: Duration) -> String {
    format!("{:.0} s", time.as_secs_f64())
}

/// Time in milliseconds or microseconds, for step times and lateness.
pub(super) fn short_time(seconds: f64) -> String {
    if !seconds.is_finite() {
        "-".to_owned()
    } else if seconds < 1e-3 {
        format!("{:.0} us", seconds * 1e6)
    } else if seconds < 1.0 {
        format!("{:.1} ms", seconds * 1e3)
    } else {
        format!("{seconds:.1} s")
    }
}

pub(super) fn force(newton: f64) -> String {
    if newton.abs() < 1e3 {
        format!("{newton:.0} N")
    } else {
        format!("{:.2} kN", n_to_kn(newton))
    }
}

/// Whether the rock decides how fast the bit advances.
fn rock_decides(transfer: &Transfer) -> bool {
    transfer.depth_of_cut.is_finite()
}

/// What drilling comes to: the rate, and how much of the surface's weight and torque the bit has. Without a hoist or a string,
/// weight and torque are those at the kick-off.
pub(super) fn drilling(transfer: &Transfer) -> String {
    let first = |surface: f64, kickoff: f64| if surface.is_finite() { surface } else { kickoff };
    let rate = m_per_s_to_m_per_h(transfer.rate_of_penetration);
    let rate = match rock_decides(transfer) {
        true => format!("drills {} m/h", number(rate)),
        // The rock of this tool holds no bit: the rate is an input.
        false => format!("advances {} m/h as given", number(rate)),
    };
    format!(
        "{rate}   weight {} kN, bit {} kN   torque {:.0} N m, bit {:.0} N m",
        number(n_to_kn(first(transfer.surface_weight, transfer.kickoff_weight))),
        number(n_to_kn(transfer.bit_weight)),
        first(transfer.surface_torque, transfer.kickoff_torque),
        transfer.bit_torque
    )
}

/// One line per input: name, applied value, received value, state, age, refused samples. A rate of penetration that nothing sends
/// and that the rock decides is none.
pub(super) fn inputs(board: &Board) -> Vec<(String, u8)> {
    let Some(status) = board.status() else {
        return Vec::new();
    };
    let is_computed = board.transfer().is_some_and(rock_decides);
    let is_input = |index: usize, name: &String| {
        let is_rate = InputKind::of_name(name) == Some(InputKind::RateOfPenetration);
        let is_assumed = status.input_state.get(index) == Some(&TwinStatus::INPUT_ASSUMED);
        !(is_rate && is_assumed && is_computed)
    };
    status
        .input_name
        .iter()
        .enumerate()
        .filter(|(index, name)| is_input(*index, name))
        .map(|(index, name)| {
            // Arrays of an older twin may be shorter; what they lack is unknown and not zero.
            let at = |values: &[f64]| values.get(index).copied().unwrap_or(f64::NAN);
            let kind = InputKind::of_name(name);
            let convert = |value: f64| kind.map_or(value, |kind| kind.from_si(value));
            let unit = kind.map_or("", InputKind::unit);
            let label = match kind {
                Some(InputKind::RotarySpeed) => "RPM",
                Some(InputKind::WeightOnBit) => "WOB",
                Some(InputKind::RateOfPenetration) => "ROP",
                Some(InputKind::StandpipePressure) => "SPP",
                None => name,
            };
            // `MAX` is no state and is shown as unknown.
            let state = status.input_state.get(index).copied().unwrap_or(u8::MAX);
            let rejected = status.input_rejected.get(index).copied().unwrap_or(0);
            let mut line = format!("{label} {} {unit}", number(convert(at(&status.input_applied))));
            line += &format!(" rx {}", number(convert(at(&status.input_received))));
            line += &format!(" {}", input_state(state));
            let age = at(&status.input_age);
            if age.is_finite() {
                line += &format!(" {age:.1} s");
            }
            if rejected > 0 {
                line += &format!(" ({rejected} refused)");
            }
            // Capitals mark what needs a person: the model no longer follows this input, or two programs send it.
            let flag = |flags: &[bool]| flags.get(index) == Some(&true);
            if flag(&status.input_safe) {
                line += " TO SAFE VALUE";
            }
            if flag(&status.input_suspect) {
                line += " suspect";
            }
            if flag(&status.input_several_drivers) {
                line += " SEVERAL PUBLISHERS";
            }
            (line, state)
        })
        .collect()
}

fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.1}")
    } else {
        "-".to_owned()
    }
}

/// Inclination and depth of a station.
pub(super) fn location(contacts: &ContactForces, station: usize) -> String {
    match (contacts.inclination.get(station), contacts.measured_depth.get(station)) {
        (Some(inclination), Some(depth)) => format!("{:.0} deg, {depth:.2} m", rad_to_deg(*inclination)),
        _ => "?".to_owned(),
    }
}

/// The largest held force of a layer and its location.
pub(super) fn largest(board: &Board, layer: usize) -> String {
    let held = board.peaks()[layer].largest();
    match (held, board.contacts()) {
        (Some((station, newton)), Some(contacts)) => format!("{} at {}", force(newton), location(contacts, station)),
        _ => "no contact".to_owned(),
    }
}

/// The number of joints at their limit, and the bend of the most bent joint.
pub(super) fn joints(board: &Board) -> String {
    let Some(joints) = board.joints() else {
        return "-".to_owned();
    };
    let at = joints.max_bend_joint as usize;
    let limit = joints.limit_angle.get(at).copied().unwrap_or(f64::NAN);
    format!(
        "{} at limit; most bent {:.2} of {:.1} deg, joint {}",
        joints.joints_at_limit,
        rad_to_deg(joints.max_bend_angle),
        rad_to_deg(limit),
        at + 1
    )
}

/// The number of watched stations per kind.
pub(super) fn whirl_counts(whirl: &WhirlState) -> String {
    let count = |kind: u8| whirl.kind.iter().filter(|&&at| at == kind).count();
    format!(
        "forward {} backward {} chaotic {} none {}",
        count(WhirlState::FORWARD),
        count(WhirlState::BACKWARD),
        count(WhirlState::CHAOTIC),
        count(WhirlState::NONE)
    )
}

/// Largest difference of the whirl rate from that of rolling without slip, over the latter, for whirl that is called
/// rolling: the default of the twin.
const ROLLING_TOLERANCE: f64 = 0.15;

/// One row of the whirl table.
pub(super) struct WhirlRow {
    pub(super) location: String,
    pub(super) kind: u8,
    /// The kind in a word; backward whirl that rolls says so.
    pub(super) word: &'static str,
    pub(super) ratio: f64,
    pub(super) clearance_ratio: f64,
    pub(super) contact_duty: f64,
    pub(super) confidence: f64,
}

/// The stations that whirl, the widest orbit first.
pub(super) fn whirl_rows(whirl: &WhirlState) -> Vec<WhirlRow> {
    let at = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(f64::NAN);
    let mut order: Vec<usize> = (0..whirl.kind.len())
        .filter(|&index| whirl.kind[index] != WhirlState::NONE)
        .collect();
    order.sort_by(|&a, &b| at(&whirl.orbit_radius, b).total_cmp(&at(&whirl.orbit_radius, a)));
    order
        .into_iter()
        .map(|index| WhirlRow {
            location: format!(
                "{:>3.0} {}",
                rad_to_deg(at(&whirl.inclination, index)),
                body(whirl.body.get(index).copied().unwrap_or_default())
            ),
            kind: whirl.kind[index],
            word: match (whirl.kind[index], at(&whirl.rolling_share, index)) {
                (WhirlState::BACKWARD, share) if (share - 1.0).abs() <= ROLLING_TOLERANCE => "rolling",
                (kind, _) => words::whirl_kind(kind),
            },
            ratio: at(&whirl.whirl_ratio, index),
            clearance_ratio: at(&whirl.clearance_ratio, index),
            contact_duty: at(&whirl.contact_duty, index),
            confidence: at(&whirl.confidence, index),
        })
        .collect()
}

/// The level of stick-slip with its index, and the code of the level.
pub(super) fn stick_slip(bit: &BitState) -> (String, u8) {
    let text = format!("{} {:.2}", severity(bit.stick_slip_severity), bit.stick_slip_index);
    (text, bit.stick_slip_severity)
}

/// The level of lateral shock with its impulse and, above OK, its location, and the code of the level.
pub(super) fn shock(contacts: &ContactForces) -> (String, u8) {
    let level = contacts.shock_severity;
    let mut text = format!("{} {:.1} N s", severity(level), contacts.shock_impulse);
    if level != ContactForces::SHOCK_OK {
        let layer = words::layer(usize::from(contacts.shock_layer == ContactForces::OUTER));
        text += &format!(" {layer} at {}", location(contacts, contacts.shock_station as usize));
    }
    (text, level)
}

/// The warning as one line.
pub(super) fn warning(warning: Option<&WhirlWarning>) -> String {
    match warning {
        None => "no warning yet".to_owned(),
        Some(warning) if warning.message.is_empty() => severity(warning.severity),
        // The sentence begins with the level.
        Some(warning) => warning.message.clone(),
    }
}
