//! The top drive: an inertia that a speed controller turns, with a limit on its torque.
//!
//! ```text
//! J w' = M - z (w - 2 g)        M = P (w_set - w) + I int (w_set - w) dt        |M| <= M_max
//! ```
//!
//! z is the impedance of the string's first piece and g the wave that arrives from below. A drive with P near z takes up
//! the waves that it would otherwise send back (Kyllingstad and Nessjoen, SPE 119660, 2009: soft torque).

use serde::{Deserialize, Serialize};

use crate::tool::description::{SpeedController, TopDrive};

/// How the drive moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct DriveState {
    /// Speed (rad/s).
    pub speed: f64,
    /// Torque of the motor (N m).
    pub torque: f64,
    /// Integral of the speed that is missing (rad).
    pub missing: f64,
    /// Speed that was asked for (rad/s).
    pub asked: f64,
    /// Torque that the string takes (N m).
    pub load: f64,
}

impl TopDrive {
    /// The drive turning steadily at `speed` (rad/s) against `torque` (N m).
    pub fn steady(&self, speed: f64, torque: f64) -> DriveState {
        let missing = match self {
            Self::Controlled(controller) if controller.integral > 0.0 => torque / controller.integral,
            _ => 0.0,
        };
        DriveState {
            speed,
            torque,
            missing,
            asked: speed,
            load: torque,
        }
    }

    /// The drive a step `h` (s) later, by the trapezoid rule: `asked` is the speed asked for (rad/s) and `arriving` the wave
    /// from below (rad/s) at the end of the step, `impedance` that of the string (N m s).
    pub fn step(&self, from: &DriveState, h: f64, asked: f64, arriving: f64, impedance: f64) -> DriveState {
        // The string answers the drive by its impedance and the wave that has arrived.
        let load_at = |speed: f64| impedance * (speed - 2.0 * arriving);
        // A rigid drive has the speed that is asked for, whatever the torque.
        let Self::Controlled(controller) = self else {
            let load = load_at(asked);
            return DriveState {
                speed: asked,
                torque: load,
                missing: 0.0,
                asked,
                load,
            };
        };
        let SpeedController {
            inertia,
            proportional,
            integral,
            torque_limit,
        } = *controller;
        // J (w1 - w0) = h/2 (M0 - L0 + M1 - L1) with M1 = base - gain w1, linear in w1.
        let speed_under = |base: f64, gain: f64| {
            let pushed = inertia * from.speed + 0.5 * h * (from.torque - from.load + base + 2.0 * impedance * arriving);
            pushed / (inertia + 0.5 * h * (gain + impedance))
        };
        // The integral at the end of the step depends on the speed at its end, so both are solved together.
        let half = 0.5 * h * integral;
        let held = integral * from.missing;
        let base = held + half * (from.asked - from.speed + asked) + proportional * asked;
        let gain = proportional + half;
        let speed = speed_under(base, gain);
        let torque = base - gain * speed;
        let missing = from.missing + 0.5 * h * (from.asked - from.speed + asked - speed);
        // Within the limit the solution stands.
        if torque.abs() <= torque_limit {
            return DriveState {
                speed,
                torque,
                missing,
                asked,
                load: load_at(speed),
            };
        }
        // At its limit the motor's torque is known. The integral does not wind up meanwhile.
        let torque = torque_limit.copysign(torque);
        let speed = speed_under(torque, 0.0);
        DriveState {
            speed,
            torque,
            missing: from.missing,
            asked,
            load: load_at(speed),
        }
    }

    /// Kinetic energy of the drive (J).
    pub fn energy(&self, state: &DriveState) -> f64 {
        match self {
            Self::Rigid => 0.0,
            Self::Controlled(controller) => 0.5 * controller.inertia * state.speed * state.speed,
        }
    }

    /// Whether the torque is at its limit.
    pub fn is_at_limit(&self, state: &DriveState) -> bool {
        match self {
            Self::Rigid => false,
            Self::Controlled(controller) => state.torque.abs() >= controller.torque_limit,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Amplitude of the wave that a drive sends back for one that arrives with amplitude 1 at `omega` (rad/s).
    fn reflected(drive: TopDrive, impedance: f64, omega: f64) -> f64 {
        let h = TAU / omega / 2000.0;
        let mut state = drive.steady(0.0, 0.0);
        let (mut sine, mut cosine) = (0.0, 0.0);
        // Twenty periods for what the start excites, then ten that are measured.
        for step in 1..=60_000_u32 {
            let phase = omega * h * f64::from(step);
            let arriving = phase.sin();
            state = drive.step(&state, h, 0.0, arriving, impedance);
            let sent = state.speed - arriving;
            if step > 40_000 {
                sine += sent * phase.sin();
                cosine += sent * phase.cos();
            }
        }
        (sine * sine + cosine * cosine).sqrt() / 10_000.0
    }

    /// What a top drive sends back of a torsional wave: r = (Z - z) / (Z + z) with Z = i omega J + P + I / (i omega),
    /// Kyllingstad and Nessjoen, SPE 119660, at omega^2 = I / J: 0 for P = z, 0.6 for P = 4 z, 1 for a stiff drive.
    /// Tolerance 1e-3: the trapezoid rule's (omega h)^2 / 12 = 1e-6, times J omega / z = 21, and what the start leaves.
    #[test]
    fn analytic_reflection_at_the_drive() {
        use crate::support::scaled_figure;
        let (impedance, omega, inertia) = (47.770, 5.0, 200.0);
        let drive = |proportional: f64| {
            TopDrive::Controlled(SpeedController {
                inertia,
                proportional,
                integral: inertia * omega * omega,
                torque_limit: 1e9,
            })
        };
        for (of, drive, expected) in [
            ("P = z", drive(impedance), 0.0),
            ("P = 4 z", drive(4.0 * impedance), 0.6),
            ("P = 1e9 N m s", drive(1e9), 1.0),
            ("a rigid drive", TopDrive::Rigid, 1.0),
        ] {
            scaled_figure(
                &format!("|r| for {of} (-)"),
                expected,
                reflected(drive, impedance, omega),
                1.0,
                1e-3,
            );
        }
    }

    #[test]
    fn the_torque_stays_within_its_limit_and_recovers_without_wind_up() {
        let drive = TopDrive::Controlled(SpeedController {
            inertia: 50.0,
            proportional: 200.0,
            integral: 100.0,
            torque_limit: 60.0,
        });
        let mut state = drive.steady(0.0, 0.0);
        for _ in 0..20_000 {
            state = drive.step(&state, 1e-3, 4.0, -1.0, 48.0);
            assert!(state.torque <= 60.0);
        }
        // z (w - 2 g) = M_max: 48 (w + 2) = 60.
        assert!(
            drive.is_at_limit(&state) && (state.speed - (60.0 / 48.0 - 2.0)).abs() < 1e-6,
            "{state:?}"
        );
        let mut most = 0.0_f64;
        for _ in 0..60_000 {
            state = drive.step(&state, 1e-3, 4.0, 2.0, 48.0);
            most = most.max(state.speed);
        }
        assert!((state.speed - 4.0).abs() < 1e-3, "{state:?}");
        // A wound-up integral would have driven it far beyond the speed asked for.
        assert!(most < 5.0, "{most} rad/s");
    }
}
