//! Made logs of a rig that drills, slides, circulates and connects, under random names, units, layouts and noise. It shares
//! nothing with the code under test: the factors of the units are those of NIST SP 811.

use flexdrill_core::inputs::Unit;
use flexdrill_field_log::Quantity;

/// A small generator of random numbers (Marsaglia's xorshift with 64 bits).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn within(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.unit()
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() >> 33) as usize % count
    }

    pub fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    pub fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }
}

/// What a rig does in a second, in the units of the fields' names.
#[derive(Debug, Clone, Copy, Default)]
pub struct Second {
    pub time_s: f64,
    pub speed_rpm: f64,
    pub weight_kn: f64,
    pub hook_kn: f64,
    pub torque_knm: f64,
    pub rate_mph: f64,
    pub pressure_kpa: f64,
    pub bit_m: f64,
    pub hole_m: f64,
    pub strokes_spm: f64,
    pub block_m: f64,
    pub motor_rpm: f64,
    pub downhole_weight_kn: f64,
}

/// A rig's hour, by the phases of its work.
pub fn rig(random: &mut Random, seconds: usize) -> Vec<Second> {
    let mut hour: Vec<Second> = Vec::with_capacity(seconds);
    let (speed, weight) = (random.within(25.0, 180.0), random.within(15.0, 150.0));
    let (tare, strokes) = (random.within(3.0, 8.0) * weight + 150.0, random.within(45.0, 130.0));
    let empty_hook = random.within(50.0, 100.0);
    let mut depth = random.within(200.0, 4000.0);
    let (mut bit, mut block, mut time) = (depth, 25.0, random.within(0.0, 50.0));
    let (mut left, mut phase, mut set) = (0_usize, 0_usize, weight);
    let mut now = Second::default();
    while hour.len() < seconds {
        if left == 0 {
            // Drilling and sliding are followed by circulation, and that by a connection, with some chance.
            phase = match phase {
                0 | 1 if random.chance(0.7) => 2,
                2 if random.chance(0.6) => 3,
                _ => random.below(2),
            };
            left = 40 + random.below(120);
            set = weight * random.within(0.6, 1.2);
        }
        left -= 1;
        // The driller moves the brake now and then.
        if random.chance(0.05) {
            set = weight * random.within(0.5, 1.3);
        }
        let target = match phase {
            0 => [speed, set, strokes],
            1 => [0.0, 0.8 * set, strokes],
            2 => [if left % 100 < 50 { 0.4 * speed } else { 0.0 }, 0.0, strokes],
            _ => [0.0, 0.0, 0.0],
        };
        now.speed_rpm += 0.4 * (target[0] - now.speed_rpm);
        now.weight_kn += 0.25 * (target[1] - now.weight_kn);
        now.strokes_spm += 0.3 * (target[2] - now.strokes_spm);
        let rate = if phase < 2 {
            0.15 * now.weight_kn.max(0.0) + 2.0
        } else {
            0.0
        };
        let step = 1.0 + random.within(-0.05, 0.05);
        depth += rate * step / 3600.0;
        bit = match phase {
            0 | 1 => depth,
            2 => (bit - 0.02).max(depth - 3.0),
            _ => bit,
        };
        block = if phase < 2 {
            (block - rate / 3600.0).max(1.0)
        } else {
            (block + 0.05).min(30.0)
        };
        time += step;
        let noise = |random: &mut Random, size: f64| size * (random.unit() + random.unit() - 1.0);
        let weight = if now.weight_kn > 0.03 * set {
            now.weight_kn + noise(random, 0.02 * set)
        } else {
            0.0
        };
        let turns = now.speed_rpm > 1.0;
        hour.push(Second {
            time_s: time,
            speed_rpm: if turns { now.speed_rpm + noise(random, 0.5) } else { 0.0 },
            weight_kn: weight,
            hook_kn: if phase == 3 {
                empty_hook + noise(random, 0.5)
            } else {
                tare - weight + noise(random, 0.01 * set)
            },
            torque_knm: if turns {
                1.0 + 0.03 * weight + 0.01 * now.speed_rpm + noise(random, 0.3)
            } else {
                0.0
            },
            rate_mph: rate * (1.0 + noise(random, 0.1)),
            pressure_kpa: 2.0 * now.strokes_spm * now.strokes_spm + 50.0 + noise(random, 20.0),
            bit_m: bit,
            hole_m: depth,
            strokes_spm: now.strokes_spm.max(0.0),
            block_m: block,
            motor_rpm: 1.3 * now.strokes_spm.max(0.0),
            downhole_weight_kn: (0.8 * weight + noise(random, 0.15 * set)).max(0.0),
        });
    }
    hour
}

