//! The connections of a listening line, and which of them yields to a new one.

use std::collections::BTreeMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::Notify;

/// Most connections that a listening line keeps at a time: sources of one rig.
pub const MOST_CONNECTIONS: usize = 8;
/// A connection without a whole frame for so long yields to one that waits. Rigs send one a second, slow ones every few
/// seconds.
const QUIET: Duration = Duration::from_secs(5);

/// The connections that are open. Clones share them.
#[derive(Debug, Clone, Default)]
pub struct Seats(Arc<Mutex<BTreeMap<u64, Seat>>>);

#[derive(Debug)]
struct Seat {
    host: IpAddr,
    /// When the newest whole frame came.
    frame: Option<Instant>,
    leave: Arc<Notify>,
}

impl Seats {
    fn all(&self) -> MutexGuard<'_, BTreeMap<u64, Seat>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A connection has sent a whole frame: it keeps its seat for the next five seconds.
    pub fn whole_frame(&self, connection: u64) {
        if let Some(seat) = self.all().get_mut(&connection) {
            seat.frame = Some(Instant::now());
        }
    }

    /// A seat for a connection from a host. Where all are taken and `give_way`, a connection that has sent no whole frame
    /// for [`QUIET`] is asked to leave. Returns what becomes ready when this connection has to leave; `None` where no seat
    /// is to be had.
    pub(super) fn take(&self, connection: u64, host: IpAddr, give_way: bool) -> Option<Arc<Notify>> {
        let mut all = self.all();
        if all.len() >= MOST_CONNECTIONS {
            let leaves = give_way.then(|| quietest(&all, Instant::now())).flatten()?;
            if let Some(seat) = all.remove(&leaves) {
                seat.leave.notify_one();
            }
        }
        let leave = Arc::new(Notify::new());
        all.insert(
            connection,
            Seat {
                host,
                frame: None,
                leave: Arc::clone(&leave),
            },
        );
        Some(leave)
    }

    /// A connection has ended.
    pub(super) fn leave(&self, connection: u64) {
        self.all().remove(&connection);
    }
}

/// The connection that yields: without a frame in the last [`QUIET`], of the host with most such connections, and there
/// the one that has been open longest. A host that opens many does not drive out the only one of another.
fn quietest(all: &BTreeMap<u64, Seat>, now: Instant) -> Option<u64> {
    let is_quiet = |seat: &Seat| seat.frame.is_none_or(|frame| now.duration_since(frame) > QUIET);
    let quiet: Vec<(u64, IpAddr)> = all
        .iter()
        .filter(|(_, seat)| is_quiet(seat))
        .map(|(connection, seat)| (*connection, seat.host))
        .collect();
    let of_host = |host: IpAddr| quiet.iter().filter(|(_, other)| *other == host).count();
    let (connection, _) = quiet
        .iter()
        .max_by_key(|(connection, host)| (of_host(*host), std::cmp::Reverse(*connection)))?;
    Some(*connection)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn host(last: u8) -> IpAddr {
        IpAddr::from([10, 0, 0, last])
    }

    #[test]
    fn the_quiet_give_way_those_of_the_busiest_host_first() {
        let seats = Seats::default();
        assert!(seats.take(1, host(1), true).is_some());
        for connection in 2..=8 {
            assert!(seats.take(connection, host(2), true).is_some());
        }
        assert!(seats.take(9, host(3), false).is_none(), "readers do not give way");
        assert!(seats.take(9, host(3), true).is_some());
        let open: Vec<u64> = seats.all().keys().copied().collect();
        assert_eq!(open, [1, 3, 4, 5, 6, 7, 8, 9], "the oldest of the host with most");
        for connection in open {
            seats.whole_frame(connection);
        }
        assert!(seats.take(10, host(1), true).is_none(), "all of them send");
        let later = Instant::now() + QUIET + Duration::from_secs(1);
        assert_eq!(quietest(&seats.all(), later), Some(3));
        seats.leave(4);
        assert!(seats.take(10, host(1), true).is_some());
    }
}
