//! The frames for the node: a bounded queue, and a thread that writes it.

use std::io;
use std::os::unix::net::UnixStream;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

use crate::dds::frames::{self, FromSide, LogLevel};

/// Most frames in the queue.
const DEPTH: usize = 1024;

/// Sends frames to the node. A frame that finds the queue full is dropped: the node stands still then, and newer frames
/// follow.
#[derive(Clone)]
pub(super) struct Outlet {
    frames: SyncSender<Option<FromSide>>,
    thread: Arc<Mutex<Option<JoinHandle<()>>>>,
}

impl Outlet {
    pub(super) fn start(socket: UnixStream) -> io::Result<Self> {
        let (frames, queue) = sync_channel(DEPTH);
        let thread = std::thread::Builder::new()
            .name("to the node".into())
            .spawn(move || write(socket, &queue))?;
        Ok(Self {
            frames,
            thread: Arc::new(Mutex::new(Some(thread))),
        })
    }

    pub(super) fn send(&self, frame: FromSide) {
        let _ = self.frames.try_send(Some(frame));
    }

    pub(super) fn log(&self, level: LogLevel, text: impl Into<String>) {
        self.send(FromSide::Log {
            level,
            text: text.into(),
        });
    }

    /// Writes all queued frames, and ends.
    pub(super) fn finish(&self) {
        let _ = self.frames.send(None);
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(thread) = thread {
            let _ = thread.join();
        }
    }
}

fn write(mut socket: UnixStream, queue: &Receiver<Option<FromSide>>) {
    while let Ok(Some(frame)) = queue.recv() {
        if frames::write(&mut socket, &frame).is_err() {
            // The node has closed the socket, which ends the reading thread, too.
            return;
        }
    }
}
