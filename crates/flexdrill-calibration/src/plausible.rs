//! What the rig measures against what plausible tools do.
//!
//! A plausible tool is one that is not excluded by what is known (`uncertainty` in a configuration). It has its own reading of
//! a quantity: what it computes, as the sensor of its rig shows it. The measured mean is compared with two ranges of readings:
//!
//! - all: from the lowest to the highest of the tools that were drawn before anything was measured, without weights. What
//!   was measured since changes nothing of it, so that a fault outside of it cannot be learned;
//! - fitting: from 5 to 95 % of the tools by their weights, those that fit what was measured before.
//!
//! All tools share the error of the model and of the sensor's offset, and the mean has the scatter of the sensor. Both widen
//! a range as they widen the figure of one twin ([`Residual::limit`](crate::residual::Residual::limit)): for tools that are
//! all alike, the comparison is that with a twin.

use crate::monitor::LEVELS;
use crate::residual::{Cause, RigQuantity, causes, limit};

/// The tools that a range is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tools {
    /// All that were drawn before anything was measured.
    All,
    /// Those that fit what was measured before.
    Fitting,
}

/// A quantity as it is measured and as plausible tools have it (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Readings {
    /// Mean of the measured values.
    pub measured: f64,
    /// Lowest and highest reading of all tools; `None` where they are not known.
    pub all: Option<[f64; 2]>,
    /// Readings of 5 and 95 % of the tools by weight; `None` where too few of them have weight.
    pub fitting: Option<[f64; 2]>,
    /// Standard deviation of the error that all tools share: the model's and that of the sensor's offset.
    pub error: f64,
    /// Standard deviation of the measured mean, from the scatter of the sensor.
    pub scatter: f64,
}

impl Readings {
    /// The range of these tools.
    pub fn range(&self, tools: Tools) -> Option<[f64; 2]> {
        match tools {
            Tools::All => self.all,
            Tools::Fitting => self.fitting,
        }
    }

    /// Measured less the nearest end of a range, 0 within it.
    pub fn distance(&self, [low, high]: [f64; 2]) -> f64 {
        (self.measured - high).max(0.0) + (self.measured - low).min(0.0)
    }

    /// The distance beyond which the shared error exceeds `level` times half of its 90 % band with certainty.
    pub fn limit(&self, level: f64) -> f64 {
        limit(self.error, self.scatter, level)
    }

    /// Distance from a range over what is surely beyond the band of the shared error; 0 where the range is not known.
    fn ratio(&self, tools: Tools) -> f64 {
        self.range(tools)
            .map_or(0.0, |range| self.distance(range) / self.limit(1.0))
    }

    /// The larger of both distances, as a ratio: the range of those that fit mostly lies within that of all.
    fn larger_ratio(&self) -> f64 {
        let [all, fitting] = [Tools::All, Tools::Fitting].map(|tools| self.ratio(tools));
        if fitting.abs() > all.abs() { fitting } else { all }
    }

    /// Whether the measured value is surely further from a range than `level` times half of the error's band.
    fn is_beyond(&self, tools: Tools, level: f64) -> bool {
        self.range(tools)
            .is_some_and(|range| self.distance(range).abs() >= self.limit(level))
    }
}

/// What plausible tools say of what the rig measures.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// Per quantity, in the order of [`RigQuantity::ALL`]; `None` while it cannot be judged.
    pub readings: [Option<Readings>; RigQuantity::COUNT],
    /// Whether the bit drills.
    pub drilling: bool,
    /// How many tools were drawn before anything was measured.
    pub tools: u32,
}

/// A quantity that no tool of a set explains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disagreement {
    /// What was measured.
    pub quantity: RigQuantity,
    /// Its readings.
    pub readings: Readings,
    /// The tools that do not explain it: those that fit only where some of all do.
    pub tools: Tools,
    /// Their range.
    pub range: [f64; 2],
    /// Whether the measured value is beyond the higher one of [`LEVELS`] too.
    pub much: bool,
}

impl Compared {
    /// Whether any quantity can be judged.
    pub fn is_judged(&self) -> bool {
        self.readings
            .iter()
            .flatten()
            .any(|readings| readings.all.or(readings.fitting).is_some())
    }

    /// The quantity that is farthest outside; one that no tool explains comes before one that only those do not explain which
    /// fit. `None` where some tool explains each.
    pub fn disagreement(&self) -> Option<Disagreement> {
        [Tools::All, Tools::Fitting].into_iter().find_map(|tools| {
            let known = RigQuantity::ALL
                .into_iter()
                .filter_map(|quantity| Some((quantity, self.readings[quantity as usize]?)));
            let beyond = known.filter(|(_, readings)| readings.is_beyond(tools, LEVELS[0]));
            let (quantity, readings) =
                beyond.max_by(|a, b| a.1.ratio(tools).abs().total_cmp(&b.1.ratio(tools).abs()))?;
            Some(Disagreement {
                quantity,
                readings,
                tools,
                range: readings.range(tools)?,
                // What some plausible tool does is never much.
                much: readings.is_beyond(Tools::All, LEVELS[1]),
            })
        })
    }

