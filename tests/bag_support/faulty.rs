//! A disk that fails where it is told to.

use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

use flexdrill::bag::{Disk, FileId, Storage, StorageFile};

/// Error numbers of the kernel.
pub const EIO: i32 = 5;
pub const ENOSPC: i32 = 28;

/// What an operation does instead of what it should.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Fails with this error number.
    Refuse(i32),
    /// A write takes the first half only. Anything else does what it should.
    Short,
    /// A write takes the first half, and what comes next fails with this number.
    ShortThenRefuse(i32),
    /// Waits until it is let go.
    Hang,
    /// Takes so many milliseconds.
    Slow(u64),
}

/// Which kinds of operations count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Counted {
    All,
    Writes,
    Syncs,
}

struct Plan {
    counted: Counted,
    fault: Fault,
    /// Operations that fail: from the first to before the last.
    from: AtomicUsize,
    until: AtomicUsize,
    count: AtomicUsize,
    fired: AtomicBool,
    swapped: AtomicBool,
    gate: Mutex<bool>,
    opened: Condvar,
}

/// What the disk does in an operation.
enum Turn {
    AsEver,
    Half,
}

impl Plan {
    fn turn(&self, is_write: bool, is_sync: bool) -> io::Result<Turn> {
        let counts = match self.counted {
            Counted::All => true,
            Counted::Writes => is_write,
            Counted::Syncs => is_sync,
        };
        if !counts {
            return Ok(Turn::AsEver);
        }
        let number = self.count.fetch_add(1, Ordering::SeqCst);
        let (from, until) = (self.from.load(Ordering::SeqCst), self.until.load(Ordering::SeqCst));
        if let Fault::ShortThenRefuse(error) = self.fault
            && number == from.saturating_add(1)
        {
            return Err(io::Error::from_raw_os_error(error));
        }
        if !(from..until).contains(&number) {
            return Ok(Turn::AsEver);
        }
        self.fired.store(true, Ordering::SeqCst);
        match self.fault {
            Fault::Refuse(error) => Err(io::Error::from_raw_os_error(error)),
            Fault::Short | Fault::ShortThenRefuse(_) => Ok(Turn::Half),
            Fault::Slow(milliseconds) => {
                std::thread::sleep(Duration::from_millis(milliseconds));
                Ok(Turn::AsEver)
            }
            Fault::Hang => {
                let mut open = self.gate.lock().unwrap();
                while !*open {
                    open = self.opened.wait(open).unwrap();
                }
                Ok(Turn::AsEver)
            }
        }
    }
}

/// The disk; clones are the same one.
#[derive(Clone)]
pub struct Faulty(Arc<Plan>);

impl Faulty {
    /// One that fails in no operation yet.
    pub fn new(counted: Counted, fault: Fault) -> Self {
        Self(Arc::new(Plan {
            counted,
            fault,
            from: AtomicUsize::new(usize::MAX),
            until: AtomicUsize::new(usize::MAX),
            count: AtomicUsize::new(0),
            fired: AtomicBool::new(false),
            swapped: AtomicBool::new(false),
            gate: Mutex::new(false),
            opened: Condvar::new(),
        }))
    }

    /// The operation that comes after `number` more is to fail.
    pub fn fail_once_after(&self, number: usize) {
        let from = self.0.count.load(Ordering::SeqCst) + number;
        self.0.until.store(from + 1, Ordering::SeqCst);
        self.0.from.store(from, Ordering::SeqCst);
    }

    /// All operations fail from now on.
    pub fn fail(&self) {
        self.0.from.store(0, Ordering::SeqCst);
    }

    /// From now on every path leads to another disk, as when one was taken out.
    pub fn swap(&self) {
        self.0.swapped.store(true, Ordering::SeqCst);
    }

    /// None fails any more, and what hangs goes on.
    pub fn heal(&self) {
        self.0.from.store(usize::MAX, Ordering::SeqCst);
        *self.0.gate.lock().unwrap() = true;
        self.0.opened.notify_all();
    }

    /// Whether an operation has met the fault.
    pub fn fired(&self) -> bool {
        self.0.fired.load(Ordering::SeqCst)
    }

    /// Operations so far.
    pub fn count(&self) -> usize {
        self.0.count.load(Ordering::SeqCst)
    }
}

struct FaultyFile(Box<dyn StorageFile>, Arc<Plan>);

impl StorageFile for FaultyFile {
    fn write_at(&mut self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        let bytes = match self.1.turn(true, false)? {
            Turn::AsEver => bytes,
            Turn::Half => &bytes[..bytes.len().div_ceil(2)],
        };
        self.0.write_at(bytes, offset)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.1.turn(false, true)?;
        self.0.sync()
    }

    fn set_len(&mut self, length: u64) -> io::Result<()> {
        self.1.turn(false, false)?;
        self.0.set_len(length)
    }

    fn id(&self) -> io::Result<FileId> {
        self.0.id()
    }
}

impl Storage for Faulty {
    fn create(&self, path: &Path) -> io::Result<Box<dyn StorageFile>> {
        self.0.turn(false, false)?;
        Ok(Box::new(FaultyFile(Disk.create(path)?, Arc::clone(&self.0))))
    }

    fn make_folder(&self, path: &Path) -> io::Result<()> {
        Disk.make_folder(path)
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        Disk.remove(path)
    }

    fn id(&self, path: &Path) -> io::Result<FileId> {
        let mut id = Disk.id(path)?;
        if self.0.swapped.load(Ordering::SeqCst) {
            id.device += 1;
        }
        Ok(id)
    }

    fn largest_file(&self) -> Option<u64> {
        Disk.largest_file()
    }

    fn put(&self, path: &Path, text: &str) -> io::Result<()> {
        self.0.turn(false, false)?;
        Disk.put(path, text)
    }
}
