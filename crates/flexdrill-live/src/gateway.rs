//! Admission of viewers: WebSockets of the protocol, from programs and from pages of this machine.
//!
//! A page of any server can open a WebSocket to this machine from a browser on it; the header `Origin` names the page's
//! server. The header `Host` shows a foreign name that its owner has pointed to this machine (DNS rebinding). A viewer
//! that steers sends the token in the URL, the only field that the protocol has for it.

use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;

use axum::body::Body;
use axum::extract::{ConnectInfo, Request};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use hyper_util::rt::TokioIo;
use tokio::sync::Semaphore;
use tokio_tungstenite::tungstenite::handshake::derive_accept_key;

use crate::backlog::Backlog;
use crate::hub::Hub;
use crate::session::{Session, Subprotocol, next_number};
use crate::steering::{Pilot, Steering, Viewer};
use crate::{Token, WrongTokens};
use flexdrill_text::{log_ending, printable};

/// Largest number of viewers. Each costs one file handle and, when slow, some megabytes.
pub(crate) const MOST_VIEWERS: usize = 32;
/// The supported subprotocols, newest first.
const SUBPROTOCOLS: [(&str, Subprotocol); 2] = [
    ("foxglove.sdk.v1.1", Subprotocol::V1_1),
    ("foxglove.sdk.v1", Subprotocol::V1),
];
/// The subprotocol of viewers from before 2025.
const OLD_SUBPROTOCOL: &str = "foxglove.websocket.v1";
/// Foxglove's own viewer in a browser.
const FOXGLOVE_APP: &str = "https://app.foxglove.dev";

/// Admits viewers to the topics of a hub.
pub struct Gateway {
    hub: Arc<Hub>,
    /// Steering, for viewers with the token.
    steered: Option<(Token, Arc<Steering>)>,
    seats: Arc<Semaphore>,
    origins: Vec<String>,
    wrong_tokens: WrongTokens,
}

impl Gateway {
    /// A gateway to the topics of `hub`, for pages of this machine, of Foxglove, and of `origins` (such as
    /// `https://viewer.example`, or `file://` for viewers opened from a file). With `steered`, a viewer with the token
    /// may steer.
    pub fn new(hub: &Arc<Hub>, steered: Option<(Token, Arc<Steering>)>, origins: &[String]) -> Arc<Self> {
        Arc::new(Self {
            hub: Arc::clone(hub),
            steered,
            seats: Arc::new(Semaphore::new(MOST_VIEWERS)),
            origins: origins.to_vec(),
            wrong_tokens: WrongTokens::default(),
        })
    }

    /// Opens a WebSocket, or answers with the reason for the refusal.
    pub async fn enter(self: Arc<Self>, request: Request) -> Response {
        match self.admit(request).await {
            Ok(response) => response,
            Err((status, why)) => (status, why).into_response(),
        }
    }