/// What a column really is.
#[derive(Debug, Clone, PartialEq)]
pub enum Truth {
    /// The time, by its format in a mapping.
    Time(&'static str),
    Quantity(Quantity, Unit),
    /// Nothing that the twin reads.
    Other,
}

/// A column of a made log.
pub struct Made {
    pub name: String,
    /// As a line below the header or in LAS would have it; empty without one.
    pub unit: String,
    pub truth: Truth,
    pub texts: Vec<String>,
}

/// A unit, its spellings, and how many of the generator's unit are in one.
type Spelled = (Unit, &'static [&'static str], f64);

const FORCES: &[Spelled] = &[
    (Unit::Kilonewton, &["kN"], 1.0),
    (Unit::Kilopound, &["klbf", "klbs", "kip"], 4.448_221_615_260_5),
    (Unit::TonneForce, &["t", "tonne"], 9.806_65),
    (Unit::Kilodecanewton, &["kdaN", "KDN"], 10.0),
];
const TORQUES: &[Spelled] = &[
    (Unit::KilonewtonMetre, &["kN.m", "kNm"], 1.0),
    (
        Unit::FootPound,
        &["ft.lbf", "ftlb", "ft-lbs"],
        1.355_817_948_331_400_4e-3,
    ),
    (Unit::KilofootPound, &["kft.lbf", "kftlb"], 1.355_817_948_331_400_4),
];
const PRESSURES: &[Spelled] = &[
    (Unit::Kilopascal, &["kPa"], 1.0),
    (Unit::Psi, &["psi"], 6.894_757_293_168_361),
    (Unit::Bar, &["bar"], 100.0),
];
const RATES: &[Spelled] = &[
    (Unit::MetrePerHour, &["m/h", "m/hr"], 1.0),
    (Unit::FootPerHour, &["ft/h", "ft/hr"], 0.3048),
];
const LENGTHS: &[Spelled] = &[(Unit::Metre, &["m"], 1.0), (Unit::Foot, &["ft", "feet"], 0.3048)];
const SPEEDS: &[Spelled] = &[(Unit::TurnPerMinute, &["rpm", "r/min", "RPM"], 1.0)];

/// A quantity: its names, its units, and its value.
type Known = (
    Quantity,
    &'static [&'static str],
    &'static [Spelled],
    fn(&Second) -> f64,
);

