//! The public port of the server. It bounds connections, because the crate accepts any number, and hands those that begin
//! as OPC UA to the server's own port on loopback.

use std::collections::BTreeMap;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::net::{TcpListener, TcpStream};
use tokio::sync::mpsc;
use tokio::task::JoinSet;
use tokio::time::timeout;

use super::event::ServerEvent;

/// Most connections at a time.
pub const MOST_CONNECTIONS: usize = 32;
/// Most connections of one address at a time, so that one client does not take all.
pub const MOST_OF_ADDRESS: usize = 16;
/// A connection that does not begin within this time is closed.
const BEGINNING: Duration = Duration::from_secs(5);
/// Wait after the system refuses a connection, for example without handles.
const PAUSE: Duration = Duration::from_millis(500);

/// The open connections of each address.
type Open = Arc<Mutex<BTreeMap<IpAddr, usize>>>;

/// Accepts connections for as long as it is polled.
pub(super) async fn run(listener: &TcpListener, server: SocketAddr, events: mpsc::Sender<ServerEvent>) {
    let open: Open = Arc::default();
    let mut connections = JoinSet::new();
    loop {
        while connections.try_join_next().is_some() {}
        let Ok((stream, peer)) = listener.accept().await else {
            let _ = events.try_send(ServerEvent::NotAccepted);
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        let Some(place) = Place::take(&open, peer.ip()) else {
            let _ = events.try_send(ServerEvent::Refused { peer: peer.ip() });
            continue;
        };
        let events = events.clone();
        connections.spawn(async move {
            let _ = events.try_send(ServerEvent::Opened { peer: peer.ip() });
            if !relay(stream, server).await {
                let _ = events.try_send(ServerEvent::NotOpcUa { peer: peer.ip() });
            }
            drop(place);
            let _ = events.try_send(ServerEvent::Closed);
        });
    }
}

/// A place among the open connections, until it is dropped.
struct Place {
    open: Open,
    address: IpAddr,
}

impl Place {
    fn take(open: &Open, address: IpAddr) -> Option<Self> {
        let mut counts = open.lock().unwrap_or_else(PoisonError::into_inner);
        let of_address = counts.get(&address).copied().unwrap_or_default();
        if counts.values().sum::<usize>() >= MOST_CONNECTIONS || of_address >= MOST_OF_ADDRESS {
            return None;
        }
        counts.insert(address, of_address + 1);
        drop(counts);
        Some(Self {
            open: Arc::clone(open),
            address,
        })
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut counts = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(count) = counts.get_mut(&self.address) {
            *count -= 1;
            if *count == 0 {
                counts.remove(&self.address);
            }
        }
    }
}

/// Hands a connection to the server until either end closes it. False where it does not begin as OPC UA.
async fn relay(stream: TcpStream, server: SocketAddr) -> bool {
    match timeout(BEGINNING, begins_as_opc_ua(&stream)).await {
        Ok(Some(true)) => {}
        // A client that leaves before its first byte says nothing about its protocol.
        Ok(None) => return true,
        Ok(Some(false)) | Err(_) => return false,
    }
    let Ok(inner) = TcpStream::connect(server).await else {
        return true;
    };
    let _ = (stream.set_nodelay(true), inner.set_nodelay(true));
    let (mut from_client, mut to_client) = stream.into_split();
    let (mut from_server, mut to_server) = inner.into_split();
    // The first end ends both: a client that never closes would keep its place. How it ended does not matter here.
    tokio::select! {
        _ = tokio::io::copy(&mut from_client, &mut to_server) => {}
        _ = tokio::io::copy(&mut from_server, &mut to_client) => {}
    }
    true
}

/// Whether the first message is a Hello, `HELF`; `None` where the connection ends before.
async fn begins_as_opc_ua(stream: &TcpStream) -> Option<bool> {
    let mut beginning = [0; 4];
    loop {
        let count = stream.peek(&mut beginning).await.ok()?;
        match &beginning[..count] {
            [] => return None,
            b"HELF" => return Some(true),
            part if b"HELF".starts_with(part) => {
                // The bytes stay where they are, so that the next look would see the same at once.
                tokio::time::sleep(Duration::from_millis(50)).await;
            }
            _ => return Some(false),
        }
    }
}
