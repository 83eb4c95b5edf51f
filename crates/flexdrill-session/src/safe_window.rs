//! The safe window: a map of speed and weight (`flexdrill map`), and where the present point is on it.

use std::path::{Path, PathBuf};

use flexdrill_config::Config;
use flexdrill_map::{Axis, Cell, Map, MapError, ROTARY_SPEED, Verdict, WEIGHT_ON_BIT};
use flexdrill_messages::SafeWindow as Message;
use flexdrill_messages::std_msgs::Header;
use flexdrill_outputs::words::priority_code;

/// Why a map is not loaded.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// The file is no map, or damaged.
    #[error("map.file: {0}")]
    Map(#[from] MapError),
    /// Another pair of keys.
    #[error(
        "map.file: {file}: a map over {x} and {y}; the node needs one over {ROTARY_SPEED} and {WEIGHT_ON_BIT}, as \
         `flexdrill map --rpm A:B --wob A:B` makes it"
    )]
    Axes {
        /// Path of the file, for the message.
        file: String,
        /// Key of its first axis.
        x: String,
        /// Key of its second axis.
        y: String,
    },
    /// Another tool.
    #[error(
        "map.file: {file}: a map of another tool or configuration (\"{title}\", motion {found:.8}); this configuration has \
         motion {own:.8}: make the map again from it with `flexdrill map`, or remove the key"
    )]
    OtherTool {
        /// Path of the file, for the message.
        file: String,
        /// Title of its configuration.
        title: String,
        /// Its hash.
        found: String,
        /// That of the configuration.
        own: String,
    },
}

/// A map of this tool.
#[derive(Debug, Clone, PartialEq)]
pub struct SafeWindow {
    map: Map,
    /// Whether the speed is the map's first axis.
    speed_is_x: bool,
}

/// Where a point is.
#[derive(Debug, Clone, PartialEq)]
pub enum Location<'a> {
    /// In a cell in which no alarm must be expected.
    Inside,
    /// In a cell in which one must be expected, or may come; with its number per run.
    Expected(Expectation<'a>),
    /// In a cell of which a run failed.
    Unknown,
    /// In a cell that was not run, and of which the runs around it do not say what it is.
    NotKnown,
    /// Off the map: which axis is left, and where it ends.
    Beyond {
        /// `rotary speed` or `weight on bit`.
        axis: &'static str,
        /// Last value of the map.
        end: f64,
        /// Of this.
        unit: &'static str,
    },
    /// Not judged: the weight is below that of the map, as off bottom.
    OffBottom,
}

/// The alarm that a cell has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expectation<'a> {
    /// Id of the likeliest one; empty where it is inferred only.
    pub alarm: &'a str,
    /// Largest chance of any alarm over the starts; none where inferred.
    pub chance: Option<f64>,
    /// Whether it comes from some starts only.
    pub depends: bool,
}

impl SafeWindow {
    /// The map that a configuration names, if it does; a relative path is relative to the folder of `config_file`.
    ///
    /// # Errors
    /// When the file is no map of this tool over speed and weight.
    pub fn of(config: &Config, config_file: &Path) -> Result<Option<Self>, WindowError> {
        let Some(file) = &config.map.file else {
            return Ok(None);
        };
        let folder = config_file.parent().map_or_else(PathBuf::new, Path::to_owned);
        let path = folder.join(file);
        Self::new(Map::load(&path)?, config, &path.display().to_string()).map(Some)
    }

    /// A map; `file` stands for it in errors.
    ///
    /// # Errors
    /// When it is not one of this tool over speed and weight.
    pub fn new(map: Map, config: &Config, file: &str) -> Result<Self, WindowError> {
        let speed_is_x = map.x.key == ROTARY_SPEED && map.y.key == WEIGHT_ON_BIT;
        let speed_is_y = map.y.key == ROTARY_SPEED && map.x.key == WEIGHT_ON_BIT;
        if !speed_is_x && !speed_is_y {
            return Err(WindowError::Axes {
                file: file.to_owned(),
                x: map.x.key,
                y: map.y.key,
            });
        }
        let own = config.motion_hash();
        if map.motion != own {
            return Err(WindowError::OtherTool {
                file: file.to_owned(),
                title: map.title,
                found: map.motion,
                own,
            });
        }
        Ok(Self { map, speed_is_x })
    }

