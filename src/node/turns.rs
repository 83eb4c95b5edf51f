//! Shares of the look-ahead: goals of `~/what_if` come first, and the search for advice and the forecast get their turns
//! next to them, so that no client can take all of it by asking.

use std::time::{Duration, Instant};

/// Longest time for which goals keep the search and the forecast from a turn. The forecast looks a minute ahead: it is
/// then at most half a minute late.
const LONGEST_WAIT: Duration = Duration::from_secs(30);
/// Longest time of a goal while others wait.
pub const LONGEST_GOAL: Duration = Duration::from_secs(600);

/// A turn of the search and of the forecast.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// No goal is open: a goal that comes interrupts it.
    Free,
    /// Goals have had their time: it runs next to them, and no goal interrupts it.
    Kept,
}

/// Decides when the search and the forecast run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Turns {
    /// Since when goals have been open without a turn of the others.
    goals_since: Option<Instant>,
}

impl Turns {
    /// The turn that may begin at `now`, while goals are `open` or not.
    pub fn next(&mut self, open: bool, now: Instant) -> Option<Turn> {
        if !open {
            self.goals_since = None;
            return Some(Turn::Free);
        }
        let since = *self.goals_since.get_or_insert(now);
        (now.duration_since(since) >= LONGEST_WAIT).then_some(Turn::Kept)
    }

    /// A turn that was kept has ended: the goals have their time again.
    pub fn ended(&mut self, now: Instant) {
        self.goals_since = Some(now);
    }
}

/// Whether a goal that has run for so long ends with what it has found, because others wait.
pub fn is_over(ran: Duration, others_wait: bool) -> bool {
    others_wait && ran >= LONGEST_GOAL
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five goals of 67,200 s each were two hours and more without advice and without a forecast.
    #[test]
    fn goals_without_end_leave_a_turn_every_half_minute() {
        let begin = Instant::now();
        let (mut turns, mut kept) = (Turns::default(), 0);
        assert_eq!(turns.next(false, begin), Some(Turn::Free));
        for second in 0..600 {
            let now = begin + Duration::from_secs(second);
            match turns.next(true, now) {
                Some(Turn::Kept) => {
                    kept += 1;
                    // A search or a forecast of ten seconds.
                    turns.ended(now + Duration::from_secs(10));
                }
                other => assert_eq!(other, None),
            }
        }
        assert!((14..=15).contains(&kept), "{kept} turns in ten minutes");
        assert_eq!(turns.next(false, begin + Duration::from_secs(600)), Some(Turn::Free));
        assert_eq!(turns.next(true, begin + Duration::from_secs(601)), None);
    }

    #[test]
    fn a_goal_is_bounded_only_while_others_wait() {
        assert!(!is_over(Duration::from_secs(7200), false));
        assert!(!is_over(Duration::from_secs(599), true));
        assert!(is_over(Duration::from_secs(600), true));
    }
}
