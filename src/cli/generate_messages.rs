//! `flexdrill generate-messages`: writes the Rust source of the messages, for developers.

use std::path::PathBuf;

use crate::messages::generator;

/// Write src/messages/generated.rs from msg/ and src/messages/external/.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Root of the repository.
    #[arg(long, default_value = ".")]
    root: PathBuf,
}

/// Runs it.
///
/// # Errors
/// When a definition cannot be read or understood, or the file not written.
pub fn run(args: &Args) -> anyhow::Result<()> {
    let path = generator::write(&args.root)?;
    println!("wrote {}", path.display());
    Ok(())
}