    fn speeds(&self) -> &Axis {
        if self.speed_is_x { &self.map.x } else { &self.map.y }
    }

    fn weights(&self) -> &Axis {
        if self.speed_is_x { &self.map.y } else { &self.map.x }
    }

    fn cell(&self, speed: usize, weight: usize) -> Option<&Cell> {
        let (x, y) = if self.speed_is_x {
            (speed, weight)
        } else {
            (weight, speed)
        };
        self.map.cells.get(y * self.map.x.values.len() + x)
    }

    /// Where a speed (r/min) and a weight (kN) are.
    pub fn locate(&self, rpm: f64, kn: f64) -> Location<'_> {
        let (speeds, weights) = (&self.speeds().values, &self.weights().values);
        let [low, high] = ends(weights);
        if kn < low {
            return Location::OffBottom;
        }
        if kn > high {
            return beyond("weight on bit", weights, kn, "kN");
        }
        let [slow, fast] = ends(speeds);
        if !(slow..=fast).contains(&rpm) {
            return beyond("rotary speed", speeds, rpm, "r/min");
        }
        let Some(cell) = self.cell(nearest(speeds, rpm), nearest(weights, kn)) else {
            return Location::NotKnown;
        };
        match cell.verdict {
            Verdict::Clear => Location::Inside,
            Verdict::Unknown => Location::Unknown,
            Verdict::NotKnown => Location::NotKnown,
            Verdict::Alarm => Location::Expected(expectation(cell, false)),
            Verdict::DependsOnStart => Location::Expected(expectation(cell, true)),
        }
    }

    /// The cell nearest to a speed (r/min) and a weight (kN) in which no alarm must be expected, measured in the map's
    /// ranges. Such a cell was run, or is inferred with 95 %.
    pub fn nearest_inside(&self, rpm: f64, kn: f64) -> Option<[f64; 2]> {
        let (speeds, weights) = (&self.speeds().values, &self.weights().values);
        let ranges = [ends(speeds), ends(weights)].map(|[low, high]| high - low);
        let inside = speeds.iter().enumerate().flat_map(|(speed, of_speed)| {
            weights.iter().enumerate().filter_map(move |(weight, of_weight)| {
                let clear = self.cell(speed, weight)?.verdict == Verdict::Clear;
                clear.then_some([*of_speed, *of_weight])
            })
        });
        let away = |[speed, weight]: &[f64; 2]| ((speed - rpm) / ranges[0]).hypot((weight - kn) / ranges[1]);
        inside.min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// As a message.
    pub fn message(&self, header: Header) -> Message {
        let map = &self.map;
        let [least_members, most_members] = map.members_ended().unwrap_or_default();
        let mut message = Message {
            header,
            title: map.title.clone(),
            program: map.program.clone(),
            motion: map.motion.clone(),
            horizon: map.horizon,
            members: map.members,
            least_members,
            most_members,
            limit: map.limit,
            priority: priority_code(Some(map.priority)),
            rotary_speed_rpm: self.speeds().values.clone(),
            weight_on_bit_kn: self.weights().values.clone(),
            ..Message::default()
        };
        // The order is that of `flexdrill/SafeWindow`: weights outside, speeds inside, whichever axis of the map
        // is which. A viewer takes the arrays without the map's file.
        for weight in 0..message.weight_on_bit_kn.len() {
            for speed in 0..message.rotary_speed_rpm.len() {
                let Some(cell) = self.cell(speed, weight) else { continue };
                let Expectation { alarm, chance, .. } = expectation(cell, false);
                message.verdict.push(match cell.verdict {
                    Verdict::Clear => Message::CLEAR,
                    Verdict::Alarm => Message::ALARM,
                    Verdict::DependsOnStart => Message::DEPENDS_ON_START,
                    Verdict::Unknown => Message::UNKNOWN,
                    Verdict::NotKnown => Message::NOT_KNOWN,
                });
                // NaN stands for a share that no run gives: 0 would be read as "free of alarms".
                message.chance.push(chance.unwrap_or(f64::NAN));
                message.alarm.push(alarm.to_owned());
                let was_run = cell.starts.iter().any(|start| start.state.was_run());
                message.was_run.push(was_run);
            }
        }
        message
    }
}

