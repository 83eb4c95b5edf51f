//! The sequence number of a record (item 04): whether frames were lost, repeated or came late.

/// Most records that can be missing on one connection: somewhat more than one per second for a day. A larger step is a
/// defect of the number, or a source that counts from its start again.
const MOST_MISSING: u64 = 100_000;

/// Contradictions after which numbers are declared unusable. One or two happen where a source begins again.
const STRIKES: u32 = 3;
/// So many records in order forget earlier contradictions: a source that wraps at 100 counts.
const IN_ORDER: u32 = 50;
/// A second counter on the line advances by at most so much between two of its records.
const SMALL_STEP: u64 = 16;

/// What a record's sequence number says, compared with those before it on the same connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sequence {
    /// The record has no number that can be used.
    Unnumbered,
    /// The first of this record on this connection.
    First,
    /// One more than the last.
    Next,
    /// The same number as the last, with the same contents.
    Duplicate,
    /// The same number as the last, with other contents: the record is new, and the number does not count.
    Stalled,
    /// Less than the last, with a later date and time in the header: the source counts from its start again.
    Restarted,
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
        matches!(
            self,
            Self::Unnumbered | Self::First | Self::Next | Self::Stalled | Self::Restarted | Self::Gap { .. }
        )
    }
}

/// A record, as far as its sequence is concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Numbered {
    /// Its number.
    pub number: u64,
    /// A hash of its other items.
    pub contents: u64,
    /// Date and time of its header (ns since 1970), if it has them.
    pub instant: Option<i64>,
    /// Whether the number is a date or a time of day.
    pub is_clock: bool,
}

/// Why the numbers of a record are not used, found once per connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SequenceDefect {
    /// Records with other contents have the same number.
    Constant,
    /// The numbers count down, or begin again every few records.
    NoCount,
    /// The numbers are dates or times.
    Clock,
    /// Two counters alternate: two sources share the line. The records of the smaller number are not used.
    TwoCounters,
}

impl SequenceDefect {
    /// In words, without the record.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Constant => {
                "has the same number in records with other contents. The number is not used from now on: every record is, \
                 and missing ones are not noticed. `sequence: ignore` in the mapping does so from the start"
            }
            Self::NoCount => {
                "does not count: it counts down or begins again every few records. The number is not used from now on: \
                 every record is, and missing ones are not noticed. `sequence: ignore` in the mapping does so from the \
                 start"
            }
            Self::Clock => {
                "holds a date or a time. The number is not used from now on: every record is, and missing ones are not \
                 noticed. `sequence: ignore` in the mapping does so from the start"
            }
            Self::TwoCounters => {
                "has two counters in turn, as if two sources shared the line. Records of the smaller number are not used, \
                 and the inputs are suspect. Disconnect one source, or give each a connection"
            }
        }
    }
}

/// Follows the sequence numbers of one record on one connection.
#[derive(Debug, Clone, Default)]
pub struct SequenceWatch {
    newest: Option<Numbered>,
    /// The last number that was out of order or jumped: a source that counts from its start again continues from there.
    anew: Option<u64>,
    /// The last number that was out of order, which a second counter would continue.
    behind: Option<u64>,
    /// Hash of the newest record, used or not.
    contents: Option<u64>,
    /// Contradictions, and records in order since the last one.
    strikes: u32,
    in_order: u32,
    /// Records that continued the smaller of two counters.
    second: u32,
    /// Records that were counted as missing since the numbers were in order.
    counted_missing: u64,
    defect: Option<SequenceDefect>,
}

/// What a number says, and what it reveals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Classified {
    /// What it says.
    pub sequence: Sequence,
    /// A defect of the numbers that this one reveals.
    pub found: Option<SequenceDefect>,
    /// Records counted as missing before, by numbers that do not count.
    pub retracted: u64,
}

impl SequenceWatch {
    /// The defect of the numbers, if one was found.
    pub const fn defect(&self) -> Option<SequenceDefect> {
        self.defect
    }

