//! Logging: to standard error with a filter, and to `/rosout` so that `ros2` tools show it.

use std::fmt::Write as _;
use std::io::IsTerminal as _;
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

use ros2_client::builtin_interfaces::Time;
use ros2_client::log::Log;
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::{Context, Layer, SubscriberExt};
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{Registry, fmt, reload};

use super::args::RosArgs;
use crate::dds::plan::{Offer, dds_type_name};
use crate::dds::port::{PortBuilder, TopicPublisher};
use flexdrill_messages::to_cdr_body;
use flexdrill_text::printable;

/// RustDDS warns of every datagram above 1500 bytes and of peers that leave, ros2-client warns of every plain DDS client, and
/// foxglove reports a closed viewer as an error. async-opcua has a line for every connection and for every fault of a
/// client; the bridge counts them and logs them with a limit.
const LIBRARIES: &str = "rustdds=error,ros2_client=error,mio=error,foxglove=off,opcua_client=off,opcua_core=off,\
                         opcua_crypto=off,opcua_nodes=off,opcua_server=off,opcua_types=off";

/// The publisher of log lines, and the logger's name, while the node runs.
#[derive(Default)]
struct Rosout {
    target: RwLock<Option<(TopicPublisher, String)>>,
}

static ROSOUT: OnceLock<Arc<Rosout>> = OnceLock::new();
/// The filter of the start, and the handle to change it.
static FILTER: OnceLock<(String, reload::Handle<Targets, Registry>)> = OnceLock::new();

/// Starts logging. The filter is RUST_LOG if set, else `--log-level` or `info`, without the noise of the libraries. May
/// be called more than once; only the first call counts.
pub fn start(arguments: &RosArgs) {
    let mut filter = format!("{},{LIBRARIES}", arguments.log_level.as_deref().unwrap_or("info"));
    for (logger, level) in &arguments.logger_levels {
        // Writing to a string does not fail.
        let _ = write!(filter, ",{logger}={level}");
    }
    let text = chosen(std::env::var("RUST_LOG").ok(), filter);
    let (filter, handle) = reload::Layer::new(targets(&text));
    let rosout = ROSOUT.get_or_init(Arc::default);
    let lines = fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .with_target(false)
        .fmt_fields(fmt::format::debug_fn(|writer, field, value| {
            write!(writer, "{}", field_text(field, value))
        }));
    // A second subscriber is refused; the first one stays.
    let started = tracing_subscriber::registry()
        .with(filter)
        .with(lines)
        .with(RosoutLayer(Arc::clone(rosout)))
        .try_init();
    if started.is_ok() {
        // The first call is the only one that gets here.
        let _ = FILTER.set((text, handle));
    }
}

/// The filter's text: what RUST_LOG asks for if it can be read, else the default.
fn chosen(asked: Option<String>, default: String) -> String {
    let readable = |text: &String| !text.trim().is_empty() && text.parse::<Targets>().is_ok();
    asked.filter(readable).unwrap_or(default)
}

/// The filter of a text; a directive that cannot be read is left out, so that the others act.
fn targets(text: &str) -> Targets {
    let readable = |directive: &&str| !directive.trim().is_empty() && directive.parse::<Targets>().is_ok();
    let directives: Vec<&str> = text.split(',').filter(readable).collect();
    directives.join(",").parse().unwrap_or_default()
}

/// Adds directives such as `flexdrill=debug` to those of the start, in place of those that were added before. False when
/// logging was not started here.
pub fn add_directives(directives: &[String]) -> bool {
    let Some((start, handle)) = FILTER.get() else {
        return false;
    };
    let filter = format!("{start},{}", directives.join(","));
    handle.reload(targets(&filter)).is_ok()
}

