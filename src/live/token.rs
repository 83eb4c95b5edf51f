//! The secret that who steers must show.

use std::fmt::{self, Write as _};
use std::path::Path;

use anyhow::{Context as _, bail};
use subtle::ConstantTimeEq as _;

/// Random bytes of a token: nobody guesses it.
const RANDOM: usize = 24;
/// Shortest token in a file (characters): with fewer it could be guessed by trying.
const SHORTEST: usize = 16;

/// A secret.
#[derive(Clone)]
pub struct Token(String);

/// Without the secret itself: what is debugged is logged.
impl fmt::Debug for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Token(..)")
    }
}

impl Token {
    /// A new one.
    ///
    /// # Errors
    /// When the system has no random numbers.
    pub fn random() -> anyhow::Result<Self> {
        let mut bytes = [0_u8; RANDOM];
        fill_random(&mut bytes)?;
        let mut text = String::new();
        for byte in bytes {
            // Writing to a string does not fail.
            let _ = write!(text, "{byte:02x}");
        }
        Ok(Self(text))
    }

    /// The one in a file.
    ///
    /// # Errors
    /// When the file cannot be read or holds none.
    pub fn from_file(path: &Path) -> anyhow::Result<Self> {
        let text = std::fs::read_to_string(path).with_context(|| format!("--token-file {}", path.display()))?;
        let token = text.trim();
        let length = token.chars().count();
        if length < SHORTEST || !token.chars().all(|c| c.is_ascii_graphic()) {
            bail!(
                "--token-file {}: {length} characters; a token is one line of at least {SHORTEST} letters, digits and signs; \
                 `openssl rand -hex 24` makes one",
                path.display()
            );
        }
        Ok(Self(token.to_owned()))
    }

    /// The one of an option that allows to steer: from its file, or a new one.
    ///
    /// # Errors
    /// As the two others.
    pub fn where_allowed(allowed: bool, file: Option<&Path>) -> anyhow::Result<Option<Self>> {
        Ok(match (allowed, file) {
            (false, _) => None,
            (true, None) => Some(Self::random()?),
            (true, Some(file)) => Some(Self::from_file(file)?),
        })
    }

    /// For the address that is printed.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// Whether it is this one. Takes the same time whatever is offered.
    pub(crate) fn is(&self, offered: &str) -> bool {
        self.0.as_bytes().ct_eq(offered.as_bytes()).into()
    }
}

/// Fills with random bytes of the system.
///
/// # Errors
/// When it has none.
pub(crate) fn fill_random(bytes: &mut [u8]) -> anyhow::Result<()> {
    let length = bytes.len();
    let filled = rustix::rand::getrandom(bytes, rustix::rand::GetRandomFlags::empty())
        .context("the system gives no random numbers")?;
    // The system gives up to 256 bytes at once or none.
    if filled != length {
        bail!("the system gave {filled} of {length} random bytes");
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
