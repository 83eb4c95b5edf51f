//! `flexdrill watch`: a terminal dashboard over DDS. It reads the same topics as any outside client.

mod alarms;
mod board;
mod feed;
mod plain;
mod profile;
mod screen;
mod texts;

use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use clap::Args;

use super::{numbers, signals};
use crate::cli::output::{self, tell};
use crate::dds::network::Network;
use board::Board;
use feed::Feed;

/// How often the network and the keyboard are polled.
const POLL: Duration = Duration::from_millis(50);
/// Longest time for an orderly end of the full screen.
const PATIENCE: Duration = Duration::from_secs(3);
/// Time between two screen updates.
const FRAME: Duration = Duration::from_millis(100);
/// How long `--once` waits for a complete set of messages without `--duration`.
const ONCE_PATIENCE: Duration = Duration::from_secs(30);

/// Shows a running twin in the terminal, over DDS.
#[derive(Debug, Args)]
pub(super) struct WatchArgs {
    /// DDS domain, 0 to 232; default ROS_DOMAIN_ID or 0.
    #[arg(long)]
    domain: Option<u16>,
    /// Namespace of the twin.
    #[arg(long, default_value = "/")]
    namespace: String,
    /// Print blocks of lines instead of a full screen; the default when the output is no terminal.
    #[arg(long)]
    plain: bool,
    /// Print one block as soon as every topic has been received once, and end. Implies --plain.
    #[arg(long)]
    once: bool,
    /// Time between two blocks of --plain (s).
    #[arg(long, default_value_t = 1.0, value_parser = numbers::seconds)]
    interval: f64,
    /// End after this time (s); fails when no message of a twin was received.
    #[arg(long, value_parser = numbers::seconds)]
    duration: Option<f64>,
}

/// # Errors
/// When DDS does not start, the terminal cannot be used, or no message of a twin was received in time.
pub(super) fn run(args: &WatchArgs) -> anyhow::Result<()> {
    let (network, notes) = Network::read(args.domain, |name| std::env::var(name).ok())?;
    let stop = signals::stop_flag()?;
    let mut feed = Feed::new(&network, &args.namespace)?;
    let mut board = Board::new(Instant::now());
    let deadline = args.duration.map(Duration::from_secs_f64);
    if args.once || args.plain || !std::io::stdout().is_terminal() {
        for note in notes {
            tell!("note: {note}");
        }
        print_blocks(args, &mut feed, &mut board, deadline, &stop)?;
        if output::has_failed() {
            return Ok(());
        }
    } else {
        let mut terminal =
            ratatui::try_init().context("the terminal cannot be switched to full screen; use --plain")?;
        let result = show_screen(&mut terminal, &mut feed, &mut board, deadline, &stop);
        ratatui::restore();
        result?;
    }
    // An operator or a signal may end it at any time; after the given time, a twin must have been received.
    let by_clock = args.once || (deadline.is_some() && !stop.load(Ordering::Relaxed));
    if by_clock && board.status().is_none() {
        bail!(
            "no twin heard on {} in domain {}: is `flexdrill run` up, in the same domain (ROS_DOMAIN_ID) and namespace?",
            feed.status_topic(),
            network.domain_id
        );
    }
    Ok(())
}

fn print_blocks(
    args: &WatchArgs,
    feed: &mut Feed,
    board: &mut Board,
    deadline: Option<Duration>,
    stop: &AtomicBool,
) -> anyhow::Result<()> {
    let start = Instant::now();
    let interval = Duration::from_secs_f64(args.interval);
    let patience = if args.once {
        Some(deadline.unwrap_or(ONCE_PATIENCE))
    } else {
        deadline
    };
    let mut next = start + interval;
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(POLL);
        let now = Instant::now();
        feed.drain(board, now);
        if args.once && board.is_complete() {
            plain::print(board, now);
            break;
        }
        if !args.once && now >= next {
            next = now + interval;
            plain::print(board, now);
            if output::has_failed() {
                break;
            }
        }
        if patience.is_some_and(|patience| now - start >= patience) {
            if args.once {
                plain::print(board, now);
                bail!("not received in time: {}", board.missing().join(", "));
            }
            break;
        }
    }
    Ok(())
}

fn show_screen(
    terminal: &mut ratatui::DefaultTerminal,
    feed: &mut Feed,
    board: &mut Board,
    deadline: Option<Duration>,
    stop: &Arc<AtomicBool>,
) -> anyhow::Result<()> {
    let start = Instant::now();
    let mut next = start;
    let asked = Arc::clone(stop);
    // Reading the keys of a closed terminal may never return.
    std::thread::spawn(move || {
        while !asked.load(Ordering::Relaxed) {
            std::thread::sleep(POLL);
        }
        std::thread::sleep(PATIENCE);
        std::process::exit(1);
    });
    while !stop.load(Ordering::Relaxed) {
        let now = Instant::now();
        feed.drain(board, now);
        if now >= next {
            next = now + FRAME;
            terminal.draw(|frame| screen::draw(frame, board, now))?;
        }
        if screen::quit_pressed(POLL)? || deadline.is_some_and(|deadline| now - start >= deadline) {
            stop.store(true, Ordering::Relaxed);
        }
    }
    Ok(())
}
