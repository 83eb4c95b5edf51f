//! Connections to the server's address: bounds on their number, their idle time and their send buffers.
//!
//! Any client that reaches the address can open connections and leave them unused. They must not use up the handles
//! that DDS and the recording need. The number of connections is therefore bounded, and a new one closes the oldest
//! connection of the client address that has the most. Admitted WebSockets have their own bound (`gateway`).

use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;

use axum::extract::ConnectInfo;
use axum::{Extension, Router};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use rustix::process::{Resource, getrlimit};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::{AbortHandle, Id, JoinSet};
use tokio::time::Sleep;

use flexdrill_text::log_ending;

/// Largest number of connections that are not WebSockets: a page uses up to six.
const MOST: usize = 64;
/// These connections use at most one handle in so many that the process may open; the rest is for DDS and the
/// recording.
const SHARE: u64 = 4;
/// Longest time until a request's head is complete, and until the next request on the connection begins.
const HEAD: Duration = Duration::from_secs(10);
/// Longest head of a request (bytes).
const MOST_HEAD: usize = 16 << 10;
/// A connection that accepts no data for this time is closed.
const STALL: Duration = Duration::from_secs(20);
/// Send buffer of a connection (bytes): data in it cannot be replaced by newer data, so it holds only a tenth of a
/// second of all topics of the default tool. The kernel's overhead comes on top.
const SEND_BUFFER: usize = 128 << 10;
/// Pause after the system has refused a connection, so that repeated refusals do not load the processor.
const REFUSED: Duration = Duration::from_millis(100);

/// Serves requests until `end` completes, then closes all connections except the WebSockets.
///
/// # Errors
/// When the listener cannot be used.
pub async fn serve(listener: std::net::TcpListener, router: Router, end: impl Future<Output = ()>) -> io::Result<()> {
    let listener = TcpListener::from_std(listener)?;
    let most = most_connections();
    let mut open = Open::default();
    let mut end = std::pin::pin!(end);
    loop {
        tokio::select! {
            () = &mut end => return Ok(()),
            Some(done) = open.tasks.join_next_with_id() => open.forget(match done {
                Ok((id, ())) => id,
                Err(error) => error.id(),
            }),
            accepted = listener.accept() => match accepted {
                Ok((stream, from)) => {
                    if let Some(address) = open.make_room(most)
                        && let Some(more) = log_ending("connections full")
                    {
                        tracing::warn!(
                            "{most} connections are open, which is the most; the oldest one from {address} was closed for a \
                             new one{more}"
                        );
                    }
                    open.add(from.ip(), connection(stream, from, router.clone()));
                }
                Err(error) => {
                    if let Some(more) = log_ending("connection not accepted") {
                        tracing::warn!("a connection could not be accepted: {error}{more}");
                    }
                    tokio::time::sleep(REFUSED).await;
                }
            },
        }
    }
}

/// Largest number of connections, given the process's limit of handles.
fn most_connections() -> usize {
    let handles = getrlimit(Resource::Nofile).current.unwrap_or(u64::MAX);
    usize::try_from(handles / SHARE).unwrap_or(MOST).clamp(1, MOST)
}

/// Open connections, oldest first.
#[derive(Default)]
struct Open {
    tasks: JoinSet<()>,
    each: Vec<(Id, IpAddr, AbortHandle)>,
}

impl Open {
    fn add(&mut self, from: IpAddr, connection: impl Future<Output = ()> + Send + 'static) {
        let handle = self.tasks.spawn(connection);
        self.each.push((handle.id(), from, handle));
    }

    fn forget(&mut self, id: Id) {
        self.each.retain(|(known, ..)| *known != id);
    }

    /// If `most` connections are open, closes the oldest one of the address that has the most. Returns that address.
    fn make_room(&mut self, most: usize) -> Option<IpAddr> {
        if self.each.len() < most {
            return None;
        }
        let count = |address: &IpAddr| self.each.iter().filter(|(_, from, _)| from == address).count();
        // Of addresses with the same count, the one with the oldest connection is found last.
        let (_, address, _) = self.each.iter().rev().max_by_key(|(_, from, _)| count(from))?;
        let address = *address;
        let oldest = self.each.iter().position(|(_, from, _)| *from == address)?;
        let (_, _, handle) = self.each.remove(oldest);
        handle.abort();
        Some(address)
    }
}

async fn connection(stream: TcpStream, from: SocketAddr, router: Router) {
    let socket = socket2::SockRef::from(&stream);
    // Small messages are sent without delay. If the system refuses one of these options, a slow viewer lags more.
    let _ = socket.set_tcp_nodelay(true);
    let _ = socket.set_send_buffer_size(SEND_BUFFER);
    // The connection of a machine that has vanished is closed.
    let _ = socket.set_tcp_user_timeout(Some(STALL));
    let router = router.layer(Extension(ConnectInfo(from)));
    let serving = hyper::server::conn::http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD)
        .max_buf_size(MOST_HEAD)
        .serve_connection(TokioIo::new(StallGuard::new(stream)), TowerToHyperService::new(router))
        .with_upgrades();
    // An error on a connection concerns its client only.
    let _ = serving.await;
}

/// A stream that fails when it has accepted no data for [`STALL`].
struct StallGuard {
    stream: TcpStream,
    /// The timer that runs while the connection accepts no data.
    stalled: Option<Pin<Box<Sleep>>>,
}

impl StallGuard {
    fn new(stream: TcpStream) -> Self {
        Self { stream, stalled: None }
    }

    fn judge<T>(&mut self, context: &mut Context<'_>, written: Poll<io::Result<T>>) -> Poll<io::Result<T>> {
        if written.is_ready() {
            self.stalled = None;
            return written;
        }
        let stalled = self.stalled.get_or_insert_with(|| Box::pin(tokio::time::sleep(STALL)));
        match stalled.as_mut().poll(context) {
            Poll::Ready(()) => Poll::Ready(Err(io::ErrorKind::TimedOut.into())),
            Poll::Pending => Poll::Pending,
        }
    }
}

impl AsyncRead for StallGuard {
    fn poll_read(mut self: Pin<&mut Self>, context: &mut Context<'_>, into: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, into)
    }
}

impl AsyncWrite for StallGuard {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.judge(context, written)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        parts: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write_vectored(context, parts);
        self.judge(context, written)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn the_oldest_of_the_busiest_address_makes_room() {
        let address = |number: u8| IpAddr::from([10, 0, 0, number]);
        let mut open = Open::default();
        for from in [1, 2, 2, 3] {
            open.add(address(from), std::future::pending());
        }
        let second = open.each[1].0;
        assert_eq!(open.make_room(5), None);
        assert_eq!(open.make_room(4), Some(address(2)));
        let ended = open.tasks.join_next_with_id().await.unwrap().unwrap_err();
        assert!(ended.is_cancelled() && ended.id() == second);
        assert_eq!(
            open.make_room(3),
            Some(address(1)),
            "of several with the same count, the oldest"
        );
    }

    #[test]
    fn handles_are_left_for_dds_and_the_recording() {
        let handles = getrlimit(Resource::Nofile).current.unwrap_or(u64::MAX);
        assert!(most_connections() as u64 <= MOST as u64 && most_connections() as u64 <= handles / 4);
    }
}
