//! `--cases rig-faults`: faults while the twin is compared with the rig: how soon the alarm `rig_disagrees` comes, what it
//! names, and how often it comes without a fault. The figures with and without the fault are those of full runs of the twin;
//! noise and drift are those that the configuration states.

use flexdrill_bench::table::Table;
use flexdrill_calibration::monitor::{LEVELS, Monitor, MonitorSettings, Reading};
use flexdrill_calibration::residual::{Cause, RigQuantity};
use flexdrill_calibration::study::point::{Figures, Load, run};
use flexdrill_calibration::windows::Activity;
use flexdrill_config::Config;
use flexdrill_core::units::{kn_to_n, rpm_to_rad_per_s};

/// Speed (r/min) and weight (kN) of drilling.
const RPM: f64 = 45.0;
const WEIGHT: f64 = 16.0;
/// Weight at the bit where a sensor shows a quarter more than there is: it is off by 20 % of what it shows.
const TRUE_WEIGHT: f64 = 0.8 * WEIGHT;
/// Seconds of a stand. It ends with rotation off bottom, then without rotation.
const STAND: u32 = 1800;
const OFF_BOTTOM: u32 = 90;
const AT_REST: u32 = 180;
/// Seconds between two words of a sub above the bit.
const WORD: u32 = 30;
/// A fault begins in the middle of a stand, after an hour, and is looked for so long (s).
const BEGIN: u32 = 3600 + 700;
const LOOKED: u32 = 3600;
/// Seconds after the alarm at which its cause is read.
const READ: u32 = 60;
/// Runs per fault, and days without one.
const RUNS: u64 = 100;
const DAYS: u64 = 100;

/// What rig or twin show off bottom and while drilling.
#[derive(Clone, Copy)]
struct Shown {
    off_bottom: Figures,
    drilling: Figures,
}

struct Rig {
    monitor: MonitorSettings,
    /// Standard deviation of the drift of torque (N m) and hook load (N) after an hour.
    drift: [f64; 2],
    /// On-delay and off-delay of the alarm (s).
    delays: [f64; 2],
    /// A sub above the bit measures, too.
    in_the_hole: bool,
    /// Standard deviation of the twin's error, as a share; the same over a run.
    error: f64,
}

/// When an alarm came (s), and the cause that it named first.
type Came = (u32, Option<Cause>);

