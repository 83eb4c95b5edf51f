//! Who may write: users with their passwords. Everyone else reads.

use std::collections::BTreeMap;
use std::io;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use ::opcua::nodes::AccessLevel;
use ::opcua::server::authenticator::{AuthManager, Password, UserToken, user_pass_security_policy_id};
use ::opcua::server::{ANONYMOUS_USER_TOKEN_ID, ServerEndpoint};
use ::opcua::types::{Error, MessageSecurityMode, NodeId, StatusCode, UAString, UserTokenPolicy, UserTokenType};
use async_trait::async_trait;
use tokio::sync::{Semaphore, mpsc};

use super::event::ServerEvent;

/// Time that a wrong password costs.
const PENALTY: Duration = Duration::from_secs(1);
/// Wrong passwords that are answered at a time; more are refused at once, so that waiting costs no memory.
const MOST_WAITING: usize = 8;
/// Most users of a file: more are a mistake, or a file made to exhaust memory.
const MOST_USERS: usize = 1000;
/// Fewest characters of a password.
const SHORTEST_PASSWORD: usize = 8;

/// Why a file of passwords cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum UsersError {
    /// It cannot be read.
    #[error("{}: {source}", .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The reason, in words for a log.
        source: io::Error,
    },
    /// Others may read it.
    #[error("{}: others on this machine may read it (mode {mode:03o}), and it holds passwords; chmod 600 {}", .path.display(), .path.display())]
    Open {
        /// The file.
        path: PathBuf,
        /// Its permissions.
        mode: u32,
    },
    /// A line is wrong.
    #[error("{}:{line}: {what}; it must be one NAME:PASSWORD per line, a password of 8 characters or more", .path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        what: &'static str,
    },
}

/// Users with their passwords.
#[derive(Default, Clone)]
pub struct Users(BTreeMap<String, String>);

impl Users {
    /// Reads a file with one `NAME:PASSWORD` per line; empty lines and those that begin with `#` are skipped.
    ///
    /// # Errors
    /// When the file cannot be read, others may read it, a line is wrong, or there is no user.
    pub fn load(path: &Path) -> Result<Self, UsersError> {
        let failed = |source| UsersError::Read {
            path: path.to_owned(),
            source,
        };
        // Checked before reading: passwords that others could read are taken as known to them.
        let mode = std::fs::metadata(path).map_err(failed)?.permissions().mode() & 0o777;
        if mode & 0o077 != 0 {
            return Err(UsersError::Open {
                path: path.to_owned(),
                mode,
            });
        }
        let text = std::fs::read_to_string(path).map_err(failed)?;
        // Errors name the line and never its text, which holds a password.
        let wrong = |line: usize, what| UsersError::Line {
            path: path.to_owned(),
            line: line + 1,
            what,
        };
        // A wrong line refuses the whole file. A user who is left out in
        // silence would be looked for at the wrong place.
        let mut users = BTreeMap::new();
        for (number, line) in text.lines().enumerate() {
            if line.trim().is_empty() || line.starts_with('#') {
                continue;
            }
            let (name, password) = line.split_once(':').ok_or_else(|| wrong(number, "there is no colon"))?;
            // `ANONYMOUS` would give the rights of a user to every client without a login.
            if name.is_empty()
                || name == ANONYMOUS_USER_TOKEN_ID
                || name.len() > 64
                || name.chars().any(char::is_control)
            {
                return Err(wrong(
                    number,
                    "the name is empty, too long, ANONYMOUS or has control characters",
                ));
            }
            if password.chars().count() < SHORTEST_PASSWORD {
                return Err(wrong(number, "the password is too short"));
            }
            if users.insert(name.to_owned(), password.to_owned()).is_some() {
                return Err(wrong(number, "the user stands here twice"));
            }
            if users.len() > MOST_USERS {
                return Err(wrong(number, "there are more than 1000 users"));
            }
        }
        // A file without users is surely a mistake, because without the option no client could write either.
        if users.is_empty() {
            return Err(wrong(0, "there is no user"));
        }
        Ok(Self(users))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn is_right(&self, name: &str, password: &str) -> bool {
        // An unknown user takes the same time as a wrong password.
        let (expected, known) = self
            .0
            .get(name)
            .map_or(("", false), |expected| (expected.as_str(), true));
        same(expected.as_bytes(), password.as_bytes()) && known
    }
}

/// Compares in a time that does not depend on where the two differ.
fn same(expected: &[u8], given: &[u8]) -> bool {
    let mut difference = expected.len() ^ given.len();
    for (index, byte) in given.iter().enumerate() {
        difference |= usize::from(byte ^ expected.get(index).copied().unwrap_or_default());
    }
    difference == 0
}

/// Decides who is who, and who may write.
pub struct AccessControl {
    users: Users,
    /// Whether users may give their password where it is not encrypted: on loopback only.
    plain_passwords: bool,
    waiting: Semaphore,
    events: mpsc::Sender<ServerEvent>,
}

impl AccessControl {
    /// An access control; refusals are sent as events, and dropped while the queue is full.
    pub fn new(users: Users, plain_passwords: bool, events: mpsc::Sender<ServerEvent>) -> Self {
        Self {
            users,
            plain_passwords,
            waiting: Semaphore::new(MOST_WAITING),
            events,
        }
    }

