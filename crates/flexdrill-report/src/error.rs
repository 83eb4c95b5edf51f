//! Errors of a report.

use std::path::PathBuf;

use flexdrill_bag::BagError;
use flexdrill_plot::DrawError;

/// Why no report was written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The bag cannot be read.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The bag has none of the twin's topics.
    #[error(
        "{path}: none of its topics is the twin's; it has {present}. Run the rig's inputs through the model first: \
         flexdrill replay {path} --out OUT.mcap",
        path = path.display()
    )]
    NoTwin {
        /// The bag.
        path: PathBuf,
        /// Its topics.
        present: String,
    },
    /// The bag has several twins.
    #[error("{path}: the bag has twins in the namespaces {namespaces}; choose one with --namespace", path = path.display())]
    SeveralTwins {
        /// The bag.
        path: PathBuf,
        /// Their namespaces.
        namespaces: String,
    },
    /// The bag has no twin in the requested namespace.
    #[error("{path}: the bag has no twin in the namespace {wanted}, only in {namespaces}", path = path.display())]
    OtherNamespace {
        /// The bag.
        path: PathBuf,
        /// The requested namespace.
        wanted: String,
        /// The namespaces of its twins.
        namespaces: String,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The page could not be written.
    #[error("cannot write the report {path}: {source}", path = path.display())]
    Write {
        /// The page.
        path: PathBuf,
        /// The operating system's error.
        source: std::io::Error,
    },
}