/// Runs all faults; gives the tables.
///
/// # Errors
/// When a run of the twin fails.
pub(crate) fn tables(config: &Config, duration: f64) -> anyhow::Result<String> {
    // Figures of the twin are computed once. The watch below repeats them with noise, at a cost of nothing.
    let figures = |config: &Config, weight: f64| {
        eprintln!("the twin at {RPM} r/min and {weight} kN");
        let load = Load {
            motion: if weight > 0.0 {
                Activity::Drilling
            } else {
                Activity::OffBottom
            },
            rotary_speed: rpm_to_rad_per_s(RPM),
            weight: kn_to_n(weight),
        };
        run(config, &load).map_err(anyhow::Error::msg)
    };
    let shown = |config: &Config, weight: f64| {
        anyhow::Ok(Shown {
            off_bottom: figures(config, 0.0)?,
            drilling: figures(config, weight)?,
        })
    };
    // A sensor that shows too much leads the driller to put on less: the true weight is lower than the shown one.
    let healthy = shown(config, WEIGHT)?;
    let less_weight = figures(config, TRUE_WEIGHT)?;
    let arc = shown(&in_the_arc(config)?, WEIGHT)?;
    let layers = shown(&in_both_layers(config)?, WEIGHT)?;
    // A bit that takes half of its torque lowers the torque at the surface by the same amount.
    let mut dull = healthy;
    dull.drilling[2] *= 0.5;
    dull.drilling[0] -= dull.drilling[2];
    // The hook load and the shown weight stay; what depends on the true weight is that of the lower one.
    let mut sensor = healthy;
    sensor.drilling = less_weight;
    sensor.drilling[1] = healthy.drilling[1];
    let faults = [
        ("friction of the wall doubled in the arc", arc),
        ("friction doubled in both layers of the tool", layers),
        ("weight sensor off by 20 %", sensor),
        ("torque of the bit halved", dull),
    ];
    let mut text = conditions(&healthy, &faults);
    let mut found = Table::new([
        "fault",
        "measured",
        "error of the twin",
        "found of 100 within an hour",
        "median (s)",
        "longest (s)",
        "likeliest cause after a minute",
    ]);
    let mut calm = Table::new(["measured", "error of the twin", "days", "false alarms per day"]);
    for in_the_hole in [false, true] {
        // With the error of the twin and without: the first shows what the
        // rig sees, the second what the method can do at best.
        for error in [0.0, config.calibration.model_error] {
            let rig = Rig::new(config, in_the_hole, error);
            let measured = if in_the_hole { "surface and hole" } else { "surface" };
            let error = format!("{} %", 100.0 * error);
            for (name, fault) in &faults {
                let mut came: Vec<Came> = (0..RUNS)
                    .filter_map(|seed| {
                        // The fault begins after a time without one, in which the comparison has settled.
                        let all = rig.watch(seed, BEGIN + LOOKED, &healthy, |second| {
                            if second < BEGIN { healthy } else { *fault }
                        });
                        all.into_iter().find(|(second, _)| *second >= BEGIN)
                    })
                    .collect();
                came.sort_by_key(|(second, _)| *second);
                let after = |at: Option<&Came>| at.map_or("-".to_owned(), |(second, _)| (second - BEGIN).to_string());
                found.row([
                    (*name).to_owned(),
                    measured.to_owned(),
                    error.clone(),
                    came.len().to_string(),
                    after(came.get(came.len().saturating_sub(1) / 2)),
                    after(came.last()),
                    named(&came),
                ]);
            }
            // Other seeds than those of the faults, and none of the seconds has a fault: every alarm is a false one.
            let alarms: usize = (0..DAYS)
                .map(|day| rig.watch(1000 + day, duration as u32, &healthy, |_| healthy).len())
                .sum();
            calm.row([
                measured.to_owned(),
                error,
                format!("{}", DAYS as f64 * duration / 86_400.0),
                format!("{:.2}", alarms as f64 / (DAYS as f64 * duration / 86_400.0)),
            ]);
        }
    }
    text.push_str(found.text());
    text.push('\n');
    text.push_str(calm.text());
    Ok(text)
}

/// Twice the friction of the guide on the wall in the arc.
fn in_the_arc(config: &Config) -> anyhow::Result<Config> {
    let factor = config.contact.wall_friction_factors.arc;
    Ok(config.with_value("contact.wall_friction_factors.arc", 2.0 * factor)?)
}

/// Twice the friction in both layers along the whole tool.
fn in_both_layers(config: &Config) -> anyhow::Result<Config> {
    let contact = &config.contact;
    let values = [
        ("contact.inner.friction_tangential", contact.inner.friction_tangential),
        ("contact.inner.friction_axial", contact.inner.friction_axial),
        ("contact.outer.friction_tangential", contact.outer.friction_tangential),
        ("contact.outer.friction_axial", contact.outer.friction_axial),
    ];
    Ok(config.with_values("fault", values.map(|(key, value)| (key, 2.0 * value)))?)
}

fn conditions(healthy: &Shown, faults: &[(&str, Shown)]) -> String {
    let mut table = Table::new([
        "condition",
        "motion",
        "surface torque (N m)",
        "hook load (kN)",
        "bit torque (N m)",
        "bit weight (kN)",
    ]);
    for (name, shown) in [("the twin", *healthy)].iter().chain(faults) {
        for (motion, figures) in [("off bottom", shown.off_bottom), ("drilling", shown.drilling)] {
            let [torque, hook, bit, weight, ..] = figures;
            table.row([
                (*name).to_owned(),
                motion.to_owned(),
                format!("{torque:.0}"),
                format!("{:.1}", 1e-3 * hook),
                format!("{bit:.0}"),
                format!("{:.1}", 1e-3 * weight),
            ]);
        }
    }
    format!("{}\n", table.text())
}

