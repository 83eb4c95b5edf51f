//! A set of alarms.

use std::fmt;

use super::catalogue::AlarmId;

const _: () = assert!(AlarmId::ALL.len() <= u64::BITS as usize);

/// A set of alarms, in the order of [`AlarmId::ALL`].
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct AlarmSet(u64);

impl AlarmSet {
    /// No alarm.
    pub const EMPTY: Self = Self(0);

    const fn bit(id: AlarmId) -> u64 {
        1 << id as usize
    }

    /// Whether an alarm is in it.
    pub const fn contains(self, id: AlarmId) -> bool {
        self.0 & Self::bit(id) != 0
    }

    /// Adds an alarm.
    pub const fn insert(&mut self, id: AlarmId) {
        self.0 |= Self::bit(id);
    }

    /// What is in either.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// What is in both.
    #[must_use]
    pub const fn common(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// What is not in the other.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether all of it is in the other.
    pub const fn is_within(self, other: Self) -> bool {
        self.without(other).is_empty()
    }

    /// Whether it has no alarm.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Number of alarms.
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Its alarms.
    pub fn iter(self) -> impl Iterator<Item = AlarmId> {
        AlarmId::ALL.into_iter().filter(move |id| self.contains(*id))
    }
}

impl FromIterator<AlarmId> for AlarmSet {
    fn from_iter<T: IntoIterator<Item = AlarmId>>(ids: T) -> Self {
        let mut set = Self::EMPTY;
        ids.into_iter().for_each(|id| set.insert(id));
        set
    }
}

impl fmt::Debug for AlarmSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

impl fmt::Display for AlarmSet {
    /// The names in a sentence: `backward whirl, lateral shock and stick-slip`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let last = self.len().saturating_sub(1);
        for (index, id) in self.iter().enumerate() {
            let joint = match index {
                0 => "",
                _ if index == last => " and ",
                _ => ", ",
            };
            write!(f, "{joint}{}", id.name())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_joined_parted_and_named() {
        let set = |ids: &[AlarmId]| ids.iter().copied().collect::<AlarmSet>();
        let all = AlarmId::ALL.into_iter().collect::<AlarmSet>();
        assert_eq!(
            (all.len(), all.iter().count()),
            (AlarmId::ALL.len(), AlarmId::ALL.len())
        );
        let two = set(&[AlarmId::StickSlip, AlarmId::BackwardWhirl]);
        assert!(two.contains(AlarmId::StickSlip) && !two.contains(AlarmId::Shock));
        assert_eq!(two.to_string(), "backward whirl and stick-slip");
        let three = two.union(set(&[AlarmId::Shock]));
        assert_eq!(three.to_string(), "backward whirl, lateral shock and stick-slip");
        assert!(two.is_within(three) && !three.is_within(two) && AlarmSet::EMPTY.is_within(two));
        assert_eq!(three.without(two), set(&[AlarmId::Shock]));
        assert_eq!(three.common(two), two);
        assert!(AlarmSet::EMPTY.is_empty() && AlarmSet::EMPTY.to_string().is_empty());
    }
}
