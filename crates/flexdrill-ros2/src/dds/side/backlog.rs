//! Detects programs on this machine that do not read their packets, by the bytes that the system queues at each socket.

use std::net::{SocketAddr, UdpSocket};
use std::time::Duration;

/// Time between two checks, in which a healthy program empties its socket.
const CHECK_INTERVAL: Duration = Duration::from_millis(20);
const TABLES: [&str; 2] = ["/proc/net/udp", "/proc/net/udp6"];

/// Whether packets are queued in two checks in a row at one of those sockets that are on this machine.
pub(super) fn piles_up(sockets: &[SocketAddr]) -> bool {
    let ports: Vec<u16> = sockets
        .iter()
        .filter(|socket| is_local(socket))
        .map(SocketAddr::port)
        .collect();
    if ports.is_empty() || !is_waiting(&ports) {
        return false;
    }
    std::thread::sleep(CHECK_INTERVAL);
    is_waiting(&ports)
}

/// Only addresses of this machine can be bound.
fn is_local(socket: &SocketAddr) -> bool {
    UdpSocket::bind((socket.ip(), 0)).is_ok()
}

fn is_waiting(ports: &[u16]) -> bool {
    TABLES
        .iter()
        .filter_map(|table| std::fs::read_to_string(table).ok())
        .any(|table| {
            table
                .lines()
                .filter_map(waiting)
                .any(|(port, bytes)| bytes > 0 && ports.contains(&port))
        })
}

/// Port and queued bytes of a line of the table: `sl local_address rem_address st tx_queue:rx_queue ...`.
fn waiting(line: &str) -> Option<(u16, u64)> {
    let mut fields = line.split_whitespace();
    let port = fields.nth(1)?.rsplit(':').next()?;
    let bytes = fields.nth(2)?.split(':').nth(1)?;
    Some((
        u16::from_str_radix(port, 16).ok()?,
        u64::from_str_radix(bytes, 16).ok()?,
    ))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn a_socket_without_a_reading_program_is_detected() {
        let read = UdpSocket::bind("127.0.0.1:0").unwrap();
        let unread = UdpSocket::bind("127.0.0.1:0").unwrap();
        let from = UdpSocket::bind("127.0.0.1:0").unwrap();
        for to in [&read, &unread] {
            from.send_to(b"packet", to.local_addr().unwrap()).unwrap();
        }
        read.recv(&mut [0; 16]).unwrap();
        assert!(!piles_up(&[read.local_addr().unwrap()]));
        assert!(piles_up(&[unread.local_addr().unwrap()]));
        // The same port number on another machine does not count.
        let elsewhere = SocketAddr::from(([192, 0, 2, 1], unread.local_addr().unwrap().port()));
        assert!(!piles_up(&[elsewhere]));
    }
}
