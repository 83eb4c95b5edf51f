//! The sequence number of a record (item 04): whether frames were lost, repeated or came late.

/// Most records that can be missing on one connection: somewhat more than one per second for a day. A larger step is a
/// defect of the number, or a source that counts from its start again.
const MOST_MISSING: u64 = 100_000;

/// What a record's sequence number says, compared with those before it on the same connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sequence {
    /// The record has no number that can be read.
    Unnumbered,
    /// The first of this record on this connection.
    First,
    /// One more than the last.
    Next,
    /// The same as the last.
    Duplicate,
    /// Numbers are missing before it.
    Gap {
        /// How many.
        missing: u64,
    },
    /// Ahead of the last by more than can be missing: the number is wrong, or the source counts from its start again.
    Jump {
        /// The largest number before it.
        newest: u64,
    },
    /// Less than the last: it comes late, or the source counts from its start again.
    OutOfOrder {
        /// The largest number before it.
        newest: u64,
    },
}

impl Sequence {
    /// Whether the record is newer than all before it, as far as the numbers say.
    pub const fn is_newest(self) -> bool {
        matches!(self, Self::Unnumbered | Self::First | Self::Next | Self::Gap { .. })
    }
}

/// Follows the sequence numbers of one record on one connection.
#[derive(Debug, Clone, Copy, Default)]
pub struct SequenceWatch {
    newest: Option<u64>,
    /// The last number that was out of order or jumped: a source that counts from its start again continues from there.
    anew: Option<u64>,
}

impl SequenceWatch {
    /// Classifies the next number.
    pub fn classify(&mut self, number: u64) -> Sequence {
        let Some(newest) = self.newest else {
            self.newest = Some(number);
            return Sequence::First;
        };
        let continues_anew = self.anew.is_some_and(|anew| anew.checked_add(1) == Some(number));
        let found = if continues_anew || newest.checked_add(1) == Some(number) {
            Sequence::Next
        } else if number == newest || self.anew == Some(number) {
            return Sequence::Duplicate;
        } else if number > newest && number - newest - 1 <= MOST_MISSING {
            Sequence::Gap {
                missing: number - newest - 1,
            }
        } else if number > newest {
            self.anew = Some(number);
            return Sequence::Jump { newest };
        } else {
            self.anew = Some(number);
            return Sequence::OutOfOrder { newest };
        };
        self.anew = None;
        self.newest = Some(number);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Sequence::{Duplicate, First, Gap, Jump, Next, OutOfOrder};

    fn classified(numbers: &[u64]) -> Vec<Sequence> {
        let mut watch = SequenceWatch::default();
        numbers.iter().map(|number| watch.classify(*number)).collect()
    }

    #[test]
    fn each_number_has_its_class() {
        assert_eq!(
            classified(&[7, 8, 8, 12, 10, 13]),
            [
                First,
                Next,
                Duplicate,
                Gap { missing: 3 },
                OutOfOrder { newest: 12 },
                Next
            ]
        );
    }

    /// One number of 1e15 would otherwise count 1e15 records as missing, and all that follow as late.
    #[test]
    fn a_number_far_ahead_is_not_followed_unless_the_next_continues_it() {
        let far = 1_000_000_000_000_000;
        assert_eq!(
            classified(&[7, far, 8, 9, 9 + 100_001]),
            [First, Jump { newest: 7 }, Next, Next, Gap { missing: 100_000 }]
        );
        assert_eq!(
            classified(&[7, far, far + 1, far + 2]),
            [First, Jump { newest: 7 }, Next, Next]
        );
    }

    #[test]
    fn a_source_that_counts_anew_is_followed_from_its_second_number() {
        let found = classified(&[9998, 9999, 0, 1, 2]);
        assert_eq!(found, [First, Next, OutOfOrder { newest: 9999 }, Next, Next]);
        // A late frame alone does not turn the count back.
        assert_eq!(
            classified(&[5, 6, 3, 7, 8]),
            [First, Next, OutOfOrder { newest: 6 }, Next, Next]
        );
        assert_eq!(
            classified(&[u64::MAX, u64::MAX, 0]),
            [First, Duplicate, OutOfOrder { newest: u64::MAX }]
        );
    }
}
