//! Calls of a service of another node.
//!
//! A request has its identity before its data, as rmw_cyclonedds sends it. A server that accepts both mappings cannot
//! confuse them: read as the other mapping, the identity would begin a string of two thousand million characters.

use std::sync::Arc;
use std::time::Duration;

use serde::Serialize;
use serde::de::DeserializeOwned;
use tokio::sync::Mutex;

use crate::dds::port::{Inbox, Monitor, PortBuilder, Sample, TopicPublisher};
use flexdrill_messages::{from_cdr_body, to_cdr_body};

/// Bytes of the identity: the client and the number of the call.
const IDENTITY: usize = 16;
/// A string of this length is longer than any message.
const NO_LENGTH: u64 = 0xffff_0000;
/// Longest wait for a reply.
const REPLY_WAIT: Duration = Duration::from_secs(3);

/// Longest wait for the discovery of the server, which is updated twice a second.
const DISCOVERY_WAIT: Duration = Duration::from_secs(1);
/// Time between two checks for the server.
const CHECK_INTERVAL: Duration = Duration::from_millis(50);

/// Why a call has no answer.
#[derive(Debug, thiserror::Error)]
pub enum CallError {
    /// No node serves it.
    #[error("no node serves {service}; check that the twin runs in this domain and namespace")]
    NoServer {
        /// Absolute name.
        service: String,
    },
    /// No reply came.
    #[error("{service} has not answered within {seconds} s")]
    NoReply {
        /// Absolute name.
        service: String,
        /// Time waited (s).
        seconds: u64,
    },
    /// The request or the reply is not of the service's type.
    #[error("{service}: {source}")]
    Encoding {
        /// Absolute name.
        service: String,
        /// What is wrong.
        source: cdr_encoding::Error,
    },
}

/// One service of another node.
pub struct ServiceClient {
    name: String,
    requests: TopicPublisher,
    replies: Arc<Inbox<Sample>>,
    identity: u64,
    /// Number of the last call. The lock is held during a call, so that calls do not read each other's replies.
    calls: Mutex<u64>,
}

impl ServiceClient {
    /// A client at `port`. `name` is absolute, `ros_type` is such as `package/srv/Type`; `identity` must be unique to
    /// this process.
    pub fn new(port: &mut PortBuilder, name: &str, ros_type: &str, identity: u64) -> Self {
        let (requests, replies) = port.client(name, ros_type);
        Self {
            name: name.to_owned(),
            requests,
            replies,
            identity: identity | NO_LENGTH,
            calls: Mutex::new(0),
        }
    }

    /// Calls the service.
    ///
    /// # Errors
    /// When no node serves it or no reply comes in time.
    pub async fn call<Req: Serialize, Resp: DeserializeOwned>(
        &self,
        monitor: &Monitor,
        request: &Req,
    ) -> Result<Resp, CallError> {
        let encoding = |source| CallError::Encoding {
            service: self.name.clone(),
            source,
        };
        let mut calls = self.calls.lock().await;
        let found = tokio::time::timeout(DISCOVERY_WAIT, async {
            while monitor.readers(&self.requests) == 0 {
                tokio::time::sleep(CHECK_INTERVAL).await;
            }
        });
        found.await.map_err(|_| CallError::NoServer {
            service: self.name.clone(),
        })?;
        *calls += 1;
        let mut identity = [0; IDENTITY];
        identity[..8].copy_from_slice(&self.identity.to_le_bytes());
        identity[8..].copy_from_slice(&calls.to_le_bytes());
        let mut body = identity.to_vec();
        body.extend(to_cdr_body(request).map_err(encoding)?);
        self.requests.publish(body);
        let reply = tokio::time::timeout(REPLY_WAIT, self.reply_to(&identity)).await;
        let reply = reply.map_err(|_| CallError::NoReply {
            service: self.name.clone(),
            seconds: REPLY_WAIT.as_secs(),
        })?;
        // The alignment of the data is unchanged by the identity, since 16 is a multiple of 8.
        let (response, _) = from_cdr_body(&reply).map_err(encoding)?;
        Ok(response)
    }

    /// Waits for the reply with this identity, and ignores replies to other clients.
    async fn reply_to(&self, identity: &[u8; IDENTITY]) -> Vec<u8> {
        loop {
            if let Sample::Body { body, .. } = self.replies.next().await
                && let Some(rest) = body.strip_prefix(identity)
            {
                return rest.to_vec();
            }
        }
    }
}
