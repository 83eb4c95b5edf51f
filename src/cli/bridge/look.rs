//! `flexdrill bridge wits --look`: what a line carries and what the mapping makes of it, without publishing.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use anyhow::bail;
use tokio::sync::{broadcast, mpsc};

use super::super::signals;
use super::WitsArgs;
use crate::cli::new_file;
use crate::cli::output::{say, say_text};
use flexdrill_bridge::lines::{self, LineState, Seats, Times};
use flexdrill_bridge::wits::{Counts, Line, LineEvent, Look, Mapping};
use flexdrill_text::{counted, printable};

/// Pieces of a line that wait to be read.
const QUEUE: usize = 64;
/// Most connections that are shown: a peer that connects again and again must not fill the memory.
const MOST_SHOWN: usize = 16;

/// What a connection carried.
struct Seen {
    address: String,
    line: Line,
    look: Look,
}

/// Listens for `time`, prints a table per connection and writes the items of the one with most frames as a mapping.
///
/// # Errors
/// When the line cannot be used, no frame came, or the mapping cannot be written.
pub(super) async fn run(args: &WitsArgs, mapping: &Mapping, time: Duration) -> anyhow::Result<()> {
    let (place, name) = args.line.place(args.baud).await?;
    say!("wits {name}; nothing is published; listening for {} s", time.as_secs());
    let (sender, mut events) = mpsc::channel(QUEUE);
    let (outgoing, _) = broadcast::channel(1);
    let seats = Seats::default();
    // As in the bridge, the line lives in this task: its connections close with it. It has nothing to write but requests.
    let mut line = std::pin::pin!(lines::run(
        place,
        Times::default(),
        mapping.ask(),
        sender,
        outgoing,
        seats.clone()
    ));
    let mut shutdown = std::pin::pin!(signals::shutdown(false)?);
    let mut end = std::pin::pin!(tokio::time::sleep(time));
    let (mut seen, mut counts) = (BTreeMap::<u64, Seen>::new(), Counts::default());
    let mut why = String::new();
    loop {
        tokio::select! {
            () = &mut line => break,
            () = &mut end => break,
            () = &mut shutdown => break,
            Some(event) = events.recv() => match event {
                LineState::Opened { connection, peer, address } if seen.len() < MOST_SHOWN => {
                    let line = Line::new(mapping, &peer);
                    seen.insert(connection, Seen { address, line, look: Look::new(mapping) });
                }
                LineState::Bytes { connection, time, bytes } => {
                    let Some(Seen { line, look, .. }) = seen.get_mut(&connection) else { continue };
                    // Whole frames hold a seat here too, or a scanner could drive out the rig.
                    line.push(&bytes, time, &mut counts, |event| {
                        if let LineEvent::Frame(frame, _) = event {
                            seats.whole_frame(connection);
                            look.frame(&frame);
                        }
                    });
                }
                LineState::Asked { .. } => say!("silent for 10 s; asked for frames, as some recorders need it"),
                LineState::Waiting { why: reason, .. } => why = format!(": {}", printable(&reason)),
                LineState::Opened { .. }
                | LineState::Closed { .. }
                | LineState::Refused { .. }
                | LineState::NotWritten { .. } => {}
            },
        }
    }
    // A line without a frame is the usual first failure, so that the reason of the last attempt is part of the error.
    if counts.frames == 0 {
        bail!(
            "no frame in {} s{why}; {} outside of frames",
            time.as_secs(),
            counted(counts.discarded_bytes, "byte")
        );
    }
    for (connection, Seen { address, look, .. }) in seen.iter().filter(|(_, seen)| seen.look.frames() > 0) {
        say_text!(
            "connection {connection} ({}), {}:\n{}",
            printable(address),
            counted(look.frames(), "frame"),
            look.table()
        );
    }
    let most = seen.values().max_by_key(|seen| seen.look.frames());
    match most {
        Some(Seen { address, look, .. }) => write_site(&args.site, &look.site_file(&printable(address))),
        None => Ok(()),
    }
}

/// Writes the mapping of what was seen, and says how it is used.
///
/// # Errors
/// When the file cannot be written. A file that exists is left as it is: it may have a person's corrections.
fn write_site(file: &Path, text: &str) -> anyhow::Result<()> {
    let name = printable(&file.display().to_string()).into_owned();
    if new_file::write(file, text, "--site")? {
        say!(
            "{name} has these items as a mapping; correct what differs from the rig's display, and use it with --map {name}"
        );
    } else {
        say!("{name} exists and is left as it is; --site names another file for the mapping of these items");
    }
    Ok(())
}
