//! Handles wrong tokens: a refusal takes a pause, so that guessing is slow, and the log names the client's address.

use std::net::{IpAddr, SocketAddr};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use flexdrill_clock::monotonic;
use tokio::sync::Semaphore;

use flexdrill_text::Throttle;

/// Pause before a refusal. The right token is accepted at once, even while others try wrong ones.
const PAUSE: Duration = Duration::from_secs(1);
/// Largest number of refusals that pause at the same time; further ones wait before their pause.
const MOST_WAITING: usize = 8;
/// Largest number of addresses remembered; beyond it the one without a wrong token for the longest time is dropped.
const MOST_ADDRESSES: usize = 64;
/// Shortest time between two log lines about one address (s).
const LINE_INTERVAL: f64 = 10.0;

/// An address that has sent a wrong token.
#[derive(Debug)]
struct Offender {
    address: IpAddr,
    count: u64,
    line: Throttle,
}

/// Wrong tokens so far.
#[derive(Debug)]
pub struct WrongTokens {
    /// The most recent one comes last.
    offenders: Mutex<Vec<Offender>>,
    waiting: Semaphore,
}

impl Default for WrongTokens {
    fn default() -> Self {
        Self {
            offenders: Mutex::default(),
            waiting: Semaphore::new(MOST_WAITING),
        }
    }
}

impl WrongTokens {
    /// Logs a wrong token and pauses before the refusal; at most eight refusals per second complete.
    pub async fn refuse(&self, from: SocketAddr) {
        if let Some((count, more)) = self.count(from.ip(), monotonic::now() as f64 * 1e-9) {
            tracing::warn!("{from} sent a wrong token and was refused; {count} from this address so far{more}");
        }
        let _permit = self.waiting.acquire().await;
        tokio::time::sleep(PAUSE).await;
    }

    /// Counts a wrong token. Returns the address's count and the ending of the log line, if a line is due.
    fn count(&self, address: IpAddr, now: f64) -> Option<(u64, String)> {
        let mut offenders = self.offenders();
        let known = offenders.iter().position(|offender| offender.address == address);
        let mut offender = match known {
            Some(index) => offenders.remove(index),
            None => {
                if offenders.len() == MOST_ADDRESSES {
                    offenders.remove(0);
                }
                Offender {
                    address,
                    count: 0,
                    line: Throttle::new(LINE_INTERVAL),
                }
            }
        };
        offender.count += 1;
        let line = offender.line.ending(now).map(|more| (offender.count, more));
        offenders.push(offender);
        line
    }

    fn offenders(&self) -> MutexGuard<'_, Vec<Offender>> {
        self.offenders.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_address_is_counted_and_few_are_remembered() {
        let wrong = WrongTokens::default();
        let address = |number: u8| IpAddr::from([10, 0, 0, number]);
        assert_eq!(wrong.count(address(1), 0.0), Some((1, String::new())));
        assert_eq!(wrong.count(address(1), 1.0), None);
        assert_eq!(
            wrong.count(address(2), 1.0),
            Some((1, String::new())),
            "another address has its own lines"
        );
        assert_eq!(
            wrong.count(address(1), 11.0),
            Some((3, " (1 more since the last line)".to_owned()))
        );
        for number in 3..=200 {
            wrong.count(address(number), 12.0);
        }
        assert_eq!(wrong.offenders().len(), MOST_ADDRESSES);
    }

    #[tokio::test]
    async fn guessing_is_slow() {
        let wrong = WrongTokens::default();
        let start = std::time::Instant::now();
        let tries = (0..=MOST_WAITING).map(|_| wrong.refuse(([10, 0, 0, 1], 1).into()));
        futures::future::join_all(tries).await;
        assert!(start.elapsed() >= 2 * PAUSE, "nine guesses, eight a second");
    }
}
