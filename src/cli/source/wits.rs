//! The samples of a capture of a WITS line.

use std::collections::BTreeMap;
use std::path::Path;

use super::bags::of_message;
use super::{MeasuredSample, Samples, SurveySample};
use crate::cli::output::tell;
use crate::messages::builtin_interfaces::Time;
use flexdrill_bridge::wits::capture::{CaptureError, CaptureReader};
use flexdrill_bridge::wits::{Counts, Line, LineEvent, Mapping, Reading, Sources};
use flexdrill_text::{counted, printable};

/// Whether a file is a capture that `flexdrill bridge wits --capture` wrote.
pub(super) fn is_capture(path: &Path) -> bool {
    path.is_file() && CaptureReader::open(path).is_ok_and(|capture| capture.is_timed())
}

/// What the frames of a capture say, at the times at which they arrived. In a file without such times the frames have those
/// of their headers.
///
/// # Errors
/// When the file or the mapping cannot be read.
pub(super) fn read(path: &Path, mapping: Option<&Path>) -> anyhow::Result<Samples> {
    let mapping = mapping.map_or_else(|| Ok(Mapping::default()), Mapping::load)?;
    let capture = CaptureReader::open(path)?;
    let mut taken = Taken {
        utc_offset: mapping.utc_offset(),
        timed: capture.is_timed(),
        samples: Samples::default(),
        sources: Sources::default(),
        without_time: 0,
    };
    // Each connection has its own reader, because frames of two sources may interleave in the capture.
    let (mut counts, mut lines) = (Counts::default(), BTreeMap::<u64, Line>::new());
    let mut newest = 0;
    for block in capture {
        let block = match block {
            // What is before the damage is used.
            Err(error @ CaptureError::Damaged { .. }) => {
                tell!("{}", printable(&error.to_string()));
                break;
            }
            block => block?,
        };
        // Blocks without a time have that of the block before; in files without any, the frames' own stamps count.
        newest = block.time.unwrap_or(newest);
        // An empty block is the capture's mark for the end of a connection. A frame that was open ends with it.
        if block.bytes.is_empty() {
            if let Some(line) = lines.remove(&block.connection) {
                line.finish(newest, &mut counts, |event| taken.take(block.connection, event, newest));
            }
            taken.sources.closed(block.connection);
            continue;
        }
        let line = lines.entry(block.connection);
        let line = line.or_insert_with(|| Line::new(&mapping, &format!("connection {}", block.connection)));
        line.push(&block.bytes, newest, &mut counts, |event| {
            taken.take(block.connection, event, newest);
        });
    }
    // A capture that was stopped leaves connections open, and their last frames count.
    for (connection, line) in lines {
        line.finish(newest, &mut counts, |event| taken.take(connection, event, newest));
    }
    // The counts are printed even if all is well: a mapping that fits nothing also gives no error.
    let faults: u64 = counts.faults.iter().sum();
    tell!(
        "{}: {} frames, {} used with {} values; {} bytes in no frame, {faults} faulty items, {} records missing",
        path.display(),
        counts.frames,
        counts.used,
        counts.values,
        counts.discarded_bytes,
        counts.missing
    );
    if taken.without_time > 0 {
        tell!(
            "not used: {}; the file has no times of arrival, and a frame without date and time (items 05 and 06) has none",
            counted(taken.without_time, "frame")
        );
    }
    Ok(taken.samples)
}

/// What was read so far.
struct Taken {
    /// How far the clock of the headers is ahead of UTC (s).
    utc_offset: i32,
    /// Whether the times of arrival are known.
    timed: bool,
    samples: Samples,
    /// As in the bridge that wrote the capture.
    sources: Sources,
    without_time: u64,
}

impl Taken {
    fn take(&mut self, connection: u64, event: LineEvent, arrived: i64) {
        let LineEvent::Frame(_, mut reading) = event else {
            return;
        };
        if self.timed {
            self.sources.sort(connection, arrived, &mut reading);
        }
        if reading.inputs.is_none() && reading.measured.is_none() && reading.survey.is_none() {
            return;
        }
        let Some(time) = self.time(&reading, arrived) else {
            self.without_time += 1;
            return;
        };
        let Reading {
            inputs,
            measured,
            survey,
            ..
        } = *reading;
        let stamp = |given: Time| {
            if self.timed {
                given
            } else {
                Time::from_nanoseconds(time)
            }
        };
        if let Some(mut message) = inputs {
            message.header.stamp = stamp(message.header.stamp);
            self.samples.inputs.extend(of_message(&message, time));
        }
        if let Some(mut message) = measured {
            message.header.stamp = stamp(message.header.stamp);
            self.samples.measured.push(MeasuredSample { time, message });
        }
        if let Some(mut message) = survey {
            message.header.stamp = stamp(message.header.stamp);
            self.samples.surveys.push(SurveySample { time, message });
        }
    }

    /// When a frame arrived (ns since 1970), or what its first header says.
    fn time(&self, reading: &Reading, arrived: i64) -> Option<i64> {
        if self.timed {
            return Some(arrived);
        }
        let mut headers = reading.records.iter().map(|seen| &seen.header);
        headers.find_map(|header| header.instant(self.utc_offset))
    }
}
