//! Service servers that answer both kinds of ROS 2 clients.
//!
//! ROS 2's two DDS layers send services differently: rmw_fastrtps sends the request's identity outside of the data
//! ("enhanced" mapping), rmw_cyclonedds puts 16 bytes before the data ("cyclone" mapping). The bytes of a request fit its
//! type exactly either with or without those 16 bytes. A server here therefore recognises the mapping and answers each
//! client in the client's own, so that `ros2 param` works from both.

use std::collections::VecDeque;
use std::future::Future;
use std::pin::Pin;
use std::str::FromStr;
use std::sync::Arc;

use futures::StreamExt as _;
use futures::stream::FuturesUnordered;
use serde::de::DeserializeOwned;

use super::replies::Reply;
use crate::dds::frames::Peer;
use crate::dds::plan::MOST_REPLY;
use crate::dds::port::{PortBuilder, Request, Requests};
use flexdrill_messages::{MOST_PADDING, from_cdr_body, to_cdr_body};
use flexdrill_text::log_ending;

/// Bytes that rmw_cyclonedds puts before a request and expects before its reply: client id and sequence number.
const CYCLONE_HEADER: usize = 16;
/// A server's work, to be run as a task.
pub type Task = Pin<Box<dyn Future<Output = ()> + Send>>;

tokio::task_local! {
    /// The client of the request that is being answered.
    static CLIENT: Peer;
}

/// The client whose request is being answered: its DDS writer; none outside of a handler.
pub fn client() -> Option<Peer> {
    CLIENT.try_with(Clone::clone).ok()
}

/// The client of the present request, as an ending for a log line; empty outside of a handler.
pub fn asked_by() -> String {
    client().map_or_else(String::new, |client| format!(": asked for by {client}"))
}

/// The mapping of services.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ServiceMapping {
    /// Each client is answered in its own mapping. The value decides where a request fits both.
    Auto(Dialect),
    /// One mapping only.
    Only(Dialect),
}

/// The mapping of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// rmw_fastrtps, rmw_connextdds, and plain DDS programs.
    Enhanced,
    /// rmw_cyclonedds.
    Cyclone,
}

impl Dialect {
    /// The dialect of the ROS 2 layer that RMW_IMPLEMENTATION names.
    pub fn of_rmw(rmw_implementation: Option<&str>) -> Self {
        match rmw_implementation {
            Some(name) if name.contains("cyclone") => Dialect::Cyclone,
            _ => Dialect::Enhanced,
        }
    }
}

impl ServiceMapping {
    /// A description for the log.
    pub fn describe(self) -> &'static str {
        match self {
            ServiceMapping::Auto(_) => "auto (clients on rmw_fastrtps and rmw_cyclonedds are both answered)",
            ServiceMapping::Only(Dialect::Enhanced) => "enhanced (clients on rmw_fastrtps)",
            ServiceMapping::Only(Dialect::Cyclone) => "cyclone (clients on rmw_cyclonedds)",
        }
    }
}

/// An unknown name of a mapping.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not a service mapping; use auto, enhanced or cyclone")]
pub struct UnknownMapping(String);

impl FromStr for ServiceMapping {
    type Err = UnknownMapping;

    fn from_str(text: &str) -> Result<Self, UnknownMapping> {
        match text {
            "auto" => Ok(ServiceMapping::Auto(Dialect::of_rmw(
                std::env::var("RMW_IMPLEMENTATION").ok().as_deref(),
            ))),
            "enhanced" => Ok(ServiceMapping::Only(Dialect::Enhanced)),
            "cyclone" => Ok(ServiceMapping::Only(Dialect::Cyclone)),
            other => Err(UnknownMapping(other.to_owned())),
        }
    }
}

