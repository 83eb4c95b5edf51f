//! The `flexdrill` binary; everything is in the library.

use std::sync::atomic::{AtomicBool, Ordering};

/// Standard output was not open when the program started.
static NO_OUTPUT: AtomicBool = AtomicBool::new(false);

extern "C" fn look_at_output() {
    NO_OUTPUT.store(
        rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err(),
        Ordering::Relaxed,
    );
}

/// Run before Rust's runtime, which opens /dev/null in the place of a standard output that is not open, after which the
/// two cannot be distinguished.
#[cfg(target_os = "linux")]
#[expect(
    unsafe_code,
    reason = "the linker calls functions of this section before main; this one touches an atomic only"
)]
#[used]
#[unsafe(link_section = ".init_array")]
static BEFORE_RUNTIME: extern "C" fn() = look_at_output;

fn main() -> std::process::ExitCode {
    flexdrill::cli::main(NO_OUTPUT.load(Ordering::Relaxed))
}
