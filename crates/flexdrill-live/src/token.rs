//! The secret that a client must send to steer.

use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};

use subtle::ConstantTimeEq as _;

/// Random bytes of a token: too many to guess.
const RANDOM: usize = 24;
/// Shortest token in a file (characters): a shorter one could be found by trying.
const SHORTEST: usize = 16;

/// Why there is no token.
#[derive(Debug, thiserror::Error)]
pub enum TokenError {
    /// The operating system has no random numbers.
    #[error("the operating system has no random numbers: {0}")]
    Random(#[source] std::io::Error),
    /// The file cannot be read.
    #[error("--token-file {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's error.
        source: std::io::Error,
    },
    /// The file holds no token, or one that can be guessed.
    #[error(
        "--token-file {}: {length} characters; a token is one line of at least {SHORTEST} letters, digits and punctuation \
         marks; `openssl rand -hex 24` makes one",
        path.display()
    )]
    Weak {
        /// The file.
        path: PathBuf,
        /// Number of characters in it, without blanks at its ends.
        length: usize,
    },
}

/// A secret.
#[derive(Clone)]
pub struct Token(String);

/// Omits the secret, because debug output may be logged.
impl fmt::Debug for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Token(..)")
    }
}

impl Token {
    /// A new random token.
    ///
    /// # Errors
    /// When the operating system has no random numbers.
    pub fn random() -> Result<Self, TokenError> {
        let mut bytes = [0_u8; RANDOM];
        fill_random(&mut bytes)?;
        let mut text = String::new();
        for byte in bytes {
            // Writing to a string does not fail.
            let _ = write!(text, "{byte:02x}");
        }
        Ok(Self(text))
    }

    /// The token in a file.
    ///
    /// # Errors
    /// When the file cannot be read, or holds no token of sufficient length.
    pub fn from_file(path: &Path) -> Result<Self, TokenError> {
        let text = std::fs::read_to_string(path).map_err(|source| TokenError::Read {
            path: path.to_owned(),
            source,
        })?;
        let token = text.trim();
        let length = token.chars().count();
        if length < SHORTEST || !token.chars().all(|c| c.is_ascii_graphic()) {
            return Err(TokenError::Weak {
                path: path.to_owned(),
                length,
            });
        }
        Ok(Self(token.to_owned()))
    }

    /// The token for an option that allows steering: from its file, or a new one; `None` if steering is not allowed.
    ///
    /// # Errors
    /// As [`Token::random`] and [`Token::from_file`].
    pub fn where_allowed(allowed: bool, file: Option<&Path>) -> Result<Option<Self>, TokenError> {
        Ok(match (allowed, file) {
            (false, _) => None,
            (true, None) => Some(Self::random()?),
            (true, Some(file)) => Some(Self::from_file(file)?),
        })
    }

    /// The text, for the URL that is printed.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// Whether `offered` is this token. The comparison takes the same time for any text of its length.
    pub fn is(&self, offered: &str) -> bool {
        self.0.as_bytes().ct_eq(offered.as_bytes()).into()
    }
}

/// Fills `bytes`, at most 256, with random bytes of the operating system.
///
/// # Errors
/// When it has none.
pub fn fill_random(bytes: &mut [u8]) -> Result<(), TokenError> {
    let wanted = bytes.len();
    let flags = rustix::rand::GetRandomFlags::empty();
    let given = rustix::rand::getrandom(bytes, flags).map_err(|error| TokenError::Random(error.into()))?;
    // The kernel gives up to 256 bytes at once or none.
    if given != wanted {
        return Err(TokenError::Random(std::io::ErrorKind::UnexpectedEof.into()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_whole_token_is_it() {
        let token = Token::random().unwrap();
        assert_eq!(token.text().len(), 2 * RANDOM);
        assert!(token.is(token.text()));
        assert!(!token.is(&token.text()[1..]) && !token.is("") && !token.is(&format!("{}0", token.text())));
        assert_ne!(token.text(), Token::random().unwrap().text());
    }

    #[test]
    fn a_file_with_a_guessable_token_is_refused() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(&file, "drill\n").unwrap();
        let said = Token::from_file(file.path()).err().unwrap().to_string();
        assert!(said.contains("5 characters") && said.contains("16"), "{said}");
        std::fs::write(&file, "0123456789abcdef\n").unwrap();
        assert!(Token::from_file(file.path()).unwrap().is("0123456789abcdef"));
    }
}
