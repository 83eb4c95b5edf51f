//! Opens the page in this machine's browser without revealing the token: every user can read the arguments of a program
//! in the list of processes.

use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::cli::output::tell;
use crate::live::fill_random;

/// A page in a file readable by its owner only, which redirects the browser to an address. Dropping it removes the
/// file.
#[derive(Debug)]
pub(super) struct Redirect(PathBuf);

impl Redirect {
    /// Writes a redirect to `url` into `folder`.
    ///
    /// # Errors
    /// When the file cannot be written.
    fn write(folder: &Path, url: &str) -> anyhow::Result<Self> {
        let mut random = [0; 8];
        fill_random(&mut random)?;
        let path = folder.join(format!("flexdrill-{:016x}.html", u64::from_le_bytes(random)));
        let mut file: File = OpenOptions::new()
            .write(true)
            .create_new(true)
            .mode(0o600)
            .open(&path)?;
        let redirect = Self(path);
        let url = escaped(url);
        writeln!(
            file,
            "<!doctype html><meta charset=\"utf-8\"><title>flexdrill</title>\
             <meta name=\"referrer\" content=\"no-referrer\">\
             <meta http-equiv=\"refresh\" content=\"0;url={url}\"><a href=\"{url}\">flexdrill</a>"
        )?;
        Ok(redirect)
    }
}

impl Drop for Redirect {
    fn drop(&mut self) {
        // By now the browser has read the file, or the user has opened the printed URL.
        let _ = std::fs::remove_file(&self.0);
    }
}

fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Lets the desktop open a URL, through a private file if the URL has a token. Without a desktop it prints a hint.
pub(super) fn open(url: &str) -> Option<Redirect> {
    match try_open(url) {
        Ok(redirect) => redirect,
        Err(error) => {
            tell!("cannot open a browser ({error}); open the printed address in one");
            None
        }
    }
}

fn try_open(url: &str) -> anyhow::Result<Option<Redirect>> {
    let program = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let mut command = Command::new(program);
    let redirect = if url.contains('#') {
        // Only the session's user can enter this folder, if the session has one.
        let folder = std::env::var_os("XDG_RUNTIME_DIR").map_or_else(std::env::temp_dir, PathBuf::from);
        let redirect = Redirect::write(&folder, url)?;
        command.arg(&redirect.0);
        Some(redirect)
    } else {
        command.arg(url);
        None
    };
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| anyhow::anyhow!("{program}: {error}"))?;
    Ok(redirect)
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::PermissionsExt as _;

    use super::*;

    #[test]
    fn only_the_owner_can_read_the_redirect_and_it_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        let redirect = Redirect::write(folder.path(), "http://127.0.0.1:8080/#token=a\"&<b").unwrap();
        let mode = std::fs::metadata(&redirect.0).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
        let text = std::fs::read_to_string(&redirect.0).unwrap();
        assert!(
            text.contains("url=http://127.0.0.1:8080/#token=a&quot;&amp;&lt;b\""),
            "{text}"
        );
        drop(redirect);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
