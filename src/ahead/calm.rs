//! When a member without an alarm ends before its horizon: once its motion has stayed away from all levels, and nothing that grows as
//! it does would reach one.

use crate::alarms::{AlarmBook, AlarmId};
use flexdrill_core::twin::Snapshot;
use flexdrill_motion::{HazardKind, Severity};

/// Largest share of a level that counts as away from it. A margin of a fifth is what calibration leaves of friction.
const AWAY: f64 = 0.8;

/// The second half of the time after which a calm member ends, in two parts. A figure that grew from the first to the second, and
/// would reach a level by the end of the horizon, is not calm.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Calm {
    /// Looks after which a calm member ends, and those of its horizon.
    after: u64,
    all: u64,
    /// Largest figure over its level in each part.
    shares: [f64; 2],
}

impl Calm {
    /// Of a member that may end after so many looks of `all`.
    pub const fn new(after: u64, all: u64) -> Self {
        Self {
            after,
            all,
            shares: [0.0; 2],
        }
    }

    /// Takes a look, and says whether the member ends with it.
    pub fn ends(&mut self, look: u64, snapshot: &Snapshot, book: &AlarmBook) -> bool {
        let begin = self.after / 2;
        if look <= begin || look > self.after || self.after >= self.all {
            return false;
        }
        let part = usize::from(look > begin + (self.after - begin) / 2);
        let stands = AlarmId::ALL.into_iter().any(|id| book.active(id).is_some());
        let share = if stands { f64::INFINITY } else { share(snapshot) };
        self.shares[part] = self.shares[part].max(share);
        look == self.after && self.is_away()
    }

    /// Whether the motion stays away from all levels to the end of the horizon, if it goes on as in the two parts.
    fn is_away(&self) -> bool {
        let [first, second] = self.shares;
        // The parts are a quarter of the time each; growth is continued along a line.
        let quarters = 4.0 * (self.all - self.after) as f64 / self.after as f64;
        first.max(second) < AWAY && second + (second - first).max(0.0) * quarters < 1.0
    }
}

/// The largest figure of a hazard over its level; infinite where a condition is met, or the level is not known.
fn share(snapshot: &Snapshot) -> f64 {
    let shares = HazardKind::ALL.map(|kind| {
        let of = snapshot.hazards.of(kind);
        match (of.severity, of.value / of.threshold) {
            (Severity::Ok, share) if share.is_finite() => share,
            // What is not judged here, or has not moved, has the value 0.
            (Severity::Ok, _) if of.value == 0.0 => 0.0,
            _ => f64::INFINITY,
        }
    });
    shares.into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use flexdrill_config::Config;

    /// Whether a member whose stick-slip index is this share of its level, by looks, ends after 300 of 600.
    fn ends(index: impl Fn(u64) -> f64) -> bool {
        let config = Config::from_text("default.yaml", include_str!("../../config/default.yaml")).unwrap();
        let book = AlarmBook::prompt(Arc::new(config), 0);
        let mut calm = Calm::new(300, 600);
        let mut snapshot = Snapshot::default();
        let ended: Vec<u64> = (1..=600)
            .filter(|look| {
                let of = &mut snapshot.hazards.list[HazardKind::StickSlip as usize];
                (of.value, of.threshold) = (0.5 * index(*look), 0.5);
                calm.ends(*look, &snapshot, &book)
            })
            .collect();
        assert!(ended.is_empty() || ended == [300], "{ended:?}");
        !ended.is_empty()
    }

    #[test]
    fn a_member_ends_where_nothing_comes_near_a_level() {
        assert!(ends(|_| 0.0) && ends(|_| 0.7));
        // What came first has ended.
        assert!(ends(|look| if look < 150 { 5.0 } else { 0.1 }));
        // Near a level, in either part.
        assert!(!ends(|_| 0.85));
        assert!(!ends(|look| if look == 160 { 0.85 } else { 0.1 }));
        assert!(!ends(|look| if look == 300 { 0.85 } else { 0.1 }));
        // 0.1 to 0.4 within a quarter of the time: 1.6 at the end.
        assert!(!ends(|look| if look > 225 { 0.4 } else { 0.1 }));
        assert!(ends(|look| if look > 225 { 0.25 } else { 0.1 }));
        // No figure says nothing.
        assert!(!ends(|_| f64::NAN));
    }

    #[test]
    fn a_member_with_a_whole_horizon_never_ends_early() {
        let config = Config::from_text("default.yaml", include_str!("../../config/default.yaml")).unwrap();
        let book = AlarmBook::prompt(Arc::new(config), 0);
        let mut calm = Calm::new(600, 600);
        assert!((1..=600).all(|look| !calm.ends(look, &Snapshot::default(), &book)));
    }
}
