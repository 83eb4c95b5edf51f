//! Messages that a recording lost, by cause: each cause has its own remedy.

use std::fmt;

/// Messages lost, by cause.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Losses {
    /// Samples of the rig that arrived faster than the node processes them, so that none of them reached the recorder.
    pub flooded: u64,
    /// The recorder's queue was full: the disk writes more slowly than messages arrive, or does not respond.
    pub too_slow: u64,
    /// Arrived while no file could be written, or were in a file that was removed.
    pub unwritten: u64,
    /// In a file that the disk failed to sync.
    pub refused: u64,
}

impl Losses {
    /// Sum over all causes.
    pub fn total(&self) -> u64 {
        self.causes().map(|(count, _)| count).into_iter().sum()
    }

    /// The difference to an earlier count.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        Self {
            flooded: self.flooded.saturating_sub(before.flooded),
            too_slow: self.too_slow.saturating_sub(before.too_slow),
            unwritten: self.unwritten.saturating_sub(before.unwritten),
            refused: self.refused.saturating_sub(before.refused),
        }
    }

    /// The sum of both.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            flooded: self.flooded + other.flooded,
            too_slow: self.too_slow + other.too_slow,
            unwritten: self.unwritten + other.unwritten,
            refused: self.refused + other.refused,
        }
    }

    fn causes(&self) -> [(u64, &'static str); 4] {
        [
            (
                self.flooded,
                "arrived faster than the node processes them: a program floods an input",
            ),
            (self.too_slow, "found the disk too slow or not responding"),
            (
                self.unwritten,
                "could not be written: the disk was full or gone, or the file or its folder was removed",
            ),
            (self.refused, "are in a file that the disk failed to sync"),
        ]
    }
}

impl fmt::Display for Losses {
    /// Each cause with its count; empty when nothing was lost.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let causes = self.causes();
        let present = causes.iter().filter(|(count, _)| *count > 0);
        for (index, (count, cause)) in present.enumerate() {
            let separator = if index > 0 { "; " } else { "" };
            write!(f, "{separator}{count} {cause}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cause_is_named_with_its_own_count() {
        let lost = Losses {
            flooded: 7,
            unwritten: 2,
            ..Losses::default()
        };
        assert_eq!(lost.total(), 9);
        assert_eq!(
            lost.to_string(),
            "7 arrived faster than the node processes them: a program floods an input; 2 could not be written: the disk was full or \
             gone, or the file or its folder was removed"
        );
        assert_eq!(lost.since(&lost), Losses::default());
        assert_eq!(Losses::default().to_string(), "");
    }
}
