//! Who may come in: a WebSocket that speaks the protocol, from this machine's own pages and programs.
//!
//! A page of anybody can open a WebSocket to this machine from the browser that shows it; the browser says by `Origin`
//! whose page it is. A name that its owner points to this machine (DNS rebinding) shows in `Host`. Who steers shows the
//! token in the address, the one place that the protocol has for it.

use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};

use axum::body::Body;
use axum::extract::{ConnectInfo, Request};
use axum::http::{HeaderMap, HeaderName, StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use flexdrill_realtime::monotonic;
use hyper_util::rt::TokioIo;
use tokio::io::AsyncWriteExt as _;
use tokio::net::TcpStream;
use tokio::sync::Semaphore;

use super::Token;
use super::pump::{Pump, text_of_client};
use super::steering::Steering;
use crate::told::{Throttles, printable};

/// Most clients at once: each may leave some megabytes lying in its queue.
const MOST_CLIENTS: usize = 32;
/// What the protocol's server speaks, newest first.
const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1.1", "foxglove.sdk.v1"];
/// What viewers of before 2025 ask for.
const OLD_SUBPROTOCOL: &str = "foxglove.websocket.v1";
/// Where Foxglove's own viewer comes from in a browser.
const FOXGLOVE_APP: &str = "https://app.foxglove.dev";
/// Least time between two lines about refused clients of one kind (s).
const TOLD_INTERVAL: f64 = 10.0;
/// Headers of a WebSocket's opening that concern both ends.
const OPENING: [HeaderName; 5] = [
    header::UPGRADE,
    header::CONNECTION,
    header::SEC_WEBSOCKET_KEY,
    header::SEC_WEBSOCKET_VERSION,
    header::SEC_WEBSOCKET_PROTOCOL,
];

/// Where who has shown the token gets.
pub(super) struct SteeredWay {
    pub token: Token,
    /// The protocol's server that offers to steer.
    pub target: SocketAddr,
    pub steering: Arc<Steering>,
}

/// Lets clients through to the protocol's servers, which listen where only this machine gets.
pub struct Door {
    target: SocketAddr,
    steered: Option<SteeredWay>,
    seats: Arc<Semaphore>,
    origins: Vec<String>,
    told: Mutex<Throttles<&'static str>>,
}

impl Door {
    /// To the server at `target`, for pages of this machine, of Foxglove, and of `origins` (as `https://viewer.example`).
    pub fn new(target: SocketAddr, origins: &[String]) -> Arc<Self> {
        Self::with(target, None, origins)
    }

    /// The same, with a way for who has the token.
    pub(super) fn with(target: SocketAddr, steered: Option<SteeredWay>, origins: &[String]) -> Arc<Self> {
        Arc::new(Self {
            target,
            steered,
            seats: Arc::new(Semaphore::new(MOST_CLIENTS)),
            origins: origins.to_vec(),
            told: Mutex::new(Throttles::new(TOLD_INTERVAL)),
        })
    }

    /// Opens a WebSocket through to the server, or says why not.
    pub async fn enter(self: Arc<Self>, request: Request) -> Response {
        match self.let_through(request).await {
            Ok(response) => response,
            Err((status, why)) => (status, why).into_response(),
        }
    }

    async fn let_through(&self, mut request: Request) -> Result<Response, (StatusCode, String)> {
        let headers = request.headers();
        if !has_word(headers, &header::UPGRADE, "websocket") {
            let why = "this address speaks the Foxglove WebSocket protocol; open it in Foxglove or Lichtblick\n";
            return Err((StatusCode::UPGRADE_REQUIRED, why.to_owned()));
        }
        if !host_is_ours(headers) || !self.origin_is_ours(headers) {
            let why = format!(
                "a page of {} asked for the live data and was refused; --allow-origin lets a viewer in",
                printable(text(headers, &header::ORIGIN).unwrap_or("another host"))
            );
            self.tell("origin", &why);
            return Err((StatusCode::FORBIDDEN, why));
        }
        if !SUBPROTOCOLS
            .iter()
            .any(|known| has_word(headers, &header::SEC_WEBSOCKET_PROTOCOL, known))
        {
            let why = refusal_of_subprotocol(text(headers, &header::SEC_WEBSOCKET_PROTOCOL).unwrap_or_default());
            self.tell("subprotocol", &why);
            return Err((StatusCode::BAD_REQUEST, why));
        }
        let Ok(seat) = Arc::clone(&self.seats).try_acquire_owned() else {
            let why = format!("{MOST_CLIENTS} live clients are connected, which is the most; close one");
            self.tell("seats", &why);
            return Err((StatusCode::SERVICE_UNAVAILABLE, why));
        };
        let way = self.way(request.uri())?;
        let viewer = match request.extensions().get() {
            Some(ConnectInfo(address)) => *address,
            None => SocketAddr::from(([0, 0, 0, 0], 0)),
        };
        let (target, introduction) = match way {
            Some(way) => (way.target, text_of_client(&way.steering.introduce(viewer))),
            None => (self.target, Vec::new()),
        };
        let (response, theirs) = open(target, headers).await.map_err(|error| {
            let why = format!("the live data cannot be reached: {error}");
            self.tell("target", &why);
            (StatusCode::BAD_GATEWAY, why)
        })?;
        let ours = hyper::upgrade::on(&mut request);
        tokio::spawn(async move {
            if let Ok((ours, theirs)) = tokio::try_join!(ours, theirs) {
                let (mut from_viewer, to_viewer) = tokio::io::split(TokioIo::new(ours));
                let (from_server, mut to_server) = tokio::io::split(TokioIo::new(theirs));
                let hear = async {
                    to_server.write_all(&introduction).await?;
                    tokio::io::copy(&mut from_viewer, &mut to_server).await
                };
                let pump = Pump::new(viewer);
                // It ends when either side goes, and that is all there is to know.
                tokio::select! {
                    _ = hear => {}
                    () = pump.run(from_server, to_viewer) => {}
                }
            }
            drop(seat);
        });
        Ok(response)
    }

    /// Where a viewer gets by the address that it asked for: with the token to where it may steer, without it to look.
    fn way(&self, asked: &Uri) -> Result<Option<&SteeredWay>, (StatusCode, String)> {
        let Some(offered) = token_in(asked) else {
            return Ok(None);
        };
        let refused = |status, why: &str| {
            self.tell("token", why);
            Err((status, why.to_owned()))
        };
        match &self.steered {
            None => refused(
                StatusCode::FORBIDDEN,
                "a viewer came with a token, but steering is off: start with --allow-control, or leave ?token= out to look",
            ),
            Some(way) if way.token.is(offered) => Ok(Some(way)),
            Some(_) => refused(
                StatusCode::UNAUTHORIZED,
                "a viewer came with another token than the one that was printed at the start; leave ?token= out to look",
            ),
        }
    }

    fn origin_is_ours(&self, headers: &HeaderMap) -> bool {
        origin_is_known(headers)
            || text(headers, &header::ORIGIN)
                .is_some_and(|origin| origin == FOXGLOVE_APP || self.origins.iter().any(|known| known == origin))
    }

    fn tell(&self, kind: &'static str, why: &str) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(more) = told.ending(kind, monotonic::now() as f64 * 1e-9) {
            tracing::warn!("{why}{more}");
        }
    }
}