/// Publishes log lines of this crate on `/rosout` until [`disconnect`]; `node` is the node's full name.
pub fn connect(port: &mut PortBuilder, node: &str) {
    let offer = Offer {
        latched: true,
        depth: 100,
        lifespan: Some(10.0),
        ..Offer::usual(10.0)
    };
    let publisher = port.publisher("/rosout", &dds_type_name("rcl_interfaces/msg/Log"), offer);
    let name = node.trim_start_matches('/').replace('/', ".");
    let rosout = ROSOUT.get_or_init(Arc::default);
    *rosout.target.write().unwrap_or_else(PoisonError::into_inner) = Some((publisher, name));
}

/// Stops publishing log lines. To be called before the node is dropped.
pub fn disconnect() {
    if let Some(rosout) = ROSOUT.get() {
        *rosout.target.write().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

struct RosoutLayer(Arc<Rosout>);

impl<S: Subscriber> Layer<S> for RosoutLayer {
    fn on_event(&self, event: &Event<'_>, _context: Context<'_, S>) {
        let metadata = event.metadata();
        // The DDS library logs while it holds its locks, and a line about this topic would cause the next one.
        if !metadata.target().starts_with("flexdrill") {
            return;
        }
        let Ok(target) = self.0.target.try_read() else { return };
        let Some((publisher, name)) = target.as_ref() else {
            return;
        };
        let mut text = Text::default();
        event.record(&mut text);
        let line = Log {
            stamp: Time::now(),
            level: match *metadata.level() {
                Level::ERROR => Log::ERROR,
                Level::WARN => Log::WARN,
                Level::INFO => Log::INFO,
                _ => Log::DEBUG,
            },
            name: name.clone(),
            msg: text.0,
            file: metadata.file().unwrap_or_default().to_owned(),
            function: metadata.target().to_owned(),
            line: metadata.line().unwrap_or_default(),
        };
        if let Ok(body) = to_cdr_body(&line) {
            publisher.publish(body);
        }
    }
}

#[derive(Default)]
struct Text(String);

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        self.0.push_str(&field_text(field, value));
    }
}

/// The text of a field. It may have come from other programs: it is printed on one line, with control characters escaped.
fn field_text(field: &Field, value: &dyn std::fmt::Debug) -> String {
    let text = format!("{value:?}");
    if field.name() == "message" {
        printable(&text).into_owned()
    } else {
        format!(" {}={}", field.name(), printable(&text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[derive(Default)]
    struct Lines(Mutex<Vec<String>>);

    impl<S: Subscriber> Layer<S> for &'static Lines {
        fn on_event(&self, event: &Event<'_>, _context: Context<'_, S>) {
            let mut text = Text::default();
            event.record(&mut text);
            self.0.lock().unwrap().push(text.0);
        }
    }

    #[test]
    fn a_directive_that_cannot_be_read_leaves_the_others() {
        let filter = targets("info,rustdds=error,flexdrill=nonsense,,flexdrill::ros=debug,flexdrill::ros=warn");
        assert!(filter.would_enable("flexdrill", &Level::INFO) && !filter.would_enable("flexdrill", &Level::DEBUG));
        assert!(filter.would_enable("rustdds::discovery", &Level::ERROR));
        assert!(!filter.would_enable("rustdds::discovery", &Level::WARN));
        // The last directive for a target counts.
        assert!(!filter.would_enable("flexdrill::ros::node", &Level::INFO));
        let default = || "info".to_owned();
        assert_eq!(chosen(Some("flexdrill=trace".to_owned()), default()), "flexdrill=trace");
        for unusable in [None, Some(String::new()), Some("flexdrill=nonsense".to_owned())] {
            assert_eq!(chosen(unusable, default()), "info");
        }
    }

    #[test]
    fn foreign_text_is_escaped() {
        let lines: &'static Lines = Box::leak(Box::default());
        let operator = "ann\x1b[2J\nalarm shock is normal";
        tracing::subscriber::with_default(tracing_subscriber::registry().with(lines), || {
            tracing::info!(topic = %"a\rb", "asked for by {operator}");
        });
        let said = lines.0.lock().unwrap();
        assert_eq!(
            *said,
            ["asked for by ann\\u{1b}[2J\\nalarm shock is normal topic=a\\rb"]
        );
    }
}
