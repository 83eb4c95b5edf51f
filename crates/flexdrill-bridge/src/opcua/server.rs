//! The twin as a server of OPC UA.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use ::opcua::crypto::SecurityPolicy;
use ::opcua::server::address_space::AddressSpace;
use ::opcua::server::diagnostics::DiagnosticsNodeManagerBuilder;
use ::opcua::server::node_manager::ServerContext;
use ::opcua::server::node_manager::memory::{InMemoryNodeManager, InMemoryNodeManagerBuilder};
use ::opcua::server::{ANONYMOUS_USER_TOKEN_ID, Limits, Server, ServerBuilder, ServerEndpoint, ServerHandle};
use ::opcua::types::{MessageSecurityMode, VariableId, Variant};
use tokio::net::TcpListener;
use tokio::sync::mpsc;

use super::build::build;
use super::event::ServerEvent;
use super::gate;
use super::keys::Keys;
use super::nodes::{CoreNodes, TwinNodes};
use super::space;
use super::twin::TwinServer;
use super::users::{AccessControl, Users};

/// Subscriptions after which the server restarts: the crate keeps those of clients that left for as long as these asked.
const MOST_SUBSCRIPTIONS: u32 = 300;
/// Time between two looks at that number.
const LOOK: Duration = Duration::from_secs(5);

/// How the server is set up.
#[derive(Clone)]
pub struct Setup {
    /// Host name or address in the addresses that clients are given.
    pub host: String,
    /// URI of this program, as in its certificate.
    pub application_uri: String,
    /// Certificates.
    pub keys: Keys,
    /// Who may write.
    pub users: Users,
    /// Whether targets may be written at all.
    pub allow_write: bool,
    /// Whether clients may connect without encryption.
    pub unencrypted: bool,
    /// Whether passwords are accepted without encryption: on loopback only.
    pub plain_passwords: bool,
}

/// Why the server does not start.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// A port.
    #[error("the port of the server: {0}")]
    Port(#[from] std::io::Error),
    /// The crate refuses the setup.
    #[error("the server of OPC UA cannot be set up: {0}")]
    Setup(String),
}

/// Memory that a client can make the server hold is bounded by these.
fn limits() -> Limits {
    let mut limits = Limits {
        max_sessions: gate::MOST_CONNECTIONS,
        max_browse_continuation_points: 20,
        max_query_continuation_points: 5,
        max_history_continuation_points: 5,
        ..Limits::default()
    };
    let subscriptions = &mut limits.subscriptions;
    subscriptions.max_subscriptions_per_session = 3;
    subscriptions.max_monitored_items_per_sub = 1000;
    // Room for all alarms that stand when a client subscribes.
    subscriptions.max_monitored_item_queue_size = 50;
    subscriptions.max_keep_alive_count = 300;
    subscriptions.max_lifetime_count = 900;
    let operations = &mut limits.operational;
    operations.max_nodes_per_read = 1000;
    operations.max_nodes_per_write = 20;
    limits
}

/// A server that is set up and not yet run.
pub struct Prepared {
    server: Server,
    handle: ServerHandle,
    inner: TcpListener,
    events: mpsc::Sender<ServerEvent>,
}

impl Prepared {
    /// Serves clients on `listener` for as long as it is polled, or until the server has to restart; returns why.
    pub async fn run(self, listener: &TcpListener) -> String {
        let (inner, public) = match (self.inner.local_addr(), listener.local_addr()) {
            (Ok(inner), Ok(public)) => (inner, public),
            (Err(error), _) | (_, Err(error)) => return error.to_string(),
        };
        let (handle, events) = (self.handle, self.events);
        let gate = async {
            // The server names its own port to clients once it runs; they need the public one.
            while handle.info().port.load(Ordering::Relaxed) != inner.port() {
                tokio::time::sleep(Duration::from_millis(1)).await;
            }
            handle.info().port.store(public.port(), Ordering::Relaxed);
            gate::run(listener, inner, events).await;
        };
        let watch = async {
            let count = VariableId::Server_ServerDiagnostics_ServerDiagnosticsSummary_CurrentSubscriptionCount;
            loop {
                tokio::time::sleep(LOOK).await;
                let value = handle.info().diagnostics.get(count).and_then(|value| value.value);
                if let Some(Variant::UInt32(subscriptions)) = value
                    && subscriptions > MOST_SUBSCRIPTIONS
                {
                    return format!("{subscriptions} subscriptions are kept, of clients that left");
                }
            }
        };
        let ended = tokio::select! {
            ended = self.server.run_with(self.inner) => ended.err().unwrap_or_else(|| "it ended".to_owned()),
            () = gate => "its port is closed".to_owned(),
            why = watch => why,
        };
        handle.cancel();
        ended
    }
}

