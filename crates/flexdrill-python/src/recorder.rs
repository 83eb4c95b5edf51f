//! A recording: columns that grow by a sample, and the events of the alarms.

use flexdrill_core::twin::Snapshot;
use flexdrill_messages::AlarmEvent;

use crate::columns::{Column, GROUPS, Group, INSTANT, Read, group};

/// Most bytes of a recording: more than a usual machine has memory for.
pub const MOST_BYTES: u64 = 16 << 30;

/// Why a recording cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecorderError {
    /// No group of that name.
    #[error("record: {name:?} is no group; the groups are {}", names())]
    UnknownGroup {
        /// The name that was asked for.
        name: String,
    },
    /// The rate does not make sense.
    #[error("rate_hz = {rate}: must be above 0 and at most {most} Hz, one sample per model step")]
    Rate {
        /// The rate that was asked for (Hz).
        rate: f64,
        /// The highest rate (Hz).
        most: f64,
    },
    /// It would not fit into the memory.
    #[error(
        "the recording would have {bytes} bytes: must be at most {MOST_BYTES}; record fewer groups, lower rate_hz, or \
         run in parts"
    )]
    TooLarge {
        /// Its size.
        bytes: u64,
    },
}

fn names() -> String {
    GROUPS.iter().map(|group| group.name).collect::<Vec<_>>().join(", ")
}

/// Values of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers.
    Real(Vec<f64>),
    /// Codes.
    Code(Vec<u8>),
    /// Counts and indices.
    Count(Vec<u64>),
}

impl Values {
    fn of(read: Read) -> Self {
        match read {
            Read::Number(_) | Read::Energy(_) | Read::List(_) | Read::Pairs(_) | Read::Triples(_) | Read::Few(_) => {
                Self::Real(Vec::new())
            }
            Read::Code(_) | Read::Codes(_) => Self::Code(Vec::new()),
            Read::Count(_) | Read::Indices(_) => Self::Count(Vec::new()),
        }
    }

    fn take(&mut self, read: Read, snapshot: &Snapshot) {
        match (self, read) {
            (Self::Real(out), Read::Number(read)) => out.push(read(snapshot)),
            (Self::Real(out), Read::Energy(read)) => out.push(read(&snapshot.energy)),
            (Self::Real(out), Read::List(read)) => out.extend_from_slice(read(snapshot)),
            (Self::Real(out), Read::Pairs(read)) => out.extend_from_slice(read(snapshot).as_flattened()),
            (Self::Real(out), Read::Triples(read)) => out.extend_from_slice(read(snapshot).as_flattened()),
            (Self::Real(out), Read::Few(read)) => read(snapshot, out),
            (Self::Code(out), Read::Code(read)) => out.push(read(snapshot)),
            (Self::Code(out), Read::Codes(read)) => read(snapshot, out),
            (Self::Count(out), Read::Count(read)) => out.push(read(snapshot)),
            (Self::Count(out), Read::Indices(read)) => read(snapshot, out),
            // `of` made the values for this very column.
            _ => {}
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Real(values) => values.len(),
            Self::Code(values) => values.len(),
            Self::Count(values) => values.len(),
        }
    }

    fn bytes(&self) -> u64 {
        let size = match self {
            Self::Real(_) | Self::Count(_) => 8,
            Self::Code(_) => 1,
        };
        self.len() as u64 * size
    }
}

/// A finished column.
#[derive(Debug, Clone, PartialEq)]
pub struct Finished {
    /// `group.column`, such as `bit.torque_nm`; `time_s` and `step` have no group.
    pub name: String,
    /// Length of each axis: time first, if the column has it, then the tool's, then the components'.
    pub shape: Vec<usize>,
    /// Values in that order.
    pub values: Values,
}

struct Kept {
    group: &'static str,
    column: Column,
    values: Values,
}

/// Columns that grow by a sample.
pub struct Recorder {
    columns: Vec<Kept>,
    /// Events of the alarms, as the node publishes them; their stamps are model time.
    pub alarms: Vec<AlarmEvent>,
    samples: usize,
    every: u64,
}

