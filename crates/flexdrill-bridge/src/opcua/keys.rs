//! The folder with our certificate and those of others.

use std::fs::{DirBuilder, Permissions};
use std::io;
use std::os::unix::fs::{DirBuilderExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use ::opcua::crypto::{CertificateStore, X509Data};

/// Bits of our key: what all policies from Basic256Sha256 on accept.
const KEY_BITS: u32 = 2048;
/// Validity of our certificate (days): the life of a rig's equipment, because an expired one stops the connection.
const VALID_DAYS: u32 = 3650;
/// Most certificates that are kept for an operator to look at: a stranger can send any number.
const MOST_REJECTED: usize = 100;

/// Why the folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum KeysError {
    /// The disk or its permissions.
    #[error("{}: {source}; --state names the folder for certificates", .path.display())]
    Folder {
        /// The folder or file.
        path: PathBuf,
        /// The reason, in words for a log.
        source: io::Error,
    },
    /// The certificate could not be made.
    #[error("{}: no certificate could be made: {why}; remove what is in own/ and private/, and start again", .path.display())]
    Certificate {
        /// The folder.
        path: PathBuf,
        /// The reason, in words for a log.
        why: String,
    },
}

/// A folder of certificates: `own/` and `private/` are ours; in `trusted/` are those that we accept, in `rejected/` those
/// that came and were not in `trusted/`.
#[derive(Debug, Clone)]
pub struct Keys {
    folder: PathBuf,
}

/// What a certificate states.
#[derive(Debug, Clone, Copy)]
pub struct Application<'a> {
    /// Name for people.
    pub name: &'a str,
    /// The URI of the program, which both ends compare.
    pub uri: &'a str,
    /// Address under which others reach us, if it is one.
    pub host: Option<&'a str>,
}

/// The name of this machine, for addresses and URIs.
pub fn own_name() -> String {
    let names = X509Data::computer_hostnames();
    names.into_iter().next().unwrap_or_else(|| "localhost".to_owned())
}

impl Keys {
    /// Opens the folder, and makes it and our certificate if they are not there.
    ///
    /// # Errors
    /// When the disk refuses it, or the certificate cannot be made.
    pub fn open(folder: &Path, application: Application<'_>) -> Result<Self, KeysError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| KeysError::Folder { path, source }
        };
        // Others neither read the key nor add to what is trusted.
        let mut builder = DirBuilder::new();
        builder.recursive(true).mode(0o700);
        for name in ["own", "private", "trusted", "rejected"] {
            let path = folder.join(name);
            builder.create(&path).map_err(failed(&path))?;
        }
        let store = CertificateStore::new(folder);
        let key = store.own_private_key_path();
        let certificate = store.own_certificate_path();
        if !key.exists() || !certificate.exists() {
            let hosts = application.host.map(|host| vec![host.to_owned()]);
            let data = X509Data {
                key_size: KEY_BITS,
                common_name: application.name.to_owned(),
                organization: application.name.to_owned(),
                organizational_unit: "drilling".to_owned(),
                country: "NO".to_owned(),
                state: "none".to_owned(),
                alt_host_names: X509Data::alt_host_names(application.uri, hosts, true, true, false),
                certificate_duration_days: VALID_DAYS,
            };
            store
                .create_and_store_application_instance_cert(&data, true)
                .map_err(|why| KeysError::Certificate {
                    path: folder.to_owned(),
                    why,
                })?;
            std::fs::set_permissions(&key, Permissions::from_mode(0o600)).map_err(failed(&key))?;
        }
        Ok(Self {
            folder: folder.to_owned(),
        })
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// How many certificates wait in `rejected/`; beyond a hundred the oldest are removed.
    pub fn rejected(&self) -> usize {
        let Ok(entries) = std::fs::read_dir(self.folder.join("rejected")) else {
            return 0;
        };
        let mut files: Vec<_> = entries
            .filter_map(|entry| {
                let entry = entry.ok()?;
                Some((entry.metadata().ok()?.modified().ok()?, entry.path()))
            })
            .collect();
        files.sort();
        let beyond = files.len().saturating_sub(MOST_REJECTED);
        for (_, path) in files.drain(..beyond) {
            // One that stays is counted the next time.
            let _ = std::fs::remove_file(path);
        }
        files.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_certificate_is_made_once_and_only_its_user_reads_the_key() {
        let folder = tempfile::tempdir().unwrap();
        let application = Application {
            name: "flexdrill",
            uri: "urn:test:flexdrill",
            host: Some("192.168.1.10"),
        };
        let keys = Keys::open(folder.path(), application).unwrap();
        let store = CertificateStore::new(folder.path());
        let first = store.read_own_cert().unwrap();
        assert!(first.is_application_uri_valid("urn:test:flexdrill").is_ok());
        let mode = std::fs::metadata(store.own_private_key_path())
            .unwrap()
            .permissions()
            .mode();
        assert_eq!(mode & 0o777, 0o600);
        Keys::open(folder.path(), application).unwrap();
        assert_eq!(store.read_own_cert().unwrap().thumbprint(), first.thumbprint());
        for number in 0..MOST_REJECTED + 5 {
            std::fs::write(folder.path().join(format!("rejected/{number}.der")), "x").unwrap();
        }
        assert_eq!(keys.rejected(), MOST_REJECTED);
        assert_eq!(
            std::fs::read_dir(folder.path().join("rejected")).unwrap().count(),
            MOST_REJECTED
        );
    }
}
