//! The file system as a recording uses it. Tests replace it by one that fails.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::os::unix::fs::{FileExt as _, MetadataExt as _};
use std::path::Path;

use rustix::process::{Resource, getrlimit};

/// Identity of a file, independent of its path: device and inode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileId {
    /// Id of the device.
    pub device: u64,
    /// Inode on the device.
    pub number: u64,
}

/// An open file of a recording.
pub trait StorageFile: Send {
    /// Writes some of `bytes` at `offset` (bytes). Returns how many.
    ///
    /// # Errors
    /// When nothing could be written.
    fn write_at(&mut self, bytes: &[u8], offset: u64) -> io::Result<usize>;

    /// Syncs the written data to the disk.
    ///
    /// # Errors
    /// When the disk refused. The data written since the last successful sync may then be lost, even if a later call
    /// succeeds: the kernel drops it.
    fn sync(&mut self) -> io::Result<()>;

    /// Truncates the file to `length` bytes.
    ///
    /// # Errors
    /// When the file system refuses.
    fn set_len(&mut self, length: u64) -> io::Result<()>;

    /// Identity of the file.
    ///
    /// # Errors
    /// When the file system reports an error.
    fn id(&self) -> io::Result<FileId>;
}

/// A file system.
pub trait Storage: Send + Sync {
    /// Creates a new file.
    ///
    /// # Errors
    /// When the file exists, or cannot be created.
    fn create(&self, path: &Path) -> io::Result<Box<dyn StorageFile>>;

    /// Creates a folder in an existing one.
    ///
    /// # Errors
    /// When it cannot be created.
    fn make_folder(&self, path: &Path) -> io::Result<()>;

    /// Removes a file.
    ///
    /// # Errors
    /// When the file system refuses.
    fn remove(&self, path: &Path) -> io::Result<()>;

    /// Identity of the file or folder that is at `path` now.
    ///
    /// # Errors
    /// When there is none.
    fn id(&self, path: &Path) -> io::Result<FileId>;

    /// Largest file size allowed (bytes), if there is a limit.
    fn largest_file(&self) -> Option<u64>;

    /// Writes a small text file at once: all of it or nothing, and never over another file.
    ///
    /// # Errors
    /// When the file exists, or cannot be written.
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
            // The file system has no hard links.
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

/// Syncs a folder, so that a new file's name is on the disk. Where that is impossible, only a crash of the machine can
/// lose the name.
pub(crate) fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let _ = File::open(folder.unwrap_or(Path::new("."))).and_then(|folder| folder.sync_all());
}
