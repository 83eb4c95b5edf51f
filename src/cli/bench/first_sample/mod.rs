//! `--cases first-sample`: time from plugging a recorder in to its first sample at the twin's input.

mod recorder;
mod twin;

use std::time::{Duration, Instant};

use anyhow::Context as _;

use self::recorder::{Habit, Recorder, Wire};
use self::twin::Ends;
use crate::cli::built_in::DemoLog;
use crate::field_log;
use crate::rig_inputs::DriverId;
use flexdrill_bench::machine;
use flexdrill_bench::table::Table;
use flexdrill_bridge::wits::Mapping;
use flexdrill_config::Config;

/// How often a recorder that streams is plugged in, each time at another phase of its second.
const PLUGS: u32 = 5;

/// A line of the table: what it is, the recorder, and the mapping of the bridge.
type Line = (&'static str, Recorder, &'static str);

const fn streams(wire: Wire, frame: fn(u64) -> String) -> Recorder {
    Recorder {
        wire,
        habit: Habit::Streams,
        before: b"",
        frame,
    }
}

const fn answers(wire: Wire) -> Recorder {
    Recorder {
        wire,
        habit: Habit::Answers,
        before: b"",
        frame: recorder::named,
    }
}

/// The lines of the table in `docs/rig_inputs.md` that differ in what happens before the first sample.
const LINES: [Line; 13] = [
    ("streams, bridge connects", streams(Wire::Server, recorder::plain), ""),
    (
        "streams, connects to the bridge",
        streams(Wire::Client, recorder::plain),
        "",
    ),
    ("streams, serial line", streams(Wire::Serial, recorder::plain), ""),
    (
        "plugged in within a frame, behind the negotiation of a terminal server",
        Recorder {
            before: b"\xff\xfd\x01\xff\xfb\x03\x003.0\r\n012041\r\n!!\r\n",
            ..streams(Wire::Server, recorder::plain)
        },
        "",
    ),
    (
        "frames between STX and ETX, serial line",
        streams(Wire::Serial, recorder::framed),
        "",
    ),
    (
        "`1984PASON/EDR`, no items 01 to 07",
        streams(Wire::Server, recorder::named),
        "",
    ),
    ("item 04 constant", streams(Wire::Server, recorder::constant_number), ""),
    (
        "item 04 is date and time",
        streams(Wire::Server, recorder::date_as_number),
        "",
    ),
    (
        "connects while half frames hold all eight connections",
        streams(Wire::ClientBehindHalves, recorder::plain),
        "",
    ),
    ("answers only, bridge connects", answers(Wire::Server), ""),
    ("answers only, connects to the bridge", answers(Wire::Client), ""),
    ("answers only, serial line", answers(Wire::Serial), ""),
    (
        "answers only, mapping with `ask: {every_s: 1}`",
        answers(Wire::Server),
        "ask: {every_s: 1}\n",
    ),
];

/// Times of one plug, all since the connection was made.
struct Times {
    sent: Duration,
    accepted: Duration,
}

/// Measures all lines, each announced to `say`; gives the section of a document.
///
/// # Errors
/// When DDS, loopback or a pseudo terminal cannot be used, or no sample of a line is accepted.
pub(super) fn section(config: &Config, mut say: impl FnMut(&str)) -> anyhow::Result<String> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let table = runtime.block_on(async {
        let mut ends = Ends::join()?;
        // The nodes find each other before anything is measured, as those of a rig do.
        say("bridge and twin find each other");
        plugged(&mut ends, config, &LINES[0], Duration::ZERO).await?;
        let mut table = Table::new([
            "line",
            "plugs",
            "first frame sent after (s)",
            "first accepted sample after (s)",
            "of that bridge, DDS and input (ms)",
        ]);
        for line in &LINES {
            say(line.0);
            let plugs = match line.1.habit {
                Habit::Streams => PLUGS,
                Habit::Answers => 1,
            };
            let mut times = Vec::new();
            for plug in 0..plugs {
                let phase = Duration::from_secs(1) * (2 * plug + 1) / (2 * plugs);
                let measured = plugged(&mut ends, config, line, phase).await;
                times.push(measured.with_context(|| line.0.to_owned())?);
            }
            table.row(row(line.0, &times));
        }
        table.row(log_row(config)?);
        anyhow::Ok(table)
    })?;
    Ok(format!(
        "Command: `flexdrill bench --cases first-sample`. {}\n\nMedian and longest. Each line is a made recorder that is \
         plugged into a bridge. One that streams sends a frame per second, and its {PLUGS} plugs are at different phases \
         of that second; one that answers sends a frame per packet. The time ends when the input of a twin in another DDS \
         participant has accepted a sample. All run on loopback; a serial line is a pseudo terminal, without the time of \
         the bytes on a wire (0.13 s for such a frame at 9600 bit/s).\n\n{}",
        machine::describe(),
        table.text()
    ))
}

