//! A small synthetic rig log with everything that happens in a real one, for demonstrations without a real one.
//!
//! The same bytes every time. 180 s at 1 Hz with the columns of `config/field_logs/rig_1hz.yaml`: a connection, a
//! run-up off bottom, steps of weight on bit, a stall, a gap, missing codes, a spike, a time that stands still, and the
//! pull off bottom. Its hookload, speeds and noise are made up, of the size of a small rig's. Its torque is the surface
//! torque that the twin of `config/rig.yaml` computes at this speed and weight ([`torque_nm`]), with a scatter: rig and
//! twin agree there. Another tool, such as that of `config/default.yaml`, has another torque.

use std::fmt::Write;

/// Length (s).
const LENGTH: u32 = 180;
/// Hookload in slips and off bottom (klbf).
const IN_SLIPS_KLBF: f64 = 32.0;
const OFF_BOTTOM_KLBF: f64 = 48.0;
const KN_PER_KLBF: f64 = 4.448_221_615_260_5;
const NM_PER_FTLB: f64 = 1.355_817_948_331_4;
const RPM: f64 = std::f64::consts::PI / 30.0;

/// Weight at the surface (kN), and the torque at the bit (N m) at 40 and at 60 r/min, of the rig's tool with its guide
/// as shipped (`docs/measurements.md`, the rig's tool over speed and weight), with the tool off bottom in front.
pub const BIT_TORQUE: [(f64, [f64; 2]); 5] = [
    (0.0, [0.0, 0.0]),
    (5.0, [49.0, 47.0]),
    (10.0, [122.0, 120.0]),
    (20.0, [269.0, 265.0]),
    (30.0, [409.0, 396.0]),
];
/// Surface torque off bottom (N m), of the same tool (`docs/measurements.md`, faults of a rig).
const OFF_BOTTOM_NM: f64 = 3.0;
/// What friction takes above the bit at 10 kN and 40 r/min (N m): 136.9 at the kick-off and 124.4 at the bit
/// (`docs/measurements.md`, the rig's tool by step). The string hangs in a vertical hole and takes nothing.
const FRICTION_NM: f64 = 12.5;
/// Inertia of the top drive, and of the string of 1000 m of 2 7/8 in pipe (kg m2).
const INERTIA: f64 = 50.0 + 15.0;
/// Torsional stiffness of that string (N m/rad): 79 GPa x 1.915e-6 m4 / 1000 m.
const STIFFNESS: f64 = 151.0;
/// Response time of the hoist (s), by which the weight arrives.
const RESPONSE: f64 = 4.0;
/// Largest scatter of the torque sensor (N m): a deviation of 8, where `calibration.torque_noise_nm` allows 15.
const SCATTER_NM: f64 = 14.0;

/// The steady surface torque (N m) of the rig's tool at a rotary speed (r/min) and a weight slacked off (kN): that of
/// the bit, and what friction takes, which grows with the weight from what it is off bottom. Below 40 r/min it is that
/// at 40 r/min; at standstill there is none.
pub fn torque_nm(rotary_speed_rpm: f64, weight_on_bit_kn: f64) -> f64 {
    if rotary_speed_rpm == 0.0 {
        return 0.0;
    }
    let faster = ((rotary_speed_rpm - 40.0) / 20.0).clamp(0.0, 1.0);
    let at = |torque: [f64; 2]| torque[0] + faster * (torque[1] - torque[0]);
    let between = BIT_TORQUE.windows(2).find(|rows| weight_on_bit_kn <= rows[1].0);
    let [(low, below), (high, above)] = match between {
        Some(rows) => [rows[0], rows[1]],
        None => [BIT_TORQUE[3], BIT_TORQUE[4]],
    };
    let (below, above) = (at(below), at(above));
    let bit = below + (above - below) * (weight_on_bit_kn - low) / (high - low);
    bit + OFF_BOTTOM_NM + (FRICTION_NM - OFF_BOTTOM_NM) * weight_on_bit_kn / 10.0
}

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
    // The weight that has arrived at the bit's torque (kN), and the angle by which a stuck bit has wound the string
    // (rad).
    let (mut arrived, mut wound) = (0.0_f64, 0.0_f64);
    for second in 0..LENGTH {
        let phase = PHASES.iter().find(|phase| second < phase.until).unwrap_or(&PHASES[0]);
        // r/min per s: gently off bottom, hard into a stall and out of it. The driller changes 2 kN per s.
        let slew = if phase.state == 4 { 4.0 } else { 15.0 };
        let before = speed;
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
        arrived += (weight - arrived) / RESPONSE;
        // Above this weight the bit sticks. The drive winds the string until it stands, and holds its torque; the twin,
        // which is given the speed and the weight alone, has a bit that runs out. So the two differ here, as at a rig.
        let stuck = phase.weight_on_bit_kn > 15.0;
        wound = if stuck { wound + RPM * speed } else { 0.0 };
        let torque_nm = if stuck {
            torque_nm(50.0, arrived) + STIFFNESS * wound
        } else {
            // One second between rows: their difference is the acceleration.
            torque_nm(speed, arrived) + INERTIA * RPM * (speed - before)
        };
        let torque = (torque_nm + SCATTER_NM * noise.next()) / NM_PER_FTLB;
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