    fn takes_passwords(&self, endpoint: &ServerEndpoint) -> bool {
        let encrypts = endpoint.message_security_mode() == MessageSecurityMode::SignAndEncrypt;
        !self.users.is_empty() && (encrypts || self.plain_passwords)
    }
}

#[async_trait]
impl AuthManager for AccessControl {
    async fn authenticate_anonymous_token(&self, _endpoint: &ServerEndpoint) -> Result<(), Error> {
        Ok(())
    }

    async fn authenticate_username_identity_token(
        &self,
        _endpoint: &ServerEndpoint,
        username: &str,
        password: &Password,
    ) -> Result<UserToken, Error> {
        if self.users.is_right(username, password.get()) {
            return Ok(UserToken(username.to_owned()));
        }
        let user = username.chars().take(64).collect();
        let _ = self.events.try_send(ServerEvent::LoginRefused { user });
        if let Ok(_turn) = self.waiting.try_acquire() {
            tokio::time::sleep(PENALTY).await;
        }
        Err(Error::new(
            StatusCode::BadUserAccessDenied,
            "user or password are wrong",
        ))
    }

    fn effective_user_access_level(&self, token: &UserToken, level: AccessLevel, _node: &NodeId) -> AccessLevel {
        if token.is_anonymous() {
            level & AccessLevel::CURRENT_READ
        } else {
            level
        }
    }

    fn user_token_policies(&self, endpoint: &ServerEndpoint) -> Vec<UserTokenPolicy> {
        let policy = |id: UAString, token_type| UserTokenPolicy {
            policy_id: id,
            token_type,
            issued_token_type: UAString::null(),
            issuer_endpoint_url: UAString::null(),
            security_policy_uri: UAString::null(),
        };
        let mut policies = vec![policy("anonymous".into(), UserTokenType::Anonymous)];
        if self.takes_passwords(endpoint) {
            policies.push(policy(user_pass_security_policy_id(endpoint), UserTokenType::UserName));
        }
        policies
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::Permissions;

    fn load(text: &str, mode: u32) -> Result<Users, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("users");
        std::fs::write(&path, text).unwrap();
        std::fs::set_permissions(&path, Permissions::from_mode(mode)).unwrap();
        Users::load(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn a_file_of_passwords_is_read_and_its_faults_are_said() {
        let users = load("# rig 7\nann:correct horse\n\nbob:pass:word9\n", 0o600).unwrap();
        assert!(users.is_right("ann", "correct horse") && users.is_right("bob", "pass:word9"));
        for (name, password) in [
            ("ann", "correct hors"),
            ("ann", ""),
            ("bob", "correct horse"),
            ("eve", ""),
        ] {
            assert!(!users.is_right(name, password), "{name} {password}");
        }
        for (text, mode, words) in [
            ("ann:correct horse\n", 0o640, "chmod 600"),
            ("ann correct horse\n", 0o600, "users:1: there is no colon"),
            ("\nann:short\n", 0o600, "users:2: the password is too short"),
            ("ann:correct horse\nann:correct horse\n", 0o600, "twice"),
            ("ANONYMOUS:correct horse\n", 0o600, "ANONYMOUS"),
            ("# none\n", 0o600, "there is no user"),
        ] {
            let error = load(text, mode).err().unwrap();
            assert!(error.contains(words), "{words}: {error}");
            assert!(!error.contains("horse"), "{error}");
        }
    }
}