    async fn admit(&self, mut request: Request) -> Result<Response, (StatusCode, String)> {
        let headers = request.headers();
        // Checks in the order of their cost and of what they reveal: a browser that
        // was led here by mistake learns only what this address is.
        if !has_word(headers, &header::UPGRADE, "websocket") {
            let why = "this address speaks the Foxglove WebSocket protocol; open it in Foxglove or Lichtblick\n";
            return Err((StatusCode::UPGRADE_REQUIRED, why.to_owned()));
        }
        // Before anything else of the request is used: it may come from a
        // page of another server in the operator's browser.
        if !host_is_ours(headers) || !self.origin_is_ours(headers) {
            let origin = text(headers, &header::ORIGIN).unwrap_or("another host");
            let why = format!(
                "a page of {} requested the live data and was refused; --allow-origin admits a viewer",
                printable(origin)
            );
            log("origin", &why);
            return Err((StatusCode::FORBIDDEN, why));
        }
        // The first known subprotocol in our order, because the newest one is listed first.
        let known = SUBPROTOCOLS
            .iter()
            .find(|(name, _)| has_word(headers, &header::SEC_WEBSOCKET_PROTOCOL, name));
        let Some((name, subprotocol)) = known else {
            let why = refusal_of_subprotocol(text(headers, &header::SEC_WEBSOCKET_PROTOCOL).unwrap_or_default());
            log("subprotocol", &why);
            return Err((StatusCode::BAD_REQUEST, why));
        };
        // RFC 6455 allows only GET and version 13.
        let key = text(headers, &header::SEC_WEBSOCKET_KEY).filter(|_| {
            request.method() == axum::http::Method::GET
                && text(headers, &header::SEC_WEBSOCKET_VERSION).is_some_and(|version| version.trim() == "13")
        });
        let Some(accepted) = key.map(|key| derive_accept_key(key.as_bytes())) else {
            let why = "the request does not open a WebSocket of version 13 (RFC 6455)".to_owned();
            return Err((StatusCode::BAD_REQUEST, why));
        };
        // Without an address the viewer has the unspecified one. It counts
        // like a further address and gets no rights from it.
        let address = match request.extensions().get() {
            Some(ConnectInfo(address)) => *address,
            None => SocketAddr::from(([0, 0, 0, 0], 0)),
        };
        // The token is checked before a seat is taken, so that wrong ones cannot occupy the seats.
        let steering = self.steering(request.uri(), address).await?;
        // Seats bound the memory: each viewer has a backlog.
        let Ok(seat) = Arc::clone(&self.seats).try_acquire_owned() else {
            let why = format!("{MOST_VIEWERS} live viewers are connected, the largest number allowed; close one");
            log("seats", &why);
            return Err((StatusCode::SERVICE_UNAVAILABLE, why));
        };
        // The connection becomes a WebSocket only after the response
        // below has been sent, so the session runs in a task.
        let upgrade = hyper::upgrade::on(&mut request);
        let (hub, steering, subprotocol) = (Arc::clone(&self.hub), steering.map(Arc::clone), *subprotocol);
        tokio::spawn(async move {
            if let Ok(stream) = upgrade.await {
                let number = next_number();
                // The backlog exists before the session, because the hub writes into it as soon as it knows the viewer.
                let backlog = Arc::new(Backlog::new(address));
                let pilot = steering.map(|steering| Pilot::new(&steering, Viewer { number, address }, &backlog));
                let session = Session::new(number, &hub, backlog, pilot);
                session.run(TokioIo::new(stream), subprotocol).await;
            }
            // The seat is held until the session has ended, however it ends.
            drop(seat);
        });
        let mut response = Response::new(Body::empty());
        *response.status_mut() = StatusCode::SWITCHING_PROTOCOLS;
        let headers = response.headers_mut();
        headers.insert(header::CONNECTION, HeaderValue::from_static("upgrade"));
        headers.insert(header::UPGRADE, HeaderValue::from_static("websocket"));
        headers.insert(header::SEC_WEBSOCKET_PROTOCOL, HeaderValue::from_static(name));
        if let Ok(accepted) = HeaderValue::from_str(&accepted) {
            headers.insert(header::SEC_WEBSOCKET_ACCEPT, accepted);
        }
        Ok(response)
    }

    /// The steering for a viewer whose URL has the token; `None` for a viewer without a token, which may only look.
    async fn steering(&self, uri: &Uri, address: SocketAddr) -> Result<Option<&Arc<Steering>>, (StatusCode, String)> {
        let Some(offered) = token_in(uri) else {
            return Ok(None);
        };
        match &self.steered {
            None => {
                let why = "a viewer sent a token, but steering is off: start with --allow-control, or remove ?token= to look \
                           only";
                log("token", why);
                Err((StatusCode::FORBIDDEN, why.to_owned()))
            }
            Some((token, steering)) if token.is(offered) => Ok(Some(steering)),
            Some(_) => {
                self.wrong_tokens.refuse(address).await;
                let why = "a viewer sent a wrong token; the program printed the right one at its start. Remove ?token= to look only";
                Err((StatusCode::UNAUTHORIZED, why.to_owned()))
            }
        }
    }

    fn origin_is_ours(&self, headers: &HeaderMap) -> bool {
        origin_is_known(headers)
            || text(headers, &header::ORIGIN)
                .is_some_and(|origin| origin == FOXGLOVE_APP || self.origins.iter().any(|known| known == origin))
    }
}

/// One line per kind of refused viewers in ten seconds.
fn log(kind: &'static str, why: &str) {
    if let Some(more) = log_ending(kind) {
        tracing::warn!("{why}{more}");
    }
}

/// The token in `/?token=TOKEN`.
fn token_in(uri: &Uri) -> Option<&str> {
    uri.query()?.split('&').find_map(|part| part.strip_prefix("token="))
}