/// Why the bytes of a request do not fit its type.
#[derive(Debug, thiserror::Error)]
enum RequestError {
    #[error("it is shorter than the header of {CYCLONE_HEADER} bytes")]
    NoHeader,
    #[error(transparent)]
    Decode(#[from] cdr_encoding::Error),
    #[error("{0} bytes remain")]
    LeftOver(usize),
}

/// Reads a request, and recognises its mapping.
fn interpret<Req: DeserializeOwned>(mapping: ServiceMapping, body: &[u8]) -> Result<(Dialect, Req), RequestError> {
    let read = |bytes: Option<&[u8]>| -> Result<Req, RequestError> {
        let bytes = bytes.ok_or(RequestError::NoHeader)?;
        let (request, used) = from_cdr_body::<Req>(bytes)?;
        match bytes.len().saturating_sub(used) {
            left if left > MOST_PADDING => Err(RequestError::LeftOver(left)),
            _ => Ok(request),
        }
    };
    let enhanced = || read(Some(body)).map(|request| (Dialect::Enhanced, request));
    let cyclone = || read(body.get(CYCLONE_HEADER..)).map(|request| (Dialect::Cyclone, request));
    match mapping {
        ServiceMapping::Auto(Dialect::Enhanced) => enhanced().or_else(|_| cyclone()),
        ServiceMapping::Auto(Dialect::Cyclone) => cyclone().or_else(|_| enhanced()),
        ServiceMapping::Only(Dialect::Enhanced) => enhanced(),
        ServiceMapping::Only(Dialect::Cyclone) => cyclone(),
    }
}

/// A service's server, ready to be run as a task.
pub struct ServiceServer {
    requests: Requests,
    name: String,
    mapping: ServiceMapping,
}

impl ServiceServer {
    /// A server at `port`. `name` is absolute, `ros_type` is such as `package/srv/Type`.
    pub fn new(port: &mut PortBuilder, name: &str, ros_type: &str, mapping: ServiceMapping) -> Self {
        Self {
            requests: port.service(name, ros_type),
            name: name.to_owned(),
            mapping,
        }
    }

    /// Answers requests, one after another, for as long as the future is polled.
    pub async fn serve<Req, Resp, Handler, Answer>(self, handler: Handler)
    where
        Req: DeserializeOwned,
        Resp: Reply,
        Handler: Fn(Req) -> Answer,
        Answer: Future<Output = Resp>,
    {
        loop {
            let received = self.requests.next().await;
            let Some((dialect, request)) = self.read::<Req>(&received) else {
                continue;
            };
            if let Some(refusal) = received.refused.as_deref().and_then(Resp::refused) {
                self.reply(received, dialect, refusal);
                continue;
            }
            let response = CLIENT
                .scope(received.client.clone(), async { handler(request).await })
                .await;
            self.reply(received, dialect, response);
        }
    }

    /// Answers requests, up to `most` at once: for answers that come after a while. Where more clients wait, the one that has
    /// waited longest gets no answer.
    pub async fn serve_each<Req, Resp, Handler, Answer>(self, most: usize, handler: Handler)
    where
        Req: DeserializeOwned,
        Resp: Reply,
        Handler: Fn(Req) -> Answer,
        Answer: Future<Output = Resp>,
    {
        let mut waiting = FuturesUnordered::new();
        let mut dropped = VecDeque::new();
        loop {
            tokio::select! {
                received = self.requests.next() => {
                    let Some((dialect, request)) = self.read::<Req>(&received) else { continue };
                    let answer = CLIENT.scope(received.client.clone(), handler(request));
                    let (keep, given_up) = tokio::sync::oneshot::channel::<()>();
                    dropped.push_back(keep);
                    if dropped.len() > most {
                        dropped.pop_front();
                    }
                    waiting.push(async move {
                        tokio::select! {
                            response = answer => Some((received, dialect, response)),
                            _ = given_up => None,
                        }
                    });
                }
                Some(answered) = waiting.next() => {
                    if let Some((received, dialect, response)) = answered {
                        self.reply(received, dialect, response);
                    }
                    dropped.retain(|keep: &tokio::sync::oneshot::Sender<()>| !keep.is_closed());
                }
            }
        }
    }

    /// The request in what was received; a log line where there is none.
    fn read<Req: DeserializeOwned>(&self, received: &Request) -> Option<(Dialect, Req)> {
        let mapping = if received.is_from_dds() {
            self.mapping
        } else {
            ServiceMapping::Only(Dialect::Enhanced)
        };
        interpret::<Req>(mapping, &received.body)
            .map_err(|why| {
                if let Some(more) = log_ending(format!("{} unreadable", self.name)) {
                    tracing::warn!(
                        "service {}: a request of {} bytes could not be read: {why}{more}",
                        self.name,
                        received.body.len()
                    );
                }
            })
            .ok()
    }