/// The largest chance of any alarm over a cell's starts, with the likeliest alarm of that start.
fn expectation(cell: &Cell, depends: bool) -> Expectation<'_> {
    let known = cell
        .starts
        .iter()
        .filter_map(|start| Some((start.chance?, start.alarm.as_str())));
    let worst = known.max_by(|(a, _), (b, _)| a.total_cmp(b));
    Expectation {
        alarm: worst.map_or("", |(_, alarm)| alarm),
        chance: worst.map(|(chance, _)| chance),
        depends,
    }
}

/// The ends of an axis: half a cell beyond its first and last value.
fn ends(values: &[f64]) -> [f64; 2] {
    let [Some(first), Some(last)] = [values.first(), values.last()] else {
        return [f64::NAN; 2];
    };
    let half = |a: usize, b: usize| values.get(a).zip(values.get(b)).map_or(0.0, |(a, b)| 0.5 * (b - a));
    let count = values.len();
    [first - half(0, 1), last + half(count.saturating_sub(2), count - 1)]
}

fn nearest(values: &[f64], value: f64) -> usize {
    let away = |index: &usize| (values[*index] - value).abs();
    (0..values.len())
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .unwrap_or(0)
}

fn beyond(axis: &'static str, values: &[f64], value: f64, unit: &'static str) -> Location<'static> {
    let [low, _] = ends(values);
    let end = if value < low { values.first() } else { values.last() };
    Location::Beyond {
        axis,
        end: end.copied().unwrap_or(f64::NAN),
        unit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexdrill_alarms::Priority;
    use flexdrill_map::{FORMAT, OfStart, Origin, Start};

    fn config() -> Config {
        Config::from_text("coarse.yaml", include_str!("../../../config/coarse.yaml")).unwrap()
    }

    fn axis(key: &str, values: &[f64]) -> Axis {
        Axis {
            key: key.to_owned(),
            name: key.to_owned(),
            unit: String::new(),
            values: values.to_vec(),
        }
    }

    fn known(chance: f64, alarm: &str) -> OfStart {
        OfStart {
            state: Origin::Known,
            expected: chance > 0.1,
            confidence: 1.0,
            chance: Some(chance),
            interval: [0.0, 1.0],
            alarm: alarm.to_owned(),
            members: 10,
            ..OfStart::inferred(false, 1.0)
        }
    }

    /// Speeds of 40, 60 and 80 r/min, weights of 5 and 10 kN: whirl at 80 r/min, from one start at 60 r/min and 10 kN, and a
    /// failed run at 40 r/min and 10 kN; at 40 r/min and 5 kN a start is inferred. `turned` has the weight as the first axis.
    fn map(config: &Config, turned: bool) -> Map {
        let (speeds, weights) = (
            axis(ROTARY_SPEED, &[40.0, 60.0, 80.0]),
            axis(WEIGHT_ON_BIT, &[5.0, 10.0]),
        );
        let of = |rpm: f64, kn: f64| match (rpm, kn) {
            (80.0, _) => [
                known(0.8, "backward_whirl"),
                OfStart {
                    members: 6,
                    ..known(0.5, "backward_whirl")
                },
            ],
            (60.0, 10.0) => [known(0.0, ""), known(0.6, "chaotic_whirl")],
            (40.0, 10.0) => [
                known(0.0, ""),
                OfStart {
                    state: Origin::Unknown,
                    members: 1,
                    failed: 1,
                    ..OfStart::inferred(false, 0.5)
                },
            ],
            (40.0, _) => [known(0.0, ""), OfStart::inferred(false, 0.96)],
            _ => [known(0.0, ""), known(0.0, "")],
        };
        let (x, y) = if turned { (weights, speeds) } else { (speeds, weights) };
        let mut cells = Vec::new();
        for on_y in &y.values {
            for on_x in &x.values {
                let (rpm, kn) = if turned { (*on_y, *on_x) } else { (*on_x, *on_y) };
                let starts = of(rpm, kn).to_vec();
                cells.push(Cell {
                    x: *on_x,
                    y: *on_y,
                    verdict: Verdict::of(&starts),
                    starts,
                });
            }
        }
        Map {
            format: FORMAT,
            program: "flexdrill 0.2.0".to_owned(),
            title: "a test".to_owned(),
            configuration: config.hash(),
            motion: config.motion_hash(),
            x,
            y,
            horizon: 30.0,
            members: 20,
            run_all: false,
            first_alarm: false,
            plausible: false,
            posterior: None,
            seed: 1,
            priority: Priority::Medium,
            limit: 0.1,
            starts: Start::ALL.to_vec(),
            runs: 0,
            first_looks: 0,
            model_time: 0.0,
            cells,
        }
    }

    #[test]
    fn a_point_has_the_verdict_of_its_cell_whichever_axis_is_first() {
        let config = config();
        for turned in [false, true] {
            let window = SafeWindow::new(map(&config, turned), &config, "map.json").unwrap();
            assert_eq!(window.locate(45.0, 6.0), Location::Inside);
            assert_eq!(window.locate(45.0, 9.0), Location::Unknown);
            let Location::Expected(whirl) = window.locate(85.0, 4.0) else {
                panic!("whirl at 80 r/min")
            };
            assert_eq!(
                (whirl.alarm, whirl.chance, whirl.depends),
                ("backward_whirl", Some(0.8), false)
            );
            let Location::Expected(chaotic) = window.locate(60.0, 10.0) else {
                panic!("from one start")
            };
            assert_eq!((chaotic.alarm, chaotic.depends), ("chaotic_whirl", true));
            assert_eq!(window.locate(60.0, 2.0), Location::OffBottom);
            let beyond = |axis, end, unit| Location::Beyond { axis, end, unit };
            assert_eq!(window.locate(91.0, 5.0), beyond("rotary speed", 80.0, "r/min"));
            assert_eq!(window.locate(29.0, 5.0), beyond("rotary speed", 40.0, "r/min"));
            assert_eq!(window.locate(60.0, 13.0), beyond("weight on bit", 10.0, "kN"));
            assert_eq!(window.nearest_inside(85.0, 10.0), Some([60.0, 5.0]));
            let message = window.message(Header::default());
            let [clear, alarm] = [Message::CLEAR, Message::ALARM];
            let second = [Message::UNKNOWN, Message::DEPENDS_ON_START, alarm];
            assert_eq!(message.verdict, [[clear, clear, alarm], second].concat());
            assert_eq!(message.chance[2], 0.8);
            assert_eq!(message.alarm[4], "chaotic_whirl");
            assert_eq!(message.was_run, [true; 6]);
            let ended = [message.members, message.least_members, message.most_members];
            assert_eq!(ended, [20, 6, 10]);
        }
    }

    #[test]
    fn what_is_not_known_is_outside_and_is_never_advised() {
        let config = config();
        let mut map = map(&config, false);
        // At 60 r/min and 5 kN, the nearest clear point, nothing was run and nothing is known.
        let cell = &mut map.cells[1];
        cell.starts[1] = OfStart::not_known(0.9);
        cell.verdict = Verdict::of(&cell.starts);
        let window = SafeWindow::new(map, &config, "map.json").unwrap();
        assert_eq!(window.locate(60.0, 5.0), Location::NotKnown);
        assert_eq!(window.nearest_inside(85.0, 10.0), Some([40.0, 5.0]));
        let message = window.message(Header::default());
        assert_eq!(
            message.verdict[..3],
            [Message::CLEAR, Message::NOT_KNOWN, Message::ALARM]
        );
    }

    #[test]
    fn a_map_of_another_tool_or_over_other_keys_is_refused_in_words() {
        let config = config();
        let other = config.with_value("well.hole_diameter", 0.12).unwrap();
        let refused = |map: Map, config: &Config| SafeWindow::new(map, config, "map.json").unwrap_err().to_string();
        let words = refused(map(&config, false), &other);
        assert!(
            words.contains("map.json: a map of another tool") && words.contains("make the map again"),
            "{words}"
        );
        let renamed = config.with_value("run.title", "the same tool").unwrap();
        assert!(SafeWindow::new(map(&config, false), &renamed, "map.json").is_ok());
        let mut friction = map(&config, false);
        friction.x.key = "contact.inner.friction_tangential".to_owned();
        assert!(refused(friction, &config).contains("over contact.inner.friction_tangential and"));
    }

    #[test]
    fn a_map_that_is_missing_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let named = config().with_value("map.file", "no_such.json").unwrap();
        let error = SafeWindow::of(&named, &folder.path().join("tool.yaml"))
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("map.file: ") && error.contains("no_such.json"),
            "{error}"
        );
        assert_eq!(SafeWindow::of(&config(), Path::new("tool.yaml")).unwrap(), None);
    }
}