/// The answer to a client that asks for another subprotocol.
fn refusal_of_subprotocol(asked: &str) -> String {
    let quoted = printable(asked);
    let known = SUBPROTOCOLS.map(|(name, _)| name).join(" and ");
    if asked.split(',').any(|word| word.trim() == OLD_SUBPROTOCOL) {
        format!(
            "a client requested the subprotocol {quoted} from before 2025; this server supports {known}: use a newer viewer \
             (Foxglove of 2025 on, Lichtblick after 1.21), or open a recording in it"
        )
    } else {
        format!("a client requested the subprotocol '{quoted}'; this server supports {known}")
    }
}

/// Whether `Host` is an IP address or `localhost`. Any other name may be one that its owner has pointed to this
/// machine.
pub fn host_is_ours(headers: &HeaderMap) -> bool {
    text(headers, &header::HOST).is_some_and(|host| is_number_or_local(host_name(host)))
}

/// Whether the request comes from no page, or from a page of this machine.
fn origin_is_known(headers: &HeaderMap) -> bool {
    let Some(origin) = text(headers, &header::ORIGIN) else {
        // Programs send no Origin. A header that is not text does not come from a browser.
        return headers.get(header::ORIGIN).is_none();
    };
    // `app://` is the scheme of installed viewers. A page opened from a file can be anyone's, so `null` and `file://`
    // must be allowed by name.
    if origin.starts_with("app://") {
        return true;
    }
    let Some(authority) = origin
        .strip_prefix("http://")
        .or_else(|| origin.strip_prefix("https://"))
    else {
        return false;
    };
    // The page has this server's address, or this machine serves it.
    Some(authority) == text(headers, &header::HOST) || is_local(host_name(authority))
}

/// The host in `host:port`.
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
    fn foreign_host_names_are_refused() {
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
    fn pages_of_other_servers_are_refused() {
        let asked = |origin| gateway(&["https://viewer.example"]).origin_is_ours(&headers("192.168.1.7:8080", origin));
        for ours in [
            None,
            Some("http://192.168.1.7:8080"),
            Some("http://localhost:3000"),
            Some("https://app.foxglove.dev"),
            Some("https://viewer.example"),
            Some("app://viewer"),
        ] {
            assert!(asked(ours), "{ours:?}");
        }
        for foreign in [
            "https://evil.example",
            "http://192.168.1.8:8080",
            "null",
            "file://",
            "http://localhost.evil.example",
            "ftp://localhost",
        ] {
            assert!(!asked(Some(foreign)), "{foreign}");
        }
    }

    /// Any file received by mail opens with this origin.
    #[test]
    fn pages_from_files_are_refused_unless_they_are_allowed() {
        for origin in ["file://", "null"] {
            let headers = headers("127.0.0.1:8765", Some(origin));
            assert!(!gateway(&[]).origin_is_ours(&headers), "{origin}");
            assert!(gateway(&[origin]).origin_is_ours(&headers), "{origin}");
        }
    }

    fn gateway(origins: &[&str]) -> Arc<Gateway> {
        let origins: Vec<String> = origins.iter().map(|origin| (*origin).to_owned()).collect();
        Gateway::new(&Hub::new([]), None, &origins)
    }

    #[tokio::test]
    async fn the_token_is_a_part_of_the_address() {
        for (address, token) in [
            ("/", None),
            ("/?token=abc", Some("abc")),
            ("/live?x=1&token=abc", Some("abc")),
            ("/?tokens=abc", None),
            ("/?token=", Some("")),
        ] {
            assert_eq!(token_in(&address.parse().unwrap()), token, "{address}");
        }
        let (gateway, from) = (gateway(&[]), ([127, 0, 0, 1], 1).into());
        assert!(gateway.steering(&"/".parse().unwrap(), from).await.unwrap().is_none());
        let (status, why) = gateway
            .steering(&"/?token=abc".parse().unwrap(), from)
            .await
            .err()
            .unwrap();
        assert_eq!(status, StatusCode::FORBIDDEN);
        assert!(why.contains("--allow-control"), "{why}");
    }

    #[test]
    fn the_refusal_of_an_old_viewer_says_what_to_do() {
        let said = refusal_of_subprotocol("foxglove.websocket.v1");
        assert!(
            said.contains("newer viewer") && said.contains("foxglove.sdk.v1"),
            "{said}"
        );
        assert!(!refusal_of_subprotocol("chat").contains("newer viewer"));
    }
}
