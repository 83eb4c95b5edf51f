//! Number and times of recorded messages.

/// Number and times of recorded messages.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    /// Messages per topic.
    pub per_topic: Vec<u64>,
    /// First and last log time (ns).
    pub bounds: Option<(u64, u64)>,
}

impl Tally {
    /// No message on any of `topics` topics.
    pub fn new(topics: usize) -> Self {
        Self {
            per_topic: vec![0; topics],
            bounds: None,
        }
    }

    /// Number of messages on all topics.
    pub fn messages(&self) -> u64 {
        self.per_topic.iter().sum()
    }

    /// Adds a message.
    pub fn count(&mut self, topic: usize, log_time: u64) {
        if let Some(count) = self.per_topic.get_mut(topic) {
            *count += 1;
        }
        self.widen((log_time, log_time));
    }

    /// Adds the messages of another tally.
    pub fn add(&mut self, other: &Self) {
        for (sum, count) in self.per_topic.iter_mut().zip(&other.per_topic) {
            *sum += count;
        }
        if let Some(bounds) = other.bounds {
            self.widen(bounds);
        }
    }

    fn widen(&mut self, (from, to): (u64, u64)) {
        self.bounds = Some(match self.bounds {
            None => (from, to),
            Some((first, last)) => (first.min(from), last.max(to)),
        });
    }
}
