//! Judges the times of a log before a run: their direction and the usual step between rows, with the likely cause where
//! they cannot be right and the line of the mapping that cures it.

use crate::TimeFormat;
use crate::parts::Timed;
use crate::time_format::DAY;

/// The usual step between rows is not shorter (s): surface recorders write at most some tens of rows per second.
const SHORTEST: f64 = 8e-3;
/// The usual step between rows is not longer (s), unless the mapping allows longer gaps.
const LONGEST: f64 = 15.0;
/// Steps that another format would have to give to be a likely cause (s).
pub(crate) const LIKELY: std::ops::RangeInclusive<f64> = 0.05..=LONGEST;
/// With fewer steps the usual one is chance.
const FEW_STEPS: usize = 3;
/// Days of a spreadsheet from 1954 to 2119.
pub(crate) const EXCEL_DAYS: std::ops::Range<f64> = 20_000.0..80_000.0;

/// What is known of the times besides the rows.
pub(crate) struct Evidence<'a> {
    pub(crate) format: &'a TimeFormat,
    /// Whether the mapping names the format.
    pub(crate) is_named: bool,
    /// Name of the time column.
    pub(crate) column: &'a str,
    /// Its unit as the log gives it; empty where it gives none.
    pub(crate) unit: &'a str,
    pub(crate) max_gap: f64,
    /// The names of all columns.
    pub(crate) names: Vec<String>,
    /// A column of dates that the mapping does not name, with more than one date.
    pub(crate) other_dates: Option<String>,
}

/// The order of the rows in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Direction {
    OldestFirst,
    NewestFirst,
}

/// Why the times cannot be right, and what cures it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wrong {
    pub(crate) found: String,
    pub(crate) cure: String,
}

/// # Errors
/// When the times cannot be right.
pub(crate) fn judge(rows: &[Timed], evidence: &Evidence<'_>) -> Result<Direction, Wrong> {
    evidence.name_and_unit()?;
    if let Some(dates) = &evidence.other_dates {
        return Err(Wrong {
            found: format!(
                "it has no date, and column `{dates}` has several: the time between two rows of different days would be lost"
            ),
            cure: format!(
                "set `time: {{date: \"{dates}\", clock: \"{}\"}}` in the mapping",
                evidence.column
            ),
        });
    }
    let mut steps: Vec<f64> = rows
        .windows(2)
        .map(|pair| evidence.step(pair[0].time, pair[1].time))
        .collect();
    let count = |wanted: fn(&f64) -> bool| steps.iter().filter(|step| wanted(step)).count();
    let (rising, falling, standing) = (
        count(|step| *step > 0.0),
        count(|step| *step < 0.0),
        count(|step| *step == 0.0),
    );
    if rising + falling == 0 {
        return if standing < FEW_STEPS {
            Ok(Direction::OldestFirst)
        } else {
            Err(evidence.stands(standing, standing))
        };
    }
    let most = rising.max(falling);
    // A few rows out of order have their own reports; with many the file is not in the order of time.
    let is_mixed = rising.min(falling) * 3 > most && rising + falling >= 8;
    // The direction is certain when nearly all rows have it.
    let is_newest_first = falling >= FEW_STEPS && rising * 9 <= falling;
    if is_mixed || falling > rising && falling >= FEW_STEPS && !is_newest_first {
        return Err(Wrong {
            found: format!("it falls in {falling} rows and rises in {rising}"),
            cure: "sort the rows of the log by time, or name the column of time: `time: {column: ...}`".to_owned(),
        });
    }
    let forward = !is_newest_first;
    steps.retain(|step| if forward { *step > 0.0 } else { *step < 0.0 });
    if steps.len() >= FEW_STEPS {
        steps.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        let usual = steps[steps.len() / 2].abs();
        evidence.step_size(usual, rows[rows.len() / 2].time, [standing, rows.len() - 1])?;
    }
    Ok(if forward {
        Direction::OldestFirst
    } else {
        Direction::NewestFirst
    })
}

