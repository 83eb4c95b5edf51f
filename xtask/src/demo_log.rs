//! A small synthetic rig log with everything that happens in a real one, for demonstrations without a real one.
//!
//! The same bytes every time. 180 s at 1 Hz with the columns of `config/field_logs/rig_1hz.yaml`: a connection, a
//! run-up off bottom, steps of weight on bit, a stall, a gap, missing codes, a spike, a time that stands still, and the
//! pull off bottom. Its hookload, speeds and noise are made up, of the size of a small rig's.

use std::fmt::Write;

/// Length (s).
const LENGTH: u32 = 180;
/// Hookload in slips and off bottom (klbf).
const IN_SLIPS_KLBF: f64 = 32.0;
const OFF_BOTTOM_KLBF: f64 = 48.0;
const KN_PER_KLBF: f64 = 4.448_221_615_260_5;

/// What the rig does.
struct Phase {
    /// Until this second.
    until: u32,
    /// Codes of the log: 2 drilling, 3 connection, 4 ream.
    state: u32,
    rotary_speed_rpm: f64,
    weight_on_bit_kn: f64,
}

const fn phase(until: u32, state: u32, rotary_speed_rpm: f64, weight_on_bit_kn: f64) -> Phase {
    Phase {
        until,
        state,
        rotary_speed_rpm,
        weight_on_bit_kn,
    }
}

const PHASES: [Phase; 8] = [
    phase(15, 3, 0.0, 0.0),
    phase(50, 4, 40.0, 0.0),
    phase(80, 2, 40.0, 5.0),
    phase(110, 2, 40.0, 10.0),
    phase(125, 2, 50.0, 15.0),
    // The bit sticks and the top drive stalls; the driller lets it come free.
    phase(133, 2, 0.0, 18.0),
    phase(168, 2, 40.0, 10.0),
    phase(LENGTH, 4, 40.0, 0.0),
];

/// The log as text.
pub fn demo_log() -> String {
    let mut text = String::from("time_s,block_height_ft,hookload_klbf,top_drive_rpm,top_drive_torque_ftlb,rig_state\n");
    // A fixed seed: the log is compared byte by byte in a test.
    let mut noise = Noise(0x2545_f491_4f6c_dd1d);
    let (mut speed, mut weight, mut block) = (0.0_f64, 0.0_f64, 60.0_f64);
    for second in 0..LENGTH {
        let phase = PHASES.iter().find(|phase| second < phase.until).unwrap_or(&PHASES[0]);
        // r/min per s: gently off bottom, hard into a stall and out of it. The driller changes 2 kN per s.
        let slew = if phase.state == 4 { 4.0 } else { 15.0 };
        speed += (phase.rotary_speed_rpm - speed).clamp(-slew, slew);
        weight += (phase.weight_on_bit_kn - weight).clamp(-2.0, 2.0);
        // The block follows the bit down; its fall is made up, and only has to be steady.
        block -= 0.01 * speed / 40.0 + 0.002 * weight;
        let time = f64::from(second) + 0.5 + 0.2 * noise.next();
        // In slips the string hangs in the rotary table, and the hook carries itself alone.
        let hookload = if phase.state == 3 {
            IN_SLIPS_KLBF
        } else {
            OFF_BOTTOM_KLBF - weight / KN_PER_KLBF
        } + 0.15 * noise.next();
        let turning = if speed > 0.0 { speed + 0.5 * noise.next() } else { 0.0 };
        // Above this weight the bit stalls: the torque no longer follows the speed.
        let stalled = phase.weight_on_bit_kn > 15.0;
        let torque = if stalled { 900.0 } else { 3.0 * speed + 25.0 * weight } + 10.0 * noise.next();
        let (mut hookload, mut turning) = (format!("{hookload:.2}"), format!("{turning:.1}"));
        let mut time = format!("{time:.2}");
        // The faults are those of real logs, so that the demonstration shows what the reader reports.
        match second {
            // Nothing was written for six seconds.
            138..=143 => continue,
            150..=152 => {
                hookload = "-999.25".to_string();
                turning = "-999.25".to_string();
            }
            158 => turning = "412.0".to_string(),
            // The time of the row before once more.
            163 => time = last_time(&text),
            _ => {}
        }
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{time},{block:.2},{hookload},{turning},{:.0},{}",
            torque.max(0.0),
            phase.state
        );
    }
    text
}

fn last_time(text: &str) -> String {
    let last = text.lines().next_back().unwrap_or("");
    last.split(',').next().unwrap_or("").to_string()
}

/// Uniform in -1..1, the same on every machine: xorshift, then only exact operations.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}
