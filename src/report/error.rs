//! Why there is no report.

use std::path::PathBuf;

use crate::bag::BagError;
use flexdrill_plot::DrawError;

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The bag cannot be read.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The bag holds nothing that the twin has published.
    #[error(
        "{path}: none of its topics is the twin's, there are {present}; run the rig's inputs through the model first: \
         flexdrill replay {path} --out OUT.mcap",
        path = path.display()
    )]
    NoTwin {
        /// Bag.
        path: PathBuf,
        /// Its topics.
        present: String,
    },
    /// The bag holds several twins.
    #[error("{path}: it holds twins in the namespaces {namespaces}; say which with --namespace", path = path.display())]
    SeveralTwins {
        /// Bag.
        path: PathBuf,
        /// Their namespaces.
        namespaces: String,
    },
    /// The bag holds no twin of that namespace.
    #[error("{path}: no twin in the namespace {wanted}, but in {namespaces}", path = path.display())]
    OtherNamespace {
        /// Bag.
        path: PathBuf,
        /// Namespace asked for.
        wanted: String,
        /// Those that there are.
        namespaces: String,
    },
    /// A figure could not be drawn.
    #[error(transparent)]
    Draw(#[from] DrawError),
    /// The page could not be written.
    #[error("cannot write the report {path}: {source}", path = path.display())]
    Write {
        /// Page.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
}
