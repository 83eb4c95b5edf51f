//! The page's requests over HTTP: data other than live data, and actions on the twin.

use crate::DashboardError;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::extract::{ConnectInfo, DefaultBodyLimit, Path, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::{any, get, post};
use axum::{Json, Router};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::assets;
use crate::board::Board;
use crate::control::{Action, Control, Refused};
use crate::life::LifeTable;
use crate::snapshots::Snapshots;
use crate::what_if::{Question, WhatIf};
use flexdrill_live::{Gateway, WrongTokens, host_is_ours};

/// Longest body of a request (bytes): names and reasons.
const LONGEST_BODY: usize = 16 << 10;
/// Header in which a page names the run of the server that served it.
const INSTANCE: &str = "x-flexdrill-instance";
/// Longest time of a request: longer than the node and the refusal of a wrong token take.
const LONGEST: Duration = Duration::from_secs(20);

/// The state that all requests share.
pub(crate) struct Shared {
    pub board: Arc<Board>,
    /// `None` if no client may steer.
    pub control: Option<Arc<Control>>,
    /// Questions to the look-ahead; `None` as for steering.
    pub what_if: Option<Arc<WhatIf>>,
    /// The reason in that case.
    pub no_control: &'static str,
    pub gateway: Arc<Gateway>,
    pub namespace: String,
    /// Absolute name of the twin's node.
    pub node: String,
    /// The recording that is played; `None` for a live twin.
    pub bag: Option<Arc<PlayedBag>>,
    /// Random text that identifies this run of the server.
    pub instance: String,
    pub answers: SharedAnswers,
    /// The table of joints' lives, where one is named.
    pub life: Option<Arc<LifeTable>>,
}

/// Text for [`Shared::instance`].
///
/// # Errors
/// When the operating system has no random numbers.
pub(crate) fn new_instance() -> Result<String, DashboardError> {
    let mut random = [0; 8];
    flexdrill_live::fill_random(&mut random)?;
    Ok(format!("{:016x}", u64::from_le_bytes(random)))
}

/// Answers that requests share, so that many requests cost little.
#[derive(Default)]
pub(crate) struct SharedAnswers {
    history: Snapshots,
    journal: Snapshots,
    wrong_tokens: WrongTokens,
}

pub(crate) struct PlayedBag {
    pub name: String,
    /// ns since 1970.
    pub start: u64,
    pub end: u64,
    /// Whether the whole bag has been read.
    pub ready: std::sync::atomic::AtomicBool,
}

type Server = State<Arc<Shared>>;

/// The router of the dashboard's address.
pub(crate) fn router(shared: Shared) -> Router {
    let api = Router::new()
        .route("/live", any(live))
        .route("/api/session", get(session))
        .route("/api/pulse", get(pulse))
        .route("/api/history", get(history))
        .route("/api/orbit/{joint}/{time_ns}", get(orbit))
        .route("/api/journal", get(journal))
        .route("/api/control", get(control))
        .route("/api/what_if", get(what_if))
        .route("/api/mappings", get(mappings))
        .route("/api/life", get(life))
        .route("/api/control/{what}", post(act))
        .layer(DefaultBodyLimit::max(LONGEST_BODY));
    assets::router()
        .merge(api)
        .with_state(Arc::new(shared))
        .layer(middleware::from_fn(guard))
}

/// Refuses foreign host names, bounds the time of a request, and adds the security headers to every answer.
async fn guard(request: Request, next: Next) -> Response {
    let response = if host_is_ours(request.headers()) {
        let late = || (StatusCode::REQUEST_TIMEOUT, "the request took too long\n").into_response();
        tokio::time::timeout(LONGEST, next.run(request))
            .await
            .unwrap_or_else(|_| late())
    } else {
        let why = "use this server's IP address or localhost\n";
        (StatusCode::FORBIDDEN, why).into_response()
    };
    assets::guard(response).await
}

async fn live(State(shared): Server, request: Request) -> Response {
    Arc::clone(&shared.gateway).enter(request).await
}

async fn session(State(shared): Server) -> Json<Value> {
    let session = shared.board.session();
    let bag = shared.bag.as_ref().map(|bag| {
        json!({
            "name": bag.name,
            "start_ns": bag.start.to_string(),
            "end_ns": bag.end.to_string(),
            "ready": bag.ready.load(std::sync::atomic::Ordering::Acquire),
            "incidents": shared.board.incidents(),
        })
    });
    Json(json!({
        "version": env!("CARGO_PKG_VERSION"),
        "instance": shared.instance,
        "mode": if bag.is_some() { "bag" } else { "live" },
        "namespace": shared.namespace,
        "node": shared.node,
        "control": shared.control.is_some(),
        "life": shared.life.is_some(),
        "limits": session.as_ref().map(|session| session.limits_json()),
        "bag": bag,
        "tool": session.as_ref().map(|session| session.tool_json()),
        "config_hash": session.as_ref().map(|session| &session.config_hash),
        "start_ns": session.as_ref().map(|session| session.start.to_string()),
    }))
}

/// The server's clock and the age of its newest data. This request has its own connection, so that a page with a queue
/// of live data learns how far behind it is.
async fn pulse(State(shared): Server) -> Response {
    let body = json!({
        "instance": shared.instance,
        "time_ns": super::now().to_string(),
        "newest": if shared.bag.is_some() { json!({}) } else { shared.board.newest() },
    });
    ([(header::CACHE_CONTROL, "no-store")], Json(body)).into_response()
}

async fn history(State(shared): Server) -> Response {
    // The history has one frame per second, so a copy stays current for a second.
    let second = flexdrill_clock::monotonic::now() / 1_000_000_000;
    match shared.answers.history.body(second, || shared.board.history()) {
        Some(body) => large(body, "application/octet-stream"),
        None => answer(StatusCode::NOT_FOUND, "no message of the twin has arrived yet"),
    }
}

/// An answer that is sent in parts and never cached.
fn large(body: Body, kind: &'static str) -> Response {
    let mut response = Response::new(body);
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    response
}

async fn orbit(State(shared): Server, Path((joint, time)): Path<(usize, i64)>) -> Response {
    match shared.board.orbit(joint, time) {
        Some(motion) => Json(motion).into_response(),
        None => answer(StatusCode::NOT_FOUND, "no motion of that joint is kept for this time"),
    }
}

async fn journal(State(shared): Server) -> Response {
    let journal = || serde_json::to_vec(&shared.board.journal()).ok();
    match shared.answers.journal.body(shared.board.journal_version(), journal) {
        Some(body) => large(body, "application/json"),
        None => answer(
            StatusCode::INTERNAL_SERVER_ERROR,
            "the journal cannot be written as JSON",
        ),
    }
}

async fn control(State(shared): Server) -> Json<Value> {
    let status = shared.board.status();
    let status = status.as_ref().map(|(status, _)| status);
    Json(match &shared.control {
        Some(control) => control.json(status),
        None => json!({"allowed": false, "driving": false}),
    })
}

async fn what_if(State(shared): Server) -> Response {
    let body = shared.what_if.as_ref().map_or(Value::Null, |what_if| what_if.json());
    ([(header::CACHE_CONTROL, "no-store")], Json(body)).into_response()
}

async fn mappings(State(shared): Server) -> Response {
    // A recording has the diagnostics of its time, and nothing in it can be confirmed.
    let body = if shared.bag.is_some() {
        json!([])
    } else {
        let service = shared.control.as_ref().map(|control| control.confirm_service());
        shared.board.mappings(&shared.namespace, service)
    };
    ([(header::CACHE_CONTROL, "no-store")], Json(body)).into_response()
}

async fn life(State(shared): Server) -> Response {
    let Some(life) = shared.life.as_ref().map(Arc::clone) else {
        return Json(Value::Null).into_response();
    };
    // The table is on a disk, which may not answer.
    match tokio::task::spawn_blocking(move || life.json()).await {
        Ok(body) => ([(header::CACHE_CONTROL, "no-store")], Json(body)).into_response(),
        Err(_) => answer(StatusCode::INTERNAL_SERVER_ERROR, "the table of lives cannot be read"),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SteerRequest {
    operator: String,
    rotary_speed_rpm: f64,
    weight_on_bit_kn: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AlarmRequest {
    operator: String,
    #[serde(default)]
    id: String,
    #[serde(default)]
    reason: String,
    duration_s: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OperatorRequest {
    operator: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MappingRequest {
    operator: String,
    source: String,
    mapping: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PauseRequest {
    operator: String,
    paused: bool,
}

async fn act(
    State(shared): Server,
    Path(what): Path<String>,
    ConnectInfo(from): ConnectInfo<SocketAddr>,
    headers: HeaderMap,
    body: Bytes,
) -> Response {
    // Without the permission there is no control at all: a fault in what follows cannot steer.
    let Some(control) = &shared.control else {
        return answer(StatusCode::FORBIDDEN, shared.no_control);
    };
    // The token is checked before the body is read, so that a stranger's body is never parsed.
    let offered = bearer(&headers);
    if !offered.is_some_and(|token| control.admits(token)) {
        if offered.is_some() {
            // A wrong token is logged and delayed, which slows guessing. A missing one comes from every page without control.
            shared.answers.wrong_tokens.refuse(from).await;
        }
        return answer(
            StatusCode::UNAUTHORIZED,
            "send the token that the dashboard printed at its start",
        );
    }
    // A page from an earlier run of the server must not act on the present one.
    if headers
        .get(INSTANCE)
        .is_some_and(|bound| bound.as_bytes() != shared.instance.as_bytes())
    {
        return answer(
            StatusCode::CONFLICT,
            "the server has been restarted since this page was loaded; reload the page",
        );
    }
    // Each request names its operator, who stands in the journal and in the log.
    let done = match what.as_str() {
        "steer" => steer(&shared, control, &body),
        "release" => read::<OperatorRequest>(&body).and_then(|plain| control.release(&plain.operator)),
        "acknowledge" | "shelve" | "unshelve" => match read::<AlarmRequest>(&body) {
            Ok(AlarmRequest {
                operator,
                id,
                reason,
                duration_s,
            }) => {
                let action = match what.as_str() {
                    "acknowledge" => Action::Acknowledge { id, reason },
                    "shelve" => Action::Shelve {
                        id,
                        reason,
                        duration: duration_s,
                    },
                    _ => Action::Unshelve { id, reason },
                };
                control.carry_out(&operator, action).await
            }
            Err(refused) => Err(refused),
        },
        "reset" => match read::<OperatorRequest>(&body) {
            Ok(plain) => control.carry_out(&plain.operator, Action::Reset).await,
            Err(refused) => Err(refused),
        },
        "confirm_mapping" => match read::<MappingRequest>(&body) {
            Ok(MappingRequest {
                operator,
                source,
                mapping,
            }) => {
                let action = Action::ConfirmMapping { source, mapping };
                control.carry_out(&operator, action).await
            }
            Err(refused) => Err(refused),
        },
        "pause" => match read::<PauseRequest>(&body) {
            Ok(pause) => control.carry_out(&pause.operator, Action::Pause(pause.paused)).await,
            Err(refused) => Err(refused),
        },
        // Control and questions are set up one by one, so each is checked.
        "what_if" | "cancel_what_if" => {
            let Some(what_if) = &shared.what_if else {
                return answer(StatusCode::FORBIDDEN, shared.no_control);
            };
            if what == "what_if" {
                match read::<Question>(&body) {
                    Ok(question) => what_if.ask(question).await,
                    Err(refused) => Err(refused),
                }
            } else {
                match read::<OperatorRequest>(&body) {
                    Ok(plain) => what_if.cancel(&plain.operator).await,
                    Err(refused) => Err(refused),
                }
            }
        }
        _ => return answer(StatusCode::NOT_FOUND, "no such request"),
    };
    // A page distinguishes its own mistake, a conflict with another operator
    // and a twin that is away: only the last is worth a retry.
    match done {
        Ok(message) => answer(StatusCode::OK, &message),
        Err(refused) => {
            let status = match refused {
                Refused::Wrong(_) => StatusCode::BAD_REQUEST,
                Refused::Conflict(_) => StatusCode::CONFLICT,
                Refused::Away(_) => StatusCode::SERVICE_UNAVAILABLE,
            };
            answer(status, &refused.to_string())
        }
    }
}

fn steer(shared: &Shared, control: &Control, body: &[u8]) -> Result<String, Refused> {
    let wanted: SteerRequest = read(body)?;
    let limits = shared.board.session().map(|session| session.limits);
    let status = shared.board.status();
    control.steer(
        &wanted.operator,
        [wanted.rotary_speed_rpm, wanted.weight_on_bit_kn],
        limits,
        status.as_ref().map(|(status, _)| status),
    )
}

fn read<T: DeserializeOwned>(body: &[u8]) -> Result<T, Refused> {
    serde_json::from_slice(body).map_err(|error| Refused::Wrong(format!("the request is malformed: {error}")))
}

/// The token in `Authorization: Bearer TOKEN`.
fn bearer(headers: &HeaderMap) -> Option<&str> {
    headers
        .get(header::AUTHORIZATION)?
        .to_str()
        .ok()?
        .strip_prefix("Bearer ")
}

fn answer(status: StatusCode, message: &str) -> Response {
    (status, Json(json!({"ok": status.is_success(), "message": message}))).into_response()
}