const KNOWN: [Known; 8] = [
    (
        Quantity::RotarySpeed,
        &["RPM", "Rotary Speed", "Top Drive RPM", "RPMA", "TD_Speed"],
        SPEEDS,
        |now| now.speed_rpm,
    ),
    (
        Quantity::WeightOnBit,
        &["WOB", "Weight on Bit", "WOBA", "weight_on_bit", "Bit Weight"],
        FORCES,
        |now| now.weight_kn,
    ),
    (
        Quantity::HookLoad,
        &["Hookload", "Hook Load", "HKLA", "HookLoad"],
        FORCES,
        |now| now.hook_kn,
    ),
    (
        Quantity::Torque,
        &["Torque", "Top Drive Torque", "TQA", "rotary_torque", "TRQ"],
        TORQUES,
        |now| now.torque_knm,
    ),
    (
        Quantity::RateOfPenetration,
        &["ROP", "Rate of Penetration", "ROPA", "ROP avg"],
        RATES,
        |now| now.rate_mph,
    ),
    (
        Quantity::StandpipePressure,
        &["SPP", "Standpipe Pressure", "SPPA"],
        PRESSURES,
        |now| now.pressure_kpa,
    ),
    (Quantity::BitDepth, &["Bit Depth", "BitDepth", "DBTM"], LENGTHS, |now| {
        now.bit_m
    }),
    (
        Quantity::HoleDepth,
        &["Hole Depth", "HoleDepth", "DMEA"],
        LENGTHS,
        |now| now.hole_m,
    ),
];

/// Columns that are easily taken for an input: names, units in which they are written, and the value.
type Easily = (&'static [&'static str], &'static [&'static str], fn(&Second) -> f64);

const OTHERS: [Easily; 9] = [
    (
        &["SPM", "Pump 1 SPM", "spm1", "Strokes"],
        &["", "1/min", "rpm"],
        |now| now.strokes_spm,
    ),
    (
        &["Motor RPM", "Bit RPM", "Downhole RPM", "Pump RPM", "Shaker RPM"],
        &["", "rpm"],
        |now| now.motor_rpm,
    ),
    (&["Downhole WOB", "DWOB", "MWD WOB"], &["", "kN"], |now| {
        now.downhole_weight_kn
    }),
    (&["Block Height", "BPOS", "Block Position"], &["", "m"], |now| {
        now.block_m
    }),
    (
        &["Casing Pressure", "Annular Pressure", "Pump Pressure"],
        &["", "kPa"],
        |now| 0.9 * now.pressure_kpa,
    ),
    (&["WOB setpoint", "RPM limit", "Torque Max"], &["", "kN", "rpm"], |_| {
        120.0
    }),
    (&["Depth", "TVD", "Lag Depth"], &["", "m"], |now| now.hole_m),
    (&["Gamma", "Temperature", "Kelly torque"], &["", "kN.m"], |now| {
        3.0 + now.torque_knm
    }),
    (&["Total Strokes", "Record", "Count"], &["", "1"], |now| {
        (now.time_s * 1.1).floor()
    }),
];

/// A made log: its text, and what each column is.
pub struct Log {
    pub text: String,
    pub columns: Vec<(String, Truth)>,
}

/// A made log of this seed.
pub fn log(seed: u64, seconds: usize) -> Log {
    let mut random = Random::new(seed);
    let hour = rig(&mut random, seconds);
    let mut columns = vec![time_column(&mut random, &hour)];
    let opaque = random.chance(0.35);
    for (quantity, names, units, value) in KNOWN {
        if random.chance(0.8) {
            let (unit, spellings, one) = random.pick(units);
            let name = if opaque {
                format!("CH{}", columns.len())
            } else {
                (*random.pick(names)).to_owned()
            };
            let texts = hour.iter().map(|now| number(value(now) / one, *one));
            columns.push(Made {
                name,
                unit: (*random.pick(spellings)).to_owned(),
                truth: Truth::Quantity(quantity, *unit),
                texts: texts.collect(),
            });
        }
    }
    for (names, units, value) in OTHERS {
        if random.chance(0.5) {
            let name = if opaque {
                format!("CH{}", columns.len())
            } else {
                (*random.pick(names)).to_owned()
            };
            columns.push(Made {
                name,
                unit: (*random.pick(units)).to_owned(),
                truth: Truth::Other,
                texts: hour.iter().map(|now| number(value(now), 1.0)).collect(),
            });
        }
    }
    for index in (1..columns.len()).rev() {
        let other = random.below(index + 1);
        columns.swap(index, other);
    }
    written(&mut random, columns)
}