/// The cause that most alarms name first, with its share.
fn named(came: &[Came]) -> String {
    let words = |cause: Cause| format!("{cause:?}");
    let mut counts: Vec<(String, usize)> = Vec::new();
    for cause in came.iter().filter_map(|(_, cause)| *cause) {
        match counts.iter_mut().find(|(name, _)| *name == words(cause)) {
            Some((_, count)) => *count += 1,
            None => counts.push((words(cause), 1)),
        }
    }
    let most = counts.into_iter().max_by_key(|(_, count)| *count);
    most.map_or("-".to_owned(), |(name, count)| format!("{name} ({count})"))
}

impl Rig {
    fn new(config: &Config, in_the_hole: bool, error: f64) -> Self {
        let alarm = &config.alarms.rig_disagrees;
        Self {
            monitor: MonitorSettings::stated(&flexdrill_calibration::stated(config)),
            drift: [
                config.calibration.torque_drift_nm,
                kn_to_n(config.calibration.hook_load_drift_kn),
            ],
            delays: [alarm.on_delay, alarm.off_delay],
            in_the_hole,
            error,
        }
    }

    /// Seconds at which the alarm came in a run of so many seconds, in which the twin computes `twin` and the rig shows what
    /// `truth` gives for a second.
    fn watch(&self, seed: u64, seconds: u32, twin: &Shown, truth: impl Fn(u32) -> Shown) -> Vec<Came> {
        // One generator per run and seed: all noise of a run is in its order, so that it repeats.
        let mut random = fastrand::Rng::with_seed(seed);
        let mut normal = move || {
            // Box and Muller; one minus the number avoids the logarithm of zero.
            let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
            radius * (std::f64::consts::TAU * random.f64()).cos()
        };
        // The error of the twin is one factor per run: a model that is wrong is so all day.
        let shares: Figures = std::array::from_fn(|_| 1.0 + self.error * normal());
        let mut monitor = Monitor::new(self.monitor);
        let mut drift = [0.0; 2];
        let mut alarm = Alarm::default();
        let mut came = Vec::new();
        for second in 0..seconds {
            // A random walk by the second, as that of a calibration's logs.
            for (drift, hour) in drift.iter_mut().zip(self.drift) {
                *drift += hour / 60.0 * normal();
            }
            // A stand is drilled, then the tool rotates off bottom, then it rests for the connection.
            let of_stand = second % STAND;
            let rests = of_stand >= STAND - AT_REST;
            let off_bottom = of_stand >= STAND - AT_REST - OFF_BOTTOM;
            let of = |shown: &Shown| if off_bottom { shown.off_bottom } else { shown.drilling };
            let (truth, twin) = (of(&truth(second)), of(twin));
            let speed = if rests { 0.0 } else { rpm_to_rad_per_s(RPM) };
            let noise = |quantity: RigQuantity| self.monitor.expected[quantity as usize].noise;
            let mut measured = [f64::NAN; RigQuantity::COUNT];
            measured[0] = truth[0] * shares[0] + drift[0] + noise(RigQuantity::SurfaceTorque) * normal();
            measured[1] = truth[1] * shares[1] + drift[1] + noise(RigQuantity::HookLoad) * normal();
            // Mud pulse telemetry brings a word now and then; between two there is no value.
            if self.in_the_hole && second.is_multiple_of(WORD) {
                measured[2] = speed + noise(RigQuantity::DownholeSpeed) * normal();
                measured[3] = truth[2] * shares[2] + noise(RigQuantity::DownholeTorque) * normal();
                measured[4] = truth[3] * shares[3] + noise(RigQuantity::DownholeWeight) * normal();
            }
            let compared = monitor.push(&Reading {
                step: 1.0,
                rotary_speed: speed,
                weight: if off_bottom { 0.0 } else { kn_to_n(WEIGHT) },
                good: true,
                measured,
                // The twin's figures have neither noise nor tare; the comparison expects them like that.
                predicted: [twin[0], twin[1], speed, twin[2], twin[3]],
            });
            let worst = compared.worst();
            // Without a comparison the alarm keeps its state, as in the node.
            let beyond = worst.map(|(_, of)| of.difference().abs() >= of.limit(LEVELS[0]));
            if alarm.comes(beyond, self.delays) {
                came.push((second, None));
            }
            // The alarm shows its worst moment; a cause is read once the hole has been heard of after the fault.
            if let Some((at, named)) = came.last_mut().filter(|_| alarm.stands)
                && second <= *at + READ
                && let Some(cause) = compared.causes.first()
            {
                *named = Some(*cause);
            }
        }
        came
    }
}

