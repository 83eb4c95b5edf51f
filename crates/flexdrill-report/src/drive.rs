//! The inputs, and the part of the torque that reached the bit.

use std::collections::BTreeMap;

use crate::history::{HELD, History, Range};
use crate::shares::Shares;
use flexdrill_core::inputs::InputKind;
use flexdrill_core::units::{kn_to_n, m_per_h_to_m_per_s, mpa_to_pa, rpm_to_rad_per_s};
use flexdrill_messages::{AppliedInputs, BitState, JointDeflections, RigInputs};
use flexdrill_outputs::InputValues as _;

/// Below this speed the drive counts as stopped, and its torque says nothing about transfer (rad/s): 1 r/min.
const STOPPED: f64 = 0.105;
/// Largest number of parameter changes kept.
const CHANGES: usize = 200;

/// Rotary speed and weight on bit in SI.
#[derive(Debug, Default)]
pub(crate) struct InputPair {
    pub rotary_speed: History,
    pub weight_on_bit: History,
}

/// An optional input over time, SI.
#[derive(Debug, Default)]
pub(crate) struct OptionalInput {
    /// As received from the rig.
    pub received: History,
    /// As accepted by the twin, or assumed, before the slew limit.
    pub accepted: History,
}

impl OptionalInput {
    /// Whether it acted or was sent.
    pub(crate) fn concerns(&self) -> bool {
        let acted = |range: &Range| range.min != 0.0 || range.max != 0.0;
        self.received.range().is_some() || self.accepted.range().as_ref().is_some_and(acted)
    }
}

/// A change of a parameter during the run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ParameterChange {
    /// s from the beginning.
    pub time: f64,
    pub name: String,
    pub value: f64,
}

/// Mean torques over the time in which the drive turns.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct TorqueMeans {
    /// Integral of the torque at the uppermost joint (N m s).
    top: f64,
    /// Integral of the torque at the bit (N m s).
    bit: f64,
    /// Time in which the drive turned (s).
    time: f64,
    /// Time (s) of the last message, and its torques if the drive turned.
    last: Option<(f64, Option<[f64; 2]>)>,
}

impl TorqueMeans {
    /// Mean torque at the uppermost joint and of the bit (N m); `None` when the drive never turned.
    pub(crate) fn means(&self) -> Option<[f64; 2]> {
        (self.time > 0.0).then(|| [self.top / self.time, self.bit / self.time])
    }

    /// Adds the torques of an instant (s), `None` while the drive is stopped. They hold until the next instant.
    fn push(&mut self, time: f64, torques: Option<[f64; 2]>) {
        if let Some((before, Some([top, bit]))) = self.last {
            let held = (time - before).clamp(0.0, HELD);
            self.top += top * held;
            self.bit += bit * held;
            self.time += held;
        }
        self.last = Some((time, torques));
    }
}

/// Inputs, bit and torque over time.
#[derive(Debug, Default)]
pub(crate) struct Drive {
    /// Inputs as received from the rig.
    pub received: InputPair,
    /// Inputs as accepted by the twin, before the slew limit.
    pub accepted: InputPair,
    /// Rate of penetration (m/s).
    pub rate_of_penetration: OptionalInput,
    /// Standpipe pressure (Pa).
    pub standpipe_pressure: OptionalInput,
    /// Speed of the bit (rad/s), weight on it (N).
    pub bit: InputPair,
    /// Torque through the uppermost joint (N m).
    pub top_torque: History,
    pub bit_torque: History,
    pub stick_slip: History,
    pub lateral_acceleration: History,
    pub transfer: TorqueMeans,
    /// The worst state of the inputs.
    pub input_quality: Shares,
    pub changes: Vec<ParameterChange>,
    /// Number of further changes.
    pub more_changes: u64,
    pub resets: u64,
    newest_bit_torque: Option<f64>,
    known: BTreeMap<String, f64>,
}

impl Drive {
    pub(crate) fn rig_inputs(&mut self, time: f64, message: &RigInputs) {
        let value = |kind| message.value(kind).unwrap_or(f64::NAN);
        self.received_speed(time, value(InputKind::RotarySpeed));
        self.received_weight(time, value(InputKind::WeightOnBit));
        self.received_rate(time, value(InputKind::RateOfPenetration));
        self.received_pressure(time, value(InputKind::StandpipePressure));
    }

    pub(crate) fn received_speed(&mut self, time: f64, rpm: f64) {
        self.received.rotary_speed.push(time, rpm_to_rad_per_s(rpm));
    }

    pub(crate) fn received_weight(&mut self, time: f64, kn: f64) {
        self.received.weight_on_bit.push(time, kn_to_n(kn));
    }

    pub(crate) fn received_rate(&mut self, time: f64, m_per_h: f64) {
        self.rate_of_penetration
            .received
            .push(time, m_per_h_to_m_per_s(m_per_h));
    }

    pub(crate) fn received_pressure(&mut self, time: f64, mpa: f64) {
        self.standpipe_pressure.received.push(time, mpa_to_pa(mpa));
    }

    pub(crate) fn applied(&mut self, time: f64, message: &AppliedInputs) {
        self.accepted.rotary_speed.push(time, message.rotary_speed);
        self.accepted.weight_on_bit.push(time, message.weight_on_bit);
        self.rate_of_penetration
            .accepted
            .push(time, message.rate_of_penetration);
        self.standpipe_pressure.accepted.push(time, message.standpipe_pressure);
        self.input_quality.push(time, message.input_quality);
        self.resets += u64::from(message.reset);
        for (name, value) in message.parameter_name.iter().zip(&message.parameter_value) {
            // The twin repeats all values every second; only a different value is a change.
            if self.known.get(name) == Some(value) {
                continue;
            }
            if self.changes.len() == CHANGES {
                self.more_changes += 1;
                continue;
            }
            self.known.insert(name.clone(), *value);
            self.changes.push(ParameterChange {
                time,
                name: name.clone(),
                value: *value,
            });
        }
    }

    pub(crate) fn bit(&mut self, time: f64, message: &BitState) {
        self.bit.rotary_speed.push(time, message.rotary_speed);
        self.bit.weight_on_bit.push(time, message.weight_on_bit);
        self.bit_torque.push(time, message.torque);
        self.stick_slip.push(time, message.stick_slip_index);
        self.lateral_acceleration.push(time, message.lateral_acceleration_peak);
        self.newest_bit_torque = Some(message.torque);
    }

    pub(crate) fn joints(&mut self, time: f64, message: &JointDeflections) {
        let (Some(&torque), Some(&spin)) = (message.torque.first(), message.spin_rate.first()) else {
            return;
        };
        self.top_torque.push(time, torque);
        let bit = self.newest_bit_torque.filter(|bit| (bit + torque).is_finite());
        let torques = bit.filter(|_| spin.abs() > STOPPED).map(|bit| [torque, bit]);
        self.transfer.push(time, torques);
    }

    /// The time in which the inputs and the bit's motion are all known (s), so that their means can be compared; `None`
    /// if there is none.
    pub(crate) fn common_window(&self) -> Option<[f64; 2]> {
        let pairs = [&self.received, &self.accepted, &self.bit];
        let spans = pairs.iter().flat_map(|pair| [&pair.rotary_speed, &pair.weight_on_bit]);
        let window = spans
            .filter_map(History::span)
            .reduce(|[from, to], [begin, end]| [from.max(begin), to.min(end)]);
        window.filter(|[from, to]| to > from)
    }
}