    /// Classifies the next record.
    pub fn classify(&mut self, next: Numbered) -> Classified {
        let known = self.defect;
        if known.is_some_and(|defect| defect != SequenceDefect::TwoCounters) {
            return Classified {
                sequence: Sequence::Unnumbered,
                found: None,
                retracted: 0,
            };
        }
        let mut sequence = self.compare(next);
        let is_new = self.contents.replace(next.contents) != Some(next.contents);
        self.judge(sequence, next, is_new);
        let found = self.defect.filter(|_| known.is_none());
        match self.defect {
            Some(SequenceDefect::TwoCounters) => {
                // The counters' steps depend on how the sources alternate.
                if let Sequence::Gap { .. } = sequence {
                    sequence = Sequence::Next;
                }
            }
            Some(_) => sequence = Sequence::Unnumbered,
            None => {}
        }
        if let Sequence::Gap { missing } = sequence {
            self.counted_missing = self.counted_missing.saturating_add(missing);
        }
        let retracted = match found {
            Some(_) => std::mem::take(&mut self.counted_missing),
            None => 0,
        };
        Classified {
            sequence,
            found,
            retracted,
        }
    }

    fn compare(&mut self, next: Numbered) -> Sequence {
        let number = next.number;
        let Some(last) = self.newest else {
            self.newest = Some(next);
            return Sequence::First;
        };
        let newest = last.number;
        let continues_anew = self.anew.is_some_and(|anew| anew.checked_add(1) == Some(number));
        let is_later = next.instant.zip(last.instant).is_some_and(|(next, last)| next > last);
        let found = if continues_anew || newest.checked_add(1) == Some(number) {
            Sequence::Next
        } else if number == newest || self.anew == Some(number) {
            // A repetition is equal in everything.
            if self.contents == Some(next.contents) {
                return Sequence::Duplicate;
            }
            Sequence::Stalled
        } else if number > newest && number - newest - 1 <= MOST_MISSING {
            Sequence::Gap {
                missing: number - newest - 1,
            }
        } else if number > newest {
            self.anew = Some(number);
            return Sequence::Jump { newest };
        } else if is_later && self.second == 0 && !self.continues_behind(number) {
            Sequence::Restarted
        } else {
            self.anew = Some(number);
            return Sequence::OutOfOrder { newest };
        };
        self.anew = None;
        self.newest = Some(next);
        found
    }

    /// Whether a number continues those that were out of order.
    fn continues_behind(&self, number: u64) -> bool {
        self.behind
            .is_some_and(|behind| number > behind && number - behind <= SMALL_STEP)
    }

    /// Counts contradictions. Repetitions of the same record are none.
    fn judge(&mut self, sequence: Sequence, next: Numbered, is_new: bool) {
        if next.is_clock {
            self.strike(SequenceDefect::Clock);
            return;
        }
        match sequence {
            Sequence::Next | Sequence::Gap { .. } => {
                self.in_order += 1;
                if self.in_order >= IN_ORDER {
                    (self.strikes, self.counted_missing, self.second) = (0, 0, 0);
                    self.behind = None;
                }
            }
            Sequence::Stalled => self.strike(SequenceDefect::Constant),
            Sequence::OutOfOrder { .. } if self.continues_behind(next.number) => {
                self.behind = Some(next.number);
                self.in_order = 0;
                self.second += 1;
                if self.second >= STRIKES {
                    self.defect = Some(SequenceDefect::TwoCounters);
                }
            }
            Sequence::OutOfOrder { .. } | Sequence::Restarted if is_new => {
                self.behind = Some(next.number);
                self.strike(SequenceDefect::NoCount);
            }
            Sequence::Jump { .. } if is_new => self.strike(SequenceDefect::NoCount),
            Sequence::Unnumbered
            | Sequence::First
            | Sequence::Duplicate
            | Sequence::Restarted
            | Sequence::Jump { .. }
            | Sequence::OutOfOrder { .. } => {}
        }
    }