/// A number with the digits that recorders give: one in a thousand of usual values.
fn number(value: f64, one: f64) -> String {
    match value {
        value if one < 0.01 => format!("{value:.0}"),
        value => format!("{value:.2}"),
    }
}

fn time_column(random: &mut Random, hour: &[Second]) -> Made {
    // 2026-01-29 10:00:00 UTC.
    const BEGIN: f64 = 1_769_680_800.0;
    let clock = |time: f64| {
        let whole = 36_000 + time as u64;
        format!("{:02}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
    };
    let (name, unit, format): (&str, &str, &'static str) = *random.pick(&[
        ("Time", "s", "seconds"),
        ("time_s", "", "seconds"),
        ("Time", "ms", "milliseconds"),
        ("Timestamp", "", "iso8601"),
        ("DateTime", "", "%d.%m.%Y %H:%M:%S"),
        ("UTC", "", "seconds"),
        ("Time", "", "time_of_day"),
        ("x1", "", "iso8601"),
        ("Elapsed time", "min", "minutes"),
    ]);
    let text = |now: &Second| match (name, format) {
        ("UTC", _) => format!("{:.0}", BEGIN + now.time_s),
        (_, "seconds") => format!("{:.2}", now.time_s),
        (_, "milliseconds") => format!("{:.0}", 1e3 * now.time_s),
        (_, "minutes") => format!("{:.5}", now.time_s / 60.0),
        (_, "iso8601") => format!("2026-01-29T{}Z", clock(now.time_s)),
        (_, "time_of_day") => clock(now.time_s),
        _ => format!("29.01.2026 {}", clock(now.time_s)),
    };
    Made {
        name: name.to_owned(),
        unit: unit.to_owned(),
        truth: Truth::Time(format),
        texts: hour.iter().map(text).collect(),
    }
}

/// The columns as a file, in one of the layouts that programs write.
fn written(random: &mut Random, columns: Vec<Made>) -> Log {
    let separator = *random.pick(&[",", ";", "\t"]);
    let comma = separator == ";" && random.chance(0.5);
    let style = random.below(4);
    let header_name = |column: &Made| match (style, column.unit.as_str()) {
        (_, "") | (3, _) => column.name.clone(),
        (0, unit) => format!("{} ({unit})", column.name),
        (1, unit) => format!("{} [{unit}]", column.name),
        (_, unit) if unit.contains(['/', '.', '-', '1']) => format!("{} ({unit})", column.name),
        (_, unit) => format!("{}_{unit}", column.name),
    };
    let names: Vec<String> = columns.iter().map(header_name).collect();
    let mut text = String::new();
    if random.chance(0.2) {
        text.push_str("Report of a rig\nwritten by a recorder\n");
    }
    text.push_str(&names.join(separator));
    text.push('\n');
    // The units below the header, or in no place at all.
    let below = style == 3 && random.chance(0.6);
    if below {
        let units: Vec<&str> = columns.iter().map(|column| column.unit.as_str()).collect();
        text.push_str(&units.join(separator));
        text.push('\n');
    }
    for row in 0..columns.first().map_or(0, |column| column.texts.len()) {
        let fields: Vec<String> = columns
            .iter()
            .map(|column| match (random.below(400), &column.truth) {
                // A sensor fails now and then; a clock does not.
                (0, Truth::Quantity(..) | Truth::Other) => String::new(),
                (1, Truth::Quantity(..) | Truth::Other) => "-999.25".to_owned(),
                _ => column.texts[row].clone(),
            })
            .map(|field| {
                if comma && field.parse::<f64>().is_ok() {
                    field.replace('.', ",")
                } else {
                    field
                }
            })
            .collect();
        text.push_str(&fields.join(separator));
        text.push('\n');
    }
    Log {
        text,
        columns: names
            .into_iter()
            .zip(columns.into_iter().map(|column| column.truth))
            .collect(),
    }
}