    fn reply<Resp: Reply>(&self, asked: Request, dialect: Dialect, response: Resp) {
        let mut bytes = match dialect {
            Dialect::Cyclone => asked.body.get(..CYCLONE_HEADER).unwrap_or_default().to_vec(),
            Dialect::Enhanced => Vec::new(),
        };
        match encoded(response, MOST_REPLY - CYCLONE_HEADER) {
            Ok((body, told)) => {
                if let Some(why) = told
                    && let Some(more) = log_ending(format!("{} shortened", self.name))
                {
                    tracing::warn!("service {}: {why}{more}", self.name);
                }
                bytes.extend(body);
            }
            Err(error) => {
                if let Some(more) = log_ending(format!("{} not encoded", self.name)) {
                    tracing::error!("service {}: the reply could not be encoded: {error}{more}", self.name);
                }
                return;
            }
        }
        self.requests.reply(asked, bytes);
    }
}

/// A reply as bytes; where they are more than `most`, those of a shorter one, and the message in it.
fn encoded<Resp: Reply>(response: Resp, most: usize) -> Result<(Vec<u8>, Option<String>), cdr_encoding::Error> {
    let body = to_cdr_body(&response)?;
    if body.len() <= most {
        return Ok((body, None));
    }
    let why = format!(
        "the reply would have {} bytes, more than {most}, and was shortened; ask for less at once",
        body.len()
    );
    Ok((to_cdr_body(&response.shortened(&why))?, Some(why)))
}

/// A handler that needs no waiting.
pub fn at_once<Req, Resp>(answer: impl Fn(Req) -> Resp) -> impl Fn(Req) -> std::future::Ready<Resp> {
    move |request| std::future::ready(answer(request))
}

/// Shares what a handler needs with the future it returns.
pub fn shared<S, Req, Answer>(state: Arc<S>, answer: impl Fn(Arc<S>, Req) -> Answer) -> impl Fn(Req) -> Answer {
    move |request| answer(Arc::clone(&state), request)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ros2_client::rcl_interfaces::GetParametersResponse;
    use serde::{Deserialize, Serialize};

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Names {
        names: Vec<String>,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct List {
        prefixes: Vec<String>,
        depth: u64,
    }

    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    struct Nothing {
        unused: u8,
    }

    fn both_ways<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(request: &T) {
        let plain = to_cdr_body(request).unwrap();
        let headed: Vec<u8> = (0..16u8)
            .map(|i| i.wrapping_mul(37) ^ 0xa5)
            .chain(plain.iter().copied())
            .collect();
        let padded = |bytes: &[u8]| {
            bytes
                .iter()
                .copied()
                .chain(std::iter::repeat_n(0, bytes.len().wrapping_neg() % 4))
                .collect::<Vec<u8>>()
        };
        for preferred in [Dialect::Enhanced, Dialect::Cyclone] {
            let auto = ServiceMapping::Auto(preferred);
            for (bytes, dialect) in [(&plain, Dialect::Enhanced), (&headed, Dialect::Cyclone)] {
                for bytes in [bytes.clone(), padded(bytes)] {
                    let (found, read) = interpret::<T>(auto, &bytes).unwrap();
                    assert_eq!((found, &read), (dialect, request), "{} bytes", bytes.len());
                }
            }
        }
        assert!(interpret::<T>(ServiceMapping::Only(Dialect::Enhanced), &padded(&headed)).is_err());
    }

    #[test]
    fn the_form_of_a_request_is_seen_from_its_bytes() {
        both_ways(&Names {
            names: vec!["use_sim_time".into()],
        });
        both_ways(&Names {
            names: vec!["rates.joint_deflections".into(), "bit.friction_factor".into()],
        });
        both_ways(&List {
            prefixes: vec![],
            depth: 0,
        });
        both_ways(&List {
            prefixes: vec!["rates".into()],
            depth: 2,
        });
        both_ways(&Nothing { unused: 0 });
    }

    #[test]
    fn a_reply_that_is_too_long_is_shortened_and_told() {
        let reply = |bytes: usize| flexdrill_messages::std_srvs::TriggerResponse {
            success: true,
            message: "x".repeat(bytes),
        };
        let (body, told) = encoded(reply(50), 100).unwrap();
        assert!(body.len() > 50 && told.is_none());
        let (body, told) = encoded(reply(400), 300).unwrap();
        let told = told.unwrap();
        assert!(told.contains("409 bytes, more than 300"), "{told}");
        assert!(body.len() <= 300 && String::from_utf8_lossy(&body).contains(&told));
        let values = vec![ros2_client::ParameterValue::NotSet.into(); 100];
        let (body, told) = encoded(GetParametersResponse { values }, 300).unwrap();
        assert!(told.is_some());
        assert_eq!(body, [0; 4], "an empty list");
    }

    #[test]
    fn rmw_implementation_gives_the_preference() {
        assert_eq!(Dialect::of_rmw(Some("rmw_cyclonedds_cpp")), Dialect::Cyclone);
        assert_eq!(Dialect::of_rmw(Some("rmw_fastrtps_cpp")), Dialect::Enhanced);
        assert_eq!(Dialect::of_rmw(None), Dialect::Enhanced);
    }
}