/// The alarm: its delays, and that it outlasts times in which nothing can be judged while it stands.
#[derive(Default)]
struct Alarm {
    stands: bool,
    /// Seconds for which the condition is, or is not, as the alarm has it.
    other: f64,
}

impl Alarm {
    /// Takes whether a residual is beyond its level, `None` where none can be judged. Whether the alarm comes.
    fn comes(&mut self, beyond: Option<bool>, [on, off]: [f64; 2]) -> bool {
        let Some(beyond) = beyond else {
            self.other = 0.0;
            return false;
        };
        if beyond == self.stands {
            self.other = 0.0;
            return false;
        }
        self.other += 1.0;
        let delay = if self.stands { off } else { on };
        // The first second of a condition is the beginning of its time.
        if self.other <= delay {
            return false;
        }
        (self.stands, self.other) = (beyond, 0.0);
        beyond
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests fail by panicking")]
mod tests {
    use super::*;

    const TWIN: Shown = Shown {
        off_bottom: [60.0, 200e3, 0.0, 0.0, 0.0],
        drilling: [300.0, 184e3, 200.0, 12e3, 1e-3],
    };

    fn rig(in_the_hole: bool) -> Rig {
        let config = Config::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rig.yaml")).unwrap();
        Rig::new(&config, in_the_hole, 0.0)
    }

    #[test]
    fn a_fault_is_found_and_named_and_a_healthy_rig_is_left_alone() {
        let mut dull = TWIN;
        dull.drilling[2] *= 0.5;
        dull.drilling[0] -= dull.drilling[2];
        for seed in 0..5 {
            let came = rig(true).watch(
                seed,
                BEGIN + LOOKED,
                &TWIN,
                |second| if second < BEGIN { TWIN } else { dull },
            );
            let (second, cause) = came[0];
            assert!((BEGIN + 10..BEGIN + 120).contains(&second), "{came:?}");
            assert_eq!(cause, Some(Cause::BitTakesLess));
            assert_eq!(rig(false).watch(seed, BEGIN, &TWIN, |_| TWIN), []);
        }
    }

    #[test]
    fn the_alarm_has_its_delays_and_outlasts_what_cannot_be_judged() {
        let mut alarm = Alarm::default();
        let mut take =
            |beyond: Option<bool>, times: usize| (0..times).filter(|_| alarm.comes(beyond, [10.0, 30.0])).count();
        assert_eq!(take(Some(true), 10), 0);
        assert_eq!(take(None, 1), 0);
        assert_eq!(take(Some(true), 11), 1);
        assert_eq!(take(None, 200) + take(Some(true), 200), 0, "it stands");
        assert_eq!(take(Some(false), 31) + take(Some(true), 10), 0);
        assert_eq!(take(Some(true), 1), 1, "it has returned, and comes again");
    }
}
