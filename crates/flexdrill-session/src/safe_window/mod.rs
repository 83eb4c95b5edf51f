//! The safe window: a map of speed and weight (`flexdrill map`), and where the present point is on it.

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use flexdrill_config::Config;
use flexdrill_map::{Map, MapError, ROTARY_SPEED, Verdict, WEIGHT_ON_BIT};
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
    /// The message of a recording contradicts itself.
    #[error(
        "twin/safe_window: {got} values of {field} for {cells} cells of speed and weight: the message is damaged, and the replay \
         judges no known_window"
    )]
    Recorded {
        /// The list of the message.
        field: &'static str,
        /// Its values.
        got: usize,
        /// Cells by the axes.
        cells: usize,
    },
}

/// A map of this tool, in the form in which it is published: a recording has all of it that a run is judged by.
#[derive(Debug, Clone, PartialEq)]
pub struct SafeWindow(Message);

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
        Ok(Self(message(&map, speed_is_x)))
    }

    /// The map that a recording has of its run, as `twin/safe_window`.
    ///
    /// # Errors
    /// When its lists do not belong together: bytes of a recording may be damaged.
    pub fn of_recording(message: Message) -> Result<Self, WindowError> {
        let cells = message.rotary_speed_rpm.len() * message.weight_on_bit_kn.len();
        for (field, got) in [
            ("verdict", message.verdict.len()),
            ("chance", message.chance.len()),
            ("alarm", message.alarm.len()),
            ("was_run", message.was_run.len()),
        ] {
            if got != cells || cells == 0 {
                return Err(WindowError::Recorded { field, got, cells });
            }
        }
        Ok(Self(message))
    }

    fn speeds(&self) -> &[f64] {
        &self.0.rotary_speed_rpm
    }

    fn weights(&self) -> &[f64] {
        &self.0.weight_on_bit_kn
    }

    /// The place of a cell in the lists of the message.
    fn place(&self, speed: usize, weight: usize) -> usize {
        weight * self.speeds().len() + speed
    }

    fn verdict(&self, place: usize) -> u8 {
        self.0.verdict.get(place).copied().unwrap_or(Message::NOT_KNOWN)
    }

    /// Where a speed (r/min) and a weight (kN) are.
    pub fn locate(&self, rpm: f64, kn: f64) -> Location<'_> {
        let (speeds, weights) = (self.speeds(), self.weights());
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
        let place = self.place(nearest(speeds, rpm), nearest(weights, kn));
        match self.verdict(place) {
            Message::CLEAR => Location::Inside,
            Message::UNKNOWN => Location::Unknown,
            Message::ALARM => Location::Expected(self.expectation(place, false)),
            Message::DEPENDS_ON_START => Location::Expected(self.expectation(place, true)),
            _ => Location::NotKnown,
        }
    }

    /// The largest chance of any alarm over the starts of a cell, with the likeliest alarm of that start.
    fn expectation(&self, place: usize, depends: bool) -> Expectation<'_> {
        Expectation {
            alarm: self.0.alarm.get(place).map_or("", String::as_str),
            chance: self.0.chance.get(place).copied().filter(|chance| !chance.is_nan()),
            depends,
        }
    }

    /// The cell nearest to a speed (r/min) and a weight (kN) in which no alarm must be expected, measured in the map's
    /// ranges. Such a cell was run, or is inferred with 95 %.
    pub fn nearest_inside(&self, rpm: f64, kn: f64) -> Option<[f64; 2]> {
        let (speeds, weights) = (self.speeds(), self.weights());
        let ranges = [ends(speeds), ends(weights)].map(|[low, high]| high - low);
        let inside = speeds.iter().enumerate().flat_map(|(speed, of_speed)| {
            weights.iter().enumerate().filter_map(move |(weight, of_weight)| {
                let clear = self.verdict(self.place(speed, weight)) == Message::CLEAR;
                clear.then_some([*of_speed, *of_weight])
            })
        });
        let away = |[speed, weight]: &[f64; 2]| ((speed - rpm) / ranges[0]).hypot((weight - kn) / ranges[1]);
        inside.min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// As a message.
    pub fn message(&self, header: Header) -> Message {
        Message {
            header,
            ..self.0.clone()
        }
    }
}

/// A map over speed and weight as a message without a header.
fn message(map: &Map, speed_is_x: bool) -> Message {
    let (speeds, weights) = if speed_is_x { (&map.x, &map.y) } else { (&map.y, &map.x) };
    let [least_members, most_members] = map.members_ended().unwrap_or_default();
    let mut message = Message {
        title: map.title.clone(),
        program: map.program.clone(),
        motion: map.motion.clone(),
        horizon: map.horizon,
        members: map.members,
        least_members,
        most_members,
        limit: map.limit,
        priority: priority_code(Some(map.priority)),
        rotary_speed_rpm: speeds.values.clone(),
        weight_on_bit_kn: weights.values.clone(),
        ..Message::default()
    };
    // The order is that of `flexdrill/SafeWindow`: weights outside, speeds inside, whichever axis of the map
    // is which. A viewer takes the arrays without the map's file.
    for weight in 0..weights.values.len() {
        for speed in 0..speeds.values.len() {
            let (x, y) = if speed_is_x { (speed, weight) } else { (weight, speed) };
            let Some(cell) = map.cells.get(y * map.x.values.len() + x) else {
                continue;
            };
            message.verdict.push(match cell.verdict {
                Verdict::Clear => Message::CLEAR,
                Verdict::Alarm => Message::ALARM,
                Verdict::DependsOnStart => Message::DEPENDS_ON_START,
                Verdict::Unknown => Message::UNKNOWN,
                Verdict::NotKnown => Message::NOT_KNOWN,
            });
            let known = cell
                .starts
                .iter()
                .filter_map(|start| Some((start.chance?, start.alarm.as_str())));
            let worst = known.max_by(|(a, _), (b, _)| a.total_cmp(b));
            // NaN stands for a share that no run gives: 0 would be read as "free of alarms".
            message.chance.push(worst.map_or(f64::NAN, |(chance, _)| chance));
            message.alarm.push(worst.map_or("", |(_, alarm)| alarm).to_owned());
            let was_run = cell.starts.iter().any(|start| start.state.was_run());
            message.was_run.push(was_run);
        }
    }
    message
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