    fn strike(&mut self, defect: SequenceDefect) {
        self.in_order = 0;
        self.strikes += 1;
        if self.strikes >= STRIKES {
            self.defect = Some(defect);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Sequence::{Duplicate, First, Gap, Jump, Next, OutOfOrder, Stalled, Unnumbered};

    fn classified(numbers: &[u64]) -> Vec<Sequence> {
        let mut watch = SequenceWatch::default();
        let classes = numbers
            .iter()
            .map(|number| watch.classify(numbered(*number, *number)).sequence);
        classes.collect()
    }

    fn numbered(number: u64, contents: u64) -> Numbered {
        Numbered {
            number,
            contents,
            instant: None,
            is_clock: false,
        }
    }

    /// Classes and defect of 120 records, each with contents unlike those before. `time`: their headers have times.
    fn long(number: impl Fn(u64) -> u64, time: bool) -> (Vec<Sequence>, Option<SequenceDefect>, u64) {
        let mut watch = SequenceWatch::default();
        let (mut classes, mut missing) = (Vec::new(), 0_u64);
        for record in 0..120 {
            let instant = time.then_some(i64::try_from(record).unwrap() * 1_000_000_000);
            let next = Numbered {
                instant,
                ..numbered(number(record), record)
            };
            let found = watch.classify(next);
            missing -= found.retracted;
            if let Gap { missing: more } = found.sequence {
                missing += more;
            }
            classes.push(found.sequence);
        }
        (classes, watch.defect(), missing)
    }

    fn used(classes: &[Sequence]) -> usize {
        classes.iter().filter(|class| class.is_newest()).count()
    }

    #[test]
    fn a_constant_number_is_declared_unusable_after_three_and_every_record_is_used() {
        let (classes, defect, _) = long(|_| 7, false);
        assert_eq!(classes[..4], [First, Stalled, Stalled, Unnumbered]);
        assert_eq!((used(&classes), defect), (120, Some(SequenceDefect::Constant)));
        // Equal records are repetitions, however many.
        let mut watch = SequenceWatch::default();
        let repeated: Vec<_> = (0..9).map(|_| watch.classify(numbered(7, 1)).sequence).collect();
        assert_eq!(repeated[1..], [Duplicate; 8]);
        assert_eq!(watch.defect(), None);
    }

    #[test]
    fn numbers_that_count_down_or_wrap_early_lose_two_records_at_most() {
        for time in [false, true] {
            for (name, number) in [
                ("down", (|record| 9999 - record) as fn(u64) -> u64),
                ("wraps at 2", |record| record % 2),
                ("wraps at 3", |record| record % 3),
                ("wraps at 10", |record| record % 10),
            ] {
                let (classes, defect, missing) = long(number, time);
                assert!(
                    defect.is_some_and(|defect| defect != SequenceDefect::TwoCounters),
                    "{name}: {defect:?}"
                );
                let lost = 120 - used(&classes);
                assert!(lost <= if time { 0 } else { 2 }, "{name}: {lost} lost, {classes:?}");
                assert_eq!(missing, 0, "{name}");
            }
            // Counters of this length work, and show what is missing.
            let (classes, defect, _) = long(|record| record % 60, time);
            assert_eq!(defect, None);
            assert!(used(&classes) >= 118 + usize::from(time), "{classes:?}");
        }
    }

    #[test]
    fn two_counters_on_one_line_are_two_sources_and_nothing_is_missing() {
        for step in [1, 2] {
            let alternate = |record: u64| {
                let own = record / 2 * step;
                if record.is_multiple_of(2) { 5 + own } else { 1000 + own }
            };
            for time in [false, true] {
                let (classes, defect, missing) = long(alternate, time);
                assert_eq!(defect, Some(SequenceDefect::TwoCounters), "{step} {time} {classes:?}");
                assert_eq!(missing, 0);
                assert!((60..=63).contains(&used(&classes)), "{}", used(&classes));
            }
        }
    }

    #[test]
    fn a_number_that_is_a_clock_is_declared_so() {
        let mut watch = SequenceWatch::default();
        let next = |second: u64| Numbered {
            is_clock: true,
            ..numbered(20_260_925_083_700 + second, second)
        };
        let found: Vec<_> = (0..4).filter_map(|second| watch.classify(next(second)).found).collect();
        assert_eq!(found, [SequenceDefect::Clock]);
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