/// Plugs a recorder in once; one that streams sends its first frame after `phase`.
///
/// # Errors
/// When the line cannot be used or no sample is accepted.
async fn plugged(ends: &mut Ends, config: &Config, line: &Line, phase: Duration) -> anyhow::Result<Times> {
    let (name, recorder, mapping) = line;
    let mapping = Mapping::from_text(name, mapping)?;
    let (place, plug) = recorder.line(phase).await?;
    let (plugged, accepted) = ends.first_accepted(config, mapping, place, plug).await?;
    // The sample may be accepted before the recorder's thread has noted when it sent.
    let moment = || {
        let noted = plugged.moments.recv_timeout(Duration::from_secs(5));
        noted.context("the recorder sent nothing")
    };
    let (made, sent) = (moment()?, moment()?);
    Ok(Times {
        sent: sent - made,
        accepted: accepted - made,
    })
}

fn row(name: &str, times: &[Times]) -> [String; 5] {
    let of = |time: fn(&Times) -> Duration| times.iter().map(time).collect();
    [
        name.to_owned(),
        times.len().to_string(),
        median_and_longest(of(|times| times.sent), 1.0, 2),
        median_and_longest(of(|times| times.accepted), 1.0, 2),
        median_and_longest(of(|times| times.accepted.saturating_sub(times.sent)), 1e3, 1),
    ]
}

/// The demonstration's log: read and judged, until its first value is at the input.
///
/// # Errors
/// When the built-in log is refused.
fn log_row(config: &Config) -> anyhow::Result<[String; 5]> {
    let log = DemoLog;
    let times = (0..PLUGS).map(|_| {
        let (mapping, input) = (log.mapping()?, twin::input(config));
        let began = Instant::now();
        let (sequence, report) =
            field_log::read_bytes(log.name(), log.content(), &mapping, &field_log::Range::default())?;
        let first = sequence.inputs.first().context("the log has no input")?;
        let refused = input.accept_plain(first.kind, first.value, DriverId([0; 16]));
        anyhow::ensure!(
            refused.is_empty(),
            "the first value of the log is refused: {}",
            refused[0]
        );
        anyhow::Ok((began.elapsed(), report.rows))
    });
    let times = times.collect::<anyhow::Result<Vec<_>>>()?;
    let rows = times.first().map_or(0, |(_, rows)| *rows);
    let read = median_and_longest(times.iter().map(|(time, _)| *time).collect(), 1.0, 3);
    Ok([
        format!("a log of {rows} rows, read and judged"),
        times.len().to_string(),
        "-".to_owned(),
        read,
        "-".to_owned(),
    ])
}

/// Median and longest of some times, in seconds over `factor`; one of a single time.
fn median_and_longest(mut times: Vec<Duration>, factor: f64, digits: usize) -> String {
    times.sort();
    let in_words = |time: Option<&Duration>| {
        time.map_or_else(String::new, |time| format!("{:.digits$}", factor * time.as_secs_f64()))
    };
    let longest = in_words(times.last());
    match times.len() {
        0 | 1 => longest,
        many => format!("{}, {longest}", in_words(times.get(many / 2))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_their_median_and_the_longest() {
        let seconds = |times: &[u64]| times.iter().map(|time| Duration::from_secs(*time)).collect();
        assert_eq!(median_and_longest(seconds(&[3, 1, 9, 2, 5]), 1.0, 1), "3.0, 9.0");
        assert_eq!(median_and_longest(seconds(&[7]), 1e3, 0), "7000");
        assert_eq!(median_and_longest(Vec::new(), 1.0, 0), "");
    }

    #[test]
    fn the_built_in_log_has_a_first_value_that_is_accepted() {
        let config = crate::cli::built_in::BuiltIn::Default.or_file(None).unwrap();
        let [name, plugs, ..] = log_row(&config).unwrap();
        // A row that is earlier than one before it is left out; the header has no time.
        let text = String::from_utf8_lossy(DemoLog.content());
        let times = text
            .lines()
            .filter_map(|line| line.split(',').next()?.parse::<f64>().ok());
        let in_order = times.fold((0, f64::NEG_INFINITY), |(rows, last), time| {
            if time > last { (rows + 1, time) } else { (rows, last) }
        });
        assert_eq!(name, format!("a log of {} rows, read and judged", in_order.0));
        assert_eq!(plugs, PLUGS.to_string());
    }
}
