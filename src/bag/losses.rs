//! Messages that a recording lost, by where: each cause has another remedy.

use std::fmt;

/// Messages lost, by cause.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Losses {
    /// Samples of the rig that came faster than they were taken, so that they were never handed over.
    pub flooded: u64,
    /// Found the recorder's queue full: the disk writes more slowly than messages come, or does not answer.
    pub too_slow: u64,
    /// Came while nothing could be written, or were in a file that was removed.
    pub unwritten: u64,
    /// In a file that the disk refused to keep.
    pub refused: u64,
}

impl Losses {
    /// All of them.
    pub fn total(&self) -> u64 {
        self.causes().map(|(count, _)| count).into_iter().sum()
    }

    /// What was lost since an earlier count.
    #[must_use]
    pub fn since(&self, before: &Self) -> Self {
        Self {
            flooded: self.flooded.saturating_sub(before.flooded),
            too_slow: self.too_slow.saturating_sub(before.too_slow),
            unwritten: self.unwritten.saturating_sub(before.unwritten),
            refused: self.refused.saturating_sub(before.refused),
        }
    }

    /// Both together.
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
                "came faster than they could be taken: a program floods an input",
            ),
            (self.too_slow, "found the disk too slow or not answering"),
            (
                self.unwritten,
                "could not be written: the disk was full or gone, or the file or its folder was removed",
            ),
            (self.refused, "are in a file that the disk refused to keep"),
        ]
    }
}

impl fmt::Display for Losses {
    /// Every cause that there was with its count; empty where nothing was lost.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let causes = self.causes();
        let some = causes.iter().filter(|(count, _)| *count > 0);
        for (index, (count, cause)) in some.enumerate() {
            let gap = if index > 0 { "; " } else { "" };
            write!(f, "{gap}{count} {cause}")?;
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
            "7 came faster than they could be taken: a program floods an input; 2 could not be written: the disk was full or \
             gone, or the file or its folder was removed"
        );
        assert_eq!(lost.since(&lost), Losses::default());
        assert_eq!(Losses::default().to_string(), "");
    }
}