impl Recorder {
    /// For the groups of these names, a sample every `every` model steps (0: only those asked for by hand).
    ///
    /// # Errors
    /// When there is no group of a name.
    pub fn new<'a>(groups: impl IntoIterator<Item = &'a str>, every: u64) -> Result<Self, RecorderError> {
        let mut columns = Vec::new();
        add(&mut columns, &INSTANT);
        let mut taken: Vec<&str> = Vec::new();
        for name in groups {
            let group = group(name).ok_or_else(|| RecorderError::UnknownGroup { name: name.to_owned() })?;
            if !taken.contains(&name) {
                taken.push(name);
                add(&mut columns, group);
            }
        }
        Ok(Self {
            columns,
            alarms: Vec::new(),
            samples: 0,
            every,
        })
    }

    /// Model steps between two samples at `rate` (Hz), rounded to whole steps.
    ///
    /// # Errors
    /// When the rate is not above zero, or is higher than one sample per step.
    pub fn interval(rate: f64, time_step: f64) -> Result<u64, RecorderError> {
        let most = 1.0 / time_step;
        // Rounding of 1 / dt must not refuse the rate of every step.
        if rate > 0.0 && rate <= most * (1.0 + 1e-9) {
            Ok(((most / rate).round() as u64).max(1))
        } else {
            Err(RecorderError::Rate { rate, most })
        }
    }

    /// Whether a sample is due after `step` steps.
    pub fn is_due(&self, step: u64) -> bool {
        self.every > 0 && step.is_multiple_of(self.every)
    }

    /// Checks the size of a recording of `steps` model steps, by the sizes in `snapshot`.
    ///
    /// # Errors
    /// When it would be larger than [`MOST_BYTES`].
    pub fn check_size(&self, snapshot: &Snapshot, steps: u64) -> Result<(), RecorderError> {
        let samples = steps.checked_div(self.every).unwrap_or(0).saturating_add(1);
        let sample: u64 = (self.columns.iter().filter(|kept| !kept.column.fixed))
            .map(|kept| {
                let mut values = Values::of(kept.column.read);
                values.take(kept.column.read, snapshot);
                values.bytes()
            })
            .sum();
        let bytes = samples.saturating_mul(sample);
        if bytes > MOST_BYTES {
            return Err(RecorderError::TooLarge { bytes });
        }
        Ok(())
    }

    /// Adds a sample.
    pub fn sample(&mut self, snapshot: &Snapshot) {
        for kept in &mut self.columns {
            if !kept.column.fixed || self.samples == 0 {
                kept.values.take(kept.column.read, snapshot);
            }
        }
        self.samples += 1;
    }

    /// Samples so far.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The columns.
    pub fn finish(self) -> Vec<Finished> {
        let samples = self.samples;
        self.columns.into_iter().map(|kept| kept.finish(samples)).collect()
    }
}

fn add(columns: &mut Vec<Kept>, group: &'static Group) {
    columns.extend(group.columns.iter().map(|column| Kept {
        group: if group.name == INSTANT.name { "" } else { group.name },
        column: *column,
        values: Values::of(column.read),
    }));
}

impl Kept {
    fn finish(self, samples: usize) -> Finished {
        let along_time = if self.column.fixed { samples.min(1) } else { samples };
        let of_sample = self.values.len().checked_div(along_time).unwrap_or(0);
        let mut shape = if self.column.fixed { Vec::new() } else { vec![samples] };
        match self.column.read {
            Read::Number(_) | Read::Energy(_) | Read::Code(_) | Read::Count(_) => {}
            Read::List(_) | Read::Codes(_) | Read::Few(_) | Read::Indices(_) => shape.push(of_sample),
            Read::Pairs(_) => shape.extend([of_sample / 2, 2]),
            Read::Triples(_) => shape.extend([of_sample / 3, 3]),
        }
        let name = if self.group.is_empty() {
            self.column.name.to_owned()
        } else {
            format!("{}.{}", self.group, self.column.name)
        };
        Finished {
            name,
            shape,
            values: self.values,
        }
    }
}