/// Sets the server up.
///
/// # Errors
/// When there is no port for it or the setup is refused.
pub async fn prepare(setup: &Setup, events: mpsc::Sender<ServerEvent>) -> Result<(TwinServer, Prepared), ServerError> {
    // The server itself listens on loopback only. The public port is the gateway's, which bounds the connections.
    let inner = TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, 0))).await?;
    // One flag joins the two node managers: the standard's node takes the request for a refresh, the twin's answers it.
    let refresh = Arc::new(AtomicBool::new(false));
    let (core_refresh, twin_refresh) = (Arc::clone(&refresh), Arc::clone(&refresh));
    let (twin_events, writable) = (events.clone(), setup.allow_write);
    let core = move |context: ServerContext, space: &mut AddressSpace| CoreNodes::new(context, space, core_refresh);
    let twin = move |context: ServerContext, space: &mut AddressSpace| {
        build(&context, space, writable, twin_events, twin_refresh)
    };
    let access = AccessControl::new(setup.users.clone(), setup.plain_passwords, events.clone());
    let mut builder = ServerBuilder::new()
        // The nodes of the standard come from `CoreNodes`, because it also takes the request for a refresh.
        .without_node_managers()
        .with_node_manager(InMemoryNodeManagerBuilder::new(core))
        .with_node_manager(DiagnosticsNodeManagerBuilder)
        .with_node_manager(InMemoryNodeManagerBuilder::new(twin))
        .with_authenticator(Arc::new(access))
        .application_name("flexdrill")
        .application_uri(setup.application_uri.clone())
        .product_uri("urn:flexdrill")
        .certificate_path("own/cert.der")
        .private_key_path("private/private.pem")
        .pki_dir(setup.keys.folder())
        // Trusting unknown certificates would make encryption useless against
        // a client in the middle; an administrator moves them.
        .trust_client_certs(false)
        .host(setup.host.clone())
        .discovery_urls(vec!["/".to_owned()])
        .limits(limits())
        .diagnostics_enabled(true);
    let tokens = [ANONYMOUS_USER_TOKEN_ID.to_owned()];
    let encrypt = MessageSecurityMode::SignAndEncrypt;
    for (name, policy, mode) in [
        ("aes256", SecurityPolicy::Aes256Sha256RsaPss, encrypt),
        ("basic256sha256", SecurityPolicy::Basic256Sha256, encrypt),
        ("none", SecurityPolicy::None, MessageSecurityMode::None),
    ] {
        // Encrypted endpoints always exist; the open one only by option or on loopback.
        if mode == encrypt || setup.unencrypted {
            builder = builder.add_endpoint(name, ServerEndpoint::new("/", policy, mode, &tokens));
        }
    }
    let (server, handle) = builder.build().map_err(ServerError::Setup)?;
    // These cannot be missing in a server that was built from the parts above; a change of the crate would show here.
    let missing = |what: &str| ServerError::Setup(format!("{what} is missing"));
    let nodes = handle
        .node_managers()
        .get_of_type::<InMemoryNodeManager<TwinNodes>>()
        .ok_or_else(|| missing("the twin's part"))?;
    let namespace = handle
        .get_namespace_index(space::NAMESPACE)
        .ok_or_else(|| missing("the twin's namespace"))?;
    let twin = TwinServer::new(nodes, handle.clone(), namespace, refresh);
    let prepared = Prepared {
        server,
        handle,
        inner,
        events,
    };
    Ok((twin, prepared))
}