/// The token in `/?token=TOKEN`.
fn token_in(asked: &Uri) -> Option<&str> {
    asked.query()?.split('&').find_map(|part| part.strip_prefix("token="))
}

/// What is said to a client that asks for another subprotocol.
fn refusal_of_subprotocol(asked: &str) -> String {
    let shown = printable(asked);
    let known = SUBPROTOCOLS.join(" and ");
    if asked.split(',').any(|word| word.trim() == OLD_SUBPROTOCOL) {
        format!(
            "a client asked for the subprotocol {shown} of before 2025, and this server speaks {known}: use a newer viewer \
             (Foxglove of 2025 on, Lichtblick after 1.21), or open a recording in it"
        )
    } else {
        format!("a client asked for the subprotocol '{shown}', and this server speaks {known}")
    }
}

/// Whether the request was addressed to a number or to `localhost`, not to a name that anybody may point here.
pub(crate) fn host_is_ours(headers: &HeaderMap) -> bool {
    text(headers, &header::HOST).is_some_and(|host| is_number_or_local(host_name(host)))
}

/// Whether no page asked, or one of this machine.
fn origin_is_known(headers: &HeaderMap) -> bool {
    let Some(origin) = text(headers, &header::ORIGIN) else {
        // Programs send none; a header that is no text is no page's.
        return headers.get(header::ORIGIN).is_none();
    };
    // Installed viewers; no page of a server has such an origin.
    if origin.starts_with("file://") || origin.starts_with("app://") {
        return true;
    }
    let Some(authority) = origin
        .strip_prefix("http://")
        .or_else(|| origin.strip_prefix("https://"))
    else {
        return false;
    };
    // The page of this very address, or one that this machine itself serves.
    Some(authority) == text(headers, &header::HOST) || is_local(host_name(authority))
}

/// The name or number in `host:port`.
fn host_name(authority: &str) -> &str {
    match authority.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or_default(),
        None => authority.split(':').next().unwrap_or_default(),
    }
}

fn is_local(host: &str) -> bool {
    host.eq_ignore_ascii_case("localhost") || host.parse().is_ok_and(|address: IpAddr| address.is_loopback())
}