    /// What the quantities that are surely outside may mean, the likeliest first.
    pub fn causes(&self) -> Vec<Cause> {
        let ratios = self
            .readings
            .map(|readings| readings.map(|readings| readings.larger_ratio()));
        causes(&ratios, self.drilling)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::residual::Residual;

    fn readings(measured: f64) -> Readings {
        Readings {
            measured,
            all: Some([250.0, 400.0]),
            fitting: Some([300.0, 330.0]),
            error: 10.0,
            scatter: 2.0,
        }
    }

    fn compared(quantity: RigQuantity, readings: Readings) -> Compared {
        let mut all = [None; RigQuantity::COUNT];
        all[quantity as usize] = Some(readings);
        Compared {
            readings: all,
            drilling: true,
            tools: 12,
        }
    }

    const TORQUE: RigQuantity = RigQuantity::SurfaceTorque;

    /// The limits are 1.5 and 3 times 1.645 x 10, plus 4 x 2: 32.7 and 57.3.
    #[test]
    fn a_value_is_outside_all_tools_or_outside_those_that_fit_or_explained() {
        let of = |measured| compared(TORQUE, readings(measured)).disagreement();
        for explained in [300.0, 330.0, 362.0, 268.0] {
            assert_eq!(of(explained), None, "{explained}");
        }
        for fitting in [363.0, 266.0, 400.0, 250.0, 432.0, 218.0] {
            let found = of(fitting).unwrap();
            assert_eq!((found.tools, found.much), (Tools::Fitting, false), "{fitting}");
            assert_eq!(found.range, [300.0, 330.0]);
        }
        for (outside, much) in [(433.0, false), (217.0, false), (458.0, true), (192.0, true)] {
            let found = of(outside).unwrap();
            assert_eq!((found.tools, found.much), (Tools::All, much), "{outside}");
            assert_eq!(found.range, [250.0, 400.0]);
        }
    }

    /// Tools that have learned a fault: those that fit do what is measured, and it is outside all the same.
    #[test]
    fn tools_that_fit_a_fault_do_not_hide_it() {
        let learned = Readings {
            fitting: Some([440.0, 480.0]),
            ..readings(460.0)
        };
        let found = compared(TORQUE, learned).disagreement().unwrap();
        assert_eq!(found.tools, Tools::All);
        assert_eq!(compared(TORQUE, learned).causes()[0], Cause::FrictionHigher);
    }

    /// Tools that are all alike are one twin: the same limits, and the same causes.
    #[test]
    fn alike_tools_are_compared_as_one_twin() {
        for measured in [250.0, 267.0, 268.0, 300.0, 332.0, 333.0, 358.0] {
            let alike = Readings {
                all: Some([300.0; 2]),
                fitting: Some([300.0; 2]),
                ..readings(measured)
            };
            let twin = Residual {
                measured,
                predicted: 300.0,
                error: 10.0,
                scatter: 2.0,
            };
            let beyond = LEVELS.map(|level| twin.difference().abs() >= twin.limit(level));
            let found = compared(TORQUE, alike).disagreement();
            assert_eq!(
                [found.is_some(), found.is_some_and(|found| found.much)],
                beyond,
                "{measured}"
            );
        }
    }

    #[test]
    fn the_quantity_that_no_tool_explains_comes_first_and_unknown_ranges_say_nothing() {
        let mut both = compared(TORQUE, readings(430.0));
        let outside = readings(440.0);
        both.readings[RigQuantity::HookLoad as usize] = Some(outside);
        let found = both.disagreement().unwrap();
        assert_eq!((found.quantity, found.tools), (RigQuantity::HookLoad, Tools::All));
        let unknown = Readings {
            all: None,
            fitting: None,
            ..outside
        };
        let unknown = compared(TORQUE, unknown);
        assert!(!unknown.is_judged() && unknown.disagreement().is_none() && unknown.causes().is_empty());
        // Without one of the ranges the other one judges.
        let only = Readings { all: None, ..outside };
        assert_eq!(compared(TORQUE, only).disagreement().unwrap().tools, Tools::Fitting);
    }

    /// A rig of another law than the twin's: 11 N m of torque per kN of weight and 60 N m of friction, below a string of 300 kN.
    struct Rig {
        /// What the weight indicator shows over the truth.
        indicator: f64,
        /// The same of the torque sensor.
        torque_sensor: f64,
        friction: f64,
    }

    /// What the weight indicator shows (kN).
    const SHOWN: f64 = 60.0;
    const STATED: crate::monitor::Stated = crate::monitor::Stated {
        noise: [5.0, 200.0, 0.1, 5.0, 200.0],
        tare: [0.0; RigQuantity::COUNT],
        drift: [1.0, 100.0, 0.0, 0.0, 0.0],
        model: 0.003,
    };

    impl Rig {
        fn readings(&self) -> [f64; RigQuantity::COUNT] {
            let weight = SHOWN / self.indicator;
            let mut readings = [f64::NAN; RigQuantity::COUNT];
            readings[TORQUE as usize] = self.torque_sensor * (11.0 * weight + 60.0 * self.friction);
            readings[RigQuantity::HookLoad as usize] = (300.0 - weight) * 1e3;
            readings
        }
    }

    /// Sixteen tools whose indicators are up to 5 % off, and their friction up to a third, each of both everywhere.
    fn tools() -> impl Iterator<Item = Rig> {
        (0..16_i32).map(|k| Rig {
            indicator: 0.95 + 0.1 * f64::from(k) / 15.0,
            torque_sensor: 1.0,
            friction: 0.67 + 0.66 * f64::from(7 * k % 16) / 15.0,
        })
    }

    /// Seconds in which the twin alone disagrees with a rig, and in which plausible tools do. The tools that fit always do what
    /// is measured: nothing could be learned better.
    fn seconds(rig: &dyn Fn(u32) -> Rig, all: u32) -> [Vec<u32>; 2] {
        use crate::monitor::{Monitor, MonitorSettings, Reading};
        use crate::residual::Watch;
        let settings = MonitorSettings::stated(&STATED);
        let mut random = crate::random::Random::new(8);
        let nominal = Rig {
            indicator: 1.0,
            torque_sensor: 1.0,
            friction: 1.0,
        };
        let (mut monitor, mut found) = (Monitor::new(settings), [Vec::new(), Vec::new()]);
        let mut members: Vec<_> = tools()
            .map(|tool| (tool.readings(), [Watch::new(settings.mean); RigQuantity::COUNT]))
            .collect();
        for second in 0..all {
            let mut measured = rig(second).readings();
            for (value, noise) in measured.iter_mut().zip(STATED.noise) {
                *value += noise * random.normal();
            }
            let twin = monitor.push(&Reading {
                step: 1.0,
                rotary_speed: 4.0,
                weight: SHOWN * 1e3,
                good: true,
                measured,
                predicted: nominal.readings(),
            });
            let of_twin = |(_, of): (_, Residual)| of.difference().abs() >= of.limit(LEVELS[0]);
            if twin.worst().is_some_and(of_twin) {
                found[0].push(second);
            }
            let readings = std::array::from_fn(|k| {
                let means: Vec<Residual> = members
                    .iter_mut()
                    .filter_map(|(tool, watches)| {
                        watches[k].push(1.0, measured[k], tool[k]);
                        watches[k].residual(&settings.expected[k], 5.0, f64::from(second) / 3600.0)
                    })
                    .collect();
                let first = means.first()?;
                let of = means.iter().map(|of| of.predicted);
                Some(Readings {
                    measured: first.measured,
                    all: Some([of.clone().fold(f64::MAX, f64::min), of.fold(f64::MIN, f64::max)]),
                    fitting: Some([first.measured; 2]),
                    error: first.error,
                    scatter: first.scatter,
                })
            });
            let compared = Compared {
                readings,
                drilling: true,
                tools: 16,
            };
            if compared.disagreement().is_some() {
                found[1].push(second);
            }
        }
        found
    }

    /// Ten minutes with a weight indicator that shows 3 % too much: its tools know that it may.
    #[test]
    fn a_weight_indicator_that_is_off_as_it_may_be_is_no_disagreement() {
        for indicator in [0.97, 1.03] {
            let rig = |_| Rig {
                indicator,
                torque_sensor: 1.0,
                friction: 1.0,
            };
            let [twin, tools] = seconds(&rig, 600);
            assert!(
                twin.len() > 500,
                "{indicator}: the twin alone disagrees in {} s",
                twin.len()
            );
            assert_eq!(tools, [0; 0], "{indicator}");
        }
    }

    /// A torque sensor that shows 1.3 times the truth from a second on, which no tool does: 936 against at most 775 N m. It is
    /// found within a minute, and as long as it lasts, although the tools that fit have learned it.
    #[test]
    fn a_fault_that_no_tool_has_is_found_and_is_never_learned() {
        const FAILS: u32 = 300;
        let rig = |second| Rig {
            indicator: 1.0,
            torque_sensor: if second < FAILS { 1.0 } else { 1.3 },
            friction: 1.0,
        };
        let [_, tools] = seconds(&rig, 1800);
        let first = tools.first().copied().unwrap();
        assert!((FAILS..FAILS + 60).contains(&first), "{first}");
        assert_eq!(tools, (first..1800).collect::<Vec<_>>());
    }
}
