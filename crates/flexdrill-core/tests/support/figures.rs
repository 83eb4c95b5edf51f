//! Figures of single laws, which `cargo xtask reference validation` collects from the output of the tests.

#![allow(dead_code, reason = "every test takes what it needs")]

/// Holds `ours` to `expected` within `tolerance`, relative to `expected`, and prints both.
pub fn figure(quantity: &str, expected: f64, ours: f64, tolerance: f64) {
    scaled_figure(quantity, expected, ours, expected.abs(), tolerance);
}

/// As [`figure`], with the difference relative to `scale`.
pub fn scaled_figure(quantity: &str, expected: f64, ours: f64, scale: f64, tolerance: f64) {
    let thread = std::thread::current();
    let test = thread
        .name()
        .and_then(|name| name.rsplit("::").next())
        .unwrap_or_default();
    println!("figure\t{test}\t{quantity}\t{expected:e}\t{ours:e}\t{scale:e}\t{tolerance:e}");
    let difference = (ours - expected).abs() / scale;
    assert!(
        difference <= tolerance,
        "{quantity}: {ours} instead of {expected}, {difference:e} apart where {tolerance:e} is allowed"
    );
}