fn is_number_or_local(host: &str) -> bool {
    is_local(host) || host.parse::<IpAddr>().is_ok()
}

fn text<'a>(headers: &'a HeaderMap, name: &HeaderName) -> Option<&'a str> {
    headers.get(name)?.to_str().ok()
}

fn has_word(headers: &HeaderMap, name: &HeaderName, word: &str) -> bool {
    let texts = headers
        .get_all(name)
        .into_iter()
        .filter_map(|value| value.to_str().ok());
    texts
        .flat_map(|text| text.split(','))
        .any(|found| found.trim().eq_ignore_ascii_case(word))
}

/// Opens a WebSocket at the protocol's server with the client's own key, so that its answer is the client's.
async fn open(target: SocketAddr, headers: &HeaderMap) -> Result<(Response, hyper::upgrade::OnUpgrade), OpenError> {
    let stream = TcpStream::connect(target).await?;
    stream.set_nodelay(true)?;
    let (mut sender, connection) = hyper::client::conn::http1::handshake(TokioIo::new(stream)).await?;
    tokio::spawn(connection.with_upgrades());
    let mut request = Request::new(Body::empty());
    *request.uri_mut() = Uri::from_static("/");
    for name in OPENING {
        for value in headers.get_all(&name) {
            request.headers_mut().append(&name, value.clone());
        }
    }
    if let Ok(host) = target.to_string().parse() {
        request.headers_mut().insert(header::HOST, host);
    }
    let mut answer = sender.send_request(request).await?;
    let upgraded = hyper::upgrade::on(&mut answer);
    Ok((answer.map(Body::new), upgraded))
}

#[derive(Debug, thiserror::Error)]
enum OpenError {
    #[error(transparent)]
    Connect(#[from] std::io::Error),
    #[error(transparent)]
    Http(#[from] hyper::Error),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(host: &str, origin: Option<&str>) -> HeaderMap {
        let mut headers = HeaderMap::new();
        headers.insert(header::HOST, host.parse().unwrap());
        if let Some(origin) = origin {
            headers.insert(header::ORIGIN, origin.parse().unwrap());
        }
        headers
    }

    #[test]
    fn names_that_anybody_may_point_here_are_refused() {
        for ours in [
            "127.0.0.1:8080",
            "localhost:8080",
            "[::1]:8080",
            "192.168.1.7:8080",
            "LOCALHOST",
        ] {
            assert!(host_is_ours(&headers(ours, None)), "{ours}");
        }
        for foreign in [
            "rig.example:8080",
            "localhost.evil.example",
            "127.0.0.1.nip.io:8080",
            "",
        ] {
            assert!(!host_is_ours(&headers(foreign, None)), "{foreign}");
        }
        assert!(!host_is_ours(&HeaderMap::new()));
    }

    #[test]
    fn pages_of_others_are_refused() {
        let door = Door::new(([127, 0, 0, 1], 1).into(), &["https://viewer.example".to_owned()]);
        let asked = |origin| door.origin_is_ours(&headers("192.168.1.7:8080", origin));
        for ours in [
            None,
            Some("http://192.168.1.7:8080"),
            Some("http://localhost:3000"),
            Some("https://app.foxglove.dev"),
            Some("https://viewer.example"),
            Some("file://"),
        ] {
            assert!(asked(ours), "{ours:?}");
        }
        for foreign in [
            "https://evil.example",
            "http://192.168.1.8:8080",
            "null",
            "http://localhost.evil.example",
            "ftp://localhost",
        ] {
            assert!(!asked(Some(foreign)), "{foreign}");
        }
    }

    #[test]
    fn the_token_is_a_part_of_the_address() {
        for (address, token) in [
            ("/", None),
            ("/?token=abc", Some("abc")),
            ("/live?x=1&token=abc", Some("abc")),
            ("/?tokens=abc", None),
            ("/?token=", Some("")),
        ] {
            assert_eq!(token_in(&address.parse().unwrap()), token, "{address}");
        }
        let door = Door::new(([127, 0, 0, 1], 1).into(), &[]);
        let way = |address: &str| door.way(&address.parse().unwrap()).map(|way| way.is_some());
        assert!(!way("/").unwrap());
        let (status, why) = way("/?token=abc").unwrap_err();
        assert_eq!(status, StatusCode::FORBIDDEN);
        assert!(why.contains("--allow-control"), "{why}");
    }

    #[test]
    fn an_old_viewer_is_told_what_to_do() {
        let said = refusal_of_subprotocol("foxglove.websocket.v1");
        assert!(
            said.contains("newer viewer") && said.contains("foxglove.sdk.v1"),
            "{said}"
        );
        assert!(!refusal_of_subprotocol("chat").contains("newer viewer"));
    }
}
