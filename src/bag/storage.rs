//! What a recording asks of the file system: the seam at which tests let it fail.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::os::unix::fs::{FileExt as _, MetadataExt as _};
use std::path::Path;

use rustix::process::{Resource, getrlimit};

/// Which file it is, whatever its name: device and number on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileId {
    /// Device.
    pub device: u64,
    /// Number on the device.
    pub number: u64,
}

/// An open file of a recording.
pub trait StorageFile: Send {
    /// Writes some of `bytes` at `offset` (bytes); how many.
    ///
    /// # Errors
    /// When nothing could be written.
    fn write_at(&mut self, bytes: &[u8], offset: u64) -> io::Result<usize>;

    /// Brings what was written to the disk.
    ///
    /// # Errors
    /// When the disk refused it. What was written since the last good time may then be lost, whatever a later call says:
    /// the kernel forgets it.
    fn sync(&mut self) -> io::Result<()>;

    /// Cuts the file to `length` bytes.
    ///
    /// # Errors
    /// When the file system refuses.
    fn set_len(&mut self, length: u64) -> io::Result<()>;

    /// Which file it is.
    ///
    /// # Errors
    /// When the file system does not answer.
    fn id(&self) -> io::Result<FileId>;
}

/// A file system.
pub trait Storage: Send + Sync {
    /// Makes a file that is not there yet.
    ///
    /// # Errors
    /// When it is there, or cannot be made.
    fn create(&self, path: &Path) -> io::Result<Box<dyn StorageFile>>;

    /// Makes a folder in one that is there.
    ///
    /// # Errors
    /// When it cannot be made.
    fn make_folder(&self, path: &Path) -> io::Result<()>;

    /// Removes a file.
    ///
    /// # Errors
    /// When the file system refuses.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Which file or folder stands at `path` now.
    ///
    /// # Errors
    /// When there is none.
    fn id(&self, path: &Path) -> io::Result<FileId>;

    /// Largest file that may be written (bytes), if that is known.
    fn largest_file(&self) -> Option<u64>;

    /// Puts a small text at `path`: all of it or nothing, and never over another file.
    ///
    /// # Errors
    /// When there is a file, or it cannot be written.
    fn put(&self, path: &Path, text: &str) -> io::Result<()>;
}

/// The file system of this machine.
#[derive(Debug, Clone, Copy, Default)]
pub struct Disk;

impl Storage for Disk {
    fn create(&self, path: &Path) -> io::Result<Box<dyn StorageFile>> {
        let file = OpenOptions::new().write(true).create_new(true).open(path)?;
        sync_folder(path);
        Ok(Box::new(DiskFile(file)))
    }

    fn make_folder(&self, path: &Path) -> io::Result<()> {
        std::fs::create_dir(path)?;
        sync_folder(path);
        Ok(())
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        std::fs::remove_file(path)
    }

    fn id(&self, path: &Path) -> io::Result<FileId> {
        std::fs::metadata(path).map(|found| id(&found))
    }

    fn largest_file(&self) -> Option<u64> {
        getrlimit(Resource::Fsize).current
    }

    fn put(&self, path: &Path, text: &str) -> io::Result<()> {
        let temporary = path.with_extension("yaml.part");
        let written = File::create(&temporary).and_then(|mut file| {
            file.write_all(text.as_bytes())?;
            file.sync_all()
        });
        let put = written.and_then(|()| match std::fs::hard_link(&temporary, path) {
            Ok(()) => std::fs::remove_file(&temporary),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(error),
            // File systems without links.
            Err(_) if path.exists() => Err(ErrorKind::AlreadyExists.into()),
            Err(_) => std::fs::rename(&temporary, path),
        });
        if put.is_err() {
            let _ = std::fs::remove_file(&temporary);
        }
        sync_folder(path);
        put
    }
}

struct DiskFile(File);

impl StorageFile for DiskFile {
    fn write_at(&mut self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        self.0.write_at(bytes, offset)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.0.sync_data()
    }

    fn set_len(&mut self, length: u64) -> io::Result<()> {
        self.0.set_len(length)
    }

    fn id(&self) -> io::Result<FileId> {
        self.0.metadata().map(|found| id(&found))
    }
}

fn id(found: &std::fs::Metadata) -> FileId {
    FileId {
        device: found.dev(),
        number: found.ino(),
    }
}

/// Brings a new name to the disk. File systems that cannot do it lose the name only together with the machine.
pub(super) fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
}
