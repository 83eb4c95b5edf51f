//! The `flexdrill` binary; everything is in the library.

fn main() -> std::process::ExitCode {
    flexdrill::cli::main()
}
