//! `/clock`, followed with suspicion: one message must not carry the model and all its stamps into another year.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::rig::{RigInputs, decode};
use crate::dds::port::{Inbox, Sample};
use crate::messages::rosgraph_msgs::Clock;
use flexdrill_realtime::clock::LEAP;
use flexdrill_realtime::monotonic;
use flexdrill_text::Throttle;

/// Wall time for which ticks must agree on another time before it is believed (ns).
const AGREED_FOR: u64 = 2_000_000_000;
/// Ticks that must agree: a clock that comes once a second needs no longer than one that comes often.
const AGREED_TICKS: u32 = 3;
/// Least time between two lines about ticks that were ignored (s).
const LOG_INTERVAL: f64 = 10.0;

/// What a tick came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Tick {
    /// It is the present time.
    Followed,
    /// It is the present time, and the clock was set by so much to get there (ns).
    Set(i128),
    /// It is so far from the present time (ns) that it is not believed yet.
    Ignored(i128),
}

/// Another time that ticks tell of.
#[derive(Debug, Clone, Copy)]
struct Other {
    /// Newest of these ticks (ns).
    time: u64,
    /// When the first one came (wall, ns).
    since: u64,
    ticks: u32,
}

/// Follows the ticks of a simulated clock.
#[derive(Debug, Default)]
struct Follower {
    /// Present time (ns); 0 before the first tick.
    present: u64,
    other: Option<Other>,
}

impl Follower {
    /// Takes a tick of `time` (ns) that came at `wall` (ns). A step of up to [`LEAP`] is followed at once; a longer one,
    /// either way, when only ticks of the other time have come for a while: a player that was moved, or a simulation that
    /// was started over.
    fn take(&mut self, time: u64, wall: u64) -> Tick {
        let by = i128::from(time) - i128::from(self.present);
        if self.present == 0 || by.unsigned_abs() <= u128::from(LEAP) {
            let before = std::mem::replace(&mut self.present, time);
            self.other = None;
            return if by < 0 && before != 0 {
                Tick::Set(by)
            } else {
                Tick::Followed
            };
        }
        let agrees = |other: &Other| time.abs_diff(other.time) <= LEAP;
        let other = match self.other.filter(agrees) {
            Some(other) => Other {
                time,
                ticks: other.ticks + 1,
                ..other
            },
            None => Other {
                time,
                since: wall,
                ticks: 1,
            },
        };
        if other.ticks >= AGREED_TICKS && wall.saturating_sub(other.since) >= AGREED_FOR {
            self.present = time;
            self.other = None;
            return Tick::Set(by);
        }
        self.other = Some(other);
        Tick::Ignored(by)
    }
}

/// Follows `/clock`; `newest` is in ns.
pub async fn follow(rig: RigInputs, ticks: Arc<Inbox<Sample>>, newest: Arc<AtomicU64>) {
    let mut follower = Follower::default();
    let mut ignored_lines = Throttle::new(LOG_INTERVAL);
    loop {
        let Ok((Clock { clock }, writer)) = decode::<Clock>(ticks.next().await) else {
            continue;
        };
        let wall = monotonic::now();
        let tick = follower.take(clock.to_nanoseconds().max(0) as u64, wall);
        newest.store(follower.present, Ordering::Release);
        match tick {
            Tick::Followed => {}
            Tick::Set(by) => {
                tracing::warn!(
                    "/clock was set by {:+.3} s; the model goes on from where it is, with stamps of the new time",
                    by as f64 * 1e-9
                );
                rig.clock_set();
            }
            Tick::Ignored(by) => {
                if let Some(more) = ignored_lines.ending(wall as f64 * 1e-9) {
                    tracing::warn!(
                        "/clock: a time {:+.3} s from the present one is ignored until only such have come for {} s; is \
                         another program publishing /clock? Its writer is {}{more}",
                        by as f64 * 1e-9,
                        AGREED_FOR / 1_000_000_000,
                        hex(&writer)
                    );
                }
            }
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: u64 = 1_000_000_000;
    /// 2038-01-18 (ns since 1970).
    const FORGED: u64 = 2_147_400_000 * SECOND;

    /// A follower of a clock that has told 1000 s, at a wall time of 50 s.
    fn followed() -> Follower {
        let mut follower = Follower::default();
        assert_eq!(follower.take(1000 * SECOND, 50 * SECOND), Tick::Followed);
        follower
    }

    #[test]
    fn forged_ticks_among_true_ones_are_never_believed() {
        let mut follower = followed();
        for tenth in 1..600_u64 {
            let wall = 50 * SECOND + tenth * SECOND / 10;
            for forged in [FORGED, 1] {
                assert!(matches!(follower.take(forged, wall), Tick::Ignored(_)));
            }
            let time = 1000 * SECOND + tenth * SECOND / 10;
            assert_eq!(follower.take(time, wall), Tick::Followed);
            assert_eq!(follower.present, time);
        }
    }

    #[test]
    fn a_clock_that_was_moved_is_believed_after_a_while_and_comes_back_the_same_way() {
        let mut follower = followed();
        let mut wall = 50 * SECOND;
        for begin in [FORGED, 1000 * SECOND, 3 * SECOND] {
            let first_wall = wall;
            let set = (0..100_u64).find_map(|tenth| {
                wall = first_wall + tenth * SECOND / 10;
                match follower.take(begin + tenth * SECOND / 10, wall) {
                    Tick::Set(by) => Some(by),
                    Tick::Ignored(_) => None,
                    Tick::Followed => panic!("believed at once"),
                }
            });
            assert!(set.is_some());
            assert_eq!(wall - first_wall, AGREED_FOR);
            assert_eq!(follower.present, begin + AGREED_FOR);
        }
    }

    #[test]
    fn a_paused_a_fast_and_a_slightly_corrected_clock_are_followed_at_once() {
        let mut follower = followed();
        assert_eq!(follower.take(1000 * SECOND, 51 * SECOND), Tick::Followed);
        assert_eq!(follower.take(1010 * SECOND, 52 * SECOND), Tick::Followed);
        assert_eq!(
            follower.take(1007 * SECOND, 53 * SECOND),
            Tick::Set(-3 * i128::from(SECOND))
        );
    }
}