impl Evidence<'_> {
    /// The time from one row to the next (s); over midnight where the times restart there.
    fn step(&self, from: f64, to: f64) -> f64 {
        let step = to - from;
        if self.format.restarts_daily() && step.abs() > DAY / 2.0 {
            step - DAY.copysign(step)
        } else {
            step
        }
    }

    /// Refuses a column whose name or unit says that it is something else.
    fn name_and_unit(&self) -> Result<(), Wrong> {
        if self.format.seconds_in_one().is_none() {
            return Ok(());
        }
        if is_depth(self.column) || !is_time(self.column) && matches!(&*self.unit.to_lowercase(), "m" | "ft" | "f") {
            return Err(self.depth());
        }
        let Some(by_unit) = format_of_unit(self.unit) else {
            return Ok(());
        };
        // A format that the mapping names has been chosen; the default has not.
        if self.is_named || by_unit == *self.format {
            return Ok(());
        }
        Err(Wrong {
            found: format!(
                "the log gives its unit as {:?}, and the mapping reads seconds",
                self.unit
            ),
            cure: format!("set `{}` in `columns.time` of the mapping", by_unit.in_mapping()),
        })
    }

    fn depth(&self) -> Wrong {
        let times = self.names.iter().find(|name| is_time(name) && !is_depth(name));
        Wrong {
            found: "it seems to be a depth".to_owned(),
            cure: times.map_or_else(
                || "a log by depth has no time between its rows: export it by time".to_owned(),
                |name| format!("name the column of time: `time: {{column: \"{name}\"}}` in the mapping"),
            ),
        }
    }

    fn stands(&self, standing: usize, steps: usize) -> Wrong {
        let clock = self.names.iter().find(|name| *name != self.column && is_time(name));
        let example = clock.map_or_else(
            || "export the log with seconds".to_owned(),
            |clock| {
                format!(
                    "where another column has the clock, set `time: {{date: \"{}\", clock: \"{clock}\"}}` in the mapping",
                    self.column
                )
            },
        );
        Wrong {
            found: format!(
                "{standing} of {steps} rows repeat the time of the row before, as a time without seconds does"
            ),
            cure: example,
        }
    }

    /// Refuses a usual step (s) that no recorder has. `time` is that of a row in the middle (s).
    fn step_size(&self, usual: f64, time: f64, [standing, steps]: [usize; 2]) -> Result<(), Wrong> {
        let longest = LONGEST.max(self.max_gap);
        let Some(one) = self.format.seconds_in_one() else {
            if usual <= longest {
                return Ok(());
            }
            return Err(if standing * 2 > steps {
                self.stands(standing, steps)
            } else {
                self.rare(usual)
            });
        };
        let (step, number) = (usual / one, time / one);
        // Half a foot and a foot in metres are steps of depth, and of no clock.
        if [0.1524, 0.3048].iter().any(|foot| (step - foot).abs() < 1e-4) {
            return Err(self.depth());
        }
        if (SHORTEST..=longest).contains(&usual) {
            return Ok(());
        }
        let is_excel = EXCEL_DAYS.contains(&number) && step < SHORTEST && *self.format != TimeFormat::ExcelDays;
        let mut likely: Vec<(&TimeFormat, f64)> = TimeFormat::NUMBERS
            .iter()
            .filter_map(|format| Some((format, step * format.seconds_in_one()?)))
            .filter(|(format, step)| {
                if is_excel {
                    **format == TimeFormat::ExcelDays
                } else {
                    LIKELY.contains(step)
                }
            })
            .collect();
        // One row per second is the usual rate, so the nearest to it comes first.
        likely.sort_by(|a, b| a.1.ln().abs().total_cmp(&b.1.ln().abs()));
        if likely.is_empty() && usual > longest {
            return Err(if standing * 2 > steps {
                self.stands(standing, steps)
            } else {
                self.rare(usual)
            });
        }
        let cures: Vec<String> = likely
            .iter()
            .map(|(format, step)| format!("`{}` ({} s between rows)", format.in_mapping(), shown(*step)))
            .collect();
        Err(Wrong {
            found: format!(
                "read as {}, the rows are {} s apart, {} than any recorder writes them",
                self.format.name(),
                shown(usual),
                if usual > longest { "longer" } else { "faster" }
            ),
            cure: if cures.is_empty() {
                "set the format of the column in `columns.time` of the mapping".to_owned()
            } else {
                format!("set {} in `columns.time` of the mapping", cures.join(" or "))
            },
        })
    }

    fn rare(&self, usual: f64) -> Wrong {
        Wrong {
            found: format!(
                "the rows are {} s apart, and a value is held for {} s",
                shown(usual),
                self.max_gap
            ),
            cure: format!(
                "export the log with a row per second; if a row stands for so long, set `quality: {{max_gap: {}}}` in the \
                 mapping",
                shown((2.0 * usual).min(DAY))
            ),
        }
    }
}

/// The format of a column of numbers by its unit; `None` where it is no unit of time.
pub(crate) fn format_of_unit(unit: &str) -> Option<TimeFormat> {
    Some(match &*unit.to_lowercase() {
        "s" | "sec" | "secs" | "seconds" => TimeFormat::Seconds,
        "ms" | "msec" | "milliseconds" => TimeFormat::Milliseconds,
        "us" | "µs" | "microseconds" => TimeFormat::Microseconds,
        "ns" | "nanoseconds" => TimeFormat::Nanoseconds,
        "min" | "mins" | "minutes" => TimeFormat::Minutes,
        "h" | "hr" | "hrs" | "hours" => TimeFormat::Hours,
        "d" | "day" | "days" => TimeFormat::ExcelDays,
        _ => return None,
    })
}

/// Three digits of a step.
pub(crate) fn shown(seconds: f64) -> f64 {
    let scale = 10f64.powf(2.0 - seconds.log10().floor());
    let rounded = (seconds * scale).round() / scale;
    if rounded.is_finite() { rounded } else { seconds }
}

fn words(name: &str) -> impl Iterator<Item = String> + '_ {
    let words = name.split(|character: char| !character.is_alphanumeric());
    words.filter(|word| !word.is_empty()).map(str::to_lowercase)
}

pub(crate) fn is_time(name: &str) -> bool {
    let marks = ["time", "date", "clock", "utc", "sec", "stamp", "etim"];
    words(name).any(|word| word == "t" || marks.iter().any(|mark| word.contains(mark)))
}

pub(crate) fn is_depth(name: &str) -> bool {
    let is_mark = |word: String| word.starts_with("dept") || matches!(&*word, "md" | "tvd" | "dmea" | "dbtm");
    !is_time(name) && words(name).any(is_mark)
}
