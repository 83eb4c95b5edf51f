//! The subscription of `/clock`. A single forged or wrong message must not move the model and its stamps to another year.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::inputs::RigInputs;
use super::receive::decode;
use flexdrill_messages::rosgraph_msgs::Clock;
use flexdrill_realtime::clock::LEAP;
use flexdrill_realtime::monotonic;
use flexdrill_ros2::dds::port::{Inbox, Sample};
use flexdrill_text::{hex, log_ending};

/// Wall time for which messages must agree on another time before it is adopted (ns).
const AGREED_FOR: u64 = 2_000_000_000;
/// Messages that must agree, so that a clock of 1 Hz needs no longer than a faster one.
const AGREED_MESSAGES: u32 = 3;

/// The effect of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Effect {
    /// Its time is the present time.
    Followed,
    /// Its time is the present time, and the clock was set by this difference (ns).
    Set(i128),
    /// Its time is too far from the present time, by this difference (ns), to be adopted yet.
    Ignored(i128),
}

/// A time far from the present one, on which messages agree.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    /// The newest of these times (ns).
    time: u64,
    /// Wall time of the first of these messages (ns).
    since: u64,
    messages: u32,
}

/// Follows a simulated clock.
#[derive(Debug, Default)]
struct Follower {
    /// Present time (ns); 0 before the first message.
    present: u64,
    candidate: Option<Candidate>,
}

impl Follower {
    /// Judges a message with `time` (ns) that came at `wall` (ns). A change of up to [`LEAP`] is followed at once. A larger
    /// one, forward or back, is followed when only messages that agree on it have come for a while: the player was moved,
    /// or the simulation was restarted.
    fn update(&mut self, time: u64, wall: u64) -> Effect {
        let difference = i128::from(time) - i128::from(self.present);
        if self.present == 0 || difference.unsigned_abs() <= u128::from(LEAP) {
            let before = std::mem::replace(&mut self.present, time);
            self.candidate = None;
            return if difference < 0 && before != 0 {
                Effect::Set(difference)
            } else {
                Effect::Followed
            };
        }
        let agrees = |candidate: &Candidate| time.abs_diff(candidate.time) <= LEAP;
        let candidate = match self.candidate.filter(agrees) {
            Some(candidate) => Candidate {
                time,
                messages: candidate.messages + 1,
                ..candidate
            },
            None => Candidate {
                time,
                since: wall,
                messages: 1,
            },
        };
        if candidate.messages >= AGREED_MESSAGES && wall.saturating_sub(candidate.since) >= AGREED_FOR {
            self.present = time;
            self.candidate = None;
            return Effect::Set(difference);
        }
        self.candidate = Some(candidate);
        Effect::Ignored(difference)
    }
}

/// Follows `/clock` for as long as it is polled, and writes its time (ns) to `newest`.
pub async fn follow(inputs: RigInputs, messages: Arc<Inbox<Sample>>, newest: Arc<AtomicU64>) {
    let mut follower = Follower::default();
    loop {
        let Ok((Clock { clock }, writer)) = decode::<Clock>(messages.next().await) else {
            continue;
        };
        let wall = monotonic::now();
        let effect = follower.update(clock.to_nanoseconds().max(0) as u64, wall);
        newest.store(follower.present, Ordering::Release);
        match effect {
            Effect::Followed => {}
            Effect::Set(difference) => {
                let way = if difference > 0 { "ahead" } else { "back" };
                if let Some(more) = log_ending(format!("/clock was set {way}")) {
                    tracing::warn!(
                        "/clock was set by {:+.3} s; the model continues from its state, with stamps of the new time{more}",
                        difference as f64 * 1e-9
                    );
                }
                inputs.clock_set();
            }
            Effect::Ignored(difference) => {
                if let Some(more) = log_ending("/clock ignored") {
                    tracing::warn!(
                        "/clock: a time {:+.3} s from the present one is ignored until all messages agree on it for {} s; \
                         check whether another program publishes /clock. Its writer is {}{more}",
                        difference as f64 * 1e-9,
                        AGREED_FOR / 1_000_000_000,
                        hex(&writer)
                    );
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: u64 = 1_000_000_000;
    /// 2038-01-18 (ns since 1970).
    const FORGED: u64 = 2_147_400_000 * SECOND;

    /// A follower of a clock that has shown 1000 s, at a wall time of 50 s.
    fn followed() -> Follower {
        let mut follower = Follower::default();
        assert_eq!(follower.update(1000 * SECOND, 50 * SECOND), Effect::Followed);
        follower
    }

    #[test]
    fn forged_messages_among_true_ones_are_never_adopted() {
        let mut follower = followed();
        for tenth in 1..600_u64 {
            let wall = 50 * SECOND + tenth * SECOND / 10;
            for forged in [FORGED, 1] {
                assert!(matches!(follower.update(forged, wall), Effect::Ignored(_)));
            }
            let time = 1000 * SECOND + tenth * SECOND / 10;
            assert_eq!(follower.update(time, wall), Effect::Followed);
            assert_eq!(follower.present, time);
        }
    }

    #[test]
    fn a_clock_that_was_moved_is_adopted_after_a_while_forward_and_back() {
        let mut follower = followed();
        let mut wall = 50 * SECOND;
        for begin in [FORGED, 1000 * SECOND, 3 * SECOND] {
            let first_wall = wall;
            let set = (0..100_u64).find_map(|tenth| {
                wall = first_wall + tenth * SECOND / 10;
                match follower.update(begin + tenth * SECOND / 10, wall) {
                    Effect::Set(difference) => Some(difference),
                    Effect::Ignored(_) => None,
                    Effect::Followed => panic!("adopted at once"),
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
        assert_eq!(follower.update(1000 * SECOND, 51 * SECOND), Effect::Followed);
        assert_eq!(follower.update(1010 * SECOND, 52 * SECOND), Effect::Followed);
        assert_eq!(
            follower.update(1007 * SECOND, 53 * SECOND),
            Effect::Set(-3 * i128::from(SECOND))
        );
    }
}
