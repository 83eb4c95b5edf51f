//! `cargo xtask figure` and `cargo xtask search`.

mod figures;
mod search;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};

/// Studies of the repository, from its root.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask")]
enum Study {
    /// Draws a picture of the documents from runs of the model or from a table.
    Figure {
        /// Which one.
        #[arg(value_enum)]
        which: Which,
        /// Where to: a folder for physics, else a file (SVG).
        to: PathBuf,
    },
    /// Searches for parameter sets that agree with the paper's findings; writes search.csv with a line per trial.
    Search(search::command::SearchArgs),
}

/// A picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Those of docs/physics.md; prints its table.
    Physics,
    /// That of README.md, from benches/speed.csv.
    Speed,
    /// That of docs/effects/spine.md.
    Spine,
    /// That of docs/whirl.md.
    Whirl,
}

fn main() -> anyhow::Result<()> {
    match Study::parse() {
        Study::Figure { which, to } => match which {
            Which::Physics => figures::physics::draw(&to),
            Which::Speed => figures::speed::draw(&to),
            Which::Spine => figures::spine::draw(&to),
            Which::Whirl => figures::whirl::draw(&to),
        },
        Study::Search(args) => search::command::run(&args),
    }
}
